//! A real margin and the one fitted to it, drawn over each other.

use std::fmt::Write as _;

use glam::DVec2;

use super::silhouettes;
use crate::geometry::{Rect, compact};
use crate::margin::Margin;
use crate::margin::fit::Fit;
use crate::raster::Grid;
use crate::raster::draw::{Canvas, Rgba};

const PAPER: Rgba = [255, 255, 255, 255];
const REAL: Rgba = [204, 224, 192, 255];
const FITTED: Rgba = [190, 30, 40, 255];

/// Room around the leaf, as a share of its longer side.
const ROOM: f64 = 0.04;

/// Both margins as a picture whose longer side has `side_px` pixels: the real blade as an area, the
/// fitted margin as a line.
#[must_use]
pub fn picture(real: &Margin, fit: &Fit, side_px: usize) -> Grid<Rgba> {
    let page = page(real, fit);
    let scale = side_px as f64 / page.size().max_element();
    let size = (page.size() * scale).ceil();
    let mut canvas = Canvas::new(size.x.max(1.0) as usize, size.y.max(1.0) as usize, PAPER);
    let placed = |margin: &Margin| -> Vec<DVec2> {
        let to_pixel = |p: &DVec2| DVec2::new(p.x - page.min.x, page.max.y - p.y) * scale;
        margin.outline().iter().map(to_pixel).collect()
    };
    canvas.fill(&[&placed(real)], REAL);
    let mut line = placed(&fit.margin);
    line.extend(line.first().copied());
    canvas.stroke(&line, (side_px as f64 / 300.0).max(1.0), FITTED);
    canvas.into_picture()
}

/// The real margin is drawn as curves within this of it (lengths).
const CURVE: f64 = 0.001;

/// Both margins as vectors in true size, the real one as curves.
#[must_use]
pub fn svg(real: &Margin, fit: &Fit) -> String {
    let page = page(real, fit);
    let size = page.size();
    let place = |p: DVec2| (p.x - page.min.x, page.max.y - p.y);
    let mut fitted = String::from("M");
    for &p in fit.margin.outline() {
        let (x, y) = place(p);
        let _ = write!(fitted, " {x:.3},{y:.3}");
    }
    let apex = real.apex_index();
    let curve = compact::compact(real.outline(), &[0, apex], CURVE * real.length_mm());
    let hex = |[r, g, b, _]: Rgba| format!("#{r:02x}{g:02x}{b:02x}");
    format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.3}mm\" height=\"{1:.3}mm\" \
         viewBox=\"0 0 {0:.3} {1:.3}\">\n\
         <path id=\"real\" fill=\"{2}\" d=\"{3}\"/>\n\
         <path id=\"fitted\" fill=\"none\" stroke=\"{4}\" stroke-width=\"{5:.3}\" \
         stroke-linejoin=\"round\" d=\"{6}\"/>\n</svg>\n",
        size.x,
        size.y,
        hex(REAL),
        silhouettes::path(&curve, place),
        hex(FITTED),
        size.max_element() / 300.0,
        fitted + " Z"
    )
}

fn page(real: &Margin, fit: &Fit) -> Rect {
    let both = Rect::around(real.outline().iter().chain(fit.margin.outline()).copied());
    both.grown(ROOM * both.size().max_element())
}
