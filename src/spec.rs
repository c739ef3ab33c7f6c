//! Everything a leaf is made from, as plain data: the stages' settings put together.

use crate::growth::GrowthSpec;
use crate::margin::MarginSpec;
use crate::parameter::parameters;
use crate::texture::TextureSpec;
use crate::texture::petiole::PetioleSpec;
use crate::texture::pigment::ColourSpec;
use crate::texture::relief::ReliefSpec;
use crate::veins::VeinSpec;

parameters! {
    /// What is written of a leaf.
    pub struct OutputSpec {
        /// Maps to write of each side: some of basecolor, opacity, normal, height, roughness,
        /// ambientocclusion, orm, translucency, thickness, veinmask, veinorder, bump; or all, or none.
        maps: text(
            "basecolor,opacity,normal,height,roughness,ambientocclusion,orm,translucency,thickness,\
             veinmask,veinorder"
        ),
        /// Other files to write: some of obj, svg, json, graphml, csv; or all, or none.
        formats: text("obj"),
    }
}

parameters! {
    /// A leaf, every value drawn.
    pub struct LeafSpec {
        /// Name of the leaf; files are called after it.
        name: text("leaf"),
        /// What it is, for people.
        title: text(""),
        /// The outline of the blade.
        margin: group(MarginSpec, MarginSpec::default()),
        /// How the blade grows.
        growth: group(GrowthSpec, GrowthSpec::default()),
        /// How the veins grow.
        veins: group(VeinSpec, VeinSpec::default()),
        /// The stalk.
        petiole: group(PetioleSpec, PetioleSpec::default()),
        /// Pigments.
        colour: group(ColourSpec, ColourSpec::default()),
        /// Heights and shine.
        relief: group(ReliefSpec, ReliefSpec::default()),
        /// Size of the pictures.
        texture: group(TextureSpec, TextureSpec::default()),
        /// What is written.
        output: group(OutputSpec, OutputSpec::default()),
    }
}
