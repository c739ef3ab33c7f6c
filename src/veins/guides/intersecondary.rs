//! Veins between two secondaries that end half-way to the margin.

use super::course::Course;
use super::planter::{Planter, Vein};
use super::secondary::Plan;
use super::{GuideSpec, INTERSECONDARY};
use crate::seed::Rng;

/// Lays those between two neighbouring secondaries of one side of the midrib.
pub(super) fn lay(
    spec: &GuideSpec,
    planter: &mut Planter<'_>,
    midrib: &Vein,
    lower: &Plan,
    upper: &Plan,
    rng: &mut Rng,
) {
    let [a, b, c] = [rng.unit(), rng.unit(), rng.unit()];
    let count = (spec.intersecondary_count + a).floor() as usize;
    for i in 0..count {
        let part = (i as f64 + 1.0) / (count as f64 + 1.0) + 0.15 * spec.irregularity * (b - 0.5);
        let share = lower.share + (upper.share - lower.share) * part;
        let (node, from, ahead) = midrib.at(share);
        let course = Course {
            from,
            ahead,
            side: lower.side,
            angle_deg: 0.5 * (lower.angle_deg + upper.angle_deg) + 4.0 * (c - 0.5),
            curvature: lower.curvature,
        };
        let length = spec.intersecondary_length * (0.75 + 0.5 * b);
        let line = course.part_way(planter.ground, length);
        planter.lay(node, &line, INTERSECONDARY, 0.4);
    }
}
