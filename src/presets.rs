//! Leaves that come with `venation`: one TOML file each in `presets/`, embedded in the program. Species
//! ([`PRESETS`]) and, beside them, the lobed shapes of Garg's figures ([`FIGURES`]).

use crate::document::{Document, DocumentError};
use crate::spelling;

/// A leaf that comes with `venation`.
#[derive(Debug, Clone, Copy)]
pub struct Preset {
    /// Latin name in kebab-case: `fagus-sylvatica`; of a figure its author and number: `garg-4-6-a`.
    pub name: &'static str,
    /// Common name: `beech`; of a figure `4.6a`.
    pub common: &'static str,
    /// What it looks like, in a line.
    pub about: &'static str,
    /// Its TOML.
    pub text: &'static str,
}

macro_rules! presets {
    ($($name:literal, $common:literal, $about:literal;)*) => {
        &[$(Preset {
            name: $name,
            common: $common,
            about: $about,
            text: include_str!(concat!("../presets/", $name, ".toml")),
        }),*]
    };
}

/// Every species, by Latin name.
pub const PRESETS: &[Preset] = presets! {
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
    "liriodendron-tulipifera", "tulip-tree", "four lobes, an apex that looks cut off; fresh green";
    "magnolia-grandiflora", "magnolia", "long elliptic, thick and glossy; rusty felt below";
    "nelumbo-nucifera", "lotus", "a round shield on a petiole in its middle; some twenty forking rays";
    "poa-pratensis", "grass", "a long narrow blade, veins side by side";
    "populus-tremula", "aspen", "nearly round, on a long thin petiole; deeper green along the veins";
    "pyrus-communis", "pear", "ovate, dark and shiny, a dense fine net";
    "quercus-robur", "oak", "rounded lobes, two ears at the base";
    "salix-alba", "willow", "narrow lance, grey-green; silvery below";
    "syringa-vulgaris", "lilac", "heart-shaped, soft mid green";
    "tilia-cordata", "linden", "heart-shaped, oblique base, abrupt tip";
};

/// Shapes of multilobed leaves after figures 4.6 and 6.12 of S. Garg's thesis (2011): number and kind of
/// lobes as their captions say, in the 26 numbers of section 6.1.
pub const FIGURES: &[Preset] = presets! {
    "garg-4-6-a", "4.6a", "palmate, three lobes";
    "garg-4-6-b", "4.6b", "palmate, five lobes";
    "garg-4-6-c", "4.6c", "palmate, seven lobes";
    "garg-4-6-d", "4.6d", "pinnate, ten lobes";
    "garg-4-6-e", "4.6e", "bilobed";
    "garg-6-12-a", "6.12a", "two lobes";
    "garg-6-12-b", "6.12b", "pinnate, ten lobes";
    "garg-6-12-c", "6.12c", "palmate, three broad lobes";
    "garg-6-12-d", "6.12d", "palmate, three slender lobes";
    "garg-6-12-e", "6.12e", "palmate, five broad lobes";
    "garg-6-12-f", "6.12f", "palmate, five slender lobes";
    "garg-6-12-g", "6.12g", "palmate, seven lobes";
};

/// Species and figures.
pub fn all() -> impl Iterator<Item = &'static Preset> {
    PRESETS.iter().chain(FIGURES)
}

/// The preset of a Latin or common name.
#[must_use]
pub fn find(name: &str) -> Option<&'static Preset> {
    all().find(|preset| preset.name == name || preset.common == name)
}

/// The preset's name nearest to a misspelt one.
#[must_use]
pub fn nearest(name: &str) -> Option<&'static str> {
    // Looser than for keys: names are short, and a slip weighs more in them.
    spelling::nearest(name, 0.5, all().flat_map(|preset| [preset.name, preset.common]))
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
