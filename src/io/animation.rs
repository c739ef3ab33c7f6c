//! Pictures one after the other, as an animated PNG.
//!
//! Browsers and Blender play it. APNG is PNG to programs that know no animations: they show the first
//! picture.

use crate::raster::Grid;

/// An animation of pictures of one size, sRGB with straight alpha, `per_second` of them a second,
/// repeated for ever.
///
/// # Panics
///
/// Without a picture, with an empty one, or when sizes differ.
#[must_use]
pub fn apng(frames: &[Grid<[u8; 4]>], per_second: u16) -> Vec<u8> {
    let first = frames.first().expect("an animation has frames");
    let size = (first.width(), first.height());
    assert!(frames.iter().all(|frame| (frame.width(), frame.height()) == size), "one size");
    let mut file = Vec::new();
    write(&mut file, frames, per_second).expect("memory takes what is written to it");
    file
}

fn write(
    file: &mut Vec<u8>,
    frames: &[Grid<[u8; 4]>],
    per_second: u16,
) -> Result<(), png::EncodingError> {
    let side = |pixels| u32::try_from(pixels).expect("a side of a picture fits in 32 bits");
    let mut encoder = png::Encoder::new(file, side(frames[0].width()), side(frames[0].height()));
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_deflate_compression(png::DeflateCompression::Level(2));
    encoder.set_filter(png::Filter::Sub);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder.set_animated(side(frames.len()), 0)?;
    encoder.set_frame_delay(1, per_second.max(1))?;
    encoder.add_text_chunk("Software".into(), super::GENERATOR.into())?;
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(frame.values().as_flattened())?;
    }
    writer.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_frame_is_read_back() {
        let frames: Vec<Grid<[u8; 4]>> =
            (0..4_u8).map(|i| Grid::filled(5, 3, [i, 2 * i, 200, 255])).collect();
        let bytes = apng(&frames, 24);
        let mut reader =
            png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().expect("a PNG");
        let control = *reader.info().animation_control().expect("an animation");
        assert_eq!((control.num_frames, control.num_plays), (4, 0));
        let mut samples = vec![0; 5 * 3 * 4];
        for frame in &frames {
            reader.next_frame(&mut samples).expect("a frame");
            assert_eq!(samples, frame.values().as_flattened());
            let delay = reader.info().frame_control().expect("a frame");
            assert_eq!((delay.delay_num, delay.delay_den), (1, 24));
        }
    }
}
