//! Making one leaf of a run: grown, painted, written.

use std::sync::{Mutex, MutexGuard, PoisonError};

use venation::io::write::{Overwrite, write_files};
use venation::io::{self, LeafFiles};
use venation::pipeline;
use venation::seed::Seed;
use venation::texture::Canvas;

use super::super::Failure;
use super::super::progress::Bar;
use super::job::Job;
use super::{Made, notes};

/// Canvases of leaves that have been written, for those to come: as many as are made at a time.
#[derive(Default)]
pub(super) struct Canvases(Mutex<Vec<Canvas>>);

impl Canvases {
    fn list(&self) -> MutexGuard<'_, Vec<Canvas>> {
        // A thread that died with the list in hand has left it whole.
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

pub(super) fn make(
    job: &Job,
    overwrite: Overwrite,
    quiet: bool,
    canvases: &Canvases,
) -> Result<Made, Failure> {
    let mut bar = Bar::new(quiet, "");
    let canvas = || canvases.list().pop().unwrap_or_default();
    let leaf = pipeline::generate_with(&job.spec, Seed(job.seed), canvas, &mut bar)?;
    let files = io::encode_leaf(&LeafFiles::of(&leaf, &job.toml, &job.output));
    write_files(&job.folder, &files, overwrite)?;
    let made = Made {
        files: files.into_iter().map(|(name, _)| name).collect(),
        nodes: leaf.grown.venation.graph().len(),
        unreached_sources: leaf.grown.venation.unreached().total(),
        note: notes::of_sources(&leaf.grown.venation),
        ..Made::of(job, "made")
    };
    canvases.list().push(leaf.textures.into());
    Ok(made)
}
