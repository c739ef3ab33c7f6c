//! The size of the blade at every step.
//!
//! Source: Foster, who prints two formulas for the first margin. Here the margin at step t of G is
//! the mature one scaled about the base by s(t) = (1 + t) / (1 + G): it starts with area and ends
//! exactly on the given outline. Anisotropic growth runs G = max(G_h, G_v) steps; the axis with
//! fewer steps starts closer to its goal, s_x(t) = (1 + (G − G_h) + t·G_h / G) / (1 + G), so both end
//! at 1 (the printed rate overshoots).

use glam::DVec2;

use super::{EvenGrowth, GrowthError, GrowthSpec, GrowthType};

/// More steps than this are a slip of the keyboard: the longest runs in Foster's tables have 5000.
const MAX_STEPS: u64 = 100_000;

/// The steps that are run and the scale at each.
#[derive(Debug, Clone)]
pub(super) struct Schedule {
    pub(super) first: u64,
    pub(super) last: u64,
    total: u64,
    /// Steps of growth across and along.
    axes: [u64; 2],
    grows: bool,
}

impl Schedule {
    pub(super) fn new(spec: &GrowthSpec) -> Result<Self, GrowthError> {
        let anisotropic = spec.r#type == GrowthType::Anisotropic
            || (spec.r#type == GrowthType::NonUniform
                && spec.rates.even_growth == EvenGrowth::Anisotropic);
        let axes = if anisotropic {
            [spec.horizontal_steps, spec.vertical_steps]
        } else {
            [spec.total_steps; 2]
        };
        let keys: [&'static str; 2] = if anisotropic {
            ["growth.horizontal_steps", "growth.vertical_steps"]
        } else {
            ["growth.total_steps"; 2]
        };
        let setting = |key, value, problem| Err(GrowthError::Setting { key, value, problem });
        for (key, steps) in keys.into_iter().zip(axes) {
            if !(1..=MAX_STEPS).contains(&steps) {
                let problem = format!("must be a whole number from 1 to {MAX_STEPS}");
                return setting(key, steps as f64, problem);
            }
        }
        let total = axes[0].max(axes[1]);
        if spec.start_step > total {
            let problem = format!("must be at most the total number of steps ({total})");
            return setting("growth.start_step", spec.start_step as f64, problem);
        }
        if !(spec.scale > 0.0 && spec.scale <= 1.0) {
            let problem = "must be above 0 and at most 1".to_owned();
            return setting("growth.scale", spec.scale, problem);
        }
        let scaled = |steps: u64| (steps as f64 * spec.scale).round() as u64;
        let grows = spec.r#type != GrowthType::None;
        Ok(Self { first: scaled(spec.start_step), last: scaled(total), total, axes, grows })
    }

    pub(super) fn is_uneven(&self) -> bool {
        self.axes[0] != self.axes[1]
    }

    pub(super) fn scale(&self, step: u64) -> DVec2 {
        if !self.grows {
            return DVec2::ONE;
        }
        self.scale_at_age(step.min(self.total) as f64)
    }

    /// Steps from the first margin to the mature one.
    pub(super) fn total(&self) -> u64 {
        self.total
    }

    /// The scale at an age in steps, of a blade that grows.
    pub(super) fn scale_at_age(&self, t: f64) -> DVec2 {
        let total = self.total as f64;
        let along =
            |axis: u64| (1.0 + (total - axis as f64) + t * axis as f64 / total) / (1.0 + total);
        DVec2::new(along(self.axes[0]), along(self.axes[1]))
    }

    /// The first step that is run with a scale of at least `scale`, for equal axes; `None` when that
    /// is after the last.
    pub(super) fn first_at_least(&self, scale: f64) -> Option<u64> {
        // The formula solved for t, then put right for rounding.
        let guess = (scale * (1.0 + self.total as f64) - 1.0).ceil();
        let mut step = (guess.max(self.first as f64).min(self.last as f64 + 1.0)) as u64;
        while step > self.first && self.scale(step - 1).x >= scale {
            step -= 1;
        }
        while step <= self.last && self.scale(step).x < scale {
            step += 1;
        }
        (step <= self.last).then_some(step)
    }
}
