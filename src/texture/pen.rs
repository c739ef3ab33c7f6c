//! Tapered strokes laid on rows of texels, some texels at a time.
//!
//! What a stroke is on a row is worked out once, and a block of texels is taken without a branch, so that
//! all of them are drawn at once. Most veins are a few texels long: what counts is the work for a row, not
//! for a texel.

use std::ops::Range;

use glam::Vec2;

use crate::raster::coverage::Capsule;

/// Texels that are drawn on at a time. Beyond its reach a stroke leaves them as they are, so that rows may
/// be longer by a block than they are read.
pub(super) const BLOCK: usize = 8;

/// A number of every texel of a block.
pub(super) type Block = [f32; BLOCK];

/// A stroke made ready to be drawn row by row.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pen {
    capsule: Capsule,
    reach: f32,
    along: Vec2,
    /// From one end to the other the place along the axis goes from 0 to 1.
    per_along: Vec2,
    /// By how much the axis goes aside from row to row, and how far the reach goes beside it; none where
    /// the stroke lies flat.
    lean: Option<[f32; 2]>,
}

/// A pen on one row.
#[derive(Debug, Clone, Copy)]
pub(super) struct RowPen<'a> {
    pen: &'a Pen,
    /// From the first end to the centres of the row.
    dy: f32,
    /// What that adds to the place along the axis.
    before: f32,
}

/// The axis of a stroke seen from the texels of a block.
#[derive(Debug, Clone, Copy)]
pub(super) struct Axis {
    /// The squared distance to it.
    pub distance2: Block,
    /// The radius of the stroke at the nearest place.
    pub radius: Block,
}

impl Pen {
    /// Nothing of the stroke is found farther than `reach` from its axis.
    #[inline(always)]
    pub(super) fn new(capsule: &Capsule, reach: f32) -> Self {
        let along = capsule.b - capsule.a;
        let length2 = along.length_squared();
        let per_length2 = if length2 > 0.0 { 1.0 / length2 } else { 0.0 };
        let flat = along.y.abs() < 0.1 * along.x.abs() || along.y == 0.0;
        let lean = (!flat).then(|| {
            let per_y = 1.0 / along.y;
            [along.x * per_y, reach * length2.sqrt() * per_y.abs() + 1.0]
        });
        Self { capsule: *capsule, reach, along, per_along: along * per_length2, lean }
    }

    /// Of some columns those that can lie within reach in row `y`: a slanted stroke crosses few of its
    /// box.
    #[inline(always)]
    pub(super) fn columns(&self, y: usize, columns: Range<usize>) -> Range<usize> {
        let Some([per_row, aside]) = self.lean else { return columns };
        // Where the axis, drawn out, has the height of the row.
        let a = self.capsule.a;
        let middle = a.x + (y as f32 + 0.5 - a.y) * per_row;
        clip(middle - aside..middle + aside + 1.0, &columns)
    }

    /// As [`columns`](Self::columns), of a stroke that is wide for its length: above and below its ends it
    /// is round.
    #[inline(always)]
    pub(super) fn chord(&self, y: usize, columns: Range<usize>) -> Range<usize> {
        let (low, high) = (self.capsule.a.min(self.capsule.b), self.capsule.a.max(self.capsule.b));
        let y = y as f32 + 0.5;
        let beyond = (low.y - y).max(y - high.y).max(0.0);
        let aside = (self.reach * self.reach - beyond * beyond).max(0.0).sqrt() + 1.0;
        clip(low.x - aside..high.x + aside + 1.0, &columns)
    }

    #[inline(always)]
    pub(super) fn on_row(&self, y: usize) -> RowPen<'_> {
        let dy = y as f32 + 0.5 - self.capsule.a.y;
        RowPen { pen: self, dy, before: dy * self.per_along.y }
    }
}

/// The columns between two places, among others.
#[inline(always)]
fn clip(ends: Range<f32>, columns: &Range<usize>) -> Range<usize> {
    let clip = |x: f32| (x.max(0.0) as usize).clamp(columns.start, columns.end);
    clip(ends.start)..clip(ends.end)
}

impl RowPen<'_> {
    /// The axis as seen from the texels from column `x` on.
    #[inline(always)]
    pub(super) fn axis(&self, x: usize) -> Axis {
        let Pen { capsule: Capsule { a, radius_a, radius_b, .. }, along, per_along, .. } = self.pen;
        let mut axis = Axis { distance2: [0.0; BLOCK], radius: [0.0; BLOCK] };
        let first = x as f32 + 0.5 - a.x;
        for i in 0..BLOCK {
            let dx = first + i as f32;
            let t = (dx * per_along.x + self.before).clamp(0.0, 1.0);
            let (ex, ey) = (dx - along.x * t, self.dy - along.y * t);
            axis.distance2[i] = ex * ex + ey * ey;
            axis.radius[i] = radius_a + (radius_b - radius_a) * t;
        }
        axis
    }
}

/// A block of texels, to be worked on.
///
/// # Panics
///
/// If they are more or fewer.
#[inline(always)]
pub(super) fn block(texels: &[f32]) -> Block {
    texels.try_into().expect("as many texels as a block has")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_lies_within_reach_is_in_the_columns() {
        let ends = [(3.2, 4.1, 40.7, 9.3), (20.0, 3.0, 21.5, 44.0), (9.0, 9.0, 9.0, 9.0)];
        for (ax, ay, bx, by) in ends {
            for reach in [0.8, 3.3, 11.0_f32] {
                let (a, b) = (Vec2::new(ax, ay), Vec2::new(bx, by));
                let capsule = Capsule { a, b, radius_a: reach, radius_b: 0.5 * reach };
                let pen = Pen::new(&capsule, reach);
                let [columns, rows] = capsule.pixels(reach, 50, 0..50);
                for (y, x) in (0..50).flat_map(|y| (0..50).map(move |x| (y, x))) {
                    let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    let (distance2, t) = capsule.nearest(centre);
                    let Axis { distance2: found, radius } = pen.on_row(y).axis(x);
                    assert!((found[0] - distance2).abs() < 1e-3 * (1.0 + distance2));
                    assert!((radius[0] - capsule.radius(t)).abs() < 1e-3);
                    if distance2 <= reach * reach {
                        let seen = [pen.columns(y, columns.clone()), pen.chord(y, columns.clone())];
                        assert!(rows.contains(&y) && seen.iter().all(|seen| seen.contains(&x)));
                    }
                }
            }
        }
    }
}
