//! Flood fill over 4-neighbours, and where a fill that reaches the border squeezed through.
//!
//! Two pixels that meet at a corner only are not connected, so a diagonal stroke one pixel wide
//! holds.

use std::collections::BinaryHeap;

use super::components::neighbours;
use super::{Grid, chamfer};

/// Everything that is open and connected to the border.
#[must_use]
pub fn from_border(open: &Grid<bool>) -> Grid<bool> {
    let (width, height) = (open.width(), open.height());
    let edge = (0..width * height).filter(|&i| on_border(i, width, height));
    fill(open, edge)
}

/// Everything that is open and connected to the pixel `(x, y)`.
#[must_use]
pub fn from(open: &Grid<bool>, (x, y): (usize, usize)) -> Grid<bool> {
    fill(open, std::iter::once(y * open.width() + x))
}

fn fill(open: &Grid<bool>, starts: impl Iterator<Item = usize>) -> Grid<bool> {
    let (width, height) = (open.width(), open.height());
    let mut filled = Grid::filled(width, height, false);
    let mut waiting = Vec::new();
    for start in starts {
        if open.values()[start] && !filled.values()[start] {
            filled.values_mut()[start] = true;
            waiting.push(start);
        }
        while let Some(i) = waiting.pop() {
            for next in neighbours(i, width, height) {
                if open.values()[next] && !filled.values()[next] {
                    filled.values_mut()[next] = true;
                    waiting.push(next);
                }
            }
        }
    }
    filled
}

fn on_border(i: usize, width: usize, height: usize) -> bool {
    let (x, y) = (i % width, i / width);
    x == 0 || y == 0 || x + 1 == width || y + 1 == height
}

/// A gap in a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Gap {
    /// Column of its middle.
    pub x: usize,
    /// Row of its middle.
    pub y: usize,
    /// How wide it is, roughly (px).
    pub width: f64,
}

/// Where a fill from `start` leaks to the border: the narrowest place of the widest way out. `None`
/// when the border cannot be reached.
#[must_use]
pub fn leak(open: &Grid<bool>, start: (usize, usize)) -> Option<Gap> {
    let (width, height) = (open.width(), open.height());
    let clearance = chamfer::distance_to(width, height, |i| !open.values()[i]);
    let room = |i: usize| clearance.values()[i].min(chamfer::NEVER);
    // Always on through the roomiest pixel at hand (Prim): every way found is the widest there is.
    let start = start.1 * width + start.0;
    let mut came_from = vec![usize::MAX; width * height];
    let mut heap = BinaryHeap::from([(room(start), start, start)]);
    while let Some((_, i, from)) = heap.pop() {
        if came_from[i] != usize::MAX {
            continue;
        }
        came_from[i] = from;
        if on_border(i, width, height) {
            return Some(narrowest(i, start, &came_from, &clearance));
        }
        for next in neighbours(i, width, height) {
            if open.values()[next] && came_from[next] == usize::MAX {
                heap.push((room(next), next, i));
            }
        }
    }
    None
}

/// The narrowest place of the way to `end`, against the room that there was before it: a start close
/// to the wall is no gap.
fn narrowest(end: usize, start: usize, came_from: &[usize], clearance: &Grid<u32>) -> Gap {
    let mut way = vec![end];
    while way[way.len() - 1] != start {
        way.push(came_from[way[way.len() - 1]]);
    }
    let mut roomiest = 1;
    let mut best = (f64::INFINITY, end);
    for &i in way.iter().rev() {
        let room = clearance.values()[i];
        roomiest = roomiest.max(room);
        let share = f64::from(room) / f64::from(roomiest);
        if share < best.0 {
            best = (share, i);
        }
    }
    let room = f64::from(clearance.values()[best.1]) / f64::from(chamfer::PIXEL);
    let (x, y) = (best.1 % clearance.width(), best.1 / clearance.width());
    Gap { x, y, width: 2.0 * room - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of ink from (5, 5) to (34, 24) in a picture of 40 × 30; what is open.
    fn boxed() -> Grid<bool> {
        let mut open = Grid::filled(40, 30, true);
        for x in 5..35 {
            open[(x, 5)] = false;
            open[(x, 24)] = false;
        }
        for y in 5..25 {
            open[(5, y)] = false;
            open[(34, y)] = false;
        }
        open
    }

    #[test]
    fn a_closed_box_holds_the_fill() {
        let open = boxed();
        let inside = from(&open, (20, 20)).values().iter().filter(|&&v| v).count();
        assert_eq!(inside, 28 * 18);
        let outside = from_border(&open).values().iter().filter(|&&v| v).count();
        assert_eq!(outside, 40 * 30 - 30 * 20);
        assert_eq!(leak(&open, (20, 20)), None);
    }

    #[test]
    fn a_leak_is_named_where_the_wall_is_open() {
        let mut open = boxed();
        for y in 12..15 {
            open[(34, y)] = true;
        }
        for start in [(20, 20), (6, 6)] {
            let gap = leak(&open, start).expect("it leaks");
            assert!(gap.x.abs_diff(34) <= 1 && gap.y == 13, "{gap:?}");
            assert!((2.0..=4.0).contains(&gap.width), "{gap:?}");
        }
    }
}
