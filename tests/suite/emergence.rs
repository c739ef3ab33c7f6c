//! Veins that are straight, symmetric and ordered though nothing lays them down.

use venation::growth::{GrowingBlade, GrowthSpec, GrowthType};
use venation::margin;
use venation::presets;
use venation::seed::Seed;
use venation::veins::guides::PrimaryType;
use venation::veins::metrics::hierarchy::Hierarchy;
use venation::veins::{Algorithm, VeinKind, VeinSpec};

use super::veins::{ellipse, grown};

fn blade(kind: GrowthType) -> GrowingBlade {
    let growth = GrowthSpec { r#type: kind, ..GrowthSpec::default() };
    GrowingBlade::new(ellipse(), &growth).expect("a blade")
}

/// All that makes a hierarchy of its own.
fn emergent() -> VeinSpec {
    let mut spec = VeinSpec {
        algorithm: Algorithm::AuxinClosed,
        straightness: 0.7,
        symmetry: 0.8,
        ..VeinSpec::default()
    };
    spec.phases.coarseness = 6.0;
    spec.convergence.spacing_mm = 4.5;
    spec
}

#[test]
fn growth_alone_makes_a_straight_midrib_and_even_secondaries() {
    for kind in [GrowthType::Isotropic, GrowthType::NonUniform] {
        let blade = blade(kind);
        for seed in 1..=3 {
            let venation = grown(&blade, &emergent(), seed);
            assert_eq!(venation.check(blade.finished()), None, "{kind} {seed}");
            let found = Hierarchy::of(&venation, blade.finished()).expect("a midrib");
            assert!(found.midrib_sinuosity <= 1.05, "{kind} {seed}: {found:?}");
            assert!(found.secondaries.iter().all(|&count| count >= 4), "{kind} {seed}: {found:?}");
            assert!(found.difference() <= 2, "{kind} {seed}: {found:?}");
            assert!(found.secondary_sinuosity <= 1.1, "{kind} {seed}: {found:?}");
            assert!(found.spacing_variation <= 0.6, "{kind} {seed}: {found:?}");
            let kinds = |wanted: VeinKind| {
                let nodes = 0..venation.graph().len() as u32;
                nodes.filter(|&node| venation.kind(node) == wanted).count()
            };
            let counts = [VeinKind::Primary, VeinKind::Secondary, VeinKind::Minor].map(kinds);
            assert!(counts.iter().all(|&count| count > 100), "{counts:?}");
        }
    }
}

#[test]
fn straightness_makes_veins_straighter_and_symmetry_halves_alike() {
    let measured = |kind: GrowthType, change: &dyn Fn(&mut VeinSpec)| {
        let blade = blade(kind);
        let mut spec = VeinSpec::default();
        change(&mut spec);
        let found = (1..=4).map(|seed| {
            let venation = grown(&blade, &spec, seed);
            let hierarchy = Hierarchy::of(&venation, blade.finished()).expect("a midrib");
            (hierarchy.secondary_sinuosity - 1.0, mirrored_share(venation.graph().positions()))
        });
        found.fold((0.0, 0.0), |sum, one| (sum.0 + one.0 / 4.0, sum.1 + one.1 / 4.0))
    };
    let plain = measured(GrowthType::Isotropic, &|_| ());
    let straight = measured(GrowthType::Isotropic, &|spec| spec.straightness = 1.0);
    assert!(straight.0 < 0.9 * plain.0, "{straight:?} {plain:?}");
    // In a blade of full size the halves are each other's image.
    let symmetric = measured(GrowthType::None, &|spec| spec.symmetry = 1.0);
    assert!(symmetric.1 > 0.95, "{symmetric:?}");
    assert!(measured(GrowthType::None, &|_| ()).1 < 0.5);
}

/// The share of the nodes that have another at their mirrored place.
fn mirrored_share(nodes: &[glam::DVec2]) -> f64 {
    let is_near = |p: &&glam::DVec2| {
        let twin = glam::DVec2::new(-p.x, p.y);
        nodes.iter().any(|q| q.distance_squared(twin) < 0.01)
    };
    nodes.iter().filter(is_near).count() as f64 / nodes.len() as f64
}

#[test]
fn density_follows_the_margin_and_the_midrib() {
    let blade = blade(GrowthType::None);
    let share = |margin: f64, midrib: f64| {
        let mut spec = VeinSpec::default();
        (spec.density.margin, spec.density.midrib) = (margin, midrib);
        let venation = grown(&blade, &spec, 2);
        let nodes = venation.graph().positions();
        let near = |p: &&glam::DVec2| p.x.abs() < 5.0;
        nodes.iter().filter(near).count() as f64 / nodes.len() as f64
    };
    let even = share(1.0, 1.0);
    assert!(share(1.0, 6.0) > 1.1 * even);
    assert!(share(6.0, 1.0) < 0.97 * even);
    assert!(share(1.0, 0.0) < 0.9 * even);
}

/// A leaf of a preset whose hierarchy emerges is whole, and `twice` the same.
fn keeps_its_guarantees(name: &str, kind: GrowthType, seed: u64, twice: bool) {
    let document = presets::find(name).expect("a preset").document().expect("it parses");
    let mut spec = document.resolve(Seed(seed)).expect("it resolves");
    spec.growth.r#type = kind;
    spec.veins.guides.primary = PrimaryType::None;
    spec.veins.spawn_rate = 30.0;
    let own = emergent();
    spec.veins.straightness = own.straightness;
    spec.veins.pull = 0.4;
    spec.veins.symmetry = own.symmetry;
    spec.veins.phases = own.phases;
    spec.veins.convergence = own.convergence;
    spec.veins.density.margin = 1.5;
    let margin = margin::build(&spec.margin, Seed(1)).expect("a margin");
    let blade = GrowingBlade::new(margin, &spec.growth).expect("it grows");
    let venation = grown(&blade, &spec.veins, seed);
    assert_eq!(venation.check(blade.finished()), None, "{name} {kind}");
    if twice {
        assert_eq!(grown(&blade, &spec.veins, seed), venation, "{name} {kind}");
    }
}

/// With lobes and with teeth.
const WHOLE: [&str; 5] = ["maple", "birch", "oak", "ivy", "willow"];

#[test]
fn in_whole_leaves_with_lobes_and_teeth_guarantees_stay() {
    // Every other pair, so that each preset and each type is there; all are for --ignored.
    for (i, name) in WHOLE.into_iter().enumerate() {
        for (k, &kind) in GrowthType::ALL.iter().enumerate().filter(|(k, _)| (i + k) % 2 == 0) {
            keeps_its_guarantees(name, kind, (i + k) as u64, i == k);
        }
    }
}

#[test]
#[ignore = "takes minutes: run with --ignored"]
fn in_whole_leaves_of_every_growth_guarantees_stay() {
    for (i, name) in WHOLE.into_iter().enumerate() {
        for (k, &kind) in GrowthType::ALL.iter().enumerate() {
            keeps_its_guarantees(name, kind, (i + k) as u64, false);
        }
    }
}

#[test]
fn numbers_out_of_their_limits_name_the_key() {
    let blade = blade(GrowthType::Isotropic);
    let error = |change: &dyn Fn(&mut VeinSpec)| {
        let mut spec = VeinSpec::default();
        change(&mut spec);
        let grown = venation::veins::grow(&spec, &blade, Seed(1), &mut venation::observer::Silent);
        grown.expect_err("refused").to_string()
    };
    let refused = error(&|spec| spec.straightness = 1.5);
    assert!(refused.contains("veins.straightness = 1.5"), "{refused}");
    let refused = error(&|spec| spec.phases.coarseness = 0.5);
    assert!(refused.contains("veins.phases.coarseness = 0.5"), "{refused}");
    let refused = error(&|spec| spec.convergence.angle_deg = f64::NAN);
    assert!(refused.contains("veins.convergence.angle_deg"), "{refused}");
}

#[test]
fn growth_ends_whatever_is_asked_of_it() {
    let still = |total_steps| {
        let growth = GrowthSpec {
            r#type: GrowthType::None,
            total_steps,
            start_step: 0,
            ..GrowthSpec::default()
        };
        GrowingBlade::new(ellipse(), &growth)
    };
    // Opposed sources, and sources that nothing can reach: the end comes by itself.
    let blade = still(100_000).expect("a blade");
    for algorithm in [Algorithm::AuxinOpen, Algorithm::AuxinClosed] {
        let spec = VeinSpec {
            algorithm,
            sources_mm: vec![[20.0, 50.0], [-20.0, 50.0], [0.0, 30.0], [400.0, 3.0]],
            attraction_distance_mm: 12.0,
            straightness: 1.0,
            pull: 1.0,
            ..VeinSpec::default()
        };
        let venation = grown(&blade, &spec, 1);
        assert!(venation.nodes_after_step().len() < 2000, "it stands still early");
        assert!(venation.graph().len() < 2000);
        assert!(venation.unreached().outside == 1, "{:?}", venation.unreached());
        assert!(venation.unreached().total() >= 1, "{:?}", venation.unreached());
    }
    let millions = still(5_000_000).expect_err("too many").to_string();
    assert!(millions.contains("growth.total_steps = 5000000"), "{millions}");
}
