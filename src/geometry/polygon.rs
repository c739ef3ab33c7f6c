//! Simple closed polygons: area, winding, containment, crossings, resampling.
//!
//! A polygon is a slice of vertices; the first is not repeated at the end. Every function is total
//! on finite input and linear in the number of vertices, unless it says otherwise.

use super::{DVec2, chains, segments::SegmentIndex};

/// Twice the signed area of the triangle a, b, c: positive when they turn anticlockwise.
#[must_use]
pub fn cross(a: DVec2, b: DVec2, c: DVec2) -> f64 {
    (b - a).perp_dot(c - a)
}

/// The area, positive when the vertices run anticlockwise (y up).
#[must_use]
pub fn signed_area(polygon: &[DVec2]) -> f64 {
    // Relative to the first vertex: far from the origin the terms would cancel badly.
    let Some(&origin) = polygon.first() else { return 0.0 };
    edges(polygon).map(|(a, b)| (a - origin).perp_dot(b - origin)).sum::<f64>() * 0.5
}

/// The centre of mass of the area; the mean of the vertices when there is no area.
#[must_use]
pub fn centroid(polygon: &[DVec2]) -> DVec2 {
    let Some(&origin) = polygon.first() else { return DVec2::ZERO };
    let (mut sum, mut area) = (DVec2::ZERO, 0.0);
    for (a, b) in edges(polygon) {
        let (a, b) = (a - origin, b - origin);
        let doubled = a.perp_dot(b);
        area += doubled;
        sum += (a + b) * doubled;
    }
    if area.abs() < 1e-300 {
        return polygon.iter().sum::<DVec2>() / polygon.len() as f64;
    }
    origin + sum / (3.0 * area)
}

/// The edges, the last one back to the first vertex.
pub fn edges(polygon: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    (0..polygon.len()).map(|i| (polygon[i], polygon[(i + 1) % polygon.len()]))
}

/// The length of the boundary.
#[must_use]
pub fn perimeter(polygon: &[DVec2]) -> f64 {
    edges(polygon).map(|(a, b)| a.distance(b)).sum()
}

/// Whether `p` lies inside, by the even-odd rule. Points on the boundary may go either way.
#[must_use]
pub fn contains(polygon: &[DVec2], p: DVec2) -> bool {
    edges(polygon).filter(|&(a, b)| crosses_ray(a, b, p)).count() % 2 == 1
}

/// Whether the edge a–b crosses the ray from `p` towards +x.
pub(super) fn crosses_ray(a: DVec2, b: DVec2, p: DVec2) -> bool {
    (a.y > p.y) != (b.y > p.y) && p.x < (b.x - a.x) * (p.y - a.y) / (b.y - a.y) + a.x
}

/// The point of the segment a–b nearest to `p`.
#[must_use]
pub fn nearest_on_segment(a: DVec2, b: DVec2, p: DVec2) -> DVec2 {
    let along = b - a;
    let length2 = along.length_squared();
    if length2 == 0.0 {
        return a;
    }
    a + along * ((p - a).dot(along) / length2).clamp(0.0, 1.0)
}

/// Whether the segments a–b and c–d touch, ends included.
#[must_use]
pub fn segments_touch(a: DVec2, b: DVec2, c: DVec2, d: DVec2) -> bool {
    // Pieces of one straight line lie by rounding on any side of each other, however far apart.
    if a.max(b).cmplt(c.min(d)).any() || c.max(d).cmplt(a.min(b)).any() {
        return false;
    }
    let (d1, d2) = (cross(a, b, c), cross(a, b, d));
    let (d3, d4) = (cross(c, d, a), cross(c, d, b));
    if d1 * d2 < 0.0 && d3 * d4 < 0.0 {
        return true;
    }
    let within = |a: DVec2, b: DVec2, p: DVec2| p.cmpge(a.min(b)).all() && p.cmple(a.max(b)).all();
    (d1 == 0.0 && within(a, b, c))
        || (d2 == 0.0 && within(a, b, d))
        || (d3 == 0.0 && within(c, d, a))
        || (d4 == 0.0 && within(c, d, b))
}

/// Whether the segments a–b and c–d touch or come as near as `gap`; some count that stay up to √2 times as far
/// apart.
#[must_use]
pub fn segments_near(a: DVec2, b: DVec2, c: DVec2, d: DVec2, gap: f64) -> bool {
    let boxes_part =
        (a.min(b) - gap).cmpgt(c.max(d)).any() || (c.min(d) - gap).cmpgt(a.max(b)).any();
    // Whether c–d lies on one side of the line through a and b, farther from it than the gap.
    let parts = |a: DVec2, b: DVec2, c: DVec2, d: DVec2| {
        // No shorter than the segment, and quicker than its length.
        let along = (b - a).abs().element_sum();
        let (e, f) = (cross(a, b, c), cross(a, b, d));
        e.min(f) > gap * along || e.max(f) < -gap * along
    };
    !(boxes_part || parts(a, b, c, d) || parts(c, d, a, b))
}

/// Whether a polygon never turns clockwise. Straight stretches of a sampled curve turn by rounding,
/// which is far below the tolerance.
#[must_use]
pub fn is_convex(polygon: &[DVec2]) -> bool {
    let n = polygon.len();
    let turns_left = |i: usize| {
        let (a, b, c) = (polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]);
        cross(a, b, c) >= -1e-12 * a.distance(b) * b.distance(c)
    };
    (0..n).all(turns_left)
}

/// Where the outline first touches itself, neighbours at their shared vertex excepted; `None` when
/// it is simple. Near-linear for outlines of even edges, and quicker still for smooth simple ones.
#[must_use]
pub fn self_crossing(polygon: &[DVec2]) -> Option<DVec2> {
    if chains::touching(polygon) == Some(false) {
        return None;
    }
    let index = SegmentIndex::of_polygon(polygon);
    (0..polygon.len()).find_map(|i| {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        let hit = index.any_near(a, b, |j| edges_touch(polygon, i, j));
        hit.then(|| (a + b) * 0.5)
    })
}

/// The pairs of edges that touch, as [`self_crossing`] understands it; the smaller index first.
#[must_use]
pub fn crossings(polygon: &[DVec2]) -> Vec<(usize, usize)> {
    let index = SegmentIndex::of_polygon(polygon);
    let mut pairs = Vec::new();
    for i in 0..polygon.len() {
        let (a, b) = (polygon[i], polygon[(i + 1) % polygon.len()]);
        index.any_near(a, b, |j| {
            if edges_touch(polygon, i, j) {
                pairs.push((i.min(j), i.max(j)));
            }
            false
        });
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// Whether two edges touch; neighbours only when one folds back on the other.
pub(super) fn edges_touch(polygon: &[DVec2], i: usize, j: usize) -> bool {
    let n = polygon.len();
    if j == i {
        return false;
    }
    let (a, b) = (polygon[i], polygon[(i + 1) % n]);
    let (c, d) = (polygon[j], polygon[(j + 1) % n]);
    if j == (i + 1) % n {
        // Neighbours share b; they overlap only when the second folds back on the first.
        return cross(a, b, d) == 0.0 && (d - b).dot(a - b) > 0.0;
    }
    if i == (j + 1) % n {
        return cross(c, d, b) == 0.0 && (b - a).dot(c - a) > 0.0;
    }
    segments_touch(a, b, c, d)
}

/// The corners of the convex hull of some points, anticlockwise (Andrew's monotone chain, 1979).
#[must_use]
pub fn convex_hull(points: &[DVec2]) -> Vec<DVec2> {
    let mut sorted = points.to_vec();
    sorted.sort_unstable_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    sorted.dedup();
    if sorted.len() < 3 {
        return sorted;
    }
    let chain = |points: &mut dyn Iterator<Item = DVec2>| {
        let mut hull: Vec<DVec2> = Vec::new();
        for p in points {
            while let [.., a, b] = hull[..]
                && cross(a, b, p) <= 0.0
            {
                hull.pop();
            }
            hull.push(p);
        }
        hull.pop();
        hull
    };
    let mut hull = chain(&mut sorted.iter().copied());
    hull.extend(chain(&mut sorted.iter().rev().copied()));
    hull
}

/// Points along the boundary at equal steps of at most `step`, starting at vertex 0.
#[must_use]
pub fn resampled(polygon: &[DVec2], step: f64) -> Vec<DVec2> {
    let total = perimeter(polygon);
    let count = ((total / step).ceil() as usize).max(3);
    let spacing = total / count as f64;
    let mut points = Vec::with_capacity(count);
    let (mut walked, mut next) = (0.0, 0.0);
    for (a, b) in edges(polygon) {
        let length = a.distance(b);
        while points.len() < count && next < walked + length {
            points.push(a.lerp(b, (next - walked) / length));
            next = spacing * points.len() as f64;
        }
        walked += length;
    }
    points
}

/// The same boundary with points added on its edges, so that none is longer than `longest`.
#[must_use]
pub fn subdivided(polygon: &[DVec2], longest: f64) -> Vec<DVec2> {
    edges(polygon).flat_map(|(a, b)| pieces(a, b, longest)).collect()
}

/// Points from `a` to before `b`, no two farther apart than `longest`.
pub fn pieces(a: DVec2, b: DVec2, longest: f64) -> impl Iterator<Item = DVec2> {
    let n = (a.distance(b) / longest).ceil().max(1.0) as usize;
    (0..n).map(move |i| a.lerp(b, i as f64 / n as f64))
}

/// The polygon without vertices that follow another within `least` (the last against the first
/// too). Vertex 0 always stays.
#[must_use]
pub fn without_short_edges(polygon: &[DVec2], least: f64) -> Vec<DVec2> {
    let mut kept: Vec<DVec2> = Vec::with_capacity(polygon.len());
    for &p in polygon {
        if kept.last().is_none_or(|last| last.distance(p) >= least) {
            kept.push(p);
        }
    }
    while kept.len() > 1 && kept[0].distance(kept[kept.len() - 1]) < least {
        kept.pop();
    }
    kept
}

/// Douglas–Peucker: a polygon through some of the vertices that stays within `tolerance` of the
/// boundary. Vertices listed in `keep` stay. Quadratic in the worst case.
#[must_use]
pub fn simplified(polygon: &[DVec2], tolerance: f64, keep: &[usize]) -> Vec<usize> {
    let n = polygon.len();
    let mut anchors: Vec<usize> = keep.to_vec();
    anchors.push(0);
    let far = (0..n).max_by(|&i, &j| {
        polygon[i].distance_squared(polygon[0]).total_cmp(&polygon[j].distance_squared(polygon[0]))
    });
    anchors.extend(far);
    anchors.sort_unstable();
    anchors.dedup();
    let mut kept = vec![false; n];
    let mut open: Vec<(usize, usize)> = Vec::new();
    for (k, &start) in anchors.iter().enumerate() {
        kept[start] = true;
        open.push((start, anchors.get(k + 1).copied().unwrap_or(anchors[0] + n)));
    }
    while let Some((start, end)) = open.pop() {
        let (a, b) = (polygon[start], polygon[end % n]);
        let worst = (start + 1..end)
            .map(|i| (polygon[i % n].distance(nearest_on_segment(a, b, polygon[i % n])), i))
            .max_by(|x, y| x.0.total_cmp(&y.0));
        if let Some((distance, i)) = worst
            && distance > tolerance
        {
            kept[i % n] = true;
            open.push((start, i));
            open.push((i, end));
        }
    }
    (0..n).filter(|&i| kept[i]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Vec<DVec2> {
        [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)].map(DVec2::from).to_vec()
    }

    #[test]
    fn pieces_of_a_straight_line_touch_only_their_neighbours() {
        // Off straight by rounding: each seems to lie across the other.
        for turn in 0..200 {
            let ahead = DVec2::from_angle(f64::from(turn) * 0.0317) * 0.26154;
            let from = DVec2::new(4.360839171917715e-6, 8.902829793505502e-5);
            let points: Vec<DVec2> = (0..40).map(|i| from + ahead * f64::from(i)).collect();
            for (i, a) in points.windows(2).enumerate() {
                for b in points[i + 1..].windows(2).skip(1) {
                    assert!(!segments_touch(a[0], a[1], b[0], b[1]), "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn a_square_has_its_area_centroid_and_perimeter() {
        assert_eq!(signed_area(&square()), 4.0);
        assert_eq!(centroid(&square()), DVec2::ONE);
        assert_eq!(perimeter(&square()), 8.0);
        let clockwise: Vec<_> = square().into_iter().rev().collect();
        assert_eq!(signed_area(&clockwise), -4.0);
    }

    #[test]
    fn segments_are_near_when_their_distance_says_so() {
        let mut rng = crate::seed::Seed(3).stream(crate::seed::Stage::Guides);
        let (mut near, mut far) = (0, 0);
        for _ in 0..20_000 {
            let [a, b, c, d] = [(); 4].map(|()| DVec2::new(rng.unit(), rng.unit()));
            let ends = [(a, b, c), (a, b, d), (c, d, a), (c, d, b)];
            let apart = ends.map(|(a, b, p)| nearest_on_segment(a, b, p).distance(p));
            let apart = apart.into_iter().fold(f64::INFINITY, f64::min);
            if segments_touch(a, b, c, d) || apart <= 0.05 {
                near += 1;
                assert!(segments_near(a, b, c, d, 0.05), "{a} {b} {c} {d}");
            } else if apart > 0.05 * 1.42 {
                far += 1;
                assert!(!segments_near(a, b, c, d, 0.05), "{a} {b} {c} {d}");
            }
        }
        assert!(near > 5000 && far > 5000, "{near} {far}");
    }

    #[test]
    fn a_bow_tie_crosses_itself_and_a_square_does_not() {
        let tie = [(0.0, 0.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)].map(DVec2::from);
        assert!(self_crossing(&tie).is_some());
        assert_eq!(self_crossing(&square()), None);
    }

    #[test]
    fn a_fold_back_on_itself_is_a_crossing() {
        let spike = [(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (2.0, 1.0), (0.0, 2.0)].map(DVec2::from);
        assert!(self_crossing(&spike).is_some());
    }

    #[test]
    fn resampling_keeps_equal_steps_on_the_boundary() {
        let points = resampled(&square(), 0.3);
        assert_eq!(points.len(), 27);
        assert!(points.iter().all(|p| (p.x * (2.0 - p.x) * p.y * (2.0 - p.y)).abs() < 1e-12));
    }

    #[test]
    fn subdividing_keeps_the_vertices_and_shortens_the_edges() {
        let points = subdivided(&square(), 0.7);
        assert_eq!(points.len(), 12);
        assert!(square().iter().all(|corner| points.contains(corner)));
        assert!(edges(&points).all(|(a, b)| a.distance(b) <= 0.7));
    }

    #[test]
    fn simplifying_keeps_corners_and_drops_the_rest() {
        let dense = resampled(&square(), 0.25);
        let kept = simplified(&dense, 1e-9, &[]);
        assert_eq!(kept.len(), 4);
    }

    #[test]
    fn a_hull_has_the_corners_and_nothing_else() {
        let mut points = resampled(&square(), 0.3);
        points.extend([DVec2::new(1.0, 1.2), DVec2::new(0.4, 1.9)]);
        points.extend(square());
        assert_eq!(convex_hull(&points), square());
    }

    #[test]
    fn short_edges_go_also_across_the_seam() {
        let mut points = square();
        points.push(DVec2::new(0.0, 1e-6));
        points.insert(1, DVec2::new(1e-6, 0.0));
        assert_eq!(without_short_edges(&points, 1e-3), square());
    }
}
