//! Pixels that have never heard of leaves.

pub mod chamfer;
pub mod color;
pub mod components;
pub mod contour;
pub mod coverage;
pub mod distance;
pub mod draw;
pub mod flood_fill;
pub mod montage;
pub mod skeleton;
pub mod smooth;
pub mod thinning;
pub mod threshold;

use crate::parallel::for_each_piece;

/// A rectangle of values, row 0 at the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Grid<T> {
    width: usize,
    height: usize,
    values: Vec<T>,
}

impl<T: Clone> Grid<T> {
    /// A grid filled with one value.
    #[must_use]
    pub fn filled(width: usize, height: usize, value: T) -> Self {
        Self { width, height, values: vec![value; width * height] }
    }
}

impl<T> Grid<T> {
    /// A grid over `values`, row by row from the top.
    ///
    /// # Panics
    ///
    /// If there are not `width * height` values.
    #[must_use]
    pub fn from_values(width: usize, height: usize, values: Vec<T>) -> Self {
        assert_eq!(values.len(), width * height, "a grid needs a value for every pixel");
        Self { width, height, values }
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// All values, row by row from the top.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, row by row from the top, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// The values of row `y`.
    #[must_use]
    pub fn row(&self, y: usize) -> &[T] {
        &self.values[y * self.width..(y + 1) * self.width]
    }

    /// The same size, each value mapped.
    #[must_use]
    pub fn map<U>(&self, f: impl FnMut(&T) -> U) -> Grid<U> {
        Grid { width: self.width, height: self.height, values: self.values.iter().map(f).collect() }
    }

    /// The value at `(x, y)`, or `None` outside.
    #[must_use]
    pub fn get(&self, x: isize, y: isize) -> Option<&T> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < self.width && y < self.height).then(|| &self.values[y * self.width + x])
    }
}

impl<T: Copy + Default + Send> Grid<T> {
    /// A grid of which `value` gives every value by its column and row; on all threads.
    #[must_use]
    pub fn computed(width: usize, height: usize, value: impl Fn(usize, usize) -> T + Sync) -> Self {
        let mut grid = Self::filled(width, height, T::default());
        for_each_piece(&mut grid.values, width, &|y, row| {
            for (x, pixel) in row.iter_mut().enumerate() {
                *pixel = value(x, y);
            }
        });
        grid
    }
}

impl<T: Clone + Default> Grid<T> {
    /// A square of this side with anything in it: this one if it has that side, else a new one.
    pub(crate) fn or_new(self, side: usize) -> Self {
        if (self.width, self.height) == (side, side) {
            return self;
        }
        Self::filled(side, side, T::default())
    }
}

impl<T: Copy> Grid<T> {
    /// Mirrored left to right.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let mut values = Vec::with_capacity(self.values.len());
        for y in 0..self.height {
            values.extend(self.row(y).iter().rev());
        }
        Self { width: self.width, height: self.height, values }
    }
}

impl<T> std::ops::Index<(usize, usize)> for Grid<T> {
    type Output = T;

    fn index(&self, (x, y): (usize, usize)) -> &T {
        &self.values[y * self.width + x]
    }
}

impl<T> std::ops::IndexMut<(usize, usize)> for Grid<T> {
    fn index_mut(&mut self, (x, y): (usize, usize)) -> &mut T {
        &mut self.values[y * self.width + x]
    }
}
