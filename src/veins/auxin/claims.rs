//! What each source of open venation knows of its nearest node.

use super::NONE;
use super::field::DEAD;
use crate::veins::graph::NodeId;

/// What stands between a source and its nearest node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sight {
    /// Not looked at yet, or hidden by tissue that is still to come.
    Unknown,
    Clear,
    /// The mature margin or a cut.
    Hidden,
}

/// The nearest node of a source.
#[derive(Debug, Clone, Copy)]
pub(super) struct Claim {
    /// Its squared distance; infinite while none is in reach.
    pub(super) near2: f64,
    /// Where the blade deforms, no node but the nearest is nearer than this (squared).
    pub(super) others2: f64,
    pub(super) node: NodeId,
    pub(super) sight: Sight,
}

impl Claim {
    /// Of no node, where all others lie beyond a squared distance.
    pub(super) fn none(others2: f64) -> Self {
        Self { near2: f64::INFINITY, others2, node: NONE, sight: Sight::Unknown }
    }

    /// From this far on (squared) a new node changes nothing.
    pub(super) fn bound2(&self, deforms: bool) -> f64 {
        // As long as there is no node, every one in reach is welcome.
        if deforms && self.node != NONE { self.others2 } else { self.near2 }
    }

    /// Takes note of a new nearest node.
    pub(super) fn set(&mut self, near2: f64, node: NodeId, others2: f64) {
        if node != self.node {
            self.sight = Sight::Unknown;
        }
        (self.near2, self.node, self.others2) = (near2, node, others2);
    }

    /// Hears of a new node, which gets the source if it is the nearest and kills it within `kill2`;
    /// from how far on nodes do not matter now.
    pub(super) fn hear(&mut self, node: NodeId, distance2: f64, kill2: f64, deforms: bool) -> f64 {
        if distance2 >= self.near2 {
            self.others2 = self.others2.min(distance2);
        } else if distance2 <= kill2 {
            return DEAD;
        } else {
            self.set(distance2, node, self.others2.min(self.near2));
        }
        self.bound2(deforms)
    }
}
