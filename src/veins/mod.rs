//! The vein pattern: grown, measured in width, ranked by order.
//!
//! Algorithms vary behind one enum and one `match` in [`grow`]; all end in a [`VeinGraph`], so
//! widths, orders and everything after them are shared.

pub mod auxin;
pub mod graph;
pub mod orders;
pub mod widths;

use crate::growth::GrowingBlade;
use crate::observer::Observer;
use crate::parameter::{parameters, words};
use crate::seed::Seed;
pub use graph::{NodeId, VeinGraph, VeinKind};

words! {
    /// How veins are made.
    pub enum Algorithm {
        /// Veins grow towards auxin sources and never meet (Runions et al. 2005, open venation).
        AuxinOpen = "auxin-open",
    }
}

parameters! {
    /// Growth of the vein pattern. Lengths are those of the blade at the step in question.
    pub struct VeinSpec {
        /// How veins are made.
        algorithm: choice(Algorithm, Algorithm::AuxinOpen),
        /// Auxin darts thrown per step at full size; more gives a denser pattern.
        spawn_rate: number(60.0, 0.0..=100_000.0, "darts/step"),
        /// A dart nearer than this to a source is lost.
        source_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A dart nearer than this to a vein is lost.
        vein_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A source is used up when a vein comes within this distance.
        kill_distance_mm: number(0.8, 0.001..=1000.0, "mm"),
        /// How far a vein grows in one step.
        node_step_mm: number(0.3, 0.001..=100.0, "mm"),
        /// A source calls veins within this distance only; 0 for no limit.
        attraction_distance_mm: number(0.0, 0.0..=10_000.0, "mm"),
        /// Positions of auxin sources in the mature leaf, instead of darts.
        sources_mm: points(),
        /// Radius of the finest veins.
        tip_radius_mm: number(0.03, 0.0001..=10.0, "mm"),
        /// Murray's exponent: the parent's radius to this power is the sum over its children.
        murray_exponent: number(3.0, 1.0..=10.0, ""),
    }
}

/// A vein pattern with widths and orders.
///
/// # Guarantees
///
/// - One radius (mm, positive) and one order (1 = primary) for each node.
/// - A radius is never smaller than a child's; an order never greater than a child's.
/// - Every node lies inside the margin it was grown in.
#[derive(Debug, Clone, PartialEq)]
pub struct Venation {
    graph: VeinGraph,
    radii: Vec<f64>,
    orders: Vec<u8>,
    /// How many sources no vein reached.
    unreached_sources: usize,
}

impl Venation {
    /// A graph whose nodes have these radii and orders.
    ///
    /// # Panics
    ///
    /// If there is not one radius and one order for each node.
    #[must_use]
    pub fn new(
        graph: VeinGraph,
        radii: Vec<f64>,
        orders: Vec<u8>,
        unreached_sources: usize,
    ) -> Self {
        assert_eq!(radii.len(), graph.len(), "a radius for every node");
        assert_eq!(orders.len(), graph.len(), "an order for every node");
        Self { graph, radii, orders, unreached_sources }
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
        match self.orders[node as usize] {
            0 | 1 => VeinKind::Primary,
            2 => VeinKind::Secondary,
            _ => VeinKind::Minor,
        }
    }

    /// How many auxin sources no vein reached.
    #[must_use]
    pub fn unreached_sources(&self) -> usize {
        self.unreached_sources
    }
}

/// Grows the vein pattern of a leaf from `roots` (leaf space, mm; usually the base alone).
///
/// # Errors
///
/// [`VeinError`] names the key, the value and the limit.
pub fn grow(
    _spec: &VeinSpec,
    _blade: &GrowingBlade,
    _seed: Seed,
    _observer: &mut dyn Observer,
) -> Result<Venation, VeinError> {
    unimplemented!()
}

/// Why veins could not be grown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VeinError {
    /// Two settings contradict each other.
    #[error("{key} = {value} {problem}")]
    Setting {
        /// The key.
        key: &'static str,
        /// Its value.
        value: f64,
        /// What is wrong and what to change.
        problem: String,
    },
}
