//! Outlines as they come from files and pictures, thinned and mended before they become margins.

use glam::DVec2;

use super::silhouette::Traced;
use crate::geometry::polygon;

/// Outlines of more points than this are thinned: 8192 texels show no more.
const MANY_POINTS: usize = 16_384;

/// Drops points that crowd, and says so.
pub fn thin(traced: &mut Traced) {
    let outline = &mut traced.outline;
    if outline.len() > MANY_POINTS {
        let given = outline.len();
        let least = polygon::perimeter(outline) / MANY_POINTS as f64;
        *outline = polygon::without_short_edges(outline, least);
        traced.notes.push(format!("{given} points thinned to {}", outline.len()));
    }
}

/// The polygon without its loops, when they are small: a crossing pair of edges is replaced by the
/// larger of the two polygons that it makes, up to `MOST_LOOPS` times.
#[must_use]
pub fn without_loops(outline: &[DVec2]) -> Option<Vec<DVec2>> {
    const MOST_LOOPS: usize = 16;
    const MOST_POINTS: usize = 4000;
    /// All loops together may have this share of the area.
    const MOST_LOST: f64 = 0.02;
    if outline.len() > MOST_POINTS {
        return None;
    }
    let whole = polygon::signed_area(outline).abs();
    let mut rest = outline.to_vec();
    for _ in 0..MOST_LOOPS {
        let n = rest.len();
        let crossing = (0..n).find_map(|i| {
            let (a, b) = (rest[i], rest[(i + 1) % n]);
            (i + 2..n).filter(|&j| (j + 1) % n != i).find_map(|j| {
                let (c, d) = (rest[j], rest[(j + 1) % n]);
                polygon::segments_touch(a, b, c, d).then(|| {
                    let (u, v) = ((b - a).perp_dot(c - a), (b - a).perp_dot(d - a));
                    let p = if u == v { c } else { c.lerp(d, (u / (u - v)).clamp(0.0, 1.0)) };
                    (i, j, p)
                })
            })
        });
        let Some((i, j, p)) = crossing else { break };
        let mut inner = vec![p];
        inner.extend_from_slice(&rest[i + 1..=j]);
        let mut outer = rest[..=i].to_vec();
        outer.push(p);
        outer.extend_from_slice(&rest[j + 1..]);
        let area = |polygon: &[DVec2]| polygon::signed_area(polygon).abs();
        rest = if area(&inner) > area(&outer) { inner } else { outer };
        rest.dedup();
    }
    let kept = polygon::signed_area(&rest).abs();
    let small = (whole - kept).abs() <= MOST_LOST * whole.max(kept);
    (rest.len() > 3 && small && polygon::self_crossing(&rest).is_none()).then_some(rest)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_loop_is_cut_off_and_a_large_one_is_not() {
        let circle = |n: usize| {
            (0..n)
                .map(move |i| DVec2::from_angle(std::f64::consts::TAU * i as f64 / n as f64) * 10.0)
        };
        let mut points: Vec<DVec2> = circle(60).collect();
        points.swap(10, 11);
        assert!(polygon::self_crossing(&points).is_some());
        let mended = without_loops(&points).expect("a small loop");
        assert_eq!(polygon::self_crossing(&mended), None);
        let eight: Vec<DVec2> = (0..60)
            .map(|i| std::f64::consts::TAU * (f64::from(i) + 0.3) / 60.0)
            .map(|t| DVec2::new(t.sin(), (2.0 * t).sin()))
            .collect();
        assert_eq!(without_loops(&eight), None);
    }
}
