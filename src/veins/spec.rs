//! The settings of the vein pattern.

use super::VeinError;
use super::auxin::{ConvergenceSpec, DensitySpec, PhaseSpec};
use super::guides::{self, GuideSpec};
use super::particles::ParticleSpec;
use crate::parameter::{Parameters, parameters, words};

words! {
    /// How veins are made.
    pub enum Algorithm {
        /// Veins grow towards auxin sources and never meet (Runions et al. 2005, open venation).
        AuxinOpen = "auxin-open",
        /// Veins grow towards auxin sources and meet there, so that loops close (Runions et al. 2005,
        /// closed venation).
        AuxinClosed = "auxin-closed",
        /// Veins are the trails of particles that flow to the petiole (Rodkaew et al. 2002).
        Particles = "particles",
    }
}

words! {
    /// Where the widths of veins come from.
    pub enum Widths {
        /// The number of tips behind them, by Murray's law; what joins veins carries nothing.
        Murray = "murray",
        /// The flow through them, to which they adapt: in loops, too.
        Flow = "flow",
    }
}

parameters! {
    /// Growth of the vein pattern. Lengths are those of the blade at the step in question.
    pub struct VeinSpec {
        /// How veins are made.
        algorithm: choice(Algorithm, Algorithm::AuxinOpen),
        /// Times all lengths of veins that grow or flow, the radius of the finest included; darts are as many
        /// more as there is room for. What is laid down (`guides`, `convergence`) stays. 0.43 gives a beech the areoles of a real one: 10 mm of vein to the mm².
        scale: number(1.0, 0.1..=10.0, ""),
        /// Auxin darts thrown per step at full size; more gives a denser pattern.
        spawn_rate: number(60.0, 0.0..=100_000.0, "darts/step"),
        /// A dart nearer than this to a source is lost.
        source_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A dart nearer than this to a vein is lost.
        vein_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A source is used up when a vein comes within this distance.
        kill_distance_mm: number(0.8, 0.001..=1000.0, "mm"),
        /// How far a vein grows in one step.
        node_step_mm: number(0.3, 0.001..=100.0, "mm"),
        /// No step of a vein that grows in a small leaf becomes longer than this once the leaf is grown;
        /// 0 for no limit. Long ones have no nodes from which veins could branch. Trails of particles are
        /// cut to so many `particles.step_mm`.
        longest_step: number(0.0, 0.0..=1000.0, "steps"),
        /// A source calls veins within this distance only; 0 for no limit.
        attraction_distance_mm: number(0.0, 0.0..=10_000.0, "mm"),
        /// Closed venation: veins meet only where the way round along other veins is longer than this;
        /// around 5 and more, no areole is a speck.
        least_loop: number(2.0, 0.0..=50.0, "kill distances"),
        /// Closed venation: share of the steps in which veins close loops. In the rest they end free, as
        /// in open venation: the finest veinlets of a real leaf.
        closing_share: number(1.0, 0.0..=1.0, ""),
        /// Closed venation, last steps that close no loops: spawn and kill distances there, relative to
        /// those before. Below 1, sources find room inside the loops.
        veinlet_scale: number(0.7, 0.1..=2.0, ""),
        /// Closed venation: kill distance in the last steps, relative to that before (no less than half
        /// a step). Small, and the veinlets reach the middle of what they feed.
        veinlet_kill: number(0.7, 0.01..=2.0, ""),
        /// Veins that end free are no shorter than this: stubs go.
        least_veinlet: number(0.0, 0.0..=50.0, "kill distances"),
        /// How straight veins come: 0 as all their sources pull them, above it tips follow those ahead.
        straightness: number(0.0, 0.0..=1.0, ""),
        /// How strongly veins are drawn to the apex: a vein that would leave at a right angle leaves at
        /// atan(1/pull), 45° for 1.
        pull: number(0.0, 0.0..=3.0, ""),
        /// Share of the darts that have a twin on the other side of the midrib; 1 for a leaf whose halves
        /// mirror each other.
        symmetry: number(0.0, 0.0..=1.0, ""),
        /// How far a twin may be off its mirrored place.
        symmetry_jitter_mm: number(0.0, 0.0..=100.0, "mm"),
        /// Sources stand far apart at first, so that orders of veins follow each other.
        phases: group(PhaseSpec, PhaseSpec::default()),
        /// Points on the margin from which the first veins come.
        convergence: group(ConvergenceSpec, ConvergenceSpec::default()),
        /// Where darts fall more or less densely.
        density: group(DensitySpec, DensitySpec::default()),
        /// Positions of auxin sources in the mature leaf, instead of darts.
        sources_mm: points(),
        /// Radius of the finest veins.
        tip_radius_mm: number(0.03, 0.0001..=10.0, "mm"),
        /// Murray's exponent: the parent's radius to this power is the sum over its children.
        murray_exponent: number(3.0, 1.0..=10.0, ""),
        /// What each order adds to Murray's exponent, from the second on; it stays from 1 to 10. The
        /// order is that of the vein that divides.
        exponent_change: number(0.0, -9.0..=9.0, ""),
        /// No vein is drawn finer; 0 for the radius of the tips.
        least_radius_mm: number(0.0, 0.0..=10.0, "mm"),
        /// How evenly a vein tapers between its branches: 0 in a step at each, 1 all the way.
        taper: number(0.0, 0.0..=1.0, ""),
        /// Share of its radius at its beginning that a tertiary, or finer, vein which ends on another keeps at
        /// least: at 0 only what its own branches ask for, at 1 all of it. Rungs between secondaries keep most.
        joined_width: number(0.0, 0.0..=1.0, ""),
        /// Where widths come from: `murray` counts tips, `flow` lets veins adapt to what flows through
        /// them, loops included, and takes seconds for each 10 000 junctions.
        widths: choice(Widths, Widths::Murray),
        /// Share of the demand for water that comes and goes, for `widths = "flow"`; loops live on it.
        fluctuation: number(0.5, 0.0..=1.0, ""),
        /// How often junctions move towards a balance of the veins' pull; about 5 gives natural angles.
        relaxation: count(0, 0..=100, "sweeps"),
        /// How strongly areoles that are smaller than their neighbours press on their veins while
        /// junctions move, in pulls of a mean vein; without, the small ones shrink.
        areole_pressure: number(0.0, 0.0..=10.0, ""),
        /// How far kinks of grown veins are drawn straight; above 0 long segments become curves too.
        smoothing: number(0.0, 0.0..=1.0, ""),
        /// How far fine veins bow between their junctions: the spread of the height of the bow, as a share
        /// of its length. 0.1 gives veins 2 hundredths longer than their chords.
        sinuosity: number(0.0, 0.0..=0.5, ""),
        /// Veins that are laid before auxin takes over.
        guides: group(GuideSpec, GuideSpec::default()),
        /// Particles, for `algorithm = "particles"`.
        particles: group(ParticleSpec, ParticleSpec::default()),
    }
}

impl VeinSpec {
    /// The same at [`scale`](Self::scale) 1, with its lengths and its darts as that says.
    #[must_use]
    pub fn scaled(&self) -> Self {
        let mut spec = Self { scale: 1.0, ..self.clone() };
        for length in [
            &mut spec.source_spawn_distance_mm,
            &mut spec.vein_spawn_distance_mm,
            &mut spec.kill_distance_mm,
            &mut spec.node_step_mm,
            &mut spec.attraction_distance_mm,
            &mut spec.symmetry_jitter_mm,
            &mut spec.tip_radius_mm,
            &mut spec.least_radius_mm,
            &mut spec.particles.spacing_mm,
            &mut spec.particles.step_mm,
            &mut spec.particles.merge_radius_mm,
        ] {
            *length *= self.scale;
        }
        spec.spawn_rate /= self.scale * self.scale;
        spec
    }
}

/// Refuses settings under which growth would make no sense or never end.
pub(super) fn check(spec: &VeinSpec) -> Result<(), VeinError> {
    if let Some(outside) = spec.outside_limits() {
        let key = format!("veins.{}", outside.key);
        return Err(VeinError::setting(key, outside.value, outside.problem()));
    }
    agree(spec)
}

/// Refuses settings that are each in their limits and contradict each other.
fn agree(spec: &VeinSpec) -> Result<(), VeinError> {
    guides::check(&spec.guides)?;
    // A vein steps over a source that is nearer than its step; half a step beyond, it must count as
    // reached, or the vein would turn round for ever.
    let least = spec.node_step_mm / 2.0;
    if spec.kill_distance_mm < least {
        let problem = format!(
            "must be at least half of veins.node_step_mm ({least}): veins would step over the sources"
        );
        return Err(VeinError::setting("veins.kill_distance_mm", spec.kill_distance_mm, problem));
    }
    Ok(())
}

/// The settings at their scale, fit to be grown from.
pub(super) fn scaled(spec: &VeinSpec) -> Result<VeinSpec, VeinError> {
    let scaled = spec.scaled();
    if let Some(outside) = scaled.outside_limits() {
        let problem = format!(
            "makes veins.{} {}, which {}; take a scale nearer to 1, or change that too",
            outside.key,
            outside.value,
            outside.problem()
        );
        return Err(VeinError::setting("veins.scale", spec.scale, problem));
    }
    agree(&scaled)?;
    Ok(scaled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::Value;

    /// Calls `visit` with the dotted key of every number.
    fn for_each_number(key: &str, value: &mut Value, visit: &mut impl FnMut(&str, &mut Value)) {
        match value {
            Value::Object(group) => {
                for (name, value) in group {
                    let key = if key.is_empty() { name.clone() } else { format!("{key}.{name}") };
                    for_each_number(&key, value, visit);
                }
            }
            Value::Array(list) => {
                list.iter_mut().for_each(|value| for_each_number(key, value, visit));
            }
            Value::Number(_) => visit(key, value),
            _ => {}
        }
    }

    fn numbers(spec: &VeinSpec) -> Vec<(String, f64)> {
        let mut found = Vec::new();
        let mut value = serde_json::to_value(spec).expect("plain data");
        for_each_number("", &mut value, &mut |key, value| {
            found.push((key.to_owned(), value.as_f64().expect("a number")));
        });
        found
    }

    proptest! {
        #[test]
        fn scaling_multiplies_lengths_and_nothing_else(scale in 0.1..10.0f64, draw in 0.1..3.0f64) {
            // Every number another, so that none is 0.
            let points = vec![[1.0, 2.0]];
            let spec = VeinSpec { sources_mm: points, ..VeinSpec::default() };
            let mut value = serde_json::to_value(spec).expect("plain data");
            let mut next = draw;
            for_each_number("", &mut value, &mut |_, value| {
                next += 0.1;
                *value = if value.is_u64() { Value::from(next as u64 + 1) } else { Value::from(next) };
            });
            value["scale"] = Value::from(scale);
            let spec: VeinSpec = serde_json::from_value(value).expect("the same settings");
            let mut lengths = 0;
            for ((key, was), (_, is)) in numbers(&spec).into_iter().zip(numbers(&spec.scaled())) {
                let is_laid = ["sources_mm", "guides.", "convergence."].iter().any(|k| key.starts_with(k));
                let expected = match key.as_str() {
                    "scale" => 1.0,
                    "spawn_rate" => was / (scale * scale),
                    _ if key.ends_with("_mm") && !is_laid => {
                        lengths += 1;
                        was * scale
                    }
                    _ => was,
                };
                prop_assert_eq!(is, expected, "{}", key);
            }
            prop_assert_eq!(lengths, 11);
        }
    }
}
