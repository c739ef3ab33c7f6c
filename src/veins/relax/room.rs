//! Whether there is room for veins where a junction has moved to.

use glam::DVec2;

use super::net::Net;
use super::{LEAST_EDGE, LEAST_GAP, LEAST_SHRINK};
use crate::geometry::Rect;
use crate::geometry::box_cells::BoxCells;
use crate::geometry::polygon::{nearest_on_segment, segments_touch};
use crate::geometry::segments::SegmentIndex;
use crate::veins::graph::NodeId;

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

/// An edge and the box around it.
#[derive(Debug, Clone, Copy)]
struct Line {
    ends: [NodeId; 2],
    from: DVec2,
    to: DVec2,
    around: Rect,
}

impl Line {
    fn new(ends: [NodeId; 2], net: &Net) -> Self {
        let [from, to] = ends.map(|node| net.place(node));
        Self { ends, from, to, around: Rect::around([from, to]) }
    }

    /// Whether two edges touch, or come too close where they share a node.
    fn is_in_the_way(&self, other: &Self) -> bool {
        let [a, b] = self.ends;
        let [c, d] = other.ends;
        let (hub, mine, theirs) = if a == c {
            (self.from, (b, self.to), (d, other.to))
        } else if a == d {
            (self.from, (b, self.to), (c, other.from))
        } else if b == c {
            (self.to, (a, self.from), (d, other.to))
        } else if b == d {
            (self.to, (a, self.from), (c, other.from))
        } else {
            return segments_touch(self.from, self.to, other.from, other.to);
        };
        // The edge itself, or a second one between the same nodes.
        mine.0 != theirs.0 && is_gap_below(hub, mine.1, theirs.1, LEAST_GAP)
    }
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
            let line = Line::new(ends, net);
            let is_hit =
                |other: &Line| other.around.meets(line.around) && line.is_in_the_way(other);
            let is_at_margin = is_near_margin && self.margin.touches(line.from, line.to);
            !(is_at_margin || self.found.iter().any(is_hit))
        })
    }

    /// Finds the edges of which the boxes meet that of a star.
    fn look_around(&mut self, star: Rect, net: &Net) {
        let Self { edges, found, step, .. } = self;
        found.clear();
        let Some(edges) = edges else { return };
        // None goes farther than a step in a sweep.
        edges.for_each_meeting(star.grown(*step), |edge| {
            let line = Line::new(net.edges[edge as usize], net);
            if line.around.meets(star) {
                found.push(line);
            }
        });
    }
}

/// Whether two edges from `hub` keep apart by less than a share of the shorter one.
fn is_gap_below(hub: DVec2, a: DVec2, b: DVec2, share: f64) -> bool {
    let (to_a, to_b) = (a - hub, b - hub);
    let (along, across) = (to_a.dot(to_b), to_a.perp_dot(to_b));
    // The share is at least the sine of the angle between them, and 1 from a right angle on: only two that
    // lie nearly on each other are measured. A hundredth more, for rounding.
    let sine2 = 1.02 * share * share;
    if along <= 0.0 || across * across > sine2 * to_a.length_squared() * to_b.length_squared() {
        return false;
    }
    let apart =
        a.distance(nearest_on_segment(hub, b, a)).min(b.distance(nearest_on_segment(hub, a, b)));
    apart / hub.distance(a).min(hub.distance(b)) < share
}
