//! Attraction without a reach: whole tiles of sources are passed over when no new node can be nearer
//! to any of them than what it has.
//!
//! Without a reach every source acts from the first step on, and asking each in every step whether
//! one of the new nodes is nearer costs O(sources · new nodes). Most new nodes are far from most
//! sources: which of them matter is asked first for blocks of some hundred sources, then for tiles
//! of sixteen, and the few that are left are measured from each.

use glam::DVec2;

use super::field::{DEAD, Field};
use crate::geometry::point_index::PointIndex;
use crate::growth::Metric;

/// Tiles along the side of a block.
const BLOCK: usize = 4;

/// Up to this many new nodes are measured one by one for each block; an index over them pays beyond:
/// 0.2 µs instead of 1 ns for each.
const FEW: usize = 256;

/// A new node, its place in the frame of the mature leaf and in that of the metric.
#[derive(Debug, Clone, Copy)]
struct Tip {
    at: DVec2,
    stretched: DVec2,
    number: u32,
}

/// The new node nearest to a source.
#[derive(Debug, Clone, Copy)]
pub(super) struct Found {
    /// Its place among the new nodes; the first among equals.
    pub(super) tip: usize,
    /// Squared distance.
    pub(super) distance2: f64,
    /// No other new node is nearer than this (squared).
    pub(super) others2: f64,
}

/// What is kept from step to step: memory only.
#[derive(Debug, Default)]
pub(super) struct Tiles {
    tips: Vec<Tip>,
    of_block: Vec<Tip>,
    of_tile: Vec<Tip>,
}

/// A part of the blade that asks which tips matter to what is in it.
struct Part {
    /// In the frame of the metric, as all that follows.
    middle: DVec2,
    half_diagonal: f64,
    /// No tip matters to anyone from this far (squared) on.
    bound2: f64,
    /// Whether the distances of all tips matter that are nearer than a bound, or only the nearest of
    /// each source.
    bounds_others: bool,
}

impl Part {
    /// How far from the middle a tip can matter, where the nearest lies as far as `nearest`: near
    /// enough to be nearer than what a member has and, seen from the middle, not a diagonal farther
    /// than the nearest of them. `None` when not even that is near enough.
    fn radius(&self, nearest: f64) -> Option<f64> {
        let near = self.bound2.sqrt() + self.half_diagonal;
        let radius = near.min(nearest + 2.0 * self.half_diagonal) * (1.0 + 1e-9);
        (nearest <= radius).then_some(radius)
    }

    /// Chooses the tips that may matter, in their order; the radius around the middle they lie in.
    fn choose(&self, tips: &[Tip], chosen: &mut Vec<Tip>) -> Option<f64> {
        let distance2 = |tip: &Tip| tip.stretched.distance_squared(self.middle);
        let nearest = tips
            .iter()
            .map(|tip| (distance2(tip), tip))
            .reduce(|a, b| if b.0 < a.0 { b } else { a })?;
        let radius = self.radius(nearest.0.sqrt())?;
        chosen.clear();
        let matters = |tip: &&Tip| {
            let tip2 = distance2(tip);
            tip2 <= radius * radius && self.is_not_outdone(tip, tip2, nearest)
        };
        chosen.extend(tips.iter().filter(matters));
        Some(radius)
    }

    /// The same for many tips.
    fn choose_by(&self, index: &PointIndex, tips: &[Tip], chosen: &mut Vec<Tip>) -> Option<f64> {
        let radius = self.radius(index.nearest_distance2(self.middle).sqrt())?;
        chosen.clear();
        index.for_each_within(self.middle, radius, |tip, _| chosen.push(tips[tip as usize]));
        chosen.sort_unstable_by_key(|tip| tip.number);
        let distance2 = |tip: &Tip| tip.stretched.distance_squared(self.middle);
        let nearest = chosen
            .iter()
            .map(|tip| (distance2(tip), *tip))
            .reduce(|a, b| if b.0 < a.0 { b } else { a })?;
        chosen.retain(|tip| self.is_not_outdone(tip, distance2(tip), (nearest.0, &nearest.1)));
        Some(radius)
    }

    /// Whether a tip may be nearer to some member than the one nearest to the middle is: else their
    /// bisector passes the members by.
    fn is_not_outdone(&self, tip: &Tip, tip2: f64, (nearest2, nearest): (f64, &Tip)) -> bool {
        // Less what rounding may do.
        let farther = tip2 * (1.0 - 1e-9) - nearest2;
        let apart2 = tip.stretched.distance_squared(nearest.stretched);
        let diagonal2 = self.half_diagonal * self.half_diagonal;
        self.bounds_others || farther <= 0.0 || farther * farther <= 4.0 * diagonal2 * apart2
    }
}

impl Tiles {
    /// Tells every source of the nearest of the new nodes `fresh`, wherever that may be nearer than
    /// the source's bound; `hear`, told the source's id, answers with the new bound. `bounds_others` says whether the bound is
    /// on the distance of all nodes but the nearest.
    pub(super) fn offer<S: Copy + Send + Sync>(
        &mut self,
        field: &mut Field<S>,
        fresh: &[DVec2],
        metric: Metric,
        bounds_others: bool,
        mut hear: impl FnMut(u32, &mut S, Found) -> f64,
    ) {
        if fresh.is_empty() {
            return;
        }
        let Self { tips, of_block, of_tile } = self;
        tips.clear();
        let tip = |(number, &at): (usize, &DVec2)| Tip {
            at,
            stretched: metric.place(at),
            number: number as u32,
        };
        tips.extend(fresh.iter().enumerate().map(tip));
        let index = (tips.len() > FEW).then(|| {
            let places: Vec<DVec2> = tips.iter().map(|tip| tip.stretched).collect();
            PointIndex::new(&places)
        });
        let is_plain = metric.is_plain() && !bounds_others;
        let (columns, rows, width) = field.cells();
        let part = |middle: DVec2, width: f64, bound2: f64| Part {
            middle: metric.place(middle),
            half_diagonal: metric.half_diagonal(middle, DVec2::splat(width / 2.0)),
            bound2,
            bounds_others,
        };
        for (first_row, first_column) in (0..rows)
            .step_by(BLOCK)
            .flat_map(|row| (0..columns).step_by(BLOCK).map(move |column| (row, column)))
        {
            // What is asked of each tile first, is asked of the block as a whole.
            let mut bounds2 = [[DEAD; BLOCK]; BLOCK];
            for (y, row) in (first_row..rows.min(first_row + BLOCK)).enumerate() {
                for (x, column) in (first_column..columns.min(first_column + BLOCK)).enumerate() {
                    bounds2[y][x] = field.bound2_of_cell(row, column);
                }
            }
            let bound2 = bounds2.iter().flatten().copied().fold(DEAD, f64::max);
            if bound2 == DEAD {
                continue;
            }
            let last = (first_row + BLOCK - 1, first_column + BLOCK - 1);
            let middle =
                (field.middle(first_row, first_column) + field.middle(last.0, last.1)) / 2.0;
            let block = part(middle, width * BLOCK as f64, bound2);
            let chosen = match &index {
                Some(index) => block.choose_by(index, tips, of_block),
                None => block.choose(tips, of_block),
            };
            if chosen.is_none() {
                continue;
            }
            for (at, &bound2) in bounds2.iter().flatten().enumerate() {
                if bound2 == DEAD {
                    continue;
                }
                let (row, column) = (first_row + at / BLOCK, first_column + at % BLOCK);
                let tile = part(field.middle(row, column), width, bound2);
                let Some(radius) = tile.choose(of_block, of_tile) else { continue };
                // A tip that is not among the chosen lies at least this far from every member.
                let beyond2 = (radius - tile.half_diagonal).max(0.0).powi(2);
                if is_plain {
                    let find = |p| nearest_only(of_tile, p);
                    field.tell_cell(row, column, find, &mut hear);
                } else {
                    let find = |p| nearest(of_tile, p, beyond2, metric);
                    field.tell_cell(row, column, find, &mut hear);
                }
            }
        }
        field.settle_news();
    }
}

/// The nearest of some tips, of which there is at least one, by plain distance and with nothing said of
/// the others. Apart from [`nearest`], for every source is asked in every step: 5 ns less of 30.
#[inline]
fn nearest_only(tips: &[Tip], p: DVec2) -> Option<Found> {
    let (first, rest) = tips.split_first()?;
    let (mut distance2, mut number) = (p.distance_squared(first.at), first.number);
    for tip in rest {
        let other2 = p.distance_squared(tip.at);
        // Both chosen without a jump: which tip is nearest cannot be foretold.
        let is_nearer = other2 < distance2;
        number = if is_nearer { tip.number } else { number };
        distance2 = if is_nearer { other2 } else { distance2 };
    }
    Some(Found { tip: number as usize, distance2, others2: f64::INFINITY })
}

/// The nearest of some tips.
fn nearest(tips: &[Tip], p: DVec2, beyond2: f64, metric: Metric) -> Option<Found> {
    let mut best = Found { tip: usize::MAX, distance2: f64::INFINITY, others2: beyond2 };
    for tip in tips {
        let distance2 = metric.distance_squared(p, tip.at);
        if distance2 < best.distance2 {
            best.others2 = best.others2.min(best.distance2);
            (best.distance2, best.tip) = (distance2, tip.number as usize);
        } else {
            best.others2 = best.others2.min(distance2);
        }
    }
    (best.tip != usize::MAX).then_some(best)
}
