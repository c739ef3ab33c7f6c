//! Relative neighbours, tags and meetings of closed venation, and veins in each other's way.

use glam::DVec2;
use venation::geometry::polygon::nearest_on_segment;
use venation::veins::planar::CLEARANCE_MM;

use super::{Source, World};

/// The veins a source waits for, and until when.
#[derive(Clone)]
pub(super) struct Tag {
    veins: Vec<usize>,
    last_step: u64,
}

impl World<'_> {
    /// Farthest from which a node matters.
    fn search(&self) -> f64 {
        match self.spec.attraction_distance_mm {
            0.0 => f64::INFINITY,
            mm => self.length(mm).max(self.kill()),
        }
    }

    /// The relative neighbours of a place among the nodes, straight from the definition.
    fn relative_neighbours(&self, s: DVec2) -> Vec<usize> {
        let all = || 0..self.positions.len();
        let to = |v: usize| self.distance2(s, self.positions[v]);
        let between = |u: usize, v: usize| self.distance2(self.positions[u], self.positions[v]);
        let shields = |u: usize, v: usize| (to(u), u) < (to(v), v) && between(u, v) < to(v);
        let search = self.search();
        all()
            .filter(|&v| to(v) <= search * search)
            .filter(|&v| all().all(|u| u == v || !shields(u, v)))
            .collect()
    }

    /// The relative neighbours that are, or grew out of, those a source was tagged with.
    fn follow(&self, source: &mut Source) {
        let now = self.relative_neighbours(source.place);
        if let Some(tag) = &mut source.tag {
            let of = |v: usize| tag.veins.contains(&v);
            tag.veins =
                now.into_iter().filter(|&v| of(v) || self.parents[v].is_some_and(of)).collect();
        }
    }

    /// Whom a source calls.
    pub(super) fn calls_of(&self, source: &mut Source, reach: f64) -> Vec<usize> {
        let kill = self.kill();
        let mut nodes = self.relative_neighbours(source.place);
        self.follow(source);
        if let Some(tag) = &source.tag {
            nodes.clone_from(&tag.veins);
        }
        nodes.retain(|&v| {
            let d2 = self.distance2(source.place, self.positions[v]);
            d2 > kill * kill && d2 <= reach * reach && !self.hidden(source.place, self.positions[v])
        });
        nodes
    }

    /// Tags what has been reached and ends what need not, or must not, wait any longer.
    pub(super) fn settle(&mut self, sources: &mut Vec<Source>, patience: bool) {
        let kill = self.kill();
        let mut meetings = Vec::new();
        sources.retain_mut(|source| {
            let place = source.place;
            let to = |v: usize| self.distance2(place, self.positions[v]).sqrt();
            let come = |v: usize| self.distance2(place, self.positions[v]) <= kill * kill;
            if source.tag.is_none() {
                if !(0..self.positions.len()).any(come) {
                    return true;
                }
                let mut veins = self.relative_neighbours(place);
                veins.retain(|&v| !self.hidden(place, self.positions[v]));
                let farthest = veins.iter().map(|&v| to(v)).fold(0.0, f64::max);
                let steps = 2.0 * farthest / self.length(self.spec.node_step_mm);
                source.tag = Some(Tag { veins, last_step: self.step + steps.ceil() as u64 });
            } else {
                self.follow(source);
            }
            let tag = source.tag.as_ref().expect("just tagged");
            if patience && self.step < tag.last_step && !tag.veins.iter().all(|&v| come(v)) {
                return true;
            }
            let come: Vec<usize> = tag.veins.iter().copied().filter(|&v| come(v)).collect();
            meetings.push((place, come));
            false
        });
        for (place, veins) in meetings {
            self.meet(place, &veins);
        }
    }

    fn meet(&mut self, place: DVec2, veins: &[usize]) {
        let least = 1e-3 * self.length(self.spec.node_step_mm);
        let is_there = |q: DVec2| self.distance2(place, q) < least * least;
        let there = veins.iter().copied().find(|&v| is_there(self.positions[v]));
        if veins.len() < 2 || (there.is_none() && self.positions.iter().any(|q| is_there(*q))) {
            return;
        }
        let place = there.map_or(place, |v| self.positions[v]);
        let mut ends: Vec<usize> = there.into_iter().collect();
        for &v in veins {
            let from = self.positions[v];
            if Some(v) != there
                && ends.iter().all(|&end| !self.are_close(v, end))
                && !self.hidden(from, place)
                && !self.overlaps(v, place)
                && self.crossed(from, place, [v, there.unwrap_or(v)]).is_none()
            {
                ends.push(v);
            }
        }
        if ends.len() < 2 {
            return;
        }
        let junction = there.unwrap_or_else(|| {
            self.positions.push(place);
            self.parents.push(Some(ends[0]));
            self.positions.len() - 1
        });
        self.joins.extend(ends[1..].iter().map(|&v| (junction, v)));
    }

    /// All edges, as they were made.
    pub(super) fn edges(&self) -> Vec<(usize, usize)> {
        let grown = self.parents.iter().enumerate().filter_map(|(v, p)| Some(((*p)?, v)));
        grown.chain(self.joins.iter().copied()).collect()
    }

    /// Whether two nodes are next to each other or on a short way along edges.
    fn are_close(&self, a: usize, b: usize) -> bool {
        let limit = 2.0 * self.length(self.spec.kill_distance_mm);
        let mut way = vec![f64::INFINITY; self.positions.len()];
        way[a] = 0.0;
        let edges = self.edges();
        loop {
            let mut changed = false;
            for &(u, v) in &edges {
                let length = self.distance2(self.positions[u], self.positions[v]).sqrt();
                for (u, v) in [(u, v), (v, u)] {
                    if way[u] + length < way[v] && way[u] + length <= limit {
                        way[v] = way[u] + length;
                        changed = true;
                    }
                }
            }
            if !changed {
                break;
            }
        }
        way[b] <= limit || edges.contains(&(a, b)) || edges.contains(&(b, a))
    }

    /// The first edge crossed or touched on the way from `p` to `q`, those at some nodes excepted.
    fn crossed(&self, p: DVec2, q: DVec2, apart: [usize; 2]) -> Option<(usize, usize)> {
        let side = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let mut first: Option<(f64, (usize, usize))> = None;
        for (u, v) in self.edges() {
            if apart.contains(&u) || apart.contains(&v) {
                continue;
            }
            let (a, b) = (self.positions[u], self.positions[v]);
            let (before, after) = (side(a, b, p), side(a, b, q));
            // All but to touch is to be in the way.
            let crosses = before * after < 0.0 && side(p, q, a) * side(p, q, b) < 0.0;
            let apart = [(a, b, p), (a, b, q), (p, q, a), (p, q, b)]
                .map(|(a, b, p)| nearest_on_segment(a, b, p).distance(p));
            if crosses || apart.iter().any(|&gap| gap <= CLEARANCE_MM) {
                let way = if before == after { 0.0 } else { before / (before - after) };
                if first.is_none_or(|(least, _)| way < least) {
                    first = Some((way, (u, v)));
                }
            }
        }
        first.map(|(_, edge)| edge)
    }

    /// Whether an edge from a node would lie on one that it has.
    fn overlaps(&self, node: usize, p: DVec2) -> bool {
        let least = 1e-3 * self.length(self.spec.node_step_mm);
        let from = self.positions[node];
        let new = self.way(from, p);
        self.edges().into_iter().any(|(u, v)| {
            let other = if u == node {
                v
            } else if v == node {
                u
            } else {
                return false;
            };
            let old = self.way(from, self.positions[other]);
            let (long, short) = if old.length() > new.length() { (old, new) } else { (new, old) };
            short.dot(long) > 0.0 && short.perp_dot(long).abs() / long.length() < least
        })
    }

    /// Whether a vein stands in the way of a step; in closed venation the step may end in a join.
    pub(super) fn stops(&mut self, node: usize, child: DVec2) -> bool {
        if self.overlaps(node, child) {
            return true;
        }
        let from = self.positions[node];
        let Some((a, b)) = self.crossed(from, child, [node, node]) else { return false };
        if !self.closing {
            return true;
        }
        let to = |v: usize| self.distance2(from, self.positions[v]);
        let end = if to(b) < to(a) { b } else { a };
        let free = to(end) <= (2.0 * self.length(self.spec.node_step_mm)).powi(2)
            && !self.are_close(node, end)
            && !self.hidden(from, self.positions[end])
            && !self.overlaps(node, self.positions[end])
            && self.crossed(from, self.positions[end], [node, end]).is_none();
        if free {
            self.joins.push((node, end));
        }
        true
    }
}
