//! `venation generate`: leaves into folders.

mod difference;
mod job;
mod making;
mod notes;

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde::Serialize;
use venation::document::{Comments, Document, Value};
use venation::io;
use venation::io::batch::{self, Shard};
use venation::io::write::Overwrite;

use super::leaf_args::LeafArgs;
use super::output_args::OutputArgs;
use super::progress::{Counter, ProgressWord};
use super::run_args::RunArgs;
use super::{Context, Failure, numbers, seeds};
use job::Job;
use making::{Canvases, make};

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
  venation generate maple --format glb --card outline             one file for engines
  venation generate oak --profile unity-hdrp --mips -o oak        names and packing of Unity's HDRP
  venation generate oak --format svg,dxf --svg-style laser --maps none
  venation generate oak --seeds 1-1000 -o oaks --shard 3/16       one of sixteen machines
  venation generate out/leaf.toml -o again                        the same leaf, byte for byte

Settings: every key of `venation presets show beech` takes a value or a range; each leaf draws its own.
A folder holds NAME_BaseColor.png, _Opacity, _Normal (OpenGL), _Height (16 bit), _Roughness,
_AmbientOcclusion, _ORM, _Translucency, _Thickness, _VeinMask and _VeinOrder, the same of the underside
in back/, NAME.obj and NAME.mtl, leaf.toml and manifest.json. A batch has a manifest.jsonl, a shard
manifest.000I-of-000N.jsonl; `venation merge` makes one of them.")]
pub(crate) struct Args {
    #[command(flatten)]
    leaf: LeafArgs,
    /// Seed of one leaf [default: the file's, else 1].
    #[arg(long, value_name = "N", conflicts_with = "seeds", value_parser = numbers::seed)]
    seed: Option<u64>,
    /// Seeds of many leaves, as 1-3,5,7-20:2; each gets a folder DIR/NAME_s0003.
    #[arg(long, value_name = "LIST")]
    seeds: Option<String>,
    /// Make only the leaves of shard I of N; count from 0 or from 1.
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    shard: Option<Shard>,
    #[command(flatten)]
    output: OutputArgs,
    /// Other files to write: obj, glb, usda, svg, dxf, json, graphml, csv; all or none [default: the
    /// file's, else obj].
    #[arg(long, value_name = "LIST")]
    format: Option<String>,
    /// Folder to write into [default: the leaf's name].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
    /// What tells of progress: auto is a bar on stderr where a person is watching; openjd prints the lines
    /// that Open Job Description reads, on stdout.
    #[arg(long, value_name = "HOW", value_enum, default_value = "auto")]
    progress: ProgressWord,
    /// Go on where an earlier run stopped: leave leaves alone that are there with the same settings and all
    /// files asked for, make anew those that lack some; refuse folders of other leaves.
    #[arg(long, conflicts_with = "force")]
    skip_existing: bool,
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
    /// What is to be said of it.
    #[serde(skip)]
    note: Option<String>,
}

impl Made {
    /// A leaf of which nothing is known yet but what it is called.
    fn of(job: &Job, status: &'static str) -> Self {
        Self {
            seed: job.seed,
            name: job.spec.name.clone(),
            folder: shown(&job.folder),
            status,
            problem: None,
            files: Vec::new(),
            nodes: 0,
            unreached_sources: 0,
            note: None,
        }
    }
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    if args.run.json && args.progress == ProgressWord::Openjd {
        let problem =
            "--json: stdout would hold the lines of --progress openjd, too; give one of them";
        return Err(Failure::Input(problem.into()));
    }
    let mut document = args.leaf.document(context)?;
    args.output.apply(&mut document)?;
    if let Some(formats) = &args.format {
        document.insert("output.formats", Value::Text(formats.clone()), "--format");
    }
    let mut batch = Batch::new(args, &document)?;
    let overwrite = args.run.overwrite();
    // Nothing is grown before it is known that everything may be written.
    let go_on = |job: &mut Job| if args.skip_existing { job.go_on() } else { Ok(Some(overwrite)) };
    let plans: Vec<_> = batch.jobs.iter_mut().map(go_on).collect::<Result<_, _>>()?;
    let planned = batch.jobs.iter().zip(plans);
    let todo: Vec<(&Job, Overwrite)> =
        planned.filter_map(|(job, plan)| Some((job, plan?))).collect();
    for (job, overwrite) in &todo {
        let files = job.collisions();
        if *overwrite == Overwrite::Refuse && !files.is_empty() {
            let folder = job.folder.clone();
            let error = io::Error::WouldOverwrite { folder, files };
            let advice = match args.skip_existing {
                true => "no leaf.toml tells whose they are; --force overwrites",
                false => "--force overwrites, --skip-existing goes on",
            };
            return Err(Failure::Exists(format!("{error}; {advice}")));
        }
    }
    batch.check()?;
    let pool = pool(args.run.threads)?;
    notes::tell_sizes(context, &todo);
    if args.run.dry_run {
        return plan(args, context, &batch, &todo);
    }
    notes::tell_shortfalls(&document, context, &todo);
    notes::tell_unused(context, &todo);
    let counter = Counter::new(args.progress, context.quiet, todo.len());
    let bars = context.quiet || batch.jobs.len() != 1 || args.progress != ProgressWord::Auto;
    let canvases = Canvases::default();
    let results: Vec<Result<Made, Failure>> = pool.install(|| {
        let results = todo.par_iter().map(|(job, overwrite)| {
            let result = make(job, *overwrite, bars, &canvases).or_else(|failure| match failure {
                // Another process with the same orders was here first.
                Failure::Exists(_) if args.skip_existing && job.is_done() => {
                    Ok(Made::of(job, "skipped"))
                }
                failure => Err(failure),
            });
            counter.one_more();
            result
        });
        results.collect()
    });
    drop(counter);
    report(args, context, &batch, &todo, results)
}

/// The leaves of a run.
struct Batch {
    jobs: Vec<Job>,
    /// Where its manifest goes, if it has one.
    manifest: Option<PathBuf>,
    /// Of a shard, the hash of the run that it is a shard of.
    run_sha256: Option<String>,
}

impl Batch {
    fn new(args: &Args, document: &Document) -> Result<Self, Failure> {
        let seeds = seeds::chosen(args.seeds.as_deref(), args.seed, document.seed)?;
        let alone = args.seeds.is_none();
        let single = alone && args.shard.is_none();
        let run_sha256 =
            args.shard.map(|_| io::run_sha256(&document.to_toml(Comments::None), &seeds));
        let jobs: Vec<Job> = seeds
            .into_iter()
            .enumerate()
            .filter(|&(place, _)| args.shard.is_none_or(|shard| shard.holds(place)))
            .map(|(_, seed)| Job::new(document, seed, args.out.as_ref(), alone))
            .collect::<Result<_, _>>()?;
        let file = args.shard.map_or_else(|| batch::BATCH_FILE.to_owned(), Shard::file);
        let root = match (&args.out, jobs.first()) {
            (Some(root), _) => Some(root.clone()),
            (None, Some(job)) => Some(PathBuf::from(&job.spec.name)),
            // A shard without leaves and without a folder has nowhere to say so.
            (None, None) => None,
        };
        let manifest = root.filter(|_| !single).map(|root| root.join(file));
        Ok(Self { jobs, manifest, run_sha256 })
    }

    /// Refuses a manifest that a run could not add to.
    fn check(&self) -> Result<(), Failure> {
        if let Some(path) = &self.manifest {
            batch::others(path, &[])?;
        }
        Ok(())
    }

    /// Writes the batch's manifest: what is there now of every leaf.
    fn seal(&self, problems: &[(u64, String)]) -> Result<(), Failure> {
        let Some(path) = &self.manifest else { return Ok(()) };
        let problem = |seed: u64| {
            problems.iter().find(|(of, _)| *of == seed).map(|(_, problem)| problem.clone())
        };
        let mut lines: Vec<_> = self.jobs.iter().map(|job| job.line(problem(job.seed))).collect();
        lines.iter_mut().for_each(|line| line.run_sha256.clone_from(&self.run_sha256));
        lines.extend(batch::others(path, &lines)?);
        super::save(path, batch::to_jsonl(&lines).into_bytes())
    }
}

/// Says what a run would write and what it would leave alone.
fn plan(
    args: &Args,
    context: &mut Context<'_>,
    batch: &Batch,
    todo: &[(&Job, Overwrite)],
) -> Result<(), Failure> {
    let planned: Vec<Made> = todo
        .iter()
        .map(|(job, _)| Made { files: job.names(), ..Made::of(job, "planned") })
        .collect();
    tell(args, context, batch.manifest.as_deref(), &planned, batch.jobs.len() - todo.len())
}

pub(super) fn pool(threads: Option<usize>) -> Result<rayon::ThreadPool, Failure> {
    rayon::ThreadPoolBuilder::new()
        .num_threads(threads.unwrap_or(0))
        .build()
        .map_err(|error| Failure::Unexpected(format!("--threads: {error}")))
}

fn shown(path: &Path) -> String {
    path.display().to_string()
}

fn report(
    args: &Args,
    context: &mut Context<'_>,
    batch: &Batch,
    todo: &[(&Job, Overwrite)],
    results: Vec<Result<Made, Failure>>,
) -> Result<(), Failure> {
    let (all, skipped) = (todo.len(), batch.jobs.len() - todo.len());
    let mut list = Vec::new();
    let mut failures = Vec::new();
    let mut problems = Vec::new();
    for ((job, _), result) in todo.iter().zip(results) {
        match result {
            Ok(made) => list.push(made),
            Err(failure) => {
                let problem = failure.message().unwrap_or_default().to_owned();
                if batch.jobs.len() > 1 {
                    super::complain(&format!("seed {}: {problem}", job.seed));
                }
                problems.push((job.seed, problem.clone()));
                list.push(Made { problem: Some(problem), ..Made::of(job, "failed") });
                failures.push(failure);
            }
        }
    }
    // A shard of which every leaf failed is done, too: the others are not to wait for it.
    let sealed = batch.seal(&problems);
    let is_sealed = sealed.is_ok();
    if failures.is_empty() || failures.len() < all {
        sealed?;
    }
    let manifest = batch.manifest.as_deref().filter(|_| is_sealed);
    tell(args, context, manifest, &list, skipped)?;
    let notes: Vec<&String> = list.iter().filter_map(|made| made.note.as_ref()).collect();
    match &notes[..] {
        [] => {}
        [note] if all == 1 => context.say(note),
        [note, ..] => {
            context.say(&format!("in {} of {all} leaves, as the first: {note}", notes.len()));
        }
    }
    if skipped > 0 {
        context.say(&format!("{skipped} of {} leaves were there already", batch.jobs.len()));
    }
    match failures.len() {
        0 => Ok(()),
        1 if batch.jobs.len() == 1 => Err(failures.remove(0)),
        failed => Err(Failure::Partial(format!("{failed} of {all} leaves failed"))),
    }
}

/// The files made or planned, on stdout.
fn tell(
    args: &Args,
    context: &mut Context<'_>,
    manifest: Option<&Path>,
    list: &[Made],
    skipped: usize,
) -> Result<(), Failure> {
    let manifest = manifest.map(shown);
    if args.run.json {
        let version = env!("CARGO_PKG_VERSION");
        let document = serde_json::json!({
            "version": version, "skipped": skipped, "leaves": list, "manifest": manifest
        });
        let text = serde_json::to_string_pretty(&document).expect("plain data");
        writeln!(context.stdout, "{text}")?;
        return Ok(());
    }
    for made in list {
        for file in &made.files {
            writeln!(context.stdout, "{}", Path::new(&made.folder).join(file).display())?;
        }
    }
    if let Some(manifest) = manifest {
        writeln!(context.stdout, "{manifest}")?;
    }
    Ok(())
}
