use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::geometry::polygon::{self, segments_touch};
use crate::growth::GrowthSpec;
use crate::margin::{self, Margin, MarginSpec};
use crate::seed::{Seed, Stage};
use crate::veins::graph::NodeId;

fn laid(guides: GuideSpec, margin: &Margin, seed: u64) -> VeinGraph {
    let blade = GrowingBlade::new(margin.clone(), &GrowthSpec::default()).expect("grows");
    let spec = VeinSpec { guides, node_step_mm: 0.5, ..VeinSpec::default() };
    build(&spec, &blade, &mut Seed(seed).stream(Stage::Guides))
}

/// What every set of guides promises; `None` when it holds.
fn broken(graph: &VeinGraph, margin: &Margin) -> Option<String> {
    if let Some(wrong) = graph.check() {
        return Some(wrong);
    }
    let positions = graph.positions();
    if let Some(p) = positions.iter().find(|p| !polygon::contains(margin.outline(), **p)) {
        return Some(format!("a node outside at {p}"));
    }
    let at = |node: NodeId| positions[node as usize];
    let edges: Vec<(NodeId, NodeId)> = graph.edges().chain(graph.joins().iter().copied()).collect();
    for (i, &(a, b)) in edges.iter().enumerate() {
        if graph.rank(b).is_none() {
            return Some(format!("node {b} has no rank"));
        }
        if polygon::edges(margin.outline()).any(|(c, d)| segments_touch(at(a), at(b), c, d)) {
            return Some(format!("a guide crosses the margin near {}", at(b)));
        }
        for &(c, d) in &edges[i + 1..] {
            let apart = at(a).distance(at(c)) > 4.0;
            let linked = a == c || a == d || b == c || b == d;
            if !apart && !linked && segments_touch(at(a), at(b), at(c), at(d)) {
                return Some(format!(
                    "guides {a}–{b} and {c}–{d} of {} cross near {}, edge {i}",
                    graph.len(),
                    at(b)
                ));
            }
        }
    }
    None
}

fn oval() -> Margin {
    margin::build(&MarginSpec::default(), Seed(1)).expect("the default margin")
}

/// Wavy or lobed: a closed curve around the axis with the base in a corner at the origin.
fn random_margin(lobes: u32, depth: f64, width: f64, skew: f64) -> Option<Margin> {
    let n = 240;
    let mut outline = Vec::new();
    for i in 0..n {
        let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        let wave = 1.0 + depth * libm::cos(f64::from(lobes) * t);
        let r = 40.0 * wave / (1.0 + depth);
        let side = if t < std::f64::consts::PI { 1.0 } else { 1.0 - skew };
        outline.push(DVec2::new(r * libm::sin(t) * width * side, -r * libm::cos(t)));
    }
    let base = outline[0];
    outline.iter_mut().for_each(|p| *p -= base);
    let apex = (n / 2) as usize;
    outline[apex].x = 0.0;
    Margin::new(outline, apex, Vec::new(), "").ok()
}

fn any_spec() -> impl Strategy<Value = GuideSpec> {
    (
        (0..PrimaryType::ALL.len(), 0..SecondaryType::ALL.len(), 0..RimType::ALL.len()),
        (1u64..12, 0u64..14, 0u64..6),
        (20.0..150.0f64, 20.0..85.0f64, -30.0..20.0f64, -0.2..0.9f64),
        (0.0..1.0f64, 0.0..1.0f64, 0.0..1.0f64, 0.0..2.0f64),
        (0..TertiaryType::ALL.len(), 0.02..0.1f64),
    )
        .prop_map(|((p, s, r), counts, angles, shares, (t, spacing))| GuideSpec {
            tertiary: TertiaryType::ALL[t],
            tertiary_spacing: spacing,
            primary: PrimaryType::ALL[p],
            secondary: SecondaryType::ALL[s],
            rim: RimType::ALL[r],
            primary_count: counts.0,
            secondary_count: counts.1,
            lateral_count: counts.2,
            primary_angle_deg: angles.0,
            secondary_angle_deg: angles.1,
            angle_change_deg: angles.2,
            curvature: angles.3,
            irregularity: shares.0,
            decurrence: shares.1,
            alternation: shares.2,
            intersecondary_count: shares.3,
            ..GuideSpec::default()
        })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn guides_cross_nothing_on_any_margin(
        spec in any_spec(),
        lobes in 0u32..9,
        depth in 0.0..0.55f64,
        width in 0.15..1.2f64,
        skew in 0.0..0.6f64,
        seed in 0u64..1000,
    ) {
        let Some(margin) = random_margin(lobes, depth, width, skew) else { return Ok(()) };
        let graph = laid(spec.clone(), &margin, seed);
        prop_assert_eq!(broken(&graph, &margin), None);
        prop_assert_eq!(&graph, &laid(spec, &margin, seed));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn tertiaries_change_no_other_vein_and_end_as_their_type_says(
        spec in any_spec(),
        kind in 1..TertiaryType::ALL.len(),
        seed in 0u64..1000,
    ) {
        let margin = oval();
        let spec = GuideSpec { tertiary: TertiaryType::ALL[kind], ..spec };
        let bare = laid(GuideSpec { tertiary: TertiaryType::None, ..spec.clone() }, &margin, seed);
        let graph = laid(spec.clone(), &margin, seed);
        // They come last: all that was there stays as it was.
        prop_assert_eq!(&graph.positions()[..bare.len()], bare.positions());
        prop_assert_eq!(&graph.joins()[..bare.joins().len()], bare.joins());
        let spacing = spec.tertiary_spacing * margin.length_mm();
        let (fresh, joins) = (bare.len() as NodeId.., &graph.joins()[bare.joins().len()..]);
        let (mut firsts, mut path) = (0, vec![0.0; graph.len()]);
        for node in fresh.take_while(|&node| (node as usize) < graph.len()) {
            prop_assert_eq!(graph.rank(node).map(|rank| rank.kind), Some(VeinKind::Tertiary));
            let parent = graph.parent(node).expect("no root");
            let [a, b] = [parent, node].map(|node| graph.positions()[node as usize]);
            if parent < bare.len() as NodeId {
                firsts += 1;
            }
            path[node as usize] = path[parent as usize] + a.distance(b);
            // Leaning and bent, from one vein to the next.
            prop_assert!(path[node as usize] < 1.5 * 14.0 * spacing, "{} of {}", path[node as usize], spacing);
        }
        match spec.tertiary {
            TertiaryType::Ramified => prop_assert!(joins.is_empty(), "they end free"),
            _ => prop_assert!(joins.len() <= firsts, "{} ends of {}", joins.len(), firsts),
        }
        // A rung joins what it has come to, but where the way there is not clear.
        if spec.tertiary == TertiaryType::Percurrent {
            prop_assert!(3 * joins.len() >= 2 * firsts, "{} ends of {}", joins.len(), firsts);
        }
    }
}

/// Where secondaries leave the midrib: sides and ends.
fn secondaries(graph: &VeinGraph) -> Vec<(f64, DVec2)> {
    let positions = graph.positions();
    let counts = graph.child_counts();
    let order = |node: NodeId| graph.rank(node).map_or(9, |rank| rank.order);
    graph
        .edges()
        .filter(|&(parent, child)| order(parent) == 1 && order(child) == 2)
        .map(|(_, first)| {
            let mut end = first;
            while counts[end as usize] > 0 {
                end = graph.edges().find(|e| e.0 == end).expect("a child").1;
            }
            (positions[first as usize].x.signum(), positions[end as usize])
        })
        .collect()
}

fn pinnate(secondary: SecondaryType) -> GuideSpec {
    GuideSpec { primary: PrimaryType::Pinnate, secondary, ..GuideSpec::default() }
}

#[test]
fn craspedodromous_secondaries_end_at_the_margin() {
    let margin = oval();
    let graph = laid(pinnate(SecondaryType::Craspedodromous), &margin, 3);
    let ends = secondaries(&graph);
    assert!(ends.len() >= 12, "{}", ends.len());
    for (_, end) in ends {
        let edges = polygon::edges(margin.outline());
        let distance = edges
            .map(|(a, b)| polygon::nearest_on_segment(a, b, end).distance(end))
            .fold(f64::INFINITY, f64::min);
        assert!(distance < 0.02 * margin.length_mm(), "{distance} at {end}");
    }
}

#[test]
fn secondaries_end_in_the_teeth() {
    let margin = targets::tests::toothed(10, 3.0);
    let spec = GuideSpec { secondary_count: 9, ..pinnate(SecondaryType::Craspedodromous) };
    let graph = laid(spec, &margin, 5);
    let teeth = targets::teeth(&margin, 9.0);
    let ends = secondaries(&graph);
    for side in [1.0, -1.0] {
        let has_vein = |tip: &&targets::Tip| ends.iter().any(|(_, end)| end.distance(tip.at) < 1.0);
        let tips: Vec<_> = teeth.iter().filter(|tip| tip.side == side).collect();
        let first = tips.iter().position(&has_vein).expect("a tooth with a vein");
        let last = tips.iter().rposition(&has_vein).expect("a tooth with a vein");
        assert!(last - first >= 4, "{first} {last}");
        assert!(tips[first..=last].iter().all(&has_vein), "a tooth without a vein on side {side}");
    }
    assert!(ends.len() <= teeth.len() + 4, "secondaries between the teeth: {}", ends.len());
}

#[test]
fn a_symmetric_leaf_has_as_many_on_the_left_as_on_the_right() {
    for &kind in &SecondaryType::ALL[1..] {
        let spec = GuideSpec { alternation: 0.0, asymmetry: 0.0, ..pinnate(kind) };
        let ends = secondaries(&laid(spec, &oval(), 2));
        let right = ends.iter().filter(|end| end.0 > 0.0).count();
        assert_eq!(2 * right, ends.len(), "{kind}");
        assert!(right >= 5, "{kind} {right}");
    }
}

#[test]
fn brochidodromous_secondaries_close_loops() {
    let graph = laid(pinnate(SecondaryType::Brochidodromous), &oval(), 2);
    assert!(graph.joins().len() >= 8, "{}", graph.joins().len());
}

#[test]
fn a_midrib_is_straight_and_ends_near_the_apex() {
    for irregularity in [0.0, 1.0] {
        let spec = GuideSpec { irregularity, ..pinnate(SecondaryType::None) };
        let graph = laid(spec, &oval(), 4);
        let positions = graph.positions();
        let end = positions[positions.len() - 1];
        let path = curve::length(positions);
        assert!(path / end.distance(positions[0]) <= 1.05);
        assert!(end.distance(oval().apex()) < 0.05 * oval().length_mm());
    }
}

#[test]
fn a_bent_blade_has_its_midrib_in_the_middle() {
    // A sickle: its chord leaves the blade.
    let rib = |t: f64| DVec2::new(30.0 * libm::sin(std::f64::consts::PI * t), 100.0 * t);
    let half = |t: f64| 9.0 * libm::sin(std::f64::consts::PI * t);
    let mut outline = vec![DVec2::ZERO];
    outline
        .extend((1..60).map(|i| rib(f64::from(i) / 60.0) + DVec2::X * half(f64::from(i) / 60.0)));
    outline.push(DVec2::new(0.0, 100.0));
    outline.extend(
        (1..60).rev().map(|i| rib(f64::from(i) / 60.0) - DVec2::X * half(f64::from(i) / 60.0)),
    );
    let margin = Margin::new(outline, 60, Vec::new(), "").expect("a sickle");
    let graph = laid(pinnate(SecondaryType::Craspedodromous), &margin, 1);
    assert_eq!(broken(&graph, &margin), None);
    let order = |node: usize| graph.rank(node as NodeId).map_or(9, |rank| rank.order);
    let midrib = (0..graph.len()).filter(|&n| order(n) == 1).map(|n| graph.positions()[n]);
    for p in midrib.filter(|p| (20.0..80.0).contains(&p.y)) {
        let off = (p.x - rib(p.y / 100.0).x).abs();
        assert!(off < 0.45 * half(p.y / 100.0), "{off} at {p}");
    }
    assert!(secondaries(&graph).len() >= 8);
}

#[test]
fn every_type_lays_veins() {
    let margin = random_margin(0, 0.0, 0.8, 0.0).expect("an oval");
    for &primary in &PrimaryType::ALL[1..] {
        let spec = GuideSpec { primary, ..pinnate(SecondaryType::Eucamptodromous) };
        let graph = laid(spec, &margin, 6);
        let kinds = |kind| {
            (0..graph.len() as u32)
                .filter(|&n| graph.rank(n).is_some_and(|r| r.kind == kind))
                .count()
        };
        assert!(kinds(VeinKind::Primary) > 120, "{primary}");
        let midrib = primary != PrimaryType::Flabellate;
        assert_eq!(kinds(VeinKind::Secondary) > 20, midrib, "{primary}");
    }
    for rim in [RimType::Intramarginal, RimType::Marginal] {
        let spec = GuideSpec { rim, ..pinnate(SecondaryType::Craspedodromous) };
        let graph = laid(spec, &margin, 6);
        let kind =
            if rim == RimType::Marginal { VeinKind::Marginal } else { VeinKind::Intramarginal };
        let count = (0..graph.len() as u32)
            .filter(|&n| graph.rank(n).is_some_and(|r| r.kind == kind))
            .count();
        assert!(count as f64 * 0.5 > 0.6 * polygon::perimeter(margin.outline()), "{rim} {count}");
    }
}

#[test]
fn a_number_out_of_its_limits_is_refused_with_its_key() {
    let guides = GuideSpec { curvature: 7.0, ..pinnate(SecondaryType::None) };
    let spec = VeinSpec { guides, ..VeinSpec::default() };
    let blade = GrowingBlade::new(oval(), &GrowthSpec::default()).expect("it grows");
    let error = crate::veins::grow(&spec, &blade, Seed(1), &mut crate::observer::Silent);
    let error = error.expect_err("too curved").to_string();
    assert!(error.contains("veins.guides.curvature = 7"), "{error}");
}
