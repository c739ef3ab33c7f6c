use glam::DVec2;

use super::*;
use crate::observer::Silent;

fn adapted(graph: &VeinGraph, fluctuation: f64) -> Vec<f64> {
    radii(graph, &vec![1.0; graph.len()], 1e-3, fluctuation, &mut Silent).expect("radii")
}

/// A trunk to a fork, whose limbs have 1 and 5 sinks, nodes along the veins.
fn tree() -> (VeinGraph, [NodeId; 4]) {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::ZERO);
    let along = graph.sprout(root, DVec2::new(0.1, 1.0));
    let fork = graph.sprout(along, DVec2::new(0.0, 2.0));
    let single = graph.sprout(fork, DVec2::new(-4.0, 3.0));
    let limb = graph.sprout(fork, DVec2::new(1.0, 3.0));
    for i in 0..4 {
        graph.sprout(limb, DVec2::new(1.0 + f64::from(i), 4.0));
    }
    (graph, [root, along, single, limb])
}

#[test]
fn on_a_tree_a_steady_flow_gives_murrays_law() {
    let (graph, [root, along, single, limb]) = tree();
    let radii = adapted(&graph, 0.0);
    // Sinks: the fork, the single end, the limb's junction and its four ends.
    for (node, sinks) in [(root, 7.0), (along, 7.0), (single, 1.0), (limb, 5.0)] {
        let expected = libm::cbrt(sinks / 7.0);
        assert!((radii[node as usize] / expected - 1.0).abs() < 1e-3, "{sinks}: {radii:?}");
    }
}

#[test]
fn on_a_tree_a_single_moving_sink_gives_the_root_of_that() {
    let (graph, [root, _, single, limb]) = tree();
    let radii = adapted(&graph, 1.0);
    // ⟨F²⟩ is the number of sinks, not its square.
    for (node, sinks) in [(root, 7.0f64), (single, 1.0), (limb, 5.0)] {
        let expected = libm::pow(sinks / 7.0, 1.0 / 6.0);
        assert!((radii[node as usize] / expected - 1.0).abs() < 1e-3, "{sinks}: {radii:?}");
    }
}

/// A stem, and two arms of equal length that meet below an end.
fn diamond() -> VeinGraph {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::ZERO);
    let fork = graph.sprout(root, DVec2::new(0.0, 1.0));
    let left = graph.sprout(fork, DVec2::new(-1.0, 2.0));
    let right = graph.sprout(fork, DVec2::new(1.0, 2.0));
    let meeting = graph.sprout(left, DVec2::new(0.0, 3.0));
    graph.join(right, meeting);
    graph.sprout(meeting, DVec2::new(0.0, 4.0));
    graph
}

#[test]
fn both_arms_of_a_symmetric_loop_are_equally_wide() {
    let radii = adapted(&diamond(), 0.5);
    let (left, right) = (radii[2], radii[3]);
    assert!((left - right).abs() < 1e-5 && left > 0.1, "{radii:?}");
    // Either carries half of what the stem does, less one sink of three.
    assert!(left < radii[1] && radii[0] == 1.0 && radii[1] == 1.0, "{radii:?}");
}

#[test]
fn the_short_side_of_a_loop_carries_more() {
    let mut graph = diamond();
    let far = DVec2::new(-1.0, 2.0);
    graph = graph.mapped(|p| if p == far { DVec2::new(-9.0, 2.0) } else { p });
    let radii = adapted(&graph, 1.0);
    assert!(radii[2] < radii[3], "{radii:?}");
}

#[test]
fn roots_alone_and_several_roots_have_radii() {
    let mut graph = VeinGraph::new();
    graph.add_root(DVec2::ZERO);
    assert_eq!(adapted(&graph, 0.5), [1e-3]);
    let other = graph.add_root(DVec2::X);
    graph.sprout(other, DVec2::new(1.0, 1.0));
    assert_eq!(adapted(&graph, 0.5)[1..], [1.0, 1.0]);
}

#[test]
fn too_many_junctions_are_refused() {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::ZERO);
    for i in 0..=MOST_STOPS {
        graph.sprout(root, DVec2::new(i as f64, 1.0));
    }
    let refused = radii(&graph, &vec![1.0; graph.len()], 1e-3, 0.5, &mut Silent);
    assert_eq!(
        refused.expect_err("too many").to_string(),
        "veins.widths = \"flow\" takes at most 200000 junctions and ends, here are 200001: grow \
         fewer veins (veins.source_spawn_distance_mm) or take \"murray\""
    );
}
