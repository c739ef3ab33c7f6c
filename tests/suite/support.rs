//! What several tests need: the program in a fresh folder, and folders compared byte for byte.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use assert_cmd::Command;

/// The program, run inside `folder`.
pub(crate) fn venation(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::cargo_bin("venation").expect("the program is built with the tests");
    command.current_dir(folder).args(arguments);
    command
}

/// Exit code, stdout and stderr of a run.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = venation(folder, arguments).output().expect("the program starts");
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("output is UTF-8");
    let code = output.status.code().expect("the program exits by itself");
    (code, text(output.stdout), text(output.stderr))
}

/// Runs and expects exit code 0; gives stdout.
pub(crate) fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let (code, stdout, stderr) = run(folder, arguments);
    assert_eq!(code, 0, "{arguments:?}: {stderr}");
    stdout
}

/// Runs and expects `code` with a one-line message; gives the message.
pub(crate) fn fail(folder: &Path, code: i32, arguments: &[&str]) -> String {
    let (got, _, stderr) = run(folder, arguments);
    assert_eq!(got, code, "{arguments:?}: {stderr}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert!(stderr.starts_with("venation: "), "{stderr}");
    stderr
}

/// Every file below a folder, by relative path.
pub(crate) fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut files = BTreeMap::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(next) = open.pop() {
        for entry in std::fs::read_dir(&next).expect("the folder can be read") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below the folder").to_path_buf();
                files.insert(name, std::fs::read(&path).expect("the file can be read"));
            }
        }
    }
    files
}

/// Asserts that two folders hold the same files with the same bytes.
pub(crate) fn assert_same(a: &Path, b: &Path) {
    let (a, b) = (contents(a), contents(b));
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(bytes == &b[name], "{} differs", name.display());
    }
}

/// A fresh folder that goes when dropped.
pub(crate) fn fresh() -> tempfile::TempDir {
    tempfile::tempdir().expect("a temporary folder")
}

/// Settings that leave few veins, which grow quickly.
pub(crate) const FEW_VEINS: &[&str] = &[
    "--set",
    "veins.kill_distance_mm=4",
    "--set",
    "veins.source_spawn_distance_mm=5",
    "--set",
    "veins.vein_spawn_distance_mm=5",
    "--set",
    "veins.node_step_mm=1",
];

/// A command that makes small leaves with few veins.
pub(crate) fn small<'a>(arguments: &[&'a str]) -> Vec<&'a str> {
    [arguments, &["--size", "64"], FEW_VEINS].concat()
}

/// The collection of real leaves, or `None` after saying so.
pub(crate) fn collection() -> Option<PathBuf> {
    let folder = std::env::var_os("VENATION_LEAVES").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: VENATION_LEAVES does not name a collection of leaves");
    }
    folder
}
