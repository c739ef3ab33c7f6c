//! One leaf to make: what it is, where it goes, whether it is there already.

use std::path::PathBuf;

use venation::document::{Comments, Document};
use venation::io::batch::BatchLine;
use venation::io::manifest::Manifest;
use venation::io::write::{Overwrite, collisions};
use venation::io::{self, MANIFEST_FILE, SPEC_FILE};
use venation::seed::Seed;
use venation::spec::{LeafSpec, Output};

use super::super::{Failure, leaf_args};
use super::difference::difference;

/// One leaf to make.
pub(super) struct Job {
    pub(super) seed: u64,
    pub(super) spec: LeafSpec,
    /// By how many percent its margin is perturbed; `None` where it is taken as it stands.
    pub(super) varied: Option<f64>,
    /// Where it goes.
    pub(super) folder: PathBuf,
    /// The same, relative to the folder of the batch.
    pub(super) subfolder: String,
    /// The settings as they will stand in leaf.toml.
    pub(super) toml: String,
    pub(super) output: Output,
}

impl Job {
    /// The leaf of a seed, for a folder of its own below `root` or for `root` itself.
    pub(super) fn new(
        document: &Document,
        seed: u64,
        root: Option<&PathBuf>,
        single: bool,
    ) -> Result<Self, Failure> {
        let (spec, varied) = leaf_args::resolve_varied(document, seed)?;
        let root = root.cloned().unwrap_or_else(|| PathBuf::from(&spec.name));
        let subfolder = if single { String::new() } else { format!("{}_s{seed:04}", spec.name) };
        let folder = if single { root } else { root.join(&subfolder) };
        let (toml, output) = settings(&spec, seed)?;
        Ok(Self { seed, spec, varied, folder, subfolder, toml, output })
    }

    /// The files of this leaf, relative to its folder.
    pub(super) fn names(&self) -> Vec<String> {
        io::file_names(&self.spec.name, self.spec.texture.size_px as usize, &self.output)
    }

    /// Whether an earlier run finished this very leaf (the manifest is written last, and carries the
    /// hash of its settings) and made every file that is wanted, which is still there.
    pub(super) fn is_done(&self) -> bool {
        let Some(manifest) = self.manifest() else { return false };
        // A file that the manifest does not tell of is of another leaf. Of its bytes only that there are any
        // is asked: people pack pictures smaller.
        let is_there = |name: &String| {
            let data = self.folder.join(name).metadata();
            data.is_ok_and(|data| data.is_file() && data.len() > 0)
                && manifest.files.iter().any(|file| file.path == *name)
        };
        manifest.settings_sha256 == self.settings_sha256()
            && self.names().iter().filter(|name| *name != MANIFEST_FILE).all(is_there)
    }

    /// Goes on where an earlier run stopped: what becomes of the files that are there, `None` when
    /// nothing is left to do.
    ///
    /// A run of this very leaf may be completed over; of one that was finished with other maps or formats
    /// those stay, so that its manifest tells of all that is there.
    pub(super) fn go_on(&mut self) -> Result<Option<Overwrite>, Failure> {
        if self.is_done() {
            return Ok(None);
        }
        // Where no settings are, the files are other people's.
        let Ok(text) = std::fs::read_to_string(self.folder.join(SPEC_FILE)) else {
            return Ok(Some(Overwrite::Refuse));
        };
        if io::settings_sha256(&text) != self.settings_sha256() {
            let folder = self.folder.display();
            let what = difference(&text, &self.toml);
            let problem = format!(
                "{folder}: holds another leaf: {what}; --force overwrites, another -o keeps both"
            );
            return Err(Failure::Exists(problem));
        }
        if self.manifest().is_some() {
            self.join(&text)?;
        }
        Ok(Some(Overwrite::Force))
    }

    /// Adds the maps and formats of the settings that are there.
    fn join(&mut self, text: &str) -> Result<(), Failure> {
        let there = Document::parse(text, SPEC_FILE)?.resolve(Seed(self.seed))?;
        let joined = self.spec.output.joined(&there.output);
        self.spec.output = joined.map_err(venation::error::Error::from)?;
        (self.toml, self.output) = settings(&self.spec, self.seed)?;
        Ok(())
    }

    fn manifest(&self) -> Option<Manifest> {
        let text = std::fs::read(self.folder.join(MANIFEST_FILE)).ok()?;
        serde_json::from_slice(&text).ok()
    }

    pub(super) fn settings_sha256(&self) -> String {
        io::settings_sha256(&self.toml)
    }

    /// The files in the way.
    pub(super) fn collisions(&self) -> Vec<String> {
        collisions(&self.folder, self.names().iter().map(String::as_str))
    }

    /// The line of the batch's manifest for this leaf, from the manifest that it has on disk.
    pub(super) fn line(&self, problem: Option<String>) -> BatchLine {
        match self.manifest() {
            Some(manifest) if problem.is_none() => BatchLine::of(&self.subfolder, &manifest),
            _ => BatchLine {
                seed: self.seed,
                name: self.spec.name.clone(),
                folder: self.subfolder.clone(),
                settings_sha256: self.settings_sha256(),
                run_sha256: None,
                problem,
                files: Vec::new(),
            },
        }
    }
}

/// The settings of a leaf as text, and what they say is to be written.
fn settings(spec: &LeafSpec, seed: u64) -> Result<(String, Output), Failure> {
    let toml = Document::of_spec(spec, seed).to_toml(Comments::None);
    Ok((toml, spec.output.resolve().map_err(venation::error::Error::from)?))
}
