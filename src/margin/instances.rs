//! Instances of a margin: every number perturbed by a random percentage.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, 2011, figures 5.24 and 6.13: all
//! parameters of a leaf are perturbed by up to 15–40 %. Departs from it: numbers that would then
//! contradict each other stop at the bound between them, and a leaf that would still be no margin is
//! perturbed less, so that every instance is a leaf.

use super::parametric::SideSpec;
use super::{MarginSpec, build};
use crate::parameter::{Kind, Parameters, RECORD};
use crate::seed::Seed;

/// Shares of the percentage that are tried, one after the other: the last gives the leaf itself.
const TRIES: [f64; 7] = [1.0, 0.75, 0.55, 0.4, 0.25, 0.1, 0.0];

/// The margin with every number moved by a random percentage up to `percent`, within its limits. Each
/// number has a stream of its own.
#[must_use]
pub fn instance(spec: &MarginSpec, percent: f64, seed: Seed) -> MarginSpec {
    let tries = TRIES.iter().map(|share| perturbed(spec, share * percent, seed));
    tries.into_iter().find(|spec| build(spec, seed).is_ok()).unwrap_or_else(|| spec.clone())
}

fn perturbed(spec: &MarginSpec, percent: f64, seed: Seed) -> MarginSpec {
    let mut tree = toml::Value::try_from(spec).expect("settings are plain data");
    for parameter in MarginSpec::parameters().iter().filter(|p| p.key != LOBES) {
        let key = format!("vary/margin.{}", parameter.key);
        let path: Vec<&str> = parameter.key.split('.').collect();
        perturb(&mut tree, &path, &parameter.kind, &key, percent, seed);
    }
    let mut spec: MarginSpec = tree.try_into().expect("the same settings with other numbers");
    for side in [&mut spec.right, &mut spec.left] {
        reconcile(side);
    }
    // Teeth keep a zone of their own.
    spec.teeth.to = spec.teeth.to.max(spec.teeth.from + LEAST_ZONE).min(1.0);
    spec.teeth.from = spec.teeth.from.min(spec.teeth.to - LEAST_ZONE);
    spec
}

/// The number of lobes is the kind of leaf, not a measure of it.
const LOBES: &str = "lobing.count";

/// Moves the number at a path, in every record of a list on the way.
fn perturb(
    node: &mut toml::Value,
    path: &[&str],
    kind: &Kind,
    key: &str,
    percent: f64,
    seed: Seed,
) {
    match (path, &mut *node) {
        ([RECORD, rest @ ..], toml::Value::Array(records)) => {
            for (i, record) in records.iter_mut().enumerate() {
                perturb(record, rest, kind, &format!("{key}/{}", i + 1), percent, seed);
            }
        }
        ([first, rest @ ..], node) => {
            if let Some(node) = node.get_mut(*first) {
                perturb(node, rest, kind, key, percent, seed);
            }
        }
        ([], node) => {
            let factor = 1.0 + percent / 100.0 * (2.0 * seed.parameter(key).unit() - 1.0);
            match (kind, node) {
                (Kind::Number { min, max, .. }, toml::Value::Float(x)) => {
                    *x = (*x * factor).clamp(*min, *max);
                }
                (Kind::Count { min, max, .. }, toml::Value::Integer(n)) => {
                    let moved = (*n as f64 * factor).round().clamp(*min as f64, *max as f64);
                    *n = moved as i64;
                }
                _ => {}
            }
        }
    }
}

/// Teeth stand on at least this part of an edge.
const LEAST_ZONE: f64 = 0.05;

/// A tail or shoulder lies at most this far out, in half widths at the waist.
const INNER: f64 = 0.95;

/// The numbers of a side, none past the bound that another sets.
fn reconcile(side: &mut SideSpec) {
    let bound =
        |angle: f64, extended: bool| if extended { angle.max(90.0) } else { angle.min(90.0) };
    side.base_angle_deg = bound(side.base_angle_deg, side.tail_depth > 0.0);
    side.apex_angle_deg = bound(side.apex_angle_deg, side.shoulder_height > 0.0);
    side.tail_x = side.tail_x.min(INNER * side.waist_x);
    side.shoulder_x = side.shoulder_x.min(INNER * side.waist_x);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::margin::detail::ToothType;

    #[test]
    fn numbers_move_by_up_to_the_percentage_and_no_percentage_moves_none() {
        let mut spec = MarginSpec::default();
        spec.teeth.r#type = ToothType::Serrate;
        spec.teeth.count = 40;
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for seed in 0..300 {
            let instance = instance(&spec, 20.0, Seed(seed));
            let change = instance.right.waist_x / spec.right.waist_x;
            (least, most) = (least.min(change), most.max(change));
            assert!((0.8..=1.2).contains(&change), "{change}");
            assert!((32..=48).contains(&instance.teeth.count), "{}", instance.teeth.count);
            assert!(instance.right.base_angle_deg <= 90.0, "no extension, no reflex base");
        }
        assert!(least < 0.81 && most > 1.19, "the whole range is used: {least} {most}");
        assert_eq!(instance(&spec, 0.0, Seed(1)), spec);
    }

    #[test]
    fn a_bound_between_two_numbers_holds() {
        let mut spec = MarginSpec::default();
        for side in [&mut spec.right, &mut spec.left] {
            (side.tail_depth, side.base_angle_deg, side.tail_x) = (0.1, 92.0, 0.27);
        }
        for seed in 0..100 {
            let instance = instance(&spec, 40.0, Seed(seed));
            assert!(instance.right.base_angle_deg >= 90.0);
            assert!(instance.right.tail_x < instance.right.waist_x);
            assert!(build(&instance, Seed(seed)).is_ok());
        }
    }
}
