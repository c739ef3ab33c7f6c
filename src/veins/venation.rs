//! A vein pattern: graph, widths and orders.

use glam::DVec2;

use super::{NodeId, VeinGraph, VeinKind, Widths};
use crate::geometry::polygon;
use crate::margin::Margin;

/// A vein pattern with widths and orders.
///
/// # Guarantees
///
/// - One radius (mm, positive) and one order (1 = primary) for each node.
/// - A radius is never smaller than a child's, unless widths come from the flow; an order is never
///   greater than a child's.
/// - Every node lies inside the margin it was grown in.
#[derive(Debug, Clone, PartialEq)]
pub struct Venation {
    pub(super) graph: VeinGraph,
    pub(super) radii: Vec<f64>,
    pub(super) orders: Vec<u8>,
    pub(super) widths: Widths,
    pub(super) nodes_after_step: Vec<u32>,
    pub(super) sources: usize,
    pub(super) unreached: Unreached,
}

/// The auxin sources that no vein reached, by reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct Unreached {
    /// Given places outside the blade.
    pub outside: usize,
    /// Places that the margin of a bud has not passed.
    pub too_young: usize,
    /// Farther from every vein than the attraction distance.
    pub out_of_reach: usize,
    /// The margin or a cut hides them from the nearest vein.
    pub hidden: usize,
    /// Veins were on their way when growth ended, or could not come closer.
    pub unfinished: usize,
}

impl Unreached {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.outside + self.too_young + self.out_of_reach + self.hidden + self.unfinished
    }

    /// The reasons in words, each with its count; empty where there are none.
    #[must_use]
    pub fn reasons(&self) -> String {
        let reasons = [
            (self.outside, "outside the blade"),
            (self.too_young, "where the margin has not come yet"),
            (self.out_of_reach, "beyond the attraction distance of every vein"),
            (self.hidden, "hidden behind the margin or a cut"),
            (self.unfinished, "not reached when growth ended"),
        ];
        let given = reasons.into_iter().filter(|&(count, _)| count > 0);
        given.map(|(count, reason)| format!("{count} {reason}")).collect::<Vec<_>>().join(", ")
    }
}

impl std::fmt::Display for Unreached {
    /// The count, and the reasons in words.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self.total() {
            0 => write!(f, "0"),
            total => write!(f, "{total}: {}", self.reasons()),
        }
    }
}

impl Venation {
    /// A graph whose nodes have these radii and orders, grown at once and from no sources.
    ///
    /// # Panics
    ///
    /// If there is not one radius and one order for each node.
    #[must_use]
    pub fn new(graph: VeinGraph, radii: Vec<f64>, orders: Vec<u8>) -> Self {
        assert_eq!(radii.len(), graph.len(), "a radius for every node");
        assert_eq!(orders.len(), graph.len(), "an order for every node");
        let nodes_after_step = vec![graph.len() as u32];
        let unreached = Unreached::default();
        let widths = Widths::Murray;
        Self { graph, radii, orders, widths, nodes_after_step, sources: 0, unreached }
    }

    /// The nodes and edges.
    #[must_use]
    pub fn graph(&self) -> &VeinGraph {
        &self.graph
    }

    /// Radius of the vein at each node (mm).
    #[must_use]
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Order of the vein at each node: 1 primary, 2 secondary, …
    #[must_use]
    pub fn orders(&self) -> &[u8] {
        &self.orders
    }

    /// What part of the pattern a node belongs to.
    #[must_use]
    pub fn kind(&self, node: NodeId) -> VeinKind {
        if let Some(rank) = self.graph.rank(node) {
            return rank.kind;
        }
        match self.orders[node as usize] {
            0 | 1 => VeinKind::Primary,
            2 => VeinKind::Secondary,
            _ => VeinKind::Minor,
        }
    }

    /// How many nodes there were after each step; nodes are numbered as they grew. Guided veins are
    /// there from the first step on.
    #[must_use]
    pub fn nodes_after_step(&self) -> &[u32] {
        &self.nodes_after_step
    }

    /// How many auxin sources there were in all.
    #[must_use]
    pub fn sources(&self) -> usize {
        self.sources
    }

    /// The auxin sources that no vein reached.
    #[must_use]
    pub fn unreached(&self) -> Unreached {
        self.unreached
    }

    /// The first guarantee that does not hold inside `margin`, in words; `None` when all do. For
    /// tests.
    #[must_use]
    pub fn check(&self, margin: &Margin) -> Option<String> {
        if let Some(broken) = self.graph.check() {
            return Some(broken);
        }
        let n = self.graph.len();
        if self.radii.len() != n || self.orders.len() != n {
            return Some("not one radius and one order for each node".into());
        }
        let odd = |node: &usize| !(self.radii[*node] > 0.0 && self.orders[*node] > 0);
        if let Some(node) = (0..n).find(odd) {
            return Some(format!("node {node} has no radius or no order"));
        }
        let shrinks = |&(parent, child): &(NodeId, NodeId)| {
            let (parent, child) = (parent as usize, child as usize);
            let thinner = self.radii[parent] < self.radii[child];
            (thinner && self.widths == Widths::Murray) || self.orders[parent] > self.orders[child]
        };
        if let Some((parent, child)) = self.graph.edges().find(shrinks) {
            return Some(format!(
                "node {parent} is thinner or of a higher order than its child {child}"
            ));
        }
        let outside = |p: &&DVec2| !polygon::contains(margin.outline(), **p);
        self.graph.positions().iter().find(outside).map(|p| format!("a node outside, at {p}"))
    }
}
