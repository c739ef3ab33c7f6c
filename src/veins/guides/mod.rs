//! Veins laid down by architecture, before auxin takes over.
//!
//! The first and second order of a leaf follow types that every species keeps: one midrib or several
//! primaries, secondaries that run into the teeth, join in arches or fade along the margin. Here they
//! are laid as curves with ranges of their own; the finer veins grow from them by auxin.
//!
//! Source: types and their definitions after Ellis et al., *Manual of Leaf Architecture*, 2009 (terms
//! only), and Hickey, "Classification of the architecture of dicotyledonous leaves", Am. J. Bot. 60,
//! 1973. That guides and a simulation share the work is the answer to what E. Foster's *Procedural
//! leaf generation* leaves open (straight and symmetric veins).
//!
//! Guides are made in the frame of the mature leaf. They are all there from the first step: under
//! isotropic growth as the small leaf has them, under marginal growth also where the margin has not
//! passed yet, as veins that are laid down ahead of the tissue they will serve.
//!
//! Guides never cross each other, the margin or a cut: a vein stops before it would touch anything, and
//! one that would be left a stump is not laid.

mod aside;
pub mod carry;
mod course;
mod curve;
mod ends;
mod fan;
mod given;
mod ground;
mod intersecondary;
mod lobes;
mod matching;
mod planter;
mod primary;
mod rim;
mod rows;
mod secondary;
mod sinus;
mod targets;
mod tertiary;
#[cfg(test)]
mod tests;

use crate::growth::GrowingBlade;
use crate::parameter::{parameters, words};
use crate::seed::Rng;
use crate::veins::graph::{Rank, VeinGraph, VeinKind};
use crate::veins::{VeinError, VeinSpec};
pub use given::GivenSpec;
use ground::Ground;
use planter::Planter;

words! {
    /// How the primary veins run.
    pub enum PrimaryType {
        /// No guides at all: every vein is grown.
        None = "none",
        /// One midrib.
        Pinnate = "pinnate",
        /// Three or more from one point, straight or curved, towards the lobes if there are any.
        Actinodromous = "actinodromous",
        /// The same, but each further one leaves the one before.
        Palinactinodromous = "palinactinodromous",
        /// Three or more in arches that come together at the apex.
        Acrodromous = "acrodromous",
        /// Several equally fine ones that fork again and again and fan out.
        Flabellate = "flabellate",
        /// Many, side by side from base to apex.
        Parallelodromous = "parallelodromous",
        /// Several that first turn outwards or back, then arch to the apex.
        Campylodromous = "campylodromous",
    }
}

words! {
    /// How the secondary veins end.
    pub enum SecondaryType {
        /// None are laid.
        None = "none",
        /// At the margin, in the teeth if there are any.
        Craspedodromous = "craspedodromous",
        /// They fork near the margin: one branch to a tooth, one to the next secondary.
        Semicraspedodromous = "semicraspedodromous",
        /// The same, with arches outside.
        FestoonedSemicraspedodromous = "festooned-semicraspedodromous",
        /// They turn up along the margin and fade.
        Eucamptodromous = "eucamptodromous",
        /// They branch into a net before the margin.
        Reticulodromous = "reticulodromous",
        /// They fork freely towards the margin.
        Cladodromous = "cladodromous",
        /// They join the next one in arches.
        Brochidodromous = "brochidodromous",
        /// The same, with more arches outside.
        FestoonedBrochidodromous = "festooned-brochidodromous",
    }
}

words! {
    /// How the tertiary veins run between the secondaries.
    pub enum TertiaryType {
        /// None are laid: they grow.
        None = "none",
        /// From one secondary to the next, like the rungs of a ladder.
        Percurrent = "percurrent",
        /// The same with a step half-way.
        PercurrentAlternate = "percurrent-alternate",
        /// Leaning and bending, so that they meet each other.
        Reticulate = "reticulate",
        /// They fork and end between the secondaries.
        Ramified = "ramified",
    }
}

words! {
    /// A vein along the margin.
    pub enum RimType {
        /// None.
        None = "none",
        /// At some distance; the secondaries end in it.
        Intramarginal = "intramarginal",
        /// On the margin itself.
        Marginal = "marginal",
    }
}

parameters! {
    /// Veins that are laid before auxin takes over.
    pub struct GuideSpec {
        /// How the primary veins run; `none` for no guides at all.
        primary: choice(PrimaryType, PrimaryType::None),
        /// Veins at the base: with the midrib for palmate types, in all for parallel and fan ones.
        primary_count: count(5, 1..=61, "veins"),
        /// Angle between the midrib and the outermost primary; 180 for rays all round.
        primary_angle_deg: number(75.0, 5.0..=180.0, "deg"),
        /// How far up the midrib the other primaries begin.
        primary_origin: number(0.0, 0.0..=0.4, "lengths"),
        /// Neighbouring veins of a fan fork until they are this close at the margin.
        fork_spacing_mm: number(2.0, 0.1..=100.0, "mm"),
        /// How the secondary veins end.
        secondary: choice(SecondaryType, SecondaryType::None),
        /// Secondary veins on each side of the midrib.
        secondary_count: count(7, 0..=60, "per side"),
        /// Secondary veins on the outer side of each primary beside the midrib.
        lateral_count: count(3, 0..=30, "per side"),
        /// Angle between midrib and secondary veins at the base.
        secondary_angle_deg: number(48.0, 5.0..=120.0, "deg"),
        /// How much that angle changes from base to apex.
        angle_change_deg: number(-8.0, -80.0..=60.0, "deg"),
        /// Share of that angle by which a secondary turns to the apex on its way.
        curvature: number(0.15, -0.5..=1.2, ""),
        /// Where on the midrib the lowest secondary leaves.
        first_at: number(0.07, 0.005..=0.9, "lengths"),
        /// Where on the midrib the highest secondary leaves.
        last_at: number(0.92, 0.05..=0.99, "lengths"),
        /// How much closer secondaries stand at the apex than at the base.
        spacing_change: number(0.45, -0.9..=0.9, ""),
        /// How far towards the margin go secondaries that do not end there.
        reach: number(0.8, 0.2..=0.98, ""),
        /// How far secondaries run along the midrib before they leave it: 0 excurrent, 1 decurrent.
        decurrence: number(0.2, 0.0..=1.0, ""),
        /// Secondaries of the two sides: 0 opposite, 1 alternate.
        alternation: number(0.5, 0.0..=1.0, ""),
        /// Share of the irregularity that each side has for itself.
        asymmetry: number(0.6, 0.0..=1.0, ""),
        /// How unevenly veins stand and bend.
        irregularity: number(0.2, 0.0..=1.0, ""),
        /// How far a secondary moves to end in a tooth, in spacings of the secondaries.
        tooth_reach: number(0.75, 0.0..=2.0, ""),
        /// Veins between two secondaries, on average.
        intersecondary_count: number(0.0, 0.0..=3.0, ""),
        /// How long they are, as a share of the way to the margin.
        intersecondary_length: number(0.45, 0.1..=0.95, ""),
        /// How the tertiary veins run.
        tertiary: choice(TertiaryType, TertiaryType::None),
        /// From one tertiary vein to the next along a secondary.
        tertiary_spacing: number(0.035, 0.005..=0.5, "lengths"),
        /// A vein along the margin.
        rim: choice(RimType, RimType::None),
        /// How far an intramarginal vein lies inside the margin.
        rim_inset: number(0.02, 0.002..=0.2, "lengths"),
        /// Guides line by line.
        given: group(GivenSpec, GivenSpec::default()),
    }
}

impl GuideSpec {
    /// Takes as many veins as another leaf has, where the primaries of both are of one type: then each has
    /// one in the other that answers it.
    pub fn numbered_as(&mut self, other: &Self) {
        if self.primary == other.primary {
            self.primary_count = other.primary_count;
            self.secondary_count = other.secondary_count;
            self.lateral_count = other.lateral_count;
        }
    }
}

const PRIMARY: Rank = Rank { order: 1, kind: VeinKind::Primary };
const SECONDARY: Rank = Rank { order: 2, kind: VeinKind::Secondary };
const INTERSECONDARY: Rank = Rank { order: 2, kind: VeinKind::Intersecondary };
const TERTIARY: Rank = Rank { order: 3, kind: VeinKind::Tertiary };
const EXTERIOR: Rank = Rank { order: 3, kind: VeinKind::Exterior };

/// Guides end this far inside the margin, in steps; at most [`INSET`] lengths.
const INSET_STEPS: f64 = 0.35;

/// In lengths of the blade: less than a texel of a large picture.
const INSET: f64 = 0.003;

/// More guide nodes than this to the length serve no picture.
const FINEST: f64 = 4000.0;

/// The guides of a leaf, in the frame of the mature leaf; empty without any.
#[must_use]
pub fn build(spec: &VeinSpec, blade: &GrowingBlade, rng: &mut Rng) -> VeinGraph {
    planted(spec, blade, rng, |planter| planter.graph).unwrap_or_default()
}

/// Lays the guides of a leaf and takes from them what is asked; `None` for a leaf without any.
fn planted<T>(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    rng: &mut Rng,
    take: impl FnOnce(Planter<'_>) -> T,
) -> Option<T> {
    let guides = &spec.guides;
    if guides.primary == PrimaryType::None && guides.given.is_empty() {
        return None;
    }
    // Where tissue does not move a bud is the part of the leaf that is there.
    let margin = blade.present();
    let step = spec.node_step_mm.clamp(margin.length_mm() / FINEST, margin.length_mm() / 60.0);
    // Veins of a fan stand closer than others: they need finer steps to keep apart.
    let step = match guides.primary {
        PrimaryType::Flabellate => {
            step.min(guides.fork_spacing_mm / 5.0).max(margin.length_mm() / FINEST)
        }
        _ => step,
    };
    let inset = (INSET_STEPS * step).min(INSET * margin.length_mm());
    let ground = Ground::new(margin, blade.root(), inset);
    let mut planter = Planter::new(&ground, step);
    if guides.given.is_empty() {
        let primaries = primary::lay(guides, &mut planter, rng);
        rows::lay(guides, &mut planter, &primaries, rng);
    } else {
        given::lay(&guides.given, &mut planter);
    }
    Some(take(planter))
}

/// Refuses what contradicts itself.
///
/// # Errors
///
/// [`VeinError`] names the key, the value and what it must be.
pub(super) fn check(spec: &GuideSpec) -> Result<(), VeinError> {
    if spec.first_at >= spec.last_at {
        let problem = format!("must be below veins.guides.last_at ({})", spec.last_at);
        return Err(VeinError::setting("veins.guides.first_at", spec.first_at, problem));
    }
    given::check(&spec.given)
}
