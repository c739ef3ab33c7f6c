//! Attraction without a reach: whole tiles of sources are passed over when no new node can be nearer
//! to any of them than what it has.
//!
//! Without a reach every source acts from the first step on, and asking each in every step whether
//! one of the new nodes is nearer costs O(sources · new nodes). Most new nodes are far from most
//! sources: which of them matter is asked first for blocks of some thousand sources, then for tiles
//! of sixteen, and the few that are left are measured from each.

use glam::DVec2;

use super::field::{DEAD, Field, Hit, Told};
use crate::geometry::point_index::PointIndex;
use crate::growth::Metric;

/// Tiles along the side of a block.
const BLOCK: usize = 8;

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
    members: Vec<u32>,
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
        chosen.extend(tips.iter().filter(|tip| distance2(tip) <= radius * radius));
        self.drop_the_outdone(nearest.1.stretched, chosen);
        Some(radius)
    }

    /// The same for many tips.
    fn choose_by(&self, index: &PointIndex, tips: &[Tip], chosen: &mut Vec<Tip>) -> Option<f64> {
        let radius = self.radius(index.nearest_distance2(self.middle).sqrt())?;
        chosen.clear();
        index.for_each_within(self.middle, radius, |tip, _| chosen.push(tips[tip as usize]));
        chosen.sort_unstable_by_key(|tip| tip.number);
        let distance2 = |tip: &&Tip| tip.stretched.distance_squared(self.middle);
        let nearest = chosen.iter().min_by(|a, b| distance2(a).total_cmp(&distance2(b)));
        let nearest = nearest.map(|tip| tip.stretched);
        if let Some(nearest) = nearest {
            self.drop_the_outdone(nearest, chosen);
        }
        Some(radius)
    }

    /// Drops the tips than which the one nearest to the middle is nearer to every member: their
    /// bisector passes by.
    fn drop_the_outdone(&self, nearest: DVec2, chosen: &mut Vec<Tip>) {
        if self.bounds_others {
            return;
        }
        let nearest2 = nearest.distance_squared(self.middle);
        chosen.retain(|tip| {
            let tip2 = tip.stretched.distance_squared(self.middle);
            let apart = tip.stretched.distance(nearest);
            // Less what rounding may do.
            tip2 * (1.0 - 1e-9) - nearest2 <= 2.0 * self.half_diagonal * apart
        });
    }
}

impl Tiles {
    /// Tells every source of the nearest of the new nodes `fresh`, wherever that may be nearer than
    /// the source's bound; `hear` answers with the new bound. `bounds_others` says whether the bound is
    /// on the distance of all nodes but the nearest.
    pub(super) fn offer<S>(
        &mut self,
        field: &mut Field<S>,
        fresh: &[DVec2],
        metric: Metric,
        bounds_others: bool,
        hear: impl Fn(&mut S, Found) -> f64,
    ) {
        if fresh.is_empty() {
            return;
        }
        let Self { tips, of_block, of_tile, members } = self;
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
                members.clear();
                field.members(row, column, members);
                for &slot in members.iter() {
                    let Some(found) = nearest(of_tile, field.place(slot as usize), beyond2, metric)
                    else {
                        continue;
                    };
                    let node = found.tip as u32;
                    let hit = Hit { slot, node, distance2: found.distance2 };
                    field.tell(hit, |_, _, state| Told {
                        bound2: hear(state, found),
                        is_marked: false,
                    });
                }
            }
        }
    }
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
