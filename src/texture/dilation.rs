//! Spreads a leaf over the empty texels around it, so that filters and mipmaps find leaf there.
//!
//! The source is the nearest fully covered texel: half-covered ones would smear the fringe.

use super::side::SideMaps;
use crate::raster::distance::{NO_SITE, nearest_sites};

/// Fills both sides of a leaf, which cover the same texels, the back mirrored.
pub(super) fn spread(front: &mut SideMaps, back: &mut SideMaps) {
    let size = front.size();
    let alpha = |i: usize, side: &SideMaps| side.base_colour.values()[i][3];
    let nearest = nearest_sites(size, size, |i| alpha(i, front) == u8::MAX);
    // Who needs a source is written down first, so that the planes are free to change.
    let sources: Vec<u32> = nearest
        .values()
        .iter()
        .enumerate()
        .map(|(i, &site)| if alpha(i, front) == 0 { site } else { NO_SITE })
        .collect();
    drop(nearest);
    let from =
        |i: usize| Some(sources[i]).filter(|&site| site != NO_SITE).map(|site| site as usize);
    front.spread(from);
    let mirrored = |i: usize| i - i % size + size - 1 - i % size;
    back.spread(|i| from(mirrored(i)).map(mirrored));
}
