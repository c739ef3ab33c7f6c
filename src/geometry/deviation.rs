//! How far two lines lie apart, from the points of each to the other.

use super::polygon::nearest_on_segment;
use super::segments::SegmentIndex;
use super::{DVec2, Rect};

/// Distances from points to a line, as quantiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distances {
    /// Half of the points are nearer.
    pub median: f64,
    /// Three quarters of the points are nearer.
    pub upper_quartile: f64,
    /// No point is farther.
    pub max: f64,
}

impl Distances {
    /// Of a list of distances.
    ///
    /// # Panics
    ///
    /// If the list is empty.
    #[must_use]
    pub fn of(mut distances: Vec<f64>) -> Self {
        distances.sort_unstable_by(f64::total_cmp);
        let last = distances.len() - 1;
        let at = |share: f64| distances[(share * last as f64).round() as usize];
        Self { median: at(0.5), upper_quartile: at(0.75), max: at(1.0) }
    }

    /// The same in another unit.
    #[must_use]
    pub fn scaled(&self, by: f64) -> Self {
        Self {
            median: self.median * by,
            upper_quartile: self.upper_quartile * by,
            max: self.max * by,
        }
    }
}

/// The distance from each point of `from` to the boundary of the polygon `to`.
#[must_use]
pub fn to_polygon(from: &[DVec2], to: &[DVec2]) -> Vec<f64> {
    let index = SegmentIndex::of_polygon(to);
    let both = Rect::around(from.iter().chain(to).copied());
    let reach = both.size().length() + f64::MIN_POSITIVE;
    from.iter()
        .map(|&p| index.nearest(p, reach).map_or(reach, |(squared, _)| squared.sqrt()))
        .collect()
}

/// The squared distance from `p` to an open line. For short lines.
#[must_use]
pub fn squared_to_line(p: DVec2, line: &[DVec2]) -> f64 {
    line.windows(2)
        .map(|s| nearest_on_segment(s[0], s[1], p).distance_squared(p))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_in_a_square_is_a_step_away_on_both_sides_but_at_its_corners() {
        let square = |half: f64| {
            [(-half, -half), (half, -half), (half, half), (-half, half)].map(DVec2::from)
        };
        let (inner, outer) = (square(1.0), square(2.0));
        let outwards = to_polygon(&super::super::polygon::resampled(&inner, 0.1), &outer);
        assert!(outwards.iter().all(|d| (d - 1.0).abs() < 1e-12));
        let inwards = Distances::of(to_polygon(&outer, &inner));
        assert!((inwards.max - 2f64.sqrt()).abs() < 1e-12);
        assert_eq!(inwards.scaled(0.5).max, inwards.max * 0.5);
    }

    #[test]
    fn quantiles_of_a_count() {
        let distances = Distances::of((0..101).rev().map(f64::from).collect());
        assert_eq!(
            (distances.median, distances.upper_quartile, distances.max),
            (50.0, 75.0, 100.0)
        );
    }
}
