//! Sources that a vein has come to: whom they still wait for, and what meets at their place.

use std::ops::Range;

use smallvec::SmallVec;

use super::super::NONE;
use super::super::neighbours::{Around, SECTORS};
use super::super::nodes::Nodes;
use super::calling::A_THREAD;
use super::{At, PATIENCE, Sources, State, Tag};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;

/// Whether the source in a slot sees its neighbour in a sixth, for good.
type News = (usize, usize, bool);

/// What is found out about the sources of a share that a node has come to. Kept for its memory.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Settled {
    waiting: Vec<u32>,
    /// By slot, tags that are new or about other nodes now.
    tags: Vec<(usize, Tag)>,
    sights: Vec<News>,
    done: Vec<Done>,
}

impl Settled {
    fn clear(&mut self) {
        let Self { waiting, tags, sights, done } = self;
        waiting.clear();
        tags.clear();
        sights.clear();
        done.clear();
    }
}

/// A source that waits no longer, and what has come to it.
#[derive(Debug)]
struct Done {
    source: u32,
    slot: usize,
    come: SmallVec<[NodeId; SECTORS]>,
}

impl Sources {
    /// Which of the relative neighbours of a tagged source it waits for: those it was tagged with and
    /// what grew out of them.
    pub(super) fn followed(&self, around: &Around, tag: u32, nodes: &Nodes) -> [NodeId; SECTORS] {
        let tagged = &self.tags[tag as usize].veins;
        let mut veins = [NONE; SECTORS];
        for (k, node, _) in around.neighbours() {
            let is_of = |vein: NodeId| tagged.contains(&vein);
            if is_of(node) || nodes.graph().parent(node).is_some_and(is_of) {
                veins[k] = node;
            }
        }
        veins
    }

    /// The tag of a source that a node has come to.
    fn tag(&self, i: usize, metric: Metric, at: At<'_>, sights: &mut Vec<News>) -> Tag {
        let limit2 = self.ranges.search2(metric);
        let mut veins = [NONE; SECTORS];
        let mut farthest2 = 0.0f64;
        let around = &self.field.state(i).around;
        for (k, node, distance2) in around.neighbours() {
            if distance2 > limit2 {
                continue;
            }
            let sight = self.sight(around, self.field.place(i), (k, node), at);
            if sight.is_lasting {
                sights.push((i, k, sight.is_clear));
            }
            if sight.is_clear {
                veins[k] = node;
                farthest2 = farthest2.max(distance2);
            }
        }
        let steps = PATIENCE * farthest2.sqrt() / at.nodes.stride(metric);
        Tag { veins, last_step: at.step + steps.ceil() as u64 }
    }

    /// Removes the tagged sources whose veins have all come, or that have waited long enough.
    pub(super) fn settle_reached(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &mut Nodes,
        patience: bool,
    ) -> Vec<u32> {
        let mut reached = std::mem::take(&mut self.reached);
        // Those that wait stand in order already, which this sort makes use of.
        reached.sort();
        reached.dedup();
        let shares = self.field.shares(reached.len(), A_THREAD);
        let mut settled = std::mem::take(&mut self.settled);
        settled.resize_with(shares.len(), Settled::default);
        settled.iter_mut().for_each(Settled::clear);
        let mut pieces: Vec<_> = shares.into_iter().zip(&mut settled).collect();
        let at = At { blade, step, nodes };
        self.field.each_share(&mut pieces, true, |(share, settled)| {
            self.look_after(&reached, share, at, metric, patience, settled);
        });
        reached.clear();
        let mut done = Vec::new();
        for settled in &mut settled {
            reached.extend(&settled.waiting);
            self.note_tags(settled);
            done.append(&mut settled.done);
        }
        self.settled = settled;
        self.reached = reached;
        done.sort_unstable_by_key(|done| done.source);
        for Done { slot, .. } in &done {
            let tag = std::mem::replace(&mut self.field.state_mut(*slot).tag, NONE);
            self.free_tags.extend((tag != NONE).then_some(tag));
            self.field.kill(*slot);
        }
        for Done { slot, come, .. } in &done {
            if come.len() > 1 {
                nodes.meet(self.field.place(*slot), come, blade, step, metric);
            }
        }
        self.field.take_dead()
    }

    /// Finds out which sources of a share still wait and which are done.
    fn look_after(
        &self,
        sources: &[u32],
        share: &Range<usize>,
        at: At<'_>,
        metric: Metric,
        patience: bool,
        settled: &mut Settled,
    ) {
        let kill2 = self.ranges.kill2(metric);
        for &source in sources {
            let Some(slot) = self.field.slot(source).filter(|slot| share.contains(slot)) else {
                continue;
            };
            let State { around, tag: place } = self.field.state(slot);
            let sights = settled.sights.len();
            let tag = match self.tags.get(*place as usize) {
                Some(tag) => Tag { veins: self.followed(around, *place, at.nodes), ..*tag },
                None if around.least2() > kill2 => continue,
                None => self.tag(slot, metric, at, &mut settled.sights),
            };
            let is_on_its_way = |(k, node, distance2): (usize, NodeId, f64)| {
                tag.veins[k] == node && distance2 > kill2
            };
            if patience && at.step < tag.last_step && around.neighbours().any(is_on_its_way) {
                settled.waiting.push(source);
                let is_known = self.tags.get(*place as usize).is_some_and(|known| *known == tag);
                settled.tags.extend((!is_known).then_some((slot, tag)));
                continue;
            }
            settled.sights.truncate(sights);
            let has_come = |&(k, node, distance2): &(usize, NodeId, f64)| {
                tag.veins[k] == node && distance2 <= kill2
            };
            let come = around.neighbours().filter(has_come).map(|(_, node, _)| node);
            let mut come: SmallVec<_> = come.collect();
            // The first that grew first.
            come.sort_unstable();
            settled.done.push(Done { source, slot, come });
        }
    }

    fn note_tags(&mut self, settled: &Settled) {
        for &(i, k, clear) in &settled.sights {
            self.field.state_mut(i).around.set_sight(k, clear);
        }
        for &(i, tag) in &settled.tags {
            let place = &mut self.field.state_mut(i).tag;
            if *place == NONE {
                *place = self.free_tags.pop().unwrap_or_else(|| {
                    self.tags.push(tag);
                    self.tags.len() as u32 - 1
                });
            }
            self.tags[*place as usize] = tag;
        }
    }

    /// Ends the waiting of all tagged sources; the ids of the dead.
    pub(in crate::veins::auxin) fn settle(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &mut Nodes,
    ) -> Vec<u32> {
        if self.deforms {
            // The blade may have grown since its neighbours were looked up.
            self.horizon.follow(metric);
            for source in self.reached.clone() {
                let Some(i) = self.field.slot(source) else { continue };
                let around = self.look_around(self.field.place(i), nodes, metric);
                self.store(i, around);
            }
        }
        self.settle_reached(blade, step, metric, nodes, false)
    }
}
