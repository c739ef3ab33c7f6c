//! Stubs taken away.
//!
//! Where a vein was on its way to a source that others reached, or would have closed too small a loop, it
//! ends after a step or two. In cleared leaves a veinlet that ends free reaches well into its areole;
//! shorter ones are bumps on the side of a vein, and readers of pictures drop them, too.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use super::VeinSpec;
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
    let goes = stubs(&graph, least);
    if goes.contains(&true) {
        without(&graph, &nodes_after_step, &goes)
    } else {
        (graph, nodes_after_step)
    }
}

/// The nodes of all veins shorter than `least` that end free, their junctions excepted: the shortest
/// first, since what is left at its junction is one vein then, and longer.
fn stubs(graph: &VeinGraph, least: f64) -> Vec<bool> {
    let mut degrees = vec![0u32; graph.len()];
    for (a, b) in graph.edges().chain(graph.joins().iter().copied()) {
        degrees[a as usize] += 1;
        degrees[b as usize] += 1;
    }
    let mut goes = vec![false; graph.len()];
    let mut waiting = BinaryHeap::new();
    // In the order of lengths, which are not negative.
    let key = |stub: &Stub, tip: NodeId| Reverse((stub.length.to_bits(), tip));
    let tips = (0..graph.len() as NodeId).filter(|&node| degrees[node as usize] == 1);
    for tip in tips {
        waiting.extend(Stub::at(graph, &degrees, tip, least).map(|stub| key(&stub, tip)));
    }
    while let Some(entry) = waiting.pop() {
        let Reverse((_, tip)) = entry;
        let Some(stub) = Stub::at(graph, &degrees, tip, least) else { continue };
        if key(&stub, tip) != entry {
            // It has become longer since.
            waiting.push(key(&stub, tip));
            continue;
        }
        let mut node = tip;
        while node != stub.hub {
            goes[node as usize] = true;
            node = graph.parent(node).unwrap_or(stub.hub);
        }
        degrees[stub.hub as usize] -= 1;
    }
    goes
}

/// A vein that may go.
struct Stub {
    /// The junction it hangs on.
    hub: NodeId,
    length: f64,
}

impl Stub {
    /// The vein that ends in a tip, if it grew out of a junction and is shorter than `least`.
    fn at(graph: &VeinGraph, degrees: &[u32], tip: NodeId, least: f64) -> Option<Self> {
        let (mut node, mut length) = (tip, 0.0);
        loop {
            if graph.rank(node).is_some() {
                return None;
            }
            let hub = graph.parent(node)?;
            let place = |node: NodeId| graph.positions()[node as usize];
            length += place(node).distance(place(hub));
            if length >= least {
                return None;
            }
            if degrees[hub as usize] != 2 {
                return (degrees[hub as usize] > 2).then_some(Self { hub, length });
            }
            node = hub;
        }
    }
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
