//! Whether margins leap on the way from one to the other.
//!
//! Numbers in between make margins in between but at the switches of section 6.3: a waist counts as soon as
//! it lies above the valley beside it, and two lobes meet or do not.

use crate::geometry::deviation;
use crate::margin::Outline;

/// What moves less than this (lengths of the blade) between two places of the path is not looked into.
const FAR: f64 = 0.02;

/// So often the way between two such places is halved.
const HALVINGS: u32 = 6;

/// After that a leap is still this part of what it was; a way that leads on smoothly is a sixty-fourth.
const LEFT: f64 = 0.5;

/// Whether outlines of length 1 leap somewhere between places of the path. An outline that is none counts
/// as a leap.
pub(super) fn any(places: &[f64], outline: impl Fn(f64) -> Option<Outline>) -> bool {
    let outlines: Option<Vec<Outline>> = places.iter().map(|&u| outline(u)).collect();
    let Some(outlines) = outlines else { return true };
    places.windows(2).zip(outlines.windows(2)).any(|(place, pair)| {
        let first = apart(&pair[0], &pair[1]);
        if first < FAR {
            return false;
        }
        let ([mut low, mut high], mut ends) = ([place[0], place[1]], pair.to_vec());
        let mut now = first;
        for _ in 0..HALVINGS {
            let u = f64::midpoint(low, high);
            let Some(middle) = outline(u) else { return true };
            let [below, above] = [apart(&ends[0], &middle), apart(&middle, &ends[1])];
            if below > above {
                (high, ends[1], now) = (u, middle, below);
            } else {
                (low, ends[0], now) = (u, middle, above);
            }
        }
        now > LEFT * first
    })
}

/// How far the farthest point of either lies from the other.
fn apart(a: &Outline, b: &Outline) -> f64 {
    let farthest = |a: &Outline, b: &Outline| {
        deviation::to_polygon(&a.points, &b.points).into_iter().fold(0.0, f64::max)
    };
    farthest(a, b).max(farthest(b, a))
}
