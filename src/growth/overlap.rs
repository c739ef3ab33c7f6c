//! What two outlines that share the base have in common.
//!
//! Method: walk along one polygon while inside the other and change over where it leaves (Weiler and
//! Atherton, *Hidden surface removal using polygon area sorting*, 1977). The walk starts at the base
//! and ends when it comes back, so only the part that hangs together with the base comes out.

use glam::DVec2;

/// Where an edge of one polygon crosses an edge of the other.
#[derive(Debug, Clone, Copy)]
struct Crossing {
    /// Edge and place on it (0–1), in each polygon.
    on: [(usize, f64); 2],
    at: DVec2,
    /// Whether the first polygon enters the second here.
    first_enters: bool,
}

/// The common part of two anticlockwise polygons, both with the base as vertex 0; the walk starts on
/// `first`, whose first edge must lie in or on `second`. Empty when the walk does not come back.
pub(super) fn common_part(first: &[DVec2], second: &[DVec2]) -> Vec<DVec2> {
    let crossings = crossings(first, second);
    // The crossings in the order in which each polygon meets them.
    let orders = [0, 1].map(|side| {
        let mut order: Vec<usize> = (0..crossings.len()).collect();
        order.sort_by(|&a, &b| {
            let (a, b) = (crossings[a].on[side], crossings[b].on[side]);
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        order
    });
    let polygons = [first, second];
    let mut outline = vec![first[0]];
    let (mut side, mut edge, mut place) = (0, 0, 0.0);
    for _ in 0..first.len() + second.len() + 2 * crossings.len() {
        let next = orders[side].iter().find(|&&i| {
            let (e, t) = crossings[i].on[side];
            e == edge && t > place
        });
        let Some(&i) = next else {
            edge += 1;
            if edge == polygons[side].len() {
                return outline;
            }
            outline.push(polygons[side][edge]);
            place = 0.0;
            continue;
        };
        let crossing = crossings[i];
        place = crossing.on[side].1;
        let enters = if side == 0 { crossing.first_enters } else { !crossing.first_enters };
        if !enters {
            outline.push(crossing.at);
            side = 1 - side;
            (edge, place) = crossing.on[side];
        }
    }
    Vec::new()
}

/// Every proper crossing. Edges that overlap or only touch count as not crossing.
fn crossings(first: &[DVec2], second: &[DVec2]) -> Vec<Crossing> {
    let mut found = Vec::new();
    for (i, &a) in first.iter().enumerate() {
        let b = first[(i + 1) % first.len()];
        let (low, high) = (a.min(b), a.max(b));
        for (j, &c) in second.iter().enumerate() {
            let d = second[(j + 1) % second.len()];
            if c.max(d).cmplt(low).any() || c.min(d).cmpgt(high).any() {
                continue;
            }
            let (along, other) = (b - a, d - c);
            let turn = along.perp_dot(other);
            let (t, u) = ((c - a).perp_dot(other) / turn, (c - a).perp_dot(along) / turn);
            if (0.0..1.0).contains(&t) && (0.0..1.0).contains(&u) && t.max(u) > 0.0 {
                let first_enters = turn < 0.0;
                found.push(Crossing { on: [(i, t), (j, u)], at: a + along * t, first_enters });
            }
        }
    }
    found
}

/// The outline with a vertex where it meets the +y axis last, and the index of that vertex.
pub(super) fn with_apex(outline: &[DVec2]) -> (Vec<DVec2>, usize) {
    let mut best: Option<(f64, usize)> = None;
    for (i, &a) in outline.iter().enumerate().skip(1) {
        let b = outline[(i + 1) % outline.len()];
        if a.x > 0.0 && b.x <= 0.0 || a.x == 0.0 {
            let y = if a.x == 0.0 { a.y } else { a.y + (b.y - a.y) * (a.x / (a.x - b.x)) };
            if y > 0.0 && best.is_none_or(|best| y > best.0) {
                best = Some((y, i + 1));
            }
        }
    }
    let mut outline = outline.to_vec();
    let Some((y, at)) = best else { return (outline, 0) };
    let apex = DVec2::new(0.0, y);
    outline.insert(at, apex);
    // A vertex that stood there already would leave two.
    if outline[at - 1] == apex {
        outline.remove(at);
        return (outline, at - 1);
    }
    if outline.get(at + 1) == Some(&apex) {
        outline.remove(at + 1);
    }
    (outline, at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;

    #[test]
    fn the_common_part_of_a_fork_and_a_bar_is_the_part_at_the_base() {
        let right = [(0., 0.), (3., -1.), (3., 9.), (1., 9.), (1., 5.), (2., 2.)];
        let left = [(-1., 2.), (-1., 9.), (-3., 9.), (-3., -1.)];
        let fork: Vec<DVec2> = right.into_iter().chain(left).map(DVec2::from).collect();
        let bar = [(0., 0.), (5., -0.5), (5., 4.), (-5., 4.), (-5., -0.5)].map(DVec2::from);
        let part = common_part(&bar, &fork);
        let brute = (0..400 * 400)
            .map(|i| DVec2::new(f64::from(i % 400) - 199.5, f64::from(i / 400) - 99.5) * 0.025)
            .filter(|p| polygon::contains(&fork, *p) && polygon::contains(&bar, *p))
            .count() as f64
            * 0.025
            * 0.025;
        assert!((polygon::signed_area(&part) - brute).abs() < 0.05, "{part:?} {brute}");
    }
}
