//! Where auxin sources come from: darts that fall where there is room, or given places.

use glam::DVec2;
use rayon::prelude::*;

use super::callers::Callers;
use super::habit::{self, Density};
use super::nodes::Nodes;
use crate::geometry::point_grid::PointGrid;
use crate::geometry::scatter::PolygonScatter;
use crate::geometry::z_order::z_order;
use crate::growth::{GrowingBlade, Metric};
use crate::seed::Rng;
use crate::veins::{VeinError, VeinSpec};

/// More darts than this are a slip of the keyboard: Foster's longest run throws 3 million, and each
/// costs about a tenth of a microsecond.
const MAX_DARTS: f64 = 3e7;

/// More sources than this are a slip of the keyboard, mostly a spacing of zero: they take a few
/// hundred megabytes.
const MAX_SOURCES: usize = 4_000_000;

/// The last veinlets have few steps to come in: so many times more darts fall then, or large areoles
/// would stay empty by chance.
const VEINLET_DARTS: f64 = 4.0;

/// The sources still to come.
pub(super) struct Supply<'a> {
    spec: &'a VeinSpec,
    blade: &'a GrowingBlade,
    spacing_mm: f64,
    vein_spacing_mm: f64,
    rate: f64,
    /// Times the room that sources need in the end.
    coarseness: f64,
    density: Option<Density>,
    /// Whether darts fall in every step, not all at once before the first.
    falls: bool,
    is_paced: bool,
    /// Whether nothing falls for the time being.
    rests: bool,
    scatter: PolygonScatter,
    /// Living sources, for their spacing; only where darts fall.
    spaced: PointGrid,
    /// Where they are, and where those were that died.
    places: Vec<DVec2>,
    /// Part of a dart left over from the last step.
    fraction: f64,
    /// Given places, or those of all darts where they fall before the first step, with their step of
    /// birth, latest first.
    waiting: Vec<(u64, DVec2)>,
    given: bool,
    /// Darts that fall on the mature blade at once, where tissue stands still.
    volley: u64,
    is_sorted: bool,
    outside: usize,
}

impl<'a> Supply<'a> {
    /// Where tissue stands still, the darts of the first `volley_steps` steps fall at once.
    pub(super) fn new(
        spec: &'a VeinSpec,
        blade: &'a GrowingBlade,
        volley_steps: u64,
    ) -> Result<Self, VeinError> {
        let steps = blade.steps().count() as f64;
        let given = !spec.sources_mm.is_empty();
        if !given && spec.spawn_rate * steps > MAX_DARTS {
            let problem = format!(
                "over {steps} steps throws more than {MAX_DARTS:.0} darts; lower it or growth.total_steps"
            );
            return Err(VeinError::setting("veins.spawn_rate", spec.spawn_rate, problem));
        }
        let frame = blade.frame(*blade.steps().start());
        let first = frame.metric();
        let cell = first.reach(first.length(spec.source_spawn_distance_mm)).max_element();
        let density = Density::new(spec, blade);
        let more = density.as_ref().map_or(1.0, Density::most);
        let is_paced =
            !given && (spec.phases.coarseness > 1.0 || spec.convergence.spacing_mm > 0.0);
        let mut supply = Self {
            spec,
            blade,
            spacing_mm: spec.source_spawn_distance_mm,
            vein_spacing_mm: spec.vein_spawn_distance_mm,
            rate: spec.spawn_rate * more,
            coarseness: 1.0,
            density,
            falls: !given && (blade.carries_tissue() || is_paced),
            is_paced,
            rests: false,
            scatter: PolygonScatter::new(blade.mature().outline()),
            spaced: PointGrid::new(blade.mature().bounds(), cell),
            places: Vec::new(),
            fraction: 0.0,
            waiting: Vec::new(),
            given,
            volley: (spec.spawn_rate * more * volley_steps as f64) as u64,
            is_sorted: false,
            outside: 0,
        };
        let is_odd = |place: &[f64; 2]| !DVec2::from(*place).is_finite();
        if let Some(i) = spec.sources_mm.iter().position(is_odd) {
            let problem = "is the index of a point that is not made of finite numbers";
            return Err(VeinError::setting("veins.sources_mm", i as f64, problem));
        }
        // To leave out at once those that are outside would move all others once more.
        let outside = (u64::MAX, DVec2::NAN);
        let waits = |place: &[f64; 2]| waiting(blade, DVec2::from(*place)).unwrap_or(outside);
        supply.waiting = spec.sources_mm.par_iter().map(waits).collect();
        supply.waiting.retain(|(_, place)| !place.is_nan());
        supply.outside = spec.sources_mm.len() - supply.waiting.len();
        Ok(supply)
    }

    /// How many sources may come, at most about.
    pub(super) fn most(&self) -> usize {
        if self.given {
            return self.waiting.len();
        }
        let darts = self.rate * self.blade.steps().count() as f64;
        let room = self.blade.mature().area_mm2() / (self.spacing_mm * self.spacing_mm);
        darts.min(room).min(MAX_SOURCES as f64) as usize
    }

    /// Whether sources may come in this step.
    pub(super) fn is_due(&self, step: u64, age: f64) -> bool {
        let next = self.waiting.last();
        let is_waiting = next.is_some_and(|&(birth, _)| birth <= step || !self.is_sorted);
        self.throws(age) || self.volley > 0 || is_waiting
    }

    /// Whether darts fall in a step at an age.
    fn throws(&self, age: f64) -> bool {
        self.falls && !self.rests && !self.waits(age)
    }

    /// Adds the sources of one step to `calls`.
    pub(super) fn seed(
        &mut self,
        step: u64,
        age: f64,
        metric: Metric,
        rng: &mut Rng,
        calls: &mut dyn Callers,
        nodes: &Nodes,
    ) -> Result<(), VeinError> {
        if self.is_paced {
            self.coarseness = habit::coarseness(self.spec, age);
        }
        if !self.given && !self.falls {
            // All darts fall on the mature blade before the step.
            let mut left = std::mem::take(&mut self.volley);
            while left > 0 {
                let pair = self.thrown(metric, rng);
                left = left.saturating_sub(if pair[1].is_some() { 2 } else { 1 });
                for p in pair.into_iter().flatten() {
                    if self.is_free(p, metric, nodes) {
                        self.place(p);
                        match waiting(self.blade, p) {
                            Some(place) => self.waiting.push(place),
                            None => self.outside += 1,
                        }
                    }
                }
                self.check_number()?;
            }
        }
        let born = if self.is_sorted { self.due(step) } else { self.sort(step) };
        if !born.is_empty() {
            calls.add_all(&born, nodes, metric);
        }
        if self.throws(age) {
            let cell = metric.reach(metric.length(self.spacing_mm)).max_element();
            self.spaced.refine(cell, &self.places);
            // As many as would fall on the whole leaf if all of it were as large as its largest part;
            // those that fall beside the others are lost.
            self.fraction += self.rate * self.blade.greatest_area_scale(step);
            while self.fraction >= 1.0 {
                let pair = self.thrown(metric, rng);
                self.fraction -= if pair[1].is_some() { 2.0 } else { 1.0 };
                for p in pair.into_iter().flatten() {
                    let is_there = self.blade.birth_step(p).is_some_and(|birth| birth <= step);
                    if is_there && self.is_free(p, metric, nodes) {
                        self.place(p);
                        calls.add(p, nodes, metric);
                    }
                }
                self.check_number()?;
            }
        }
        calls.keep_order(metric);
        Ok(())
    }

    /// Puts those that wait in order; takes out the places of those that are born in this step.
    ///
    /// Those of one step are born in order of place, so that sources which call in the order of their ids
    /// find what they know together in memory: at a million, more than twice as fast.
    fn sort(&mut self, step: u64) -> Vec<DVec2> {
        self.is_sorted = true;
        let bounds = self.blade.mature().bounds();
        // Among equals the first comes first.
        let key = |(i, &(birth, p)): (usize, &(u64, DVec2))| {
            u128::from(birth.max(step)) << 64 | u128::from(z_order(bounds, p)) << 32 | i as u128
        };
        let mut order: Vec<u128> = self.waiting.par_iter().enumerate().map(key).collect();
        order.par_sort_unstable();
        let due = order.partition_point(|key| (key >> 64) as u64 <= step);
        let place = |&key: &u128| self.waiting[key as u32 as usize];
        let born = order[..due].par_iter().map(|key| place(key).1).collect();
        // Latest first, so that they can be popped.
        self.waiting = order[due..].par_iter().rev().map(place).collect();
        born
    }

    /// Takes out the places of those that are born in this step.
    fn due(&mut self, step: u64) -> Vec<DVec2> {
        let waits = self.waiting.partition_point(|&(birth, _)| birth > step);
        self.waiting.drain(waits..).rev().map(|(_, p)| p).collect()
    }

    /// Keeps others away from a source.
    fn place(&mut self, p: DVec2) {
        self.spaced.push(p);
        self.places.push(p);
    }

    fn check_number(&self) -> Result<(), VeinError> {
        if self.spaced.len() <= MAX_SOURCES {
            return Ok(());
        }
        let problem = format!("leaves room for more than {MAX_SOURCES} sources; raise it");
        Err(VeinError::setting("veins.source_spawn_distance_mm", self.spacing_mm, problem))
    }

    /// Whether nothing falls yet: the first veins come from the margin alone.
    fn waits(&self, age: f64) -> bool {
        self.spec.convergence.spacing_mm > 0.0 && age < self.spec.convergence.until
    }

    /// Whether sources come in phases.
    pub(super) fn is_paced(&self) -> bool {
        self.is_paced
    }

    /// One dart, or a pair.
    fn thrown(&self, metric: Metric, rng: &mut Rng) -> [Option<DVec2>; 2] {
        let (u, v) = (rng.unit(), rng.unit());
        let p = self.scatter.point(u, v);
        if metric.is_warped() {
            let (here, most) = (metric.area_scale(p), metric.greatest_area_scale());
            if rng.unit() * most >= here {
                return [None, None];
            }
        }
        if self.density.as_ref().is_some_and(|density| !density.admits(p, rng)) {
            return [None, None];
        }
        let Some(twin) = habit::mirrored(self.spec, p, rng) else { return [Some(p), None] };
        if metric.distance_squared(p, twin) < self.room(p, metric).powi(2) {
            // A pair that would crowd itself is one on the midrib.
            return [Some(DVec2::new(0.0, p.y)).filter(|p| self.blade.covers(*p)), None];
        }
        [Some(p), Some(twin).filter(|p| self.blade.covers(*p))]
    }

    /// How far from others a source at `p` must be.
    fn room(&self, p: DVec2, metric: Metric) -> f64 {
        metric.length(self.spacing_mm) * self.share(p)
    }

    /// Of the final distances, at `p` in this step.
    fn share(&self, p: DVec2) -> f64 {
        let density = self.density.as_ref().map_or(1.0, |density| density.closeness(p));
        self.coarseness * density
    }

    /// Whether a dart does not fall too near to a source or a vein.
    fn is_free(&self, p: DVec2, metric: Metric, nodes: &Nodes) -> bool {
        let spacing = self.room(p, metric);
        let crowded = spacing > 0.0
            && self.spaced.any_near(&self.places, p, metric.around(p, spacing), |_, q| {
                metric.distance_squared(p, q) < spacing * spacing
            });
        let vein_spacing = metric.length(self.vein_spacing_mm) * self.share(p);
        !crowded && !nodes.any_within(p, vein_spacing, metric)
    }

    /// From now on sources need only a share of their room; where tissue stands still, the darts of
    /// this many steps fall anew.
    pub(super) fn crowd(&mut self, share: f64, volley_steps: u64) {
        self.spacing_mm *= share;
        self.vein_spacing_mm *= share;
        self.rate *= VEINLET_DARTS;
        self.volley = (self.rate * volley_steps as f64) as u64;
        self.rests = false;
        self.waiting.reverse();
        self.is_sorted = false;
    }

    /// From now on nothing falls, until [`crowd`](Self::crowd).
    pub(super) fn rest(&mut self) {
        self.rests = true;
    }

    /// Makes room where sources died.
    pub(super) fn forget(&mut self, dead: &[u32]) {
        if self.falls {
            dead.iter().for_each(|&id| self.spaced.remove(id, self.places[id as usize]));
        }
    }

    /// Whether no source is to come.
    pub(super) fn is_exhausted(&self) -> bool {
        !(self.falls && self.rate > 0.0) && self.waiting.iter().all(|&(birth, _)| birth == u64::MAX)
    }

    /// Given places that lie outside the blade.
    pub(super) fn outside(&self) -> usize {
        self.outside
    }

    /// Places that the margin never passed.
    pub(super) fn unborn(&self) -> usize {
        self.waiting.len()
    }
}

/// A place with the step in which the margin passes it, if it lies in the blade.
fn waiting(blade: &GrowingBlade, p: DVec2) -> Option<(u64, DVec2)> {
    // One that the margin does not pass in time waits for ever.
    blade.covers(p).then(|| (blade.birth_step(p).unwrap_or(u64::MAX), p))
}
