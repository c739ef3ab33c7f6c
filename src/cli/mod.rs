//! The program: commands over the library's public interface.
//!
//! stdout is data, stderr is messages. Exit codes: 0 done, 1 unexpected, 2 bad arguments or input,
//! 3 would overwrite, 4 some items of a batch failed.

mod atlas;
mod bench;
mod compare;
mod failure;
mod fit;
mod generate;
mod inspect;
mod leaf_args;
mod merge;
mod morph;
mod numbers;
mod output_args;
mod presets;
mod progress;
mod run_args;
mod seeds;
mod shell;

use std::ffi::OsString;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::error::ErrorKind;
use clap::{Parser, Subcommand};
pub(crate) use failure::Failure;
use venation::io::write::{Overwrite, collisions, write_files};

/// Where a command writes, and how much it says.
pub(crate) struct Context<'a> {
    /// Data.
    pub(crate) stdout: &'a mut dyn Write,
    /// Whether messages and bars are wanted.
    pub(crate) quiet: bool,
}

impl Context<'_> {
    /// A message for the person, on stderr.
    pub(crate) fn say(&self, message: &str) {
        if !self.quiet {
            complain(message);
        }
    }
}

/// A message on stderr. It may quote file names and files: line breaks and terminal codes in them
/// are escaped.
pub(crate) fn complain(message: &str) {
    let mut line = String::with_capacity(message.len());
    for c in message.chars() {
        if c.is_control() { line.extend(c.escape_default()) } else { line.push(c) }
    }
    // Where nobody can be told, the work goes on.
    let _ = writeln!(std::io::stderr(), "venation: {line}");
}

const LONG_ABOUT: &str = "\
Grows leaves instead of painting them: a margin bounds a simulation of auxin and veins, Murray's law \
gives the veins their widths, pigments colour the blade, and out come textures for both sides, a \
card, vector outlines and the vein graph.

Same settings and seed, same bytes, on any number of threads.";

const EXAMPLES: &str = "\
Examples:
  venation generate beech                               textures of a beech leaf in ./fagus-sylvatica
  venation generate beech --outline scan.jpg -o out     grown in the outline of a scanned leaf
  venation generate linden --seeds 1-50 -o lindens      fifty different leaves
  venation atlas oak --seeds 1-16 --size 4096 -o oaks   one set of maps for engines
  venation compare beech -o growth.png                  growth types side by side
  venation fit scan.jpg -o leaf.toml                    a real leaf as parameters that vary
  venation inspect out                                  its veins measured beside real leaves
  venation bench --auxins 1000,2000,4000,8000           time against the number of sources
  venation presets show beech > my.toml                 every setting, to edit and generate from

Exit codes: 0 done, 1 unexpected, 2 bad arguments or input, 3 would overwrite, 4 part of a batch failed.";

#[derive(Debug, Parser)]
#[command(name = "venation", version, about = "Grows leaves: textures, vein graphs and cards.")]
#[command(long_about = LONG_ABOUT, after_help = EXAMPLES, max_term_width = 100)]
struct Cli {
    /// Say nothing but errors.
    #[arg(short, long, global = true)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Make leaves: textures, a card, outlines and graphs.
    Generate(Box<generate::Args>),
    /// Lay many leaves on one set of maps.
    Atlas(Box<atlas::Args>),
    /// Growth types, scatter patterns or vein algorithms side by side, as one labelled picture.
    Compare(Box<compare::Args>),
    /// Find the parameters of real leaves.
    Fit(Box<fit::Args>),
    /// One leaf turning into another: frames, a strip and an animation.
    Morph(Box<morph::Args>),
    /// Measure a vein pattern, grown or real, beside real leaves; or the leaves on a scan.
    Inspect(inspect::Args),
    /// Time the growth of veins against the number of auxin sources.
    Bench(bench::Args),
    /// List the leaves that come with venation, or show one as complete TOML.
    Presets(presets::Args),
    /// Put the manifests of the shards of a batch together.
    Merge(merge::Args),
    /// Print the JSON Schema of leaf files, for editors.
    Schema,
    /// Print a completion script for a shell.
    Completions(shell::CompletionArgs),
    /// Print the manual page.
    Man(shell::ManArgs),
}

/// Runs the program on the process's arguments.
pub(crate) fn run() -> Result<(), Failure> {
    let cli = match Cli::try_parse_from(numbers::joined(std::env::args_os())) {
        Ok(cli) => cli,
        // clap does not say which.
        Err(error) if error.kind() == ErrorKind::InvalidUtf8 => {
            return Err(Failure::Input(unreadable(std::env::args_os())));
        }
        Err(error) => {
            // Help and version are data; mistakes are one line and code 2.
            if !error.use_stderr() {
                write!(std::io::stdout(), "{error}")?;
                return Ok(());
            }
            return Err(Failure::Input(one_line(&error.to_string())));
        }
    };
    // Not locked: batches tell of their progress from other threads.
    let mut stdout = std::io::stdout();
    let mut context = Context { stdout: &mut stdout, quiet: cli.quiet };
    match &cli.command {
        Command::Generate(args) => generate::run(args, &mut context),
        Command::Atlas(args) => atlas::run(args, &mut context),
        Command::Compare(args) => compare::run(args, &mut context),
        Command::Fit(args) => fit::run(args, &mut context),
        Command::Morph(args) => morph::run(args, &mut context),
        Command::Inspect(args) => inspect::run(args, &mut context),
        Command::Bench(args) => bench::run(args, context.stdout),
        Command::Presets(args) => presets::run(args, &mut context),
        Command::Merge(args) => merge::run(args, &mut context),
        Command::Schema => {
            let schema = serde_json::to_string_pretty(&venation::document::schema());
            writeln!(context.stdout, "{}", schema.expect("plain data"))?;
            Ok(())
        }
        Command::Completions(args) => shell::completions::<Cli>(args, &mut context),
        Command::Man(args) => shell::man::<Cli>(args, &mut context),
    }
}

/// Refuses when a file that would be written is there already, unless forced, and when two that would be
/// written are one.
fn refuse_existing<'a>(
    paths: impl IntoIterator<Item = &'a PathBuf>,
    force: bool,
) -> Result<(), Failure> {
    let paths: Vec<_> = paths.into_iter().collect();
    // Files are written by their names as text: another one would be made.
    let unnamed = |path: &&&PathBuf| path.file_name().is_some_and(|name| name.to_str().is_none());
    if let Some(path) = paths.iter().find(unnamed) {
        let problem = format!("{}: the name is not UTF-8 text; give another", path.display());
        return Err(Failure::Input(problem));
    }
    let twice = paths.iter().enumerate().find(|(i, path)| paths[..*i].contains(path));
    if let Some((_, path)) = twice {
        let problem = format!("{}: two outputs cannot be one file; name another", path.display());
        return Err(Failure::Input(problem));
    }
    match paths.into_iter().find(|path| !force && is_there(path)) {
        Some(path) => {
            let problem = format!("{}: exists already; --force overwrites", path.display());
            Err(Failure::Exists(problem))
        }
        None => Ok(()),
    }
}

/// Refuses, forced or not, to write over what is read.
fn spare_inputs<'a>(
    outputs: impl IntoIterator<Item = &'a PathBuf>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let real = |path: &Path| std::fs::canonicalize(path).ok();
    let read: Vec<PathBuf> = inputs.iter().filter_map(|path| real(path)).collect();
    let mut outputs = outputs.into_iter();
    match outputs.find(|path| real(path).is_some_and(|path| read.contains(&path))) {
        Some(path) => {
            let problem = format!("{}: is read; write to another file", path.display());
            Err(Failure::Input(problem))
        }
        None => Ok(()),
    }
}

/// Refuses to write a PNG under the ending of another kind of file.
fn png_only(flag: &str, path: &Path) -> Result<(), Failure> {
    match path.extension() {
        Some(ending) if !ending.eq_ignore_ascii_case("png") => {
            let (named, png) = (path.display(), path.with_extension("png"));
            let problem = format!("{flag}: {named}: a PNG is written; call it {}", png.display());
            Err(Failure::Input(problem))
        }
        _ => Ok(()),
    }
}

/// Whether a name ends like that of a picture or a film.
fn is_picture(path: &Path) -> bool {
    const ENDINGS: [&str; 17] = [
        "png", "apng", "jpg", "jpeg", "gif", "webp", "avif", "bmp", "tif", "tiff", "tga", "exr",
        "svg", "pdf", "mp4", "mov", "webm",
    ];
    let ending = path.extension();
    ending.is_some_and(|ending| ENDINGS.iter().any(|known| ending.eq_ignore_ascii_case(known)))
}

/// Whether something is at a path, be it a link to nowhere.
fn is_there(path: &Path) -> bool {
    let (folder, name) = parted(path);
    !collisions(folder, [name.as_str()]).is_empty()
}

/// Writes one file, whole or not at all; it is known that it may be written.
fn save(path: &Path, bytes: Vec<u8>) -> Result<(), Failure> {
    let (folder, name) = parted(path);
    Ok(write_files(folder, &[(name, bytes)], Overwrite::Force)?)
}

/// The folder of a path and the name in it.
fn parted(path: &Path) -> (&Path, String) {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    (path.parent().unwrap_or(Path::new("")), name)
}

/// Which arguments are no text where only text will do.
fn unreadable(arguments: impl Iterator<Item = OsString>) -> String {
    let wrong = arguments.filter(|argument| argument.to_str().is_none());
    let wrong: Vec<String> = wrong.map(|text| format!("`{}`", text.to_string_lossy())).collect();
    format!(
        "{}: not UTF-8 text; give a name that is (folders and pictures may have any)",
        wrong.join(", ")
    )
}

/// clap's message in one line: what is wrong and its tip, without usage.
fn one_line(message: &str) -> String {
    let said = message.split("\nUsage:").next().unwrap_or(message);
    let said = said.split("\nFor more information").next().unwrap_or(said);
    let lines: Vec<&str> = said.lines().map(str::trim).filter(|line| !line.is_empty()).collect();
    lines.join("; ").trim_start_matches("error: ").replace(":; ", ": ")
}
