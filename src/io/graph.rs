//! The vein pattern as JSON, for programs that measure or draw it themselves.
//!
//! `{"version": 1, "unit": "mm", "margin": [[x, y], …], "nodes": [{"id", "x", "y", "parent", "radius",
//! "order", "kind"}, …], "joins": [[a, b], …]}` in leaf space: base at the origin, apex on +y.
//! `parent` is `null` at a root; `joins` are edges that close loops and have no parent.

use std::collections::HashSet;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::geometry::polygon;
use crate::margin::Margin;
use crate::veins::{NodeId, VeinGraph, Venation};

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
    /// `primary`, `secondary`, `tertiary`, `intersecondary`, `intramarginal`, `marginal`, `exterior` or `minor`.
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

/// A vein graph read from a file, fit to be measured.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadGraph {
    /// Nodes and edges.
    pub graph: VeinGraph,
    /// Radius at each node (mm).
    pub radii: Vec<f64>,
    /// Order at each node, 1 primary.
    pub orders: Vec<u8>,
    /// The outline; empty when the file has none.
    pub outline: Vec<DVec2>,
}

/// Coordinates and radii beyond this (mm) are no leaf, and their squares would lose their digits.
const MOST_MM: f64 = 1e6;

/// Why a `_veins.json` is no vein graph, to stand after its name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum GraphError {
    /// Other JSON, or none.
    #[error("is not a vein graph: {0}")]
    Json(#[from] serde_json::Error),
    /// A format to come.
    #[error("is version {0} of the format; this program reads 1")]
    Version(u32),
    /// Lengths in another unit.
    #[error("has lengths in `{0}`; this program reads mm")]
    Unit(String),
    /// A point of the margin far from any leaf, or nowhere.
    #[error("margin point {0} is beyond {MOST_MM} mm")]
    MarginPoint(usize),
    /// A margin without a blade.
    #[error("margin encloses no area")]
    NoArea,
    /// A node that makes no sense.
    #[error("node {index} {problem}")]
    Node {
        /// Its place in the list.
        index: usize,
        /// What is wrong with it.
        problem: NodeProblem,
    },
    /// A join that makes no sense.
    #[error("join {index} {problem}")]
    Join {
        /// Its place in the list.
        index: usize,
        /// What is wrong with it.
        problem: JoinProblem,
    },
    /// Nodes, if any, but no edge.
    #[error("has no veins")]
    NoVeins,
}

/// What is wrong with a node.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NodeProblem {
    /// It is not where its id says.
    #[error("has the id {0}; ids count from 0")]
    Id(NodeId),
    /// It lies far from any leaf, or nowhere.
    #[error("is beyond {MOST_MM} mm")]
    TooFar,
    /// Its vein has no width, or too much.
    #[error("has the radius {0}")]
    Radius(f64),
    /// Its vein is of no order.
    #[error("has the order 0; orders count from 1")]
    Order,
    /// It stands before its parent.
    #[error("has the parent {0}; parents come first")]
    Parent(NodeId),
}

/// What is wrong with a join.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum JoinProblem {
    /// A node that there is not, or twice the same.
    #[error("of nodes {0} and {1} is none")]
    Ends(NodeId, NodeId),
    /// An edge that is there already.
    #[error("repeats the edge from {0} to {1}")]
    Repeated(NodeId, NodeId),
}

impl VeinDocument {
    /// Reads a `_veins.json`.
    ///
    /// # Errors
    ///
    /// [`GraphError::Json`].
    pub fn from_json(text: &str) -> Result<Self, GraphError> {
        Ok(serde_json::from_str(text)?)
    }

    /// The graph, all guarantees checked.
    ///
    /// # Errors
    ///
    /// [`GraphError`] with the first number or edge that makes no sense.
    pub fn graph(&self) -> Result<ReadGraph, GraphError> {
        if self.version != 1 {
            return Err(GraphError::Version(self.version));
        }
        if self.unit != "mm" {
            return Err(GraphError::Unit(self.unit.clone()));
        }
        let sound = |value: f64| value.abs() <= MOST_MM;
        let outline: Vec<DVec2> = self.margin.iter().map(|&p| DVec2::from(p)).collect();
        if let Some(i) = outline.iter().position(|p| !sound(p.x) || !sound(p.y)) {
            return Err(GraphError::MarginPoint(i));
        }
        if !outline.is_empty()
            && (outline.len() < 3 || polygon::signed_area(&outline).abs() <= f64::MIN_POSITIVE)
        {
            return Err(GraphError::NoArea);
        }
        let mut graph = VeinGraph::new();
        for (i, node) in self.nodes.iter().enumerate() {
            let fail = |problem: NodeProblem| Err(GraphError::Node { index: i, problem });
            if node.id as usize != i {
                return fail(NodeProblem::Id(node.id));
            }
            if !sound(node.x) || !sound(node.y) {
                return fail(NodeProblem::TooFar);
            }
            if !(node.radius > 0.0 && sound(node.radius)) {
                return fail(NodeProblem::Radius(node.radius));
            }
            if node.order == 0 {
                return fail(NodeProblem::Order);
            }
            let position = DVec2::new(node.x, node.y);
            match node.parent {
                None => graph.add_root(position),
                Some(parent) if (parent as usize) < i => graph.sprout(parent, position),
                Some(parent) => return fail(NodeProblem::Parent(parent)),
            };
        }
        let mut seen = HashSet::new();
        for (i, &[a, b]) in self.joins.iter().enumerate() {
            let fail = |problem: JoinProblem| Err(GraphError::Join { index: i, problem });
            let count = graph.len() as NodeId;
            if a >= count || b >= count || a == b {
                return fail(JoinProblem::Ends(a, b));
            }
            let is_edge = graph.parent(a) == Some(b) || graph.parent(b) == Some(a);
            if is_edge || !seen.insert((a.min(b), a.max(b))) {
                return fail(JoinProblem::Repeated(a, b));
            }
            graph.join(a, b);
        }
        if graph.edges().next().is_none() {
            return Err(GraphError::NoVeins);
        }
        let radii = self.nodes.iter().map(|node| node.radius).collect();
        let orders = self.nodes.iter().map(|node| node.order).collect();
        Ok(ReadGraph { graph, radii, orders, outline })
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
