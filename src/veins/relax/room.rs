//! Whether there is room for veins where a junction has moved to.

use super::net::Net;
use super::{LEAST_EDGE, LEAST_SHRINK};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::NodeId;
use crate::veins::planar::Line;

/// An edge of which both ends may have moved, and how long it was before.
pub(super) type Moved = ([NodeId; 2], f64);

/// Cells in which edges are looked for, in steps: about as wide as half of what is looked at at once.
const CELL: f64 = 2.0;

/// What is around: the margin, and the veins as they were when a sweep began.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) margin: SegmentIndex,
    step: f64,
    edges: Option<BoxCells>,
    found: Vec<Line>,
}

impl Room {
    pub(super) fn new(margin: SegmentIndex, step: f64) -> Self {
        Self { margin, step, edges: None, found: Vec::new() }
    }

    /// Takes note of where the veins are.
    pub(super) fn begin_sweep(&mut self, net: &Net) {
        let boxes = net.edges.iter().map(|ends| Rect::around(ends.map(|node| net.place(node))));
        let bounds = Rect::around(net.positions.iter().copied());
        self.edges = Some(BoxCells::new(bounds, CELL * self.step, boxes));
    }

    /// Whether edges may be where they are now.
    pub(super) fn is_sound(&mut self, moved: &[Moved], net: &Net) -> bool {
        let keeps_length = |&([a, b], old): &Moved| {
            let length = net.place(a).distance(net.place(b));
            length >= old || (length >= old * LEAST_SHRINK && length >= self.step * LEAST_EDGE)
        };
        if !moved.iter().all(keeps_length) {
            return false;
        }
        let ends = moved.iter().flat_map(|&(ends, _)| ends);
        let star = Rect::around(ends.map(|node| net.place(node)));
        let is_near_margin = self.margin.any_near(star.min, star.max, |_| true);
        self.look_around(star, net);
        moved.iter().all(|&(ends, _)| {
            let line = Line::new(ends, &net.positions);
            let [from, to] = ends.map(|node| net.place(node));
            let is_at_margin = is_near_margin && self.margin.touches(from, to);
            !(is_at_margin || self.found.iter().any(|other| line.is_in_the_way(other)))
        })
    }

    /// Finds the edges of which the boxes meet that of a star.
    fn look_around(&mut self, star: Rect, net: &Net) {
        let Self { edges, found, step, .. } = self;
        found.clear();
        let Some(edges) = edges else { return };
        // None goes farther than a step in a sweep.
        edges.for_each_meeting(star.grown(*step), |edge| {
            let line = Line::new(net.edges[edge as usize], &net.positions);
            if line.around().meets(star) {
                found.push(line);
            }
        });
    }
}
