//! An index of the sources that keeps up with births and deaths.

use glam::DVec2;

use crate::geometry::point_index::PointIndex;

/// Newborn sources stand in a plain list until there are this many, or a quarter of the index.
const NEWBORN: usize = 64;

/// The index is built anew when less than this share of it is alive: every search also finds the
/// dead. Building takes about as long as one search in ten finds.
const THINNED: f64 = 0.5;

/// Which sources lie within a radius of a place. They are known by their order.
#[derive(Debug)]
pub(super) struct SourceIndex {
    index: PointIndex,
    /// How many are in the index.
    indexed: usize,
    /// How many there are.
    len: usize,
}

impl SourceIndex {
    pub(super) fn new() -> Self {
        Self { index: PointIndex::new(&[]), indexed: 0, len: 0 }
    }

    /// Takes note of a source at the end.
    pub(super) fn push(&mut self) {
        self.len += 1;
    }

    /// Whether so many were born or died that it should be built anew.
    pub(super) fn is_stale(&self, living: usize) -> bool {
        let newborn = self.len - self.indexed;
        let inside = living.saturating_sub(newborn) as f64;
        newborn > NEWBORN.max(self.indexed / 4) || inside < THINNED * self.indexed as f64
    }

    /// Builds it over these sources.
    pub(super) fn build(&mut self, places: impl Iterator<Item = DVec2>) {
        let places: Vec<DVec2> = places.collect();
        self.index = PointIndex::new(&places);
        (self.indexed, self.len) = (places.len(), places.len());
    }

    /// Calls `visit` with every source within `radius` of `p` (up to rounding), its squared distance
    /// up to rounding, and with all newborn ones, at no distance.
    pub(super) fn for_each_within(&self, p: DVec2, radius: f64, mut visit: impl FnMut(u32, f64)) {
        self.index.for_each_within(p, radius, &mut visit);
        (self.indexed as u32..self.len as u32).for_each(|source| visit(source, 0.0));
    }
}
