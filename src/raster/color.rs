//! Colours as hue, saturation and value, mixed along the shorter arc of the hue circle.
//!
//! The conversions are palette's, restated for plain floats without a branch per colour space: a
//! texture asks for millions. The tests hold the two against each other.

use crate::geometry::whole;

/// A colour: hue in degrees, saturation and value 0–1, in sRGB's own (not linear) numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tint {
    /// Hue (degrees), any turn.
    pub hue: f32,
    /// Saturation.
    pub saturation: f32,
    /// Value (brightness).
    pub value: f32,
}

impl Tint {
    /// The same colour with its hue written on the turn nearest to `reference`'s, so that plain
    /// interpolation between the two runs along the shorter arc.
    #[must_use]
    pub fn unrolled(self, reference: Self) -> Self {
        let turns = ((reference.hue - self.hue) / 360.0).round();
        Self { hue: self.hue + 360.0 * turns, ..self }
    }

    /// From this colour to `other`, hue as written: for colours [`unrolled`](Self::unrolled)
    /// against one reference.
    #[must_use]
    #[inline]
    pub fn towards(self, other: Self, share: f32) -> Self {
        Self {
            hue: self.hue + (other.hue - self.hue) * share,
            saturation: self.saturation + (other.saturation - self.saturation) * share,
            value: self.value + (other.value - self.value) * share,
        }
    }

    /// From this colour to `other` along the shorter arc of hue.
    #[must_use]
    pub fn mixed(self, other: Self, share: f32) -> Self {
        self.towards(other.unrolled(self), share)
    }

    /// Red, green, blue, 0–1, in sRGB.
    #[must_use]
    #[inline]
    pub fn srgb(self) -> [f32; 3] {
        let sixths = self.hue * (1.0 / 60.0);
        // The hue is within a few turns: bring it into 0–6 without a call to a library.
        let sixths = sixths - 6.0 * whole::floor(sixths * (1.0 / 6.0)) as f32;
        let (s, v) = (self.saturation.clamp(0.0, 1.0), self.value.clamp(0.0, 1.0));
        let ramp = |shift: f32| {
            let k = sixths + shift;
            let k = if k >= 6.0 { k - 6.0 } else { k };
            v - v * s * k.min(4.0 - k).clamp(0.0, 1.0)
        };
        [ramp(5.0), ramp(3.0), ramp(1.0)]
    }
}

/// A share 0–1 in 16 bits, rounded; what is less or more is 0 or 1.
#[must_use]
#[inline(always)]
pub fn word(share: f32) -> u16 {
    whole::cut(share * 65535.0 + 0.5, 65535.0) as u16
}

/// A share 0–1 as a byte, rounded; what is less or more is 0 or 1.
#[must_use]
#[inline(always)]
pub fn byte(share: f32) -> u8 {
    whole::cut(share * 255.0 + 0.5, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use palette::{FromColor, Mix};

    type Hsv = palette::Hsv<palette::encoding::Srgb, f32>;

    #[test]
    fn conversion_agrees_with_palette() {
        for i in 0..500 {
            let tint = Tint {
                hue: i as f32 * 3.7 - 400.0,
                saturation: (i % 11) as f32 / 10.0,
                value: (i % 7) as f32 / 6.0,
            };
            let theirs: palette::Srgb<f32> =
                palette::Srgb::from_color(Hsv::new(tint.hue, tint.saturation, tint.value));
            let ours = tint.srgb();
            let off = (ours[0] - theirs.red).abs()
                + (ours[1] - theirs.green).abs()
                + (ours[2] - theirs.blue).abs();
            assert!(off < 1e-4, "{tint:?}: {ours:?} {theirs:?}");
        }
    }

    #[test]
    fn hues_mix_along_the_shorter_arc_as_in_palette() {
        for (a, b) in [(350.0, 20.0), (20.0, 350.0), (95.0, 62.0), (-30.0, 60.0), (10.0, 700.0)] {
            let tint = |hue| Tint { hue, saturation: 0.8, value: 0.7 };
            let ours = tint(a).mixed(tint(b), 0.3).srgb();
            let mixed = Hsv::new(a, 0.8, 0.7).mix(Hsv::new(b, 0.8, 0.7), 0.3);
            let theirs: palette::Srgb<f32> = palette::Srgb::from_color(mixed);
            assert!((ours[0] - theirs.red).abs() < 1e-4, "{a} {b}");
            assert!((ours[1] - theirs.green).abs() < 1e-4, "{a} {b}");
        }
    }
}
