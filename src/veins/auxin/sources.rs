//! Where auxin sources come from: darts that fall where there is room, or given places.

use glam::DVec2;

use super::callers::Callers;
use super::extend::Nodes;
use crate::geometry::point_grid::PointGrid;
use crate::geometry::scatter::PolygonScatter;
use crate::growth::{GrowingBlade, Metric};
use crate::seed::Rng;
use crate::veins::{VeinError, VeinSpec};

/// More darts than this are a slip of the keyboard: Foster's longest run throws 3 million, and each
/// costs about a tenth of a microsecond.
const MAX_DARTS: f64 = 3e7;

/// More sources than this are a slip of the keyboard, mostly a spacing of zero: they take a few
/// hundred megabytes.
const MAX_SOURCES: usize = 4_000_000;

/// The sources still to come.
pub(super) struct Supply<'a> {
    blade: &'a GrowingBlade,
    spacing_mm: f64,
    vein_spacing_mm: f64,
    rate: f64,
    scatter: PolygonScatter,
    /// Living sources, for their spacing; only where darts fall.
    spaced: PointGrid,
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
        spec: &VeinSpec,
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
        let mut supply = Self {
            blade,
            spacing_mm: spec.source_spawn_distance_mm,
            vein_spacing_mm: spec.vein_spawn_distance_mm,
            rate: spec.spawn_rate,
            scatter: PolygonScatter::new(blade.mature().outline()),
            spaced: PointGrid::new(blade.mature().bounds(), cell),
            fraction: 0.0,
            waiting: Vec::new(),
            given,
            volley: (spec.spawn_rate * volley_steps as f64) as u64,
            is_sorted: false,
            outside: 0,
        };
        for (i, place) in spec.sources_mm.iter().enumerate() {
            let p = DVec2::from(*place);
            if !p.is_finite() {
                let problem = "is the index of a point that is not made of finite numbers";
                return Err(VeinError::setting("veins.sources_mm", i as f64, problem));
            }
            supply.wait_for(p);
        }
        Ok(supply)
    }

    /// Keeps a place for the step in which the margin passes it.
    fn wait_for(&mut self, p: DVec2) {
        if !self.blade.covers(p) {
            self.outside += 1;
            return;
        }
        // A place the margin does not pass in time waits for ever.
        self.waiting.push((self.blade.birth_step(p).unwrap_or(u64::MAX), p));
    }

    /// Adds the sources of one step to `calls`.
    pub(super) fn seed(
        &mut self,
        step: u64,
        metric: Metric,
        rng: &mut Rng,
        calls: &mut dyn Callers,
        nodes: &Nodes,
    ) -> Result<(), VeinError> {
        let darts_fall = !self.given && self.blade.carries_tissue();
        if !self.given && !self.blade.carries_tissue() {
            // All darts fall on the mature blade before the step.
            for _ in 0..std::mem::take(&mut self.volley) {
                if let Some(p) = self.throw(metric, rng, nodes) {
                    self.spaced.push(p);
                    self.wait_for(p);
                }
                self.check_number()?;
            }
        }
        if !self.is_sorted {
            self.is_sorted = true;
            // Stable: those of one step keep their order. Latest first, so that they can be popped.
            self.waiting.reverse();
            self.waiting.sort_by_key(|&(birth, _)| std::cmp::Reverse(birth));
        }
        while let Some(&(birth, p)) = self.waiting.last()
            && birth <= step
        {
            self.waiting.pop();
            calls.add(p, nodes, metric);
        }
        if darts_fall {
            let cell = metric.reach(metric.length(self.spacing_mm)).max_element();
            self.spaced.refine(cell);
            // As many as would fall on the whole leaf if all of it were as large as its largest part;
            // those that fall beside the others are lost.
            self.fraction += self.rate * self.blade.greatest_area_scale(step);
            let darts = self.fraction as u64;
            self.fraction -= darts as f64;
            for _ in 0..darts {
                let thrown = self.throw(metric, rng, nodes);
                let is_there =
                    |p: &DVec2| self.blade.birth_step(*p).is_some_and(|birth| birth <= step);
                if let Some(p) = thrown.filter(is_there) {
                    self.spaced.push(p);
                    calls.add(p, nodes, metric);
                }
                self.check_number()?;
            }
        }
        calls.keep_index();
        Ok(())
    }

    fn check_number(&self) -> Result<(), VeinError> {
        if self.spaced.len() <= MAX_SOURCES {
            return Ok(());
        }
        let problem = format!("leaves room for more than {MAX_SOURCES} sources; raise it");
        Err(VeinError::setting("veins.source_spawn_distance_mm", self.spacing_mm, problem))
    }

    /// One dart; nothing when it falls too near to a source or a vein.
    fn throw(&self, metric: Metric, rng: &mut Rng, nodes: &Nodes) -> Option<DVec2> {
        let (u, v) = (rng.unit(), rng.unit());
        let p = self.scatter.point(u, v);
        if metric.is_warped() {
            let (here, most) = (metric.area_scale(p), metric.greatest_area_scale());
            if rng.unit() * most >= here {
                return None;
            }
        }
        let spacing = metric.length(self.spacing_mm);
        let crowded = spacing > 0.0
            && self.spaced.any_near(p, metric.around(p, spacing), |_, q| {
                metric.distance_squared(p, q) < spacing * spacing
            });
        let free = !crowded && !nodes.any_within(p, metric.length(self.vein_spacing_mm), metric);
        free.then_some(p)
    }

    /// From now on sources need only a share of their room; where tissue stands still, the darts of
    /// this many steps fall anew.
    pub(super) fn crowd(&mut self, share: f64, volley_steps: u64) {
        self.spacing_mm *= share;
        self.vein_spacing_mm *= share;
        self.volley = (self.rate * volley_steps as f64) as u64;
        self.waiting.reverse();
        self.is_sorted = false;
    }

    /// Makes room where sources died.
    pub(super) fn forget(&mut self, dead: &[u32]) {
        if !self.given && self.blade.carries_tissue() {
            dead.iter().for_each(|&id| self.spaced.remove(id));
        }
    }

    /// Whether no source is to come.
    pub(super) fn is_exhausted(&self) -> bool {
        let darts_fall = !self.given && self.blade.carries_tissue() && self.rate > 0.0;
        !darts_fall && self.waiting.iter().all(|&(birth, _)| birth == u64::MAX)
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
