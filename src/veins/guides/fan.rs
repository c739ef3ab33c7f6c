//! Veins that fork again and again and so fill a fan at one spacing, as in a ginkgo.
//!
//! A place in the fan is (u, t): the ray to the share u of the margin that the fan reaches, and the
//! share t of the way along it. A vein has a stretch of the margin to itself and keeps to the ray at the
//! middle of it; where that stretch, t of the way out, has become wide enough for two veins, it
//! forks, and both branches swing over to the middles of their halves. As every vein stays within its
//! stretch, none meets another.

use glam::DVec2;

use super::curve;
use super::planter::{CLEARANCE, CLOSE, Planter};
use super::{GuideSpec, PRIMARY};
use crate::geometry::measured::stretch;
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
    /// How much of it is seen from the base up to each of its points: its length, where it lies across
    /// the rays; the wall of a cleft, along which they run, counts for little.
    seen: Vec<f64>,
}

impl Fan {
    fn new(base: DVec2, arc: Vec<DVec2>) -> Self {
        let mut total = 0.0;
        let across = arc.windows(2).map(|w| {
            let ray = (w[0].midpoint(w[1]) - base).normalize_or_zero();
            total += ray.perp_dot(w[1] - w[0]).abs();
            total
        });
        let seen = std::iter::once(0.0).chain(across).collect();
        Self { base, arc, seen }
    }

    fn width(&self) -> f64 {
        self.seen[self.seen.len() - 1]
    }

    fn place(&self, u: f64, t: f64) -> DVec2 {
        let (i, part) = stretch(&self.seen, u * self.width());
        self.base.lerp(self.arc[i].lerp(self.arc[i + 1], part), t)
    }
}

/// Lays the veins of a fan out of the root.
pub(super) fn lay(spec: &GuideSpec, planter: &mut Planter<'_>, root: u32, rng: &mut Rng) {
    // Each keeps to its own stretch: at the base, where those are narrow, too.
    planter.keep_apart(CLOSE);
    lay_rays(spec, planter, root, rng);
    planter.keep_apart(CLEARANCE);
}

fn lay_rays(spec: &GuideSpec, planter: &mut Planter<'_>, root: u32, rng: &mut Rng) {
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
    let arcs = |side: &[DVec2]| {
        fans(base, side.iter().copied().filter(within), 3.0 * spec.fork_spacing_mm)
    };
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
    fans: Vec<Fan>,
    basal: f64,
    rng: &mut Rng,
) {
    let total: f64 = fans.iter().map(Fan::width).sum();
    for fan in fans {
        // The lobes of a cleft blade have basal veins of their own.
        let basal = (basal * fan.width() / total).round().max(1.0) as usize;
        lay_arc(spec, planter, root, &fan, basal, rng);
    }
}

/// Stretches of a line as seen from the base: it breaks where two points are farther apart than `gap`.
fn fans(base: DVec2, points: impl Iterator<Item = DVec2>, gap: f64) -> Vec<Fan> {
    let mut runs: Vec<Vec<DVec2>> = Vec::new();
    for p in points {
        match runs.last_mut() {
            Some(run) if run[run.len() - 1].distance(p) <= gap => run.push(p),
            _ => runs.push(vec![p]),
        }
    }
    runs.retain(|run| run.len() > 1);
    let mut fans: Vec<Fan> = runs.into_iter().map(|run| Fan::new(base, run)).collect();
    // The bottom of a cleft that is seen past its walls needs no veins of its own.
    let widest = fans.iter().map(Fan::width).fold(0.0, f64::max);
    fans.retain(|fan| fan.width() > LEAST_ARC * widest);
    fans
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
    let count = (fan.width() / spec.fork_spacing_mm).ceil().clamp(1.0, MOST_ENDS) as usize;
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
        // A vein to one end goes as far as it gets; one that could not come to its fork forks at once.
        let reached = swing(fan, planter, &branch, middle, fork);
        if served > 1 {
            let (from, u, t) = reached.unwrap_or((branch.from, branch.u, branch.t));
            let half = branch.first + served / 2;
            open.push(Branch { from, u, t, first: half, last: branch.last });
            open.push(Branch { from, u, t, first: branch.first, last: half });
        }
    }
}

/// Lays a branch that swings over to the ray `middle` and ends at the share `end` of it: its last node
/// and place. `None` when something stops it; unless it runs to the margin, it is not laid then.
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
    let aside = (middle - u).abs() * fan.width() * f64::midpoint(t, end).max(t);
    let span = 2.0 * aside / libm::tan(FORK_ANGLE.to_radians()) / ray;
    let span = span.clamp(1e-9, end - t);
    let at = |share: f64| {
        let here = t + (end - t) * share;
        let left = 1.0 - ((here - t) / span).min(1.0);
        fan.place(u + (middle - u) * (1.0 - left * left), here)
    };
    let line: Vec<DVec2> = (0..=POINTS).map(|i| at(i as f64 / POINTS as f64)).collect();
    let room = 1.0 - 2.0 * planter.step / curve::length(&line);
    let vein = planter.lay(from, &line, PRIMARY, if end < 1.0 { room } else { 0.0 })?;
    Some((vein.end().0, middle, end))
}
