//! (stub)
use super::{Context, Failure};
#[derive(Debug, clap::Args)]
pub(crate) struct Args {}
pub(crate) fn run(_: &Args, _: &mut Context<'_>) -> Result<(), Failure> {
    Ok(())
}
