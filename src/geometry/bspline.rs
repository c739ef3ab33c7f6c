//! Clamped quadratic B-splines: evaluate, flatten to a tolerance.
//!
//! Each span between two knots is a quadratic Bézier curve, whose middle control point is the
//! spline's own; its ends lie on the control polygon in the ratio of the knots (Boehm's insertion,
//! done once per span).

use super::DVec2;

/// A clamped quadratic B-spline.
///
/// # Guarantees
///
/// - Three more knots than control points; knots do not decrease.
/// - It starts at the first control point and ends at the last.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticBSpline {
    knots: Vec<f64>,
    control: Vec<DVec2>,
}

impl QuadraticBSpline {
    /// A spline over a full knot vector (ends threefold).
    ///
    /// # Panics
    ///
    /// If the knots break the guarantees: they come from code, never from a user.
    #[must_use]
    pub fn new(knots: Vec<f64>, control: Vec<DVec2>) -> Self {
        let n = control.len();
        assert!(n >= 3 && knots.len() == n + 3, "{} knots for {n} control points", knots.len());
        assert!(knots.windows(2).all(|pair| pair[0] <= pair[1]), "knots decrease: {knots:?}");
        assert!(knots[0] == knots[2] && knots[n] == knots[n + 2], "ends are not threefold");
        Self { knots, control }
    }

    /// The control points.
    #[must_use]
    pub fn control(&self) -> &[DVec2] {
        &self.control
    }

    /// The spans as Bézier curves, with the parameter at both ends.
    pub fn spans(&self) -> impl Iterator<Item = (f64, f64, [DVec2; 3])> + '_ {
        let (t, q) = (&self.knots, &self.control);
        (2..q.len()).filter(|&i| t[i] < t[i + 1]).map(move |i| {
            let start = q[i - 2].lerp(q[i - 1], ratio(t[i - 1], t[i], t[i + 1]));
            let end = q[i - 1].lerp(q[i], ratio(t[i], t[i + 1], t[i + 2]));
            (t[i], t[i + 1], [start, q[i - 1], end])
        })
    }

    /// The point at parameter `u`, clamped to the knots' interval.
    #[must_use]
    pub fn at(&self, u: f64) -> DVec2 {
        let mut last = self.control[0];
        for (start, end, [a, b, c]) in self.spans() {
            if u < end {
                let s = ((u - start) / (end - start)).max(0.0);
                return a.lerp(b, s).lerp(b.lerp(c, s), s);
            }
            last = c;
        }
        last
    }

    /// A polyline from end to end that stays within `tolerance` of the curve.
    #[must_use]
    pub fn flattened(&self, tolerance: f64) -> Vec<DVec2> {
        let mut points = vec![self.control[0]];
        for (_, _, [a, b, c]) in self.spans() {
            // A chord over 1/n of a parabola is off by |a - 2b + c| / (4 n²) at most.
            let bulge = (a - 2.0 * b + c).length();
            let pieces = (bulge / (4.0 * tolerance)).sqrt().ceil().max(1.0) as usize;
            points.extend((1..=pieces).map(|i| {
                let s = i as f64 / pieces as f64;
                a.lerp(b, s).lerp(b.lerp(c, s), s)
            }));
        }
        points
    }
}

/// Where `x` lies between `low` and `high`; 0 when they coincide.
fn ratio(low: f64, x: f64, high: f64) -> f64 {
    if high > low { (x - low) / (high - low) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spline() -> QuadraticBSpline {
        let control =
            [(0.0, 0.0), (1.0, 0.0), (2.0, 2.0), (0.0, 3.0), (-1.0, 1.0)].map(DVec2::from);
        QuadraticBSpline::new(vec![0.0, 0.0, 0.0, 0.3, 0.7, 1.0, 1.0, 1.0], control.to_vec())
    }

    /// Cox–de Boor, straight from the definition (Garg 5.2, 5.3).
    fn basis(i: usize, degree: usize, u: f64, knots: &[f64]) -> f64 {
        if degree == 0 {
            return f64::from(u8::from(knots[i] <= u && u < knots[i + 1]));
        }
        let part = |numerator: f64, denominator: f64| {
            if denominator == 0.0 { 0.0 } else { numerator / denominator }
        };
        part(u - knots[i], knots[i + degree] - knots[i]) * basis(i, degree - 1, u, knots)
            + part(knots[i + degree + 1] - u, knots[i + degree + 1] - knots[i + 1])
                * basis(i + 1, degree - 1, u, knots)
    }

    #[test]
    fn evaluation_agrees_with_the_definition() {
        let spline = spline();
        for k in 0..100 {
            let u = f64::from(k) / 100.0;
            let sum: DVec2 =
                (0..5).map(|i| spline.control[i] * basis(i, 2, u, &spline.knots)).sum();
            assert!(spline.at(u).distance(sum) < 1e-12, "at {u}");
        }
        assert_eq!(spline.at(1.0), spline.control[4]);
    }

    #[test]
    fn flattening_stays_within_its_tolerance() {
        let spline = spline();
        let line = spline.flattened(1e-3);
        for k in 0..1000 {
            let p = spline.at(f64::from(k) / 1000.0);
            let off = line
                .windows(2)
                .map(|s| p.distance(super::super::polygon::nearest_on_segment(s[0], s[1], p)))
                .fold(f64::INFINITY, f64::min);
            assert!(off <= 1e-3 + 1e-12, "{off}");
        }
    }
}
