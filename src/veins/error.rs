//! What cannot be grown.

/// Why veins could not be grown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VeinError {
    /// Two settings contradict each other.
    #[error("{key} = {value} {problem}")]
    Setting {
        /// The key.
        key: String,
        /// Its value.
        value: f64,
        /// What is wrong and what to change.
        problem: String,
    },
    /// Too many junctions for widths from the flow.
    #[error(
        "veins.widths = \"flow\" takes at most {limit} junctions and ends, here are {count}: grow \
         fewer veins (veins.source_spawn_distance_mm) or take \"murray\""
    )]
    Junctions {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl VeinError {
    pub(super) fn setting(key: impl Into<String>, value: f64, problem: impl Into<String>) -> Self {
        Self::Setting { key: key.into(), value, problem: problem.into() }
    }
}
