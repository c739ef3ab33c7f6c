//! Expected pictures, which are also the README's, so that neither goes stale.
//!
//! `BLESS=1 cargo test golden` rewrites them. A picture that differs leaves what was made and a
//! difference picture in the folder that the message names.

use std::path::{Path, PathBuf};

use venation::document::Document;
use venation::io::image::{Caption, colour_png};
use venation::io::outline::{self, OutlineKind, OutlineOptions};
use venation::observer::Silent;
use venation::pipeline::{self, Leaf};
use venation::presets::{self, PRESETS};
use venation::raster::Grid;
use venation::raster::montage::{self, Layout, Panel};
use venation::seed::Seed;

pub(crate) type Picture = Grid<[u8; 4]>;

/// A channel may be off by this much: rounding of the last bit in another build.
const CHANNEL_TOLERANCE: u8 = 3;

/// This share of the pixels may be off by more: a speck at an edge.
const PIXEL_TOLERANCE: f64 = 5e-4;

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(format!("{name}.png"))
}

pub(crate) fn read(path: &Path) -> Option<Picture> {
    let picture = image::open(path).ok()?.into_rgba8();
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let values = picture.pixels().map(|pixel| pixel.0).collect();
    Some(Grid::from_values(width, height, values))
}

/// Asserts that a picture is the expected one, or makes it so.
pub(crate) fn compare(name: &str, made: &Picture) {
    let path = golden(name);
    let png = colour_png(made, &Caption::default());
    if std::env::var_os("BLESS").is_some() {
        std::fs::create_dir_all(path.parent().expect("tests/golden")).expect("the folder");
        std::fs::write(&path, png).expect("the golden picture can be written");
        return;
    }
    let failed = |why: &str| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
        std::fs::create_dir_all(&folder).expect("a folder for what was made");
        std::fs::write(folder.join(format!("{name}.made.png")), &png).expect("what was made");
        panic!("{name}: {why}; see {} (BLESS=1 accepts it)", folder.display());
    };
    let Some(expected) = read(&path) else { failed("no expected picture") };
    if (expected.width(), expected.height()) != (made.width(), made.height()) {
        failed("another size");
    }
    let off = |(a, b): (&[u8; 4], &[u8; 4])| (0..4).map(|c| a[c].abs_diff(b[c])).max();
    let differences: Vec<u8> =
        expected.values().iter().zip(made.values()).filter_map(off).collect();
    let wrong = differences.iter().filter(|d| **d > CHANNEL_TOLERANCE).count();
    if wrong as f64 > PIXEL_TOLERANCE * differences.len() as f64 {
        let shown = differences.iter().map(|d| [d.saturating_mul(8), 0, 0, 255]).collect();
        let shown = Grid::from_values(made.width(), made.height(), shown);
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("golden");
        std::fs::create_dir_all(&folder).expect("a folder for what was made");
        let bytes = colour_png(&shown, &Caption::default());
        std::fs::write(folder.join(format!("{name}.difference.png")), bytes).expect("differences");
        failed(&format!("{wrong} of {} pixels differ", differences.len()));
    }
}

pub(crate) fn document(preset: &str, settings: &[&str]) -> Document {
    let mut document = presets::find(preset).expect("a preset").document().expect("it parses");
    for setting in settings {
        document.set(setting, "golden").expect("a valid setting");
    }
    document
}

pub(crate) fn leaf(document: &Document, seed: u64, size: usize) -> Leaf {
    let mut document = document.clone();
    document.set(&format!("texture.size_px={size}"), "golden").expect("a size");
    let spec = document.resolve(Seed(seed)).expect("it resolves");
    pipeline::generate(&spec, Seed(seed), &mut Silent).expect("a leaf")
}

/// The fronts of one leaf, grown once, painted with each of these settings.
fn paintings(preset: &str, seed: u64, size: usize, all: &[Vec<String>]) -> Vec<Picture> {
    let size = format!("texture.size_px={size}");
    let resolved = |settings: &[String]| {
        let settings: Vec<&str> = settings.iter().chain([&size]).map(String::as_str).collect();
        document(preset, &settings).resolve(Seed(seed)).expect("it resolves")
    };
    let grown = pipeline::grow(&resolved(&[]), Seed(seed), &mut Silent).expect("a leaf");
    let front = |settings: &Vec<String>| {
        let textures = pipeline::paint(&resolved(settings), &grown, Seed(seed), &mut Silent);
        textures.expect("it can be painted").front.base_colour
    };
    all.iter().map(front).collect()
}

pub(crate) fn panel(picture: Picture, label: &str) -> Panel {
    Panel { picture, label: label.to_owned(), notes: Vec::new() }
}

/// Normals and heights as pictures in the blade's coverage.
fn shown<T: Copy>(map: &Grid<T>, cover: &Picture, rgb: impl Fn(T) -> [u8; 3]) -> Picture {
    let values = map.values().iter().zip(cover.values()).map(|(&v, c)| {
        let [r, g, b] = rgb(v);
        [r, g, b, c[3]]
    });
    Grid::from_values(map.width(), map.height(), values.collect())
}

fn normals(side: &venation::texture::SideMaps) -> Picture {
    shown(&side.normal, &side.base_colour, |n| n)
}

fn heights(side: &venation::texture::SideMaps) -> Picture {
    shown(&side.height, &side.base_colour, |h| [(h >> 8) as u8; 3])
}

pub(crate) fn sheet(title: &str, panels: &[Panel], columns: usize, panel_px: usize) -> Picture {
    montage::sheet(title, panels, Layout { columns, panel_px })
}

/// A leaf in the outline of a file among the fixtures.
fn in_outline(preset: &str, file: &str, settings: &[&str]) -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/outlines").join(file);
    let options =
        OutlineOptions { kind: OutlineKind::Auto, root: None, y_up: false, length_mm: 70.0 };
    let imported = outline::import(&path, &options).expect("the fixture imports");
    let mut document = document(preset, settings);
    use venation::document::Value;
    document.set("margin.length_mm=70", "golden").expect("a valid setting");
    document.insert("margin.kind", Value::Text("polygon".into()), "golden");
    document.insert("margin.polygon_mm", Value::Points(imported.polygon_mm), "golden");
    document.insert("margin.cuts_mm", Value::Lines(imported.cuts_mm), "golden");
    document
}

#[test]
fn golden_presets_front_and_back() {
    let mut panels = Vec::new();
    for preset in PRESETS {
        let leaf = leaf(&document(preset.name, &[]), 1, 512);
        let name = format!("{} ({})", preset.common, preset.name);
        panels.push(panel(leaf.textures.front.base_colour, &name));
        panels.push(panel(leaf.textures.back.base_colour, "back"));
    }
    compare("readme_presets", &sheet("presets", &panels, 6, 320));
}

#[test]
fn golden_colour_types() {
    let types = [("uniform", 1.0), ("from-veins", 1.0), ("from-edges", 8.0), ("speckled", 2.5)];
    let (mut names, mut settings) = (Vec::new(), Vec::new());
    for model in ["pigments", "hsv"] {
        for (word, spread) in types {
            names.push(format!("{model}, {word}"));
            settings.push(vec![
                format!("colour.model={model}"),
                format!("colour.type={word}"),
                format!("colour.spread_mm={spread}"),
                "colour.vein_spread=5".to_owned(),
                "colour.speckle_count=160".to_owned(),
            ]);
        }
    }
    let pictures = paintings("lilac", 3, 512, &settings);
    let panels: Vec<Panel> =
        pictures.into_iter().zip(&names).map(|(picture, name)| panel(picture, name)).collect();
    compare("readme_colour", &sheet("colour types", &panels, 4, 384));
}

#[test]
fn golden_season_of_a_maple() {
    let folder = crate::support::fresh();
    let arguments = ["compare", "maple", "--by", "season", "--size", "512", "-o", "s.png"];
    crate::support::succeed(folder.path(), &arguments);
    compare("readme_season", &read(&folder.path().join("s.png")).expect("the sheet"));
}

#[test]
fn golden_damage_of_an_oak() {
    let wounds = [
        "holes=0.15",
        "margin_bites=0.2",
        "skeletonise=0.35",
        "mines=0.5",
        "spots=0.5",
        "scorch=0.4",
        "tears=0.6",
    ];
    let settings = wounds.map(|wound| vec![format!("damage.{wound}")]);
    let pictures = paintings("oak", 2, 512, &settings);
    let panels: Vec<Panel> =
        pictures.into_iter().zip(wounds).map(|(picture, wound)| panel(picture, wound)).collect();
    compare("readme_damage", &sheet("damage", &panels, 4, 384));
}

#[test]
fn golden_relief_of_both_sides() {
    let leaf = leaf(&document("beech", &["output.maps=height,normal,preview"]), 2, 512);
    let (front, back) = (&leaf.textures.front, &leaf.textures.back);
    let lit = front.preview.map(|&[r, g, b]| [r, g, b, 255]);
    let side = lit.height();
    let view = |panel: usize| {
        let row = |y: usize| lit.row(y)[panel * side..(panel + 1) * side].to_vec();
        Grid::from_values(side, side, (0..side).flat_map(row).collect())
    };
    let panels = [
        panel(heights(front), "front, height"),
        panel(normals(front), "front, normal"),
        panel(heights(back), "back, height"),
        panel(normals(back), "back, normal"),
        panel(view(0), "front, lit"),
        panel(view(1), "back, lit"),
        panel(view(2), "against the light"),
    ];
    compare("readme_relief", &sheet("relief", &panels, 4, 384));
}

#[test]
fn golden_leaf_in_a_real_outline() {
    let leaf = leaf(&in_outline("lilac", "Passiflora_alata_1_8.png", &[]), 1, 768);
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/outlines");
    let scan = read(&fixtures.join("Passiflora_alata_1_8.png")).expect("the fixture");
    let (front, back) = (&leaf.textures.front, &leaf.textures.back);
    let panels = [
        panel(scan, "given: a scanned outline"),
        panel(front.base_colour.clone(), "front"),
        panel(back.base_colour.clone(), "back"),
        panel(normals(front), "front, normal"),
    ];
    compare("readme_scan", &sheet("", &panels, 4, 448));
}

#[test]
fn golden_leaves_in_outlines_from_files() {
    let files = [
        ("beech", "Passiflora_capsularis_1_7.png", "photograph"),
        ("beech", "Passiflora_setacea_1_10.png", "photograph"),
        ("lilac", "Passiflora_villosa_1_6.png", "photograph"),
        ("linden", "Passiflora_edulis_3_2.csv", "CSV"),
        ("willow", "openclipart_leaf_01.svg", "SVG"),
        ("beech", "sketch.png", "drawing"),
    ];
    let panels: Vec<Panel> = files
        .iter()
        .map(|(preset, file, label)| {
            let leaf = leaf(&in_outline(preset, file, &[]), 1, 512);
            panel(leaf.textures.front.base_colour, label)
        })
        .collect();
    compare("readme_outlines", &sheet("outlines from files", &panels, 6, 320));
}

/// A sheet of the program's own.
fn compare_sheet(name: &str, arguments: &[&str]) {
    let folder = crate::support::fresh();
    let output = ["--size", "512", "-o", "s.png"];
    crate::support::succeed(folder.path(), &[&["compare"], arguments, &output].concat());
    compare(name, &read(&folder.path().join("s.png")).expect("the sheet"));
}

#[test]
fn golden_growth_types() {
    compare_sheet("readme_growth", &["beech"]);
}

#[test]
fn golden_veins_from_growth_alone() {
    compare_sheet("readme_emergence", &["beech", "--by", "emergence"]);
}

#[test]
fn golden_guided_veins() {
    let leaf = leaf(&document("beech", &[]), 1, 1024);
    let (front, back) = (&leaf.textures.front, &leaf.textures.back);
    let panels = [
        panel(front.base_colour.clone(), "front"),
        panel(back.base_colour.clone(), "back"),
        panel(normals(back), "back, normal"),
    ];
    compare("readme_guides", &sheet("", &panels, 3, 480));
}

#[test]
fn golden_net_with_every_areole() {
    let settings = ["margin.length_mm=30", "veins.scale=0.43", "output.maps=veinmask"];
    let leaf = leaf(&document("beech", &settings), 3, 2048);
    let mask = &leaf.textures.front.vein_mask;
    let grey = |&v: &u8| [v, v, v, 255];
    let side = mask.width();
    let square = |x: usize, y: usize, edge: usize| {
        let row = |y: usize| mask.row(y)[x..x + edge].iter().map(grey);
        Grid::from_values(edge, edge, (y..y + edge).flat_map(row).collect())
    };
    // No petiole has veins: the picture ends with the blade.
    let veined = |&y: &usize| mask.row(y).iter().any(|&v| v > 0);
    let last = (0..side).rfind(veined).expect("there are veins");
    let edge = last + (0..side).find(veined).expect("there are veins");
    let blade = square((side - edge) / 2, 0, edge);
    let close = square(side / 2 - 320, side / 3 - 320, 640);
    let panels = [panel(blade, "veins of a small beech leaf"), panel(close, "closer")];
    compare("readme_net", &sheet("", &panels, 2, 640));
}

#[test]
fn golden_particles_by_scatter_pattern() {
    // Rodkaew 2002, figure 9.
    let folder = crate::support::fresh();
    let arguments = ["compare", "lilac", "--by", "scatter", "--size", "300", "-o", "s.png"];
    crate::support::succeed(folder.path(), &arguments);
    compare("readme_scatter", &read(&folder.path().join("s.png")).expect("the sheet"));
}

#[test]
fn golden_atlas() {
    let folder = crate::support::fresh();
    let flags = ["--seeds", "1-9", "--size", "768", "--maps", "basecolor", "-o", "a"];
    crate::support::succeed(folder.path(), &[&["atlas", "oak"][..], &flags].concat());
    let picture = |name: &str| read(&folder.path().join("a").join(name)).expect("the sheet");
    let name = "quercus-robur_atlas_BaseColor.png";
    let panels =
        [panel(picture(name), "front"), panel(picture(&format!("back/{name}")), "back, mirrored")];
    compare("readme_atlas", &sheet("", &panels, 2, 640));
}

#[test]
fn golden_shapes_by_name() {
    // Garg 2011, tables 4.2 and 4.3.
    let folder = crate::support::fresh();
    // In so small a picture a coarser net shows more.
    let smaller = ["--size", "160", "--set", "margin.length_mm=40", "--set", "veins.scale=2.2"];
    let arguments = ["compare", "beech", "--by", "shape", "-o", "s.png"];
    crate::support::succeed(folder.path(), &[&arguments[..], &smaller].concat());
    compare("readme_shapes", &read(&folder.path().join("s.png")).expect("the sheet"));
}

#[test]
fn golden_multilobed_figures() {
    // Garg 2011, figures 4.6 and 6.12.
    let panel = |preset: &presets::Preset| {
        let leaf = leaf(&document(preset.name, &[]), 1, 240);
        panel(leaf.textures.front.base_colour, &format!("{} {}", preset.common, preset.about))
    };
    let panels: Vec<Panel> = presets::FIGURES.iter().map(panel).collect();
    compare("readme_lobes", &sheet("figures 4.6 and 6.12 of Garg 2011", &panels, 6, 240));
}

#[test]
fn every_picture_of_the_readme_is_here() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).expect("the README");
    let pictures: Vec<&str> = readme
        .split("](")
        .skip(1)
        .filter_map(|rest| rest.split(')').next())
        .filter(|target| target.ends_with(".png"))
        .collect();
    assert!(pictures.len() >= 6, "{pictures:?}");
    for picture in pictures {
        assert!(root.join(picture).is_file(), "{picture} is missing");
    }
}
