//! How pigments go from summer to litter, from bud to maturity, and in sickness.
//!
//! Every place has a season of its own: margin, tip, the sunny side and islands of tissue turn before
//! the rest, tissue along the larger veins last. Chlorophyll goes first, carotenoid stays longer,
//! anthocyanin is made meanwhile, brown comes at the end (J. Sanger, Ecology 52, 1971; order and pace
//! after M. Nakashima, Y. Yamakita, Life 13, 2023). All courses are smooth in the season, so that a
//! film of it does not flicker.

use super::Tissue;
use crate::parameter::parameters;
use crate::texture::tissue::smooth;

parameters! {
    /// The state of a leaf: colour and tissue only, its shape stays.
    pub struct StateSpec {
        /// 0 summer, 0.5 full autumn colour, 1 litter.
        season: number(0.0, 0.0..=1.0, ""),
        /// 0 just unfolded, 1 mature.
        maturity: number(1.0, 0.0..=1.0, ""),
        /// 1 well; less yellows between the veins, then dies from the margin.
        health: number(1.0, 0.0..=1.0, ""),
    }
}

parameters! {
    /// How a leaf turns.
    pub struct SenescenceSpec {
        /// Anthocyanin made in autumn: 0 for yellow leaves, 5 orange, 15 and more red.
        anthocyanin_ug_cm2: number(1.0, 0.0..=60.0, "µg/cm²"),
        /// Share of the green still there in full colour: 0.3 for leaves that fall dull green, 0.8 for
        /// evergreen ones, which turn only when they die.
        chlorophyll_kept: number(0.0, 0.0..=1.0, ""),
        /// Share of the carotenoid still there in full colour.
        carotenoid_kept: number(0.8, 0.0..=1.0, ""),
        /// Brown at the end.
        brown: number(1.2, 0.0..=3.0, ""),
        /// Red in that brown, of tannins, counted as anthocyanin.
        litter_red_ug_cm2: number(0.5, 0.0..=30.0, "µg/cm²"),
        /// Plates of tissue more or less than in summer at the end: dry tissue is full of air and pale,
        /// sodden tissue dark.
        litter_structure: number(0.55, -1.5..=1.5, "plates"),
        /// How unevenly it browns: 0 all alike, 1 in dark blotches and pale patches.
        blotches: number(0.6, 0.0..=1.0, ""),
        /// How much of the season lies between the first and the last place to turn.
        spread: number(0.25, 0.0..=2.0, ""),
        /// How much earlier the margin turns.
        margin_first: number(0.3, -1.0..=1.0, ""),
        /// How much earlier the tip turns.
        tip_first: number(0.15, -1.0..=1.0, ""),
        /// How much later tissue along the larger veins turns.
        veins_last: number(0.35, -1.0..=1.0, ""),
        /// How much earlier one side, that in the sun, turns.
        sun_side: number(0.15, -1.0..=1.0, ""),
        /// How much earlier some islands of tissue turn than others.
        islands: number(0.45, 0.0..=1.0, ""),
    }
}

/// A starved leaf is half green this far from its larger veins (mm).
const GREEN_MM: f32 = 1.3;

/// Where one place stands.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::texture) struct Condition {
    /// Its own season, 0 summer to 1 litter.
    pub season: f32,
    /// How far it has lost its green for want of health, 0–1.
    pub chlorosis: f32,
    /// How far it has died, 0–1.
    pub death: f32,
}

impl Condition {
    /// How dry it is, 0–1.
    #[inline(always)]
    pub(in crate::texture) fn dryness(&self) -> f32 {
        smooth(0.55, 1.0, self.season).max(self.death)
    }
}

/// Finds the condition of every place.
#[derive(Debug)]
pub(in crate::texture) struct Course {
    season: f32,
    spread: f32,
    sickness: f32,
    margin: f32,
    tip: f32,
    veins: f32,
    sun: f32,
    islands: f32,
    /// The margin's and the larger veins' influence reach so far (mm).
    reach: f32,
    per_length: f32,
    /// Which way the sun stands (per mm).
    sunward: [f32; 2],
}

impl Course {
    /// Of a leaf `length` long and of this area (mm, mm²); `sun_deg` is where the sun stands.
    pub(in crate::texture) fn new(
        spec: &SenescenceSpec,
        state: &StateSpec,
        length: f64,
        area: f64,
        sun_deg: f64,
    ) -> Self {
        let breadth = area.sqrt().max(1e-3);
        let sun = crate::units::Angle::from_degrees(sun_deg);
        Self {
            season: state.season as f32,
            spread: spec.spread as f32,
            sickness: 1.0 - state.health as f32,
            margin: spec.margin_first as f32,
            tip: spec.tip_first as f32,
            veins: spec.veins_last as f32,
            sun: spec.sun_side as f32,
            islands: spec.islands as f32,
            reach: (0.10 * breadth) as f32,
            per_length: (1.0 / length.max(1e-3)) as f32,
            sunward: [(sun.cos() / breadth) as f32, (sun.sin() / breadth) as f32],
        }
    }

    /// Whether every place is as in summer and well.
    pub(in crate::texture) fn is_plain(&self) -> bool {
        self.season == 0.0 && self.sickness == 0.0
    }

    /// The condition of a place (mm).
    #[inline(always)]
    pub(in crate::texture) fn at(&self, x: f32, y: f32, tissue: &Tissue) -> Condition {
        let place = &tissue.place;
        let [broad, middle, fine] = place.noise;
        let edge = place.edge.max(0.0);
        let margin = self.reach / (self.reach + edge);
        let by_vein = 0.35 * self.reach / (0.35 * self.reach + place.major);
        let tip = y * self.per_length - 0.5;
        let sunny = x * self.sunward[0] + (y - 0.5 / self.per_length) * self.sunward[1];
        let islands = 0.55 * broad + 0.4 * middle + 0.12 * fine + 0.06 * tissue.tones[1];
        // How early this place turns: 0 last, 1 first.
        let early = 0.5 + self.margin * (margin - 0.5) + self.tip * tip + self.sun * sunny
            - self.veins * (by_vein - 0.35)
            + self.islands * islands;
        let late = 1.0 - early.clamp(0.0, 1.0);
        let season = (self.season * (1.0 + self.spread) - self.spread * late).clamp(0.0, 1.0);
        // Green stays along the veins; what lies farthest from them, and the rim, dies first.
        let away = place.major * place.major / (place.major * place.major + GREEN_MM * GREEN_MM);
        let between = away * (0.72 + 0.28 * smooth(0.0, 0.5, place.vein));
        let starved = 0.05 + 1.05 * between + 0.2 * away * (middle + broad);
        let chlorosis = (self.sickness * 1.35 * starved).clamp(0.0, 1.0);
        let ill = 1.7 * self.sickness - 1.25 + 0.75 * margin + 0.3 * broad + 0.25 * middle
            - 0.3 * by_vein;
        let sick = if self.sickness > 0.0 { 1.0 } else { 0.0 };
        Condition { season, chlorosis, death: sick * smooth(0.0, 0.45, ill) }
    }
}

/// What the season has made of the pigments of a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turned {
    /// Share of the chlorophyll's colour left; see [`super::mixer`].
    pub chlorophyll: f32,
    /// Share of the carotenoid left.
    pub carotenoid: f32,
    /// Anthocyanin added (µg/cm²).
    pub anthocyanin: f32,
    /// Brown added.
    pub brown: f32,
    /// Plates added: tissue that dries is full of air.
    pub structure: f32,
    /// How far it has died, 0–1.
    pub end: f32,
}

impl Turned {
    #[inline(always)]
    pub(super) fn array(&self) -> [f32; 6] {
        let Self { chlorophyll, carotenoid, anthocyanin, brown, structure, end } = *self;
        [chlorophyll, carotenoid, anthocyanin, brown, structure, end]
    }

    #[inline(always)]
    pub(super) fn of(
        [chlorophyll, carotenoid, anthocyanin, brown, structure, end]: [f32; 6],
    ) -> Self {
        Self { chlorophyll, carotenoid, anthocyanin, brown, structure, end }
    }

    /// At a place whose season is `s`.
    #[inline]
    pub(super) fn at(s: f32, spec: &SenescenceSpec) -> Self {
        let end = smooth(0.53, 1.0, s);
        let (green, kept) = (spec.chlorophyll_kept as f32, spec.carotenoid_kept as f32);
        // Evenly and gently by halves: a plain smooth step would leap in the middle of a film.
        let left = 1.0 - 0.5 * (smooth(0.0, 0.7, s) + (s / 0.7).min(1.0));
        Self {
            chlorophyll: left + green * (1.0 - left) * (1.0 - end),
            carotenoid: (1.0 - (1.0 - kept) * smooth(0.2, 0.6, s)) * (1.0 - 0.45 * end),
            anthocyanin: spec.anthocyanin_ug_cm2 as f32
                * 0.5
                * (smooth(0.04, 0.66, s) + ((s - 0.04) / 0.62).clamp(0.0, 1.0))
                * (1.0 - 0.88 * end)
                + spec.litter_red_ug_cm2 as f32 * end,
            // Slowly at first: the first trace of brown darkens most.
            brown: spec.brown as f32 * end * (0.4 + 0.6 * end),
            structure: 0.4 * smooth(0.0, 0.68, s) + (spec.litter_structure as f32 - 0.4) * end,
            end,
        }
    }
}
