//! What a run has written, for programs: `manifest.json`.
//!
//! Every file with its meaning, colour space, size and hash, and the numbers that place the pictures
//! on the leaf: none of it can be read off the pictures. No dates and no folders of this machine:
//! same leaf, same bytes.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::graph::rounded;
use crate::units::TextureFrame;

/// The content of a `manifest.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of this format: 1.
    pub version: u32,
    /// The program and its version.
    pub generator: String,
    /// Name of the leaf.
    pub name: String,
    /// What it is, for people; may be empty.
    pub title: String,
    /// The seed it was drawn from.
    pub seed: u64,
    /// What the base colour holds: `total` reflectance, or `diffuse`, less the mirror part of the
    /// surface.
    pub albedo: String,
    /// Side of the maps (pixels).
    pub size_px: usize,
    /// Blade from base to apex (mm).
    pub length_mm: f64,
    /// Area of the blade (mm²).
    pub area_mm2: f64,
    /// Height of the highest over the lowest value of the height maps (mm).
    pub height_range_mm: f64,
    /// Thickness that the greatest value of the thickness maps stands for (mm).
    pub thickness_range_mm: f64,
    /// Where the leaf hangs on its stem: the far end of the petiole.
    pub petiole_pivot: Place,
    /// Where the blade begins.
    pub base: Place,
    /// Where the blade ends.
    pub apex: Place,
    /// From leaf space to the maps: u to the right, v up from the lower left corner.
    pub uv_from_mm: SideMapping,
    /// Nodes in the vein pattern.
    pub nodes: usize,
    /// Auxin sources that no vein reached.
    pub unreached_sources: usize,
    /// Every other file, in the order of writing.
    pub files: Vec<FileRecord>,
}

/// A place on the leaf.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// In leaf space (mm): base at the origin, apex on +y.
    pub mm: [f64; 2],
    /// On the front maps.
    pub uv: [f64; 2],
    /// On the back maps, which are mirrored.
    pub uv_back: [f64; 2],
}

/// How leaf space lies on the maps of each side.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct SideMapping {
    /// The upper side.
    pub front: Mapping,
    /// The lower side.
    pub back: Mapping,
}

/// `uv = scale * mm + offset`, each coordinate by itself.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Mapping {
    /// Share of the picture per mm.
    pub scale: [f64; 2],
    /// Where the base of the blade lies.
    pub offset: [f64; 2],
}

/// One file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Relative to the manifest, with `/`.
    pub path: String,
    /// The map, by the word that asks for it; absent where the file is none, as are `side` … `height`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub map: Option<String>,
    /// What it holds.
    pub meaning: String,
    /// `front` or `back`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub side: Option<String>,
    /// `rgba`, `rgb`, `grey+alpha` or `grey`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub channels: Option<String>,
    /// Bits of a channel.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub bits: Option<u8>,
    /// `sRGB` or `linear`.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub colour_space: Option<String>,
    /// Pixels in a row.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub width: Option<usize>,
    /// Rows.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub height: Option<usize>,
    /// Length of the file.
    pub bytes: usize,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

impl SideMapping {
    /// The mapping of a square of leaf space; the back is mirrored left to right.
    #[must_use]
    pub fn of(frame: &TextureFrame) -> Self {
        let scale = 1.0 / frame.side_mm;
        let DVec2 { x, y } = -frame.min * scale;
        Self {
            front: Mapping { scale: [scale, scale], offset: [x, y] },
            back: Mapping { scale: [-scale, scale], offset: [1.0 - x, y] },
        }
    }

    /// A point of leaf space (mm) as a place.
    #[must_use]
    pub fn place(&self, p: DVec2) -> Place {
        let uv = |m: &Mapping| DVec2::from(m.scale) * p + DVec2::from(m.offset);
        let array = |p: DVec2| p.to_array().map(rounded);
        Place { mm: array(p), uv: array(uv(&self.front)), uv_back: array(uv(&self.back)) }
    }
}

impl Manifest {
    /// As indented JSON; keys in the order of the fields.
    #[must_use]
    pub fn to_json(&self) -> String {
        let json = serde_json::to_string_pretty(self).expect("plain data has a form in JSON");
        json + "\n"
    }
}
