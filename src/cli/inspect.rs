//! `venation inspect`: a vein pattern measured, beside real leaves; or the blades in a picture.

mod blades;

use std::path::PathBuf;

use serde_json::{Value, json};
use venation::io::network::{self, ReadNetwork};
use venation::io::outline;
use venation::margin::blades::THIN;
use venation::veins::metrics::measures::{Measures, Unit};
use venation::veins::metrics::{Architecture, Measure, picture};

use super::{Context, Failure};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation generate beech --format json -o out && venation inspect out
  venation inspect out/fagus-sylvatica_veins.json --json > measures.json
  venation inspect cleared-leaf.png                   a real network, veins white on black or back
  venation inspect cleared-leaf.png --px-per-mm 252   the same with lengths in mm
  venation inspect scan.jpg --px-per-mm 11.81         every blade on a scan, with its area and length
  venation inspect scan.jpg --silhouettes scan.svg    and as curves of few control points

A picture whose largest part is on the whole narrower than 2 % of its extent is a net of veins, any other shows blades; --blades and --veins settle it. Areas are those within the outline, petiole and holes (listed apart) included; length is the greatest extent, base to apex leaves the petiole away. Points are the control points of a quadratic B-spline, corners kept, that stays within --tolerance of the boundary; error is its greatest distance.

The twenty rows come first: measures free of scale, each with the band that real leaves lie in. A row \
counts when all its values are inside. \
Open forking veins (ginkgo) and parallel ones (grass) have eight rows of their own. Pictures need veins 6 px wide or more for rows 16 to 19.")]
pub(crate) struct Args {
    /// A leaf's folder, its NAME_veins.json, or a picture (PNG, JPEG) of veins, black and white, or of
    /// leaves.
    path: PathBuf,
    /// Everything as one JSON document.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// Every measure as a line of CSV.
    #[arg(long)]
    csv: bool,
    /// The picture shows leaves: list every blade with its area and length.
    #[arg(long, conflicts_with = "veins")]
    blades: bool,
    /// The picture shows veins, whatever it looks like.
    #[arg(long)]
    veins: bool,
    /// Scale of a picture: lengths are in mm then.
    #[arg(long, value_name = "N")]
    px_per_mm: Option<f64>,
    /// Write the blades of a picture as curves of few control points, corners kept.
    #[arg(long, value_name = "FILE.svg")]
    silhouettes: Option<PathBuf>,
    /// How far these curves may lie from the boundary, in pixels.
    #[arg(long, value_name = "PX", default_value = "1")]
    tolerance: f64,
    /// Overwrite a file of an earlier run.
    #[arg(long)]
    force: bool,
    /// The rows that count: `reticulate`, `dichotomous` or `parallel`. By itself: what the veins look like.
    #[arg(long, value_name = "KIND", value_parser = architecture)]
    architecture: Option<Architecture>,
}

fn architecture(word: &str) -> Result<Architecture, String> {
    Architecture::ALL.iter().copied().find(|kind| kind.word() == word).ok_or_else(|| {
        let words: Vec<&str> = Architecture::ALL.iter().map(|kind| kind.word()).collect();
        format!("is not one of {}", words.join(", "))
    })
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    if let Some(scale) = args.px_per_mm.filter(|scale| !(1e-3..=1e6).contains(scale)) {
        let problem = format!("--px-per-mm: {scale} is not between 0.001 and 1000000");
        return Err(Failure::Input(problem));
    }
    if !(0.05..=1000.0).contains(&args.tolerance) {
        let problem = format!("--tolerance: {} is not between 0.05 and 1000 px", args.tolerance);
        return Err(Failure::Input(problem));
    }
    if args.silhouettes.as_ref().is_some_and(|file| file.extension().is_none_or(|e| e != "svg")) {
        return Err(Failure::Input("--silhouettes: curves are written as .svg".into()));
    }
    if args.silhouettes.is_some() && args.veins {
        return Err(Failure::Input("--silhouettes draws blades; leave --veins away".into()));
    }
    if args.silhouettes.is_some() || args.shows_blades()? {
        return blades::run(args, context);
    }
    let read = network::read(&args.path, args.px_per_mm)
        .map_err(|error| Failure::Input(error.to_string()))?;
    read.notes.iter().for_each(|note| context.say(note));
    let measures = Measures::by(&read.network, read.unit, args.architecture);
    let coarse = |pixel: f64| measures.median_width < Some(picture::FINEST_WIDTH_PX * pixel);
    if read.pixel.is_some_and(coarse) {
        context.say("veins are less than 6 px wide: do not trust rows 16 to 19");
    }
    if measures.topology.loops() != measures.areoles.len() {
        context.say(&format!(
            "{} loops but {} areoles: some veins cross without a junction",
            measures.topology.loops(),
            measures.areoles.len()
        ));
    }
    let text = if args.json {
        let document = document(&read, &measures);
        serde_json::to_string_pretty(&document).expect("plain data") + "\n"
    } else if args.csv {
        csv(&measures)
    } else {
        table(&read, &measures)
    };
    write!(context.stdout, "{text}")?;
    Ok(())
}

impl Args {
    /// Whether to look for blades: asked for, or a picture of things too wide for veins.
    fn shows_blades(&self) -> Result<bool, Failure> {
        if self.blades || self.veins || !network::is_picture(&self.path) {
            return Ok(self.blades);
        }
        // What shows no blade at all may still show veins, or says itself what is wrong with it.
        Ok(outline::blades(&self.path).is_ok_and(|found| found.thinness >= THIN))
    }
}

fn number(value: Option<f64>) -> String {
    match value {
        None => "-".into(),
        Some(value) if value.abs() >= 100.0 => format!("{value:.1}"),
        // Nothing less than nothing: what rounds to 0 has no sign.
        Some(value) if value.abs() < 0.0005 => "0.000".into(),
        Some(value) => format!("{value:.3}"),
    }
}

/// A band as short as it can be written.
fn band(measure: &Measure) -> String {
    let Some(band) = &measure.band else { return String::new() };
    format!("{}-{}", band.start(), band.end())
}

const fn verdict(measure: &Measure, inside: Option<bool>) -> &'static str {
    match (inside, &measure.value) {
        (Some(true), _) => "yes",
        (Some(false), _) => "no",
        (None, _) => "",
    }
}

fn line(text: &mut String, row: &str, measure: &Measure) {
    let (value, band) = (number(measure.value), band(measure));
    let verdict = verdict(measure, measure.is_inside());
    *text += format!("{row:>3}  {:46} {value:>9}  {band:13} {verdict}", measure.name).trim_end();
    *text += "\n";
}

fn table(read: &ReadNetwork, m: &Measures) -> String {
    let unit = m.unit.symbol();
    let t = &m.topology;
    let mut text = format!(
        "{}\n{} segments between {} nodes in {} parts; {} areoles, {} free endings\n\
         length {} {unit}, blade {} {unit}², median width {} {unit}\n",
        read.path.display(),
        t.segments,
        t.nodes,
        t.parts,
        m.areoles.len(),
        t.free_ends,
        number(Some(m.length)),
        number(Some(m.blade_area)),
        number(m.median_width),
    );
    if let Some(pixel) = m.distance_pixel {
        text += &format!("distances on a grid of {} px/{unit}\n", number(Some(1.0 / pixel)));
    }
    text += &format!("\n{:>3}  {:46} {:>9}  {:13} {}\n", "row", "measure", "value", "band", "ok");
    for row in &m.rows {
        for measure in &row.measures {
            line(&mut text, &row.number.to_string(), measure);
        }
    }
    let kind = m.architecture.word();
    text += &format!("{} of {} rows inside ({kind})\n\n", m.rows_inside(), m.rows.len());
    m.others.iter().for_each(|measure| line(&mut text, "", measure));
    if !m.orders.is_empty() {
        text += &format!("\norder  segments  length {unit}  {unit}/{unit}²  width {unit}\n");
    }
    for o in &m.orders {
        text += &format!(
            "{:>5}  {:>8}  {:>9.2}  {:>6.3}  {:>8.4}\n",
            o.order, o.segments, o.length, o.length_per_area, o.width
        );
    }
    text += &format!("\nStrahler  streams  ratio  length {unit}  width {unit}  ratio\n");
    for (i, s) in m.strahler.iter().enumerate() {
        let above = m.strahler.get(i + 1);
        let streams = above.map(|a| s.streams as f64 / a.streams as f64);
        let widths = above.map(|a| a.width / s.width);
        text += &format!(
            "{:>8}  {:>7}  {:>5}  {:>9.2}  {:>8.4}  {:>5}\n",
            s.order,
            s.streams,
            streams.map_or("-".into(), |v| format!("{v:.2}")),
            s.length,
            s.width,
            widths.map_or("-".into(), |v| format!("{v:.2}")),
        );
    }
    text += "\nw3/w1      share  angle 12 (band)     angle 13 (band)     angle 23 (band)\n";
    for bin in &m.angles {
        let angle = |m: &Measure| format!("{:>6} {:12}", number(m.value), format!("({})", band(m)));
        let range = format!("{}-{}", bin.ratio[0], bin.ratio[1]);
        text += &format!("{range:10} {:.3}", bin.share);
        bin.angles.iter().for_each(|m| text += &format!("  {}", angle(m).trim_end()));
        text += "\n";
    }
    text += "\nw1 quantiles  junctions  Murray exponent (band)  area ratio (band)\n";
    for bin in &m.exponents {
        let range = format!("{}-{}", bin.quantiles[0], bin.quantiles[1]);
        text += &format!("{range:12}  {:>9}", bin.junctions);
        for measure in [&bin.murray, &bin.area_ratio] {
            text += &format!("  {:>8} ({})", number(measure.value), band(measure));
        }
        text += "\n";
    }
    text
}

fn csv(measures: &Measures) -> String {
    let mut text = String::from("row,key,value,low,high,inside\n");
    for (row, measure) in measures.all() {
        let cell = |value: Option<f64>| value.map(|v| v.to_string()).unwrap_or_default();
        let band = measure.band.as_ref();
        text += &format!(
            "{},{},{},{},{},{}\n",
            row.map(|row| row.to_string()).unwrap_or_default(),
            measure.key,
            cell(measure.value),
            cell(band.map(|band| *band.start())),
            cell(band.map(|band| *band.end())),
            measure.is_inside().map(|inside| inside.to_string()).unwrap_or_default(),
        );
    }
    text
}

fn measure(measure: &Measure) -> Value {
    json!({
        "key": measure.key,
        "name": measure.name,
        "value": measure.value,
        "band": measure.band.as_ref().map(|band| [*band.start(), *band.end()]),
        "inside": measure.is_inside(),
    })
}

fn document(read: &ReadNetwork, m: &Measures) -> Value {
    let rows = m.rows.iter().map(|row| {
        json!({
            "row": row.number,
            "inside": row.is_inside(),
            "measures": row.measures.iter().map(measure).collect::<Vec<_>>(),
        })
    });
    let orders = m.orders.iter().map(|o| {
        json!({
            "order": o.order,
            "segments": o.segments,
            "length": o.length,
            "length_per_area": o.length_per_area,
            "width": o.width,
        })
    });
    let strahler = m.strahler.iter().map(
        |s| json!({ "order": s.order, "streams": s.streams, "length": s.length, "width": s.width }),
    );
    let angles = m.angles.iter().map(|bin| {
        json!({
            "width_ratio": bin.ratio,
            "junctions": bin.junctions,
            "angles": bin.angles.iter().map(measure).collect::<Vec<_>>(),
        })
    });
    let exponents = m.exponents.iter().map(|bin| {
        json!({
            "width_quantiles": bin.quantiles,
            "junctions": bin.junctions,
            "murray": measure(&bin.murray),
            "area_ratio": measure(&bin.area_ratio),
        })
    });
    json!({
        "version": env!("CARGO_PKG_VERSION"),
        "path": read.path.to_string_lossy(),
        "unit": m.unit.symbol(),
        "is_scaled": m.unit == Unit::Millimetre,
        "picture_pixel": read.pixel,
        "distance_pixel": m.distance_pixel,
        "nodes": m.topology.nodes,
        "segments": m.topology.segments,
        "parts": m.topology.parts,
        "loops": m.topology.loops(),
        "areoles": m.areoles.len(),
        "free_ends": m.topology.free_ends,
        "length": m.length,
        "blade_area": m.blade_area,
        "median_width": m.median_width,
        "architecture": m.architecture.word(),
        "rows_inside": m.rows_inside(),
        "rows": rows.collect::<Vec<_>>(),
        "others": m.others.iter().map(measure).collect::<Vec<_>>(),
        "orders": orders.collect::<Vec<_>>(),
        "strahler": strahler.collect::<Vec<_>>(),
        "angles_by_width": angles.collect::<Vec<_>>(),
        "exponents_by_width": exponents.collect::<Vec<_>>(),
    })
}
