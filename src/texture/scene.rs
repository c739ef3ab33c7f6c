//! One leaf laid out on its texture, and painting it by bands of rows.
//!
//! A band knows everything it needs, so bands run in parallel and in any order with the same
//! bytes. What looks at neighbours, normals and occlusion, is made from the heights afterwards.

use std::ops::Range;

use glam::DVec2;
use rayon::prelude::*;

use super::Paint;
use super::brush::Painted;
use super::damage::Wounds;
use super::deep::Deep;
use super::fields::{Strokes, VeinRows, midrib};
use super::guide::{Guide, Lattice, Reach};
use super::map::{MapKind, MapSet};
use super::optics::Optics;
use super::petiole::{Stalk, StalkAt};
use super::pigment::{Course, Pigments};
use super::relief::Relief;
use super::side::SideMaps;
use super::strip::{LANES, Strip, Structure};
use super::tissue;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::raster::Grid;
use crate::raster::color::{byte, word};
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

pub(super) struct Scene {
    pub(super) size: usize,
    band: usize,
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
    deep_colour: &'a mut [[u16; 4]],
    deep_roughness: &'a mut [u16],
    deep_transmission: &'a mut [u16],
    deep_translucency: &'a mut [[u16; 3]],
    deep_vein_mask: &'a mut [u16],
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
        let band = band_rows(size);
        Self {
            size,
            band,
            frame,
            per_mm: per_mm as f32,
            outline: margin.outline().iter().map(pixel).collect(),
            slits: slits.collect(),
            strokes: Strokes::new(venation, neck, &frame, size, band),
            guide,
            wounds,
            course,
            stalk_length: paint.petiole.length_mm as f32,
            pigments: Pigments::new(
                paint.colour,
                paint.state,
                &paint.petiole.colour,
                petiole_reach,
                !paint.damage.is_none(),
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
        // Normals are made from the heights at the end.
        let maps = self.maps.without(MapKind::Normal);
        let mut sides = [SideMaps::empty(size, maps), SideMaps::empty(size, maps)];
        let [front, back] = &mut sides;
        let bands: Vec<_> =
            bands(front, self.band * size).zip(bands(back, self.band * size)).collect();
        bands.into_par_iter().enumerate().for_each_init(Scratch::default, |scratch, (i, sides)| {
            let rows = i * self.band..((i + 1) * self.band).min(size);
            pulp::Arch::new().dispatch(Band { scene: self, number: i, rows, sides, scratch });
        });
        sides
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

/// What the bands that one thread paints use one after the other.
#[derive(Default)]
struct Scratch {
    veins: VeinRows,
    nodes: Vec<[f32; 8]>,
}

/// A band of rows to be painted, with whatever vector instructions the processor has: no result depends
/// on which, since every number is rounded alike.
struct Band<'a> {
    scene: &'a Scene,
    number: usize,
    rows: Range<usize>,
    sides: (SideRows<'a>, SideRows<'a>),
    scratch: &'a mut Scratch,
}

impl pulp::WithSimd for Band<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) {
        let Self { scene, number, rows, sides, scratch } = self;
        let size = scene.size;
        let cover = scene.blade_cover(rows.clone());
        let stalk = scene.stalk.rows(&scene.frame, size, rows.clone());
        let spans = spans(&cover, stalk.as_deref(), size);
        let painted = spans.iter().filter(|span| !span.is_empty());
        let Some(columns) = painted.cloned().reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
        else {
            return;
        };
        scene.strokes.fill(number, rows.clone(), size, &mut scratch.veins);
        let at = |x: usize, y: usize| {
            let [left, bottom] = scene.frame.min.as_vec2().to_array();
            [left + x as f32 / scene.per_mm, bottom + (size - y) as f32 / scene.per_mm]
        };
        let mut structure = Structure::new(scene);
        structure.prepare(at(columns.start, rows.end), at(columns.end, rows.start));
        let (mut strip, mut painted) = (Strip::empty(), Painted::empty());
        let (mut front, mut back) = sides;
        for (y, span) in rows.clone().zip(&spans) {
            if span.is_empty() {
                continue;
            }
            let line = y - rows.start;
            let guide = scene.guide.row(y, &mut scratch.nodes);
            let wounds = scene.wounds.as_ref().map(|wounds| wounds.row(y));
            let [left, low] = at(span.start, y + 1);
            let height = low + 0.5 / scene.per_mm;
            structure.prepare_row(left, at(span.end, y)[0], height, scene.seed);
            for start in span.clone().step_by(LANES) {
                let texels = line * size + start..line * size + (start + LANES).min(span.end);
                strip.go_to(scene, start, texels.len(), y);
                strip.read_guide(&guide);
                strip.read_veins(&scratch.veins, line);
                let stalk = stalk.as_ref().map(|stalk| &stalk[texels.clone()]);
                strip.read_cover(&cover[texels.clone()], stalk);
                strip.read_structure(scene, &structure);
                if let Some(wounds) = &wounds {
                    strip.read_wounds(scene, wounds);
                }
                strip.read_condition(scene);
                painted.paint(scene, &strip, scene.maps);
                front.put(0, texels.clone(), scene, &strip, &painted);
                // Mirrored with the picture: what lies right in front lies left behind.
                let mirrored = |x: usize| 2 * line * size + size - x;
                let behind = mirrored(texels.end)..mirrored(texels.start);
                back.put(1, behind, scene, &strip, &painted);
            }
        }
    }
}

impl SideRows<'_> {
    /// Writes a strip to the planes that are kept; the back from right to left.
    #[inline(always)]
    fn put(
        &mut self,
        side: usize,
        texels: Range<usize>,
        scene: &Scene,
        strip: &Strip,
        painted: &Painted,
    ) {
        #[inline(always)]
        fn lay<T>(plane: &mut [T], side: usize, texels: Range<usize>, value: impl Fn(usize) -> T) {
            // A plane that is not kept has no texels.
            let Some(texels) = plane.get_mut(texels) else { return };
            let n = texels.len();
            // Written as loops: what iterators do out of line would be done without vectors.
            if side == 0 {
                for (i, texel) in texels.iter_mut().enumerate().take(LANES) {
                    *texel = value(i);
                }
            } else {
                for i in 0..n.min(LANES) {
                    texels[n - 1 - i] = value(i);
                }
            }
        }
        let per_height = 65535.0 / (2.0 * scene.relief.bound());
        let per_thickness = 65535.0 / scene.relief.thickest();
        let (shades, all) = (&painted.shades[side], || texels.clone());
        lay(self.colour, side, all(), |i| {
            let [r, g, b, ..] = shades[i].map(byte);
            [r, g, b, byte(painted.alpha[i])]
        });
        let heights = &painted.heights[side];
        lay(self.height, side, all(), |i| (heights[i] * per_height + 32768.0) as u16);
        lay(self.bump, side, all(), |i| painted.bumps[side][i] as u8);
        lay(self.roughness, side, all(), |i| byte(painted.roughness[side][i]));
        lay(self.transmission, side, all(), |i| byte(painted.transmission[side][i]));
        lay(self.translucency, side, all(), |i| {
            let [_, _, _, r, g, b, ..] = shades[i].map(byte);
            [r, g, b]
        });
        lay(self.thickness, side, all(), |i| (painted.thickness[i] * per_thickness + 0.5) as u16);
        lay(self.vein_mask, side, all(), |i| byte(strip.vein_mask(i)));
        lay(self.vein_order, side, all(), |i| strip.vein_order(i));
        lay(self.deep_colour, side, all(), |i| {
            let [r, g, b, ..] = shades[i].map(word);
            [r, g, b, word(painted.alpha[i])]
        });
        lay(self.deep_roughness, side, all(), |i| word(painted.roughness[side][i]));
        lay(self.deep_transmission, side, all(), |i| word(painted.transmission[side][i]));
        lay(self.deep_translucency, side, all(), |i| {
            let [_, _, _, r, g, b, ..] = shades[i].map(word);
            [r, g, b]
        });
        lay(self.deep_vein_mask, side, all(), |i| word(strip.vein_mask(i)));
    }
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

fn bands(side: &mut SideMaps, band: usize) -> impl Iterator<Item = SideRows<'_>> {
    // A plane that is not kept has no rows, in every band.
    fn chunks<T>(plane: &mut Grid<T>, band: usize) -> impl Iterator<Item = &mut [T]> {
        plane.values_mut().chunks_mut(band).chain(std::iter::repeat_with(Default::default))
    }
    let mut height = chunks(&mut side.height, band);
    let mut bump = chunks(&mut side.bump, band);
    let mut roughness = chunks(&mut side.roughness, band);
    let mut transmission = chunks(&mut side.transmission, band);
    let mut translucency = chunks(&mut side.translucency, band);
    let mut thickness = chunks(&mut side.thickness, band);
    let mut vein_mask = chunks(&mut side.vein_mask, band);
    let mut vein_order = chunks(&mut side.vein_order, band);
    let mut deep = side.deep.as_deref_mut().map(|deep| {
        let Deep { base_colour, roughness, transmission, translucency, vein_mask, .. } = deep;
        let roughness = chunks(roughness, band).zip(chunks(transmission, band));
        let others = chunks(translucency, band).zip(chunks(vein_mask, band));
        chunks(base_colour, band).zip(roughness.zip(others))
    });
    side.base_colour.values_mut().chunks_mut(band).map_while(move |colour| {
        let deep = deep.as_mut().and_then(Iterator::next);
        let (deep_colour, ((deep_roughness, deep_transmission), others)) = deep.unwrap_or_default();
        let (deep_translucency, deep_vein_mask) = others;
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
            deep_colour,
            deep_roughness,
            deep_transmission,
            deep_translucency,
            deep_vein_mask,
        })
    })
}
