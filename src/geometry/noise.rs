//! Gradient noise on the plane and along a line, and the integer hash beneath it.
//!
//! Source: K. Perlin, "Improving noise", ACM Trans. Graph. 21(3), 2002. Departs from it: the
//! permutation table is an integer hash, so the pattern never repeats, and gradients are sixteen
//! unit vectors, because eight show the axes at low frequency.
//!
//! Only sums, products and comparisons: the same bits on every machine.

use super::whole::floor;

/// A hash of a lattice point: every bit of the result depends on every bit of the input.
#[must_use]
#[inline]
pub fn lattice(x: i32, y: i32, seed: u32) -> u32 {
    let mut h = (x as u32).wrapping_mul(0x9E37_79B1) ^ seed.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ (h >> 15)).wrapping_add((y as u32).wrapping_mul(0x85EB_CA77));
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    h ^ (h >> 15)
}

/// A number in [0, 1) from the upper bits of a hash.
#[must_use]
#[inline]
pub fn unit(hash: u32) -> f32 {
    (hash >> 8) as f32 * (1.0 / (1 << 24) as f32)
}

/// Smooth noise of about one feature per unit, mean 0, within −1 … 1.
#[must_use]
#[inline]
pub fn gradient(x: f32, y: f32, seed: u32) -> f32 {
    let (ix, iy) = (floor(x), floor(y));
    let (fx, fy) = (x - ix as f32, y - iy as f32);
    let corner = |dx: i32, dy: i32| {
        let [gx, gy] = GRADIENTS[(lattice(ix + dx, iy + dy, seed) >> 28) as usize];
        gx * (fx - dx as f32) + gy * (fy - dy as f32)
    };
    let (u, v) = (fade(fx), fade(fy));
    let low = lerp(corner(0, 0), corner(1, 0), u);
    let high = lerp(corner(0, 1), corner(1, 1), u);
    // The extreme of unit gradients in the plane is √½.
    lerp(low, high, v) * std::f32::consts::SQRT_2
}

/// [`gradient`] along one row: what the lattice gives to a whole row is worked out once.
///
/// Along a row a corner's share is linear in x, so the corners above and below a lattice column are
/// joined to one line; a value takes two of them.
#[derive(Debug, Default)]
pub struct GradientRow {
    first: i32,
    /// Slope in x, and value at the column, of each lattice column.
    lines: Vec<[f32; 2]>,
}

impl GradientRow {
    /// Prepares the row `y` from `left` to `right`.
    pub fn prepare(&mut self, left: f32, right: f32, y: f32, seed: u32) {
        let iy = floor(y);
        let fy = y - iy as f32;
        let v = fade(fy);
        self.first = floor(left);
        self.lines.clear();
        self.lines.extend((self.first..=floor(right) + 1).map(|ix| {
            let [lower, upper] =
                [0, 1].map(|dy| GRADIENTS[(lattice(ix, iy + dy, seed) >> 28) as usize]);
            [lerp(lower[0], upper[0], v), lerp(lower[1] * fy, upper[1] * (fy - 1.0), v)]
        }));
    }

    /// Noise at places of the row, between the ends it was prepared for.
    ///
    /// # Panics
    ///
    /// Outside of them.
    #[must_use]
    #[inline(always)]
    pub fn along<const N: usize>(&self, xs: &[f32; N]) -> [f32; N] {
        let (mut columns, mut within) = ([0_i32; N], [0.0; N]);
        for i in 0..N {
            let ix = floor(xs[i]);
            (columns[i], within[i]) = (ix - self.first, xs[i] - ix as f32);
        }
        // What is looked up, which goes one by one, apart from what is worked out.
        let (mut lines, mut next) = ([[0.0; 2]; N], [[0.0; 2]; N]);
        for i in 0..N {
            let column = columns[i] as usize;
            (lines[i], next[i]) = (self.lines[column], self.lines[column + 1]);
        }
        let mut found = [0.0; N];
        for i in 0..N {
            let ([slope, value], [next_slope, next_value], fx) = (lines[i], next[i], within[i]);
            let (low, high) = (slope * fx + value, next_slope * (fx - 1.0) + next_value);
            found[i] = lerp(low, high, fade(fx)) * std::f32::consts::SQRT_2;
        }
        found
    }
}

/// Octaves of noise along one row, each of twice the frequency and half the weight, within −1 … 1.
///
/// Unlike [`fractal`]'s they are shifted against each other, not turned: rows stay rows.
#[derive(Debug)]
pub struct FractalRow {
    octaves: Vec<GradientRow>,
    seed: u32,
    per_total: f32,
}

/// From octave to octave, in x and y.
const SHIFT: [f32; 2] = [17.31, 5.87];

impl FractalRow {
    /// So many octaves, at least one, along no row yet.
    #[must_use]
    pub fn new(octaves: u32, seed: u32) -> Self {
        let rows = (0..octaves.max(1)).map(|_| GradientRow::default()).collect();
        let total = 2.0 - 0.5_f32.powi(octaves.max(1) as i32 - 1);
        Self { octaves: rows, seed, per_total: 1.0 / total }
    }

    /// Prepares the row `y` from `left` to `right`.
    pub fn prepare(&mut self, mut left: f32, mut right: f32, mut y: f32) {
        for (octave, row) in (0..).zip(&mut self.octaves) {
            let seed = self.seed.wrapping_add(0x68E3_1DA4_u32.wrapping_mul(octave));
            row.prepare(left, right, y, seed);
            (left, right) = (2.0 * left + SHIFT[0], 2.0 * right + SHIFT[0]);
            y = 2.0 * y + SHIFT[1];
        }
    }

    /// Noise at places of the row, between the ends it was prepared for.
    ///
    /// # Panics
    ///
    /// Outside of them.
    #[must_use]
    #[inline(always)]
    pub fn along<const N: usize>(&self, mut xs: [f32; N]) -> [f32; N] {
        let (mut sums, mut weight) = ([0.0; N], self.per_total);
        for row in &self.octaves {
            let found = row.along(&xs);
            for i in 0..N {
                sums[i] += weight * found[i];
                xs[i] = 2.0 * xs[i] + SHIFT[0];
            }
            weight *= 0.5;
        }
        sums
    }
}

/// The sum of `octaves` of [`gradient`], each of twice the frequency and half the weight, within
/// −1 … 1. Octaves are turned against each other, so that their lattices do not line up.
#[must_use]
pub fn fractal(mut x: f32, mut y: f32, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * gradient(x, y, seed.wrapping_add(octave.wrapping_mul(0x68E3_1DA4)));
        total += weight;
        weight *= 0.5;
        // Turned by atan(3/4), scaled by 2.
        (x, y) = (1.6 * x - 1.2 * y + 17.3, 1.2 * x + 1.6 * y + 5.9);
    }
    if total > 0.0 { sum / total } else { 0.0 }
}

/// Smooth noise along a line: about one feature per unit, mean 0, within −1 … 1, 0 at whole numbers.
#[must_use]
pub fn gradient_1d(x: f64, seed: u32) -> f64 {
    let cell = x.floor();
    let t = x - cell;
    let slope = |i: i64| 2.0 * f64::from(unit(lattice(i as i32, (i >> 32) as i32, seed))) - 1.0;
    let (a, b) = (slope(cell as i64) * t, slope(cell as i64 + 1) * (t - 1.0));
    let u = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    // Two slopes of one and minus one meet half-way at a half.
    2.0 * (a + (b - a) * u)
}

/// The sum of `octaves` of [`gradient_1d`], each of twice the frequency and half the weight, within
/// −1 … 1. Octaves are shifted against each other, so that their zeros do not meet.
#[must_use]
pub fn fractal_1d(x: f64, octaves: u32, seed: u32) -> f64 {
    let (mut sum, mut weight, mut total, mut x) = (0.0, 1.0, 0.0, x);
    for octave in 0..octaves {
        sum += weight * gradient_1d(x, seed.wrapping_add(octave.wrapping_mul(0x68E3_1DA4)));
        total += weight;
        weight *= 0.5;
        x = 2.0 * x + 0.37;
    }
    if total > 0.0 { sum / total } else { 0.0 }
}

#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
fn lerp(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// cos and sin of odd multiples of π/16.
const GRADIENTS: [[f32; 2]; 16] = {
    const A: f32 = 0.980_785_25;
    const B: f32 = 0.195_090_32;
    const C: f32 = 0.831_469_6;
    const D: f32 = 0.555_570_24;
    [
        [A, B],
        [C, D],
        [D, C],
        [B, A],
        [-B, A],
        [-D, C],
        [-C, D],
        [-A, B],
        [-A, -B],
        [-C, -D],
        [-D, -C],
        [-B, -A],
        [B, -A],
        [D, -C],
        [C, -D],
        [A, -B],
    ]
};

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_bounded_centred_and_continuous() {
        let (mut sum, mut most) = (0.0, 0.0_f32);
        for i in 0..20_000 {
            let (x, y) = (i as f32 * 0.0731 - 500.0, i as f32 * 0.0417);
            let n = fractal(x, y, 3, 9);
            assert!(n.abs() <= 1.0);
            assert!((fractal(x + 1e-3, y, 3, 9) - n).abs() < 0.02);
            sum += n;
            most = most.max(n.abs());
        }
        assert!((sum / 20_000.0).abs() < 0.02 && most > 0.4, "{sum} {most}");
    }

    #[test]
    fn noise_along_a_line_is_bounded_centred_and_continuous() {
        let (mut sum, mut most) = (0.0, 0.0_f64);
        for i in 0..20_000 {
            let x = f64::from(i) * 0.0731 - 700.0;
            let n = fractal_1d(x, 3, 9);
            assert!(n.abs() <= 1.0);
            assert!((fractal_1d(x + 1e-4, 3, 9) - n).abs() < 2e-3);
            sum += n;
            most = most.max(n.abs());
        }
        assert!((sum / 20_000.0).abs() < 0.02 && most > 0.4, "{sum} {most}");
        assert_ne!(gradient_1d(3.4, 1), gradient_1d(3.4, 2));
    }

    #[test]
    fn noise_by_rows_is_the_noise() {
        let mut row = GradientRow::default();
        for j in 0..40 {
            let y = j as f32 * 0.317 - 6.0;
            row.prepare(-30.0, 40.0, y, 11);
            for i in 0..=700 {
                let x = i as f32 * 0.1 - 30.0;
                let ([fast], slow) = (row.along(&[x]), gradient(x, y, 11));
                assert!((fast - slow).abs() < 2e-6, "{x} {y}: {fast} {slow}");
            }
        }
    }

    #[test]
    fn octaves_by_rows_are_bounded_and_continuous_across_rows() {
        let [mut here, mut below] = [0, 1].map(|_| FractalRow::new(3, 9));
        let mut most = 0.0_f32;
        for j in 0..200 {
            let y = j as f32 * 0.171 - 20.0;
            here.prepare(-9.0, 40.0, y);
            below.prepare(-9.0, 40.0, y + 1e-3);
            for i in 0..200 {
                let x = i as f32 * 0.24 - 8.9;
                let [n, right] = here.along([x, x + 1e-3]);
                let [under] = below.along([x]);
                assert!(n.abs() <= 1.0);
                assert!((right - n).abs() < 0.02 && (under - n).abs() < 0.02);
                most = most.max(n.abs());
            }
        }
        assert!(most > 0.4, "{most}");
    }
}
