//! The slowly varying fields of a leaf on a coarse grid, read by interpolation.
//!
//! Distances: the distance transform says which node's cell holds the nearest line, and the distance
//! is measured to that line itself. The cell is known by its centre only, so where two stretches are
//! about equally far the wrong one may be taken, and between the nodes a ridge is cut off. On a lobed
//! outline the error stayed below 0.07 node spacings (a seventh of a texel) near the margin and below
//! 0.36 deep inside, where nothing sharp depends on it; a test holds both.

mod lattice;
mod panel;
mod smooth;
mod spread;

use std::ops::Range;

use glam::DVec2;

pub(super) use self::lattice::Lattice;
use self::lattice::vein_lines;
use self::panel::panels;
use self::smooth::{NOISE_NODES_MM, Smooth, SmoothFields};
use self::spread::Spread;
use super::strip::{LANES, Lane};
use crate::geometry::polygon;
use crate::margin::Margin;
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
    /// How far the panel between the larger veins has risen (0–1).
    pub panel: f32,
}

/// Numbers of a place.
pub(super) const NUMBERS: usize = 9;

impl Place {
    #[inline(always)]
    pub(super) fn array(self) -> [f32; NUMBERS] {
        let [a, b, c] = self.noise;
        [self.edge, self.major, self.vein, self.from_veins, self.speckle, a, b, c, self.panel]
    }

    #[inline(always)]
    pub(super) fn of(numbers: [f32; NUMBERS]) -> Self {
        let [edge, major, vein, from_veins, speckle, a, b, c, panel] = numbers;
        Self { edge, major, vein, from_veins, speckle, noise: [a, b, c], panel }
    }
}

/// Wounds lie on a guide with at least so many nodes a side: they have edges, and a leaf of few texels is to
/// lose no other tissue than one of many.
pub(super) const NODES_OF_WOUNDS: usize = 512;

/// What has nothing sharp lies on no more nodes a side than these: on a leaf of 100 mm every fifth of a
/// millimetre.
const SMOOTH_NODES: usize = 512;

/// The coarse grids.
#[derive(Debug)]
pub(super) struct Guide {
    side: usize,
    per_texel: f32,
    /// Distance to the nearest vein.
    vein: Vec<f32>,
    /// Weight of the colour that spreads from the narrow veins, where any does.
    narrow: Option<Vec<f32>>,
    /// The node before each column of the texture, and how far towards the next one it lies.
    columns: Vec<(u32, f32)>,
    smooth: Smooth,
    smooth_columns: Vec<(u32, f32)>,
}

/// The reach of the schemes that spread from things.
#[derive(Debug)]
pub(super) struct Reach<'a> {
    pub vein_spread: f64,
    /// How much the colour from the veins counts, 0–1.
    pub vein_strength: f32,
    /// Whether fine veins spread less colour than large ones.
    pub faint_veins: bool,
    pub speckles: &'a [DVec2],
    pub speckle_mm: f64,
}

impl Reach<'_> {
    /// Nothing spreads.
    pub(super) const NONE: Self = Self {
        vein_spread: 0.0,
        vein_strength: 0.0,
        faint_veins: false,
        speckles: &[],
        speckle_mm: 0.0,
    };
}

impl Guide {
    /// Half the texture's resolution serves: every field is smooth over two texels, or covered by
    /// the vein that it is sharp at. Past 1024 nodes a side the leaf has nothing finer to say.
    pub(super) fn side_for(size: usize) -> usize {
        (size / 2).clamp(16, 1024)
    }

    /// With so many nodes a side, for a texture of so many texels.
    pub(super) fn new(
        side: usize,
        margin: &Margin,
        venation: &Venation,
        frame: &TextureFrame,
        size: usize,
        reach: &Reach<'_>,
        seed: u32,
    ) -> Self {
        let lattice = Lattice { frame, side };
        let coarse = Lattice { frame, side: side.min(SMOOTH_NODES) };
        let outline: Vec<_> = polygon::edges(margin.outline()).collect();
        let slits = margin.cuts().iter().flat_map(|cut| cut.windows(2).map(|w| (w[0], w[1])));
        let edges: Vec<_> = outline.iter().copied().chain(slits).collect();
        let veins: Vec<_> = vein_lines(venation, |_| true);
        let major: Vec<_> = vein_lines(venation, |order| order <= 2);
        let margin_cells = 3.0 * coarse.spacing() as f32;
        let edge = coarse.signed_distances(&edges, &outline, margin_cells);
        let inside = |depth: &f32| *depth > -margin_cells;
        let spans = edge.chunks(coarse.side).map(|row| {
            let (first, last) = (row.iter().position(inside), row.iter().rposition(inside));
            first.zip(last).map_or(0..0, |(first, last)| first..last + 1)
        });
        let spans: Vec<Range<usize>> = spans.collect();
        let major = coarse.distances(&major, &spans);
        let spread = Spread::new(&lattice, &coarse, venation, reach);
        let smooth = SmoothFields {
            side: coarse.side,
            panel: panels(coarse.side, coarse.spacing(), &major, &spans),
            major,
            speckle: coarse.speckle_weights(reach.speckles, reach.speckle_mm),
            from_wide: spread.wide,
            edge,
            spans,
        };
        let fine_spans = smooth.spans_at(side);
        let vein = lattice.distances(&veins, &fine_spans);
        let even = coarse.spacing() <= NOISE_NODES_MM;
        let smooth = smooth.nodes(if even { &coarse } else { &lattice }, seed);
        let columns = |side: usize| {
            let column = move |x: usize| {
                let (i, t) = between(x, side as f32 / size as f32, side);
                (i as u32, t)
            };
            (0..size).map(column).collect()
        };
        Self {
            side,
            per_texel: side as f32 / size as f32,
            vein,
            narrow: spread.narrow,
            columns: columns(side),
            smooth_columns: columns(smooth.side),
            smooth,
        }
    }

    /// The guide along some columns of row `y` of the texture; `mixed` is overwritten.
    #[inline(always)]
    pub(super) fn row<'a>(
        &'a self,
        y: usize,
        columns: &Range<usize>,
        mixed: &'a mut MixedRow,
    ) -> GuideRow<'a> {
        let size = self.columns.len();
        let nodes = |of: &[(u32, f32)]| {
            let [first, last] = [columns.start, columns.end - 1].map(|x| of[x].0 as usize);
            first..last + 2
        };
        let (fine, smooth) = (nodes(&self.columns), nodes(&self.smooth_columns));
        mix_rows(&self.vein, self.side, y, size, fine.clone(), &mut mixed.vein);
        match &self.narrow {
            Some(narrow) => mix_rows(narrow, self.side, y, size, fine, &mut mixed.narrow),
            None => mixed.narrow.resize(self.side, 0.0),
        }
        let side = self.smooth.side;
        mix_rows(&self.smooth.nodes, side, y, size, smooth, &mut mixed.smooth);
        GuideRow { mixed, columns: &self.columns, smooth_columns: &self.smooth_columns }
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
        let side = self.smooth.side;
        let per_node = side as f32 / self.side as f32;
        let (column, s) = between(i % self.side, per_node, side);
        let (row, t) = between(i / self.side, per_node, side);
        let [above, below] = [row, row + 1].map(|row| {
            let from = row * side + column;
            mixed(&self.smooth.nodes[from], &self.smooth.nodes[from + 1], s)
        });
        let narrow = self.narrow.as_ref().map_or(0.0, |narrow| narrow[i]);
        place(self.vein[i], narrow, &mixed(&above, &below, t))
    }
}

/// A place of both lattices.
#[inline(always)]
fn place(vein: f32, narrow: f32, smooth: &[f32; 8]) -> Place {
    let [edge, major, speckle, a, b, c, wide, panel] = *smooth;
    let from_veins = if wide > narrow { wide } else { narrow };
    Place { edge, major, vein, from_veins, speckle, noise: [a, b, c], panel }
}

/// Some columns of the nodes of a lattice with so many a side mixed for a row of a texture of so many texels.
#[inline(always)]
fn mix_rows<T: Mix>(
    nodes: &[T],
    side: usize,
    y: usize,
    size: usize,
    columns: Range<usize>,
    row: &mut Vec<T>,
) {
    let (i, t) = between(y, side as f32 / size as f32, side);
    let of_row = |i: usize| &nodes[i * side + columns.start..i * side + columns.end];
    let (lower, upper) = (of_row(i), of_row(i + 1));
    row.resize(side, T::default());
    for (row, (a, b)) in row[columns].iter_mut().zip(lower.iter().zip(upper)) {
        *row = a.mixed(b, t);
    }
}

/// What lies on a node.
trait Mix: Copy + Default {
    /// What lies between two nodes.
    fn mixed(&self, other: &Self, share: f32) -> Self;
}

impl Mix for f32 {
    #[inline(always)]
    fn mixed(&self, other: &Self, share: f32) -> Self {
        self + (other - self) * share
    }
}

impl Mix for [f32; 8] {
    #[inline(always)]
    fn mixed(&self, other: &Self, share: f32) -> Self {
        mixed(self, other, share)
    }
}

/// Nodes of both lattices at the height of a row of the texture.
#[derive(Debug, Default)]
pub(super) struct MixedRow {
    vein: Vec<f32>,
    narrow: Vec<f32>,
    smooth: Vec<[f32; 8]>,
}

/// The guide along one row of the texture.
#[derive(Debug)]
pub(super) struct GuideRow<'a> {
    mixed: &'a MixedRow,
    columns: &'a [(u32, f32)],
    smooth_columns: &'a [(u32, f32)],
}

impl GuideRow<'_> {
    /// The guide at some columns of the texture, in the order of [`Place::array`]; past their end the last
    /// is repeated.
    #[inline(always)]
    pub(super) fn read(&self, columns: Range<usize>, lanes: &mut [Lane; NUMBERS]) {
        // All of a node together, and then number by number.
        let (mut vein, mut narrow) = ([0.0; LANES], [0.0; LANES]);
        let mut smooth = [[0.0; 8]; LANES];
        for i in 0..LANES {
            let x = (columns.start + i).min(columns.end - 1);
            let (node, t) = self.columns[x];
            let between = |row: &[f32]| row[node as usize].mixed(&row[node as usize + 1], t);
            (vein[i], narrow[i]) = (between(&self.mixed.vein), between(&self.mixed.narrow));
            mix(&self.mixed.smooth, self.smooth_columns[x], &mut smooth[i]);
        }
        for i in 0..LANES {
            let place = place(vein[i], narrow[i], &smooth[i]).array();
            for k in 0..NUMBERS {
                lanes[k][i] = place[k];
            }
        }
    }
}

/// What lies between a node, found by its number, and the next one. As [`mixed`], but written in place: with
/// one of them for both, painting was found to take a quarter longer.
#[inline(always)]
fn mix<const N: usize>(nodes: &[[f32; N]], (i, t): (u32, f32), found: &mut [f32; N]) {
    let (a, b) = (&nodes[i as usize], &nodes[i as usize + 1]);
    for k in 0..N {
        found[k] = a[k] + (b[k] - a[k]) * t;
    }
}

/// The node before a texel's centre, and how far towards the next one the centre lies.
#[inline]
pub(super) fn between(texel: usize, per_texel: f32, side: usize) -> (usize, f32) {
    let g = ((texel as f32 + 0.5) * per_texel - 0.5).clamp(0.0, side as f32 - 1.0);
    let i = (g as usize).min(side - 2);
    (i, g - i as f32)
}

#[inline(always)]
pub(super) fn mixed<const N: usize>(a: &[f32; N], b: &[f32; N], t: f32) -> [f32; N] {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t)
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
        let size = 200;
        let side = Guide::side_for(size);
        let spacing = frame.side_mm / side as f64;
        let guide = Guide::new(side, &margin, &bare, &frame, size, &Reach::NONE, 1);
        let edges = SegmentIndex::of_polygon(margin.outline());
        let mut nodes = MixedRow::default();
        for y in 0..size {
            let row = guide.row(y, &(0..size), &mut nodes);
            let mut lanes = [[0.0; LANES]; NUMBERS];
            for x in 0..size {
                // Strip by strip, the last of them shorter.
                let lane = x % LANES;
                if lane == 0 {
                    row.read(x..(x + LANES).min(size), &mut lanes);
                }
                let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                let p = frame.leaf_from_pixel(centre, size);
                let distance = edges.nearest(p, 1000.0).expect("an edge").0.sqrt();
                let expected = if edges.contains(p) { distance } else { -distance };
                if expected < -1.5 * spacing {
                    continue; // Far outside nobody asks, and only the cell is known.
                }
                let found = f64::from(lanes[0][lane]);
                let limit = if expected < 4.0 { 0.1 } else { 0.5 } * spacing;
                assert!((found - expected).abs() < limit, "{p}: {found} {expected}");
            }
            let [last, beyond] = [size % LANES - 1, LANES - 1].map(|i| lanes.map(|lane| lane[i]));
            assert_eq!(beyond, last, "past the end the last is repeated");
        }
    }
}
