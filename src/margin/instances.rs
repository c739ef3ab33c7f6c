//! Instances of a margin: every number perturbed by a random percentage.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, 2011, figures 5.24 and 6.13: all
//! parameters of a leaf are perturbed by up to 15–40 %. Departs from it: the left side goes part of the way
//! with the right one, numbers that would then contradict each other stop at the bound between them, and a
//! leaf that would still be no margin is perturbed less, so that every instance is a leaf.

use super::lobes::LobeSide;
use super::parametric::SideSpec;
use super::{MarginSpec, build};
use crate::parameter::{Kind, Parameters, RECORD};
use crate::seed::Seed;

/// Shares of the percentage that are tried, one after the other: the last gives the leaf itself.
const TRIES: [f64; 7] = [1.0, 0.75, 0.55, 0.4, 0.25, 0.1, 0.0];

/// The margin with every number moved by a random percentage up to `percent`, within its limits, and the
/// percentage that could be had: less than asked where the leaf would be no margin. Each number has a stream
/// of its own.
#[must_use]
pub fn instance(spec: &MarginSpec, percent: f64, seed: Seed) -> (MarginSpec, f64) {
    let mut tries = TRIES.iter().map(|share| share * percent);
    let builds = |percent: f64| {
        let moved = perturbed(spec, percent, seed);
        build(&moved, seed).is_ok().then_some((moved, percent))
    };
    tries.find_map(builds).unwrap_or_else(|| (spec.clone(), 0.0))
}

fn perturbed(spec: &MarginSpec, percent: f64, seed: Seed) -> MarginSpec {
    let mut tree = toml::Value::try_from(spec).expect("settings are plain data");
    let draw = Draw { percent, seed };
    for parameter in MarginSpec::parameters().iter().filter(|p| p.key != LOBES) {
        let key = format!("vary/margin.{}", parameter.key);
        let path: Vec<&str> = parameter.key.split('.').collect();
        let keys = [key.replace(".left.", ".right."), key];
        draw.perturb(&mut tree, &path, &parameter.kind, &keys);
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

/// What the left side has for itself of the way its numbers move; the rest it shares with the right one. The
/// halves of a leaf grow together: with nothing shared, one lobe of a pair would often be lost.
const OWN: f64 = 0.4;

struct Draw {
    percent: f64,
    seed: Seed,
}

impl Draw {
    /// Moves the number at a path, in every record of a list on the way. `keys`: the streams of the answering
    /// number on the right side, and its own.
    fn perturb(&self, node: &mut toml::Value, path: &[&str], kind: &Kind, keys: &[String; 2]) {
        match (path, &mut *node) {
            ([RECORD, rest @ ..], toml::Value::Array(records)) => {
                let answers = answers(records);
                for (i, record) in records.iter_mut().enumerate() {
                    let [answering, own] = keys;
                    let keys =
                        [format!("{answering}/{}", answers[i] + 1), format!("{own}/{}", i + 1)];
                    self.perturb(record, rest, kind, &keys);
                }
            }
            ([first, rest @ ..], node) => {
                if let Some(node) = node.get_mut(*first) {
                    self.perturb(node, rest, kind, keys);
                }
            }
            ([], node) => {
                let factor = 1.0 + self.percent / 100.0 * self.moved(keys);
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

    /// From −1 to 1.
    fn moved(&self, [answering, own]: &[String; 2]) -> f64 {
        let draw = |key: &str| 2.0 * self.seed.parameter(key).unit() - 1.0;
        if answering == own { draw(own) } else { draw(answering) * (1.0 - OWN) + draw(own) * OWN }
    }
}

/// For each of a list of lobes the one on the right that answers it, itself where none does.
fn answers(records: &[toml::Value]) -> Vec<usize> {
    let stands = |record: &toml::Value, on: LobeSide| {
        record.get("side").and_then(toml::Value::as_str) == Some(on.word())
    };
    let on = |side: LobeSide| -> Vec<usize> {
        (0..records.len()).filter(|&i| stands(&records[i], side)).collect()
    };
    let mut answers: Vec<usize> = (0..records.len()).collect();
    for (left, right) in on(LobeSide::Left).into_iter().zip(on(LobeSide::Right)) {
        answers[left] = right;
    }
    answers
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
            let (instance, _) = instance(&spec, 20.0, Seed(seed));
            let change = instance.right.waist_x / spec.right.waist_x;
            (least, most) = (least.min(change), most.max(change));
            assert!((0.8..=1.2).contains(&change), "{change}");
            assert!((32..=48).contains(&instance.teeth.count), "{}", instance.teeth.count);
            assert!(instance.right.base_angle_deg <= 90.0, "no extension, no reflex base");
        }
        assert!(least < 0.81 && most > 1.19, "the whole range is used: {least} {most}");
        assert_eq!(instance(&spec, 0.0, Seed(1)), (spec, 0.0));
    }

    #[test]
    fn a_bound_between_two_numbers_holds() {
        let mut spec = MarginSpec::default();
        for side in [&mut spec.right, &mut spec.left] {
            (side.tail_depth, side.base_angle_deg, side.tail_x) = (0.1, 92.0, 0.27);
        }
        for seed in 0..100 {
            let (instance, _) = instance(&spec, 40.0, Seed(seed));
            assert!(instance.right.base_angle_deg >= 90.0);
            assert!(instance.right.tail_x < instance.right.waist_x);
            assert!(build(&instance, Seed(seed)).is_ok());
        }
    }
}
