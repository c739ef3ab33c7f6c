//! Outline and veins as vectors, in true size.
//!
//! For drawing programs, plotters and cutters: lengths are millimetres (`width` and `height` say so,
//! the view box has the same numbers), the outline is one closed path, no segment is drawn twice,
//! and every order of veins is a layer of its own. Layers are numbered from 1 in their labels:
//! plotter programs read the number, and fold a layer 0 into layer 1.
//!
//! The page is the square of the textures, so the drawing lies on them exactly. SVG's y runs down.
//!
//! What lines look like is a [`SvgStyle`]: for print veins have their widths; a plotter's pen has its
//! own, so veins are single lines, each as long as it goes on; a laser tells its work by colour, red
//! to cut through and blue to score, in hairlines.

use std::fmt::Write as _;

use glam::DVec2;

use super::drawing::{Cut, number, order_name, pieces};
use crate::margin::Margin;
use crate::spec::SvgStyle;
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Width of the outline in print (mm): a hairline that still shows on screen.
const OUTLINE_WIDTH_MM: f64 = 0.1;

/// Width of a plotter's lines (mm), that of a fine pen: only for the screen.
const PEN_MM: f64 = 0.3;

/// Laser programs take lines up to this width (mm) for paths to follow, wider ones for areas.
const HAIRLINE_MM: f64 = 0.01;

/// How lines are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drawing<'a> {
    /// The title in the file.
    pub title: &'a str,
    /// What they are for.
    pub style: SvgStyle,
    /// Veins narrower than this are left out (mm).
    pub least_width_mm: f64,
}

/// The drawing of a leaf, or of its outline alone; `rings` outline what is left of a damaged blade.
#[must_use]
pub fn svg(
    drawing: &Drawing<'_>,
    margin: &Margin,
    venation: Option<&Venation>,
    frame: &TextureFrame,
    rings: &[Vec<DVec2>],
) -> String {
    let page = Page { frame };
    let side = number(frame.side_mm);
    let mut svg = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <svg xmlns=\"http://www.w3.org/2000/svg\" \
         xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" \
         width=\"{side}mm\" height=\"{side}mm\" viewBox=\"0 0 {side} {side}\" fill=\"none\" \
         stroke-linecap=\"round\" stroke-linejoin=\"round\">\n<title>{}</title>\n",
        escaped(drawing.title)
    );
    let (cut, score, outline_mm) = match drawing.style {
        SvgStyle::Print => ("black", "black", OUTLINE_WIDTH_MM),
        SvgStyle::Plotter => ("black", "black", PEN_MM),
        SvgStyle::Laser => ("#ff0000", "#0000ff", HAIRLINE_MM),
    };
    let by_width = drawing.style == SvgStyle::Print;
    open_layer(&mut svg, 1, "outline", cut, Some(outline_mm));
    // Of a damaged blade what is left, gaps as rings of their own.
    let whole = [margin.outline().to_vec()];
    for ring in if rings.is_empty() { &whole[..] } else { rings } {
        let _ = writeln!(svg, "<path d=\"{} Z\"/>", page.path(ring));
    }
    for cut in margin.cuts() {
        let _ = writeln!(svg, "<path d=\"{}\"/>", page.path(cut));
    }
    svg.push_str("</g>\n");

    let cut = Cut { by_width, least_width_mm: drawing.least_width_mm };
    let pieces = venation.map(|venation| pieces(venation, cut)).unwrap_or_default();
    let orders = pieces.iter().map(|piece| piece.order).max().unwrap_or(0);
    for order in 1..=orders {
        let width = (!by_width).then_some(outline_mm);
        open_layer(&mut svg, usize::from(order) + 1, &order_name(order), score, width);
        for piece in pieces.iter().filter(|piece| piece.order == order) {
            let points = page.points(&piece.points);
            if !points.contains(' ') {
                continue;
            }
            let _ = if by_width {
                let width = number(2.0 * piece.radius);
                writeln!(svg, "<polyline stroke-width=\"{width}\" points=\"{points}\"/>")
            } else {
                writeln!(svg, "<polyline points=\"{points}\"/>")
            };
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn open_layer(svg: &mut String, number: usize, name: &str, colour: &str, width: Option<f64>) {
    let width = width.map_or(String::new(), |width| format!(" stroke-width=\"{width}\""));
    let _ = writeln!(
        svg,
        "<g id=\"layer{number}\" inkscape:groupmode=\"layer\" \
         inkscape:label=\"{number} {name}\" stroke=\"{colour}\"{width}>"
    );
}

/// From leaf space to the page.
struct Page<'a> {
    frame: &'a TextureFrame,
}

impl Page<'_> {
    fn point(&self, p: DVec2) -> String {
        let p = p - self.frame.min;
        format!("{},{}", number(p.x), number(self.frame.side_mm - p.y))
    }

    /// Points with a space between them; those that print alike in succession only once.
    fn points(&self, points: &[DVec2]) -> String {
        let mut printed: Vec<String> = points.iter().map(|&p| self.point(p)).collect();
        printed.dedup();
        printed.join(" ")
    }

    fn path(&self, points: &[DVec2]) -> String {
        format!("M {}", self.points(points))
    }
}

/// Text that XML takes as text.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            // Control characters have no place in XML, not even escaped.
            c if c.is_control() => escaped.push(' '),
            '\u{fffe}' | '\u{ffff}' => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}
