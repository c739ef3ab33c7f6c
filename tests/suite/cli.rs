//! The command line as a person types it: messages, exit codes, files.

use crate::support::{assert_same, contents, fail, fresh, run, small, succeed};

#[test]
fn a_leaf_comes_with_all_its_files() {
    let folder = fresh();
    let stdout = succeed(folder.path(), &small(&["generate", "beech", "-o", "out"]));
    let names: Vec<String> = contents(&folder.path().join("out"))
        .into_keys()
        .map(|path| path.to_string_lossy().into_owned())
        .collect();
    let n = "fagus-sylvatica";
    let maps = "BaseColor Opacity Normal Height Roughness AmbientOcclusion ORM Translucency Thickness \
                VeinMask VeinOrder";
    let mut expected: Vec<String> = maps
        .split(' ')
        .flat_map(|map| [format!("{n}_{map}.png"), format!("back/{n}_{map}.png")])
        .chain([format!("{n}.obj"), format!("{n}.mtl")])
        .chain(["leaf.toml".into(), "manifest.json".into()])
        .collect();
    expected.sort();
    assert_eq!(names, expected);
    assert_eq!(stdout.lines().count(), expected.len());
    assert!(stdout.contains(&format!("out/{n}_BaseColor.png")), "{stdout}");
}

#[test]
fn the_other_formats_and_maps_come_when_asked_for() {
    let folder = fresh();
    let arguments =
        ["generate", "willow", "-o", "o", "--maps", "bump,height", "--format", "svg,json"];
    succeed(folder.path(), &small(&arguments));
    let files = contents(&folder.path().join("o"));
    let has = |name: &str| files.keys().any(|path| path.to_string_lossy() == name);
    for name in ["salix-alba_Bump.png", "salix-alba_Height.png", "back/salix-alba_Bump.png"] {
        assert!(has(name), "{name}");
    }
    assert!(has("salix-alba.svg") && has("salix-alba_veins.json"));
    assert!(!has("salix-alba_BaseColor.png") && !has("salix-alba.obj"));
}

#[test]
fn an_existing_leaf_is_not_overwritten_unless_forced() {
    let folder = fresh();
    let arguments = small(&["generate", "beech", "-o", "out"]);
    succeed(folder.path(), &arguments);
    let before = contents(&folder.path().join("out"));
    let message = fail(folder.path(), 3, &arguments);
    assert!(message.contains("out") && message.contains("--force"), "{message}");
    assert_eq!(contents(&folder.path().join("out")), before);
    let forced = [&arguments[..], &["--force", "--seed", "2"]].concat();
    succeed(folder.path(), &forced);
    assert_ne!(contents(&folder.path().join("out")), before);
}

#[test]
fn seed_3_alone_equals_seed_3_of_a_batch_on_any_number_of_threads() {
    let folder = fresh();
    succeed(
        folder.path(),
        &small(&["generate", "linden", "--seeds", "1-4", "-o", "batch", "-t", "2"]),
    );
    succeed(folder.path(), &small(&["generate", "linden", "--seed", "3", "-o", "one", "-t", "1"]));
    assert_same(&folder.path().join("batch/tilia-cordata_s0003"), &folder.path().join("one"));
}

#[test]
fn leaf_toml_run_again_gives_the_same_bytes() {
    let folder = fresh();
    succeed(folder.path(), &small(&["generate", "linden", "--seed", "5", "-o", "one"]));
    succeed(folder.path(), &["generate", "one/leaf.toml", "-o", "two", "-t", "1"]);
    assert_same(&folder.path().join("one"), &folder.path().join("two"));
}

#[test]
fn leaf_toml_remembers_what_was_written() {
    let folder = fresh();
    let arguments = ["generate", "willow", "-o", "one", "--maps", "bump", "--format", "svg,csv"];
    succeed(folder.path(), &small(&arguments));
    succeed(folder.path(), &["generate", "one/leaf.toml", "-o", "two"]);
    assert_same(&folder.path().join("one"), &folder.path().join("two"));
    succeed(folder.path(), &["generate", "one/leaf.toml", "-o", "three", "--maps", "none"]);
    assert!(!folder.path().join("three/salix-alba_Bump.png").exists());
}

#[test]
fn an_outline_keeps_no_path_and_its_leaf_toml_gives_the_same_bytes() {
    let folder = fresh();
    let points: String = (0..60)
        .map(|i| {
            let t = f64::from(i) / 60.0 * std::f64::consts::TAU;
            format!("{},{}\n", 100.0 + 40.0 * t.sin(), 200.0 - 100.0 * t.cos())
        })
        .collect();
    std::fs::write(folder.path().join("my-outline.csv"), format!("x,y\n{points}")).unwrap();
    succeed(
        folder.path(),
        &small(&[
            "generate",
            "beech",
            "--outline",
            "my-outline.csv",
            "--root",
            "100,300",
            "--length-mm",
            "50",
            "-o",
            "one",
        ]),
    );
    let toml = std::fs::read_to_string(folder.path().join("one/leaf.toml")).unwrap();
    assert!(!toml.contains("my-outline"), "{toml}");
    assert!(toml.contains("length_mm = 50.0"), "{toml}");
    // The polygon is in millimetres: its apex stands at the length.
    let spec = venation::document::Document::parse(&toml, "leaf.toml")
        .and_then(|document| document.resolve(venation::seed::Seed(1)))
        .unwrap();
    assert!(spec.margin.polygon_mm.contains(&[0.0, 50.0]), "{:?}", spec.margin.polygon_mm);
    std::fs::remove_file(folder.path().join("my-outline.csv")).unwrap();
    succeed(folder.path(), &["generate", "one/leaf.toml", "-o", "two"]);
    assert_same(&folder.path().join("one"), &folder.path().join("two"));
}

#[test]
fn given_sources_are_all_the_sources_there_are() {
    let folder = fresh();
    std::fs::write(folder.path().join("s.csv"), "x,y\n5,40\n-5,40\n0,60\n").unwrap();
    let arguments = small(&[
        "generate",
        "beech",
        "--sources",
        "s.csv",
        "--growth",
        "none",
        "-o",
        "out",
        "--format",
        "json",
        "--set",
        "veins.guides.primary=none",
    ]);
    succeed(folder.path(), &arguments);
    let text =
        std::fs::read_to_string(folder.path().join("out/fagus-sylvatica_veins.json")).unwrap();
    let graph: serde_json::Value = serde_json::from_str(&text).unwrap();
    let nodes = graph["nodes"].as_array().unwrap();
    let parents: Vec<u64> = nodes.iter().filter_map(|n| n["parent"].as_u64()).collect();
    let tips = (0..nodes.len() as u64).filter(|id| !parents.contains(id)).count();
    assert!((1..=3).contains(&tips), "{tips} tips for three sources");
}

#[test]
fn leaves_of_metres_are_told_to_take_long() {
    let folder = fresh();
    let message =
        |length| run(folder.path(), &["generate", "beech", "--length-mm", length, "-n"]).2;
    assert_eq!(message("100"), "");
    let text = message("2000");
    assert!(text.contains("2000 mm") && text.contains("veins.scale"), "{text}");
}

#[test]
fn json_alone_on_stdout() {
    let folder = fresh();
    let stdout = succeed(
        folder.path(),
        &small(&["generate", "aspen", "--seeds", "1-2", "-o", "out", "--json"]),
    );
    let report: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    let leaves = report["leaves"].as_array().unwrap();
    assert_eq!(leaves.len(), 2);
    assert_eq!(leaves[1]["seed"], 2);
    assert_eq!(leaves[0]["status"], "made");
    assert!(leaves[0]["nodes"].as_u64().unwrap() > 10);
}

#[test]
fn part_of_a_batch_may_fail() {
    let folder = fresh();
    // Base angles on both sides of 90 without a basal extension: some seeds contradict themselves.
    let arguments = small(&[
        "generate",
        "beech",
        "--seeds",
        "1-6",
        "-o",
        "out",
        "--set",
        "margin.right.base_angle_deg=80..100",
    ]);
    let message = fail(folder.path(), 4, &arguments);
    assert!(message.contains("margin.right.base_angle_deg"), "{message}");
    assert!(message.contains("of 6 leaves failed"), "{message}");
    assert!(!contents(&folder.path().join("out")).is_empty());
}

#[test]
fn presets_are_listed_and_shown() {
    let folder = fresh();
    let list = succeed(folder.path(), &["presets"]);
    assert!(list.lines().count() >= 6, "{list}");
    assert!(list.contains("fagus-sylvatica") && list.contains("beech"));
    let toml = succeed(folder.path(), &["presets", "show", "beech"]);
    std::fs::write(folder.path().join("my.toml"), toml).unwrap();
    succeed(folder.path(), &small(&["generate", "my.toml", "-o", "a"]));
    succeed(folder.path(), &small(&["generate", "beech", "-o", "b"]));
    assert_same(&folder.path().join("a"), &folder.path().join("b"));
}

#[test]
fn compare_writes_a_sheet_and_a_table() {
    let folder = fresh();
    let arguments = small(&["compare", "beech", "-o", "sheet.png", "--csv", "table.csv"]);
    succeed(folder.path(), &arguments);
    let table = std::fs::read_to_string(folder.path().join("table.csv")).unwrap();
    let growths: Vec<&str> =
        table.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    assert_eq!(growths, ["none", "marginal", "isotropic", "anisotropic", "non-uniform"]);
    let sheet = std::fs::read(folder.path().join("sheet.png")).unwrap();
    assert_eq!(&sheet[1..4], b"PNG");
    fail(folder.path(), 3, &arguments);
}

#[test]
fn compare_reports_measures_alone_on_stdout() {
    let folder = fresh();
    let json = |arguments: &[&str]| -> serde_json::Value {
        let arguments = [&["compare", "beech", "--json"], arguments].concat();
        serde_json::from_str(&succeed(folder.path(), &small(&arguments))).expect("JSON alone")
    };
    let report = json(&["--csv", "table.csv", "--seeds", "1-2"]);
    assert_eq!(report["by"], "growth");
    assert_eq!(report["files"], serde_json::json!(["table.csv"]));
    let table = std::fs::read_to_string(folder.path().join("table.csv")).unwrap();
    let leaves = report["leaves"].as_array().expect("a list");
    assert_eq!(leaves.len(), table.lines().count() - 1);
    for (row, leaf) in table.lines().skip(1).zip(leaves) {
        let nodes = leaf["nodes"].to_string();
        assert!(row.starts_with(&format!(
            "{},{},{nodes},",
            leaf["case"].as_str().unwrap(),
            leaf["seed"]
        )));
    }
    let year = json(&["--by", "season"]);
    assert_eq!(year["leaves"][0]["state"], "spring");
    assert_eq!(year["files"], serde_json::json!([]));
    let film = ["compare", "beech", "--by", "season", "--frames", "2", "--json", "-o", "f.png"];
    assert!(fail(folder.path(), 2, &small(&film)).contains("--json"));
}

#[test]
fn compare_shows_scatter_patterns_by_spacing_and_algorithms() {
    let folder = fresh();
    let by = |word| ["compare", "lilac", "--by", word, "--csv", "t.csv", "-o", "s.png", "--force"];
    succeed(folder.path(), &small(&by("scatter")));
    let table = std::fs::read_to_string(folder.path().join("t.csv")).unwrap();
    assert!(table.starts_with("scatter,seed,nodes,"), "{table}");
    let row = |i: usize| table.lines().nth(i).unwrap_or_default();
    assert!(row(1).starts_with("square 3 px,") && row(16).starts_with("random 10 px,"), "{table}");
    assert_eq!(row(16).split(',').nth(3), Some("125"));
    succeed(folder.path(), &small(&by("algorithm")));
    let table = std::fs::read_to_string(folder.path().join("t.csv")).unwrap();
    assert!(table.contains("\nauxin-open,") && table.contains("\nparticles,"), "{table}");
}

#[test]
fn bench_prints_a_table_and_the_exponent() {
    let folder = fresh();
    let out = succeed(
        folder.path(),
        &["bench", "--auxins", "200,400,800", "--csv", "b.csv", "--runs", "1"],
    );
    assert!(out.contains("exponent"), "{out}");
    let table = std::fs::read_to_string(folder.path().join("b.csv")).unwrap();
    assert_eq!(table.lines().count(), 4, "{table}");
}

#[test]
fn a_leaf_that_grows_no_vein_is_a_leaf_all_the_same() {
    let folder = fresh();
    let bare = ["generate", "beech", "--set", "veins.guides.primary=none", "--maps", "basecolor"];
    std::fs::write(folder.path().join("far.csv"), "500,30\n").unwrap();
    for (out, cause) in [
        ("dartless", ["--set", "veins.spawn_rate=0"]),
        ("unreachable", ["--set", "veins.attraction_distance_mm=0.01"]),
        ("outside", ["--sources", "far.csv"]),
    ] {
        let arguments = small(&[&bare[..], &cause, &["-o", out, "--format", "json,svg"]].concat());
        let (code, _, message) = run(folder.path(), &arguments);
        assert_eq!(code, 0, "{out}: {message}");
        let is_told = message.contains("no vein reached ");
        assert_eq!(is_told, out != "dartless", "{out}: {message}");
    }
}

#[test]
fn sources_that_play_no_part_are_told_of() {
    let folder = fresh();
    std::fs::write(folder.path().join("one.csv"), "5,30\n").unwrap();
    let leaf = ["generate", "oak", "--sources", "one.csv", "--maps", "none", "-o"];
    let trails = ["--set", "veins.algorithm=particles", "--set", "veins.particles.spacing_mm=9"];
    let (code, _, message) = run(folder.path(), &small(&[&leaf[..], &["o"], &trails].concat()));
    assert_eq!(code, 0, "{message}");
    assert!(message.contains("veins.sources_mm") && message.contains("pattern"), "{message}");
    let (_, _, message) = run(folder.path(), &small(&[&leaf[..], &["p"]].concat()));
    assert!(!message.contains("no part"), "{message}");
}
