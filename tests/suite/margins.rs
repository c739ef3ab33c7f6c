//! Teeth and instances: what every preset keeps, and their pictures.

use glam::DVec2;
use venation::document::Document;
use venation::margin::{self, LandmarkKind, Margin};
use venation::presets::PRESETS;
use venation::raster::draw::Canvas;
use venation::seed::Seed;
use venation::veins::VeinKind;

use crate::golden::{Picture, compare, document, panel, sheet};
use crate::support::{fail, fresh, succeed};

/// A margin as a filled shape, as large as fits.
pub(crate) fn shape(margin: &Margin, px: usize) -> Picture {
    let bounds = margin.bounds();
    let size = bounds.size();
    let scale = 0.94 * px as f64 / size.max_element();
    let centre = (bounds.min + bounds.max) * 0.5;
    let place = |p: &DVec2| {
        let off = (*p - centre) * scale;
        DVec2::new(0.5 * px as f64 + off.x, 0.5 * px as f64 - off.y)
    };
    let outline: Vec<DVec2> = margin.outline().iter().map(place).collect();
    let mut canvas = Canvas::new(px, px, [255, 255, 255, 255]);
    canvas.fill(&[&outline], [104, 142, 78, 255]);
    canvas.into_picture()
}

fn margin_of(document: &Document, seed: u64) -> Margin {
    let spec = document.resolve(Seed(seed)).expect("it resolves");
    margin::build(&spec.margin, Seed(seed)).expect("a margin")
}

#[test]
fn golden_teeth() {
    let forms: [(&str, &[&str]); 8] = [
        ("serrate", &["type=serrate", "count=16", "depth=0.4"]),
        ("dentate", &["type=dentate", "count=13", "depth=0.5"]),
        ("crenate", &["type=crenate", "count=13", "depth=0.35", "lean=0.1"]),
        ("second order", &["type=serrate", "count=8", "depth=0.35", "second.count=4"]),
        (
            "third order",
            &["type=serrate", "count=6", "depth=0.4", "second.count=3", "third.count=2"],
        ),
        (
            "bristles",
            &[
                "type=serrate",
                "count=12",
                "distal_bow=-0.7",
                "bristle_mm=2.5",
                "sinus_rounding=0.6",
            ],
        ),
        ("glands", &["type=serrate", "count=12", "gland_mm=1", "proximal_bow=0.5"]),
        (
            "uneven, hooked",
            &["type=serrate", "count=11", "lean=0.8", "irregularity=0.5", "depth=0.5"],
        ),
    ];
    let mut panels: Vec<_> = forms
        .iter()
        .map(|(label, settings)| {
            let settings: Vec<String> =
                settings.iter().map(|s| format!("margin.teeth.{s}")).collect();
            let settings: Vec<&str> = settings.iter().map(String::as_str).collect();
            panel(shape(&margin_of(&document("pear", &settings), 1), 420), label)
        })
        .collect();
    for (label, settings) in [
        ("waves", ["margin.waves.height=0.02", "margin.waves.count=7"]),
        ("roughness", ["margin.roughness.height_mm=0.8", "margin.roughness.grain_mm=3"]),
    ] {
        let document = document("magnolia", &settings);
        panels.push(panel(shape(&margin_of(&document, 1), 420), label));
    }
    for name in ["birch", "chestnut", "linden", "aspen", "willow", "beech"] {
        panels.push(panel(shape(&margin_of(&document(name, &[]), 1), 420), name));
    }
    compare("readme_teeth", &sheet("", &panels, 8, 280));
}

#[test]
fn golden_instances() {
    let mut panels = Vec::new();
    for name in ["birch", "linden"] {
        panels.push(panel(shape(&margin_of(&document(name, &[]), 1), 360), name));
        for seed in 1..=5 {
            let document = document(name, &["vary=20"]);
            panels.push(panel(shape(&margin_of(&document, seed), 360), &format!("seed {seed}")));
        }
    }
    compare("readme_instances", &sheet("perturbed by 20 %", &panels, 6, 280));
}

/// Every preset at 20 %, so many instances of each.
fn instances_are_margins(count: u64) {
    for preset in PRESETS {
        let mut document = preset.document().expect("it parses");
        document.set("vary=20%", "test").expect("a percentage");
        let mut areas = std::collections::BTreeSet::new();
        for seed in 0..count {
            let spec = document.resolve(Seed(seed)).expect("it resolves");
            let margin = margin::build(&spec.margin, Seed(seed))
                .unwrap_or_else(|error| panic!("{} seed {seed}: {error}", preset.name));
            assert_eq!(margin.check(), None, "{} seed {seed}", preset.name);
            areas.insert((margin.area_mm2() * 1e6) as u64);
        }
        assert_eq!(areas.len() as u64, count, "{}: no two instances are alike", preset.name);
    }
}

#[test]
fn instances_of_every_preset_at_20_percent_are_margins() {
    instances_are_margins(12);
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn a_thousand_instances_of_every_preset_at_20_percent_are_margins() {
    instances_are_margins(1000);
}

#[test]
fn vary_on_the_command_line_is_vary_in_the_file_and_in_set() {
    let folder = fresh();
    let show = |arguments: &[&str], name: &str| {
        let mut all = vec!["generate"];
        all.extend_from_slice(arguments);
        all.extend([
            "--maps", "none", "--format", "none", "--size", "16", "-o", name, "--seed", "5",
        ]);
        // Nothing is asked of the net between the veins that are laid.
        all.extend(["--set", "veins.spawn_rate=1"]);
        succeed(folder.path(), &all);
        std::fs::read_to_string(folder.path().join(name).join("leaf.toml")).expect("leaf.toml")
    };
    let flag = show(&["beech", "--vary", "20%"], "flag");
    assert_eq!(flag, show(&["beech", "--vary", "20"], "bare"));
    assert_eq!(flag, show(&["beech", "--set", "vary=20%"], "set"));
    let preset = venation::presets::find("beech").expect("beech").text;
    std::fs::write(folder.path().join("v.toml"), format!("vary = 20\n{preset}")).expect("written");
    assert_eq!(flag, show(&["v.toml"], "file"));
    assert_ne!(flag, show(&["beech"], "without"));
    // The drawn leaf is the leaf: nothing is perturbed a second time.
    assert_eq!(flag, show(&["flag/leaf.toml"], "again"));
    let message = fail(folder.path(), 2, &["generate", "beech", "--vary", "150%"]);
    assert!(message.contains("vary = 150 is outside 0 to 100 %"), "{message}");
}

#[test]
fn secondaries_end_in_the_teeth() {
    for name in ["birch", "chestnut"] {
        let mut document = document(name, &["veins.spawn_rate=1", "growth.start_step=1"]);
        document.set("growth.total_steps=2", "test").expect("a setting");
        for seed in [1, 2] {
            let spec = document.resolve(Seed(seed)).expect("it resolves");
            let grown =
                venation::pipeline::grow(&spec, Seed(seed), &mut venation::observer::Silent)
                    .expect("veins");
            let marks = grown.margin.landmarks().iter();
            let tips: Vec<DVec2> = marks
                .filter(|mark| mark.kind == LandmarkKind::Tooth { order: 1 })
                .map(|mark| grown.margin.outline()[mark.vertex])
                .collect();
            let graph = grown.venation.graph();
            let secondary = |node: u32| grown.venation.kind(node) == VeinKind::Secondary;
            let mut goes_on = vec![false; graph.len()];
            for (parent, child) in graph.edges() {
                goes_on[parent as usize] |= secondary(child);
            }
            let ends: Vec<DVec2> = (0..graph.len())
                .filter(|&i| secondary(i as u32) && !goes_on[i])
                .map(|i| graph.positions()[i])
                .collect();
            assert!(ends.len() >= 10, "{name} {seed}: {} secondaries", ends.len());
            // The tip of a bristle stands beyond the tooth that the vein ends in.
            let reach = 0.02 * spec.margin.length_mm + spec.margin.teeth.bristle_mm;
            let near = |end: &&DVec2| tips.iter().any(|tip| tip.distance(**end) < reach);
            let served = ends.iter().filter(near).count();
            assert!(served * 10 >= ends.len() * 9, "{name} {seed}: {served} of {}", ends.len());
        }
    }
}
