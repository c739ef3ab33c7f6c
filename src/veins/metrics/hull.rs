//! The blade around a network whose margin is not known.
//!
//! A morphological closing: what lies within a reach of the veins, its holes filled, and drawn in
//! again by the same reach. The reach is twice the side of a mean areole, so that the bays between
//! the last veins close and lobes stay open.

use glam::DVec2;

use super::areoles::Areoles;
use super::lines::{Frame, Lines};
use super::network::Network;
use crate::geometry::{Rect, polygon};
use crate::raster::Grid;
use crate::raster::components::neighbours;
use crate::raster::contour;
use crate::raster::distance::nearest_sites;

/// Pixels along the longer side of the blade: the reach is some ten of them on a dense net.
const SIDE: f64 = 2048.0;

/// The outline of the blade around a network, anticlockwise; empty for one without extent.
#[must_use]
pub fn outline(network: &Network) -> Vec<DVec2> {
    let points = network.segments().iter().flat_map(|segment| segment.path.iter().copied());
    let bounds = Rect::around(points);
    let extent = bounds.size().max_element();
    if extent.is_nan() || extent <= 0.0 {
        return Vec::new();
    }
    let pixel = extent / SIDE;
    let reach = reach(network, bounds).clamp(3.0 * pixel, extent / 4.0);
    let frame = Frame::around(bounds.grown(reach + 2.0 * pixel), pixel, f64::INFINITY);
    let reach = (reach / frame.pixel) as f32;
    let near = Lines::of(network, frame).distances().map(|distance| *distance <= reach);
    let outside = reachable_from_border(&near);
    let nearest = nearest_sites(frame.width, frame.height, |i| outside[i]);
    let at = |i: usize| DVec2::new((i % frame.width) as f64, (i / frame.width) as f64);
    let mut pixel = 0;
    let depth = nearest.map(|&site| {
        let depth = at(pixel).distance(at(site as usize)) as f32 - reach;
        pixel += 1;
        depth
    });
    let lines = contour::contours(&depth, 0.0);
    let area = |line: &Vec<DVec2>| polygon::signed_area(line);
    let largest = lines.into_iter().max_by(|a, b| area(a).total_cmp(&area(b))).unwrap_or_default();
    // The y axis turns over, and the winding with it.
    largest.into_iter().rev().map(|p| frame.leaf_from_pixel(p)).collect()
}

fn reach(network: &Network, bounds: Rect) -> f64 {
    let areas: Vec<f64> = Areoles::of(network).list.iter().map(|areole| areole.area).collect();
    let size = bounds.size();
    // Without areoles: the spacing of veins that fill the box evenly.
    let spacing = super::statistics::mean(&areas)
        .map_or_else(|| size.x * size.y / network.length(), f64::sqrt);
    2.0 * spacing
}

/// The pixels off the mask that hang together with the border.
fn reachable_from_border(mask: &Grid<bool>) -> Vec<bool> {
    let (width, height) = (mask.width(), mask.height());
    let mut outside = vec![false; width * height];
    let is_border = |i: &usize| {
        let (x, y) = (i % width, i / width);
        x == 0 || y == 0 || x + 1 == width || y + 1 == height
    };
    let mut open: Vec<usize> =
        (0..width * height).filter(is_border).filter(|&i| !mask.values()[i]).collect();
    open.iter().for_each(|&i| outside[i] = true);
    while let Some(i) = open.pop() {
        for next in neighbours(i, width, height) {
            if !mask.values()[next] && !outside[next] {
                outside[next] = true;
                open.push(next);
            }
        }
    }
    outside
}
