//! The maps that can be had of a leaf: what each is called, holds and looks like outside the leaf.
//!
//! Writers go through [`MapKind::ALL`] and ask [`SideMaps::samples`](super::SideMaps::samples); a new
//! map is a variant here, a plane in [`SideMaps`](super::SideMaps) and the texel that fills it.

use super::TextureError;
use crate::parameter::words;

words! {
    /// A map of one side of the blade.
    pub enum MapKind {
        /// Colour and coverage.
        BaseColour = "basecolor",
        /// Coverage alone.
        Opacity = "opacity",
        /// Normals.
        Normal = "normal",
        /// Normals with y down.
        NormalDx = "normaldx",
        /// Height.
        Height = "height",
        /// Roughness of the surface.
        Roughness = "roughness",
        /// Smoothness of the surface.
        Gloss = "gloss",
        /// Light kept off by the relief.
        AmbientOcclusion = "ambientocclusion",
        /// Occlusion, roughness, metal and transmission in one picture.
        Orm = "orm",
        /// Metal, occlusion, detail mask and smoothness in one picture, as Unity's HDRP packs them.
        MaskMap = "maskmap",
        /// Colour of the light that comes through.
        Translucency = "translucency",
        /// Thickness of the blade.
        Thickness = "thickness",
        /// Where veins are.
        VeinMask = "veinmask",
        /// Of which order the vein is.
        VeinOrder = "veinorder",
        /// Foster's bump map.
        Bump = "bump",
        /// The leaf lit from the front, from behind, and against the light.
        Preview = "preview",
        /// The steps of the enhancement of Rodkaew et al. 2002.
        Enhancement = "enhancement",
    }
}

/// The channels of a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// One number.
    Grey,
    /// One number and coverage.
    GreyAlpha,
    /// Three numbers.
    Rgb,
    /// Three numbers and a fourth.
    Rgba,
}

impl Channels {
    /// In words.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Grey => "grey",
            Self::GreyAlpha => "grey+alpha",
            Self::Rgb => "rgb",
            Self::Rgba => "rgba",
        }
    }

    /// How many.
    #[must_use]
    pub const fn count(self) -> usize {
        match self {
            Self::Grey => 1,
            Self::GreyAlpha => 2,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }
}

/// What a map holds where the leaf is not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outside {
    /// The value of the nearest fully covered texel.
    Dilated,
    /// Nothing.
    Zero,
    /// The greatest value.
    One,
    /// The normal of a plain surface, (128, 128, 255).
    FlatNormal,
    /// Something to look at: no map of the leaf's own texels.
    Paper,
}

impl MapKind {
    /// The maps that are written unless others are asked for.
    pub const DEFAULT: &'static [Self] = &[
        Self::BaseColour,
        Self::Opacity,
        Self::Normal,
        Self::Height,
        Self::Roughness,
        Self::AmbientOcclusion,
        Self::Orm,
        Self::Translucency,
        Self::Thickness,
        Self::VeinMask,
        Self::VeinOrder,
    ];

    /// The end of the file name: other programs sort maps by these words.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::BaseColour => "BaseColor",
            Self::Opacity => "Opacity",
            Self::Normal => "Normal",
            Self::NormalDx => "NormalDX",
            Self::Height => "Height",
            Self::Roughness => "Roughness",
            Self::Gloss => "Gloss",
            Self::AmbientOcclusion => "AmbientOcclusion",
            Self::Orm => "ORM",
            Self::MaskMap => "MaskMap",
            Self::Translucency => "Translucency",
            Self::Thickness => "Thickness",
            Self::VeinMask => "VeinMask",
            Self::VeinOrder => "VeinOrder",
            Self::Bump => "Bump",
            Self::Preview => "Preview",
            Self::Enhancement => "Enhancement",
        }
    }

    /// What the values mean, for people.
    #[must_use]
    pub const fn meaning(self) -> &'static str {
        match self {
            Self::BaseColour => {
                "colour without light or shadow; alpha is coverage, straight; colour goes on under \
                 alpha 0"
            }
            Self::Opacity => "coverage: 0 outside, 1 inside; grey and alpha are equal",
            Self::Normal => "normal in tangent space, OpenGL (+y up the picture)",
            Self::NormalDx => "normal in tangent space, DirectX (+y down the picture)",
            Self::Height => {
                "height: 0 lowest, 65535 highest, apart by height_range_mm; plain blade in the middle"
            }
            Self::Roughness => "perceptual roughness (GGX): 0 mirror, 1 matt",
            Self::Gloss => "smoothness: 1 less roughness",
            Self::AmbientOcclusion => "light that reaches the surface past the relief: 1 all of it",
            Self::Orm => {
                "red occlusion, green roughness, blue metal (0), alpha the share of the scattered \
                 light that comes out on the far side"
            }
            Self::MaskMap => {
                "red metal (0), green occlusion, blue detail mask (a half), alpha smoothness"
            }
            Self::Translucency => "colour of the light that comes through the blade",
            Self::Thickness => "thickness: 65535 is thickness_range_mm",
            Self::VeinMask => "how much of the texel is vein",
            Self::VeinOrder => "order of the vein: 0 none, 1 primary, 2 secondary …",
            Self::Bump => "height in the red channel, plain blade at 128",
            Self::Preview => "for people: upper side, lower side, and against the light",
            Self::Enhancement => {
                "for people: plain veins; thickened, noise, blur; embossed; inverted; recoloured; \
                 veins added"
            }
        }
    }

    /// The channels of a pixel.
    #[must_use]
    pub const fn channels(self) -> Channels {
        match self {
            Self::BaseColour | Self::Orm | Self::MaskMap => Channels::Rgba,
            Self::Opacity => Channels::GreyAlpha,
            Self::Normal
            | Self::NormalDx
            | Self::Translucency
            | Self::Bump
            | Self::Preview
            | Self::Enhancement => Channels::Rgb,
            _ => Channels::Grey,
        }
    }

    /// Bits of a channel.
    #[must_use]
    pub const fn bits(self) -> u8 {
        match self {
            Self::Height | Self::Thickness => 16,
            _ => 8,
        }
    }

    /// `sRGB` for colours, `linear` for data that no colour profile may touch.
    #[must_use]
    pub const fn colour_space(self) -> &'static str {
        match self {
            Self::BaseColour | Self::Translucency | Self::Preview | Self::Enhancement => "sRGB",
            _ => "linear",
        }
    }

    /// Whether the lower side has one of its own.
    #[must_use]
    pub const fn has_back(self) -> bool {
        !matches!(self, Self::Preview)
    }

    /// What it holds where the leaf is not.
    #[must_use]
    pub const fn outside(self) -> Outside {
        match self {
            Self::Opacity | Self::Thickness | Self::VeinMask | Self::VeinOrder => Outside::Zero,
            Self::AmbientOcclusion => Outside::One,
            Self::Normal | Self::NormalDx => Outside::FlatNormal,
            Self::Preview | Self::Enhancement => Outside::Paper,
            _ => Outside::Dilated,
        }
    }

    /// The maps that a comma-separated list names; `all` of them or `none`. Large letters are as good
    /// as small ones, `ao` is ambient occlusion, and what is asked for twice is there once.
    ///
    /// # Errors
    ///
    /// [`TextureError::Map`] with the word that names none.
    pub fn list(words: &str) -> Result<Vec<Self>, TextureError> {
        match words.trim().to_ascii_lowercase().as_str() {
            "none" => return Ok(Vec::new()),
            "all" => return Ok(Self::ALL.to_vec()),
            _ => {}
        }
        let find = |word: &str| match word.trim().to_ascii_lowercase().as_str() {
            "ao" => Ok(Self::AmbientOcclusion),
            lower => Self::ALL
                .iter()
                .copied()
                .find(|map| map.word() == lower)
                .ok_or_else(|| TextureError::Map { word: word.trim().to_owned() }),
        };
        let named: Vec<Self> = words.split(',').map(find).collect::<Result<_, _>>()?;
        Ok(Self::ALL.iter().copied().filter(|map| named.contains(map)).collect())
    }
}

/// The planes of pixels that are kept while a leaf is painted: those of the maps asked for, those they
/// are made from, and always colour with coverage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MapSet(u32);

/// Set where 16 bits are wanted; maps have the bits below.
const DEEP: u32 = 1 << 31;

impl MapSet {
    /// Every map, with 8 bits a channel where 16 are not its own.
    pub const ALL: Self = Self(DEEP - 1);

    /// The planes that these maps need.
    #[must_use]
    pub fn of(maps: &[MapKind]) -> Self {
        let bit = |map: MapKind| 1 << map as u32;
        // Normals and occlusion are read off the heights.
        let needs = |map: &MapKind| match map {
            MapKind::Opacity => 0,
            MapKind::Normal | MapKind::NormalDx => bit(MapKind::Normal) | bit(MapKind::Height),
            MapKind::AmbientOcclusion => bit(MapKind::AmbientOcclusion) | bit(MapKind::Height),
            MapKind::Gloss => bit(MapKind::Roughness),
            MapKind::MaskMap => {
                bit(MapKind::Roughness) | bit(MapKind::AmbientOcclusion) | bit(MapKind::Height)
            }
            MapKind::Orm => {
                bit(MapKind::Orm)
                    | bit(MapKind::Roughness)
                    | bit(MapKind::AmbientOcclusion)
                    | bit(MapKind::Height)
            }
            MapKind::Preview => {
                let shown = [
                    MapKind::Normal,
                    MapKind::Height,
                    MapKind::Roughness,
                    MapKind::AmbientOcclusion,
                    MapKind::Translucency,
                ];
                shown.into_iter().map(bit).fold(bit(MapKind::Preview), |set, one| set | one)
            }
            MapKind::Enhancement => bit(MapKind::Enhancement) | bit(MapKind::VeinMask),
            &other => bit(other),
        };
        Self(maps.iter().map(needs).fold(bit(MapKind::BaseColour), |set, bits| set | bits))
    }

    /// The set with every colour and share kept with 16 bits, too.
    #[must_use]
    pub const fn deep(self) -> Self {
        Self(self.0 | DEEP)
    }

    /// Whether colours and shares are kept with 16 bits, too.
    #[must_use]
    pub const fn is_deep(self) -> bool {
        self.0 & DEEP != 0
    }

    /// The set with the plane of one map more.
    #[must_use]
    pub const fn with(self, map: MapKind) -> Self {
        Self(self.0 | (1 << map as u32))
    }

    /// Whether the plane of this map is kept; for `Orm` its transmission.
    #[must_use]
    #[inline]
    pub const fn has(self, map: MapKind) -> bool {
        self.0 & (1 << map as u32) != 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_names_maps_once_and_in_order() {
        let list = MapKind::list("Normal, ao,basecolor,normal").expect("known words");
        assert_eq!(list, [MapKind::BaseColour, MapKind::Normal, MapKind::AmbientOcclusion]);
        let error = MapKind::list("normal,shine").expect_err("no such map").to_string();
        assert!(error.contains("output.maps") && error.contains("`shine`"), "{error}");
    }

    #[test]
    fn a_packed_map_brings_what_it_is_made_of_and_nothing_else() {
        let set = MapSet::of(&[MapKind::Orm]);
        for map in MapKind::ALL {
            let needed = matches!(
                map,
                MapKind::Orm
                    | MapKind::Roughness
                    | MapKind::AmbientOcclusion
                    | MapKind::Height
                    | MapKind::BaseColour
            );
            assert_eq!(set.has(*map), needed, "{map}");
        }
    }
}
