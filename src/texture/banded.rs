//! Things on a picture sorted by the bands of rows that they pass through: drawn band by band, all that is
//! drawn on stays in the cache of a core, and bands can be drawn side by side.

use std::ops::Range;

/// Things in bands.
#[derive(Debug)]
pub(super) struct Banded<T> {
    /// Those of band i are `things[starts[i]..starts[i + 1]]`, in their order; one that passes through several
    /// bands stands in each.
    things: Vec<T>,
    starts: Vec<usize>,
}

impl<T: Copy> Banded<T> {
    /// Sorts things on a picture of so many rows into bands of `band` rows by the rows that each is on.
    pub(super) fn new(
        things: &[T],
        rows: usize,
        band: usize,
        rows_of: impl Fn(&T) -> Range<usize>,
    ) -> Self {
        let bands = |thing: &T| {
            let rows = rows_of(thing);
            if rows.is_empty() { 0..0 } else { rows.start / band..rows.end.div_ceil(band) }
        };
        let mut starts = vec![0; rows.div_ceil(band) + 1];
        for i in things.iter().flat_map(bands) {
            starts[i + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut next = starts.clone();
        // Any thing will do: each place is written to.
        let mut sorted = match things.first() {
            Some(&any) => vec![any; starts[starts.len() - 1]],
            None => Vec::new(),
        };
        for thing in things {
            for i in bands(thing) {
                sorted[next[i]] = *thing;
                next[i] += 1;
            }
        }
        Self { things: sorted, starts }
    }

    /// What passes through a band.
    pub(super) fn band(&self, i: usize) -> &[T] {
        &self.things[self.starts[i]..self.starts[i + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_band_has_what_passes_through_it_in_order() {
        let things = [0..3, 9..10, 2..9, 5..5, 4..8, 8..9_usize].map(|rows| (rows.start, rows.end));
        let banded = Banded::new(&things, 10, 4, |&(start, end)| start..end);
        for (i, rows) in [0..4, 4..8, 8..10].into_iter().enumerate() {
            let meets = |&&(start, end): &&(usize, usize)| {
                start < end && start < rows.end && end > rows.start
            };
            let expected: Vec<_> = things.iter().filter(meets).copied().collect();
            assert_eq!(banded.band(i), expected, "band {i}");
        }
        let none = Banded::new(&[] as &[u8], 10, 4, |_| 0..1);
        assert!((0..3).all(|i| none.band(i).is_empty()));
    }
}
