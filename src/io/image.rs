//! Grids of pixels to PNG bytes.
//!
//! What programs that read leaf textures need to find in a PNG, and what this file keeps to:
//!
//! - An `sRGB` chunk on pictures of colour and no colour chunk at all on data (height, normals,
//!   coverage), so that nobody bends numbers through a colour profile.
//! - Colour under alpha 0 stays as it is: it is the dilated colour that keeps edges free of halos.
//! - 16-bit samples are big-endian, as the format asks.
//! - `pHYs` gives the true size, since leaves are life-size objects.
//! - The settings travel in text chunks, without a time stamp: same leaf, same bytes.

use png::{BitDepth, ColorType, DeflateCompression, Filter};
use rayon::prelude::*;

use crate::parameter::words;
use crate::raster::Grid;
use crate::texture::SideMaps;

words! {
    /// A map of one side of the blade.
    pub enum MapKind {
        /// Colour and coverage.
        BaseColour = "basecolor",
        /// Coverage alone.
        Opacity = "opacity",
        /// Height.
        Height = "height",
        /// Normals.
        Normal = "normal",
        /// Foster's bump map.
        Bump = "bump",
    }
}

impl MapKind {
    /// The maps that are written unless others are asked for.
    pub const DEFAULT: &'static [Self] =
        &[Self::BaseColour, Self::Opacity, Self::Height, Self::Normal];

    /// The end of the file name: other programs sort maps by these words.
    #[must_use]
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::BaseColour => "BaseColor",
            Self::Opacity => "Opacity",
            Self::Height => "Height",
            Self::Normal => "Normal",
            Self::Bump => "Bump",
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
            Self::Height => {
                "height: 0 lowest, 65535 highest, apart by height_range_mm; plain \
                             blade in the middle"
            }
            Self::Normal => "normal in tangent space, OpenGL (+y up the picture)",
            Self::Bump => "height in the red channel, plain blade at 128",
        }
    }

    /// The channels of a pixel, in words.
    #[must_use]
    pub const fn channels(self) -> &'static str {
        match self {
            Self::BaseColour => "rgba",
            Self::Opacity => "grey+alpha",
            Self::Height => "grey",
            Self::Normal | Self::Bump => "rgb",
        }
    }

    /// Bits of a channel.
    #[must_use]
    pub const fn bits(self) -> u8 {
        match self {
            Self::Height => 16,
            _ => 8,
        }
    }

    /// `sRGB` for colours, `linear` for data that no colour profile may touch.
    #[must_use]
    pub const fn colour_space(self) -> &'static str {
        match self {
            Self::BaseColour => "sRGB",
            _ => "linear",
        }
    }

    /// This map of one side as a PNG.
    #[must_use]
    pub fn encode(self, maps: &SideMaps, caption: &Caption<'_>) -> Vec<u8> {
        match self {
            Self::BaseColour => colour_png(&maps.base_colour, caption),
            Self::Opacity => opacity_png(&maps.base_colour, caption),
            Self::Height => height_png(&maps.height, caption),
            Self::Normal => normal_png(&maps.normal, caption),
            Self::Bump => bump_png(&maps.bump, caption),
        }
    }
}

/// What a PNG says about itself beside its pixels.
#[derive(Debug, Clone, Copy, Default)]
pub struct Caption<'a> {
    /// True size; `None` for pictures without one, such as contact sheets.
    pub pixels_per_mm: Option<f64>,
    /// Keyword and text, any UTF-8. The keywords are Latin letters, at most 79.
    pub texts: &'a [(&'a str, &'a str)],
}

/// A picture of colours, sRGB with straight alpha.
#[must_use]
pub fn colour_png(picture: &Grid<[u8; 4]>, caption: &Caption<'_>) -> Vec<u8> {
    encode(picture, picture.values().as_flattened(), &COLOUR, caption)
}

/// The alpha of a picture as grey and as alpha: some programs take a mask from one, some from the
/// other, and a mask with both is cut out right everywhere.
#[must_use]
pub fn opacity_png(picture: &Grid<[u8; 4]>, caption: &Caption<'_>) -> Vec<u8> {
    encode(picture, &samples(picture, |&[.., alpha]| [alpha, alpha]), &OPACITY, caption)
}

/// 16-bit grey data.
#[must_use]
pub fn height_png(heights: &Grid<u16>, caption: &Caption<'_>) -> Vec<u8> {
    encode(heights, &samples(heights, |height| height.to_be_bytes()), &HEIGHT, caption)
}

/// RGB data.
#[must_use]
pub fn normal_png(normals: &Grid<[u8; 3]>, caption: &Caption<'_>) -> Vec<u8> {
    encode(normals, normals.values().as_flattened(), &NORMAL, caption)
}

/// Grey data in the red channel of RGB, as Foster's bump maps have it.
#[must_use]
pub fn bump_png(heights: &Grid<u8>, caption: &Caption<'_>) -> Vec<u8> {
    encode(heights, &samples(heights, |&height| [height, 0, 0]), &BUMP, caption)
}

/// How samples lie in a file, what they are, and how they are packed.
#[derive(Debug)]
struct Layout {
    colour: ColorType,
    depth: BitDepth,
    srgb: bool,
    compression: DeflateCompression,
    filter: Filter,
}

// Packing, measured on speckled, veined maps of 1024² (milliseconds of one core, kilobytes):
//
//             ultra fast    level 1      level 2      level 6
//   colour    10  1709      23  1312     30   960     282   790    (filter sub)
//   normal     5   817      11   593     18   511     161   474    (filter sub)
//   height     4  1173      11  1051     36  1065      52  1064    (filter Paeth)
//   opacity  0.5    15       1    18      4     7       4     7    (filter up)
//
// Level 2 for what gains by it, the fastest for the rest: a leaf of two sides takes 0.1 s.

const COLOUR: Layout = Layout {
    colour: ColorType::Rgba,
    depth: BitDepth::Eight,
    srgb: true,
    compression: DeflateCompression::Level(2),
    filter: Filter::Sub,
};

const OPACITY: Layout = Layout {
    colour: ColorType::GrayscaleAlpha,
    depth: BitDepth::Eight,
    srgb: false,
    compression: DeflateCompression::FdeflateUltraFast,
    filter: Filter::Up,
};

const HEIGHT: Layout = Layout {
    colour: ColorType::Grayscale,
    depth: BitDepth::Sixteen,
    srgb: false,
    compression: DeflateCompression::FdeflateUltraFast,
    filter: Filter::Paeth,
};

const NORMAL: Layout = Layout { colour: ColorType::Rgb, srgb: false, ..COLOUR };

const BUMP: Layout = Layout { colour: ColorType::Rgb, ..OPACITY };

fn samples<T: Sync, const N: usize>(
    grid: &Grid<T>,
    bytes: impl Fn(&T) -> [u8; N] + Sync + Send,
) -> Vec<u8> {
    grid.values().par_iter().map(bytes).collect::<Vec<_>>().into_flattened()
}

/// # Panics
///
/// If the picture is empty: PNG has no such thing.
fn encode<T>(grid: &Grid<T>, samples: &[u8], layout: &Layout, caption: &Caption<'_>) -> Vec<u8> {
    let mut file = Vec::new();
    write(&mut file, grid, samples, layout, caption)
        .expect("a picture that is not empty is written to memory without error");
    file
}

fn write<T>(
    file: &mut Vec<u8>,
    grid: &Grid<T>,
    samples: &[u8],
    layout: &Layout,
    caption: &Caption<'_>,
) -> Result<(), png::EncodingError> {
    let side = |pixels| u32::try_from(pixels).expect("a side of a picture fits in 32 bits");
    let mut encoder = png::Encoder::new(file, side(grid.width()), side(grid.height()));
    encoder.set_color(layout.colour);
    encoder.set_depth(layout.depth);
    encoder.set_deflate_compression(layout.compression);
    encoder.set_filter(layout.filter);
    if layout.srgb {
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    }
    if let Some(pixels_per_mm) = caption.pixels_per_mm {
        let per_metre = (pixels_per_mm * 1000.0).round() as u32;
        let unit = png::Unit::Meter;
        let size = png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit };
        encoder.set_pixel_dims(Some(size));
    }
    encoder.add_text_chunk("Software".into(), super::GENERATOR.into())?;
    for (keyword, text) in caption.texts {
        encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned())?;
    }
    let mut writer = encoder.write_header()?;
    writer.write_image_data(samples)?;
    writer.finish()
}
