//! Distances and weights on the nodes of the guide.

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use crate::raster::Grid;
use crate::raster::coverage::Capsule;
use crate::raster::distance::{NO_SITE, nearest_sites};
use crate::texture::fields::BRANCH_FLARE;
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Where "far away" ends (mm), for leaves without the thing that a distance is to.
const FAR_MM: f32 = 1e4;

pub(super) type Line = (DVec2, DVec2);

pub(super) fn vein_lines(venation: &Venation, wanted: impl Fn(u8) -> bool) -> Vec<Line> {
    let graph = venation.graph();
    let at = |node: u32| graph.positions()[node as usize];
    graph
        .edges()
        .chain(graph.joins().iter().copied())
        .filter(|&(_, child)| wanted(venation.orders()[child as usize]))
        .map(|(a, b)| (at(a), at(b)))
        .collect()
}

/// The nodes of the guide in leaf space.
pub(in crate::texture) struct Lattice<'a> {
    pub frame: &'a TextureFrame,
    pub side: usize,
}

impl Lattice<'_> {
    /// Distance from every node to the nearest vein up to an order (mm).
    pub(in crate::texture) fn vein_distances(&self, venation: &Venation, order: u8) -> Vec<f32> {
        self.distances(&vein_lines(venation, |of| of <= order), |_| true)
    }

    /// The node nearest to a point of the frame (mm).
    pub(in crate::texture) fn nearest_node(&self, p: DVec2) -> usize {
        let pixel = self.frame.pixel_from_leaf(p, self.side);
        let clamp = |v: f64| (v.max(0.0) as usize).min(self.side - 1);
        clamp(pixel.y) * self.side + clamp(pixel.x)
    }

    /// The nodes in the box around a line, `reach` away from it at most (mm).
    pub(in crate::texture) fn nodes_near(&self, a: DVec2, b: DVec2, reach: f64) -> Vec<usize> {
        let [a, b] = [a, b].map(|p| self.frame.pixel_from_leaf(p, self.side).as_vec2());
        let reach = (reach / self.spacing()) as f32;
        let capsule = Capsule { a, b, radius_a: reach, radius_b: reach };
        let [columns, rows] = capsule.pixels(reach, self.side, 0..self.side);
        rows.flat_map(|y| columns.clone().map(move |x| y * self.side + x)).collect()
    }

    pub(in crate::texture) fn leaf(&self, x: usize, y: usize) -> DVec2 {
        self.frame.leaf_from_pixel(DVec2::new(x as f64 + 0.5, y as f64 + 0.5), self.side)
    }

    /// From node to node (mm).
    pub(in crate::texture) fn spacing(&self) -> f64 {
        self.frame.side_mm / self.side as f64
    }

    /// Distance from every node that is `wanted` to the nearest of some lines (mm); others are far.
    pub(super) fn distances(
        &self,
        lines: &[Line],
        wanted: impl Fn(usize) -> bool + Sync,
    ) -> Vec<f32> {
        let near = Near::new(self, lines);
        let (side, spacing) = (self.side, self.spacing() as f32);
        let mut distances = vec![FAR_MM; side * side];
        distances.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
            for (x, distance) in row.iter_mut().enumerate() {
                if wanted(y * side + x) && near.sites[(x, y)] != NO_SITE {
                    *distance = near.distance(x, y) * spacing;
                }
            }
        });
        distances
    }

    /// Distance from every node to the nearest of some lines (mm), negative outside the outline; there
    /// only to a cell, when it is more than `exact`.
    pub(super) fn signed_distances(
        &self,
        lines: &[Line],
        outline: &[Line],
        exact: f32,
    ) -> Vec<f32> {
        let near = Near::new(self, lines);
        let (side, spacing) = (self.side, self.spacing() as f32);
        let mut distances = vec![-FAR_MM; side * side];
        distances.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
            let height = self.leaf(0, y).y;
            let mut crossings: Vec<f64> = outline
                .iter()
                .filter(|(a, b)| (a.y > height) != (b.y > height))
                .map(|(a, b)| a.x + (b.x - a.x) * (height - a.y) / (b.y - a.y))
                .collect();
            crossings.sort_by(f64::total_cmp);
            let mut passed = 0;
            for (x, distance) in row.iter_mut().enumerate() {
                let at = self.leaf(x, y).x;
                while passed < crossings.len() && crossings[passed] <= at {
                    passed += 1;
                }
                let site = near.sites[(x, y)];
                if site == NO_SITE {
                    continue;
                }
                if passed % 2 == 1 {
                    *distance = near.distance(x, y) * spacing;
                    continue;
                }
                let (sx, sy) = (site as usize % side, site as usize / side);
                let cells = Vec2::new(x.abs_diff(sx) as f32, y.abs_diff(sy) as f32).length();
                // A cell's line may pass a cell nearer than its centre.
                let far = (cells - 1.5) * spacing > exact;
                *distance = -spacing * if far { cells } else { near.distance(x, y) };
            }
        });
        distances
    }

    /// The largest w = 1 − distance / (spread × width) over all veins.
    pub(super) fn vein_weights(&self, venation: &Venation, spread: f64) -> Vec<f32> {
        let mut weights = vec![0.0_f32; self.side * self.side];
        if spread <= 0.0 {
            return weights;
        }
        let per_mm = self.frame.pixels_per_mm(self.side);
        for (a, b) in coarse_edges(venation, spread) {
            let position = |node: u32| {
                let p = venation.graph().positions()[node as usize];
                self.frame.pixel_from_leaf(p, self.side).as_vec2()
            };
            let reach = |node: u32| 2.0 * spread * venation.radii()[node as usize] * per_mm;
            let capsule = Capsule {
                a: position(a),
                b: position(b),
                radius_a: reach(a).min(reach(b) * BRANCH_FLARE) as f32,
                radius_b: reach(b) as f32,
            };
            self.add_cone(&mut weights, &capsule);
        }
        weights
    }

    /// The largest w = 1 − distance / reach over all speckles.
    pub(super) fn speckle_weights(&self, speckles: &[DVec2], reach_mm: f64) -> Vec<f32> {
        let mut weights = vec![0.0_f32; self.side * self.side];
        let reach = (reach_mm * self.frame.pixels_per_mm(self.side)) as f32;
        if reach <= 0.0 {
            return weights;
        }
        for &speckle in speckles {
            let a = self.frame.pixel_from_leaf(speckle, self.side).as_vec2();
            self.add_cone(&mut weights, &Capsule { a, b: a, radius_a: reach, radius_b: reach });
        }
        weights
    }

    fn add_cone(&self, weights: &mut [f32], capsule: &Capsule) {
        let [columns, rows] = capsule.pixels(capsule.widest(), self.side, 0..self.side);
        let Capsule { a, b, radius_a, radius_b } = *capsule;
        let along = b - a;
        let length2 = along.length_squared();
        let per_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        let first = columns.start as i32;
        for y in rows {
            let row = &mut weights[y * self.side..][columns.clone()];
            let dy = y as f32 + 0.5 - a.y;
            // Without a branch, so that several nodes can be weighed at once.
            for (i, weight) in row.iter_mut().enumerate() {
                let dx = (first + i as i32) as f32 + 0.5 - a.x;
                let t = ((dx * along.x + dy * along.y) * per_length2).clamp(0.0, 1.0);
                let (ex, ey) = (dx - along.x * t, dy - along.y * t);
                let reach = (radius_a + (radius_b - radius_a) * t).max(1e-6);
                let own = 1.0 - (ex * ex + ey * ey).sqrt() / reach;
                *weight = if own > *weight { own } else { *weight };
            }
        }
    }
}

/// Which of some lines is near each node; lengths are in nodes.
struct Near {
    lines: Vec<[Vec2; 2]>,
    /// A line that passes the cell of a node.
    line_at: Vec<u32>,
    /// The cell nearest to a node that a line passes.
    sites: Grid<u32>,
}

impl Near {
    fn new(lattice: &Lattice<'_>, lines: &[Line]) -> Self {
        const NO_LINE: u32 = u32::MAX;
        let side = lattice.side;
        let node = |p: DVec2| lattice.frame.pixel_from_leaf(p, side).as_vec2();
        let lines: Vec<[Vec2; 2]> = lines.iter().map(|&(a, b)| [node(a), node(b)]).collect();
        // Note in each cell a line that passes it; where several do, they are near each other.
        let mut line_at = vec![NO_LINE; side * side];
        for (i, &[a, b]) in lines.iter().enumerate() {
            let steps = (a.distance(b) * 2.0) as usize + 1;
            for step in 0..=steps {
                let cell = a.lerp(b, step as f32 / steps as f32);
                let clamp = |v: f32| (v.max(0.0) as usize).min(side - 1);
                let slot = &mut line_at[clamp(cell.y) * side + clamp(cell.x)];
                if *slot == NO_LINE {
                    *slot = i as u32;
                }
            }
        }
        let sites = nearest_sites(side, side, |i| line_at[i] != NO_LINE);
        Self { lines, line_at, sites }
    }

    /// From a node to the nearest line, where there is one.
    fn distance(&self, x: usize, y: usize) -> f32 {
        let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let i = self.line_at[self.sites[(x, y)] as usize] as usize;
        // The neighbours in the list continue the line: the nearest may be one of them.
        let near = self.lines[i.saturating_sub(1)..(i + 2).min(self.lines.len())].iter();
        let least = near
            .map(|&[a, b]| Capsule { a, b, radius_a: 0.0, radius_b: 0.0 }.nearest(p).0)
            .fold(f32::INFINITY, f32::min);
        least.sqrt()
    }
}

/// The vein edges with short ones in a row replaced by one, as long as it is short against the
/// reach of the colour: a midrib of 300 nodes would otherwise paint 300 overlapping discs.
fn coarse_edges(venation: &Venation, spread: f64) -> Vec<(u32, u32)> {
    let graph = venation.graph();
    let children = graph.child_counts();
    // The last node on the way to each node from which no edge has been drawn yet.
    let mut start: Vec<u32> = (0..graph.len() as u32).collect();
    let mut edges = Vec::new();
    for (parent, child) in graph.edges() {
        let from = start[parent as usize];
        let length = graph.positions()[from as usize].distance(graph.positions()[child as usize]);
        let reach = 2.0 * spread * venation.radii()[child as usize];
        if length < 0.12 * reach && children[child as usize] > 0 {
            start[child as usize] = from;
        } else {
            edges.push((from, child));
        }
    }
    edges.extend(graph.joins());
    edges
}
