//! `venation inspect` and the graphs other programs read.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::support::{fail, fresh, run, succeed};

fn small_leaf(folder: &Path) {
    let arguments = [
        "generate",
        "beech",
        "--size",
        "16",
        "--set",
        "margin.length_mm=20",
        "--maps",
        "none",
        "--format",
        "json,graphml,csv",
        "-o",
        "leaf",
    ];
    succeed(folder, &arguments);
}

fn only(folder: &Path, ending: &str) -> std::path::PathBuf {
    let entries = std::fs::read_dir(folder).expect("a folder");
    let mut paths = entries.map(|entry| entry.expect("an entry").path());
    paths.find(|path| path.to_string_lossy().ends_with(ending)).expect(ending)
}

#[test]
fn a_made_leaf_is_measured_from_its_folder_and_from_its_graph() {
    let folder = fresh();
    small_leaf(folder.path());
    let table = succeed(folder.path(), &["inspect", "leaf"]);
    assert!(table.contains("of 20 rows inside"), "{table}");
    assert!(table.contains("order  segments"), "{table}");
    let graph = only(&folder.path().join("leaf"), "_veins.json");
    let graph = graph.to_string_lossy();
    assert_eq!(
        table,
        succeed(folder.path(), &["inspect", &graph]).replace(
            &*graph,
            &Path::new("leaf").join(Path::new(&*graph).file_name().unwrap()).to_string_lossy(),
        )
    );
    let json: Value =
        serde_json::from_str(&succeed(folder.path(), &["inspect", "leaf", "--json"])).unwrap();
    let rows = json["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 20);
    assert_eq!(rows[0]["measures"][0]["key"], "loop_index");
    assert_eq!(json["unit"], "mm");
    let csv = succeed(folder.path(), &["inspect", "leaf", "--csv"]);
    assert!(csv.starts_with("row,key,value,low,high,inside\n1,loop_index,"), "{csv}");
    assert!(csv.lines().all(|line| line.matches(',').count() == 5), "{csv}");
    // Vein length per area by order adds up to the whole.
    let orders = json["orders"].as_array().unwrap();
    let sum: f64 = orders.iter().map(|order| order["length"].as_f64().unwrap()).sum();
    let whole = json["length"].as_f64().unwrap();
    assert!((sum - whole).abs() < 1e-6 * whole, "{sum} {whole}");
}

#[test]
fn tables_have_a_line_for_every_node_and_edge() {
    let folder = fresh();
    small_leaf(folder.path());
    let leaf = folder.path().join("leaf");
    let graph: Value =
        serde_json::from_str(&std::fs::read_to_string(only(&leaf, "_veins.json")).unwrap())
            .unwrap();
    let nodes = graph["nodes"].as_array().unwrap();
    let roots = nodes.iter().filter(|node| node["parent"].is_null()).count();
    let joins = graph["joins"].as_array().unwrap().len();
    let table = |ending: &str| std::fs::read_to_string(only(&leaf, ending)).unwrap();
    assert_eq!(table("_nodes.csv").lines().count(), nodes.len() + 1);
    assert_eq!(table("_edges.csv").lines().count(), nodes.len() - roots + joins + 1);
    assert!(table("_areoles.csv").starts_with("area_mm2,perimeter_mm,"));
}

/// networkx, where Python has it, reads the same graph.
#[test]
fn networkx_reads_the_graph() {
    let has = Command::new("python3").args(["-c", "import networkx"]).output();
    if !has.is_ok_and(|output| output.status.success()) {
        eprintln!("skipped: python3 with networkx is not here (pip install networkx)");
        return;
    }
    let folder = fresh();
    small_leaf(folder.path());
    let leaf = folder.path().join("leaf");
    let script = "
import json, math, sys, networkx
g = networkx.read_graphml(sys.argv[1])
d = json.load(open(sys.argv[2]))
roots = sum(n['parent'] is None for n in d['nodes'])
assert g.number_of_nodes() == len(d['nodes'])
assert g.number_of_edges() == len(d['nodes']) - roots + len(d['joins'])
assert networkx.number_connected_components(g) <= roots
for n in d['nodes']:
    a = g.nodes[str(n['id'])]
    assert (a['x'], a['y'], a['radius'], a['order'], a['kind']) == tuple(
        n[k] for k in ('x', 'y', 'radius', 'order', 'kind'))
for u, v, a in g.edges(data=True):
    p, q = g.nodes[u], g.nodes[v]
    assert abs(math.hypot(p['x'] - q['x'], p['y'] - q['y']) - a['length']) < 1e-5
    assert isinstance(a['is_join'], bool) and isinstance(a['order'], int)
";
    let output = Command::new("python3")
        .args(["-c", script])
        .args([only(&leaf, ".graphml"), only(&leaf, "_veins.json")])
        .output()
        .expect("python3 starts");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

const NODE: &str = r#"{"id":0,"x":0,"y":0,"parent":null,"radius":1,"order":1,"kind":"primary"}"#;

fn graph(nodes: &str, joins: &str) -> String {
    format!(r#"{{"version":1,"unit":"mm","margin":[],"nodes":[{nodes}],"joins":[{joins}]}}"#)
}

#[test]
fn bad_graphs_are_refused_with_the_file_and_the_reason() {
    let folder = fresh();
    let second = |parent: &str| {
        let node = NODE.replace("\"id\":0", "\"id\":1").replace("\"x\":0", "\"x\":1");
        format!("{NODE},{}", node.replace("null", parent))
    };
    let cases = [
        (String::new(), "is empty"),
        ("[".repeat(100_000), "is not a vein graph"),
        ("{}".into(), "missing field"),
        (graph("", ""), "has no veins"),
        (graph(NODE, ""), "has no veins"),
        (graph(&second("7"), ""), "node 1 has the parent 7"),
        (graph(&second("1"), ""), "node 1 has the parent 1"),
        (graph(&second("-1"), ""), "is not a vein graph"),
        (graph(&second("0"), "[0,9]"), "join 0"),
        (graph(&second("0"), "[0,1]"), "repeats the edge"),
        (graph(&NODE.replace("\"radius\":1", "\"radius\":-1"), ""), "radius -1"),
        (graph(&NODE.replace("\"x\":0", "\"x\":1e300"), ""), "beyond"),
        (graph(&NODE.replace("\"x\":0", "\"x\":1e999"), ""), "is not a vein graph"),
        (graph(&second("0"), "").replace("\"version\":1", "\"version\":2"), "version 2"),
        (graph(&second("0"), "").replace("[]", "[[0,0],[1,1],[2,2]]"), "margin"),
    ];
    for (i, (text, reason)) in cases.iter().enumerate() {
        let name = format!("case{i}.json");
        std::fs::write(folder.path().join(&name), text).unwrap();
        let message = fail(folder.path(), 2, &["inspect", &name]);
        assert!(message.contains(&name) && message.contains(reason), "{i}: {message}");
    }
    for name in ["nowhere.json", "."] {
        let message = fail(folder.path(), 2, &["inspect", name]);
        assert!(message.contains(name), "{message}");
    }
}

#[test]
fn odd_but_sound_graphs_are_measured() {
    let folder = fresh();
    // All nodes in one place, and a graph along one line: no areas, no directions.
    let node = |i: u32, x: f64| {
        let parent = if i == 0 { "null".into() } else { (i - 1).to_string() };
        NODE.replace("\"id\":0", &format!("\"id\":{i}"))
            .replace("\"x\":0", &format!("\"x\":{x}"))
            .replace("null", &parent)
    };
    let list = |x: fn(u32) -> f64| (0..4).map(|i| node(i, x(i))).collect::<Vec<_>>().join(",");
    for (name, x) in [("point.json", (|_| 0.0) as fn(u32) -> f64), ("line.json", f64::from)] {
        std::fs::write(folder.path().join(name), graph(&list(x), "[0,3]")).unwrap();
        let (code, _, stderr) = run(folder.path(), &["inspect", name]);
        assert_eq!(code, 0, "{name}: {stderr}");
    }
}

#[test]
fn bad_pictures_are_refused() {
    let folder = fresh();
    let mut whole = Vec::new();
    let mut encoder = png::Encoder::new(&mut whole, 40, 40);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&[0; 1600]).unwrap();
    writer.finish().unwrap();
    let mut huge = whole.clone();
    huge[16..20].copy_from_slice(&60_000u32.to_be_bytes());
    let mut jpeg = Vec::new();
    let noise: Vec<u8> =
        (0..40_000u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let mut encoder = image::codecs::jpeg::JpegEncoder::new(&mut jpeg);
    encoder.encode(&noise, 200, 200, image::ExtendedColorType::L8).unwrap();
    std::fs::write(folder.path().join("whole.jpg"), &jpeg).unwrap();
    succeed(folder.path(), &["inspect", "whole.jpg"]);
    let cases: [(&str, &[u8]); 6] = [
        ("black.png", &whole),
        ("truncated.png", &whole[..whole.len() - 30]),
        ("signature.png", &whole[..8]),
        ("huge.png", &huge),
        ("short.jpg", &[0xff, 0xd8, 0xff, 0xe0]),
        ("truncated.jpg", &jpeg[..jpeg.len() / 2]),
    ];
    for (name, bytes) in cases {
        std::fs::write(folder.path().join(name), bytes).unwrap();
        let message = fail(folder.path(), 2, &["inspect", name]);
        assert!(message.contains(name), "{message}");
    }
    for (name, text, problem) in
        [("empty.png", "", "is empty"), ("text.png", "veins", "is not a PNG or JPEG picture")]
    {
        std::fs::write(folder.path().join(name), text).unwrap();
        let message = fail(folder.path(), 2, &["inspect", name]);
        assert!(message.contains(name) && message.contains(problem), "{message}");
    }
    let arguments = ["generate", "beech", "--outline", "truncated.jpg"];
    let message = fail(folder.path(), 2, &arguments);
    assert!(message.contains("truncated.jpg") && message.contains("cut short"), "{message}");
    let message = fail(folder.path(), 2, &["inspect", "black.png", "--px-per-mm", "0"]);
    assert!(message.contains("--px-per-mm"), "{message}");
}

/// The real networks lie where `VENATION_LEAVES` says, in a folder `veins`; without it they are
/// skipped. Bands: what every one of them was found to be, a twentieth wider.
#[test]
fn real_networks_lie_where_they_were_found() {
    let Some(leaves) = std::env::var_os("VENATION_LEAVES") else {
        eprintln!("skipped: VENATION_LEAVES does not name a folder of real leaves");
        return;
    };
    let folder = fresh();
    for (name, least) in
        [("net_leaf1", 17), ("net_leaf2", 17), ("net_leaf4", 13), ("zelkova_vein_mask", 13)]
    {
        let path = Path::new(&leaves).join("veins").join(format!("{name}.png"));
        let text = succeed(folder.path(), &["inspect", &path.to_string_lossy(), "--json"]);
        let json: Value = serde_json::from_str(&text).unwrap();
        let value = |key: &str| {
            let rows = json["rows"].as_array().unwrap().iter();
            let mut all = rows.flat_map(|row| row["measures"].as_array().unwrap());
            all.find(|m| m["key"] == key).unwrap()["value"].as_f64().unwrap()
        };
        for (key, low, high) in [
            ("loop_index", 0.16, 0.22),
            ("mst_ratio", 0.51, 0.66),
            ("edges_per_node", 1.22, 1.42),
            ("areole_elongation_median", 1.40, 1.60),
            ("vla_x_distance_mean", 0.30, 0.34),
            ("balanced_exponent", 0.70, 1.25),
        ] {
            assert!((low..=high).contains(&value(key)), "{name} {key} {}", value(key));
        }
        let inside = json["rows_inside"].as_u64().unwrap();
        assert!(inside >= least, "{name}: {inside} of 20 rows inside");
    }
}
