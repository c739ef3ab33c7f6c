//! Smaller levels of the maps that keep the leaf's edge green and its coverage.
//!
//! A plain box filter mixes the ground under the leaf into its edge, and lets what is thin (bristles,
//! skeletons) fade below the threshold of an alpha test until it is gone. So colours, heights and
//! surface are means weighted by coverage, in linear light where they are colours; coverage is scaled on
//! every level so that as large a share of the texels passes the test at one half as on level 0.
//!
//! Source: I. Castaño, "Computing alpha mipmaps", 2010. Departs from it: the scale is found exactly, from
//! the coverages in order, not by bisection.

use palette::{LinSrgb, Srgb};

use super::deep::Deep;
use super::side::{FLAT, SideMaps};
use crate::raster::Grid;
use crate::raster::color::word;

/// The levels below a side, from half its size to a single texel.
#[must_use]
pub fn levels(side: &SideMaps) -> Vec<SideMaps> {
    let share = coverage(&side.base_colour);
    let alpha = match &side.deep {
        Some(deep) => deep.base_colour.map(|c| f32::from(c[3]) / 65535.0),
        None => side.base_colour.map(|c| f32::from(c[3]) / 255.0),
    };
    let mut level = Level { maps: side.clone(), alpha };
    let mut levels = Vec::new();
    while level.alpha.width() > 1 {
        level = level.halved();
        let mut maps = level.maps.clone();
        keep_coverage(&mut maps, &level.alpha, share);
        levels.push(maps);
    }
    levels
}

/// Sides of the levels below a size.
#[must_use]
pub fn sizes(size: usize) -> Vec<usize> {
    std::iter::successors(Some(size / 2), |size| Some(size / 2)).take_while(|&s| s > 0).collect()
}

/// The share of the texels that pass an alpha test at one half.
fn coverage(picture: &Grid<[u8; 4]>) -> f64 {
    let passed = picture.values().iter().filter(|texel| texel[3] >= 128).count();
    passed as f64 / picture.values().len().max(1) as f64
}

/// Scales coverages so that this share of them is at least one half.
fn keep_coverage(maps: &mut SideMaps, alpha: &Grid<f32>, share: f64) {
    let mut ordered: Vec<f32> = alpha.values().to_vec();
    ordered.sort_unstable_by(|a, b| b.total_cmp(a));
    let kept = (share * ordered.len() as f64).round() as usize;
    // The coverage of the last texel that has to pass.
    let least = kept.checked_sub(1).map_or(1.0, |last| ordered[last].max(1e-4));
    // Just over one half as a byte: 128.
    let scale = if kept == 0 { 1.0 } else { 128.0 / 255.0 / least };
    // Of texels that are alike at the threshold only as many pass as have to, spread over the picture.
    let above = ordered.partition_point(|&alpha| alpha > least);
    let mut surplus: Vec<usize> =
        (0..alpha.values().len()).filter(|&i| alpha.values()[i] == least).collect();
    // Multiples of the golden section modulo 2³² leave no large gaps (Knuth's multiplicative hash).
    surplus.sort_unstable_by_key(|&i| ((i as u32).wrapping_mul(0x9E37_79B1), i));
    let surplus = surplus.split_off(kept.saturating_sub(above).min(surplus.len()));
    // What fails on no account passes by rounding.
    let scaled = |alpha: f32, full: f32, fails: f32| {
        let scaled = ((alpha * scale).min(1.0) * full).round();
        if alpha < least { scaled.min(fails) } else { scaled }
    };
    let byte = |alpha: f32| scaled(alpha, 255.0, f32::from(FAILS)) as u8;
    cover(&mut maps.base_colour, alpha, byte, &surplus, FAILS);
    let Some(deep) = &mut maps.deep else { return };
    let fails = u16::from(FAILS) * 257;
    let word = |alpha: f32| scaled(alpha, 65535.0, f32::from(fails)) as u16;
    cover(&mut deep.base_colour, alpha, word, &surplus, fails);
}

/// Writes coverages into a picture; those of `surplus` are no greater than `fails`.
fn cover<T: Copy + Ord>(
    picture: &mut Grid<[T; 4]>,
    alpha: &Grid<f32>,
    scaled: impl Fn(f32) -> T,
    surplus: &[usize],
    fails: T,
) {
    for (texel, &alpha) in picture.values_mut().iter_mut().zip(alpha.values()) {
        texel[3] = scaled(alpha);
    }
    for &i in surplus {
        let texel = &mut picture.values_mut()[i];
        texel[3] = texel[3].min(fails);
    }
}

/// The greatest coverage that fails an alpha test at one half.
const FAILS: u8 = 127;

/// A level before its coverage is scaled.
struct Level {
    maps: SideMaps,
    alpha: Grid<f32>,
}

/// The texels under one texel of the next level: places and weights that sum to one. A side that is not
/// even has three in a row under one.
struct Block {
    items: [(usize, f32); 9],
    len: usize,
}

impl std::ops::Deref for Block {
    type Target = [(usize, f32)];

    fn deref(&self) -> &Self::Target {
        &self.items[..self.len]
    }
}

impl Level {
    fn halved(&self) -> Self {
        let size = self.alpha.width();
        let half = size / 2;
        let spans: Vec<Vec<(usize, f32)>> = (0..half).map(|i| span(i, half, size)).collect();
        let plain = Mean { size, spans: &spans, weights: None };
        let alpha = plain.of(&self.alpha, |block, alpha| mean(block, |i| alpha[i]));
        // Weighted by coverage; where nothing is covered, what was spread there counts evenly.
        let covered = Mean { weights: Some((&self.alpha, &alpha)), ..plain };
        let maps = &self.maps;
        let byte = |block: &Block, plane: &[u8]| mean(block, |i| f32::from(plane[i])).round() as u8;
        let word =
            |block: &Block, plane: &[u16]| mean(block, |i| f32::from(plane[i])).round() as u16;
        let colour = |block: &Block, plane: &[[u8; 3]]| light(block, |i| plane[i]);
        let base = |block: &Block, plane: &[[u8; 4]]| {
            let [r, g, b] = light(block, |i| [plane[i][0], plane[i][1], plane[i][2]]);
            [r, g, b, 0]
        };
        Self {
            maps: SideMaps {
                base_colour: covered.of(&maps.base_colour, base),
                normal: covered.of(&maps.normal, direction),
                height: covered.of(&maps.height, word),
                roughness: covered.of(&maps.roughness, byte),
                occlusion: covered.of(&maps.occlusion, byte),
                transmission: covered.of(&maps.transmission, byte),
                translucency: covered.of(&maps.translucency, colour),
                thickness: plain.of(&maps.thickness, word),
                vein_mask: plain.of(&maps.vein_mask, byte),
                vein_order: plain.of(&maps.vein_order, commonest),
                bump: covered.of(&maps.bump, byte),
                // For people, and no smaller for being far away.
                preview: Grid::from_values(0, 0, Vec::new()),
                enhancement: Grid::from_values(0, 0, Vec::new()),
                deep: maps.deep.as_ref().map(|deep| {
                    let base = |block: &Block, plane: &[[u16; 4]]| {
                        let [r, g, b] = deep_light(block, |i| [0, 1, 2].map(|c| plane[i][c]));
                        [r, g, b, 0]
                    };
                    let colour =
                        |block: &Block, plane: &[[u16; 3]]| deep_light(block, |i| plane[i]);
                    Box::new(Deep {
                        base_colour: covered.of(&deep.base_colour, base),
                        roughness: covered.of(&deep.roughness, word),
                        occlusion: covered.of(&deep.occlusion, word),
                        transmission: covered.of(&deep.transmission, word),
                        translucency: covered.of(&deep.translucency, colour),
                        vein_mask: plain.of(&deep.vein_mask, word),
                    })
                }),
            },
            alpha,
        }
    }
}

/// Blocks of texels, each becoming one.
#[derive(Clone, Copy)]
struct Mean<'a> {
    size: usize,
    spans: &'a [Vec<(usize, f32)>],
    /// Coverage of every texel and of every block, where they count.
    weights: Option<(&'a Grid<f32>, &'a Grid<f32>)>,
}

impl Mean<'_> {
    fn of<T: Sync, U: Copy + Default + Send>(
        &self,
        plane: &Grid<T>,
        of_block: impl Fn(&Block, &[T]) -> U + Sync,
    ) -> Grid<U> {
        // Planes that were not painted stay empty.
        if plane.values().is_empty() {
            return Grid::from_values(0, 0, Vec::new());
        }
        let half = self.spans.len();
        Grid::computed(half, half, |x, y| of_block(&self.block(x, y), plane.values()))
    }

    fn block(&self, column: usize, row: usize) -> Block {
        let mut block = Block { items: [(0, 0.0); 9], len: 0 };
        for &(y, v) in &self.spans[row] {
            for &(x, u) in &self.spans[column] {
                let place = y * self.size + x;
                let own = match self.weights {
                    Some((alpha, total)) if total[(column, row)] > 0.0 => {
                        alpha.values()[place] / total[(column, row)]
                    }
                    _ => 1.0,
                };
                block.items[block.len] = (place, u * v * own);
                block.len += 1;
            }
        }
        block
    }
}

/// What a texel of `half` covers of a row of `size`, which may be odd.
fn span(target: usize, half: usize, size: usize) -> Vec<(usize, f32)> {
    let scale = size as f64 / half as f64;
    let (from, to) = (target as f64 * scale, (target + 1) as f64 * scale);
    (from as usize..size)
        .take_while(|&x| (x as f64) < to - 1e-9)
        .map(|x| {
            let covered = to.min((x + 1) as f64) - from.max(x as f64);
            (x, (covered / scale) as f32)
        })
        .collect()
}

fn mean(block: &Block, value: impl Fn(usize) -> f32) -> f32 {
    block.iter().map(|&(i, weight)| weight * value(i)).sum::<f32>()
}

/// The mean of colours with 8 bits a channel, in linear light.
fn light(block: &Block, value: impl Fn(usize) -> [u8; 3]) -> [u8; 3] {
    let encoded: Srgb<u8> =
        Srgb::from_linear(linear_mean(block, |i| Srgb::from(value(i)).into_linear()));
    encoded.into()
}

/// The same with 16 bits a channel.
fn deep_light(block: &Block, value: impl Fn(usize) -> [u16; 3]) -> [u16; 3] {
    let share = |i: usize| value(i).map(|word| f32::from(word) / 65535.0);
    let encoded: Srgb<f32> =
        Srgb::from_linear(linear_mean(block, |i| Srgb::from(share(i)).into_linear()));
    <[f32; 3]>::from(encoded).map(word)
}

fn linear_mean(block: &Block, light: impl Fn(usize) -> LinSrgb) -> LinSrgb {
    let mut sum = LinSrgb::new(0.0, 0.0, 0.0);
    for &(i, weight) in block.iter() {
        sum += light(i) * weight;
    }
    sum
}

/// The mean of directions, of unit length.
fn direction(block: &Block, normals: &[[u8; 3]]) -> [u8; 3] {
    let sum = [0, 1, 2].map(|k| mean(block, |i| f32::from(normals[i][k]) - 128.0));
    let length = sum.iter().map(|x| x * x).sum::<f32>().sqrt();
    if length < 1.0 { FLAT } else { super::normals::encoded(sum.map(|x| x / length)) }
}

/// The label with the largest share; of equal ones the lowest that is not 0.
fn commonest(block: &Block, labels: &[u8]) -> u8 {
    let share = |label: u8| -> f32 {
        block.iter().filter(|(i, _)| labels[*i] == label).map(|(_, weight)| weight).sum()
    };
    let candidates = block.iter().map(|&(i, _)| labels[i]);
    let rank = |label: u8| (share(label), label != 0, std::cmp::Reverse(label));
    candidates
        .max_by(|&a, &b| {
            let (a, b) = (rank(a), rank(b));
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
        })
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::map::{MapKind, MapSet};
    use super::*;

    /// Green stripes, `on` of every `of` columns, ground spread black on purpose.
    fn stripes(size: usize, on: usize, of: usize) -> SideMaps {
        let mut side = SideMaps::empty(size, MapSet::of(&[]));
        for y in 0..size {
            for x in 0..size {
                side.base_colour[(x, y)] =
                    if (x + y / 3) % of < on { [60, 140, 40, 255] } else { [0, 0, 0, 0] };
            }
        }
        side
    }

    #[test]
    fn thin_stripes_stay_and_keep_their_colour() {
        let side = stripes(256, 2, 9);
        let share = coverage(&side.base_colour);
        let levels = levels(&side);
        assert_eq!(levels.iter().map(SideMaps::size).collect::<Vec<_>>(), sizes(256));
        for level in &levels[..6] {
            let kept = coverage(&level.base_colour);
            // To half a texel: there are only sixteen on the smallest of these levels.
            let half = 0.5 / (level.size() * level.size()) as f64;
            assert!((kept - share).abs() <= half + 1e-9, "{kept} of {share} at {}", level.size());
            for texel in level.base_colour.values().iter().filter(|texel| texel[3] > 0) {
                assert_eq!(texel[..3], [60, 140, 40]);
            }
        }
    }

    #[test]
    fn levels_of_16_bits_are_finer_than_widened_bytes() {
        let mut side = SideMaps::empty(16, MapSet::of(&[MapKind::Roughness]).deep());
        let deep = side.deep.as_mut().expect("16 bits were asked for");
        for (i, texel) in deep.base_colour.values_mut().iter_mut().enumerate() {
            *texel = [20_000 + 7 * i as u16, 30_001, 9, u16::MAX];
        }
        for (i, texel) in deep.roughness.values_mut().iter_mut().enumerate() {
            *texel = 4 * i as u16;
        }
        side.base_colour.values_mut().fill([78, 117, 0, 255]);
        let half = &levels(&side)[0];
        let deep = half.deep.as_ref().expect("levels keep their bits");
        // Texels 0, 1, 16 and 17.
        assert_eq!(deep.roughness[(0, 0)], 34);
        let [red, green, _, alpha] = deep.base_colour[(0, 0)];
        assert!(red.abs_diff(20_060) <= 1 && green.abs_diff(30_001) <= 1, "{red} {green}");
        assert_eq!(alpha / 257, u16::from(half.base_colour[(0, 0)][3]));
    }

    #[test]
    fn odd_sizes_lose_no_texel() {
        for (half, size) in [(2, 5), (3, 7), (1, 3), (4, 8)] {
            let mut share = vec![0.0; size];
            for target in 0..half {
                let span = span(target, half, size);
                let sum: f32 = span.iter().map(|(_, weight)| weight).sum();
                assert!((sum - 1.0).abs() < 1e-6);
                span.iter().for_each(|&(x, weight)| share[x] += weight);
            }
            let each = half as f32 / size as f32;
            assert!(share.iter().all(|s| (s - each).abs() < 1e-6), "{share:?}");
        }
    }

    #[test]
    fn labels_stay_labels() {
        let mut block = Block { items: [(0, 0.25); 9], len: 4 };
        (0..4).for_each(|i| block.items[i].0 = i);
        assert_eq!(commonest(&block, &[0, 0, 0, 3]), 0);
        assert_eq!(commonest(&block, &[0, 3, 0, 3]), 3);
        assert_eq!(commonest(&block, &[5, 2, 0, 0]), 0);
        assert_eq!(commonest(&block, &[5, 5, 2, 2]), 2);
    }
}
