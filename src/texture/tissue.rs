//! The fine structure between the grown veins: nets ([`super::net`]) of the finest veins around areoles in three
//! sizes, and grain.
//!
//! Sizes are millimetres, so a larger texture shows more and not larger tissue; what would be finer
//! than the texels fades.

/// Sizes of the meshes (mm): of third-order veins where none have grown, of the fourth order, and
/// of the fifth.
pub(super) const MESH_MM: [f32; 3] = [2.1, 0.85, 0.27];

/// After so many cells each repeats.
pub(super) const CELLS: [usize; 3] = [16, 16, 32];

/// Which mesh is the areole: the one that bulges.
pub(super) const AREOLE: usize = 1;

/// Half the width of the lines of each net (mm).
pub(super) const LINE_MM: [f32; 3] = [0.042, 0.032, 0.014];

/// The nets begin within these distances (mm) of a grown vein: nearer, it takes their place.
pub(super) const AWAY_MM: [[f32; 2]; 3] = [[0.5, 1.3], [0.05, 0.35], [0.0, 0.1]];

/// Size of the grain (mm): a few cells of the epidermis.
const GRAIN_MM: f32 = 0.11;

/// A smooth step from 0 at `low` to 1 at `high`.
#[inline(always)]
pub(super) fn smooth(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// How much of structures `size` mm wide a texture of so many pixels to the millimetre can show.
pub(super) fn shown(size: f32, pixels_per_mm: f32) -> f32 {
    smooth(1.8, 5.0, size * pixels_per_mm)
}

/// Size of the grain on a texture (mm): its own, but never finer than the texels can carry.
pub(super) fn grain_size(pixels_per_mm: f32) -> f32 {
    GRAIN_MM.max(1.7 / pixels_per_mm)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn structures_finer_than_the_texels_fade() {
        assert_eq!(shown(0.27, 4.0), 0.0);
        assert_eq!(shown(0.85, 12.0), 1.0);
    }
}
