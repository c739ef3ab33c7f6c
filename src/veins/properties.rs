//! What every stage after growth promises, over random nets.

use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::geometry::polygon::{nearest_on_segment, segments_touch};
use crate::geometry::segments::SegmentIndex;
use crate::margin::MarginSpec;
use planar::CLEARANCE_MM;

/// Edges of one node that leave within this share of the shorter one lie nearly on each other.
const GAP: f64 = 0.02;

/// Nodes about `spacing` apart in a part of a blade, each hung on the nearest that it can see, and joins:
/// plane, with guided veins, in places so dense that a hair lies between two veins.
fn net(margin: &Margin, seed: u64, count: usize, spacing: f64) -> VeinGraph {
    let mut rng = Seed(seed).stream(Stage::Shuffle);
    let side = spacing * (count as f64).sqrt();
    // A third of the nets lies at the margin.
    let at_margin = margin.outline()[(rng.unit() * margin.outline().len() as f64) as usize];
    let middle = if rng.unit() < 0.33 { at_margin } else { DVec2::new(0.0, 30.0) };
    let lines = margin.lines();
    let inside = SegmentIndex::of_polygon(margin.outline());
    let mut graph = VeinGraph::new();
    while graph.len() < count {
        let p = middle + DVec2::new(rng.between(-0.5, 0.5), rng.between(-0.5, 0.5)) * side;
        let is_taken = graph.positions().iter().any(|q| q.distance(p) < 0.2 * spacing);
        if is_taken || !inside.contains(p) {
            continue;
        }
        if graph.is_empty() {
            let root = graph.add_root(p);
            graph.set_rank(root, Rank { order: 1, kind: VeinKind::Primary });
            continue;
        }
        let mut order: Vec<NodeId> = (0..graph.len() as NodeId).collect();
        let far = |node: &NodeId| graph.positions()[*node as usize].distance(p);
        order.sort_by(|a, b| far(a).total_cmp(&far(b)));
        order.truncate(3);
        let seen = order.into_iter().find(|&node| {
            let from = graph.positions()[node as usize];
            !lines.touches(from, p) && is_free(&graph, [node, NodeId::MAX], [from, p])
        });
        let Some(parent) = seen else { continue };
        let node = graph.sprout(parent, p);
        let draw = rng.unit();
        if let Some(rank) = graph.rank(parent).filter(|_| draw < 0.3) {
            let order = (rank.order + u8::from(draw < 0.1)).min(3);
            let kind = [VeinKind::Primary, VeinKind::Secondary, VeinKind::Tertiary];
            graph.set_rank(node, Rank { order, kind: kind[usize::from(order) - 1] });
        }
    }
    for _ in 0..2 * count {
        let [a, b] = [(); 2].map(|()| (rng.unit() * count as f64) as NodeId);
        let ends = [a, b].map(|node| graph.positions()[node as usize]);
        let known = edges(&graph).iter().any(|&e| e == [a, b] || e == [b, a]);
        let far = ends[0].distance(ends[1]) > 3.0 * spacing;
        if a != b
            && !known
            && !far
            && !lines.touches(ends[0], ends[1])
            && is_free(&graph, [a, b], ends)
        {
            graph.join(a, b);
        }
    }
    graph
}

fn edges(graph: &VeinGraph) -> Vec<[NodeId; 2]> {
    graph.edges().chain(graph.joins().iter().copied()).map(|(a, b)| [a, b]).collect()
}

/// The distance of two lines; of those with a common end (`Some`), the share of the shorter one that the
/// end of one keeps from the other.
fn distance([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> f64 {
    if segments_touch(a, b, c, d) {
        return 0.0;
    }
    let ends = [(a, b, c), (a, b, d), (c, d, a), (c, d, b)];
    let apart = ends.map(|(a, b, p)| nearest_on_segment(a, b, p).distance(p));
    apart.into_iter().fold(f64::INFINITY, f64::min)
}

/// Whether two edges are not in each other's way, the slow and obvious way.
fn are_apart(ends: [NodeId; 2], line: [DVec2; 2], others: [NodeId; 2], other: [DVec2; 2]) -> bool {
    let hub = (0..2).flat_map(|i| [(i, 0), (i, 1)]).find(|&(i, j)| ends[i] == others[j]);
    let Some((i, j)) = hub else { return distance(line, other) > CLEARANCE_MM };
    let (a, b) = (line[1 - i], other[1 - j]);
    let apart = nearest_on_segment(other[0], other[1], a)
        .distance(a)
        .min(nearest_on_segment(line[0], line[1], b).distance(b));
    apart >= 0.999 * GAP * line[0].distance(line[1]).min(other[0].distance(other[1]))
}

/// Whether a line between nodes, of which one may be new, is in the way of no edge.
fn is_free(graph: &VeinGraph, ends: [NodeId; 2], line: [DVec2; 2]) -> bool {
    let at = |node: NodeId| graph.positions()[node as usize];
    edges(graph).into_iter().all(|other| are_apart(ends, line, other, other.map(at)))
}

/// The first two edges that are in each other's way, or an edge that leaves the blade.
fn fault(graph: &VeinGraph, margin: &Margin) -> Option<String> {
    if let Some(wrong) = graph.check() {
        return Some(wrong);
    }
    let at = |node: NodeId| graph.positions()[node as usize];
    let inside = SegmentIndex::of_polygon(margin.outline());
    if let Some(p) = graph.positions().iter().find(|p| !inside.contains(**p)) {
        return Some(format!("a node outside at {p}"));
    }
    let edges = edges(graph);
    let lines = margin.lines();
    for (i, &one) in edges.iter().enumerate() {
        let line = one.map(at);
        if lines.touches(line[0], line[1]) {
            return Some(format!("edge {one:?} touches the margin"));
        }
        let crossed = edges[..i].iter().find(|&&other| !are_apart(one, line, other, other.map(at)));
        if let Some(other) = crossed {
            return Some(format!("edge {one:?} is in the way of {other:?} near {}", line[0]));
        }
    }
    None
}

/// How many edges end at each node.
fn degrees(graph: &VeinGraph) -> Vec<usize> {
    let mut degrees = vec![0; graph.len()];
    edges(graph).into_iter().flatten().for_each(|node| degrees[node as usize] += 1);
    degrees
}

fn roots(graph: &VeinGraph) -> Vec<DVec2> {
    let roots = (0..graph.len() as NodeId).filter(|&node| graph.parent(node).is_none());
    roots.map(|node| graph.positions()[node as usize]).collect()
}

fn length(graph: &VeinGraph) -> f64 {
    let at = |node: NodeId| graph.positions()[node as usize];
    edges(graph).into_iter().map(|[a, b]| at(a).distance(at(b))).sum()
}

/// The places of nodes that a stage must leave, of those with a property.
fn places(graph: &VeinGraph, holds: impl Fn(NodeId) -> bool) -> Vec<[u64; 2]> {
    let nodes = (0..graph.len() as NodeId).filter(|&node| holds(node));
    let place = |node: NodeId| graph.positions()[node as usize].to_array().map(f64::to_bits);
    let mut places: Vec<_> = nodes.map(place).collect();
    places.sort_unstable();
    places
}

fn margin() -> Margin {
    crate::margin::build(&MarginSpec::default(), Seed(1)).expect("the default margin")
}

/// A net and the settings of the stages.
#[derive(Debug, Clone)]
struct Case {
    seed: u64,
    count: usize,
    spacing: f64,
    relaxation: u64,
    smoothing: f64,
    sinuosity: f64,
    areole_pressure: f64,
}

impl Case {
    fn net(&self) -> VeinGraph {
        net(&margin(), self.seed, self.count, self.spacing)
    }

    fn spec(&self) -> VeinSpec {
        VeinSpec {
            node_step_mm: self.spacing,
            kill_distance_mm: self.spacing,
            relaxation: self.relaxation,
            smoothing: self.smoothing,
            sinuosity: self.sinuosity,
            areole_pressure: self.areole_pressure,
            ..VeinSpec::default()
        }
    }
}

/// Of several sizes; in the least the clearance is a part that counts.
fn any_case() -> impl Strategy<Value = Case> {
    let sizes = prop_oneof![Just(0.01), Just(0.5), Just(2.0)];
    let settings = (1u64..8, 0.05..1.0f64, 0.02..0.5f64, 0.0..0.3f64);
    (any::<u64>(), 10usize..70, sizes, settings).prop_map(|(seed, count, spacing, settings)| {
        let (relaxation, smoothing, sinuosity, areole_pressure) = settings;
        Case { seed, count, spacing, relaxation, smoothing, sinuosity, areole_pressure }
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    #[test]
    fn junctions_come_apart_and_nothing_else_changes(case in any_case()) {
        let (graph, spec) = (case.net(), case.spec());
        let after = vec![1, graph.len() as u32 / 2, graph.len() as u32];
        let (made, counts) = split::split(&spec, &margin(), graph.clone(), after.clone());
        prop_assert_eq!(fault(&made, &margin()), None);
        // A node more is an edge more: loops and pieces are as many as before.
        prop_assert_eq!(made.joins().len(), graph.joins().len());
        prop_assert_eq!(roots(&made), roots(&graph));
        let stars = |graph: &VeinGraph| -> usize {
            degrees(graph).into_iter().map(|degree| degree.saturating_sub(3)).sum()
        };
        prop_assert_eq!(stars(&graph) - stars(&made), made.len() - graph.len());
        // Every node stays where it was; what is new has three edges or more.
        let before = places(&graph, |_| true);
        let kept = places(&made, |node| before.binary_search(&bits(&made, node)).is_ok());
        prop_assert_eq!(&kept, &before);
        let degrees = degrees(&made);
        let fresh = |node: &NodeId| before.binary_search(&bits(&made, *node)).is_err();
        for node in (0..made.len() as NodeId).filter(fresh) {
            prop_assert!(degrees[node as usize] >= 3, "node {} of {}", node, degrees[node as usize]);
        }
        prop_assert_eq!(counts[2], made.len() as u32);
        prop_assert!(counts[0] >= 1 && counts[0] <= counts[1] && counts[1] <= counts[2]);
    }

    #[test]
    fn relaxing_moves_junctions_and_crosses_nothing(case in any_case()) {
        let (graph, spec) = (case.net(), case.spec());
        let made = relax::relaxed(&spec, &margin(), graph.clone(), || ());
        prop_assert_eq!(fault(&made, &margin()), None);
        prop_assert_eq!(edges(&made), edges(&graph));
        let is_midrib = |node: NodeId| graph.rank(node).is_some_and(|rank| rank.order == 1);
        let degrees = degrees(&graph);
        let is_guided_end = |node: NodeId| graph.rank(node).is_some() && degrees[node as usize] == 1;
        for node in 0..graph.len() as NodeId {
            let [was, is] = [&graph, &made].map(|graph| graph.positions()[node as usize]);
            if is_midrib(node) || is_guided_end(node) || graph.parent(node).is_none() {
                prop_assert_eq!(was, is);
            }
            // Half a step for each of the junctions that take it along, in every sweep.
            prop_assert!(was.distance(is) <= spec.relaxation as f64 * spec.node_step_mm);
        }
    }

    #[test]
    fn smoothing_keeps_the_net(case in any_case(), relaxes in any::<bool>()) {
        let (graph, spec) = (case.net(), case.spec());
        let spec = VeinSpec { relaxation: if relaxes { spec.relaxation } else { 0 }, ..spec };
        let after = vec![1, graph.len() as u32];
        let made = smooth::smoothed(&spec, &margin(), graph.clone(), after);
        prop_assert_eq!(fault(&made.graph, &margin()), None);
        prop_assert_eq!(made.nodes_after_step, vec![1, made.graph.len() as u32]);
        prop_assert_eq!(made.graph.joins().len(), graph.joins().len());
        prop_assert_eq!(roots(&made.graph), roots(&graph));
        // Junctions and ends are as many, and new nodes lie along veins.
        let sorted = |graph: &VeinGraph| {
            let mut degrees = degrees(graph);
            degrees.retain(|&degree| degree != 2);
            degrees.sort_unstable();
            degrees
        };
        prop_assert_eq!(sorted(&made.graph), sorted(&graph));
        let ends = |graph: &VeinGraph| {
            let degrees = degrees(graph);
            places(graph, |node| degrees[node as usize] == 1)
        };
        prop_assert_eq!(ends(&made.graph), ends(&graph));
        prop_assert!(length(&made.graph) <= 1.3 * length(&graph));
    }

    #[test]
    fn bows_leave_junctions_ends_and_guides(case in any_case(), seed in any::<u64>()) {
        let (graph, spec) = (case.net(), case.spec());
        let rough = VeinSpec { smoothing: 1e-9, ..spec.clone() };
        let after = vec![graph.len() as u32];
        // Pieces that can bow.
        let graph = smooth::smoothed(&rough, &margin(), graph, after).graph;
        let made = bow::bowed(&spec, &margin(), graph.clone(), &mut Seed(seed).stream(Stage::Bows));
        prop_assert_eq!(fault(&made, &margin()), None);
        prop_assert_eq!(edges(&made), edges(&graph));
        let degrees = degrees(&graph);
        for node in 0..graph.len() as NodeId {
            let [was, is] = [&graph, &made].map(|graph| graph.positions()[node as usize]);
            if degrees[node as usize] != 2 || graph.rank(node).is_some() || graph.parent(node).is_none() {
                prop_assert_eq!(was, is);
            }
            // Three deviations of an arch and half of that of a wave, of the longest bow.
            let most = 4.5 * spec.sinuosity * 8.0 * spec.node_step_mm;
            prop_assert!(was.distance(is) <= most);
        }
    }

    #[test]
    fn pruning_takes_short_free_ends_only(case in any_case(), least in 0.1..3.0f64) {
        let (graph, spec) = (case.net(), case.spec());
        let spec = VeinSpec { least_veinlet: least, ..spec };
        let least = least * spec.kill_distance_mm;
        let after = vec![1, graph.len() as u32 / 2, graph.len() as u32];
        let (made, counts) = prune::pruned(&spec, graph.clone(), after.clone());
        prop_assert_eq!(made.check(), None);
        // Those that are left are in order: who went?
        let mut kept = vec![false; graph.len()];
        let mut numbers = vec![NodeId::MAX; graph.len()];
        let mut next = 0;
        for node in 0..graph.len() {
            if made.positions().get(next) == Some(&graph.positions()[node]) {
                (kept[node], numbers[node]) = (true, next as NodeId);
                next += 1;
            }
        }
        prop_assert_eq!(next, made.len());
        let count = |before: u32| kept[..before as usize].iter().filter(|kept| **kept).count() as u32;
        prop_assert_eq!(counts, after.into_iter().map(count).collect::<Vec<_>>());
        let left = edges(&graph).into_iter().filter(|e| e.iter().all(|&node| kept[node as usize]));
        let left: Vec<_> = left.map(|e| e.map(|node| numbers[node as usize])).collect();
        prop_assert_eq!(left, edges(&made));
        prop_assert_eq!(made.joins().len(), graph.joins().len());
        // The longest way from what is left to the end of what went.
        let at = |node: NodeId| graph.positions()[node as usize];
        let mut reach = vec![0.0f64; graph.len()];
        for (parent, node) in graph.edges().collect::<Vec<_>>().into_iter().rev() {
            let way = reach[node as usize] + at(parent).distance(at(node));
            if kept[node as usize] {
                prop_assert!(kept[parent as usize], "a vein without a parent");
                continue;
            }
            prop_assert!(graph.rank(node).is_none(), "a guided vein went");
            prop_assert!(way < least, "{} of {}", way, least);
            reach[parent as usize] = reach[parent as usize].max(if kept[parent as usize] { 0.0 } else { way });
        }
        // And nothing short is left that ends free.
        let degrees = degrees(&made);
        for tip in (0..made.len() as NodeId).filter(|&node| degrees[node as usize] == 1) {
            let (mut node, mut way, mut is_guided) = (tip, 0.0, false);
            while let Some(parent) = made.parent(node).filter(|_| node == tip || degrees[node as usize] == 2) {
                is_guided |= made.rank(node).is_some();
                way += made.positions()[node as usize].distance(made.positions()[parent as usize]);
                node = parent;
            }
            let hangs = degrees[node as usize] > 2;
            prop_assert!(!hangs || is_guided || way >= least, "{} of {} at {}", way, least, tip);
        }
    }
}

fn bits(graph: &VeinGraph, node: NodeId) -> [u64; 2] {
    graph.positions()[node as usize].to_array().map(f64::to_bits)
}
