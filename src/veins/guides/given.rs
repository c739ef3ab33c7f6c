//! Guides given line by line, in place of those of the types.

use glam::DVec2;

use super::aside::{self, aside};
use super::curve;
use super::planter::{Planter, Vein};
use super::primary::into_lobe;
use super::sinus;
use super::{EXTERIOR, INTERSECONDARY, PRIMARY, SECONDARY, TERTIARY};
use crate::geometry::Rect;
use crate::parameter::parameters;
use crate::veins::VeinError;
use crate::veins::graph::{NodeId, Rank, VeinKind};

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
    let mut laid = LaidLines::default();
    for (rank, lines) in given.lists() {
        for line in lines {
            let line: Vec<DVec2> = line.iter().map(|p| DVec2::from(*p) * length).collect();
            let vein = if laid.is_empty() {
                midrib(planter, &line)
            } else {
                laid.start(line[0], length).and_then(|start| branch(planter, &line, rank, &start))
            };
            if let Some((vein, course)) = vein {
                join(planter, &vein, &line, rank);
                laid.push(line, vein, course);
            }
        }
    }
}

/// The midrib, along its line or the way that the blade has for one; what was laid and the whole of it.
fn midrib(planter: &mut Planter<'_>, line: &[DVec2]) -> Option<(Vein, Vec<DVec2>)> {
    let axis = planter.ground.axis();
    // The base itself is on the margin; the root is inside.
    let mut line = begun_at(line, planter.ground.root());
    let way = planter.way(&line, PRIMARY);
    if way < WHOLE && way < planter.way(&axis, PRIMARY) {
        line = axis;
    }
    let vein = planter.lay(0, &line, PRIMARY, 0.0)?;
    Some((vein, line))
}

/// Any other vein. Where the margin is in its way it keeps inside that; where that is a long way, it goes
/// round it.
fn branch(
    planter: &mut Planter<'_>,
    line: &[DVec2],
    rank: Rank,
    start: &Start<'_>,
) -> Option<(Vein, Vec<DVec2>)> {
    let (node, from) = (start.node, planter.graph.positions()[start.node as usize]);
    let mut course = begun_at(line, from);
    let is_main = matches!(rank.kind, VeinKind::Primary | VeinKind::Secondary);
    let left = is_main && start.is_left(line);
    let length = planter.ground.length();
    let on_its_side = |course: Vec<DVec2>| aside(course, start.parent, start.share, left, length);
    if is_main {
        if from.distance(line[0]) > planter.step {
            // The other had to be laid elsewhere.
            course = on_its_side(course);
        }
        if rank == PRIMARY {
            course = on_its_side(sinus::round(planter.ground, &course));
        }
        if planter.way(&course, rank) < WHOLE {
            let inside = planter.ground.inside(&curve::resampled(&course, planter.step));
            let inside = on_its_side(inside);
            if planter.way(&inside, rank) > planter.way(&course, rank) {
                course = inside;
            }
        }
        if planter.way(&course, rank) < WHOLE - REST {
            let end = line[line.len() - 1];
            let side = if end.x < from.x { -1.0 } else { 1.0 };
            let round = on_its_side(into_lobe(planter, from, side, end));
            if planter.way(&round, rank) > planter.way(&course, rank) {
                course = round;
            }
        }
    }
    if let Some(vein) = planter.lay(node, &course, rank, 0.0) {
        return Some((vein, course));
    }
    if !is_main {
        return None;
    }
    // Where veins crowd, out of a node beside or at another angle: a vein does not go and come again.
    let tries = || {
        let beside = |&degrees: &f64| start.beside.iter().map(move |&node| (degrees, node));
        ASIDE_DEG.iter().flat_map(beside)
    };
    let turned = |planter: &Planter<'_>, degrees: f64, node: NodeId| {
        let from = planter.graph.positions()[node as usize];
        let turn = DVec2::from_angle(degrees.to_radians());
        on_its_side(begun_at(&course, from).iter().map(|p| from + turn.rotate(*p - from)).collect())
    };
    let laid = tries().find_map(|(degrees, node)| {
        let line = turned(planter, degrees, node);
        Some((planter.lay(node, &line, rank, 0.0)?, line))
    });
    laid.or_else(|| {
        tries().find_map(|(degrees, node)| {
            let line = turned(planter, degrees, node);
            Some((planter.lay_bud(node, &line, rank)?, line))
        })
    })
}

/// How far a vein without room is turned.
const ASIDE_DEG: [f64; 7] = [0.0, 15.0, -15.0, 30.0, -30.0, 50.0, -50.0];

/// It leaves at most so many nodes off its place.
const BESIDE: usize = 3;

/// The line moved so that it begins at `from`, less and less until its end stays: it keeps its direction.
fn begun_at(line: &[DVec2], from: DVec2) -> Vec<DVec2> {
    let (shift, last) = (from - line[0], (line.len() - 1) as f64);
    let moved = |(i, p): (usize, &DVec2)| *p + shift * (1.0 - i as f64 / last);
    let mut begun: Vec<DVec2> = line.iter().enumerate().map(moved).collect();
    begun[0] = from;
    begun
}

/// A line that meets a vein at its end was to end there.
fn join(planter: &mut Planter<'_>, vein: &Vein, line: &[DVec2], rank: Rank) {
    let reached = vein.length() / curve::length(line).max(1e-300);
    let fine = !matches!(rank.kind, VeinKind::Primary | VeinKind::Secondary);
    if reached > 1.0 - REST || fine {
        planter.join_hit(vein);
    }
}

/// Lines as they were given, and what was laid of them: a line begins on one that was given, wherever that
/// had to be laid.
#[derive(Debug, Default)]
struct LaidLines {
    lines: Vec<LaidLine>,
}

#[derive(Debug)]
struct LaidLine {
    given: Vec<DVec2>,
    bounds: Rect,
    vein: Vein,
    /// All of the way of which the vein is the free part.
    course: Vec<DVec2>,
}

/// Where a line leaves another.
struct Start<'a> {
    node: NodeId,
    given: &'a [DVec2],
    /// The nodes about that, the nearest first.
    beside: Vec<NodeId>,
    parent: &'a [DVec2],
    share: f64,
}

impl Start<'_> {
    /// Whether a line as it was given leaves the other as that was given on the left.
    fn is_left(&self, line: &[DVec2]) -> bool {
        aside::is_left(curve::at(line, BY_NOW).0, self.given)
    }
}

/// On which side of the other a line leaves shows at this share of it.
const BY_NOW: f64 = 0.15;

impl LaidLines {
    fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    fn push(&mut self, given: Vec<DVec2>, vein: Vein, course: Vec<DVec2>) {
        let bounds = Rect::around(given.iter().copied());
        self.lines.push(LaidLine { given, bounds, vein, course });
    }

    /// Where a line that begins at `p` leaves, on a blade of this length; `None` where nothing was laid.
    fn start(&self, p: DVec2, length: f64) -> Option<Start<'_>> {
        let mut best: Option<(f64, &LaidLine)> = None;
        for line in &self.lines {
            let most = best.map_or(f64::INFINITY, |(d2, _)| d2);
            // One that leaves the same place is no parent.
            let beside = best.is_some() && line.given[0].distance(p) < 4.0 * length / ROUNDING;
            let outside = p.clamp(line.bounds.min, line.bounds.max).distance_squared(p);
            if outside < most && !beside {
                let Some((foot, _)) = curve::nearest(&line.given, p) else { continue };
                let d2 = foot.distance_squared(p);
                if d2 < most {
                    best = Some((d2, line));
                }
            }
        }
        let (_, line) = best?;
        let share = curve::share_at(&line.given, p);
        // Nodes stand at equal steps.
        let (whole, last) = (curve::length(&line.course), line.vein.nodes.len() - 1);
        let at = share * whole * last as f64 / line.vein.length();
        // What began beyond where the other got to begins at its end.
        let at = (at.round() as usize).min(last);
        let beside = (0..=BESIDE).flat_map(|k| [at.checked_sub(k), (k > 0).then_some(at + k)]);
        let nodes = &line.vein.nodes;
        let beside = beside.flatten().filter_map(|i| nodes.get(i).copied()).collect();
        let given = &line.given;
        Some(Start { node: nodes[at], given, beside, parent: &line.course, share })
    }
}
