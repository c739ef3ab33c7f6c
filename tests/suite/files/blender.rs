//! The cards in Blender, where Blender's Python module `bpy` is installed:
//! `VENATION_BPY=/path/to/python cargo test --test suite -- --ignored blender`.

use std::path::Path;
use std::process::Command;

use serde_json::Value;
use venation::io::write::{Overwrite, write_files};
use venation::io::{LeafFiles, encode_leaf};
use venation::raster::Grid;
use venation::spec::Output;

use super::{SIZE, SmallLeaf};

/// Imports a card, reports its materials, and takes a picture from either side by even light.
/// It leaves by `_exit`, since the module can crash while Python shuts down.
const SCRIPT: &str = r#"
import bpy, json, os, sys
folder, card = sys.argv[1], sys.argv[2]
bpy.ops.wm.read_factory_settings(use_empty=True)
if card.endswith(".glb"):
    bpy.ops.import_scene.gltf(filepath=folder + "/" + card)
else:
    bpy.ops.wm.obj_import(filepath=folder + "/" + card)
report = {"materials": {}, "pictures": {}}
for material in bpy.data.materials:
    shader = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    def source(name):
        links = shader.inputs[name].links
        if not links: return None
        node = links[0].from_node
        picture = node.type == "TEX_IMAGE" and (node.image.filepath or node.image.name)
        return [os.path.basename(picture) if picture else node.type, links[0].from_socket.name]
    spaces = [n.image.colorspace_settings.name for n in material.node_tree.nodes
              if n.type == "TEX_IMAGE"]
    report["materials"][material.name] = {
        "colour": source("Base Color"), "alpha": source("Alpha"),
        "normal": source("Normal"), "spaces": sorted(spaces),
        "metallic": shader.inputs["Metallic"].default_value,
        "roughness": shader.inputs["Roughness"].default_value,
        "specular": shader.inputs["Specular IOR Level"].default_value,
        "transmission": shader.inputs["Transmission Weight"].default_value}
card = [o for o in bpy.data.objects if o.type == "MESH"]
corners = [o.matrix_world @ v.co for o in card for v in o.data.vertices]
low = [min(c[k] for c in corners) for k in range(3)]
high = [max(c[k] for c in corners) for k in range(3)]
report["low"], report["high"] = low, high
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples = 4
scene.render.resolution_x = scene.render.resolution_y = 64
scene.render.film_transparent = True
scene.view_settings.view_transform = "Standard"
scene.world = bpy.data.worlds.new("even light")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (1, 1, 1, 1)
camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
scene.collection.objects.link(camera)
scene.camera = camera
camera.data.type = "ORTHO"
camera.data.ortho_scale = high[0] - low[0]
camera.data.clip_start = 0.001
middle = [(a + b) / 2 for a, b in zip(low, high)]
# The importer turns y up into z up, so the upper side looks along -y.
for side, sign in (("front", -1), ("back", 1)):
    camera.location = (middle[0], middle[1] + sign * 0.5, middle[2])
    camera.rotation_euler = (3.14159265 / 2, 0, 0 if sign < 0 else 3.14159265)
    scene.render.filepath = f"{folder}/{side}.png"
    bpy.ops.render.render(write_still=True)
with open(folder + "/report.json", "w") as file: json.dump(report, file)
os._exit(0)
"#;

/// What Blender makes of a card in a folder; `None`, said aloud, where there is no Blender.
fn shown(folder: &Path, card: &str) -> Option<Value> {
    let Ok(python) = std::env::var("VENATION_BPY") else {
        eprintln!("skipped: set VENATION_BPY to a Python that has bpy (pip install bpy)");
        return None;
    };
    let mut command = Command::new(python);
    let run = command.args(["-c", SCRIPT]).arg(folder).arg(card).output().expect("Python starts");
    let report = std::fs::read(folder.join("report.json"))
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    Some(serde_json::from_slice(&report).expect("a report"))
}

#[test]
#[ignore = "needs Blender's bpy: set VENATION_BPY to a Python that has it"]
fn blender_shows_a_glb_with_its_pictures() {
    let folder = crate::support::fresh();
    let arguments = ["generate", "linden", "--size", "256", "--format", "glb", "-o", "leaf"];
    crate::support::succeed(folder.path(), &arguments);
    let leaf = folder.path().join("leaf");
    let Some(report) = shown(&leaf, "tilia-cordata.glb") else { return };
    for side in ["front", "back"] {
        let material = &report["materials"][format!("tilia-cordata_{side}")];
        let colour = material["colour"][0].as_str().unwrap_or_default();
        assert!(colour.starts_with(&format!("tilia-cordata_{side}_BaseColor")), "{material}");
        assert!(!material["alpha"].is_null() && !material["normal"].is_null(), "{material}");
        assert_eq!(material["metallic"], 0.0, "{material}");
        assert_eq!(material["transmission"], 0.0, "{material}");
        let spaces = material["spaces"].as_array().expect("colour spaces");
        let colours = spaces.iter().filter(|space| *space == "sRGB").count();
        assert_eq!((colours, spaces.len() > colours), (1, true), "{material}");
    }
    let opacity = image::open(leaf.join("tilia-cordata_Opacity.png")).unwrap().into_luma8();
    for side in ["front", "back"] {
        let picture = image::open(leaf.join(format!("{side}.png"))).unwrap().into_rgba8();
        let (mut apart, mut covered, mut green) = (0, 0, 0);
        for (x, y, pixel) in picture.enumerate_pixels() {
            let x = if side == "front" { 4 * x + 2 } else { 255 - (4 * x + 2) };
            let expected = opacity.get_pixel(x, 4 * y + 2).0[0] > 127;
            apart += u32::from((pixel.0[3] > 127) != expected);
            covered += u32::from(expected);
            green += u32::from(pixel.0[3] > 127 && pixel.0[1] > pixel.0[2]);
        }
        assert!(apart < covered / 8, "{side}: {apart} of {covered} pixels differ");
        assert!(green > covered * 8 / 10, "{side}: {green} of {covered} are green");
    }
}

#[test]
#[ignore = "needs Blender's bpy: set VENATION_BPY to a Python that has it"]
fn blender_shows_both_sides_cut_out() {
    // Red in front, blue behind, and a silhouette that tells left from right and up from down.
    let mut leaf = SmallLeaf::new("oak");
    let covered = |x: usize, y: usize| x > SIZE / 4 && (x < SIZE / 2 || y > SIZE / 2);
    let picture = |colour: [u8; 3]| {
        let pixel = |i: usize| {
            let alpha = if covered(i % SIZE, i / SIZE) { 255 } else { 0 };
            [colour[0], colour[1], colour[2], alpha]
        };
        Grid::from_values(SIZE, SIZE, (0..SIZE * SIZE).map(pixel).collect())
    };
    leaf.textures.front.base_colour = picture([200, 30, 30]);
    leaf.textures.back.base_colour = picture([30, 30, 200]).mirrored();
    let folder = tempfile::tempdir().unwrap();
    let standard = Output::standard();
    let files = LeafFiles { output: &standard, ..leaf.files() };
    write_files(folder.path(), &encode_leaf(&files), Overwrite::Refuse).unwrap();
    let Some(report) = shown(folder.path(), "oak.obj") else { return };

    for (name, specular) in [("oak_front", 0.3), ("oak_back", 0.1)] {
        let material = &report["materials"][name];
        assert_eq!(material["colour"], serde_json::json!(["oak_BaseColor.png", "Color"]));
        assert_eq!(material["alpha"], serde_json::json!(["oak_Opacity.png", "Alpha"]));
        let number = |key: &str| material[key].as_f64().unwrap();
        assert!((number("specular") - specular).abs() < 1e-5, "{material}");
        assert!((0.6..0.9).contains(&number("roughness")), "{material}");
        assert_eq!(number("transmission"), 0.0);
    }
    let side_m = leaf.textures.frame.side_mm * 1e-3;
    let width = report["high"][0].as_f64().unwrap() - report["low"][0].as_f64().unwrap();
    assert!((width - side_m).abs() < 1e-6, "{report}");

    for (side, colour) in [("front", 0), ("back", 2)] {
        let path = folder.path().join(format!("{side}.png"));
        let picture = image::open(path).unwrap().into_rgba8();
        // A quarter of the way in from each edge of each cell of a 4 × 4 board.
        for (i, j) in (0..16).map(|k| (k % 4, k / 4)) {
            let (x, y) = ((2 * i + 1) * SIZE / 8, (2 * j + 1) * SIZE / 8);
            let x_shown = if side == "front" { x } else { SIZE - 1 - x };
            let scale = 64.0 / SIZE as f64;
            let at = |v: usize| ((v as f64 + 0.5) * scale) as u32;
            let pixel = picture.get_pixel(at(x_shown), at(y)).0;
            assert_eq!(pixel[3] > 128, covered(x, y), "{side} ({x}, {y}): {pixel:?}");
            if pixel[3] > 128 {
                assert!(pixel[colour] > 100 && pixel[2 - colour] < 100, "{side}: {pixel:?}");
            }
        }
    }
}
