//! One leaf laid out on its texture: what lies where.
//!
//! Nothing here depends on colours, the season or the relief, so a leaf that is painted again under others of
//! these is not laid out again.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::Paint;
use super::damage::{DamageSpec, Wounds};
use super::fields::{Strokes, midrib};
use super::guide::{Guide, Lattice, NODES_OF_WOUNDS, Reach};
use super::net::Net;
use super::petiole::{PetioleSpec, Stalk};
use super::pigment::{ColourType, Hsv};
use super::tissue;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::raster::Grid;
use crate::raster::color::byte;
use crate::raster::coverage::{Capsule, polygon_rows, stroke_share};
use crate::seed::{Seed, Stage};
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Rows painted at once on a texture of this side: enough that a vein is not looked at again for every
/// few rows, few enough that what the veins are stays in the cache of a core.
fn band_rows(size: usize) -> usize {
    (BAND_TEXELS / size).clamp(8, 32)
}

/// At 21 bytes a texel 700 kB, in a cache of 1 MB.
const BAND_TEXELS: usize = 1 << 15;

/// A slit is open this wide (mm): the edges of torn tissue shrink back a little.
const SLIT_MM: f64 = 0.15;

/// The petiole is at least this share of its own width where it meets the blade.
const NECK: f64 = 0.74;

/// A midrib with this share of the radius at the base is the only primary.
const LEADS: f64 = 0.9;

/// Of several primaries the petiole goes on in one that leaves the base within so many degrees of the leaf's axis.
const STRAIGHT_ON_DEG: f64 = 12.0;

/// The settings that a layout depends on.
#[derive(Debug, Clone, PartialEq)]
struct Laid {
    size_px: u64,
    gutter: f64,
    petiole: PetioleSpec,
    damage: DamageSpec,
    vein_spread: f64,
    vein_strength: f32,
    faint_veins: bool,
    speckles: u64,
    speckle_mm: f64,
}

impl Laid {
    fn of(paint: &Paint<'_>) -> Self {
        let colour = paint.colour;
        let from_veins = colour.r#type == ColourType::FromVeins;
        Self {
            size_px: paint.texture.size_px,
            gutter: paint.texture.gutter,
            // Its colour is no matter of where it lies.
            petiole: PetioleSpec { colour: Hsv::default(), ..paint.petiole.clone() },
            damage: paint.damage.clone(),
            vein_spread: colour.vein_spread,
            vein_strength: if from_veins { 1.0 } else { colour.undertone as f32 },
            // Else a net leaves nothing of the first colour.
            faint_veins: from_veins,
            speckles: match colour.speckle_count {
                0 => paint.default_speckles,
                count => count,
            },
            speckle_mm: colour.spread_mm,
        }
    }
}

/// A leaf on its texture.
#[derive(Debug)]
pub(super) struct Layout {
    laid: Laid,
    pub(super) size: usize,
    /// Rows in a band.
    pub(super) band: usize,
    pub(super) frame: TextureFrame,
    pub(super) per_mm: f32,
    outline: Vec<DVec2>,
    slits: Vec<Capsule>,
    pub(super) strokes: Strokes,
    pub(super) guide: Guide,
    /// None where it is finer than the texels.
    pub(super) nets: [Option<Net>; 3],
    pub(super) stalk: Stalk,
    /// Whether the petiole comes from below, into the blade.
    pub(super) shield: bool,
    /// Radii of the widest vein and of the midrib where the petiole begins (mm).
    pub(super) widest: f64,
    pub(super) neck: f64,
    pub(super) wounds: Option<Wounds>,
    /// Of what is random in the tissue.
    pub(super) seed: u32,
}

impl Layout {
    pub(super) fn new(paint: &Paint<'_>, margin: &Margin, venation: &Venation, seed: Seed) -> Self {
        let laid = Laid::of(paint);
        let size = paint.texture.size_px as usize;
        let widest = venation.radii().iter().copied().fold(0.0, f64::max);
        let graph = venation.graph();
        let root = (0..graph.len() as u32)
            .filter(|&node| graph.parent(node).is_none())
            .map(|node| venation.radii()[node as usize])
            .fold(0.0, f64::max);
        // A thin midrib widens towards the petiole, and a leaf without veins still hangs on one.
        let stalked = paint.petiole.length_mm > 0.0;
        let neck = if stalked { root.max(NECK * 0.5 * paint.petiole.width_mm) } else { root };
        // Into a shield the petiole runs from below: it goes on in no vein, and widens none.
        let goes_on = !margin.is_peltate();
        let midrib = if goes_on { midrib(venation) } else { Vec::new() };
        // One of several primaries does not lead the petiole.
        let leads =
            midrib.get(1).is_some_and(|&node| venation.radii()[node as usize] > LEADS * root);
        let midrib: Vec<DVec2> =
            midrib.into_iter().map(|node| graph.positions()[node as usize]).collect();
        // Of a fan the widest vein is no midrib: the petiole ends at the base, and widens none of them.
        let goes_on = goes_on && (leads || Stalk::off_deg(neck, &midrib).abs() < STRAIGHT_ON_DEG);
        let midrib = if goes_on { midrib } else { Vec::new() };
        let stalk = Stalk::new(paint.petiole, neck, &midrib, leads);
        let bounds = margin.bounds().joined(stalk.bounds());
        let frame = TextureFrame::around(bounds.min, bounds.max, paint.texture.gutter);
        let per_mm = frame.pixels_per_mm(size);
        let tissue = seed.stream(Stage::Tissue).bits() as u32;
        let speckles = speckles(laid.speckles, margin, seed);
        let reach = Reach {
            vein_spread: laid.vein_spread,
            vein_strength: laid.vein_strength,
            faint_veins: laid.faint_veins,
            speckles: &speckles,
            speckle_mm: laid.speckle_mm,
        };
        let pixel = |p: &DVec2| frame.pixel_from_leaf(*p, size);
        let slits = margin.cuts().iter().flat_map(|cut| cut.windows(2)).map(|w| {
            let radius = (0.5 * SLIT_MM * per_mm) as f32;
            let [a, b] = [pixel(&w[0]).as_vec2(), pixel(&w[1]).as_vec2()];
            Capsule { a, b, radius_a: radius, radius_b: radius }
        });
        let side = Guide::side_for(size);
        let guide = Guide::new(side, margin, venation, &frame, size, &reach, tissue);
        let hurt = !paint.damage.is_none();
        let wounds = hurt.then(|| {
            // Nobody asks the finer one for colours.
            let finer = (side < NODES_OF_WOUNDS).then(|| {
                let reach = &Reach::NONE;
                Guide::new(NODES_OF_WOUNDS, margin, venation, &frame, size, reach, tissue)
            });
            let guide = finer.as_ref().unwrap_or(&guide);
            let lattice = Lattice { frame: &frame, side: guide.side() };
            Wounds::new(paint.damage, margin, venation, guide, &lattice, per_mm as f32, seed)
        });
        let band = band_rows(size);
        Self {
            size,
            band,
            frame,
            per_mm: per_mm as f32,
            outline: margin.outline().iter().map(pixel).collect(),
            slits: slits.collect(),
            strokes: Strokes::new(venation, if goes_on { neck } else { 0.0 }, &frame, size, band),
            guide,
            nets: [0, 1, 2].map(|k| {
                let (size, cells) = (tissue::MESH_MM[k], tissue::CELLS[k]);
                Net::new(size, cells, per_mm as f32, tissue ^ (0x51 + k as u32))
            }),
            stalk,
            shield: margin.is_peltate(),
            widest,
            neck,
            wounds,
            seed: tissue,
            laid,
        }
    }

    /// Whether the same leaf under these settings lies so.
    pub(super) fn serves(&self, paint: &Paint<'_>) -> bool {
        self.laid == Laid::of(paint)
    }

    /// How far the leaf covered the texels before there were wounds (255 for all).
    pub(super) fn whole(&self) -> Grid<u8> {
        let size = self.size;
        let rows = |first: usize| {
            let rows = first..(first + self.band).min(size);
            let blade = self.blade_cover(rows.clone());
            let stalk = self.stalk.rows(&self.frame, size, rows);
            let seen = |(i, blade): (usize, f32)| {
                let stalk = stalk.as_ref().map_or(0.0, |stalk| stalk[i].cover);
                byte(1.0 - (1.0 - blade) * (1.0 - stalk))
            };
            blade.into_iter().enumerate().map(seen).collect::<Vec<u8>>()
        };
        let bands: Vec<Vec<u8>> =
            (0..size.div_ceil(self.band)).into_par_iter().map(|i| rows(i * self.band)).collect();
        Grid::from_values(size, size, bands.concat())
    }

    pub(super) fn blade_cover(&self, rows: Range<usize>) -> Vec<f32> {
        let mut cover = polygon_rows(&self.outline, self.size, rows.clone());
        for slit in &self.slits {
            let [columns, lines] = slit.pixels(slit.widest() + 0.5, self.size, rows.clone());
            for y in lines {
                for x in columns.clone() {
                    let centre = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    let distance = slit.nearest(centre).0.sqrt();
                    let open = stroke_share(distance, slit.widest(), 0.5);
                    let texel = &mut cover[(y - rows.start) * self.size + x];
                    *texel = texel.min(1.0 - open);
                }
            }
        }
        cover
    }
}

/// Where the speckles lie: darts on the blade, the same for both sides.
fn speckles(count: u64, margin: &Margin, seed: Seed) -> Vec<DVec2> {
    let inside = SegmentIndex::of_polygon(margin.outline());
    let bounds = margin.bounds();
    let mut rng = seed.stream(Stage::Speckles);
    let mut speckles = Vec::new();
    // A bound, so that a blade which is a mere sliver of its box ends with fewer, not never.
    for _ in 0..count.saturating_mul(100) {
        if speckles.len() as u64 == count {
            break;
        }
        let x = rng.between(bounds.min.x, bounds.max.x);
        let p = DVec2::new(x, rng.between(bounds.min.y, bounds.max.y));
        if inside.contains(p) {
            speckles.push(p);
        }
    }
    speckles
}
