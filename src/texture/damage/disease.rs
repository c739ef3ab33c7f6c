//! What is still there but hurt: mines, spots, scorch.

use glam::DVec2;

use super::{BROWN, Blade, FRASS, MINE, PALE, SPOT};
use crate::geometry::noise;
use crate::geometry::polygon;
use crate::texture::tissue::smooth;
use crate::units::Angle;

/// The pale halo of a spot, in its radii.
const HALO: f32 = 0.8;

/// A miner keeps so far from the axis of a larger vein (mm), beside what it eats itself.
const VEIN_MM: f32 = 0.45;

/// A miner that likes no way better than this goes no farther.
const TRAPPED: f32 = 2.4;

impl Blade<'_> {
    /// Kills tissue from the margin inwards, where water comes last: far from the base and from the larger veins,
    /// in tongues between these. Some stretches of the margin are spared.
    pub(super) fn scorch(&mut self, strength: f64) {
        if strength == 0.0 {
            return;
        }
        let strength = strength as f32;
        let length = self.margin.length_mm() as f32;
        for node in 0..self.nodes.len() {
            let place = self.place(node);
            if place.edge < -2.0 {
                continue;
            }
            let p = self.at(node).as_vec2();
            let [broad, middle, fine] = place.noise;
            let far = smooth(0.1, 0.85, p.length() / length);
            let hit = smooth(-0.5, 0.4, broad + 0.5 * middle + 0.5 * (strength - 0.5));
            let between = smooth(0.0, 0.07 * self.breadth, place.major);
            let reach = 0.6 * self.breadth * strength * far * hit * (0.3 + 0.7 * between);
            let depth = reach * (1.0 + 0.4 * middle) - place.edge + 0.4 * fine;
            // A yellow front runs before the brown.
            let wound = &mut self.nodes[node];
            wound[BROWN] = wound[BROWN].max(smooth(-0.3, 0.9, depth));
            wound[PALE] = wound[PALE].max(0.45 * smooth(-3.0, 0.3, depth));
        }
    }

    /// Brown spots with a dark rim and a narrow pale halo.
    pub(super) fn spots(&mut self, count: usize) {
        for _ in 0..count {
            let start = self.dart();
            let centre = self.at(start);
            let radius = 0.012 * self.breadth * self.uniform(0.3, 1.0).powi(2) * 1.9 + 0.25;
            let salt = self.rng.bits() as u32;
            for node in self.lattice.nodes_near(centre, centre, f64::from(3.0 * radius)) {
                let to = (self.at(node) - centre).as_vec2();
                let r = radius
                    * (1.0
                        + 0.3
                            * noise::gradient(
                                to.x / radius * 0.8 + 3.0,
                                to.y / radius * 0.8,
                                salt,
                            ));
                let depth = r - to.length();
                let wound = &mut self.nodes[node];
                wound[SPOT] = wound[SPOT].max(depth);
                wound[PALE] = wound[PALE].max(0.3 * smooth(-HALO * r, 0.0, depth));
            }
        }
    }

    /// Galleries that wind between the veins and widen as their maker grows; it leaves a dark line.
    pub(super) fn mines(&mut self, count: usize) {
        // Where others have eaten.
        let mut galleries: Vec<DVec2> = Vec::new();
        for _ in 0..count {
            let start = self.dart();
            let mut p = self.at(start);
            let mut heading = {
                let turn = Angle::from_degrees(f64::from(self.uniform(0.0, 360.0)));
                DVec2::new(turn.cos(), turn.sin())
            };
            let mut bend = 0.0_f32;
            let length = self.breadth * self.uniform(0.8, 1.6);
            let widest = self.breadth * self.uniform(0.008, 0.014);
            let step = (0.5 * widest).max(self.lattice.spacing() as f32);
            let steps = (length / step) as usize;
            let mut way = vec![p];
            for i in 0..steps {
                let half = widest * (0.15 + 0.85 * i as f32 / steps as f32);
                if self.place(self.node_at(p)).edge < 0.2 {
                    break;
                }
                bend = 0.9 * bend + self.uniform(-0.07, 0.07);
                // What is eaten already is empty: a piece back along its own way it goes no more.
                let behind = way.len().saturating_sub((8.0 * widest / step) as usize);
                let ahead = f64::from(4.0 * half + step);
                let turned = (-6..=6).map(|k| 0.11 * k as f32).map(|turn| {
                    let towards = DVec2::from_angle(f64::from(bend + turn)).rotate(heading);
                    let eaten = galleries.iter().chain(&way[..behind]);
                    let cost = self.unease(p + towards * ahead, half, eaten);
                    // Nor does it leap over a vein.
                    let on_the_way = self.place(self.node_at(p + towards * (0.5 * ahead)));
                    let vein = vein_in_the_way(on_the_way.major, half);
                    (cost.max(vein) + 1.5 * turn * turn, towards)
                });
                let (cost, towards) =
                    turned.min_by(|a, b| a.0.total_cmp(&b.0)).expect("there are thirteen");
                if cost > TRAPPED {
                    break;
                }
                heading = towards;
                let next = p + heading * f64::from(step);
                self.gallery(p, next, half);
                p = next;
                way.push(p);
            }
            galleries.append(&mut way);
        }
    }

    /// How little a miner of this half width likes a place: for the larger veins, for the margin, for
    /// what it or another has eaten.
    fn unease<'p>(&self, p: DVec2, half: f32, eaten: impl Iterator<Item = &'p DVec2>) -> f32 {
        let place = self.place(self.node_at(p));
        let near = |distance: f32, enough: f32| (1.0 - distance / (enough * half)).clamp(0.0, 1.5);
        let eaten = eaten.map(|q| q.distance_squared(p)).fold(f64::INFINITY, f64::min);
        vein_in_the_way(place.major, half)
            + 2.0 * near(place.edge, 4.0)
            + 3.0 * near(eaten.sqrt() as f32, 5.0)
    }

    fn gallery(&mut self, a: DVec2, b: DVec2, half: f32) {
        for node in self.lattice.nodes_near(a, b, f64::from(half + 0.6)) {
            let p = self.at(node);
            let distance = polygon::nearest_on_segment(a, b, p).distance(p) as f32;
            let wound = &mut self.nodes[node];
            wound[MINE] = wound[MINE].max(half - distance);
            wound[FRASS] = wound[FRASS].max(0.22 * half - distance);
        }
    }
}

/// How little a miner of this half width likes to be so near to one of the larger veins (mm).
fn vein_in_the_way(distance: f32, half: f32) -> f32 {
    let near = 1.0 - distance / (1.6 * half + VEIN_MM);
    2.6 * near.max(0.0).powi(2)
}
