//! Outlines from files: pictures of leaves and polygons, told apart by their content.
//!
//! Files are not trusted: sizes are capped before anything is read, pictures are decoded row by row
//! where the format allows it, and nothing that a file names is opened.

mod csv;
mod picture;
mod svg;

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::DVec2;

use crate::geometry::{Rect, polygon};
use crate::margin::blades::{self, Blades};
use crate::margin::placement::{self, Found, Placed};
use crate::margin::silhouette::{self, Picture, Traced};
use crate::margin::{self, Margin, MarginError, MarginKind, MarginSpec, sketch, tidy};
use crate::parameter::words;
use crate::point_list::PointError;
use crate::seed::Seed;

words! {
    /// What a file shows.
    pub enum OutlineKind {
        /// Tell by its content.
        Auto = "auto",
        /// A drawing with a pen: the region that the line encloses.
        Sketch = "sketch",
        /// A photograph, scan or mask on a plain background.
        Photo = "photo",
        /// A polygon: CSV or an SVG path.
        Polygon = "polygon",
    }
}

/// How to read an outline.
#[derive(Debug, Clone, PartialEq)]
pub struct OutlineOptions {
    /// What the file shows.
    pub kind: OutlineKind,
    /// Where the petiole is attached, in the file's own coordinates; found when not given. Pictures:
    /// pixels, y down, as shown, EXIF orientation applied. In a sketch it lies inside the blade.
    pub root: Option<[f64; 2]>,
    /// The y axis of a CSV points up.
    pub y_up: bool,
    /// Length of the blade from base to apex, without petiole (mm).
    pub length_mm: f64,
}

impl Default for OutlineOptions {
    fn default() -> Self {
        Self { kind: OutlineKind::Auto, root: None, y_up: false, length_mm: 80.0 }
    }
}

/// An outline in leaf space, fit for [`Margin::new`].
#[derive(Debug, Clone, PartialEq)]
pub struct ImportedOutline {
    /// The outline (mm): the base at [0, 0] first, anticlockwise, the apex on +y.
    pub polygon_mm: Vec<[f64; 2]>,
    /// Slits inside (mm).
    pub cuts_mm: Vec<Vec<[f64; 2]>>,
    /// What the file was taken for; never [`OutlineKind::Auto`].
    pub kind: OutlineKind,
    /// Where the petiole was attached, in the file's own coordinates.
    pub base: [f64; 2],
    /// Where the apex was, in the file's own coordinates.
    pub apex: [f64; 2],
    /// What was done that the user should know of, a short sentence each.
    pub notes: Vec<String>,
}

impl ImportedOutline {
    /// The outline as a margin, with its slits.
    ///
    /// # Errors
    ///
    /// None that an outline as it was imported could cause; those of [`Margin::new`] for one that was
    /// changed.
    pub fn margin(&self) -> Result<Margin, MarginError> {
        let spec = MarginSpec {
            kind: MarginKind::Polygon,
            length_mm: self.length_mm(),
            polygon_mm: self.polygon_mm.clone(),
            cuts_mm: self.cuts_mm.clone(),
            ..MarginSpec::default()
        };
        // Nothing random in it: no teeth, waves or roughness.
        margin::build(&spec, Seed(0))
    }

    fn length_mm(&self) -> f64 {
        let on_axis = self.polygon_mm.iter().filter(|p| p[0].abs() <= 1e-9 * p[1].abs().max(1.0));
        on_axis.map(|p| p[1]).fold(0.0, f64::max)
    }
}

/// Why a file gave no outline. Displays as one line: the path, then the problem.
#[derive(Debug, thiserror::Error)]
#[error("{}: {problem}", path.display())]
pub struct OutlineError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub problem: OutlineProblem,
}

/// What is wrong with a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum OutlineProblem {
    /// It cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] std::io::Error),
    /// It is broken, of another kind, or too large.
    #[error("{0}")]
    Content(String),
    /// A line of it is no point.
    #[error(transparent)]
    Point(#[from] PointError),
    /// It is what it should be but shows no usable leaf.
    #[error("{0}")]
    Leaf(#[from] MarginError),
    /// The wanted length is no length.
    #[error("the length {0} mm is not a positive number")]
    Length(f64),
}

impl OutlineProblem {
    fn content(problem: impl Into<String>) -> Self {
        Self::Content(problem.into())
    }
}

/// An outline in the coordinates of its file.
struct Found2d {
    traced: Traced,
    kind: OutlineKind,
    /// What one unit of `traced` is in the file.
    unit: f64,
    /// y points down in the file.
    y_down: bool,
}

/// Files of text are not larger than this (bytes).
const MOST_TEXT: u64 = 32 << 20;

/// Outlines of fewer points get more on their edges.
const FEW_POINTS: usize = 32;

/// Reads a leaf outline from a PNG, JPEG, CSV or SVG file.
///
/// # Errors
///
/// [`OutlineError`], with the path: for files that cannot be read, hold no outline, or hold one that
/// [`Margin::new`] refuses, and for a root away from the leaf.
pub fn import(path: &Path, options: &OutlineOptions) -> Result<ImportedOutline, OutlineError> {
    read(path, options).map_err(|problem| OutlineError { path: path.to_owned(), problem })
}

/// Finds every blade in a PNG or JPEG picture.
///
/// # Errors
///
/// [`OutlineError`], with the path: for files that are no picture and pictures without a blade.
pub fn blades(path: &Path) -> Result<Blades, OutlineError> {
    let find = || -> Result<Blades, OutlineProblem> {
        let mut head = Vec::new();
        File::open(path)?.take(16).read_to_end(&mut head)?;
        let format = picture::Format::of(&head)
            .ok_or_else(|| OutlineProblem::content("is not a PNG or JPEG picture"))?;
        let (picture, mut notes) = picture::read(path, format)?;
        let mut found = blades::find(&picture)?;
        notes.append(&mut found.notes);
        Ok(Blades { notes, ..found })
    };
    find().map_err(|problem| OutlineError { path: path.to_owned(), problem })
}

fn read(path: &Path, options: &OutlineOptions) -> Result<ImportedOutline, OutlineProblem> {
    let length_mm = options.length_mm;
    if !(length_mm.is_finite() && length_mm > 0.0) {
        return Err(OutlineProblem::Length(length_mm));
    }
    let mut file = File::open(path)?;
    let mut head = Vec::new();
    Read::by_ref(&mut file).take(16).read_to_end(&mut head)?;
    if head.is_empty() {
        return Err(OutlineProblem::content("the file is empty"));
    }
    let mut found = match picture::Format::of(&head) {
        Some(format) => from_picture(path, format, options)?,
        None => from_text(path, file, &head, options)?,
    };
    tidy::thin(&mut found.traced);
    mend(&mut found)?;
    place(found, options)
}

fn from_picture(
    path: &Path,
    format: picture::Format,
    options: &OutlineOptions,
) -> Result<Found2d, OutlineProblem> {
    if options.kind == OutlineKind::Polygon {
        return Err(OutlineProblem::content("is a picture, not a polygon (CSV or SVG)"));
    }
    let (picture, mut notes) = picture::read(path, format)?;
    let kind = match options.kind {
        OutlineKind::Auto if sketch::looks_like_sketch(&picture) => OutlineKind::Sketch,
        OutlineKind::Auto => OutlineKind::Photo,
        kind => kind,
    };
    let root = options.root.map(|root| DVec2::from(root) / picture.file_pixels);
    let mut traced = trace(kind, &picture, root)?;
    if kind == OutlineKind::Photo && options.kind == OutlineKind::Auto && is_a_line(&traced.outline)
    {
        // A drawing that does not close. Given a root, the rule for sketches says where it leaks.
        let _ = trace(OutlineKind::Sketch, &picture, root)?;
        return Err(OutlineProblem::content(
            "shows thin lines that enclose no blade; if it is a drawing, close its outline (a root \
             inside tells where it is open)",
        ));
    }
    notes.append(&mut traced.notes);
    traced.notes = notes;
    Ok(Found2d { traced, kind, unit: picture.file_pixels, y_down: true })
}

fn trace(kind: OutlineKind, picture: &Picture, root: Option<DVec2>) -> Result<Traced, MarginError> {
    match kind {
        OutlineKind::Sketch => sketch::trace(picture, root),
        _ => silhouette::trace(picture, root),
    }
}

/// Whether an outline surrounds a drawn line and no blade: even blades of grass are wider.
fn is_a_line(outline: &[DVec2]) -> bool {
    const LEAST_WIDTH: f64 = 0.01;
    let extent = Rect::around(outline.iter().copied()).size().max_element();
    let width = 2.0 * polygon::signed_area(outline).abs() / polygon::perimeter(outline);
    width < LEAST_WIDTH * extent
}

fn from_text(
    path: &Path,
    mut file: File,
    head: &[u8],
    options: &OutlineOptions,
) -> Result<Found2d, OutlineProblem> {
    let named = path.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
    let named = named.as_deref().unwrap_or("");
    let wants_picture = matches!(options.kind, OutlineKind::Sketch | OutlineKind::Photo);
    if wants_picture || matches!(named, "png" | "jpg" | "jpeg") {
        return Err(OutlineProblem::content("is not a PNG or JPEG picture"));
    }
    if let Some(other) = picture::other_format(head) {
        let problem = format!("is {other}; save the picture as PNG or JPEG");
        return Err(OutlineProblem::Content(problem));
    }
    let size = file.metadata()?.len();
    if size > MOST_TEXT {
        let problem = format!(
            "has {size} bytes; a polygon may have {MOST_TEXT} (simplify it, or give a picture)"
        );
        return Err(OutlineProblem::Content(problem));
    }
    let mut bytes = head.to_vec();
    Read::by_ref(&mut file).take(MOST_TEXT).read_to_end(&mut bytes)?;
    let text = std::str::from_utf8(&bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&b| b == b'\n').count() + 1;
        OutlineProblem::Content(format!("line {line}: is not text; neither a CSV nor an SVG file"))
    })?;
    let text = text.trim_start_matches('\u{feff}');
    let is_svg = named == "svg" || text.trim_start().starts_with('<');
    let (outline, notes) = if is_svg { svg::outline(text)? } else { csv::outline(text)? };
    let y_down = is_svg || !options.y_up;
    let traced = Traced { outline, cuts: Vec::new(), notes };
    Ok(Found2d { traced, kind: OutlineKind::Polygon, unit: 1.0, y_down })
}

/// Takes small loops out of an outline that crosses itself.
fn mend(found: &mut Found2d) -> Result<(), OutlineProblem> {
    let outline = &mut found.traced.outline;
    let Some(at) = polygon::self_crossing(outline) else { return Ok(()) };
    // A line crosses itself everywhere; what it lacks is area.
    let size = Rect::around(outline.iter().copied()).size();
    let area = polygon::signed_area(outline);
    if area.abs() < 1e-5 * size.max_element().powi(2) {
        return Err(OutlineProblem::content("the points lie on a line and enclose no area"));
    }
    match tidy::without_loops(outline) {
        Some(mended) => {
            *outline = mended;
            let at = at * found.unit;
            found
                .traced
                .notes
                .push(format!("the outline crossed itself near {}: loops cut off", place_name(at)));
            Ok(())
        }
        None => Err(OutlineProblem::Content(format!(
            "the outline crosses itself near {}; mend it there",
            place_name(at * found.unit)
        ))),
    }
}

/// From the coordinates of the file to leaf space.
fn place(found: Found2d, options: &OutlineOptions) -> Result<ImportedOutline, OutlineProblem> {
    let Found2d { traced, kind, unit, y_down } = found;
    let up = DVec2::new(1.0, if y_down { -1.0 } else { 1.0 });
    let outline: Vec<DVec2> = traced.outline.iter().map(|&p| p * up).collect();
    let cuts: Vec<Vec<DVec2>> =
        traced.cuts.iter().map(|line| line.iter().map(|&p| p * up).collect()).collect();
    let root = options.root.map(|root| DVec2::from(root) * up / unit);
    let placed =
        placement::place(&outline, &cuts, root, options.length_mm).map_err(|error| {
            match (error, options.root) {
                (MarginError::Root { problem, .. }, Some([x, y])) => {
                    MarginError::Root { x, y, problem }
                }
                (error, _) => error,
            }
        })?;
    // Guarantees are the margin's to give.
    let hint = "mend the outline there";
    let (mut points, mut apex) = (placed.outline.clone(), placed.apex);
    if points.len() < FEW_POINTS {
        // A diamond typed by hand is an outline too.
        let tip = points[apex];
        points = polygon::subdivided(&points, polygon::perimeter(&points) / FEW_POINTS as f64);
        apex = points.iter().position(|p| *p == tip).unwrap_or(apex);
    }
    let margin = Margin::new(points, apex, placed.cuts.clone(), hint)?;

    let mut notes = traced.notes;
    let in_file = |p: DVec2| p * up * unit;
    let (base, apex) = (in_file(placed.base_was), in_file(placed.apex_was));
    notes.push(attachment_note(&placed, base, kind));
    let plain = |line: &[DVec2]| line.iter().map(|p| p.to_array()).collect();
    Ok(ImportedOutline {
        polygon_mm: plain(margin.outline()),
        cuts_mm: margin.cuts().iter().map(|line| plain(line)).collect(),
        kind,
        base: base.to_array(),
        apex: apex.to_array(),
        notes,
    })
}

fn attachment_note(placed: &Placed, base: DVec2, kind: OutlineKind) -> String {
    let how = match placed.found {
        Found::Given => "petiole attachment as given",
        Found::Stalk => "petiole cut off; attachment",
        Found::Nub => "petiole attachment found where the base sticks out,",
        Found::Notch => "petiole attachment found in the notch of the base,",
        Found::End => "no petiole: attachment assumed",
    };
    match kind {
        OutlineKind::Polygon => format!("{how} at {}", place_name(base)),
        _ => format!("{how} at pixel ({:.0}, {:.0})", base.x, base.y),
    }
}

/// A place in the coordinates of a file, to about five digits.
fn place_name(p: DVec2) -> String {
    let number = |v: f64| match v.abs() {
        size if size >= 1e7 || (size < 1e-2 && size > 0.0) => format!("{v:.4e}"),
        size if size >= 100.0 => format!("{v:.1}"),
        _ => format!("{v:.3}"),
    };
    format!("({}, {})", number(p.x), number(p.y))
}
