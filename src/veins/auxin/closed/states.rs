//! What each source knows of the nodes around it, and how it learns of new ones.

use glam::DVec2;

use super::super::NONE;
use super::super::extend::Nodes;
use super::super::neighbours::Around;
use super::{Sources, State};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

impl Sources {
    /// Looks the neighbours of a place up from nothing.
    pub(super) fn look_around(&self, s: DVec2, nodes: &Nodes, metric: Metric) -> Around {
        let search = self.ranges.search(metric);
        let bounds = self.field.bounds();
        let mut around = Around::EMPTY;
        let (low, high) =
            ((bounds.min - s) * metric.stretch, (bounds.max - s) * metric.stretch);
        let stretch = metric.stretch.min_element();
        nodes.grid().for_each_outwards(
            &mut around,
            s,
            |around, clear| {
                clear * stretch <= search && !around.is_settled(clear * stretch, low, high)
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

    pub(super) fn store(&mut self, i: usize, around: Around) {
        self.field.state_mut(i).around = around;
        self.field.set_bound2(i, around.most2());
    }

    /// Tells the sources around of a new node.
    pub(super) fn offer(&mut self, node: NodeId, metric: Metric, nodes: &Nodes) {
        let p = nodes.position(node);
        let Self { field, ranges, hits, reached, .. } = self;
        let kill2 = ranges.kill2(metric);
        hits.clear();
        field.find(p, metric.reach(ranges.search(metric)), ranges.search2(metric), metric, hits);
        for &hit in hits.iter() {
            let (id, s) = field.id_and_place(hit.slot as usize);
            let near = hit.distance2 <= kill2;
            field.tell(hit, |State { around, tag }| {
                around.offer(s, node, p, hit.distance2, nodes, metric);
                if near && *tag == NONE {
                    reached.push(id);
                }
                around.most2()
            });
        }
    }
}
