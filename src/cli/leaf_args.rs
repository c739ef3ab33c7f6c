//! The flags that describe a leaf, shared by the commands that make one.

use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use venation::document::{Document, Value};
use venation::io::outline::{self, OutlineKind, OutlineOptions};
use venation::margin::MarginSpec;
use venation::margin::shapes;
use venation::point_list;
use venation::presets;
use venation::seed::Seed;
use venation::spec::LeafSpec;

use super::{Context, Failure};

/// Growth types as words of the command line.
#[derive(Debug, Clone, Copy, clap::ValueEnum)]
pub(crate) enum GrowthWord {
    /// Full size from the first step on.
    None,
    /// New tissue at the margin only.
    Marginal,
    /// The same rate in both directions.
    Isotropic,
    /// Different rates across and along.
    Anisotropic,
    /// Rates that differ from place to place (`growth.rates`).
    NonUniform,
}

impl GrowthWord {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Marginal => "marginal",
            Self::Isotropic => "isotropic",
            Self::Anisotropic => "anisotropic",
            Self::NonUniform => "non-uniform",
        }
    }
}

/// Kinds of outline as words of the command line.
#[derive(Debug, Clone, Copy, Default, clap::ValueEnum)]
pub(crate) enum OutlineWord {
    /// By what is in the file: a picture whose background encloses more background is a sketch.
    #[default]
    Auto,
    /// A drawing of the outline on a plain background.
    Sketch,
    /// A photograph, scan or mask of a leaf on a plain background.
    Photo,
    /// CSV with x,y in every line, or a path in an SVG.
    Polygon,
}

impl OutlineWord {
    pub(crate) fn kind(self) -> OutlineKind {
        match self {
            Self::Auto => OutlineKind::Auto,
            Self::Sketch => OutlineKind::Sketch,
            Self::Photo => OutlineKind::Photo,
            Self::Polygon => OutlineKind::Polygon,
        }
    }
}

#[derive(Debug, clap::Args)]
pub(crate) struct LeafArgs {
    /// A preset (`venation presets` lists them) or a TOML file.
    #[arg(value_name = "PRESET | FILE.toml")]
    pub(crate) leaf: String,
    /// Grow in the outline of this PNG, JPEG, CSV or SVG file instead of the preset's.
    #[arg(long, value_name = "FILE")]
    outline: Option<PathBuf>,
    /// What the outline file is.
    #[arg(long, value_name = "KIND", value_enum, default_value = "auto", requires = "outline")]
    outline_kind: OutlineWord,
    /// Where the petiole meets the blade, in the file's own coordinates (pictures: pixels, y down);
    /// found by itself when not given.
    #[arg(long, value_name = "X,Y", requires = "outline", value_parser = point, allow_hyphen_values = true)]
    root: Option<[f64; 2]>,
    /// The y axis of the CSV points up, not down.
    #[arg(long, requires = "outline")]
    y_up: bool,
    /// Give the blade the shape of this name instead of the preset's: `ovate-cordate-straight`,
    /// `reniform`, … (`venation compare --by shape` shows them all).
    #[arg(long, value_name = "NAME", conflicts_with = "outline")]
    shape: Option<String>,
    /// Length of the blade from base to apex, in mm; a range, as 60..90, draws one for each leaf
    /// [default: the preset's].
    #[arg(long, value_name = "L")]
    length_mm: Option<String>,
    /// How the blade grows.
    #[arg(long, value_name = "TYPE", value_enum)]
    growth: Option<GrowthWord>,
    /// Side of the square textures, in pixels: 16 to 16384 [default: the preset's, 1024].
    #[arg(long, value_name = "PX")]
    pub(crate) size: Option<i64>,
    /// 0 summer, 0.5 autumn colour, 1 litter; a range, as 0.3..0.7, draws one for each leaf
    /// [default: the preset's, 0].
    #[arg(long, value_name = "0 to 1")]
    season: Option<String>,
    /// 0 just unfolded, 1 mature, or a range [default: the preset's, 1].
    #[arg(long, value_name = "0 to 1")]
    maturity: Option<String>,
    /// 1 well, less sick, or a range [default: the preset's, 1].
    #[arg(long, value_name = "0 to 1")]
    health: Option<String>,
    /// What has happened to it, as holes=0.2,margin_bites=0.1,skeletonise=0.1 (shares of the blade),
    /// mines, spots, scorch, tears (0 to 1).
    #[arg(long, value_name = "LIST")]
    damage: Option<String>,
    /// Other wounds on the same leaf.
    #[arg(long, value_name = "N")]
    damage_seed: Option<i64>,
    /// Perturb every number of the margin by up to so many percent, on top of the preset's ranges.
    #[arg(long, value_name = "PERCENT%")]
    vary: Option<String>,
    /// Auxin sources from this CSV (x,y in mm of the mature leaf: base 0,0, apex on +y) instead of
    /// darts; they make the whole pattern: open venation without guides or smoothing, unless --set.
    #[arg(long, value_name = "FILE.csv")]
    sources: Option<PathBuf>,
    /// Set any key: `--set veins.kill_distance_mm=0.6`, a range `0.5..0.8`, `20±10%`.
    #[arg(long, value_name = "key=value", allow_hyphen_values = true)]
    set: Vec<String>,
}

pub(crate) fn point(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("`{text}` is not X,Y");
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let number = |t: &str| t.trim().parse::<f64>().ok().filter(|v| v.is_finite());
    Ok([number(x).ok_or_else(wrong)?, number(y).ok_or_else(wrong)?])
}

/// What to say about a leaf that is neither a preset nor a file.
pub(crate) fn unknown(name: &str) -> String {
    let hint = match presets::nearest(name) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`venation presets` lists the presets".to_owned(),
    };
    format!("`{name}` is neither a preset nor a TOML file; {hint}")
}

/// Files a person describes a leaf in are small; more than this is a mistake (bytes).
const LARGEST_TEXT: u64 = 256 << 20;

/// The text of a file.
fn read_text(path: &Path) -> Result<String, Failure> {
    let fail = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let size = std::fs::metadata(path).map_err(|e| fail(e.to_string()))?.len();
    if size > LARGEST_TEXT {
        return Err(fail(format!("{size} bytes are too many (limit {LARGEST_TEXT})")));
    }
    // A device has no size, and no end.
    let file = File::open(path).map_err(|e| fail(e.to_string()))?;
    let mut bytes = Vec::new();
    let read = file.take(LARGEST_TEXT + 1).read_to_end(&mut bytes);
    if read.map_err(|e| fail(e.to_string()))? as u64 > LARGEST_TEXT {
        return Err(fail(format!("more than {LARGEST_TEXT} bytes are too many")));
    }
    String::from_utf8(bytes).map_err(|_| fail("not UTF-8 text".into()))
}

fn read_sources(path: &Path) -> Result<Vec<[f64; 2]>, Failure> {
    let fail = |problem: String| Failure::Input(format!("{}: {problem}", path.display()));
    let points = point_list::parse(&read_text(path)?).map_err(|e| fail(e.to_string()))?;
    if points.is_empty() { Err(fail("no points".into())) } else { Ok(points) }
}

/// The document of a preset or a TOML file.
pub(crate) fn read_document(leaf: &str) -> Result<Document, Failure> {
    if let Some(preset) = presets::find(leaf) {
        return Ok(preset.document()?);
    }
    let path = Path::new(leaf);
    if !path.exists() && path.extension().is_none() {
        return Err(Failure::Input(unknown(leaf)));
    }
    let text = read_text(path)?;
    Ok(Document::parse(&text, leaf)?)
}

impl LeafArgs {
    /// The files that it is made from, and what may be one.
    pub(crate) fn inputs(&self) -> Vec<PathBuf> {
        let files = self.outline.iter().chain(&self.sources).cloned();
        files.chain([PathBuf::from(&self.leaf)]).collect()
    }

    /// Whether `--set` gives this key.
    pub(crate) fn sets(&self, key: &str) -> bool {
        self.set.iter().any(|assignment| assignment.split('=').next().map(str::trim) == Some(key))
    }

    /// The document that the flags describe: preset or file, outline, then the flags over it.
    pub(crate) fn document(&self, context: &Context<'_>) -> Result<Document, Failure> {
        let mut document = read_document(&self.leaf)?;
        if let Some(length) = &self.length_mm {
            document.set(&format!("margin.length_mm={length}"), "--length-mm")?;
        }
        if let Some(vary) = &self.vary {
            document.set(&format!("vary={vary}"), "--vary")?;
        }
        if let Some(growth) = self.growth {
            document.set(&format!("growth.type={}", growth.word()), "--growth")?;
        }
        if let Some(size) = self.size {
            document.set(&format!("texture.size_px={size}"), "--size")?;
        }
        let state =
            [("season", &self.season), ("maturity", &self.maturity), ("health", &self.health)];
        for (name, value) in state {
            if let Some(value) = value {
                document.set(&format!("state.{name}={value}"), &format!("--{name}"))?;
            }
        }
        for wound in self.damage.iter().flat_map(|list| list.split(',')) {
            document.set(&format!("damage.{}", wound.trim()), "--damage")?;
        }
        if let Some(seed) = self.damage_seed {
            document.set(&format!("damage.seed={seed}"), "--damage-seed")?;
        }
        if let Some(path) = &self.outline {
            self.import_outline(path, &mut document, context)?;
        }
        if let Some(name) = &self.shape {
            insert_shape(name, &mut document)?;
        }
        if let Some(path) = &self.sources {
            let points = read_sources(path)?;
            document.insert("veins.sources_mm", Value::Points(points), "--sources");
            // Given sources make the whole pattern, as they stand: nothing laid, joined or smoothed.
            document.set("veins.algorithm=auxin-open", "--sources")?;
            document.set("veins.guides.primary=none", "--sources")?;
            document.set("veins.smoothing=0", "--sources")?;
        }
        for assignment in &self.set {
            document.set(assignment, "--set")?;
        }
        Ok(document)
    }

    fn import_outline(
        &self,
        path: &Path,
        document: &mut Document,
        context: &Context<'_>,
    ) -> Result<(), Failure> {
        let kind = self.outline_kind.kind();
        // Any length will do: each leaf scales the outline to the length it draws.
        let options = OutlineOptions { kind, root: self.root, y_up: self.y_up, length_mm: 100.0 };
        let imported =
            outline::import(path, &options).map_err(|error| Failure::Input(error.to_string()))?;
        for note in &imported.notes {
            context.say(&format!("{}: {note}", path.display()));
        }
        document.insert("margin.kind", Value::Text("polygon".into()), "--outline");
        document.insert("margin.polygon_mm", Value::Points(imported.polygon_mm), "--outline");
        document.insert("margin.cuts_mm", Value::Lines(imported.cuts_mm), "--outline");
        Ok(())
    }
}

/// Puts the margin of a named shape into a document.
fn insert_shape(name: &str, document: &mut Document) -> Result<(), Failure> {
    let Some(shape) = shapes::find(name) else {
        let names: Vec<String> = shapes::all().into_iter().map(|shape| shape.name).collect();
        let hint = match venation::document::nearest_word(name, names.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => {
                "they are waist-base-apex, as in ovate-cordate-straight, or botanists' names, as \
                     in reniform"
                    .to_owned()
            }
        };
        return Err(Failure::Input(format!("--shape: there is no shape `{name}`; {hint}")));
    };
    let length = document.value("margin.length_mm");
    document.insert_group("margin", &MarginSpec::default().shaped(&shape), "--shape");
    if let Some(length) = length {
        document.insert("margin.length_mm", length, "--shape");
    }
    Ok(())
}

/// One leaf of a document; its name will do for files, and it is known what to write of it.
pub(crate) fn resolve(document: &Document, seed: u64) -> Result<LeafSpec, Failure> {
    Ok(resolve_varied(document, seed)?.0)
}

/// The same, and by how many percent its margin is perturbed where that was asked for.
pub(crate) fn resolve_varied(
    document: &Document,
    seed: u64,
) -> Result<(LeafSpec, Option<f64>), Failure> {
    let (spec, varied) = document.resolve_varied(Seed(seed))?;
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_".contains(c);
    if spec.name.is_empty() || spec.name.len() > 100 || !spec.name.chars().all(plain) {
        let problem = format!(
            "name = `{}`: files are called after it, so it takes 1 to 100 letters, digits, - and _",
            spec.name
        );
        return Err(at_fault(document, "name", &problem));
    }
    if let Err(error) = spec.output.resolve() {
        return Err(at_fault(document, error.key(), &error.to_string()));
    }
    Ok((spec, varied))
}

/// What is wrong with the value of a key, and where it was given.
fn at_fault(document: &Document, key: &str, problem: &str) -> Failure {
    Failure::Input(match document.origin(key) {
        Some(origin) => format!("{origin}: {problem}"),
        None => problem.to_owned(),
    })
}
