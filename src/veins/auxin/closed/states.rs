//! What each source knows of the nodes around it, and how it learns of new ones.

use glam::DVec2;

use super::super::NONE;
use super::super::field::{Hit, Told};
use super::super::horizon::Horizon;
use super::super::neighbours::Around;
use super::super::nodes::Nodes;
use super::{Sources, State};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

/// New nodes for each thread, at least: sharing out costs as much as some of them.
const A_THREAD: usize = 24;

impl Sources {
    /// Looks the neighbours of a place up from nothing.
    pub(super) fn look_around(&self, s: DVec2, nodes: &Nodes, metric: Metric) -> Around {
        look_around(s, nodes, metric, self.ranges.search(metric), &self.horizon)
    }

    pub(super) fn store(&mut self, i: usize, around: Around) {
        self.field.state_mut(i).around = around;
        self.field.set_bound2(i, around.most2());
    }

    /// Tells the sources around of the nodes from `before` on.
    pub(super) fn offer(&mut self, before: usize, metric: Metric, nodes: &Nodes) {
        let kill2 = self.ranges.kill2(metric);
        let search = self.ranges.search(metric);
        let hear = |hit: Hit, s: DVec2, state: &mut State| {
            let p = nodes.position(hit.node);
            state.around.offer(s, hit.node, p, hit.distance2, nodes, metric);
            let is_marked = hit.distance2 <= kill2 && state.tag == NONE;
            Told { bound2: state.around.most2(), is_marked }
        };
        let fresh = &nodes.positions()[before..];
        let reached = self.field.offer(before as NodeId, fresh, search, metric, A_THREAD, hear);
        self.reached.extend(reached);
    }
}

/// Looks the neighbours of a place up from nothing, as far as `search`.
pub(super) fn look_around(
    s: DVec2,
    nodes: &Nodes,
    metric: Metric,
    search: f64,
    horizon: &Horizon,
) -> Around {
    let mut around = Around::EMPTY;
    let mut ends = None;
    nodes.grid().for_each_outwards(
        nodes.positions(),
        &mut around,
        s,
        |around, clear| {
            let clear = metric.clearance(s, clear);
            if clear > search || around.is_settled(clear) {
                return false;
            }
            let ends = ends.get_or_insert_with(|| horizon.distances(s, metric));
            around.shade(s, horizon, ends, nodes, metric);
            !around.is_settled(clear)
        },
        |around, node, p| {
            let distance2 = metric.distance_squared(s, p);
            if distance2 <= search * search {
                around.offer(s, node, p, distance2, nodes, metric);
            }
        },
    );
    around
}
