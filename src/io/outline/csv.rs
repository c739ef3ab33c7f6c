//! A polygon as text: one point a line, two numbers a point.
//!
//! What separates numbers and lines is [`point_list`]'s affair.

use glam::DVec2;

use super::OutlineProblem;
use crate::point_list;

/// More points than this are no outline that a hand or a camera made.
const MOST_POINTS: usize = 500_000;

/// The polygon and what was dropped from it.
pub(super) fn outline(text: &str) -> Result<(Vec<DVec2>, Vec<String>), OutlineProblem> {
    let given = point_list::parse(text)?;
    if given.len() > MOST_POINTS {
        let problem = format!("has more than {MOST_POINTS} points; simplify the outline");
        return Err(OutlineProblem::Content(problem));
    }
    let mut points: Vec<DVec2> = given.iter().map(|p| DVec2::from(*p)).collect();
    points.dedup();
    let repeated = given.len() - points.len();
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
