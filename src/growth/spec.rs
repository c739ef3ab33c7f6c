//! The settings of growth, and why a blade cannot grow.

use super::rates::RateSpec;
use crate::margin::MarginError;
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
        /// At rates that differ with place and age (`growth.rates`); what is inside is carried along.
        NonUniform = "non-uniform",
    }
}

parameters! {
    /// Growth of the blade, in steps (Foster, appendix B.2).
    pub struct GrowthSpec {
        /// How the blade grows: `none`, `marginal`, `isotropic`, `anisotropic` or `non-uniform`.
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
        /// Rates by place and age, for `type = "non-uniform"`.
        rates: group(RateSpec, RateSpec::default()),
    }
}

/// Why a blade cannot grow.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GrowthError {
    /// A setting is out of its limits, or contradicts another.
    #[error("{key} = {value} {problem}")]
    Setting {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// The limit and what to change.
        problem: String,
    },
    /// The blade is not a proper margin at some age, mostly because it is too small.
    #[error("the blade at step {step} is no margin: {source}; raise growth.scale")]
    Margin {
        /// The step.
        step: u64,
        /// What is wrong with it.
        source: MarginError,
    },
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_read_as_they_are_written() {
        for word in GrowthType::ALL {
            assert_eq!(word.to_string().parse(), Ok(*word));
        }
        let unknown = "uneven".parse::<GrowthType>().expect_err("no such word").to_string();
        assert!(unknown.starts_with("`uneven` is none of none, marginal, "), "{unknown}");
    }
}
