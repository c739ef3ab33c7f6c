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
    assert!(width.max(height) <= 1 << 14, "squared distances need to fit 32 bits");
    let column_sites = nearest_in_columns(width, height, &is_site);
    let mut nearest = Grid::filled(width, height, NO_SITE);
    nearest.values_mut().par_chunks_mut(width.max(1)).enumerate().for_each_init(
        || Vec::with_capacity(width),
        |envelope, (y, row)| {
            row_envelope(&column_sites[y * width..(y + 1) * width], y as i32, envelope, row);
        },
    );
    nearest
}

const NO_ROW: u16 = u16::MAX;

/// For every pixel the row of the nearest site in its column.
fn nearest_in_columns(
    width: usize,
    height: usize,
    is_site: &(impl Fn(usize) -> bool + Sync),
) -> Vec<u16> {
    let mut rows = vec![NO_ROW; width * height];
    for y in 0..height {
        let (above, here) = rows.split_at_mut(y * width);
        let above = &above[y.saturating_sub(1) * width..];
        for x in 0..width {
            here[x] = if is_site(y * width + x) {
                y as u16
            } else if y > 0 {
                above[x]
            } else {
                NO_ROW
            };
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
struct Parabola {
    column: i32,
    height: i32,
    from: i32,
}

fn row_envelope(sites: &[u16], y: i32, envelope: &mut Vec<Parabola>, nearest: &mut [u32]) {
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
            from = above.div_euclid(2 * (column - last.column)) + 1;
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
    for (i, parabola) in envelope.iter().enumerate() {
        let end = envelope.get(i + 1).map_or(width, |next| next.from);
        let site =
            u32::from(sites[parabola.column as usize]) * width as u32 + parabola.column as u32;
        nearest[parabola.from as usize..end as usize].fill(site);
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
