//! Which secondary ends in which tooth.

use glam::DVec2;

use super::GuideSpec;
use super::planter::{Planter, Vein};
use super::secondary::Plan;
use super::targets::Tip;
use crate::geometry::alignment;

/// The tooth that each of a row of secondaries, from base to apex, should end in: those that
/// bring most of them into teeth with the least bending, in the order of the row.
pub(super) fn teeth_for(
    spec: &GuideSpec,
    planter: &Planter<'_>,
    parent: &Vein,
    plans: &[Plan],
    teeth: &[Tip],
) -> Vec<Option<Tip>> {
    let none = vec![None; plans.len()];
    let Some(side) = plans.first().map(|plan| plan.side) else { return none };
    let mut tips: Vec<Tip> = teeth.iter().filter(|tip| tip.side == side).copied().collect();
    if tips.is_empty() {
        return none;
    }
    let ends: Vec<(DVec2, f64)> = plans
        .iter()
        .map(|plan| {
            let line = plan.course(parent, plan.share.clamp(0.01, 0.99)).to_margin(planter.ground);
            (line[line.len() - 1], spec.tooth_reach * plan.spacing)
        })
        .collect();
    // The inner side of a lobe runs down the margin while its vein runs up.
    let (first, last) = (ends[0].0, ends[ends.len() - 1].0);
    let along = |p: DVec2| {
        let near = |a: &&Tip, b: &&Tip| a.at.distance(p).total_cmp(&b.at.distance(p));
        tips.iter().min_by(near).map_or(0.0, |tip| tip.along)
    };
    if along(last) < along(first) {
        tips.reverse();
    }
    let tallest = tips.iter().map(|tip| tip.height).fold(0.0, f64::max);
    let gain = |i: usize, j: usize| {
        let (end, reach) = ends[i];
        let bend = tips[j].at.distance(end) / reach;
        if bend <= 1.0 { 1.2 - bend + 0.6 * tips[j].height / tallest } else { f64::NEG_INFINITY }
    };
    let pairs = alignment::in_order(plans.len(), tips.len(), gain);
    pairs.into_iter().map(|tooth| tooth.map(|j| tips[j])).collect()
}
