//! Every leaf that comes with venation.

use proptest::prelude::*;
use venation::document::{Comments, Document};
use venation::margin;
use venation::presets::PRESETS;
use venation::seed::Seed;

#[test]
fn every_preset_is_called_after_its_file_and_gives_a_margin() {
    for preset in PRESETS {
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
    let mut names: Vec<_> = PRESETS.iter().flat_map(|p| [p.name, p.common]).collect();
    names.sort_unstable();
    let count = names.len();
    names.dedup();
    assert_eq!(names.len(), count);
}

#[test]
fn what_show_prints_is_the_same_leaf() {
    for preset in PRESETS {
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
