//! Where teeth stand: one record a tooth, before anything is cut.

use super::super::{Margin, MarginError};
use super::spec::{SmallTeethSpec, TeethSpec, ToothType};
use crate::geometry::noise;

/// One tooth on an edge of the blade, or on a flank of a larger tooth.
#[derive(Debug, Clone, PartialEq)]
pub struct Tooth {
    /// Where it begins, as a share of the edge or flank.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// How high it stands over its sinuses, in its own widths.
    pub depth: f64,
    /// Smaller teeth on the flank towards the base, and on the one towards the tip.
    pub flanks: [Vec<Self>; 2],
}

/// What all teeth of a leaf have in common: the effective numbers behind a [`ToothType`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ToothForm {
    /// How far the tip stands from the middle of the tooth towards the tip of the leaf (widths).
    pub lean: f64,
    /// 0 pointed, 1 rounded.
    pub tip_rounding: f64,
    /// 0 angular, 1 rounded.
    pub sinus_rounding: f64,
    /// 1 convex, −1 concave; of the flank towards the base and of the other.
    pub bow: [f64; 2],
    /// 1 flexuous, −1 retroflexed.
    pub flexure: [f64; 2],
    /// Length of the bristle (mm).
    pub bristle_mm: f64,
    /// Diameter of the gland (mm).
    pub gland_mm: f64,
}

impl ToothForm {
    /// The form that a type and its knobs make.
    #[must_use]
    pub fn of(spec: &TeethSpec) -> Self {
        let dentate = spec.r#type == ToothType::Dentate;
        let crenate = spec.r#type == ToothType::Crenate;
        Self {
            lean: if dentate { 0.0 } else { spec.lean },
            tip_rounding: if crenate { 1.0 } else { spec.tip_rounding },
            sinus_rounding: spec.sinus_rounding,
            bow: [spec.proximal_bow, spec.distal_bow],
            flexure: [spec.proximal_flexure, spec.distal_flexure],
            bristle_mm: spec.bristle_mm,
            gland_mm: spec.gland_mm,
        }
    }

    /// How the length of a tooth's two flanks is shared out: the part of the one towards the base.
    fn proximal_share(&self, depth: f64) -> f64 {
        let (up, down) = ((0.5 + self.lean).hypot(depth), (0.5 - self.lean).hypot(depth));
        up / (up + down)
    }
}

/// Random numbers of one edge by the number of the tooth, so that a tooth more leaves the others as
/// they were. The left side mixes its own with the right side's.
#[derive(Debug, Clone, Copy)]
pub(super) struct Draws {
    pub(super) own: u32,
    pub(super) mirror: u32,
    /// How far its own count: 1 fully.
    pub(super) asymmetry: f64,
}

impl Draws {
    /// A number from −1 to 1.
    fn signed(&self, tooth: usize, what: i32) -> f64 {
        let draw =
            |seed| 2.0 * f64::from(noise::unit(noise::lattice(tooth as i32, what, seed))) - 1.0;
        draw(self.mirror) + (draw(self.own) - draw(self.mirror)) * self.asymmetry
    }
}

/// An edge that teeth are to stand on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    /// Its length (mm).
    pub(super) length: f64,
    pub(super) draws: Draws,
    /// Times the number of teeth, and times their depth: what its lobe says.
    pub(super) count: f64,
    pub(super) depth: f64,
}

/// Teeth narrower than this many of the least edges of a margin would be lost in it.
const LEAST_EDGES: f64 = 20.0;

/// An edge at least this long, as a share of the longest, has as many teeth as that one: the two
/// sides of an oblique blade are alike.
const ALIKE: f64 = 0.75;

/// Depth varies by this share of the irregularity of widths.
const DEPTH_IRREGULARITY: f64 = 0.6;

/// The teeth of every edge, given its length (mm).
pub(super) fn teeth(spec: &TeethSpec, edges: &[Edge]) -> Result<Vec<Vec<Tooth>>, MarginError> {
    let wrong = |key: &str, value: f64, problem: String| MarginError::Landmark {
        key: format!("margin.teeth.{key}"),
        value,
        problem,
    };
    if spec.from >= spec.to {
        let problem = format!("is not below margin.teeth.to = {}", spec.to);
        return Err(wrong("from", spec.from, problem));
    }
    let longest = edges.iter().map(|edge| edge.length).fold(0.0, f64::max);
    let small = [&spec.second, &spec.third];
    let finest: f64 = small.iter().map(|small| small.count as f64 + 1.0).product();
    edges
        .iter()
        .map(|edge| {
            let length = edge.length;
            let zone = (spec.to - spec.from) * length;
            let count = match spec.count {
                0 => (spec.per_cm * zone / 10.0).round().max(1.0),
                count if length >= ALIKE * longest => count as f64,
                count => (count as f64 * length / longest).round(),
            };
            let count = if edge.count == 1.0 { count } else { (count * edge.count).round() };
            let least = LEAST_EDGES * Margin::MIN_EDGE_MM * finest;
            let most = (zone / least).floor();
            if count > most {
                let (key, value, bound) = match spec.count {
                    0 => ("per_cm", spec.per_cm, spec.per_cm * most / count),
                    given => ("count", given as f64, given as f64 * most / count),
                };
                let problem = format!(
                    "makes teeth finer than {:.2} mm on an edge of {zone:.1} mm; at most {bound:.1} \
                     there",
                    least / finest
                );
                return Err(wrong(key, value, problem));
            }
            Ok(row(spec, count as usize, edge))
        })
        .collect()
}

/// The teeth of one edge.
fn row(spec: &TeethSpec, count: usize, edge: &Edge) -> Vec<Tooth> {
    let form = ToothForm::of(spec);
    let draws = edge.draws;
    let width = |k: usize| {
        let place = (k as f64 + 0.5) / count as f64;
        (1.0 - spec.spacing_change * place) * (1.0 + spec.irregularity * draws.signed(k, 0))
    };
    let widths: Vec<f64> = (0..count).map(width).collect();
    let total: f64 = widths.iter().sum();
    let mut at = 0.0;
    let mut teeth = Vec::with_capacity(count);
    for (k, width) in widths.iter().enumerate() {
        let (from, to) = (at / total, (at + width) / total);
        at += width;
        let way = (spec.to - spec.from) * (0.5 * (from + to)).min(1.0 - 0.5 * (from + to));
        let fade = if spec.end_fade > 0.0 { smoothstep(way / spec.end_fade) } else { 1.0 };
        let varied = 1.0 + DEPTH_IRREGULARITY * spec.irregularity * draws.signed(k, 1);
        let depth = spec.depth * edge.depth * varied * fade;
        let share = |t: f64| spec.from + (spec.to - spec.from) * t;
        let small = [(&spec.second, 2), (&spec.third, 3)];
        teeth.push(Tooth {
            from: share(from),
            to: share(to),
            depth,
            flanks: smaller(&form, depth, fade, &small, draws, k),
        });
    }
    teeth
}

/// Between a sinus and the first smaller tooth on a flank (spacings of these).
const SINUS_ROOM: f64 = 0.5;

/// The teeth on the flanks of a tooth of a depth.
fn smaller(
    form: &ToothForm,
    depth: f64,
    fade: f64,
    orders: &[(&SmallTeethSpec, i32)],
    draws: Draws,
    tooth: usize,
) -> [Vec<Tooth>; 2] {
    let Some(&(spec, order)) = orders.first() else { return Default::default() };
    let lower = (spec.count as f64 * form.proximal_share(depth)).round() as usize;
    let upper = spec.count as usize - lower.min(spec.count as usize);
    let upper = (upper as f64 * spec.distal_share).round() as usize;
    [(lower, false), (upper, true)].map(|(count, above)| {
        // The tip of the larger tooth stands in the place of one more; the sinus keeps some room.
        let spacing = 1.0 / (count as f64 + 1.0 + SINUS_ROOM);
        let first = if above { spacing } else { SINUS_ROOM * spacing };
        (0..count)
            .map(|k| {
                let from = first + k as f64 * spacing;
                let number = tooth * 16 + k;
                let depth = spec.depth
                    * fade
                    * (1.0 + 0.15 * draws.signed(number, 2 * order + i32::from(above)));
                let flanks = smaller(form, depth, fade, &orders[1..], draws, number);
                Tooth { from, to: from + spacing, depth, flanks }
            })
            .collect()
    })
}

fn smoothstep(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
