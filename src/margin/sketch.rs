//! The outline of a leaf drawn with a pen, by Foster's rule.
//!
//! The top-left pixel is the background, colours near it count as equal, all else is ink. The blade
//! is what a flood fill from the root covers, or the largest region that the ink encloses; the line
//! where it meets the ink is the margin. Lines drawn inside the blade are slits: a slit that starts
//! at the margin is taken out of the outline and kept as a line like the others.
//!
//! Departs from Foster's flood fill: the margin is a polygon to sub-pixel accuracy, not the filled
//! pixels.
//!
//! Coordinates are pixels of the picture, y down.

use glam::DVec2;

use super::MarginError;
use super::silhouette::{MIN_SIDE, Picture, Traced};
use crate::geometry::segments::SegmentIndex;
use crate::raster::chamfer::{self, PIXEL};
use crate::raster::components::Components;
use crate::raster::{Grid, contour, flood_fill, smooth, thinning};

/// Channels this near to the background's are background (of 255).
const SAME_COLOUR: f32 = 32.0;
/// A smaller enclosed region is a slip of the pen (px).
const LEAST_AREA: usize = 40;
/// In a sketch the paper inside is at least this share of what the ink surrounds. Holes and glints
/// in a photographed leaf are less.
const PAPER_INSIDE: f64 = 0.4;

/// Whether the background that touches the border encloses another region of background, large
/// enough for the ink around it to be an outline and not a leaf with holes.
#[must_use]
pub fn looks_like_sketch(picture: &Picture) -> bool {
    let open = background(&picture.pixels);
    let outside = flood_fill::from_border(&open);
    let shapes = Components::of(&outside.map(|&out| !out));
    let Some((shape, area)) = shapes.largest() else { return false };
    let of_shape = shapes.labels.values().iter().zip(open.values());
    let paper = of_shape.filter(|&(&label, &open)| label == shape && open).count();
    paper >= LEAST_AREA && paper as f64 > PAPER_INSIDE * area as f64
}

/// The outline of the blade around `root`, or of the largest region that the drawing encloses, and
/// the lines drawn inside it.
///
/// # Errors
///
/// [`MarginError::Root`] when the root is not inside a closed outline, with the place where the
/// outline is open; [`MarginError::Picture`] when nothing is enclosed.
pub fn trace(picture: &Picture, root: Option<DVec2>) -> Result<Traced, MarginError> {
    let pixels = &picture.pixels;
    let (width, height) = (pixels.width(), pixels.height());
    if width < MIN_SIDE || height < MIN_SIDE {
        return Err(MarginError::Picture(format!(
            "the picture is {width} x {height} px; a sketch needs at least {MIN_SIDE} x {MIN_SIDE}"
        )));
    }
    let mut notes = Vec::new();
    let open = background(pixels);
    let paper = match root {
        Some(root) => fill_from(root, &open, picture)?,
        None => largest_enclosed(&open, &mut notes)?,
    };
    let blade = with_slits_closed(&paper, &open);
    let field = smooth::gaussian(&blade.map(|&inside| f32::from(u8::from(inside))), 0.6);
    let outline = contour::largest_outline(&field, 0.5)
        .ok_or_else(|| MarginError::Picture("the drawing encloses no blade".into()))?;
    let cuts = slits(&blade, &open, &outline);
    if !cuts.is_empty() {
        let lines = if cuts.len() == 1 { "line" } else { "lines" };
        notes.push(format!("{} {lines} inside the blade kept as slits", cuts.len()));
    }
    Ok(Traced { outline, cuts, notes })
}

/// Which pixels are background.
fn background(pixels: &Grid<[u8; 4]>) -> Grid<bool> {
    let seen = |&[r, g, b, a]: &[u8; 4]| {
        let alpha = f32::from(a) / 255.0;
        [f32::from(r) * alpha, f32::from(g) * alpha, f32::from(b) * alpha, f32::from(a)]
    };
    let Some(paper) = pixels.values().first().map(seen) else { return pixels.map(|_| true) };
    pixels.map(|p| seen(p).iter().zip(paper).all(|(a, b)| (a - b).abs() <= SAME_COLOUR))
}

/// The paper that a flood fill from the root covers.
fn fill_from(root: DVec2, open: &Grid<bool>, picture: &Picture) -> Result<Grid<bool>, MarginError> {
    let (width, height) = (open.width(), open.height());
    let error = |problem: String| {
        let at = picture.in_file(root);
        MarginError::Root { x: at.x, y: at.y, problem }
    };
    let within = root.is_finite()
        && root.cmpge(DVec2::ZERO).all()
        && root.x < width as f64
        && root.y < height as f64;
    if !within {
        let size = picture.in_file(DVec2::new(width as f64, height as f64));
        return Err(error(format!("lies outside the picture of {} x {} px", size.x, size.y)));
    }
    let outside = flood_fill::from_border(open);
    let mut start = (root.x as usize, root.y as usize);
    if !open[start] {
        // The petiole is attached to the line itself: start on the paper beside it.
        let near = (width.max(height) / 50).max(3) as isize;
        let (x, y) = (start.0 as isize, start.1 as isize);
        start = (-near..=near)
            .flat_map(|dy| (-near..=near).map(move |dx| (dx, dy)))
            .filter(|&(dx, dy)| {
                let is = |mask: &Grid<bool>| mask.get(x + dx, y + dy) == Some(&true);
                is(open) && !is(&outside)
            })
            .min_by_key(|&(dx, dy)| (dx * dx + dy * dy, dy, dx))
            .map(|(dx, dy)| ((x + dx) as usize, (y + dy) as usize))
            .ok_or_else(|| {
                error("lies on ink; move it onto the paper inside the outline".into())
            })?;
    }
    if outside[start] {
        let gap = flood_fill::leak(open, start);
        let place = gap.map_or_else(String::new, |gap| {
            let at = picture.in_file(DVec2::new(gap.x as f64 + 0.5, gap.y as f64 + 0.5));
            let wide = (gap.width * picture.file_pixels).max(1.0);
            format!(", narrowest near ({:.0}, {:.0}), about {wide:.0} px wide", at.x, at.y)
        });
        return Err(error(format!(
            "is not inside a closed outline: the fill leaks to the border of the picture{place}; \
             close the gap or move the root inside"
        )));
    }
    let paper = flood_fill::from(open, start);
    if paper.values().iter().filter(|&&on| on).count() < LEAST_AREA {
        return Err(error(format!("lies in a region of less than {LEAST_AREA} px")));
    }
    Ok(paper)
}

/// The largest region of paper that the border does not reach.
fn largest_enclosed(open: &Grid<bool>, notes: &mut Vec<String>) -> Result<Grid<bool>, MarginError> {
    let outside = flood_fill::from_border(open);
    let mut enclosed = open.clone();
    for (enclosed, &out) in enclosed.values_mut().iter_mut().zip(outside.values()) {
        *enclosed &= !out;
    }
    let regions = Components::of(&enclosed);
    let (label, area) =
        regions.largest().filter(|&(_, area)| area >= LEAST_AREA).ok_or_else(|| {
            let problem = "the drawing encloses no region: close the outline, or give the root to \
                       learn where it is open";
            MarginError::Picture(problem.into())
        })?;
    let others = regions.areas[1..].iter().filter(|&&other| other * 10 > area).count();
    if others > 1 {
        notes.push(format!("the drawing encloses {others} regions: took the largest"));
    }
    Ok(regions.labels.map(|&l| l == label))
}

/// The paper, what it encloses, and the ink of thin lines that reach into it from the outline.
fn with_slits_closed(paper: &Grid<bool>, open: &Grid<bool>) -> Grid<bool> {
    let (width, height) = (paper.width(), paper.height());
    let around = flood_fill::from_border(&paper.map(|&inside| !inside));
    let blade = around.map(|&out| !out);
    let (is_blade, is_open) = (blade.values(), open.values());
    // How thick the outline is: the way from beyond it to the blade, for most of its length.
    let to_blade = chamfer::distance_to(width, height, |i| is_blade[i]);
    let to_beyond = chamfer::distance_to(width, height, |i| is_open[i] && !is_blade[i]);
    let mut ways: Vec<u32> = (0..width * height)
        .filter(|&i| !is_blade[i] && to_beyond.values()[i] == PIXEL)
        .map(|i| to_blade.values()[i])
        .collect();
    if ways.is_empty() {
        return blade;
    }
    let three_quarters = ways.len() * 3 / 4;
    let thickness = *ways.select_nth_unstable(three_quarters).1;
    // Ink deeper than that, between two banks of the blade no farther apart than a stroke.
    let reach = thickness / 2 + PIXEL * 3 / 2;
    let to_far = chamfer::distance_to(width, height, |i| to_blade.values()[i] > reach);
    let closed = (0..width * height).map(|i| {
        let slit = !is_open[i]
            && to_beyond.values()[i] > thickness + PIXEL / 2
            && to_far.values()[i] > reach;
        is_blade[i] || slit
    });
    let closed = Grid::from_values(width, height, closed.collect());
    let around = flood_fill::from_border(&closed.map(|&inside| !inside));
    around.map(|&out| !out)
}

/// The centre lines of the ink inside the blade, clipped to the outline.
fn slits(blade: &Grid<bool>, open: &Grid<bool>, outline: &[DVec2]) -> Vec<Vec<DVec2>> {
    const LEAST_PX: usize = 6;
    let mut ink = blade.clone();
    for (ink, &open) in ink.values_mut().iter_mut().zip(open.values()) {
        *ink &= !open;
    }
    let index = SegmentIndex::of_polygon(outline);
    let mut lines = Vec::new();
    for line in thinning::centre_lines(&ink, LEAST_PX) {
        // Thinning pulls ends back, so little is lost where a line starts at the margin.
        for run in line.split(|&p| !index.contains(p)) {
            if run.len() > 1 {
                lines.push(run.to_vec());
            }
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;

    const INK: [u8; 4] = [20, 20, 60, 255];

    /// A circle of radius 60 around (100, 80) drawn with a pen 4 px wide on 200 × 160 px.
    fn circle() -> Picture {
        let mut pixels = Grid::filled(200, 160, [250, 250, 240, 255]);
        for y in 0..160 {
            for x in 0..200 {
                let r = (x as f64 + 0.5 - 100.0).hypot(y as f64 + 0.5 - 80.0);
                if (60.0..64.0).contains(&r) {
                    pixels[(x, y)] = INK;
                }
            }
        }
        Picture { pixels, file_pixels: 1.0 }
    }

    fn stroke(picture: &mut Picture, x: std::ops::Range<usize>, y: std::ops::Range<usize>) {
        for y in y {
            for x in x.clone() {
                picture.pixels[(x, y)] = INK;
            }
        }
    }

    const DISC: f64 = std::f64::consts::PI * 60.0 * 60.0;

    #[test]
    fn the_interior_of_the_drawing_is_the_blade() {
        let picture = circle();
        assert!(looks_like_sketch(&picture));
        for root in [None, Some(DVec2::new(100.0, 130.0)), Some(DVec2::new(100.0, 142.0))] {
            let traced = trace(&picture, root).expect("a closed circle");
            let area = polygon::signed_area(&traced.outline);
            assert!((area / DISC - 1.0).abs() < 0.02, "{area}");
            assert!(traced.cuts.is_empty());
        }
    }

    #[test]
    fn lines_drawn_inside_are_kept_as_slits() {
        let mut picture = circle();
        // One that floats and one that starts at the outline.
        stroke(&mut picture, 80..83, 60..100);
        stroke(&mut picture, 120..164, 80..83);
        let traced = trace(&picture, None).expect("a closed circle");
        let area = polygon::signed_area(&traced.outline);
        assert!((area / DISC - 1.0).abs() < 0.02, "the slits are not in the outline: {area}");
        assert_eq!(traced.cuts.len(), 2, "{:?}", traced.cuts);
        let length = |line: &Vec<DVec2>| line.windows(2).map(|w| w[0].distance(w[1])).sum::<f64>();
        assert!(traced.cuts.iter().all(|line| (30.0..42.0).contains(&length(line))));
        assert_eq!(traced.notes, ["2 lines inside the blade kept as slits"]);
    }

    #[test]
    fn an_open_outline_says_where_it_leaks() {
        let mut picture = circle();
        for y in 77..83 {
            for x in 155..170 {
                picture.pixels[(x, y)] = [250, 250, 240, 255];
            }
        }
        assert!(!looks_like_sketch(&picture));
        let root = Some(DVec2::new(100.0, 130.0));
        let error = trace(&picture, root).expect_err("it leaks").to_string();
        assert!(error.contains("narrowest near (16"), "{error}");
        let error = trace(&picture, None).expect_err("nothing is enclosed").to_string();
        assert!(error.contains("encloses no region"), "{error}");
    }

    #[test]
    fn a_root_off_the_picture_is_named() {
        let error = trace(&circle(), Some(DVec2::new(-3.0, 900.0))).expect_err("off");
        assert!(error.to_string().contains("(-3, 900) lies outside the picture"), "{error}");
    }
}
