//! The trails that particles leave, and their reversal: trails run from the blade to the petiole and
//! join on the way; a vein graph grows from the petiole.

use std::collections::HashSet;

use glam::DVec2;

use super::confluence::{Confluence, NONE};
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::VeinGraph;

/// Nodes nearer than about this (in steps) stand in one place.
const SAME_PLACE: f64 = 1e-6;

/// A trail goes on to the next place after so many steps: a particle that waits for another lays none.
const LEAST_MOVE: f64 = 0.5;

/// Where the trails of one particle end for now: one, or several that have met and go on together
/// from the next place laid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ends {
    first: u32,
    last: u32,
}

/// Places in the order in which they were laid, the roots first, each with the place laid after it.
#[derive(Debug)]
pub(super) struct Trails {
    positions: Vec<DVec2>,
    /// The next place of the trail: laid later, or a root.
    onward: Vec<u32>,
    /// The next of the ends that have met.
    sibling: Vec<u32>,
    taken: HashSet<[i64; 2]>,
    step: f64,
    roots: usize,
}

impl Trails {
    pub(super) fn new(roots: &[DVec2], step: f64) -> Self {
        let mut trails = Self {
            positions: Vec::new(),
            onward: Vec::new(),
            sibling: Vec::new(),
            taken: HashSet::new(),
            step,
            roots: roots.len(),
        };
        for &root in roots {
            trails.take(root);
            trails.add(root);
        }
        trails
    }

    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether a place was free; it no longer is.
    fn take(&mut self, p: DVec2) -> bool {
        let place = (p / (SAME_PLACE * self.step)).round();
        self.taken.insert([place.x as i64, place.y as i64])
    }

    fn add(&mut self, p: DVec2) -> u32 {
        self.positions.push(p);
        self.onward.push(NONE);
        self.sibling.push(NONE);
        self.positions.len() as u32 - 1
    }

    /// Begins a trail; `None` where another place is.
    pub(super) fn begin(&mut self, p: DVec2) -> Option<Ends> {
        self.take(p).then(|| {
            let id = self.add(p);
            Ends { first: id, last: id }
        })
    }

    /// Goes on to `p`; where another place is, and within half a step, the trails wait for the next.
    pub(super) fn lay(&mut self, ends: &mut Ends, p: DVec2) {
        let least = LEAST_MOVE * self.step;
        if each(&self.sibling, *ends).any(|end| self.positions[end as usize].distance(p) < least) {
            return;
        }
        if let Some(place) = self.begin(p) {
            self.go_on(*ends, place.first);
            *ends = place;
        }
    }

    /// Lets trails meet.
    pub(super) fn meet(&mut self, a: Ends, b: Ends) -> Ends {
        self.sibling[a.last as usize] = b.first;
        Ends { first: a.first, last: b.last }
    }

    /// Ends trails at a root.
    pub(super) fn arrive(&mut self, ends: Ends, root: usize) {
        self.go_on(ends, root as u32);
    }

    fn go_on(&mut self, ends: Ends, to: u32) {
        each(&self.sibling, ends).for_each(|end| self.onward[end as usize] = to);
    }

    /// The trails as veins that grow from the roots. Places outside the blade are left out, and so are those
    /// at which a trail turned back, where it `is_free` to go past; trails that cross join.
    pub(super) fn into_graph(
        self,
        blade: &SegmentIndex,
        is_free: impl Fn(DVec2, DVec2) -> bool,
    ) -> VeinGraph {
        let mut confluence = Confluence::new(blade, self.positions, self.onward, self.roots);
        confluence.clip();
        confluence.trim(&is_free);
        confluence.join(self.step, &is_free);
        confluence.into_graph()
    }
}

/// The ends that have met, by the next of each.
fn each(sibling: &[u32], ends: Ends) -> impl Iterator<Item = u32> + '_ {
    let next = move |&at: &u32| (at != ends.last).then(|| sibling[at as usize]);
    std::iter::successors(Some(ends.first), next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trails_that_met_are_one_vein_that_forks() {
        let square = [(-9., -9.), (9., -9.), (9., 9.), (-9., 9.)].map(DVec2::from);
        let mut trails = Trails::new(&[DVec2::ZERO], 1.0);
        let a = trails.begin(DVec2::new(-1.0, 3.0)).expect("free");
        let b = trails.begin(DVec2::new(1.0, 3.0)).expect("free");
        assert_eq!(trails.begin(DVec2::new(1.0, 3.0)), None);
        let mut both = trails.meet(a, b);
        trails.lay(&mut both, DVec2::new(0.0, 2.0));
        // Taken: the trail goes on at the next place.
        trails.lay(&mut both, DVec2::new(1.0, 3.0));
        trails.lay(&mut both, DVec2::new(0.0, 1.0));
        trails.arrive(both, 0);
        let graph = trails.into_graph(&SegmentIndex::of_polygon(&square), |_, _| true);
        assert_eq!(graph.check(), None);
        let heights: Vec<f64> = graph.positions().iter().map(|p| p.y).collect();
        assert_eq!(heights, [0.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!((1..5).map(|i| graph.parent(i)).collect::<Vec<_>>(), [0, 1, 2, 2].map(Some));
    }
}
