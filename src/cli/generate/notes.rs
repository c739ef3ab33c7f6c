//! What is to be said of leaves before and after they are made: notes on stderr.

use venation::document::Document;
use venation::io::write::Overwrite;
use venation::veins::{Algorithm, Venation};

use super::Context;
use super::job::Job;

/// When so large a share of the sources stays without a vein, a part of the blade is bare.
const BARE: f64 = 0.05;

/// What is to be said of a leaf of which many auxin sources were not reached.
pub(super) fn of_sources(venation: &Venation) -> Option<String> {
    let (sources, unreached) = (venation.sources(), venation.unreached());
    let count = unreached.total();
    if count as f64 <= BARE * sources as f64 {
        return None;
    }
    let reasons = unreached.reasons();
    let advice = match unreached.unfinished {
        0 => "",
        _ => {
            "; with more growth.total_steps or longer steps (veins.longest_step = 0) veins come farther"
        }
    };
    Some(format!("no vein reached {count} of {sources} auxin sources ({reasons}){advice}"))
}

/// Says which leaves are perturbed by less than `vary` asks for.
pub(super) fn tell_shortfalls(
    document: &Document,
    context: &Context<'_>,
    todo: &[(&Job, Overwrite)],
) {
    let Some(wanted) = document.vary else { return };
    let varied = todo.iter().filter_map(|(job, _)| job.varied);
    let short: Vec<f64> = varied.filter(|percent| *percent < wanted).collect();
    let why = "with more, margins would cross themselves";
    match &short[..] {
        [] => {}
        [percent] if todo.len() == 1 => {
            context.say(&format!("vary: the margin differs by {percent} %, not {wanted}: {why}"));
        }
        _ => context.say(&format!(
            "vary: {} of {} margins differ by less than {wanted} %: {why}",
            short.len(),
            todo.len()
        )),
    }
}

/// Says which settings play no part.
pub(super) fn tell_unused(context: &Context<'_>, todo: &[(&Job, Overwrite)]) {
    let is_unused = |job: &Job| {
        let veins = &job.spec.veins;
        veins.algorithm == Algorithm::Particles && !veins.sources_mm.is_empty()
    };
    if todo.iter().any(|(job, _)| is_unused(job)) {
        context.say(
            "veins.sources_mm: auxin sources play no part where veins are trails of particles, \
             which start from veins.particles.pattern",
        );
    }
}

/// So many squares as wide as the kill distance in the square over half the blade's length take about a
/// minute of one core.
const MANY: f64 = 2e6;

/// Says which leaves will take long: metres given as millimetres go unnoticed otherwise.
pub(super) fn tell_sizes(context: &Context<'_>, todo: &[(&Job, Overwrite)]) {
    let apart_mm = |job: &Job| job.spec.veins.scaled().kill_distance_mm;
    let size = |job: &Job| 0.5 * (job.spec.margin.length_mm / apart_mm(job)).powi(2);
    let grown = todo.iter().filter(|(job, _)| job.spec.veins.algorithm != Algorithm::Particles);
    let slow = grown.map(|(job, _)| (size(job), *job)).filter(|(many, _)| *many > MANY);
    if let Some((many, job)) = slow.max_by(|a, b| a.0.total_cmp(&b.0)) {
        context.say(&format!(
            "seed {}: veins {:.2} mm apart in a blade of {:.0} mm take a core some {:.0} minutes; a larger \
             veins.scale makes the net coarser",
            job.seed,
            apart_mm(job),
            job.spec.margin.length_mm,
            (many / MANY).ceil(),
        ));
    }
}
