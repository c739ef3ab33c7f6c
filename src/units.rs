//! Angles, and the maps between the spaces a leaf lives in.
//!
//! | space | unit | axes |
//! |---|---|---|
//! | leaf  | millimetre | base of the blade at the origin, apex on +y, z off the front face |
//! | uv    | 0 – 1 | u right, v up: the square of leaf space that a texture shows |
//! | pixel | 1 | x right, y down; centres at + 0.5 |
//!
//! Maps are named destination-from-source, so that compositions can be checked by eye.

use glam::DVec2;
use serde::{Deserialize, Serialize};

/// An angle. Made from degrees, read in radians.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Angle {
    degrees: f64,
}

impl Angle {
    /// An angle of so many degrees.
    #[must_use]
    pub const fn from_degrees(degrees: f64) -> Self {
        Self { degrees }
    }

    /// In degrees.
    #[must_use]
    pub const fn degrees(self) -> f64 {
        self.degrees
    }

    /// In radians.
    #[must_use]
    pub fn radians(self) -> f64 {
        self.degrees.to_radians()
    }

    /// The sine, the same on every platform.
    #[must_use]
    pub fn sin(self) -> f64 {
        libm::sin(self.radians())
    }

    /// The cosine, the same on every platform.
    #[must_use]
    pub fn cos(self) -> f64 {
        libm::cos(self.radians())
    }
}

/// The square of leaf space that a texture shows: blade, petiole and a gutter around them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct TextureFrame {
    /// The corner with the least x and y (mm).
    pub min: DVec2,
    /// Length of a side (mm).
    pub side_mm: f64,
}

impl TextureFrame {
    /// The smallest square around the box `min`–`max` with `gutter` (a share of the side, 0–0.4)
    /// left free on every side; the box lies in its middle.
    #[must_use]
    pub fn around(min: DVec2, max: DVec2, gutter: f64) -> Self {
        let size = max - min;
        let side_mm = size.max_element() / (1.0 - 2.0 * gutter);
        Self { min: (min + max) * 0.5 - DVec2::splat(0.5 * side_mm), side_mm }
    }

    /// The uv of a point in leaf space.
    #[must_use]
    pub fn uv_from_leaf(&self, p: DVec2) -> DVec2 {
        (p - self.min) / self.side_mm
    }

    /// The point in leaf space of a uv.
    #[must_use]
    pub fn leaf_from_uv(&self, uv: DVec2) -> DVec2 {
        self.min + uv * self.side_mm
    }

    /// The pixel position of a point in leaf space, on a front texture `size` pixels wide.
    #[must_use]
    pub fn pixel_from_leaf(&self, p: DVec2, size: usize) -> DVec2 {
        let uv = self.uv_from_leaf(p);
        DVec2::new(uv.x, 1.0 - uv.y) * size as f64
    }

    /// The point in leaf space at a pixel position, on a front texture `size` pixels wide.
    #[must_use]
    pub fn leaf_from_pixel(&self, pixel: DVec2, size: usize) -> DVec2 {
        let uv = pixel / size as f64;
        self.leaf_from_uv(DVec2::new(uv.x, 1.0 - uv.y))
    }

    /// Pixels to the millimetre on a texture `size` pixels wide.
    #[must_use]
    pub fn pixels_per_mm(&self, size: usize) -> f64 {
        size as f64 / self.side_mm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_maps_between_spaces_are_inverses() {
        let frame = TextureFrame::around(DVec2::new(-20.0, -12.0), DVec2::new(25.0, 80.0), 0.03);
        let p = DVec2::new(3.0, 41.0);
        assert!(frame.leaf_from_uv(frame.uv_from_leaf(p)).distance(p) < 1e-12);
        assert!(frame.leaf_from_pixel(frame.pixel_from_leaf(p, 512), 512).distance(p) < 1e-12);
    }

    #[test]
    fn the_apex_is_near_the_top_of_the_picture() {
        let frame = TextureFrame::around(DVec2::new(-20.0, 0.0), DVec2::new(20.0, 80.0), 0.05);
        let apex = frame.pixel_from_leaf(DVec2::new(0.0, 80.0), 100);
        assert!((apex - DVec2::new(50.0, 5.0)).length() < 1e-9, "{apex}");
    }
}
