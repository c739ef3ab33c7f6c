//! Many leaves: shards and their union, killed runs, atlases, and what a dry run says of them.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use serde_json::Value;

use crate::support::{self, FEW_VEINS, contents, fail, fresh, run, succeed};

/// A command that makes small leaves and few of their maps.
fn small<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [&support::small(arguments)[..], &["--maps", "basecolor,height,orm"]].concat()
}

/// The files below a folder without the manifests of shards.
fn without_shards(folder: &Path) -> std::collections::BTreeMap<std::path::PathBuf, Vec<u8>> {
    let mut files = contents(folder);
    files.retain(|path, _| !path.to_string_lossy().contains("-of-"));
    files
}

#[test]
fn the_union_of_shards_is_the_unsharded_run() {
    let folder = fresh();
    let batch = ["generate", "beech", "--seeds", "1-5,9"];
    succeed(folder.path(), &small(&[&batch[..], &["-o", "whole"]].concat()));
    // Shards counted from 0 in one folder, from 1 in the other, a thread here and two there.
    for (out, shards) in [("zero", ["0/3", "1/3", "2/3"]), ("one", ["1/3", "2/3", "3/3"])] {
        for (shard, threads) in shards.iter().zip(["1", "2", "1"]) {
            let more = ["-o", out, "--shard", shard, "-t", threads];
            succeed(folder.path(), &small(&[&batch[..], &more].concat()));
        }
        let manifest = succeed(folder.path(), &["merge", out]);
        assert_eq!(manifest.trim(), format!("{out}/manifest.jsonl"));
        // Merging again changes nothing.
        succeed(folder.path(), &["merge", out]);
        let (whole, union) = (folder.path().join("whole"), folder.path().join(out));
        assert!(contents(&whole) == without_shards(&union), "{out}");
        assert_eq!(contents(&union).len(), contents(&whole).len() + 3);
    }
    let lines = std::fs::read_to_string(folder.path().join("whole/manifest.jsonl")).unwrap();
    let seeds: Vec<u64> = lines
        .lines()
        .map(|line| serde_json::from_str::<Value>(line).unwrap()["seed"].as_u64().unwrap())
        .collect();
    assert_eq!(seeds, [1, 2, 3, 4, 5, 9]);
}

#[test]
fn merging_says_what_is_missing_and_refuses_shards_of_other_runs() {
    let folder = fresh();
    let shard = |out: &'static str, shard: &'static str, more: &[&'static str]| {
        let batch = ["generate", "beech", "--seeds", "1-4", "-o", out, "--shard", shard];
        succeed(folder.path(), &small(&[&batch[..], more].concat()));
    };
    shard("out", "0/2", &[]);
    let message = fail(folder.path(), 2, &["merge", "out"]);
    assert!(message.contains("manifest.0001-of-0002.jsonl missing"), "{message}");
    shard("out", "1/2", &[]);
    succeed(folder.path(), &["merge", "out"]);
    // The same seeds with other settings, other seeds, another leaf.
    shard("other", "0/2", &["--set", "texture.gutter=0.1"]);
    let seeds = ["generate", "beech", "--seeds", "1-6", "-o", "more", "--shard", "0/2"];
    let leaf = ["generate", "linden", "--seeds", "1-4", "-o", "linden", "--shard", "0/2"];
    succeed(folder.path(), &small(&seeds));
    succeed(folder.path(), &small(&leaf));
    for first in ["other", "more", "linden"] {
        let first = format!("{first}/manifest.0000-of-0002.jsonl");
        let second = "out/manifest.0001-of-0002.jsonl";
        let message = fail(folder.path(), 2, &["merge", &first, second]);
        assert!(message.contains("shards of different runs"), "{message}");
        assert!(message.contains(&first) && message.contains(second), "{message}");
    }
    // Manifests that are no shards', and do not agree.
    for (out, gutter) in [("a", "0.1"), ("b", "0.2")] {
        let gutter = format!("texture.gutter={gutter}");
        let batch = ["generate", "beech", "--seeds", "1,2", "-o", out, "--set", &gutter];
        succeed(folder.path(), &small(&batch));
    }
    let both = ["merge", "a/manifest.jsonl", "b/manifest.jsonl", "-o", "both.jsonl"];
    let message = fail(folder.path(), 2, &both);
    assert!(message.contains("disagree about fagus-sylvatica_s0001"), "{message}");
    for (wrong, expected) in [("3/2", "i is at most n"), ("1", "not i/n"), ("1/0", "0 shards")] {
        let arguments = ["generate", "beech", "--seeds", "1-4", "--shard", wrong];
        let message = fail(folder.path(), 2, &arguments);
        assert!(message.contains(expected), "{message}");
    }
    let message = fail(folder.path(), 2, &["merge", "nowhere"]);
    assert!(message.contains("nowhere"), "{message}");
}

#[test]
fn a_shard_whose_leaves_all_failed_holds_up_no_other() {
    let folder = fresh();
    let batch = ["generate", "beech", "--seeds", "1,2", "-o", "out"];
    // Veins would step over the sources.
    let wrong = ["--set", "veins.node_step_mm=5", "--set", "veins.kill_distance_mm=1"];
    for shard in ["0/2", "1/2"] {
        let more = ["--shard", shard];
        let (code, listed, message) =
            run(folder.path(), &[&small(&batch)[..], &wrong, &more].concat());
        assert_eq!(code, 2, "{message}");
        assert!(listed.contains("-of-0002.jsonl"), "{listed}");
    }
    let message = fail(folder.path(), 4, &["merge", "out"]);
    assert!(message.contains("2 of 2 leaves failed"), "{message}");
    let merged = std::fs::read_to_string(folder.path().join("out/manifest.jsonl")).unwrap();
    assert_eq!(merged.matches("veins.kill_distance_mm").count(), 2, "{merged}");
}

#[test]
fn a_manifest_that_cannot_be_added_to_is_told_of_before_anything_is_grown() {
    let folder = fresh();
    std::fs::create_dir(folder.path().join("out")).unwrap();
    std::fs::write(folder.path().join("out/manifest.jsonl"), "no line of ours\n").unwrap();
    let batch = ["generate", "beech", "--seeds", "1-2", "-o", "out"];
    for more in [&[][..], &["-n"], &["--force"]] {
        let message = fail(folder.path(), 2, &[&small(&batch)[..], more].concat());
        assert!(message.contains("manifest.jsonl:1: "), "{message}");
    }
    assert_eq!(contents(folder.path()).len(), 1);
}

#[test]
fn a_list_of_one_seed_is_a_list() {
    let folder = fresh();
    for seeds in ["5", "7"] {
        succeed(folder.path(), &small(&["generate", "beech", "--seeds", seeds, "-o", "out"]));
    }
    let manifest = std::fs::read_to_string(folder.path().join("out/manifest.jsonl")).unwrap();
    let folders: Vec<Value> =
        manifest.lines().map(|line| serde_json::from_str::<Value>(line).unwrap()).collect();
    let names: Vec<_> = folders.iter().map(|line| line["folder"].as_str().unwrap()).collect();
    assert_eq!(names, ["fagus-sylvatica_s0005", "fagus-sylvatica_s0007"]);
}

#[test]
fn every_seed_is_read_back_from_the_settings() {
    let folder = fresh();
    let last = u64::MAX.to_string();
    succeed(folder.path(), &small(&["generate", "beech", "--seed", &last, "-o", "a"]));
    succeed(folder.path(), &["generate", "a/leaf.toml", "-o", "b"]);
    support::assert_same(&folder.path().join("a"), &folder.path().join("b"));
}

#[cfg(target_os = "linux")]
#[test]
fn what_a_killed_run_left_half_written_goes_with_the_next_run() {
    let folder = fresh();
    let out = folder.path().join("out");
    succeed(folder.path(), &small(&["generate", "beech", "-o", "out"]));
    // Find out what this machine is called by catching a file in the act.
    let name = || {
        let program = assert_cmd::cargo::cargo_bin("venation");
        let arguments = ["generate", "beech", "--seeds", "1-40", "-o", "caught", "--size", "512"];
        let mut child = Command::new(program)
            .current_dir(folder.path())
            .args(arguments)
            .stdout(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let mut caught = None;
        while caught.is_none() && child.try_wait().unwrap().is_none() {
            let batch = folder.path().join("caught");
            for leaf in std::fs::read_dir(batch).into_iter().flatten().flatten() {
                for file in std::fs::read_dir(leaf.path()).into_iter().flatten().flatten() {
                    let name = file.file_name().into_string().unwrap();
                    if name.starts_with(".venation-tmp-") {
                        caught = Some(name);
                    }
                }
            }
        }
        child.kill().unwrap();
        child.wait().unwrap();
        caught
    };
    let name = name().expect("a file in the act");
    // Its process is dead now; a living one's, and another machine's, stay.
    let mut parts: Vec<String> = name.rsplitn(3, '-').map(str::to_owned).collect();
    parts[1] = std::process::id().to_string();
    let living = format!("{}-{}-{}", parts[2], parts[1], parts[0]);
    let foreign = ".venation-tmp-00000000-1-0";
    for file in [&name, &living, &foreign.to_owned()] {
        std::fs::write(out.join(file), "half a pic").unwrap();
    }
    succeed(folder.path(), &small(&["generate", "beech", "-o", "out", "--force"]));
    assert!(!out.join(&name).exists(), "{name} is left");
    assert!(out.join(&living).exists() && out.join(foreign).exists());
}

/// The paths that a command lists.
fn listed(folder: &Path, arguments: &[&str]) -> BTreeSet<String> {
    succeed(folder, arguments).lines().map(str::to_owned).collect()
}

#[test]
fn a_dry_run_lists_what_the_run_then_writes_and_writes_nothing() {
    let commands: &[&[&str]] = &[
        &["generate", "willow", "-o", "out", "--format", "all", "--mips"],
        &["generate", "willow", "--seeds", "1-3", "-o", "out", "--profile", "unreal"],
        &["generate", "willow", "--seeds", "1-5", "-o", "out", "--shard", "1/2"],
        &["atlas", "willow", "--seeds", "1-3", "-o", "out", "--size", "256", "--mips"],
        &["compare", "willow", "--by", "seed", "--seeds", "1-2", "-o", "s.png", "--csv", "s.csv"],
    ];
    for arguments in commands {
        let folder = fresh();
        let small: Vec<&str> = small(&[])
            .chunks(2)
            .filter(|flag| match arguments[0] {
                "compare" => flag[0] != "--maps",
                "atlas" => flag[0] != "--size",
                _ => flag[1] != "basecolor,height,orm" || !arguments.contains(&"--profile"),
            })
            .flatten()
            .copied()
            .collect();
        let arguments = [arguments, &small[..]].concat();
        let planned = listed(folder.path(), &[&arguments[..], &["--dry-run"]].concat());
        assert!(contents(folder.path()).is_empty(), "{arguments:?}");
        let made = listed(folder.path(), &arguments);
        let there: BTreeSet<String> = contents(folder.path())
            .into_keys()
            .map(|path| path.to_string_lossy().into_owned())
            .collect();
        assert_eq!(planned, there, "{arguments:?}");
        assert_eq!(planned, made, "{arguments:?}");
        // A dry run meets what is in the way as the run does.
        fail(folder.path(), 3, &[&arguments[..], &["--dry-run"]].concat());
    }
}

#[test]
fn an_atlas_has_leaves_that_keep_apart_and_ground_that_is_filled() {
    let folder = fresh();
    let flags = ["--seeds", "1-6", "--size", "512", "--padding", "8", "-o", "out"];
    let flags = [&flags[..], &["--maps", "basecolor,height"]].concat();
    let atlas = [&["atlas", "aspen"][..], &flags, FEW_VEINS].concat();
    succeed(folder.path(), &[&atlas[..], &["-t", "1"]].concat());
    let out = folder.path().join("out");
    let json = std::fs::read_to_string(out.join("atlas.json")).unwrap();
    let json: Value = serde_json::from_str(&json).unwrap();
    let size = 512;
    assert_eq!(json["size_px"], size);
    let leaves = json["leaves"].as_array().unwrap();
    assert_eq!(leaves.len(), 6);
    let picture = |name: &str| image::open(out.join(name)).unwrap().into_rgba8();
    let front = picture("populus-tremula_atlas_BaseColor.png");
    let back = picture("back/populus-tremula_atlas_BaseColor.png");
    let number = |value: &Value| value.as_f64().unwrap();
    let rects: Vec<[i64; 4]> = leaves
        .iter()
        .map(|leaf| ["x", "y", "width", "height"].map(|k| leaf["rect"][k].as_i64().unwrap()))
        .collect();

    // Rectangles keep their distance from each other and from the border.
    for (i, &[x, y, w, h]) in rects.iter().enumerate() {
        assert!(x >= 8 && y >= 8 && x + w <= size - 8 && y + h <= size - 8);
        for &[u, v, s, t] in &rects[i + 1..] {
            assert!(x + w + 8 <= u || u + s + 8 <= x || y + h + 8 <= v || v + t + 8 <= y);
        }
        // Each is touched by its leaf on all four sides.
        let covered = |x: i64, y: i64| front.get_pixel(x as u32, y as u32).0[3] > 0;
        assert!((x..x + w).any(|x| covered(x, y)) && (x..x + w).any(|x| covered(x, y + h - 1)));
        assert!((y..y + h).any(|y| covered(x, y)) && (y..y + h).any(|y| covered(x + w - 1, y)));
    }
    // Nothing outside of them; everywhere the colour of the nearest leaf.
    for (x, y, pixel) in front.enumerate_pixels() {
        let inside = rects.iter().any(|&[u, v, w, h]| {
            (u..u + w).contains(&i64::from(x)) && (v..v + h).contains(&i64::from(y))
        });
        assert!(inside || pixel.0[3] == 0, "({x}, {y})");
        assert!(pixel.0[1] > 0, "({x}, {y}) is black");
        // The back is the mirrored sheet.
        assert_eq!(pixel.0[3], back.get_pixel(511 - x, y).0[3]);
    }
    for (leaf, &[x, y, w, h]) in leaves.iter().zip(&rects) {
        // Both origins of v tell of the same rectangle.
        let uv = |origin: &str, end: &str, k: usize| number(&leaf["rect"][origin][end][k]) * 512.0;
        assert!((uv("uv_top_left", "min", 0) - x as f64).abs() < 1e-2);
        assert!((uv("uv_top_left", "max", 1) - (y + h) as f64).abs() < 1e-2);
        assert!((uv("uv_bottom_left", "min", 1) - (512 - y - h) as f64).abs() < 1e-2);
        assert!((uv("uv_bottom_left", "max", 0) - (x + w) as f64).abs() < 1e-2);
        // Base and apex lie on the leaf, as far apart as its length says.
        let at = |key: &str| [0, 1].map(|k| number(&leaf[key]["px"][k]));
        let (base, apex) = (at("base"), at("apex"));
        let length = (base[0] - apex[0]).hypot(base[1] - apex[1]);
        let per_mm = number(&leaf["pixels_per_mm"]);
        assert!((length / per_mm - number(&leaf["length_mm"])).abs() < 1e-3);
        // The outline encloses the leaf's opaque texels, petiole aside: compare areas.
        let ring: Vec<[f64; 2]> = leaf["outline_uv"]
            .as_array()
            .unwrap()
            .iter()
            .map(|p| [number(&p[0]) * 512.0, (1.0 - number(&p[1])) * 512.0])
            .collect();
        let enclosed: f64 = (0..ring.len())
            .map(|i| {
                let ([a, b], [c, d]) = (ring[i], ring[(i + 1) % ring.len()]);
                0.5 * (c * b - a * d)
            })
            .sum();
        let covered: f64 = (x..x + w)
            .flat_map(|x| (y..y + h).map(move |y| (x, y)))
            .map(|(x, y)| f64::from(front.get_pixel(x as u32, y as u32).0[3]) / 255.0)
            .sum();
        assert!(enclosed > 0.85 * covered && enclosed < 1.02 * covered, "{enclosed} {covered}");
        // The settings make the leaf again.
        let settings = leaf["settings"].as_str().unwrap();
        assert!(out.join(settings).is_file());
    }
    // All leaves have the same scale, to a texel of the longest picture.
    let scales: Vec<f64> = leaves.iter().map(|leaf| number(&leaf["pixels_per_mm"])).collect();
    let (least, most) = (scales.iter().copied().fold(f64::MAX, f64::min), scales[0].max(scales[1]));
    assert!(most / least < 1.02, "{scales:?}");
    // The same bytes on two threads.
    let before = contents(&out);
    succeed(folder.path(), &[&atlas[..], &["-t", "2", "--force"]].concat());
    assert!(before == contents(&out));
    let crowd = ["atlas", "aspen", "--seeds", "1-40", "--size", "128", "--padding", "20"];
    let message = fail(folder.path(), 2, &[&crowd[..], &["-o", "no"], FEW_VEINS].concat());
    assert!(message.contains("do not fit on 128 pixels"), "{message}");
    // Of leaves that would fit as mere lines, the outlines tell.
    let crowd =
        ["atlas", "aspen", "--seeds", "1-24", "--size", "128", "--padding", "20", "-o", "no"];
    let told =
        |more: &[&'static str]| fail(folder.path(), 2, &[&crowd[..], FEW_VEINS, more].concat());
    let message = told(&["--dry-run"]);
    assert!(message.contains("24 leaves do not fit on 128 pixels"), "{message}");
    assert_eq!(message, told(&[]));
}

#[test]
fn a_contact_sheet_shows_every_seed() {
    let folder = fresh();
    let sheet = |seeds: &str, out: &str| {
        let arguments = ["compare", "beech", "--by", "seed", "--seeds", seeds, "-o", out];
        succeed(folder.path(), &[&arguments[..], &["--size", "64"], FEW_VEINS].concat());
        let picture = image::open(folder.path().join(out)).unwrap();
        (picture.width(), picture.height())
    };
    let (four, nine) = (sheet("1-4", "four.png"), sheet("1-9", "nine.png"));
    assert!(nine.0 > four.0 && nine.1 > four.1, "{four:?} {nine:?}");
}

/// The first block of the README that starts with this line, without its fence.
fn of_readme(first: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let readme = std::fs::read_to_string(root.join("README.md")).unwrap();
    let start = readme.find(first).unwrap_or_else(|| panic!("no `{first}` in the README"));
    readme[start..].split("```").next().unwrap().to_owned()
}

#[test]
fn the_readmes_job_template_runs() {
    let template = of_readme("specificationVersion: jobtemplate");
    let openjd = std::env::var("VENATION_OPENJD").unwrap_or_else(|_| "openjd".into());
    if Command::new(&openjd).arg("--version").output().is_err() {
        eprintln!("skipped: no `openjd`; pip install openjd-cli, or set VENATION_OPENJD to it");
        return;
    }
    let folder = fresh();
    std::fs::write(folder.path().join("leaves.yaml"), template).unwrap();
    let program = assert_cmd::cargo::cargo_bin("venation");
    let beside = program.parent().unwrap().to_str().unwrap();
    let path = format!("{beside}:{}", std::env::var("PATH").unwrap_or_default());
    let openjd = |arguments: &[&str]| {
        let mut command = Command::new(&openjd);
        command.current_dir(folder.path()).env("PATH", &path).args(arguments);
        let output = command.output().unwrap();
        let said = String::from_utf8_lossy(&output.stdout).into_owned();
        assert!(output.status.success(), "{said}{}", String::from_utf8_lossy(&output.stderr));
        said
    };
    openjd(&["check", "leaves.yaml"]);
    let out = folder.path().join("out");
    let out = format!("Out={}", out.display());
    let parameters = ["-p", "Seeds=1-5", "-p", &out, "-p", "Preset=grass"];
    let run =
        |step: &str| openjd(&[&["run", "leaves.yaml", "--step", step][..], &parameters].concat());
    let said = run("leaves");
    assert!(said.contains("openjd_progress: 100"), "{said}");
    run("merge");
    let lines = std::fs::read_to_string(folder.path().join("out/manifest.jsonl")).unwrap();
    assert_eq!(lines.lines().count(), 5);
    for line in lines.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        let leaf = folder.path().join("out").join(line["folder"].as_str().unwrap());
        for file in line["files"].as_array().unwrap() {
            let path = leaf.join(file["path"].as_str().unwrap());
            assert_eq!(path.metadata().unwrap().len(), file["bytes"].as_u64().unwrap());
        }
    }
}

#[test]
fn a_manifest_that_could_not_be_written_is_not_listed() {
    let folder = fresh();
    std::fs::write(folder.path().join("taken"), "a file").unwrap();
    let batch = ["generate", "beech", "--seeds", "1,2", "-o", "taken"];
    let (code, listed, message) = run(folder.path(), &small(&batch));
    assert_eq!((code, listed.as_str()), (4, ""), "{message}");
    assert!(message.contains("taken"), "{message}");
    let (_, told, _) = run(folder.path(), &small(&[&batch[..], &["--json"]].concat()));
    assert_eq!(serde_json::from_str::<Value>(&told).unwrap()["manifest"], Value::Null);
}
