//! Rows of secondary veins: where along its parent each leaves, at what angle, and into which tooth.

use glam::DVec2;

use super::curve;
use super::intersecondary;
use super::lobes;
use super::matching::teeth_for;
use super::planter::{Planter, Vein};
use super::primary::{Lateral, Primaries};
use super::rim::Rim;
use super::secondary::{Laid, Plan};
use super::targets::{self, Tip};
use super::tertiary::{self, Bearer};
use super::{GuideSpec, PrimaryType, RimType, SecondaryType};
use crate::seed::Rng;

/// A secondary of full irregularity leaves at up to so many degrees more or less.
const ANGLE_SPREAD: f64 = 16.0;

/// Lays the secondaries of all primaries, and the vein along the margin.
pub(super) fn lay(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    primaries: &Primaries,
    rng: &mut Rng,
) {
    let Some(midrib) = &primaries.midrib else { return };
    let mut rim = Rim::new(spec, planter);
    let mut bearers = Vec::new();
    if spec.secondary != SecondaryType::None {
        let ground = planter.ground;
        let first = spec.first_at.max(primaries.secondaries_from).min(spec.last_at - 1e-3);
        let lobed = match spec.primary {
            PrimaryType::Pinnate => targets::known_lobes(ground.margin()),
            _ => Vec::new(),
        };
        let on = |side: f64| lobed.iter().filter(|tip| tip.side == side).count();
        let count = (spec.secondary_count as usize).max(on(1.0)).max(on(-1.0));
        let between = (spec.last_at - first) / count.max(1) as f64 * midrib.length();
        let reaches_margin = !matches!(
            spec.secondary,
            SecondaryType::Eucamptodromous
                | SecondaryType::Brochidodromous
                | SecondaryType::FestoonedBrochidodromous
                | SecondaryType::Reticulodromous
        ) && spec.rim != RimType::Intramarginal;
        let teeth = if reaches_margin && spec.tooth_reach > 0.0 {
            targets::teeth(ground.margin(), between)
        } else {
            Vec::new()
        };
        let mut row = Row { spec, teeth, taken: Vec::new(), bearers: Vec::new(), rim: &mut rim };
        row.both_sides(planter, midrib, count, (first, spec.last_at), &lobed, rng);
        let palmate =
            matches!(spec.primary, PrimaryType::Actinodromous | PrimaryType::Palinactinodromous);
        if palmate {
            for lateral in &primaries.laterals {
                row.lateral(planter, lateral, between, rng);
                let vein = lateral.vein.clone();
                row.bearers.push(Bearer { vein, ahead: midrib.at(0.5).2 });
            }
        }
        bearers = row.bearers;
    }
    rim.lay(planter, primaries);
    if spec.primary == PrimaryType::Parallelodromous {
        bearers.extend(beside(midrib, primaries));
    }
    tertiary::lay(spec, planter, &bearers, rng);
}

/// Parallel veins bear cross-veins, each to its neighbour on the outer side.
fn beside(midrib: &Vein, primaries: &Primaries) -> Vec<Bearer> {
    let ahead = midrib.at(0.5).2;
    let bearer = |vein: &Vein, side: f64| Bearer {
        vein: vein.clone(),
        ahead: curve::turned(ahead, 90.0, side),
    };
    let inner = [1.0, -1.0].map(|side| bearer(midrib, side));
    let others = primaries.laterals.iter().map(|lateral| bearer(&lateral.vein, lateral.side));
    inner.into_iter().chain(others).collect()
}

/// Secondaries along one primary after the other.
pub(super) struct Row<'a> {
    pub(super) spec: &'a GuideSpec,
    pub(super) teeth: Vec<Tip>,
    /// Teeth that have a vein.
    pub(super) taken: Vec<DVec2>,
    /// What tertiaries leave from.
    pub(super) bearers: Vec<Bearer>,
    pub(super) rim: &'a mut Rim,
}

impl Row<'_> {
    /// Where `count` secondaries leave between two shares of a vein, with the spacing at each.
    fn places(&self, count: usize, (first, last): (f64, f64)) -> Vec<(f64, f64)> {
        let weight =
            |k: usize| 1.0 - self.spec.spacing_change * (k as f64 + 0.5) / count.max(2) as f64;
        let total: f64 = (0..count.saturating_sub(1)).map(weight).sum();
        let mut at = first;
        (0..count)
            .map(|k| {
                let spacing =
                    if total > 0.0 { weight(k) / total * (last - first) } else { last - first };
                let place = (at, spacing);
                at += spacing;
                place
            })
            .collect()
    }

    fn both_sides(
        &mut self,
        planter: &mut Planter<'_>,
        midrib: &Vein,
        count: usize,
        range: (f64, f64),
        lobed: &[Tip],
        rng: &mut Rng,
    ) {
        let spec = self.spec;
        let leads = if rng.unit() < 0.5 { 1.0 } else { -1.0 };
        let places = self.places(count, range);
        let mut plans: Vec<[Plan; 2]> = Vec::new();
        for &(place, spacing) in &places {
            let shared = draws(rng);
            plans.push([1.0, -1.0].map(|side| {
                let own = draws(rng);
                let mixed: [f64; 4] = std::array::from_fn(|i| {
                    spec.irregularity * (shared[i] + (own[i] - shared[i]) * spec.asymmetry)
                });
                let t = (place - range.0) / (range.1 - range.0);
                let stagger = 0.25 * spec.alternation * side * leads;
                Plan {
                    share: place + spacing * (stagger + 0.35 * mixed[0]),
                    side,
                    angle_deg: spec.secondary_angle_deg
                        + spec.angle_change_deg * t
                        + ANGLE_SPREAD * 0.5 * mixed[1],
                    curvature: spec.curvature + 0.25 * mixed[2],
                    spacing: spacing * midrib.length(),
                    sway: mixed[3],
                    lobe: None,
                }
            }));
        }
        let tips = [0, 1].map(|s| {
            let mut side: Vec<Plan> = plans.iter().map(|pair| pair[s]).collect();
            lobes::assign(&mut side, [1.0, -1.0][s], lobed, midrib);
            plans.iter_mut().zip(&side).for_each(|(pair, plan)| pair[s] = *plan);
            teeth_for(spec, planter, midrib, &side, &self.free_teeth())
        });
        // The veins of lobes first: nothing may stand in their way.
        let mut of_lobes: Vec<[Option<Laid>; 2]> = plans
            .iter()
            .map(|pair| {
                pair.map(|plan| {
                    plan.lobe.and_then(|_| self.secondary(planter, midrib, &plan, None, None))
                })
            })
            .collect();
        // From the apex down, so that arches find the one above.
        let mut above: [Option<Laid>; 2] = [None, None];
        for (k, pair) in plans.iter().enumerate().rev() {
            for (s, plan) in pair.iter().enumerate() {
                if plan.lobe.is_some() {
                    above[s] = of_lobes[k][s].take().or(above[s].take());
                    continue;
                }
                if self.is_between_teeth(&tips[s], k) {
                    continue;
                }
                let laid = self.secondary(planter, midrib, plan, above[s].as_ref(), tips[s][k]);
                if laid.is_some() {
                    above[s] = laid;
                }
            }
        }
        for pairs in plans.windows(2) {
            for (lower, upper) in pairs[0].iter().zip(&pairs[1]) {
                intersecondary::lay(self.spec, planter, midrib, lower, upper, rng);
            }
        }
    }

    /// The outer side of a primary beside the midrib, and the inner one within a lobe.
    fn lateral(
        &mut self,
        planter: &mut Planter<'_>,
        lateral: &Lateral,
        between: f64,
        rng: &mut Rng,
    ) {
        let spec = self.spec;
        let count = spec.lateral_count as usize;
        let mut sides = vec![(lateral.side, (0.16, 0.86))];
        if lateral.lobed {
            sides.push((-lateral.side, (0.45, 0.9)));
        }
        for (side, range) in sides {
            let mut plan = |(place, spacing): (f64, f64)| {
                let own = draws(rng).map(|draw| draw * spec.irregularity);
                Plan {
                    share: place + 0.3 * spacing * own[0],
                    side,
                    angle_deg: spec.secondary_angle_deg + 0.5 * ANGLE_SPREAD * own[1],
                    curvature: spec.curvature + 0.25 * own[2],
                    spacing: (spacing * lateral.vein.length()).min(between),
                    sway: own[3],
                    lobe: None,
                }
            };
            let plans: Vec<Plan> = self.places(count, range).into_iter().map(&mut plan).collect();
            let tips = teeth_for(spec, planter, &lateral.vein, &plans, &self.free_teeth());
            let mut above = None;
            for (plan, tip) in plans.iter().zip(tips).rev() {
                let laid = self.secondary(planter, &lateral.vein, plan, above.as_ref(), tip);
                if laid.is_some() {
                    above = laid;
                }
            }
        }
    }

    /// The teeth that have no vein yet.
    fn free_teeth(&self) -> Vec<Tip> {
        self.teeth.iter().filter(|tip| !self.taken.contains(&tip.at)).copied().collect()
    }

    /// Whether a secondary has no tooth, and those before and after it have neighbouring ones: in a
    /// margin of large teeth each vein has its own.
    fn is_between_teeth(&self, tips: &[Option<Tip>], k: usize) -> bool {
        let before = tips[..k].iter().rev().find_map(|tip| *tip);
        let after = tips[k..].iter().find_map(|tip| *tip);
        let (Some(before), Some(after)) = (before, after) else { return false };
        let between = |tip: &Tip| {
            tip.side == before.side && tip.along > before.along && tip.along < after.along
        };
        tips[k].is_none()
            && self.spec.secondary == SecondaryType::Craspedodromous
            && !self.teeth.iter().any(between)
    }
}

/// Four numbers from −1 to 1.
fn draws(rng: &mut Rng) -> [f64; 4] {
    std::array::from_fn(|_| rng.between(-1.0, 1.0))
}
