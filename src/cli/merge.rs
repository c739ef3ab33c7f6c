//! `venation merge`: the manifests of shards put together.

use std::path::PathBuf;

use venation::io::batch;

use super::{Context, Failure};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation generate linden --seeds 1-50 -o lindens --shard 0/2     on one machine
  venation generate linden --seeds 1-50 -o lindens --shard 1/2     on another
  venation merge lindens                                           writes lindens/manifest.jsonl

The result is, byte for byte, the manifest of the run without --shard.")]
pub(crate) struct Args {
    /// Folders with manifests of shards, or such manifests.
    #[arg(value_name = "DIR | FILE.jsonl", required = true)]
    shards: Vec<PathBuf>,
    /// The manifest to write [default: manifest.jsonl beside the first one].
    #[arg(short, long, value_name = "FILE.jsonl")]
    out: Option<PathBuf>,
    /// Overwrite a manifest that says something else.
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let files = batch::shard_files(&args.shards)?;
    let lines = batch::merge(&files)?;
    let text = batch::to_jsonl(&lines);
    let beside = || files[0].with_file_name(batch::BATCH_FILE);
    let path = args.out.clone().unwrap_or_else(beside);
    // Merging again is no change, so it is no overwriting either.
    let same = std::fs::read(&path).is_ok_and(|bytes| bytes == text.as_bytes());
    if !same {
        super::refuse_existing([&path], args.force)?;
        super::save(&path, text.into_bytes())?;
    }
    writeln!(context.stdout, "{}", path.display())?;
    let failed = lines.iter().filter(|line| line.problem.is_some()).count();
    if failed > 0 {
        return Err(Failure::Partial(format!("{failed} of {} leaves failed", lines.len())));
    }
    context.say(&format!("{} leaves of {} shards", lines.len(), files.len()));
    Ok(())
}
