use glam::DVec2;
use proptest::prelude::*;

use super::*;
use crate::margin::{self, LandmarkKind, Margin};
use crate::parameter::{Kind, Parameters};

fn toothed(teeth: TeethSpec) -> MarginSpec {
    MarginSpec { teeth, ..MarginSpec::default() }
}

fn serrate() -> TeethSpec {
    TeethSpec { r#type: ToothType::Serrate, count: 9, irregularity: 0.0, ..TeethSpec::default() }
}

fn build(spec: &MarginSpec) -> Margin {
    let margin = margin::build(spec, Seed(3)).expect("a margin");
    assert_eq!(margin.check(), None);
    margin
}

fn count(margin: &Margin, kind: LandmarkKind) -> usize {
    margin.landmarks().iter().filter(|mark| mark.kind == kind).count()
}

/// How far a point lies outside an outline (negative inside).
fn outside(outline: &[DVec2], p: DVec2) -> f64 {
    let near = polygon::edges(outline)
        .map(|(a, b)| polygon::nearest_on_segment(a, b, p).distance(p))
        .fold(f64::INFINITY, f64::min);
    if polygon::contains(outline, p) { -near } else { near }
}

#[test]
fn every_tooth_of_every_order_is_a_landmark_between_two_sinuses() {
    let mut teeth = TeethSpec { depth: 0.4, ..serrate() };
    teeth.second.count = 3;
    teeth.third.count = 2;
    let margin = build(&toothed(teeth));
    assert_eq!(count(&margin, LandmarkKind::Tooth { order: 1 }), 18);
    assert_eq!(count(&margin, LandmarkKind::Tooth { order: 2 }), 54);
    assert_eq!(count(&margin, LandmarkKind::Tooth { order: 3 }), 108);
    let first = |kind| match kind {
        LandmarkKind::Tooth { order: 1 } => Some(true),
        LandmarkKind::Sinus { order: 1 } => Some(false),
        _ => None,
    };
    let row: Vec<bool> = margin.landmarks().iter().filter_map(|mark| first(mark.kind)).collect();
    let repeats = row.windows(2).filter(|pair| pair[0] == pair[1]).count();
    // Around the apex no sinus is marked: the edge there is plain.
    assert!(repeats <= 1, "{row:?}");
}

#[test]
fn tips_stand_out_by_half_the_depth_and_sinuses_lie_in_by_as_much() {
    let spec = toothed(TeethSpec {
        end_fade: 0.0,
        spacing_change: 0.0,
        proximal_bow: 0.0,
        lean: 0.0,
        ..serrate()
    });
    let plain = margin::entire(&spec).expect("a margin");
    let margin = build(&spec);
    let side: f64 =
        plain.outline()[..=plain.apex_index()].windows(2).map(|w| w[0].distance(w[1])).sum();
    let half = 0.5 * 0.35 * (0.97 - 0.05) * side / 9.0;
    let height = |kind: LandmarkKind| -> Vec<f64> {
        let marks = margin.landmarks().iter().filter(|mark| mark.kind == kind);
        marks.map(|mark| outside(plain.outline(), margin.outline()[mark.vertex])).collect()
    };
    for tip in height(LandmarkKind::Tooth { order: 1 }) {
        assert!((tip / half - 1.0).abs() < 0.05, "{tip} {half}");
    }
    let sinuses = height(LandmarkKind::Sinus { order: 1 });
    // The last sinus of either side lies on the margin itself.
    let deep = sinuses.iter().filter(|s| (*s / -half - 1.0).abs() < 0.05).count();
    assert_eq!((deep, sinuses.len()), (16, 18), "{sinuses:?}");
    assert!((margin.area_mm2() / plain.area_mm2() - 1.0).abs() < 0.02, "as much in as out");
}

#[test]
fn serrate_teeth_lean_to_the_apex_and_dentate_ones_stand_upright() {
    for (kind, lean) in [(ToothType::Serrate, 0.3), (ToothType::Dentate, 0.0)] {
        let margin = build(&toothed(TeethSpec { r#type: kind, ..serrate() }));
        let marks = margin.landmarks();
        let at = |i: usize| margin.outline()[marks[i].vertex];
        let leans: Vec<f64> = (1..marks.len() - 1)
            .filter(|&i| marks[i].kind == LandmarkKind::Tooth { order: 1 } && at(i).x > 0.0)
            .filter(|&i| matches!(marks[i - 1].kind, LandmarkKind::Sinus { .. }))
            .map(|i| {
                let (below, above) = (at(i - 1), at(i + 1));
                let along = above - below;
                (at(i) - below).dot(along) / along.length_squared() - 0.5
            })
            .collect();
        let mean = leans.iter().sum::<f64>() / leans.len() as f64;
        assert!((mean - lean).abs() < 0.05, "{kind}: {mean} of {leans:?}");
    }
}

#[test]
fn crenate_teeth_have_no_point() {
    let sharpest = |kind| {
        let margin = build(&toothed(TeethSpec { r#type: kind, ..serrate() }));
        let outline = margin.outline();
        let n = outline.len();
        let turn = |i: usize| {
            let (a, b, c) = (outline[(i + n - 1) % n], outline[i], outline[(i + 1) % n]);
            (b - a).angle_to(c - b).to_degrees()
        };
        let tips = margin.landmarks().iter().filter(|m| m.kind == LandmarkKind::Tooth { order: 1 });
        tips.map(|mark| turn(mark.vertex)).fold(0.0, f64::max)
    };
    assert!(sharpest(ToothType::Crenate) < 25.0, "{}", sharpest(ToothType::Crenate));
    assert!(sharpest(ToothType::Serrate) > 60.0, "{}", sharpest(ToothType::Serrate));
}

#[test]
fn without_asymmetry_the_left_side_is_the_mirror_of_the_right_one() {
    let mut spec = toothed(TeethSpec { irregularity: 0.4, ..serrate() });
    spec.waves.height = 0.01;
    spec.asymmetry = 0.0;
    let margin = build(&spec);
    let outline = margin.outline();
    let n = outline.len();
    assert_eq!(n % 2, 0);
    for i in 1..n / 2 {
        let mirrored = DVec2::new(-outline[n - i].x, outline[n - i].y);
        assert!(outline[i].distance(mirrored) < 1e-9, "vertex {i}");
    }
    spec.asymmetry = 1.0;
    let own = build(&spec);
    let bounds = own.bounds();
    assert!((bounds.max.x + bounds.min.x).abs() > 1e-3, "each side has its own teeth: {bounds:?}");
}

#[test]
fn waves_and_roughness_stay_within_their_heights_and_leave_the_ends() {
    let mut spec = MarginSpec::default();
    spec.waves.height = 0.02;
    spec.roughness.height_mm = 0.5;
    let plain = margin::entire(&spec).expect("a margin");
    let margin = build(&spec);
    assert_eq!(margin.apex(), plain.apex());
    let away =
        margin.outline().iter().map(|&p| outside(plain.outline(), p).abs()).fold(0.0, f64::max);
    assert!(away > 0.8 && away <= 1.6 * (0.02 * 80.0 + 0.5), "{away}");
}

#[test]
fn flanks_towards_the_tip_have_as_many_smaller_teeth_as_their_share_says() {
    let small = |distal_share: f64| {
        let mut teeth = TeethSpec { irregularity: 0.0, lean: 0.0, ..serrate() };
        teeth.second = SmallTeethSpec { count: 6, distal_share, ..SmallTeethSpec::default() };
        let margin = build(&toothed(teeth));
        let small =
            margin.landmarks().iter().filter(|m| m.kind == LandmarkKind::Tooth { order: 2 });
        let large =
            margin.landmarks().iter().filter(|m| m.kind == LandmarkKind::Tooth { order: 1 });
        small.count() as f64 / large.count() as f64
    };
    // Of upright teeth both flanks are alike: three on each.
    assert_eq!([1.0, 0.7, 0.0].map(small), [6.0, 5.0, 3.0]);
}

#[test]
fn before_waves_begin_a_side_is_as_it_was() {
    let mut spec = MarginSpec::default();
    (spec.waves.height, spec.waves.from) = (0.03, 0.6);
    let plain = margin::entire(&spec).expect("a margin");
    let away = |margin: &Margin, upper: bool| {
        // Both sides are well past half of their way at this height.
        let here = margin.outline().iter().filter(|p| (p.y > 0.5 * spec.length_mm) == upper);
        here.map(|&p| outside(plain.outline(), p).abs()).fold(0.0, f64::max)
    };
    let margin = build(&spec);
    assert!(away(&margin, false) < 0.02, "{}", away(&margin, false));
    assert!(away(&margin, true) > 1.0, "{}", away(&margin, true));
}

#[test]
fn teeth_too_fine_name_the_key_the_value_and_the_bound() {
    let spec = toothed(TeethSpec { count: 0, per_cm: 60.0, ..serrate() });
    let small = MarginSpec { length_mm: 80.0, ..spec };
    let mut fine = small.clone();
    fine.teeth.second.count = 12;
    fine.teeth.third.count = 12;
    let error = margin::build(&fine, Seed(1)).expect_err("too fine").to_string();
    assert!(error.starts_with("margin.teeth.per_cm = 60 makes teeth finer"), "{error}");
    let bound: f64 = error
        .rsplit("at most ")
        .next()
        .and_then(|t| t.split(' ').next())
        .expect("a bound")
        .parse()
        .expect("a number");
    fine.teeth.per_cm = bound;
    build(&fine);
    let error = margin::build(&toothed(TeethSpec { from: 0.9, to: 0.4, ..serrate() }), Seed(1));
    let error = error.expect_err("backwards").to_string();
    assert_eq!(error, "margin.teeth.from = 0.9 is not below margin.teeth.to = 0.4");
}

#[test]
fn every_lobe_has_its_own_teeth_on_both_flanks() {
    use crate::margin::MarginKind;
    use crate::margin::lobes::{LobeRecord, LobeSide};
    let lobe = |side, angle_deg, teeth_count| LobeRecord {
        side,
        angle_deg,
        length: 0.8,
        teeth_count,
        ..LobeRecord::default()
    };
    let mut spec = toothed(TeethSpec { count: 0, per_cm: 2.0, ..serrate() });
    spec.kind = MarginKind::Lobed;
    spec.lobe = vec![
        lobe(LobeSide::Right, 60.0, 0.0),
        lobe(LobeSide::Left, 60.0, 3.0),
        lobe(LobeSide::Apex, 0.0, 1.0),
    ];
    let margin = build(&spec);
    let valleys = margin.landmarks().iter().filter(|mark| mark.kind == LandmarkKind::Valley);
    let valleys: Vec<usize> = valleys.map(|mark| mark.vertex).collect();
    assert_eq!(valleys.len(), 2, "{:?}", margin.landmarks());
    let teeth = |from: usize, to: usize| {
        let first =
            margin.landmarks().iter().filter(|m| m.kind == LandmarkKind::Tooth { order: 1 });
        first.filter(|mark| (from..to).contains(&mark.vertex)).count()
    };
    let n = margin.outline().len();
    let (right, apex, left) =
        (teeth(0, valleys[0]), teeth(valleys[0], valleys[1]), teeth(valleys[1], n));
    assert_eq!(right, 0, "none on the right lobe");
    assert!(apex >= 6 && left > apex, "{apex} {left}");
}

/// Every knob of a group drawn from its whole range.
fn anywhere<T: Parameters + serde::Serialize + serde::de::DeserializeOwned + Default>(
    prefix: &str,
    seed: u64,
) -> T {
    let mut tree = toml::Value::try_from(T::default()).expect("plain data");
    for parameter in T::parameters() {
        let mut node = &mut tree;
        for part in parameter.key.split('.') {
            node = node.get_mut(part).expect("a field");
        }
        let mut rng = Seed(seed).parameter(&format!("{prefix}.{}", parameter.key));
        *node = match parameter.kind {
            Kind::Number { min, max, .. } => toml::Value::Float(rng.between(min, max)),
            Kind::Count { min, max, .. } => {
                toml::Value::Integer((min as f64 + rng.unit() * (max - min + 1) as f64) as i64)
            }
            Kind::Choice(words) => {
                toml::Value::String(words[(rng.unit() * words.len() as f64) as usize].into())
            }
            _ => continue,
        };
    }
    tree.try_into().expect("the same group")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn any_knobs_give_a_valid_margin_or_name_what_is_wrong(seed: u64, cordate: bool, deep: bool) {
        let mut spec = MarginSpec {
            teeth: anywhere("teeth", seed),
            waves: anywhere("waves", seed),
            ..MarginSpec::default()
        };
        // Third orders on hundreds of teeth are many points, and no other case.
        spec.teeth.count %= 30;
        spec.teeth.per_cm %= 6.0;
        spec.teeth.per_cm += 0.1;
        spec.teeth.second.count %= 7;
        spec.teeth.third.count %= if deep { 3 } else { 1 };
        if seed % 3 == 0 {
            spec.roughness = anywhere("roughness", seed);
        }
        if cordate {
            for side in [&mut spec.right, &mut spec.left] {
                (side.tail_depth, side.base_angle_deg) = (0.15, 140.0);
            }
        }
        match margin::build(&spec, Seed(seed)) {
            Ok(margin) => prop_assert_eq!(margin.check(), None),
            Err(MarginError::Landmark { key, .. }) => prop_assert!(key.starts_with("margin.teeth.")),
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}
