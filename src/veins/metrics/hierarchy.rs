//! How far a pattern is a midrib with side veins: straight, even in number, evenly spaced.
//!
//! What is a side vein is settled by length, so that patterns with and without laid veins compare: a
//! vein of a higher order that leaves the midrib and comes as far as [`LEAST_LENGTH`].

use super::statistics::variation;
use crate::margin::Margin;
use crate::veins::{NodeId, Venation};

/// A side vein is at least this long from end to end, in lengths of the blade.
pub const LEAST_LENGTH: f64 = 0.12;

/// Measures of the midrib and its side veins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hierarchy {
    /// Path over chord of the midrib; 1 is straight.
    pub midrib_sinuosity: f64,
    /// Side veins on the right and on the left.
    pub secondaries: [usize; 2],
    /// Their path over chord, by length.
    pub secondary_sinuosity: f64,
    /// Distances between neighbours on one side along the midrib: deviation over mean; 0 without any.
    pub spacing_variation: f64,
}

impl Hierarchy {
    /// Measures a pattern in its blade; `None` without a midrib.
    #[must_use]
    pub fn of(venation: &Venation, margin: &Margin) -> Option<Self> {
        let (graph, orders) = (venation.graph(), venation.orders());
        let at = |node: NodeId| graph.positions()[node as usize];
        // The midrib ends where a primary vein comes nearest to the apex.
        let primary = |node: &NodeId| orders[*node as usize] == 1;
        let to_apex = |node: NodeId| at(node).distance_squared(margin.apex());
        let end = (0..graph.len() as NodeId)
            .filter(primary)
            .reduce(|a, b| if to_apex(b) < to_apex(a) { b } else { a })?;
        let mut midrib = vec![end];
        let mut path = 0.0;
        while let Some(parent) = graph.parent(*midrib.last()?) {
            path += at(*midrib.last()?).distance(at(parent));
            midrib.push(parent);
        }
        midrib.reverse();
        let chord = at(midrib[0]).distance(at(end));
        // How far up the midrib each of its nodes is.
        let mut height = vec![f64::NAN; graph.len()];
        let mut up = 0.0;
        for (i, &node) in midrib.iter().enumerate() {
            up += if i > 0 { at(midrib[i - 1]).distance(at(node)) } else { 0.0 };
            height[node as usize] = up;
        }
        // Of each node that is not on the midrib: the side vein it belongs to.
        let mut stem: Vec<NodeId> = vec![NodeId::MAX; graph.len()];
        let mut ends: Vec<(NodeId, f64)> = vec![(NodeId::MAX, 0.0); graph.len()];
        for (parent, node) in graph.edges() {
            let is_midrib = |node: NodeId| !height[node as usize].is_nan();
            if is_midrib(node) {
                continue;
            }
            stem[node as usize] = if is_midrib(parent) { node } else { stem[parent as usize] };
            let first = stem[node as usize];
            if first != NodeId::MAX && orders[node as usize] == orders[first as usize] {
                let start = graph.parent(first)?;
                let reach = at(node).distance(at(start));
                if reach > ends[first as usize].1 {
                    ends[first as usize] = (node, reach);
                }
            }
        }
        let least = LEAST_LENGTH * margin.length_mm();
        let mut sides: [Vec<f64>; 2] = Default::default();
        let (mut paths, mut chords) = (0.0, 0.0);
        for (first, &(end, reach)) in ends.iter().enumerate().filter(|(_, end)| end.1 >= least) {
            let start = graph.parent(first as NodeId)?;
            let mut node = end;
            while node != start {
                let parent = graph.parent(node)?;
                paths += at(node).distance(at(parent));
                node = parent;
            }
            chords += reach;
            sides[usize::from(at(end).x < at(start).x)].push(height[start as usize]);
        }
        let mut gaps = Vec::new();
        for side in &mut sides {
            side.sort_by(f64::total_cmp);
            gaps.extend(side.windows(2).map(|pair| pair[1] - pair[0]));
        }
        Some(Self {
            midrib_sinuosity: if chord > 0.0 { path / chord } else { 1.0 },
            secondaries: [sides[0].len(), sides[1].len()],
            secondary_sinuosity: if chords > 0.0 { paths / chords } else { 1.0 },
            spacing_variation: variation(&gaps).unwrap_or(0.0),
        })
    }

    /// By how many one side has more.
    #[must_use]
    pub fn difference(&self) -> usize {
        self.secondaries[0].abs_diff(self.secondaries[1])
    }
}
