//! `venation generate`: leaves into folders.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;
use venation::document::{Comments, Document, Value};
use venation::io::write::{Overwrite, collisions, write_files};
use venation::io::{self, FormatKind, LeafFiles, MapKind};
use venation::pipeline;
use venation::seed::Seed;
use venation::spec::LeafSpec;

use super::leaf_args::{self, LeafArgs};
use super::progress::Bar;
use super::{Context, Failure, seeds};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation generate beech
  venation generate beech --seed 7 --size 2048 -o out
  venation generate maple --season 0.55 --damage holes=0.1,spots=0.3 --maps preview -o autumn
  venation generate willow --seeds 1-3,5,7-20:2 -o willows        13 leaves, willows/salix-alba_s0001 …
  venation generate beech --outline scan.jpg --length-mm 72       a scanned leaf's outline
  venation generate beech --outline drawing.png --root 310,540    a drawing, petiole given in pixels
  venation generate linden --growth marginal --set colour.type=from-edges --set colour.spread_mm=4..8
  venation generate out/leaf.toml -o again                        the same leaf, byte for byte

Settings: every key of `venation presets show beech` takes a value or a range; each leaf draws its own.
A folder holds NAME_BaseColor.png, _Opacity, _Normal (OpenGL), _Height (16 bit), _Roughness,
_AmbientOcclusion, _ORM, _Translucency, _Thickness, _VeinMask and _VeinOrder, the same of the underside
in back/, NAME.obj and NAME.mtl, leaf.toml and manifest.json.")]
pub(crate) struct Args {
    #[command(flatten)]
    leaf: LeafArgs,
    /// Seed of one leaf [default: the file's, else 1].
    #[arg(long, value_name = "N", conflicts_with = "seeds")]
    seed: Option<u64>,
    /// Seeds of many leaves, as 1-3,5,7-20:2; each gets a folder DIR/NAME_s0003.
    #[arg(long, value_name = "LIST")]
    seeds: Option<String>,
    /// Maps to write: basecolor, opacity, normal, height, roughness, ambientocclusion (ao), orm,
    /// translucency, thickness, veinmask, veinorder; for people preview (lit) and enhancement; bump; all
    /// or none [default: the file's, else the first eleven].
    #[arg(long, value_name = "LIST")]
    maps: Option<String>,
    /// Other files to write: obj, svg, json, graphml, csv; all or none [default: the file's, else obj].
    #[arg(long, value_name = "LIST")]
    format: Option<String>,
    /// Folder to write into [default: the leaf's name].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Threads to use; the bytes are the same for any number [default: all processors].
    #[arg(short, long, value_name = "N")]
    threads: Option<usize>,
    /// Report on stdout as one JSON document.
    #[arg(long)]
    json: bool,
    /// Overwrite files of an earlier run.
    #[arg(long, conflicts_with = "skip_existing")]
    force: bool,
    /// Leave leaves alone that are there already with the same settings.
    #[arg(long)]
    skip_existing: bool,
}

/// One leaf to make.
struct Job {
    seed: u64,
    spec: LeafSpec,
    folder: PathBuf,
    /// The settings as they will stand in leaf.toml.
    toml: String,
    /// The maps to write.
    maps: Vec<MapKind>,
    /// The other files to write.
    formats: Vec<FormatKind>,
}

/// What became of a leaf.
#[derive(Debug, Serialize)]
struct Made {
    seed: u64,
    name: String,
    folder: String,
    status: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    problem: Option<String>,
    files: Vec<String>,
    nodes: usize,
    unreached_sources: usize,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let mut document = args.leaf.document(context)?;
    if let Some(maps) = &args.maps {
        document.insert("output.maps", Value::Text(maps.clone()), "--maps");
    }
    if let Some(formats) = &args.format {
        document.insert("output.formats", Value::Text(formats.clone()), "--format");
    }
    let jobs = jobs(args, &document)?;
    let overwrite = if args.force { Overwrite::Force } else { Overwrite::Refuse };
    // Nothing is grown before it is known that everything may be written.
    let todo: Vec<(&Job, Overwrite)> = if args.skip_existing {
        jobs.iter().filter(|job| !job.is_done()).map(|job| (job, job.resume())).collect()
    } else {
        jobs.iter().map(|job| (job, overwrite)).collect()
    };
    for (job, overwrite) in &todo {
        let names = io::file_names(&job.spec.name, &job.maps, &job.formats);
        let files = collisions(&job.folder, names.iter().map(String::as_str));
        if *overwrite == Overwrite::Refuse && !files.is_empty() {
            let folder = job.folder.clone();
            return Err(write_failure(&io::Error::WouldOverwrite { folder, files }));
        }
    }
    let pool = pool(args.threads)?;
    let single = jobs.len() == 1;
    let quiet = context.quiet;
    let results: Vec<Result<Made, Failure>> = pool.install(|| {
        todo.par_iter().map(|(job, overwrite)| make(job, *overwrite, quiet || !single)).collect()
    });
    report(args, context, &jobs, &todo, results)
}

fn jobs(args: &Args, document: &Document) -> Result<Vec<Job>, Failure> {
    let seeds = seeds::chosen(args.seeds.as_deref(), args.seed, document.seed)?;
    let single = seeds.len() == 1;
    let jobs = seeds.into_iter().map(|seed| {
        let spec = leaf_args::resolve(document, seed)?;
        let root = args.out.clone().unwrap_or_else(|| PathBuf::from(&spec.name));
        let folder = if single { root } else { root.join(format!("{}_s{seed:04}", spec.name)) };
        let toml = Document::of_spec(&spec, seed).to_toml(Comments::None);
        let maps = MapKind::list(&spec.output.maps).map_err(venation::error::Error::from)?;
        let all = FormatKind::ALL;
        let formats = words("output.formats", &spec.output.formats, all, FormatKind::word)?;
        Ok(Job { seed, spec, folder, toml, maps, formats })
    });
    jobs.collect()
}

impl Job {
    /// Whether an earlier run finished this very leaf (the manifest is written last) and every
    /// file that is wanted is there.
    fn is_done(&self) -> bool {
        let names = io::file_names(&self.spec.name, &self.maps, &self.formats);
        self.same_settings() && names.iter().all(|name| self.folder.join(name).is_file())
    }

    /// Whether the leaf there is this one, whatever was written of it.
    fn same_settings(&self) -> bool {
        let leaf = |text: &str| text.split("\n[output]").next().map(str::to_owned);
        std::fs::read_to_string(self.folder.join("leaf.toml"))
            .is_ok_and(|text| leaf(&text) == leaf(&self.toml))
    }

    /// A killed run of this very leaf may be completed over; other people's files may not.
    fn resume(&self) -> Overwrite {
        if self.same_settings() { Overwrite::Force } else { Overwrite::Refuse }
    }
}

fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    /// Threads beyond any machine's take minutes to start and make nothing faster.
    const MOST: usize = 1024;
    if threads == Some(0) {
        return Err(Failure::Input("--threads: 0 threads make no leaf; give 1 or more".into()));
    }
    if let Some(threads) = threads.filter(|&threads| threads > MOST) {
        return Err(Failure::Input(format!("--threads: {threads} is more than {MOST}")));
    }
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::Unexpected(format!("--threads: {error}")))
}

fn make(job: &Job, overwrite: Overwrite, quiet: bool) -> Result<Made, Failure> {
    let mut bar = Bar::new(quiet, "");
    let leaf = pipeline::generate(&job.spec, Seed(job.seed), &mut bar)?;
    let files = io::encode_leaf(&LeafFiles {
        name: &job.spec.name,
        title: &job.spec.title,
        seed: leaf.seed,
        margin: &leaf.grown.margin,
        venation: &leaf.grown.venation,
        textures: &leaf.textures,
        spec_toml: &job.toml,
        specularity: job.spec.relief.specularity,
        roughness: job.spec.relief.roughness,
        maps: &job.maps,
        formats: &job.formats,
    });
    write_files(&job.folder, &files, overwrite).map_err(|error| write_failure(&error))?;
    Ok(Made {
        seed: job.seed,
        name: job.spec.name.clone(),
        folder: shown(&job.folder),
        status: "made",
        problem: None,
        files: files.into_iter().map(|(name, _)| name).collect(),
        nodes: leaf.grown.venation.graph().len(),
        unreached_sources: leaf.grown.venation.unreached().total(),
    })
}

fn write_failure(error: &io::Error) -> Failure {
    match error {
        io::Error::WouldOverwrite { .. } => {
            Failure::Exists(format!("{error}; --force overwrites, --skip-existing goes on"))
        }
        _ => Failure::Input(error.to_string()),
    }
}

/// The items of a comma-separated list of words, `all` of them or `none`.
fn words<T: Copy>(
    key: &str,
    list: &str,
    all: &[T],
    word: fn(T) -> &'static str,
) -> Result<Vec<T>, Failure> {
    match list.trim() {
        "none" => return Ok(Vec::new()),
        "all" => return Ok(all.to_vec()),
        _ => {}
    }
    let find = |item: &str| {
        all.iter().copied().find(|&kind| word(kind) == item).ok_or_else(|| {
            let known: Vec<&str> = all.iter().map(|&kind| word(kind)).collect();
            Failure::Input(format!("{key}: `{item}` is none of {}", known.join(", ")))
        })
    };
    list.split(',').map(|item| find(item.trim())).collect()
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

fn report(
    args: &Args,
    context: &mut Context<'_>,
    jobs: &[Job],
    todo: &[(&Job, Overwrite)],
    results: Vec<Result<Made, Failure>>,
) -> Result<(), Failure> {
    let (all, skipped) = (todo.len(), jobs.len() - todo.len());
    let mut list = Vec::new();
    let mut failures = Vec::new();
    for ((job, _), result) in todo.iter().zip(results) {
        match result {
            Ok(made) => list.push(made),
            Err(failure) => {
                let problem = failure.message().unwrap_or_default().to_owned();
                if jobs.len() > 1 {
                    super::complain(&format!("seed {}: {problem}", job.seed));
                }
                list.push(Made {
                    seed: job.seed,
                    name: job.spec.name.clone(),
                    folder: shown(&job.folder),
                    status: "failed",
                    problem: Some(problem),
                    files: Vec::new(),
                    nodes: 0,
                    unreached_sources: 0,
                });
                failures.push(failure);
            }
        }
    }
    if args.json {
        let version = env!("CARGO_PKG_VERSION");
        let document =
            serde_json::json!({ "version": version, "skipped": skipped, "leaves": list });
        let text = serde_json::to_string_pretty(&document).expect("plain data");
        writeln!(context.stdout, "{text}")?;
    } else {
        for made in &list {
            for file in &made.files {
                writeln!(context.stdout, "{}", Path::new(&made.folder).join(file).display())?;
            }
        }
    }
    if skipped > 0 {
        context.say(&format!("{skipped} of {} leaves were there already", jobs.len()));
    }
    match failures.len() {
        0 => Ok(()),
        1 if jobs.len() == 1 => Err(failures.remove(0)),
        failed => Err(Failure::Partial(format!("{failed} of {all} leaves failed"))),
    }
}
