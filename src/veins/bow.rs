//! Fine veins bow between their junctions.
//!
//! In cleared leaves a segment of the net is 1 to 4 hundredths longer than its chord: it bows to one
//! side or sways. Grown veins that were relaxed are nearly straight. Here the nodes between two
//! junctions move aside, by an arch and a wave whose heights are drawn for every segment; junctions, ends
//! and guided veins stay. A segment that would touch another vein or the margin bows less, or not at
//! all.

use glam::DVec2;

use super::VeinSpec;
use super::chains::Chains;
use super::graph::{NodeId, VeinGraph};
use crate::geometry::polygon::segments_touch;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::seed::Rng;

/// The height of the wave, in heights of the arch.
const WAVE: f64 = 0.5;

/// A bow is no longer than this (steps): long veins sway, segment after segment.
const LONGEST: f64 = 8.0;

/// A graph in `margin` with the bows that `veins.sinuosity` asks for; as it is at 0.
#[must_use]
pub fn bowed(spec: &VeinSpec, margin: &Margin, graph: VeinGraph, rng: &mut Rng) -> VeinGraph {
    if spec.sinuosity == 0.0 || graph.is_empty() {
        return graph;
    }
    let chains = Chains::of(&graph);
    let edges: Vec<[NodeId; 2]> =
        graph.edges().chain(graph.joins().iter().copied()).map(|(a, b)| [a, b]).collect();
    let mut positions = graph.positions().to_vec();
    let lines = margin.lines();
    let longest = LONGEST * spec.node_step_mm;
    let home = {
        let at = |node: NodeId| positions[node as usize];
        SegmentIndex::new(edges.iter().map(|&[a, b]| (at(a), at(b))).collect())
    };
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
            nodes.iter().zip(&after).for_each(|(&node, &p)| positions[node as usize] = p);
            if is_sound(nodes, &positions, &edges, &home, &lines, longest) {
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

fn is_sound(
    nodes: &[NodeId],
    positions: &[DVec2],
    edges: &[[NodeId; 2]],
    home: &SegmentIndex,
    lines: &SegmentIndex,
    reach: f64,
) -> bool {
    let at = |node: NodeId| positions[node as usize];
    let reach = DVec2::splat(0.5 * reach);
    nodes.windows(2).all(|pair| {
        let (p, q) = (at(pair[0]), at(pair[1]));
        let touches = |edge: usize| {
            let [c, d] = edges[edge];
            let apart = pair.iter().all(|&node| node != c && node != d);
            apart && segments_touch(p, q, at(c), at(d))
        };
        p != q
            && !lines.touches(p, q)
            && !home.any_near(p.min(q) - reach, p.max(q) + reach, touches)
    })
}
