//! Areoles: the faces of a network, found by walking around each one.
//!
//! At the end of a segment the walk takes the next one clockwise, so what it goes around lies on its
//! left; of each connected part the face with the least signed area is the outside. Shape is that
//! of the closed boundary: veins with the same areole on both sides (free-ending veinlets and their
//! branches) belong to the inside and add neither length nor corners, but the place where they
//! leave splits the boundary in two segments.
//!
//! Departs from a true planar subdivision in one point: an island of veins within an areole is not
//! cut out of it.

use glam::DVec2;

use super::network::{HalfEdge, Network, split};
use super::topology::Parts;

/// An area closed in by veins.
#[derive(Debug, Clone, PartialEq)]
pub struct Areole {
    /// Its area.
    pub area: f64,
    /// The length of its closed boundary.
    pub perimeter: f64,
    /// Its centre of mass.
    pub centroid: DVec2,
    /// Square root of the ratio of its second moments: length over width of a rectangle.
    pub elongation: f64,
    /// Segments on its closed boundary.
    pub segments: usize,
    /// Vein ends inside it.
    pub free_ends: usize,
}

impl Areole {
    /// 4πA/p²: 1 for a circle.
    #[must_use]
    pub fn circularity(&self) -> f64 {
        4.0 * std::f64::consts::PI * self.area / self.perimeter.powi(2)
    }
}

/// The areoles of a network.
#[derive(Debug, Clone)]
pub struct Areoles {
    /// The areoles.
    pub list: Vec<Areole>,
    /// For both sides of each segment, the areole there; `None` for the outside.
    pub beside: Vec<[Option<u32>; 2]>,
}

impl Areoles {
    /// Finds them.
    #[must_use]
    pub fn of(network: &Network) -> Self {
        let (faces, face_of) = walks(network);
        let segments = network.segments();
        let parts = Parts::of(network);
        let degrees = network.degrees();
        let shapes: Vec<Areole> =
            faces.iter().map(|walk| shape(network, walk, &face_of, &degrees)).collect();
        // The outside of each part has the least area, which is negative but for a tree.
        let mut outside = vec![u32::MAX; parts.count];
        for (face, walk) in faces.iter().enumerate() {
            let part = parts.of_node[segments[split(walk[0]).0].ends[0]];
            let least = outside[part];
            if least == u32::MAX || shapes[face].area < shapes[least as usize].area {
                outside[part] = face as u32;
            }
        }
        let mut is_outside = vec![false; faces.len()];
        outside.iter().for_each(|&face| is_outside[face as usize] = true);
        let mut number = vec![None; faces.len()];
        let mut list = Vec::new();
        for (face, shape) in shapes.into_iter().enumerate() {
            if !is_outside[face] && shape.area > 0.0 {
                number[face] = Some(list.len() as u32);
                list.push(shape);
            }
        }
        let beside = |half_edge: usize| number[face_of[half_edge] as usize];
        let beside = (0..segments.len()).map(|i| [beside(2 * i), beside(2 * i + 1)]).collect();
        Self { list, beside }
    }
}

/// The walks around all faces, and the face on the left of each half-edge.
fn walks(network: &Network) -> (Vec<Vec<HalfEdge>>, Vec<u32>) {
    let segments = network.segments();
    let mut around = network.incidence();
    let angle = |&half_edge: &HalfEdge| {
        let (segment, side) = split(half_edge);
        let direction = segments[segment].direction(side, 0.0);
        direction.y.atan2(direction.x)
    };
    // The half-edge before each one, anticlockwise around its node.
    let mut before = vec![0; 2 * segments.len()];
    for node in 0..network.nodes().len() {
        let leaving = around.at_mut(node);
        leaving.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        let last = leaving.len() - 1;
        for (i, &half_edge) in leaving.iter().enumerate() {
            before[half_edge as usize] = leaving[if i == 0 { last } else { i - 1 }];
        }
    }
    let mut face_of = vec![u32::MAX; 2 * segments.len()];
    let mut faces = Vec::new();
    for start in 0..face_of.len() {
        let (mut walk, mut at) = (Vec::new(), start);
        while face_of[at] == u32::MAX {
            face_of[at] = faces.len() as u32;
            walk.push(at as HalfEdge);
            at = before[at ^ 1] as usize;
        }
        if !walk.is_empty() {
            faces.push(walk);
        }
    }
    (faces, face_of)
}

/// Measures a face by Green's theorem along its boundary.
fn shape(network: &Network, walk: &[HalfEdge], face_of: &[u32], degrees: &[usize]) -> Areole {
    let segments = network.segments();
    let (mut perimeter, mut sides, mut free_ends) = (0.0, 0, 0);
    // Relative to a point nearby: far from the origin the terms would cancel badly.
    let origin = segments[split(walk[0]).0].path[0];
    let mut moments = Moments::default();
    for &half_edge in walk {
        let (segment, side) = split(half_edge);
        let segment = &segments[segment];
        let end = segment.ends[1 - side];
        free_ends += usize::from(degrees[end] == 1 && !network.is_root(end));
        if face_of[half_edge as usize] == face_of[half_edge as usize ^ 1] {
            continue;
        }
        perimeter += segment.length;
        sides += 1;
        for pair in segment.path.windows(2) {
            let (a, b) = (pair[0] - origin, pair[1] - origin);
            if side == 0 { moments.add(a, b) } else { moments.add(b, a) }
        }
    }
    Areole {
        area: moments.area,
        perimeter,
        centroid: origin + moments.first / moments.area,
        elongation: moments.elongation(),
        segments: sides,
        free_ends,
    }
}

/// Integrals over an area, from the edges of its boundary.
#[derive(Debug, Default)]
struct Moments {
    area: f64,
    first: DVec2,
    xx: f64,
    xy: f64,
    yy: f64,
}

impl Moments {
    fn add(&mut self, a: DVec2, b: DVec2) {
        let doubled = a.perp_dot(b);
        self.area += doubled / 2.0;
        self.first += (a + b) * doubled / 6.0;
        self.xx += (a.x * a.x + a.x * b.x + b.x * b.x) * doubled / 12.0;
        self.yy += (a.y * a.y + a.y * b.y + b.y * b.y) * doubled / 12.0;
        self.xy += (a.x * b.y + 2.0 * a.x * a.y + 2.0 * b.x * b.y + b.x * a.y) * doubled / 24.0;
    }

    /// From the eigenvalues of the second moments about the centre of mass.
    fn elongation(&self) -> f64 {
        let centre = self.first / self.area;
        let xx = self.xx / self.area - centre.x * centre.x;
        let yy = self.yy / self.area - centre.y * centre.y;
        let xy = self.xy / self.area - centre.x * centre.y;
        let spread = ((xx - yy) / 2.0).hypot(xy);
        let mean = (xx + yy) / 2.0;
        // A sliver has a width below rounding.
        ((mean + spread) / (mean - spread).max(mean * 1e-9)).sqrt()
    }
}
