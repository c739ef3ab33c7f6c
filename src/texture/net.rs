//! A net of areoles: the border of a jittered Voronoi diagram, tabled.
//!
//! Source: S. Worley, "A cellular texture basis function", SIGGRAPH 1996. Departs from it:
//!
//! - The distance to the border is that to the bisector of the two nearest points, not F₂ − F₁, so that lines
//!   keep their width.
//! - The points repeat after some cells, and one such patch is worked out beforehand. Places are bent before
//!   they are looked up, so no two patches look alike.
//!
//! Around every place of a patch the distance is linear but where the nearest two change. An entry of the table
//! is therefore such a linear piece, which holds on both sides of the border: beyond it the distance is negative and
//! the areole the other one. What is read is exact but where the two nearest change within an entry.

use pulp::{Simd, WithSimd};
use rayon::prelude::*;

use super::strip::{LANES, Lane};
use super::tissue;
use crate::geometry::{noise, whole};

/// An entry is at most so many texels wide, as far as [`ENTRIES`] go.
const ENTRY_TEXELS: f32 = 2.0;

/// Entries to a cell, at least and at most: a block of them is worked out at a time, and those of a patch are to
/// stay in a cache.
const ENTRIES: [usize; 2] = [BLOCK, 64];

/// Entries that are worked out together.
const BLOCK: usize = 8;

/// Places farther from a border than this (cells) count as so far. Hardly any is farther than one: it would lie as
/// far from the nearest points of all cells around it.
const FARTHEST: f32 = 1.5;

/// Steps of a distance, 12 bits.
const DISTANCES: f32 = 4095.0;

/// Steps of a slope and of a tone, 5 bits.
const STEPS: f32 = 31.0;

/// A net, by a patch of it.
#[derive(Debug)]
pub(super) struct Net {
    /// How much of it the texels show, more than 0 to 1.
    pub(super) shown: f32,
    /// Width of an entry (mm).
    entry_mm: f32,
    /// A patch has so many entries a side, a power of two.
    side: usize,
    /// A step of the distances (entries).
    step: f32,
    entries: Vec<Entry>,
}

/// From the highest bits: distance to the border; slope to the right and upwards; the areole's tone and that of
/// the areole beyond.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Entry(u32);

impl Entry {
    /// The piece around a place that sees its two nearest points there; see [`nearest_two`].
    #[inline(always)]
    fn between([[x, y, own], [far_x, far_y, other]]: &[[[f32; BLOCK]; 3]; 2], i: usize) -> Self {
        let bits = |x: f32, most: f32| whole::cut(x * most + 0.5, most).cast_unsigned();
        let (dx, dy) = (far_x[i] - x[i], far_y[i] - y[i]);
        let apart = (dx * dx + dy * dy).sqrt().max(1e-3);
        // From the middle between the two, along the way from one to the other.
        let (mx, my) = (0.5 * (x[i] + far_x[i]), 0.5 * (y[i] + far_y[i]));
        let per_apart = 1.0 / apart;
        let distance = bits((mx * dx + my * dy) * per_apart / FARTHEST, DISTANCES);
        let [right, up] = [dx, dy].map(|d| bits(0.5 - 0.5 * d * per_apart, STEPS));
        let [own, other] = [own[i], other[i]].map(|tone| bits(tone, STEPS));
        Self(distance << 20 | right << 15 | up << 10 | own << 5 | other)
    }

    #[inline(always)]
    fn distance(self) -> f32 {
        (self.0 >> 20).cast_signed() as f32
    }

    #[inline(always)]
    fn slope(self) -> [f32; 2] {
        [15, 10].map(|shift| (self.0 >> shift & 31).cast_signed() as f32 * (2.0 / STEPS) - 1.0)
    }

    #[inline(always)]
    fn tones(self) -> [f32; 2] {
        [5, 0].map(|shift| (self.0 >> shift & 31).cast_signed() as f32 * (1.0 / STEPS))
    }
}

impl Net {
    /// A net of cells of this size (mm), of which so many, a power of two, make a side of the patch, as a texture of so
    /// many pixels to the millimetre shows it; none where it is finer than the texels.
    pub(super) fn new(size_mm: f32, cells: usize, per_mm: f32, seed: u32) -> Option<Self> {
        let shown = tissue::shown(size_mm, per_mm);
        if shown == 0.0 {
            return None;
        }
        debug_assert!(cells.is_power_of_two(), "cells are counted round by their bits");
        let wanted = (size_mm * per_mm / ENTRY_TEXELS) as usize;
        let [least, most] = ENTRIES;
        let per_cell = wanted.next_power_of_two().clamp(least, most);
        let side = cells * per_cell;
        let points = Points { cells: cells as i32, seed };
        let mut entries = vec![Entry::default(); side * side];
        entries.par_chunks_mut(per_cell * side).enumerate().for_each(|(row, entries)| {
            pulp::Arch::new().dispatch(CellRow { points, row: row as i32, per_cell, entries });
        });
        let per_cell = per_cell as f32;
        let step = FARTHEST / DISTANCES * per_cell;
        Some(Self { shown, entry_mm: size_mm / per_cell, side, step, entries })
    }

    /// The net at some places (mm): distance to the border of the areole (mm), and a number of the areole, 0–1.
    #[inline(always)]
    pub(super) fn along(&self, [xs, ys]: &[Lane; 2], border: &mut Lane, tone: &mut Lane) {
        let (per_mm, last) = (1.0 / self.entry_mm, self.side as i32 - 1);
        let (mut entries, mut places) = ([0_i32; LANES], [[0.0_f32; LANES]; 2]);
        for i in 0..LANES {
            let (x, y) = (xs[i] * per_mm, ys[i] * per_mm);
            let (column, row) = (whole::floor(x), whole::floor(y));
            entries[i] = (row & last) * self.side as i32 + (column & last);
            (places[0][i], places[1][i]) = (x - column as f32 - 0.5, y - row as f32 - 0.5);
        }
        let mut found = [Entry::default(); LANES];
        for i in 0..LANES {
            found[i] = self.entries[entries[i] as usize];
        }
        for i in 0..LANES {
            let ([dx, dy], [own, other]) = (found[i].slope(), found[i].tones());
            let distance = found[i].distance() * self.step + dx * places[0][i] + dy * places[1][i];
            border[i] = distance.abs() * self.entry_mm;
            tone[i] = if distance < 0.0 { other } else { own };
        }
    }
}

/// The points of a net: one in each cell, the same again after some cells.
#[derive(Debug, Clone, Copy)]
struct Points {
    cells: i32,
    seed: u32,
}

impl Points {
    /// Where in its cell a point lies, and a number of its areole, 0–1.
    fn at(self, x: i32, y: i32) -> [f32; 3] {
        let hash = noise::lattice(x.rem_euclid(self.cells), y.rem_euclid(self.cells), self.seed);
        // Within the middle 90 % of the cell, from the two halves of the hash.
        let jitter = |bits: u32| 0.05 + 0.9 * (bits as f32 / 65536.0);
        let tone = noise::unit(noise::lattice(hash as i32, 0, 7));
        [jitter(hash & 0xffff), jitter(hash >> 16), tone]
    }

    /// The points of a cell and of the eight around it, as seen from its lower left corner.
    fn around(self, x: i32, y: i32) -> [[f32; 3]; 9] {
        std::array::from_fn(|k| {
            let (dx, dy) = (k as i32 % 3 - 1, k as i32 / 3 - 1);
            let [px, py, tone] = self.at(x + dx, y + dy);
            [px + dx as f32, py + dy as f32, tone]
        })
    }
}

/// The entries of a row of cells, to be worked out.
struct CellRow<'a> {
    points: Points,
    row: i32,
    per_cell: usize,
    entries: &'a mut [Entry],
}

impl WithSimd for CellRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { points, row, per_cell, entries } = self;
        let place = |i: usize| (i as f32 + 0.5) / per_cell as f32;
        let side = points.cells as usize * per_cell;
        for cell in 0..points.cells {
            let points = points.around(cell, row);
            for (line, entries) in entries.chunks_mut(side).enumerate() {
                let first = cell as usize * per_cell;
                let entries = &mut entries[first..first + per_cell];
                for (block, entries) in entries.chunks_exact_mut(BLOCK).enumerate() {
                    let mut x = [0.0; BLOCK];
                    for (i, x) in x.iter_mut().enumerate() {
                        *x = place(block * BLOCK + i);
                    }
                    let found = nearest_two(simd, &points, &x, place(line));
                    let mut pieces = [Entry::default(); BLOCK];
                    for (i, piece) in pieces.iter_mut().enumerate() {
                        *piece = Entry::between(&found, i);
                    }
                    entries.copy_from_slice(&pieces);
                }
            }
        }
    }
}

/// Of nine points the two nearest to some places: where they lie, seen from there, and their numbers.
///
/// Without a branch, which would be mispredicted at every other point.
#[inline(always)]
fn nearest_two<S: Simd>(
    simd: S,
    points: &[[f32; 3]; 9],
    x: &[f32; BLOCK],
    y: f32,
) -> [[[f32; BLOCK]; 3]; 2] {
    const { assert!(BLOCK.is_multiple_of(S::F32_LANES), "blocks are made of whole vectors") };
    let mut found = [[[0.0; BLOCK]; 3]; 2];
    let [near, next] =
        found.each_mut().map(|found| found.each_mut().map(|all| S::as_mut_simd_f32s(all).0));
    let (x, zero) = (S::as_simd_f32s(x).0, simd.splat_f32s(0.0));
    for k in 0..x.len() {
        // Squared distance, direction and number of both.
        let (mut first, mut first_at) = (simd.splat_f32s(f32::INFINITY), [zero; 3]);
        let (mut second, mut second_at) = (first, first_at);
        for &[px, py, tone] in points {
            let dx = simd.sub_f32s(simd.splat_f32s(px), x[k]);
            let dy = simd.splat_f32s(py - y);
            let squared = simd.add_f32s(simd.mul_f32s(dx, dx), simd.mul_f32s(dy, dy));
            let is_first = simd.less_than_f32s(squared, first);
            let is_second = simd.less_than_f32s(squared, second);
            for (j, own) in [dx, dy, simd.splat_f32s(tone)].into_iter().enumerate() {
                let other = simd.select_f32s(is_second, own, second_at[j]);
                second_at[j] = simd.select_f32s(is_first, first_at[j], other);
                first_at[j] = simd.select_f32s(is_first, own, first_at[j]);
            }
            second = simd.min_f32s(second, simd.max_f32s(first, squared));
            first = simd.min_f32s(first, squared);
        }
        for j in 0..3 {
            (near[j][k], next[j][k]) = (first_at[j], second_at[j]);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    /// Distance to the border and number of the areole at a place (cells), and that of the areole beyond, from every
    /// point of a wide neighbourhood.
    fn slow(points: Points, x: f32, y: f32) -> [f32; 3] {
        let (column, row) = (x.floor() as i32, y.floor() as i32);
        let mut near = Vec::new();
        for (i, j) in (-2..=2).flat_map(|j| (-2..=2).map(move |i| (column + i, row + j))) {
            let [px, py, tone] = points.at(i, j);
            let (px, py) = (i as f32 + px, j as f32 + py);
            near.push(((px - x).powi(2) + (py - y).powi(2), [px, py], tone));
        }
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        let ([px, py], [qx, qy]) = (near[0].1, near[1].1);
        let border = (near[1].0 - near[0].0) / (2.0 * (px - qx).hypot(py - qy));
        [border, near[0].2, near[1].2]
    }

    fn along(net: &Net, places: &[Lane; 2]) -> [Lane; 2] {
        let mut found = [[0.0; LANES]; 2];
        let [border, tone] = &mut found;
        net.along(places, border, tone);
        found
    }

    #[test]
    fn a_net_is_that_of_a_full_search() {
        // Cells of four, of sixteen and of two hundred texels.
        for (size_mm, per_mm) in [(0.27, 15.0), (0.85, 19.0), (2.1, 95.0)] {
            let net = Net::new(size_mm, 16, per_mm, 5).expect("it is shown");
            let points = Points { cells: 16, seed: 5 };
            let mut rng = Seed(3).stream(Stage::Tissue);
            let (mut exact, mut wrong, mut asked) = (0, 0, 0);
            let entry = net.entry_mm / size_mm;
            for _ in 0..200 {
                let places = [0, 1]
                    .map(|_| std::array::from_fn(|_| rng.between(-70.0, 70.0) as f32 * size_mm));
                let [border, tone] = along(&net, &places);
                for i in 0..LANES {
                    let (x, y) = (places[0][i] / size_mm, places[1][i] / size_mm);
                    let [expected, own, other] = slow(points, x, y);
                    asked += 1;
                    // Five bits of a direction, over half an entry; and those of a tone.
                    let off = (border[i] / size_mm - expected).abs();
                    if off < 0.05 * entry + 1e-3 && (tone[i] - own).abs() < 0.6 / STEPS {
                        exact += 1;
                        continue;
                    }
                    // Else the two nearest change within an entry: from one areole to a third, or, on the
                    // border itself, places.
                    let around =
                        [-0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75].map(|step| step * entry);
                    let changes =
                        around.iter().flat_map(|dx| around.iter().map(move |dy| (dx, dy)));
                    let changes = changes
                        .map(|(dx, dy)| slow(points, x + dx, y + dy))
                        .any(|[_, first, second]| [first, second] != [own, other]);
                    wrong += usize::from(!changes);
                }
            }
            assert!(exact * 100 > asked * 75, "{size_mm}: {exact} of {asked} exact");
            // The nearest two of nine points are not always those of twenty-five.
            assert!(wrong * 1000 < asked * 5, "{size_mm}: {wrong} of {asked} wrong");
        }
    }

    #[test]
    fn a_net_does_not_depend_on_the_processor() {
        let (points, per_cell) = (Points { cells: 16, seed: 8 }, 16);
        let mut dispatched = vec![Entry::default(); 16 * per_cell * per_cell];
        let mut plain = dispatched.clone();
        let row = |entries| CellRow { points, row: 3, per_cell, entries };
        pulp::Arch::new().dispatch(row(&mut dispatched));
        row(&mut plain).with_simd(pulp::Scalar::new());
        assert!(dispatched == plain && plain.iter().all(|&entry| entry != Entry::default()));
    }

    #[test]
    fn a_net_repeats_after_its_cells_and_not_before() {
        let net = Net::new(1.0, 16, 8.0, 9).expect("it is shown");
        let at = |shift: f32| {
            let places =
                [0.37_f32, 0.11].map(|step| std::array::from_fn(|i| shift + step * i as f32));
            along(&net, &places)
        };
        let [here, there] = [at(0.0), at(16.0)];
        let same = |a: &Lane, b: &Lane| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(same(&here[0], &there[0]) && same(&here[1], &there[1]));
        assert!(!same(&here[0], &at(8.0)[0]) && !same(&here[0], &at(4.0)[0]));
    }
}
