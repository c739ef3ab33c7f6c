//! Tertiary veins between the secondaries: ladders, nets or branches.
//!
//! Percurrent tertiaries run from one secondary to the next like rungs, in one piece (opposite) or with
//! a step where two meet half-way (alternate); reticulate ones bend and lean at random and so meet each
//! other; ramified ones lean out to the margin, fork and fork again, and end free. Terms after Ellis et al., *Manual of
//! Leaf Architecture*, 2009.

use glam::DVec2;

use super::curve::{self, turned};
use super::planter::{Planter, Vein};
use super::{GuideSpec, TERTIARY, TertiaryType};
use crate::seed::Rng;
use crate::veins::graph::NodeId;

/// A tertiary that finds no vein within so many of its spacings runs to the margin: none is laid.
const LONGEST: f64 = 14.0;

/// A rung leans by so many degrees at full irregularity.
const LEAN: f64 = 30.0;

/// The height of its bow towards the margin, in its lengths.
const BOW: f64 = 0.06;

/// A ramified tertiary leans out along its secondary by the angle of this tangent.
const OUTWARD: f64 = 0.5;

/// Its stem, as a share of the way to the next vein; with its branches it comes most of that way.
const STEM: f64 = 0.38;

/// How often it forks.
const FORKS: usize = 2;

/// A branch of it, in lengths of what it leaves.
const BRANCH: f64 = 0.7;

/// The angle by which a branch turns away, in degrees.
const FORK: f64 = 26.0;

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
        // Ramified ones do not run to each other: where all lead is found out before the first is laid.
        let at_once = if spec.tertiary == TertiaryType::Ramified { count.max(1) } else { 1 };
        for first in (0..count).step_by(at_once) {
            let mut rungs = Vec::new();
            for k in first..count.min(first + at_once) {
                let sway = [rng.between(-1.0, 1.0), rng.between(-1.0, 1.0), rng.between(-1.0, 1.0)];
                let along = (k as f64 + 0.5 + 0.7 * spec.irregularity * sway[0]) * spacing;
                let share = FIRST + along / length;
                if share < 1.0 {
                    rungs.extend(Rung::at(spec, planter, bearer, share, LONGEST * spacing, sway));
                }
            }
            rungs.iter().for_each(|rung| rung.lay(spec, planter, rng));
        }
    }
}

/// One tertiary from a place of a secondary to the next vein on the side of the apex.
struct Rung {
    node: NodeId,
    from: DVec2,
    /// Along the secondary.
    heading: DVec2,
    /// At a right angle to it.
    across: DVec2,
    /// To the next vein.
    chord: DVec2,
    sway: [f64; 3],
}

impl Rung {
    /// At a share of a bearer; `None` where no vein follows within a distance.
    fn at(
        spec: &GuideSpec,
        planter: &Planter<'_>,
        bearer: &Bearer,
        share: f64,
        longest: f64,
        sway: [f64; 3],
    ) -> Option<Self> {
        let (node, from, heading) = bearer.vein.at(share);
        let across =
            if heading.perp().dot(bearer.ahead) > 0.0 { heading.perp() } else { -heading.perp() };
        let straight = match spec.tertiary {
            TertiaryType::Ramified => (across + heading * OUTWARD).normalize_or_zero(),
            _ => across,
        };
        let towards = turned(straight, LEAN * spec.irregularity * loose(spec) * sway[1], 1.0);
        let reached = planter.probe(node, towards, longest)?;
        Some(Self { node, from, heading, across, chord: reached - from, sway })
    }

    fn lay(&self, spec: &GuideSpec, planter: &mut Planter<'_>, rng: &mut Rng) {
        let &Self { node, from, heading, chord, sway, .. } = self;
        let reached = from + chord;
        let bend = BOW + 0.15 * spec.irregularity * loose(spec) * sway[2];
        let out = heading * (chord.length() * bend);
        match spec.tertiary {
            TertiaryType::PercurrentAlternate => {
                // The second half sets out from the other side, half a rung further.
                let half = from + chord * (0.5 + 0.1 * sway[2]);
                let bow =
                    [from, from.lerp(half, 0.4) + out, from.lerp(half, 0.8) + out, half + out];
                let line = curve::cubic(bow, 16);
                let Some(vein) = planter.lay(node, &line, TERTIARY, 0.7) else { return };
                let (end, at, _) = vein.end();
                let side = if sway[0] > 0.0 { 1.0 } else { -1.0 };
                let on = turned(chord, 40.0, side);
                let Some(reached) = planter.probe(end, on.normalize_or_zero(), chord.length())
                else {
                    return;
                };
                let line = [at, at.lerp(reached, 0.5), reached];
                if let Some(vein) = planter.lay(end, &line, TERTIARY, 0.5) {
                    planter.join_hit(&vein);
                }
            }
            TertiaryType::Ramified => {
                // It leaves nearly at a right angle and turns out.
                let first = from + self.across * (0.4 * STEM * chord.length());
                let line = curve::cubic([from, first, first, from + chord * STEM], 12);
                if let Some(stem) = planter.lay(node, &line, TERTIARY, 0.6) {
                    ramify(spec, planter, &stem, FORKS, rng);
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
}

/// How much more those lean and bend that are to meet each other.
fn loose(spec: &GuideSpec) -> f64 {
    if spec.tertiary == TertiaryType::Reticulate { 2.0 } else { 1.0 }
}

/// Forks a vein at its end: both branches go on as it came and turn away, one mostly longer.
fn ramify(spec: &GuideSpec, planter: &mut Planter<'_>, stem: &Vein, forks: usize, rng: &mut Rng) {
    let (end, at, ahead) = stem.end();
    let uneven = (0.3 + spec.irregularity) * rng.between(-0.6, 0.6);
    for side in [1.0, -1.0] {
        let length = stem.length() * BRANCH * (1.0 + side * uneven);
        let angle = FORK * (1.0 - 0.5 * side * uneven) * rng.between(0.85, 1.15);
        let tip = at + turned(ahead, angle, side) * length;
        let bow = [at, at + ahead * (0.25 * length), at.lerp(tip, 0.6), tip];
        let Some(branch) = planter.lay(end, &curve::cubic(bow, 12), TERTIARY, 0.4) else {
            continue;
        };
        if forks > 1 {
            ramify(spec, planter, &branch, forks - 1, rng);
        }
    }
}
