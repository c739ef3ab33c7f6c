//! The only library modules that read or write.
//!
//! Writing has two halves: [`encode_leaf`] turns a leaf into named bytes and touches no disk,
//! [`write::write_files`] puts named bytes into a folder. [`file_names`] tells beforehand what a run
//! will write.

pub mod animation;
pub mod atlas;
pub mod batch;
pub mod card;
mod decimal;
mod drawing;
pub mod dxf;
pub mod fit;
pub mod glb;
pub mod graph;
pub mod graphml;
pub mod image;
mod jpeg;
mod leaf_files;
pub mod manifest;
mod map_files;
pub mod mask;
pub mod network;
pub mod obj;
pub mod outline;
mod remains;
pub mod silhouettes;
pub mod svg;
pub mod tables;
pub mod usda;
pub mod write;

use std::path::{Path, PathBuf};

pub use crate::spec::FormatKind;
pub use crate::texture::map::MapKind;
pub use leaf_files::{LeafFiles, encode_leaf, file_names, run_sha256, settings_sha256};

/// The program and its version, as every file names its maker.
pub const GENERATOR: &str = concat!("venation ", env!("CARGO_PKG_VERSION"));

/// The resolved settings, from which the same leaf can be made again.
pub const SPEC_FILE: &str = "leaf.toml";

/// The list of all files; written last, so where it is, the run was completed.
pub const MANIFEST_FILE: &str = "manifest.json";

/// Why files could not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Files are already there and were not to be replaced.
    #[error("{} already holds {}", folder.display(), listed(files))]
    WouldOverwrite {
        /// The folder.
        folder: PathBuf,
        /// The files in the way, relative to it.
        files: Vec<String>,
    },
    /// The system refused.
    #[error("cannot write {}: {source}", path.display())]
    Write {
        /// What was to be written.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl Error {
    fn write(path: &Path, source: std::io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }
}

/// The first few names, and how many more.
fn listed(files: &[String]) -> String {
    const SHOWN: usize = 12;
    let mut list = files.iter().take(SHOWN).map(String::as_str).collect::<Vec<_>>().join(", ");
    if files.len() > SHOWN {
        list += &format!(" and {} more", files.len() - SHOWN);
    }
    list
}

/// The name of a leaf as the beginning of file names: letters, digits, `_`, `-` and `.` stay, all
/// else becomes `_`, because an MTL cannot name a file with a space in it and a slash would leave
/// the folder.
#[must_use]
pub fn file_stem(name: &str) -> String {
    // Letters of up to 4 bytes, and endings to come: far below the 255 bytes that names may have.
    const LONGEST: usize = 48;
    let kept = |c: char| if c.is_alphanumeric() || "_-.".contains(c) { c } else { '_' };
    let stem: String = name.trim().chars().map(kept).take(LONGEST).collect();
    match stem.chars().next() {
        None => "leaf".into(),
        // Not hidden, and not taken for a flag.
        Some('.' | '-') => format!("_{stem}"),
        Some(_) => stem,
    }
}
