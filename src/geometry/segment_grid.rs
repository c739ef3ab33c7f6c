//! Segments that are added one by one: which lie near a place.
//!
//! Dense cells with a linked list each, as [`super::point_grid`] has for points. Every segment is
//! listed in the cells it passes through, so that a long one is found from everywhere along it. The
//! grid knows numbers only; whoever asks knows where the ends are.

use super::paving::Paving;
use super::{DVec2, Rect};
use crate::parallel;

/// End of a list.
const NONE: u32 = u32::MAX;

/// Segments in the cells of a grid, known by the order in which they came.
#[derive(Debug, Clone)]
pub struct SegmentGrid {
    paving: Paving,
    heads: Vec<u32>,
    /// Lists of segments: a number and the next entry.
    entries: Vec<(u32, u32)>,
    len: u32,
}

impl SegmentGrid {
    /// An empty grid over `bounds` with cells of about `cell`; what is outside is kept in the cells at
    /// the border.
    #[must_use]
    pub fn new(bounds: Rect, cell: f64) -> Self {
        Self::over(Paving::new(bounds, cell))
    }

    fn over(paving: Paving) -> Self {
        Self { paving, heads: parallel::filled(paving.len(), NONE), entries: Vec::new(), len: 0 }
    }

    /// Makes room for so many more segments, about as long as a cell.
    pub fn expect(&mut self, more: usize) {
        parallel::make_room(&mut self.entries, 2 * more, (NONE, NONE));
    }

    /// Adds the segment a–b.
    pub fn push(&mut self, a: DVec2, b: DVec2) -> u32 {
        let id = self.len;
        self.len += 1;
        let paving = self.paving;
        let (first, last) = (paving.row(a.y.min(b.y)), paving.row(a.y.max(b.y)));
        for row in first..=last {
            let (low, high) = self.span(a, b, row, first..=last);
            for column in paving.column(low)..=paving.column(high) {
                let head = &mut self.heads[paving.at(column, row)];
                self.entries.push((id, *head));
                *head = self.entries.len() as u32 - 1;
            }
        }
        id
    }

    /// From where to where (x) a segment may run within one of its rows; a little too wide, so that
    /// rounding loses nothing.
    fn span(
        &self,
        a: DVec2,
        b: DVec2,
        row: usize,
        rows: std::ops::RangeInclusive<usize>,
    ) -> (f64, f64) {
        let (low, high) = (a.x.min(b.x), a.x.max(b.x));
        // Rows at the ends may be rows at the border, which reach to infinity.
        if rows.end() - rows.start() < 2 {
            return (low, high);
        }
        let at = |y: f64| a.x + (b.x - a.x) * ((y - a.y) / (b.y - a.y)).clamp(0.0, 1.0);
        let cell = self.paving.cell;
        let bottom = self.paving.bounds.min.y + row as f64 * cell;
        let below = if row == *rows.start() { a.y.min(b.y) } else { bottom };
        let above = if row == *rows.end() { a.y.max(b.y) } else { bottom + cell };
        let (p, q, slack) = (at(below), at(above), 1e-6 * cell);
        ((p.min(q) - slack).max(low), (p.max(q) + slack).min(high))
    }

    /// Makes cells smaller when `cell` is less than half of theirs. `ends` tells where the segments
    /// are.
    pub fn refine(&mut self, cell: f64, ends: impl Fn(u32) -> (DVec2, DVec2)) {
        // Asked in every step: memory for finer cells is taken only where they come.
        let Some(paving) = self.paving.finer(cell) else { return };
        let mut finer = Self::over(paving);
        for id in 0..self.len {
            let (a, b) = ends(id);
            finer.push(a, b);
        }
        *self = finer;
    }

    /// Calls `visit` with every segment in the cells that the box of a–b touches, some more than once.
    pub fn for_each_near(&self, a: DVec2, b: DVec2, mut visit: impl FnMut(u32)) {
        let Self { paving, .. } = self;
        let (first, last) = (paving.column(a.x.min(b.x)), paving.column(a.x.max(b.x)));
        for row in paving.row(a.y.min(b.y))..=paving.row(a.y.max(b.y)) {
            for column in first..=last {
                let mut at = self.heads[paving.at(column, row)];
                while at != NONE {
                    let (id, next) = self.entries[at as usize];
                    visit(id);
                    at = next;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon::segments_touch;
    use crate::seed::{Seed, Stage};

    #[test]
    fn the_grid_finds_whatever_touches() {
        let mut rng = Seed(6).stream(Stage::Tissue);
        let mut grid = SegmentGrid::new(Rect { min: DVec2::ZERO, max: DVec2::ONE }, 0.2);
        let mut segments = Vec::new();
        for i in 0..300 {
            // Some reach beyond the bounds.
            let a = DVec2::new(rng.between(-0.1, 1.1), rng.between(-0.1, 1.1));
            let length = if i % 10 == 0 { 1.0 } else { 0.05 };
            let towards = DVec2::new(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0));
            segments.push((a, a + towards * length));
            grid.push(a, a + towards * length);
            if i == 150 {
                grid.refine(0.04, |id| segments[id as usize]);
            }
        }
        for _ in 0..500 {
            let p = DVec2::new(rng.unit(), rng.unit());
            let q = p + DVec2::new(rng.between(-0.1, 0.1), rng.between(-0.1, 0.1));
            let touches = |id: u32| {
                let (a, b) = segments[id as usize];
                segments_touch(p, q, a, b)
            };
            let mut found = Vec::new();
            grid.for_each_near(p, q, |id| found.extend(touches(id).then_some(id)));
            found.sort_unstable();
            found.dedup();
            assert_eq!(found, (0..300).filter(|&id| touches(id)).collect::<Vec<_>>());
        }
    }
}
