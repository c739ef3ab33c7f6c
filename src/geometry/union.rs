//! Polygons put together; the only file that names i_overlay.

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::float::single::SingleFloatOverlay;

use super::DVec2;

/// The rings around all that lies within `rings` (anticlockwise around what is inside, clockwise around gaps) or
/// within `polygon`: each outline, followed by its gaps.
///
/// Corners are rounded to a billionth of the box around all, and more where lines cross.
#[must_use]
pub fn united(rings: &[Vec<DVec2>], polygon: &[DVec2]) -> Vec<Vec<DVec2>> {
    let contour = |ring: &[DVec2]| ring.iter().map(|p| p.to_array()).collect::<Vec<[f64; 2]>>();
    let subject: Vec<_> = rings.iter().map(|ring| contour(ring)).collect();
    let shapes =
        subject.overlay_as::<i64>(&contour(polygon), OverlayRule::Union, FillRule::NonZero);
    let points = |ring: Vec<[f64; 2]>| ring.into_iter().map(DVec2::from).collect();
    shapes.into_iter().flatten().map(points).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::signed_area;

    fn square(x: f64, y: f64, side: f64) -> Vec<DVec2> {
        [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]
            .map(|(u, v)| DVec2::new(x + side * u, y + side * v))
            .to_vec()
    }

    #[test]
    fn overlapping_polygons_become_one_and_gaps_stay() {
        let mut gap = square(1.0, 1.0, 1.0);
        gap.reverse();
        let united = united(&[square(0.0, 0.0, 4.0), gap], &square(3.0, 3.0, 4.0));
        let areas: Vec<f64> = united.iter().map(|ring| signed_area(ring)).collect();
        assert_eq!(areas.len(), 2, "{areas:?}");
        assert!((areas[0] - (16.0 + 16.0 - 1.0)).abs() < 1e-6, "{areas:?}");
        assert!((areas[1] + 1.0).abs() < 1e-6, "{areas:?}");
    }

    #[test]
    fn what_lies_apart_stays_apart() {
        assert_eq!(united(&[square(0.0, 0.0, 1.0)], &square(3.0, 0.0, 1.0)).len(), 2);
        assert_eq!(united(&[square(0.0, 0.0, 4.0)], &square(1.0, 1.0, 1.0)).len(), 1, "inside");
    }
}
