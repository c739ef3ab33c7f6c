//! Junctions of three veins: angles, widths, and the laws that tie them.
//!
//! Veins are ranked by width, w₁ ≥ w₂ ≥ w₃; an angle is that between the directions of two veins.
//! Sources of the laws: Murray, PNAS 12, 1926 (w₁ⁿ = w₂ⁿ + w₃ⁿ); Bohn, Andreotti, Douady, Munzinger
//! & Couder, Phys. Rev. E 65, 2002 (veins pull with a force of their width, and junctions are in
//! balance).

use glam::DVec2;

use super::network::{Network, split};
use super::statistics::median;

/// How far from a junction the direction of a vein is taken, in lengths of the segment: all of it,
/// the chord to its other end.
const REACH: f64 = f64::INFINITY;

/// A junction of three veins, the widest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Junction {
    /// Widths, from the widest.
    pub widths: [f64; 3],
    /// Directions of the veins, of length 1.
    pub directions: [DVec2; 3],
}

impl Junction {
    /// The angles between veins 1 and 2, 1 and 3, 2 and 3 (degrees, at most 180).
    #[must_use]
    pub fn angles(&self) -> [f64; 3] {
        let [a, b, c] = self.directions;
        [(a, b), (a, c), (b, c)].map(|(a, b)| a.perp_dot(b).abs().atan2(a.dot(b)).to_degrees())
    }

    /// ‖Σ wᵖ e‖ / Σ wᵖ: 0 when veins that pull with wᵖ are in balance.
    #[must_use]
    pub fn imbalance(&self, p: f64) -> f64 {
        let pulls = self.widths.map(|width| (width / self.widths[0]).powf(p));
        let sum: DVec2 = pulls.iter().zip(self.directions).map(|(&pull, e)| e * pull).sum();
        sum.length() / pulls.iter().sum::<f64>()
    }

    /// w₃/w₁.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        self.widths[2] / self.widths[0]
    }

    /// The n of w₁ⁿ = w₂ⁿ + w₃ⁿ; infinite when the two widest are equal.
    #[must_use]
    pub fn murray_exponent(&self) -> f64 {
        let [a, b] = [self.widths[1], self.widths[2]].map(|width| width / self.widths[0]);
        if a >= 1.0 {
            return f64::INFINITY;
        }
        // The sum falls from 2 at n = 0 towards 0; 60 halvings reach rounding.
        let (mut low, mut high) = (0.0, 1000.0);
        for _ in 0..60 {
            let n = f64::midpoint(low, high);
            if a.powf(n) + b.powf(n) > 1.0 { low = n } else { high = n }
        }
        low
    }

    /// (w₂² + w₃²) / w₁²: 1 when the cross-section is kept.
    #[must_use]
    pub fn area_ratio(&self) -> f64 {
        let [a, b, c] = self.widths;
        (b * b + c * c) / (a * a)
    }
}

/// The junctions of three veins. Those where a vein comes back to itself or has no direction are
/// left out.
#[must_use]
pub fn junctions(network: &Network) -> Vec<Junction> {
    let incidence = network.incidence();
    let segments = network.segments();
    let at = |node: usize| {
        let leaving: [u32; 3] = incidence.at(node).try_into().ok()?;
        let mut veins = leaving.map(|half_edge| {
            let (segment, side) = split(half_edge);
            (segments[segment].width, segments[segment].direction(side, REACH), segment)
        });
        veins.sort_by(|a, b| b.0.total_cmp(&a.0));
        let [a, b, c] = veins.map(|vein| vein.2);
        let sound = veins.iter().all(|vein| vein.1 != DVec2::ZERO && vein.0 > 0.0);
        (sound && a != b && a != c && b != c).then(|| Junction {
            widths: veins.map(|vein| vein.0),
            directions: veins.map(|vein| vein.1),
        })
    };
    (0..network.nodes().len()).filter_map(at).collect()
}

/// The exponents p that are tried for the balance of forces.
const BALANCE_EXPONENTS: std::ops::RangeInclusive<u32> = 0..=60;

/// The p at which the median imbalance is least, to 0.05; the middle of those that are equal.
#[must_use]
pub fn balanced_exponent(junctions: &[Junction]) -> Option<f64> {
    let residual = |step: u32| {
        let p = f64::from(step) * 0.05;
        let all: Vec<f64> = junctions.iter().map(|junction| junction.imbalance(p)).collect();
        Some((p, median(&all)?))
    };
    let all: Vec<(f64, f64)> = BALANCE_EXPONENTS.filter_map(residual).collect();
    let least = all.iter().map(|&(_, residual)| residual).fold(f64::INFINITY, f64::min);
    let best: Vec<f64> =
        all.iter().filter(|entry| entry.1 <= least + 1e-9).map(|&(p, _)| p).collect();
    Some(f64::midpoint(*best.first()?, *best.last()?))
}
