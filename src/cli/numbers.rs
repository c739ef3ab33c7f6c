//! Numbers of the command line.

use std::ffi::OsString;

/// The arguments of the program, with what begins like a negative number joined to the option before it:
/// else it would be taken for an option, and nobody would be told the limits of the number.
pub(super) fn joined(arguments: impl Iterator<Item = OsString>) -> Vec<OsString> {
    let mut joined: Vec<OsString> = Vec::new();
    for argument in arguments {
        let before = joined.last_mut().filter(|before| is_option(before));
        match (before, argument.to_str().filter(|text| is_negative(text))) {
            (Some(option), Some(number)) => {
                option.push("=");
                option.push(number);
            }
            _ => joined.push(argument),
        }
    }
    joined
}

/// `--name` or `-n`, without a value.
fn is_option(argument: &OsString) -> bool {
    let Some(text) = argument.to_str() else { return false };
    match text.strip_prefix("--") {
        Some(name) => name.starts_with(|c: char| c.is_ascii_alphabetic()) && !name.contains('='),
        None => matches!(text.as_bytes(), [b'-', letter] if letter.is_ascii_alphabetic()),
    }
}

/// `-3`, `-.5`, `-1..2`, `-5%`.
fn is_negative(text: &str) -> bool {
    let digits = text.strip_prefix('-').map(|rest| rest.strip_prefix('.').unwrap_or(rest));
    digits.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}

/// Reads a whole number within limits.
///
/// # Errors
///
/// The limits, in words.
pub(super) fn whole<T: TryFrom<u64>, const MIN: u64, const MAX: u64>(
    text: &str,
) -> Result<T, String> {
    let number = text.trim().parse().ok().filter(|number| (MIN..=MAX).contains(number));
    let number = number.and_then(|number: u64| T::try_from(number).ok());
    number.ok_or_else(|| format!("it takes a whole number from {MIN} to {MAX}"))
}

/// Any seed.
pub(super) fn seed(text: &str) -> Result<u64, String> {
    whole::<u64, 0, { u64::MAX }>(text)
}

/// So many threads: those beyond any machine's take minutes to start and make nothing faster.
pub(super) fn threads(text: &str) -> Result<usize, String> {
    whole::<usize, 1, 1024>(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_numbers_are_values_of_the_option_before() {
        let joined = |line: &str| joined(line.split(' ').map(OsString::from)).join(" ".as_ref());
        for (line, expected) in [
            ("a --n -3 b", "a --n=-3 b"),
            ("a -t -1 --x -.5", "a -t=-1 --x=-.5"),
            ("a --n -1..2 --m -5%", "a --n=-1..2 --m=-5%"),
            ("a -3 --n=1 -2", "a -3 --n=1 -2"),
            ("a -- -3", "a -- -3"),
            ("a --n -n --m", "a --n -n --m"),
        ] {
            assert_eq!(joined(line), OsString::from(expected), "{line}");
        }
    }
}
