//! Places on lines whose points are numbered by a measure that rises along them, such as the way.

/// The stretch between two of some measures, which rise, that holds a value, and where in it the value
/// lies, from 0 to 1: a value outside is taken to the nearest end. Takes one measure at least; logarithmic.
#[must_use]
pub fn stretch(measures: &[f64], value: f64) -> (usize, f64) {
    let last = measures.len() - 1;
    let i = measures.partition_point(|&measure| measure <= value).clamp(1, last.max(1)) - 1;
    let long = measures[(i + 1).min(last)] - measures[i];
    (i, if long > 0.0 { ((value - measures[i]) / long).clamp(0.0, 1.0) } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_between_and_kept_within_the_ends() {
        let measures = [0.0, 1.0, 1.0, 3.0];
        let cases = [
            (-1.0, (0, 0.0)),
            (0.25, (0, 0.25)),
            (1.0, (2, 0.0)),
            (2.0, (2, 0.5)),
            (9.0, (2, 1.0)),
        ];
        for (value, found) in cases {
            assert_eq!(stretch(&measures, value), found, "{value}");
        }
        assert_eq!(stretch(&[2.0], 2.0), (0, 0.0));
    }
}
