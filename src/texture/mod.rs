//! Images of the blade: colour, coverage, height and normals of both sides.

pub mod fields;
pub mod normals;
pub mod petiole;
pub mod pigment;
pub mod relief;
pub mod tissue;

use crate::margin::Margin;
use crate::observer::Observer;
use crate::parameter::parameters;
use crate::raster::Grid;
use crate::seed::Seed;
use crate::units::TextureFrame;
use crate::veins::Venation;
use petiole::PetioleSpec;
use pigment::ColourSpec;
use relief::ReliefSpec;

parameters! {
    /// Size and place of the textures.
    pub struct TextureSpec {
        /// Side of the square textures.
        size_px: count(1024, 16..=16_384, "px"),
        /// Free space around leaf and petiole, as a share of the side.
        gutter: number(0.02, 0.0..=0.4, ""),
    }
}

/// All the settings that [`paint`] reads.
#[derive(Debug, Clone, Copy)]
pub struct Paint<'a> {
    /// Size and gutter.
    pub texture: &'a TextureSpec,
    /// The stalk.
    pub petiole: &'a PetioleSpec,
    /// Pigments.
    pub colour: &'a ColourSpec,
    /// Heights and surface.
    pub relief: &'a ReliefSpec,
}

/// Paints both sides of a leaf.
///
/// # Errors
///
/// [`TextureError`] when a map would not fit.
pub fn paint(
    _paint: &Paint<'_>,
    _margin: &Margin,
    _venation: &Venation,
    _seed: Seed,
    _observer: &mut dyn Observer,
) -> Result<TextureSet, TextureError> {
    unimplemented!()
}

/// Why textures could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {}

/// The maps of one side.
#[derive(Debug, Clone, PartialEq)]
pub struct SideMaps {
    /// Base colour, sRGB, and coverage as straight alpha. Under alpha 0 the colour is that of the
    /// nearest fully covered texel.
    pub base_colour: Grid<[u8; 4]>,
    /// Height above the lowest place the map can show; 65535 is `TextureSet::height_range_mm`.
    pub height: Grid<u16>,
    /// Unit normal in tangent space, OpenGL (+y up the picture), 0–255 for −1–1.
    pub normal: Grid<[u8; 3]>,
    /// Foster's bump: red channel, blade at 128.
    pub bump: Grid<u8>,
}

/// The textures of a leaf.
///
/// # Guarantees
///
/// - All maps are squares of one size; the back is mirrored left to right against the front.
/// - Colour is sRGB with straight alpha, dilated under alpha 0.
/// - Normals are unit length before rounding, z > 0.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureSet {
    /// The square of leaf space shown.
    pub frame: TextureFrame,
    /// The upper (adaxial) side.
    pub front: SideMaps,
    /// The lower (abaxial) side, mirrored.
    pub back: SideMaps,
    /// Height of 65535 over 0 (mm), the same on both sides; the plain blade is in the middle.
    pub height_range_mm: f64,
    /// Where the petiole leaves the stem, its far end (mm).
    pub petiole_end: glam::DVec2,
}
