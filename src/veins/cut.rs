//! Long pieces of vein cut into steps, so that veins can bend and branch along them.

use super::graph::VeinGraph;

/// A graph of which no edge from a node to its parent is longer than `longest` (mm); what is put between
/// stands on the straight line.
#[must_use]
pub(super) fn cut(graph: &VeinGraph, longest: f64) -> VeinGraph {
    let mut made = VeinGraph::new();
    let mut numbers = Vec::with_capacity(graph.len());
    for (node, &p) in (0..).zip(graph.positions()) {
        let Some(parent) = graph.parent(node) else {
            numbers.push(made.add_root(p));
            continue;
        };
        let start = graph.positions()[parent as usize];
        let pieces = (start.distance(p) / longest).ceil().max(1.0) as usize;
        let mut last = numbers[parent as usize];
        for i in 1..=pieces {
            let place = if i == pieces { p } else { start.lerp(p, i as f64 / pieces as f64) };
            last = made.sprout(last, place);
            if let Some(rank) = graph.rank(node) {
                made.set_rank(last, rank);
            }
        }
        numbers.push(last);
    }
    for &(a, b) in graph.joins() {
        made.join(numbers[a as usize], numbers[b as usize]);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn long_pieces_become_steps_and_short_ones_stay() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let far = graph.sprout(root, DVec2::new(0.0, 2.5));
        graph.sprout(far, DVec2::new(0.5, 2.5));
        let made = cut(&graph, 1.0);
        assert_eq!(made.check(), None);
        let heights: Vec<f64> = made.positions().iter().map(|p| p.y).collect();
        assert_eq!(made.len(), 5);
        assert!((heights[1] - 2.5 / 3.0).abs() < 1e-12 && heights[3] == 2.5, "{heights:?}");
        assert_eq!(made.parent(4), Some(3));
        assert_eq!(cut(&made, 1.0), made);
    }
}
