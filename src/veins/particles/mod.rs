//! Veins are the trails of particles that flow to the petiole.
//!
//! Particles are scattered over the blade, each with the same energy. In every step all move by the
//! same distance along p̂ + q̂, where p̂ points to the nearest other particle and q̂ to the petiole;
//! particles that come close merge and their energies add; a trail is as wide as the energy on it
//! needs. So trails share their ways, and become a tree.
//!
//! Source: Rodkaew, Siripant, Lursinsap and Chongstitvatana, "An algorithm for generating vein images
//! for realistic modeling of a leaf", 2002, algorithms 1 and 2. Departs from it: the paper ignores
//! the margin and fails where the petiole is hidden; here q̂ follows the shortest path inside the
//! blade (`steer`) and particles that cannot see each other neither attract nor merge, unless
//! `steering` is `plain`. p̂ + q̂ is made a unit vector (a step has one length), but where it is shorter
//! than one: a particle that another follows would be thrown aside by a whole step, to and fro, and waits
//! instead. Of neighbours equally near, that nearer to the petiole attracts: a regular pattern stays as
//! symmetric as the blade. Trails that cross join (`confluence`). The width is Murray's law on the energy.
//! Growth plays no part: particles flow in the finished blade.
//!
//! Lengths are millimetres of the finished leaf.

mod confluence;
mod contacts;
pub mod patterns;
mod steer;
mod trails;

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::VeinError;
use super::graph::VeinGraph;
use crate::geometry::point_cells::PointCells;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::observer::{Observer, Progress};
use crate::parameter::{parameters, words};
use crate::seed::Rng;
use patterns::Pattern;
use steer::Steer;
use trails::{Ends, Trails};

words! {
    /// The two algorithms of Rodkaew et al. 2002.
    pub enum Motion {
        /// Algorithm 1: every particle moves to the petiole by itself.
        Direct = "direct",
        /// Algorithm 2: particles also move towards their nearest neighbour, and merge.
        Attracted = "attracted",
    }
}

words! {
    /// How particles find the petiole.
    pub enum Steering {
        /// Along the shortest path inside the margin.
        Inside = "inside",
        /// Straight, as printed: trails that leave the blade are clipped.
        Plain = "plain",
    }
}

parameters! {
    /// Particles that flow to the petiole (Rodkaew et al. 2002). Lengths are those of the finished
    /// leaf; the paper's pixel is about 1/200 of the blade.
    pub struct ParticleSpec {
        /// `direct`: each particle goes by itself; `attracted`: towards its neighbours too, merging.
        algorithm: choice(Motion, Motion::Attracted),
        /// Where particles start: `square`, `hexagonal`, `jitter` or `random`.
        pattern: choice(Pattern, Pattern::Jitter),
        /// From particle to particle at the start; the finest veins are about as far apart.
        spacing_mm: number(2.0, 0.01..=1000.0, "mm"),
        /// How many particles start; 0 to take as many as the spacing gives.
        count: count(0, 0..=50_000, "particles"),
        /// How far a particle moves in one step.
        step_mm: number(0.2, 0.001..=100.0, "mm"),
        /// Particles nearer to each other than this become one.
        merge_radius_mm: number(0.8, 0.0..=1000.0, "mm"),
        /// Energy of each particle at the start; one of energy 1 leaves a vein of `tip_radius_mm`.
        initial_energy: number(1.0, 0.000_001..=1e6, ""),
        /// `inside`: along the shortest path inside the margin; `plain`: straight at the petiole.
        steering: choice(Steering, Steering::Inside),
    }
}

/// What the particles left.
#[derive(Debug, Clone, PartialEq)]
pub struct Flowed {
    /// The trails, from the petiole outwards. Every tip is where a particle started.
    pub graph: VeinGraph,
    /// How many particles started.
    pub particles: usize,
    /// Steps until the last arrived.
    pub steps: u64,
}

/// More places than this are a slip of the keyboard, as for veins that grow.
const MAX_PLACES: usize = 10_000_000;

/// More steps than this likewise; a leaf takes a few hundred.
const MAX_STEPS: f64 = 1e6;

/// After this many times the steps of the longest way neighbours attract no more, and after twice as
/// many what is left goes straight. Leaves take less than two, but this makes every run end.
const PATIENCE: f64 = 6.0;

/// One particle on its way.
#[derive(Debug, Clone, Copy)]
struct Particle {
    /// In units of the initial energy.
    energy: u32,
    ends: Ends,
    lost: bool,
}

/// Lets particles flow to `roots`, those of them inside `margin`.
///
/// # Errors
///
/// [`VeinError`] with the key, the value and the limit.
pub fn grow(
    spec: &ParticleSpec,
    margin: &Margin,
    roots: &[DVec2],
    rng: &mut Rng,
    observer: &mut dyn Observer,
) -> Result<Flowed, VeinError> {
    let starts = patterns::starts(spec, margin, rng)?;
    flow(spec, margin, roots, &starts, observer)
}

/// The same from given starts.
fn flow(
    spec: &ParticleSpec,
    margin: &Margin,
    roots: &[DVec2],
    starts: &[DVec2],
    observer: &mut dyn Observer,
) -> Result<Flowed, VeinError> {
    let edges = SegmentIndex::of_polygon(margin.outline());
    let mut inside: Vec<DVec2> = Vec::new();
    for &root in roots {
        if edges.contains(root) && !inside.contains(&root) {
            inside.push(root);
        }
    }
    if inside.is_empty() {
        return Err(VeinError::setting("root", 0.0, "no root lies inside the blade"));
    }
    let steer = match spec.steering {
        Steering::Inside => Steer::inside(margin, &inside),
        Steering::Plain => Steer::plain(margin, &inside),
    };
    let mut state = State::new(spec, steer, &inside, starts);
    let patience = (PATIENCE * state.steer.longest() / spec.step_mm).ceil() + 100.0;
    if patience > MAX_STEPS {
        let least = PATIENCE * state.steer.longest() / MAX_STEPS;
        let problem = format!(
            "could take {patience:.0} steps to the petiole; it must be at least {least:.4}"
        );
        return Err(VeinError::setting("veins.particles.step_mm", spec.step_mm, problem));
    }
    let particles = starts.len();
    let mut steps = 0;
    while !state.is_done() {
        let attracted = spec.algorithm == Motion::Attracted && steps < patience as u64;
        state.step(attracted);
        if steps == 2 * patience as u64 {
            state.particles.iter_mut().for_each(|particle| particle.lost = true);
        }
        steps += 1;
        if state.trails.len() > MAX_PLACES {
            let problem = format!(
                "leaves more than {MAX_PLACES} places on the trails; raise it, or scatter fewer particles"
            );
            return Err(VeinError::setting("veins.particles.step_mm", spec.step_mm, problem));
        }
        if steps % 16 == 0 || state.is_done() {
            observer.report(Progress {
                stage: "particles",
                step: steps,
                steps: 0,
                nodes: state.trails.len(),
                sources: state.positions.len(),
            });
        }
    }
    let State { trails, steer, .. } = state;
    let graph = trails.into_graph(&edges, |a, b| steer.sees(a, b));
    Ok(Flowed { graph, particles, steps })
}

/// All particles on their way, in the order in which they started. Of two that merge the first
/// stays.
struct State {
    positions: Vec<DVec2>,
    particles: Vec<Particle>,
    trails: Trails,
    steer: Steer,
    cells: PointCells,
    step: f64,
    radius: f64,
}

impl State {
    fn new(spec: &ParticleSpec, steer: Steer, roots: &[DVec2], starts: &[DVec2]) -> Self {
        let mut state = Self {
            positions: Vec::new(),
            particles: Vec::new(),
            trails: Trails::new(roots, spec.step_mm),
            steer,
            cells: PointCells::default(),
            step: spec.step_mm,
            radius: spec.merge_radius_mm,
        };
        for &p in starts {
            if let Some(ends) = state.trails.begin(p) {
                state.positions.push(p);
                state.particles.push(Particle { energy: 1, ends, lost: false });
            }
        }
        state.arrive();
        state
    }

    fn is_done(&self) -> bool {
        self.particles.is_empty()
    }

    fn step(&mut self, attracted: bool) {
        // Move all at once, towards where the others were.
        let before = self.positions.clone();
        if attracted {
            self.cells.rebuild(&before, self.radius);
        }
        for (i, particle) in self.particles.iter_mut().enumerate() {
            let p = before[i];
            let off = |j: u32| self.steer.off_root2(before[j as usize]);
            let neighbour =
                if attracted { self.cells.nearest_other(p, i as u32, off) } else { None };
            let neighbour = neighbour
                .map(|j| before[j as usize])
                .filter(|&other| particle.lost || self.steer.sees(p, other));
            self.positions[i] = self.steer.step(p, neighbour, self.step, &mut particle.lost);
        }
        // Merge what came close, lay the trails, and let go what is there.
        if attracted {
            self.merge();
        }
        self.arrive();
        for (particle, &p) in self.particles.iter_mut().zip(&self.positions) {
            self.trails.lay(&mut particle.ends, p);
        }
    }

    /// Merges particles closer than the radius, the nearest pair first, until none are.
    fn merge(&mut self) {
        let n = self.positions.len();
        self.cells.rebuild(&self.positions, self.radius);
        let mut pairs = BinaryHeap::new();
        for i in 0..n as u32 {
            self.offer_pairs(i, 0.0, |j| j > i, &mut pairs);
        }
        if pairs.is_empty() {
            return;
        }
        let mut merges = vec![0u32; n];
        let mut gone = vec![false; n];
        // How far merged particles are from where the cells have them.
        let (mut drift, filed) = (0.0f64, self.positions.clone());
        while let Some(Reverse(Pair { a, b, after, .. })) = pairs.pop() {
            let (i, j) = (a as usize, b as usize);
            if gone[i] || gone[j] || merges[i] + merges[j] != after {
                continue;
            }
            let (one, other) = (self.particles[i], self.particles[j]);
            let (e, f) = (f64::from(one.energy), f64::from(other.energy));
            self.positions[i] = (self.positions[i] * e + self.positions[j] * f) / (e + f);
            self.particles[i] = Particle {
                energy: one.energy + other.energy,
                ends: self.trails.meet(one.ends, other.ends),
                lost: one.lost && other.lost,
            };
            gone[j] = true;
            merges[i] += 1;
            drift = drift.max(self.positions[i].distance(filed[i]));
            let mut found = Vec::new();
            self.offer_pairs(a, drift, |k| k != a && !gone[k as usize], &mut found);
            pairs.extend(found.into_iter().map(|Reverse(pair)| {
                let after = merges[pair.a as usize] + merges[pair.b as usize];
                Reverse(Pair { after, ..pair })
            }));
        }
        self.keep(|i| !gone[i]);
    }

    /// The pairs that one particle makes with others in sight and closer than the radius.
    fn offer_pairs(
        &self,
        i: u32,
        drift: f64,
        wanted: impl Fn(u32) -> bool,
        pairs: &mut impl Extend<Reverse<Pair>>,
    ) {
        let p = self.positions[i as usize];
        self.cells.for_each_near(p, self.radius + drift, |j| {
            let q = self.positions[j as usize];
            let distance2 = p.distance_squared(q);
            let close = distance2 < self.radius * self.radius && wanted(j);
            if close && self.steer.sees(p, q) {
                let (a, b) = (i.min(j), i.max(j));
                pairs.extend([Reverse(Pair { distance2: distance2.to_bits(), a, b, after: 0 })]);
            }
        });
    }

    /// Ends the trails of the particles that are there.
    fn arrive(&mut self) {
        // A longer step than the radius would pass the petiole by for ever.
        let reach = self.radius.max(self.step);
        let there: Vec<Option<usize>> = (self.positions.iter().zip(&self.particles))
            .map(|(&p, particle)| self.steer.arrived(p, reach, particle.lost))
            .collect();
        for (particle, root) in self.particles.iter().zip(&there) {
            if let Some(root) = *root {
                self.trails.arrive(particle.ends, root);
            }
        }
        self.keep(|i| there[i].is_none());
    }

    fn keep(&mut self, wanted: impl Fn(usize) -> bool) {
        let mut at = 0..self.positions.len();
        self.positions.retain(|_| at.next().is_some_and(&wanted));
        let mut at = 0..self.particles.len();
        self.particles.retain(|_| at.next().is_some_and(&wanted));
    }
}

/// Two particles that are close; nearest first, then by id.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    /// The bits of the squared distance: they order like numbers at or above zero.
    distance2: u64,
    a: u32,
    b: u32,
    /// How often the two had merged when this was measured.
    after: u32,
}

#[cfg(test)]
mod tests;
