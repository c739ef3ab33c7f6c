//! The outline of a leaf in a photograph or scan on a plain background.
//!
//! The background is what the border of the picture shows, a plane of colour fitted to it, so that
//! uneven light does no harm. How far each pixel is from it is split in two by an automatic
//! threshold; the largest region is the leaf, its holes are filled and specks dropped; its contour
//! is taken between the pixels. Green leaves on blue, white ones on black and leaves that are in the
//! alpha channel alone all come out the same way.
//!
//! Coordinates are pixels of the picture, y down.

use glam::{DVec2, Vec4};

use super::MarginError;
use crate::raster::components::Components;
use crate::raster::{Grid, contour, smooth, threshold};

/// A decoded picture.
#[derive(Debug, Clone)]
pub struct Picture {
    /// 8-bit sRGB with straight alpha.
    pub pixels: Grid<[u8; 4]>,
    /// How many pixels of the file one of these is wide: above 1 when it was reduced.
    pub file_pixels: f64,
}

impl Picture {
    /// A place in the picture, in pixels of the file, for messages.
    pub(super) fn in_file(&self, p: DVec2) -> DVec2 {
        p * self.file_pixels
    }
}

/// A leaf found in a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// The outline, simple, the first point not repeated.
    pub outline: Vec<DVec2>,
    /// Open lines drawn inside.
    pub cuts: Vec<Vec<DVec2>>,
    /// What the user should know.
    pub notes: Vec<String>,
}

/// Smaller pictures hold no leaf worth growing (px).
pub(crate) const MIN_SIDE: usize = 8;
/// A leaf that covers more of the border than this is not a leaf on a background.
const MOST_OF_BORDER: f64 = 0.10;
/// The mean difference between leaf and background, of 255, below which it is noise.
const LEAST_CONTRAST: f64 = 12.0;
/// The least share of the variance that leaf against background must explain. White noise split at
/// its mean explains 0.64.
const LEAST_SEPARATION: f64 = 0.66;
/// The least area of a leaf (px).
const LEAST_AREA: usize = 40;

/// The outline of the leaf on a plain background; of the one at `root` when there are several.
///
/// # Errors
///
/// [`MarginError::Picture`] says what the picture lacks.
pub fn trace(picture: &Picture, root: Option<DVec2>) -> Result<Traced, MarginError> {
    let pixels = &picture.pixels;
    let (width, height) = (pixels.width(), pixels.height());
    let Field { mut field, level, mut notes } = field(pixels)?;

    // The leaf: the largest region, or the one at the root.
    let regions = Components::of(&field.map(|&v| v > level));
    let (largest, largest_area) = regions
        .largest()
        .filter(|&(_, area)| area >= LEAST_AREA)
        .ok_or_else(|| MarginError::Picture("the picture shows no leaf".into()))?;
    let second = (1..regions.areas.len()).filter(|&n| n != largest as usize);
    let rivals = second.filter(|&n| regions.areas[n] * 10 > largest_area).count();
    let leaf = root.and_then(|p| region_at(&regions, p, largest_area / 100)).unwrap_or(largest);
    if leaf != largest {
        notes.push(format!("{} leaves: took the one at the root", rivals + 1));
    } else if rivals > 0 {
        notes.push(format!("{} leaves: took the largest", rivals + 1));
    }
    let on_border = border(width, height).filter(|&i| regions.labels.values()[i] == leaf).count();
    let share = on_border as f64 / border(width, height).count() as f64;
    if share > MOST_OF_BORDER {
        return Err(MarginError::Picture(format!(
            "the leaf covers {:.0} % of the picture's border; leave plain background around it",
            share * 100.0
        )));
    }
    if on_border > 0 {
        notes.push("the leaf is cut off at the border of the picture".to_owned());
    }

    // Nothing else above the threshold, and no holes in the leaf.
    let outside = Components::of(&regions.labels.map(|&label| label != leaf));
    let mut open = vec![false; outside.areas.len()];
    for i in border(width, height) {
        open[outside.labels.values()[i] as usize] = true;
    }
    open[0] = true;
    let holes = (0..open.len()).filter(|&n| !open[n] && outside.areas[n] > 4).count();
    if holes > 0 {
        notes.push(format!("{holes} hole{} filled", if holes == 1 { "" } else { "s" }));
    }
    for (i, value) in field.values_mut().iter_mut().enumerate() {
        if !open[outside.labels.values()[i] as usize] {
            *value = value.max(2.0 * level);
        } else if regions.labels.values()[i] != leaf {
            *value = value.min(0.999 * level);
        }
    }
    let outline = contour::largest_outline(&field, level)
        .ok_or_else(|| MarginError::Picture("the picture shows no leaf".into()))?;
    Ok(Traced { outline, cuts: Vec::new(), notes })
}

/// How far every pixel is from the background, where leaves begin, and what was done.
pub(super) struct Field {
    pub(super) field: Grid<f32>,
    pub(super) level: f32,
    pub(super) notes: Vec<String>,
}

/// The picture as distances from its background, smoothed, and the level that parts leaf from it.
pub(super) fn field(pixels: &Grid<[u8; 4]>) -> Result<Field, MarginError> {
    let (width, height) = (pixels.width(), pixels.height());
    if width < MIN_SIDE || height < MIN_SIDE {
        let problem = format!(
            "the picture is {width} x {height} px; a leaf needs at least {MIN_SIDE} x {MIN_SIDE}"
        );
        return Err(MarginError::Picture(problem));
    }
    let mut notes = Vec::new();
    let raw = difference(pixels);
    let level = split(&raw)?;
    let raw = if is_noisy(&raw, level) {
        notes.push("speckled picture: specks smoothed away".to_owned());
        smooth::median(&smooth::median(&raw))
    } else {
        raw
    };
    // A picture this small has no detail to spare.
    let sigma = if width.max(height) < 150 { 0.5 } else { 0.8 };
    Ok(Field { field: smooth::gaussian(&raw, sigma), level, notes })
}

/// The pixels along the border, once each.
pub(super) fn border(width: usize, height: usize) -> impl Iterator<Item = usize> {
    let rows = (0..width).flat_map(move |x| [x, (height - 1) * width + x]);
    let columns = (1..height - 1).flat_map(move |y| [y * width, y * width + width - 1]);
    rows.chain(columns)
}

/// The region at `p` or within a fiftieth of the picture of it, when it has more than `least`
/// pixels.
fn region_at(regions: &Components, p: DVec2, least: usize) -> Option<u32> {
    let labels = &regions.labels;
    let reach = (labels.width().max(labels.height()) / 50) as isize;
    let (x, y) = (p.x as isize, p.y as isize);
    let mut near: Vec<(isize, u32)> = Vec::new();
    for dy in -reach..=reach {
        for dx in -reach..=reach {
            let label = labels.get(x.saturating_add(dx), y.saturating_add(dy));
            if let Some(&label) = label.filter(|&&l| l != 0 && regions.areas[l as usize] > least) {
                near.push((dx * dx + dy * dy, label));
            }
        }
    }
    near.into_iter().min().map(|(_, label)| label)
}

/// Colour premultiplied by alpha, and alpha: what is transparent has no colour.
fn premultiplied(&[r, g, b, a]: &[u8; 4]) -> Vec4 {
    let alpha = f32::from(a) / 255.0;
    Vec4::new(f32::from(r) * alpha, f32::from(g) * alpha, f32::from(b) * alpha, f32::from(a))
}

/// How far each pixel is from the background, 0 to about 255.
fn difference(pixels: &Grid<[u8; 4]>) -> Grid<f32> {
    let (width, height) = (pixels.width(), pixels.height());
    let plane = background(pixels);
    let mut field = Grid::filled(width, height, 0.0f32);
    for y in 0..height {
        for x in 0..width {
            let off = premultiplied(&pixels[(x, y)]) - plane.at(x, y, width, height);
            let grey = (off.x + off.y + off.z) / 3.0;
            let hue2 = (off.x - grey).powi(2) + (off.y - grey).powi(2) + (off.z - grey).powi(2);
            // A shadow is darker but of the same hue: hue counts for more.
            let colour = (grey * grey + hue2).sqrt();
            field[(x, y)] = colour.max(off.w.abs());
        }
    }
    field
}

/// A colour that changes evenly over the picture.
struct Plane {
    middle: Vec4,
    across: Vec4,
    down: Vec4,
}

impl Plane {
    fn at(&self, x: usize, y: usize, width: usize, height: usize) -> Vec4 {
        let u = (x as f32 + 0.5) / width as f32 - 0.5;
        let v = (y as f32 + 0.5) / height as f32 - 0.5;
        self.middle + self.across * u + self.down * v
    }
}

/// The colour of the background: the median of the border, then a plane fitted by least squares to
/// those border pixels that are near it, thrice.
fn background(pixels: &Grid<[u8; 4]>) -> Plane {
    const NEAR: f32 = 28.0;
    let (width, height) = (pixels.width(), pixels.height());
    let samples: Vec<(usize, usize, Vec4)> = border(width, height)
        .map(|i| (i % width, i / width, premultiplied(&pixels.values()[i])))
        .collect();
    let median = |channel: usize| {
        let mut values: Vec<f32> = samples.iter().map(|(_, _, c)| c[channel]).collect();
        values.sort_unstable_by(f32::total_cmp);
        values[values.len() / 2]
    };
    let middle = Vec4::new(median(0), median(1), median(2), median(3));
    let mut plane = Plane { middle, across: Vec4::ZERO, down: Vec4::ZERO };
    for _ in 0..6 {
        let near: Vec<(f32, f32, Vec4)> = samples
            .iter()
            .filter(|&&(x, y, c)| (c - plane.at(x, y, width, height)).abs().max_element() < NEAR)
            .map(|&(x, y, c)| {
                let u = (x as f32 + 0.5) / width as f32 - 0.5;
                (u, (y as f32 + 0.5) / height as f32 - 0.5, c)
            })
            .collect();
        // On too little of the border a slope would be a guess.
        if near.len() * 8 < samples.len() {
            break;
        }
        let count = near.len() as f32;
        let mean = near.iter().fold((0.0, 0.0, Vec4::ZERO), |m, &(u, v, c)| {
            (m.0 + u / count, m.1 + v / count, m.2 + c / count)
        });
        let (mut uu, mut uv, mut vv) = (0.0, 0.0, 0.0);
        let (mut uc, mut vc) = (Vec4::ZERO, Vec4::ZERO);
        for &(u, v, c) in &near {
            let (u, v, c) = (u - mean.0, v - mean.1, c - mean.2);
            uu += u * u;
            uv += u * v;
            vv += v * v;
            uc += c * u;
            vc += c * v;
        }
        let determinant = uu * vv - uv * uv;
        if determinant < 1e-3 * uu * vv {
            break;
        }
        plane.across = (uc * vv - vc * uv) / determinant;
        plane.down = (vc * uu - uc * uv) / determinant;
        plane.middle = mean.2 - plane.across * mean.0 - plane.down * mean.1;
    }
    plane
}

/// The level between background and leaf.
fn split(field: &Grid<f32>) -> Result<f32, MarginError> {
    const BINS: usize = 256;
    let most = field.values().iter().copied().fold(0.0, f32::max);
    let one_colour = || {
        MarginError::Picture(
            "the picture is one colour: no leaf stands out from the background".into(),
        )
    };
    if most < 1.0 {
        return Err(one_colour());
    }
    let per_bin = most / (BINS - 1) as f32;
    let mut histogram = [0u64; BINS];
    for value in field.values() {
        histogram[(value / per_bin + 0.5) as usize] += 1;
    }
    let split = threshold::otsu(&histogram).ok_or_else(one_colour)?;
    let contrast = (split.high - split.low) * f64::from(per_bin);
    if contrast < LEAST_CONTRAST || split.separation < LEAST_SEPARATION {
        return Err(MarginError::Picture(format!(
            "no leaf stands out from the background (contrast {contrast:.0} of 255, at least \
             {LEAST_CONTRAST}; separation {:.2}, at least {LEAST_SEPARATION})",
            split.separation
        )));
    }
    Ok(split.at as f32 * per_bin)
}

/// Whether more than one pixel in 500 differs in kind from all its four neighbours.
fn is_noisy(field: &Grid<f32>, level: f32) -> bool {
    let (width, height) = (field.width(), field.height());
    let above = |x: usize, y: usize| field[(x, y)] > level;
    let mut lone = 0;
    for y in 1..height - 1 {
        for x in 1..width - 1 {
            let around = [above(x - 1, y), above(x + 1, y), above(x, y - 1), above(x, y + 1)];
            lone += usize::from(around.iter().all(|&other| other != above(x, y)));
        }
    }
    lone * 500 > width * height
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;

    /// An ellipse of `leaf` on `ground`, 120 × 160 px, with half tones at the edge.
    fn ellipse(leaf: [f64; 4], ground: [f64; 4]) -> Picture {
        let mut pixels = Grid::filled(120, 160, [0u8; 4]);
        for y in 0..160 {
            for x in 0..120 {
                let p = DVec2::new(x as f64 + 0.5 - 60.0, y as f64 + 0.5 - 80.0);
                let r = (p / DVec2::new(30.0, 60.0)).length();
                let share = ((1.0 - r) * 40.0 + 0.5).clamp(0.0, 1.0);
                pixels[(x, y)] =
                    [0, 1, 2, 3].map(|k| (leaf[k] * share + ground[k] * (1.0 - share)) as u8);
            }
        }
        Picture { pixels, file_pixels: 1.0 }
    }

    const ELLIPSE: f64 = std::f64::consts::PI * 30.0 * 60.0;

    #[test]
    fn any_plain_background_will_do() {
        let opaque = |r: f64, g: f64, b: f64| [r, g, b, 255.0];
        for (leaf, ground) in [
            (opaque(0.0, 0.0, 0.0), opaque(255.0, 255.0, 255.0)),
            (opaque(255.0, 255.0, 255.0), opaque(0.0, 0.0, 0.0)),
            (opaque(60.0, 110.0, 40.0), opaque(90.0, 170.0, 230.0)),
            ([0.0, 0.0, 0.0, 255.0], [0.0, 0.0, 0.0, 0.0]),
        ] {
            let traced = trace(&ellipse(leaf, ground), None).expect("a leaf");
            let area = polygon::signed_area(&traced.outline);
            assert!((area / ELLIPSE - 1.0).abs() < 0.01, "{leaf:?} on {ground:?}: {area}");
            assert_eq!(traced.notes, Vec::<String>::new());
        }
    }

    #[test]
    fn holes_are_filled_and_specks_dropped() {
        let mut picture = ellipse([30.0, 90.0, 20.0, 255.0], [250.0, 250.0, 245.0, 255.0]);
        let clean = trace(&picture, None).expect("a leaf").outline;
        for y in 0..6 {
            for x in 0..6 {
                picture.pixels[(57 + x, 70 + y)] = [250, 250, 245, 255];
                picture.pixels[(5 + x, 8 + y)] = [30, 90, 20, 255];
            }
        }
        let traced = trace(&picture, None).expect("a leaf");
        assert_eq!(traced.notes, ["1 hole filled"]);
        assert_eq!(traced.outline, clean);
    }

    #[test]
    fn a_leaf_in_uneven_light_is_found() {
        let mut picture = ellipse([90.0, 90.0, 90.0, 255.0], [180.0, 180.0, 180.0, 255.0]);
        for y in 0..160 {
            for x in 0..120 {
                for value in &mut picture.pixels[(x, y)][..3] {
                    *value = (f64::from(*value) - 60.0 + x as f64) as u8;
                }
            }
        }
        let area = polygon::signed_area(&trace(&picture, None).expect("a leaf").outline);
        assert!((area / ELLIPSE - 1.0).abs() < 0.02, "{area}");
    }

    #[test]
    fn empty_pictures_are_refused() {
        let blank = Picture { pixels: Grid::filled(60, 60, [9, 9, 9, 255]), file_pixels: 1.0 };
        let error = trace(&blank, None).expect_err("nothing there").to_string();
        assert!(error.contains("one colour"), "{error}");
        let dot = Picture { pixels: Grid::filled(1, 1, [9, 9, 9, 255]), file_pixels: 1.0 };
        assert!(trace(&dot, None).expect_err("too small").to_string().contains("1 x 1 px"));
    }
}
