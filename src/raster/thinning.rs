//! Strokes to lines: thinning to one pixel, then following the pixels.
//!
//! Source: Zhang & Suen, "A fast parallel algorithm for thinning digital patterns", CACM 27, 1984.

use super::Grid;
use crate::geometry::{DVec2, polygon};

/// The eight neighbours, clockwise from the one above.
pub(super) const AROUND: [(isize, isize); 8] =
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
#[must_use]
pub fn thinned(mask: &Grid<bool>) -> Grid<bool> {
    let mut thin = mask.clone();
    let (width, height) = (mask.width(), mask.height());
    let removable = [0, 1].map(|pass| std::array::from_fn(|code| is_removable(code, pass)));
    let all: Vec<u32> =
        (0..width * height).filter(|&i| mask.values()[i]).map(|i| i as u32).collect();
    // A pass judges a pixel as it did last time unless a neighbour went since, in the last pass or
    // the one before: only those are looked at again.
    let mut gone: [Vec<u32>; 2] = [Vec::new(), Vec::new()];
    let mut looked_at = Grid::filled(width, height, 0u32);
    for turn in 0.. {
        let table: &[bool; 256] = &removable[turn as usize % 2];
        let goes = |&i: &u32| table[surroundings(&thin, i as usize)];
        let goes: Vec<u32> = if turn < 2 {
            all.iter().copied().filter(|i| thin.values()[*i as usize] && goes(i)).collect()
        } else {
            let mut again = Vec::new();
            for &i in gone.iter().flatten() {
                let (x, y) = ((i as usize % width) as isize, (i as usize / width) as isize);
                for (dx, dy) in AROUND {
                    if thin.get(x + dx, y + dy) == Some(&true) {
                        let next = (y + dy) as usize * width + (x + dx) as usize;
                        if std::mem::replace(&mut looked_at.values_mut()[next], turn) != turn {
                            again.push(next as u32);
                        }
                    }
                }
            }
            again.into_iter().filter(goes).collect()
        };
        goes.iter().for_each(|&i| thin.values_mut()[i as usize] = false);
        gone[turn as usize % 2] = goes;
        if turn > 0 && gone.iter().all(Vec::is_empty) {
            break;
        }
    }
    thin
}

/// Which of the eight neighbours are set, a bit for each, clockwise from the one above.
fn surroundings(thin: &Grid<bool>, i: usize) -> usize {
    let (width, height) = (thin.width(), thin.height());
    let (x, y) = (i % width, i / width);
    if x > 0 && y > 0 && x + 1 < width && y + 1 < height {
        let values = thin.values();
        let (up, down) = (i - width, i + width);
        let at = [up, up + 1, i + 1, down + 1, down, down - 1, i - 1, up - 1];
        return at.iter().rev().fold(0, |code, &j| code * 2 + usize::from(values[j]));
    }
    AROUND.iter().rev().fold(0, |code, (dx, dy)| {
        code * 2 + usize::from(thin.get(x as isize + dx, y as isize + dy) == Some(&true))
    })
}

fn is_removable(code: usize, pass: usize) -> bool {
    let p: [bool; 8] = std::array::from_fn(|k| code >> k & 1 == 1);
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
