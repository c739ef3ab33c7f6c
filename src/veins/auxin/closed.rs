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

mod calling;
mod reached;
mod states;

use std::ops::Range;

use glam::DVec2;

use self::states::look_around;
use super::NONE;
use super::callers::{self, Callers, Ranges};
use super::calls::Round;
use super::field::{Birth, Field};
use super::horizon::Horizon;
use super::neighbours::{Around, SECTORS};
use super::nodes::Nodes;
use super::open;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// A tagged source waits this many times as long as its farthest vein would need.
const PATIENCE: f64 = 2.0;

/// The veins that a source waits for.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Tag {
    veins: [NodeId; SECTORS],
    last_step: u64,
}

/// What a source knows of the nodes.
#[derive(Debug, Clone, Copy)]
struct State {
    around: Around,
    /// Its tag, or [`NONE`].
    tag: u32,
}

/// The living sources and whom they call.
pub(super) struct Sources {
    field: Field<State>,
    horizon: Horizon,
    ranges: Ranges,
    round: Round,
    /// What sources that call find out, by share.
    answers: Vec<calling::Answers>,
    /// What is found out of those that wait, by share.
    settled: Vec<reached::Settled>,
    tags: Vec<Tag>,
    free_tags: Vec<u32>,
    /// Sources to which a node has come within the kill distance, and those that wait.
    reached: Vec<u32>,
    deforms: bool,
    /// Distances may shrink, too: every source is looked after in every step.
    warps: bool,
    convex: bool,
}

impl Sources {
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Self {
        Self {
            field: Field::new(blade.mature().bounds()),
            horizon: Horizon::new(blade.mature().outline()),
            ranges: Ranges::new(spec),
            round: Round::default(),
            answers: Vec::new(),
            settled: Vec::new(),
            tags: Vec::new(),
            free_tags: Vec::new(),
            reached: Vec::new(),
            deforms: blade.deforms(),
            warps: blade.is_warped(),
            convex: blade.is_convex(),
        }
    }

    /// Whether a source at `p` sees its neighbour in a sixth.
    fn sight(&self, around: &Around, p: DVec2, (k, node): (usize, NodeId), at: At<'_>) -> Sight {
        if self.convex {
            return Sight { is_clear: true, is_lasting: false };
        }
        if let Some(is_clear) = around.sight(k) {
            return Sight { is_clear, is_lasting: false };
        }
        let q = at.nodes.position(node);
        if at.blade.blocks_sight_for_ever(p, q) {
            return Sight { is_clear: false, is_lasting: true };
        }
        // The blade only gains tissue: what is clear stays clear.
        let is_clear = !at.blade.blocks_sight_yet(p, q, at.step);
        Sight { is_clear, is_lasting: is_clear }
    }

    /// Takes note of what sources were born.
    fn note_births(&mut self, born: Range<u32>, metric: Metric) {
        let (field, kill2) = (&self.field, self.ranges.kill2(metric));
        let has_come = |id: &u32| {
            field.slot(*id).is_some_and(|slot| field.state(slot).around.least2() <= kill2)
        };
        self.reached.extend(field.acting_since(born.start).filter(has_come));
    }

    /// The same sources in open venation.
    pub(super) fn opened(
        &self,
        spec: &VeinSpec,
        blade: &GrowingBlade,
        metric: Metric,
        nodes: &Nodes,
    ) -> open::Sources {
        let mut sources = open::Sources::new(spec, blade);
        for id in 0..self.field.len() as u32 {
            match self.field.slot(id) {
                Some(slot) => sources.add(self.field.place(slot), nodes, metric),
                None => sources.add_spent(),
            }
        }
        sources
    }
}

/// What a source that knows the nodes around it knows when it is born.
fn birth(around: Around, warps: bool) -> Birth<State> {
    let is_acting = around.least2().is_finite() || warps;
    Birth { bound2: around.most2(), is_acting, state: State { around, tag: NONE } }
}

/// Whether a source sees a neighbour.
struct Sight {
    is_clear: bool,
    /// Whether that is news and remains so.
    is_lasting: bool,
}

/// Where and when.
#[derive(Clone, Copy)]
struct At<'a> {
    blade: &'a GrowingBlade,
    step: u64,
    nodes: &'a Nodes,
}

impl Callers for Sources {
    fn len(&self) -> usize {
        self.field.len()
    }

    fn living(&self) -> usize {
        self.field.living()
    }

    fn add_all(&mut self, places: &[DVec2], nodes: &Nodes, metric: Metric) {
        self.horizon.follow(metric);
        let Self { field, horizon, ranges, warps, .. } = self;
        let search = ranges.search(metric);
        let birth = |p| birth(look_around(p, nodes, metric, search, horizon), *warps);
        let born = field.add_all(places, metric.reach(search), calling::A_THREAD, birth);
        self.note_births(born, metric);
    }

    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        self.horizon.follow(metric);
        let id = self.field.add(p, birth(self.look_around(p, nodes, metric), self.warps));
        self.note_births(id..id + 1, metric);
    }

    fn keep_order(&mut self, metric: Metric) {
        self.field.keep_order(metric.reach(self.ranges.search(metric)));
    }

    fn call(&mut self, blade: &GrowingBlade, step: u64, metric: Metric, nodes: &Nodes) {
        self.horizon.follow(metric);
        self.call_all(At { blade, step, nodes }, metric);
    }

    fn calls(&self) -> &Round {
        &self.round
    }

    fn place(&self, source: u32) -> DVec2 {
        self.field.place_of(source)
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
        self.offer(before, metric, nodes);
        let dead = self.settle_reached(blade, step, metric, nodes, true);
        self.offer(grown, metric, nodes);
        dead
    }

    fn is_waiting(&self) -> bool {
        !self.reached.is_empty()
    }

    fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        let search2 = self.ranges.search2(blade.frame(blade.last_step()).metric());
        callers::unreached(&self.field, blade, nodes, |slot| {
            let nearest = self.field.state(slot).around.nearest();
            nearest.filter(|&(distance2, _)| distance2 <= search2).map(|(_, node)| node)
        })
    }
}
