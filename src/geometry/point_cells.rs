//! Points that all move in every step: what is nearest to each, what lies near a place.
//!
//! A counting sort into the cells of a uniform grid, made anew in every step: 13–56 ns a point, where
//! a tree takes 45–210. Cells hold about one point each, however few are left.

use super::{DVec2, Rect};

/// Points sorted by cell.
#[derive(Debug, Clone, Default)]
pub struct PointCells {
    min: DVec2,
    cell: f64,
    columns: usize,
    rows: usize,
    /// Where the list of each cell starts in `items`.
    starts: Vec<u32>,
    /// Points by cell, ascending in each.
    items: Vec<(DVec2, u32)>,
    homes: Vec<u32>,
}

impl PointCells {
    /// Sorts the points into cells at least `least` wide. Reuses its memory.
    pub fn rebuild(&mut self, points: &[DVec2], least: f64) {
        let bounds = Rect::around(points.iter().copied());
        let size = if points.is_empty() { DVec2::ZERO } else { bounds.size() };
        let n = points.len().max(1) as f64;
        // One point a cell; no more cells than points along a line either.
        let even = (size.x * size.y / n).sqrt().max(size.max_element() / n);
        self.cell = even.max(least).max(f64::MIN_POSITIVE);
        self.min = if points.is_empty() { DVec2::ZERO } else { bounds.min };
        self.columns = (size.x / self.cell) as usize + 1;
        self.rows = (size.y / self.cell) as usize + 1;
        self.starts.clear();
        self.starts.resize(self.columns * self.rows + 1, 0);
        self.homes.clear();
        for &p in points {
            let home = self.row(p.y) * self.columns + self.column(p.x);
            self.homes.push(home as u32);
            self.starts[home] += 1;
        }
        // From counts to ends; filling from the back turns ends into starts.
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        self.items.clear();
        self.items.resize(points.len(), (DVec2::ZERO, 0));
        for (i, &p) in points.iter().enumerate().rev() {
            let slot = &mut self.starts[self.homes[i] as usize];
            *slot -= 1;
            self.items[*slot as usize] = (p, i as u32);
        }
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.min.x) / self.cell).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.min.y) / self.cell).max(0.0) as usize).min(self.rows - 1)
    }

    /// The points in the cells of one row, from column to column.
    fn strip(&self, row: usize, first: usize, last: usize) -> &[(DVec2, u32)] {
        let at = row * self.columns;
        &self.items[self.starts[at + first] as usize..self.starts[at + last + 1] as usize]
    }

    /// The point nearest to the one at `p` with the number `own`; among equals that with the least
    /// `rank`, then the lowest number. Two rings of cells mostly; a lone point far from the others costs
    /// as much as looking at all.
    #[must_use]
    pub fn nearest_other(&self, p: DVec2, own: u32, rank: impl Fn(u32) -> f64) -> Option<u32> {
        let (column, row) = (self.column(p.x) as isize, self.row(p.y) as isize);
        let (columns, rows) = (self.columns as isize, self.rows as isize);
        let mut best = (f64::INFINITY, u32::MAX);
        let mut visit = |row: isize, first: isize, last: isize| {
            let (first, last) = (first.max(0), last.min(columns - 1));
            if row < 0 || row >= rows || first > last {
                return best.0;
            }
            for &(q, id) in self.strip(row as usize, first as usize, last as usize) {
                let distance2 = p.distance_squared(q);
                let comes_before = |other| (rank(id), id) < (rank(other), other);
                if id != own
                    && (distance2 < best.0 || (distance2 == best.0 && comes_before(best.1)))
                {
                    best = (distance2, id);
                }
            }
            best.0
        };
        for ring in 0..=columns.max(rows) {
            let (left, right) = (column - ring, column + ring);
            let mut nearest2 = visit(row - ring, left, right);
            if ring > 0 {
                nearest2 = visit(row + ring, left, right);
            }
            for y in row - ring + 1..row + ring {
                visit(y, left, left);
                nearest2 = visit(y, right, right);
            }
            // All of the next ring is farther than this; less a little, for rounding at the sides.
            let clear = ring as f64 * self.cell * (1.0 - 1e-9);
            if nearest2 < clear * clear {
                break;
            }
        }
        (best.1 != u32::MAX).then_some(best.1)
    }

    /// Calls `visit` with every point sorted into a cell that the circle's box touches.
    pub fn for_each_near(&self, p: DVec2, radius: f64, mut visit: impl FnMut(u32)) {
        let (first, last) = (self.column(p.x - radius), self.column(p.x + radius));
        for row in self.row(p.y - radius)..=self.row(p.y + radius) {
            self.strip(row, first, last).iter().for_each(|&(_, id)| visit(id));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn the_cells_agree_with_looking_at_every_point() {
        let mut rng = Seed(4).stream(Stage::Tissue);
        let mut cells = PointCells::default();
        for n in [1usize, 2, 3, 40, 500] {
            // A cloud, a line with a point far off, and a lattice full of ties.
            let cloud = (0..n).map(|_| DVec2::new(rng.unit(), 3.0 * rng.unit())).collect();
            let line = (0..n).map(|i| DVec2::new((i * i) as f64, 0.0)).collect();
            let lattice = (0..n).map(|i| DVec2::new((i % 7) as f64, (i / 7) as f64)).collect();
            for points in [cloud, line, lattice] {
                let points: Vec<DVec2> = points;
                cells.rebuild(&points, 0.01);
                for (i, &p) in points.iter().enumerate() {
                    let rank = |j: u32| f64::from(j % 5);
                    let nearest = (0..n)
                        .filter(|&j| j != i)
                        .map(|j| (p.distance_squared(points[j]), rank(j as u32), j as u32))
                        .reduce(|a, b| if b < a { b } else { a });
                    let found = cells.nearest_other(p, i as u32, rank);
                    assert_eq!(found, nearest.map(|(_, _, j)| j));
                    let mut near = Vec::new();
                    cells.for_each_near(p, 0.2, |j| near.push(j));
                    let within = |j: &u32| points[*j as usize].distance(p) <= 0.2;
                    assert!((0..n as u32).filter(within).all(|j| near.contains(&j)));
                }
            }
        }
    }
}
