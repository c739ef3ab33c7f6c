//! A static index over points: which lie within a radius of a place. The only file that names kiddo.
//!
//! kiddo's immutable tree is used with the Eytzinger layout and flat leaves of 16, the fastest of
//! its layouts for radius queries over 10⁴–10⁶ points. Radii are widened by rounding before they
//! reach the tree and every caller measures distances itself, so that no result depends on how the
//! tree rounds or on the order in which it finds points.

use kiddo::leaf_strategies::FlatVec;
use kiddo::{Eytzinger, KdTree, SquaredEuclidean};

use super::DVec2;

type Tree = KdTree<f64, u32, Eytzinger, FlatVec<f64, u32, 2, 16>, 2, 16>;

/// An index over points that stay where they are.
#[derive(Debug)]
pub struct PointIndex {
    tree: Option<Tree>,
}

impl PointIndex {
    /// An index over `points`, which are then known by their place in the slice.
    ///
    /// # Panics
    ///
    /// If a coordinate is not finite: the tree would give wrong neighbours without a word.
    #[must_use]
    pub fn new(points: &[DVec2]) -> Self {
        assert!(points.iter().all(|p| p.is_finite()), "an index needs finite points");
        if points.is_empty() {
            return Self { tree: None };
        }
        let rows: Vec<[f64; 2]> = points.iter().map(DVec2::to_array).collect();
        // Serial: a tree must not depend on the number of threads.
        let tree = Tree::builder().with_serial_construction().build_from_slice(&rows);
        Self { tree: Some(tree.expect("finite points can always be split into leaves")) }
    }

    /// Calls `visit` with every point within `radius` of `p`, bounds included, in no order, and its
    /// squared distance up to rounding; points a rounding error outside may come too.
    pub fn for_each_within(&self, p: DVec2, radius: f64, mut visit: impl FnMut(u32, f64)) {
        let Some(tree) = &self.tree else { return };
        let radius2 = radius * radius * (1.0 + 1e-12);
        tree.query(&p.to_array())
            .within::<SquaredEuclidean<f64>>(radius2)
            .unsorted()
            .visit(|hit| visit(hit.item, hit.distance));
    }

    /// The squared distance from `p` to the nearest point; infinite when there is none.
    #[must_use]
    pub fn nearest_distance2(&self, p: DVec2) -> f64 {
        let Some(tree) = &self.tree else { return f64::INFINITY };
        tree.query(&p.to_array()).nearest_one::<SquaredEuclidean<f64>>().execute().distance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn the_index_agrees_with_looking_at_every_point() {
        let mut rng = Seed(11).stream(Stage::Tissue);
        let mut points: Vec<DVec2> = (0..700).map(|_| DVec2::new(rng.unit(), rng.unit())).collect();
        // A straight midrib: many points with one coordinate in common.
        points.extend((0..100).map(|i| DVec2::new(0.5, f64::from(i) / 100.0)));
        let index = PointIndex::new(&points);
        for _ in 0..300 {
            let p = DVec2::new(rng.between(-0.2, 1.2), rng.between(-0.2, 1.2));
            let mut found = Vec::new();
            index.for_each_within(p, 0.2, |i, _| found.push(i));
            found.sort_unstable();
            let within = |i: &u32| points[*i as usize].distance(p) <= 0.2;
            assert_eq!(found, (0..points.len() as u32).filter(within).collect::<Vec<_>>());
            let nearest =
                points.iter().map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min);
            assert!((index.nearest_distance2(p) - nearest).abs() < 1e-15);
        }
    }

    #[test]
    fn nothing_is_found_among_no_points() {
        let index = PointIndex::new(&[]);
        index.for_each_within(DVec2::ZERO, 1e9, |_, _| panic!("found one"));
        assert_eq!(index.nearest_distance2(DVec2::ZERO), f64::INFINITY);
    }
}
