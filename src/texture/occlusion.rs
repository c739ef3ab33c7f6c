//! Ambient occlusion from heights: how much of an even sky the relief hides.
//!
//! In eight directions the horizon is the steepest slope up to a few distances; with the surface
//! lit after the cosine, a horizon at the angle h leaves cos² h of a direction's light, and
//! sin² h = s² / (1 + s²) for a slope s (L. Bavoil, M. Sainz, "Image-space horizon-based ambient
//! occlusion", 2008, with the normal upright). Row by row and tap by tap, so that the compiler can
//! take several texels at once.

use rayon::prelude::*;

use super::side::SideMaps;

/// Where the horizon is looked for (mm): the flank of a vein, and the width of an areole.
const REACH_MM: [f32; 2] = [0.12, 0.45];

/// Directions as whole texels; diagonals are longer by √2.
const DIRECTIONS: [(i32, i32); 8] =
    [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// Real grooves are steeper than a height map of few texels can be: their slopes count more.
const EMPHASIS: f32 = 1.6;

/// Fills the occlusion of a side from its heights where the leaf is; 255 elsewhere. One step of a
/// height is `per_texel` texels high, and `per_mm` texels make a millimetre.
pub(super) fn fill(side: &mut SideMaps, per_texel: f32, per_mm: f32) {
    let size = side.size();
    let SideMaps { base_colour, height, occlusion, .. } = side;
    let steps = REACH_MM.map(|mm| ((mm * per_mm + 0.5) as usize).clamp(1, size.max(2) - 1));
    let fill_row = |(horizon, sum): &mut (Vec<f32>, Vec<f32>), (y, row): (usize, &mut [u8])| {
        let covered = |texel: &[u8; 4]| texel[3] > 0;
        let colours = base_colour.row(y);
        let Some(first) = colours.iter().position(covered) else { return };
        let last = colours.iter().rposition(covered).expect("there is a first");
        let here = height.row(y);
        sum[first..=last].fill(0.0);
        for (dx, dy) in DIRECTIONS {
            horizon[first..=last].fill(0.0);
            for step in steps {
                let length =
                    step as f32 * if dx * dy == 0 { 1.0 } else { std::f32::consts::SQRT_2 };
                let scale = EMPHASIS * per_texel / length;
                let shift = step as isize * dx as isize;
                let line = y as isize + step as isize * dy as isize;
                if line < 0 || line >= size as isize {
                    continue;
                }
                let there = height.row(line as usize);
                let from = (first as isize).max(-shift) as usize;
                let to = ((last + 1) as isize).min(size as isize - shift).max(0) as usize;
                if from >= to {
                    continue;
                }
                let (start, end) = (from as isize + shift, to as isize + shift);
                let others = &there[start as usize..end as usize];
                let own = &here[from..to];
                for ((horizon, &own), &other) in horizon[from..to].iter_mut().zip(own).zip(others) {
                    let slope = (i32::from(other) - i32::from(own)) as f32 * scale;
                    *horizon = horizon.max(slope);
                }
            }
            for (sum, &slope) in sum[first..=last].iter_mut().zip(&horizon[first..=last]) {
                *sum += slope * slope / (1.0 + slope * slope);
            }
        }
        for x in first..=last {
            if covered(&colours[x]) {
                row[x] = (255.5 - 255.0 * sum[x] / DIRECTIONS.len() as f32) as u8;
            }
        }
    };
    occlusion
        .values_mut()
        .par_chunks_mut(size.max(1))
        .enumerate()
        .for_each_init(|| (vec![0.0; size], vec![0.0; size]), fill_row);
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
        fill(&mut side, 1e-3, 10.0);
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
        fill(&mut side, 1.0, 10.0);
        // Three of eight directions end at the wall; none of them can see past it.
        let expected = (255.5 - 255.0 * 3.0 / 8.0) as u8;
        assert!(side.occlusion[(7, 8)].abs_diff(expected) <= 1, "{}", side.occlusion[(7, 8)]);
    }
}
