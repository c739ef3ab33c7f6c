//! From a document to one leaf: a value drawn for every range. A lobe that stands on each side is drawn
//! twice and becomes two.

use super::value::{self, from_plain};
use super::{Document, DocumentError, Entry, Value, parameters, records};
use crate::margin::instances;
use crate::margin::lobes::LobeSide;
use crate::parameter::Parameter;
use crate::seed::Seed;
use crate::spec::LeafSpec;

/// The leaf, and by how many percent its margin was perturbed where that was asked for.
pub(super) fn resolve(
    document: &Document,
    seed: Seed,
) -> Result<(LeafSpec, Option<f64>), DocumentError> {
    let mut tree = toml::Table::new();
    let value_of =
        |key: &str| drawn(&document.value(key).expect("every parameter has a default"), key, seed);
    for parameter in parameters().iter().filter(|p| !records::is_record(&p.key)) {
        insert(&mut tree, &parameter.key, value_of(&parameter.key));
    }
    for (list, keys) in records::lists() {
        let count = document.record_count(list);
        let mut items = Vec::with_capacity(count);
        for number in 1..=count {
            complete(document, list, number, count)?;
            let record = Record { document, list, number, keys: &keys };
            let right = record.drawn(seed);
            if right.get(SIDE).and_then(toml::Value::as_str) == Some(LobeSide::Each.word()) {
                let left = record.drawn_left(&right, asymmetry(&tree), seed);
                items.extend([on(right, LobeSide::Right), on(left, LobeSide::Left)]);
            } else {
                items.push(toml::Value::Table(right));
            }
        }
        insert(&mut tree, list, toml::Value::Array(items));
    }
    let spec: Result<LeafSpec, toml::de::Error> = toml::Value::Table(tree).try_into();
    let mut spec = spec.map_err(|error| DocumentError {
        origin: "leaf".into(),
        problem: error.message().to_owned(),
    })?;
    // The length is drawn: only now is it known what the polygon measures.
    spec.margin = spec.margin.at_length();
    let is_own = document.seed == Some(seed.0) && !document.varies_own_seed;
    let wanted = document.vary.filter(|percent| *percent > 0.0 && !is_own);
    let varied = wanted.map(|percent| {
        let (margin, varied) = instances::instance(&spec.margin, percent, seed);
        spec.margin = margin.at_length();
        varied
    });
    Ok((spec, varied))
}

/// A record of a document that is being drawn.
struct Record<'a> {
    document: &'a Document,
    list: &'static str,
    number: usize,
    keys: &'a [(&'static str, &'static Parameter)],
}

impl Record<'_> {
    fn key(&self, key: &str) -> String {
        format!("{}.{}.{key}", self.list, self.number)
    }

    fn value(&self, key: &str) -> Value {
        self.document.value(&self.key(key)).expect("every parameter has a default")
    }

    fn drawn(&self, seed: Seed) -> toml::Table {
        let mut record = toml::Table::new();
        for (key, _) in self.keys {
            insert(&mut record, key, drawn(&self.value(key), &self.key(key), seed));
        }
        record
    }

    /// What stands on the left where `right` stands on the right: its like at asymmetry 0, drawn for
    /// itself at 1.
    fn drawn_left(&self, right: &toml::Table, asymmetry: f64, seed: Seed) -> toml::Table {
        let mut left = right.clone();
        for (key, _) in self.keys {
            let stream = self.key(&format!("{}.{key}", LobeSide::Left.word()));
            let own = drawn(&self.value(key), &stream, seed);
            let like = drawn(&self.value(key), &self.key(key), seed);
            insert(&mut left, key, between(&like, own, asymmetry));
        }
        left
    }
}

/// Where a record of a lobe says on which side it stands.
const SIDE: &str = "side";

fn on(mut record: toml::Table, side: LobeSide) -> toml::Value {
    record.insert(SIDE.into(), toml::Value::String(side.word().into()));
    toml::Value::Table(record)
}

/// How far the left side of the margin is its own, as drawn.
fn asymmetry(tree: &toml::Table) -> f64 {
    let margin = tree.get("margin").and_then(|margin| margin.get("asymmetry"));
    margin.and_then(toml::Value::as_float).unwrap_or(1.0)
}

/// A number between that of the right side, at 0, and the left side's own, at 1.
fn between(right: &toml::Value, own: toml::Value, asymmetry: f64) -> toml::Value {
    match (right, &own) {
        (toml::Value::Float(right), toml::Value::Float(own)) => {
            let mixed = right + (own - right) * asymmetry;
            toml::Value::Float((mixed * ROUNDING).round() / ROUNDING)
        }
        _ => own,
    }
}

/// Refuses a list in which a record is missing.
fn complete(
    document: &Document,
    list: &str,
    number: usize,
    count: usize,
) -> Result<(), DocumentError> {
    let about =
        |n: usize| move |(key, _): &(&String, &Entry)| records::number_in(key, list) == Some(n);
    if document.entries.iter().any(|entry| about(number)(&entry)) {
        return Ok(());
    }
    let last = document.entries.iter().find(about(count));
    let (key, origin) = last.map_or((list, ""), |(key, entry)| (key.as_str(), &entry.origin));
    Err(DocumentError {
        origin: origin.to_owned(),
        problem: format!(
            "{key} is given, but {list}.{number} is not; they count from 1 without gaps"
        ),
    })
}

/// Drawn numbers are rounded to this many to the unit: a millionth of a millimetre or of a degree
/// shows nowhere, and keeps the files readable.
const ROUNDING: f64 = 1e6;

fn drawn(value: &Value, key: &str, seed: Seed) -> toml::Value {
    match value {
        Value::Number { low, high } if low == high => toml::Value::Float(*low),
        Value::Number { low, high } => {
            let x = seed.parameter(key).between(*low, *high);
            toml::Value::Float(((x * ROUNDING).round() / ROUNDING).clamp(*low, *high))
        }
        Value::Count { low, high } => {
            let span = (high - low) as f64 + 1.0;
            let step = if low == high { 0 } else { (seed.parameter(key).unit() * span) as u64 };
            toml::Value::Integer((low + step).min(*high) as i64)
        }
        Value::Text(text) => toml::Value::String(text.clone()),
        Value::Flag(flag) => toml::Value::Boolean(*flag),
        Value::Points(points) => points_value(points),
        Value::Lines(lines) => {
            toml::Value::Array(lines.iter().map(|line| points_value(line)).collect())
        }
    }
}

fn points_value(points: &[[f64; 2]]) -> toml::Value {
    let point = |p: &[f64; 2]| toml::Value::Array(p.map(toml::Value::Float).to_vec());
    toml::Value::Array(points.iter().map(point).collect())
}

fn insert(tree: &mut toml::Table, key: &str, value: toml::Value) {
    match key.split_once('.') {
        None => {
            tree.insert(key.to_owned(), value);
        }
        Some((group, rest)) => {
            let child = tree
                .entry(group.to_owned())
                .or_insert_with(|| toml::Value::Table(toml::Table::new()));
            let child = child.as_table_mut().expect("a group of parameters is a table");
            insert(child, rest, value);
        }
    }
}

pub(super) fn document_of(spec: &LeafSpec, seed: u64) -> Document {
    let tree = toml::Value::try_from(spec).expect("a leaf is plain data");
    let mut document = Document { seed: Some(seed), ..Document::default() };
    insert_tree(&mut document, "", &tree, "leaf");
    // What the tree leaves out (an empty list) is given as its default.
    for parameter in parameters().iter().filter(|p| !records::is_record(&p.key)) {
        if !document.gives(&parameter.key)
            && let Some(value) = value::default_of(&parameter.key)
        {
            document.insert(&parameter.key, value, "leaf");
        }
    }
    document
}

/// Gives the keys of `group` (all, when empty) the values of a tree of plain data.
pub(super) fn insert_tree(document: &mut Document, group: &str, tree: &toml::Value, origin: &str) {
    let inside = |key: &str| {
        let rest =
            if group.is_empty() { Some(key) } else { key.strip_prefix(group)?.strip_prefix('.') };
        rest.map(str::to_owned)
    };
    let plain = |parameter: &Parameter, key: String| Parameter { key, ..parameter.clone() };
    for parameter in parameters().iter().filter(|p| !records::is_record(&p.key)) {
        let Some(rest) = inside(&parameter.key) else { continue };
        if let Some(value) = from_plain(tree, &plain(parameter, rest)) {
            document.insert(&parameter.key, value, origin);
        }
    }
    for (list, keys) in records::lists() {
        let Some(rest) = inside(list) else { continue };
        document.start_list(list);
        let items = rest.split('.').try_fold(tree, |node, part| node.get(part));
        let items = items.and_then(toml::Value::as_array).map_or(&[][..], Vec::as_slice);
        for (i, item) in items.iter().enumerate() {
            for (key, parameter) in &keys {
                if let Some(value) = from_plain(item, &plain(parameter, (*key).to_owned())) {
                    document.insert(&format!("{list}.{}.{key}", i + 1), value, origin);
                }
            }
        }
    }
}
