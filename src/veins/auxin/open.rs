//! Open venation: each source calls the one node it is nearest to, and veins never meet.
//!
//! A source remembers its nearest node. Distances between tissue never shrink in the model's measure,
//! so only a new node can take a source over: the work follows what changed, not what is there.
//! With a reach, each new node asks a static index of the sources which ones it wins; without,
//! tiles of sources look at the new nodes of the step ([`super::tiles`]). Where the blade changes its
//! proportions an old node can become the nearest too: then each source also keeps a lower bound on
//! the distance of all others and searches again when its nearest node grows past it.

use glam::DVec2;

use super::claims::{Claims, NONE, Sight};
use super::extend::Nodes;
use super::tiles::Tiles;
use crate::geometry::point_index::PointIndex;
use crate::growth::{GrowingBlade, Metric};
use crate::veins::graph::NodeId;
use crate::veins::{Unreached, VeinSpec};

/// Newborn sources stand in a plain list until there are this many, or a quarter of the index.
const NEWBORN: usize = 64;

/// The index is built anew when less than this share of it is alive: every search also finds the
/// dead. Building takes about as long as one search in ten finds.
const THINNED: f64 = 0.5;

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
    claims: Claims,
    /// The next caller of the same node.
    next: Vec<u32>,
    /// Sources in reach of a node, ascending.
    acting: Vec<u32>,
    /// Sources born within the kill distance: they call once.
    doomed: Vec<u32>,
    called: Vec<Called>,
    round: u32,
    living: usize,
    index: PointIndex,
    /// The source of each point of the index.
    indexed: Vec<u32>,
    /// The first source that is not in the index.
    unindexed: usize,
    /// Instead of the index, without a reach.
    tiles: Option<Tiles>,
    reach_mm: f64,
    kill_mm: f64,
    deforms: bool,
    /// Distances may shrink, too: every source is looked after in every step.
    warps: bool,
    convex: bool,
}

impl Calls {
    pub(super) fn new(spec: &VeinSpec, blade: &GrowingBlade) -> Self {
        let unlimited = spec.attraction_distance_mm == 0.0;
        Self {
            positions: Vec::new(),
            claims: Claims::new(blade.deforms() && !blade.is_warped()),
            next: Vec::new(),
            acting: Vec::new(),
            doomed: Vec::new(),
            called: Vec::new(),
            round: 0,
            living: 0,
            index: PointIndex::new(&[]),
            indexed: Vec::new(),
            unindexed: 0,
            tiles: unlimited.then(|| Tiles::new(blade.mature().bounds())),
            reach_mm: if unlimited { f64::INFINITY } else { spec.attraction_distance_mm },
            kill_mm: spec.kill_distance_mm,
            deforms: blade.deforms(),
            warps: blade.is_warped(),
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

    fn kill2(&self, metric: Metric) -> f64 {
        metric.length(self.kill_mm).powi(2)
    }

    /// Adds a source.
    pub(super) fn add(&mut self, p: DVec2, nodes: &Nodes, metric: Metric) {
        let id = self.positions.len() as u32;
        let search2 = self.search(metric).powi(2);
        let found = nodes.nearest(p, metric, search2);
        let others2 = found.map_or(search2, |nearest| nearest.others2);
        self.claims.add(found.map(|nearest| (nearest.distance2, nearest.id)), others2);
        if self.warps {
            self.claims.watch(id);
        }
        if found.is_some_and(|nearest| nearest.distance2 <= self.kill2(metric)) {
            self.doomed.push(id);
        }
        if let Some(tiles) = &mut self.tiles {
            tiles.push(id, p);
        }
        self.positions.push(p);
        self.next.push(NONE);
        self.living += 1;
    }

    /// Adds a source that is used up already, so that those after it keep their numbers.
    pub(super) fn add_spent(&mut self, p: DVec2) {
        let id = self.positions.len() as u32;
        self.claims.add(None, 0.0);
        self.claims.kill(id);
        self.claims.take_dead();
        self.positions.push(p);
        self.next.push(NONE);
    }

    /// Builds the index anew once enough sources were born or died since.
    pub(super) fn keep_index(&mut self) {
        let outside = self.positions.len() - self.unindexed;
        let grown = outside > NEWBORN.max(self.indexed.len() / 4);
        let thinned =
            ((self.living - outside.min(self.living)) as f64) < THINNED * self.indexed.len() as f64;
        if self.tiles.is_some() || !(grown || thinned) {
            return;
        }
        let alive = |i: &u32| self.claims.is_alive(*i as usize);
        self.indexed = (0..self.positions.len() as u32).filter(alive).collect();
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
        let mut acting = std::mem::take(&mut self.acting);
        merge(&mut acting, &self.claims.take_arrived());
        let never = Called { pull: DVec2::ZERO, first: NONE, last: NONE, round: 0 };
        self.called.resize(nodes.len(), never);
        self.round += 1;
        if let Some(tiles) = &mut self.tiles {
            tiles.begin(&acting, &self.positions);
        }
        let reach2 = metric.length(self.reach_mm).powi(2);
        let search2 = self.search(metric).powi(2);
        let mut called = Vec::new();
        // Ascending: sums over callers are taken in the order of their ids, because floating-point
        // addition is not associative.
        acting.retain(|&source| {
            let i = source as usize;
            if !self.claims.is_alive(i) {
                return false;
            }
            if self.deforms {
                self.measure_again(i, nodes, metric, search2);
            }
            let distance2 = self.claims.near2(i);
            if let Some(tiles) = &mut self.tiles {
                tiles.raise(self.positions[i], self.claims.bound2(i));
            }
            if distance2 > search2 {
                if !self.warps {
                    self.claims.out_of_reach(i, search2);
                }
                return self.warps;
            }
            // One that only the kill distance reaches calls nobody, nor does one that is touched.
            let calls = distance2 <= reach2 && distance2 > 0.0;
            if !calls || (!self.convex && !self.sees(i, blade, step, nodes)) {
                return true;
            }
            let node = self.claims.nearest(i);
            let towards = metric.between(nodes.position(node), self.positions[i]);
            let entry = &mut self.called[node as usize];
            if entry.round != self.round {
                let round = self.round;
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

    /// Follows the nearest node of a source while the blade deforms.
    fn measure_again(&mut self, i: usize, nodes: &Nodes, metric: Metric, search2: f64) {
        let p = self.positions[i];
        if self.warps {
            let found = nodes.nearest(p, metric, search2);
            self.claims.found(i, found.map(|nearest| (nearest.distance2, nearest.id)));
            return;
        }
        let distance2 = metric.distance_squared(p, nodes.position(self.claims.nearest(i)));
        if self.claims.measured(i, distance2)
            && let Some(found) = nodes.nearest(p, metric, search2.max(distance2))
        {
            self.claims.searched(i, found.distance2, found.id, found.others2);
        }
    }

    /// Whether a source sees its nearest node.
    fn sees(&mut self, i: usize, blade: &GrowingBlade, step: u64, nodes: &Nodes) -> bool {
        if self.claims.sight(i) == Sight::Unknown {
            let (p, q) = (self.positions[i], nodes.position(self.claims.nearest(i)));
            if blade.blocks_sight_for_ever(p, q) {
                self.claims.set_sight(i, Sight::Hidden);
            } else if !blade.blocks_sight_yet(p, q, step) {
                // The blade only gains tissue: what is clear stays clear.
                self.claims.set_sight(i, Sight::Clear);
            }
        }
        self.claims.sight(i) == Sight::Clear
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
        let distance2 = |source: &u32| self.claims.near2(*source as usize);
        self.callers(node).min_by(|a, b| distance2(a).total_cmp(&distance2(b)))
    }

    /// The unit vector from the nearest node of a source to it.
    pub(super) fn unit_to(&self, source: u32, nodes: &Nodes, metric: Metric) -> DVec2 {
        let i = source as usize;
        let from = nodes.position(self.claims.nearest(i));
        metric.between(from, self.positions[i]) / self.claims.near2(i).sqrt()
    }

    /// Lets the nodes from `before` on take over the sources they are nearest to, and removes every
    /// source within the kill distance of a node; the ids of the dead.
    ///
    /// Only a new node can kill, or an old one a newborn source: distances never shrink, unless rates
    /// of growth differ from place to place.
    pub(super) fn take_over(&mut self, before: usize, nodes: &Nodes, metric: Metric) -> Vec<u32> {
        let fresh = &nodes.positions()[before..];
        let kill2 = self.kill2(metric);
        if fresh.is_empty() {
            // Nobody is taken over.
        } else if let Some(tiles) = &mut self.tiles {
            let (claims, positions) = (&mut self.claims, &self.positions);
            tiles.offer(fresh, positions, metric, |source, tip| {
                let (i, tip) = (source as usize, tip as usize);
                if !claims.is_alive(i) {
                    return false;
                }
                let distance2 = metric.distance_squared(positions[i], fresh[tip]);
                claims.offer(source, (before + tip) as NodeId, distance2, kill2);
                // Another tip may be as near.
                claims.bound_others(i, distance2);
                true
            });
        } else {
            for (i, &at) in fresh.iter().enumerate() {
                self.offer_in_reach((before + i) as NodeId, at, metric);
            }
        }
        for source in self.doomed.drain(..) {
            self.claims.kill(source);
        }
        if self.warps {
            for i in 0..self.acting.len() {
                let source = self.acting[i];
                if self.claims.near2(source as usize) <= kill2 {
                    self.claims.kill(source);
                }
            }
        }
        let dead = self.claims.take_dead();
        self.living -= dead.len();
        dead
    }

    /// One new node asks the sources around it.
    fn offer_in_reach(&mut self, node: NodeId, at: DVec2, metric: Metric) {
        let search = self.search(metric);
        let (search2, kill2) = (search * search, self.kill2(metric));
        let newborn = self.unindexed as u32..self.positions.len() as u32;
        let Self { index, indexed, positions, claims, deforms, .. } = self;
        let offer = |source: u32, claims: &mut Claims| {
            let distance2 = metric.distance_squared(positions[source as usize], at);
            if distance2 <= search2 {
                claims.offer(source, node, distance2, kill2);
            }
        };
        // The tree knows only the frame of the mature leaf, where the circle is an ellipse.
        let radius = metric.radius(at, search);
        index.for_each_within(at, radius, |point, about2| {
            let source = indexed[point as usize];
            // Most sources around are dead or have a nearer node: do not even fetch their place.
            if *deforms || about2 <= claims.near2(source as usize) * (1.0 + 1e-9) {
                offer(source, claims);
            }
        });
        newborn.for_each(|source| offer(source, claims));
    }

    /// The sources that are left, and why.
    pub(super) fn unreached(&self, blade: &GrowingBlade, nodes: &Nodes) -> Unreached {
        let mut unreached = Unreached::default();
        for i in (0..self.positions.len()).filter(|&i| self.claims.is_alive(i)) {
            let node = self.claims.nearest(i);
            let hidden = || {
                let step = blade.last_step();
                blade.blocks_sight(self.positions[i], nodes.position(node), step)
            };
            if node == NONE || !self.claims.is_acting(i) {
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

/// Merges an ascending list into another, from the back and in place.
pub(super) fn merge(into: &mut Vec<u32>, other: &[u32]) {
    let (mut a, mut b) = (into.len(), other.len());
    into.resize(a + b, 0);
    for at in (0..a + b).rev() {
        if b == 0 {
            break;
        }
        if a > 0 && into[a - 1] > other[b - 1] {
            a -= 1;
            into[at] = into[a];
        } else {
            b -= 1;
            into[at] = other[b];
        }
    }
}
