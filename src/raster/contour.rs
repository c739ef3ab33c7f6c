//! Contours of a field of numbers, to sub-pixel accuracy.
//!
//! Source: Lorensen & Cline, "Marching cubes", SIGGRAPH 1987, in two dimensions; saddles are decided
//! by the mean of the four corners. The centre of pixel (x, y) is at (x + 0.5, y + 0.5), y down.
//! Fairing: Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995, with
//! every point held within a fraction of a pixel of where it was found.

use std::collections::HashMap;

use super::Grid;
use crate::geometry::{DVec2, polygon};

/// The closed lines along which `field` passes through `level`; outside the grid it is below.
/// Simple, pairwise disjoint, first point not repeated; positive area (as numbers, y down) around
/// what is higher, negative around holes.
#[must_use]
pub fn contours(field: &Grid<f32>, level: f32) -> Vec<Vec<DVec2>> {
    let (width, height) = (field.width() as isize, field.height() as isize);
    let least = field.values().iter().copied().fold(level, f32::min);
    // As far below the level outside as the level is above the floor: the border is cut half way.
    let outside = least.min(level - 1e-3 * level.abs().max(1e-3));
    let value = |x: isize, y: isize| field.get(x, y).copied().unwrap_or(outside);
    let inside = |x: isize, y: isize| value(x, y) > level;
    // An edge between two pixel centres: from (x, y) to the right (0) or down (1).
    type Edge = (isize, isize, u8);
    let mut next: HashMap<Edge, Edge> = HashMap::new();
    let mut order: Vec<Edge> = Vec::new();
    for y in -1..height {
        for x in -1..width {
            let corners = [inside(x, y), inside(x + 1, y), inside(x + 1, y + 1), inside(x, y + 1)];
            let case = corners.iter().rev().fold(0, |bits, &on| bits * 2 + usize::from(on));
            if case == 0 || case == 15 {
                continue;
            }
            let (top, right) = ((x, y, 0), (x + 1, y, 1));
            let (bottom, left) = ((x, y + 1, 0), (x, y, 1));
            let mut join = |from: Edge, to: Edge| {
                next.insert(from, to);
                order.push(from);
            };
            let mean = || {
                (value(x, y) + value(x + 1, y) + value(x, y + 1) + value(x + 1, y + 1)) * 0.25
                    > level
            };
            // What is higher lies on the right of the direction on the screen, left as numbers.
            match case {
                1 => join(top, left),
                2 => join(right, top),
                3 => join(right, left),
                4 => join(bottom, right),
                6 => join(bottom, top),
                7 => join(bottom, left),
                8 => join(left, bottom),
                9 => join(top, bottom),
                11 => join(right, bottom),
                12 => join(left, right),
                13 => join(top, right),
                14 => join(left, top),
                5 if mean() => {
                    join(top, right);
                    join(bottom, left);
                }
                5 => {
                    join(top, left);
                    join(bottom, right);
                }
                _ if mean() => {
                    join(left, top);
                    join(right, bottom);
                }
                _ => {
                    join(right, top);
                    join(left, bottom);
                }
            }
        }
    }
    let place = |(x, y, down): Edge| {
        let (a, b) = (value(x, y), value(x + isize::from(down == 0), y + isize::from(down == 1)));
        // Off the pixel centres themselves, where two lines could touch.
        let along = f64::from((level - a) / (b - a)).clamp(1e-3, 1.0 - 1e-3);
        let centre = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
        centre + if down == 1 { DVec2::Y } else { DVec2::X } * along
    };
    let mut lines = Vec::new();
    for start in order {
        let mut line = Vec::new();
        let mut at = start;
        while let Some(to) = next.remove(&at) {
            line.push(place(at));
            at = to;
        }
        if line.len() > 2 {
            lines.push(line);
        }
    }
    lines
}

/// A point of a contour found to about this (px) may be moved by as much to make the line fair: the
/// steps of a mask without half tones are half a pixel high.
const FAIRING_PX: f64 = 0.5;
/// How far the simplified contour may leave the fair one (px).
const TOLERANCE_PX: f64 = 0.2;

/// The contour around the largest area, without stair-steps, as few points as its shape needs;
/// simple. `None` when nothing is above the level.
#[must_use]
pub fn largest_outline(field: &Grid<f32>, level: f32) -> Option<Vec<DVec2>> {
    let raw = contours(field, level)
        .into_iter()
        .max_by(|a, b| polygon::signed_area(a).total_cmp(&polygon::signed_area(b)))?;
    // Where the shape is only a pixel wide its two sides may get across each other: try with less.
    for share in [1.0, 0.5, 0.2] {
        let fair = faired(&polygon::resampled(&raw, 0.75), FAIRING_PX * share);
        let kept = polygon::simplified(&fair, TOLERANCE_PX * share, &[]);
        let outline: Vec<DVec2> = kept.into_iter().map(|i| fair[i]).collect();
        if outline.len() > 3 && polygon::self_crossing(&outline).is_none() {
            return Some(outline);
        }
    }
    Some(raw)
}

/// Smoothed without shrinking, each point within `reach` of where it was.
fn faired(points: &[DVec2], reach: f64) -> Vec<DVec2> {
    const ROUNDS: usize = 40;
    const SHRINK: f64 = 0.5;
    const GROW: f64 = -0.52;
    let n = points.len();
    let mut now = points.to_vec();
    let mut then = now.clone();
    for round in 0..2 * ROUNDS {
        let weight = if round % 2 == 0 { SHRINK } else { GROW };
        for i in 0..n {
            let middle = (now[(i + n - 1) % n] + now[(i + 1) % n]) * 0.5;
            let moved = now[i] + (middle - now[i]) * weight - points[i];
            then[i] = points[i] + moved.clamp_length_max(reach);
        }
        std::mem::swap(&mut now, &mut then);
    }
    now
}

#[cfg(test)]
mod tests {
    use super::*;

    fn disc(radius: f64, centre: DVec2, size: usize) -> Grid<f32> {
        let mut field = Grid::filled(size, size, 0.0f32);
        for y in 0..size {
            for x in 0..size {
                let p = DVec2::new(x as f64 + 0.5, y as f64 + 0.5);
                field[(x, y)] = if p.distance(centre) < radius { 1.0 } else { 0.0 };
            }
        }
        field
    }

    #[test]
    fn a_ring_has_two_lines_that_turn_opposite_ways() {
        let centre = DVec2::splat(20.0);
        let mut field = disc(15.0, centre, 40);
        for (value, hole) in field.values_mut().iter_mut().zip(disc(6.0, centre, 40).values()) {
            *value -= hole;
        }
        let mut areas: Vec<f64> =
            contours(&field, 0.5).iter().map(|line| polygon::signed_area(line)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 2);
        assert!(areas[0] < -90.0 && areas[1] > 650.0, "{areas:?}");
    }

    #[test]
    fn a_shape_cut_by_the_border_is_closed_there() {
        let field = Grid::filled(6, 4, 1.0f32);
        let lines = contours(&field, 0.5);
        assert_eq!(lines.len(), 1);
        assert!(polygon::signed_area(&lines[0]) > 20.0);
    }

    #[test]
    fn a_disc_without_half_tones_comes_out_round() {
        let centre = DVec2::new(100.3, 99.6);
        let outline = largest_outline(&disc(83.7, centre, 200), 0.5).expect("a disc");
        let worst = outline.iter().map(|p| (p.distance(centre) - 83.7).abs()).fold(0.0, f64::max);
        assert!(worst < 0.45, "{worst} px off the circle");
        assert!((20..200).contains(&outline.len()), "{} points", outline.len());
        // No stair-steps: every turn is a gentle left.
        let n = outline.len();
        for i in 0..n {
            let before = outline[i] - outline[(i + n - 1) % n];
            let after = outline[(i + 1) % n] - outline[i];
            assert!(before.angle_to(after).abs() < 0.35, "turn at {}", outline[i]);
        }
    }

    #[test]
    fn a_checkerboard_gives_simple_lines() {
        let mut field = Grid::filled(9, 9, 0.0f32);
        for y in 0..9 {
            for x in 0..9 {
                field[(x, y)] = ((x + y) % 2) as f32;
            }
        }
        for line in contours(&field, 0.4) {
            assert_eq!(polygon::self_crossing(&line), None);
        }
    }
}
