//! What is painted on a strip: heights, surface and colours of both sides.

use super::map::{MapKind, MapSet};
use super::optics::transmitted_share;
use super::relief::Relief;
use super::scene::Scene;
use super::strip::{LANES, LEAST_SEEN, Lane, Strip, texel};

/// Light that comes back from a place and light that goes through it, as sRGB numbers 0–1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shade {
    pub reflected: [f32; 3],
    pub through: [f32; 3],
}

impl Shade {
    /// From this to `other`.
    #[inline(always)]
    pub(super) fn mixed(self, other: Self, share: f32) -> Self {
        let mix = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share);
        Self {
            reflected: mix(self.reflected, other.reflected),
            through: mix(self.through, other.through),
        }
    }

    #[inline(always)]
    pub(super) fn at(shades: &Shades, i: usize) -> Self {
        let [r, g, b, tr, tg, tb] = texel(shades, i);
        Self { reflected: [r, g, b], through: [tr, tg, tb] }
    }

    #[inline(always)]
    pub(super) fn put(self, shades: &mut Shades, i: usize) {
        let ([r, g, b], [tr, tg, tb]) = (self.reflected, self.through);
        for (lane, value) in shades.iter_mut().zip([r, g, b, tr, tg, tb]) {
            lane[i] = value;
        }
    }
}

/// The colours of the texels of a strip on one side: red, green and blue of the light sent back and of that which
/// comes through.
pub(super) type Shades = [Lane; 6];

/// A strip of both sides. What is not asked for is left as it was.
#[derive(Debug)]
pub(super) struct Painted {
    pub alpha: Lane,
    pub shades: [Shades; 2],
    /// Over the plain blade (mm).
    pub heights: [Lane; 2],
    /// Steps of 8 bits.
    pub bumps: [Lane; 2],
    pub roughness: [Lane; 2],
    /// Share of the scattered light that goes on through.
    pub transmission: [Lane; 2],
    /// From front to back (mm).
    pub thickness: Lane,
}

impl Painted {
    pub(super) fn empty() -> Self {
        let zero = [0.0; LANES];
        Self {
            alpha: zero,
            shades: [[zero; 6]; 2],
            heights: [zero; 2],
            bumps: [zero; 2],
            roughness: [zero; 2],
            transmission: [zero; 2],
            thickness: zero,
        }
    }

    #[inline(always)]
    pub(super) fn paint(&mut self, scene: &Scene<'_>, strip: &Strip, maps: MapSet) {
        for i in 0..LANES {
            self.alpha[i] = strip.alpha(i);
        }
        scene.pigments.paint(strip, &mut self.shades);
        if maps.has(MapKind::Height) {
            for i in 0..LANES {
                let [front, back] = scene.relief.heights(&strip.ground(i));
                (self.heights[0][i], self.heights[1][i]) = (front, back);
            }
            if scene.layout.wounds.is_some() {
                for i in 0..strip.len {
                    let [front, back] = scene.relief.raised(&strip.injury(i));
                    self.heights[0][i] += front;
                    self.heights[1][i] += back;
                }
            }
        }
        if maps.has(MapKind::Bump) {
            for i in 0..LANES {
                let [front, back] = scene.relief.bumps(&strip.ground(i));
                (self.bumps[0][i], self.bumps[1][i]) = (front, back);
            }
        }
        if maps.has(MapKind::Roughness) {
            for i in 0..LANES {
                let [front, back] = scene.optics.roughness(&strip.ground(i), strip.dryness(i));
                (self.roughness[0][i], self.roughness[1][i]) = (front, back);
            }
        }
        if maps.has(MapKind::Thickness) {
            for i in 0..LANES {
                let blade = if self.alpha[i] < LEAST_SEEN { 0.0 } else { strip.blade[i] };
                self.thickness[i] = scene.relief.thickness(&strip.ground(i)) * blade;
            }
            if scene.layout.wounds.is_some() {
                for i in 0..strip.len {
                    self.thickness[i] *= Relief::left(&strip.injury(i));
                }
            }
        }
        if strip.stalked {
            self.add_stalk(scene, strip);
        }
        if maps.has(MapKind::Orm) {
            for (shares, shades) in self.transmission.iter_mut().zip(&self.shades) {
                for (i, share) in shares.iter_mut().enumerate() {
                    let Shade { reflected, through } = Shade::at(shades, i);
                    *share = transmitted_share(reflected, through);
                }
            }
        }
    }

    /// The petiole, and the part of it that runs into the midrib.
    fn add_stalk(&mut self, scene: &Scene<'_>, strip: &Strip) {
        for i in 0..strip.len {
            let stalk = &strip.stalk[i];
            if stalk.cover == 0.0 {
                continue;
            }
            let shares = strip.stalk_shares(i, scene.layout.shield);
            let shades = scene.pigments.stalk(stalk, scene.stalk_length, strip.fibre[i]);
            let [front, back] = scene.relief.stalk_heights(stalk);
            // Behind, stalk and midrib are one cord: whichever is higher.
            let heights = [front, back.max(self.heights[1][i])];
            let (bumps, roughness) = (scene.relief.stalk_bumps(), scene.optics.stalk());
            for side in 0..2 {
                let share = shares[side];
                let painted = &mut self.shades[side];
                Shade::at(painted, i).mixed(shades[side], share).put(painted, i);
                for (lane, value) in [
                    (&mut self.heights[side], heights[side]),
                    (&mut self.bumps[side], bumps[side]),
                    (&mut self.roughness[side], roughness[side]),
                ] {
                    lane[i] += (value - lane[i]) * share;
                }
            }
            self.thickness[i] = self.thickness[i].max(2.0 * stalk.dome);
        }
    }
}
