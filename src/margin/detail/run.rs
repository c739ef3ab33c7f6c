//! A piece of the outline from a low place (base, valley) to a tip (apex, lobe), by arc length.

use glam::DVec2;

use super::super::{Landmark, LandmarkKind, Outline};
use crate::geometry::measured::stretch;

/// A piece of an outline that detail is set on.
///
/// Every point knows its foot: where it would be without any detail. Shrinking detail moves points
/// towards their feet.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Run {
    points: Vec<DVec2>,
    feet: Vec<DVec2>,
    /// The way from the start to each point.
    ways: Vec<f64>,
    /// Outside lies to the right of travel (1) or to the left (−1).
    pub(super) outward: f64,
}

impl Run {
    /// Points that lie on their feet.
    pub(super) fn new(points: Vec<DVec2>, outward: f64) -> Self {
        Self::displaced(points.clone(), points, outward)
    }

    pub(super) fn displaced(points: Vec<DVec2>, feet: Vec<DVec2>, outward: f64) -> Self {
        let mut way = 0.0;
        let mut ways = vec![0.0];
        ways.extend(points.windows(2).map(|w| {
            way += w[0].distance(w[1]);
            way
        }));
        Self { points, feet, ways, outward }
    }

    pub(super) fn length(&self) -> f64 {
        self.ways[self.ways.len() - 1]
    }

    pub(super) fn points(&self) -> &[DVec2] {
        &self.points
    }

    fn lerp(list: &[DVec2], (i, t): (usize, f64)) -> DVec2 {
        list[i].lerp(list[(i + 1).min(list.len() - 1)], t)
    }

    /// The point at way `s`; past the ends straight on.
    pub(super) fn at(&self, s: f64) -> DVec2 {
        let inside = s.clamp(0.0, self.length());
        let p = Self::lerp(&self.points, stretch(&self.ways, inside));
        if s == inside {
            return p;
        }
        let n = self.points.len();
        let (a, b) = if s < 0.0 { (0, 1) } else { (n - 2, n - 1) };
        p + (self.points[b] - self.points[a]).normalize_or_zero() * (s - inside)
    }

    /// The foot at way `s`.
    pub(super) fn foot(&self, s: f64) -> DVec2 {
        Self::lerp(&self.feet, stretch(&self.ways, s.clamp(0.0, self.length())))
    }

    /// The directions along the run and out of the blade at way `s`, of the chord over ±`reach`.
    pub(super) fn frame(&self, s: f64, reach: f64) -> (DVec2, DVec2) {
        let (low, high) = ((s - reach).max(0.0), (s + reach).min(self.length()));
        let along = (self.at(high) - self.at(low)).normalize_or(DVec2::Y);
        (along, -along.perp() * self.outward)
    }

    /// The points strictly between two ways, with their feet.
    pub(super) fn between(&self, from: f64, to: f64) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
        (0..self.points.len())
            .filter(move |&i| self.ways[i] > from && self.ways[i] < to)
            .map(|i| (self.points[i], self.feet[i]))
    }
}

/// Where a run lies on its outline.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    /// The vertices it goes from and to, in the order of the outline; the second may be the count
    /// of vertices, which is the base again.
    pub(super) from: usize,
    pub(super) to: usize,
    /// Whether its tip is its first vertex, so that the run goes against the outline.
    pub(super) descends: bool,
    /// On the right side of the blade.
    pub(super) right: bool,
    /// Counted from the base on its side.
    pub(super) number: u32,
    /// The lobe whose tip it ends at, in the order of the tips on the outline.
    pub(super) lobe: Option<usize>,
}

/// The runs of an anticlockwise outline, in its order: up the right side and down the left one, with
/// a turn at every lobe tip and valley.
pub(super) fn spans(outline: &Outline) -> Vec<Span> {
    let n = outline.points.len();
    // The turns between base and base: whether each is a tip.
    let mut turns = vec![(0, false)];
    for mark in &outline.landmarks {
        let tip = match mark.kind {
            LandmarkKind::LobeTip { .. } => true,
            LandmarkKind::Valley => false,
            _ => continue,
        };
        if mark.vertex != 0 && mark.vertex != outline.apex {
            turns.push((mark.vertex, tip));
        }
    }
    // A leaf of an even number of lobes has its apex in a notch.
    let notched =
        |mark: &Landmark| mark.vertex == outline.apex && mark.kind == LandmarkKind::Valley;
    turns.push((outline.apex, !outline.landmarks.iter().any(notched)));
    turns.push((n, false));
    turns.sort_by_key(|turn| turn.0);
    let is_tip = |mark: &&Landmark| matches!(mark.kind, LandmarkKind::LobeTip { .. });
    let mut tips: Vec<usize> =
        outline.landmarks.iter().filter(is_tip).map(|mark| mark.vertex).collect();
    tips.sort_unstable();
    let mut spans: Vec<Span> = Vec::new();
    for pair in turns.windows(2) {
        let [(from, low), (to, _)] = pair else { continue };
        let right = *to <= outline.apex;
        // Two tips or two valleys in a row: as the side goes.
        let descends = if pair[0].1 == pair[1].1 { !right } else { *low };
        let tip = if descends { *from } else { *to };
        let lobe = tips.iter().position(|&vertex| vertex == tip);
        spans.push(Span { from: *from, to: *to, descends, right, number: 0, lobe });
    }
    let rights = spans.iter().filter(|span| span.right).count();
    let lefts = spans.len() - rights;
    for (i, span) in spans.iter_mut().enumerate() {
        span.number = (if span.right { i } else { lefts - 1 - (i - rights) }) as u32;
    }
    spans
}

impl Span {
    /// The run on an outline.
    pub(super) fn run(&self, outline: &Outline) -> Run {
        let n = outline.points.len();
        let mut points: Vec<DVec2> = (self.from..=self.to).map(|i| outline.points[i % n]).collect();
        if self.descends {
            points.reverse();
        }
        Run::new(points, if self.descends { -1.0 } else { 1.0 })
    }
}
