//! Primary veins: the midrib, and those beside it.

use glam::DVec2;

use super::course::Course;
use super::curve::{self, smoothstep, turned};
use super::planter::{Planter, Vein};
use super::{GuideSpec, PRIMARY, PrimaryType, SecondaryType, fan, targets};
use crate::seed::Rng;

/// The most that a midrib of full irregularity strays, in lengths of the blade.
const WANDER: f64 = 0.012;

/// Primaries beside the midrib stand out no less than this from it (degrees).
const LEAST_ANGLE: f64 = 8.0;

/// A palinactinodromous primary leaves the one before at this share of its length.
const LEAVES_AT: f64 = 0.1;

/// The primary veins of a leaf.
pub(super) struct Primaries {
    pub(super) midrib: Option<Vein>,
    pub(super) laterals: Vec<Lateral>,
    /// Secondaries leave the midrib above this share of it.
    pub(super) secondaries_from: f64,
}

/// A primary beside the midrib.
pub(super) struct Lateral {
    pub(super) vein: Vein,
    pub(super) side: f64,
    /// Whether it runs into a lobe.
    pub(super) lobed: bool,
}

/// Lays the primaries.
pub(super) fn lay(spec: &GuideSpec, planter: &mut Planter<'_>, rng: &mut Rng) -> Primaries {
    let root = planter.root(PRIMARY);
    let mut primaries = Primaries { midrib: None, laterals: Vec::new(), secondaries_from: 0.0 };
    if spec.primary == PrimaryType::Flabellate {
        // All round a petiole one ray runs to the apex and does not fork.
        if planter.ground.margin().is_peltate() {
            planter.lay(root, &planter.ground.axis(), PRIMARY, 0.0);
        }
        fan::lay(spec, planter, root, rng);
        return primaries;
    }
    let straight = planter.ground.axis();
    let amplitude = spec.irregularity * WANDER * planter.ground.length();
    let wavering = curve::wavering(&straight, amplitude, rng);
    // Where a narrow base leaves no room to stray, it does not.
    let axis = if planter.way(&wavering, PRIMARY) < planter.way(&straight, PRIMARY) {
        straight
    } else {
        wavering
    };
    primaries.midrib = planter.lay(root, &axis, PRIMARY, 0.0);
    let Some(midrib) = primaries.midrib.clone() else { return primaries };
    match spec.primary {
        PrimaryType::Actinodromous | PrimaryType::Palinactinodromous => {
            palmate(spec, planter, &midrib, &mut primaries, rng);
        }
        PrimaryType::Acrodromous | PrimaryType::Campylodromous | PrimaryType::Parallelodromous => {
            arches(spec, planter, &midrib, &mut primaries, rng);
        }
        PrimaryType::None | PrimaryType::Pinnate | PrimaryType::Flabellate => {}
    }
    primaries
}

/// Rays from the base, into the lobes where there are any.
fn palmate(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    midrib: &Vein,
    primaries: &mut Primaries,
    rng: &mut Rng,
) {
    let pairs = (spec.primary_count.saturating_sub(1) / 2) as usize;
    let ground = planter.ground;
    let lobes = targets::lobes(ground.margin());
    let handed = [1.0, -1.0].map(|side| rng.between(-1.0, 1.0) * side);
    for side in [1.0, -1.0] {
        let mut last: Option<Vein> = None;
        let tips: Vec<_> = lobes.iter().filter(|tip| tip.side == side).collect();
        for k in 0..pairs {
            let sway = [handed[usize::from(side < 0.0)], rng.between(-1.0, 1.0), rng.unit()];
            let share = (k + 1) as f64 / pairs as f64;
            let angle = spec.primary_angle_deg * share * (1.0 + 0.08 * spec.irregularity * sway[1]);
            // Out of the midrib, or out of the one before.
            let origin = match (&last, spec.primary) {
                (Some(last), PrimaryType::Palinactinodromous) => last.at(LEAVES_AT),
                _ if spec.primary_origin > 0.0 => {
                    midrib.at(spec.primary_origin * (1.0 + 0.3 * spec.irregularity * sway[0]))
                }
                _ => (midrib.nodes[0], midrib.line[0], midrib.at(0.1).2),
            };
            let axis = midrib.at(0.1).2;
            let line = if let Some(tip) = tips.get(k) {
                into_lobe(planter, origin.1, side, tip.at)
            } else if tips.is_empty() {
                let curvature = (spec.curvature + 0.25).min(0.6);
                let (from, ahead) = (origin.1, axis);
                let angle_deg = angle.max(LEAST_ANGLE);
                let course = Course { from, ahead, side, angle_deg, curvature };
                match spec.secondary {
                    SecondaryType::Craspedodromous => course.to_margin(ground),
                    _ => course.along_margin(ground, spec.reach.max(0.88), 0.4),
                }
            } else {
                // Drawn all the same: what comes after must not hang on how many lobes there are.
                curve::wavering(&[], 0.0, rng);
                continue;
            };
            let amplitude = 0.5 * spec.irregularity * WANDER * curve::length(&line);
            let line = curve::wavering(&line, amplitude, rng);
            if let Some(vein) = planter.lay(origin.0, &line, PRIMARY, 0.4) {
                last = Some(vein.clone());
                primaries.laterals.push(Lateral { vein, side, lobed: !tips.is_empty() });
            }
        }
    }
    primaries.secondaries_from = spec.primary_origin;
}

/// How far the ways into a lobe that are tried bow away from the midrib (degrees).
const BOWS_DEG: [f64; 4] = [6.0, 2.0, -2.0, -6.0];

/// From the base into the tip of a lobe: a slight bow, or round the sinus where that is cut off.
pub(super) fn into_lobe(planter: &Planter<'_>, from: DVec2, side: f64, tip: DVec2) -> Vec<DVec2> {
    let chord = tip - from;
    let bow = |degrees: f64| {
        let leave = from + turned(chord, degrees, side) * 0.35;
        let arrive = from + turned(chord, degrees / 6.0, side) * 0.7;
        curve::cubic([from, leave, arrive, tip], 60)
    };
    let is_free = |bow: &Vec<DVec2>| {
        let inner = &bow[1..bow.len() - 2];
        inner.windows(2).all(|w| planter.ground.is_free(w[0], w[1]))
    };
    let found = BOWS_DEG.into_iter().map(bow).find(is_free);
    found.or_else(|| planter.ground.route(from, tip)).unwrap_or_else(|| bow(BOWS_DEG[0]))
}

/// Half the width of the blade on one side of a midrib, at 64 places from base to apex, evened.
fn half_widths(planter: &Planter<'_>, midrib: &Vein, side: f64) -> Vec<f64> {
    let ground = planter.ground;
    let mut widths: Vec<f64> = (0..=64)
        .map(|i| {
            let (_, p, ahead) = midrib.at(f64::from(i) / 64.0);
            ground.cast(p, turned(ahead, 90.0, side))
        })
        .collect();
    for _ in 0..6 {
        let before = widths.clone();
        for i in 1..64 {
            widths[i] = before[i].min((before[i - 1] + 2.0 * before[i] + before[i + 1]) / 4.0);
        }
    }
    widths
}

/// Parallel veins have come to their places at this share of the length, or, in a narrow blade, so many
/// halves of its width above the base.
const SETTLED: f64 = 0.12;
const SETTLED_WIDTHS: f64 = 1.5;

/// Lines beside the midrib, at constant shares of the width once they have left the base.
fn arches(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    midrib: &Vein,
    primaries: &mut Primaries,
    rng: &mut Rng,
) {
    let pairs = (spec.primary_count.saturating_sub(1) / 2) as usize;
    let parallel = spec.primary == PrimaryType::Parallelodromous;
    // Where the lines have come to their place, and where they end, in lengths of the midrib.
    let origin = spec.primary_origin;
    let (latest, end) = if parallel { (SETTLED, 0.985) } else { (0.45, 0.955) };
    let widest = if parallel { 0.93 } else { 0.72 };
    let slope = libm::tan(spec.primary_angle_deg.min(80.0).to_radians());
    for side in [1.0, -1.0] {
        let widths = half_widths(planter, midrib, side);
        let broadest = widths.iter().copied().fold(0.0, f64::max);
        // A narrow blade has no room for many veins that part slowly.
        let early = SETTLED_WIDTHS * broadest / midrib.length();
        let settled = if parallel { latest.min(early) } else { latest };
        let width = |t: f64| {
            let at = (t * 64.0).clamp(0.0, 63.999);
            let (i, part) = (at as usize, at.fract());
            widths[i] * (1.0 - part) + widths[i + 1] * part
        };
        for k in 0..pairs {
            let sway = rng.between(-1.0, 1.0);
            let share = (k + 1) as f64 / (pairs as f64 + if parallel { 0.0 } else { 0.35 });
            let share = share * widest * (1.0 + 0.06 * spec.irregularity * sway);
            let share = share.min(0.95);
            let total = midrib.length();
            let line: Vec<DVec2> = (0..=160)
                .map(|i| {
                    let t = origin + (end - origin) * f64::from(i) / 160.0;
                    let (p, ahead) = curve::at(&midrib.line, t);
                    let rise = smoothstep(-settled, settled, t - origin) * 2.0 - 1.0;
                    // The angle at which they leave limits how fast they go out.
                    let steepest = (t - origin) * total * slope * share / widest;
                    let out = (share * width(t) * rise).min(steepest);
                    p + turned(ahead, 90.0, side) * out
                })
                .collect();
            let line = if spec.primary == PrimaryType::Campylodromous {
                recurved(spec, planter, midrib, side, share / widest, &line)
            } else {
                line
            };
            let line = curve::rounded(&line, 4);
            let laid = if parallel || spec.primary == PrimaryType::Acrodromous {
                planter.lay_beside(&line, PRIMARY, 0.3)
            } else {
                planter.lay(midrib.nodes[0], &line, PRIMARY, 0.3)
            };
            if let Some(vein) = laid {
                primaries.laterals.push(Lateral { vein, side, lobed: false });
            }
        }
    }
    // Below, a secondary would come out on the far side of the arches.
    primaries.secondaries_from = origin + 0.12;
}

/// A line that leaves the base at a wide angle and comes back to `line` where that has settled.
fn recurved(
    spec: &GuideSpec,
    planter: &Planter<'_>,
    midrib: &Vein,
    side: f64,
    share: f64,
    line: &[DVec2],
) -> Vec<DVec2> {
    let from = midrib.line[0];
    let (_, _, axis) = midrib.at(0.1);
    let towards = turned(axis, spec.primary_angle_deg * share, side);
    let meet = line.len() * 2 / 5;
    let ahead = (line[meet + 1] - line[meet]).normalize_or_zero();
    let room = planter.ground.cast(from, towards);
    let out = 0.55 * room.min(line[meet].distance(from));
    let back = 0.5 * line[meet].distance(from);
    let bow = [from, from + towards * out, line[meet] - ahead * back, line[meet]];
    let mut whole = curve::cubic(bow, 60);
    whole.extend(&line[meet + 1..]);
    whole
}
