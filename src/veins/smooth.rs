//! Grown veins without kinks.
//!
//! A vein that grew in a small leaf has few nodes far apart once the leaf is grown: it shows as a
//! kinked line. Here nodes move towards the middle of their neighbours along the vein (a low pass),
//! and long segments become pieces of Catmull–Rom curves. Roots, tips and guided veins stay; nothing
//! crosses the margin, and what would cross another vein stays as it grew.

use std::collections::HashSet;

use glam::DVec2;

use super::VeinSpec;
use super::chains::{Chains, Edge};
use super::graph::{NodeId, VeinGraph};
use super::{orders, planar, widths};
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;

/// How often each node moves.
const ROUNDS: usize = 6;

/// A node moves this share of its longest segment at most: neighbouring veins stay apart.
const FARTHEST: f64 = 0.35;

/// A segment longer than this (in steps) becomes several.
const LONG: f64 = 1.5;

/// A graph that was smoothed, with the counts of nodes after each step.
#[derive(Debug, Clone, PartialEq)]
pub struct Smoothed {
    /// The graph.
    pub graph: VeinGraph,
    /// How many of its nodes there were after each step. A node put into a segment came with the
    /// node at its end.
    pub nodes_after_step: Vec<u32>,
}

/// A graph in `margin` smoothed as `veins.smoothing` says; as it is at 0.
#[must_use]
pub fn smoothed(
    spec: &VeinSpec,
    margin: &Margin,
    graph: VeinGraph,
    nodes_after_step: Vec<u32>,
) -> Smoothed {
    if spec.smoothing == 0.0 || graph.is_empty() {
        return Smoothed { graph, nodes_after_step };
    }
    let lines = margin.lines();
    let inside = SegmentIndex::of_polygon(margin.outline());
    let blade = Blade { lines, inside };
    let heirs = heirs(&graph, spec);
    let longest = LONG * spec.node_step_mm;
    let pieces = if spec.sinuosity > 0.0 { least_pieces(&graph) } else { vec![1; graph.len()] };
    let mut stiff = vec![false; graph.len()];
    loop {
        let positions = low_pass(&graph, &heirs, &blade, &stiff, spec);
        let shape = Shape {
            positions: &positions,
            heirs: &heirs,
            stiff: &stiff,
            pieces: &pieces,
            blade: &blade,
        };
        let (finer, renumbered) = subdivided(&graph, shape, longest);
        if !stiffen(&mut stiff, &graph, &finer, &renumbered) {
            let count =
                |old: &u32| old.checked_sub(1).map_or(0, |last| renumbered[last as usize] + 1);
            let nodes_after_step = nodes_after_step.iter().map(count).collect();
            return Smoothed { graph: finer, nodes_after_step };
        }
    }
}

/// Marks the ends of segments of which pieces cross; whether there are new ones.
fn stiffen(
    stiff: &mut [bool],
    graph: &VeinGraph,
    finer: &VeinGraph,
    renumbered: &[NodeId],
) -> bool {
    let mut any = false;
    // A node put into a segment comes just before the node at its end.
    let origin = |node: NodeId| renumbered.partition_point(|&new| new < node) as NodeId;
    for (a, b) in planar::crossing_edges(finer) {
        let end = origin(b);
        let grown = finer.parent(b) == Some(a);
        let start = if grown { graph.parent(end).unwrap_or(end) } else { origin(a) };
        for node in [start, end] {
            any |= !std::mem::replace(&mut stiff[node as usize], true);
        }
    }
    any
}

/// Where the nodes have come to and what else gives segments their form.
#[derive(Clone, Copy)]
struct Shape<'a> {
    positions: &'a [DVec2],
    heirs: &'a [Option<NodeId>],
    /// Nodes that stay where they grew; segments between two of them stay straight.
    stiff: &'a [bool],
    /// The least number of pieces of the segment that ends at each node.
    pieces: &'a [u8],
    blade: &'a Blade,
}

struct Blade {
    lines: SegmentIndex,
    inside: SegmentIndex,
}

impl Blade {
    fn is_free(&self, a: DVec2, b: DVec2) -> bool {
        !self.lines.touches(a, b)
    }
}

/// The child that carries each vein on: the widest, and among equals the straightest.
fn heirs(graph: &VeinGraph, spec: &VeinSpec) -> Vec<Option<NodeId>> {
    let radii = widths::murray(graph, spec.tip_radius_mm, spec.murray_exponent);
    orders::heirs(graph, &orders::by_width(graph, &radii))
}

/// Pieces to the stretch of vein between two junctions that is to bow.
const BOWING: usize = 3;

/// For the segment that ends at each node, into how many it must be cut for its vein to bow.
fn least_pieces(graph: &VeinGraph) -> Vec<u8> {
    let mut pieces = vec![1; graph.len()];
    for chain in Chains::of(graph).chains {
        let least = BOWING.div_ceil(chain.edges.len()) as u8;
        for edge in chain.edges {
            if let Edge::Parent(node) = edge {
                pieces[node as usize] = least;
            }
        }
    }
    pieces
}

/// Every node moved towards the middle of its parent and its heir.
fn low_pass(
    graph: &VeinGraph,
    heirs: &[Option<NodeId>],
    blade: &Blade,
    stiff: &[bool],
    spec: &VeinSpec,
) -> Vec<DVec2> {
    let home = graph.positions();
    let mut degrees = graph.child_counts();
    graph.joins().iter().for_each(|&(a, b)| [a, b].iter().for_each(|&i| degrees[i as usize] += 1));
    // Junctions that are in balance stay.
    let is_held = |i: usize| spec.relaxation > 0 && degrees[i] > 1;
    let mut farthest = vec![0.0f64; graph.len()];
    for (parent, child) in graph.edges() {
        let long = FARTHEST * home[parent as usize].distance(home[child as usize]);
        for node in [parent, child] {
            farthest[node as usize] = farthest[node as usize].max(long);
        }
    }
    let mut placed = home.to_vec();
    for _ in 0..ROUNDS {
        let before = placed.clone();
        for node in 0..graph.len() as NodeId {
            let i = node as usize;
            let (Some(parent), Some(heir)) = (graph.parent(node), heirs[i]) else { continue };
            if graph.rank(node).is_some() || stiff[i] || is_held(i) {
                continue;
            }
            let middle = before[parent as usize].midpoint(before[heir as usize]);
            // A branch holds the node that it leaves.
            let weight = spec.smoothing * if degrees[i] > 1 { 0.25 } else { 0.5 };
            let moved = before[i].lerp(middle, weight);
            placed[i] = home[i] + (moved - home[i]).clamp_length_max(farthest[i]);
        }
    }
    // What would leave the blade goes back, with its neighbours, until nothing does.
    loop {
        let mut back = Vec::new();
        for (parent, child) in graph.edges() {
            let (a, b) = (placed[parent as usize], placed[child as usize]);
            let moved = a != home[parent as usize] || b != home[child as usize];
            if moved && !(blade.is_free(a, b) && blade.inside.contains(b)) {
                back.extend([parent, child]);
            }
        }
        back.extend(
            doubles(&placed).into_iter().filter(|&n| placed[n as usize] != home[n as usize]),
        );
        if back.is_empty() {
            return placed;
        }
        back.into_iter().for_each(|node| placed[node as usize] = home[node as usize]);
    }
}

fn bits(p: DVec2) -> [u64; 2] {
    // The sum turns −0 into 0.
    [(p.x + 0.0).to_bits(), (p.y + 0.0).to_bits()]
}

/// Nodes that stand where another one does, all of them.
fn doubles(positions: &[DVec2]) -> Vec<NodeId> {
    let mut sorted: Vec<([u64; 2], NodeId)> =
        positions.iter().enumerate().map(|(i, &p)| (bits(p), i as NodeId)).collect();
    sorted.sort_unstable();
    let same = sorted.windows(2).filter(|pair| pair[0].0 == pair[1].0);
    same.flat_map(|pair| [pair[0].1, pair[1].1]).collect()
}

/// The graph with long segments as several, and the new number of each node.
fn subdivided(graph: &VeinGraph, shape: Shape<'_>, longest: f64) -> (VeinGraph, Vec<NodeId>) {
    let positions = shape.positions;
    let mut finer = VeinGraph::new();
    let mut taken: HashSet<[u64; 2]> = positions.iter().map(|&p| bits(p)).collect();
    let mut renumbered: Vec<NodeId> = Vec::with_capacity(graph.len());
    for node in 0..graph.len() as NodeId {
        let here = positions[node as usize];
        let Some(parent) = graph.parent(node) else {
            let id = finer.add_root(here);
            renumbered.push(id);
            if let Some(rank) = graph.rank(node) {
                finer.set_rank(id, rank);
            }
            continue;
        };
        let mut from = renumbered[parent as usize];
        for p in between(graph, shape, node, parent, longest) {
            if taken.insert(bits(p)) {
                from = finer.sprout(from, p);
                if let Some(rank) = graph.rank(node) {
                    finer.set_rank(from, rank);
                }
            }
        }
        let id = finer.sprout(from, here);
        if let Some(rank) = graph.rank(node) {
            finer.set_rank(id, rank);
        }
        renumbered.push(id);
    }
    for &(a, b) in graph.joins() {
        finer.join(renumbered[a as usize], renumbered[b as usize]);
    }
    (finer, renumbered)
}

/// The nodes to put into the segment from `parent` to `node`.
fn between(
    graph: &VeinGraph,
    shape: Shape<'_>,
    node: NodeId,
    parent: NodeId,
    longest: f64,
) -> Vec<DVec2> {
    let Shape { positions, heirs, stiff, pieces, blade } = shape;
    let at = |node: NodeId| positions[node as usize];
    let (a, b) = (at(parent), at(node));
    let long = (a.distance(b) / longest).ceil() as usize;
    let pieces = long.max(usize::from(pieces[node as usize]));
    if pieces < 2 {
        return Vec::new();
    }
    // A branch leaves straight; a vein goes on as it came.
    let goes_on = heirs[parent as usize] == Some(node);
    let before = graph.parent(parent).filter(|_| goes_on).map_or(a * 2.0 - b, at);
    let after = heirs[node as usize].map_or(b * 2.0 - a, at);
    let curve = |t: f64| {
        // Tangents are limited: a short segment before a long one must not throw it out.
        let limit = a.distance(b);
        let m0 = ((b - before) * 0.5).clamp_length_max(limit);
        let m1 = ((after - a) * 0.5).clamp_length_max(limit);
        let (t2, t3) = (t * t, t * t * t);
        a * (2.0 * t3 - 3.0 * t2 + 1.0)
            + m0 * (t3 - 2.0 * t2 + t)
            + b * (3.0 * t2 - 2.0 * t3)
            + m1 * (t3 - t2)
    };
    // A curve is longer than its chord.
    let pieces = pieces + usize::from(long > 1);
    let shares = (1..pieces).map(|i| i as f64 / pieces as f64);
    if stiff[parent as usize] && stiff[node as usize] {
        return shares.map(|t| a.lerp(b, t)).collect();
    }
    let points: Vec<DVec2> = shares.clone().map(curve).collect();
    let mut last = a;
    let free = points.iter().chain([&b]).all(|&p| {
        let free = blade.is_free(last, p) && blade.inside.contains(p);
        last = p;
        free
    });
    if free { points } else { shares.map(|t| a.lerp(b, t)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::margin::{self, MarginSpec};

    #[test]
    fn no_segment_stays_long_and_counts_follow() {
        let margin = margin::build(&MarginSpec::default()).expect("the default margin");
        let mut graph = VeinGraph::new();
        let mut tip = graph.add_root(DVec2::new(0.0, 5.0));
        for i in 1..12 {
            let kink = if i % 2 == 0 { 1.0 } else { -1.0 };
            tip = graph.sprout(tip, DVec2::new(kink, 5.0 + 4.0 * f64::from(i)));
            if i == 5 {
                graph.sprout(tip, DVec2::new(8.0, 30.0));
            }
        }
        let spec = VeinSpec { smoothing: 1.0, ..VeinSpec::default() };
        let nodes_after_step = vec![1, 4, graph.len() as u32];
        let kinked = graph.clone();
        let made = smoothed(&spec, &margin, graph, nodes_after_step);
        assert_eq!(made.graph.check(), None);
        let at = |node: NodeId| made.graph.positions()[node as usize];
        let longest = made.graph.edges().map(|(a, b)| at(a).distance(at(b))).fold(0.0, f64::max);
        assert!(longest <= LONG * spec.node_step_mm * 1.3, "{longest}");
        assert_eq!(made.nodes_after_step[0], 1);
        assert_eq!(made.nodes_after_step[2], made.graph.len() as u32);
        let fourth = kinked.positions()[3];
        assert!(at(made.nodes_after_step[1] - 1).distance(fourth) < 2.0);
        let stray = made.graph.positions().iter().filter(|p| p.y < 20.0).map(|p| p.x.abs());
        assert!(stray.fold(0.0, f64::max) < 1.1);
    }

    #[test]
    fn nothing_changes_without_smoothing() {
        let margin = margin::build(&MarginSpec::default()).expect("the default margin");
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::new(0.0, 5.0));
        graph.sprout(root, DVec2::new(0.0, 50.0));
        let made = smoothed(&VeinSpec::default(), &margin, graph.clone(), vec![2]);
        assert_eq!(made, Smoothed { graph, nodes_after_step: vec![2] });
    }
}
