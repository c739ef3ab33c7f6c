//! `venation fit`: real leaves to parameters.

use std::path::{Path, PathBuf};

use rayon::prelude::*;
use serde_json::{Value, json};
use venation::document::{self, Comments, Document};
use venation::geometry::deviation::Distances;
use venation::io;
use venation::io::fit as drawing;
use venation::io::image::{Caption, colour_png};
use venation::io::outline::{self, OutlineOptions};
use venation::margin::fit::{self, Fit};
use venation::margin::{Margin, MarginError};
use venation::raster::montage::{self, Layout, Panel};

use super::leaf_args::{self, OutlineWord};
use super::{Context, Failure};

#[derive(Debug, clap::Args)]
#[command(after_help = "\
Examples:
  venation fit scan.png -o leaf.toml                  the leaf as parameters, and leaf.png: both margins
  venation generate leaf.toml -o leaf                 the fitted leaf, with veins and textures
  venation generate leaf.toml --seeds 1-20 -o leaves  it and nineteen like it
  venation fit outline.csv --like linden -o mine.toml its outline, all else as linden's
  venation fit scans --csv > fits.csv                 every leaf of a folder
  venation fit scans --sheet fits.png                 and all of them on one sheet

Distances are relative to the primary vein (base to apex), from the points of each margin to the \
nearest place of the other: median, three quarters, greatest.")]
pub(crate) struct Args {
    /// Pictures (PNG, JPEG) or outlines (CSV, SVG) of leaves, or folders of them.
    #[arg(required = true, value_name = "FILE | DIR")]
    paths: Vec<PathBuf>,
    /// The fitted leaf as TOML, and beside it both margins drawn, as PNG; a folder for several.
    #[arg(short, long, value_name = "FILE.toml | DIR")]
    out: Option<PathBuf>,
    /// Both margins drawn, as PNG or SVG [default: beside the TOML file].
    #[arg(long, value_name = "FILE.png | FILE.svg")]
    overlay: Option<PathBuf>,
    /// All leaves with both margins on one sheet.
    #[arg(long, value_name = "FILE.png")]
    sheet: Option<PathBuf>,
    /// Take everything but the margin from this preset or TOML file.
    #[arg(long, value_name = "PRESET | FILE.toml")]
    like: Option<String>,
    /// How far leaves of other seeds than the fitted one's may differ from it, in percent of each
    /// number of the margin.
    #[arg(long, value_name = "PERCENT", default_value = "8")]
    vary: f64,
    /// What the files show.
    #[arg(long, value_name = "KIND", value_enum, default_value = "auto")]
    outline_kind: OutlineWord,
    /// Where the petiole meets the blade, in the file's own coordinates; found when not given.
    #[arg(long, value_name = "X,Y", value_parser = leaf_args::point, allow_hyphen_values = true)]
    root: Option<[f64; 2]>,
    /// The y axis of a CSV points up, not down.
    #[arg(long)]
    y_up: bool,
    /// Length of the blade from base to apex, in mm [default: 80].
    #[arg(long, value_name = "L", conflicts_with = "px_per_mm")]
    length_mm: Option<f64>,
    /// Scale of the files, from which the length follows.
    #[arg(long, value_name = "N")]
    px_per_mm: Option<f64>,
    /// Everything as one JSON document on stdout.
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// One line of CSV a leaf on stdout.
    #[arg(long)]
    csv: bool,
    /// Overwrite files of an earlier run.
    #[arg(long)]
    force: bool,
}

/// A fit that strays farther than this (lengths of the primary vein) is told to be poor; of sixty scanned
/// leaves none does.
const POOR: f64 = 0.1;

/// A leaf fitted.
struct Fitted {
    path: PathBuf,
    name: String,
    real: Margin,
    fit: Fit,
    base: [f64; 2],
    apex: [f64; 2],
    notes: Vec<String>,
}

pub(crate) fn run(args: &Args, context: &mut Context<'_>) -> Result<(), Failure> {
    args.check()?;
    let (paths, folders) = files(&args.paths)?;
    let single = paths.len() == 1 && !folders;
    if !single && args.overlay.is_some() {
        return Err(Failure::Input("--overlay draws one leaf; --sheet draws several".into()));
    }
    if !single && args.root.is_some() {
        return Err(Failure::Input("--root is a place in one file; fit one at a time".into()));
    }
    let base = match &args.like {
        Some(leaf) => leaf_args::read_document(leaf)?,
        None => Document::new(),
    };
    let outputs = args.outputs(&paths, single)?;
    let written = || outputs.iter().flatten().chain(&args.sheet);
    super::spare_inputs(written(), &paths)?;
    super::refuse_existing(written(), args.force)?;

    let results: Vec<Result<Fitted, String>> =
        paths.par_iter().map(|path| args.fit(path)).collect();
    let mut fitted = Vec::new();
    let mut failed = 0;
    for (result, outputs) in results.into_iter().zip(&outputs) {
        match result {
            Ok(leaf) => {
                leaf.notes
                    .iter()
                    .for_each(|note| context.say(&format!("{}: {note}", leaf.path.display())));
                for output in outputs {
                    super::save(output, leaf.file(output, &base, args.vary)?)?;
                }
                fitted.push(leaf);
            }
            Err(problem) if single => return Err(Failure::Input(problem)),
            Err(problem) => {
                super::complain(&problem);
                failed += 1;
            }
        }
    }
    if let Some(sheet) = &args.sheet {
        super::save(sheet, contact_sheet(&fitted))?;
    }
    let text = if args.json {
        json_text(&fitted, single)
    } else if args.csv {
        csv_text(&fitted)
    } else {
        table(&fitted)
    };
    write!(context.stdout, "{text}")?;
    if failed > 0 {
        let problem = format!("{failed} of {} leaves were not fitted", paths.len());
        return Err(Failure::Partial(problem));
    }
    Ok(())
}

impl Args {
    fn check(&self) -> Result<(), Failure> {
        let outside = |flag: &str, value: f64, low: f64, high: f64| {
            let problem = format!("{flag}: {value} is not between {low} and {high}");
            (!(low..=high).contains(&value)).then_some(Failure::Input(problem))
        };
        let wrong = [
            outside("--vary", self.vary, 0.0, 100.0),
            self.length_mm.and_then(|length| outside("--length-mm", length, 1.0, 2000.0)),
            self.px_per_mm.and_then(|scale| outside("--px-per-mm", scale, 1e-3, 1e6)),
        ];
        if let Some(out) = self.out.as_ref().filter(|out| super::is_picture(out)) {
            let problem = "leaves are written as .toml, or into a folder; --overlay draws them";
            return Err(Failure::Input(format!("-o: {}: {problem}", out.display())));
        }
        if let Some(sheet) = &self.sheet {
            super::png_only("--sheet", sheet)?;
        }
        wrong.into_iter().flatten().next().map_or(Ok(()), Err)
    }

    /// The files to write for each leaf.
    fn outputs(&self, paths: &[PathBuf], single: bool) -> Result<Vec<Vec<PathBuf>>, Failure> {
        let is = |path: &Path, ending: &str| path.extension().is_some_and(|e| e == ending);
        if let Some(path) =
            self.overlay.as_ref().filter(|path| !is(path, "png") && !is(path, "svg"))
        {
            let problem = format!("{}: both margins are drawn as .png or .svg", path.display());
            return Err(Failure::Input(problem));
        }
        let to_folder = !single || self.out.as_ref().is_some_and(|out| !is(out, "toml"));
        let mut lists = Vec::new();
        for path in paths {
            let toml = self.out.as_ref().map(|out| {
                if to_folder { out.join(format!("{}.toml", name_of(path))) } else { out.clone() }
            });
            let overlay = self.overlay.clone();
            let overlay = overlay.or_else(|| toml.as_ref().map(|toml| toml.with_extension("png")));
            lists.push([toml, overlay].into_iter().flatten().collect());
        }
        Ok(lists)
    }

    fn fit(&self, path: &Path) -> Result<Fitted, String> {
        let told = |error: &MarginError| format!("{}: {error}", path.display());
        let mut options = OutlineOptions {
            kind: self.outline_kind.kind(),
            root: self.root,
            y_up: self.y_up,
            length_mm: self.length_mm.unwrap_or(80.0),
        };
        let mut imported = outline::import(path, &options).map_err(|error| error.to_string())?;
        if let Some(scale) = self.px_per_mm {
            let [dx, dy] = [0, 1].map(|i| imported.apex[i] - imported.base[i]);
            options.length_mm = dx.hypot(dy) / scale;
            if !(1.0..=2000.0).contains(&options.length_mm) {
                return Err(format!(
                    "{}: at {scale} px/mm the blade is {:.2} mm long; it takes 1 to 2000",
                    path.display(),
                    options.length_mm
                ));
            }
            imported = outline::import(path, &options).map_err(|error| error.to_string())?;
        }
        let real = imported.margin().map_err(|error| told(&error))?;
        let fit = fit::fit(&real).map_err(|error| told(&error))?;
        let mut notes = imported.notes;
        if fit.worst() > POOR {
            notes.push(format!(
                "the fit strays {:.2} lengths of the primary vein: is the outline torn, is base or apex \
                 another (--root)? `generate --outline` takes it as it is",
                fit.worst()
            ));
        }
        let (path, name) = (path.to_owned(), name_of(path));
        Ok(Fitted { path, name, real, fit, base: imported.base, apex: imported.apex, notes })
    }
}

/// The leaves that the arguments name, and whether a folder was among them.
fn files(paths: &[PathBuf]) -> Result<(Vec<PathBuf>, bool), Failure> {
    const ENDINGS: [&str; 5] = ["png", "jpg", "jpeg", "csv", "svg"];
    let mut found = Vec::new();
    let mut folders = false;
    for path in paths {
        if !path.is_dir() {
            found.push(path.clone());
            continue;
        }
        folders = true;
        let failed = |error: std::io::Error| Failure::Input(format!("{}: {error}", path.display()));
        let mut inside = Vec::new();
        for entry in std::fs::read_dir(path).map_err(failed)? {
            let file = entry.map_err(failed)?.path();
            let ending = file.extension().map(|e| e.to_string_lossy().to_ascii_lowercase());
            if ending.is_some_and(|ending| ENDINGS.contains(&ending.as_str())) {
                inside.push(file);
            }
        }
        if inside.is_empty() {
            let problem = format!("{}: holds no PNG, JPEG, CSV or SVG file", path.display());
            return Err(Failure::Input(problem));
        }
        inside.sort();
        found.extend(inside);
    }
    Ok((found, folders))
}

/// A leaf is called after its file.
fn name_of(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' };
    let name: String = io::file_stem(&stem).chars().map(plain).collect();
    if name.is_empty() { "leaf".into() } else { name }
}

impl Fitted {
    fn file(&self, path: &Path, base: &Document, vary: f64) -> Result<Vec<u8>, Failure> {
        Ok(match path.extension().and_then(|e| e.to_str()) {
            Some("svg") => drawing::svg(&self.real, &self.fit).into_bytes(),
            Some("png") => {
                colour_png(&drawing::picture(&self.real, &self.fit, 900), &Caption::default())
            }
            _ => self.document(base, vary)?.to_toml(Comments::None).into_bytes(),
        })
    }

    /// The leaf as settings: those of `base` with the fitted margin.
    fn document(&self, base: &Document, vary: f64) -> Result<Document, Failure> {
        let mut document = base.clone();
        document.set_margin(&self.fit.spec, "fit");
        let text = |text: String| document::Value::Text(text);
        document.insert("name", text(self.name.clone()), "fit");
        document.insert("title", text(format!("{}, fitted", self.name)), "fit");
        document.seed = Some(1);
        document.vary = (vary > 0.0).then_some(vary);
        Ok(document)
    }

    fn json(&self) -> Value {
        let fit = &self.fit;
        let distances = |d: &Distances| json!({ "median": d.median, "upper_quartile": d.upper_quartile, "max": d.max });
        json!({
            "path": self.path.to_string_lossy(),
            "name": self.name,
            "base": self.base,
            "apex": self.apex,
            "length_mm": fit.spec.length_mm,
            "kind": fit.kind(),
            "lobes": fit.lobes,
            "numbers": fit.numbers,
            "basal_extension": fit.has_tail(),
            "apical_extension": fit.has_shoulder(),
            "max": fit.worst(),
            "fitted_to_real": distances(&fit.fitted_to_real),
            "real_to_fitted": distances(&fit.real_to_fitted),
            "margin": serde_json::to_value(&fit.spec).expect("plain data"),
        })
    }
}

fn json_text(fitted: &[Fitted], single: bool) -> String {
    let leaves: Vec<Value> = fitted.iter().map(Fitted::json).collect();
    let document = match (&leaves[..], single) {
        ([leaf], true) => leaf.clone(),
        _ => json!({ "leaves": leaves, "max": quantiles(fitted) }),
    };
    serde_json::to_string_pretty(&document).expect("plain data") + "\n"
}

/// How the greatest distances are spread over the leaves.
fn quantiles(fitted: &[Fitted]) -> Value {
    let mut worst: Vec<f64> = fitted.iter().map(|leaf| leaf.fit.worst()).collect();
    worst.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| worst.get((share * (worst.len().max(1) - 1) as f64).round() as usize);
    json!({ "median": at(0.5), "nine_in_ten": at(0.9), "greatest": at(1.0) })
}

fn csv_text(fitted: &[Fitted]) -> String {
    let mut text = String::from(
        "name,lobes,numbers,max,fitted_median,fitted_upper_quartile,fitted_max,real_median,\
         real_upper_quartile,real_max\n",
    );
    for leaf in fitted {
        let (fit, [there, back]) =
            (&leaf.fit, [&leaf.fit.fitted_to_real, &leaf.fit.real_to_fitted]);
        text += &format!("{},{},{},{:.5}", leaf.name, fit.lobes, fit.numbers, fit.worst());
        for d in [there, back] {
            text += &format!(",{:.5},{:.5},{:.5}", d.median, d.upper_quartile, d.max);
        }
        text += "\n";
    }
    text
}

fn table(fitted: &[Fitted]) -> String {
    let mut text = String::new();
    for leaf in fitted {
        let fit = &leaf.fit;
        text +=
            &format!("{}: {}, {} numbers\n", leaf.path.display(), fit.description(), fit.numbers);
        for (name, d) in
            [("fitted to real", &fit.fitted_to_real), ("real to fitted", &fit.real_to_fitted)]
        {
            text += &format!(
                "  {name}  median {:.4}  75 % {:.4}  max {:.4}\n",
                d.median, d.upper_quartile, d.max
            );
        }
    }
    if fitted.len() > 1 {
        let spread = quantiles(fitted);
        let number = |key: &str| spread[key].as_f64().unwrap_or(f64::NAN);
        text += &format!(
            "{} leaves: greatest distance, median {:.4}, nine in ten {:.4}, all {:.4}\n",
            fitted.len(),
            number("median"),
            number("nine_in_ten"),
            number("greatest")
        );
    }
    text
}

fn contact_sheet(fitted: &[Fitted]) -> Vec<u8> {
    const PANEL_PX: usize = 300;
    let panels: Vec<Panel> = fitted
        .iter()
        .map(|leaf| Panel {
            picture: drawing::picture(&leaf.real, &leaf.fit, PANEL_PX),
            label: leaf.name.clone(),
            notes: vec![format!("{}: {:.4}", leaf.fit.description(), leaf.fit.worst())],
        })
        .collect();
    let sheet = montage::sheet("", &panels, Layout { columns: 0, panel_px: PANEL_PX });
    colour_png(&sheet, &Caption::default())
}
