//! Leaves that come with `venation`: one TOML file each in `presets/`, embedded in the program.

use crate::document::{self, Document, DocumentError};

/// A leaf that comes with `venation`.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// Latin name in kebab-case: `fagus-sylvatica`.
    pub name: &'static str,
    /// Common name: `beech`.
    pub common: &'static str,
    /// What it looks like, in a line.
    pub about: &'static str,
    /// Its TOML.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal, $common:literal, $about:literal;)*) => {
        /// Every preset, by Latin name.
        pub const PRESETS: &[Preset] = &[$(Preset {
            name: $name,
            common: $common,
            about: $about,
            text: include_str!(concat!("../presets/", $name, ".toml")),
        }),*];
    };
}

presets! {
    "acer-platanoides", "maple", "five lobes with few long-pointed teeth; bright green";
    "betula-pendula", "birch", "small, nearly a rhomb; doubly toothed";
    "castanea-sativa", "chestnut", "long, one bristle-tipped tooth to each of many side veins";
    "cercis-canadensis", "redbud", "broad heart, five to seven veins from the base";
    "cinnamomum-camphora", "camphor", "elliptic and glossy, three arching main veins";
    "cornus-florida", "dogwood", "ovate, veins arching towards the tip; glaucous below";
    "fagus-sylvatica", "beech", "oval, glossy green, nearly straight side veins";
    "ficus-religiosa", "bodhi", "broad, drawn out into a long drip tip; looped side veins";
    "ginkgo-biloba", "ginkgo", "a notched fan of forking veins";
    "hedera-helix", "ivy", "five pointed lobes, very dark, pale veins";
    "magnolia-grandiflora", "magnolia", "long elliptic, thick and glossy; rusty felt below";
    "poa-pratensis", "grass", "a long narrow blade, veins side by side";
    "populus-tremula", "aspen", "nearly round, on a long thin petiole; deeper green along the veins";
    "pyrus-communis", "pear", "ovate, dark and shiny, a dense fine net";
    "quercus-robur", "oak", "rounded lobes, two ears at the base";
    "salix-alba", "willow", "narrow lance, grey-green; silvery below";
    "syringa-vulgaris", "lilac", "heart-shaped, soft mid green";
    "tilia-cordata", "linden", "heart-shaped, oblique base, abrupt tip";
}

/// The preset of a Latin or common name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Preset> {
    PRESETS.iter().find(|preset| preset.name == name || preset.common == name)
}

/// The preset's name nearest to a misspelt one.
#[must_use]
pub fn nearest(name: &str) -> Option<&'static str> {
    // Looser than for keys: names are short, and a slip weighs more in them.
    document::nearest(name, 0.5, PRESETS.iter().flat_map(|preset| [preset.name, preset.common]))
}

impl Preset {
    /// Its document.
    ///
    /// # Errors
    ///
    /// None for the presets that come with `venation`: a test reads them all.
    pub fn document(&self) -> Result<Document, DocumentError> {
        Document::parse(self.text, &format!("{}.toml", self.name))
    }
}
