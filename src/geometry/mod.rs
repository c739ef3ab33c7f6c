//! Mathematics that has never heard of leaves. Vectors are glam's `DVec2`.

pub mod alignment;
pub mod box_cells;
pub mod bspline;
mod chains;
pub mod compact;
pub mod deviation;
pub mod geodesic;
pub mod measured;
pub mod minimise;
pub mod noise;
pub mod nurbs;
pub mod packing;
mod paving;
pub mod point_cells;
pub mod point_grid;
pub mod point_index;
pub mod polygon;
mod rings;
pub mod scatter;
pub mod segment_grid;
pub mod segments;
pub mod sparse;
pub mod triangulate;
pub mod union;
pub mod whole;
pub mod z_order;

pub use glam::DVec2;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// The corner with the least coordinates.
    pub min: DVec2,
    /// The corner with the greatest coordinates.
    pub max: DVec2,
}

impl Rect {
    /// The smallest box around some points; empty (min > max) around none.
    #[must_use]
    pub fn around(points: impl IntoIterator<Item = DVec2>) -> Self {
        let empty = Self { min: DVec2::INFINITY, max: DVec2::NEG_INFINITY };
        points
            .into_iter()
            .fold(empty, |rect, p| Self { min: rect.min.min(p), max: rect.max.max(p) })
    }

    /// The smallest box around two points.
    #[inline]
    #[must_use]
    pub fn between(a: DVec2, b: DVec2) -> Self {
        Self { min: a.min(b), max: a.max(b) }
    }

    /// The smallest box around two.
    #[inline]
    #[must_use]
    pub fn joined(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// Width and height.
    #[must_use]
    pub fn size(&self) -> DVec2 {
        self.max - self.min
    }

    /// Whether the two have a point in common, their borders included.
    #[inline]
    #[must_use]
    pub fn meets(&self, other: Self) -> bool {
        // Without branches: asked of all that is near.
        (self.min.x <= other.max.x)
            & (self.max.x >= other.min.x)
            & (self.min.y <= other.max.y)
            & (self.max.y >= other.min.y)
    }

    /// The least width of square cells, from `cell` on, of which at most so many lie over the box and in
    /// one of its rows.
    fn cell_width(&self, cell: f64, most: f64) -> f64 {
        let size = self.size();
        // Over a single point any width will do; the least ones would make billions of cells.
        let least = if size.max_element() > 0.0 { f64::MIN_POSITIVE } else { 1.0 };
        let size = size.max(DVec2::splat(least));
        cell.max((size.x * size.y / most).sqrt()).max(size.max_element() / most)
    }

    /// The same, larger by `by` on every side.
    #[inline]
    #[must_use]
    pub fn grown(&self, by: f64) -> Self {
        Self { min: self.min - DVec2::splat(by), max: self.max + DVec2::splat(by) }
    }
}
