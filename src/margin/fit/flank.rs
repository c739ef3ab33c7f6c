//! One side of a blade from base to apex: where its tips and valleys are, and the halves of lobes
//! between them.

use glam::DVec2;

use super::half::{Effort, Extras, Half, Stretch};

/// Points of a side, at equal steps of the way.
pub(super) const POINTS: usize = 200;

/// Tips and valleys are at least this many points apart.
const APART: usize = 5;

/// One side of a real blade, as if it were the right one: base at the origin, apex at (0, 1).
#[derive(Debug, Clone)]
pub(super) struct Side {
    line: Vec<DVec2>,
}

/// What stands at the apex of the leaf.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum AtApex {
    /// The tip of a lobe.
    Tip,
    /// The valley between two.
    Valley,
}

/// A side fitted.
#[derive(Debug, Clone)]
pub(super) struct Flank {
    /// Foot, tip, foot, … from the base to the apex.
    pub(super) corners: Vec<DVec2>,
    /// The half between each corner and the next, from foot to tip.
    pub(super) halves: Vec<Half>,
    /// The greatest distance from the real side.
    pub(super) worst: f64,
}

impl Flank {
    /// The same with halves nearer to the lines from their feet to their tips.
    pub(super) fn softened(&self, share: f64) -> Self {
        let halves = self.halves.iter().map(|half| half.softened(share)).collect();
        Self { halves, ..self.clone() }
    }
}

impl Side {
    /// Of a line from base to apex.
    pub(super) fn of(line: &[DVec2]) -> Self {
        Self { line: at_equal_steps(line, POINTS) }
    }

    pub(super) fn line(&self) -> &[DVec2] {
        &self.line
    }

    /// The half between two corners; even ones are feet.
    fn stretch(&self, corners: &[usize], i: usize) -> (Stretch, f64) {
        let (from, to) = (corners[i], corners[i + 1]);
        let mut line = at_equal_steps(&self.line[from..=to], (to - from).clamp(20, 60));
        let falls = i % 2 == 1;
        if falls {
            line.reverse();
        }
        (Stretch::of(&line, falls), self.line[from].distance(self.line[to]))
    }

    fn worst(&self, corners: &[usize], i: usize) -> f64 {
        let (stretch, length) = self.stretch(corners, i);
        stretch.fit(Extras::default(), None, Effort::Quick).1 * length
    }

    /// The side as lobes with valleys near the given places; `None` when there is no room.
    pub(super) fn lobed(&self, valleys: &[usize], at_apex: AtApex) -> Option<Flank> {
        let corners = self.corners(valleys, at_apex)?;
        let mut flank = Flank {
            corners: corners.iter().map(|&i| self.line[i]).collect(),
            halves: Vec::new(),
            worst: 0.0,
        };
        for i in 0..corners.len() - 1 {
            let (stretch, length) = self.stretch(&corners, i);
            let (half, worst) = stretch.fit(Extras::default(), None, Effort::Full);
            flank.halves.push(half);
            flank.worst = flank.worst.max(worst * length);
        }
        Some(flank)
    }

    /// The side of a unilobed blade.
    pub(super) fn unilobed(&self, extras: Extras) -> (Half, f64) {
        let stretch = Stretch::of(&at_equal_steps(&self.line, 100), false);
        stretch.fit(Extras { unilobed: true, ..extras }, None, Effort::Full)
    }

    /// Feet and tips in turn: tips where the margin is farthest from its feet, then all moved along
    /// the margin to where the halves beside them fit best.
    fn corners(&self, valleys: &[usize], at_apex: AtApex) -> Option<Vec<usize>> {
        let last = self.line.len() - 1;
        let mut feet = valleys.to_vec();
        feet.push(0);
        feet.sort_unstable();
        if at_apex == AtApex::Valley {
            feet.push(last);
        }
        let mut corners = Vec::new();
        for pair in feet.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            let middle = (self.line[from] + self.line[to]) * 0.5;
            let far = |i: usize| self.line[i].distance_squared(middle);
            let between = from + APART..(to + 1).saturating_sub(APART);
            let tip = between.max_by(|&a, &b| far(a).total_cmp(&far(b)))?;
            corners.extend([from, tip]);
        }
        corners.extend(feet.last());
        if at_apex == AtApex::Tip {
            corners.push(last);
        }
        if corners.windows(2).any(|pair| pair[0] + APART > pair[1]) {
            return None;
        }
        // The worse of the two halves beside a corner counts, the other a little.
        let cost = |corners: &[usize], k: usize| {
            let (a, b) = (self.worst(corners, k - 1), self.worst(corners, k));
            a.max(b) + 0.3 * a.min(b)
        };
        for step in [8, 4, 2, 1] {
            for k in 1..corners.len() - 1 {
                let mut best = cost(&corners, k);
                for _ in 0..3 {
                    let moved = [corners[k].saturating_sub(step), corners[k] + step];
                    let room = corners[k - 1] + APART..=corners[k + 1] - APART;
                    let moves = moved.into_iter().filter(|i| room.contains(i)).map(|i| {
                        let mut moved = corners.clone();
                        moved[k] = i;
                        (cost(&moved, k), moved)
                    });
                    let Some((cost, moved)) = moves.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                        break;
                    };
                    if cost >= best {
                        break;
                    }
                    (best, corners) = (cost, moved);
                }
            }
        }
        Some(corners)
    }
}

/// `steps` + 1 points along a line, its ends included.
fn at_equal_steps(line: &[DVec2], steps: usize) -> Vec<DVec2> {
    let mut ways = vec![0.0];
    for pair in line.windows(2) {
        ways.push(ways[ways.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = ways[ways.len() - 1];
    (0..=steps)
        .map(|k| {
            let way = total * k as f64 / steps as f64;
            let i = ways.partition_point(|&w| w <= way).clamp(1, line.len() - 1);
            let length = (ways[i] - ways[i - 1]).max(f64::MIN_POSITIVE);
            line[i - 1].lerp(line[i], ((way - ways[i - 1]) / length).clamp(0.0, 1.0))
        })
        .collect()
}
