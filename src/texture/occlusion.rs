//! Ambient occlusion from heights: how much of an even sky the relief hides.
//!
//! In eight directions the horizon is the steepest slope up to a few distances; with the surface
//! lit after the cosine, a horizon at the angle h leaves cos² h of a direction's light, and
//! sin² h = s² / (1 + s²) for a slope s (L. Bavoil, M. Sainz, "Image-space horizon-based ambient
//! occlusion", 2008, with the normal upright). Row by row and tap by tap, so that the compiler can
//! take several texels at once.

use std::ops::Range;

use rayon::prelude::*;

use super::side::SideMaps;
use super::spans::Spans;
use crate::raster::Grid;
use crate::raster::color::{byte, word};

/// Where the horizon is looked for (mm): the flank of a vein, and the width of an areole.
const REACH_MM: [f32; 2] = [0.12, 0.45];

/// Directions as whole texels; diagonals are longer by √2.
const DIRECTIONS: [(i32, i32); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// Real grooves are steeper than a height map of few texels can be: their slopes count more.
const EMPHASIS: f32 = 1.6;

/// Fills the occlusion of a side from its heights where the leaf is; with 255 elsewhere. One step of a
/// height is `per_texel` texels high, and `per_mm` texels make a millimetre.
pub(super) fn fill(side: &mut SideMaps, spans: &Spans, per_texel: f32, per_mm: f32) {
    let size = side.size();
    let steps = REACH_MM.map(|mm| ((mm * per_mm + 0.5) as usize).clamp(1, size.max(2) - 1));
    let SideMaps { base_colour, height, occlusion, deep, .. } = side;
    fill_plane(occlusion, (base_colour, height, spans), steps, per_texel, byte);
    if let Some(deep) = deep {
        fill_plane(&mut deep.occlusion, (base_colour, height, spans), steps, per_texel, word);
    }
}

/// Fills a plane whose values `of` shares are, where the leaf is.
fn fill_plane<T: Copy + Send>(
    occlusion: &mut Grid<T>,
    (base_colour, height, spans): (&Grid<[u8; 4]>, &Grid<u16>, &Spans),
    steps: [usize; 2],
    per_texel: f32,
    of: impl Fn(f32) -> T + Copy + Sync,
) {
    let size = height.width();
    let fill_row = |sum: &mut Vec<f32>, (y, row): (usize, &mut [T])| {
        let (colours, columns) = (base_colour.row(y), spans.row(y));
        row[..columns.start].fill(of(1.0));
        row[columns.end..].fill(of(1.0));
        if columns.is_empty() {
            return;
        }
        let work = Row { y, columns, height, steps, per_texel, sum, colours, row, of };
        pulp::Arch::new().dispatch(work);
    };
    occlusion
        .values_mut()
        .par_chunks_mut(size.max(1))
        .enumerate()
        .for_each_init(|| vec![0.0; size], fill_row);
}

/// Columns of a row of which is found how much light the relief hides, in all directions.
struct Row<'a, T, F> {
    y: usize,
    columns: Range<usize>,
    height: &'a Grid<u16>,
    steps: [usize; 2],
    per_texel: f32,
    /// For what is hidden, not kept.
    sum: &'a mut [f32],
    colours: &'a [[u8; 4]],
    row: &'a mut [T],
    of: F,
}

impl<T: Copy, F: Fn(f32) -> T> pulp::WithSimd for Row<'_, T, F> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { y, columns, height, steps, per_texel, sum, colours, row, of } = self;
        let (first, end, size) = (columns.start, columns.end, height.width());
        sum[first..end].fill(0.0);
        for (dx, dy) in DIRECTIONS {
            let length = if dx * dy == 0 { 1.0 } else { std::f32::consts::SQRT_2 };
            // Where the farther look stays in the picture the nearer one does.
            let reach = |step: usize| {
                let (shift, line) = (step as i32 * dx, y as i32 + step as i32 * dy);
                let inside = (0..height.height() as i32).contains(&line);
                let from = (first as i32).max(-shift);
                let to = (end as i32).min(size as i32 - shift);
                inside.then_some((from.max(0) as usize..to.max(from).max(0) as usize, line, shift))
            };
            let scales = steps.map(|step| EMPHASIS * per_texel / (step as f32 * length));
            let looks = steps.map(reach);
            match looks {
                [Some((near, near_line, near_shift)), Some((far, far_line, far_shift))]
                    if !far.is_empty() =>
                {
                    let part = |line: i32, shift: i32, columns: &Range<usize>| {
                        let start = (columns.start as i32 + shift) as usize;
                        &height.row(line as usize)[start..start + columns.len()]
                    };
                    let one = |columns: Range<usize>, sum: &mut [f32]| {
                        let others = part(near_line, near_shift, &columns);
                        let own = &height.row(y)[columns.clone()];
                        add_horizon(&mut sum[columns], own, [others, others], [scales[0]; 2]);
                    };
                    one(near.start..far.start.max(near.start), sum);
                    one(far.end.min(near.end)..near.end, sum);
                    let others =
                        [part(near_line, near_shift, &far), part(far_line, far_shift, &far)];
                    let own = &height.row(y)[far.clone()];
                    add_horizon(&mut sum[far], own, others, scales);
                }
                [Some((near, line, shift)), _] if !near.is_empty() => {
                    let start = (near.start as i32 + shift) as usize;
                    let others = &height.row(line as usize)[start..start + near.len()];
                    let own = &height.row(y)[near.clone()];
                    add_horizon(&mut sum[near], own, [others, others], [scales[0]; 2]);
                }
                _ => {}
            }
        }
        let (sum, colours) = (&sum[first..end], &colours[first..end]);
        for ((texel, colour), hidden) in row[first..end].iter_mut().zip(colours).zip(sum) {
            let open = of(1.0 - hidden / DIRECTIONS.len() as f32);
            *texel = if colour[3] > 0 { open } else { of(1.0) };
        }
    }
}

/// Adds what the horizon hides in one direction, from the heights at two distances.
#[inline(always)]
fn add_horizon(sum: &mut [f32], own: &[u16], others: [&[u16]; 2], scales: [f32; 2]) {
    let n = sum.len();
    let (own, near, far) = (&own[..n], &others[0][..n], &others[1][..n]);
    for i in 0..n {
        let rise = |other: u16| (i32::from(other) - i32::from(own[i])) as f32;
        let (near, far) = (rise(near[i]) * scales[0], rise(far[i]) * scales[1]);
        // Not `max`, which asks for what is not a number.
        let higher = if near > far { near } else { far };
        let slope = if higher > 0.0 { higher } else { 0.0 };
        let slope2 = slope * slope;
        sum[i] += slope2 / (1.0 + slope2);
    }
}

#[cfg(test)]
mod tests {
    use super::super::map::MapSet;
    use super::*;

    #[test]
    fn a_groove_is_darker_than_a_plain_and_a_ridge_is_not() {
        let size = 33;
        let mut side = SideMaps::empty(size, MapSet::ALL);
        side.base_colour.values_mut().fill([0, 0, 0, 255]);
        for y in 0..size {
            side.height[(10, y)] = 30_000;
            side.height[(22, y)] = 35_000;
        }
        fill(&mut side, &Spans::whole(size), 1e-3, 10.0);
        let at = |x: usize| side.occlusion[(x, 16)];
        assert!(at(10) < 200 && at(22) == 255 && at(16) == 255, "{} {}", at(10), at(22));
        assert!(at(21) < 255);
    }

    #[test]
    fn a_wall_on_one_side_hides_half_of_the_sky_at_most() {
        let mut side = SideMaps::empty(16, MapSet::ALL);
        side.base_colour.values_mut().fill([0, 0, 0, 255]);
        for y in 0..16 {
            for x in 8..16 {
                side.height[(x, y)] = 65_535;
            }
        }
        fill(&mut side, &Spans::whole(16), 1.0, 10.0);
        // Three of eight directions end at the wall; none of them can see past it.
        let expected = (255.5 - 255.0 * 3.0 / 8.0) as u8;
        assert!(side.occlusion[(7, 8)].abs_diff(expected) <= 1, "{}", side.occlusion[(7, 8)]);
    }
}
