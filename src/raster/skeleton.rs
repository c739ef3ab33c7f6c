//! The skeleton of a mask as a graph: lines between forks and ends, with the half-width of the mask
//! along them.
//!
//! Thinning as in [`thinning`](super::thinning). Fork pixels that touch are one fork, at their mean.
//! Lines are evened out, since the staircase of a skeleton is up to 8 % too long.

use std::collections::HashMap;

use super::Grid;
use super::distance::nearest_sites;
use super::thinning::{AROUND, thinned};
use crate::geometry::DVec2;

/// A line of a skeleton.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The nodes at its two ends; the same one for a ring.
    pub ends: [usize; 2],
    /// Its course, from node to node (pixels, y down; pixel centres at + 0.5).
    pub path: Vec<DVec2>,
    /// Median over its pixels of the distance to the nearest pixel off the mask.
    pub half_width: f64,
}

/// A skeleton as a graph.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Skeleton {
    /// Forks and ends; on a ring without forks, some point of it.
    pub nodes: Vec<DVec2>,
    /// The lines between them.
    pub lines: Vec<Line>,
}

/// The number of the node at a pixel: those that are no fork or end have none.
const NO_NODE: u32 = u32::MAX;

/// How many times a line is evened out, by the mean of every point and its neighbours.
const EVENED: usize = 4;

impl Skeleton {
    /// The skeleton of a mask.
    ///
    /// # Panics
    ///
    /// If a side is longer than 16 384 pixels.
    #[must_use]
    pub fn of(mask: &Grid<bool>) -> Self {
        Self::follow(&thinned(mask), mask)
    }

    fn follow(thin: &Grid<bool>, mask: &Grid<bool>) -> Self {
        let width = thin.width();
        let pixels: Vec<usize> = (0..thin.values().len()).filter(|&i| thin.values()[i]).collect();
        let half_widths = half_widths(mask, &pixels);
        let mut node_of: HashMap<usize, u32> = HashMap::new();
        let mut skeleton = Self::default();
        for &pixel in &pixels {
            let degree = links(thin, pixel).count();
            if degree > 2 && !node_of.contains_key(&pixel) {
                skeleton.add_fork(thin, pixel, &mut node_of);
            } else if degree == 1 {
                node_of.insert(pixel, skeleton.nodes.len() as u32);
                skeleton.nodes.push(centre(pixel, width));
            }
        }
        // A step from one pixel to another is taken once only, in one direction.
        let mut walked: std::collections::HashSet<(usize, usize)> = Default::default();
        for rings in [false, true] {
            for &start in &pixels {
                if rings {
                    // Rings have no node yet, and no pixel of theirs has been walked.
                    let fresh = |next| !walked.contains(&(start, next));
                    if node_of.contains_key(&start) || !links(thin, start).any(fresh) {
                        continue;
                    }
                    node_of.insert(start, skeleton.nodes.len() as u32);
                    skeleton.nodes.push(centre(start, width));
                }
                let Some(&node) = node_of.get(&start) else { continue };
                for first in links(thin, start) {
                    if node_of.get(&first) == Some(&node) || !walked.insert((start, first)) {
                        continue;
                    }
                    let mut line = vec![start, first];
                    let mut at = first;
                    walked.insert((first, start));
                    while !node_of.contains_key(&at) {
                        let before = line[line.len() - 2];
                        let Some(next) = links(thin, at).find(|&next| next != before) else {
                            break;
                        };
                        walked.insert((at, next));
                        walked.insert((next, at));
                        line.push(next);
                        at = next;
                    }
                    let end = node_of.get(&at).copied().unwrap_or(NO_NODE);
                    if end != NO_NODE {
                        skeleton.add_line([node, end], &line, width, &half_widths);
                    }
                }
            }
        }
        skeleton
    }

    /// A node for a fork and all fork pixels that hang together with it.
    fn add_fork(&mut self, thin: &Grid<bool>, first: usize, node_of: &mut HashMap<usize, u32>) {
        let node = self.nodes.len() as u32;
        let (mut sum, mut count) = (DVec2::ZERO, 0.0);
        let mut open = vec![first];
        node_of.insert(first, node);
        while let Some(pixel) = open.pop() {
            sum += centre(pixel, thin.width());
            count += 1.0;
            for next in links(thin, pixel) {
                if !node_of.contains_key(&next) && links(thin, next).count() > 2 {
                    node_of.insert(next, node);
                    open.push(next);
                }
            }
        }
        self.nodes.push(sum / count);
    }

    fn add_line(
        &mut self,
        ends: [u32; 2],
        line: &[usize],
        width: usize,
        half_widths: &HashMap<usize, f32>,
    ) {
        let ends = ends.map(|end| end as usize);
        let mut widths: Vec<f32> = line.iter().map(|pixel| half_widths[pixel]).collect();
        widths.sort_unstable_by(f32::total_cmp);
        let half_width = f64::from(widths[widths.len() / 2]);
        // The pixels at the ends stand for their nodes.
        let mut path = vec![self.nodes[ends[0]]];
        path.extend(line[1..line.len() - 1].iter().map(|&pixel| centre(pixel, width)));
        path.push(self.nodes[ends[1]]);
        for _ in 0..EVENED {
            let before = path.clone();
            for i in 1..path.len() - 1 {
                path[i] = before[i] * 0.5 + (before[i - 1] + before[i + 1]) * 0.25;
            }
        }
        self.lines.push(Line { ends, path, half_width });
    }
}

fn centre(pixel: usize, width: usize) -> DVec2 {
    DVec2::new((pixel % width) as f64 + 0.5, (pixel / width) as f64 + 0.5)
}

/// The pixels next to a skeleton pixel; diagonal steps only where no pair of straight steps does
/// the same.
fn links(thin: &Grid<bool>, pixel: usize) -> impl Iterator<Item = usize> + '_ {
    let width = thin.width();
    let (x, y) = ((pixel % width) as isize, (pixel / width) as isize);
    let set = move |x: isize, y: isize| thin.get(x, y) == Some(&true);
    AROUND.into_iter().filter_map(move |(dx, dy)| {
        let around_corner = dx != 0 && dy != 0 && (set(x + dx, y) || set(x, y + dy));
        (set(x + dx, y + dy) && !around_corner)
            .then(|| (y + dy) as usize * width + (x + dx) as usize)
    })
}

/// The distance from each of some pixels to the nearest pixel off the mask; what lies beyond the
/// picture counts as on it.
fn half_widths(mask: &Grid<bool>, pixels: &[usize]) -> HashMap<usize, f32> {
    let width = mask.width();
    let nearest = nearest_sites(width, mask.height(), |i| !mask.values()[i]);
    let distance = |pixel: usize| match nearest.values()[pixel] {
        super::distance::NO_SITE => width.max(mask.height()) as f32,
        site => centre(pixel, width).distance(centre(site as usize, width)) as f32,
    };
    pixels.iter().map(|&pixel| (pixel, distance(pixel))).collect()
}
