//! A box paved with square cells: which cell a place lies in.

use super::rings::Size;
use super::{DVec2, Rect};

/// More cells than this cost memory and time to clear; cells get wider instead.
const MAX_CELLS: f64 = 4e6;

/// Columns and rows of cells over a box. What is outside lies in the cells at the border.
#[derive(Debug, Clone, Copy)]
pub(super) struct Paving {
    pub(super) bounds: Rect,
    /// Width of a cell.
    pub(super) cell: f64,
    per_cell: f64,
    pub(super) size: Size,
}

impl Paving {
    /// Cells of about `cell` over `bounds`.
    pub(super) fn new(bounds: Rect, cell: f64) -> Self {
        let size = bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let cell = bounds.cell_width(cell, MAX_CELLS);
        let count = |length: f64| (length / cell) as usize + 1;
        let size = Size { columns: count(size.x), rows: count(size.y) };
        Self { bounds, cell, per_cell: 1.0 / cell, size }
    }

    /// Cells of about `cell` over the same box, when that is less than half of their width now.
    pub(super) fn finer(&self, cell: f64) -> Option<Self> {
        let is_allowed = self.bounds.cell_width(cell, MAX_CELLS) * 2.0 <= self.cell;
        (is_allowed && cell * 2.0 < self.cell).then(|| Self::new(self.bounds, cell))
    }

    /// Number of cells.
    pub(super) fn len(&self) -> usize {
        self.size.columns * self.size.rows
    }

    #[inline]
    pub(super) fn column(&self, x: f64) -> usize {
        (((x - self.bounds.min.x) * self.per_cell).max(0.0) as usize).min(self.size.columns - 1)
    }

    #[inline]
    pub(super) fn row(&self, y: f64) -> usize {
        (((y - self.bounds.min.y) * self.per_cell).max(0.0) as usize).min(self.size.rows - 1)
    }

    /// The number of a cell.
    #[inline]
    pub(super) fn at(&self, column: usize, row: usize) -> usize {
        row * self.size.columns + column
    }

    /// The number of the cell that a place lies in.
    #[inline]
    pub(super) fn home(&self, p: DVec2) -> usize {
        self.at(self.column(p.x), self.row(p.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_outside_lies_at_the_border() {
        let paving = Paving::new(Rect { min: DVec2::ZERO, max: DVec2::new(2.0, 1.0) }, 0.5);
        assert_eq!((paving.size.columns, paving.size.rows, paving.len()), (5, 3, 15));
        assert_eq!(paving.home(DVec2::new(0.6, 0.2)), 1);
        assert_eq!(paving.home(DVec2::splat(-9.0)), 0);
        assert_eq!(paving.home(DVec2::splat(9.0)), 14);
    }

    #[test]
    fn cells_get_finer_by_half_or_more_and_never_too_many() {
        let paving = Paving::new(Rect { min: DVec2::ZERO, max: DVec2::ONE }, 0.1);
        assert!(paving.finer(0.06).is_none() && paving.finer(0.05).is_none());
        assert_eq!(paving.finer(0.04).expect("less than half").size.columns, 26);
        let finest = paving.finer(1e-9).expect("finer").len() as f64;
        assert!(finest < 1.01 * MAX_CELLS, "{finest}");
    }
}
