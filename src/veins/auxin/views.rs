//! Calling without a reach, on a blade that keeps its proportions.

use glam::DVec2;

use super::NONE;
use crate::veins::graph::NodeId;

/// In place of the node that a source calls: it has died.
pub(super) const GONE: NodeId = NONE - 1;

/// By the ids of sources, whom each calls, where that stays so until a new node comes.
///
/// Sources call in the order of their ids and stand in the order of their cells: from here calling is a
/// walk, not a search for each, and what hearing of a node writes here is small enough to stay near.
#[derive(Debug, Default)]
pub(super) struct Views {
    pub(super) places: Vec<DVec2>,
    /// [`NONE`] when it calls nobody, [`GONE`] when it has died.
    pub(super) nodes: Vec<NodeId>,
    /// The node that was last seen.
    pub(super) seen: Vec<NodeId>,
}

impl Views {
    pub(super) fn add(&mut self, place: DVec2, node: NodeId) {
        self.places.push(place);
        self.nodes.push(node);
        self.seen.push(NONE);
    }
}

/// Whom a source calls whose nearest node is that far away: nobody, when it is touched.
pub(super) fn callee(node: NodeId, distance2: f64) -> NodeId {
    if distance2 > 0.0 { node } else { NONE }
}
