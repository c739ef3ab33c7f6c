//! Junctions moved until the pull of the veins balances.
//!
//! Veins pull at a junction with a force of their width (Bohn, Andreotti, Douady, Munzinger & Couder,
//! Phys. Rev. E 65, 2002); in real leaves Σ w e is nearly 0, e being the unit vector to the other end
//! of each vein. Each sweep moves every junction p by η (Σ w e / Σ w) l, l the shortest of these
//! distances among the veins that get shorter, so that junctions which lie too close part quickly. The
//! nodes along a vein follow in proportion, so that it keeps its shape.
//!
//! Roots, nodes beside the margin and guided veins of the first order stay. A move that would bring a
//! vein across the margin or another vein is halved twice, then left out.

mod faces;

use faces::Faces;
use glam::DVec2;

use super::VeinSpec;
use super::chains::{Chain, Chains, Edge};
use super::graph::{NodeId, VeinGraph};
use super::widths;
use crate::geometry::polygon::{nearest_on_segment, segments_touch};
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;

/// The share η of the imbalance that one sweep takes away. Beyond 0.5 junctions swing; far below,
/// more sweeps are needed for the same.
const SHARE: f64 = 0.45;

/// No edge shrinks below this share of its length in a sweep, so that no two nodes meet.
const LEAST_SHRINK: f64 = 0.5;

/// Nor below this share of a step in all: small areoles do not collapse.
const LEAST_EDGE: f64 = 0.2;

/// A vein between two junctions shrinks to no less than this many steps: the length of veins would
/// shrink on and on, and small areoles with it.
const LEAST_CHAIN: f64 = 0.35;

/// Edges that share a node stay apart by this share of the shorter one.
const LEAST_GAP: f64 = 0.02;

/// A graph in `margin` relaxed as `veins.relaxation` says; as it is at 0. Veins pull with their widths
/// after the settings, those of a tree where widths come from the flow.
#[must_use]
pub fn relaxed(spec: &VeinSpec, margin: &Margin, graph: VeinGraph) -> VeinGraph {
    if spec.relaxation == 0 || graph.is_empty() {
        return graph;
    }
    let (radii, _) = widths::of_tree(spec, &graph, spec.tip_radius_mm);
    let relaxation = Relaxation::new(&graph, &radii, margin.lines(), spec);
    let mut places = relaxation.run(spec.relaxation).into_iter();
    graph.mapped(|old| places.next().unwrap_or(old))
}

struct Relaxation {
    chains: Chains,
    /// The pull of each chain: its mean radius.
    pulls: Vec<f64>,
    /// Nodes that stay.
    pinned: Vec<bool>,
    /// Both ends of every edge.
    edges: Vec<[NodeId; 2]>,
    margin: SegmentIndex,
    positions: Vec<DVec2>,
    step: f64,
    faces: Option<Faces>,
    /// How strongly faces press, in pulls of the mean vein.
    pressure: f64,
}

impl Relaxation {
    fn new(graph: &VeinGraph, radii: &[f64], margin: SegmentIndex, spec: &VeinSpec) -> Self {
        let step = spec.node_step_mm;
        let chains = Chains::of(graph);
        let positions = graph.positions().to_vec();
        let pulls: Vec<f64> = chains.chains.iter().map(|chain| pull(graph, radii, chain)).collect();
        let mean_pull = pulls.iter().sum::<f64>() / pulls.len().max(1) as f64;
        let pressure = spec.areole_pressure * mean_pull;
        let faces = (pressure > 0.0).then(|| Faces::of(&chains, &positions));
        let is_end: Vec<bool> = chains.at.iter().map(|at| at.len() == 1).collect();
        let is_pinned = |node: NodeId| {
            graph.parent(node).is_none()
                || graph.rank(node).is_some_and(|rank| rank.order <= 1 || is_end[node as usize])
                || margin.nearest(positions[node as usize], step).is_some()
        };
        let pinned = (0..graph.len() as NodeId).map(is_pinned).collect();
        let joins = graph.joins().iter().copied();
        let edges = graph.edges().chain(joins).map(|(a, b)| [a, b]).collect();
        Self { chains, pulls, pinned, edges, margin, positions, step, faces, pressure }
    }

    fn run(mut self, sweeps: u64) -> Vec<DVec2> {
        let free: Vec<NodeId> =
            self.chains.junctions().filter(|&node| !self.pinned[node as usize]).collect();
        for _ in 0..sweeps {
            if let Some(faces) = &mut self.faces {
                faces.measure(&self.chains, &self.positions);
            }
            let at = |node: NodeId| self.positions[node as usize];
            let near = SegmentIndex::new(self.edges.iter().map(|&[a, b]| (at(a), at(b))).collect());
            for &junction in &free {
                let full = self.displacement(junction);
                let _ =
                    [1.0, 0.5, 0.25].iter().any(|&share| self.shift(junction, full * share, &near));
            }
        }
        self.positions
    }

    /// Towards balance, by half a step at most: the index of a sweep knows edges as they were when
    /// it began.
    fn displacement(&self, junction: NodeId) -> DVec2 {
        let here = self.positions[junction as usize];
        let (mut force, mut pulls) = (DVec2::ZERO, 0.0);
        let mut ways: Vec<DVec2> = Vec::with_capacity(3);
        for &number in &self.chains.at[junction as usize] {
            let nodes = &self.chains.chains[number as usize].nodes;
            let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
            if first == last {
                continue;
            }
            let other = if first == junction { last } else { first };
            let towards = self.positions[other as usize] - here;
            let pull = self.pulls[number as usize];
            force += towards.normalize_or_zero() * pull;
            pulls += pull;
            ways.push(towards);
        }
        if let Some(faces) = &self.faces {
            force += faces.push(&self.chains, junction, &self.positions) * self.pressure;
        }
        // Towards the end of a vein it goes a share of its length at most.
        let nearest = ways
            .iter()
            .filter(|towards| towards.dot(force) > 0.0)
            .map(|towards| (towards.length() - LEAST_CHAIN * self.step).max(0.0))
            .fold(f64::INFINITY, f64::min);
        if pulls > 0.0 && nearest.is_finite() {
            (force * (SHARE * nearest / pulls)).clamp_length_max(self.step / 2.0)
        } else {
            DVec2::ZERO
        }
    }

    /// Moves a junction by `by`, and the nodes along its veins with it, unless they would touch
    /// something. Whether it did.
    fn shift(&mut self, junction: NodeId, by: DVec2, near: &SegmentIndex) -> bool {
        if by == DVec2::ZERO {
            return true;
        }
        let mut back = vec![(junction, self.positions[junction as usize])];
        let mut edges = Vec::new();
        let mut moves = vec![(junction, 1.0)];
        for &number in &self.chains.at[junction as usize] {
            let nodes = &self.chains.chains[number as usize].nodes;
            let length = |pair: &[NodeId]| {
                self.positions[pair[0] as usize].distance(self.positions[pair[1] as usize])
            };
            edges.extend(nodes.windows(2).map(|pair| ([pair[0], pair[1]], length(pair))));
            if nodes[0] == nodes[nodes.len() - 1] {
                // A loop back to the junction keeps its place; only its two ends move.
                continue;
            }
            self.follow(nodes, junction, &mut moves);
        }
        back.extend(moves[1..].iter().map(|&(node, _)| (node, self.positions[node as usize])));
        moves.iter().for_each(|&(node, share)| self.positions[node as usize] += by * share);
        let sound = edges.iter().all(|&(ends, length)| self.is_sound(ends, length, near));
        if !sound {
            back.into_iter().for_each(|(node, p)| self.positions[node as usize] = p);
        }
        sound
    }

    /// The nodes along a vein move less the farther they are from the junction, up to the first one
    /// that stays.
    fn follow(&self, nodes: &[NodeId], junction: NodeId, moves: &mut Vec<(NodeId, f64)>) {
        let last = nodes.len() - 1;
        let away = |i: usize| if nodes[0] == junction { nodes[i] } else { nodes[last - i] };
        if self.drifts(away(last)) {
            // A veinlet goes along whole: else its junction would climb up to its tip.
            moves.extend((1..=last).map(|i| (away(i), 1.0)));
            return;
        }
        let at = |i: usize| self.positions[away(i) as usize];
        let end = (1..last).find(|&i| self.pinned[away(i) as usize]).unwrap_or(last);
        let total: f64 = (0..end).map(|i| at(i).distance(at(i + 1))).sum();
        let mut along = 0.0;
        for i in 1..end {
            along += at(i - 1).distance(at(i));
            moves.push((away(i), 1.0 - along / total));
        }
    }

    /// Whether a node is the free end of a vein that may move.
    fn drifts(&self, node: NodeId) -> bool {
        self.chains.at[node as usize].len() == 1 && !self.pinned[node as usize]
    }

    /// Whether an edge that was `old` long may be where it is.
    fn is_sound(&self, [a, b]: [NodeId; 2], old: f64, near: &SegmentIndex) -> bool {
        let at = |node: NodeId| self.positions[node as usize];
        let (p, q) = (at(a), at(b));
        let length = p.distance(q);
        if length < old && (length < old * LEAST_SHRINK || length < self.step * LEAST_EDGE) {
            return false;
        }
        let touches = |other: usize| {
            let [c, d] = self.edges[other];
            let Some(hub) = [a, b].into_iter().find(|&node| node == c || node == d) else {
                return segments_touch(p, q, at(c), at(d));
            };
            let mine = if hub == a { b } else { a };
            let theirs = if hub == c { d } else { c };
            // The edge itself, or a second one between the same nodes.
            mine != theirs && gap(at(hub), at(mine), at(theirs)) < LEAST_GAP
        };
        let reach = DVec2::splat(self.step);
        !self.margin.touches(p, q) && !near.any_near(p.min(q) - reach, p.max(q) + reach, touches)
    }
}

/// How far two edges from `hub` keep apart, as a share of the shorter one.
fn gap(hub: DVec2, a: DVec2, b: DVec2) -> f64 {
    let apart =
        a.distance(nearest_on_segment(hub, b, a)).min(b.distance(nearest_on_segment(hub, a, b)));
    apart / hub.distance(a).min(hub.distance(b))
}

/// The mean radius along a chain: an edge is as wide as its younger node, a join as its thinner end.
fn pull(graph: &VeinGraph, radii: &[f64], chain: &Chain) -> f64 {
    let at = |node: NodeId| graph.positions()[node as usize];
    let (mut weighted, mut total) = (0.0, 0.0);
    for (pair, &edge) in chain.nodes.windows(2).zip(&chain.edges) {
        let length = at(pair[0]).distance(at(pair[1]));
        let radius = match edge {
            Edge::Parent(node) => radii[node as usize],
            Edge::Join(_) => radii[pair[0] as usize].min(radii[pair[1] as usize]),
        };
        weighted += length * radius;
        total += length;
    }
    if total > 0.0 { weighted / total } else { 0.0 }
}

#[cfg(test)]
mod tests;
