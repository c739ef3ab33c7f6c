//! The faces between the veins, as far as junctions need them: what presses on a junction from each
//! side.
//!
//! In a foam the gas in a bubble keeps its walls from closing in: tension alone would shrink every
//! bubble of fewer than six sides and swell the others (J. von Neumann, discussion in *Metal
//! Interfaces*, 1952). Areoles are full of tissue. A face smaller than its neighbours therefore presses
//! on its junctions, a larger one gives way.

use glam::DVec2;

use super::net::Net;
use crate::veins::graph::NodeId;

/// A chain seen from one of its ends: twice its number, plus 1 from its last node.
type HalfChain = u32;

/// No face: a node that is no junction, or a side that looks out of the net.
const NONE: u32 = u32::MAX;

/// A face presses no more than one that is e times too small.
const MOST_PRESSURE: f64 = 1.0;

/// The faces of a plane net of chains.
#[derive(Debug)]
pub(super) struct Faces {
    /// The half-chains that leave each junction or end, anticlockwise, one node after the other.
    leaving: Vec<HalfChain>,
    /// Where those of each node start in `leaving`.
    firsts: Vec<u32>,
    /// The face on the left of each half-chain.
    left: Vec<u32>,
    /// Area of each face; negative for what lies around a net.
    areas: Vec<f64>,
    /// ln of the mean area of its neighbours over its own.
    pressures: Vec<f64>,
}

impl Faces {
    /// The faces of a net where its nodes stand now.
    pub(super) fn of(net: &Net) -> Self {
        let (leaving, firsts) = around(net);
        let left = vec![NONE; 2 * net.chain_count()];
        let mut faces = Self { leaving, firsts, left, areas: Vec::new(), pressures: Vec::new() };
        for start in 0..faces.left.len() as HalfChain {
            if faces.left[start as usize] != NONE {
                continue;
            }
            let face = faces.areas.len() as u32;
            faces.areas.push(0.0);
            let mut half = start;
            while faces.left[half as usize] == NONE {
                faces.left[half as usize] = face;
                half = faces.next(net, half);
            }
        }
        faces
    }

    /// The half-chains that leave a node, anticlockwise.
    fn leaving(&self, node: NodeId) -> &[HalfChain] {
        let at = node as usize;
        &self.leaving[self.firsts[at] as usize..self.firsts[at + 1] as usize]
    }

    /// The half-chain that follows along the face on the left.
    fn next(&self, net: &Net, half: HalfChain) -> HalfChain {
        let back = half ^ 1;
        let leaving = self.leaving(start(net, back));
        let place = leaving.iter().position(|&other| other == back).expect("its own start");
        leaving[(place + leaving.len() - 1) % leaving.len()]
    }

    /// Measures the faces anew.
    pub(super) fn measure(&mut self, net: &Net) {
        self.areas.iter_mut().for_each(|area| *area = 0.0);
        for number in 0..net.chain_count() {
            let nodes = net.chain(number as u32).windows(2);
            let swept: f64 =
                nodes.map(|pair| net.place(pair[0]).perp_dot(net.place(pair[1])) / 2.0).sum();
            self.areas[self.left[2 * number] as usize] += swept;
            self.areas[self.left[2 * number + 1] as usize] -= swept;
        }
        let sides = |number: usize| [self.left[2 * number], self.left[2 * number + 1]];
        let mut around = vec![(0.0, 0u32); self.areas.len()];
        for number in 0..net.chain_count() {
            let [a, b] = sides(number);
            if a == b || self.areas[a as usize] <= 0.0 || self.areas[b as usize] <= 0.0 {
                continue;
            }
            for (face, other) in [(a, b), (b, a)] {
                let (sum, count) = &mut around[face as usize];
                *sum += self.areas[other as usize];
                *count += 1;
            }
        }
        self.pressures.clear();
        self.pressures.extend(self.areas.iter().zip(around).map(|(&area, (sum, count))| {
            if count == 0 || area <= 0.0 {
                return 0.0;
            }
            libm::log(sum / f64::from(count) / area).clamp(-MOST_PRESSURE, MOST_PRESSURE)
        }));
    }

    /// Σ p ∂A/∂x over the faces at a junction, each p in units of 1 over the side of the face.
    pub(super) fn push(&self, net: &Net, junction: NodeId) -> DVec2 {
        let leaving = self.leaving(junction);
        let end = |half: HalfChain| net.place(start(net, half ^ 1));
        let mut sum = DVec2::ZERO;
        for (i, &half) in leaving.iter().enumerate() {
            let face = self.left[half as usize] as usize;
            if self.areas[face] > 0.0 {
                // The boundary comes in along the next chain and goes out along this one.
                let before = leaving[(i + 1) % leaving.len()];
                let gradient = -(end(half) - end(before)).perp() / 2.0;
                sum += gradient * (self.pressures[face] / self.areas[face].sqrt());
            }
        }
        sum
    }
}

/// The node from which a half-chain leaves.
fn start(net: &Net, half: HalfChain) -> NodeId {
    let nodes = net.chain(half >> 1);
    if half & 1 == 0 { nodes[0] } else { nodes[nodes.len() - 1] }
}

/// The half-chains at each node, anticlockwise by their first piece, and where those of each node start.
fn around(net: &Net) -> (Vec<HalfChain>, Vec<u32>) {
    let angle = |half: HalfChain| {
        let nodes = net.chain(half >> 1);
        let last = nodes.len() - 1;
        let [from, to] = if half & 1 == 0 { [0, 1] } else { [last, last - 1] };
        let way = net.place(nodes[to]) - net.place(nodes[from]);
        libm::atan2(way.y, way.x)
    };
    let mut all: Vec<(NodeId, f64, HalfChain)> = (0..2 * net.chain_count() as HalfChain)
        .map(|half| (start(net, half), angle(half), half))
        .collect();
    all.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
    let mut firsts = vec![0; net.positions.len() + 1];
    all.iter().for_each(|&(node, ..)| firsts[node as usize + 1] += 1);
    for node in 1..firsts.len() {
        firsts[node] += firsts[node - 1];
    }
    (all.into_iter().map(|(.., half)| half).collect(), firsts)
}
