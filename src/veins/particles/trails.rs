//! The trails that particles leave, and their reversal: trails run from the blade to the petiole and
//! join on the way; a vein graph grows from the petiole.

use std::collections::HashSet;

use glam::DVec2;

use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::VeinGraph;

/// No node.
const NONE: u32 = u32::MAX;

/// Nodes nearer than about this (in steps) stand in one place.
const SAME_PLACE: f64 = 1e-6;

/// Where the trails of one particle end for now: one, or several that have met and go on together
/// from the next place laid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ends {
    first: u32,
    last: u32,
}

/// Places in the order in which they were laid, each with the place laid after it.
#[derive(Debug)]
pub(super) struct Trails {
    positions: Vec<DVec2>,
    /// The next place of the trail: laid later, or the root `r` as `NONE - 1 - r`.
    onward: Vec<u32>,
    /// The next of the ends that have met.
    sibling: Vec<u32>,
    taken: HashSet<[i64; 2]>,
    per_place: f64,
    roots: Vec<DVec2>,
}

impl Trails {
    pub(super) fn new(roots: &[DVec2], step: f64) -> Self {
        let mut trails = Self {
            positions: Vec::new(),
            onward: Vec::new(),
            sibling: Vec::new(),
            taken: HashSet::new(),
            per_place: 1.0 / (SAME_PLACE * step),
            roots: roots.to_vec(),
        };
        for &root in roots {
            trails.take(root);
        }
        trails
    }

    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether a place was free; it no longer is.
    fn take(&mut self, p: DVec2) -> bool {
        let place = (p * self.per_place).round();
        self.taken.insert([place.x as i64, place.y as i64])
    }

    /// Begins a trail; `None` where another place is.
    pub(super) fn begin(&mut self, p: DVec2) -> Option<Ends> {
        self.take(p).then(|| {
            let id = self.positions.len() as u32;
            self.positions.push(p);
            self.onward.push(NONE);
            self.sibling.push(NONE);
            Ends { first: id, last: id }
        })
    }

    /// Goes on to `p`; where another place is, the trails wait for the next.
    pub(super) fn lay(&mut self, ends: &mut Ends, p: DVec2) {
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
        self.go_on(ends, NONE - 1 - root as u32);
    }

    fn go_on(&mut self, ends: Ends, to: u32) {
        let mut at = ends.first;
        loop {
            self.onward[at as usize] = to;
            if at == ends.last {
                return;
            }
            at = self.sibling[at as usize];
        }
    }

    /// The trails as veins that grow from the roots: what was laid last comes first. Places outside
    /// the blade are left out, and the trail goes straight from the last inside to the next.
    pub(super) fn into_graph(self, blade: &SegmentIndex) -> VeinGraph {
        let mut graph = VeinGraph::new();
        let roots: Vec<u32> = self.roots.iter().map(|&root| graph.add_root(root)).collect();
        let mut ids = vec![0; self.positions.len()];
        for at in (0..self.positions.len()).rev() {
            let onward = self.onward[at];
            let parent = match ids.get(onward as usize) {
                Some(&id) => id,
                None => roots[(NONE - 1 - onward) as usize],
            };
            let p = self.positions[at];
            ids[at] = if blade.contains(p) { graph.sprout(parent, p) } else { parent };
        }
        graph
    }
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
        let graph = trails.into_graph(&SegmentIndex::of_polygon(&square));
        assert_eq!(graph.check(), None);
        let heights: Vec<f64> = graph.positions().iter().map(|p| p.y).collect();
        assert_eq!(heights, [0.0, 1.0, 2.0, 3.0, 3.0]);
        assert_eq!((1..5).map(|i| graph.parent(i)).collect::<Vec<_>>(), [0, 1, 2, 2].map(Some));
    }
}
