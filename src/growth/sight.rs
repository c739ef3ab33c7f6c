//! What is inside a blade at a step, and what sees what there.

use glam::DVec2;

use super::GrowingBlade;

impl GrowingBlade {
    /// Whether `p` lies inside the blade at a step.
    #[must_use]
    pub fn is_inside(&self, p: DVec2, step: u64) -> bool {
        self.edges.contains(p) && self.birth_step(p).is_some_and(|birth| birth <= step)
    }

    /// The first step at which the margin has passed the place `p` of the mature blade; `None` when
    /// that is after the last step.
    #[must_use]
    pub fn birth_step(&self, p: DVec2) -> Option<u64> {
        let Some(sweep) = &self.sweep else { return Some(self.schedule.first) };
        let scale = sweep.scale_reaching(p);
        if self.rates.is_none() {
            return self.schedule.first_at_least(scale);
        }
        let (mut low, mut high) = (self.schedule.first, self.schedule.last + 1);
        while low < high {
            let middle = low.midpoint(high);
            if self.passed(middle) >= scale { high = middle } else { low = middle + 1 }
        }
        (low <= self.schedule.last).then_some(low)
    }

    /// Whether `p` lies inside the mature blade.
    #[must_use]
    pub fn covers(&self, p: DVec2) -> bool {
        self.edges.contains(p)
    }

    /// Whether the margin or a cut stands between two points inside the blade.
    #[must_use]
    pub fn blocks_sight(&self, a: DVec2, b: DVec2, step: u64) -> bool {
        !self.convex && (self.blocks_sight_for_ever(a, b) || self.blocks_sight_yet(a, b, step))
    }

    /// Whether the mature margin or a cut stands between two points, so that they will never see
    /// each other.
    #[must_use]
    pub fn blocks_sight_for_ever(&self, a: DVec2, b: DVec2) -> bool {
        !self.convex && (self.edges.touches(a, b) || self.cuts.touches(a, b))
    }

    /// Whether tissue that is still to come lies between two points.
    #[must_use]
    pub fn blocks_sight_yet(&self, a: DVec2, b: DVec2, step: u64) -> bool {
        let Some(sweep) = &self.sweep else { return false };
        !self.convex && sweep.touches(a, b, self.passed(step))
    }

    /// Whether sight is never blocked: a convex blade without cuts.
    #[must_use]
    pub fn is_convex(&self) -> bool {
        self.convex
    }
}
