//! Veins that fork again and again and so fill a fan at one spacing, as in a ginkgo.
//!
//! A place in the fan is (u, t): the ray to the share u of the margin that the fan reaches, and the
//! share t of the way along it. A vein has a stretch of the margin to itself and keeps to the ray at the
//! middle of it; where that stretch, t of the way out, has become wide enough for two veins, it
//! forks, and both branches swing over to the middles of their halves. As every vein stays within its
//! stretch, none meets another.

use glam::DVec2;

use super::curve;
use super::planter::Planter;
use super::{GuideSpec, PRIMARY};
use crate::seed::Rng;

/// The angle at which a branch leaves the course of the vein that forks (degrees).
const FORK_ANGLE: f64 = 11.0;

/// A vein forks when it has this many times the final spacing to itself.
const FORKS_AT: f64 = 1.45;

/// Points to a branch before it is cut into steps.
const POINTS: usize = 48;

/// More ends than this are a slip of the keyboard.
const MOST_ENDS: f64 = 2000.0;

/// A stretch of the margin shorter than this, relative to the longest one, has no basal vein.
const LEAST_ARC: f64 = 0.1;

/// A vein that is to be laid.
struct Branch {
    /// The node that it grows out of, and where that stands.
    from: u32,
    u: f64,
    t: f64,
    /// The stretch it serves, in ends.
    first: usize,
    last: usize,
}

/// The rays of a fan.
struct Fan {
    base: DVec2,
    /// The margin that the fan reaches.
    arc: Vec<DVec2>,
    length: f64,
}

impl Fan {
    fn place(&self, u: f64, t: f64) -> DVec2 {
        self.base.lerp(curve::at(&self.arc, u).0, t)
    }
}

/// Lays the veins of a fan out of the root.
pub(super) fn lay(spec: &GuideSpec, planter: &mut Planter<'_>, root: u32, rng: &mut Rng) {
    let ground = planter.ground;
    let base = ground.root();
    let line = crate::geometry::polygon::resampled(
        ground.margin().outline(),
        0.25 * spec.fork_spacing_mm.min(ground.length() / 8.0),
    );
    let within = |p: &DVec2| {
        let angle = (*p - base).angle_to(DVec2::Y).abs().to_degrees();
        angle <= spec.primary_angle_deg && ground.is_free(base, base.lerp(*p, 0.97))
    };
    let arcs =
        |side: &[DVec2]| runs(side.iter().copied().filter(within), 3.0 * spec.fork_spacing_mm);
    if ground.margin().is_peltate() {
        // Both sides of the ray to the apex.
        let tip = ground.margin().apex();
        let distance = |i: &usize| line[*i].distance_squared(tip);
        let apex = (0..line.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0);
        let basal = (spec.primary_count.saturating_sub(1) / 2) as f64;
        for side in [&line[..=apex], &line[apex..]] {
            lay_arcs(spec, planter, root, arcs(side), basal, rng);
        }
    } else {
        lay_arcs(spec, planter, root, arcs(&line), spec.primary_count as f64, rng);
    }
}

/// Lays the veins of several stretches of the margin, of which `basal` leave the base.
fn lay_arcs(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    root: u32,
    arcs: Vec<Vec<DVec2>>,
    basal: f64,
    rng: &mut Rng,
) {
    let base = planter.ground.root();
    let total: f64 = arcs.iter().map(|arc| curve::length(arc)).sum();
    for arc in arcs {
        let length = curve::length(&arc);
        // The lobes of a cleft blade have basal veins of their own.
        let basal = (basal * length / total).round().max(1.0) as usize;
        lay_arc(spec, planter, root, &Fan { base, arc, length }, basal, rng);
    }
}

/// Stretches of a line: it breaks where two points are farther apart than `gap`.
fn runs(points: impl Iterator<Item = DVec2>, gap: f64) -> Vec<Vec<DVec2>> {
    let mut runs: Vec<Vec<DVec2>> = Vec::new();
    for p in points {
        match runs.last_mut() {
            Some(run) if run[run.len() - 1].distance(p) <= gap => run.push(p),
            _ => runs.push(vec![p]),
        }
    }
    // The bottom of a cleft that is seen past its walls needs no veins of its own.
    let longest = runs.iter().map(|run| curve::length(run)).fold(0.0, f64::max);
    runs.retain(|run| curve::length(run) > LEAST_ARC * longest);
    runs
}

/// Lays the veins that serve one stretch of the margin.
fn lay_arc(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    root: u32,
    fan: &Fan,
    basal: usize,
    rng: &mut Rng,
) {
    let count = (fan.length / spec.fork_spacing_mm).ceil().clamp(1.0, MOST_ENDS) as usize;
    let basal = basal.clamp(1, count);
    let mut open: Vec<Branch> = (0..basal)
        .rev()
        .map(|i| {
            let (first, last) = (i * count / basal, (i + 1) * count / basal);
            let u = (first + last) as f64 / (2 * count) as f64;
            Branch { from: root, u, t: 0.0, first, last }
        })
        .collect();
    while let Some(branch) = open.pop() {
        let served = branch.last - branch.first;
        let sway = [rng.between(-1.0, 1.0), rng.between(-1.0, 1.0)];
        let even = FORKS_AT / served as f64;
        let fork = if served == 1 { 1.0 } else { even * (1.0 + 0.5 * spec.irregularity * sway[0]) };
        let fork = fork.min(1.0);
        let middle = (branch.first + branch.last) as f64 / 2.0
            + 0.2 * spec.irregularity * served as f64 * sway[1];
        let middle = middle / count as f64;
        let Some((from, u, t)) = swing(fan, planter, &branch, middle, fork) else { continue };
        // What was stopped on its way forks no more.
        if served > 1 && t < 1.0 {
            let half = branch.first + served / 2;
            open.push(Branch { from, u, t, first: half, last: branch.last });
            open.push(Branch { from, u, t, first: branch.first, last: half });
        }
    }
}

/// Lays a branch that swings over to the ray `middle` and ends at the share `end` of it: its last node
/// and place. `None` when something stops it.
fn swing(
    fan: &Fan,
    planter: &mut Planter<'_>,
    branch: &Branch,
    middle: f64,
    end: f64,
) -> Option<(u32, f64, f64)> {
    let Branch { from, u, t, .. } = *branch;
    let ray = fan.base.distance(fan.place(middle, 1.0));
    if (end - t) * ray < 3.0 * planter.step {
        // No room before the next fork: that is here, too.
        return Some((from, u, t));
    }
    // An offset that is made good evenly slower leaves at twice its mean slope.
    let aside = (middle - u).abs() * fan.length * f64::midpoint(t, end).max(t);
    let span = 2.0 * aside / libm::tan(FORK_ANGLE.to_radians()) / ray;
    let span = span.clamp(1e-9, end - t);
    let at = |share: f64| {
        let here = t + (end - t) * share;
        let left = 1.0 - ((here - t) / span).min(1.0);
        fan.place(u + (middle - u) * (1.0 - left * left), here)
    };
    let line: Vec<DVec2> = (0..=POINTS).map(|i| at(i as f64 / POINTS as f64)).collect();
    let vein = planter.lay(from, &line, PRIMARY, 0.0)?;
    let (node, place, _) = vein.end();
    let is_whole = place.distance(line[POINTS]) <= 2.0 * planter.step;
    is_whole.then_some((node, middle, end))
}
