//! Black-and-white pictures of veins: PNG and JPEG files as masks, at full resolution.
//!
//! PNGs are decoded row by row, so that a cleared leaf scanned at 6400 dpi takes a byte to the pixel.
//! What is brighter than half is white, transparent is black. The background is the colour of most
//! of the picture's border; veins have the other.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Read, Seek, SeekFrom};
use std::path::Path;

use super::jpeg;
use crate::raster::Grid;

/// Veins in a picture.
#[derive(Debug, Clone)]
pub struct VeinMask {
    /// Where veins are.
    pub veins: Grid<bool>,
    /// Whether they were the dark part.
    pub dark_veins: bool,
}

/// Sides that distance transforms take (px).
const MOST_SIDE: u32 = 1 << 14;
/// Pictures may have this many pixels: measuring takes some ten bytes to the pixel.
const MOST_PIXELS: u64 = 160_000_000;
/// JPEGs are decoded whole, at 3 bytes to the pixel.
const MOST_DECODED_BYTES: u64 = 256 << 20;

/// Why a file shows no veins, to stand after its name.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MaskError {
    /// The system refused.
    #[error("{0}")]
    Read(#[from] std::io::Error),
    /// Too short to be one.
    #[error("is not a picture")]
    NoPicture,
    /// More than can be measured.
    #[error(
        "is {width} x {height} px; at most {MOST_SIDE} px a side and {} megapixels are measured: reduce it",
        MOST_PIXELS / 1_000_000
    )]
    TooLarge {
        /// Pixels in a row.
        width: u32,
        /// Rows.
        height: u32,
    },
    /// Rows that come in no order.
    #[error("is interlaced; save it without interlacing")]
    Interlaced,
    /// A broken PNG.
    #[error("is not a sound PNG picture: {0}")]
    Png(#[from] png::DecodingError),
    /// A PNG with fewer rows than it says.
    #[error("is not a sound PNG picture: rows are missing")]
    MissingRows,
    /// A broken JPEG.
    #[error("is not a sound JPEG picture: {0}")]
    Jpeg(#[from] image::ImageError),
    /// A JPEG that is too large or cut short.
    #[error("{0}")]
    JpegFile(String),
    /// Neither veins nor ground.
    #[error("has a single colour: no veins to measure")]
    OneColour,
}

/// Whether a file begins as the pictures do that [`read`] reads.
#[must_use]
pub fn is_picture(head: &[u8]) -> bool {
    head.starts_with(b"\x89PNG\r\n\x1a\n") || head.starts_with(&[0xff, 0xd8, 0xff])
}

/// Reads a picture of veins.
///
/// # Errors
///
/// [`MaskError`] says what is wrong with it.
pub fn read(path: &Path) -> Result<VeinMask, MaskError> {
    let mut file = File::open(path)?;
    let mut head = [0; 3];
    file.read_exact(&mut head).map_err(|_| MaskError::NoPicture)?;
    file.seek(SeekFrom::Start(0))?;
    let white = if head == [0xff, 0xd8, 0xff] {
        read_jpeg(&file)?
    } else {
        read_png(BufReader::new(file))?
    };
    let (width, height) = (white.width(), white.height());
    let row = |y: usize| white.row(y).iter().copied();
    let sides = (0..height).flat_map(|y| [white[(0, y)], white[(width - 1, y)]]);
    let border = row(0).chain(row(height - 1)).chain(sides);
    let (total, bright) = border.fold((0, 0), |(n, w), white| (n + 1, w + usize::from(white)));
    let dark_veins = 2 * bright > total;
    let veins = if dark_veins { white.map(|white| !white) } else { white };
    if !veins.values().contains(&true) {
        return Err(MaskError::OneColour);
    }
    Ok(VeinMask { veins, dark_veins })
}

fn check_size(width: u32, height: u32) -> Result<(), MaskError> {
    let pixels = u64::from(width) * u64::from(height);
    if width.max(height) > MOST_SIDE || pixels > MOST_PIXELS {
        return Err(MaskError::TooLarge { width, height });
    }
    Ok(())
}

fn read_png(reader: impl BufRead + Seek) -> Result<Grid<bool>, MaskError> {
    let mut decoder = png::Decoder::new_with_limits(reader, png::Limits { bytes: 256 << 20 });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // The size first: nothing is allocated for what the header claims.
    let info = decoder.read_header_info()?;
    let (width, height, interlaced) = (info.width, info.height, info.interlaced);
    check_size(width, height)?;
    if interlaced {
        return Err(MaskError::Interlaced);
    }
    decoder.set_transformations(
        png::Transformations::normalize_to_color8() | png::Transformations::ALPHA,
    );
    let mut reader = decoder.read_info()?;
    let channels = reader.output_color_type().0.samples();
    let mut values = Vec::new();
    while let Some(row) = reader.next_row()? {
        values.extend(row.data().chunks_exact(channels).map(is_white));
    }
    if values.len() != width as usize * height as usize {
        return Err(MaskError::MissingRows);
    }
    Ok(Grid::from_values(width as usize, height as usize, values))
}

/// Brightness above half, by the weights of Rec. 601; transparent pixels are black.
fn is_white(samples: &[u8]) -> bool {
    let (grey, alpha) = match *samples {
        [grey, alpha] => (u32::from(grey) * 1000, alpha),
        [r, g, b, alpha] => (299 * u32::from(r) + 587 * u32::from(g) + 114 * u32::from(b), alpha),
        _ => return false,
    };
    u64::from(grey) * u64::from(alpha) > 127 * 1000 * 255
}

fn read_jpeg(file: &File) -> Result<Grid<bool>, MaskError> {
    let bytes = jpeg::read(file).map_err(|problem| match problem {
        jpeg::Problem::Read(error) => MaskError::Read(error),
        jpeg::Problem::Content(what) => MaskError::JpegFile(what),
    })?;
    let mut reader = image::ImageReader::new(Cursor::new(bytes));
    reader.set_format(image::ImageFormat::Jpeg);
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(MOST_SIDE);
    limits.max_image_height = Some(MOST_SIDE);
    limits.max_alloc = Some(MOST_DECODED_BYTES);
    reader.limits(limits);
    let picture = reader.decode()?;
    check_size(picture.width(), picture.height())?;
    let grey = picture.into_luma8();
    let (width, height) = (grey.width() as usize, grey.height() as usize);
    let values = grey.into_raw().into_iter().map(|grey| grey > 127).collect();
    Ok(Grid::from_values(width, height, values))
}
