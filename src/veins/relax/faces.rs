//! The faces between the veins, as far as junctions need them: what presses on a junction from each
//! side.
//!
//! In a foam the gas in a bubble keeps its walls from closing in: tension alone would shrink every
//! bubble of fewer than six sides and swell the others (J. von Neumann, discussion in *Metal
//! Interfaces*, 1952). Areoles are full of tissue. A face smaller than its neighbours therefore presses
//! on its junctions, a larger one gives way.

use glam::DVec2;

use crate::veins::chains::Chains;
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
    /// The half-chains that leave each junction or end, anticlockwise.
    around: Vec<Vec<HalfChain>>,
    /// The face on the left of each half-chain.
    left: Vec<u32>,
    /// Area of each face; negative for what lies around a net.
    areas: Vec<f64>,
    /// ln of the mean area of its neighbours over its own.
    pressures: Vec<f64>,
}

impl Faces {
    /// The faces of `chains` whose nodes stand at `positions`.
    pub(super) fn of(chains: &Chains, positions: &[DVec2]) -> Self {
        let mut faces = Self {
            around: around(chains, positions),
            left: vec![NONE; 2 * chains.chains.len()],
            areas: Vec::new(),
            pressures: Vec::new(),
        };
        for start in 0..faces.left.len() as HalfChain {
            if faces.left[start as usize] != NONE {
                continue;
            }
            let face = faces.areas.len() as u32;
            faces.areas.push(0.0);
            let mut half = start;
            while faces.left[half as usize] == NONE {
                faces.left[half as usize] = face;
                half = faces.next(chains, half);
            }
        }
        faces
    }

    /// The half-chain that follows along the face on the left.
    fn next(&self, chains: &Chains, half: HalfChain) -> HalfChain {
        let back = half ^ 1;
        let leaving = &self.around[start(chains, back) as usize];
        let place = leaving.iter().position(|&other| other == back).expect("its own start");
        leaving[(place + leaving.len() - 1) % leaving.len()]
    }

    /// Measures the faces anew.
    pub(super) fn measure(&mut self, chains: &Chains, positions: &[DVec2]) {
        self.areas.iter_mut().for_each(|area| *area = 0.0);
        for (number, chain) in chains.chains.iter().enumerate() {
            let swept: f64 = chain
                .nodes
                .windows(2)
                .map(|pair| positions[pair[0] as usize].perp_dot(positions[pair[1] as usize]) / 2.0)
                .sum();
            self.areas[self.left[2 * number] as usize] += swept;
            self.areas[self.left[2 * number + 1] as usize] -= swept;
        }
        let sides = |number: usize| [self.left[2 * number], self.left[2 * number + 1]];
        let mut around = vec![(0.0, 0u32); self.areas.len()];
        for number in 0..chains.chains.len() {
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
    pub(super) fn push(&self, chains: &Chains, junction: NodeId, positions: &[DVec2]) -> DVec2 {
        let leaving = &self.around[junction as usize];
        let end = |half: HalfChain| positions[start(chains, half ^ 1) as usize];
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
fn start(chains: &Chains, half: HalfChain) -> NodeId {
    let nodes = &chains.chains[(half >> 1) as usize].nodes;
    if half & 1 == 0 { nodes[0] } else { nodes[nodes.len() - 1] }
}

/// The half-chains at each node, anticlockwise by their first piece.
fn around(chains: &Chains, positions: &[DVec2]) -> Vec<Vec<HalfChain>> {
    let mut around: Vec<Vec<HalfChain>> = vec![Vec::new(); chains.at.len()];
    for half in 0..2 * chains.chains.len() as HalfChain {
        around[start(chains, half) as usize].push(half);
    }
    let angle = |half: HalfChain| {
        let nodes = &chains.chains[(half >> 1) as usize].nodes;
        let last = nodes.len() - 1;
        let [from, to] = if half & 1 == 0 { [0, 1] } else { [last, last - 1] };
        let way = positions[nodes[to] as usize] - positions[nodes[from] as usize];
        libm::atan2(way.y, way.x)
    };
    for leaving in &mut around {
        leaving.sort_by(|&a, &b| angle(a).total_cmp(&angle(b)).then(a.cmp(&b)));
    }
    around
}
