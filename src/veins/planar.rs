//! Where edges of a vein pattern cross.

use glam::DVec2;

use super::graph::{NodeId, VeinGraph};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::polygon::{nearest_on_segment, segments_near};
use crate::geometry::segments::SegmentIndex;

/// Veins that do not meet keep this far apart (mm): files hold millionths of a millimetre, in which what is
/// nearer may cross. Far below what can be seen.
pub const CLEARANCE_MM: f64 = 4e-6;

/// Edges that share a node stay apart by this share of the shorter one.
pub(super) const LEAST_GAP: f64 = 0.02;

/// An edge and the box around it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Line {
    ends: [NodeId; 2],
    from: DVec2,
    to: DVec2,
    around: Rect,
}

impl Line {
    pub(super) fn new(ends: [NodeId; 2], positions: &[DVec2]) -> Self {
        let (from, to) = (positions[ends[0] as usize], positions[ends[1] as usize]);
        Self { ends, from, to, around: Rect::between(from, to).grown(CLEARANCE_MM / 2.0) }
    }

    /// What may be in its way meets this box.
    #[inline]
    pub(super) fn around(&self) -> Rect {
        self.around
    }

    /// Whether it touches a segment.
    pub(super) fn touches(&self, segments: &SegmentIndex) -> bool {
        segments.touches(self.from, self.to)
    }

    /// Whether two edges touch, all but touch, or come too close where they share a node.
    pub(super) fn is_in_the_way(&self, other: &Self) -> bool {
        if !self.around.meets(other.around) {
            return false;
        }
        let [a, b] = self.ends;
        let [c, d] = other.ends;
        let (hub, mine, theirs) = if a == c {
            (self.from, (b, self.to), (d, other.to))
        } else if a == d {
            (self.from, (b, self.to), (c, other.from))
        } else if b == c {
            (self.to, (a, self.from), (d, other.to))
        } else if b == d {
            (self.to, (a, self.from), (c, other.from))
        } else {
            return segments_near(self.from, self.to, other.from, other.to, CLEARANCE_MM);
        };
        // The edge itself, or a second one between the same nodes.
        mine.0 != theirs.0 && is_gap_below(hub, mine.1, theirs.1, LEAST_GAP)
    }
}

/// Whether two edges from `hub` keep apart by less than a share of the shorter one.
pub(super) fn is_gap_below(hub: DVec2, a: DVec2, b: DVec2, share: f64) -> bool {
    let (to_a, to_b) = (a - hub, b - hub);
    let (along, across) = (to_a.dot(to_b), to_a.perp_dot(to_b));
    // The share is at least the sine of the angle between them, and 1 from a right angle on: only two that
    // lie nearly on each other are measured. A hundredth more, for rounding.
    let sine2 = 1.02 * share * share;
    if along <= 0.0 || across * across > sine2 * to_a.length_squared() * to_b.length_squared() {
        return false;
    }
    let apart =
        a.distance(nearest_on_segment(hub, b, a)).min(b.distance(nearest_on_segment(hub, a, b)));
    apart / hub.distance(a).min(hub.distance(b)) < share
}

/// Edges that are in the way of another: that cross it, touch it or all but do, or lie nearly on it where
/// they share a node; joins are edges too.
#[must_use]
pub fn crossing_edges(graph: &VeinGraph) -> Vec<(NodeId, NodeId)> {
    let edges: Vec<(NodeId, NodeId)> = graph.edges().chain(graph.joins().iter().copied()).collect();
    let positions = graph.positions();
    let lines: Vec<Line> = edges.iter().map(|&(a, b)| Line::new([a, b], positions)).collect();
    let length: f64 = lines.iter().map(|line| line.from.distance(line.to)).sum();
    let bounds = Rect::around(positions.iter().copied());
    let boxes = lines.iter().map(Line::around);
    let cells = BoxCells::new(bounds, 1.5 * length / edges.len().max(1) as f64, boxes);
    let mut crossing = Vec::new();
    cells.for_each_pair(|i, j| {
        let (i, j) = (i as usize, j as usize);
        if lines[i].is_in_the_way(&lines[j]) {
            crossing.extend([edges[i], edges[j]]);
        }
    });
    crossing.sort_unstable();
    crossing.dedup();
    crossing
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn what_all_but_touches_is_in_the_way() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let across = graph.sprout(root, DVec2::new(2.0, 0.0));
        let beyond = graph.sprout(across, DVec2::new(2.0, 2.0));
        let tip = graph.sprout(beyond, DVec2::new(1.0, CLEARANCE_MM * 2.0));
        assert_eq!(crossing_edges(&graph), []);
        let mut heights = [0.0, 0.0, 2.0, CLEARANCE_MM / 2.0].into_iter();
        let nearer = graph.mapped(|p| DVec2::new(p.x, heights.next().unwrap_or(p.y)));
        assert_eq!(crossing_edges(&nearer), [(root, across), (beyond, tip)]);
    }

    #[test]
    fn edges_of_one_node_that_lie_nearly_on_each_other_are_in_the_way() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let one = graph.sprout(root, DVec2::new(2.0, 0.0));
        let other = graph.sprout(root, DVec2::new(1.0, 0.021));
        assert_eq!(crossing_edges(&graph), []);
        let nearer = graph.mapped(|p| DVec2::new(p.x, p.y.min(0.019)));
        assert_eq!(crossing_edges(&nearer), [(root, one), (root, other)]);
    }
}
