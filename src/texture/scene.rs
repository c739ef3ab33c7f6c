//! One leaf laid out on its texture, and painting it by bands of rows.
//!
//! A band knows everything it needs, so bands run in parallel and in any order with the same
//! bytes. Each computes a row more on either side, for the slopes of its outermost rows.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::fields::{Guide, Strokes, VeinAt, midrib};
use super::normals;
use super::petiole::{Stalk, StalkAt};
use super::pigment::{Pigments, Tissue};
use super::relief::{Ground, Relief};
use super::tissue::{self, Net, smooth};
use super::{Paint, SideMaps};
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::raster::Grid;
use crate::raster::color::byte;
use crate::raster::coverage::{Capsule, polygon_rows, stroke_share};
use crate::seed::{Seed, Stage};
use crate::units::TextureFrame;
use crate::veins::Venation;

use super::guide::Reach;

/// Rows painted at once: enough that the rows shared with the neighbours cost little, few enough
/// that a band's fields stay in the cache of a core.
const BAND: usize = 32;

/// A slit is open this wide (mm): the edges of torn tissue shrink back a little.
const SLIT_MM: f64 = 0.15;

/// The petiole is at least this share of its own width where it meets the blade.
const NECK: f64 = 0.62;

/// Fibres are longer than wide by the inverse of this.
const FIBRE_STRETCH: f32 = 0.08;

pub(super) struct Scene {
    size: usize,
    frame: TextureFrame,
    per_mm: f32,
    outline: Vec<DVec2>,
    slits: Vec<Capsule>,
    strokes: Strokes,
    guide: Guide,
    stalk: Stalk,
    stalk_length: f32,
    pigments: [Pigments; 2],
    relief: Relief,
    seed: u32,
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
    // A margin fills more than a hundredth of its box, or it would not have been made.
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

/// Goes along the rows of a band, with the nets' neighbourhoods at hand.
struct Walker<'a> {
    scene: &'a Scene,
    nets: [Net; 3],
    shown: [f32; 3],
    lines: [f32; 3],
    grain: f32,
    mm: f32,
    min: [f32; 2],
}

impl<'a> Walker<'a> {
    fn new(scene: &'a Scene) -> Self {
        let sizes = tissue::MESH_MM;
        Self {
            scene,
            nets: [0, 1, 2].map(|k| Net::new(sizes[k], scene.seed ^ (0x51 + k as u32))),
            shown: sizes.map(|size| tissue::shown(size, scene.per_mm)),
            lines: tissue::LINE_MM.map(|half| half * scene.per_mm),
            grain: tissue::grain_size(scene.per_mm),
            mm: 1.0 / scene.per_mm,
            min: scene.frame.min.as_vec2().to_array(),
        }
    }

    #[inline]
    fn texel(
        &mut self,
        column: usize,
        row: usize,
        place: super::guide::Place,
        vein: VeinAt,
        blade: f32,
        stalk: StalkAt,
    ) -> Texel<'a> {
        let scene = self.scene;
        let x = self.min[0] + (column as f32 + 0.5) * self.mm;
        let y = self.min[1] + (scene.size as f32 - row as f32 - 0.5) * self.mm;
        // The net is drawn out and bent by the tissue's own unevenness.
        let [_, middle, fine] = place.noise;
        let (bent_x, bent_y) = (x + 0.5 * middle + 0.25 * fine, y + 0.45 * fine - 0.4 * middle);
        let (mut lines, mut tones, mut border) = ([0.0; 3], [0.0; 3], 0.0);
        for (k, net) in self.nets.iter_mut().enumerate() {
            let [none, full] = tissue::AWAY_MM[k];
            let shown = self.shown[k] * smooth(none, full, place.vein);
            if self.shown[k] == 0.0 || (shown == 0.0 && k != tissue::AREOLE) {
                continue;
            }
            let mesh = net.at(bent_x, bent_y);
            let half = (0.7 * self.lines[k]).max(0.7);
            lines[k] = shown * stroke_share(mesh.border / self.mm, self.lines[k], half);
            tones[k] = shown * (2.0 * mesh.tone - 1.0);
            if k == tissue::AREOLE {
                border = mesh.border;
            }
        }
        let grain = tissue::grain(x, y, self.grain, scene.seed ^ 0x77);
        // The stalk is made of fibres: its grain is drawn out along it.
        let fibre = if stalk.cover > 0.0 {
            tissue::grain(x, stalk.along * FIBRE_STRETCH, 2.0 * self.grain, scene.seed ^ 0x99)
        } else {
            0.0
        };
        let from_base = (x * x + y * y).sqrt();
        Texel {
            scene,
            alpha: byte(1.0 - (1.0 - blade) * (1.0 - stalk.cover)),
            blade,
            stalk,
            fibre,
            ground: Ground { place, vein, border, grain },
            tissue: Tissue { place, vein, lines, tones, grain, from_base },
        }
    }
}

/// Everything at one texel.
struct Texel<'a> {
    scene: &'a Scene,
    alpha: u8,
    blade: f32,
    stalk: StalkAt,
    /// Grain of the stalk, −1 – 1.
    fibre: f32,
    ground: Ground,
    tissue: Tissue,
}

impl Texel<'_> {
    /// How much of what is seen is the stalk: under the blade in front, over it behind.
    #[inline]
    fn stalk_shares(&self) -> [f32; 2] {
        let (blade, stalk) = (self.blade, self.stalk.cover);
        let seen = blade + stalk - blade * stalk;
        if stalk == 0.0 || seen <= 0.0 {
            return [0.0; 2];
        }
        let (under, over) = (stalk * (1.0 - blade) / seen, stalk / seen);
        // Its upper end dips into the midrib.
        let emerged = smooth(-4.0, 1.0, self.stalk.along / self.stalk.radius.max(1e-6));
        [under, under + (over - under) * emerged]
    }

    #[inline]
    fn heights(&self) -> [f32; 2] {
        let [front, back] = self.scene.relief.heights(&self.ground);
        if self.stalk.cover == 0.0 {
            return [front, back];
        }
        let [under, over] = self.stalk_shares();
        let [stalk_front, stalk_back] = self.scene.relief.stalk_heights(&self.stalk);
        // Behind, stalk and midrib are one cord: whichever is higher.
        let cord = back.max(stalk_back);
        [front + (stalk_front - front) * under, back + (cord - back) * over]
    }

    #[inline]
    fn bumps(&self) -> [u8; 2] {
        let blade = self.scene.relief.bumps(&self.ground);
        if self.stalk.cover == 0.0 {
            return blade;
        }
        let (stalk, shares) = (self.scene.relief.stalk_bumps(), self.stalk_shares());
        std::array::from_fn(|side| {
            let (blade, stalk) = (f32::from(blade[side]), f32::from(stalk[side]));
            (blade + (stalk - blade) * shares[side] + 0.5) as u8
        })
    }

    #[inline]
    fn colours(&self) -> [[u8; 4]; 2] {
        let shares = self.stalk_shares();
        std::array::from_fn(|side| {
            let pigments = &self.scene.pigments[side];
            let mut rgb = pigments.blade(&self.tissue).srgb();
            if shares[side] > 0.0 {
                let length = self.scene.stalk_length;
                let stalk = pigments.stalk(&self.stalk, length, self.fibre).srgb();
                rgb = std::array::from_fn(|k| rgb[k] + (stalk[k] - rgb[k]) * shares[side]);
            }
            let [r, g, b] = rgb.map(byte);
            [r, g, b, self.alpha]
        })
    }
}
