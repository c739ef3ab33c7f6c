//! The measures that leaves are compared by, and the bands real leaves lie in.
//!
//! Bands: nine real networks (*Dalbergia miscolobium* of Ronellenfitsch's `nesting`, and leaves of
//! Lasser's `network_extraction`), widened by 82 published leaves (Blonder's and Fricker's tables,
//! through `venation_tradeoffs`) where both know a measure. Scale-free but for vein length per area.

use std::ops::RangeInclusive;

/// A number and the band that real leaves lie in.
#[derive(Debug, Clone, PartialEq)]
pub struct Measure {
    /// A word for programs.
    pub key: String,
    /// What it is, for people.
    pub name: String,
    /// Its value; `None` where the pattern has nothing to measure, such as areoles.
    pub value: Option<f64>,
    /// Where real leaves lie; `None` for what only informs.
    pub band: Option<RangeInclusive<f64>>,
}

impl Measure {
    /// A measure.
    #[must_use]
    pub fn new(
        key: impl Into<String>,
        name: impl Into<String>,
        value: Option<f64>,
        band: Option<RangeInclusive<f64>>,
    ) -> Self {
        Self { key: key.into(), name: name.into(), value: value.filter(|v| v.is_finite()), band }
    }

    /// Whether the value lies in the band; `None` without a band.
    #[must_use]
    pub fn is_inside(&self) -> Option<bool> {
        let band = self.band.as_ref()?;
        Some(self.value.is_some_and(|value| band.contains(&value)))
    }
}

/// One of the twenty rows: a measure, or two that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// 1 to 20.
    pub number: u32,
    /// The measures; each has a band.
    pub measures: Vec<Measure>,
}

impl Row {
    /// Whether all of its measures are inside their bands.
    #[must_use]
    pub fn is_inside(&self) -> bool {
        self.measures.iter().all(|measure| measure.is_inside() == Some(true))
    }
}

/// Row, key, name and band of the measures that count.
#[expect(clippy::approx_constant, reason = "0.318 is measured, not 1/π")]
const BANDS: [(u32, &str, &str, RangeInclusive<f64>); 22] = [
    (1, "loop_index", "loop index, areoles x area / length²", 0.16..=0.22),
    (2, "mst_ratio", "spanning tree length / length", 0.38..=0.88),
    (3, "meshedness", "meshedness", 0.13..=0.20),
    (4, "edges_per_node", "segments per node", 1.22..=1.42),
    (5, "degree_3_share", "three-way share of junctions", 0.90..=1.0),
    (6, "areole_ln_area_sd", "deviation of ln areole area", 0.54..=1.06),
    (7, "areole_elongation_median", "areole elongation, median", 1.42..=1.70),
    (8, "areole_circularity_median", "areole circularity, median", 0.68..=0.85),
    (9, "areole_segments_mean", "segments per areole", 6.4..=7.5),
    (10, "areole_free_ends_mean", "free endings per areole", 0.29..=1.62),
    (11, "areoles_without_free_ends", "share of areoles without any", 0.47..=0.76),
    (12, "segment_length_variation", "segment length, deviation / mean", 0.53..=0.61),
    (13, "tortuosity_median", "tortuosity, median", 1.01..=1.04),
    (14, "vla_x_distance_mean", "VLA x mean distance to vein", 0.284..=0.318),
    (15, "vla_x_inradius_mean", "VLA x mean areole inradius", 0.67..=0.78),
    (16, "angle_smallest_median", "smallest junction angle, median", 92.0..=101.0),
    (16, "angle_largest_median", "largest junction angle, median", 141.0..=151.0),
    (17, "imbalance_median", "force imbalance at p = 1, median", 0.0..=0.13),
    (17, "balanced_exponent", "p of least imbalance", 0.75..=1.25),
    (18, "width_ratio_max", "widest / median width", 5.0..=17.0),
    (19, "length_share_over_2", "length share over 2 median widths", 0.012..=0.099),
    (20, "nesting_excess", "nesting minus shuffled", 0.01..=1.0),
];

/// The twenty rows, with the value that `value` gives for each key.
pub(super) fn rows(value: impl Fn(&str) -> Option<f64>) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (number, key, name, band) in BANDS {
        let measure = Measure::new(key, name, value(key), Some(band));
        match rows.last_mut().filter(|row| row.number == number) {
            Some(row) => row.measures.push(measure),
            None => rows.push(Row { number, measures: vec![measure] }),
        }
    }
    rows
}
