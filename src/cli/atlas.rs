//! `venation atlas`: many leaves on one set of maps.

use std::path::PathBuf;

use rayon::prelude::*;
use venation::document::{Comments, Document};
use venation::geometry::packing;
use venation::io::atlas::{AtlasFiles, AtlasLeaf, atlas_file_names, encode_atlas};
use venation::io::write::{Overwrite, collisions, write_files};
use venation::io::{self};
use venation::margin;
use venation::observer::Silent;
use venation::pipeline::{self, Grown};
use venation::seed::Seed;
use venation::spec::{LeafSpec, Output};
use venation::texture::atlas::{AtlasSheet, PixelRect, covered};
use venation::texture::map::Outside;

use super::generate::pool;
use super::leaf_args::{self, LeafArgs};
use super::output_args::OutputArgs;
use super::progress::{Counter, ProgressWord};
use super::run_args::RunArgs;
use super::{Context, Failure, numbers, seeds};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation atlas oak --seeds 1-16 --size 4096 -o oaks
  venation atlas willow --seeds 1-24 --profile unreal --mips -o willows
  venation atlas maple --seeds 1-9 --maps basecolor,normal --padding 32 --dry-run

All leaves have the same texels to the millimetre, so large ones stay larger. atlas.json has for each its
rectangle and margin (with v from the bottom and from the top), the end of its petiole as pivot, its size
in mm and its seed; leaves/ has its settings, from which `venation generate` makes it alone. The ground
between the leaves is filled from the nearest one. The back is the mirrored sheet: u becomes 1 - u.

Leaves whose outlines fill more than the sheet are refused before any is grown, by --dry-run, too; whether
others find room shows when they are packed, grown and measured.")]
pub(crate) struct Args {
    #[command(flatten)]
    leaf: LeafArgs,
    /// Seeds of the leaves, as 1-3,5,7-20:2.
    #[arg(long, value_name = "LIST", default_value = "1-16")]
    seeds: String,
    #[command(flatten)]
    output: OutputArgs,
    /// Pixels that stay free between leaves [default: a 256th of the side].
    #[arg(long, value_name = "PX", value_parser = numbers::whole::<usize, 0, { u64::MAX }>)]
    padding: Option<usize>,
    /// Folder to write into [default: the leaf's name and _atlas].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
}

/// Side of the sheet unless another is asked for (pixels).
const SIZE_PX: u64 = 4096;

/// Leaves are measured on pictures of this side (pixels).
const MEASURED_PX: u64 = 256;

/// A leaf that is grown and measured.
struct Ready {
    seed: u64,
    spec: LeafSpec,
    toml: String,
    grown: Grown,
    /// Side of its square picture, and width and height of what is covered of it, a texel of the
    /// measuring picture added all round (mm).
    side_mm: f64,
    box_mm: [f64; 2],
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let mut document = args.leaf.document(context)?;
    args.output.apply(&mut document)?;
    if args.leaf.size.is_none() && !args.leaf.sets("texture.size_px") {
        document.set(&format!("texture.size_px={SIZE_PX}"), "atlas")?;
    }
    let seeds = seeds::chosen(Some(&args.seeds), None, None)?;
    let first = leaf_args::resolve(&document, seeds[0])?;
    let size = first.texture.size_px as usize;
    let padding = args.padding.unwrap_or(size / 256);
    let mut output = first.output.resolve().map_err(venation::error::Error::from)?;
    // What is for people is no map of the sheet.
    output.maps.retain(|map| map.outside() != Outside::Paper);
    output.formats.clear();
    let folder = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}_atlas", first.name)));
    let names = atlas_file_names(&first.name, size, &seeds, &output);
    let overwrite = args.run.overwrite();
    let files = collisions(&folder, names.iter().map(String::as_str));
    if overwrite == Overwrite::Refuse && !files.is_empty() {
        return Err(io::Error::WouldOverwrite { folder, files }.into());
    }
    // Nothing is grown that could not fit: a leaf takes no less than this.
    if padding >= size {
        return Err(no_room(seeds.len(), size, padding));
    }
    let least = (LEAST_SIDE_PX + padding) * (LEAST_WIDTH_PX + padding);
    if seeds.len().saturating_mul(least) > (size + padding).pow(2) {
        return Err(no_room(seeds.len(), size, padding));
    }
    let pool = pool(args.run.threads)?;
    if pool.install(|| is_crowded(&document, &seeds, size, padding))? {
        return Err(no_room(seeds.len(), size, padding));
    }
    let mut packed = None;
    if !args.run.dry_run {
        let files = pool.install(|| {
            let counter = Counter::new(ProgressWord::Auto, context.quiet, 2 * seeds.len());
            let ready: Vec<Ready> = seeds
                .par_iter()
                .map(|&seed| {
                    let ready = grow(&document, seed);
                    counter.one_more();
                    ready
                })
                .collect::<Result<_, _>>()?;
            let sheet = lay_out(&ready, size, padding)?;
            packed = Some(sheet.packed(&ready, size));
            paint(ready, &sheet, (size, padding), &first, &output, &counter)
        })?;
        write_files(&folder, &files, overwrite)?;
    }
    let listed: Vec<String> =
        names.iter().map(|name| folder.join(name).display().to_string()).collect();
    if args.run.json {
        let status = if args.run.dry_run { "planned" } else { "made" };
        let report = serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "status": status,
            "folder": folder.display().to_string(),
            "seeds": seeds,
            "files": names,
        });
        let text = serde_json::to_string_pretty(&report).expect("plain data");
        writeln!(context.stdout, "{text}")?;
    } else {
        for file in listed {
            writeln!(context.stdout, "{file}")?;
        }
    }
    if let Some(packed) = packed {
        let share = 100.0 * packed;
        context.say(&format!("{} leaves fill {share:.0} % of the sheet", seeds.len()));
    }
    Ok(())
}

/// Grows a leaf and measures it on a small picture.
fn grow(document: &Document, seed: u64) -> Result<Ready, Failure> {
    let spec = leaf_args::resolve(document, seed)?;
    let toml = Document::of_spec(&spec, seed).to_toml(Comments::None);
    let grown = pipeline::grow(&spec, Seed(seed), &mut Silent)?;
    let mut small = spec.clone();
    small.texture.size_px = MEASURED_PX;
    small.output.maps = "basecolor".into();
    small.output.formats = "none".into();
    small.output.bits = 8;
    let textures = pipeline::paint(&small, &grown, Seed(seed), &mut Silent)?;
    let side_mm = textures.frame.side_mm;
    let texel = side_mm / MEASURED_PX as f64;
    let rect = covered(&textures.front.base_colour)
        .ok_or_else(|| Failure::Unexpected(format!("seed {seed}: nothing is painted")))?;
    let box_mm = [rect.width, rect.height].map(|pixels| (pixels + 2) as f64 * texel);
    Ok(Ready { seed, spec, toml, grown, side_mm, box_mm })
}

/// How leaves lie on a sheet.
struct LayOut {
    per_mm: f64,
    places: Vec<(usize, usize)>,
}

impl LayOut {
    fn boxes(ready: &[Ready], per_mm: f64) -> Vec<(usize, usize)> {
        let pixels = |mm: f64| (mm * per_mm).ceil() as usize;
        ready.iter().map(|leaf| (pixels(leaf.box_mm[0]), pixels(leaf.box_mm[1]))).collect()
    }

    fn packed(&self, ready: &[Ready], size: usize) -> f64 {
        let filled: usize = Self::boxes(ready, self.per_mm).iter().map(|(w, h)| w * h).sum();
        filled as f64 / (size * size) as f64
    }
}

/// From one scale tried to the next, and how many: down to a fiftieth of the largest.
const SCALE_STEP: f64 = 0.99;
const SCALES_TRIED: i32 = 400;

/// The most texels to the millimetre with which all leaves still fit.
fn lay_out(ready: &[Ready], size: usize, padding: usize) -> Result<LayOut, Failure> {
    let try_at = |per_mm: f64| {
        let places = packing::into_square(&LayOut::boxes(ready, per_mm), size, padding)?;
        Some(LayOut { per_mm, places })
    };
    // No leaf may be larger than the sheet, nor painted larger than pictures can be, nor all together
    // larger than the sheet.
    let longest = ready.iter().flat_map(|leaf| leaf.box_mm).fold(0.0, f64::max);
    let widest = ready.iter().map(|leaf| leaf.side_mm).fold(0.0, f64::max);
    let area: f64 = ready.iter().map(|leaf| leaf.box_mm[0] * leaf.box_mm[1]).sum();
    let most = (size as f64 / longest).min(16_384.0 / widest).min(size as f64 / area.sqrt());
    // From above, since a scale may fit where a smaller one does not.
    let best = (0..SCALES_TRIED).find_map(|i| try_at(most * SCALE_STEP.powi(i)));
    let smallest = ready.iter().map(|leaf| leaf.side_mm).fold(f64::INFINITY, f64::min);
    best.filter(|found| found.per_mm * smallest >= LEAST_PAINTED_PX)
        .ok_or_else(|| no_room(ready.len(), size, padding))
}

/// A leaf's own picture has 16 texels at least.
const LEAST_PAINTED_PX: f64 = 17.0;

/// What is covered of a leaf's own picture of 16 texels or more, at the least: nearly its side, and more than
/// a line.
const LEAST_SIDE_PX: usize = 8;
const LEAST_WIDTH_PX: usize = 2;

/// Whether the outlines alone, at the least scale that leaves can be painted at, would fill more than the
/// sheet: known without growing anything.
fn is_crowded(
    document: &Document,
    seeds: &[u64],
    size: usize,
    padding: usize,
) -> Result<bool, Failure> {
    let measured = |&seed: &u64| -> Result<([f64; 2], f64), Failure> {
        let spec = leaf_args::resolve(document, seed)?;
        let margin =
            margin::build(&spec.margin, Seed(seed)).map_err(venation::error::Error::from)?;
        let outline = margin.bounds().size();
        // How far the stalk reaches is not known yet, but the most that it can.
        let stalk = spec.petiole.length_mm + 2.0 * spec.petiole.width_mm;
        let most = 1.1 * outline.max_element() + stalk;
        // What has fallen off a leaf takes no room.
        let taken = if spec.damage.is_none() { outline.to_array() } else { [0.0; 2] };
        Ok((taken, most / (1.0 - 2.0 * spec.texture.gutter)))
    };
    let leaves: Vec<_> = seeds.par_iter().map(measured).collect::<Result<_, _>>()?;
    let smallest = leaves.iter().map(|(_, side_mm)| *side_mm).fold(f64::INFINITY, f64::min);
    let pixels = |mm: f64| mm * LEAST_PAINTED_PX / smallest + padding as f64;
    let area: f64 =
        leaves.iter().map(|([width, height], _)| pixels(*width) * pixels(*height)).sum();
    Ok(area > ((size - padding) as f64).powi(2))
}

fn no_room(leaves: usize, size: usize, padding: usize) -> Failure {
    Failure::Input(format!(
        "{leaves} leaves do not fit on {size} pixels with {padding} between them; give a larger --size, a \
         smaller --padding or fewer --seeds"
    ))
}

/// Paints every leaf, lays it on the sheet, and gives the files.
fn paint(
    ready: Vec<Ready>,
    sheet: &LayOut,
    (size, padding): (usize, usize),
    first: &LeafSpec,
    output: &Output,
    counter: &Counter,
) -> Result<Vec<(String, Vec<u8>)>, Failure> {
    let mut atlas = AtlasSheet::new(size, output.planes());
    let mut leaves = Vec::new();
    let boxes = LayOut::boxes(&ready, sheet.per_mm);
    for ((leaf, &(x, y)), (width, height)) in ready.into_iter().zip(&sheet.places).zip(boxes) {
        let painted_px = (leaf.side_mm * sheet.per_mm) as usize;
        let mut spec = leaf.spec;
        spec.texture.size_px = painted_px as u64;
        spec.output.formats = "none".into();
        let textures = pipeline::paint(&spec, &leaf.grown, Seed(leaf.seed), &mut Silent)?;
        let whole = PixelRect { x: 0, y: 0, width: 1, height: 1 };
        let mut from = covered(&textures.front.base_colour).unwrap_or(whole);
        // What was measured has a texel to spare; a leaf may still not leave its box.
        (from.width, from.height) = (from.width.min(width), from.height.min(height));
        atlas.lay(&textures, from, (x, y));
        leaves.push(AtlasLeaf {
            seed: leaf.seed,
            margin: leaf.grown.margin,
            petiole_end: textures.petiole_end,
            spec_toml: leaf.toml,
            frame: textures.frame,
            painted_px,
            from,
            rect: PixelRect { x, y, ..from },
        });
        counter.one_more();
    }
    let textures = atlas.finish(sheet.per_mm);
    Ok(encode_atlas(&AtlasFiles {
        name: &first.name,
        title: &first.title,
        textures: &textures,
        leaves: &leaves,
        padding_px: padding,
        output,
    }))
}
