//! All files of a leaf: what is written, what it is called and what it says.

use glam::DVec2;
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::image::{Caption, map_png};
use super::manifest::{FileRecord, Manifest, SideMapping};
use super::tables::Table;
use super::{FormatKind, GENERATOR, MANIFEST_FILE, SPEC_FILE};
use super::{file_stem, graph, graphml, obj, svg};
use crate::margin::Margin;
use crate::seed::Seed;
use crate::texture::map::MapKind;
use crate::texture::{SideMaps, TextureSet};
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
    /// Its pictures.
    pub textures: &'a TextureSet,
    /// The resolved settings.
    pub spec_toml: &'a str,
    /// Shine of the upper side, 0–1.
    pub specularity: f64,
    /// Roughness of the surface, 0–1.
    pub roughness: f64,
    /// The maps to write of each side.
    pub maps: &'a [MapKind],
    /// The other forms to write.
    pub formats: &'a [FormatKind],
}

/// What [`encode_leaf`] will make of a leaf of this name, in the same order.
#[must_use]
pub fn file_names(name: &str, maps: &[MapKind], formats: &[FormatKind]) -> Vec<String> {
    let entries = entries(&file_stem(name), maps, formats);
    entries.into_iter().map(|(path, _)| path).chain([MANIFEST_FILE.to_owned()]).collect()
}

/// Everything that is written of a leaf: relative names with `/`, and bytes.
///
/// The same leaf gives the same bytes on any number of threads; names come in a fixed order, the
/// manifest last.
#[must_use]
pub fn encode_leaf(leaf: &LeafFiles<'_>) -> Vec<(String, Vec<u8>)> {
    let stem = file_stem(leaf.name);
    let encoded: Vec<((String, Vec<u8>), FileRecord)> = entries(&stem, leaf.maps, leaf.formats)
        .into_par_iter()
        .map(|(path, content)| {
            let bytes = content.encode(leaf, &stem);
            let record = content.record(leaf, &path, &bytes);
            ((path, bytes), record)
        })
        .collect();
    let (mut files, records): (Vec<_>, Vec<_>) = encoded.into_iter().unzip();
    files.push((MANIFEST_FILE.to_owned(), leaf.manifest(records).to_json().into_bytes()));
    files
}

/// What is in a file.
#[derive(Debug, Clone, Copy)]
enum Content {
    Map(Side, MapKind),
    Spec,
    Card,
    Materials,
    Drawing,
    Graph,
    GraphMl,
    Table(Table),
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    Front,
    Back,
}

/// Every file but the manifest. Words that were asked for twice count once.
fn entries(stem: &str, maps: &[MapKind], formats: &[FormatKind]) -> Vec<(String, Content)> {
    // The settings come first: a run that was killed can tell from them what it was making.
    let mut entries = vec![(SPEC_FILE.to_owned(), Content::Spec)];
    for (folder, side) in [("", Side::Front), ("back/", Side::Back)] {
        for &map in MapKind::ALL.iter().filter(|map| maps.contains(map)) {
            if side == Side::Back && !map.has_back() {
                continue;
            }
            let path = format!("{folder}{stem}_{}.png", map.suffix());
            entries.push((path, Content::Map(side, map)));
        }
    }
    for format in FormatKind::ALL.iter().filter(|format| formats.contains(format)) {
        match format {
            FormatKind::Obj => {
                entries.push((format!("{stem}.obj"), Content::Card));
                entries.push((format!("{stem}.mtl"), Content::Materials));
            }
            FormatKind::Svg => entries.push((format!("{stem}.svg"), Content::Drawing)),
            FormatKind::Json => entries.push((format!("{stem}_veins.json"), Content::Graph)),
            FormatKind::GraphMl => {
                entries.push((format!("{stem}_veins.graphml"), Content::GraphMl));
            }
            FormatKind::Csv => entries.extend(
                Table::ALL
                    .iter()
                    .map(|&table| (format!("{stem}_{}.csv", table.word()), Content::Table(table))),
            ),
        }
    }
    entries
}

impl Side {
    const fn word(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }
}

impl Content {
    fn encode(self, leaf: &LeafFiles<'_>, stem: &str) -> Vec<u8> {
        let frame = &leaf.textures.frame;
        let card = obj::Card {
            stem,
            maps: leaf.maps,
            frame,
            specularity: leaf.specularity,
            roughness: leaf.roughness,
        };
        match self {
            Self::Map(side, map) => leaf.encode_map(side, map),
            Self::Spec => leaf.spec_toml.into(),
            Self::Card => card.obj().into(),
            Self::Materials => card.mtl().into(),
            Self::Drawing => {
                let rings = &leaf.textures.rings;
                svg::svg(leaf.shown_name(), leaf.margin, Some(leaf.venation), frame, rings).into()
            }
            Self::Graph => graph::VeinDocument::new(leaf.margin, leaf.venation).to_json().into(),
            Self::GraphMl => graphml::graphml(leaf.venation).into(),
            Self::Table(table) => table.csv(leaf.margin, leaf.venation).into(),
        }
    }

    const fn meaning(self) -> &'static str {
        match self {
            Self::Map(_, map) => map.meaning(),
            Self::Spec => "the resolved settings; makes the same files again",
            Self::Card => {
                "card with both sides, in metres: base at the origin, apex on +y, upper side to +z"
            }
            Self::Materials => "materials of the card",
            Self::Drawing => "outline and veins in mm, a layer for every order",
            Self::Graph => "vein graph in mm: nodes with parent, radius and order",
            Self::GraphMl => "vein graph in mm for graph programs, loops included",
            Self::Table(table) => table.meaning(),
        }
    }

    fn record(self, leaf: &LeafFiles<'_>, path: &str, bytes: &[u8]) -> FileRecord {
        let picture = match self {
            Self::Map(side, map) => Some((side, map)),
            _ => None,
        };
        let map = picture.map(|(_, map)| map);
        FileRecord {
            path: path.to_owned(),
            map: map.map(|map| map.word().to_owned()),
            meaning: self.meaning().to_owned(),
            side: picture.map(|(side, _)| side.word().to_owned()),
            channels: map.map(|map| map.channels().word().to_owned()),
            bits: map.map(MapKind::bits),
            colour_space: map.map(|map| map.colour_space().to_owned()),
            width: picture.map(|(side, map)| leaf.maps_of(side).dimensions(map).0),
            height: picture.map(|(side, map)| leaf.maps_of(side).dimensions(map).1),
            bytes: bytes.len(),
            sha256: Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect(),
        }
    }
}

impl LeafFiles<'_> {
    /// The title, or the name where there is none.
    fn shown_name(&self) -> &str {
        if self.title.is_empty() { self.name } else { self.title }
    }

    fn maps_of(&self, side: Side) -> &SideMaps {
        match side {
            Side::Front => &self.textures.front,
            Side::Back => &self.textures.back,
        }
    }

    fn encode_map(&self, side: Side, map: MapKind) -> Vec<u8> {
        let maps = self.maps_of(side);
        let description = format!("{} side; {}", side.word(), map.meaning());
        let seed = self.seed.0.to_string();
        // The picture that is passed on alone carries the settings, so that it can be made again.
        let settings = (map == MapKind::BaseColour).then_some(("Settings", self.spec_toml));
        let texts: Vec<(&str, &str)> = [
            ("Title", self.shown_name()),
            ("Description", &description),
            ("Name", self.name),
            ("Seed", &seed),
        ]
        .into_iter()
        .chain(settings)
        .collect();
        let pixels_per_mm = self.textures.frame.pixels_per_mm(maps.base_colour.width());
        map_png(map, maps, &Caption { pixels_per_mm: Some(pixels_per_mm), texts: &texts })
    }

    fn manifest(&self, files: Vec<FileRecord>) -> Manifest {
        let uv_from_mm = SideMapping::of(&self.textures.frame);
        Manifest {
            version: 1,
            generator: GENERATOR.to_owned(),
            name: self.name.to_owned(),
            title: self.title.to_owned(),
            seed: self.seed.0,
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
            unreached_sources: self.venation.unreached().total(),
            files,
        }
    }
}
