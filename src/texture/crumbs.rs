//! Crumbs: what wounds leave hanging on nothing once a leaf has become texels.
//!
//! The wounds have let fall what nothing holds (see [`super::damage`]), but necks that are there may be
//! finer than a texel. Of every piece that the whole blade has on its texture the largest part stays,
//! with what hangs on it by half-covered texels if that is large; crumbs go from every map.

use std::collections::VecDeque;

use super::side::SideMaps;
use crate::raster::Grid;

/// Texels covered at least so far are seen by an alpha test at one half.
const SEEN: u8 = 128;

/// What is cut off by less than a texel and as large as this share of its piece is no crumb.
const LARGE: f64 = 0.01;

/// Finds the crumbs and clears them on both sides, the back being mirrored. `whole` is how far the
/// texels were covered (255 for all) before there were wounds, `bare` says where only veins are left: fine ones hold
/// one another however faint.
pub(super) fn clear(
    front: &mut SideMaps,
    back: &mut SideMaps,
    whole: &Grid<u8>,
    bare: impl Fn(usize, usize) -> bool,
) {
    let crumbs = find(&front.base_colour, whole, bare);
    let size = front.size();
    for i in crumbs {
        let (x, y) = (i % size, i / size);
        front.clear(y * size + x);
        back.clear(y * size + size - 1 - x);
    }
}

fn find(
    picture: &Grid<[u8; 4]>,
    whole: &Grid<u8>,
    bare: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    let size = picture.width();
    let alpha = |i: usize| picture.values()[i][3];
    let hurt = |i: usize| alpha(i).saturating_add(1) < whole.values()[i];
    let solid = |i: usize| alpha(i) >= SEEN || (alpha(i) > 0 && bare(i % size, i / size));
    let pieces = labelled(size, |i| whole.values()[i] >= SEEN || solid(i));
    let parts = labelled(size, solid);
    let connected = labelled(size, |i| alpha(i) > 0);

    // The largest part of every piece.
    let mut largest = vec![0; pieces.areas.len()];
    for i in 0..size * size {
        let (piece, part) = (pieces.labels[i] as usize, parts.labels[i] as usize);
        if part > 0 && parts.areas[part] > parts.areas[largest[piece]] {
            largest[piece] = part;
        }
    }
    // What else stays: large parts that hang on it, and what no wound has cut off.
    let mut stays = vec![false; parts.areas.len()];
    let mut cut_off = vec![false; parts.areas.len()];
    let mut holds = vec![false; connected.areas.len()];
    for i in 0..size * size {
        let (piece, part) = (pieces.labels[i] as usize, parts.labels[i] as usize);
        if part > 0 && largest[piece] == part {
            stays[part] = true;
            holds[connected.labels[i] as usize] = true;
        }
        if part > 0 {
            cut_off[part] |= hurt(i) || around(i, size).any(&hurt);
        }
    }
    for i in 0..size * size {
        let (piece, part) = (pieces.labels[i] as usize, parts.labels[i] as usize);
        if part > 0 && !stays[part] {
            let large = parts.areas[part] as f64 >= LARGE * pieces.areas[piece] as f64;
            let hangs = holds[connected.labels[i] as usize];
            stays[part] = !cut_off[part] || (large && hangs);
        }
    }
    // Faint texels go with the part that they are nearest to; those near none were a wound's rim.
    let mut nearest = parts.labels;
    let faint = |nearest: &[u32], i: usize| nearest[i] == 0 && alpha(i) > 0;
    let borders = |&i: &usize| nearest[i] > 0 && around(i, size).any(|j| faint(&nearest, j));
    let mut queue: VecDeque<usize> = (0..size * size).filter(borders).collect();
    while let Some(i) = queue.pop_front() {
        for next in around(i, size) {
            if faint(&nearest, next) {
                nearest[next] = nearest[i];
                queue.push_back(next);
            }
        }
    }
    let mut sound = vec![true; connected.areas.len()];
    for i in (0..size * size).filter(|&i| alpha(i) > 0 && nearest[i] == 0) {
        sound[connected.labels[i] as usize] &= !hurt(i) && !around(i, size).any(&hurt);
    }
    let gone = |i: &usize| {
        let i = *i;
        alpha(i) > 0
            && match nearest[i] as usize {
                0 => !sound[connected.labels[i] as usize],
                part => !stays[part],
            }
    };
    (0..size * size).filter(gone).collect()
}

/// The regions of a mask over 8 neighbours: the number of each texel's, 0 for none, and their areas.
struct Regions {
    labels: Vec<u32>,
    areas: Vec<usize>,
}

fn labelled(size: usize, mask: impl Fn(usize) -> bool) -> Regions {
    let mut regions = Regions { labels: vec![0; size * size], areas: vec![0] };
    let mut open = Vec::new();
    for start in 0..size * size {
        if regions.labels[start] != 0 || !mask(start) {
            continue;
        }
        let label = regions.areas.len() as u32;
        regions.labels[start] = label;
        regions.areas.push(0);
        open.push(start);
        while let Some(i) = open.pop() {
            regions.areas[label as usize] += 1;
            for next in around(i, size) {
                if regions.labels[next] == 0 && mask(next) {
                    regions.labels[next] = label;
                    open.push(next);
                }
            }
        }
    }
    regions
}

/// The eight texels around one, as far as there are.
fn around(i: usize, size: usize) -> impl Iterator<Item = usize> {
    let (x, y) = (i % size, i / size);
    let (columns, rows) =
        (x.saturating_sub(1)..(x + 2).min(size), y.saturating_sub(1)..(y + 2).min(size));
    rows.flat_map(move |row| columns.clone().map(move |column| row * size + column))
        .filter(move |&next| next != i)
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
