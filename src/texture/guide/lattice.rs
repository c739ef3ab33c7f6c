//! Distances and weights on the nodes of the guide.

use std::ops::Range;

use glam::{DVec2, Vec2};
use rayon::prelude::*;

use crate::raster::coverage::Capsule;
use crate::raster::distance::NearestByRows;
use crate::texture::banded::Banded;
use crate::texture::pen::{Axis, BLOCK, Pen, block};
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
        let all = vec![0..self.side; self.side];
        self.distances(&vein_lines(venation, |of| of <= order), &all)
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

    /// Distance from the nodes in some columns of every row to the nearest of some lines (mm); others are
    /// far.
    pub(super) fn distances(&self, lines: &[Line], columns: &[Range<usize>]) -> Vec<f32> {
        let near = Near::new(self, lines);
        let (side, spacing) = (self.side, self.spacing() as f32);
        let mut distances = vec![FAR_MM; side * side];
        near.sites.for_each_row(&mut distances, |nearest, row| {
            let y = nearest.y();
            let wanted = &columns[y];
            if wanted.is_empty() {
                return;
            }
            nearest.runs(0..side, |run, site| {
                let line = near.line_at[site as usize] as usize;
                let columns = run.start.max(wanted.start)..run.end.min(wanted.end);
                let Some(distances) = row.get_mut(columns.clone()) else { return };
                for (x, distance) in columns.zip(distances) {
                    *distance = near.distance(line, x, y) * spacing;
                }
            });
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
        near.sites.for_each_row(&mut distances, |nearest, row| {
            let y = nearest.y();
            let height = self.leaf(0, y).y;
            let mut crossings: Vec<f64> = outline
                .iter()
                .filter(|(a, b)| (a.y > height) != (b.y > height))
                .map(|(a, b)| a.x + (b.x - a.x) * (height - a.y) / (b.y - a.y))
                .collect();
            crossings.sort_by(f64::total_cmp);
            let mut passed = 0;
            nearest.runs(0..side, |run, site| {
                let line = near.line_at[site as usize] as usize;
                let (sx, sy) = (site as usize % side, site as usize / side);
                for x in run {
                    let at = self.leaf(x, y).x;
                    while passed < crossings.len() && crossings[passed] <= at {
                        passed += 1;
                    }
                    row[x] = if passed % 2 == 1 {
                        near.distance(line, x, y) * spacing
                    } else {
                        let cells =
                            Vec2::new(x.abs_diff(sx) as f32, y.abs_diff(sy) as f32).length();
                        // A cell's line may pass a cell nearer than its centre.
                        let far = (cells - 1.5) * spacing > exact;
                        -spacing * if far { cells } else { near.distance(line, x, y) }
                    };
                }
            });
        });
        distances
    }

    /// The largest w = 1 − distance / reach over all speckles.
    pub(super) fn speckle_weights(&self, speckles: &[DVec2], reach_mm: f64) -> Vec<f32> {
        let reach = (reach_mm * self.frame.pixels_per_mm(self.side)) as f32;
        if reach <= 0.0 {
            return vec![0.0; self.side * self.side];
        }
        let cone = |&speckle: &DVec2| {
            let a = self.frame.pixel_from_leaf(speckle, self.side).as_vec2();
            (Capsule { a, b: a, radius_a: reach, radius_b: reach }, 1.0)
        };
        self.weights(&speckles.iter().map(cone).collect::<Vec<_>>())
    }

    /// The largest height of some cones over every node.
    pub(super) fn weights(&self, cones: &[Cone]) -> Vec<f32> {
        let side = self.side;
        let rows = |(cone, _): &Cone| {
            let [_, rows] = cone.pixels(cone.widest(), side, 0..side);
            rows
        };
        let cones = Banded::new(cones, side, BAND, rows);
        let mut weights = vec![0.0; side * side];
        let fill = |wide: &mut Vec<f32>, (i, weights): (usize, &mut [f32])| {
            let rows = i * BAND..((i + 1) * BAND).min(side);
            let cones = cones.band(i);
            pulp::Arch::new().dispatch(Cones { side, rows, cones, wide, weights });
        };
        weights.par_chunks_mut(BAND * side).enumerate().for_each_init(Vec::new, fill);
        weights
    }
}

/// Rows of the lattice that cones are drawn on at a time.
const BAND: usize = 32;

/// The height of a cone on the axis of a capsule; at its radius it is 0.
pub(super) type Cone = (Capsule, f32);

/// Cones over some rows of nodes, of which the highest counts.
struct Cones<'a> {
    side: usize,
    rows: Range<usize>,
    cones: &'a [Cone],
    /// The rows and after each some nodes that a cone at the end may run over into.
    wide: &'a mut Vec<f32>,
    weights: &'a mut [f32],
}

impl pulp::WithSimd for Cones<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { side, rows, cones, wide, weights } = self;
        let stride = side + BLOCK;
        wide.clear();
        wide.resize(stride * rows.len(), 0.0);
        for (cone, height) in cones {
            let [columns, lines] = cone.pixels(cone.widest(), side, rows.clone());
            // The slope instead of the radius: it is not divided by at every node.
            let slope = |radius: f32| height / radius.max(1e-6);
            let (radius_a, radius_b) = (slope(cone.radius_a), slope(cone.radius_b));
            let pen = Pen::new(&Capsule { radius_a, radius_b, ..*cone }, cone.widest());
            for y in lines {
                let on_row = pen.on_row(y);
                for x in pen.chord(y, columns.clone()).step_by(BLOCK) {
                    let Axis { distance2, radius: slope } = on_row.axis(x);
                    let nodes = &mut wide[(y - rows.start) * stride + x..][..BLOCK];
                    let mut highest = block(nodes);
                    for i in 0..BLOCK {
                        highest[i] = highest[i].max(height - distance2[i].sqrt() * slope[i]);
                    }
                    nodes.copy_from_slice(&highest);
                }
            }
        }
        for (row, wide) in weights.chunks_exact_mut(side).zip(wide.chunks_exact(stride)) {
            row.copy_from_slice(&wide[..side]);
        }
    }
}

/// Which of some lines is near each node; lengths are in nodes.
struct Near {
    lines: Vec<Stretch>,
    /// A line that passes the cell of a node.
    line_at: Vec<u32>,
    /// The cells nearest to the nodes that a line passes.
    sites: NearestByRows,
}

/// A line, ready to be measured from.
struct Stretch {
    from: Vec2,
    along: Vec2,
    /// From one end to the other the place along it goes from 0 to 1.
    per_along: Vec2,
}

impl Near {
    fn new(lattice: &Lattice<'_>, lines: &[Line]) -> Self {
        const NO_LINE: u32 = u32::MAX;
        let side = lattice.side;
        let node = |p: DVec2| lattice.frame.pixel_from_leaf(p, side).as_vec2();
        let mut stretches = Vec::with_capacity(lines.len());
        // Note in each cell a line that passes it; where several do, they are near each other.
        let mut line_at = vec![NO_LINE; side * side];
        for (i, &(a, b)) in (0..).zip(lines) {
            let (a, b) = (node(a), node(b));
            let (along, length2) = (b - a, a.distance_squared(b));
            let per_along = if length2 > 0.0 { along / length2 } else { Vec2::ZERO };
            stretches.push(Stretch { from: a, along, per_along });
            let steps = length2.sqrt() as usize + 1;
            for step in 0..=steps {
                let cell = a.lerp(b, step as f32 / steps as f32);
                let clamp = |v: f32| (v.max(0.0) as usize).min(side - 1);
                let slot = &mut line_at[clamp(cell.y) * side + clamp(cell.x)];
                if *slot == NO_LINE {
                    *slot = i;
                }
            }
        }
        let sites = NearestByRows::new(side, side, |i| line_at[i] != NO_LINE);
        Self { lines: stretches, line_at, sites }
    }

    /// From a node to a line, or one of its neighbours in the list, which continue it.
    #[inline]
    fn distance(&self, line: usize, x: usize, y: usize) -> f32 {
        let p = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let near = self.lines[line.saturating_sub(1)..(line + 2).min(self.lines.len())].iter();
        let least = near
            .map(|line| line.distance2(p))
            .fold(f32::INFINITY, |a, b| if b < a { b } else { a });
        least.sqrt()
    }
}

impl Stretch {
    #[inline]
    fn distance2(&self, p: Vec2) -> f32 {
        let to = p - self.from;
        let t = to.dot(self.per_along).clamp(0.0, 1.0);
        (to - self.along * t).length_squared()
    }
}
