//! Open and closed venation the slow, obvious way: every step from scratch, every source against every node.
//!
//! Closed venation chooses its calls and ends its sources in `reference/closing.rs`.
//!
//! The rules are written down again here, from Runions et al. (2005) and Foster's report, and share
//! with the library only the blade (what is inside, what blocks sight) and the map from random
//! numbers to darts.

use glam::DVec2;
use venation::geometry::scatter::PolygonScatter;
use venation::geometry::z_order::z_order;
use venation::growth::{self, GrowingBlade};
use venation::seed::Rng;
use venation::veins::{Algorithm, VeinSpec};

mod closing;
use closing::Tag;

/// In which frame distances are measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Frame {
    /// The mature leaf; the lengths of the model shrink.
    Mature,
    /// The leaf as it is: everything is carried along in every step.
    Literal,
}

/// Nodes, each with its parent, and how many sources are left alive.
pub(crate) struct Reference {
    pub(crate) positions: Vec<DVec2>,
    pub(crate) parents: Vec<Option<usize>>,
    pub(crate) joins: Vec<(usize, usize)>,
    pub(crate) alive: usize,
}

/// A living source.
#[derive(Clone)]
struct Source {
    place: DVec2,
    /// Once a vein has come to it, in closed venation.
    tag: Option<Tag>,
}

impl Source {
    fn new(place: DVec2) -> Self {
        Self { place, tag: None }
    }
}

struct World<'a> {
    blade: &'a GrowingBlade,
    spec: &'a VeinSpec,
    frame: Frame,
    step: u64,
    /// How the frame of the mature leaf measures at the step.
    measure: growth::Frame,
    positions: Vec<DVec2>,
    parents: Vec<Option<usize>>,
    joins: Vec<(usize, usize)>,
    /// Whether veins close loops now.
    closing: bool,
}

impl World<'_> {
    /// Where a place of the mature leaf lies in the frame.
    fn shown(&self, p: DVec2) -> DVec2 {
        match self.frame {
            Frame::Literal => self.blade.carry(p, self.blade.mature_step(), self.step),
            Frame::Mature => p,
        }
    }

    /// The place of the mature leaf that lies there in the frame.
    fn mature(&self, p: DVec2) -> DVec2 {
        match self.frame {
            Frame::Literal => self.blade.carry(p, self.step, self.blade.mature_step()),
            Frame::Mature => p,
        }
    }

    fn length(&self, mm: f64) -> f64 {
        match self.frame {
            Frame::Mature => self.measure.metric().length(mm),
            Frame::Literal => mm,
        }
    }

    /// The way from `a` to `b` as it is measured.
    fn way(&self, a: DVec2, b: DVec2) -> DVec2 {
        match self.frame {
            Frame::Mature => self.measure.metric().between(a, b),
            Frame::Literal => b - a,
        }
    }

    /// The end of a way.
    fn end(&self, from: DVec2, way: DVec2) -> DVec2 {
        match self.frame {
            Frame::Mature => self.measure.metric().beyond(from, way),
            Frame::Literal => from + way,
        }
    }

    fn distance2(&self, a: DVec2, b: DVec2) -> f64 {
        self.way(a, b).length_squared()
    }

    /// Spawn and kill distances relative to the settings.
    fn crowding(&self) -> f64 {
        let is_last = self.spec.algorithm == Algorithm::AuxinClosed && !self.closing;
        if is_last { self.spec.veinlet_scale } else { 1.0 }
    }

    fn kill(&self) -> f64 {
        let least = self.spec.node_step_mm / 2.0;
        self.length((self.spec.kill_distance_mm * self.crowding()).max(least))
    }

    fn inside(&self, p: DVec2) -> bool {
        self.blade.is_inside(self.mature(p), self.step)
    }

    fn hidden(&self, a: DVec2, b: DVec2) -> bool {
        self.blade.blocks_sight(self.mature(a), self.mature(b), self.step)
    }

    /// The nearest node, the first among equals.
    fn nearest(&self, p: DVec2) -> (f64, usize) {
        let mut best = (f64::INFINITY, usize::MAX);
        for (id, &q) in self.positions.iter().enumerate() {
            let d2 = self.distance2(p, q);
            if d2 < best.0 {
                best = (d2, id);
            }
        }
        best
    }

    /// Share of the steps made so far.
    fn age(&self) -> f64 {
        let steps = self.blade.steps();
        (self.step - steps.start()) as f64 / steps.count() as f64
    }

    /// How much farther apart sources stand than in the end.
    fn coarseness(&self) -> f64 {
        let phases = &self.spec.phases;
        let left = ((phases.settle_at - self.age()) / phases.settle_at).max(0.0);
        libm::pow(phases.coarseness, left)
    }

    /// What a dart falls too near to: at most so far (squared).
    fn room2(&self, mm: f64) -> f64 {
        let length = self.length(mm * self.crowding()) * self.coarseness();
        length * length
    }

    /// Whether there is room for a source.
    fn is_free(&self, p: DVec2, sources: &[DVec2]) -> bool {
        let far = |q: &DVec2, mm: f64| self.distance2(p, *q) >= self.room2(mm);
        sources.iter().all(|q| far(q, self.spec.source_spawn_distance_mm))
            && self.positions.iter().all(|q| far(q, self.spec.vein_spawn_distance_mm))
    }

    /// One dart or a pair; how many were thrown, and where they fall.
    fn darts(&self, scatter: &PolygonScatter, rng: &mut Rng) -> (u64, Vec<DVec2>) {
        let (u, v) = (rng.unit(), rng.unit());
        let p = scatter.point(u, v);
        if self.blade.is_warped() && self.step < self.blade.mature_step() {
            // Evenly over the leaf as it is.
            let most = self.blade.greatest_area_scale(self.step);
            if rng.unit() * most >= self.blade.area_scale(p, self.step) {
                return (1, Vec::new());
            }
        }
        if self.spec.symmetry > 0.0 {
            let (keeps, turn, out) = (rng.unit(), rng.unit(), rng.unit());
            if keeps < self.spec.symmetry {
                let angle = std::f64::consts::TAU * turn;
                let off = DVec2::new(libm::cos(angle), libm::sin(angle));
                let twin = DVec2::new(-p.x, p.y) + off * (self.spec.symmetry_jitter_mm * out);
                let apart2 = self.distance2(self.shown(p), self.shown(twin));
                let on_midrib = DVec2::new(0.0, p.y);
                let (thrown, mut places) =
                    if apart2 < self.room2(self.spec.source_spawn_distance_mm) {
                        (1, vec![on_midrib])
                    } else if self.blade.covers(twin) {
                        (2, vec![p, twin])
                    } else {
                        (1, vec![p])
                    };
                places.retain(|p| self.blade.covers(*p));
                return (thrown, places.into_iter().map(|p| self.shown(p)).collect());
            }
        }
        (1, vec![self.shown(p)])
    }

    /// How much of the settings still steers veins.
    fn share_of_steering(&self) -> f64 {
        match self.spec.phases.coarseness {
            1.0 => 1.0,
            most => libm::log(self.coarseness()) / libm::log(most),
        }
    }

    /// Where a vein goes that its callers pull along a unit vector.
    fn steered(&self, node: usize, towards: DVec2, units: &[DVec2]) -> DVec2 {
        let share = self.share_of_steering();
        let power = 12.0 * (self.spec.straightness * share);
        let mut way = towards;
        let ends = self.edges().into_iter().filter(|&(a, b)| a == node || b == node).count();
        if let Some(parent) = self.parents[node]
            && ends < 2
            && units.len() > 1
            && power > 0.0
        {
            // Those ahead count most.
            let heading = self.way(self.positions[parent], self.positions[node]).normalize();
            let mut sum = DVec2::ZERO;
            for unit in units {
                sum += *unit * libm::pow((0.5 + 0.5 * unit.dot(heading)).max(0.0), power);
            }
            way = sum.normalize_or(towards);
        }
        let pulled = (way + DVec2::Y * (self.spec.pull * share)).normalize_or_zero();
        if pulled.dot(way) > 0.5 { pulled } else { way }
    }

    /// Makes a child, if there is room; `None` when the margin is in the way.
    fn sprout(&mut self, node: usize, towards: DVec2) -> Option<()> {
        let length = self.length(self.spec.node_step_mm);
        let from = self.positions[node];
        let child = self.end(from, towards * length);
        for (id, &q) in self.positions.iter().enumerate() {
            let d2 = self.distance2(child, q);
            let sibling = self.parents[id] == Some(node) && d2 < (0.25 * length) * (0.25 * length);
            if sibling || d2 < (1e-3 * length) * (1e-3 * length) {
                return Some(());
            }
        }
        if !self.inside(child) || self.hidden(from, child) {
            return None;
        }
        if self.stops(node, child) {
            return Some(());
        }
        self.positions.push(child);
        self.parents.push(Some(node));
        Some(())
    }

    /// Throws so many darts, each with room among those that are there.
    fn throw_at_once(
        &self,
        darts: f64,
        scatter: &PolygonScatter,
        rng: &mut Rng,
        places: &mut Vec<DVec2>,
    ) {
        let mut left = darts as u64;
        while left > 0 {
            let (thrown, found) = self.darts(scatter, rng);
            left = left.saturating_sub(thrown);
            for p in found {
                if self.is_free(p, places) {
                    places.push(p);
                }
            }
        }
    }

    fn extend(&mut self, node: usize, callers: &[DVec2]) {
        let from = self.positions[node];
        let unit = |p: DVec2| {
            let towards = self.way(from, p);
            towards / towards.length_squared().sqrt()
        };
        let units: Vec<DVec2> = callers.iter().map(|&p| unit(p)).collect();
        let sum = |units: &[DVec2]| units.iter().fold(DVec2::ZERO, |sum, unit| sum + *unit);
        let mut first = 0;
        // Opposed sources: the first gets a child of its own, until the rest agree.
        while units.len() - first > 1 && sum(&units[first..]).length_squared() < 1.0 - 1e-9 {
            self.sprout(node, units[first]);
            first += 1;
        }
        let pull = sum(&units[first..]);
        if pull.length() == 0.0 {
            return;
        }
        let is_steered = self.spec.straightness > 0.0 || self.spec.pull > 0.0;
        if is_steered && self.share_of_steering() > 0.0 {
            let towards = self.steered(node, pull / pull.length(), &units[first..]);
            if self.sprout(node, towards).is_some() {
                return;
            }
        }
        let blocked = self.sprout(node, pull / pull.length()).is_none();
        if blocked && units.len() - first > 1 {
            let mut nearest = 0;
            for i in 1..callers.len() {
                let nearer =
                    self.distance2(callers[i], from) < self.distance2(callers[nearest], from);
                if nearer {
                    nearest = i;
                }
            }
            self.sprout(node, units[nearest]);
        }
    }
}

/// Grows venation from `root` over at most `most_steps` steps.
pub(crate) fn grow(
    spec: &VeinSpec,
    blade: &GrowingBlade,
    root: DVec2,
    rng: &mut Rng,
    frame: Frame,
    most_steps: usize,
) -> Reference {
    let first = *blade.steps().start();
    let mut world = World {
        blade,
        spec,
        frame,
        step: first,
        measure: blade.frame(first),
        positions: Vec::new(),
        parents: vec![None],
        joins: Vec::new(),
        closing: spec.algorithm == Algorithm::AuxinClosed,
    };
    let steps = blade.steps().count();
    let closing_steps =
        if world.closing { (spec.closing_share * steps as f64).round() as usize } else { steps };
    let root = world.shown(root);
    world.positions.push(root);
    let scatter = PolygonScatter::new(blade.mature().outline());
    let given = !spec.sources_mm.is_empty();
    let darts_fall = !given && (blade.carries_tissue() || spec.phases.coarseness > 1.0);
    let mut waiting: Vec<DVec2> =
        spec.sources_mm.iter().map(|p| DVec2::from(*p)).filter(|p| blade.covers(*p)).collect();
    if !given && !darts_fall {
        world.throw_at_once(spec.spawn_rate * closing_steps as f64, &scatter, rng, &mut waiting);
    }
    // Where tissue stands still, a dart keeps its room for ever.
    let thrown = waiting.clone();
    let mut sources: Vec<Source> = Vec::new();
    let drain = (3.0 * spec.source_spawn_distance_mm / spec.node_step_mm).ceil() as usize;
    let drain = drain.min(closing_steps / 4);
    let mut rate = spec.spawn_rate;
    let mut fraction = 0.0;
    for (made, step) in blade.steps().take(most_steps).enumerate() {
        // Grow the blade and what is carried with it.
        let before = world.step;
        world.step = step;
        world.measure = blade.frame(step);
        if frame == Frame::Literal {
            world.positions.iter_mut().for_each(|p| *p = blade.carry(*p, before, step));
            for source in &mut sources {
                source.place = blade.carry(source.place, before, step);
            }
        }
        if world.closing && made >= closing_steps {
            // From here on veins end free, closer to each other.
            world.settle(&mut sources, false);
            world.closing = false;
            // The last veins have few steps to come in.
            rate *= 4.0;
            if !given && !darts_fall {
                let mut spaced: Vec<DVec2> = thrown.clone();
                let left = rate * (steps - closing_steps) as f64;
                world.throw_at_once(left, &scatter, rng, &mut spaced);
                waiting.extend(&spaced[thrown.len()..]);
            }
        }
        // Seed sources: those the margin has passed, and this step's darts.
        let (mut born, rest): (Vec<DVec2>, Vec<DVec2>) =
            waiting.into_iter().partition(|&p| blade.is_inside(p, step));
        waiting = rest;
        // They call in an order, and are born in that of place.
        born.sort_by_key(|&p| z_order(blade.mature().bounds(), p));
        sources.extend(born.into_iter().map(|p| Source::new(world.shown(p))));
        // Before the veins that end free, those on their way meet.
        let rests = world.closing && closing_steps < steps && made + drain >= closing_steps;
        if darts_fall && !rests {
            fraction += rate * blade.greatest_area_scale(step);
            while fraction >= 1.0 {
                let (thrown, places) = world.darts(&scatter, rng);
                fraction -= thrown as f64;
                for p in places {
                    let others: Vec<DVec2> = sources.iter().map(|source| source.place).collect();
                    if world.inside(p) && world.is_free(p, &others) {
                        sources.push(Source::new(p));
                    }
                }
            }
        }
        // Call.
        let reach = match spec.attraction_distance_mm {
            0.0 => f64::INFINITY,
            mm => world.length(mm),
        };
        let mut callers: Vec<Vec<DVec2>> = vec![Vec::new(); world.positions.len()];
        for source in &mut sources {
            let p = source.place;
            if world.closing {
                for node in world.calls_of(source, reach) {
                    callers[node].push(p);
                }
                continue;
            }
            let (d2, node) = world.nearest(p);
            if d2 > 0.0 && d2 <= reach * reach && !world.hidden(p, world.positions[node]) {
                callers[node].push(p);
            }
        }
        // Extend.
        for (node, callers) in callers.iter().enumerate().filter(|(_, list)| !list.is_empty()) {
            world.extend(node, callers);
        }
        // Kill.
        if world.closing {
            world.settle(&mut sources, true);
        } else {
            let kill = world.kill();
            sources.retain(|source| world.nearest(source.place).0 > kill * kill);
        }
    }
    if world.closing {
        world.settle(&mut sources, false);
    }
    Reference {
        positions: world.positions,
        parents: world.parents,
        joins: world.joins,
        alive: sources.len(),
    }
}
