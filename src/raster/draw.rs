//! Coloured shapes, pictures and words on a canvas, for pictures that people look at.
//!
//! The only file that names tiny-skia. It works with 8 bits and few steps of coverage: good for
//! sheets and overlays, never for heights, distances or normals (those are floats of our own in
//! `coverage`).
//!
//! Words are set in Hack, a font that travels with the program, so a sheet looks the same on a
//! machine without fonts. Its letters are filled as outlines.

use std::sync::LazyLock;

use glam::DVec2;
use palette::{LinSrgb, Srgb};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, Path, PathBuilder, Pixmap, PremultipliedColorU8,
    Stroke, Transform,
};
use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::Grid;

/// A colour: sRGB and straight alpha.
pub type Rgba = [u8; 4];

static FONT: LazyLock<Face<'static>> = LazyLock::new(|| {
    Face::parse(epaint_default_fonts::HACK_REGULAR, 0).expect("the font in the program is whole")
});

/// A place to draw on. Positions are pixels from the upper left corner, y down.
#[derive(Debug)]
pub struct Canvas {
    pixmap: Pixmap,
}

impl Canvas {
    /// A canvas of one colour.
    ///
    /// # Panics
    ///
    /// If it has no pixels, or more than memory can hold.
    #[must_use]
    pub fn new(width: usize, height: usize, background: Rgba) -> Self {
        let side = |pixels: usize| u32::try_from(pixels).ok();
        let mut pixmap = side(width)
            .zip(side(height))
            .and_then(|(width, height)| Pixmap::new(width, height))
            .expect("a canvas has pixels, and not more than memory holds");
        pixmap.fill(colour(background));
        Self { pixmap }
    }

    /// Fills the inside of closed rings; a ring within a ring is a hole.
    pub fn fill(&mut self, rings: &[&[DVec2]], with: Rgba) {
        let mut builder = PathBuilder::new();
        for ring in rings {
            trace(&mut builder, ring);
            builder.close();
        }
        self.fill_path(builder.finish(), with, FillRule::EvenOdd);
    }

    /// Draws a line through points, with round ends and corners.
    pub fn stroke(&mut self, points: &[DVec2], width: f64, with: Rgba) {
        let mut builder = PathBuilder::new();
        trace(&mut builder, points);
        let stroke = Stroke {
            width: width as f32,
            line_cap: LineCap::Round,
            line_join: LineJoin::Round,
            ..Stroke::default()
        };
        if let Some(path) = builder.finish() {
            let paint = paint(with);
            self.pixmap.stroke_path(&path, &paint, &stroke, Transform::identity(), None);
        }
    }

    /// Lays a picture over the rectangle at `(left, top)`, scaled to `width` × `height`. Each pixel
    /// is the mean of what it covers, taken in linear light, over what was there. What lies outside
    /// the canvas is left away.
    pub fn paste(
        &mut self,
        picture: &Grid<Rgba>,
        (left, top): (usize, usize),
        (width, height): (usize, usize),
    ) {
        let stride = self.pixmap.width() as usize;
        let rows = height.min((self.pixmap.height() as usize).saturating_sub(top));
        let columns = width.min(stride.saturating_sub(left));
        let across: Vec<_> = (0..columns).map(|x| Span::of(x, width, picture.width())).collect();
        let pixels = self.pixmap.pixels_mut();
        for y in 0..rows {
            let down = Span::of(y, height, picture.height());
            for (x, across) in across.iter().enumerate() {
                let under = &mut pixels[(top + y) * stride + left + x];
                *under = over(mean(picture, across, &down), *under);
            }
        }
    }

    /// Writes a line of words from `start`, the left end of the line they stand on, in letters with
    /// `size` pixels from line to line. What the font lacks becomes `?`.
    pub fn text(&mut self, text: &str, start: DVec2, size: f64, with: Rgba) {
        let scale = (size / line_height()) as f32;
        let mut pen = start.as_vec2();
        let mut outline = Letters { builder: PathBuilder::new(), pen, scale };
        for c in text.chars() {
            let glyph = glyph(c);
            outline.pen = pen;
            // A space has no outline.
            let _ = FONT.outline_glyph(glyph, &mut outline);
            pen.x += advance(glyph) as f32 * scale;
        }
        self.fill_path(outline.builder.finish(), with, FillRule::Winding);
    }

    /// The picture drawn.
    #[must_use]
    pub fn into_picture(self) -> Grid<Rgba> {
        let (width, height) = (self.pixmap.width() as usize, self.pixmap.height() as usize);
        let values = self.pixmap.take_demultiplied().as_chunks::<4>().0.to_vec();
        Grid::from_values(width, height, values)
    }

    fn fill_path(&mut self, path: Option<Path>, with: Rgba, rule: FillRule) {
        // There is no path where nothing, or nothing finite, was traced.
        if let Some(path) = path {
            self.pixmap.fill_path(&path, &paint(with), rule, Transform::identity(), None);
        }
    }
}

/// Width of a line of words in letters of `size` (pixels).
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    text.chars().map(|c| advance(glyph(c))).sum::<f64>() * size / line_height()
}

/// From line to line, in the font's own unit.
fn line_height() -> f64 {
    f64::from(FONT.ascender()) - f64::from(FONT.descender())
}

fn advance(glyph: GlyphId) -> f64 {
    f64::from(FONT.glyph_hor_advance(glyph).unwrap_or(0))
}

fn glyph(c: char) -> GlyphId {
    FONT.glyph_index(c).or_else(|| FONT.glyph_index('?')).unwrap_or(GlyphId(0))
}

fn colour([r, g, b, a]: Rgba) -> Color {
    Color::from_rgba8(r, g, b, a)
}

fn paint(with: Rgba) -> Paint<'static> {
    let mut paint = Paint::default();
    paint.set_color(colour(with));
    paint
}

fn trace(builder: &mut PathBuilder, points: &[DVec2]) {
    for (i, p) in points.iter().enumerate() {
        let (x, y) = (p.x as f32, p.y as f32);
        if i == 0 { builder.move_to(x, y) } else { builder.line_to(x, y) }
    }
}

/// Takes the outlines of letters; the font's y runs up.
struct Letters {
    builder: PathBuilder,
    pen: glam::Vec2,
    scale: f32,
}

impl Letters {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (self.pen.x + self.scale * x, self.pen.y - self.scale * y)
    }
}

impl OutlineBuilder for Letters {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.builder.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.builder.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.builder.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.builder.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.builder.close();
    }
}

/// The source pixels under one target pixel along one axis: the first one and the share of the target
/// that each covers.
struct Span {
    first: usize,
    shares: Vec<f32>,
}

impl Span {
    fn of(target: usize, targets: usize, sources: usize) -> Self {
        let scale = sources as f64 / targets as f64;
        let (from, to) = (target as f64 * scale, (target + 1) as f64 * scale);
        let first = from as usize;
        let shares = (first..sources)
            .take_while(|&source| (source as f64) < to - 1e-9)
            .map(|source| {
                let (a, b) = (from.max(source as f64), to.min((source + 1) as f64));
                ((b - a) / scale) as f32
            })
            .collect();
        Self { first, shares }
    }
}

/// Mean colour of a rectangle of a picture: linear light, times coverage; and the coverage.
fn mean(picture: &Grid<Rgba>, across: &Span, down: &Span) -> (LinSrgb<f32>, f32) {
    let mut sum = LinSrgb::new(0.0, 0.0, 0.0);
    let mut coverage = 0.0;
    for (y, share_y) in down.shares.iter().enumerate() {
        let row = &picture.row(down.first + y)[across.first..];
        for (&[r, g, b, a], share_x) in row.iter().zip(&across.shares) {
            let weight = share_x * share_y * f32::from(a) / 255.0;
            if weight > 0.0 {
                sum += Srgb::new(r, g, b).into_linear::<f32>() * weight;
                coverage += weight;
            }
        }
    }
    (sum, coverage)
}

/// A colour (linear, premultiplied) with its coverage over a pixel.
fn over(
    (above, coverage): (LinSrgb<f32>, f32),
    under: PremultipliedColorU8,
) -> PremultipliedColorU8 {
    if coverage <= 0.0 {
        return under;
    }
    let under = under.demultiply();
    let rest = (1.0 - coverage).max(0.0) * f32::from(under.alpha()) / 255.0;
    let below = Srgb::new(under.red(), under.green(), under.blue()).into_linear::<f32>();
    let alpha = (coverage + rest).min(1.0);
    let mixed = (above + below * rest) / alpha;
    let encoded: Srgb<u8> = Srgb::from_linear(mixed);
    let alpha = (alpha * 255.0).round() as u8;
    tiny_skia::ColorU8::from_rgba(encoded.red, encoded.green, encoded.blue, alpha).premultiply()
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHITE: Rgba = [255; 4];
    const BLACK: Rgba = [0, 0, 0, 255];

    fn square(from: f64, to: f64) -> [DVec2; 4] {
        [(from, from), (to, from), (to, to), (from, to)].map(DVec2::from)
    }

    #[test]
    fn a_ring_within_a_ring_is_a_hole() {
        let mut canvas = Canvas::new(10, 10, WHITE);
        canvas.fill(&[&square(1.0, 9.0), &square(4.0, 6.0)], BLACK);
        let picture = canvas.into_picture();
        assert_eq!([picture[(0, 0)], picture[(2, 2)], picture[(5, 5)]], [WHITE, BLACK, WHITE]);
    }

    #[test]
    fn a_picture_pasted_at_its_own_size_is_itself() {
        let values = (0..48u8).map(|i| [i * 5, 255 - i * 3, i, 255]).collect();
        let picture = Grid::from_values(8, 6, values);
        let mut canvas = Canvas::new(8, 6, WHITE);
        canvas.paste(&picture, (0, 0), (8, 6));
        assert_eq!(canvas.into_picture(), picture);
    }

    #[test]
    fn shrinking_averages_light_and_lets_the_background_through() {
        // Half black, half white is 50 % of the light, which sRGB writes as 188.
        let picture = Grid::from_values(2, 2, vec![BLACK, WHITE, WHITE, BLACK]);
        let mut canvas = Canvas::new(1, 1, BLACK);
        canvas.paste(&picture, (0, 0), (1, 1));
        assert_eq!(canvas.into_picture()[(0, 0)], [188, 188, 188, 255]);
        // Colour under alpha 0 does not show.
        let picture = Grid::from_values(2, 1, vec![[255, 0, 0, 0], BLACK]);
        let mut canvas = Canvas::new(1, 1, WHITE);
        canvas.paste(&picture, (0, 0), (1, 1));
        assert_eq!(canvas.into_picture()[(0, 0)], [188, 188, 188, 255]);
    }

    #[test]
    fn what_is_pasted_over_the_edge_is_left_away() {
        let picture = Grid::filled(4, 4, BLACK);
        let mut canvas = Canvas::new(5, 5, WHITE);
        canvas.paste(&picture, (3, 3), (7, 7));
        canvas.paste(&picture, (30, 30), (7, 7));
        let picture = canvas.into_picture();
        assert_eq!([picture[(2, 2)], picture[(4, 4)]], [WHITE, BLACK]);
    }

    #[test]
    fn words_are_as_wide_as_they_say() {
        let text = "Quercus – 12 µm² Ωλ";
        let width = text_width(text, 20.0);
        let mut canvas = Canvas::new(400, 40, WHITE);
        canvas.text(text, DVec2::new(0.0, 25.0), 20.0, BLACK);
        let picture = canvas.into_picture();
        let inked = |x: &usize| (0..40).any(|y| picture[(*x, y)] != WHITE);
        let last = (0..400).filter(inked).max().unwrap() as f64;
        assert!(last < width && last > width - 12.0, "{last} of {width}");
    }

    #[test]
    fn what_the_font_lacks_is_a_question_mark() {
        let write = |text: &str| {
            let mut canvas = Canvas::new(60, 30, WHITE);
            canvas.text(text, DVec2::new(2.0, 22.0), 20.0, BLACK);
            canvas.into_picture()
        };
        assert_eq!(write("a櫟\n"), write("a??"));
        assert_ne!(write("a?"), write("a"));
    }
}
