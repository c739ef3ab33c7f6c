//! Junctions of more than three veins, taken apart into junctions of three.
//!
//! In real leaves 19 of 20 junctions join three veins. Grown ones often join more, because every
//! source calls the node nearest to it and nodes that stick out are called again. As in a foam, where a
//! vertex of four films is unstable and splits in two (J. Plateau; D. Weaire & S. Hutzler, *The Physics
//! of Foams*, 1999), two neighbouring veins leave together: the pair whose pull on a new node gains most
//! over what the piece between the two junctions costs. Beside a much wider vein the thinner one slides
//! along it, which stays as it is.

use glam::DVec2;

use super::graph::{NodeId, Rank, VeinGraph};
use super::{VeinSpec, planar, widths};
use crate::geometry::polygon::segments_near;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;

/// A vein that is this many times as wide as the other stays in its place.
const MUCH_WIDER: f64 = 1.5;

/// The piece between two new junctions, in lengths of the shorter edge of the pair.
const APART: f64 = 0.5;

/// Edges at a node closer together than this (sine) have no room for a piece between them, nor have
/// those that are as far from a fork as this.
const LEAST_ANGLE: f64 = 0.05;

/// A graph in `margin` without junctions of more than three veins, so far as there is room, and how
/// many of its nodes there were after each step; as it is without `veins.relaxation`.
#[must_use]
pub fn split(
    spec: &VeinSpec,
    margin: &Margin,
    graph: VeinGraph,
    nodes_after_step: Vec<u32>,
) -> (VeinGraph, Vec<u32>) {
    if spec.relaxation == 0 || graph.is_empty() {
        return (graph, nodes_after_step);
    }
    let radii = widths::murray(&graph, spec.tip_radius_mm, spec.murray_exponent);
    let (made, counts) = taken_apart(&graph, &radii, &margin.lines());
    let count = |old: &u32| old.checked_sub(1).map_or(0, |last| counts[last as usize]);
    let nodes_after_step = nodes_after_step.iter().map(count).collect();
    (made, nodes_after_step)
}

/// The graph taken apart, and how many nodes it has up to what was each node. `radii` are those of the
/// nodes; `margin` are the lines that no vein crosses.
fn taken_apart(graph: &VeinGraph, radii: &[f64], margin: &SegmentIndex) -> (VeinGraph, Vec<u32>) {
    let mut kept = vec![false; graph.len()];
    loop {
        let mut stars = Stars::of(graph, radii);
        for node in 0..graph.len() as NodeId {
            if !kept[node as usize] {
                stars.split(node, margin);
            }
        }
        let (made, numbers) = stars.graph(graph);
        // What crosses is left as it was.
        let crossing = planar::crossing_edges(&made);
        let origin = |node: NodeId| stars.hosts[numbers.old[node as usize] as usize];
        let mut any = false;
        for host in crossing.into_iter().flat_map(|(a, b)| [origin(a), origin(b)]) {
            any |= !std::mem::replace(&mut kept[host as usize], true);
        }
        if !any {
            return (made, numbers.counts);
        }
    }
}

/// What leaves a node.
#[derive(Debug, Clone, Copy)]
struct Spoke {
    end: End,
    to: NodeId,
    width: f64,
    /// Of a guided vein; the highest for others.
    order: u8,
    direction: DVec2,
    length: f64,
    angle: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum End {
    Parent,
    Child,
    /// The join of this number.
    Join(u32),
}

/// A graph whose edges can be hung anew; added nodes stand at the end.
struct Stars {
    positions: Vec<DVec2>,
    parents: Vec<Option<NodeId>>,
    ranks: Vec<Option<Rank>>,
    radii: Vec<f64>,
    joins: Vec<(NodeId, NodeId)>,
    children: Vec<Vec<NodeId>>,
    joins_at: Vec<Vec<u32>>,
    /// The node of the graph that each belongs to: itself, or the star it was taken from.
    hosts: Vec<NodeId>,
    edges: SegmentIndex,
    edge_ends: Vec<(NodeId, NodeId)>,
}

/// Numbers of nodes before and after.
struct Numbers {
    new: Vec<NodeId>,
    old: Vec<NodeId>,
    /// How many there are after each node and what was taken from its star.
    counts: Vec<u32>,
}

impl Stars {
    fn of(graph: &VeinGraph, radii: &[f64]) -> Self {
        let n = graph.len();
        let edge_ends: Vec<(NodeId, NodeId)> =
            graph.edges().chain(graph.joins().iter().copied()).collect();
        let at = |node: NodeId| graph.positions()[node as usize];
        let edges = SegmentIndex::new(edge_ends.iter().map(|&(a, b)| (at(a), at(b))).collect());
        let mut stars = Self {
            positions: graph.positions().to_vec(),
            parents: (0..n as NodeId).map(|node| graph.parent(node)).collect(),
            ranks: (0..n as NodeId).map(|node| graph.rank(node)).collect(),
            radii: radii.to_vec(),
            joins: graph.joins().to_vec(),
            children: vec![Vec::new(); n],
            joins_at: vec![Vec::new(); n],
            hosts: (0..n as NodeId).collect(),
            edges,
            edge_ends,
        };
        for (parent, child) in graph.edges() {
            stars.children[parent as usize].push(child);
        }
        for (number, &(a, b)) in graph.joins().iter().enumerate() {
            stars.joins_at[a as usize].push(number as u32);
            stars.joins_at[b as usize].push(number as u32);
        }
        stars
    }

    /// What leaves a node, anticlockwise.
    fn spokes(&self, node: NodeId) -> Vec<Spoke> {
        let i = node as usize;
        let here = self.positions[i];
        let mut ends: Vec<(End, NodeId, f64)> = Vec::new();
        ends.extend(self.parents[i].map(|parent| (End::Parent, parent, self.radii[i])));
        ends.extend(
            self.children[i].iter().map(|&child| (End::Child, child, self.radii[child as usize])),
        );
        for &join in &self.joins_at[i] {
            let (a, b) = self.joins[join as usize];
            let other = if a == node { b } else { a };
            let width = self.radii[i].min(self.radii[other as usize]);
            ends.push((End::Join(join), other, width));
        }
        let order = |node: NodeId| self.ranks[node as usize].map_or(u8::MAX, |rank| rank.order);
        let spoke = |(end, to, width): (End, NodeId, f64)| {
            let order = match end {
                End::Parent => order(node),
                End::Child => order(to),
                End::Join(_) => u8::MAX,
            };
            let towards = self.positions[to as usize] - here;
            let direction = towards.normalize_or_zero();
            let angle = libm::atan2(direction.y, direction.x);
            Spoke { end, to, width, order, direction, length: towards.length(), angle }
        };
        let mut spokes: Vec<Spoke> = ends.into_iter().map(spoke).collect();
        spokes.sort_by(|a, b| a.angle.total_cmp(&b.angle).then(a.to.cmp(&b.to)));
        spokes
    }

    /// Takes pairs of veins away from a node until three are left.
    fn split(&mut self, node: NodeId, margin: &SegmentIndex) {
        loop {
            let spokes = self.spokes(node);
            if spokes.len() < 4 {
                return;
            }
            let mut pairs: Vec<(f64, usize)> = (0..spokes.len())
                .filter_map(|i| Some((gain(&spokes[i], &spokes[(i + 1) % spokes.len()])?, i)))
                .collect();
            pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let done = pairs
                .iter()
                .any(|&(_, i)| self.take(node, spokes[i], spokes[(i + 1) % spokes.len()], margin));
            if !done {
                return;
            }
        }
    }

    /// Hangs two neighbouring veins on a node of their own; whether there was room.
    fn take(&mut self, node: NodeId, a: Spoke, b: Spoke, margin: &SegmentIndex) -> bool {
        let here = self.positions[node as usize];
        let (mut length, direction) = course(&a, &b);
        length *= APART;
        for _ in 0..3 {
            let place = here + direction * length;
            let free = [here, self.positions[a.to as usize], self.positions[b.to as usize]]
                .into_iter()
                .all(|end| !margin.touches(place, end) && self.is_free(place, end, node, &a, &b));
            if free && place != here {
                self.hang(node, place, a, b);
                return true;
            }
            length *= 0.5;
        }
        false
    }

    /// Whether a line from the new `place` crosses none of the edges that were there, but those of the
    /// pair.
    fn is_free(&self, place: DVec2, end: DVec2, node: NodeId, a: &Spoke, b: &Spoke) -> bool {
        let own = [node, a.to, b.to];
        let touches = |edge: usize| {
            let (c, d) = self.edge_ends[edge];
            if own.contains(&c) || own.contains(&d) {
                return false;
            }
            let [c, d] = [c, d].map(|node| self.positions[node as usize]);
            segments_near(place, end, c, d, planar::CLEARANCE_MM)
        };
        let gap = planar::CLEARANCE_MM;
        !self.edges.any_near(place.min(end) - gap, place.max(end) + gap, touches)
    }

    fn hang(&mut self, node: NodeId, place: DVec2, a: Spoke, b: Spoke) {
        let added = self.positions.len() as NodeId;
        let i = node as usize;
        self.positions.push(place);
        self.hosts.push(self.hosts[i]);
        self.children.push(Vec::new());
        self.joins_at.push(Vec::new());
        let is_above = a.end == End::Parent || b.end == End::Parent;
        if is_above {
            // Between the node and its parent.
            let parent = self.parents[i].expect("a spoke to it");
            self.parents.push(Some(parent));
            self.ranks.push(self.ranks[i]);
            self.radii.push(self.radii[i]);
            self.parents[i] = Some(added);
            self.children[added as usize].push(node);
            self.children[parent as usize]
                .iter_mut()
                .filter(|c| **c == node)
                .for_each(|c| *c = added);
        } else {
            self.parents.push(Some(node));
            let rank = |spoke: &Spoke| match spoke.end {
                End::Child => self.ranks[spoke.to as usize],
                _ => None,
            };
            let ranks = [rank(&a), rank(&b)];
            self.ranks.push(ranks.into_iter().flatten().min_by_key(|rank| rank.order));
            self.radii.push(a.width.max(b.width));
            self.children[i].push(added);
        }
        for spoke in [a, b] {
            match spoke.end {
                End::Parent => {}
                End::Child => {
                    self.children[i].retain(|&child| child != spoke.to);
                    self.parents[spoke.to as usize] = Some(added);
                    self.children[added as usize].push(spoke.to);
                }
                End::Join(join) => {
                    self.joins_at[i].retain(|&other| other != join);
                    let (c, d) = self.joins[join as usize];
                    self.joins[join as usize] = if c == node { (added, d) } else { (c, added) };
                    self.joins_at[added as usize].push(join);
                }
            }
        }
    }

    /// The graph, every added node beside its star in birth.
    fn graph(&self, before: &VeinGraph) -> (VeinGraph, Numbers) {
        let n = before.len();
        let mut beside: Vec<Vec<NodeId>> = vec![Vec::new(); n];
        for added in n..self.positions.len() {
            beside[self.hosts[added] as usize].push(added as NodeId);
        }
        let mut made = VeinGraph::new();
        let mut numbers = Numbers {
            new: vec![NodeId::MAX; self.positions.len()],
            old: Vec::new(),
            counts: Vec::with_capacity(n),
        };
        let mut emit = |node: NodeId, numbers: &mut Numbers| {
            let place = self.positions[node as usize];
            let id = match self.parents[node as usize] {
                None => made.add_root(place),
                Some(parent) => made.sprout(numbers.new[parent as usize], place),
            };
            if let Some(rank) = self.ranks[node as usize] {
                made.set_rank(id, rank);
            }
            numbers.new[node as usize] = id;
            numbers.old.push(node);
        };
        for node in 0..n as NodeId {
            // Those of a star hang on each other: emit whatever has a parent, until all are out.
            let mut waiting = vec![node];
            waiting.extend(&beside[node as usize]);
            while !waiting.is_empty() {
                waiting.retain(|&here| {
                    let ready = self.parents[here as usize]
                        .is_none_or(|parent| numbers.new[parent as usize] != NodeId::MAX);
                    if ready {
                        emit(here, &mut numbers);
                    }
                    !ready
                });
            }
            numbers.counts.push(numbers.old.len() as u32);
        }
        for &(a, b) in &self.joins {
            made.join(numbers.new[a as usize], numbers.new[b as usize]);
        }
        (made, numbers)
    }
}

/// What two neighbouring veins gain by leaving together: their pull less that of the piece they share,
/// as wide as Murray's law makes it. `None` where they are too close or too far apart.
fn gain(a: &Spoke, b: &Spoke) -> Option<f64> {
    let turn = a.direction.perp_dot(b.direction);
    if turn < LEAST_ANGLE {
        return None;
    }
    let pull = (a.direction * a.width + b.direction * b.width).length();
    let shared = libm::cbrt(a.width.powi(3) + b.width.powi(3));
    Some(pull - shared)
}

/// Where the piece that a pair shares may go: how far and which way.
fn course(a: &Spoke, b: &Spoke) -> (f64, DVec2) {
    let stays = if a.order != b.order {
        Some(if a.order < b.order { a } else { b })
    } else if a.width.max(b.width) >= MUCH_WIDER * a.width.min(b.width) {
        Some(if a.width > b.width { a } else { b })
    } else {
        None
    };
    let together = || (a.direction * a.width + b.direction * b.width).normalize_or_zero();
    (a.length.min(b.length), stays.map_or_else(together, |spoke| spoke.direction))
}
