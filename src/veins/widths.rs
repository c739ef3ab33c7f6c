//! Radii of the veins, from the tips to the petiole.
//!
//! Sources: Murray, "The physiological principle of minimum work", PNAS 12, 1926: where veins of radii
//! r₁ … rₙ meet, the parent has rᵉ = r₁ᵉ + … + rₙᵉ, with e = 3 for laminar flow. Foster prints the law
//! without the sum. Departs from it where asked: e may change with the order of the parent, the finest
//! veins have a floor, a vein may taper evenly between its branches, not in a step at each, and one that ends on
//! another keeps some of its width.

use glam::DVec2;

use super::graph::{NodeId, VeinGraph};
use super::{VeinError, VeinSpec, Widths, flow, orders};
use crate::observer::Observer;

/// Murray's exponent is never less (areas and more are kept) nor more (nearly nothing is).
const EXPONENTS: std::ops::RangeInclusive<f64> = 1.0..=10.0;

/// The radius (mm) and the order of the vein at each node, as `spec` says, tips of `tip_radius_mm`.
///
/// # Errors
///
/// Those of [`flow::radii`].
pub fn radii_and_orders(
    spec: &VeinSpec,
    graph: &VeinGraph,
    tip_radius_mm: f64,
    observer: &mut dyn Observer,
) -> Result<(Vec<f64>, Vec<u8>), VeinError> {
    let (mut radii, mut orders) = of_tree(spec, graph, tip_radius_mm);
    if spec.widths == Widths::Flow {
        let floor = spec.least_radius_mm.max(tip_radius_mm);
        radii = flow::radii(graph, &radii, floor, spec.fluctuation, observer)?;
        orders = orders::by_width(graph, &radii);
    }
    if spec.taper > 0.0 {
        taper(graph, &orders, &mut radii, spec.taper);
    }
    if spec.joined_width > 0.0 && spec.widths == Widths::Murray {
        widen_joined(graph, &orders, &mut radii, spec.joined_width);
    }
    radii.iter_mut().for_each(|radius| *radius = radius.max(spec.least_radius_mm));
    Ok((radii, orders))
}

/// The same by Murray's law, whatever `veins.widths` says, without taper.
#[must_use]
pub fn of_tree(spec: &VeinSpec, graph: &VeinGraph, tip_radius_mm: f64) -> (Vec<f64>, Vec<u8>) {
    let mut radii = murray(graph, tip_radius_mm, spec.murray_exponent);
    let mut orders = orders::by_width(graph, &radii);
    if spec.exponent_change != 0.0 {
        let exponent = |order: u8| {
            let exponent = spec.murray_exponent + spec.exponent_change * f64::from(order - 1);
            exponent.clamp(*EXPONENTS.start(), *EXPONENTS.end())
        };
        radii = murray_by_order(graph, &orders, tip_radius_mm, exponent);
        orders = orders::by_width(graph, &radii);
    }
    radii.iter_mut().for_each(|radius| *radius = radius.max(spec.least_radius_mm));
    (radii, orders)
}

/// Radius of the vein at each node (mm); tips have `tip_radius_mm`. Loop-closing edges carry no
/// flow. One pass in reverse order of birth.
#[must_use]
pub fn murray(graph: &VeinGraph, tip_radius_mm: f64, exponent: f64) -> Vec<f64> {
    // In units of the tip every tip contributes 1, whatever the exponent.
    let mut flow = vec![0.0f64; graph.len()];
    for node in (0..graph.len()).rev() {
        if flow[node] == 0.0 {
            flow[node] = 1.0;
        }
        if let Some(parent) = graph.parent(node as u32) {
            flow[parent as usize] += flow[node];
        }
    }
    flow.into_iter().map(|flow| radius(tip_radius_mm, flow, exponent)).collect()
}

/// The same with an exponent that depends on the order of the vein that divides.
#[must_use]
pub fn murray_by_order(
    graph: &VeinGraph,
    orders: &[u8],
    tip_radius_mm: f64,
    exponent: impl Fn(u8) -> f64,
) -> Vec<f64> {
    let counts = graph.child_counts();
    // Of the children seen so far: the widest, and the sum at a fork, in units of the tip.
    let mut widest = vec![0.0f64; graph.len()];
    let mut sums = vec![0.0f64; graph.len()];
    for node in (0..graph.len()).rev() {
        widest[node] = match counts[node] {
            0 => 1.0,
            // A vein that goes on keeps its radius, to the last bit.
            1 => widest[node],
            // Rounding must not make it thinner than a child.
            _ => root(sums[node], exponent(orders[node])).max(widest[node]),
        };
        if let Some(parent) = graph.parent(node as NodeId).map(|id| id as usize) {
            if counts[parent] > 1 {
                sums[parent] += libm::pow(widest[node], exponent(orders[parent]));
            }
            widest[parent] = widest[parent].max(widest[node]);
        }
    }
    widest.into_iter().map(|radius| radius * tip_radius_mm).collect()
}

/// Makes every vein taper evenly from a branch to the next (by `share` of the way from Murray's
/// steps), and towards its tip. Radii only grow, so none falls below a child's.
fn taper(graph: &VeinGraph, orders: &[u8], radii: &mut [f64], share: f64) {
    let heirs = orders::heirs(graph, orders);
    let position = |node: NodeId| graph.positions()[node as usize];
    let begins = |&node: &NodeId| {
        graph.parent(node).is_none_or(|parent| heirs[parent as usize] != Some(node))
    };
    for start in (0..graph.len() as NodeId).filter(begins) {
        let vein: Vec<NodeId> =
            std::iter::successors(Some(start), |&node| heirs[node as usize]).collect();
        let steps: Vec<f64> = vein.iter().map(|&node| radii[node as usize]).collect();
        let mut from = 0;
        while from + 1 < vein.len() {
            // The stretch as far as the radius is that after the step.
            let end = (from + 1..vein.len()).take_while(|&i| steps[i] == steps[from + 1]);
            let to = end.last().unwrap_or(from + 1);
            let points: Vec<DVec2> = vein[from..=to].iter().map(|&node| position(node)).collect();
            let total: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
            let excess = share * (steps[from] - steps[to]).max(0.0);
            let mut left = total;
            for i in from + 1..to {
                left -= points[i - from - 1].distance(points[i - from]);
                radii[vein[i] as usize] = steps[to] + excess * (left / total).max(0.0);
            }
            from = to;
        }
    }
}

/// Midribs and secondaries thin towards their ends wherever these lie; from this order on a vein may be a rung.
const RUNG: u8 = 3;

/// Keeps every finer vein that ends on another by at least `share` of its radius at its beginning: water may come from
/// either end, and a rung between two veins is no thorn on one. Radii only grow, and none beyond that at the beginning.
fn widen_joined(graph: &VeinGraph, orders: &[u8], radii: &mut [f64], share: f64) {
    let heirs = orders::heirs(graph, orders);
    let counts = graph.child_counts();
    let ends = graph.joins().iter().flat_map(|&(a, b)| [a, b]);
    let is_rung = |node: NodeId| counts[node as usize] == 0 && orders[node as usize] >= RUNG;
    for end in ends.filter(|&node| is_rung(node)) {
        let before = |&node: &NodeId| {
            graph.parent(node).filter(|&parent| heirs[parent as usize] == Some(node))
        };
        let vein: Vec<NodeId> = std::iter::successors(Some(end), before).collect();
        let least = vein.last().map_or(0.0, |&first| share * radii[first as usize]);
        for node in vein {
            let radius = &mut radii[node as usize];
            *radius = radius.max(least);
        }
    }
}

/// Radius of a vein that carries the flow of so many tips (mm).
#[must_use]
pub fn radius(tip_radius_mm: f64, tips: f64, exponent: f64) -> f64 {
    tip_radius_mm * root(tips, exponent)
}

/// The `exponent`-th root. `libm` gives the same bits on every machine; it is monotone enough for a
/// radius never to shrink, because flows are whole numbers of tips.
fn root(flow: f64, exponent: f64) -> f64 {
    if exponent == 3.0 { libm::cbrt(flow) } else { libm::pow(flow, 1.0 / exponent) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::observer::Silent;

    #[test]
    fn the_cubes_at_a_fork_add_up() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let fork = graph.sprout(root, DVec2::Y);
        for i in 0..3 {
            let mut tip = graph.sprout(fork, DVec2::new(f64::from(i), 2.0));
            tip = graph.sprout(tip, DVec2::new(f64::from(i), 3.0));
            graph.sprout(tip, DVec2::new(f64::from(i), 4.0));
        }
        let radii = murray(&graph, 0.5, 3.0);
        assert_eq!(radii[fork as usize], 0.5 * libm::cbrt(3.0));
        assert_eq!(radii[root as usize], radii[fork as usize]);
        assert!(radii[2..].iter().all(|&r| r == 0.5));
        assert_eq!(murray(&graph, 1.0, 1.0)[0], 3.0);
    }

    /// A trunk with a fork into a limb with two tips, and a tip.
    fn limb() -> (VeinGraph, [NodeId; 6]) {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let fork = graph.sprout(root, DVec2::Y);
        let limb = graph.sprout(fork, DVec2::new(0.0, 2.0));
        let tips = [(0.0, 3.0), (1.0, 3.0)].map(|p| graph.sprout(limb, DVec2::from(p)));
        let side = graph.sprout(fork, DVec2::new(-1.0, 2.0));
        (graph, [root, fork, limb, tips[0], tips[1], side])
    }

    #[test]
    fn a_vein_that_ends_on_another_keeps_a_share_of_its_width() {
        let (mut graph, [root, fork, limb, left, right, side]) = limb();
        // The left tip is the limb's heir, and ends on the side vein.
        graph.join(side, left);
        let murray = murray(&graph, 0.5, 3.0);
        let mut secondary = murray.clone();
        widen_joined(&graph, &[1, 1, 2, 2, 3, 2], &mut secondary, 1.0);
        assert_eq!(secondary, murray);
        let orders = [1, 1, 3, 3, 4, 3];
        for share in [0.5, 0.9, 1.0] {
            let mut radii = murray.clone();
            widen_joined(&graph, &orders, &mut radii, share);
            let expected = (share * murray[limb as usize]).max(0.5);
            assert_eq!(radii[left as usize], expected);
            for node in [root, fork, limb, right, side] {
                assert_eq!(radii[node as usize], murray[node as usize], "{node}");
            }
        }
    }

    #[test]
    fn each_order_has_its_exponent() {
        let (graph, [root, fork, limb, ..]) = limb();
        let orders = [1, 1, 2, 2, 3, 2];
        let radii = murray_by_order(&graph, &orders, 0.5, |order| f64::from(order) + 1.0);
        let expected = libm::cbrt(2.0);
        assert!((radii[limb as usize] / 0.5 - expected).abs() < 1e-15);
        let expected = (expected * expected + 1.0).sqrt();
        assert!((radii[fork as usize] / 0.5 - expected).abs() < 1e-15);
        assert_eq!(radii[root as usize], radii[fork as usize]);
        let same = murray_by_order(&graph, &orders, 0.5, |_| 3.0);
        let murray = murray(&graph, 0.5, 3.0);
        assert!(same.iter().zip(&murray).all(|(a, b)| (a - b).abs() < 1e-15), "{same:?}");
    }

    #[test]
    fn the_floor_lifts_the_finest_veins_only() {
        let (graph, [root, _, limb, tip, ..]) = limb();
        let spec = VeinSpec { tip_radius_mm: 0.1, least_radius_mm: 0.12, ..VeinSpec::default() };
        let (radii, _) = radii_and_orders(&spec, &graph, 0.1, &mut Silent).expect("radii");
        let [tip, limb, root] = [tip, limb, root].map(|node| radii[node as usize]);
        assert_eq!([tip, limb, root], [0.12, 0.1 * libm::cbrt(2.0), 0.1 * libm::cbrt(3.0)]);
    }

    #[test]
    fn a_vein_tapers_evenly_between_branches() {
        let mut graph = VeinGraph::new();
        let mut midrib = vec![graph.add_root(DVec2::ZERO)];
        for i in 1..=8 {
            midrib.push(graph.sprout(midrib[i - 1], DVec2::new(0.0, i as f64)));
        }
        graph.sprout(midrib[4], DVec2::new(1.0, 5.0));
        let orders = orders::by_width(&graph, &murray(&graph, 0.5, 1.0));
        let mut radii = murray(&graph, 0.5, 1.0);
        taper(&graph, &orders, &mut radii, 1.0);
        let along: Vec<f64> = midrib.iter().map(|&node| radii[node as usize]).collect();
        assert_eq!(along, [1.0, 1.0, 1.0, 1.0, 1.0, 0.875, 0.75, 0.625, 0.5]);
    }
}
