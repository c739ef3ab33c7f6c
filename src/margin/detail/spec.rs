//! The knobs of teeth, waves and roughness.

use crate::parameter::{parameters, words};

words! {
    /// What the teeth are like (Ellis et al. 2009).
    pub enum ToothType {
        /// No teeth: an entire margin.
        None = "none",
        /// Pointed, leaning towards the tip of the leaf or lobe.
        Serrate = "serrate",
        /// Pointed, standing upright on the margin.
        Dentate = "dentate",
        /// Rounded, without a point.
        Crenate = "crenate",
    }
}

parameters! {
    /// Teeth along the margin: from base or valley to the tip, on both sides and on every lobe.
    pub struct TeethSpec {
        /// What the teeth are like: `serrate` lean to the tip, `dentate` stand upright, `crenate` are
        /// rounded; `none` for an entire margin.
        r#type: choice(ToothType, ToothType::None),
        /// Teeth of the first order on each side (on the longest edge of a lobed blade, on others by
        /// their length); 0 to go by `per_cm`.
        count: count(0, 0..=400, "per side"),
        /// Teeth of the first order on a centimetre of the margin, where `count` is 0.
        per_cm: number(3.0, 0.05..=60.0, "per cm"),
        /// How high a tooth stands over the sinuses. Half of it lies outside the margin without teeth.
        /// Teeth that would touch another part of the margin are made smaller until they do not.
        depth: number(0.35, 0.0..=2.0, "spacings"),
        /// How far the tip of a serrate or crenate tooth stands towards the tip of the leaf: 0 over
        /// the middle of the tooth, 0.5 over its upper sinus, more for hooked teeth.
        lean: number(0.3, 0.0..=1.0, "spacings"),
        /// How much closer teeth stand at the tip than at the base.
        spacing_change: number(0.3, -0.9..=0.9, ""),
        /// How unevenly large: up to 0.25 the teeth are regular (the least spacing is 60 % of the
        /// greatest).
        irregularity: number(0.12, 0.0..=0.9, ""),
        /// Where teeth begin on the way from the base or valley to the tip.
        from: number(0.05, 0.0..=0.95, "sides"),
        /// Where they end.
        to: number(0.97, 0.05..=1.0, "sides"),
        /// Over this part at either end of the teeth they fade.
        end_fade: number(0.08, 0.0..=0.5, "sides"),
        /// How round the tips are: 0 pointed, 1 rounded from half-way up the flanks.
        tip_rounding: number(0.0, 0.0..=1.0, ""),
        /// How round the sinuses are: 0 angular, 1 rounded from half-way down the flanks.
        sinus_rounding: number(0.0, 0.0..=1.0, ""),
        /// The flank towards the base: 1 convex, 0 straight, -1 concave.
        proximal_bow: number(0.2, -1.0..=1.0, ""),
        /// The flank towards the tip: 1 convex, 0 straight, -1 concave.
        distal_bow: number(0.0, -1.0..=1.0, ""),
        /// S-shape of the flank towards the base: 1 flexuous, -1 retroflexed.
        proximal_flexure: number(0.0, -1.0..=1.0, ""),
        /// S-shape of the flank towards the tip: 1 flexuous, -1 retroflexed.
        distal_flexure: number(0.0, -1.0..=1.0, ""),
        /// Teeth of the second order, on the flanks of the first.
        second: group(SmallTeethSpec, SmallTeethSpec::default()),
        /// Teeth of the third order, on the flanks of the second.
        third: group(SmallTeethSpec, SmallTeethSpec::default()),
        /// A bristle on each tooth of the first order, as of chestnut; 0 for none.
        bristle_mm: number(0.0, 0.0..=20.0, "mm"),
        /// A round gland on each tooth of the first order: its diameter; 0 for none.
        gland_mm: number(0.0, 0.0..=3.0, "mm"),
    }
}

parameters! {
    /// Teeth on the flanks of larger teeth, of the same form as these.
    pub struct SmallTeethSpec {
        /// How many each larger tooth carries, on its flanks by their length; 0 for none.
        count: count(0, 0..=12, "per tooth"),
        /// How high they stand.
        depth: number(0.35, 0.0..=2.0, "spacings"),
        /// How many of those on the flank towards the tip there are: 0 leaves that flank bare, as in
        /// birches.
        distal_share: number(1.0, 0.0..=1.0, ""),
    }
}

parameters! {
    /// Waves of the margin, as of a sinuate or undulate one, by noise along it.
    pub struct WaveSpec {
        /// How far the margin swings to either side; 0 for none.
        height: number(0.0, 0.0..=0.2, "lengths"),
        /// Waves on each side (on the longest edge of a lobed blade, on others by their length).
        count: number(6.0, 0.5..=60.0, "per side"),
        /// How unlike each other they are: 0 even waves, 1 noise.
        irregularity: number(0.4, 0.0..=1.0, ""),
        /// Where waves begin on the way from the base or valley to the tip.
        from: number(0.0, 0.0..=0.95, "sides"),
    }
}

parameters! {
    /// Fine unevenness of the margin, by noise along it.
    pub struct RoughnessSpec {
        /// How far the margin strays to either side; 0 for none.
        height_mm: number(0.0, 0.0..=5.0, "mm"),
        /// The length of its coarsest bumps.
        grain_mm: number(2.0, 0.1..=100.0, "mm"),
    }
}
