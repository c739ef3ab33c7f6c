//! The curve through landmarks with tangents, of which every margin is made.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! section 5.3.1. A quadratic B-spline through landmarks pᵢ with unit tangents tᵢ; the knots are the
//! cumulative chord lengths and the means of neighbours (5.9, 5.10). Its control points (5.15 for
//! three landmarks, 5.20 for four) follow one rule for any number: beside each landmark stand
//! pᵢ ± α tᵢ Δu/4, Δu being the parameter interval on that side. With α = D, the total chord length
//! (times `tension`), α Δu is the length of the chord there: D drops out, and the curve is local.
//!
//! Between two landmarks the curve is two parabolas that meet halfway between the two control points,
//! because the knot there is the mean of its neighbours; [`append`] draws these without the spline.

use glam::DVec2;

use crate::geometry::bspline::QuadraticBSpline;

/// A point the margin passes through, and its direction there (unit).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// The point, relative to the primary vein.
    pub at: DVec2,
    /// The direction of the margin, towards the next waypoint.
    pub towards: DVec2,
}

/// How far a polygon may stray from its curve, in lengths of the primary vein: a sixth of a texel on
/// a blade 8192 texels long.
pub const TOLERANCE: f64 = 2e-5;

/// The two control points between neighbouring waypoints.
fn between(a: &Waypoint, b: &Waypoint, tension: f64) -> (DVec2, DVec2) {
    let reach = a.at.distance(b.at) * tension / 4.0;
    (a.at + a.towards * reach, b.at - b.towards * reach)
}

/// The spline through two waypoints or more.
///
/// # Panics
///
/// With fewer than two: makers of margins always have both ends.
#[must_use]
pub fn spline(waypoints: &[Waypoint], tension: f64) -> QuadraticBSpline {
    let pairs = || waypoints.windows(2).map(|pair| (&pair[0], &pair[1]));
    let total: f64 = pairs().map(|(a, b)| a.at.distance(b.at)).sum();
    let (mut control, mut knots) = (vec![waypoints[0].at], vec![0.0; 3]);
    let mut u = 0.0;
    for (a, b) in pairs() {
        let (leaving, arriving) = between(a, b, tension);
        control.extend([leaving, arriving]);
        let step = a.at.distance(b.at) / total;
        if u > 0.0 {
            knots.push(u);
        }
        knots.push(u + step / 2.0);
        u += step;
    }
    control.push(waypoints[waypoints.len() - 1].at);
    knots.extend([1.0; 3]);
    QuadraticBSpline::new(knots, control)
}

/// The spline as quadratic Bézier curves, from end to end.
pub fn parabolas(waypoints: &[Waypoint], tension: f64) -> impl Iterator<Item = [DVec2; 3]> + '_ {
    waypoints.windows(2).flat_map(move |pair| {
        let (leaving, arriving) = between(&pair[0], &pair[1], tension);
        let middle = (leaving + arriving) * 0.5;
        [[pair[0].at, leaving, middle], [middle, arriving, pair[1].at]]
    })
}

/// Adds the spline as points that stay within [`TOLERANCE`] of it, without its first point.
pub fn append(points: &mut Vec<DVec2>, waypoints: &[Waypoint], tension: f64) {
    parabolas(waypoints, tension).for_each(|span| parabola(points, span));
}

/// The same from the last waypoint to the first, without the last: the way down.
pub fn append_reversed(points: &mut Vec<DVec2>, waypoints: &[Waypoint], tension: f64) {
    for pair in waypoints.windows(2).rev() {
        let (leaving, arriving) = between(&pair[0], &pair[1], tension);
        let middle = (leaving + arriving) * 0.5;
        parabola(points, [pair[1].at, arriving, middle]);
        parabola(points, [middle, leaving, pair[0].at]);
    }
}

/// Adds a quadratic Bézier curve, without its first point.
fn parabola(points: &mut Vec<DVec2>, [a, b, c]: [DVec2; 3]) {
    // A chord over 1/n of it is off by |a − 2b + c| / (4 n²) at most.
    let second = a - 2.0 * b + c;
    let pieces = (second.length() / (4.0 * TOLERANCE)).sqrt().ceil().max(1.0);
    let first = (b - a) * 2.0;
    let step = 1.0 / pieces;
    points.extend((1..pieces as usize).map(|i| {
        let s = i as f64 * step;
        a + (first + second * s) * s
    }));
    points.push(c);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waypoints() -> Vec<Waypoint> {
        [
            ((0.0, 0.0), (0.9, 0.1)),
            ((0.2, -0.1), (1.0, 0.0)),
            ((0.4, 0.3), (0.0, 1.0)),
            ((0.0, 1.0), (-0.6, 0.8)),
        ]
        .map(|(at, towards)| Waypoint { at: at.into(), towards: DVec2::from(towards).normalize() })
        .to_vec()
    }

    #[test]
    fn control_points_of_three_waypoints_follow_equation_5_15() {
        let list = waypoints();
        let marks = [list[0], list[2], list[3]];
        let spline = spline(&marks, 1.0);
        let [(p1, t1), (p2, t2), (p3, t3)] = marks.map(|w| (w.at, w.towards));
        let d = p1.distance(p2) + p2.distance(p3);
        let u2 = p1.distance(p2) / d;
        let expected = [
            p1,
            p1 + d * t1 * (u2 / 4.0),
            p2 - d * t2 * (u2 / 4.0),
            p2 + d * t2 * ((1.0 - u2) / 4.0),
            p3 - d * t3 * ((1.0 - u2) / 4.0),
            p3,
        ];
        for (q, e) in spline.control().iter().zip(expected) {
            assert!(q.distance(e) < 1e-14, "{q} {e}");
        }
    }

    #[test]
    fn control_points_of_four_waypoints_follow_equation_5_20() {
        let list = waypoints();
        let spline = spline(&list, 1.0);
        let [(p1, t1), (p2, t2), (p3, t3), (p4, t4)] =
            [0, 1, 2, 3].map(|i| (list[i].at, list[i].towards));
        let (d1, d2) = (p1.distance(p2), p2.distance(p3));
        let d = d1 + d2 + p3.distance(p4);
        // u₃ in 5.16 is cumulative, as in 5.9.
        let (u2, u3) = (d1 / d, (d1 + d2) / d);
        let expected = [
            p1,
            p1 + d * t1 * (u2 / 4.0),
            p2 - d * t2 * (u2 / 4.0),
            p2 + d * t2 * ((u3 - u2) / 4.0),
            p3 - d * t3 * ((u3 - u2) / 4.0),
            p3 + d * t3 * ((1.0 - u3) / 4.0),
            p4 - d * t4 * ((1.0 - u3) / 4.0),
            p4,
        ];
        for (q, e) in spline.control().iter().zip(expected) {
            assert!(q.distance(e) < 1e-14, "{q} {e}");
        }
    }

    #[test]
    fn the_curve_passes_through_every_waypoint_with_its_tangent() {
        for tension in [1.0, 0.5] {
            for count in 2..=4 {
                let list = &waypoints()[..count];
                let spline = spline(list, tension);
                let chord = |pair: &[Waypoint]| pair[0].at.distance(pair[1].at);
                let total: f64 = list.windows(2).map(chord).sum();
                let mut u = 0.0;
                for (i, w) in list.iter().enumerate() {
                    assert!(spline.at(u).distance(w.at) < 1e-12, "waypoint {i}");
                    let direction = (spline.at(u + 1e-6) - spline.at(u - 1e-6)).normalize();
                    assert!(direction.dot(w.towards) > 1.0 - 1e-5, "tangent {i}: {direction}");
                    u += list.get(i + 1).map_or(0.0, |next| w.at.distance(next.at) / total);
                }
            }
        }
    }

    #[test]
    fn what_is_drawn_is_the_spline() {
        for count in 2..=4 {
            let list = &waypoints()[..count];
            let spline = spline(list, 0.8);
            let mut points = vec![list[0].at];
            append(&mut points, list, 0.8);
            let slow = spline.flattened(TOLERANCE);
            assert_eq!(points.len(), slow.len());
            for (p, q) in points.iter().zip(slow) {
                assert!(p.distance(q) < 1e-12, "{p} {q}");
            }
        }
    }
}
