//! The vein pattern: grown, measured in width, ranked by order.
//!
//! Algorithms vary behind one enum and one `match` in [`grow`]; all end in a [`VeinGraph`], so
//! widths, orders and everything after them are shared.

pub mod auxin;
pub mod bow;
pub mod chains;
pub mod flow;
pub mod graph;
pub mod guides;
pub mod metrics;
pub mod orders;
pub mod particles;
pub mod planar;
pub mod relax;
pub mod smooth;
pub mod split;
pub mod widths;

use glam::DVec2;

use crate::geometry::polygon;
use crate::growth::GrowingBlade;
use crate::margin::Margin;
use crate::observer::Observer;
use crate::parameter::{Kind, Parameters, parameters, words};
use crate::seed::{Seed, Stage};
use auxin::{ConvergenceSpec, DensitySpec, PhaseSpec};
pub use graph::{NodeId, Rank, VeinGraph, VeinKind};
use guides::GuideSpec;
use particles::ParticleSpec;

words! {
    /// How veins are made.
    pub enum Algorithm {
        /// Veins grow towards auxin sources and never meet (Runions et al. 2005, open venation).
        AuxinOpen = "auxin-open",
        /// Veins grow towards auxin sources and meet there, so that loops close (Runions et al. 2005,
        /// closed venation).
        AuxinClosed = "auxin-closed",
        /// Veins are the trails of particles that flow to the petiole (Rodkaew et al. 2002).
        Particles = "particles",
    }
}

words! {
    /// Where the widths of veins come from.
    pub enum Widths {
        /// The number of tips behind them, by Murray's law; what joins veins carries nothing.
        Murray = "murray",
        /// The flow through them, to which they adapt: in loops, too.
        Flow = "flow",
    }
}

parameters! {
    /// Growth of the vein pattern. Lengths are those of the blade at the step in question.
    pub struct VeinSpec {
        /// How veins are made.
        algorithm: choice(Algorithm, Algorithm::AuxinOpen),
        /// Auxin darts thrown per step at full size; more gives a denser pattern.
        spawn_rate: number(60.0, 0.0..=100_000.0, "darts/step"),
        /// A dart nearer than this to a source is lost.
        source_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A dart nearer than this to a vein is lost.
        vein_spawn_distance_mm: number(1.0, 0.0..=1000.0, "mm"),
        /// A source is used up when a vein comes within this distance.
        kill_distance_mm: number(0.8, 0.001..=1000.0, "mm"),
        /// How far a vein grows in one step.
        node_step_mm: number(0.3, 0.001..=100.0, "mm"),
        /// A source calls veins within this distance only; 0 for no limit.
        attraction_distance_mm: number(0.0, 0.0..=10_000.0, "mm"),
        /// Closed venation: veins meet only where the way round along other veins is longer than this;
        /// around 5 and more, no areole is a speck.
        least_loop: number(2.0, 0.0..=50.0, "kill distances"),
        /// Closed venation: share of the steps in which veins close loops. In the rest they end free, as
        /// in open venation: the finest veinlets of a real leaf.
        closing_share: number(1.0, 0.0..=1.0, ""),
        /// Closed venation, last steps that close no loops: spawn and kill distances there, relative to
        /// those before. Below 1, sources find room inside the loops.
        veinlet_scale: number(0.7, 0.1..=2.0, ""),
        /// Closed venation: kill distance in the last steps, relative to that before (no less than half
        /// a step). Small, and the veinlets reach the middle of what they feed.
        veinlet_kill: number(0.7, 0.01..=2.0, ""),
        /// How straight veins come: 0 as their sources pull them, at 1 tips keep most of their heading.
        straightness: number(0.0, 0.0..=1.0, ""),
        /// How strongly veins are drawn to the apex: a vein that would leave at a right angle leaves at
        /// atan(1/pull), 45° for 1.
        pull: number(0.0, 0.0..=3.0, ""),
        /// Share of the darts that have a twin on the other side of the midrib; 1 for a leaf whose halves
        /// mirror each other.
        symmetry: number(0.0, 0.0..=1.0, ""),
        /// How far a twin may be off its mirrored place.
        symmetry_jitter_mm: number(0.0, 0.0..=100.0, "mm"),
        /// Sources stand far apart at first, so that orders of veins follow each other.
        phases: group(PhaseSpec, PhaseSpec::default()),
        /// Points on the margin from which the first veins come.
        convergence: group(ConvergenceSpec, ConvergenceSpec::default()),
        /// Where darts fall more or less densely.
        density: group(DensitySpec, DensitySpec::default()),
        /// Positions of auxin sources in the mature leaf, instead of darts.
        sources_mm: points(),
        /// Radius of the finest veins.
        tip_radius_mm: number(0.03, 0.0001..=10.0, "mm"),
        /// Murray's exponent: the parent's radius to this power is the sum over its children.
        murray_exponent: number(3.0, 1.0..=10.0, ""),
        /// What each order adds to Murray's exponent, from the second on; it stays from 1 to 10. The
        /// order is that of the vein that divides.
        exponent_change: number(0.0, -9.0..=9.0, ""),
        /// No vein is drawn finer; 0 for the radius of the tips.
        least_radius_mm: number(0.0, 0.0..=10.0, "mm"),
        /// How evenly a vein tapers between its branches: 0 in a step at each, 1 all the way.
        taper: number(0.0, 0.0..=1.0, ""),
        /// Where widths come from: `murray` counts tips, `flow` lets veins adapt to what flows through
        /// them, loops included, and takes seconds for each 10 000 junctions.
        widths: choice(Widths, Widths::Murray),
        /// Share of the demand for water that comes and goes, for `widths = "flow"`; loops live on it.
        fluctuation: number(0.5, 0.0..=1.0, ""),
        /// How often junctions move towards a balance of the veins' pull; about 5 gives natural angles.
        relaxation: count(0, 0..=100, "sweeps"),
        /// How far kinks of grown veins are drawn straight; above 0 long segments become curves too.
        smoothing: number(0.0, 0.0..=1.0, ""),
        /// How far fine veins bow between their junctions: the spread of the height of the bow, as a share
        /// of its length. 0.1 gives veins 2 hundredths longer than their chords.
        sinuosity: number(0.0, 0.0..=0.5, ""),
        /// Veins that are laid before auxin takes over.
        guides: group(GuideSpec, GuideSpec::default()),
        /// Particles, for `algorithm = "particles"`.
        particles: group(ParticleSpec, ParticleSpec::default()),
    }
}

impl std::fmt::Display for Unreached {
    /// The count, and the reasons in words.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.total())?;
        let reasons = [
            (self.outside, "outside the blade"),
            (self.too_young, "where the margin has not come yet"),
            (self.out_of_reach, "beyond the attraction distance of every vein"),
            (self.hidden, "hidden behind the margin or a cut"),
            (self.unfinished, "not reached when growth ended"),
        ];
        let mut separator = ": ";
        for (count, reason) in reasons.into_iter().filter(|&(count, _)| count > 0) {
            write!(f, "{separator}{count} {reason}")?;
            separator = ", ";
        }
        Ok(())
    }
}

/// A vein pattern with widths and orders.
///
/// # Guarantees
///
/// - One radius (mm, positive) and one order (1 = primary) for each node.
/// - A radius is never smaller than a child's, unless widths come from the flow; an order is never
///   greater than a child's.
/// - Every node lies inside the margin it was grown in.
#[derive(Debug, Clone, PartialEq)]
pub struct Venation {
    graph: VeinGraph,
    radii: Vec<f64>,
    orders: Vec<u8>,
    widths: Widths,
    nodes_after_step: Vec<u32>,
    sources: usize,
    unreached: Unreached,
}

/// The auxin sources that no vein reached, by reason.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Serialize)]
pub struct Unreached {
    /// Given places outside the blade.
    pub outside: usize,
    /// Places that the margin of a bud has not passed.
    pub too_young: usize,
    /// Farther from every vein than the attraction distance.
    pub out_of_reach: usize,
    /// The margin or a cut hides them from the nearest vein.
    pub hidden: usize,
    /// Veins were on their way when growth ended, or could not come closer.
    pub unfinished: usize,
}

impl Unreached {
    /// All of them.
    #[must_use]
    pub fn total(&self) -> usize {
        self.outside + self.too_young + self.out_of_reach + self.hidden + self.unfinished
    }
}

impl Venation {
    /// A graph whose nodes have these radii and orders, grown at once and from no sources.
    ///
    /// # Panics
    ///
    /// If there is not one radius and one order for each node.
    #[must_use]
    pub fn new(graph: VeinGraph, radii: Vec<f64>, orders: Vec<u8>) -> Self {
        assert_eq!(radii.len(), graph.len(), "a radius for every node");
        assert_eq!(orders.len(), graph.len(), "an order for every node");
        let nodes_after_step = vec![graph.len() as u32];
        let unreached = Unreached::default();
        let widths = Widths::Murray;
        Self { graph, radii, orders, widths, nodes_after_step, sources: 0, unreached }
    }

    /// The nodes and edges.
    #[must_use]
    pub fn graph(&self) -> &VeinGraph {
        &self.graph
    }

    /// Radius of the vein at each node (mm).
    #[must_use]
    pub fn radii(&self) -> &[f64] {
        &self.radii
    }

    /// Order of the vein at each node: 1 primary, 2 secondary, …
    #[must_use]
    pub fn orders(&self) -> &[u8] {
        &self.orders
    }

    /// What part of the pattern a node belongs to.
    #[must_use]
    pub fn kind(&self, node: NodeId) -> VeinKind {
        if let Some(rank) = self.graph.rank(node) {
            return rank.kind;
        }
        match self.orders[node as usize] {
            0 | 1 => VeinKind::Primary,
            2 => VeinKind::Secondary,
            _ => VeinKind::Minor,
        }
    }

    /// How many nodes there were after each step; nodes are numbered as they grew. Guided veins are
    /// there from the first step on.
    #[must_use]
    pub fn nodes_after_step(&self) -> &[u32] {
        &self.nodes_after_step
    }

    /// How many auxin sources there were in all.
    #[must_use]
    pub fn sources(&self) -> usize {
        self.sources
    }

    /// The auxin sources that no vein reached.
    #[must_use]
    pub fn unreached(&self) -> Unreached {
        self.unreached
    }

    /// The first guarantee that does not hold inside `margin`, in words; `None` when all do. For
    /// tests.
    #[must_use]
    pub fn check(&self, margin: &Margin) -> Option<String> {
        if let Some(broken) = self.graph.check() {
            return Some(broken);
        }
        let n = self.graph.len();
        if self.radii.len() != n || self.orders.len() != n {
            return Some("not one radius and one order for each node".into());
        }
        let odd = |node: &usize| !(self.radii[*node] > 0.0 && self.orders[*node] > 0);
        if let Some(node) = (0..n).find(odd) {
            return Some(format!("node {node} has no radius or no order"));
        }
        let shrinks = |&(parent, child): &(NodeId, NodeId)| {
            let (parent, child) = (parent as usize, child as usize);
            let thinner = self.radii[parent] < self.radii[child];
            (thinner && self.widths == Widths::Murray) || self.orders[parent] > self.orders[child]
        };
        if let Some((parent, child)) = self.graph.edges().find(shrinks) {
            return Some(format!(
                "node {parent} is thinner or of a higher order than its child {child}"
            ));
        }
        let outside = |p: &&DVec2| !polygon::contains(margin.outline(), **p);
        self.graph.positions().iter().find(outside).map(|p| format!("a node outside, at {p}"))
    }
}

/// Grows the vein pattern of a leaf from the base of its blade, in the size of the finished leaf.
///
/// # Errors
///
/// [`VeinError`] names the key, the value and the limit.
pub fn grow(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<Venation, VeinError> {
    grow_from(spec, blade, &[blade.root()], seed, observer)
}

/// The same from any roots, in the frame of the mature leaf; those outside the first blade grow
/// nothing. Guides start at the base of the blade whatever the roots.
///
/// # Errors
///
/// As [`grow`].
pub fn grow_from(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    roots: &[DVec2],
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<Venation, VeinError> {
    check(spec)?;
    let mut start = guides::build(spec, blade, &mut seed.stream(Stage::Guides));
    for &root in roots {
        let taken = start.positions().contains(&root);
        if !taken && blade.is_inside(root, *blade.steps().start()) {
            start.add_root(root);
        }
    }
    let grown = match spec.algorithm {
        Algorithm::AuxinOpen | Algorithm::AuxinClosed => {
            auxin::grow(spec, blade, start, &mut seed.stream(Stage::AuxinSources), observer)?
        }
        Algorithm::Particles => return trails(spec, blade, roots, seed, observer),
    };
    let graph = grown.graph.mapped(|p| blade.finished_from_mature(p));
    let (graph, nodes_after_step) =
        split::split(spec, blade.finished(), graph, grown.nodes_after_step);
    // Before smoothing: it puts nodes between, and balance asks for junctions only.
    let graph = relax::relaxed(spec, blade.finished(), graph);
    let smooth::Smoothed { graph, nodes_after_step } =
        smooth::smoothed(spec, blade.finished(), graph, nodes_after_step);
    let graph = bow::bowed(spec, blade.finished(), graph, &mut seed.stream(Stage::Bows));
    let (radii, orders) = widths::radii_and_orders(spec, &graph, spec.tip_radius_mm, observer)?;
    Ok(Venation {
        graph,
        radii,
        orders,
        widths: spec.widths,
        nodes_after_step,
        sources: grown.sources,
        unreached: grown.unreached,
    })
}

/// Veins as the trails of particles in the finished blade.
fn trails(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    roots: &[DVec2],
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<Venation, VeinError> {
    let roots: Vec<DVec2> = roots.iter().map(|&p| blade.finished_from_mature(p)).collect();
    let mut rng = seed.stream(Stage::Particles);
    let flowed = particles::grow(&spec.particles, blade.finished(), &roots, &mut rng, observer)?;
    // Every tip is one particle: Murray's law on tips is his law on energy.
    let tip =
        widths::radius(spec.tip_radius_mm, spec.particles.initial_energy, spec.murray_exponent);
    let (graph, _) = split::split(spec, blade.finished(), flowed.graph, Vec::new());
    let graph = relax::relaxed(spec, blade.finished(), graph);
    let graph = bow::bowed(spec, blade.finished(), graph, &mut seed.stream(Stage::Bows));
    let (radii, orders) = widths::radii_and_orders(spec, &graph, tip, observer)?;
    let widths = spec.widths;
    Ok(Venation { widths, sources: flowed.particles, ..Venation::new(graph, radii, orders) })
}

/// Refuses settings under which growth would make no sense or never end.
fn check(spec: &VeinSpec) -> Result<(), VeinError> {
    particles::check(&spec.particles)?;
    let defaults = VeinSpec::parameters();
    let value = |key: &str| match key {
        "spawn_rate" => spec.spawn_rate,
        "source_spawn_distance_mm" => spec.source_spawn_distance_mm,
        "vein_spawn_distance_mm" => spec.vein_spawn_distance_mm,
        "kill_distance_mm" => spec.kill_distance_mm,
        "node_step_mm" => spec.node_step_mm,
        "attraction_distance_mm" => spec.attraction_distance_mm,
        "tip_radius_mm" => spec.tip_radius_mm,
        "closing_share" => spec.closing_share,
        "veinlet_scale" => spec.veinlet_scale,
        "smoothing" => spec.smoothing,
        "least_loop" => spec.least_loop,
        "veinlet_kill" => spec.veinlet_kill,
        "sinuosity" => spec.sinuosity,
        "exponent_change" => spec.exponent_change,
        "least_radius_mm" => spec.least_radius_mm,
        "taper" => spec.taper,
        "straightness" => spec.straightness,
        "pull" => spec.pull,
        "symmetry" => spec.symmetry,
        "symmetry_jitter_mm" => spec.symmetry_jitter_mm,
        "fluctuation" => spec.fluctuation,
        _ => spec.murray_exponent,
    };
    for parameter in &defaults {
        let Kind::Number { min, max, .. } = parameter.kind else { continue };
        if parameter.key.contains('.') {
            // Groups check their own.
            continue;
        }
        let value = value(&parameter.key);
        if !(min..=max).contains(&value) {
            let key = format!("veins.{}", parameter.key);
            return Err(VeinError::setting(key, value, format!("must be from {min} to {max}")));
        }
    }
    guides::check(&spec.guides)?;
    auxin::check(spec)?;
    // A vein steps over a source that is nearer than its step; half a step beyond, it must count as
    // reached, or the vein would turn round for ever.
    let least = spec.node_step_mm / 2.0;
    if spec.kill_distance_mm < least {
        let problem = format!(
            "must be at least half of veins.node_step_mm ({least}): veins would step over the sources"
        );
        return Err(VeinError::setting("veins.kill_distance_mm", spec.kill_distance_mm, problem));
    }
    Ok(())
}

/// Why veins could not be grown.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VeinError {
    /// Two settings contradict each other.
    #[error("{key} = {value} {problem}")]
    Setting {
        /// The key.
        key: String,
        /// Its value.
        value: f64,
        /// What is wrong and what to change.
        problem: String,
    },
    /// Too many junctions for widths from the flow.
    #[error(
        "veins.widths = \"flow\" takes at most {limit} junctions and ends, here are {count}: grow \
         fewer veins (veins.source_spawn_distance_mm) or take \"murray\""
    )]
    Junctions {
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
}

impl VeinError {
    fn setting(key: impl Into<String>, value: f64, problem: impl Into<String>) -> Self {
        Self::Setting { key: key.into(), value, problem: problem.into() }
    }
}

#[cfg(test)]
mod tests;
