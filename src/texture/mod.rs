//! Images of the blade: colour, coverage, height and normals of both sides.
//!
//! [`paint`] lays the leaf out on its texture, paints both sides band by band as seen from the
//! front, spreads them over the empty texels, and mirrors the back.

mod dilation;
mod fields;
mod guide;
pub mod normals;
pub mod petiole;
pub mod pigment;
pub mod relief;
mod scene;
mod texel;
mod tissue;

use crate::margin::Margin;
use crate::observer::{Observer, Progress};
use crate::parameter::parameters;
use crate::raster::Grid;
use crate::seed::Seed;
use crate::units::TextureFrame;
use crate::veins::Venation;
use petiole::PetioleSpec;
use pigment::ColourSpec;
use relief::ReliefSpec;
use scene::Scene;

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
    /// How many speckles are thrown when `colour.speckle_count` is 0: a tenth of the auxin spawn
    /// rate (Foster, appendix B.3).
    pub default_speckles: u64,
}

/// The limits of `texture.size_px`.
const SIZES_PX: std::ops::RangeInclusive<u64> = 16..=16_384;

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
    let size = paint.texture.size_px;
    if !SIZES_PX.contains(&size) {
        return Err(TextureError::Size { size });
    }
    let mut report = |step| {
        observer.report(Progress { stage: "painting", step, steps: 3, nodes: 0, sources: 0 });
    };
    report(0);
    let scene = Scene::new(paint, margin, venation, seed);
    report(1);
    let [mut front, mut back] = scene.paint();
    report(2);
    dilation::spread([&mut front, &mut back]);
    back.mirror();
    report(3);
    Ok(TextureSet {
        frame: scene.frame(),
        front,
        back,
        height_range_mm: scene.height_range_mm(),
        petiole_end: scene.petiole_end(),
    })
}

/// Why textures could not be painted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TextureError {
    /// The side is too short or too long.
    #[error("texture.size_px = {size} must lie in 16..=16384")]
    Size {
        /// As given.
        size: u64,
    },
}

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

impl SideMaps {
    /// The maps of no leaf at all: clear, flat.
    fn empty(size: usize) -> Self {
        Self {
            base_colour: Grid::filled(size, size, [0; 4]),
            height: Grid::filled(size, size, 1 << 15),
            normal: Grid::filled(size, size, [128, 128, 255]),
            bump: Grid::filled(size, size, 128),
        }
    }

    /// Turns the pictures over, left to right.
    fn mirror(&mut self) {
        self.base_colour = self.base_colour.mirrored();
        self.height = self.height.mirrored();
        self.normal = self.normal.mirrored();
        self.bump = self.bump.mirrored();
    }
}

impl TextureSet {
    /// The first guarantee that does not hold, in words; `None` when all do. For tests.
    #[must_use]
    pub fn check(&self) -> Option<String> {
        let size = self.front.base_colour.width();
        for (name, side) in [("front", &self.front), ("back", &self.back)] {
            let sizes = [
                (side.base_colour.width(), side.base_colour.height()),
                (side.height.width(), side.height.height()),
                (side.normal.width(), side.normal.height()),
                (side.bump.width(), side.bump.height()),
            ];
            if sizes.iter().any(|&each| each != (size, size)) {
                return Some(format!("the maps of the {name} are not all {size} squares"));
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
