//! Polygons with holes cut into triangles; the only file that names earcut.

use earcut::Earcut;

use super::DVec2;
use super::polygon::cross;

/// Triangles over the corners of the rings, counted on from ring to ring: the first ring is the
/// outline, the others are holes in it. Each triangle is anticlockwise (y up) and has an area; the
/// rings may run either way round. Nothing for fewer than three corners.
#[must_use]
pub fn with_holes(rings: &[Vec<DVec2>]) -> Vec<[u32; 3]> {
    let corners: Vec<DVec2> = rings.iter().flatten().copied().collect();
    let turned = |[a, b, c]: [u32; 3]| {
        let area = area(&corners, &[a, b, c]);
        if area > 0.0 { Some([a, b, c]) } else { (area < 0.0).then_some([b, a, c]) }
    };
    cut(rings).into_iter().filter_map(turned).collect()
}

/// The same of one polygon, with the triangles that have no area: each side that is none of the polygon's is
/// that of two.
#[must_use]
pub fn connected(polygon: &[DVec2]) -> Vec<[u32; 3]> {
    cut(&[polygon.to_vec()])
}

/// Twice the area, below 0 where the corners run clockwise.
fn area(corners: &[DVec2], triangle: &[u32; 3]) -> f64 {
    let [a, b, c] = triangle.map(|corner| corners[corner as usize]);
    cross(a, b, c)
}

/// All of earcut's triangles, anticlockwise.
fn cut(rings: &[Vec<DVec2>]) -> Vec<[u32; 3]> {
    let corners: Vec<DVec2> = rings.iter().flatten().copied().collect();
    let mut starts = Vec::new();
    let mut count = 0_u32;
    for ring in rings {
        starts.push(count);
        count += ring.len() as u32;
    }
    let mut indices: Vec<u32> = Vec::new();
    let holes = starts.get(1..).unwrap_or_default();
    Earcut::new().earcut(corners.iter().map(|p| p.to_array()), holes, &mut indices);
    let mut triangles = indices.as_chunks::<3>().0.to_vec();
    // They all run the same way round.
    if triangles.iter().map(|t| area(&corners, t)).sum::<f64>() < 0.0 {
        triangles.iter_mut().for_each(|t| t.swap(1, 2));
    }
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_of(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        triangles.iter().map(|t| 0.5 * area(points, t)).sum()
    }

    #[test]
    fn triangles_fill_the_outline_less_its_holes() {
        let square = |from: f64, to: f64| {
            [(from, from), (to, from), (to, to), (from, to)].map(DVec2::from).to_vec()
        };
        let rings = [square(0.0, 10.0), square(2.0, 4.0), square(6.0, 9.0)];
        let points: Vec<DVec2> = rings.iter().flatten().copied().collect();
        let triangles = with_holes(&rings);
        assert!((area_of(&points, &triangles) - (100.0 - 4.0 - 9.0)).abs() < 1e-9);
        let turned: Vec<Vec<DVec2>> =
            rings.iter().map(|ring| ring.iter().rev().copied().collect()).collect();
        let points: Vec<DVec2> = turned.iter().flatten().copied().collect();
        assert!((area_of(&points, &with_holes(&turned)) - 87.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert!(with_holes(&[]).is_empty());
        assert!(with_holes(&[vec![DVec2::ZERO, DVec2::X]]).is_empty());
    }
}
