//! The measures that leaves are compared by, and the bands real leaves lie in.
//!
//! Netted leaves of dicotyledons have twenty rows. Open forking veins (ginkgo, ferns) and parallel ones
//! (grasses) have rows of their own, because most of the twenty measure areoles, which they do not
//! have or have as long boxes.
//!
//! Bands: nine real networks (*Dalbergia miscolobium* of Ronellenfitsch's `nesting`, and leaves of
//! Lasser's `network_extraction`), widened by 82 published leaves (Blonder's and Fricker's tables,
//! through `venation_tradeoffs`) where both know a measure. Scale-free but for vein length per area.

use std::ops::RangeInclusive;

use crate::parameter::words;

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

/// Row, key, name and band of a measure that counts.
type Band = (u32, &'static str, &'static str, RangeInclusive<f64>);

/// Netted leaves.
#[expect(clippy::approx_constant, reason = "0.318 is measured, not 1/π")]
const RETICULATE: [Band; 22] = [
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

/// Open dichotomous veins. No two meet; nearly all run to the margin, side by side: between parallel
/// lines the mean distance is a quarter of their spacing. Vein length per area: Boyce, Brodribb, Feild
/// & Zwieniecki, Proc. R. Soc. B 276, 2009 (about 2 mm/mm² in ginkgo and ferns).
const DICHOTOMOUS: [Band; 8] = [
    (1, "loop_index", "loop index, areoles x area / length²", 0.0..=0.001),
    (2, "mst_ratio", "spanning tree length / length", 0.999..=1.0),
    (3, "degree_3_share", "three-way share of junctions", 0.95..=1.0),
    (4, "ends_at_margin", "share of the ends at the margin", 0.8..=1.0),
    (5, "fork_angle_median", "angle between the two branches of a fork, median", 2.0..=45.0),
    (6, "tortuosity_median", "tortuosity, median", 1.0..=1.04),
    (7, "vla_x_distance_mean", "VLA x mean distance to vein", 0.24..=0.32),
    (8, "vla", "vein length per area, mm/mm²", 1.5..=2.6),
];

/// Parallel veins of grasses: long ones side by side, and short cross-veins. Lengths as of *Poa* and
/// *Zea*: 0.1 to 0.25 mm between veins, a cross-vein every 1 to 3 mm, 4 to 9 mm/mm².
const PARALLEL: [Band; 8] = [
    (1, "alignment", "alignment of the veins with the blade", 0.8..=1.0),
    (2, "parallel_spacing_variation", "spacing of long veins, deviation / mean", 0.0..=0.45),
    (3, "areole_elongation_median", "areole elongation, median", 3.0..=40.0),
    (4, "degree_3_share", "three-way share of junctions", 0.90..=1.0),
    (5, "vla_x_distance_mean", "VLA x mean distance to vein", 0.24..=0.36),
    (6, "vla", "vein length per area, mm/mm²", 4.0..=9.0),
    (7, "parallel_spacing", "spacing of long veins, mm", 0.1..=0.25),
    (8, "cross_vein_spacing", "spacing of cross-veins, mm", 1.0..=3.0),
];

words! {
    /// What kind of network a leaf has, which says what rows count.
    pub enum Architecture {
        /// Netted: areoles closed in by veins of many orders.
        Reticulate = "reticulate",
        /// Open and forking: no vein meets another.
        Dichotomous = "dichotomous",
        /// Side by side from base to apex, with cross-veins.
        Parallel = "parallel",
    }
}

/// The rows of an architecture, with the value that `value` gives for each key. Lengths in
/// millimetres need a scale: without one those rows are left out.
pub(super) fn rows(
    architecture: Architecture,
    is_scaled: bool,
    value: impl Fn(&str) -> Option<f64>,
) -> Vec<Row> {
    let bands: &[Band] = match architecture {
        Architecture::Reticulate => &RETICULATE,
        Architecture::Dichotomous => &DICHOTOMOUS,
        Architecture::Parallel => &PARALLEL,
    };
    let mut rows: Vec<Row> = Vec::new();
    for (number, key, name, band) in bands.iter().cloned() {
        let has_unit = ["vla", "parallel_spacing", "cross_vein_spacing"].contains(&key);
        if has_unit && !is_scaled {
            continue;
        }
        let measure = Measure::new(key, name, value(key), Some(band));
        match rows.last_mut().filter(|row| row.number == number) {
            Some(row) => row.measures.push(measure),
            None => rows.push(Row { number, measures: vec![measure] }),
        }
    }
    rows
}
