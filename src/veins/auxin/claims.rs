//! What each source knows of its nearest node.

use crate::veins::graph::NodeId;

/// No node, no source.
pub(super) const NONE: u32 = u32::MAX;

/// In place of the squared distance of a dead source: nothing is nearer.
const DEAD: f64 = -1.0;

/// What stands between a source and its nearest node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sight {
    /// Not looked at yet, or hidden by tissue that is still to come.
    Unknown,
    Clear,
    /// The mature margin or a cut.
    Hidden,
}

/// The nearest node of every source.
#[derive(Debug)]
pub(super) struct Claims {
    /// Squared distance of the nearest node; infinite while none is in reach, [`DEAD`] at the end.
    near2: Vec<f64>,
    nearest: Vec<NodeId>,
    /// No node but the nearest is nearer than this (squared); kept where the blade deforms, else
    /// empty.
    others2: Vec<f64>,
    sight: Vec<Sight>,
    /// Whether the source is in the list of those in reach, or about to be.
    is_acting: Vec<bool>,
    /// Sources that came into reach since they were last taken.
    arrived: Vec<u32>,
    /// Sources that died since they were last taken.
    dead: Vec<u32>,
    deforms: bool,
}

impl Claims {
    pub(super) fn new(deforms: bool) -> Self {
        Self {
            near2: Vec::new(),
            nearest: Vec::new(),
            others2: Vec::new(),
            sight: Vec::new(),
            is_acting: Vec::new(),
            arrived: Vec::new(),
            dead: Vec::new(),
            deforms,
        }
    }

    /// Adds a source with its nearest node, if any is in reach, and the bound on all others.
    pub(super) fn add(&mut self, nearest: Option<(f64, NodeId)>, others2: f64) {
        let (near2, node) = nearest.unwrap_or((f64::INFINITY, NONE));
        if nearest.is_some() {
            self.arrived.push(self.near2.len() as u32);
        }
        self.near2.push(near2);
        self.nearest.push(node);
        self.sight.push(Sight::Unknown);
        self.is_acting.push(nearest.is_some());
        if self.deforms {
            self.others2.push(others2);
        }
    }

    pub(super) fn is_alive(&self, i: usize) -> bool {
        self.near2[i] != DEAD
    }

    pub(super) fn is_acting(&self, i: usize) -> bool {
        self.is_acting[i]
    }

    /// Squared distance of the nearest node; of nothing that is alive below zero.
    pub(super) fn near2(&self, i: usize) -> f64 {
        self.near2[i]
    }

    pub(super) fn nearest(&self, i: usize) -> NodeId {
        self.nearest[i]
    }

    pub(super) fn sight(&self, i: usize) -> Sight {
        self.sight[i]
    }

    pub(super) fn set_sight(&mut self, i: usize, sight: Sight) {
        self.sight[i] = sight;
    }

    /// From nearer than this (squared) a new node changes what is known of a source.
    pub(super) fn bound2(&self, i: usize) -> f64 {
        if self.deforms { self.others2[i] } else { self.near2[i] }
    }

    /// Takes note that the blade deformed: the nearest node is now this far away. Whether it may no
    /// longer be the nearest.
    pub(super) fn measured(&mut self, i: usize, near2: f64) -> bool {
        self.near2[i] = near2;
        near2 >= self.others2[i]
    }

    /// Takes note of a new search.
    pub(super) fn searched(&mut self, i: usize, near2: f64, node: NodeId, others2: f64) {
        if node != self.nearest[i] {
            self.sight[i] = Sight::Unknown;
        }
        (self.near2[i], self.nearest[i], self.others2[i]) = (near2, node, others2);
    }

    /// Takes note of what is nearest now, if anything is in reach.
    pub(super) fn found(&mut self, i: usize, nearest: Option<(f64, NodeId)>) {
        let (near2, node) = nearest.unwrap_or((f64::INFINITY, NONE));
        if node != self.nearest[i] {
            self.sight[i] = Sight::Unknown;
        }
        (self.near2[i], self.nearest[i]) = (near2, node);
    }

    /// Puts a source into the list of those in reach, though it may not be.
    pub(super) fn watch(&mut self, source: u32) {
        if !self.is_acting[source as usize] {
            self.is_acting[source as usize] = true;
            self.arrived.push(source);
        }
    }

    /// Takes note that all nodes are now farther than `search2`.
    pub(super) fn out_of_reach(&mut self, i: usize, search2: f64) {
        self.is_acting[i] = false;
        if self.deforms {
            // Measured again when a new node comes.
            (self.near2[i], self.nearest[i]) = (f64::INFINITY, NONE);
            self.others2[i] = search2;
        }
    }

    /// Offers a new node, which gets the source if it is the nearest, and kills it within `kill2`.
    pub(super) fn offer(&mut self, source: u32, node: NodeId, distance2: f64, kill2: f64) {
        let i = source as usize;
        if distance2 >= self.near2[i] {
            if self.deforms {
                self.others2[i] = self.others2[i].min(distance2);
            }
            return;
        }
        if distance2 <= kill2 {
            self.kill(source);
            return;
        }
        if self.deforms {
            self.others2[i] = self.others2[i].min(self.near2[i]);
        }
        (self.near2[i], self.nearest[i]) = (distance2, node);
        self.sight[i] = Sight::Unknown;
        if !self.is_acting[i] {
            self.is_acting[i] = true;
            self.arrived.push(source);
        }
    }

    /// No other than the nearest node is nearer than this (squared) any more.
    pub(super) fn bound_others(&mut self, i: usize, distance2: f64) {
        if self.deforms {
            self.others2[i] = self.others2[i].min(distance2);
        }
    }

    pub(super) fn kill(&mut self, source: u32) {
        if self.is_alive(source as usize) {
            self.near2[source as usize] = DEAD;
            self.dead.push(source);
        }
    }

    pub(super) fn take_dead(&mut self) -> Vec<u32> {
        std::mem::take(&mut self.dead)
    }

    /// Those that came into reach, ascending.
    pub(super) fn take_arrived(&mut self) -> Vec<u32> {
        self.arrived.sort_unstable();
        std::mem::take(&mut self.arrived)
    }
}
