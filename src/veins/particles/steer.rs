//! Which way to the petiole: straight, or along the shortest path inside the margin.
//!
//! The paper steers straight at the petiole and leaves the blade where a lobe hides it. Here every
//! cell of a grid knows the corner to make for: a shortest-path search over the cells from the
//! petiole, in which a cell makes for whatever the cell before it makes for, as long as margin and
//! cuts leave the view of it free, so that paths are straight between the corners they turn round.
//!
//! Source of the search: Nash, Koenig and Tovey, "Lazy Theta*", AAAI 2010. Sight is settled on the
//! polygon, not on the cells.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;

/// Cells over the blade: a lobe of a thousandth of its area still has a dozen.
const CELLS: f64 = 12_000.0;

/// How often cells are halved until every cell inside has a way to the petiole: a bridge narrower
/// than a cell hides what is behind it.
const HALVINGS: u32 = 3;

/// No way found.
const NONE: u32 = u32::MAX;

/// What there is to know about the way.
#[derive(Debug)]
pub(super) struct Steer {
    roots: Vec<DVec2>,
    walls: Option<Walls>,
    longest: f64,
}

/// The margin and the cuts, and the way round them.
#[derive(Debug)]
struct Walls {
    edges: SegmentIndex,
    cuts: SegmentIndex,
    convex: bool,
    ways: Ways,
}

impl Walls {
    fn free(&self, a: DVec2, b: DVec2) -> bool {
        !self.edges.touches(a, b) && !self.cuts.touches(a, b)
    }
}

impl Steer {
    /// Straight at the nearest root, whatever is between.
    pub(super) fn plain(margin: &Margin, roots: &[DVec2]) -> Self {
        Self { roots: roots.to_vec(), walls: None, longest: margin.bounds().size().length() }
    }

    /// Along the shortest path inside the blade.
    pub(super) fn inside(margin: &Margin, roots: &[DVec2]) -> Self {
        let mut steer = Self::plain(margin, roots);
        let cuts = margin.cuts().iter().flat_map(|line| line.windows(2).map(|w| (w[0], w[1])));
        let mut walls = Walls {
            edges: SegmentIndex::of_polygon(margin.outline()),
            cuts: SegmentIndex::new(cuts.collect()),
            convex: margin.cuts().is_empty() && polygon::is_convex(margin.outline()),
            ways: Ways::none(),
        };
        if !walls.convex {
            for halving in 0..=HALVINGS {
                let cell = (margin.area_mm2() / CELLS).sqrt() / f64::from(1 << halving);
                walls.ways = Ways::find(margin, &walls, roots, cell);
                if walls.ways.lost == 0 {
                    break;
                }
            }
            steer.longest = steer.longest.max(walls.ways.longest);
        }
        steer.walls = Some(walls);
        steer
    }

    /// The longest way to a root (mm), about.
    pub(super) fn longest(&self) -> f64 {
        self.longest
    }

    /// Whether two particles can see each other.
    pub(super) fn sees(&self, a: DVec2, b: DVec2) -> bool {
        self.walls.as_ref().is_none_or(|walls| walls.convex || walls.free(a, b))
    }

    /// The root that a particle at `p` has arrived at, when one is within `reach` and in sight.
    pub(super) fn arrived(&self, p: DVec2, reach: f64, lost: bool) -> Option<usize> {
        let near = |&i: &usize| {
            let root = self.roots[i];
            p.distance_squared(root) <= reach * reach && (lost || self.sees(p, root))
        };
        (0..self.roots.len()).find(near)
    }

    fn nearest_root(&self, p: DVec2) -> DVec2 {
        let nearer =
            |a: &DVec2, b: &DVec2| p.distance_squared(*a).total_cmp(&p.distance_squared(*b));
        self.roots.iter().copied().min_by(nearer).unwrap_or(DVec2::ZERO)
    }

    /// The square of how far it is to the nearest root, straight.
    pub(super) fn off_root2(&self, p: DVec2) -> f64 {
        self.nearest_root(p).distance_squared(p)
    }

    /// The corner or root to make for from `p`; `None` where no way is known.
    pub(super) fn target(&self, p: DVec2) -> Option<DVec2> {
        match &self.walls {
            Some(walls) if !walls.convex => walls.ways.target(p, &self.roots, walls),
            _ => Some(self.nearest_root(p)),
        }
    }

    /// Where a particle at `p` is after a step along p̂ + q̂; `neighbour` is the one that attracts it.
    ///
    /// A step has one length, whatever that of the sum is, but where the sum is shorter than a unit vector:
    /// there a particle is followed by its neighbour, and the less is left of its way the more it waits.
    ///
    /// Where the margin or a cut is in the way it goes along q̂ alone, or to the middle of its cell,
    /// from where the way is free. One that can do neither is lost: from then on it goes straight.
    pub(super) fn step(
        &self,
        p: DVec2,
        neighbour: Option<DVec2>,
        step: f64,
        lost: &mut bool,
    ) -> DVec2 {
        let target = if *lost { None } else { self.target(p) };
        let q = unit(target.unwrap_or_else(|| self.nearest_root(p)) - p);
        let both =
            p + step * neighbour.map_or(q, |other| (unit(other - p) + q).clamp_length_max(1.0));
        let Some(walls) = &self.walls else { return both };
        if *lost {
            return p + step * q;
        }
        if let Some(target) = target {
            let middle = walls.ways.middle(p);
            let ways =
                [Some(both), Some(towards(p, target, step)), middle.map(|m| towards(p, m, step))];
            if let Some(to) = ways.into_iter().flatten().find(|&to| to != p && walls.free(p, to)) {
                return to;
            }
        }
        *lost = true;
        p + step * q
    }
}

fn unit(v: DVec2) -> DVec2 {
    let length = v.length();
    if length > 0.0 { v / length } else { DVec2::ZERO }
}

/// `step` from `p` towards `to`, but not beyond.
fn towards(p: DVec2, to: DVec2, step: f64) -> DVec2 {
    let along = to - p;
    let length = along.length();
    if length <= step { to } else { p + along * (step / length) }
}

/// What every cell makes for.
#[derive(Debug)]
struct Ways {
    min: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// A root, or a cell's number behind the roots.
    target: Vec<u32>,
    /// How far it is to a root (mm); nothing where there is no way.
    distance: Vec<f64>,
    /// Cells inside without a way.
    lost: usize,
    longest: f64,
}

impl Ways {
    fn none() -> Self {
        let (target, distance) = (Vec::new(), Vec::new());
        Self {
            min: DVec2::ZERO,
            cell: 1.0,
            columns: 0,
            rows: 0,
            target,
            distance,
            lost: 0,
            longest: 0.0,
        }
    }

    fn centre(&self, cell: usize) -> DVec2 {
        let place = DVec2::new((cell % self.columns) as f64, (cell / self.columns) as f64);
        self.min + (place + 0.5) * self.cell
    }

    fn cell_at(&self, p: DVec2) -> (isize, isize) {
        let place = ((p - self.min) / self.cell).floor();
        (place.x as isize, place.y as isize)
    }

    /// The cells at the rim of a square around a cell.
    fn ring(&self, (x, y): (isize, isize), ring: isize) -> impl Iterator<Item = usize> + use<> {
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        (-ring..=ring)
            .flat_map(move |dy| {
                let across = if dy.abs() == ring { 1 } else { (2 * ring).max(1) };
                (-ring..=ring).step_by(across as usize).map(move |dx| (x + dx, y + dy))
            })
            .filter(move |&(x, y)| x >= 0 && y >= 0 && x < columns && y < rows)
            .map(move |(x, y)| (y * columns + x) as usize)
    }

    fn point(&self, target: u32, roots: &[DVec2]) -> DVec2 {
        let target = target as usize;
        roots.get(target).copied().unwrap_or_else(|| self.centre(target - roots.len()))
    }

    fn find(margin: &Margin, walls: &Walls, roots: &[DVec2], cell: f64) -> Self {
        let bounds = margin.bounds();
        let size = bounds.size() / cell;
        let (columns, rows) = (size.x as usize + 1, size.y as usize + 1);
        let n = columns * rows;
        let (target, distance) = (vec![NONE; n], vec![f64::INFINITY; n]);
        let mut ways =
            Self { min: bounds.min, cell, columns, rows, target, distance, lost: 0, longest: 0.0 };
        let inside: Vec<bool> = (0..n).map(|c| walls.edges.contains(ways.centre(c))).collect();
        let mut search = Search { closed: vec![false; n], open: BinaryHeap::new() };
        for (i, &root) in roots.iter().enumerate() {
            // The nearest ring of cells that see the root: its own may be outside, in a narrow base.
            for ring in 0..columns.max(rows) as isize {
                let mut seen = false;
                for c in ways.ring(ways.cell_at(root), ring) {
                    if inside[c] && walls.free(ways.centre(c), root) {
                        let distance = ways.centre(c).distance(root);
                        search.offer(&mut ways, c, distance, i as u32);
                        seen = true;
                    }
                }
                if seen {
                    break;
                }
            }
        }
        while let Some(Reverse((_, c))) = search.open.pop() {
            let c = c as usize;
            if search.closed[c] {
                continue;
            }
            // Settle what the cell makes for: the view was taken for granted when it was offered.
            let (at, here) = (ways.centre(c), ways.cell_at(ways.centre(c)));
            if !walls.free(at, ways.point(ways.target[c], roots)) {
                let by_neighbour = ways
                    .ring(here, 1)
                    .filter(|&k| search.closed[k] && walls.free(at, ways.centre(k)))
                    .map(|k| (ways.distance[k] + ways.centre(k).distance(at), k))
                    .reduce(|a, b| if b < a { b } else { a });
                let Some((distance, k)) = by_neighbour else {
                    // Offered again when another neighbour is closed.
                    (ways.target[c], ways.distance[c]) = (NONE, f64::INFINITY);
                    continue;
                };
                (ways.target[c], ways.distance[c]) = ((roots.len() + k) as u32, distance);
            }
            search.closed[c] = true;
            ways.longest = ways.longest.max(ways.distance[c]);
            let target = ways.target[c];
            let corner = ways.point(target, roots);
            let before = ways.distance[c] - at.distance(corner);
            for k in ways.ring(here, 1) {
                if inside[k] && !search.closed[k] {
                    let distance = before + ways.centre(k).distance(corner);
                    search.offer(&mut ways, k, distance, target);
                }
            }
        }
        ways.lost = (0..n).filter(|&c| inside[c] && !search.closed[c]).count();
        ways
    }

    /// The middle of the cell of `p`, when a way leads from it.
    fn middle(&self, p: DVec2) -> Option<DVec2> {
        let c = self.ring(self.cell_at(p), 0).next()?;
        (self.target[c] != NONE).then(|| self.centre(c))
    }

    fn target(&self, p: DVec2, roots: &[DVec2], walls: &Walls) -> Option<DVec2> {
        let here = self.cell_at(p);
        let c = self.ring(here, 0).next();
        if let Some(c) = c.filter(|&c| self.target[c] != NONE) {
            return Some(self.point(self.target[c], roots));
        }
        // A cell at the margin, its middle outside: for what the cells around make for, the one with
        // the shortest way; else for the nearest of them.
        let around = || {
            let cells = (1..=2).flat_map(|ring| self.ring(here, ring));
            cells.filter(|&k| self.target[k] != NONE)
        };
        let least = |a: (f64, usize), b: (f64, usize)| if b < a { b } else { a };
        let by_target = around().filter_map(|k| {
            let corner = self.point(self.target[k], roots);
            let on = self.distance[k] - self.centre(k).distance(corner);
            walls.free(p, corner).then(|| (p.distance(corner) + on, k))
        });
        if let Some((_, k)) = by_target.reduce(least) {
            return Some(self.point(self.target[k], roots));
        }
        let in_sight = around().filter(|&k| walls.free(p, self.centre(k)));
        let nearest = in_sight.map(|k| (p.distance_squared(self.centre(k)), k)).reduce(least);
        nearest.map(|(_, k)| self.centre(k))
    }
}

/// The search so far.
struct Search {
    closed: Vec<bool>,
    /// Distances (their bits: they order like numbers at or above zero) and cells.
    open: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Search {
    fn offer(&mut self, ways: &mut Ways, cell: usize, distance: f64, target: u32) {
        if distance < ways.distance[cell] {
            ways.distance[cell] = distance;
            ways.target[cell] = target;
            self.open.push(Reverse((distance.to_bits(), cell as u32)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hook: up, across to the right and down again, the petiole at the foot of the left leg.
    fn hook() -> Margin {
        let outline = [
            (0., 0.),
            (2., 0.),
            (2., 16.),
            (8., 16.),
            (8., 2.),
            (12., 2.),
            (12., 20.),
            (0., 20.),
            (-1., 15.),
            (-1., 5.),
        ];
        Margin::new(outline.map(DVec2::from).to_vec(), 7, Vec::new(), "").expect("a margin")
    }

    #[test]
    fn the_way_round_two_corners_is_the_shortest() {
        let margin = hook();
        let root = DVec2::new(0.5, 0.5);
        let steer = Steer::inside(&margin, &[root]);
        let start = DVec2::new(11.0, 3.0);
        let (mut p, mut walked, mut lost) = (start, 0.0, false);
        while steer.arrived(p, 0.1, lost).is_none() {
            let next = steer.step(p, None, 0.1, &mut lost);
            walked += p.distance(next);
            assert!(polygon::contains(margin.outline(), next) && walked < 100.0, "{next}");
            p = next;
        }
        assert!(!lost);
        let corners = [start, DVec2::new(8., 16.), DVec2::new(2., 16.), root];
        let shortest: f64 = corners.windows(2).map(|w| w[0].distance(w[1])).sum();
        assert!(walked < 1.03 * shortest, "{walked} for {shortest}");
    }

    #[test]
    fn a_target_in_sight_is_made_for_straight() {
        let margin = hook();
        let root = DVec2::new(0.5, 0.5);
        let steer = Steer::inside(&margin, &[root]);
        assert_eq!(steer.target(DVec2::new(0.7, 12.0)), Some(root));
        assert_eq!(Steer::plain(&margin, &[root]).target(DVec2::new(11.0, 3.0)), Some(root));
    }
}
