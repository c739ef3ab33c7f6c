//! What the material promises: light that is not made from nothing, seasons that move colours only,
//! films without jumps, wounds that all maps agree on.

use glam::DVec2;
use palette::{FromColor, Lab, Srgb};
use rayon::prelude::*;
use venation::geometry::polygon::signed_area;
use venation::observer::Silent;
use venation::pipeline;
use venation::presets;
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::texture::damage::DamageSpec;
use venation::texture::map::MapKind;
use venation::texture::pigment::{Albedo, ColourModel, ColourType, Hsv};
use venation::texture::{Style, TextureSet, paint};

use crate::sample_leaf;
use crate::support::{contents, fail, fresh, succeed};
use crate::textures::Settings;

fn painted(settings: &Settings) -> TextureSet {
    let (margin, veins) = sample_leaf::veined();
    settings.painted(margin, veins)
}

fn linear(byte: u8) -> f64 {
    let value = f64::from(byte) / 255.0;
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

fn mean(set: &TextureSet) -> [f64; 3] {
    let opaque: Vec<_> = set.front.base_colour.values().iter().filter(|c| c[3] == 255).collect();
    std::array::from_fn(|k| {
        opaque.iter().map(|colour| f64::from(colour[k])).sum::<f64>() / opaque.len() as f64
    })
}

#[test]
fn no_texel_sends_back_and_lets_through_more_light_than_falls_on_it() {
    // The last is bare of all but yellow, which sRGB has no room for: red alone would send back and let
    // through more than white has.
    for (season, health, maturity, green) in [
        (0.0, 1.0, 1.0, 42.0),
        (0.5, 1.0, 1.0, 42.0),
        (1.0, 1.0, 1.0, 42.0),
        (0.2, 0.2, 0.1, 42.0),
        (0.0, 1.0, 1.0, 0.0),
    ] {
        let mut settings = Settings::of_size(128);
        let leaf = &mut settings.colour.pigments.leaf;
        leaf.chlorophyll_ug_cm2 = green;
        (leaf.carotenoid_ug_cm2, leaf.anthocyanin_ug_cm2) = (14.0, 0.0);
        settings.state.season = season;
        settings.state.health = health;
        settings.state.maturity = maturity;
        settings.damage =
            DamageSpec { mines: 0.6, spots: 0.5, scorch: 0.3, ..DamageSpec::default() };
        settings.colour.pigments.back_bloom = 0.5;
        let set = painted(&settings);
        for side in [&set.front, &set.back] {
            let texels = side.base_colour.values().iter().zip(side.translucency.values());
            for (back, through) in texels {
                for c in 0..3 {
                    let sum = linear(back[c]) + linear(through[c]);
                    assert!(sum <= 1.005, "season {season}: {back:?} {through:?}");
                }
            }
        }
    }
}

#[test]
fn a_green_leaf_is_as_light_and_as_green_as_leaves_are() {
    // Bands of total reflectance of dark to mid green leaves.
    let set = painted(&Settings::of_size(128));
    let [r, g, b] = mean(&set).map(|v| (v / 255.0) as f32);
    let lab: Lab = Lab::from_color(Srgb::new(r, g, b));
    assert!((32.0..47.0).contains(&lab.l), "{lab:?}");
    assert!((-22.0..-10.0).contains(&lab.a) && (12.0..33.0).contains(&lab.b), "{lab:?}");
}

#[test]
fn the_season_moves_colours_from_green_to_brown_and_nothing_else() {
    let at = |season| {
        let mut settings = Settings::of_size(128);
        settings.state.season = season;
        painted(&settings)
    };
    let summer = at(0.0);
    let mut hue = f64::INFINITY;
    for season in [0.0, 0.25, 0.5] {
        let set = at(season);
        let next = hue_deg(&set);
        assert!(next < hue - 5.0, "{season}: {next} after {hue}");
        hue = next;
        assert!(set.front.height == summer.front.height && set.back.normal == summer.back.normal);
        assert!(set.front.vein_mask == summer.front.vein_mask);
        let covers = set.front.base_colour.values().iter().zip(summer.front.base_colour.values());
        assert!(covers.into_iter().all(|(a, b)| a[3] == b[3]));
    }
    assert!((25.0..60.0).contains(&hue), "half way it is yellow to orange: {hue}");
    let [r, g, b] = mean(&at(1.0));
    assert!(r > g && g > b && r < 170.0, "litter is brown: {r} {g} {b}");
    // A dry leaf is rougher.
    let rough =
        |set: &TextureSet| set.front.roughness.values().iter().map(|&v| u64::from(v)).sum::<u64>();
    assert!(rough(&at(1.0)) > rough(&summer));
}

#[test]
fn tissue_along_the_larger_veins_stays_green_longest() {
    let mut settings = Settings::of_size(384);
    settings.state.season = 0.5;
    settings.colour.pigments.autumn.islands = 0.0;
    let set = painted(&settings);
    let per_mm = set.frame.pixels_per_mm(384);
    // Along the midrib at half length, and as far from veins as the leaf allows beside it.
    let at = |x: f64| {
        let p = set.frame.pixel_from_leaf(DVec2::new(x, 30.0), 384);
        let [r, g, ..] = set.front.base_colour[(p.x as usize, p.y as usize)];
        f64::from(g) / f64::from(r)
    };
    let near: f64 = (0..12).map(|i| at(1.2 + f64::from(i) / per_mm)).sum();
    let far: f64 = (0..12).map(|i| at(9.0 + f64::from(i) / per_mm)).sum();
    assert!(near > far, "{near} {far}");
}

#[test]
fn sixty_frames_of_a_season_move_no_texel_by_more_than_eight() {
    let mut films = Vec::new();
    for (anthocyanin, r#type) in [(0.5, ColourType::Uniform), (28.0, ColourType::FromEdges)] {
        let mut settings = Settings::of_size(96);
        settings.colour.pigments.autumn.anthocyanin_ug_cm2 = anthocyanin;
        settings.colour.r#type = r#type;
        films.push((format!("{type} with {anthocyanin} of red"), settings));
    }
    for preset in presets::PRESETS {
        let spec = preset.document().expect("valid").resolve(Seed(1)).expect("valid");
        let mut settings = Settings::of_size(96);
        settings.colour = spec.colour;
        films.push((preset.name.to_owned(), settings));
    }
    films.into_par_iter().for_each(|(name, mut settings)| {
        let mut last: Option<TextureSet> = None;
        for frame in 0..60 {
            settings.state.season = f64::from(frame) / 59.0;
            let set = painted(&settings);
            if let Some(last) = last {
                for (a, b) in [(&last.front, &set.front), (&last.back, &set.back)] {
                    for (a, b) in a.base_colour.values().iter().zip(b.base_colour.values()) {
                        let jump = (0..4).map(|c| a[c].abs_diff(b[c])).max();
                        assert!(jump <= Some(8), "{name}, frame {frame}: {a:?} {b:?}");
                    }
                    for (a, b) in a.translucency.values().iter().zip(b.translucency.values()) {
                        let jump = (0..3).map(|c| a[c].abs_diff(b[c])).max();
                        assert!(jump <= Some(8), "{name}, frame {frame}, through: {a:?} {b:?}");
                    }
                }
            }
            last = Some(set);
        }
    });
}

#[test]
fn sickness_yellows_and_youth_is_lighter() {
    let with = |change: &dyn Fn(&mut Settings)| {
        let mut settings = Settings::of_size(96);
        change(&mut settings);
        mean(&painted(&settings))
    };
    let [r, g, _] = with(&|_| {});
    let [sick_r, sick_g, _] = with(&|s| s.state.health = 0.5);
    assert!(sick_r / sick_g > r / g && sick_r > r + 10.0);
    let [_, young, _] = with(&|s| s.state.maturity = 0.0);
    assert!(young > g + 5.0, "{young} {g}");
}

#[test]
fn a_diffuse_base_colour_is_the_total_less_the_surface() {
    let mut settings = Settings::of_size(64);
    let total = painted(&settings);
    settings.colour.albedo = Albedo::Diffuse;
    let diffuse = painted(&settings);
    assert_eq!((total.albedo, diffuse.albedo), (Albedo::Total, Albedo::Diffuse));
    let pairs = total.front.base_colour.values().iter().zip(diffuse.front.base_colour.values());
    let blade = pairs.filter(|(a, _)| a[3] == 255 && a[1] > a[0]).collect::<Vec<_>>();
    assert!(blade.len() > 500);
    let surface = |c: usize| {
        blade.iter().map(|(a, b)| linear(a[c]) - linear(b[c])).sum::<f64>() / blade.len() as f64
    };
    assert!((0.030..0.046).contains(&surface(1)), "{}", surface(1));
}

#[test]
fn hues_chosen_by_hand_turn_with_the_season_and_let_light_through() {
    let at = |season| {
        let mut settings = Settings::of_size(96);
        settings.colour.model = ColourModel::Hsv;
        settings.state.season = season;
        settings.colour.pigments.autumn.anthocyanin_ug_cm2 = 0.0;
        painted(&settings)
    };
    let (summer, autumn, litter) = (at(0.0), at(0.5), at(1.0));
    // In summer as chosen: 92 degrees, and the light that comes through is greener yellow.
    assert!((85.0..100.0).contains(&hue_deg(&summer)), "{}", hue_deg(&summer));
    assert!((35.0..62.0).contains(&hue_deg(&autumn)), "{}", hue_deg(&autumn));
    let [r, g, b] = mean(&litter);
    assert!(r > g && g > b, "{r} {g} {b}");
    for set in [&summer, &autumn, &litter] {
        let texels = set.front.base_colour.values().iter().zip(set.front.translucency.values());
        let mut shine = 0;
        for (back, through) in texels {
            for c in 0..3 {
                assert!(linear(back[c]) + linear(through[c]) <= 1.005, "{back:?} {through:?}");
            }
            shine += usize::from(back[3] == 255 && through[0].max(through[1]) > 60);
        }
        assert!(shine > 1000, "{shine}");
    }
    // A thin pale leaf lets more light through than a deep green one.
    let through = |value: f64, saturation: f64| {
        let mut settings = Settings::of_size(96);
        settings.colour.model = ColourModel::Hsv;
        settings.colour.front.base = Hsv { hue_deg: 92.0, saturation, value };
        let set = painted(&settings);
        set.front.translucency.values().iter().map(|texel| u64::from(texel[1])).sum::<u64>()
    };
    let (pale, deep) = (through(0.6, 0.5), through(0.3, 0.45));
    assert!(pale > deep * 5 / 4, "{pale} {deep}");
}

#[test]
fn evergreen_leaves_stay_green_until_they_die() {
    let at = |kept, season| {
        let mut settings = Settings::of_size(96);
        settings.colour.pigments.autumn.chlorophyll_kept = kept;
        settings.state.season = season;
        hue_deg(&painted(&settings))
    };
    let [summer, evergreen, turned, dead] =
        [at(0.9, 0.0), at(0.9, 0.5), at(0.0, 0.5), at(0.9, 1.0)];
    let half = 0.5 * (summer + turned);
    assert!(evergreen > half && turned < 62.0, "{summer} {evergreen} {turned}");
    assert!(dead < 45.0, "{dead}");
}

#[test]
fn sixteen_bits_are_more_than_eight_and_agree_with_them() {
    let (margin, veins) = sample_leaf::veined();
    let settings = Settings::of_size(96);
    let mut deep = settings.as_paint();
    deep.maps = deep.maps.deep();
    let deep = paint(&deep, margin, veins, Seed(3), &mut Silent).expect("a leaf");
    let plain = settings.painted(margin, veins);
    for (deep, plain) in [(&deep.front, &plain.front), (&deep.back, &plain.back)] {
        for map in [
            MapKind::BaseColour,
            MapKind::Opacity,
            MapKind::Roughness,
            MapKind::Gloss,
            MapKind::AmbientOcclusion,
            MapKind::Orm,
            MapKind::MaskMap,
            MapKind::Translucency,
            MapKind::VeinMask,
        ] {
            assert!(deep.samples(map) == plain.samples(map), "{map}: 8 bits are what they were");
            let (fine, coarse) = (deep.samples_of(map, 16, 1.0), plain.samples(map));
            assert_eq!(fine.len(), 2 * coarse.len());
            let mut between = 0;
            for (pair, &byte) in fine.chunks_exact(2).zip(&coarse) {
                let value = u16::from_be_bytes([pair[0], pair[1]]);
                let off = f64::from(value) / 257.0 - f64::from(byte);
                assert!(off.abs() <= 0.51, "{map}: {value} {byte}");
                between += usize::from(value % 257 != 0);
            }
            let few = if map == MapKind::Opacity { 50 } else { 1000 };
            assert!(between > few, "{map}: {between} values are between those of 8 bits");
        }
    }
}

/// Of the mean colour, as long as red or green is the greatest and blue the least.
fn hue_deg(set: &TextureSet) -> f64 {
    let [r, g, b] = mean(set);
    let spread = r.max(g) - b;
    if r >= g { 60.0 * (g - b) / spread } else { 60.0 * (2.0 - (r - b) / spread) }
}

fn cover(set: &TextureSet) -> f64 {
    let texels = set.front.base_colour.values().iter();
    texels.map(|colour| f64::from(colour[3]) / 255.0).sum()
}

#[test]
fn wounds_take_the_share_they_are_asked_for_and_spare_what_they_should() {
    let mut settings = Settings::of_size(512);
    settings.petiole.length_mm = 0.0;
    let whole = painted(&settings);
    for (wound, damage) in [
        ("holes", DamageSpec { holes: 0.2, ..DamageSpec::default() }),
        ("bites", DamageSpec { margin_bites: 0.25, ..DamageSpec::default() }),
    ] {
        settings.damage = damage;
        let hurt = painted(&settings);
        let share = 1.0 - cover(&hurt) / cover(&whole);
        let asked = settings.damage.holes + settings.damage.margin_bites;
        assert!((share / asked - 1.0).abs() < 0.15, "{wound}: {share} for {asked}");
        // Both sides and all maps agree, and the outline does.
        assert_eq!(hurt.check(), None);
        let rings: f64 = hurt.rings.iter().map(|ring| signed_area(ring)).sum();
        let area = cover(&hurt) / hurt.frame.pixels_per_mm(512).powi(2);
        assert!((rings / area - 1.0).abs() < 0.02, "{wound}: {rings} {area}");
        let order = hurt.front.vein_order.values();
        for (i, colour) in hurt.front.base_colour.values().iter().enumerate() {
            if colour[3] == 0 {
                assert_eq!((order[i], hurt.front.vein_mask.values()[i]), (0, 0));
                assert_eq!(hurt.front.thickness.values()[i], 0);
            }
        }
        // Primary veins stand.
        let primary = whole.front.vein_order.values().iter().zip(whole.front.vein_mask.values());
        let stands = |((&order, &mask), after): ((&u8, &u8), &[u8; 4])| {
            order != 1 || mask < 255 || after[3] == 255
        };
        assert!(primary.zip(hurt.front.base_colour.values()).all(stands), "{wound}");
        // Elsewhere it is the same leaf: texels far from every wound have not changed.
        let pairs = whole.front.base_colour.values().iter().zip(hurt.front.base_colour.values());
        let same = pairs.filter(|(a, b)| a[3] == 255 && a == b).count();
        assert!(same as f64 > 0.4 * cover(&whole), "{wound}: {same}");
    }
}

#[test]
fn eaten_leaves_hang_together_and_their_veins_end_at_the_gaps() {
    let mut settings = Settings::of_size(384);
    settings.damage = DamageSpec { holes: 0.25, margin_bites: 0.25, ..DamageSpec::default() };
    for seed in 1..=3 {
        settings.damage.seed = seed;
        let set = painted(&settings);
        let solid = set.front.base_colour.map(|colour| colour[3] > 127);
        let parts = venation::raster::components::Components::of(&solid);
        let of_size = parts.areas[1..].iter().filter(|&&area| area > 12).count();
        assert_eq!(of_size, 1, "{:?}", parts.areas);
    }
    let folder = fresh();
    let arguments = ["generate", "linden", "--size", "256", "--damage", "holes=0.25"];
    let files = ["--maps", "opacity", "--format", "json,svg", "-o", "eaten"];
    succeed(folder.path(), &[&arguments[..], &files].concat());
    let open = |name: &str| folder.path().join("eaten").join(name);
    let opacity = image::open(open("tilia-cordata_Opacity.png")).expect("a map").into_luma8();
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(open(name)).expect("a file")).expect("JSON")
    };
    let (veins, manifest) = (json("tilia-cordata_veins.json"), json("manifest.json"));
    let number = |value: &serde_json::Value| value.as_f64().expect("a number");
    let front = &manifest["uv_from_mm"]["front"];
    let pixel = |mm: f64, axis: usize| {
        (mm * number(&front["scale"][axis]) + number(&front["offset"][axis])) * 256.0
    };
    let nodes = veins["nodes"].as_array().expect("nodes");
    let bare = nodes.iter().filter(|node| {
        let (x, y) = (pixel(number(&node["x"]), 0), 256.0 - pixel(number(&node["y"]), 1));
        // A node on the edge of a gap may lie in a texel that is all but empty.
        let around = [(0.0, 0.0), (0.7, 0.0), (-0.7, 0.0), (0.0, 0.7), (0.0, -0.7)];
        let open = |(dx, dy): &(f64, f64)| opacity.get_pixel((x + dx) as u32, (y + dy) as u32).0[0];
        around.iter().all(|place| open(place) == 0)
    });
    let bare = bare.count();
    assert!(nodes.len() > 500 && bare < nodes.len() / 500, "{bare} of {}", nodes.len());
}

#[test]
fn tears_cut_nothing_off() {
    let preset = presets::find("maple").expect("a preset").document().expect("valid");
    let mut spec = preset.resolve(Seed(1)).expect("valid");
    spec.texture.size_px = 384;
    spec.veins.spawn_rate /= 10.0;
    let grown = pipeline::grow(&spec, Seed(1), &mut Silent).expect("it grows");
    let paint =
        |spec: &LeafSpec| pipeline::paint(spec, &grown, Seed(1), &mut Silent).expect("it paints");
    let whole = cover(&paint(&spec));
    spec.damage.tears = 1.0;
    for seed in 1..=4 {
        spec.damage.seed = seed;
        let torn = paint(&spec);
        // Ten tears take no more than what is between their edges.
        let left = cover(&torn) / whole;
        assert!(left > 0.93 && left < 0.995, "{left} of the blade are left");
        assert_eq!(torn.rings.len(), 1, "neither holes nor pieces");
    }
}

#[test]
fn mines_are_blisters_over_thin_tissue_and_spots_have_a_rim() {
    let mut settings = Settings::of_size(512);
    let sound = painted(&settings);
    settings.damage = DamageSpec { mines: 1.0, ..DamageSpec::default() };
    let mined = painted(&settings);
    let texels = 0..512 * 512;
    let at = |i: usize| {
        let before = i32::from(sound.front.height.values()[i]);
        let thick = i32::from(sound.front.thickness.values()[i]);
        let left = i32::from(mined.front.thickness.values()[i]);
        (i32::from(mined.front.height.values()[i]) - before, left - thick)
    };
    let changed: Vec<_> = texels.clone().map(at).filter(|(_, thin)| *thin < 0).collect();
    assert!(changed.len() > 500, "{}", changed.len());
    let raised = changed.iter().filter(|(raised, _)| *raised > 0).count();
    assert!(raised * 10 > changed.len() * 8, "{raised} of {}", changed.len());
    settings.damage = DamageSpec { spots: 1.0, ..DamageSpec::default() };
    let spotted = painted(&settings);
    let heights = |set: &TextureSet| set.front.height.values().to_vec();
    let (before, after) = (heights(&sound), heights(&spotted));
    let higher = texels.clone().filter(|&i| after[i] > before[i]).count();
    let lower = texels.filter(|&i| after[i] < before[i]).count();
    assert!(higher > 100 && lower > 100, "{higher} {lower}");
}

#[test]
fn skeletons_keep_their_veins_and_another_seed_wounds_elsewhere() {
    let mut settings = Settings::of_size(384);
    settings.damage.skeletonise = 1.0;
    let bare = painted(&settings);
    let whole = painted(&Settings::of_size(384));
    assert!(cover(&bare) < 0.75 * cover(&whole) && cover(&bare) > 0.05 * cover(&whole));
    let veins = whole.front.vein_mask.values().iter().zip(bare.front.base_colour.values());
    let kept: Vec<u8> = veins.filter(|(mask, _)| **mask == 255).map(|(_, c)| c[3]).collect();
    assert!(kept.len() > 100 && kept.iter().all(|&alpha| alpha == 255));
    settings.damage = DamageSpec { holes: 0.1, ..DamageSpec::default() };
    let own = painted(&settings);
    settings.damage.seed = 9;
    assert!(painted(&settings).rings != own.rings);
}

#[test]
fn spots_are_dry_within_a_dark_rim() {
    let mut settings = Settings::of_size(512);
    let whole = painted(&settings).front.base_colour;
    settings.damage.spots = 1.0;
    let spotted = painted(&settings).front.base_colour;
    let light = |[r, g, b, _]: [u8; 4]| u32::from(r) + u32::from(g) + u32::from(b);
    let is_brown = |[r, g, _, a]: [u8; 4]| a == 255 && r > g;
    let (side, mut dry, mut rim) = (whole.width(), 0, 0);
    for (x, y) in (2..side - 2).flat_map(|y| (2..side - 2).map(move |x| (x, y))) {
        let (now, before) = (spotted[(x, y)], whole[(x, y)]);
        if !is_brown(now) || before[3] < 255 {
            continue;
        }
        rim += usize::from(light(now) < light(before));
        if 10 * light(now) > 14 * light(before) {
            dry += 1;
            // Green tissue does not touch it: the rim lies between them.
            for (i, j) in [(x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)] {
                assert!(spotted[(i, j)][3] < 255 || is_brown(spotted[(i, j)]), "at {x}, {y}");
            }
        }
    }
    assert!(dry > 50 && rim > 50, "{dry} dry, {rim} in rims");
}

#[test]
fn the_preview_is_lit_and_the_enhancement_has_six_steps() {
    let mut settings = Settings::of_size(64);
    let set = painted(&settings);
    assert_eq!((set.front.preview.width(), set.front.preview.height()), (192, 64));
    assert!(set.back.preview.values().is_empty());
    // Against the light the paper is dark and the leaf shines.
    let [paper, ..] = set.front.preview[(0, 0)];
    let [dusk, ..] = set.front.preview[(191, 0)];
    assert!(paper > 200 && dusk < 80);
    assert_eq!((set.back.enhancement.width(), set.back.enhancement.height()), (192, 128));
    settings.texture.style = Style::Enhanced;
    let enhanced = painted(&settings);
    for (y, x) in [(20, 30), (40, 33)] {
        let [r, g, b, _] = enhanced.front.base_colour[(x, y)];
        assert_eq!([r, g, b], set.front.enhancement[(128 + x, 64 + y)]);
    }
}

#[test]
fn the_year_is_a_sheet_with_a_table_or_a_film() {
    let folder = fresh();
    let small = ["--size", "64", "--set", "growth.type=none"];
    let with = |more: &[&'static str]| {
        [&["compare", "maple", "--by", "season"][..], &small, more].concat()
    };
    succeed(folder.path(), &with(&["-o", "year.png", "--csv", "year.csv"]));
    let table = std::fs::read_to_string(folder.path().join("year.csv")).expect("a table");
    let hues: Vec<f64> = table
        .lines()
        .skip(2)
        .map(|line| line.rsplit(',').next().and_then(|hue| hue.parse().ok()).expect("a hue"))
        .collect();
    // From summer on the hue falls from green to brown.
    assert!(hues.len() == 5 && hues[0] > 70.0, "{hues:?}");
    assert!(hues.windows(2).take(2).all(|pair| pair[0] > pair[1]), "{hues:?}");
    assert!(hues[4] < 45.0, "{hues:?}");
    succeed(folder.path(), &with(&["-o", "film", "--frames", "3"]));
    let names: Vec<_> = contents(&folder.path().join("film")).into_keys().collect();
    assert_eq!(names.len(), 3);
    succeed(folder.path(), &with(&["-o", "film.png", "--frames", "3"]));
    let film = std::fs::read(folder.path().join("film.png")).expect("a film");
    assert_eq!(film.windows(4).filter(|kind| kind == b"fcTL").count(), 3);
    let message = fail(folder.path(), 2, &["compare", "maple", "--frames", "3", "-o", "x.png"]);
    assert!(message.contains("--by season"), "{message}");
}

#[test]
fn every_leaf_of_a_batch_draws_its_own_state_from_a_range() {
    let folder = fresh();
    let flags = ["--season", "0.2..0.8", "--length-mm=30..60", "--size", "32", "-o", "many"];
    let mut command = vec!["generate", "beech", "--seeds", "1-4"];
    command.extend(flags);
    command.extend(["--set", "veins.spawn_rate=5", "--maps", "basecolor"]);
    succeed(folder.path(), &command);
    let number = |seed: usize, key: &str| -> f64 {
        let path = format!("many/fagus-sylvatica_s{seed:04}/leaf.toml");
        let text = std::fs::read_to_string(folder.path().join(path)).expect("its settings");
        let line = text.lines().find(|line| line.starts_with(key)).expect("the key");
        line.split('=').nth(1).expect("a value").trim().parse().expect("a number")
    };
    for (key, range) in [("season ", 0.2..=0.8), ("length_mm ", 30.0..=60.0)] {
        let mut drawn: Vec<f64> = (1..=4).map(|seed| number(seed, key)).collect();
        assert!(drawn.iter().all(|value| range.contains(value)), "{key}{drawn:?}");
        drawn.sort_by(f64::total_cmp);
        drawn.dedup();
        assert_eq!(drawn.len(), 4, "{key}{drawn:?}");
    }
}

#[test]
fn states_and_wounds_out_of_range_are_refused_by_name() {
    let folder = fresh();
    for (flags, part) in [
        (["--season", "1.5"], "state.season"),
        (["--health", "-1"], "state.health"),
        (["--season", "autumn"], "state.season"),
        (["--maturity", "0.2..1.2"], "state.maturity"),
        (["--damage", "holes=2"], "damage.holes"),
        (["--damage", "hole=0.1"], "damage.holes"),
        (["--damage", "holes"], "holes"),
    ] {
        let flag = format!("{}={}", flags[0], flags[1]);
        let message = fail(folder.path(), 2, &["generate", "beech", &flag]);
        assert!(message.contains(part), "{flags:?}: {message}");
    }
    assert!(contents(folder.path()).is_empty());
}
