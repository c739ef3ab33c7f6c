//! Veins grow towards auxin sources.
//!
//! In every step the blade grows, sources appear where there is room, each source calls the vein
//! node it is nearest to, each called node grows one step towards its callers, and sources that a
//! node has come close to are used up.
//!
//! Source: Runions et al., "Modeling and visualization of leaf venation patterns", ACM Trans. Graph.
//! 24(3), 2005, with the growth, the darts and the order of a step of E. Foster's *Procedural leaf
//! generation*. Departs from them: everything stands still in the frame of the mature leaf and the
//! distances shrink instead (exact for the growth types offered); line of sight is settled on the
//! polygon and not on pixels; a vein never crosses the margin or a cut.
//!
//! Lengths in the settings are millimetres of the blade at the step in question.

mod callers;
mod calls;
mod claims;
mod closed;
mod convergence;
mod extend;
mod field;
mod habit;
mod horizon;
mod neighbours;
mod nodes;
mod open;
mod sources;
mod tiles;
mod views;
mod web;

use super::graph::VeinGraph;
use super::{Algorithm, Unreached, VeinError, VeinSpec};
use crate::growth::{GrowingBlade, Metric};
use crate::observer::{Observer, Progress};
use crate::seed::Rng;
use callers::Callers;
use convergence::Convergence;
pub use convergence::ConvergenceSpec;
use habit::Steering;
pub use habit::{DensitySpec, PhaseSpec};
pub(crate) use nodes::LEAST_BETWEEN_NODES;
use nodes::{Meeting, Nodes};
use sources::Supply;

/// No node, no source.
const NONE: u32 = u32::MAX;

/// What grew.
#[derive(Debug, Clone, PartialEq)]
pub struct Grown {
    /// The veins, in the frame of the mature leaf.
    pub graph: VeinGraph,
    /// The sources that are left.
    pub unreached: Unreached,
    /// Sources that ever were.
    pub sources: usize,
    /// Living sources, summed over the steps made.
    pub source_steps: u64,
    /// How many nodes there were after each step made; fewer steps than the blade has when nothing
    /// could change any more.
    pub nodes_after_step: Vec<u32>,
}

/// More nodes than this are a slip of the keyboard: a leaf with every areole of a real one has 1.5
/// million.
const MAX_NODES: usize = 10_000_000;

/// Veins get this many distances between sources far from the last closing source to the first of
/// the veinlets.
const DRAIN: f64 = 3.0;

/// How many nodes can grow in the blade before they stand closer than a quarter of a step everywhere,
/// as children of one node never do. Without this limit a shower of darts with no least distances
/// lets veins double in every step, until millions of nodes stand in one place.
fn room(spec: &VeinSpec, blade: &GrowingBlade, metric: Metric) -> f64 {
    let step = metric.reach(metric.length(spec.node_step_mm));
    10_000.0 + 16.0 * blade.mature().area_mm2() / step.element_product()
}

/// Grows open or closed venation from the veins of `start` (in the frame of the mature leaf): bare
/// roots, or guides, which are there from the first step on.
///
/// # Errors
///
/// [`VeinError`] with the key, the value and the limit.
pub fn grow(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    start: VeinGraph,
    rng: &mut Rng,
    observer: &mut dyn Observer,
) -> Result<Grown, VeinError> {
    let steps = blade.steps().count() as u64;
    let is_closed = spec.algorithm == Algorithm::AuxinClosed;
    let closing_steps =
        if is_closed { (spec.closing_share * steps as f64).round() as u64 } else { steps };
    // Before the last veins, which end free, those on their way meet: else they would end a hair before
    // each other.
    let drain = (DRAIN * spec.source_spawn_distance_mm / spec.node_step_mm).ceil() as u64;
    let drain = drain.min(closing_steps / 4);
    let mut supply = Supply::new(spec, blade, closing_steps)?;
    let first = *blade.steps().start();
    let meeting = if is_closed { Meeting::Join } else { Meeting::Stop };
    let mut nodes = Nodes::new(spec, blade, start, blade.frame(first).metric(), meeting);
    // Mostly a vein takes two or three steps from source to source.
    nodes.expect(3 * supply.most());
    if nodes.graph().is_empty() {
        return Err(VeinError::setting("root", 0.0, "no root lies inside the blade"));
    }
    let mut convergence = Convergence::new(spec, blade, steps, rng);
    if convergence.is_some() {
        nodes.rank_roots(convergence::PRIMARY);
    }
    let is_steered = !Steering::new(spec, 0.0).is_off();
    let mut open = open::Sources::new(spec, blade);
    let mut closed = is_closed.then(|| closed::Sources::new(spec, blade));
    // Full size: nothing changes any more once a step has changed nothing.
    let full_size = blade.is_full_size();
    let mut stands_still = false;
    let pace = (steps / 100).max(1);
    let mut made = 0;
    let mut nodes_after_step = Vec::new();
    let mut source_steps = 0;
    // Those that were laid stand as close as they were laid.
    let mut grown = 0;
    for step in blade.steps() {
        let frame = blade.frame(step);
        let metric = frame.metric();
        nodes.refine(metric);
        let is_closing = made < closing_steps;
        let age = made as f64 / steps as f64;
        if is_steered {
            nodes.steer(Steering::new(spec, age));
        }
        if is_closing && stands_still {
            // Nothing happens before the last veins, which end free.
            made += 1;
            nodes_after_step.push(nodes.len() as u32);
            continue;
        }
        if is_closed && closing_steps < steps && made + drain >= closing_steps && is_closing {
            supply.rest();
        }
        if let Some(sources) = closed.take_if(|_| !is_closing) {
            open = end_free(sources, spec, blade, step, &mut nodes, &mut supply);
            supply.crowd(spec.veinlet_scale, steps - closing_steps);
        }
        let is_last = closed.is_none() || closing_steps == steps;
        let calls: &mut dyn Callers = match &mut closed {
            Some(closed) => closed,
            None => &mut open,
        };
        if supply.is_due(step, age) || blade.deforms() || blade.is_warped() {
            nodes.follow();
        }
        // Seed new sources where the blade has room.
        supply.seed(step, age, metric, rng, calls, &nodes)?;
        // Let each source call the nodes it is to call.
        source_steps += calls.living() as u64;
        calls.call(blade, step, metric, &nodes);
        // Grow each called node one step towards its callers.
        let before = nodes.len();
        nodes.extend(calls, blade, step, metric);
        let points = convergence.as_mut().filter(|points| points.is_open(made));
        let is_open = points.is_some();
        if let Some(points) = points {
            points.grow(&mut nodes, step, metric, rng);
        }
        grown += nodes.len() - before;
        if nodes.len() > MAX_NODES || grown as f64 > room(spec, blade, metric) {
            let problem = "crowds the blade with vein nodes; raise it, raise the spawn distances or \
                           throw fewer darts";
            return Err(VeinError::setting("veins.node_step_mm", spec.node_step_mm, problem));
        }
        // Let the new nodes take sources over, and remove those that have been reached.
        let dead = calls.take_over(before, blade, step, metric, &mut nodes);
        stands_still = full_size
            && dead.is_empty()
            && nodes.len() == before
            && !calls.is_waiting()
            && !supply.is_paced();
        supply.forget(&dead);
        made += 1;
        nodes_after_step.push(nodes.len() as u32);
        if made % pace == 0 || made == steps {
            observer.report(Progress {
                stage: "veins",
                step: made,
                steps,
                nodes: nodes.len(),
                sources: calls.living(),
            });
        }
        // Stop when nothing can change any more: under growth lengths shrink and room appears, so
        // only a blade of full size settles while there are sources left.
        let is_settled = calls.living() == 0 || stands_still;
        if supply.is_exhausted() && is_settled && is_last && !is_open {
            break;
        }
    }
    if let Some(closed) = &mut closed {
        // Veins that have come to a source meet, though others are still on their way.
        let last = blade.last_step();
        closed.settle(blade, last, blade.frame(last).metric(), &mut nodes);
        if let Some(count) = nodes_after_step.last_mut() {
            *count = nodes.len() as u32;
        }
    }
    let calls: &dyn Callers = match &closed {
        Some(closed) => closed,
        None => &open,
    };
    let mut unreached = calls.unreached(blade, &nodes);
    unreached.outside += supply.outside();
    unreached.too_young += supply.unborn();
    let sources = calls.len() + unreached.outside + supply.unborn();
    Ok(Grown { graph: nodes.into_graph(), unreached, sources, source_steps, nodes_after_step })
}

/// Turns closed venation into open: what has come to a source meets, and the sources that are left
/// call their nearest node only.
fn end_free(
    mut sources: closed::Sources,
    spec: &VeinSpec,
    blade: &GrowingBlade,
    step: u64,
    nodes: &mut Nodes,
    supply: &mut Supply<'_>,
) -> open::Sources {
    let frame = blade.frame(step);
    let metric = frame.metric();
    supply.forget(&sources.settle(blade, step, metric, nodes));
    nodes.end_free();
    let mut spec = spec.clone();
    let least = spec.node_step_mm / 2.0;
    spec.kill_distance_mm = (spec.kill_distance_mm * spec.veinlet_kill).max(least);
    sources.opened(&spec, blade, metric, nodes)
}
