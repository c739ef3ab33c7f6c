//! Closed venation: each source calls its relative neighbours, and veins that come to it meet there.
//!
//! A source keeps its relative neighbours ([`super::neighbours`]); while the blade does not deform
//! unevenly a node once shielded stays shielded, so only new nodes change them. Under uneven growth
//! they are looked up anew in every step. When the first node comes within the kill distance the
//! source is *tagged* with the nodes that then are its visible relative neighbours: from now on it calls
//! only these and what grows out of them, and it is used up when each of them has come within
//! the kill distance or is a relative neighbour no longer. Then those that have come are brought
//! together at its place.
//!
//! Source: Runions et al. 2005, section 3.3. Departs from it: neighbours are exact, not taken from a Delaunay
//! graph; a tagged source waits no longer than twice the time that the farthest of its veins needs on
//! a straight way, because one that others hold away would be called for ever; loops are stored.

mod reached;
mod states;

use glam::DVec2;

use super::callers::Callers;
use super::claims::NONE;
use super::extend::Nodes;
use super::neighbours::{Around, SECTORS};
use super::open::{self, merge};
use super::source_index::SourceIndex;
use crate::geometry::Rect;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// A tagged source waits this many times as long as its farthest vein would need.
const PATIENCE: f64 = 2.0;

/// In place of the distance from which on a node does not matter, for a dead source.
const DEAD: f64 = -1.0;

/// One call: a source and one of its relative neighbours.
#[derive(Debug, Clone, Copy)]
struct Call {
    unit: DVec2,
    distance2: f64,
    /// The next call of the same node.
    next: u32,
}

/// The calls of one node in one step.
#[derive(Debug, Clone, Copy)]
struct Called {
    pull: DVec2,
    first: u32,
    last: u32,
    /// The round of calls this is from.
    round: u32,
}

/// The veins that a source waits for.
#[derive(Debug, Clone, Copy)]
struct Tag {
    veins: [NodeId; SECTORS],
    last_step: u64,
}

/// What changes about a source.
#[derive(Debug, Clone, Copy)]
struct State {
    place: DVec2,
    around: Around,
    source: u32,
    /// Its tag, or [`NONE`].
    tag: u32,
    is_acting: bool,
}

/// The living sources and whom they call.
pub(super) struct Calls {
    positions: Vec<DVec2>,
    /// Where the state of each source is; neighbours in the blade are neighbours there, so that a new
    /// node finds the sources around it together in memory. [`NONE`] for those long dead.
    slots: Vec<u32>,
    states: Vec<State>,
    /// For each state: from this far (squared) on a node does not matter; [`DEAD`] at the end.
    outer2: Vec<f64>,
    tags: Vec<Tag>,
    free_tags: Vec<u32>,
    /// Sources in reach of a node, ascending.
    acting: Vec<u32>,
    /// Sources that came into reach since the last step.
    arrived: Vec<u32>,
    /// Sources to which a node has come within the kill distance, and those that wait.
    reached: Vec<u32>,
    calls: Vec<Call>,
    called: Vec<Called>,
    round: u32,
    living: usize,
    index: SourceIndex,
    bounds: Rect,
    reach_mm: f64,
    kill_mm: f64,
    step_mm: f64,
    deforms: bool,
    /// Distances may shrink, too: every source is looked after in every step.
    warps: bool,
    convex: bool,
}

impl Calls {
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Self {
        let unlimited = spec.attraction_distance_mm == 0.0;
        Self {
            positions: Vec::new(),
            slots: Vec::new(),
            states: Vec::new(),
            outer2: Vec::new(),
            tags: Vec::new(),
            free_tags: Vec::new(),
            acting: Vec::new(),
            arrived: Vec::new(),
            reached: Vec::new(),
            calls: Vec::new(),
            called: Vec::new(),
            round: 0,
            living: 0,
            index: SourceIndex::new(),
            bounds: blade.mature().bounds(),
            reach_mm: if unlimited { f64::INFINITY } else { spec.attraction_distance_mm },
            kill_mm: spec.kill_distance_mm,
            step_mm: spec.node_step_mm,
            deforms: blade.deforms(),
            warps: blade.is_warped(),
            convex: blade.is_convex(),
        }
    }

    /// How far a node can matter to a source: by calling or by having come.
    fn search(&self, metric: Metric) -> f64 {
        metric.length(self.reach_mm.max(self.kill_mm))
    }

    fn kill2(&self, metric: Metric) -> f64 {
        metric.length(self.kill_mm).powi(2)
    }

    /// Whether a source sees its neighbour in a sixth.
    fn sees(&mut self, i: usize, k: usize, node: NodeId, at: At<'_>) -> bool {
        if self.convex {
            return true;
        }
        if let Some(sight) = self.states[i].around.sight(k) {
            return sight;
        }
        let (p, q) = (self.states[i].place, at.nodes.position(node));
        if at.blade.blocks_sight_for_ever(p, q) {
            self.states[i].around.set_sight(k, false);
            return false;
        }
        let clear = !at.blade.blocks_sight_yet(p, q, at.step);
        if clear {
            // The blade only gains tissue: what is clear stays clear.
            self.states[i].around.set_sight(k, true);
        }
        clear
    }

    /// The calls of a called node, by the ids of the callers.
    fn calls_of(&self, node: NodeId) -> impl Iterator<Item = &Call> + '_ {
        let call = |at: u32| (at != NONE).then(|| &self.calls[at as usize]);
        std::iter::successors(call(self.called[node as usize].first), move |last| call(last.next))
    }

    /// The same sources in open venation.
    pub(super) fn opened(
        &self,
        spec: &VeinSpec,
        blade: &GrowingBlade,
        metric: Metric,
        nodes: &Nodes,
    ) -> open::Calls {
        let mut calls = open::Calls::new(spec, blade);
        for (i, &p) in self.positions.iter().enumerate() {
            if self.slot(i as u32).is_some() {
                calls.add(p, nodes, metric);
            } else {
                calls.add_spent(p);
            }
        }
        calls
    }
}

/// Where and when.
#[derive(Clone, Copy)]
struct At<'a> {
    blade: &'a GrowingBlade,
    step: u64,
    nodes: &'a Nodes,
}

impl Callers for Calls {
    fn len(&self) -> usize {
        self.positions.len()
    }

    fn living(&self) -> usize {
        self.living
    }

    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        let id = self.positions.len() as u32;
        let around = self.look_around(p, nodes, metric);
        let least2 = around.least2();
        self.positions.push(p);
        self.slots.push(self.states.len() as u32);
        self.outer2.push(around.most2());
        let is_acting = least2.is_finite() || self.warps;
        self.index.push();
        self.states.push(State { place: p, around, source: id, tag: NONE, is_acting });
        if is_acting {
            self.arrived.push(id);
        }
        if least2 <= self.kill2(metric) {
            self.reached.push(id);
        }
        self.living += 1;
    }

    fn keep_index(&mut self) {
        if self.reach_mm.is_finite() && self.index.is_stale(self.living) {
            self.tidy();
            self.index.build(self.states.iter().map(|state| state.place));
        }
    }

    fn call(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &Nodes,
    ) -> Vec<NodeId> {
        let mut acting = std::mem::take(&mut self.acting);
        self.arrived.sort_unstable();
        merge(&mut acting, &self.arrived);
        self.arrived.clear();
        self.calls.clear();
        let never = Called { pull: DVec2::ZERO, first: NONE, last: NONE, round: 0 };
        self.called.resize(nodes.len(), never);
        self.round += 1;
        let at = At { blade, step, nodes };
        let (kill2, search2) = (self.kill2(metric), self.search(metric).powi(2));
        let reach2 = metric.length(self.reach_mm).powi(2);
        let mut called = Vec::new();
        // Ascending: sums over callers are taken in the order of their ids, because floating-point
        // addition is not associative.
        acting.retain(|&source| {
            let Some(i) = self.slot(source) else { return false };
            if self.deforms {
                let around = self.look_around(self.states[i].place, nodes, metric);
                self.store(i, around);
            }
            let around = self.states[i].around;
            if self.warps && around.least2() <= kill2 && self.states[i].tag == NONE {
                self.reached.push(source);
            }
            if around.least2() > search2 {
                if self.warps {
                    return true;
                }
                // Distances only grow: those nodes will not matter again.
                self.states[i].is_acting = false;
                self.store(i, Around::EMPTY);
                return false;
            }
            if self.states[i].tag != NONE {
                self.follow_tag(i, nodes);
            }
            for (k, node, distance2) in around.neighbours() {
                let is_called = distance2 > kill2
                    && distance2 <= reach2
                    && (self.states[i].tag == NONE
                        || self.tags[self.states[i].tag as usize].veins[k] == node)
                    && self.sees(i, k, node, at);
                if !is_called {
                    continue;
                }
                let towards = metric.between(nodes.position(node), self.states[i].place);
                let unit = towards / distance2.sqrt();
                let call = self.calls.len() as u32;
                self.calls.push(Call { unit, distance2, next: NONE });
                let entry = &mut self.called[node as usize];
                if entry.round != self.round {
                    let round = self.round;
                    *entry = Called { pull: DVec2::ZERO, first: call, last: call, round };
                    called.push(node);
                } else {
                    self.calls[entry.last as usize].next = call;
                    entry.last = call;
                }
                entry.pull += unit;
            }
            true
        });
        self.acting = acting;
        called.sort_unstable();
        called
    }

    fn pull(&self, node: NodeId) -> DVec2 {
        self.called[node as usize].pull
    }

    fn count(&self, node: NodeId) -> usize {
        self.calls_of(node).count()
    }

    fn units(&self, node: NodeId, _: &Nodes, _: Metric) -> Vec<DVec2> {
        self.calls_of(node).map(|call| call.unit).collect()
    }

    fn unit_to_nearest(&self, node: NodeId, _: &Nodes, _: Metric) -> DVec2 {
        let nearest = self.calls_of(node).min_by(|a, b| a.distance2.total_cmp(&b.distance2));
        nearest.map_or(DVec2::ZERO, |call| call.unit)
    }

    fn take_over(
        &mut self,
        before: usize,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &mut Nodes,
    ) -> Vec<u32> {
        let grown = nodes.len();
        (before..grown).for_each(|node| self.offer(node as NodeId, metric, nodes));
        let dead = self.settle_reached(blade, step, metric, nodes, true);
        (grown..nodes.len()).for_each(|node| self.offer(node as NodeId, metric, nodes));
        dead
    }

    fn is_waiting(&self) -> bool {
        !self.reached.is_empty()
    }

    fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        let mut unreached = Unreached::default();
        let search2 = self.search(blade.frame(blade.last_step()).metric()).powi(2);
        for i in (0..self.states.len()).filter(|&i| self.outer2[i] != DEAD) {
            let hidden = |node: NodeId| {
                let step = blade.last_step();
                blade.blocks_sight(self.states[i].place, nodes.position(node), step)
            };
            match self.states[i].around.nearest() {
                Some((distance2, node)) if distance2 <= search2 && self.states[i].is_acting => {
                    if hidden(node) {
                        unreached.hidden += 1;
                    } else {
                        unreached.unfinished += 1;
                    }
                }
                _ => unreached.out_of_reach += 1,
            }
        }
        unreached
    }
}
