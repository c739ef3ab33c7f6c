//! Fields of the guide without anything sharp, on a lattice as coarse as they allow.

use std::ops::Range;

use rayon::prelude::*;

use super::lattice::Lattice;
use super::{between, mixed};
use crate::geometry::noise;

/// Feature sizes of the three noises (mm): across the leaf, between secondaries, around areoles.
const NOISE_MM: [f32; 3] = [16.0, 4.5, 1.6];

/// Noise lies on the smooth lattice where its nodes are no further apart (mm): six to the finest feature.
pub(super) const NOISE_NODES_MM: f64 = 0.27;

/// Fields without anything sharp on the nodes of a lattice.
#[derive(Debug)]
pub(super) struct Smooth {
    pub(super) side: usize,
    /// Edge, major and speckle as in [`Place`](super::Place), three noises, the weight of the colour that spreads from
    /// the wide veins, panel.
    pub(super) nodes: Vec<[f32; 8]>,
}

/// Smooth fields apart, on a lattice that may be coarser than that of [`Smooth`].
pub(super) struct SmoothFields {
    pub(super) side: usize,
    pub(super) edge: Vec<f32>,
    pub(super) major: Vec<f32>,
    pub(super) speckle: Vec<f32>,
    pub(super) from_wide: Vec<f32>,
    pub(super) panel: Vec<f32>,
    /// In each row the nodes from the first to the last that are not far outside.
    pub(super) spans: Vec<Range<usize>>,
}

impl SmoothFields {
    /// The spans on a lattice of this side.
    pub(super) fn spans_at(&self, side: usize) -> Vec<Range<usize>> {
        let of_row = |y: usize| {
            let (i, _) = between(y, self.side as f32 / side as f32, self.side);
            let [a, b] = [&self.spans[i], &self.spans[i + 1]];
            let span = match (a.is_empty(), b.is_empty()) {
                (true, _) => b.clone(),
                (_, true) => a.clone(),
                _ => a.start.min(b.start)..a.end.max(b.end),
            };
            span.start * side / self.side..span.end * side / self.side
        };
        (0..side).map(of_row).collect()
    }

    /// All of them together, with noise.
    pub(super) fn nodes(&self, lattice: &Lattice<'_>, seed: u32) -> Smooth {
        let side = lattice.side;
        let spans = self.spans_at(side);
        let columns: Vec<_> =
            (0..side).map(|x| between(x, self.side as f32 / side as f32, self.side)).collect();
        let noises = || [0, 1, 2].map(|k| noise::FractalRow::new(3 - k, seed ^ (k + 1)));
        let fill = |noises: &mut [noise::FractalRow; 3], (y, nodes): (usize, &mut [[f32; 8]])| {
            pulp::Arch::new().dispatch(NodeRow {
                lattice,
                fields: self,
                columns: &columns,
                y,
                span: spans[y].clone(),
                noises,
                nodes,
            });
        };
        let mut nodes = vec![[0.0; 8]; side * side];
        nodes.par_chunks_mut(side).enumerate().for_each_init(noises, fill);
        Smooth { side, nodes }
    }
}

/// What lies on a square lattice read between its nodes, on one with so many a side.
pub(super) fn refined(nodes: &[f32], side: usize, to: usize) -> Vec<f32> {
    let places: Vec<_> = (0..to).map(|i| between(i, side as f32 / to as f32, side)).collect();
    let mut refined = Vec::with_capacity(to * to);
    let mut row = Vec::with_capacity(side);
    for &(i, t) in &places {
        let (above, below) = (&nodes[i * side..(i + 1) * side], &nodes[(i + 1) * side..]);
        row.clear();
        row.extend(above.iter().zip(below).map(|(a, b)| a + (b - a) * t));
        refined.extend(places.iter().map(|&(j, s)| row[j] + (row[j + 1] - row[j]) * s));
    }
    refined
}

/// A row of smooth nodes to be filled.
struct NodeRow<'a> {
    lattice: &'a Lattice<'a>,
    fields: &'a SmoothFields,
    /// The place among the fields before each column, and how far towards the next one it lies.
    columns: &'a [(usize, f32)],
    y: usize,
    /// Other nodes are far outside, and lack noise.
    span: Range<usize>,
    noises: &'a mut [noise::FractalRow; 3],
    nodes: &'a mut [[f32; 8]],
}

/// Nodes whose noise is worked out together.
const NODES: usize = 64;

impl pulp::WithSimd for NodeRow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { lattice, fields, columns, y, span, noises, nodes } = self;
        let (i, t) = between(y, fields.side as f32 / nodes.len() as f32, fields.side);
        let [lower, upper] = [i, i + 1].map(|i| i * fields.side..(i + 1) * fields.side);
        let SmoothFields { edge, major, speckle, from_wide, panel, .. } = fields;
        let rows = [edge, major, speckle, from_wide, panel]
            .map(|plane| [&plane[lower.clone()], &plane[upper.clone()]]);
        for (node, &(i, s)) in nodes.iter_mut().zip(columns) {
            let [edge, major, speckle, wide, panel] = rows.map(|[lower, upper]| {
                let [a, b] = mixed(&[lower[i], lower[i + 1]], &[upper[i], upper[i + 1]], t);
                a + (b - a) * s
            });
            *node = [edge, major, speckle, 0.0, 0.0, 0.0, wide, panel];
        }
        if span.is_empty() {
            return;
        }
        let [left, right] = [span.start, span.end].map(|x| lattice.leaf(x, y).as_vec2());
        let spacing = lattice.spacing() as f32;
        for (k, noise) in noises.iter_mut().enumerate() {
            let size = NOISE_MM[k];
            noise.prepare(left.x / size, right.x / size, left.y / size);
            for start in span.clone().step_by(NODES) {
                let end = (start + NODES).min(span.end);
                let mut places = [0.0; NODES];
                let (first, most) = (left.x + (start - span.start) as f32 * spacing, right.x);
                for (i, place) in places.iter_mut().enumerate() {
                    *place = (first + i as f32 * spacing).min(most) / size;
                }
                for (node, found) in nodes[start..end].iter_mut().zip(noise.along(places)) {
                    node[3 + k] = found;
                }
            }
        }
    }
}
