//! The performance tables of Foster's report: what they vary, and the seconds that they print.

use glam::DVec2;

use super::{BenchmarkError, Measure, measure};
use crate::growth::{GrowingBlade, GrowthSpec, GrowthType};
use crate::margin::Margin;
use crate::seed::Seed;
use crate::veins::VeinSpec;

/// One row of Foster's performance tables.
#[derive(Debug, Clone, PartialEq)]
pub struct FosterRow {
    /// What the table varies.
    pub table: &'static str,
    /// The value in this row.
    pub value: &'static str,
    /// Seconds printed in the report; [`FOSTER_GAVE_UP`] where it gives only that limit.
    pub printed_seconds: f64,
    growth: GrowthSpec,
    veins: VeinSpec,
}

/// Runs longer than this (s) were not waited for in the report.
pub const FOSTER_GAVE_UP: f64 = 6000.0;

/// Length from the root to the farthest point of the outline in the suite (px; one px is one mm).
pub const FOSTER_REACH: f64 = 300.0;

/// The rows of the five tables. The base case: 600 darts per step, the three distances 5 px, node
/// step 1 px, isotropic growth over 600 steps from step 300.
#[must_use]
pub fn foster_suite() -> Vec<FosterRow> {
    let growth = GrowthSpec {
        total_steps: 600,
        start_step: 300,
        horizontal_steps: 600,
        vertical_steps: 600,
        ..GrowthSpec::default()
    };
    let veins = VeinSpec {
        spawn_rate: 600.0,
        source_spawn_distance_mm: 5.0,
        vein_spawn_distance_mm: 5.0,
        kill_distance_mm: 5.0,
        node_step_mm: 1.0,
        attraction_distance_mm: 0.0,
        ..VeinSpec::default()
    };
    let row = |table, value, printed_seconds, change: &dyn Fn(&mut GrowthSpec, &mut VeinSpec)| {
        let mut row = FosterRow {
            table,
            value,
            printed_seconds,
            growth: growth.clone(),
            veins: veins.clone(),
        };
        change(&mut row.growth, &mut row.veins);
        row
    };
    let mut rows = Vec::new();
    for (value, distance, seconds) in
        [("1 px", 1.0, 34.0), ("5 px", 5.0, 25.0), ("10 px", 10.0, 11.0), ("100 px", 100.0, 9.0)]
    {
        rows.push(row("auxin spawn distance", value, seconds, &|_, veins| {
            veins.source_spawn_distance_mm = distance;
        }));
    }
    for (value, distance, seconds) in
        [("1 px", 1.0, 43.0), ("5 px", 5.0, 25.0), ("10 px", 10.0, 18.0), ("100 px", 100.0, 3.0)]
    {
        rows.push(row("kill distance", value, seconds, &|_, veins| {
            veins.kill_distance_mm = distance;
        }));
    }
    for (value, rate, seconds) in
        [("1000", 1000.0, 212.0), ("600", 600.0, 25.0), ("400", 400.0, 12.0), ("100", 100.0, 8.0)]
    {
        rows.push(row("auxin spawn rate", value, seconds, &|_, veins| veins.spawn_rate = rate));
    }
    for (value, kind, seconds) in [
        ("marginal", GrowthType::Marginal, 38.0),
        ("isotropic", GrowthType::Isotropic, 25.0),
        ("anisotropic", GrowthType::Anisotropic, 26.0),
        ("none", GrowthType::None, 32.0),
    ] {
        rows.push(row("growth type", value, seconds, &|growth, _| {
            growth.r#type = kind;
            // Uneven, so that the row measures what it names.
            growth.horizontal_steps = 450;
        }));
    }
    for (value, steps, seconds) in [
        ("600", 600, 25.0),
        ("1000", 1000, 370.0),
        ("3000", 3000, FOSTER_GAVE_UP),
        ("5000", 5000, FOSTER_GAVE_UP),
    ] {
        rows.push(row("total steps", value, seconds, &|growth, _| growth.total_steps = steps));
    }
    rows
}

/// Grows one row on a margin, scaled so that its farthest point is [`FOSTER_REACH`] from the base.
///
/// # Errors
///
/// [`BenchmarkError`] when it cannot grow.
pub fn run_foster(row: &FosterRow, margin: &Margin) -> Result<Measure, BenchmarkError> {
    let farthest = margin.outline().iter().map(|p| p.length()).fold(0.0, f64::max);
    let scale = FOSTER_REACH / farthest;
    let scaled = |line: &[DVec2]| line.iter().map(|p| *p * scale).collect::<Vec<_>>();
    let cuts = margin.cuts().iter().map(|line| scaled(line)).collect();
    let margin = Margin::new(scaled(margin.outline()), margin.apex_index(), cuts, "")?;
    let blade = GrowingBlade::new(margin, &row.growth)?;
    let root = blade.root();
    measure(&row.veins, &blade, root, Seed(42))
}
