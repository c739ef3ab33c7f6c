//! How secondaries end inside the blade: arches to the next one, branches, forks.

use glam::DVec2;

use super::curve::{self, turned};
use super::planter::{Planter, Vein};
use super::secondary::{Laid, Plan};
use super::{EXTERIOR, SECONDARY};

/// An arch meets the next secondary at this share of that one.
const ARCH_AT: f64 = 0.8;

/// An arch from the end of a secondary to the one above, with which it closes a loop.
pub(super) fn arch_to(
    planter: &mut Planter<'_>,
    vein: &Vein,
    above: &Laid,
    plan: &Plan,
) -> Option<Vein> {
    let (node, from, heading) = vein.end();
    let (_, to, outward) = above.vein.at(ARCH_AT + 0.06 * plan.sway);
    let chord = from.distance(to);
    if chord > 3.5 * plan.spacing {
        return None;
    }
    let bulge = (from - to).normalize_or_zero();
    let arrive = (bulge * 0.55 + outward * 0.85).normalize_or(bulge);
    for reach in [0.5, 0.3, 0.1] {
        let bow = [from, from + heading * (reach * chord), to + arrive * (reach * chord), to];
        if let Some(arch) = planter.lay(node, &curve::cubic(bow, 40), SECONDARY, 0.6) {
            planter.join_hit(&arch);
            return Some(arch);
        }
    }
    None
}

/// A branch from the end of a secondary straight on to the margin.
pub(super) fn branch_to(planter: &mut Planter<'_>, vein: &Vein, tip: DVec2) {
    let (node, from, heading) = vein.end();
    let chord = from.distance(tip);
    let bow = [from, from + heading * (0.35 * chord), from.lerp(tip, 0.7), tip];
    planter.lay(node, &curve::cubic(bow, 24), EXTERIOR, 0.5);
}

/// An arch outside the arches of two neighbours.
pub(super) fn festoon(planter: &mut Planter<'_>, arch: &Vein, upper: &Vein, plan: &Plan) {
    let (node, from, ahead) = arch.at(0.3);
    let (_, to, above) = upper.at(0.25);
    let chord = from.distance(to);
    let out = [ahead, above].map(|v| turned(v, 62.0, plan.side));
    for reach in [0.5, 0.3] {
        let bow = [from, from + out[0] * (reach * chord), to + out[1] * (0.6 * reach * chord), to];
        if let Some(vein) = planter.lay(node, &curve::cubic(bow, 32), EXTERIOR, 0.5) {
            planter.join_hit(&vein);
            return;
        }
    }
}

/// Branches of branches towards the margin, `generations` times.
pub(super) fn fork(
    planter: &mut Planter<'_>,
    vein: &Vein,
    plan: &Plan,
    generations: usize,
    angle_deg: f64,
    reach: f64,
) {
    let mut tips = vec![vein.end()];
    for generation in 0..generations {
        let mut next = Vec::new();
        for (node, from, heading) in tips {
            for side in [plan.side, -plan.side] {
                let sway = 1.0 + 0.3 * plan.sway * side;
                let towards = turned(heading, 0.5 * angle_deg * sway, side);
                let room = planter.ground.cast(from, towards);
                let left = (generations - generation) as f64;
                let long = (reach * room / left * 1.2).min(reach * room);
                let bend = from + heading * (0.3 * long);
                let to = from + towards * long;
                let bow = [from, bend, from.lerp(to, 0.75), to];
                if let Some(branch) = planter.lay(node, &curve::cubic(bow, 20), EXTERIOR, 0.4) {
                    next.push(branch.end());
                }
            }
        }
        tips = next;
    }
}
