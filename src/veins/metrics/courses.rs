//! Which way veins run: all one way, as in a grass, or apart and to the margin, as in a ginkgo.

use glam::DVec2;

use super::junctions::junctions;
use super::network::Network;
use super::rows::Architecture;
use super::statistics::{median, share, variation};
use crate::geometry::segments::SegmentIndex;

/// A piece of vein belongs to the long ones when it is within 30 degrees of the axis of the blade.
const ALONG: f64 = 0.866;

/// From this alignment on veins are parallel.
const ALIGNED: f64 = 0.8;

/// Loops to the segment below which veins are open: a broken picture has a few by chance.
const OPEN: f64 = 0.002;

/// An end is at the margin when it is no farther than this from it, in mean spacings of the veins.
const AT_MARGIN: f64 = 1.0;

/// Scans across the blade on which the spacing of long veins is taken.
const SCANS: usize = 40;

/// Veins are counted on lines at these shares of the length of the blade, to tell fans from parallel
/// veins.
const FAR_APART: [f64; 2] = [0.25, 0.7];

/// How the veins of a network run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Courses {
    /// |Σ l e^(2iθ)| / Σ l over the pieces of all veins: 1 when all run one way, 0 for a net.
    pub alignment: f64,
    /// Share of the free ends that lie at the margin.
    pub ends_at_margin: Option<f64>,
    /// Median angle between the two thinner veins of a junction (degrees).
    pub fork_angle: Option<f64>,
    /// Mean distance between neighbouring long veins: blade area over their length.
    pub spacing: Option<f64>,
    /// Deviation over mean of the gaps between long veins on lines across the blade, line by line.
    pub spacing_variation: Option<f64>,
    /// Mean distance between cross-veins along the strip between two long veins.
    pub cross_spacing: Option<f64>,
    /// What that makes of the leaf.
    pub architecture: Architecture,
}

impl Courses {
    /// Of a network with so many independent loops.
    #[must_use]
    pub fn of(network: &Network, loops: usize) -> Self {
        let pieces: Vec<[DVec2; 2]> = network
            .segments()
            .iter()
            .flat_map(|segment| segment.path.windows(2).map(|pair| [pair[0], pair[1]]))
            .collect();
        // Doubled angles: a vein has no direction.
        let doubled: DVec2 = pieces
            .iter()
            .map(|[a, b]| {
                let d = *b - *a;
                let length = d.length();
                if length > 0.0 {
                    DVec2::new(d.x * d.x - d.y * d.y, 2.0 * d.x * d.y) / length
                } else {
                    DVec2::ZERO
                }
            })
            .sum();
        let total = network.length();
        let alignment = if total > 0.0 { doubled.length() / total } else { 0.0 };
        let turn = 0.5 * libm::atan2(doubled.y, doubled.x);
        let axis = DVec2::new(libm::cos(turn), libm::sin(turn));
        let ends_at_margin = ends_at_margin(network);
        let is_open = (loops as f64) <= OPEN * network.segments().len() as f64;
        let lines = scans(network, &pieces, axis);
        // A fan has more veins the farther out; parallel ones run side by side all the way.
        let counts = FAR_APART.map(|share| lines[(share * SCANS as f64) as usize].len());
        let fans_out = counts[0].max(counts[1]) > 2 * counts[0].min(counts[1]);
        let architecture = if alignment >= ALIGNED && !(is_open && fans_out) {
            Architecture::Parallel
        } else if is_open && (fans_out || ends_at_margin > Some(0.5)) {
            Architecture::Dichotomous
        } else {
            Architecture::Reticulate
        };
        let along = |d: DVec2| d.normalize_or_zero().dot(axis).abs() >= ALONG;
        let long: f64 =
            pieces.iter().filter(|[a, b]| along(*b - *a)).map(|[a, b]| a.distance(*b)).sum();
        let crossing = network.segments().iter().filter(|segment| {
            let ends = [segment.path[0], segment.path[segment.path.len() - 1]];
            !along(ends[1] - ends[0])
        });
        let crossing = crossing.count();
        let forks: Vec<f64> =
            junctions(network).iter().map(|junction| junction.angles()[2]).collect();
        Self {
            alignment,
            ends_at_margin,
            fork_angle: median(&forks),
            spacing: (long > 0.0).then(|| network.blade_area() / long),
            spacing_variation: spacing_variation(&lines),
            cross_spacing: (crossing > 0).then(|| long / crossing as f64),
            architecture,
        }
    }
}

fn ends_at_margin(network: &Network) -> Option<f64> {
    let (area, length) = (network.blade_area(), network.length());
    if !(area > 0.0 && length > 0.0) {
        return None;
    }
    let margin = SegmentIndex::of_polygon(network.outline());
    let reach = AT_MARGIN * area / length;
    let degrees = network.degrees();
    let ends: Vec<usize> =
        (0..degrees.len()).filter(|&i| degrees[i] == 1 && !network.is_root(i)).collect();
    share(&ends, |&end| margin.nearest(network.nodes()[end], reach).is_some())
}

/// Where long veins cross lines across the blade, evenly along its axis; each line sorted.
fn scans(network: &Network, pieces: &[[DVec2; 2]], axis: DVec2) -> Vec<Vec<f64>> {
    let heights = network.outline().iter().map(|p| p.dot(axis));
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), height| {
        (low.min(height), high.max(height))
    });
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); SCANS];
    for [a, b] in pieces {
        let (from, to) = (a.dot(axis), b.dot(axis));
        if (to - from).abs() < ALONG * a.distance(*b) {
            continue;
        }
        let scan = |height: f64| (height - low) / (high - low) * SCANS as f64 - 0.5;
        let (first, last) = (scan(from.min(to)).ceil().max(0.0), scan(from.max(to)));
        for i in (first as usize..SCANS).take_while(|&i| (i as f64) < last) {
            let height = low + (i as f64 + 0.5) / SCANS as f64 * (high - low);
            let p = a.lerp(*b, (height - from) / (to - from));
            crossings[i].push(axis.perp_dot(p));
        }
    }
    crossings.iter_mut().for_each(|line| line.sort_by(f64::total_cmp));
    crossings
}

/// The mean over the lines that cross 4 veins or more.
fn spacing_variation(lines: &[Vec<f64>]) -> Option<f64> {
    let variations: Vec<f64> = lines
        .iter()
        .filter_map(|line| {
            let gaps: Vec<f64> = line.windows(2).map(|pair| pair[1] - pair[0]).collect();
            if gaps.len() >= 3 { variation(&gaps) } else { None }
        })
        .collect();
    super::statistics::mean(&variations)
}
