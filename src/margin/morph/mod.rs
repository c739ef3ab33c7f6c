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

mod space;
mod teeth;
#[cfg(test)]
mod tests;

use glam::DVec2;

use super::detail::{self, Tooth, ToothForm, ToothType};
use super::{Landmark, LandmarkKind, Margin, MarginError, MarginKind, MarginSpec, Outline};
use crate::geometry::nurbs;
use crate::seed::Seed;

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
    shapes: Vec<space::Shape>,
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
        let weights = kept.iter().map(weight).collect();
        let specs: Vec<MarginSpec> = kept.iter().map(|&i| leaves[i].margin.clone()).collect();
        let entire: Vec<Outline> = specs
            .iter()
            .map(|spec| Ok(super::entire(spec)?.to_outline()))
            .collect::<Result<_, MarginError>>()?;
        let edges = |outline: &Outline| {
            let turns = outline.landmarks.iter().filter(|mark| {
                matches!(mark.kind, LandmarkKind::LobeTip { .. } | LandmarkKind::Valley)
            });
            turns
                .map(|mark| (mark.vertex > outline.apex, mark.kind == LandmarkKind::Valley))
                .collect()
        };
        let first: Vec<(bool, bool)> = edges(&entire[0]);
        let alike = entire.iter().all(|outline| edges(outline) == first);
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
        let sides: Vec<_> = specs
            .iter()
            .map(|spec| (spec.kind == MarginKind::Unilobed).then(|| spec.sides()))
            .collect();
        let shapes = space::unified(&outlines, &sides);
        let forms = teeth::forms(&specs);
        Ok(Self { kept, given: leaves.len(), weights, specs, shapes, teeth, forms, seed })
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
        let leaves = || self.specs.iter().zip(&shares);
        let length = leaves().map(|(spec, share)| spec.length_mm * share).sum();
        let entire = space::mixed(&self.shapes, &shares, length);
        let Some(teeth) = &self.teeth else { return Margin::from_outline(entire, HINT) };
        let spec = self.detail_at(&shares, length);
        let plain = Margin::from_outline(entire, HINT)?;
        if detail::is_plain(&spec) {
            return Ok(plain);
        }
        let form = teeth::mixed_form(&self.forms, &shares);
        let rows: Vec<Vec<Tooth>> = teeth.iter().map(|rows| teeth::mixed(rows, &shares)).collect();
        let outline = detail::carve(&plain.to_outline(), &spec, &rows, &form, self.seed)?;
        Margin::from_outline(outline, HINT)
    }

    /// The settings of detail on the way.
    fn detail_at(&self, shares: &[f64], length: f64) -> MarginSpec {
        let mix = |value: fn(&MarginSpec) -> f64| -> f64 {
            self.specs.iter().zip(shares).map(|(spec, share)| value(spec) * share).sum()
        };
        let mut spec = self.specs[self.specs.len() - 1].clone();
        spec.length_mm = length;
        spec.asymmetry = mix(|spec| spec.asymmetry);
        if self.specs.iter().any(|spec| spec.teeth.r#type != ToothType::None) {
            // Any type and depth: teeth are carved as planned.
            spec.teeth.r#type = ToothType::Serrate;
            spec.teeth.depth = 1.0;
        }
        spec.waves.height = mix(|spec| spec.waves.height);
        spec.waves.count = mix(|spec| spec.waves.count);
        spec.waves.irregularity = mix(|spec| spec.waves.irregularity);
        spec.roughness.height_mm = mix(|spec| spec.roughness.height_mm);
        spec.roughness.grain_mm = mix(|spec| spec.roughness.grain_mm);
        spec
    }

    /// The margin at `u` as settings: at the ends the leaves' own, in between a polygon with its
    /// landmarks.
    ///
    /// # Errors
    ///
    /// As [`at`](Self::at).
    pub fn spec_at(&self, u: f64) -> Result<MarginSpec, MarginError> {
        if u <= 0.0 || u >= 1.0 {
            let end = if u <= 0.0 { 0 } else { self.specs.len() - 1 };
            return Ok(self.specs[end].clone());
        }
        Ok(MarginSpec::of_margin(&self.at(u)?))
    }
}

impl MarginSpec {
    /// A margin as a polygon with the landmarks that veins read.
    #[must_use]
    pub fn of_margin(margin: &Margin) -> Self {
        let point = |p: DVec2| [p.x, p.y];
        let mut tips: Vec<Vec<[f64; 2]>> = Vec::new();
        let mut lobes = Vec::new();
        for &Landmark { vertex, kind } in margin.landmarks() {
            let at = margin.outline()[vertex];
            match kind {
                LandmarkKind::Tooth { order } => {
                    let order = usize::from(order.max(1));
                    tips.resize(tips.len().max(order), Vec::new());
                    tips[order - 1].push(point(at));
                }
                LandmarkKind::LobeTip { origin } => lobes.push(vec![point(origin), point(at)]),
                _ => {}
            }
        }
        Self {
            kind: MarginKind::Polygon,
            length_mm: margin.length_mm(),
            polygon_mm: margin.outline().iter().copied().map(point).collect(),
            cuts_mm: margin.cuts().iter().map(|l| l.iter().copied().map(point).collect()).collect(),
            tooth_tips_mm: tips,
            lobe_veins_mm: lobes,
            ..Self::default()
        }
    }
}
