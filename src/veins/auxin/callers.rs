//! What the loop of growth asks of the sources, however they choose whom to call, and what both
//! ways of choosing have in common.

use glam::DVec2;

use super::calls::{Calls, Round, unit};
use super::field::{Acting, Field};
use super::nodes::Nodes;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// The living sources and whom they call.
pub(super) trait Callers {
    /// Sources that ever were.
    fn len(&self) -> usize;

    /// Sources that are left.
    fn living(&self) -> usize;

    /// Adds sources.
    fn add_all(&mut self, places: &[DVec2], nodes: &Nodes, metric: Metric) {
        places.iter().for_each(|&p| self.add(p, nodes, metric));
    }

    /// Adds a source.
    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric);

    /// Follows the sources that were born and died.
    fn keep_order(&mut self, metric: Metric);

    /// Lets every source call.
    fn call(&mut self, blade: &GrowingBlade, step: u64, metric: Metric, nodes: &Nodes);

    /// The calls of this step.
    fn calls(&self) -> &Round;

    /// Where a living source is.
    fn place(&self, source: u32) -> DVec2;

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

/// Lets the sources in reach call, each share of them in the order of their ids: `ask` notes the calls of one
/// and what it found out, and says whether it stays in reach. Each thread is given `a_thread` at least.
pub(super) fn call_by_share<S: Copy + Send + Sync, A: Default + Send>(
    (field, acting): (&Field<S>, &mut [Acting]),
    (round, answers): (&mut Round, &mut Vec<A>),
    a_thread: usize,
    (nodes, metric): (&Nodes, Metric),
    ask: impl Fn(u32, &mut Calls, &mut A) -> bool + Sync,
) {
    answers.resize_with(acting.len(), A::default);
    let count: usize = acting.iter().map(Acting::len).sum();
    let is_enough = count >= acting.len() * a_thread;
    let calls = round.shares(acting.len());
    let mut pieces: Vec<_> = acting.iter_mut().zip(calls).zip(answers).collect();
    field.each_share(&mut pieces, is_enough, |((acting, calls), answers)| {
        calls.begin(nodes.len());
        acting.retain(|source| ask(source, calls, answers));
        calls.end();
    });
    round.end(|node, source| unit(nodes.position(node), field.place_of(source), metric));
}

/// How far nodes matter to sources, in lengths of the blade.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ranges {
    reach_mm: f64,
    kill_mm: f64,
}

impl Ranges {
    pub(super) fn new(spec: &VeinSpec) -> Self {
        let unlimited = spec.attraction_distance_mm == 0.0;
        let reach_mm = if unlimited { f64::INFINITY } else { spec.attraction_distance_mm };
        Self { reach_mm, kill_mm: spec.kill_distance_mm }
    }

    /// Whether all nodes matter to all sources.
    pub(super) fn are_unlimited(&self) -> bool {
        self.reach_mm.is_infinite()
    }

    /// How far a node can matter to a source: by being called or by having come.
    pub(super) fn search(&self, metric: Metric) -> f64 {
        metric.length(self.reach_mm.max(self.kill_mm))
    }

    /// The same, squared.
    pub(super) fn search2(&self, metric: Metric) -> f64 {
        self.search(metric).powi(2)
    }

    /// How far a source calls, squared.
    pub(super) fn reach2(&self, metric: Metric) -> f64 {
        metric.length(self.reach_mm).powi(2)
    }

    /// Where a node has come to a source, squared.
    pub(super) fn kill2(&self, metric: Metric) -> f64 {
        metric.length(self.kill_mm).powi(2)
    }
}

/// Why sources are left, where `nearest` tells the nearest node in reach of one in a slot.
pub(super) fn unreached<S: Copy + Send + Sync>(
    field: &Field<S>,
    blade: &GrowingBlade,
    nodes: &Nodes,
    nearest: impl Fn(usize) -> Option<NodeId>,
) -> Unreached {
    let mut unreached = Unreached::default();
    for slot in field.living_slots() {
        let node = if field.source(slot).is_acting { nearest(slot) } else { None };
        let Some(node) = node else {
            unreached.out_of_reach += 1;
            continue;
        };
        if blade.blocks_sight(field.place(slot), nodes.position(node), blade.last_step()) {
            unreached.hidden += 1;
        } else {
            unreached.unfinished += 1;
        }
    }
    unreached
}
