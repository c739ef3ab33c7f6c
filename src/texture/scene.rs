//! One leaf laid out on its texture, and painting it by bands of rows.
//!
//! A band knows everything it needs, so bands run in parallel and in any order with the same
//! bytes. What looks at neighbours, normals and occlusion, is made from the heights afterwards.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::Paint;
use super::damage::{WoundAt, Wounds};
use super::fields::{Strokes, midrib};
use super::guide::{Guide, Lattice, Reach};
use super::map::{MapKind, MapSet};
use super::optics::{self, Optics};
use super::petiole::{Stalk, StalkAt};
use super::pigment::{Course, Pigments};
use super::relief::Relief;
use super::side::SideMaps;
use super::texel::{Shade, Texel, Walker};
use super::tissue;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::raster::Grid;
use crate::raster::color::byte;
use crate::raster::coverage::{Capsule, polygon_rows, stroke_share};
use crate::seed::{Seed, Stage};
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Rows painted at once: enough that a vein is not looked at again for every few rows, few enough
/// that a band's fields stay in the cache of a core.
const BAND: usize = 32;

/// A slit is open this wide (mm): the edges of torn tissue shrink back a little.
const SLIT_MM: f64 = 0.15;

/// The petiole is at least this share of its own width where it meets the blade.
const NECK: f64 = 0.74;

/// A midrib with this share of the radius at the base is the only primary.
const LEADS: f64 = 0.9;

pub(super) struct Scene {
    pub(super) size: usize,
    pub(super) frame: TextureFrame,
    pub(super) per_mm: f32,
    outline: Vec<DVec2>,
    slits: Vec<Capsule>,
    strokes: Strokes,
    guide: Guide,
    stalk: Stalk,
    pub(super) stalk_length: f32,
    pub(super) pigments: Pigments,
    pub(super) course: Course,
    wounds: Option<Wounds>,
    pub(super) relief: Relief,
    pub(super) optics: Optics,
    maps: MapSet,
    pub(super) seed: u32,
}

/// The rows of one side's maps that a band fills; empty where a map is not kept.
struct SideRows<'a> {
    colour: &'a mut [[u8; 4]],
    height: &'a mut [u16],
    bump: &'a mut [u8],
    roughness: &'a mut [u8],
    transmission: &'a mut [u8],
    translucency: &'a mut [[u8; 3]],
    thickness: &'a mut [u16],
    vein_mask: &'a mut [u8],
    vein_order: &'a mut [u8],
}

impl Scene {
    pub(super) fn new(paint: &Paint<'_>, margin: &Margin, venation: &Venation, seed: Seed) -> Self {
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
        let stalk = Stalk::new(paint.petiole, neck, &midrib, leads);
        let (blade, below) = (margin.bounds(), stalk.bounds());
        let frame = TextureFrame::around(
            blade.min.min(below.min),
            blade.max.max(below.max),
            paint.texture.gutter,
        );
        let per_mm = frame.pixels_per_mm(size);
        let tissue = seed.stream(Stage::Tissue).bits() as u32;
        let speckles = speckles(paint, margin, seed);
        let reach = Reach {
            vein_spread: paint.colour.vein_spread,
            speckles: &speckles,
            speckle_mm: paint.colour.spread_mm,
        };
        let pixel = |p: &DVec2| frame.pixel_from_leaf(*p, size);
        let slits = margin.cuts().iter().flat_map(|cut| cut.windows(2)).map(|w| {
            let radius = (0.5 * SLIT_MM * per_mm) as f32;
            let [a, b] = [pixel(&w[0]).as_vec2(), pixel(&w[1]).as_vec2()];
            Capsule { a, b, radius_a: radius, radius_b: radius }
        });
        let shown = tissue::shown(tissue::MESH_MM[tissue::AREOLE], per_mm as f32);
        let guide = Guide::new(margin, venation, &frame, size, &reach, tissue);
        let lattice = Lattice { frame: &frame, side: guide.side() };
        let wounds =
            Wounds::new(paint.damage, margin, venation, &guide, &lattice, per_mm as f32, seed);
        let sun_deg = seed.stream(Stage::Senescence).between(0.0, 360.0);
        let course = Course::new(
            &paint.colour.pigments.autumn,
            paint.state,
            margin.length_mm(),
            margin.area_mm2(),
            sun_deg,
        );
        let petiole_reach = 6.0 * neck as f32;
        Self {
            size,
            frame,
            per_mm: per_mm as f32,
            outline: margin.outline().iter().map(pixel).collect(),
            slits: slits.collect(),
            strokes: Strokes::new(venation, if goes_on { neck } else { 0.0 }, &frame, size),
            guide,
            wounds,
            course,
            stalk_length: paint.petiole.length_mm as f32,
            pigments: Pigments::new(
                paint.colour,
                paint.state,
                &paint.petiole.colour,
                petiole_reach,
            ),
            relief: Relief::new(paint.relief, widest, neck, stalk.widest(), shown),
            optics: Optics::new(paint.relief),
            maps: paint.maps,
            stalk,
            seed: tissue,
        }
    }

    pub(super) fn frame(&self) -> TextureFrame {
        self.frame
    }

    pub(super) fn petiole_end(&self) -> DVec2 {
        self.stalk.end()
    }

    /// Outline and gaps of a damaged blade (mm); none where it is whole.
    pub(super) fn rings(&self) -> Vec<Vec<DVec2>> {
        let wounds = self.wounds.as_ref();
        wounds.map_or_else(Vec::new, |wounds| wounds.rings(&self.guide, &self.frame))
    }

    /// From the lowest to the highest place that the height maps can show (mm).
    pub(super) fn height_range_mm(&self) -> f64 {
        2.0 * f64::from(self.relief.bound())
    }

    /// Thickness that the greatest value of the thickness maps stands for (mm).
    pub(super) fn thickness_range_mm(&self) -> f64 {
        f64::from(self.relief.thickest())
    }

    /// Both sides, empty where the leaf is not, heights without their normals; the back mirrored.
    pub(super) fn paint(&self) -> [SideMaps; 2] {
        let size = self.size;
        let mut sides = [SideMaps::empty(size, self.maps), SideMaps::empty(size, self.maps)];
        let [front, back] = &mut sides;
        let bands: Vec<_> = bands(front, size).zip(bands(back, size)).collect();
        bands.into_par_iter().enumerate().for_each(|(i, (mut front, mut back))| {
            let rows = i * BAND..((i + 1) * BAND).min(size);
            self.paint_band(rows, [&mut front, &mut back]);
        });
        sides
    }

    fn paint_band(&self, rows: Range<usize>, sides: [&mut SideRows<'_>; 2]) {
        let size = self.size;
        let cover = self.blade_cover(rows.clone());
        let stalk = self.stalk.rows(&self.frame, size, rows.clone());
        let spans = spans(&cover, stalk.as_deref(), size);
        if spans.iter().all(Range::is_empty) {
            return;
        }
        let veins = self.strokes.rows(size, rows.clone());
        let mut walker = Walker::new(self);
        let [front, back] = sides;
        for y in rows.clone() {
            let line = (y - rows.start) * size;
            let span = spans[y - rows.start].clone();
            if span.is_empty() {
                continue;
            }
            let guide = self.guide.row(y);
            let wounds = self.wounds.as_ref().map(|wounds| wounds.row(y));
            for x in span {
                let i = line + x;
                let stalk = stalk.as_ref().map_or(StalkAt::default(), |stalk| stalk[i]);
                let wound = wounds.as_ref().map_or(WoundAt::NONE, |wounds| wounds.at(x));
                let texel = walker.texel(x, y, guide.at(x), veins[i], (cover[i], wound), stalk);
                if texel.alpha > 0 {
                    // Mirrored with the picture: what lies right in front lies left behind.
                    self.put(&texel, [(front, i), (back, line + size - 1 - x)]);
                }
            }
        }
    }

    /// Writes a texel to the planes that are kept.
    #[inline]
    fn put(&self, texel: &Texel<'_>, places: [(&mut SideRows<'_>, usize); 2]) {
        let maps = self.maps;
        let colours = texel.colours();
        let [heights, bumps, roughness] = [
            if maps.has(MapKind::Height) { texel.heights() } else { [0.0; 2] },
            if maps.has(MapKind::Bump) { texel.bumps() } else { [0.0; 2] },
            if maps.has(MapKind::Roughness) { texel.roughness() } else { [0.0; 2] },
        ];
        let thickness = if maps.has(MapKind::Thickness) { texel.thickness() } else { 0.0 };
        let scale = 65535.0 / (2.0 * self.relief.bound());
        for (side, (rows, at)) in places.into_iter().enumerate() {
            let Shade { reflected, through } = colours[side];
            let [r, g, b] = reflected.map(byte);
            rows.colour[at] = [r, g, b, texel.alpha];
            if let Some(height) = rows.height.get_mut(at) {
                *height = (heights[side] * scale + 32768.0) as u16;
            }
            if let Some(bump) = rows.bump.get_mut(at) {
                *bump = bumps[side] as u8;
            }
            if let Some(slot) = rows.roughness.get_mut(at) {
                *slot = byte(roughness[side]);
            }
            if let Some(slot) = rows.transmission.get_mut(at) {
                *slot = byte(optics::transmitted_share(reflected, through));
            }
            if let Some(slot) = rows.translucency.get_mut(at) {
                *slot = through.map(byte);
            }
            if let Some(slot) = rows.thickness.get_mut(at) {
                *slot = (thickness / self.relief.thickest() * 65535.0 + 0.5) as u16;
            }
            if let Some(slot) = rows.vein_mask.get_mut(at) {
                *slot = texel.vein_mask();
            }
            if let Some(slot) = rows.vein_order.get_mut(at) {
                *slot = texel.vein_order();
            }
        }
    }

    fn blade_cover(&self, rows: Range<usize>) -> Vec<f32> {
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
fn speckles(paint: &Paint<'_>, margin: &Margin, seed: Seed) -> Vec<DVec2> {
    let count = match paint.colour.speckle_count {
        0 => paint.default_speckles,
        count => count,
    };
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

/// In each row the columns from the first to the last that anything covers.
fn spans(cover: &[f32], stalk: Option<&[StalkAt]>, width: usize) -> Vec<Range<usize>> {
    let covered = |i: usize| cover[i] > 0.0 || stalk.is_some_and(|stalk| stalk[i].cover > 0.0);
    (0..cover.len() / width)
        .map(|y| {
            let row = y * width;
            let first = (0..width).find(|&x| covered(row + x));
            let last = (0..width).rev().find(|&x| covered(row + x));
            first.zip(last).map_or(0..0, |(first, last)| first..last + 1)
        })
        .collect()
}

fn bands(side: &mut SideMaps, size: usize) -> impl Iterator<Item = SideRows<'_>> {
    // A plane that is not kept has no rows, in every band.
    fn chunks<T>(plane: &mut Grid<T>, size: usize) -> impl Iterator<Item = &mut [T]> {
        plane.values_mut().chunks_mut(BAND * size).chain(std::iter::repeat_with(Default::default))
    }
    let mut height = chunks(&mut side.height, size);
    let mut bump = chunks(&mut side.bump, size);
    let mut roughness = chunks(&mut side.roughness, size);
    let mut transmission = chunks(&mut side.transmission, size);
    let mut translucency = chunks(&mut side.translucency, size);
    let mut thickness = chunks(&mut side.thickness, size);
    let mut vein_mask = chunks(&mut side.vein_mask, size);
    let mut vein_order = chunks(&mut side.vein_order, size);
    side.base_colour.values_mut().chunks_mut(BAND * size).map_while(move |colour| {
        Some(SideRows {
            colour,
            height: height.next()?,
            bump: bump.next()?,
            roughness: roughness.next()?,
            transmission: transmission.next()?,
            translucency: translucency.next()?,
            thickness: thickness.next()?,
            vein_mask: vein_mask.next()?,
            vein_order: vein_order.next()?,
        })
    })
}
