//! How much of a pixel a shape covers: exactly for polygons, by a window across for strokes.
//!
//! Polygons: signed areas accumulated along rows, as in R. Levien's font-rs: every edge adds, to
//! the pixels it passes, the area to its right; a running sum over the row is the coverage. Exact
//! for any polygon that does not cross itself, so the sum over the picture is the polygon's area.
//!
//! Strokes are capsules: a segment with a radius at either end, the radius linear between.

use std::ops::Range;

use glam::{DVec2, Vec2};

/// The share of every pixel of some rows, `width` pixels each, that lies inside a simple polygon.
/// Pixel coordinates, y down; either winding.
#[must_use]
pub fn polygon_rows(polygon: &[DVec2], width: usize, rows: Range<usize>) -> Vec<f32> {
    let stride = width + 2;
    let mut areas = vec![0.0_f32; stride * rows.len()];
    let (top, bottom) = (rows.start as f64, rows.end as f64);
    for (a, b) in crate::geometry::polygon::edges(polygon) {
        let (sign, upper, lower) = if a.y < b.y { (1.0, a, b) } else { (-1.0, b, a) };
        if lower.y <= top || upper.y >= bottom || lower.y == upper.y {
            continue;
        }
        let slope = (lower.x - upper.x) / (lower.y - upper.y);
        let x_at = |y: f64| upper.x + (y - upper.y) * slope;
        let mut y = upper.y.max(top);
        let end = lower.y.min(bottom);
        while y < end {
            let row = y as usize;
            let next = ((row + 1) as f64).min(end);
            let start = (row - rows.start) * stride;
            let cells = &mut areas[start..start + stride];
            add_edge(cells, width as f64, x_at(y), x_at(next), sign * (next - y));
            y = next;
        }
    }
    let mut covers = Vec::with_capacity(width * rows.len());
    for cells in areas.chunks_exact(stride) {
        let mut sum = 0.0_f32;
        covers.extend(cells[..width].iter().map(|cell| {
            sum += cell;
            settled(sum.abs())
        }));
    }
    covers
}

/// Sums that should be 0 or 1 miss it by rounding; what is smaller than this is rounding.
fn settled(cover: f32) -> f32 {
    const ROUNDING: f32 = 2e-5;
    if cover < ROUNDING {
        0.0
    } else if cover > 1.0 - ROUNDING {
        1.0
    } else {
        cover
    }
}

/// Adds an edge that runs from `xa` to `xb` over the height `dy` of one row (signed).
fn add_edge(cells: &mut [f32], width: f64, xa: f64, xb: f64, dy: f64) {
    let (left, right) = if xa < xb { (xa, xb) } else { (xb, xa) };
    if left >= width {
        return;
    }
    // Left of the picture an edge counts as standing on its border.
    if right <= 0.0 {
        cells[0] += dy as f32;
        return;
    }
    if right - left < 1e-9 {
        let i = left.max(0.0) as usize;
        let inside = left.max(0.0) - i as f64;
        cells[i] += (dy * (1.0 - inside)) as f32;
        cells[i + 1] += (dy * inside) as f32;
        return;
    }
    let per_x = dy / (right - left);
    if left < 0.0 {
        cells[0] += (-left * per_x) as f32;
    }
    let (mut x, end) = (left.max(0.0), right.min(width));
    while x < end {
        let i = x as usize;
        let next = ((i + 1) as f64).min(end);
        let part = (next - x) * per_x;
        let inside = (x + next) * 0.5 - i as f64;
        cells[i] += (part * (1.0 - inside)) as f32;
        cells[i + 1] += (part * inside) as f32;
        x = next;
    }
}

/// A tapered stroke: a segment with a radius at either end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capsule {
    /// One end.
    pub a: Vec2,
    /// The other end.
    pub b: Vec2,
    /// Radius at `a`.
    pub radius_a: f32,
    /// Radius at `b`.
    pub radius_b: f32,
}

impl Capsule {
    /// The squared distance from `p` to the axis, and where along it the nearest point lies (0–1).
    #[must_use]
    #[inline]
    pub fn nearest(&self, p: Vec2) -> (f32, f32) {
        let along = self.b - self.a;
        let to = p - self.a;
        let length2 = along.length_squared();
        let t = if length2 > 0.0 { (to.dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
        ((to - along * t).length_squared(), t)
    }

    /// The radius at `t` (0–1).
    #[must_use]
    #[inline]
    pub fn radius(&self, t: f32) -> f32 {
        self.radius_a + (self.radius_b - self.radius_a) * t
    }

    /// The greater of the two radii.
    #[must_use]
    pub fn widest(&self) -> f32 {
        self.radius_a.max(self.radius_b)
    }

    /// The columns and rows of a picture whose pixel centres lie in the box that reaches `reach`
    /// beyond the axis; `self` is in pixels.
    #[must_use]
    pub fn pixels(&self, reach: f32, width: usize, rows: Range<usize>) -> [Range<usize>; 2] {
        let low = self.a.min(self.b) - Vec2::splat(reach + 0.5);
        let high = self.a.max(self.b) + Vec2::splat(reach + 0.5);
        // Saturating casts: a box that starts left of the picture starts at 0.
        let clip = |low: f32, high: f32, range: Range<usize>| {
            let start = (low.max(0.0) as usize).max(range.start);
            start..((high.max(0.0) as usize + 1).min(range.end)).max(start)
        };
        [clip(low.x, high.x, 0..width), clip(low.y, high.y, rows)]
    }
}

/// The share of a window of half-width `half`, at `distance` from the axis of a long stroke of
/// radius `radius`, that the stroke fills. Strokes thinner than the window fade, not vanish.
#[must_use]
#[inline(always)]
pub fn stroke_share(distance: f32, radius: f32, half: f32) -> f32 {
    let (far, near) = (distance + half, distance - half);
    // Not `min` and `max`, which ask for what is not a number.
    let end = if far < radius { far } else { radius };
    let overlap = end - if near > -radius { near } else { -radius };
    (overlap / (2.0 * half)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::signed_area;

    fn star(points: usize) -> Vec<DVec2> {
        (0..2 * points)
            .map(|i| {
                let r = if i % 2 == 0 { 29.3 } else { 13.7 };
                let angle = i as f64 * std::f64::consts::PI / points as f64 + 0.1;
                DVec2::new(32.1 + r * angle.cos(), 31.6 + r * angle.sin())
            })
            .collect()
    }

    #[test]
    fn coverage_sums_to_the_area() {
        for points in [3, 4, 7, 19] {
            let polygon = star(points);
            let sum: f64 =
                polygon_rows(&polygon, 64, 0..64).iter().map(|&cover| f64::from(cover)).sum();
            let area = signed_area(&polygon).abs();
            assert!((sum - area).abs() < 1e-3 * area, "{points}: {sum} {area}");
        }
    }

    #[test]
    fn a_half_covered_pixel_says_so() {
        let corners = [(1.5, 1.0), (3.0, 1.0), (3.0, 2.25), (1.5, 2.25)];
        let polygon: Vec<DVec2> = corners.map(DVec2::from).to_vec();
        let covers = polygon_rows(&polygon, 4, 0..4);
        assert_eq!(&covers[4..8], &[0.0, 0.5, 1.0, 0.0]);
        assert_eq!(&covers[8..12], &[0.0, 0.125, 0.25, 0.0]);
    }

    #[test]
    fn bands_of_rows_and_shapes_beyond_the_picture_agree_with_the_whole() {
        let polygon: Vec<DVec2> = star(9).iter().map(|p| *p - DVec2::new(20.0, 9.0)).collect();
        let whole = polygon_rows(&polygon, 33, 0..64);
        let banded: Vec<f32> =
            (0..8).flat_map(|i| polygon_rows(&polygon, 33, i * 8..(i + 1) * 8)).collect();
        assert_eq!(whole, banded);
        assert!(whole.iter().all(|&cover| (0.0..=1.0).contains(&cover)));
    }

    #[test]
    fn a_thin_stroke_fades_by_its_width() {
        assert!((stroke_share(0.0, 0.1, 0.5) - 0.2).abs() < 1e-6);
        assert!((stroke_share(0.4, 3.0, 0.5) - 1.0).abs() < 1e-6);
        assert!((stroke_share(3.0, 3.0, 0.5) - 0.5).abs() < 1e-6);
        assert_eq!(stroke_share(4.0, 3.0, 0.5), 0.0);
    }
}
