//! Images of the blade: colour, coverage, height and normals of both sides.
//!
//! [`paint`] lays the leaf out on its texture, paints both sides band by band, spreads them over the
//! empty texels, and reads normals and occlusion off the heights. An [`Easel`] does so again and again.
//!
//! A texel takes 19 bytes a side when every map of the default set is kept, so 8192² with both sides
//! needs 2.6 GB, and 540 MB with the colour alone; `MapSet` keeps what the maps asked for need. The
//! rest is small beside it, but for the 13 bytes a texel of a leaf with wounds while crumbs are looked
//! for.

pub mod atlas;
mod band;
mod banded;
mod brush;
mod canvas;
mod chords;
mod crumbs;
pub mod damage;
pub mod deep;
mod dilation;
mod easel;
mod enhance;
mod fields;
mod guide;
mod lattice;
mod layout;
pub mod map;
pub mod mip;
mod net;
pub mod normals;
mod occlusion;
mod optics;
mod pen;
pub mod petiole;
pub mod pigment;
pub mod plates;
mod preview;
pub mod relief;
mod samples;
mod scene;
mod side;
mod spans;
pub mod spectrum;
mod strip;
mod tissue;

use crate::margin::Margin;
use crate::observer::Observer;
use crate::parameter::{OutsideLimits, Parameters, parameters, words};
use crate::raster::Grid;
use crate::seed::Seed;
use crate::spelling::advice;
use crate::units::TextureFrame;
use crate::veins::Venation;
pub use canvas::Canvas;
use damage::DamageSpec;
pub use easel::Easel;
use map::{MapKind, MapSet};
use petiole::PetioleSpec;
use pigment::{Albedo, ColourSpec, StateSpec};
use relief::ReliefSpec;
pub use side::SideMaps;

words! {
    /// How the base colour is made.
    pub enum Style {
        /// From the tissue.
        Tissue = "tissue",
        /// By the image enhancement of Rodkaew et al. 2002, section 5.
        Enhanced = "enhanced",
    }
}

parameters! {
    /// Size and place of the textures.
    pub struct TextureSpec {
        /// Side of the square textures.
        size_px: count(1024, 16..=16_384, "px"),
        /// Free space around leaf and petiole, as a share of the side.
        gutter: number(0.02, 0.0..=0.4, ""),
        /// How the base colour is made: `tissue`, or `enhanced` as Rodkaew et al. 2002 do.
        style: choice(Style, Style::Tissue),
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
    /// Season, maturity and health.
    pub state: &'a StateSpec,
    /// What has happened to the leaf.
    pub damage: &'a DamageSpec,
    /// Heights and surface.
    pub relief: &'a ReliefSpec,
    /// The planes to keep.
    pub maps: MapSet,
    /// How many speckles are thrown when `colour.speckle_count` is 0: a tenth of the auxin spawn
    /// rate (Foster, appendix B.3).
    pub default_speckles: u64,
}

/// Paints both sides of a leaf. The same bytes on any number of threads.
///
/// # Errors
///
/// [`TextureError`] when a map would not fit.
pub fn paint(
    paint: &Paint<'_>,
    margin: &Margin,
    venation: &Venation,
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<TextureSet, TextureError> {
    Easel::new(margin, venation, seed).paint(paint, observer)
}

/// Refuses settings that a program made and under which nothing could be painted.
fn check(paint: &Paint<'_>) -> Result<(), TextureError> {
    let groups: [(&str, Option<OutsideLimits>); 6] = [
        ("texture", paint.texture.outside_limits()),
        ("petiole", paint.petiole.outside_limits()),
        ("colour", paint.colour.outside_limits()),
        ("state", paint.state.outside_limits()),
        ("damage", paint.damage.outside_limits()),
        ("relief", paint.relief.outside_limits()),
    ];
    let mut found = groups.into_iter().filter_map(|(group, outside)| Some(outside?.within(group)));
    found.next().map_or(Ok(()), |outside| Err(TextureError::Setting(outside)))
}

/// The pictures that are made from the others.
fn finish(paint: &Paint<'_>, maps: MapSet, set: &mut TextureSet, noise: u32) {
    let per_mm = set.frame.pixels_per_mm(set.front.size()) as f32;
    let enhanced = paint.texture.style == Style::Enhanced;
    if enhanced || maps.has(MapKind::Enhancement) {
        for side in [&mut set.front, &mut set.back] {
            let steps = enhance::steps(side, per_mm, noise);
            side.enhancement = enhance::montage(&steps);
            if enhanced {
                enhance::replace(side, &steps);
            }
            if !maps.has(MapKind::Enhancement) {
                side.enhancement = Grid::filled(0, 0, [0; 3]);
            }
        }
    }
    if maps.has(MapKind::Preview) {
        set.front.preview = preview::lit(&set.front, &set.back);
    }
}

/// Why textures could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// A setting outside its limits.
    #[error("{} = {} {}", .0.key, .0.value, .0.problem())]
    Setting(OutsideLimits),
    /// A map that there is not.
    #[error("output.maps: `{word}` {}", advice(word, "map", MapKind::ALL.iter().map(|map| map.word())))]
    Map {
        /// As given.
        word: String,
    },
}

/// The textures of a leaf.
///
/// # Guarantees
///
/// - All maps but the pictures for people are squares of one size; the back is mirrored left to right
///   against the front.
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
    /// Thickness of 65535 in the thickness maps (mm).
    pub thickness_range_mm: f64,
    /// Where the petiole leaves the stem, its far end (mm).
    pub petiole_end: glam::DVec2,
    /// The outline of the petiole (mm), which begins within the blade; empty where there is none.
    pub petiole: Vec<glam::DVec2>,
    /// What the base colour holds.
    pub albedo: Albedo,
    /// The outline of what is left of a damaged blade and of the gaps in it (mm): anticlockwise
    /// around tissue, clockwise around gaps; none where the blade is whole.
    pub rings: Vec<Vec<glam::DVec2>>,
}

impl TextureSet {
    /// The first guarantee that does not hold, in words; `None` when all do. For tests.
    #[must_use]
    pub fn check(&self) -> Option<String> {
        let size = self.front.base_colour.width();
        for (name, side) in [("front", &self.front), ("back", &self.back)] {
            if let Some(plane) = side.check() {
                return Some(format!("the {plane} map of the {name} is no square of {size}"));
            }
            for (i, normal) in side.normal.values().iter().enumerate() {
                let [x, y, z] = normal.map(|byte| f32::from(byte) / 127.5 - 1.0);
                let length = (x * x + y * y + z * z).sqrt();
                if normal[2] < 128 || (length - 1.0).abs() > 0.02 {
                    return Some(format!("normal {normal:?} of the {name} at {i}"));
                }
            }
        }
        let back = self.back.base_colour.mirrored();
        let mut pairs = self.front.base_colour.values().iter().zip(back.values());
        pairs.any(|(a, b)| a[3] != b[3]).then(|| "the sides cover different texels".to_owned())
    }
}
