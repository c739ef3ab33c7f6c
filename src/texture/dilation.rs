//! Spreads a leaf over the empty texels around it, so that filters and mipmaps find leaf there.
//!
//! The source is the nearest fully covered texel: half-covered ones would smear the fringe.

use super::SideMaps;
use crate::raster::Grid;
use crate::raster::distance::{NO_SITE, nearest_sites};

/// The normal of a plain surface.
const FLAT: [u8; 3] = [128, 128, 255];

/// Fills both sides of a leaf, which cover the same texels.
pub(super) fn spread(sides: [&mut SideMaps; 2]) {
    let alpha = sides[0].base_colour.map(|colour| colour[3]);
    let (width, height) = (alpha.width(), alpha.height());
    let nearest = nearest_sites(width, height, |i| alpha.values()[i] == u8::MAX);
    let from = |i: usize| {
        let site = nearest.values()[i];
        (alpha.values()[i] == 0 && site != NO_SITE).then_some(site as usize)
    };
    for side in sides {
        fill(&mut side.base_colour, from, |texel, source| {
            let [r, g, b, _] = source;
            *texel = [r, g, b, 0];
        });
        fill(&mut side.height, from, |texel, source| *texel = source);
        // A flat normal does no harm in a mipmap; the sides of a round petiole, spread, would.
        fill(&mut side.normal, from, |texel, _| *texel = FLAT);
        fill(&mut side.bump, from, |texel, source| *texel = source);
    }
}

fn fill<T: Copy + Send + Sync>(
    grid: &mut Grid<T>,
    from: impl Fn(usize) -> Option<usize>,
    put: impl Fn(&mut T, T),
) {
    for i in 0..grid.values().len() {
        if let Some(source) = from(i) {
            let source = grid.values()[source];
            put(&mut grid.values_mut()[i], source);
        }
    }
}
