//! The vein pattern: the fast path against an obvious one, and what every pattern guarantees.

use glam::DVec2;
use proptest::prelude::*;
use venation::benchmark;
use venation::growth::{
    EvenGrowth, GrowingBlade, GrowthSpec, GrowthType, RateAxes, RatePattern, RateSpec,
};
use venation::margin::Margin;
use venation::observer::{Progress, Silent};
use venation::seed::{Rng, Seed, Stage};
use venation::veins::{self, Algorithm, VeinSpec, Venation, auxin};

use super::reference::{self, Frame};

/// An ellipse 100 mm long and 50 wide.
pub(crate) fn ellipse() -> Margin {
    let at = |i: usize| {
        let t = std::f64::consts::TAU * i as f64 / 64.0;
        DVec2::new(25.0 * t.sin(), 50.0 - 50.0 * t.cos())
    };
    let mut outline: Vec<DVec2> = (0..64).map(at).collect();
    outline[32].x = 0.0;
    Margin::new(outline, 32, Vec::new(), "").expect("an ellipse is a margin")
}

/// Lobes below the base, two deep sinuses and a cut: nearly nothing sees everything.
fn lobed() -> Margin {
    let right = [
        (6.0, -9.0),
        (16.0, -12.0),
        (26.0, -3.0),
        (30.0, 14.0),
        (20.0, 22.0),
        (7.0, 30.0),
        (9.0, 36.0),
        (24.0, 48.0),
        (26.0, 60.0),
        (16.0, 70.0),
        (6.0, 72.0),
        (8.0, 85.0),
    ];
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right.iter().map(|&p| DVec2::from(p)));
    outline.push(DVec2::new(0.0, 100.0));
    outline.extend(right.iter().rev().map(|&(x, y)| DVec2::new(-x * 0.93, y)));
    let cut = vec![DVec2::new(3.0, 50.0), DVec2::new(18.0, 56.0)];
    Margin::new(outline, 13, vec![cut], "").expect("a lobed margin")
}

/// Rates of any pattern, now and then with curves of their own.
fn rates(rng: &mut Rng) -> RateSpec {
    let pick = |rng: &mut Rng, n: usize| (rng.bits() % n as u64) as usize;
    let curve = |rng: &mut Rng| match pick(rng, 3) {
        0 => vec![[0.0, rng.between(0.2, 2.0)], [0.6, 1.0], [1.0, rng.between(0.2, 2.0)]],
        _ => Vec::new(),
    };
    RateSpec {
        pattern: RatePattern::ALL[pick(rng, RatePattern::ALL.len())],
        contrast: if rng.unit() < 0.2 { 1.0 } else { rng.between(0.0, 1.0) },
        front: rng.between(0.2, 1.5),
        axes: RateAxes::ALL[pick(rng, RateAxes::ALL.len())],
        even_growth: EvenGrowth::ALL[pick(rng, 2)],
        by_place: curve(rng),
        by_age: curve(rng),
    }
}

/// A small random case of one kind.
fn case(
    kind: GrowthType,
    concave: bool,
    reach: bool,
    given: bool,
    rng: &mut Rng,
) -> (GrowingBlade, VeinSpec) {
    let steps = 25 + rng.bits() % 50;
    let growth = GrowthSpec {
        r#type: kind,
        total_steps: steps,
        horizontal_steps: 10 + rng.bits() % 60,
        vertical_steps: steps,
        start_step: rng.bits() % 20,
        scale: if rng.unit() < 0.3 { rng.between(0.6, 1.0) } else { 1.0 },
        rates: if kind == GrowthType::NonUniform { rates(rng) } else { RateSpec::default() },
    };
    let margin = if concave { lobed() } else { ellipse() };
    let mut spec = VeinSpec {
        // Now and then more than fit into the lists that are searched one by one.
        spawn_rate: if rng.unit() < 0.2 { 60.0 } else { rng.between(0.5, 8.0) },
        source_spawn_distance_mm: rng.between(0.0, 8.0),
        vein_spawn_distance_mm: rng.between(0.0, 8.0),
        node_step_mm: rng.between(1.0, 4.0),
        attraction_distance_mm: if reach { rng.between(6.0, 30.0) } else { 0.0 },
        ..VeinSpec::default()
    };
    spec.kill_distance_mm = spec.node_step_mm * rng.between(0.5, 4.0);
    if rng.unit() < 0.4 {
        let some = |rng: &mut Rng, most: f64| (rng.unit() < 0.6).then(|| rng.between(0.1, most));
        spec.straightness = some(rng, 1.0).unwrap_or(0.0);
        spec.pull = some(rng, 1.5).unwrap_or(0.0);
        spec.symmetry = some(rng, 1.1).unwrap_or(0.0).min(1.0);
        spec.symmetry_jitter_mm = some(rng, 3.0).unwrap_or(0.0);
        spec.phases.coarseness = some(rng, 6.0).unwrap_or(1.0).max(1.0);
        spec.phases.settle_at = rng.between(0.2, 1.0);
    }
    if given {
        let bounds = margin.bounds();
        spec.sources_mm = (0..90)
            .map(|_| {
                let x = rng.between(bounds.min.x, bounds.max.x);
                [x, rng.between(bounds.min.y, bounds.max.y)]
            })
            .collect();
    }
    (GrowingBlade::new(margin, &growth).expect("a blade"), spec)
}

/// All kinds of cases, `each` of each.
pub(crate) fn for_all_cases(each: u64, mut test: impl FnMut(&str, &GrowingBlade, &VeinSpec, u64)) {
    for &kind in GrowthType::ALL {
        for bits in 0..8 {
            let (concave, reach, given) = (bits & 1 > 0, bits & 2 > 0, bits & 4 > 0);
            for seed in 0..each {
                let mut rng = Seed(seed * 8 + bits).stream(Stage::Tissue);
                let (blade, spec) = case(kind, concave, reach, given, &mut rng);
                let name = format!("{kind} concave={concave} reach={reach} given={given} {seed}");
                test(&name, &blade, &spec, seed);
            }
        }
    }
}

#[test]
fn the_fast_path_agrees_with_the_obvious_one_node_by_node() {
    let mut nodes = 0;
    for_all_cases(8, |name, blade, spec, seed| {
        let (root, darts) = (blade.root(), || Seed(seed).stream(Stage::AuxinSources));
        let slow = reference::grow(spec, blade, root, &mut darts(), Frame::Mature, usize::MAX);
        let mut bare = veins::VeinGraph::new();
        bare.add_root(root);
        let fast = auxin::grow(spec, blade, bare, &mut darts(), &mut Silent).expect(name);
        assert_eq!(fast.graph.len(), slow.positions.len(), "{name}");
        for (id, &p) in fast.graph.positions().iter().enumerate() {
            let parent = fast.graph.parent(id as u32).map(|parent| parent as usize);
            assert_eq!(parent, slow.parents[id], "{name}: node {id}");
            assert!(p.distance(slow.positions[id]) <= 1e-9 * 100.0, "{name}: node {id}");
        }
        let left = fast.unreached;
        assert_eq!(left.out_of_reach + left.hidden + left.unfinished, slow.alive, "{name}");
        nodes += fast.graph.len();
    });
    assert!(nodes > 15_000, "the cases have become too easy: {nodes} nodes");
}

#[test]
fn attraction_without_limit_agrees_with_the_obvious_one_over_many_tiles() {
    // Some hundred sources make a few blocks of tiles; the small cases fit into one.
    for (kind, algorithm) in [
        (GrowthType::None, Algorithm::AuxinOpen),
        (GrowthType::Anisotropic, Algorithm::AuxinOpen),
        (GrowthType::NonUniform, Algorithm::AuxinOpen),
    ] {
        let growth = GrowthSpec {
            r#type: kind,
            total_steps: 60,
            vertical_steps: 60,
            horizontal_steps: 40,
            start_step: 30,
            ..GrowthSpec::default()
        };
        let blade = GrowingBlade::new(ellipse(), &growth).expect("a blade");
        let mut rng = Seed(kind as u64).stream(Stage::Tissue);
        let place = |rng: &mut Rng| [rng.between(-25.0, 25.0), rng.between(0.0, 100.0)];
        let spec = VeinSpec {
            algorithm,
            sources_mm: (0..900).map(|_| place(&mut rng)).collect(),
            node_step_mm: 1.2,
            kill_distance_mm: 1.5,
            attraction_distance_mm: 0.0,
            ..VeinSpec::default()
        };
        let (root, darts) = (blade.root(), || Seed(1).stream(Stage::AuxinSources));
        let slow = reference::grow(&spec, &blade, root, &mut darts(), Frame::Mature, usize::MAX);
        let mut bare = veins::VeinGraph::new();
        bare.add_root(root);
        let fast = auxin::grow(&spec, &blade, bare, &mut darts(), &mut Silent).expect("grows");
        assert!(fast.graph.len() > 200, "{kind}: {} nodes", fast.graph.len());
        assert_eq!(fast.graph.len(), slow.positions.len(), "{kind} {algorithm}");
        for (id, &p) in fast.graph.positions().iter().enumerate() {
            let parent = fast.graph.parent(id as u32).map(|parent| parent as usize);
            assert_eq!(parent, slow.parents[id], "{kind} {algorithm}: node {id}");
            assert!(p.distance(slow.positions[id]) <= 1e-7, "{kind} {algorithm}: node {id}");
        }
    }
}

fn grown_on(
    threads: usize,
    spec: &VeinSpec,
    blade: &GrowingBlade,
    start: &veins::VeinGraph,
) -> auxin::Grown {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let mut rng = Seed(1).stream(Stage::AuxinSources);
    pool.install(|| auxin::grow(spec, blade, start.clone(), &mut rng, &mut Silent)).expect("grows")
}

#[test]
fn threads_show_nowhere_in_large_steps() {
    let growth = GrowthSpec {
        r#type: GrowthType::None,
        total_steps: 1000,
        start_step: 0,
        ..GrowthSpec::default()
    };
    for algorithm in [Algorithm::AuxinOpen, Algorithm::AuxinClosed] {
        let mut workload = benchmark::standard_workload(6000, Seed(5));
        workload.veins.algorithm = algorithm;
        // On the lobed margin sources do not see all their neighbours.
        for margin in [workload.margin, lobed()] {
            let blade = GrowingBlade::new(margin, &growth).expect("a blade");
            // Many roots make steps large enough to be shared out.
            let mut start = veins::VeinGraph::new();
            for i in 0..400 {
                let (x, y) = (f64::from(i % 10) - 4.5, f64::from(i / 10) - 19.5);
                let root = DVec2::new(2.5 * x, 50.0 + 1.5 * y);
                if blade.covers(root) {
                    start.add_root(root);
                }
            }
            let grow = |threads| grown_on(threads, &workload.veins, &blade, &start);
            let alone = grow(1);
            let widest = alone.nodes_after_step.windows(2).map(|w| w[1] - w[0]).max();
            assert!(widest > Some(300), "steps have become too small: {widest:?}");
            for threads in [2, 5] {
                assert!(grow(threads) == alone, "{algorithm} on {threads} threads");
            }
        }
    }
}

#[test]
fn threads_show_nowhere_while_proportions_change() {
    for kind in [GrowthType::Anisotropic, GrowthType::NonUniform, GrowthType::Marginal] {
        let growth = GrowthSpec {
            r#type: kind,
            total_steps: 80,
            vertical_steps: 80,
            horizontal_steps: 60,
            start_step: 40,
            ..GrowthSpec::default()
        };
        let blade = GrowingBlade::new(lobed(), &growth).expect("a blade");
        let mut start = veins::VeinGraph::new();
        for i in 0..300 {
            let root = DVec2::new(1.5 * f64::from(i % 20) - 14.0, 2.0 + 5.0 * f64::from(i / 20));
            if blade.covers(root) {
                start.add_root(root);
            }
        }
        for algorithm in [Algorithm::AuxinOpen, Algorithm::AuxinClosed] {
            let spec = VeinSpec {
                algorithm,
                spawn_rate: 300.0,
                source_spawn_distance_mm: 0.4,
                vein_spawn_distance_mm: 0.3,
                kill_distance_mm: 0.25,
                node_step_mm: 0.2,
                attraction_distance_mm: 3.0,
                ..VeinSpec::default()
            };
            let alone = grown_on(1, &spec, &blade, &start);
            assert!(alone.sources > 3000, "{kind}: {} sources are too few", alone.sources);
            for threads in [2, 3] {
                assert!(grown_on(threads, &spec, &blade, &start) == alone, "{kind} {algorithm}");
            }
        }
    }
}

#[test]
fn threads_show_nowhere_in_a_blade_too_narrow_to_be_shared_out() {
    let right = [(0.75, 1.0), (0.75, 150.0), (0.75, 299.0)].map(DVec2::from);
    let left = [(-0.75, 299.0), (-0.75, 150.0), (-0.75, 1.0)].map(DVec2::from);
    let ends = [DVec2::ZERO, DVec2::new(0.0, 300.0)];
    let outline = [&ends[..1], &right[..], &ends[1..], &left[..]].concat();
    let margin = Margin::new(outline, 4, Vec::new(), "").expect("a strip");
    let spec = VeinSpec {
        algorithm: Algorithm::AuxinClosed,
        spawn_rate: 4000.0,
        source_spawn_distance_mm: 0.15,
        vein_spawn_distance_mm: 0.15,
        kill_distance_mm: 0.1,
        node_step_mm: 0.05,
        attraction_distance_mm: 1.0,
        ..VeinSpec::default()
    };
    let growth = GrowthSpec {
        r#type: GrowthType::Isotropic,
        total_steps: 60,
        start_step: 20,
        ..GrowthSpec::default()
    };
    let blade = GrowingBlade::new(margin, &growth).expect("a blade");
    let mut start = veins::VeinGraph::new();
    for i in 1..600 {
        start.add_root(DVec2::new(0.0, 0.5 * f64::from(i)));
    }
    let grow = |threads| grown_on(threads, &spec, &blade, &start);
    let alone = grow(1);
    assert!(alone.sources > 2000, "{} sources are too few to be shared out", alone.sources);
    assert!(grow(2) == alone && grow(3) == alone);
}

#[test]
fn non_uniform_growth_at_even_rates_agrees_with_the_plain_types_node_by_node() {
    type Change = fn(&mut RateSpec);
    let pairs: [(GrowthType, Change); 4] = [
        (GrowthType::Isotropic, |rates| rates.contrast = 0.0),
        (GrowthType::Anisotropic, |rates| {
            (rates.contrast, rates.even_growth) = (0.0, EvenGrowth::Anisotropic);
        }),
        (GrowthType::Marginal, |rates| {
            (rates.pattern, rates.contrast) = (RatePattern::MarginLed, 1.0);
        }),
        (GrowthType::None, |rates| {
            (rates.pattern, rates.by_age) = (RatePattern::Even, vec![[0.0, 0.0]]);
        }),
    ];
    for (kind, change) in pairs {
        for (seed, margin) in [ellipse(), lobed()].into_iter().enumerate() {
            for algorithm in [Algorithm::AuxinOpen, Algorithm::AuxinClosed] {
                let plain = GrowthSpec { r#type: kind, total_steps: 120, ..GrowthSpec::default() };
                let plain = GrowthSpec { start_step: 40, vertical_steps: 120, ..plain };
                let plain = GrowthSpec { horizontal_steps: 80, ..plain };
                let mut uneven = plain.clone();
                uneven.r#type = GrowthType::NonUniform;
                change(&mut uneven.rates);
                let grow = |growth: &GrowthSpec| {
                    let blade = GrowingBlade::new(margin.clone(), growth).expect("a blade");
                    let spec = VeinSpec { algorithm, ..VeinSpec::default() };
                    grown(&blade, &spec, seed as u64)
                };
                let (plain, uneven) = (grow(&plain), grow(&uneven));
                assert!(plain.graph().len() > 500, "{kind}");
                assert_eq!(plain.graph(), uneven.graph(), "{kind} {algorithm}");
                assert_eq!(plain.unreached(), uneven.unreached(), "{kind} {algorithm}");
            }
        }
    }
}

#[test]
fn distances_that_shrink_agree_with_a_leaf_that_grows() {
    // Rounding differs, and growth is chaotic: over a few steps it must not show.
    for_all_cases(2, |name, blade, spec, seed| {
        let (root, darts) = (blade.root(), || Seed(seed).stream(Stage::AuxinSources));
        let grow = |frame| reference::grow(spec, blade, root, &mut darts(), frame, 20);
        let (mature, literal) = (grow(Frame::Mature), grow(Frame::Literal));
        assert_eq!(mature.parents, literal.parents, "{name}");
        let last = blade.steps().nth(19).unwrap_or(blade.last_step());
        for (&p, &q) in mature.positions.iter().zip(&literal.positions) {
            let grown = blade.carry(q, last, blade.last_step());
            assert!(grown.distance(blade.finished_from_mature(p)) < 1e-6, "{name}: {p} {q}");
        }
    });
}

pub(crate) fn grown(blade: &GrowingBlade, spec: &VeinSpec, seed: u64) -> Venation {
    veins::grow(spec, blade, Seed(seed), &mut Silent).expect("veins")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_pattern_keeps_its_guarantees(
        seed in 0u64..1_000_000, kind in 0..GrowthType::ALL.len(), concave: bool, reach: bool, given: bool,
    ) {
        let mut rng = Seed(seed).stream(Stage::Tissue);
        let (blade, spec) = case(GrowthType::ALL[kind], concave, reach, given, &mut rng);
        let venation = grown(&blade, &spec, seed);
        prop_assert_eq!(venation.check(blade.finished()), None);
        let graph = venation.graph();
        prop_assert!(graph.joins().is_empty(), "open veins never meet");
        let roots = (0..graph.len() as u32).filter(|&node| graph.parent(node).is_none());
        prop_assert_eq!(roots.collect::<Vec<_>>(), vec![0]);
        prop_assert!(graph.positions()[0].length() < 1e-3);
        prop_assert_eq!(&grown(&blade, &spec, seed), &venation);
    }
}

#[test]
fn veins_of_a_convex_blade_reach_every_source_in_time() {
    let blade = GrowingBlade::new(
        ellipse(),
        &GrowthSpec {
            r#type: GrowthType::None,
            total_steps: 600,
            start_step: 0,
            ..GrowthSpec::default()
        },
    )
    .expect("a blade");
    let venation = grown(&blade, &VeinSpec::default(), 3);
    assert_eq!(venation.unreached().total(), 0);
    assert!(venation.sources() > 1000);
    assert_eq!(venation.orders()[0], 1);
}

#[test]
fn progress_comes_about_every_hundredth_and_ends_at_the_end() {
    let blade = GrowingBlade::new(ellipse(), &GrowthSpec::default()).expect("a blade");
    let mut heard: Vec<Progress> = Vec::new();
    let mut listen = |progress: Progress| heard.push(progress);
    veins::grow(&VeinSpec::default(), &blade, Seed(3), &mut listen).expect("veins");
    let grown = heard.iter().take_while(|progress| progress.stage == heard[0].stage).count();
    assert!((90..=210).contains(&grown), "{grown}");
    let last = &heard[grown - 1];
    assert_eq!((last.step, last.steps), (301, 301));
    // What follows growth has a bar of its own.
    let refined = heard.last().expect("reports");
    assert_ne!(refined.stage, last.stage);
    assert_eq!((refined.step, refined.steps), (3, 3));
}

#[test]
fn impossible_settings_are_errors_that_name_the_key() {
    let blade = GrowingBlade::new(ellipse(), &GrowthSpec::default()).expect("a blade");
    let error = |change: &dyn Fn(&mut VeinSpec)| {
        let mut spec = VeinSpec::default();
        change(&mut spec);
        veins::grow(&spec, &blade, Seed(1), &mut Silent).expect_err("refused").to_string()
    };
    let small = error(&|spec| spec.kill_distance_mm = 0.1);
    assert!(small.contains("veins.kill_distance_mm = 0.1") && small.contains("0.15"), "{small}");
    let many = error(&|spec| spec.spawn_rate = 100_000.0);
    assert!(many.contains("veins.spawn_rate"), "{many}");
    let nan = error(&|spec| spec.sources_mm = vec![[1.0, 50.0], [f64::NAN, 2.0]]);
    assert!(nan.contains("veins.sources_mm"), "{nan}");
    let thin = error(&|spec| spec.tip_radius_mm = 0.0);
    assert!(thin.contains("veins.tip_radius_mm"), "{thin}");
}
