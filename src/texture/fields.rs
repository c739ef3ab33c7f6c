//! What the painters ask of a place on the blade: the veins across it, and the guide beneath it.
//!
//! Veins are drawn at full resolution, band by band, from tapered capsules, each within its own
//! box. What varies slowly (distance to the margin, to the larger veins, the reach of the colour
//! schemes, broad mottling) is computed on a coarser guide ([`super::guide`]) and read in between.

use std::ops::Range;

use super::banded::Banded;
use super::chords::chords;
use super::pen::{Axis, BLOCK, Pen, block};
use crate::raster::coverage::{Capsule, stroke_share};
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Half the window through which a texel sees a vein (px). At 0.5 a slanted vein finer than a
/// texel falls into dashes; at 1 everything is soft.
const LEAST_HALF_PX: f32 = 0.7;

/// A vein's label reaches at least so far from its axis (px): half a texel's diagonal leaves no gap.
const LEAST_LABEL_PX: f32 = 0.71;

/// A groove reaches this many radii from the axis of its vein.
const GROOVE_RADII: f32 = 2.6;

/// The edge of a vein is soft over this share of its radius on either side of the outline: veins
/// are tissue, not wires.
const SOFT_EDGE: f32 = 0.3;

/// Where veins overlap, one of this radius (mm) counts half.
const SHOWS_MM: f32 = 0.05;

/// A vein is drawn no farther from its nodes than this, nor wider or narrower (px).
const OFF_PX: f64 = 0.12;

/// The veins of a leaf as strokes on its texture (pixels).
#[derive(Debug)]
pub(super) struct Strokes {
    strokes: Banded<Stroke>,
    mm: f32,
}

#[derive(Debug, Clone, Copy)]
struct Stroke {
    capsule: Capsule,
    order: u8,
    /// Farther from its axis nothing of it is found (px).
    reach: f32,
}

/// What the veins are at one texel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct VeinAt {
    /// How much of the texel is vein (0–1).
    pub cover: f32,
    /// Radius of that vein (mm).
    pub radius: f32,
    /// Height of a round vein over the texel (mm).
    pub dome: f32,
    /// Depth of a wide smooth groove along the veins (mm).
    pub groove: f32,
}

/// What the veins are over some rows, row by row; see [`VeinAt`].
#[derive(Debug, Default)]
pub(super) struct VeinRows {
    /// From row to row: the columns, and some texels that a stroke at the end may run over into.
    stride: usize,
    /// The column of the first texel in each row.
    first: usize,
    /// Size of a texel (mm).
    pub mm: f32,
    pub cover: Vec<f32>,
    pub radius: Vec<f32>,
    /// The dome's height, squared (px²).
    pub dome2: Vec<f32>,
    pub groove: Vec<f32>,
    /// Order of the vein, 0 for none; of several the lowest. Empty where nobody asks.
    pub order: Vec<u8>,
    /// How much of a texel's vein is seen; of two veins the one that shows more counts.
    shows: Vec<f32>,
}

impl VeinRows {
    /// Empty rows.
    fn clear(&mut self, columns: &Range<usize>, rows: usize, orders: bool) {
        (self.stride, self.first) = (columns.len() + BLOCK, columns.start);
        let texels = self.stride * rows;
        let planes =
            [&mut self.cover, &mut self.radius, &mut self.dome2, &mut self.groove, &mut self.shows];
        for plane in planes {
            plane.clear();
            plane.resize(texels, 0.0);
        }
        self.order.clear();
        self.order.resize(if orders { texels } else { 0 }, 0);
    }

    /// Where a texel is found, by its row among these and its column.
    #[inline(always)]
    pub(super) fn index(&self, row: usize, column: usize) -> usize {
        row * self.stride + column - self.first
    }
}

impl Strokes {
    /// The veins of a leaf whose midrib starts with the radius `neck` (mm), sorted into bands of so
    /// many rows.
    pub(super) fn new(
        venation: &Venation,
        neck: f64,
        frame: &TextureFrame,
        size: usize,
        band: usize,
    ) -> Self {
        let pixels_per_mm = frame.pixels_per_mm(size);
        let at = |node: u32| {
            frame.pixel_from_leaf(venation.graph().positions()[node as usize], size).as_vec2()
        };
        let radii = necked(venation, neck);
        let grown = chords(venation, &radii, OFF_PX / pixels_per_mm).into_iter().map(|chord| {
            let [radius_a, radius_b] = chord.radii.map(|radius| (radius * pixels_per_mm) as f32);
            (Capsule { a: at(chord.from), b: at(chord.to), radius_a, radius_b }, chord.to)
        });
        let joined = venation.graph().joins().iter().map(|&(a, b)| {
            let thinner = (radii[a as usize].min(radii[b as usize]) * pixels_per_mm) as f32;
            (Capsule { a: at(a), b: at(b), radius_a: thinner, radius_b: thinner }, b)
        });
        let strokes: Vec<Stroke> = grown
            .chain(joined)
            .map(|(capsule, node)| {
                let order = venation.orders()[node as usize];
                let widest = capsule.widest();
                let reach = (GROOVE_RADII * widest).max(widest + LEAST_HALF_PX);
                Stroke { capsule, order, reach }
            })
            .collect();
        let rows = |stroke: &Stroke| {
            let [_, rows] = stroke.capsule.pixels(stroke.reach, size, 0..size);
            rows
        };
        let strokes = Banded::new(&strokes, size, band, rows);
        Self { strokes, mm: (1.0 / pixels_per_mm) as f32 }
    }

    /// The veins over some columns of a band of rows of the texture; their orders where they are asked
    /// for.
    #[inline(always)]
    pub(super) fn fill(
        &self,
        band: usize,
        rows: Range<usize>,
        seen: &Range<usize>,
        orders: bool,
        out: &mut VeinRows,
    ) {
        out.clear(seen, rows.len(), orders);
        out.mm = self.mm;
        for stroke in self.strokes.band(band) {
            let [columns, lines] = stroke.capsule.pixels(stroke.reach, seen.end, rows.clone());
            let start = columns.start.max(seen.start);
            let columns = start..columns.end.max(start);
            let pen = Pen::new(&stroke.capsule, stroke.reach);
            for y in lines {
                let on_row = pen.on_row(y);
                for x in pen.columns(y, columns.clone()).step_by(BLOCK) {
                    let first = out.index(y - rows.start, x);
                    let (axis, texels) = (on_row.axis(x), first..first + BLOCK);
                    out.draw(&axis, self.mm, texels.clone());
                    if orders {
                        out.label(&axis, stroke.order, texels);
                    }
                }
            }
        }
    }
}

/// The nodes of the midrib, from the petiole: at each fork the widest child. Of several roots the
/// first.
pub(super) fn midrib(venation: &Venation) -> Vec<u32> {
    let graph = venation.graph();
    let radius = |node: u32| venation.radii()[node as usize];
    let mut widest: Vec<Option<u32>> = vec![None; graph.len()];
    for (parent, child) in graph.edges() {
        let slot = &mut widest[parent as usize];
        if slot.is_none_or(|other| radius(child) > radius(other)) {
            *slot = Some(child);
        }
    }
    let root = (!graph.is_empty()).then_some(0);
    std::iter::successors(root, |&node| widest[node as usize]).collect()
}

/// The radii of all nodes, widened along the midrib towards the petiole.
fn necked(venation: &Venation, neck: f64) -> Vec<f64> {
    let mut radii = venation.radii().to_vec();
    let at = |node: u32| venation.graph().positions()[node as usize];
    let reach = NECK_RADII * neck;
    let (mut walked, mut last) = (0.0, None);
    for node in midrib(venation) {
        walked += last.map_or(0.0, |last| at(last).distance(at(node)));
        if walked >= reach {
            break;
        }
        let own = &mut radii[node as usize];
        *own += (neck - *own).max(0.0) * (1.0 - walked / reach).powi(2);
        last = Some(node);
    }
    radii
}

/// The midrib widens towards the petiole over so many of the radii that they meet with.
const NECK_RADII: f64 = 30.0;

/// A branch widens towards its parent up to so many times its own radius, but by no more than it is long:
/// a fillet. The parent's full radius would make a thorn of every fine branch on the midrib, and a short
/// piece that widens much looks like a step across the vein.
pub(super) const BRANCH_FLARE: f64 = 1.3;

impl VeinRows {
    /// Draws a vein on some texels. Without a branch, so that all are drawn at once.
    #[inline(always)]
    fn draw(&mut self, axis: &Axis, mm: f32, texels: Range<usize>) {
        let Axis { distance2, radius: here } = axis;
        // By `max` where that is meant: a comparison becomes a store of some lanes, which is slow.
        let mut groove = block(&self.groove[texels.clone()]);
        for i in 0..BLOCK {
            let here2 = here[i] * here[i];
            let wide = (1.0 - distance2[i] / (GROOVE_RADII * GROOVE_RADII * here2)).max(0.0);
            let own = wide * wide * here[i] * mm;
            groove[i] = groove[i].max(own);
        }
        self.groove[texels.clone()].copy_from_slice(&groove);
        let mut dome2 = block(&self.dome2[texels.clone()]);
        for i in 0..BLOCK {
            dome2[i] = dome2[i].max(here[i] * here[i] - distance2[i]);
        }
        self.dome2[texels.clone()].copy_from_slice(&dome2);
        let mut shows = block(&self.shows[texels.clone()]);
        let mut cover = block(&self.cover[texels.clone()]);
        let mut radius = block(&self.radius[texels.clone()]);
        for i in 0..BLOCK {
            let half = (SOFT_EDGE * here[i]).max(LEAST_HALF_PX);
            let share = stroke_share(distance2[i].sqrt(), here[i], half);
            // Of two veins the one that shows more: a fine branch inside its parent's soft edge
            // loses.
            let here_mm = here[i] * mm;
            let seen = share * here_mm / (here_mm + SHOWS_MM);
            let more = seen > shows[i];
            cover[i] = if more { share } else { cover[i] };
            radius[i] = if more { here_mm } else { radius[i] };
            shows[i] = if more { seen } else { shows[i] };
        }
        self.shows[texels.clone()].copy_from_slice(&shows);
        self.cover[texels.clone()].copy_from_slice(&cover);
        self.radius[texels].copy_from_slice(&radius);
    }

    /// Notes a vein's order on some texels, where it is the lowest so far.
    #[inline(always)]
    fn label(&mut self, axis: &Axis, own: u8, texels: Range<usize>) {
        let seen = axis.distance2.iter().zip(&axis.radius);
        for (order, (distance2, here)) in self.order[texels].iter_mut().zip(seen) {
            // No finer than the texels, so that a label never falls into dashes.
            let labelled = here.max(LEAST_LABEL_PX);
            let lowest = *order == 0 || own < *order;
            *order = if lowest & (*distance2 < labelled * labelled) { own } else { *order };
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec2;

    use super::*;
    use crate::veins::VeinGraph;

    #[test]
    fn a_vein_that_begins_with_a_short_piece_has_no_step_across_it() {
        const SIZE: usize = 64;
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        // Much shorter than the vein is wide.
        let near = graph.sprout(root, DVec2::new(0.0, 0.02));
        graph.sprout(near, DVec2::new(0.0, 8.0));
        let venation = Venation::new(graph, vec![4.0, 1.0, 1.0], vec![1; 3]);
        let frame = TextureFrame { min: DVec2::splat(-8.0), side_mm: 16.0 };
        let strokes = Strokes::new(&venation, 0.0, &frame, SIZE, SIZE);
        let mut rows = VeinRows::default();
        strokes.fill(0, 0..SIZE, &(0..SIZE), false, &mut rows);
        let groove = |x: usize, y: usize| rows.groove[rows.index(y, x)];
        let deepest = groove(SIZE / 2, SIZE / 2);
        assert!(deepest > 0.9, "{deepest}");
        for (x, y) in (0..SIZE - 1).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
            let step = (groove(x, y) - groove(x, y + 1)).abs();
            assert!(step < 0.2, "{step} mm at {x}, {y}");
        }
    }
}
