//! The maps of one side, as planes of pixels.

use super::deep::Deep;
use super::dilation::Ground;
use super::map::{MapKind, MapSet, Outside};
use super::samples;
use crate::raster::Grid;

/// The normal of a plain surface.
pub(super) const FLAT: [u8; 3] = [128, 128, 255];

/// The plain blade, in heights and in Foster's bump.
const PLAIN_HEIGHT: u16 = 1 << 15;
const PLAIN_BUMP: u8 = 128;

/// The maps of one side.
///
/// # Guarantees
///
/// Planes that were asked for are squares of one size, but for the pictures for people, `enhancement` and
/// `preview`; the others are empty.
#[derive(Debug, Clone, PartialEq)]
pub struct SideMaps {
    /// Base colour, sRGB, and coverage as straight alpha. Under alpha 0 the colour is that of the
    /// nearest fully covered texel. Always there.
    pub base_colour: Grid<[u8; 4]>,
    /// Unit normal in tangent space, OpenGL (+y up the picture), 0–255 for −1–1.
    pub normal: Grid<[u8; 3]>,
    /// Height above the lowest place the map can show; 65535 is `TextureSet::height_range_mm`.
    pub height: Grid<u16>,
    /// Perceptual roughness.
    pub roughness: Grid<u8>,
    /// Ambient light that reaches the surface.
    pub occlusion: Grid<u8>,
    /// Share of the scattered light that comes out on the far side.
    pub transmission: Grid<u8>,
    /// Colour of the light that comes through, sRGB.
    pub translucency: Grid<[u8; 3]>,
    /// Thickness; 65535 is `TextureSet::thickness_range_mm`.
    pub thickness: Grid<u16>,
    /// How much of the texel is vein.
    pub vein_mask: Grid<u8>,
    /// Order of the vein, 0 for none.
    pub vein_order: Grid<u8>,
    /// Foster's bump: red channel, blade at 128.
    pub bump: Grid<u8>,
    /// Upper side, lower side and against the light, side by side; the lower side has none.
    pub preview: Grid<[u8; 3]>,
    /// Six steps of enhancement, three in a row.
    pub enhancement: Grid<[u8; 3]>,
    /// Colours and shares with 16 bits a channel, where they were asked for.
    pub deep: Option<Box<Deep>>,
}

impl SideMaps {
    /// The maps of no leaf at all: clear, flat.
    #[must_use]
    pub fn empty(size: usize, maps: MapSet) -> Self {
        fn plane<T: Clone>(size: usize, maps: MapSet, map: MapKind, value: T) -> Grid<T> {
            let side = if maps.has(map) { size } else { 0 };
            Grid::filled(side, side, value)
        }
        Self {
            base_colour: Grid::filled(size, size, [0; 4]),
            normal: plane(size, maps, MapKind::Normal, FLAT),
            height: plane(size, maps, MapKind::Height, PLAIN_HEIGHT),
            roughness: plane(size, maps, MapKind::Roughness, 0),
            occlusion: plane(size, maps, MapKind::AmbientOcclusion, u8::MAX),
            transmission: plane(size, maps, MapKind::Orm, 0),
            translucency: plane(size, maps, MapKind::Translucency, [0; 3]),
            thickness: plane(size, maps, MapKind::Thickness, 0),
            vein_mask: plane(size, maps, MapKind::VeinMask, 0),
            vein_order: plane(size, maps, MapKind::VeinOrder, 0),
            bump: plane(size, maps, MapKind::Bump, PLAIN_BUMP),
            // Made from the others at the end.
            preview: Grid::filled(0, 0, [0; 3]),
            enhancement: Grid::filled(0, 0, [0; 3]),
            deep: Deep::empty(size, maps),
        }
    }

    /// The maps of a leaf that is yet to be painted, with anything in them: planes of `used` that fit, else new
    /// ones.
    pub(super) fn unpainted(used: Option<Self>, size: usize, maps: MapSet) -> Self {
        let used = used.unwrap_or_else(|| Self::empty(0, maps));
        let kept = |map: MapKind| if maps.has(map) { size } else { 0 };
        Self {
            base_colour: used.base_colour.or_new(size),
            normal: used.normal.or_new(kept(MapKind::Normal)),
            height: used.height.or_new(kept(MapKind::Height)),
            roughness: used.roughness.or_new(kept(MapKind::Roughness)),
            occlusion: used.occlusion.or_new(kept(MapKind::AmbientOcclusion)),
            transmission: used.transmission.or_new(kept(MapKind::Orm)),
            translucency: used.translucency.or_new(kept(MapKind::Translucency)),
            thickness: used.thickness.or_new(kept(MapKind::Thickness)),
            vein_mask: used.vein_mask.or_new(kept(MapKind::VeinMask)),
            vein_order: used.vein_order.or_new(kept(MapKind::VeinOrder)),
            bump: used.bump.or_new(kept(MapKind::Bump)),
            preview: used.preview.or_new(0),
            enhancement: used.enhancement.or_new(0),
            deep: Deep::unpainted(used.deep, size, maps),
        }
    }

    /// Side of the pictures (pixels).
    #[must_use]
    pub fn size(&self) -> usize {
        self.base_colour.width()
    }

    /// Whether this map was painted.
    #[must_use]
    pub fn has(&self, map: MapKind) -> bool {
        self.dimensions(map).0 > 0
    }

    /// Width and height of a map (pixels); 0 for one that was not painted.
    #[must_use]
    pub fn dimensions(&self, map: MapKind) -> (usize, usize) {
        fn of<T>(plane: &Grid<T>) -> (usize, usize) {
            (plane.width(), plane.height())
        }
        match map {
            MapKind::BaseColour | MapKind::Opacity => of(&self.base_colour),
            MapKind::Normal | MapKind::NormalDx => of(&self.normal),
            MapKind::Height => of(&self.height),
            MapKind::Roughness | MapKind::Gloss | MapKind::MaskMap => of(&self.roughness),
            MapKind::AmbientOcclusion => of(&self.occlusion),
            MapKind::Orm => of(&self.transmission),
            MapKind::Translucency => of(&self.translucency),
            MapKind::Thickness => of(&self.thickness),
            MapKind::VeinMask => of(&self.vein_mask),
            MapKind::VeinOrder => of(&self.vein_order),
            MapKind::Bump => of(&self.bump),
            MapKind::Preview => of(&self.preview),
            MapKind::Enhancement => of(&self.enhancement),
        }
    }

    /// The bytes of a map, row by row from the top, channels side by side, 16-bit numbers with the
    /// high byte first; the layout is [`MapKind::channels`] and [`MapKind::bits`]. Empty for a map
    /// that was not painted.
    #[must_use]
    pub fn samples(&self, map: MapKind) -> Vec<u8> {
        match map {
            MapKind::BaseColour => self.base_colour.values().as_flattened().to_vec(),
            MapKind::Opacity => samples::of_plane(&self.base_colour, |&[.., alpha]| [alpha, alpha]),
            MapKind::Normal => self.normal.values().as_flattened().to_vec(),
            MapKind::NormalDx => samples::of_plane(&self.normal, |&[x, y, z]| [x, u8::MAX - y, z]),
            MapKind::Height => samples::of_plane(&self.height, |height| height.to_be_bytes()),
            MapKind::Roughness => self.roughness.values().to_vec(),
            MapKind::Gloss => {
                samples::of_plane(&self.roughness, |&roughness| [u8::MAX - roughness])
            }
            MapKind::AmbientOcclusion => self.occlusion.values().to_vec(),
            MapKind::MaskMap => {
                let planes = [&self.occlusion, &self.roughness].map(Grid::values);
                let [occlusion, roughness] = planes;
                samples::packed(samples::in_all(&planes), |texels, bytes| {
                    let planes = occlusion[texels.clone()].iter().zip(&roughness[texels]);
                    for (bytes, (&open, &rough)) in bytes.iter_mut().zip(planes) {
                        *bytes = [0, open, 128, u8::MAX - rough];
                    }
                })
            }
            MapKind::Orm => {
                let planes =
                    [&self.occlusion, &self.roughness, &self.transmission].map(Grid::values);
                let [occlusion, roughness, transmission] = planes;
                samples::packed(samples::in_all(&planes), |texels, bytes| {
                    let surface = occlusion[texels.clone()].iter().zip(&roughness[texels.clone()]);
                    let planes = surface.zip(&transmission[texels]);
                    for (bytes, ((&open, &rough), &through)) in bytes.iter_mut().zip(planes) {
                        *bytes = [open, rough, 0, through];
                    }
                })
            }
            MapKind::Translucency => self.translucency.values().as_flattened().to_vec(),
            MapKind::Thickness => {
                samples::of_plane(&self.thickness, |thickness| thickness.to_be_bytes())
            }
            MapKind::VeinMask => self.vein_mask.values().to_vec(),
            MapKind::VeinOrder => self.vein_order.values().to_vec(),
            MapKind::Bump => samples::of_plane(&self.bump, |&height| [height, 0, 0]),
            MapKind::Preview => self.preview.values().as_flattened().to_vec(),
            MapKind::Enhancement => self.enhancement.values().as_flattened().to_vec(),
        }
    }

    /// Takes the leaf from a texel: what is spread over the empty ones is spread later.
    pub(super) fn clear(&mut self, i: usize) {
        fn put<T>(plane: &mut Grid<T>, i: usize, value: T) {
            // A plane that is not kept has no texels.
            if let Some(texel) = plane.values_mut().get_mut(i) {
                *texel = value;
            }
        }
        put(&mut self.base_colour, i, [0; 4]);
        put(&mut self.thickness, i, 0);
        put(&mut self.vein_mask, i, 0);
        put(&mut self.vein_order, i, 0);
        if let Some(deep) = &mut self.deep {
            put(&mut deep.base_colour, i, [0; 4]);
            put(&mut deep.vein_mask, i, 0);
        }
    }

    /// Fills the texels outside the leaf, each plane after its map's [`Outside`]; where there is nothing to spread,
    /// as in [`Self::empty`].
    pub(super) fn spread(&mut self, ground: Ground<'_>) {
        ground.fill(self.base_colour.values_mut(), [0; 4], |[r, g, b, _]| [r, g, b, 0]);
        ground.fill(self.height.values_mut(), PLAIN_HEIGHT, |value| value);
        ground.fill(self.roughness.values_mut(), 0, |value| value);
        ground.fill(self.transmission.values_mut(), 0, |value| value);
        ground.fill(self.translucency.values_mut(), [0; 3], |value| value);
        ground.fill(self.bump.values_mut(), PLAIN_BUMP, |value| value);
        if let Some(deep) = &mut self.deep {
            deep.spread(ground);
        }
        debug_assert!(MapKind::Thickness.outside() == Outside::Zero, "left as it is empty");
    }

    /// The first plane that is neither empty nor a square of the base colour's size.
    pub(super) fn check(&self) -> Option<&'static str> {
        let size = self.size();
        let planes = [
            ("normal", self.normal.width(), self.normal.height()),
            ("height", self.height.width(), self.height.height()),
            ("roughness", self.roughness.width(), self.roughness.height()),
            ("occlusion", self.occlusion.width(), self.occlusion.height()),
            ("transmission", self.transmission.width(), self.transmission.height()),
            ("translucency", self.translucency.width(), self.translucency.height()),
            ("thickness", self.thickness.width(), self.thickness.height()),
            ("vein mask", self.vein_mask.width(), self.vein_mask.height()),
            ("vein order", self.vein_order.width(), self.vein_order.height()),
            ("bump", self.bump.width(), self.bump.height()),
        ];
        planes
            .into_iter()
            .find(|&(_, width, height)| (width, height) != (size, size) && width + height > 0)
            .map(|(name, ..)| name)
    }
}
