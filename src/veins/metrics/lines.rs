//! The centre lines of a network on a grid, with their place within each pixel, so that distances
//! to them are good to a small part of a pixel.

use glam::DVec2;

use super::network::Network;
use crate::geometry::Rect;
use crate::raster::Grid;
use crate::raster::components::neighbours;
use crate::raster::distance::{NO_SITE, nearest_sites};

/// A grid laid over the plane: y down, pixel (0, 0) at the upper left.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    corner: DVec2,
    /// Side of a pixel.
    pub(super) pixel: f64,
    pub(super) width: usize,
    pub(super) height: usize,
}

/// Sides of a grid: what [`nearest_sites`] takes.
const MOST_SIDE: f64 = 16_000.0;

impl Frame {
    /// A frame around a box, of at most `most` pixels; pixels get larger than asked for if need be.
    pub(super) fn around(bounds: Rect, pixel: f64, most: f64) -> Self {
        // A pixel of room on every side.
        let size = bounds.size().max(DVec2::splat(pixel));
        let pixel = pixel.max((size.x * size.y / most).sqrt()).max(size.max_element() / MOST_SIDE);
        let cells = (size / pixel).ceil() + 2.0;
        Self {
            corner: DVec2::new(bounds.min.x - pixel, bounds.max.y + pixel),
            pixel,
            width: cells.x as usize,
            height: cells.y as usize,
        }
    }

    pub(super) fn pixel_from_leaf(&self, p: DVec2) -> DVec2 {
        let p = (p - self.corner) / self.pixel;
        DVec2::new(p.x, -p.y)
    }

    pub(super) fn leaf_from_pixel(&self, p: DVec2) -> DVec2 {
        self.corner + DVec2::new(p.x, -p.y) * self.pixel
    }
}

/// Centre lines drawn one pixel wide, each pixel touching the next at a side or a corner.
#[derive(Debug)]
pub(super) struct Lines {
    pub(super) frame: Frame,
    /// For pixels on a line, where in the pixel it runs, in 254ths; `OFF` elsewhere.
    places: Grid<[u8; 2]>,
}

const OFF: [u8; 2] = [255, 255];

impl Lines {
    pub(super) fn of(network: &Network, frame: Frame) -> Self {
        let mut places = Grid::filled(frame.width, frame.height, OFF);
        for segment in network.segments() {
            for pair in segment.path.windows(2) {
                let [a, b] = [pair[0], pair[1]].map(|p| frame.pixel_from_leaf(p));
                draw(&mut places, a, b);
            }
        }
        Self { frame, places }
    }

    pub(super) fn is_line(&self, pixel: usize) -> bool {
        self.places.values()[pixel] != OFF
    }

    /// The distance from the centre of every pixel to the nearest line, in pixels.
    ///
    /// The nearest pixel on a line need not be that of the nearest line, by up to a pixel where two
    /// lines are equally far: those of the four neighbours are tried too.
    pub(super) fn distances(&self) -> Grid<f32> {
        let Frame { width, height, .. } = self.frame;
        let nearest = nearest_sites(width, height, |i| self.is_line(i));
        let corner = |i: usize| DVec2::new((i % width) as f64, (i / width) as f64);
        let distance = |x: usize, y: usize| {
            let i = y * width + x;
            let to = |near: usize| match nearest.values()[near] {
                NO_SITE => f64::INFINITY,
                site => {
                    let [x, y] = self.places.values()[site as usize].map(|v| f64::from(v) / 254.0);
                    (corner(i) + 0.5).distance_squared(corner(site as usize) + DVec2::new(x, y))
                }
            };
            neighbours(i, width, height).map(to).fold(to(i), f64::min).sqrt() as f32
        };
        Grid::computed(width, height, distance)
    }
}

fn draw(places: &mut Grid<[u8; 2]>, a: DVec2, b: DVec2) {
    let steps = (b - a).abs().max_element().ceil().max(1.0);
    let (width, height) = (places.width(), places.height());
    for i in 0..=steps as usize {
        let p = a.lerp(b, i as f64 / steps);
        // What the frame was laid around lies within it, but for rounding.
        let (x, y) = (p.x as usize, p.y as usize);
        if x >= width || y >= height {
            continue;
        }
        let corner = DVec2::new(x as f64, y as f64);
        let nearest = crate::geometry::polygon::nearest_on_segment(a, b, corner + 0.5) - corner;
        // 255 would read as no line at all.
        let place = (nearest.clamp(DVec2::ZERO, DVec2::ONE) * 254.0).round();
        places[(x, y)] = [place.x as u8, place.y as u8];
    }
}
