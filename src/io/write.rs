//! Files to a folder: all of them or none, whole or not at all, never over others unasked.
//!
//! Every file is first written beside its place under a temporary name and flushed to disk; only
//! when all are there are they renamed, in order. A run that is killed, or a disk that is full,
//! leaves what was there before, or whole new files: put the file that describes the others last,
//! and its presence says that a run was completed. Temporary files of killed runs lie about until the
//! next run writes to their folder: it deletes those whose process is gone.

use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write as _};
use std::path::{Component, Path, PathBuf};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

use sha2::{Digest, Sha256};

use super::Error;

/// What to do when a file is already there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Overwrite {
    /// Write nothing and name the files in the way.
    Refuse,
    /// Replace them.
    Force,
}

/// Temporary files begin with this, so that people know whose they are and `ls` hides them. What
/// follows is the machine, the process and a number: `.venation-tmp-5f0c91d2-4711-3`.
const TEMPORARY_PREFIX: &str = ".venation-tmp-";

/// Temporary files of other machines are taken for dead when nothing was written to them for so long:
/// no file takes a fraction of it.
const ABANDONED: Duration = Duration::from_secs(24 * 60 * 60);

/// Those of `names` (relative, with `/`) that are already in `folder`, in order.
#[must_use]
pub fn collisions<'a>(folder: &Path, names: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    // A dangling link is in the way too, so do not follow links.
    let taken = |name: &&str| fs::symlink_metadata(folder.join(name)).is_ok();
    names.into_iter().filter(taken).map(str::to_owned).collect()
}

/// Writes `files` (relative name with `/`, content) into `folder`, which is made if need be.
///
/// # Errors
///
/// - [`Error::WouldOverwrite`] lists the files in the way, unless forced; nothing is written.
/// - [`Error::Write`] with the path that could not be written; files not yet renamed are taken
///   back.
pub fn write_files(
    folder: &Path,
    files: &[(String, Vec<u8>)],
    overwrite: Overwrite,
) -> Result<(), Error> {
    let names = || files.iter().map(|(name, _)| name.as_str());
    if let Some(name) = names().find(|name| !stays_inside(name)) {
        let source = std::io::Error::new(ErrorKind::InvalidInput, "the name leaves the folder");
        return Err(Error::Write { path: folder.join(name), source });
    }
    if overwrite == Overwrite::Refuse {
        let taken = collisions(folder, names());
        if !taken.is_empty() {
            return Err(Error::WouldOverwrite { folder: folder.to_owned(), files: taken });
        }
    }
    for path in names().map(|name| folder.join(name)) {
        let source = match fs::metadata(&path) {
            Ok(there) if there.is_dir() => ErrorKind::IsADirectory.into(),
            // A device or a pipe would be gone, and a file in its place.
            Ok(there) if !there.is_file() => {
                std::io::Error::new(ErrorKind::InvalidInput, "is no plain file")
            }
            _ => continue,
        };
        return Err(Error::Write { path, source });
    }

    let mut staged = Staged::default();
    for (name, content) in files {
        staged.add(&folder.join(name), content)?;
    }
    staged.rename()
}

fn stays_inside(name: &str) -> bool {
    !name.is_empty() && Path::new(name).components().all(|c| matches!(c, Component::Normal(_)))
}

/// Files under temporary names, deleted when dropped.
#[derive(Debug, Default)]
struct Staged {
    /// Temporary path and final path.
    files: Vec<(PathBuf, PathBuf)>,
}

impl Staged {
    fn add(&mut self, path: &Path, content: &[u8]) -> Result<(), Error> {
        let folder = path.parent().unwrap_or(Path::new(""));
        fs::create_dir_all(folder)
            .map_err(|source| Error::write(folder, blocked(folder, source)))?;
        if !self.files.iter().any(|(_, path)| path.parent() == Some(folder)) {
            remove_abandoned(folder);
        }
        let (mut file, temporary) = create_temporary(folder)?;
        self.files.push((temporary, path.to_owned()));
        file.write_all(content)
            .and_then(|()| file.sync_all())
            .map_err(|source| Error::write(path, source))
    }

    fn rename(mut self) -> Result<(), Error> {
        // The last file vouches for the others: an old one must not vouch for half a new set.
        if let [.., _, (_, seal)] = &self.files[..]
            && let Err(source) = fs::remove_file(seal)
            && source.kind() != ErrorKind::NotFound
        {
            return Err(Error::write(seal, source));
        }
        let mut folders: Vec<PathBuf> = Vec::new();
        for (temporary, path) in &self.files {
            fs::rename(temporary, path).map_err(|source| Error::write(path, source))?;
            if let Some(folder) = path.parent().filter(|f| !folders.iter().any(|seen| seen == f)) {
                folders.push(folder.to_owned());
            }
        }
        self.files.clear();
        // The names are safe only once the folders are; not every system can flush a folder, and
        // the files themselves are flushed, so a refusal is no error.
        for folder in folders {
            let _ = File::open(folder).and_then(|folder| folder.sync_all());
        }
        Ok(())
    }
}

impl Drop for Staged {
    fn drop(&mut self) {
        for (temporary, _) in &self.files {
            // Those already renamed are gone; there is nobody to tell about the rest.
            let _ = fs::remove_file(temporary);
        }
    }
}

/// A new file in `folder` that nobody else writes to.
fn create_temporary(folder: &Path) -> Result<(File, PathBuf), Error> {
    static COUNTER: AtomicU32 = AtomicU32::new(0);
    loop {
        // Process ids repeat, across containers even at the same time: on a clash, count on.
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let name = format!("{TEMPORARY_PREFIX}{}-{}-{count}", machine(), std::process::id());
        let path = folder.join(name);
        match OpenOptions::new().write(true).create_new(true).open(&path) {
            Ok(file) => return Ok((file, path)),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(source) => return Err(Error::write(folder, source)),
        }
    }
}

/// What tells the processes of this machine, or container, from those of others that write to the same
/// disk: eight hexadecimal digits.
fn machine() -> &'static str {
    static TAG: LazyLock<String> = LazyLock::new(|| {
        // A process number means something within one boot and one namespace only. Where the system
        // has no such files, every machine is the same and only age tells.
        let boot = fs::read("/proc/sys/kernel/random/boot_id").unwrap_or_default();
        let namespace = fs::read_link("/proc/self/ns/pid").unwrap_or_default();
        let digest = Sha256::digest([&boot, namespace.as_os_str().as_encoded_bytes()].concat());
        digest[..4].iter().map(|byte| format!("{byte:02x}")).collect()
    });
    &TAG
}

/// Deletes what killed runs left in a folder. Nothing is lost when it cannot: later runs pass by.
fn remove_abandoned(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(rest) = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY_PREFIX)) else {
            continue;
        };
        let mut parts = rest.split('-');
        let (on, process) = (parts.next(), parts.next().and_then(|id| id.parse::<u32>().ok()));
        let gone = on == Some(machine())
            && process.is_some_and(|id| {
                Path::new("/proc/self").exists() && !Path::new(&format!("/proc/{id}")).exists()
            });
        let age = entry.metadata().and_then(|data| data.modified()).map(|time| time.elapsed());
        let old = age.is_ok_and(|age| age.is_ok_and(|age| age > ABANDONED));
        if gone || old {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Says plainly when a file stands where a folder should be.
fn blocked(folder: &Path, source: std::io::Error) -> std::io::Error {
    match folder.ancestors().find(|path| path.is_file()) {
        Some(file) => std::io::Error::new(
            ErrorKind::NotADirectory,
            format!("{} is a file, not a folder", file.display()),
        ),
        None => source,
    }
}
