//! Vein nodes and their growth: where a child may be made.

use glam::DVec2;

use super::open::Calls;
use crate::geometry::point_grid::{Nearest, PointGrid};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::VeinSpec;
use crate::veins::graph::{NodeId, VeinGraph};

/// A child nearer than this (in steps) to a child that the node already has would be the same vein
/// again: a node pulled evenly from both sides would lay it for ever.
const LEAST_BETWEEN_CHILDREN: f64 = 0.25;

/// A node nearer than this (in steps) to any other would stand in the same place; far above
/// rounding, far below what could be seen.
const LEAST_BETWEEN_NODES: f64 = 1e-3;

/// The sum of unit vectors shorter than this pulls nowhere. One vector alone has length 1, less
/// rounding.
const LEAST_PULL: f64 = 1.0 - 1e-9;

/// The veins so far.
pub(super) struct Nodes {
    graph: VeinGraph,
    /// Cells of about a step: what is around a child.
    near: PointGrid,
    /// Cells of about the spacing of sources: what is nearest to a source.
    far: PointGrid,
    step_mm: f64,
    far_cell_mm: f64,
}

impl Nodes {
    pub(super) fn new(
        spec: &VeinSpec,
        blade: &GrowingBlade,
        start: VeinGraph,
        metric: Metric,
    ) -> Self {
        let bounds = blade.mature().bounds();
        let step_mm = spec.node_step_mm;
        let far_cell_mm = (2.0 * step_mm).max(spec.vein_spawn_distance_mm.min(10.0 * step_mm));
        let cell = |mm: f64| metric.reach(metric.length(mm)).max_element();
        let mut nodes = Self {
            graph: start,
            near: PointGrid::new(bounds, cell(step_mm)),
            far: PointGrid::new(bounds, cell(far_cell_mm)),
            step_mm,
            far_cell_mm,
        };
        for &node in nodes.graph.positions() {
            nodes.near.push(node);
            nodes.far.push(node);
        }
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
    }

    /// Whether a node is nearer to `p` than `distance`.
    pub(super) fn any_within(&self, p: DVec2, distance: f64, metric: Metric) -> bool {
        distance > 0.0
            && self.far.any_near(p, metric.reach(distance), |_, q| {
                metric.distance_squared(p, q) < distance * distance
            })
    }

    /// The node nearest to `p`, within a squared distance.
    pub(super) fn nearest(&self, p: DVec2, metric: Metric, limit2: f64) -> Option<Nearest> {
        self.far.nearest(p, metric.stretch, limit2)
    }

    /// Grows a called node towards its callers.
    ///
    /// Where they pull apart (their unit vectors sum to less than 1) the first gets a child of its
    /// own and is left out, until the rest agree or one is left (Foster).
    pub(super) fn extend(
        &mut self,
        node: NodeId,
        calls: &Calls,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
    ) {
        let mut pull = calls.pull(node);
        let mut left = calls.callers(node).count();
        if left > 1 && pull.length_squared() < LEAST_PULL {
            let units: Vec<DVec2> =
                calls.callers(node).map(|source| calls.unit_to(source, self, metric)).collect();
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
        let made = self.sprout(node, pull / length, blade, step, metric);
        if made == Sprout::Blocked && left > 1 {
            // The mean of the callers lies beyond the margin (a sinus between two lobes), though each
            // of them can be seen. Follow the nearest; the others call again from where that leads.
            if let Some(nearest) = calls.nearest_caller(node) {
                let towards = calls.unit_to(nearest, self, metric);
                self.sprout(node, towards, blade, step, metric);
            }
        }
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
        let length = metric.length(self.step_mm);
        let child = from + towards * length / metric.stretch;
        let siblings = (LEAST_BETWEEN_CHILDREN * length) * (LEAST_BETWEEN_CHILDREN * length);
        let others = (LEAST_BETWEEN_NODES * length) * (LEAST_BETWEEN_NODES * length);
        let reach = metric.reach(LEAST_BETWEEN_CHILDREN * length);
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
        self.graph.sprout(node, child);
        self.near.push(child);
        self.far.push(child);
        Sprout::Made
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
}
