//! Cuts teeth out of an edge of the blade.
//!
//! A tooth is drawn in a frame that follows the edge: its sinuses below the edge, its tip above, a
//! flank on either side, bowed and bent. Smaller teeth are cut out of the flanks in the same way.

use glam::DVec2;

use super::super::LandmarkKind;
use super::node::Node;
use super::ornament::{add_bristle, add_gland};
use super::place::{Tooth, ToothForm};
use super::run::Run;

/// Parts without teeth shrink in pieces of this share of an edge.
const PIECES: f64 = 24.0;

/// The frame of a tooth follows the edge over this share of the width of the row's teeth.
const FRAME: f64 = 0.15;

/// A full bow stands out of a flank by this share of its length, a full flexure by this.
const BOW: f64 = 0.22;
const FLEXURE: f64 = 0.8;

/// Teeth of a depth of one in this bow fully, shallower ones less.
const BOWED_FROM: f64 = 12.0;

/// Teeth on the flank towards the tip lean this much as the others do.
const UPPER_LEAN: f64 = -0.4;

/// A bristle is at most this long, a gland's radius at most this large, in widths of the tooth.
const MOST_BRISTLE: f64 = 1.0;
const MOST_GLAND: f64 = 0.25;

/// What is particular to the teeth of one order on one edge or flank.
#[derive(Debug, Clone, Copy)]
struct Rank {
    order: u8,
    /// How far tips stand from the middle, along the run (widths).
    lean: f64,
    /// The part of the outline they shrink with; each its own on an edge.
    part: Option<f64>,
}

pub(super) struct Cutter<'a> {
    pub(super) form: &'a ToothForm,
    /// How far the polygon may stray from the curves (mm).
    pub(super) tolerance: f64,
    /// Parts counted so far.
    pub(super) parts: usize,
}

impl Cutter<'_> {
    /// The edge with its teeth, from its first to its last point, corners rounded.
    pub(super) fn edge(&mut self, run: &Run, teeth: &[Tooth]) -> Vec<Node> {
        let nodes = self.cut(run, teeth, Rank { order: 1, lean: self.form.lean, part: None });
        self.rounded(&nodes)
    }

    /// One order of teeth.
    fn cut(&mut self, run: &Run, teeth: &[Tooth], rank: Rank) -> Vec<Node> {
        let part = rank.part;
        let length = run.length();
        let least = 1e-9 * length;
        let teeth: Vec<&Tooth> =
            teeth.iter().filter(|t| (t.to - t.from) * length > least).collect();
        let mut nodes = Vec::new();
        let mut at = 0.0;
        // The plain part below the first tooth, then every tooth with the sinus below it.
        let row = Row::of(&teeth, length);
        for (i, tooth) in teeth.iter().enumerate() {
            let (from, to) = (tooth.from * length, tooth.to * length);
            let joined = [i > 0 && from - at <= least, {
                let next = teeth.get(i + 1);
                next.is_some_and(|next| next.from * length - to <= least)
            }];
            if !joined[0] {
                self.plain(&mut nodes, run, at, from, part);
            }
            let high = tooth.depth * (to - from);
            let ends = [(from, joined[0]), (to, joined[1])];
            let sinks = ends.map(|(way, joined)| if joined { row.sink(way) } else { 0.0 });
            // Over its sinuses; at the end of a row as if there were another tooth.
            let feet = [0, 1].map(|k| if joined[k] { sinks[k] } else { -0.5 * high });
            let tip = 0.5 * (feet[0] + feet[1]) + high;
            let own = part.unwrap_or(self.parts as f64);
            if part.is_none() {
                self.parts += 1;
            }
            let frame = Frame { run, from, width: to - from, reach: FRAME * row.width };
            let rank = Rank { part: Some(own), ..rank };
            self.tooth(&mut nodes, &frame, tooth, [sinks[0], tip, sinks[1]], rank);
            at = to;
        }
        self.plain(&mut nodes, run, at, length, part);
        nodes
    }

    /// The edge as it is between two ways, both included.
    fn plain(&mut self, nodes: &mut Vec<Node>, run: &Run, from: f64, to: f64, part: Option<f64>) {
        let piece = run.length() / PIECES;
        let first = self.parts as f64;
        let mut push = |s: f64, at: DVec2, foot: DVec2| {
            let part = part.unwrap_or(first + (s - from) / piece);
            // The sinus of the tooth before stands at the same place.
            if nodes.last().is_none_or(|last: &Node| last.at.distance_squared(at) > 1e-18) {
                nodes.push(Node::plain(at, foot, part));
            }
        };
        push(from, run.at(from), run.foot(from));
        let mut s = from;
        let mut last = run.at(from);
        for (at, foot) in run.between(from, to) {
            s += last.distance(at);
            last = at;
            push(s, at, foot);
        }
        push(to, run.at(to), run.foot(to));
        if part.is_none() {
            self.parts += ((to - from) / piece).ceil() as usize + 2;
        }
    }

    /// One tooth: the sinus below it is there already (or the plain edge), its tip, and the sinus
    /// above it.
    fn tooth(
        &mut self,
        nodes: &mut Vec<Node>,
        frame: &Frame<'_>,
        tooth: &Tooth,
        [below, high, above]: [f64; 3],
        rank: Rank,
    ) {
        let (width, order) = (frame.width, rank.order);
        let part = rank.part.unwrap_or(0.0);
        let tip_at = 0.5 + rank.lean;
        let corners =
            [DVec2::new(0.0, below), DVec2::new(tip_at * width, high), DVec2::new(width, above)];
        let tip_foot = tip_at.clamp(0.15, 0.85);
        let stations = [0.0, tip_foot, 1.0];
        let mut flanks: [Vec<Node>; 2] = [0, 1].map(|k| {
            // A flank that hardly rises hardly bows: where teeth fade, nothing is left of them.
            let rise = (BOWED_FROM * tooth.depth).min(1.0);
            let line = self.flank(k, (corners[k], corners[k + 1]), rise, frame.sag());
            let last = line.len() - 1;
            let foot = |i: usize| {
                let share = stations[k] + (stations[k + 1] - stations[k]) * i as f64 / last as f64;
                frame.run.foot(frame.from + share * width)
            };
            let points: Vec<DVec2> = line.iter().map(|&p| frame.place(p)).collect();
            let feet: Vec<DVec2> = (0..points.len()).map(foot).collect();
            let mut nodes = if tooth.flanks[k].is_empty() {
                points.iter().zip(&feet).map(|(&p, &f)| Node::plain(p, f, part)).collect()
            } else {
                let flank = Run::displaced(points, feet, frame.run.outward);
                // On the upper flank, forward is back towards the tip of the larger tooth.
                let lean = if k == 0 { rank.lean } else { UPPER_LEAN * rank.lean };
                self.cut(&flank, &tooth.flanks[k], Rank { order: order + 1, lean, ..rank })
            };
            if order > 1 {
                // Straight beneath, or evenly on the way where still smaller teeth stand on the flank.
                let last = nodes.len() - 1;
                let even = |i: usize| {
                    let share = i as f64 / last as f64;
                    (stations[k] + (stations[k + 1] - stations[k]) * share) * width
                };
                let direct = nodes.len() == line.len();
                for (i, node) in nodes.iter_mut().enumerate() {
                    let along = if direct { line[i].x.clamp(0.0, width) } else { even(i) };
                    node.bare = frame.run.at(frame.from + along);
                }
            }
            nodes
        });
        let lengths = [0, 1].map(|k| corners[k].distance(corners[k + 1]));
        let half = 0.5 * lengths[0].min(lengths[1]);
        let [lower, upper] = &mut flanks;
        let (last, tip) = (lower.len() - 1, upper[0].at);
        lower[last].mark = Some(LandmarkKind::Tooth { order });
        lower[last].round = self.form.tip_rounding * half;
        let end = upper.len() - 1;
        upper[end].mark = Some(LandmarkKind::Sinus { order });
        upper[end].round = self.form.sinus_rounding * half;
        upper.remove(0);
        let (bristle, gland) = (self.form.bristle_mm, 0.5 * self.form.gland_mm);
        // Small teeth carry small ornaments: a tooth that fades, or comes up in a morph, has none yet.
        let fade = (tooth.depth * 10.0).min(1.0);
        let (bristle, gland) = (bristle.min(MOST_BRISTLE * width), gland.min(MOST_GLAND * width));
        if order == 1 && bristle > 0.0 && fade > 0.0 {
            add_bristle(lower, upper, tip, bristle * fade);
        } else if order == 1 && gland > 0.0 && fade > 0.0 {
            add_gland(lower, upper, gland * fade, frame.run.outward);
        }
        // The first point of the lower flank is there already.
        let there = nodes.last().is_some_and(|last| last.at.distance_squared(lower[0].at) < 1e-12);
        nodes.extend_from_slice(&lower[usize::from(there)..]);
        nodes.extend_from_slice(upper);
    }

    /// A flank in the frame of its tooth (mm along the edge, mm out), ends included, with a share
    /// of its bow; the edge bends by `sag` beneath it.
    fn flank(&self, k: usize, (from, to): (DVec2, DVec2), share: f64, sag: f64) -> Vec<DVec2> {
        let along = to - from;
        let out = along.perp();
        let bow = share * self.form.bow[k] * 4.0 * BOW;
        let flexure = share * self.form.flexure[k] * FLEXURE;
        // Concave at the sinus and convex at the tip is flexuous, on both flanks.
        let flexure = if k == 0 { -flexure } else { flexure };
        let bulge = along.length() * (bow.abs() + 3.0 * flexure.abs() + 0.05) + 2.0 * sag;
        let pieces = (bulge / (2.0 * self.tolerance)).sqrt().ceil().clamp(2.0, 48.0) as usize;
        (0..=pieces)
            .map(|i| {
                let t = i as f64 / pieces as f64;
                let s = t * (1.0 - t);
                from + along * t + out * (s * (bow + flexure * (1.0 - 2.0 * t)))
            })
            .collect()
    }

    /// Corners drawn round, each from half-way to its neighbours at most.
    fn rounded(&self, nodes: &[Node]) -> Vec<Node> {
        let mut way = 0.0;
        let ways: Vec<f64> = (0..nodes.len())
            .map(|i| {
                way += if i > 0 { nodes[i].at.distance(nodes[i - 1].at) } else { 0.0 };
                way
            })
            .collect();
        let corners: Vec<usize> = (0..nodes.len()).filter(|&i| nodes[i].mark.is_some()).collect();
        let mut made = Vec::with_capacity(nodes.len());
        let mut next = 0;
        for (k, &i) in corners.iter().enumerate() {
            let before = if k > 0 { 0.5 * (ways[i] - ways[corners[k - 1]]) } else { ways[i] };
            let after = corners.get(k + 1).map_or(way - ways[i], |&j| 0.5 * (ways[j] - ways[i]));
            let reach = nodes[i].round.min(before).min(after);
            if reach <= 2.0 * self.tolerance {
                continue;
            }
            let (low, high) = (ways[i] - reach, ways[i] + reach);
            let at = |s: f64| {
                let j = ways.partition_point(|&w| w <= s).clamp(1, nodes.len() - 1) - 1;
                let long = ways[j + 1] - ways[j];
                let t = if long > 0.0 { ((s - ways[j]) / long).clamp(0.0, 1.0) } else { 0.0 };
                Node::between(&nodes[j], &nodes[j + 1], t)
            };
            let (a, b, c) = (at(low), nodes[i], at(high));
            while next < nodes.len() && ways[next] < low {
                made.push(nodes[next]);
                next += 1;
            }
            let bulge = (a.at - 2.0 * b.at + c.at).length();
            let half = (bulge / (4.0 * self.tolerance)).sqrt().ceil().clamp(2.0, 32.0) as usize / 2;
            let curve = |a: DVec2, b: DVec2, c: DVec2, t: f64| a.lerp(b, t).lerp(b.lerp(c, t), t);
            for j in 0..=2 * half {
                let t = j as f64 / (2 * half) as f64;
                let mut node = Node::plain(
                    curve(a.at, b.at, c.at, t),
                    curve(a.foot, b.foot, c.foot, t),
                    if j <= half { b.part } else { c.part },
                );
                node.bare = curve(a.bare, b.bare, c.bare, t);
                node.mark = b.mark.filter(|_| j == half);
                made.push(node);
            }
            while next < nodes.len() && ways[next] <= high {
                next += 1;
            }
        }
        made.extend_from_slice(&nodes[next..]);
        made
    }
}

/// A row of teeth, from which the depth of its sinuses comes: teeth so small that they are hardly
/// there (in a morph, before they come up) leave the sinuses of the others as they were.
struct Row {
    /// Beginning, end and half height of every tooth (mm).
    teeth: Vec<(f64, f64, f64)>,
    /// The mean width of a place on the row (mm).
    width: f64,
}

impl Row {
    fn of(teeth: &[&Tooth], length: f64) -> Self {
        let teeth: Vec<(f64, f64, f64)> = teeth
            .iter()
            .map(|tooth| {
                let (from, to) = (tooth.from * length, tooth.to * length);
                (from, to, 0.5 * tooth.depth * (to - from))
            })
            .collect();
        let widths = || teeth.iter().map(|(from, to, _)| to - from);
        let total: f64 = widths().sum();
        let width = if total > 0.0 { widths().map(|w| w * w).sum::<f64>() / total } else { 0.0 };
        Self { teeth, width }
    }

    /// How far a sinus lies from the edge (mm out): the mean half height of what stands within half a
    /// width of it, less towards the ends of the row.
    fn sink(&self, way: f64) -> f64 {
        let reach = 0.5 * self.width;
        let (mut sum, mut covered) = (0.0, 0.0);
        for &(from, to, half) in &self.teeth {
            let overlap = (to.min(way + reach) - from.max(way - reach)).max(0.0);
            sum += half * overlap;
            covered += overlap;
        }
        let (Some(first), Some(last)) = (self.teeth.first(), self.teeth.last()) else { return 0.0 };
        let end = (way - first.0).min(last.1 - way).max(0.0);
        if covered > 0.0 { -sum / covered * (end / reach).min(1.0) } else { 0.0 }
    }
}

/// The place of a tooth on its edge.
struct Frame<'a> {
    run: &'a Run,
    from: f64,
    width: f64,
    /// Directions are those of the edge over this far on either side.
    reach: f64,
}

impl Frame<'_> {
    /// How far the edge bends away from a chord beneath the tooth (mm).
    fn sag(&self) -> f64 {
        let at = |share: f64| self.run.at(self.from + share * self.width);
        at(0.5).distance(at(0.0).midpoint(at(1.0)))
    }

    /// A point of the tooth (mm along the edge from its beginning, mm out) in leaf space.
    fn place(&self, p: DVec2) -> DVec2 {
        let s = self.from + p.x;
        let (_, out) = self.run.frame(s, self.reach);
        self.run.at(s) + out * p.y
    }
}
