//! The vein graph as GraphML, which networkx, igraph and Gephi read.
//!
//! Source: the GraphML specification, graphml.graphdrawing.org. An undirected graph: loops are edges
//! like all others, told apart by `is_join`. Lengths are millimetres in leaf space.

use std::fmt::Write as _;

use super::graph::rounded;
use crate::veins::{NodeId, Venation};

/// The attributes: element, name, type.
const KEYS: [(&str, &str, &str); 9] = [
    ("node", "x", "double"),
    ("node", "y", "double"),
    ("node", "radius", "double"),
    ("node", "order", "int"),
    ("node", "kind", "string"),
    ("edge", "length", "double"),
    ("edge", "mean_radius", "double"),
    ("edge", "edge_order", "int"),
    ("edge", "is_join", "boolean"),
];

/// The graph of a leaf.
#[must_use]
pub fn graphml(venation: &Venation) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
         <graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n",
    );
    for (element, name, kind) in KEYS {
        // Edges and nodes both have an order; ids are unique, names need not be.
        let shown = name.trim_start_matches("edge_");
        text += &format!(
            "<key id=\"{name}\" for=\"{element}\" attr.name=\"{shown}\" attr.type=\"{kind}\"/>\n"
        );
    }
    text += "<graph edgedefault=\"undirected\">\n";
    let positions = venation.graph().positions();
    for (id, position) in positions.iter().enumerate() {
        let _ = writeln!(
            text,
            "<node id=\"{id}\"><data key=\"x\">{}</data><data key=\"y\">{}</data>\
             <data key=\"radius\">{}</data><data key=\"order\">{}</data>\
             <data key=\"kind\">{}</data></node>",
            rounded(position.x),
            rounded(position.y),
            rounded(venation.radii()[id]),
            venation.orders()[id],
            venation.kind(id as NodeId),
        );
    }
    for edge in edges(venation) {
        let _ = writeln!(
            text,
            "<edge source=\"{}\" target=\"{}\"><data key=\"length\">{}</data>\
             <data key=\"mean_radius\">{}</data><data key=\"edge_order\">{}</data>\
             <data key=\"is_join\">{}</data></edge>",
            edge.source,
            edge.target,
            rounded(edge.length),
            rounded(edge.mean_radius),
            edge.order,
            edge.is_join,
        );
    }
    text += "</graph>\n</graphml>\n";
    text
}

/// An edge as files tell it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) source: NodeId,
    pub(super) target: NodeId,
    pub(super) length: f64,
    pub(super) mean_radius: f64,
    pub(super) order: u8,
    pub(super) is_join: bool,
}

/// All edges, those from parent to child first.
pub(super) fn edges(venation: &Venation) -> impl Iterator<Item = Edge> + '_ {
    let graph = venation.graph();
    let edge = |source: NodeId, target: NodeId, is_join: bool| {
        let (a, b) = (source as usize, target as usize);
        let (radii, orders) = (venation.radii(), venation.orders());
        Edge {
            source,
            target,
            length: graph.positions()[a].distance(graph.positions()[b]),
            mean_radius: f64::midpoint(radii[a], radii[b]),
            order: orders[a].max(orders[b]),
            is_join,
        }
    };
    let joins = graph.joins().iter().map(move |&(a, b)| edge(a, b, true));
    graph.edges().map(move |(parent, node)| edge(parent, node, false)).chain(joins)
}
