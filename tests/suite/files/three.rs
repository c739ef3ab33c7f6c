//! The cards in three.js, in a headless Chromium, where both are installed:
//! `VENATION_THREE=/path/to/node_modules VENATION_CHROMIUM=/usr/bin/chromium cargo test --test suite --
//! --ignored three` (npm's three and puppeteer-core).

use std::process::Command;

use serde_json::{Value, json};

use crate::support::{fresh, succeed};

/// The names of the folder and the program, or a word on what is missing.
fn installed() -> Option<[String; 2]> {
    let modules = std::env::var("VENATION_THREE").ok();
    let chromium = std::env::var("VENATION_CHROMIUM").unwrap_or_else(|_| "chromium".into());
    let runs = Command::new(&chromium).arg("--version").output().is_ok();
    if let Some(modules) = modules.filter(|_| runs) {
        return Some([modules, chromium]);
    }
    eprintln!(
        "skipped: set VENATION_THREE to a node_modules with three and puppeteer-core, and \
         VENATION_CHROMIUM to Chromium where it is not on the path"
    );
    None
}

#[test]
#[ignore = "needs three.js and Chromium: see the head of this file"]
fn three_js_shows_both_sides_cut_out() {
    let Some([modules, chromium]) = installed() else { return };
    let folder = fresh();
    let arguments = ["generate", "linden", "--size", "256", "--format", "obj,glb", "-o", "leaf"];
    succeed(folder.path(), &arguments);
    let leaf = folder.path().join("leaf");
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/suite/files/three.mjs");
    let mut command = Command::new("node");
    command.args([script, &modules, &chromium]).arg(&leaf).arg("tilia-cordata").arg(folder.path());
    let output = command.output().expect("node starts");
    let said = String::from_utf8_lossy(&output.stderr);
    let report: Value = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{said}"));
    assert_eq!(report["messages"], json!([]), "three.js has nothing to say");
    for side in 0..2 {
        let material = &report["glb"]["materials"][side];
        assert_eq!(material["metalness"], json!(0), "{material}");
        assert_eq!(
            (&material["alphaTest"], &material["transparent"]),
            (&json!(0.5), &json!(false))
        );
        assert_eq!((&material["doubleSided"], &material["normal"]), (&json!(true), &json!(256)));
        let material = &report["obj"]["materials"][side];
        assert_eq!((&material["alphaMap"], &material["normal"]), (&json!(256), &json!(256)));
        assert_eq!(material["bump"], json!(false), "{material}");
    }
    let shown = |name: &str| {
        let picture = image::open(folder.path().join(format!("{name}.png"))).unwrap();
        picture.resize_exact(256, 256, image::imageops::FilterType::Triangle).into_rgba8()
    };
    let opacity = image::open(leaf.join("tilia-cordata_Opacity.png")).unwrap().into_luma8();
    for kind in ["glb", "obj"] {
        for side in ["front", "back"] {
            let picture = shown(&format!("{kind}-{side}"));
            let (mut apart, mut leaf, mut green) = (0, 0, 0);
            for (x, y, pixel) in picture.enumerate_pixels() {
                let x = if side == "front" { x } else { 255 - x };
                let expected = opacity.get_pixel(x, y).0[0] > 127;
                apart += u32::from((pixel.0[3] > 127) != expected);
                leaf += u32::from(expected);
                green += u32::from(pixel.0[3] > 127 && pixel.0[1] > pixel.0[2]);
            }
            assert!(apart < leaf / 25, "{kind} {side}: {apart} of {leaf} texels differ");
            assert!(green > leaf * 9 / 10, "{kind} {side}: {green} of {leaf} are green");
        }
    }
}
