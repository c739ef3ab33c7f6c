//! How far the tissue is from its nearest vein.
//!
//! On a grid over the whole blade, from pixel centres to the centre lines of the veins, free-ending
//! ones included. The inradius of an areole is the greatest distance in it.

use rayon::prelude::*;

use super::lines::{Frame, Lines};
use super::network::Network;
use super::statistics::{mean, variation};
use crate::geometry::Rect;
use crate::raster::components::Components;
use crate::raster::{Grid, coverage};

/// Distances in a blade.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Distances {
    /// Side of a pixel of the grid they were measured on.
    pub pixel: f64,
    /// Mean over the blade.
    pub mean: f64,
    /// Median over the blade.
    pub median: f64,
    /// 95th percentile over the blade.
    pub p95: f64,
    /// Mean over the areoles of the greatest distance in each.
    pub inradius_mean: Option<f64>,
    /// Deviation over mean of the same.
    pub inradius_variation: Option<f64>,
}

/// Pixels to the mean spacing of veins (blade area over vein length): mean distances are then some
/// 5 pixels, and the error below 1 %.
const PIXELS_PER_SPACING: f64 = 16.0;

/// Pixels at the most: half a gigabyte of memory at the height of it.
const MOST_PIXELS: f64 = 16e6;

impl Distances {
    /// Measures a network with so many areoles; `None` without veins or blade.
    #[must_use]
    pub fn of(network: &Network, areoles: usize) -> Option<Self> {
        let (area, length) = (network.blade_area(), network.length());
        if !(area > 0.0 && length > 0.0) {
            return None;
        }
        let veins = network.segments().iter().flat_map(|segment| segment.path.iter());
        let bounds = Rect::around(veins.chain(network.outline()).copied());
        let frame = Frame::around(bounds, area / length / PIXELS_PER_SPACING, MOST_PIXELS);
        let lines = Lines::of(network, frame);
        let distances = lines.distances();
        let inside = inside(network, &frame);
        let mut all: Vec<f32> = distances
            .values()
            .iter()
            .zip(inside.values())
            .filter_map(|(&distance, &inside)| inside.then_some(distance))
            .collect();
        if all.is_empty() {
            return None;
        }
        let total: f64 = all.iter().map(|&distance| f64::from(distance)).sum();
        let mut quantile = |q: f64| {
            let place = (q * (all.len() - 1) as f64) as usize;
            f64::from(*all.select_nth_unstable_by(place, f32::total_cmp).1) * frame.pixel
        };
        let (median, p95) = (quantile(0.5), quantile(0.95));
        let inradii = inradii(&lines, &inside, &distances, areoles);
        Some(Self {
            pixel: frame.pixel,
            mean: total / all.len() as f64 * frame.pixel,
            median,
            p95,
            inradius_mean: mean(&inradii),
            inradius_variation: variation(&inradii),
        })
    }
}

/// The pixels whose greater part lies in the blade.
fn inside(network: &Network, frame: &Frame) -> Grid<bool> {
    let outline: Vec<_> = network.outline().iter().map(|&p| frame.pixel_from_leaf(p)).collect();
    let rows: Vec<usize> = (0..frame.height).step_by(64).collect();
    let values: Vec<bool> = rows
        .into_par_iter()
        .flat_map_iter(|row| {
            let end = (row + 64).min(frame.height);
            coverage::polygon_rows(&outline, frame.width, row..end).into_iter().map(|c| c > 0.5)
        })
        .collect();
    Grid::from_values(frame.width, frame.height, values)
}

/// The greatest distance in each areole (in leaf units).
fn inradii(lines: &Lines, inside: &Grid<bool>, distances: &Grid<f32>, areoles: usize) -> Vec<f64> {
    let mut pixel = 0;
    let tissue = inside.map(|_| {
        pixel += 1;
        !lines.is_line(pixel - 1)
    });
    let regions = Components::of(&tissue);
    let mut greatest = vec![0.0f32; regions.areas.len()];
    for (i, &label) in regions.labels.values().iter().enumerate() {
        let greatest = &mut greatest[label as usize];
        // What reaches beyond the blade is no areole.
        let distance = if inside.values()[i] { distances.values()[i] } else { f32::INFINITY };
        *greatest = greatest.max(distance);
    }
    let mut closed: Vec<usize> =
        (1..greatest.len()).filter(|&label| greatest[label].is_finite()).collect();
    // Pixels between veins that pass each other closely are cut off too: the largest regions are
    // the areoles.
    closed.sort_by_key(|&label| std::cmp::Reverse(regions.areas[label]));
    let of_areole = closed.into_iter().take(areoles).map(|label| f64::from(greatest[label]));
    of_areole.map(|distance| distance * lines.frame.pixel).collect()
}
