//! Numbers as text files take them.

/// A number with so many decimal places at most, without trailing zeros and never in scientific notation.
pub(super) fn decimal(value: f64, places: usize) -> String {
    let printed = format!("{value:.places$}");
    let printed =
        if places > 0 { printed.trim_end_matches('0').trim_end_matches('.') } else { &printed };
    if printed == "-0" { "0".into() } else { printed.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_as_short_as_its_places_allow() {
        for (value, places, expected) in [
            (1.5, 7, "1.5"),
            (-2.0, 4, "-2"),
            (1e-9, 7, "0"),
            (-1e-9, 7, "0"),
            (1_234_567.0, 4, "1234567"),
            (0.123_456_78, 4, "0.1235"),
            (1e21, 2, "1000000000000000000000"),
            (120.0, 0, "120"),
        ] {
            assert_eq!(decimal(value, places), expected);
        }
    }
}
