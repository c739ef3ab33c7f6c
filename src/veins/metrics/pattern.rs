//! Measures of a vein pattern that tell growth types apart.

use glam::DVec2;

use crate::margin::Margin;
use crate::veins::{NodeId, Venation};

/// Measures of one vein pattern.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VeinMetrics {
    /// Vein nodes.
    pub nodes: usize,
    /// Free vein ends.
    pub tips: usize,
    /// Length of all veins (mm).
    pub length_mm: f64,
    /// Path over chord of the primary and secondary veins, weighted by length: 1 is straight.
    pub sinuosity: f64,
    /// Share of the steps after which a vein is within [`APEX_REACH`] of the apex; 1 if never.
    pub apex_reached_at: f64,
    /// Auxin sources that no vein reached.
    pub unreached_sources: usize,
}

/// A vein this near the apex has reached it, in lengths of the blade.
pub const APEX_REACH: f64 = 0.05;

impl VeinMetrics {
    /// Measures a pattern in its blade.
    #[must_use]
    pub fn of(venation: &Venation, margin: &Margin) -> Self {
        let graph = venation.graph();
        let positions = graph.positions();
        let length =
            |(a, b): (NodeId, NodeId)| positions[a as usize].distance(positions[b as usize]);
        let children = graph.child_counts();
        let near = |p: &DVec2| p.distance(margin.apex()) <= APEX_REACH * margin.length_mm();
        // Nodes are numbered as they grew, so the first one near the apex was the first there.
        let first = positions.iter().position(near);
        let counts = venation.nodes_after_step();
        let step = |node: usize| counts.iter().position(|&count| count as usize > node);
        Self {
            nodes: graph.len(),
            tips: children.iter().filter(|count| **count == 0).count(),
            length_mm: graph.edges().map(length).sum(),
            sinuosity: sinuosity(venation),
            apex_reached_at: first
                .and_then(step)
                .map_or(1.0, |made| (made + 1) as f64 / counts.len() as f64),
            unreached_sources: venation.unreached().total(),
        }
    }
}

/// Path over chord of the veins of order 1 and 2, weighted by their chords.
fn sinuosity(venation: &Venation) -> f64 {
    let (graph, orders) = (venation.graph(), venation.orders());
    let positions = graph.positions();
    // A vein runs from its tip towards the root as long as the order stays.
    let mut continued = vec![false; graph.len()];
    for (parent, node) in graph.edges() {
        if orders[parent as usize] == orders[node as usize] {
            continued[parent as usize] = true;
        }
    }
    let (mut paths, mut chords) = (0.0, 0.0);
    for tip in 0..graph.len() as NodeId {
        let order = orders[tip as usize];
        if order > 2 || continued[tip as usize] {
            continue;
        }
        let (mut at, mut path) = (tip, 0.0);
        while let Some(parent) = graph.parent(at) {
            path += positions[at as usize].distance(positions[parent as usize]);
            at = parent;
            if orders[at as usize] != order {
                break;
            }
        }
        paths += path;
        chords += positions[tip as usize].distance(positions[at as usize]);
    }
    if chords > 0.0 { paths / chords } else { 1.0 }
}
