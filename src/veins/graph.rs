//! The vein pattern as a graph: a forest of nodes that grow from the petiole, and joins between
//! branches that met.

use glam::DVec2;

use crate::parallel;
use crate::parameter::words;

/// A node, by its place in the graph. Parents come before children.
pub type NodeId = u32;

words! {
    /// What part of the pattern a node belongs to.
    pub enum VeinKind {
        /// The midrib and other veins of the first order.
        Primary = "primary",
        /// Branches of the primary veins.
        Secondary = "secondary",
        /// Between two secondaries, like them but shorter and finer.
        Intersecondary = "intersecondary",
        /// Along the margin, at some distance; the secondaries end in it.
        Intramarginal = "intramarginal",
        /// On the margin itself.
        Marginal = "marginal",
        /// Outside the secondaries: small arches between them, and branches to the teeth.
        Exterior = "exterior",
        /// Between secondaries, laid down as they were.
        Tertiary = "tertiary",
        /// Every finer vein.
        Minor = "minor",
    }
}

/// Order and kind of a vein that were decided where it was laid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Rank {
    /// 1 primary, 2 secondary, …
    pub order: u8,
    /// What it is.
    pub kind: VeinKind,
}

/// Nodes and edges of a vein pattern, in leaf space (mm).
///
/// # Guarantees
///
/// - A parent comes before its children, so the parent edges are a forest. As grown its roots lie at the
///   petiole; what is left of a damaged leaf has others.
/// - No two nodes at one position.
/// - Joins name two different existing nodes, neither the parent of the other.
/// - A node with a rank grows out of one with a rank of no higher order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct VeinGraph {
    positions: Vec<DVec2>,
    /// The parent of each node; a root is its own parent.
    parents: Vec<NodeId>,
    joins: Vec<(NodeId, NodeId)>,
    /// The ranks that were given, by node; nodes past the end have none.
    ranks: Vec<Option<Rank>>,
}

impl VeinGraph {
    /// A graph without nodes.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes room for so many more nodes.
    pub fn reserve(&mut self, more: usize) {
        parallel::make_room(&mut self.positions, more, DVec2::ZERO);
        parallel::make_room(&mut self.parents, more, 0);
    }

    /// Adds a root at the petiole.
    pub fn add_root(&mut self, position: DVec2) -> NodeId {
        let id = self.positions.len() as NodeId;
        self.positions.push(position);
        self.parents.push(id);
        id
    }

    /// Adds a node that grows out of `parent`. The caller keeps positions distinct.
    ///
    /// # Panics
    ///
    /// If there is no such parent.
    pub fn sprout(&mut self, parent: NodeId, position: DVec2) -> NodeId {
        assert!((parent as usize) < self.positions.len(), "a vein grows out of an existing node");
        let id = self.positions.len() as NodeId;
        self.positions.push(position);
        self.parents.push(parent);
        id
    }

    /// The same graph with every node moved, by id. `place` keeps positions distinct.
    #[must_use]
    pub fn mapped(mut self, mut place: impl FnMut(DVec2) -> DVec2) -> Self {
        self.positions.iter_mut().for_each(|p| *p = place(*p));
        self
    }

    /// Records that the veins at `a` and `b` have met.
    pub fn join(&mut self, a: NodeId, b: NodeId) {
        self.joins.push((a, b));
    }

    /// Decides what vein a node belongs to.
    pub fn set_rank(&mut self, node: NodeId, rank: Rank) {
        let needed = node as usize + 1;
        if self.ranks.len() < needed {
            self.ranks.resize(needed, None);
        }
        self.ranks[node as usize] = Some(rank);
    }

    /// What vein a node belongs to, where that was decided before it grew.
    #[must_use]
    pub fn rank(&self, node: NodeId) -> Option<Rank> {
        self.ranks.get(node as usize).copied().flatten()
    }

    /// The highest order that was given; 0 when none was.
    #[must_use]
    pub fn highest_rank(&self) -> u8 {
        self.ranks.iter().flatten().map(|rank| rank.order).max().unwrap_or(0)
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no nodes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Where the nodes are (mm), by id.
    #[must_use]
    pub fn positions(&self) -> &[DVec2] {
        &self.positions
    }

    /// The parent of a node; `None` for a root.
    #[must_use]
    pub fn parent(&self, node: NodeId) -> Option<NodeId> {
        let parent = self.parents[node as usize];
        (parent != node).then_some(parent)
    }

    /// Loop-closing edges.
    #[must_use]
    pub fn joins(&self) -> &[(NodeId, NodeId)] {
        &self.joins
    }

    /// Nodes that are no root, each with its parent, parents first.
    pub fn edges(&self) -> impl Iterator<Item = (NodeId, NodeId)> + '_ {
        (0..self.len() as NodeId).filter_map(|node| Some((self.parent(node)?, node)))
    }

    /// How many children each node has, by id.
    #[must_use]
    pub fn child_counts(&self) -> Vec<u32> {
        let mut counts = vec![0; self.len()];
        for (parent, _) in self.edges() {
            counts[parent as usize] += 1;
        }
        counts
    }

    /// The first guarantee that does not hold, in words; `None` when all do. For tests.
    #[must_use]
    pub fn check(&self) -> Option<String> {
        if let Some(i) = (0..self.len()).find(|&i| self.parents[i] as usize > i) {
            return Some(format!("node {i} comes before its parent {}", self.parents[i]));
        }
        if let Some(p) = self.positions.iter().find(|p| !p.is_finite()) {
            return Some(format!("a node at {p}"));
        }
        let mut sorted: Vec<[u64; 2]> =
            self.positions.iter().map(|p| [p.x.to_bits(), p.y.to_bits()]).collect();
        sorted.sort_unstable();
        if sorted.windows(2).any(|pair| pair[0] == pair[1]) {
            return Some("two nodes at one position".into());
        }
        let order = |node: NodeId| self.rank(node).map_or(u8::MAX, |rank| rank.order);
        if let Some((_, node)) =
            self.edges().find(|&(p, c)| self.rank(c).is_some() && order(p) > order(c))
        {
            return Some(format!("node {node} has a rank, and its parent none or a higher one"));
        }
        let n = self.len() as NodeId;
        self.joins
            .iter()
            .find(|&&(a, b)| {
                a == b || a >= n || b >= n || self.parent(a) == Some(b) || self.parent(b) == Some(a)
            })
            .map(|join| format!("a join {join:?} that closes no loop"))
    }
}
