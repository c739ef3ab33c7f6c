//! The knobs of a leaf: name, unit, limits and meaning, each written once.
//!
//! A stage declares its settings with `parameters!`: the macro makes
//! the plain struct that the stage works with (numbers already drawn) and the list of
//! [`Parameter`]s from which documents are checked, help is printed and complete files are written.
//! Ranges live in the document only ([`crate::document`]); a stage never sees one.
//!
//! A field of `records` is a list of groups (one a lobe, say). Its knobs are listed once, with
//! [`RECORD`] where a document has the number of the record: `margin.lobe.N.angle_deg`.

mod words;

/// One knob.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// Dotted path, the same in presets, `--set`, errors and documentation.
    pub key: String,
    /// What it does, in one or two sentences.
    pub doc: String,
    /// What values it takes.
    pub kind: Kind,
}

/// What values a parameter takes.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number in `min..=max`; a document may give a range to draw from.
    Number {
        /// Least value.
        min: f64,
        /// Greatest value.
        max: f64,
        /// Unit, empty for a ratio.
        unit: &'static str,
    },
    /// A whole number in `min..=max`; a document may give a range to draw from.
    Count {
        /// Least value.
        min: u64,
        /// Greatest value.
        max: u64,
        /// Unit, empty for a plain count.
        unit: &'static str,
    },
    /// One whole number of a few; a document may give no range of them.
    OneOf(&'static [u64]),
    /// One word of a list.
    Choice(&'static [&'static str]),
    /// Any text.
    Text,
    /// `true` or `false`.
    Flag,
    /// Points `[[x, y], …]` (mm).
    Points,
    /// Lines of points `[[[x, y], …], …]` (mm).
    Lines,
}

/// What stands in a key for the number of a record, which counts from 1.
pub const RECORD: &str = "N";

/// Settings that can list their knobs.
pub trait Parameters {
    /// Every knob, in the order in which files show them; keys relative to this group.
    fn parameters() -> Vec<Parameter>;

    /// The default of every knob, as a tree by the parts of their keys.
    fn defaults() -> toml::Table;

    /// The first number or count that is outside its limits (or no number), in the order of the
    /// knobs. Documents are checked as they are read; this is for settings that a program made.
    fn outside_limits(&self) -> Option<OutsideLimits>;
}

/// A setting outside its limits.
#[derive(Debug, Clone, PartialEq)]
pub struct OutsideLimits {
    /// Its key, relative to the group that was asked.
    pub key: String,
    /// Its value.
    pub value: f64,
    /// The least it may be.
    pub min: f64,
    /// The most it may be.
    pub max: f64,
}

impl OutsideLimits {
    /// What is wrong, to stand after `KEY = VALUE`.
    #[must_use]
    pub fn problem(&self) -> String {
        format!("must be from {} to {}", self.min, self.max)
    }

    /// The same seen from the group above.
    pub(crate) fn within(mut self, group: &str) -> Self {
        self.key = format!("{group}.{}", self.key);
        self
    }
}

/// A word that is none of a list.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{word}` is none of {}", words.join(", "))]
pub struct UnknownWord {
    /// As given.
    pub word: String,
    /// Those that there are.
    pub words: &'static [&'static str],
}

/// A word of a list, as a parameter.
pub trait Choice {
    /// The words, in the order of the variants.
    const WORDS: &'static [&'static str];
}

/// The list of `group`, each key behind `prefix`.
pub fn prefixed<T: Parameters>(prefix: &str) -> Vec<Parameter> {
    let mut list = T::parameters();
    for parameter in &mut list {
        parameter.key = format!("{prefix}.{}", parameter.key);
    }
    list
}

/// Puts the records found in `inner` into the group `key` of `tree`.
pub(crate) fn add_records(tree: &mut toml::Table, key: &str, inner: toml::Table) {
    let Some(toml::Value::Table(group)) = tree.get_mut(key) else { return };
    for (name, value) in inner {
        let toml::Value::Table(table) = value else { continue };
        if table.contains_key(RECORD) {
            group.insert(name, table.into());
        } else {
            add_records(group, &name, table);
        }
    }
}

/// Declares a group of settings: a struct with serde and `Default`, and its [`Parameters`].
///
/// ```ignore
/// parameters! {
///     /// Doc of the group.
///     pub struct GrowthSpec {
///         /// Doc of the knob, shown in help and files.
///         scale: number(1.0, 0.01..=1.0, ""),
///         steps: count(600, 1..=100_000, "steps"),
///         bits: one_of(8, &[8, 16]),
///         r#type: choice(GrowthType, GrowthType::Isotropic),
///         front: group(SideColour, SideColour::default()),
///         spot: records(SpotSpec),
///     }
/// }
/// ```
macro_rules! parameters {
    (
        $(#[$attribute:meta])*
        pub struct $Name:ident {
            $( $(#[doc = $doc:literal])+ $field:ident : $kind:ident $arguments:tt ),* $(,)?
        }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
        #[serde(deny_unknown_fields, default)]
        pub struct $Name {
            $( $(#[doc = $doc])+ pub $field: $crate::parameter::field_type!($kind $arguments), )*
        }

        impl Default for $Name {
            fn default() -> Self {
                Self { $( $field: $crate::parameter::field_default!($kind $arguments), )* }
            }
        }

        impl $crate::parameter::Parameters for $Name {
            fn parameters() -> Vec<$crate::parameter::Parameter> {
                let mut list = Vec::new();
                $( {
                    let key = stringify!($field).trim_start_matches("r#");
                    let doc = [$($doc),+].map(str::trim).join(" ");
                    $crate::parameter::field_parameters!(list, key, doc, $kind $arguments);
                } )*
                list
            }

            fn defaults() -> toml::Table {
                let plain = toml::Value::try_from(Self::default()).expect("settings are plain data");
                let toml::Value::Table(mut tree) = plain else { unreachable!("a struct is a table") };
                $( {
                    let key = stringify!($field).trim_start_matches("r#");
                    $crate::parameter::field_defaults!(tree, key, $kind $arguments);
                } )*
                tree
            }

            fn outside_limits(&self) -> Option<$crate::parameter::OutsideLimits> {
                $( {
                    let key = stringify!($field).trim_start_matches("r#");
                    let outside =
                        $crate::parameter::field_outside!(self.$field, key, $kind $arguments);
                    if outside.is_some() {
                        return outside;
                    }
                } )*
                None
            }
        }
    };
}

/// The type of a field declared in [`parameters!`].
macro_rules! field_type {
    (number $x:tt) => { f64 };
    (count $x:tt) => { u64 };
    (one_of $x:tt) => { u64 };
    (choice ($T:ty, $default:expr)) => { $T };
    (text $x:tt) => { String };
    (flag $x:tt) => { bool };
    (points $x:tt) => { Vec<[f64; 2]> };
    (lines $x:tt) => { Vec<Vec<[f64; 2]>> };
    (group ($T:ty, $default:expr)) => { $T };
    (records ($T:ty)) => { Vec<$T> };
}

/// The default of a field declared in [`parameters!`].
macro_rules! field_default {
    (number ($default:expr, $limits:expr, $unit:expr)) => {
        $default
    };
    (count ($default:expr, $limits:expr, $unit:expr)) => {
        $default
    };
    (one_of ($default:expr, $numbers:expr)) => {
        $default
    };
    (choice ($T:ty, $default:expr)) => {
        $default
    };
    (text ($default:expr)) => {
        String::from($default)
    };
    (flag ($default:expr)) => {
        $default
    };
    (points ()) => {
        Vec::new()
    };
    (lines ()) => {
        Vec::new()
    };
    (group ($T:ty, $default:expr)) => {
        $default
    };
    (records ($T:ty)) => {
        Vec::new()
    };
}

/// Adds to the tree of defaults what the plain default of a field in [`parameters!`] lacks: what
/// stands in records, of which there are none yet.
macro_rules! field_defaults {
    ($tree:ident, $key:ident, group ($T:ty, $default:expr)) => {
        // The group's own defaults may have been replaced where it is used; records stay its own.
        let inner = <$T as $crate::parameter::Parameters>::defaults();
        $crate::parameter::add_records(&mut $tree, $key, inner);
    };
    ($tree:ident, $key:ident, records ($T:ty)) => {
        let record = <$T as $crate::parameter::Parameters>::defaults();
        let named = toml::Table::from_iter([($crate::parameter::RECORD.to_owned(), record.into())]);
        $tree.insert($key.to_owned(), named.into());
    };
    ($tree:ident, $key:ident, $kind:ident $arguments:tt) => {
        let _ = (&mut $tree, $key);
    };
}

/// The parameters of a field declared in [`parameters!`].
macro_rules! field_parameters {
    ($list:ident, $key:ident, $doc:ident, group ($T:ty, $default:expr)) => {
        let _ = $doc;
        $list.extend($crate::parameter::prefixed::<$T>($key));
    };
    ($list:ident, $key:ident, $doc:ident, records ($T:ty)) => {
        let _ = $doc;
        let prefix = format!("{}.{}", $key, $crate::parameter::RECORD);
        $list.extend($crate::parameter::prefixed::<$T>(&prefix));
    };
    ($list:ident, $key:ident, $doc:ident, $kind:ident $arguments:tt) => {
        $list.push($crate::parameter::Parameter {
            key: $key.to_owned(),
            doc: $doc,
            kind: $crate::parameter::field_kind!($kind $arguments),
        });
    };
}

/// The [`Kind`] of a field declared in [`parameters!`].
macro_rules! field_kind {
    (number ($default:expr, $limits:expr, $unit:expr)) => {{
        let limits = $limits;
        $crate::parameter::Kind::Number { min: *limits.start(), max: *limits.end(), unit: $unit }
    }};
    (count ($default:expr, $limits:expr, $unit:expr)) => {{
        let limits = $limits;
        $crate::parameter::Kind::Count { min: *limits.start(), max: *limits.end(), unit: $unit }
    }};
    (one_of ($default:expr, $numbers:expr)) => {
        $crate::parameter::Kind::OneOf($numbers)
    };
    (choice ($T:ty, $default:expr)) => {
        $crate::parameter::Kind::Choice(<$T as $crate::parameter::Choice>::WORDS)
    };
    (text $x:tt) => {
        $crate::parameter::Kind::Text
    };
    (flag $x:tt) => {
        $crate::parameter::Kind::Flag
    };
    (points $x:tt) => {
        $crate::parameter::Kind::Points
    };
    (lines $x:tt) => {
        $crate::parameter::Kind::Lines
    };
}

/// What is outside its limits in a field of [`parameters!`].
macro_rules! field_outside {
    (@in $value:expr, $key:ident, $limits:expr) => {{
        let limits = $limits;
        (!limits.contains(&$value)).then(|| $crate::parameter::OutsideLimits {
            key: $key.to_owned(),
            value: $value as f64,
            min: *limits.start() as f64,
            max: *limits.end() as f64,
        })
    }};
    ($value:expr, $key:ident, number ($default:expr, $limits:expr, $unit:expr)) => {
        $crate::parameter::field_outside!(@in $value, $key, $limits)
    };
    ($value:expr, $key:ident, count ($default:expr, $limits:expr, $unit:expr)) => {
        $crate::parameter::field_outside!(@in $value, $key, $limits)
    };
    ($value:expr, $key:ident, group $arguments:tt) => {
        $crate::parameter::Parameters::outside_limits(&$value).map(|outside| outside.within($key))
    };
    ($value:expr, $key:ident, records $arguments:tt) => {
        $value.iter().enumerate().find_map(|(i, record)| {
            let outside = $crate::parameter::Parameters::outside_limits(record)?;
            Some(outside.within(&(i + 1).to_string()).within($key))
        })
    };
    ($value:expr, $key:ident, $kind:ident $arguments:tt) => {{
        let _ = $key;
        None::<$crate::parameter::OutsideLimits>
    }};
}

pub(crate) use words::words;
pub(crate) use {
    field_default, field_defaults, field_kind, field_outside, field_parameters, field_type,
    parameters,
};
