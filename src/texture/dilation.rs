//! Spreads a leaf over the empty texels around it, so that filters and mipmaps find leaf there.
//!
//! The source is the nearest fully covered texel: half-covered ones would smear the fringe. Texels in
//! a row that have their source in common are filled together.

use std::ops::Range;

use super::side::SideMaps;
use super::spans::Spans;
use crate::parallel::for_each_piece;
use crate::raster::distance::{NO_SITE, NearestByRows, runs_of};

/// Empty texels of one row, and where what fills them is found.
#[derive(Debug, Clone, Copy)]
struct Run {
    start: u16,
    end: u16,
    /// Index of the texel, row by row; [`NO_SITE`] where no texel is fully covered.
    source: u32,
}

/// The empty texels of a picture.
#[derive(Debug)]
pub(super) struct Empty {
    size: usize,
    runs: Vec<Run>,
    /// Where the runs of each row begin, and where the last ends.
    rows: Vec<usize>,
    mirrored: bool,
}

/// Fills both sides of a leaf, which cover the same texels, the back mirrored. The front has none outside
/// of `spans`.
pub(super) fn spread(front: &mut SideMaps, back: &mut SideMaps, spans: &Spans) {
    let mut empty = Empty::of(front, spans);
    front.spread(&empty);
    empty.mirrored = true;
    back.spread(&empty);
}

impl Empty {
    fn of(side: &SideMaps, spans: &Spans) -> Self {
        let size = side.size();
        let colours = &side.base_colour;
        let nearest = NearestByRows::of_rows(size, size, |y| {
            let row = colours.row(y);
            runs_of(spans.row(y), |x| row[x][3] == u8::MAX)
        });
        let mut rows = vec![Vec::new(); size];
        nearest.for_each_row(&mut rows, |nearest, found| {
            let (row, span) = (colours.row(nearest.y()), spans.row(nearest.y()));
            let runs = &mut found[0];
            for bare in nearest.gaps() {
                let mut fill = |columns: Range<usize>, source| {
                    let mut put = |gap: Range<usize>| {
                        if !gap.is_empty() {
                            runs.push(Run { start: gap.start as u16, end: gap.end as u16, source });
                        }
                    };
                    put(columns.start..columns.end.min(span.start));
                    let mut rest = columns.start.max(span.start)..columns.end.min(span.end);
                    while let Some(gap) = gap(row, rest.clone()) {
                        rest.start = gap.end;
                        put(gap);
                    }
                    put(columns.start.max(span.end).max(span.start)..columns.end);
                };
                let beside = bare.start.saturating_sub(1)..(bare.end + 1).min(size);
                let mut spread = false;
                nearest.runs(beside, |columns, source| {
                    spread = true;
                    fill(columns.start.max(bare.start)..columns.end.min(bare.end), source);
                });
                if !spread {
                    fill(bare, NO_SITE);
                }
            }
        });
        let starts = std::iter::once(0).chain(rows.iter().scan(0, |sum, row| {
            *sum += row.len();
            Some(*sum)
        }));
        Self { size, rows: starts.collect(), runs: rows.concat(), mirrored: false }
    }

    /// Fills the empty texels of a plane with what `spread` makes of their sources; with `plain` where there is
    /// none.
    pub(super) fn fill<T: Copy + Send + Sync>(
        &self,
        plane: &mut [T],
        plain: T,
        spread: impl Fn(T) -> T + Sync,
    ) {
        if plane.is_empty() {
            return;
        }
        // What is copied is written down first, so that the plane is free to change.
        let mirrored = |i: usize| i - i % self.size + self.size - 1 - i % self.size;
        let source = |run: &Run| {
            if run.source == NO_SITE {
                return plain;
            }
            let i = run.source as usize;
            spread(plane[if self.mirrored { mirrored(i) } else { i }])
        };
        let mut values = vec![plane[0]; self.runs.len()];
        for_each_piece(&mut values, RUNS, &|i, values| {
            for (value, run) in values.iter_mut().zip(&self.runs[i * RUNS..]) {
                *value = source(run);
            }
        });
        for_each_piece(plane, self.size, &|y, row| {
            let of_row = self.rows[y]..self.rows[y + 1];
            for (run, &value) in self.runs[of_row.clone()].iter().zip(&values[of_row]) {
                let (start, end) = (usize::from(run.start), usize::from(run.end));
                let texels =
                    if self.mirrored { self.size - end..self.size - start } else { start..end };
                row[texels].fill(value);
            }
        });
    }
}

/// Runs of which one thread after the other writes down the sources.
const RUNS: usize = 1 << 12;

/// The first texels in a row, within some columns, that are empty.
fn gap(row: &[[u8; 4]], columns: Range<usize>) -> Option<Range<usize>> {
    let texels = row.get(columns.clone())?;
    let start = texels.iter().position(|texel| texel[3] == 0)?;
    let length = texels[start..].iter().position(|texel| texel[3] != 0);
    let end = length.map_or(columns.end, |length| columns.start + start + length);
    Some(columns.start + start..end)
}
