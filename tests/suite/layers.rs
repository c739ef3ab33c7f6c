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

/// Every Rust file below a folder but those that hold nothing but tests.
fn sources(folder: &Path) -> Vec<std::path::PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("src can be read") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            found.extend(sources(&path));
        } else if path.extension().is_some_and(|e| e == "rs") && !path.ends_with("tests.rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A file without comments and without what is compiled for tests only: what they use is their own affair.
fn code(text: &str) -> String {
    let mut code = String::new();
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.trim_start().starts_with("//") {
            continue;
        }
        if line.trim() != "#[cfg(test)]" {
            code += line;
            code.push('\n');
            continue;
        }
        let end = line.replace("#[cfg(test)]", "}");
        let item = lines.by_ref().find(|line| !line.trim_start().starts_with('#'));
        if item.is_some_and(|item| !item.ends_with(';') && !item.ends_with('}')) {
            lines.by_ref().find(|line| *line == end);
        }
    }
    code
}

/// The modules that follow `crate::`, alone or in braces.
fn used_modules(code: &str) -> Vec<String> {
    let name = |text: &str| -> String {
        text.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
    };
    let mut used = Vec::new();
    for path in code.split("crate::").skip(1) {
        let Some(group) = path.strip_prefix('{') else {
            used.push(name(path));
            continue;
        };
        let (mut depth, mut start) = (0, 0);
        for (i, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth > 0 => depth -= 1,
                ',' | '}' if depth == 0 => {
                    used.push(name(&group[start..i]));
                    start = i + 1;
                    if c == '}' {
                        break;
                    }
                }
                _ => {}
            }
        }
    }
    used
}

#[test]
fn what_a_file_uses_is_found_wherever_its_tests_stand() {
    let text = "\
#[cfg(test)]
mod tests;

// use crate::cli;
use crate::{geometry::{self, Rect}, raster};
impl crate::texture::Map {
    #[cfg(test)]
    #[must_use]
    fn seen() {
        crate::io::x();
    }
}
#[cfg(test)]
mod more {
    use crate::pipeline;
}
fn last() -> crate::veins::Graph {}
";
    assert_eq!(used_modules(&code(text)), ["geometry", "raster", "texture", "veins"]);
}

#[test]
fn files_and_the_environment_are_met_in_io_and_the_program_only() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for path in sources(&src) {
        let relative = path.strip_prefix(&src).expect("below src");
        if ["io", "cli"].iter().any(|home| relative.starts_with(home)) {
            continue;
        }
        let text = code(&std::fs::read_to_string(&path).expect("a source file"));
        for name in ["std::fs", "std::env", "std::net", "std::process::Command"] {
            assert!(!text.contains(name), "{} names {name}", relative.display());
        }
    }
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
        for used in used_modules(&code(&text)) {
            if used != module && line_of(&used).is_some_and(|other| other >= line) {
                upward.push(format!("{}: {used}", relative.display()));
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
