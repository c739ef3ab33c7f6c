//! The course of one vein from where it leaves another.

use glam::DVec2;

use super::curve::{self, smoothstep, turned};
use super::ground::Ground;

/// How a vein leaves another, and how it goes on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Course {
    pub(super) from: DVec2,
    /// Where the other vein runs to.
    pub(super) ahead: DVec2,
    /// 1 to the right of the other vein, −1 to the left.
    pub(super) side: f64,
    pub(super) angle_deg: f64,
    /// The share of the angle by which it turns ahead on its way to the margin.
    pub(super) curvature: f64,
}

/// Pieces of a course on the straight way to the margin.
const PIECES: f64 = 80.0;

/// A vein that goes along the margin ends after so many times the way to it.
const LONGEST: f64 = 2.2;

impl Course {
    fn heading(self, share: f64) -> DVec2 {
        let angle = self.angle_deg * (1.0 - self.curvature * share.min(1.3));
        turned(self.ahead, angle, self.side)
    }

    /// The way to the margin (mm), about the middle of its directions.
    pub(super) fn reach(self, ground: &Ground<'_>) -> f64 {
        ground.cast(self.from, self.heading(0.5))
    }

    /// As far as the margin.
    pub(super) fn to_margin(self, ground: &Ground<'_>) -> Vec<DVec2> {
        let reach = self.reach(ground);
        let piece = reach / PIECES;
        let mut line = vec![self.from];
        let mut p = self.from;
        for i in 0..(LONGEST * PIECES) as usize {
            let heading = self.heading((i as f64 + 0.5) / PIECES);
            let room = ground.cast(p, heading);
            if room <= piece {
                line.push(p + heading * room);
                break;
            }
            p += heading * piece;
            line.push(p);
        }
        line
    }

    /// A share of the way to the margin.
    pub(super) fn part_way(self, ground: &Ground<'_>, share: f64) -> Vec<DVec2> {
        curve::beginning(&self.to_margin(ground), share)
    }

    /// Towards the margin, then up along it inside a border of 1 − `share` of the way, for `after`
    /// times the way.
    pub(super) fn along_margin(self, ground: &Ground<'_>, share: f64, after: f64) -> Vec<DVec2> {
        let reach = self.reach(ground);
        let piece = reach / PIECES;
        let border = (1.0 - share).max(0.02) * reach;
        let mut line = vec![self.from];
        let (mut p, mut turned_at) = (self.from, None);
        for i in 0..((LONGEST + after) * PIECES) as usize {
            let walked = (i as f64 + 0.5) / PIECES;
            let own = self.heading(walked);
            let (distance, rim) = ground.rim(p);
            // A vein that leaves at the base of the blade begins beside the margin.
            let away = smoothstep(0.2, 0.5, walked);
            let along = away * (1.0 - smoothstep(0.6 * border, 1.8 * border, distance));
            let heading = own.lerp(rim, along).normalize_or(own);
            let beside = away * own.dot(rim) > 0.97 && distance < 1.2 * border;
            if (along > 0.5 || beside) && turned_at.is_none() {
                turned_at = Some(i);
            }
            if turned_at.is_some_and(|t| (i - t) as f64 > after * PIECES) {
                break;
            }
            p += heading * piece;
            line.push(p);
        }
        line
    }
}

/// A line whose first part runs along the vein it comes from: `base` lies there, `length` behind
/// (decurrent attachment).
pub(super) fn decurrent(line: &[DVec2], base: DVec2, length: f64) -> Vec<DVec2> {
    let total = curve::length(line);
    if length <= 0.0 || total <= 0.0 {
        return line.to_vec();
    }
    let share = (1.5 * length / total).min(0.5);
    let (to, _) = curve::at(line, share);
    let corner = line[0];
    let quadratic = [base, base.lerp(corner, 2.0 / 3.0), to.lerp(corner, 2.0 / 3.0), to];
    let mut bent = curve::cubic(quadratic, 16);
    let mut walked = 0.0;
    for w in line.windows(2) {
        walked += w[0].distance(w[1]);
        if walked > share * total {
            bent.push(w[1]);
        }
    }
    bent
}
