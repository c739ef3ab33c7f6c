//! Documents as TOML.

use std::fmt::Write as _;

use super::{Comments, Document, Value, parameters};
use crate::parameter::{Kind, Parameter, RECORD};

pub(super) fn toml(document: &Document, comments: Comments) -> String {
    let mut text = String::new();
    let version = env!("CARGO_PKG_VERSION");
    let _ = writeln!(text, "version = \"{version}\"");
    if let Some(seed) = document.seed {
        let _ = writeln!(text, "seed = {seed}");
    }
    if let Some(vary) = document.vary {
        if comments == Comments::Full {
            let _ =
                writeln!(text, "# Every number of the margin perturbed by up to so many percent.");
        }
        let _ = writeln!(text, "vary = {}", float(vary));
    }
    // Plain keys of a group must stand before the tables inside it.
    let mut group = String::new();
    for parameter in in_table_order() {
        if let Some((list, _)) = parameter.key.split_once(&format!(".{RECORD}.")) {
            if list != group {
                list.clone_into(&mut group);
                records(&mut text, document, list, comments);
            }
            continue;
        }
        let (table, name) = parameter.key.rsplit_once('.').unwrap_or(("", &parameter.key));
        if table != group {
            table.clone_into(&mut group);
            let _ = writeln!(text, "\n[{table}]");
        }
        let value = document.value(&parameter.key).expect("every parameter has a default");
        if comments == Comments::Full {
            let _ = writeln!(text, "# {}", comment(parameter));
        }
        let _ = writeln!(text, "{name} = {}", shown(&value));
    }
    text
}

/// The records of a list, one table each; when there are none, what one would hold as a comment.
fn records(text: &mut String, document: &Document, list: &str, comments: Comments) {
    let lists = super::records::lists();
    let keys = lists.iter().find(|(name, _)| *name == list).map_or(&[][..], |(_, keys)| keys);
    let count = document.record_count(list);
    if count == 0 && comments == Comments::Full {
        let _ = writeln!(text, "\n# [[{list}]]");
        for (name, parameter) in keys {
            let value = document.value(&parameter.key).expect("every parameter has a default");
            let _ = writeln!(text, "# {name} = {}  # {}", shown(&value), comment(parameter));
        }
    }
    for number in 1..=count {
        let _ = writeln!(text, "\n[[{list}]]");
        for (name, parameter) in keys {
            let value = document.value(&format!("{list}.{number}.{name}"));
            let value = value.expect("every parameter has a default");
            if comments == Comments::Full && number == 1 {
                let _ = writeln!(text, "# {}", comment(parameter));
            }
            let _ = writeln!(text, "{name} = {}", shown(&value));
        }
    }
}

/// Parameters so that each table's keys stand together, tables in order of first appearance.
fn in_table_order() -> Vec<&'static Parameter> {
    let table = |p: &Parameter| p.key.rsplit_once('.').map_or("", |(table, _)| table).to_owned();
    let mut order: Vec<String> = Vec::new();
    for parameter in parameters() {
        if !order.contains(&table(parameter)) {
            order.push(table(parameter));
        }
    }
    let mut list: Vec<&Parameter> = parameters().iter().collect();
    list.sort_by_key(|p| order.iter().position(|t| *t == table(p)));
    list
}

fn comment(parameter: &Parameter) -> String {
    let limits = match parameter.kind {
        Kind::Number { min, max, unit: "" } => format!(" [{min} to {max}]"),
        Kind::Number { min, max, unit } => format!(" [{min} to {max} {unit}]"),
        Kind::Count { min, max, unit: "" } => format!(" [{min} to {max}]"),
        Kind::Count { min, max, unit } => format!(" [{min} to {max} {unit}]"),
        Kind::OneOf(numbers) => {
            let numbers: Vec<String> = numbers.iter().map(u64::to_string).collect();
            format!(" [{}]", numbers.join(" | "))
        }
        Kind::Choice(words) => format!(" [{}]", words.join(" | ")),
        _ => String::new(),
    };
    format!("{}{limits}", parameter.doc)
}

fn shown(value: &Value) -> String {
    match value {
        Value::Number { low, high } if low == high => float(*low),
        Value::Number { low, high } => format!("[{}, {}]", float(*low), float(*high)),
        Value::Count { low, high } if low == high => low.to_string(),
        Value::Count { low, high } => format!("[{low}, {high}]"),
        Value::Text(text) => toml::Value::String(text.clone()).to_string(),
        Value::Flag(flag) => flag.to_string(),
        Value::Points(points) => points_text(points),
        Value::Lines(lines) => {
            let lines: Vec<String> = lines.iter().map(|line| points_text(line)).collect();
            format!("[{}]", lines.join(", "))
        }
    }
}

/// The shortest text that reads back as the same number, always with a point.
fn float(x: f64) -> String {
    format!("{x:?}")
}

fn points_text(points: &[[f64; 2]]) -> String {
    let points: Vec<String> =
        points.iter().map(|p| format!("[{}, {}]", float(p[0]), float(p[1]))).collect();
    format!("[{}]", points.join(", "))
}
