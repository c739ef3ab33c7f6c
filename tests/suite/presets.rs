//! Every leaf that comes with venation.

use proptest::prelude::*;
use venation::document::{Comments, Document};
use venation::geometry::{DVec2, polygon};
use venation::margin::lobes::LobeSide;
use venation::margin::{self, Landmark, LandmarkKind, MarginKind};
use venation::presets::{self, FIGURES, PRESETS};
use venation::seed::Seed;

use crate::support::{fresh, succeed};

#[test]
fn every_preset_is_called_after_its_file_and_gives_a_margin() {
    for preset in presets::all() {
        let document = preset.document().unwrap_or_else(|e| panic!("{e}"));
        let spec = document.resolve(Seed(1)).expect("presets resolve");
        assert_eq!(spec.name, preset.name);
        assert!(!spec.title.is_empty(), "{} has no title", preset.name);
        let margin =
            margin::build(&spec.margin, Seed(1)).unwrap_or_else(|e| panic!("{}: {e}", preset.name));
        assert_eq!(margin.check(), None);
    }
}

#[test]
fn names_do_not_clash() {
    let mut names: Vec<_> = presets::all().flat_map(|p| [p.name, p.common]).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn what_show_prints_is_the_same_leaf() {
    for preset in presets::all() {
        let document = preset.document().expect("presets parse");
        let shown = Document::parse(&document.to_toml(Comments::Full), "shown").expect("TOML");
        for seed in 0..5 {
            assert_eq!(
                shown.resolve(Seed(seed)).expect("resolves"),
                document.resolve(Seed(seed)).expect("resolves"),
            );
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn any_seed_of_any_preset_gives_a_valid_margin(seed: u64, index in 0..PRESETS.len()) {
        let preset = &PRESETS[index];
        let spec = preset.document().unwrap().resolve(Seed(seed)).unwrap();
        let margin = margin::build(&spec.margin, Seed(seed)).map_err(|e| {
            TestCaseError::fail(format!("{} seed {seed}: {e}", preset.name))
        })?;
        prop_assert_eq!(margin.check(), None);
        prop_assert!((margin.length_mm() - spec.margin.length_mm).abs() < 1e-9);
    }
}

#[test]
fn figures_have_the_lobes_of_their_captions_and_species_the_lobes_of_their_kind() {
    let lobes = [
        ("4.6a", 3),
        ("4.6b", 5),
        ("4.6c", 7),
        ("4.6d", 10),
        ("4.6e", 2),
        ("6.12a", 2),
        ("6.12b", 10),
        ("6.12c", 3),
        ("6.12d", 3),
        ("6.12e", 5),
        ("6.12f", 5),
        ("6.12g", 7),
        ("maple", 5),
        ("oak", 13),
        ("ivy", 5),
        ("tulip-tree", 4),
    ];
    for (name, count) in lobes {
        let document = presets::find(name).expect(name).document().expect("it parses");
        for seed in 0..4 {
            let spec = document.resolve(Seed(seed)).expect("it resolves");
            assert_eq!(spec.margin.kind, MarginKind::Lobed, "{name}");
            let margin = margin::build(&spec.margin, Seed(seed)).expect("a margin");
            let is_tip = |mark: &&Landmark| matches!(mark.kind, LandmarkKind::LobeTip { .. });
            assert_eq!(margin.landmarks().iter().filter(is_tip).count(), count, "{name}");
        }
    }
    assert_eq!(FIGURES.len(), 12, "five of 4.6, seven of 6.12");
}

#[test]
fn lobes_on_each_side_are_alike_without_asymmetry_and_drawn_for_themselves_with_it() {
    let mut document = presets::find("maple").expect("maple").document().expect("it parses");
    let lengths = |document: &Document, seed: u64| -> [f64; 2] {
        let lobes = document.resolve(Seed(seed)).expect("it resolves").margin.lobe;
        assert_eq!(lobes.len(), 5);
        assert_eq!((lobes[0].side, lobes[1].side), (LobeSide::Right, LobeSide::Left));
        [lobes[0].length, lobes[1].length]
    };
    document.set("margin.asymmetry=0", "test").expect("a number");
    let [right, left] = lengths(&document, 3);
    assert_eq!(right, left);
    document.set("margin.asymmetry=1", "test").expect("a number");
    let apart: Vec<[f64; 2]> = (0..40).map(|seed| lengths(&document, seed)).collect();
    assert_eq!(apart[3][0], right, "the right side is the one it was");
    assert!(apart.iter().all(|[right, left]| right != left));
    let mean = |side: usize| apart.iter().map(|pair| pair[side]).sum::<f64>() / 40.0;
    let product = apart.iter().map(|[r, l]| (r - mean(0)) * (l - mean(1))).sum::<f64>();
    let squares = |side: usize| apart.iter().map(|p| (p[side] - mean(side)).powi(2)).sum::<f64>();
    let correlation = product / (squares(0) * squares(1)).sqrt();
    assert!(correlation.abs() < 0.4, "of two independent draws: {correlation}");
}

/// Where an outline (anticlockwise) is hollow: stretches that turn clockwise, by more than a wave of the
/// margin does.
fn hollows(outline: &[DVec2]) -> usize {
    const WAVE_DEG: f64 = 12.0;
    let points = polygon::resampled(outline, 0.4);
    let n = points.len();
    let turn = |i: usize| {
        let [a, b, c] = [i + n - 1, i, i + 1].map(|k| points[k % n]);
        (b - a).angle_to(c - b).to_degrees()
    };
    let bulge = (0..n).find(|&i| turn(i) > 0.0).expect("it goes round");
    let (mut count, mut turned) = (0, 0.0);
    for turn in (bulge..=bulge + n).map(|i| turn(i % n)) {
        if turn < -0.3 {
            turned -= turn;
        } else {
            count += usize::from(turned > WAVE_DEG);
            turned = 0.0;
        }
    }
    count
}

#[test]
fn an_oak_is_hollow_between_its_lobes_and_at_the_base_and_nowhere_else() {
    let document = presets::find("oak").expect("oak").document().expect("it parses");
    for seed in 0..60 {
        let spec = document.resolve(Seed(seed)).expect("it resolves");
        let margin = margin::build(&spec.margin, Seed(seed)).expect("a margin");
        assert_eq!(hollows(margin.outline()), 13, "seed {seed}");
    }
}

#[test]
fn laid_veins_take_no_room_from_those_that_grow() {
    let folder = fresh();
    for scale in ["veins.scale=3", "veins.scale=10"] {
        let fan = ["generate", "ginkgo", "--set", scale, "--maps", "none", "--format", "csv"];
        succeed(folder.path(), &[&fan[..], &["-o", scale]].concat());
    }
}
