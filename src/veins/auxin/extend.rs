//! Vein nodes and their growth: where a child may be made.

use glam::DVec2;

use super::callers::Callers;
use super::habit::Steering;
use super::web::{Edge, Web};
use crate::geometry::point_grid::{Nearest, PointGrid};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::VeinSpec;
use crate::veins::graph::{NodeId, Rank, VeinGraph};

/// A child nearer than this (in steps) to a child that the node already has would be the same vein
/// again: a node pulled evenly from both sides would lay it for ever.
const LEAST_BETWEEN_CHILDREN: f64 = 0.25;

/// A node nearer than this (in steps) to any other would stand in the same place; far above
/// rounding, far below what could be seen.
pub(crate) const LEAST_BETWEEN_NODES: f64 = 1e-3;

/// The sum of unit vectors shorter than this pulls nowhere. One vector alone has length 1, less
/// rounding.
const LEAST_PULL: f64 = 1.0 - 1e-9;

/// A join may be this long, in steps. One that ends at a long edge (made when the blade was small) would
/// run along it.
const LONGEST_JOIN: f64 = 2.0;

/// What happens where a vein would cross another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meeting {
    /// It stops.
    Stop,
    /// It joins it.
    Join,
}

/// The veins so far.
pub(super) struct Nodes {
    graph: VeinGraph,
    /// Cells of about a step: what is around a child.
    near: PointGrid,
    /// Cells of about the spacing of sources: what is nearest to a source.
    far: PointGrid,
    step_mm: f64,
    /// In the mature leaf; infinite without a limit.
    longest_step_mm: f64,
    far_cell_mm: f64,
    least_loop_mm: f64,
    web: Web,
    meeting: Meeting,
    steering: Steering,
}

impl Nodes {
    pub(super) fn new(
        spec: &VeinSpec,
        blade: &GrowingBlade,
        start: VeinGraph,
        metric: Metric,
        meeting: Meeting,
    ) -> Self {
        let bounds = blade.mature().bounds();
        let step_mm = spec.node_step_mm;
        let far_cell_mm = match meeting {
            Meeting::Stop => (2.0 * step_mm).max(spec.vein_spawn_distance_mm.min(10.0 * step_mm)),
            // What stands between a source and a node is mostly looked for over a few steps.
            Meeting::Join => 2.5 * step_mm,
        };
        let cell = |mm: f64| metric.reach(metric.length(mm)).max_element();
        let web = Web::new(bounds, cell(step_mm));
        let mut nodes = Self {
            graph: start,
            near: PointGrid::new(bounds, cell(step_mm)),
            far: PointGrid::new(bounds, cell(far_cell_mm)),
            step_mm,
            longest_step_mm: match spec.longest_step {
                0.0 => f64::INFINITY,
                steps => steps * step_mm,
            },
            far_cell_mm,
            least_loop_mm: spec.least_loop * spec.kill_distance_mm,
            web,
            meeting,
            steering: Steering::new(spec, 0.0),
        };
        for &node in nodes.graph.positions() {
            nodes.near.push(node);
            nodes.far.push(node);
        }
        let edges = nodes.graph.edges().chain(nodes.graph.joins().iter().copied());
        edges.for_each(|edge| nodes.web.add(edge, nodes.graph.positions()));
        nodes
    }

    pub(super) fn graph(&self) -> &VeinGraph {
        &self.graph
    }

    pub(super) fn into_graph(self) -> VeinGraph {
        self.graph
    }

    pub(super) fn len(&self) -> usize {
        self.graph.len()
    }

    pub(super) fn position(&self, node: NodeId) -> DVec2 {
        self.graph.positions()[node as usize]
    }

    pub(super) fn positions(&self) -> &[DVec2] {
        self.graph.positions()
    }

    /// Follows the lengths as they shrink.
    pub(super) fn refine(&mut self, metric: Metric) {
        self.near.refine(metric.reach(metric.length(self.step_mm)).max_element());
        self.far.refine(metric.reach(metric.length(self.far_cell_mm)).max_element());
        let cell = metric.reach(metric.length(self.step_mm)).max_element();
        self.web.refine(cell, self.graph.positions());
    }

    /// How far a vein grows in a step.
    pub(super) fn stride(&self, metric: Metric) -> f64 {
        metric.length(self.step_mm).min(self.longest_step_mm * metric.stretch.min_element())
    }

    /// How veins are steered from now on.
    pub(super) fn steer(&mut self, steering: Steering) {
        self.steering = steering;
    }

    /// From now on veins stop where they would cross another.
    pub(super) fn end_free(&mut self) {
        self.meeting = Meeting::Stop;
    }

    /// The nodes by place, in cells of a few steps.
    pub(super) fn grid(&self) -> &PointGrid {
        &self.far
    }

    /// Whether a node stands between a source at `s` and the `node` at a squared distance from it.
    pub(super) fn stands_between(
        &self,
        s: DVec2,
        node: NodeId,
        distance2: f64,
        metric: Metric,
    ) -> bool {
        let p = self.position(node);
        // The box around both circles' common part.
        let distance = distance2.sqrt() * (1.0 + 1e-9);
        let (near, far) = (metric.around(s, distance), metric.around(p, distance));
        let (low, high) = ((s - near).max(p - far), (s + near).min(p + far));
        self.far.any_near((low + high) / 2.0, (high - low) / 2.0, |id, q| {
            let other2 = metric.distance_squared(s, q);
            (other2, id) < (distance2, node) && metric.distance_squared(p, q) < distance2
        })
    }

    /// Whether a node is nearer to `p` than `distance`.
    pub(super) fn any_within(&self, p: DVec2, distance: f64, metric: Metric) -> bool {
        distance > 0.0
            && self.far.any_near(p, metric.around(p, distance), |_, q| {
                metric.distance_squared(p, q) < distance * distance
            })
    }

    /// The node nearest to `p`, within a squared distance.
    pub(super) fn nearest(&self, p: DVec2, metric: Metric, limit2: f64) -> Option<Nearest> {
        if !metric.is_warped() {
            return self.far.nearest(p, metric.stretch, limit2);
        }
        let mut best = Nearest { id: NodeId::MAX, distance2: limit2, others2: limit2 };
        self.far.for_each_outwards(
            &mut best,
            p,
            |best, clear| metric.clearance(p, clear).powi(2) <= best.distance2,
            |best, id, q| {
                let distance2 = metric.distance_squared(p, q);
                if (distance2, id) < (best.distance2, best.id) {
                    *best = Nearest { id, distance2, others2: distance2 };
                }
            },
        );
        (best.id != NodeId::MAX).then_some(best)
    }

    /// Grows a called node towards its callers.
    ///
    /// Where they pull apart (their unit vectors sum to less than 1) the first gets a child of its
    /// own and is left out, until the rest agree or one is left (Foster).
    pub(super) fn extend(
        &mut self,
        node: NodeId,
        calls: &dyn Callers,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        let mut pull = calls.calls().pull(node);
        let mut left = calls.calls().count(node);
        if left > 1 && pull.length_squared() < LEAST_PULL {
            let units = calls.units(node, self, metric);
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
            let towards = self.steered(node, straight, left, calls, metric);
            if self.sprout(node, towards, blade, step, metric) != Sprout::Blocked {
                return;
            }
        }
        let made = self.sprout(node, straight, blade, step, metric);
        if made == Sprout::Blocked && left > 1 {
            // The mean of the callers lies beyond the margin (a sinus between two lobes), though each
            // of them can be seen. Follow the nearest; the others call again from where that leads.
            let towards = calls.unit_to_nearest(node, self, metric);
            self.sprout(node, towards, blade, step, metric);
        }
    }

    /// Where a vein goes that the last `left` of its callers pull along a unit vector: only a tip has a
    /// heading.
    fn steered(
        &self,
        node: NodeId,
        towards: DVec2,
        left: usize,
        calls: &dyn Callers,
        metric: Metric,
    ) -> DVec2 {
        let parent = self.graph.parent(node).filter(|_| self.web.is_tip(node));
        let mut way = towards;
        if let Some(parent) = parent.filter(|_| left > 1 && self.steering.straightens()) {
            let heading = metric.between(self.position(parent), self.position(node)).normalize();
            let units = calls.units(node, self, metric);
            way = self.steering.ahead(&units[units.len() - left..], heading).normalize_or(towards);
        }
        self.steering.pulled(way)
    }

    /// Decides what vein the roots belong to that have no rank.
    pub(super) fn rank_roots(&mut self, rank: Rank) {
        for node in 0..self.graph.len() as NodeId {
            if self.graph.parent(node).is_none() && self.graph.rank(node).is_none() {
                self.graph.set_rank(node, rank);
            }
        }
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
        let least = LEAST_BETWEEN_NODES * metric.length(self.step_mm);
        let around = metric.around(place, least);
        let is_free = !self
            .near
            .any_near(place, around, |_, q| metric.distance_squared(place, q) < least * least)
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
        let taken = self.near.any_near(child, reach, |id, q| {
            let d2 = metric.distance_squared(child, q);
            d2 < others || (d2 < siblings && graph.parent(id) == Some(node))
        });
        if taken {
            return Sprout::Taken;
        }
        if !blade.is_inside(child, step) || blade.blocks_sight(from, child, step) {
            return Sprout::Blocked;
        }
        if self.overlaps(node, child, metric) {
            return Sprout::Taken;
        }
        if let Some(edge) = self.crossed(from, child, [node, node]) {
            if self.meeting == Meeting::Join {
                self.join_edge(node, edge, blade, step, metric);
            }
            return Sprout::Crossed;
        }
        self.add(node, child);
        Sprout::Made
    }

    /// Makes a child where there is room for it.
    fn add(&mut self, parent: NodeId, p: DVec2) -> NodeId {
        let node = self.graph.sprout(parent, p);
        self.near.push(p);
        self.far.push(p);
        self.web.add((parent, node), self.graph.positions());
        node
    }

    fn join(&mut self, a: NodeId, b: NodeId) {
        self.graph.join(a, b);
        self.web.add((a, b), self.graph.positions());
    }

    fn crossed(&self, p: DVec2, q: DVec2, apart: [NodeId; 2]) -> Option<Edge> {
        self.web.crossed(p, q, apart, self.graph.positions())
    }

    /// Whether an edge from a node would lie on one that it has: back along it, or the same way
    /// again with a step that has become shorter.
    fn overlaps(&self, node: NodeId, p: DVec2, metric: Metric) -> bool {
        let least = LEAST_BETWEEN_NODES * metric.length(self.step_mm);
        let from = self.position(node);
        let way = |p: DVec2| metric.between(from, p);
        self.web.overlaps(node, p, least, way, self.graph.positions())
    }

    /// Whether two nodes are on one vein, or next to each other on two that have met.
    fn are_close(&self, a: NodeId, b: NodeId, metric: Metric) -> bool {
        let limit = metric.length(self.least_loop_mm);
        let length = |a: NodeId, b: NodeId| {
            metric.distance_squared(self.position(a), self.position(b)).sqrt()
        };
        self.web.are_beside(a, b) || self.web.is_way_within(a, b, limit, length)
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
        let length = metric.length(self.step_mm);
        let least2 = (LEAST_BETWEEN_NODES * length) * (LEAST_BETWEEN_NODES * length);
        // A vein that has come to the very place needs no child there.
        let there = arrivals
            .iter()
            .copied()
            .find(|&node| metric.distance_squared(self.position(node), place) < least2);
        let reach = metric.around(place, LEAST_BETWEEN_NODES * length);
        let taken =
            || self.near.any_near(place, reach, |_, q| metric.distance_squared(place, q) < least2);
        if there.is_none() && taken() {
            return;
        }
        let place = there.map_or(place, |node| self.position(node));
        let mut ends: Vec<NodeId> = there.into_iter().collect();
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
