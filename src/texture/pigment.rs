//! Colour of the blade: a base colour and Foster's four colour types, front and back.
//!
//! Source: Foster, appendix B.3. Departs from it: one blend per texel with the largest weight
//! w = 1 − distance / reach among the sources in reach (node after node saturates), the front of
//! the colour made uneven by the tissue; hue on the shorter arc. The schemes not chosen are applied
//! with colours just off the base, as in the source.
//!
//! Pigments only: no light is painted in, but the soft darkening of the green tissue that lines a
//! vein.

use super::fields::{Place, VeinAt};
use super::petiole::StalkAt;
use super::texel::Shade;
use super::tissue::smooth;
use crate::parameter::{parameters, words};
use crate::raster::color::Tint;

parameters! {
    /// A colour: hue, saturation, value.
    pub struct Hsv {
        /// Hue: 0 red, 60 yellow, 120 green. May run past 0 or 360, so that a range can cross red.
        hue_deg: number(92.0, -360.0..=720.0, "deg"),
        /// Saturation.
        saturation: number(0.46, 0.0..=1.0, ""),
        /// Value (brightness).
        value: number(0.37, 0.0..=1.0, ""),
    }
}

words! {
    /// How the second colour is spread (Foster, appendix B.3).
    pub enum ColourType {
        /// Base colour all over.
        Uniform = "uniform",
        /// From the veins outwards.
        FromVeins = "from-veins",
        /// From the margin inwards.
        FromEdges = "from-edges",
        /// From scattered points.
        Speckled = "speckled",
    }
}

parameters! {
    /// The colours of one side.
    pub struct SideColour {
        /// Colour of the tissue.
        base: group(Hsv, Hsv::default()),
        /// The second colour, spread by the colour type.
        alternate: group(Hsv, Hsv { hue_deg: 62.0, saturation: 0.6, value: 0.55 }),
        /// Colour of the veins.
        vein: group(Hsv, Hsv { hue_deg: 75.0, saturation: 0.38, value: 0.55 }),
    }
}

parameters! {
    /// Pigments of both sides (Foster, appendix B.3).
    pub struct ColourSpec {
        /// How the second colour is spread: `uniform`, `from-veins`, `from-edges` or `speckled`.
        r#type: choice(ColourType, ColourType::Uniform),
        /// Reach of the colour from a vein, in vein widths.
        vein_spread: number(8.0, 0.0..=200.0, "vein widths"),
        /// Reach of the colour from the margin or a speckle.
        spread_mm: number(6.0, 0.0..=1000.0, "mm"),
        /// How many speckles are thrown; 0 for a tenth of the auxin spawn rate.
        speckle_count: count(0, 0..=100_000, ""),
        /// Strength of the schemes not chosen, which keep the blade from looking flat.
        undertone: number(0.12, 0.0..=1.0, ""),
        /// Strength of the fine structure between the veins.
        mottle: number(0.35, 0.0..=1.0, ""),
        /// Upper side.
        front: group(SideColour, SideColour::default()),
        /// Lower side.
        back: group(SideColour, SideColour {
            base: Hsv { hue_deg: 88.0, saturation: 0.34, value: 0.52 },
            alternate: Hsv { hue_deg: 62.0, saturation: 0.45, value: 0.62 },
            vein: Hsv { hue_deg: 72.0, saturation: 0.28, value: 0.66 },
        }),
    }
}

impl Hsv {
    /// As a colour to compute with.
    #[must_use]
    pub fn tint(&self) -> Tint {
        Tint {
            hue: self.hue_deg as f32,
            saturation: self.saturation as f32,
            value: self.value as f32,
        }
    }
}

/// What colour is made of, at one texel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tissue {
    /// The guide.
    pub place: Place,
    /// The veins.
    pub vein: VeinAt,
    /// How much of the texel the lines of the fine nets cover, as far as they show (0–1).
    pub lines: [f32; 3],
    /// Lightness of the meshes of the nets, as far as they show (−1 – 1).
    pub tones: [f32; 3],
    /// Grain, −1 – 1.
    pub grain: f32,
    /// Distance from the base of the blade (mm).
    pub from_base: f32,
}

/// How the two sides of a blade differ.
#[derive(Debug, Clone, Copy)]
struct Face {
    /// A vein of this radius (mm) shows half its colour: finer ones are buried in green tissue.
    half_shown_mm: f32,
    /// How much of the vein's colour the fine nets show.
    lines: [f32; 3],
    /// Darkening of the tissue that lines a vein.
    flank: f32,
}

const FRONT: Face = Face { half_shown_mm: 0.075, lines: [0.42, 0.30, 0.20], flank: 0.20 };
const BACK: Face = Face { half_shown_mm: 0.030, lines: [0.55, 0.42, 0.26], flank: 0.12 };

/// The colours of one side, ready to mix.
#[derive(Debug)]
pub(super) struct Pigments {
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
}

impl Pigments {
    /// The pigments of the front and the back.
    pub(super) fn of_sides(spec: &ColourSpec, petiole: &Hsv, petiole_reach: f32) -> [Self; 2] {
        [(&spec.front, FRONT), (&spec.back, BACK)]
            .map(|(side, face)| Self::new(spec, side, face, petiole, petiole_reach))
    }

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
        }
    }

    /// What is seen of the blade, and through it.
    #[inline]
    pub(super) fn blade(&self, tissue: &Tissue) -> Shade {
        let tint = self.tint(tissue);
        let vein = tissue.vein.cover * tissue.vein.radius / (tissue.vein.radius + 0.12);
        shade(tint, 0.92 - 0.6 * vein)
    }

    /// The colour of the blade.
    #[inline]
    fn tint(&self, tissue: &Tissue) -> Tint {
        let Tissue { place, vein, lines, tones, grain, from_base } = tissue;
        let [broad, middle, fine] = place.noise;
        let m = self.mottle;
        // The scheme chosen, and the others faintly. Where a colour gives out, tissue makes its
        // front uneven; full strength and the reach stay where they are.
        let uneven =
            |w: f32| (w + 2.0 * m * w * (1.0 - w) * (0.5 * middle + 0.35 * fine)).clamp(0.0, 1.0);
        let weights = [
            uneven(place.from_veins),
            uneven((1.0 - place.edge.max(0.0) * self.per_spread_mm).max(0.0)),
            uneven(place.speckle),
        ];
        let types = [ColourType::FromVeins, ColourType::FromEdges, ColourType::Speckled];
        let mut tint = self.base;
        for ((w, off), r#type) in weights.into_iter().zip(self.off).zip(types) {
            tint = if r#type == self.r#type {
                tint.towards(self.alternate, w)
            } else {
                tint.towards(off, w * self.undertone)
            };
        }
        // Broad patches of greener and yellower tissue; deeper green along the larger veins, paler
        // in the middle of the panels between them.
        let panel = place.major * place.major / (place.major * place.major + 6.0);
        tint.hue += m * (5.0 * broad + 4.0 * middle - 3.0 * panel);
        tint.saturation *= 1.0 + m * (0.18 * middle - 0.10 * broad + 0.10 * fine);
        let light = 0.22 * broad
            + 0.16 * middle
            + 0.09 * fine
            + 0.16 * (panel - 0.6)
            + 0.07 * tones[0]
            + 0.06 * tones[1]
            + 0.10 * grain;
        tint.value *= 1.0 + m * light;
        // The fine nets, here stronger, there weaker.
        let [third, fourth, fifth] = self.face.lines;
        let coarse = (third * lines[0]).max(fourth * lines[1]) * (1.0 + 0.7 * fine);
        let net = coarse.max(fifth * lines[2]);
        tint = tint.towards(self.vein, net * m.sqrt());
        // A thin hardened rim.
        let rim = 1.0 - smooth(0.05, 0.45, place.edge);
        tint = tint.towards(self.vein, 0.30 * rim);
        // Green tissue thickens beside a vein.
        let flank = vein.groove / (vein.groove + 0.12);
        tint.value *= 1.0 - self.face.flank * flank * (1.0 - vein.cover);
        // The vein itself, paler along its crest.
        let shows = vein.radius / (vein.radius + self.face.half_shown_mm);
        let round = (vein.dome / vein.radius.max(1e-6)).min(1.0);
        let mut core = self.vein;
        core.value *= 0.90 + 0.16 * round + 0.05 * m * (fine + grain);
        let near = 1.0 - smooth(0.0, self.petiole_reach, *from_base);
        core = core.towards(self.petiole, 0.5 * near);
        tint.towards(core, vein.cover * shows * (0.65 + 0.35 * round))
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

/// A colour chosen by hand lets light of its own hue through: yellower, more saturated, and `share`
/// as bright.
#[inline]
fn shade(tint: Tint, share: f32) -> Shade {
    let through = Tint {
        hue: tint.hue + 0.25 * (60.0 - tint.hue).clamp(-40.0, 0.0),
        saturation: (1.45 * tint.saturation).min(1.0),
        value: tint.value * share,
    };
    Shade { reflected: tint.srgb(), through: through.srgb() }
}
