//! The veins in order of place: what is near in the blade lies together in memory.
//!
//! Nodes are numbered as they grew, everywhere at once; a junction and what is around it would be
//! fetched from as many places in memory as it has nodes.

use glam::DVec2;

use crate::geometry::Rect;
use crate::geometry::z_order::z_order;
use crate::veins::chains::{Chain, Chains};
use crate::veins::graph::{NodeId, VeinGraph};

/// The nodes, edges and chains of a graph, nodes renumbered in order of place.
#[derive(Debug)]
pub(super) struct Net {
    pub(super) positions: Vec<DVec2>,
    /// Both ends of every edge.
    pub(super) edges: Vec<[NodeId; 2]>,
    /// The chains, one after the other.
    nodes: Vec<NodeId>,
    /// Where each starts in `nodes`.
    firsts: Vec<u32>,
    /// The pull of each chain.
    pulls: Vec<f64>,
    /// The chains at each node, in the order of their numbers.
    at: Vec<u32>,
    /// Where those of each node start in `at`.
    at_firsts: Vec<u32>,
    /// The number here of every node of the graph.
    numbers: Vec<NodeId>,
}

impl Net {
    pub(super) fn new(graph: &VeinGraph, chains: &Chains, pulls: &[f64]) -> Self {
        let places = graph.positions();
        let bounds = Rect::around(places.iter().copied());
        let mut order: Vec<(u32, NodeId)> =
            (0..).zip(places).map(|(node, &p)| (z_order(bounds, p), node)).collect();
        order.sort_unstable();
        let mut numbers = vec![0; order.len()];
        (0..).zip(&order).for_each(|(number, &(_, node))| numbers[node as usize] = number);
        let number = |node: NodeId| numbers[node as usize];
        let mut edges: Vec<[NodeId; 2]> = graph
            .edges()
            .chain(graph.joins().iter().copied())
            .map(|(a, b)| [number(a), number(b)])
            .collect();
        edges.sort_unstable();
        let mut by_place: Vec<(NodeId, u32)> = (0..)
            .zip(&chains.chains)
            .map(|(at, chain): (u32, &Chain)| (number(chain.nodes[0]), at))
            .collect();
        by_place.sort_unstable();
        let mut renumbered = vec![0; by_place.len()];
        let (mut nodes, mut firsts) = (Vec::with_capacity(edges.len() + by_place.len()), vec![0]);
        for (place, &(_, chain)) in (0..).zip(&by_place) {
            renumbered[chain as usize] = place;
            nodes.extend(chains.chains[chain as usize].nodes.iter().map(|&node| number(node)));
            firsts.push(nodes.len() as u32);
        }
        let (mut at, mut at_firsts) = (Vec::with_capacity(2 * by_place.len()), vec![0]);
        for &(_, node) in &order {
            at.extend(chains.at[node as usize].iter().map(|&chain| renumbered[chain as usize]));
            at_firsts.push(at.len() as u32);
        }
        Self {
            positions: order.iter().map(|&(_, node)| places[node as usize]).collect(),
            edges,
            nodes,
            firsts,
            pulls: by_place.iter().map(|&(_, chain)| pulls[chain as usize]).collect(),
            at,
            at_firsts,
            numbers,
        }
    }

    /// The number here of a node of the graph.
    pub(super) fn number(&self, node: NodeId) -> NodeId {
        self.numbers[node as usize]
    }

    /// By the nodes of the graph, where they are.
    pub(super) fn places(&self) -> Vec<DVec2> {
        self.numbers.iter().map(|&number| self.positions[number as usize]).collect()
    }

    #[inline]
    pub(super) fn place(&self, node: NodeId) -> DVec2 {
        self.positions[node as usize]
    }

    /// The chains at a junction.
    pub(super) fn chains_at(&self, junction: NodeId) -> &[u32] {
        let at = junction as usize;
        &self.at[self.at_firsts[at] as usize..self.at_firsts[at + 1] as usize]
    }

    /// The nodes along a chain.
    pub(super) fn chain(&self, chain: u32) -> &[NodeId] {
        let at = chain as usize;
        &self.nodes[self.firsts[at] as usize..self.firsts[at + 1] as usize]
    }

    /// How many chains there are.
    pub(super) fn chain_count(&self) -> usize {
        self.pulls.len()
    }

    pub(super) fn pull(&self, chain: u32) -> f64 {
        self.pulls[chain as usize]
    }
}
