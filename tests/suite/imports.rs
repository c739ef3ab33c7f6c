//! Outlines from pictures and polygons: sound ones, broken ones, and leaves with known ends.
//!
//! `VENATION_LEAVES` may name a folder with `silhouettes/`, `outlines/`, `scans/`, `svg/`, `hostile/`
//! and an `index.csv` with tips and bases; without it the tests over that collection do nothing.

use std::path::{Path, PathBuf};

use venation::io::outline::{ImportedOutline, OutlineKind, OutlineOptions, import};
use venation::margin::{MarginKind, MarginSpec, build};
use venation::seed::Seed;

use crate::support::collection;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/outlines").join(name)
}

fn options() -> OutlineOptions {
    OutlineOptions::default()
}

fn with_root(x: f64, y: f64) -> OutlineOptions {
    OutlineOptions { root: Some([x, y]), ..options() }
}

/// Imports a fixture and checks what every import promises.
fn imported(name: &str, options: &OutlineOptions) -> ImportedOutline {
    let outline = import(&fixture(name), options).unwrap_or_else(|error| panic!("{error}"));
    check(&outline, options.length_mm);
    outline
}

fn refused(name: &str, options: &OutlineOptions) -> String {
    let error = import(&fixture(name), options).expect_err(name).to_string();
    assert!(error.contains(name) && !error.contains('\n') && error.len() < 400, "{error}");
    error
}

fn check(outline: &ImportedOutline, length_mm: f64) {
    assert_eq!(outline.polygon_mm[0], [0.0, 0.0]);
    assert!(outline.polygon_mm.contains(&[0.0, length_mm]));
    assert_ne!(outline.kind, OutlineKind::Auto);
    let spec = MarginSpec {
        kind: MarginKind::Polygon,
        length_mm,
        polygon_mm: outline.polygon_mm.clone(),
        cuts_mm: outline.cuts_mm.clone(),
        ..MarginSpec::default()
    };
    let margin = build(&spec, Seed(1)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(margin.check(), None);
}

/// Every file of `folder` listed in its `expect.json` is accepted or refused as it says.
fn as_expected(folder: &Path) {
    let list = std::fs::read_to_string(folder.join("expect.json")).expect("expect.json");
    let list: serde_json::Map<String, serde_json::Value> =
        serde_json::from_str(&list).expect("a map of names to words");
    for (name, expected) in list {
        let result = import(&folder.join(&name), &options());
        match (&result, expected.as_str().expect("a word")) {
            (Ok(outline), "accept" | "either") => check(outline, options().length_mm),
            (Err(error), "refuse" | "either") => {
                let error = error.to_string();
                assert!(error.contains(&name) && !error.contains('\n'), "{error}");
            }
            (result, expected) => panic!("{name}: {expected} expected, got {result:?}"),
        }
    }
}

#[test]
fn odd_files_are_accepted_or_refused_as_listed() {
    as_expected(&fixture(""));
}

#[test]
fn refusals_say_what_is_wrong() {
    for (name, words) in [
        ("empty.png", "empty"),
        ("text_named.png", "not a PNG or JPEG"),
        ("header_says_2e9.png", "2147483647 x 2147483647 px"),
        ("truncated.png", "not a sound PNG"),
        ("one_pixel.png", "1 x 1 px"),
        ("all_white.png", "one colour"),
        ("o_nan.csv", "line 7"),
        ("o_words.csv", "line 3"),
        ("o_two_points.csv", "2 distinct points"),
        ("o_collinear.csv", "no area"),
        ("s_broken.svg", "not a sound SVG"),
        ("sketch_open.png", "enclose no blade"),
    ] {
        let error = refused(name, &options());
        assert!(error.contains(words), "{error}");
    }
    let error = refused("no_such_file.png", &options());
    assert!(error.contains("cannot be read"), "{error}");
    let polygon = OutlineOptions { kind: OutlineKind::Polygon, ..options() };
    assert!(refused("holes.png", &polygon).contains("is a picture, not a polygon"));
    let length = OutlineOptions { length_mm: f64::NAN, ..options() };
    assert!(refused("o_closed.csv", &length).contains("not a positive number"));
}

#[test]
fn an_open_sketch_says_where_it_leaks() {
    let error = refused("sketch_open.png", &with_root(528.0, 800.0));
    assert!(error.contains("the root (528, 800)"), "{error}");
    assert!(error.contains("narrowest near (27"), "{error}");
    assert!(error.contains(", 61") || error.contains(", 62"), "{error}");
}

#[test]
fn a_sketch_is_told_from_a_photo_and_keeps_its_slits() {
    let sketch = imported("sketch.png", &options());
    assert_eq!(sketch.kind, OutlineKind::Sketch);
    assert_eq!(sketch.cuts_mm.len(), 3);
    assert_eq!(imported("holes.png", &options()).kind, OutlineKind::Photo);
    assert_eq!(imported("o_closed.csv", &options()).kind, OutlineKind::Polygon);
    // The same drawing as a photograph: the outer edge of the ink, a little larger.
    let photo = OutlineOptions { kind: OutlineKind::Photo, ..options() };
    assert!(imported("sketch.png", &photo).cuts_mm.is_empty());
}

#[test]
fn notes_tell_what_was_done() {
    for (name, words) in [
        ("two_leaves.png", "2 leaves: took the largest"),
        ("holes.png", "hole"),
        ("jpeg_exif_rot6_progressive.jpg", "EXIF orientation 6 applied"),
        ("huge_1bit.png", "9000 x 9000 px averaged down by 3"),
        ("Passiflora_villosa_1_6.png", "petiole cut off; attachment at pixel (49"),
        ("o_duplicates.csv", "repeated points dropped"),
    ] {
        let notes = imported(name, &options()).notes;
        assert!(notes.iter().any(|note| note.contains(words)), "{name}: {notes:?}");
    }
}

#[test]
fn a_root_is_in_the_pixels_of_the_file() {
    let near = imported("huge_1bit.png", &with_root(4570.0, 5430.0));
    let away = (near.base[0] - 4570.0).hypot(near.base[1] - 5430.0);
    assert!(away < 300.0, "{:?}", near.base);
    let error = refused("Passiflora_alata_1_8.png", &with_root(20.0, 30.0));
    assert!(error.contains("the root (20, 30) lies outside the leaf"), "{error}");
}

#[test]
fn bits_depths_and_formats_give_the_same_leaf() {
    let one = imported("grey8_white_leaf.png", &options());
    for name in ["alpha_only.png", "grey16.png", "la8.png", "palette.png", "palette_trns.png"] {
        let other = imported(name, &options());
        let apart = (one.apex[0] - other.apex[0]).hypot(one.apex[1] - other.apex[1]);
        assert!(apart < 1.5, "{name}: {:?}, not {:?}", other.apex, one.apex);
    }
}

#[test]
fn the_y_axis_of_a_csv_can_point_up() {
    let down = imported("o_closed.csv", &options());
    let up = imported("o_closed.csv", &OutlineOptions { y_up: true, ..with_root(485.7, 858.5) });
    // The same leaf seen from behind.
    let mirrored: Vec<f64> = up.polygon_mm.iter().map(|p| -p[0]).collect();
    let widest = |xs: &mut dyn Iterator<Item = f64>| xs.fold(0.0, f64::max);
    let right = widest(&mut down.polygon_mm.iter().map(|p| p[0]));
    assert!((widest(&mut mirrored.into_iter()) - right).abs() < 0.5);
}

#[test]
fn a_mask_and_its_outline_give_the_same_blade() {
    let area = |o: &ImportedOutline| {
        let n = o.polygon_mm.len();
        let cross = |i: usize| {
            let ([a, b], [c, d]) = (o.polygon_mm[i], o.polygon_mm[(i + 1) % n]);
            a * d - b * c
        };
        (0..n).map(cross).sum::<f64>() / 2.0
    };
    let polygon = imported("o_closed.csv", &options());
    let reversed = imported("o_reversed.csv", &options());
    assert!((area(&polygon) / area(&reversed) - 1.0).abs() < 1e-6);
}

proptest::proptest! {
    #![proptest_config(proptest::test_runner::Config::with_cases(64))]

    #[test]
    fn no_bytes_make_it_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..300)) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("any.csv");
        std::fs::write(&path, bytes).expect("written");
        let _ = import(&path, &options());
    }

    #[test]
    fn damaged_pictures_never_panic(
        which in 0usize..4,
        at in 0.0f64..1.0,
        byte in proptest::num::u8::ANY,
        end in 0.2f64..1.0,
    ) {
        let names = ["tiny_64.png", "touches_borders.png", "jpeg_q10.jpg", "s_arc_relative.svg"];
        let mut bytes = std::fs::read(fixture(names[which])).expect("a fixture");
        let at = (at * bytes.len() as f64) as usize;
        bytes[at] = byte;
        bytes.truncate((end * bytes.len() as f64) as usize);
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("damaged");
        std::fs::write(&path, bytes).expect("written");
        let _ = import(&path, &options());
    }
}

#[test]
fn the_collection_is_read_without_a_surprise() {
    let Some(folder) = collection() else { return };
    as_expected(&folder.join("hostile"));
    for part in ["silhouettes", "outlines", "svg", "scans"] {
        let mut count = 0;
        for entry in std::fs::read_dir(folder.join(part)).expect("a folder") {
            let path = entry.expect("an entry").path();
            let outline = import(&path, &options()).unwrap_or_else(|error| panic!("{error}"));
            check(&outline, options().length_mm);
            count += 1;
        }
        assert!(count > 0, "{part} is empty");
    }
}

/// The distance between two points, as a share of `length`.
fn off(a: [f64; 2], b: [f64; 2], length: f64) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1]) / length
}

#[test]
fn tips_and_bases_are_found_where_people_see_them() {
    let Some(folder) = collection() else { return };
    let index = std::fs::read_to_string(folder.join("index.csv")).expect("index.csv");
    let (mut tips, mut bases) = (Vec::new(), Vec::new());
    for line in index.lines().filter(|line| line.starts_with("silhouettes/")) {
        let columns: Vec<&str> = line.split(',').collect();
        let place = |column: usize| {
            let (x, y) = columns[column].split_once(' ')?;
            Some([x.parse().ok()?, y.parse().ok()?])
        };
        let (Some(tip), Some(base)) = (place(10), place(11)) else { continue };
        let found = import(&folder.join(columns[0]), &options()).expect(columns[0]);
        let length = off(tip, base, 1.0);
        tips.push(off(found.apex, tip, length));
        bases.push(off(found.base, base, length));
    }
    for (name, errors) in [("tip", &mut tips), ("base", &mut bases)] {
        errors.sort_by(f64::total_cmp);
        let at = |share: f64| 100.0 * errors[((errors.len() - 1) as f64 * share) as usize];
        let (median, most, worst) = (at(0.5), at(0.9), at(1.0));
        eprintln!("{name}: median {median:.2} %, 90 % below {most:.2} %, worst {worst:.2} %");
        // The listed base is a line through the centroid, not the petiole: up to 9 % apart.
        assert!(errors.len() > 40 && median < 2.0 && most < 7.0 && worst < 10.0);
    }
}

#[test]
fn a_diamond_typed_by_hand_is_an_outline() {
    let folder = crate::support::fresh();
    let path = folder.path().join("diamond.csv");
    std::fs::write(&path, "50,100\n80,50\n50,0\n20,50\n").expect("the file");
    let imported = import(&path, &OutlineOptions::default()).expect("a blade");
    assert!(imported.polygon_mm.len() >= 8);
    let highest = imported.polygon_mm.iter().map(|p| p[1]).fold(0.0, f64::max);
    assert!((highest - 80.0).abs() < 1e-6, "{highest}");
}

#[test]
fn a_picture_too_thin_to_be_averaged_down_is_told_its_own_size() {
    let folder = crate::support::fresh();
    let path = folder.path().join("strip.png");
    image::GrayImage::new(60_000, 10).save(&path).expect("the file");
    let error = import(&path, &options()).expect_err("too thin").to_string();
    assert!(error.contains("the picture is 60000 x 10 px; averaged down by 15"), "{error}");
}

#[test]
fn teeth_too_wide_for_a_blade_that_winds_are_told_with_what_would_do() {
    let folder = crate::support::fresh();
    // A band three wide that winds three times, a tenth of its width between the turns.
    let place = |i: i32, out: f64| {
        let angle = f64::from(i) / 200.0 * std::f64::consts::TAU;
        let from_middle = 4.0 + 3.3 * f64::from(i) / 200.0 + out;
        format!("{},{}\n", from_middle * angle.cos(), from_middle * angle.sin())
    };
    let inner = (0..=600).map(|i| place(i, 0.0));
    let outline: String = inner.chain((0..=600).rev().map(|i| place(i, 3.0))).collect();
    std::fs::write(folder.path().join("winds.csv"), outline).expect("the file");
    let leaf = ["generate", "beech", "--outline", "winds.csv", "--maps", "none", "-o", "out"];
    let leaf = crate::support::small(&leaf);
    let message = crate::support::fail(folder.path(), 2, &leaf);
    assert!(
        message.contains("teeth as wide as these cannot follow a margin that winds"),
        "{message}"
    );
    for advice in ["margin.teeth.count=100", "margin.teeth.type=none"] {
        let advised = [&leaf[..], &["--set", advice, "--force"]].concat();
        crate::support::succeed(folder.path(), &advised);
    }
}
