//! A band of rows, painted strip by strip.

use std::ops::Range;

use super::brush::{Painted, Shade};
use super::deep::Deep;
use super::fields::VeinRows;
use super::guide::MixedRow;
use super::map::MapKind;
use super::petiole::StalkAt;
use super::scene::Scene;
use super::side::SideMaps;
use super::strip::{Grain, LANES, Strip};
use crate::geometry::whole;
use crate::raster::Grid;
use crate::raster::color::{byte, word};

/// The rows of one side's maps that a band fills; empty where a map is not kept.
pub(super) struct SideRows<'a> {
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

/// What the bands that one thread paints use one after the other.
#[derive(Default)]
pub(super) struct Scratch {
    veins: VeinRows,
    guide: MixedRow,
}

/// A band of rows to be painted, with whatever vector instructions the processor has: no result depends
/// on which, since every number is rounded alike.
pub(super) struct Band<'a> {
    pub(super) scene: &'a Scene<'a>,
    pub(super) number: usize,
    pub(super) rows: Range<usize>,
    pub(super) sides: (SideRows<'a>, SideRows<'a>),
    pub(super) scratch: &'a mut Scratch,
}

impl pulp::WithSimd for Band<'_> {
    type Output = Vec<Range<usize>>;

    /// Where in each row something was painted.
    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> Vec<Range<usize>> {
        let Self { scene, number, rows, sides, scratch } = self;
        let size = scene.layout.size;
        let cover = scene.layout.blade_cover(rows.clone());
        let stalk = scene.layout.stalk.rows(&scene.layout.frame, size, rows.clone());
        let spans = spans(&cover, stalk.as_deref(), size);
        let (mut front, mut back) = sides;
        // Mirrored with the picture: what lies right in front lies left behind.
        let behind = |line: usize, columns: &Range<usize>| {
            (line + 1) * size - columns.end..(line + 1) * size - columns.start
        };
        for (line, span) in spans.iter().enumerate() {
            for bare in [0..span.start, span.end..size] {
                back.clear(behind(line, &bare));
                front.clear(line * size + bare.start..line * size + bare.end);
            }
        }
        let painted = spans.iter().filter(|span| !span.is_empty());
        let Some(columns) = painted.cloned().reduce(|a, b| a.start.min(b.start)..a.end.max(b.end))
        else {
            return spans;
        };
        let orders = scene.maps.has(MapKind::VeinOrder);
        scene.layout.strokes.fill(number, rows.clone(), &columns, orders, &mut scratch.veins);
        let at = |x: usize, y: usize| {
            let [left, bottom] = scene.layout.frame.min.as_vec2().to_array();
            [
                left + x as f32 / scene.layout.per_mm,
                bottom + (size - y) as f32 / scene.layout.per_mm,
            ]
        };
        let mut grain = Grain::new(scene);
        let (mut strip, mut painted) = (Strip::empty(), Painted::empty());
        for (y, span) in rows.clone().zip(&spans) {
            if span.is_empty() {
                continue;
            }
            let line = y - rows.start;
            let guide = scene.layout.guide.row(y, span, &mut scratch.guide);
            let wounds = scene.layout.wounds.as_ref().map(|wounds| wounds.row(y));
            let [left, low] = at(span.start, y + 1);
            let height = low + 0.5 / scene.layout.per_mm;
            grain.prepare(left, at(span.end, y)[0], height, scene.layout.seed);
            for start in span.clone().step_by(LANES) {
                let columns = start..(start + LANES).min(span.end);
                let texels = line * size + columns.start..line * size + columns.end;
                strip.go_to(scene, start, texels.len(), y);
                strip.read_guide(&guide);
                strip.read_veins(&scratch.veins, line);
                let stalk = stalk.as_ref().map(|stalk| &stalk[texels.clone()]);
                strip.read_cover(&cover[texels.clone()], stalk);
                strip.read_structure(scene, &grain);
                if let Some(wounds) = &wounds {
                    strip.read_wounds(scene, wounds);
                }
                strip.read_condition(scene);
                painted.paint(scene, &strip, scene.maps);
                front.put(0, texels.clone(), scene, &strip, &painted);
                back.put(1, behind(line, &columns), scene, &strip, &painted);
            }
        }
        spans
    }
}

impl SideRows<'_> {
    /// Clears texels that no leaf covers, of planes that nothing is spread in.
    fn clear(&mut self, texels: Range<usize>) {
        fn zero<T: Copy + Default>(plane: &mut [T], texels: &Range<usize>) {
            // A plane that is not kept has no texels.
            if let Some(row) = plane.get_mut(texels.clone()) {
                row.fill(T::default());
            }
        }
        // Colour for its alpha.
        zero(self.colour, &texels);
        zero(self.deep_colour, &texels);
        zero(self.thickness, &texels);
        zero(self.vein_mask, &texels);
        zero(self.vein_order, &texels);
        zero(self.deep_vein_mask, &texels);
    }

    /// Writes a strip to the planes that are kept; the back from right to left.
    #[inline(always)]
    fn put(
        &mut self,
        side: usize,
        texels: Range<usize>,
        scene: &Scene<'_>,
        strip: &Strip,
        painted: &Painted,
    ) {
        // A plane that is not kept has no texels. What is laid is worked out first, in a loop and not in
        // a closure: those are compiled out of line, without vectors.
        macro_rules! lay {
            ($plane:expr, $empty:expr, |$i:ident| $value:expr) => {
                if let Some(row) = $plane.get_mut(texels.clone()) {
                    let mut values = [$empty; LANES];
                    for $i in 0..LANES {
                        values[$i] = $value;
                    }
                    laid(row, side, &values);
                }
            };
        }
        let per_height = 65535.0 / (2.0 * scene.relief.bound());
        let per_thickness = 65535.0 / scene.relief.thickest();
        let (shades, alpha) = (&painted.shades[side], &painted.alpha);
        let (heights, bumps) = (&painted.heights[side], &painted.bumps[side]);
        let (roughness, transmission) = (&painted.roughness[side], &painted.transmission[side]);
        lay!(self.colour, [0; 4], |i| {
            let [r, g, b] = Shade::at(shades, i).reflected;
            [byte(r), byte(g), byte(b), byte(alpha[i])]
        });
        lay!(self.height, 0, |i| whole::cut(heights[i] * per_height + 32768.0, 65535.0) as u16);
        lay!(self.bump, 0, |i| whole::cut(bumps[i], 255.0) as u8);
        lay!(self.roughness, 0, |i| byte(roughness[i]));
        lay!(self.transmission, 0, |i| byte(transmission[i]));
        lay!(self.translucency, [0; 3], |i| {
            let [r, g, b] = Shade::at(shades, i).through;
            [byte(r), byte(g), byte(b)]
        });
        lay!(self.thickness, 0, |i| {
            whole::cut(painted.thickness[i] * per_thickness + 0.5, 65535.0) as u16
        });
        lay!(self.vein_mask, 0, |i| byte(strip.vein_mask(i)));
        lay!(self.vein_order, 0, |i| strip.vein_order(i));
        lay!(self.deep_colour, [0; 4], |i| {
            let [r, g, b] = Shade::at(shades, i).reflected;
            [word(r), word(g), word(b), word(alpha[i])]
        });
        lay!(self.deep_roughness, 0, |i| word(roughness[i]));
        lay!(self.deep_transmission, 0, |i| word(transmission[i]));
        lay!(self.deep_translucency, [0; 3], |i| {
            let [r, g, b] = Shade::at(shades, i).through;
            [word(r), word(g), word(b)]
        });
        lay!(self.deep_vein_mask, 0, |i| word(strip.vein_mask(i)));
    }
}

/// Copies a strip to its texels; behind, from right to left.
#[inline(always)]
fn laid<T: Copy>(texels: &mut [T], side: usize, values: &[T; LANES]) {
    let n = texels.len().min(LANES);
    if side == 0 {
        texels[..n].copy_from_slice(&values[..n]);
    } else {
        let mut mirrored = *values;
        mirrored.reverse();
        texels[..n].copy_from_slice(&mirrored[LANES - n..]);
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

pub(super) fn bands(side: &mut SideMaps, band: usize) -> impl Iterator<Item = SideRows<'_>> {
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
