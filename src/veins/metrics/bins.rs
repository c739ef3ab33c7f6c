//! Angles and exponents of junctions by the widths that meet there.
//!
//! Thin veins meet wide ones at right angles and equals at 120°; small veins follow Murray's law and
//! large ones keep their cross-section (Price et al. 2013). The bands are those of seven or eight
//! real leaves.

use std::ops::RangeInclusive;

use super::junctions::Junction;
use super::rows::Measure;
use super::statistics::median;

/// Junctions whose w₃/w₁ lies in a range.
#[derive(Debug, Clone, PartialEq)]
pub struct AngleBin {
    /// The range of w₃/w₁.
    pub ratio: [f64; 2],
    /// Junctions in it.
    pub junctions: usize,
    /// Their share of all.
    pub share: f64,
    /// Medians of the angles between veins 1 and 2, 1 and 3, 2 and 3 (degrees).
    pub angles: [Measure; 3],
}

/// Junctions whose w₁ lies in a range of quantiles.
#[derive(Debug, Clone, PartialEq)]
pub struct ExponentBin {
    /// The range, as shares of all junctions, thinnest first.
    pub quantiles: [f64; 2],
    /// Junctions in it.
    pub junctions: usize,
    /// Median of Murray's exponent.
    pub murray: Measure,
    /// Median of (w₂² + w₃²) / w₁².
    pub area_ratio: Measure,
}

/// Ranges of w₃/w₁, with the bands of the three angles and of the share of the junctions.
type AngleBand = (f64, [RangeInclusive<f64>; 3]);
const ANGLE_BANDS: [AngleBand; 7] = [
    (0.0, [164.0..=174.0, 92.0..=97.0, 89.0..=92.0]),
    (0.2, [150.0..=174.0, 92.0..=117.0, 89.0..=95.0]),
    (0.35, [150.0..=160.0, 108.0..=117.0, 90.0..=95.0]),
    (0.5, [143.0..=151.0, 111.0..=118.0, 97.0..=100.0]),
    (0.65, [137.0..=142.0, 113.0..=119.0, 102.0..=105.0]),
    (0.8, [127.0..=132.0, 116.0..=121.0, 109.0..=111.0]),
    (0.9, [121.0..=127.0, 116.0..=122.0, 112.0..=116.0]),
];

pub(super) fn angle_bins(junctions: &[Junction]) -> Vec<AngleBin> {
    let mut bins = Vec::new();
    for (i, (low, bands)) in ANGLE_BANDS.into_iter().enumerate() {
        let high = ANGLE_BANDS.get(i + 1).map_or(1.0, |next| next.0);
        let last = i + 1 == ANGLE_BANDS.len();
        let these: Vec<[f64; 3]> = junctions
            .iter()
            .filter(|j| j.ratio() >= low && (j.ratio() < high || last))
            .map(Junction::angles)
            .collect();
        let mut bands = bands.into_iter();
        let angles = [(0, "12"), (1, "13"), (2, "23")].map(|(k, pair)| {
            let values: Vec<f64> = these.iter().map(|angles| angles[k]).collect();
            let key = format!("angle_{pair}_median_{low}_{high}");
            Measure::new(key, format!("angle {pair}, median"), median(&values), bands.next())
        });
        let share = these.len() as f64 / junctions.len().max(1) as f64;
        bins.push(AngleBin { ratio: [low, high], junctions: these.len(), share, angles });
    }
    bins
}

/// Quantiles of w₁, with the bands of Murray's exponent and of the ratio of cross-sections.
type ExponentBand = (f64, RangeInclusive<f64>, Option<RangeInclusive<f64>>);
const EXPONENT_BANDS: [ExponentBand; 5] = [
    (0.0, 3.2..=5.6, None),
    (0.5, 2.3..=3.4, None),
    (0.8, 1.9..=2.4, None),
    (0.95, 1.1..=1.9, None),
    (0.99, 1.4..=1.9, Some(0.82..=0.99)),
];

pub(super) fn exponent_bins(mut junctions: Vec<Junction>) -> Vec<ExponentBin> {
    junctions.sort_by(|a, b| a.widths[0].total_cmp(&b.widths[0]));
    let place = |q: f64| (q * junctions.len() as f64).round() as usize;
    let bin = |(i, (low, murray, area)): (usize, ExponentBand)| {
        let high = EXPONENT_BANDS.get(i + 1).map_or(1.0, |next| next.0);
        let these = &junctions[place(low)..place(high)];
        let median_of =
            |of: fn(&Junction) -> f64| median(&these.iter().map(of).collect::<Vec<f64>>());
        let key = |what: &str| format!("{what}_median_{low}_{high}");
        ExponentBin {
            quantiles: [low, high],
            junctions: these.len(),
            murray: Measure::new(
                key("murray"),
                "Murray exponent, median",
                median_of(Junction::murray_exponent),
                Some(murray),
            ),
            area_ratio: Measure::new(
                key("area_ratio"),
                "cross-sections after / before, median",
                median_of(Junction::area_ratio),
                area,
            ),
        }
    };
    EXPONENT_BANDS.into_iter().enumerate().map(bin).collect()
}
