//! Whether a polygon is simple, by chains that run one way.
//!
//! A stretch of boundary along which neither x nor y turns back cannot touch itself, and the box around
//! any part of it is that of its two ends. So two such chains are compared by halving: parts whose
//! boxes lie apart are done with at once. An outline of a smooth blade has a few chains, which lie apart
//! but for the vertices they share, and is found simple in little more than the time to read it. No box
//! is stored and nothing is sorted. (Halving curves by their boxes: D. Ballard, "Strip trees", Comm.
//! ACM 24, 1981; boxes of monotone pieces come for nothing.)

use super::DVec2;
use super::polygon::edges_touch;

/// With more chains than this (margins with many teeth, rough ones) pairs of chains become too many: a
/// grid of edges is faster.
const MOST: usize = 48;

/// Whether any two edges touch, neighbours at their shared vertex excepted; `None` when the polygon has
/// too many chains to be looked at in this way.
pub(super) fn touching(polygon: &[DVec2]) -> Option<bool> {
    let mut chains = [(0, 0); MOST];
    let count = split(polygon, &mut chains)?;
    let chains = &chains[..count];
    let touch = |k: usize| chains[..k].iter().any(|&a| parts_touch(polygon, a, chains[k]));
    Some((1..count).any(touch))
}

/// The chains, as first and last vertex; the last one may end at the vertex count, which is vertex 0.
fn split(polygon: &[DVec2], chains: &mut [(usize, usize); MOST]) -> Option<usize> {
    let n = polygon.len();
    let mut count = 0;
    let mut start = 0;
    // The way of the chain so far: 0 where it has not moved yet.
    let mut way = DVec2::ZERO;
    for i in 0..n {
        let edge = polygon[if i + 1 == n { 0 } else { i + 1 }] - polygon[i];
        if edge.x * way.x < 0.0 || edge.y * way.y < 0.0 {
            *chains.get_mut(count)? = (start, i);
            (count, start, way) = (count + 1, i, DVec2::ZERO);
        }
        // Signs only: products of them neither vanish nor overflow.
        let sign = |x: f64| {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else {
                0.0
            }
        };
        if way.x == 0.0 {
            way.x = sign(edge.x);
        }
        if way.y == 0.0 {
            way.y = sign(edge.y);
        }
    }
    *chains.get_mut(count)? = (start, n);
    Some(count + 1)
}

/// Whether an edge of one part of a chain touches one of another.
fn parts_touch(polygon: &[DVec2], a: (usize, usize), b: (usize, usize)) -> bool {
    let n = polygon.len();
    let ends = |(first, last): (usize, usize)| {
        let (p, q) = (polygon[first], polygon[if last == n { 0 } else { last }]);
        (p.min(q), p.max(q))
    };
    let ((low_a, high_a), (low_b, high_b)) = (ends(a), ends(b));
    let apart =
        low_a.x > high_b.x || low_b.x > high_a.x || low_a.y > high_b.y || low_b.y > high_a.y;
    if apart {
        return false;
    }
    let (edges_a, edges_b) = (a.1 - a.0, b.1 - b.0);
    if edges_a == 1 && edges_b == 1 {
        return edges_touch(polygon, a.0, b.0);
    }
    if edges_a >= edges_b {
        let middle = a.0 + edges_a / 2;
        parts_touch(polygon, (a.0, middle), b) || parts_touch(polygon, (middle, a.1), b)
    } else {
        let middle = b.0 + edges_b / 2;
        parts_touch(polygon, a, (b.0, middle)) || parts_touch(polygon, a, (middle, b.1))
    }
}

#[cfg(test)]
mod tests {
    use super::super::polygon::{crossings, edges};
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn chains_find_what_the_comparison_of_all_edges_finds() {
        let mut rng = Seed(11).stream(Stage::Tissue);
        let (mut simple, mut many) = (0, 0);
        for case in 0..4000 {
            // A round outline with waves, some of which make it cross itself; on a coarse lattice now and
            // then, where edges stand upright, vertices meet and folds lie on each other.
            let n = 8 + (rng.bits() % 90) as usize;
            let [waves, depth, lean] =
                [rng.between(1.0, 9.0).floor(), rng.unit(), rng.between(-1.0, 1.0)];
            let lattice = [0.0, 0.125, 0.25][case % 3];
            let outline: Vec<DVec2> = (0..n)
                .map(|i| {
                    let turn = std::f64::consts::TAU * i as f64 / n as f64;
                    let radius = 2.0 + 1.8 * depth * libm::sin(waves * turn);
                    let angle = turn + lean * depth * libm::cos(waves * turn);
                    let p = DVec2::new(libm::cos(angle), libm::sin(angle)) * radius;
                    if lattice > 0.0 { (p / lattice).round() * lattice } else { p }
                })
                .collect();
            if edges(&outline).any(|(a, b)| a == b) {
                continue;
            }
            let Some(touches) = touching(&outline) else {
                many += 1;
                continue;
            };
            assert_eq!(touches, !crossings(&outline).is_empty(), "case {case}: {outline:?}");
            simple += usize::from(!touches);
        }
        assert!(simple > 500 && many < 2000, "{simple} simple, {many} of many chains");
    }
}
