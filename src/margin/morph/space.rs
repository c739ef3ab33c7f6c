//! The space in which margins are points: the same stations between the same landmarks.

use glam::DVec2;

use super::super::parametric::SideSpec;
use super::super::{Landmark, LandmarkKind, Outline};
use crate::geometry::alignment;

/// A margin as a point of the common space.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Shape {
    /// The stations, of a blade of length 1.
    points: Vec<DVec2>,
    /// Index of the apex.
    apex: usize,
    /// What stands where, and where a lobe's vein begins.
    marks: Vec<(usize, LandmarkKind, DVec2)>,
}

/// An outline of length 1, by the way along it from the base.
struct Ring {
    /// The vertices, the first repeated at the end.
    points: Vec<DVec2>,
    ways: Vec<f64>,
    apex: usize,
    turns: Vec<Turn>,
}

/// A lobe tip or a valley.
#[derive(Debug, Clone, Copy)]
struct Turn {
    vertex: usize,
    kind: LandmarkKind,
    origin: DVec2,
}

impl Turn {
    fn is_tip(&self) -> bool {
        self.kind != LandmarkKind::Valley
    }
}

impl Ring {
    fn of(outline: &Outline) -> Self {
        let length = outline.points[outline.apex].y;
        let mut points: Vec<DVec2> = outline.points.iter().map(|p| *p / length).collect();
        points.push(points[0]);
        let mut way = 0.0;
        let mut ways = vec![0.0];
        ways.extend(points.windows(2).map(|w| {
            way += w[0].distance(w[1]);
            way
        }));
        let turns = outline.landmarks.iter().filter_map(|mark| {
            let origin = match mark.kind {
                LandmarkKind::LobeTip { origin } => origin / length,
                LandmarkKind::Valley => DVec2::ZERO,
                _ => return None,
            };
            let inner = mark.vertex != 0 && mark.vertex != outline.apex;
            inner.then_some(Turn { vertex: mark.vertex, kind: mark.kind, origin })
        });
        Self { turns: turns.collect(), points, ways, apex: outline.apex }
    }

    fn round(&self) -> f64 {
        self.ways[self.ways.len() - 1]
    }

    fn at(&self, way: f64) -> DVec2 {
        let last = self.ways.len() - 1;
        let i = self.ways.partition_point(|&w| w <= way).clamp(1, last) - 1;
        let long = self.ways[i + 1] - self.ways[i];
        let t = if long > 0.0 { ((way - self.ways[i]) / long).clamp(0.0, 1.0) } else { 0.0 };
        self.points[i].lerp(self.points[i + 1], t)
    }

    /// The way to the vertex of one side nearest to `p`.
    fn way_near(&self, p: DVec2, right: bool) -> f64 {
        let last = self.points.len() - 1;
        let range = if right { 0..=self.apex } else { self.apex..=last };
        let far = |i: &usize| self.points[*i].distance_squared(p);
        self.ways[range.min_by(|i, j| far(i).total_cmp(&far(j))).unwrap_or(0)]
    }

    /// The way to where a ray meets the outline last; `None` when it does not.
    fn way_to(&self, from: DVec2, towards: DVec2) -> Option<f64> {
        let mut best: Option<(f64, f64)> = None;
        for i in 0..self.points.len() - 1 {
            let (a, b) = (self.points[i], self.points[i + 1]);
            let across = towards.perp_dot(b - a);
            if across == 0.0 {
                continue;
            }
            let (far, t) =
                ((a - from).perp_dot(b - a) / across, (a - from).perp_dot(towards) / across);
            if far > 1e-6 && (0.0..=1.0).contains(&t) && best.is_none_or(|(most, _)| far > most) {
                best = Some((far, self.ways[i] + t * (self.ways[i + 1] - self.ways[i])));
            }
        }
        best.map(|(_, way)| way)
    }
}

/// All outlines in one space. `sides` are the landmarks of unilobed ones: right and left.
pub(super) fn unified(outlines: &[Outline], sides: &[Option<[SideSpec; 2]>]) -> Vec<Shape> {
    let rings: Vec<Ring> = outlines.iter().map(Ring::of).collect();
    let lobes = |ring: &Ring| ring.turns.iter().filter(|turn| turn.is_tip()).count();
    let most = rings.iter().map(lobes).max().unwrap_or(0);
    let model = rings.iter().position(|ring| lobes(ring) == most).unwrap_or(0);
    let marks: Vec<Vec<f64>> = if most > 0 {
        rings.iter().map(|ring| lobed_marks(ring, &rings[model])).collect()
    } else {
        unilobed_marks(&rings, sides)
    };
    let model = &rings[model];
    // Stations: every vertex of every outline, by its share of the way between two landmarks.
    let intervals = marks[0].len() - 1;
    let stations: Vec<Vec<f64>> = (0..intervals)
        .map(|j| {
            let mut shares = vec![0.0];
            for (ring, marks) in rings.iter().zip(&marks) {
                let (from, to) = (marks[j], marks[j + 1]);
                let inner = ring.ways.iter().filter(|&&way| way > from && way < to);
                shares.extend(inner.map(|way| (way - from) / (to - from)));
            }
            shares.retain(|share| *share == 0.0 || (LEAST..1.0 - LEAST).contains(share));
            shares.sort_by(f64::total_cmp);
            shares.dedup_by(|b, a| *b - *a < LEAST);
            shares
        })
        .collect();
    let mut apex = 0;
    let mut turns = Vec::new();
    let mut index = 0;
    for (j, shares) in stations.iter().enumerate() {
        if j > 0 && is_apex(&rings, &marks, j) {
            apex = index;
        }
        if let Some(turn) = turn_at(model, j, most) {
            turns.push((index, turn));
        }
        index += shares.len();
    }
    rings
        .iter()
        .zip(&marks)
        .map(|(ring, marks)| {
            let inside = |(j, shares): (usize, &Vec<f64>)| -> Vec<DVec2> {
                let (from, to) = (marks[j], marks[j + 1]);
                shares.iter().map(|share| ring.at(from + share * (to - from))).collect()
            };
            let points: Vec<DVec2> = stations.iter().enumerate().flat_map(inside).collect();
            let near = |turn: &Turn| {
                // A lobe of its own here begins where it does, another one where the model's does.
                let own = ring.turns.iter().filter(|own| own.is_tip());
                let same = own.map(|own| (own.origin, ring.points[own.vertex]));
                let at = marks_position(model, turn).map(|j| ring.at(marks[j]));
                let mut same =
                    same.filter(|(_, tip)| at.is_some_and(|at| at.distance(*tip) < 1e-6));
                same.next().map_or(turn.origin, |(origin, _)| origin)
            };
            let marks = turns.iter().map(|(i, turn)| (*i, turn.kind, near(turn))).collect();
            Shape { points, apex, marks }
        })
        .collect()
}

/// Stations closer than this, as a share of the way between two landmarks, are one.
const LEAST: f64 = 1e-5;

/// The marks of a lobed space, in order: base, the model's turns with the apex among them, base.
fn order_of(model: &Ring) -> Vec<Option<Turn>> {
    let mut list: Vec<Option<Turn>> = vec![None];
    let (right, left): (Vec<Turn>, Vec<Turn>) =
        model.turns.iter().partition(|turn| turn.vertex < model.apex);
    list.extend(right.into_iter().map(Some));
    list.push(None);
    list.extend(left.into_iter().map(Some));
    list.push(None);
    list
}

fn turn_at(model: &Ring, j: usize, lobes: usize) -> Option<Turn> {
    if lobes == 0 { None } else { order_of(model)[j] }
}

fn marks_position(model: &Ring, turn: &Turn) -> Option<usize> {
    order_of(model).iter().position(|other| other.is_some_and(|o| o.vertex == turn.vertex))
}

/// Whether mark `j` is the apex: it is in every outline.
fn is_apex(rings: &[Ring], marks: &[Vec<f64>], j: usize) -> bool {
    rings.iter().zip(marks).all(|(ring, marks)| marks[j] == ring.ways[ring.apex])
}

/// Base, tail, waist, shoulder, apex and down the other side, after 7.2.1.
fn unilobed_marks(rings: &[Ring], sides: &[Option<[SideSpec; 2]>]) -> Vec<Vec<f64>> {
    let ends = |ring: &Ring| vec![0.0, ring.ways[ring.apex], ring.round()];
    let Some(sides) = sides.iter().cloned().collect::<Option<Vec<[SideSpec; 2]>>>() else {
        return rings.iter().map(ends).collect();
    };
    let mut marks: Vec<Vec<f64>> = rings.iter().map(|_| vec![0.0]).collect();
    for (s, right) in [(0, true), (1, false)] {
        let sign = if right { 1.0 } else { -1.0 };
        // From the base: the waist, and what is known of the extensions, by the way along the side.
        let total = |ring: &Ring| {
            let apex = ring.ways[ring.apex];
            if right { apex } else { ring.round() - apex }
        };
        let from_base = |ring: &Ring, x: f64, y: f64| {
            let way = ring.way_near(DVec2::new(sign * x, y), right);
            if right { way } else { ring.round() - way }
        };
        let each = || rings.iter().zip(&sides).map(|(ring, side)| (ring, &side[s]));
        let waists: Vec<f64> =
            each().map(|(ring, side)| from_base(ring, side.waist_x, side.waist_y)).collect();
        let tails = each().map(|(ring, side)| {
            (side.tail_depth > 0.0).then(|| from_base(ring, side.tail_x, -side.tail_depth))
        });
        let shoulders = each().map(|(ring, side)| {
            let y = 1.0 + side.shoulder_height;
            (side.shoulder_height > 0.0).then(|| total(ring) - from_base(ring, side.shoulder_x, y))
        });
        let upper: Vec<f64> =
            rings.iter().zip(&waists).map(|(ring, waist)| total(ring) - waist).collect();
        let tails = shared_ratio(&tails.collect::<Vec<_>>(), &waists);
        let shoulders = shared_ratio(&shoulders.collect::<Vec<_>>(), &upper);
        for (k, (ring, marks)) in rings.iter().zip(&mut marks).enumerate() {
            let mut side: Vec<f64> = Vec::new();
            side.extend(tails.as_ref().map(|tails| tails[k]));
            side.push(waists[k]);
            side.extend(shoulders.as_ref().map(|shoulders| total(ring) - shoulders[k]));
            if right {
                marks.extend(side);
                marks.push(ring.ways[ring.apex]);
            } else {
                marks.extend(side.iter().rev().map(|way| ring.round() - way));
                marks.push(ring.round());
            }
        }
    }
    marks
}

/// Equation 7.1 along the chain of leaves: where one has no extension, its landmark divides the way
/// from base to waist as that of the nearest leaf with one does. `None` when no leaf has one.
fn shared_ratio(known: &[Option<f64>], waists: &[f64]) -> Option<Vec<f64>> {
    let mut ratios: Vec<Option<f64>> =
        known.iter().zip(waists).map(|(way, waist)| way.map(|way| way / waist)).collect();
    ratios.iter().flatten().next()?;
    while ratios.iter().any(Option::is_none) {
        let before = ratios.clone();
        for k in 0..ratios.len() {
            if before[k].is_none() {
                let lower = k.checked_sub(1).and_then(|j| before[j]);
                ratios[k] = lower.or_else(|| before.get(k + 1).copied().flatten());
            }
        }
    }
    let place = |(ratio, waist): (&Option<f64>, &f64)| ratio.unwrap_or(0.5) * waist;
    Some(ratios.iter().zip(waists).map(place).collect())
}

/// A lobe answers one of the model's when their tips are seen from the base at less than this angle
/// from each other (degrees).
const SAME_LOBE_DEG: f64 = 40.0;

/// Where a margin has the model's lobe tips and valleys, after 7.2.2: its own where they answer each
/// other; else where the model's vein, cast from its origin, meets the margin, and half-way between
/// tips.
fn lobed_marks(ring: &Ring, model: &Ring) -> Vec<f64> {
    let order = order_of(model);
    let apex = ring.ways[ring.apex];
    let mut marks = vec![0.0];
    for right in [true, false] {
        let (low, high) = if right { (0.0, apex) } else { (apex, ring.round()) };
        let end = order.iter().skip(1).position(Option::is_none).map_or(order.len(), |i| i + 1);
        let turns: Vec<Turn> = if right {
            order[1..end].iter().flatten().copied().collect()
        } else {
            order[end + 1..].iter().flatten().copied().collect()
        };
        marks.extend(side_marks(ring, model, &turns, right, low, high));
        marks.push(high);
    }
    marks
}

fn side_marks(
    ring: &Ring,
    model: &Ring,
    turns: &[Turn],
    right: bool,
    low: f64,
    high: f64,
) -> Vec<f64> {
    let on_side = |turn: &&Turn| (turn.vertex < ring.apex) == right;
    let own: Vec<&Turn> = ring.turns.iter().filter(on_side).collect();
    if own.len() == turns.len() && own.iter().zip(turns).all(|(a, b)| a.is_tip() == b.is_tip()) {
        return own.iter().map(|turn| ring.ways[turn.vertex]).collect();
    }
    let tips: Vec<&Turn> = turns.iter().filter(|turn| turn.is_tip()).collect();
    let own_tips: Vec<&&Turn> = own.iter().filter(|turn| turn.is_tip()).collect();
    let angle = |p: DVec2| libm::atan2(p.x.abs(), p.y).to_degrees();
    let apart = |i: usize, j: usize| {
        let (a, b) = (ring.points[own_tips[i].vertex], model.points[tips[j].vertex]);
        (angle(a) - angle(b)).abs()
    };
    // The own tips that answer the model's, in order, with the most likeness.
    let gain = |i: usize, j: usize| (1.0 - apart(i, j) / SAME_LOBE_DEG).max(-1.0);
    let mut ways: Vec<Option<f64>> = vec![None; tips.len()];
    for (i, answer) in alignment::in_order(own_tips.len(), tips.len(), gain).iter().enumerate() {
        if let Some(j) = answer {
            ways[*j] = Some(ring.ways[own_tips[i].vertex]);
        }
    }
    // The others by their veins, kept in order between those that are known.
    let known = ways.clone();
    for (j, tip) in tips.iter().enumerate() {
        if known[j].is_some() {
            continue;
        }
        let towards = model.points[tip.vertex] - tip.origin;
        let before = ways[..j].iter().rev().find_map(|way| *way).unwrap_or(low);
        let next = (j..tips.len()).find_map(|k| known[k].map(|way| (k, way)));
        let (k, after) = next.unwrap_or((tips.len(), high));
        let cast = ring.way_to(tip.origin, towards.normalize_or_zero());
        let room = (after - before) / (k - j + 1) as f64;
        let even = before + room;
        let way = cast.filter(|way| *way > before + 0.25 * room && *way < after - 0.25 * room);
        ways[j] = Some(way.unwrap_or(even));
    }
    let ways: Vec<f64> = ways.into_iter().flatten().collect();
    // Valleys: an own one between the two tips, or the middle of the way.
    let mut next = 0;
    turns
        .iter()
        .map(|turn| {
            if turn.is_tip() {
                next += 1;
                return ways[next - 1];
            }
            let before = if next > 0 { ways[next - 1] } else { low };
            let after = ways.get(next).copied().unwrap_or(high);
            let middle = 0.5 * (before + after);
            let inside = |way: &f64| *way > before && *way < after;
            let valleys = own.iter().filter(|own| !own.is_tip()).map(|own| ring.ways[own.vertex]);
            let near = |a: &f64, b: &f64| (a - middle).abs().total_cmp(&(b - middle).abs());
            valleys.filter(inside).min_by(near).unwrap_or(middle)
        })
        .collect()
}

/// The outline of a length between shapes of one space.
pub(super) fn mixed(shapes: &[Shape], shares: &[f64], length: f64) -> Outline {
    let mix = |point: &dyn Fn(&Shape) -> DVec2| -> DVec2 {
        shapes.iter().zip(shares).map(|(shape, share)| point(shape) * *share).sum::<DVec2>()
            * length
    };
    let first = &shapes[0];
    let mut points: Vec<DVec2> =
        (0..first.points.len()).map(|i| mix(&|shape| shape.points[i])).collect();
    // Rounding must not take the two ends off the axis.
    points[0].x = 0.0;
    points[first.apex] = DVec2::new(0.0, length);
    let landmarks = (0..first.marks.len())
        .map(|j| {
            let (vertex, kind, _) = first.marks[j];
            let kind = match kind {
                LandmarkKind::LobeTip { .. } => {
                    LandmarkKind::LobeTip { origin: mix(&|shape| shape.marks[j].2) }
                }
                other => other,
            };
            Landmark { vertex, kind }
        })
        .collect();
    Outline { points, apex: first.apex, cuts: Vec::new(), landmarks }
}
