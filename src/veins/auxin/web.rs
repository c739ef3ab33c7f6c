//! The edges between the nodes, so far as growth needs to know them: what a step would meet, and how
//! far it is from node to node along the veins.
//!
//! What a step meets is found in one walk over the edges around it: every node is the second end of an
//! edge (a root of one from itself to itself), so that nodes need no grid of their own. With one, laying
//! veins took a fifth longer, for each grid's cells come from far memory.

use std::collections::HashMap;

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

    /// Whether one comes from `a` to `b` along edges over no more than `limit`. No edge's `length` is more than that of
    /// a way round over other nodes. Looks at the nodes from which `b` could still be reached.
    pub(super) fn is_way_within(
        &self,
        a: NodeId,
        b: NodeId,
        limit: f64,
        length: impl Fn(NodeId, NodeId) -> f64,
    ) -> bool {
        // Mostly a few edges: a list is as good as a queue. A node is looked at again when a shorter way to it
        // turns up.
        let mut known = Ways { list: smallvec![(a, 0.0)], shortest: HashMap::new() };
        let mut next = 0;
        while next < known.list.len() {
            let (node, way) = known.list[next];
            next += 1;
            if node == b {
                return true;
            }
            for other in self.beside(node) {
                let way = way + length(node, other);
                // Rounding keeps no node out that a sum of edges would let in.
                let is_worth = way <= limit && way + length(other, b) <= limit * (1.0 + 1e-9);
                if is_worth {
                    known.add(other, way);
                }
            }
        }
        false
    }
}

/// Ways from one node to others.
struct Ways {
    /// In the order in which they were found.
    list: SmallVec<[(NodeId, f64); FEW]>,
    /// The shortest to each node, once there are many.
    shortest: HashMap<NodeId, f64>,
}

/// So many are sooner looked through than looked up.
const FEW: usize = 32;

impl Ways {
    /// Adds a way if it is shorter than those known to its node.
    fn add(&mut self, node: NodeId, way: f64) {
        if self.list.len() <= FEW {
            if self.list.iter().any(|&(other, known)| other == node && known <= way) {
                return;
            }
        } else {
            if self.shortest.is_empty() {
                // Later ones in the list are shorter.
                self.shortest.extend(self.list.iter().copied());
            }
            if self.shortest.get(&node).is_some_and(|&known| known <= way) {
                return;
            }
            self.shortest.insert(node, way);
        }
        self.list.push((node, way));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Rng, Seed, Stage};

    /// Veins of short steps from a few roots, some of which stay alone, with joins here and there.
    fn web(rng: &mut Rng) -> (Web, Vec<DVec2>, Vec<Edge>) {
        let mut web = Web::new(Rect { min: DVec2::ZERO, max: DVec2::ONE }, 0.1);
        let mut positions: Vec<DVec2> =
            (0..8).map(|_| DVec2::new(rng.unit(), rng.unit())).collect();
        (0..8).for_each(|root| web.add_root(root, &positions));
        let mut edges = Vec::new();
        for child in 8..200 {
            let parent = 3 + (rng.unit() * f64::from(child - 3)) as NodeId;
            let way = DVec2::from_angle(rng.between(0.0, std::f64::consts::TAU));
            positions.push(positions[parent as usize] + 0.05 * way);
            edges.push((parent, child));
            web.add((parent, child), &positions);
            if child % 20 == 0 {
                edges.push((child - 1, child));
                web.add((child - 1, child), &positions);
            }
        }
        (web, positions, edges)
    }

    #[test]
    fn a_step_meets_what_a_look_at_everything_finds() {
        let mut rng = Seed(3).stream(Stage::Tissue);
        let (web, positions, edges) = web(&mut rng);
        let (mut taken, mut stopped) = (0, 0);
        for _ in 0..2000 {
            let from = (rng.unit() * positions.len() as f64) as NodeId;
            let p = positions[from as usize];
            let q = p + 0.05 * DVec2::from_angle(rng.between(0.0, std::f64::consts::TAU));
            let near = |_: NodeId, other: DVec2| other.distance(q) < 0.02;
            let met = web.met(p, q, DVec2::splat(0.02), [from, from], near, &positions);
            let is_taken = positions.iter().any(|&other| near(0, other));
            let ends = |edge: Edge| (positions[edge.0 as usize], positions[edge.1 as usize]);
            let in_the_way = |&(a, b): &Edge| {
                let (c, d) = ends((a, b));
                a != from && b != from && segments_near(p, q, c, d, CLEARANCE_MM)
            };
            let way = |edge: Edge| way_to(p, q, ends(edge).0, ends(edge).1);
            let first = edges.iter().copied().filter(in_the_way);
            let first = first.min_by(|&a, &b| way(a).total_cmp(&way(b)));
            assert_eq!(met, Met { is_taken, edge: first });
            assert_eq!(web.any_node_near(q, DVec2::splat(0.02), near, &positions), is_taken);
            taken += usize::from(is_taken);
            stopped += usize::from(first.is_some());
        }
        assert!(taken > 100 && stopped > 100, "{taken} taken, {stopped} stopped");
    }

    #[test]
    fn ways_are_found_as_by_looking_at_all_of_them() {
        let mut rng = Seed(5).stream(Stage::Tissue);
        let (web, positions, edges) = web(&mut rng);
        let length = |a: NodeId, b: NodeId| positions[a as usize].distance(positions[b as usize]);
        let (mut near, mut far) = (0, 0);
        for _ in 0..60 {
            let from = (rng.unit() * positions.len() as f64) as NodeId;
            let mut ways = vec![f64::INFINITY; positions.len()];
            ways[from as usize] = 0.0;
            for _ in 0..positions.len() {
                for &(a, b) in &edges {
                    let (to_a, to_b) = (ways[a as usize], ways[b as usize]);
                    ways[b as usize] = to_b.min(to_a + length(a, b));
                    ways[a as usize] = to_a.min(to_b + length(a, b));
                }
            }
            for (to, &way) in (0..).zip(&ways) {
                let limit = rng.between(0.0, 0.8);
                if (way - limit).abs() < 1e-9 {
                    continue;
                }
                let is_near = web.is_way_within(from, to, limit, length);
                assert_eq!(is_near, way < limit, "{from} to {to}: {way}, {limit}");
                near += usize::from(is_near);
                far += usize::from(!is_near && way < 1.0);
            }
        }
        assert!(near > 1000 && far > 1000, "{near} near, {far} far");
    }

    #[test]
    fn a_root_is_found_though_no_edge_leads_to_it() {
        let positions = [DVec2::splat(0.5), DVec2::splat(0.9)];
        let mut web = Web::new(Rect { min: DVec2::ZERO, max: DVec2::ONE }, 0.1);
        (0..2).for_each(|root| web.add_root(root, &positions));
        let is_there = |node: NodeId, _: DVec2| node == 0;
        let near = |p| web.any_node_near(p, DVec2::splat(0.01), is_there, &positions);
        assert!(near(positions[0]) && !near(positions[1]));
        // It is no vein: it is in nobody's way and beside nobody, itself neither.
        assert_eq!(web.crossed(DVec2::ZERO, DVec2::ONE, [NONE, NONE], &positions), None);
        assert!(web.is_tip(0) && !web.are_beside(0, 0));
    }
}
