//! The map from the mature leaf to a younger one whose parts have grown at different rates.
//!
//! The blade is cut across into bands. Along, each band has one scale, so that places follow by
//! adding up bands from the base; across, scales are linear from one edge of a band to the other. That is
//! what the velocities v_y = ∫₀^y g_y dη and v_x = x·g_x(y) do to a leaf when the rates g belong to
//! the tissue: they are compatible (no gap, no overlap) whatever the rates, and the axis stays straight.
//!
//! The map J of its derivatives is [w, x·w′; 0, e]: distances are those of the current leaf, |Jᵀ J| for
//! neighbours, and no tissue has to be carried along.

use glam::DVec2;

use crate::geometry::Rect;

/// Scales by band, relative to the mature leaf.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Warp {
    /// Where the bands begin, and how high each is.
    bottom: f64,
    height: f64,
    /// Scale across at the edges of the bands.
    across: Vec<f64>,
    /// Scale along in each band.
    along: Vec<f64>,
    /// Where the edges of the bands lie.
    edges: Vec<f64>,
}

impl Warp {
    /// Bands of equal height from `bottom` up: `across` at their edges, `along` in each. The base of
    /// the blade (y = 0) stays where it is. Scales are above zero.
    pub(super) fn new(bottom: f64, height: f64, across: Vec<f64>, along: Vec<f64>) -> Self {
        debug_assert_eq!(across.len(), along.len() + 1);
        let mut edges = vec![0.0; across.len()];
        for (i, scale) in along.iter().enumerate() {
            edges[i + 1] = edges[i] + scale * height;
        }
        let mut warp = Self { bottom, height, across, along, edges };
        let base = warp.place(DVec2::ZERO).y;
        warp.edges.iter_mut().for_each(|y| *y -= base);
        warp
    }

    /// The band a height is in, and how far up in it (in bands, beyond 0–1 outside of all).
    #[inline]
    fn band(&self, y: f64) -> (usize, f64) {
        let at = (y - self.bottom) / self.height;
        let band = (at.max(0.0) as usize).min(self.along.len() - 1);
        (band, at - band as f64)
    }

    #[inline]
    fn across_at(&self, (band, up): (usize, f64)) -> f64 {
        let (low, high) = (self.across[band], self.across[band + 1]);
        low + (high - low) * up.clamp(0.0, 1.0)
    }

    #[inline]
    pub(super) fn place(&self, p: DVec2) -> DVec2 {
        let at = self.band(p.y);
        let y = self.edges[at.0] + at.1 * (self.height * self.along[at.0]);
        DVec2::new(p.x * self.across_at(at), y)
    }

    /// The point of the mature leaf that lies there.
    pub(super) fn unplace(&self, q: DVec2) -> DVec2 {
        let up = self.height_of(q.y);
        DVec2::new(q.x / self.across_at(self.band(up)), up)
    }

    fn height_of(&self, y: f64) -> f64 {
        let after = self.edges.partition_point(|edge| *edge <= y);
        let band = after.saturating_sub(1).min(self.along.len() - 1);
        let up = (y - self.edges[band]) / self.along[band];
        self.bottom + band as f64 * self.height + up
    }

    pub(super) fn mean_stretch(&self) -> DVec2 {
        let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
        DVec2::new(mean(&self.across), mean(&self.along))
    }

    /// The scales across and along between two heights: the least across, the greatest, the least
    /// along, and the steepest change of the scale across.
    fn between(&self, low: f64, high: f64) -> (f64, f64, f64, f64) {
        let (first, last) = (self.band(low), self.band(high));
        let (a, b) = (self.across_at(first), self.across_at(last));
        let (mut least, mut most) = (a.min(b), a.max(b));
        let (mut least_along, mut steepest) = (f64::INFINITY, 0.0f64);
        for band in first.0..=last.0 {
            if band > first.0 {
                (least, most) = (least.min(self.across[band]), most.max(self.across[band]));
            }
            least_along = least_along.min(self.along[band]);
            let change = (self.across[band + 1] - self.across[band]).abs() / self.height;
            steepest = steepest.max(change);
        }
        (least, most, least_along, steepest)
    }

    pub(super) fn around(&self, p: DVec2, measure: f64) -> DVec2 {
        if !measure.is_finite() {
            return DVec2::splat(measure);
        }
        let q = self.place(p);
        let (low, high) = (self.height_of(q.y - measure), self.height_of(q.y + measure));
        let (least, most, ..) = self.between(low, high);
        // The ends of the circle, at whichever scale takes them farthest out.
        let (left, right) = (q.x - measure, q.x + measure);
        let left = (left / least).min(left / most);
        let right = (right / least).max(right / most);
        let half = DVec2::new((p.x - left).max(right - p.x), (p.y - low).max(high - p.y));
        // Rounding must not lose what lies on the circle.
        half * (1.0 + 1e-9)
    }

    /// A point as far away along lies at least as far as the bands between; one as far away across
    /// at least |Δx|·w less what the change of w moves x on the way up, and that way is itself no
    /// longer than the distance over the scale along.
    pub(super) fn clearance(&self, p: DVec2, distance: f64) -> f64 {
        let (low, high) = (p.y - distance, p.y + distance);
        let y = |up: f64| self.place(DVec2::new(0.0, up)).y;
        let along = (y(high) - y(p.y)).min(y(p.y) - y(low));
        let (least, _, least_along, steepest) = self.between(low, high);
        let across = distance * least / (1.0 + p.x.abs() * steepest / least_along);
        along.min(across) * (1.0 - 1e-9)
    }

    /// The corners of a box around the image of another.
    pub(super) fn corners(&self, rect: Rect) -> (DVec2, DVec2) {
        let (least, most, ..) = self.between(rect.min.y, rect.max.y);
        let y = |up: f64| self.place(DVec2::new(0.0, up)).y;
        let left = (rect.min.x * least).min(rect.min.x * most);
        let right = (rect.max.x * least).max(rect.max.x * most);
        (DVec2::new(left, y(rect.min.y)), DVec2::new(right, y(rect.max.y)))
    }

    pub(super) fn area_scale(&self, p: DVec2) -> f64 {
        let at = self.band(p.y);
        self.across_at(at) * self.along[at.0]
    }

    pub(super) fn greatest_area_scale(&self) -> f64 {
        let edges = self.across.windows(2).map(|pair| pair[0].max(pair[1]));
        edges.zip(&self.along).map(|(across, along)| across * along).fold(0.0, f64::max)
    }

    /// The smallest scale anywhere.
    pub(super) fn least_scale(&self) -> f64 {
        self.across.iter().chain(&self.along).copied().fold(f64::INFINITY, f64::min)
    }
}
