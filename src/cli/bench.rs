//! `venation bench`: how long veins take to grow.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde::Serialize;
use venation::benchmark::{self, BenchmarkError, Measure, Workload};
use venation::margin::{self, Margin};
use venation::presets;
use venation::seed::Seed;
use venation::veins::Algorithm;

use super::Failure;

/// Time the growth of veins on a standard leaf, a workload of your own or the tables of Foster's
/// report.
#[derive(Debug, clap::Args)]
pub(crate) struct Args {
    /// Auxin counts to run on the standard leaf, separated by commas.
    #[arg(long, value_name = "N,N,…", value_delimiter = ',',
          value_parser = clap::value_parser!(u32).range(1..=10_000_000),
          default_values_t = [1000, 2000, 4000, 8000, 16_000, 32_000, 64_000],
          conflicts_with_all = ["workload", "suite"])]
    auxins: Vec<u32>,
    /// Run a workload from FILE.json; its sources (lines `x,y`) are in FILE.csv beside it. Given
    /// several times, the exponent is fitted over them.
    #[arg(long, value_name = "FILE.json", conflicts_with = "suite")]
    workload: Vec<PathBuf>,
    /// Run a suite: `foster`, every row of the five tables of the report.
    #[arg(long)]
    suite: Option<Suite>,
    /// Grow closed venation (veins meet and form loops) on the standard leaf or the workload.
    #[arg(long, conflicts_with = "suite")]
    closed: bool,
    /// Runs of each; the median time counts.
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Seed of the darts on the standard leaf.
    #[arg(long, default_value_t = 42)]
    seed: u64,
    /// Also write the measures to FILE as JSON.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Also write the measures to FILE as CSV.
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

/// A set of runs with a name.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
enum Suite {
    /// Foster's five performance tables.
    Foster,
}

/// Why there is no benchmark.
#[derive(Debug, thiserror::Error)]
pub(crate) enum Error {
    /// A file cannot be read or written.
    #[error("{}: {source}", path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A workload makes no sense.
    #[error("{}: {source}", path.display())]
    Workload {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: BenchmarkError,
    },
    /// A run failed.
    #[error(transparent)]
    Run(#[from] BenchmarkError),
}

/// One line of the results.
#[derive(Debug, Serialize)]
struct Line {
    /// What was run.
    name: String,
    /// What the report prints (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    printed_seconds: Option<f64>,
    #[serde(flatten)]
    measure: Measure,
}

/// Everything that was measured.
#[derive(Debug, Serialize)]
struct Results {
    runs: u32,
    lines: Vec<Line>,
    /// Exponent of time against auxin count, where counts were varied.
    #[serde(skip_serializing_if = "Option::is_none")]
    exponent: Option<f64>,
}

impl Args {
    /// A workload with the venation asked for.
    fn grown_as(&self, mut workload: Workload) -> Workload {
        if self.closed {
            workload.veins.algorithm = Algorithm::AuxinClosed;
        }
        workload
    }
}

/// Runs the benchmark and prints its table to `out`.
pub(crate) fn run(args: &Args, out: &mut dyn Write) -> Result<(), Failure> {
    super::refuse_existing(args.json.iter().chain(&args.csv), args.force)?;
    let mut results = Results { runs: args.runs, lines: Vec::new(), exponent: None };
    let mut add = |out: &mut dyn Write, line: Line| -> Result<(), Failure> {
        print(out, &line)?;
        results.lines.push(line);
        Ok(())
    };
    let head = ["", "auxins", "nodes", "joins", "steps", "CPU s", "wall s"];
    writeln!(out, "{}  not reached", columns(head.map(String::from)))?;
    if let Some(Suite::Foster) = args.suite {
        let blade = beech()?;
        for row in benchmark::foster_suite() {
            let measure =
                median(args.runs, || benchmark::run_foster(&row, &blade)).map_err(Error::Run)?;
            let name = format!("{} {}", row.table, row.value);
            add(out, Line { name, printed_seconds: Some(row.printed_seconds), measure })?;
        }
    } else if !args.workload.is_empty() {
        for path in &args.workload {
            let workload = args.grown_as(read(path)?);
            let named = |source| Error::Workload { path: path.clone(), source };
            let measure = median(args.runs, || benchmark::run(&workload)).map_err(named)?;
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            add(out, Line { name, printed_seconds: None, measure })?;
        }
    } else {
        for &count in &args.auxins {
            let workload = benchmark::standard_workload(count as usize, Seed(args.seed));
            let workload = args.grown_as(workload);
            let measure = median(args.runs, || benchmark::run(&workload)).map_err(Error::Run)?;
            add(out, Line { name: "standard".into(), printed_seconds: None, measure })?;
        }
    }
    if args.suite.is_none() {
        let measures: Vec<Measure> = results.lines.iter().map(|l| l.measure.clone()).collect();
        results.exponent = benchmark::exponent(&measures);
    }
    if let Some(exponent) = results.exponent {
        writeln!(out, "fitted exponent of time against auxins: {exponent:.2}")?;
    }
    if let Some(path) = &args.json {
        let text = serde_json::to_string_pretty(&results).expect("numbers and words") + "\n";
        super::save(path, text.into_bytes())?;
    }
    if let Some(path) = &args.csv {
        super::save(path, csv(&results.lines).into_bytes())?;
    }
    Ok(())
}

/// The blade of the suite: the report's own is not printed, so the beech preset's stands in.
fn beech() -> Result<Margin, Failure> {
    let preset = presets::find("beech").expect("beech comes with venation");
    let spec = preset.document()?.resolve(Seed(1))?;
    Ok(margin::build(&spec.margin, Seed(1)).map_err(venation::error::Error::from)?)
}

/// The run of median time.
fn median(
    runs: u32,
    mut run: impl FnMut() -> Result<Measure, BenchmarkError>,
) -> Result<Measure, BenchmarkError> {
    let mut measures = (0..runs).map(|_| run()).collect::<Result<Vec<_>, _>>()?;
    measures.sort_by(|a, b| a.cpu_seconds.total_cmp(&b.cpu_seconds));
    Ok(measures.swap_remove(measures.len() / 2))
}

fn columns(cells: [String; 7]) -> String {
    let [name, sources, nodes, joins, steps, cpu, wall] = cells;
    format!("{name:<28}{sources:>8}{nodes:>9}{joins:>8}{steps:>7}{cpu:>10}{wall:>10}")
}

fn print(out: &mut dyn Write, line: &Line) -> std::io::Result<()> {
    let m = &line.measure;
    let cells = [
        line.name.clone(),
        m.sources.to_string(),
        m.nodes.to_string(),
        m.joins.to_string(),
        m.steps.to_string(),
        format!("{:.4}", m.cpu_seconds),
        format!("{:.4}", m.seconds),
    ];
    let report = match line.printed_seconds {
        Some(seconds) if seconds >= benchmark::FOSTER_GAVE_UP => {
            format!("  (report: more than {seconds} s)")
        }
        Some(seconds) => format!("  (report: {seconds} s)"),
        None => String::new(),
    };
    writeln!(out, "{}  {}{report}", columns(cells), m.unreached)
}

fn csv(lines: &[Line]) -> String {
    let mut text = String::from(
        "name,printed_seconds,auxins,nodes,joins,steps,cpu_seconds,seconds,outside,too_young,out_of_reach,hidden,unfinished\n",
    );
    for Line { name, printed_seconds, measure: m } in lines {
        let printed = printed_seconds.map_or(String::new(), |seconds| seconds.to_string());
        let left = &m.unreached;
        text += &format!(
            "{name},{printed},{},{},{},{},{},{},{},{},{},{},{}\n",
            m.sources,
            m.nodes,
            m.joins,
            m.steps,
            m.cpu_seconds,
            m.seconds,
            left.outside,
            left.too_young,
            left.out_of_reach,
            left.hidden,
            left.unfinished
        );
    }
    text
}

fn read(path: &Path) -> Result<Workload, Error> {
    let text = |path: &Path| {
        std::fs::read_to_string(path)
            .map_err(|source| Error::File { path: path.to_path_buf(), source })
    };
    let named = |source| Error::Workload { path: path.to_path_buf(), source };
    Workload::parse(&text(path)?, &text(&path.with_extension("csv"))?).map_err(named)
}
