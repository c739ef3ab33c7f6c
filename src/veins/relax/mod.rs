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
mod net;
mod room;

use faces::Faces;
use glam::DVec2;
use net::Net;
use room::{Moved, Room};

use super::VeinSpec;
use super::chains::{Chain, Chains, Edge};
use super::graph::{NodeId, VeinGraph};
use super::widths;
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

/// A graph in `margin` relaxed as `veins.relaxation` says; as it is at 0. Veins pull with their widths
/// after the settings, those of a tree where widths come from the flow. `swept` is called after every
/// sweep.
#[must_use]
pub fn relaxed(
    spec: &VeinSpec,
    margin: &Margin,
    graph: VeinGraph,
    swept: impl FnMut(),
) -> VeinGraph {
    if spec.relaxation == 0 || graph.is_empty() {
        return graph;
    }
    let (radii, _) = widths::of_tree(spec, &graph, spec.tip_radius_mm);
    let relaxation = Relaxation::new(&graph, &radii, margin.lines(), spec);
    let mut places = relaxation.run(spec.relaxation, swept).into_iter();
    graph.mapped(|old| places.next().unwrap_or(old))
}

struct Relaxation {
    net: Net,
    room: Room,
    /// Nodes that stay.
    pinned: Vec<bool>,
    /// The junctions that move, in order of place: what one looks at is at hand for the next.
    free: Vec<NodeId>,
    step: f64,
    faces: Option<Faces>,
    /// How strongly faces press, in pulls of the mean vein.
    pressure: f64,
    star: Star,
}

/// A junction on its way; kept for its memory.
#[derive(Default)]
struct Star {
    /// The nodes that go along, and the share of the way that each goes.
    moves: Vec<(NodeId, f64)>,
    /// Where they were.
    back: Vec<DVec2>,
    edges: Vec<Moved>,
    /// From the junction to the other ends of its veins.
    ways: Vec<DVec2>,
}

impl Relaxation {
    fn new(graph: &VeinGraph, radii: &[f64], margin: SegmentIndex, spec: &VeinSpec) -> Self {
        let step = spec.node_step_mm;
        let chains = Chains::of(graph);
        let pulls: Vec<f64> = chains.chains.iter().map(|chain| pull(graph, radii, chain)).collect();
        let mean_pull = pulls.iter().sum::<f64>() / pulls.len().max(1) as f64;
        let pressure = spec.areole_pressure * mean_pull;
        let is_pinned = |node: NodeId| {
            let is_end = chains.at[node as usize].len() == 1;
            graph.parent(node).is_none()
                || graph.rank(node).is_some_and(|rank| rank.order <= 1 || is_end)
                || margin.nearest(graph.positions()[node as usize], step).is_some()
        };
        let net = Net::new(graph, &chains, &pulls);
        let mut pinned = vec![false; graph.len()];
        for node in 0..graph.len() as NodeId {
            pinned[net.number(node) as usize] = is_pinned(node);
        }
        let junctions = chains.junctions().map(|node| net.number(node));
        let mut free: Vec<NodeId> = junctions.filter(|&node| !pinned[node as usize]).collect();
        free.sort_unstable();
        let faces = (pressure > 0.0).then(|| Faces::of(&net));
        let room = Room::new(margin, step);
        Self { net, room, pinned, free, step, faces, pressure, star: Star::default() }
    }

    fn run(mut self, sweeps: u64, mut swept: impl FnMut()) -> Vec<DVec2> {
        let free = std::mem::take(&mut self.free);
        for _ in 0..sweeps {
            if let Some(faces) = &mut self.faces {
                faces.measure(&self.net);
            }
            self.room.begin_sweep(&self.net);
            for &junction in &free {
                let full = self.displacement(junction);
                if full == DVec2::ZERO {
                    continue;
                }
                self.gather(junction);
                let _ = [1.0, 0.5, 0.25].iter().any(|&share| self.shift(full * share));
            }
            swept();
        }
        self.net.places()
    }

    /// Towards balance, by half a step at most: in a sweep edges are looked for around where they were
    /// when it began.
    fn displacement(&mut self, junction: NodeId) -> DVec2 {
        let Self { net, faces, star, .. } = self;
        let here = net.place(junction);
        let (mut force, mut pulls) = (DVec2::ZERO, 0.0);
        star.ways.clear();
        for &chain in net.chains_at(junction) {
            let nodes = net.chain(chain);
            let (first, last) = (nodes[0], nodes[nodes.len() - 1]);
            if first == last {
                continue;
            }
            let other = if first == junction { last } else { first };
            let towards = net.place(other) - here;
            let pull = net.pull(chain);
            force += towards.normalize_or_zero() * pull;
            pulls += pull;
            star.ways.push(towards);
        }
        if let Some(faces) = faces {
            force += faces.push(net, junction) * self.pressure;
        }
        // Towards the end of a vein it goes a share of its length at most.
        let nearest = star
            .ways
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

    /// Finds out what a junction takes along.
    fn gather(&mut self, junction: NodeId) {
        let Star { mut moves, mut back, mut edges, ways } = std::mem::take(&mut self.star);
        let net = &self.net;
        moves.clear();
        edges.clear();
        moves.push((junction, 1.0));
        for &chain in net.chains_at(junction) {
            let nodes = net.chain(chain);
            let length = |pair: &[NodeId]| net.place(pair[0]).distance(net.place(pair[1]));
            edges.extend(nodes.windows(2).map(|pair| ([pair[0], pair[1]], length(pair))));
            if nodes[0] == nodes[nodes.len() - 1] {
                // A loop back to the junction keeps its place; only its two ends move.
                continue;
            }
            self.follow(nodes, junction, &mut moves);
        }
        back.clear();
        back.extend(moves.iter().map(|&(node, _)| net.place(node)));
        self.star = Star { moves, back, edges, ways };
    }

    /// Moves the junction that was gathered by `by`, and the nodes along its veins with it, unless they
    /// would touch something. Whether it did.
    fn shift(&mut self, by: DVec2) -> bool {
        let Self { net, room, star, .. } = self;
        for &(node, share) in &star.moves {
            net.positions[node as usize] += by * share;
        }
        let sound = room.is_sound(&star.edges, net);
        if !sound {
            for (&(node, _), &p) in star.moves.iter().zip(&star.back) {
                net.positions[node as usize] = p;
            }
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
        let at = |i: usize| self.net.place(away(i));
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
        self.net.chains_at(node).len() == 1 && !self.pinned[node as usize]
    }
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
