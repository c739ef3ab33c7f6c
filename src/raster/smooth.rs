//! Small filters on fields of numbers.

use super::Grid;

/// Convolved with a Gaussian of standard deviation `sigma` (px); edges repeat outwards.
#[must_use]
pub fn gaussian(field: &Grid<f32>, sigma: f64) -> Grid<f32> {
    let reach = (3.0 * sigma).ceil().max(1.0) as usize;
    let weights: Vec<f64> =
        (0..=reach).map(|k| libm::exp(-0.5 * (k as f64 / sigma).powi(2))).collect();
    let total = weights[0] + 2.0 * weights[1..].iter().sum::<f64>();
    let weights: Vec<f32> = weights.iter().map(|w| (w / total) as f32).collect();
    let (width, height) = (field.width(), field.height());
    let mut rows = Grid::filled(width, height, 0.0f32);
    for y in 0..height {
        let line = field.row(y);
        for x in 0..width {
            let mut sum = line[x] * weights[0];
            for k in 1..=reach {
                sum += (line[x.saturating_sub(k)] + line[(x + k).min(width - 1)]) * weights[k];
            }
            rows[(x, y)] = sum;
        }
    }
    let mut smooth = Grid::filled(width, height, 0.0f32);
    for y in 0..height {
        let out = &mut smooth.values_mut()[y * width..(y + 1) * width];
        for (value, middle) in out.iter_mut().zip(rows.row(y)) {
            *value = middle * weights[0];
        }
        for (k, weight) in weights.iter().enumerate().skip(1) {
            let (above, below) = (rows.row(y.saturating_sub(k)), rows.row((y + k).min(height - 1)));
            for (value, (a, b)) in out.iter_mut().zip(above.iter().zip(below)) {
                *value += (a + b) * weight;
            }
        }
    }
    smooth
}

/// The median of each pixel and its eight neighbours; the outermost ring stays as it is.
#[must_use]
pub fn median(field: &Grid<f32>) -> Grid<f32> {
    let mut out = field.clone();
    for y in 1..field.height().saturating_sub(1) {
        for x in 1..field.width().saturating_sub(1) {
            let mut around = [0.0f32; 9];
            for (k, value) in around.iter_mut().enumerate() {
                *value = field[(x + k % 3 - 1, y + k / 3 - 1)];
            }
            around.sort_unstable_by(f32::total_cmp);
            out[(x, y)] = around[4];
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smoothing_keeps_a_constant_and_the_sum_of_a_spike() {
        let flat = gaussian(&Grid::filled(9, 7, 3.0f32), 1.2);
        assert!(flat.values().iter().all(|v| (v - 3.0).abs() < 1e-5));
        let mut spike = Grid::filled(21, 21, 0.0f32);
        spike[(10, 10)] = 1.0;
        let sum: f32 = gaussian(&spike, 1.0).values().iter().sum();
        assert!((sum - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_median_removes_a_speck_and_keeps_an_edge() {
        let mut field = Grid::filled(8, 8, 0.0f32);
        for y in 0..8 {
            for x in 4..8 {
                field[(x, y)] = 1.0;
            }
        }
        let edge = field.clone();
        field[(2, 3)] = 1.0;
        assert_eq!(median(&field), edge);
    }
}
