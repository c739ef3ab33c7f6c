//! Pairs between two rows that keep their order.
//!
//! Source: Needleman & Wunsch, "A general method applicable to the search for similarities in the amino
//! acid sequence of two proteins", J. Mol. Biol. 48, 1970, with gaps that cost nothing.

/// For each of `n` things in a row the one of `m` others, in a row too, that it is paired with: no two
/// pairs cross, and the sum of their gains is greatest. Ties leave the later ones unpaired.
///
/// `gain(i, j)` may be −∞ for what must not be paired. Time and memory n·m.
#[must_use]
pub fn in_order(n: usize, m: usize, gain: impl Fn(usize, usize) -> f64) -> Vec<Option<usize>> {
    // best[i][j]: the most that the first i get from the first j.
    let mut best = vec![vec![0.0_f64; m + 1]; n + 1];
    for i in 1..=n {
        for j in 1..=m {
            let paired = best[i - 1][j - 1] + gain(i - 1, j - 1);
            best[i][j] = paired.max(best[i - 1][j]).max(best[i][j - 1]);
        }
    }
    let mut pairs = vec![None; n];
    let (mut i, mut j) = (n, m);
    while i > 0 && j > 0 {
        if best[i][j] == best[i - 1][j] {
            i -= 1;
        } else if best[i][j] == best[i][j - 1] {
            j -= 1;
        } else {
            (i, j) = (i - 1, j - 1);
            pairs[i] = Some(j);
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn no_other_pairs_in_order_gain_more() {
        /// The most that the rest can gain, by trying everything.
        fn most(i: usize, j: usize, gains: &[Vec<f64>]) -> f64 {
            if i == gains.len() || j == gains[i].len() {
                return 0.0;
            }
            let paired = gains[i][j] + most(i + 1, j + 1, gains);
            paired.max(most(i + 1, j, gains)).max(most(i, j + 1, gains))
        }
        let mut rng = Seed(4).stream(Stage::Guides);
        for _ in 0..200 {
            let [n, m] = std::array::from_fn(|_| 1 + (rng.bits() % 5) as usize);
            let gains: Vec<Vec<f64>> =
                (0..n).map(|_| (0..m).map(|_| rng.between(-1.0, 2.0)).collect()).collect();
            let pairs = in_order(n, m, |i, j| gains[i][j]);
            let partners: Vec<usize> = pairs.iter().copied().flatten().collect();
            assert!(partners.is_sorted_by(|a, b| a < b), "{pairs:?}");
            let sum: f64 = (0..n).filter_map(|i| pairs[i].map(|j| gains[i][j])).sum();
            assert!((sum - most(0, 0, &gains)).abs() < 1e-12, "{pairs:?} of {gains:?}");
        }
    }

    #[test]
    fn what_must_not_be_paired_is_not() {
        assert_eq!(in_order(2, 3, |_, _| f64::NEG_INFINITY), [None, None]);
        assert_eq!(in_order(0, 3, |_, _| 1.0), []);
    }
}
