//! What the painters ask of a place on the blade: the veins across it, and the guide beneath it.
//!
//! Veins are drawn at full resolution, band by band, from tapered capsules, each within its own
//! box. What varies slowly (distance to the margin, to the larger veins, the reach of the colour
//! schemes, broad mottling) is computed on a coarser guide ([`super::guide`]) and read in between.

use std::ops::Range;

use glam::Vec2;

use crate::raster::coverage::{Capsule, stroke_share};
use crate::units::TextureFrame;
use crate::veins::Venation;

pub(super) use super::guide::Place;

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
    capsules: Vec<Capsule>,
    orders: Vec<u8>,
    pixels_per_mm: f32,
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
    /// Order of the vein here, 0 for none; of several the lowest.
    pub order: u8,
}

impl Strokes {
    /// The veins of a leaf whose midrib starts with the radius `neck` (mm).
    pub(super) fn new(venation: &Venation, neck: f64, frame: &TextureFrame, size: usize) -> Self {
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
        Self {
            capsules: grown.chain(joined).collect(),
            orders: edges.chain(loops).map(|node| venation.orders()[node as usize]).collect(),
            pixels_per_mm: pixels_per_mm as f32,
        }
    }

    /// The veins over some rows of the texture, row by row.
    pub(super) fn rows(&self, width: usize, rows: Range<usize>) -> Vec<VeinAt> {
        let mut texels = vec![VeinAt::default(); width * rows.len()];
        let mm = 1.0 / self.pixels_per_mm;
        for (capsule, &order) in self.capsules.iter().zip(&self.orders) {
            let reach = (GROOVE_RADII * capsule.widest()).max(capsule.widest() + LEAST_HALF_PX);
            let [columns, lines] = capsule.pixels(reach, width, rows.clone());
            for y in lines {
                let row = &mut texels[(y - rows.start) * width..][..width];
                for x in columns.clone() {
                    let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    row[x].add(capsule, order, centre, mm);
                }
            }
        }
        texels
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

/// A branch widens towards its parent up to so many times its own radius: a fillet. The parent's
/// full radius would make a thorn of every fine branch on the midrib.
pub(super) const BRANCH_FLARE: f64 = 1.3;

impl VeinAt {
    #[inline]
    fn add(&mut self, capsule: &Capsule, order: u8, centre: Vec2, mm: f32) {
        let (distance2, t) = capsule.nearest(centre);
        let radius = capsule.radius(t);
        let radius2 = radius * radius;
        let wide = 1.0 - distance2 / (GROOVE_RADII * GROOVE_RADII * radius2);
        if wide > 0.0 {
            self.groove = self.groove.max(wide * wide * radius * mm);
        }
        let half = (SOFT_EDGE * radius).max(LEAST_HALF_PX);
        let outside = radius + half;
        if distance2 >= outside * outside {
            return;
        }
        let cover = stroke_share(distance2.sqrt(), radius, half);
        // Of two veins the one that shows more: a fine branch inside its parent's soft edge loses.
        let radius_mm = radius * mm;
        let shows = |cover: f32, radius: f32| cover * radius / (radius + SHOWS_MM);
        if shows(cover, radius_mm) > shows(self.cover, self.radius) {
            (self.cover, self.radius) = (cover, radius_mm);
        }
        // No finer than the texels, so that a label never falls into dashes.
        let labelled = radius.max(LEAST_LABEL_PX);
        if distance2 < labelled * labelled && (self.order == 0 || order < self.order) {
            self.order = order;
        }
        if distance2 < radius2 {
            self.dome = self.dome.max((radius2 - distance2).sqrt() * mm);
        }
    }
}
