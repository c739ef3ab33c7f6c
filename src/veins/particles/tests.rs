use super::*;
use crate::geometry::polygon::{self, segments_near};
use crate::observer::Silent;
use crate::parameter::Parameters;
use crate::seed::{Seed, Stage};
use crate::veins::graph::VeinGraph;
use crate::veins::planar::CLEARANCE_MM;
use crate::veins::widths;

/// Five lobes like an ivy's, the basal ones below the petiole, with the area that gives the paper
/// its counts (px²).
fn ivy() -> Margin {
    let right = [
        (6., -6.),
        (20., -22.),
        (45., -30.),
        (52., -8.),
        (50., 8.),
        (70., 12.),
        (98., 30.),
        (80., 50.),
        (54., 66.),
        (40., 84.),
        (30., 110.),
    ];
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right.iter().map(|&p| DVec2::from(p)));
    outline.push(DVec2::new(0.0, 150.0));
    outline.extend(right.iter().rev().map(|&(x, y)| DVec2::new(-x, y)));
    let scale = (12_450.0 / polygon::signed_area(&outline)).sqrt();
    outline.iter_mut().for_each(|p| *p *= scale);
    Margin::new(outline, 12, Vec::new(), "").expect("an ivy")
}

/// Nearly nothing sees the petiole, and a cut is in the way.
fn maze() -> Margin {
    let outline = [
        (0., 0.),
        (12., 1.),
        (30., -20.),
        (34., 4.),
        (14., 10.),
        (6., 30.),
        (30., 34.),
        (12., 40.),
        (14., 44.),
        (34., 50.),
        (28., 12.),
        (40., 12.),
        (40., 60.),
        (0., 80.),
        (-20., 60.),
        (-36., 62.),
        (-38., 20.),
        (-30., 20.),
        (-28., 50.),
        (-14., 48.),
        (-10., 12.),
        (-20., 4.),
        (-4., 3.),
    ];
    let cut = [(1., 60.), (3., 30.)].map(DVec2::from).to_vec();
    Margin::new(outline.map(DVec2::from).to_vec(), 13, vec![cut], "").expect("a maze")
}

fn ellipse() -> Margin {
    let at = |i: usize| {
        let t = std::f64::consts::TAU * i as f64 / 64.0;
        DVec2::new(25.0 * t.sin(), 50.0 - 50.0 * t.cos())
    };
    let mut outline: Vec<DVec2> = (0..64).map(at).collect();
    outline[32].x = 0.0;
    Margin::new(outline, 32, Vec::new(), "").expect("an ellipse")
}

/// The paper's settings, in its pixels.
fn paper(pattern: Pattern, spacing: f64) -> ParticleSpec {
    let spec = ParticleSpec { pattern, spacing_mm: spacing, ..ParticleSpec::default() };
    ParticleSpec { step_mm: 1.0, merge_radius_mm: 2.0, ..spec }
}

const ROOT: DVec2 = DVec2::new(0.0, 1.5);

fn run(spec: &ParticleSpec, margin: &Margin) -> Flowed {
    let mut rng = Seed(3).stream(Stage::Particles);
    grow(spec, margin, &[ROOT], &mut rng, &mut Silent).expect("flows")
}

/// Positions and parents, the obvious way: every particle looks at every other, and every merge
/// looks at every pair.
fn obvious(spec: &ParticleSpec, margin: &Margin, starts: &[DVec2]) -> Flowed {
    let steer = match spec.steering {
        Steering::Inside => Steer::inside(margin, &[ROOT]),
        Steering::Plain => Steer::plain(margin, &[ROOT]),
    };
    let reach = spec.merge_radius_mm.max(spec.step_mm);
    let mut trails = Trails::new(&[ROOT], spec.step_mm);
    let mut all: Vec<Option<(DVec2, f64, Ends, bool)>> =
        starts.iter().map(|&p| trails.begin(p).map(|ends| (p, 1.0, ends, false))).collect();
    let mut steps = 0;
    loop {
        for entry in &mut all {
            if let Some((p, _, ends, lost)) = *entry
                && steer.arrived(p, reach, lost).is_some()
            {
                trails.arrive(ends, 0);
                *entry = None;
            }
        }
        if steps > 0 {
            for (p, _, ends, _) in all.iter_mut().flatten() {
                trails.lay(ends, *p);
            }
        }
        if all.iter().all(Option::is_none) {
            let edges = SegmentIndex::of_polygon(margin.outline());
            return Flowed {
                graph: trails.into_graph(&edges, |a, b| steer.sees(a, b)),
                particles: starts.len(),
                steps,
            };
        }
        steps += 1;
        let before: Vec<Option<DVec2>> = all.iter().map(|e| e.map(|e| e.0)).collect();
        let attracted = spec.algorithm == Motion::Attracted;
        for (i, entry) in all.iter_mut().enumerate() {
            let Some((p, _, _, lost)) = entry else { continue };
            let others =
                (0..before.len()).filter(|&j| j != i && attracted).filter_map(|j| before[j]);
            let nearest = others
                .reduce(|a, b| {
                    let far = |q: DVec2| (p.distance_squared(q), ROOT.distance_squared(q));
                    if far(b) < far(a) { b } else { a }
                })
                .filter(|&other| *lost || steer.sees(*p, other));
            *p = steer.step(*p, nearest, spec.step_mm, lost);
        }
        loop {
            let mut closest: Option<(f64, usize, usize)> = None;
            let merging = if attracted { all.len() } else { 0 };
            for i in 0..merging {
                for j in i + 1..all.len() {
                    let (Some(a), Some(b)) = (all[i], all[j]) else { continue };
                    let found = (a.0.distance_squared(b.0), i, j);
                    if found.0 < spec.merge_radius_mm.powi(2)
                        && closest.is_none_or(|c| found < c)
                        && steer.sees(a.0, b.0)
                    {
                        closest = Some(found);
                    }
                }
            }
            let Some((_, i, j)) = closest else { break };
            let (a, b) = (all[i].expect("there"), all[j].take().expect("there"));
            let mean = (a.0 * a.1 + b.0 * b.1) / (a.1 + b.1);
            all[i] = Some((mean, a.1 + b.1, trails.meet(a.2, b.2), a.3 && b.3));
        }
    }
}

#[test]
fn the_grid_and_the_obvious_way_agree_node_by_node() {
    let mut rng = Seed(11).stream(Stage::Particles);
    for margin in [ivy(), maze(), ellipse()] {
        for &pattern in Pattern::ALL {
            for (motion, steering, step, radius) in [
                (Motion::Attracted, Steering::Inside, 1.0, 2.0),
                (Motion::Attracted, Steering::Plain, 0.7, 6.0),
                (Motion::Attracted, Steering::Inside, 2.5, 0.5),
                (Motion::Direct, Steering::Inside, 1.0, 2.0),
            ] {
                let spec = ParticleSpec {
                    algorithm: motion,
                    steering,
                    count: 70,
                    step_mm: step,
                    merge_radius_mm: radius,
                    ..paper(pattern, 1.0)
                };
                let starts = patterns::starts(&spec, &margin, &mut rng).expect("starts");
                let quick = flow(&spec, &margin, &[ROOT], &starts, &mut Silent).expect("flows");
                assert_eq!(quick, obvious(&spec, &margin, &starts), "{spec:?}");
            }
        }
    }
}

#[test]
fn the_paper_s_counts_come_from_its_spacings() {
    let margin = ivy();
    for &pattern in Pattern::ALL {
        for (spacing, paper_s, tolerance) in
            [(3.0, 1378, 0.02), (5.0, 500, 0.03), (7.0, 254, 0.04), (10.0, 125, 0.06)]
        {
            let mut rng = Seed(1).stream(Stage::Particles);
            let starts = patterns::starts(&paper(pattern, spacing), &margin, &mut rng);
            let off = starts.expect("starts").len() as f64 / f64::from(paper_s) - 1.0;
            assert!(off.abs() <= tolerance, "{pattern} {spacing}: {off:.3} off {paper_s}");
            // The other way round: the count given, the spacing found.
            let spec = ParticleSpec { count: paper_s as u64, ..paper(pattern, 1.0) };
            let count = patterns::starts(&spec, &margin, &mut rng).expect("starts").len();
            let slack = if pattern == Pattern::Jitter { 12 } else { paper_s as usize / 200 + 1 };
            assert!(count.abs_diff(paper_s as usize) <= slack, "{pattern}: {count} for {paper_s}");
        }
    }
}

#[test]
fn patterns_have_the_geometry_of_the_figure() {
    let margin = ivy();
    let starts = |pattern| {
        let mut rng = Seed(1).stream(Stage::Particles);
        let starts = patterns::starts(&paper(pattern, 8.0), &margin, &mut rng).expect("starts");
        assert!(starts.iter().all(|&p| polygon::contains(margin.outline(), p)));
        starts
    };
    let nearest = |points: &[DVec2], i: usize| {
        let others = (0..points.len()).filter(|&j| j != i);
        others.map(|j| points[i].distance(points[j])).fold(f64::INFINITY, f64::min)
    };
    let offset = |p: DVec2| (p.x / 8.0).rem_euclid(1.0);
    let square = starts(Pattern::Square);
    assert!(square.iter().all(|&p| offset(p) == 0.0));
    assert!((0..square.len()).all(|i| nearest(&square, i) == 8.0));
    // Mirrored, as the leaf is.
    assert!(square.iter().all(|p| square.contains(&DVec2::new(-p.x, p.y))));
    let hexagonal = starts(Pattern::Hexagonal);
    let shifted = hexagonal.iter().filter(|&&p| offset(p) == 0.5).count();
    let straight = hexagonal.iter().filter(|&&p| offset(p) == 0.0).count();
    assert_eq!(shifted + straight, hexagonal.len());
    assert!(shifted.abs_diff(straight) < hexagonal.len() / 8);
    // One particle in each square of the lattice.
    let jitter = starts(Pattern::Jitter);
    let mut squares: Vec<[i64; 2]> =
        (jitter.iter()).map(|p| [(p.x / 8.0).round() as i64, (p.y / 8.0).floor() as i64]).collect();
    squares.sort_unstable();
    assert!(squares.windows(2).all(|pair| pair[0] != pair[1]));
    assert!(starts(Pattern::Random).len() == (margin.area_mm2() / 64.0).round() as usize);
}

#[test]
fn a_lone_particle_walks_straight_to_the_petiole() {
    let spec = paper(Pattern::Square, 1.0);
    let start = DVec2::new(9.0, 70.0);
    let flowed = flow(&spec, &ivy(), &[ROOT], &[start], &mut Silent).expect("flows");
    let positions = flowed.graph.positions();
    assert_eq!(flowed.graph.child_counts().iter().max(), Some(&1));
    assert_eq!(positions.last(), Some(&start));
    let expected = (start.distance(ROOT) - 2.0).ceil();
    assert_eq!(flowed.steps as f64, expected);
    for p in positions {
        assert!((*p - ROOT).perp_dot(start - ROOT).abs() < 1e-9 * start.length_squared());
    }
}

#[test]
fn two_particles_meet_halfway_and_go_on_together() {
    let spec = paper(Pattern::Square, 1.0);
    let pair = [DVec2::new(-5.0, 60.0), DVec2::new(5.0, 60.0)];
    let flowed = flow(&spec, &ellipse(), &[ROOT], &pair, &mut Silent).expect("flows");
    let counts = flowed.graph.child_counts();
    assert_eq!(counts.iter().filter(|&&count| count == 2).count(), 1);
    let fork = counts.iter().position(|&count| count == 2).expect("a fork");
    let place = flowed.graph.positions()[fork];
    assert!(place.x.abs() < 1e-9 && (50.0..58.0).contains(&place.y), "{place}");
}

#[test]
fn every_tip_is_a_start_and_the_petiole_is_as_wide_as_the_cube_root_of_all() {
    for margin in [ivy(), maze(), ellipse()] {
        for &pattern in Pattern::ALL {
            for motion in [Motion::Direct, Motion::Attracted] {
                let spec = ParticleSpec { algorithm: motion, ..paper(pattern, 4.0) };
                let flowed = run(&spec, &margin);
                let graph = &flowed.graph;
                assert_eq!(graph.check(), None);
                let tips = graph.child_counts().iter().filter(|&&count| count == 0).count();
                assert_eq!(tips, flowed.particles);
                let radii = widths::murray(graph, 0.5, 3.0);
                assert_eq!(radii[0], 0.5 * libm::cbrt(flowed.particles as f64));
                let inside = |p: &&DVec2| polygon::contains(margin.outline(), **p);
                assert!(graph.positions().iter().all(|p| inside(&p)));
                assert_eq!(run(&spec, &margin), flowed);
            }
        }
    }
}

#[test]
fn no_vein_crosses_the_margin_or_a_cut_when_steered_inside() {
    let mut plain = 0;
    for margin in [ivy(), maze()] {
        let lines = |line: &Vec<DVec2>| line.windows(2).map(|w| (w[0], w[1])).collect::<Vec<_>>();
        let walls = SegmentIndex::new(
            polygon::edges(margin.outline()).chain(margin.cuts().iter().flat_map(lines)).collect(),
        );
        let crossings = |steering| {
            let graph =
                run(&ParticleSpec { steering, ..paper(Pattern::Random, 2.0) }, &margin).graph;
            let at = |id: u32| graph.positions()[id as usize];
            graph.edges().filter(|&(a, b)| walls.touches(at(a), at(b))).count()
        };
        assert_eq!(crossings(Steering::Inside), 0);
        plain += crossings(Steering::Plain);
    }
    assert!(plain > 0);
}

/// How many pairs of edges without a place in common touch or all but touch.
pub(super) fn crossings(graph: &VeinGraph) -> usize {
    let at = |id: u32| graph.positions()[id as usize];
    let left = |&(a, b): &(u32, u32)| at(a).x.min(at(b).x);
    let mut edges: Vec<(u32, u32)> = graph.edges().collect();
    edges.sort_by(|one, other| left(one).total_cmp(&left(other)));
    let crossed = |(i, &(a, b)): (usize, &(u32, u32))| {
        let right = at(a).x.max(at(b).x);
        let beside = edges[i + 1..].iter().take_while(|other| left(other) <= right);
        let meets = |&&(c, d): &&(u32, u32)| {
            ![c, d].contains(&a)
                && ![c, d].contains(&b)
                && segments_near(at(a), at(b), at(c), at(d), CLEARANCE_MM)
        };
        beside.filter(meets).count()
    };
    edges.iter().enumerate().map(crossed).sum()
}

#[test]
fn trails_cross_nowhere_and_hardly_turn_back() {
    let (mut turns, mut sharp) = (0, 0);
    for margin in [ivy(), maze(), ellipse()] {
        for &pattern in Pattern::ALL {
            for (motion, spacing) in [(Motion::Direct, 8.0), (Motion::Attracted, 4.0)] {
                let spec = ParticleSpec { algorithm: motion, ..paper(pattern, spacing) };
                let graph = run(&spec, &margin).graph;
                assert_eq!(crossings(&graph), 0, "{pattern} {motion}");
                let at = |id: u32| graph.positions()[id as usize];
                for (here, before) in graph.edges() {
                    if let Some(next) = graph.parent(here) {
                        let (to, on) = (at(here) - at(before), at(next) - at(here));
                        turns += 1;
                        sharp += usize::from(to.angle_to(on).abs().to_degrees() > 120.0);
                    }
                }
            }
        }
    }
    assert!(turns > 50_000 && sharp * 500 < turns, "{sharp} of {turns}");
}

#[test]
fn settings_that_make_no_sense_are_refused_with_their_key() {
    let refused = |spec: &ParticleSpec| {
        let mut rng = Seed(3).stream(Stage::Particles);
        let error = grow(spec, &ivy(), &[ROOT], &mut rng, &mut Silent).expect_err("refused");
        error.to_string()
    };
    let spec = paper(Pattern::Square, 3.0);
    let message = refused(&ParticleSpec { spacing_mm: 0.01, ..spec.clone() });
    assert!(message.starts_with("veins.particles.spacing_mm = 0.01 scatters"), "{message}");
    let message = refused(&ParticleSpec { step_mm: 0.001, ..spec.clone() });
    assert!(message.starts_with("veins.particles.step_mm = 0.001"), "{message}");
    let message = refused(&ParticleSpec { spacing_mm: 900.0, ..spec.clone() });
    assert!(message.contains("no particle inside"), "{message}");
    let spec = ParticleSpec { merge_radius_mm: -1.0, ..spec };
    let outside = spec.outside_limits().expect("a radius below its limit");
    assert_eq!((outside.key.as_str(), outside.value), ("merge_radius_mm", -1.0));
}
