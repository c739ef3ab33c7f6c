//! How far nodes may lie from a place, by direction: no farther than the blade reaches.
//!
//! The blade is held between pairs of parallel lines, one for each of some directions; for a narrow wedge
//! seen from a place each line says how far what lies before it can be.

use glam::DVec2;

use crate::geometry::Rect;
use crate::growth::Metric;

/// Wedges around a place; wedge i lies between the rays i and i + 1.
pub(super) const WEDGES: usize = 24;

/// Lines that face more than so many wedges away from a wedge say nothing of use.
const ASIDE: usize = 5;

/// The blade by direction, and the directions.
#[derive(Debug)]
pub(super) struct Horizon {
    outline: Vec<DVec2>,
    bounds: Rect,
    /// Far above rounding.
    slack: f64,
    rays: [DVec2; WEDGES],
    /// Directions of the middles of the wedges.
    middles: [DVec2; WEDGES],
    /// 1 over the cosine between the far ray of a wedge and the middle of another, by how many wedges
    /// lie between.
    per_cosine: [f64; ASIDE + 1],
    stretch: DVec2,
    /// How far the stretched blade reaches in the direction of each middle.
    reach: [f64; WEDGES],
}

impl Horizon {
    /// Of a blade with an outline in the frame of the mature leaf.
    pub(super) fn new(outline: &[DVec2]) -> Self {
        let wedge = std::f64::consts::TAU / WEDGES as f64;
        let unit = |turns: f64| DVec2::new(libm::cos(turns * wedge), libm::sin(turns * wedge));
        let bounds = Rect::around(outline.iter().copied());
        Self {
            outline: outline.to_vec(),
            bounds,
            slack: 1e-6 * bounds.size().max_element(),
            rays: std::array::from_fn(|i| unit(i as f64)),
            middles: std::array::from_fn(|i| unit(i as f64 + 0.5)),
            per_cosine: std::array::from_fn(|i| 1.0 / libm::cos((i as f64 + 0.5) * wedge)),
            stretch: DVec2::ZERO,
            reach: [0.0; WEDGES],
        }
    }

    /// Follows the proportions of the blade.
    pub(super) fn follow(&mut self, metric: Metric) {
        if metric.is_warped() || metric.stretch == self.stretch {
            return;
        }
        self.stretch = metric.stretch;
        for (reach, &way) in self.reach.iter_mut().zip(&self.middles) {
            let along = self.outline.iter().map(|&p| (p * metric.stretch).dot(way));
            *reach = along.fold(f64::NEG_INFINITY, f64::max);
        }
    }

    pub(super) fn ray(&self, i: usize) -> DVec2 {
        self.rays[i % WEDGES]
    }

    /// From where on there is no node in each wedge seen from `s`.
    pub(super) fn distances(&self, s: DVec2, metric: Metric) -> [f64; WEDGES] {
        let before: [f64; WEDGES] = if metric.is_warped() {
            // Straight edges are bent: the box holds them, and what is between.
            let (low, high) = metric.corners_from(s, self.bounds);
            self.middles.map(|way| {
                way.x * if way.x > 0.0 { high.x } else { low.x }
                    + way.y * if way.y > 0.0 { high.y } else { low.y }
            })
        } else {
            let s = metric.place(s);
            std::array::from_fn(|i| self.reach[i] - s.dot(self.middles[i]))
        };
        let before = before.map(|distance| distance.max(0.0) + self.slack);
        std::array::from_fn(|i| {
            let by_line = |aside: usize| {
                let (left, right) = ((i + aside) % WEDGES, (i + WEDGES - aside) % WEDGES);
                before[left].min(before[right]) * self.per_cosine[aside]
            };
            (0..=ASIDE).map(by_line).fold(f64::INFINITY, f64::min)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::growth::{GrowingBlade, GrowthSpec, GrowthType};
    use crate::margin::{self, MarginSpec};
    use crate::seed::{Seed, Stage};

    #[test]
    fn nothing_in_the_blade_lies_beyond_the_horizon() {
        let margin = margin::build(&MarginSpec::default(), Seed(1)).expect("the default margin");
        let mut horizon = Horizon::new(margin.outline());
        let bounds = margin.bounds();
        let mut rng = Seed(3).stream(Stage::Tissue);
        for r#type in [GrowthType::Isotropic, GrowthType::Anisotropic, GrowthType::NonUniform] {
            let growth = GrowthSpec { r#type, ..GrowthSpec::default() };
            let blade = GrowingBlade::new(margin.clone(), &growth).expect("it grows");
            let frame = blade.frame(150);
            let metric = frame.metric();
            horizon.follow(metric);
            let mut inside = || loop {
                let p = bounds.min + bounds.size() * DVec2::new(rng.unit(), rng.unit());
                if blade.covers(p) {
                    return p;
                }
            };
            let mut closest = f64::INFINITY;
            for _ in 0..200 {
                let s = inside();
                let distances = horizon.distances(s, metric);
                for p in (0..100).map(|_| inside()).chain(margin.outline().iter().copied()) {
                    let way = metric.between(s, p);
                    let turn = libm::atan2(way.y, way.x).rem_euclid(std::f64::consts::TAU);
                    let wedge = turn / std::f64::consts::TAU * WEDGES as f64;
                    let left = distances[wedge as usize % WEDGES] - way.length();
                    assert!(left >= 0.0, "{type:?}: {s} sees {p} beyond");
                    closest = closest.min(left / way.length());
                }
            }
            assert!(closest < 0.3, "{type:?}: a horizon that far is none: {closest}");
        }
    }
}
