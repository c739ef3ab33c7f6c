//! The living sources, in order of place.
//!
//! A new node asks which sources it matters to: those in the cells around it that know of nothing as
//! near. A cell's sources lie together in memory, so that asking is a walk over a few short runs. Not
//! kiddo's static tree, though sources stand still: a search in it finds the dead and the well-served
//! too, one by one, and took 0.14 of the 0.31 seconds in which 100 000 sources were served; here it
//! takes about 0.03.

mod acting;
mod births;
mod cells;
mod offer;
mod shares;

use std::ops::Range;

use glam::DVec2;

pub(super) use self::acting::Acting;
pub(super) use self::births::Birth;
use self::cells::Cells;
use self::shares::Shares;
use super::NONE;
use super::tiles::Found;
use crate::geometry::Rect;
use crate::veins::graph::NodeId;

/// In place of the distance from which on a node does not matter, for a dead source.
pub(super) const DEAD: f64 = -1.0;

/// Newborn sources stand in lists until there are this many, or half as many as in the runs.
const NEWBORN: usize = 64;

/// Runs are made anew when less than this share of them is alive: every search passes the dead.
const THINNED: f64 = 0.5;

/// Sources in a cell, at most about: more make searches pass over what is far.
const IN_A_CELL: f64 = 32.0;

/// Cells for each source, at most about: more would be empty.
const CELLS_A_SOURCE: f64 = 4.0;

/// A source and what it knows of the nodes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<S> {
    pub(super) id: u32,
    /// Its bound says so, too; but that lies in memory that whoever asks does not need: closed venation
    /// took a twentieth longer.
    pub(super) is_alive: bool,
    /// Whether it is in the list of those in reach, or about to be.
    pub(super) is_acting: bool,
    pub(super) state: S,
}

impl<S> Source<S> {
    /// Lets the source hear of a node that matters to it, and notes what comes of it.
    #[inline]
    fn hear(&mut self, bound2: &mut f64, hear: impl FnOnce(&mut S) -> Told, news: &mut News) {
        let told = hear(&mut self.state);
        *bound2 = told.bound2;
        if told.bound2 == DEAD {
            self.is_alive = false;
            news.dead.push(self.id);
            return;
        }
        if told.is_marked {
            news.marked.push(self.id);
        }
        if !self.is_acting {
            self.is_acting = true;
            news.arrived.push(self.id);
        }
    }
}

/// A source that a new node may matter to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Hit {
    pub(super) slot: u32,
    pub(super) node: NodeId,
    /// Squared distance of the node.
    pub(super) distance2: f64,
}

/// What a source makes of a new node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Told {
    /// From how far (squared) on nodes do not matter now; [`DEAD`] if it died of it.
    pub(super) bound2: f64,
    /// Whether whoever asks is to hear of it.
    pub(super) is_marked: bool,
}

/// Ids of sources to which something happened.
#[derive(Debug, Default)]
struct News {
    arrived: Vec<u32>,
    dead: Vec<u32>,
    marked: Vec<u32>,
}

/// Sources by place. Each is known by its id, the order of births, and stands in a slot, which
/// changes.
#[derive(Debug)]
pub(super) struct Field<S> {
    bounds: Rect,
    /// The slot of each source, by id; [`NONE`] for those that were dead when they were last put in order:
    /// whoever writes here takes what is read in every step out of the caches of the other threads.
    slots: Vec<u32>,
    places: Vec<DVec2>,
    /// By slot: from this far (squared) on a node does not matter; [`DEAD`] at the end.
    bound2: Vec<f64>,
    sources: Vec<Source<S>>,
    cells: Cells,
    living: usize,
    /// Sources in reach of a node, by band of cells.
    acting: Vec<Acting>,
    /// Sources that died since they were last taken.
    dead: Vec<u32>,
    news: News,
    /// What new nodes found and what came of it, by band; kept for its memory.
    finds: Vec<(offer::Finds, News)>,
    shares: Shares,
}

impl<S: Copy + Send + Sync> Field<S> {
    pub(super) fn new(bounds: Rect) -> Self {
        Self {
            bounds,
            slots: Vec::new(),
            places: Vec::new(),
            bound2: Vec::new(),
            sources: Vec::new(),
            cells: Cells::new(bounds, f64::INFINITY),
            living: 0,
            acting: vec![Acting::default()],
            dead: Vec::new(),
            news: News::default(),
            finds: Vec::new(),
            shares: Shares::default(),
        }
    }

    /// Sources that ever were.
    pub(super) fn len(&self) -> usize {
        self.slots.len()
    }

    /// Sources that are left.
    pub(super) fn living(&self) -> usize {
        self.living
    }

    /// Adds a source that is used up already, so that those after it keep their ids.
    pub(super) fn add_spent(&mut self) {
        self.slots.push(NONE);
    }

    /// Where a source stands, if it is alive.
    pub(super) fn slot(&self, id: u32) -> Option<usize> {
        let slot = self.slots[id as usize] as usize;
        self.sources.get(slot).is_some_and(|source| source.is_alive).then_some(slot)
    }

    pub(super) fn place(&self, slot: usize) -> DVec2 {
        self.places[slot]
    }

    /// Where a living source is.
    pub(super) fn place_of(&self, id: u32) -> DVec2 {
        self.slot(id).map_or(DVec2::NAN, |slot| self.place(slot))
    }

    pub(super) fn source(&self, slot: usize) -> &Source<S> {
        &self.sources[slot]
    }

    pub(super) fn state(&self, slot: usize) -> &S {
        &self.sources[slot].state
    }

    pub(super) fn state_mut(&mut self, slot: usize) -> &mut S {
        &mut self.sources[slot].state
    }

    pub(super) fn set_bound2(&mut self, slot: usize, bound2: f64) {
        self.bound2[slot] = bound2;
    }

    /// Takes note that no node is in reach of a source any more.
    pub(super) fn retire(&mut self, slot: usize) {
        self.sources[slot].is_acting = false;
    }

    /// The slots of the living.
    pub(super) fn living_slots(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.places.len()).filter(|&slot| self.sources[slot].is_alive)
    }

    pub(super) fn kill(&mut self, slot: usize) {
        if self.bound2[slot] != DEAD {
            self.bound2[slot] = DEAD;
            let source = &mut self.sources[slot];
            source.is_alive = false;
            self.living -= 1;
            self.dead.push(source.id);
        }
    }

    /// The ids of those that died since this was last asked.
    pub(super) fn take_dead(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.dead)
    }

    /// The sources in reach by band, to be given back to [`set_acting`](Self::set_acting).
    pub(super) fn take_acting(&mut self) -> Vec<Acting> {
        std::mem::take(&mut self.acting)
    }

    pub(super) fn set_acting(&mut self, acting: Vec<Acting>) {
        let acts = |id: u32| self.slot(id).is_some_and(|slot| self.sources[slot].is_acting);
        debug_assert!(acting.iter().flat_map(Acting::iter).all(acts), "others have been taken out");
        self.acting = acting;
    }

    /// The ids of those in reach among the sources just born, of which `first` is the first.
    pub(super) fn acting_since(&self, first: u32) -> impl Iterator<Item = u32> + '_ {
        self.acting.iter().flat_map(move |acting| acting.arrived_since(first))
    }

    /// The ids of the sources in reach, some of them dead.
    pub(super) fn acting(&self) -> impl Iterator<Item = u32> + '_ {
        self.acting.iter().flat_map(Acting::iter)
    }

    /// Gives the sources in reach to the bands that they are in now.
    fn share_out_acting(&mut self) {
        let bands = self.cells.bands();
        if bands == 1 && self.acting.len() == 1 {
            return;
        }
        let acting = std::mem::replace(&mut self.acting, vec![Acting::default(); bands]);
        for id in acting.iter().flat_map(Acting::iter) {
            self.arrive(id);
        }
    }

    /// Takes note that a source has come into reach, if it is alive.
    fn arrive(&mut self, id: u32) {
        if let Some(slot) = self.slot(id) {
            self.acting[self.cells.band_of(self.places[slot])].arrive(id);
        }
    }

    /// The slots of each share of the sources, a band to each; of all in one where there is too little work
    /// for giving each thread so much.
    pub(super) fn shares(&self, work: usize, a_thread: usize) -> Vec<Range<usize>> {
        let bands = self.cells.bands();
        let shares = if work < bands * a_thread { 1 } else { bands };
        let share = |at: usize| {
            let slots = self.cells.slots_of(at);
            // The newborn stand after all others.
            slots.start..if at + 1 == shares { self.places.len() } else { slots.end }
        };
        (0..shares).map(share).collect()
    }

    /// Does each piece of work, one to a share: on the thread that knows the share, where there is enough.
    pub(super) fn each_share<T: Send>(
        &self,
        pieces: &mut [T],
        is_enough: bool,
        work: impl Fn(&mut T) + Sync,
    ) {
        if pieces.len() > 1 && is_enough {
            self.shares.each(pieces, work);
        } else {
            pieces.iter_mut().for_each(work);
        }
    }

    /// Columns and rows of the cells, and their width.
    pub(super) fn cells(&self) -> (usize, usize, f64) {
        (self.cells.columns, self.cells.rows, self.cells.width)
    }

    /// The middle of a cell.
    pub(super) fn middle(&self, row: usize, column: usize) -> DVec2 {
        self.cells.min + (DVec2::new(column as f64, row as f64) + 0.5) * self.cells.width
    }

    /// From this far (squared) on a node matters to none of the sources in a cell; [`DEAD`] when there
    /// is none.
    pub(super) fn bound2_of_cell(&self, row: usize, column: usize) -> f64 {
        let newborn = self.cells.newborn_in(row, column).map(|slot| &self.bound2[slot]);
        let sorted = &self.bound2[self.cells.run(row, column, column)];
        sorted
            .iter()
            .chain(newborn)
            .fold(DEAD, |most, &bound2| if bound2 > most { bound2 } else { most })
    }

    /// Tells the sources in a cell of the new node that `find` finds nearest to each; to be followed by
    /// [`settle_news`](Self::settle_news).
    pub(super) fn tell_cell(
        &mut self,
        row: usize,
        column: usize,
        find: impl Fn(DVec2) -> Option<Found>,
        hear: &mut impl FnMut(u32, &mut S, Found) -> f64,
    ) {
        let Self { places, bound2, sources, cells, news, .. } = self;
        let mut tell = |place: DVec2, bound2: &mut f64, source: &mut Source<S>| {
            if *bound2 == DEAD {
                return;
            }
            let Some(found) = find(place) else { return };
            if found.distance2 < *bound2 {
                let id = source.id;
                let hear =
                    |state: &mut S| Told { bound2: hear(id, state, found), is_marked: false };
                source.hear(bound2, hear, news);
            }
        };
        let run = cells.run(row, column, column);
        let there = places[run.clone()].iter().zip(&mut bound2[run.clone()]).zip(&mut sources[run]);
        for ((&place, bound2), source) in there {
            tell(place, bound2, source);
        }
        for slot in cells.newborn_in(row, column) {
            tell(places[slot], &mut bound2[slot], &mut sources[slot]);
        }
    }

    /// Takes note of what came of telling.
    pub(super) fn settle_news(&mut self) {
        let arrived = std::mem::take(&mut self.news.arrived);
        arrived.into_iter().for_each(|id| self.arrive(id));
        self.living -= self.news.dead.len();
        self.dead.append(&mut self.news.dead);
    }
}
