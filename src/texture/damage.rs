//! What eats, mines, spots, scorches and tears a blade: decided once, so that every map, the opacity
//! and the outline agree.
//!
//! Wounds lie on the nodes of the guide as signed depths (mm): how far inside a gap a place is. Read
//! in between, they have smooth edges at any size of texture. Shares are of the blade's area, and
//! wounds are added until so much is gone. What stands at a wound's edge dies brown.

mod disease;
mod eaten;
mod fall;
mod texel;

use std::collections::VecDeque;

use glam::DVec2;

pub(super) use self::texel::{Injury, WoundRow};
use super::guide::{Guide, Lattice, Place, between, mixed};
use crate::geometry::polygon;
use crate::margin::Margin;
use crate::parameter::parameters;
use crate::raster::Grid;
use crate::raster::contour::contours;
use crate::seed::{Rng, Seed, Stage};
use crate::units::TextureFrame;
use crate::veins::Venation;

parameters! {
    /// What has happened to a leaf. All 0 for none.
    pub struct DamageSpec {
        /// Share of the blade eaten in holes, which stop at the larger veins.
        holes: number(0.0, 0.0..=0.8, ""),
        /// Share of the blade bitten off from the margin, down to the primary veins.
        margin_bites: number(0.0, 0.0..=0.8, ""),
        /// Share of the blade of which only the veins are left.
        skeletonise: number(0.0, 0.0..=1.0, ""),
        /// Mines between the skins: 1 for eight of them.
        mines: number(0.0, 0.0..=1.0, ""),
        /// Spots of disease: 1 for a hundred and twenty.
        spots: number(0.0, 0.0..=1.0, ""),
        /// Scorching from the margin and tip: at 1 most of the blade.
        scorch: number(0.0, 0.0..=1.0, ""),
        /// Tears from the margin towards the primary veins: 1 for ten of them.
        tears: number(0.0, 0.0..=1.0, ""),
        /// Another seed gives other wounds to the same leaf; 0 for the leaf's own.
        seed: count(0, 0..=9_007_199_254_740_991, ""),
    }
}

impl DamageSpec {
    /// Whether nothing has happened.
    #[must_use]
    pub fn is_none(&self) -> bool {
        let shares = [
            self.holes,
            self.margin_bites,
            self.skeletonise,
            self.mines,
            self.spots,
            self.scorch,
            self.tears,
        ];
        shares.iter().all(|&share| share == 0.0)
    }
}

/// A node of the wounds: depths in a gap, a skeletonised area, a spot, a mine and the line of frass in
/// it (mm, negative outside), how brown and how pale. What has an edge is kept as a depth, so that the
/// edge is as sharp as the texels, not as the nodes.
type Wound = [f32; 7];

const GONE: usize = 0;
const BARE: usize = 1;
const SPOT: usize = 2;
const MINE: usize = 3;
const FRASS: usize = 4;
const BROWN: usize = 5;
const PALE: usize = 6;

/// No wound at all.
const SOUND: Wound = [FAR_MM, FAR_MM, FAR_MM, FAR_MM, FAR_MM, 0.0, 0.0];

/// Far from any gap (mm).
const FAR_MM: f32 = -10.0;

/// The wounds of a leaf on the nodes of its guide.
#[derive(Debug)]
pub(super) struct Wounds {
    side: usize,
    per_texel: f32,
    per_mm: f32,
    nodes: Vec<Wound>,
    rings: Vec<Vec<DVec2>>,
}

impl Wounds {
    /// The wounds of a leaf.
    pub(super) fn new(
        spec: &DamageSpec,
        margin: &Margin,
        venation: &Venation,
        guide: &Guide,
        lattice: &Lattice<'_>,
        per_mm: f32,
        seed: Seed,
    ) -> Self {
        let seed = if spec.seed == 0 { seed } else { Seed(spec.seed) };
        let mut blade = Blade::new(margin, venation, guide, lattice, seed);
        // Who eats comes last: it takes the spots along.
        blade.scorch(spec.scorch);
        blade.spots((spec.spots * 120.0).round() as usize);
        blade.mines((spec.mines * 8.0).round() as usize);
        blade.skeletonise(spec.skeletonise);
        blade.tears((spec.tears * 10.0).round() as usize);
        blade.bites(spec.margin_bites);
        blade.holes(spec.holes);
        blade.let_fall();
        let rings = rings(&blade.nodes, guide, lattice.frame);
        let (side, per_texel) = (guide.side(), guide.per_texel());
        Self { side, per_texel, per_mm, nodes: blade.nodes, rings }
    }

    /// The wounds along row `y` of the texture.
    pub(super) fn row(&self, y: usize) -> WoundRow<'_> {
        let (i, t) = between(y, self.per_texel, self.side);
        let lower = &self.nodes[i * self.side..(i + 1) * self.side];
        let upper = &self.nodes[(i + 1) * self.side..(i + 2) * self.side];
        let nodes = lower.iter().zip(upper).map(|(a, b)| mixed(a, b, t)).collect();
        WoundRow::new(self, nodes)
    }

    /// Whether only veins are left at a texel.
    pub(super) fn is_bare(&self, x: usize, y: usize) -> bool {
        let [(i, _), (j, _)] = [x, y].map(|texel| between(texel, self.per_texel, self.side));
        let near = [0, 1, self.side, self.side + 1];
        near.iter().any(|step| self.nodes[j * self.side + i + step][BARE] > 0.0)
    }

    /// The outline of what is left of the blade, and of the gaps in it (mm): simple rings,
    /// anticlockwise around tissue, clockwise around gaps. Skeletonised areas count as tissue.
    pub(super) fn rings(&self) -> &[Vec<DVec2>] {
        &self.rings
    }
}

/// A piece or a gap is no smaller than this (cells of the guide's nodes).
const LEAST_RING_NODES: f64 = 1.0;

fn rings(nodes: &[Wound], guide: &Guide, frame: &TextureFrame) -> Vec<Vec<DVec2>> {
    if nodes.iter().all(|node| node[GONE] <= 0.0) {
        return Vec::new();
    }
    let side = guide.side();
    let depth = |(i, node): (usize, &Wound)| guide.node(i).edge.min(-node[GONE]);
    let field = Grid::from_values(side, side, nodes.iter().enumerate().map(depth).collect());
    let in_mm = |mut ring: Vec<DVec2>| {
        for p in &mut ring {
            *p = frame.leaf_from_pixel(*p, side);
        }
        // Rows run down and leaves up: the turn is the other way.
        ring.reverse();
        ring
    };
    // What is smaller than a cell is the end of a tooth that passes between two nodes: nothing has come off there.
    let seen = |ring: &Vec<DVec2>| polygon::signed_area(ring).abs() >= LEAST_RING_NODES;
    contours(&field, 0.0).into_iter().filter(seen).map(in_mm).collect()
}

/// A blade that is being hurt.
struct Blade<'a> {
    margin: &'a Margin,
    guide: &'a Guide,
    lattice: &'a Lattice<'a>,
    /// Distance to the nearest primary vein (mm).
    primary: Vec<f32>,
    /// Nodes inside the margin.
    inside: usize,
    /// √area (mm): what sizes are measured by.
    breadth: f32,
    nodes: Vec<Wound>,
    rng: Rng,
}

impl<'a> Blade<'a> {
    fn new(
        margin: &'a Margin,
        venation: &Venation,
        guide: &'a Guide,
        lattice: &'a Lattice<'a>,
        seed: Seed,
    ) -> Self {
        let count = guide.side() * guide.side();
        Self {
            margin,
            guide,
            lattice,
            primary: lattice.vein_distances(venation, 1),
            inside: (0..count).filter(|&i| guide.node(i).edge > 0.0).count(),
            breadth: margin.area_mm2().sqrt() as f32,
            nodes: vec![SOUND; count],
            rng: seed.stream(Stage::Damage),
        }
    }

    fn place(&self, i: usize) -> Place {
        self.guide.node(i)
    }

    /// Where a node lies (mm).
    fn at(&self, i: usize) -> DVec2 {
        self.lattice.leaf(i % self.guide.side(), i / self.guide.side())
    }

    /// The node nearest to a point of the frame (mm).
    fn node_at(&self, p: DVec2) -> usize {
        self.lattice.nearest_node(p)
    }

    fn uniform(&mut self, low: f32, high: f32) -> f32 {
        self.rng.between(f64::from(low), f64::from(high)) as f32
    }

    /// A random node inside the blade.
    fn dart(&mut self) -> usize {
        let bounds = self.margin.bounds();
        for _ in 0..1000 {
            let x = self.rng.between(bounds.min.x, bounds.max.x);
            let p = DVec2::new(x, self.rng.between(bounds.min.y, bounds.max.y));
            let node = self.node_at(p);
            if self.place(node).edge > 0.0 {
                return node;
            }
        }
        self.node_at(DVec2::new(0.0, 0.5 * self.margin.length_mm()))
    }

    /// The nodes around `start` that are reached over nodes of depth above 0, and those at their
    /// border, with their depths; `limit` bounds the walk.
    fn patch(&self, start: usize, depth: impl Fn(usize) -> f32, limit: usize) -> Vec<(usize, f32)> {
        let side = self.guide.side();
        let mut seen = std::collections::BTreeSet::from([start]);
        let mut queue = VecDeque::from([start]);
        let mut patch = Vec::new();
        while let Some(node) = queue.pop_front() {
            let here = depth(node);
            patch.push((node, here));
            // Three nodes past the border: there the depth says how near the gap is.
            if here < -3.0 * self.lattice.spacing() as f32 || patch.len() > limit {
                continue;
            }
            let (x, y) = (node % side, node / side);
            let around = [
                (x > 0, node.wrapping_sub(1)),
                (x + 1 < side, node + 1),
                (y > 0, node.wrapping_sub(side)),
                (y + 1 < side, node + side),
            ];
            for (exists, next) in around {
                // From outside one does not come in again: what a vein cuts off stays.
                let crosses = here <= 0.0 && exists && depth(next) > here.max(-0.5);
                if exists && !crosses && seen.insert(next) {
                    queue.push_back(next);
                }
            }
        }
        patch
    }

    /// How much more of the blade a patch would take, in nodes.
    fn gain(&self, patch: &[(usize, f32)], layer: usize) -> usize {
        let taken = |&(node, depth): &(usize, f32)| {
            depth > 0.0
                && self.nodes[node][layer] <= 0.0
                && self.nodes[node][GONE] <= 0.0
                && self.place(node).edge > 0.0
        };
        patch.iter().filter(|entry| taken(entry)).count()
    }

    fn apply(&mut self, patch: &[(usize, f32)], layer: usize) {
        for &(node, depth) in patch {
            let slot = &mut self.nodes[node][layer];
            *slot = slot.max(depth);
        }
    }

    /// Adds patches that `propose` makes at a scale, until a share of the blade is taken.
    fn until(
        &mut self,
        share: f64,
        layer: usize,
        mut propose: impl FnMut(&mut Self, f32) -> Vec<(usize, f32)>,
    ) {
        let wanted = share * self.inside as f64;
        let (mut taken, mut scale) = (0.0, 1.0);
        for _ in 0..600 {
            if taken >= 0.96 * wanted {
                break;
            }
            let patch = propose(self, scale);
            let gain = self.gain(&patch, layer) as f64;
            // The last ones are smaller, so that no more is taken than was asked for.
            if taken + gain > 1.05 * wanted {
                scale = (scale * 0.8_f32).max(0.08);
                continue;
            }
            self.apply(&patch, layer);
            taken += gain;
        }
    }
}
