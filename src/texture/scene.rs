//! What a leaf that is laid out looks like, and painting it by bands of rows.
//!
//! A band knows everything it needs, so bands run in parallel and in any order with the same
//! bytes. What looks at neighbours, normals and occlusion, is made from the heights afterwards.

use std::ops::Range;

use rayon::prelude::*;

use super::Paint;
use super::band::{Band, Scratch, bands};
use super::canvas::Canvas;
use super::layout::Layout;
use super::map::MapSet;
use super::optics::Optics;
use super::pigment::{Course, Pigments};
use super::relief::Relief;
use super::side::SideMaps;
use super::spans::Spans;
use super::tissue;
use crate::margin::Margin;
use crate::seed::{Seed, Stage};

pub(super) struct Scene<'a> {
    pub(super) layout: &'a Layout,
    pub(super) stalk_length: f32,
    pub(super) pigments: Pigments,
    pub(super) course: Course,
    pub(super) relief: Relief,
    pub(super) optics: Optics,
    pub(super) maps: MapSet,
}

/// The petiole's colour runs into the midrib over so many of its radii.
const PETIOLE_REACH: f32 = 6.0;

impl<'a> Scene<'a> {
    pub(super) fn new(
        layout: &'a Layout,
        paint: &Paint<'_>,
        maps: MapSet,
        margin: &Margin,
        seed: Seed,
    ) -> Self {
        let sun_deg = seed.stream(Stage::Senescence).between(0.0, 360.0);
        let course = Course::new(
            &paint.colour.pigments.autumn,
            paint.state,
            margin.length_mm(),
            margin.area_mm2(),
            sun_deg,
        );
        let shown = tissue::shown(tissue::MESH_MM[tissue::AREOLE], layout.per_mm);
        let Layout { widest, neck, stalk, wounds, .. } = layout;
        Self {
            layout,
            course,
            stalk_length: paint.petiole.length_mm as f32,
            pigments: Pigments::new(
                paint.colour,
                paint.state,
                &paint.petiole.colour,
                PETIOLE_REACH * *neck as f32,
                wounds.is_some(),
            ),
            relief: Relief::new(paint.relief, *widest, *neck, stalk.widest(), shown),
            optics: Optics::new(paint.relief),
            maps,
        }
    }

    /// From the lowest to the highest place that the height maps can show (mm).
    pub(super) fn height_range_mm(&self) -> f64 {
        2.0 * f64::from(self.relief.bound())
    }

    /// Thickness that the greatest value of the thickness maps stands for (mm).
    pub(super) fn thickness_range_mm(&self) -> f64 {
        f64::from(self.relief.thickest())
    }

    /// Both sides, empty where the leaf is not, heights without their normals, the back mirrored; and
    /// where in the front it is.
    pub(super) fn paint(&self, canvas: &mut Canvas) -> ([SideMaps; 2], Spans) {
        let Layout { size, band, .. } = *self.layout;
        let mut sides = canvas.take(size, self.maps);
        let [front, back] = &mut sides;
        let bands: Vec<_> = bands(front, band * size).zip(bands(back, band * size)).collect();
        let paint = |scratch: &mut Scratch, (i, sides): (usize, _)| {
            let rows = i * band..((i + 1) * band).min(size);
            pulp::Arch::new().dispatch(Band { scene: self, number: i, rows, sides, scratch })
        };
        let spans: Vec<Vec<Range<usize>>> =
            bands.into_par_iter().enumerate().map_init(Scratch::default, paint).collect();
        (sides, Spans::of(spans.concat()))
    }
}
