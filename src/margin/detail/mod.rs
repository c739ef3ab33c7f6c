//! Teeth, waves and roughness along a margin.
//!
//! Detail is set on the edges of a finished outline, which run from a low place (the base, a valley)
//! to a tip (the apex, a lobe's): first waves, then teeth of up to three orders, then roughness. Tips
//! and sinuses of teeth become landmarks, which the veins that end there read.
//!
//! Source: the vocabulary of Ellis et al., *Manual of Leaf Architecture*, 2009 (terms only). Garg 2011
//! leaves teeth to future work (8.3); like there, they stand on the smooth envelope of the margin.
//!
//! # Repair
//!
//! An outline never crosses itself. Where teeth or waves would touch another part of it (in narrow
//! sinuses between lobes, at deep hooked teeth) that tooth or stretch alone is drawn back towards the
//! margin without detail, in steps, until nothing touches.

mod cut;
mod node;
mod ornament;
mod place;
mod ripple;
mod run;
mod spec;
#[cfg(test)]
mod tests;

use glam::DVec2;

use super::lobes::{LobeRecord, LobeSide};
use super::{Landmark, MarginError, MarginSpec, Outline, curve};
use crate::geometry::polygon;
use crate::seed::{Seed, Stage};
use cut::Cutter;
use node::Node;
use place::{Draws, Edge};
pub use place::{Tooth, ToothForm};
use run::{Run, Span};
pub use spec::{RoughnessSpec, SmallTeethSpec, TeethSpec, ToothType, WaveSpec};

/// What can be changed about detail that cannot be repaired: drawn back to nothing, waves and roughness lie on
/// the margin, but a tooth is straight where the margin winds.
const HINT: &str = "teeth as wide as these cannot follow a margin that winds so: give more of them \
                    (margin.teeth.count, margin.teeth.per_cm), or none (margin.teeth.type = \"none\")";

/// Steps in which detail that touches something is drawn back, and by what share in each.
const STEPS: usize = 24;
const SHRINK: f64 = 0.7;

/// Small teeth are drawn back to this share before larger ones follow.
const LEAST_FINE: f64 = 0.15;

/// Whether a margin has any detail.
#[must_use]
pub fn is_plain(spec: &MarginSpec) -> bool {
    let toothless = spec.teeth.r#type == ToothType::None || spec.teeth.depth == 0.0;
    toothless && spec.waves.height == 0.0 && spec.roughness.height_mm == 0.0
}

/// The seeds of the edges and of the roughness.
struct Seeds {
    right: u32,
    left: u32,
    rough: u32,
}

impl Seeds {
    fn new(seed: Seed) -> Self {
        let mut rng = seed.stream(Stage::Margin);
        let mut next = || rng.bits() as u32;
        Self { right: next(), left: next(), rough: next() }
    }

    /// The seed of an edge, and that of its mirror on the right.
    fn edge(&self, span: &Span) -> (u32, u32) {
        let of = |side: u32| side.wrapping_add(span.number.wrapping_mul(0x9E37_79B1));
        (of(if span.right { self.right } else { self.left }), of(self.right))
    }
}

/// An anticlockwise, simple outline with the detail that `spec` asks for.
///
/// # Errors
///
/// [`MarginError::Landmark`] with the key, its value and the bound; [`MarginError::SelfCrossing`]
/// when the outline crosses itself even without detail.
pub fn set(outline: &Outline, spec: &MarginSpec, seed: Seed) -> Result<Outline, MarginError> {
    let teeth = plan(outline, spec, seed)?;
    carve(outline, spec, &teeth, &ToothForm::of(&spec.teeth), seed)
}

/// Where teeth are to stand, edge by edge in the order of the outline.
///
/// # Errors
///
/// As [`set`].
pub fn plan(
    outline: &Outline,
    spec: &MarginSpec,
    seed: Seed,
) -> Result<Vec<Vec<Tooth>>, MarginError> {
    let seeds = Seeds::new(seed);
    Edges::of(outline, spec, &seeds).teeth(spec, &seeds)
}

/// An outline with waves and roughness, and these teeth on its edges.
///
/// # Errors
///
/// [`MarginError::SelfCrossing`] when the outline crosses itself even without detail.
pub fn carve(
    outline: &Outline,
    spec: &MarginSpec,
    teeth: &[Vec<Tooth>],
    form: &ToothForm,
    seed: Seed,
) -> Result<Outline, MarginError> {
    let seeds = Seeds::new(seed);
    let mut detailed = Edges::of(outline, spec, &seeds).cut(outline, teeth, form);
    let fixed = [0, detailed.apex];
    let before = detailed.nodes.len();
    detailed.nodes = ripple::roughened(&detailed.nodes, &fixed, &spec.roughness, seeds.rough);
    if detailed.nodes.len() != before {
        let tip = outline.points[outline.apex];
        detailed.apex = nearest(&detailed.nodes, tip);
    }
    detailed.mended(outline)
}

/// The records of the lobes of a leaf, in the order of their tips on the outline.
fn lobes_in_order(spec: &MarginSpec) -> Vec<&LobeRecord> {
    let on = |side: LobeSide| spec.lobe.iter().filter(move |lobe| lobe.side.is_on(side));
    let apex = spec.lobe.iter().filter(|lobe| lobe.side == LobeSide::Apex);
    on(LobeSide::Right).chain(apex).chain(on(LobeSide::Left).rev()).collect()
}

/// The edges of an outline, in its order.
pub(super) struct Edges {
    spans: Vec<Span>,
    runs: Vec<Run>,
}

impl Edges {
    /// With the waves of `spec`.
    fn of(outline: &Outline, spec: &MarginSpec, seeds: &Seeds) -> Self {
        let spans = run::spans(outline);
        let runs: Vec<Run> = spans.iter().map(|span| span.run(outline)).collect();
        let longest = runs.iter().map(Run::length).fold(0.0, f64::max);
        let scale = outline.points[outline.apex].y;
        let waved = |(run, span): (Run, &Span)| {
            let (own, mirror) = seeds.edge(span);
            let seed = if spec.asymmetry > 0.0 { own } else { mirror };
            ripple::waves(run, &spec.waves, longest, scale, seed)
        };
        let runs = runs.into_iter().zip(&spans).map(waved).collect();
        Self { spans, runs }
    }

    fn teeth(&self, spec: &MarginSpec, seeds: &Seeds) -> Result<Vec<Vec<Tooth>>, MarginError> {
        if spec.teeth.r#type == ToothType::None {
            return Ok(vec![Vec::new(); self.runs.len()]);
        }
        let lobes = lobes_in_order(spec);
        let edges: Vec<Edge> = self
            .runs
            .iter()
            .zip(&self.spans)
            .map(|(run, span)| {
                let (own, mirror) = seeds.edge(span);
                let draws = Draws { own, mirror, asymmetry: spec.asymmetry };
                let lobe = span.lobe.and_then(|lobe| lobes.get(lobe));
                let (count, depth) =
                    lobe.map_or((1.0, 1.0), |lobe| (lobe.teeth_count, lobe.teeth_depth));
                Edge { length: run.length(), draws, count, depth }
            })
            .collect();
        place::teeth(&spec.teeth, &edges)
    }

    /// The outline with teeth cut into every edge.
    fn cut(&self, outline: &Outline, teeth: &[Vec<Tooth>], form: &ToothForm) -> Detailed {
        let tolerance = curve::TOLERANCE * outline.points[outline.apex].y;
        let mut cutter = Cutter { form, tolerance, parts: 0 };
        let mut nodes: Vec<Node> = Vec::with_capacity(outline.points.len());
        let mut apex = 0;
        for ((run, span), teeth) in self.runs.iter().zip(&self.spans).zip(teeth) {
            let mut edge = cutter.edge(run, teeth);
            if span.descends {
                edge.reverse();
            }
            if span.from == outline.apex {
                apex = nodes.len();
            }
            let mark = outline.landmarks.iter().find(|mark| mark.vertex == span.from);
            edge[0].mark = mark.map(|mark| mark.kind);
            // The next edge begins where this one ends.
            edge.pop();
            nodes.extend(edge);
        }
        Detailed { nodes, apex, parts: cutter.parts + 2 }
    }
}

/// An outline with detail, which may cross itself yet.
struct Detailed {
    nodes: Vec<Node>,
    apex: usize,
    parts: usize,
}

impl Detailed {
    /// The outline, parts that touch something drawn back: their smallest teeth first.
    fn mended(mut self, plain: &Outline) -> Result<Outline, MarginError> {
        let mut fine = vec![1.0; self.parts + 1];
        let mut whole = fine.clone();
        let mut points = self.points(&fine, &whole);
        for step in 0..=STEPS {
            let crossings = self.crossings(&points);
            if crossings.is_empty() {
                break;
            }
            if step == STEPS {
                let at = points[crossings[0].0];
                return Err(MarginError::SelfCrossing { x: at.x, y: at.y, hint: HINT });
            }
            let mut touching: Vec<usize> = Vec::new();
            for (i, j) in crossings {
                for k in [i, i + 1, j, j + 1] {
                    let part = self.nodes[k % self.nodes.len()].part;
                    touching.extend([part.floor() as usize, part.ceil() as usize]);
                }
            }
            touching.sort_unstable();
            touching.dedup();
            // The last steps take all of it, and of the neighbours too.
            let reach = (step + 4).saturating_sub(STEPS);
            for part in touching {
                for k in part.saturating_sub(reach)..=(part + reach).min(self.parts) {
                    match step {
                        _ if reach > 0 => whole[k] = 0.0,
                        _ if fine[k] > LEAST_FINE => fine[k] *= SHRINK,
                        _ => whole[k] *= SHRINK,
                    }
                }
            }
            if step + 1 == STEPS {
                // Nothing helped: the outline as it was.
                whole.fill(0.0);
            }
            points = self.points(&fine, &whole);
        }
        // Landmarks inside an edge (where a drip tip begins) go to the nearest vertex.
        for mark in &plain.landmarks {
            let at = plain.points[mark.vertex];
            let near = nearest(&self.nodes, at);
            if self.nodes[near].mark.is_none() {
                self.nodes[near].mark = Some(mark.kind);
            }
        }
        let marks = self.nodes.iter().enumerate();
        let landmarks = marks
            .filter_map(|(vertex, node)| Some(Landmark { vertex, kind: node.mark? }))
            .filter(|mark| mark.vertex != 0)
            .collect();
        Ok(Outline { points, apex: self.apex, cuts: plain.cuts.clone(), landmarks })
    }

    /// The pairs of vertices whose edges (to the next vertex) touch, once vertices that a margin does
    /// not tell apart are merged.
    fn crossings(&self, points: &[DVec2]) -> Vec<(usize, usize)> {
        let marks = self.nodes.iter().enumerate();
        let landmarks = marks
            .filter_map(|(vertex, node)| Some(Landmark { vertex, kind: node.mark? }))
            .collect();
        let outline =
            Outline { points: points.to_vec(), apex: self.apex, cuts: Vec::new(), landmarks };
        let spaced = outline.spaced().points;
        // Those that stay are in the order they had.
        let mut next = 0;
        let kept: Vec<usize> = spaced
            .iter()
            .map(|p| {
                while next + 1 < points.len() && points[next] != *p {
                    next += 1;
                }
                next
            })
            .collect();
        polygon::crossings(&spaced).into_iter().map(|(i, j)| (kept[i], kept[j])).collect()
    }

    fn points(&self, fine: &[f64], whole: &[f64]) -> Vec<DVec2> {
        let share = |shares: &[f64], part: f64| {
            let (i, t) = (part.floor() as usize, part.fract());
            shares[i] + (shares[(i + 1).min(shares.len() - 1)] - shares[i]) * t
        };
        let mut points: Vec<DVec2> = self
            .nodes
            .iter()
            .map(|node| node.shrunk(share(fine, node.part), share(whole, node.part)))
            .collect();
        // Base and apex stay, whatever is done around them.
        for i in [0, self.apex] {
            points[i] = self.nodes[i].foot;
        }
        points
    }
}

fn nearest(nodes: &[Node], p: DVec2) -> usize {
    let distance = |i: &usize| nodes[*i].at.distance_squared(p);
    (0..nodes.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
}
