//! Why a margin could not be made.

/// Why a margin could not be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MarginError {
    /// A coordinate is NaN or infinite.
    #[error("the outline has a coordinate that is not a finite number, at point {index}")]
    NotFinite {
        /// Index of the point.
        index: usize,
    },
    /// Too little left to be a leaf.
    #[error("the outline has {count} distinct points; a leaf needs at least {least}")]
    TooFewPoints {
        /// Distinct points.
        count: usize,
        /// The least number.
        least: usize,
    },
    /// The outline encloses (nearly) nothing.
    #[error("the outline encloses no area ({area_mm2:.3e} mm²)")]
    NoArea {
        /// Its area (mm²).
        area_mm2: f64,
    },
    /// The outline crosses or touches itself.
    #[error("the outline crosses itself near ({x:.2}, {y:.2}) mm; {hint}")]
    SelfCrossing {
        /// Where, x (mm).
        x: f64,
        /// Where, y (mm).
        y: f64,
        /// What to change.
        hint: &'static str,
    },
    /// The base is not the first vertex, or the apex not on the axis.
    #[error("the outline must start at the base (0, 0) and have its apex on the +y axis")]
    NotPlaced,
    /// A cut leaves the blade.
    #[error("a slit leaves the blade near ({x:.2}, {y:.2}) mm")]
    CutOutside {
        /// Where, x (mm).
        x: f64,
        /// Where, y (mm).
        y: f64,
    },
    /// The landmarks of one side contradict each other.
    #[error("{key} = {value} {problem}")]
    Landmark {
        /// The key.
        key: String,
        /// Its value.
        value: f64,
        /// What is wrong with it and what to change.
        problem: String,
    },
    /// Settings that are each in order make no leaf together.
    #[error("{0}")]
    Unsuited(String),
    /// The outline crosses itself, and one setting can mend it.
    #[error("the outline crosses itself near ({x:.2}, {y:.2}) mm: {key} = {value} {problem}")]
    CrossingBy {
        /// Where, x (mm).
        x: f64,
        /// Where, y (mm).
        y: f64,
        /// The key to change.
        key: String,
        /// Its value.
        value: f64,
        /// Its bound.
        problem: String,
    },
    /// A picture holds no usable outline.
    #[error("{0}")]
    Picture(String),
    /// The place given for the petiole is unusable.
    #[error("the root ({x}, {y}) {problem}")]
    Root {
        /// As given, x.
        x: f64,
        /// As given, y.
        y: f64,
        /// What is wrong with it.
        problem: String,
    },
}
