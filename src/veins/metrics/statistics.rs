//! Summaries of samples. Nothing of an empty sample is known, so everything is an `Option`.

/// The mean.
pub(super) fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// The standard deviation of the sample as a whole (divisor n).
pub(super) fn deviation(values: &[f64]) -> Option<f64> {
    let mean = mean(values)?;
    let squares = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>();
    Some((squares / values.len() as f64).sqrt())
}

/// Deviation over mean.
pub(super) fn variation(values: &[f64]) -> Option<f64> {
    mean(values).filter(|mean| *mean != 0.0).and_then(|mean| Some(deviation(values)? / mean))
}

/// The value below which the share `q` of the sample lies, linear between two values.
pub(super) fn quantile(values: &[f64], q: f64) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let place = q * sorted.len().checked_sub(1)? as f64;
    let (low, high) = (sorted[place.floor() as usize], sorted[place.ceil() as usize]);
    // Infinite neighbours have no values between them.
    Some(if low == high { low } else { low + (high - low) * place.fract() })
}

/// The value in the middle.
pub(super) fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// The share of the sample that is as asked.
pub(super) fn share<T>(items: &[T], is: impl Fn(&T) -> bool) -> Option<f64> {
    let count = items.iter().filter(|item| is(item)).count();
    (!items.is_empty()).then(|| count as f64 / items.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn summaries_of_a_known_sample() {
        let sample = [4.0, 1.0, 3.0, 2.0];
        assert_eq!(mean(&sample), Some(2.5));
        assert_eq!(median(&sample), Some(2.5));
        assert_eq!(quantile(&sample, 1.0), Some(4.0));
        assert_eq!(deviation(&sample), Some(1.25f64.sqrt()));
        assert_eq!(share(&sample, |v| *v > 3.0), Some(0.25));
        assert_eq!(median(&[1.0, f64::INFINITY, f64::INFINITY]), Some(f64::INFINITY));
    }

    #[test]
    fn nothing_is_known_of_nothing() {
        assert_eq!(
            (mean(&[]), median(&[]), deviation(&[]), variation(&[])),
            (None, None, None, None)
        );
    }
}
