//! The leaf as an eye would see it: lit from above on either side, and held against the light.
//!
//! Lambert and GGX (B. Walter et al., "Microfacet models for refraction through rough surfaces",
//! EGSR 2007) under one sun and an even sky, from the maps alone, in linear light.

use super::side::SideMaps;
use super::spectrum::{decoded, encoded};
use crate::parallel::for_each_piece;
use crate::raster::Grid;

/// Panels are no larger than this (pixels): larger maps are averaged down.
const LARGEST_PX: usize = 1024;

/// Towards the sun: from the upper left, low enough for relief to show.
const SUN: [f32; 3] = [-0.53, 0.53, 0.66];

/// Light of the sun and of the sky on a plain white surface, and from behind: there one looks into the light, as
/// bright as a camera takes it that is set for the leaf.
const SUN_LIGHT: f32 = 1.05;
const SKY_LIGHT: f32 = 0.32;
const BEHIND: f32 = 3.2;

/// How bright a leaf against the light is at the most, on average (linear, the brightest channel).
const EXPOSED: f32 = 0.7;

/// Reflectance of a leaf's surface at right angles.
const F0: f32 = 0.037;

/// What lies behind the leaf, and what shines behind it (linear).
const PAPER: [f32; 3] = [0.86, 0.85, 0.82];
const DUSK: [f32; 3] = [0.05, 0.055, 0.06];

/// Front, back, and front against the light, side by side.
pub(super) fn lit(front: &SideMaps, back: &SideMaps) -> Grid<[u8; 3]> {
    let size = front.size();
    let step = size.div_ceil(LARGEST_PX);
    let side = size / step;
    let linear: Vec<f32> = (0..256).map(|byte| decoded(f64::from(byte) / 255.0) as f32).collect();
    let against = View::Against { behind: exposed(front, &linear) };
    let views: [(&SideMaps, View); 3] = [(front, View::Lit), (back, View::Lit), (front, against)];
    let mut picture = Grid::filled(3 * side, side, [0; 3]);
    for_each_piece(picture.values_mut(), 3 * side, &|y, row| {
        for (panel, (maps, view)) in views.iter().enumerate() {
            for x in 0..side {
                let mut sum = [0.0; 3];
                for i in 0..step * step {
                    let (x, y) = (x * step + i % step, y * step + i / step);
                    let light = view.of(maps, y * size + x, &linear);
                    sum = std::array::from_fn(|c| sum[c] + light[c]);
                }
                let mean = sum.map(|v| f64::from(v) / (step * step) as f64);
                row[panel * side + x] = mean.map(|v| (encoded(v.min(1.0)) * 255.0 + 0.5) as u8);
            }
        }
    });
    picture
}

/// How bright the light behind a leaf is to be, so that of a yellow leaf more is seen than its outline.
fn exposed(maps: &SideMaps, linear: &[f32]) -> f32 {
    let seen = maps.translucency.values().iter().zip(maps.base_colour.values());
    let whole = seen.filter(|(_, colour)| colour[3] == u8::MAX);
    let brightest =
        |through: &[u8; 3]| linear[usize::from(through.iter().copied().max().unwrap_or(0))];
    let (sum, count) = whole.fold((0.0, 0_u32), |(sum, count), (through, _)| {
        (sum + f64::from(brightest(through)), count + 1)
    });
    let mean = (sum / f64::from(count.max(1))) as f32;
    BEHIND.min(EXPOSED / mean.max(1e-3))
}

#[derive(Debug, Clone, Copy)]
enum View {
    Lit,
    /// With so much light behind the leaf.
    Against {
        behind: f32,
    },
}

impl View {
    /// Light from one texel, over what lies behind it.
    fn of(self, maps: &SideMaps, at: usize, linear: &[f32]) -> [f32; 3] {
        let [r, g, b, alpha] = maps.base_colour.values()[at];
        let behind = match self {
            Self::Lit => PAPER,
            Self::Against { .. } => DUSK,
        };
        if alpha == 0 {
            return behind;
        }
        let colour = [r, g, b].map(|byte| linear[usize::from(byte)]);
        let normal = maps.normal.values()[at].map(|byte| f32::from(byte) / 127.5 - 1.0);
        let open = f32::from(maps.occlusion.values()[at]) / 255.0;
        let light = match self {
            Self::Lit => {
                let roughness = f32::from(maps.roughness.values()[at]) / 255.0;
                let facing = dot(normal, SUN).max(0.0);
                let gloss = gloss(normal, roughness) * facing * SUN_LIGHT;
                let shine = gloss + F0 * SKY_LIGHT * open * (1.0 - roughness);
                colour.map(|c| c * (facing / SUN[2] * SUN_LIGHT * 0.8 + SKY_LIGHT * open) + shine)
            }
            Self::Against { behind } => {
                let through = maps.translucency.values()[at].map(|b| linear[usize::from(b)]);
                let facing = 0.75 + 0.25 * normal[2];
                std::array::from_fn(|c| through[c] * behind * facing + colour[c] * SKY_LIGHT * open)
            }
        };
        let share = f32::from(alpha) / 255.0;
        std::array::from_fn(|c| behind[c] + (light[c] - behind[c]) * share)
    }
}

/// GGX seen from straight above.
fn gloss(normal: [f32; 3], roughness: f32) -> f32 {
    let alpha2 = roughness.powi(4).max(1e-4);
    let half = {
        let [x, y, z] = [SUN[0], SUN[1], SUN[2] + 1.0];
        let length = (x * x + y * y + z * z).sqrt();
        [x / length, y / length, z / length]
    };
    let cos = dot(normal, half).max(0.0);
    let spread = cos * cos * (alpha2 - 1.0) + 1.0;
    // With the masking of both ways taken as 1 / (4 cos cos), over the cosines.
    F0 * alpha2 / (4.0 * spread * spread * (normal[2].max(0.2)))
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
