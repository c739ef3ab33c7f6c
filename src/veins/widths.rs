//! Radii of the veins, from the tips to the petiole.
//!
//! Source: Murray, "The physiological principle of minimum work", PNAS 12, 1926: where veins of radii
//! r₁ … rₙ meet, the parent has rᵉ = r₁ᵉ + … + rₙᵉ, with e = 3 for laminar flow. Foster prints the law
//! without the sum.

use super::graph::VeinGraph;

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
    use glam::DVec2;

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
}
