//! Heights: veins sunken in front and raised behind, tissue quilted between them.

use crate::parameter::parameters;

parameters! {
    /// Heights of both sides, and how they take the light.
    pub struct ReliefSpec {
        /// Depth of the veins in front, in vein radii.
        front_depth: number(0.4, 0.0..=5.0, "vein radii"),
        /// Height of the veins behind, in vein radii.
        back_height: number(1.2, 0.0..=5.0, "vein radii"),
        /// How far the tissue swells between the veins.
        quilting_mm: number(0.04, 0.0..=5.0, "mm"),
        /// Fine speckle of the surface: 0 smooth, 1 rough (Foster's leaf roughness).
        roughness: number(0.35, 0.0..=1.0, ""),
        /// Shine of the upper side: 0 matt, 1 glossy; the lower side has a third of it.
        specularity: number(0.3, 0.0..=1.0, ""),
    }
}
