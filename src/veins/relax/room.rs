//! Whether there is room for veins where a junction has moved to.

use glam::DVec2;

use super::net::Net;
use super::{LEAST_EDGE, LEAST_SHRINK};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::NodeId;
use crate::veins::planar::{CLEARANCE_MM, Line};

/// An edge of which both ends may have moved, and how long it was before.
pub(super) type Moved = ([NodeId; 2], f64);

/// Cells in which edges are looked for, in steps: a few across what is looked at at once.
const CELL: f64 = 1.4;

/// What is around: the margin, and the veins as they were when a sweep began.
#[derive(Debug)]
pub(super) struct Room {
    pub(super) margin: SegmentIndex,
    step: f64,
    edges: Option<BoxCells>,
    /// Where the nodes were when the sweep began.
    begun: Vec<DVec2>,
    /// The farthest that any has come since.
    farthest: f64,
    /// The edges that are asked about, and those around them.
    lines: Vec<Line>,
    found: Vec<Line>,
}

impl Room {
    pub(super) fn new(margin: SegmentIndex, step: f64) -> Self {
        Self {
            margin,
            step,
            edges: None,
            begun: Vec::new(),
            farthest: 0.0,
            lines: Vec::new(),
            found: Vec::new(),
        }
    }

    /// Takes note of where the veins are.
    pub(super) fn begin_sweep(&mut self, net: &Net) {
        let boxes = net.edges.iter().map(|&[a, b]| Rect::between(net.place(a), net.place(b)));
        let bounds = Rect::around(net.positions.iter().copied());
        self.edges = Some(BoxCells::new(bounds, CELL * self.step, boxes));
        self.begun.clone_from(&net.positions);
        self.farthest = 0.0;
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
        let Self { margin, begun, lines, .. } = self;
        lines.clear();
        lines.extend(moved.iter().map(|&(ends, _)| Line::new(ends, &net.positions)));
        let boxes = lines.iter().map(Line::around);
        let Some(star) = boxes.reduce(Rect::joined) else { return true };
        let mut farthest = self.farthest;
        for node in moved.iter().flat_map(|(ends, _)| ends) {
            farthest = farthest.max(begun[*node as usize].distance(net.place(*node)));
        }
        let is_near_margin = margin.any_near(star.min, star.max, |_| true);
        if is_near_margin && lines.iter().any(|line| line.touches(margin)) {
            return false;
        }
        self.look_around(star, farthest, net);
        let Self { lines, found, .. } = self;
        let sound = !lines.iter().any(|line| found.iter().any(|other| line.is_in_the_way(other)));
        if sound {
            self.farthest = farthest;
        }
        sound
    }

    /// Finds the edges of which the boxes meet that of a star, when none has come farther than this.
    fn look_around(&mut self, star: Rect, farthest: f64, net: &Net) {
        let Self { edges, found, .. } = self;
        found.clear();
        let Some(edges) = edges else { return };
        edges.for_each_meeting(star.grown(farthest + CLEARANCE_MM), |edge| {
            let line = Line::new(net.edges[edge as usize], &net.positions);
            if line.around().meets(star) {
                found.push(line);
            }
        });
    }
}
