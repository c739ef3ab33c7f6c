//! The calls of one step: which nodes are called, and by which sources.

use glam::DVec2;

use super::NONE;
use crate::veins::graph::NodeId;

/// The calls of one node.
#[derive(Debug, Clone, Copy)]
struct Called {
    /// The sum of the unit vectors towards the callers.
    pull: DVec2,
    first: u32,
    last: u32,
    count: u32,
    /// The step this is from.
    round: u32,
}

const NEVER: Called = Called { pull: DVec2::ZERO, first: NONE, last: NONE, count: 0, round: 0 };

/// Who calls whom.
#[derive(Debug, Default)]
pub(super) struct Calls {
    /// By node.
    called: Vec<Called>,
    /// The caller, and the next call of the same node.
    calls: Vec<(u32, u32)>,
    /// Nodes that are called.
    nodes: Vec<NodeId>,
    round: u32,
}

impl Calls {
    /// Begins a step with that many nodes.
    pub(super) fn begin(&mut self, nodes: usize) {
        self.called.resize(nodes, NEVER);
        self.calls.clear();
        self.nodes.clear();
        self.round += 1;
    }

    /// Lets a source call a node, which lies in the direction −`unit`.
    ///
    /// Sources call in the order of their ids: floating-point addition is not associative.
    pub(super) fn add(&mut self, source: u32, node: NodeId, unit: DVec2) {
        let call = self.calls.len() as u32;
        self.calls.push((source, NONE));
        let entry = &mut self.called[node as usize];
        if entry.round == self.round {
            self.calls[entry.last as usize].1 = call;
            entry.last = call;
            entry.count += 1;
            entry.pull += unit;
        } else {
            *entry = Called { pull: unit, first: call, last: call, count: 1, round: self.round };
            self.nodes.push(node);
        }
    }

    /// The called nodes, ascending.
    pub(super) fn take_nodes(&mut self) -> Vec<NodeId> {
        self.nodes.sort_unstable();
        std::mem::take(&mut self.nodes)
    }

    /// The sum of the unit vectors towards the callers of a called node.
    pub(super) fn pull(&self, node: NodeId) -> DVec2 {
        self.called[node as usize].pull
    }

    /// How many call a called node.
    pub(super) fn count(&self, node: NodeId) -> usize {
        self.called[node as usize].count as usize
    }

    /// The callers of a called node, ascending.
    pub(super) fn callers(&self, node: NodeId) -> impl Iterator<Item = u32> + '_ {
        let call = |at: u32| (at != NONE).then(|| self.calls[at as usize]);
        let first = call(self.called[node as usize].first);
        std::iter::successors(first, move |&(_, next)| call(next)).map(|(source, _)| source)
    }
}
