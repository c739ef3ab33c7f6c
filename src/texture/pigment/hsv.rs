//! Colours as they are chosen, in hue, saturation and value: Foster's colour types, front and back.
//!
//! Source: Foster, appendix B.3. Departs from it: one blend per texel with the largest weight
//! w = 1 − distance / reach among the sources in reach (node after node saturates), the front of
//! the colour made uneven by the tissue; hue on the shorter arc. The schemes not chosen are applied
//! with colours just off the base, as in the source.
//!
//! The pigments of a leaf of such colours are found from them, and are what light goes through and what
//! ages, sickens and is hurt.
//!
//! Pigments only: no light is painted in, but the soft darkening of the green tissue that lines a
//! vein.

use super::mixer::Mixer;
use super::{
    Albedo, Amounts, BACK, ColourSpec, ColourType, FRONT, Face, Hsv, SPREADING, SideColour,
    StateSpec, Tissue, shade,
};
use crate::raster::color::{Tint, byte};
use crate::texture::brush::{Shade, Shades};
use crate::texture::lattice;
use crate::texture::petiole::StalkAt;
use crate::texture::spectrum::{decoded, encoded};
use crate::texture::strip::{LANES, Strip};
use crate::texture::tissue::smooth;

/// Both sides as they are chosen, over the pigments of a leaf that looks so: those are what light goes
/// through, and what ages and sickens.
#[derive(Debug)]
pub(in crate::texture) struct Leaf {
    sides: [Chosen; 2],
    /// The leaf as it stands, and as it would be in summer and sound.
    now: Mixer,
    sound: Mixer,
    /// Whether the two may differ.
    changed: bool,
}

impl Leaf {
    pub(super) fn new(
        spec: &ColourSpec,
        state: &StateSpec,
        petiole: &Hsv,
        petiole_reach: f32,
        hurt: bool,
    ) -> Self {
        let mut alike = spec.clone();
        let lattice = lattice::of(Albedo::Total);
        let leaf_of =
            |colour: &Hsv| Amounts::of(lattice.leaf_of(colour.tint().srgb()).map(f64::from));
        let pigments = &mut alike.pigments;
        pigments.leaf = leaf_of(&spec.front.base);
        pigments.alternate = leaf_of(&spec.front.alternate);
        let green = |amounts: &Amounts| amounts.chlorophyll_ug_cm2.max(0.1);
        let ratio = |colour: &Hsv| green(&leaf_of(colour)) / green(&pigments.leaf);
        let (vein, back) = (ratio(&spec.front.vein), ratio(&spec.back.base));
        (pigments.vein_chlorophyll, pigments.back_chlorophyll) = (vein.min(2.0), back.min(2.0));
        let mixer = |state: &StateSpec| Mixer::new(&alike, state, petiole, petiole_reach, hurt);
        let summer = StateSpec::default();
        Self {
            sides: [(&spec.front, FRONT), (&spec.back, BACK)]
                .map(|(side, face)| Chosen::new(spec, side, face, petiole, petiole_reach)),
            now: mixer(state),
            sound: mixer(&summer).sound(),
            changed: *state != summer || hurt,
        }
    }

    /// What is seen of both sides of the blade, and through them. In summer it is what was chosen; what
    /// the season, sickness and wounds do to the pigments is done to it, and what no pigments of a leaf
    /// explain fades meanwhile.
    pub(super) fn paint(&self, strip: &Strip, shades: &mut [Shades; 2]) {
        self.now.paint(strip, shades);
        let mut sound = [[[0.0; LANES]; 6]; 2];
        if self.changed {
            self.sound.paint(strip, &mut sound);
        }
        for (side, (shades, sound)) in shades.iter_mut().zip(&sound).enumerate() {
            for i in 0..strip.len {
                let tissue = strip.tissue(i);
                let chosen = self.sides[side].blade(&tissue);
                let alive = (1.0 - tissue.condition.season) * (1.0 - tissue.condition.death);
                let kept = alive * (1.0 - tissue.injury.brown) * (1.0 - tissue.injury.pale);
                for c in 0..3 {
                    let now = shades[c][i];
                    let seen = if self.changed {
                        now + (chosen[c] - sound[c][i]) * kept
                    } else {
                        chosen[c]
                    };
                    let seen = seen.clamp(0.0, 1.0);
                    shades[c][i] = seen;
                    // No more light comes out than falls in; squares stand in for sRGB's curve, which
                    // lies below them.
                    shades[c + 3][i] = shades[c + 3][i].min((1.0 - seen * seen).max(0.0).sqrt());
                }
            }
        }
    }

    pub(super) fn stalk(&self, stalk: &StalkAt, length: f32, grain: f32) -> [Shade; 2] {
        std::array::from_fn(|side| self.sides[side].stalk(stalk, length, grain))
    }
}

/// The colours of one side, ready to mix.
#[derive(Debug)]
struct Chosen {
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

/// Share of light that the surface of a leaf mirrors, nearly the same at all wavelengths.
const SURFACE: f64 = 0.038;

impl Chosen {
    fn new(
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

    /// What is seen of the blade.
    #[inline]
    fn blade(&self, tissue: &Tissue) -> [f32; 3] {
        let seen = self.tint(tissue).srgb();
        match &self.less_surface {
            Some(curve) => seen.map(|value| curve[byte(value) as usize]),
            None => seen,
        }
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
        tint.towards(core, seen)
    }

    /// The colour of the petiole; it is the midrib's at the blade and browner at the stem.
    #[inline]
    fn stalk(&self, stalk: &StalkAt, length: f32, grain: f32) -> Shade {
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
