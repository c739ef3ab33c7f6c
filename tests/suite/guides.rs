//! Guided veins in whole leaves: every preset, several seeds.

use venation::growth::{GrowingBlade, GrowthType};
use venation::margin::{self, LandmarkKind};
use venation::observer::Silent;
use venation::presets::{self, PRESETS, Preset};
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::veins::guides::SecondaryType;
use venation::veins::{self, NodeId, VeinKind, Venation};

fn grown(spec: &LeafSpec, seed: u64) -> (GrowingBlade, Venation) {
    let margin = margin::build(&spec.margin, Seed(seed)).expect("a margin");
    let blade = GrowingBlade::new(margin, &spec.growth).expect("it grows");
    let venation = veins::grow(&spec.veins, &blade, Seed(seed), &mut Silent).expect("veins");
    (blade, venation)
}

/// A preset's leaf of one growth type is whole, and `twice` the same.
fn keeps_its_promises(preset: &Preset, growth: GrowthType, seed: u64, twice: bool) {
    let document = preset.document().expect("it parses");
    let mut spec = document.resolve(Seed(seed)).expect("it resolves");
    spec.growth.r#type = growth;
    spec.veins.spawn_rate = 40.0;
    if growth == GrowthType::Marginal {
        spec.growth.scale = 0.8;
    }
    let name = format!("{} {growth} {seed}", preset.name);
    let (blade, venation) = grown(&spec, seed);
    assert_eq!(venation.check(blade.finished()), None, "{name}");
    if twice {
        let (_, again) = grown(&spec, seed);
        assert_eq!(venation, again, "{name}");
    }
    let longest = 1.5 * 1.2 * spec.veins.node_step_mm;
    let at = |node: NodeId| venation.graph().positions()[node as usize];
    for (a, b) in venation.graph().edges() {
        let length = at(a).distance(at(b));
        assert!(length <= longest, "{name}: {length} of {longest} at {}", at(b));
    }
}

#[test]
fn presets_keep_what_venation_promises_whatever_the_growth() {
    // Two types each, every type with eight presets at least; all with all are for --ignored. One leaf of
    // each type is grown twice.
    let types = GrowthType::ALL;
    for (index, preset) in PRESETS.iter().enumerate() {
        let (one, other) = (index % types.len(), (index + 2) % types.len());
        keeps_its_promises(preset, types[one], one as u64, index < types.len());
        keeps_its_promises(preset, types[other], other as u64, false);
    }
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn presets_keep_what_venation_promises_in_every_growth() {
    for preset in PRESETS {
        for (seed, &growth) in (0..).zip(GrowthType::ALL) {
            keeps_its_promises(preset, growth, seed, false);
        }
    }
}

#[test]
fn in_every_preset_the_midrib_is_straight_and_the_widest_vein() {
    for preset in PRESETS {
        for seed in 0..3 {
            let document = preset.document().expect("it parses");
            let mut spec = document.resolve(Seed(seed)).expect("it resolves");
            // The midrib and the secondaries are laid: a coarse net between them will do.
            spec.veins.spawn_rate = 10.0;
            let (blade, venation) = grown(&spec, seed);
            let (graph, kind) = (venation.graph(), |node: NodeId| venation.kind(node));
            let at = |node: NodeId| graph.positions()[node as usize];
            let near_apex = |node: &NodeId| {
                kind(*node) == VeinKind::Primary
                    && at(*node).distance(blade.finished().apex())
                        < 0.05 * blade.finished().length_mm()
            };
            let nodes = 0..graph.len() as NodeId;
            let tip = nodes.clone().rfind(near_apex).expect("a midrib up to the apex");
            let (mut node, mut path) = (tip, 0.0);
            let mut midrib = vec![tip];
            while let Some(parent) = graph.parent(node) {
                path += at(node).distance(at(parent));
                assert_eq!(venation.orders()[node as usize], 1);
                node = parent;
                midrib.push(node);
            }
            assert!(path / at(tip).distance(at(node)) <= 1.05, "{} {seed}", preset.name);
            // Those of other primaries on each half of the blade: they bear them on both of their sides.
            let secondaries = |side: f64| {
                let edges = graph.edges();
                let leaves = edges.filter(|&(a, b)| {
                    kind(a) == VeinKind::Primary && kind(b) == VeinKind::Secondary
                });
                leaves
                    .filter(|&(a, b)| {
                        let is_on_midrib = midrib.contains(&a);
                        let x = if is_on_midrib { at(b).x - at(a).x } else { at(a).x };
                        x * side > 0.0
                    })
                    .count() as i64
            };
            // Fans and blades of grass have none.
            if spec.veins.guides.secondary == SecondaryType::None {
                continue;
            }
            let (right, left) = (secondaries(1.0), secondaries(-1.0));
            assert!(right >= 4 && (right - left).abs() <= 3, "{} {right} {left}", preset.name);
        }
    }
}

#[test]
fn every_lobe_of_a_lobed_preset_has_a_vein_to_its_tip() {
    for (name, expected) in [
        ("maple", VeinKind::Primary),
        ("ivy", VeinKind::Primary),
        ("oak", VeinKind::Secondary),
        ("tulip-tree", VeinKind::Secondary),
    ] {
        for seed in 0..4 {
            let document = presets::find(name).expect(name).document().expect("it parses");
            let mut spec = document.resolve(Seed(seed)).expect("it resolves");
            spec.veins.spawn_rate = 0.0;
            let (blade, venation) = grown(&spec, seed);
            let margin = blade.finished();
            let nodes = venation.graph().positions().iter().zip(0..);
            let nodes: Vec<_> = nodes.map(|(at, node)| (*at, venation.kind(node))).collect();
            for mark in margin.landmarks() {
                let LandmarkKind::LobeTip { origin } = mark.kind else { continue };
                let tip = margin.outline()[mark.vertex];
                let kind =
                    if mark.vertex == margin.apex_index() { VeinKind::Primary } else { expected };
                let near = nodes
                    .iter()
                    .any(|(at, own)| *own == kind && at.distance(tip) < 0.02 * margin.length_mm());
                assert!(near, "{name} seed {seed}: no {kind:?} vein at {tip} from {origin}");
            }
        }
    }
}
