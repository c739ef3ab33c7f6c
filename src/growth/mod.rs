//! How the blade changes with age.
//!
//! Everything is kept in the frame of the mature leaf. Where tissue moves with the blade (isotropic,
//! anisotropic growth) it stands still in this frame, and the distances of the vein model shrink
//! instead ([`Metric`]); [`GrowingBlade::carry`] is the literal motion, for tests and pictures. Where
//! it does not move (marginal growth) the margin passes over it.
//!
//! Source: E. Foster, *Procedural leaf generation*, growth of the margin and appendix B.2, who moves
//! every point in every step. Departs from it: the root is always the base of the blade, both
//! printed formulas of the first margin are replaced by one (`scales`), and under marginal growth
//! tissue never disappears again (`marginal`).

mod marginal;
mod metric;
mod overlap;
mod rates;
mod scales;
mod sight;
mod spec;
mod warp;

use glam::DVec2;

use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use marginal::Sweep;
pub use metric::{Frame, Metric};
use rates::Rates;
pub use rates::{EvenGrowth, RateAxes, RatePattern, RateSpec};
use scales::Schedule;
pub use spec::{GrowthError, GrowthSpec, GrowthType};
use warp::Warp;

/// A blade at every age. Points are in the frame of the mature leaf.
///
/// # Guarantees
///
/// - At the last step of a leaf with `growth.scale` = 1 the blade is the mature margin.
/// - The blade never shrinks: what is inside at one step is inside at all later ones.
/// - [`carry`](Self::carry) is the identity between equal steps and takes inside to inside.
#[derive(Debug, Clone)]
pub struct GrowingBlade {
    margin: Margin,
    spec: GrowthSpec,
    schedule: Schedule,
    edges: SegmentIndex,
    cuts: SegmentIndex,
    /// Two points inside always see each other.
    convex: bool,
    /// The margin that passes over the tissue, under marginal growth.
    sweep: Option<Sweep>,
    /// Under non-uniform growth.
    rates: Option<Rates>,
    carries_tissue: bool,
    finished: Margin,
    present: Margin,
}

impl GrowingBlade {
    /// A blade that ends as `margin` (with `growth.scale` = 1).
    ///
    /// # Errors
    ///
    /// [`GrowthError`] with the key and the limit when the steps contradict each other.
    pub fn new(margin: Margin, spec: &GrowthSpec) -> Result<Self, GrowthError> {
        let schedule = Schedule::new(spec)?;
        let lines = margin.cuts().iter().flat_map(|line| line.windows(2).map(|w| (w[0], w[1])));
        let cuts = SegmentIndex::new(lines.collect());
        let rates = (spec.r#type == GrowthType::NonUniform)
            .then(|| Rates::new(&spec.rates, margin.bounds(), margin.apex().y))
            .transpose()?;
        rates.as_ref().map_or(Ok(()), |rates| rates.check(&schedule))?;
        let passes = match &rates {
            Some(rates) => rates.at_margin() > 0.0,
            None => spec.r#type == GrowthType::Marginal,
        };
        let sweep = passes.then(|| Sweep::new(margin.outline()));
        let carries_tissue = match &rates {
            Some(rates) => rates.is_field() || rates.scale(&schedule, 0) != DVec2::ONE,
            None => matches!(spec.r#type, GrowthType::Isotropic | GrowthType::Anisotropic),
        };
        let mut blade = Self {
            edges: SegmentIndex::of_polygon(margin.outline()),
            cuts,
            convex: margin.cuts().is_empty() && polygon::is_convex(margin.outline()),
            sweep,
            rates,
            carries_tissue,
            schedule,
            spec: spec.clone(),
            finished: margin.clone(),
            present: margin.clone(),
            margin,
        };
        let last = blade.last_step();
        blade.present = blade.passed_margin(last)?;
        blade.finished = blade.at(last)?;
        Ok(blade)
    }

    /// The mature margin.
    #[must_use]
    pub fn mature(&self) -> &Margin {
        &self.margin
    }

    /// The margin of the leaf that comes out: the mature one, or that of a bud.
    #[must_use]
    pub fn finished(&self) -> &Margin {
        &self.finished
    }

    /// Its growth.
    #[must_use]
    pub fn spec(&self) -> &GrowthSpec {
        &self.spec
    }

    /// The steps in which veins grow: from start · scale to total · scale.
    #[must_use]
    pub fn steps(&self) -> std::ops::RangeInclusive<u64> {
        self.schedule.first..=self.schedule.last
    }

    /// The step of the finished leaf.
    #[must_use]
    pub fn last_step(&self) -> u64 {
        self.schedule.last
    }

    /// The step at which the blade is mature; after the last one of a bud.
    #[must_use]
    pub fn mature_step(&self) -> u64 {
        self.schedule.total()
    }

    /// What there is of the mature leaf at the last step, where tissue lies in the mature leaf.
    #[must_use]
    pub fn present(&self) -> &Margin {
        &self.present
    }

    /// Size of the outline at a step, across and along, relative to the mature one; under non-uniform
    /// growth that of the box around it.
    #[must_use]
    pub fn scale_at(&self, step: u64) -> DVec2 {
        if let Some(warp) = self.warp(step) {
            let bounds = self.margin.bounds();
            let (low, high) = warp.corners(bounds);
            let outline = self.margin.outline().iter();
            let reach = outline.map(|p| warp.place(*p).x.abs()).fold(0.0, f64::max);
            let widest = bounds.max.x.max(-bounds.min.x);
            return DVec2::new(reach / widest, (high - low).y / bounds.size().y)
                * self.passed(step);
        }
        match &self.rates {
            Some(rates) => rates.scale(&self.schedule, step) * self.passed(step),
            None => self.schedule.scale(step),
        }
    }

    /// Scale of the tissue, across and along, where it is the same everywhere.
    fn tissue_scale(&self, step: u64) -> DVec2 {
        match &self.rates {
            _ if !self.carries_tissue || self.is_warped() => DVec2::ONE,
            Some(rates) => rates.scale(&self.schedule, step),
            None => self.schedule.scale(step),
        }
    }

    /// How large the tissue is, by area and relative to the mature leaf, where it is largest.
    #[must_use]
    pub fn greatest_area_scale(&self, step: u64) -> f64 {
        match self.warp(step) {
            Some(warp) => warp.greatest_area_scale(),
            None => self.tissue_scale(step).element_product(),
        }
    }

    /// How far the margin has come that passes over the tissue, relative to the mature one.
    fn passed(&self, step: u64) -> f64 {
        match (&self.sweep, &self.rates) {
            (None, _) => 1.0,
            (_, Some(rates)) => rates.passed(&self.schedule, step),
            (_, None) => self.schedule.scale(step).x,
        }
    }

    /// The map to the leaf of a step; `None` where all scales are alike, as in the mature leaf.
    fn warp(&self, step: u64) -> Option<Warp> {
        let is_mature = step >= self.schedule.total();
        self.rates.as_ref().filter(|_| !is_mature)?.warp(&self.schedule, step)
    }

    /// Whether points inside move with the blade.
    #[must_use]
    pub fn carries_tissue(&self) -> bool {
        self.carries_tissue
    }

    /// Whether the blade has its full size from the first step on.
    #[must_use]
    pub fn is_full_size(&self) -> bool {
        !self.carries_tissue && self.passed(self.schedule.first) == 1.0
    }

    /// How lengths are measured at a step.
    #[must_use]
    pub fn frame(&self, step: u64) -> Frame {
        if let Some(warp) = self.warp(step) {
            return Frame::warped(warp);
        }
        let scale = self.tissue_scale(step);
        if self.deforms() {
            Frame::uniform(scale, 1.0)
        } else {
            Frame::uniform(DVec2::ONE, 1.0 / scale.x)
        }
    }

    /// Whether the blade changes its proportions, so that what is nearest can change with age.
    #[must_use]
    pub fn deforms(&self) -> bool {
        self.carries_tissue && (self.is_warped() || self.schedule.is_uneven())
    }

    /// Whether it grows at rates that differ from place to place: then distances may also shrink.
    #[must_use]
    pub fn is_warped(&self) -> bool {
        self.rates.as_ref().is_some_and(Rates::is_field)
    }

    /// How large the tissue at a place is, by area and relative to the mature leaf.
    #[must_use]
    pub fn area_scale(&self, p: DVec2, step: u64) -> f64 {
        match self.warp(step) {
            Some(warp) => warp.area_scale(p),
            None => self.tissue_scale(step).element_product(),
        }
    }

    /// Area at a step relative to the mature blade.
    ///
    /// # Errors
    ///
    /// As [`at`](Self::at), under marginal growth.
    pub fn area_share(&self, step: u64) -> Result<f64, GrowthError> {
        if self.is_warped() || self.sweep.as_ref().is_some_and(|sweep| !sweep.is_plain()) {
            return Ok(self.at(step)?.area_mm2() / self.margin.area_mm2());
        }
        Ok(self.scale_at(step).element_product())
    }

    /// What the margin has passed at a step, where tissue lies in the mature leaf.
    fn passed_margin(&self, step: u64) -> Result<Margin, GrowthError> {
        let scale = self.passed(step);
        match &self.sweep {
            Some(sweep) if scale != 1.0 => sweep
                .margin(&self.margin, scale)
                .map_err(|source| GrowthError::Margin { step, source }),
            _ => Ok(self.margin.clone()),
        }
    }

    /// The blade at a step as a margin, at the size it then has.
    ///
    /// # Errors
    ///
    /// [`GrowthError::Margin`] when it is too small to be a margin.
    pub fn at(&self, step: u64) -> Result<Margin, GrowthError> {
        let there = self.passed_margin(step)?;
        let frame = self.frame_of_leaf(step);
        let metric = frame.metric();
        if !metric.is_warped() && metric.stretch == DVec2::ONE {
            return Ok(there);
        }
        let outline = there.to_outline();
        let outline = if metric.is_warped() {
            // Straight edges become bent ones.
            let longest = self.margin.length_mm() * FINENESS;
            outline.mapped(longest, |p| metric.place(p))
        } else {
            outline.scaled(metric.stretch)
        };
        let made = Margin::from_outline(outline, "change growth.type");
        made.map_err(|source| GrowthError::Margin { step, source })
    }

    /// The map from the mature leaf to that of a step, in its own size.
    fn frame_of_leaf(&self, step: u64) -> Frame {
        match self.warp(step) {
            Some(warp) => Frame::warped(warp),
            None => Frame::uniform(self.tissue_scale(step), 1.0),
        }
    }

    /// Where a point of the blade at step `from` lies at step `to`, in the leaf's own size.
    #[must_use]
    pub fn carry(&self, point: DVec2, from: u64, to: u64) -> DVec2 {
        if from == to || !self.carries_tissue() {
            return point;
        }
        if !self.is_warped() {
            return point * (self.tissue_scale(to) / self.tissue_scale(from));
        }
        let mature = self.warp(from).map_or(point, |young| young.unplace(point));
        self.warp(to).map_or(mature, |old| old.place(mature))
    }

    /// Where a place of the mature leaf lies in the finished one.
    #[must_use]
    pub fn finished_from_mature(&self, p: DVec2) -> DVec2 {
        self.frame_of_leaf(self.last_step()).metric().place(p)
    }

    /// Where a vein that enters at the base begins: just inside the blade at every age, so that
    /// lines of sight from it are well defined.
    #[must_use]
    pub fn root(&self) -> DVec2 {
        if self.margin.is_peltate() {
            return DVec2::ZERO;
        }
        let outline = self.margin.outline();
        let (out, back) = (outline[1].normalize(), outline[outline.len() - 1].normalize());
        // The bisector of the corner; it points outwards where the corner is reflex.
        let middle = out + back;
        let inward = if middle.length() < 1e-6 { out.perp() } else { middle.normalize() };
        let inward =
            if out.perp_dot(back) < 0.0 && middle.length() >= 1e-6 { -inward } else { inward };
        inward * (self.margin.length_mm() * ROOT_INSET)
    }
}

/// Edges of a young blade under non-uniform growth are cut to this, in lengths: what is lost between
/// the bent and the straight one is a hundred-thousandth of that.
const FINENESS: f64 = 5e-4;

/// How far inside the base a root lies, in lengths of the blade: invisible (0.1 µm in a leaf of
/// 100 mm), yet a million times the rounding of a coordinate.
const ROOT_INSET: f64 = 1e-6;

#[cfg(test)]
mod tests;
