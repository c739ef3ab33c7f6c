//! How lengths are measured at one age, in the frame of the mature leaf.

use glam::DVec2;

use super::warp::Warp;
use crate::geometry::Rect;

/// The measure of one age. Where the blade grows at different rates from place to place it holds the
/// map to the leaf of that age.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    stretch: DVec2,
    per_mm: f64,
    warp: Option<Warp>,
}

impl Frame {
    /// Of a blade whose tissue has one scale everywhere. Uniform growth keeps `stretch` at one, so that
    /// distances stay valid from step to step and only the lengths of the model shrink.
    pub(super) fn uniform(stretch: DVec2, per_mm: f64) -> Self {
        Self { stretch, per_mm, warp: None }
    }

    pub(super) fn warped(warp: Warp) -> Self {
        Self { stretch: warp.mean_stretch(), per_mm: 1.0, warp: Some(warp) }
    }

    /// The measure itself.
    #[must_use]
    pub fn metric(&self) -> Metric<'_> {
        Metric { stretch: self.stretch, per_mm: self.per_mm, warp: self.warp.as_ref() }
    }
}

/// How lengths are measured at one age.
///
/// Where tissue has one scale everywhere, the distance of two points is |(a − b)·`stretch`|, and a
/// length of the current leaf is `per_mm` times as long in that measure. Under non-uniform growth
/// points are [placed](Self::place) in the leaf of that age and measured there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric<'a> {
    /// Factors on x and y; their means where they differ from place to place.
    pub stretch: DVec2,
    /// What a current millimetre measures.
    pub per_mm: f64,
    warp: Option<&'a Warp>,
}

impl Metric<'_> {
    /// Whether scales differ from place to place; then distances may shrink as the leaf grows.
    #[must_use]
    pub fn is_warped(&self) -> bool {
        self.warp.is_some()
    }

    /// Whether the measure is plain distance in the frame of the mature leaf.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.warp.is_none() && self.stretch == DVec2::ONE
    }

    /// Where a point lies in the measure.
    #[inline]
    #[must_use]
    pub fn place(&self, p: DVec2) -> DVec2 {
        match self.warp {
            None => p * self.stretch,
            Some(warp) => warp.place(p),
        }
    }

    /// The way from `a` to `b`.
    #[inline]
    #[must_use]
    pub fn between(&self, a: DVec2, b: DVec2) -> DVec2 {
        match self.warp {
            None => (b - a) * self.stretch,
            Some(warp) => warp.place(b) - warp.place(a),
        }
    }

    /// The point at the end of a way from `from`.
    #[inline]
    #[must_use]
    pub fn beyond(&self, from: DVec2, way: DVec2) -> DVec2 {
        match self.warp {
            None => from + way / self.stretch,
            Some(warp) => warp.unplace(warp.place(from) + way),
        }
    }

    /// The squared distance of two points.
    #[inline]
    #[must_use]
    pub fn distance_squared(&self, a: DVec2, b: DVec2) -> f64 {
        self.between(a, b).length_squared()
    }

    /// The measure of a length of the current leaf.
    #[must_use]
    pub fn length(&self, mm: f64) -> f64 {
        mm * self.per_mm
    }

    /// Half width and height, in the frame of the mature leaf, of the box around a circle of the
    /// given measure; under non-uniform growth of a typical one.
    #[must_use]
    pub fn reach(&self, measure: f64) -> DVec2 {
        DVec2::splat(measure) / self.stretch
    }

    /// Half width and height, in the frame of the mature leaf, of a box around `p` that holds all
    /// points within the given measure.
    #[inline]
    #[must_use]
    pub fn around(&self, p: DVec2, measure: f64) -> DVec2 {
        match self.warp {
            None => self.reach(measure),
            Some(warp) => warp.around(p, measure),
        }
    }

    /// Radius, in the frame of the mature leaf, of a circle around `p` that holds all points within
    /// the given measure.
    #[must_use]
    pub fn radius(&self, p: DVec2, measure: f64) -> f64 {
        match self.warp {
            None => self.reach(measure).max_element(),
            Some(warp) => warp.around(p, measure).length(),
        }
    }

    /// No point farther than `distance` from `p` in x or in y, in the frame of the mature leaf, is
    /// nearer than this in the measure.
    #[must_use]
    pub fn clearance(&self, p: DVec2, distance: f64) -> f64 {
        match self.warp {
            None => distance * self.stretch.min_element(),
            Some(warp) => warp.clearance(p, distance),
        }
    }

    /// The corners of a box around `rect` as seen from `p`.
    #[must_use]
    pub fn corners_from(&self, p: DVec2, rect: Rect) -> (DVec2, DVec2) {
        match self.warp {
            None => ((rect.min - p) * self.stretch, (rect.max - p) * self.stretch),
            Some(warp) => {
                let (low, high) = warp.corners(rect);
                (low - warp.place(p), high - warp.place(p))
            }
        }
    }

    /// How far the points of a box may be from its centre.
    #[must_use]
    pub fn half_diagonal(&self, centre: DVec2, half: DVec2) -> f64 {
        match self.warp {
            None => (half * self.stretch).length(),
            Some(warp) => {
                let rect = Rect { min: centre - half, max: centre + half };
                let (low, high) = warp.corners(rect);
                let centre = warp.place(centre);
                (centre - low).max(high - centre).length()
            }
        }
    }

    /// How large the tissue at `p` is, by area and relative to the mature leaf, where scales differ.
    pub(crate) fn area_scale(&self, p: DVec2) -> f64 {
        self.warp.map_or(1.0, |warp| warp.area_scale(p))
    }

    /// The greatest of those.
    pub(crate) fn greatest_area_scale(&self) -> f64 {
        self.warp.map_or(1.0, Warp::greatest_area_scale)
    }
}
