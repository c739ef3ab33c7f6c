//! Open venation: each source calls the one node it is nearest to, and veins never meet.
//!
//! A source remembers its nearest node. Distances between tissue never shrink in the model's measure,
//! so only a new node can take a source over: the work follows what changed, not what is there.
//! With a reach, each new node looks for the sources around it that it is nearer to
//! ([`super::field`]); without, tiles of sources look at the new nodes of the step ([`super::tiles`]).
//! Where the blade changes its proportions an old node can become the nearest too: then each source
//! also keeps a lower bound on the distance of all others and searches again when its nearest node
//! grows past it.

use std::ops::Range;

use glam::DVec2;

use super::NONE;
use super::callers::{self, Callers, Ranges};
use super::calls::{Calls, Round, unit};
use super::claims::{Claim, Sight};
use super::field::{Birth, DEAD, Field, Told};
use super::nodes::Nodes;
use super::tiles::Tiles;
use super::views::{GONE, Views, callee};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// New nodes, or sources that call, for each thread, at least: a source only compares a distance.
const A_THREAD: usize = 64;

/// What some sources found out. Kept for its memory.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Answers {
    /// The slots of those out of reach of all nodes.
    retired: Vec<usize>,
    /// By slot, what is known now of the sight of the nearest node.
    sights: Vec<(usize, Sight)>,
}

/// The living sources and whom they call.
pub(super) struct Sources {
    field: Field<Claim>,
    ranges: Ranges,
    round: Round,
    /// What sources that call find out, by share.
    answers: Vec<Answers>,
    /// Sources born within the kill distance: they call once.
    doomed: Vec<u32>,
    /// Without a reach.
    tiles: Option<Tiles>,
    /// Without a reach, where distances do not change; else empty.
    views: Views,
    deforms: bool,
    /// Distances may shrink, too: every source is looked after in every step.
    warps: bool,
    convex: bool,
}

impl Sources {
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Self {
        let ranges = Ranges::new(spec);
        Self {
            field: Field::new(blade.mature().bounds()),
            ranges,
            round: Round::default(),
            answers: Vec::new(),
            doomed: Vec::new(),
            tiles: ranges.are_unlimited().then(Tiles::default),
            views: Views::default(),
            deforms: blade.deforms(),
            warps: blade.is_warped(),
            convex: blade.is_convex(),
        }
    }

    /// Adds a source that is used up already, so that those after it keep their numbers.
    pub(super) fn add_spent(&mut self) {
        self.field.add_spent();
        if self.keeps_views() {
            self.views.add(DVec2::NAN, NONE);
        }
    }

    /// Takes note of what sources were born.
    fn note_births(&mut self, born: Range<u32>, metric: Metric) {
        let (kill2, keeps_views) = (self.ranges.kill2(metric), self.keeps_views());
        let field = &self.field;
        let claim = |id: u32| field.slot(id).map(|slot| (field.place(slot), field.state(slot)));
        let has_come = |id: &u32| claim(*id).is_some_and(|(_, claim)| claim.near2 <= kill2);
        self.doomed.extend(field.acting_since(born.start).filter(has_come));
        if keeps_views {
            for (place, claim) in born.filter_map(claim) {
                self.views.add(place, callee(claim.node, claim.near2));
            }
        }
    }

    /// Whether sources keep a bound on the distance of all nodes but the nearest.
    fn bounds_others(&self) -> bool {
        self.deforms && !self.warps
    }

    /// What sources that are born are to know of the nodes.
    fn knowledge(&self, metric: Metric) -> Knowledge {
        Knowledge {
            limit2: self.ranges.search2(metric),
            bounds_others: self.bounds_others(),
            warps: self.warps,
        }
    }

    /// Whether whom a source calls stays so until a new node comes.
    fn keeps_views(&self) -> bool {
        self.tiles.is_some() && !self.deforms && !self.warps
    }

    /// Lets every source call whom it is known to call.
    fn call_as_known(&mut self, blade: &GrowingBlade, step: u64, metric: Metric, nodes: &Nodes) {
        let mut acting = self.field.take_acting();
        let mut round = std::mem::take(&mut self.round);
        let shares = round.shares(acting.len());
        for (acting, calls) in acting.iter_mut().zip(shares) {
            calls.begin(nodes.len());
            acting.retain(|source| {
                let id = source as usize;
                let node = self.views.nodes[id];
                if node == NONE || node == GONE {
                    return node == NONE;
                }
                if !self.convex && self.views.seen[id] != node {
                    let Some(slot) = self.field.slot(source) else { return false };
                    if !self.sees(slot, blade, step, nodes) {
                        return true;
                    }
                    self.views.seen[id] = node;
                }
                let place = self.views.places[id];
                calls.add(source, node, unit(nodes.position(node), place, metric));
                true
            });
            calls.end();
        }
        round.end(|node, source| unit(nodes.position(node), self.field.place_of(source), metric));
        self.round = round;
        self.field.set_acting(acting);
    }

    /// Lets every source call the node it is nearest to.
    fn call_all(&mut self, blade: &GrowingBlade, step: u64, metric: Metric, nodes: &Nodes) {
        let mut acting = self.field.take_acting();
        let mut round = std::mem::take(&mut self.round);
        let mut answers = std::mem::take(&mut self.answers);
        callers::call_by_share(
            (&self.field, &mut acting),
            (&mut round, &mut answers),
            A_THREAD,
            (nodes, metric),
            |source, calls, answers| self.ask(source, (blade, step, metric, nodes), calls, answers),
        );
        for found in &mut answers {
            for (slot, sight) in found.sights.drain(..) {
                self.field.state_mut(slot).sight = sight;
            }
            for slot in found.retired.drain(..) {
                self.field.retire(slot);
                if self.deforms {
                    // Measured again when a new node comes.
                    self.store(slot, Claim::none(self.ranges.search2(metric)));
                }
            }
        }
        (self.answers, self.round) = (answers, round);
        self.field.set_acting(acting);
    }

    /// Lets a source call, if it is alive; whether it goes on acting.
    fn ask(
        &self,
        source: u32,
        (blade, step, metric, nodes): (&GrowingBlade, u64, Metric, &Nodes),
        calls: &mut Calls,
        answers: &mut Answers,
    ) -> bool {
        let Some(slot) = self.field.slot(source) else { return false };
        let claim = self.field.state(slot);
        let (place, node) = (self.field.place(slot), claim.node);
        if claim.near2 > self.ranges.search2(metric) {
            if !self.warps {
                answers.retired.push(slot);
            }
            return self.warps;
        }
        // One that only the kill distance reaches calls nobody, nor does one that is touched.
        if claim.near2 > self.ranges.reach2(metric) || claim.near2 <= 0.0 {
            return true;
        }
        let sight =
            if self.convex { Sight::Clear } else { sight(claim, place, blade, step, nodes) };
        if sight != claim.sight && !self.convex {
            answers.sights.push((slot, sight));
        }
        if sight == Sight::Clear {
            calls.add(source, node, unit(nodes.position(node), place, metric));
        }
        true
    }

    /// Follows the nearest node of a source while the blade deforms.
    fn measure_again(&mut self, slot: usize, nodes: &Nodes, metric: Metric, search2: f64) {
        let p = self.field.place(slot);
        let mut claim = *self.field.state(slot);
        let limit2 = if self.warps {
            search2
        } else {
            claim.near2 = metric.distance_squared(p, nodes.position(claim.node));
            search2.max(claim.near2)
        };
        if self.warps || claim.near2 >= claim.others2 {
            match nodes.nearest(p, metric, limit2) {
                Some(found) => claim.set(found.distance2, found.id, found.others2),
                None => claim.set(f64::INFINITY, NONE, search2),
            }
        }
        self.store(slot, claim);
    }

    fn store(&mut self, slot: usize, claim: Claim) {
        *self.field.state_mut(slot) = claim;
        self.field.set_bound2(slot, claim.bound2(self.bounds_others()));
    }

    /// Whether a source sees its nearest node.
    fn sees(&mut self, slot: usize, blade: &GrowingBlade, step: u64, nodes: &Nodes) -> bool {
        let p = self.field.place(slot);
        let claim = self.field.state_mut(slot);
        claim.sight = sight(claim, p, blade, step, nodes);
        claim.sight == Sight::Clear
    }
}

/// What sources know of the nodes when they are born.
#[derive(Debug, Clone, Copy)]
struct Knowledge {
    /// Of those as far as this (squared).
    limit2: f64,
    bounds_others: bool,
    warps: bool,
}

/// A source at `p` when it is born.
fn birth(p: DVec2, nodes: &Nodes, metric: Metric, knows: Knowledge) -> Birth<Claim> {
    let Knowledge { limit2, bounds_others, warps } = knows;
    let found = nodes.nearest(p, metric, limit2);
    let mut claim = Claim::none(limit2);
    if let Some(nearest) = found {
        claim.set(nearest.distance2, nearest.id, nearest.others2);
    }
    let is_acting = found.is_some() || warps;
    Birth { bound2: claim.bound2(bounds_others), is_acting, state: claim }
}

/// Whether the source at `p` sees its nearest node.
fn sight(claim: &Claim, p: DVec2, blade: &GrowingBlade, step: u64, nodes: &Nodes) -> Sight {
    let q = nodes.position(claim.node);
    match claim.sight {
        Sight::Unknown if blade.blocks_sight_for_ever(p, q) => Sight::Hidden,
        // The blade only gains tissue: what is clear stays clear.
        Sight::Unknown if !blade.blocks_sight_yet(p, q, step) => Sight::Clear,
        sight => sight,
    }
}

impl Callers for Sources {
    fn len(&self) -> usize {
        self.field.len()
    }

    fn living(&self) -> usize {
        self.field.living()
    }

    fn add_all(&mut self, places: &[DVec2], nodes: &Nodes, metric: Metric) {
        let reach = metric.reach(self.ranges.search(metric));
        let knows = self.knowledge(metric);
        let born = self.field.add_all(places, reach, A_THREAD, |p| birth(p, nodes, metric, knows));
        self.note_births(born, metric);
    }

    fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        let id = self.field.add(p, birth(p, nodes, metric, self.knowledge(metric)));
        self.note_births(id..id + 1, metric);
    }

    fn keep_order(&mut self, metric: Metric) {
        self.field.keep_order(metric.reach(self.ranges.search(metric)));
    }

    fn call(&mut self, blade: &GrowingBlade, step: u64, metric: Metric, nodes: &Nodes) {
        if self.keeps_views() {
            return self.call_as_known(blade, step, metric, nodes);
        }
        if self.deforms {
            let field = &self.field;
            let slots: Vec<usize> = field.acting().filter_map(|id| field.slot(id)).collect();
            for slot in slots {
                self.measure_again(slot, nodes, metric, self.ranges.search2(metric));
            }
        }
        self.call_all(blade, step, metric, nodes);
    }

    fn calls(&self) -> &Round {
        &self.round
    }

    fn place(&self, source: u32) -> DVec2 {
        self.field.place_of(source)
    }

    /// Lets the nodes from `before` on take over the sources they are nearest to, and removes every
    /// source within the kill distance of a node.
    ///
    /// Only a new node can kill, or an old one a newborn source: distances never shrink, unless rates
    /// of growth differ from place to place.
    fn take_over(
        &mut self,
        before: usize,
        _: &GrowingBlade,
        _: u64,
        metric: Metric,
        nodes: &mut Nodes,
    ) -> Vec<u32> {
        let fresh = &nodes.positions()[before..];
        let (kill2, bounds_others) = (self.ranges.kill2(metric), self.bounds_others());
        let keeps_views = self.keeps_views();
        if let Some(tiles) = &mut self.tiles {
            let (field, views) = (&mut self.field, &mut self.views);
            tiles.offer(field, fresh, metric, bounds_others, |id, claim, found| {
                let node = (before + found.tip) as NodeId;
                let bound2 = claim.hear(node, found.distance2, kill2, bounds_others);
                if keeps_views {
                    let is_dead = bound2 == DEAD;
                    views.nodes[id as usize] =
                        if is_dead { GONE } else { callee(node, found.distance2) };
                    return bound2;
                }
                claim.others2 = claim.others2.min(found.others2);
                if bound2 == DEAD { DEAD } else { claim.bound2(bounds_others) }
            });
        } else {
            let search = self.ranges.search(metric);
            self.field.offer(before as NodeId, fresh, search, metric, A_THREAD, |hit, _, claim| {
                Told {
                    bound2: claim.hear(hit.node, hit.distance2, kill2, bounds_others),
                    is_marked: false,
                }
            });
        }
        let mut reached = std::mem::take(&mut self.doomed);
        if self.warps {
            let has_come = |id: &u32| {
                self.field.slot(*id).is_some_and(|slot| self.field.state(slot).near2 <= kill2)
            };
            reached.extend(self.field.acting().filter(has_come));
        }
        for source in reached {
            if let Some(slot) = self.field.slot(source) {
                self.field.kill(slot);
                if keeps_views {
                    self.views.nodes[source as usize] = GONE;
                }
            }
        }
        self.field.take_dead()
    }

    fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        callers::unreached(&self.field, blade, nodes, |slot| {
            let node = self.field.state(slot).node;
            (node != NONE).then_some(node)
        })
    }
}
