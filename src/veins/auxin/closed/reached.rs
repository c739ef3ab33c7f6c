//! Sources that a vein has come to: whom they still wait for, and what meets at their place.

use rayon::prelude::*;

use super::super::NONE;
use super::super::neighbours::{Around, SECTORS};
use super::super::nodes::Nodes;
use super::calling::A_THREAD;
use super::{At, PATIENCE, Sources, State, Tag};
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;

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

    /// Tags a source that a node has come to.
    pub(super) fn tag(&mut self, i: usize, metric: Metric, at: At<'_>) {
        let limit2 = self.ranges.search2(metric);
        let mut veins = [NONE; SECTORS];
        let mut farthest2 = 0.0f64;
        let around = self.field.state(i).around;
        for (k, node, distance2) in around.neighbours() {
            if distance2 <= limit2 && self.sees(i, k, node, at) {
                veins[k] = node;
                farthest2 = farthest2.max(distance2);
            }
        }
        let steps = PATIENCE * farthest2.sqrt() / at.nodes.stride(metric);
        let tag = Tag { veins, last_step: at.step + steps.ceil() as u64 };
        let place = match self.free_tags.pop() {
            Some(place) => {
                self.tags[place as usize] = tag;
                place
            }
            None => {
                self.tags.push(tag);
                self.tags.len() as u32 - 1
            }
        };
        self.field.state_mut(i).tag = place;
    }

    /// Removes a source; the veins that have come to it, the first that grew first.
    pub(super) fn remove(&mut self, i: usize, kill2: f64) -> Vec<NodeId> {
        let tag = self.tags[self.field.state(i).tag as usize];
        let come = |&(k, node, distance2): &(usize, NodeId, f64)| {
            tag.veins[k] == node && distance2 <= kill2
        };
        let mut veins: Vec<NodeId> =
            self.field.state(i).around.neighbours().filter(come).map(|(_, node, _)| node).collect();
        veins.sort_unstable();
        self.free_tags.push(self.field.state(i).tag);
        self.field.state_mut(i).tag = NONE;
        self.field.kill(i);
        veins
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
        let kill2 = self.ranges.kill2(metric);
        let mut reached = std::mem::take(&mut self.reached);
        // Those that wait stand in order already, which this sort makes use of.
        reached.sort();
        reached.dedup();
        // Those that have waited before are looked after all at once.
        let after = |source: &u32| {
            let state = self.field.state(self.field.slot(*source)?);
            (state.tag != NONE).then(|| self.followed(&state.around, state.tag, nodes))
        };
        let veins: Vec<Option<[NodeId; SECTORS]>> =
            reached.par_iter().with_min_len(A_THREAD).map(after).collect();
        let mut veins = veins.into_iter();
        let mut meetings = Vec::new();
        reached.retain(|&source| {
            let veins = veins.next().flatten();
            let Some(i) = self.field.slot(source) else { return false };
            let State { around, tag } = *self.field.state(i);
            match veins {
                Some(veins) => self.tags[tag as usize].veins = veins,
                None if around.least2() > kill2 => return false,
                None => self.tag(i, metric, At { blade, step, nodes }),
            }
            // Its neighbours may have been seen meanwhile, and it been tagged.
            let State { around, tag } = *self.field.state(i);
            let tag = self.tags[tag as usize];
            let is_on_its_way = |(k, node, distance2): (usize, NodeId, f64)| {
                tag.veins[k] == node && distance2 > kill2
            };
            let waits = patience && step < tag.last_step && around.neighbours().any(is_on_its_way);
            if waits {
                return true;
            }
            let veins = self.remove(i, kill2);
            if veins.len() > 1 {
                meetings.push((self.field.place(i), veins));
            }
            false
        });
        self.reached = reached;
        for (place, veins) in meetings {
            nodes.meet(place, &veins, blade, step, metric);
        }
        self.field.take_dead()
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
