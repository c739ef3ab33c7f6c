//! How the surface takes the light, beside its colour: roughness of both sides, and what comes
//! through.
//!
//! Roughness is the perceptual one of GGX, √α. Glossy leaves (laurel, ivy) have α near 0.12 above,
//! thin summer leaves near 0.3, downy undersides near 0.5; a lower side has a third of the shine
//! (Foster, section 2.3.6).

use super::relief::{Ground, ReliefSpec};

/// Perceptual roughness of a matt leaf, and by how much a glossy one is smoother.
const MATT: f32 = 0.70;
const GLOSS: f32 = 0.40;

/// A lower side shines a third as much.
const BACK_SHARE: f32 = 1.0 / 3.0;

/// Roughness of both sides.
#[derive(Debug)]
pub(super) struct Optics {
    plain: [f32; 2],
    uneven: f32,
}

impl Optics {
    pub(super) fn new(spec: &ReliefSpec) -> Self {
        let shine = spec.specularity as f32;
        let grain = spec.roughness as f32;
        let plain = [shine, BACK_SHARE * shine].map(|s| MATT - GLOSS * s.sqrt() + 0.10 * grain);
        Self { plain, uneven: 0.04 + 0.10 * grain }
    }

    /// Front and back: veins a little smoother, the bottom of their grooves a little rougher.
    #[inline(always)]
    pub(super) fn roughness(&self, ground: &Ground, dry: f32) -> [f32; 2] {
        let [broad, middle, _] = ground.place.noise;
        let uneven = self.uneven * (0.5 * ground.grain + 0.25 * middle + 0.15 * broad);
        let groove = ground.vein.groove / (ground.vein.groove + 0.15);
        let vein = ground.vein.cover * ground.vein.radius / (ground.vein.radius + 0.1);
        let [front, back] = self.plain;
        let dried = |plain: f32| plain + (0.82 - plain) * dry;
        [dried(front) + uneven + 0.06 * groove, dried(back) + uneven - 0.06 * vein]
            .map(|value| value.clamp(0.05, 1.0))
    }

    /// Front and back of the petiole.
    pub(super) fn stalk(&self) -> [f32; 2] {
        self.plain.map(|plain| (plain + 0.05).min(1.0))
    }
}

/// The share of scattered light that goes on through, of both colours in sRGB (0–1): by luminance.
#[inline(always)]
pub(super) fn transmitted_share(reflected: [f32; 3], through: [f32; 3]) -> f32 {
    // Squares stand in for sRGB's curve: the share is a ratio, in which the difference drops out.
    let luminance = |[r, g, b]: [f32; 3]| 0.2126 * r * r + 0.7152 * g * g + 0.0722 * b * b;
    let (back, on) = (luminance(reflected), luminance(through));
    on / (back + on).max(1e-6)
}
