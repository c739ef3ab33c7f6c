//! Colour that spreads from the veins, each of them on a lattice as coarse as its reach allows.

use std::ops::Range;

use super::Reach;
use super::lattice::{Cone, Lattice};
use super::smooth::refined;
use crate::raster::coverage::Capsule;
use crate::texture::fields::BRANCH_FLARE;
use crate::veins::Venation;

/// Colour that spreads from a vein further than so many nodes of a lattice (the vein itself is a fifteenth
/// of that wide) lies on one with half as many, where the crest of a narrower one would come and go between the
/// nodes; a faint colour does so unseen.
const WIDE_NODES: f32 = 16.0;

/// Colour that spreads no further than this is never drawn on a lattice twice as coarse.
const NARROW_NODES: f32 = 4.0;

/// Where fine veins are faint, from this radius on (mm) a vein's colour is full: that of a tertiary.
const FULL_MM: f64 = 0.09;

/// Weights of the colour that spreads from the veins (0–1).
pub(super) struct Spread {
    /// On the nodes of the fine lattice, that of narrow veins; where there are any.
    pub(super) narrow: Option<Vec<f32>>,
    /// On the nodes of the coarse lattice, that of all others.
    pub(super) wide: Vec<f32>,
}

impl Spread {
    pub(super) fn new(
        fine: &Lattice<'_>,
        coarse: &Lattice<'_>,
        venation: &Venation,
        reach: &Reach<'_>,
    ) -> Self {
        let edges = coarse_edges(venation, reach.vein_spread);
        let far = (WIDE_NODES * reach.vein_strength).max(NARROW_NODES);
        let half = Lattice { frame: coarse.frame, side: (coarse.side / 2).max(2) };
        // A vein reaches half as many nodes of a lattice with half as many.
        let on =
            |lattice: &Lattice<'_>, of: &Lattice<'_>| far * lattice.side as f32 / of.side as f32;
        let drawn = |lattice: &Lattice<'_>, reaches: Range<f32>| {
            let cones = cones(lattice, venation, &edges, reach, &reaches);
            (!cones.is_empty()).then(|| lattice.weights(&cones))
        };
        let narrow = drawn(fine, 0.0..far);
        let middle = drawn(coarse, on(coarse, fine)..far);
        let wide = drawn(&half, on(&half, coarse)..f32::INFINITY);
        let wide = wide.map(|wide| refined(&wide, half.side, coarse.side));
        let wide = match (middle, wide) {
            (Some(middle), Some(mut wide)) => {
                // By comparison: `max` is twice as slow.
                let both = wide.iter_mut().zip(middle);
                both.for_each(|(a, b)| *a = if b > *a { b } else { *a });
                wide
            }
            (middle, wide) => {
                middle.or(wide).unwrap_or_else(|| vec![0.0; coarse.side * coarse.side])
            }
        };
        Self { narrow, wide }
    }
}

/// For some vein edges whose colour reaches so far (nodes), what is w = h (1 − distance / (spread × width)). The
/// height h is 1; where fine veins are faint, it falls with the width.
fn cones(
    lattice: &Lattice<'_>,
    venation: &Venation,
    edges: &[(u32, u32)],
    reach: &Reach<'_>,
    far: &Range<f32>,
) -> Vec<Cone> {
    let &Reach { vein_spread: spread, faint_veins, .. } = reach;
    let per_mm = lattice.frame.pixels_per_mm(lattice.side);
    let position = |node: u32| {
        let p = venation.graph().positions()[node as usize];
        lattice.frame.pixel_from_leaf(p, lattice.side).as_vec2()
    };
    let reach = |node: u32| 2.0 * spread * venation.radii()[node as usize] * per_mm;
    let cone = |(a, b): (u32, u32)| {
        let capsule = Capsule {
            a: position(a),
            b: position(b),
            radius_a: reach(a).min(reach(b) * BRANCH_FLARE) as f32,
            radius_b: reach(b) as f32,
        };
        let width = venation.radii()[b as usize] / FULL_MM;
        (capsule, if faint_veins { (width * width).min(1.0) as f32 } else { 1.0 })
    };
    let cones = edges.iter().copied().map(cone);
    cones.filter(|(cone, _)| far.contains(&cone.widest())).collect()
}

/// An edge is short at this share of the reach: from its chord a vein strays by a hundredth of that.
const SHORT: f64 = 0.3;

/// The vein edges with short ones in a row replaced by one, as long as it is short against the
/// reach of the colour: a midrib of 300 nodes would otherwise paint 300 overlapping discs. None where no colour
/// spreads.
fn coarse_edges(venation: &Venation, spread: f64) -> Vec<(u32, u32)> {
    if spread <= 0.0 {
        return Vec::new();
    }
    let graph = venation.graph();
    let children = graph.child_counts();
    // The last node on the way to each node from which no edge has been drawn yet.
    let mut start: Vec<u32> = (0..graph.len() as u32).collect();
    let mut edges = Vec::new();
    for (parent, child) in graph.edges() {
        let from = start[parent as usize];
        let length = graph.positions()[from as usize].distance(graph.positions()[child as usize]);
        let reach = 2.0 * spread * venation.radii()[child as usize];
        if length < SHORT * reach && children[child as usize] > 0 {
            start[child as usize] = from;
        } else {
            edges.push((from, child));
        }
    }
    edges.extend(graph.joins());
    edges
}
