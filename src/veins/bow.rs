//! Fine veins bow between their junctions.
//!
//! In cleared leaves a segment of the net is 1 to 4 hundredths longer than its chord: it bows to one
//! side or sways. Grown veins that were relaxed are nearly straight. Here the nodes between two
//! junctions move aside, by an arch and a wave whose heights are drawn for every segment; junctions, ends
//! and guided veins stay. A segment that would touch another vein or the margin, or be drawn out to long
//! straight pieces, bows less, or not at all.

use glam::DVec2;

use super::VeinSpec;
use super::chains::Chains;
use super::graph::{NodeId, VeinGraph};
use super::planar::{CLEARANCE_MM, Line};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::segment_grid::SegmentGrid;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::seed::Rng;

/// The height of the wave, in heights of the arch.
const WAVE: f64 = 0.5;

/// A bow is no longer than this (steps): long veins sway, segment after segment.
const LONGEST: f64 = 8.0;

/// A bow draws no edge out beyond this (steps): it would show as a straight piece.
const LONGEST_EDGE: f64 = 1.8;

/// A graph in `margin` with the bows that `veins.sinuosity` asks for; as it is at 0.
#[must_use]
pub fn bowed(spec: &VeinSpec, margin: &Margin, graph: VeinGraph, rng: &mut Rng) -> VeinGraph {
    if spec.sinuosity == 0.0 || graph.is_empty() {
        return graph;
    }
    let chains = Chains::of(&graph);
    let mut positions = graph.positions().to_vec();
    let longest = LONGEST * spec.node_step_mm;
    let mut around = Surroundings::new(&graph, margin, spec.node_step_mm);
    for chain in &chains.chains {
        // Drawn for every chain, so that one that cannot bow changes no other.
        let heights = [bell(rng), WAVE * bell(rng)];
        let nodes = &chain.nodes;
        let inner = &nodes[1..nodes.len() - 1];
        let is_free = |&node: &NodeId| graph.rank(node).is_none();
        if inner.is_empty() || nodes[0] == nodes[nodes.len() - 1] || !inner.iter().all(is_free) {
            continue;
        }
        let before: Vec<DVec2> = nodes.iter().map(|&node| positions[node as usize]).collect();
        for share in [1.0, 0.5, 0.25] {
            let after = aside(&before, heights.map(|h| h * share * spec.sinuosity), longest);
            let is_drawn_out = before.windows(2).zip(after.windows(2)).any(|(was, is)| {
                let long = is[0].distance(is[1]);
                long > LONGEST_EDGE * spec.node_step_mm && long > was[0].distance(was[1])
            });
            if is_drawn_out {
                continue;
            }
            nodes.iter().zip(&after).for_each(|(&node, &p)| positions[node as usize] = p);
            if around.are_clear(nodes, &positions) {
                around.moved(nodes, &positions);
                break;
            }
            nodes.iter().zip(&before).for_each(|(&node, &p)| positions[node as usize] = p);
        }
    }
    let mut places = positions.into_iter();
    graph.mapped(|old| places.next().unwrap_or(old))
}

/// A number about 0 with deviation 1, from −3 to 3: a half circle is no vein.
fn bell(rng: &mut Rng) -> f64 {
    2.0 * (rng.unit() + rng.unit() + rng.unit() - 1.5)
}

/// A line whose inner points have moved aside: an arch and a wave over it, or several.
fn aside(line: &[DVec2], heights: [f64; 2], longest: f64) -> Vec<DVec2> {
    let total: f64 = line.windows(2).map(|w| w[0].distance(w[1])).sum();
    let last = line.len() - 1;
    let height = total.min(longest);
    let mut along = 0.0;
    (0..=last)
        .map(|i| {
            if i == 0 || i == last {
                return line[i];
            }
            along += line[i - 1].distance(line[i]);
            let t = along / total;
            let across = (line[i + 1] - line[i - 1]).normalize_or_zero().perp();
            let turns = (total / longest).ceil().max(1.0);
            let arch = libm::sin(std::f64::consts::PI * t * turns);
            let wave = libm::sin(2.0 * std::f64::consts::PI * t * turns);
            line[i] + across * (height * (heights[0] * arch + heights[1] * wave))
        })
        .collect()
}

/// Edges that are looked at at once: of a long vein the box around all would hold half a leaf.
const AT_ONCE: usize = 8;

/// What a vein must not touch.
struct Surroundings {
    edges: Vec<[NodeId; 2]>,
    /// Where they were.
    home: BoxCells,
    /// Those of veins that have bowed, and where they are.
    bowed: Vec<[NodeId; 2]>,
    there: SegmentGrid,
    lines: SegmentIndex,
    found: Vec<Line>,
}

impl Surroundings {
    fn new(graph: &VeinGraph, margin: &Margin, cell: f64) -> Self {
        let edges: Vec<[NodeId; 2]> =
            graph.edges().chain(graph.joins().iter().copied()).map(|(a, b)| [a, b]).collect();
        let at = |node: NodeId| graph.positions()[node as usize];
        let bounds = Rect::around(graph.positions().iter().copied());
        let boxes = edges.iter().map(|ends| Rect::around(ends.map(at)));
        Self {
            home: BoxCells::new(bounds, 2.0 * cell, boxes),
            bowed: Vec::new(),
            there: SegmentGrid::new(bounds, 2.0 * cell),
            lines: margin.lines(),
            edges,
            found: Vec::new(),
        }
    }

    /// Takes note of where a vein has come to lie.
    fn moved(&mut self, nodes: &[NodeId], positions: &[DVec2]) {
        for pair in nodes.windows(2) {
            self.bowed.push([pair[0], pair[1]]);
            self.there.push(positions[pair[0] as usize], positions[pair[1] as usize]);
        }
    }

    /// Whether nothing is in the way of a vein, itself and the margin included, where its nodes are now.
    fn are_clear(&mut self, nodes: &[NodeId], positions: &[DVec2]) -> bool {
        let at = |node: NodeId| positions[node as usize];
        let line = |ends: [NodeId; 2]| Line::new(ends, positions);
        let Self { edges, home, bowed, there, lines, found } = self;
        (0..nodes.len() - 1).step_by(AT_ONCE).all(|first| {
            let part = &nodes[first..nodes.len().min(first + AT_ONCE + 1)];
            let around = Rect::around(part.iter().map(|&node| at(node))).grown(CLEARANCE_MM);
            found.clear();
            home.for_each_meeting(around, |edge| found.push(line(edges[edge as usize])));
            there.for_each_near(around.min, around.max, |edge| {
                found.push(line(bowed[edge as usize]));
            });
            found.extend(nodes.windows(2).map(|pair| line([pair[0], pair[1]])));
            part.windows(2).all(|pair| {
                let (p, q) = (at(pair[0]), at(pair[1]));
                let own = line([pair[0], pair[1]]);
                p != q
                    && !lines.touches(p, q)
                    && !found.iter().any(|other| own.is_in_the_way(other))
            })
        })
    }
}
