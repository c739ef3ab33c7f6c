//! `venation bench`: how long veins take to grow.

mod floor;
mod memory;
mod table;

use std::io::Write;
use std::path::{Path, PathBuf};

use rayon::ThreadPool;
use serde::Serialize;
use venation::benchmark::{self, BenchmarkError, Measure, Workload};
use venation::margin::{self, Margin};
use venation::parallel;
use venation::presets;
use venation::seed::Seed;
use venation::veins::Algorithm;

use super::{Failure, numbers};
use table::Line;

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
    /// Whom sources call: `standard` within four mean spacings (or what the workload says), `unlimited`
    /// at any distance, as in the paper of 2005.
    #[arg(long, value_name = "RANGE", default_value = "standard", conflicts_with = "suite")]
    attraction: Attraction,
    /// Threads to grow on; what grows is the same.
    #[arg(long, short = 't', value_name = "N", default_value_t = 1, value_parser = numbers::threads)]
    threads: usize,
    /// Also time a program on the same sources: called as PATH FOLDER N RUNS, it reads the sources
    /// from FOLDER/auxin_N.csv, in lengths of the blade, and prints a line of JSON with `cpu` for each
    /// run.
    #[arg(long, value_name = "PATH", conflicts_with = "suite")]
    floor: Option<PathBuf>,
    /// Runs of each; the median time counts.
    #[arg(long, value_name = "N", default_value_t = 3,
          value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,
    /// Seed of the darts on the standard leaf.
    #[arg(long, default_value_t = 42, value_parser = numbers::seed)]
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

/// How far sources attract.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Attraction {
    Standard,
    Unlimited,
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
    /// The floor cannot be timed.
    #[error("--floor {0}")]
    Floor(String),
    /// A run failed.
    #[error(transparent)]
    Run(#[from] BenchmarkError),
}

/// Everything that was measured.
#[derive(Debug, Serialize)]
struct Results {
    runs: u32,
    threads: usize,
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
        if self.attraction == Attraction::Unlimited {
            workload.veins.attraction_distance_mm = 0.0;
        }
        workload
    }

    /// Runs a workload, and the floor beside it.
    fn measured(
        &self,
        pool: &ThreadPool,
        name: String,
        workload: &Workload,
    ) -> Result<Line, Failure> {
        let mut line = self.timed(pool, name, || benchmark::run(workload)).map_err(Error::Run)?;
        if let Some(program) = &self.floor {
            let seconds = floor::seconds(program, workload, self.runs).map_err(Error::Floor)?;
            line.floor_seconds = Some(seconds);
        }
        Ok(line)
    }

    /// The run of median time, with the memory of the first.
    fn timed(
        &self,
        pool: &ThreadPool,
        name: String,
        run: impl Fn() -> Result<Measure, BenchmarkError> + Sync,
    ) -> Result<Line, BenchmarkError> {
        memory::forget_peak();
        let before = memory::now();
        let awake = || pool.install(|| parallel::awake(&run));
        let first = awake()?;
        // Later runs reuse what this one gave back.
        let bytes = memory::peak().zip(before).map(|(peak, before)| peak.saturating_sub(before));
        let bytes_per_node = bytes.map(|bytes| bytes as f64 / first.nodes as f64);
        let mut measures = vec![first];
        for _ in 1..self.runs {
            measures.push(awake()?);
        }
        measures.sort_by(|a, b| a.cpu_seconds.total_cmp(&b.cpu_seconds));
        let measure = measures.swap_remove(measures.len() / 2);
        let ns_per_source_step = measure.cpu_seconds * 1e9 / measure.source_steps.max(1) as f64;
        let (printed_seconds, floor_seconds) = (None, None);
        Ok(Line {
            name,
            printed_seconds,
            floor_seconds,
            bytes_per_node,
            ns_per_source_step,
            measure,
        })
    }
}

/// Runs the benchmark and prints its table to `out`.
pub(crate) fn run(args: &Args, out: &mut dyn Write) -> Result<(), Failure> {
    let pool = super::generate::pool(Some(args.threads))?;
    super::refuse_existing(args.json.iter().chain(&args.csv), args.force)?;
    let threads = args.threads;
    let mut results = Results { runs: args.runs, threads, lines: Vec::new(), exponent: None };
    let mut add = |out: &mut dyn Write, line: Line| -> Result<(), Failure> {
        table::print(out, &line)?;
        results.lines.push(line);
        Ok(())
    };
    table::head(out)?;
    if let Some(Suite::Foster) = args.suite {
        let blade = beech()?;
        for row in benchmark::foster_suite() {
            let name = format!("{} {}", row.table, row.value);
            let run = || benchmark::run_foster(&row, &blade);
            let mut line = args.timed(&pool, name, run).map_err(Error::Run)?;
            line.printed_seconds = Some(row.printed_seconds);
            add(out, line)?;
        }
    } else if !args.workload.is_empty() {
        for path in &args.workload {
            let workload = args.grown_as(read(path)?);
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            add(out, args.measured(&pool, name, &workload)?)?;
        }
    } else {
        for &count in &args.auxins {
            let workload = benchmark::standard_workload(count as usize, Seed(args.seed));
            let workload = args.grown_as(workload);
            add(out, args.measured(&pool, "standard".into(), &workload)?)?;
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
        super::save(path, table::csv(&results.lines).into_bytes())?;
    }
    Ok(())
}

/// The blade of the suite: the report's own is not printed, so the beech preset's stands in.
fn beech() -> Result<Margin, Failure> {
    let preset = presets::find("beech").expect("beech comes with venation");
    let spec = preset.document()?.resolve(Seed(1))?;
    Ok(margin::build(&spec.margin, Seed(1)).map_err(venation::error::Error::from)?)
}

fn read(path: &Path) -> Result<Workload, Error> {
    let text = |path: &Path| {
        std::fs::read_to_string(path)
            .map_err(|source| Error::File { path: path.to_path_buf(), source })
    };
    let named = |source| Error::Workload { path: path.to_path_buf(), source };
    Workload::parse(&text(path)?, &text(&path.with_extension("csv"))?).map_err(named)
}
