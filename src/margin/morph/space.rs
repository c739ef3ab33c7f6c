//! The space in which margins are points.
//!
//! A point of the space has the numbers of section 7.2: for every lobe tip the origin, angle and length of
//! its vein, for every valley its angle and distance from between the origins beside it, for landmarks of
//! unilobed blades their places. Between two marks stands the margin itself, as offsets from the line
//! between them, at stations that all margins share: so nothing of a margin is lost, whatever it is, and
//! a flank turns with its lobe.

use std::f64::consts::{FRAC_PI_2, TAU};

use glam::DVec2;

use super::super::{Landmark, LandmarkKind, Outline, lobes};
use super::flank::Flank;
use super::marks::{self, Mark, MarkKind};

/// Margins in one space.
#[derive(Debug, Clone)]
pub(super) struct Space {
    right: Side,
    left: Side,
}

/// One side of all margins.
#[derive(Debug, Clone)]
struct Side {
    kinds: Vec<MarkKind>,
    /// Between a mark and the next, the shares of the way at which the stations stand.
    stations: Vec<Vec<f64>>,
    shapes: Vec<Shape>,
}

/// One side of one margin.
#[derive(Debug, Clone)]
struct Shape {
    marks: Vec<Placed>,
    /// By interval and station: the offset from the line between the marks, x along it.
    offsets: Vec<Vec<DVec2>>,
    /// Whether nothing of this side lies beyond the axis below the base.
    keeps_side: bool,
}

/// A mark by an angle, clockwise from +y (radians), and a distance from somewhere.
#[derive(Debug, Clone, Copy)]
struct Placed {
    from: DVec2,
    angle: f64,
    distance: f64,
}

impl Placed {
    fn new(at: DVec2, from: DVec2) -> Self {
        let off = at - from;
        let angle = libm::atan2(off.x, off.y);
        // A lobe that reaches over the axis below the base has turned farther, not the other way.
        let angle = if angle < -FRAC_PI_2 { angle + TAU } else { angle };
        Self { from, angle, distance: off.length() }
    }

    fn at(&self) -> DVec2 {
        self.from + DVec2::new(libm::sin(self.angle), libm::cos(self.angle)) * self.distance
    }
}

/// Stations closer than this, as a share of the way between two marks, are one.
const LEAST: f64 = 1e-5;

impl Space {
    /// All outlines in one space.
    pub(super) fn of(outlines: &[Outline]) -> Self {
        let flanks: Vec<[Flank; 2]> = outlines.iter().map(Flank::both).collect();
        let side = |k: usize| Side::of(&flanks.iter().map(|both| &both[k]).collect::<Vec<_>>());
        Self { right: side(0), left: side(1) }
    }

    /// The outline of a length between the margins. Of its own detail each margin gives `detail`; at 0
    /// only marks are left, and lines between them.
    pub(super) fn mixed(&self, shares: &[f64], length: f64, detail: f64) -> Outline {
        let (mut right, marks) = self.right.mixed(shares, detail);
        let (left, others) = self.left.mixed(shares, detail);
        let apex = right.len() - 1;
        right[0].x = 0.0;
        right[apex] = DVec2::Y;
        let mirrored = |p: DVec2| DVec2::new(-p.x, p.y);
        let last = left.len() - 1;
        right.extend(left[1..last].iter().rev().copied().map(mirrored));
        let others = others.into_iter().rev().map(|mark| Landmark {
            vertex: apex + last - mark.vertex,
            kind: mark.kind.mapped(mirrored),
        });
        let landmarks = marks.into_iter().chain(others).collect();
        Outline { points: right, apex, cuts: Vec::new(), landmarks }.scaled(DVec2::splat(length))
    }

    /// A side between the margins as if it were the right one, from base to apex, with a measure that
    /// answers itself in all of them: marks at equal parts of 0 to 1, stations by the way between.
    pub(super) fn side(&self, left: bool, shares: &[f64], detail: f64) -> Vec<(f64, DVec2)> {
        let side = if left { &self.left } else { &self.right };
        let count = side.stations.len() as f64;
        let stations = side.stations.iter().enumerate();
        let measures = stations
            .flat_map(|(j, stations)| stations.iter().map(move |share| (j as f64 + share) / count));
        measures.chain([1.0]).zip(side.whole(shares, detail).0).collect()
    }
}

impl Side {
    fn of(flanks: &[&Flank]) -> Self {
        let (kinds, marks) = marks::marks(flanks);
        // Stations: every vertex of every margin, by its share of the way between two marks.
        let stations: Vec<Vec<f64>> = (0..kinds.len() - 1)
            .map(|j| {
                let mut shares = vec![0.0];
                for (flank, marks) in flanks.iter().zip(&marks) {
                    let (from, to) = (marks[j].way, marks[j + 1].way);
                    let inner = flank.ways().iter().filter(|&&way| way > from && way < to);
                    shares.extend(inner.map(|way| (way - from) / (to - from)));
                }
                shares.retain(|share| *share == 0.0 || (LEAST..1.0 - LEAST).contains(share));
                shares.sort_by(f64::total_cmp);
                shares.dedup_by(|b, a| *b - *a < LEAST);
                shares
            })
            .collect();
        let shape =
            |(flank, marks): (&&Flank, &Vec<Mark>)| Shape::of(flank, &kinds, marks, &stations);
        let shapes = flanks.iter().zip(&marks).map(shape).collect();
        Self { kinds, stations, shapes }
    }

    /// The side between the margins, from base to apex, with the landmarks on it.
    fn mixed(&self, shares: &[f64], detail: f64) -> (Vec<DVec2>, Vec<Landmark>) {
        let (mut points, mut landmarks) = self.whole(shares, detail);
        if self.shapes.iter().all(|shape| shape.keeps_side) {
            cut_back(&mut points, &mut landmarks);
        }
        (points, landmarks)
    }

    /// The same with every station, whatever it crosses.
    fn whole(&self, shares: &[f64], detail: f64) -> (Vec<DVec2>, Vec<Landmark>) {
        let each = || self.shapes.iter().zip(shares);
        let mix = |j: usize| {
            let mut sum = Placed { from: DVec2::ZERO, angle: 0.0, distance: 0.0 };
            for (shape, share) in each() {
                let mark = &shape.marks[j];
                sum.from += mark.from * *share;
                sum.angle += mark.angle * share;
                sum.distance += mark.distance * share;
            }
            // Landmarks and ends are places, not directions.
            let by_angle = matches!(self.kinds[j], MarkKind::Tip | MarkKind::Valley);
            let place = if by_angle {
                sum.at()
            } else {
                each().map(|(shape, share)| shape.marks[j].at() * *share).sum()
            };
            (place, sum.from)
        };
        let placed: Vec<(DVec2, DVec2)> = (0..self.kinds.len()).map(mix).collect();
        let mut points = Vec::with_capacity(self.stations.iter().map(Vec::len).sum::<usize>() + 1);
        let mut landmarks = Vec::new();
        for (j, stations) in self.stations.iter().enumerate() {
            let kind = match self.kinds[j] {
                MarkKind::Tip => Some(LandmarkKind::LobeTip { origin: placed[j].1 }),
                MarkKind::Valley => Some(LandmarkKind::Valley),
                _ => None,
            };
            landmarks.extend(kind.map(|kind| Landmark { vertex: points.len(), kind }));
            let (from, to) = (placed[j].0, placed[j + 1].0);
            let along = (to - from).normalize_or(DVec2::Y);
            for (k, share) in stations.iter().enumerate() {
                let offset: DVec2 = each().map(|(shape, part)| shape.offsets[j][k] * *part).sum();
                points.push(from.lerp(to, *share) + along.rotate(offset * detail));
            }
        }
        points.push(placed[placed.len() - 1].0);
        (points, landmarks)
    }
}

impl Shape {
    fn of(flank: &Flank, kinds: &[MarkKind], marks: &[Mark], stations: &[Vec<f64>]) -> Self {
        let vein = |k: &usize| kinds[*k] == MarkKind::Tip;
        let placed = (0..kinds.len())
            .map(|j| {
                let from = match kinds[j] {
                    MarkKind::Tip => marks[j].origin,
                    MarkKind::Valley => {
                        let below =
                            (0..j).rev().find(vein).map_or(DVec2::ZERO, |k| marks[k].origin);
                        let above = (j..kinds.len()).find(vein).map_or(below, |k| marks[k].origin);
                        below.midpoint(above)
                    }
                    MarkKind::End | MarkKind::Landmark => DVec2::ZERO,
                };
                Placed::new(flank.at(marks[j].way), from)
            })
            .collect();
        let offsets = stations
            .iter()
            .enumerate()
            .map(|(j, stations)| {
                let (way, end) = (marks[j].way, marks[j + 1].way);
                let (from, to) = (flank.at(way), flank.at(end));
                let back = (to - from).normalize_or(DVec2::Y) * DVec2::new(1.0, -1.0);
                let offset = |share: &f64| {
                    back.rotate(flank.at(way + share * (end - way)) - from.lerp(to, *share))
                };
                stations.iter().map(offset).collect()
            })
            .collect();
        let keeps_side = flank.points().iter().all(|p| p.y >= 0.0 || p.x > -1e-9);
        Self { marks: placed, offsets, keeps_side }
    }
}

/// Cuts a side back to a slit where it would reach over the axis below the base, as
/// [`lobes`](super::super::lobes) does.
fn cut_back(points: &mut Vec<DVec2>, landmarks: &mut Vec<Landmark>) {
    let last = points.len() - 1;
    let beyond = |p: &DVec2| p.x < lobes::SLIT && p.y < 0.0;
    let Some(end) = points[1..last].iter().rposition(beyond).map(|i| i + 1) else { return };
    if !points[1..=end].iter().any(|p| p.x < 0.0) {
        return;
    }
    let (a, b) = (points[end], points[end + 1]);
    let t = if b.x > a.x { ((lobes::SLIT - a.x) / (b.x - a.x)).clamp(0.0, 1.0) } else { 1.0 };
    let exit = DVec2::new(lobes::SLIT, a.lerp(b, t).y);
    points.splice(1..=end, [exit]);
    landmarks.retain(|mark| mark.vertex == 0 || mark.vertex > end);
    landmarks.iter_mut().filter(|mark| mark.vertex > end).for_each(|mark| mark.vertex -= end - 1);
}
