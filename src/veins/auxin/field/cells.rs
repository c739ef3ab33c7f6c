//! Where in the field which sources stand.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::NONE;
use crate::geometry::Rect;

/// Square cells over the blade, in bands of columns and there row by row: the slots that were sorted into
/// each, and the newborn after them.
///
/// One thread wants one band, because veins mostly grow across and what is beside lies together. Several
/// want one each: what a thread has written it finds in its own cache again.
#[derive(Debug)]
pub(super) struct Cells {
    pub(super) min: DVec2,
    pub(super) width: f64,
    per_width: f64,
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The first column of each band, and where the last ends.
    bands: Vec<usize>,
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
            bands: vec![0, columns],
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
        self.cell(self.row(p.y), self.column(p.x))
    }

    /// The place of a cell among all.
    fn cell(&self, row: usize, column: usize) -> usize {
        let columns = self.band(self.band_with(column));
        self.rows * columns.start + row * columns.len() + column - columns.start
    }

    fn band_with(&self, column: usize) -> usize {
        self.bands[1..].partition_point(|&end| end <= column)
    }

    /// The band that a place lies in.
    pub(super) fn band_of(&self, p: DVec2) -> usize {
        self.band_with(self.column(p.x))
    }

    /// The columns of a band.
    pub(super) fn band(&self, band: usize) -> Range<usize> {
        self.bands[band]..self.bands[band + 1]
    }

    pub(super) fn bands(&self) -> usize {
        self.bands.len() - 1
    }

    /// Makes so many bands, or as many as there are columns, with as many of the slots in each.
    fn cut(&mut self, bands: usize, slots: &[u32], place: impl Fn(u32) -> DVec2) {
        let mut upto = vec![0; self.columns];
        for &slot in slots {
            upto[self.column(place(slot).x)] += 1;
        }
        let mut sum = 0;
        for count in &mut upto {
            sum += *count;
            *count = sum;
        }
        self.bands.clear();
        self.bands.push(0);
        for band in 1..bands {
            let even = upto.partition_point(|&slots| slots < band * sum / bands) + 1;
            let last = self.bands.last().copied().unwrap_or_default();
            self.bands.extend((last < even && even < self.columns).then_some(even));
        }
        self.bands.push(self.columns);
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

    /// Sorts slots into the cells of so many bands; the order in which they are to stand.
    pub(super) fn sort(
        &mut self,
        bands: usize,
        slots: &[u32],
        place: impl Fn(u32) -> DVec2 + Sync,
    ) -> Vec<u32> {
        if bands > 1 {
            self.cut(bands, slots, &place);
        }
        let homes: Vec<u32> = slots.par_iter().map(|&slot| self.home(place(slot)) as u32).collect();
        // Each band by one thread, which looks through all for its own.
        let is_own = |home: u32, cells: &Range<usize>| cells.contains(&(home as usize));
        let bounds: Vec<usize> = self.bands.iter().map(|&column| self.rows * column).collect();
        let mut starts = pieces(&mut self.starts, bounds.windows(2).map(|ends| ends[1] - ends[0]));
        let bands = starts.par_iter_mut().zip(bounds.par_windows(2));
        let count = |(starts, ends): (&mut &mut [u32], &[usize])| {
            let (cells, mut sum) = (ends[0]..ends[1], 0);
            for &home in homes.iter().filter(|&&home| is_own(home, &cells)) {
                starts[home as usize - cells.start] += 1;
                sum += 1;
            }
            sum
        };
        let sums: Vec<usize> = bands.map(count).collect();
        let mut order = vec![0; slots.len()];
        let orders = pieces(&mut order, sums.iter().copied());
        let firsts: Vec<usize> = (0..sums.len()).map(|band| sums[..band].iter().sum()).collect();
        let bands = starts.into_par_iter().zip(bounds.par_windows(2));
        bands.zip(orders).zip(firsts).for_each(|(((starts, ends), order), first)| {
            let (cells, first) = (ends[0]..ends[1], first as u32);
            // From counts to ends; filling from the back turns ends into starts.
            let mut end = first;
            for start in starts.iter_mut() {
                end += *start;
                *start = end;
            }
            let own = slots.iter().zip(&homes).rev().filter(|&(_, &home)| is_own(home, &cells));
            for (&slot, &home) in own {
                let start = &mut starts[home as usize - cells.start];
                *start -= 1;
                order[(*start - first) as usize] = slot;
            }
        });
        if let Some(end) = self.starts.last_mut() {
            *end = slots.len() as u32;
        }
        order
    }

    /// The slots sorted into a band.
    pub(super) fn slots_of(&self, band: usize) -> Range<usize> {
        let columns = self.band(band);
        let start = |column: usize| self.starts[self.rows * column] as usize;
        start(columns.start)..start(columns.end)
    }

    /// The slots sorted into the cells of a row, from column to column of one band.
    pub(super) fn run(&self, row: usize, first: usize, last: usize) -> Range<usize> {
        let first_cell = self.cell(row, first);
        self.starts[first_cell] as usize..self.starts[first_cell + last - first + 1] as usize
    }

    /// The slots of the newborn in a cell.
    pub(super) fn newborn_in(&self, row: usize, column: usize) -> impl Iterator<Item = usize> + '_ {
        let sorted = self.starts[self.columns * self.rows] as usize;
        let entry = |at: u32| (at != NONE).then_some(at);
        let head = entry(self.heads[self.cell(row, column)]);
        std::iter::successors(head, move |&at| entry(self.nexts[at as usize]))
            .map(move |at| sorted + at as usize)
    }
}

/// A list cut into pieces of these lengths.
fn pieces<T>(mut list: &mut [T], lengths: impl Iterator<Item = usize>) -> Vec<&mut [T]> {
    let mut cut = |length| {
        let (piece, rest) = std::mem::take(&mut list).split_at_mut(length);
        list = rest;
        piece
    };
    lengths.map(&mut cut).collect()
}
