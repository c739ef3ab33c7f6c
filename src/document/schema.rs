//! The JSON Schema of a leaf file, for editors that complete and check while one types.
//!
//! Draft 2020-12, from the same list of parameters that files are checked against: limits, words,
//! defaults and meanings cannot differ. TOML and JSON share their data model, so the schema fits both.

use serde_json::{Value as Json, json};

use super::{Value, parameters, records, value};
use crate::parameter::{Kind, Parameter};
use crate::spec::FormatKind;
use crate::texture::map::MapKind;

/// The schema.
#[must_use]
pub fn schema() -> Json {
    let mut root =
        object("A leaf: every number may be a range, from which each leaf draws its own.");
    root["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    root["title"] = "venation leaf".into();
    root["$defs"] = json!({
        // Written as text: a range, or a middle with a share to either side.
        "range": {
            "type": "string",
            "pattern": "^\\s*[-+0-9.eE]+\\s*(\\.\\.=?\\s*[-+0-9.eE]+|(±|\\+-)\\s*[0-9.eE]+\\s*%)?\\s*$",
        },
        "point": {
            "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2,
        },
    });
    insert(
        &mut root,
        "seed",
        json!({
            "description": "Seed of everything random; --seed and --seeds override it.",
            "type": "integer", "minimum": 0, "maximum": u64::MAX,
        }),
    );
    insert(
        &mut root,
        "vary",
        json!({
            "description": "How far the margins of other seeds differ from this one (%).",
            "anyOf": [
                { "type": "number", "minimum": 0, "maximum": 100 },
                { "type": "string", "pattern": "^\\s*[0-9.]+\\s*%?\\s*$" },
            ],
        }),
    );
    insert(
        &mut root,
        "version",
        json!({
            "description": "The version of venation that wrote the file; not read.",
            "type": "string",
        }),
    );
    for parameter in parameters().iter().filter(|p| !records::is_record(&p.key)) {
        insert(&mut root, &parameter.key, property(parameter));
    }
    for (list, keys) in records::lists() {
        let mut record = object("");
        for (key, parameter) in keys {
            insert(&mut record, key, property(parameter));
        }
        root["$defs"][list] = record;
        let one = json!({ "$ref": format!("#/$defs/{list}") });
        // The whole list, or some of its records by their numbers.
        let records = json!({ "anyOf": [
            { "type": "array", "items": one },
            { "type": "object", "additionalProperties": one },
        ] });
        insert(&mut root, list, records);
    }
    root
}

fn object(description: &str) -> Json {
    json!({
        "description": description,
        "type": "object",
        "properties": {},
        "additionalProperties": false,
    })
}

/// Puts a property at a dotted key, making the groups on the way.
fn insert(group: &mut Json, key: &str, property: Json) {
    let properties = group["properties"].as_object_mut().expect("groups have properties");
    match key.split_once('.') {
        None => {
            properties.insert(key.to_owned(), property);
        }
        Some((first, rest)) => {
            let child = properties.entry(first).or_insert_with(|| object(""));
            insert(child, rest, property);
        }
    }
}

fn property(parameter: &Parameter) -> Json {
    let mut property = match &parameter.kind {
        Kind::Number { min, max, .. } => {
            ranged(&json!({ "type": "number", "minimum": min, "maximum": max }))
        }
        Kind::Count { min, max, .. } => {
            ranged(&json!({ "type": "integer", "minimum": min, "maximum": max }))
        }
        Kind::OneOf(numbers) => json!({ "enum": numbers }),
        Kind::Choice(words) => json!({ "enum": words }),
        Kind::Text => match pattern(&parameter.key) {
            Some(pattern) => json!({ "type": "string", "pattern": pattern }),
            None => json!({ "type": "string" }),
        },
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Points => points(),
        Kind::Lines => json!({ "type": "array", "items": points() }),
    };
    let unit = match parameter.kind {
        Kind::Number { unit, .. } | Kind::Count { unit, .. } if !unit.is_empty() => {
            format!(" ({unit})")
        }
        _ => String::new(),
    };
    property["description"] = format!("{}{unit}", parameter.doc).into();
    if let Some(default) = value::default_of(&parameter.key).and_then(plain) {
        property["default"] = default;
    }
    property
}

/// What text a key takes, as a regular expression; `None` where any will do.
fn pattern(key: &str) -> Option<String> {
    match key {
        // Files are called after it.
        "name" => Some("^[A-Za-z0-9_-]{1,100}$".to_owned()),
        "output.maps" => {
            let maps = MapKind::ALL.iter().map(|map| map.word());
            Some(list_of(maps.chain(["ao", "default"])))
        }
        "output.formats" => Some(list_of(FormatKind::ALL.iter().map(|format| format.word()))),
        _ => None,
    }
}

/// Words with commas between them, or one of those that stand alone. Expressions know no other way to
/// take large letters for small ones.
fn list_of<'a>(words: impl Iterator<Item = &'a str>) -> String {
    let letter = |c: char| format!("[{c}{}]", c.to_ascii_uppercase());
    let word = |word: &str| word.chars().map(letter).collect::<String>();
    let words = words.map(word).collect::<Vec<_>>().join("|");
    let (all, none) = (word("all"), word("none"));
    format!("^\\s*({all}|{none}|({words})(\\s*,\\s*({words}))*)\\s*$")
}

/// A value, a pair of ends, or either as text.
fn ranged(one: &Json) -> Json {
    json!({ "anyOf": [
        one,
        { "type": "array", "items": one, "minItems": 2, "maxItems": 2 },
        { "$ref": "#/$defs/range" },
    ] })
}

fn points() -> Json {
    json!({ "type": "array", "items": { "$ref": "#/$defs/point" } })
}

/// A default as JSON; lists are left out, for they are empty.
fn plain(value: Value) -> Option<Json> {
    match value {
        Value::Number { low, .. } => Some(low.into()),
        Value::Count { low, .. } => Some(low.into()),
        Value::Text(text) => Some(text.into()),
        Value::Flag(flag) => Some(flag.into()),
        Value::Points(_) | Value::Lines(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The property at a dotted key.
    fn at<'a>(schema: &'a Json, key: &str) -> &'a Json {
        key.split('.').fold(schema, |group, name| &group["properties"][name])
    }

    #[test]
    fn every_parameter_stands_in_the_schema_with_its_limits() {
        let schema = schema();
        for parameter in parameters().iter().filter(|p| !records::is_record(&p.key)) {
            let property = at(&schema, &parameter.key);
            assert!(property["description"].is_string(), "{}", parameter.key);
            match &parameter.kind {
                Kind::Number { min, max, .. } => {
                    assert_eq!(property["anyOf"][0]["minimum"], json!(min), "{}", parameter.key);
                    assert_eq!(property["anyOf"][1]["items"]["maximum"], json!(max));
                }
                Kind::Choice(words) => assert_eq!(property["enum"], json!(words)),
                _ => {}
            }
        }
        assert_eq!(schema["additionalProperties"], json!(false));
        let groups = schema["properties"].as_object().expect("groups");
        assert!(groups["veins"]["additionalProperties"] == json!(false));
    }
}
