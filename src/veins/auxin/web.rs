//! The edges between the nodes, so far as growth needs to know them: what a step would meet, and how
//! far it is from node to node along the veins.
//!
//! What a step meets is found in one walk over the edges around it: every node is the second end of an
//! edge (a root of one from itself to itself), so that nodes need no grid of their own. With one, laying
//! veins took a fifth longer, for each grid's cells come from far memory.

use glam::DVec2;
use smallvec::{SmallVec, smallvec};

use super::NONE;
use crate::geometry::Rect;
use crate::geometry::polygon::{cross, segments_near};
use crate::geometry::segment_grid::SegmentGrid;
use crate::parallel;
use crate::veins::graph::NodeId;
use crate::veins::planar::CLEARANCE_MM;

/// An edge, the nodes at its ends in the order in which it was made.
pub(super) type Edge = (NodeId, NodeId);

/// What a step would meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Met {
    /// Whether a node takes the place of its end.
    pub(super) is_taken: bool,
    /// The edge that it first crosses, touches or all but touches.
    pub(super) edge: Option<Edge>,
}

/// Edges by place and by node.
#[derive(Debug)]
pub(super) struct Web {
    grid: SegmentGrid,
    /// The first link of each node.
    firsts: Vec<u32>,
    /// Lists of the nodes beside each: a node and the next link. Two for each edge, at its first end and at
    /// the other.
    links: Vec<(NodeId, u32)>,
}

impl Web {
    /// No edges yet, in cells of about `cell`.
    pub(super) fn new(bounds: Rect, cell: f64) -> Self {
        let grid = SegmentGrid::new(bounds, cell);
        Self { grid, firsts: Vec::new(), links: Vec::new() }
    }

    /// Makes room for so many more nodes, each with an edge.
    pub(super) fn expect(&mut self, more: usize) {
        self.grid.expect(more);
        parallel::make_room(&mut self.firsts, more, NONE);
        parallel::make_room(&mut self.links, 2 * more, (NONE, NONE));
    }

    /// Takes note of a node that no edge leads to.
    pub(super) fn add_root(&mut self, root: NodeId, positions: &[DVec2]) {
        let place = positions[root as usize];
        self.grid.push(place, place);
        // In no list: it is beside nobody.
        self.links.extend([(root, NONE); 2]);
    }

    /// Adds an edge; the node at its second end is new, or both are there and join.
    pub(super) fn add(&mut self, edge: Edge, positions: &[DVec2]) {
        let (a, b) = edge;
        self.grid.push(positions[a as usize], positions[b as usize]);
        self.firsts.resize(positions.len(), NONE);
        for (here, there) in [(a, b), (b, a)] {
            self.links.push((there, self.firsts[here as usize]));
            self.firsts[here as usize] = self.links.len() as u32 - 1;
        }
    }

    pub(super) fn refine(&mut self, cell: f64, positions: &[DVec2]) {
        let Self { grid, links, .. } = self;
        grid.refine(cell, |id| {
            let (a, b) = edge(links, id);
            (positions[a as usize], positions[b as usize])
        });
    }

    /// Whether `test` holds for a node in the box of half size `half` around `p`; some beyond it are tested,
    /// too.
    pub(super) fn any_node_near(
        &self,
        p: DVec2,
        half: DVec2,
        test: impl Fn(NodeId, DVec2) -> bool,
        positions: &[DVec2],
    ) -> bool {
        let mut is_there = false;
        self.grid.for_each_near(p - half, p + half, |id| {
            let (_, node) = edge(&self.links, id);
            is_there = is_there || test(node, positions[node as usize]);
        });
        is_there
    }

    /// The edge that a line first crosses, touches or all but touches on its way from `p` to `q`, those at
    /// the nodes `apart` excepted.
    pub(super) fn crossed(
        &self,
        p: DVec2,
        q: DVec2,
        apart: [NodeId; 2],
        positions: &[DVec2],
    ) -> Option<Edge> {
        self.met(p, q, DVec2::ZERO, apart, |_, _| false, positions).edge
    }

    /// What is met on the way from `p` to `q`: nodes in the box of half size `half` around `q` for which
    /// `takes` holds, and edges, those at the nodes `apart` excepted.
    pub(super) fn met(
        &self,
        p: DVec2,
        q: DVec2,
        half: DVec2,
        apart: [NodeId; 2],
        takes: impl Fn(NodeId, DVec2) -> bool,
        positions: &[DVec2],
    ) -> Met {
        let mut first = (f64::INFINITY, NONE);
        let mut is_taken = false;
        self.grid.for_each_near(p.min(q - half), p.max(q + half), |id| {
            let (a, b) = edge(&self.links, id);
            let end = positions[b as usize];
            is_taken |= takes(b, end);
            if a == b || apart.contains(&a) || apart.contains(&b) {
                return;
            }
            let start = positions[a as usize];
            if segments_near(p, q, start, end, CLEARANCE_MM) {
                let way = way_to(p, q, start, end);
                if way < first.0 || (way == first.0 && id < first.1) {
                    first = (way, id);
                }
            }
        });
        Met { is_taken, edge: (first.1 != NONE).then(|| edge(&self.links, first.1)) }
    }

    fn beside(&self, node: NodeId) -> impl Iterator<Item = NodeId> + '_ {
        let link = |at: u32| (at != NONE).then(|| self.links[at as usize]);
        let first = self.firsts.get(node as usize).copied().unwrap_or(NONE);
        std::iter::successors(link(first), move |&(_, next)| link(next)).map(|(node, _)| node)
    }

    /// Whether an edge from `node` to `p` would lie on one that the node already has: nearer to it than
    /// `least`, as `way` measures from the node.
    pub(super) fn overlaps(
        &self,
        node: NodeId,
        p: DVec2,
        least: f64,
        way: impl Fn(DVec2) -> DVec2,
        positions: &[DVec2],
    ) -> bool {
        let new = way(p);
        self.beside(node).any(|other| {
            let old = way(positions[other as usize]);
            let longer2 = new.length_squared().max(old.length_squared());
            let apart = new.perp_dot(old);
            new.dot(old) > 0.0 && apart * apart < least * least * longer2
        })
    }

    /// Whether one edge at most ends at a node.
    pub(super) fn is_tip(&self, node: NodeId) -> bool {
        self.beside(node).nth(1).is_none()
    }

    pub(super) fn are_beside(&self, a: NodeId, b: NodeId) -> bool {
        self.beside(a).any(|node| node == b)
    }

    /// Whether one comes from `a` to `b` along edges over no more than `limit`.
    pub(super) fn is_way_within(
        &self,
        a: NodeId,
        b: NodeId,
        limit: f64,
        length: impl Fn(NodeId, NodeId) -> f64,
    ) -> bool {
        // A few edges at most: a list is as good as a queue. A node is looked at again when a
        // shorter way to it turns up.
        let mut known: SmallVec<[_; 32]> = smallvec![(a, 0.0)];
        let mut next = 0;
        while next < known.len() {
            let (node, way) = known[next];
            next += 1;
            if node == b {
                return true;
            }
            for other in self.beside(node) {
                let way = way + length(node, other);
                let is_shorter =
                    known.iter().all(|&(node, known_way)| node != other || way < known_way);
                if way <= limit && is_shorter {
                    known.push((other, way));
                }
            }
        }
        false
    }
}

/// The edge of a number.
fn edge(links: &[(NodeId, u32)], id: u32) -> Edge {
    let at = 2 * id as usize;
    (links[at + 1].0, links[at].0)
}

/// Which share of the way from `p` to `q` lies before the line through `a` and `b`.
fn way_to(p: DVec2, q: DVec2, a: DVec2, b: DVec2) -> f64 {
    let (before, after) = (cross(a, b, p), cross(a, b, q));
    if before == after { 0.0 } else { before / (before - after) }
}
