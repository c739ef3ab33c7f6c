//! What a batch has made: one line a leaf, one file a shard, and putting the shards together.
//!
//! A shard writes `manifest.0003-of-0016.jsonl` and no other shard touches it, so many machines
//! can work in one folder without a lock. [`merge`] makes of them the `manifest.jsonl` that one
//! machine alone would have written, byte for byte.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::manifest::Manifest;

/// Why manifests could not be read or put together.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BatchError {
    /// The system refused.
    #[error("{}: {source}", path.display())]
    Read {
        /// What was to be read.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A line that tells of no leaf.
    #[error("{}:{line}: {source}", path.display())]
    Line {
        /// The manifest.
        path: PathBuf,
        /// Which line, from 1.
        line: usize,
        /// What is wrong with it.
        source: serde_json::Error,
    },
    /// A folder without a manifest of a shard.
    #[error("{}: holds no manifest.I-of-N.jsonl", path.display())]
    NoShards {
        /// The folder.
        path: PathBuf,
    },
    /// Shards of runs with other settings or seeds.
    #[error(
        "{} and {} are shards of different runs: give all of them the same leaf, settings and seeds",
        files[0].display(), files[1].display()
    )]
    OtherRun {
        /// Their manifests.
        files: [PathBuf; 2],
    },
    /// Shards of a number that differs.
    #[error("{} and {} are shards of different batches", files[0].display(), files[1].display())]
    OtherBatch {
        /// Their manifests.
        files: [PathBuf; 2],
    },
    /// Two manifests that tell different things of one leaf.
    #[error(
        "{} and {} disagree about {folder}: they are of different runs",
        files[0].display(), files[1].display()
    )]
    Disagree {
        /// The manifests.
        files: [PathBuf; 2],
        /// The leaf's folder.
        folder: String,
    },
    /// Shards that are not there.
    #[error("{} missing", super::listed(names))]
    Missing {
        /// The names of their manifests.
        names: Vec<String>,
    },
}

fn both(first: &Path, second: &Path) -> [PathBuf; 2] {
    [first.to_owned(), second.to_owned()]
}

/// The manifest of a batch that is not cut into shards.
pub const BATCH_FILE: &str = "manifest.jsonl";

/// One shard of a batch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Which one, from 0.
    pub index: usize,
    /// Of how many.
    pub count: usize,
}

impl Shard {
    /// Reads `i/n`. Shards may be counted from 0 or from 1: `0/n` and `n/n` are the same one, so that
    /// either way of counting covers everything once.
    ///
    /// # Errors
    ///
    /// What is wrong, in words.
    pub fn parse(text: &str) -> Result<Self, String> {
        const MOST: usize = 9999;
        let number = |part: &str| part.trim().parse::<usize>().ok();
        let (index, count) = text
            .split_once('/')
            .and_then(|(index, count)| Some((number(index)?, number(count)?)))
            .ok_or_else(|| format!("`{text}` is not i/n, like 3/16"))?;
        if count == 0 || count > MOST {
            return Err(format!("{count} shards: there are 1 to {MOST}"));
        }
        if index > count {
            return Err(format!("shard {index} of {count}: i is at most n"));
        }
        Ok(Self { index: index % count, count })
    }

    /// Whether the item at this place of the whole list is this shard's.
    #[must_use]
    pub const fn holds(self, place: usize) -> bool {
        place % self.count == self.index
    }

    /// The name of its manifest.
    #[must_use]
    pub fn file(self) -> String {
        format!("manifest.{:04}-of-{:04}.jsonl", self.index, self.count)
    }

    /// The shard whose manifest has this name.
    fn of_file(name: &str) -> Option<Self> {
        let (index, count) =
            name.strip_prefix("manifest.")?.strip_suffix(".jsonl")?.split_once("-of-")?;
        let shard = Self { index: index.parse().ok()?, count: count.parse().ok()? };
        (shard.index < shard.count && shard.file() == name).then_some(shard)
    }
}

/// A leaf of a batch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BatchLine {
    /// Its seed.
    pub seed: u64,
    /// Its name.
    pub name: String,
    /// Its folder, relative to the manifest.
    pub folder: String,
    /// Of its settings: two leaves with the same are the same.
    pub settings_sha256: String,
    /// In the manifest of a shard, the hash of the run that it is a shard of.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub run_sha256: Option<String>,
    /// Why there is none.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub problem: Option<String>,
    /// Its files.
    pub files: Vec<BatchFile>,
}

/// A file of a leaf of a batch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BatchFile {
    /// Relative to the leaf's folder, with `/`.
    pub path: String,
    /// Length.
    pub bytes: usize,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

impl BatchLine {
    /// The line of a leaf that is there.
    #[must_use]
    pub fn of(folder: &str, manifest: &Manifest) -> Self {
        let files = manifest.files.iter().map(|file| BatchFile {
            path: file.path.clone(),
            bytes: file.bytes,
            sha256: file.sha256.clone(),
        });
        Self {
            seed: manifest.seed,
            name: manifest.name.clone(),
            folder: folder.to_owned(),
            settings_sha256: manifest.settings_sha256.clone(),
            run_sha256: None,
            problem: None,
            files: files.collect(),
        }
    }
}

/// The text of a manifest: a line of JSON for every leaf, by name and seed.
#[must_use]
pub fn to_jsonl(lines: &[BatchLine]) -> String {
    let mut ordered: Vec<&BatchLine> = lines.iter().collect();
    ordered.sort_by_key(|line| (&line.name, line.seed, &line.folder));
    ordered
        .into_iter()
        .map(|line| serde_json::to_string(line).expect("plain data has a form in JSON") + "\n")
        .collect()
}

/// The lines of leaves that an earlier run left in a folder and that are not made anew: a manifest tells
/// of all that is there.
///
/// # Errors
///
/// A manifest that cannot be read.
pub fn others(path: &Path, made: &[BatchLine]) -> Result<Vec<BatchLine>, BatchError> {
    if !path.exists() {
        return Ok(Vec::new());
    }
    let mut lines = read(path)?;
    lines.retain(|line| made.iter().all(|own| own.folder != line.folder));
    lines.iter_mut().for_each(|line| line.run_sha256 = None);
    Ok(lines)
}

/// Reads a manifest.
fn read(path: &Path) -> Result<Vec<BatchLine>, BatchError> {
    let text = std::fs::read_to_string(path)
        .map_err(|source| BatchError::Read { path: path.to_owned(), source })?;
    text.lines()
        .enumerate()
        .map(|(i, line)| {
            serde_json::from_str(line).map_err(|source| BatchError::Line {
                path: path.to_owned(),
                line: i + 1,
                source,
            })
        })
        .collect()
}

/// The manifests of shards in `paths`: files as they are, of folders those that lie in them.
///
/// # Errors
///
/// A folder that cannot be read or holds none.
pub fn shard_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, BatchError> {
    let mut files = Vec::new();
    for path in paths {
        if !path.is_dir() {
            files.push(path.clone());
            continue;
        }
        let entries = std::fs::read_dir(path)
            .map_err(|source| BatchError::Read { path: path.clone(), source })?;
        let mut found: Vec<PathBuf> = entries
            .filter_map(|entry| Some(entry.ok()?.path()))
            .filter(|path| {
                let name = path.file_name().map(|name| name.to_string_lossy().into_owned());
                name.is_some_and(|name| Shard::of_file(&name).is_some())
            })
            .collect();
        if found.is_empty() {
            return Err(BatchError::NoShards { path: path.clone() });
        }
        found.sort();
        files.extend(found);
    }
    Ok(files)
}

/// One manifest of many: every leaf once. A leaf that several shards made alike is one leaf.
///
/// # Errors
///
/// A manifest that cannot be read; shards of different batches or runs; a shard that is missing; two
/// that disagree about a leaf.
pub fn merge(files: &[PathBuf]) -> Result<Vec<BatchLine>, BatchError> {
    let mut merged: BTreeMap<String, (BatchLine, &Path)> = BTreeMap::new();
    let mut shards: Vec<(Shard, &Path)> = Vec::new();
    let mut run: Option<(String, &Path)> = None;
    for file in files {
        let name = file.file_name().map(|name| name.to_string_lossy().into_owned());
        if let Some(shard) = name.and_then(|name| Shard::of_file(&name)) {
            shards.push((shard, file));
        }
        for mut line in read(file)? {
            if let Some(own) = line.run_sha256.take() {
                let (first, from) = run.get_or_insert_with(|| (own.clone(), file));
                if *first != own {
                    return Err(BatchError::OtherRun { files: both(from, file) });
                }
            }
            if let Some((other, from)) = merged.get(&line.folder)
                && *other != line
            {
                return Err(BatchError::Disagree { files: both(from, file), folder: line.folder });
            }
            merged.insert(line.folder.clone(), (line, file));
        }
    }
    if let Some((first, path)) = shards.first() {
        if let Some((_, other)) = shards.iter().find(|(shard, _)| shard.count != first.count) {
            return Err(BatchError::OtherBatch { files: both(path, other) });
        }
        let names: Vec<String> = (0..first.count)
            .filter(|index| !shards.iter().any(|(shard, _)| shard.index == *index))
            .map(|index| Shard { index, count: first.count }.file())
            .collect();
        if !names.is_empty() {
            return Err(BatchError::Missing { names });
        }
    }
    Ok(merged.into_values().map(|(line, _)| line).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn either_way_of_counting_covers_everything_once() {
        for count in [1, 2, 3, 16] {
            for first in [0, 1] {
                let shards: Vec<Shard> = (first..count + first)
                    .map(|i| Shard::parse(&format!("{i}/{count}")).unwrap())
                    .collect();
                for place in 0..50 {
                    assert_eq!(shards.iter().filter(|shard| shard.holds(place)).count(), 1);
                }
            }
        }
    }

    #[test]
    fn a_shard_reads_back_from_its_file() {
        let shard = Shard { index: 3, count: 16 };
        assert_eq!(Shard::of_file(&shard.file()), Some(shard));
        for name in ["manifest.jsonl", "manifest.16-of-16.jsonl", "manifest.3-of-16.jsonl"] {
            assert_eq!(Shard::of_file(name), None);
        }
        for text in ["", "3", "3/0", "4/3", "-1/3", "a/b", "1/100000"] {
            assert!(Shard::parse(text).is_err(), "{text}");
        }
    }
}
