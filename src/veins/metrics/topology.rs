//! What hangs together, and how much of it is redundant.

use super::network::Network;

/// Disjoint sets, by union with path halving.
#[derive(Debug)]
pub(super) struct Sets(Vec<u32>);

impl Sets {
    pub(super) fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    pub(super) fn find(&mut self, mut item: u32) -> u32 {
        while self.0[item as usize] != item {
            let above = self.0[self.0[item as usize] as usize];
            self.0[item as usize] = above;
            item = above;
        }
        item
    }

    /// Puts the sets of `a` and `b` together under the root of `b`; whether they were two.
    pub(super) fn unite(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.find(a), self.find(b));
        self.0[a as usize] = b;
        a != b
    }
}

/// The connected parts of a network.
#[derive(Debug)]
pub(super) struct Parts {
    /// How many there are.
    pub(super) count: usize,
    /// The part of each node.
    pub(super) of_node: Vec<usize>,
}

impl Parts {
    pub(super) fn of(network: &Network) -> Self {
        let nodes = network.nodes().len();
        let mut sets = Sets::new(nodes);
        for segment in network.segments() {
            sets.unite(segment.ends[0] as u32, segment.ends[1] as u32);
        }
        let (mut count, mut number) = (0, vec![usize::MAX; nodes]);
        let mut of_node = Vec::with_capacity(nodes);
        for node in 0..nodes as u32 {
            let set = sets.find(node) as usize;
            if number[set] == usize::MAX {
                number[set] = count;
                count += 1;
            }
            of_node.push(number[set]);
        }
        Self { count, of_node }
    }
}

/// Counts and ratios that know nothing of widths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Topology {
    /// Nodes, those of degree 2 merged.
    pub nodes: usize,
    /// Segments.
    pub segments: usize,
    /// Connected parts.
    pub parts: usize,
    /// Nodes of degree 1, the petiole's end left out.
    pub free_ends: usize,
    /// Nodes of degree 3 or more.
    pub junctions: usize,
    /// Junctions of degree 3.
    pub degree_3: usize,
    /// Junctions of degree 4.
    pub degree_4: usize,
    /// Length of the shortest forest that connects as much.
    pub spanning_length: f64,
}

impl Topology {
    /// Counts.
    #[must_use]
    pub fn of(network: &Network) -> Self {
        let degrees = network.degrees();
        let count = |is: fn(usize) -> bool| degrees.iter().filter(|&&degree| is(degree)).count();
        let free = |node: &usize| degrees[*node] == 1 && !network.is_root(*node);
        let lengths: Vec<f64> = network.segments().iter().map(|segment| segment.length).collect();
        let forest = spanning_forest(network, &lengths);
        Self {
            nodes: degrees.len(),
            segments: lengths.len(),
            parts: Parts::of(network).count,
            free_ends: (0..degrees.len()).filter(free).count(),
            junctions: count(|degree| degree >= 3),
            degree_3: count(|degree| degree == 3),
            degree_4: count(|degree| degree == 4),
            spanning_length: forest.iter().map(|&segment| lengths[segment]).sum(),
        }
    }

    /// Independent loops: joins − roots + parts, which is the number of areoles where no vein
    /// crosses another.
    #[must_use]
    pub fn loops(&self) -> usize {
        self.segments + self.parts - self.nodes
    }

    /// (E − V + 1) / (2V − 5): loops as a share of the most that a planar graph has room for.
    #[must_use]
    pub fn meshedness(&self) -> Option<f64> {
        let (nodes, segments) = (self.nodes as f64, self.segments as f64);
        (self.nodes > 2).then(|| (segments - nodes + 1.0) / (2.0 * nodes - 5.0))
    }
}

/// The segments of the spanning forest with the least sum of weights (Kruskal 1956); the first of
/// equals.
pub(super) fn spanning_forest(network: &Network, weights: &[f64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..weights.len()).collect();
    order.sort_by(|&a, &b| weights[a].total_cmp(&weights[b]));
    let mut sets = Sets::new(network.nodes().len());
    let segments = network.segments();
    order.retain(|&i| sets.unite(segments[i].ends[0] as u32, segments[i].ends[1] as u32));
    order
}
