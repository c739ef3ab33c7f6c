//! One leaf to make: what it is, where it goes, whether it is there already.

use std::path::PathBuf;

use venation::document::{Comments, Document};
use venation::io::batch::BatchLine;
use venation::io::manifest::Manifest;
use venation::io::write::{Overwrite, collisions};
use venation::io::{self, MANIFEST_FILE, SPEC_FILE};
use venation::spec::{LeafSpec, Output};

use super::super::{Failure, leaf_args};

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
        let toml = Document::of_spec(&spec, seed).to_toml(Comments::None);
        let output = spec.output.resolve().map_err(venation::error::Error::from)?;
        Ok(Self { seed, spec, varied, folder, subfolder, toml, output })
    }

    /// The files of this leaf, relative to its folder.
    pub(super) fn names(&self) -> Vec<String> {
        io::file_names(&self.spec.name, self.spec.texture.size_px as usize, &self.output)
    }

    /// Whether an earlier run finished this very leaf (the manifest is written last, and carries the
    /// hash of its settings) and every file that is wanted is there.
    pub(super) fn is_done(&self) -> bool {
        self.manifest().is_some_and(|manifest| manifest.settings_sha256 == self.settings_sha256())
            && self.names().iter().all(|name| self.folder.join(name).is_file())
    }

    fn manifest(&self) -> Option<Manifest> {
        let text = std::fs::read(self.folder.join(MANIFEST_FILE)).ok()?;
        serde_json::from_slice(&text).ok()
    }

    pub(super) fn settings_sha256(&self) -> String {
        io::settings_sha256(&self.toml)
    }

    /// A killed run of this very leaf may be completed over, in other forms too; other people's files
    /// may not.
    pub(super) fn resume(&self) -> Overwrite {
        let leaf = |text: &str| text.split("\n[output]").next().map(str::to_owned);
        let same = std::fs::read_to_string(self.folder.join(SPEC_FILE))
            .is_ok_and(|text| leaf(&text) == leaf(&self.toml));
        if same { Overwrite::Force } else { Overwrite::Refuse }
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
