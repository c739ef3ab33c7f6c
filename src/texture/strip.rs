//! Some texels of a row, side by side: everything known of a place put together.
//!
//! What is computed for a texel is computed for all of a strip before the next thing is, in arrays of
//! one number each, so that a compiler can take eight texels at a time; nothing here depends on its
//! doing so.

use super::damage::{Injury, WoundRow};
use super::fields::{VeinAt, VeinRows};
use super::guide::{self, GuideRow, Place};
use super::petiole::StalkAt;
use super::pigment::{Condition, Tissue};
use super::relief::Ground;
use super::scene::Scene;
use super::tissue::{self, smooth};
use crate::geometry::noise::GradientRow;
use crate::raster::coverage::stroke_share;

/// Texels in a strip.
pub(super) const LANES: usize = 64;

/// A number of every texel of a strip.
pub(super) type Lane = [f32; LANES];

/// Several numbers of one texel.
#[inline(always)]
pub(super) fn texel<const N: usize>(lanes: &[Lane; N], i: usize) -> [f32; N] {
    std::array::from_fn(|k| lanes[k][i])
}

/// Fibres are longer than wide by the inverse of this.
const FIBRE_STRETCH: f32 = 0.08;

/// Further than this outside a skeletonised area (mm) nothing of it is seen.
const FAR_OUTSIDE_MM: f32 = -3.0;

/// Veins of this radius (mm) keep half of their green where all around them is eaten.
const ALIVE_MM: f32 = 0.2;

/// What covers less of a texel is not there in 8 bits.
pub(super) const LEAST_SEEN: f32 = 0.5 / 255.0;

/// The net is bent by this much of the middle and of the fine noise (mm), along and across.
const BENT_MM: [[f32; 2]; 2] = [[0.5, 0.25], [-0.4, 0.45]];

/// The grain of a row.
#[derive(Debug)]
pub(super) struct Grain {
    size_mm: f32,
    row: GradientRow,
}

impl Grain {
    pub(super) fn new(scene: &Scene<'_>) -> Self {
        Self { size_mm: tissue::grain_size(scene.layout.per_mm), row: GradientRow::default() }
    }

    /// Makes ready for a row at `y` between two ends (mm).
    pub(super) fn prepare(&mut self, left: f32, right: f32, y: f32, seed: u32) {
        let size = self.size_mm;
        self.row.prepare(left / size, right / size, y / size, seed ^ 0x77);
    }
}

/// Texels of one row. Lanes past `len` repeat the last.
#[derive(Debug)]
pub(super) struct Strip {
    pub(super) start: usize,
    pub(super) len: usize,
    /// Where they lie (mm).
    pub(super) x: Lane,
    pub(super) y: f32,
    /// Edge, major, vein, from veins, speckle, three noises, panel, as in [`Place`].
    guide: [Lane; guide::NUMBERS],
    vein: Veins,
    lines: [Lane; 3],
    tones: [Lane; 3],
    border: Lane,
    grain: Lane,
    /// How much of a texel the blade covers.
    pub(super) blade: Lane,
    /// Season, chlorosis, death, as in [`Condition`].
    condition: [Lane; 3],
    /// Brown, dark, pale, blown, as in [`Injury`].
    injured: [Lane; 4],
    /// Whether the petiole is here.
    pub(super) stalked: bool,
    pub(super) stalk: [StalkAt; LANES],
    /// Grain of the stalk, −1 – 1.
    pub(super) fibre: Lane,
}

/// What the veins are; see [`VeinAt`].
#[derive(Debug)]
struct Veins {
    cover: Lane,
    radius: Lane,
    dome: Lane,
    groove: Lane,
    order: [u8; LANES],
}

impl Strip {
    pub(super) fn empty() -> Self {
        let zero = [0.0; LANES];
        Self {
            start: 0,
            len: 0,
            x: zero,
            y: 0.0,
            guide: [zero; guide::NUMBERS],
            vein: Veins { cover: zero, radius: zero, dome: zero, groove: zero, order: [0; LANES] },
            lines: [zero; 3],
            tones: [zero; 3],
            border: zero,
            grain: zero,
            blade: zero,
            condition: [zero; 3],
            injured: [zero; 4],
            stalked: false,
            stalk: [StalkAt::default(); LANES],
            fibre: zero,
        }
    }

    /// Goes to the texels `start..start + len` of row `y` of the texture.
    #[inline(always)]
    pub(super) fn go_to(&mut self, scene: &Scene<'_>, start: usize, len: usize, y: usize) {
        (self.start, self.len) = (start, len);
        let mm = 1.0 / scene.layout.per_mm;
        let [left, bottom] = scene.layout.frame.min.as_vec2().to_array();
        let (left, first, last) = (left + 0.5 * mm, start as i32, len as i32 - 1);
        for i in 0..LANES {
            self.x[i] = left + (first + (i as i32).min(last)) as f32 * mm;
        }
        self.y = bottom + (scene.layout.size as f32 - y as f32 - 0.5) * mm;
    }

    #[inline(always)]
    pub(super) fn read_guide(&mut self, row: &GuideRow<'_>) {
        row.read(self.start..self.start + self.len, &mut self.guide);
    }

    #[inline(always)]
    pub(super) fn read_veins(&mut self, rows: &VeinRows, line: usize) {
        let from = rows.index(line, self.start);
        let (len, vein) = (self.len, &mut self.vein);
        for (lane, plane) in [
            (&mut vein.cover, &rows.cover),
            (&mut vein.radius, &rows.radius),
            (&mut vein.dome, &rows.dome2),
            (&mut vein.groove, &rows.groove),
        ] {
            lane[..len].copy_from_slice(&plane[from..from + len]);
        }
        for dome in &mut vein.dome {
            *dome = dome.sqrt() * rows.mm;
        }
        if !rows.order.is_empty() {
            vein.order[..len].copy_from_slice(&rows.order[from..from + len]);
        }
    }

    /// The blade's cover of these texels, and the petiole's where it is in the rows.
    #[inline(always)]
    pub(super) fn read_cover(&mut self, cover: &[f32], stalk: Option<&[StalkAt]>) {
        self.blade = [0.0; LANES];
        self.blade[..self.len].copy_from_slice(cover);
        self.stalked = stalk.is_some_and(|row| row.iter().any(|stalk| stalk.cover > 0.0));
        if let Some(stalk) = stalk.filter(|_| self.stalked) {
            self.stalk[..self.len].copy_from_slice(stalk);
            self.stalk[self.len..].fill(StalkAt::default());
        }
    }

    /// Nets and grain.
    #[expect(clippy::needless_range_loop, reason = "several arrays go along together")]
    #[inline(always)]
    pub(super) fn read_structure(&mut self, scene: &Scene<'_>, grain: &Grain) {
        let (mut bent, mut distance, mut number) = ([[0.0; LANES]; 2], [0.0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            // The net is drawn out and bent by the tissue's own unevenness.
            let (middle, fine) = (self.guide[6][i], self.guide[7][i]);
            bent[0][i] = self.x[i] + BENT_MM[0][0] * middle + BENT_MM[0][1] * fine;
            bent[1][i] = self.y + BENT_MM[1][0] * middle + BENT_MM[1][1] * fine;
        }
        for (k, net) in scene.layout.nets.iter().enumerate() {
            let Some(net) = net else {
                continue;
            };
            let (lines, tones) = (&mut self.lines[k], &mut self.tones[k]);
            net.along(&bent, &mut distance, &mut number);
            let [none, full] = tissue::AWAY_MM[k];
            let line = tissue::LINE_MM[k] * scene.layout.per_mm;
            let half = (0.7 * line).max(0.7);
            for i in 0..LANES {
                let shown = net.shown * smooth(none, full, self.guide[2][i]);
                lines[i] = shown * stroke_share(distance[i] * scene.layout.per_mm, line, half);
                tones[i] = shown * (2.0 * number[i] - 1.0);
            }
            if k == tissue::AREOLE {
                self.border = distance;
            }
        }
        let size = grain.size_mm;
        self.grain = grain.row.along(&self.x.map(|x| x / size));
        if self.stalked {
            for i in 0..LANES {
                // The stalk is made of fibres: its grain is drawn out along it.
                let along = self.stalk[i].along * FIBRE_STRETCH / (2.0 * size);
                let across = self.x[i] / (2.0 * size);
                let seed = scene.layout.seed ^ 0x99;
                self.fibre[i] = crate::geometry::noise::gradient(across, along, seed);
            }
        }
    }

    /// What is gone, and what has been done to the rest.
    pub(super) fn read_wounds(&mut self, scene: &Scene<'_>, row: &WoundRow<'_>) {
        for i in 0..self.len {
            let wound = row.at(self.start + i);
            self.blade[i] *= 1.0 - wound.gone;
            // Of a skeletonised area the veins are left, and whole areoles at its border.
            let depth = wound.bare + 0.5 * self.tones[tissue::AREOLE][i];
            let bare = (0.5 + 0.5 * depth * scene.layout.per_mm).clamp(0.0, 1.0);
            let (areole, grain) = (self.tones[tissue::AREOLE][i], self.grain[i]);
            let mut injury = wound.injury(areole, grain, scene.layout.per_mm);
            if wound.bare > FAR_OUTSIDE_MM && bare > 0.0 {
                let [third, fourth, fifth] = texel(&self.lines, i);
                let net = third.max(0.9 * fourth).max(0.5 * fifth);
                let kept = (1.6 * self.vein.cover[i]).max(1.5 * net).min(1.0);
                self.blade[i] *= 1.0 - bare * (1.0 - kept);
                // A large vein stays alive, as does the petiole that it runs into.
                let square = self.vein.radius[i] * self.vein.radius[i];
                let large = square / (square + ALIVE_MM * ALIVE_MM);
                injury.brown = injury.brown.max(0.55 * bare * (1.0 - large));
            }
            for (lane, value) in self.injured.iter_mut().zip(injury.array()) {
                lane[i] = value;
            }
        }
    }

    /// Where every place stands in the season.
    #[expect(clippy::needless_range_loop, reason = "several arrays go along together")]
    #[inline(always)]
    pub(super) fn read_condition(&mut self, scene: &Scene<'_>) {
        if scene.course.is_plain() {
            return;
        }
        let mut found = [[0.0; LANES]; 3];
        for i in 0..LANES {
            let at = scene.course.at(self.x[i], self.y, &self.tissue(i));
            (found[0][i], found[1][i], found[2][i]) = (at.season, at.chlorosis, at.death);
        }
        self.condition = found;
    }

    /// The season of every place.
    #[inline(always)]
    pub(super) fn seasons(&self) -> &Lane {
        &self.condition[0]
    }

    #[inline(always)]
    fn place(&self, i: usize) -> Place {
        Place::of(texel(&self.guide, i))
    }

    #[inline(always)]
    fn vein(&self, i: usize) -> VeinAt {
        let veins = &self.vein;
        VeinAt {
            cover: veins.cover[i],
            radius: veins.radius[i],
            dome: veins.dome[i],
            groove: veins.groove[i],
        }
    }

    /// What relief is made of at a texel.
    #[inline(always)]
    pub(super) fn ground(&self, i: usize) -> Ground {
        Ground {
            place: self.place(i),
            vein: self.vein(i),
            border: self.border[i],
            grain: self.grain[i],
        }
    }

    /// What colour is made of at a texel.
    #[inline(always)]
    pub(super) fn tissue(&self, i: usize) -> Tissue {
        let (x, y) = (self.x[i], self.y);
        Tissue {
            place: self.place(i),
            vein: self.vein(i),
            lines: texel(&self.lines, i),
            tones: texel(&self.tones, i),
            grain: self.grain[i],
            from_base: (x * x + y * y).sqrt(),
            condition: self.condition(i),
            injury: self.injury(i),
        }
    }

    #[inline(always)]
    fn condition(&self, i: usize) -> Condition {
        let [season, chlorosis, death] = texel(&self.condition, i);
        Condition { season, chlorosis, death }
    }

    /// What has been done to a texel.
    #[inline(always)]
    pub(super) fn injury(&self, i: usize) -> Injury {
        Injury::of(texel(&self.injured, i))
    }

    /// How dry the tissue is, 0–1.
    #[inline(always)]
    pub(super) fn dryness(&self, i: usize) -> f32 {
        self.condition(i).dryness().max(self.injury(i).brown)
    }

    /// How much of a texel is vein; none where nothing of the leaf is seen.
    #[inline(always)]
    pub(super) fn vein_mask(&self, i: usize) -> f32 {
        self.vein.cover[i] * if self.alpha(i) < LEAST_SEEN { 0.0 } else { self.blade[i] }
    }

    /// The order of the vein, 0 where there is none.
    #[inline(always)]
    pub(super) fn vein_order(&self, i: usize) -> u8 {
        if self.blade[i] >= 0.5 { self.vein.order[i] } else { 0 }
    }

    /// How much of a texel is leaf.
    #[inline(always)]
    pub(super) fn alpha(&self, i: usize) -> f32 {
        let stalk = if self.stalked { self.stalk[i].cover } else { 0.0 };
        1.0 - (1.0 - self.blade[i]) * (1.0 - stalk)
    }

    /// How much of what is seen of a texel is the stalk: over the blade, of which it comes out at the base; in
    /// front of a shield under it.
    pub(super) fn stalk_shares(&self, i: usize, shield: bool) -> [f32; 2] {
        let (blade, stalk) = (self.blade[i], self.stalk[i].cover);
        let seen = blade + stalk - blade * stalk;
        if stalk == 0.0 || seen <= 0.0 {
            return [0.0; 2];
        }
        let (under, over) = (stalk * (1.0 - blade) / seen, stalk / seen);
        // Its upper end dips into the midrib, which in front is seen to its end.
        let along = self.stalk[i].along / self.stalk[i].radius.max(1e-6);
        let above = if shield { 0.0 } else { smooth(-0.4, 0.6, along) };
        [above, smooth(-4.0, 1.0, along)].map(|emerged| under + (over - under) * emerged)
    }
}
