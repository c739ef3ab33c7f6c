//! Keys with the number of a record in them.

use std::borrow::Cow;

use super::parameters;
use crate::parameter::{Parameter, RECORD};

/// More records than this in one list are a slip.
pub(super) const MOST: usize = 99;

/// The parameter behind a key, as it is listed: numbers stand for any record.
pub(super) fn listed(key: &str) -> Option<&'static Parameter> {
    let exact = parameters().iter().find(|p| p.key == key);
    exact.or_else(|| {
        let template = template(key)?;
        parameters().iter().find(|p| p.key == template)
    })
}

/// The parameter behind a key, called by that key.
pub(super) fn find(key: &str) -> Option<Cow<'static, Parameter>> {
    let parameter = listed(key)?;
    Some(if parameter.key == key {
        // A listed key with the placeholder in it is no key.
        (!is_record(&parameter.key)).then_some(Cow::Borrowed(parameter))?
    } else {
        Cow::Owned(Parameter { key: key.to_owned(), ..parameter.clone() })
    })
}

/// Whether a listed key belongs to a record.
pub(super) fn is_record(key: &str) -> bool {
    key.split('.').any(|part| part == RECORD)
}

/// A key with the placeholder for its numbers; `None` when it has none.
pub(super) fn template(key: &str) -> Option<String> {
    let mut numbered = false;
    let parts: Vec<&str> = key
        .split('.')
        .map(|part| match number(part) {
            Some(_) => {
                numbered = true;
                RECORD
            }
            None => part,
        })
        .collect();
    numbered.then(|| parts.join("."))
}

fn number(part: &str) -> Option<usize> {
    let plain = !part.starts_with('0') && part.bytes().all(|b| b.is_ascii_digit());
    part.parse().ok().filter(|n| plain && (1..=MOST).contains(n))
}

/// The number of the record of `list` that a key is about.
pub(super) fn number_in(key: &str, list: &str) -> Option<usize> {
    let rest = key.strip_prefix(list)?.strip_prefix('.')?;
    number(rest.split('.').next()?)
}

/// Every list of records, as in `margin.lobe`, with the keys inside one record.
pub(super) fn lists() -> Vec<(&'static str, Vec<(&'static str, &'static Parameter)>)> {
    let mut lists: Vec<(&str, Vec<_>)> = Vec::new();
    for parameter in parameters() {
        let Some((list, rest)) = parameter.key.split_once(&format!(".{RECORD}.")) else { continue };
        if lists.last().is_none_or(|(last, _)| *last != list) {
            lists.push((list, Vec::new()));
        }
        let (_, keys) = lists.last_mut().expect("just pushed");
        keys.push((rest, parameter));
    }
    lists
}

/// Whether a key names a list of records.
pub(super) fn is_list(key: &str) -> bool {
    let group = format!("{}.{RECORD}.", template(key).as_deref().unwrap_or(key));
    parameters().iter().any(|p| p.key.starts_with(&group))
}

/// Whether a key names a group: a table of a file, or one record.
pub(super) fn is_group(key: &str) -> bool {
    let group = format!("{}.", template(key).as_deref().unwrap_or(key));
    parameters().iter().any(|p| p.key.starts_with(&group))
}
