//! The flags that say which maps are written and how, shared by the commands that write maps.

use venation::document::{Document, Value};

use super::Failure;

#[derive(Debug, clap::Args)]
pub(crate) struct OutputArgs {
    /// Maps to write: basecolor, opacity, normal, normaldx, height, roughness, gloss, ambientocclusion
    /// (ao), orm, maskmap, translucency, thickness, veinmask, veinorder, bump; for people preview (lit) and
    /// enhancement; default (the profile's), all or none [default: the file's, else default].
    #[arg(long, value_name = "LIST")]
    maps: Option<String>,
    /// Names and packing of the maps: default, unreal, unity-hdrp, polyhaven, ambientcg or speedtree
    /// [default: the file's, else default].
    #[arg(long, value_name = "PROFILE")]
    profile: Option<String>,
    /// Bits of a channel, 8 or 16 [default: the file's, else 8; heights and thickness always have 16].
    #[arg(long, value_name = "N")]
    bits: Option<i64>,
    /// Write the smaller levels of every map too, in mips/: edges stay green, coverage stays as it is.
    #[arg(long)]
    mips: bool,
    /// Sheet of the cards in obj, glb and usda: square or outline [default: the file's, else square].
    #[arg(long, value_name = "SHAPE")]
    card: Option<String>,
    /// Lines of the svg: print, plotter or laser [default: the file's, else print].
    #[arg(long, value_name = "STYLE")]
    svg_style: Option<String>,
    /// Draw the outline of svg and dxf around blade and petiole, in one line.
    #[arg(long)]
    petiole: bool,
    /// Leave veins out of svg and dxf that are narrower than this, in mm [default: the file's, else 0].
    #[arg(long, value_name = "MM")]
    min_width: Option<f64>,
}

impl OutputArgs {
    /// Lays the flags over a document.
    pub(crate) fn apply(&self, document: &mut Document) -> Result<(), Failure> {
        if let Some(maps) = &self.maps {
            document.insert("output.maps", Value::Text(maps.clone()), "--maps");
        }
        let mut set = |flag: &str, key: &str, value: Option<String>| match value {
            Some(value) => document.set(&format!("output.{key}={value}"), flag),
            None => Ok(()),
        };
        set("--profile", "profile", self.profile.clone())?;
        set("--bits", "bits", self.bits.map(|bits| bits.to_string()))?;
        set("--mips", "mips", self.mips.then(|| "true".to_owned()))?;
        set("--card", "card", self.card.clone())?;
        set("--svg-style", "svg_style", self.svg_style.clone())?;
        set("--petiole", "petiole", self.petiole.then(|| "true".to_owned()))?;
        set("--min-width", "least_width_mm", self.min_width.map(|width| width.to_string()))?;
        Ok(())
    }
}
