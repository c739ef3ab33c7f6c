//! What wounds are at the texels: read between the nodes, with the edges that tissue gives them.

use super::{Wound, Wounds};
use crate::texture::guide::{between, mixed};
use crate::texture::tissue::smooth;

/// Tissue this near to a gap has died (mm).
const RIM_MM: f32 = 0.45;

/// What has been done to a texel's tissue, beside what is gone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(in crate::texture) struct Injury {
    /// How far it has died (0–1).
    pub brown: f32,
    /// How far what has died is walled off, dark with tannins (0–1).
    pub dark: f32,
    /// How far only its skins are left (0–1).
    pub pale: f32,
    /// How far those are blown apart over a mine (0–1).
    pub blown: f32,
}

impl Injury {
    #[inline(always)]
    pub(in crate::texture) fn array(self) -> [f32; 4] {
        [self.brown, self.dark, self.pale, self.blown]
    }

    #[inline(always)]
    pub(in crate::texture) fn of([brown, dark, pale, blown]: [f32; 4]) -> Self {
        Self { brown, dark, pale, blown }
    }
}

/// What a wound is at one texel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::texture) struct WoundAt {
    /// Share of the tissue that is gone.
    pub gone: f32,
    /// Depth in a skeletonised area (mm).
    pub bare: f32,
    /// Depth in a spot (mm).
    spot: f32,
    /// Depth in a mine, and in the frass along it (mm).
    mine: [f32; 2],
    injury: Injury,
}

impl WoundAt {
    /// What has been done to the tissue, whose areoles and grain stand so high (−1 – 1): they make the
    /// edges uneven, since disease and its eaters go from cell to cell.
    #[inline]
    pub(in crate::texture) fn injury(&self, areole: f32, grain: f32, per_mm: f32) -> Injury {
        let Injury { mut brown, mut dark, mut pale, .. } = self.injury;
        brown += 1.4 * brown * (1.0 - brown) * (areole + 0.6 * grain);
        // Half a texel of softness, or as much as tissue has.
        let per_mm = per_mm.min(MOST_SHARP_PER_MM);
        let within = |depth: f32| (0.5 + depth * per_mm).clamp(0.0, 1.0);
        let mined = within(self.mine[0] + 0.03 * grain);
        pale = pale.max(mined);
        brown = brown.max(mined * within(self.mine[1] + 0.04 * grain) * (0.6 + 0.3 * grain));
        // A dark rim around what has dried out.
        let depth = self.spot + 0.05 * grain + 0.08 * areole;
        let spot = within(depth);
        let dry = smooth(0.12, 0.5, depth);
        brown = brown.max(spot * (1.0 - 0.5 * dry));
        dark = dark.max(spot * (1.0 - smooth(0.1, 0.34, depth)));
        pale = pale.max(spot * dry);
        Injury { brown: brown.clamp(0.0, 1.0), dark, pale: pale.clamp(0.0, 1.0), blown: mined }
    }
}

/// No edge of an injury is sharper than this: a fiftieth of a millimetre is a cell.
const MOST_SHARP_PER_MM: f32 = 50.0;

/// The wounds along one row of the texture.
#[derive(Debug)]
pub(in crate::texture) struct WoundRow<'a> {
    wounds: &'a Wounds,
    nodes: Vec<Wound>,
}

impl<'a> WoundRow<'a> {
    /// The wounds on nodes at the height of the row.
    pub(super) fn new(wounds: &'a Wounds, nodes: Vec<Wound>) -> Self {
        Self { wounds, nodes }
    }

    /// The wound at column `x`.
    #[inline]
    pub(in crate::texture) fn at(&self, x: usize) -> WoundAt {
        let (i, t) = between(x, self.wounds.per_texel, self.nodes.len());
        let [gone, bare, spot, mine, frass, brown, pale] =
            mixed(&self.nodes[i], &self.nodes[i + 1], t);
        let rim = 1.0 - (-gone / RIM_MM).clamp(0.0, 1.0);
        WoundAt {
            gone: (0.5 + gone * self.wounds.per_mm).clamp(0.0, 1.0),
            bare,
            spot,
            mine: [mine, frass],
            injury: Injury {
                brown: brown.max(0.85 * rim * rim).clamp(0.0, 1.0),
                dark: rim.powi(6),
                pale: pale.clamp(0.0, 1.0),
                blown: 0.0,
            },
        }
    }
}
