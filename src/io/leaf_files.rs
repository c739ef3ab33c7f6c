//! All files of a leaf: what is written, what it is called and what it says.

use glam::DVec2;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::card::{Card, Sheet, Side};
use super::manifest::{FileRecord, Manifest, SideMapping};
use super::map_files::{self, MapFile, Pictures, Texts};
use super::tables::Table;
use super::{FormatKind, GENERATOR, MANIFEST_FILE, SPEC_FILE};
use super::{dxf, file_stem, glb, graph, graphml, obj, remains, svg, usda};
use crate::geometry::union::united;
use crate::margin::Margin;
use crate::pipeline::Leaf;
use crate::seed::Seed;
use crate::spec::Output;
use crate::texture::TextureSet;
use crate::texture::map::MapKind;
use crate::veins::Venation;

/// A leaf and how it is to be written.
#[derive(Debug, Clone, Copy)]
pub struct LeafFiles<'a> {
    /// Name of the leaf; files are called after it ([`file_stem`]).
    pub name: &'a str,
    /// What it is, for people; may be empty.
    pub title: &'a str,
    /// The seed it was drawn from.
    pub seed: Seed,
    /// Its outline.
    pub margin: &'a Margin,
    /// Its veins.
    pub venation: &'a Venation,
    /// Its pictures. Where they show gaps, only what is left of the veins is written.
    pub textures: &'a TextureSet,
    /// The resolved settings.
    pub spec_toml: &'a str,
    /// Shine of the upper side, 0–1.
    pub specularity: f64,
    /// Roughness of the surface, 0–1.
    pub roughness: f64,
    /// What to write.
    pub output: &'a Output,
}

impl<'a> LeafFiles<'a> {
    /// A leaf that was made from `leaf.spec`, whose settings as text are `spec_toml`
    /// ([`Document::of_spec`](crate::document::Document::of_spec)) and whose output is `output`.
    #[must_use]
    pub fn of(leaf: &'a Leaf, spec_toml: &'a str, output: &'a Output) -> Self {
        Self {
            name: &leaf.spec.name,
            title: &leaf.spec.title,
            seed: leaf.seed,
            margin: &leaf.grown.margin,
            venation: &leaf.grown.venation,
            textures: &leaf.textures,
            spec_toml,
            specularity: leaf.spec.relief.specularity,
            roughness: leaf.spec.relief.roughness,
            output,
        }
    }
}

impl LeafFiles<'_> {
    /// The rings to be drawn in place of the margin; none where that is whole and drawn alone.
    fn drawn_rings(&self) -> Vec<Vec<DVec2>> {
        let rings = &self.textures.rings;
        if !self.output.petiole || self.textures.petiole.is_empty() {
            return rings.clone();
        }
        let whole = [self.margin.outline().to_vec()];
        united(if rings.is_empty() { &whole } else { rings }, &self.textures.petiole)
    }
}

/// What [`encode_leaf`] will make of a leaf of this name and size (pixels), in the same order.
#[must_use]
pub fn file_names(name: &str, size_px: usize, output: &Output) -> Vec<String> {
    let entries = entries(name, size_px, output);
    entries.into_iter().map(|(path, _)| path).chain([MANIFEST_FILE.to_owned()]).collect()
}

/// Everything that is written of a leaf: relative names with `/`, and bytes.
///
/// The same leaf gives the same bytes on any number of threads; names come in a fixed order, the
/// manifest last.
#[must_use]
pub fn encode_leaf(leaf: &LeafFiles<'_>) -> Vec<(String, Vec<u8>)> {
    let sheet = Sheet::of(leaf.output.card, &leaf.textures.front.base_colour);
    let unreached = leaf.venation.unreached().total();
    let remaining = remains::remaining(leaf.venation, &leaf.textures.rings);
    let leaf = &LeafFiles { venation: remaining.as_ref().unwrap_or(leaf.venation), ..*leaf };
    let work = Work { leaf, pictures: Pictures::new(leaf.textures, leaf.output), sheet };
    let entries = entries(leaf.name, leaf.textures.front.size(), leaf.output);
    let encoded: Vec<((String, Vec<u8>), FileRecord)> = entries
        .into_par_iter()
        .map(|(path, content)| {
            let bytes = work.encode(content);
            let record = work.record(content, &path, &bytes);
            ((path, bytes), record)
        })
        .collect();
    let (mut files, records): (Vec<_>, Vec<_>) = encoded.into_iter().unzip();
    files
        .push((MANIFEST_FILE.to_owned(), leaf.manifest(records, unreached).to_json().into_bytes()));
    files
}

/// SHA-256 of bytes, in hexadecimal.
pub(super) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The hash of a leaf's settings: two leaves of the same have the same bytes. Which of its files were
/// asked for is no part of it.
#[must_use]
pub fn settings_sha256(spec_toml: &str) -> String {
    let which = |line: &&str| !line.starts_with("maps = ") && !line.starts_with("formats = ");
    sha256(spec_toml.lines().filter(which).collect::<Vec<_>>().join("\n").as_bytes())
}

/// The hash of a run: of its settings, before any seed has chosen from them, and of its seeds.
#[must_use]
pub fn run_sha256(document_toml: &str, seeds: &[u64]) -> String {
    sha256(format!("{document_toml}\n{seeds:?}").as_bytes())
}

/// What is in a file.
#[derive(Debug, Clone, Copy)]
enum Content {
    Map(MapFile),
    Spec,
    Card,
    Materials,
    Binary,
    Stage,
    Drawing,
    CutLines,
    Graph,
    GraphMl,
    Table(Table),
}

/// Every file but the manifest.
fn entries(name: &str, size_px: usize, output: &Output) -> Vec<(String, Content)> {
    let stem = file_stem(name);
    // The settings come first: a run that was killed can tell from them what it was making.
    let mut entries = vec![(SPEC_FILE.to_owned(), Content::Spec)];
    let maps = map_files::list(name, size_px, output);
    entries.extend(maps.into_iter().map(|(path, file)| (path, Content::Map(file))));
    for format in FormatKind::ALL.iter().filter(|format| output.formats.contains(format)) {
        let mut one = |ending: &str, content: Content| {
            entries.push((format!("{stem}{ending}"), content));
        };
        match format {
            FormatKind::Obj => {
                one(".obj", Content::Card);
                one(".mtl", Content::Materials);
            }
            FormatKind::Glb => one(".glb", Content::Binary),
            FormatKind::Usda => one(".usda", Content::Stage),
            FormatKind::Svg => one(".svg", Content::Drawing),
            FormatKind::Dxf => one(".dxf", Content::CutLines),
            FormatKind::Json => one("_veins.json", Content::Graph),
            FormatKind::GraphMl => one("_veins.graphml", Content::GraphMl),
            FormatKind::Csv => {
                for &table in Table::ALL {
                    one(&format!("_{}.csv", table.word()), Content::Table(table));
                }
            }
        }
    }
    entries
}

impl Content {
    const fn meaning(self) -> &'static str {
        match self {
            Self::Map(MapFile { map, .. }) => map.meaning(),
            Self::Spec => "the resolved settings; makes the same files again",
            Self::Card => {
                "card with both sides, in metres: base at the origin, apex on +y, upper side to +z"
            }
            Self::Materials => "materials of the card",
            Self::Binary => "card with both sides and its pictures, in metres",
            Self::Stage => "card with both sides, in metres, with UsdPreviewSurface",
            Self::Drawing => "outline and veins in mm, a layer for every order",
            Self::CutLines => "outline and veins in mm for cutters, a layer for every order",
            Self::Graph => "vein graph in mm: nodes with parent, radius and order",
            Self::GraphMl => "vein graph in mm for graph programs, loops included",
            Self::Table(table) => table.meaning(),
        }
    }
}

/// A leaf with everything that several of its files need.
struct Work<'a> {
    leaf: &'a LeafFiles<'a>,
    pictures: Pictures<'a>,
    sheet: Sheet,
}

impl Work<'_> {
    fn encode(&self, content: Content) -> Vec<u8> {
        let leaf = self.leaf;
        let stem = file_stem(leaf.name);
        let card = Card {
            stem: &stem,
            frame: &leaf.textures.frame,
            sheet: &self.sheet,
            specularity: leaf.specularity,
            roughness: leaf.roughness,
        };
        let paths = || Side::ALL.map(|side| map_files::paths(leaf.name, side, leaf.output));
        match content {
            Content::Map(file) => self.pictures.encode(file, &leaf.texts(&leaf.seed.0.to_string())),
            Content::Spec => leaf.spec_toml.into(),
            Content::Card => obj::obj(&card).into(),
            Content::Materials => obj::mtl(&card, &paths()).into(),
            Content::Binary => glb::glb(&card, &self.embedded(), &leaf.provenance()),
            Content::Stage => usda::usda(&card, &paths()).into(),
            Content::Drawing => {
                let drawing = svg::Drawing {
                    title: leaf.shown_name(),
                    style: leaf.output.svg_style,
                    least_width_mm: leaf.output.least_width_mm,
                };
                let rings = leaf.drawn_rings();
                svg::svg(&drawing, leaf.margin, Some(leaf.venation), card.frame, &rings).into()
            }
            Content::CutLines => {
                let rings = leaf.drawn_rings();
                dxf::dxf(leaf.margin, leaf.venation, &rings, leaf.output.least_width_mm).into()
            }
            Content::Graph => graph::VeinDocument::new(leaf.margin, leaf.venation).to_json().into(),
            Content::GraphMl => graphml::graphml(leaf.venation).into(),
            Content::Table(table) => table.csv(leaf.margin, leaf.venation).into(),
        }
    }

    /// The pictures that stand in the card itself, whatever maps are written beside it.
    fn embedded(&self) -> [glb::Pictures; 2] {
        Side::ALL.map(|side| {
            let picture = |map| self.pictures.plain(side, map);
            glb::Pictures {
                base_colour: picture(MapKind::BaseColour),
                normal: picture(MapKind::Normal),
                orm: picture(MapKind::Orm),
                translucency: picture(MapKind::Translucency),
            }
        })
    }

    fn record(&self, content: Content, path: &str, bytes: &[u8]) -> FileRecord {
        let mut record = FileRecord::new(path, content.meaning(), bytes);
        if let Content::Map(file) = content {
            self.pictures.describe(file, &mut record);
        }
        record
    }
}

impl LeafFiles<'_> {
    /// The title, or the name where there is none.
    fn shown_name(&self) -> &str {
        if self.title.is_empty() { self.name } else { self.title }
    }

    fn texts<'a>(&'a self, seed: &'a str) -> Texts<'a> {
        Texts { title: self.shown_name(), name: self.name, seed, settings: self.spec_toml }
    }

    /// What a file that is passed on alone says of where it comes from.
    fn provenance(&self) -> serde_json::Value {
        serde_json::json!({
            "name": self.name,
            "title": self.title,
            "seed": self.seed.0,
            "lengthMm": graph::rounded(self.margin.length_mm()),
            "settingsSha256": settings_sha256(self.spec_toml),
        })
    }

    fn manifest(&self, files: Vec<FileRecord>, unreached_sources: usize) -> Manifest {
        let uv_from_mm = SideMapping::of(&self.textures.frame);
        Manifest {
            version: 1,
            generator: GENERATOR.to_owned(),
            name: self.name.to_owned(),
            title: self.title.to_owned(),
            seed: self.seed.0,
            settings_sha256: settings_sha256(self.spec_toml),
            profile: self.output.profile.word().to_owned(),
            albedo: self.textures.albedo.word().to_owned(),
            size_px: self.textures.front.base_colour.width(),
            length_mm: graph::rounded(self.margin.length_mm()),
            area_mm2: graph::rounded(self.margin.area_mm2()),
            height_range_mm: graph::rounded(self.textures.height_range_mm),
            thickness_range_mm: graph::rounded(self.textures.thickness_range_mm),
            petiole_pivot: uv_from_mm.place(self.textures.petiole_end),
            base: uv_from_mm.place(DVec2::ZERO),
            apex: uv_from_mm.place(self.margin.apex()),
            uv_from_mm,
            nodes: self.venation.graph().len(),
            unreached_sources,
            files,
        }
    }
}
