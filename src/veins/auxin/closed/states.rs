//! What each source knows of the nodes around it, and how it learns of new ones.

use glam::DVec2;

use super::super::claims::NONE;
use super::super::extend::Nodes;
use super::super::neighbours::Around;
use super::{Calls, DEAD};
use crate::growth::Metric;
use crate::veins::graph::NodeId;

impl Calls {
    /// The place of the state of a source that is alive.
    pub(super) fn slot(&self, source: u32) -> Option<usize> {
        let slot = self.slots[source as usize];
        (slot != NONE && self.outer2[slot as usize] != DEAD).then_some(slot as usize)
    }

    /// Looks the neighbours of a place up from nothing.
    pub(super) fn look_around(&self, s: DVec2, nodes: &Nodes, metric: Metric) -> Around {
        let search = self.search(metric);
        let mut around = Around::EMPTY;
        let (low, high) = metric.corners_from(s, self.bounds);
        nodes.grid().for_each_outwards(
            &mut around,
            s,
            |around, clear| {
                let clear = metric.clearance(s, clear);
                clear <= search && !around.is_settled(clear, low, high)
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

    /// Drops the states of the dead and puts the others in order of place.
    pub(super) fn tidy(&mut self) {
        let size = self.bounds.size().max(DVec2::splat(f64::MIN_POSITIVE));
        let key = |p: DVec2| {
            let place = ((p - self.bounds.min) / size * f64::from(u16::MAX)).max(DVec2::ZERO);
            spread(place.x as u32) | spread(place.y as u32) << 1
        };
        let mut order: Vec<(u64, u32)> = Vec::with_capacity(self.living);
        for (i, state) in self.states.iter().enumerate() {
            if self.outer2[i] == DEAD {
                self.slots[state.source as usize] = NONE;
            } else {
                order.push((key(state.place), i as u32));
            }
        }
        order.sort_unstable();
        self.states = order.iter().map(|&(_, i)| self.states[i as usize]).collect();
        self.outer2 = order.iter().map(|&(_, i)| self.outer2[i as usize]).collect();
        for (slot, state) in self.states.iter().enumerate() {
            self.slots[state.source as usize] = slot as u32;
        }
    }

    pub(super) fn store(&mut self, i: usize, around: Around) {
        self.states[i].around = around;
        self.outer2[i] = around.most2();
    }

    /// Tells the sources around of a new node.
    pub(super) fn offer(&mut self, node: NodeId, metric: Metric, nodes: &Nodes) {
        let p = nodes.position(node);
        let search = self.search(metric);
        let (search2, kill2) = (search * search, self.kill2(metric));
        let slots = self.states.len() as u32;
        let Self { index, states, outer2, arrived, reached, .. } = self;
        let mut offer = |slot: u32, about2: f64| {
            let i = slot as usize;
            if about2 * (1.0 - 1e-9) >= outer2[i] {
                return;
            }
            let state = &mut states[i];
            let distance2 = metric.distance_squared(state.place, p);
            if distance2 >= outer2[i] || distance2 > search2 {
                return;
            }
            state.around.offer(state.place, node, p, distance2, nodes, metric);
            outer2[i] = state.around.most2();
            if !state.is_acting {
                state.is_acting = true;
                arrived.push(state.source);
            }
            if distance2 <= kill2 && state.tag == NONE {
                reached.push(state.source);
            }
        };
        if search.is_finite() {
            // The tree knows only the frame of the mature leaf, where the circle is an ellipse.
            let radius = metric.radius(p, search);
            index.for_each_within(p, radius, |slot, about2| offer(slot, metric.at_least(about2)));
        } else {
            (0..slots).for_each(|slot| offer(slot, 0.0));
        }
    }
}

/// The lower sixteen bits with a zero before each.
fn spread(bits: u32) -> u64 {
    let mut x = u64::from(bits & 0xffff);
    x = (x | x << 8) & 0x00ff_00ff;
    x = (x | x << 4) & 0x0f0f_0f0f;
    x = (x | x << 2) & 0x3333_3333;
    (x | x << 1) & 0x5555_5555
}
