//! What stands on the tips of teeth: bristles and glands.

use glam::DVec2;

use super::node::Node;

/// A bristle is this wide at its foot, in its lengths.
const BRISTLE_WIDTH: f64 = 0.12;

/// Draws the tip of a tooth out into a bristle, along the middle of its flanks.
pub(super) fn add_bristle(lower: &mut Vec<Node>, upper: &mut Vec<Node>, tip: DVec2, length: f64) {
    let width = BRISTLE_WIDTH * length;
    let mut top = *lower.last().expect("a flank has points");
    lower.pop();
    let before = |nodes: &[Node]| nodes.last().map_or(tip, |node| node.at);
    let after = |nodes: &[Node]| nodes.first().map_or(tip, |node| node.at);
    let axis = ((tip - before(lower)).normalize_or_zero()
        + (tip - after(upper)).normalize_or_zero())
    .normalize_or_zero();
    while lower.len() > 1 && before(lower).distance(tip) < width {
        lower.pop();
    }
    while upper.len() > 1 && after(upper).distance(tip) < width {
        upper.remove(0);
    }
    // Which side of the axis the lower flank lies on.
    let side = axis.perp() * axis.perp_dot(before(lower) - tip).signum();
    let beside = |share: f64, wide: f64| tip + axis * (share * length) + side * (wide * width);
    let node = |at: DVec2| Node { at, bare: at, mark: None, round: 0.0, ..top };
    let stations = [(0.02, 0.5), (0.35, 0.3)];
    lower.extend(stations.map(|(share, wide)| node(beside(share, wide))));
    let back: Vec<Node> =
        stations.iter().rev().map(|&(share, wide)| node(beside(share, -wide))).collect();
    upper.splice(0..0, back);
    top.at = beside(1.0, 0.0);
    top.bare = top.at;
    top.round = 0.0;
    lower.push(top);
}

/// Sets a round gland on the tip of a tooth.
pub(super) fn add_gland(lower: &mut Vec<Node>, upper: &mut Vec<Node>, radius: f64, outward: f64) {
    let mut top = *lower.last().expect("a flank has points");
    let centre = top.at;
    lower.pop();
    while lower.len() > 1 && lower[lower.len() - 1].at.distance(centre) < radius {
        lower.pop();
    }
    while upper.len() > 1 && upper[0].at.distance(centre) < radius {
        upper.remove(0);
    }
    let (Some(a), Some(b)) = (lower.last(), upper.first()) else { return };
    let (start, end) = ((a.at - centre).normalize_or_zero(), (b.at - centre).normalize_or_zero());
    // Round the outside: against the turn from one flank to the other through the tooth.
    let full = std::f64::consts::TAU;
    let mut turn = libm::atan2(start.perp_dot(end), start.dot(end)) * outward;
    if turn < 0.0 {
        turn += full;
    }
    // Leave the flanks a little to either side, so that the gland has a neck.
    let steps = 12;
    top.round = 0.0;
    for i in 1..steps {
        let angle = turn * f64::from(i) / f64::from(steps) * outward;
        let at = centre + radius * DVec2::from_angle(angle).rotate(start);
        let mark = top.mark.filter(|_| i == steps / 2);
        lower.push(Node { at, bare: at, mark, ..top });
    }
}
