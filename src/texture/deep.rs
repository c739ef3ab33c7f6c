//! Maps with 16 bits a channel.
//!
//! Heights and thickness always have them, and fine normals are made from heights anew. Colours and
//! shares are painted as real numbers; where 16 bits are asked for they are kept so, beside the 8 bits
//! that the preview and the cards take, on atlases and smaller levels too.

use super::dilation::Ground;
use super::map::{MapKind, MapSet};
use super::normals;
use super::samples::{in_all, words, words_of};
use super::side::SideMaps;
use crate::raster::Grid;

/// The planes of one side with 16 bits a channel; each has its map's size, or none.
#[derive(Debug, Clone, PartialEq)]
pub struct Deep {
    /// Base colour and coverage.
    pub base_colour: Grid<[u16; 4]>,
    /// Perceptual roughness.
    pub roughness: Grid<u16>,
    /// Ambient light that reaches the surface.
    pub occlusion: Grid<u16>,
    /// Share of the scattered light that comes out on the far side.
    pub transmission: Grid<u16>,
    /// Colour of the light that comes through.
    pub translucency: Grid<[u16; 3]>,
    /// How much of the texel is vein.
    pub vein_mask: Grid<u16>,
}

impl Deep {
    /// The planes of no leaf; `None` where 16 bits are not wanted.
    pub(super) fn empty(size: usize, maps: MapSet) -> Option<Box<Self>> {
        fn plane<T: Clone>(size: usize, maps: MapSet, map: MapKind, value: T) -> Grid<T> {
            let side = if maps.has(map) { size } else { 0 };
            Grid::filled(side, side, value)
        }
        maps.is_deep().then(|| {
            Box::new(Self {
                base_colour: Grid::filled(size, size, [0; 4]),
                roughness: plane(size, maps, MapKind::Roughness, 0),
                occlusion: plane(size, maps, MapKind::AmbientOcclusion, u16::MAX),
                transmission: plane(size, maps, MapKind::Orm, 0),
                translucency: plane(size, maps, MapKind::Translucency, [0; 3]),
                vein_mask: plane(size, maps, MapKind::VeinMask, 0),
            })
        })
    }

    /// As [`SideMaps::unpainted`].
    pub(super) fn unpainted(
        used: Option<Box<Self>>,
        size: usize,
        maps: MapSet,
    ) -> Option<Box<Self>> {
        let kept = |map: MapKind| if maps.has(map) { size } else { 0 };
        let used = used.or_else(|| Self::empty(0, maps)).filter(|_| maps.is_deep())?;
        Some(Box::new(Self {
            base_colour: used.base_colour.or_new(size),
            roughness: used.roughness.or_new(kept(MapKind::Roughness)),
            occlusion: used.occlusion.or_new(kept(MapKind::AmbientOcclusion)),
            transmission: used.transmission.or_new(kept(MapKind::Orm)),
            translucency: used.translucency.or_new(kept(MapKind::Translucency)),
            vein_mask: used.vein_mask.or_new(kept(MapKind::VeinMask)),
        }))
    }

    /// As [`SideMaps::spread`].
    pub(super) fn spread(&mut self, ground: Ground<'_>) {
        ground.fill(self.base_colour.values_mut(), [0; 4], |[r, g, b, _]| [r, g, b, 0]);
        ground.fill(self.roughness.values_mut(), 0, |value| value);
        ground.fill(self.transmission.values_mut(), 0, |value| value);
        ground.fill(self.translucency.values_mut(), [0; 3], |value| value);
    }

    /// The bytes of a map, row by row, high bytes first; `None` for one that has no plane here.
    fn samples(&self, map: MapKind) -> Option<Vec<u8>> {
        let planes = [&self.occlusion, &self.roughness, &self.transmission].map(Grid::values);
        let [occlusion, roughness, transmission] = planes;
        Some(match map {
            MapKind::BaseColour => words_of(&self.base_colour, |texel| texel),
            MapKind::Opacity => words_of(&self.base_colour, |[.., alpha]| [alpha; 2]),
            MapKind::Roughness => words_of(&self.roughness, |rough| [rough]),
            MapKind::Gloss => words_of(&self.roughness, |rough| [u16::MAX - rough]),
            MapKind::AmbientOcclusion => words_of(&self.occlusion, |open| [open]),
            MapKind::Translucency => words_of(&self.translucency, |texel| texel),
            MapKind::VeinMask => words_of(&self.vein_mask, |cover| [cover]),
            MapKind::MaskMap => {
                words(in_all(&planes[..2]), |i| [0, occlusion[i], 1 << 15, u16::MAX - roughness[i]])
            }
            MapKind::Orm => {
                words(in_all(&planes), |i| [occlusion[i], roughness[i], 0, transmission[i]])
            }
            _ => return None,
        })
    }
}

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
            _ => self.deep.as_ref().and_then(|deep| deep.samples(map)).unwrap_or_else(|| {
                let bytes = self.samples(map);
                words(bytes.len(), |i| [u16::from_be_bytes([bytes[i]; 2])])
            }),
        }
    }

    fn fine_normals(&self, per_texel: f32, y_down: bool) -> Vec<u8> {
        let size = self.size();
        words(size * size, |i| {
            let (x, y) = (i % size, i / size);
            let covered = self.base_colour[(x, y)][3] > 0;
            let (dx, dy) =
                if covered { normals::slopes(&self.height, x, y, per_texel) } else { (0.0, 0.0) };
            let normal = normals::from_slopes(dx, dy);
            let [nx, ny, nz] = normal.map(|n| (n * 32767.5 + 32768.0) as u16);
            [nx, if y_down { u16::MAX - ny } else { ny }, nz]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_map_of_which_a_plane_was_not_painted_is_empty() {
        let maps = MapSet::of(&[MapKind::AmbientOcclusion]);
        for maps in [maps, maps.deep()] {
            let side = SideMaps::empty(8, maps);
            for map in [MapKind::Orm, MapKind::MaskMap] {
                for asked in [8, 16] {
                    assert!(side.samples_of(map, asked, 1.0).is_empty(), "{map:?} {asked}");
                }
            }
            assert_eq!(side.samples(MapKind::AmbientOcclusion).len(), 64);
        }
    }
}
