//! Another program timed on the same sources: a floor of what the growth must cost, or a peer.
//!
//! It is called as `PROGRAM FOLDER N RUNS`, reads the sources from `FOLDER/auxin_N.csv` (a line `x,y`
//! each, in lengths of the blade) and prints a line of JSON with `cpu` (s) for each run.

use std::path::Path;
use std::process::Command;

use serde::Deserialize;
use venation::benchmark::{LENGTH_MM, Workload};

/// Median CPU-seconds of a program on the sources of a workload; else why there are none.
pub(super) fn seconds(program: &Path, workload: &Workload, runs: u32) -> Result<f64, String> {
    let folder = std::env::temp_dir().join(format!("venation-bench-{}", std::process::id()));
    let measured = measure(program, workload, runs, &folder);
    let _ = std::fs::remove_dir_all(&folder);
    measured.map_err(|problem| format!("{}: {problem}", program.display()))
}

fn measure(program: &Path, workload: &Workload, runs: u32, folder: &Path) -> Result<f64, String> {
    #[derive(Deserialize)]
    struct Line {
        cpu: f64,
    }
    let sources = &workload.veins.sources_mm;
    let mut text = String::new();
    for [x, y] in sources {
        text += &format!("{},{}\n", x / LENGTH_MM, y / LENGTH_MM);
    }
    std::fs::create_dir_all(folder).map_err(|error| error.to_string())?;
    let csv = folder.join(format!("auxin_{}.csv", sources.len()));
    std::fs::write(csv, text).map_err(|error| error.to_string())?;
    let output = Command::new(program)
        .arg(folder)
        .arg(sources.len().to_string())
        .arg(runs.to_string())
        .output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        return Err(format!("ended with {}", output.status));
    }
    let text = String::from_utf8_lossy(&output.stdout);
    let lines: Result<Vec<Line>, _> = text.lines().map(serde_json::from_str).collect();
    let mut lines = lines.map_err(|error| format!("prints no lines of JSON with cpu: {error}"))?;
    lines.sort_by(|a, b| a.cpu.total_cmp(&b.cpu));
    lines.get(lines.len() / 2).map(|line| line.cpu).ok_or_else(|| "prints nothing".into())
}
