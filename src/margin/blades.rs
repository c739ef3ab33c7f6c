//! Every blade in a picture: leaves side by side on a scan, with their areas and lengths.
//!
//! Blades are told from a plain background as in [`super::silhouette`]. Left out are specks, what
//! lies along the border of the picture (shadow of a scanner's lid, a ruler), and rectangles (rulers,
//! cards of known area), which are counted apart. Leaves that touch in a neck much narrower than they
//! are wide are parted there.

use std::collections::VecDeque;

use glam::DVec2;

use super::silhouette::{self, Picture};
use super::{MarginError, placement};
use crate::geometry::compact::{self, CompactCurve};
use crate::geometry::polygon;
use crate::raster::components::{Components, neighbours};
use crate::raster::{Grid, contour, distance};

/// A blade in a picture; lengths in pixels of the file.
#[derive(Debug, Clone, PartialEq)]
pub struct Blade {
    /// Its outline, y down.
    pub outline: Vec<DVec2>,
    /// Area within the outline (px²), holes counted as blade.
    pub area: f64,
    /// Area of the holes (px²).
    pub hole_area: f64,
    /// Number of holes of more than [`LEAST_HOLE`] pixels.
    pub holes: usize,
    /// Greatest extent (px), petiole included.
    pub length: f64,
    /// Extent across the greatest (px).
    pub width: f64,
    /// From base to apex (px), without petiole; `None` where no base was found.
    pub base_to_apex: Option<f64>,
    /// It runs over the border of the picture.
    pub is_cut: bool,
}

impl Blade {
    /// The boundary as a compact curve that stays within `tolerance` (px) of it; tips of lobes and teeth
    /// are kept as corners.
    #[must_use]
    pub fn silhouette(&self, tolerance: f64) -> CompactCurve {
        compact::compact(&self.outline, &[], tolerance)
    }
}

/// What was found in a picture.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Blades {
    /// The blades, row by row from the top left, as one reads.
    pub blades: Vec<Blade>,
    /// Areas of the rectangles left out (px²).
    pub rectangles: Vec<f64>,
    /// What the user should know.
    pub notes: Vec<String>,
    /// Mean width of the largest thing over its extent: below [`THIN`] it is a net of lines.
    pub thinness: f64,
}

/// Holes of fewer pixels are noise.
pub const LEAST_HOLE: usize = 4;
/// Things whose mean width is a smaller share of their extent are lines, not blades.
pub const THIN: f64 = 0.02;

/// A blade has at least this share of the area of the largest.
const LEAST_SHARE: f64 = 0.02;
/// The least area of the largest blade (px).
const LEAST_AREA: usize = 40;
/// What lies on the border of the picture is a blade when it has this share of the largest that does
/// not, and is no strip along it.
const CUT_SHARE: f64 = 0.25;
/// What fills its tightest box to this share is a rectangle.
const RECTANGLE: f64 = 0.96;
/// Blades touch in a neck of at most this share of the wider one's width, and each has at least the
/// second share of that width: lobes hang on wider necks.
const NECK: f64 = 0.1;
const PART: f64 = 0.35;

/// Every blade of a picture.
///
/// # Errors
///
/// [`MarginError::Picture`] says what the picture lacks.
pub fn find(picture: &Picture) -> Result<Blades, MarginError> {
    let pixels = &picture.pixels;
    let (width, height) = (pixels.width(), pixels.height());
    let silhouette::Field { field, level, notes } = silhouette::field(pixels)?;
    let mut found = Blades { notes, ..Blades::default() };
    let regions = parted(Components::of(&field.map(|&v| v > level)), &mut found.notes);
    let on_border = {
        let mut counts = vec![0usize; regions.areas.len()];
        for i in silhouette::border(width, height) {
            counts[regions.labels.values()[i] as usize] += 1;
        }
        counts
    };
    let inside = (1..regions.areas.len()).filter(|&n| on_border[n] == 0);
    let largest = inside.map(|n| regions.areas[n]).max();
    let largest = largest.or_else(|| regions.areas[1..].iter().copied().max()).unwrap_or(0);
    if largest < LEAST_AREA {
        return Err(MarginError::Picture("the picture shows no leaf".into()));
    }
    let boxes = boxes(&regions);
    let mut most = 0;
    for n in 1..regions.areas.len() {
        let area = regions.areas[n];
        if (area as f64) < LEAST_SHARE * largest as f64 {
            continue;
        }
        if on_border[n] > 0 && is_strip(area, on_border[n], largest) {
            found.notes.push("a strip along the border left out".to_owned());
            continue;
        }
        let Some((outline, holes)) = outlines(&field, level, &regions, n as u32, boxes[n]) else {
            continue;
        };
        if area > most {
            most = area;
            found.thinness = thinness(&outline, &holes);
        }
        let scale = picture.file_pixels;
        let outline: Vec<DVec2> = outline.iter().map(|&p| p * scale).collect();
        let area = polygon::signed_area(&outline).abs();
        let (length, across, box_area) = extents(&outline);
        if area > RECTANGLE * box_area {
            found.rectangles.push(area);
            continue;
        }
        let upright: Vec<DVec2> = outline.iter().map(|p| DVec2::new(p.x, -p.y)).collect();
        let placed = placement::place(&upright, &[], None, 1.0).ok();
        found.blades.push(Blade {
            area,
            hole_area: holes.iter().map(|hole| polygon::signed_area(hole).abs()).sum::<f64>()
                * scale
                * scale,
            holes: holes.len(),
            length,
            width: across,
            base_to_apex: placed.map(|placed| placed.base_was.distance(placed.apex_was)),
            is_cut: on_border[n] > 0,
            outline,
        });
    }
    if found.blades.is_empty() && found.rectangles.is_empty() {
        return Err(MarginError::Picture("the picture shows no leaf".into()));
    }
    if !found.rectangles.is_empty() {
        let n = found.rectangles.len();
        let plural = if n == 1 { "" } else { "s" };
        found.notes.push(format!("{n} rectangle{plural} left out (rulers or cards)"));
    }
    found.notes.dedup();
    Ok(found)
}

/// Shadows and rulers along the border: little, or mostly border.
fn is_strip(area: usize, on_border: usize, largest: usize) -> bool {
    let small = (area as f64) < CUT_SHARE * largest as f64;
    // A strip is a few pixels deep along all its border.
    let depth = area as f64 / on_border as f64;
    small || depth < 0.2 * on_border as f64
}

/// The box of each region: least and greatest x and y.
fn boxes(regions: &Components) -> Vec<[usize; 4]> {
    let width = regions.labels.width();
    let mut boxes = vec![[usize::MAX, usize::MAX, 0, 0]; regions.areas.len()];
    for (i, &label) in regions.labels.values().iter().enumerate() {
        let (x, y) = (i % width, i / width);
        let b = &mut boxes[label as usize];
        *b = [b[0].min(x), b[1].min(y), b[2].max(x), b[3].max(y)];
    }
    boxes
}

/// The outline of a region and those of its holes, to parts of a pixel.
fn outlines(
    field: &Grid<f32>,
    level: f32,
    regions: &Components,
    label: u32,
    [x0, y0, x1, y1]: [usize; 4],
) -> Option<(Vec<DVec2>, Vec<Vec<DVec2>>)> {
    // The region alone, with a pixel of what is around it.
    let (left, top) = (x0.saturating_sub(1), y0.saturating_sub(1));
    let right = (x1 + 1).min(field.width() - 1);
    let bottom = (y1 + 1).min(field.height() - 1);
    let (width, height) = (right - left + 1, bottom - top + 1);
    let mut part = Grid::filled(width, height, 0.0f32);
    for y in 0..height {
        for x in 0..width {
            let at = (left + x, top + y);
            let value = field[at];
            part[(x, y)] = match regions.labels[at] {
                other if other == label => value,
                0 => value,
                _ => value.min(0.999 * level),
            };
        }
    }
    let offset = DVec2::new(left as f64, top as f64);
    let mut rings = contour::contours(&part, level);
    rings.iter_mut().flatten().for_each(|p| *p += offset);
    let area = |ring: &Vec<DVec2>| polygon::signed_area(ring);
    let outline = rings.iter().max_by(|a, b| area(a).total_cmp(&area(b)))?.clone();
    let holes = rings.into_iter().filter(|ring| area(ring) < -(LEAST_HOLE as f64));
    let inside = holes.filter(|hole| polygon::contains(&outline, hole[0])).collect();
    Some((outline, inside))
}

/// Mean width over extent: twice the area over all that bounds it.
fn thinness(outline: &[DVec2], holes: &[Vec<DVec2>]) -> f64 {
    let area = |ring: &[DVec2]| polygon::signed_area(ring).abs();
    let solid = area(outline) - holes.iter().map(|hole| area(hole)).sum::<f64>();
    let bound =
        polygon::perimeter(outline) + holes.iter().map(|h| polygon::perimeter(h)).sum::<f64>();
    2.0 * solid / bound / extents(outline).0
}

/// The greatest extent, that across it, and the area of the tightest box.
fn extents(outline: &[DVec2]) -> (f64, f64, f64) {
    let hull = polygon::convex_hull(outline);
    let mut length = (0.0, DVec2::X);
    for (i, &a) in hull.iter().enumerate() {
        for &b in &hull[i + 1..] {
            if a.distance(b) > length.0 {
                length = (a.distance(b), (b - a).normalize_or(DVec2::X));
            }
        }
    }
    let extent = |along: DVec2| {
        let reach = hull.iter().map(|p| p.dot(along));
        let (low, high) = reach
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        high - low
    };
    // The tightest box lies along an edge of the hull.
    let box_area = polygon::edges(&hull)
        .map(|(a, b)| {
            let along = (b - a).normalize_or(DVec2::X);
            extent(along) * extent(along.perp())
        })
        .fold(f64::INFINITY, f64::min);
    (length.0, extent(length.1.perp()), box_area)
}

/// The same with regions parted where blades touch.
fn parted(regions: Components, notes: &mut Vec<String>) -> Components {
    let (width, height) = (regions.labels.width(), regions.labels.height());
    if width.max(height) > 1 << 14 {
        return regions;
    }
    // How far each pixel is from the background, and the widest place of each region.
    let sites = distance::nearest_sites(width, height, |i| regions.labels.values()[i] == 0);
    let depth: Vec<f64> = sites
        .values()
        .iter()
        .enumerate()
        .map(|(i, &site)| {
            let to = |i: usize| DVec2::new((i % width) as f64, (i / width) as f64);
            if site == distance::NO_SITE { 0.0 } else { to(i).distance(to(site as usize)) }
        })
        .collect();
    let mut widest = vec![0.0f64; regions.areas.len()];
    for (i, &label) in regions.labels.values().iter().enumerate() {
        let deepest = &mut widest[label as usize];
        *deepest = deepest.max(depth[i]);
    }
    // What is left without the necks; parts wide enough to be blades grow back into what they had.
    let core = |i: usize| {
        let label = regions.labels.values()[i] as usize;
        label != 0 && depth[i] > NECK * widest[label]
    };
    let cores = Components::of(&Grid::from_values(
        width,
        height,
        (0..width * height).map(core).collect::<Vec<bool>>(),
    ));
    let mut core_depth = vec![0.0f64; cores.areas.len()];
    let mut home = vec![0u32; cores.areas.len()];
    for (i, &c) in cores.labels.values().iter().enumerate() {
        core_depth[c as usize] = core_depth[c as usize].max(depth[i]);
        home[c as usize] = regions.labels.values()[i];
    }
    let is_part = |c: usize| core_depth[c] >= PART * widest[home[c] as usize];
    let mut parts = vec![0usize; regions.areas.len()];
    (1..cores.areas.len()).filter(|&c| is_part(c)).for_each(|c| parts[home[c] as usize] += 1);
    let touching: usize = parts.iter().filter(|&&n| n > 1).count();
    if touching == 0 {
        return regions;
    }
    notes.push("leaves that touch were parted at their necks".to_owned());
    // Each part a new label; all other pixels of the region go to the part they reach first.
    let mut labels = regions.labels.clone();
    let mut areas = regions.areas.clone();
    let mut open = VecDeque::new();
    let mut taken = vec![false; width * height];
    let mut name = vec![0u32; cores.areas.len()];
    for c in (1..cores.areas.len()).filter(|&c| is_part(c) && parts[home[c] as usize] > 1) {
        areas.push(0);
        name[c] = areas.len() as u32 - 1;
    }
    for (i, &c) in cores.labels.values().iter().enumerate() {
        if name[c as usize] != 0 {
            labels.values_mut()[i] = name[c as usize];
            taken[i] = true;
            open.push_back(i);
        }
    }
    while let Some(i) = open.pop_front() {
        for next in neighbours(i, width, height) {
            let region = regions.labels.values()[next] as usize;
            if region != 0 && parts[region] > 1 && !taken[next] {
                taken[next] = true;
                labels.values_mut()[next] = labels.values()[i];
                open.push_back(next);
            }
        }
    }
    areas.iter_mut().for_each(|area| *area = 0);
    labels.values().iter().for_each(|&label| areas[label as usize] += 1);
    Components { labels, areas }
}
