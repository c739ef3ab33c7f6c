//! Points that are added one by one: what lies near a place, and what is nearest to it.
//!
//! Dense cells with a linked list each. Not kiddo's mutable tree, which refuses ordinary leaf data
//! (33 points on one straight midrib do not fit in a bucket) and takes 20–190 µs to add a point to a
//! long chain of nodes; here it is 0.03 µs whatever the order. The grid knows numbers only; whoever asks
//! knows where the points are, so that what is kept of them elsewhere stands in memory once.

use super::paving::Paving;
use super::{DVec2, Rect};
use crate::parallel;

/// End of a list.
const NONE: u32 = u32::MAX;

/// Up to this many points looking at each is quicker than walking rings of empty cells.
const FEW: usize = 24;

/// Points in the cells of a grid, known by the order in which they came.
#[derive(Debug, Clone)]
pub struct PointGrid {
    paving: Paving,
    heads: Vec<u32>,
    nexts: Vec<u32>,
    removed: usize,
}

/// The nearest point of a [`PointGrid`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Which point; the first among equals.
    pub id: u32,
    /// Its squared distance.
    pub distance2: f64,
    /// No other point is nearer than this (squared).
    pub others2: f64,
}

impl PointGrid {
    /// An empty grid over `bounds` with cells of about `cell`; points outside are kept in the cells
    /// at the border.
    #[must_use]
    pub fn new(bounds: Rect, cell: f64) -> Self {
        Self::over(Paving::new(bounds, cell))
    }

    fn over(paving: Paving) -> Self {
        Self { paving, heads: parallel::filled(paving.len(), NONE), nexts: Vec::new(), removed: 0 }
    }

    /// Number of points ever added.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nexts.len()
    }

    /// Whether no point was ever added.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nexts.is_empty()
    }

    /// Makes room for so many more points.
    pub fn expect(&mut self, more: usize) {
        parallel::make_room(&mut self.nexts, more, NONE);
    }

    /// Adds a point.
    pub fn push(&mut self, p: DVec2) -> u32 {
        let id = self.nexts.len() as u32;
        let home = self.paving.home(p);
        self.nexts.push(self.heads[home]);
        self.heads[home] = id;
        id
    }

    /// Takes the point at `p` out of every later search; its number stays taken.
    pub fn remove(&mut self, id: u32, p: DVec2) {
        let home = self.paving.home(p);
        let after = self.nexts[id as usize];
        if self.heads[home] == id {
            self.heads[home] = after;
            self.removed += 1;
            return;
        }
        let mut at = self.heads[home];
        while at != NONE {
            let next = self.nexts[at as usize];
            if next == id {
                self.nexts[at as usize] = after;
                self.removed += 1;
                return;
            }
            at = next;
        }
    }

    /// Makes cells smaller when `cell` is less than half of theirs, so that searches which shrink
    /// with a growing leaf stay short.
    pub fn refine(&mut self, cell: f64, points: &[DVec2]) {
        // Asked in every step: memory for finer cells is taken only where they come.
        let Some(paving) = self.paving.finer(cell) else { return };
        let mut finer = Self::over(paving);
        let mut present = vec![false; self.len()];
        for cell in 0..self.heads.len() {
            self.list(cell).for_each(|id| present[id as usize] = true);
        }
        finer.nexts = vec![NONE; self.len()];
        finer.removed = self.removed;
        for id in (0..self.len()).filter(|&id| present[id]) {
            let home = finer.paving.home(points[id]);
            finer.nexts[id] = finer.heads[home];
            finer.heads[home] = id as u32;
        }
        *self = finer;
    }

    fn list(&self, cell: usize) -> impl Iterator<Item = u32> + '_ {
        let entry = |id: u32| (id != NONE).then_some(id);
        std::iter::successors(entry(self.heads[cell]), move |&id| entry(self.nexts[id as usize]))
    }

    /// Whether `test` holds for a point in the cells that the box of half size `half` around `p`
    /// touches.
    pub fn any_near(
        &self,
        points: &[DVec2],
        p: DVec2,
        half: DVec2,
        mut test: impl FnMut(u32, DVec2) -> bool,
    ) -> bool {
        let Self { paving, .. } = self;
        let (first, last) = (paving.column(p.x - half.x), paving.column(p.x + half.x));
        for row in paving.row(p.y - half.y)..=paving.row(p.y + half.y) {
            for column in first..=last {
                let mut id = self.heads[paving.at(column, row)];
                while id != NONE {
                    if test(id, points[id as usize]) {
                        return true;
                    }
                    id = self.nexts[id as usize];
                }
            }
        }
        false
    }

    /// Calls `visit` with points from near to far, by rings of cells around `p`, for as long as
    /// `more` says that points farther than a distance (in the grid's own frame) still matter.
    pub fn for_each_outwards<T>(
        &self,
        points: &[DVec2],
        state: &mut T,
        p: DVec2,
        mut more: impl FnMut(&mut T, f64) -> bool,
        mut visit: impl FnMut(&mut T, u32, DVec2),
    ) {
        if self.len() <= FEW && self.removed == 0 {
            for (id, &q) in points[..self.len()].iter().enumerate() {
                visit(state, id as u32, q);
            }
            return;
        }
        let Self { paving, .. } = self;
        let size = paving.size;
        let centre = (paving.column(p.x), paving.row(p.y));
        for ring in 0..=size.last_ring() {
            if ring > 0 && !more(state, (ring - 1) as f64 * paving.cell) {
                return;
            }
            size.for_each_in_ring(centre, ring, |column, row| {
                for id in self.list(paving.at(column, row)) {
                    visit(state, id, points[id as usize]);
                }
            });
        }
    }

    /// The point nearest to `p` within a squared distance of `limit2` (included), where distances
    /// are |(a − b)·stretch|.
    #[must_use]
    pub fn nearest(
        &self,
        points: &[DVec2],
        p: DVec2,
        stretch: DVec2,
        limit2: f64,
    ) -> Option<Nearest> {
        let mut best = Nearest { id: NONE, distance2: limit2, others2: limit2 };
        let least = stretch.min_element();
        self.for_each_outwards(
            points,
            &mut best,
            p,
            |best, clear| (clear * least) * (clear * least) <= best.others2,
            |best, id, q| {
                let distance2 = ((p - q) * stretch).length_squared();
                if distance2 < best.distance2 || (distance2 == best.distance2 && id < best.id) {
                    *best = Nearest { id, distance2, others2: best.distance2 };
                } else if distance2 < best.others2 {
                    best.others2 = distance2;
                }
            },
        );
        (best.id != NONE).then_some(best)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn the_grid_agrees_with_looking_at_every_point() {
        let mut rng = Seed(4).stream(Stage::Tissue);
        let mut grid = PointGrid::new(Rect { min: DVec2::ZERO, max: DVec2::ONE }, 0.3);
        let mut present = vec![true; 400];
        let mut points = Vec::new();
        for i in 0..400_u32 {
            points.push(DVec2::new(rng.unit(), rng.unit() * rng.unit()));
            grid.push(points[i as usize]);
            if i % 5 == 4 {
                grid.remove(i - 2, points[i as usize - 2]);
                present[i as usize - 2] = false;
            }
            if i == 200 {
                grid.refine(0.05, &points);
            }
        }
        for stretch in [DVec2::ONE, DVec2::new(0.4, 1.0)] {
            for _ in 0..300 {
                let p = DVec2::new(rng.unit(), rng.unit());
                let limit2 = rng.unit() * 0.1;
                let mut all: Vec<(f64, u32)> = (0..400u32)
                    .filter(|&i| present[i as usize])
                    .map(|i| (((p - points[i as usize]) * stretch).length_squared(), i))
                    .filter(|&(d2, _)| d2 <= limit2)
                    .collect();
                all.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
                let found = grid.nearest(&points, p, stretch, limit2);
                assert_eq!(found.map(|n| (n.distance2, n.id)), all.first().copied());
                if let Some(found) = found {
                    let second = all.get(1).map_or(limit2, |other| other.0);
                    assert!(found.others2 <= second && found.others2 >= found.distance2);
                }
                let radius = 0.1;
                let near = |i: u32| present[i as usize] && p.distance(points[i as usize]) <= radius;
                let any =
                    grid.any_near(&points, p, DVec2::splat(radius), |_, q| p.distance(q) <= radius);
                assert_eq!(any, (0..400).any(near));
            }
        }
    }
}
