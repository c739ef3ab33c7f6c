//! `venation completions` and `venation man`: what shells and readers of manuals want.

use clap::{CommandFactory, Parser};

use super::{Context, Failure};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation completions bash > /etc/bash_completion.d/venation
  venation completions zsh > ~/.zfunc/_venation
  venation completions fish > ~/.config/fish/completions/venation.fish")]
pub(crate) struct CompletionArgs {
    /// The shell.
    shell: clap_complete::Shell,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation man | man -l -
  venation man generate > venation-generate.1")]
pub(crate) struct ManArgs {
    /// The page of this command instead of the program's.
    command: Option<String>,
}

pub(crate) fn completions<P: Parser>(
    args: &CompletionArgs,
    context: &mut Context<'_>,
) -> Result<(), Failure> {
    // clap_complete panics when it cannot write, so it writes to memory.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut P::command(), "venation", &mut script);
    context.stdout.write_all(&script)?;
    Ok(())
}

pub(crate) fn man<P: CommandFactory>(
    args: &ManArgs,
    context: &mut Context<'_>,
) -> Result<(), Failure> {
    let mut program = P::command();
    program.build();
    let command = match &args.command {
        None => program,
        Some(name) => {
            let known = || {
                let names: Vec<&str> =
                    program.get_subcommands().map(clap::Command::get_name).collect();
                Failure::Input(format!("`{name}` is no command; it is one of {}", names.join(", ")))
            };
            let found = program.get_subcommands().find(|command| command.get_name() == name);
            let command = found.ok_or_else(known)?.clone();
            command.display_name(format!("venation-{name}"))
        }
    };
    let mut page = Vec::new();
    clap_mangen::Man::new(command).render(&mut page)?;
    context.stdout.write_all(&page)?;
    Ok(())
}
