//! One leaf laid out on its texture, and painting it by bands of rows.
//!
//! A band knows everything it needs, so bands run in parallel and in any order with the same
//! bytes. Each computes a row more on either side, for the slopes of its outermost rows.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::fields::{Strokes, midrib};
use super::guide::{Guide, Reach};
use super::normals;
use super::petiole::{Stalk, StalkAt};
use super::pigment::Pigments;
use super::relief::Relief;
use super::texel::Walker;
use super::tissue;
use super::{Paint, SideMaps};
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::raster::Grid;
use crate::raster::coverage::{Capsule, polygon_rows, stroke_share};
use crate::seed::{Seed, Stage};
use crate::units::TextureFrame;
use crate::veins::Venation;

/// Rows painted at once: enough that the rows shared with the neighbours cost little, few enough
/// that a band's fields stay in the cache of a core.
const BAND: usize = 32;

/// A slit is open this wide (mm): the edges of torn tissue shrink back a little.
const SLIT_MM: f64 = 0.15;

/// The petiole is at least this share of its own width where it meets the blade.
const NECK: f64 = 0.62;

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
    pub(super) pigments: [Pigments; 2],
    pub(super) relief: Relief,
    pub(super) seed: u32,
}

/// The rows of one side's maps that a band fills.
struct SideRows<'a> {
    colour: &'a mut [[u8; 4]],
    height: &'a mut [u16],
    normal: &'a mut [[u8; 3]],
    bump: &'a mut [u8],
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
        let midrib: Vec<DVec2> =
            midrib(venation).into_iter().map(|node| graph.positions()[node as usize]).collect();
        let stalk = Stalk::new(paint.petiole, neck, &midrib);
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
        Self {
            size,
            frame,
            per_mm: per_mm as f32,
            outline: margin.outline().iter().map(pixel).collect(),
            slits: slits.collect(),
            strokes: Strokes::new(venation, neck, &frame, size),
            guide: Guide::new(margin, venation, &frame, size, &reach, tissue),
            stalk_length: paint.petiole.length_mm as f32,
            pigments: Pigments::of_sides(paint.colour, &paint.petiole.colour, 6.0 * neck as f32),
            relief: Relief::new(paint.relief, widest, neck, stalk.widest(), shown),
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

    /// From the lowest to the highest place that the height maps can show (mm).
    pub(super) fn height_range_mm(&self) -> f64 {
        2.0 * f64::from(self.relief.bound())
    }

    /// Both sides as seen from the front, empty where the leaf is not.
    pub(super) fn paint(&self) -> [SideMaps; 2] {
        let size = self.size;
        let mut sides = [SideMaps::empty(size), SideMaps::empty(size)];
        let [front, back] = &mut sides;
        (bands(front, size), bands(back, size)).into_par_iter().enumerate().for_each(
            |(i, (front, back))| {
                let rows = i * BAND..((i + 1) * BAND).min(size);
                self.paint_band(rows, front, back);
            },
        );
        sides
    }

    fn paint_band(&self, rows: Range<usize>, mut front: SideRows<'_>, mut back: SideRows<'_>) {
        let size = self.size;
        let halo = rows.start.saturating_sub(1)..(rows.end + 1).min(size);
        let cover = self.blade_cover(halo.clone());
        let stalk = self.stalk.rows(&self.frame, size, halo.clone());
        let spans = spans(&cover, stalk.as_deref(), size);
        if spans.iter().all(Range::is_empty) {
            return;
        }
        let veins = self.strokes.rows(size, halo.clone());
        let mut heights = vec![[0.0_f32; 2]; size * halo.len()];
        let mut walker = Walker::new(self);
        for y in halo.clone() {
            let k = y - halo.start;
            // Slopes reach one texel over the edge, to the sides as well as up and down.
            let span = [k.saturating_sub(1), k, (k + 1).min(halo.len() - 1)]
                .into_iter()
                .map(|k| spans[k].clone())
                .filter(|span| !span.is_empty())
                .reduce(|a, b| a.start.min(b.start)..a.end.max(b.end));
            let Some(span) = span else { continue };
            let row = k * size..(k + 1) * size;
            let within = rows.contains(&y).then(|| y - rows.start);
            let guide = self.guide.row(y);
            for x in span.start.saturating_sub(1)..(span.end + 1).min(size) {
                let i = row.start + x;
                let stalk = stalk.as_ref().map_or(StalkAt::default(), |stalk| stalk[i]);
                let texel = walker.texel(x, y, guide.at(x), veins[i], cover[i], stalk);
                heights[i] = texel.heights();
                if let Some(line) = within
                    && texel.alpha > 0
                {
                    let at = line * size + x;
                    [front.colour[at], back.colour[at]] = texel.colours();
                    [front.bump[at], back.bump[at]] = texel.bumps();
                }
            }
        }
        self.write_relief(&heights, &halo, &rows, &mut front, &mut back);
    }

    /// Heights and normals of the texels that have a colour.
    fn write_relief(
        &self,
        heights: &[[f32; 2]],
        halo: &Range<usize>,
        rows: &Range<usize>,
        front: &mut SideRows<'_>,
        back: &mut SideRows<'_>,
    ) {
        let size = self.size;
        let scale = 65535.0 / (2.0 * self.relief.bound());
        for y in rows.clone() {
            let (line, k) = ((y - rows.start) * size, y - halo.start);
            // At the border of the picture the difference is one-sided.
            let (above, below) = (k.saturating_sub(1), (k + 1).min(halo.len() - 1));
            let per_y = self.per_mm / (below - above).max(1) as f32;
            for x in 0..size {
                let at = line + x;
                if front.colour[at][3] == 0 {
                    continue;
                }
                let (left, right) = (x.saturating_sub(1), (x + 1).min(size - 1));
                let per_x = self.per_mm / (right - left).max(1) as f32;
                let h = |column: usize, row: usize| heights[row * size + column];
                let (here, west, east) = (h(x, k), h(left, k), h(right, k));
                let (north, south) = (h(x, above), h(x, below));
                let slopes = |side: usize| {
                    ((east[side] - west[side]) * per_x, (north[side] - south[side]) * per_y)
                };
                let ((dx, dy), (back_dx, back_dy)) = (slopes(0), slopes(1));
                front.normal[at] = normals::encoded(normals::from_slopes(dx, dy));
                // Mirrored with the picture: what rises to the right here rises to the left there.
                back.normal[at] = normals::encoded(normals::from_slopes(-back_dx, back_dy));
                front.height[at] = (here[0] * scale + 32768.0) as u16;
                back.height[at] = (here[1] * scale + 32768.0) as u16;
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

fn bands(side: &mut SideMaps, size: usize) -> impl IndexedParallelIterator<Item = SideRows<'_>> {
    fn chunks<T: Send>(grid: &mut Grid<T>, size: usize) -> rayon::slice::ChunksMut<'_, T> {
        grid.values_mut().par_chunks_mut(BAND * size)
    }
    (
        chunks(&mut side.base_colour, size),
        chunks(&mut side.height, size),
        chunks(&mut side.normal, size),
        chunks(&mut side.bump, size),
    )
        .into_par_iter()
        .map(|(colour, height, normal, bump)| SideRows { colour, height, normal, bump })
}
