//! The flags that say how a command that writes leaves runs: shared by those that do.

use venation::io::write::Overwrite;

use super::numbers;

#[derive(Debug, clap::Args)]
pub(crate) struct RunArgs {
    /// Threads to use; the bytes are the same for any number [default: all processors].
    #[arg(short, long, value_name = "N", value_parser = numbers::threads)]
    pub(crate) threads: Option<usize>,
    /// Report on stdout as one JSON document.
    #[arg(long)]
    pub(crate) json: bool,
    /// Only list the files that would be written.
    #[arg(short = 'n', long)]
    pub(crate) dry_run: bool,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

impl RunArgs {
    /// What becomes of files that are there already.
    pub(crate) fn overwrite(&self) -> Overwrite {
        if self.force { Overwrite::Force } else { Overwrite::Refuse }
    }
}
