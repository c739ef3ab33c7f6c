//! Real leaves to parameters and silhouettes: the program's files, the README's picture, real collections.

use std::path::{Path, PathBuf};

use serde_json::Value;
use venation::document::Document;
use venation::io::fit as drawing;
use venation::io::outline::{OutlineOptions, blades, import};
use venation::margin::{MarginKind, build, fit};
use venation::raster::montage::Panel;
use venation::seed::Seed;

use crate::golden::{compare, sheet};
use crate::support::{collection, fail, fresh, run, succeed};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/outlines").join(name)
}

/// What is fitted in the picture.
const LEAVES: [&str; 4] = [
    "Passiflora_capsularis_1_7.png",
    "Passiflora_villosa_1_6.png",
    "Passiflora_edulis_3_2.csv",
    "Passiflora_setacea_1_10.png",
];

#[test]
fn golden_fitted_margins_over_real_ones() {
    let panels: Vec<Panel> = LEAVES
        .iter()
        .map(|file| {
            let real = import(&fixture(file), &OutlineOptions::default()).expect(file);
            let real = real.margin().expect(file);
            let fit = fit::fit(&real).expect(file);
            assert!(fit.numbers <= 12 * fit.lobes, "{file}: {} numbers", fit.numbers);
            assert!(fit.worst() < 0.03, "{file}: {}", fit.worst());
            Panel {
                picture: drawing::picture(&real, &fit, 420),
                label: format!("{}: {:.1} % at most", fit.description(), 100.0 * fit.worst()),
                notes: Vec::new(),
            }
        })
        .collect();
    compare("readme_fits", &sheet("", &panels, 4, 320));
}

#[test]
fn a_fitted_leaf_is_a_file_and_a_picture_and_varies_with_the_seed() {
    let folder = fresh();
    let scan = fixture("Passiflora_alata_1_8.png");
    let scan = scan.to_str().expect("a path");
    let text = succeed(
        folder.path(),
        &["fit", scan, "-o", "leaf.toml", "--overlay", "both.svg", "--json"],
    );
    let told: Value = serde_json::from_str(&text).expect("JSON");
    for way in ["fitted_to_real", "real_to_fitted"] {
        let at = |key: &str| told[way][key].as_f64().expect("a number");
        assert!(at("median") <= at("upper_quartile") && at("upper_quartile") <= at("max"));
        assert!(at("max") <= told["max"].as_f64().expect("a number") && at("max") < 0.03);
    }
    let drawn = std::fs::read_to_string(folder.path().join("both.svg")).expect("the drawing");
    assert!(
        drawn.contains("id=\"real\"") && drawn.contains("id=\"fitted\"") && drawn.contains(" Q ")
    );
    let toml = std::fs::read_to_string(folder.path().join("leaf.toml")).expect("the leaf");
    let document = Document::parse(&toml, "leaf.toml").expect("it parses");
    let margin = |seed: u64| document.resolve(Seed(seed)).expect("a leaf").margin;
    // Its own seed is the fitted leaf, others are like it.
    let own = margin(document.seed.expect("a seed"));
    assert_ne!(own.kind, MarginKind::Polygon);
    let fitted: venation::margin::MarginSpec =
        serde_json::from_value(told["margin"].clone()).expect("settings");
    let area = |spec| build(&spec, Seed(1)).expect("a margin").area_mm2();
    let plain = area(fitted);
    assert!((area(own.clone()) / plain - 1.0).abs() < 1e-6);
    for seed in 2..12 {
        let other = margin(seed);
        assert_ne!(own, other);
        assert!((area(other) / plain - 1.0).abs() < 0.5, "seed {seed}");
    }
    let vary = fail(folder.path(), 2, &["fit", scan, "--vary", "200"]);
    assert!(vary.contains("--vary: 200 is not between 0 and 100"), "{vary}");
    let missing = fail(folder.path(), 2, &["fit", "nothing.png", "-o", "x.toml"]);
    assert!(missing.contains("nothing.png") && !folder.path().join("x.toml").exists(), "{missing}");
}

/// Insects have opened its outline, so that what is left is hardly a leaf's.
#[test]
fn a_scan_is_not_overwritten_by_what_is_made_of_it() {
    let folder = fresh();
    let scan = folder.path().join("scan.png");
    std::fs::copy(fixture("Passiflora_alata_1_8.png"), &scan).expect("a scan");
    let before = std::fs::read(&scan).expect("a scan");
    let message = fail(folder.path(), 2, &["fit", "scan.png", "-o", "scan.toml", "--force"]);
    assert!(message.contains("scan.png: is read"), "{message}");
    assert_eq!(std::fs::read(&scan).expect("a scan"), before);
    assert!(!folder.path().join("scan.toml").exists());
    let outline = ["compare", "beech", "--outline", "scan.png", "-o", "scan.png", "--force"];
    let message = fail(folder.path(), 2, &outline);
    assert!(message.contains("scan.png: is read"), "{message}");
    assert_eq!(std::fs::read(&scan).expect("a scan"), before);
}

#[test]
fn a_poor_fit_says_so() {
    let folder = fresh();
    let torn = fixture("holes.png");
    let (code, _, said) =
        run(folder.path(), &["fit", torn.to_str().expect("a path"), "-o", "leaf.toml"]);
    assert_eq!(code, 0);
    assert!(said.contains("the fit strays 0.") && said.contains("--outline"), "{said}");
    let whole = fixture(LEAVES[0]);
    let (_, _, said) = run(folder.path(), &["fit", whole.to_str().expect("a path")]);
    assert!(!said.contains("strays"), "{said}");
}

#[test]
fn blades_of_a_picture_come_with_area_length_and_a_compact_silhouette() {
    let folder = fresh();
    let scan = fixture("Passiflora_setacea_1_10.png");
    let scan = scan.to_str().expect("a path");
    let listed = succeed(
        folder.path(),
        &["inspect", scan, "--px-per-mm", "4.82", "--json", "--silhouettes", "s.svg"],
    );
    let told: Value = serde_json::from_str(&listed).expect("JSON");
    let blade = &told["blades"][0];
    let number = |key: &str| blade[key].as_f64().expect("a number");
    assert!(number("curve_error") <= 1.0 / 4.82 && number("control_points") > 6.0);
    assert!(number("control_points") * 5.0 < number("boundary_points"), "{blade}");
    // The curves are the blade: read back as an outline they enclose as much.
    let options = OutlineOptions::default();
    let [own, drawn] = [scan.into(), folder.path().join("s.svg")].map(|path: PathBuf| {
        import(&path, &options).expect("an outline").margin().expect("a margin")
    });
    assert!((own.area_mm2() / drawn.area_mm2() - 1.0).abs() < 0.02);
    let again = fail(folder.path(), 3, &["inspect", scan, "--silhouettes", "s.svg"]);
    assert!(again.contains("--force overwrites"), "{again}");
    let wrong = fail(folder.path(), 2, &["inspect", scan, "--silhouettes", "s.pdf"]);
    assert!(wrong.contains("--silhouettes"), "{wrong}");
}

#[test]
fn areas_of_scans_are_those_that_were_measured() {
    let Some(folder) = collection() else { return };
    // Measured by ImageJ (cm²), at 826 px to 21 cm.
    let scans: [(&str, &[f64]); 3] = [
        ("leafarea_A1-01.jpg", &[116.799, 124.069]),
        ("leafarea_A123-01.jpg", &[184.773]),
        ("leafarea_A300-2.jpg", &[124.784, 102.070]),
    ];
    for (file, stated) in scans {
        let found = blades(&folder.join("scans").join(file)).expect(file);
        let to_cm2 = |area: f64| area / (826.0_f64 / 21.0).powi(2);
        let mut areas: Vec<f64> = found.blades.iter().map(|blade| to_cm2(blade.area)).collect();
        let mut stated = stated.to_vec();
        areas.sort_by(f64::total_cmp);
        stated.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), stated.len(), "{file}: {areas:?}");
        for (area, stated) in areas.iter().zip(&stated) {
            eprintln!("{file}: {area:.2} of {stated} cm²: {:+.2} %", 100.0 * (area / stated - 1.0));
            assert!((area / stated - 1.0).abs() < 0.015, "{file}: {area} of {stated} cm²");
        }
    }
}
