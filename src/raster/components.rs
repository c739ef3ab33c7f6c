//! Connected regions of a mask, over 4 or 8 neighbours.

use super::Grid;

/// A mask split into its connected regions.
#[derive(Debug, Clone)]
pub struct Components {
    /// The number of its region for every pixel, from 1 in scan order; 0 off the mask.
    pub labels: Grid<u32>,
    /// How many pixels each region has; region `n` at index `n`, index 0 is what is off the mask.
    pub areas: Vec<usize>,
}

impl Components {
    /// The regions of `mask`, over 4 neighbours.
    #[must_use]
    pub fn of(mask: &Grid<bool>) -> Self {
        let (width, height) = (mask.width(), mask.height());
        Self::over(width, height, |i| mask.values()[i], neighbours)
    }

    /// The regions of the pixels of which `mask` is true, over 8 neighbours.
    #[must_use]
    pub fn of_eight(width: usize, height: usize, mask: impl Fn(usize) -> bool) -> Self {
        Self::over(width, height, mask, neighbours_of_eight)
    }

    fn over<I: Iterator<Item = usize>>(
        width: usize,
        height: usize,
        mask: impl Fn(usize) -> bool,
        around: impl Fn(usize, usize, usize) -> I,
    ) -> Self {
        let mut labels = Grid::filled(width, height, 0u32);
        let mut areas = vec![0usize];
        let mut open = Vec::new();
        for start in 0..width * height {
            if labels.values()[start] != 0 || !mask(start) {
                continue;
            }
            let label = areas.len() as u32;
            areas.push(0);
            labels.values_mut()[start] = label;
            open.push(start);
            while let Some(i) = open.pop() {
                areas[label as usize] += 1;
                for next in around(i, width, height) {
                    if labels.values()[next] == 0 && mask(next) {
                        labels.values_mut()[next] = label;
                        open.push(next);
                    }
                }
            }
        }
        areas[0] = width * height - areas.iter().sum::<usize>();
        Self { labels, areas }
    }

    /// The largest region and its area; the first of equals.
    #[must_use]
    pub fn largest(&self) -> Option<(u32, usize)> {
        (1..self.areas.len())
            .max_by_key(|&label| (self.areas[label], usize::MAX - label))
            .map(|label| (label as u32, self.areas[label]))
    }
}

/// The indices of the pixels left, right, above and below pixel `i`.
pub fn neighbours(i: usize, width: usize, height: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % width, i / width);
    let left = (x > 0).then(|| i - 1);
    let right = (x + 1 < width).then_some(i + 1);
    let above = (y > 0).then(|| i - width);
    let below = (y + 1 < height).then_some(i + width);
    [left, right, above, below].into_iter().flatten()
}

/// The indices of the pixels all around pixel `i`, at its corners too.
pub fn neighbours_of_eight(
    i: usize,
    width: usize,
    height: usize,
) -> impl Iterator<Item = usize> + Clone {
    let near = |at: usize, end: usize| at.saturating_sub(1)..(at + 2).min(end);
    let columns = near(i % width, width);
    let rows = near(i / width, height);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
        .filter(move |&next| next != i)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonal_neighbours_are_two_regions() {
        let mask = Grid::from_values(3, 2, vec![true, false, true, false, true, true]);
        let regions = Components::of(&mask);
        assert_eq!(regions.areas, [2, 1, 3]);
        assert_eq!(regions.largest(), Some((2, 3)));
        let regions = Components::of_eight(3, 2, |i| mask.values()[i]);
        assert_eq!(regions.areas, [2, 4]);
        let corner: Vec<usize> = neighbours_of_eight(3, 3, 2).collect();
        assert_eq!(corner, [0, 1, 4]);
    }
}
