//! Guides given line by line, in place of those of the types.

use glam::DVec2;

use super::curve;
use super::planter::{Planter, Vein};
use super::primary::into_lobe;
use super::{EXTERIOR, INTERSECONDARY, PRIMARY, SECONDARY, TERTIARY};
use crate::geometry::point_grid::Nearest;
use crate::parameter::parameters;
use crate::veins::VeinError;
use crate::veins::graph::{Rank, VeinKind};

parameters! {
    /// Guides as lines of points in lengths of the blade, from its base at (0, 0) to the apex at (0, 1). A
    /// line begins at the base or on a line before it, and is laid as far as it gets. Any given, no others
    /// are laid.
    pub struct GivenSpec {
        /// Primary veins, the midrib first.
        primary: lines(),
        /// Secondary veins, and the arches between them.
        secondary: lines(),
        /// Veins between two secondaries.
        intersecondary: lines(),
        /// Arches and branches outside the secondaries.
        exterior: lines(),
        /// Pieces of a vein inside the margin.
        intramarginal: lines(),
        /// Pieces of a vein on the margin.
        marginal: lines(),
        /// Veins between secondaries.
        tertiary: lines(),
    }
}

/// A line that begins farther than this from every other (in steps) began on one that was not laid.
const LOST: f64 = 6.0;

/// The rest of a line that a vein in its way may cut off without being another end than was meant.
const REST: f64 = 0.15;

/// A midrib that gets less far than this goes the way that a midrib of the types would.
const WHOLE: f64 = 0.95;

impl GivenSpec {
    /// Whether there is no line.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lists().iter().all(|(_, lines)| lines.is_empty())
    }

    /// All lines in the order in which they are laid, with the rank of their veins.
    pub(super) fn lists(&self) -> [(Rank, &Vec<Vec<[f64; 2]>>); 7] {
        let along = |kind| Rank { order: 2, kind };
        [
            (PRIMARY, &self.primary),
            (SECONDARY, &self.secondary),
            (INTERSECONDARY, &self.intersecondary),
            (EXTERIOR, &self.exterior),
            (along(VeinKind::Intramarginal), &self.intramarginal),
            (along(VeinKind::Marginal), &self.marginal),
            (TERTIARY, &self.tertiary),
        ]
    }

    /// Adds a line (in lengths of the blade) to those of its kind.
    pub(super) fn push(&mut self, kind: VeinKind, line: &[DVec2]) {
        let list = match kind {
            VeinKind::Primary => &mut self.primary,
            VeinKind::Secondary => &mut self.secondary,
            VeinKind::Intersecondary => &mut self.intersecondary,
            VeinKind::Exterior => &mut self.exterior,
            VeinKind::Intramarginal => &mut self.intramarginal,
            VeinKind::Marginal => &mut self.marginal,
            VeinKind::Tertiary | VeinKind::Minor => &mut self.tertiary,
        };
        let rounded = |x: f64| (x * ROUNDING).round() / ROUNDING;
        list.push(line.iter().map(|p| [rounded(p.x), rounded(p.y)]).collect());
    }
}

/// Points are kept to this part of a length: a tenth of a micrometre in a leaf of a hand.
const ROUNDING: f64 = 1e6;

/// Refuses a line that is none.
pub(super) fn check(given: &GivenSpec) -> Result<(), VeinError> {
    for (rank, lines) in given.lists() {
        if let Some(line) = lines.iter().find(|line| line.len() < 2) {
            let key = format!("veins.guides.given.{}", rank.kind.word());
            let problem = "points to a line are too few; it takes 2".to_owned();
            return Err(VeinError::setting(key, line.len() as f64, problem));
        }
    }
    Ok(())
}

/// Lays them.
pub(super) fn lay(given: &GivenSpec, planter: &mut Planter<'_>) {
    planter.root(PRIMARY);
    let length = planter.ground.length();
    for (rank, lines) in given.lists() {
        for line in lines {
            let line: Vec<DVec2> = line.iter().map(|p| DVec2::from(*p) * length).collect();
            let first = planter.records.is_empty();
            let laid = if first { midrib(planter, &line) } else { branch(planter, &line, rank) };
            if let Some(vein) = laid {
                join(planter, &vein, &line, rank);
            }
        }
    }
}

/// The midrib, along its line or the way that the blade has for one.
fn midrib(planter: &mut Planter<'_>, line: &[DVec2]) -> Option<Vein> {
    let axis = planter.ground.axis();
    // The base itself is on the margin; the root is inside.
    let line = &begun_at(line, planter.ground.root())[..];
    let line = if planter.way(line) < WHOLE && planter.way(line) < planter.way(&axis) {
        &axis[..]
    } else {
        line
    };
    planter.lay(0, line, PRIMARY, 0.0)
}

/// Any other vein; round the margin where its line would cross that.
fn branch(planter: &mut Planter<'_>, line: &[DVec2], rank: Rank) -> Option<Vein> {
    let Nearest { id: node, distance2, .. } = planter.nearest(line[0])?;
    if distance2.sqrt() > LOST * planter.step {
        return None;
    }
    let from = planter.graph.positions()[node as usize];
    let line = &begun_at(line, from)[..];
    let end = line[line.len() - 1];
    let is_main = matches!(rank.kind, VeinKind::Primary | VeinKind::Secondary);
    if is_main && planter.way(line) < WHOLE - REST {
        let side = if end.x < from.x { -1.0 } else { 1.0 };
        let round = into_lobe(planter, from, side, end);
        if planter.way(&round) > planter.way(line) {
            return planter.lay(node, &round, rank, 0.0);
        }
    }
    let laid = planter.lay(node, line, rank, 0.0);
    if laid.is_some() || !is_main {
        return laid;
    }
    // No room, or too near to the margin: nearer to the vein it leaves.
    let ahead = planter.ahead(node);
    TURNS.iter().find_map(|turn| {
        let towards = |p: &DVec2| {
            let off = *p - from;
            from + (off.normalize_or_zero().lerp(ahead, *turn)).normalize_or_zero() * off.length()
        };
        let turned: Vec<DVec2> = line.iter().map(towards).collect();
        planter.lay(node, &turned, rank, 0.0)
    })
}

/// The line moved so that it begins at `from`, less and less until its end stays: it keeps its direction.
fn begun_at(line: &[DVec2], from: DVec2) -> Vec<DVec2> {
    let (shift, last) = (from - line[0], (line.len() - 1) as f64);
    let moved = |(i, p): (usize, &DVec2)| *p + shift * (1.0 - i as f64 / last);
    let mut begun: Vec<DVec2> = line.iter().enumerate().map(moved).collect();
    begun[0] = from;
    begun
}

/// How far a vein without room is turned towards the vein it leaves.
const TURNS: [f64; 4] = [0.25, 0.5, 0.7, 0.85];

/// A line that meets a vein at its end was to end there.
fn join(planter: &mut Planter<'_>, vein: &Vein, line: &[DVec2], rank: Rank) {
    let reached = vein.length() / curve::length(line).max(1e-300);
    let fine = !matches!(rank.kind, VeinKind::Primary | VeinKind::Secondary);
    if reached > 1.0 - REST || fine {
        planter.join_hit(vein);
    }
}
