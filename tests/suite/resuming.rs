//! Runs that go on where an earlier one stopped, and those that may not: `--skip-existing`.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::support::{contents, fail, fresh, run, small, succeed};

#[test]
fn skip_existing_completes_a_killed_batch_and_refuses_strangers() {
    let folder = fresh();
    let arguments = small(&["generate", "beech", "--seeds", "1-3", "-o", "out", "--skip-existing"]);
    succeed(folder.path(), &arguments);
    let out = folder.path().join("out");
    let whole = contents(&out);
    // A run killed in the middle of leaf 2 leaves it without its manifest.
    let leaf = out.join("fagus-sylvatica_s0002");
    std::fs::remove_file(leaf.join("manifest.json")).unwrap();
    std::fs::remove_file(leaf.join("fagus-sylvatica_Normal.png")).unwrap();
    let (code, _, stderr) = run(folder.path(), &arguments);
    assert_eq!(code, 0, "{stderr}");
    assert!(stderr.contains("2 of 3 leaves were there already"), "{stderr}");
    assert_eq!(contents(&out), whole);
    // Another leaf's settings in the same place are not touched.
    let other = [&arguments[..], &["--set", "texture.gutter=0.1"]].concat();
    let message = fail(folder.path(), 3, &other);
    let expected =
        "out/fagus-sylvatica_s0001: holds another leaf: texture.gutter is 0.02 there, 0.1 here;";
    assert!(message.contains(expected), "{message}");
    assert_eq!(contents(&out), whole);
}

#[test]
fn skip_existing_makes_files_that_are_missing_or_newly_asked_for() {
    let folder = fresh();
    let arguments = small(&["generate", "beech", "-o", "out", "--skip-existing"]);
    succeed(folder.path(), &arguments);
    let out = folder.path().join("out");
    let whole = contents(&out);
    std::fs::remove_file(out.join("back/fagus-sylvatica_Height.png")).unwrap();
    succeed(folder.path(), &arguments);
    assert_eq!(contents(&out), whole);
    succeed(folder.path(), &[&arguments[..], &["--format", "obj,svg"]].concat());
    assert!(out.join("fagus-sylvatica.svg").is_file());
}

#[test]
fn a_killed_run_leaves_whole_files_and_goes_on_where_it_stopped() {
    let folder = fresh();
    let arguments = small(&["generate", "beech", "--seeds", "1-12", "-t", "1"]);
    let killed = [&arguments[..], &["-o", "killed", "--skip-existing"]].concat();
    let program = assert_cmd::cargo::cargo_bin("venation");
    let mut child = std::process::Command::new(program)
        .current_dir(folder.path())
        .args(&killed)
        .stdout(std::process::Stdio::null())
        .spawn()
        .unwrap();
    // Wait until some leaf is being written, then pull the plug.
    let out = folder.path().join("killed");
    while child.try_wait().unwrap().is_none() && !out.exists() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    for (name, bytes) in contents(&out) {
        if name.extension().is_some_and(|e| e == "png") {
            assert!(bytes.ends_with(b"IEND\xaeB`\x82"), "{} is cut off", name.display());
        }
    }
    succeed(folder.path(), &killed);
    succeed(folder.path(), &[&arguments[..], &["-o", "whole"]].concat());
    let finished = |name: &str| {
        let mut files = contents(&folder.path().join(name));
        // What the killed run was in the middle of writing keeps its temporary name.
        files.retain(|path, _| !path.to_string_lossy().contains(".venation"));
        files
    };
    assert!(finished("killed") == finished("whole"));
}

/// The paths of files that a folder's manifest tells of, and the manifest.
fn told(folder: &Path) -> Vec<PathBuf> {
    let text = std::fs::read_to_string(folder.join("manifest.json")).unwrap();
    let manifest: serde_json::Value = serde_json::from_str(&text).unwrap();
    let files = manifest["files"].as_array().unwrap().iter();
    let mut files: Vec<PathBuf> = files.map(|file| file["path"].as_str().unwrap().into()).collect();
    files.push("manifest.json".into());
    files.sort();
    files
}

fn paths(files: &BTreeMap<PathBuf, Vec<u8>>) -> Vec<PathBuf> {
    files.keys().cloned().collect()
}

#[test]
fn a_finished_leaf_is_never_overwritten_by_one_of_other_settings() {
    let folder = fresh();
    let batch = ["generate", "beech", "--seeds", "1-2", "-o", "out", "--maps", "basecolor"];
    succeed(folder.path(), &small(&batch));
    let out = folder.path().join("out");
    let before = contents(&out);
    let leaf = "out/fagus-sylvatica_s0001: holds another leaf: ";
    for (flag, value, differs) in [
        ("--bits", "16", "output.bits is 8 there, 16 here"),
        ("--card", "outline", "output.card is \"square\" there, \"outline\" here"),
        ("--profile", "unreal", "output.profile is \"default\" there, \"unreal\" here"),
        ("--svg-style", "laser", "output.svg_style is \"print\" there, \"laser\" here"),
        ("--min-width", "0.2", "output.least_width_mm is 0.0 there, 0.2 here"),
        ("--season", "0.5", "state.season is 0.0 there, 0.5 here"),
    ] {
        for more in [&["--skip-existing"][..], &["--skip-existing", "--dry-run"]] {
            let arguments = [&small(&batch)[..], &[flag, value], more].concat();
            let message = fail(folder.path(), 3, &arguments);
            assert!(message.contains(&format!("{leaf}{differs}; --force")), "{message}");
        }
    }
    assert!(contents(&out) == before);
    // Of a run that was killed, too: its files would stand beside those of this one.
    std::fs::remove_file(out.join("fagus-sylvatica_s0001/manifest.json")).unwrap();
    let other = [&small(&batch)[..], &["--profile", "unreal", "--skip-existing"]].concat();
    assert!(fail(folder.path(), 3, &other).contains("output.profile"));
    succeed(folder.path(), &[&small(&batch)[..], &["--skip-existing"]].concat());
    assert!(contents(&out) == before);
}

#[test]
fn a_leaf_that_lacks_files_asked_for_is_made_anew_and_loses_none() {
    let folder = fresh();
    let leaf = |more: &[&'static str]| small(&[&["generate", "beech", "-o", "out"], more].concat());
    let out = folder.path().join("out");
    succeed(folder.path(), &leaf(&["--maps", "basecolor", "--format", "obj"]));
    let other = leaf(&["--maps", "height", "--format", "svg", "--skip-existing"]);
    let planned = succeed(folder.path(), &[&other[..], &["--dry-run"]].concat());
    assert_eq!(succeed(folder.path(), &other), planned);
    let files = contents(&out);
    assert_eq!(paths(&files), told(&out));
    let both = ["--maps", "basecolor,height", "--format", "obj,svg"];
    // As if both had been asked for at once; and either has what it wants now.
    for more in [&both[..], &["--maps", "basecolor"], &["--maps", "height", "--format", "none"]] {
        let again = [&leaf(more)[..], &["--skip-existing"]].concat();
        let (code, _, message) = run(folder.path(), &again);
        assert_eq!(code, 0, "{message}");
        assert!(message.contains("1 of 1 leaves were there already"), "{message}");
    }
    assert!(contents(&out) == files);
    succeed(folder.path(), &[&leaf(&both)[..], &["--force"]].concat());
    assert!(contents(&out) == files);
}

#[test]
fn files_of_an_older_leaf_are_not_taken_for_those_of_the_new_one() {
    let folder = fresh();
    let leaf = |more: &[&'static str]| small(&[&["generate", "beech", "-o", "out"], more].concat());
    let height = || std::fs::read(folder.path().join("out/fagus-sylvatica_Height.png")).unwrap();
    succeed(folder.path(), &leaf(&["--maps", "basecolor,height", "--seed", "2"]));
    let old = height();
    succeed(folder.path(), &leaf(&["--maps", "basecolor", "--force"]));
    succeed(folder.path(), &leaf(&["--maps", "basecolor,height", "--skip-existing"]));
    assert!(height() != old);
    let out = folder.path().join("out");
    assert_eq!(paths(&contents(&out)), told(&out));
    // Nor is an empty file taken for one; what somebody has packed anew is left as it is.
    let whole = height();
    let picture = out.join("fagus-sylvatica_Height.png");
    for (bytes, expected) in [(&b""[..], &whole[..]), (b"packed", b"packed")] {
        std::fs::write(&picture, bytes).unwrap();
        succeed(folder.path(), &leaf(&["--maps", "basecolor,height", "--skip-existing"]));
        assert!(height() == expected);
    }
}
