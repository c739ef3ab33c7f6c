//! The shortest way between two points of a simple polygon: its triangles from one to the other, and the
//! funnel of Lee and Preparata (*Euclidean shortest paths in the presence of rectilinear barriers*, 1984)
//! through their doors. There is only one, and it moves little when polygon and points do.

use std::collections::HashMap;

use super::polygon::{self, cross};
use super::{DVec2, triangulate};

/// The inside of a polygon, ready to be asked for many ways.
#[derive(Debug, Clone)]
pub struct Geodesics {
    corners: Vec<DVec2>,
    triangles: Vec<[u32; 3]>,
    /// By triangle, the one beyond the side from its corner k to the next.
    beyond: Vec<[Option<u32>; 3]>,
}

impl Geodesics {
    /// Of a simple anticlockwise polygon. O(n log n) as a rule.
    #[must_use]
    pub fn of(polygon: &[DVec2]) -> Self {
        let triangles = triangulate::connected(polygon);
        let mut sides = HashMap::new();
        for (t, corners) in triangles.iter().enumerate() {
            for k in 0..3 {
                sides.insert((corners[k], corners[(k + 1) % 3]), t as u32);
            }
        }
        let across =
            |corners: &[u32; 3], k: usize| sides.get(&(corners[(k + 1) % 3], corners[k])).copied();
        let beyond =
            triangles.iter().map(|corners| [0, 1, 2].map(|k| across(corners, k))).collect();
        Self { corners: polygon.to_vec(), triangles, beyond }
    }

    /// The corners of the way, both ends included; an end outside counts as the nearest place inside. `None`
    /// only where the polygon is none. O(n).
    #[must_use]
    pub fn way(&self, from: DVec2, to: DVec2) -> Option<Vec<DVec2>> {
        let ((from, starts), (to, ends)) = (self.place(from)?, self.place(to)?);
        // An end on a door needs not go through it: of the triangles around, the nearest.
        let between = starts.iter().flat_map(|&start| ends.iter().map(move |&end| (start, end)));
        let doors = between.filter_map(|(start, end)| self.doors(start, end));
        Some(funnel(from, to, &doors.min_by_key(Vec::len)?))
    }

    fn corner(&self, t: u32, k: usize) -> DVec2 {
        self.corners[self.triangles[t as usize][k % 3] as usize]
    }

    /// The place nearest to `p`, and the triangles it is of; by rounding a point on a side can lie outside
    /// both beside it.
    fn place(&self, p: DVec2) -> Option<(DVec2, Vec<u32>)> {
        let side = |t: u32, k: usize| (self.corner(t, k), self.corner(t, k + 1));
        let within = |t: &u32| {
            let has_area = cross(self.corner(*t, 0), self.corner(*t, 1), self.corner(*t, 2)) > 0.0;
            let is_left = |k: usize| {
                let (a, b) = side(*t, k);
                cross(a, b, p) >= -1e-12 * a.distance_squared(b)
            };
            has_area && (0..3).all(is_left)
        };
        let triangles = 0..self.triangles.len() as u32;
        let around: Vec<u32> = triangles.clone().filter(within).collect();
        if !around.is_empty() {
            return Some((p, around));
        }
        let sides = triangles.flat_map(|t| (0..3).map(move |k| (side(t, k), t)));
        let feet = sides.map(|((a, b), t)| (polygon::nearest_on_segment(a, b, p), t));
        let nearest =
            feet.min_by(|a, b| a.0.distance_squared(p).total_cmp(&b.0.distance_squared(p)));
        nearest.map(|(foot, t)| (foot, vec![t]))
    }

    /// The sides between triangles on the way from one to another, each as its left and right corner.
    fn doors(&self, from: u32, to: u32) -> Option<Vec<[DVec2; 2]>> {
        // Triangles of a simple polygon are a tree: there is one way.
        let mut came: Vec<Option<(u32, usize)>> = vec![None; self.triangles.len()];
        let mut open = vec![from];
        while let Some(t) = open.pop() {
            if t == to {
                break;
            }
            for k in 0..3 {
                let Some(next) = self.beyond[t as usize][k] else { continue };
                if next != from && came[next as usize].is_none() {
                    came[next as usize] = Some((t, k));
                    open.push(next);
                }
            }
        }
        let mut doors = Vec::new();
        let mut t = to;
        while t != from {
            let (before, k) = came[t as usize]?;
            // Who leaves an anticlockwise triangle through a side has its first corner on the right.
            doors.push([self.corner(before, k + 1), self.corner(before, k)]);
            t = before;
        }
        doors.reverse();
        Some(doors)
    }
}

/// Pulls a way through doors (left, right) tight.
fn funnel(from: DVec2, to: DVec2, doors: &[[DVec2; 2]]) -> Vec<DVec2> {
    let mut doors = doors.to_vec();
    doors.push([to, to]);
    let mut way = vec![from];
    let mut apex = from;
    // The sides of the funnel: the corner, and the door it is of.
    let (mut left, mut right) = ((from, 0), (from, 0));
    let mut i = 0;
    while i < doors.len() {
        let [l, r] = doors[i];
        if cross(apex, right.0, r) >= 0.0 {
            if apex == right.0 || cross(apex, left.0, r) < 0.0 {
                right = (r, i);
            } else {
                // Right of it crosses left of it: the way bends round the left corner.
                way.push(left.0);
                apex = left.0;
                i = left.1 + 1;
                (left, right) = ((apex, i), (apex, i));
                continue;
            }
        }
        if cross(apex, left.0, l) <= 0.0 {
            if apex == left.0 || cross(apex, right.0, l) > 0.0 {
                left = (l, i);
            } else {
                way.push(right.0);
                apex = right.0;
                i = right.1 + 1;
                (left, right) = ((apex, i), (apex, i));
                continue;
            }
        }
        i += 1;
    }
    way.push(to);
    way.dedup();
    way
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn length(way: &[DVec2]) -> f64 {
        way.windows(2).map(|w| w[0].distance(w[1])).sum()
    }

    /// A star: concave between its arms.
    fn star(radii: &[f64]) -> Vec<DVec2> {
        let turn = std::f64::consts::TAU / radii.len() as f64;
        radii.iter().enumerate().map(|(i, r)| DVec2::from_angle(i as f64 * turn) * *r).collect()
    }

    /// By all corners that see each other.
    fn slow(polygon: &[DVec2], from: DVec2, to: DVec2) -> f64 {
        let mut places = vec![from, to];
        places.extend(polygon);
        let sees = |a: DVec2, b: DVec2| {
            if polygon::edges(polygon).any(|edge| edge == (a, b) || edge == (b, a)) {
                return true;
            }
            let inside = (1..40).all(|k| {
                let p = a.lerp(b, f64::from(k) / 40.0);
                let on_it = polygon::edges(polygon)
                    .any(|(c, d)| polygon::nearest_on_segment(c, d, p).distance(p) < 1e-9);
                on_it || polygon::contains(polygon, p)
            });
            let short = [a.lerp(b, 1e-6), b.lerp(a, 1e-6)];
            let crosses = |(c, d): (DVec2, DVec2)| {
                let apart = cross(c, d, short[0]) * cross(c, d, short[1]) < 0.0;
                apart && cross(short[0], short[1], c) * cross(short[0], short[1], d) < 0.0
            };
            inside && !polygon::edges(polygon).any(crosses)
        };
        let n = places.len();
        let mut best = vec![f64::INFINITY; n];
        best[0] = 0.0;
        for _ in 0..n {
            for i in 0..n {
                for j in 0..n {
                    let through = best[i] + places[i].distance(places[j]);
                    if through < best[j] && sees(places[i], places[j]) {
                        best[j] = through;
                    }
                }
            }
        }
        best[1]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        #[test]
        fn no_way_is_shorter(
            radii in prop::collection::vec(0.25..2.0f64, 5..14),
            from in 0usize..14,
            to in 0usize..14,
            out in (0.1..0.95f64, 0.1..0.95f64),
        ) {
            let polygon = star(&radii);
            let n = polygon.len();
            let (a, b) = (polygon[from % n] * out.0, polygon[to % n] * out.1);
            let way = Geodesics::of(&polygon).way(a, b).expect("both lie inside");
            prop_assert_eq!((way[0], way[way.len() - 1]), (a, b));
            prop_assert!((length(&way) - slow(&polygon, a, b)).abs() < 1e-6);
            for w in way.windows(2) {
                let middle = w[0].midpoint(w[1]);
                prop_assert!(polygon::contains(&polygon, middle.lerp(DVec2::ZERO, 1e-6)));
            }
        }
    }

    #[test]
    fn who_sees_the_end_goes_straight_and_outside_is_the_nearest_place_inside() {
        let polygon = star(&[2.0, 0.5, 2.0, 0.5, 2.0, 0.5]);
        let geodesics = Geodesics::of(&polygon);
        let (a, b) = (DVec2::new(0.1, 0.1), DVec2::new(1.5, 0.0));
        assert_eq!(geodesics.way(a, b), Some(vec![a, b]));
        assert_eq!(geodesics.way(a, DVec2::new(2.5, 0.0)), Some(vec![a, polygon[0]]));
        assert_eq!(Geodesics::of(&[]).way(a, b), None);
    }
}
