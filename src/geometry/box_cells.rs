//! A static index over boxes: which meet another box.
//!
//! Boxes are listed in every cell of a uniform grid that they touch, as single-precision copies a little
//! too large, so that most of what is far is passed over in a walk through memory. What is found is to
//! be looked at exactly.

use super::{DVec2, Rect};

/// More cells than this buy nothing and cost memory.
const MAX_CELLS: f64 = 4e6;

/// Single precision rounds to less than this share of the whole.
const SLACK: f64 = 1.0 / (1 << 22) as f64;

/// A box relative to the corner of the grid, and whose it is.
#[derive(Debug, Clone, Copy, Default)]
struct Item {
    low: [f32; 2],
    high: [f32; 2],
    id: u32,
}

impl Item {
    #[inline]
    fn meets(&self, other: &Self) -> bool {
        (self.low[0] <= other.high[0])
            & (self.high[0] >= other.low[0])
            & (self.low[1] <= other.high[1])
            & (self.high[1] >= other.low[1])
    }
}

/// Boxes in the cells of a grid, known by their order.
#[derive(Debug, Clone)]
pub struct BoxCells {
    min: DVec2,
    slack: f64,
    per_cell: f32,
    columns: usize,
    rows: usize,
    /// Where the list of each cell starts in `items`.
    starts: Vec<u32>,
    items: Vec<Item>,
}

impl BoxCells {
    /// Over any boxes, in cells of about `cell`; what lies outside `bounds` is kept in the cells at the
    /// border.
    #[must_use]
    pub fn new(bounds: Rect, cell: f64, boxes: impl Iterator<Item = Rect> + Clone) -> Self {
        let size = bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let cell = bounds.cell_width(cell, MAX_CELLS);
        let count = |length: f64| (length / cell) as usize + 1;
        let mut cells = Self {
            min: bounds.min,
            slack: size.max_element() * SLACK,
            per_cell: (1.0 / cell) as f32,
            columns: count(size.x),
            rows: count(size.y),
            starts: Vec::new(),
            items: Vec::new(),
        };
        cells.fill(boxes);
        cells
    }

    fn fill(&mut self, boxes: impl Iterator<Item = Rect> + Clone) {
        // Counts, then ends, which filling from the back turns into starts.
        let mut starts = vec![0u32; self.columns * self.rows + 1];
        for rect in boxes.clone() {
            self.for_each_cell(self.item(rect, 0), |cell| starts[cell] += 1);
        }
        let mut end = 0;
        for start in &mut starts {
            end += *start;
            *start = end;
        }
        let mut items = vec![Item::default(); end as usize];
        for (id, rect) in (0..).zip(boxes) {
            let item = self.item(rect, id);
            self.for_each_cell(item, |cell| {
                let place = &mut starts[cell];
                *place -= 1;
                items[*place as usize] = item;
            });
        }
        (self.starts, self.items) = (starts, items);
    }

    #[inline]
    fn item(&self, rect: Rect, id: u32) -> Item {
        let (low, high) = (rect.min - self.min - self.slack, rect.max - self.min + self.slack);
        Item { low: [low.x as f32, low.y as f32], high: [high.x as f32, high.y as f32], id }
    }

    #[inline]
    fn column(&self, x: f32) -> usize {
        ((x * self.per_cell).max(0.0) as usize).min(self.columns - 1)
    }

    #[inline]
    fn row(&self, y: f32) -> usize {
        ((y * self.per_cell).max(0.0) as usize).min(self.rows - 1)
    }

    /// The cells that a box touches.
    fn for_each_cell(&self, Item { low, high, .. }: Item, mut each: impl FnMut(usize)) {
        let (left, right) = (self.column(low[0]), self.column(high[0]));
        for row in self.row(low[1])..=self.row(high[1]) {
            for column in left..=right {
                each(row * self.columns + column);
            }
        }
    }

    /// Calls `visit` once with every two boxes that meet, and with some that nearly do.
    pub fn for_each_pair(&self, mut visit: impl FnMut(u32, u32)) {
        for cell in 0..self.columns * self.rows {
            let (row, column) = (cell / self.columns, cell % self.columns);
            let here = &self.items[self.starts[cell] as usize..self.starts[cell + 1] as usize];
            for (i, a) in here.iter().enumerate() {
                for b in &here[i + 1..] {
                    // Two that meet in several cells are told of in the first.
                    if a.meets(b)
                        && self.column(a.low[0].max(b.low[0])) == column
                        && self.row(a.low[1].max(b.low[1])) == row
                    {
                        visit(a.id, b.id);
                    }
                }
            }
        }
    }

    /// Calls `visit` once with every box that meets `rect`, and with some that nearly do.
    pub fn for_each_meeting(&self, rect: Rect, mut visit: impl FnMut(u32)) {
        let asked = self.item(rect, 0);
        let (left, right) = (self.column(asked.low[0]), self.column(asked.high[0]));
        let (below, above) = (self.row(asked.low[1]), self.row(asked.high[1]));
        for row in below..=above {
            for column in left..=right {
                let cell = row * self.columns + column;
                let run = self.starts[cell] as usize..self.starts[cell + 1] as usize;
                for item in &self.items[run] {
                    // One that stands in several of the cells is told of in the first.
                    if item.meets(&asked)
                        && self.column(item.low[0]).max(left) == column
                        && self.row(item.low[1]).max(below) == row
                    {
                        visit(item.id);
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn a_single_point_and_a_line_take_few_cells() {
        let cells = |size: DVec2| {
            let bounds = Rect { min: DVec2::ONE, max: DVec2::ONE + size };
            let cells = BoxCells::new(bounds, 0.0, std::iter::once(bounds));
            let mut met = 0;
            cells.for_each_meeting(bounds, |_| met += 1);
            assert_eq!(met, 1);
            cells.columns * cells.rows
        };
        assert_eq!(cells(DVec2::ZERO), 1);
        assert!(cells(DVec2::Y) as f64 <= MAX_CELLS + 1.0);
    }

    #[test]
    fn the_cells_find_every_box_that_meets_once() {
        let mut rng = Seed(8).stream(Stage::Tissue);
        let mut drawn = |size: f64| {
            let min = DVec2::new(rng.between(-0.2, 1.1), rng.between(-0.2, 1.1));
            Rect { min, max: min + DVec2::new(rng.unit(), rng.unit()) * size }
        };
        let boxes: Vec<Rect> =
            (0..400).map(|i| drawn(if i % 20 == 0 { 0.7 } else { 0.05 })).collect();
        let bounds = Rect { min: DVec2::ZERO, max: DVec2::ONE };
        for cell in [0.03, 0.2, 5.0] {
            let cells = BoxCells::new(bounds, cell, boxes.iter().copied());
            for asked in (0..300).map(|_| drawn(0.1)) {
                let mut found = Vec::new();
                cells.for_each_meeting(asked, |id| found.push(id));
                found.sort_unstable();
                assert!(found.windows(2).all(|pair| pair[0] < pair[1]), "one told of twice");
                let all = (0..).zip(&boxes);
                let sure: Vec<u32> =
                    all.filter(|(_, other)| other.meets(asked)).map(|(id, _)| id).collect();
                assert!(sure.iter().all(|id| found.contains(id)));
                assert!(found.iter().all(|&id| boxes[id as usize].meets(asked.grown(1e-5))));
            }
            let mut pairs = Vec::new();
            cells.for_each_pair(|a, b| pairs.push((a.min(b), a.max(b))));
            pairs.sort_unstable();
            assert!(pairs.windows(2).all(|two| two[0] < two[1]), "a pair told of twice");
            let all = (0..400u32).flat_map(|a| (a + 1..400).map(move |b| (a, b)));
            let sure: Vec<(u32, u32)> =
                all.filter(|&(a, b)| boxes[a as usize].meets(boxes[b as usize])).collect();
            assert!(sure.iter().all(|pair| pairs.binary_search(pair).is_ok()));
            assert!(pairs.len() <= sure.len() + 3, "{} {}", pairs.len(), sure.len());
        }
    }
}
