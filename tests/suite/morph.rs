//! Morphing: the program's files, whole leaves on the way, and the thesis's figures.

use std::path::Path;

use venation::document::Document;
use venation::margin::MarginSpec;
use venation::margin::morph::{MorphPath, Station};
use venation::observer::Silent;
use venation::pipeline;
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::veins::VeinKind;

use crate::golden::{compare, document, panel, sheet};
use crate::margins::shape;
use crate::support::{fail, fresh, succeed};

const QUICK: [&str; 4] = ["--size", "32", "--frames", "3"];

fn morph<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [&["morph"], arguments, &QUICK].concat()
}

#[test]
fn a_folder_holds_every_frame_a_strip_and_an_animation() {
    let folder = fresh();
    let listed = succeed(folder.path(), &morph(&["beech", "birch", "--via", "lilac:2", "-o", "m"]));
    let read = |name: &str| std::fs::read(folder.path().join("m").join(name)).expect(name);
    for frame in ["frame_0001", "frame_0002", "frame_0003"] {
        for file in ["leaf.svg", "leaf.png", "leaf.toml"] {
            assert!(!read(&format!("{frame}/{file}")).is_empty());
            let name = Path::new("m").join(frame).join(file);
            assert!(listed.lines().any(|line| Path::new(line) == name), "{listed}");
        }
    }
    let bytes = read("animation.png");
    let reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
    assert_eq!(reader.info().animation_control().expect("an animation").num_frames, 3);
    assert_eq!((reader.info().width, reader.info().height), (32, 32));
    // A frame's settings make that leaf again, its own margin at the ends.
    let outline = |spec: &str| {
        let document = Document::parse(spec, "leaf.toml").expect("it parses");
        let spec = document.resolve(Seed(1)).expect("it resolves");
        venation::margin::build(&spec.margin, Seed(1)).expect("a margin")
    };
    let text = |name: &str| String::from_utf8(read(name)).expect("text");
    let beech = document("beech", &[]).resolve(Seed(1)).expect("it resolves");
    let first = venation::margin::build(&beech.margin, Seed(1)).expect("a margin");
    assert_eq!(outline(&text("frame_0001/leaf.toml")), first);
    assert!(text("frame_0002/leaf.toml").contains("kind = \"polygon\""));
    assert_eq!(outline(&text("frame_0002/leaf.toml")).check(), None);
    let again = fail(folder.path(), 3, &morph(&["beech", "birch", "-o", "m"]));
    assert!(again.contains("--force overwrites"), "{again}");
    succeed(folder.path(), &morph(&["beech", "birch", "-o", "m", "--force"]));
}

#[test]
fn mistakes_are_named() {
    let folder = fresh();
    let message = |arguments: &[&str]| fail(folder.path(), 2, &morph(arguments));
    for (via, said) in [
        ("lilac", "it takes a leaf and its weight"),
        ("lilac:much", "the weight `much`"),
        ("lilac:-1", "the weight `-1`"),
        ("lilac:inf", "the weight `inf`"),
        ("lilak:1", "did you mean `lilac`"),
    ] {
        let message = message(&["beech", "birch", "--via", via]);
        assert!(message.contains(said), "{message}");
    }
    assert!(message(&["beech", "nothing.toml"]).contains("nothing.toml"));
    let few = fail(folder.path(), 2, &["morph", "beech", "birch", "--frames", "1"]);
    assert!(few.contains("--frames: 1 is outside 2 to"), "{few}");
    assert!(std::fs::read_dir(folder.path()).expect("the folder").next().is_none());
}

/// Where secondaries leave the midrib, right and left, in lengths of the blade.
fn insertions(spec: &LeafSpec) -> [Vec<f64>; 2] {
    let grown = pipeline::grow(spec, Seed(1), &mut Silent).expect("veins");
    let (graph, kind) = (grown.venation.graph(), |n| grown.venation.kind(n));
    let mut sides = [Vec::new(), Vec::new()];
    for (parent, child) in graph.edges() {
        if kind(child) == VeinKind::Secondary && kind(parent) == VeinKind::Primary {
            let (from, to) =
                (graph.positions()[parent as usize], graph.positions()[child as usize]);
            sides[usize::from(to.x < from.x)].push(from.y / grown.margin.length_mm());
        }
    }
    sides.iter_mut().for_each(|side| side.sort_by(f64::total_cmp));
    sides
}

#[test]
fn secondaries_keep_number_and_side_and_move_little_between_frames_of_60() {
    let settings = ["veins.spawn_rate=1", "growth.total_steps=2", "growth.start_step=1"];
    for (from, to) in [("beech", "birch"), ("chestnut", "beech")] {
        let leaves =
            [from, to].map(|name| document(name, &settings).resolve(Seed(1)).expect("it resolves"));
        let stations = leaves.clone().map(|leaf| Station { margin: leaf.margin, weight: 1.0 });
        let path = MorphPath::new(&stations, Seed(1)).expect("a path");
        let mut last: Option<[Vec<f64>; 2]> = None;
        for frame in 0..60 {
            let u = f64::from(frame) / 59.0;
            let mut spec = LeafSpec::mixed(&leaves, &path.shares(u));
            spec.margin = path.spec_at(u).expect("a margin");
            spec.veins.guides.tooth_reach = 0.0;
            let now = insertions(&spec);
            if let Some(last) = last {
                for (side, (a, b)) in last.iter().zip(&now).enumerate() {
                    assert_eq!(a.len(), b.len(), "{from} to {to}, frame {frame}, side {side}");
                    let most = a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                    assert!(most < 0.02, "{from} to {to}, frame {frame}: {most}");
                }
            }
            last = Some(now);
        }
    }
}

/// A leaf from settings over the default margin.
fn leaf(settings: &[&str]) -> MarginSpec {
    let mut document = Document::new();
    for setting in settings {
        document.set(&format!("margin.{setting}"), "figure").expect("a valid setting");
    }
    document.resolve(Seed(1)).expect("it resolves").margin
}

/// Both sides alike.
fn unilobed(settings: &[&str]) -> MarginSpec {
    let sides = |s: &&str| [format!("right.{s}"), format!("left.{s}")];
    let settings: Vec<String> = settings.iter().flat_map(sides).collect();
    leaf(&settings.iter().map(String::as_str).collect::<Vec<_>>())
}

fn row(leaves: &[(&MarginSpec, f64)], frames: usize) -> Vec<venation::margin::Margin> {
    let stations: Vec<Station> =
        leaves.iter().map(|&(spec, weight)| Station { margin: spec.clone(), weight }).collect();
    let path = MorphPath::new(&stations, Seed(1)).expect("a path");
    let at = |i: usize| path.at(i as f64 / (frames - 1) as f64).expect("a margin");
    (0..frames).map(at).collect()
}

#[test]
fn golden_morphs_of_figures_7_5_to_7_11() {
    let tail = ["base_angle_deg=150", "tail_x=0.2", "tail_depth=0.18", "waist_x=0.34"];
    let hastate = unilobed(&tail);
    let obcordate = unilobed(&[
        "apex_angle_deg=140",
        "shoulder_x=0.2",
        "shoulder_height=0.12",
        "waist_x=0.4",
        "waist_y=0.6",
    ]);
    let both = unilobed(&[
        "base_angle_deg=140",
        "tail_x=0.2",
        "tail_depth=0.15",
        "apex_angle_deg=130",
        "shoulder_x=0.18",
        "shoulder_height=0.1",
        "waist_x=0.4",
    ]);
    let oval = unilobed(&["waist_x=0.25"]);
    let broad = unilobed(&["waist_x=0.55", "base_angle_deg=85", "waist_y=0.4"]);
    let three = leaf(&[
        "kind=lobed",
        "lobing.count=3",
        "lobing.right.first_angle_deg=62",
        "lobing.left.first_angle_deg=62",
        "lobing.right.first_length=0.75",
        "lobing.left.first_length=0.75",
        "lobing.lower.waist_x=0.2",
        "lobing.upper.waist_x=0.2",
    ]);
    let seven = leaf(&[
        "kind=lobed",
        "lobing.count=7",
        "lobing.right.first_angle_deg=118",
        "lobing.left.first_angle_deg=118",
        "lobing.right.last_angle_deg=40",
        "lobing.left.last_angle_deg=40",
        "lobing.lower.waist_x=0.16",
        "lobing.upper.waist_x=0.16",
    ]);
    let tails = |side: &str| {
        let wanted = [
            format!("{side}.base_angle_deg=150"),
            format!("{side}.tail_depth=0.2"),
            format!("{side}.tail_x=0.14"),
        ];
        leaf(&wanted.iter().map(String::as_str).collect::<Vec<_>>())
    };
    let (right, left) = (tails("right"), tails("left"));
    let mut young = unilobed(&["waist_x=0.09", "base_angle_deg=20", "apex_angle_deg=18"]);
    young.length_mm = 20.0;
    let mut slim = unilobed(&["waist_x=0.13", "base_angle_deg=35", "apex_angle_deg=25"]);
    slim.length_mm = 55.0;
    let mut half = unilobed(&["waist_x=0.2", "base_angle_deg=60", "waist_y=0.38"]);
    half.length_mm = 75.0;
    let mut grown = unilobed(&tail);
    grown.length_mm = 100.0;
    const N: usize = 9;
    // Figure 7.5: straight from key to key, against one path.
    let keys: Vec<_> = [
        row(&[(&oval, 1.0), (&broad, 1.0)], N.div_ceil(2)),
        row(&[(&broad, 1.0), (&hastate, 1.0)], N.div_ceil(2)),
    ]
    .into_iter()
    .enumerate()
    .flat_map(|(i, half)| half.into_iter().skip(i))
    .collect();
    let rows = [
        ("7.5, straight from key to key", keys),
        ("7.5, one path", row(&[(&oval, 1.0), (&broad, 2.0), (&hastate, 1.0)], N)),
        ("7.6, weight 0", row(&[(&hastate, 1.0), (&both, 0.0), (&obcordate, 1.0)], N)),
        ("7.6, weight 1", row(&[(&hastate, 1.0), (&both, 1.0), (&obcordate, 1.0)], N)),
        ("7.6, weight 8", row(&[(&hastate, 1.0), (&both, 8.0), (&obcordate, 1.0)], N)),
        (
            "7.6, two references",
            row(&[(&hastate, 1.0), (&both, 3.0), (&oval, 3.0), (&obcordate, 1.0)], N),
        ),
        ("7.7a", row(&[(&oval, 1.0), (&three, 1.0)], N)),
        ("7.7b", row(&[(&hastate, 1.0), (&seven, 1.0)], N)),
        ("7.8", row(&[(&three, 1.0), (&hastate, 3.0), (&seven, 1.0)], N)),
        ("7.9", row(&[(&three, 1.0), (&seven, 1.0)], N)),
        ("7.10", row(&[(&left, 1.0), (&right, 1.0)], N)),
        ("7.11, no constraint", row(&[(&young, 1.0), (&grown, 1.0)], N)),
        ("7.11, one", row(&[(&young, 1.0), (&slim, 4.0), (&grown, 1.0)], N)),
        ("7.11, two", row(&[(&young, 1.0), (&slim, 4.0), (&half, 4.0), (&grown, 1.0)], N)),
    ];
    let mut panels = Vec::new();
    for (label, margins) in rows {
        let tallest = margins.iter().map(|m| m.bounds().size().max_element()).fold(0.0, f64::max);
        for (i, margin) in margins.iter().enumerate() {
            let px = (200.0 * margin.bounds().size().max_element() / tallest).round() as usize;
            let mut canvas = venation::raster::draw::Canvas::new(200, 200, [255, 255, 255, 255]);
            canvas.paste(&shape(margin, px), ((200 - px) / 2, 200 - px), (px, px));
            panels.push(panel(canvas.into_picture(), if i == 0 { label } else { "" }));
        }
    }
    compare("readme_morph", &sheet("", &panels, N, 120));
}

/// Every preset's margin, with the seed it is drawn from.
fn preset_margins() -> Vec<(&'static str, MarginSpec)> {
    let margin = |name| document(name, &[]).resolve(Seed(1)).expect("it resolves").margin;
    venation::presets::PRESETS.iter().map(|preset| (preset.name, margin(preset.name))).collect()
}

/// Morphs every preset into those that stand so many places after it in the list.
fn presets_turn_into_each_other(distances: &[usize], frames: u32) {
    let all = preset_margins();
    for (i, (from, first)) in all.iter().enumerate() {
        for distance in distances {
            let (to, last) = &all[(i + distance) % all.len()];
            let station = |margin: &MarginSpec| Station { margin: margin.clone(), weight: 1.0 };
            let path = MorphPath::new(&[station(first), station(last)], Seed(1)).expect("a path");
            for frame in 0..=frames {
                let u = f64::from(frame) / f64::from(frames);
                let margin = path.at(u);
                let margin =
                    margin.unwrap_or_else(|error| panic!("{from} to {to} at {u}: {error}"));
                assert_eq!(margin.check(), None, "{from} to {to} at {u}");
            }
        }
    }
}

#[test]
fn presets_of_every_kind_turn_into_each_other() {
    presets_turn_into_each_other(&[1, 7], 3);
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn every_preset_turns_into_every_other() {
    let count = venation::presets::PRESETS.len();
    presets_turn_into_each_other(&(1..count).collect::<Vec<_>>(), 23);
}
