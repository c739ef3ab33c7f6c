//! Colours as they are chosen, in hue, saturation and value: Foster's colour types, front and back.
//!
//! Source: Foster, appendix B.3. Departs from it: one blend per texel with the largest weight
//! w = 1 − distance / reach among the sources in reach (node after node saturates), the front of
//! the colour made uneven by the tissue; hue on the shorter arc. The schemes not chosen are applied
//! with colours just off the base, as in the source.
//!
//! Pigments only: no light is painted in, but the soft darkening of the green tissue that lines a
//! vein.

use super::{Albedo, ColourSpec, ColourType, Face, Hsv, SPREADING, SideColour, Tissue, shade};
use crate::raster::color::{Tint, byte};
use crate::texture::petiole::StalkAt;
use crate::texture::spectrum::{decoded, encoded};
use crate::texture::brush::Shade;
use crate::texture::tissue::smooth;

/// The colours of one side, ready to mix.
#[derive(Debug)]
pub(in crate::texture) struct Chosen {
    r#type: ColourType,
    per_spread_mm: f32,
    undertone: f32,
    mottle: f32,
    face: Face,
    base: Tint,
    alternate: Tint,
    vein: Tint,
    petiole: Tint,
    /// Off the base: from veins, from edges, speckled.
    off: [Tint; 3],
    /// The midrib takes the petiole's colour within this distance of the base (mm).
    petiole_reach: f32,
    /// Values without the mirror part of the surface, by values with it; `None` to keep it.
    less_surface: Option<Box<[f32; 256]>>,
}

/// Dead tissue, and tissue with nothing left between its skins.
const DEAD: Tint = Tint { hue: 26.0, saturation: 0.45, value: 0.40 };
const MINED: Tint = Tint { hue: 52.0, saturation: 0.26, value: 0.74 };

/// Share of light that the surface of a leaf mirrors, nearly the same at all wavelengths.
const SURFACE: f64 = 0.038;

impl Chosen {
    pub(super) fn new(
        spec: &ColourSpec,
        side: &SideColour,
        face: Face,
        petiole: &Hsv,
        petiole_reach: f32,
    ) -> Self {
        let base = side.base.tint();
        let off = |hue: f32, saturation: f32, value: f32| Tint {
            hue: base.hue + hue,
            saturation: base.saturation * saturation,
            value: base.value * value,
        };
        Self {
            r#type: spec.r#type,
            per_spread_mm: 1.0 / (spec.spread_mm as f32).max(1e-6),
            undertone: spec.undertone as f32,
            mottle: spec.mottle as f32,
            face,
            base,
            alternate: side.alternate.tint().unrolled(base),
            vein: side.vein.tint().unrolled(base),
            petiole: petiole.tint().unrolled(base),
            // Beside veins deeper and greener, towards the margin thinner and yellower, in spots
            // browner and darker.
            off: [off(14.0, 1.05, 0.55), off(-16.0, 0.95, 1.35), off(-30.0, 1.0, 0.72)],
            petiole_reach,
            less_surface: (spec.albedo == Albedo::Diffuse).then(|| {
                Box::new(std::array::from_fn(|byte| {
                    encoded((decoded(byte as f64 / 255.0) - SURFACE).max(0.0)) as f32
                }))
            }),
        }
    }

    /// What is seen of the blade, and through it.
    #[inline]
    pub(super) fn blade(&self, tissue: &Tissue) -> Shade {
        let tint = self.tint(tissue);
        let vein = tissue.vein.cover * tissue.vein.radius / (tissue.vein.radius + 0.12);
        let mut shade = shade(tint, 0.92 - 0.6 * vein);
        if let Some(curve) = &self.less_surface {
            shade.reflected = shade.reflected.map(|value| curve[byte(value) as usize]);
        }
        shade
    }

    /// The colour of the blade.
    #[inline]
    fn tint(&self, tissue: &Tissue) -> Tint {
        let Tissue { place, from_base, .. } = tissue;
        let [broad, middle, fine] = place.noise;
        let m = self.mottle;
        // The scheme chosen, and the others faintly.
        let weights = tissue.weights(self.per_spread_mm, m);
        let mut tint = self.base;
        for ((w, off), r#type) in weights.into_iter().zip(self.off).zip(SPREADING) {
            tint = if r#type == self.r#type {
                tint.towards(self.alternate, w)
            } else {
                tint.towards(off, w * self.undertone)
            };
        }
        // Broad patches of greener and yellower tissue; deeper green along the larger veins, paler
        // in the middle of the panels between them.
        tint.hue += m * (5.0 * broad + 4.0 * middle - 3.0 * tissue.panel());
        tint.saturation *= 1.0 + m * (0.18 * middle - 0.10 * broad + 0.10 * fine);
        tint.value *= 1.0 + m * tissue.unevenness();
        let [net, seen] = tissue.veins_seen(&self.face, m);
        tint = tint.towards(self.vein, net);
        // A thin hardened rim.
        let rim = 1.0 - smooth(0.05, 0.45, place.edge);
        tint = tint.towards(self.vein, 0.30 * rim);
        // Green tissue thickens beside a vein.
        tint.value *= 1.0 - self.face.flank * tissue.flank();
        // The vein itself, paler along its crest.
        let mut core = self.vein;
        core.value *= 0.90 + 0.16 * tissue.roundness() + 0.05 * m * (fine + tissue.grain);
        let near = 1.0 - smooth(0.0, self.petiole_reach, *from_base);
        core = core.towards(self.petiole, 0.5 * near);
        tint = tint.towards(core, seen);
        // What has died is brown, what was mined is pale.
        tint = tint.towards(DEAD.unrolled(self.base), tissue.injury.brown);
        tint.towards(MINED.unrolled(self.base), tissue.injury.pale)
    }

    /// The colour of the petiole; it is the midrib's at the blade and browner at the stem.
    #[inline]
    pub(super) fn stalk(&self, stalk: &StalkAt, length: f32, grain: f32) -> Shade {
        let round = stalk.dome / stalk.radius.max(1e-6);
        let blade = 1.0 - smooth(0.0, 2.0 * self.petiole_reach, stalk.along);
        let stem = smooth(0.72, 1.05, stalk.along / length.max(1e-6));
        let mut tint = self.petiole.towards(self.vein, 0.5 * blade);
        tint.hue -= 18.0 * stem;
        tint.value *=
            (0.86 + 0.18 * round) * (1.0 - 0.22 * stem) * (1.0 + 0.2 * self.mottle * grain);
        shade(tint, 0.3)
    }
}
