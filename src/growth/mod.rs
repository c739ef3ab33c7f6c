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
mod overlap;
mod scales;

use glam::DVec2;

use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::margin::{Margin, MarginError};
use crate::parameter::{parameters, words};
use marginal::Sweep;
use scales::Schedule;

words! {
    /// How the blade grows (Foster, appendix B.2).
    pub enum GrowthType {
        /// Full size from the first step on.
        None = "none",
        /// New tissue at the margin only; what is inside does not move.
        Marginal = "marginal",
        /// The same rate in both directions; what is inside is carried along.
        Isotropic = "isotropic",
        /// Different rates across and along; what is inside is carried along.
        Anisotropic = "anisotropic",
    }
}

parameters! {
    /// Growth of the blade, in steps (Foster, appendix B.2).
    pub struct GrowthSpec {
        /// How the blade grows: `none`, `marginal`, `isotropic` or `anisotropic`.
        r#type: choice(GrowthType, GrowthType::Isotropic),
        /// Steps from the first margin to the mature one (not for anisotropic growth).
        total_steps: count(400, 1..=100_000, "steps"),
        /// Steps of growth across the blade, for anisotropic growth.
        horizontal_steps: count(300, 1..=100_000, "steps"),
        /// Steps of growth along the blade, for anisotropic growth.
        vertical_steps: count(400, 1..=100_000, "steps"),
        /// The step at which veins begin; near the total they come out straight.
        start_step: count(100, 0..=100_000, "steps"),
        /// Share of the steps that are made: below 1 the leaf stays a bud of that age.
        scale: number(1.0, 0.01..=1.0, ""),
    }
}

/// Why a blade cannot grow.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowthError {
    /// A setting is out of its limits, or contradicts another.
    #[error("{key} = {value} {problem}")]
    Setting {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The limit and what to change.
        problem: String,
    },
    /// The blade is not a proper margin at some age, mostly because it is too small.
    #[error("the blade at step {step} is no margin: {source}; raise growth.scale")]
    Margin {
        /// The step.
        step: u64,
        /// What is wrong with it.
        source: MarginError,
    },
}

/// How lengths are measured at one age, in the frame of the mature leaf.
///
/// The distance of two points is |(a − b)·`stretch`|, and a length of the current leaf is
/// `per_mm` times as long in that measure. Uniform growth keeps `stretch` at one, so that distances
/// stay valid from step to step and only the lengths of the model shrink.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Metric {
    /// Factors on x and y.
    pub stretch: DVec2,
    /// What a current millimetre measures.
    pub per_mm: f64,
}

impl Metric {
    /// The squared distance of two points.
    #[must_use]
    pub fn distance_squared(&self, a: DVec2, b: DVec2) -> f64 {
        ((a - b) * self.stretch).length_squared()
    }

    /// The measure of a length of the current leaf.
    #[must_use]
    pub fn length(&self, mm: f64) -> f64 {
        mm * self.per_mm
    }

    /// Half width and height, in the frame of the mature leaf, of the box around a circle of the
    /// given measure.
    #[must_use]
    pub fn reach(&self, measure: f64) -> DVec2 {
        DVec2::splat(measure) / self.stretch
    }
}

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
    finished: Margin,
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
        let sweep = (spec.r#type == GrowthType::Marginal).then(|| Sweep::new(margin.outline()));
        let mut blade = Self {
            edges: SegmentIndex::of_polygon(margin.outline()),
            cuts,
            convex: margin.cuts().is_empty() && polygon::is_convex(margin.outline()),
            sweep,
            schedule,
            spec: spec.clone(),
            finished: margin.clone(),
            margin,
        };
        blade.finished = blade.at(blade.last_step())?;
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

    /// Size of the outline at a step, across and along, relative to the mature one.
    #[must_use]
    pub fn scale_at(&self, step: u64) -> DVec2 {
        self.schedule.scale(step)
    }

    /// Whether points inside move with the blade.
    #[must_use]
    pub fn carries_tissue(&self) -> bool {
        matches!(self.spec.r#type, GrowthType::Isotropic | GrowthType::Anisotropic)
    }

    /// How lengths are measured at a step.
    #[must_use]
    pub fn metric(&self, step: u64) -> Metric {
        let scale = if self.carries_tissue() { self.scale_at(step) } else { DVec2::ONE };
        if self.deforms() {
            Metric { stretch: scale, per_mm: 1.0 }
        } else {
            Metric { stretch: DVec2::ONE, per_mm: 1.0 / scale.x }
        }
    }

    /// Whether the blade changes its proportions, so that what is nearest can change with age.
    #[must_use]
    pub fn deforms(&self) -> bool {
        self.schedule.is_uneven()
    }

    /// Whether `p` lies inside the blade at a step.
    #[must_use]
    pub fn is_inside(&self, p: DVec2, step: u64) -> bool {
        self.edges.contains(p) && self.birth_step(p).is_some_and(|birth| birth <= step)
    }

    /// The first step at which the margin has passed the place `p` of the mature blade; `None` when
    /// that is after the last step.
    #[must_use]
    pub fn birth_step(&self, p: DVec2) -> Option<u64> {
        match &self.sweep {
            Some(sweep) => self.schedule.first_at_least(sweep.scale_reaching(p)),
            None => Some(self.schedule.first),
        }
    }

    /// Whether `p` lies inside the mature blade.
    #[must_use]
    pub fn covers(&self, p: DVec2) -> bool {
        self.edges.contains(p)
    }

    /// Whether the margin or a cut stands between two points inside the blade.
    #[must_use]
    pub fn blocks_sight(&self, a: DVec2, b: DVec2, step: u64) -> bool {
        !self.convex && (self.blocks_sight_for_ever(a, b) || self.blocks_sight_yet(a, b, step))
    }

    /// Whether the mature margin or a cut stands between two points, so that they will never see
    /// each other.
    #[must_use]
    pub fn blocks_sight_for_ever(&self, a: DVec2, b: DVec2) -> bool {
        !self.convex && (self.edges.touches(a, b) || self.cuts.touches(a, b))
    }

    /// Whether tissue that is still to come lies between two points.
    #[must_use]
    pub fn blocks_sight_yet(&self, a: DVec2, b: DVec2, step: u64) -> bool {
        let Some(sweep) = &self.sweep else { return false };
        !self.convex && sweep.touches(a, b, self.scale_at(step).x)
    }

    /// Whether sight is never blocked: a convex blade without cuts.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.convex
    }

    /// Area at a step relative to the mature blade.
    ///
    /// # Errors
    ///
    /// As [`at`](Self::at), under marginal growth.
    pub fn area_share(&self, step: u64) -> Result<f64, GrowthError> {
        if self.sweep.as_ref().is_some_and(|sweep| !sweep.is_plain()) {
            return Ok(self.at(step)?.area_mm2() / self.margin.area_mm2());
        }
        Ok(self.schedule.scale(step).element_product())
    }

    /// The blade at a step as a margin, at the size it then has.
    ///
    /// # Errors
    ///
    /// [`GrowthError::Margin`] when it is too small to be a margin.
    pub fn at(&self, step: u64) -> Result<Margin, GrowthError> {
        let scale = self.scale_at(step);
        if scale == DVec2::ONE {
            return Ok(self.margin.clone());
        }
        let made = if let Some(sweep) = &self.sweep {
            sweep.margin(&self.margin, scale.x)
        } else {
            Margin::from_outline(self.margin.to_outline().scaled(scale), "change growth.type")
        };
        made.map_err(|source| GrowthError::Margin { step, source })
    }

    /// Where a point of the blade at step `from` lies at step `to`, in the leaf's own size.
    #[must_use]
    pub fn carry(&self, point: DVec2, from: u64, to: u64) -> DVec2 {
        if from == to || !self.carries_tissue() {
            return point;
        }
        point * (self.scale_at(to) / self.scale_at(from))
    }

    /// Where a place of the mature leaf lies in the finished one.
    #[must_use]
    pub fn finished_from_mature(&self, p: DVec2) -> DVec2 {
        if self.carries_tissue() { p * self.scale_at(self.last_step()) } else { p }
    }

    /// Where a vein that enters at the base begins: just inside the blade at every age, so that
    /// lines of sight from it are well defined.
    #[must_use]
    pub fn root(&self) -> DVec2 {
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

/// How far inside the base a root lies, in lengths of the blade: invisible (0.1 µm in a leaf of
/// 100 mm), yet a million times the rounding of a coordinate.
const ROOT_INSET: f64 = 1e-6;

#[cfg(test)]
mod tests;
