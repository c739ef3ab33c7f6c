//! Points as text: one a line, two numbers each.
//!
//! Numbers stand apart by a comma, a semicolon, a tab or spaces. A first line without numbers is a
//! heading; empty lines and lines that start with `#` are skipped; further columns are ignored; a
//! byte order mark and Windows line ends do no harm.

/// More points than this are a mistake.
const MOST_POINTS: usize = 20_000_000;

/// Coordinates beyond this lose the digits that matter in the arithmetic that follows.
const MOST_COORDINATE: f64 = 1e15;

/// The points of a text.
///
/// # Errors
///
/// The line and what is wrong with it, in words.
pub fn parse(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let text = text.trim_start_matches('\u{feff}');
    let mut points = Vec::new();
    let mut heading_seen = false;
    for (number, line) in text.lines().enumerate() {
        let line = line.trim();
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let problem = |what: String| Err(format!("line {}: {what}", number + 1));
        let numbers: Vec<Option<f64>> =
            fields(line).iter().take(2).map(|field| field.parse().ok()).collect();
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
            let bound = format!("beyond {MOST_COORDINATE:e}; use a smaller unit");
            return problem(format!("\"{}\" is {bound}", short(line)));
        }
        if points.len() == MOST_POINTS {
            return problem(format!("more than {MOST_POINTS} points"));
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
    use super::parse;

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
        assert!(parse("1,2\nnan,3\n").unwrap_err().starts_with("line 2: "));
        assert!(parse("1,2\n3\n").unwrap_err().contains("one column"));
        assert!(parse("a,b\nc,d\n").unwrap_err().starts_with("line 2: "));
        assert!(parse("1,1e300\n").unwrap_err().contains("beyond"));
    }
}
