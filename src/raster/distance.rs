//! The exact Euclidean distance transform, with the nearest site.
//!
//! Source: A. Meijster, J. Roerdink, W. Hesselink, "A general algorithm for computing distance
//! transforms in linear time", 2000: nearest site in each column, then the lower envelope of
//! parabolas along each row. Departs from it: the site is kept, not only its distance.

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
    let rows = NearestByRows::new(width, height, is_site);
    let mut nearest = Grid::filled(width, height, NO_SITE);
    nearest.values_mut().par_chunks_mut(width.max(1)).enumerate().for_each_init(
        Envelope::default,
        |envelope, (y, row)| {
            rows.runs(y, envelope, |run, site| row[run].fill(site));
        },
    );
    nearest
}

/// The nearest sites as runs of pixels of a row that have one in common: for pictures of which only
/// some pixels are asked for, and which would be large if written down.
#[derive(Debug)]
pub struct NearestByRows {
    width: usize,
    /// For every pixel the row of the nearest site in its column.
    column_sites: Vec<u16>,
}

/// What [`NearestByRows::runs`] uses from row to row.
#[derive(Debug, Default)]
pub struct Envelope(Vec<Parabola>);

impl NearestByRows {
    /// The sites of a picture.
    ///
    /// # Panics
    ///
    /// If a side is longer than 16 384: squared distances would leave 32 bits.
    #[must_use]
    pub fn new(width: usize, height: usize, is_site: impl Fn(usize) -> bool) -> Self {
        Self::of_rows(width, height, |y| {
            let is_site = &is_site;
            (0..width, move |x: usize| is_site(y * width + x))
        })
    }

    /// The sites of a square, each row of which has some among its columns.
    ///
    /// # Panics
    ///
    /// If a side is longer than 16 384.
    #[must_use]
    pub fn within<F: Fn(usize) -> bool>(
        size: usize,
        row: impl Fn(usize) -> (std::ops::Range<usize>, F),
    ) -> Self {
        Self::of_rows(size, size, row)
    }

    fn of_rows<F: Fn(usize) -> bool>(
        width: usize,
        height: usize,
        row: impl Fn(usize) -> (std::ops::Range<usize>, F),
    ) -> Self {
        assert!(width.max(height) <= 1 << 14, "squared distances need to fit 32 bits");
        Self { width, column_sites: nearest_in_columns(width, height, row) }
    }

    /// Calls `each` with every run of row `y`, from left to right, and the index of its site. There is
    /// no run where there is no site.
    pub fn runs(
        &self,
        y: usize,
        envelope: &mut Envelope,
        mut each: impl FnMut(std::ops::Range<usize>, u32),
    ) {
        let sites = &self.column_sites[y * self.width..(y + 1) * self.width];
        lower_envelope(sites, y as i32, &mut envelope.0);
        let parabolas = &envelope.0;
        for (i, parabola) in parabolas.iter().enumerate() {
            let end = parabolas.get(i + 1).map_or(self.width as i32, |next| next.from);
            let column = parabola.column as usize;
            let site = u32::from(sites[column]) * self.width as u32 + column as u32;
            each(parabola.from as usize..end as usize, site);
        }
    }
}

const NO_ROW: u16 = u16::MAX;

/// For every pixel the row of the nearest site in its column.
fn nearest_in_columns<F: Fn(usize) -> bool>(
    width: usize,
    height: usize,
    row: impl Fn(usize) -> (std::ops::Range<usize>, F),
) -> Vec<u16> {
    let mut rows = Vec::with_capacity(width * height);
    for y in 0..height {
        if y == 0 {
            rows.resize(width, NO_ROW);
        } else {
            rows.extend_from_within((y - 1) * width..y * width);
        }
        let (columns, is_site) = row(y);
        let here = &mut rows[y * width..];
        for x in columns {
            here[x] = if is_site(x) { y as u16 } else { here[x] };
        }
    }
    for y in (0..height.saturating_sub(1)).rev() {
        let (here, below) = rows.split_at_mut((y + 1) * width);
        let here = &mut here[y * width..];
        for (own, &other) in here.iter_mut().zip(&below[..width]) {
            let distance = |row: u16| if row == NO_ROW { u16::MAX } else { row.abs_diff(y as u16) };
            *own = if distance(other) < distance(*own) { other } else { *own };
        }
    }
    rows
}

/// One parabola of the lower envelope: its column, squared height, and where it begins to be least.
#[derive(Debug)]
struct Parabola {
    column: i32,
    height: i32,
    from: i32,
}

fn lower_envelope(sites: &[u16], y: i32, envelope: &mut Vec<Parabola>) {
    let width = sites.len() as i32;
    envelope.clear();
    for (x, &site) in sites.iter().enumerate() {
        if site == NO_ROW {
            continue;
        }
        let column = x as i32;
        let height = (i32::from(site) - y).pow(2);
        let mut from = 0;
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
            from = 0;
        }
        if from < width {
            envelope.push(Parabola { column, height, from: from.max(0) });
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
    fn without_sites_there_is_no_nearest() {
        assert!(nearest_sites(5, 4, |_| false).values().iter().all(|&site| site == NO_SITE));
    }
}
