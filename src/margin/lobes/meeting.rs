//! Where two neighbouring lobes meet (section 6.3): default valleys, and set ones that lobes cover.

use glam::DVec2;

use super::place::{Half, Lobe};
use super::{Landmark, LandmarkKind, Outline, STRIP, Waypoint, curve};
use crate::geometry::Rect;

/// Segments that are tested together: few enough to miss early, enough to skip many.
const RUN: usize = 8;

/// Adds the upper half of `lobe` from its tip down to the valley, and from there the half of `next` up
/// to its tip; the valley is a landmark. `starts` is how the two halves leave their lower ends.
///
/// The valley lies where the halves meet, seen from the tips. Halves that do not meet but begin in one
/// place have it there; for others nothing is added, and the answer is `false`.
pub(super) fn join(
    outline: &mut Outline,
    (lobe, next, half): (&Lobe, &Lobe, Half),
    starts: (Waypoint, Waypoint),
) -> bool {
    // From the tip down, and from the tip of the next down.
    let down = curve_from_tip(lobe, lobe.upper, starts.0);
    let up = curve_from_tip(next, half, starts.1);
    // Lobes out of one place always touch there; those that meet hardly farther out leave a strip.
    let shared = starts.0.at == starts.1.at;
    let least = match starts.0.at == lobe.origin {
        true => STRIP * lobe.length.min(next.length),
        false => 0.0,
    };
    let met =
        first_crossing(&down, &up).filter(|(_, _, at)| !shared || at.distance(starts.0.at) > least);
    let ends = (down.len() - 2, up.len() - 2, starts.0.at);
    let one_place = shared && starts.0.at != lobe.origin;
    let Some((i, j, valley)) = met.or(one_place.then_some(ends)) else { return false };
    outline.points.extend(&down[1..=i]);
    outline.points.push(valley);
    let vertex = outline.points.len() - 1;
    outline.landmarks.push(Landmark { vertex, kind: LandmarkKind::Valley });
    outline.points.extend(up[..=j].iter().rev());
    true
}

fn curve_from_tip(lobe: &Lobe, half: Half, start: Waypoint) -> Vec<DVec2> {
    let mut waypoints = Vec::with_capacity(3);
    lobe.waypoints(&mut waypoints, half, start);
    let mut points = Vec::with_capacity(96);
    points.push(lobe.tip());
    curve::append_reversed(&mut points, &waypoints, lobe.tension);
    points
}

/// The first segment of `a` that crosses one of `b`, that one (the first), and where.
fn first_crossing(a: &[DVec2], b: &[DVec2]) -> Option<(usize, usize, DVec2)> {
    let boxes: Vec<Rect> = runs(b).map(|(_, run)| Rect::around(run.iter().copied())).collect();
    for (start, run) in runs(a) {
        let around = Rect::around(run.iter().copied());
        if !boxes.iter().any(|other| around.meets(*other)) {
            continue;
        }
        for (i, s) in run.windows(2).enumerate() {
            let around = Rect::around(s.iter().copied());
            for ((start_b, run_b), other) in runs(b).zip(&boxes) {
                if !around.meets(*other) {
                    continue;
                }
                for (j, t) in run_b.windows(2).enumerate() {
                    if let Some(at) = crossing([s[0], s[1]], [t[0], t[1]]) {
                        return Some((start + i, start_b + j, at));
                    }
                }
            }
        }
    }
    None
}

/// The segments in runs: the first vertex of each and its vertices, the last shared with the next.
fn runs(line: &[DVec2]) -> impl Iterator<Item = (usize, &[DVec2])> {
    (0..line.len().saturating_sub(1))
        .step_by(RUN)
        .map(|start| (start, &line[start..(start + RUN + 1).min(line.len())]))
}

/// Where two segments cross. Both lobes of a palmate leaf end in one point, which is no crossing: the
/// ends of the lines, their last points, do not count.
fn crossing([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> Option<DVec2> {
    let (along, other) = (b - a, d - c);
    let turn = along.perp_dot(other);
    let (t, u) = ((c - a).perp_dot(other) / turn, (c - a).perp_dot(along) / turn);
    ((0.0..1.0).contains(&t) && (0.0..1.0).contains(&u)).then(|| a + along * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_crossing_nearest_to_the_tip_is_found_as_by_trying_all() {
        for k in 0..40 {
            let wave = |phase: f64, tilt: f64| -> Vec<DVec2> {
                let at = |i: u32| DVec2::new(f64::from(i) * 0.1, 0.0);
                let bump =
                    |p: DVec2| p + DVec2::Y * (libm::sin(p.x * 2.0 + phase) + tilt * (p.x - 2.0));
                (0..60).map(at).map(bump).collect()
            };
            let shift = f64::from(k) * 0.37;
            let (a, b) = (wave(0.3, -0.6), wave(shift, shift * 0.1 - 1.0));
            let slow = (0..59).find_map(|i| {
                (0..59).find_map(|j| {
                    let at = crossing([a[i], a[i + 1]], [b[j], b[j + 1]])?;
                    Some((i, j, at))
                })
            });
            assert_eq!(first_crossing(&a, &b), slow, "{k}");
        }
    }
}
