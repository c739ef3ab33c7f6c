//! New tissue at the margin only; the interior stays where it is.
//!
//! Source: Foster, marginal growth. At scale s the blade is the part of the mature one that the
//! scaled outline has passed by then. For an outline that is star-shaped about its base this is the
//! scaled outline itself. Otherwise (oak, curled lobes) a sinus of the young outline would sweep over
//! tissue that already stands there; tissue does not vanish, so everything passed so far counts: the
//! scaled *star hull* (all points between the base and the outline), cut by the mature outline.

use std::f64::consts::TAU;

use glam::DVec2;

use super::overlap;
use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;
use crate::margin::{Landmark, Margin, MarginError, Outline};

/// One sector of the star hull: between two angles one edge is the farthest from the base.
#[derive(Debug, Clone, Copy)]
struct Sector {
    /// Angle at which it starts (radians, in 0..2π).
    from: f64,
    /// The farthest edge there; none where the ray meets no tissue.
    edge: Option<(DVec2, DVec2)>,
}

/// The star hull of an outline about the origin.
#[derive(Debug, Clone)]
pub(super) struct Sweep {
    sectors: Vec<Sector>,
    hull: Vec<DVec2>,
    index: SegmentIndex,
    plain: bool,
}

impl Sweep {
    pub(super) fn new(outline: &[DVec2]) -> Self {
        let mut angles: Vec<f64> =
            outline.iter().filter(|p| **p != DVec2::ZERO).map(|p| angle(*p)).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        let sectors: Vec<Sector> = (0..angles.len())
            .map(|i| {
                let next = angles.get(i + 1).copied().unwrap_or(angles[0] + TAU);
                let middle = (angles[i] + next) * 0.5;
                let ray = DVec2::new(libm::cos(middle), libm::sin(middle));
                // Edges at the base run along the ray and reach no sector's middle.
                let edge = polygon::edges(outline)
                    .filter_map(|(a, b)| Some((crossing(ray, a, b)?, (a, b))))
                    .max_by(|x, y| x.0.total_cmp(&y.0))
                    .map(|(_, edge)| edge);
                Sector { from: angles[i], edge }
            })
            .collect();
        let mut hull = hull(&sectors);
        if outline[0] != DVec2::ZERO {
            // The base of a peltate blade is not on its outline; the hull closes on itself.
            hull.remove(0);
            let first = hull[0];
            while hull.last().is_some_and(|p| p.distance(first) <= 1e-9 * first.length()) {
                hull.pop();
            }
        }
        let index = SegmentIndex::of_polygon(&hull);
        let area = polygon::signed_area(outline);
        let plain = (polygon::signed_area(&hull) - area).abs() <= 1e-9 * area;
        Self { sectors, hull, index, plain }
    }

    /// Whether the hull is the outline itself.
    pub(super) fn is_plain(&self) -> bool {
        self.plain
    }

    /// The least scale at which the hull holds `p`: 0 at the base, 1 on the outline, more outside.
    pub(super) fn scale_reaching(&self, p: DVec2) -> f64 {
        if p == DVec2::ZERO {
            return 0.0;
        }
        let at = angle(p);
        let after = self.sectors.partition_point(|sector| sector.from <= at);
        let sector = &self.sectors[(after + self.sectors.len() - 1) % self.sectors.len()];
        sector.edge.and_then(|(a, b)| on_line(p, a, b)).map_or(f64::INFINITY, |reach| 1.0 / reach)
    }

    /// Whether the hull at scale `s` crosses the segment a–b.
    pub(super) fn touches(&self, a: DVec2, b: DVec2, s: f64) -> bool {
        self.index.touches(a / s, b / s)
    }

    /// The blade at scale `s`: the part of `mature` inside the scaled hull that hangs together with
    /// the base.
    pub(super) fn margin(&self, mature: &Margin, s: f64) -> Result<Margin, MarginError> {
        let hint = "use another growth.type, or growth.scale = 1";
        let mut whole = mature.to_outline();
        // Cuts do not move: what the margin has not passed yet is missing.
        whole.cuts.clear();
        if !self.plain && mature.is_peltate() {
            return Err(MarginError::Unsuited(
                "parts of a peltate blade hide from the petiole, which marginal growth cannot follow; \
                 set growth.type = \"isotropic\""
                    .into(),
            ));
        }
        let outline = if self.plain {
            whole.scaled(DVec2::splat(s))
        } else {
            let young: Vec<DVec2> = self.hull.iter().map(|p| *p * s).collect();
            // Start on the one that lies in the other: the hull where they leave the base together.
            let outline = if angle(young[1]) >= angle(mature.outline()[1]) - 1e-6 {
                overlap::common_part(&young, mature.outline())
            } else {
                overlap::common_part(mature.outline(), &young)
            };
            let (points, apex) = overlap::with_apex(&outline);
            // What the margin has reached stands where it will stay.
            let reached = |mark: &Landmark| {
                let at = whole.points[mark.vertex];
                let vertex = points.iter().position(|p| *p == at)?;
                Some(Landmark { vertex, ..*mark })
            };
            let landmarks = whole.landmarks.iter().filter_map(reached).collect();
            Outline { points, apex, cuts: Vec::new(), landmarks }
        };
        let bare = Margin::from_outline(outline, hint)?;
        if mature.cuts().is_empty() {
            return Ok(bare);
        }
        let inside = |p: DVec2| polygon::contains(bare.outline(), p);
        let cuts = mature.cuts().iter().flat_map(|line| runs_inside(line, inside)).collect();
        Margin::from_outline(Outline { cuts, ..bare.to_outline() }, hint)
    }
}

fn angle(p: DVec2) -> f64 {
    let angle = libm::atan2(p.y, p.x);
    if angle < 0.0 { angle + TAU } else { angle }
}

/// How many times `ray` reaches to the line a–b; `None` when it runs away from it or beside it.
fn on_line(ray: DVec2, a: DVec2, b: DVec2) -> Option<f64> {
    let across = ray.perp_dot(b - a);
    let reach = a.perp_dot(b - a) / across;
    (reach.is_finite() && reach > 0.0).then_some(reach)
}

/// The same for the segment.
fn crossing(ray: DVec2, a: DVec2, b: DVec2) -> Option<f64> {
    ((ray.perp_dot(a) > 0.0) != (ray.perp_dot(b) > 0.0)).then(|| on_line(ray, a, b)).flatten()
}

/// By how much (radians) the hull stays back where it jumps: its side would pass exactly through the
/// vertex that it jumps at, and touching is not crossing. Far above rounding, far below
/// [`Margin::MIN_EDGE_MM`] in any leaf.
const BACK: f64 = 1e-8;

/// The outline of the star hull, anticlockwise from the base.
fn hull(sectors: &[Sector]) -> Vec<DVec2> {
    let n = sectors.len();
    // Begin behind the sector without tissue below the base.
    let empty = sectors.iter().position(|sector| sector.edge.is_none()).unwrap_or(0);
    let mut hull: Vec<DVec2> = vec![DVec2::ZERO];
    let reach = |sector: &Sector, angle: f64| {
        let (a, b) = sector.edge?;
        let ray = DVec2::new(libm::cos(angle), libm::sin(angle));
        on_line(ray, a, b).map(|reach| (ray, reach))
    };
    for k in 1..=n {
        let i = (empty + k) % n;
        let (sector, after, before) =
            (&sectors[i], &sectors[(i + 1) % n], &sectors[(i + n - 1) % n]);
        let jumps = |at: f64, other: &Sector| {
            let (own, other) = (reach(sector, at), reach(other, at));
            own.is_some_and(|own| other.is_some_and(|other| own.1 > other.1 * (1.0 + 1e-9)))
        };
        let from = sector.from + if jumps(sector.from, before) { BACK } else { 0.0 };
        let to = after.from - if jumps(after.from, after) { BACK } else { 0.0 };
        for angle in [from, to] {
            let Some((ray, reach)) = reach(sector, angle) else { continue };
            let p = ray * reach;
            // Sectors that meet repeat their common point, up to rounding.
            if hull.last().is_none_or(|last| last.distance(p) > 1e-9 * reach) {
                hull.push(p);
            }
        }
    }
    hull
}

/// The stretches of a line inside, cut where it leaves; bisection settles where that is.
fn runs_inside(line: &[DVec2], inside: impl Fn(DVec2) -> bool) -> Vec<Vec<DVec2>> {
    let mut runs: Vec<Vec<DVec2>> = Vec::new();
    let mut run: Vec<DVec2> = Vec::new();
    for (i, &p) in line.iter().enumerate() {
        let is_in = inside(p);
        if i > 0 && is_in != inside(line[i - 1]) {
            let (mut held, mut lost) = if is_in { (p, line[i - 1]) } else { (line[i - 1], p) };
            for _ in 0..50 {
                let middle = held.midpoint(lost);
                if inside(middle) { held = middle } else { lost = middle }
            }
            run.push(held);
        }
        if is_in {
            run.push(p);
        } else if !run.is_empty() {
            runs.push(std::mem::take(&mut run));
        }
    }
    runs.push(run);
    runs.retain(|run| run.len() > 1);
    runs
}
