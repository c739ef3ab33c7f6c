//! Connected regions of a mask, over 4-neighbours.

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
    /// The regions of `mask`.
    #[must_use]
    pub fn of(mask: &Grid<bool>) -> Self {
        let (width, height) = (mask.width(), mask.height());
        let mut labels = Grid::filled(width, height, 0u32);
        let mut areas = vec![0usize];
        let mut open = Vec::new();
        for start in 0..width * height {
            if !mask.values()[start] || labels.values()[start] != 0 {
                continue;
            }
            let label = areas.len() as u32;
            areas.push(0);
            labels.values_mut()[start] = label;
            open.push(start);
            while let Some(i) = open.pop() {
                areas[label as usize] += 1;
                for next in neighbours(i, width, height) {
                    if mask.values()[next] && labels.values()[next] == 0 {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonal_neighbours_are_two_regions() {
        let mask = Grid::from_values(3, 2, vec![true, false, true, false, true, true]);
        let regions = Components::of(&mask);
        assert_eq!(regions.areas, [2, 1, 3]);
        assert_eq!(regions.largest(), Some((2, 3)));
    }
}
