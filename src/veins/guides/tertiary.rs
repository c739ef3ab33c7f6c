//! Tertiary veins between the secondaries: ladders, nets or branches.
//!
//! Percurrent tertiaries run from one secondary to the next like rungs, in one piece (opposite) or with
//! a step where two meet half-way (alternate); reticulate ones bend and lean at random and so meet each
//! other; ramified ones fork towards the next secondary and end free. Terms after Ellis et al., *Manual of
//! Leaf Architecture*, 2009.

use glam::DVec2;

use super::curve::{self, turned};
use super::planter::{Planter, Vein};
use super::{GuideSpec, TERTIARY, TertiaryType};
use crate::seed::Rng;

/// A tertiary that finds no vein within so many of its spacings runs to the margin: none is laid.
const LONGEST: f64 = 14.0;

/// A rung leans by so many degrees at full irregularity.
const LEAN: f64 = 30.0;

/// The height of its bow towards the margin, in its lengths.
const BOW: f64 = 0.06;

/// The share of a secondary, from its parent on, that bears no tertiaries: those of the parent are there.
const FIRST: f64 = 0.04;

/// A vein from which tertiaries may leave.
pub(super) struct Bearer {
    pub(super) vein: Vein,
    /// Where its parent runs to: tertiaries leave on this side.
    pub(super) ahead: DVec2,
}

/// Lays the tertiaries of all secondaries, the lowest of a side first.
pub(super) fn lay(spec: &GuideSpec, planter: &mut Planter<'_>, bearers: &[Bearer], rng: &mut Rng) {
    if spec.tertiary == TertiaryType::None {
        return;
    }
    let spacing = spec.tertiary_spacing * planter.ground.length();
    for bearer in bearers {
        let length = bearer.vein.length();
        let count = (length * (1.0 - FIRST) / spacing).floor() as usize;
        for k in 0..count {
            let sway = [rng.between(-1.0, 1.0), rng.between(-1.0, 1.0), rng.between(-1.0, 1.0)];
            let along = (k as f64 + 0.5 + 0.7 * spec.irregularity * sway[0]) * spacing;
            let share = FIRST + along / length;
            if share < 1.0 {
                rung(spec, planter, bearer, share, spacing, sway);
            }
        }
    }
}

/// One tertiary from a place of a secondary to the next vein on the side of the apex.
fn rung(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    bearer: &Bearer,
    share: f64,
    spacing: f64,
    sway: [f64; 3],
) {
    let (node, from, heading) = bearer.vein.at(share);
    let across =
        if heading.perp().dot(bearer.ahead) > 0.0 { heading.perp() } else { -heading.perp() };
    let loose = if spec.tertiary == TertiaryType::Reticulate { 2.0 } else { 1.0 };
    let towards = turned(across, LEAN * spec.irregularity * loose * sway[1], 1.0);
    let Some(reached) = planter.probe(node, towards, LONGEST * spacing) else { return };
    let chord = reached - from;
    let out = heading * (chord.length() * (BOW + 0.15 * spec.irregularity * loose * sway[2]));
    match spec.tertiary {
        TertiaryType::PercurrentAlternate => {
            // The second half sets out from the other side, half a rung further.
            let half = from + chord * (0.5 + 0.1 * sway[2]);
            let bow = [from, from.lerp(half, 0.4) + out, from.lerp(half, 0.8) + out, half + out];
            let line = curve::cubic(bow, 16);
            let Some(vein) = planter.lay(node, &line, TERTIARY, 0.7) else { return };
            let (end, at, _) = vein.end();
            let side = if sway[0] > 0.0 { 1.0 } else { -1.0 };
            let on = turned(chord, 40.0, side);
            let Some(reached) = planter.probe(end, on.normalize_or_zero(), chord.length()) else {
                return;
            };
            let line = [at, at.lerp(reached, 0.5), reached];
            if let Some(vein) = planter.lay(end, &line, TERTIARY, 0.5) {
                planter.join_hit(&vein);
            }
        }
        TertiaryType::Ramified => {
            let half = from + chord * 0.45;
            let Some(stem) = planter.lay(node, &[from, half], TERTIARY, 0.6) else { return };
            let (end, at, _) = stem.end();
            for side in [1.0, -1.0] {
                let tip = at + turned(chord, 35.0 + 15.0 * sway[1], side) * 0.4;
                planter.lay(end, &[at, at.lerp(tip, 0.5), tip], TERTIARY, 0.4);
            }
        }
        _ => {
            let bow = [from, from + chord * 0.3 + out, from + chord * 0.7 + out, reached];
            if let Some(vein) = planter.lay(node, &curve::cubic(bow, 24), TERTIARY, 0.7) {
                planter.join_hit(&vein);
            }
        }
    }
}
