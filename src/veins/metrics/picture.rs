//! A network from a black-and-white picture of veins.
//!
//! The largest connected part of the veins is thinned to a skeleton; the width of a segment is
//! twice the median distance from its centre line to the tissue; spurs shorter than 1.3 times their
//! width are bumps of the edge of a vein, not veins, and go, one generation after the other. The
//! blade is what [`hull::outline`](super::hull::outline) finds around the veins.

use glam::DVec2;

use super::network::{Network, Segment, merged};
use crate::raster::Grid;
use crate::raster::components::{Components, neighbours};
use crate::raster::skeleton::Skeleton;

/// Ends shorter than this many times their width are no veins.
const SPUR: f64 = 1.3;

/// Widths of fewer pixels than this are too coarse for measures of width and angle.
pub const FINEST_WIDTH_PX: f64 = 6.0;

/// The network of the veins in a mask, each pixel `pixel` wide; y up, the lower left corner of the
/// picture at the origin. Without veins it is empty.
///
/// # Panics
///
/// If a side is longer than 16 384 pixels.
#[must_use]
pub fn network(veins: Grid<bool>, pixel: f64) -> Network {
    let height = veins.height() as f64;
    let veins = without_pinholes(largest(veins));
    let skeleton = Skeleton::of(&veins);
    let place = |p: DVec2| DVec2::new(p.x, height - p.y) * pixel;
    let nodes: Vec<DVec2> = skeleton.nodes.iter().map(|&p| place(p)).collect();
    let segment = |line: crate::raster::skeleton::Line| {
        let path = line.path.iter().map(|&p| place(p)).collect();
        Segment::new(line.ends, path, 2.0 * line.half_width * pixel, 0)
    };
    let mut segments: Vec<Segment> = skeleton.lines.into_iter().map(segment).collect();
    loop {
        let before = segments.len();
        segments = without_spurs(nodes.len(), segments);
        if segments.len() == before {
            break;
        }
        segments = merged(nodes.len(), &segments);
    }
    Network::new(&nodes, &segments, &[], &[])
}

fn largest(mut veins: Grid<bool>) -> Grid<bool> {
    let parts = Components::of(&veins);
    let largest = parts.largest().map_or(0, |(label, _)| label);
    for (vein, &label) in veins.values_mut().iter_mut().zip(parts.labels.values()) {
        *vein = label != 0 && label == largest;
    }
    veins
}

/// Fills holes smaller than a vein is wide each way: noise of the picture, which as areoles would
/// spoil every mean over them.
fn without_pinholes(mut veins: Grid<bool>) -> Grid<bool> {
    let (width, height) = (veins.width(), veins.height());
    let (mut area, mut sides) = (0u64, 0u64);
    for i in (0..width * height).filter(|&i| veins.values()[i]) {
        area += 1;
        sides += neighbours(i, width, height).filter(|&next| !veins.values()[next]).count() as u64;
    }
    // A strip has twice its length as boundary, and pixels make that longer by 4/π on the mean.
    let boundary = sides as f64 * std::f64::consts::FRAC_PI_4;
    let mean_width = 2.0 * area as f64 / boundary.max(1.0);
    let regions = Components::of(&veins.map(|vein| !vein));
    for (vein, &label) in veins.values_mut().iter_mut().zip(regions.labels.values()) {
        let region = regions.areas[label as usize] as f64;
        *vein |= label != 0 && region < mean_width * mean_width;
    }
    veins
}

fn without_spurs(nodes: usize, mut segments: Vec<Segment>) -> Vec<Segment> {
    let mut degrees = vec![0; nodes];
    segments.iter().flat_map(|segment| segment.ends).for_each(|end| degrees[end] += 1);
    segments.retain(|segment| {
        let ends = segment.ends.map(|end| degrees[end]);
        let is_end = ends.contains(&1) && ends != [1, 1];
        !(is_end && segment.length < SPUR * segment.width)
    });
    segments
}
