//! Where the petiole is attached, and where the tip is.
//!
//! A place on the outline speaks for itself as the base by five things, each worth a number: a stalk,
//! a notch, mirror symmetry about the line through it and the centre, a sharp tip across, and lying
//! low in the picture, as leaves are mostly laid out. The place with the largest sum wins.
//!
//! The ring is anticlockwise, y up, its points evenly spaced.

use glam::DVec2;

use super::Found;
use super::stalk::{self, Stalk};
use crate::geometry::Rect;
use crate::geometry::polygon;
use crate::geometry::segments::SegmentIndex;

/// A place for the base.
#[derive(Debug, Clone, Copy)]
pub(super) struct Base {
    /// Where.
    pub(super) at: DVec2,
    /// What spoke for it.
    pub(super) found: Found,
    /// The stalk to cut off, when there is one.
    pub(super) stalk: Option<Stalk>,
}

impl Base {
    fn on(stalk: Stalk) -> Self {
        Self { at: stalk.attachment, found: Found::Stalk, stalk: Some(stalk) }
    }
}

/// What can be told of a leaf without knowing its base.
#[derive(Debug)]
pub(super) struct Shape<'a> {
    pub(super) ring: &'a [DVec2],
    pub(super) centre: DVec2,
    /// The root of the area.
    pub(super) size: f64,
    pub(super) stalks: Vec<Stalk>,
    symmetry: Symmetry,
}

/// Weights of what speaks for a base. Set by hand on sixty leaves of twenty species; a wrong base
/// costs a whole side, so only their order matters.
mod weight {
    /// A long petiole outweighs everything, most of all when it is so long that it spoils symmetry.
    pub(super) const PETIOLE: f64 = 2.5;
    pub(super) const STALK: f64 = 2.0;
    /// A petiole cut off at its own width still says more than the rest.
    pub(super) const STUB: f64 = 0.9;
    pub(super) const NOTCH: f64 = 0.5;
    pub(super) const SYMMETRY: f64 = 7.0;
    pub(super) const SHARP_TIP: f64 = 0.6;
    pub(super) const LOW: f64 = 0.5;
    pub(super) const BLUNT: f64 = 0.6;
    pub(super) const LONG: f64 = 0.2;
}

/// Angles to both sides of the line from the base through the centre (deg): within the first lie
/// lobes that belong together, within the second the tip; beyond the third it may be a lobe.
const TIP_WITHIN_DEG: [f64; 3] = [40.0, 25.0, 10.0];

/// A base this near to a stalk, as a share of the root of the area, is at the stalk.
const BESIDE: f64 = 0.1;

/// An end of the blade with a smaller angle than this is pointed (deg).
const POINTED_DEG: f64 = 125.0;

/// What a stalk adds to the sum for its attachment.
fn worth(stalk: &Stalk) -> f64 {
    let long = (stalk.slenderness - 1.0).clamp(0.0, 1.0);
    let very_long = ((stalk.slenderness - 4.0) / 4.0).clamp(0.0, 1.0);
    // A drip tip may pass for a stalk, but it widens towards the blade and flares little.
    let flare = ((stalk.flare - 1.2) / 1.2).clamp(0.3, 1.0);
    let steady = ((1.9 - stalk.widening) / 0.6).clamp(0.1, 1.0);
    let stub = weight::STUB + (weight::STALK - weight::STUB) * long;
    (stub * flare + weight::PETIOLE * very_long) * steady
}

impl<'a> Shape<'a> {
    pub(super) fn of(ring: &'a [DVec2]) -> Self {
        let size = polygon::signed_area(ring).abs().sqrt();
        let centre = polygon::centroid(ring);
        let stalks = stalk::stalks(ring, size);
        Self { ring, centre, size, stalks, symmetry: Symmetry::of(ring, centre) }
    }

    /// The best place for the base.
    pub(super) fn base(&self) -> Base {
        let mut best: Option<(f64, Base)> = None;
        let mut offer = |score: f64, base: Base| {
            if best.as_ref().is_none_or(|(most, _)| score > *most) {
                best = Some((score, base));
            }
        };
        for &stalk in &self.stalks {
            offer(self.score(stalk.attachment) + worth(&stalk), Base::on(stalk));
        }
        for (at, notch) in self.notches() {
            offer(
                self.score(at) + weight::NOTCH * notch,
                Base { at, found: Found::Notch, stalk: None },
            );
        }
        for direction in directions() {
            let at = self.exit(self.centre, direction);
            offer(self.score(at), Base { at, found: Found::End, stalk: None });
        }
        let (_, mut base) = best.expect("every direction leaves the leaf somewhere");
        if base.found == Found::End {
            // Directions are coarse. Opposite the tip is finer, and a pointed end finer still.
            let tip = self.tip(base.at);
            let across = self.tip(tip);
            base.at = if self.angle_deg(across) < POINTED_DEG {
                across
            } else {
                self.exit(self.centre, (self.centre - tip).normalize_or(DVec2::NEG_Y))
            };
        }
        // Whatever was found beside a stalk means the stalk.
        let near = |stalk: &&Stalk| stalk.attachment.distance(base.at) < BESIDE * self.size;
        if base.stalk.is_none()
            && let Some(&stalk) = self.stalks.iter().find(near)
        {
            base = Base::on(stalk);
        }
        if base.stalk.is_none()
            && let Some(nub) = self.nub(base.at)
        {
            base = Base { at: nub, found: Found::Nub, stalk: None };
        }
        base
    }

    /// The sharpest thing that sticks out of the outline beside `at`: the rest of a petiole too short
    /// or too conical for a stalk.
    fn nub(&self, at: DVec2) -> Option<DVec2> {
        const REACH: f64 = 0.12;
        const ARM: f64 = 0.05;
        const LEAST_SHARPNESS: f64 = 0.2;
        let n = self.ring.len();
        let arm = (ARM * self.size / self.ring[0].distance(self.ring[1])).ceil() as usize;
        let arm = arm.clamp(1, n / 4);
        let sharpness = |i: usize| {
            let (a, b) = (self.ring[(i + n - arm) % n], self.ring[(i + arm) % n]);
            (self.ring[i] - a).perp_dot(b - a) / (b - a).length_squared().max(1e-12)
        };
        (0..n)
            .filter(|&i| self.ring[i].distance(at) < REACH * self.size)
            .map(|i| (sharpness(i), i))
            .filter(|&(sharp, _)| sharp > LEAST_SHARPNESS)
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, i)| self.ring[i])
    }

    /// What speaks for a base at `at`, whatever is there.
    fn score(&self, at: DVec2) -> f64 {
        let away = (at - self.centre).normalize_or(DVec2::NEG_Y);
        let sharp = ((150.0 - self.angle_deg(self.tip(at))) / 60.0).clamp(0.0, 1.0);
        let (length, width, near, far) = self.symmetry.profile(away);
        let long = (length / width).min(2.0) - 1.0;
        let blunt = (near - far) / width;
        weight::SYMMETRY * (self.symmetry.share(away) - self.symmetry.best)
            + weight::SHARP_TIP * sharp
            + weight::LOW * -away.y
            + weight::BLUNT * blunt
            + weight::LONG * long
    }

    /// The tip of a leaf with its base at `base`: the farthest point that stands out within
    /// [`TIP_WITHIN_DEG`] of the line from the base through the centre; without one, or between two
    /// lobes that stand out alike on both sides, the place where that line leaves the leaf.
    pub(super) fn tip(&self, base: DVec2) -> DVec2 {
        let n = self.ring.len();
        let along = (self.centre - base).normalize_or(DVec2::Y);
        let far = |i: usize| self.ring[i % n].distance(base);
        let off = |i: usize| self.ring[i] - base;
        let within = |i: usize, cos: f64| off(i).dot(along) >= cos * off(i).length();
        let [lobes, tips, middle] = TIP_WITHIN_DEG.map(|angle| libm::cos(angle.to_radians()));
        let window = n / 40 + 1;
        let outstanding: Vec<usize> = (0..n)
            .filter(|&i| {
                within(i, lobes)
                    && off(i).length() > 0.3 * self.size
                    && (1..=window).all(|k| far(i) >= far(i + k) && far(i) >= far(i + n - k))
            })
            .collect();
        let reach = |i: usize| off(i).dot(along);
        let tip = outstanding.iter().copied().filter(|&i| within(i, tips));
        let tip = tip.max_by(|&i, &j| reach(i).total_cmp(&reach(j)));
        let twin = |i: usize, j: usize| {
            along.perp_dot(off(i)) * along.perp_dot(off(j)) < 0.0 && reach(j) > 0.7 * reach(i)
        };
        let is_lobe = |i: usize| !within(i, middle) && outstanding.iter().any(|&j| twin(i, j));
        match tip {
            Some(i) if !is_lobe(i) => self.ring[i],
            _ => self.exit(self.centre, along),
        }
    }

    /// The angle of the outline at the point of the ring nearest to `at` (deg).
    fn angle_deg(&self, at: DVec2) -> f64 {
        let n = self.ring.len();
        let nearest = (0..n).min_by(|&i, &j| {
            self.ring[i].distance_squared(at).total_cmp(&self.ring[j].distance_squared(at))
        });
        let i = nearest.unwrap_or(0);
        let arm = (0.08 * self.size / self.ring[0].distance(self.ring[1])).ceil() as usize;
        let arm = arm.clamp(1, n / 4);
        let (a, b) = (self.ring[(i + arm) % n] - at, self.ring[(i + n - arm) % n] - at);
        a.angle_to(b).abs().to_degrees()
    }

    /// The last point of the outline on the ray from `from`.
    fn exit(&self, from: DVec2, direction: DVec2) -> DVec2 {
        let mut last = (0.0, from);
        for (a, b) in polygon::edges(self.ring) {
            let (u, v) = (direction.perp_dot(a - from), direction.perp_dot(b - from));
            if (u > 0.0) != (v > 0.0) {
                let p = a.lerp(b, u / (u - v));
                let reach = (p - from).dot(direction);
                if reach > last.0 {
                    last = (reach, p);
                }
            }
        }
        last.1
    }

    /// The deepest points of the bays of the outline, and how much of a notch each is, 0 to 1: both
    /// deep, and not just the hollow flank of something that sticks out.
    fn notches(&self) -> Vec<(DVec2, f64)> {
        let n = self.ring.len();
        let hull = convex_hull(self.ring);
        let mut notches = Vec::new();
        for (k, &start) in hull.iter().enumerate() {
            let end = hull[(k + 1) % hull.len()];
            let count = (end + n - start) % n;
            let (a, b) = (self.ring[start], self.ring[end]);
            let along = (b - a).normalize_or_zero();
            let depth = |i: usize| along.perp_dot(self.ring[i % n] - a);
            let inner = start + 1..start + count;
            if let Some(i) = inner.max_by(|&i, &j| depth(i).total_cmp(&depth(j)))
                && depth(i) > 0.015 * self.size
            {
                let deep = (depth(i) / (0.08 * self.size)).min(1.0);
                let narrow = (depth(i) / (0.12 * a.distance(b))).min(1.0);
                notches.push((self.ring[i % n], deep * narrow));
            }
        }
        notches
    }
}

/// Every second degree.
fn directions() -> impl Iterator<Item = DVec2> {
    (0..180).map(|k| {
        let (sin, cos) = libm::sincos((f64::from(k) * 2.0).to_radians());
        DVec2::new(cos, sin)
    })
}

/// How well a leaf is mirrored onto itself about each line through its centre, on a coarse raster.
#[derive(Debug)]
struct Symmetry {
    centre: DVec2,
    cell: f64,
    min: DVec2,
    side: usize,
    inside: Vec<bool>,
    points: Vec<DVec2>,
    best: f64,
}

impl Symmetry {
    const SIDE: usize = 72;

    fn of(ring: &[DVec2], centre: DVec2) -> Self {
        let bounds = Rect::around(ring.iter().copied());
        let cell = bounds.size().max_element() / Self::SIDE as f64;
        let index = SegmentIndex::of_polygon(ring);
        let mut inside = Vec::with_capacity(Self::SIDE * Self::SIDE);
        let mut points = Vec::new();
        for y in 0..Self::SIDE {
            for x in 0..Self::SIDE {
                let p = bounds.min + DVec2::new(x as f64 + 0.5, y as f64 + 0.5) * cell;
                let within = index.contains(p);
                inside.push(within);
                if within {
                    points.push(p);
                }
            }
        }
        let mut symmetry =
            Self { centre, cell, min: bounds.min, side: Self::SIDE, inside, points, best: 0.0 };
        symmetry.best = directions().map(|d| symmetry.share(d)).fold(0.0, f64::max);
        symmetry
    }

    /// The share of the leaf whose mirror image about the line along `axis` is leaf too.
    fn share(&self, axis: DVec2) -> f64 {
        let kept = self.points.iter().filter(|&&p| {
            let off = p - self.centre;
            let mirrored = self.centre + axis * (2.0 * off.dot(axis)) - off;
            let cell = (mirrored - self.min) / self.cell;
            cell.cmpge(DVec2::ZERO).all()
                && cell.max_element() < self.side as f64
                && self.inside[cell.y as usize * self.side + cell.x as usize]
        });
        kept.count() as f64 / self.points.len().max(1) as f64
    }

    /// Length along `axis`, greatest width across it, and the widths at an eighth of the length
    /// from the end at which `axis` points and from the other.
    fn profile(&self, axis: DVec2) -> (f64, f64, f64, f64) {
        const SLICES: usize = 32;
        let reach = |p: &DVec2| (*p - self.centre).dot(axis);
        let low = self.points.iter().map(reach).fold(f64::INFINITY, f64::min);
        let high = self.points.iter().map(reach).fold(f64::NEG_INFINITY, f64::max);
        let length = (high - low).max(self.cell);
        let mut counts = [0.0f64; SLICES];
        for p in &self.points {
            let slice = (reach(p) - low) / length * SLICES as f64;
            counts[(slice as usize).min(SLICES - 1)] += 1.0;
        }
        let width = |slice: usize| counts[slice] * self.cell * self.cell * SLICES as f64 / length;
        let widest = (0..SLICES).map(width).fold(self.cell, f64::max);
        let mean = |a: usize, b: usize| (width(a) + width(b)) * 0.5;
        let far = mean(SLICES / 8, SLICES / 8 - 1);
        (length, widest, mean(SLICES - SLICES / 8, SLICES - 1 - SLICES / 8), far)
    }
}

/// Indices of the corners of the convex hull of an anticlockwise ring, in order (Andrew, 1979).
fn convex_hull(ring: &[DVec2]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..ring.len()).collect();
    order.sort_by(|&i, &j| (ring[i].x.total_cmp(&ring[j].x)).then(ring[i].y.total_cmp(&ring[j].y)));
    let mut hull: Vec<usize> = Vec::new();
    for upper in [false, true] {
        let floor = hull.len();
        let mut extend = |i: usize| {
            while hull.len() >= floor + 2 {
                let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                if polygon::cross(ring[a], ring[b], ring[i]) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(i);
        };
        if upper {
            order.iter().rev().for_each(|&i| extend(i));
        } else {
            order.iter().for_each(|&i| extend(i));
        }
        hull.pop();
    }
    hull
}
