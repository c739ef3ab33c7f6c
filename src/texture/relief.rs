//! Heights: veins sunken in front and raised behind, tissue quilted between them, and panels that arch
//! between the larger ones.
//!
//! Source: Foster, section 2.3.6, for what is high and low, and the bump map; amplitudes follow
//! real leaves (a groove of 0.3–0.5 vein radii above, a cord of 1–1.5 below, quilting of 10–50 µm).
//! Departs from it: panels arch and the blade waves, by what looks right of each species under light that
//! comes from the side.

use super::damage::Injury;
use super::fields::VeinAt;
use super::guide::Place;
use super::petiole::StalkAt;
use super::tissue::smooth;
use crate::parameter::parameters;

parameters! {
    /// Heights of both sides, and how they take the light.
    pub struct ReliefSpec {
        /// Depth of the veins in front, in vein radii.
        front_depth: number(0.4, 0.0..=5.0, "vein radii"),
        /// Height of the veins behind, in vein radii.
        back_height: number(1.2, 0.0..=5.0, "vein radii"),
        /// Thickness of the blade between the veins.
        lamina_mm: number(0.22, 0.02..=5.0, "mm"),
        /// How far the tissue swells between the veins.
        quilting_mm: number(0.04, 0.0..=5.0, "mm"),
        /// How far the blade arches up between its primaries and secondaries.
        pleat_mm: number(0.3, 0.0..=10.0, "mm"),
        /// Long waves of the blade, highest at the margin.
        undulation_mm: number(0.3, 0.0..=10.0, "mm"),
        /// Fine speckle of the surface: 0 smooth, 1 rough (Foster's leaf roughness).
        roughness: number(0.35, 0.0..=1.0, ""),
        /// Shine of the upper side: 0 matt, 1 glossy; the lower side has a third of it.
        specularity: number(0.3, 0.0..=1.0, ""),
    }
}

/// What relief is made of, at one texel.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ground {
    /// The guide.
    pub place: Place,
    /// The veins.
    pub vein: VeinAt,
    /// Distance to the border of an areole of the larger net (mm).
    pub border: f32,
    /// Grain of the surface, −1 – 1.
    pub grain: f32,
}

/// Heights over the plain blade (mm), each side's own way up.
#[derive(Debug)]
pub(super) struct Relief {
    front_depth: f32,
    back_height: f32,
    lamina: f32,
    quilting: f32,
    pleat: f32,
    undulation: f32,
    /// Swell of an areole (mm), as far as the texels show areoles.
    areole: f32,
    roughness: f32,
    widest: f32,
    root: f32,
    stalk: f32,
}

/// Height of the grain at full roughness (mm): above this it would be shape, not surface.
const GRAIN_HEIGHT_MM: f32 = 0.012;

/// The tissue has swollen half way at these distances from a larger, and from any vein (mm).
const SWELL_MM: [f32; 2] = [1.6, 0.35];

/// The blade's waves are half as high this far from the margin (mm).
const WAVY_MM: f32 = 8.0;

/// How far dead tissue shrinks, a rim stands up and a mine is blown up, as shares of the lamina.
const SHRUNK: f32 = 0.12;
const RIM: f32 = 0.22;
const BLISTER: f32 = 0.25;

impl Relief {
    /// `widest` is the greatest vein radius, `root` that of the midrib at the petiole, `stalk` that
    /// of the petiole (mm); `shown` is how much of the areoles the texels can show (0–1).
    pub(super) fn new(spec: &ReliefSpec, widest: f64, root: f64, stalk: f64, shown: f32) -> Self {
        Self {
            front_depth: spec.front_depth as f32,
            back_height: spec.back_height as f32,
            lamina: spec.lamina_mm as f32,
            quilting: spec.quilting_mm as f32,
            pleat: spec.pleat_mm as f32,
            undulation: spec.undulation_mm as f32,
            areole: 0.3 * spec.quilting_mm as f32 * shown,
            roughness: spec.roughness as f32,
            widest: widest as f32,
            root: root as f32,
            stalk: stalk as f32,
        }
    }

    /// No height lies further than this from the plain blade (mm).
    pub(super) fn bound(&self) -> f32 {
        let veins = self.front_depth.max(self.back_height) * self.widest.max(self.root);
        let blade = self.pleat + self.undulation;
        let tissue = blade + self.quilting + self.areole + GRAIN_HEIGHT_MM * self.roughness;
        // Never nothing: a flat leaf still needs a scale.
        ((veins + tissue).max(self.stalk) * 1.02).max(0.01)
    }

    /// From front to back (mm): the lamina, and the veins in it, which are round.
    #[inline(always)]
    pub(super) fn thickness(&self, ground: &Ground) -> f32 {
        self.lamina.max(2.0 * ground.vein.dome) + 0.5 * self.lamina * ground.vein.cover
    }

    /// No place is thicker than this (mm).
    pub(super) fn thickest(&self) -> f32 {
        let veins = 2.0 * self.widest.max(self.root);
        (self.lamina.max(veins) + 0.5 * self.lamina).max(2.0 * self.stalk) * 1.001
    }

    /// Front and back.
    #[inline(always)]
    pub(super) fn heights(&self, ground: &Ground) -> [f32; 2] {
        let Ground { place, vein, border, grain } = ground;
        let swell = |distance: f32, half: f32| {
            let d2 = distance * distance;
            d2 / (d2 + half * half)
        };
        let quilt = self.quilting
            * (0.65 * swell(place.major, SWELL_MM[0]) + 0.35 * swell(place.vein, SWELL_MM[1]));
        let areole = self.areole * border / (border + 0.08);
        let rough = self.roughness * GRAIN_HEIGHT_MM * grain;
        // The larger veins are stiff: what lies between them bends.
        let at_margin = WAVY_MM / (WAVY_MM + place.edge.max(0.0));
        let arch = place.panel * (self.pleat + self.undulation * at_margin * place.noise[0]);
        // A sunken vein is a wide groove, a raised one a round cord with a skirt.
        let groove = self.front_depth * (0.7 * vein.groove + 0.3 * vein.dome);
        let cord = self.back_height * (0.3 * vein.groove + 0.7 * vein.dome);
        [arch + quilt + areole + rough - groove, cord - arch - 0.7 * quilt - areole + rough]
    }

    /// What injuries add to the heights of both sides (mm): dead and dry tissue shrinks, a mine is a blister,
    /// and what is walled off is a rim.
    #[inline(always)]
    pub(super) fn raised(&self, injury: &Injury) -> [f32; 2] {
        let shrunk = -SHRUNK * self.lamina * injury.brown.max(injury.pale - injury.blown);
        let rim = RIM * self.lamina * injury.dark;
        let blister = BLISTER * self.lamina * injury.blown;
        [shrunk + rim + blister, shrunk + rim + 0.5 * blister]
    }

    /// The share of the tissue that injuries leave.
    #[inline(always)]
    pub(super) fn left(injury: &Injury) -> f32 {
        (1.0 - 0.4 * injury.brown) * (1.0 - 0.6 * injury.pale)
    }

    /// Front and back of the petiole, which runs into the groove and the cord of the midrib.
    #[inline(always)]
    pub(super) fn stalk_heights(&self, stalk: &StalkAt) -> [f32; 2] {
        let free = smooth(0.0, 5.0, stalk.along / stalk.radius.max(1e-3));
        let dome = stalk.dome;
        let blend = |midrib: f32| midrib + (1.0 - midrib) * free;
        [dome * blend(-self.front_depth), dome * blend(self.back_height.min(1.0))]
    }

    /// Foster's bump of front and back: the blade at 128, veins lower in front and higher behind.
    #[inline(always)]
    pub(super) fn bumps(&self, ground: &Ground) -> [f32; 2] {
        let vein = self.bump_of_vein(ground.vein.radius) * ground.vein.cover;
        let speckle = BUMP_SPECKLE * self.roughness * ground.grain;
        [128.5 - vein + speckle, 128.5 + vein + speckle]
    }

    /// The petiole lies at the height of the root.
    pub(super) fn stalk_bumps(&self) -> [f32; 2] {
        let root = self.bump_of_vein(self.root);
        [128.5 - root, 128.5 + root]
    }

    /// By the root of the radius: linear, all but the midrib would vanish in 8 bits.
    #[inline(always)]
    fn bump_of_vein(&self, radius: f32) -> f32 {
        BUMP_VEIN * (radius / self.widest.max(1e-6)).min(1.0).sqrt()
    }
}

/// Depth of the widest vein, and of the roughest speckle, in steps of 8 bits.
const BUMP_VEIN: f32 = 90.0;
const BUMP_SPECKLE: f32 = 20.0;
