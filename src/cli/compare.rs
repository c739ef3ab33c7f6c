//! `venation compare`: growth types side by side, labelled, with their measures.

use std::path::PathBuf;

use rayon::prelude::*;
use venation::document::Document;
use venation::growth::GrowthType;
use venation::io;
use venation::observer::Silent;
use venation::pipeline::{self, Leaf};
use venation::raster::montage::{self, Layout, Panel};
use venation::seed::Seed;
use venation::veins::metrics::VeinMetrics;

use super::leaf_args::{self, LeafArgs};
use super::{Context, Failure, seeds};

/// What differs from panel to panel.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum By {
    /// The four growth types.
    Growth,
}

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation compare beech -o growth.png
  venation compare beech --outline scan.jpg --seed 3 -o growth.png --csv growth.csv
  venation compare linden --seeds 1-20 --csv growth.csv      measures over 20 seeds, no picture

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
    growth: GrowthType,
    seed: u64,
    metrics: VeinMetrics,
    leaf: Option<Leaf>,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let By::Growth = args.by;
    let document = args.leaf.document(context)?;
    let seeds = match (&args.seeds, args.seed) {
        (Some(list), _) => {
            seeds::parse(list).map_err(|problem| Failure::Input(format!("--seeds: {problem}")))?
        }
        (None, Some(seed)) => vec![seed],
        (None, None) => vec![document.seed.unwrap_or(1)],
    };
    super::refuse_existing(args.out.iter().chain(&args.csv), args.force)?;
    let work: Vec<(GrowthType, u64)> =
        seeds.iter().flat_map(|&seed| GrowthType::ALL.iter().map(move |&g| (g, seed))).collect();
    let cells: Vec<Cell> = work
        .par_iter()
        .map(|&(growth, seed)| {
            cell(&document, growth, seed, args.out.is_some() && seed == seeds[0])
        })
        .collect::<Result<_, Failure>>()?;
    if let Some(path) = &args.out {
        let png = sheet(&cells)?;
        super::save(path, png)?;
        writeln!(context.stdout, "{}", path.display())?;
    }
    if let Some(path) = &args.csv {
        super::save(path, table(&cells).into_bytes())?;
        writeln!(context.stdout, "{}", path.display())?;
    }
    if !context.quiet {
        eprint!("{}", summary(&cells));
    }
    Ok(())
}

fn cell(
    document: &Document,
    growth: GrowthType,
    seed: u64,
    painted: bool,
) -> Result<Cell, Failure> {
    let mut document = document.clone();
    document.set(&format!("growth.type={growth}"), "--by growth")?;
    let spec = leaf_args::resolve(&document, seed)?;
    let grown = pipeline::grow(&spec, Seed(seed), &mut Silent)?;
    let metrics = VeinMetrics::of(&grown.venation, &grown.margin);
    let leaf = painted
        .then(|| {
            let textures = pipeline::paint(&spec, &grown, Seed(seed), &mut Silent)?;
            Ok::<_, Failure>(Leaf { spec, seed: Seed(seed), grown, textures })
        })
        .transpose()?;
    Ok(Cell { growth, seed, metrics, leaf })
}

fn sheet(cells: &[Cell]) -> Result<Vec<u8>, Failure> {
    let shown = cells.iter().filter_map(|cell| Some((cell, cell.leaf.as_ref()?)));
    let panels: Vec<Panel> = shown
        .map(|(cell, leaf)| Panel {
            picture: leaf.textures.front.base_colour.clone(),
            label: cell.growth.to_string(),
            notes: vec![
                format!("{} nodes, {} tips", cell.metrics.nodes, cell.metrics.tips),
                format!("sinuosity {:.3}", cell.metrics.sinuosity),
            ],
        })
        .collect();
    let Some(first) = cells.iter().find_map(|cell| cell.leaf.as_ref()) else {
        return Err(Failure::Unexpected("nothing to show".into()));
    };
    let title = format!("{}: growth types, seed {}", first.spec.name, first.seed.0);
    let panel_px = first.textures.front.base_colour.width().min(720);
    let picture = montage::sheet(&title, &panels, Layout { columns: panels.len(), panel_px });
    Ok(io::image::colour_png(&picture, &io::image::Caption::default()))
}

fn table(cells: &[Cell]) -> String {
    let mut text = String::from(
        "growth,seed,nodes,tips,sinuosity,vein_length_mm,tip_step,unreached_sources\n",
    );
    for cell in cells {
        let m = &cell.metrics;
        text += &format!(
            "{},{},{},{},{:.5},{:.2},{:.4},{}\n",
            cell.growth,
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
fn summary(cells: &[Cell]) -> String {
    let mut text = format!(
        "{:12} {:>7} {:>7} {:>9} {:>9}\n",
        "growth", "nodes", "tips", "sinuosity", "tip step"
    );
    for &growth in GrowthType::ALL {
        let these: Vec<&Cell> = cells.iter().filter(|cell| cell.growth == growth).collect();
        let mean = |value: fn(&VeinMetrics) -> f64| {
            these.iter().map(|cell| value(&cell.metrics)).sum::<f64>() / these.len() as f64
        };
        text += &format!(
            "{growth:12} {:>7.0} {:>7.0} {:>9.4} {:>8.0}%\n",
            mean(|m| m.nodes as f64),
            mean(|m| m.tips as f64),
            mean(|m| m.sinuosity),
            mean(|m| 100.0 * m.apex_reached_at)
        );
    }
    text
}
