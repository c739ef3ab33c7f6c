//! The Z-order curve: numbers places so that what is near in the plane is mostly near in number.
//!
//! Source: G. M. Morton, "A computer oriented geodetic data base", IBM, 1966.

use super::{DVec2, Rect};

/// The place of `p` on the curve through `bounds`, which is cut into 65 536 by 65 536 squares; what is
/// outside counts with the squares at the border.
#[must_use]
pub fn z_order(bounds: Rect, p: DVec2) -> u32 {
    let size = bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
    let square = (p - bounds.min) / size * f64::from(u16::MAX);
    let square = square.clamp(DVec2::ZERO, DVec2::splat(f64::from(u16::MAX)));
    spread(square.x as u32) | spread(square.y as u32) << 1
}

/// The lower sixteen bits with a zero before each.
fn spread(bits: u32) -> u32 {
    let mut x = bits & 0xffff;
    x = (x | x << 8) & 0x00ff_00ff;
    x = (x | x << 4) & 0x0f0f_0f0f;
    x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_a_z_in_every_square_of_four() {
        let bounds = Rect { min: DVec2::ZERO, max: DVec2::ONE };
        let places = [(0.2, 0.2), (0.8, 0.2), (0.2, 0.8), (0.8, 0.8)];
        for (quarter, (x, y)) in places.into_iter().enumerate() {
            let p = DVec2::new(x, y);
            assert_eq!(z_order(bounds, p) >> 30, quarter as u32, "{p}");
            let inner = Rect { min: DVec2::ZERO, max: DVec2::splat(0.5) };
            assert_eq!(z_order(inner, p / 2.0) >> 30, quarter as u32, "{p}");
        }
        assert_eq!(z_order(bounds, DVec2::splat(-3.0)), 0);
        assert_eq!(z_order(bounds, DVec2::splat(9.0)), u32::MAX);
    }
}
