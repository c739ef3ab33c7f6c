//! How many rows of `inspect` grown leaves lie in: those of real ones.

use rayon::prelude::*;
use venation::observer::Silent;
use venation::pipeline;
use venation::presets;
use venation::seed::Seed;
use venation::veins::metrics::measures::Unit;
use venation::veins::metrics::{Architecture, Measures, Network};

/// A preset's leaf of a seed, measured as what it looks like.
fn measured(name: &str, seed: u64) -> Measures {
    let document = presets::find(name).expect(name).document().expect("it parses");
    let spec = document.resolve(Seed(seed)).expect("it resolves");
    let grown = pipeline::grow(&spec, Seed(seed), &mut Silent).expect("it grows");
    let veins = &grown.venation;
    let outline = grown.margin.outline();
    let network = Network::of_graph(veins.graph(), veins.radii(), veins.orders(), outline);
    Measures::of(&network, Unit::Millimetre)
}

/// The names of the rows a leaf is outside of.
fn outside(measures: &Measures) -> Vec<String> {
    let rows = measures.rows.iter().filter(|row| !row.is_inside());
    rows.map(|row| format!("{} {}", row.number, row.measures[0].name)).collect()
}

#[test]
fn a_fan_is_filled_and_forks_as_a_real_one() {
    for seed in 1..4 {
        let measures = measured("ginkgo", seed);
        assert_eq!(measures.architecture, Architecture::Dichotomous, "{seed}");
        assert_eq!(outside(&measures), Vec::<String>::new(), "{seed}");
    }
}

#[test]
fn the_veins_of_a_grass_stand_evenly_from_side_to_side() {
    for seed in 1..4 {
        let measures = measured("grass", seed);
        assert_eq!(measures.architecture, Architecture::Parallel, "{seed}");
        assert!(measures.rows_inside() >= 7, "{seed} {:?}", outside(&measures));
        let spacing = measures.rows.iter().flat_map(|row| &row.measures);
        let spacing =
            spacing.filter(|m| m.key == "parallel_spacing_variation").find_map(|m| m.value);
        assert!(spacing.is_some_and(|variation| variation < 0.15), "{seed} {spacing:?}");
    }
}

/// Distances to the nearest vein come out a little too long, as they do in the real networks measured
/// by the same reader; those two rows are the two that may be missed.
#[test]
#[ignore = "takes minutes: run with --ignored"]
fn netted_presets_lie_in_eighteen_rows() {
    let names = [
        "beech",
        "birch",
        "magnolia",
        "redbud",
        "dogwood",
        "willow",
        "lilac",
        "pear",
        "aspen",
        "chestnut",
        "bodhi",
        "oak",
        "maple",
        "tulip-tree",
        "linden",
        "camphor",
        "ivy",
    ];
    let mut short = Vec::new();
    for name in names {
        let mut inside: Vec<usize> =
            (1..=10).into_par_iter().map(|seed| measured(name, seed).rows_inside()).collect();
        inside.sort_unstable();
        println!("{name} {inside:?}");
        if inside[4] + inside[5] < 36 {
            short.push((name, inside));
        }
    }
    assert!(short.is_empty(), "{short:?}");
}
