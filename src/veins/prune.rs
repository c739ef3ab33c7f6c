//! Stubs taken away.
//!
//! Where a vein was on its way to a source that others reached, or would have closed too small a loop, it
//! ends after a step or two. In cleared leaves a veinlet that ends free reaches well into its areole;
//! shorter ones are bumps on the side of a vein, and readers of pictures drop them, too.

use super::VeinSpec;
use super::chains::{Chain, Chains};
use super::graph::{NodeId, VeinGraph};

/// A graph without free-ending veins shorter than `veins.least_veinlet`, and how many of its nodes there
/// were after each step; as it is at 0. Guided veins stay.
#[must_use]
pub fn pruned(
    spec: &VeinSpec,
    graph: VeinGraph,
    nodes_after_step: Vec<u32>,
) -> (VeinGraph, Vec<u32>) {
    let least = spec.least_veinlet * spec.kill_distance_mm;
    if least == 0.0 {
        return (graph, nodes_after_step);
    }
    let mut made = (graph, nodes_after_step);
    loop {
        let goes = stubs(&made.0, least);
        if !goes.contains(&true) {
            return made;
        }
        made = without(&made.0, &made.1, &goes);
    }
}

/// The nodes of all veins shorter than `least` that end free, their junctions excepted.
fn stubs(graph: &VeinGraph, least: f64) -> Vec<bool> {
    let Chains { chains, at } = Chains::of(graph);
    let at_end = |node: NodeId| at[node as usize].len() == 1 && graph.parent(node).is_some();
    let length = |chain: &Chain| -> f64 {
        let place = |node: NodeId| graph.positions()[node as usize];
        chain.nodes.windows(2).map(|pair| place(pair[0]).distance(place(pair[1]))).sum()
    };
    let mut goes = vec![false; graph.len()];
    // The longer of two stubs at one node stays: it is looked at again without the other.
    let mut touched = vec![false; graph.len()];
    let mut short: Vec<(f64, &Chain)> = chains
        .iter()
        .map(|chain| (length(chain), chain))
        .filter(|&(long, _)| long < least)
        .collect();
    short.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, chain) in short {
        let last = chain.nodes.len() - 1;
        let (hub, rest) = match (at_end(chain.nodes[0]), at_end(chain.nodes[last])) {
            (true, false) => (chain.nodes[last], &chain.nodes[..last]),
            (false, true) => (chain.nodes[0], &chain.nodes[1..]),
            _ => continue,
        };
        let is_grown = rest.iter().all(|&node| graph.rank(node).is_none());
        if is_grown && at[hub as usize].len() > 2 && !touched[hub as usize] {
            touched[hub as usize] = true;
            rest.iter().for_each(|&node| goes[node as usize] = true);
        }
    }
    goes
}

/// The graph without the nodes that go.
fn without(graph: &VeinGraph, nodes_after_step: &[u32], goes: &[bool]) -> (VeinGraph, Vec<u32>) {
    let mut made = VeinGraph::new();
    // Of each node, and how many there were before it.
    let mut numbers = Vec::with_capacity(graph.len());
    let mut before = Vec::with_capacity(graph.len() + 1);
    for node in 0..graph.len() as NodeId {
        before.push(made.len() as u32);
        if goes[node as usize] {
            numbers.push(NodeId::MAX);
            continue;
        }
        let place = graph.positions()[node as usize];
        let id = match graph.parent(node) {
            None => made.add_root(place),
            Some(parent) => made.sprout(numbers[parent as usize], place),
        };
        if let Some(rank) = graph.rank(node) {
            made.set_rank(id, rank);
        }
        numbers.push(id);
    }
    before.push(made.len() as u32);
    for &(a, b) in graph.joins() {
        let [a, b] = [a, b].map(|node| numbers[node as usize]);
        if a != NodeId::MAX && b != NodeId::MAX {
            made.join(a, b);
        }
    }
    let nodes_after_step = nodes_after_step.iter().map(|&count| before[count as usize]).collect();
    (made, nodes_after_step)
}
