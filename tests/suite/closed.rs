//! Closed venation: the fast path against the obvious one, and what loops promise.

use venation::geometry::polygon::segments_touch;
use venation::growth::{GrowingBlade, GrowthSpec};
use venation::observer::Silent;
use venation::seed::{Seed, Stage};
use venation::veins::{Algorithm, VeinGraph, VeinSpec, auxin};

use super::reference::{self, Frame};
use super::veins::{ellipse, for_all_cases, grown};

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

/// Pieces that hang together, counting joins.
fn components(graph: &VeinGraph) -> usize {
    let mut group: Vec<usize> = (0..graph.len()).collect();
    fn find(group: &mut [usize], mut i: usize) -> usize {
        while group[i] != i {
            group[i] = group[group[i]];
            i = group[i];
        }
        i
    }
    for (a, b) in segments(graph) {
        let (a, b) = (find(&mut group, a as usize), find(&mut group, b as usize));
        group[a] = b;
    }
    (0..graph.len()).filter(|&i| find(&mut group, i) == i).count()
}

fn ends(graph: &VeinGraph) -> usize {
    let mut degrees = vec![0; graph.len()];
    for (a, b) in segments(graph) {
        degrees[a as usize] += 1;
        degrees[b as usize] += 1;
    }
    degrees.iter().filter(|&&degree| degree == 1).count()
}

#[test]
fn areoles_are_counted_by_joins_and_the_last_veinlets_end_free() {
    let blade = GrowingBlade::new(ellipse(), &GrowthSpec::default()).expect("a blade");
    let grow = |closing_share: f64| {
        let spec = VeinSpec {
            algorithm: Algorithm::AuxinClosed,
            closing_share,
            smoothing: 0.0,
            ..VeinSpec::default()
        };
        let venation = grown(&blade, &spec, 5);
        let graph = venation.graph();
        let roots = (0..graph.len() as u32).filter(|&node| graph.parent(node).is_none()).count();
        // Euler's formula: the bounded faces of a planar graph.
        let faces = segments(graph).len() + components(graph) - graph.len();
        assert_eq!(faces, graph.joins().len() + components(graph) - roots);
        (faces, ends(graph))
    };
    let (loops, free_ends) = grow(1.0);
    assert!(loops > 500, "{loops} areoles");
    assert!(free_ends < loops / 4, "{free_ends} free ends among {loops} areoles");
    let (loops, free_ends) = grow(0.8);
    assert!(free_ends > loops / 4, "{free_ends} free ends among {loops} areoles");
    assert_eq!(grow(0.0).0, 0, "open from the first step");
}
