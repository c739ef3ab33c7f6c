//! Crumbs: what wounds leave hanging on nothing once a leaf has become texels.
//!
//! The wounds have let fall what nothing holds (see [`super::damage`]), but necks that are there may be
//! finer than a texel. Of every piece that the whole blade has on its texture the largest part stays,
//! with what hangs on it by half-covered texels if that is large; crumbs go from every map.

use std::collections::VecDeque;

use super::side::SideMaps;
use crate::raster::Grid;
use crate::raster::components::{Components, neighbours_of_eight};

/// Texels covered at least so far are seen by an alpha test at one half.
const SEEN: u8 = 128;

/// What is cut off by less than a texel and as large as this share of its piece is no crumb.
const LARGE: f64 = 0.01;

/// Clears crumbs on both sides, the back being mirrored.
pub(super) fn clear(front: &mut SideMaps, back: &mut SideMaps, crumbs: &[usize]) {
    let size = front.size();
    for i in crumbs {
        let (x, y) = (i % size, i / size);
        front.clear(y * size + x);
        back.clear(y * size + size - 1 - x);
    }
}

/// The texels of a front that are crumbs. `whole` is how far the texels were covered (255 for all) before there
/// were wounds, `bare` says where only veins are left: fine ones hold one another however faint.
pub(super) fn find(
    picture: &Grid<[u8; 4]>,
    whole: &Grid<u8>,
    bare: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    let size = picture.width();
    let alpha = |i: usize| picture.values()[i][3];
    let hurt = |i: usize| alpha(i).saturating_add(1) < whole.values()[i];
    let solid = |i: usize| alpha(i) >= SEEN || (alpha(i) > 0 && bare(i % size, i / size));
    let around = |i: usize| neighbours_of_eight(i, size, size);
    let pieces = Components::of_eight(size, size, |i| whole.values()[i] >= SEEN || solid(i));
    let mut parts = Components::of_eight(size, size, solid);
    let connected = Components::of_eight(size, size, |i| alpha(i) > 0);
    let piece_and_part = |parts: &Components, i: usize| {
        (pieces.labels.values()[i] as usize, parts.labels.values()[i] as usize)
    };
    let connected_at = |i: usize| connected.labels.values()[i] as usize;

    // The largest part of every piece.
    let mut largest = vec![0; pieces.areas.len()];
    for i in 0..size * size {
        let (piece, part) = piece_and_part(&parts, i);
        let best = largest[piece];
        if part > 0 && (best == 0 || parts.areas[part] > parts.areas[best]) {
            largest[piece] = part;
        }
    }
    // What else stays: large parts that hang on it, and what no wound has cut off.
    let mut stays = vec![false; parts.areas.len()];
    let mut cut_off = vec![false; parts.areas.len()];
    let mut holds = vec![false; connected.areas.len()];
    for i in 0..size * size {
        let (piece, part) = piece_and_part(&parts, i);
        if part > 0 && largest[piece] == part {
            stays[part] = true;
            holds[connected_at(i)] = true;
        }
        if part > 0 {
            cut_off[part] |= hurt(i) || around(i).any(&hurt);
        }
    }
    for i in 0..size * size {
        let (piece, part) = piece_and_part(&parts, i);
        if part > 0 && !stays[part] {
            let large = parts.areas[part] as f64 >= LARGE * pieces.areas[piece] as f64;
            let hangs = holds[connected_at(i)];
            stays[part] = !cut_off[part] || (large && hangs);
        }
    }
    // Faint texels go with the part that they are nearest to; those near none were a wound's rim.
    let nearest = parts.labels.values_mut();
    let faint = |nearest: &[u32], i: usize| nearest[i] == 0 && alpha(i) > 0;
    let borders = |&i: &usize| nearest[i] > 0 && around(i).any(|j| faint(nearest, j));
    let mut queue: VecDeque<usize> = (0..size * size).filter(borders).collect();
    while let Some(i) = queue.pop_front() {
        for next in around(i) {
            if faint(nearest, next) {
                nearest[next] = nearest[i];
                queue.push_back(next);
            }
        }
    }
    let mut sound = vec![true; connected.areas.len()];
    for i in (0..size * size).filter(|&i| alpha(i) > 0 && nearest[i] == 0) {
        sound[connected_at(i)] &= !hurt(i) && !around(i).any(&hurt);
    }
    let gone = |i: &usize| {
        let i = *i;
        alpha(i) > 0
            && match nearest[i] as usize {
                0 => !sound[connected_at(i)],
                part => !stays[part],
            }
    };
    (0..size * size).filter(gone).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of `#` covered, `+` half covered, `.` empty.
    fn picture(rows: &[&str]) -> Grid<[u8; 4]> {
        let alpha = |c: u8| match c {
            b'#' => 255,
            b'+' => 60,
            _ => 0,
        };
        let texels = rows.iter().flat_map(|row| row.bytes().map(|c| [9, 9, 9, alpha(c)]));
        Grid::from_values(rows.len(), rows.len(), texels.collect())
    }

    fn crumbs(rows: &[&str], whole: &Grid<u8>, bare: bool) -> Vec<usize> {
        find(&picture(rows), whole, |_, _| bare)
    }

    #[test]
    fn what_hangs_on_nothing_goes_with_its_rim() {
        let rows = [
            "####....", "####....", "####..++", "####..+#", "####....", "####....", "###+....",
            "####....",
        ];
        let whole = Grid::filled(8, 8, 255);
        assert_eq!(crumbs(&rows, &whole, false), [22, 23, 30, 31]);
    }

    #[test]
    fn what_was_apart_before_stays() {
        let rows = ["###..", "###..", "###.#", "###..", "###.."];
        let whole = picture(&rows).map(|texel| texel[3]);
        assert!(crumbs(&rows, &whole, false).is_empty());
    }

    #[test]
    fn large_parts_and_skeletons_hang_on_faint_texels() {
        let rows = [
            "###..###", "###..###", "###++###", "###..###", "###..###", "###.....", "###+++#.",
            "###.....",
        ];
        let whole = Grid::filled(8, 8, 255);
        assert_eq!(crumbs(&rows, &whole, false), [] as [usize; 0]);
        let crumb = [
            "###.....", "###.....", "###.....", "###...+.", "###.....", "###.....", "###.....",
            "###.....",
        ];
        assert_eq!(crumbs(&crumb, &whole, false), [30]);
        assert!(crumbs(&rows, &whole, true).is_empty());
    }
}
