//! Strokes to lines: thinning to one pixel, then following the pixels.
//!
//! Source: Zhang & Suen, "A fast parallel algorithm for thinning digital patterns", CACM 27, 1984.

use super::Grid;
use crate::geometry::{DVec2, polygon};

/// The eight neighbours, clockwise from the one above.
const AROUND: [(isize, isize); 8] =
    [(0, -1), (1, -1), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1)];

/// The centre lines of the strokes of `mask`, from ends and forks to ends and forks, at least
/// `least` pixels long. A closed ring without a fork ends where it starts. Pixel (x, y) has its
/// centre at (x + 0.5, y + 0.5).
#[must_use]
pub fn centre_lines(mask: &Grid<bool>, least: usize) -> Vec<Vec<DVec2>> {
    let thin = thinned(mask);
    let (width, height) = (thin.width(), thin.height());
    let set = |x: isize, y: isize| thin.get(x, y).copied().unwrap_or(false);
    // A diagonal step counts only where no pair of straight steps does the same.
    let links = |(x, y): (isize, isize)| -> Vec<(isize, isize)> {
        AROUND
            .iter()
            .filter(|&&(dx, dy)| {
                let around_corner = dx != 0 && dy != 0 && (set(x + dx, y) || set(x, y + dy));
                set(x + dx, y + dy) && !around_corner
            })
            .map(|&(dx, dy)| (x + dx, y + dy))
            .collect()
    };
    let mut walked = std::collections::HashSet::new();
    let mut lines = Vec::new();
    let pixels: Vec<(isize, isize)> = (0..width * height)
        .filter(|&i| thin.values()[i])
        .map(|i| ((i % width) as isize, (i / width) as isize))
        .collect();
    // From ends and forks first; what is left then are rings.
    for rings in [false, true] {
        for &start in &pixels {
            let from = links(start);
            if !rings && from.len() == 2 {
                continue;
            }
            for first in from {
                if !walked.insert((start, first)) {
                    continue;
                }
                walked.insert((first, start));
                let mut line = vec![start, first];
                loop {
                    let (before, at) = (line[line.len() - 2], line[line.len() - 1]);
                    let onward = links(at);
                    let Some(&next) = onward.iter().find(|&&p| p != before) else { break };
                    if onward.len() != 2 || !walked.insert((at, next)) {
                        break;
                    }
                    walked.insert((next, at));
                    line.push(next);
                }
                if line.len() >= least {
                    lines.push(smoothed(&line));
                }
            }
        }
    }
    lines
}

/// The pixels as points, the steps between them evened out; ends stay.
fn smoothed(pixels: &[(isize, isize)]) -> Vec<DVec2> {
    let raw: Vec<DVec2> =
        pixels.iter().map(|&(x, y)| DVec2::new(x as f64 + 0.5, y as f64 + 0.5)).collect();
    let mut points = raw.clone();
    for _ in 0..4 {
        let before = points.clone();
        for i in 1..points.len() - 1 {
            points[i] = before[i] * 0.5 + (before[i - 1] + before[i + 1]) * 0.25;
        }
    }
    let mut kept = vec![points[0]];
    simplify(&points, 0.4, &mut kept);
    kept
}

/// Douglas–Peucker on an open line; appends all but the first point.
fn simplify(line: &[DVec2], tolerance: f64, kept: &mut Vec<DVec2>) {
    let mut open = vec![(0, line.len() - 1)];
    while let Some((start, end)) = open.pop() {
        let off = |i: usize| {
            line[i].distance(polygon::nearest_on_segment(line[start], line[end], line[i]))
        };
        let worst = (start + 1..end).max_by(|&i, &j| off(i).total_cmp(&off(j)));
        match worst {
            Some(i) if off(i) > tolerance => open.extend([(i, end), (start, i)]),
            _ => kept.push(line[end]),
        }
    }
}

/// The mask thinned to lines one pixel wide, as connected as before.
fn thinned(mask: &Grid<bool>) -> Grid<bool> {
    let mut thin = mask.clone();
    let (width, height) = (mask.width(), mask.height());
    let mut left: Vec<(usize, usize)> =
        (0..width * height).filter(|&i| mask.values()[i]).map(|i| (i % width, i / width)).collect();
    loop {
        let before = left.len();
        for pass in 0..2 {
            let goes: Vec<(usize, usize)> =
                left.iter().copied().filter(|&p| removable(&thin, p, pass)).collect();
            for &p in &goes {
                thin[p] = false;
            }
            left.retain(|&p| thin[p]);
        }
        if left.len() == before {
            return thin;
        }
    }
}

fn removable(thin: &Grid<bool>, (x, y): (usize, usize), pass: usize) -> bool {
    let p =
        AROUND.map(|(dx, dy)| thin.get(x as isize + dx, y as isize + dy).copied().unwrap_or(false));
    let count = p.iter().filter(|&&on| on).count();
    let rises = (0..8).filter(|&k| !p[k] && p[(k + 1) % 8]).count();
    let [above, _, right, _, below, _, left, _] = p;
    let sides = if pass == 0 {
        !(right && below && (above || left))
    } else {
        !(above && left && (right || below))
    };
    (2..=6).contains(&count) && rises == 1 && sides
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_thick_bar_becomes_its_middle_line() {
        let mut mask = Grid::filled(40, 20, false);
        for y in 8..13 {
            for x in 5..35 {
                mask[(x, y)] = true;
            }
        }
        let lines = centre_lines(&mask, 3);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(lines[0].iter().all(|p| (p.y - 10.5).abs() <= 1.0), "{lines:?}");
        assert!(lines[0][0].distance(lines[0][lines[0].len() - 1]) > 22.0, "{lines:?}");
    }

    #[test]
    fn a_ring_comes_back_to_its_start() {
        let mut mask = Grid::filled(40, 40, false);
        for y in 0..40 {
            for x in 0..40 {
                let r = (x as f64 - 20.0).hypot(y as f64 - 20.0);
                mask[(x, y)] = (10.0..13.0).contains(&r);
            }
        }
        let lines = centre_lines(&mask, 3);
        assert_eq!(lines.len(), 1, "{lines:?}");
        assert!(lines[0].len() > 8 && lines[0][0].distance(*lines[0].last().unwrap()) < 1.5);
    }

    #[test]
    fn a_cross_is_four_lines() {
        let mut mask = Grid::filled(41, 41, false);
        for i in 5..36 {
            mask[(i, 20)] = true;
            mask[(20, i)] = true;
        }
        assert_eq!(centre_lines(&mask, 3).len(), 4);
    }
}
