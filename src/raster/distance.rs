//! The exact Euclidean distance transform, with the nearest site.
//!
//! Source: A. Meijster, J. Roerdink, W. Hesselink, "A general algorithm for computing distance
//! transforms in linear time", 2000: nearest site in each column, then the lower envelope of
//! parabolas along each row. Departs from it: the site is kept, not only its distance; the columns are
//! gone through band by band, so that no picture of them is needed; and between two sites of a row only
//! the columns between them are looked at.

use std::ops::Range;

use rayon::prelude::*;

use super::Grid;

/// What [`nearest_sites`] gives when there is no site at all.
pub const NO_SITE: u32 = u32::MAX;

/// For every pixel the index (row by row) of the nearest pixel that `is_site`, itself included.
///
/// # Panics
///
/// If a side is longer than 16 384: squared distances would leave 32 bits.
#[must_use]
pub fn nearest_sites(
    width: usize,
    height: usize,
    is_site: impl Fn(usize) -> bool + Sync,
) -> Grid<u32> {
    let sites = NearestByRows::new(width, height, is_site);
    let mut nearest = Grid::filled(width, height, NO_SITE);
    sites.for_each_row(nearest.values_mut(), |row, pixels| {
        row.runs(0..width, |run, site| pixels[run].fill(site));
    });
    nearest
}

/// Rows of which the nearest sites are worked out together.
const BAND: usize = 32;

/// The nearest sites as runs of pixels of a row that have one in common: for pictures of which only
/// some pixels are asked for, and which would be large if written down.
#[derive(Debug)]
pub struct NearestByRows {
    width: usize,
    /// The sites of each row, as runs from left to right, row by row.
    sites: Vec<Range<u16>>,
    /// Where the runs of each row begin, and where the last ends.
    firsts: Vec<usize>,
    /// For every band and column the row of the last site above the band.
    above: Vec<u16>,
    /// Likewise of the first site below.
    below: Vec<u16>,
}

impl NearestByRows {
    /// The sites of a picture.
    ///
    /// # Panics
    ///
    /// If a side is longer than 16 384: squared distances would leave 32 bits.
    #[must_use]
    pub fn new(width: usize, height: usize, is_site: impl Fn(usize) -> bool + Sync) -> Self {
        Self::of_rows(width, height, |y| runs_of(0..width, |x| is_site(y * width + x)))
    }

    /// The sites that `row` gives for each row, as [`runs_of`] does.
    ///
    /// # Panics
    ///
    /// If a side is longer than 16 384.
    #[must_use]
    pub fn of_rows(
        width: usize,
        height: usize,
        row: impl Fn(usize) -> Vec<Range<u16>> + Sync,
    ) -> Self {
        assert!(width.max(height) <= 1 << 14, "squared distances need to fit 32 bits");
        let rows: Vec<Vec<Range<u16>>> = (0..height).into_par_iter().map(&row).collect();
        let mut firsts = vec![0];
        firsts.extend(rows.iter().scan(0, |sum, row| {
            *sum += row.len();
            Some(*sum)
        }));
        let sites = rows.concat();
        let bands = height.div_ceil(BAND);
        let mut sites = Self { width, sites, firsts, above: Vec::new(), below: Vec::new() };
        sites.above = vec![NO_ROW; width * bands];
        sites.below = vec![NO_ROW; width * bands];
        let mut seen = vec![NO_ROW; width];
        for band in 0..bands {
            sites.above[band * width..(band + 1) * width].copy_from_slice(&seen);
            for y in sites.rows(band) {
                sites.mark(y, &mut seen);
            }
        }
        seen.fill(NO_ROW);
        for band in (0..bands).rev() {
            sites.below[band * width..(band + 1) * width].copy_from_slice(&seen);
            for y in sites.rows(band).rev() {
                sites.mark(y, &mut seen);
            }
        }
        sites
    }

    /// Writes the number of a row where it has sites.
    fn mark(&self, y: usize, columns: &mut [u16]) {
        for run in self.sites_of(y) {
            columns[usize::from(run.start)..usize::from(run.end)].fill(y as u16);
        }
    }

    fn sites_of(&self, y: usize) -> &[Range<u16>] {
        &self.sites[self.firsts[y]..self.firsts[y + 1]]
    }

    /// Calls `each` with every row and as many values for it as for the others, on all threads.
    ///
    /// # Panics
    ///
    /// Unless the values can be dealt out to the rows.
    pub fn for_each_row<T: Send>(
        &self,
        values: &mut [T],
        each: impl Fn(&mut Row<'_, '_>, &mut [T]) + Sync,
    ) {
        let height = self.firsts.len() - 1;
        let in_row = values.len() / height.max(1);
        assert_eq!(in_row * height, values.len(), "as many values for every row");
        let fill = |reader: &mut Reader<'_>, (band, values): (usize, &mut [T])| {
            reader.go_to(band);
            for (y, values) in self.rows(band).zip(values.chunks_mut(in_row)) {
                each(&mut Row { y, reader }, values);
            }
        };
        let bands = values.par_chunks_mut((BAND * in_row).max(1)).enumerate();
        bands.for_each_init(|| self.reader(), fill);
    }

    /// The rows of a band.
    fn rows(&self, band: usize) -> Range<usize> {
        band * BAND..((band + 1) * BAND).min(self.firsts.len() - 1)
    }

    /// What lies between the sites of a row, from left to right.
    fn gaps(&self, y: usize) -> impl Iterator<Item = Range<usize>> + '_ {
        let sites = self.sites_of(y);
        let starts = std::iter::once(0).chain(sites.iter().map(|run| usize::from(run.end)));
        let ends = sites.iter().map(|run| usize::from(run.start)).chain([self.width]);
        starts.zip(ends).map(|(start, end)| start..end).filter(|gap| !gap.is_empty())
    }

    /// Reads them; each thread has its own.
    fn reader(&self) -> Reader<'_> {
        Reader { sites: self, first: 0, nearest: Vec::new(), envelope: Vec::new() }
    }
}

/// The runs of the columns that are sites.
pub fn runs_of(columns: Range<usize>, is_site: impl Fn(usize) -> bool) -> Vec<Range<u16>> {
    let mut runs = Vec::new();
    let mut x = columns.start;
    while x < columns.end {
        let start = (x..columns.end).find(|&x| is_site(x)).unwrap_or(columns.end);
        x = (start..columns.end).find(|&x| !is_site(x)).unwrap_or(columns.end);
        if start < x {
            runs.push(start as u16..x as u16);
        }
    }
    runs
}

/// The sites nearest to the pixels of a row.
#[derive(Debug)]
pub struct Row<'a, 'b> {
    y: usize,
    reader: &'b mut Reader<'a>,
}

impl<'a> Row<'a, '_> {
    /// Its number.
    #[must_use]
    pub fn y(&self) -> usize {
        self.y
    }

    /// What lies between its sites, from left to right.
    pub fn gaps(&self) -> impl Iterator<Item = Range<usize>> + use<'a> {
        self.reader.sites.gaps(self.y)
    }

    /// Calls `each` with every run of pixels within some columns, from left to right, and the index of its
    /// site. There is no run where there is no site. Only the sites in these columns count: those of the
    /// row, or a gap with the sites beside it.
    pub fn runs(&mut self, columns: Range<usize>, each: impl FnMut(Range<usize>, u32)) {
        self.reader.runs(self.y, columns, each);
    }
}

/// Reads the nearest sites, a band of rows at a time.
#[derive(Debug)]
struct Reader<'a> {
    sites: &'a NearestByRows,
    first: usize,
    /// For every pixel of the band the row of the nearest site in its column.
    nearest: Vec<u16>,
    envelope: Vec<Parabola>,
}

impl Reader<'_> {
    /// Makes the rows of a band ready.
    fn go_to(&mut self, band: usize) {
        let Self { sites, first, nearest, .. } = self;
        let (width, rows) = (sites.width, sites.rows(band));
        let columns = band * width..(band + 1) * width;
        *first = rows.start;
        nearest.clear();
        for y in rows.clone() {
            match nearest.len().checked_sub(width) {
                Some(before) => nearest.extend_from_within(before..),
                None => nearest.extend_from_slice(&sites.above[columns.clone()]),
            }
            let here = nearest.len() - width;
            sites.mark(y, &mut nearest[here..]);
        }
        for y in rows.clone().rev() {
            let (here, rest) = nearest.split_at_mut((y + 1 - rows.start) * width);
            let here = &mut here[(y - rows.start) * width..];
            let next =
                if y + 1 < rows.end { &rest[..width] } else { &sites.below[columns.clone()] };
            let distance = |row: u16| if row == NO_ROW { u16::MAX } else { row.abs_diff(y as u16) };
            for gap in sites.gaps(y) {
                for (own, &other) in here[gap.clone()].iter_mut().zip(&next[gap]) {
                    *own = if distance(other) < distance(*own) { other } else { *own };
                }
            }
        }
    }

    /// The runs of row `y`, of the band at hand; see [`Row::runs`].
    fn runs(&mut self, y: usize, columns: Range<usize>, mut each: impl FnMut(Range<usize>, u32)) {
        let width = self.sites.width;
        let rows = &self.nearest[(y - self.first) * width..][..width];
        lower_envelope(rows, &columns, y as i32, &mut self.envelope);
        for (i, parabola) in self.envelope.iter().enumerate() {
            let end = self.envelope.get(i + 1).map_or(columns.end as i32, |next| next.from);
            let column = parabola.column as usize;
            let site = u32::from(rows[column]) * width as u32 + column as u32;
            each(parabola.from as usize..end as usize, site);
        }
    }
}

const NO_ROW: u16 = u16::MAX;

/// One parabola of the lower envelope: its column, squared height, and where it begins to be least.
#[derive(Debug)]
struct Parabola {
    column: i32,
    height: i32,
    from: i32,
}

fn lower_envelope(rows: &[u16], columns: &Range<usize>, y: i32, envelope: &mut Vec<Parabola>) {
    let (first, end) = (columns.start as i32, columns.end as i32);
    envelope.clear();
    for (column, &row) in (first..).zip(&rows[columns.clone()]) {
        if row == NO_ROW {
            continue;
        }
        let height = (i32::from(row) - y).pow(2);
        let mut from = first;
        while let Some(last) = envelope.last() {
            // The last column where the older parabola is not above the newer one.
            let above = column * column - last.column * last.column + height - last.height;
            // Most are neighbours, and a division takes as long as the rest.
            let apart = column - last.column;
            from = if apart == 1 { above >> 1 } else { above.div_euclid(2 * apart) } + 1;
            if from > last.from {
                break;
            }
            envelope.pop();
            from = first;
        }
        if from < end {
            envelope.push(Parabola { column, height, from: from.max(first) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    fn squared(width: usize, i: usize, site: usize) -> i64 {
        let (dx, dy) = (
            (i % width) as i64 - (site % width) as i64,
            (i / width) as i64 - (site / width) as i64,
        );
        dx * dx + dy * dy
    }

    #[test]
    fn the_nearest_site_is_that_of_a_full_search() {
        let mut rng = Seed(4).stream(Stage::Tissue);
        for (width, height, share) in [(1, 1, 1.0), (37, 21, 0.02), (16, 50, 0.3), (64, 3, 0.05)] {
            let sites: Vec<bool> = (0..width * height).map(|_| rng.unit() < share).collect();
            let found = nearest_sites(width, height, |i| sites[i]);
            let all: Vec<usize> = (0..sites.len()).filter(|&i| sites[i]).collect();
            for (i, &site) in found.values().iter().enumerate() {
                let Some(least) = all.iter().map(|&s| squared(width, i, s)).min() else {
                    assert_eq!(site, NO_SITE);
                    continue;
                };
                assert!(sites[site as usize]);
                assert_eq!(squared(width, i, site as usize), least, "{width}×{height} at {i}");
            }
        }
    }

    #[test]
    fn in_a_gap_the_sites_beside_it_are_enough() {
        let mut rng = Seed(6).stream(Stage::Tissue);
        for share in [0.02, 0.6, 0.95] {
            let (width, height) = (70, 2 * BAND + 9);
            let picture: Vec<bool> = (0..width * height).map(|_| rng.unit() < share).collect();
            let sites = NearestByRows::new(width, height, |i| picture[i]);
            let all = nearest_sites(width, height, |i| picture[i]);
            sites.for_each_row(&mut vec![(); height], |row, _| {
                let (y, mut empty) = (row.y(), 0);
                for gap in row.gaps() {
                    assert!(gap.clone().all(|x| !picture[y * width + x]));
                    empty += gap.len();
                    let beside = gap.start.saturating_sub(1)..(gap.end + 1).min(width);
                    row.runs(beside, |run, site| {
                        assert!(run.into_iter().all(|x| all[(x, y)] == site));
                    });
                }
                assert_eq!(empty, (0..width).filter(|x| !picture[y * width + x]).count());
            });
        }
    }

    #[test]
    fn without_sites_there_is_no_nearest() {
        assert!(nearest_sites(5, 4, |_| false).values().iter().all(|&site| site == NO_SITE));
    }
}
