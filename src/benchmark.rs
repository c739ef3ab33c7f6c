//! Measures of vein growth: a standard workload of any size, workloads from files, and the
//! performance tables of Foster's report. `venation bench` and `benches/veins.rs` both call this.
//!
//! The standard workload: one leaf-like blade, an ellipse twice as long as wide, and N auxin sources
//! by dart throwing at least 0.7 s apart, where s = √(area / N); kill distance 0.8 s, node step
//! 0.4 s, attraction distance 4 s, no growth of the blade. It scales so that the picture is the same
//! at every N, only finer.

mod foster;

use std::time::Instant;

use cpu_time::{ProcessTime, ThreadTime};
use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::geometry::point_grid::PointGrid;
use crate::geometry::polygon;
use crate::geometry::scatter::PolygonScatter;
use crate::growth::{GrowingBlade, GrowthError, GrowthSpec, GrowthType};
use crate::margin::{Margin, MarginError};
use crate::observer::Silent;
use crate::point_list;
use crate::seed::{Seed, Stage};
use crate::veins::{self, Unreached, VeinError, VeinGraph, VeinSpec};
pub use foster::{FOSTER_GAVE_UP, FOSTER_REACH, FosterRow, foster_suite, run_foster};

/// Sides of the polygon that stands for the ellipse.
const SIDES: usize = 256;

/// Length of the standard blade (mm).
pub const LENGTH_MM: f64 = 100.0;

/// Steps after which a run on a standing blade is given up; it stops by itself when nothing moves.
const MOST_STEPS: u64 = 100_000;

/// What is measured: a standing blade, sources and the lengths of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Workload {
    /// The blade.
    pub margin: Margin,
    /// Where the vein enters (mm).
    pub root: DVec2,
    /// Sources and lengths.
    pub veins: VeinSpec,
}

/// What a run took and made.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measure {
    /// Auxin sources.
    pub sources: usize,
    /// Vein nodes.
    pub nodes: usize,
    /// Joins, where veins met.
    pub joins: usize,
    /// Nodes that stand where another does, which there should be none of.
    pub coincident: usize,
    /// Steps made.
    pub steps: u64,
    /// Living sources, summed over the steps.
    pub source_steps: u64,
    /// Time of the growth alone, without widths (s, wall clock).
    pub seconds: f64,
    /// Seconds of the processor, which a busy machine does not stretch.
    pub cpu_seconds: f64,
    /// Sources that were not reached, by reason.
    pub unreached: Unreached,
}

/// Why there is no measure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BenchmarkError {
    /// The text of a workload cannot be read.
    #[error("no workload: {0}")]
    Text(String),
    /// The outline is no margin.
    #[error(transparent)]
    Margin(#[from] MarginError),
    /// The blade cannot grow.
    #[error(transparent)]
    Growth(#[from] GrowthError),
    /// The veins cannot grow.
    #[error(transparent)]
    Veins(#[from] VeinError),
}

/// An ellipse [`LENGTH_MM`] long and half as wide.
#[must_use]
pub fn standard_blade() -> Margin {
    let at = |i: usize| {
        let angle = std::f64::consts::TAU * i as f64 / SIDES as f64;
        DVec2::new(0.25 * libm::sin(angle), 0.5 - 0.5 * libm::cos(angle)) * LENGTH_MM
    };
    let mut outline: Vec<DVec2> = (0..SIDES).map(at).collect();
    outline[0] = DVec2::ZERO;
    outline[SIDES / 2].x = 0.0;
    Margin::new(outline, SIDES / 2, Vec::new(), "").expect("an ellipse is a margin")
}

/// The standard workload with `sources` sources.
#[must_use]
pub fn standard_workload(sources: usize, seed: Seed) -> Workload {
    let margin = standard_blade();
    let spacing = (margin.area_mm2() / sources.max(1) as f64).sqrt();
    let least = 0.7 * spacing;
    let scatter = PolygonScatter::new(margin.outline());
    let mut grid = PointGrid::new(margin.bounds(), least);
    let mut places = Vec::with_capacity(sources);
    let mut rng = seed.stream(Stage::AuxinSources);
    while places.len() < sources {
        let p = scatter.point(rng.unit(), rng.unit());
        let near = |_, q: DVec2| p.distance_squared(q) < least * least;
        if polygon::contains(margin.outline(), p)
            && !grid.any_near(&places, p, DVec2::splat(least), near)
        {
            grid.push(p);
            places.push(p);
        }
    }
    Workload::new(margin, DVec2::new(0.0, 0.005) * LENGTH_MM, spacing, places.into_iter())
}

impl Workload {
    fn new(
        margin: Margin,
        root: DVec2,
        spacing: f64,
        sources: impl Iterator<Item = DVec2>,
    ) -> Self {
        let veins = VeinSpec {
            kill_distance_mm: 0.8 * spacing,
            node_step_mm: 0.4 * spacing,
            attraction_distance_mm: 4.0 * spacing,
            sources_mm: sources.map(|p| p.to_array()).collect(),
            ..VeinSpec::default()
        };
        Self { margin, root, veins }
    }

    /// A workload from the text of its two files: the parameters (JSON with `polygon`, `root`,
    /// `kill`, `segment` and `attraction`, in lengths of the blade) and the sources (a line `x,y`
    /// each).
    ///
    /// # Errors
    ///
    /// [`BenchmarkError::Text`] says what cannot be read and where.
    pub fn parse(parameters: &str, sources: &str) -> Result<Self, BenchmarkError> {
        #[derive(Deserialize)]
        struct Parameters {
            polygon: Vec<[f64; 2]>,
            root: [f64; 2],
            kill: f64,
            segment: f64,
            attraction: f64,
        }
        let text = |problem: String| BenchmarkError::Text(problem);
        let read: Parameters = serde_json::from_str(parameters).map_err(|e| text(e.to_string()))?;
        let outline: Vec<DVec2> =
            read.polygon.iter().map(|&p| DVec2::from(p) * LENGTH_MM).collect();
        let apex = (0..outline.len())
            .max_by(|&i, &j| outline[i].y.total_cmp(&outline[j].y))
            .ok_or_else(|| text("the polygon is empty".into()))?;
        let mut outline = outline;
        // Printed numbers miss the axis by a rounding error.
        for i in [0, apex] {
            if outline[i].x.abs() < 1e-9 * LENGTH_MM {
                outline[i].x = 0.0;
            }
        }
        let margin = Margin::new(outline, apex, Vec::new(), "mend polygon there")?;
        let places = point_list::parse(sources).map_err(|e| text(format!("sources, {e}")))?;
        let places = places.iter().map(|p| p.map(|x| x * LENGTH_MM)).collect();
        let veins = VeinSpec {
            kill_distance_mm: read.kill * LENGTH_MM,
            node_step_mm: read.segment * LENGTH_MM,
            attraction_distance_mm: read.attraction * LENGTH_MM,
            sources_mm: places,
            ..VeinSpec::default()
        };
        Ok(Self { margin, root: DVec2::from(read.root) * LENGTH_MM, veins })
    }
}

/// Grows a workload once.
///
/// # Errors
///
/// [`BenchmarkError`] when it cannot grow.
pub fn run(workload: &Workload) -> Result<Measure, BenchmarkError> {
    let growth = GrowthSpec {
        r#type: GrowthType::None,
        total_steps: MOST_STEPS,
        start_step: 0,
        ..GrowthSpec::default()
    };
    let blade = GrowingBlade::new(workload.margin.clone(), &growth)?;
    measure(&workload.veins, &blade, workload.root, Seed(42))
}

fn measure(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    root: DVec2,
    seed: Seed,
) -> Result<Measure, BenchmarkError> {
    let mut rng = seed.stream(Stage::AuxinSources);
    let mut roots = VeinGraph::new();
    roots.add_root(root);
    let (wall, thread, process) = (Instant::now(), ThreadTime::now(), ProcessTime::now());
    let grown = veins::auxin::grow(spec, blade, roots, &mut rng, &mut Silent)?;
    let seconds = wall.elapsed().as_secs_f64();
    // With several threads all of the process works on this.
    let alone = rayon::current_num_threads() == 1;
    let processor = if alone { thread.elapsed() } else { process.elapsed() };
    let cpu_seconds = processor.as_secs_f64();
    Ok(Measure {
        sources: grown.sources,
        nodes: grown.graph.len(),
        joins: grown.graph.joins().len(),
        coincident: coincident(
            grown.graph.positions(),
            veins::auxin::LEAST_BETWEEN_NODES * spec.node_step_mm,
        ),
        steps: grown.nodes_after_step.len() as u64,
        source_steps: grown.source_steps,
        seconds,
        cpu_seconds,
        unreached: grown.unreached,
    })
}

/// How many nodes have another within a distance, later in the order of x.
fn coincident(nodes: &[DVec2], distance: f64) -> usize {
    let mut order: Vec<u32> = (0..nodes.len() as u32).collect();
    let at = |i: u32| nodes[i as usize];
    order.sort_unstable_by(|&i, &j| at(i).x.total_cmp(&at(j).x));
    let has_another = |&place: &usize| {
        let p = at(order[place]);
        let beside = order[place + 1..].iter().map(|&i| at(i));
        beside.take_while(|q| q.x - p.x < distance).any(|q| p.distance(q) < distance)
    };
    (0..order.len()).filter(has_another).count()
}

/// The slope of ln `cpu_seconds` over ln `sources`, by least squares; `None` for fewer than two sizes.
#[must_use]
pub fn exponent(measures: &[Measure]) -> Option<f64> {
    let points: Vec<(f64, f64)> =
        measures.iter().map(|m| (libm::log(m.sources as f64), libm::log(m.cpu_seconds))).collect();
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (mut xy, mut xx) = (0.0, 0.0);
    for p in &points {
        xy += (p.0 - x) * (p.1 - y);
        xx += (p.0 - x) * (p.0 - x);
    }
    (xx > 0.0).then(|| xy / xx)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_standard_workload_is_used_up_but_for_a_few_beyond_reach() {
        let measure = run(&standard_workload(1000, Seed(1))).expect("grows");
        assert_eq!(measure.sources, 1000);
        assert!((1200..1700).contains(&measure.nodes), "{measure:?}");
        assert!(measure.unreached.total() < 60, "{measure:?}");
    }

    #[test]
    fn nodes_in_one_place_are_counted_once_for_each_but_the_last() {
        let nodes = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1e-6, 1.0), (1.0, 1e-6), (1.0, 0.0)];
        let nodes: Vec<DVec2> = nodes.iter().map(|&p| DVec2::from(p)).collect();
        assert_eq!(coincident(&nodes, 1e-3), 3);
        assert_eq!(coincident(&nodes, 0.0), 0);
    }

    #[test]
    fn the_exponent_of_a_square_law_is_two() {
        let measure = |n: usize| Measure {
            sources: n,
            nodes: n,
            joins: 0,
            coincident: 0,
            steps: 1,
            source_steps: n as u64,
            seconds: 1.0,
            cpu_seconds: (n * n) as f64,
            unreached: Unreached::default(),
        };
        let found = exponent(&[measure(10), measure(100), measure(1000)]).expect("three sizes");
        assert!((found - 2.0).abs() < 1e-12);
        assert_eq!(exponent(&[measure(10)]), None);
    }

    #[test]
    fn a_broken_line_of_sources_is_named() {
        let parameters = r#"{"polygon": [[0,0],[1,0],[1,1],[0,1]], "root": [0,0],
            "kill": 0.1, "segment": 0.05, "attraction": 1}"#;
        let error = Workload::parse(parameters, "0.1,0.2\n0.3;0.4\n").expect_err("broken");
        assert!(!error.to_string().is_empty());
    }
}
