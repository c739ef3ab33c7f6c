//! What the painters ask of a place on the blade: the veins across it, and the guide beneath it.
//!
//! Veins are drawn at full resolution, band by band, from tapered capsules, each within its own
//! box. What varies slowly (distance to the margin, to the larger veins, the reach of the colour
//! schemes, broad mottling) is computed on a coarser guide ([`super::guide`]) and read in between.

use std::ops::Range;

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

/// A vein thins to this share of its radius at its end, so that it is lost in the tissue.
const TIP: f64 = 0.35;

/// The veins of a leaf as strokes on its texture (pixels).
#[derive(Debug)]
pub(super) struct Strokes {
    strokes: Vec<Stroke>,
    /// Which of them pass through each band of rows: `at[starts[i]..starts[i + 1]]`.
    at: Vec<u32>,
    starts: Vec<usize>,
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
    pub width: usize,
    pub cover: Vec<f32>,
    pub radius: Vec<f32>,
    pub dome: Vec<f32>,
    pub groove: Vec<f32>,
    /// Order of the vein, 0 for none; of several the lowest.
    pub order: Vec<u8>,
    /// How much of a texel's vein is seen; of two veins the one that shows more counts.
    shows: Vec<f32>,
}

impl VeinRows {
    /// Empty rows.
    fn clear(&mut self, width: usize, rows: usize) {
        self.width = width;
        let planes =
            [&mut self.cover, &mut self.radius, &mut self.dome, &mut self.groove, &mut self.shows];
        for plane in planes {
            plane.clear();
            plane.resize(width * rows, 0.0);
        }
        self.order.clear();
        self.order.resize(width * rows, 0);
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
        let radius = |node: u32| radii[node as usize] * pixels_per_mm;
        let mut ends: Vec<bool> =
            venation.graph().child_counts().iter().map(|&count| count == 0).collect();
        for &(a, b) in venation.graph().joins() {
            (ends[a as usize], ends[b as usize]) = (false, false);
        }
        let grown = venation.graph().edges().map(|(parent, child)| Capsule {
            a: at(parent),
            b: at(child),
            radius_a: radius(parent).min(radius(child) * BRANCH_FLARE) as f32,
            radius_b: (radius(child) * if ends[child as usize] { TIP } else { 1.0 }) as f32,
        });
        let joined = venation.graph().joins().iter().map(|&(a, b)| {
            let thinner = radius(a).min(radius(b)) as f32;
            Capsule { a: at(a), b: at(b), radius_a: thinner, radius_b: thinner }
        });
        let edges = venation.graph().edges().map(|(_, child)| child);
        let loops = venation.graph().joins().iter().map(|&(_, b)| b);
        let orders = edges.chain(loops).map(|node| venation.orders()[node as usize]);
        let strokes: Vec<Stroke> = grown
            .chain(joined)
            .zip(orders)
            .map(|(capsule, order)| {
                let widest = capsule.widest();
                let reach = (GROOVE_RADII * widest).max(widest + LEAST_HALF_PX);
                Stroke { capsule, order, reach }
            })
            .collect();
        let (starts, at) = sorted(&strokes, size, band);
        Self { strokes, at, starts, mm: (1.0 / pixels_per_mm) as f32 }
    }

    /// The veins over a band of rows of the texture.
    #[inline(always)]
    pub(super) fn fill(&self, band: usize, rows: Range<usize>, width: usize, out: &mut VeinRows) {
        out.clear(width, rows.len());
        for &stroke in &self.at[self.starts[band]..self.starts[band + 1]] {
            let stroke = &self.strokes[stroke as usize];
            let [columns, lines] = stroke.capsule.pixels(stroke.reach, width, rows.clone());
            for y in lines {
                let across = stroke.columns(y, columns.clone());
                let line = (y - rows.start) * width;
                let texels = line + across.start..line + across.end;
                let (x, y) = (across.start as i32, y as f32 + 0.5);
                let VeinRows { cover, radius, dome, groove, order, shows, .. } = &mut *out;
                stroke.draw(
                    (x, y, self.mm),
                    &mut cover[texels.clone()],
                    &mut radius[texels.clone()],
                    &mut dome[texels.clone()],
                    &mut groove[texels.clone()],
                    &mut shows[texels.clone()],
                    &mut order[texels],
                );
            }
        }
    }
}

/// Which strokes pass through each band: where each band's begin, and their numbers in order.
fn sorted(strokes: &[Stroke], size: usize, band: usize) -> (Vec<usize>, Vec<u32>) {
    let bands = |stroke: &Stroke| {
        let [_, lines] = stroke.capsule.pixels(stroke.reach, size, 0..size);
        if lines.is_empty() { 0..0 } else { lines.start / band..lines.end.div_ceil(band) }
    };
    let mut starts = vec![0; size.div_ceil(band) + 1];
    for stroke in strokes {
        for i in bands(stroke) {
            starts[i + 1] += 1;
        }
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let (mut next, mut at) = (starts.clone(), vec![0; starts[starts.len() - 1]]);
    for (number, stroke) in (0..).zip(strokes) {
        for i in bands(stroke) {
            at[next[i]] = number;
            next[i] += 1;
        }
    }
    (starts, at)
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

/// A branch widens towards its parent up to so many times its own radius: a fillet. The parent's
/// full radius would make a thorn of every fine branch on the midrib.
pub(super) const BRANCH_FLARE: f64 = 1.3;

impl Stroke {
    /// Of some columns those that can lie within reach in row `y`: a slanted stroke crosses few of its
    /// box.
    #[inline(always)]
    fn columns(&self, y: usize, columns: Range<usize>) -> Range<usize> {
        let along = self.capsule.b - self.capsule.a;
        if along.y.abs() < 0.1 * along.x.abs() || along.y == 0.0 {
            return columns;
        }
        // Where the axis, drawn out, has the height of the row, and how far aside the reach goes.
        let middle = self.capsule.a.x + (y as f32 + 0.5 - self.capsule.a.y) * along.x / along.y;
        let aside = self.reach * along.length() / along.y.abs() + 1.0;
        let clip = |x: f32| (x.max(0.0) as usize).clamp(columns.start, columns.end);
        clip(middle - aside)..clip(middle + aside + 1.0)
    }

    /// Draws on texels of one row, of which the first is column `x`; `y` is their centres' height.
    /// Without a branch, so that several texels can be drawn at once.
    #[inline(always)]
    #[expect(clippy::too_many_arguments, reason = "arrays apart from each other are what is quick")]
    fn draw(
        &self,
        (x, y, mm): (i32, f32, f32),
        cover: &mut [f32],
        radius: &mut [f32],
        dome: &mut [f32],
        groove: &mut [f32],
        shows: &mut [f32],
        order: &mut [u8],
    ) {
        let Capsule { a, b, radius_a, radius_b } = self.capsule;
        let along = b - a;
        let length2 = along.length_squared();
        let per_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        let dy = y - a.y;
        let n = cover.len();
        let (radius, dome, groove) = (&mut radius[..n], &mut dome[..n], &mut groove[..n]);
        let (shows, order) = (&mut shows[..n], &mut order[..n]);
        for i in 0..n {
            let dx = (x + i as i32) as f32 + 0.5 - a.x;
            let t = ((dx * along.x + dy * along.y) * per_length2).clamp(0.0, 1.0);
            let (ex, ey) = (dx - along.x * t, dy - along.y * t);
            let distance2 = ex * ex + ey * ey;
            let here = radius_a + (radius_b - radius_a) * t;
            let here2 = here * here;
            let wide = (1.0 - distance2 / (GROOVE_RADII * GROOVE_RADII * here2)).max(0.0);
            groove[i] = groove[i].max(wide * wide * here * mm);
            dome[i] = dome[i].max((here2 - distance2).max(0.0).sqrt() * mm);
            let half = (SOFT_EDGE * here).max(LEAST_HALF_PX);
            let share = stroke_share(distance2.sqrt(), here, half);
            // Of two veins the one that shows more: a fine branch inside its parent's soft edge
            // loses.
            let here_mm = here * mm;
            let seen = share * here_mm / (here_mm + SHOWS_MM);
            let more = seen > shows[i];
            cover[i] = if more { share } else { cover[i] };
            radius[i] = if more { here_mm } else { radius[i] };
            shows[i] = if more { seen } else { shows[i] };
            // No finer than the texels, so that a label never falls into dashes.
            let labelled = here.max(LEAST_LABEL_PX);
            let lowest = order[i] == 0 || self.order < order[i];
            order[i] =
                if lowest & (distance2 < labelled * labelled) { self.order } else { order[i] };
        }
    }
}
