//! Open venation: each source calls the one node it is nearest to, and veins never meet.
//!
//! A source remembers its nearest node. Distances between tissue never shrink in the model's measure,
//! so only a new node can take a source over: the work follows what changed, not what is there.
//! With a reach, each new node asks a static index of the sources which ones it wins; without,
//! every source looks at the new nodes of the step. Where the blade changes its proportions an old
//! node can become the nearest too: then each source also keeps a lower bound on the distance of all
//! others and searches again when its nearest node grows past it.

use glam::DVec2;

use super::extend::Nodes;
use crate::geometry::point_index::PointIndex;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// No node, no source.
const NONE: u32 = u32::MAX;

/// Up to this many new nodes are looked at one by one; an index over them pays beyond.
const FEW_TIPS: usize = 12;

/// Newborn sources stand in a plain list until there are this many, or a quarter of the index.
const NEWBORN: usize = 64;

/// What a source knows of its nearest node.
#[derive(Debug, Clone, Copy)]
struct Near {
    /// Squared distance; infinite while none is in reach, below zero once the source is dead.
    distance2: f64,
    node: NodeId,
}

const DEAD: Near = Near { distance2: -1.0, node: NONE };

/// What stands between a source and its nearest node.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sight {
    Unknown,
    Clear,
    /// The mature margin or a cut.
    Hidden,
}

/// The callers of one node in one step.
#[derive(Debug, Clone, Copy)]
struct Called {
    pull: DVec2,
    first: u32,
    last: u32,
    /// The round of calls this is from.
    round: u32,
}

/// The living sources and whom they call.
pub(super) struct Calls {
    positions: Vec<DVec2>,
    near: Vec<Near>,
    /// No node but the nearest is nearer than this (squared); kept where the blade deforms.
    others2: Vec<f64>,
    sight: Vec<Sight>,
    /// The next caller of the same node.
    next: Vec<u32>,
    /// Sources in reach of a node, ascending, and those that came into reach since.
    acting: Vec<u32>,
    arrived: Vec<u32>,
    is_acting: Vec<bool>,
    dead: Vec<u32>,
    called: Vec<Called>,
    round: u32,
    living: usize,
    index: PointIndex,
    /// The source of each point of the index.
    indexed: Vec<u32>,
    /// The first source that is not in the index.
    unindexed: usize,
    reach_mm: f64,
    kill_mm: f64,
    deforms: bool,
    convex: bool,
}

impl Calls {
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Self {
        let unlimited = spec.attraction_distance_mm == 0.0;
        Self {
            positions: Vec::new(),
            near: Vec::new(),
            others2: Vec::new(),
            sight: Vec::new(),
            next: Vec::new(),
            acting: Vec::new(),
            arrived: Vec::new(),
            is_acting: Vec::new(),
            dead: Vec::new(),
            called: Vec::new(),
            round: 0,
            living: 0,
            index: PointIndex::new(&[]),
            indexed: Vec::new(),
            unindexed: 0,
            reach_mm: if unlimited { f64::INFINITY } else { spec.attraction_distance_mm },
            kill_mm: spec.kill_distance_mm,
            deforms: blade.deforms(),
            convex: blade.is_convex(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    pub(super) fn living(&self) -> usize {
        self.living
    }

    /// How far a node can matter to a source: by calling or by killing.
    fn search(&self, metric: Metric) -> f64 {
        metric.length(self.reach_mm.max(self.kill_mm))
    }

    /// Adds a source.
    pub(super) fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        let id = self.positions.len() as u32;
        let search = self.search(metric);
        let found = nodes.nearest(p, metric, search * search);
        let near = found.map_or(Near { distance2: f64::INFINITY, node: NONE }, |nearest| Near {
            distance2: nearest.distance2,
            node: nearest.id,
        });
        self.positions.push(p);
        self.near.push(near);
        if self.deforms {
            self.others2.push(found.map_or(search * search, |nearest| nearest.others2));
        }
        self.sight.push(Sight::Unknown);
        self.next.push(NONE);
        self.is_acting.push(found.is_some());
        if found.is_some() {
            self.arrived.push(id);
        }
        self.living += 1;
    }

    /// Puts newborn sources into the index once there are enough of them.
    pub(super) fn index_newborn(&mut self) {
        let outside = self.positions.len() - self.unindexed;
        if self.reach_mm.is_infinite() || outside <= NEWBORN.max(self.indexed.len() / 4) {
            return;
        }
        self.indexed = (0..self.positions.len() as u32)
            .filter(|&i| self.near[i as usize].distance2 >= 0.0)
            .collect();
        let points: Vec<DVec2> = self.indexed.iter().map(|&i| self.positions[i as usize]).collect();
        self.index = PointIndex::new(&points);
        self.unindexed = self.positions.len();
    }

    /// Lets every source in reach call its nearest node; the called nodes, ascending.
    pub(super) fn call(
        &mut self,
        blade: &GrowingBlade,
        step: u64,
        metric: Metric,
        nodes: &Nodes,
    ) -> Vec<NodeId> {
        self.merge_arrived();
        let never = Called { pull: DVec2::ZERO, first: NONE, last: NONE, round: 0 };
        self.called.resize(nodes.len(), never);
        self.round += 1;
        let round = self.round;
        let reach = metric.length(self.reach_mm);
        let (reach2, search2) = (reach * reach, self.search(metric).powi(2));
        let mut called = Vec::new();
        let mut acting = std::mem::take(&mut self.acting);
        let positions = nodes.positions();
        acting.retain(|&source| {
            let i = source as usize;
            if self.near[i].distance2 < 0.0 {
                return false;
            }
            if self.deforms {
                self.measure_again(i, nodes, metric, search2);
            }
            let Near { distance2, node } = self.near[i];
            if distance2 > search2 {
                self.is_acting[i] = false;
                if self.deforms {
                    // Out of reach of all; measured again when a new node comes.
                    self.near[i] = Near { distance2: f64::INFINITY, node: NONE };
                    self.others2[i] = search2;
                }
                return false;
            }
            // One that only the kill distance reaches calls nobody, nor does one that is touched.
            if distance2 > reach2
                || distance2 == 0.0
                || (!self.convex && !self.sees(i, blade, step, positions))
            {
                return true;
            }
            let towards = (self.positions[i] - positions[node as usize]) * metric.stretch;
            let entry = &mut self.called[node as usize];
            if entry.round != round {
                *entry = Called { pull: DVec2::ZERO, first: source, last: source, round };
                called.push(node);
            } else {
                self.next[entry.last as usize] = source;
                entry.last = source;
            }
            self.next[i] = NONE;
            entry.pull += towards / distance2.sqrt();
            true
        });
        self.acting = acting;
        called.sort_unstable();
        called
    }

    /// Merges the sources that came into reach into the ascending list: sums over callers are taken
    /// in the order of their ids, because floating-point addition is not associative.
    fn merge_arrived(&mut self) {
        if self.arrived.is_empty() {
            return;
        }
        self.arrived.sort_unstable();
        // From the back, in place.
        let (mut a, mut b) = (self.acting.len(), self.arrived.len());
        self.acting.resize(a + b, 0);
        for at in (0..a + b).rev() {
            if b == 0 {
                break;
            }
            if a > 0 && self.acting[a - 1] > self.arrived[b - 1] {
                a -= 1;
                self.acting[at] = self.acting[a];
            } else {
                b -= 1;
                self.acting[at] = self.arrived[b];
            }
        }
        self.arrived.clear();
    }

    /// Follows the nearest node of a source while the blade deforms.
    fn measure_again(&mut self, i: usize, nodes: &Nodes, metric: Metric, search2: f64) {
        let p = self.positions[i];
        let node = self.near[i].node;
        let distance2 = metric.distance_squared(p, nodes.position(node));
        self.near[i].distance2 = distance2;
        if distance2 < self.others2[i] {
            return;
        }
        if let Some(nearest) = nodes.nearest(p, metric, search2.max(distance2)) {
            if nearest.id != node {
                self.sight[i] = Sight::Unknown;
            }
            self.near[i] = Near { distance2: nearest.distance2, node: nearest.id };
            self.others2[i] = nearest.others2;
        }
    }

    /// Whether a source sees its nearest node.
    fn sees(&mut self, i: usize, blade: &GrowingBlade, step: u64, nodes: &[DVec2]) -> bool {
        let (p, q) = (self.positions[i], nodes[self.near[i].node as usize]);
        if self.sight[i] == Sight::Unknown {
            let hidden = blade.blocks_sight_for_ever(p, q);
            self.sight[i] = if hidden {
                Sight::Hidden
            } else if blade.blocks_sight_yet(p, q, step) {
                // The blade only gains tissue: look again in the next step.
                Sight::Unknown
            } else {
                Sight::Clear
            };
        }
        self.sight[i] == Sight::Clear
    }

    /// The sum of the unit vectors towards the callers of a called node.
    pub(super) fn pull(&self, node: NodeId) -> DVec2 {
        self.called[node as usize].pull
    }

    /// The callers of a called node, ascending.
    pub(super) fn callers(&self, node: NodeId) -> impl Iterator<Item = u32> + '_ {
        let entry = |source: u32| (source != NONE).then_some(source);
        let first = entry(self.called[node as usize].first);
        std::iter::successors(first, move |&source| entry(self.next[source as usize]))
    }

    /// The nearest of the callers of a called node, the first among equals.
    pub(super) fn nearest_caller(&self, node: NodeId) -> Option<u32> {
        let distance2 = |source: &u32| self.near[*source as usize].distance2;
        self.callers(node).min_by(|a, b| distance2(a).total_cmp(&distance2(b)))
    }

    /// The unit vector from the nearest node of a source to it.
    pub(super) fn unit_to(&self, source: u32, nodes: &Nodes, metric: Metric) -> DVec2 {
        let Near { distance2, node } = self.near[source as usize];
        let towards = self.positions[source as usize] - nodes.position(node);
        towards * metric.stretch / distance2.sqrt()
    }

    /// Lets the nodes from `before` on take over the sources they are nearest to.
    pub(super) fn take_over(&mut self, before: usize, nodes: &Nodes, metric: Metric) {
        let fresh = before as u32..nodes.len() as u32;
        if fresh.is_empty() {
            return;
        }
        if self.reach_mm.is_infinite() {
            self.offer_to_all(fresh, nodes, metric);
        } else {
            fresh.for_each(|node| self.offer_in_reach(node, nodes.position(node), metric));
        }
    }

    /// One new node asks the sources around it.
    fn offer_in_reach(&mut self, node: NodeId, at: DVec2, metric: Metric) {
        let search = self.search(metric);
        let Self { index, indexed, positions, near, others2, sight, arrived, is_acting, .. } = self;
        let mut offer = |source: u32| {
            let i = source as usize;
            let distance2 = metric.distance_squared(positions[i], at);
            if distance2 < near[i].distance2 && distance2 <= search * search {
                if let Some(others) = others2.get_mut(i) {
                    *others = others.min(near[i].distance2);
                }
                near[i] = Near { distance2, node };
                sight[i] = Sight::Unknown;
                if !is_acting[i] {
                    is_acting[i] = true;
                    arrived.push(source);
                }
            } else if let Some(others) = others2.get_mut(i) {
                *others = others.min(distance2);
            }
        };
        // The tree knows only the frame of the mature leaf, where the circle is an ellipse.
        let radius = metric.reach(search).max_element();
        index.for_each_within(at, radius, |point| offer(indexed[point as usize]));
        (self.unindexed as u32..positions.len() as u32).for_each(offer);
    }

    /// Every source looks at the new nodes.
    fn offer_to_all(&mut self, fresh: std::ops::Range<u32>, nodes: &Nodes, metric: Metric) {
        let tips = &nodes.positions()[fresh.start as usize..];
        let index = (tips.len() > FEW_TIPS).then(|| {
            PointIndex::new(&tips.iter().map(|p| *p * metric.stretch).collect::<Vec<_>>())
        });
        for &source in self.acting.iter().chain(&self.arrived) {
            let i = source as usize;
            let p = self.positions[i];
            let tip = match &index {
                Some(index) => index.nearest_within(p * metric.stretch, self.near[i].distance2),
                None => (0..tips.len() as u32).min_by(|&a, &b| {
                    let distance2 = |tip: u32| metric.distance_squared(p, tips[tip as usize]);
                    distance2(a).total_cmp(&distance2(b))
                }),
            };
            let Some(tip) = tip else { continue };
            let distance2 = metric.distance_squared(p, tips[tip as usize]);
            let nearer = distance2 < self.near[i].distance2;
            if let Some(others) = self.others2.get_mut(i) {
                // Other tips may be as near as this one.
                *others = others.min(distance2);
            }
            if nearer {
                self.near[i] = Near { distance2, node: fresh.start + tip };
                self.sight[i] = Sight::Unknown;
            }
        }
    }

    /// Removes the sources within the kill distance of a node; their ids.
    ///
    /// Only those that have a new nearest node, or are new themselves, can be: distances never shrink.
    pub(super) fn kill(&mut self, metric: Metric) -> &[u32] {
        let kill = metric.length(self.kill_mm);
        self.dead.clear();
        for &source in self.acting.iter().chain(&self.arrived) {
            let near = &mut self.near[source as usize];
            if (0.0..=kill * kill).contains(&near.distance2) {
                *near = DEAD;
                self.dead.push(source);
            }
        }
        self.living -= self.dead.len();
        &self.dead
    }

    /// The sources that are left, and why.
    pub(super) fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        let mut unreached = Unreached::default();
        for (i, near) in self.near.iter().enumerate().filter(|(_, near)| near.distance2 >= 0.0) {
            let hidden = || {
                let (p, q) = (self.positions[i], nodes.position(near.node));
                blade.blocks_sight(p, q, blade.last_step())
            };
            if near.node == NONE || !self.is_acting[i] {
                unreached.out_of_reach += 1;
            } else if hidden() {
                unreached.hidden += 1;
            } else {
                unreached.unfinished += 1;
            }
        }
        unreached
    }
}
