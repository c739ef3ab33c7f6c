//! Rings of cells around one of a grid, for searches that go outwards.

/// Columns and rows of a grid.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Size {
    /// Rings beyond this lie outside the grid, whichever cell they go round.
    pub(super) fn last_ring(self) -> usize {
        self.columns.max(self.rows)
    }

    /// Calls `visit` with the column and the row of every cell of the grid that lies `ring` cells
    /// from one of its cells, by the greater of both ways; ring 0 is the cell itself.
    pub(super) fn for_each_in_ring(
        self,
        (column, row): (usize, usize),
        ring: usize,
        mut visit: impl FnMut(usize, usize),
    ) {
        let (left, right) = (column.saturating_sub(ring), (column + ring).min(self.columns - 1));
        let (below, above) = (row.checked_sub(ring), row + ring);
        if let Some(below) = below {
            (left..=right).for_each(|x| visit(x, below));
        }
        if ring > 0 && above < self.rows {
            (left..=right).for_each(|x| visit(x, above));
        }
        for y in below.map_or(0, |y| y + 1)..above.min(self.rows) {
            if let Some(x) = column.checked_sub(ring) {
                visit(x, y);
            }
            if column + ring < self.columns {
                visit(column + ring, y);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rings_hold_every_cell_once_and_nearer_ones_first() {
        let size = Size { columns: 7, rows: 4 };
        for (column, row) in (0..7).flat_map(|x| (0..4).map(move |y| (x, y))) {
            let mut seen = Vec::new();
            for ring in 0..=size.last_ring() {
                size.for_each_in_ring((column, row), ring, |x, y| {
                    assert_eq!(x.abs_diff(column).max(y.abs_diff(row)), ring);
                    seen.push((x, y));
                });
            }
            seen.sort_unstable();
            let all = (0..7).flat_map(|x| (0..4).map(move |y| (x, y)));
            assert!(seen.into_iter().eq(all), "around {column}, {row}");
        }
    }
}
