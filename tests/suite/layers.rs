//! Who may use whom: a module uses modules of lower lines only.

use std::path::Path;

/// The lines from the bottom up; modules of one line do not know each other.
const LINES: &[&[&str]] = &[
    &["units", "seed", "observer", "parallel", "parameter", "point_list", "spelling"],
    &["geometry"],
    &["raster"],
    &["margin"],
    &["growth"],
    &["veins"],
    &["texture"],
    &["spec"],
    &["document"],
    &["error"],
    &["pipeline", "presets"],
    &["benchmark"],
    &["io"],
];

fn line_of(module: &str) -> Option<usize> {
    LINES.iter().position(|line| line.contains(&module))
}

/// Every Rust file below a folder.
fn sources(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("src can be read") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

#[test]
fn modules_use_lower_lines_only() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut upward = Vec::new();
    for path in sources(&src) {
        let relative = path.strip_prefix(&src).expect("below src");
        let first = relative.iter().next().expect("a component").to_string_lossy();
        let module = first.trim_end_matches(".rs");
        if ["lib", "main", "cli"].contains(&module) {
            continue;
        }
        let line = line_of(module).unwrap_or_else(|| panic!("{module} has no line in LINES"));
        let text = std::fs::read_to_string(&path).expect("a source file");
        // What tests use is their own affair.
        let code = text.split("#[cfg(test)]").next().unwrap_or_default();
        for (number, row) in code.lines().enumerate() {
            if row.trim_start().starts_with("//") {
                continue;
            }
            for used in row.split("crate::").skip(1) {
                let used: String =
                    used.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
                let Some(other) = line_of(&used) else { continue };
                if used != module && other >= line {
                    upward.push(format!("{}:{}: {used}", relative.display(), number + 1));
                }
            }
        }
    }
    assert!(upward.is_empty(), "these use a module of their own line or above: {upward:#?}");
}

#[test]
fn crates_that_may_change_are_named_in_one_place_each() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let homes = [
        ("kiddo::", "geometry/point_index.rs"),
        ("tiny_skia::", "raster/draw"),
        ("clap::", "cli"),
        ("usvg::", "io/outline"),
    ];
    for path in sources(&src) {
        let relative = path.strip_prefix(&src).expect("below src").to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).expect("a source file");
        for (name, home) in homes {
            let named = text.lines().any(|l| !l.trim_start().starts_with("//") && l.contains(name));
            assert!(!named || relative.starts_with(home), "{relative} names {name}");
        }
    }
}
