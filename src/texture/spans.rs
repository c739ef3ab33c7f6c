//! Where in each row of a side something was painted: what comes after looks nowhere else.

use std::ops::Range;

/// In each row the columns from the first to the last that may hold leaf.
#[derive(Debug, Clone)]
pub(super) struct Spans(Vec<Range<usize>>);

impl Spans {
    /// Those of all rows from the top.
    pub(super) fn of(rows: Vec<Range<usize>>) -> Self {
        Self(rows)
    }

    /// All columns of a square.
    pub(super) fn whole(size: usize) -> Self {
        Self(vec![0..size; size])
    }

    /// The columns of a row.
    #[inline]
    pub(super) fn row(&self, y: usize) -> Range<usize> {
        self.0[y].clone()
    }

    /// Of the same square seen from behind.
    pub(super) fn mirrored(&self) -> Self {
        let size = self.0.len();
        let mirrored = |row: &Range<usize>| match row.is_empty() {
            true => 0..0,
            false => size - row.end..size - row.start,
        };
        Self(self.0.iter().map(mirrored).collect())
    }
}
