//! The veins of a leaf as lines to draw, for the vector formats.
//!
//! No format knows a stroke that tapers. Where widths are drawn, a vein is cut into pieces of one width
//! each; where only the course counts, a vein is one line as long as it goes on. Every edge of the
//! pattern is in one line and in no other.

use glam::DVec2;

use super::decimal::decimal;
use crate::veins::{NodeId, Venation};

/// A new piece of a vein begins where its radius has changed by this share: a step that the eye
/// takes for a taper, without cutting veins to crumbs.
const WIDTH_STEP: f64 = 0.1;

/// How veins are cut into lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    /// A new line where the width changes; else a vein is one line from its root to its tip.
    pub by_width: bool,
    /// What is narrower than this is left out (mm).
    pub least_width_mm: f64,
}

/// A stretch of a vein of one order and, where asked for, (nearly) one width.
#[derive(Debug)]
pub(super) struct Piece {
    pub order: u8,
    /// Of its first edge (mm).
    pub radius: f64,
    pub points: Vec<DVec2>,
}

/// The name of the layer for an order of veins.
pub(super) fn order_name(order: u8) -> String {
    match order {
        1 => "primary".into(),
        2 => "secondary".into(),
        3 => "tertiary".into(),
        4 => "quaternary".into(),
        5 => "quinternary".into(),
        _ => format!("order {order}"),
    }
}

/// Every edge of the pattern that is wide enough, once, in pieces as long as the cut allows.
///
/// Widths never grow from the petiole to the tips under Murray's law, so what is left in is one piece.
pub(super) fn pieces(venation: &Venation, cut: Cut) -> Vec<Piece> {
    let graph = venation.graph();
    let (radii, orders) = (venation.radii(), venation.orders());
    let order_of = |node: NodeId| orders[node as usize].max(1);
    let radius_of = |node: NodeId| radii[node as usize];
    let position_of = |node: NodeId| graph.positions()[node as usize];
    let drawn = |radius: f64| 2.0 * radius >= cut.least_width_mm;

    // The child that goes on with its parent's vein: of the same order, the widest, the eldest.
    let mut heir: Vec<Option<NodeId>> = vec![None; graph.len()];
    for (parent, child) in graph.edges().filter(|&(_, child)| drawn(radius_of(child))) {
        let wider = heir[parent as usize].is_none_or(|other| radius_of(child) > radius_of(other));
        if order_of(child) == order_of(parent) && wider {
            heir[parent as usize] = Some(child);
        }
    }

    let mut pieces = Vec::new();
    for (parent, child) in graph.edges().filter(|&(_, child)| drawn(radius_of(child))) {
        // A vein starts at a root, or where a child is no heir, or where its parent is not drawn.
        let goes_on = graph.parent(parent).is_some() && drawn(radius_of(parent));
        if heir[parent as usize] == Some(child) && goes_on {
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
            let change = (radius_of(next) - piece.radius).abs();
            if cut.by_width && change > WIDTH_STEP * piece.radius {
                pieces.push(std::mem::replace(&mut piece, start(node, next)));
            } else {
                piece.points.push(position_of(next));
            }
            node = next;
        }
        pieces.push(piece);
    }
    let joins = graph.joins().iter().map(|&(a, b)| Piece {
        order: order_of(a).max(order_of(b)),
        radius: radius_of(a).min(radius_of(b)),
        points: vec![position_of(a), position_of(b)],
    });
    pieces.extend(joins.filter(|piece| drawn(piece.radius)));
    pieces
}

/// To a tenth of a micrometre.
pub(super) fn number(value: f64) -> String {
    decimal(value, 4)
}
