//! What is gone: holes, bites, skeletonised areas, tears.

use glam::DVec2;

use super::{BARE, Blade, GONE};
use crate::geometry::noise;
use crate::geometry::polygon;

/// Holes keep so far from the axis of a larger vein, bites from that of a primary one (mm).
const FROM_MAJOR_MM: f32 = 0.4;
const FROM_PRIMARY_MM: f32 = 0.9;

/// Farther from the base than this (lengths of the blade) primary veins are eaten with the rest.
const TENDER: f64 = 0.72;

/// Tears keep so far from what is gone already (mm).
const FROM_GAP_MM: f32 = 0.9;

/// A tear shorter than this (square roots of the blade's area) would be a notch.
const SHORTEST_TEAR: f64 = 0.06;

impl Blade<'_> {
    /// Eats holes that stop at the larger veins.
    pub(super) fn holes(&mut self, share: f64) {
        let usual = 0.055 * self.breadth * (0.6 + 1.2 * share as f32);
        self.until(share, GONE, |blade, scale| {
            let start = blade.dart();
            let radius = usual * scale * blade.uniform(0.35, 1.5);
            blade.blob(start, radius, |blade, node| blade.place(node).major - FROM_MAJOR_MM)
        });
    }

    /// Leaves only the veins of some areas.
    pub(super) fn skeletonise(&mut self, share: f64) {
        if share >= 1.0 {
            for node in &mut self.nodes {
                node[BARE] = 10.0;
            }
            return;
        }
        let usual = 0.13 * self.breadth * (0.6 + 1.2 * share as f32);
        self.until(share, BARE, |blade, scale| {
            let start = blade.dart();
            let radius = usual * scale * blade.uniform(0.5, 1.4);
            blade.blob(start, radius, |_, _| f32::MAX)
        });
    }

    /// A lump of tissue around a node, as deep as `within` allows.
    fn blob(
        &mut self,
        start: usize,
        radius: f32,
        within: impl Fn(&Self, usize) -> f32,
    ) -> Vec<(usize, f32)> {
        let centre = self.at(start);
        let salt = self.rng.bits() as u32;
        let depth = |node: usize| {
            let to = (self.at(node) - centre).as_vec2();
            let (u, v) = (to.x / radius, to.y / radius);
            let lobes = 0.45 * noise::fractal(u * 0.9 + 7.0, v * 0.9, 3, salt);
            let gnawed = 0.12 * noise::gradient(to.x / 0.7, to.y / 0.7, salt ^ 1);
            (radius * (1.0 + lobes) - to.length() + gnawed).min(within(self, node))
        };
        self.patch(start, depth, 400_000)
    }

    /// Bites arcs off the margin, one beside the other as a caterpillar does.
    pub(super) fn bites(&mut self, share: f64) {
        let outline = self.margin.outline().to_vec();
        let length = polygon::perimeter(&outline);
        let usual = 0.075 * self.breadth * (0.7 + 1.2 * share as f32);
        // A meal: where it goes on, and how many bites are left of it.
        let (mut place, mut left) = (0.0, 0);
        self.until(share, GONE, |blade, scale| {
            let radius = usual * scale * blade.uniform(0.6, 1.3);
            if left == 0 {
                place = blade.rng.between(0.0, length);
                left = 2 + (blade.rng.bits() % 4) as usize;
            } else {
                place += f64::from(radius * blade.uniform(0.7, 1.2));
            }
            left -= 1;
            let (on_margin, inward) = along(&outline, place % length);
            // The head reaches from beyond the margin.
            let centre = on_margin + inward * f64::from(radius * blade.uniform(-0.15, 0.45));
            let salt = blade.rng.bits() as u32;
            let depth = |node: usize| {
                let to = (blade.at(node) - centre).as_vec2();
                let gnawed = 0.10 * noise::gradient(to.x / 0.8, to.y / 0.8, salt);
                let arc =
                    radius * (1.0 + 0.08 * noise::gradient(to.x / radius, to.y / radius, salt ^ 3));
                let spared = blade.primary[node] - FROM_PRIMARY_MM;
                let within = if blade.is_tender(node) { f32::MAX } else { spared };
                (arc - to.length() + gnawed).min(within)
            };
            blade.patch(blade.node_at(on_margin), depth, 400_000)
        });
    }

    /// Whether a node lies so far out that primary veins there are no harder than the tissue.
    fn is_tender(&self, node: usize) -> bool {
        self.at(node).length() > TENDER * self.margin.length_mm()
    }

    /// Tears the blade from the margin inwards, along the larger veins and between them, as wind does: where
    /// and in which direction of some it would go farthest without crossing one.
    pub(super) fn tears(&mut self, count: usize) {
        let outline = self.margin.outline().to_vec();
        let length = polygon::perimeter(&outline);
        let step = self.lattice.spacing() * 1.5;
        for _ in 0..count {
            let wanted = f64::from(self.breadth * self.uniform(0.15, 0.45));
            let places: [f64; 4] = std::array::from_fn(|_| self.rng.between(0.0, length));
            let ways = places.into_iter().flat_map(|place| {
                let (start, inward) = along(&outline, place);
                let turned = move |turns: i32| {
                    let turn = DVec2::from_angle(0.18 * f64::from(turns));
                    (start, turn.rotate(inward), turns.abs())
                };
                (-6..=6).map(turned)
            });
            let clear = |(start, heading, turned)| {
                (self.clear_way(start, heading, step, wanted), turned, start, heading)
            };
            // Of ways that go as far, the straightest inwards.
            let (reach, _, start, heading) = ways
                .map(clear)
                .max_by(|a, b| a.0.total_cmp(&b.0).then(b.1.cmp(&a.1)))
                .expect("there are ways from four places");
            if reach < SHORTEST_TEAR * f64::from(self.breadth) {
                continue;
            }
            let opening = f64::from(self.breadth * self.uniform(0.008, 0.03));
            let mut path = vec![start - heading * 2.0 * step, start];
            // Not quite straight: it gives way aside and comes back.
            let (mut p, mut aside) = (start, 0.0);
            while p.distance(start) < reach {
                aside = 0.85 * aside + f64::from(self.uniform(-0.12, 0.12));
                p += DVec2::from_angle(aside).rotate(heading) * step;
                if !self.is_clear(p, p.distance(start)) {
                    break;
                }
                path.push(p);
            }
            self.open(&path, opening);
        }
    }

    /// How far a straight tear would come, `wanted` at most (mm).
    fn clear_way(&self, start: DVec2, heading: DVec2, step: f64, wanted: f64) -> f64 {
        let places = (1..).map(|i| f64::from(i) * step).take_while(|gone| *gone <= wanted);
        places.take_while(|&gone| self.is_clear(start + heading * gone, gone)).last().unwrap_or(0.0)
    }

    /// Whether a tear that has come so far (mm) may pass: clear of larger veins and other tears, and of the
    /// margin on its other side, or it would cut a piece off.
    fn is_clear(&self, p: DVec2, gone: f64) -> bool {
        let node = self.node_at(p);
        let place = self.place(node);
        let from_margin = (0.4 * gone as f32).min(0.05 * self.breadth);
        self.primary[node] > FROM_PRIMARY_MM
            && place.major > FROM_MAJOR_MM
            && place.edge > from_margin
            && self.nodes[node][GONE] < -FROM_GAP_MM
    }

    /// A wedge along a path, `opening` wide where it begins (mm).
    fn open(&mut self, path: &[DVec2], opening: f64) {
        let last = (path.len() - 1) as f64;
        // What is finer falls between the nodes and would be a row of dots.
        let finest = 0.75 * self.lattice.spacing();
        for (i, pair) in path.windows(2).enumerate() {
            let half = (0.5 * opening * (1.0 - i as f64 / last)).max(finest);
            for node in self.lattice.nodes_near(pair[0], pair[1], half + 1.0) {
                let p = self.at(node);
                let distance = polygon::nearest_on_segment(pair[0], pair[1], p).distance(p);
                let slot = &mut self.nodes[node][GONE];
                *slot = slot.max((half - distance) as f32);
            }
        }
    }
}

/// The point at a distance along a closed line, and the direction inwards (the line runs
/// anticlockwise).
fn along(outline: &[DVec2], mut distance: f64) -> (DVec2, DVec2) {
    let mut last = (outline[0], DVec2::Y);
    for (a, b) in polygon::edges(outline) {
        let length = a.distance(b);
        last = (a.lerp(b, (distance / length).clamp(0.0, 1.0)), (b - a).normalize_or_zero().perp());
        if distance <= length {
            break;
        }
        distance -= length;
    }
    last
}
