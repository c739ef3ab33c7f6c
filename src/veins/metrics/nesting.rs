//! How loops nest in loops: the hierarchical decomposition of a network.
//!
//! Sources: Katifori & Magnasco, PLoS ONE 7, 2012; Ronellenfitsch, Lasser, Daly & Katifori, PLoS
//! Comput. Biol. 11, 2015. Veins are taken away from the thinnest to the widest; each time two
//! areoles become one, the smaller over the larger number of areoles in them is noted. Nested loops
//! give nearly equal numbers (q near 1), a row of loops added one by one gives small ones. Veins on
//! the outer rim divide no areoles and are left alone.

use super::areoles::Areoles;
use super::network::Network;
use super::topology::Sets;
use crate::seed::{Seed, Stage};

/// Means of q over the unions of areoles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nesting {
    /// Every union counts the same.
    pub plain: f64,
    /// A union of d areoles counts d − 1.
    pub weighted: f64,
}

/// How often widths are shuffled for comparison: the mean then moves by some 0.002 on a thousand
/// areoles.
const SHUFFLES: usize = 8;

impl Nesting {
    /// The nesting of a network with these widths of its segments; `None` without two areoles side
    /// by side.
    #[must_use]
    pub fn of(areoles: &Areoles, widths: &[f64]) -> Option<Self> {
        let mut order: Vec<usize> = (0..widths.len()).collect();
        order.sort_by(|&a, &b| widths[a].total_cmp(&widths[b]));
        let mut sets = Sets::new(areoles.list.len());
        let mut sizes = vec![1.0f64; areoles.list.len()];
        let (mut count, mut sum, mut weight, mut weighted) = (0.0, 0.0, 0.0, 0.0);
        for segment in order {
            let [Some(a), Some(b)] = areoles.beside[segment] else { continue };
            let (a, b) = (sets.find(a), sets.find(b));
            let (size_a, size_b) = (sizes[a as usize], sizes[b as usize]);
            if !sets.unite(a, b) {
                continue;
            }
            sizes[b as usize] = size_a + size_b;
            let q = size_a.min(size_b) / size_a.max(size_b);
            count += 1.0;
            sum += q;
            weight += size_a + size_b - 1.0;
            weighted += q * (size_a + size_b - 1.0);
        }
        (count > 0.0).then(|| Self { plain: sum / count, weighted: weighted / weight })
    }

    /// The mean over networks whose widths were dealt anew among the segments that divide areoles.
    #[must_use]
    pub fn of_shuffled(network: &Network, areoles: &Areoles) -> Option<Self> {
        let mut rng = Seed(0).stream(Stage::Shuffle);
        let mut widths: Vec<f64> = network.segments().iter().map(|s| s.width).collect();
        let inner: Vec<usize> = (0..widths.len())
            .filter(|&i| matches!(areoles.beside[i], [Some(a), Some(b)] if a != b))
            .collect();
        let (mut plain, mut weighted) = (0.0, 0.0);
        for _ in 0..SHUFFLES {
            for i in (1..inner.len()).rev() {
                let j = (rng.unit() * (i + 1) as f64) as usize;
                widths.swap(inner[i], inner[j]);
            }
            let nesting = Self::of(areoles, &widths)?;
            plain += nesting.plain / SHUFFLES as f64;
            weighted += nesting.weighted / SHUFFLES as f64;
        }
        Some(Self { plain, weighted })
    }
}
