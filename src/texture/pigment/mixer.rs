//! Pigments as amounts, mixed before they are looked at: what a place holds decides what it sends back
//! and lets through.
//!
//! Chlorophyll, carotenoid and anthocyanin per area, brown, and the number of plates of tissue go
//! through [`spectrum`](crate::texture::spectrum). Veins hold a share of the chlorophyll in more
//! plates; the lower side is looser tissue with less of everything under a bloom of wax or hair.

use super::season::Turned;
use super::{
    Amounts, BACK, ColourSpec, FRONT, Hsv, SPREADING, SenescenceSpec, StateSpec, Tissue, pace,
    shade,
};
use crate::raster::color::Tint;
use crate::texture::brush::{Shade, Shades};
use crate::texture::lattice::{self, Lattice};
use crate::texture::petiole::StalkAt;
use crate::texture::strip::{LANES, Lane, Strip, texel};
use crate::texture::tissue::{AREOLE, smooth};

/// Amounts at one place: chlorophyll, carotenoid, anthocyanin, brown, structure.
type Mix = [f32; 5];

/// Dead tissue, and tissue of which only the skins are left.
const DEAD: Mix = [0.4, 3.0, 0.1, 1.6, 2.1];
const MINED: Mix = [1.8, 2.2, 0.3, 0.12, 2.2];

/// More brown where a plant has walled a wound off.
const TANNIN: f32 = 3.0;

/// The colour of a bloom (sRGB): fine wax and hairs scatter blue a little more.
const BLOOM: [f32; 3] = [0.77, 0.80, 0.82];

/// Of the light through a large vein so much stays in it, half of that in one of this radius (mm).
const VEIN_KEEPS: f32 = 0.65;
const HALF_KEPT_MM: f32 = 0.3;

/// Chlorophyll is faded where its colour changes evenly: in c / (c + this).
const HALF_GREEN: f32 = 12.0;

/// Places of the season that are worked out beforehand.
const SEASONS: usize = 256;

/// Mixes the pigments of a leaf.
#[derive(Debug)]
pub(in crate::texture) struct Mixer {
    lattice: &'static Lattice,
    /// Strength of the second tissue spread from veins, from edges and by speckles: 1 for the type
    /// chosen; and of the undertones of the others.
    chosen: [f32; 3],
    faint: [f32; 3],
    per_spread_mm: f32,
    mottle: f32,
    leaf: Mix,
    alternate: Mix,
    vein_chlorophyll: f32,
    vein_structure: f32,
    back_chlorophyll: f32,
    back_structure: f32,
    back_bloom: f32,
    back_brown: f32,
    back_red: f32,
    front_bloom: f32,
    /// Chlorophyll's colour, and the other pigments, of a leaf this young, as shares.
    young: [f32; 2],
    flush: f32,
    seasons: Vec<Turned>,
    summer: bool,
    /// How unevenly it browns; 0 where nothing has browned yet.
    blotches: f32,
    /// Whether anything dies before its season.
    withers: bool,
    /// How much of the lower side a felt hides, 0–1.
    felt: f32,
    /// Whether neither sickness nor wounds count.
    sound: bool,
    petiole: Tint,
    petiole_reach: f32,
}

/// At the base a vein of the first of these radii is in the tissue, one of the second has come out of it:
/// shares of the way over which the midrib takes the petiole's colour, six radii of its own.
const COMES_OUT: [f32; 2] = [0.04, 0.1];

impl Mixer {
    pub(super) fn new(
        spec: &ColourSpec,
        state: &StateSpec,
        petiole: &Hsv,
        petiole_reach: f32,
        hurt: bool,
    ) -> Self {
        let pigments = &spec.pigments;
        let mix = |amounts: &Amounts| amounts.array().map(|v| v as f32);
        let youth = 1.0 - state.maturity as f32;
        // A petiole turns, and dries, with the leaf it carries.
        let turned = smooth(0.2, 0.6, state.season as f32);
        let ill = 1.0 - state.health as f32;
        let dry = smooth(0.6, 1.0, state.season as f32).max(smooth(0.7, 1.0, ill));
        let petiole = petiole.tint();
        let red = smooth(1.0, 18.0, pigments.autumn.anthocyanin_ug_cm2 as f32);
        let ripe = Tint { hue: 50.0 - 38.0 * red, saturation: 0.52, value: 0.66 - 0.16 * red };
        let ripe = ripe.unrolled(petiole);
        let turned = 0.8 * turned * (1.0 - pigments.autumn.chlorophyll_kept as f32);
        let dead = Tint { hue: 28.0, saturation: 0.42, value: 0.40 }.unrolled(petiole);
        let mut mixer = Self {
            lattice: lattice::of(spec.albedo),
            chosen: SPREADING.map(|r#type| f32::from(u8::from(r#type == spec.r#type))),
            faint: SPREADING
                .map(|r#type| if r#type == spec.r#type { 0.0 } else { spec.undertone as f32 }),
            per_spread_mm: 1.0 / (spec.spread_mm as f32).max(1e-6),
            mottle: spec.mottle as f32,
            leaf: mix(&pigments.leaf),
            alternate: mix(&pigments.alternate),
            vein_chlorophyll: pigments.vein_chlorophyll as f32,
            vein_structure: pigments.vein_structure as f32,
            back_chlorophyll: pigments.back_chlorophyll as f32,
            back_structure: pigments.back_structure as f32,
            back_bloom: pigments.back_bloom as f32,
            back_brown: pigments.back_brown as f32,
            felt: smooth(0.0, 0.8, pigments.back_brown as f32),
            back_red: pigments.back_anthocyanin_ug_cm2 as f32,
            front_bloom: pigments.front_bloom as f32,
            young: [1.0 - 0.33 * youth, 1.0 - 0.5 * youth],
            flush: youth * pigments.flush_anthocyanin_ug_cm2 as f32,
            seasons: vec![Turned::at(0.0, &pigments.autumn)],
            summer: state.season == 0.0,
            blotches: if state.season > 0.0 { pigments.autumn.blotches as f32 } else { 0.0 },
            withers: hurt || state.health < 1.0,
            sound: false,
            petiole: petiole.towards(ripe, turned).towards(dead, dry),
            petiole_reach,
        };
        if !mixer.summer {
            mixer.seasons = mixer.course(&pigments.autumn);
        }
        mixer
    }

    /// What evenly spaced times of the season make of the pigments.
    fn course(&self, spec: &SenescenceSpec) -> Vec<Turned> {
        let at = |place: f32| Turned::at(place, spec);
        let even = |i: usize| i as f32 / (SEASONS - 1) as f32;
        // Of the tissue as such in front and behind, where it is less and where it is more green, where it
        // rots, and of a vein.
        let mut rotting = Tissue::default();
        rotting.place.noise = [0.5, 0.5, 0.8];
        let mixes = |turned: &Turned| {
            let tissue = Tissue::default();
            let [upper, faint, pale, deep] = [1.0, 0.35, 0.7, 1.8].map(|green| {
                let mut mix = self.leaf;
                mix[0] *= green;
                self.aged(mix, &tissue, turned, 1.0)
            });
            let rotten = self.aged(self.leaf, &rotting, turned, 1.0);
            [upper, faint, pale, deep, rotten, self.behind(upper), self.vein(&tissue, &upper)]
        };
        let mixes: Vec<[Mix; 7]> = (0..SEASONS).map(|i| mixes(&at(even(i)))).collect();
        let mut changes = vec![0.0_f32; SEASONS - 1];
        for which in 0..7 {
            let mut colours = Vec::new();
            for mixes in mixes.chunks(LANES) {
                let mut lanes = [[0.0; LANES]; 5];
                for (i, mixes) in mixes.iter().enumerate() {
                    (0..5).for_each(|k| lanes[k][i] = mixes[which][k]);
                }
                let mut seen = [[0.0; LANES]; 6];
                self.lattice.read(&lanes, &mut seen);
                colours.extend((0..mixes.len()).map(|i| texel(&seen, i)));
            }
            for (change, pair) in changes.iter_mut().zip(colours.windows(2)) {
                let channels = pair[0].iter().zip(&pair[1]);
                *change = channels.map(|(a, b)| (a - b).abs()).fold(*change, f32::max);
            }
        }
        // Every place has its own season, which is shorter than the leaf's.
        let fastest = pace::FASTEST / (1.0 + spec.spread as f32);
        pace::paced(&changes, fastest).into_iter().map(at).collect()
    }

    /// The same leaf, as if it were well and nothing had been done to it.
    pub(super) fn sound(self) -> Self {
        Self { sound: true, ..self }
    }

    /// What is seen of both sides of the blade, and through them.
    #[inline(always)]
    pub(super) fn paint(&self, strip: &Strip, [front, back]: &mut [Shades; 2]) {
        let turned = self.turned(strip.seasons());
        let (mut above, mut below) = ([[0.0; LANES]; 5], [[0.0; LANES]; 5]);
        let (mut bloom, mut passing) = ([0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let mut tissue = strip.tissue(i);
            if self.sound {
                (tissue.condition, tissue.injury) = Default::default();
            }
            let turned = Turned::of(texel(&turned, i));
            let lamina = self.lamina(&tissue, &turned);
            let vein = self.vein(&tissue, &lamina);
            // A vein is pale and would let much light through, but a large one is a cord.
            let square = tissue.vein.radius * tissue.vein.radius;
            let cord = square / (square + HALF_KEPT_MM * HALF_KEPT_MM);
            passing[i] = 1.0 - VEIN_KEEPS * cord * tissue.vein.cover;
            let [upper, lower] = [(FRONT, 0.0), (BACK, self.felt)].map(|(face, felt)| {
                let [net, seen] = tissue.veins_seen(&face, self.mottle);
                // A felt hides the net, and of the veins all but what stands out of it.
                let bare = 1.0 - felt * (1.0 - cord);
                (seen * bare).max(0.8 * net * (1.0 - felt)).min(1.0)
            });
            let upper = mixed(lamina, vein, upper);
            // A bloom sends back some of the light; veins have less of it, and what is dead none.
            let dead = turned.end.max(tissue.condition.death);
            let living = (1.0 - tissue.injury.brown) * (1.0 - 0.5 * dead);
            bloom[i] = self.back_bloom * (1.0 - 0.4 * lower) * living;
            let lower = self.behind(mixed(lamina, vein, lower));
            for k in 0..5 {
                (above[k][i], below[k][i]) = (upper[k], lower[k]);
            }
        }
        self.lattice.read(&above, front);
        self.lattice.read(&below, back);
        let white = |c: usize, value: f32, bloom: f32| value + (BLOOM[c] - value) * bloom;
        for c in 0..3 {
            for i in 0..LANES {
                front[c][i] = white(c, front[c][i], self.front_bloom);
                back[c][i] = white(c, back[c][i], bloom[i]);
                front[c + 3][i] *= (1.0 - 0.5 * bloom[i]) * passing[i];
            }
            // Light meets the same tissue from either side.
            back[c + 3] = front[c + 3];
        }
        if strip.y.abs() < self.petiole_reach {
            self.add_petiole(strip, [front, back]);
        }
    }

    /// The midrib takes the petiole's colour at the base.
    fn add_petiole(&self, strip: &Strip, sides: [&mut Shades; 2]) {
        let petiole = shade(self.petiole, 0.3);
        let [some, all] = COMES_OUT.map(|share| share * self.petiole_reach);
        for (shades, face) in sides.into_iter().zip([&FRONT, &BACK]) {
            for i in 0..strip.len {
                let tissue = strip.tissue(i);
                let near = 1.0 - smooth(0.0, self.petiole_reach, tissue.from_base);
                // A vein is seen through the tissue over it, from which the petiole comes out.
                let seen_through = tissue.veins_seen(face, self.mottle)[1];
                let bare = near * smooth(some, all, tissue.vein.radius);
                let share = near * (seen_through + (tissue.vein.cover - seen_through) * bare);
                Shade::at(shades, i).mixed(petiole, share).put(shades, i);
            }
        }
    }

    /// The same tissue as seen from below: looser, with less of everything.
    #[inline(always)]
    fn behind(&self, mut mix: Mix) -> Mix {
        mix[0] *= self.back_chlorophyll;
        mix[1] *= 0.5 + 0.5 * self.back_chlorophyll;
        // Red felt bleaches as the leaf turns brown.
        let felt = self.back_red / (1.0 + mix[3]);
        mix[2] = mix[2] * (0.25 + 0.5 * self.back_chlorophyll) + felt;
        mix[3] = 0.85 * mix[3] + self.back_brown;
        mix[4] += self.back_structure;
        mix
    }

    /// The tissue between the veins.
    #[inline(always)]
    fn lamina(&self, tissue: &Tissue, turned: &Turned) -> Mix {
        let m = self.mottle;
        // The scheme chosen, and the others faintly: deeper green beside veins, thinner towards the
        // margin, a trace of brown in spots.
        let weights = tissue.weights(self.per_spread_mm, m);
        let mut mix = self.leaf;
        for (w, chosen) in weights.into_iter().zip(self.chosen) {
            mix = mixed(mix, self.alternate, w * chosen);
        }
        let [veins, edges, speckles] = std::array::from_fn(|k| weights[k] * self.faint[k]);
        let mut green = (1.0 + 1.1 * veins) * (1.0 - 0.5 * edges);
        let brown = 0.25 * speckles;
        // No two areoles hold the same; green tissue thickens beside a vein, and thins at the rim.
        let [broad, middle, fine] = tissue.place.noise;
        green *= 1.0 - (1.7 * m * tissue.unevenness()).clamp(-0.8, 0.7);
        green *= 1.0 + 0.2 * tissue.flank();
        let rim = 1.0 - smooth(0.05, 0.45, tissue.place.edge);
        green *= 1.0 - 0.35 * rim;
        mix[0] *= green;
        mix[1] *= 1.0 + 0.3 * m * (middle - broad);
        mix[2] *= 1.0 + m * (0.8 * middle + 0.5 * fine);
        mix[3] += brown;
        mix[4] += 0.15 * m * fine + 0.1 * rim;
        self.aged(mix, tissue, turned, 1.0 + 0.9 * m * (broad + 0.5 * middle))
    }

    /// Youth, season, sickness and injuries, in the order in which they come. `red` is how readily
    /// this place reddens.
    #[inline(always)]
    fn aged(&self, mut mix: Mix, tissue: &Tissue, turned: &Turned, red: f32) -> Mix {
        let condition = &tissue.condition;
        // Chlorophyll fades where its colour changes evenly.
        let left = turned.chlorophyll * self.young[0] * (1.0 - 0.86 * condition.chlorosis);
        let green = mix[0] / (mix[0] + HALF_GREEN) * left;
        mix[0] = HALF_GREEN * green / (1.0 - green);
        mix[1] *= turned.carotenoid * self.young[1] * (1.0 - 0.3 * condition.chlorosis);
        // What was red in summer bleaches.
        mix[2] *= self.young[1] * (1.0 - 0.8 * turned.end);
        mix[2] += turned.anthocyanin * red.max(0.2) + self.flush * red.max(0.4);
        mix[3] += turned.brown;
        mix[4] += turned.structure;
        if self.blotches > 0.0 {
            self.decay(&mut mix, tissue, turned);
        }
        mix = mixed(mix, DEAD, condition.death);
        mix = mixed(mix, MINED, tissue.injury.pale);
        mix = mixed(mix, DEAD, tissue.injury.brown);
        if self.withers {
            withered(&mut mix, tissue);
        }
        mix[3] += TANNIN * tissue.injury.dark;
        mix
    }

    /// Dead tissue rots from place to place: dark where it has gone far, paler and yellower where it has
    /// not, dotted all over.
    #[inline(always)]
    fn decay(&self, mix: &mut Mix, tissue: &Tissue, turned: &Turned) {
        let [broad, middle, fine] = tissue.place.noise;
        let patch = 1.2 * broad + 0.8 * middle + 0.45 * fine + 0.25 * tissue.tones[AREOLE];
        let far = self.blotches * turned.end * patch.clamp(-1.0, 1.0);
        let dots = smooth(0.30, 0.62, 0.55 * tissue.grain + 0.6 * fine);
        mix[1] *= 1.0 - 0.5 * far;
        mix[3] *= (1.0 + 0.8 * far + 0.6 * self.blotches * turned.end * dots).max(0.3);
        mix[4] -= 0.35 * far;
    }

    /// What the season has made of the pigments at each place; see [`Turned`].
    #[inline(always)]
    fn turned(&self, seasons: &Lane) -> [Lane; 6] {
        let mut turned = [[0.0; LANES]; 6];
        if self.summer {
            for (lane, value) in turned.iter_mut().zip(self.seasons[0].array()) {
                *lane = [value; LANES];
            }
            return turned;
        }
        for (lane, season) in seasons.iter().enumerate() {
            let place = season.clamp(0.0, 1.0) * (SEASONS - 1) as f32;
            let i = (place as usize).min(SEASONS - 2);
            let (a, b) = (self.seasons[i].array(), self.seasons[i + 1].array());
            for k in 0..6 {
                turned[k][lane] = a[k] + (b[k] - a[k]) * (place - i as f32);
            }
        }
        turned
    }

    /// A vein in such tissue: pale, the larger the paler, and brown before the tissue is.
    #[inline(always)]
    fn vein(&self, tissue: &Tissue, lamina: &Mix) -> Mix {
        let large = tissue.vein.radius / (tissue.vein.radius + 0.15);
        let crest = tissue.roundness();
        [
            lamina[0] * self.vein_chlorophyll,
            lamina[1] * (0.35 + 0.3 * self.vein_chlorophyll),
            lamina[2] * 0.6,
            lamina[3] * 0.75 + 0.02,
            lamina[4] + self.vein_structure * (0.45 + 0.35 * large + 0.2 * crest),
        ]
    }

    pub(super) fn stalk(&self, stalk: &StalkAt, length: f32, grain: f32) -> [Shade; 2] {
        let round = stalk.dome / stalk.radius.max(1e-6);
        let stem = smooth(0.72, 1.05, stalk.along / length.max(1e-6));
        let mut tint = self.petiole;
        tint.hue -= 14.0 * stem;
        tint.value *=
            (0.86 + 0.18 * round) * (1.0 - 0.22 * stem) * (1.0 + 0.2 * self.mottle * grain);
        [shade(tint, 0.3); 2]
    }
}

/// What has died before its season dries from place to place: darker here, paler and yellower there.
#[inline(always)]
fn withered(mix: &mut Mix, tissue: &Tissue) {
    let [broad, middle, fine] = tissue.place.noise;
    let patch = 1.1 * broad + 0.9 * middle + 0.5 * fine + 0.2 * tissue.tones[AREOLE];
    let dead = tissue.condition.death.max(tissue.injury.brown);
    let far = dead * patch.clamp(-1.0, 1.0);
    mix[1] *= 1.0 - 0.4 * far;
    mix[3] *= 1.0 + 0.45 * far;
    mix[4] -= 0.3 * far;
}

#[inline(always)]
fn mixed(a: Mix, b: Mix, share: f32) -> Mix {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share)
}
