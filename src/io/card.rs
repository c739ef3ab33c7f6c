//! The leaf as a card: two flat sheets, the upper side in front and the lower side behind.
//!
//! Every format with a mesh draws these sheets; their own axes and units are the formats' affair. A
//! material cannot have other pictures for the back of a face anywhere, so each side is a sheet of
//! its own, a little apart.

use glam::DVec2;

use crate::geometry::{polygon, triangulate};
use crate::raster::Grid;
use crate::raster::contour;
use crate::raster::distance::{NO_SITE, nearest_sites};
use crate::spec::CardShape;
use crate::units::TextureFrame;

/// How far behind the front sheet the back sheet lies, as a share of the side. In one plane the two
/// would flicker wherever back faces are not culled, which is the default in Blender; of a leaf of
/// 100 mm this is 0.2 mm, about the thickness of a blade and more than a depth buffer confuses at
/// any distance from which the leaf is larger than a few pixels.
const GAP: f64 = 1.0 / 500.0;

/// The lower side has this share of the upper side's shine (Foster 2014).
const BACK_SHINE: f64 = 1.0 / 3.0;

/// How far the cut-out may stand off the leaf (share of the side): its slack for simplifying, and
/// room for a few mip levels' blur.
const SLACK: f64 = 1.0 / 128.0;

/// Outlines are traced on pictures no larger than this (pixels): the slack is then still 8 texels.
const TRACED_PX: usize = 1024;

/// The shape of a sheet.
///
/// # Guarantees
///
/// - Triangles run anticlockwise as seen from the front, none is without area, they do not overlap.
/// - Points lie in the square of the textures.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    /// Corners on the front picture: u to the right, v up, 0–1.
    pub points: Vec<DVec2>,
    /// Three corners each.
    pub triangles: Vec<[u32; 3]>,
}

/// A side of the card.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The upper (adaxial) side.
    Front,
    /// The lower (abaxial) side.
    Back,
}

impl Side {
    /// Both, in the order of writing.
    pub const ALL: [Self; 2] = [Self::Front, Self::Back];

    /// The word for it in names and manifests.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
        }
    }

    /// The folder of its maps, with `/`.
    #[must_use]
    pub const fn folder(self) -> &'static str {
        match self {
            Self::Front => "",
            Self::Back => "back/",
        }
    }
}

/// The card of a leaf.
#[derive(Debug, Clone, Copy)]
pub struct Card<'a> {
    /// Beginning of the names of all files; without spaces.
    pub stem: &'a str,
    /// The square that the pictures show.
    pub frame: &'a TextureFrame,
    /// The shape of either sheet.
    pub sheet: &'a Sheet,
    /// Shine of the upper side, 0–1.
    pub specularity: f64,
    /// Roughness of the surface, 0–1.
    pub roughness: f64,
}

/// Where a side's pictures lie, relative to the file that names them; `None` for those that are not
/// written.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct MapPaths {
    /// Colour, coverage in alpha.
    pub base_colour: Option<String>,
    /// Coverage, in grey and in alpha.
    pub opacity: Option<String>,
    /// Normals, OpenGL.
    pub normal: Option<String>,
    /// Roughness, in grey.
    pub roughness: Option<String>,
    /// Occlusion, in grey.
    pub occlusion: Option<String>,
}

/// A corner of a sheet, ready to be written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Corner {
    /// Metres; base of the blade at the origin, apex on +y, upper side towards +z.
    pub position: [f64; 3],
    /// On the side's own picture, v up.
    pub uv: [f64; 2],
}

impl Card<'_> {
    /// The corners of a side, in the order of the sheet's points.
    #[must_use]
    pub fn corners(&self, side: Side) -> Vec<Corner> {
        let corner = |uv: &DVec2| {
            let p = self.frame.leaf_from_uv(*uv) * 1e-3;
            match side {
                Side::Front => Corner { position: [p.x, p.y, 0.0], uv: [uv.x, uv.y] },
                // The back pictures are mirrored: its left corner shows the right edge.
                Side::Back => {
                    let z = -GAP * self.frame.side_mm * 1e-3;
                    Corner { position: [p.x, p.y, z], uv: [1.0 - uv.x, uv.y] }
                }
            }
        };
        self.sheet.points.iter().map(corner).collect()
    }

    /// The triangles of a side, anticlockwise as seen from that side.
    #[must_use]
    pub fn triangles(&self, side: Side) -> Vec<[u32; 3]> {
        let turned = |[a, b, c]: &[u32; 3]| match side {
            Side::Front => [*a, *b, *c],
            Side::Back => [*b, *a, *c],
        };
        self.sheet.triangles.iter().map(turned).collect()
    }

    /// Shine of a side, 0–1.
    #[must_use]
    pub fn shine(&self, side: Side) -> f64 {
        match side {
            Side::Front => self.specularity,
            Side::Back => self.specularity * BACK_SHINE,
        }
    }

    /// Roughness of a side as renderers mean it (GGX, 0 mirror – 1 chalk) from the shine and the
    /// roughness of a leaf: 0.7 for a common leaf, the middle of the 0.6–0.8 that game artists give
    /// foliage; 0.3 at its glossiest, 0.95 at its dullest.
    #[must_use]
    pub fn microfacet_roughness(&self, side: Side) -> f64 {
        0.8 - 0.5 * self.shine(side) + 0.15 * self.roughness
    }
}

impl Sheet {
    /// A sheet of some shape for pictures with this coverage (alpha).
    #[must_use]
    pub fn of(shape: CardShape, picture: &Grid<[u8; 4]>) -> Self {
        match shape {
            CardShape::Square => Self::square(),
            CardShape::Outline => Self::cut_out(picture).unwrap_or_else(Self::square),
        }
    }

    /// The square of the textures.
    #[must_use]
    pub fn square() -> Self {
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        Self { points: corners.map(DVec2::from).to_vec(), triangles: vec![[0, 1, 2], [0, 2, 3]] }
    }

    /// A few dozen corners around all that is covered, holes of some size left open; `None` when
    /// nothing is, or when the leaf comes so near to the border that there is no room for a rim.
    #[must_use]
    pub fn cut_out(picture: &Grid<[u8; 4]>) -> Option<Self> {
        // Each traced pixel stands for a block of texels.
        let block = picture.width().div_ceil(TRACED_PX).max(1);
        let side = picture.width().div_ceil(block);
        let covered = covered_blocks(picture, block, side);
        // The leaf with a rim; its outline may move by the rim's width and still hold the leaf.
        let slack = SLACK * side as f64;
        let rim = slack.ceil() as usize + 1;
        let room = rim..side.saturating_sub(rim);
        let outside = |i: usize| !room.contains(&(i % side)) || !room.contains(&(i / side));
        if covered.iter().enumerate().any(|(i, &on)| on && outside(i)) {
            return None;
        }
        let nearest = nearest_sites(side, side, |i| covered[i]);
        let field = field(&nearest, side, slack as f32);
        let rings = contour::contours(&field, 0.0);
        let mut outer: Vec<Vec<DVec2>> = Vec::new();
        let mut holes: Vec<Vec<DVec2>> = Vec::new();
        for ring in rings {
            let area = polygon::signed_area(&ring);
            // Specks of coverage are leaf too; small holes are cheaper as texels than as corners.
            if area > 0.0 {
                outer.push(ring);
            } else if -area > HOLE_AREA * (side * side) as f64 {
                holes.push(ring);
            }
        }
        let mut sheet = Self { points: Vec::new(), triangles: Vec::new() };
        let place = |p: DVec2| {
            let uv = p * (block as f64 / picture.width() as f64);
            DVec2::new(uv.x, 1.0 - uv.y).clamp(DVec2::ZERO, DVec2::ONE)
        };
        for ring in outer {
            let ring = simplified(&ring, 0.8 * slack);
            let inside: Vec<Vec<DVec2>> = holes
                .iter()
                .filter(|hole| polygon::contains(&ring, hole[0]))
                .map(|hole| simplified(hole, 0.8 * slack))
                .filter(|hole| hole.len() >= 3)
                .collect();
            let rings: Vec<Vec<DVec2>> = std::iter::once(ring)
                .chain(inside)
                .map(|ring| ring.into_iter().map(place).collect())
                .collect();
            let first = sheet.points.len() as u32;
            for triangle in triangulate::with_holes(&rings) {
                sheet.triangles.push(triangle.map(|corner| corner + first));
            }
            sheet.points.extend(rings.into_iter().flatten());
        }
        (!sheet.triangles.is_empty()).then_some(sheet)
    }

    /// The first guarantee that does not hold, in words. For tests.
    #[must_use]
    pub fn check(&self) -> Option<String> {
        for (i, triangle) in self.triangles.iter().enumerate() {
            if triangle.iter().any(|&corner| corner as usize >= self.points.len()) {
                return Some(format!("triangle {i} names a point that is not there"));
            }
            let [a, b, c] = triangle.map(|corner| self.points[corner as usize]);
            if polygon::cross(a, b, c) <= 0.0 {
                return Some(format!("triangle {i} is clockwise or has no area"));
            }
        }
        let outside = |p: &DVec2| p.min_element() < 0.0 || p.max_element() > 1.0;
        self.points.iter().position(outside).map(|i| format!("point {i} lies outside"))
    }
}

/// Holes smaller than this share of the square stay texels.
const HOLE_AREA: f64 = 4e-4;

/// Which blocks of texels hold any leaf, row by row.
fn covered_blocks(picture: &Grid<[u8; 4]>, block: usize, side: usize) -> Vec<bool> {
    let mut covered = vec![false; side * side];
    for y in 0..picture.height() {
        for (x, texel) in picture.row(y).iter().enumerate() {
            covered[y / block * side + x / block] |= texel[3] > 0;
        }
    }
    covered
}

/// `slack` less the distance to the nearest covered pixel: positive on the leaf and its rim.
fn field(nearest: &Grid<u32>, side: usize, slack: f32) -> Grid<f32> {
    let distance = |i: usize, site: u32| {
        if site == NO_SITE {
            return -f32::from(u16::MAX);
        }
        let (dx, dy) = (i % side, i / side);
        let (sx, sy) = (site as usize % side, site as usize / side);
        let (dx, dy) = (dx.abs_diff(sx) as f32, dy.abs_diff(sy) as f32);
        // Half a diagonal: a pixel is covered to its corners.
        slack + 0.71 - (dx * dx + dy * dy).sqrt()
    };
    let values = nearest.values().iter().enumerate().map(|(i, &site)| distance(i, site)).collect();
    Grid::from_values(side, side, values)
}

/// The ring in fewer corners, simple; itself where nothing else is.
fn simplified(ring: &[DVec2], tolerance: f64) -> Vec<DVec2> {
    let mut tolerance = tolerance;
    for _ in 0..4 {
        let kept: Vec<DVec2> =
            polygon::simplified(ring, tolerance, &[]).into_iter().map(|i| ring[i]).collect();
        if kept.len() >= 3 && polygon::self_crossing(&kept).is_none() {
            return kept;
        }
        tolerance *= 0.5;
    }
    ring.to_vec()
}
