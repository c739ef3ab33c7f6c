//! Radii from the flow through veins that adapt to it, for veins with loops.
//!
//! Veins become the edges of a network between junctions, ends and roots. A conductance K relaxes by
//! dK/dt = ⟨F²⟩^β − K + κ e^(−t/ρ) with β = 1/(1 + γ), γ = 1/2, under flows F that feed every junction
//! and end from the roots; r ∝ K^(1/4), as Poiseuille has it. Under a steady flow a tree obeys Murray's
//! law with exponent 3, every sink counting 1: r ∝ F^(2β/4) = F^(1/3).
//!
//! Sources: Ronellenfitsch & Katifori, "Global optimization, local adaptation, and the role of growth
//! in distribution networks", Phys. Rev. Lett. 117, 2016; Katifori, Szöllősi & Magnasco, Phys. Rev.
//! Lett. 104, 2010, and Corson, ibid.: loops stay where the sinks fluctuate. Departs from them: the
//! ⟨ ⟩ is over fixed groups of sinks that open one after the other (patches of the blade, and sinks
//! scattered over it), 32 flows instead of one for each sink; with 16 sinks or fewer it is their single
//! moving sink.

use super::VeinError;
use super::chains::{Chains, Edge};
use super::graph::{NodeId, VeinGraph};
use crate::geometry::sparse::Pattern;
use crate::observer::{Observer, Progress};

/// β for γ = 1/2, which gives Murray's law on trees.
const BETA: f64 = 2.0 / 3.0;

/// κ, in units of the petiole's conductance: large beside all but the widest veins, so that none is
/// lost before the flow has spread.
const BACKGROUND: f64 = 0.01;

/// ρ, in units of the time in which a conductance relaxes.
const BACKGROUND_TIME: f64 = 3.0;

/// One step lasts a unit of time; the relaxation within it is exact, so it is stable.
const MOST_STEPS: u64 = 100;

/// Conductances that change by less than this share in a step have settled; those of veins that feed
/// less than one sink may go on.
const SETTLED: f64 = 1e-4;

/// Sinks open in so many patches of the blade, and again in so many scattered groups. A square.
const GROUPS: usize = 16;

/// More junctions and ends take minutes.
pub const MOST_STOPS: usize = 200_000;

/// What flows where.
struct FlowNetwork {
    /// Chains between different stops, by the unknowns at their ends; `None` is a root.
    ends: Vec<[Option<usize>; 2]>,
    lengths: Vec<f64>,
    /// Which chain each of these is.
    chains: Vec<usize>,
    /// The node of every unknown.
    stops: Vec<NodeId>,
}

/// The radius at each node (mm): that of the vein to its parent. Roots are as wide as in `murray`,
/// the radii under Murray's law; no vein is finer than `floor`. `fluctuation` is the share of the
/// sinks' demand that comes and goes.
///
/// # Errors
///
/// [`VeinError::Junctions`] beyond [`MOST_STOPS`].
pub fn radii(
    graph: &VeinGraph,
    murray: &[f64],
    floor: f64,
    fluctuation: f64,
    observer: &mut dyn Observer,
) -> Result<Vec<f64>, VeinError> {
    let Chains { chains, at } = Chains::of(graph);
    let stops: Vec<NodeId> = (0..graph.len() as NodeId)
        .filter(|&node| !at[node as usize].is_empty() && graph.parent(node).is_some())
        .collect();
    if stops.len() > MOST_STOPS {
        return Err(VeinError::Junctions { count: stops.len(), limit: MOST_STOPS });
    }
    let mut unknown = vec![None; graph.len()];
    stops.iter().enumerate().for_each(|(i, &node)| unknown[node as usize] = Some(i));
    let mut network = FlowNetwork { ends: vec![], lengths: vec![], chains: vec![], stops };
    for (number, chain) in chains.iter().enumerate() {
        let ends = [chain.nodes[0], chain.nodes[chain.nodes.len() - 1]];
        let ends = ends.map(|node| unknown[node as usize]);
        // Nothing flows round a loop back to one node, nor between roots.
        if ends[0] != ends[1] {
            let place = |node: NodeId| graph.positions()[node as usize];
            let pieces = chain.nodes.windows(2).map(|w| place(w[0]).distance(place(w[1])));
            network.ends.push(ends);
            network.lengths.push(pieces.sum());
            network.chains.push(number);
        }
    }
    let conductances = network.adapted(graph, fluctuation, observer);
    let widest = conductances.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
    let petiole = murray.iter().copied().fold(floor, f64::max);
    let mut radii: Vec<f64> = murray.iter().map(|_| floor).collect();
    for (&number, conductance) in network.chains.iter().zip(conductances) {
        let radius = rounded(petiole * (conductance / widest).sqrt().sqrt()).max(floor);
        for edge in &chains[number].edges {
            if let Edge::Parent(node) = *edge {
                radii[node as usize] = radius;
            }
        }
    }
    for (parent, child) in graph.edges() {
        if graph.parent(parent).is_none() {
            radii[parent as usize] = radii[parent as usize].max(radii[child as usize]);
        }
    }
    Ok(radii)
}

/// To a nanometre: the order of sums within the solver may depend on the machine.
fn rounded(radius: f64) -> f64 {
    (radius * 1e6).round() / 1e6
}

impl FlowNetwork {
    /// The conductances that have settled, as shares of one that carries everything.
    fn adapted(
        &self,
        graph: &VeinGraph,
        fluctuation: f64,
        observer: &mut dyn Observer,
    ) -> Vec<f64> {
        let n = self.stops.len();
        let groups = self.groups(graph);
        let (mut lower, diagonal) = (Vec::new(), |i: Option<usize>| i.map(|i| (i, i)));
        for &[a, b] in &self.ends {
            lower.extend([diagonal(a), diagonal(b)].into_iter().flatten());
            lower.extend(a.zip(b).map(|(a, b)| (a.max(b), a.min(b))));
        }
        let mut conductances = vec![1.0; self.ends.len()];
        let Some(pattern) = Pattern::new(n, &lower) else { return conductances };
        // A sink's demand, in shares of the total.
        let one = 1.0 / n as f64;
        let mut sides = vec![vec![0.0; n]; 2 * GROUPS];
        for (i, pair) in groups.iter().enumerate() {
            pair.iter().for_each(|&group| sides[group][i] = one);
        }
        sides.retain(|side| side.iter().any(|&demand| demand > 0.0));
        let shares: Vec<f64> = sides.iter().map(|side| side.iter().sum()).collect();
        // What a vein that feeds one sink has; far below that, nothing is seen any more.
        let finest = libm::pow(one, 2.0 * BETA);
        let least = 1e-3 * finest;
        let kept = libm::exp(-1.0);
        for step in 0..MOST_STEPS {
            let progress = Progress {
                stage: "widths",
                step,
                steps: MOST_STEPS,
                nodes: graph.len(),
                sources: 0,
            };
            observer.report(progress);
            let Some(flows) = self.flows(&pattern, &conductances, &sides) else {
                return conductances;
            };
            let background = BACKGROUND * libm::exp(-(step as f64) / BACKGROUND_TIME);
            let mut change = 0.0f64;
            for (edge, conductance) in conductances.iter_mut().enumerate() {
                let (mut patches, mut squares) = (0.0, 0.0);
                for (flow, share) in flows.iter().zip(&shares) {
                    patches += flow[edge];
                    squares += flow[edge] * flow[edge] / share;
                }
                // Patches and scattered groups each hold every sink once.
                let (mean, moving) = (patches / 2.0, squares / 2.0);
                let square = (1.0 - fluctuation) * mean * mean + fluctuation * moving;
                let aim = libm::pow(square, BETA) + background;
                let next = (aim + (*conductance - aim) * kept).max(least);
                change = change.max((next - *conductance).abs() / conductance.max(finest));
                *conductance = next;
            }
            if change < SETTLED && background < least {
                break;
            }
        }
        conductances
    }

    /// What flows through every edge, for each pattern of demand.
    fn flows(
        &self,
        pattern: &Pattern,
        conductances: &[f64],
        sides: &[Vec<f64>],
    ) -> Option<Vec<Vec<f64>>> {
        let mut values = Vec::new();
        let through: Vec<f64> =
            conductances.iter().zip(&self.lengths).map(|(k, length)| k / length).collect();
        for (&[a, b], &k) in self.ends.iter().zip(&through) {
            values.extend([a, b].into_iter().flatten().map(|_| k));
            values.extend(a.zip(b).map(|_| -k));
        }
        let pressures = pattern.solve(&values, sides)?;
        let flow = |pressure: &Vec<f64>| {
            let at = |end: Option<usize>| end.map_or(0.0, |i| pressure[i]);
            let edges = self.ends.iter().zip(&through);
            edges.map(|(&[a, b], &k)| k * (at(b) - at(a))).collect()
        };
        Some(pressures.iter().map(flow).collect())
    }

    /// The patch and the scattered group of each sink.
    fn groups(&self, graph: &VeinGraph) -> Vec<[usize; 2]> {
        let n = self.stops.len();
        let side = GROUPS.isqrt();
        let place = |i: usize| graph.positions()[self.stops[i] as usize];
        let mut groups: Vec<[usize; 2]> = (0..n).map(|i| [0, GROUPS + i % GROUPS]).collect();
        // Strips of equal number along the leaf, each divided across.
        let mut along: Vec<usize> = (0..n).collect();
        along.sort_by(|&a, &b| place(a).y.total_cmp(&place(b).y).then(a.cmp(&b)));
        for strip in 0..side {
            let from = |strip: usize| (strip * n).div_ceil(side);
            let mut across = along[from(strip)..from(strip + 1)].to_vec();
            across.sort_by(|&a, &b| place(a).x.total_cmp(&place(b).x).then(a.cmp(&b)));
            for (rank, &i) in across.iter().enumerate() {
                groups[i][0] = strip * side + rank * side / across.len();
            }
        }
        groups
    }
}

#[cfg(test)]
mod tests;
