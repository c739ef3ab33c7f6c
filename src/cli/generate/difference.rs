//! In what the settings of two leaves differ, for messages.

use std::collections::BTreeMap;

/// So many keys are named.
const NAMED: usize = 3;

/// Longer values (polygons) are cut off.
const LONGEST: usize = 40;

/// In which keys two texts of settings differ, in words.
pub(super) fn difference(there: &str, here: &str) -> String {
    let (Some(there), Some(here)) = (flat(there), flat(here)) else {
        return "its settings cannot be read".into();
    };
    let mut keys: Vec<&String> = there.keys().chain(here.keys()).collect();
    // The seed and the version change much of the rest.
    keys.sort_by_key(|key| (key.contains('.'), *key));
    keys.dedup();
    keys.retain(|key| there.get(*key) != here.get(*key) && !is_choice_of_files(key));
    let shown = |value: Option<&String>| match value {
        None => "nothing".to_owned(),
        Some(value) if value.chars().count() > LONGEST => {
            value.chars().take(LONGEST).chain(['…']).collect()
        }
        Some(value) => value.clone(),
    };
    let named = keys.iter().take(NAMED).map(|key| {
        format!("{key} is {} there, {} here", shown(there.get(*key)), shown(here.get(*key)))
    });
    let mut words = named.collect::<Vec<_>>().join(", ");
    match keys.len().saturating_sub(NAMED) {
        0 => {}
        1 => words += " and another key",
        more => words += &format!(" and {more} other keys"),
    }
    words
}

/// Whether a key only says which files of a leaf are written.
fn is_choice_of_files(key: &str) -> bool {
    matches!(key, "output.maps" | "output.formats")
}

/// The values of a TOML text by their dotted keys.
fn flat(text: &str) -> Option<BTreeMap<String, String>> {
    let mut values = BTreeMap::new();
    let mut open = vec![(String::new(), toml::Value::Table(text.parse().ok()?))];
    while let Some((key, value)) = open.pop() {
        let below = |part: &str| if key.is_empty() { part.into() } else { format!("{key}.{part}") };
        match value {
            toml::Value::Table(table) => {
                open.extend(table.into_iter().map(|(part, value)| (below(&part), value)));
            }
            // The records of a list.
            toml::Value::Array(items) if items.iter().any(toml::Value::is_table) => {
                let numbered = items.into_iter().enumerate();
                open.extend(numbered.map(|(i, value)| (below(&(i + 1).to_string()), value)));
            }
            value => {
                values.insert(key, value.to_string());
            }
        }
    }
    Some(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_named_and_counted() {
        let there = "seed = 1\n[output]\nbits = 8\nmaps = 'all'\n[[margin.lobe]]\nlength = 1.0\n";
        let here = "seed = 1\n[output]\nbits = 16\nmaps = 'none'\n";
        assert_eq!(
            difference(there, here),
            "margin.lobe.1.length is 1.0 there, nothing here, output.bits is 8 there, 16 here"
        );
        let many = difference("seed = 2\na.b = 1\na.c = 1\na.d = 1\na.e = 1\n", "seed = 3\n");
        assert!(many.starts_with("seed is 2 there, 3 here, a.b is 1 there"), "{many}");
        assert!(many.ends_with(" and 2 other keys"), "{many}");
        assert_eq!(difference("no settings", here), "its settings cannot be read");
    }
}
