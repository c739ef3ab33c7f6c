//! An atlas: one set of maps with many leaves on it, and `atlas.json`, which tells them apart.
//!
//! Programs count v from the bottom (OpenGL, Unity, Blender) or from the top (DirectX, Unreal, glTF): both
//! are there for everything. The back maps are the mirrored sheet: their u is 1 less that of the front.

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;

use super::graph::rounded;
use super::manifest::FileRecord;
use super::map_files::{self, Pictures, Texts};
use super::{GENERATOR, file_stem};
use crate::geometry::polygon;
use crate::margin::Margin;
use crate::spec::Output;
use crate::texture::TextureSet;
use crate::texture::atlas::PixelRect;
use crate::units::TextureFrame;

/// What tells of an atlas.
pub const ATLAS_FILE: &str = "atlas.json";

/// A leaf that lies on the sheet.
#[derive(Debug, Clone)]
pub struct AtlasLeaf {
    /// Its seed.
    pub seed: u64,
    /// Its outline.
    pub margin: Margin,
    /// The end of its petiole (mm).
    pub petiole_end: DVec2,
    /// Its resolved settings.
    pub spec_toml: String,
    /// What its own pictures show.
    pub frame: TextureFrame,
    /// Side of its own pictures (pixels).
    pub painted_px: usize,
    /// The part of them that lies on the sheet.
    pub from: PixelRect,
    /// Where that part lies.
    pub rect: PixelRect,
}

/// An atlas and how it is to be written.
#[derive(Debug, Clone, Copy)]
pub struct AtlasFiles<'a> {
    /// Name of the leaves.
    pub name: &'a str,
    /// What they are, for people.
    pub title: &'a str,
    /// The sheet.
    pub textures: &'a TextureSet,
    /// The leaves on it.
    pub leaves: &'a [AtlasLeaf],
    /// Pixels that are free between leaves at least.
    pub padding_px: usize,
    /// Which maps, and how.
    pub output: &'a Output,
}

#[derive(Debug, Serialize)]
struct AtlasDocument {
    version: u32,
    generator: String,
    name: String,
    title: String,
    size_px: usize,
    padding_px: usize,
    /// Share of the sheet inside the leaves' rectangles.
    packed: f64,
    height_range_mm: f64,
    thickness_range_mm: f64,
    profile: String,
    leaves: Vec<LeafRecord>,
    files: Vec<FileRecord>,
}

#[derive(Debug, Serialize)]
struct LeafRecord {
    index: usize,
    seed: u64,
    settings: String,
    settings_sha256: String,
    length_mm: f64,
    /// Width and height of what the rectangle shows.
    size_mm: [f64; 2],
    pixels_per_mm: f64,
    rect: RectRecord,
    /// Where it hangs on its stem: the far end of the petiole.
    pivot: Point,
    base: Point,
    apex: Point,
    /// From base to apex, on the picture, y up.
    growth_direction: [f64; 2],
    /// The margin, v from the bottom, anticlockwise.
    outline_uv: Vec<[f64; 2]>,
}

#[derive(Debug, Serialize)]
struct RectRecord {
    /// From the left and from the top.
    x: usize,
    y: usize,
    width: usize,
    height: usize,
    uv_bottom_left: UvBox,
    uv_top_left: UvBox,
}

/// Least and greatest u and v.
#[derive(Debug, Serialize)]
struct UvBox {
    min: [f64; 2],
    max: [f64; 2],
}

#[derive(Debug, Serialize)]
struct Point {
    /// In leaf space.
    mm: [f64; 2],
    /// From the left and from the top.
    px: [f64; 2],
    uv_bottom_left: [f64; 2],
    uv_top_left: [f64; 2],
}

/// What [`encode_atlas`] will make of these seeds, in the same order.
#[must_use]
pub fn atlas_file_names(name: &str, size_px: usize, seeds: &[u64], output: &Output) -> Vec<String> {
    let settings = seeds.iter().map(|&seed| settings_file(name, seed));
    let maps = map_files::list(&sheet_name(name), size_px, output);
    settings.chain(maps.into_iter().map(|(path, _)| path)).chain([ATLAS_FILE.to_owned()]).collect()
}

fn sheet_name(name: &str) -> String {
    format!("{name}_atlas")
}

fn settings_file(name: &str, seed: u64) -> String {
    format!("leaves/{}_s{seed:04}.toml", file_stem(name))
}

/// Everything that is written of an atlas: relative names with `/`, and bytes, `atlas.json` last.
#[must_use]
pub fn encode_atlas(atlas: &AtlasFiles<'_>) -> Vec<(String, Vec<u8>)> {
    let pictures = Pictures::new(atlas.textures, atlas.output);
    let seeds: Vec<String> = atlas.leaves.iter().map(|leaf| leaf.seed.to_string()).collect();
    let settings = atlas.leaves.first().map_or("", |leaf| leaf.spec_toml.as_str());
    let title = if atlas.title.is_empty() { atlas.name } else { atlas.title };
    let seeds = seeds.join(",");
    let texts = Texts { title, name: atlas.name, seed: &seeds, settings };
    let mut files: Vec<(String, Vec<u8>)> = atlas
        .leaves
        .iter()
        .map(|leaf| (settings_file(atlas.name, leaf.seed), leaf.spec_toml.clone().into_bytes()))
        .collect();
    let mut records: Vec<FileRecord> = files
        .iter()
        .map(|(path, bytes)| FileRecord::new(path, "the resolved settings of a leaf", bytes))
        .collect();
    let maps = map_files::list(&sheet_name(atlas.name), atlas.textures.front.size(), atlas.output);
    let encoded: Vec<((String, Vec<u8>), FileRecord)> = maps
        .into_par_iter()
        .map(|(path, file)| {
            let bytes = pictures.encode(file, &texts);
            let mut record = FileRecord::new(&path, file.map.meaning(), &bytes);
            pictures.describe(file, &mut record);
            ((path, bytes), record)
        })
        .collect();
    let (maps, of_maps): (Vec<_>, Vec<_>) = encoded.into_iter().unzip();
    files.extend(maps);
    records.extend(of_maps);
    let document = atlas.document(records);
    let json = serde_json::to_string_pretty(&document).expect("plain data has a form in JSON");
    files.push((ATLAS_FILE.to_owned(), (json + "\n").into_bytes()));
    files
}

impl AtlasFiles<'_> {
    fn document(&self, files: Vec<FileRecord>) -> AtlasDocument {
        let size = self.textures.front.size();
        let filled: usize = self.leaves.iter().map(|leaf| leaf.rect.width * leaf.rect.height).sum();
        let leaves = self.leaves.iter().enumerate();
        AtlasDocument {
            version: 1,
            generator: GENERATOR.to_owned(),
            name: self.name.to_owned(),
            title: self.title.to_owned(),
            size_px: size,
            padding_px: self.padding_px,
            packed: rounded(filled as f64 / (size * size) as f64),
            height_range_mm: rounded(self.textures.height_range_mm),
            thickness_range_mm: rounded(self.textures.thickness_range_mm),
            profile: self.output.profile.word().to_owned(),
            leaves: leaves.map(|(i, leaf)| leaf.record(i, self.name, size)).collect(),
            files,
        }
    }
}

impl AtlasLeaf {
    /// The place on the sheet (pixels from the upper left corner) of a point of leaf space.
    #[must_use]
    pub fn pixel(&self, p: DVec2) -> DVec2 {
        let own = self.frame.pixel_from_leaf(p, self.painted_px);
        let corner = |r: PixelRect| DVec2::new(r.x as f64, r.y as f64);
        own - corner(self.from) + corner(self.rect)
    }

    fn record(&self, index: usize, name: &str, size: usize) -> LeafRecord {
        let point = |p: DVec2| {
            let px = self.pixel(p);
            let uv = px / size as f64;
            Point {
                mm: p.to_array().map(rounded),
                px: px.to_array().map(rounded),
                uv_bottom_left: [uv.x, 1.0 - uv.y].map(rounded),
                uv_top_left: uv.to_array().map(rounded),
            }
        };
        let per_mm = self.frame.pixels_per_mm(self.painted_px);
        let PixelRect { x, y, width, height } = self.rect;
        let share = |pixels: usize| rounded(pixels as f64 / size as f64);
        let [u0, u1] = [share(x), share(x + width)];
        let outline: Vec<DVec2> = self.margin.outline().iter().map(|&p| self.pixel(p)).collect();
        // Half a pixel is as near as the picture knows it.
        let kept = polygon::simplified(&outline, 0.5, &[]);
        let direction = (self.margin.apex() - self.margin.outline()[0]).normalize_or(DVec2::Y);
        LeafRecord {
            index,
            seed: self.seed,
            settings: settings_file(name, self.seed),
            settings_sha256: super::settings_sha256(&self.spec_toml),
            length_mm: rounded(self.margin.length_mm()),
            size_mm: [width, height].map(|pixels| rounded(pixels as f64 / per_mm)),
            pixels_per_mm: rounded(per_mm),
            rect: RectRecord {
                x,
                y,
                width,
                height,
                uv_bottom_left: UvBox {
                    min: [u0, share(size - y - height)],
                    max: [u1, share(size - y)],
                },
                uv_top_left: UvBox { min: [u0, share(y)], max: [u1, share(y + height)] },
            },
            pivot: point(self.petiole_end),
            base: point(self.margin.outline()[0]),
            apex: point(self.margin.apex()),
            growth_direction: direction.to_array().map(rounded),
            outline_uv: kept
                .into_iter()
                .map(|i| outline[i] / size as f64)
                .map(|uv| [uv.x, 1.0 - uv.y].map(rounded))
                .collect(),
        }
    }
}
