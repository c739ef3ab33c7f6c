//! Pictures of leaves: PNG and JPEG files of any depth and colour type, as 8-bit sRGB with alpha.
//!
//! PNGs are decoded row by row and averaged down while they are read, so a huge scan takes little
//! memory; JPEGs are decoded whole, within a limit. The format is told by content, not by name.

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, Seek};
use std::path::Path;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder};

use super::OutlineProblem;
use crate::io::jpeg;
use crate::margin::silhouette::{MIN_SIDE, Picture};
use crate::raster::Grid;

/// Formats that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// Portable network graphics.
    Png,
    /// JPEG.
    Jpeg,
}

impl Format {
    /// By the first bytes of the file.
    pub(super) fn of(head: &[u8]) -> Option<Self> {
        if head.starts_with(b"\x89PNG\r\n\x1a\n") {
            Some(Self::Png)
        } else if head.starts_with(&[0xff, 0xd8, 0xff]) {
            Some(Self::Jpeg)
        } else {
            None
        }
    }
}

/// The name of a well-known format that is not read, by the first bytes of the file.
pub(super) fn other_format(head: &[u8]) -> Option<&'static str> {
    let formats: [(&[u8], &str); 8] = [
        (b"GIF8", "a GIF picture"),
        (b"RIFF", "a WebP picture"),
        (b"II*\0", "a TIFF picture"),
        (b"MM\0*", "a TIFF picture"),
        (b"BM", "a BMP picture"),
        (b"%PDF", "a PDF document"),
        (b"\x1f\x8b", "a compressed file"),
        (b"PK\x03\x04", "a ZIP archive"),
    ];
    if head.get(4..8) == Some(b"ftyp") {
        return Some("a HEIC or AVIF picture");
    }
    formats.into_iter().find(|(magic, _)| head.starts_with(magic)).map(|(_, name)| name)
}

/// The longer side of a picture is averaged down to at most this (px): finer than any margin needs,
/// and what follows works in tens of megabytes.
const MOST_SIDE: u32 = 4096;
/// PNGs may have this many pixels: a minute of decoding at the most.
const MOST_PNG_PIXELS: u64 = 1 << 29;
/// JPEGs may have this many pixels: they are decoded whole, at 3 bytes each.
const MOST_JPEG_PIXELS: u64 = 120_000_000;

/// The picture, averaged down when it is very large, and what was done to it.
pub(super) fn read(path: &Path, format: Format) -> Result<(Picture, Vec<String>), OutlineProblem> {
    let file = File::open(path)?;
    match format {
        Format::Png => read_png(BufReader::new(file)),
        Format::Jpeg => read_jpeg(&file),
    }
}

/// By what factor a picture of this size is averaged down, when something is left of it.
fn reduction(width: u32, height: u32) -> Result<u32, OutlineProblem> {
    let factor = width.max(height).div_ceil(MOST_SIDE);
    let left = width.min(height) / factor;
    if factor > 1 && (left as usize) < MIN_SIDE {
        return Err(OutlineProblem::Content(format!(
            "the picture is {width} x {height} px; averaged down by {factor}, to at most {MOST_SIDE} px a side, \
             less than {MIN_SIDE} px are left across: cut off what is beside the leaf"
        )));
    }
    Ok(factor)
}

fn reduction_note(width: u32, height: u32, factor: u32) -> Vec<String> {
    if factor == 1 {
        return Vec::new();
    }
    vec![format!("picture of {width} x {height} px averaged down by {factor}")]
}

fn too_large(width: u32, height: u32, most: u64) -> OutlineProblem {
    OutlineProblem::Content(format!(
        "the picture is {width} x {height} px; at most {} megapixels are read: reduce it",
        most / 1_000_000
    ))
}

fn read_png(reader: impl BufRead + Seek) -> Result<(Picture, Vec<String>), OutlineProblem> {
    let broken = |error: png::DecodingError| {
        let what = error.to_string();
        let what = if what.starts_with("CRC error") { "a checksum does not match" } else { &what };
        OutlineProblem::Content(format!("is not a sound PNG picture: {what}"))
    };
    let mut decoder = png::Decoder::new_with_limits(reader, png::Limits { bytes: 256 << 20 });
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    // The size first: nothing is allocated for what the header claims.
    let info = decoder.read_header_info().map_err(broken)?;
    let (width, height, interlaced) = (info.width, info.height, info.interlaced);
    if u64::from(width) * u64::from(height) > MOST_PNG_PIXELS {
        return Err(too_large(width, height, MOST_PNG_PIXELS));
    }
    let factor = reduction(width, height)?;
    if interlaced && factor > 1 {
        return Err(OutlineProblem::Content(format!(
            "the picture is {width} x {height} px and interlaced; above {MOST_SIDE} px save it \
             without interlacing"
        )));
    }
    decoder.set_transformations(
        png::Transformations::normalize_to_color8() | png::Transformations::ALPHA,
    );
    let mut reader = decoder.read_info().map_err(broken)?;
    let channels = reader.output_color_type().0.samples();
    let line = reader.output_line_size(width).unwrap_or(usize::MAX);
    if line > 64 << 20 {
        return Err(too_large(width, height, MOST_PNG_PIXELS));
    }
    let pixels = if interlaced {
        let mut bytes = vec![0; line * height as usize];
        let _ = reader.next_frame(&mut bytes).map_err(broken)?;
        let values = bytes.chunks_exact(channels).map(rgba).collect();
        Grid::from_values(width as usize, height as usize, values)
    } else {
        let mut boxes = Boxes::new(width as usize, height as usize, factor as usize);
        while let Some(row) = reader.next_row().map_err(broken)? {
            boxes.add_row(row.data().chunks_exact(channels).map(rgba));
        }
        boxes.finished().ok_or_else(|| OutlineProblem::content("is not a sound PNG picture"))?
    };
    let picture = Picture { pixels, file_pixels: f64::from(factor) };
    Ok((picture, reduction_note(width, height, factor)))
}

/// Grey, grey and alpha, RGB or RGBA as RGBA.
fn rgba(samples: &[u8]) -> [u8; 4] {
    match *samples {
        [grey] => [grey, grey, grey, 255],
        [grey, alpha] => [grey, grey, grey, alpha],
        [r, g, b] => [r, g, b, 255],
        [r, g, b, a] => [r, g, b, a],
        _ => [0; 4],
    }
}

/// Rows of pixels averaged over squares as they come. Squares cut by the right or lower border are
/// left out unless nothing else is there.
struct Boxes {
    factor: usize,
    width: usize,
    height: usize,
    /// Sums of red, green and blue times alpha, and of alpha, for the row of squares under way.
    sums: Vec<[u64; 4]>,
    rows: usize,
    values: Vec<[u8; 4]>,
}

impl Boxes {
    fn new(width: usize, height: usize, factor: usize) -> Self {
        let (width, height) = ((width / factor).max(1), (height / factor).max(1));
        Self { factor, width, height, sums: vec![[0; 4]; width], rows: 0, values: Vec::new() }
    }

    fn add_row(&mut self, pixels: impl Iterator<Item = [u8; 4]>) {
        if self.factor == 1 {
            self.values.extend(pixels);
            return;
        }
        for (x, [r, g, b, a]) in pixels.enumerate() {
            if let Some(sum) = self.sums.get_mut(x / self.factor) {
                for (sum, value) in sum.iter_mut().zip([r, g, b]) {
                    *sum += u64::from(value) * u64::from(a);
                }
                sum[3] += u64::from(a);
            }
        }
        self.rows += 1;
        if self.rows == self.factor {
            self.flush();
        }
    }

    fn flush(&mut self) {
        let count = (self.rows * self.factor) as u64;
        for sum in &mut self.sums {
            let [r, g, b, a] = std::mem::take(sum);
            // `a` is zero only when the colour is, too.
            let colour = |c: u64| ((c + a / 2) / a.max(1)).min(255) as u8;
            self.values.push([colour(r), colour(g), colour(b), (a / count).min(255) as u8]);
        }
        self.rows = 0;
    }

    fn finished(mut self) -> Option<Grid<[u8; 4]>> {
        if self.rows > 0 && self.values.is_empty() {
            self.flush();
        }
        self.values.truncate(self.width * self.height);
        (self.values.len() == self.width * self.height)
            .then(|| Grid::from_values(self.width, self.height, self.values))
    }
}

fn read_jpeg(file: &File) -> Result<(Picture, Vec<String>), OutlineProblem> {
    let broken = |error: image::ImageError| {
        OutlineProblem::Content(format!("is not a sound JPEG picture: {error}"))
    };
    let bytes = jpeg::read(file).map_err(|problem| match problem {
        jpeg::Problem::Read(error) => OutlineProblem::from(error),
        jpeg::Problem::Content(what) => OutlineProblem::Content(what),
    })?;
    let mut decoder = image::codecs::jpeg::JpegDecoder::new(Cursor::new(bytes)).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MOST_JPEG_PIXELS {
        return Err(too_large(width, height, MOST_JPEG_PIXELS));
    }
    let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
    let mut decoded = DynamicImage::from_decoder(decoder).map_err(broken)?;
    decoded.apply_orientation(orientation);
    let (wide, high) = (decoded.width(), decoded.height());
    let factor = reduction(wide, high)?;
    let channels = usize::from(decoded.color().channel_count());
    let samples = match decoded {
        DynamicImage::ImageLuma8(image) => image.into_raw(),
        DynamicImage::ImageLumaA8(image) => image.into_raw(),
        DynamicImage::ImageRgb8(image) => image.into_raw(),
        other => other.into_rgba8().into_raw(),
    };
    let channels =
        if samples.len() == wide as usize * high as usize * channels { channels } else { 4 };
    let mut boxes = Boxes::new(wide as usize, high as usize, factor as usize);
    for row in samples.chunks_exact(wide as usize * channels) {
        boxes.add_row(row.chunks_exact(channels).map(rgba));
    }
    let pixels =
        boxes.finished().ok_or_else(|| OutlineProblem::content("is not a sound JPEG picture"))?;
    let mut notes = reduction_note(wide, high, factor);
    if orientation != Orientation::NoTransforms {
        notes.push(format!("EXIF orientation {} applied", orientation.to_exif()));
    }
    Ok((Picture { pixels, file_pixels: f64::from(factor) }, notes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averaging_is_exact_on_even_squares_and_weighs_colour_by_alpha() {
        let mut boxes = Boxes::new(5, 4, 2);
        let white = [255, 255, 255, 255];
        let clear = [9, 200, 13, 0];
        for row in [[white, clear], [clear, white], [white, white], [white, white]] {
            boxes.add_row([row[0], row[1], white, white, clear].into_iter());
        }
        let grid = boxes.finished().expect("all rows");
        assert_eq!((grid.width(), grid.height()), (2, 2));
        assert_eq!(grid.values(), [[255, 255, 255, 127], white, white, white]);
    }

    #[test]
    fn a_picture_that_ends_early_is_none() {
        let mut boxes = Boxes::new(2, 2, 1);
        boxes.add_row([[0; 4]; 2].into_iter());
        assert_eq!(boxes.finished(), None);
    }
}
