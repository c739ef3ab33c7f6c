//! The vein pattern: the fast path against an obvious one, and what every pattern guarantees.

use glam::DVec2;
use venation::growth::{GrowingBlade, GrowthSpec, GrowthType};
use venation::margin::Margin;
use venation::observer::Silent;
use venation::seed::Seed;
use venation::veins::{self, VeinSpec};

/// An ellipse 100 mm long and 50 wide.
fn ellipse() -> Margin {
    let at = |i: usize| {
        let t = std::f64::consts::TAU * i as f64 / 64.0;
        DVec2::new(25.0 * t.sin(), 50.0 - 50.0 * t.cos())
    };
    let mut outline: Vec<DVec2> = (0..64).map(at).collect();
    outline[32].x = 0.0;
    Margin::new(outline, 32, Vec::new(), "").expect("an ellipse is a margin")
}

/// Lobes below the base, a waist and two sinuses: nearly nothing sees everything.
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

#[test]
fn every_growth_type_fills_the_blade_with_a_tree() {
    for &kind in GrowthType::ALL {
        for margin in [ellipse(), lobed()] {
            let growth = GrowthSpec {
                r#type: kind,
                total_steps: 200,
                horizontal_steps: 150,
                vertical_steps: 200,
                start_step: 60,
                ..GrowthSpec::default()
            };
            let blade = GrowingBlade::new(margin, &growth).expect("grows");
            let spec = VeinSpec {
                node_step_mm: 1.0,
                source_spawn_distance_mm: 3.0,
                kill_distance_mm: 2.0,
                ..VeinSpec::default()
            };
            let start = std::time::Instant::now();
            let venation = veins::grow(&spec, &blade, Seed(1), &mut Silent).expect("veins");
            eprintln!(
                "{kind} {} nodes {:?} orders {:?} of {} {:?}",
                venation.graph().len(),
                venation.unreached(),
                venation.orders().iter().max(),
                venation.sources(),
                start.elapsed()
            );
            assert_eq!(venation.check(blade.finished()), None, "{kind}");
            assert!(venation.graph().len() > 100, "{kind}");
        }
    }
}
