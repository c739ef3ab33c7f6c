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
}

/// The empty texels of one side.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground<'a> {
    empty: &'a Empty,
    mirrored: bool,
}

impl Empty {
    /// Those of a front, which covers none outside of `spans`.
    pub(super) fn of(front: &SideMaps, spans: &Spans) -> Self {
        let size = front.size();
        let colours = &front.base_colour;
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
        Self { size, rows: starts.collect(), runs: rows.concat() }
    }

    /// Fills both sides of a leaf, which cover the same texels, the back mirrored.
    pub(super) fn spread(&self, front: &mut SideMaps, back: &mut SideMaps) {
        front.spread(Ground { empty: self, mirrored: false });
        back.spread(Ground { empty: self, mirrored: true });
    }
}

impl Ground<'_> {
    /// Fills the empty texels of a plane with what `spread` makes of their sources; with `plain` where there is
    /// none.
    pub(super) fn fill<T: Copy + Send + Sync>(
        self,
        plane: &mut [T],
        plain: T,
        spread: impl Fn(T) -> T + Sync,
    ) {
        if plane.is_empty() {
            return;
        }
        let Empty { size, runs, rows } = self.empty;
        // What is copied is written down first, so that the plane is free to change.
        let mirrored = |i: usize| i - i % size + size - 1 - i % size;
        let source = |run: &Run| {
            if run.source == NO_SITE {
                return plain;
            }
            let i = run.source as usize;
            spread(plane[if self.mirrored { mirrored(i) } else { i }])
        };
        let mut values = vec![plain; runs.len()];
        for_each_piece(&mut values, RUNS, &|i, values| {
            for (value, run) in values.iter_mut().zip(&runs[i * RUNS..]) {
                *value = source(run);
            }
        });
        for_each_piece(plane, *size, &|y, row| {
            let of_row = rows[y]..rows[y + 1];
            for (run, &value) in runs[of_row.clone()].iter().zip(&values[of_row]) {
                let (start, end) = (usize::from(run.start), usize::from(run.end));
                let texels = if self.mirrored { size - end..size - start } else { start..end };
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
