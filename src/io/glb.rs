//! The leaf as a card in one file: binary glTF 2.0, pictures inside.
//!
//! What programs make of a glTF leaf decides what stands in it:
//!
//! - `MASK` at 0.5 cuts the blade out everywhere; `BLEND` sorts wrongly in crowns.
//! - `metallicFactor` is 0, for left out it is 1.
//! - Both sheets are double sided, so that neither side is ever missing; each hides the other's back.
//! - `KHR_materials_diffuse_transmission` says how light comes through. It is used and never required:
//!   programs that do not know it show an opaque leaf instead of none. Its amount lies in the alpha of
//!   the packed map, which occlusion and roughness do not read.
//! - Tangents are written: on a flat sheet they are those that MikkTSpace finds.
//!
//! Source: Khronos, "glTF 2.0 Specification" and the extension's readme. Units are metres, y up; v runs
//! down the picture.

use serde_json::{Value, json};

use super::card::{Card, Side};

/// The pictures of one side, as PNG files.
#[derive(Debug, Clone)]
pub struct Pictures {
    /// Colour, coverage in alpha.
    pub base_colour: Vec<u8>,
    /// Normals, OpenGL.
    pub normal: Vec<u8>,
    /// Occlusion, roughness, metal, transmission.
    pub orm: Vec<u8>,
    /// Colour of the light that comes through.
    pub translucency: Vec<u8>,
}

impl Pictures {
    /// Names (ends of names) and files, in the order of the textures.
    fn files(&self) -> [(&'static str, &[u8]); 4] {
        [
            ("BaseColor", &self.base_colour),
            ("Normal", &self.normal),
            ("ORM", &self.orm),
            ("Translucency", &self.translucency),
        ]
    }
}

/// Where each picture stands among the textures of its side.
const BASE_COLOUR: usize = 0;
const NORMAL: usize = 1;
const ORM: usize = 2;
const TRANSLUCENCY: usize = 3;
const TEXTURES_A_SIDE: usize = 4;

/// Opaque from this coverage on.
const ALPHA_CUTOFF: f64 = 0.5;

/// The file. `provenance` is laid beside the generator's name, for who asks how the leaf was made.
#[must_use]
pub fn glb(card: &Card<'_>, sides: &[Pictures; 2], provenance: &Value) -> Vec<u8> {
    let mut buffer = Buffer::default();
    let mut primitives = Vec::new();
    let (mut images, mut textures, mut materials) = (Vec::new(), Vec::new(), Vec::new());
    for (index, (side, pictures)) in Side::ALL.into_iter().zip(sides).enumerate() {
        primitives.push(primitive(card, side, index, &mut buffer));
        for (name, file) in pictures.files() {
            let view = buffer.view(file, None);
            textures.push(json!({ "sampler": 0, "source": images.len() }));
            images.push(json!({
                "name": format!("{}_{}_{name}", card.stem, side.word()),
                "mimeType": "image/png",
                "bufferView": view,
            }));
        }
        materials.push(material(card, side, index * TEXTURES_A_SIDE));
    }
    let document = json!({
        "asset": { "version": "2.0", "generator": super::GENERATOR, "extras": provenance },
        "extensionsUsed": [TRANSMISSION],
        "scene": 0,
        "scenes": [{ "name": card.stem, "nodes": [0] }],
        "nodes": [{ "name": card.stem, "mesh": 0 }],
        "meshes": [{ "name": card.stem, "primitives": primitives }],
        "materials": materials,
        "textures": textures,
        "images": images,
        // Linear, mip maps linear, edges clamped: what lies across the edge is not leaf.
        "samplers": [
            { "magFilter": 9729, "minFilter": 9987, "wrapS": 33071, "wrapT": 33071 }
        ],
        "accessors": buffer.accessors,
        "bufferViews": buffer.views,
        "buffers": [{ "byteLength": buffer.bytes.len() }],
    });
    container(&document, buffer.bytes)
}

const TRANSMISSION: &str = "KHR_materials_diffuse_transmission";

fn material(card: &Card<'_>, side: Side, first: usize) -> Value {
    let texture = |offset: usize| json!({ "index": first + offset });
    json!({
        "name": format!("{}_{}", card.stem, side.word()),
        "pbrMetallicRoughness": {
            "baseColorTexture": texture(BASE_COLOUR),
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
            "metallicRoughnessTexture": texture(ORM),
        },
        "normalTexture": texture(NORMAL),
        "occlusionTexture": texture(ORM),
        "alphaMode": "MASK",
        "alphaCutoff": ALPHA_CUTOFF,
        "doubleSided": true,
        "extensions": { (TRANSMISSION): {
            "diffuseTransmissionFactor": 1.0,
            "diffuseTransmissionTexture": texture(ORM),
            "diffuseTransmissionColorTexture": texture(TRANSLUCENCY),
        } },
    })
}

fn primitive(card: &Card<'_>, side: Side, material: usize, buffer: &mut Buffer) -> Value {
    let corners = card.corners(side);
    let facing = match side {
        Side::Front => 1.0,
        Side::Back => -1.0,
    };
    let positions: Vec<[f32; 3]> = corners.iter().map(|c| c.position.map(|x| x as f32)).collect();
    let uvs: Vec<[f32; 2]> =
        corners.iter().map(|c| [c.uv[0] as f32, (1.0 - c.uv[1]) as f32]).collect();
    let count = corners.len();
    let indices: Vec<u32> = card.triangles(side).into_iter().flatten().collect();
    json!({
        "attributes": {
            "POSITION": buffer.vectors(&positions, true),
            "NORMAL": buffer.vectors(&vec![[0.0, 0.0, facing]; count], false),
            // To the right on the picture; the fourth number turns the bitangent up it.
            "TANGENT": buffer.vectors(&vec![[facing, 0.0, 0.0, 1.0]; count], false),
            "TEXCOORD_0": buffer.vectors(&uvs, false),
        },
        "indices": buffer.indices(&indices),
        "material": material,
    })
}

/// The binary chunk, and what says where things lie in it.
#[derive(Debug, Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

/// `componentType` and `target` as glTF numbers them.
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

impl Buffer {
    fn view(&mut self, content: &[u8], target: Option<u32>) -> usize {
        // Every view starts where numbers of four bytes may.
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        let mut view = json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": content.len()
        });
        if let Some(target) = target {
            view["target"] = target.into();
        }
        self.bytes.extend_from_slice(content);
        self.views.push(view);
        self.views.len() - 1
    }

    fn vectors<const N: usize>(&mut self, vectors: &[[f32; N]], bounds: bool) -> usize {
        let bytes: Vec<u8> = vectors.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let mut accessor = json!({
            "bufferView": self.view(&bytes, Some(ARRAY_BUFFER)),
            "componentType": FLOAT,
            "count": vectors.len(),
            "type": format!("VEC{N}"),
        });
        if bounds {
            let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
                (0..N).filter_map(|k| vectors.iter().map(|v| v[k]).reduce(pick)).collect()
            };
            accessor["min"] = bound(f32::min).into();
            accessor["max"] = bound(f32::max).into();
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn indices(&mut self, indices: &[u32]) -> usize {
        // 65535 is taken: it restarts a primitive.
        let short: Option<Vec<u16>> =
            indices.iter().map(|&i| u16::try_from(i).ok().filter(|&i| i < u16::MAX)).collect();
        let (kind, bytes): (u32, Vec<u8>) = match short {
            Some(short) => (UNSIGNED_SHORT, short.iter().flat_map(|i| i.to_le_bytes()).collect()),
            None => (UNSIGNED_INT, indices.iter().flat_map(|i| i.to_le_bytes()).collect()),
        };
        let view = self.view(&bytes, Some(ELEMENT_ARRAY_BUFFER));
        self.accessors.push(json!({
            "bufferView": view, "componentType": kind, "count": indices.len(), "type": "SCALAR"
        }));
        self.accessors.len() - 1
    }
}

/// Header and two chunks, each filled up to a multiple of four bytes.
fn container(document: &Value, mut binary: Vec<u8>) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = 12 + 8 + text.len() + 8 + binary.len();
    let word = |n: usize| u32::try_from(n).expect("a GLB of less than 4 GiB").to_le_bytes();
    let mut file = Vec::with_capacity(length);
    file.extend(b"glTF");
    file.extend(word(2));
    file.extend(word(length));
    for (kind, chunk) in [(b"JSON", text), (b"BIN\0", binary)] {
        file.extend(word(chunk.len()));
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
