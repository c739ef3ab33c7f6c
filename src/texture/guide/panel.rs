//! The panels of the blade between its larger veins, which arch.

use std::ops::Range;

use super::between;
use super::smooth::refined;
use crate::raster::Grid;
use crate::raster::smooth::gaussian;

/// A panel has risen half way at this distance from its veins (mm).
const HALF_MM: f32 = 3.0;

/// Its ridges and valleys are rounded over so much (mm).
const ROUND_MM: f64 = 0.9;

/// How far panels have risen, 0 at a larger vein and towards 1 far from any, on the nodes of a lattice with the
/// distances to these veins (mm) on it. `spans` are the nodes where the distances are known.
pub(super) fn panels(
    side: usize,
    spacing_mm: f64,
    major: &[f32],
    spans: &[Range<usize>],
) -> Vec<f32> {
    // With half as many nodes: nothing here is narrower than they are, and read back between them it
    // bends less sharply than it would on all of them.
    let half = (side / 2).max(2);
    let per_node = side as f32 / half as f32;
    let (mut known, mut risen) = (Grid::filled(half, half, 0.0), Grid::filled(half, half, 0.0));
    for y in 0..half {
        for x in 0..half {
            // Of the four nodes around, those that are known.
            let corner = [x, y].map(|i| between(i, per_node, side).0);
            for (column, row) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let (column, row) = (corner[0] + column, corner[1] + row);
                if spans[row].contains(&column) {
                    let distance = major[row * side + column];
                    known[(x, y)] += 1.0;
                    risen[(x, y)] += distance / (distance + HALF_MM);
                }
            }
        }
    }
    let sigma = ROUND_MM / (spacing_mm * f64::from(per_node));
    let (known, mut risen) = (gaussian(&known, sigma), gaussian(&risen, sigma));
    // Outside nothing is known: the margin rises like what lies inside of it.
    for (risen, known) in risen.values_mut().iter_mut().zip(known.values()) {
        *risen = if *known > 0.0 { *risen / known } else { 0.0 };
    }
    refined(risen.values(), half, side)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Distances to a vein down the middle of a lattice.
    fn beside_a_vein(side: usize, spacing: f32) -> Vec<f32> {
        let from_middle = |x: usize| (x as f32 + 0.5 - 0.5 * side as f32).abs() * spacing;
        (0..side * side).map(|i| from_middle(i % side)).collect()
    }

    #[test]
    fn panels_rise_from_the_vein_and_bend_nowhere_sharply() {
        let (side, spacing) = (128, 0.2);
        let major = beside_a_vein(side, spacing);
        let panels = panels(side, f64::from(spacing), &major, &vec![0..side; side]);
        let row = &panels[64 * side..65 * side];
        assert!(row[64] < 0.25, "{}", row[64]);
        let slopes: Vec<f32> = row[64..].windows(2).map(|w| (w[1] - w[0]) / spacing).collect();
        assert!(slopes.iter().all(|slope| *slope >= 0.0), "{slopes:?}");
        // A cone would turn by 2 / HALF_MM within one node.
        let bend = slopes.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f32::max);
        assert!(bend < 0.25 / HALF_MM, "{bend}");
        let end = row[side - 1];
        assert!((0.7..1.0).contains(&end), "{end}");
    }

    #[test]
    fn what_lies_outside_raises_no_margin() {
        let (side, spacing) = (64, 0.3);
        let mut major = beside_a_vein(side, spacing);
        let spans = vec![10..40; side];
        let inside = panels(side, f64::from(spacing), &major, &spans);
        for (i, distance) in major.iter_mut().enumerate() {
            if !spans[0].contains(&(i % side)) {
                *distance = 1e4;
            }
        }
        assert_eq!(inside, panels(side, f64::from(spacing), &major, &spans));
        let known = inside.iter().enumerate().filter(|(i, _)| spans[0].contains(&(i % side)));
        assert!(known.into_iter().all(|(_, panel)| *panel > 0.0 && *panel < 1.0));
    }
}
