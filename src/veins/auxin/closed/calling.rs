//! Whom the sources call in a step. Each finds out for itself and changes nothing but its share's calls, so
//! that many are shared out to threads, each to the one that tells it of new nodes; what they found out is
//! noted after.

use super::super::NONE;
use super::super::callers;
use super::super::calls::{Calls, unit};
use super::super::neighbours::{Around, SECTORS};
use super::{At, Sources, State};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// Sources for each thread, at least: sharing out costs as much as some tens of them.
pub(super) const A_THREAD: usize = 256;

/// What some sources found out. Kept for its memory.
#[derive(Debug, Default)]
#[repr(align(128))]
pub(super) struct Answers {
    /// The slots of those out of reach of all nodes.
    retired: Vec<usize>,
    /// Neighbours that were looked up anew, by slot.
    arounds: Vec<(usize, Around)>,
    /// By slot and sixth, whether a neighbour is seen for good.
    sights: Vec<(usize, usize, bool)>,
    /// Tags and the veins they are about now.
    veins: Vec<(u32, [NodeId; SECTORS])>,
    /// Those that a node has come to without their being told.
    reached: Vec<u32>,
}

impl Answers {
    fn clear(&mut self) {
        let Self { retired, arounds, sights, veins, reached } = self;
        retired.clear();
        arounds.clear();
        sights.clear();
        veins.clear();
        reached.clear();
    }
}

impl Sources {
    /// Lets the sources in reach of a node call.
    pub(super) fn call_all(&mut self, at: At<'_>, metric: Metric) {
        let mut acting = self.field.take_acting();
        let mut round = std::mem::take(&mut self.round);
        let mut answers = std::mem::take(&mut self.answers);
        answers.iter_mut().for_each(Answers::clear);
        callers::call_by_share(
            (&self.field, &mut acting),
            (&mut round, &mut answers),
            A_THREAD,
            (at.nodes, metric),
            |source, calls, answers| self.ask(source, at, metric, calls, answers),
        );
        answers.iter().for_each(|found| self.note(found));
        (self.answers, self.round) = (answers, round);
        self.field.set_acting(acting);
    }

    /// Lets a source call, if it is alive; whether it goes on acting.
    fn ask(
        &self,
        source: u32,
        at: At<'_>,
        metric: Metric,
        calls: &mut Calls,
        answers: &mut Answers,
    ) -> bool {
        let nodes = at.nodes;
        let (kill2, search2) = (self.ranges.kill2(metric), self.ranges.search2(metric));
        let reach2 = self.ranges.reach2(metric);
        let Some(i) = self.field.slot(source) else { return false };
        let p = self.field.place(i);
        let State { mut around, tag } = *self.field.state(i);
        if self.deforms {
            around = self.look_around(p, nodes, metric);
            answers.arounds.push((i, around));
        }
        if self.warps && around.least2() <= kill2 && tag == NONE {
            answers.reached.push(source);
        }
        if around.least2() > search2 {
            // Unless they shrink, too, distances only grow: those nodes will not matter again.
            if !self.warps {
                answers.retired.push(i);
            }
            return self.warps;
        }
        let veins = (tag != NONE).then(|| self.followed(&around, tag, nodes));
        let news = veins.filter(|veins| *veins != self.tags[tag as usize].veins);
        answers.veins.extend(news.map(|veins| (tag, veins)));
        for (k, node, distance2) in around.neighbours() {
            let is_meant = distance2 > kill2
                && distance2 <= reach2
                && veins.is_none_or(|veins| veins[k] == node);
            if !is_meant {
                continue;
            }
            let sight = self.sight(&around, p, (k, node), at);
            if sight.is_lasting {
                answers.sights.push((i, k, sight.is_clear));
            }
            if sight.is_clear {
                let unit = unit(nodes.position(node), p, metric);
                calls.add(source, node, unit);
            }
        }
        true
    }

    fn note(&mut self, found: &Answers) {
        for &(i, around) in &found.arounds {
            self.store(i, around);
        }
        for &(i, k, clear) in &found.sights {
            self.field.state_mut(i).around.set_sight(k, clear);
        }
        for &(tag, veins) in &found.veins {
            self.tags[tag as usize].veins = veins;
        }
        for &i in &found.retired {
            self.field.retire(i);
            self.store(i, Around::EMPTY);
        }
        self.reached.extend(&found.reached);
    }
}
