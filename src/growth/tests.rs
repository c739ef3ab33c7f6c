use super::*;

fn ellipse(sides: usize) -> Margin {
    let at = |i: usize| {
        let t = std::f64::consts::TAU * i as f64 / sides as f64;
        DVec2::new(0.25 * libm::sin(t), 0.5 - 0.5 * libm::cos(t)) * 100.0
    };
    let mut outline: Vec<DVec2> = (0..sides).map(at).collect();
    outline[sides / 2].x = 0.0;
    Margin::new(outline, sides / 2, Vec::new(), "").expect("an ellipse is a margin")
}

fn spec(r#type: GrowthType) -> GrowthSpec {
    GrowthSpec { r#type, ..GrowthSpec::default() }
}

#[test]
fn growth_ends_exactly_on_the_mature_margin() {
    for &kind in GrowthType::ALL {
        let blade = GrowingBlade::new(ellipse(64), &spec(kind)).expect("grows");
        assert_eq!(blade.scale_at(blade.last_step()), DVec2::ONE, "{kind}");
        assert_eq!(blade.finished(), blade.mature());
        assert_eq!(blade.frame(blade.last_step()), Frame::uniform(DVec2::ONE, 1.0));
    }
}

#[test]
fn equal_steps_on_both_axes_are_isotropic() {
    let even = GrowthSpec { horizontal_steps: 400, ..spec(GrowthType::Anisotropic) };
    let a = GrowingBlade::new(ellipse(64), &even).expect("grows");
    let b = GrowingBlade::new(ellipse(64), &spec(GrowthType::Isotropic)).expect("grows");
    assert!(!a.deforms());
    assert!(a.steps().all(|step| a.scale_at(step) == b.scale_at(step)));
}

#[test]
fn carry_to_the_same_step_is_the_identity_and_there_and_back_too() {
    let blade = GrowingBlade::new(ellipse(64), &spec(GrowthType::Anisotropic)).expect("grows");
    let p = DVec2::new(3.0, 41.0);
    assert_eq!(blade.carry(p, 200, 200), p);
    assert!(blade.carry(blade.carry(p, 200, 300), 300, 200).distance(p) < 1e-12);
}

#[test]
fn under_marginal_growth_a_place_is_born_when_the_outline_passes_it() {
    let blade = GrowingBlade::new(ellipse(64), &spec(GrowthType::Marginal)).expect("grows");
    for p in [DVec2::new(0.0, 50.0), DVec2::new(12.0, 60.0), DVec2::new(-20.0, 40.0)] {
        let birth = blade.birth_step(p).expect("inside the mature blade");
        let at = |step| polygon::contains(blade.at(step).expect("a margin").outline(), p);
        assert!(at(birth) && !at(birth - 1), "{p} at {birth}");
        assert!(blade.is_inside(p, birth) && !blade.is_inside(p, birth - 1));
    }
}

#[test]
fn the_root_lies_inside_at_every_age() {
    for &kind in GrowthType::ALL {
        let blade = GrowingBlade::new(ellipse(64), &spec(kind)).expect("grows");
        assert!(blade.steps().all(|step| blade.is_inside(blade.root(), step)), "{kind}");
    }
}

#[test]
fn a_start_after_the_end_is_an_error_with_its_key() {
    let late = GrowthSpec { start_step: 401, ..GrowthSpec::default() };
    let error = GrowingBlade::new(ellipse(64), &late).expect_err("too late").to_string();
    assert!(error.contains("growth.start_step = 401"), "{error}");
}

fn uneven(change: impl Fn(&mut RateSpec)) -> GrowingBlade {
    let mut spec = spec(GrowthType::NonUniform);
    change(&mut spec.rates);
    GrowingBlade::new(ellipse(64), &spec).expect("grows")
}

#[test]
fn a_basipetal_leaf_matures_from_the_apex_and_an_acropetal_one_from_the_base() {
    let height = |blade: &GrowingBlade, from: f64, to: f64| {
        let at = |y: f64| blade.carry(DVec2::new(0.0, y), 400, 150).y;
        (at(to) - at(from)) / (to - from)
    };
    let basipetal = uneven(|_| ());
    assert!(height(&basipetal, 80.0, 95.0) > 1.5 * height(&basipetal, 5.0, 20.0));
    let acropetal = uneven(|rates| rates.pattern = RatePattern::Acropetal);
    assert!(height(&acropetal, 5.0, 20.0) > 1.5 * height(&acropetal, 80.0, 95.0));
    // As a whole they keep the pace of even growth.
    let even = 151.0 / 401.0;
    assert!((height(&basipetal, 0.0, 100.0) / even - 1.0).abs() < 0.3);
}

#[test]
fn tissue_moves_at_the_velocity_that_belongs_to_the_rates() {
    // v_y = ∫ g_y dη and v_x = x·g_x(y), so ∂v_y/∂x = 0, ∂v_x/∂x = g_x, ∂v_y/∂y = g_y: nothing shears
    // but what the change of g_x along the blade asks for.
    let blade = uneven(|rates| rates.front = 0.4);
    let (from, to, h) = (200, 201, 1e-3);
    let moved = |p: DVec2| blade.carry(p, from, to);
    for (x, y) in [(3.0, 20.0), (-12.0, 50.0), (5.0, 80.0)] {
        let p = blade.carry(DVec2::new(x, y), 400, from);
        let across = (moved(p + DVec2::X * h) - moved(p)) / h;
        let along = (moved(p + DVec2::Y * h) - moved(p)) / h;
        assert!(across.y.abs() < 1e-9, "rows stay level: {across}");
        assert!((moved(p).x / p.x - across.x).abs() < 1e-6, "v_x is x times its rate");
        // The same factor of place and age in both directions.
        assert!((across.x.ln() / along.y.ln() - 1.0).abs() < 0.15, "{across} {along}");
    }
    let axis = blade.carry(DVec2::new(0.0, 30.0), 400, 120);
    assert_eq!(axis.x, 0.0);
}

#[test]
fn the_measure_is_that_of_the_leaf_as_it_is() {
    let blade = uneven(|rates| rates.front = 0.3);
    let frame = blade.frame(180);
    let metric = frame.metric();
    let (a, b) = (DVec2::new(4.0, 30.0), DVec2::new(-7.0, 71.0));
    let now = |p: DVec2| blade.carry(p, 400, 180);
    assert!((metric.distance_squared(a, b).sqrt() - now(a).distance(now(b))).abs() < 1e-9);
    assert!(metric.beyond(a, metric.between(a, b)).distance(b) < 1e-9);
    // Bounds hold for every point around.
    let mut rng = crate::seed::Seed(1).stream(crate::seed::Stage::Tissue);
    for _ in 0..2000 {
        let p = DVec2::new(rng.between(-25.0, 25.0), rng.between(0.0, 100.0));
        let q = p + DVec2::new(rng.between(-9.0, 9.0), rng.between(-9.0, 9.0));
        let distance = metric.distance_squared(p, q).sqrt();
        let box_around = metric.around(p, distance);
        assert!((q - p).abs().cmple(box_around).all(), "{p} {q} {box_around}");
        assert!(p.distance(q) <= metric.radius(p, distance));
        assert!(metric.clearance(p, (q - p).abs().max_element()) <= distance);
        let half = (q - p).abs();
        assert!(distance <= metric.half_diagonal(p, half) * (1.0 + 1e-12));
    }
}

#[test]
fn areas_follow_the_scale_of_the_tissue() {
    let blade = uneven(|_| ());
    let step = 170;
    let share = blade.area_share(step).expect("a margin");
    // The mean over the mature blade, by counting.
    let (mut sum, mut count) = (0.0, 0);
    for i in 0..100 {
        for j in 0..200 {
            let p = DVec2::new(f64::from(i) * 0.5 - 24.75, f64::from(j) * 0.5 + 0.25);
            if blade.covers(p) {
                sum += blade.area_scale(p, step);
                count += 1;
            }
        }
    }
    assert!((sum / f64::from(count) / share - 1.0).abs() < 2e-3);
}

#[test]
fn no_rates_are_full_size_and_all_of_them_at_the_margin_marginal_growth() {
    let still = uneven(|rates| {
        rates.pattern = RatePattern::Even;
        rates.by_age = vec![[0.0, 0.0], [1.0, 0.0]];
    });
    assert!(still.is_full_size() && !still.carries_tissue());
    let none = GrowingBlade::new(ellipse(64), &spec(GrowthType::None)).expect("grows");
    let led = uneven(|rates| (rates.pattern, rates.contrast) = (RatePattern::MarginLed, 1.0));
    let marginal = GrowingBlade::new(ellipse(64), &spec(GrowthType::Marginal)).expect("grows");
    assert!(!led.carries_tissue());
    for step in [100, 199, 300, 400] {
        assert_eq!(still.at(step), none.at(step));
        assert_eq!(led.at(step), marginal.at(step));
        let p = DVec2::new(9.0, 60.0);
        assert_eq!(led.is_inside(p, step), marginal.is_inside(p, step));
    }
}

#[test]
fn factors_out_of_their_limits_name_the_key() {
    let refused = |change: &dyn Fn(&mut GrowthSpec)| {
        let mut spec = spec(GrowthType::NonUniform);
        change(&mut spec);
        GrowingBlade::new(ellipse(64), &spec).expect_err("refused").to_string()
    };
    let late = refused(&|spec| spec.rates.by_place = vec![[0.5, 1.0], [0.2, 2.0]]);
    assert!(late.contains("growth.rates.by_place = 0.2"), "{late}");
    let nan = refused(&|spec| spec.rates.by_age = vec![[0.5, f64::NAN]]);
    assert!(nan.contains("growth.rates.by_age = NaN"), "{nan}");
    let deep = refused(&|spec| {
        spec.start_step = 0;
        spec.rates.by_place = vec![[0.0, 4.0]];
    });
    assert!(deep.contains("growth.start_step = 0"), "{deep}");
}

#[test]
fn landmarks_grow_with_the_blade() {
    use crate::margin::{Landmark, LandmarkKind};
    let mut outline = ellipse(64).to_outline();
    let tip = LandmarkKind::LobeTip { origin: DVec2::new(0.0, 8.0) };
    outline.landmarks.push(Landmark { vertex: 20, kind: tip });
    let margin = Margin::from_outline(outline, "").expect("an ellipse");
    for r#type in [GrowthType::Isotropic, GrowthType::Marginal] {
        let spec = GrowthSpec { r#type, ..GrowthSpec::default() };
        let blade = GrowingBlade::new(margin.clone(), &spec).expect("grows");
        let young = blade.at(150).expect("a young blade");
        let scale = blade.scale_at(150);
        let [mark] = young.landmarks() else { panic!("{:?}", young.landmarks()) };
        let at = young.outline()[mark.vertex];
        assert!(at.distance(margin.outline()[20] * scale) < 1e-9, "{at}");
        let origin = DVec2::new(0.0, 8.0) * scale;
        assert_eq!(mark.kind, LandmarkKind::LobeTip { origin });
    }
}
