//! How sources come into the field, and the order they stand in.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::cells::Cells;
use super::{CELLS_A_SOURCE, DEAD, Field, IN_A_CELL, NEWBORN, NONE, Source, THINNED};
use crate::parallel;

/// What a source knows of the nodes when it is born.
#[derive(Debug, Clone, Copy)]
pub(in super::super) struct Birth<S> {
    /// From this far (squared) on nodes do not matter to it.
    pub(in super::super) bound2: f64,
    pub(in super::super) is_acting: bool,
    pub(in super::super) state: S,
}

impl<S: Copy + Send + Sync> Field<S> {
    /// Adds a source; its id.
    pub(in super::super) fn add(&mut self, p: DVec2, birth: Birth<S>) -> u32 {
        let id = self.slots.len() as u32;
        self.slots.push(self.places.len() as u32);
        self.cells.add(p);
        self.places.push(p);
        self.bound2.push(birth.bound2);
        let Birth { is_acting, state, .. } = birth;
        self.sources.push(Source { id, is_alive: true, is_acting, state });
        self.living += 1;
        if birth.is_acting {
            self.acting[self.cells.band_of(p)].arrive(id);
        }
        id
    }

    /// Adds sources for searches that reach as far as `reach`, each of which `bear` knows by its place; at
    /// least `a_thread` to a thread. Their ids.
    pub(in super::super) fn add_all(
        &mut self,
        born: &[DVec2],
        reach: DVec2,
        a_thread: usize,
        bear: impl Fn(DVec2) -> Birth<S> + Sync,
    ) -> Range<u32> {
        let first = self.slots.len() as u32;
        let ids = first..first + born.len() as u32;
        if !self.is_stale(born.len()) {
            let births: Vec<Birth<S>> =
                born.par_iter().with_min_len(a_thread).map(|&p| bear(p)).collect();
            for (&p, birth) in born.iter().zip(births) {
                self.add(p, birth);
            }
            return ids;
        }
        // Straight into their cells: to bear them first and then put them in order would move all once more.
        let old = self.places.len();
        self.slots.extend(old as u32..(old + born.len()) as u32);
        self.living += born.len();
        self.sort(self.width(reach), reach, born, |field, slot| {
            let Some(nth) = slot.checked_sub(old) else { return field.in_slot(slot) };
            let Birth { bound2, is_acting, state } = bear(born[nth]);
            (bound2, Source { id: first + nth as u32, is_alive: true, is_acting, state })
        });
        ids
    }

    /// Puts the sources in order of place once enough were born or died since, for searches that
    /// reach as far as `reach`.
    pub(in super::super) fn keep_order(&mut self, reach: DVec2) {
        let width = self.width(reach);
        if self.is_stale(0) || width * 2.0 < self.cells.width {
            self.sort(width, reach, &[], Self::in_slot);
        }
    }

    /// A source and from how far (squared) on nodes do not matter to it.
    fn in_slot(&self, slot: usize) -> (f64, Source<S>) {
        (self.bound2[slot], self.sources[slot])
    }

    /// How wide cells should be.
    fn width(&self, reach: DVec2) -> f64 {
        let size = self.bounds.size();
        let area = size.x * size.y;
        let count = self.living as f64;
        (reach.min_element() / 2.0)
            .min((area * IN_A_CELL / count.max(1.0)).sqrt())
            .max((area / (CELLS_A_SOURCE * count + 64.0)).sqrt())
    }

    /// Whether the order is to be made anew once more are born.
    fn is_stale(&self, more: usize) -> bool {
        let newborn = self.cells.newborn();
        let sorted = self.places.len() - newborn;
        let alive = self.living.saturating_sub(newborn) as f64;
        newborn + more > NEWBORN.max(sorted / 2) || alive < THINNED * sorted as f64
    }

    /// Drops the dead and puts the living and the born, as in the slots after theirs, in order of cell and, in a
    /// cell, of slot; `source` tells what is to stand there of a slot.
    fn sort(
        &mut self,
        width: f64,
        reach: DVec2,
        born: &[DVec2],
        source: impl Fn(&Self, usize) -> (f64, Source<S>) + Sync,
    ) {
        // Without a reach a node has callers everywhere: sources that call by band would call in vain.
        let bands = if reach.is_finite() { parallel::hands() } else { 1 };
        let old = self.places.len();
        let first_born = self.slots.len() - born.len();
        let place = |slot: u32| {
            let slot = slot as usize;
            if slot < old { self.places[slot] } else { born[slot - old] }
        };
        let alive =
            |slot: &u32| self.bound2.get(*slot as usize).is_none_or(|&bound2| bound2 != DEAD);
        let living: Vec<u32> = (0..(old + born.len()) as u32).filter(alive).collect();
        for source in self.sources.iter().filter(|source| !source.is_alive) {
            self.slots[source.id as usize] = NONE;
        }
        let mut cells = Cells::new(self.bounds, width);
        let order = cells.sort(bands, &living, place);
        let places: Vec<DVec2> = order.par_iter().map(|&slot| place(slot)).collect();
        let (mut bound2, mut sources) = (Vec::new(), Vec::new());
        let source = |&slot: &u32| source(self, slot as usize);
        order.par_iter().map(source).unzip_into_vecs(&mut bound2, &mut sources);
        (self.places, self.bound2, self.sources) = (places, bound2, sources);
        let mut arrived = Vec::new();
        for (slot, source) in self.sources.iter().enumerate() {
            self.slots[source.id as usize] = slot as u32;
            let is_born = source.id as usize >= first_born;
            arrived.extend((is_born && source.is_acting).then_some(source.id));
        }
        self.shares.share_out(cells.bands());
        self.cells = cells;
        self.share_out_acting();
        // After those that were in reach already, as `acting_since` has it.
        arrived.into_iter().for_each(|id| self.arrive(id));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::geometry::Rect;
    use crate::seed::{Seed, Stage};

    fn assert_same(a: &Field<f64>, b: &Field<f64>) {
        let known = |field: &Field<f64>| -> Vec<(u32, f64)> {
            field.sources.iter().map(|source| (source.id, source.state)).collect()
        };
        let acting = |field: &Field<f64>| -> BTreeSet<u32> { field.acting().collect() };
        assert_eq!(a.places, b.places);
        assert_eq!(a.bound2, b.bound2);
        assert_eq!(known(a), known(b));
        assert_eq!(acting(a), acting(b));
    }

    #[test]
    fn many_at_once_stand_as_if_born_one_by_one() {
        let mut rng = Seed(3).stream(Stage::Tissue);
        let reach = DVec2::splat(0.1);
        let bounds = Rect { min: DVec2::ZERO, max: DVec2::ONE };
        let bear = |p: DVec2| Birth { bound2: p.x + 1.0, is_acting: p.x < 0.3, state: p.x - p.y };
        for threads in [1, 3] {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let mut fields = [Field::new(bounds), Field::new(bounds)];
            for wave in [70, 3, 900, 500] {
                let born: Vec<DVec2> =
                    (0..wave).map(|_| DVec2::new(rng.unit(), rng.unit())).collect();
                let [at_once, one_by_one] = &mut fields;
                let ids = pool.install(|| {
                    let ids = at_once.add_all(&born, reach, 16, bear);
                    born.iter().for_each(|&p| _ = one_by_one.add(p, bear(p)));
                    at_once.keep_order(reach);
                    one_by_one.keep_order(reach);
                    ids
                });
                assert_eq!(ids.len(), wave);
                let mut since: Vec<u32> = at_once.acting_since(ids.start).collect();
                since.sort_unstable();
                let in_reach = |&id: &u32| born[(id - ids.start) as usize].x < 0.3;
                assert_eq!(since, ids.clone().filter(in_reach).collect::<Vec<_>>());
                assert_same(at_once, one_by_one);
                for field in [at_once, one_by_one] {
                    for id in (0..field.len() as u32).step_by(3) {
                        let slot = field.slot(id);
                        slot.into_iter().for_each(|slot| field.kill(slot));
                    }
                }
            }
        }
    }
}
