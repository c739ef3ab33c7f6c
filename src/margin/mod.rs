//! The outline of the blade.
//!
//! [`build`] makes a [`Margin`] from a [`MarginSpec`]: a parametric leaf ([`parametric`]) or a
//! polygon in millimetres. Drawings, photographs and foreign polygons become such a polygon first
//! ([`sketch`], [`silhouette`], [`placement`]); none of them opens a file.
//!
//! Each kind makes an [`Outline`]; [`Margin::from_outline`] checks it once. What the maker knows of
//! the outline (lobe tips, valleys, teeth) travels along as [`Landmark`]s.

pub mod blades;
pub mod curve;
pub mod detail;
mod error;
pub mod fit;
mod given;
pub mod instances;
mod landmarks;
pub mod lobes;
pub mod morph;
mod outline;
pub mod parametric;
pub mod placement;
pub mod shapes;
pub mod silhouette;
pub mod sketch;
pub mod tidy;

use glam::DVec2;

use crate::geometry::segments::SegmentIndex;
use crate::geometry::{Rect, polygon};
use crate::parameter::{parameters, words};
use crate::seed::Seed;
use detail::{RoughnessSpec, TeethSpec, WaveSpec};
pub use error::MarginError;
pub use landmarks::{Landmark, LandmarkKind};
use lobes::LobeRecord;
use lobes::shorthand::LobingSpec;
pub use outline::Outline;
use parametric::SideSpec;

words! {
    /// Where the outline comes from.
    pub enum MarginKind {
        /// Both sides by landmarks and tangents.
        Unilobed = "unilobed",
        /// Several lobes, each with a vein of its own.
        Lobed = "lobed",
        /// A polygon in millimetres.
        Polygon = "polygon",
    }
}

parameters! {
    /// The outline of the blade.
    pub struct MarginSpec {
        /// Where the outline comes from: `unilobed` (landmarks) or `lobed` (lobes along veins), both
        /// after Garg 2011, or `polygon`.
        kind: choice(MarginKind, MarginKind::Unilobed),
        /// Length of the blade from base to apex, without petiole.
        length_mm: number(80.0, 1.0..=2000.0, "mm"),
        /// The right side of a unilobed leaf, seen from the front.
        right: group(SideSpec, SideSpec::default()),
        /// The left side of a unilobed leaf, seen from the front.
        left: group(SideSpec, SideSpec::default()),
        /// How far the left side is its own: 1 as given, 0 the mirror of the right side.
        asymmetry: number(1.0, 0.0..=1.0, ""),
        /// How far a unilobed leaf's midrib turns from base to apex, which stays on the axis; above 0
        /// it bows to the right.
        midrib_bend_deg: number(0.0, -120.0..=120.0, "deg"),
        /// How far inside the blade the petiole is attached, as a share of the length of the blade: 0
        /// on the margin, above 0 a peltate leaf; `length_mm` runs from there to the apex.
        base_inset: number(0.0, 0.0..=0.6, "blades"),
        /// The lobes of a lobed leaf by the first and the last; used when no `margin.lobe` is given.
        lobing: group(LobingSpec, LobingSpec::default()),
        /// The lobes of a lobed leaf one by one.
        lobe: records(LobeRecord),
        /// Teeth along the margin.
        teeth: group(TeethSpec, TeethSpec::default()),
        /// Waves of the margin.
        waves: group(WaveSpec, WaveSpec::default()),
        /// Fine unevenness of the margin.
        roughness: group(RoughnessSpec, RoughnessSpec::default()),
        /// The outline when `kind = "polygon"`: base at [0, 0], apex on +y; scaled to `length_mm`.
        polygon_mm: points(),
        /// Slits inside the polygon, as open lines.
        cuts_mm: lines(),
        /// Tips of teeth that stand on the polygon: a line of points for each order.
        tooth_tips_mm: lines(),
        /// Lobes of the polygon: for each where its vein begins, and its tip.
        lobe_veins_mm: lines(),
    }
}

/// The outline of a leaf blade, in leaf space (mm).
///
/// # Guarantees
///
/// - At least 8 vertices, all finite; neighbours at least [`Margin::MIN_EDGE_MM`] apart.
/// - Simple: no two edges touch, except neighbours at their shared vertex.
/// - Anticlockwise; the first vertex is the base, at the origin, and is not repeated at the end. Of a
///   peltate leaf the base lies inside, and the first vertex below it on the −y axis.
/// - The apex is a vertex on the +y axis.
/// - Cuts (slits inside the blade) are finite lines of two points or more, all of which lie inside the
///   outline.
/// - Landmarks stand in the order of their vertices, at most one at each.
#[derive(Debug, Clone, PartialEq)]
pub struct Margin {
    outline: Vec<DVec2>,
    apex: usize,
    cuts: Vec<Vec<DVec2>>,
    landmarks: Vec<Landmark>,
}

impl Margin {
    /// Neighbouring vertices are at least this far apart (mm): far below a texel (200 mm over 8192
    /// is 0.024), so nothing visible goes; far above rounding, so tangents stay defined.
    pub const MIN_EDGE_MM: f64 = 1e-3;

    /// Fewer vertices than this make no leaf.
    pub const MIN_VERTICES: usize = 8;

    /// A margin from an outline that starts at the base and has its apex at vertex `apex`; either
    /// winding. Merges vertices that stand too close and refuses what it cannot guarantee.
    ///
    /// # Errors
    ///
    /// The [`MarginError`] of the guarantee that would be broken; `hint` says what the caller's user
    /// can change about a self-crossing.
    pub fn new(
        outline: Vec<DVec2>,
        apex: usize,
        cuts: Vec<Vec<DVec2>>,
        hint: &'static str,
    ) -> Result<Self, MarginError> {
        Self::from_outline(Outline { points: outline, apex, cuts, landmarks: Vec::new() }, hint)
    }

    /// A margin from an outline with what stands on it. Merges vertices that stand too close (never
    /// the base or the apex, landmarks only with each other) and refuses what it cannot guarantee.
    ///
    /// # Errors
    ///
    /// As [`new`](Self::new).
    pub fn from_outline(mut outline: Outline, hint: &'static str) -> Result<Self, MarginError> {
        if let Some(index) = outline.points.iter().position(|p| !p.is_finite()) {
            return Err(MarginError::NotFinite { index });
        }
        let tip = outline.points.get(outline.apex).copied().unwrap_or(DVec2::ZERO);
        let first = outline.points.first().copied().unwrap_or(DVec2::INFINITY);
        let at_base = first.length() < 1e-9;
        let below = first.x.abs() < 1e-9 && first.y < 0.0;
        if !(at_base || below && polygon::contains(&outline.points, DVec2::ZERO))
            || tip.x.abs() > 1e-9 * tip.y.abs().max(1.0)
            || tip.y <= 0.0
        {
            return Err(MarginError::NotPlaced);
        }
        outline = outline.spaced();
        if outline.points.len() < Self::MIN_VERTICES {
            return Err(MarginError::TooFewPoints {
                count: outline.points.len(),
                least: Self::MIN_VERTICES,
            });
        }
        let area = polygon::signed_area(&outline.points);
        if area.abs() < 1e-4 * tip.y * tip.y {
            return Err(MarginError::NoArea { area_mm2: area });
        }
        outline.wound(area);
        let Outline { mut points, apex, cuts, mut landmarks } = outline;
        landmarks.sort_by_key(|mark| mark.vertex);
        points[0] = if at_base { DVec2::ZERO } else { DVec2::new(0.0, first.y) };
        points[apex].x = 0.0;
        if let Some(at) = polygon::self_crossing(&points) {
            return Err(MarginError::SelfCrossing { x: at.x, y: at.y, hint });
        }
        let outside = |p: &&DVec2| !p.is_finite() || !polygon::contains(&points, **p);
        let cuts: Vec<Vec<DVec2>> = cuts.into_iter().filter(|line| line.len() > 1).collect();
        if let Some(p) = cuts.iter().flatten().find(outside) {
            return Err(MarginError::CutOutside { x: p.x, y: p.y });
        }
        Ok(Self { outline: points, apex, cuts, landmarks })
    }

    /// The vertices, anticlockwise from the base.
    #[must_use]
    pub fn outline(&self) -> &[DVec2] {
        &self.outline
    }

    /// The tip of the blade.
    #[must_use]
    pub fn apex(&self) -> DVec2 {
        self.outline[self.apex]
    }

    /// Whether the petiole is attached inside the blade, and not on the margin.
    #[must_use]
    pub fn is_peltate(&self) -> bool {
        self.outline[0] != DVec2::ZERO
    }

    /// Index of the apex in the outline. Vertices before it are the right side, after it the left.
    #[must_use]
    pub fn apex_index(&self) -> usize {
        self.apex
    }

    /// Slits drawn inside the blade.
    #[must_use]
    pub fn cuts(&self) -> &[Vec<DVec2>] {
        &self.cuts
    }

    /// The lines that no vein crosses: the outline and the cuts.
    #[must_use]
    pub fn lines(&self) -> SegmentIndex {
        let cuts = self.cuts.iter().flat_map(|line| line.windows(2).map(|w| (w[0], w[1])));
        SegmentIndex::new(polygon::edges(&self.outline).chain(cuts).collect())
    }

    /// What stands on the margin (lobe tips, valleys, teeth), in the order of the vertices. Empty
    /// when the outline came as a polygon.
    #[must_use]
    pub fn landmarks(&self) -> &[Landmark] {
        &self.landmarks
    }

    /// The same as an outline to change and check again.
    #[must_use]
    pub fn to_outline(&self) -> Outline {
        Outline {
            points: self.outline.clone(),
            apex: self.apex,
            cuts: self.cuts.clone(),
            landmarks: self.landmarks.clone(),
        }
    }

    /// From base to apex (mm).
    #[must_use]
    pub fn length_mm(&self) -> f64 {
        self.apex().y
    }

    /// Area of the blade (mm²).
    #[must_use]
    pub fn area_mm2(&self) -> f64 {
        polygon::signed_area(&self.outline)
    }

    /// The box around the blade.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        Rect::around(self.outline.iter().copied())
    }

    /// The first guarantee that does not hold, in words; `None` when all do. For tests.
    #[must_use]
    pub fn check(&self) -> Option<String> {
        let ordered = self.landmarks.windows(2).all(|pair| pair[0].vertex < pair[1].vertex);
        if !ordered || self.landmarks.iter().any(|mark| mark.vertex >= self.outline.len()) {
            return Some("landmarks are out of order".into());
        }
        match Self::from_outline(self.to_outline(), "") {
            Err(error) => Some(error.to_string()),
            Ok(same) if same != *self => Some("rebuilding the margin changes it".into()),
            Ok(_) => None,
        }
    }
}

/// The margin of a leaf; `seed` draws what is irregular about its teeth, waves and roughness.
///
/// # Errors
///
/// [`MarginError`] names the key, the value and what to change.
pub fn build(spec: &MarginSpec, seed: Seed) -> Result<Margin, MarginError> {
    let plain = entire(spec)?;
    if detail::is_plain(spec) {
        return Ok(plain);
    }
    let hint = "lower margin.teeth.depth, margin.waves.height or margin.roughness.height_mm";
    Margin::from_outline(detail::set(&plain.to_outline(), spec, seed)?, hint)
}

/// The margin without teeth, waves and roughness.
///
/// # Errors
///
/// As [`build`].
pub fn entire(spec: &MarginSpec) -> Result<Margin, MarginError> {
    match spec.kind {
        MarginKind::Unilobed => {
            let outline = parametric::outline(spec)?.peltate(spec.base_inset);
            let hint = "lower tension, or narrow tail_x or shoulder_x";
            let margin = Margin::from_outline(outline.scaled(DVec2::splat(spec.length_mm)), hint);
            margin.map_err(|error| parametric::mending::advised(spec, error))
        }
        MarginKind::Lobed => {
            let expanded;
            let records = if spec.lobe.is_empty() {
                expanded = spec.lobing.records()?;
                &expanded
            } else {
                &spec.lobe
            };
            let outline = lobes::outline(records)?.peltate(spec.base_inset);
            let hint = "make the lobes there narrower or shorter";
            let margin = Margin::from_outline(outline.scaled(DVec2::splat(spec.length_mm)), hint);
            margin.map_err(|error| lobes::mending::advised(spec, records, error))
        }
        MarginKind::Polygon => {
            Margin::from_outline(spec.given_outline(), "mend margin.polygon_mm there")
        }
    }
}
