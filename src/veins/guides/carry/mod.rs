//! Guides carried along while one leaf turns into another.
//!
//! Laid anew on every blade on the way, guides would come and go: one that just finds room on this blade
//! finds none on the next. So the guides of both ends are laid once and matched: midrib to midrib, and
//! along veins that answer each other those on one side in order. On the way a vein leaves its parent at a
//! share between those of both ends, runs to a place between on the margin (or to the vein where its end
//! was joined), and keeps its form seen from its ends. A vein that only one end has lies in the same gap
//! between its neighbours all the way, and grows out of nothing or shrinks back into it.

mod laid;
mod pairs;
mod spacing;
mod strand;

use glam::DVec2;

use super::aside::{TIP, aside};
use super::curve;
use super::given::GivenSpec;
use super::{GuideSpec, PrimaryType, planted};
use crate::geometry::geodesic::Geodesics;
use crate::growth::{GrowingBlade, GrowthSpec};
use crate::margin::MarginError;
use crate::margin::morph::{MarginSide, MorphPath};
use crate::seed::{Seed, Stage};
use crate::veins::VeinSpec;
use crate::veins::graph::VeinKind;
use laid::{Group, Laid};
use pairs::Pair;
use strand::{Between, Sides, Strand};

/// The guides of two leaves and of all between them.
#[derive(Debug, Clone)]
pub struct CarriedGuides {
    veins: Vec<Vein>,
    /// In the order in which they are laid: those that both ends have go before.
    order: Vec<usize>,
    fan_spacing_mm: Option<f64>,
    /// Whether both ends have one type of primaries.
    alike: bool,
}

#[derive(Debug, Clone)]
struct Vein {
    kind: VeinKind,
    parent: Option<usize>,
    of: [Strand; 2],
    lives: Lives,
    is_main: bool,
    is_left: bool,
    /// How many main veins leave it on the side where most do.
    bears: usize,
}

/// Which ends have a vein.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lives {
    Always,
    First,
    Last,
}

/// Main veins that grow out of nothing have so many steps from the start: shorter ones are not laid, and
/// would spring up one by one.
const LEAST_STEPS: f64 = 4.0;

/// One that only one end has leaves so many of the least lengths from the next.
const APART: f64 = 0.75;

impl CarriedGuides {
    /// Lays and matches the guides of the first and the last leaf of a path. What is irregular about them
    /// is drawn from `seed`.
    ///
    /// # Errors
    ///
    /// [`MarginError`] of an end that is no margin.
    pub fn new(
        path: &MorphPath,
        ends: [(&VeinSpec, &GrowthSpec); 2],
        seed: Seed,
    ) -> Result<Self, MarginError> {
        let mut laid: Vec<Vec<Laid>> = Vec::new();
        let mut sides: Vec<Sides> = Vec::new();
        for (u, (spec, growth)) in [0.0, 1.0].into_iter().zip(ends) {
            let margin = path.at(u)?;
            sides.push(unit(path.sides(u)?, margin.length_mm()));
            // What cannot grow is told by the one who grows it.
            let blade = GrowingBlade::new(margin, growth).ok();
            let rng = &mut seed.stream(Stage::Guides);
            let veins =
                blade.and_then(|blade| planted(&spec.scaled(), &blade, rng, |p| laid::laid(&p)));
            laid.push(veins.unwrap_or_default());
        }
        let fans = ends.map(|(spec, _)| &spec.guides);
        let fans = fans.iter().filter(|guides| guides.primary == PrimaryType::Flabellate);
        let fan_spacing_mm = fans.map(|guides| guides.fork_spacing_mm).reduce(f64::min);
        let veins = veins([&laid[0], &laid[1]], [&sides[0], &sides[1]]);
        let mut order: Vec<usize> = (0..veins.len()).collect();
        order.sort_by_key(|&i| veins[i].lives != Lives::Always);
        let alike = ends[0].0.guides.primary == ends[1].0.guides.primary;
        Ok(Self { veins, order, fan_spacing_mm, alike })
    }

    /// Whether veins come and go nowhere when the ends have the guides of their own types: they have one
    /// type of primaries, and every main vein of one has its like in the other. A fan at an end is laid as
    /// one.
    #[must_use]
    pub fn fits_ends(&self) -> bool {
        let is_met = |vein: &Vein| !vein.is_main || vein.lives == Lives::Always;
        self.fan_spacing_mm.is_some() || self.alike && self.veins.iter().all(is_met)
    }

    /// Gives a leaf on the way its guides: those at `u`, as `share` of the last leaf (0 to 1).
    ///
    /// # Errors
    ///
    /// As [`MorphPath::at`].
    pub fn settle(
        &self,
        path: &MorphPath,
        u: f64,
        share: f64,
        spec: &mut VeinSpec,
    ) -> Result<(), MarginError> {
        let sides = path.sides(u)?;
        let margin = path.at(u)?;
        let length = margin.length_mm();
        let least = LEAST_STEPS * spec.node_step_mm * spec.scale / length;
        let outline: Vec<DVec2> = margin.outline().iter().map(|p| *p / length).collect();
        let inside = Geodesics::of(&outline);
        spec.guides.given = self.at(&unit(sides, length), &inside, share, least);
        if let Some(spacing) = self.fan_spacing_mm {
            let GuideSpec { primary, fork_spacing_mm, .. } = &mut spec.guides;
            (*primary, *fork_spacing_mm) = (PrimaryType::Flabellate, spacing);
        }
        Ok(())
    }

    fn at(&self, sides: &Sides, inside: &Geodesics, share: f64, least: f64) -> GivenSpec {
        let (done, from) = (vec![Progress::Open; self.veins.len()], vec![None; self.veins.len()]);
        let mut lines = Lines { guides: self, sides, inside, share, least, done, from };
        let mut given = GivenSpec::default();
        for &i in &self.order {
            let line = lines.line(i);
            if line.len() > 1 && curve::length(&line) > 0.0 {
                given.push(self.veins[i].kind, &line);
            }
        }
        given
    }
}

/// Sides of a blade of this length as if its length were 1.
fn unit(sides: [MarginSide; 2], length: f64) -> Sides {
    sides.map(|side| side.scaled(1.0 / length))
}

fn veins(laid: [&[Laid]; 2], sides: [&Sides; 2]) -> Vec<Vein> {
    if laid.iter().any(|leaf| leaf.is_empty()) {
        return Vec::new();
    }
    let strands = [0, 1].map(|k| -> Vec<Strand> {
        laid[k].iter().map(|vein| Strand::of(vein, sides[k])).collect()
    });
    let measures = strands
        .each_ref()
        .map(|all| -> Vec<f64> { all.iter().map(|strand| strand.measure).collect() });
    let pairs = pairs::pairs(laid[0], laid[1], [&measures[0], &measures[1]]);
    // By leaf and number there, the pair.
    let mut places = [vec![0; laid[0].len()], vec![0; laid[1].len()]];
    for (p, pair) in pairs.iter().enumerate() {
        for (row, i) in places.iter_mut().zip(pair.of) {
            if let Some(i) = i {
                row[i] = p;
            }
        }
    }
    let joined = |k: usize, i: usize| laid[k][i].joined.map(|(to, share)| (places[k][to], share));
    let own = |k: usize, i: usize| Strand { joined: joined(k, i), ..strands[k][i].clone() };
    let mut veins: Vec<Vein> = pairs
        .iter()
        .map(|pair| {
            let of = match pair.of {
                [Some(i), Some(j)] => [own(0, i), own(1, j)],
                [Some(i), None] => [own(0, i), moved(&own(0, i), pair, 0)],
                [None, Some(j)] => [moved(&own(1, j), pair, 1), own(1, j)],
                [None, None] => unreachable!("a pair has a vein"),
            };
            let ranks = [0, 1].map(|k| pair.of[k].map(|i| laid[k][i].rank));
            // Between a primary and a secondary it is a secondary.
            let rank = ranks.into_iter().flatten().max_by_key(|rank| rank.order);
            let any = |is: fn(Group) -> bool| {
                (0..2).any(|k| pair.of[k].is_some_and(|i| is(laid[k][i].group)))
            };
            Vein {
                kind: rank.map_or(VeinKind::Minor, |rank| rank.kind),
                parent: pair.parent,
                of,
                lives: match pair.of {
                    [Some(_), Some(_)] => Lives::Always,
                    [Some(_), None] => Lives::First,
                    _ => Lives::Last,
                },
                is_main: any(Group::is_main),
                is_left: any(Group::is_left),
                bears: 0,
            }
        })
        .collect();
    let mut borne = vec![[0; 2]; veins.len()];
    for vein in veins.iter().filter(|vein| vein.is_main) {
        if let Some(parent) = vein.parent {
            borne[parent][usize::from(vein.is_left)] += 1;
        }
    }
    for (vein, [right, left]) in veins.iter_mut().zip(borne) {
        vein.bears = right.max(left);
    }
    veins
}

/// A strand of leaf `k` as the other leaf would have it: in the answering gap between its neighbours.
fn moved(strand: &Strand, pair: &Pair, k: usize) -> Strand {
    let answer = |at: f64, gaps: [[f64; 2]; 2]| {
        let [[low, high], other] = [gaps[k], gaps[1 - k]];
        // Measures of the inner side of a lobe fall where shares rise.
        let wide = high - low;
        let part = if wide == 0.0 { 0.5 } else { ((at - low) / wide).clamp(0.0, 1.0) };
        other[0] + part * (other[1] - other[0])
    };
    let from = answer(strand.from, pair.gap);
    let measure = pair.ends.map_or(strand.measure, |ends| answer(strand.measure, ends));
    Strand { from, measure, ..strand.clone() }
}

#[derive(Debug, Clone)]
enum Progress {
    Open,
    Asked,
    Done(Vec<DVec2>),
}

/// The lines of a leaf on the way, as they are asked for.
struct Lines<'a> {
    guides: &'a CarriedGuides,
    sides: &'a Sides,
    inside: &'a Geodesics,
    share: f64,
    /// Main veins are no shorter.
    least: f64,
    done: Vec<Progress>,
    /// The shares of their parents at which they leave.
    from: Vec<Option<f64>>,
}

impl Lines<'_> {
    fn line(&mut self, i: usize) -> Vec<DVec2> {
        if let Progress::Done(line) = &self.done[i] {
            return line.clone();
        }
        self.done[i] = Progress::Asked;
        let vein = &self.guides.veins[i];
        let between =
            Between { of: &vein.of, share: self.share, sides: self.sides, inside: self.inside };
        let mut share = 0.0;
        let from = match vein.parent {
            Some(parent) => {
                let line = self.line(parent);
                if line.len() < 2 {
                    return self.finish(i, Vec::new());
                }
                share = self.leaves_at(i, parent, curve::length(&line));
                curve::at(&line, share).0
            }
            None => DVec2::ZERO,
        };
        let met = [0, 1].map(|k| {
            let (to, share) = vein.of[k].joined?;
            // Two that each end on the other have no line yet: the margin says where they end.
            if matches!(self.done[to], Progress::Asked) {
                return None;
            }
            let line = self.line(to);
            (line.len() > 1).then(|| curve::at(&line, share).0)
        });
        let mut line = between.line(from, met);
        if let Some(parent) = vein.parent.filter(|_| vein.is_main) {
            line = aside(line, &self.line(parent), share, vein.is_left, 1.0);
        }
        let grown = match vein.lives {
            Lives::Always => return self.finish(i, line),
            Lives::First => 1.0 - self.share,
            Lives::Last => self.share,
        };
        let whole = curve::length(&line);
        // A bud has room for the buds on it.
        let least = self.least * (1.0 + APART * vein.bears as f64);
        let least = if vein.is_main { least.min(whole) } else { 0.0 };
        let share = (grown * whole).max(least) / whole.max(1e-300);
        self.finish(i, curve::beginning(&line, share))
    }

    /// The share of its parent, of this length, at which a vein leaves. Where gaps close on the way, those
    /// that one end has not keep some room: on one place there would be no telling them apart.
    fn leaves_at(&mut self, i: usize, parent: usize, length: f64) -> f64 {
        if let Some(share) = self.from[i] {
            return share;
        }
        let veins = &self.guides.veins;
        let mixed = |j: usize| {
            let between = Between {
                of: &veins[j].of,
                share: self.share,
                sides: self.sides,
                inside: self.inside,
            };
            between.from()
        };
        let own = mixed(i);
        if !veins[i].is_main || own > TIP {
            return own;
        }
        let is_kin = |kin: &Vein| {
            kin.parent == Some(parent) && kin.is_main && kin.is_left == veins[i].is_left
        };
        let all = veins.iter().enumerate().filter(|(_, vein)| is_kin(vein));
        let mut kin: Vec<(f64, usize)> = all.map(|(j, _)| (mixed(j), j)).collect();
        kin.retain(|(place, _)| *place <= TIP);
        kin.sort_by(|a, b| a.0.total_cmp(&b.0));
        let places: Vec<f64> = kin.iter().map(|(place, _)| *place).collect();
        let passes = |j: usize| veins[j].lives != Lives::Always;
        let gap = |n: usize| {
            let crowds = passes(kin[n].1) || n > 0 && passes(kin[n - 1].1);
            if crowds { APART * self.least / length } else { 0.0 }
        };
        let gaps: Vec<f64> = (0..kin.len()).map(gap).collect();
        for ((_, j), place) in kin.into_iter().zip(spacing::spaced(&places, &gaps, TIP)) {
            self.from[j] = Some(place);
        }
        self.from[i].unwrap_or(own)
    }

    fn finish(&mut self, i: usize, line: Vec<DVec2>) -> Vec<DVec2> {
        self.done[i] = Progress::Done(line.clone());
        line
    }
}
