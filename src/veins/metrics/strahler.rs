//! Strahler orders of the widest tree in a network.
//!
//! Source: Strahler, "Quantitative analysis of watershed geomorphology", Trans. AGU 38, 1957: ends
//! have order 1; where two streams of one order meet, the order rises. Loops are cut where the veins
//! are thinnest, by a spanning tree of greatest width. These orders count from the ends, those of
//! leaf architecture from the petiole.

use super::network::{Network, split};
use super::topology::spanning_forest;

/// The streams of one order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StrahlerOrder {
    /// The order, 1 at the ends.
    pub order: u32,
    /// How many streams there are.
    pub streams: usize,
    /// Length of all of them.
    pub length: f64,
    /// Their mean width, by length.
    pub width: f64,
}

/// The streams of every order, from the ends. Of several parts of a network each is a tree of its
/// own.
#[must_use]
pub fn strahler(network: &Network) -> Vec<StrahlerOrder> {
    let segments = network.segments();
    let thinness: Vec<f64> = segments.iter().map(|segment| -segment.width).collect();
    let mut in_tree = vec![false; segments.len()];
    spanning_forest(network, &thinness).into_iter().for_each(|i| in_tree[i] = true);
    let incidence = network.incidence();
    // Roots first: the petiole, then whichever end of the widest veins comes from outside.
    let mut starts: Vec<usize> =
        (0..network.nodes().len()).filter(|&node| network.is_root(node)).collect();
    let mut widest: Vec<usize> = (0..segments.len()).filter(|&i| in_tree[i]).collect();
    widest.sort_by(|&a, &b| segments[b].width.total_cmp(&segments[a].width));
    starts.extend(widest.iter().map(|&i| outer_end(network, segments[i].ends)));
    // Every node after the one nearer to the root, with the half-edge that leads to it.
    let mut seen = vec![false; network.nodes().len()];
    let mut visits: Vec<(usize, Option<u32>)> = Vec::new();
    for start in starts {
        if seen[start] {
            continue;
        }
        seen[start] = true;
        let mut at = visits.len();
        visits.push((start, None));
        while at < visits.len() {
            for &half_edge in incidence.at(visits[at].0) {
                let (segment, side) = split(half_edge);
                let next = segments[segment].ends[1 - side];
                if in_tree[segment] && !seen[next] {
                    seen[next] = true;
                    visits.push((next, Some(half_edge)));
                }
            }
            at += 1;
        }
    }
    // From the ends towards the roots: the highest order at a node, and how many come in with it.
    let mut incoming = vec![(0u32, 0u32); network.nodes().len()];
    let mut table: Vec<StrahlerOrder> = Vec::new();
    for &(node, from) in visits.iter().rev() {
        let (highest, times) = incoming[node];
        let order = if times >= 2 { highest + 1 } else { highest.max(1) };
        let Some(half_edge) = from else { continue };
        let (segment, side) = split(half_edge);
        let parent = &mut incoming[segments[segment].ends[side]];
        match order.cmp(&parent.0) {
            std::cmp::Ordering::Greater => *parent = (order, 1),
            std::cmp::Ordering::Equal => parent.1 += 1,
            std::cmp::Ordering::Less => {}
        }
        while table.len() < order as usize {
            let order = table.len() as u32 + 1;
            table.push(StrahlerOrder { order, streams: 0, length: 0.0, width: 0.0 });
        }
        let entry = &mut table[order as usize - 1];
        // A stream begins where the order is new.
        entry.streams += usize::from(order > highest);
        entry.length += segments[segment].length;
        entry.width += segments[segment].length * segments[segment].width;
    }
    table.iter_mut().for_each(|entry| entry.width /= entry.length);
    table
}

/// The end farther from the middle of the blade: veins come in from the rim.
fn outer_end(network: &Network, ends: [usize; 2]) -> usize {
    let centre = crate::geometry::polygon::centroid(network.outline());
    let far = |end: usize| network.nodes()[end].distance_squared(centre);
    if far(ends[0]) >= far(ends[1]) { ends[0] } else { ends[1] }
}
