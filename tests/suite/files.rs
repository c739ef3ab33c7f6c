//! The files of a leaf, read back by other programs' libraries or by eyes of their own.

mod blender;
mod card;
mod gltf;
mod pictures;
mod profiles;
mod three;
mod usda;
mod vectors;
mod write;

use std::collections::HashSet;

use glam::DVec2;
use sha2::{Digest, Sha256};
use venation::io::manifest::Manifest;
use venation::io::write::{Overwrite, write_files};
use venation::io::{self, FormatKind, LeafFiles, MapKind, encode_leaf, file_names, file_stem};
use venation::margin::Margin;
use venation::raster::Grid;
use venation::seed::Seed;
use venation::spec::Output;
use venation::texture::{SideMaps, TextureSet};
use venation::units::TextureFrame;
use venation::veins::{VeinGraph, Venation};

const SIZE: usize = 48;

/// A small leaf with one branch of each order, a join, a slit and a petiole.
struct SmallLeaf {
    name: String,
    output: Output,
    margin: Margin,
    venation: Venation,
    textures: TextureSet,
}

impl SmallLeaf {
    fn new(name: &str) -> Self {
        let margin = margin();
        let textures = textures(&margin);
        let output = everything();
        Self { name: name.into(), output, margin, venation: venation(), textures }
    }

    fn files(&self) -> LeafFiles<'_> {
        LeafFiles {
            name: &self.name,
            title: "A leaf for tests <& small>",
            seed: Seed(7),
            margin: &self.margin,
            venation: &self.venation,
            textures: &self.textures,
            spec_toml: "seed = 7\nname = \"prüf\"\n",
            specularity: 0.3,
            roughness: 0.35,
            output: &self.output,
        }
    }

    fn encoded(&self) -> Vec<(String, Vec<u8>)> {
        encode_leaf(&self.files())
    }
}

/// Every map and every format.
fn everything() -> Output {
    Output { maps: MapKind::ALL.to_vec(), formats: FormatKind::ALL.to_vec(), ..Output::standard() }
}

fn margin() -> Margin {
    let right = [(8.0, 2.0), (15.0, 12.0), (17.0, 25.0), (11.0, 42.0)].map(DVec2::from);
    let left = right.map(|p| DVec2::new(-p.x, p.y));
    let mut outline = vec![DVec2::ZERO];
    outline.extend(right);
    outline.push(DVec2::new(0.0, 55.0));
    outline.extend(left.iter().rev());
    let slit = vec![DVec2::new(6.0, 20.0), DVec2::new(9.0, 22.0)];
    Margin::new(outline, 5, vec![slit], "").unwrap()
}

fn venation() -> Venation {
    let mut graph = VeinGraph::new();
    let mut radii = Vec::new();
    let mut orders = Vec::new();
    let mut midrib = vec![graph.add_root(DVec2::ZERO)];
    for i in 1..=20 {
        let parent = *midrib.last().unwrap();
        midrib.push(graph.sprout(parent, DVec2::new(0.0, 2.5 * f64::from(i))));
    }
    for i in 0..=20 {
        radii.push(0.8 - 0.03 * f64::from(i));
        orders.push(1);
    }
    let mut ends = Vec::new();
    for side in [-1.0, 1.0] {
        let mut parent = midrib[4];
        for i in 1..=4 {
            let out = 2.0 * f64::from(i);
            parent = graph.sprout(parent, DVec2::new(side * out, 10.0 + 0.5 * out));
            radii.push(0.2);
            orders.push(2);
        }
        ends.push(graph.sprout(parent, DVec2::new(side * 9.0, 17.0)));
        radii.push(0.05);
        orders.push(3);
    }
    graph.join(ends[0], ends[1]);
    assert_eq!(graph.check(), None);
    Venation::new(graph, radii, orders)
}

fn textures(margin: &Margin) -> TextureSet {
    let petiole_end = DVec2::new(2.0, -12.0);
    let bounds = margin.bounds();
    let frame = TextureFrame::around(bounds.min.min(petiole_end), bounds.max, 0.04);
    let pixel = |i: usize, salt: usize| (i * 37 + salt * 101 + i * i / 5) as u8;
    let side = |salt: usize| SideMaps {
        base_colour: Grid::from_values(
            SIZE,
            SIZE,
            (0..SIZE * SIZE)
                .map(|i| {
                    // Colour under alpha 0 differs from place to place: it has to stay.
                    let alpha = [0, 255, 128][i / SIZE % 3];
                    [pixel(i, salt), pixel(i, salt + 1), pixel(i, salt + 2), alpha]
                })
                .collect(),
        ),
        height: grid(|i| (i * 29 + salt * 1000) as u16),
        normal: grid(|i| [pixel(i, salt), 128, 255]),
        roughness: grid(|i| pixel(i, salt + 6)),
        occlusion: grid(|i| pixel(i, salt + 7)),
        transmission: grid(|i| pixel(i, salt + 8)),
        translucency: grid(|i| [pixel(i, salt + 9), pixel(i, salt), 7]),
        thickness: grid(|i| (i * 31 + salt * 900) as u16),
        vein_mask: grid(|i| pixel(i, salt + 10)),
        vein_order: grid(|i| (i % 6) as u8),
        bump: grid(|i| pixel(i, salt + 5)),
        preview: grid(|i| [pixel(i, salt), 9, 9]),
        enhancement: grid(|i| [9, pixel(i, salt), 9]),
        deep: None,
    };
    let (front, back) = (side(1), side(2));
    TextureSet {
        frame,
        front,
        back,
        height_range_mm: 0.75,
        thickness_range_mm: 1.5,
        petiole_end,
        petiole: Vec::new(),
        albedo: venation::texture::pigment::Albedo::Total,
        rings: Vec::new(),
    }
}

fn grid<T>(value: impl FnMut(usize) -> T) -> Grid<T> {
    Grid::from_values(SIZE, SIZE, (0..SIZE * SIZE).map(value).collect())
}

fn bytes_of<'a>(files: &'a [(String, Vec<u8>)], name: &str) -> &'a [u8] {
    let found = files.iter().find(|(path, _)| path == name);
    &found.unwrap_or_else(|| panic!("no {name}")).1
}

fn text_of<'a>(files: &'a [(String, Vec<u8>)], name: &str) -> &'a str {
    std::str::from_utf8(bytes_of(files, name)).unwrap()
}

#[test]
fn files_are_those_announced_and_the_same_on_any_number_of_threads() {
    let leaf = SmallLeaf::new("oak");
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| leaf.encoded())
    };
    let files = on(1);
    assert!(files == on(7));
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, file_names("oak", SIZE, &everything()));
    assert_eq!(names.last(), Some(&"manifest.json"));
    let all: HashSet<&&str> = names.iter().collect();
    assert_eq!(all.len(), names.len());
    let maps = vec![MapKind::Height, MapKind::Normal, MapKind::AmbientOcclusion];
    let some = Output { maps, ..Output::standard() };
    assert_eq!(
        file_names("oak", SIZE, &some),
        [
            "leaf.toml",
            "oak_Normal.png",
            "oak_Height.png",
            "oak_AmbientOcclusion.png",
            "back/oak_Normal.png",
            "back/oak_Height.png",
            "back/oak_AmbientOcclusion.png",
            "oak.obj",
            "oak.mtl",
            "manifest.json"
        ]
    );
    let maps = vec![MapKind::Height, MapKind::Height];
    let twice = Output { maps, formats: Vec::new(), ..Output::standard() };
    assert_eq!(file_names("oak", SIZE, &twice).len(), 4);
}

#[test]
fn names_become_names_of_files() {
    for (name, stem) in [
        ("oak", "oak"),
        ("Große Eiche 2", "Große_Eiche_2"),
        ("../../etc/passwd", "_.._.._etc_passwd"),
        ("a\\b:c*d\"e\nf\0", "a_b_c_d_e_f_"),
        ("", "leaf"),
        ("  ", "leaf"),
        ("-rf", "_-rf"),
        ("楡", "楡"),
    ] {
        assert_eq!(file_stem(name), stem);
    }
    assert!(file_stem(&"楡".repeat(500)).len() < 200);
}

#[test]
fn the_card_shows_both_sides() {
    let leaf = SmallLeaf::new("Große Eiche");
    let files = leaf.encoded();
    let folder = tempfile::tempdir().unwrap();
    write_files(folder.path(), &files, Overwrite::Refuse).unwrap();
    let path = folder.path().join("Große_Eiche.obj");
    let options = tobj::LoadOptions { triangulate: true, single_index: true, ..Default::default() };
    let (models, materials) = tobj::load_obj(&path, &options).unwrap();
    let materials = materials.unwrap();

    assert_eq!(models.len(), 2);
    let frame = &leaf.textures.frame;
    for (model, back) in models.iter().zip([false, true]) {
        let mesh = &model.mesh;
        assert_eq!(mesh.indices.len(), 6);
        let material = &materials[mesh.material_id.unwrap()];
        assert_eq!(material.name, if back { "Große_Eiche_back" } else { "Große_Eiche_front" });
        let position =
            |i: u32| DVec2::new(at(&mesh.positions, 3, i, 0), at(&mesh.positions, 3, i, 1));
        let direction = if back { -1.0 } else { 1.0 };
        for triangle in mesh.indices.chunks(3) {
            let [a, b, c] = [0, 1, 2].map(|k| position(triangle[k]));
            assert!((b - a).perp_dot(c - a) * direction > 0.0, "wound the right way");
        }
        for &i in &mesh.indices {
            let normal: Vec<f64> = (0..3).map(|k| at(&mesh.normals, 3, i, k)).collect();
            assert_eq!(normal, [0.0, 0.0, direction]);
            let z = at(&mesh.positions, 3, i, 2);
            assert!(if back { (-1e-3..-1e-5).contains(&z) } else { z == 0.0 });
            // The picture of the back is mirrored, so that both lie on the same leaf.
            let mut uv = frame.uv_from_leaf(position(i) * 1e3);
            if back {
                uv.x = 1.0 - uv.x;
            }
            let texcoord = DVec2::new(at(&mesh.texcoords, 2, i, 0), at(&mesh.texcoords, 2, i, 1));
            assert!((0.0..=1.0).contains(&texcoord.x) && (0.0..=1.0).contains(&texcoord.y));
            assert!(uv.distance(texcoord) < 1e-4, "{uv} {texcoord}");
        }
    }

    for material in &materials {
        assert_eq!(material.illumination_model, Some(2));
        let roughness: f32 = material.unknown_param["Pr"].parse().unwrap();
        let exponent = material.shininess.unwrap();
        assert!((1.0 - (exponent / 1000.0).sqrt() - roughness).abs() < 1e-4, "Ns agrees with Pr");
        assert!((0.6..=0.85).contains(&roughness));
    }
    let [front, back] = [0, 1].map(|i| materials[i].specular.unwrap()[0]);
    assert!((front - 0.3).abs() < 1e-6 && (back - 0.1).abs() < 1e-6);
}

fn at(values: &[f32], stride: usize, i: u32, k: usize) -> f64 {
    f64::from(values[i as usize * stride + k])
}

#[test]
fn materials_name_written_files_and_nothing_that_makes_glass() {
    let leaf = SmallLeaf::new("my oak");
    for maps in [MapKind::ALL, MapKind::DEFAULT, &[MapKind::Height], &[MapKind::BaseColour]] {
        let output = Output { maps: maps.to_vec(), ..everything() };
        let files = encode_leaf(&LeafFiles { output: &output, ..leaf.files() });
        let mut pictures = Vec::new();
        for line in text_of(&files, "my_oak.mtl").lines() {
            let words: Vec<&str> = line.split(' ').collect();
            assert!(!["Tf", "map_Bump", "map_bump", "bump"].contains(&words[0]), "{line}");
            if words[0].starts_with("map_") || words[0] == "norm" {
                assert_eq!(words.len(), 2, "no space in {line}");
                assert!(!bytes_of(&files, words[1]).is_empty());
                assert!(words[0] != "map_d" || words[1].ends_with("_Opacity.png"));
                pictures.push(words[1]);
            }
        }
        let named = [MapKind::BaseColour, MapKind::Opacity, MapKind::Normal];
        let expected = maps.iter().filter(|map| named.contains(map)).count();
        assert_eq!(pictures.len(), 2 * expected);
    }
}

#[test]
fn the_vein_graph_reads_back() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    let json: serde_json::Value = serde_json::from_str(text_of(&files, "oak_veins.json")).unwrap();
    assert_eq!((&json["version"], &json["unit"]), (&1.into(), &"mm".into()));
    let keys = ["version", "unit", "margin", "nodes", "joins"];
    assert!(json.as_object().unwrap().keys().all(|key| keys.contains(&key.as_str())));
    assert_eq!(json["margin"].as_array().unwrap().len(), leaf.margin.outline().len());
    assert_eq!(json["margin"][0], serde_json::json!([0.0, 0.0]));

    let graph = leaf.venation.graph();
    let nodes = json["nodes"].as_array().unwrap();
    assert_eq!(nodes.len(), graph.len());
    for (i, node) in nodes.iter().enumerate() {
        assert_eq!(node["id"], i);
        let p = graph.positions()[i];
        let close = |key: &str, value: f64| (node[key].as_f64().unwrap() - value).abs() < 1e-6;
        assert!(close("x", p.x) && close("y", p.y) && close("radius", leaf.venation.radii()[i]));
        assert_eq!(node["parent"].as_u64().map(|p| p as u32), graph.parent(i as u32));
        assert_eq!(node["order"], leaf.venation.orders()[i]);
        assert_eq!(node["kind"], leaf.venation.kind(i as u32).word());
    }
    assert!(nodes[0]["parent"].is_null());
    assert_eq!(json["joins"], serde_json::json!([[25, 30]]));

    let document: io::graph::VeinDocument = serde_json::from_value(json).unwrap();
    assert_eq!(document, io::graph::VeinDocument::new(&leaf.margin, &leaf.venation));
    assert_eq!(document.to_json(), text_of(&files, "oak_veins.json"));
}

#[test]
fn a_leaf_without_veins_has_files_too() {
    let mut leaf = SmallLeaf::new("bare");
    leaf.venation = Venation::new(VeinGraph::new(), Vec::new(), Vec::new());
    let files = leaf.encoded();
    let json: serde_json::Value = serde_json::from_str(text_of(&files, "bare_veins.json")).unwrap();
    assert_eq!(json["nodes"], serde_json::json!([]));
    usvg::Tree::from_str(text_of(&files, "bare.svg"), &usvg::Options::default()).unwrap();
}

#[test]
fn the_drawing_has_true_size_and_a_layer_for_every_order() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    let svg = text_of(&files, "oak.svg");
    let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
    // usvg measures in pixels of 1/96 inch.
    let side = leaf.textures.frame.side_mm;
    assert!((f64::from(tree.size().width()) * 25.4 / 96.0 - side).abs() < 1e-3);
    assert!(svg.contains("<title>A leaf for tests &lt;&amp; small&gt;</title>"));

    let labels: Vec<&str> = svg
        .split("inkscape:label=\"")
        .skip(1)
        .map(|rest| rest.split('"').next().unwrap())
        .collect();
    assert_eq!(labels, ["1 outline", "2 primary", "3 secondary", "4 tertiary"]);

    // The apex, 55 mm up, lies where the textures have it.
    let outline = svg.lines().find(|line| line.starts_with("<path")).unwrap();
    assert!(outline.contains(" Z\"/>"), "{outline}");
    let apex = leaf.textures.frame.pixel_from_leaf(DVec2::new(0.0, 55.0), 1) * side;
    let drawn = outline.split(' ').filter_map(|point| {
        let (x, y) = point.split_once(',')?;
        Some(DVec2::new(x.parse().ok()?, y.parse().ok()?))
    });
    assert_eq!(drawn.filter(|p| p.distance(apex) < 1e-3).count(), 1, "{outline}");
}

#[test]
fn the_drawing_has_every_vein_once() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    let svg = text_of(&files, "oak.svg");
    let mut segments = HashSet::new();
    let mut widths = HashSet::new();
    for line in svg.lines().filter(|line| line.starts_with("<polyline")) {
        let quoted: Vec<&str> = line.split('"').collect();
        assert!(quoted[1].parse::<f64>().unwrap() > 0.0);
        widths.insert(quoted[1]);
        let points: Vec<&str> = quoted[3].split(' ').collect();
        for pair in points.windows(2) {
            let (a, b) = (pair[0].min(pair[1]), pair[0].max(pair[1]));
            assert!(segments.insert((a, b)), "{a} – {b} twice");
        }
    }
    let graph = leaf.venation.graph();
    assert_eq!(segments.len(), graph.edges().count() + graph.joins().len());
    assert!(widths.len() > 5, "the midrib tapers");
}

#[test]
fn the_manifest_tells_the_truth() {
    let leaf = SmallLeaf::new("oak");
    let files = leaf.encoded();
    let text = text_of(&files, "manifest.json");
    let manifest: Manifest = serde_json::from_str(text).unwrap();
    assert_eq!(manifest.files.len(), files.len() - 1);
    for (record, (name, bytes)) in manifest.files.iter().zip(&files) {
        assert_eq!(record.path, *name);
        assert_eq!(record.bytes, bytes.len());
        let hash: String = Sha256::digest(bytes).iter().map(|b| format!("{b:02x}")).collect();
        assert_eq!(record.sha256, hash);
        assert!(!record.meaning.is_empty());
        if name.ends_with(".png") {
            let colour = ["BaseColor.png", "Translucency.png", "Preview.png", "Enhancement.png"]
                .iter()
                .any(|end| name.ends_with(end));
            assert_eq!(
                record.colour_space.as_deref(),
                Some(if colour { "sRGB" } else { "linear" })
            );
            assert_eq!((record.width, record.height), (Some(SIZE), Some(SIZE)));
            let back = name.starts_with("back/");
            assert_eq!(record.side.as_deref(), Some(if back { "back" } else { "front" }));
            assert!(record.map.is_some() && record.bits.is_some() && record.channels.is_some());
        } else {
            assert_eq!((&record.map, record.width), (&None, None));
        }
    }
    assert_eq!((manifest.seed, manifest.size_px, manifest.nodes), (7, SIZE, 31));
    assert_eq!((manifest.length_mm, manifest.height_range_mm), (55.0, 0.75));
    assert_eq!((manifest.unreached_sources, manifest.name.as_str()), (0, "oak"));
    assert_eq!(manifest.petiole_pivot.mm, [2.0, -12.0]);

    let frame = &leaf.textures.frame;
    let uv = frame.uv_from_leaf(DVec2::new(2.0, -12.0));
    assert!(DVec2::from(manifest.petiole_pivot.uv).distance(uv) < 1e-6);
    assert!(
        DVec2::from(manifest.petiole_pivot.uv_back).distance(DVec2::new(1.0 - uv.x, uv.y)) < 1e-6
    );
    let mapping = manifest.uv_from_mm;
    for p in [DVec2::ZERO, DVec2::new(3.0, 41.0)] {
        let map = |scale: [f64; 2], offset: [f64; 2]| DVec2::from(scale) * p + DVec2::from(offset);
        let uv = frame.uv_from_leaf(p);
        assert!(map(mapping.front.scale, mapping.front.offset).distance(uv) < 1e-9);
        let mirrored = DVec2::new(1.0 - uv.x, uv.y);
        assert!(map(mapping.back.scale, mapping.back.offset).distance(mirrored) < 1e-9);
    }
}
