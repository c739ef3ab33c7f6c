use super::shorthand::{LobeRow, LobingSpec};
use super::*;
use crate::geometry::deviation;
use crate::margin::{Margin, MarginKind, MarginSpec, entire};
use crate::seed::{Rng, Seed, Stage};

fn lobed(lobing: LobingSpec) -> MarginSpec {
    MarginSpec { kind: MarginKind::Lobed, lobing, ..MarginSpec::default() }
}

fn palmate(count: u64) -> LobingSpec {
    LobingSpec { count, ..LobingSpec::default() }
}

fn pinnate(count: u64) -> LobingSpec {
    let row = LobeRow {
        first_spacing: 0.12,
        spacing_change: 0.01,
        first_angle_deg: 65.0,
        last_angle_deg: 45.0,
        first_length: 0.35,
        last_length: 0.3,
    };
    LobingSpec { count, right: row.clone(), left: row, ..LobingSpec::default() }
}

fn tips(margin: &Margin) -> Vec<DVec2> {
    let tip = |mark: &&Landmark| matches!(mark.kind, LandmarkKind::LobeTip { .. });
    margin.landmarks().iter().filter(tip).map(|mark| margin.outline()[mark.vertex]).collect()
}

fn valleys(margin: &Margin) -> Vec<DVec2> {
    let valley = |mark: &&Landmark| mark.kind == LandmarkKind::Valley;
    margin.landmarks().iter().filter(valley).map(|mark| margin.outline()[mark.vertex]).collect()
}

#[test]
fn origins_follow_equation_6_4_and_grow_by_6_2_and_6_3() {
    let row = LobeRow { first_spacing: 0.11, spacing_change: 0.023, ..LobeRow::default() };
    let mut r = 0.0;
    for i in 1..=5_u32 {
        r += 0.11 + f64::from(i - 1) * 0.023;
        assert!((row.origin(u64::from(i)) - r).abs() < 1e-15);
    }
}

#[test]
fn the_change_of_spacing_is_bounded_on_both_sides() {
    // n = 4, s₀ = 0.1: −0.1/3 ≤ Δs < 2 (1 − 0.4) / 12 = 0.1.
    let with = |side: &str, spacing_change: f64| {
        let row = LobeRow { first_spacing: 0.1, ..pinnate(9).right };
        let changed = LobeRow { spacing_change, ..row.clone() };
        let (right, left) = if side == "left" { (row, changed) } else { (changed, row) };
        LobingSpec { right, left, ..pinnate(9) }.records()
    };
    for side in ["left", "right"] {
        for fine in [-0.1 / 3.0, 0.0, 0.0999] {
            with(side, fine).unwrap();
        }
        let over = with(side, 0.1).unwrap_err().to_string();
        assert!(over.contains(&format!("margin.lobing.{side}.spacing_change = 0.1 ")), "{over}");
        assert!(over.contains("less than 0.1000"), "{over}");
        let under = with(side, -0.034).unwrap_err().to_string();
        assert!(under.contains("-0.0333 or more"), "{under}");
    }
    // One lobe a side has no Δs: the first values count.
    let records = LobingSpec { count: 3, ..palmate(3) }.records().unwrap();
    assert_eq!((records[0].angle_deg, records[0].length), (95.0, 0.6));
}

#[test]
fn twenty_six_numbers_expand_to_the_record_of_every_lobe() {
    let records = pinnate(9).records().unwrap();
    assert_eq!(records.len(), 5, "four pairs and the apex");
    for (i, record) in records[..4].iter().enumerate() {
        let i = i as f64;
        assert!((record.angle_deg - (65.0 - i * 20.0 / 3.0)).abs() < 1e-12);
        assert!((record.length - (0.35 - i * 0.05 / 3.0)).abs() < 1e-12);
    }
    let spec = MarginSpec { lobe: records, ..lobed(LobingSpec::default()) };
    assert_eq!(entire(&spec).unwrap(), entire(&lobed(pinnate(9))).unwrap());
}

#[test]
fn every_lobe_has_its_tip_and_every_pair_a_valley() {
    for (lobing, notched) in [
        (palmate(3), false),
        (palmate(5), false),
        (palmate(7), false),
        (pinnate(9), false),
        (pinnate(10), true),
        (palmate(2), true),
    ] {
        let count = lobing.count as usize;
        let margin = entire(&lobed(lobing.clone())).unwrap();
        assert_eq!(margin.check(), None, "{count}");
        assert_eq!(tips(&margin).len(), count, "{count}");
        assert_eq!(valleys(&margin).len(), count - 1, "{count}");
        let at_apex = margin.landmarks().iter().find(|m| m.vertex == margin.apex_index()).unwrap();
        assert_eq!(at_apex.kind == LandmarkKind::Valley, notched);
        for record in lobing.records().unwrap() {
            if record.side == LobeSide::Apex {
                continue;
            }
            // Equation 6.9.
            let angle = record.angle_deg.to_radians();
            let e = DVec2::new(angle.sin(), angle.cos()) * record.length;
            let e = (e + DVec2::new(0.0, record.origin)) * 80.0;
            assert!(tips(&margin).iter().any(|tip| tip.distance(e) < 1e-9), "{e}");
        }
    }
}

#[test]
fn a_set_valley_lies_where_equation_6_10_puts_it_with_its_tangents() {
    let slim = HalfLobe { waist_x: 0.14, ..HalfLobe::default() };
    let lobing = LobingSpec {
        lower: slim.clone(),
        upper: slim,
        valley: ValleyKind::Set,
        valley_distance: 0.4,
        valley_angle_deg: 20.0,
        valley_lower_deg: 70.0,
        valley_upper_deg: 30.0,
        ..pinnate(9)
    };
    let records = lobing.records().unwrap();
    let margin = entire(&lobed(lobing)).unwrap();
    for (i, record) in records[..4].iter().enumerate() {
        let (angle, turn) = (record.angle_deg.to_radians(), 20.0_f64.to_radians());
        let vein = DVec2::new(angle.sin(), angle.cos()) * record.length;
        // Anticlockwise, as the matrix of 6.10 turns.
        let way = DVec2::from_angle(turn).rotate(vein);
        let h = (DVec2::new(0.0, record.origin) + 0.4 * way) * 80.0;
        let found = margin.landmarks().iter().filter(|mark| mark.kind == LandmarkKind::Valley);
        let vertex = found.map(|mark| mark.vertex).nth(i).unwrap();
        let outline = margin.outline();
        assert!(outline[vertex].distance(h) < 1e-9, "{i}");
        // The margin comes down on this lobe's side and goes up on the next one's.
        let down = direction([0, 1, 2].map(|k| outline[vertex - k]));
        let up = direction([0, 1, 2].map(|k| outline[vertex + k]));
        let way = way.normalize();
        let lower = DVec2::from_angle(-70.0_f64.to_radians()).rotate(way);
        let upper = DVec2::from_angle(30.0_f64.to_radians()).rotate(way);
        assert!(down.distance(lower) < 1e-6, "{i}: {down} {lower}");
        assert!(up.distance(upper) < 1e-6, "{i}: {up} {upper}");
    }
}

#[test]
fn a_set_valley_that_lobes_cover_lies_on_both_of_them_where_they_meet() {
    let wide = HalfLobe { waist_x: 0.26, waist_y: 0.6, ..HalfLobe::default() };
    let mut deep = palmate(5);
    (deep.lower, deep.upper, deep.valley) = (wide.clone(), wide, ValleyKind::Set);
    (deep.valley_distance, deep.valley_lower_deg, deep.valley_upper_deg) = (0.3, 20.0, 20.0);
    let records = deep.records().unwrap();
    let margin = entire(&lobed(deep)).unwrap();
    assert_eq!(margin.check(), None);
    for (i, found) in valleys(&margin)[..2].iter().enumerate() {
        let (lobe, next) = (Lobe::new(&records[i]), Lobe::new(&records[i + 1]));
        let (down, up) = lobe.valley.unwrap();
        let set = down.at;
        assert!(found.distance(set * 80.0) > 4.0, "{found} is farther out than {set}");
        for (lobe, half, start) in [(&lobe, lobe.upper, down), (&next, next.lower, up)] {
            let mut waypoints = Vec::new();
            lobe.waypoints(&mut waypoints, half, start);
            let spline = curve::spline(&waypoints, lobe.tension);
            let near = (0..=20_000).map(|i| spline.at(f64::from(i) / 20_000.0));
            let off = near.map(|p| p.distance(*found / 80.0)).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-4, "{i}: {off}");
        }
    }
}

#[test]
fn default_valleys_lie_on_both_lobes() {
    let records = palmate(5).records().unwrap();
    let whole = |i: usize, half: fn(&Lobe) -> Half| {
        let lobe = Lobe::new(&records[i]);
        let mut waypoints = Vec::new();
        lobe.waypoints(&mut waypoints, half(&lobe), lobe.leaving(half(&lobe), lobe.origin));
        curve::spline(&waypoints, lobe.tension)
    };
    let margin = entire(&lobed(palmate(5))).unwrap();
    let valley = valleys(&margin)[0] / 80.0;
    for spline in [whole(0, |lobe| lobe.upper), whole(1, |lobe| lobe.lower)] {
        let near = (0..=20_000).map(|i| spline.at(f64::from(i) / 20_000.0).distance(valley));
        assert!(near.fold(f64::INFINITY, f64::min) < 1e-4);
    }
}

#[test]
fn the_left_side_is_its_own() {
    let mut records = palmate(5).records().unwrap();
    let mut left = records[0].clone();
    (records[0].side, left.side, left.length) = (LobeSide::Right, LobeSide::Left, 0.4);
    records.insert(1, left);
    let spec = MarginSpec { lobe: records, ..lobed(LobingSpec::default()) };
    let margin = entire(&spec).unwrap();
    assert_eq!(margin.check(), None);
    let lowest = |side: f64| {
        let tips = tips(&margin).into_iter().filter(|tip| tip.x * side > 0.0);
        tips.map(|tip| tip.length()).fold(f64::INFINITY, f64::min)
    };
    assert!((lowest(1.0) - 48.0).abs() < 1e-9);
    assert!((lowest(-1.0) - 32.0).abs() < 1e-9);
    assert_eq!(tips(&margin).len(), 5);
}

#[test]
fn a_bent_vein_ends_where_the_straight_one_does() {
    let record = LobeRecord { bend_deg: 40.0, valley: ValleyKind::Set, ..LobeRecord::default() };
    let (bent, straight) =
        (Lobe::new(&record), Lobe::new(&LobeRecord { bend_deg: 0.0, ..record.clone() }));
    let ways = |lobe: &Lobe| {
        let mut list = Vec::new();
        lobe.waypoints(&mut list, lobe.upper, lobe.valley.unwrap().0);
        list
    };
    let (a, b) = (ways(&bent), ways(&straight));
    assert_eq!(a[2].at, b[2].at);
    // It turns towards the apex: it arrives at the tip 20° nearer to the midrib.
    let turn = b[2].towards.angle_to(a[2].towards).to_degrees();
    assert!((turn - 20.0).abs() < 1e-9, "{turn}");
    // Half way it runs as the straight one does, to the side away from the apex.
    let middle = Lobe::new(&LobeRecord {
        upper: HalfLobe { waist_x: 0.005, ..HalfLobe::default() },
        ..record
    });
    assert!(ways(&middle)[1].at.y < b[1].at.y);
}

#[test]
fn lists_that_make_no_leaf_say_why() {
    let problem = |lobe: Vec<LobeRecord>| outline(&lobe).unwrap_err().to_string();
    assert!(problem(Vec::new()).contains("a side without lobes"));
    let apex = LobeRecord { side: LobeSide::Apex, ..LobeRecord::default() };
    assert!(problem(vec![apex.clone(), apex.clone()]).contains("keep one"));
    let right = LobeRecord { side: LobeSide::Right, ..LobeRecord::default() };
    assert!(problem(vec![right.clone()]).contains("a side without lobes"));
    // One at the apex is a leaf, with or without others.
    outline(std::slice::from_ref(&apex)).unwrap();
    outline(&[right, apex]).unwrap();
}

/// A record with every number drawn within reason.
fn drawn(rng: &mut Rng, side: LobeSide, n: usize, i: usize) -> LobeRecord {
    let share = i as f64 / n as f64;
    let half = |rng: &mut Rng| HalfLobe {
        waist_x: rng.between(0.1, 0.3),
        waist_y: rng.between(0.3, 0.8),
        base_angle_deg: rng.between(10.0, 70.0),
        apex_angle_deg: rng.between(10.0, 90.0),
    };
    LobeRecord {
        side,
        angle_deg: 100.0 - 70.0 * share + rng.between(-4.0, 4.0),
        length: rng.between(0.5, 0.9),
        lower: half(rng),
        upper: half(rng),
        valley: if rng.unit() < 0.5 { ValleyKind::Meet } else { ValleyKind::Set },
        valley_distance: rng.between(0.25, 0.5),
        valley_angle_deg: 70.0 / n as f64 / 2.0,
        ..LobeRecord::default()
    }
}

/// Leaves of lobes drawn within reason.
fn drawn_leaves(count: usize) -> Vec<Vec<LobeRecord>> {
    let mut rng = Seed(5).stream(Stage::Guides);
    let mut leaf = || {
        let n = 1 + (rng.unit() * 3.0) as usize;
        let mut lobe: Vec<LobeRecord> =
            (0..n).map(|i| drawn(&mut rng, LobeSide::Both, n, i)).collect();
        lobe.push(drawn(&mut rng, LobeSide::Apex, n, n));
        lobe
    };
    (0..count).map(|_| leaf()).collect()
}

#[test]
fn a_small_change_of_random_lobes_moves_the_margin_a_little() {
    // A switch of section 6.3 (a waist passed by its valley, lobes that come to touch) lies within a
    // change this small in no leaf of a few hundred.
    const BY: f64 = 1e-7;
    let mut rng = Seed(6).stream(Stage::Guides);
    let mut compared = 0;
    for lobe in drawn_leaves(120) {
        let mut moved = lobe.clone();
        for record in &mut moved {
            let halves = [&mut record.lower, &mut record.upper].into_iter().flat_map(|half| {
                [
                    &mut half.waist_x,
                    &mut half.waist_y,
                    &mut half.base_angle_deg,
                    &mut half.apex_angle_deg,
                ]
            });
            let rest = [
                &mut record.angle_deg,
                &mut record.length,
                &mut record.valley_distance,
                &mut record.valley_angle_deg,
            ];
            halves.chain(rest).for_each(|x| *x *= 1.0 + BY * rng.between(-1.0, 1.0));
        }
        let build = |lobe| entire(&MarginSpec { lobe, ..lobed(LobingSpec::default()) });
        let (Ok(before), Ok(after)) = (build(lobe), build(moved)) else { continue };
        compared += 1;
        for (from, to) in [(&before, &after), (&after, &before)] {
            let off = deviation::to_polygon(from.outline(), to.outline());
            let most = off.into_iter().fold(0.0, f64::max);
            assert!(most < 1e-2, "{most} mm of {}", before.length_mm());
        }
    }
    assert!(compared > 100, "{compared}");
}

#[test]
fn random_lobes_are_margins_or_are_refused_with_a_place() {
    let mut made = 0;
    for lobe in drawn_leaves(300) {
        let spec = MarginSpec { lobe, ..lobed(LobingSpec::default()) };
        match entire(&spec) {
            Ok(margin) => {
                made += 1;
                assert_eq!(margin.check(), None);
            }
            Err(error) => assert!(error.to_string().contains("crosses itself"), "{error}"),
        }
    }
    // The rest has a lobe behind another, or one that reaches over the midrib.
    assert!(made >= 280, "{made}");
}

#[test]
fn basal_lobes_that_overlap_are_cut_back_to_a_slit() {
    let wide = HalfLobe { waist_x: 0.5, base_angle_deg: 80.0, ..HalfLobe::default() };
    let lowest = LobeRecord { angle_deg: 150.0, length: 0.5, lower: wide, ..LobeRecord::default() };
    let mut lobe = vec![lowest];
    lobe.extend(palmate(5).records().unwrap().split_off(1));
    let spec = MarginSpec { lobe, ..lobed(LobingSpec::default()) };
    let margin = entire(&spec).unwrap();
    assert_eq!(margin.check(), None);
    let outline = margin.outline();
    assert!((outline[1].x - SLIT * 80.0).abs() < 1e-9 && outline[1].y < 0.0, "{}", outline[1]);
    let last = outline[outline.len() - 1];
    assert!(last.distance(DVec2::new(-outline[1].x, outline[1].y)) < 1e-9);
}

#[test]
fn a_lobe_that_hides_another_names_the_key_the_value_and_a_bound_that_works() {
    let half = |waist_x: f64| HalfLobe { waist_x, ..HalfLobe::default() };
    let hidden = LobeRecord {
        angle_deg: 100.0,
        length: 0.6,
        lower: half(0.14),
        upper: half(0.14),
        ..LobeRecord::default()
    };
    let wide =
        LobeRecord { angle_deg: 60.0, length: 0.9, lower: half(0.6), ..LobeRecord::default() };
    let apex = LobeRecord { side: LobeSide::Apex, ..LobeRecord::default() };
    let spec = MarginSpec { lobe: vec![hidden, wide, apex], ..lobed(LobingSpec::default()) };
    let error = entire(&spec).unwrap_err();
    let MarginError::CrossingBy { key, value, problem, .. } = &error else { panic!("{error}") };
    assert_eq!((key.as_str(), *value), ("margin.lobe.2.lower.waist_x", 0.6));
    let words = problem.split("take ").nth(1).unwrap();
    let bound: f64 = words.split(' ').next().unwrap().parse().unwrap();
    let mut mended = spec;
    mended.lobe[1].lower.waist_x = bound;
    assert_eq!(entire(&mended).unwrap().check(), None);
}

/// The direction of a sampled parabola at the first of three neighbouring points, exactly.
fn direction([a, b, c]: [DVec2; 3]) -> DVec2 {
    (4.0 * b - 3.0 * a - c).normalize()
}
