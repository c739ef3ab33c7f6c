//! How the blade changes with age.
//!
//! Everything is kept in the frame of the mature leaf, where tissue that moves with the blade stands
//! still and the distances of the model shrink instead; [`GrowingBlade::carry`] goes between ages.

use crate::margin::Margin;
use crate::parameter::{parameters, words};

words! {
    /// How the blade grows (Foster, appendix B.2).
    pub enum GrowthType {
        /// Full size from the first step on.
        None = "none",
        /// New tissue at the margin only; what is inside does not move.
        Marginal = "marginal",
        /// The same rate in both directions; what is inside is carried along.
        Isotropic = "isotropic",
        /// Different rates across and along; what is inside is carried along.
        Anisotropic = "anisotropic",
    }
}

parameters! {
    /// Growth of the blade, in steps (Foster, appendix B.2).
    pub struct GrowthSpec {
        /// How the blade grows: `none`, `marginal`, `isotropic` or `anisotropic`.
        r#type: choice(GrowthType, GrowthType::Isotropic),
        /// Steps from the first margin to the mature one (not for anisotropic growth).
        total_steps: count(400, 1..=100_000, "steps"),
        /// Steps of growth across the blade, for anisotropic growth.
        horizontal_steps: count(300, 1..=100_000, "steps"),
        /// Steps of growth along the blade, for anisotropic growth.
        vertical_steps: count(400, 1..=100_000, "steps"),
        /// The step at which veins begin; near the total they come out straight.
        start_step: count(100, 0..=100_000, "steps"),
        /// Share of the steps that are made: below 1 the leaf stays a bud of that age.
        scale: number(1.0, 0.01..=1.0, ""),
    }
}

/// A blade at every age.
#[derive(Debug, Clone)]
pub struct GrowingBlade {
    margin: Margin,
    spec: GrowthSpec,
}

impl GrowingBlade {
    /// The mature margin.
    #[must_use]
    pub fn mature(&self) -> &Margin {
        &self.margin
    }

    /// Its growth.
    #[must_use]
    pub fn spec(&self) -> &GrowthSpec {
        &self.spec
    }
}
