//! A polygon as text: one point a line, two numbers a point.
//!
//! Numbers stand apart by a comma, a semicolon, a tab or spaces. A first line without numbers is a
//! heading; empty lines and lines that start with `#` are skipped; further columns are ignored.

use glam::DVec2;

use super::OutlineProblem;

/// More points than this are no outline that a hand or a camera made.
const MOST_POINTS: usize = 500_000;
/// Coordinates beyond this lose their sub-pixel digits in the arithmetic that follows.
const MOST_COORDINATE: f64 = 1e15;

/// The polygon and what was dropped from it.
pub(super) fn outline(text: &str) -> Result<(Vec<DVec2>, Vec<String>), OutlineProblem> {
    let mut points: Vec<DVec2> = Vec::new();
    let (mut repeated, mut heading_seen) = (0, false);
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let problem =
            |what: String| Err(OutlineProblem::Content(format!("line {}: {what}", number + 1)));
        let fields = fields(line);
        let numbers: Vec<Option<f64>> =
            fields.iter().take(2).map(|field| field.parse().ok()).collect();
        let [x, y] = match numbers[..] {
            [Some(x), Some(y)] => [x, y],
            // A heading has no number in it at all.
            _ if points.is_empty() && !heading_seen && numbers.iter().all(Option::is_none) => {
                heading_seen = true;
                continue;
            }
            [_] => {
                return problem(format!("\"{}\" is one column; a point has x and y", short(line)));
            }
            _ => return problem(format!("\"{}\" is not a pair of numbers", short(line))),
        };
        if !(x.is_finite() && y.is_finite()) {
            return problem(format!("\"{}\" is not a pair of finite numbers", short(line)));
        }
        if x.abs().max(y.abs()) > MOST_COORDINATE {
            return problem(format!(
                "\"{}\" is beyond {MOST_COORDINATE:e}; use a smaller unit",
                short(line)
            ));
        }
        let point = DVec2::new(x, y);
        if points.last() == Some(&point) {
            repeated += 1;
            continue;
        }
        if points.len() == MOST_POINTS {
            return problem(format!("more than {MOST_POINTS} points; simplify the outline"));
        }
        points.push(point);
    }
    while points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    if points.len() < 3 {
        return Err(OutlineProblem::Content(format!(
            "has {} distinct points; a polygon needs at least 3",
            points.len()
        )));
    }
    let mut notes = Vec::new();
    if repeated > 0 {
        notes.push(format!("{repeated} repeated points dropped"));
    }
    Ok((points, notes))
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

    fn points(text: &str) -> Vec<DVec2> {
        outline(text).expect("a polygon").0
    }

    fn problem(text: &str) -> String {
        outline(text).expect_err("no polygon").to_string()
    }

    #[test]
    fn separators_headings_and_line_ends_do_not_matter() {
        let expected = [(0.0, 0.0), (4.0, 0.5), (2.0, 3e1)].map(DVec2::from).to_vec();
        for text in [
            "x,y\n0,0\n4,0.5\n2,30\n",
            "0;0\r\n4;.5\r\n2;3e1\r\n0;0",
            "# leaf\n0 0\n\n4   0.5\n2 30",
            "\"x\",\"y\",\"z\"\n0,0,9\n4,0.5,9\n4,0.5,9\n2,30,9",
            "X\tY\n0\t0\n4\t0.5\n2\t30",
        ] {
            assert_eq!(points(text), expected, "{text}");
        }
    }

    #[test]
    fn problems_name_their_line() {
        assert_eq!(
            problem("x,y\n0,0\n1,NaN\n"),
            "line 3: \"1,NaN\" is not a pair of finite numbers"
        );
        assert_eq!(problem("0,0\n\na,b\n"), "line 3: \"a,b\" is not a pair of numbers");
        assert_eq!(problem("0,0\n7\n"), "line 2: \"7\" is one column; a point has x and y");
        assert_eq!(problem("x,y\n"), "has 0 distinct points; a polygon needs at least 3");
        assert_eq!(problem("1,2\n1,2\n3,4\n"), "has 2 distinct points; a polygon needs at least 3");
        assert!(problem("0,0\n1e300,4\n").contains("beyond 1e15"));
    }

    proptest::proptest! {
        #[test]
        fn no_text_makes_it_panic(text in "[0-9eE.,;\t \\-+\nNaninfx\u{feff}\"#]{0,200}") {
            let _ = outline(&text);
        }
    }
}
