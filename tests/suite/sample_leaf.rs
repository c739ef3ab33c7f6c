//! A leaf for tests and benches of painting that need veins but not their growth: an ovate blade
//! filled by plain space colonisation in the frame of the mature leaf.

use std::sync::LazyLock;

use glam::DVec2;
use venation::geometry::polygon;
use venation::margin::Margin;
use venation::seed::{Seed, Stage};
use venation::veins::{NodeId, VeinGraph, Venation};

/// An ovate blade, `length` mm long.
pub(crate) fn ovate(length: f64) -> Margin {
    let side = |y: f64| 0.92 * length * y.powf(0.62) * (1.0 - y).powf(0.95) * (1.0 - 0.12 * y);
    let right = (1..80).map(|i| i as f64 / 80.0).map(|y| DVec2::new(side(y), y * length));
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right);
    outline.push(DVec2::new(0.0, length));
    outline.extend(
        (1..80).rev().map(|i| i as f64 / 80.0).map(|y| DVec2::new(-0.96 * side(y), y * length)),
    );
    Margin::new(outline, 80, Vec::new(), "").expect("an ovate blade is a margin")
}

/// A blade of 60 mm and its veins, grown once for all that ask.
pub(crate) fn veined() -> &'static (Margin, Venation) {
    static LEAF: LazyLock<(Margin, Venation)> = LazyLock::new(|| {
        let margin = ovate(60.0);
        let veins = veins(&margin);
        (margin, veins)
    });
    &LEAF
}

/// A blade without veins.
pub(crate) fn bare() -> Venation {
    Venation::new(VeinGraph::new(), Vec::new(), Vec::new())
}

/// Veins that fill `margin`, some 7000 nodes on an 80 mm blade.
pub(crate) fn veins(margin: &Margin) -> Venation {
    let length = margin.length_mm();
    let bounds = margin.bounds();
    let mut rng = Seed(11).stream(Stage::AuxinSources);
    let mut graph = VeinGraph::new();
    graph.add_root(DVec2::ZERO);
    // Each source with its nearest node and the distance to it.
    let mut sources: Vec<(DVec2, NodeId, f64)> = Vec::new();
    const STEPS: u32 = 260;
    for step in 0..STEPS {
        // In the frame of the mature leaf lengths shrink as the leaf grows.
        let scale = (0.12 + 0.88 * f64::from(step) / f64::from(STEPS)).recip();
        let (spacing, reach, grown) = (0.0135 * length * scale, 0.0105 * length, 0.0042 * length);
        for _ in 0..250 {
            let x = rng.between(bounds.min.x, bounds.max.x);
            let p = DVec2::new(x, rng.between(bounds.min.y, bounds.max.y));
            let crowded = sources.iter().any(|source| source.0.distance(p) < spacing);
            if crowded || !polygon::contains(margin.outline(), p) {
                continue;
            }
            let (node, distance) = nearest(&graph, p);
            if distance > 0.9 * spacing {
                sources.push((p, node, distance));
            }
        }
        let before = graph.len();
        let mut pulls = vec![DVec2::ZERO; before];
        for (p, node, _) in &sources {
            pulls[*node as usize] += (*p - graph.positions()[*node as usize]).normalize();
        }
        for (node, pull) in pulls.iter().enumerate() {
            let length = grown * scale.min(2.0);
            let p = graph.positions()[node] + pull.normalize_or_zero() * length;
            if pull.length() < 0.5 || nearest(&graph, p).1 < 0.3 * length {
                continue;
            }
            let child = graph.sprout(node as NodeId, p);
            for source in &mut sources {
                let distance = source.0.distance(p);
                if distance < source.2 {
                    (source.1, source.2) = (child, distance);
                }
            }
        }
        sources.retain(|source| source.2 > reach * scale);
    }
    measured(graph)
}

fn nearest(graph: &VeinGraph, p: DVec2) -> (NodeId, f64) {
    let distances = graph.positions().iter().map(|node| node.distance_squared(p)).enumerate();
    let (node, distance2) = distances.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a root");
    (node as NodeId, distance2.sqrt())
}

/// Radii by Murray's law, and orders by following the widest child.
fn measured(graph: VeinGraph) -> Venation {
    let edges: Vec<(NodeId, NodeId)> = graph.edges().collect();
    let mut cubes = vec![0.0_f64; graph.len()];
    for &(parent, child) in edges.iter().rev() {
        if cubes[child as usize] == 0.0 {
            cubes[child as usize] = 0.03_f64.powi(3);
        }
        cubes[parent as usize] += cubes[child as usize];
    }
    let mut widest = vec![0.0_f64; graph.len()];
    for &(parent, child) in &edges {
        widest[parent as usize] = widest[parent as usize].max(cubes[child as usize]);
    }
    let mut orders = vec![1_u8; graph.len()];
    for &(parent, child) in &edges {
        let branches = cubes[child as usize] < widest[parent as usize];
        orders[child as usize] = (orders[parent as usize] + u8::from(branches)).min(9);
    }
    let radii = cubes.iter().map(|cube| cube.max(0.03_f64.powi(3)).cbrt()).collect();
    Venation::new(graph, radii, orders)
}
