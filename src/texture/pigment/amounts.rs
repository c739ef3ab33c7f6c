//! Amounts of pigments: what is given of a blade's tissue, its veins and its lower side.

use super::SenescenceSpec;
use crate::parameter::parameters;

parameters! {
    /// Pigments and structure of a tissue. Green leaves hold 25–75 µg/cm² of chlorophyll and a fifth
    /// of that of carotenoid.
    pub struct Amounts {
        /// Chlorophyll.
        chlorophyll_ug_cm2: number(42.0, 0.0..=120.0, "µg/cm²"),
        /// Carotenoid: yellow, hidden by chlorophyll.
        carotenoid_ug_cm2: number(9.0, 0.0..=40.0, "µg/cm²"),
        /// Anthocyanin: red.
        anthocyanin_ug_cm2: number(0.7, 0.0..=60.0, "µg/cm²"),
        /// Brown: 0 living, 1 dead, 2.5 dark litter.
        brown: number(0.0, 0.0..=3.0, ""),
        /// Plates of tissue: 1.2 thin and clear, 2.2 thick and pale.
        structure: number(1.6, 1.0..=3.2, "plates"),
    }
}

parameters! {
    /// Pigments of a blade.
    pub struct PigmentSpec {
        /// The tissue.
        leaf: group(Amounts, Amounts::default()),
        /// The second tissue, spread by `colour.type`.
        alternate: group(Amounts, Amounts {
            chlorophyll_ug_cm2: 9.0,
            carotenoid_ug_cm2: 6.0,
            ..Amounts::default()
        }),
        /// Chlorophyll in the veins, as a share of the tissue's.
        vein_chlorophyll: number(0.22, 0.0..=2.0, ""),
        /// Plates that the largest veins have more than the tissue.
        vein_structure: number(0.9, 0.0..=2.0, "plates"),
        /// Chlorophyll of the lower side, as a share of the upper one's.
        back_chlorophyll: number(0.55, 0.0..=2.0, ""),
        /// Plates that the lower side has more.
        back_structure: number(0.4, 0.0..=2.0, "plates"),
        /// Bloom of the lower side, wax or hair: 0 none, 1 white.
        back_bloom: number(0.12, 0.0..=1.0, ""),
        /// Brown of the lower side: the rusty felt of some leaves.
        back_brown: number(0.0, 0.0..=3.0, ""),
        /// Anthocyanin of the lower side's felt: it makes brown rusty.
        back_anthocyanin_ug_cm2: number(0.0, 0.0..=60.0, "µg/cm²"),
        /// Bloom of the upper side.
        front_bloom: number(0.0, 0.0..=1.0, ""),
        /// Anthocyanin of a leaf that has just unfolded.
        flush_anthocyanin_ug_cm2: number(0.4, 0.0..=60.0, "µg/cm²"),
        /// How it turns in autumn.
        autumn: group(SenescenceSpec, SenescenceSpec::default()),
    }
}

impl Amounts {
    /// Chlorophyll, carotenoid, anthocyanin, brown, structure.
    #[must_use]
    pub fn of([chlorophyll, carotenoid, anthocyanin, brown, structure]: [f64; 5]) -> Self {
        Self {
            chlorophyll_ug_cm2: chlorophyll,
            carotenoid_ug_cm2: carotenoid,
            anthocyanin_ug_cm2: anthocyanin,
            brown,
            structure,
        }
    }

    /// The inverse of [`of`](Self::of).
    #[must_use]
    pub fn array(&self) -> [f64; 5] {
        [
            self.chlorophyll_ug_cm2,
            self.carotenoid_ug_cm2,
            self.anthocyanin_ug_cm2,
            self.brown,
            self.structure,
        ]
    }
}
