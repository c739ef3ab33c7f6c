//! A vein keeps to its side of the one it leaves.

use glam::DVec2;

use super::curve;

/// A vein gets away from its parent at no smaller angle than this (its sine: 20°),
const RISE: f64 = 0.34;

/// until it is so far off (lengths of the blade).
const OFF: f64 = 0.03;

/// A vein that leaves past this share of its parent goes on beyond its end, where there are no sides.
pub(super) const TIP: f64 = 0.97;

/// The line moved off the parent it leaves at share `from`, where it would run along that or cross it: as
/// the parent bends on the way from leaf to leaf, what was seen from the line's own ends can lie across it.
/// `length` is that of the blade.
pub(super) fn aside(
    mut line: Vec<DVec2>,
    parent: &[DVec2],
    from: f64,
    left: bool,
    length: f64,
) -> Vec<DVec2> {
    if from > TIP {
        return line;
    }
    let hand = if left { 1.0 } else { -1.0 };
    let (mut way, mut last) = (0.0, line[0]);
    for p in line.iter_mut().skip(1) {
        way += p.distance(last);
        last = *p;
        let Some((foot, ahead)) = curve::nearest(parent, *p) else { continue };
        let out = ahead.perp() * hand;
        let side = if out.dot(*p - foot) < 0.0 { -1.0 } else { 1.0 };
        let off = side * p.distance(foot);
        let least = (RISE * way).min(OFF * length);
        if off < least {
            *p += out * (least - off);
        }
    }
    line
}

/// Whether a point lies on the left of a line.
pub(super) fn is_left(p: DVec2, line: &[DVec2]) -> bool {
    curve::nearest(line, p).is_some_and(|(foot, ahead)| ahead.perp_dot(p - foot) > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_across_its_parent_is_moved_to_its_side() {
        let parent: Vec<DVec2> = (0..=20).map(|i| DVec2::new(0.0, f64::from(i) / 20.0)).collect();
        let line: Vec<DVec2> = (0..=20)
            .map(|i| f64::from(i) / 20.0)
            .map(|t| DVec2::new(0.3 * t * (t - 0.3), 0.5 + 0.3 * t))
            .collect();
        assert!(line.iter().any(|p| p.x < -0.005));
        let moved = aside(line.clone(), &parent, 0.5, false, 1.0);
        assert!(moved[1..].iter().all(|p| p.x > 0.0), "{moved:?}");
        assert_eq!(moved[20], line[20]);
        // What is on its side already stays.
        let far: Vec<DVec2> = line.iter().map(|p| DVec2::new(p.y - 0.5, p.y)).collect();
        assert_eq!(aside(far.clone(), &parent, 0.5, false, 1.0), far);
        let mirrored =
            aside(line.iter().map(|p| DVec2::new(-p.x, p.y)).collect(), &parent, 0.5, true, 1.0);
        for (a, b) in moved.iter().zip(&mirrored) {
            assert!((a.x + b.x).abs() < 1e-12 && a.y == b.y);
        }
    }
}
