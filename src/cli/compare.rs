//! `venation compare`: growth types, scatter patterns or vein algorithms side by side, labelled, with
//! their measures.

mod cases;
mod trails;

use std::path::PathBuf;

use rayon::prelude::*;
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

use super::leaf_args::{self, LeafArgs};
use super::{Context, Failure, seeds};
use cases::{By, Case};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation compare beech -o growth.png
  venation compare lilac --by scatter -o scatter.png         particles, as Rodkaew 2002, figure 9
  venation compare beech --by shape -o shapes.png            every shape of a unilobed blade
  venation compare beech --outline scan.jpg --seed 3 -o growth.png --csv growth.csv
  venation compare linden --seeds 1-20 --csv growth.csv      measures over 20 seeds, no picture

--by growth grows open venation without guided veins, which would look alike under every growth type;
--set veins.guides.primary=pinnate and --set veins.algorithm=auxin-closed keep them.

Measures: nodes; tips (free vein ends); sinuosity (path over chord of the primary and secondary veins,
1 is straight); tip_step (share of the steps after which a vein is within 5 % of the apex).")]
pub(crate) struct Args {
    #[command(flatten)]
    leaf: LeafArgs,
    /// What differs from panel to panel.
    #[arg(long, value_enum, default_value = "growth")]
    by: By,
    /// Seed of the leaf shown [default: the file's, else 1].
    #[arg(long, value_name = "N", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Seeds to measure; the picture shows the first.
    #[arg(long, value_name = "LIST")]
    seeds: Option<String>,
    /// The picture to write (PNG).
    #[arg(short, long, value_name = "FILE.png", required_unless_present = "csv")]
    out: Option<PathBuf>,
    /// The measures of every leaf as CSV.
    #[arg(long, value_name = "FILE.csv")]
    csv: Option<PathBuf>,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

/// One leaf of the comparison.
struct Cell {
    case: Case,
    seed: u64,
    metrics: VeinMetrics,
    panel: Option<Panel>,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
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
    let seeds = seeds::chosen(args.seeds.as_deref(), args.seed, document.seed)?;
    super::refuse_existing(args.out.iter().chain(&args.csv), args.force)?;
    let cases = args.by.cases();
    let work: Vec<(Case, u64)> =
        seeds.iter().flat_map(|&seed| cases.iter().map(move |&case| (case, seed))).collect();
    let mut cells: Vec<Cell> = work
        .par_iter()
        .map(|&(case, seed)| cell(&document, case, seed, args.out.is_some() && seed == seeds[0]))
        .collect::<Result<_, Failure>>()?;
    if let Some(path) = &args.out {
        let name = leaf_args::resolve(&document, seeds[0])?.name;
        let title = format!("{name}: {}, seed {}", args.by.title(), seeds[0]);
        super::save(path, sheet(&title, args.by, &mut cells)?)?;
        writeln!(context.stdout, "{}", path.display())?;
    }
    if let Some(path) = &args.csv {
        super::save(path, table(args.by, &cells).into_bytes())?;
        writeln!(context.stdout, "{}", path.display())?;
    }
    if !context.quiet {
        eprint!("{}", summary(args.by, &cells));
    }
    Ok(())
}

/// Panels are no larger than this (pixels), nor those of lines than [`LINES_PX`].
const PANEL_PX: usize = 720;
const LINES_PX: usize = 420;

fn cell(document: &Document, case: Case, seed: u64, shown: bool) -> Result<Cell, Failure> {
    let mut spec = leaf_args::resolve(document, seed)?;
    spec.output.maps = MapKind::BaseColour.word().into();
    case.apply(&mut spec)?;
    let grown = pipeline::grow(&spec, Seed(seed), &mut Silent)?;
    let metrics = VeinMetrics::of(&grown.venation, &grown.margin);
    let panel = shown.then(|| panel(case, &spec, &grown, &metrics, seed)).transpose()?;
    Ok(Cell { case, seed, metrics, panel })
}

fn panel(
    case: Case,
    spec: &LeafSpec,
    grown: &Grown,
    metrics: &VeinMetrics,
    seed: u64,
) -> Result<Panel, Failure> {
    let nodes = format!("{} nodes, {} tips", metrics.nodes, metrics.tips);
    let label = case.label();
    if let Case::Scatter(..) = case {
        let side = (spec.texture.size_px as usize).min(LINES_PX);
        let notes = vec![format!("{} particles", grown.venation.sources())];
        return Ok(Panel { picture: trails::picture(grown, side), label, notes });
    }
    if let Case::Shape(index) = case {
        let shape = shapes::all().swap_remove(index);
        let kind = shape.kind.to_string();
        let notes = if kind == shape.name { Vec::new() } else { vec![kind] };
        let textures = pipeline::paint(spec, grown, Seed(seed), &mut Silent)?;
        return Ok(Panel { picture: textures.front.base_colour, label, notes });
    }
    let textures = pipeline::paint(spec, grown, Seed(seed), &mut Silent)?;
    let notes = vec![nodes, format!("sinuosity {:.3}", metrics.sinuosity)];
    Ok(Panel { picture: textures.front.base_colour, label, notes })
}

fn sheet(title: &str, by: By, cells: &mut [Cell]) -> Result<Vec<u8>, Failure> {
    let panels: Vec<Panel> = cells.iter_mut().filter_map(|cell| cell.panel.take()).collect();
    let Some(first) = panels.first() else {
        return Err(Failure::Unexpected("nothing to show".into()));
    };
    let panel_px = first.picture.width().min(PANEL_PX);
    let picture = montage::sheet(title, &panels, Layout { columns: by.columns(), panel_px });
    Ok(io::image::colour_png(&picture, &io::image::Caption::default()))
}

fn table(by: By, cells: &[Cell]) -> String {
    let mut text = format!(
        "{},seed,nodes,tips,sinuosity,vein_length_mm,tip_step,unreached_sources\n",
        by.word()
    );
    for cell in cells {
        let m = &cell.metrics;
        text += &format!(
            "{},{},{},{},{:.5},{:.2},{:.4},{}\n",
            cell.case.label(),
            cell.seed,
            m.nodes,
            m.tips,
            m.sinuosity,
            m.length_mm,
            m.apex_reached_at,
            m.unreached_sources
        );
    }
    text
}

/// Means over the seeds, for the person.
fn summary(by: By, cells: &[Cell]) -> String {
    let width = by.cases().iter().map(|case| case.label().len() + 1).fold(12, usize::max);
    let mut text = format!(
        "{:width$} {:>7} {:>7} {:>9} {:>9}\n",
        by.word(),
        "nodes",
        "tips",
        "sinuosity",
        "tip step"
    );
    for case in by.cases() {
        let these: Vec<&Cell> = cells.iter().filter(|cell| cell.case == case).collect();
        let mean = |value: fn(&VeinMetrics) -> f64| {
            these.iter().map(|cell| value(&cell.metrics)).sum::<f64>() / these.len() as f64
        };
        text += &format!(
            "{:width$} {:>7.0} {:>7.0} {:>9.4} {:>8.0}%\n",
            case.label(),
            mean(|m| m.nodes as f64),
            mean(|m| m.tips as f64),
            mean(|m| m.sinuosity),
            mean(|m| 100.0 * m.apex_reached_at)
        );
    }
    text
}
