//! The calls of one step: which nodes are called, and by which sources.

use glam::DVec2;

use super::NONE;
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

/// Who calls whom.
#[derive(Debug, Default)]
pub(super) struct Calls {
    /// By node, where its calls may be: valid if the node is named there. Small and never cleared,
    /// for few nodes are called in a step.
    places: Vec<u32>,
    called: Vec<Called>,
    /// The caller, and the next call of the same node.
    calls: Vec<(u32, u32)>,
}

impl Calls {
    /// Begins a step with that many nodes.
    pub(super) fn begin(&mut self, nodes: usize) {
        self.places.resize(nodes, 0);
        self.calls.clear();
        self.called.clear();
    }

    /// Lets a source call a node, which lies in the direction −`unit`.
    ///
    /// Sources call in the order of their ids: floating-point addition is not associative.
    pub(super) fn add(&mut self, source: u32, node: NodeId, unit: DVec2) {
        let call = self.calls.len() as u32;
        self.calls.push((source, NONE));
        match self.called.get_mut(self.places[node as usize] as usize) {
            Some(entry) if entry.node == node => {
                self.calls[entry.last as usize].1 = call;
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

    /// The callers of a called node, ascending.
    pub(super) fn callers(&self, node: NodeId) -> impl Iterator<Item = u32> + '_ {
        let call = |at: u32| (at != NONE).then(|| self.calls[at as usize]);
        std::iter::successors(call(self.of(node).first), move |&(_, next)| call(next))
            .map(|(source, _)| source)
    }
}
