//! What the loop of growth asks of the sources, however they choose whom to call.

use glam::DVec2;

use super::extend::Nodes;
use super::open;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::Unreached;
use crate::veins::graph::NodeId;

/// The living sources and whom they call.
pub(super) trait Callers {
    /// Sources that ever were.
    fn len(&self) -> usize;

    /// Sources that are left.
    fn living(&self) -> usize;

    /// Adds a source.
    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric);

    /// Follows the sources that were born and died.
    fn keep_index(&mut self);

    /// Lets every source call; the called nodes, ascending.
    fn call(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &Nodes,
    ) -> Vec<NodeId>;

    /// The sum of the unit vectors towards the callers of a called node.
    fn pull(&self, node: NodeId) -> DVec2;

    /// How many call a called node.
    fn count(&self, node: NodeId) -> usize;

    /// The unit vectors towards the callers of a called node, by their ids.
    fn units(&self, node: NodeId, nodes: &Nodes, metric: Metric) -> Vec<DVec2>;

    /// The unit vector towards the nearest caller, the first among equals.
    fn unit_to_nearest(&self, node: NodeId, nodes: &Nodes, metric: Metric) -> DVec2;

    /// Tells the sources of the nodes from `before` on and removes those that are done with; the ids
    /// of the dead.
    fn take_over(
        &mut self,
        before: usize,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &mut Nodes,
    ) -> Vec<u32>;

    /// Whether a source waits for veins that are on their way.
    fn is_waiting(&self) -> bool {
        false
    }

    /// The sources that are left, and why.
    fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached;
}

impl Callers for open::Calls {
    fn len(&self) -> usize {
        self.len()
    }

    fn living(&self) -> usize {
        self.living()
    }

    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        self.add(p, nodes, metric);
    }

    fn keep_index(&mut self) {
        self.keep_index();
    }

    fn call(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &Nodes,
    ) -> Vec<NodeId> {
        self.call(blade, step, metric, nodes)
    }

    fn pull(&self, node: NodeId) -> DVec2 {
        self.pull(node)
    }

    fn count(&self, node: NodeId) -> usize {
        self.callers(node).count()
    }

    fn units(&self, node: NodeId, nodes: &Nodes, metric: Metric) -> Vec<DVec2> {
        self.callers(node).map(|source| self.unit_to(source, nodes, metric)).collect()
    }

    fn unit_to_nearest(&self, node: NodeId, nodes: &Nodes, metric: Metric) -> DVec2 {
        let nearest = self.nearest_caller(node);
        nearest.map_or(DVec2::ZERO, |source| self.unit_to(source, nodes, metric))
    }

    fn take_over(
        &mut self,
        before: usize,
        _: &GrowingBlade,
        _: u64,
        metric: Metric,
        nodes: &mut Nodes,
    ) -> Vec<u32> {
        self.take_over(before, nodes, metric)
    }

    fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        self.unreached(blade, nodes)
    }
}
