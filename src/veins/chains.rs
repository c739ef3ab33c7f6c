//! A vein graph as chains: stretches of vein from a junction, end or root to the next.
//!
//! What happens at junctions (the pull of the veins, the division of a flow) knows no nodes along a
//! vein; what happens to a junction must take those nodes along.

use super::graph::{NodeId, VeinGraph};

/// A stretch of vein.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chain {
    /// Its nodes, from one stop to the other, both included; the same one twice for a loop.
    pub nodes: Vec<NodeId>,
    /// Its edges, one fewer, in the same order.
    pub edges: Vec<Edge>,
}

/// An edge of the graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Edge {
    /// From this node to its parent.
    Parent(NodeId),
    /// The join of this number.
    Join(u32),
}

/// The chains of a graph.
///
/// # Guarantees
///
/// - Every edge belongs to exactly one chain.
/// - A chain ends at stops: roots and nodes that do not have exactly two edges.
/// - Chains are in the order of their first stop, the same for the same graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Chains {
    /// The chains.
    pub chains: Vec<Chain>,
    /// Which chains end at each node; a loop stands twice. Empty but for stops.
    pub at: Vec<Vec<u32>>,
}

impl Chains {
    /// The chains of `graph`.
    #[must_use]
    pub fn of(graph: &VeinGraph) -> Self {
        let incident = Incident::new(graph);
        let is_stop = |node: NodeId| incident.at(node).len() != 2 || graph.parent(node).is_none();
        let mut used_parent = vec![false; graph.len()];
        let mut used_join = vec![false; graph.joins().len()];
        let mut take = |edge: Edge| {
            let used = match edge {
                Edge::Parent(node) => &mut used_parent[node as usize],
                Edge::Join(join) => &mut used_join[join as usize],
            };
            !std::mem::replace(used, true)
        };
        let mut made = Self { chains: Vec::new(), at: vec![Vec::new(); graph.len()] };
        for start in (0..graph.len() as NodeId).filter(|&node| is_stop(node)) {
            for &(edge, next) in incident.at(start) {
                if !take(edge) {
                    continue;
                }
                let mut chain = Chain { nodes: vec![start, next], edges: vec![edge] };
                let mut here = next;
                while !is_stop(here) {
                    let Some(&(edge, next)) =
                        incident.at(here).iter().find(|&&(edge, _)| take(edge))
                    else {
                        break;
                    };
                    chain.nodes.push(next);
                    chain.edges.push(edge);
                    here = next;
                }
                let number = made.chains.len() as u32;
                made.at[start as usize].push(number);
                made.at[here as usize].push(number);
                made.chains.push(chain);
            }
        }
        made
    }

    /// Where veins meet: stops with at least three chains, by id.
    pub fn junctions(&self) -> impl Iterator<Item = NodeId> + '_ {
        (0..self.at.len() as NodeId).filter(|&node| self.at[node as usize].len() >= 3)
    }
}

/// The edges at each node, each with the node at its other end.
struct Incident {
    edges: Vec<(Edge, NodeId)>,
    /// Where those of each node start.
    firsts: Vec<u32>,
}

impl Incident {
    /// First the parent's, then by number.
    fn new(graph: &VeinGraph) -> Self {
        let ends = || {
            let parents = graph.edges().flat_map(|(parent, child)| {
                let edge = Edge::Parent(child);
                [(child, edge, parent), (parent, edge, child)]
            });
            let joins = (0..).zip(graph.joins()).flat_map(|(number, &(a, b))| {
                let edge = Edge::Join(number);
                [(a, edge, b), (b, edge, a)]
            });
            parents.chain(joins)
        };
        let mut firsts = vec![0u32; graph.len() + 1];
        ends().for_each(|(node, ..)| firsts[node as usize + 1] += 1);
        for node in 0..graph.len() {
            firsts[node + 1] += firsts[node];
        }
        let mut next = firsts.clone();
        let mut edges = vec![(Edge::Join(0), 0); firsts[graph.len()] as usize];
        for (node, edge, other) in ends() {
            let place = &mut next[node as usize];
            edges[*place as usize] = (edge, other);
            *place += 1;
        }
        Self { edges, firsts }
    }

    fn at(&self, node: NodeId) -> &[(Edge, NodeId)] {
        let at = node as usize;
        &self.edges[self.firsts[at] as usize..self.firsts[at + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec2;

    #[test]
    fn nodes_along_a_vein_and_joins_merge() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let fork = graph.sprout(root, DVec2::Y);
        let left = graph.sprout(fork, DVec2::new(-1.0, 2.0));
        let right = graph.sprout(fork, DVec2::new(1.0, 2.0));
        let end = graph.sprout(right, DVec2::new(0.5, 3.0));
        let tip = graph.sprout(end, DVec2::new(0.5, 4.0));
        graph.join(left, end);
        let Chains { chains, at } = Chains::of(&graph);
        let nodes: Vec<&[NodeId]> = chains.iter().map(|chain| &chain.nodes[..]).collect();
        let expected: [&[NodeId]; 4] =
            [&[root, fork], &[fork, left, end], &[fork, right, end], &[end, tip]];
        assert_eq!(nodes, expected);
        assert_eq!(chains[1].edges, [Edge::Parent(left), Edge::Join(0)]);
        assert_eq!(at.iter().map(Vec::len).collect::<Vec<_>>(), [1, 3, 0, 0, 3, 1]);
    }
}
