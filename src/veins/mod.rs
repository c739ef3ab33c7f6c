//! The vein pattern: grown, measured in width, ranked by order.
//!
//! Algorithms vary behind one enum and one `match` in [`grow`]; all end in a [`VeinGraph`], so
//! widths, orders and everything after them are shared.

pub mod auxin;
pub mod bow;
pub mod chains;
mod cut;
mod error;
pub mod flow;
pub mod graph;
pub mod guides;
pub mod metrics;
pub mod orders;
pub mod particles;
pub mod planar;
pub mod prune;
pub mod relax;
pub mod smooth;
mod spec;
pub mod split;
mod venation;
pub mod widths;

use glam::DVec2;

use crate::growth::GrowingBlade;
use crate::margin::Margin;
use crate::observer::{Observer, Progress};
use crate::seed::{Seed, Stage};
pub use error::VeinError;
pub use graph::{NodeId, Rank, VeinGraph, VeinKind};
pub use spec::{Algorithm, VeinSpec, Widths};
pub use venation::{Unreached, Venation};

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
    spec::check(spec)?;
    let spec = &spec::scaled(spec)?;
    let raw = match spec.algorithm {
        Algorithm::AuxinOpen | Algorithm::AuxinClosed => auxin(spec, blade, roots, seed, observer)?,
        Algorithm::Particles => trails(spec, blade, roots, seed, observer)?,
    };
    finished(spec, blade.finished(), raw, seed, observer)
}

/// A pattern in the finished blade as it grew, before its junctions and courses are refined.
struct Raw {
    graph: VeinGraph,
    nodes_after_step: Vec<u32>,
    tip_radius_mm: f64,
    sources: usize,
    unreached: Unreached,
}

/// Guides, and veins that grow from them towards auxin sources.
fn auxin(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    roots: &[DVec2],
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<Raw, VeinError> {
    let mut start = guides::build(spec, blade, &mut seed.stream(Stage::Guides));
    for &root in roots {
        let taken = start.positions().contains(&root);
        if !taken && blade.is_inside(root, *blade.steps().start()) {
            start.add_root(root);
        }
    }
    let mut rng = seed.stream(Stage::AuxinSources);
    let grown = auxin::grow(spec, blade, start, &mut rng, observer)?;
    Ok(Raw {
        graph: grown.graph.mapped(|p| blade.finished_from_mature(p)),
        nodes_after_step: grown.nodes_after_step,
        tip_radius_mm: spec.tip_radius_mm,
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
) -> Result<Raw, VeinError> {
    let roots: Vec<DVec2> = roots.iter().map(|&p| blade.finished_from_mature(p)).collect();
    let mut rng = seed.stream(Stage::Particles);
    let flowed = particles::grow(&spec.particles, blade.finished(), &roots, &mut rng, observer)?;
    let graph = match spec.longest_step {
        0.0 => flowed.graph,
        steps => cut::cut(&flowed.graph, steps * spec.particles.step_mm),
    };
    Ok(Raw {
        nodes_after_step: vec![graph.len() as u32],
        graph,
        // Every tip is one particle: Murray's law on tips is his law on energy.
        tip_radius_mm: widths::radius(
            spec.tip_radius_mm,
            spec.particles.initial_energy,
            spec.murray_exponent,
        ),
        sources: flowed.particles,
        unreached: Unreached::default(),
    })
}

/// How far the refinement of a grown pattern has come: in a leaf of a million nodes it takes longer than
/// their growth.
struct Refining<'a> {
    observer: &'a mut dyn Observer,
    step: u64,
    steps: u64,
    nodes: usize,
}

impl<'a> Refining<'a> {
    /// A step for every sweep, and for splitting, smoothing and bowing.
    fn begin(spec: &VeinSpec, observer: &'a mut dyn Observer, nodes: usize) -> Self {
        let mut refining = Self { observer, step: 0, steps: spec.relaxation + 3, nodes };
        refining.report();
        refining
    }

    fn one_more(&mut self) {
        self.step += 1;
        self.report();
    }

    fn report(&mut self) {
        let Self { step, steps, nodes, .. } = *self;
        self.observer.report(Progress { stage: "refining", step, steps, nodes, sources: 0 });
    }
}

/// Stubs away, junctions and courses as in a real leaf, then widths and orders.
fn finished(
    spec: &VeinSpec,
    margin: &Margin,
    raw: Raw,
    seed: Seed,
    observer: &mut dyn Observer,
) -> Result<Venation, VeinError> {
    let mut refining = Refining::begin(spec, observer, raw.graph.len());
    let (graph, nodes_after_step) = prune::pruned(spec, raw.graph, raw.nodes_after_step);
    let (graph, nodes_after_step) = split::split(spec, margin, graph, nodes_after_step);
    refining.one_more();
    // Before smoothing: it puts nodes between, and balance asks for junctions only.
    let graph = relax::relaxed(spec, margin, graph, || refining.one_more());
    let smooth::Smoothed { graph, nodes_after_step } =
        smooth::smoothed(spec, margin, graph, nodes_after_step);
    refining.one_more();
    let graph = bow::bowed(spec, margin, graph, &mut seed.stream(Stage::Bows));
    refining.one_more();
    let (radii, orders) = widths::radii_and_orders(spec, &graph, raw.tip_radius_mm, observer)?;
    Ok(Venation {
        graph,
        radii,
        orders,
        widths: spec.widths,
        nodes_after_step,
        sources: raw.sources,
        unreached: raw.unreached,
    })
}

#[cfg(test)]
mod properties;
#[cfg(test)]
mod tests;
