//! Where in the field which sources stand.

use glam::DVec2;

use super::NONE;
use crate::geometry::Rect;

/// Square cells over the blade: the slots that were sorted into each, and the newborn after them.
#[derive(Debug)]
pub(super) struct Cells {
    pub(super) min: DVec2,
    pub(super) width: f64,
    per_width: f64,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// Where the run of each cell starts.
    starts: Vec<u32>,
    /// The last newborn of each cell.
    heads: Vec<u32>,
    /// For each newborn, the one before it in its cell.
    nexts: Vec<u32>,
}

impl Cells {
    pub(super) fn new(bounds: Rect, width: f64) -> Self {
        let size = bounds.size();
        let per_width = 1.0 / width;
        let (columns, rows) =
            ((size.x * per_width) as usize + 1, (size.y * per_width) as usize + 1);
        Self {
            min: bounds.min,
            width,
            per_width,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            heads: vec![NONE; columns * rows],
            nexts: Vec::new(),
        }
    }

    pub(super) fn column(&self, x: f64) -> usize {
        (((x - self.min.x) * self.per_width).max(0.0) as usize).min(self.columns - 1)
    }

    pub(super) fn row(&self, y: f64) -> usize {
        (((y - self.min.y) * self.per_width).max(0.0) as usize).min(self.rows - 1)
    }

    fn home(&self, p: DVec2) -> usize {
        self.row(p.y) * self.columns + self.column(p.x)
    }

    /// Adds a newborn.
    pub(super) fn add(&mut self, p: DVec2) {
        let home = self.home(p);
        self.nexts.push(self.heads[home]);
        self.heads[home] = self.nexts.len() as u32 - 1;
    }

    pub(super) fn newborn(&self) -> usize {
        self.nexts.len()
    }

    /// Sorts slots into the cells; the order in which they are to stand.
    pub(super) fn sort(&mut self, slots: &[u32], places: &[DVec2]) -> Vec<u32> {
        let homes: Vec<u32> =
            slots.iter().map(|&slot| self.home(places[slot as usize]) as u32).collect();
        for &home in &homes {
            self.starts[home as usize] += 1;
        }
        // From counts to ends; filling from the back turns ends into starts.
        let mut end = 0;
        for start in &mut self.starts {
            end += *start;
            *start = end;
        }
        let mut order = vec![0; slots.len()];
        for (&slot, &home) in slots.iter().zip(&homes).rev() {
            let start = &mut self.starts[home as usize];
            *start -= 1;
            order[*start as usize] = slot;
        }
        order
    }

    /// The first slot sorted into a row, or after the last row that of the newborn.
    pub(super) fn first_of(&self, row: usize) -> usize {
        self.starts[row * self.columns] as usize
    }

    /// The slots sorted into the cells of a row, from column to column.
    pub(super) fn run(&self, row: usize, first: usize, last: usize) -> std::ops::Range<usize> {
        let at = row * self.columns;
        self.starts[at + first] as usize..self.starts[at + last + 1] as usize
    }

    /// The slots of the newborn in a cell.
    pub(super) fn newborn_in(&self, row: usize, column: usize) -> impl Iterator<Item = usize> + '_ {
        let sorted = self.starts[self.columns * self.rows] as usize;
        let entry = |at: u32| (at != NONE).then_some(at);
        let head = entry(self.heads[row * self.columns + column]);
        std::iter::successors(head, move |&at| entry(self.nexts[at as usize]))
            .map(move |at| sorted + at as usize)
    }
}
