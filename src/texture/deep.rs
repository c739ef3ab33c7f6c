//! Maps with 16 bits a channel.
//!
//! Heights and thickness are kept with 16 bits, and normals are made from heights anew, so these three
//! are as fine as the numbers say. The other planes are kept with 8 bits and only widened (0–255 to
//! 0–65535, ends on ends): for programs that take nothing else.

use rayon::prelude::*;

use super::map::MapKind;
use super::normals;
use super::side::SideMaps;

impl MapKind {
    /// Bits of a channel when `asked` (8 or 16) are wanted: heights and thickness always have 16, orders,
    /// Foster's bump and what is for people 8.
    #[must_use]
    pub const fn bits_of(self, asked: u8) -> u8 {
        match self {
            Self::VeinOrder | Self::Bump | Self::Preview | Self::Enhancement => 8,
            _ if asked == 16 => 16,
            other => other.bits(),
        }
    }
}

impl SideMaps {
    /// The bytes of a map with [`MapKind::bits_of`] `asked` bits, laid out as in [`Self::samples`]. One
    /// step of a height is `per_texel` texels high.
    #[must_use]
    pub fn samples_of(&self, map: MapKind, asked: u8, per_texel: f32) -> Vec<u8> {
        if map.bits_of(asked) == map.bits() {
            return self.samples(map);
        }
        match map {
            MapKind::Normal if self.has(MapKind::Height) => self.fine_normals(per_texel, false),
            MapKind::NormalDx if self.has(MapKind::Height) => self.fine_normals(per_texel, true),
            _ => self.samples(map).into_par_iter().flat_map_iter(|byte| [byte, byte]).collect(),
        }
    }

    fn fine_normals(&self, per_texel: f32, y_down: bool) -> Vec<u8> {
        let size = self.size();
        let rows = (0..size).into_par_iter().map(|y| {
            let mut row = Vec::with_capacity(6 * size);
            for x in 0..size {
                let covered = self.base_colour[(x, y)][3] > 0;
                let (dx, dy) = if covered {
                    normals::slopes(&self.height, x, y, per_texel)
                } else {
                    (0.0, 0.0)
                };
                let [nx, ny, nz] = normals::from_slopes(dx, dy);
                let [nx, ny, nz] = [nx, ny, nz].map(|n| (n * 32767.5 + 32768.0) as u16);
                let ny = if y_down { u16::MAX - ny } else { ny };
                row.extend([nx, ny, nz].into_iter().flat_map(u16::to_be_bytes));
            }
            row
        });
        rows.flatten_iter().collect()
    }
}
