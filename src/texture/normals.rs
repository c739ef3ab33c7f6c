//! Normals from heights by central differences, OpenGL convention: +x right, +y up the picture.

use std::ops::Range;

use super::side::{FLAT, SideMaps};
use super::spans::Spans;
use crate::geometry::whole;
use crate::parallel::for_each_piece;
use crate::raster::Grid;

/// The unit normal of a surface whose height rises by `dx` per unit to the right and by `dy` per
/// unit up the picture.
#[must_use]
#[inline(always)]
pub fn from_slopes(dx: f32, dy: f32) -> [f32; 3] {
    let scale = 1.0 / (1.0 + dx * dx + dy * dy).sqrt();
    [-dx * scale, -dy * scale, scale]
}

/// A unit vector as bytes: 0–255 for −1–1.
#[must_use]
#[inline(always)]
pub fn encoded(normal: [f32; 3]) -> [u8; 3] {
    normal.map(|component| whole::cut(component * 127.5 + 128.0, 255.0) as u8)
}

/// Fills the normals of a side from its heights, where the leaf is; flat elsewhere. One step of a
/// height is `per_texel` texels high.
pub(super) fn fill(side: &mut SideMaps, spans: &Spans, per_texel: f32) {
    let size = side.size();
    let SideMaps { base_colour, height, normal, .. } = side;
    for_each_piece(normal.values_mut(), size, &|y, normals| {
        let colours = base_colour.row(y);
        let columns = spans.row(y);
        pulp::Arch::new().dispatch(Row { y, columns, colours, height, per_texel, normals });
    });
}

/// A row of normals to be filled.
struct Row<'a> {
    y: usize,
    /// Outside of these there is no leaf.
    columns: Range<usize>,
    colours: &'a [[u8; 4]],
    height: &'a Grid<u16>,
    per_texel: f32,
    normals: &'a mut [[u8; 3]],
}

/// Texels taken together.
const LANES: usize = 64;

impl pulp::WithSimd for Row<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { y, columns, colours, height, per_texel, normals } = self;
        let size = normals.len();
        let (row, last) = (height.row(y), height.height() - 1);
        let (above, below) = (height.row(y.saturating_sub(1)), height.row((y + 1).min(last)));
        let across = if y == 0 || y == last { per_texel } else { 0.5 * per_texel };
        let at = |x: usize| encoded_slopes(height, x, y, per_texel);
        normals[..columns.start].fill(FLAT);
        normals[columns.end..].fill(FLAT);
        for start in columns.clone().step_by(LANES) {
            let end = (start + LANES).min(columns.end);
            if colours[start..end].iter().all(|texel| texel[3] == 0) {
                normals[start..end].fill(FLAT);
                continue;
            }
            // Away from the border of the picture, texel by texel alike.
            let inner = start.max(1)..end.min(size.max(1) - 1);
            let mut steep = [[0.0_f32; LANES]; 2];
            if !inner.is_empty() {
                let n = inner.len();
                let left = &row[inner.start - 1..][..n];
                let right = &row[inner.start + 1..][..n];
                let (up, down) = (&above[inner.clone()][..n], &below[inner.clone()][..n]);
                let [dx, dy] = &mut steep;
                for i in 0..n.min(LANES) {
                    let rise = |to: u16, from: u16| (i32::from(to) - i32::from(from)) as f32;
                    dx[i] = rise(right[i], left[i]) * (0.5 * per_texel);
                    dy[i] = rise(up[i], down[i]) * across;
                }
                let mut bytes = [[0_u8; LANES]; 3];
                for i in 0..LANES {
                    let normal = encoded(from_slopes(dx[i], dy[i]));
                    (bytes[0][i], bytes[1][i], bytes[2][i]) = (normal[0], normal[1], normal[2]);
                }
                for (i, texel) in normals[inner.clone()].iter_mut().enumerate() {
                    *texel = [bytes[0][i], bytes[1][i], bytes[2][i]];
                }
            }
            for x in (start..inner.start).chain(inner.end.max(inner.start)..end) {
                normals[x] = at(x);
            }
            for (normal, colour) in normals[start..end].iter_mut().zip(&colours[start..end]) {
                *normal = if colour[3] == 0 { FLAT } else { *normal };
            }
        }
    }
}

fn encoded_slopes(height: &Grid<u16>, x: usize, y: usize, per_texel: f32) -> [u8; 3] {
    let (dx, dy) = slopes(height, x, y, per_texel);
    encoded(from_slopes(dx, dy))
}

/// How much the surface rises from texel to texel, to the right and up the picture. One step of a
/// height is `per_texel` texels high; at the border of the picture the difference is one-sided.
#[inline]
pub(super) fn slopes(height: &Grid<u16>, x: usize, y: usize, per_texel: f32) -> (f32, f32) {
    let ends = |at: usize, size: usize| (at.saturating_sub(1), (at + 1).min(size - 1));
    let ((above, below), (left, right)) = (ends(y, height.height()), ends(x, height.width()));
    let rise = |to: u16, from: u16| (i32::from(to) - i32::from(from)) as f32;
    let dx = rise(height[(right, y)], height[(left, y)]) * per_texel;
    let dy = rise(height[(x, above)], height[(x, below)]) * per_texel;
    (dx / (right - left).max(1) as f32, dy / (below - above).max(1) as f32)
}

#[cfg(test)]
mod tests {
    use super::super::map::MapSet;
    use super::*;

    #[test]
    fn flat_is_the_usual_blue() {
        assert_eq!(encoded(from_slopes(0.0, 0.0)), FLAT);
    }

    #[test]
    fn slopes_lean_away_from_the_rise() {
        let [x, y, z] = from_slopes(2.0, -1.0);
        assert!(x < 0.0 && y > 0.0 && z > 0.0);
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-6);
        assert!((x / z + 2.0).abs() < 1e-6);
        // Steep beyond all measure: still in front.
        assert!(encoded(from_slopes(1e6, 1e6))[2] >= 128);
    }

    #[test]
    fn a_cone_leans_the_right_way_on_every_side() {
        let size = 65;
        let mut side = SideMaps::empty(size, MapSet::ALL);
        side.base_colour.values_mut().fill([0, 0, 0, 255]);
        for y in 0..size {
            for x in 0..size {
                let (dx, dy) = (x as f64 - 32.0, y as f64 - 32.0);
                side.height[(x, y)] = (60_000.0 - 1000.0 * dx.hypot(dy)) as u16;
            }
        }
        // A thousand steps to the texel, each 1/1000 of a texel high: 45°.
        fill(&mut side, &Spans::whole(size), 1e-3);
        let lean = (127.5 * std::f64::consts::FRAC_1_SQRT_2) as u8;
        let at = |x: usize, y: usize| side.normal[(x, y)];
        let near = |a: u8, b: u8| a.abs_diff(b) <= 1;
        // Right of the top the surface faces right, above it (rows run down) it faces up.
        let ([right, _, _], [left, _, _]) = (at(52, 32), at(12, 32));
        assert!(near(right, 128 + lean) && near(left, 128 - lean), "{right} {left}");
        let ([_, up, _], [_, down, _]) = (at(32, 12), at(32, 52));
        assert!(near(up, 128 + lean) && near(down, 128 - lean), "{up} {down}");
        assert!(near(at(52, 32)[2], 128 + lean) && at(32, 32) == FLAT);
    }
}
