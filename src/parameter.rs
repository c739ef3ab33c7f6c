//! The knobs of a leaf: name, unit, limits and meaning, each written once.
//!
//! A stage declares its settings with `parameters!`: the macro makes
//! the plain struct that the stage works with (numbers already drawn) and the list of
//! [`Parameter`]s from which documents are checked, help is printed and complete files are written.
//! Ranges live in the document only ([`crate::document`]); a stage never sees one.

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

/// Settings that can list their knobs.
pub trait Parameters {
    /// Every knob, in the order in which files show them; keys relative to this group.
    fn parameters() -> Vec<Parameter>;
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

/// Declares a group of settings: a struct with serde and `Default`, and its [`Parameters`].
///
/// ```ignore
/// parameters! {
///     /// Doc of the group.
///     pub struct GrowthSpec {
///         /// Doc of the knob, shown in help and files.
///         scale: number(1.0, 0.01..=1.0, ""),
///         steps: count(600, 1..=100_000, "steps"),
///         r#type: choice(GrowthType, GrowthType::Isotropic),
///         front: group(SideColour, SideColour::default()),
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
        }
    };
}

/// The type of a field declared in [`parameters!`].
macro_rules! field_type {
    (number $x:tt) => { f64 };
    (count $x:tt) => { u64 };
    (choice ($T:ty, $default:expr)) => { $T };
    (text $x:tt) => { String };
    (flag $x:tt) => { bool };
    (points $x:tt) => { Vec<[f64; 2]> };
    (lines $x:tt) => { Vec<Vec<[f64; 2]>> };
    (group ($T:ty, $default:expr)) => { $T };
}

/// The default of a field declared in [`parameters!`].
macro_rules! field_default {
    (number ($default:expr, $limits:expr, $unit:expr)) => {
        $default
    };
    (count ($default:expr, $limits:expr, $unit:expr)) => {
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
}

/// The parameters of a field declared in [`parameters!`].
macro_rules! field_parameters {
    ($list:ident, $key:ident, $doc:ident, group ($T:ty, $default:expr)) => {
        let _ = $doc;
        $list.extend($crate::parameter::prefixed::<$T>($key));
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

/// Declares an enum of plain words: serde in kebab-case, [`Choice`], `Display` and `FromStr`.
macro_rules! words {
    (
        $(#[$attribute:meta])*
        pub enum $Name:ident { $( $(#[doc = $doc:literal])+ $Variant:ident = $word:literal ),* $(,)? }
    ) => {
        $(#[$attribute])*
        #[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
        pub enum $Name { $( $(#[doc = $doc])+ #[serde(rename = $word)] $Variant, )* }

        impl $Name {
            /// Every variant, in order.
            pub const ALL: &'static [Self] = &[$( Self::$Variant ),*];

            /// The word for it in files and on the command line.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self { $( Self::$Variant => $word ),* }
            }
        }

        impl $crate::parameter::Choice for $Name {
            const WORDS: &'static [&'static str] = &[$( $word ),*];
        }

        impl std::fmt::Display for $Name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.pad(self.word())
            }
        }
    };
}

pub(crate) use {field_default, field_kind, field_parameters, field_type, parameters, words};
