//! New nodes ask the sources around them which they matter to, and tell those.
//!
//! Asking changes nothing, and telling changes only the source that is told: on several threads the
//! new nodes of a large step are shared out for the one and the sources for the other. Each source
//! hears of the nodes in the order of their ids, so that the number of threads shows nowhere.

use glam::DVec2;
use rayon::prelude::*;

use super::{DEAD, Field, Hit, News, Source, Told};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// New nodes for each thread, at least: waking one costs as much as some tens of them.
const A_THREAD: usize = 48;

/// Sources found before they are told, at most about: memory.
const A_BATCH: usize = 1 << 16;

/// One in so many sources found says where to cut for the threads.
const SAMPLE: usize = 32;

/// From so many new nodes on it is worth while to find out how far they may matter where there is no
/// reach.
const WORTH_BOUNDING: usize = 32;

/// What some new nodes found. Longer than its contents, so that the walk can write without asking.
#[derive(Debug, Default)]
pub(super) struct Finds {
    buffer: Vec<Hit>,
    len: usize,
}

impl Finds {
    fn add(&mut self, hit: Hit) {
        match self.buffer.get_mut(self.len) {
            Some(place) => *place = hit,
            None => self.buffer.push(hit),
        }
        self.len += 1;
    }

    fn hits(&self) -> &[Hit] {
        &self.buffer[..self.len]
    }
}

/// Sources in consecutive slots.
pub(super) struct Part<'a, S> {
    pub(super) first: usize,
    pub(super) places: &'a [DVec2],
    pub(super) bound2: &'a mut [f64],
    pub(super) sources: &'a mut [Source<S>],
}

impl<'a, S> Part<'a, S> {
    /// Tells a source of a node found, unless it knows of one as near since.
    pub(super) fn tell(
        &mut self,
        hit: Hit,
        hear: impl FnOnce(Hit, DVec2, &mut S) -> Told,
        news: &mut News,
    ) {
        let i = hit.slot as usize - self.first;
        if hit.distance2 >= self.bound2[i] {
            return;
        }
        let place = self.places[i];
        let hear = |state: &mut S| hear(hit, place, state);
        self.sources[i].hear(&mut self.bound2[i], hear, news);
    }

    /// Those up to a slot, and the rest.
    fn split(self, slot: usize) -> (Self, Self) {
        let at = slot - self.first;
        let (places, later_places) = self.places.split_at(at);
        let (bound2, later_bound2) = self.bound2.split_at_mut(at);
        let (sources, later_sources) = self.sources.split_at_mut(at);
        let before = Self { first: self.first, places, bound2, sources };
        let after = Self {
            first: slot,
            places: later_places,
            bound2: later_bound2,
            sources: later_sources,
        };
        (before, after)
    }
}

impl<S: Send + Sync> Field<S> {
    /// Tells every source within `search` of the new nodes that matter to it; `first` is the id of the
    /// first of them. The ids of the sources that are marked.
    pub(in super::super) fn offer(
        &mut self,
        first: NodeId,
        fresh: &[DVec2],
        search: f64,
        metric: Metric,
        hear: impl Fn(Hit, DVec2, &mut S) -> Told + Sync,
    ) -> Vec<u32> {
        // Without a reach what is found would fill the memory.
        let threads = if search.is_finite() { rayon::current_num_threads() } else { 1 };
        let (search, far) = self.bounded(search, fresh.len(), metric);
        let threads = threads.min(fresh.len() / A_THREAD).max(1);
        let mut finds = std::mem::take(&mut self.finds);
        finds.resize_with(threads.max(finds.len()), Finds::default);
        if threads > 1 {
            let size = fresh.len().div_ceil(threads);
            let chunks = fresh.par_chunks(size).zip(&mut finds).enumerate();
            chunks.for_each(|(i, (chunk, finds))| {
                finds.len = 0;
                for (k, &p) in chunk.iter().enumerate() {
                    self.find(first + (i * size + k) as NodeId, p, search, metric, finds);
                }
            });
            self.tell_shared(&finds[..fresh.len().div_ceil(size)], hear);
        } else {
            let finds = &mut finds[0];
            finds.len = 0;
            for (k, &p) in fresh.iter().enumerate() {
                self.find(first + k as NodeId, p, search, metric, finds);
                self.find_far(&far, first + k as NodeId, p, search, metric, finds);
                if finds.len > A_BATCH || k + 1 == fresh.len() {
                    let mut all = Part {
                        first: 0,
                        places: &self.places,
                        bound2: &mut self.bound2,
                        sources: &mut self.sources,
                    };
                    finds.hits().iter().for_each(|&hit| all.tell(hit, &hear, &mut self.news));
                    finds.len = 0;
                }
            }
        }
        self.finds = finds;
        self.settle_news();
        std::mem::take(&mut self.news.marked)
    }

    /// Without a reach: a distance within which new nodes matter to nearly all sources, and the slots of
    /// the sources to which farther ones matter, too.
    fn bounded(&self, search: f64, fresh: usize, metric: Metric) -> (f64, Vec<u32>) {
        if search.is_finite() || metric.is_warped() || fresh < WORTH_BOUNDING {
            return (search, Vec::new());
        }
        let mut bounds2: Vec<f64> =
            self.bound2.iter().copied().filter(|&bound2| bound2 != DEAD).collect();
        bounds2.sort_unstable_by(f64::total_cmp);
        let size = self.bounds.size() * metric.stretch;
        let sources = bounds2.len() as f64;
        // What a new node has to look at: the sources in the box around it, and all that are far.
        let cost = |bound2: f64, far: usize| {
            let share = 4.0 * bound2 / (size.x * size.y);
            far as f64 + sources * share.min(1.0)
        };
        let shares = [50, 75, 88, 94, 97, 99, 100];
        let tried = shares.map(|percent| {
            let upto = (bounds2.len() * percent).div_ceil(100);
            let bound2 = if upto == 0 { 0.0 } else { bounds2[upto - 1] };
            (cost(bound2, bounds2.len() - upto), bound2)
        });
        let (_, bound2) = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default();
        let is_far = |&slot: &u32| self.bound2[slot as usize] > bound2;
        // Rounding must leave none out.
        (bound2.sqrt() * (1.0 + 1e-9), (0..self.bound2.len() as u32).filter(is_far).collect())
    }

    /// Collects the sources among `far` to which a node matters that lies beyond the search.
    fn find_far(
        &self,
        far: &[u32],
        node: NodeId,
        p: DVec2,
        search: f64,
        metric: Metric,
        finds: &mut Finds,
    ) {
        for &slot in far {
            let distance2 = metric.distance_squared(self.places[slot as usize], p);
            if distance2 < self.bound2[slot as usize] && distance2 > search * search {
                finds.add(Hit { slot, node, distance2 });
            }
        }
    }

    /// Collects the sources to which a node matters.
    fn find(&self, node: NodeId, p: DVec2, search: f64, metric: Metric, finds: &mut Finds) {
        let reach = if search.is_finite() { metric.around(p, search) } else { DVec2::INFINITY };
        let limit2 = search * search;
        let (left, right) = (self.cells.column(p.x - reach.x), self.cells.column(p.x + reach.x));
        for row in self.cells.row(p.y - reach.y)..=self.cells.row(p.y + reach.y) {
            let run = self.cells.run(row, left, right);
            if metric.is_warped() {
                run.for_each(|slot| self.look(slot, node, p, limit2, metric, finds));
            } else {
                self.walk(run, node, p, limit2, metric.stretch, finds);
            }
            if self.cells.newborn() > 0 {
                for column in left..=right {
                    let newborn = self.cells.newborn_in(row, column);
                    newborn.for_each(|slot| self.look(slot, node, p, limit2, metric, finds));
                }
            }
        }
    }

    /// Looks at one source.
    fn look(
        &self,
        slot: usize,
        node: NodeId,
        p: DVec2,
        limit2: f64,
        metric: Metric,
        finds: &mut Finds,
    ) {
        let distance2 = metric.distance_squared(self.places[slot], p);
        if distance2 < self.bound2[slot] && distance2 <= limit2 {
            finds.add(Hit { slot: slot as u32, node, distance2 });
        }
    }

    /// Looks at all sources in a run of slots. Every one is written down, and kept or not: which it
    /// will be cannot be foreseen, and a wrong guess costs as much as five looks.
    fn walk(
        &self,
        run: std::ops::Range<usize>,
        node: NodeId,
        p: DVec2,
        limit2: f64,
        stretch: DVec2,
        finds: &mut Finds,
    ) {
        let needed = finds.len + run.len();
        if finds.buffer.len() < needed {
            finds.buffer.resize(2 * needed, Hit { slot: 0, node: 0, distance2: 0.0 });
        }
        let mut len = finds.len;
        let slots = run.start as u32..;
        let sources = self.places[run.clone()].iter().zip(&self.bound2[run]);
        for (slot, (q, &bound2)) in slots.zip(sources) {
            let distance2 = ((p - *q) * stretch).length_squared();
            finds.buffer[len] = Hit { slot, node, distance2 };
            len += usize::from((distance2 < bound2) & (distance2 <= limit2));
        }
        finds.len = len;
    }

    /// Tells the sources on as many threads as found them.
    fn tell_shared(&mut self, finds: &[Finds], hear: impl Fn(Hit, DVec2, &mut S) -> Told + Sync) {
        let mut sample: Vec<u32> = finds
            .iter()
            .flat_map(|finds| finds.hits().iter().step_by(SAMPLE).map(|hit| hit.slot))
            .collect();
        sample.sort_unstable();
        let mut rest = Part {
            first: 0,
            places: &self.places,
            bound2: &mut self.bound2,
            sources: &mut self.sources,
        };
        let mut parts = Vec::with_capacity(finds.len());
        for i in 1..finds.len() {
            let Some(&slot) = sample.get(i * sample.len() / finds.len()) else { break };
            let (part, later) = rest.split(slot as usize);
            parts.push((part, News::default()));
            rest = later;
        }
        parts.push((rest, News::default()));
        parts.par_iter_mut().for_each(|(part, news)| {
            let slots = part.first as u32..(part.first + part.places.len()) as u32;
            let hits = finds.iter().flat_map(Finds::hits);
            for &hit in hits.filter(|hit| slots.contains(&hit.slot)) {
                part.tell(hit, &hear, news);
            }
        });
        for (_, mut news) in parts {
            self.news.arrived.append(&mut news.arrived);
            self.news.dead.append(&mut news.dead);
            self.news.marked.append(&mut news.marked);
        }
    }
}
