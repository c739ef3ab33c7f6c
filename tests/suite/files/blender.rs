//! The card in Blender, where Blender's Python module `bpy` is installed:
//! `VENATION_BPY=/path/to/python cargo test --test suite -- --ignored blender`.

use std::process::Command;

use venation::io::write::{Overwrite, write_files};
use venation::io::{LeafFiles, encode_leaf};
use venation::raster::Grid;
use venation::spec::Output;

use super::{SIZE, SmallLeaf};

/// Imports the card, reports its materials, and takes a picture from either side by even light.
/// It leaves by `_exit`, since the module can crash while Python shuts down.
const SCRIPT: &str = r#"
import bpy, json, os, sys
folder = sys.argv[1]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=folder + "/oak.obj")
report = {"materials": {}, "pictures": {}}
for material in bpy.data.materials:
    shader = next(n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    def source(name):
        links = shader.inputs[name].links
        if not links: return None
        node = links[0].from_node
        return [os.path.basename(node.image.filepath) if node.type == "TEX_IMAGE" else node.type,
                links[0].from_socket.name]
    report["materials"][material.name] = {
        "colour": source("Base Color"), "alpha": source("Alpha"),
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

#[test]
#[ignore = "needs Blender's bpy: set VENATION_BPY to a Python that has it"]
fn blender_shows_both_sides_cut_out() {
    let python = std::env::var("VENATION_BPY").expect("VENATION_BPY names a Python with bpy");
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
    let run = Command::new(python).args(["-c", SCRIPT]).arg(folder.path()).output().unwrap();
    let report = std::fs::read(folder.path().join("report.json"))
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();

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
