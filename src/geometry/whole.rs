//! Whole numbers near floats, in a form that is taken eight at a time.
//!
//! A cast saturates, and sends what is not a number to 0: compilers do that one number at a time. Added to a
//! large float, a small one leaves its whole part in the last bits of the sum.

/// 1.5 × 2²³: the floats beside it are whole numbers, and their bits count up with them.
const ANCHOR: f32 = 12_582_912.0;

/// The whole number nearest to `x`, of two the even one, for |x| ≤ 2²².
#[must_use]
#[inline(always)]
pub fn nearest(x: f32) -> i32 {
    (x + ANCHOR).to_bits().wrapping_sub(ANCHOR.to_bits()).cast_signed()
}

/// The greatest whole number not above `x`, for |x| ≤ 2²². The library's `floor` is a call on machines
/// without SSE 4.1.
#[must_use]
#[inline(always)]
pub fn floor(x: f32) -> i32 {
    let near = nearest(x);
    near - i32::from(x < near as f32)
}

/// The number, or 0 or `most` where it is less or more; of what is not a number 0.
#[must_use]
#[inline(always)]
pub fn held(x: f32, most: f32) -> f32 {
    // Not `clamp`, which lets through what is not a number.
    let x = if x > 0.0 { x } else { 0.0 };
    if x < most { x } else { most }
}

/// As [`held`], cut to a whole number, for `most` ≤ 2²²: what a saturating cast does.
#[must_use]
#[inline(always)]
pub fn cut(x: f32, most: f32) -> i32 {
    floor(held(x, most))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn whole_numbers_are_those_of_the_library() {
        let mut rng = Seed(6).stream(Stage::Tissue);
        let most = (1 << 22) as f32;
        let random = (0..20_000).map(|i| {
            let reach = [1.0, 30.0, 70_000.0, f64::from(most)][i % 4];
            rng.between(-reach, reach) as f32
        });
        let edges = [
            0.0, -0.0, 0.5, -0.5, 1.5, -1.5, 2.5, 0.9, 1.0, -1.0, -2.0, 254.5, 255.0, 123_456.7,
            most, -most, 1e-30, -1e-30,
        ];
        for x in random.chain(edges) {
            assert_eq!(floor(x), x.floor() as i32, "{x}");
            assert_eq!(nearest(x), x.round_ties_even() as i32, "{x}");
            assert_eq!(cut(x, 255.0), i32::from(x as u8), "{x}");
        }
        for x in [f32::INFINITY, f32::NEG_INFINITY, f32::NAN, f32::MAX, f32::MIN] {
            assert_eq!(cut(x, 65535.0), i32::from(x as u16), "{x}");
        }
    }
}
