//! The slowly varying fields of a leaf on a coarse grid, read by interpolation.
//!
//! Distances: the distance transform says which node's cell holds the nearest line, and the distance
//! is measured to that line itself. The cell is known by its centre only, so where two stretches are
//! about equally far the wrong one may be taken, and between the nodes a ridge is cut off. On a lobed
//! outline the error stayed below 0.07 node spacings (a seventh of a texel) near the margin and below
//! 0.36 deep inside, where nothing sharp depends on it; a test holds both.

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use super::fields::BRANCH_FLARE;
use crate::geometry::noise;
use crate::geometry::polygon;
use crate::margin::Margin;
use crate::raster::coverage::Capsule;
use crate::raster::distance::{NO_SITE, nearest_sites};
use crate::units::TextureFrame;
use crate::veins::Venation;

/// What the guide knows about one place.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Place {
    /// Distance to the margin or a slit (mm), negative outside the blade.
    pub edge: f32,
    /// Distance to the nearest primary or secondary vein (mm).
    pub major: f32,
    /// Distance to the nearest vein (mm).
    pub vein: f32,
    /// Weight of the colour that spreads from the veins (0–1).
    pub from_veins: f32,
    /// Weight of the colour of the speckles (0–1).
    pub speckle: f32,
    /// Broad, middle and fine noise (−1 – 1).
    pub noise: [f32; 3],
}

impl Place {
    #[inline]
    fn array(self) -> [f32; 8] {
        let [a, b, c] = self.noise;
        [self.edge, self.major, self.vein, self.from_veins, self.speckle, a, b, c]
    }

    #[inline]
    fn of([edge, major, vein, from_veins, speckle, a, b, c]: [f32; 8]) -> Self {
        Self { edge, major, vein, from_veins, speckle, noise: [a, b, c] }
    }
}

/// Where "far away" ends (mm), for leaves without the thing that a distance is to.
const FAR_MM: f32 = 1e4;

/// Feature sizes of the three noises (mm): across the leaf, between secondaries, around areoles.
const NOISE_MM: [f32; 3] = [16.0, 4.5, 1.6];

/// The coarse grid.
#[derive(Debug)]
pub(super) struct Guide {
    side: usize,
    per_texel: f32,
    nodes: Vec<[f32; 8]>,
}

/// The reach of the schemes that spread from things.
#[derive(Debug)]
pub(super) struct Reach<'a> {
    pub vein_spread: f64,
    pub speckles: &'a [DVec2],
    pub speckle_mm: f64,
}

impl Guide {
    /// Half the texture's resolution serves: every field is smooth over two texels, or covered by
    /// the vein that it is sharp at. Past 1024 nodes a side the leaf has nothing finer to say.
    fn side_for(size: usize) -> usize {
        (size / 2).clamp(16, 1024)
    }

    pub(super) fn new(
        margin: &Margin,
        venation: &Venation,
        frame: &TextureFrame,
        size: usize,
        reach: &Reach<'_>,
        seed: u32,
    ) -> Self {
        let side = Self::side_for(size);
        let lattice = Lattice { frame, side };
        let outline: Vec<_> = polygon::edges(margin.outline()).collect();
        let slits = margin.cuts().iter().flat_map(|cut| cut.windows(2).map(|w| (w[0], w[1])));
        let edges: Vec<_> = outline.iter().copied().chain(slits).collect();
        let veins: Vec<_> = vein_lines(venation, |_| true);
        let major: Vec<_> = vein_lines(venation, |order| order <= 2);
        let mut fields: Vec<Vec<f32>> =
            [&edges, &major, &veins].par_iter().map(|lines| lattice.distances(lines)).collect();
        lattice.negate_outside(&outline, &mut fields[0]);
        let from_veins = lattice.vein_weights(venation, reach.vein_spread);
        let speckle = lattice.speckle_weights(reach.speckles, reach.speckle_mm);
        let mut nodes = vec![[0.0; 8]; side * side];
        let margin_cells = (frame.side_mm / side as f64 * 3.0) as f32;
        nodes.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
            for (x, node) in row.iter_mut().enumerate() {
                let i = y * side + x;
                let mut place = Place {
                    edge: fields[0][i],
                    major: fields[1][i],
                    vein: fields[2][i],
                    from_veins: from_veins[i],
                    speckle: speckle[i],
                    noise: [0.0; 3],
                };
                if place.edge > -margin_cells {
                    let p = lattice.leaf(x, y).as_vec2();
                    for (k, size) in NOISE_MM.iter().enumerate() {
                        let q = p / *size;
                        let octaves = 3 - k as u32;
                        place.noise[k] = noise::fractal(q.x, q.y, octaves, seed ^ (k as u32 + 1));
                    }
                }
                *node = place.array();
            }
        });
        Self { side, per_texel: side as f32 / size as f32, nodes }
    }

    /// The guide along row `y` of the texture.
    pub(super) fn row(&self, y: usize) -> GuideRow {
        let (i, t) = self.between(y);
        let lower = &self.nodes[i * self.side..(i + 1) * self.side];
        let upper = &self.nodes[(i + 1) * self.side..(i + 2) * self.side];
        let nodes = lower.iter().zip(upper).map(|(a, b)| mixed(a, b, t)).collect();
        GuideRow { nodes, per_texel: self.per_texel }
    }

    fn between(&self, texel: usize) -> (usize, f32) {
        between(texel, self.per_texel, self.side)
    }

    /// Nodes in a row.
    pub(super) fn side(&self) -> usize {
        self.side
    }

    /// Nodes to the texel.
    pub(super) fn per_texel(&self) -> f32 {
        self.per_texel
    }

    /// The node of this number, row by row from the top.
    #[inline]
    pub(super) fn node(&self, i: usize) -> Place {
        Place::of(self.nodes[i])
    }
}

/// The guide along one row of the texture.
#[derive(Debug)]
pub(super) struct GuideRow {
    nodes: Vec<[f32; 8]>,
    per_texel: f32,
}

impl GuideRow {
    /// The guide at column `x` of the texture.
    #[inline]
    pub(super) fn at(&self, x: usize) -> Place {
        let (i, t) = between(x, self.per_texel, self.nodes.len());
        Place::of(mixed(&self.nodes[i], &self.nodes[i + 1], t))
    }
}

/// The node before a texel's centre, and how far towards the next one the centre lies.
#[inline]
pub(super) fn between(texel: usize, per_texel: f32, side: usize) -> (usize, f32) {
    let g = ((texel as f32 + 0.5) * per_texel - 0.5).clamp(0.0, side as f32 - 1.0);
    let i = (g as usize).min(side - 2);
    (i, g - i as f32)
}

#[inline]
pub(super) fn mixed<const N: usize>(a: &[f32; N], b: &[f32; N], t: f32) -> [f32; N] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
}

type Line = (DVec2, DVec2);

fn vein_lines(venation: &Venation, wanted: impl Fn(u8) -> bool) -> Vec<Line> {
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
pub(super) struct Lattice<'a> {
    pub frame: &'a TextureFrame,
    pub side: usize,
}

impl Lattice<'_> {
    /// Distance from every node to the nearest vein up to an order (mm).
    pub(super) fn vein_distances(&self, venation: &Venation, order: u8) -> Vec<f32> {
        self.distances(&vein_lines(venation, |of| of <= order))
    }

    /// The node nearest to a point of the frame (mm).
    pub(super) fn nearest_node(&self, p: DVec2) -> usize {
        let pixel = self.frame.pixel_from_leaf(p, self.side);
        let clamp = |v: f64| (v.max(0.0) as usize).min(self.side - 1);
        clamp(pixel.y) * self.side + clamp(pixel.x)
    }

    /// The nodes in the box around a line, `reach` away from it at most (mm).
    pub(super) fn nodes_near(&self, a: DVec2, b: DVec2, reach: f64) -> Vec<usize> {
        let [a, b] = [a, b].map(|p| self.frame.pixel_from_leaf(p, self.side).as_vec2());
        let reach = (reach / self.spacing()) as f32;
        let capsule = Capsule { a, b, radius_a: reach, radius_b: reach };
        let [columns, rows] = capsule.pixels(reach, self.side, 0..self.side);
        rows.flat_map(|y| columns.clone().map(move |x| y * self.side + x)).collect()
    }

    pub(super) fn leaf(&self, x: usize, y: usize) -> DVec2 {
        self.frame.leaf_from_pixel(DVec2::new(x as f64 + 0.5, y as f64 + 0.5), self.side)
    }

    /// From node to node (mm).
    pub(super) fn spacing(&self) -> f64 {
        self.frame.side_mm / self.side as f64
    }

    /// Distance from every node to the nearest of some lines (mm).
    fn distances(&self, lines: &[Line]) -> Vec<f32> {
        const NO_LINE: u32 = u32::MAX;
        let side = self.side;
        // Note in each cell a line that passes it; where several do, they are near each other.
        let mut line_at = vec![NO_LINE; side * side];
        for (i, &(a, b)) in lines.iter().enumerate() {
            let steps = (a.distance(b) / self.spacing() * 2.0) as usize + 1;
            for step in 0..=steps {
                let p = a.lerp(b, step as f64 / steps as f64);
                let cell = self.frame.pixel_from_leaf(p, side);
                let clamp = |v: f64| (v.max(0.0) as usize).min(side - 1);
                let slot = &mut line_at[clamp(cell.y) * side + clamp(cell.x)];
                if *slot == NO_LINE {
                    *slot = i as u32;
                }
            }
        }
        let nearest = nearest_sites(side, side, |i| line_at[i] != NO_LINE);
        let mut distances = vec![FAR_MM; side * side];
        distances.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
            for (x, distance) in row.iter_mut().enumerate() {
                let site = nearest[(x, y)];
                if site == NO_SITE {
                    continue;
                }
                let p = self.leaf(x, y);
                let i = line_at[site as usize] as usize;
                // The neighbours in the list continue the line: the nearest may be one of them.
                let near = lines[i.saturating_sub(1)..(i + 2).min(lines.len())].iter();
                let least = near
                    .map(|&(a, b)| polygon::nearest_on_segment(a, b, p).distance_squared(p))
                    .fold(f64::INFINITY, f64::min);
                *distance = least.sqrt() as f32;
            }
        });
        distances
    }

    /// Turns the sign of what lies outside the outline.
    fn negate_outside(&self, outline: &[Line], distances: &mut [f32]) {
        let side = self.side;
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
                if passed % 2 == 0 {
                    *distance = -*distance;
                }
            }
        });
    }

    /// The largest w = 1 − distance / (spread × width) over all veins.
    fn vein_weights(&self, venation: &Venation, spread: f64) -> Vec<f32> {
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
    fn speckle_weights(&self, speckles: &[DVec2], reach_mm: f64) -> Vec<f32> {
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
        for y in rows {
            let row = &mut weights[y * self.side..][..self.side];
            for x in columns.clone() {
                let (distance2, t) = capsule.nearest(Vec2::new(x as f32 + 0.5, y as f32 + 0.5));
                let reach = capsule.radius(t);
                if distance2 < reach * reach {
                    row[x] = row[x].max(1.0 - distance2.sqrt() / reach);
                }
            }
        }
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::segments::SegmentIndex;
    use crate::veins::VeinGraph;

    #[test]
    fn distances_to_the_margin_are_near_those_of_a_full_search() {
        let corner = |i: usize| {
            let angle = std::f64::consts::TAU * (i as f64 - 24.0) / 96.0;
            let r = 30.0 * (1.0 + 0.15 * libm::cos(6.0 * angle));
            DVec2::new(r * libm::cos(angle), r * libm::sin(angle) + 25.5)
        };
        let mut outline: Vec<DVec2> = (0..96).map(corner).collect();
        let apex = 48;
        (outline[0], outline[apex].x) = (DVec2::ZERO, 0.0);
        let margin = Margin::new(outline, apex, Vec::new(), "").expect("a margin");
        let bounds = margin.bounds();
        let frame = TextureFrame::around(bounds.min, bounds.max, 0.05);
        let bare = Venation::new(VeinGraph::new(), Vec::new(), Vec::new());
        let reach = Reach { vein_spread: 0.0, speckles: &[], speckle_mm: 0.0 };
        let size = 200;
        let spacing = frame.side_mm / Guide::side_for(size) as f64;
        let guide = Guide::new(&margin, &bare, &frame, size, &reach, 1);
        let edges = SegmentIndex::of_polygon(margin.outline());
        for y in 0..size {
            let row = guide.row(y);
            for x in 0..size {
                let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let p = frame.leaf_from_pixel(centre, size);
                let distance = edges.nearest(p, 1000.0).expect("an edge").0.sqrt();
                let expected = if edges.contains(p) { distance } else { -distance };
                if expected < -3.0 {
                    continue; // Far outside nobody asks; at the frame the guide is constant.
                }
                let found = f64::from(row.at(x).edge);
                let limit = if expected < 4.0 { 0.1 } else { 0.5 } * spacing;
                assert!((found - expected).abs() < limit, "{p}: {found} {expected}");
            }
        }
    }
}
