//! The veins that are left of a damaged blade: cut off where a gap or a bite begins.

use glam::DVec2;

use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::veins::{NodeId, VeinGraph, Venation};

/// The veins within the `rings` of what is left of the blade, as
/// [`TextureSet::rings`](crate::texture::TextureSet::rings) gives them; all of them where there are none.
/// A vein ends on the ring that cuts it, and what is left of it beyond a gap begins on the gap's far side,
/// as a root.
pub(super) fn remaining(venation: &Venation, rings: &[Vec<DVec2>]) -> Option<Venation> {
    if rings.is_empty() {
        return None;
    }
    let edges = rings.iter().flat_map(|ring| polygon::edges(ring)).collect();
    let mut left = Remains {
        venation,
        tissue: SegmentIndex::new(edges),
        places: vec![None; venation.graph().len()],
        graph: VeinGraph::new(),
        radii: Vec::new(),
        orders: Vec::new(),
    };
    for node in 0..venation.graph().len() as NodeId {
        left.add(node);
    }
    for &(a, b) in venation.graph().joins() {
        left.join(a, b);
    }
    Some(Venation::new(left.graph, left.radii, left.orders))
}

struct Remains<'a> {
    venation: &'a Venation,
    tissue: SegmentIndex,
    /// What has become of each node.
    places: Vec<Option<NodeId>>,
    graph: VeinGraph,
    radii: Vec<f64>,
    orders: Vec<u8>,
}

impl Remains<'_> {
    fn at(&self, node: NodeId) -> DVec2 {
        self.venation.graph().positions()[node as usize]
    }

    /// Adds a place of the vein of `node`, out of `parent` or as a root.
    fn place(&mut self, parent: Option<NodeId>, position: DVec2, node: NodeId) -> NodeId {
        let id = match parent {
            Some(parent) => self.graph.sprout(parent, position),
            None => self.graph.add_root(position),
        };
        self.radii.push(self.venation.radii()[node as usize]);
        self.orders.push(self.venation.orders()[node as usize]);
        if let Some(rank) = self.venation.graph().rank(node) {
            self.graph.set_rank(id, rank);
        }
        id
    }

    /// The last place in the tissue on the way from `inside` to `outside`.
    fn cut(&self, mut inside: DVec2, mut outside: DVec2) -> DVec2 {
        for _ in 0..30 {
            let middle = inside.midpoint(outside);
            if self.tissue.contains(middle) {
                inside = middle;
            } else {
                outside = middle;
            }
        }
        inside
    }

    fn add(&mut self, node: NodeId) {
        let here = self.at(node);
        let whole = self.tissue.contains(here);
        let parent = self.venation.graph().parent(node);
        let Some(parent) = parent else {
            // The petiole holds the base, which stands on the outline.
            self.places[node as usize] = Some(self.place(None, here, node));
            return;
        };
        let (from, left) = (self.at(parent), self.places[parent as usize]);
        let crossed = self.tissue.touches(from, here);
        match (left, whole) {
            (Some(left), true) if !crossed || self.venation.graph().parent(parent).is_none() => {
                self.places[node as usize] = Some(self.place(Some(left), here, node));
            }
            (Some(left), false) => {
                let end = self.cut(from, here);
                if end.distance(from) > LEAST_MM {
                    self.place(Some(left), end, node);
                }
            }
            (_, true) => {
                let start = self.cut(here, from);
                let root = (left.is_none() && start.distance(here) > LEAST_MM)
                    .then(|| self.place(None, start, node));
                self.places[node as usize] = Some(self.place(root, here, node));
            }
            (None, false) => {}
        }
    }

    fn join(&mut self, a: NodeId, b: NodeId) {
        let places = [a, b].map(|node| self.places[node as usize]);
        let (p, q) = (self.at(a), self.at(b));
        match places {
            [Some(one), Some(other)] if !self.tissue.touches(p, q) => self.graph.join(one, other),
            [Some(left), None] => self.stub(left, p, q, a),
            [None, Some(left)] => self.stub(left, q, p, b),
            _ => {}
        }
    }

    fn stub(&mut self, left: NodeId, inside: DVec2, outside: DVec2, node: NodeId) {
        let end = self.cut(inside, outside);
        if end.distance(inside) > LEAST_MM {
            self.place(Some(left), end, node);
        }
    }
}

/// No end of a vein is shorter (mm): it would be a node on a node.
const LEAST_MM: f64 = 1e-6;

#[cfg(test)]
mod tests {
    use super::*;

    fn square(low: f64, high: f64) -> Vec<DVec2> {
        [(low, low), (high, low), (high, high), (low, high)].map(DVec2::from).to_vec()
    }

    #[test]
    fn veins_end_at_a_gap_and_go_on_behind_it() {
        // A gap from 3 to 5 in a blade from 0 to 10, and a vein straight through it.
        let mut gap = square(3.0, 5.0);
        gap.reverse();
        let rings = [square(0.0, 10.0), gap];
        let mut graph = VeinGraph::new();
        let mut tip = graph.add_root(DVec2::new(0.5, 4.0));
        for i in 1..9 {
            tip = graph.sprout(tip, DVec2::new(0.5 + f64::from(i), 4.0));
        }
        // A loop around the gap, and one that crosses it.
        graph.join(1, 7);
        let side = graph.sprout(1, DVec2::new(1.5, 8.0));
        graph.join(side, 8);
        let count = graph.len();
        let whole = Venation::new(graph, vec![0.1; count], vec![1; count]);
        let left = remaining(&whole, &rings).expect("a hurt blade");
        let at = left.graph().positions();
        assert!(at.iter().all(|p| !(p.x > 3.0 + 1e-6 && p.x < 5.0 - 1e-6 && p.y == 4.0)), "{at:?}");
        let mut ends: Vec<f64> =
            at.iter().map(|p| p.x).filter(|x| (2.9..5.1).contains(x)).collect();
        ends.sort_by(f64::total_cmp);
        assert!((ends[0] - 3.0).abs() < 1e-6 && (ends[1] - 5.0).abs() < 1e-6, "{ends:?}");
        let length: f64 =
            left.graph().edges().map(|(a, b)| at[a as usize].distance(at[b as usize])).sum();
        assert!((length - (8.0 - 2.0 + 4.0)).abs() < 1e-5, "{length}");
        assert_eq!(left.graph().joins().len(), 1);
        let roots = (0..left.graph().len() as NodeId)
            .filter(|&node| left.graph().parent(node).is_none())
            .count();
        assert_eq!(roots, 2);
    }

    #[test]
    fn a_whole_blade_keeps_its_veins() {
        let mut graph = VeinGraph::new();
        graph.add_root(DVec2::ZERO);
        let whole = Venation::new(graph, vec![0.1], vec![1]);
        assert_eq!(remaining(&whole, &[]), None);
    }
}
