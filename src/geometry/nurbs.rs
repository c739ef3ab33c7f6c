//! Rational quadratic B-splines over any kind of points: what each control point counts for.
//!
//! Source: L. Piegl & W. Tiller, *The NURBS Book*, 1997, equation 4.1, with uniform knots whose ends
//! are threefold, so that the curve passes through its first and last point.

/// How much each of the control points with these weights counts at `u` (0 to 1); the shares sum to
/// 1. Two points are joined by a line; one is all there is.
///
/// # Panics
///
/// Without a control point: the caller has at least one.
#[must_use]
pub fn shares(weights: &[f64], u: f64) -> Vec<f64> {
    let n = weights.len();
    assert!(n > 0, "a curve has control points");
    let u = u.clamp(0.0, 1.0);
    let mut shares = match n {
        1 => vec![1.0],
        2 => vec![1.0 - u, u],
        _ => quadratic_basis(n, u),
    };
    shares.iter_mut().zip(weights).for_each(|(share, weight)| *share *= weight);
    let total: f64 = shares.iter().sum();
    shares.iter_mut().for_each(|share| *share /= total);
    shares
}

/// The quadratic B-spline basis over clamped uniform knots (Cox–de Boor).
fn quadratic_basis(n: usize, u: f64) -> Vec<f64> {
    let spans = n - 2;
    let knot = |i: usize| (i.saturating_sub(2).min(spans)) as f64 / spans as f64;
    let span = ((u * spans as f64) as usize).min(spans - 1) + 2;
    let mut basis = vec![0.0; n];
    let part = |low: f64, high: f64| if high > low { (u - low) / (high - low) } else { 0.0 };
    let (left, right) = (part(knot(span - 1), knot(span + 1)), part(knot(span), knot(span + 2)));
    let inner = part(knot(span), knot(span + 1));
    basis[span - 2] = (1.0 - inner) * (1.0 - left);
    basis[span - 1] = (1.0 - inner) * left + inner * (1.0 - right);
    basis[span] = inner * right;
    basis
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Cox–de Boor, straight from the definition.
    fn basis(i: usize, degree: usize, u: f64, knots: &[f64]) -> f64 {
        if degree == 0 {
            let last = knots[i + 1] == knots[knots.len() - 1] && knots[i] < knots[i + 1];
            return f64::from(u8::from(knots[i] <= u && (u < knots[i + 1] || (last && u <= 1.0))));
        }
        let part = |a: f64, b: f64| if b > a { (u - a) / (b - a) } else { 0.0 };
        let rest = |a: f64, b: f64| if b > a { (b - u) / (b - a) } else { 0.0 };
        part(knots[i], knots[i + degree]) * basis(i, degree - 1, u, knots)
            + rest(knots[i + 1], knots[i + degree + 1]) * basis(i + 1, degree - 1, u, knots)
    }

    #[test]
    fn shares_follow_the_definition() {
        for n in 3..7 {
            let spans = n - 2;
            let mut knots = vec![0.0; 2];
            knots.extend((0..=spans).map(|i| i as f64 / spans as f64));
            knots.extend([1.0; 2]);
            let weights: Vec<f64> = (0..n).map(|i| 1.0 + 0.7 * (i % 3) as f64).collect();
            for step in 0..=40 {
                let u = f64::from(step) / 40.0;
                let raw: Vec<f64> = (0..n).map(|i| weights[i] * basis(i, 2, u, &knots)).collect();
                let total: f64 = raw.iter().sum();
                for (share, expected) in shares(&weights, u).iter().zip(&raw) {
                    assert!((share - expected / total).abs() < 1e-12, "{n} {u}");
                }
            }
        }
    }

    #[test]
    fn the_ends_are_the_first_and_the_last_point_and_two_points_make_a_line() {
        assert_eq!(shares(&[1.0, 9.0, 0.5, 1.0], 0.0), [1.0, 0.0, 0.0, 0.0]);
        assert_eq!(shares(&[1.0, 9.0, 0.5, 1.0], 1.0), [0.0, 0.0, 0.0, 1.0]);
        assert_eq!(shares(&[1.0, 1.0], 0.25), [0.75, 0.25]);
        // A heavier reference counts more half-way.
        assert!(shares(&[1.0, 4.0, 1.0], 0.5)[1] > shares(&[1.0, 1.0, 1.0], 0.5)[1]);
    }
}
