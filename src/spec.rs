//! Everything a leaf is made from, as plain data: the stages' settings put together.

use crate::growth::GrowthSpec;
use crate::margin::MarginSpec;
use crate::parameter::{Kind, Parameters, parameters};
use crate::texture::TextureSpec;
use crate::texture::damage::DamageSpec;
use crate::texture::petiole::PetioleSpec;
use crate::texture::pigment::{ColourSpec, StateSpec};
use crate::texture::relief::ReliefSpec;
use crate::veins::VeinSpec;

parameters! {
    /// What is written of a leaf.
    pub struct OutputSpec {
        /// Maps to write of each side: some of basecolor, opacity, normal, height, roughness,
        /// ambientocclusion, orm, translucency, thickness, veinmask, veinorder, bump, preview,
        /// enhancement; or all, or none.
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
        /// Season, maturity and health: colour and tissue only.
        state: group(StateSpec, StateSpec::default()),
        /// What has happened to the leaf.
        damage: group(DamageSpec, DamageSpec::default()),
        /// Heights and shine.
        relief: group(ReliefSpec, ReliefSpec::default()),
        /// Size of the pictures.
        texture: group(TextureSpec, TextureSpec::default()),
        /// What is written.
        output: group(OutputSpec, OutputSpec::default()),
    }
}

impl LeafSpec {
    /// A leaf between others, each counting by its share: every number in between, hues on the
    /// shorter arc; words, counts and points, which know no between, as the last leaf has them. The
    /// margin is the last leaf's too: shapes have a space of their own
    /// ([`MorphPath`](crate::margin::morph::MorphPath)).
    ///
    /// # Panics
    ///
    /// Without a leaf.
    #[must_use]
    pub fn mixed(leaves: &[Self], shares: &[f64]) -> Self {
        let tree = |leaf| toml::Value::try_from(leaf).expect("a leaf is plain data");
        let trees: Vec<toml::Value> = leaves.iter().map(tree).collect();
        let mut mixed = trees.last().expect("a leaf").clone();
        for parameter in Self::parameters() {
            let Kind::Number { min, max, unit } = parameter.kind else { continue };
            if parameter.key.starts_with("margin.") {
                continue;
            }
            let value = |tree: &toml::Value| {
                parameter.key.split('.').try_fold(tree, |node, part| node.get(part))?.as_float()
            };
            let Some(values) = trees.iter().map(value).collect::<Option<Vec<f64>>>() else {
                continue;
            };
            let last = values[values.len() - 1];
            let hue = unit == "deg" && parameter.key.ends_with("hue_deg");
            let from_last = |x: f64| {
                let off = x - last;
                if hue { off - 360.0 * (off / 360.0).round() } else { off }
            };
            let off: f64 = values.iter().zip(shares).map(|(x, share)| from_last(*x) * share).sum();
            let x = if hue { (last + off).rem_euclid(360.0) } else { last + off };
            let mut node = Some(&mut mixed);
            for part in parameter.key.split('.') {
                node = node.and_then(|node| node.get_mut(part));
            }
            if let Some(node) = node {
                *node = toml::Value::Float(x.clamp(min, max));
            }
        }
        mixed.try_into().expect("the same settings with other numbers")
    }
}
