//! Normals from heights by central differences, OpenGL convention: +x right, +y up the picture.

use rayon::prelude::*;

use super::side::{FLAT, SideMaps};

/// The unit normal of a surface whose height rises by `dx` per unit to the right and by `dy` per
/// unit up the picture.
#[must_use]
#[inline]
pub fn from_slopes(dx: f32, dy: f32) -> [f32; 3] {
    let scale = 1.0 / (1.0 + dx * dx + dy * dy).sqrt();
    [-dx * scale, -dy * scale, scale]
}

/// A unit vector as bytes: 0–255 for −1–1.
#[must_use]
#[inline]
pub fn encoded(normal: [f32; 3]) -> [u8; 3] {
    normal.map(|component| (component * 127.5 + 128.0) as u8)
}

/// Fills the normals of a side from its heights, where the leaf is; flat elsewhere. One step of a
/// height is `per_texel` texels high.
pub(super) fn fill(side: &mut SideMaps, per_texel: f32) {
    let size = side.size();
    let SideMaps { base_colour, height, normal, .. } = side;
    normal.values_mut().par_chunks_mut(size.max(1)).enumerate().for_each(|(y, row)| {
        // At the border of the picture the difference is one-sided.
        let (above, below) = (y.saturating_sub(1), (y + 1).min(size - 1));
        let per_y = per_texel / (below - above).max(1) as f32;
        let [north, here, south] = [above, y, below].map(|y| height.row(y));
        let covered = base_colour.row(y);
        for x in 0..size {
            if covered[x][3] == 0 {
                row[x] = FLAT;
                continue;
            }
            let (left, right) = (x.saturating_sub(1), (x + 1).min(size - 1));
            let per_x = per_texel / (right - left).max(1) as f32;
            let rise = |to: u16, from: u16| (i32::from(to) - i32::from(from)) as f32;
            let dx = rise(here[right], here[left]) * per_x;
            let dy = rise(north[x], south[x]) * per_y;
            row[x] = encoded(from_slopes(dx, dy));
        }
    });
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
        fill(&mut side, 1e-3);
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
