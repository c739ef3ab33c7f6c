//! Colour of the blade: a base colour and Foster's four colour types, front and back.

use crate::parameter::{parameters, words};

parameters! {
    /// A colour: hue, saturation, value.
    pub struct Hsv {
        /// Hue: 0 red, 60 yellow, 120 green. May run past 0 or 360, so that a range can cross red.
        hue_deg: number(95.0, -360.0..=720.0, "deg"),
        /// Saturation.
        saturation: number(0.5, 0.0..=1.0, ""),
        /// Value (brightness).
        value: number(0.4, 0.0..=1.0, ""),
    }
}

words! {
    /// How the second colour is spread (Foster, appendix B.3).
    pub enum ColourType {
        /// Base colour all over.
        Uniform = "uniform",
        /// From the veins outwards.
        FromVeins = "from-veins",
        /// From the margin inwards.
        FromEdges = "from-edges",
        /// From scattered points.
        Speckled = "speckled",
    }
}

parameters! {
    /// The colours of one side.
    pub struct SideColour {
        /// Colour of the tissue.
        base: group(Hsv, Hsv::default()),
        /// The second colour, spread by the colour type.
        alternate: group(Hsv, Hsv { hue_deg: 62.0, saturation: 0.6, value: 0.55 }),
        /// Colour of the veins.
        vein: group(Hsv, Hsv { hue_deg: 75.0, saturation: 0.38, value: 0.55 }),
    }
}

parameters! {
    /// Pigments of both sides (Foster, appendix B.3).
    pub struct ColourSpec {
        /// How the second colour is spread: `uniform`, `from-veins`, `from-edges` or `speckled`.
        r#type: choice(ColourType, ColourType::Uniform),
        /// Reach of the colour from a vein, in vein widths.
        vein_spread: number(8.0, 0.0..=200.0, "vein widths"),
        /// Reach of the colour from the margin or a speckle.
        spread_mm: number(6.0, 0.0..=1000.0, "mm"),
        /// How many speckles are thrown; 0 for a tenth of the auxin spawn rate.
        speckle_count: count(0, 0..=100_000, ""),
        /// Strength of the schemes not chosen, which keep the blade from looking flat.
        undertone: number(0.12, 0.0..=1.0, ""),
        /// Strength of the fine structure between the veins.
        mottle: number(0.35, 0.0..=1.0, ""),
        /// Upper side.
        front: group(SideColour, SideColour::default()),
        /// Lower side.
        back: group(SideColour, SideColour {
            base: Hsv { hue_deg: 88.0, saturation: 0.34, value: 0.52 },
            alternate: Hsv { hue_deg: 62.0, saturation: 0.45, value: 0.62 },
            vein: Hsv { hue_deg: 72.0, saturation: 0.28, value: 0.66 },
        }),
    }
}
