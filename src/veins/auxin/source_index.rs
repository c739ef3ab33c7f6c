//! An index of the sources that keeps up with births and deaths.

use glam::DVec2;

use crate::geometry::point_index::PointIndex;

/// Newborn sources stand in a plain list until there are this many, or a quarter of the index.
const NEWBORN: usize = 64;

/// The index is built anew when less than this share of it is alive: every search also finds the
/// dead. Building takes about as long as one search in ten finds.
const THINNED: f64 = 0.5;

/// Which sources lie within a radius of a place.
#[derive(Debug)]
pub(super) struct SourceIndex {
    index: PointIndex,
    /// The source of each point of the index.
    indexed: Vec<u32>,
    /// The first source that is not in the index.
    unindexed: usize,
}

impl SourceIndex {
    pub(super) fn new() -> Self {
        Self { index: PointIndex::new(&[]), indexed: Vec::new(), unindexed: 0 }
    }

    /// Builds the index anew once enough sources were born or died since.
    pub(super) fn keep(
        &mut self,
        positions: &[DVec2],
        living: usize,
        is_alive: impl Fn(usize) -> bool,
    ) {
        let outside = positions.len() - self.unindexed;
        let grown = outside > NEWBORN.max(self.indexed.len() / 4);
        let inside = living.saturating_sub(outside) as f64;
        if !grown && inside >= THINNED * self.indexed.len() as f64 {
            return;
        }
        self.indexed = (0..positions.len() as u32).filter(|i| is_alive(*i as usize)).collect();
        let points: Vec<DVec2> = self.indexed.iter().map(|&i| positions[i as usize]).collect();
        self.index = PointIndex::new(&points);
        self.unindexed = positions.len();
    }

    /// Calls `visit` with every source within `radius` of `p` (up to rounding), its squared distance
    /// up to rounding, and with all newborn ones, at no distance.
    pub(super) fn for_each_within(
        &self,
        p: DVec2,
        radius: f64,
        sources: usize,
        mut visit: impl FnMut(u32, f64),
    ) {
        let indexed = &self.indexed;
        self.index.for_each_within(p, radius, |point, about2| {
            visit(indexed[point as usize], about2);
        });
        (self.unindexed as u32..sources as u32).for_each(|source| visit(source, 0.0));
    }
}
