//! TOML and `key=value` into checked values, with the place of every mistake.

use std::num::ParseIntError;

use toml::de::{DeArray, DeTable, DeValue};

use super::records::{self, find};
use super::value::kind_in_words;
use super::{Document, DocumentError, Entry, Value, parameters};
use crate::parameter::{Kind, Parameter, RECORD};
use crate::spelling::{LIKE_A_KEY, likeness, nearest};

/// Keys of a file that are not knobs of the leaf.
const SEED: &str = "seed";
const VERSION: &str = "version";
const VARY: &str = "vary";

pub(super) fn document(text: &str, origin: &str) -> Result<Document, DocumentError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let line_of = |at: usize| text[..at.min(text.len())].matches('\n').count() + 1;
    let table = DeTable::parse(text).map_err(|error| DocumentError {
        origin: format!("{origin}:{}", error.span().map_or(1, |span| line_of(span.start))),
        problem: error.message().lines().collect::<Vec<_>>().join("; "),
    })?;
    let mut reader = Reader { origin, line_of: &line_of, document: Document::new() };
    reader.table("", table.get_ref())?;
    Ok(reader.document)
}

struct Reader<'a> {
    origin: &'a str,
    line_of: &'a dyn Fn(usize) -> usize,
    document: Document,
}

impl Reader<'_> {
    fn table(&mut self, prefix: &str, table: &DeTable<'_>) -> Result<(), DocumentError> {
        // As they stand in the file: what is wrong first is told first.
        let mut entries: Vec<_> = table.iter().collect();
        entries.sort_by_key(|(name, _)| name.span().start);
        for (name, value) in entries {
            let origin = format!("{}:{}", self.origin, (self.line_of)(name.span().start));
            let key = format!("{prefix}{}", name.get_ref());
            let fail = |problem: String| DocumentError { origin: origin.clone(), problem };
            match value.get_ref() {
                DeValue::Table(inner) => {
                    if !records::is_group(&key) {
                        return Err(fail(unknown_group(&key)));
                    }
                    self.table(&format!("{key}."), inner)?;
                }
                DeValue::Array(items) if records::is_list(&key) => self.records(&key, items)?,
                // The whole range of the command line: more than TOML asks its readers to know.
                value if key == SEED => {
                    let seed = integer(value, u64::from_str_radix);
                    let wrong =
                        || fail(format!("{SEED} takes a whole number from 0 to {}", u64::MAX));
                    self.document.seed = Some(seed.ok_or_else(wrong)?);
                }
                _ if key == VERSION => {}
                value if key == VARY => {
                    let text = match value {
                        DeValue::String(text) => text.to_string(),
                        value => float(value).map_or_else(String::new, |x| x.to_string()),
                    };
                    self.document.vary = Some(percent(&text).map_err(fail)?);
                }
                value => {
                    let parameter = find(&key).ok_or_else(|| fail(unknown(&key)))?;
                    let value = read(value, &parameter).map_err(fail)?;
                    self.document.entries.insert(key, Entry { value, origin });
                }
            }
        }
        Ok(())
    }
}

impl Reader<'_> {
    /// `[[list]]`, `[[list]]`, …: all the records of a list.
    fn records(&mut self, list: &str, items: &DeArray<'_>) -> Result<(), DocumentError> {
        self.document.start_list(list);
        for (i, item) in items.iter().enumerate() {
            let origin = format!("{}:{}", self.origin, (self.line_of)(item.span().start));
            let fail = |problem: String| DocumentError { origin: origin.clone(), problem };
            let DeValue::Table(inner) = item.get_ref() else {
                return Err(fail(format!("{list} takes tables: write [[{list}]] over each")));
            };
            if i == records::MOST {
                return Err(fail(format!("{list} has {} records; the most is {i}", items.len())));
            }
            self.table(&format!("{list}.{}.", i + 1), inner)?;
            // A record that gives nothing is one all the same.
            if self.document.record_count(list) == i {
                let listed = records::lists().into_iter().find(|(name, _)| *name == list);
                let (first, parameter) = listed.expect("a list").1[0];
                let value = super::value::default_of(&parameter.key).expect("listed");
                let entry = Entry { value, origin };
                self.document.entries.insert(format!("{list}.{}.{first}", i + 1), entry);
            }
        }
        Ok(())
    }
}

/// The percentage of `vary=20` or `vary=20%`; `None` for another key.
pub(super) fn variation(text: &str, origin: &str) -> Result<Option<f64>, DocumentError> {
    match text.split_once('=') {
        Some((key, value)) if key.trim() == VARY => {
            let fail = |problem| DocumentError { origin: origin.to_owned(), problem };
            percent(value).map(Some).map_err(fail)
        }
        _ => Ok(None),
    }
}

fn percent(text: &str) -> Result<f64, String> {
    let text = text.trim();
    let number = text.strip_suffix('%').unwrap_or(text).trim().parse::<f64>();
    match number {
        Ok(x) if (0.0..=100.0).contains(&x) => Ok(x),
        Ok(x) => Err(format!("{VARY} = {x} is outside 0 to 100 %")),
        Err(_) => Err(format!("{VARY} = `{text}`: it takes a percentage, as 20 or 20%")),
    }
}

pub(super) fn assignment(text: &str, origin: &str) -> Result<(String, Value), DocumentError> {
    let fail = |problem: String| DocumentError { origin: origin.to_owned(), problem };
    let Some((key, value)) = text.split_once('=') else {
        return Err(fail(format!("`{text}` is not key=value")));
    };
    let (key, value) = (key.trim(), value.trim());
    let parameter = find(key).ok_or_else(|| fail(unknown(key)))?;
    let value = match parameter.kind {
        Kind::Text | Kind::Choice(_) => Value::Text(value.trim_matches('"').to_owned()),
        Kind::Flag => {
            let flag = value.parse().map_err(|_| fail(format!("{key} takes true or false")))?;
            Value::Flag(flag)
        }
        _ if value.starts_with('[') => {
            let line = format!("x = {value}");
            let table = DeTable::parse(&line).map_err(|_| {
                fail(format!("{key} = {value}: not {}", kind_in_words(&parameter.kind)))
            })?;
            read(table.get_ref()["x"].get_ref(), &parameter).map_err(fail)?
        }
        _ => number_text(value, &parameter).map_err(fail)?,
    };
    check(value, &parameter).map(|value| (key.to_owned(), value)).map_err(fail)
}

/// So many letters of a word say which it is.
const BEGUN: usize = 5;

fn unknown(key: &str) -> String {
    fn last_of(key: &str) -> &str {
        key.rsplit('.').next().unwrap_or(key)
    }
    let keys = || parameters().iter().map(|p| p.key.as_str());
    let last = last_of(key);
    let plain = records::template(key);
    let plain = plain.as_deref().unwrap_or(key);
    // Units are forgotten first.
    let is_begun = |known: &&str| known.strip_prefix(plain).is_some_and(|rest| !rest.contains('.'));
    if let Some(begun) = keys().find(is_begun).filter(|_| last.len() >= BEGUN) {
        return unknown_but(key, Some(begun));
    }
    let by_key = nearest(plain, LIKE_A_KEY, keys());
    // A last part that stands elsewhere, spelt like that or nearly, is the right word in the wrong group.
    let by_last = nearest(last, LIKE_A_KEY, keys().map(last_of))
        .and_then(|near| keys().find(|key| last_of(key) == near));
    let alike = |near: Option<&str>| near.map_or(-1.0, |near| likeness(last, last_of(near)));
    unknown_but(key, if alike(by_last) > alike(by_key) { by_last } else { by_key })
}

/// The same for the name of a table.
fn unknown_group(key: &str) -> String {
    let plain = records::template(key);
    let groups = parameters().iter().flat_map(|p| {
        let ends = p.key.match_indices('.').map(|(end, _)| end);
        ends.map(|end| &p.key[..end])
    });
    unknown_but(key, nearest(plain.as_deref().unwrap_or(key), LIKE_A_KEY, groups))
}

fn unknown_but(key: &str, near: Option<&str>) -> String {
    match near {
        Some(near) => {
            let number = key.split('.').find(|part| part.parse::<usize>().is_ok()).unwrap_or("1");
            let near = near.replace(&format!(".{RECORD}."), &format!(".{number}."));
            format!("unknown key `{key}`; did you mean `{near}`?")
        }
        None => format!("unknown key `{key}`; `venation presets show beech` lists all keys"),
    }
}

fn read(value: &DeValue<'_>, parameter: &Parameter) -> Result<Value, String> {
    let takes = || format!("{} takes {}", parameter.key, kind_in_words(&parameter.kind));
    let read = match (&parameter.kind, value) {
        (Kind::Number { .. } | Kind::Count { .. }, DeValue::String(text)) => {
            number_text(text, parameter)?
        }
        (Kind::Number { .. } | Kind::Count { .. } | Kind::OneOf(_), DeValue::Array(ends)) => {
            let [low, high] = &ends[..] else { return Err(takes()) };
            let end = |v: &DeValue<'_>| float(v).ok_or_else(takes);
            range(end(low.get_ref())?, end(high.get_ref())?, parameter)?
        }
        (Kind::Number { .. } | Kind::Count { .. } | Kind::OneOf(_), value) => {
            let x = float(value).ok_or_else(takes)?;
            range(x, x, parameter)?
        }
        (Kind::Text | Kind::Choice(_), DeValue::String(text)) => Value::Text(text.to_string()),
        (Kind::Flag, DeValue::Boolean(flag)) => Value::Flag(*flag),
        (Kind::Points, list) => Value::Points(points(list).ok_or_else(takes)?),
        (Kind::Lines, DeValue::Array(lines)) => {
            let lines = lines.iter().map(|line| points(line.get_ref())).collect::<Option<_>>();
            Value::Lines(lines.ok_or_else(takes)?)
        }
        _ => return Err(takes()),
    };
    check(read, parameter)
}

fn check(value: Value, parameter: &Parameter) -> Result<Value, String> {
    match value.problem(parameter) {
        Some(problem) => Err(problem),
        None => Ok(value),
    }
}

/// `0.5`, `0.4..0.6`, `0.5±20%` or `0.5+-20%`.
fn number_text(text: &str, parameter: &Parameter) -> Result<Value, String> {
    let takes = || {
        let takes = kind_in_words(&parameter.kind);
        let forms = match parameter.kind {
            Kind::OneOf(_) => "",
            _ => ", `min..max` or `middle±percent%`",
        };
        format!("{} = `{text}`: it takes {takes}{forms}", parameter.key)
    };
    let number = |text: &str| text.trim().parse::<f64>().map_err(|_| takes());
    if let Some((low, high)) = text.split_once("..") {
        return range(number(low)?, number(high.trim_start_matches('='))?, parameter);
    }
    if let Some((middle, percent)) = text.split_once('±').or_else(|| text.split_once("+-")) {
        let middle = number(middle)?;
        let percent = number(percent.trim().strip_suffix('%').ok_or_else(takes)?)?;
        let reach = (middle * percent / 100.0).abs();
        let whole = matches!(parameter.kind, Kind::Count { .. });
        let end = |x: f64| if whole { x.round() } else { x };
        return range(end(middle - reach), end(middle + reach), parameter);
    }
    range(number(text)?, number(text)?, parameter)
}

fn range(low: f64, high: f64, parameter: &Parameter) -> Result<Value, String> {
    let whole = |x: f64| match x.is_finite() && x.fract() == 0.0 {
        true => Ok(x),
        false => Err(format!("{} = {x} is not a whole number", parameter.key)),
    };
    match parameter.kind {
        Kind::Count { min, max, .. } => {
            let within = |x: f64| {
                if whole(x)? < min as f64 || x > max as f64 {
                    return Err(format!("{} = {x} is outside {min} to {max}", parameter.key));
                }
                Ok(x as u64)
            };
            Ok(Value::Count { low: within(low)?, high: within(high)? })
        }
        Kind::OneOf(_) if low < 0.0 || low > high || whole(low).and(whole(high)).is_err() => {
            let shown = if low == high { low.to_string() } else { format!("{low}..{high}") };
            Err(format!("{} = {shown}: it takes {}", parameter.key, kind_in_words(&parameter.kind)))
        }
        Kind::OneOf(_) => Ok(Value::Count { low: low as u64, high: high as u64 }),
        _ => Ok(Value::Number { low, high }),
    }
}

/// A whole number, read from its digits and their base.
fn integer<T>(
    value: &DeValue<'_>,
    read: impl Fn(&str, u32) -> Result<T, ParseIntError>,
) -> Option<T> {
    match value {
        DeValue::Integer(n) => read(n.as_str(), n.radix()).ok(),
        _ => None,
    }
}

fn float(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(x) => x.as_str().parse().ok(),
        value => integer(value, i64::from_str_radix).map(|n| n as f64),
    }
}

fn points(list: &DeValue<'_>) -> Option<Vec<[f64; 2]>> {
    let DeValue::Array(list) = list else { return None };
    list.iter()
        .map(|point| {
            let DeValue::Array(point) = point.get_ref() else { return None };
            let [x, y] = &point[..] else { return None };
            Some([float(x.get_ref())?, float(y.get_ref())?])
        })
        .collect()
}
