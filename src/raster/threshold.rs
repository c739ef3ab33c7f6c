//! Automatic threshold.
//!
//! Source: Otsu, "A threshold selection method from gray-level histograms", IEEE Trans. SMC 9,
//! 1979.

/// How a histogram splits in two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Split {
    /// Where, in bins (a bin's middle is at its index): between the two classes; the middle of the
    /// gap when there is one.
    pub at: f64,
    /// Mean of the lower class, in bins.
    pub low: f64,
    /// Mean of the upper class, in bins.
    pub high: f64,
    /// Share of the variance that the split explains, 0 to 1.
    pub separation: f64,
}

/// The split of a histogram that explains most of its variance; `None` when it has one value only.
#[must_use]
pub fn otsu(histogram: &[u64]) -> Option<Split> {
    let total: f64 = histogram.iter().map(|&n| n as f64).sum();
    let moment = |power: i32| -> f64 {
        histogram.iter().enumerate().map(|(i, &n)| n as f64 * (i as f64).powi(power)).sum()
    };
    let sum = moment(1);
    let variance = moment(2) / total - (sum / total).powi(2);
    let (mut below, mut sum_below) = (0.0, 0.0);
    // Best between-class variance; the first and last split that reach it; the class means.
    let mut best: Option<(f64, usize, usize, f64, f64)> = None;
    for (i, &n) in histogram.iter().enumerate() {
        below += n as f64;
        sum_below += n as f64 * i as f64;
        let above = total - below;
        if below == 0.0 || above <= 0.0 {
            continue;
        }
        let (low, high) = (sum_below / below, (sum - sum_below) / above);
        let between = below * above * (high - low).powi(2) / (total * total);
        match &mut best {
            // Empty bins leave it as it is: the split may lie anywhere in the gap.
            Some((most, _, last, ..)) if n == 0 && *last + 1 == i && between >= *most => *last = i,
            Some((most, ..)) if between <= *most => {}
            _ => best = Some((between, i, i, low, high)),
        }
    }
    let (between, first, last, low, high) = best?;
    let at = (first + last) as f64 * 0.5 + 0.5;
    Some(Split { at, low, high, separation: between / variance })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_spikes_split_half_way() {
        let mut histogram = [0u64; 256];
        histogram[10] = 900;
        histogram[210] = 100;
        let split = otsu(&histogram).expect("two values");
        assert_eq!(split.at, 110.0);
        assert_eq!((split.low, split.high), (10.0, 210.0));
        assert!((split.separation - 1.0).abs() < 1e-9);
    }

    #[test]
    fn one_value_does_not_split() {
        let mut histogram = [0u64; 256];
        histogram[10] = 900;
        assert_eq!(otsu(&histogram), None);
        assert_eq!(otsu(&[]), None);
    }
}
