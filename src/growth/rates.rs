//! Growth that is faster in some parts of the blade than in others, and at some ages than at others.
//!
//! The relative elementary growth rate of a place (how fast a short line there grows, relative to its
//! length) is that of even growth times a factor of place and age. Scales follow by summing rates
//! back from the mature leaf, where they are 1: the given margin is met exactly, and a factor of 1
//! everywhere is even growth itself. Places are material: a factor stays with the tissue.
//!
//! Basipetal leaves mature from the apex: a front moves down to the base, and behind it tissue hardly
//! grows. Acropetal ones mature from the base. Margin-led ones add tissue at the margin: of the
//! logarithm of the size a share is laid down there and does not move any more, the rest is even.
//!
//! Source: non-uniform growth is what Runions et al. (2005) and E. Foster name as future work. Rates
//! are those of O. Richards and A. Kavanagh, "The analysis of the relative growth gradients and
//! changing form of growing organisms", Am. Nat. 77, 1943. The factors are of mean 1 along the blade,
//! so that the leaf as a whole keeps its pace.

use glam::DVec2;

use super::GrowthError;
use super::scales::Schedule;
use super::warp::Warp;
use crate::geometry::Rect;
use crate::parameter::{parameters, words};

words! {
    /// Which part of the blade grows fastest.
    pub enum RatePattern {
        /// All alike.
        Even = "even",
        /// The base: the leaf matures from the apex down.
        Basipetal = "basipetal",
        /// The apex: the leaf matures from the base up.
        Acropetal = "acropetal",
        /// The margin, where tissue is added.
        MarginLed = "margin-led",
    }
}

words! {
    /// Directions in which growth follows the pattern.
    pub enum RateAxes {
        /// Across and along.
        Both = "both",
        /// Along only; across it is even.
        Along = "along",
        /// Across only; along it is even.
        Across = "across",
    }
}

words! {
    /// What rates that are the same everywhere amount to.
    pub enum EvenGrowth {
        /// Isotropic growth, over `growth.total_steps`.
        Isotropic = "isotropic",
        /// Anisotropic growth, over `growth.horizontal_steps` and `growth.vertical_steps`.
        Anisotropic = "anisotropic",
    }
}

parameters! {
    /// Rates for `growth.type = "non-uniform"`.
    pub struct RateSpec {
        /// Which part grows fastest: `even` (none), `basipetal` (the base; maturing from the apex),
        /// `acropetal` (the apex) or `margin-led` (the margin).
        pattern: choice(RatePattern, RatePattern::Basipetal),
        /// How much: 0 is even growth, at 1 mature tissue grows no more; `margin-led`: the share of
        /// growth at the margin, at 1 marginal growth.
        contrast: number(0.8, 0.0..=1.0, ""),
        /// Basipetal and acropetal: how gradually tissue matures.
        front: number(0.7, 0.05..=3.0, "lengths"),
        /// Directions that follow the pattern: `both`, `along` or `across`.
        axes: choice(RateAxes, RateAxes::Both),
        /// What even rates amount to: `isotropic` (`growth.total_steps`) or `anisotropic`
        /// (`growth.horizontal_steps`, `growth.vertical_steps`).
        even_growth: choice(EvenGrowth, EvenGrowth::Isotropic),
        /// Factors on the rate by place, `[[place, factor], …]`; places from 0 (base) to 1 (apex),
        /// straight lines between.
        by_place: points(),
        /// Factors on the rate by age, `[[age, factor], …]`; ages from 0 to 1 (mature). 0 everywhere
        /// is a blade of full size.
        by_age: points(),
    }
}

/// Factors beyond this make parts of a young leaf too small to be one.
const GREATEST_FACTOR: f64 = 4.0;

/// Bands of the blade: the front is a few of them wide even where it is steepest.
const BANDS: usize = 48;

/// Ages at which factors are read; between two they stay.
const AGES: usize = 96;

/// A part that is smaller than this at the first step is no part of a leaf.
const LEAST_SCALE: f64 = 1e-6;

/// How scales follow from rates.
#[derive(Debug, Clone)]
pub(super) struct Rates {
    /// Share of the growth at the margin.
    at_margin: f64,
    /// Factors of age, if not 1 throughout.
    by_age: Vec<[f64; 2]>,
    /// Where rates differ from place to place.
    field: Option<Field>,
}

/// Factors in bands across the blade.
#[derive(Debug, Clone)]
struct Field {
    bottom: f64,
    height: f64,
    /// For each age, the factors at the edges of the bands (growth across).
    across: Vec<Vec<f64>>,
    /// For each age, the factors in the middle of the bands (growth along).
    along: Vec<Vec<f64>>,
}

impl Rates {
    pub(super) fn new(spec: &RateSpec, bounds: Rect, apex: f64) -> Result<Self, GrowthError> {
        let limits = |key, value: f64, min: f64, max: f64| {
            if (min..=max).contains(&value) {
                return Ok(());
            }
            let problem = format!("must be from {min} to {max}");
            Err(GrowthError::Setting { key, value, problem })
        };
        limits("growth.rates.contrast", spec.contrast, 0.0, 1.0)?;
        limits("growth.rates.front", spec.front, 0.05, 3.0)?;
        check_curve("growth.rates.by_place", &spec.by_place)?;
        check_curve("growth.rates.by_age", &spec.by_age)?;
        let wave = matches!(spec.pattern, RatePattern::Basipetal | RatePattern::Acropetal);
        let differs = (wave && spec.contrast > 0.0) || !is_one(&spec.by_place);
        let led = spec.pattern == RatePattern::MarginLed;
        Ok(Self {
            at_margin: if led { spec.contrast } else { 0.0 },
            by_age: if is_one(&spec.by_age) { Vec::new() } else { spec.by_age.clone() },
            field: differs.then(|| Field::new(spec, bounds, apex)),
        })
    }

    /// Share of the growth at the margin.
    pub(super) fn at_margin(&self) -> f64 {
        self.at_margin
    }

    /// Whether scales differ from place to place.
    pub(super) fn is_field(&self) -> bool {
        self.field.is_some()
    }

    /// The size of the blade at a step, across and along, where rates do not differ.
    fn size(&self, schedule: &Schedule, step: u64) -> DVec2 {
        if self.by_age.is_empty() {
            return schedule.scale(step);
        }
        let mut grown = DVec2::ZERO;
        each_age(schedule, step, |_, age, growth| grown += growth * value(&self.by_age, age));
        DVec2::new(libm::exp(-grown.x), libm::exp(-grown.y))
    }

    /// How far the margin has come by what was added there, relative to the mature blade.
    pub(super) fn passed(&self, schedule: &Schedule, step: u64) -> f64 {
        if self.at_margin == 0.0 {
            return 1.0;
        }
        libm::pow(self.size(schedule, step).max_element(), self.at_margin)
    }

    /// The scale of the tissue, across and along, where rates do not differ.
    pub(super) fn scale(&self, schedule: &Schedule, step: u64) -> DVec2 {
        self.size(schedule, step) / self.passed(schedule, step)
    }

    /// The map to the leaf of a step, where rates differ from place to place.
    pub(super) fn warp(&self, schedule: &Schedule, step: u64) -> Option<Warp> {
        let field = self.field.as_ref()?;
        let mut across = vec![0.0; BANDS + 1];
        let mut along = vec![0.0; BANDS];
        let rest = 1.0 - self.at_margin;
        each_age(schedule, step, |i, age, growth| {
            let growth = growth * rest * value(&self.by_age, age);
            let add = |sums: &mut [f64], factors: &[f64], growth: f64| {
                sums.iter_mut().zip(factors).for_each(|(sum, factor)| *sum += growth * factor);
            };
            add(&mut across, &field.across[i], growth.x);
            add(&mut along, &field.along[i], growth.y);
        });
        let scales = |sums: Vec<f64>| sums.into_iter().map(|sum| libm::exp(-sum)).collect();
        Some(Warp::new(field.bottom, field.height, scales(across), scales(along)))
    }

    /// Refuses rates under which a part of the leaf would be next to nothing at the first step.
    pub(super) fn check(&self, schedule: &Schedule) -> Result<(), GrowthError> {
        let least = match self.warp(schedule, schedule.first) {
            Some(warp) => warp.least_scale(),
            None => self.size(schedule, schedule.first).min_element(),
        };
        let is_even = !self.is_field() && self.by_age.is_empty();
        if least >= LEAST_SCALE || is_even {
            return Ok(());
        }
        let problem = format!(
            "lets parts of the blade be {least:.1e} of their size when veins begin; raise it, or \
             lower growth.rates.contrast and the factors of growth.rates"
        );
        let value = schedule.first as f64;
        Err(GrowthError::Setting { key: "growth.start_step", value, problem })
    }
}

impl Field {
    fn new(spec: &RateSpec, bounds: Rect, apex: f64) -> Self {
        let height = bounds.size().y / BANDS as f64;
        let place = |band: f64| ((bounds.min.y + band * height) / apex).clamp(0.0, 1.0);
        let edges: Vec<f64> = (0..=BANDS).map(|i| place(i as f64)).collect();
        let middles: Vec<f64> = (0..BANDS).map(|i| place(i as f64 + 0.5)).collect();
        let follows = |axes: RateAxes| spec.axes == RateAxes::Both || spec.axes == axes;
        let factors = |places: &[f64], follows: bool| -> Vec<Vec<f64>> {
            let at = |i: usize| (i as f64 + 0.5) / AGES as f64;
            let ages = (0..AGES).map(at);
            ages.map(|age| {
                if !follows {
                    return vec![1.0; places.len()];
                }
                // Of mean 1 over the length of the blade.
                let mean = middles.iter().map(|u| wave(spec, *u, age)).sum::<f64>() / BANDS as f64;
                let factor = |u: &f64| wave(spec, *u, age) / mean * value(&spec.by_place, *u);
                places.iter().map(factor).collect()
            })
            .collect()
        };
        Self {
            bottom: bounds.min.y,
            height,
            across: factors(&edges, follows(RateAxes::Across)),
            along: factors(&middles, follows(RateAxes::Along)),
        }
    }
}

/// Calls `visit` with the ages from a step on: the number of each, the age itself, and what even
/// growth adds there to the logarithm of the size.
fn each_age(schedule: &Schedule, step: u64, mut visit: impl FnMut(usize, f64, DVec2)) {
    let total = schedule.total() as f64;
    let size = |age: f64| {
        let scale = schedule.scale_at_age(age * total);
        DVec2::new(libm::log(scale.x), libm::log(scale.y))
    };
    let mut at = (step as f64 / total).min(1.0);
    let first = ((at * AGES as f64) as usize).min(AGES - 1);
    let mut before = size(at);
    for i in first..AGES {
        let next = (i + 1) as f64 / AGES as f64;
        if next <= at {
            continue;
        }
        let after = size(next);
        visit(i, (i as f64 + 0.5) / AGES as f64, after - before);
        (at, before) = (next, after);
    }
}

/// The factor of the pattern at a place (0 base, 1 apex): 1 before the front, less behind it.
fn wave(spec: &RateSpec, place: f64, age: f64) -> f64 {
    let from_base = match spec.pattern {
        RatePattern::Basipetal => place,
        RatePattern::Acropetal => 1.0 - place,
        RatePattern::Even | RatePattern::MarginLed => return 1.0,
    };
    // The front comes from the far end and is at the near one when the leaf is mature.
    let behind = (from_base - (1.0 - age)) / spec.front + 0.5;
    let t = behind.clamp(0.0, 1.0);
    1.0 - spec.contrast * t * t * (3.0 - 2.0 * t)
}

/// The value of a curve: straight between its points, level beyond; 1 without any.
fn value(curve: &[[f64; 2]], at: f64) -> f64 {
    let after = curve.partition_point(|point| point[0] <= at);
    match (after.checked_sub(1).map(|i| curve[i]), curve.get(after)) {
        (None, None) => 1.0,
        (Some(last), None) => last[1],
        (None, Some(first)) => first[1],
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (at - a[0]) / (b[0] - a[0]),
    }
}

fn is_one(curve: &[[f64; 2]]) -> bool {
    curve.iter().all(|point| point[1] == 1.0)
}

fn check_curve(key: &'static str, curve: &[[f64; 2]]) -> Result<(), GrowthError> {
    let error = |value: f64, problem: String| Err(GrowthError::Setting { key, value, problem });
    let mut before = f64::NEG_INFINITY;
    for &[at, factor] in curve {
        if !(0.0..=1.0).contains(&at) || at < before {
            return error(at, "must be from 0 to 1, and no smaller than the one before".into());
        }
        if !(0.0..=GREATEST_FACTOR).contains(&factor) {
            return error(factor, format!("is a factor, from 0 to {GREATEST_FACTOR}"));
        }
        before = at;
    }
    Ok(())
}
