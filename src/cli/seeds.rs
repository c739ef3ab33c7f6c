//! The grammar of `--seeds`: `1-3,5,7-20:2`, as render managers write frame ranges.

use super::Failure;

/// More leaves than this in one run is taken for a slip of the finger.
const MOST: usize = 1_000_000;

/// The seeds a command works on: those of `--seeds`, else `--seed`, else the file's, else 1.
pub(crate) fn chosen(
    list: Option<&str>,
    one: Option<u64>,
    of_file: Option<u64>,
) -> Result<Vec<u64>, Failure> {
    match list {
        Some(list) => parse(list).map_err(|problem| Failure::Input(format!("--seeds: {problem}"))),
        None => Ok(vec![one.or(of_file).unwrap_or(1)]),
    }
}

/// The seeds of a range list, in the order given.
///
/// # Errors
///
/// Names the column (from 1) and the part that is wrong: not a number, backwards, step 0, a seed
/// given twice.
fn parse(text: &str) -> Result<Vec<u64>, String> {
    let mut seeds = Vec::new();
    let mut seen = std::collections::HashSet::new();
    let mut column = 1;
    for part in text.split(',') {
        let fail = |problem: &str| format!("column {column}: `{part}` {problem}");
        let number =
            |text: &str| text.trim().parse::<u64>().map_err(|_| fail("is not a seed range"));
        let (range, step) = match part.split_once(':') {
            Some((range, step)) => (range, number(step)?),
            None => (part, 1),
        };
        let (first, last) = match range.split_once('-') {
            Some((first, last)) => (number(first)?, number(last)?),
            None if part.contains(':') => return Err(fail("has a step but no range")),
            None => (number(range)?, number(range)?),
        };
        if step == 0 {
            return Err(fail("has step 0"));
        }
        if first > last {
            return Err(fail("runs backwards"));
        }
        if (last - first) / step >= MOST as u64 || seeds.len() > MOST {
            return Err(fail(&format!("asks for more than {MOST} leaves")));
        }
        for seed in (first..=last).step_by(usize::try_from(step).unwrap_or(usize::MAX)) {
            if !seen.insert(seed) {
                return Err(fail(&format!("gives seed {seed} a second time")));
            }
            seeds.push(seed);
        }
        column += part.chars().count() + 1;
    }
    Ok(seeds)
}

#[cfg(test)]
mod tests {
    use super::parse;

    #[test]
    fn ranges_lists_and_steps() {
        assert_eq!(parse("1-3,5,7-20:2").unwrap(), [1, 2, 3, 5, 7, 9, 11, 13, 15, 17, 19]);
        assert_eq!(parse("0").unwrap(), [0]);
        assert_eq!(parse("18446744073709551615").unwrap(), [u64::MAX]);
    }

    #[test]
    fn mistakes_name_their_column() {
        assert_eq!(parse("1-3,5-1").unwrap_err(), "column 5: `5-1` runs backwards");
        assert_eq!(parse("1-3,2").unwrap_err(), "column 5: `2` gives seed 2 a second time");
        assert!(parse("").unwrap_err().starts_with("column 1"));
        assert!(parse("1-9:0").unwrap_err().contains("step 0"));
        assert!(parse("5:2").unwrap_err().contains("no range"));
        assert!(parse("x").unwrap_err().contains("not a seed range"));
        assert!(parse("0-18446744073709551615").unwrap_err().contains("more than"));
    }
}
