//! A leaf's picture from its veins alone, by image processing.
//!
//! Source: Rodkaew et al., "An algorithm for generating vein images for realistic modeling of a leaf",
//! 2002, section 5 and figure 7: the veins are thickened, noise is added, a 3×3 Gaussian smooths it,
//! intensities along 45° emboss it, the picture is inverted and recoloured, and the white veins of the
//! second step are added. Departs from it: the colours are the leaf's own instead of a scan's.

use super::side::SideMaps;
use crate::geometry::noise;
use crate::parallel::for_each_piece;
use crate::raster::Grid;
use crate::raster::color::{byte, word};

/// Veins are thickened by this on either side (mm), at least one pixel.
const THICKENED_MM: f32 = 0.08;

/// Strength of the noise and of the embossing.
const NOISE: f32 = 0.16;
const EMBOSS: f32 = 1.6;

/// How much of the white veins is added at the end.
const ADDED: f32 = 0.28;

/// The pseudo colour of the embossed picture.
const PSEUDO: [f32; 3] = [0.86, 0.92, 0.62];

/// The six pictures of figure 7, as shares of full light.
pub(super) type Steps = [Grid<[f32; 3]>; 6];

/// Figure 7a–f for one side. The side needs its vein mask.
pub(super) fn steps(side: &SideMaps, per_mm: f32, seed: u32) -> Steps {
    let size = side.size();
    let grey = |grid: &Grid<f32>| grid.map(|&v| [v; 3]);
    // 7a: dark veins on white.
    let veins = match &side.deep {
        Some(deep) => deep.vein_mask.map(|&mask| f32::from(mask) / 65535.0),
        None => side.vein_mask.map(|&mask| f32::from(mask) / 255.0),
    };
    let plain = veins.map(|v| 1.0 - v);
    // 7b: thickened, with noise, smoothed.
    let reach = (THICKENED_MM * per_mm).round().clamp(1.0, 16.0) as usize;
    let thick = widened(&widened(&veins, reach, (1, 0)), reach, (0, 1));
    let mut grained = thick;
    let grain = (0.06 * per_mm).max(1.5);
    for (i, value) in grained.values_mut().iter_mut().enumerate() {
        let (x, y) = ((i % size) as f32 / grain, (i / size) as f32 / grain);
        *value = (*value + NOISE * noise::fractal(x, y, 3, seed)).clamp(0.0, 1.0);
    }
    let smooth = blurred(&grained);
    // 7c: intensity stands for thickness; light falls in at 45°.
    let embossed = Grid::computed(size, size, |x, y| {
        let at = |by| smooth.get(x as isize + by, y as isize + by).copied().unwrap_or(0.0);
        (0.5 + EMBOSS * (at(1) - at(-1))).clamp(0.0, 1.0)
    });
    let tinted = embossed.map(|&v| PSEUDO.map(|c| c * v));
    // 7d, 7e: inverted, then in the colours of a leaf, which keep their lightness in the mean.
    let inverted = embossed.map(|&v| 1.0 - v);
    let mut coloured = grey(&inverted);
    let colour = |i: usize| match &side.deep {
        Some(deep) => deep.base_colour.values()[i].map(|word| f32::from(word) / 65535.0),
        None => side.base_colour.values()[i].map(|byte| f32::from(byte) / 255.0),
    };
    for (i, texel) in coloured.values_mut().iter_mut().enumerate() {
        let [r, g, b, _] = colour(i);
        let light = texel[0] / 0.5;
        *texel = [r, g, b].map(|c| (c * (0.35 + 0.65 * light)).min(1.0));
    }
    // 7f: the veins of 7b, white, are added.
    let mut added = coloured.clone();
    for (texel, &vein) in added.values_mut().iter_mut().zip(smooth.values()) {
        *texel = texel.map(|c| (c + ADDED * vein * (1.0 - c)).min(1.0));
    }
    let second = smooth.map(|&v| [1.0 - v; 3]);
    [grey(&plain), second, tinted, grey(&inverted), coloured, added]
}

/// All steps, three in a row.
pub(super) fn montage(steps: &Steps) -> Grid<[u8; 3]> {
    let size = steps[0].width();
    let mut picture = Grid::filled(3 * size, 2 * size, [0; 3]);
    for_each_piece(picture.values_mut(), 3 * size, &|y, row| {
        for (panel, steps) in steps[3 * (y / size)..][..3].iter().enumerate() {
            for (texel, step) in row[panel * size..].iter_mut().zip(steps.row(y % size)) {
                *texel = step.map(byte);
            }
        }
    });
    picture
}

/// Puts the last step in the place of the colour; coverage stays.
pub(super) fn replace(side: &mut SideMaps, steps: &Steps) {
    let texels = side.base_colour.values_mut().iter_mut().zip(steps[5].values());
    for (texel, step) in texels.filter(|(texel, _)| texel[3] > 0) {
        let [r, g, b] = step.map(byte);
        *texel = [r, g, b, texel[3]];
    }
    let Some(deep) = &mut side.deep else { return };
    for (texel, step) in deep.base_colour.values_mut().iter_mut().zip(steps[5].values()) {
        if texel[3] > 0 {
            let [r, g, b] = step.map(word);
            *texel = [r, g, b, texel[3]];
        }
    }
}

/// The greatest value within `reach` pixels along a line of rows or columns.
fn widened(grid: &Grid<f32>, reach: usize, (dx, dy): (isize, isize)) -> Grid<f32> {
    let reach = reach as isize;
    Grid::computed(grid.width(), grid.height(), |x, y| {
        (-reach..=reach)
            .filter_map(|k| grid.get(x as isize + k * dx, y as isize + k * dy))
            .fold(0.0, |a: f32, &b| a.max(b))
    })
}

/// The 3×3 Gaussian: 1 2 1 across and down, over 16.
fn blurred(grid: &Grid<f32>) -> Grid<f32> {
    Grid::computed(grid.width(), grid.height(), |x, y| {
        let here = grid[(x, y)];
        let at = |dx, dy| grid.get(x as isize + dx, y as isize + dy).copied().unwrap_or(here);
        let row = |dy| at(-1, dy) + 2.0 * at(0, dy) + at(1, dy);
        (row(-1) + 2.0 * row(0) + row(1)) / 16.0
    })
}

#[cfg(test)]
mod tests {
    use super::super::map::MapSet;
    use super::*;

    #[test]
    fn a_constant_stays_under_the_gaussian_and_a_point_becomes_its_weights() {
        let flat = Grid::filled(5, 5, 0.4);
        assert!(blurred(&flat).values().iter().all(|v| (v - 0.4).abs() < 1e-6));
        let mut point = Grid::filled(5, 5, 0.0);
        point[(2, 2)] = 16.0;
        let spread = blurred(&point);
        assert_eq!((spread[(2, 2)], spread[(1, 2)], spread[(1, 1)]), (4.0, 2.0, 1.0));
    }

    #[test]
    fn with_sixteen_bits_nothing_is_made_from_eight() {
        let size = 8;
        let maps = MapSet::ALL.deep();
        let mut side = SideMaps::empty(size, maps);
        side.base_colour.values_mut().fill([80, 120, 50, 255]);
        let deep = side.deep.as_mut().expect("16 bits");
        // Between two steps of 8 bits.
        deep.base_colour.values_mut().fill([80 * 257 + 100, 120 * 257, 50 * 257, u16::MAX]);
        let [.., coloured, _] = steps(&side, 12.0, 1);
        side.deep.as_mut().expect("16 bits").base_colour.values_mut().fill([80 * 257; 4]);
        let [.., other, _] = steps(&side, 12.0, 1);
        assert!(coloured[(3, 3)][0] > other[(3, 3)][0]);
        // A vein of less than a step of 8 bits shows.
        side.deep.as_mut().expect("16 bits").vein_mask.values_mut().fill(100);
        let [plain, ..] = steps(&side, 12.0, 1);
        assert!(plain[(3, 3)][0] < 1.0);
    }

    #[test]
    fn the_steps_are_those_of_the_paper() {
        let size = 32;
        let mut side = SideMaps::empty(size, MapSet::ALL);
        side.base_colour.values_mut().fill([80, 120, 50, 255]);
        for i in 0..size {
            side.vein_mask[(16, i)] = 255;
        }
        let [plain, thick, embossed, inverted, coloured, added] = steps(&side, 12.0, 1);
        assert_eq!((plain[(16, 9)], plain[(3, 9)]), ([0.0; 3], [1.0; 3]));
        // Thicker than it was.
        assert!(thick[(15, 9)][0] < 0.6 && thick[(3, 9)][0] > 0.6);
        for y in 4..28 {
            for x in 4..28 {
                let [r, _, _] = embossed[(x, y)];
                assert!((r / PSEUDO[0] + inverted[(x, y)][0] - 1.0).abs() < 1e-5);
                assert!(added[(x, y)][1] >= coloured[(x, y)][1]);
            }
        }
        // Light from one corner: one flank bright, the other dark.
        assert!(embossed[(14, 16)][0] > embossed[(18, 16)][0] + 0.3);
        assert!(added[(16, 16)][2] > coloured[(16, 16)][2] + 0.1);
    }
}
