//! The fine structure between the grown veins: a net of the finest veins around areoles, and grain.
//!
//! The net is the border of a jittered Voronoi diagram in three sizes (S. Worley, "A cellular texture
//! basis function", SIGGRAPH 1996). Departs from it: the distance to the border is that to the
//! bisector of the two nearest points, not F₂ − F₁, so that lines keep their width.
//!
//! Sizes are millimetres, so a larger texture shows more and not larger tissue; what would be finer
//! than the texels fades.

use crate::geometry::noise;

/// Sizes of the meshes (mm): of third-order veins where none have grown, of the fourth order, and
/// of the fifth.
pub(super) const MESH_MM: [f32; 3] = [2.1, 0.85, 0.27];

/// Which mesh is the areole: the one that bulges.
pub(super) const AREOLE: usize = 1;

/// Half the width of the lines of each net (mm).
pub(super) const LINE_MM: [f32; 3] = [0.042, 0.032, 0.014];

/// The nets begin within these distances (mm) of a grown vein: nearer, it takes their place.
pub(super) const AWAY_MM: [[f32; 2]; 3] = [[0.5, 1.3], [0.05, 0.35], [0.0, 0.1]];

/// Size of the grain (mm): a few cells of the epidermis.
const GRAIN_MM: f32 = 0.11;

/// A smooth step from 0 at `low` to 1 at `high`.
#[inline]
pub(super) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// What a net is at one place.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Mesh {
    /// Distance to the border of the areole (mm).
    pub border: f32,
    /// A number of the areole, 0–1.
    pub tone: f32,
}

/// One net, read along a row: it keeps the points around the last place.
#[derive(Debug)]
pub(super) struct Net {
    size: f32,
    seed: u32,
    cell: (i32, i32),
    points: [[f32; 2]; 9],
    hashes: [u32; 9],
}

impl Net {
    pub(super) fn new(size: f32, seed: u32) -> Self {
        let mut net = Self { size, seed, cell: (0, 0), points: [[0.0; 2]; 9], hashes: [0; 9] };
        net.gather((0, 0));
        net
    }

    fn gather(&mut self, cell: (i32, i32)) {
        self.cell = cell;
        for (k, point) in self.points.iter_mut().enumerate() {
            let (dx, dy) = (k as i32 % 3 - 1, k as i32 / 3 - 1);
            let hash = noise::lattice(cell.0 + dx, cell.1 + dy, self.seed);
            self.hashes[k] = hash;
            // Within the middle 90 % of the cell, from the two halves of the hash.
            let jitter = |bits: u32| 0.05 + 0.9 * (bits as f32 / 65536.0);
            *point = [dx as f32 + jitter(hash & 0xffff), dy as f32 + jitter(hash >> 16)];
        }
    }

    /// The net at a place (mm).
    #[inline]
    pub(super) fn at(&mut self, x: f32, y: f32) -> Mesh {
        let (x, y) = (x / self.size, y / self.size);
        let cell = (noise::floor(x), noise::floor(y));
        if cell != self.cell {
            self.gather(cell);
        }
        let (x, y) = (x - cell.0 as f32, y - cell.1 as f32);
        // The two nearest points without a branch, which would be mispredicted at every other
        // point: positive floats sort as their bits do, and the last four bits carry the index.
        let (mut first, mut second) = (u32::MAX, u32::MAX);
        for (k, point) in self.points.iter().enumerate() {
            let (dx, dy) = (point[0] - x, point[1] - y);
            let key = ((dx * dx + dy * dy).to_bits() & !15) | k as u32;
            second = second.min(first.max(key));
            first = first.min(key);
        }
        let (nearest, next) = ((first & 15) as usize, (second & 15) as usize);
        let (p, q) = (self.points[nearest], self.points[next]);
        let squared = |point: [f32; 2]| (point[0] - x).powi(2) + (point[1] - y).powi(2);
        let (dx, dy) = (p[0] - q[0], p[1] - q[1]);
        let apart = (dx * dx + dy * dy).sqrt().max(1e-3);
        Mesh {
            border: ((squared(q) - squared(p)) / (2.0 * apart)).max(0.0) * self.size,
            tone: noise::unit(noise::lattice(self.hashes[nearest] as i32, 0, 7)),
        }
    }
}

/// How much of structures `size` mm wide a texture of so many pixels to the millimetre can show.
pub(super) fn shown(size: f32, pixels_per_mm: f32) -> f32 {
    smooth(1.8, 5.0, size * pixels_per_mm)
}

/// Grain of the surface at a place (mm): −1 – 1.
#[inline]
pub(super) fn grain(x: f32, y: f32, size: f32, seed: u32) -> f32 {
    noise::gradient(x / size, y / size, seed)
}

/// Size of the grain on a texture (mm): its own, but never finer than the texels can carry.
pub(super) fn grain_size(pixels_per_mm: f32) -> f32 {
    GRAIN_MM.max(1.7 / pixels_per_mm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_net_is_the_same_however_one_comes_to_a_place() {
        let mut walked = Net::new(0.85, 5);
        for i in 0..500 {
            let (x, y) = (i as f32 * 0.13 - 20.0, i as f32 * 0.07 - 9.0);
            let (here, fresh) = (walked.at(x, y), Net::new(0.85, 5).at(x, y));
            assert_eq!((here.border, here.tone), (fresh.border, fresh.tone));
            assert!(here.border >= 0.0 && here.border < 0.85 && (0.0..1.0).contains(&here.tone));
        }
    }

    #[test]
    fn structures_finer_than_the_texels_fade() {
        assert_eq!(shown(0.27, 4.0), 0.0);
        assert_eq!(shown(0.85, 12.0), 1.0);
    }
}
