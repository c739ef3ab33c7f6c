//! The calls of one step: which nodes are called, and by which sources.

use glam::DVec2;

use super::NONE;
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// The calls of one node.
#[derive(Debug, Clone, Copy)]
struct Called {
    node: NodeId,
    count: u32,
    /// The sum of the unit vectors towards the callers.
    pull: DVec2,
    first: u32,
    last: u32,
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
    /// The called nodes, ascending, each with its place in `called`.
    order: Vec<(NodeId, u32)>,
    /// They themselves in that order: for whoever takes them over from another thread.
    ascending: Vec<Called>,
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
                self.called.push(Called { node, count: 1, pull: unit, first: call, last: call });
            }
        }
    }

    /// Takes note that all have called.
    pub(super) fn end(&mut self) {
        self.order.clear();
        self.order.extend(self.called.iter().map(|called| called.node).zip(0..));
        self.order.sort_unstable();
        self.ascending.clear();
        self.ascending.extend(self.order.iter().map(|&(_, at)| self.called[at as usize]));
    }

    /// Who calls a node, ascending.
    fn callers(&self, called: &Called) -> impl Iterator<Item = u32> {
        let call = |at: u32| (at != NONE).then(|| self.calls[at as usize]);
        std::iter::successors(call(called.first), move |&Call { next, .. }| call(next))
            .map(|call| call.source)
    }
}

/// The calls of a step by share of the sources, and whom they call together.
#[derive(Debug, Default)]
pub(super) struct Round {
    shares: Vec<Calls>,
    /// The calls of nodes that sources of several shares call.
    shared: Calls,
    /// The called nodes of all shares, one share after the other, and then those that are shared: who grows
    /// them finds them in a row, and not in what other threads have just written.
    called: Vec<Called>,
    /// Where those of each share end.
    ends: Vec<usize>,
    /// The called nodes, ascending, each with its place in `called`.
    order: Vec<(NodeId, u32)>,
}

impl Round {
    /// Where the sources of each share are to note their calls.
    pub(super) fn shares(&mut self, shares: usize) -> &mut [Calls] {
        self.shares.resize_with(shares, Calls::default);
        &mut self.shares
    }

    /// Takes note that all shares have called; `unit` tells the unit vector from a node towards a source.
    pub(super) fn end(&mut self, unit: impl Fn(NodeId, u32) -> DVec2) {
        let Self { shares, shared, called, ends, order } = self;
        called.clear();
        ends.clear();
        for calls in &*shares {
            called.extend_from_slice(&calls.ascending);
            ends.push(called.len());
        }
        order.clear();
        order.extend(called.iter().map(|called| called.node).zip(0..));
        if shares.len() < 2 {
            return;
        }
        shared.begin(shares[0].places.len());
        // Few runs in order, which this sort makes use of.
        order.sort();
        let alone = called.len();
        order.dedup_by(|later, earlier| {
            let (node, is_shared) = (later.0, later.0 == earlier.0);
            if is_shared && (earlier.1 as usize) < alone {
                earlier.1 = (alone + shared.called.len()) as u32;
                let mut callers = Vec::new();
                for calls in &*shares {
                    if let Ok(at) = calls.order.binary_search_by_key(&node, |&(node, _)| node) {
                        callers.extend(calls.callers(&calls.called[calls.order[at].1 as usize]));
                    }
                }
                callers.sort_unstable();
                callers.into_iter().for_each(|source| shared.add(source, node, unit(node, source)));
            }
            is_shared
        });
        called.extend_from_slice(&shared.called);
    }

    /// The called nodes, ascending.
    pub(super) fn called(&self) -> impl Iterator<Item = CallsOf<'_>> {
        self.order.iter().map(|&(_, at)| CallsOf { round: self, at: at as usize })
    }
}

/// The calls of one node.
#[derive(Debug, Clone, Copy)]
pub(super) struct CallsOf<'a> {
    round: &'a Round,
    at: usize,
}

impl<'a> CallsOf<'a> {
    fn called(self) -> &'a Called {
        &self.round.called[self.at]
    }

    /// Whom they call.
    pub(super) fn node(self) -> NodeId {
        self.called().node
    }

    /// The sum of the unit vectors towards the callers.
    pub(super) fn pull(self) -> DVec2 {
        self.called().pull
    }

    /// How many call.
    pub(super) fn count(self) -> usize {
        self.called().count as usize
    }

    /// Who calls, ascending.
    pub(super) fn callers(self) -> impl Iterator<Item = u32> {
        let share = self.round.ends.partition_point(|&end| end <= self.at);
        self.round.shares.get(share).unwrap_or(&self.round.shared).callers(self.called())
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
                let calls = round.shares(shares);
                calls.iter_mut().for_each(|calls| calls.begin(positions.len()));
                for (id, &from) in (0..).zip(&sources) {
                    let node = nearest(from);
                    let unit = unit(positions[node], from, metric);
                    calls[(from.x * shares as f64) as usize].add(id, node as NodeId, unit);
                }
                calls.iter_mut().for_each(Calls::end);
                round.end(|node, id| unit(positions[node as usize], sources[id as usize], metric));
            }
            let told = |calls: CallsOf<'_>| {
                (calls.node(), calls.pull(), calls.count(), calls.callers().collect::<Vec<_>>())
            };
            round.called().map(told).collect::<Vec<_>>()
        };
        let together = round(1);
        assert!(together.len() > 30);
        assert_eq!(round(2), together);
        assert_eq!(round(3), together);
    }
}
