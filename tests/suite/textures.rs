//! What painting promises: the maps of both sides, against geometry and against each other.

use glam::DVec2;
use palette::{FromColor, Mix};
use venation::geometry::segments::SegmentIndex;
use venation::margin::Margin;
use venation::observer::Silent;
use venation::raster::Grid;
use venation::seed::Seed;
use venation::texture::damage::DamageSpec;
use venation::texture::map::{MapKind, MapSet};
use venation::texture::petiole::PetioleSpec;
use venation::texture::pigment::{ColourModel, ColourSpec, ColourType, Hsv, StateSpec};
use venation::texture::relief::ReliefSpec;
use venation::texture::{Paint, SideMaps, TextureSet, TextureSpec, paint};
use venation::veins::{VeinGraph, Venation};

use crate::sample_leaf;

#[derive(Clone, Default)]
pub(crate) struct Settings {
    pub(crate) texture: TextureSpec,
    pub(crate) petiole: PetioleSpec,
    pub(crate) colour: ColourSpec,
    pub(crate) state: StateSpec,
    pub(crate) damage: DamageSpec,
    pub(crate) relief: ReliefSpec,
}

impl Settings {
    pub(crate) fn of_size(size_px: u64) -> Self {
        Self { texture: TextureSpec { size_px, ..TextureSpec::default() }, ..Self::default() }
    }

    pub(crate) fn as_paint(&self) -> Paint<'_> {
        Paint {
            texture: &self.texture,
            petiole: &self.petiole,
            colour: &self.colour,
            state: &self.state,
            damage: &self.damage,
            relief: &self.relief,
            maps: MapSet::ALL,
            default_speckles: 6,
        }
    }

    pub(crate) fn painted(&self, margin: &Margin, veins: &Venation) -> TextureSet {
        paint(&self.as_paint(), margin, veins, Seed(3), &mut Silent).expect("a leaf can be painted")
    }
}

fn opaque(colour: [u8; 4]) -> bool {
    colour[3] == 255
}

/// A straight midrib, 0.6 mm in radius.
fn midrib(margin: &Margin) -> Venation {
    let mut graph = VeinGraph::new();
    let mut tip = graph.add_root(DVec2::ZERO);
    for i in 1..100 {
        tip = graph.sprout(tip, DVec2::new(0.0, margin.length_mm() * f64::from(i) / 101.0));
    }
    let nodes = graph.len();
    Venation::new(graph, vec![0.6; nodes], vec![1; nodes])
}

#[test]
fn every_guarantee_holds_on_a_sample_leaf() {
    let (margin, veins) = sample_leaf::veined();
    let set = Settings::of_size(256).painted(margin, veins);
    assert_eq!(set.check(), None);
}

#[test]
fn each_map_can_be_had_alone_and_is_the_same() {
    let (margin, veins) = sample_leaf::veined();
    let settings = Settings::of_size(64);
    let all = settings.painted(margin, veins);
    for &map in MapKind::ALL {
        let mut alone = settings.as_paint();
        alone.maps = MapSet::of(&[map]);
        let set = paint(&alone, margin, veins, Seed(3), &mut Silent).expect("a leaf");
        assert_eq!(set.check(), None, "{map}");
        for (alone, all) in [(&set.front, &all.front), (&set.back, &all.back)] {
            let (width, height) = alone.dimensions(map);
            let bytes = map.channels().count() * usize::from(map.bits() / 8) * width * height;
            assert_eq!(alone.samples(map).len(), bytes, "{map}");
            assert!(alone.samples(map) == all.samples(map), "{map}");
        }
    }
}

#[test]
fn coverage_sums_to_the_area_of_the_blade() {
    let margin = sample_leaf::ovate(60.0);
    let mut settings = Settings::of_size(512);
    settings.petiole.length_mm = 0.0;
    let set = settings.painted(&margin, &sample_leaf::bare());
    let texels: f64 =
        set.front.base_colour.values().iter().map(|colour| f64::from(colour[3]) / 255.0).sum();
    let area = texels / set.frame.pixels_per_mm(512).powi(2);
    assert!((area / margin.area_mm2() - 1.0).abs() < 1e-3, "{area} {}", margin.area_mm2());
}

#[test]
fn normals_are_the_slopes_of_the_heights() {
    let (margin, veins) = sample_leaf::veined();
    let set = Settings::of_size(256).painted(margin, veins);
    let texel_mm = 1.0 / set.frame.pixels_per_mm(256);
    for side in [&set.front, &set.back] {
        let height = |x, y| f64::from(side.height[(x, y)]) / 65535.0 * set.height_range_mm;
        let mut seen = 0;
        for y in 1..255 {
            for x in 1..255 {
                let around = [(x, y), (x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)];
                if !around.iter().all(|&at| opaque(side.base_colour[at])) {
                    continue;
                }
                // +x to the right, +y up the picture, against the rows.
                let dx = (height(x + 1, y) - height(x - 1, y)) / (2.0 * texel_mm);
                let dy = (height(x, y - 1) - height(x, y + 1)) / (2.0 * texel_mm);
                let length = (1.0 + dx * dx + dy * dy).sqrt();
                let expected = [-dx / length, -dy / length, 1.0 / length];
                for (byte, expected) in side.normal[(x, y)].into_iter().zip(expected) {
                    let found = f64::from(byte) / 127.5 - 1.0;
                    assert!((found - expected).abs() < 0.012, "({x}, {y}) {found} {expected}");
                }
                seen += 1;
            }
        }
        assert!(seen > 10_000);
    }
}

#[test]
fn a_raised_vein_is_bright_red_on_its_right_side_and_a_sunken_one_on_its_left() {
    let margin = sample_leaf::ovate(60.0);
    let mut settings = Settings::of_size(512);
    settings.petiole.length_mm = 0.0;
    settings.relief.roughness = 0.0;
    settings.relief.quilting_mm = 0.0;
    let set = settings.painted(&margin, &midrib(&margin));
    let offset = 0.5 * 0.6 * set.frame.pixels_per_mm(512);
    let centre = set.frame.pixel_from_leaf(DVec2::new(0.0, 30.0), 512);
    let red = |side: &SideMaps, x: f64| side.normal[(x as usize, centre.y as usize)][0];
    assert!(red(&set.front, centre.x - offset) > 140 && red(&set.front, centre.x + offset) < 116);
    // On the back the picture is mirrored, and the light still comes from its own right.
    let back = 512.0 - centre.x;
    assert!(red(&set.back, back + offset) > 170 && red(&set.back, back - offset) < 86);
    let at = |grid: &Grid<u16>, x: f64| grid[(x as usize, centre.y as usize)];
    assert!(at(&set.front.height, centre.x) < 32768 - 2000);
    assert!(at(&set.back.height, back) > 32768 + 2000);
    assert!(set.front.bump[(centre.x as usize, centre.y as usize)] < 128);
    assert!(set.back.bump[(back as usize, centre.y as usize)] > 128);
}

#[test]
fn the_blade_arches_between_its_larger_veins_up_in_front_and_hollow_behind() {
    let margin = sample_leaf::ovate(60.0);
    let mut settings = Settings::of_size(512);
    settings.petiole.length_mm = 0.0;
    let relief = &mut settings.relief;
    (relief.front_depth, relief.back_height, relief.roughness) = (0.0, 0.0, 0.0);
    (relief.quilting_mm, relief.undulation_mm, relief.pleat_mm) = (0.0, 0.0, 0.8);
    let set = settings.painted(&margin, &midrib(&margin));
    let back = set.back.height.mirrored();
    let height = |map: &Grid<u16>, x_mm: f64| {
        let at = set.frame.pixel_from_leaf(DVec2::new(x_mm, 30.0), 512);
        (f64::from(map[(at.x as usize, at.y as usize)]) / 65535.0 - 0.5) * set.height_range_mm
    };
    let front = |x_mm: f64| height(&set.front.height, x_mm);
    assert!(front(0.0) < 0.2, "{}", front(0.0));
    for (near, far) in [(0.0, 2.0), (2.0, 5.0), (5.0, 9.0), (0.0, -4.0), (-4.0, -9.0)] {
        assert!(front(far) > front(near) + 0.05, "{near} {far}");
        assert!((front(far) + height(&back, far)).abs() < 0.001, "{far}");
    }
    // Three quarters of the way at three times the distance of half.
    assert!((front(9.0) - 0.8 * 0.75).abs() < 0.03, "{}", front(9.0));
    settings.relief.pleat_mm = 0.0;
    let flat = settings.painted(&margin, &midrib(&margin));
    assert!(flat.front.height.values().iter().all(|height| height.abs_diff(32768) <= 1));
}

#[test]
fn empty_texels_wear_the_nearest_opaque_leaf() {
    let (margin, veins) = sample_leaf::veined();
    let set = Settings::of_size(64).painted(margin, veins);
    for side in [&set.front, &set.back] {
        let colour = &side.base_colour;
        let places = || (0..64).flat_map(|y| (0..64).map(move |x| (x, y)));
        let sources: Vec<_> = places().filter(|&at| opaque(colour[at])).collect();
        for at in places().filter(|&at| colour[at][3] == 0) {
            let far = |&(x, y): &(usize, usize)| x.abs_diff(at.0).pow(2) + y.abs_diff(at.1).pow(2);
            let least = sources.iter().map(far).min().expect("a leaf");
            let same = |source: &&(usize, usize)| {
                far(source) == least
                    && colour[**source][..3] == colour[at][..3]
                    && side.height[**source] == side.height[at]
            };
            assert!(sources.iter().find(same).is_some(), "{at:?}");
            assert_eq!(side.normal[at], [128, 128, 255], "{at:?}");
        }
    }
}

#[test]
fn the_back_is_mirrored_paler_and_greyer() {
    let (margin, veins) = sample_leaf::veined();
    let set = Settings::of_size(128).painted(margin, veins);
    let back = set.back.base_colour.mirrored();
    let [mut front_value, mut back_value] = [0_u64; 2];
    for (front, back) in set.front.base_colour.values().iter().zip(back.values()) {
        assert_eq!(front[3], back[3]);
        front_value += u64::from(front[1]);
        back_value += u64::from(back[1]);
    }
    assert!(back_value > front_value * 11 / 10);
}

#[test]
fn edges_take_the_second_colour_along_the_shorter_arc() {
    let margin = sample_leaf::ovate(60.0);
    let mut settings = Settings::of_size(512);
    let colour = &mut settings.colour;
    colour.model = ColourModel::Hsv;
    (colour.undertone, colour.mottle, colour.spread_mm) = (0.0, 0.0, 10.0);
    colour.r#type = ColourType::FromEdges;
    colour.front.base = Hsv { hue_deg: 20.0, saturation: 0.8, value: 0.5 };
    colour.front.alternate = Hsv { hue_deg: 340.0, saturation: 0.8, value: 0.7 };
    let set = settings.painted(&margin, &sample_leaf::bare());
    let edges = SegmentIndex::of_polygon(margin.outline());
    let (base, alternate) = (colour_of(20.0, 0.5), colour_of(340.0, 0.7));
    for i in 0..200 {
        let p = DVec2::new(-12.0 + 0.12 * f64::from(i), 25.0);
        let pixel = set.frame.pixel_from_leaf(p, 512);
        let (x, y) = (pixel.x as usize, pixel.y as usize);
        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        let (distance2, _) =
            edges.nearest(set.frame.leaf_from_pixel(centre, 512), 100.0).expect("an edge");
        let distance = distance2.sqrt();
        if distance < 0.6 {
            continue;
        }
        let weight = (1.0 - distance / 10.0).max(0.0) as f32;
        let expected: palette::Srgb<f32> = palette::Srgb::from_color(base.mix(alternate, weight));
        let found = set.front.base_colour[(x, y)];
        let pairs =
            [(found[0], expected.red), (found[1], expected.green), (found[2], expected.blue)];
        for (found, expected) in pairs {
            let off = f32::from(found) - expected * 255.0;
            assert!(off.abs() < 2.5, "{p}: {found} {}", expected * 255.0);
        }
    }
}

fn colour_of(hue: f32, value: f32) -> palette::Hsv {
    palette::Hsv::new(hue, 0.8, value)
}

#[test]
fn the_bytes_do_not_depend_on_the_number_of_threads() {
    let (margin, veins) = sample_leaf::veined();
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| Settings::of_size(200).painted(margin, veins))
    };
    assert!(on(1) == on(4));
}

#[test]
fn extreme_settings_still_make_a_leaf() {
    let margin = sample_leaf::ovate(40.0);
    let slit = vec![vec![DVec2::new(1.0, 10.0), DVec2::new(6.0, 20.0)]];
    let torn = Margin::new(margin.outline().to_vec(), margin.apex_index(), slit, "").expect("torn");
    let (bare, veined) = (sample_leaf::bare(), sample_leaf::veins(&margin));
    let mut settings = Settings::of_size(48);
    let mut check = |change: &dyn Fn(&mut Settings)| {
        change(&mut settings);
        for veins in [&bare, &veined] {
            assert_eq!(settings.painted(&torn, veins).check(), None);
        }
    };
    check(&|s| s.texture.size_px = 16);
    check(&|s| s.petiole = PetioleSpec { length_mm: 1000.0, width_mm: 100.0, ..s.petiole.clone() });
    check(&|s| s.petiole.length_mm = 0.0);
    check(&|s| (s.colour.vein_spread, s.colour.spread_mm) = (200.0, 1000.0));
    check(&|s| (s.colour.vein_spread, s.colour.spread_mm) = (0.0, 0.0));
    check(&|s| (s.relief.front_depth, s.relief.back_height) = (0.0, 0.0));
    check(&|s| s.texture.gutter = 0.4);
    check(&|s| s.colour.speckle_count = 1000);
}

#[test]
fn a_large_texture_has_the_same_leaf() {
    let margin = sample_leaf::ovate(60.0);
    // Past 2048 texels the guide is coarser than half of them.
    let mut settings = Settings::of_size(2560);
    settings.texture.gutter = 0.38;
    let set = settings.painted(&margin, &midrib(&margin));
    assert_eq!(set.front.base_colour.width(), 2560);
    assert_eq!(set.check(), None);
}

#[test]
fn a_size_beyond_the_limits_is_an_error() {
    let margin = sample_leaf::ovate(60.0);
    let settings = Settings::of_size(20_000);
    let paint_settings = settings.as_paint();
    let error = paint(&paint_settings, &margin, &sample_leaf::bare(), Seed(3), &mut Silent);
    assert!(error.is_err_and(|error| error.to_string().contains("texture.size_px = 20000")));
}

/// Writes every map of a sample leaf under `$PAINT_OUT`, to look at.
#[test]
#[ignore = "writes pictures for people"]
fn pictures_to_look_at() {
    let folder =
        std::path::PathBuf::from(std::env::var("PAINT_OUT").expect("PAINT_OUT is a folder"));
    let size = std::env::var("PAINT_SIZE").map_or(1024, |size| size.parse().expect("a number"));
    let margin = sample_leaf::ovate(80.0);
    let veins = sample_leaf::veins(&margin);
    println!("{} nodes", veins.graph().len());
    let mut settings = Settings::of_size(size);
    if let Ok(word) = std::env::var("PAINT_TYPE") {
        settings.colour.r#type =
            *ColourType::ALL.iter().find(|t| t.word() == word).expect("a type");
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
    println!("range {} mm, {:?}", set.height_range_mm, set.check());
}
