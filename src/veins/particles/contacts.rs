//! Where a trail comes upon another.

use glam::DVec2;

use crate::geometry::Rect;
use crate::geometry::polygon::{cross, nearest_on_segment, segments_near};
use crate::geometry::segment_grid::SegmentGrid;
use crate::veins::planar::{CLEARANCE_MM, is_gap_below};

/// Where an edge comes upon another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Which share of the edge lies before it.
    way: f64,
    pub(super) place: DVec2,
    /// The places at the ends of the other edge.
    pub(super) edge: [u32; 2],
}

/// The edges laid so far, from place to place; some are there no more.
#[derive(Debug)]
pub(super) struct Laid {
    grid: SegmentGrid,
    edges: Vec<[u32; 2]>,
}

impl Laid {
    /// None yet, in cells of about `cell`.
    pub(super) fn new(bounds: Rect, cell: f64) -> Self {
        Self { grid: SegmentGrid::new(bounds, cell), edges: Vec::new() }
    }

    pub(super) fn push(&mut self, edge: [u32; 2], positions: &[DVec2]) {
        let [from, to] = edge.map(|place| positions[place as usize]);
        self.grid.push(from, to);
        self.edges.push(edge);
    }

    /// Where an edge first comes upon one that `is_there`, at a place that `counts`; of edges to the same place also
    /// one that keeps apart from it by less than `least_gap` (a share of the shorter one).
    pub(super) fn first_contact(
        &self,
        [from, to]: [u32; 2],
        least_gap: f64,
        positions: &[DVec2],
        is_there: impl Fn([u32; 2]) -> bool,
        counts: impl Fn(DVec2) -> bool,
    ) -> Option<Contact> {
        let at = |place: u32| positions[place as usize];
        let (p, q) = (at(from), at(to));
        let mut first: Option<Contact> = None;
        self.grid.for_each_near(p.min(q), p.max(q), |id| {
            let edge @ [a, b] = self.edges[id as usize];
            if a == from || b == from || a == to || !is_there(edge) {
                return;
            }
            let found = if b == to {
                overlap(p, q, at(a), least_gap)
            } else if segments_near(p, q, at(a), at(b), CLEARANCE_MM) {
                Some(crossing(p, q, at(a), at(b)))
            } else {
                None
            };
            if let Some((way, place)) = found
                && first.is_none_or(|f| (way, edge) < (f.way, f.edge))
                && counts(place)
            {
                first = Some(Contact { way, place, edge });
            }
        });
        first
    }
}

/// Where two edges to the same place `q` lie on each other or keep apart by less than a share of the shorter
/// one: which share of p–q is before that, and where.
fn overlap(p: DVec2, q: DVec2, c: DVec2, least_gap: f64) -> Option<(f64, DVec2)> {
    let lies_on = |a: DVec2, b: DVec2| a.distance(nearest_on_segment(b, q, a)) <= CLEARANCE_MM;
    let overlaps = lies_on(p, c) || lies_on(c, p) || is_gap_below(q, p, c, least_gap);
    let at_own = p.distance_squared(q) <= c.distance_squared(q);
    overlaps.then(|| if at_own { (0.0, p) } else { (share(p, q, c), c) })
}

/// Where the edge p–q comes upon c–d: which share of it is before that, and where.
fn crossing(p: DVec2, q: DVec2, c: DVec2, d: DVec2) -> (f64, DVec2) {
    const TOUCH: f64 = 2.0 * CLEARANCE_MM;
    if p.distance(nearest_on_segment(c, d, p)) <= TOUCH {
        return (0.0, p);
    }
    // An end that lies on the edge comes first: of two along each other, where lines cross is chance.
    let ends = [c, d].map(|end| (share(p, q, end), end));
    let lies_on = |&(way, end): &(f64, DVec2)| end.distance(p.lerp(q, way)) <= TOUCH;
    if let Some(first) = ends.into_iter().filter(lies_on).min_by(|a, b| a.0.total_cmp(&b.0)) {
        return first;
    }
    let (before, after) = (cross(c, d, p), cross(c, d, q));
    let way = if before == after { 1.0 } else { before / (before - after) };
    let way = way.clamp(0.0, 1.0);
    (way, p.lerp(q, way))
}

/// The share of the way from `p` to `q` that is before what is nearest to `c`.
fn share(p: DVec2, q: DVec2, c: DVec2) -> f64 {
    ((c - p).dot(q - p) / p.distance_squared(q)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn at(x: f64, y: f64) -> DVec2 {
        DVec2::new(x, y)
    }

    #[test]
    fn what_comes_first_on_the_way_is_found() {
        let (p, q) = (at(0., 0.), at(4., 0.));
        // Across, from behind, an end that touches, along each other.
        assert_eq!(crossing(p, q, at(1., -1.), at(1., 3.)), (0.25, at(1., 0.)));
        assert_eq!(crossing(p, q, at(-1., 0.), at(2., 0.)), (0.0, p));
        assert_eq!(crossing(p, q, at(3., 0.), at(3., 3.)), (0.75, at(3., 0.)));
        assert_eq!(crossing(p, q, at(9., 0.), at(2., 0.)), (0.5, at(2., 0.)));
        assert_eq!(crossing(p, q, at(1., 0.), at(3., 0.)), (0.25, at(1., 0.)));
    }

    #[test]
    fn two_edges_to_one_place_meet_at_the_nearer_start() {
        let (p, q) = (at(0., 0.), at(4., 0.));
        assert_eq!(overlap(p, q, at(1., 0.), 0.0), Some((0.25, at(1., 0.))));
        assert_eq!(overlap(p, q, at(-3., 0.), 0.0), Some((0.0, p)));
        assert_eq!(overlap(p, q, at(2., 0.03), 0.0), None);
        assert_eq!(overlap(p, q, at(2., 0.03), 0.02), Some((0.5, at(2., 0.03))));
        assert_eq!(overlap(p, q, at(2., 0.05), 0.02), None);
    }

    #[test]
    fn edges_that_are_no_more_are_not_met() {
        let positions = [at(0., 0.), at(4., 0.), at(1., -1.), at(1., 3.), at(9., 9.)];
        let mut laid = Laid::new(Rect::around(positions), 1.0);
        laid.push([2, 3], &positions);
        let met = |is_there: bool| {
            let contact = laid.first_contact([0, 1], 0.0, &positions, |_| is_there, |_| true);
            contact.map(|contact| (contact.place, contact.edge))
        };
        assert_eq!(met(true), Some((at(1., 0.), [2, 3])));
        assert_eq!(met(false), None);
    }
}
