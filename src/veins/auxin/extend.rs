//! Where a vein grows on: children of called nodes, and veins that meet.

use glam::DVec2;
use smallvec::SmallVec;

use super::callers::Callers;
use super::calls::{CallsOf, unit};
use super::nodes::{LEAST_BETWEEN_NODES, Meeting, Nodes};
use super::web::Edge;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::{NodeId, Rank};

/// A child nearer than this (in steps) to a child that the node already has would be the same vein
/// again: a node pulled evenly from both sides would lay it for ever.
const LEAST_BETWEEN_CHILDREN: f64 = 0.25;

/// The sum of unit vectors shorter than this pulls nowhere. One vector alone has length 1, less
/// rounding.
const LEAST_PULL: f64 = 1.0 - 1e-9;

/// A join may be this long, in steps. One that ends at a long edge (made when the blade was small) would
/// run along it.
const LONGEST_JOIN: f64 = 2.0;

impl Nodes {
    /// Grows each called node one step towards its callers.
    ///
    /// On one thread: to find out on all of them where there is room, before anything grows, took longer on two
    /// threads than to find it out on one, for each wants what the other has just written.
    pub(super) fn extend(
        &mut self,
        callers: &dyn Callers,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        for calls in callers.calls().called() {
            self.grow_on(calls, callers, blade, step, metric);
        }
    }

    /// Grows a called node towards its callers.
    ///
    /// Where they pull apart (their unit vectors sum to less than 1) the first gets a child of its
    /// own and is left out, until the rest agree or one is left (Foster).
    fn grow_on(
        &mut self,
        calls: CallsOf<'_>,
        callers: &dyn Callers,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        let node = calls.node();
        let mut pull = calls.pull();
        let mut left = calls.count();
        if left > 1 && pull.length_squared() < LEAST_PULL {
            let units = self.units(calls, callers, metric);
            let mut first = 0;
            while left > 1 && pull.length_squared() < LEAST_PULL {
                self.sprout(node, units[first], blade, step, metric);
                first += 1;
                left -= 1;
                // Summed anew: taking away would leave the rounding of what is gone.
                pull = units[first..].iter().fold(DVec2::ZERO, |sum, unit| sum + *unit);
            }
        }
        let length = pull.length();
        if length == 0.0 {
            return;
        }
        let straight = pull / length;
        if !self.steering.is_off() {
            let towards = self.steered(straight, left, (calls, callers), metric);
            if self.sprout(node, towards, blade, step, metric) != Sprout::Blocked {
                return;
            }
        }
        let made = self.sprout(node, straight, blade, step, metric);
        if made == Sprout::Blocked && left > 1 {
            // The mean of the callers lies beyond the margin (a sinus between two lobes), though each
            // of them can be seen. Follow the nearest; the others call again from where that leads.
            let towards = self.unit_to_nearest(calls, callers, metric);
            self.sprout(node, towards, blade, step, metric);
        }
    }

    /// The unit vectors from a called node towards its callers, by their ids.
    fn units(&self, calls: CallsOf<'_>, callers: &dyn Callers, metric: Metric) -> Vec<DVec2> {
        let from = self.position(calls.node());
        calls.callers().map(|source| unit(from, callers.place(source), metric)).collect()
    }

    /// The unit vector from a called node towards its nearest caller, the first among equals.
    fn unit_to_nearest(&self, calls: CallsOf<'_>, callers: &dyn Callers, metric: Metric) -> DVec2 {
        let from = self.position(calls.node());
        let distance2 = |source: &DVec2| metric.distance_squared(*source, from);
        let places = calls.callers().map(|source| callers.place(source));
        let nearest = places.min_by(|a, b| distance2(a).total_cmp(&distance2(b)));
        nearest.map_or(DVec2::ZERO, |source| unit(from, source, metric))
    }

    /// Where a vein goes that the last `left` of its callers pull along a unit vector: only a tip has a
    /// heading.
    fn steered(
        &self,
        towards: DVec2,
        left: usize,
        (calls, callers): (CallsOf<'_>, &dyn Callers),
        metric: Metric,
    ) -> DVec2 {
        let node = calls.node();
        let parent = self.graph.parent(node).filter(|_| self.web.is_tip(node));
        let mut way = towards;
        if let Some(parent) = parent.filter(|_| left > 1 && self.steering.straightens()) {
            let heading = metric.between(self.position(parent), self.position(node)).normalize();
            let units = self.units(calls, callers, metric);
            way = self.steering.ahead(&units[units.len() - left..], heading).normalize_or(towards);
        }
        self.steering.pulled(way)
    }

    /// Makes a child of a ranked vein at a place, unless another vein, the margin or a cut is in the
    /// way.
    pub(super) fn lay(
        &mut self,
        node: NodeId,
        place: DVec2,
        rank: Rank,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) -> Option<NodeId> {
        let is_free = !self.is_taken(place, metric)
            && blade.is_inside(place, step)
            && !blade.blocks_sight(self.position(node), place, step)
            && !self.overlaps(node, place, metric)
            && self.crossed(self.position(node), place, [node, node]).is_none();
        is_free.then(|| {
            let child = self.add(node, place);
            self.graph.set_rank(child, rank);
            child
        })
    }

    /// Makes a child one step from `node`, if there is room for it.
    fn sprout(
        &mut self,
        node: NodeId,
        towards: DVec2,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) -> Sprout {
        let from = self.position(node);
        let length = self.stride(metric);
        let child = metric.beyond(from, towards * length);
        let siblings = (LEAST_BETWEEN_CHILDREN * length) * (LEAST_BETWEEN_CHILDREN * length);
        let others = (LEAST_BETWEEN_NODES * length) * (LEAST_BETWEEN_NODES * length);
        let reach = metric.around(child, LEAST_BETWEEN_CHILDREN * length);
        let graph = &self.graph;
        let takes = |id: NodeId, q: DVec2| {
            let d2 = metric.distance_squared(child, q);
            d2 < others || (d2 < siblings && graph.parent(id) == Some(node))
        };
        let met = self.web.met(from, child, reach, [node, node], takes, graph.positions());
        if met.is_taken {
            return Sprout::Taken;
        }
        if !blade.is_inside(child, step) || blade.blocks_sight(from, child, step) {
            return Sprout::Blocked;
        }
        if self.overlaps(node, child, metric) {
            return Sprout::Taken;
        }
        if let Some(edge) = met.edge {
            if self.meeting == Meeting::Join {
                self.join_edge(node, edge, blade, step, metric);
            }
            return Sprout::Crossed;
        }
        self.add(node, child);
        Sprout::Made
    }

    /// Ends a vein at the nearer end of an edge in its way, if that can be reached.
    fn join_edge(
        &mut self,
        node: NodeId,
        edge: Edge,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        let from = self.position(node);
        let distance2 = |end: NodeId| metric.distance_squared(from, self.position(end));
        let end = if distance2(edge.1) < distance2(edge.0) { edge.1 } else { edge.0 };
        let to = self.position(end);
        let is_near = distance2(end) <= metric.length(LONGEST_JOIN * self.step_mm).powi(2);
        let is_free = is_near
            && !self.are_close(node, end, metric)
            && !blade.blocks_sight(from, to, step)
            && !self.overlaps(node, to, metric)
            && self.crossed(from, to, [node, end]).is_none();
        if is_free {
            self.join(node, end);
        }
    }

    /// Brings veins together at the place of the source that called them.
    ///
    /// The first gets a child there, which the others join. One that would have to cross a vein or
    /// leave the blade stays apart, as does one that has met the others close by.
    pub(super) fn meet(
        &mut self,
        place: DVec2,
        arrivals: &[NodeId],
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        let least2 = self.least_between(metric).powi(2);
        // A vein that has come to the very place needs no child there.
        let there = arrivals
            .iter()
            .copied()
            .find(|&node| metric.distance_squared(self.position(node), place) < least2);
        if there.is_none() && self.is_taken(place, metric) {
            return;
        }
        let place = there.map_or(place, |node| self.position(node));
        let mut ends: SmallVec<[NodeId; 6]> = there.into_iter().collect();
        for &node in arrivals.iter().filter(|&&node| Some(node) != there) {
            let from = self.position(node);
            let is_free = ends.iter().all(|&end| !self.are_close(node, end, metric))
                && !blade.blocks_sight(from, place, step)
                && !self.overlaps(node, place, metric)
                && self.crossed(from, place, [node, there.unwrap_or(node)]).is_none();
            if is_free {
                ends.push(node);
            }
        }
        if let [first, others @ ..] = ends[..].as_ref()
            && !others.is_empty()
        {
            let junction = there.unwrap_or_else(|| self.add(*first, place));
            others.iter().for_each(|&node| self.join(junction, node));
        }
    }
}

/// What came of an attempt to make a child.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sprout {
    Made,
    /// A node stands there already.
    Taken,
    /// The margin or a cut is in the way.
    Blocked,
    /// Another vein is in the way.
    Crossed,
}
