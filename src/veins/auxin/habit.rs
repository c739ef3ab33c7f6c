//! How straight, how symmetric and how evenly spread veins come, where growth alone makes them.
//!
//! What E. Foster's *Procedural leaf generation* misses (section 6: straightness and symmetry, "perhaps
//! by using constrained auxin placement") in five parts, each off by default:
//!
//! - *straightness*: the tip of a vein follows those of its callers that lie ahead; the others get
//!   branches once it has passed. (Keeping a part of the heading instead, as flocking does, makes veins
//!   less straight: they overshoot their sources and turn back.)
//! - *pull*: every caller is seen a little towards the apex, so that a vein which leaves at a right
//!   angle leaves at atan(1 / pull).
//! - *symmetry*: darts fall in mirrored pairs; some pairs lose one, and one may be off by a little.
//! - *phases*: sources stand far apart while the first veins grow, and closer and closer later, so that
//!   orders follow each other (A. Runions et al. 2005 get theirs from a blade that starts small).
//! - *density*: darts fall more or less densely along the margin and along the midrib.

use glam::DVec2;

use super::super::VeinSpec;
use crate::geometry::segments::SegmentIndex;
use crate::growth::GrowingBlade;
use crate::parameter::parameters;
use crate::seed::Rng;

parameters! {
    /// Sources that stand far apart at first.
    pub struct PhaseSpec {
        /// How many times as far apart sources stand at first than in the end; 1 for no phases.
        coarseness: number(1.0, 1.0..=100.0, ""),
        /// Share of the steps after which they stand as close as they ever will.
        settle_at: number(0.7, 0.01..=1.0, ""),
    }
}

parameters! {
    /// Where darts fall more or less densely than elsewhere.
    pub struct DensitySpec {
        /// Darts by area along the margin, relative to elsewhere; spacing follows.
        margin: number(1.0, 0.0..=20.0, ""),
        /// Darts by area along the midrib, relative to elsewhere; spacing follows.
        midrib: number(1.0, 0.0..=20.0, ""),
        /// How far that reaches.
        width: number(0.08, 0.005..=1.0, "lengths"),
    }
}

/// Callers behind this (its cosine, seen from where the pull leads) are not turned away from.
const WIDEST_TURN: f64 = 0.5;

/// How fast, at full straightness, callers count less the farther they lie off the heading: those at 60
/// degrees by ¾ to this power.
const SHARPNESS: f64 = 12.0;

/// Where less dense than this, no dart falls, and distances need not be infinite.
const LEAST_DENSITY: f64 = 1e-4;

/// What the settings come to in one step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Steering {
    straightness: f64,
    pull: f64,
}

impl Steering {
    /// After a share of the steps: where there are phases, the finer veins are the less steered.
    pub(super) fn new(spec: &VeinSpec, age: f64) -> Self {
        let most = spec.phases.coarseness;
        let share =
            if most > 1.0 { libm::log(coarseness(spec, age)) / libm::log(most) } else { 1.0 };
        Self { straightness: spec.straightness * share, pull: spec.pull * share }
    }

    /// Whether nothing is steered.
    #[inline]
    pub(super) fn is_off(&self) -> bool {
        self.straightness == 0.0 && self.pull == 0.0
    }

    /// Whether callers count differently.
    pub(super) fn straightens(&self) -> bool {
        self.straightness > 0.0
    }

    /// The sum of the unit vectors towards the callers of a tip, those ahead counting most.
    pub(super) fn ahead(&self, units: &[DVec2], heading: DVec2) -> DVec2 {
        let power = SHARPNESS * self.straightness;
        let weight = |unit: DVec2| libm::pow((0.5 + 0.5 * unit.dot(heading)).max(0.0), power);
        units.iter().fold(DVec2::ZERO, |sum, unit| sum + *unit * weight(*unit))
    }

    /// A unit vector drawn to the apex.
    pub(super) fn pulled(&self, towards: DVec2) -> DVec2 {
        let pulled = (towards + DVec2::Y * self.pull).normalize_or_zero();
        if pulled.dot(towards) > WIDEST_TURN { pulled } else { towards }
    }
}

/// How much farther apart sources stand after a share of the steps than in the end.
pub(super) fn coarseness(spec: &VeinSpec, age: f64) -> f64 {
    let PhaseSpec { coarseness, settle_at } = spec.phases;
    if coarseness == 1.0 {
        return 1.0;
    }
    let first = if spec.convergence.spacing_mm > 0.0 { spec.convergence.until } else { 0.0 };
    let left = if settle_at > first { (settle_at - age) / (settle_at - first) } else { 0.0 };
    libm::pow(coarseness, left.clamp(0.0, 1.0))
}

/// Where the second dart of a pair falls; `None` when the pair has only one.
pub(super) fn mirrored(spec: &VeinSpec, p: DVec2, rng: &mut Rng) -> Option<DVec2> {
    if spec.symmetry == 0.0 {
        return None;
    }
    let (keeps, turn, out) = (rng.unit(), rng.unit(), rng.unit());
    if keeps >= spec.symmetry {
        return None;
    }
    let angle = std::f64::consts::TAU * turn;
    let off = DVec2::new(libm::cos(angle), libm::sin(angle)) * (spec.symmetry_jitter_mm * out);
    Some(DVec2::new(-p.x, p.y) + off)
}

/// The density of darts by place.
#[derive(Debug)]
pub(super) struct Density {
    spec: DensitySpec,
    width: f64,
    edges: SegmentIndex,
    most: f64,
}

impl Density {
    /// `None` when it is the same everywhere.
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Option<Self> {
        let density = &spec.density;
        (density.margin != 1.0 || density.midrib != 1.0).then(|| Self {
            spec: density.clone(),
            width: density.width * blade.mature().length_mm(),
            edges: SegmentIndex::of_polygon(blade.mature().outline()),
            most: density.margin.max(1.0) * density.midrib.max(1.0),
        })
    }

    fn at(&self, p: DVec2) -> f64 {
        let near = |distance: f64| (1.0 - distance / self.width).clamp(0.0, 1.0);
        let factor = |most: f64, distance: f64| 1.0 + (most - 1.0) * near(distance);
        let nearest = self.edges.nearest(p, self.width);
        let margin = nearest.map_or(self.width, |(distance2, _)| distance2.sqrt());
        factor(self.spec.margin, margin) * factor(self.spec.midrib, p.x.abs())
    }

    /// Whether a dart that falls at `p` stays.
    pub(super) fn admits(&self, p: DVec2, rng: &mut Rng) -> bool {
        rng.unit() * self.most < self.at(p)
    }

    /// Distances at `p`, relative to those elsewhere: area is the square of length.
    pub(super) fn closeness(&self, p: DVec2) -> f64 {
        1.0 / self.at(p).max(LEAST_DENSITY).sqrt()
    }

    /// How many darts are thrown for one that falls where nothing is changed.
    pub(super) fn most(&self) -> f64 {
        self.most
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vein_at_a_right_angle_leaves_at_the_angle_of_the_pull() {
        for pull in [0.3, 1.0, 1.7] {
            let steering = Steering { straightness: 0.0, pull };
            let way = steering.pulled(DVec2::X);
            assert!((way.y.atan2(way.x) - f64::atan(pull)).abs() < 1e-12);
            assert_eq!(steering.pulled(-DVec2::Y), -DVec2::Y, "not away from callers");
        }
    }

    #[test]
    fn a_tip_follows_the_callers_ahead() {
        let steering = Steering { straightness: 1.0, pull: 0.0 };
        let units = [DVec2::Y, DVec2::X, DVec2::new(-0.6, 0.8)];
        let way = steering.ahead(&units, DVec2::Y).normalize();
        assert!(way.y > 0.95, "{way}");
        // Two at the same angle count the same.
        let way = steering.ahead(&[DVec2::X, -DVec2::X], DVec2::Y);
        assert_eq!(way, DVec2::ZERO);
    }

    #[test]
    fn sources_come_closer_from_phase_to_phase() {
        let mut spec = VeinSpec::default();
        assert_eq!(coarseness(&spec, 0.0), 1.0);
        spec.phases.coarseness = 16.0;
        spec.phases.settle_at = 0.8;
        assert_eq!(coarseness(&spec, 0.0), 16.0);
        assert!((coarseness(&spec, 0.4) - 4.0).abs() < 1e-12);
        assert_eq!(coarseness(&spec, 0.9), 1.0);
    }
}
