//! A vein pattern as lines, the darker and wider the more flows in them, as in the pictures of Rodkaew et
//! al. 2002.

use venation::geometry::DVec2;
use venation::margin::Margin;
use venation::pipeline::Grown;
use venation::raster::Grid;
use venation::raster::draw::{Canvas, Rgba};

const PAPER: Rgba = [255, 255, 255, 255];
const OUTLINE: Rgba = [190, 190, 184, 255];

/// Shades between the finest and the widest vein.
const SHADES: u32 = 12;

/// The thinnest line (pixels).
const THINNEST: f64 = 0.7;

/// The widest line, in sides of the picture.
const WIDEST: f64 = 1.0 / 90.0;

/// From where a leaf is seen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Seen {
    Above,
    Below,
}

/// A square picture of the veins in their margin.
pub(super) fn picture(grown: &Grown, side: usize, seen: Seen) -> Grid<Rgba> {
    let mut canvas = Canvas::new(side, side, PAPER);
    let pixel_from_leaf = fitted(&grown.margin, side as f64, seen);
    let mut outline: Vec<DVec2> =
        grown.margin.outline().iter().map(|p| pixel_from_leaf(*p)).collect();
    outline.push(outline[0]);
    canvas.stroke(&outline, 1.0, OUTLINE);
    let graph = grown.venation.graph();
    let radii = grown.venation.radii();
    let (finest, widest) =
        radii.iter().fold((f64::INFINITY, 0.0), |(low, high), &r| (r.min(low), r.max(high)));
    let share = |node: u32| {
        if widest > finest { (radii[node as usize] - finest) / (widest - finest) } else { 0.0 }
    };
    // The darker over the lighter.
    let shade = |share: f64| (share * f64::from(SHADES)).round() as u32;
    let grown = graph.edges().map(|(parent, node)| (shade(share(node)), node, parent));
    // Where veins meet the finer one ends.
    let met = graph.joins().iter().map(|&(a, b)| (shade(share(a).min(share(b))), a, b));
    let mut lines: Vec<(u32, u32, u32)> = grown.chain(met).collect();
    lines.sort_unstable();
    for (shade, node, other) in lines {
        let ends = [other, node].map(|id| pixel_from_leaf(graph.positions()[id as usize]));
        let part = f64::from(shade) / f64::from(SHADES);
        let width = THINNEST + part * (side as f64 * WIDEST - THINNEST).max(0.0);
        canvas.stroke(&ends, width, ink(part));
    }
    canvas.into_picture()
}

/// From light green to nearly black.
fn ink(part: f64) -> Rgba {
    let between = |low: f64, high: f64| (low + (high - low) * part.sqrt()).round() as u8;
    [between(150.0, 16.0), between(178.0, 44.0), between(132.0, 20.0), 255]
}

/// Pixels from leaf space: the blade in the middle, with a little room around.
fn fitted(margin: &Margin, side: f64, seen: Seen) -> impl Fn(DVec2) -> DVec2 {
    let bounds = margin.bounds();
    let scale = 0.94 * side / bounds.size().max_element();
    let middle = (bounds.min + bounds.max) / 2.0;
    let mirror = if seen == Seen::Below { -1.0 } else { 1.0 };
    move |p| DVec2::splat(side / 2.0) + (p - middle) * DVec2::new(mirror * scale, -scale)
}
