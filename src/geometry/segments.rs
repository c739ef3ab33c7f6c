//! A static index over line segments: which lie near another segment, what is inside a polygon,
//! how far the nearest one is.
//!
//! Segments are listed in every cell of a uniform grid that their box touches. Cells are about one
//! mean segment wide, so a query near few segments looks at few. An empty cell knows how far the next
//! one is that is not, so that a query far from all of them looks at few cells, too.

use std::sync::OnceLock;

use super::polygon::{crosses_ray, nearest_on_segment, segments_touch};
use super::rings::Size;
use super::{DVec2, Rect};

/// An index over segments a–b.
#[derive(Debug, Clone)]
pub struct SegmentIndex {
    segments: Vec<(DVec2, DVec2)>,
    min: DVec2,
    per_cell: f64,
    columns: usize,
    rows: usize,
    /// Where the list of each cell starts in `items`.
    starts: Vec<u32>,
    items: Vec<u32>,
    /// From each cell the number of columns or rows, whichever is more, to the nearest that is not empty.
    /// Worked out when first asked for: a margin's own edges, among which none is long, do without.
    away: OnceLock<Vec<u16>>,
    /// For each cell that no segment comes into, whether it lies inside the polygon they make. Likewise.
    inside: OnceLock<Vec<bool>>,
}

/// More cells than this buy nothing and cost memory.
const MAX_CELLS_A_SIDE: f64 = 512.0;

/// Along fewer cells than this each is looked at, unless it is known already which are empty.
const FEW_CELLS: usize = 12;

impl SegmentIndex {
    /// Over the edges of a closed polygon; segment `i` runs from vertex `i` to the next.
    #[must_use]
    pub fn of_polygon(polygon: &[DVec2]) -> Self {
        Self::new(super::polygon::edges(polygon).collect())
    }

    /// Over any segments.
    #[must_use]
    pub fn new(segments: Vec<(DVec2, DVec2)>) -> Self {
        let bounds = Rect::around(segments.iter().flat_map(|&(a, b)| [a, b]));
        let size = bounds.size().max(DVec2::ZERO);
        let mean = segments.iter().map(|(a, b)| a.distance(*b)).sum::<f64>()
            / segments.len().max(1) as f64;
        let widest = size.max_element();
        let cell = mean.max(widest / MAX_CELLS_A_SIDE).max(f64::MIN_POSITIVE);
        let count = |length: f64| ((length / cell) as usize + 1).min(MAX_CELLS_A_SIDE as usize + 1);
        let (columns, rows) = (count(size.x), count(size.y));
        let min = if segments.is_empty() { DVec2::ZERO } else { bounds.min };
        let mut index = Self {
            segments,
            min,
            per_cell: 1.0 / cell,
            columns,
            rows,
            starts: vec![0; columns * rows + 1],
            items: Vec::new(),
            away: OnceLock::new(),
            inside: OnceLock::new(),
        };
        index.fill();
        index
    }

    fn fill(&mut self) {
        let boxes: Vec<_> =
            self.segments.iter().map(|&(a, b)| self.cells(a.min(b), a.max(b))).collect();
        let mut counts = vec![0u32; self.columns * self.rows + 1];
        for &(x0, y0, x1, y1) in &boxes {
            for y in y0..=y1 {
                for x in x0..=x1 {
                    counts[y * self.columns + x + 1] += 1;
                }
            }
        }
        for i in 1..counts.len() {
            counts[i] += counts[i - 1];
        }
        self.starts.clone_from(&counts);
        self.items = vec![0; counts[counts.len() - 1] as usize];
        for (i, &(x0, y0, x1, y1)) in boxes.iter().enumerate() {
            for y in y0..=y1 {
                for x in x0..=x1 {
                    let slot = &mut counts[y * self.columns + x];
                    self.items[*slot as usize] = i as u32;
                    *slot += 1;
                }
            }
        }
    }

    fn away(&self) -> &[u16] {
        self.away.get_or_init(|| self.measured_emptiness())
    }

    /// In two sweeps over the rows, down and up: every way of a king goes on in one of them.
    fn measured_emptiness(&self) -> Vec<u16> {
        let columns = self.columns;
        let far = columns.max(self.rows) as u16;
        let of_cell = |run: &[u32]| if run[0] == run[1] { far } else { 0 };
        let mut away: Vec<u16> = self.starts.windows(2).map(of_cell).collect();
        for row in 0..self.rows {
            let (above, rest) = away.split_at_mut(row * columns);
            spread(&above[above.len().saturating_sub(columns)..], &mut rest[..columns]);
        }
        for row in (0..self.rows).rev() {
            let (rest, below) = away.split_at_mut((row + 1) * columns);
            spread(&below[..below.len().min(columns)], &mut rest[row * columns..]);
        }
        away
    }

    /// The cells that a box touches, clamped to the grid.
    fn cells(&self, min: DVec2, max: DVec2) -> (usize, usize, usize, usize) {
        let low = ((min - self.min) * self.per_cell).max(DVec2::ZERO);
        let high = ((max - self.min) * self.per_cell).max(DVec2::ZERO);
        (
            (low.x as usize).min(self.columns - 1),
            (low.y as usize).min(self.rows - 1),
            (high.x as usize).min(self.columns - 1),
            (high.y as usize).min(self.rows - 1),
        )
    }

    fn cell(&self, x: usize, y: usize) -> &[u32] {
        let i = y * self.columns + x;
        &self.items[self.starts[i] as usize..self.starts[i + 1] as usize]
    }

    /// Whether `test` holds for a segment whose cells the box of a–b touches. `test` gets indices,
    /// some more than once.
    pub fn any_near(&self, a: DVec2, b: DVec2, mut test: impl FnMut(usize) -> bool) -> bool {
        let (x0, y0, x1, y1) = self.cells(a.min(b), a.max(b));
        let widest = (x1 - x0).max(y1 - y0);
        // By far the most are the short edges of veins: they need not ask what is known of other cells.
        if widest == 0 {
            return self.cell(x0, y0).iter().any(|&i| test(i as usize));
        }
        let known = self.away.get().map(Vec::as_slice).unwrap_or_default();
        let known = if widest < FEW_CELLS { known } else { self.away() };
        let away =
            |x: usize, y: usize| known.get(y * self.columns + x).map_or(0, |&n| usize::from(n));
        if away(x0, y0) > widest {
            return false;
        }
        (y0..=y1).any(|y| {
            let mut x = x0;
            while x <= x1 {
                if self.cell(x, y).iter().any(|&i| test(i as usize)) {
                    return true;
                }
                x += away(x, y).max(1);
            }
            false
        })
    }

    /// Whether the segment a–b touches any of these.
    #[must_use]
    pub fn touches(&self, a: DVec2, b: DVec2) -> bool {
        self.any_near(a, b, |i| {
            let (c, d) = self.segments[i];
            segments_touch(a, b, c, d)
        })
    }

    /// Which of the empty cells lie inside. Beside an empty cell, an empty one is like it.
    fn found_inside(&self) -> Vec<bool> {
        let mut inside = vec![false; self.columns * self.rows];
        for row in 0..self.rows {
            let mut known = None;
            for column in 0..self.columns {
                let is_empty = self.cell(column, row).is_empty();
                let middle = DVec2::new(column as f64 + 0.5, row as f64 + 0.5);
                let is_inside =
                    || self.crosses_oddly(self.min + middle / self.per_cell, column, row);
                known = is_empty.then(|| known.unwrap_or_else(is_inside));
                inside[row * self.columns + column] = known == Some(true);
            }
        }
        inside
    }

    /// Whether `p` lies inside the closed polygon whose edges these are (even-odd rule).
    #[must_use]
    pub fn contains(&self, p: DVec2) -> bool {
        let cell = (p - self.min) * self.per_cell;
        if cell.y < 0.0 || cell.y >= self.rows as f64 || cell.x >= self.columns as f64 {
            return false;
        }
        let (row, column) = (cell.y as usize, cell.x.max(0.0) as usize);
        if self.cell(column, row).is_empty() {
            let inside = self.inside.get_or_init(|| self.found_inside());
            return inside[row * self.columns + column];
        }
        self.crosses_oddly(p, column, row)
    }

    /// Whether the ray from `p`, in the cell of that column and row, to the right crosses an odd number
    /// of segments.
    fn crosses_oddly(&self, p: DVec2, first: usize, row: usize) -> bool {
        let mut inside = false;
        for x in first..self.columns {
            for &i in self.cell(x, row) {
                let (a, b) = self.segments[i as usize];
                // A segment stands in several cells of the row: count it in the first one only.
                let low = (a.x.min(b.x) - self.min.x) * self.per_cell;
                let home = (low.max(0.0) as usize).clamp(first, self.columns - 1);
                if home == x && crosses_ray(a, b, p) {
                    inside = !inside;
                }
            }
        }
        inside
    }

    /// The squared distance from `p` to the nearest segment and that segment, when within `reach`.
    #[must_use]
    pub fn nearest(&self, p: DVec2, reach: f64) -> Option<(f64, usize)> {
        let mut best = (reach * reach, usize::MAX);
        // Rings of cells outwards; stop once a whole ring is farther than the best.
        let centre = ((p - self.min) * self.per_cell)
            .clamp(DVec2::ZERO, DVec2::new(self.columns as f64 - 1.0, self.rows as f64 - 1.0));
        let home = (centre.x as usize, centre.y as usize);
        let size = Size { columns: self.columns, rows: self.rows };
        let outside = p.distance(p.clamp(
            self.min,
            self.min + DVec2::new(self.columns as f64, self.rows as f64) / self.per_cell,
        ));
        let empty = usize::from(self.away()[home.1 * self.columns + home.0]);
        for ring in empty..size.last_ring() {
            let clear = (ring.saturating_sub(1) as f64 / self.per_cell).max(outside);
            if clear * clear > best.0 {
                break;
            }
            size.for_each_in_ring(home, ring, |column, row| {
                for &i in self.cell(column, row) {
                    let (a, b) = self.segments[i as usize];
                    let d2 = p.distance_squared(nearest_on_segment(a, b, p));
                    if (d2, i as usize) < best {
                        best = (d2, i as usize);
                    }
                }
            });
        }
        (best.1 != usize::MAX).then_some(best)
    }
}

/// Takes the distances of the cells of a row no farther than a king goes from the row before, if there is one,
/// and along the row.
fn spread(before: &[u16], row: &mut [u16]) {
    let nearer = |cells: &mut [u16], from: &[u16]| {
        cells.iter_mut().zip(from).for_each(|(own, from)| *own = (*own).min(from + 1));
    };
    if let [_, beyond @ ..] = before {
        nearer(row, before);
        nearer(row, beyond);
        nearer(&mut row[1..], before);
    }
    for x in 1..row.len() {
        row[x] = row[x].min(row[x - 1] + 1);
    }
    for x in (1..row.len()).rev() {
        row[x - 1] = row[x - 1].min(row[x] + 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;
    use crate::seed::{Seed, Stage};

    fn star(points: usize) -> Vec<DVec2> {
        (0..points)
            .map(|i| {
                let angle = std::f64::consts::TAU * i as f64 / points as f64;
                let radius = if i % 2 == 0 { 10.0 } else { 4.0 };
                DVec2::new(angle.cos(), angle.sin()) * radius
            })
            .collect()
    }

    #[test]
    fn the_index_agrees_with_looking_at_every_edge() {
        // Among cells as wide as the whole, and among many that are empty.
        for outline in [star(34), polygon::subdivided(&star(34), 0.3)] {
            let index = SegmentIndex::of_polygon(&outline);
            // Never asked for anything by which it would learn which cells are empty.
            let unaware = index.clone();
            let mut rng = Seed(5).stream(Stage::Tissue);
            for i in 0..2000 {
                let p = DVec2::new(rng.between(-12.0, 12.0), rng.between(-12.0, 12.0));
                let reach = if i % 4 == 0 { 9.0 } else { 2.0 };
                let q = p + DVec2::new(rng.between(-reach, reach), rng.between(-reach, reach));
                assert_eq!(index.contains(p), polygon::contains(&outline, p), "{p}");
                let touches = polygon::edges(&outline).any(|(a, b)| segments_touch(a, b, p, q));
                assert_eq!(index.touches(p, q), touches);
                let near = p + (q - p).clamp_length_max(1.5);
                let touches = polygon::edges(&outline).any(|(a, b)| segments_touch(a, b, p, near));
                assert_eq!(unaware.touches(p, near), touches);
                let nearest = polygon::edges(&outline)
                    .map(|(a, b)| p.distance_squared(nearest_on_segment(a, b, p)))
                    .fold(f64::INFINITY, f64::min);
                let (found, _) = index.nearest(p, 100.0).expect("something is nearest");
                assert!((found - nearest).abs() < 1e-12);
            }
            assert!(unaware.away.get().is_none() && unaware.inside.get().is_none());
        }
    }

    #[test]
    fn every_cell_knows_how_far_the_next_is_that_is_not_empty() {
        let index = SegmentIndex::of_polygon(&polygon::subdivided(&star(12), 0.5));
        let cells = || (0..index.rows).flat_map(|y| (0..index.columns).map(move |x| (x, y)));
        let full: Vec<_> = cells().filter(|&(x, y)| !index.cell(x, y).is_empty()).collect();
        for (x, y) in cells() {
            let away = full.iter().map(|&(i, j)| x.abs_diff(i).max(y.abs_diff(j))).min();
            assert_eq!(Some(usize::from(index.away()[y * index.columns + x])), away, "{x}, {y}");
        }
        assert!(cells().count() > 3 * full.len(), "most are empty");
    }
}
