//! The least value of a function of a few bounded numbers, without derivatives.
//!
//! Source: Nelder & Mead, "A simplex method for function minimization", The Computer Journal 7,
//! 1965; coefficients that depend on the dimension after Gao & Han, "Implementing the Nelder–Mead
//! simplex algorithm with adaptive parameters", Computational Optimization and Applications 51,
//! 2012. Points outside the bounds are moved to them.
//!
//! Own code, since what it replaces is small: the crates in reach bring a linear algebra library
//! each, derivatives that greatest distances do not have, and no bounds.

/// How to search.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Search {
    /// The function is called this often at most.
    pub most_calls: usize,
    /// Stops when the values over the simplex differ by less than this.
    pub tolerance: f64,
}

/// The place with the least value found, and that value.
#[derive(Debug, Clone, PartialEq)]
pub struct Minimum {
    /// Where.
    pub at: Vec<f64>,
    /// The value there.
    pub value: f64,
}

/// Searches downhill from `start`, with first steps of `steps`; number `i` stays within `bounds[i]`.
///
/// Values that are not finite count as very large ones.
///
/// # Panics
///
/// If the three lists differ in length or are empty: they come from code.
pub fn minimum(
    mut value: impl FnMut(&[f64]) -> f64,
    start: &[f64],
    steps: &[f64],
    bounds: &[[f64; 2]],
    search: Search,
) -> Minimum {
    let n = start.len();
    assert!(n > 0 && steps.len() == n && bounds.len() == n, "lists of {n} numbers");
    let inside = |x: &mut [f64]| {
        for (x, [low, high]) in x.iter_mut().zip(bounds) {
            *x = x.clamp(*low, *high);
        }
    };
    let mut calls = 0;
    let mut call = |x: &[f64]| {
        calls += 1;
        let v = value(x);
        (if v.is_finite() { v } else { f64::MAX }, calls)
    };
    let mut first = start.to_vec();
    inside(&mut first);
    type Simplex = Vec<(f64, Vec<f64>)>;
    let corners = |value: f64, at: &[f64], call: &mut dyn FnMut(&[f64]) -> (f64, usize)| {
        let mut simplex: Simplex = vec![(value, at.to_vec())];
        for i in 0..n {
            let mut x = at.to_vec();
            // Away from a bound that is too near.
            let step = if x[i] + steps[i] > bounds[i][1] { -steps[i] } else { steps[i] };
            x[i] += step;
            inside(&mut x);
            simplex.push((call(&x).0, x));
        }
        simplex
    };
    let mut simplex = corners(call(&first).0, &first, &mut call);
    let mut restarted = f64::INFINITY;
    let dimension = (n as f64).max(2.0);
    let (expand, contract, shrink) =
        (1.0 + 2.0 / dimension, 0.75 - 0.5 / dimension, 1.0 - 1.0 / dimension);
    loop {
        simplex.sort_by(|a, b| a.0.total_cmp(&b.0));
        let spread = simplex[n].0 - simplex[0].0;
        let mut middle = vec![0.0; n];
        for (_, x) in &simplex[..n] {
            middle.iter_mut().zip(x).for_each(|(m, x)| *m += x / n as f64);
        }
        let worst = simplex[n].clone();
        let along = |share: f64| {
            let mut x: Vec<f64> =
                middle.iter().zip(&worst.1).map(|(m, w)| m + share * (m - w)).collect();
            inside(&mut x);
            x
        };
        let reflected = along(1.0);
        let (at_reflected, calls) = call(&reflected);
        if calls >= search.most_calls {
            break;
        }
        if spread < search.tolerance {
            // A simplex pressed flat against a bound cannot leave along it: once more from there, with
            // corners in every direction, until that finds nothing better.
            let (least, at) = simplex[0].clone();
            let pressed = at.iter().zip(bounds).any(|(x, [low, high])| x == low || x == high);
            if !pressed || least >= restarted {
                break;
            }
            restarted = least;
            simplex = corners(least, &at, &mut call);
            continue;
        }
        simplex[n] = if at_reflected < simplex[0].0 {
            let expanded = along(expand);
            let (at_expanded, _) = call(&expanded);
            if at_expanded < at_reflected {
                (at_expanded, expanded)
            } else {
                (at_reflected, reflected)
            }
        } else if at_reflected < simplex[n - 1].0 {
            (at_reflected, reflected)
        } else {
            let contracted =
                if at_reflected < worst.0 { along(contract) } else { along(-contract) };
            let (at_contracted, _) = call(&contracted);
            if at_contracted < worst.0.min(at_reflected) {
                (at_contracted, contracted)
            } else {
                let best = simplex[0].1.clone();
                for (v, x) in &mut simplex[1..] {
                    x.iter_mut().zip(&best).for_each(|(x, b)| *x = b + shrink * (*x - b));
                    *v = call(x).0;
                }
                continue;
            }
        };
    }
    let (value, at) = simplex.swap_remove(0);
    Minimum { at, value }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SEARCH: Search = Search { most_calls: 4000, tolerance: 1e-14 };

    #[test]
    fn the_valley_of_rosenbrock_is_found() {
        let rosenbrock = |x: &[f64]| {
            x.windows(2).map(|p| (1.0 - p[0]).powi(2) + 100.0 * (p[1] - p[0] * p[0]).powi(2)).sum()
        };
        let found = minimum(rosenbrock, &[-1.2, 1.0, 0.5], &[0.3; 3], &[[-5.0, 5.0]; 3], SEARCH);
        assert!(found.at.iter().all(|x| (x - 1.0).abs() < 1e-3), "{found:?}");
    }

    #[test]
    fn bounds_hold_and_the_least_may_lie_on_one() {
        let mut seen = Vec::new();
        let bowl = |x: &[f64]| {
            seen.push(x.to_vec());
            (x[0] - 3.0).powi(2) + (x[1] + 1.0).powi(2)
        };
        let found = minimum(bowl, &[0.0, 0.0], &[1.0; 2], &[[-2.0, 2.0], [-2.0, 2.0]], SEARCH);
        assert!((found.at[0] - 2.0).abs() < 1e-6 && (found.at[1] + 1.0).abs() < 1e-5, "{found:?}");
        assert!(seen.iter().flatten().all(|x| x.abs() <= 2.0));
    }

    #[test]
    fn what_is_not_a_number_is_avoided() {
        let root = |x: &[f64]| (x[0] - 0.25).sqrt();
        let found = minimum(root, &[1.0], &[0.5], &[[-9.0, 9.0]], SEARCH);
        assert!((found.at[0] - 0.25).abs() < 1e-6, "{found:?}");
    }
}
