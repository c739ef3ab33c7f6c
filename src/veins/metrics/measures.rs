//! Everything that is measured of a network, gathered.

use std::ops::RangeInclusive;

use super::areoles::{Areole, Areoles};
use super::bins::{AngleBin, ExponentBin, angle_bins, exponent_bins};
use super::courses::Courses;
use super::distances::Distances;
use super::junctions::{Junction, balanced_exponent, junctions};
use super::nesting::Nesting;
use super::network::Network;
use super::rows::{Architecture, Measure, Row, rows};
use super::statistics::{deviation, mean, median, quantile, share, variation};
use super::strahler::{StrahlerOrder, strahler};
use super::topology::Topology;

/// The unit of length of a network.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unit {
    /// Millimetres.
    Millimetre,
    /// Pixels of a picture whose scale is not known.
    Pixel,
}

impl Unit {
    /// As written after a number.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Millimetre => "mm",
            Self::Pixel => "px",
        }
    }
}

/// Measures of a network, beside those of real leaves.
#[derive(Debug, Clone)]
pub struct Measures {
    /// Unit of the lengths.
    pub unit: Unit,
    /// Counts.
    pub topology: Topology,
    /// Areoles.
    pub areoles: Vec<Areole>,
    /// Length of all veins.
    pub length: f64,
    /// Area of the blade.
    pub blade_area: f64,
    /// Side of a pixel of the grid on which distances were measured.
    pub distance_pixel: Option<f64>,
    /// Median width of the segments.
    pub median_width: Option<f64>,
    /// What kind of network it is, by which rows it is measured.
    pub architecture: Architecture,
    /// The rows that count: twenty for a netted leaf.
    pub rows: Vec<Row>,
    /// What else is known of real leaves, and what informs.
    pub others: Vec<Measure>,
    /// Veins by order, where orders are known.
    pub orders: Vec<OrderShare>,
    /// Strahler orders.
    pub strahler: Vec<StrahlerOrder>,
    /// Angles of junctions by the ratio of their widths.
    pub angles: Vec<AngleBin>,
    /// Exponents of junctions by the width of their widest vein.
    pub exponents: Vec<ExponentBin>,
}

/// The veins of one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OrderShare {
    /// 1 primary, 2 secondary, …
    pub order: u8,
    /// Segments.
    pub segments: usize,
    /// Length of all of them.
    pub length: f64,
    /// Length per area of the blade.
    pub length_per_area: f64,
    /// Their mean width, by length.
    pub width: f64,
}

impl Measures {
    /// Measures a network, by the rows of what it looks like.
    #[must_use]
    pub fn of(network: &Network, unit: Unit) -> Self {
        Self::by(network, unit, None)
    }

    /// Measures a network by the rows of an architecture.
    #[must_use]
    pub fn by(network: &Network, unit: Unit, architecture: Option<Architecture>) -> Self {
        let topology = Topology::of(network);
        let areoles = Areoles::of(network);
        let junctions = junctions(network);
        let distances = Distances::of(network, areoles.list.len());
        let segments = network.segments();
        let widths: Vec<f64> = segments.iter().map(|segment| segment.width).collect();
        let nesting = Nesting::of(&areoles, &widths);
        let shuffled = Nesting::of_shuffled(network, &areoles);
        let excess = nesting.zip(shuffled).map(|(real, other)| real.plain - other.plain);
        let weighted = nesting.zip(shuffled).map(|(real, other)| real.weighted - other.weighted);
        let (length, blade_area) = (network.length(), network.blade_area());
        let vla = (blade_area > 0.0).then(|| length / blade_area);
        let list = &areoles.list;
        let areole = |of: fn(&Areole) -> f64| list.iter().map(of).collect::<Vec<f64>>();
        let areas = areole(|areole| areole.area);
        let ln_areas = areole(|areole| areole.area.ln());
        let elongations = areole(|areole| areole.elongation);
        let circularities = areole(Areole::circularity);
        let sides = areole(|areole| areole.segments as f64);
        let free_ends = areole(|areole| areole.free_ends as f64);
        let lengths: Vec<f64> = segments.iter().map(|segment| segment.length).collect();
        let tortuosities: Vec<f64> = segments
            .iter()
            .filter(|segment| segment.chord() > 0.0)
            .map(|segment| segment.length / segment.chord())
            .collect();
        let angle = |of: fn([f64; 3]) -> f64| {
            junctions.iter().map(|junction| of(junction.angles())).collect::<Vec<f64>>()
        };
        let smallest = angle(|[a, b, c]| a.min(b).min(c));
        let largest = angle(|[a, b, c]| a.max(b).max(c));
        let imbalance = |p: f64| {
            median(&junctions.iter().map(|junction| junction.imbalance(p)).collect::<Vec<_>>())
        };
        let median_width = median(&widths).filter(|width| *width > 0.0);
        let over = |times: f64| {
            let limit = times * median_width?;
            let wide = segments.iter().filter(|segment| segment.width > limit);
            // The sum turns the −0 of no lengths into 0.
            Some(wide.map(|segment| segment.length).sum::<f64>() / length + 0.0)
        };
        let ratio = |a: f64, b: f64| (b > 0.0).then(|| a / b);
        let count = |n: usize| n as f64;
        let scaled = |of: fn(&Distances) -> Option<f64>| Some(vla? * of(distances.as_ref()?)?);
        let courses = Courses::of(network, topology.loops());
        let architecture = architecture.unwrap_or(courses.architecture);
        let value = |key: &str| match key {
            "alignment" => Some(courses.alignment),
            "ends_at_margin" => courses.ends_at_margin,
            "fork_angle_median" => courses.fork_angle,
            "parallel_spacing" => courses.spacing,
            "parallel_spacing_variation" => courses.spacing_variation,
            "cross_vein_spacing" => courses.cross_spacing,
            "vla" => vla,
            "loop_index" => ratio(count(list.len()) * blade_area, length * length),
            // Of a tree all of it, whatever the order in which lengths were summed.
            "mst_ratio" => ratio(topology.spanning_length, length).map(|share| share.min(1.0)),
            "meshedness" => topology.meshedness(),
            "edges_per_node" => ratio(count(topology.segments), count(topology.nodes)),
            "degree_3_share" => ratio(count(topology.degree_3), count(topology.junctions)),
            "areole_ln_area_sd" => deviation(&ln_areas),
            "areole_elongation_median" => median(&elongations),
            "areole_circularity_median" => median(&circularities),
            "areole_segments_mean" => mean(&sides),
            "areole_free_ends_mean" => mean(&free_ends),
            "areoles_without_free_ends" => share(list, |areole| areole.free_ends == 0),
            "segment_length_variation" => variation(&lengths),
            "tortuosity_median" => median(&tortuosities),
            "vla_x_distance_mean" => scaled(|distances| Some(distances.mean)),
            "vla_x_inradius_mean" => scaled(|distances| distances.inradius_mean),
            "angle_smallest_median" => median(&smallest),
            "angle_largest_median" => median(&largest),
            "imbalance_median" => imbalance(1.0),
            "balanced_exponent" => balanced_exponent(&junctions),
            "width_ratio_max" => Some(widths.iter().copied().fold(0.0, f64::max) / median_width?),
            "length_share_over_2" => over(2.0),
            "nesting_excess" => excess,
            _ => unreachable!("every row has a value"),
        };
        let mut others = Vec::new();
        let mut other =
            |key: &str, name: &str, value: Option<f64>, band: Option<RangeInclusive<f64>>| {
                others.push(Measure::new(key, name, value, band));
            };
        if unit == Unit::Millimetre {
            other("vla", "vein length per area, mm/mm²", vla, Some(2.0..=15.0));
            let density = ratio(count(list.len()), blade_area);
            other("areole_density", "areoles per mm²", density, Some(3.7..=42.0));
        }
        let sqrt_areole = mean(&areas).map(f64::sqrt);
        other(
            "vla_x_sqrt_areole",
            "VLA x √mean areole area",
            vla.zip(sqrt_areole).map(|(a, b)| a * b),
            Some(1.22..=2.32),
        );
        other(
            "vla_x_leaf_sqrt_area",
            "VLA x √blade area",
            vla.map(|vla| vla * blade_area.sqrt()),
            Some(48.9..=373.0),
        );
        for (times, band) in
            [(1.25, 0.14..=0.30), (1.5, 0.06..=0.19), (3.0, 0.009..=0.043), (5.0, 0.0..=0.018)]
        {
            let key = format!("length_share_over_{times}");
            let name = format!("length share over {times} median widths");
            other(&key, &name, over(times), Some(band));
        }
        other(
            "areole_area_variation",
            "areole area, deviation / mean",
            variation(&areas),
            Some(0.57..=1.03),
        );
        other(
            "areole_elongation_mean",
            "areole elongation, mean",
            mean(&elongations),
            Some(1.48..=1.63),
        );
        other(
            "areole_elongation_p95",
            "areole elongation, 95th percentile",
            quantile(&elongations, 0.95),
            Some(2.07..=2.4),
        );
        other(
            "areole_circularity_p5",
            "areole circularity, 5th percentile",
            quantile(&circularities, 0.05),
            Some(0.48..=0.84),
        );
        other(
            "areole_circularity_p95",
            "areole circularity, 95th percentile",
            quantile(&circularities, 0.95),
            Some(0.48..=0.84),
        );
        other(
            "areole_segments_p5",
            "segments per areole, 5th percentile",
            quantile(&sides, 0.05),
            Some(4.0..=11.0),
        );
        other(
            "areole_segments_p95",
            "segments per areole, 95th percentile",
            quantile(&sides, 0.95),
            Some(4.0..=11.0),
        );
        other(
            "degree_4_share",
            "four-way share of junctions",
            ratio(count(topology.degree_4), count(topology.junctions)),
            Some(0.0..=0.04),
        );
        other(
            "ending_share",
            "free endings / nodes",
            ratio(count(topology.free_ends), count(topology.nodes)),
            Some(0.084..=0.372),
        );
        other(
            "junctions_per_areole",
            "junctions / areoles",
            ratio(count(topology.junctions), count(list.len())),
            Some(1.78..=4.11),
        );
        other(
            "tortuosity_p95",
            "tortuosity, 95th percentile",
            quantile(&tortuosities, 0.95),
            Some(1.0..=1.17),
        );
        other(
            "vla_x_distance_median",
            "VLA x median distance to vein",
            scaled(|d| Some(d.median)),
            Some(0.25..=0.27),
        );
        other(
            "vla_x_distance_p95",
            "VLA x 95th percentile of distance",
            scaled(|d| Some(d.p95)),
            Some(0.63..=0.76),
        );
        other(
            "inradius_variation",
            "areole inradius, deviation / mean",
            distances.and_then(|d| d.inradius_variation),
            Some(0.18..=0.26),
        );
        let all_angles: Vec<f64> = junctions.iter().flat_map(Junction::angles).collect();
        other("angle_mean", "junction angles, mean", mean(&all_angles), None);
        other(
            "angle_deviation",
            "junction angles, deviation",
            deviation(&all_angles),
            Some(26.0..=29.0),
        );
        other(
            "t_junctions",
            "share of junctions with an angle over 150°",
            share(&largest, |angle| *angle > 150.0),
            Some(0.29..=0.36),
        );
        other(
            "imbalance_p0",
            "force imbalance at p = 0, median",
            imbalance(0.0),
            Some(0.16..=0.19),
        );
        other(
            "imbalance_p2",
            "force imbalance at p = 2, median",
            imbalance(2.0),
            Some(0.15..=0.16),
        );
        let second: Vec<f64> = junctions.iter().map(|j| j.widths[1] / j.widths[0]).collect();
        other(
            "second_width_median",
            "second / widest width at a junction, median",
            median(&second),
            Some(0.88..=0.91),
        );
        let murray: Vec<f64> = junctions.iter().map(Junction::murray_exponent).collect();
        other("murray_median", "Murray exponent, median", median(&murray), Some(2.6..=3.9));
        let area_ratios: Vec<f64> = junctions.iter().map(Junction::area_ratio).collect();
        other(
            "area_ratio_median",
            "cross-sections after / before, median",
            median(&area_ratios),
            Some(1.14..=1.36),
        );
        other("nesting", "nesting number", nesting.map(|n| n.plain), Some(0.57..=0.70));
        other(
            "nesting_weighted",
            "nesting number, weighted",
            nesting.map(|n| n.weighted),
            Some(0.14..=0.58),
        );
        other("nesting_weighted_excess", "the same minus shuffled", weighted, None);
        Self {
            unit,
            topology,
            length,
            blade_area,
            distance_pixel: distances.map(|distances| distances.pixel),
            median_width,
            architecture,
            rows: rows(architecture, unit == Unit::Millimetre, value),
            others,
            orders: orders(network),
            strahler: strahler(network),
            angles: angle_bins(&junctions),
            exponents: exponent_bins(junctions),
            areoles: areoles.list,
        }
    }

    /// How many of the rows are inside their bands.
    #[must_use]
    pub fn rows_inside(&self) -> usize {
        self.rows.iter().filter(|row| row.is_inside()).count()
    }

    /// All measures with the number of their row, the rows first.
    pub fn all(&self) -> impl Iterator<Item = (Option<u32>, &Measure)> {
        let rows = self.rows.iter();
        let rows = rows.flat_map(|row| row.measures.iter().map(|m| (Some(row.number), m)));
        rows.chain(self.others.iter().map(|measure| (None, measure)))
    }
}

fn orders(network: &Network) -> Vec<OrderShare> {
    let of_order = |order: u8| {
        let these = network.segments().iter().filter(|segment| segment.order == order);
        let length: f64 = these.clone().map(|segment| segment.length).sum();
        let area: f64 = these.clone().map(|segment| segment.length * segment.width).sum();
        let segments = these.count();
        (segments > 0).then(|| OrderShare {
            order,
            segments,
            length,
            length_per_area: length / network.blade_area(),
            width: area / length,
        })
    };
    let highest = network.segments().iter().map(|segment| segment.order).max().unwrap_or(0);
    (1..=highest).filter_map(of_order).collect()
}
