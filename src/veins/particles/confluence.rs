//! What trails leave of themselves once all are laid: a tree of veins that cross nowhere.
//!
//! A particle that another catches up with has gone ahead of the place where they meet, and particles
//! pass over the trails of those before them. So trails are trimmed back to where they need not turn
//! back, and where two cross the one with fewer particles joins the other, as sap would; one that comes
//! upon itself goes on from there without the loop. No particle is lost on the way.
//!
//! Departs from the source (Rodkaew et al. 2002), whose trails are painted one over the other, and where
//! what crosses is as good as what joins.

use glam::DVec2;

use super::contacts::{Contact, Laid};
use crate::geometry::Rect;
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::VeinGraph;
use crate::veins::planar::{CLEARANCE_MM, LEAST_GAP};

/// Nothing comes after this place.
pub(super) const NONE: u32 = u32::MAX;

/// Trails that meet nearer than this to a place (in steps) meet there.
const AT_PLACE: f64 = 1e-3;

/// An edge that comes upon more than this is laid across what is left: no end without it.
const MOST_CONTACTS: usize = 1000;

/// So many places farther on a trail may join another that it would have to turn back for.
const FARTHER: usize = 8;

/// Places and what comes after each.
#[derive(Debug)]
pub(super) struct Confluence<'a> {
    blade: &'a SegmentIndex,
    positions: Vec<DVec2>,
    /// The next place towards the petiole; none after a root, and for a place that is left out.
    onward: Vec<u32>,
    /// Where a particle started: the end of a vein, also where another trail runs over it.
    is_start: Vec<bool>,
    /// How many particles pass through.
    flow: Vec<u32>,
    roots: usize,
}

/// Where two trails join.
enum Joint {
    /// At a place of one of them.
    Place(u32),
    /// Between places.
    Fresh(DVec2),
}

impl<'a> Confluence<'a> {
    /// Of places in the order in which they were laid, the roots first.
    pub(super) fn new(
        blade: &'a SegmentIndex,
        positions: Vec<DVec2>,
        onward: Vec<u32>,
        roots: usize,
    ) -> Self {
        let mut is_start = vec![true; positions.len()];
        is_start[..roots].fill(false);
        onward.iter().filter(|&&next| next != NONE).for_each(|&at| is_start[at as usize] = false);
        Self { blade, positions, onward, is_start, flow: Vec::new(), roots }
    }

    fn at(&self, place: u32) -> DVec2 {
        self.positions[place as usize]
    }

    fn places(&self) -> std::ops::Range<u32> {
        self.roots as u32..self.positions.len() as u32
    }

    /// Leaves out the places outside the blade: trails go straight from the last inside to the next.
    pub(super) fn clip(&mut self) {
        // What comes after a place was laid after it, or is a root.
        let is_out: Vec<bool> = self.positions.iter().map(|&p| !self.blade.contains(p)).collect();
        for place in self.places().rev() {
            let next = self.onward[place as usize] as usize;
            if next >= self.roots && is_out[next] {
                self.onward[place as usize] = self.onward[next];
            }
        }
        self.places().filter(|&i| is_out[i as usize]).for_each(|i| self.leave_out(i));
    }

    fn leave_out(&mut self, place: u32) {
        self.onward[place as usize] = NONE;
        self.is_start[place as usize] = false;
    }

    /// Leaves out the places at which trails turn back, where the way past them is free.
    pub(super) fn trim(&mut self, is_free: impl Fn(DVec2, DVec2) -> bool) {
        let mut before: Vec<(u32, u32)> =
            self.places().map(|i| (self.onward[i as usize], i)).collect();
        before.sort_unstable();
        // The last first: what leads to a place is looked at after it, and knows where it leads then.
        for place in self.places().rev() {
            let next = self.onward[place as usize];
            let first = before.partition_point(|&(to, _)| to < place);
            let count = before[first..].partition_point(|&(to, _)| to == place);
            let leading = &before[first..first + count];
            if next == NONE || leading.is_empty() {
                continue;
            }
            let (here, to) = (self.at(place), self.at(next));
            let course: DVec2 =
                leading.iter().map(|&(_, from)| (here - self.at(from)).normalize_or_zero()).sum();
            let turns_back = course.dot(to - here) < 0.0;
            if turns_back && leading.iter().all(|&(_, from)| is_free(self.at(from), to)) {
                leading.iter().for_each(|&(_, from)| self.onward[from as usize] = next);
                self.leave_out(place);
            }
        }
    }

    /// Lets trails that cross or touch join: that with more particles keeps its course.
    pub(super) fn join(&mut self, step: f64, is_free: impl Fn(DVec2, DVec2) -> bool) {
        self.flow = self.is_start.iter().map(|&is_start| u32::from(is_start)).collect();
        // Trimmed or not, what comes after a place was laid after it, or is a root.
        for place in self.places() {
            let (here, next) = (self.flow[place as usize], self.onward[place as usize]);
            if next != NONE {
                self.flow[next as usize] += here;
            }
        }
        let bounds = Rect::around(self.positions.iter().copied());
        let mut laid = Laid::new(bounds, step);
        let near = (AT_PLACE * step).max(2.0 * CLEARANCE_MM);
        for place in self.places() {
            let mut from = Some(place).filter(|&place| self.flow[place as usize] > 0);
            for _ in 0..MOST_CONTACTS {
                let Some(place) = from else { break };
                let contact = self.first_contact(&laid, place, self.onward[place as usize]);
                from = contact.and_then(|contact| self.meet(place, contact, near, &mut laid));
                if contact.is_none() {
                    self.lay(place, &mut laid);
                }
            }
        }
        for place in self.places() {
            self.ease(place, &mut laid, &is_free);
        }
    }

    /// Lets a trail that would have to turn back where it joins another join it farther on.
    fn ease(&mut self, from: u32, laid: &mut Laid, is_free: impl Fn(DVec2, DVec2) -> bool) {
        let mut to = self.onward[from as usize];
        if self.flow[from as usize] == 0 || !self.turns_back(from, to) {
            return;
        }
        for _ in 0..FARTHER {
            to = self.onward[to as usize];
            if to == NONE {
                break;
            }
            let fits = !self.turns_back(from, to)
                && is_free(self.at(from), self.at(to))
                && self.first_contact(laid, from, to).is_none();
            if fits {
                self.lead(from, to);
                self.lay(from, laid);
                return;
            }
        }
    }

    /// Whether a trail that goes on from a place to another turns by more than a right angle there.
    fn turns_back(&self, from: u32, to: u32) -> bool {
        let next = self.onward[to as usize];
        let turn = |next: u32| (self.at(to) - self.at(from)).dot(self.at(next) - self.at(to)) < 0.0;
        next != NONE && turn(next)
    }

    fn lay(&self, from: u32, laid: &mut Laid) {
        laid.push([from, self.onward[from as usize]], &self.positions);
    }

    /// Where an edge from place to place first comes upon a laid one.
    fn first_contact(&self, laid: &Laid, from: u32, to: u32) -> Option<Contact> {
        // At a root all may meet at any angle.
        let least_gap = if (to as usize) < self.roots { 0.0 } else { LEAST_GAP };
        // The way of a trail that was clipped is outside, and no place may be there.
        let counts = |place: DVec2| self.blade.contains(place);
        let is_there = |[a, b]: [u32; 2]| self.onward[a as usize] == b && self.flow[a as usize] > 0;
        laid.first_contact([from, to], least_gap, &self.positions, is_there, counts)
    }

    /// Joins the trail from a place and the edge that it has come upon. The place to go on from, where the
    /// trail keeps its course: it has come upon itself, or upon a lesser one.
    fn meet(&mut self, from: u32, contact: Contact, near: f64, laid: &mut Laid) -> Option<u32> {
        let [a, b] = contact.edge;
        let to = self.onward[from as usize];
        let goes_on_at = |at: Option<u32>| {
            let is_greater = self.flow[from as usize] > self.flow[a as usize];
            self.leads(b, from) || (at != Some(b) && is_greater && !self.leads(to, a))
        };
        let (at, goes_on) = match self.joint(from, contact, near) {
            Joint::Place(at) => (at, goes_on_at(Some(at))),
            Joint::Fresh(place) => {
                let goes_on = goes_on_at(None);
                let at = self.positions.len() as u32;
                self.positions.push(place);
                self.onward.push(b);
                self.is_start.push(false);
                self.flow.push(0);
                self.lead(a, at);
                self.lay(a, laid);
                if !goes_on {
                    self.lay(at, laid);
                }
                (at, goes_on)
            }
        };
        // What goes on is led on first: nothing may lead to itself, not even for a moment.
        if at == from {
            if !goes_on {
                self.lead(from, b);
                self.lay(from, laid);
            }
            self.lead(a, from);
            self.lay(a, laid);
        } else {
            if goes_on {
                self.lead(at, to);
            }
            self.lead(from, at);
            self.lay(from, laid);
        }
        goes_on.then_some(at)
    }

    /// Where the trail from a place and the edge that it has come upon are to join.
    fn joint(&self, from: u32, contact: Contact, near: f64) -> Joint {
        let [a, b] = contact.edge;
        let is_near = |place: u32| self.at(place).distance(contact.place) < near;
        if b != self.onward[from as usize] && is_near(b) {
            return Joint::Place(b);
        }
        match [a, from].into_iter().find(|&place| is_near(place)) {
            // A start stays the end of its vein: a trail over it joins beside it.
            Some(start) if self.is_start[start as usize] => {
                Joint::Fresh((self.at(start) + self.at(b)) / 2.0)
            }
            Some(place) => Joint::Place(place),
            None => Joint::Fresh(contact.place),
        }
    }

    /// Lets a trail go on to another place, and all that flows in it.
    fn lead(&mut self, from: u32, to: u32) {
        let flow = self.flow[from as usize];
        let mut at = std::mem::replace(&mut self.onward[from as usize], to);
        while at != NONE {
            self.flow[at as usize] -= flow;
            at = self.onward[at as usize];
        }
        at = to;
        while at != NONE {
            self.flow[at as usize] += flow;
            at = self.onward[at as usize];
        }
    }

    /// Whether one comes from place to place towards the petiole.
    fn leads(&self, from: u32, to: u32) -> bool {
        let next = |&at: &u32| Some(self.onward[at as usize]).filter(|&next| next != NONE);
        std::iter::successors(Some(from), next).any(|at| at == to)
    }

    /// The trails as veins that grow from the roots; what no particle flows through is left out.
    pub(super) fn into_graph(self) -> VeinGraph {
        let mut graph = VeinGraph::new();
        let mut ids = vec![NONE; self.positions.len()];
        for (id, &root) in ids.iter_mut().zip(&self.positions[..self.roots]) {
            *id = graph.add_root(root);
        }
        let mut way = Vec::new();
        for start in self.places().rev().filter(|&i| self.is_start[i as usize]) {
            let mut at = start;
            while ids[at as usize] == NONE {
                way.push(at);
                at = self.onward[at as usize];
            }
            let mut parent = ids[at as usize];
            while let Some(place) = way.pop() {
                parent = graph.sprout(parent, self.at(place));
                ids[place as usize] = parent;
            }
        }
        graph
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};
    use crate::veins::particles::tests::crossings;

    fn square() -> SegmentIndex {
        let corners = [(-9., -9.), (9., -9.), (9., 9.), (-9., 9.)];
        SegmentIndex::of_polygon(&corners.map(DVec2::from))
    }

    /// The graph of trails that end at the origin.
    fn confluence(trails: &[&[(f64, f64)]]) -> VeinGraph {
        let (mut positions, mut onward) = (vec![DVec2::ZERO], vec![NONE]);
        for trail in trails {
            for (i, &p) in trail.iter().enumerate() {
                positions.push(DVec2::from(p));
                let is_last = i + 1 == trail.len();
                onward.push(if is_last { 0 } else { positions.len() as u32 });
            }
        }
        joined(positions, onward)
    }

    fn joined(positions: Vec<DVec2>, onward: Vec<u32>) -> VeinGraph {
        let blade = square();
        let mut confluence = Confluence::new(&blade, positions, onward, 1);
        confluence.clip();
        confluence.trim(|_, _| true);
        confluence.join(1.0, |_, _| true);
        let graph = confluence.into_graph();
        assert_eq!(graph.check(), None);
        assert_eq!(crossings(&graph), 0);
        graph
    }

    /// From a place to the petiole.
    fn way(graph: &VeinGraph, from: (f64, f64)) -> Vec<(f64, f64)> {
        let is_there = |p: &DVec2| p.distance(DVec2::from(from)) < 1e-9;
        let start = graph.positions().iter().position(is_there).expect("a place") as u32;
        let way = std::iter::successors(Some(start), |&at| graph.parent(at));
        way.map(|at| graph.positions()[at as usize].into()).collect()
    }

    #[test]
    fn a_trail_joins_one_that_it_comes_upon_and_the_rest_of_it_is_gone() {
        let graph = confluence(&[&[(-2., 6.), (2., 2.)], &[(2., 6.), (-2., 2.)]]);
        assert_eq!(way(&graph, (2., 6.)), [(2., 6.), (0., 4.), (2., 2.), (0., 0.)]);
        assert_eq!(graph.len(), 5);
    }

    #[test]
    fn the_trail_with_more_particles_keeps_its_course() {
        let positions = [(0., 0.), (-2., 6.), (2., 2.), (3., 8.), (2., 8.), (2., 6.), (-2., 2.)];
        let onward = vec![NONE, 2, 0, 5, 5, 6, 0];
        let graph = joined(positions.map(DVec2::from).to_vec(), onward);
        assert_eq!(way(&graph, (-2., 6.)), [(-2., 6.), (0., 4.), (-2., 2.), (0., 0.)]);
        assert_eq!(way(&graph, (2., 8.))[1..], [(2., 6.), (0., 4.), (-2., 2.), (0., 0.)]);
    }

    #[test]
    fn a_trail_that_comes_upon_itself_goes_on_without_the_loop() {
        let graph =
            confluence(&[&[(-4., 4.), (0., 4.), (3., 4.), (3., 6.), (1., 6.), (1., 3.), (0., 2.)]]);
        let expected = [(-4., 4.), (0., 4.), (1., 4.), (1., 3.), (0., 2.), (0., 0.)];
        assert_eq!(way(&graph, (-4., 4.)), expected);
        assert_eq!(graph.len(), expected.len());
    }

    #[test]
    fn places_at_which_a_trail_turns_back_are_left_out() {
        let graph = confluence(&[&[(0., 6.), (0., 3.), (0.5, 4.), (1., 2.)]]);
        assert_eq!(way(&graph, (0., 6.)), [(0., 6.), (0., 3.), (1., 2.), (0., 0.)]);
    }

    #[test]
    fn a_start_that_another_trail_runs_over_stays_a_tip() {
        let graph =
            confluence(&[&[(0., 4.), (0., 3.), (0., 2.)], &[(0., 8.), (0., 5.5), (0., 3.5)]]);
        assert_eq!(graph.child_counts().iter().filter(|&&count| count == 0).count(), 2);
    }

    #[test]
    fn tangles_of_any_kind_become_trees_without_crossings() {
        let mut rng = Seed(5).stream(Stage::Particles);
        for _ in 0..60 {
            let mut trails = Vec::new();
            for _ in 0..12 {
                let mut p = DVec2::new(rng.between(-7.0, 7.0), rng.between(-7.0, 7.0));
                let mut trail = vec![(p.x, p.y)];
                while p.length() > 1.0 {
                    let aside = DVec2::new(rng.between(-1.2, 1.2), rng.between(-1.2, 1.2));
                    p = (p * 0.96 + aside).clamp(DVec2::splat(-8.0), DVec2::splat(8.0));
                    trail.push((p.x, p.y));
                }
                trails.push(trail);
            }
            let trails: Vec<&[(f64, f64)]> = trails.iter().map(Vec::as_slice).collect();
            let graph = confluence(&trails);
            let tips = graph.child_counts().iter().filter(|&&count| count == 0).count();
            assert_eq!(tips, trails.len());
        }
    }
}
