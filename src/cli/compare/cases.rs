//! What differs from panel to panel: one case each, in the order of the sheet.

use venation::error::Error;
use venation::growth::{GrowthType, RatePattern};
use venation::margin::{self, MarginSpec, shapes};
use venation::seed::Seed;
use venation::spec::LeafSpec;
use venation::veins::Algorithm;
use venation::veins::guides::PrimaryType;
use venation::veins::particles::patterns::Pattern;

/// What differs from panel to panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum By {
    /// The growth types.
    Growth,
    /// Particles: the four scatter patterns × spacings of 3, 5, 7 and 10 pixels (Rodkaew 2002, fig. 9).
    Scatter,
    /// The vein algorithms.
    Algorithm,
    /// Nothing but the seed: a contact sheet of what a preset makes.
    Seed,
    /// Shapes of unilobed blades: the fifty types and twelve names (Garg 2011, tables 4.2 and 4.3).
    Shape,
    /// One leaf from spring to litter: front, back and against the light; `--frames N` for a film.
    Season,
    /// What makes veins straight, symmetric and ordered where growth alone makes them.
    Emergence,
}

/// One thing more from panel to panel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Emergence {
    Plain,
    Straight,
    Symmetric,
    Convergence,
    Phases,
    Basipetal,
}

/// What one panel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Case {
    Growth(GrowthType),
    Scatter(Pattern, u64),
    Algorithm(Algorithm),
    /// The leaf as it is.
    Seed,
    /// By its place among all shapes.
    Shape(usize),
    Emergence(Emergence),
}

impl Emergence {
    const ALL: [Self; 6] = [
        Self::Plain,
        Self::Straight,
        Self::Symmetric,
        Self::Convergence,
        Self::Phases,
        Self::Basipetal,
    ];

    fn word(self) -> &'static str {
        match self {
            Self::Plain => "growth alone",
            Self::Straight => "+ straightness",
            Self::Symmetric => "+ symmetry",
            Self::Convergence => "+ convergence",
            Self::Phases => "+ phases",
            Self::Basipetal => "+ basipetal",
        }
    }

    /// Settings that the leaf does not have itself.
    fn apply(self, spec: &mut LeafSpec) -> Result<(), Error> {
        // Of its width alone: whatever the teeth are.
        let width = margin::build(&spec.margin, Seed(0))?.bounds().size().x;
        // The share of its size at which the last convergence points appear.
        let (start, total) = (spec.growth.start_step as f64, spec.growth.total_steps as f64);
        let young = (start + spec.veins.convergence.until * (total - start).max(0.0)) / total;
        let has = |more: Self| self as u8 >= more as u8;
        if has(Self::Basipetal) {
            spec.growth.r#type = GrowthType::NonUniform;
            spec.growth.rates.pattern = RatePattern::Basipetal;
        }
        alone(spec)?;
        let veins = &mut spec.veins;
        let or = |value: f64, default: f64| if value == 0.0 { default } else { value };
        veins.straightness =
            if has(Self::Straight) { or(veins.straightness, STRAIGHTNESS) } else { 0.0 };
        veins.symmetry = if has(Self::Symmetric) { or(veins.symmetry, SYMMETRY) } else { 0.0 };
        if !has(Self::Phases) {
            veins.phases.coarseness = 1.0;
        } else if veins.phases.coarseness == 1.0 {
            veins.phases.coarseness = COARSENESS;
        }
        let spacing = SPACING * width * young;
        veins.convergence.spacing_mm =
            if has(Self::Convergence) { or(veins.convergence.spacing_mm, spacing) } else { 0.0 };
        Ok(())
    }
}

/// Leaves the veins to growth, as in the papers. With no midrib to start from, they must cross the
/// whole blade in the steps there are.
fn alone(spec: &mut LeafSpec) -> Result<(), Error> {
    let length = margin::build(&spec.margin, Seed(0))?.length_mm();
    let steps = spec.growth.total_steps.saturating_sub(spec.growth.start_step).max(1) as f64;
    let veins = &mut spec.veins;
    veins.guides.primary = PrimaryType::None;
    veins.longest_step = 0.0;
    veins.node_step_mm = veins.node_step_mm.max(CROSSINGS * length / steps);
    veins.kill_distance_mm = veins.kill_distance_mm.max(veins.node_step_mm / 2.0);
    Ok(())
}

/// How often a vein could go from base to apex: it has turns to make, and sources to wait for.
const CROSSINGS: f64 = 1.6;

/// What `--by emergence` takes where a leaf says nothing: veins as straight and as alike on both sides
/// as most leaves', eight times as far apart at first.
const STRAIGHTNESS: f64 = 0.7;
const SYMMETRY: f64 = 0.8;
const COARSENESS: f64 = 8.0;

/// Between convergence points, in widths of the blade when the last of them appear.
const SPACING: f64 = 0.3;

/// The paper's spacings (pixels) and how many particles they gave, the number of the random pattern.
const SCATTERS: [(u64, u64); 4] = [(3, 1378), (5, 500), (7, 254), (10, 125)];

/// Sixty leaves on one sheet are shown no larger than this (pixels).
const SHAPE_PX: u64 = 256;

/// The area of the paper's ivy (pixels²): its counts times its spacings².
const IVY_PX2: f64 = 12_450.0;

/// The paper's step and merge radius (pixels).
const STEP_PX: f64 = 1.0;
const MERGE_PX: f64 = 2.0;

impl By {
    /// The word for it in titles and tables.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Growth => "growth",
            Self::Scatter => "scatter",
            Self::Algorithm => "algorithm",
            Self::Seed => "leaf",
            Self::Shape => "shape",
            Self::Season => "season",
            Self::Emergence => "emergence",
        }
    }

    pub(super) fn title(self) -> &'static str {
        match self {
            Self::Growth => "growth types",
            Self::Scatter => "particles by scatter pattern and spacing",
            Self::Algorithm => "vein algorithms",
            Self::Seed => "seeds",
            Self::Shape => "shapes of unilobed blades: waist-base-apex, and botanists' names",
            Self::Season => "season",
            Self::Emergence => "veins from growth alone",
        }
    }

    pub(super) fn cases(self) -> Vec<Case> {
        match self {
            Self::Growth => GrowthType::ALL.iter().map(|&growth| Case::Growth(growth)).collect(),
            Self::Scatter => SCATTERS
                .iter()
                .flat_map(|&(px, _)| Pattern::ALL.iter().map(move |&p| Case::Scatter(p, px)))
                .collect(),
            Self::Algorithm => Algorithm::ALL.iter().map(|&a| Case::Algorithm(a)).collect(),
            Self::Seed => vec![Case::Seed],
            Self::Shape => (0..shapes::all().len()).map(Case::Shape).collect(),
            // The year has a sheet of its own: the leaf grows once.
            Self::Season => Vec::new(),
            Self::Emergence => Emergence::ALL.map(Case::Emergence).to_vec(),
        }
    }

    /// Panels in a row of the sheet; 0 for one that is about as high as wide.
    pub(super) fn columns(self) -> usize {
        match self {
            Self::Scatter => Pattern::ALL.len(),
            Self::Seed => 0,
            Self::Growth | Self::Algorithm | Self::Season | Self::Emergence => self.cases().len(),
            // The types of one waist fill two rows.
            Self::Shape => 8,
        }
    }
}

impl Case {
    pub(super) fn label(self) -> String {
        match self {
            Self::Growth(growth) => growth.to_string(),
            Self::Scatter(pattern, px) => format!("{pattern} {px} px"),
            Self::Algorithm(algorithm) => algorithm.to_string(),
            Self::Seed => "leaf".to_owned(),
            Self::Shape(index) => shapes::all().swap_remove(index).name,
            Self::Emergence(emergence) => emergence.word().to_owned(),
        }
    }

    /// Makes a leaf the one of this case.
    pub(super) fn apply(self, spec: &mut LeafSpec) -> Result<(), Error> {
        match self {
            Self::Growth(growth) => {
                spec.growth.r#type = growth;
                if spec.veins.guides.primary == PrimaryType::None {
                    alone(spec)?;
                }
            }
            Self::Algorithm(algorithm) => spec.veins.algorithm = algorithm,
            Self::Seed => {}
            Self::Shape(index) => {
                // The shape alone, as `--shape` gives it: no teeth, waves or bend of the leaf's own.
                let length_mm = spec.margin.length_mm;
                let plain = MarginSpec { length_mm, ..MarginSpec::default() };
                spec.margin = plain.shaped(&shapes::all()[index]);
                spec.texture.size_px = spec.texture.size_px.min(SHAPE_PX);
            }
            Self::Emergence(emergence) => emergence.apply(spec)?,
            Self::Scatter(pattern, px) => {
                // The paper's pixel: that in which this blade is as large as its ivy.
                let pixel = (margin::build(&spec.margin, Seed(1))?.area_mm2() / IVY_PX2).sqrt();
                spec.veins.algorithm = Algorithm::Particles;
                // As printed: every particle has its vein.
                (spec.veins.scale, spec.veins.least_veinlet) = (1.0, 0.0);
                spec.veins.longest_step = 0.0;
                let particles = &mut spec.veins.particles;
                particles.pattern = pattern;
                particles.spacing_mm = px as f64 * pixel;
                let given = SCATTERS.iter().find(|(spacing, _)| *spacing == px);
                let random = pattern == Pattern::Random;
                particles.count = given.map_or(0, |&(_, count)| if random { count } else { 0 });
                particles.step_mm = STEP_PX * pixel;
                particles.merge_radius_mm = MERGE_PX * pixel;
            }
        }
        Ok(())
    }
}
