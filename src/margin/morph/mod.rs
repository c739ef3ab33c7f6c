//! Morphing: the margins between two leaves, drawn towards others on the way.
//!
//! Every leaf becomes a point of one leaf space: its margin, length 1, at the same stations between
//! the same landmarks, with its length and its teeth beside it. The path through that space is a
//! rational quadratic B-spline whose weights say how strongly each reference draws it.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! chapter 7: the mapping of landmarks by 7.2.1 (equation 7.1) and 7.2.2, the path by 7.2, end weights
//! 1, references of weight 0 left out. Departs from it: between landmarks the margin itself is a point
//! of the space, in stations of equal arc length, and not the numbers that made it. So both ends are
//! exact, whatever they came from: landmarks, lobes or a polygon; and it needs no fit.

mod flank;
mod leaps;
mod marks;
mod numbers;
mod repair;
mod sides;
mod space;
mod teeth;
#[cfg(test)]
mod tests;

use super::detail::{self, Tooth, ToothForm, ToothType};
use super::{LandmarkKind, Margin, MarginError, MarginSpec, Outline};
use crate::geometry::{nurbs, polygon};
use crate::seed::Seed;
use flank::Flank;
pub use sides::MarginSide;

/// What can be done about an outline on the way that crosses itself.
const HINT: &str = "that is on the way between the two; give a reference with --via";

/// A leaf on the way.
#[derive(Debug, Clone, PartialEq)]
pub struct Station {
    /// Its margin.
    pub margin: MarginSpec,
    /// How strongly it draws the path; of no account for the first and the last.
    pub weight: f64,
}

/// A path from one margin to another.
#[derive(Debug, Clone)]
pub struct MorphPath {
    /// Which of the given leaves are on the path.
    kept: Vec<usize>,
    given: usize,
    weights: Vec<f64>,
    specs: Vec<MarginSpec>,
    way: Way,
    /// By edge, by shape, the teeth that answer each other; `None` when teeth are part of the shapes.
    teeth: Option<Vec<Vec<Vec<Tooth>>>>,
    forms: Vec<ToothForm>,
    seed: Seed,
}

impl MorphPath {
    /// The path through these leaves, the first and the last exactly; `seed` draws what is irregular
    /// about all of them.
    ///
    /// # Errors
    ///
    /// [`MarginError`] of a leaf that is none.
    ///
    /// # Panics
    ///
    /// With fewer than two leaves: a path has two ends.
    pub fn new(leaves: &[Station], seed: Seed) -> Result<Self, MarginError> {
        assert!(leaves.len() >= 2, "a path has two ends");
        let last = leaves.len() - 1;
        let kept: Vec<usize> =
            (0..=last).filter(|&i| i == 0 || i == last || leaves[i].weight > 0.0).collect();
        let weight = |&i: &usize| if i == 0 || i == last { 1.0 } else { leaves[i].weight };
        let weights: Vec<f64> = kept.iter().map(weight).collect();
        let specs: Vec<MarginSpec> = kept.iter().map(|&i| leaves[i].margin.clone()).collect();
        let entire: Vec<Outline> = specs
            .iter()
            .map(|spec| Ok(super::entire(spec)?.to_outline()))
            .collect::<Result<_, MarginError>>()?;
        let edges = |outline: &Outline| -> Vec<(bool, bool)> {
            let turns = outline.landmarks.iter().filter(|mark| {
                matches!(mark.kind, LandmarkKind::LobeTip { .. } | LandmarkKind::Valley)
            });
            turns
                .map(|mark| (mark.vertex > outline.apex, mark.kind == LandmarkKind::Valley))
                .collect()
        };
        // Lobes that a polygon does not tell of are found on it; its teeth know nothing of them.
        let found = entire.iter().any(|outline| {
            !Flank::knows_lobes(outline)
                && Flank::both(outline).iter().any(|flank| !flank.turns.is_empty())
        });
        let alike = !found && entire.iter().all(|outline| edges(outline) == edges(&entire[0]));
        let (outlines, teeth) = if alike {
            let plans = specs.iter().zip(&entire);
            let plans: Vec<Vec<Vec<Tooth>>> = plans
                .map(|(spec, outline)| detail::plan(outline, spec, seed))
                .collect::<Result<_, _>>()?;
            let edges = plans[0].len();
            let of_edge = |e: usize| -> Vec<Vec<Tooth>> {
                plans.iter().map(|plan| plan[e].clone()).collect()
            };
            (entire, Some((0..edges).map(|e| teeth::unified(&of_edge(e))).collect()))
        } else {
            let built: Result<Vec<Outline>, MarginError> =
                specs.iter().map(|spec| Ok(super::build(spec, seed)?.to_outline())).collect();
            (built?, None)
        };
        let way = Way::new(&specs, &outlines, &weights)?;
        let forms = teeth::forms(&specs);
        Ok(Self { kept, given: leaves.len(), weights, specs, way, teeth, forms, seed })
    }

    /// How much each of the given leaves counts at `u` (0 the first, 1 the last).
    #[must_use]
    pub fn shares(&self, u: f64) -> Vec<f64> {
        let mut all = vec![0.0; self.given];
        for (&i, share) in self.kept.iter().zip(nurbs::shares(&self.weights, u)) {
            all[i] = share;
        }
        all
    }

    /// The margin at `u`. At 0 and 1 it is exactly that of the first and the last leaf.
    ///
    /// # Errors
    ///
    /// [`MarginError::SelfCrossing`] when the way there leads through what is no leaf.
    pub fn at(&self, u: f64) -> Result<Margin, MarginError> {
        if u <= 0.0 || u >= 1.0 {
            let end = if u <= 0.0 { 0 } else { self.specs.len() - 1 };
            return super::build(&self.specs[end], self.seed);
        }
        let shares = nurbs::shares(&self.weights, u);
        let spec = self.mixed(&shares);
        let entire = self.way.outline(&shares, u, &spec)?;
        let Some(teeth) = &self.teeth else { return Margin::from_outline(entire, HINT) };
        let plain = Margin::from_outline(entire, HINT)?;
        if detail::is_plain(&spec) {
            return Ok(plain);
        }
        let form = teeth::mixed_form(&self.forms, &shares);
        let rows: Vec<Vec<Tooth>> = teeth.iter().map(|rows| teeth::mixed(rows, &shares)).collect();
        let outline = detail::carve(&plain.to_outline(), &spec, &rows, &form, self.seed)?;
        Margin::from_outline(outline, HINT)
    }

    /// The settings of length and detail on the way, and of the margin where leaves are of one structure.
    fn mixed(&self, shares: &[f64]) -> MarginSpec {
        let mix = |value: fn(&MarginSpec) -> f64| -> f64 {
            self.specs.iter().zip(shares).map(|(spec, share)| value(spec) * share).sum()
        };
        let mut spec = self.specs[self.specs.len() - 1].clone();
        spec.length_mm = mix(|spec| spec.length_mm);
        spec.asymmetry = mix(|spec| spec.asymmetry);
        if self.specs.iter().any(|spec| spec.teeth.r#type != ToothType::None) {
            // Any type and depth: teeth are carved as planned.
            spec.teeth.r#type = ToothType::Serrate;
            spec.teeth.depth = 1.0;
        }
        spec.waves.height = mix(|spec| spec.waves.height);
        spec.waves.count = mix(|spec| spec.waves.count);
        spec.waves.irregularity = mix(|spec| spec.waves.irregularity);
        spec.waves.from = mix(|spec| spec.waves.from);
        spec.roughness.height_mm = mix(|spec| spec.roughness.height_mm);
        spec.roughness.grain_mm = mix(|spec| spec.roughness.grain_mm);
        match &self.way {
            Way::Numbers(leaves) => numbers::mixed(leaves, shares, &spec),
            Way::Space { .. } => spec,
        }
    }

    /// The margin at `u` as settings: the leaves' own at the ends; in between those of a parametric leaf
    /// where all leaves are and have one structure and no teeth, else a polygon with its landmarks.
    ///
    /// # Errors
    ///
    /// As [`at`](Self::at).
    pub fn spec_at(&self, u: f64) -> Result<MarginSpec, MarginError> {
        if u <= 0.0 || u >= 1.0 {
            let end = if u <= 0.0 { 0 } else { self.specs.len() - 1 };
            return Ok(self.specs[end].clone());
        }
        let spec = self.mixed(&nurbs::shares(&self.weights, u));
        let parametric =
            matches!(self.way, Way::Numbers(_)) && spec.teeth.r#type == ToothType::None;
        if parametric { Ok(spec) } else { Ok(MarginSpec::of_margin(&self.at(u)?)) }
    }
}

/// How leaves are mixed.
#[derive(Debug, Clone)]
enum Way {
    /// Number by number: they are parametric and of one structure, and do not leap on the way.
    Numbers(Vec<MarginSpec>),
    /// As margins with marks that answer each other.
    Space { space: space::Space, ease: f64 },
}

/// Places on the path at which it is tried.
const TRIED: u32 = 48;

impl Way {
    fn new(
        specs: &[MarginSpec],
        outlines: &[Outline],
        weights: &[f64],
    ) -> Result<Self, MarginError> {
        let tried = || (1..TRIED).map(|i| f64::from(i) / f64::from(TRIED));
        if let Some(leaves) = numbers::alike(specs)? {
            let unit = MarginSpec { length_mm: 1.0, ..leaves[0].clone() };
            let outline = |u: f64| {
                let shares = nurbs::shares(weights, u);
                Some(super::entire(&numbers::mixed(&leaves, &shares, &unit)).ok()?.to_outline())
            };
            let places: Vec<f64> = [0.0].into_iter().chain(tried()).chain([1.0]).collect();
            if !leaps::any(&places, outline) {
                return Ok(Self::Numbers(leaves));
            }
        }
        let space = space::Space::of(outlines);
        // What must be cut away, at the worst place: as little as can be had for the least easing.
        let lost = |ease: f64| {
            let at = |u: f64| {
                let shares = nurbs::shares(weights, u);
                loss(&space.mixed(&shares, 1.0, 1.0 - ease * bump(u)))
            };
            tried().map(at).fold(0.0, f64::max)
        };
        let mut ease = 0.0;
        let mut least = lost(ease);
        for more in EASES {
            if least <= SMALL {
                break;
            }
            let now = lost(more);
            if now < least {
                (ease, least) = (more, now);
            }
        }
        Ok(Self::Space { space, ease })
    }

    /// The outline without teeth; `spec` is the leaf on the way.
    fn outline(&self, shares: &[f64], u: f64, spec: &MarginSpec) -> Result<Outline, MarginError> {
        match self {
            Self::Numbers(_) => Ok(super::entire(spec)?.to_outline()),
            Self::Space { space, ease } => {
                let outline = space.mixed(shares, spec.length_mm, 1.0 - ease * bump(u));
                if polygon::self_crossing(&outline.points).is_none() {
                    return Ok(outline);
                }
                let at = polygon::self_crossing(&outline.points).unwrap_or_default();
                let crossing = MarginError::SelfCrossing { x: at.x, y: at.y, hint: HINT };
                repair::without_loops(outline).ok_or(crossing)
            }
        }
    }
}

/// How far margins on the way give up their own detail, from little to all, where they would cross
/// themselves otherwise.
const EASES: [f64; 4] = [0.25, 0.5, 0.75, 1.0];

/// Loops that are shorter than this, as a share of the outline, are cut off without easing.
const SMALL: f64 = 0.02;

/// The share of an outline that must be cut off to make it simple; 1 when that does not help.
fn loss(outline: &Outline) -> f64 {
    let whole = polygon::perimeter(&outline.points);
    if polygon::self_crossing(&outline.points).is_none() {
        return 0.0;
    }
    let left = repair::without_loops(outline.clone());
    left.map_or(1.0, |left| 1.0 - polygon::perimeter(&left.points) / whole)
}

/// 0 at both ends of the path, 1 on most of it.
fn bump(u: f64) -> f64 {
    let t = (4.0 * u * (1.0 - u)).clamp(0.0, 1.0);
    t * (2.0 - t)
}
