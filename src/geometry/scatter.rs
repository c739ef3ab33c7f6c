//! Points scattered over an area: pure functions of uniform numbers.

use super::{DVec2, polygon};

/// Uniformly distributed points in a polygon, each from two numbers in [0, 1).
///
/// The polygon is cut into trapezoids with horizontal sides; the first number picks one by area and
/// the height in it, the second the place across. Nothing is thrown away, so a thin polygon costs no
/// more than a round one.
#[derive(Debug, Clone)]
pub struct PolygonScatter {
    trapezoids: Vec<Trapezoid>,
    /// Area up to the end of each trapezoid.
    cumulated: Vec<f64>,
}

/// Between two heights, from a left to a right edge.
#[derive(Debug, Clone, Copy)]
struct Trapezoid {
    low: f64,
    high: f64,
    /// Left and right end at the low side, then at the high side.
    ends: [f64; 4],
}

impl PolygonScatter {
    /// Over the inside (even-odd rule) of a simple polygon. Quadratic in the number of vertices at
    /// worst, near-linear for leaves.
    #[must_use]
    pub fn new(outline: &[DVec2]) -> Self {
        let mut heights: Vec<f64> = outline.iter().map(|p| p.y).collect();
        heights.sort_by(f64::total_cmp);
        heights.dedup();
        let (mut trapezoids, mut cumulated, mut area) = (Vec::new(), Vec::new(), 0.0);
        for strip in heights.windows(2) {
            let (low, high) = (strip[0], strip[1]);
            let middle = low.midpoint(high);
            let across = |a: DVec2, b: DVec2, y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y));
            let mut sides: Vec<[f64; 3]> = polygon::edges(outline)
                .filter(|(a, b)| (a.y > middle) != (b.y > middle))
                .map(|(a, b)| [across(a, b, middle), across(a, b, low), across(a, b, high)])
                .collect();
            sides.sort_by(|a, b| a[0].total_cmp(&b[0]));
            for pair in sides.chunks_exact(2) {
                let ends = [pair[0][1], pair[1][1], pair[0][2], pair[1][2]];
                area += (pair[1][0] - pair[0][0]) * (high - low);
                trapezoids.push(Trapezoid { low, high, ends });
                cumulated.push(area);
            }
        }
        Self { trapezoids, cumulated }
    }

    /// The point for two numbers in [0, 1).
    #[must_use]
    pub fn point(&self, u: f64, v: f64) -> DVec2 {
        let Some(&total) = self.cumulated.last() else { return DVec2::ZERO };
        let wanted = u * total;
        let i =
            self.cumulated.partition_point(|&area| area <= wanted).min(self.trapezoids.len() - 1);
        let before = if i == 0 { 0.0 } else { self.cumulated[i - 1] };
        let share = ((wanted - before) / (self.cumulated[i] - before)).clamp(0.0, 1.0);
        let Trapezoid { low, high, ends: [left0, right0, left1, right1] } = self.trapezoids[i];
        // The width runs linearly from w₀ to w₁: invert the quadratic of the area below, in the form
        // that does not cancel when the widths are equal.
        let (w0, w1) = (right0 - left0, right1 - left1);
        let root = (w0 * w0 + share * (w1 * w1 - w0 * w0)).max(0.0).sqrt();
        let t = if w0 + root > 0.0 { share * (w0 + w1) / (w0 + root) } else { 0.0 };
        let t = t.clamp(0.0, 1.0);
        let (left, right) = (left0 + t * (left1 - left0), right0 + t * (right1 - right0));
        DVec2::new(left + v * (right - left), low + t * (high - low))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn points_fill_every_part_of_a_concave_polygon_by_its_area() {
        // An L: three unit squares.
        let outline = [(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)].map(DVec2::from);
        let scatter = PolygonScatter::new(&outline);
        let mut rng = Seed(2).stream(Stage::AuxinSources);
        let mut counts = [0u32; 4];
        for _ in 0..30_000 {
            let p = scatter.point(rng.unit(), rng.unit());
            counts[(p.y as usize) * 2 + p.x as usize] += 1;
        }
        assert_eq!(counts[3], 0);
        assert!(counts[..3].iter().all(|&n| (9_700..10_300).contains(&n)), "{counts:?}");
    }

    #[test]
    fn heights_in_a_triangle_follow_its_width() {
        let outline = [(-1., 0.), (1., 0.), (0., 1.)].map(DVec2::from);
        let scatter = PolygonScatter::new(&outline);
        // The share of area below height h is 1 − (1 − h)².
        for share in [0.0, 0.1, 0.5, 0.9] {
            let y = scatter.point(share, 0.3).y;
            assert!((1.0 - (1.0 - y) * (1.0 - y) - share).abs() < 1e-12, "{share}: {y}");
        }
    }
}
