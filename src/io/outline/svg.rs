//! The outline in an SVG drawing: of all shapes, the subpath that encloses the largest area.
//!
//! Groups, transforms, `use` and styles are resolved by usvg; coordinates are those of the drawing's
//! outermost user space (its `viewBox`), y down. Files that the drawing names are not opened.

use glam::DVec2;
use usvg::tiny_skia_path::{PathSegment, Point, Transform};

use super::OutlineProblem;
use crate::geometry::{Rect, polygon};

/// Curves are flattened to within this share of the drawing's extent.
const TOLERANCE: f64 = 2e-5;
/// A curve is cut into at most this many pieces.
const MOST_PIECES: f64 = 256.0;
/// More points than this in one drawing are refused.
const MOST_POINTS: usize = 500_000;

/// The polygon and what was decided on the way.
pub(super) fn outline(text: &str) -> Result<(Vec<DVec2>, Vec<String>), OutlineProblem> {
    // A drawing may name other files and hold pictures; neither is an outline.
    let options = usvg::Options {
        image_href_resolver: usvg::ImageHrefResolver {
            resolve_data: Box::new(|_, _, _| None),
            resolve_string: Box::new(|_, _| None),
        },
        ..usvg::Options::default()
    };
    let unsound =
        |what: String| OutlineProblem::Content(format!("is not a sound SVG file: {what}"));
    let parsing = usvg::roxmltree::ParsingOptions { allow_dtd: true, ..Default::default() };
    let xml = usvg::roxmltree::Document::parse_with_options(text, parsing)
        .map_err(|error| unsound(error.to_string()))?;
    let tree =
        usvg::Tree::from_xmltree(&xml, &options).map_err(|error| unsound(error.to_string()))?;
    let from_page = drawing_from_page(&xml, &tree);
    let extent = f64::from(tree.size().width().max(tree.size().height()));
    let mut found = Vec::new();
    let mut count = 0;
    collect(tree.root(), &from_page, extent * TOLERANCE, &mut found, &mut count)?;
    let shapes = found.len();
    if found.len() > 1 {
        // A page painted behind the leaf is no leaf.
        let whole = polygon_area_of_page(&tree, &from_page);
        let leaves: Vec<_> = found.iter().filter(|p| !is_page(p, whole)).cloned().collect();
        if !leaves.is_empty() {
            found = leaves;
        }
    }
    let area = |p: &Vec<DVec2>| polygon::signed_area(p).abs();
    let outline = found
        .into_iter()
        .max_by(|a, b| area(a).total_cmp(&area(b)))
        .filter(|p| p.len() > 2 && area(p) > 0.0)
        .ok_or_else(|| {
            OutlineProblem::content(
                "has no path that encloses an area (pictures and text do not count)",
            )
        })?;
    let mut notes = Vec::new();
    if shapes > 1 {
        notes.push(format!("{shapes} shapes in the drawing: took the largest"));
    }
    Ok((outline, notes))
}

/// From the page, on which usvg puts everything, back to the drawing's own coordinates.
fn drawing_from_page(xml: &usvg::roxmltree::Document<'_>, tree: &usvg::Tree) -> Transform {
    let view_box: Vec<f32> = xml
        .root_element()
        .attribute("viewBox")
        .map(|text| text.split([' ', ',', '\n', '\t']).filter_map(|n| n.parse().ok()).collect())
        .unwrap_or_default();
    let (width, height) = (tree.size().width(), tree.size().height());
    let to_page = match (&view_box[..], tree.root().children()) {
        // The map to the page is the outermost group, there only when it does something.
        (&[x, y, w, h], [usvg::Node::Group(group)])
            if [x, y, w, h] != [0.0, 0.0, width, height] =>
        {
            group.transform()
        }
        _ => Transform::identity(),
    };
    to_page.invert().unwrap_or_else(Transform::identity)
}

fn polygon_area_of_page(tree: &usvg::Tree, from_page: &Transform) -> f64 {
    let (sx, sy) = from_page.get_scale();
    f64::from(tree.size().width() * sx) * f64::from(tree.size().height() * sy)
}

/// Whether a polygon is an upright rectangle about as large as the page or larger.
fn is_page(points: &[DVec2], page: f64) -> bool {
    let size = Rect::around(points.iter().copied()).size();
    let area = polygon::signed_area(points).abs();
    points.len() <= 5 && area > 0.999 * size.x * size.y && area > 0.9 * page
}

fn collect(
    group: &usvg::Group,
    from_page: &Transform,
    tolerance: f64,
    found: &mut Vec<Vec<DVec2>>,
    count: &mut usize,
) -> Result<(), OutlineProblem> {
    for node in group.children() {
        match node {
            usvg::Node::Group(inner) => collect(inner, from_page, tolerance, found, count)?,
            usvg::Node::Path(path) if path.is_visible() => {
                let map = path.abs_transform().post_concat(*from_page);
                let room = MOST_POINTS - *count;
                let polygons = flattened(path.data(), &map, tolerance, room).ok_or_else(|| {
                    OutlineProblem::Content(format!(
                        "has more than {MOST_POINTS} points; simplify the drawing"
                    ))
                })?;
                *count += polygons.iter().map(Vec::len).sum::<usize>();
                found.extend(polygons);
            }
            _ => {}
        }
    }
    Ok(())
}

/// The subpaths as closed polygons; `None` for more than so many points.
fn flattened(
    path: &usvg::tiny_skia_path::Path,
    map: &Transform,
    tolerance: f64,
    most: usize,
) -> Option<Vec<Vec<DVec2>>> {
    let place = |mut p: Point| {
        map.map_point(&mut p);
        DVec2::new(f64::from(p.x), f64::from(p.y))
    };
    let mut polygons: Vec<Vec<DVec2>> = Vec::new();
    let mut now: Vec<DVec2> = Vec::new();
    let mut before = 0;
    for segment in path.segments() {
        // Before more is asked of memory: a curve of a few bytes is hundreds of points.
        if before + now.len() > most {
            return None;
        }
        match segment {
            PathSegment::MoveTo(p) => {
                before += now.len();
                polygons.push(std::mem::take(&mut now));
                now.push(place(p));
            }
            PathSegment::LineTo(p) => now.push(place(p)),
            PathSegment::QuadTo(c, p) => {
                let (c, p) = (place(c), place(p));
                let Some(&start) = now.last() else { continue };
                // As a cubic with the same points.
                let (c1, c2) = (start.lerp(c, 2.0 / 3.0), p.lerp(c, 2.0 / 3.0));
                cubic(&mut now, [start, c1, c2, p], tolerance);
            }
            PathSegment::CubicTo(c1, c2, p) => {
                let Some(&start) = now.last() else { continue };
                cubic(&mut now, [start, place(c1), place(c2), place(p)], tolerance);
            }
            PathSegment::Close => {}
        }
    }
    polygons.push(now);
    for polygon in &mut polygons {
        polygon.dedup();
        while polygon.len() > 1 && polygon.first() == polygon.last() {
            polygon.pop();
        }
    }
    polygons.retain(|p| p.len() > 2 && p.iter().all(|p| p.is_finite()));
    (polygons.iter().map(Vec::len).sum::<usize>() <= most).then_some(polygons)
}

/// Appends a cubic as chords. A chord over 1/n of the parameter is off by at most
/// √3/18·|second difference|·3/n², Wang's bound.
fn cubic(line: &mut Vec<DVec2>, [a, b, c, d]: [DVec2; 4], tolerance: f64) {
    let bend = (a - b * 2.0 + c).length().max((b - c * 2.0 + d).length());
    let pieces = (0.75 * bend / tolerance).sqrt().ceil().clamp(1.0, MOST_PIECES);
    for k in 1..=pieces as usize {
        let t = k as f64 / pieces;
        let s = 1.0 - t;
        line.push(
            a * (s * s * s) + b * (3.0 * s * s * t) + c * (3.0 * s * t * t) + d * (t * t * t),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_and_arcs_are_resolved() {
        let text = r##"<svg xmlns="http://www.w3.org/2000/svg" width="800" height="800" viewBox="0 0 100 100">
            <rect width="100" height="100" fill="white"/>
            <g transform="translate(50 60) scale(2)"><path d="M -10 0 a 10 10 0 0 1 20 0 a 10 10 0 0 1 -20 0"/></g>
            <path d="M0 0 L 5 0 L 5 5 Z"/></svg>"##;
        let (points, notes) = outline(text).expect("a circle");
        let area = polygon::signed_area(&points).abs();
        assert!((area / (std::f64::consts::PI * 400.0) - 1.0).abs() < 1e-3, "{area}");
        assert!(points.iter().all(|p| (p.distance(DVec2::new(50.0, 60.0)) - 20.0).abs() < 0.02));
        assert_eq!(notes, ["3 shapes in the drawing: took the largest"]);
    }

    #[test]
    fn a_path_of_too_many_points_is_left_before_they_are_all_there() {
        let mut path = usvg::tiny_skia_path::PathBuilder::new();
        path.move_to(0.0, 0.0);
        for _ in 0..4 {
            path.cubic_to(9e3, 0.0, 0.0, 9e3, 9e3, 9e3);
        }
        let path = path.finish().expect("a path");
        let points = |most| flattened(&path, &Transform::identity(), 1e-3, most);
        let all = points(10_000).expect("few enough").iter().map(Vec::len).sum::<usize>();
        assert!(all > 900, "{all}");
        assert!(points(all).is_some() && points(all - 1).is_none() && points(1).is_none());
    }

    #[test]
    fn a_drawing_without_a_shape_is_refused() {
        let text = r#"<svg xmlns="http://www.w3.org/2000/svg"><text>leaf</text></svg>"#;
        assert!(outline(text).expect_err("no path").to_string().contains("no path"));
        assert!(outline("<svg><path d=").expect_err("cut off").to_string().contains("not a sound"));
    }
}
