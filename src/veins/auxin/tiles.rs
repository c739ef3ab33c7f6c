//! Sources by place, for attraction without a reach: whole tiles are passed over when no new node
//! can be nearer to any of their sources than what that has.
//!
//! Without a reach every source acts from the first step on, and asking each in every step whether
//! one of the new nodes is nearer costs O(sources · steps). Most new nodes are far from most sources:
//! two questions for each tile of some sixteen sources answer for all of them.

use glam::DVec2;

use crate::geometry::Rect;
use crate::geometry::point_index::PointIndex;
use crate::growth::Metric;

/// Sources in a tile, about: fewer make more questions, more make the answers vaguer.
const IN_A_TILE: f64 = 16.0;

/// Tiles are cut anew when the number of sources has changed by this factor.
const DRIFT: usize = 3;

/// Up to this many new nodes are measured one by one; an index over them pays beyond.
const FEW: usize = 24;

/// Sources in square tiles.
#[derive(Debug)]
pub(super) struct Tiles {
    bounds: Rect,
    side: f64,
    columns: usize,
    members: Vec<Vec<u32>>,
    /// For each tile, no member can be taken over from this far (squared) or farther.
    bound2: Vec<f64>,
    /// Sources when the tiles were cut.
    cut_for: usize,
}

impl Tiles {
    pub(super) fn new(bounds: Rect) -> Self {
        let mut tiles =
            Self { bounds, side: 1.0, columns: 1, members: vec![], bound2: vec![], cut_for: 0 };
        tiles.cut(&[], &[]);
        tiles
    }

    /// Puts sources into tiles of a size that suits their number.
    fn cut(&mut self, living: &[u32], positions: &[DVec2]) {
        let size = self.bounds.size();
        let wanted = (living.len() as f64 / IN_A_TILE).max(1.0);
        self.side = (size.x * size.y / wanted).sqrt();
        self.columns = (size.x / self.side) as usize + 1;
        let rows = (size.y / self.side) as usize + 1;
        self.members = vec![Vec::new(); self.columns * rows];
        self.bound2 = vec![0.0; self.members.len()];
        for &source in living {
            self.push(source, positions[source as usize]);
        }
        self.cut_for = living.len();
    }

    fn tile(&self, p: DVec2) -> usize {
        let place = ((p - self.bounds.min) / self.side).max(DVec2::ZERO);
        let column = (place.x as usize).min(self.columns - 1);
        let rows = self.members.len() / self.columns;
        (place.y as usize).min(rows - 1) * self.columns + column
    }

    pub(super) fn push(&mut self, source: u32, p: DVec2) {
        let tile = self.tile(p);
        self.members[tile].push(source);
    }

    /// Begins a step: bounds are to be raised anew by the living sources.
    pub(super) fn begin(&mut self, living: &[u32], positions: &[DVec2]) {
        let (now, then) = (living.len(), self.cut_for);
        if now > DRIFT * then.max(IN_A_TILE as usize) || now * DRIFT < then {
            self.cut(living, positions);
        }
        self.bound2.fill(0.0);
    }

    /// A source at `p` can be taken over from nearer than this (squared).
    pub(super) fn raise(&mut self, p: DVec2, bound2: f64) {
        let tile = self.tile(p);
        self.bound2[tile] = self.bound2[tile].max(bound2);
    }

    /// Calls `offer` with each source and the place in `tips` of the nearest of them (the first
    /// among equals), wherever that may be nearer than the bound; a source for which it answers
    /// `false` is dead and forgotten.
    pub(super) fn offer(
        &mut self,
        tips: &[DVec2],
        positions: &[DVec2],
        metric: Metric,
        mut offer: impl FnMut(u32, u32) -> bool,
    ) {
        let stretched: Vec<DVec2> = tips.iter().map(|p| metric.place(*p)).collect();
        let index = (tips.len() > FEW).then(|| PointIndex::new(&stretched));
        let half = DVec2::splat(self.side / 2.0);
        let mut candidates: Vec<u32> = Vec::new();
        for (tile, members) in self.members.iter_mut().enumerate() {
            if members.is_empty() || self.bound2[tile] == 0.0 {
                continue;
            }
            // The new nodes that matter to anyone in the tile: near enough to be nearer than what a
            // member has, and, seen from the centre, not a diagonal farther than the nearest of them.
            let corner = DVec2::new((tile % self.columns) as f64, (tile / self.columns) as f64);
            let centre = self.bounds.min + corner * self.side + half;
            let half_diagonal = metric.half_diagonal(centre, half);
            let centre = metric.place(centre);
            let distance2 = |tip: u32| stretched[tip as usize].distance_squared(centre);
            let nearest2 = match &index {
                Some(index) => index.nearest_distance2(centre),
                None => (0..tips.len() as u32).map(distance2).fold(f64::INFINITY, f64::min),
            };
            let radius = (self.bound2[tile].sqrt() + half_diagonal)
                .min(nearest2.sqrt() + 2.0 * half_diagonal)
                * (1.0 + 1e-9);
            if nearest2 > radius * radius {
                continue;
            }
            candidates.clear();
            if let Some(index) = &index {
                index.for_each_within(centre, radius, |tip, _| candidates.push(tip));
                candidates.sort_unstable();
            } else {
                let near = |tip: &u32| distance2(*tip) <= radius * radius;
                candidates.extend((0..tips.len() as u32).filter(near));
            }
            members.retain(|&source| {
                let p = positions[source as usize];
                let tip = nearest_of(&candidates, tips, p, metric);
                tip.is_none_or(|tip| offer(source, tip))
            });
        }
    }
}

/// The nearest of some tips, the first among equals.
fn nearest_of(candidates: &[u32], tips: &[DVec2], p: DVec2, metric: Metric) -> Option<u32> {
    let mut best = (f64::INFINITY, None);
    for &tip in candidates {
        let distance2 = metric.distance_squared(p, tips[tip as usize]);
        if distance2 < best.0 {
            best = (distance2, Some(tip));
        }
    }
    best.1
}
