//! The fine structure between the grown veins: a net of the finest veins around areoles, and grain.
//!
//! The net is the border of a jittered Voronoi diagram in three sizes (S. Worley, "A cellular texture
//! basis function", SIGGRAPH 1996). Departs from it: the distance to the border is that to the
//! bisector of the two nearest points, not F₂ − F₁, so that lines keep their width.
//!
//! Sizes are millimetres, so a larger texture shows more and not larger tissue; what would be finer
//! than the texels fades.

use pulp::Simd;

use super::strip::{LANES, Lane};
use crate::geometry::{noise, whole};

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
#[inline(always)]
pub(super) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Texels that are compared with the same points at a time.
const BLOCK: usize = 8;

/// One net over some rows: the points of all its cells there.
#[derive(Debug)]
pub(super) struct Net {
    size: f32,
    seed: u32,
    /// The cell of the first point.
    first: [i32; 2],
    across: usize,
    /// Where in its cell a point lies, and a number of its areole, 0–1.
    points: Vec<[f32; 3]>,
}

impl Net {
    pub(super) fn new(size: f32, seed: u32) -> Self {
        Self { size, seed, first: [0; 2], across: 0, points: Vec::new() }
    }

    /// Works out the points around all places between two corners (mm).
    pub(super) fn prepare(&mut self, low: [f32; 2], high: [f32; 2]) {
        let cell = |v: f32| whole::floor(v / self.size);
        self.first = low.map(|v| cell(v) - 1);
        let last = high.map(|v| cell(v) + 1);
        self.across = (last[0] - self.first[0] + 1) as usize;
        self.points.clear();
        for y in self.first[1]..=last[1] {
            for x in self.first[0]..=last[0] {
                let hash = noise::lattice(x, y, self.seed);
                // Within the middle 90 % of the cell, from the two halves of the hash.
                let jitter = |bits: u32| 0.05 + 0.9 * (bits as f32 / 65536.0);
                let tone = noise::unit(noise::lattice(hash as i32, 0, 7));
                self.points.push([jitter(hash & 0xffff), jitter(hash >> 16), tone]);
            }
        }
    }

    /// The net at places (mm) between the corners it was prepared for: distance to the border of the
    /// areole (mm), and a number of the areole, 0–1.
    #[inline(always)]
    pub(super) fn along<S: Simd>(
        &self,
        simd: S,
        [xs, ys]: &[Lane; 2],
        border: &mut Lane,
        tone: &mut Lane,
    ) {
        let per_cell = 1.0 / self.size;
        let (mut cells, mut within) = ([[0_i32; LANES]; 2], [[0.0_f32; LANES + BLOCK]; 2]);
        for i in 0..LANES {
            let (x, y) = (xs[i] * per_cell, ys[i] * per_cell);
            let (column, row) = (whole::floor(x), whole::floor(y));
            (cells[0][i], cells[1][i]) = (column, row);
            (within[0][i], within[1][i]) = (x - column as f32, y - row as f32);
        }
        let mut found = [[0.0_f32; LANES + BLOCK]; 3];
        let mut start = 0;
        while start < LANES {
            let cell = [cells[0][start], cells[1][start]];
            let mut end = start + 1;
            while end < LANES && [cells[0][end], cells[1][end]] == cell {
                end += 1;
            }
            let points = self.around(cell);
            // A block may reach past the end: what follows is overwritten by the next run.
            for block in (start..end).step_by(BLOCK) {
                let at = |axis: usize| {
                    <&[f32; BLOCK]>::try_from(&within[axis][block..block + BLOCK])
                        .expect("a slice of that length")
                };
                let seen = nearest_two(simd, points, at(0), at(1));
                for (found, seen) in found.iter_mut().zip(seen) {
                    found[block..block + BLOCK].copy_from_slice(&seen);
                }
            }
            start = end;
        }
        let [behind, apart2, number] = &found;
        for i in 0..LANES {
            border[i] = behind[i] / (2.0 * apart2[i].sqrt().max(1e-3)) * self.size;
            tone[i] = number[i];
        }
    }

    /// The points of a cell and of the eight around it, row by row.
    #[inline(always)]
    fn around(&self, [x, y]: [i32; 2]) -> [&[[f32; 3]; 3]; 3] {
        let (column, row) = ((x - self.first[0]) as usize, (y - self.first[1]) as usize);
        std::array::from_fn(|dy| {
            let from = (row + dy - 1) * self.across + column - 1;
            <&[[f32; 3]; 3]>::try_from(&self.points[from..from + 3]).expect("three points")
        })
    }
}

/// Of the points around a cell the two nearest to some places in it (cell sizes): by how much the squared
/// distance to the second is greater, how far the two are apart, squared, and the number of the first.
///
/// Without a branch, which would be mispredicted at every other point.
#[inline(always)]
fn nearest_two<S: Simd>(
    simd: S,
    points: [&[[f32; 3]; 3]; 3],
    x: &[f32; BLOCK],
    y: &[f32; BLOCK],
) -> [[f32; BLOCK]; 3] {
    const { assert!(BLOCK.is_multiple_of(S::F32_LANES), "blocks are made of whole vectors") };
    let mut found = [[0.0; BLOCK]; 3];
    let [behind, apart2, number] = found.each_mut().map(|all| S::as_mut_simd_f32s(all).0);
    let (x, y) = (S::as_simd_f32s(x).0, S::as_simd_f32s(y).0);
    let (zero, far) = (simd.splat_f32s(0.0), simd.splat_f32s(f32::INFINITY));
    for k in 0..x.len() {
        // Squared distance and direction of both.
        let (mut near, mut near_x, mut near_y) = (far, zero, zero);
        let (mut next, mut next_x, mut next_y) = (far, zero, zero);
        let mut areole = zero;
        for (row, points) in points.into_iter().enumerate() {
            let y = simd.sub_f32s(y[k], simd.splat_f32s(row as f32 - 1.0));
            for (column, &[px, py, tone]) in points.iter().enumerate() {
                let x = simd.sub_f32s(x[k], simd.splat_f32s(column as f32 - 1.0));
                let dx = simd.sub_f32s(simd.splat_f32s(px), x);
                let dy = simd.sub_f32s(simd.splat_f32s(py), y);
                let squared = simd.add_f32s(simd.mul_f32s(dx, dx), simd.mul_f32s(dy, dy));
                let is_near = simd.less_than_f32s(squared, near);
                let is_next = simd.less_than_f32s(squared, next);
                let or_next = |own, old, first| {
                    simd.select_f32s(is_near, first, simd.select_f32s(is_next, own, old))
                };
                next = simd.min_f32s(next, simd.max_f32s(near, squared));
                (next_x, next_y) = (or_next(dx, next_x, near_x), or_next(dy, next_y, near_y));
                near = simd.min_f32s(near, squared);
                near_x = simd.select_f32s(is_near, dx, near_x);
                near_y = simd.select_f32s(is_near, dy, near_y);
                areole = simd.select_f32s(is_near, simd.splat_f32s(tone), areole);
            }
        }
        behind[k] = simd.sub_f32s(next, near);
        let (dx, dy) = (simd.sub_f32s(near_x, next_x), simd.sub_f32s(near_y, next_y));
        apart2[k] = simd.add_f32s(simd.mul_f32s(dx, dx), simd.mul_f32s(dy, dy));
        number[k] = areole;
    }
    found
}

/// How much of structures `size` mm wide a texture of so many pixels to the millimetre can show.
pub(super) fn shown(size: f32, pixels_per_mm: f32) -> f32 {
    smooth(1.8, 5.0, size * pixels_per_mm)
}

/// Size of the grain on a texture (mm): its own, but never finer than the texels can carry.
pub(super) fn grain_size(pixels_per_mm: f32) -> f32 {
    GRAIN_MM.max(1.7 / pixels_per_mm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::WithSimd;

    /// Cell by cell, every point of a wide neighbourhood.
    fn slow(size: f32, seed: u32, x: f32, y: f32) -> (f32, f32) {
        let (x, y) = (x / size, y / size);
        let (cx, cy) = (x.floor() as i32, y.floor() as i32);
        let mut points = Vec::new();
        for (i, j) in (-2..=2).flat_map(|j| (-2..=2).map(move |i| (cx + i, cy + j))) {
            let hash = noise::lattice(i, j, seed);
            let jitter = |bits: u32| 0.05 + 0.9 * (bits as f32 / 65536.0);
            let (px, py) = (i as f32 + jitter(hash & 0xffff), j as f32 + jitter(hash >> 16));
            let tone = noise::unit(noise::lattice(hash as i32, 0, 7));
            points.push(((px - x).powi(2) + (py - y).powi(2), [px, py], tone));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ([px, py], [qx, qy]) = (points[0].1, points[1].1);
        let apart = (px - qx).hypot(py - qy);
        ((points[1].0 - points[0].0) / (2.0 * apart) * size, points[0].2)
    }

    struct Along<'a>(&'a Net, [Lane; 2]);

    impl WithSimd for Along<'_> {
        type Output = [Lane; 2];

        fn with_simd<S: Simd>(self, simd: S) -> [Lane; 2] {
            let mut found = [[0.0; LANES]; 2];
            let [border, tone] = &mut found;
            self.0.along(simd, &self.1, border, tone);
            found
        }
    }

    #[test]
    fn a_net_along_a_strip_is_that_of_a_full_search() {
        for (size, step) in [(0.85, 0.05), (0.27, 0.05), (2.1, 0.9)] {
            let mut net = Net::new(size, 5);
            net.prepare([-21.0, -10.0], [50.0, 8.0]);
            let mut close = 0;
            for row in 0..40 {
                let xs: Lane = std::array::from_fn(|i| i as f32 * step - 20.0 + 0.3 * row as f32);
                let ys: Lane = std::array::from_fn(|i| 0.4 * row as f32 - 9.0 + 0.01 * i as f32);
                let [border, tone] = pulp::Arch::new().dispatch(Along(&net, [xs, ys]));
                let plain = Along(&net, [xs, ys]).with_simd(pulp::Scalar::new());
                assert_eq!([border, tone], plain, "no result depends on the processor");
                for i in 0..LANES {
                    let (expected, areole) = slow(size, 5, xs[i], ys[i]);
                    // The nearest two of nine are not always those of twenty-five, and on a border
                    // either areole will do.
                    close += usize::from((border[i] - expected).abs() < 2e-3 * size);
                    assert!(tone[i] == areole || expected < 2e-3 * size, "{} {}", xs[i], ys[i]);
                    assert!(border[i] >= 0.0 && border[i] < size && (0.0..1.0).contains(&tone[i]));
                }
            }
            assert!(close > 40 * LANES * 995 / 1000, "{size}: {close}");
        }
    }

    #[test]
    fn structures_finer_than_the_texels_fade() {
        assert_eq!(shown(0.27, 4.0), 0.0);
        assert_eq!(shown(0.85, 12.0), 1.0);
    }
}
