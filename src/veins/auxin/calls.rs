//! The calls of one step: which nodes are called, and by which sources.

use glam::DVec2;

use super::NONE;
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// The calls of one node.
#[derive(Debug, Clone, Copy)]
struct Called {
    node: NodeId,
    /// The sum of the unit vectors towards the callers.
    pull: DVec2,
    first: u32,
    last: u32,
    count: u32,
}

/// A call.
#[derive(Debug, Clone, Copy)]
struct Call {
    /// Where the source is.
    from: DVec2,
    /// The next call of the same node.
    next: u32,
}

/// Who calls whom.
#[derive(Debug, Default)]
pub(super) struct Calls {
    /// By node, where its calls may be: valid if the node is named there. Small and never cleared,
    /// for few nodes are called in a step.
    places: Vec<u32>,
    called: Vec<Called>,
    calls: Vec<Call>,
}

impl Calls {
    /// Begins a step with that many nodes.
    pub(super) fn begin(&mut self, nodes: usize) {
        self.places.resize(nodes, 0);
        self.calls.clear();
        self.called.clear();
    }

    /// Lets a source at `from` call a node, which lies in the direction −`unit`.
    ///
    /// Sources call in the order of their ids: floating-point addition is not associative.
    pub(super) fn add(&mut self, from: DVec2, node: NodeId, unit: DVec2) {
        let call = self.calls.len() as u32;
        self.calls.push(Call { from, next: NONE });
        match self.called.get_mut(self.places[node as usize] as usize) {
            Some(entry) if entry.node == node => {
                self.calls[entry.last as usize].next = call;
                entry.last = call;
                entry.count += 1;
                entry.pull += unit;
            }
            _ => {
                self.places[node as usize] = self.called.len() as u32;
                self.called.push(Called { node, pull: unit, first: call, last: call, count: 1 });
            }
        }
    }

    /// The called nodes, ascending.
    pub(super) fn nodes(&self) -> Vec<NodeId> {
        let mut nodes: Vec<NodeId> = self.called.iter().map(|called| called.node).collect();
        nodes.sort_unstable();
        nodes
    }

    fn of(&self, node: NodeId) -> &Called {
        &self.called[self.places[node as usize] as usize]
    }

    /// The sum of the unit vectors towards the callers of a called node.
    pub(super) fn pull(&self, node: NodeId) -> DVec2 {
        self.of(node).pull
    }

    /// How many call a called node.
    pub(super) fn count(&self, node: NodeId) -> usize {
        self.of(node).count as usize
    }

    /// Where the callers of a called node are, by their ids.
    fn callers(&self, node: NodeId) -> impl Iterator<Item = DVec2> + '_ {
        let call = |at: u32| (at != NONE).then(|| &self.calls[at as usize]);
        std::iter::successors(call(self.of(node).first), move |&&Call { next, .. }| call(next))
            .map(|call| call.from)
    }

    /// The unit vectors from a called node at `p` towards its callers, by their ids.
    pub(super) fn units(&self, node: NodeId, p: DVec2, metric: Metric) -> Vec<DVec2> {
        self.callers(node).map(|source| unit(p, source, metric)).collect()
    }

    /// The unit vector from a called node at `p` towards its nearest caller, the first among equals.
    pub(super) fn unit_to_nearest(&self, node: NodeId, p: DVec2, metric: Metric) -> DVec2 {
        let distance2 = |source: &DVec2| metric.distance_squared(*source, p);
        let nearest = self.callers(node).min_by(|a, b| distance2(a).total_cmp(&distance2(b)));
        nearest.map_or(DVec2::ZERO, |source| unit(p, source, metric))
    }
}

/// The unit vector from a node to a source.
pub(super) fn unit(node: DVec2, source: DVec2, metric: Metric) -> DVec2 {
    let towards = metric.between(node, source);
    towards / towards.length_squared().sqrt()
}
