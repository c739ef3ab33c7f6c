//! One texel: everything known of a place put together, and what is painted there.

use super::damage::WoundAt;
use super::fields::{Place, VeinAt};
use super::petiole::StalkAt;
use super::pigment::{Condition, Tissue};
use super::relief::Ground;
use super::scene::Scene;
use super::tissue::{self, Net, smooth};
use crate::raster::color::byte;
use crate::raster::coverage::stroke_share;

/// Fibres are longer than wide by the inverse of this.
const FIBRE_STRETCH: f32 = 0.08;

/// Further than this outside a skeletonised area (mm) nothing of it is seen.
const FAR_OUTSIDE_MM: f32 = -3.0;

/// Goes along the rows of a band, with the nets' neighbourhoods at hand.
pub(super) struct Walker<'a> {
    scene: &'a Scene,
    nets: [Net; 3],
    shown: [f32; 3],
    lines: [f32; 3],
    grain: f32,
    mm: f32,
    min: [f32; 2],
}

impl<'a> Walker<'a> {
    pub(super) fn new(scene: &'a Scene) -> Self {
        let sizes = tissue::MESH_MM;
        Self {
            scene,
            nets: [0, 1, 2].map(|k| Net::new(sizes[k], scene.seed ^ (0x51 + k as u32))),
            shown: sizes.map(|size| tissue::shown(size, scene.per_mm)),
            lines: tissue::LINE_MM.map(|half| half * scene.per_mm),
            grain: tissue::grain_size(scene.per_mm),
            mm: 1.0 / scene.per_mm,
            min: scene.frame.min.as_vec2().to_array(),
        }
    }

    #[inline]
    pub(super) fn texel(
        &mut self,
        column: usize,
        row: usize,
        place: Place,
        vein: VeinAt,
        (blade, wound): (f32, WoundAt),
        stalk: StalkAt,
    ) -> Texel<'a> {
        let scene = self.scene;
        let x = self.min[0] + (column as f32 + 0.5) * self.mm;
        let y = self.min[1] + (scene.size as f32 - row as f32 - 0.5) * self.mm;
        // The net is drawn out and bent by the tissue's own unevenness.
        let [_, middle, fine] = place.noise;
        let (bent_x, bent_y) = (x + 0.5 * middle + 0.25 * fine, y + 0.45 * fine - 0.4 * middle);
        let (mut lines, mut tones, mut border) = ([0.0; 3], [0.0; 3], 0.0);
        for (k, net) in self.nets.iter_mut().enumerate() {
            let [none, full] = tissue::AWAY_MM[k];
            let shown = self.shown[k] * smooth(none, full, place.vein);
            if self.shown[k] == 0.0 || (shown == 0.0 && k != tissue::AREOLE) {
                continue;
            }
            let mesh = net.at(bent_x, bent_y);
            let half = (0.7 * self.lines[k]).max(0.7);
            lines[k] = shown * stroke_share(mesh.border / self.mm, self.lines[k], half);
            tones[k] = shown * (2.0 * mesh.tone - 1.0);
            if k == tissue::AREOLE {
                border = mesh.border;
            }
        }
        let grain = tissue::grain(x, y, self.grain, scene.seed ^ 0x77);
        // The stalk is made of fibres: its grain is drawn out along it.
        let fibre = if stalk.cover > 0.0 {
            tissue::grain(x, stalk.along * FIBRE_STRETCH, 2.0 * self.grain, scene.seed ^ 0x99)
        } else {
            0.0
        };
        let from_base = (x * x + y * y).sqrt();
        let mut blade = blade * (1.0 - wound.gone);
        // Of a skeletonised area the veins are left, and whole areoles at its border.
        let depth = wound.bare + 0.5 * tones[tissue::AREOLE];
        let bare = (0.5 + 0.5 * depth * scene.per_mm).clamp(0.0, 1.0);
        let mut injury = wound.injury;
        if wound.bare > FAR_OUTSIDE_MM && bare > 0.0 {
            let net = lines[0].max(0.9 * lines[1]).max(0.5 * lines[2]);
            let kept = (1.6 * vein.cover).max(1.5 * net).min(1.0);
            blade *= 1.0 - bare * (1.0 - kept);
            injury.brown = injury.brown.max(0.55 * bare);
        }
        let mut tissue = Tissue {
            place,
            vein,
            lines,
            tones,
            grain,
            from_base,
            condition: Condition::default(),
            injury,
        };
        tissue.condition = scene.course.at(x, y, &tissue);
        Texel {
            scene,
            alpha: byte(1.0 - (1.0 - blade) * (1.0 - stalk.cover)),
            blade,
            stalk,
            fibre,
            ground: Ground { place, vein, border, grain },
            tissue,
        }
    }
}

/// Everything at one texel.
pub(super) struct Texel<'a> {
    scene: &'a Scene,
    pub(super) alpha: u8,
    blade: f32,
    stalk: StalkAt,
    /// Grain of the stalk, −1 – 1.
    fibre: f32,
    ground: Ground,
    tissue: Tissue,
}

impl Texel<'_> {
    /// How much of what is seen is the stalk: under the blade in front, over it behind.
    #[inline]
    fn stalk_shares(&self) -> [f32; 2] {
        let (blade, stalk) = (self.blade, self.stalk.cover);
        let seen = blade + stalk - blade * stalk;
        if stalk == 0.0 || seen <= 0.0 {
            return [0.0; 2];
        }
        let (under, over) = (stalk * (1.0 - blade) / seen, stalk / seen);
        // Its upper end dips into the midrib.
        let emerged = smooth(-4.0, 1.0, self.stalk.along / self.stalk.radius.max(1e-6));
        [under, under + (over - under) * emerged]
    }

    #[inline]
    pub(super) fn heights(&self) -> [f32; 2] {
        let [front, back] = self.scene.relief.heights(&self.ground);
        if self.stalk.cover == 0.0 {
            return [front, back];
        }
        let [under, over] = self.stalk_shares();
        let [stalk_front, stalk_back] = self.scene.relief.stalk_heights(&self.stalk);
        // Behind, stalk and midrib are one cord: whichever is higher.
        let cord = back.max(stalk_back);
        [front + (stalk_front - front) * under, back + (cord - back) * over]
    }

    #[inline]
    pub(super) fn bumps(&self) -> [f32; 2] {
        let blade = self.scene.relief.bumps(&self.ground);
        if self.stalk.cover == 0.0 {
            return blade;
        }
        let (stalk, shares) = (self.scene.relief.stalk_bumps(), self.stalk_shares());
        std::array::from_fn(|side| blade[side] + (stalk[side] - blade[side]) * shares[side])
    }

    /// How dry the tissue is, 0–1.
    #[inline]
    fn dryness(&self) -> f32 {
        self.tissue.condition.dryness().max(self.tissue.injury.brown)
    }

    /// Perceptual roughness of both sides.
    #[inline]
    pub(super) fn roughness(&self) -> [f32; 2] {
        let blade = self.scene.optics.roughness(&self.ground, self.dryness());
        if self.stalk.cover == 0.0 {
            return blade;
        }
        let (stalk, shares) = (self.scene.optics.stalk(), self.stalk_shares());
        std::array::from_fn(|side| blade[side] + (stalk[side] - blade[side]) * shares[side])
    }

    /// From front to back (mm).
    #[inline]
    pub(super) fn thickness(&self) -> f32 {
        let blade = self.scene.relief.thickness(&self.ground) * self.blade;
        blade.max(2.0 * self.stalk.dome)
    }

    /// How much of the texel is vein.
    #[inline]
    pub(super) fn vein_mask(&self) -> u8 {
        byte(self.ground.vein.cover * self.blade)
    }

    /// The order of the vein, 0 where there is none.
    #[inline]
    pub(super) fn vein_order(&self) -> u8 {
        if self.blade >= 0.5 { self.ground.vein.order } else { 0 }
    }

    /// What is seen of both sides, and through them.
    #[inline]
    pub(super) fn colours(&self) -> [Shade; 2] {
        let shares = self.stalk_shares();
        let pigments = &self.scene.pigments;
        let blade = pigments.blade(&self.tissue);
        if shares == [0.0; 2] {
            return blade;
        }
        let stalk = pigments.stalk(&self.stalk, self.scene.stalk_length, self.fibre);
        std::array::from_fn(|side| blade[side].mixed(stalk[side], shares[side]))
    }
}

/// Light that comes back from a place and light that goes through it, as sRGB numbers 0–1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Shade {
    pub reflected: [f32; 3],
    pub through: [f32; 3],
}

impl Shade {
    /// From this to `other`.
    #[inline]
    pub(super) fn mixed(self, other: Self, share: f32) -> Self {
        let mix = |a: [f32; 3], b: [f32; 3]| std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share);
        Self {
            reflected: mix(self.reflected, other.reflected),
            through: mix(self.through, other.through),
        }
    }
}
