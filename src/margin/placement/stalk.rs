//! Thin stalks on an outline: petioles, whole or cut short.
//!
//! From every point of the outline the two banks are followed like a zip. A stalk keeps its width
//! and then flares abruptly; a drip tip grows from nothing and never keeps a width, so its zip opens
//! at once.

use glam::DVec2;

use crate::geometry::polygon;

/// A stalk on a ring of points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Stalk {
    /// The ring's index where it leaves the blade, before its end in the order of the ring.
    pub(super) from: usize,
    /// The same on the other bank.
    pub(super) to: usize,
    /// Between the two.
    pub(super) attachment: DVec2,
    /// Length over width.
    pub(super) slenderness: f64,
    /// How much wider the zip is one and a half widths beyond the attachment, in widths.
    pub(super) flare: f64,
    /// Its width near the blade over its width near the end.
    pub(super) widening: f64,
}

impl Stalk {
    /// Whether point `i` of the ring is part of it.
    pub(super) fn holds(&self, i: usize) -> bool {
        if self.from <= self.to {
            (self.from..=self.to).contains(&i)
        } else {
            i >= self.from || i <= self.to
        }
    }
}

/// Wider than this, as a share of the root of the leaf's area, is a lobe.
const MOST_WIDTH: f64 = 0.16;
/// Shorter than this, in widths, is a tooth.
const LEAST_SLENDERNESS: f64 = 0.7;
/// Shorter than this, as a share of the root of the leaf's area, is a flaw of the outline.
const LEAST_LENGTH: f64 = 0.012;
/// The least width at a third of the length, over the typical width: a tip that grows evenly from
/// nothing has 0.56 there.
const LEAST_AT_THIRD: f64 = 0.7;
/// The width at which the stalk ends, over its own width.
const FLARED: f64 = 1.5;
/// The cut is made where the stalk is still this wide, over its own width.
const CUT_AT: f64 = 1.25;

/// The stalks of an anticlockwise ring of evenly spaced points, most slender first; no two share a
/// point. `size` is the root of the area.
pub(super) fn stalks(ring: &[DVec2], size: f64) -> Vec<Stalk> {
    let mut found: Vec<Stalk> = (0..ring.len()).filter_map(|end| zip(ring, end, size)).collect();
    found.sort_by(|a, b| b.slenderness.total_cmp(&a.slenderness));
    let mut apart: Vec<Stalk> = Vec::new();
    for stalk in found {
        let shared = |other: &Stalk| {
            other.holds(stalk.from) || other.holds(stalk.to) || stalk.holds(other.from)
        };
        if !apart.iter().any(shared) {
            apart.push(stalk);
        }
    }
    apart
}

/// One chord of the zip.
struct Chord {
    from: usize,
    to: usize,
    width: f64,
    /// Length of the zip's middle line up to here.
    depth: f64,
}

/// The stalk whose free end is point `end`, if that is the end of one.
fn zip(ring: &[DVec2], end: usize, size: f64) -> Option<Stalk> {
    let n = ring.len();
    let step = ring[0].distance(ring[1]);
    let (mut from, mut to) = (end, end);
    let mut chords: Vec<Chord> = vec![Chord { from, to, width: 0.0, depth: 0.0 }];
    let (mut middle, mut evened) = (ring[end], ring[end]);
    let most = 2.5 * MOST_WIDTH * size;
    while chords.len() < n / 2 {
        let (back, forth) = ((from + n - 1) % n, (to + 1) % n);
        let (a, b) = (ring[back].distance(ring[to]), ring[from].distance(ring[forth]));
        let width = if a < b {
            from = back;
            a
        } else {
            to = forth;
            b
        };
        let next = (ring[from] + ring[to]) * 0.5;
        // The banks advance in turns: over two steps the middle does not sway.
        let even = (middle + next) * 0.5;
        let depth = chords[chords.len() - 1].depth + even.distance(evened);
        (middle, evened) = (next, even);
        chords.push(Chord { from, to, width, depth });
        if width > most {
            break;
        }
    }
    // The width of what lies behind, blunt end left out; the stalk ends where the zip outgrows it.
    let mut typical = 0.0;
    let mut flared = None;
    let mut widths: Vec<f64> = Vec::new();
    let mut start = 0;
    for (k, chord) in chords.iter().enumerate() {
        widths.push(chord.width);
        if chord.depth < LEAST_LENGTH * size || chord.depth < 4.0 * step {
            continue;
        }
        while chords[start].depth < 0.25 * chord.depth {
            start += 1;
        }
        let mut behind = widths[start..=k].to_vec();
        let half = behind.len() / 2;
        typical = *behind.select_nth_unstable_by(half, f64::total_cmp).1;
        // The end may be wider than the rest.
        if typical > 1.5 * MOST_WIDTH * size {
            return None;
        }
        if chord.width > FLARED * typical {
            flared = Some(k);
            break;
        }
    }
    let flared = flared?;
    let cut = chords[..flared].iter().rposition(|c| c.width <= CUT_AT * typical)?;
    let attached = &chords[cut];
    let length = attached.depth;
    let too_short = length < (LEAST_SLENDERNESS * typical).max(LEAST_LENGTH * size);
    if too_short || typical > MOST_WIDTH * size {
        return None;
    }
    let third = chords.iter().find(|c| c.depth >= 0.35 * length)?;
    if third.width < LEAST_AT_THIRD * typical {
        return None;
    }
    // Both banks are as long, and the cut goes straight across; else the zip started beside a tip.
    let (one, other) = ((end + n - attached.from) % n, (attached.to + n - end) % n);
    let across = (ring[attached.to] - ring[attached.from]).normalize_or_zero();
    let along = ((ring[attached.to] + ring[attached.from]) * 0.5 - ring[end]).normalize_or_zero();
    if one.min(other) * 2 < one.max(other) || across.dot(along).abs() > 0.6 {
        return None;
    }
    // The two banks must enclose blade, not the gap between two lobes.
    let count = (attached.to + n - attached.from) % n;
    let body: Vec<DVec2> = (0..=count).map(|k| ring[(attached.from + k) % n]).collect();
    if polygon::signed_area(&body) < 0.4 * length * typical {
        return None;
    }
    let beyond = chords.iter().take_while(|c| c.depth <= length + 1.5 * typical).last()?;
    let near_blade = chords.iter().find(|c| c.depth >= 0.85 * length)?;
    Some(Stalk {
        widening: near_blade.width / third.width,
        from: attached.from,
        to: attached.to,
        attachment: (ring[attached.from] + ring[attached.to]) * 0.5,
        slenderness: length / typical,
        flare: beyond.width / typical,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A lens 2 long and 1 wide along y, its lower end at the origin.
    fn lens(stalk: Option<(f64, f64)>) -> Vec<DVec2> {
        let side = |x: f64| {
            (0..=200).map(move |i| {
                let t = f64::from(i) / 200.0;
                DVec2::new(x * 0.5 * (std::f64::consts::PI * t).sin(), 2.0 * t)
            })
        };
        let mut points: Vec<DVec2> = side(1.0).collect();
        points.extend(side(-1.0).rev());
        if let Some((length, width)) = stalk {
            let half = width / 2.0;
            points.retain(|p| p.y > half || p.x.abs() > half);
            points.push(DVec2::new(-half, -length));
            points.push(DVec2::new(half, -length));
        }
        polygon::resampled(&polygon::without_short_edges(&points, 1e-6), 0.005)
    }

    #[test]
    fn a_petiole_is_found_with_its_attachment() {
        for length in [0.06, 0.2, 0.6] {
            let found = stalks(&lens(Some((length, 0.05))), 1.1);
            assert_eq!(found.len(), 1, "{found:?}");
            assert!(found[0].attachment.length() < 0.05, "{found:?}");
            // The lens itself is no wider than the stalk up to y = 0.03.
            let expected = (length + 0.03) / 0.05;
            assert!((found[0].slenderness / expected - 1.0).abs() < 0.4, "{found:?}");
        }
    }

    #[test]
    fn tips_are_no_stalks() {
        assert_eq!(stalks(&lens(None), 1.1), []);
    }

    #[test]
    fn a_long_drip_tip_is_no_stalk() {
        let side = |x: f64| {
            (0..=300).map(move |i| {
                let t = f64::from(i) / 300.0;
                let width = if t < 0.6 {
                    (std::f64::consts::PI * t / 1.2).sin().sqrt()
                } else {
                    ((1.0 - t) / 0.4).powi(3)
                };
                DVec2::new(x * 0.5 * width, 2.5 * t)
            })
        };
        let mut points: Vec<DVec2> = side(1.0).collect();
        points.extend(side(-1.0).rev());
        let points = polygon::without_short_edges(&points, 1e-6);
        let ring = polygon::resampled(&points, 0.005);
        assert_eq!(stalks(&ring, 1.1), []);
    }
}
