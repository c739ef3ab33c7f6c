//! Secondaries that are the veins of lobes: in a pinnately lobed leaf one leaves the midrib for every
//! lobe, where the maker of the margin says, and runs to its tip.

use glam::DVec2;

use super::curve;
use super::planter::{Planter, Vein};
use super::primary::into_lobe;
use super::secondary::Plan;
use super::targets::Tip;
use crate::geometry::alignment;

/// Gives the lobes of one side their veins: of the secondaries planned there (from base to apex) those
/// nearest to where the veins begin, in order. The others stay as they are.
pub(super) fn assign(plans: &mut [Plan], side: f64, lobes: &[Tip], midrib: &Vein) {
    let mut lobes: Vec<(f64, Tip)> = lobes
        .iter()
        .filter(|tip| tip.side == side)
        .filter_map(|tip| Some((share_of(midrib, tip.origin?), *tip)))
        .collect();
    lobes.sort_by(|a, b| (a.0, a.1.along).partial_cmp(&(b.0, b.1.along)).expect("finite"));
    // Every pair gains more than what shares differ by, so that no lobe is left without.
    let gain = |i: usize, j: usize| 2.0 - (plans[i].share - lobes[j].0).abs();
    let pairs = alignment::in_order(plans.len(), lobes.len(), gain);
    for (plan, (share, tip)) in
        plans.iter_mut().zip(pairs).filter_map(|(plan, pair)| Some((plan, lobes[pair?])))
    {
        plan.share = share;
        plan.lobe = Some(tip);
    }
}

/// How far up a vein the place nearest to `p` is.
fn share_of(vein: &Vein, p: DVec2) -> f64 {
    let off = |i: &usize| vein.line[*i].distance_squared(p);
    let nearest = (0..vein.line.len()).min_by(|i, j| off(i).total_cmp(&off(j))).unwrap_or(0);
    nearest as f64 / (vein.line.len() - 1).max(1) as f64
}

/// From its place on the midrib to the tip of a lobe: bowed as the plan is, or as a primary would be
/// where that leaves the blade.
pub(super) fn course(planter: &Planter<'_>, parent: &Vein, plan: &Plan, tip: DVec2) -> Vec<DVec2> {
    let ground = planter.ground;
    let (_, from, ahead) = parent.at(plan.share);
    let angle_deg = ahead.angle_to(tip - from).abs().to_degrees();
    let half_turned = (1.0 - 0.5 * plan.curvature).max(0.5);
    let bowed = Plan { angle_deg: angle_deg / half_turned, ..*plan };
    let bowed = curve::ended_at(&bowed.course(parent, plan.share).to_margin(ground), tip);
    let inner = &bowed[1.min(bowed.len())..bowed.len().saturating_sub(2)];
    if bowed.len() > 4 && inner.windows(2).all(|w| ground.is_free(w[0], w[1])) {
        return bowed;
    }
    into_lobe(planter, from, plan.side, tip)
}
