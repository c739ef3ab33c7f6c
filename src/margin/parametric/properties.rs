//! Properties of unilobed margins over random parameters.

use glam::DVec2;
use proptest::prelude::*;

use super::SideSpec;
use crate::geometry::deviation;
use crate::margin::{Margin, MarginError, MarginSpec, entire};

/// A side as leaves have them: what is drawn is kept apart from what its landmarks forbid.
fn side(drawn: &[f64], tailed: bool, shouldered: bool, dripping: bool) -> SideSpec {
    let between = |i: usize, low: f64, high: f64| low + (high - low) * drawn[i];
    let waist_x = between(0, 0.04, 0.6);
    let angle = |i: usize, extended: bool| {
        if extended { between(i, 95.0, 165.0) } else { between(i, 10.0, 88.0) }
    };
    let dripping = dripping && !shouldered;
    SideSpec {
        waist_x,
        waist_y: between(1, 0.2, 0.65),
        base_angle_deg: angle(2, tailed),
        apex_angle_deg: angle(3, shouldered),
        tail_x: waist_x * between(4, 0.3, 0.8),
        tail_depth: if tailed { between(5, 0.02, 0.25) } else { 0.0 },
        shoulder_x: waist_x * between(6, 0.3, 0.8),
        shoulder_height: if shouldered { between(7, 0.02, 0.2) } else { 0.0 },
        drip_length: if dripping { between(8, 0.05, 0.3) } else { 0.0 },
        drip_x: waist_x * between(9, 0.1, 0.4),
        tension: between(10, 0.4, 1.1),
    }
}

fn leaf() -> impl Strategy<Value = MarginSpec> {
    let drawn = || prop::collection::vec(0.0..1.0, 11);
    let extras = || prop::array::uniform3(any::<bool>());
    (drawn(), extras(), drawn(), extras(), -40.0..40.0).prop_map(|(a, e, b, f, bend)| MarginSpec {
        right: side(&a, e[0], e[1], e[2]),
        left: side(&b, f[0], f[1], f[2]),
        midrib_bend_deg: bend,
        length_mm: 100.0,
        ..MarginSpec::default()
    })
}

/// Every number of the leaf a little larger, each by another amount; landmarks keep their order.
fn nudged(spec: &MarginSpec, by: f64) -> MarginSpec {
    let mut spec = spec.clone();
    for (i, side) in [&mut spec.right, &mut spec.left].into_iter().enumerate() {
        let by = by * (1.0 + 0.3 * i as f64);
        side.waist_x += 2.0 * by;
        side.waist_y += by;
        side.tail_x += by;
        side.shoulder_x += by;
        side.drip_x += by;
        side.base_angle_deg += 57.0 * by;
        side.apex_angle_deg += 40.0 * by;
        side.tension += by;
        if side.tail_depth > 0.0 {
            side.tail_depth += by;
        }
        if side.shoulder_height > 0.0 {
            side.shoulder_height += by;
        }
        if side.drip_length > 0.0 {
            side.drip_length += by;
        }
    }
    spec.midrib_bend_deg += 50.0 * by;
    spec
}

/// The greatest distance from a point of either margin to the other.
fn apart(a: &Margin, b: &Margin) -> f64 {
    let there = deviation::to_polygon(a.outline(), b.outline());
    there.into_iter().chain(deviation::to_polygon(b.outline(), a.outline())).fold(0.0, f64::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn unilobed_margins_are_simple_anticlockwise_and_continuous(spec in leaf()) {
        match entire(&spec) {
            Ok(margin) => {
                prop_assert_eq!(margin.check(), None);
                prop_assert!(margin.area_mm2() > 0.0);
                prop_assert_eq!(margin.apex(), DVec2::new(0.0, 100.0));
                // A thousandth of a length, times what the numbers of a side can do together.
                let by = 1e-4;
                if let Ok(near) = entire(&nudged(&spec, by)) {
                    let moved = apart(&margin, &near);
                    prop_assert!(moved < 10.0 * by * 100.0, "moved {} mm", moved);
                }
            }
            Err(MarginError::CrossingBy { key, value, problem, .. }) => {
                let bound: f64 = problem
                    .split(' ')
                    .find_map(|word| word.parse().ok())
                    .expect("the problem names a bound");
                prop_assert!(bound != value);
                let mended = with_bound(&spec, &key, bound, bound < value);
                prop_assert!(entire(&mended).is_ok(), "{} = {}: {}", key, value, problem);
            }
            Err(error) => prop_assert!(false, "{}", error),
        }
    }
}

fn with_bound(spec: &MarginSpec, key: &str, bound: f64, most: bool) -> MarginSpec {
    let mut spec = spec.clone();
    let to = |x: &mut f64| *x = if most { x.min(bound) } else { x.max(bound) };
    if key == "margin.midrib_bend_deg" {
        spec.midrib_bend_deg = bound;
        return spec;
    }
    for side in [&mut spec.right, &mut spec.left] {
        to(match key.rsplit('.').next().expect("a name") {
            "tension" => &mut side.tension,
            "tail_depth" => &mut side.tail_depth,
            "shoulder_height" => &mut side.shoulder_height,
            "base_angle_deg" => &mut side.base_angle_deg,
            "apex_angle_deg" => &mut side.apex_angle_deg,
            "waist_x" => &mut side.waist_x,
            "waist_y" => &mut side.waist_y,
            other => panic!("no such key: {other}"),
        });
    }
    spec
}

#[test]
fn a_margin_that_crosses_itself_names_the_key_the_value_and_a_bound_that_works() {
    let side = SideSpec {
        waist_x: 0.05,
        waist_y: 0.1,
        base_angle_deg: 178.0,
        tail_x: 0.04,
        tail_depth: 0.6,
        tension: 1.5,
        ..SideSpec::default()
    };
    let spec = MarginSpec { right: side.clone(), left: side, ..MarginSpec::default() };
    let error = entire(&spec).expect_err("it crosses itself");
    let message = error.to_string();
    let MarginError::CrossingBy { key, value, problem, .. } = error else { panic!("{message}") };
    assert!(
        message.contains(&format!("{key} = {value} takes the margin across itself")),
        "{message}"
    );
    let bound = problem.split(' ').find_map(|word| word.parse::<f64>().ok()).expect("a bound");
    assert!(entire(&with_bound(&spec, &key, bound, bound < value)).is_ok(), "{message}");
}
