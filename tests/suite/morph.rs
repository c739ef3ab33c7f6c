//! Morphing: the program's files, whole leaves on the way, and the thesis's figures.

use std::path::Path;

use glam::DVec2;
use venation::document::Document;
use venation::growth::GrowingBlade;
use venation::margin::morph::{MorphPath, Station};
use venation::margin::{Margin, MarginSpec};
use venation::seed::{Seed, Stage};
use venation::spec::LeafSpec;
use venation::veins::VeinKind;
use venation::veins::guides::{self, PrimaryType, SecondaryType, carry::CarriedGuides};

use crate::golden::{compare, document, panel, read, sheet};
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
    assert!(few.contains("'1' for '--frames <N>'") && few.contains("from 2 to 10000"), "{few}");
    assert!(std::fs::read_dir(folder.path()).expect("the folder").next().is_none());
}

/// Where secondaries leave primary veins, on the right and the left of those, as the way along the veins
/// from the base (a lobe that turns carries its veins along), and how far up primary veins get, in lengths of
/// the blade.
fn insertions(spec: &LeafSpec, margin: &Margin) -> ([Vec<f64>; 2], f64) {
    let blade = GrowingBlade::new(margin.clone(), &spec.growth).expect("it grows");
    let graph = guides::build(&spec.veins.scaled(), &blade, &mut Seed(1).stream(Stage::Guides));
    assert_eq!(graph.check(), None);
    let kind = |node| graph.rank(node).map(|rank| rank.kind);
    let mut way = vec![0.0; graph.len()];
    for (parent, child) in graph.edges() {
        let [from, to] = [parent, child].map(|node| graph.positions()[node as usize]);
        way[child as usize] = way[parent as usize] + from.distance(to) / margin.length_mm();
    }
    let mut sides = [Vec::new(), Vec::new()];
    for (parent, child) in graph.edges() {
        if kind(child) == Some(VeinKind::Secondary) && kind(parent) == Some(VeinKind::Primary) {
            let at = |node: u32| graph.positions()[node as usize];
            let ahead = graph.parent(parent).map_or(DVec2::Y, |back| at(parent) - at(back));
            let left = ahead.perp_dot(at(child) - at(parent)) > 0.0;
            sides[usize::from(left)].push(way[parent as usize]);
        }
    }
    sides.iter_mut().for_each(|side| side.sort_by(f64::total_cmp));
    let primaries = (0..graph.len() as u32).filter(|node| kind(*node) == Some(VeinKind::Primary));
    let heights = primaries.map(|node| graph.positions()[node as usize].y / margin.length_mm());
    (sides, heights.fold(0.0, f64::max))
}

/// What happens to secondaries between neighbouring frames of 60.
#[derive(Debug, Default)]
struct Changes {
    /// Frames after which their number on a side is another.
    number: Vec<usize>,
    /// How far one moves at most along the vein it leaves, in lengths of the blade.
    step: f64,
    /// The midrib ends no lower than this.
    midrib: f64,
}

fn changes(from: &str, to: &str, own: bool) -> Changes {
    let leaves = [from, to].map(|name| document(name, &[]).resolve(Seed(1)).expect("it resolves"));
    let stations = leaves.clone().map(|leaf| Station { margin: leaf.margin, weight: 1.0 });
    let path = MorphPath::new(&stations, Seed(1)).expect("a path");
    let mut ends = leaves.clone();
    if !own {
        let numbers = ends[1].veins.guides.clone();
        ends[0].veins.guides.numbered_as(&numbers);
    }
    let both = ends.each_ref().map(|leaf| (&leaf.veins, &leaf.growth));
    let guides = CarriedGuides::new(&path, both, Seed(1)).expect("guides");
    let mut changes = Changes { midrib: 1.0, ..Changes::default() };
    let mut last: Option<[Vec<f64>; 2]> = None;
    for frame in 0..60 {
        let u = f64::from(frame) / 59.0;
        let shares = path.shares(u);
        let mut spec = match frame {
            0 => ends[0].clone(),
            59 => ends[1].clone(),
            _ => LeafSpec::mixed(&leaves, &shares),
        };
        if (1..59).contains(&frame) || !(own || guides.fits_ends()) {
            guides.settle(&path, u, shares[1], &mut spec.veins).expect("guides");
        }
        let margin = path.at(u).expect("a margin");
        let (now, midrib) = insertions(&spec, &margin);
        if let Some(last) = last {
            for (a, b) in last.iter().zip(&now) {
                if a.len() != b.len() {
                    changes.number.push(frame as usize);
                    continue;
                }
                let most = a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
                changes.step = changes.step.max(most);
            }
        }
        changes.midrib = changes.midrib.min(midrib);
        last = Some(now);
    }
    changes
}

#[test]
fn secondaries_keep_number_and_side_and_move_little_between_frames_of_60() {
    let pairs = [
        ("beech", "birch"),
        ("beech", "willow"),
        ("oak", "dogwood"),
        ("linden", "maple"),
        ("oak", "maple"),
        // Lateral primaries that go from lobe to lobe, that a sinus reaches, that shrink.
        ("maple", "camphor"),
        ("ivy", "maple"),
        ("camphor", "ivy"),
    ];
    for (from, to) in pairs {
        let changes = changes(from, to, false);
        assert!(changes.number.is_empty(), "{from} to {to}: {changes:?}");
        assert!(changes.step < 0.02, "{from} to {to}: {changes:?}");
        assert!(changes.midrib > 0.9, "{from} to {to}: {changes:?}");
    }
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn secondaries_of_all_presets_keep_number_and_side() {
    // Fans and parallel veins bear no secondaries to keep.
    let bears = |name: &&str| {
        let guides = document(name, &[]).resolve(Seed(1)).expect("it resolves").veins.guides;
        guides.secondary != SecondaryType::None && guides.primary != PrimaryType::Flabellate
    };
    let names = venation::presets::PRESETS.iter().map(|preset| preset.name);
    let names: Vec<&str> = names.filter(bears).collect();
    let mut wrong = Vec::new();
    for distance in [1, 4, 7, 9] {
        for (i, from) in names.iter().enumerate() {
            let to = names[(i + distance) % names.len()];
            let changes = changes(from, to, false);
            println!("{from} to {to}: {changes:?}");
            if !changes.number.is_empty() || changes.step >= 0.02 {
                wrong.push(format!("{from} to {to}: {changes:?}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
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

fn row(leaves: &[(&MarginSpec, f64)], frames: usize) -> Vec<Margin> {
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

#[test]
fn golden_whole_leaves_of_a_morph() {
    let folder = fresh();
    let how = ["--veins", "--frames", "5", "--size", "300"];
    let mut panels = Vec::new();
    for (from, to) in [("ivy", "maple"), ("camphor", "ivy")] {
        let out = format!("{from}-{to}");
        succeed(folder.path(), &[&["morph", from, to, "-o", &out], &how[..]].concat());
        for frame in 1..=5 {
            let path = folder.path().join(format!("{out}/frame_{frame:04}/leaf.png"));
            let label = if frame == 1 { format!("{from} to {to}") } else { String::new() };
            panels.push(panel(read(&path).expect("a frame"), &label));
        }
    }
    compare("readme_morph_veins", &sheet("", &panels, 5, 300));
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

/// How far the margin moves at most between two of so many frames, in lengths of the blade.
fn farthest_step(from: &str, to: &str, frames: u32) -> f64 {
    let station = |name| {
        let margin = document(name, &[]).resolve(Seed(1)).expect("it resolves").margin;
        Station { margin, weight: 1.0 }
    };
    let path = MorphPath::new(&[station(from), station(to)], Seed(1)).expect("a path");
    let outline = |frame| {
        let margin = path.at(f64::from(frame) / f64::from(frames - 1)).expect("a margin");
        let unit = margin.outline().iter().map(|p| *p / margin.length_mm());
        unit.collect::<Vec<DVec2>>()
    };
    let outlines: Vec<_> = (0..frames).map(outline).collect();
    let apart = |a: &[DVec2], b: &[DVec2]| {
        venation::geometry::deviation::to_polygon(a, b).into_iter().fold(0.0, f64::max)
    };
    let steps = outlines.windows(2).map(|w| apart(&w[0], &w[1]).max(apart(&w[1], &w[0])));
    steps.fold(0.0, f64::max)
}

/// The waists of ivy's lobes lie below its valleys, those of a maple's above: number by number they would
/// begin to count all at once on the way.
#[test]
fn margins_do_not_leap_where_waists_begin_to_count() {
    for (from, to) in [("ivy", "maple"), ("maple", "ivy"), ("oak", "maple"), ("beech", "willow")] {
        let step = farthest_step(from, to, 60);
        assert!(step < 0.03, "{from} to {to}: {step}");
    }
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn margins_of_all_presets_do_not_leap() {
    let names: Vec<&str> = venation::presets::PRESETS.iter().map(|preset| preset.name).collect();
    let pairs = names.iter().flat_map(|from| names.iter().map(move |to| (from, to)));
    let mut far = Vec::new();
    for (from, to) in pairs.filter(|(from, to)| from != to) {
        let step = farthest_step(from, to, 60);
        if step >= 0.04 {
            far.push(format!("{from} to {to}: {step:.3}"));
        }
    }
    assert!(far.is_empty(), "{far:#?}");
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn every_preset_turns_into_every_other() {
    let count = venation::presets::PRESETS.len();
    presets_turn_into_each_other(&(1..count).collect::<Vec<_>>(), 23);
}
