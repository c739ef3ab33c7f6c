//! Values of a document, their check against a parameter, and the defaults.

use std::fmt;
use std::sync::LazyLock;

use super::records;
use crate::parameter::{Kind, Parameter, Parameters};
use crate::spec::LeafSpec;
use crate::spelling::{LIKE_A_KEY, nearest};

/// A value as a document gives it.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A number from a range; equal ends are a constant.
    Number {
        /// Least.
        low: f64,
        /// Greatest.
        high: f64,
    },
    /// A whole number from a range, both ends possible.
    Count {
        /// Least.
        low: u64,
        /// Greatest.
        high: u64,
    },
    /// A word or free text.
    Text(String),
    /// Yes or no.
    Flag(bool),
    /// Points.
    Points(Vec<[f64; 2]>),
    /// Lines of points.
    Lines(Vec<Vec<[f64; 2]>>),
}

impl Value {
    /// A constant number.
    #[must_use]
    pub fn number(value: f64) -> Self {
        Self::Number { low: value, high: value }
    }

    /// A constant whole number.
    #[must_use]
    pub fn count(value: u64) -> Self {
        Self::Count { low: value, high: value }
    }

    /// What is wrong with it as a value of `parameter`, in words; `None` when it fits.
    #[must_use]
    pub fn problem(&self, parameter: &Parameter) -> Option<String> {
        let key = &parameter.key;
        match (self, &parameter.kind) {
            (Self::Number { low, high }, Kind::Number { min, max, .. }) => {
                if !low.is_finite() || !high.is_finite() {
                    return Some(format!("{key} is not a finite number"));
                }
                if low > high {
                    return Some(backwards(key, low, high));
                }
                let outside = [low, high].into_iter().find(|end| *end < min || *end > max)?;
                Some(format!("{key} = {outside} is outside {min} to {max}"))
            }
            (Self::Count { low, high }, Kind::Count { min, max, .. }) => {
                if low > high {
                    return Some(backwards(key, low, high));
                }
                let outside = [low, high].into_iter().find(|end| *end < min || *end > max)?;
                Some(format!("{key} = {outside} is outside {min} to {max}"))
            }
            (Self::Count { low, high }, Kind::OneOf(numbers)) => {
                if low == high && numbers.contains(low) {
                    return None;
                }
                let shown = if low == high { low.to_string() } else { format!("{low}..{high}") };
                Some(format!("{key} = {shown}: it takes {}", kind_in_words(&parameter.kind)))
            }
            (Self::Text(word), Kind::Choice(words)) => {
                if words.contains(&word.as_str()) {
                    return None;
                }
                let hint = match nearest(word, LIKE_A_KEY, words.iter().copied()) {
                    Some(near) => format!("; did you mean `{near}`?"),
                    None => format!("; it is one of: {}", words.join(", ")),
                };
                Some(format!("{key} has no value `{word}`{hint}"))
            }
            (Self::Points(points), Kind::Points) => not_finite(key, points),
            (Self::Lines(lines), Kind::Lines) => lines.iter().find_map(|l| not_finite(key, l)),
            (Self::Text(_), Kind::Text) | (Self::Flag(_), Kind::Flag) => None,
            (_, kind) => Some(format!("{key} takes {}", kind_in_words(kind))),
        }
    }
}

fn backwards(key: &str, low: &impl fmt::Display, high: &impl fmt::Display) -> String {
    format!("{key} = {low}..{high} runs backwards; write {high}..{low}")
}

fn not_finite(key: &str, points: &[[f64; 2]]) -> Option<String> {
    let index = points.iter().position(|p| !p[0].is_finite() || !p[1].is_finite())?;
    Some(format!("{key}: point {index} is not finite"))
}

/// What a parameter takes, for messages.
pub(super) fn kind_in_words(kind: &Kind) -> String {
    match kind {
        Kind::Number { .. } => "a number or a range [min, max]".into(),
        Kind::Count { .. } => "a whole number or a range [min, max] of them".into(),
        Kind::OneOf(numbers) => {
            let numbers: Vec<String> = numbers.iter().map(u64::to_string).collect();
            format!("{}, no range", numbers.join(" or "))
        }
        Kind::Choice(words) => format!("one of: {}", words.join(", ")),
        Kind::Text => "text".into(),
        Kind::Flag => "true or false".into(),
        Kind::Points => "points [[x, y], …]".into(),
        Kind::Lines => "lines of points [[[x, y], …], …]".into(),
    }
}

/// The default leaf as a tree of TOML values, with one record in every list of them.
static DEFAULTS: LazyLock<toml::Value> = LazyLock::new(|| LeafSpec::defaults().into());

/// The default of a key; `None` for an unknown key.
pub(super) fn default_of(key: &str) -> Option<Value> {
    from_plain(&DEFAULTS, records::listed(key)?)
}

/// The value at a parameter's key in a tree of plain (drawn) values.
pub(super) fn from_plain(tree: &toml::Value, parameter: &Parameter) -> Option<Value> {
    let found = parameter.key.split('.').try_fold(tree, |node, part| node.get(part))?;
    Some(match (&parameter.kind, found) {
        (Kind::Number { .. }, toml::Value::Float(x)) => Value::number(*x),
        (Kind::Count { .. } | Kind::OneOf(_), toml::Value::Integer(n)) => {
            Value::count(u64::try_from(*n).ok()?)
        }
        (Kind::Choice(_) | Kind::Text, toml::Value::String(s)) => Value::Text(s.clone()),
        (Kind::Flag, toml::Value::Boolean(b)) => Value::Flag(*b),
        (Kind::Points, list) => Value::Points(list.clone().try_into().ok()?),
        (Kind::Lines, list) => Value::Lines(list.clone().try_into().ok()?),
        _ => return None,
    })
}
