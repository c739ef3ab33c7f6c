use glam::DVec2;

use super::super::detail::{SmallTeethSpec, TeethSpec};
use super::super::lobes::shorthand::LobingSpec;
use super::*;
use crate::geometry::polygon;
use crate::margin::{MarginKind, build, parametric::SideSpec};

const SEED: Seed = Seed(4);

fn plain() -> MarginSpec {
    MarginSpec { length_mm: 60.0, ..MarginSpec::default() }
}

fn cordate() -> MarginSpec {
    let side = SideSpec {
        waist_x: 0.42,
        waist_y: 0.35,
        base_angle_deg: 130.0,
        tail_x: 0.22,
        tail_depth: 0.14,
        ..SideSpec::default()
    };
    MarginSpec { right: side.clone(), left: side, ..MarginSpec::default() }
}

fn toothed(count: u64, small: u64) -> MarginSpec {
    let teeth = TeethSpec {
        r#type: ToothType::Serrate,
        count,
        depth: 0.4,
        second: SmallTeethSpec { count: small, ..SmallTeethSpec::default() },
        ..TeethSpec::default()
    };
    MarginSpec { teeth, ..cordate() }
}

fn lobed(count: u64) -> MarginSpec {
    let lobing = LobingSpec { count, ..LobingSpec::default() };
    MarginSpec { kind: MarginKind::Lobed, lobing, ..MarginSpec::default() }
}

fn polygon_of(spec: &MarginSpec) -> MarginSpec {
    let margin = build(spec, SEED).expect("a margin");
    let mut polygon = MarginSpec::of_margin(&margin);
    polygon.tooth_tips_mm.clear();
    polygon.lobe_veins_mm.clear();
    polygon
}

fn between(from: &MarginSpec, to: &MarginSpec) -> MorphPath {
    through(&[(from, 1.0), (to, 1.0)])
}

fn through(leaves: &[(&MarginSpec, f64)]) -> MorphPath {
    let station = |&(spec, weight): &(&MarginSpec, f64)| Station { margin: spec.clone(), weight };
    MorphPath::new(&leaves.iter().map(station).collect::<Vec<_>>(), SEED).expect("a path")
}

/// The farthest that a vertex of one margin lies from the other (mm).
fn apart(a: &Margin, b: &Margin) -> f64 {
    let off = |p: &DVec2, other: &Margin| {
        polygon::edges(other.outline())
            .map(|(c, d)| polygon::nearest_on_segment(c, d, *p).distance(*p))
            .fold(f64::INFINITY, f64::min)
    };
    let one = a.outline().iter().map(|p| off(p, b)).fold(0.0, f64::max);
    b.outline().iter().map(|p| off(p, a)).fold(one, f64::max)
}

/// Pairs of every kind.
fn pairs() -> Vec<(&'static str, MarginSpec, MarginSpec)> {
    vec![
        ("no extension, one", plain(), cordate()),
        ("teeth", toothed(7, 3), toothed(12, 0)),
        ("teeth and none", plain(), toothed(9, 2)),
        ("unilobed, three lobes", plain(), lobed(3)),
        ("toothed, five lobes", toothed(9, 0), lobed(5)),
        ("three lobes, seven", lobed(3), lobed(7)),
        ("seven lobes, cordate", lobed(7), cordate()),
        ("polygon", polygon_of(&toothed(5, 0)), plain()),
        ("polygon, lobes", polygon_of(&cordate()), lobed(5)),
    ]
}

#[test]
fn both_ends_are_exact_and_the_path_arrives_there() {
    for (name, from, to) in pairs() {
        let path = between(&from, &to);
        for (u, near, end) in [(0.0, 1e-6, &from), (1.0, 1.0 - 1e-6, &to)] {
            let exact = build(end, SEED).expect("a margin");
            assert_eq!(path.at(u).expect("an end"), exact, "{name} {u}");
            let off = apart(&path.at(near).expect("near an end"), &exact);
            assert!(off < 0.02, "{name}: {off} mm from the end at {near}");
        }
    }
}

#[test]
fn every_frame_is_a_margin_of_the_length_between() {
    for (name, from, to) in pairs() {
        let path = between(&from, &to);
        for frame in 0..=16 {
            let u = f64::from(frame) / 16.0;
            let margin = path.at(u).unwrap_or_else(|error| panic!("{name} at {u}: {error}"));
            assert_eq!(margin.check(), None, "{name} at {u}");
            let length = from.length_mm + (to.length_mm - from.length_mm) * u;
            assert!((margin.length_mm() - length).abs() < 1e-9, "{name} at {u}");
        }
    }
}

#[test]
fn a_small_step_moves_the_margin_a_little() {
    for (name, from, to) in pairs() {
        let path = between(&from, &to);
        for frame in 0..12 {
            let u = (f64::from(frame) + 0.37) / 12.0;
            let (a, b) = (path.at(u).expect("a margin"), path.at(u + 1e-4).expect("a margin"));
            let off = apart(&a, &b);
            assert!(off < 0.05, "{name} at {u}: {off} mm");
        }
    }
}

#[test]
fn a_reference_without_weight_counts_for_nothing_and_more_weight_draws_nearer() {
    let (from, to, via) = (plain(), cordate(), toothed(9, 0));
    let linear = between(&from, &to);
    let without = through(&[(&from, 1.0), (&via, 0.0), (&to, 1.0)]);
    let reference = build(&via, SEED).expect("a margin");
    let mut last = f64::INFINITY;
    assert_eq!(without.at(0.4).expect("a margin"), linear.at(0.4).expect("a margin"));
    assert_eq!(without.shares(0.4), [0.6, 0.0, 0.4]);
    for weight in [0.2, 1.0, 5.0, 50.0] {
        let path = through(&[(&from, 1.0), (&via, weight), (&to, 1.0)]);
        let off = apart(&path.at(0.5).expect("a margin"), &reference);
        assert!(off < last, "weight {weight}: {off} after {last}");
        last = off;
        // The ends count 1 each at half-way, the reference twice its weight.
        let expected = 2.0 * weight / (2.0 * weight + 2.0);
        assert!((path.shares(0.5)[1] - expected).abs() < 1e-12);
    }
}

#[test]
fn extensions_grow_out_of_the_margin() {
    let path = between(&plain(), &cordate());
    let mut last = 0.0;
    for frame in 1..=20 {
        let low = -path.at(f64::from(frame) / 20.0).expect("a margin").bounds().min.y;
        assert!(low >= last - 1e-9, "the base goes down steadily: {low} after {last}");
        last = low;
    }
    assert!((last - 0.14 * 80.0).abs() < 0.01);
}

#[test]
fn lobes_are_there_from_the_first_frame_and_know_their_veins() {
    let path = between(&plain(), &lobed(5));
    for u in [0.1, 0.5, 0.9] {
        let margin = path.at(u).expect("a margin");
        let tips = margin.landmarks().iter();
        let tips = tips.filter(|mark| matches!(mark.kind, LandmarkKind::LobeTip { .. })).count();
        assert!(tips >= 4, "{tips} lobe tips at {u}");
    }
}

#[test]
fn frames_as_settings_are_the_same_margins_with_their_teeth() {
    let path = between(&toothed(6, 2), &toothed(9, 0));
    for u in [0.0, 0.3, 0.8, 1.0] {
        let margin = path.at(u).expect("a margin");
        let again = build(&path.spec_at(u).expect("settings"), SEED).expect("a margin");
        assert_eq!(margin.outline(), again.outline());
        let first = |margin: &Margin| {
            let marks = margin.landmarks().iter();
            marks.filter(|m| m.kind == LandmarkKind::Tooth { order: 1 }).count()
        };
        assert_eq!(first(&margin), first(&again));
    }
}

/// Any margin: unilobed with extensions on either side, lobed, or an outline that knows nothing of itself.
fn any_margin() -> impl proptest::strategy::Strategy<Value = MarginSpec> {
    use proptest::prelude::*;
    let side = (0.1..0.5, 0.25..0.6, any::<bool>(), any::<bool>()).prop_map(
        |(waist_x, waist_y, tail, shoulder)| SideSpec {
            waist_x,
            waist_y,
            base_angle_deg: if tail { 140.0 } else { 60.0 },
            apex_angle_deg: if shoulder { 130.0 } else { 40.0 },
            tail_x: 0.6 * waist_x,
            tail_depth: if tail { 0.15 } else { 0.0 },
            shoulder_x: 0.5 * waist_x,
            shoulder_height: if shoulder { 0.1 } else { 0.0 },
            ..SideSpec::default()
        },
    );
    let unilobed = (side.clone(), side).prop_map(|(right, left)| MarginSpec {
        right,
        left,
        ..MarginSpec::default()
    });
    let lobed = (2_u64..10).prop_map(lobed);
    // A star of uneven rays over the base, its lowest ray the petiole's place.
    let star = (prop::collection::vec((0.5..1.0, 0.15..0.45), 2..7)).prop_map(|rays| {
        let count = rays.len() * 2;
        let mut polygon_mm = vec![[0.0, 0.0]];
        for (i, (tip, valley)) in rays.iter().chain(rays.iter().rev()).enumerate() {
            let step = 280.0 / (count - 1) as f64;
            let at = |degrees: f64, radius: f64| {
                let (x, y) = degrees.to_radians().sin_cos();
                [60.0 * radius * x, 60.0 * radius * y + 25.0]
            };
            let angle = 140.0 - step * i as f64;
            if i == rays.len() {
                polygon_mm.push([0.0, 85.0]);
            }
            polygon_mm.push(at(angle + 0.3 * step, *valley));
            polygon_mm.push(at(angle, *tip));
        }
        MarginSpec {
            kind: MarginKind::Polygon,
            length_mm: 85.0,
            polygon_mm,
            ..MarginSpec::default()
        }
    });
    prop_oneof![unilobed, lobed, star]
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig::with_cases(48))]

    #[test]
    fn any_margin_turns_into_any_other(from in any_margin(), to in any_margin()) {
        let buildable = build(&from, SEED).is_ok() && build(&to, SEED).is_ok();
        proptest::prop_assume!(buildable);
        let path = between(&from, &to);
        for u in [0.0, 0.05, 0.3, 0.5, 0.7, 0.95, 1.0] {
            let margin = path.at(u).map_err(|error| {
                proptest::test_runner::TestCaseError::fail(format!("at {u}: {error}"))
            })?;
            proptest::prop_assert_eq!(margin.check(), None);
            // Its settings make it again.
            let again = build(&path.spec_at(u).expect("settings"), SEED).expect("a margin");
            proptest::prop_assert!(apart(&margin, &again) < 1e-9);
        }
    }
}
