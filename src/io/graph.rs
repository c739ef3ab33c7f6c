//! The vein pattern as JSON, for programs that measure or draw it themselves.
//!
//! `{"version": 1, "unit": "mm", "margin": [[x, y], …], "nodes": [{"id", "x", "y", "parent", "radius",
//! "order", "kind"}, …], "joins": [[a, b], …]}` in leaf space: base at the origin, apex on +y.
//! `parent` is `null` at a root; `joins` are edges that close loops and have no parent.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::margin::Margin;
use crate::veins::{NodeId, Venation};

/// The content of a `_veins.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VeinDocument {
    /// Version of the format: 1.
    pub version: u32,
    /// Unit of all lengths: `mm`.
    pub unit: String,
    /// The outline, anticlockwise from the base.
    pub margin: Vec<[f64; 2]>,
    /// The nodes, parents first; a node's id is its place in the list.
    pub nodes: Vec<VeinNode>,
    /// Edges that close loops, by ids.
    pub joins: Vec<[NodeId; 2]>,
}

/// A node in a `_veins.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct VeinNode {
    /// Its place in the list.
    pub id: NodeId,
    /// Across the leaf (mm).
    pub x: f64,
    /// Along the leaf (mm).
    pub y: f64,
    /// The node that this one grew out of.
    pub parent: Option<NodeId>,
    /// Radius of the vein (mm).
    pub radius: f64,
    /// 1 primary, 2 secondary, …
    pub order: u8,
    /// `primary`, `secondary`, `intersecondary`, `intramarginal`, `marginal`, `exterior` or `minor`.
    pub kind: String,
}

impl VeinDocument {
    /// The document of a leaf.
    #[must_use]
    pub fn new(margin: &Margin, venation: &Venation) -> Self {
        let graph = venation.graph();
        let node = |id: NodeId| {
            let [x, y] = rounded_point(graph.positions()[id as usize]);
            VeinNode {
                id,
                x,
                y,
                parent: graph.parent(id),
                radius: rounded(venation.radii()[id as usize]),
                order: venation.orders()[id as usize],
                kind: venation.kind(id).word().to_owned(),
            }
        };
        Self {
            version: 1,
            unit: "mm".into(),
            margin: margin.outline().iter().copied().map(rounded_point).collect(),
            nodes: (0..graph.len() as NodeId).map(node).collect(),
            joins: graph.joins().iter().map(|&(a, b)| [a, b]).collect(),
        }
    }

    /// As JSON, a node to the line: small enough to read and to compare.
    #[must_use]
    pub fn to_json(&self) -> String {
        format!(
            "{{\"version\":{},\"unit\":{},\n\"margin\":{},\n\"nodes\":{},\n\"joins\":{}}}\n",
            self.version,
            json(&self.unit),
            lines(&self.margin),
            lines(&self.nodes),
            lines(&self.joins),
        )
    }
}

fn lines<T: Serialize>(items: &[T]) -> String {
    let items: Vec<String> = items.iter().map(json).collect();
    if items.is_empty() { "[]".into() } else { format!("[\n{}\n]", items.join(",\n")) }
}

fn json<T: Serialize>(value: &T) -> String {
    serde_json::to_string(value).expect("plain data has a form in JSON")
}

fn rounded_point(p: DVec2) -> [f64; 2] {
    [rounded(p.x), rounded(p.y)]
}

/// To a nanometre: finer than any leaf, and without the noise of the last bits.
pub(super) fn rounded(value: f64) -> f64 {
    // The sum turns −0 into 0.
    (value * 1e6).round() / 1e6 + 0.0
}
