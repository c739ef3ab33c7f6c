//! The writer, and what may stand in its way.

use std::fs;
use std::path::Path;

use venation::io::Error;
use venation::io::write::{Overwrite, collisions, write_files};

fn two_files() -> Vec<(String, Vec<u8>)> {
    vec![("a.txt".into(), b"new a".to_vec()), ("back/b.txt".into(), b"new b".to_vec())]
}

fn names_below(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn files_in_the_way_are_listed_and_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/out");
    write_files(&out, &two_files(), Overwrite::Refuse).unwrap();
    assert_eq!(fs::read(out.join("back/b.txt")).unwrap(), b"new b");
    fs::write(out.join("back/b.txt"), "old").unwrap();
    fs::remove_file(out.join("a.txt")).unwrap();

    let error = write_files(&out, &two_files(), Overwrite::Refuse).unwrap_err();
    match &error {
        Error::WouldOverwrite { folder, files } => {
            assert_eq!((folder, files), (&out, &vec!["back/b.txt".to_owned()]));
        }
        other => panic!("{other}"),
    }
    assert!(error.to_string().ends_with("already holds back/b.txt"), "{error}");
    assert_eq!(collisions(&out, ["a.txt", "back/b.txt"]), ["back/b.txt"]);
    assert_eq!(names_below(&out), ["back"]);
    assert_eq!(fs::read(out.join("back/b.txt")).unwrap(), b"old");

    write_files(&out, &two_files(), Overwrite::Force).unwrap();
    assert_eq!(fs::read(out.join("back/b.txt")).unwrap(), b"new b");
    assert_eq!(names_below(&out), ["a.txt", "back"]);
    assert_eq!(names_below(&out.join("back")), ["b.txt"]);
}

#[test]
fn a_file_where_the_folder_should_be_is_an_error_that_names_it() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::write(&out, "a file").unwrap();
    for overwrite in [Overwrite::Refuse, Overwrite::Force] {
        let error = write_files(&out, &two_files(), overwrite).unwrap_err().to_string();
        assert!(error.contains("out is a file, not a folder"), "{error}");
    }
    assert_eq!(fs::read(&out).unwrap(), b"a file");

    // The same below the folder: nothing of the rest is left behind.
    let out = folder.path().join("other");
    fs::create_dir(&out).unwrap();
    fs::write(out.join("back"), "a file").unwrap();
    let error = write_files(&out, &two_files(), Overwrite::Refuse).unwrap_err().to_string();
    assert!(error.contains("back is a file, not a folder"), "{error}");
    assert_eq!(names_below(&out), ["back"]);
}

#[test]
fn a_folder_where_a_file_should_be_stops_everything() {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir_all(folder.path().join("back/b.txt")).unwrap();
    let error = write_files(folder.path(), &two_files(), Overwrite::Force).unwrap_err();
    assert!(error.to_string().contains("b.txt"), "{error}");
    assert_eq!(names_below(folder.path()), ["back"]);
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_an_error_that_names_it() {
    // Not even root makes files here.
    let error = write_files(Path::new("/proc/1"), &two_files(), Overwrite::Refuse).unwrap_err();
    assert!(matches!(error, Error::Write { .. }));
    assert!(error.to_string().starts_with("cannot write /proc/1"), "{error}");
}

#[cfg(unix)]
#[test]
fn a_dangling_link_is_in_the_way() {
    let folder = tempfile::tempdir().unwrap();
    std::os::unix::fs::symlink("nowhere", folder.path().join("a.txt")).unwrap();
    let error = write_files(folder.path(), &two_files(), Overwrite::Refuse).unwrap_err();
    assert!(matches!(error, Error::WouldOverwrite { .. }), "{error}");
}

#[test]
fn what_killed_runs_left_does_not_matter() {
    let folder = tempfile::tempdir().unwrap();
    // Every name that this process could think of next.
    let left: Vec<String> =
        (0..200).map(|i| format!(".venation-tmp-{}-{i}", std::process::id())).collect();
    for name in &left {
        fs::write(folder.path().join(name), "half a pic").unwrap();
    }
    write_files(folder.path(), &two_files(), Overwrite::Refuse).unwrap();
    assert_eq!(fs::read(folder.path().join("a.txt")).unwrap(), b"new a");
    for name in &left {
        assert_eq!(fs::read(folder.path().join(name)).unwrap(), b"half a pic");
    }
    assert_eq!(names_below(folder.path()).len(), left.len() + 2);
}

#[test]
fn no_name_leaves_the_folder() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["../x", "/x", "a/../../x", ".", ""] {
        let out = folder.path().join("out");
        let error = write_files(&out, &[(name.into(), vec![])], Overwrite::Force).unwrap_err();
        assert!(error.to_string().contains("leaves the folder"), "{name}: {error}");
        assert!(!out.exists());
    }
}
