//! Outline and veins as vectors, in true size.
//!
//! For drawing programs, plotters and cutters: lengths are millimetres (`width` and `height` say so,
//! the view box has the same numbers), the outline is one closed path, no segment is drawn twice,
//! and every order of veins is a layer of its own. Layers are numbered from 1 in their labels:
//! plotter programs read the number, and fold a layer 0 into layer 1.
//!
//! The page is the square of the textures, so the drawing lies on them exactly. SVG's y runs down.
//! It knows no stroke that tapers either: a vein is cut into pieces of one width each.

use std::fmt::Write as _;

use glam::DVec2;

use crate::margin::Margin;
use crate::units::TextureFrame;
use crate::veins::{NodeId, Venation};

/// A new piece of a vein begins where its radius has changed by this share: a step that the eye
/// takes for a taper, without cutting veins to crumbs.
const WIDTH_STEP: f64 = 0.1;

/// Width of the outline (mm): a hairline that still shows on screen.
const OUTLINE_WIDTH_MM: f64 = 0.1;

/// The drawing of a leaf, or of its outline alone; `rings` outline what is left of a damaged blade.
#[must_use]
pub fn svg(
    title: &str,
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
        escaped(title)
    );
    open_layer(&mut svg, 1, "outline", &format!(" stroke-width=\"{OUTLINE_WIDTH_MM}\""));
    // Of a damaged blade what is left, gaps as rings of their own.
    let whole = [margin.outline().to_vec()];
    for ring in if rings.is_empty() { &whole[..] } else { rings } {
        let _ = writeln!(svg, "<path d=\"{} Z\"/>", page.path(ring));
    }
    for cut in margin.cuts() {
        let _ = writeln!(svg, "<path d=\"{}\"/>", page.path(cut));
    }
    svg.push_str("</g>\n");

    let pieces = venation.map(pieces).unwrap_or_default();
    let orders = pieces.iter().map(|piece| piece.order).max().unwrap_or(0);
    for order in 1..=orders {
        open_layer(&mut svg, usize::from(order) + 1, &order_name(order), "");
        for piece in pieces.iter().filter(|piece| piece.order == order) {
            let points = page.points(&piece.points);
            if points.contains(' ') {
                let width = number(2.0 * piece.radius);
                let _ = writeln!(svg, "<polyline stroke-width=\"{width}\" points=\"{points}\"/>");
            }
        }
        svg.push_str("</g>\n");
    }
    svg.push_str("</svg>\n");
    svg
}

fn open_layer(svg: &mut String, number: usize, name: &str, style: &str) {
    let _ = writeln!(
        svg,
        "<g id=\"layer{number}\" inkscape:groupmode=\"layer\" \
         inkscape:label=\"{number} {name}\" stroke=\"black\"{style}>"
    );
}

fn order_name(order: u8) -> String {
    match order {
        1 => "primary".into(),
        2 => "secondary".into(),
        3 => "tertiary".into(),
        4 => "quaternary".into(),
        5 => "quinternary".into(),
        _ => format!("order {order}"),
    }
}

/// A stretch of a vein of one order and (nearly) one width.
#[derive(Debug)]
struct Piece {
    order: u8,
    radius: f64,
    points: Vec<DVec2>,
}

/// Every edge of the pattern, once, in pieces as long as order and width allow.
fn pieces(venation: &Venation) -> Vec<Piece> {
    let graph = venation.graph();
    let (radii, orders) = (venation.radii(), venation.orders());
    let order_of = |node: NodeId| orders[node as usize].max(1);
    let radius_of = |node: NodeId| radii[node as usize];
    let position_of = |node: NodeId| graph.positions()[node as usize];

    // The child that goes on with its parent's vein: of the same order, the widest, the eldest.
    let mut heir: Vec<Option<NodeId>> = vec![None; graph.len()];
    for (parent, child) in graph.edges() {
        let wider = heir[parent as usize].is_none_or(|other| radius_of(child) > radius_of(other));
        if order_of(child) == order_of(parent) && wider {
            heir[parent as usize] = Some(child);
        }
    }

    let mut pieces = Vec::new();
    for (parent, child) in graph.edges() {
        // A vein starts at a root, or where a child is no heir.
        if heir[parent as usize] == Some(child) && graph.parent(parent).is_some() {
            continue;
        }
        let start = |parent: NodeId, child: NodeId| Piece {
            order: order_of(child),
            radius: radius_of(child),
            points: vec![position_of(parent), position_of(child)],
        };
        let mut piece = start(parent, child);
        let mut node = child;
        while let Some(next) = heir[node as usize] {
            if (radius_of(next) - piece.radius).abs() > WIDTH_STEP * piece.radius {
                pieces.push(std::mem::replace(&mut piece, start(node, next)));
            } else {
                piece.points.push(position_of(next));
            }
            node = next;
        }
        pieces.push(piece);
    }
    pieces.extend(graph.joins().iter().map(|&(a, b)| Piece {
        order: order_of(a).max(order_of(b)),
        radius: radius_of(a).min(radius_of(b)),
        points: vec![position_of(a), position_of(b)],
    }));
    pieces
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

/// To a tenth of a micrometre, without trailing zeros.
fn number(value: f64) -> String {
    let printed = format!("{value:.4}");
    let printed = printed.trim_end_matches('0').trim_end_matches('.');
    if printed == "-0" { "0".into() } else { printed.into() }
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
