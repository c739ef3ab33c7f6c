//! Whom the sources call in a step. Each finds out for itself and changes nothing, so that many are shared
//! out to threads, each to the one that tells it of new nodes; what they found out is then noted in the order
//! of their ids.

use std::ops::Range;

use glam::DVec2;

use super::super::NONE;
use super::super::calls::unit;
use super::super::neighbours::{Around, SECTORS};
use super::{At, Sources, State};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// Sources for each thread, at least: sharing out costs as much as some tens of them.
pub(super) const A_THREAD: usize = 256;

/// What some sources found out. Kept for its memory.
#[derive(Debug, Default)]
pub(super) struct Answers {
    calls: Vec<Call>,
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

/// A call of a source.
#[derive(Debug, Clone, Copy)]
struct Call {
    source: u32,
    node: NodeId,
    from: DVec2,
    /// From the node to the source.
    unit: DVec2,
}

impl Sources {
    /// Lets the sources in reach of a node call.
    pub(super) fn call_all(&mut self, at: At<'_>, metric: Metric) {
        let mut acting = self.field.take_acting();
        let mut answers = std::mem::take(&mut self.answers);
        let shares = self.field.shares(acting.len(), A_THREAD);
        answers.resize_with(shares.len(), Answers::default);
        answers.iter_mut().for_each(Answers::clear);
        let mut pieces: Vec<_> = shares.into_iter().zip(&mut answers).collect();
        self.field.each_share(&mut pieces, |(share, found)| {
            self.ask(&acting, share, at, metric, found);
        });
        let mut gone = Vec::new();
        for found in &mut answers {
            self.note(found);
            gone.append(&mut found.gone);
        }
        self.note_calls(&answers);
        gone.sort_unstable();
        // A first share without slots and the next both begin at the first.
        gone.dedup();
        let mut gone = gone.into_iter().peekable();
        acting.retain(|source| gone.next_if_eq(source).is_none());
        self.answers = answers;
        self.field.set_acting(acting);
    }

    /// Asks those of the sources that stand in a share of the slots; the first tells of the dead, too.
    fn ask(
        &self,
        sources: &[u32],
        share: &Range<usize>,
        at: At<'_>,
        metric: Metric,
        answers: &mut Answers,
    ) {
        let nodes = at.nodes;
        let (kill2, search2) = (self.ranges.kill2(metric), self.ranges.search2(metric));
        let reach2 = self.ranges.reach2(metric);
        for &source in sources {
            let Some(i) = self.field.slot(source) else {
                if share.start == 0 {
                    answers.gone.push(source);
                }
                continue;
            };
            if !share.contains(&i) {
                continue;
            }
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
                    answers.calls.push(Call { source, node, from: p, unit });
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
    }

    /// Lets the sources of all shares call in the order of their ids. Neighbours mostly follow each other and
    /// are of one share: each has long runs.
    fn note_calls(&mut self, answers: &[Answers]) {
        let mut left: Vec<&[Call]> = answers.iter().map(|found| &found.calls[..]).collect();
        loop {
            left.retain(|calls| !calls.is_empty());
            left.sort_unstable_by_key(|calls| calls[0].source);
            let Some((first, others)) = left.split_first_mut() else { return };
            let until = others.first().map_or(u32::MAX, |calls| calls[0].source);
            while let Some((&Call { source, node, from, unit }, rest)) = first.split_first()
                && source < until
            {
                self.calls.add(from, node, unit);
                *first = rest;
            }
        }
    }
}
