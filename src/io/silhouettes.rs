//! Silhouettes as vectors: curves of few control points, for drawing programs and cutters.

use std::fmt::Write as _;

use glam::DVec2;

use crate::geometry::Rect;
use crate::geometry::compact::CompactCurve;

/// Room around the silhouettes, as a share of the longer side.
const ROOM: f64 = 0.02;

/// Curves whose y points down as one SVG, with `per_mm` of their units to the millimetre; without a scale
/// the units are pixels.
#[must_use]
pub fn svg(curves: &[CompactCurve], per_mm: Option<f64>) -> String {
    let control = curves.iter().flat_map(CompactCurve::beziers).flatten();
    let page = Rect::around(control);
    let page = page.grown(ROOM * page.size().max_element());
    let scale = per_mm.unwrap_or(1.0);
    let size = page.size() / scale;
    let unit = if per_mm.is_some() { "mm" } else { "" };
    let mut svg = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.3}{unit}\" height=\"{1:.3}{unit}\" \
         viewBox=\"0 0 {0:.3} {1:.3}\" fill=\"black\">\n",
        size.x, size.y
    );
    for (i, curve) in curves.iter().enumerate() {
        let place = |p: DVec2| {
            let p = (p - page.min) / scale;
            (p.x, p.y)
        };
        let _ = writeln!(svg, "<path id=\"blade{}\" d=\"{}\"/>", i + 1, path(curve, place));
    }
    svg + "</svg>\n"
}

/// The commands of a closed path: one quadratic curve after the other.
pub(super) fn path(curve: &CompactCurve, place: impl Fn(DVec2) -> (f64, f64)) -> String {
    let mut path = String::new();
    for [start, control, end] in curve.beziers() {
        if path.is_empty() {
            let (x, y) = place(start);
            let _ = write!(path, "M {x:.3},{y:.3}");
        }
        let ((cx, cy), (x, y)) = (place(control), place(end));
        let _ = write!(path, " Q {cx:.3},{cy:.3} {x:.3},{y:.3}");
    }
    path + " Z"
}
