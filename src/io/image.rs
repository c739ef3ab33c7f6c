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

use crate::raster::Grid;
use crate::texture::map::{Channels, MapKind};
use png::{BitDepth, ColorType, DeflateCompression, Filter};

/// A map of `bits` (8 or 16) as a PNG; `samples` as [`crate::texture::SideMaps::samples_of`] lays
/// them.
#[must_use]
pub fn map_png(
    map: MapKind,
    bits: u8,
    size: (usize, usize),
    samples: &[u8],
    caption: &Caption<'_>,
) -> Vec<u8> {
    encode(size, samples, &layout(map, bits), caption)
}

/// How a map is packed.
fn layout(map: MapKind, bits: u8) -> Layout {
    Layout {
        colour: match map.channels() {
            Channels::Grey => ColorType::Grayscale,
            Channels::GreyAlpha => ColorType::GrayscaleAlpha,
            Channels::Rgb => ColorType::Rgb,
            Channels::Rgba => ColorType::Rgba,
        },
        depth: if bits == 16 { BitDepth::Sixteen } else { BitDepth::Eight },
        srgb: map.colour_space() == "sRGB",
        packing: FASTEST,
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
    let size = (picture.width(), picture.height());
    encode(size, picture.values().as_flattened(), &COLOUR, caption)
}

/// How samples lie in a file, and what they are.
#[derive(Debug)]
struct Layout {
    colour: ColorType,
    depth: BitDepth,
    srgb: bool,
    packing: Packing,
}

/// How hard a packer tries, and what it takes a sample's difference to.
#[derive(Debug, Clone, Copy)]
struct Packing {
    compression: DeflateCompression,
    filter: Filter,
}

// The fastest packing that the crate knows, and one filter. Maps of the lotus at 2048² (milliseconds of one
// core, kilobytes), which fills its square:
//
//             ultra fast    level 1      level 2    (Paeth)
//   colour     31  5056     91  5899    115  4971
//   height     16  4893     39  4442     95  4379
//   normal     20  4399     73  5016    112  5083
//   ORM        34  5295    109  6469    127  5777
//
// The deflate levels take three to five times as long and save nothing; Sub, Up and Avg are a tenth faster
// and make files up to 6 % larger.

const FASTEST: Packing =
    Packing { compression: DeflateCompression::FdeflateUltraFast, filter: Filter::Paeth };

// Sheets and films hold paper and letters, where the levels find what repeats.

const SMALL: Packing = Packing { compression: DeflateCompression::Level(2), filter: Filter::Sub };

const COLOUR: Layout =
    Layout { colour: ColorType::Rgba, depth: BitDepth::Eight, srgb: true, packing: SMALL };

/// # Panics
///
/// If the picture is empty: PNG has no such thing.
fn encode(size: (usize, usize), samples: &[u8], layout: &Layout, caption: &Caption<'_>) -> Vec<u8> {
    let mut file = Vec::new();
    write(&mut file, size, samples, layout, caption)
        .expect("a picture that is not empty is written to memory without error");
    file
}

fn write(
    file: &mut Vec<u8>,
    (width, height): (usize, usize),
    samples: &[u8],
    layout: &Layout,
    caption: &Caption<'_>,
) -> Result<(), png::EncodingError> {
    let side = |pixels| u32::try_from(pixels).expect("a side of a picture fits in 32 bits");
    let mut encoder = png::Encoder::new(file, side(width), side(height));
    encoder.set_color(layout.colour);
    encoder.set_depth(layout.depth);
    encoder.set_deflate_compression(layout.packing.compression);
    encoder.set_filter(layout.packing.filter);
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
