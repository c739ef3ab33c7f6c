//! The stalk of the leaf: drawn under the blade in front and over it behind.

use super::pigment::Hsv;
use crate::parameter::parameters;

parameters! {
    /// The stalk of the leaf.
    pub struct PetioleSpec {
        /// Length below the base of the blade; 0 for a sessile leaf.
        length_mm: number(15.0, 0.0..=1000.0, "mm"),
        /// Width at the stem; it narrows to the midrib's at the blade.
        width_mm: number(1.8, 0.05..=100.0, "mm"),
        /// How far it bends aside, as the angle between its two ends.
        bend_deg: number(8.0, -80.0..=80.0, "deg"),
        /// Its colour.
        colour: group(Hsv, Hsv { hue_deg: 70.0, saturation: 0.45, value: 0.55 }),
    }
}
