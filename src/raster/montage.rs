//! Labelled pictures side by side.

use glam::DVec2;

use super::Grid;
use super::draw::{Canvas, Rgba, text_width};

/// A picture on a sheet, and what is said about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// The picture; transparent parts show the sheet.
    pub picture: Grid<Rgba>,
    /// Its name.
    pub label: String,
    /// Lines in smaller letters below the name.
    pub notes: Vec<String>,
}

/// How a sheet is laid out. Pictures keep their shape and fill squares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layout {
    /// Panels in a row; 0 for a sheet that is about as high as wide.
    pub columns: usize,
    /// Side of the square that a picture may fill (pixels).
    pub panel_px: usize,
}

const PAPER: Rgba = [246, 245, 240, 255];
const CARD: Rgba = [255, 255, 255, 255];
const INK: Rgba = [38, 40, 36, 255];
const FAINT_INK: Rgba = [104, 108, 100, 255];

/// A contact sheet: the title, then the panels from left to right and from top to bottom. Text that
/// is too wide for its panel goes on in the next line.
#[must_use]
pub fn sheet(title: &str, panels: &[Panel], layout: Layout) -> Grid<Rgba> {
    let side = layout.panel_px.max(1);
    // Letters follow the panels, but never too small to read.
    let type_size = (side as f64 / 18.0).clamp(15.0, 40.0).round();
    let note_size = (type_size * 0.87).round();
    let gap = (1.2 * type_size) as usize;
    let columns = match layout.columns {
        0 => (1..).find(|n| n * n >= panels.len()).unwrap_or(1),
        columns => columns.min(panels.len().max(1)),
    };

    // Break the texts, so that the heights of the rows are known.
    let width = gap + columns * (side + gap);
    let title_size = 1.35 * type_size;
    let title = wrapped(title, title_size, (width - 2 * gap) as f64);
    let captions: Vec<Caption> =
        panels.iter().map(|panel| Caption::new(panel, type_size, note_size, side)).collect();
    let row_height = |row: &[Caption]| {
        let text = row.iter().map(Caption::height).fold(0.0, f64::max);
        side + text.ceil() as usize + gap
    };
    let title_height = (title.len() as f64 * title_size).ceil() as usize;
    let top = if title.is_empty() { gap } else { gap + title_height + gap / 2 };
    let height = top + captions.chunks(columns).map(row_height).sum::<usize>();

    // Draw them, a row at a time.
    let mut canvas = Canvas::new(width, height.max(1), PAPER);
    write_lines(&mut canvas, &title, DVec2::splat(gap as f64), title_size, INK);
    let mut y = top;
    for (panels, captions) in panels.chunks(columns).zip(captions.chunks(columns)) {
        for (column, (panel, caption)) in panels.iter().zip(captions).enumerate() {
            let x = gap + column * (side + gap);
            canvas.fill(&[&rectangle(x, y, side)], CARD);
            let (w, h) = fitted(panel.picture.width(), panel.picture.height(), side);
            canvas.paste(&panel.picture, (x + (side - w) / 2, y + (side - h) / 2), (w, h));
            let below = DVec2::new(x as f64, (y + side) as f64 + CAPTION_GAP * type_size);
            let after = write_lines(&mut canvas, &caption.label, below, type_size, INK);
            write_lines(&mut canvas, &caption.notes, after, note_size, FAINT_INK);
        }
        y += row_height(captions);
    }
    canvas.into_picture()
}

/// Between picture and caption, in letter sizes.
const CAPTION_GAP: f64 = 0.25;

/// The words under a panel, in lines.
struct Caption {
    label: Vec<String>,
    notes: Vec<String>,
    type_size: f64,
    note_size: f64,
}

impl Caption {
    fn new(panel: &Panel, type_size: f64, note_size: f64, side: usize) -> Self {
        let width = side as f64;
        let notes = panel.notes.iter().flat_map(|note| wrapped(note, note_size, width)).collect();
        Self { label: wrapped(&panel.label, type_size, width), notes, type_size, note_size }
    }

    fn height(&self) -> f64 {
        let lines = self.label.len() as f64 * self.type_size;
        CAPTION_GAP * self.type_size + lines + self.notes.len() as f64 * self.note_size
    }
}

/// Writes lines below each other from a top left corner; returns where the next would begin.
fn write_lines(canvas: &mut Canvas, lines: &[String], at: DVec2, size: f64, ink: Rgba) -> DVec2 {
    // The share of a line that lies above the letters' feet.
    const ASCENT: f64 = 0.8;
    let mut corner = at;
    for line in lines {
        canvas.text(line, corner + DVec2::new(0.0, ASCENT * size), size, ink);
        corner.y += size;
    }
    corner
}

fn rectangle(x: usize, y: usize, side: usize) -> [DVec2; 4] {
    let (left, top, side) = (x as f64, y as f64, side as f64);
    [(0.0, 0.0), (side, 0.0), (side, side), (0.0, side)].map(|(u, v)| DVec2::new(left + u, top + v))
}

/// The largest size of the same shape within a square.
fn fitted(width: usize, height: usize, side: usize) -> (usize, usize) {
    let longest = width.max(height).max(1);
    let scaled = |pixels: usize| ((pixels * side + longest / 2) / longest).clamp(1, side);
    (scaled(width), scaled(height))
}

/// Text in lines no wider than `width`: broken between words and after their hyphens, and within a
/// part of a word that is too wide by itself.
fn wrapped(text: &str, size: f64, width: f64) -> Vec<String> {
    let fits = |line: &str| text_width(line, size) <= width;
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        for (i, part) in parts(word).into_iter().enumerate() {
            if let Some(line) = lines.last_mut() {
                let space = if i == 0 { " " } else { "" };
                let longer = format!("{line}{space}{part}");
                if fits(&longer) {
                    *line = longer;
                    continue;
                }
            }
            let mut line = String::new();
            for c in part.chars() {
                line.push(c);
                if !fits(&line) && line.chars().count() > 1 {
                    line.pop();
                    lines.push(std::mem::replace(&mut line, c.to_string()));
                }
            }
            lines.push(line);
        }
    }
    lines
}

/// A word in parts, each but the last with its hyphen; a sign before a number is no hyphen.
fn parts(word: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let mut start = 0;
    for (i, _) in word.match_indices('-') {
        let before = word[..i].chars().next_back().is_some_and(char::is_alphanumeric);
        let after = word[i + 1..].chars().next().is_some_and(char::is_alphabetic);
        if before && after {
            parts.push(&word[start..=i]);
            start = i + 1;
        }
    }
    parts.push(&word[start..]);
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(width: usize, height: usize, label: &str) -> Panel {
        let picture = Grid::filled(width, height, [30, 120, 40, 255]);
        Panel { picture, label: label.into(), notes: vec!["80 mm".into()] }
    }

    #[test]
    fn pictures_keep_their_shape() {
        assert_eq!(fitted(400, 100, 200), (200, 50));
        assert_eq!(fitted(10, 40, 200), (50, 200));
        assert_eq!(fitted(1, 9000, 200), (1, 200));
    }

    #[test]
    fn text_is_broken_to_fit_and_loses_no_letter() {
        let text = "isotropic growth Rhododendronhybridengarten λ";
        let lines = wrapped(text, 16.0, 120.0);
        assert!(lines.len() > 2);
        assert!(lines.iter().all(|line| text_width(line, 16.0) <= 120.0), "{lines:?}");
        let squeezed = |text: &str| text.replace(' ', "");
        assert_eq!(squeezed(&lines.concat()), squeezed(text));
    }

    #[test]
    fn compound_words_are_broken_at_their_hyphens() {
        assert_eq!(parts("ovate-cordate-straight"), ["ovate-", "cordate-", "straight"]);
        assert_eq!(parts("-3"), ["-3"]);
        assert_eq!(parts("1-9"), ["1-9"]);
        let lines = wrapped("ovate-cordate-straight", 16.0, text_width("ovate-cordate-", 16.0));
        assert_eq!(lines, ["ovate-cordate-", "straight"]);
    }

    #[test]
    fn a_sheet_has_a_column_for_each_panel_up_to_the_number_given() {
        let panels: Vec<Panel> = (0..5).map(|i| panel(64, 64, &format!("{i}"))).collect();
        let of = |columns| sheet("t", &panels, Layout { columns, panel_px: 100 });
        let (wide, square, single) = (of(9), of(0), of(1));
        assert!(wide.width() > 5 * 100 && wide.height() < 2 * 100);
        assert!(square.width() > 3 * 100 && square.width() < 4 * 100);
        assert!(single.width() < 2 * 100 && single.height() > 5 * 100);
    }

    #[test]
    fn an_empty_sheet_is_paper() {
        let empty = sheet("", &[], Layout { columns: 0, panel_px: 100 });
        assert!(empty.values().iter().all(|pixel| *pixel == PAPER));
    }
}
