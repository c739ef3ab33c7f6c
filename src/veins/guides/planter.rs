//! Lines become nodes of a graph, and stop before they would touch anything.

use glam::DVec2;

use super::curve;
use super::ground::Ground;
use crate::geometry::point_grid::{Nearest, PointGrid};
use crate::geometry::polygon::segments_touch;
use crate::veins::graph::{NodeId, Rank, VeinGraph, VeinKind};

/// A branch may run this close beside its parent for as many clearances from where it leaves it.
const LEAVING: f64 = 6.0;

/// Guides keep this many steps between them.
pub(super) const CLEARANCE: f64 = 1.5;

/// As many where their courses are known not to meet.
pub(super) const CLOSE: f64 = 0.4;

/// The steps of a bud, in steps.
const BUD: f64 = 0.4;

/// The veins laid so far.
pub(super) struct Planter<'a> {
    pub(super) ground: &'a Ground<'a>,
    pub(super) graph: VeinGraph,
    pub(super) records: Vec<Record>,
    near: PointGrid,
    pub(super) step: f64,
    clearance: f64,
}

/// What was laid at once: one vein, or a piece of one.
#[derive(Debug, Clone)]
pub(super) struct Record {
    /// From the one it grew out of.
    pub(super) nodes: Vec<NodeId>,
    pub(super) rank: Rank,
    /// The node of another vein that its end was joined to.
    pub(super) joined: Option<NodeId>,
}

/// A vein that was laid, from the node it grew out of.
#[derive(Debug, Clone)]
pub(super) struct Vein {
    pub(super) nodes: Vec<NodeId>,
    pub(super) line: Vec<DVec2>,
    /// The vein that stopped it.
    pub(super) hit: Option<NodeId>,
}

impl Vein {
    /// The node a share of the length along, never the first or last; the place and direction there.
    pub(super) fn at(&self, share: f64) -> (NodeId, DVec2, DVec2) {
        let last = self.nodes.len() - 1;
        // Nodes stand at equal steps.
        let i =
            ((share * last as f64).round() as usize).clamp(1.min(last), last.max(2) - 1).min(last);
        let wide = (last / 40).max(2);
        let (a, b) = (i.saturating_sub(wide), (i + wide).min(last));
        let ahead = (self.line[b] - self.line[a]).normalize_or_zero();
        (self.nodes[i], self.line[i], ahead)
    }

    pub(super) fn end(&self) -> (NodeId, DVec2, DVec2) {
        let last = self.nodes.len() - 1;
        let ahead = self.line[last] - self.line[last.saturating_sub(3)];
        (self.nodes[last], self.line[last], ahead.normalize_or_zero())
    }

    pub(super) fn length(&self) -> f64 {
        curve::length(&self.line)
    }
}

impl<'a> Planter<'a> {
    pub(super) fn new(ground: &'a Ground<'a>, step: f64) -> Self {
        let bounds = ground.margin().bounds();
        Self {
            ground,
            graph: VeinGraph::new(),
            records: Vec::new(),
            near: PointGrid::new(bounds, 2.0 * step),
            step,
            clearance: CLEARANCE * step,
        }
    }

    /// Veins laid from now on keep this many steps between them.
    pub(super) fn keep_apart(&mut self, steps: f64) {
        self.clearance = steps * self.step;
    }

    pub(super) fn root(&mut self, rank: Rank) -> NodeId {
        let root = self.graph.add_root(self.ground.root());
        self.graph.set_rank(root, rank);
        self.near.push(self.ground.root());
        root
    }

    /// Lays a vein out of `from` along `line`, as far as it gets; nothing at all when that is less
    /// than the share `least` of it.
    pub(super) fn lay(
        &mut self,
        from: NodeId,
        line: &[DVec2],
        rank: Rank,
        least: f64,
    ) -> Option<Vein> {
        let start = self.graph.positions()[from as usize];
        let mut line = line.to_vec();
        *line.first_mut()? = start;
        let mut points = curve::resampled(&line, self.step);
        let mut hit = None;
        let mut free = 1;
        while free < points.len() {
            let (a, b) = (points[free - 1], points[free]);
            if !b.is_finite() || !self.is_free(a, b, rank) {
                break;
            }
            // A curve that is drawn tight can cross itself.
            let own = points[..free].windows(2).rev().skip(1);
            let near = |w: &&[DVec2]| w[0].distance_squared(b) < 16.0 * self.step * self.step;
            if own.filter(near).any(|w| segments_touch(a, b, w[0], w[1])) {
                break;
            }
            hit = self.in_the_way(a, b, from, start);
            if hit.is_some() {
                break;
            }
            free += 1;
        }
        if free < 3 || ((free - 1) as f64) < least * (points.len() - 1) as f64 {
            return None;
        }
        points.truncate(free);
        Some(self.grow(from, points, rank, hit))
    }

    /// Lays the least vein there is out of `from` along `line`, of two short steps, close to the margin if
    /// it must.
    pub(super) fn lay_bud(&mut self, from: NodeId, line: &[DVec2], rank: Rank) -> Option<Vein> {
        let start = self.graph.positions()[from as usize];
        let whole = curve::resampled(line, BUD * self.step);
        let points = whole.get(..3)?.to_vec();
        let is_free = |w: &[DVec2]| {
            self.ground.is_inside(w[0], w[1]) && self.in_the_way(w[0], w[1], from, start).is_none()
        };
        points.windows(2).all(is_free).then(|| self.grow(from, points, rank, None))
    }

    /// Adds the nodes of a vein.
    fn grow(&mut self, from: NodeId, line: Vec<DVec2>, rank: Rank, hit: Option<NodeId>) -> Vein {
        // A vein along the margin can begin at a branch of a secondary.
        let least = self.graph.rank(from).map_or(0, |parent| parent.order);
        let rank = Rank { order: rank.order.max(least), ..rank };
        let mut nodes = vec![from];
        for &p in &line[1..] {
            let node = self.graph.sprout(nodes[nodes.len() - 1], p);
            self.graph.set_rank(node, rank);
            self.near.push(p);
            nodes.push(node);
        }
        self.records.push(Record { nodes: nodes.clone(), rank, joined: None });
        Vein { nodes, line, hit }
    }

    /// Whether margin and cuts let a vein of this rank go from a to b.
    fn is_free(&self, a: DVec2, b: DVec2, rank: Rank) -> bool {
        match rank.kind {
            VeinKind::Primary => self.ground.is_free_at_base(a, b),
            _ => self.ground.is_free(a, b),
        }
    }

    /// The share of a line that margin and cuts leave free for a vein of this rank.
    pub(super) fn way(&self, line: &[DVec2], rank: Rank) -> f64 {
        let points = curve::resampled(line, self.step);
        let is_free = |w: &&[DVec2]| self.is_free(w[0], w[1], rank);
        let free = points.windows(2).take_while(is_free).count();
        free as f64 / (points.len() - 1).max(1) as f64
    }

    /// The node nearest to `p`.
    pub(super) fn nearest(&self, p: DVec2) -> Option<Nearest> {
        self.near.nearest(self.graph.positions(), p, DVec2::ONE, f64::INFINITY)
    }

    /// Where a straight vein out of a node would meet another vein, within a distance; `None` where it
    /// would come to the margin or nowhere.
    pub(super) fn probe(&self, from: NodeId, towards: DVec2, longest: f64) -> Option<DVec2> {
        let start = self.graph.positions()[from as usize];
        let pieces = (longest / self.step) as usize;
        let mut last = start;
        for i in 1..=pieces {
            let next = start + towards * (i as f64 * self.step);
            if !next.is_finite() || !self.ground.is_free(last, next) {
                return None;
            }
            if let Some(hit) = self.in_the_way(last, next, from, start) {
                return (i > 2).then(|| self.graph.positions()[hit as usize]);
            }
            last = next;
        }
        None
    }

    /// A node of another vein that the piece a–b would touch or come too close to.
    fn in_the_way(&self, a: DVec2, b: DVec2, from: NodeId, start: DVec2) -> Option<NodeId> {
        let positions = self.graph.positions();
        let leaving = b.distance(start) < LEAVING * self.clearance;
        let first = a == start;
        let mut found: Option<(f64, NodeId)> = None;
        let half = DVec2::splat(self.clearance + 2.0 * self.step);
        self.near.any_near(positions, b, half, |id, q| {
            let d2 = b.distance_squared(q);
            let close = if leaving { 0.05 * self.step } else { self.clearance };
            let parent = self.graph.parent(id);
            let own = first && (id == from || parent == Some(from));
            let crosses =
                !own && parent.is_some_and(|p| segments_touch(a, b, positions[p as usize], q));
            let is_close = d2 < close * close;
            if (crosses || is_close) && found.is_none_or(|best| (d2, id) < best) {
                found = Some((d2, id));
            }
            false
        });
        let joined = self.graph.joins().iter().any(|&(c, d)| {
            let own = first && (c == from || d == from);
            let [c, d] = [c, d].map(|id| positions[id as usize]);
            !own && segments_touch(a, b, c, d)
        });
        if joined && found.is_none() {
            return self.nearest(b).map(|nearest| nearest.id);
        }
        found.map(|(_, id)| id)
    }

    /// Lays a line that starts beside another vein: out of the nearest node to the place where it
    /// has got free of the others for good.
    pub(super) fn lay_beside(&mut self, line: &[DVec2], rank: Rank, least: f64) -> Option<Vein> {
        let points = curve::resampled(line, self.step);
        let free = 1.6 * self.clearance;
        let is_near = |&p: &DVec2| self.nearest(p).is_none_or(|n| n.distance2 <= free * free);
        let lower = points.len() / 2;
        let first = points[..lower].iter().rposition(is_near).map_or(0, |last| last + 1);
        if first == lower {
            return None;
        }
        // Out of a node farther back, so that it leaves at a small angle.
        let back = points[first.saturating_sub(6)];
        let from = self.nearest(back)?.id;
        let mut rest = vec![self.graph.positions()[from as usize]];
        rest.extend(&points[first..]);
        self.lay(from, &rest, rank, least)
    }

    /// Records that a vein has met the one that stopped it, or one that lies between.
    pub(super) fn join_hit(&mut self, vein: &Vein) {
        let Some(hit) = vein.hit else { return };
        let (end, at, _) = vein.end();
        let Some(met) = self.first_met(end, at, hit) else { return };
        if vein.nodes.contains(&met) {
            return;
        }
        self.graph.join(end, met);
        let ends_here = |record: &&mut Record| record.nodes.last() == Some(&end);
        if let Some(record) = self.records.iter_mut().rev().find(ends_here) {
            record.joined = Some(met);
        }
    }

    /// The node that an end can be joined to without crossing anything on the way: `hit`, or the nearer
    /// node of a vein before it.
    fn first_met(&self, end: NodeId, at: DVec2, hit: NodeId) -> Option<NodeId> {
        let (graph, positions) = (&self.graph, self.graph.positions());
        let mut met = hit;
        // Each is nearer than the one before, so this ends.
        loop {
            let to = positions[met as usize];
            let reach = at.distance(to);
            let related =
                end == met || graph.parent(end) == Some(met) || graph.parent(met) == Some(end);
            if related || !self.ground.is_free(at, to) {
                return None;
            }
            let crosses = |a: NodeId, b: NodeId| {
                let linked = [a, b].iter().any(|&n| n == end || n == met);
                !linked && segments_touch(at, to, positions[a as usize], positions[b as usize])
            };
            let mut between: Option<(f64, NodeId)> = None;
            let mut is_clear = true;
            let mut note = |a: NodeId, b: NodeId| {
                is_clear = false;
                for n in [a, b] {
                    let distance = at.distance(positions[n as usize]);
                    if distance < reach && between.is_none_or(|best| (distance, n) < best) {
                        between = Some((distance, n));
                    }
                }
            };
            let half = DVec2::splat(reach + 2.0 * self.step);
            self.near.any_near(positions, to, half, |id, _| {
                if let Some(parent) = graph.parent(id).filter(|&parent| crosses(parent, id)) {
                    note(parent, id);
                }
                false
            });
            let joins = graph.joins().iter().filter(|&&(a, b)| crosses(a, b));
            joins.for_each(|&(a, b)| note(a, b));
            if is_clear {
                return Some(met);
            }
            met = between?.1;
        }
    }
}
