//! Whom the sources call in a step. Each finds out for itself and changes nothing, so that many are shared
//! out to threads; what they found out is then noted in the order of their ids.

use glam::DVec2;
use rayon::prelude::*;

use super::super::NONE;
use super::super::callers::unit;
use super::super::neighbours::{Around, SECTORS};
use super::{At, Sources, State};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// Sources for each thread, at least: sharing out costs as much as some tens of them.
pub(super) const A_THREAD: usize = 256;

/// What some sources found out. Kept for its memory.
#[derive(Debug, Default)]
pub(super) struct Answers {
    calls: Vec<(u32, NodeId, DVec2)>,
    /// Those that act no more.
    gone: Vec<u32>,
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
        let Self { calls, gone, retired, arounds, sights, veins, reached } = self;
        calls.clear();
        gone.clear();
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
        let threads = rayon::current_num_threads().min(acting.len() / A_THREAD).max(1);
        let mut answers = std::mem::take(&mut self.answers);
        answers.resize_with(threads.max(answers.len()), Answers::default);
        answers.iter_mut().for_each(Answers::clear);
        if threads > 1 {
            let chunks = acting.par_chunks(acting.len().div_ceil(threads)).zip(&mut answers);
            chunks.for_each(|(sources, answers)| self.ask(sources, at, metric, answers));
        } else {
            self.ask(&acting, at, metric, &mut answers[0]);
        }
        for found in &answers {
            self.note(found);
        }
        let mut gone = answers.iter().flat_map(|found| &found.gone).peekable();
        acting.retain(|source| gone.next_if_eq(&source).is_none());
        self.answers = answers;
        self.field.set_acting(acting);
    }

    fn ask(&self, sources: &[u32], at: At<'_>, metric: Metric, answers: &mut Answers) {
        let nodes = at.nodes;
        let (kill2, search2) = (self.ranges.kill2(metric), self.ranges.search2(metric));
        let reach2 = self.ranges.reach2(metric);
        for &source in sources {
            let Some(i) = self.field.slot(source) else {
                answers.gone.push(source);
                continue;
            };
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
                    answers.gone.push(source);
                }
                continue;
            }
            let veins = (tag != NONE).then(|| self.followed(&around, tag, nodes));
            answers.veins.extend(veins.map(|veins| (tag, veins)));
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
                    answers.calls.push((source, node, unit(nodes.position(node), p, metric)));
                }
            }
        }
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
        for &(source, node, unit) in &found.calls {
            self.calls.add(source, node, unit);
        }
    }
}
