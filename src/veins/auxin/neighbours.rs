//! The relative neighbours of a source among the nodes.
//!
//! A node is one unless another stands in its way: one that is nearer to the source than it is, and
//! nearer to it than the source is. Of two nodes within 60 degrees of each other, seen from the
//! source, the nearer stands in the way of the farther, so at most the nearest node of each sixth of
//! the circle is a relative neighbour. Those six are kept, each with a mark whether it is one. A new
//! node changes them in constant time, and the nodes themselves need to be searched only when one of
//! the other sixths holds a nearer node that is not itself in the way.
//!
//! In a sixth without a node, nodes beside it stand in the way of all that is far, or the blade ends: from
//! where on is kept in place of the distance of a node, so that neither a search nor a source waits for
//! what cannot matter.
//!
//! Source: G. Toussaint, "The relative neighbourhood graph of a finite planar set", Pattern
//! Recognition 12, 1980; the six cones are A. Yao's (SIAM J. Comput. 11, 1982). Between nodes at one
//! distance the one with the lower id counts as nearer.

use glam::DVec2;

use super::NONE;
use super::horizon::{Horizon, WEDGES};
use super::nodes::Nodes;
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// Sixths of the circle.
pub(super) const SECTORS: usize = 6;

/// Of each sixth, the others in which nodes may stand in each other's way: those within 90 degrees, so never
/// the opposite one.
const BESIDE: [u8; SECTORS] = [0b11_0110, 0b10_1101, 0b01_1011, 0b11_0110, 0b10_1101, 0b01_1011];

/// The nearest node in each sixth of the circle around a source.
#[derive(Debug, Clone, Copy)]
pub(super) struct Around {
    /// Squared distances; where there is no node, from where on none can be a relative neighbour.
    near2: [f64; SECTORS],
    nodes: [NodeId; SECTORS],
    /// Which of them are relative neighbours, a bit for each.
    neighbours: u8,
    /// Which of them are known to see the source.
    clear: u8,
    /// Which of them never will.
    hidden: u8,
}

impl Around {
    /// Of no nodes.
    pub(super) const EMPTY: Self = Self {
        near2: [f64::INFINITY; SECTORS],
        nodes: [NONE; SECTORS],
        neighbours: 0,
        clear: 0,
        hidden: 0,
    };

    /// The relative neighbours, each with its sixth and its squared distance.
    pub(super) fn neighbours(&self) -> impl Iterator<Item = (usize, NodeId, f64)> + '_ {
        (0..SECTORS).filter(|&k| self.is_neighbour(k)).map(|k| (k, self.nodes[k], self.near2[k]))
    }

    fn is_neighbour(&self, k: usize) -> bool {
        self.neighbours & (1 << k) > 0
    }

    /// The nearest node of all; it is a relative neighbour.
    pub(super) fn nearest(&self) -> Option<(f64, NodeId)> {
        (0..SECTORS)
            .map(|k| (self.near2[k], self.nodes[k]))
            .filter(|&(_, node)| node != NONE)
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
    }

    /// The squared distance of the nearest node; infinite without one.
    pub(super) fn least2(&self) -> f64 {
        let there = self.near2.iter().zip(&self.nodes).filter(|&(_, &node)| node != NONE);
        there.fold(f64::INFINITY, |least2, (&near2, _)| least2.min(near2))
    }

    /// No node as far as this (squared) changes anything.
    pub(super) fn most2(&self) -> f64 {
        self.near2.iter().copied().fold(0.0, f64::max)
    }

    /// Whether nothing farther than a distance can be a relative neighbour.
    pub(super) fn is_settled(&self, distance: f64) -> bool {
        self.near2.iter().all(|&near2| near2 <= distance * distance)
    }

    /// Finds out, for the sixths that have no node, from where on those beside them stand in the way, or
    /// the blade ends: `ends` tells that for each wedge.
    pub(super) fn shade(
        &mut self,
        s: DVec2,
        horizon: &Horizon,
        ends: &[f64; WEDGES],
        nodes: &Nodes,
        metric: Metric,
    ) {
        const WEDGES_A_SECTOR: usize = WEDGES / SECTORS;
        for k in 0..SECTORS {
            if self.nodes[k] != NONE {
                continue;
            }
            let beside = |turns: [usize; 2]| {
                let ids = turns.map(|turn| self.nodes[(k + turn) % SECTORS]);
                ids.map(|id| (id != NONE).then(|| metric.between(s, nodes.position(id))))
            };
            let (clockwise, anticlockwise) = (beside([5, 4]), beside([1, 2]));
            // What is in the way along the far ray of a wedge is in the way in all of it.
            let least2 = |there: [Option<DVec2>; 2], ray: DVec2| {
                let all = there.into_iter().flatten().map(|way| shaded_from2(way, ray));
                all.fold(f64::INFINITY, f64::min)
            };
            let from2 = |wedge: usize| {
                (ends[wedge] * ends[wedge])
                    .min(least2(clockwise, horizon.ray(wedge + 1)))
                    .min(least2(anticlockwise, horizon.ray(wedge)))
            };
            let wedges = k * WEDGES_A_SECTOR..(k + 1) * WEDGES_A_SECTOR;
            let farthest2 = wedges.map(from2).fold(0.0, f64::max);
            self.near2[k] = self.near2[k].min(farthest2);
        }
    }

    /// Takes note of a node at `p`, as far from the source at `s` as `distance2` (squared).
    ///
    /// `nodes` may already hold others that are still to be offered: the order does not matter.
    pub(super) fn offer(
        &mut self,
        s: DVec2,
        node: NodeId,
        p: DVec2,
        distance2: f64,
        nodes: &Nodes,
        metric: Metric,
    ) {
        let here = sector(metric.between(s, p));
        // A bit for each sixth whose node is nearer, or in which one may stand that was left out; found
        // without a jump, which could not be foretold.
        let (mut nearer, mut present) = (0_u8, 0_u8);
        for k in 0..SECTORS {
            let (other2, other) = (self.near2[k], self.nodes[k]);
            let is_nearer = (other2 < distance2) | ((other2 == distance2) & (other < node));
            nearer |= u8::from(is_nearer) << k;
            present |= u8::from(other != NONE) << k;
        }
        let between2 = |k: usize| metric.distance_squared(p, nodes.position(self.nodes[k]));
        // What stands in the way of others, and what is in its way.
        let beside = BESIDE[here];
        let mut shielded = 0;
        for k in sectors(!nearer & beside & present & self.neighbours) {
            shielded |= u8::from(between2(k) < self.near2[k]) << k;
        }
        let bit = 1 << here;
        if nearer & bit > 0 || self.nodes[here] == node {
            self.neighbours &= !shielded;
            return;
        }
        let is_shielded = sectors(nearer & beside & present).any(|k| between2(k) < distance2);
        let in_doubt = nearer & beside > 0;
        self.neighbours &= !shielded;
        (self.near2[here], self.nodes[here]) = (distance2, node);
        self.clear &= !bit;
        self.hidden &= !bit;
        if is_shielded || (in_doubt && nodes.stands_between(s, node, distance2, metric)) {
            self.neighbours &= !bit;
        } else {
            self.neighbours |= bit;
        }
    }

    /// What is known of the sight between the source and the node of a sixth.
    pub(super) fn sight(&self, k: usize) -> Option<bool> {
        let bit = 1 << k;
        if self.clear & bit > 0 {
            Some(true)
        } else if self.hidden & bit > 0 {
            Some(false)
        } else {
            None
        }
    }

    pub(super) fn set_sight(&mut self, k: usize, clear: bool) {
        let marks = if clear { &mut self.clear } else { &mut self.hidden };
        *marks |= 1 << k;
    }
}

/// From which squared distance on a node, seen at `r` from the source, stands in the way of all nodes
/// along a ray.
fn shaded_from2(r: DVec2, ray: DVec2) -> f64 {
    // Beyond 89 degrees it would be too far to be of use, and rounding would tell.
    const LEAST_COSINE: f64 = 0.0175;
    // Far above rounding.
    const SLACK: f64 = 1.0 + 1e-4;
    let (distance2, along) = (r.length_squared(), r.dot(ray));
    if along <= 0.0 || along * along < LEAST_COSINE * LEAST_COSINE * distance2 {
        return f64::INFINITY;
    }
    // Nearer to the node than to the source, and farther from the source than the node.
    let bisector = distance2 / (2.0 * along);
    (bisector * bisector).max(distance2) * SLACK
}

/// The sixths of a set.
fn sectors(set: u8) -> impl Iterator<Item = usize> {
    let lowest = |left: u8| (left > 0).then_some(left);
    std::iter::successors(lowest(set), move |&left| lowest(left & (left - 1)))
        .map(|left| left.trailing_zeros() as usize)
}

/// The sixth of the circle that a vector points into.
fn sector(v: DVec2) -> usize {
    const TAN_60: f64 = 1.732_050_807_568_877_2;
    // By whether it points up, steeply, and to the right: a jump could not be foretold.
    const SIXTHS: [u8; 8] = [3, 5, 4, 4, 2, 0, 1, 1];
    let is_steep = v.y.abs() > TAN_60 * v.x.abs();
    let at = usize::from(v.y >= 0.0) << 2 | usize::from(is_steep) << 1 | usize::from(v.x > 0.0);
    usize::from(SIXTHS[at])
}
