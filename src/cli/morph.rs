//! `venation morph`: one leaf turning into another, frame by frame.

use std::path::{Path, PathBuf};

use glam::DVec2;
use rayon::prelude::*;
use venation::document::{Comments, Document};
use venation::error::Error;
use venation::io::write::{Overwrite, collisions, write_files};
use venation::io::{self, animation, graph::VeinDocument, image, svg};
use venation::margin::morph::{MorphPath, Station};
use venation::margin::{LandmarkKind, Margin};
use venation::observer::{Observer, Progress, Silent};
use venation::pipeline;
use venation::raster::Grid;
use venation::raster::draw::{Canvas, Rgba};
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::units::TextureFrame;
use venation::veins::guides::carry::CarriedGuides;

use super::leaf_args::{self, read_document};
use super::progress::Bar;
use super::{Context, Failure, numbers};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation morph beech birch --frames 24 -o morph
  venation morph willow lilac --via poplar.toml:2 --frames 60 -o morph
  venation morph bud/leaf.toml beech --veins --frames 60 --size 512 -o growth

A folder holds frame_0001/leaf.svg, leaf.png and leaf.toml (from which `generate` makes that leaf) for
every frame, strip.png with all of them, and animation.png (APNG). All frames have one scale, so that a
growing leaf grows. A reference of weight 0 counts for nothing; the larger its weight, the nearer the
path comes to it.

With --veins the guides of both ends are laid and matched: on the way veins move from where one leaf has \
them to where the other has. All frames have as many: those that one end has not are there as buds of a \
few steps. Two leaves of one type of primary veins have as many as TO. With --own-veins (and at the end \
of a fan) both ends are as `generate` makes them, without buds.")]
pub(crate) struct Args {
    /// The first leaf: a preset or a TOML file.
    #[arg(value_name = "FROM")]
    from: String,
    /// The last leaf: a preset or a TOML file.
    #[arg(value_name = "TO")]
    to: String,
    /// A leaf that draws the path towards itself, and how strongly; may be given several times, in
    /// order.
    #[arg(long, value_name = "LEAF:WEIGHT")]
    via: Vec<String>,
    /// How many frames, both ends included.
    #[arg(long, value_name = "N", default_value = "24", value_parser = numbers::whole::<usize, 2, MOST_FRAMES>)]
    frames: usize,
    /// Grow the veins of every frame and paint it.
    #[arg(long)]
    veins: bool,
    /// The same, each end with as many veins as it has by itself.
    #[arg(long)]
    own_veins: bool,
    /// Seed of all frames [default: FROM's, else 1].
    #[arg(long, value_name = "N", value_parser = numbers::seed)]
    seed: Option<u64>,
    /// Side of the square pictures, in pixels: 16 to 4096.
    #[arg(long, value_name = "PX", default_value = "512", value_parser = numbers::whole::<u64, 16, LARGEST_PX>)]
    size: u64,
    /// Frames a second of the animation.
    #[arg(long, value_name = "N", default_value = "24", value_parser = numbers::whole::<u16, 1, 65_535>)]
    fps: u16,
    /// Set any key of all leaves, as in `generate`.
    #[arg(long, value_name = "key=value", allow_hyphen_values = true)]
    set: Vec<String>,
    /// Folder to write into [default: FROM-TO].
    #[arg(short, long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Report on stdout as one JSON document.
    #[arg(long)]
    json: bool,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

/// Frames beyond this fit in no memory and no film.
const MOST_FRAMES: u64 = 10_000;

/// The largest frame (pixels): all of an animation are held at once.
const LARGEST_PX: u64 = 4096;

/// Free space around the leaves, as a share of the picture.
const GUTTER: f64 = 0.03;

/// The strip shows at most so many frames, evenly chosen, so wide each (pixels).
const STRIP_FRAMES: usize = 24;
const STRIP_PX: usize = 160;

/// One frame, made.
struct Frame {
    spec: LeafSpec,
    margin: Margin,
    /// The picture of a painted leaf with the square it shows, and the vein graph.
    painted: Option<(Grid<Rgba>, TextureFrame, venation::veins::Venation)>,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    let (leaves, weights, seed) = leaves(args)?;
    let out = args.out.clone().unwrap_or_else(|| {
        PathBuf::from(format!("{}-{}", leaves[0].name, leaves[leaves.len() - 1].name))
    });
    let names = names(args);
    let taken = collisions(&out, names.iter().map(String::as_str));
    if !args.force && !taken.is_empty() {
        return Err(io::Error::WouldOverwrite { folder: out, files: taken }.into());
    }

    let stations: Vec<Station> = leaves
        .iter()
        .zip(&weights)
        .map(|(leaf, &weight)| Station { margin: leaf.margin.clone(), weight })
        .collect();
    let path = MorphPath::new(&stations, seed).map_err(Error::from)?;
    let frames = make(args, context, &leaves, &path, seed)?;
    let files = write(args, &out, &frames, seed)?;
    if args.json {
        let document = serde_json::json!({
            "version": env!("CARGO_PKG_VERSION"),
            "folder": out.display().to_string(),
            "frames": args.frames,
            "files": files,
        });
        writeln!(context.stdout, "{document:#}")?;
    } else {
        for file in files {
            writeln!(context.stdout, "{}", out.join(file).display())?;
        }
    }
    Ok(())
}

/// The leaves of the path with their weights, and the seed of all frames.
fn leaves(args: &Args) -> Result<(Vec<LeafSpec>, Vec<f64>, Seed), Failure> {
    let mut names = vec![(args.from.as_str(), 1.0)];
    for via in &args.via {
        let fail = |problem: &str| Failure::Input(format!("--via {via}: {problem}"));
        let (leaf, weight) = via
            .rsplit_once(':')
            .ok_or_else(|| fail("it takes a leaf and its weight, as lilac:2"))?;
        let number = weight.trim().parse::<f64>().ok().filter(|w| w.is_finite() && *w >= 0.0);
        let number = number.filter(|w| *w <= 1e6).ok_or_else(|| {
            fail(&format!("the weight `{weight}` is no number from 0 to 1000000"))
        })?;
        names.push((leaf, number));
    }
    names.push((args.to.as_str(), 1.0));
    let mut documents = Vec::new();
    for (name, _) in &names {
        let mut document = read_document(name)?;
        for assignment in &args.set {
            document.set(assignment, "--set")?;
        }
        documents.push(document);
    }
    let seed = args.seed.or(documents[0].seed).unwrap_or(1);
    let resolve = |document: &Document| leaf_args::resolve(document, seed);
    let leaves = documents.iter().map(resolve).collect::<Result<Vec<LeafSpec>, _>>()?;
    Ok((leaves, names.iter().map(|(_, weight)| *weight).collect(), Seed(seed)))
}

fn folder(frame: usize) -> String {
    format!("frame_{:04}", frame + 1)
}

/// What a run will write.
fn names(args: &Args) -> Vec<String> {
    let mut names = Vec::new();
    for frame in 0..args.frames {
        let folder = folder(frame);
        names.extend(["leaf.svg", "leaf.png"].map(|name| format!("{folder}/{name}")));
        if args.veins || args.own_veins {
            names.push(format!("{folder}/leaf_veins.json"));
        }
        names.push(format!("{folder}/{}", io::SPEC_FILE));
    }
    names.extend(["strip.png", "animation.png"].map(str::to_owned));
    names
}

fn make(
    args: &Args,
    context: &Context<'_>,
    leaves: &[LeafSpec],
    path: &MorphPath,
    seed: Seed,
) -> Result<Vec<Frame>, Failure> {
    let mut bar = Bar::new(context.quiet, "");
    let last = args.frames - 1;
    let veins = args.veins || args.own_veins;
    let ends = ends(leaves, args.own_veins);
    let guides = if veins { Some(carried(path, &ends, seed)?) } else { None };
    let one = |frame: usize| -> Result<Frame, Failure> {
        let u = frame as f64 / last as f64;
        let named = |problem: Error| Failure::Input(format!("frame {}: {problem}", frame + 1));
        let shares = path.shares(u);
        let end = if frame == 0 { Some(0) } else { (frame == last).then_some(1) };
        let mut spec =
            end.map_or_else(|| LeafSpec::mixed(leaves, &shares), |end: usize| ends[end].clone());
        spec.margin = path.spec_at(u).map_err(|error| named(error.into()))?;
        spec.texture.size_px = args.size;
        spec.output.maps = "basecolor".into();
        let is_own =
            |guides: &CarriedGuides| end.is_some() && (args.own_veins || guides.fits_ends());
        if let Some(guides) = guides.as_ref().filter(|guides| !is_own(guides)) {
            let (first, last) = (shares[0], shares[shares.len() - 1]);
            let settled = guides.settle(path, u, last / (first + last), &mut spec.veins);
            settled.map_err(|error| named(error.into()))?;
        }
        if !veins {
            let margin = path.at(u).map_err(|error| named(error.into()))?;
            return Ok(Frame { spec, margin, painted: None });
        }
        let leaf = pipeline::generate(&spec, seed, &mut Silent).map_err(named)?;
        let (textures, grown) = (leaf.textures, leaf.grown);
        let painted = Some((textures.front.base_colour, textures.frame, grown.venation));
        Ok(Frame { spec, margin: grown.margin, painted })
    };
    let mut frames = Vec::with_capacity(args.frames);
    let batch = 2 * rayon::current_num_threads();
    for start in (0..args.frames).step_by(batch) {
        let numbers = start..(start + batch).min(args.frames);
        let made: Vec<Frame> = numbers.into_par_iter().map(one).collect::<Result<_, Failure>>()?;
        frames.extend(made);
        let (step, steps) = (frames.len() as u64, args.frames as u64);
        bar.report(Progress { stage: "frames", step, steps, nodes: 0, sources: 0 });
    }
    Ok(frames)
}

/// The first and the last leaf, with as many guides as the last one when both have one type of primary
/// veins, unless each keeps its own.
fn ends(leaves: &[LeafSpec], own: bool) -> [LeafSpec; 2] {
    let mut ends = [leaves[0].clone(), leaves[leaves.len() - 1].clone()];
    if !own {
        let [first, last] = &mut ends;
        first.veins.guides.numbered_as(&last.veins.guides);
    }
    ends
}

/// The guides of both ends, and between.
fn carried(path: &MorphPath, ends: &[LeafSpec; 2], seed: Seed) -> Result<CarriedGuides, Failure> {
    let ends = ends.each_ref().map(|leaf| (&leaf.veins, &leaf.growth));
    Ok(CarriedGuides::new(path, ends, seed).map_err(Error::from)?)
}

fn write(args: &Args, out: &Path, frames: &[Frame], seed: Seed) -> Result<Vec<String>, Failure> {
    let common = common_frame(frames);
    let size = args.size as usize;
    let pictures: Vec<Grid<Rgba>> =
        frames.par_iter().map(|frame| picture(frame, &common, size)).collect();
    let mut files: Vec<(String, Vec<u8>)> = frames
        .par_iter()
        .zip(&pictures)
        .enumerate()
        .map(|(i, (frame, picture))| {
            let folder = folder(i);
            let title = format!("{}, frame {} of {}", frame.spec.title, i + 1, frames.len());
            let style = svg::Drawing {
                title: &title,
                style: frame.spec.output.svg_style,
                least_width_mm: frame.spec.output.least_width_mm,
            };
            let veins = frame.painted.as_ref().map(|(_, _, venation)| venation);
            let drawing = svg::svg(&style, &frame.margin, veins, &common, &[]);
            let caption = image::Caption {
                pixels_per_mm: Some(common.pixels_per_mm(size)),
                ..image::Caption::default()
            };
            let toml = Document::of_spec(&frame.spec, seed.0).to_toml(Comments::None);
            let mut files = vec![
                (format!("{folder}/leaf.svg"), drawing.into_bytes()),
                (format!("{folder}/leaf.png"), image::colour_png(picture, &caption)),
            ];
            if let Some((_, _, venation)) = &frame.painted {
                let veins = VeinDocument::new(&frame.margin, venation).to_json();
                files.push((format!("{folder}/leaf_veins.json"), veins.into_bytes()));
            }
            files.push((format!("{folder}/{}", io::SPEC_FILE), toml.into_bytes()));
            files
        })
        .flatten()
        .collect();
    let strip = strip(&pictures);
    files.push(("strip.png".into(), image::colour_png(&strip, &image::Caption::default())));
    files.push(("animation.png".into(), animation::apng(&pictures, args.fps)));
    let overwrite = if args.force { Overwrite::Force } else { Overwrite::Refuse };
    write_files(out, &files, overwrite)?;
    Ok(files.into_iter().map(|(name, _)| name).collect())
}

/// The square that all frames fit in.
fn common_frame(frames: &[Frame]) -> TextureFrame {
    let boxes = frames.iter().flat_map(|frame| match &frame.painted {
        Some((_, square, _)) => [square.min, square.min + DVec2::splat(square.side_mm)],
        None => [frame.margin.bounds().min, frame.margin.bounds().max],
    });
    let (low, high) = boxes
        .fold((DVec2::splat(f64::INFINITY), DVec2::splat(f64::NEG_INFINITY)), |(low, high), p| {
            (low.min(p), high.max(p))
        });
    TextureFrame::around(low, high, GUTTER)
}

/// A frame at the scale of all: the painted leaf, or a plain blade with its main veins.
fn picture(frame: &Frame, common: &TextureFrame, size: usize) -> Grid<Rgba> {
    let mut canvas = Canvas::new(size, size, [0; 4]);
    if let Some((painted, square, _)) = &frame.painted {
        let corner = common.pixel_from_leaf(square.min + DVec2::new(0.0, square.side_mm), size);
        let side = (square.side_mm * common.pixels_per_mm(size)).round() as usize;
        let at = (corner.x.round().max(0.0) as usize, corner.y.round().max(0.0) as usize);
        canvas.paste(painted, at, (side, side));
        return canvas.into_picture();
    }
    let colour = |hsv: &venation::texture::pigment::Hsv| {
        let [r, g, b] = hsv.tint().srgb().map(venation::raster::color::byte);
        [r, g, b, 255]
    };
    let place = |p: &DVec2| common.pixel_from_leaf(*p, size);
    let outline: Vec<DVec2> = frame.margin.outline().iter().map(place).collect();
    let front = &frame.spec.colour.front;
    canvas.fill(&[&outline], colour(&front.base));
    let mut veins = vec![[DVec2::ZERO, frame.margin.apex()]];
    for mark in frame.margin.landmarks() {
        if let LandmarkKind::LobeTip { origin } = mark.kind {
            veins.push([origin, frame.margin.outline()[mark.vertex]]);
        }
    }
    let width = (0.006 * frame.margin.length_mm() * common.pixels_per_mm(size)).max(1.0);
    for vein in veins {
        canvas.stroke(&vein.map(|p| place(&p)), width, colour(&front.vein));
    }
    canvas.into_picture()
}

/// Frames side by side on white, evenly chosen when there are many.
fn strip(pictures: &[Grid<Rgba>]) -> Grid<Rgba> {
    let count = pictures.len().min(STRIP_FRAMES);
    let side = STRIP_PX.min(pictures[0].width());
    let mut canvas = Canvas::new(count * side, side, [255; 4]);
    for i in 0..count {
        let frame = i * (pictures.len() - 1) / (count - 1);
        canvas.paste(&pictures[frame], (i * side, 0), (side, side));
    }
    canvas.into_picture()
}
