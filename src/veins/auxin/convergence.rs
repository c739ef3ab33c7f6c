//! Veins of the first orders from points on the margin where auxin converges.
//!
//! The margin is a line of convergence points: at the apex and at the tips of lobes first, then wherever
//! two of them (or a point and the base) have come farther apart than they hold each other off, while
//! the blade is small. From each a strand runs to the veins that are there: the midrib and the
//! primaries of the lobes from the base, the others from the vein that they meet at the angle of the
//! species. So secondaries are regular because growth makes room for one at a time, end in the teeth,
//! and number more on a larger or longer leaf.
//!
//! Source: A. Runions, M. Tsiantis and P. Prusinkiewicz, "A common developmental program can produce
//! diverse leaf shapes", New Phytol. 216, 2017. Departs from it: the outline is given, so that strands
//! do not drag it; a strand is laid from the older vein outwards, at once when its point appears.

use std::f64::consts::TAU;

use glam::DVec2;

use super::super::VeinSpec;
use super::super::graph::{NodeId, Rank, VeinKind};
use super::nodes::Nodes;
use crate::growth::{GrowingBlade, Metric};
use crate::margin::LandmarkKind;
use crate::parameter::parameters;
use crate::seed::Rng;

parameters! {
    /// Points on the margin from which the first veins come.
    pub struct ConvergenceSpec {
        /// A point appears where two are farther apart than this along the margin of the blade at the
        /// step; 0 for none.
        spacing_mm: number(0.0, 0.0..=1000.0, "mm"),
        /// Share of the steps in which points appear; no other sources do.
        until: number(0.3, 0.01..=1.0, ""),
        /// Angle between the older vein and a strand that leaves it.
        angle_deg: number(48.0, 10.0..=90.0, "deg"),
        /// How much wider it leaves, to bend to the apex on its way.
        bend_deg: number(10.0, -40.0..=60.0, "deg"),
        /// How far a point may appear off the middle, as a share of its room.
        jitter: number(0.15, 0.0..=0.9, ""),
        /// A point moves to the tip of a tooth within this distance, in spacings.
        tooth_reach: number(0.4, 0.0..=1.0, ""),
    }
}

/// A strand that lays this many steps in one has reached the margin of a small leaf in a few.
const STEPS_AT_ONCE: f64 = 6.0;

/// How far a strand turns this way and that (radians) when nothing keeps it straight.
const WOBBLE: f64 = 0.3;

/// How much of that stays from node to node.
const PERSISTENCE: f64 = 0.93;

/// Two strands leave one side of a vein no closer than this, in spacings along the margin.
const LEAST_APART: f64 = 0.35;

/// A point that could only be reached at an angle so much wider than the species' (degrees) gets no
/// strand.
const WIDEST: f64 = 22.0;

/// Points end this far inside the margin, in steps.
const INSET_STEPS: f64 = 0.6;

/// More points than this are a spacing that was meant for something else.
const MOST: usize = 400;

pub(super) const PRIMARY: Rank = Rank { order: 1, kind: VeinKind::Primary };
const SECONDARY: Rank = Rank { order: 2, kind: VeinKind::Secondary };

/// A point and its strand.
#[derive(Debug, Clone, Copy)]
struct Point {
    /// Where it is along the outline: how many vertices on, and the share to the next.
    along: f64,
    place: DVec2,
    rank: Rank,
    /// The end of the strand, once it has left a vein.
    tip: Option<NodeId>,
    /// Where it left.
    start: NodeId,
    /// On which side of the older vein.
    side: f64,
    /// The way before it when it left.
    length: f64,
    wobble: f64,
    /// Its strand is being laid, and does not wait for the margin.
    is_under_way: bool,
    is_done: bool,
}

/// The convergence points of a leaf.
pub(super) struct Convergence<'a> {
    spec: &'a VeinSpec,
    blade: &'a GrowingBlade,
    points: Vec<Point>,
    /// Shifts that both sides share, in the order in which points appear there.
    shared: Vec<f64>,
    /// Nodes of primary strands, ascending, each with its point.
    primaries: Vec<(NodeId, usize)>,
    counts: [usize; 2],
    until: u64,
}

impl<'a> Convergence<'a> {
    /// `None` without any. `steps` are those of the whole growth.
    pub(super) fn new(
        spec: &'a VeinSpec,
        blade: &'a GrowingBlade,
        steps: u64,
        rng: &mut Rng,
    ) -> Option<Self> {
        let convergence = &spec.convergence;
        if convergence.spacing_mm == 0.0 {
            return None;
        }
        let shared = (0..MOST).map(|_| rng.between(-1.0, 1.0)).collect();
        let until = (convergence.until * steps as f64).ceil() as u64;
        let mut all = Self {
            spec,
            blade,
            points: Vec::new(),
            shared,
            primaries: Vec::new(),
            counts: [0; 2],
            until,
        };
        let margin = blade.mature();
        all.add(margin.apex_index() as f64, PRIMARY);
        for landmark in margin.landmarks() {
            let is_tip = matches!(landmark.kind, LandmarkKind::LobeTip { .. });
            if is_tip && landmark.vertex != margin.apex_index() {
                all.add(landmark.vertex as f64, PRIMARY);
            }
        }
        Some(all)
    }

    /// Whether points may still appear after this many steps.
    pub(super) fn is_open(&self, made: u64) -> bool {
        made < self.until
    }

    /// Adds the points that there is room for, and lays the strands of one step.
    pub(super) fn grow(&mut self, nodes: &mut Nodes, step: u64, metric: Metric, rng: &mut Rng) {
        for i in 0..self.points.len() {
            if !self.points[i].is_done {
                self.lay(i, nodes, step, metric, rng);
            }
        }
        if !self.points.iter().any(|point| point.is_under_way) {
            self.appear(step, metric, rng);
        }
    }

    /// A point on the outline, a little inside.
    fn add(&mut self, along: f64, rank: Rank) {
        let outline = self.blade.mature().outline();
        let (n, vertex) = (outline.len(), along as usize);
        let (a, b) = (outline[vertex % n], outline[(vertex + 1) % n]);
        let on = a.lerp(b, along - vertex as f64);
        let before = outline[(vertex + n - 1) % n];
        let at_vertex = along == vertex as f64;
        let way = if at_vertex { (b - on).normalize() + (on - before).normalize() } else { b - a };
        let inside = way.perp().normalize_or_zero();
        let inset = INSET_STEPS * self.spec.node_step_mm;
        let place = [1.0, 0.5, 0.25, 0.1]
            .map(|share| on + inside * (inset * share))
            .into_iter()
            .find(|p| self.blade.covers(*p));
        let Some(place) = place else { return };
        self.points.push(Point {
            along,
            place,
            rank,
            tip: None,
            start: 0,
            side: 0.0,
            length: 0.0,
            wobble: 0.0,
            is_under_way: false,
            is_done: false,
        });
    }

    /// Points where there is room for them.
    fn appear(&mut self, step: u64, metric: Metric, rng: &mut Rng) {
        let outline = self.blade.mature().outline();
        let n = outline.len();
        // Under marginal growth the outline of the step is the mature one made smaller.
        let share = if self.blade.carries_tissue() { 1.0 } else { self.blade.scale_at(step).x };
        let mut arcs = vec![0.0];
        for i in 0..n {
            let way = metric.between(outline[i], outline[(i + 1) % n]).length() / metric.per_mm;
            arcs.push(arcs[i] + way * share);
        }
        let arc = |along: f64| {
            let vertex = (along as usize).min(n - 1);
            arcs[vertex] + (arcs[vertex + 1] - arcs[vertex]) * (along - vertex as f64)
        };
        let along = |at: f64| {
            let vertex = arcs.partition_point(|arc| *arc <= at).clamp(1, n) - 1;
            vertex as f64 + ((at - arcs[vertex]) / (arcs[vertex + 1] - arcs[vertex])).min(1.0)
        };
        let mut ends: Vec<f64> = self.points.iter().map(|point| arc(point.along)).collect();
        ends.extend([0.0, arcs[n]]);
        ends.sort_by(f64::total_cmp);
        let apex = arc(self.blade.mature().apex_index() as f64);
        let spec = &self.spec.convergence;
        let mut places = Vec::new();
        for pair in ends.windows(2) {
            let more = ((pair[1] - pair[0]) / spec.spacing_mm) as usize;
            let room = (pair[1] - pair[0]) / (more + 1) as f64;
            places.extend((1..=more).map(|k| (pair[0] + room * k as f64, room)));
        }
        // Each side from the base up, so that both share their shifts.
        let (right, mut left): (Vec<_>, Vec<_>) = places.into_iter().partition(|p| p.0 < apex);
        left.reverse();
        let teeth: Vec<f64> = (self.blade.mature().landmarks().iter())
            .filter(|mark| matches!(mark.kind, LandmarkKind::Tooth { .. }))
            .map(|mark| mark.vertex as f64)
            .collect();
        for (side, list) in [right, left].into_iter().enumerate() {
            for (at, room) in list {
                let sign = if side == 0 { 1.0 } else { -1.0 };
                let own = rng.between(-1.0, 1.0);
                let both = self.shared[self.counts[side] % MOST];
                self.counts[side] += 1;
                let symmetry = self.spec.symmetry;
                let shift = sign * (symmetry * both + (1.0 - symmetry) * own);
                let at = at + shift * spec.jitter * room / 2.0;
                let reach = spec.tooth_reach * spec.spacing_mm;
                let tooth = teeth
                    .iter()
                    .map(|tooth| ((arc(*tooth) - at).abs(), *tooth))
                    .filter(|(off, tooth)| {
                        *off <= reach && self.points.iter().all(|point| point.along != *tooth)
                    })
                    .reduce(|best, other| if other.0 < best.0 { other } else { best });
                if self.points.len() < MOST {
                    self.add(tooth.map_or_else(|| along(at), |(_, tooth)| tooth), SECONDARY);
                }
            }
        }
    }

    /// Lays the strand of a point, a few steps on.
    fn lay(&mut self, i: usize, nodes: &mut Nodes, step: u64, metric: Metric, rng: &mut Rng) {
        let mut point = self.points[i];
        let mut tip = match point.tip {
            Some(tip) => tip,
            None => match self.leave(&point, nodes, step, metric) {
                Departure::From(node, side) => {
                    (point.start, point.side) = (node, side);
                    node
                }
                Departure::Later => return,
                Departure::Never => {
                    self.points[i].is_done = true;
                    return;
                }
            },
        };
        let step_mm = self.spec.node_step_mm;
        let way = |tip: NodeId| metric.between(nodes.position(tip), point.place);
        if point.tip.is_none() {
            point.length = way(tip).length();
        }
        point.is_under_way = true;
        let mut left = STEPS_AT_ONCE * metric.length(step_mm);
        while left > 0.0 {
            let from = nodes.position(tip);
            let way = metric.between(from, point.place);
            if from.distance(point.place) < 0.75 * step_mm {
                point.is_done = true;
                break;
            }
            let rest = (way.length() / point.length.max(1e-9)).min(1.0);
            let towards = self.turned(&mut point, way.normalize(), rest, rng);
            // Nodes are as close as they will be in the mature leaf, where nothing stretches them.
            let ahead = metric.beyond(from, towards * metric.length(step_mm)) - from;
            let child = from + ahead.normalize() * step_mm;
            match nodes.lay(tip, child, point.rank, self.blade, step, metric) {
                Some(node) => {
                    tip = node;
                    if point.rank == PRIMARY {
                        self.primaries.push((node, i));
                    }
                }
                None if !self.blade.is_inside(child, step) && self.blade.covers(child) => {
                    point.is_under_way = false;
                    break;
                }
                None => {
                    point.is_done = true;
                    break;
                }
            }
            left -= metric.between(from, child).length();
        }
        point.tip = Some(tip);
        point.is_under_way &= !point.is_done;
        self.points[i] = point;
    }

    /// The way of a strand: wider at first, and not quite straight.
    fn turned(&self, point: &mut Point, towards: DVec2, rest: f64, rng: &mut Rng) -> DVec2 {
        if point.rank == PRIMARY && towards.x == 0.0 && self.spec.straightness == 1.0 {
            return towards;
        }
        let bend = if point.rank == PRIMARY { 0.0 } else { self.spec.convergence.bend_deg };
        // Away from the apex: clockwise on the right.
        let side = if towards.x > 0.0 { -1.0 } else { 1.0 };
        let noise = rng.between(-1.0, 1.0) * (1.0 - PERSISTENCE * PERSISTENCE).sqrt();
        point.wobble = point.wobble * PERSISTENCE + noise;
        // Little is left of it at the end, where all strands run into their points.
        let wobble = point.wobble * WOBBLE * (1.0 - self.spec.straightness) * rest.sqrt();
        let angle = side * bend.to_radians() * rest + wobble.clamp(-TAU / 6.0, TAU / 6.0);
        let (sin, cos) = (libm::sin(angle), libm::cos(angle));
        DVec2::new(cos, sin).rotate(towards)
    }

    /// Where a strand leaves: for a primary the nearest root, else the place on a primary from which the
    /// point lies nearest to the line at the angle of the species.
    fn leave(&self, point: &Point, nodes: &Nodes, step: u64, metric: Metric) -> Departure {
        let is_in_sight =
            |node: NodeId| !self.blade.blocks_sight(nodes.position(node), point.place, step);
        let way = |node: NodeId| metric.between(nodes.position(node), point.place);
        let graph = nodes.graph();
        if point.rank == PRIMARY {
            let roots = (0..nodes.len() as NodeId).filter(|node| graph.parent(*node).is_none());
            let nearest =
                roots.reduce(
                    |a, b| {
                        if way(b).length_squared() < way(a).length_squared() { b } else { a }
                    },
                );
            let root = nearest.filter(|root| is_in_sight(*root));
            return root.map_or(Departure::Later, |root| Departure::From(root, 0.0));
        }
        // Along the primary, which runs to the apex of the blade or of its lobe, and out of it.
        let parts = |node: NodeId, primary: usize| {
            let Point { start, place, .. } = self.points[primary];
            let axis = metric.between(nodes.position(start), place).normalize_or(DVec2::Y);
            let way = way(node);
            (way.dot(axis), way.perp_dot(axis))
        };
        let angle = self.spec.convergence.angle_deg;
        let slope = 1.0 / libm::tan(angle.to_radians());
        let mut list: Vec<(f64, NodeId, usize)> = (self.primaries.iter())
            .map(|&(node, primary)| {
                let (along, out) = parts(node, primary);
                let cost = out * out + (along - slope * out.abs()).powi(2);
                (cost, node, primary)
            })
            .collect();
        list.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let least = LEAST_APART * metric.length(self.spec.convergence.spacing_mm);
        let is_free = |node: NodeId, out: f64| {
            self.points.iter().all(|other| {
                let has_left = other.rank == SECONDARY && other.tip.is_some();
                let is_near = || {
                    let (a, b) = (nodes.position(other.start), nodes.position(node));
                    metric.distance_squared(a, b) < least * least
                };
                !(has_left && other.side == out.signum() && is_near())
            })
        };
        let Some(&(_, node, primary)) = list.iter().find(|&&(_, node, primary)| {
            is_in_sight(node) && is_free(node, parts(node, primary).1)
        }) else {
            return if list.is_empty() { Departure::Later } else { Departure::Never };
        };
        let (along, out) = parts(node, primary);
        let leaves_at = libm::atan2(out.abs(), along).to_degrees();
        if leaves_at > angle + WIDEST {
            return Departure::Never;
        }
        Departure::From(node, out.signum())
    }
}

/// Whether a strand can leave an older vein.
#[derive(Debug, Clone, Copy)]
enum Departure {
    /// The node, and on which side of its vein: the sign of the way out of it.
    From(NodeId, f64),
    /// No vein is there, or in sight, yet.
    Later,
    /// None that is there is good for it.
    Never,
}
