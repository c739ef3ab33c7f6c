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
        assert_eq!(blade.metric(blade.last_step()), Metric { stretch: DVec2::ONE, per_mm: 1.0 });
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
