//! A vein pattern as segments between junctions and ends: what every measure is taken of.
//!
//! Nodes of degree 2 are merged, as Blonder's `venation_programs` and Fricker's LeafVeinCNN do, so a
//! segment is a stretch of vein between two places where veins meet or end. The margin is not a
//! vein.

use glam::DVec2;

use super::hull;
use crate::veins::VeinGraph;

/// A stretch of vein from a junction or end to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    /// The nodes at its two ends; the same one for a loop.
    pub ends: [usize; 2],
    /// Its course, from the first end to the second, both included.
    pub path: Vec<DVec2>,
    /// Length along the path.
    pub length: f64,
    /// Mean width over the length.
    pub width: f64,
    /// Vein order, 1 primary; 0 when unknown.
    pub order: u8,
}

impl Segment {
    /// A segment along a path.
    #[must_use]
    pub fn new(ends: [usize; 2], path: Vec<DVec2>, width: f64, order: u8) -> Self {
        let length = path.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        Self { ends, path, length, width, order }
    }

    /// The distance between the ends.
    #[must_use]
    pub fn chord(&self) -> f64 {
        match (self.path.first(), self.path.last()) {
            (Some(a), Some(b)) => a.distance(*b),
            _ => 0.0,
        }
    }

    /// The direction, of length 1, in which it leaves the end at `side` (0 or 1), towards the point
    /// `reach` along it; reach 0 gives the first piece. Zero for a path without length.
    #[must_use]
    pub fn direction(&self, side: usize, reach: f64) -> DVec2 {
        let last = self.path.len() - 1;
        let at = |i: usize| self.path[if side == 0 { i } else { last - i }];
        let (start, mut left) = (at(0), reach);
        for i in 0..last {
            let step = at(i).distance(at(i + 1));
            if step >= left && step > 0.0 {
                let share = if left > 0.0 { left / step } else { 1.0 };
                return (at(i).lerp(at(i + 1), share) - start).normalize_or_zero();
            }
            left -= step;
        }
        (at(last) - start).normalize_or_zero()
    }
}

/// Veins as segments, in a blade.
///
/// # Guarantees
///
/// - Segments name existing nodes and have at least 2 points, all finite.
/// - A node has a degree other than 2, but for one on a ring without junctions.
/// - The outline has at least 3 points, anticlockwise, unless there is not a single segment.
#[derive(Debug, Clone, PartialEq)]
pub struct Network {
    nodes: Vec<DVec2>,
    segments: Vec<Segment>,
    is_root: Vec<bool>,
    outline: Vec<DVec2>,
}

impl Network {
    /// Merges the nodes of degree 2 and drops those without a segment. Without an outline (fewer
    /// than 3 points) the blade is what [`hull::outline`] finds around the veins.
    #[must_use]
    pub fn new(nodes: &[DVec2], segments: &[Segment], roots: &[usize], outline: &[DVec2]) -> Self {
        let mut is_root = vec![false; nodes.len()];
        for &root in roots {
            is_root[root] = true;
        }
        let (mut nodes, mut segments) = (nodes.to_vec(), merged(nodes.len(), segments));
        compact(&mut nodes, &mut segments, &mut is_root);
        let mut network = Self { nodes, segments, is_root, outline: outline.to_vec() };
        if outline.len() < 3 {
            network.outline = hull::outline(&network);
        } else if crate::geometry::polygon::signed_area(outline) < 0.0 {
            network.outline.reverse();
        }
        network
    }

    /// All veins of a graph: a vein between two nodes is as wide as the younger, a join as its
    /// thinner end.
    #[must_use]
    pub fn of_graph(graph: &VeinGraph, radii: &[f64], orders: &[u8], outline: &[DVec2]) -> Self {
        let positions = graph.positions();
        let segment = |a: u32, b: u32, radius: f64, order: u8| {
            let ends = [a as usize, b as usize];
            Segment::new(ends, ends.map(|i| positions[i]).to_vec(), 2.0 * radius, order)
        };
        let mut segments: Vec<Segment> = graph
            .edges()
            .map(|(parent, node)| {
                segment(parent, node, radii[node as usize], orders[node as usize])
            })
            .collect();
        segments.extend(graph.joins().iter().map(|&(a, b)| {
            let (i, j) = (a as usize, b as usize);
            segment(a, b, radii[i].min(radii[j]), orders[i].max(orders[j]))
        }));
        let roots: Vec<usize> =
            (0..graph.len()).filter(|&node| graph.parent(node as u32).is_none()).collect();
        Self::new(positions, &segments, &roots, outline)
    }

    /// Where veins meet or end.
    #[must_use]
    pub fn nodes(&self) -> &[DVec2] {
        &self.nodes
    }

    /// The stretches of vein.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// Whether veins come in through a node from outside: the petiole is no free ending.
    #[must_use]
    pub fn is_root(&self, node: usize) -> bool {
        self.is_root[node]
    }

    /// The outline of the blade, anticlockwise.
    #[must_use]
    pub fn outline(&self) -> &[DVec2] {
        &self.outline
    }

    /// The area of the blade.
    #[must_use]
    pub fn blade_area(&self) -> f64 {
        crate::geometry::polygon::signed_area(&self.outline)
    }

    /// The length of all veins.
    #[must_use]
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// How many segment ends lie at each node; both ends of a loop count.
    #[must_use]
    pub fn degrees(&self) -> Vec<usize> {
        let mut degrees = vec![0; self.nodes.len()];
        for end in self.segments.iter().flat_map(|segment| segment.ends) {
            degrees[end] += 1;
        }
        degrees
    }

    /// The ends of segments at each node.
    #[must_use]
    pub fn incidence(&self) -> Incidence {
        Incidence::of(self.nodes.len(), &self.segments)
    }
}

/// A segment seen from one of its ends: twice its number, plus 1 from the second end.
pub type HalfEdge = u32;

/// The segment of a half-edge, and the end from which it starts.
#[must_use]
pub const fn split(half_edge: HalfEdge) -> (usize, usize) {
    ((half_edge >> 1) as usize, (half_edge & 1) as usize)
}

/// The half-edges that leave each node.
#[derive(Debug, Clone)]
pub struct Incidence {
    first: Vec<u32>,
    leaving: Vec<HalfEdge>,
}

impl Incidence {
    fn of(nodes: usize, segments: &[Segment]) -> Self {
        let mut first = vec![0u32; nodes + 1];
        for end in segments.iter().flat_map(|segment| segment.ends) {
            first[end + 1] += 1;
        }
        for node in 0..nodes {
            first[node + 1] += first[node];
        }
        let mut place = first.clone();
        let mut leaving = vec![0; 2 * segments.len()];
        for (half_edge, end) in segments.iter().flat_map(|segment| segment.ends).enumerate() {
            leaving[place[end] as usize] = half_edge as HalfEdge;
            place[end] += 1;
        }
        Self { first, leaving }
    }

    /// The half-edges that leave a node.
    #[must_use]
    pub fn at(&self, node: usize) -> &[HalfEdge] {
        &self.leaving[self.first[node] as usize..self.first[node + 1] as usize]
    }

    /// The same, to put them in another order.
    pub fn at_mut(&mut self, node: usize) -> &mut [HalfEdge] {
        &mut self.leaving[self.first[node] as usize..self.first[node + 1] as usize]
    }
}

/// The segments chained through nodes of degree 2.
pub(super) fn merged(nodes: usize, segments: &[Segment]) -> Vec<Segment> {
    let incidence = Incidence::of(nodes, segments);
    let passes = |node: usize| incidence.at(node).len() == 2;
    let mut taken = vec![false; segments.len()];
    let mut chains = Vec::new();
    let mut chain = |start: HalfEdge, ring: bool| {
        if taken[split(start).0] {
            return;
        }
        let (mut half_edge, mut pieces) = (start, Vec::new());
        loop {
            let (segment, side) = split(half_edge);
            taken[segment] = true;
            pieces.push(half_edge);
            let end = segments[segment].ends[1 - side];
            if !passes(end) {
                break;
            }
            let [a, b] = [incidence.at(end)[0], incidence.at(end)[1]];
            half_edge = if a == half_edge ^ 1 { b } else { a };
            // A ring without a junction comes back to where it began.
            if ring && taken[split(half_edge).0] {
                break;
            }
        }
        chains.push(joined(segments, &pieces));
    };
    // From junctions and ends first; what is left then are rings.
    for node in (0..nodes).filter(|&node| !passes(node)) {
        incidence.at(node).iter().for_each(|&start| chain(start, false));
    }
    for node in 0..nodes {
        incidence.at(node).iter().for_each(|&start| chain(start, true));
    }
    chains
}

/// One segment of several, end to end.
fn joined(segments: &[Segment], pieces: &[HalfEdge]) -> Segment {
    let start = |&piece: &HalfEdge| segments[split(piece).0].ends[split(piece).1];
    let end = |&piece: &HalfEdge| segments[split(piece).0].ends[1 - split(piece).1];
    let ends = [start(&pieces[0]), end(&pieces[pieces.len() - 1])];
    let mut path: Vec<DVec2> = Vec::new();
    let (mut length, mut area, mut plain) = (0.0, 0.0, 0.0);
    // The order of most of the length.
    let mut by_order = [0.0; 256];
    for &piece in pieces {
        let (segment, side) = (&segments[split(piece).0], split(piece).1);
        let skip = usize::from(!path.is_empty());
        if side == 0 {
            path.extend(segment.path.iter().skip(skip));
        } else {
            path.extend(segment.path.iter().rev().skip(skip));
        }
        length += segment.length;
        area += segment.length * segment.width;
        plain += segment.width;
        by_order[usize::from(segment.order)] += segment.length;
    }
    let width = if length > 0.0 { area / length } else { plain / pieces.len() as f64 };
    let order = (0..=255u8)
        .rev()
        .max_by(|&a, &b| by_order[usize::from(a)].total_cmp(&by_order[usize::from(b)]));
    Segment { ends, path, length, width, order: order.unwrap_or(0) }
}

/// Drops nodes without a segment.
fn compact(nodes: &mut Vec<DVec2>, segments: &mut [Segment], is_root: &mut Vec<bool>) {
    let mut used = vec![false; nodes.len()];
    segments.iter().flat_map(|segment| segment.ends).for_each(|end| used[end] = true);
    let mut place = Vec::with_capacity(nodes.len());
    let mut count = 0;
    for &used in &used {
        place.push(count);
        count += usize::from(used);
    }
    for segment in segments {
        segment.ends = segment.ends.map(|end| place[end]);
    }
    let mut kept = used.iter();
    nodes.retain(|_| *kept.next().unwrap_or(&false));
    let mut kept = used.iter();
    is_root.retain(|_| *kept.next().unwrap_or(&false));
}
