//! What a comparison measures: as CSV, as JSON, and means for the person.

use serde_json::{Value, json};
use venation::veins::metrics::VeinMetrics;
use venation::veins::metrics::hierarchy::Hierarchy;

use super::Cell;
use super::cases::By;

pub(super) fn table(by: By, cells: &[Cell]) -> String {
    let mut text = format!(
        "{},seed,nodes,tips,sinuosity,vein_length_mm,tip_step,unreached_sources,midrib_sinuosity,\
         secondaries_right,secondaries_left,secondary_sinuosity,spacing_variation\n",
        by.word()
    );
    for cell in cells {
        let m = &cell.metrics;
        text += &format!(
            "{},{},{},{},{:.5},{:.2},{:.4},{},{}\n",
            cell.case.label(),
            cell.seed,
            m.nodes,
            m.tips,
            m.sinuosity,
            m.length_mm,
            m.apex_reached_at,
            m.unreached_sources,
            cell.hierarchy.map_or_else(
                || ",,,,".to_owned(),
                |h| {
                    let [right, left] = h.secondaries;
                    let (rib, side) = (h.midrib_sinuosity, h.secondary_sinuosity);
                    format!("{rib:.5},{right},{left},{side:.5},{:.4}", h.spacing_variation)
                }
            )
        );
    }
    text
}

/// The same as a list of records; the measures of a hierarchy are null where there is no midrib.
pub(super) fn records(cells: &[Cell]) -> Vec<Value> {
    let record = |cell: &Cell| {
        let (m, h) = (&cell.metrics, cell.hierarchy);
        json!({
            "case": cell.case.label(),
            "seed": cell.seed,
            "nodes": m.nodes,
            "tips": m.tips,
            "sinuosity": m.sinuosity,
            "vein_length_mm": m.length_mm,
            "tip_step": m.apex_reached_at,
            "unreached_sources": m.unreached_sources,
            "midrib_sinuosity": h.map(|h| h.midrib_sinuosity),
            "secondaries_right": h.map(|h| h.secondaries[0]),
            "secondaries_left": h.map(|h| h.secondaries[1]),
            "secondary_sinuosity": h.map(|h| h.secondary_sinuosity),
            "spacing_variation": h.map(|h| h.spacing_variation),
        })
    };
    cells.iter().map(record).collect()
}

/// Means over the seeds, for the person.
pub(super) fn summary(by: By, cells: &[Cell]) -> String {
    if by == By::Emergence {
        return hierarchies(cells);
    }
    let width = by.cases().iter().map(|case| case.label().len() + 1).fold(12, usize::max);
    let mut text = format!(
        "{:width$} {:>7} {:>7} {:>9} {:>9}\n",
        by.word(),
        "nodes",
        "tips",
        "sinuosity",
        "tip step"
    );
    for case in by.cases() {
        let these: Vec<&Cell> = cells.iter().filter(|cell| cell.case == case).collect();
        let mean = |value: fn(&VeinMetrics) -> f64| {
            these.iter().map(|cell| value(&cell.metrics)).sum::<f64>() / these.len() as f64
        };
        text += &format!(
            "{:width$} {:>7.0} {:>7.0} {:>9.4} {:>8.0}%\n",
            case.label(),
            mean(|m| m.nodes as f64),
            mean(|m| m.tips as f64),
            mean(|m| m.sinuosity),
            mean(|m| 100.0 * m.apex_reached_at)
        );
    }
    text
}

/// The same for what stands out in a hierarchy of veins.
fn hierarchies(cells: &[Cell]) -> String {
    let mut text = format!(
        "{:16} {:>7} {:>11} {:>11} {:>15} {:>8}\n",
        "emergence", "midrib", "secondaries", "difference", "their sinuosity", "spacing"
    );
    for case in By::Emergence.cases() {
        let these: Vec<Hierarchy> = cells
            .iter()
            .filter(|cell| cell.case == case)
            .filter_map(|cell| cell.hierarchy)
            .collect();
        let mean = |value: &dyn Fn(&Hierarchy) -> f64| {
            these.iter().map(value).sum::<f64>() / these.len().max(1) as f64
        };
        text += &format!(
            "{:16} {:>7.4} {:>11.1} {:>11.1} {:>15.4} {:>8.3}\n",
            case.label(),
            mean(&|h| h.midrib_sinuosity),
            mean(&|h| h.secondaries.iter().sum::<usize>() as f64),
            mean(&|h| h.difference() as f64),
            mean(&|h| h.secondary_sinuosity),
            mean(&|h| h.spacing_variation)
        );
    }
    text
}
