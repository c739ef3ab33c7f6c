//! The measures as text.

use std::io::Write;

use serde::Serialize;
use venation::benchmark::{self, Measure};

/// One line of the results.
#[derive(Debug, Serialize)]
pub(super) struct Line {
    /// What was run.
    pub(super) name: String,
    /// What the report prints (s).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) printed_seconds: Option<f64>,
    /// What the floor took (CPU-seconds).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) floor_seconds: Option<f64>,
    /// Peak memory less that before the run, for each node (bytes).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) bytes_per_node: Option<f64>,
    /// CPU time for each living source and step (ns).
    pub(super) ns_per_source_step: f64,
    #[serde(flatten)]
    pub(super) measure: Measure,
}

fn columns(cells: [String; 9]) -> String {
    let [name, sources, nodes, joins, steps, cpu, wall, memory, each] = cells;
    format!(
        "{name:<28}{sources:>8}{nodes:>9}{joins:>8}{steps:>7}{cpu:>10}{wall:>10}{memory:>8}{each:>9}"
    )
}

/// The heading.
pub(super) fn head(out: &mut dyn Write) -> std::io::Result<()> {
    let head = ["", "auxins", "nodes", "joins", "steps", "CPU s", "wall s", "B/node", "ns/act"];
    writeln!(out, "{}  not reached", columns(head.map(String::from)))
}

/// One line.
pub(super) fn print(out: &mut dyn Write, line: &Line) -> std::io::Result<()> {
    let m = &line.measure;
    let cells = [
        line.name.clone(),
        m.sources.to_string(),
        m.nodes.to_string(),
        m.joins.to_string(),
        m.steps.to_string(),
        format!("{:.4}", m.cpu_seconds),
        format!("{:.4}", m.seconds),
        line.bytes_per_node.map_or("-".into(), |bytes| format!("{bytes:.0}")),
        format!("{:.1}", line.ns_per_source_step),
    ];
    let mut more = match line.printed_seconds {
        Some(seconds) if seconds >= benchmark::FOSTER_GAVE_UP => {
            format!("  (report: more than {seconds} s)")
        }
        Some(seconds) => format!("  (report: {seconds} s)"),
        None => String::new(),
    };
    if let Some(floor) = line.floor_seconds {
        more += &format!("  (floor: {floor:.4} s, {:.2} times that)", m.cpu_seconds / floor);
    }
    if m.coincident > 0 {
        more += &format!("  ({} nodes where another is)", m.coincident);
    }
    writeln!(out, "{}  {}{more}", columns(cells), m.unreached)
}

/// All lines for a spreadsheet.
pub(super) fn csv(lines: &[Line]) -> String {
    let mut text = String::from(
        "name,printed_seconds,floor_seconds,auxins,nodes,joins,coincident,steps,cpu_seconds,seconds,\
         bytes_per_node,ns_per_source_step,outside,too_young,out_of_reach,hidden,unfinished\n",
    );
    let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
    for line in lines {
        let (m, left) = (&line.measure, &line.measure.unreached);
        text += &format!(
            "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
            line.name,
            number(line.printed_seconds),
            number(line.floor_seconds),
            m.sources,
            m.nodes,
            m.joins,
            m.coincident,
            m.steps,
            m.cpu_seconds,
            m.seconds,
            number(line.bytes_per_node),
            line.ns_per_source_step,
            left.outside,
            left.too_young,
            left.out_of_reach,
            left.hidden,
            left.unfinished
        );
    }
    text
}
