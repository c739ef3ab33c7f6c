//! New nodes ask the sources around them which they matter to, and tell those.
//!
//! On several threads the sources of a large step are shared out by bands of cells: each thread lets the
//! new nodes ask its own. Each source hears of the nodes in the order of their ids, so that the number
//! of threads shows nowhere.
//!
//! To tell sources while the nodes of the step are still being laid gained nothing on two threads: the one that
//! lays must then be given fewer sources, which call on it alone, too, and whatever one thread tells and
//! another lets call travels between their caches.

use std::ops::Range;

use glam::DVec2;

use super::cells::Cells;
use super::{DEAD, Field, Hit, News, Source, Told};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// Sources found before they are told, at most about: memory.
const A_BATCH: usize = 1 << 16;

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

/// Sources in consecutive slots: those sorted into a band of cells, or the newborn.
#[repr(align(128))]
struct Part<'a, S> {
    cells: &'a Cells,
    /// Empty for the newborn.
    columns: Range<usize>,
    first: usize,
    places: &'a [DVec2],
    bound2: &'a mut [f64],
    sources: &'a mut [Source<S>],
    /// The slots of those beyond the search to which nodes may matter.
    far: &'a [u32],
    finds: Finds,
    news: News,
}

/// What new nodes there are, and how far they may matter.
#[derive(Clone, Copy)]
struct Fresh<'a> {
    first: NodeId,
    places: &'a [DVec2],
    search: f64,
    metric: Metric<'a>,
}

impl<'a, S> Part<'a, S> {
    /// Those in the first columns, up to a slot, and the rest.
    fn split(self, columns: Range<usize>, slot: usize) -> (Self, Self) {
        let at = slot - self.first;
        let (places, later_places) = self.places.split_at(at);
        let (bound2, later_bound2) = self.bound2.split_at_mut(at);
        let (sources, later_sources) = self.sources.split_at_mut(at);
        let (far, later_far) =
            self.far.split_at(self.far.partition_point(|&far| (far as usize) < slot));
        let after = Self {
            cells: self.cells,
            columns: 0..0,
            first: slot,
            places: later_places,
            bound2: later_bound2,
            sources: later_sources,
            far: later_far,
            finds: Finds::default(),
            news: News::default(),
        };
        (Self { columns, places, bound2, sources, far, ..self }, after)
    }

    /// Tells the sources of the new nodes that matter to them.
    fn tell_all(&mut self, fresh: Fresh<'_>, hear: &impl Fn(Hit, DVec2, &mut S) -> Told) {
        if self.places.is_empty() {
            return;
        }
        self.finds.len = 0;
        for (k, &p) in fresh.places.iter().enumerate() {
            let node = fresh.first + k as NodeId;
            self.find(node, p, fresh.search, fresh.metric);
            self.find_far(node, p, fresh.search, fresh.metric);
            if self.finds.len > A_BATCH || k + 1 == fresh.places.len() {
                let finds = std::mem::take(&mut self.finds);
                finds.hits().iter().for_each(|&hit| self.tell(hit, hear));
                self.finds = Finds { len: 0, ..finds };
            }
        }
    }

    /// Tells a source of a node found, unless it knows of one as near since.
    fn tell(&mut self, hit: Hit, hear: &impl Fn(Hit, DVec2, &mut S) -> Told) {
        let i = hit.slot as usize - self.first;
        if hit.distance2 >= self.bound2[i] {
            return;
        }
        let place = self.places[i];
        let hear = |state: &mut S| hear(hit, place, state);
        self.sources[i].hear(&mut self.bound2[i], hear, &mut self.news);
    }

    /// Collects the sources to which a node matters.
    fn find(&mut self, node: NodeId, p: DVec2, search: f64, metric: Metric) {
        let cells = self.cells;
        let reach = if search.is_finite() { metric.around(p, search) } else { DVec2::INFINITY };
        let limit2 = search * search;
        let (left, right) = (cells.column(p.x - reach.x), cells.column(p.x + reach.x));
        let (low, high) = (cells.row(p.y - reach.y), cells.row(p.y + reach.y));
        if self.columns.is_empty() {
            for row in low..=high {
                for column in left..=right {
                    let newborn = cells.newborn_in(row, column);
                    newborn.for_each(|slot| self.look(slot, node, p, limit2, metric));
                }
            }
            return;
        }
        let (left, right) = (left.max(self.columns.start), right.min(self.columns.end - 1));
        if left > right {
            return;
        }
        for row in low..=high {
            let run = cells.run(row, left, right);
            if metric.is_warped() {
                run.for_each(|slot| self.look(slot, node, p, limit2, metric));
            } else {
                self.walk(run, node, p, limit2, metric.stretch);
            }
        }
    }

    /// Collects the far sources to which a node matters.
    fn find_far(&mut self, node: NodeId, p: DVec2, search: f64, metric: Metric) {
        for &slot in self.far {
            let i = slot as usize - self.first;
            let distance2 = metric.distance_squared(self.places[i], p);
            if distance2 < self.bound2[i] && distance2 > search * search {
                self.finds.add(Hit { slot, node, distance2 });
            }
        }
    }

    /// Looks at one source.
    fn look(&mut self, slot: usize, node: NodeId, p: DVec2, limit2: f64, metric: Metric) {
        let i = slot - self.first;
        let distance2 = metric.distance_squared(self.places[i], p);
        if distance2 < self.bound2[i] && distance2 <= limit2 {
            self.finds.add(Hit { slot: slot as u32, node, distance2 });
        }
    }

    /// Looks at all sources in a run of slots. Every one is written down, and kept or not: which it
    /// will be cannot be foreseen, and a wrong guess costs as much as five looks.
    fn walk(&mut self, run: Range<usize>, node: NodeId, p: DVec2, limit2: f64, stretch: DVec2) {
        let finds = &mut self.finds;
        let needed = finds.len + run.len();
        if finds.buffer.len() < needed {
            finds.buffer.resize(2 * needed, Hit { slot: 0, node: 0, distance2: 0.0 });
        }
        let mut len = finds.len;
        let slots = run.start as u32..;
        let own = run.start - self.first..run.end - self.first;
        let sources = self.places[own.clone()].iter().zip(&self.bound2[own]);
        for (slot, (q, &bound2)) in slots.zip(sources) {
            let distance2 = ((p - *q) * stretch).length_squared();
            finds.buffer[len] = Hit { slot, node, distance2 };
            len += usize::from((distance2 < bound2) & (distance2 <= limit2));
        }
        finds.len = len;
    }
}

impl<S: Copy + Send + Sync> Field<S> {
    /// Tells every source within `search` of the new nodes that matter to it; `first` is the id of the
    /// first of them. Each thread is given `a_thread` of them at least. The ids of the sources that are
    /// marked.
    pub(in super::super) fn offer(
        &mut self,
        first: NodeId,
        fresh: &[DVec2],
        search: f64,
        metric: Metric,
        a_thread: usize,
        hear: impl Fn(Hit, DVec2, &mut S) -> Told + Sync,
    ) -> Vec<u32> {
        // Without a reach what is found would fill the memory.
        let bands = self.cells.bands();
        let is_shared = search.is_finite() && fresh.len() >= bands * a_thread;
        let (search, far) = self.bounded(search, fresh.len(), metric);
        let mut parts = Vec::with_capacity(bands + 1);
        let mut rest = Part {
            cells: &self.cells,
            columns: 0..0,
            first: 0,
            places: &self.places,
            bound2: &mut self.bound2,
            sources: &mut self.sources,
            far: &far,
            finds: Finds::default(),
            news: News::default(),
        };
        for band in 0..bands {
            let (part, later) = rest.split(self.cells.band(band), self.cells.slots_of(band).end);
            parts.push(part);
            rest = later;
        }
        parts.push(rest);
        for (part, (finds, news)) in parts.iter_mut().zip(self.finds.drain(..)) {
            (part.finds, part.news) = (finds, news);
        }
        for (part, acting) in parts.iter_mut().zip(&mut self.acting) {
            acting.lend(&mut part.news.arrived);
        }
        let fresh = Fresh { first, places: fresh, search, metric };
        let (sorted, newborn) = parts.split_at_mut(bands);
        let tell = |part: &mut Part<'_, S>| part.tell_all(fresh, &hear);
        if bands > 1 && is_shared {
            self.shares.each(sorted, tell);
        } else {
            sorted.iter_mut().for_each(tell);
        }
        newborn.iter_mut().for_each(tell);
        for (band, Part { finds, mut news, .. }) in parts.into_iter().enumerate() {
            match self.acting.get_mut(band) {
                Some(acting) => acting.lend(&mut news.arrived),
                None => self.news.arrived.append(&mut news.arrived),
            }
            self.news.dead.append(&mut news.dead);
            self.news.marked.append(&mut news.marked);
            self.finds.push((finds, news));
        }
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
}
