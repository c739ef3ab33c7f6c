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
    source: u32,
    /// The next call of the same node.
    next: u32,
}

/// Who calls whom.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Calls {
    /// By node, where its calls may be: valid if the node is named there. Small and never cleared,
    /// for few nodes are called in a step.
    places: Vec<u32>,
    called: Vec<Called>,
    calls: Vec<Call>,
    /// The called nodes, ascending.
    nodes: Vec<NodeId>,
}

impl Calls {
    /// Begins a step with that many nodes.
    fn begin(&mut self, nodes: usize) {
        self.places.resize(nodes, 0);
        self.calls.clear();
        self.called.clear();
    }

    /// Lets a source call a node, which lies in the direction −`unit`.
    ///
    /// Sources call in the order of their ids: floating-point addition is not associative.
    pub(super) fn add(&mut self, source: u32, node: NodeId, unit: DVec2) {
        let call = self.calls.len() as u32;
        self.calls.push(Call { source, next: NONE });
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

    /// Takes note that all have called.
    pub(super) fn end(&mut self) {
        self.nodes.clear();
        self.nodes.extend(self.called.iter().map(|called| called.node));
        self.nodes.sort_unstable();
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
    pub(super) fn callers(&self, node: NodeId) -> impl Iterator<Item = u32> {
        let call = |at: u32| (at != NONE).then(|| self.calls[at as usize]);
        std::iter::successors(call(self.of(node).first), move |&Call { next, .. }| call(next))
            .map(|call| call.source)
    }
}

/// The calls of a step by share of the sources, and whom they call together.
#[derive(Debug, Default)]
pub(super) struct Round {
    shares: Vec<Calls>,
    /// The calls of nodes that sources of several shares call.
    shared: Calls,
    /// The called nodes, ascending, each with the number of the share that calls it; after the last the
    /// number of those that are shared.
    called: Vec<(NodeId, u32)>,
}

impl Round {
    /// Begins a step with that many nodes; where the sources of each share note their calls.
    pub(super) fn begin(&mut self, nodes: usize, shares: usize) -> &mut [Calls] {
        self.shares.resize_with(shares, Calls::default);
        self.shares.iter_mut().for_each(|calls| calls.begin(nodes));
        &mut self.shares
    }

    /// Takes note that all shares have called; `unit` tells the unit vector from a node towards a source.
    pub(super) fn end(&mut self, unit: impl Fn(NodeId, u32) -> DVec2) {
        let Self { shares, shared, called } = self;
        called.clear();
        for (share, calls) in (0..).zip(&*shares) {
            called.extend(calls.nodes.iter().map(|&node| (node, share)));
        }
        if shares.len() < 2 {
            return;
        }
        shared.begin(shares[0].places.len());
        // Few runs in order, which this sort makes use of.
        called.sort();
        let several = shares.len() as u32;
        called.dedup_by(|later, earlier| {
            let (node, is_shared) = (later.0, later.0 == earlier.0);
            if is_shared && earlier.1 != several {
                earlier.1 = several;
                let calls = |share: &&Calls| share.nodes.binary_search(&node).is_ok();
                let callers = shares.iter().filter(calls).flat_map(|share| share.callers(node));
                let mut callers: Vec<u32> = callers.collect();
                callers.sort_unstable();
                callers.into_iter().for_each(|source| shared.add(source, node, unit(node, source)));
            }
            is_shared
        });
    }

    /// The called nodes, ascending, each with the calls that hold its own.
    pub(super) fn called(&self) -> impl Iterator<Item = (NodeId, &Calls)> {
        let calls = |share: u32| self.shares.get(share as usize).unwrap_or(&self.shared);
        self.called.iter().map(move |&(node, share)| (node, calls(share)))
    }
}

/// The unit vector from a node to a source.
pub(super) fn unit(node: DVec2, source: DVec2, metric: Metric) -> DVec2 {
    let towards = metric.between(node, source);
    towards / towards.length_squared().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::growth::{GrowingBlade, GrowthSpec};
    use crate::margin::{self, MarginSpec};
    use crate::seed::{Seed, Stage};

    #[test]
    fn shares_call_as_all_would_together() {
        let mut rng = Seed(8).stream(Stage::Tissue);
        let mut place = || DVec2::new(rng.unit(), rng.unit());
        let positions: Vec<DVec2> = (0..40).map(|_| place()).collect();
        let sources: Vec<DVec2> = (0..200).map(|_| place()).collect();
        let margin = margin::build(&MarginSpec::default(), Seed(1)).expect("the default margin");
        let blade = GrowingBlade::new(margin, &GrowthSpec::default()).expect("it grows");
        let frame = blade.frame(100);
        let metric = frame.metric();
        let nearest = |source: DVec2| {
            let distance2 = |i: &usize| positions[*i].distance_squared(source);
            (0..40).min_by(|a, b| distance2(a).total_cmp(&distance2(b))).expect("nodes")
        };
        let round = |shares: usize| {
            let mut round = Round::default();
            for _ in 0..2 {
                let calls = round.begin(positions.len(), shares);
                for (id, &from) in (0..).zip(&sources) {
                    let node = nearest(from);
                    let unit = unit(positions[node], from, metric);
                    calls[(from.x * shares as f64) as usize].add(id, node as NodeId, unit);
                }
                calls.iter_mut().for_each(Calls::end);
                round.end(|node, id| unit(positions[node as usize], sources[id as usize], metric));
            }
            let told = |(node, calls): (NodeId, &Calls)| {
                (node, calls.pull(node), calls.count(node), calls.callers(node).collect::<Vec<_>>())
            };
            round.called().map(told).collect::<Vec<_>>()
        };
        let together = round(1);
        assert!(together.len() > 30);
        assert_eq!(round(2), together);
        assert_eq!(round(3), together);
    }
}
