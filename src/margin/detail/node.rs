//! A vertex of an outline with detail, which knows where it would be without.

use glam::DVec2;

use super::super::LandmarkKind;

/// A vertex of the detailed outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Node {
    pub(super) at: DVec2,
    /// Where it would be without the smallest teeth.
    pub(super) bare: DVec2,
    /// Where it would be without detail.
    pub(super) foot: DVec2,
    /// Which part of the outline it shrinks with: between the part of this number and the next.
    pub(super) part: f64,
    pub(super) mark: Option<LandmarkKind>,
    /// From how far on either side this corner is to be rounded (mm).
    pub(super) round: f64,
}

impl Node {
    pub(super) fn plain(at: DVec2, foot: DVec2, part: f64) -> Self {
        Self { at, bare: at, foot, part, mark: None, round: 0.0 }
    }

    /// Where it is with only a share of its smallest teeth, and a share of everything.
    pub(super) fn shrunk(&self, fine: f64, whole: f64) -> DVec2 {
        if fine == 1.0 && whole == 1.0 {
            return self.at;
        }
        self.foot.lerp(self.bare.lerp(self.at, fine), whole)
    }

    pub(super) fn between(a: &Self, b: &Self, t: f64) -> Self {
        Self::plain(
            a.at.lerp(b.at, t),
            a.foot.lerp(b.foot, t),
            if t < 0.5 { a.part } else { b.part },
        )
    }
}
