//! Which vein is primary, which secondary, and so on.
//!
//! Leaf architecture ranks veins by width where they leave their parent vein (Manual of Leaf
//! Architecture, 2009): at a fork the widest child carries the vein on and keeps its order, every
//! other begins a vein of the next order. Between children of (nearly) one width the straighter one
//! carries on. Orders that were given (guided veins) stay; what grows out of such a vein begins at the
//! order after the highest that was given.

use super::graph::{NodeId, VeinGraph};

/// Finer veins are not told apart: manuals rank up to the seventh order.
pub const HIGHEST_ORDER: u8 = 7;

/// Children whose radii are within this share of the widest count as equally wide: under Murray's law
/// a tenth of the radius is a third of the tips, and near the apex a tip more or less is chance.
const NEARLY: f64 = 0.1;

/// The order of the vein at each node: 1 primary, 2 secondary, …, at most [`HIGHEST_ORDER`].
#[must_use]
pub fn by_width(graph: &VeinGraph, radii: &[f64]) -> Vec<u8> {
    let n = graph.len();
    // The children of each node, as lists in order of birth.
    let (mut first, mut next) = (vec![NodeId::MAX; n], vec![NodeId::MAX; n]);
    for (parent, child) in graph.edges().collect::<Vec<_>>().into_iter().rev() {
        next[child as usize] = first[parent as usize];
        first[parent as usize] = child;
    }
    let entry = |id: NodeId| (id != NodeId::MAX).then_some(id);
    let next = &next;
    let children = |node: NodeId| {
        std::iter::successors(entry(first[node as usize]), move |&id| entry(next[id as usize]))
    };
    let mut orders = vec![1u8; n];
    let first_free = (graph.highest_rank() + 1).min(HIGHEST_ORDER);
    for node in 0..n as NodeId {
        if let Some(rank) = graph.rank(node) {
            orders[node as usize] = rank.order;
            for child in children(node) {
                orders[child as usize] = first_free;
            }
            continue;
        }
        let Some(main) = main_child(graph, radii, node, children(node)) else { continue };
        for child in children(node) {
            let order = orders[node as usize];
            let order = if child == main { order } else { (order + 1).min(HIGHEST_ORDER) };
            orders[child as usize] = order;
        }
    }
    orders
}

/// The child that carries each vein on, at the same order.
#[must_use]
pub fn heirs(graph: &VeinGraph, orders: &[u8]) -> Vec<Option<NodeId>> {
    let mut heirs: Vec<Option<NodeId>> = vec![None; graph.len()];
    for (parent, child) in graph.edges() {
        let carries_on = orders[parent as usize] == orders[child as usize];
        if carries_on && heirs[parent as usize].is_none() {
            heirs[parent as usize] = Some(child);
        }
    }
    heirs
}

/// The child that carries the vein on.
fn main_child(
    graph: &VeinGraph,
    radii: &[f64],
    node: NodeId,
    children: impl Iterator<Item = NodeId> + Clone,
) -> Option<NodeId> {
    let positions = graph.positions();
    let here = positions[node as usize];
    let widest = children.clone().map(|child| radii[child as usize]).fold(0.0, f64::max);
    let before = graph.parent(node).map_or(glam::DVec2::Y, |p| here - positions[p as usize]);
    let straightness = |child: NodeId| {
        (positions[child as usize] - here).normalize_or_zero().dot(before.normalize_or_zero())
    };
    children
        .filter(|&child| radii[child as usize] >= widest * (1.0 - NEARLY))
        .map(|child| (straightness(child), child))
        // The first among equals: `max_by` would take the last.
        .reduce(|best, other| if other.0 > best.0 { other } else { best })
        .map(|(_, child)| child)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::veins::widths::murray;
    use glam::DVec2;

    #[test]
    fn the_midrib_is_primary_and_its_branches_are_secondary() {
        let mut graph = VeinGraph::new();
        let mut midrib = vec![graph.add_root(DVec2::ZERO)];
        for i in 1..=6 {
            midrib.push(graph.sprout(midrib[i - 1], DVec2::new(0.0, i as f64)));
        }
        graph.sprout(midrib[5], DVec2::new(-1.0, 5.5));
        graph.sprout(midrib[5], DVec2::new(1.0, 5.5));
        let branch = graph.sprout(midrib[3], DVec2::new(1.0, 3.5));
        let twig = graph.sprout(branch, DVec2::new(2.0, 4.0));
        let fork = graph.sprout(branch, DVec2::new(1.2, 4.5));
        let radii = murray(&graph, 0.1, 3.0);
        let orders = by_width(&graph, &radii);
        assert!(midrib.iter().all(|&node| orders[node as usize] == 1));
        assert_eq!([branch, twig, fork].map(|node| orders[node as usize]), [2, 2, 3]);
    }
}
