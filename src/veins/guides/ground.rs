//! The blade on which guides are laid: how far the margin is, which way it runs, where the middle is.

use std::cell::OnceCell;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec2;

use super::curve;
use crate::geometry::geodesic::Geodesics;
use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;

/// The middle of a blade is looked for on a lattice with so many cells to the length.
const CELLS: f64 = 72.0;

/// A straight midrib may lie this far off the middle of the blade, as a share of half the width, before
/// the blade counts as bent. Oblique leaves stay below, sickles do not.
const OBLIQUE: f64 = 0.3;

/// How far from the margin a guide keeps, as a share of the way from the base.
const AT_BASE: f64 = 0.1;

/// The same for primaries: a base that tapers to a stalk leaves the midrib hardly more.
const AT_NARROW_BASE: f64 = 0.01;

/// A blade.
pub(super) struct Ground<'a> {
    margin: &'a Margin,
    /// Outline and cuts.
    lines: SegmentIndex,
    segments: Vec<(DVec2, DVec2)>,
    /// The outline without its teeth, at equal steps.
    even: Vec<DVec2>,
    root: DVec2,
    inset: f64,
    /// Made when it is asked for.
    geodesics: OnceCell<Geodesics>,
}

impl<'a> Ground<'a> {
    /// `inset`: guides keep this far from the margin.
    pub(super) fn new(margin: &'a Margin, root: DVec2, inset: f64) -> Self {
        let cuts = margin.cuts().iter().flat_map(|line| line.windows(2).map(|w| (w[0], w[1])));
        let segments: Vec<_> = polygon::edges(margin.outline()).chain(cuts).collect();
        let dense = polygon::resampled(margin.outline(), margin.length_mm() / 100.0);
        let even = super::targets::evened(&dense, 3.0);
        let lines = SegmentIndex::new(segments.clone());
        Self { margin, lines, segments, even, root, inset, geodesics: OnceCell::new() }
    }

    pub(super) fn margin(&self) -> &Margin {
        self.margin
    }

    pub(super) fn root(&self) -> DVec2 {
        self.root
    }

    pub(super) fn length(&self) -> f64 {
        self.margin.length_mm()
    }

    /// Whether a guide may run from `a`, where it is, to `b`.
    pub(super) fn is_free(&self, a: DVec2, b: DVec2) -> bool {
        self.is_apart(a, b, AT_BASE)
    }

    /// The same for a vein out of the base along the middle of the blade, however narrow that is there.
    pub(super) fn is_free_at_base(&self, a: DVec2, b: DVec2) -> bool {
        self.is_apart(a, b, AT_NARROW_BASE)
    }

    /// Guides keep less of the inset at the base, where the margin begins: `share` of the way from there.
    fn is_apart(&self, a: DVec2, b: DVec2, share: f64) -> bool {
        let inset = self.inset.min(share * b.distance(self.root));
        self.is_inside(a, b)
            && self.lines.nearest(b, inset).is_none_or(|(d2, _)| d2 >= inset * inset)
    }

    /// Whether no margin and no cut lies between, however near.
    pub(super) fn is_inside(&self, a: DVec2, b: DVec2) -> bool {
        polygon::contains(self.margin.outline(), b) && !self.lines.touches(a, b)
    }

    /// The line with what lies outside, or too near to the margin, moved to where a guide may run.
    pub(super) fn inside(&self, line: &[DVec2]) -> Vec<DVec2> {
        let moved = |p: &DVec2| {
            let inset = 1.05 * self.inset.min(AT_BASE * p.distance(self.root));
            let out = !polygon::contains(self.margin.outline(), *p);
            let reach = if out { f64::MAX.sqrt() } else { inset };
            let Some((_, i)) = self.lines.nearest(*p, reach) else { return *p };
            let (a, b) = self.segments[i];
            let foot = polygon::nearest_on_segment(a, b, *p);
            // Outlines run anticlockwise; a cut has blade on both sides.
            let is_cut = i >= self.margin.outline().len();
            let inwards = if is_cut { *p - foot } else { (b - a).perp() };
            foot + inwards.normalize_or_zero() * inset
        };
        let (first, rest) = line.split_at(1);
        first.iter().copied().chain(rest.iter().map(moved)).collect()
    }

    /// How far inside the margin a point lies, `most` if that is farther; below 0 outside.
    pub(super) fn depth(&self, p: DVec2, most: f64) -> f64 {
        let distance = |reach: f64| self.lines.nearest(p, reach).map(|(d2, _)| d2.sqrt());
        if polygon::contains(self.margin.outline(), p) {
            distance(most).map_or(most, |near| near.min(most))
        } else {
            -distance(f64::MAX.sqrt()).unwrap_or(0.0)
        }
    }

    /// The point, or the nearest one that lies at least so far inside the margin here.
    pub(super) fn off_margin(&self, p: DVec2, least: f64) -> DVec2 {
        let out = !polygon::contains(self.margin.outline(), p);
        let reach = if out { f64::MAX.sqrt() } else { least };
        let Some((_, i)) = self.lines.nearest(p, reach) else { return p };
        let (a, b) = self.segments[i];
        let foot = polygon::nearest_on_segment(a, b, p);
        let away = if out { foot - p } else { p - foot };
        // Outlines run anticlockwise.
        foot + away.normalize_or((b - a).perp().normalize_or_zero()) * least
    }

    /// How far guides keep from the margin.
    pub(super) fn inset(&self) -> f64 {
        self.inset
    }

    /// The shortest way between two points inside the margin; cuts do not stop it.
    pub(super) fn shortest(&self, from: DVec2, to: DVec2) -> Option<Vec<DVec2>> {
        self.geodesics.get_or_init(|| Geodesics::of(self.margin.outline())).way(from, to)
    }

    /// How far the margin or a cut is from `p` in a direction.
    pub(super) fn cast(&self, p: DVec2, towards: DVec2) -> f64 {
        // By rounding a ray aimed at a vertex can slip between its two edges.
        let aside = || self.cast_between(p, DVec2::from_angle(1e-7).rotate(towards));
        self.cast_between(p, towards).or_else(aside).unwrap_or(0.0)
    }

    fn cast_between(&self, p: DVec2, towards: DVec2) -> Option<f64> {
        let mut nearest = f64::INFINITY;
        for &(a, b) in &self.segments {
            let edge = b - a;
            let across = towards.perp_dot(edge);
            if across == 0.0 {
                continue;
            }
            let along = (a - p).perp_dot(edge) / across;
            let share = (a - p).perp_dot(towards) / across;
            if along > 1e-9 * self.length() && (0.0..=1.0).contains(&share) {
                nearest = nearest.min(along);
            }
        }
        nearest.is_finite().then_some(nearest)
    }

    /// Distance of the margin without its teeth, and its direction towards the apex there.
    pub(super) fn rim(&self, p: DVec2) -> (f64, DVec2) {
        let n = self.even.len();
        let mut best = (f64::INFINITY, 0);
        for i in 0..n {
            let (a, b) = (self.even[i], self.even[(i + 1) % n]);
            let d2 = p.distance_squared(polygon::nearest_on_segment(a, b, p));
            if d2 < best.0 {
                best = (d2, i);
            }
        }
        let (a, b) = (self.even[best.1], self.even[(best.1 + 1) % n]);
        let ahead = (b - a).normalize_or_zero();
        // Anticlockwise from the base: up on the right side, down on the left.
        let apex = self.even_apex();
        (best.0.sqrt(), if best.1 < apex { ahead } else { -ahead })
    }

    fn even_apex(&self) -> usize {
        let tip = self.margin.apex();
        let distance = |i: &usize| self.even[*i].distance_squared(tip);
        (0..self.even.len()).min_by(|i, j| distance(i).total_cmp(&distance(j))).unwrap_or(0)
    }

    /// From the root to the apex: straight, or along the middle of a bent blade.
    pub(super) fn axis(&self) -> Vec<DVec2> {
        let tip = self.margin.apex();
        let straight: Vec<DVec2> =
            (0..=100).map(|i| self.root.lerp(tip, f64::from(i) / 100.0)).collect();
        if self.is_upright() {
            return straight;
        }
        self.route(self.root, tip).unwrap_or(straight)
    }

    /// Whether the straight line from base to apex lies near enough to the middle of the blade.
    fn is_upright(&self) -> bool {
        let tip = self.margin.apex();
        let off = |i: i32| {
            let p = self.root.lerp(tip, 0.05 + 0.9 * f64::from(i) / 30.0);
            if !polygon::contains(self.margin.outline(), p) {
                return None;
            }
            let (right, left) = (self.cast(p, DVec2::X), self.cast(p, DVec2::NEG_X));
            Some((right - left) / (right + left))
        };
        let Some(off) = (0..=30).map(off).collect::<Option<Vec<f64>>>() else { return false };
        // Over a fifth of the length, so that single lobes and teeth do not count.
        off.windows(7).all(|w| (w.iter().sum::<f64>() / 7.0).abs() < OBLIQUE)
    }

    /// The way from `from` to `to` that keeps to the middle of the blade, rounded; `None` where the
    /// lattice finds none.
    pub(super) fn route(&self, from: DVec2, to: DVec2) -> Option<Vec<DVec2>> {
        let bounds = self.margin.bounds();
        let cell = bounds.size().max_element() / CELLS;
        let size = (bounds.size() / cell).ceil().as_usizevec2() + glam::USizeVec2::ONE;
        let place =
            |i: usize| bounds.min + DVec2::new((i % size.x) as f64, (i / size.x) as f64) * cell;
        // What a step costs: dear near the margin, dearer still outside. A cut is gone round, no farther off
        // than need be.
        let rim = SegmentIndex::of_polygon(self.margin.outline());
        let cost: Vec<Option<f64>> = (0..size.x * size.y)
            .map(|i| {
                let p = place(i);
                if !polygon::contains(self.margin.outline(), p) {
                    return None;
                }
                let d = rim.nearest(p, f64::MAX.sqrt()).map_or(0.0, |(d2, _)| d2.sqrt());
                let width = d / (0.1 * self.length());
                Some(1.0 + 1.0 / (width * width + 0.01))
            })
            .collect();
        let home = |p: DVec2| {
            let seen = |i: &usize| cost[*i].is_some() && !self.lines_between(p, place(*i));
            (0..cost.len()).filter(seen).min_by(|&i, &j| {
                place(i).distance_squared(p).total_cmp(&place(j).distance_squared(p))
            })
        };
        let (start, goal) = (home(from)?, home(to)?);
        let mut best = vec![f64::INFINITY; cost.len()];
        let mut came = vec![usize::MAX; cost.len()];
        let mut open = BinaryHeap::new();
        best[start] = 0.0;
        // Non-negative floats order like their bits.
        open.push(Reverse((0u64, start)));
        while let Some(Reverse((bits, i))) = open.pop() {
            if i == goal {
                break;
            }
            if f64::from_bits(bits) > best[i] {
                continue;
            }
            let (x, y) = ((i % size.x) as isize, (i / size.x) as isize);
            for (dx, dy) in NEIGHBOURS {
                let (nx, ny) = (x + dx, y + dy);
                if nx < 0 || ny < 0 || nx >= size.x as isize || ny >= size.y as isize {
                    continue;
                }
                let j = ny as usize * size.x + nx as usize;
                let (Some(here), Some(there)) = (cost[i], cost[j]) else { continue };
                let total = best[i] + 0.5 * (here + there) * place(i).distance(place(j));
                if total < best[j] && !self.lines.touches(place(i), place(j)) {
                    best[j] = total;
                    came[j] = i;
                    open.push(Reverse((total.to_bits(), j)));
                }
            }
        }
        if !best[goal].is_finite() {
            return None;
        }
        let mut way = vec![to];
        let mut i = goal;
        while i != start {
            way.push(place(i));
            i = came[i];
        }
        way.push(from);
        way.reverse();
        Some(curve::resampled(&curve::rounded(&curve::resampled(&way, cell), 60), cell))
    }

    /// Whether the margin or a cut lies between; the ends may be on it.
    fn lines_between(&self, a: DVec2, b: DVec2) -> bool {
        self.lines.touches(a.lerp(b, 1e-3), b.lerp(a, 1e-3))
    }
}

/// Sixteen directions: with eight a way between two lobes shows corners.
const NEIGHBOURS: [(isize, isize); 16] = [
    (1, 0),
    (2, 1),
    (1, 1),
    (1, 2),
    (0, 1),
    (-1, 2),
    (-1, 1),
    (-2, 1),
    (-1, 0),
    (-2, -1),
    (-1, -1),
    (-1, -2),
    (0, -1),
    (1, -2),
    (1, -1),
    (2, -1),
];
