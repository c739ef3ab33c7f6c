//! Widths and relaxed junctions of whole leaves.

use super::metrics::{Network, junctions};
use super::*;
use crate::geometry::polygon::segments_touch;
use crate::geometry::segments::SegmentIndex;
use crate::observer::Silent;
use crate::{pipeline, presets};

/// A small beech leaf with these settings.
fn beech(settings: &[&str]) -> pipeline::Grown {
    let mut document = presets::find("beech").expect("a preset").document().expect("it parses");
    let small = ["margin.length_mm=30", "veins.guides.secondary_count=6"];
    for setting in small.iter().chain(settings) {
        document.set(setting, "a test").expect("a setting");
    }
    let spec = document.resolve(Seed(7)).expect("it resolves");
    pipeline::grow(&spec, Seed(7), &mut Silent).expect("a leaf")
}

/// Median imbalance at p = 1, and number of junctions.
fn imbalance(leaf: &pipeline::Grown) -> (f64, usize) {
    let veins = &leaf.venation;
    let network =
        Network::of_graph(veins.graph(), veins.radii(), veins.orders(), leaf.margin.outline());
    let mut all: Vec<f64> =
        junctions::junctions(&network).iter().map(|junction| junction.imbalance(1.0)).collect();
    all.sort_by(f64::total_cmp);
    (all[all.len() / 2], all.len())
}

/// How many pairs of edges without a common node touch.
fn crossings(graph: &VeinGraph) -> usize {
    let edges: Vec<(NodeId, NodeId)> = graph.edges().chain(graph.joins().iter().copied()).collect();
    let at = |node: NodeId| graph.positions()[node as usize];
    let index = SegmentIndex::new(edges.iter().map(|&(a, b)| (at(a), at(b))).collect());
    let crossed = |i: usize| {
        let (a, b) = edges[i];
        index.any_near(at(a), at(b), |j| {
            let (c, d) = edges[j];
            let apart = a != c && a != d && b != c && b != d;
            apart && segments_touch(at(a), at(b), at(c), at(d))
        })
    };
    (0..edges.len()).filter(|&i| crossed(i)).count()
}

#[test]
fn relaxed_junctions_balance_better_and_cross_nothing() {
    for algorithm in ["auxin-open", "auxin-closed"] {
        let algorithm = format!("veins.algorithm={algorithm}");
        let [before, after] = ["0", "5"].map(|sweeps| {
            let leaf = beech(&[&algorithm, &format!("veins.relaxation={sweeps}")]);
            assert_eq!(leaf.venation.check(&leaf.margin), None);
            leaf
        });
        let (was, is) = (imbalance(&before), imbalance(&after));
        // Stars are taken apart first: more junctions of three.
        assert!(is.0 < was.0 * 0.7 && is.1 >= was.1, "{algorithm}: {was:?}, then {is:?}");
        let [was, is] = [&before, &after].map(|leaf| crossings(leaf.venation.graph()));
        assert!(is <= was, "{algorithm}: {was} edges crossed others, {is} do");
        let again = beech(&[&algorithm, "veins.relaxation=5"]);
        assert_eq!(again.venation, after.venation);
    }
}

#[test]
fn widths_of_a_whole_leaf_hold_what_they_promise() {
    let forms: [&[&str]; 3] = [
        &["veins.exponent_change=-0.5", "veins.taper=1", "veins.least_radius_mm=0.04"],
        &["veins.algorithm=auxin-closed", "veins.widths=flow"],
        &["veins.algorithm=auxin-closed", "veins.widths=flow", "veins.relaxation=3"],
    ];
    for settings in forms {
        let leaf = beech(settings);
        assert_eq!(leaf.venation.check(&leaf.margin), None, "{settings:?}");
        let radii = leaf.venation.radii();
        let least = radii.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(least >= 0.03, "{settings:?}: {least}");
    }
}

#[test]
fn trails_of_particles_heed_the_limits_of_steps_and_veinlets() {
    let grow = |setting: &str| {
        let plain = ["veins.algorithm=particles", "veins.relaxation=0", "veins.smoothing=0"];
        let still = ["veins.sinuosity=0", "veins.longest_step=0", "veins.least_veinlet=0"];
        let settings: Vec<&str> = plain.into_iter().chain(still).chain([setting]).collect();
        beech(&settings).venation
    };
    let longest = |veins: &Venation| {
        let at = |node: NodeId| veins.graph().positions()[node as usize];
        veins.graph().edges().map(|(a, b)| at(a).distance(at(b))).fold(0.0, f64::max)
    };
    let free = grow("veins.longest_step=0");
    let cut = grow("veins.longest_step=1");
    let step = particles::ParticleSpec::default().step_mm;
    assert!(longest(&free) > 1.5 * step, "{}", longest(&free));
    assert!(longest(&cut) <= step * (1.0 + 1e-9), "{}", longest(&cut));
    let tips =
        |veins: &Venation| veins.graph().child_counts().iter().filter(|&&count| count == 0).count();
    assert_eq!(tips(&cut), tips(&free));
    // 6 times 0.21 mm.
    let pruned = grow("veins.least_veinlet=6");
    assert!(tips(&pruned) < tips(&free), "{} of {}", tips(&pruned), tips(&free));
    let finer = grow("veins.scale=0.5");
    assert!(tips(&finer) > 3 * tips(&free), "{} and {}", tips(&finer), tips(&free));
}
