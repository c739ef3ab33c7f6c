//! What colours a blade: pigments as amounts, or colours chosen by hand; where which of them lies; and
//! how the leaf's age and health change them.
//!
//! Source of the schemes: Foster, appendix B.3, which spreads a second colour from the veins, the
//! edges or speckles. Here the schemes spread amounts of pigments (`amounts`) or, as in the source,
//! colours in hue, saturation and value (`hsv`).

mod amounts;
mod hsv;
mod mixer;
mod pace;
mod season;

pub use amounts::{Amounts, PigmentSpec};
pub(super) use season::{Condition, Course};
pub use season::{SenescenceSpec, StateSpec};

use super::brush::{Shade, Shades};
use super::damage::Injury;
use super::fields::VeinAt;
use super::guide::Place;
use super::petiole::StalkAt;
use super::strip::Strip;
use super::tissue::AREOLE;

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
    /// What the colours of a blade are made from.
    pub enum ColourModel {
        /// Amounts of pigments, by the light they absorb; they age and sicken.
        Pigments = "pigments",
        /// Hue, saturation and value as given.
        Hsv = "hsv",
    }
}

words! {
    /// What a base colour holds.
    pub enum Albedo {
        /// All light sent back, as a picture under an even sky shows it.
        Total = "total",
        /// The same less the mirror part of the surface, for renderers that add their own gloss.
        Diffuse = "diffuse",
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
    /// Colours of both sides and how they are spread (Foster, appendix B.3).
    pub struct ColourSpec {
        /// What colours are made from: `pigments` (amounts; season, maturity and health act on them)
        /// or `hsv` (the colours of `colour.front` and `colour.back` as they stand).
        model: choice(ColourModel, ColourModel::Pigments),
        /// What the base colour holds: `total` (all light sent back) or `diffuse` (less the mirror
        /// part of the surface).
        albedo: choice(Albedo, Albedo::Total),
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
        /// Pigments of the tissue (`colour.model = "pigments"`).
        pigments: group(PigmentSpec, PigmentSpec::default()),
        /// Upper side (`colour.model = "hsv"`).
        front: group(SideColour, SideColour::default()),
        /// Lower side (`colour.model = "hsv"`).
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
#[derive(Debug, Clone, Copy, Default)]
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
    /// Where this place stands between summer and litter, and how well it is.
    pub condition: Condition,
    /// What has been done to it.
    pub injury: Injury,
}

/// Colour types that spread something, in the order of the weights.
const SPREADING: [ColourType; 3] =
    [ColourType::FromVeins, ColourType::FromEdges, ColourType::Speckled];

impl Tissue {
    /// Weights of the colours from veins, from edges and from speckles. Where one gives out, tissue
    /// makes its front uneven; full strength and the reach stay where they are.
    #[inline(always)]
    fn weights(&self, per_spread_mm: f32, mottle: f32) -> [f32; 3] {
        let [broad, middle, fine] = self.place.noise;
        // It goes from areole to areole: as fine as the texels, and far less even than the distance.
        let tissue = 0.5 * middle + 0.35 * fine;
        let cells = 0.22 * self.tones[AREOLE] + 0.16 * self.tones[AREOLE + 1] + 0.14 * self.grain;
        let uneven = |w: f32, by: f32| -> f32 { (w + mottle * w * (1.0 - w) * by).clamp(0.0, 1.0) };
        let ragged = 6.0 * (broad + tissue + 2.2 * cells);
        [
            uneven(self.place.from_veins, 2.0 * (tissue + cells)),
            uneven((1.0 - self.place.edge.max(0.0) * per_spread_mm).max(0.0_f32), ragged),
            uneven(self.place.speckle, ragged),
        ]
    }

    /// How far from the larger veins, 0 on one and 1 in the middle of a wide panel.
    #[inline(always)]
    fn panel(&self) -> f32 {
        self.place.major * self.place.major / (self.place.major * self.place.major + 6.0)
    }

    /// Unevenness in lightness: broad patches, panels paler than the tissue along the larger veins,
    /// areoles that differ a little, grain.
    #[inline(always)]
    fn unevenness(&self) -> f32 {
        let [broad, middle, fine] = self.place.noise;
        0.22 * broad
            + 0.16 * middle
            + 0.09 * fine
            + 0.16 * (self.panel() - 0.6)
            + 0.07 * self.tones[0]
            + 0.06 * self.tones[1]
            + 0.10 * self.grain
    }

    /// How much of a side's veins is seen through its tissue: of the fine nets, here stronger, there
    /// weaker, and of the grown veins.
    #[inline(always)]
    fn veins_seen(&self, face: &Face, mottle: f32) -> [f32; 2] {
        let [third, fourth, fifth] = face.lines;
        let fine = self.place.noise[2];
        let coarse = (third * self.lines[0]).max(fourth * self.lines[1]) * (1.0 + 0.7 * fine);
        let net = coarse.max(fifth * self.lines[2]) * mottle.sqrt();
        let shows = self.vein.radius / (self.vein.radius + face.half_shown_mm);
        [net, self.vein.cover * shows * (0.65 + 0.35 * self.roundness())]
    }

    /// 1 on the crest of a vein, 0 at its foot.
    #[inline(always)]
    fn roundness(&self) -> f32 {
        (self.vein.dome / self.vein.radius.max(1e-6)).min(1.0)
    }

    /// How much the tissue lines a vein.
    #[inline(always)]
    fn flank(&self) -> f32 {
        self.vein.groove / (self.vein.groove + 0.12) * (1.0 - self.vein.cover)
    }
}

/// The colours of a leaf, ready to mix.
#[derive(Debug)]
pub(super) enum Pigments {
    /// By amounts.
    Amounts(Box<mixer::Mixer>),
    /// As chosen, front and back.
    Chosen(Box<hsv::Leaf>),
}

impl Pigments {
    /// The petiole colours the midrib within `petiole_reach` of the base (mm); `hurt` leaves have wounds.
    pub(super) fn new(
        spec: &ColourSpec,
        state: &StateSpec,
        petiole: &Hsv,
        petiole_reach: f32,
        hurt: bool,
    ) -> Self {
        match spec.model {
            ColourModel::Pigments => Self::Amounts(Box::new(mixer::Mixer::new(
                spec,
                state,
                petiole,
                petiole_reach,
                hurt,
            ))),
            ColourModel::Hsv => {
                Self::Chosen(Box::new(hsv::Leaf::new(spec, state, petiole, petiole_reach, hurt)))
            }
        }
    }

    /// What is seen of both sides of the blade, and through them.
    #[inline(always)]
    pub(super) fn paint(&self, strip: &Strip, shades: &mut [Shades; 2]) {
        match self {
            Self::Amounts(mixer) => mixer.paint(strip, shades),
            Self::Chosen(leaf) => leaf.paint(strip, shades),
        }
    }

    /// What is seen of both sides of the petiole; it is the midrib's colour at the blade and browner
    /// at the stem.
    #[inline(always)]
    pub(super) fn stalk(&self, stalk: &StalkAt, length: f32, grain: f32) -> [Shade; 2] {
        match self {
            Self::Amounts(mixer) => mixer.stalk(stalk, length, grain),
            Self::Chosen(leaf) => leaf.stalk(stalk, length, grain),
        }
    }
}

/// A colour chosen by hand lets light of its own hue through: yellower, more saturated, and `share`
/// as bright.
#[inline(always)]
fn shade(tint: Tint, share: f32) -> Shade {
    let through = Tint {
        hue: tint.hue + 0.25 * (60.0 - tint.hue).clamp(-40.0, 0.0),
        saturation: (1.45 * tint.saturation).min(1.0),
        value: tint.value * share,
    };
    Shade { reflected: tint.srgb(), through: through.srgb() }
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
