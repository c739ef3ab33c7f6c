//! Closed venation: the fast path against the obvious one, and what loops promise.

use venation::geometry::polygon::segments_touch;
use venation::observer::Silent;
use venation::seed::{Seed, Stage};
use venation::veins::{Algorithm, VeinGraph, VeinSpec, auxin};

use super::reference::{self, Frame};
use super::veins::{for_all_cases, grown};

/// A case of open venation, closed; every third with last veins that end free.
fn closed(spec: &VeinSpec, seed: u64) -> VeinSpec {
    VeinSpec {
        algorithm: Algorithm::AuxinClosed,
        closing_share: if seed % 3 == 2 { 0.6 } else { 1.0 },
        ..spec.clone()
    }
}

#[test]
fn closed_venation_agrees_with_the_obvious_one_node_by_node() {
    let (mut nodes, mut joins) = (0, 0);
    for_all_cases(8, |name, blade, spec, seed| {
        let spec = &closed(spec, seed);
        let (root, darts) = (blade.root(), || Seed(seed).stream(Stage::AuxinSources));
        let slow = reference::grow(spec, blade, root, &mut darts(), Frame::Mature, usize::MAX);
        let mut bare = VeinGraph::new();
        bare.add_root(root);
        let fast = auxin::grow(spec, blade, bare, &mut darts(), &mut Silent).expect(name);
        for (id, &p) in fast.graph.positions().iter().enumerate().take(slow.positions.len()) {
            let parent = fast.graph.parent(id as u32).map(|parent| parent as usize);
            assert_eq!(parent, slow.parents[id], "{name}: node {id}");
            assert!(p.distance(slow.positions[id]) <= 1e-9 * 100.0, "{name}: node {id}");
        }
        assert_eq!(fast.graph.len(), slow.positions.len(), "{name}");
        let fast_joins: Vec<(usize, usize)> =
            fast.graph.joins().iter().map(|&(a, b)| (a as usize, b as usize)).collect();
        assert_eq!(fast_joins, slow.joins, "{name}");
        let left = fast.unreached;
        assert_eq!(left.out_of_reach + left.hidden + left.unfinished, slow.alive, "{name}");
        nodes += fast.graph.len();
        joins += fast_joins.len();
    });
    assert!(nodes > 15_000 && joins > 1000, "too easy: {nodes} nodes, {joins} joins");
}

/// Edges and joins.
fn segments(graph: &VeinGraph) -> Vec<(u32, u32)> {
    graph.edges().chain(graph.joins().iter().copied()).collect()
}

#[test]
fn closed_venation_is_planar_and_stays_inside() {
    for_all_cases(3, |name, blade, spec, seed| {
        let venation = grown(blade, &closed(spec, seed), seed);
        assert_eq!(venation.check(blade.finished()), None, "{name}");
        let graph = venation.graph();
        let at = |node: u32| graph.positions()[node as usize];
        let segments = segments(graph);
        for (i, &(a, b)) in segments.iter().enumerate() {
            for &(c, d) in &segments[..i] {
                let apart = a != c && a != d && b != c && b != d;
                let crosses = apart && segments_touch(at(a), at(b), at(c), at(d));
                assert!(!crosses, "{name}: {a}-{b} crosses {c}-{d}");
            }
        }
    });
}
