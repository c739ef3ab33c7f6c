//! `venation compare`: growth types, scatter patterns, vein algorithms or what orders veins, side by
//! side, labelled, with their measures.

mod cases;
mod measures;
mod season;
mod trails;

use std::io::Write as _;
use std::path::PathBuf;

use rayon::prelude::*;
use serde_json::{Value, json};
use venation::document::Document;
use venation::io;
use venation::margin::shapes;
use venation::observer::Silent;
use venation::pipeline::{self, Grown};
use venation::raster::montage::{self, Layout, Panel};
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::texture::map::MapKind;
use venation::veins::metrics::VeinMetrics;
use venation::veins::metrics::hierarchy::Hierarchy;

use super::leaf_args::{self, LeafArgs};
use super::{Context, Failure, numbers, seeds};
use cases::{By, Case};
use trails::Seen;

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation compare beech -o growth.png
  venation compare lilac --by scatter -o scatter.png         particles, as Rodkaew 2002, figure 9
  venation compare beech --by shape -o shapes.png            every shape of a unilobed blade
  venation compare beech --outline scan.jpg --seed 3 -o growth.png --csv growth.csv
  venation compare oak --by seed --seeds 1-20 -o oaks.png    a contact sheet
  venation compare beech --by emergence -o emergence.png     straight, symmetric, ordered: one by one
  venation compare linden --seeds 1-20 --csv growth.csv      measures over 20 seeds, no picture
  venation compare maple --by season -o year.png             spring to litter: front, back, against the light
  venation compare maple --by season --frames 60 -o film.png an animated PNG; a folder of pictures without .png

--by growth grows open venation without guided veins, which would look alike under every growth type;
--set veins.guides.primary=pinnate and --set veins.algorithm=auxin-closed keep them.

Measures: nodes; tips (free vein ends); sinuosity (path over chord of the primary and secondary veins,
1 is straight; of the midrib alone; of its side veins); secondaries by side and how their distances
vary (deviation over mean); tip_step (share of the steps after which a vein is within 5 % of the apex).")]
pub(crate) struct Args {
    #[command(flatten)]
    leaf: LeafArgs,
    /// What differs from panel to panel.
    #[arg(long, value_enum, default_value = "growth")]
    by: By,
    /// Seed of the leaf shown [default: the file's, else 1].
    #[arg(long, value_name = "N", conflicts_with = "seeds", value_parser = numbers::seed)]
    seed: Option<u64>,
    /// Seeds to measure; the picture shows the first, --by seed all of them [default with it: 1-12].
    #[arg(long, value_name = "LIST")]
    seeds: Option<String>,
    /// The picture to write (PNG).
    #[arg(short, long, value_name = "FILE.png", required_unless_present_any = ["csv", "json"])]
    out: Option<PathBuf>,
    /// The measures of every leaf as CSV.
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// Report files and measures on stdout as one JSON document.
    #[arg(long, conflicts_with = "dry_run")]
    json: bool,
    /// Only list the files that would be written.
    #[arg(short = 'n', long)]
    dry_run: bool,
    /// `--by season`: so many pictures of the season from 0 to 1, instead of a sheet; an animated PNG
    /// where `-o` ends in .png, else a folder of pictures.
    #[arg(long, value_name = "N", requires = "out", value_parser = clap::value_parser!(u32).range(2..=10_000))]
    frames: Option<u32>,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

impl Args {
    /// Refuses a picture under the ending of another kind, and a folder of them under that of any.
    fn check(&self) -> Result<(), Failure> {
        let Some(out) = &self.out else { return Ok(()) };
        match self.frames {
            None => super::png_only("-o", out),
            Some(_) if season::is_animation(out) => Ok(()),
            Some(_) if super::is_picture(out) => super::png_only("-o", out),
            Some(_) => Ok(()),
        }
    }

    /// The sheet and its table.
    fn written(&self) -> impl Iterator<Item = &PathBuf> {
        self.out.iter().chain(&self.csv)
    }
}

/// One leaf of the comparison.
struct Cell {
    case: Case,
    seed: u64,
    metrics: VeinMetrics,
    hierarchy: Option<Hierarchy>,
    panel: Option<Panel>,
    /// Its veins as lines, for a second row.
    lines: Option<Panel>,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    args.check()?;
    let mut document = args.leaf.document(context)?;
    // Laid veins and closed nets look alike under every growth: leave the whole pattern to it, as in
    // the papers, unless told otherwise.
    if args.by == By::Growth {
        for (key, value) in [("veins.guides.primary", "none"), ("veins.algorithm", "auxin-open")] {
            if !args.leaf.sets(key) {
                document.set(&format!("{key}={value}"), "--by growth")?;
            }
        }
    }
    let seeds = match (&args.seeds, args.seed) {
        (None, None) if args.by == By::Seed => seeds::chosen(Some(SHEET_SEEDS), None, None)?,
        (list, one) => seeds::chosen(list.as_deref(), one, document.seed)?,
    };
    if args.by == By::Season {
        if seeds.len() > 1 {
            let problem = "--seeds: --by season shows one leaf; give one seed";
            return Err(Failure::Input(problem.into()));
        }
        return through_the_year(args, &document, seeds[0], context);
    }
    if args.frames.is_some() {
        return Err(Failure::Input("--frames: only --by season makes a film".into()));
    }
    refuse(args)?;
    if args.dry_run {
        return list(args, context);
    }
    let cases = args.by.cases();
    let shown = |seed: u64| args.out.is_some() && (args.by == By::Seed || seed == seeds[0]);
    let work: Vec<(Case, u64)> =
        seeds.iter().flat_map(|&seed| cases.iter().map(move |&case| (case, seed))).collect();
    let mut cells: Vec<Cell> = work
        .par_iter()
        .map(|&(case, seed)| cell(&document, case, seed, shown(seed)))
        .collect::<Result<_, Failure>>()?;
    if let Some(path) = &args.out {
        let name = leaf_args::resolve(&document, seeds[0])?.name;
        let title = match args.by {
            By::Seed => format!("{name}: {} seeds", seeds.len()),
            by => format!("{name}: {}, seed {}", by.title(), seeds[0]),
        };
        super::save(path, sheet(&title, args.by, &mut cells)?)?;
    }
    if let Some(path) = &args.csv {
        super::save(path, measures::table(args.by, &cells).into_bytes())?;
    }
    report(args, &measures::records(&cells), context)?;
    if !context.quiet && !args.json {
        let _ = write!(std::io::stderr(), "{}", measures::summary(args.by, &cells));
    }
    Ok(())
}

/// Refuses to write where it may not.
fn refuse(args: &Args) -> Result<(), Failure> {
    super::spare_inputs(args.written(), &args.leaf.inputs())?;
    super::refuse_existing(args.written(), args.force)
}

/// The files that were written, and as JSON what was measured, too.
fn report(args: &Args, leaves: &[Value], context: &mut Context<'_>) -> Result<(), Failure> {
    if !args.json {
        return list(args, context);
    }
    let files: Vec<String> = args.written().map(|path| path.display().to_string()).collect();
    let document = json!({
        "version": env!("CARGO_PKG_VERSION"),
        "by": args.by.word(),
        "files": files,
        "leaves": leaves,
    });
    Ok(writeln!(context.stdout, "{document:#}")?)
}

/// The files that a sheet and its table would be.
fn list(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    for path in args.written() {
        writeln!(context.stdout, "{}", path.display())?;
    }
    Ok(())
}

fn through_the_year(
    args: &Args,
    document: &Document,
    seed: u64,
    context: &mut Context<'_>,
) -> Result<(), Failure> {
    if let (Some(frames), Some(out)) = (args.frames, &args.out) {
        for (given, flag) in [(args.json, "--json"), (args.csv.is_some(), "--csv")] {
            if given {
                return Err(Failure::Input(format!("{flag}: a film has no measures")));
            }
        }
        let year = season::Year::new(document, seed)?;
        return year.film(frames as usize, out, (args.force, args.dry_run), context);
    }
    refuse(args)?;
    if args.dry_run {
        return list(args, context);
    }
    let (sheet, states) = season::Year::new(document, seed)?.sheet()?;
    if let Some(path) = &args.out {
        super::save(path, sheet)?;
    }
    if let Some(path) = &args.csv {
        super::save(path, season::table(&states).into_bytes())?;
    }
    report(args, &states.iter().map(season::State::record).collect::<Vec<_>>(), context)
}

/// The seeds of a contact sheet unless others are asked for.
const SHEET_SEEDS: &str = "1-12";

/// Panels are no larger than this (pixels), nor those of lines than [`LINES_PX`].
const PANEL_PX: usize = 720;
const LINES_PX: usize = 420;

fn cell(document: &Document, case: Case, seed: u64, shown: bool) -> Result<Cell, Failure> {
    let mut spec = leaf_args::resolve(document, seed)?;
    spec.output.maps = MapKind::BaseColour.word().into();
    case.apply(&mut spec)?;
    let grown = pipeline::grow(&spec, Seed(seed), &mut Silent)?;
    let metrics = VeinMetrics::of(&grown.venation, &grown.margin);
    let hierarchy = Hierarchy::of(&grown.venation, &grown.margin);
    let mut cell = Cell { case, seed, metrics, hierarchy, panel: None, lines: None };
    if shown {
        let panel = panel(&cell, &spec, &grown)?;
        if matches!(case, Case::Growth(_) | Case::Algorithm(_) | Case::Emergence(_)) {
            let picture = trails::picture(&grown, panel.picture.width().min(PANEL_PX), Seen::Below);
            cell.lines = Some(Panel { picture, label: String::new(), notes: Vec::new() });
        }
        cell.panel = Some(panel);
    }
    Ok(cell)
}

fn panel(cell: &Cell, spec: &LeafSpec, grown: &Grown) -> Result<Panel, Failure> {
    let Cell { case, seed, metrics, .. } = cell;
    let (case, seed) = (*case, *seed);
    let nodes = format!("{} nodes, {} tips", metrics.nodes, metrics.tips);
    let label = case.label();
    if let Case::Scatter(..) = case {
        let side = (spec.texture.size_px as usize).min(LINES_PX);
        let notes = vec![format!("{} particles", grown.venation.sources())];
        return Ok(Panel { picture: trails::picture(grown, side, Seen::Above), label, notes });
    }
    let textures = pipeline::paint(spec, grown, Seed(seed), &mut Silent)?;
    if case == Case::Seed {
        let notes = vec![format!("{:.0} mm", grown.margin.length_mm()), nodes];
        let label = format!("seed {seed}");
        return Ok(Panel { picture: textures.front.base_colour, label, notes });
    }
    if let Case::Shape(index) = case {
        let shape = shapes::all().swap_remove(index);
        let kind = shape.kind.to_string();
        let notes = if kind == shape.name { Vec::new() } else { vec![kind] };
        return Ok(Panel { picture: textures.front.base_colour, label, notes });
    }
    // Veins show best from below.
    let picture = textures.back.base_colour;
    if let Case::Emergence(_) = case {
        let Some(found) = cell.hierarchy else {
            return Err(Failure::Unexpected("no midrib to measure".into()));
        };
        let [right, left] = found.secondaries;
        let notes = vec![
            format!("midrib {:.3}", found.midrib_sinuosity),
            format!("{left} left, {right} right"),
            format!("spacing varies by {:.2}", found.spacing_variation),
        ];
        return Ok(Panel { picture, label, notes });
    }
    let notes = vec![nodes, format!("sinuosity {:.3}", metrics.sinuosity)];
    Ok(Panel { picture, label, notes })
}

fn sheet(title: &str, by: By, cells: &mut [Cell]) -> Result<Vec<u8>, Failure> {
    let mut panels: Vec<Panel> = cells.iter_mut().filter_map(|cell| cell.panel.take()).collect();
    panels.extend(cells.iter_mut().filter_map(|cell| cell.lines.take()));
    let Some(first) = panels.first() else {
        return Err(Failure::Unexpected("nothing to show".into()));
    };
    let panel_px = first.picture.width().min(PANEL_PX);
    let picture = montage::sheet(title, &panels, Layout { columns: by.columns(), panel_px });
    Ok(io::image::colour_png(&picture, &io::image::Caption::default()))
}
