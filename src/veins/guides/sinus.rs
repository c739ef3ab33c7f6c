//! Primary veins given line by line go round a sinus that reaches into their way.
//!
//! What is done follows the margin smoothly, so that a vein on the way from leaf to leaf does not jump when
//! a sinus comes near: the nearer that is, the more the line turns into the shortest way inside the blade.

use glam::DVec2;

use super::curve;
use super::ground::Ground;

/// A line nearer to the margin than this (lengths of the blade) begins to turn,
const NEAR: f64 = 0.03;

/// but near its ends, where the margin is, only what is nearer than this share of the way from there.
const RISE: f64 = 0.1;

/// At this share of those distances it has turned whole.
const WHOLE: f64 = 0.3;

/// Its end lies so far inside the margin (lengths of the blade).
const LEAST: f64 = 1e-3;

/// The points of a line to work with.
const POINTS: usize = 64;

/// How often the shortest way is rounded and moved off the margin again,
const ROUNDS: usize = 8;

/// by so many times what guides keep from it.
const KEPT: f64 = 1.5;

/// The line that keeps inside; the line itself where it is far enough from the margin, or where the blade has
/// no way for it.
pub(super) fn round(ground: &Ground<'_>, line: &[DVec2]) -> Vec<DVec2> {
    let line = curve::resampled_to(line, POINTS);
    let (from, last) = (line[0], line.len() - 1);
    let end = ground.off_margin(line[last], LEAST * ground.length());
    let ended = curve::ended_at(&line, end);
    let turned = 1.0 - curve::smoothstep(WHOLE, 1.0, clearance(ground, &ended));
    if turned == 0.0 {
        return ended;
    }
    let Some(way) = ground.shortest(from, end) else { return ended };
    let mut way = curve::resampled_to(&way, POINTS);
    for _ in 0..ROUNDS {
        way = curve::rounded(&way, 2);
        for p in &mut way[1..last] {
            let enough = RISE * p.distance(from).min(p.distance(end));
            *p = ground.off_margin(*p, enough.min(KEPT * ground.inset()));
        }
    }
    ended.iter().zip(way).map(|(own, other)| own.lerp(other, turned)).collect()
}

/// How far a line keeps from the margin at its narrowest, in parts of what it should; below 0 outside.
fn clearance(ground: &Ground<'_>, line: &[DVec2]) -> f64 {
    let (from, end) = (line[0], line[line.len() - 1]);
    let parts = line[1..line.len() - 1].iter().map(|&p| {
        let enough = (NEAR * ground.length()).min(RISE * p.distance(from).min(p.distance(end)));
        ground.depth(p, enough) / enough.max(1e-300)
    });
    parts.fold(1.0, f64::min)
}
