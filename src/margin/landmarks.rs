//! What stands on a margin: tips of lobes, valleys between them, teeth.
//!
//! The makers of an outline know where they put these; whoever reads the finished [`Margin`] (veins
//! that end in teeth, primaries that run to lobe tips) is told by [`Margin::landmarks`] instead of
//! looking for them again. Outlines that come as polygons have none.
//!
//! [`Margin`]: super::Margin
//! [`Margin::landmarks`]: super::Margin::landmarks

use glam::DVec2;

/// A vertex of the margin with a meaning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Landmark {
    /// Index of the vertex in the outline.
    pub vertex: usize,
    /// What stands there.
    pub kind: LandmarkKind,
}

/// What stands at a vertex of the margin.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum LandmarkKind {
    /// The tip of a lobe, the one at the apex included.
    LobeTip {
        /// Where the vein of the lobe begins: on the midrib, or at the base (mm).
        origin: DVec2,
    },
    /// The lowest place between two lobes.
    Valley,
    /// The tip of a tooth.
    Tooth {
        /// 1 for the large teeth, 2 for those on them, 3 for those on these.
        order: u8,
    },
    /// The lowest place between two teeth of an order.
    Sinus {
        /// As of the teeth.
        order: u8,
    },
    /// Where a slender drip tip begins, on either side of it.
    TipNeck,
}

impl LandmarkKind {
    /// The same on a blade whose points are moved.
    #[must_use]
    pub(super) fn mapped(self, place: impl Fn(DVec2) -> DVec2) -> Self {
        match self {
            Self::LobeTip { origin } => Self::LobeTip { origin: place(origin) },
            other => other,
        }
    }

    /// Whether two landmarks too close to tell apart should leave this one.
    pub(super) fn outranks(self, other: Self) -> bool {
        self.rank() < other.rank()
    }

    fn rank(self) -> u8 {
        match self {
            Self::LobeTip { .. } => 0,
            Self::Valley => 1,
            Self::TipNeck => 2,
            Self::Tooth { order } => 3_u8.saturating_add(order.saturating_mul(2)),
            Self::Sinus { order } => 4_u8.saturating_add(order.saturating_mul(2)),
        }
    }
}
