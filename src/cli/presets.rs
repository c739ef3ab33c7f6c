//! `venation presets`: what comes with the program.

use clap::Subcommand;
use venation::document::Comments;
use venation::presets::{self, FIGURES, PRESETS};

use super::{Context, Failure};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation presets                       names and descriptions
  venation presets --figures             shapes of the figures of the papers
  venation presets show beech            complete TOML with the meaning and limits of every key
  venation presets show beech > my.toml  a copy to edit; venation generate my.toml")]
pub(crate) struct Args {
    #[command(subcommand)]
    command: Option<PresetCommand>,
    /// The shapes of figures instead of the species.
    #[arg(long)]
    figures: bool,
    /// The list as JSON.
    #[arg(long)]
    json: bool,
}

#[derive(Debug, Subcommand)]
enum PresetCommand {
    /// Print a preset as complete TOML.
    Show {
        /// Latin or common name: fagus-sylvatica, beech.
        name: String,
    },
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    if let Some(PresetCommand::Show { name }) = &args.command {
        let preset =
            presets::find(name).ok_or_else(|| Failure::Input(super::leaf_args::unknown(name)))?;
        let text = preset.document()?.to_toml(Comments::Full);
        write!(context.stdout, "# {}: {}\n{text}", preset.common, preset.about)?;
        return Ok(());
    }
    let listed = if args.figures { FIGURES } else { PRESETS };
    if args.json {
        let list: Vec<_> = listed
            .iter()
            .map(|p| serde_json::json!({ "name": p.name, "common": p.common, "about": p.about }))
            .collect();
        writeln!(context.stdout, "{}", serde_json::to_string_pretty(&list).expect("plain data"))?;
        return Ok(());
    }
    for preset in listed {
        writeln!(context.stdout, "{:24} {:10} {}", preset.name, preset.common, preset.about)?;
    }
    Ok(())
}
