//! Lines of points: cubic curves, equal steps, directions, slight irregularity.

use glam::DVec2;

use crate::geometry::polygon;
use crate::seed::Rng;
use crate::units::Angle;

/// `v` turned by an angle, clockwise on the right side (`side` 1) and anticlockwise on the left
/// (−1): away from a vein that runs along `v`.
pub(super) fn turned(v: DVec2, degrees: f64, side: f64) -> DVec2 {
    let angle = Angle::from_degrees(-side * degrees);
    let (sin, cos) = (angle.sin(), angle.cos());
    DVec2::new(v.x * cos - v.y * sin, v.x * sin + v.y * cos)
}

/// The length of a line.
pub(super) fn length(line: &[DVec2]) -> f64 {
    line.windows(2).map(|w| w[0].distance(w[1])).sum()
}

/// The cubic Bézier curve of four points, as so many pieces.
pub(super) fn cubic(p: [DVec2; 4], pieces: usize) -> Vec<DVec2> {
    let at = |t: f64| {
        let s = 1.0 - t;
        p[0] * (s * s * s)
            + p[1] * (3.0 * s * s * t)
            + p[2] * (3.0 * s * t * t)
            + p[3] * (t * t * t)
    };
    (0..=pieces).map(|i| at(i as f64 / pieces as f64)).collect()
}

/// The point a share of the length along a line, and the direction there.
pub(super) fn at(line: &[DVec2], share: f64) -> (DVec2, DVec2) {
    let goal = share.clamp(0.0, 1.0) * length(line);
    let mut walked = 0.0;
    let mut last = (line[0], DVec2::Y);
    for w in line.windows(2) {
        let piece = w[0].distance(w[1]);
        if piece > 0.0 {
            let ahead = (w[1] - w[0]) / piece;
            if walked + piece >= goal {
                return (w[0] + ahead * (goal - walked), ahead);
            }
            last = (w[1], ahead);
            walked += piece;
        }
    }
    last
}

/// The point of a line nearest to `p`, and the direction there; `None` of a line without pieces.
pub(super) fn nearest(line: &[DVec2], p: DVec2) -> Option<(DVec2, DVec2)> {
    let feet = line.windows(2).map(|w| (polygon::nearest_on_segment(w[0], w[1], p), w[1] - w[0]));
    let nearest = feet.min_by(|a, b| a.0.distance_squared(p).total_cmp(&b.0.distance_squared(p)));
    nearest.map(|(foot, way)| (foot, way.normalize_or(DVec2::Y)))
}

/// The share of a line at its point nearest to `p`.
pub(super) fn share_at(line: &[DVec2], p: DVec2) -> f64 {
    let (mut walked, mut best) = (0.0, (f64::INFINITY, 0.0));
    for w in line.windows(2) {
        let foot = polygon::nearest_on_segment(w[0], w[1], p);
        if foot.distance_squared(p) < best.0 {
            best = (foot.distance_squared(p), walked + foot.distance(w[0]));
        }
        walked += w[0].distance(w[1]);
    }
    if walked > 0.0 { best.1 / walked } else { 0.0 }
}

/// The first `share` of a line.
pub(super) fn beginning(line: &[DVec2], share: f64) -> Vec<DVec2> {
    let goal = share.clamp(0.0, 1.0) * length(line);
    let mut walked = 0.0;
    let mut kept = vec![line[0]];
    for w in line.windows(2) {
        let piece = w[0].distance(w[1]);
        if walked + piece >= goal {
            if piece > 0.0 && goal > walked {
                kept.push(w[0].lerp(w[1], (goal - walked) / piece));
            }
            break;
        }
        walked += piece;
        kept.push(w[1]);
    }
    kept
}

/// Points along a line at equal steps of at most `step`, both ends included.
pub(super) fn resampled(line: &[DVec2], step: f64) -> Vec<DVec2> {
    resampled_to(line, ((length(line) / step).ceil() as usize).max(1))
}

/// Points along a line at so many equal steps, both ends included.
pub(super) fn resampled_to(line: &[DVec2], count: usize) -> Vec<DVec2> {
    let total = length(line);
    let spacing = total / count as f64;
    let mut points = Vec::with_capacity(count + 1);
    let (mut walked, mut next) = (0.0, 0.0);
    for w in line.windows(2) {
        let piece = w[0].distance(w[1]);
        while points.len() < count && next <= walked + piece && piece > 0.0 {
            points.push(w[0].lerp(w[1], ((next - walked) / piece).clamp(0.0, 1.0)));
            next = spacing * points.len() as f64;
        }
        walked += piece;
    }
    points.extend(line.last());
    points
}

/// The line turned and scaled about its beginning so that it ends at `end`.
pub(super) fn ended_at(line: &[DVec2], end: DVec2) -> Vec<DVec2> {
    let (from, to) = (line[0], line[line.len() - 1]);
    let (chord, goal) = (to - from, end - from);
    let square = chord.length_squared();
    if square == 0.0 {
        return line.to_vec();
    }
    // Multiplication by goal / chord as complex numbers.
    let (re, im) = (goal.dot(chord) / square, chord.perp_dot(goal) / square);
    let place = |p: &DVec2| {
        let d = *p - from;
        from + DVec2::new(d.x * re - d.y * im, d.x * im + d.y * re)
    };
    line.iter().map(place).collect()
}

/// The line with a few slow waves across it, up to `amplitude`, none at its ends.
pub(super) fn wavering(line: &[DVec2], amplitude: f64, rng: &mut Rng) -> Vec<DVec2> {
    let tau = std::f64::consts::TAU;
    let waves: Vec<(f64, f64, f64)> = (0..3)
        .map(|i| {
            let cycles = rng.between(0.6, 1.2) * f64::from(i + 1);
            (cycles * tau, rng.unit() * tau, rng.between(-1.0, 1.0) / f64::from(i + 1))
        })
        .collect();
    let total = length(line);
    if amplitude == 0.0 || total == 0.0 {
        return line.to_vec();
    }
    let mut walked = 0.0;
    (0..line.len())
        .map(|i| {
            let before = line[i.saturating_sub(1)];
            walked += line[i].distance(before);
            let t = walked / total;
            let ahead = (line[(i + 1).min(line.len() - 1)] - before).normalize_or_zero();
            let sway: f64 = waves.iter().map(|(f, phase, a)| a * libm::sin(f * t + phase)).sum();
            line[i] + ahead.perp() * (sway * amplitude * 4.0 * t * (1.0 - t))
        })
        .collect()
}

/// An open line with its corners rounded: `rounds` means of each point with its neighbours.
pub(super) fn rounded(line: &[DVec2], rounds: usize) -> Vec<DVec2> {
    let mut line = line.to_vec();
    for _ in 0..rounds {
        let before = line.clone();
        for i in 1..line.len().saturating_sub(1) {
            line[i] = (before[i - 1] + before[i] * 2.0 + before[i + 1]) * 0.25;
        }
    }
    line
}

/// 0 below `low`, 1 above `high`, smooth in between.
pub(super) fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_where_it_is_told_and_keeps_its_form() {
        let line = [DVec2::ZERO, DVec2::new(1.0, 0.5), DVec2::new(2.0, 0.0)];
        let moved = ended_at(&line, DVec2::new(0.0, 4.0));
        assert!(moved[2].distance(DVec2::new(0.0, 4.0)) < 1e-12);
        assert!(moved[1].distance(DVec2::new(-1.0, 2.0)) < 1e-12);
    }

    #[test]
    fn steps_along_a_line_are_equal() {
        let line = cubic([DVec2::ZERO, DVec2::Y, DVec2::new(1.0, 2.0), DVec2::new(3.0, 2.0)], 40);
        let points = resampled(&line, 0.1);
        let longest = points.windows(2).map(|w| w[0].distance(w[1])).fold(0.0, f64::max);
        assert!(longest <= 0.1 + 1e-12);
        assert_eq!(points.first(), line.first());
        assert_eq!(points.last(), line.last());
    }
}
