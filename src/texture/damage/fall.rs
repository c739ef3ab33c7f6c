//! What falls off a blade once others have eaten of it.

use std::collections::VecDeque;

use super::{Blade, GONE};
use crate::raster::Grid;
use crate::raster::components::{Components, neighbours};

/// What has fallen off lies so deep in the gap (mm).
const FALLEN_MM: f32 = 1.0;

/// What is no thicker than twice this (mm) holds nothing; so far from any gap nothing has got thinner.
const NECK_MM: f32 = 0.15;
const HEALTHY_MM: f32 = 1.5;

impl Blade<'_> {
    /// Takes what hangs on nothing any more, or on a thread: of every piece that the whole blade had,
    /// the largest part stays. Primary veins hold together, however fine they are beside the nodes.
    pub(super) fn let_fall(&mut self) {
        let (side, spacing) = (self.guide.side(), self.lattice.spacing() as f32);
        let thread = NECK_MM.max(0.4 * spacing);
        let tissue = |i: usize| self.place(i).edge > 0.0 && self.nodes[i][GONE] <= 0.0;
        let holds = |i: usize| {
            let gone = self.nodes[i][GONE];
            let thick = gone < -HEALTHY_MM || self.place(i).edge.min(-gone) > thread;
            tissue(i) && (thick || self.primary[i] < 1.5 * spacing)
        };
        let pieces = |mask: &dyn Fn(usize) -> bool| {
            Components::of(&Grid::from_values(side, side, (0..side * side).map(mask).collect()))
        };
        let whole = pieces(&|i| self.place(i).edge > 0.0);
        let mut left = pieces(&holds);
        let mut largest = vec![0_usize; whole.areas.len()];
        let pairs = || whole.labels.values().iter().zip(left.labels.values());
        for (&piece, &part) in pairs().filter(|(_, part)| **part > 0) {
            let best = &mut largest[piece as usize];
            if *best == 0 || left.areas[part as usize] > left.areas[*best] {
                *best = part as usize;
            }
        }
        // Rims and threads go with what they are nearest to.
        let labels = left.labels.values_mut();
        let mut queue: VecDeque<usize> = (0..labels.len()).filter(|&i| labels[i] > 0).collect();
        while let Some(i) = queue.pop_front() {
            for next in neighbours(i, side, side) {
                if labels[next] == 0 && tissue(next) {
                    labels[next] = labels[i];
                    queue.push_back(next);
                }
            }
        }
        let stays = |i: usize| {
            largest[whole.labels.values()[i] as usize] == left.labels.values()[i] as usize
        };
        let fallen: Vec<usize> = (0..side * side).filter(|&i| tissue(i) && !stays(i)).collect();
        for i in fallen {
            let (x, y) = (i % side, i / side);
            for row in y.saturating_sub(2)..(y + 3).min(side) {
                for node in (x.saturating_sub(2)..(x + 3).min(side)).map(|x| row * side + x) {
                    // Past the margin, too: what is read between the nodes would leave its rim.
                    if node == i || self.place(node).edge <= 0.0 {
                        self.nodes[node][GONE] = self.nodes[node][GONE].max(FALLEN_MM);
                    }
                }
            }
        }
    }
}
