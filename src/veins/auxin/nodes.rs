//! The veins so far: nodes by place, what is near them, and the edges between them.

use glam::DVec2;

use super::habit::Steering;
use super::web::{Edge, Web};
use crate::geometry::point_grid::{Nearest, PointGrid};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::VeinSpec;
use crate::veins::graph::{NodeId, Rank, VeinGraph};

/// A node nearer than this (in steps) to any other would stand in the same place; far above
/// rounding, far below what could be seen.
pub(crate) const LEAST_BETWEEN_NODES: f64 = 1e-3;

/// How wide cells are in which what a step meets is looked for (steps). In cells of one step there are
/// more to look into, and laying veins takes a tenth longer.
const CELL_STEPS: f64 = 2.0;

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
    pub(super) graph: VeinGraph,
    /// Cells of about the spacing of sources: what is nearest to a source. Where veins do not join, it knows
    /// of new nodes only after [`follow`](Self::follow).
    far: PointGrid,
    pub(super) step_mm: f64,
    /// In the mature leaf; infinite without a limit.
    longest_step_mm: f64,
    far_cell_mm: f64,
    least_loop_mm: f64,
    pub(super) web: Web,
    pub(super) meeting: Meeting,
    pub(super) steering: Steering,
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
        let web = Web::new(bounds, cell(CELL_STEPS * step_mm));
        let mut nodes = Self {
            graph: start,
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
        let Self { graph, far, web, .. } = &mut nodes;
        let positions = graph.positions();
        positions.iter().for_each(|&p| _ = far.push(p));
        let is_root = |&node: &NodeId| graph.parent(node).is_none();
        (0..graph.len() as NodeId).filter(is_root).for_each(|root| web.add_root(root, positions));
        let edges = graph.edges().chain(graph.joins().iter().copied());
        edges.for_each(|edge| web.add(edge, positions));
        nodes
    }

    /// Makes room for so many more nodes: what grows in place of this would be copied time and again.
    pub(super) fn expect(&mut self, more: usize) {
        self.graph.reserve(more);
        self.far.expect(more);
        self.web.expect(more);
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
        let positions = self.graph.positions();
        let cell = metric.reach(metric.length(CELL_STEPS * self.step_mm)).max_element();
        self.web.refine(cell, positions);
        self.far.refine(metric.reach(metric.length(self.far_cell_mm)).max_element(), positions);
    }

    /// Lets sources ask for what is near them.
    ///
    /// Open venation asks for that where sources are born and where the blade deforms, and mostly neither
    /// happens any more: a tenth of the time of growing.
    pub(super) fn follow(&mut self) {
        let new = &self.graph.positions()[self.far.len()..];
        new.iter().for_each(|&p| _ = self.far.push(p));
    }

    /// The nodes by place, in cells of about the spacing of sources.
    fn far(&self) -> &PointGrid {
        debug_assert_eq!(self.far.len(), self.graph.len(), "those asked know all nodes");
        &self.far
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
        self.far()
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
        self.far().any_near(self.positions(), (low + high) / 2.0, (high - low) / 2.0, |id, q| {
            let other2 = metric.distance_squared(s, q);
            (other2, id) < (distance2, node) && metric.distance_squared(p, q) < distance2
        })
    }

    /// Whether a node is nearer to `p` than `distance`.
    pub(super) fn any_within(&self, p: DVec2, distance: f64, metric: Metric) -> bool {
        distance > 0.0
            && self.far().any_near(self.positions(), p, metric.around(p, distance), |_, q| {
                metric.distance_squared(p, q) < distance * distance
            })
    }

    /// The node nearest to `p`, within a squared distance.
    pub(super) fn nearest(&self, p: DVec2, metric: Metric, limit2: f64) -> Option<Nearest> {
        if !metric.is_warped() {
            return self.far().nearest(self.positions(), p, metric.stretch, limit2);
        }
        let mut best = Nearest { id: NodeId::MAX, distance2: limit2, others2: limit2 };
        self.far().for_each_outwards(
            self.positions(),
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

    /// Decides what vein the roots belong to that have no rank.
    pub(super) fn rank_roots(&mut self, rank: Rank) {
        for node in 0..self.graph.len() as NodeId {
            if self.graph.parent(node).is_none() && self.graph.rank(node).is_none() {
                self.graph.set_rank(node, rank);
            }
        }
    }

    /// Makes a child where there is room for it.
    pub(super) fn add(&mut self, parent: NodeId, p: DVec2) -> NodeId {
        let node = self.graph.sprout(parent, p);
        if self.meeting == Meeting::Join {
            self.far.push(p);
        }
        self.web.add((parent, node), self.graph.positions());
        node
    }

    pub(super) fn join(&mut self, a: NodeId, b: NodeId) {
        self.graph.join(a, b);
        self.web.add((a, b), self.graph.positions());
    }

    /// A node nearer than this to any other would stand in the same place.
    pub(super) fn least_between(&self, metric: Metric) -> f64 {
        LEAST_BETWEEN_NODES * metric.length(self.step_mm)
    }

    /// Whether a node stands in a place already.
    pub(super) fn is_taken(&self, place: DVec2, metric: Metric) -> bool {
        let least = self.least_between(metric);
        let is_there = |_, q| metric.distance_squared(place, q) < least * least;
        self.web.any_node_near(place, metric.around(place, least), is_there, self.positions())
    }

    pub(super) fn crossed(&self, p: DVec2, q: DVec2, apart: [NodeId; 2]) -> Option<Edge> {
        self.web.crossed(p, q, apart, self.graph.positions())
    }

    /// Whether an edge from a node would lie on one that it has: back along it, or the same way
    /// again with a step that has become shorter.
    pub(super) fn overlaps(&self, node: NodeId, p: DVec2, metric: Metric) -> bool {
        let least = self.least_between(metric);
        let from = self.position(node);
        let way = |p: DVec2| metric.between(from, p);
        self.web.overlaps(node, p, least, way, self.graph.positions())
    }

    /// Whether two nodes are on one vein, or next to each other on two that have met.
    pub(super) fn are_close(&self, a: NodeId, b: NodeId, metric: Metric) -> bool {
        let limit = metric.length(self.least_loop_mm);
        let length = |a: NodeId, b: NodeId| {
            metric.distance_squared(self.position(a), self.position(b)).sqrt()
        };
        self.web.are_beside(a, b) || self.web.is_way_within(a, b, limit, length)
    }
}
