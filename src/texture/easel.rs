//! Painting one leaf, once or again and again.

use super::canvas::Canvas;
use super::dilation::Empty;
use super::layout::Layout;
use super::map::MapKind;
use super::scene::Scene;
use super::side::SideMaps;
use super::spans::Spans;
use super::{Paint, Style, TextureError, TextureSet};
use super::{check, crumbs, finish, normals, occlusion};
use crate::margin::Margin;
use crate::observer::{Observer, Progress};
use crate::seed::Seed;
use crate::veins::Venation;

/// A grown leaf that is painted under one setting after another.
///
/// Where everything lies is worked out once for settings that differ in colours (but not in how they spread), season,
/// maturity, health, relief and maps only; and pictures that are [given back](Self::take_back) are painted over.
/// Neither changes a byte.
#[derive(Debug)]
pub struct Easel<'a> {
    margin: &'a Margin,
    venation: &'a Venation,
    seed: Seed,
    layout: Option<Layout>,
    outside: Option<Outside>,
    canvas: Canvas,
}

/// Where a leaf is not, once it is known which texels its layout covers.
#[derive(Debug)]
struct Outside {
    crumbs: Vec<usize>,
    empty: Empty,
}

impl<'a> Easel<'a> {
    /// For the leaf of a seed.
    #[must_use]
    pub fn new(margin: &'a Margin, venation: &'a Venation, seed: Seed) -> Self {
        Self { margin, venation, seed, layout: None, outside: None, canvas: Canvas::default() }
    }

    /// Lays down pictures that nobody looks at any more, of this leaf or of another: the next ones are painted over
    /// them.
    pub fn take_back(&mut self, canvas: impl Into<Canvas>) {
        self.canvas = canvas.into();
    }

    /// Paints both sides of the leaf. The same bytes on any number of threads.
    ///
    /// # Errors
    ///
    /// [`TextureError`] when a map would not fit.
    pub fn paint(
        &mut self,
        paint: &Paint<'_>,
        observer: &mut dyn Observer,
    ) -> Result<TextureSet, TextureError> {
        check(paint)?;
        let mut report = |step| {
            observer.report(Progress { stage: "painting", step, steps: 3, nodes: 0, sources: 0 });
        };
        report(0);
        let laid = self.layout.take().filter(|layout| layout.serves(paint));
        let outside = self.outside.take().filter(|_| laid.is_some());
        let layout: &Layout = self.layout.insert(
            laid.unwrap_or_else(|| Layout::new(paint, self.margin, self.venation, self.seed)),
        );
        let mut maps = paint.maps;
        if paint.texture.style == Style::Enhanced {
            maps = maps.with(MapKind::VeinMask);
        }
        let scene = Scene::new(layout, paint, maps, self.margin, self.seed);
        report(1);
        let ([mut front, mut back], spans) = scene.paint(&mut self.canvas);
        let outside = match outside {
            Some(outside) => {
                crumbs::clear(&mut front, &mut back, &outside.crumbs);
                outside
            }
            None => Outside::of(layout, [&mut front, &mut back], &spans),
        };
        report(2);
        self.outside.insert(outside).empty.spread(&mut front, &mut back);
        let per_mm = layout.frame.pixels_per_mm(layout.size) as f32;
        let per_texel = scene.height_range_mm() as f32 / 65535.0 * per_mm;
        for (side, spans) in [(&mut front, &spans), (&mut back, &spans.mirrored())] {
            if maps.has(MapKind::Normal) {
                normals::fill(side, spans, per_texel);
            }
            if side.has(MapKind::AmbientOcclusion) {
                occlusion::fill(side, spans, per_texel, per_mm);
            }
        }
        let mut set = TextureSet {
            frame: layout.frame,
            front,
            back,
            height_range_mm: scene.height_range_mm(),
            thickness_range_mm: scene.thickness_range_mm(),
            petiole_end: layout.stalk.end(),
            petiole: layout.stalk.outline(),
            albedo: paint.colour.albedo,
            rings: layout.wounds.as_ref().map_or_else(Vec::new, |wounds| wounds.rings().to_vec()),
        };
        finish(paint, maps, &mut set, layout.seed);
        report(3);
        Ok(set)
    }
}

impl Outside {
    /// Clears the crumbs of a leaf that has just been painted, and finds what is empty then.
    fn of(layout: &Layout, [front, back]: [&mut SideMaps; 2], spans: &Spans) -> Self {
        let crumbs = layout.wounds.as_ref().map_or_else(Vec::new, |wounds| {
            let bare = |x: usize, y: usize| wounds.is_bare(x, y);
            crumbs::find(&front.base_colour, &layout.whole(), bare)
        });
        crumbs::clear(front, back, &crumbs);
        Self { crumbs, empty: Empty::of(front, spans) }
    }
}
