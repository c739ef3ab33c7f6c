//! Many leaves on one set of textures.
//!
//! Leaves are laid down one after the other, so that only one stands beside the sheet in memory. When all
//! are there, heights and thickness are brought to one scale and the ground between the leaves is filled
//! from the nearest of them, as around a single leaf.

use glam::DVec2;

use super::TextureSet;
use super::dilation::Empty;
use super::map::MapSet;
use super::pigment::Albedo;
use super::side::SideMaps;
use super::spans::Spans;
use crate::raster::Grid;
use crate::units::TextureFrame;

/// A rectangle of pixels, x from the left, y from the top.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PixelRect {
    /// Left edge.
    pub x: usize,
    /// Upper edge.
    pub y: usize,
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

/// A sheet on which leaves are laid.
#[derive(Debug)]
pub struct AtlasSheet {
    front: SideMaps,
    back: SideMaps,
    albedo: Albedo,
    leaves: Vec<Laid>,
}

/// Where a leaf lies, and what its numbers stand for.
#[derive(Debug)]
struct Laid {
    rect: PixelRect,
    height_range_mm: f64,
    thickness_range_mm: f64,
}

/// The smallest rectangle of a front picture around all that is covered; `None` when nothing is.
#[must_use]
pub fn covered(picture: &Grid<[u8; 4]>) -> Option<PixelRect> {
    let (mut left, mut right) = (usize::MAX, 0);
    let (mut top, mut bottom) = (usize::MAX, 0);
    for y in 0..picture.height() {
        let row = picture.row(y);
        let on = |texel: &[u8; 4]| texel[3] > 0;
        if let (Some(first), Some(last)) = (row.iter().position(on), row.iter().rposition(on)) {
            (left, right) = (left.min(first), right.max(last));
            (top, bottom) = (top.min(y), y);
        }
    }
    (left <= right).then(|| PixelRect {
        x: left,
        y: top,
        width: right + 1 - left,
        height: bottom + 1 - top,
    })
}

impl AtlasSheet {
    /// An empty sheet.
    #[must_use]
    pub fn new(size: usize, maps: MapSet) -> Self {
        let (front, back) = (SideMaps::empty(size, maps), SideMaps::empty(size, maps));
        Self { front, back, albedo: Albedo::Total, leaves: Vec::new() }
    }

    /// Lays the part `from` of a leaf's pictures down with its upper left corner at `to`.
    ///
    /// # Panics
    ///
    /// If it does not fit on the sheet.
    pub fn lay(&mut self, leaf: &TextureSet, from: PixelRect, to: (usize, usize)) {
        self.albedo = leaf.albedo;
        let size = self.front.size();
        let rect = PixelRect { x: to.0, y: to.1, ..from };
        assert!(rect.x + rect.width <= size && rect.y + rect.height <= size, "it fits");
        copy(&leaf.front, &mut self.front, from, rect);
        // Both the leaf's back and the sheet's are mirrored.
        let mirrored = |r: PixelRect, size: usize| PixelRect { x: size - r.x - r.width, ..r };
        copy(&leaf.back, &mut self.back, mirrored(from, leaf.back.size()), mirrored(rect, size));
        self.leaves.push(Laid {
            rect,
            height_range_mm: leaf.height_range_mm,
            thickness_range_mm: leaf.thickness_range_mm,
        });
    }

    /// The textures, `pixels_per_mm` at most on any leaf.
    #[must_use]
    pub fn finish(mut self, pixels_per_mm: f64) -> TextureSet {
        let greatest = |range: fn(&Laid) -> f64| self.leaves.iter().map(range).fold(0.0, f64::max);
        let height_range_mm = greatest(|leaf| leaf.height_range_mm);
        let thickness_range_mm = greatest(|leaf| leaf.thickness_range_mm);
        let size = self.front.size();
        for leaf in &self.leaves {
            let heights = leaf.height_range_mm / height_range_mm.max(f64::MIN_POSITIVE);
            let thickness = leaf.thickness_range_mm / thickness_range_mm.max(f64::MIN_POSITIVE);
            let behind = PixelRect { x: size - leaf.rect.x - leaf.rect.width, ..leaf.rect };
            for (side, rect) in [(&mut self.front, leaf.rect), (&mut self.back, behind)] {
                // Heights are counted from the plain blade in the middle.
                rescale(&mut side.height, rect, heights, 32768.0);
                rescale(&mut side.thickness, rect, thickness, 0.0);
            }
        }
        let whole = Spans::whole(self.front.size());
        Empty::of(&self.front, &whole).spread(&mut self.front, &mut self.back);
        TextureSet {
            frame: TextureFrame { min: DVec2::ZERO, side_mm: size as f64 / pixels_per_mm },
            front: self.front,
            back: self.back,
            height_range_mm,
            thickness_range_mm,
            petiole_end: DVec2::ZERO,
            petiole: Vec::new(),
            albedo: self.albedo,
            rings: Vec::new(),
        }
    }
}

fn rescale(plane: &mut Grid<u16>, rect: PixelRect, by: f64, middle: f64) {
    if by == 1.0 || plane.values().is_empty() {
        return;
    }
    for y in rect.y..rect.y + rect.height {
        for x in rect.x..rect.x + rect.width {
            let value = &mut plane[(x, y)];
            *value = ((f64::from(*value) - middle) * by + middle).round() as u16;
        }
    }
}

fn copy(leaf: &SideMaps, sheet: &mut SideMaps, from: PixelRect, to: PixelRect) {
    rows(&leaf.base_colour, &mut sheet.base_colour, from, to);
    rows(&leaf.normal, &mut sheet.normal, from, to);
    rows(&leaf.height, &mut sheet.height, from, to);
    rows(&leaf.roughness, &mut sheet.roughness, from, to);
    rows(&leaf.occlusion, &mut sheet.occlusion, from, to);
    rows(&leaf.transmission, &mut sheet.transmission, from, to);
    rows(&leaf.translucency, &mut sheet.translucency, from, to);
    rows(&leaf.thickness, &mut sheet.thickness, from, to);
    rows(&leaf.vein_mask, &mut sheet.vein_mask, from, to);
    rows(&leaf.vein_order, &mut sheet.vein_order, from, to);
    rows(&leaf.bump, &mut sheet.bump, from, to);
    if let (Some(leaf), Some(sheet)) = (&leaf.deep, &mut sheet.deep) {
        rows(&leaf.base_colour, &mut sheet.base_colour, from, to);
        rows(&leaf.roughness, &mut sheet.roughness, from, to);
        rows(&leaf.occlusion, &mut sheet.occlusion, from, to);
        rows(&leaf.transmission, &mut sheet.transmission, from, to);
        rows(&leaf.translucency, &mut sheet.translucency, from, to);
        rows(&leaf.vein_mask, &mut sheet.vein_mask, from, to);
    }
}

fn rows<T: Copy>(leaf: &Grid<T>, sheet: &mut Grid<T>, from: PixelRect, to: PixelRect) {
    if leaf.values().is_empty() || sheet.values().is_empty() {
        return;
    }
    let stride = sheet.width();
    for y in 0..from.height {
        let source = &leaf.row(from.y + y)[from.x..from.x + from.width];
        let start = (to.y + y) * stride + to.x;
        sheet.values_mut()[start..start + from.width].copy_from_slice(source);
    }
}
