//! What painting promises: the maps of both sides, against geometry and against each other.

use glam::DVec2;
use venation::margin::Margin;
use venation::observer::Silent;
use venation::seed::Seed;
use venation::texture::petiole::PetioleSpec;
use venation::texture::pigment::ColourSpec;
use venation::texture::relief::ReliefSpec;
use venation::texture::{Paint, TextureSet, TextureSpec, paint};
use venation::veins::Venation;

use crate::sample_leaf;

#[derive(Clone, Default)]
struct Settings {
    texture: TextureSpec,
    petiole: PetioleSpec,
    colour: ColourSpec,
    relief: ReliefSpec,
}

impl Settings {
    fn of_size(size_px: u64) -> Self {
        Self { texture: TextureSpec { size_px, ..TextureSpec::default() }, ..Self::default() }
    }

    fn painted(&self, margin: &Margin, veins: &Venation) -> TextureSet {
        let settings = Paint {
            texture: &self.texture,
            petiole: &self.petiole,
            colour: &self.colour,
            relief: &self.relief,
            default_speckles: 6,
        };
        paint(&settings, margin, veins, Seed(3), &mut Silent).expect("a leaf can be painted")
    }
}

/// Writes every map of a sample leaf under `$PAINT_OUT`, to look at.
#[test]
#[ignore = "writes pictures for people"]
fn pictures_to_look_at() {
    let folder = std::path::PathBuf::from(std::env::var("PAINT_OUT").expect("PAINT_OUT is a folder"));
    let size = std::env::var("PAINT_SIZE").map_or(1024, |size| size.parse().expect("a number"));
    let margin = sample_leaf::ovate(80.0);
    let veins = sample_leaf::veins(&margin);
    println!("{} nodes", veins.graph().len());
    let mut settings = Settings::of_size(size);
    if let Ok(word) = std::env::var("PAINT_TYPE") {
        let types = venation::texture::pigment::ColourType::ALL;
        settings.colour.r#type = *types.iter().find(|t| t.word() == word).expect("a type");
    }
    let start = std::time::Instant::now();
    let set = settings.painted(&margin, &veins);
    println!("{:?}", start.elapsed());
    for (name, side) in [("front", &set.front), ("back", &set.back)] {
        let at = |map: &str| folder.join(format!("{name}_{map}.png"));
        let side_px = size as u32;
        let flat = side.base_colour.values().as_flattened().to_vec();
        image::RgbaImage::from_raw(side_px, side_px, flat).unwrap().save(at("colour")).unwrap();
        let flat = side.normal.values().as_flattened().to_vec();
        image::RgbImage::from_raw(side_px, side_px, flat).unwrap().save(at("normal")).unwrap();
        let flat = side.height.values().to_vec();
        image::ImageBuffer::<image::Luma<u16>, _>::from_raw(side_px, side_px, flat)
            .unwrap()
            .save(at("height"))
            .unwrap();
        let flat = side.bump.values().to_vec();
        image::GrayImage::from_raw(side_px, side_px, flat).unwrap().save(at("bump")).unwrap();
    }
    println!("range {} mm, {:?}, {}", set.height_range_mm, set.check(), DVec2::ZERO);
}
