//! Names and packing for other programs, finer bits and smaller levels, against the maps they are made
//! from.

use std::collections::BTreeSet;

use venation::io::{FormatKind, LeafFiles, MapKind, encode_leaf, file_names};
use venation::spec::{Output, OutputSpec, Profile};

use super::{SIZE, SmallLeaf, bytes_of, everything};

fn profile(profile: Profile) -> Output {
    OutputSpec { profile, formats: "none".into(), ..OutputSpec::default() }.resolve().unwrap()
}

fn names(name: &str, profile_: Profile) -> BTreeSet<String> {
    file_names(name, SIZE, &profile(profile_))
        .into_iter()
        .filter(|name| name.ends_with(".png") && !name.starts_with("back/"))
        .collect()
}

#[test]
fn every_profile_has_its_names() {
    let expect = |profile: Profile, expected: &[&str]| {
        let expected: BTreeSet<String> = expected.iter().map(|name| (*name).to_owned()).collect();
        let names = names("Acer-platanoides", profile);
        assert!(names.is_superset(&expected), "{profile}: {names:?}");
    };
    let n = |suffix: &str| format!("Acer-platanoides_{suffix}.png");
    expect(
        Profile::Default,
        &[&n("BaseColor"), &n("Opacity"), &n("Normal"), &n("Height"), &n("Roughness"), &n("ORM")],
    );
    let unreal = ["BC", "N", "ORM", "H", "T"].map(|s| format!("T_Acer-platanoides_{s}.png"));
    expect(Profile::Unreal, &unreal.each_ref().map(String::as_str));
    expect(Profile::UnityHdrp, &[&n("BaseMap"), &n("Normal"), &n("MaskMap"), &n("Height")]);
    let haven = ["diff", "nor_gl", "nor_dx", "disp", "rough", "ao", "arm", "alpha"]
        .map(|s| format!("acer_platanoides_{s}.png"));
    expect(Profile::PolyHaven, &haven.each_ref().map(String::as_str));
    expect(
        Profile::AmbientCg,
        &[&n("Color"), &n("NormalGL"), &n("NormalDX"), &n("Displacement"), &n("AmbientOcclusion")],
    );
    expect(Profile::SpeedTree, &[&n("Color"), &n("Opacity"), &n("Normal"), &n("Gloss")]);
    // No name that a material importer takes for glass, and no two maps of one name.
    for &profile_ in Profile::ALL {
        let output = Output { maps: MapKind::ALL.to_vec(), ..profile(profile_) };
        let files = file_names("oak", SIZE, &output);
        assert!(files.iter().all(|name| !name.contains("Transmission")));
        assert_eq!(files.iter().collect::<BTreeSet<_>>().len(), files.len(), "{profile_}");
    }
}

#[test]
fn packed_and_turned_maps_agree_with_what_they_are_made_of() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    for (folder, side) in [("", &leaf.textures.front), ("back/", &leaf.textures.back)] {
        let decoded = |suffix: &str| {
            image::load_from_memory(bytes_of(&files, &format!("{folder}oak_{suffix}.png"))).unwrap()
        };
        let (gl, dx) = (decoded("Normal").into_rgb8(), decoded("NormalDX").into_rgb8());
        for (gl, dx) in gl.pixels().zip(dx.pixels()) {
            assert_eq!((gl[0], gl[2], gl[1]), (dx[0], dx[2], 255 - dx[1]));
        }
        let mask = decoded("MaskMap").into_rgba8();
        let (roughness, occlusion) = (side.roughness.values(), side.occlusion.values());
        for (i, pixel) in mask.pixels().enumerate() {
            assert_eq!(pixel.0, [0, occlusion[i], 128, 255 - roughness[i]]);
        }
        let gloss = decoded("Gloss").into_luma8();
        assert!(
            gloss.pixels().zip(roughness).all(|(gloss, roughness)| gloss[0] == 255 - roughness)
        );
    }
}

#[test]
fn sixteen_bits_are_finer_normals_and_the_same_picture() {
    let leaf = SmallLeaf::new("oak");
    let output = Output { bits: 16, ..everything() };
    let files = encode_leaf(&LeafFiles { output: &output, ..leaf.files() });
    let coarse = leaf.encoded();
    for &map in MapKind::ALL {
        let name = format!("oak_{}.png", map.suffix());
        let fine = bytes_of(&files, &name);
        let depth = fine[24];
        use MapKind as M;
        let coarse_only = [M::VeinOrder, M::Bump, M::Preview, M::Enhancement].contains(&map);
        assert_eq!(depth, if coarse_only { 8 } else { 16 }, "{map}");
        if map == MapKind::Normal || map == MapKind::NormalDx {
            continue; // The heights of this leaf are not those of its normals.
        }
        let fine = image::load_from_memory(fine).unwrap().into_rgba8();
        let coarse = image::load_from_memory(bytes_of(&coarse, &name)).unwrap().into_rgba8();
        let off = fine.iter().zip(coarse.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(off.unwrap() <= 1, "{map}: {off:?}");
    }
}

#[test]
fn a_grown_leafs_fine_normals_round_to_its_coarse_ones() {
    use venation::observer::Silent;
    use venation::{pipeline, presets, seed::Seed};
    let mut document = presets::find("beech").unwrap().document().unwrap();
    for setting in
        ["texture.size_px=256", "veins.kill_distance_mm=4", "output.bits=16", "output.mips=true"]
    {
        document.set(setting, "test").unwrap();
    }
    let spec = document.resolve(Seed(1)).unwrap();
    let leaf = pipeline::generate(&spec, Seed(1), &mut Silent).unwrap();
    let set = &leaf.textures;
    let per_texel = set.height_range_mm / 65535.0 * set.frame.pixels_per_mm(256);
    let (mut distinct, mut covered) = (BTreeSet::new(), 0);
    for side in [&set.front, &set.back] {
        for map in [MapKind::Normal, MapKind::NormalDx] {
            let fine = side.samples_of(map, 16, per_texel as f32);
            let coarse = side.samples(map);
            for (fine, coarse) in fine.as_chunks::<2>().0.iter().zip(coarse) {
                let fine = u16::from_be_bytes(*fine);
                assert!((fine >> 8).abs_diff(u16::from(coarse)) <= 1, "{fine} {coarse}");
                distinct.insert(fine);
                covered += 1;
            }
        }
    }
    assert!(distinct.len() > 1000 && covered > 0, "{} values", distinct.len());
    // The edge stays green on smaller levels: its colours are those of the leaf beside it.
    let levels = venation::texture::mip::levels(&set.front);
    let share = |side: &venation::texture::SideMaps| {
        let passed = side.base_colour.values().iter().filter(|texel| texel[3] >= 128).count();
        passed as f64 / side.base_colour.values().len() as f64
    };
    for level in &levels[..5] {
        let off = (share(level) - share(&set.front)).abs();
        // No level can tell less than half a texel.
        let least = 0.5 / (level.size() * level.size()) as f64;
        assert!(off <= 0.01_f64.max(least), "{off} at {}", level.size());
    }
    for (level, green) in levels[..5].iter().zip(edge_greens(&set.front, 5)) {
        let mut sums = [0.0; 2];
        for (texel, &(green, cover)) in level.base_colour.values().iter().zip(green.values()) {
            if cover > 0.0 && cover < 1.0 {
                sums[0] += f64::from(texel[1]);
                sums[1] += green;
            }
        }
        let ratio = sums[0] / sums[1];
        assert!((ratio - 1.0).abs() < 0.03, "{ratio} at {}", level.size());
    }
}

/// For every level the green that a plain box filter makes of the spread colours, in linear light, and
/// the share of each texel that the leaf covers.
fn edge_greens(
    side: &venation::texture::SideMaps,
    levels: usize,
) -> Vec<venation::raster::Grid<(f64, f64)>> {
    use palette::Srgb;
    let picture = &side.base_colour;
    (1..=levels)
        .map(|level| {
            let block = 1 << level;
            let size = picture.width() / block;
            let values = (0..size * size).map(|i| {
                let (x, y) = (i % size * block, i / size * block);
                let texels = (0..block * block).map(|k| picture[(x + k % block, y + k / block)]);
                let count = (block * block) as f64;
                let light: f32 = texels
                    .clone()
                    .map(|t| Srgb::new(t[0], t[1], t[2]).into_linear::<f32>().green)
                    .sum();
                let cover: f64 = texels.map(|t| f64::from(t[3]) / 255.0).sum::<f64>() / count;
                let linear = palette::LinSrgb::new(0.0, light / count as f32, 0.0);
                let encoded: Srgb<f32> = Srgb::from_linear(linear);
                (f64::from(encoded.green) * 255.0, cover)
            });
            venation::raster::Grid::from_values(size, size, values.collect())
        })
        .collect()
}

#[test]
fn smaller_levels_are_announced_and_halve_down_to_one_texel() {
    let leaf = SmallLeaf::new("oak");
    let output = Output {
        mips: true,
        maps: vec![MapKind::BaseColour, MapKind::VeinOrder],
        formats: vec![FormatKind::Json],
        ..Output::standard()
    };
    let files = encode_leaf(&LeafFiles { output: &output, ..leaf.files() });
    let written: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(written, file_names("oak", SIZE, &output));
    for (level, side) in [(1, 24), (2, 12), (3, 6), (4, 3), (5, 1)] {
        let name = format!("back/mips/oak_BaseColor_{level}.png");
        let picture = image::load_from_memory(bytes_of(&files, &name)).unwrap();
        assert_eq!((picture.width(), picture.height()), (side, side));
    }
    assert!(!written.contains(&"mips/oak_BaseColor_6.png"));
}
