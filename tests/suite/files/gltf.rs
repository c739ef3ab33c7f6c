//! The card in binary glTF, by a reader of our own; by Khronos' validator where it is installed:
//! `VENATION_GLTF_VALIDATOR=/path/to/node_modules/gltf-validator cargo test --test suite -- --ignored glTF`.

use std::process::Command;

use glam::{DVec2, DVec3};
use serde_json::{Value, json};
use venation::io::{FormatKind, LeafFiles, MapKind, encode_leaf};
use venation::spec::{CardShape, Output};

use super::{SmallLeaf, bytes_of};

/// A GLB taken apart: its JSON and its binary chunk.
struct Glb<'a> {
    json: Value,
    binary: &'a [u8],
}

impl<'a> Glb<'a> {
    fn read(file: &'a [u8]) -> Self {
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!(&file[..4], b"glTF");
        assert_eq!((word(4), word(8)), (2, file.len()));
        let text = word(12);
        assert_eq!((&file[16..20], text % 4), (&b"JSON"[..], 0));
        let second = 20 + text;
        assert_eq!(&file[second + 4..second + 8], b"BIN\0");
        assert_eq!(second + 8 + word(second), file.len());
        let json = serde_json::from_slice(&file[20..second]).unwrap();
        Self { json, binary: &file[second + 8..] }
    }

    fn view(&self, index: &Value) -> &'a [u8] {
        let view = &self.json["bufferViews"][index.as_u64().unwrap() as usize];
        let number = |key: &str| view[key].as_u64().unwrap() as usize;
        assert_eq!(number("byteOffset") % 4, 0);
        &self.binary[number("byteOffset")..number("byteOffset") + number("byteLength")]
    }

    /// The numbers of an accessor, `width` to the element.
    fn numbers(&self, index: &Value, width: usize) -> Vec<Vec<f64>> {
        let accessor = &self.json["accessors"][index.as_u64().unwrap() as usize];
        let bytes = self.view(&accessor["bufferView"]);
        let numbers: Vec<f64> = match accessor["componentType"].as_u64().unwrap() {
            5123 => bytes.as_chunks().0.iter().map(|b| f64::from(u16::from_le_bytes(*b))).collect(),
            5125 => bytes.as_chunks().0.iter().map(|b| f64::from(u32::from_le_bytes(*b))).collect(),
            5126 => bytes.as_chunks().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect(),
            other => panic!("component type {other}"),
        };
        assert_eq!(numbers.len(), width * accessor["count"].as_u64().unwrap() as usize);
        numbers.chunks(width).map(<[f64]>::to_vec).collect()
    }

    fn image_of(&self, texture: &Value) -> &'a [u8] {
        let texture = &self.json["textures"][texture["index"].as_u64().unwrap() as usize];
        let image = &self.json["images"][texture["source"].as_u64().unwrap() as usize];
        assert_eq!(image["mimeType"], "image/png");
        self.view(&image["bufferView"])
    }
}

fn glb_only(card: CardShape) -> Output {
    Output { maps: Vec::new(), formats: vec![FormatKind::Glb], card, ..Output::standard() }
}

#[test]
fn the_material_is_a_leafs() {
    let leaf = SmallLeaf::new("oak");
    let files = encode_leaf(&LeafFiles { output: &glb_only(CardShape::Square), ..leaf.files() });
    let glb = Glb::read(bytes_of(&files, "oak.glb"));
    let transmission = "KHR_materials_diffuse_transmission";
    assert_eq!(glb.json["asset"]["version"], "2.0");
    assert_eq!(glb.json["extensionsUsed"], json!([transmission]));
    assert_eq!(glb.json.get("extensionsRequired"), None);
    let materials = glb.json["materials"].as_array().unwrap();
    assert_eq!(materials.len(), 2);
    for (material, side) in materials.iter().zip([&leaf.textures.front, &leaf.textures.back]) {
        assert_eq!(material["alphaMode"], "MASK");
        assert_eq!(material["alphaCutoff"], 0.5);
        assert_eq!(material["doubleSided"], true);
        let surface = &material["pbrMetallicRoughness"];
        assert_eq!(surface["metallicFactor"], 0.0);
        let extension = &material["extensions"][transmission];
        let decoded = |texture: &Value| image::load_from_memory(glb.image_of(texture)).unwrap();
        let colour = decoded(&surface["baseColorTexture"]);
        assert_eq!(colour.as_rgba8().unwrap().as_raw(), side.base_colour.values().as_flattened());
        let normal = decoded(&material["normalTexture"]);
        assert_eq!(normal.as_rgb8().unwrap().as_raw(), side.normal.values().as_flattened());
        // One packed picture serves occlusion, roughness and the amount of transmission.
        let packed = &surface["metallicRoughnessTexture"];
        assert_eq!(packed, &material["occlusionTexture"]);
        assert_eq!(packed, &extension["diffuseTransmissionTexture"]);
        assert_eq!(*decoded(packed).as_rgba8().unwrap().as_raw(), side.samples(MapKind::Orm));
        let through = decoded(&extension["diffuseTransmissionColorTexture"]);
        let expected = side.translucency.values().as_flattened();
        assert_eq!(through.as_rgb8().unwrap().as_raw(), expected);
    }
}

#[test]
fn both_sheets_lie_on_the_leaf_with_tangents_along_their_pictures() {
    let leaf = SmallLeaf::new("oak");
    for card in [CardShape::Square, CardShape::Outline] {
        let files = encode_leaf(&LeafFiles { output: &glb_only(card), ..leaf.files() });
        let glb = Glb::read(bytes_of(&files, "oak.glb"));
        let primitives = glb.json["meshes"][0]["primitives"].as_array().unwrap();
        assert_eq!(primitives.len(), 2);
        for (i, primitive) in primitives.iter().enumerate() {
            let of = |name: &str, width| glb.numbers(&primitive["attributes"][name], width);
            let positions: Vec<DVec3> =
                of("POSITION", 3).iter().map(|p| DVec3::new(p[0], p[1], p[2])).collect();
            let accessor = primitive["attributes"]["POSITION"].as_u64().unwrap() as usize;
            for (key, pick) in [("min", f64::min as fn(f64, f64) -> f64), ("max", f64::max)] {
                let bound: Vec<f64> =
                    (0..3).map(|k| positions.iter().map(|p| p[k]).reduce(pick).unwrap()).collect();
                assert_eq!(glb.json["accessors"][accessor][key], json!(bound));
            }
            let facing = if i == 0 { 1.0 } else { -1.0 };
            let (uvs, tangents) = (of("TEXCOORD_0", 2), of("TANGENT", 4));
            for normal in of("NORMAL", 3) {
                assert_eq!(normal, [0.0, 0.0, facing]);
            }
            // v runs down; the back picture is mirrored.
            for (p, uv) in positions.iter().zip(&uvs) {
                let mut expected = leaf.textures.frame.uv_from_leaf(DVec2::new(p.x, p.y) * 1e3);
                if i == 1 {
                    expected.x = 1.0 - expected.x;
                }
                assert!(expected.distance(DVec2::new(uv[0], 1.0 - uv[1])) < 1e-5);
            }
            let indices = glb.numbers(&primitive["indices"], 1);
            for triangle in indices.chunks(3) {
                let [a, b, c] = [0, 1, 2].map(|k| triangle[k][0] as usize);
                let normal = (positions[b] - positions[a]).cross(positions[c] - positions[a]);
                assert!(normal.z * facing > 0.0, "wound the right way");
                // The tangent is where u grows, the bitangent where v falls.
                let at = |k: usize| DVec2::new(uvs[k][0], uvs[k][1]);
                let (e, f) = (at(b) - at(a), at(c) - at(a));
                let (p, q) = (positions[b] - positions[a], positions[c] - positions[a]);
                let along_u = (p * f.y - q * e.y) / e.perp_dot(f);
                let along_v = (q * e.x - p * f.x) / e.perp_dot(f);
                let t = &tangents[a];
                let tangent = DVec3::new(t[0], t[1], t[2]);
                let bitangent = DVec3::new(0.0, 0.0, facing).cross(tangent) * t[3];
                assert!(tangent.dot(along_u.normalize()) > 0.999);
                assert!(bitangent.dot(along_v.normalize()) < -0.999);
            }
        }
    }
}

/// Prints the validator's report of the files named, one JSON a line.
const SCRIPT: &str = "
const validator = require(process.argv[1]);
const fs = require('fs');
(async () => {
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)));
    console.log(JSON.stringify(report.issues));
  }
})();
";

#[test]
#[ignore = "needs npm's gltf-validator: set VENATION_GLTF_VALIDATOR to its folder"]
fn the_gltf_validator_has_nothing_to_say() {
    let Ok(validator) = std::env::var("VENATION_GLTF_VALIDATOR") else {
        eprintln!("skipped: set VENATION_GLTF_VALIDATOR to the folder of npm's gltf-validator");
        return;
    };
    let folder = crate::support::fresh();
    let mut command = Command::new("node");
    command.args(["-e", SCRIPT, &validator]);
    for preset in ["maple", "willow", "ginkgo"] {
        for card in ["square", "outline"] {
            let out = format!("{preset}-{card}");
            let arguments =
                ["generate", preset, "--size", "256", "--format", "glb", "--card", card];
            crate::support::succeed(folder.path(), &[&arguments[..], &["-o", &out]].concat());
            let glb = crate::support::contents(&folder.path().join(&out));
            let glb = glb.keys().find(|path| path.extension().is_some_and(|e| e == "glb")).unwrap();
            command.arg(folder.path().join(&out).join(glb));
        }
    }
    let output = command.output().expect("node starts");
    let text = String::from_utf8(output.stdout).unwrap();
    assert_eq!(text.lines().count(), 6, "{}", String::from_utf8_lossy(&output.stderr));
    for line in text.lines() {
        let issues: Value = serde_json::from_str(line).unwrap();
        assert_eq!(
            (&issues["numErrors"], &issues["numWarnings"]),
            (&json!(0), &json!(0)),
            "{line}"
        );
        // What is left is that it does not know the extension.
        for message in issues["messages"].as_array().unwrap() {
            let code = message["code"].as_str().unwrap();
            assert!(["UNSUPPORTED_EXTENSION", "UNUSED_OBJECT"].contains(&code), "{line}");
        }
    }
}
