//! Where edges of a vein pattern cross.

use super::graph::{NodeId, VeinGraph};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::polygon::segments_touch;

/// Edges that cross or touch another with which they share no node; joins are edges too.
#[must_use]
pub fn crossing_edges(graph: &VeinGraph) -> Vec<(NodeId, NodeId)> {
    let edges: Vec<(NodeId, NodeId)> = graph.edges().chain(graph.joins().iter().copied()).collect();
    let positions = graph.positions();
    let ends = |edge: usize| {
        let (a, b) = edges[edge];
        (positions[a as usize], positions[b as usize])
    };
    let length: f64 = (0..edges.len()).map(|i| ends(i).0.distance(ends(i).1)).sum();
    let bounds = Rect::around(positions.iter().copied());
    let boxes = (0..edges.len()).map(|i| Rect::around(<[_; 2]>::from(ends(i))));
    let cells = BoxCells::new(bounds, 1.5 * length / edges.len().max(1) as f64, boxes);
    let mut crossing = Vec::new();
    cells.for_each_pair(|i, j| {
        let ((a, b), (c, d)) = (edges[i as usize], edges[j as usize]);
        let ((p, q), (r, s)) = (ends(i as usize), ends(j as usize));
        let apart = a != c && a != d && b != c && b != d;
        if apart && segments_touch(p, q, r, s) {
            crossing.extend([(a, b), (c, d)]);
        }
    });
    crossing.sort_unstable();
    crossing.dedup();
    crossing
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn two_of_three_edges_cross() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let across = graph.sprout(root, DVec2::new(2.0, 2.0));
        let up = graph.sprout(root, DVec2::new(0.0, 2.0));
        let right = graph.sprout(across, DVec2::new(2.0, 0.0));
        assert_eq!(crossing_edges(&graph), []);
        graph.join(up, right);
        assert_eq!(crossing_edges(&graph), [(root, across), (up, right)]);
    }
}
