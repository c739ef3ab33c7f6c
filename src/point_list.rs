//! Points as text: one a line, two numbers each.
//!
//! Numbers stand apart by a comma, a semicolon, a tab or spaces. A first line without numbers is a
//! heading; empty lines and lines that start with `#` are skipped; further columns are ignored; a
//! byte order mark and Windows line ends do no harm.

/// More points than this are a mistake.
const MOST_POINTS: usize = 20_000_000;

/// Coordinates beyond this lose the digits that matter in the arithmetic that follows.
const MOST_COORDINATE: f64 = 1e15;

/// A line that holds no point.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {problem}")]
pub struct PointError {
    /// Which line, from 1.
    pub line: usize,
    /// What is wrong with it.
    pub problem: PointProblem,
}

/// What is wrong with a line; with it stands how it begins.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum PointProblem {
    /// A number stands alone.
    #[error("\"{0}\" is one column; a point has x and y")]
    OneColumn(String),
    /// Something else than numbers.
    #[error("\"{0}\" is not a pair of numbers")]
    NoNumbers(String),
    /// NaN or infinite.
    #[error("\"{0}\" is not a pair of finite numbers")]
    NotFinite(String),
    /// A coordinate that would lose its digits.
    #[error("\"{0}\" is beyond {MOST_COORDINATE:e}; use a smaller unit")]
    TooFar(String),
    /// More points than anybody means.
    #[error("more than {MOST_POINTS} points")]
    TooMany,
}

/// The points of a text.
///
/// # Errors
///
/// [`PointError`] names the line and what is wrong with it.
pub fn parse(text: &str) -> Result<Vec<[f64; 2]>, PointError> {
    let text = text.trim_start_matches('\u{feff}');
    let mut points = Vec::new();
    let mut heading_seen = false;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let fail = |problem: PointProblem| Err(PointError { line: number + 1, problem });
        let numbers: Vec<Option<f64>> =
            fields(line).iter().take(2).map(|field| field.parse().ok()).collect();
        let [x, y] = match numbers[..] {
            [Some(x), Some(y)] => [x, y],
            // A heading has no number in it at all.
            _ if points.is_empty() && !heading_seen && numbers.iter().all(Option::is_none) => {
                heading_seen = true;
                continue;
            }
            [_] => return fail(PointProblem::OneColumn(short(line))),
            _ => return fail(PointProblem::NoNumbers(short(line))),
        };
        if !(x.is_finite() && y.is_finite()) {
            return fail(PointProblem::NotFinite(short(line)));
        }
        if x.abs().max(y.abs()) > MOST_COORDINATE {
            return fail(PointProblem::TooFar(short(line)));
        }
        if points.len() == MOST_POINTS {
            return fail(PointProblem::TooMany);
        }
        points.push([x, y]);
    }
    Ok(points)
}

/// The columns of a line, by the strongest separator in it.
fn fields(line: &str) -> Vec<&str> {
    match [';', '\t', ','].into_iter().find(|&separator| line.contains(separator)) {
        Some(separator) => line.split(separator).map(|f| f.trim().trim_matches('"')).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// At most the first 40 characters, control characters masked.
fn short(line: &str) -> String {
    line.chars().take(40).map(|c| if c.is_control() { '?' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn separators_headings_comments_and_marks() {
        let expected = vec![[1.0, 2.0], [-3.5, 4e2]];
        for text in [
            "x,y\n1,2\n-3.5,4e2\n",
            "\u{feff}x;y\r\n1;2\r\n-3.5;4e2\r\n",
            "# mm\n1 2\n\n-3.5\t400",
            "\"1\",\"2\",third\n-3.5,400,x",
        ] {
            assert_eq!(parse(text).unwrap(), expected, "{text:?}");
        }
        assert_eq!(parse("").unwrap(), Vec::<[f64; 2]>::new());
    }

    #[test]
    fn mistakes_name_their_line() {
        let wrong = |text: &str| parse(text).unwrap_err();
        let text = |text: &str| text.to_owned();
        let problem = PointProblem::NotFinite(text("nan,3"));
        assert_eq!(wrong("1,2\nnan,3\n"), PointError { line: 2, problem });
        assert_eq!(wrong("1,2\n3\n").problem, PointProblem::OneColumn(text("3")));
        let problem = PointProblem::NoNumbers(text("c,d"));
        assert_eq!(wrong("a,b\nc,d\n"), PointError { line: 2, problem });
        let told = wrong("1,1e300\n").to_string();
        assert_eq!(told, "line 1: \"1,1e300\" is beyond 1e15; use a smaller unit");
    }
}
