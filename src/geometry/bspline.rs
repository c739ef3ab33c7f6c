//! Quadratic B-splines: evaluate, flatten to a tolerance.

use super::DVec2;

/// A clamped quadratic B-spline.
#[derive(Debug, Clone, PartialEq)]
pub struct QuadraticBSpline {
    knots: Vec<f64>,
    control: Vec<DVec2>,
}
