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
    let mut starts = Vec::new();
    let mut count = 0_u32;
    for ring in rings {
        starts.push(count);
        count += ring.len() as u32;
    }
    let mut indices: Vec<u32> = Vec::new();
    let holes = starts.get(1..).unwrap_or_default();
    Earcut::new().earcut(corners.iter().map(|p| p.to_array()), holes, &mut indices);
    let triangles = indices.as_chunks::<3>().0.iter();
    triangles
        .filter_map(|&[a, b, c]| {
            let [p, q, r] = [a, b, c].map(|corner| corners[corner as usize]);
            let area = cross(p, q, r);
            if area > 0.0 { Some([a, b, c]) } else { (area < 0.0).then_some([b, a, c]) }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(points: &[DVec2], triangles: &[[u32; 3]]) -> f64 {
        let of = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| points[i as usize]);
            0.5 * cross(a, b, c)
        };
        triangles.iter().map(of).sum()
    }

    #[test]
    fn triangles_fill_the_outline_less_its_holes() {
        let square = |from: f64, to: f64| {
            [(from, from), (to, from), (to, to), (from, to)].map(DVec2::from).to_vec()
        };
        let rings = [square(0.0, 10.0), square(2.0, 4.0), square(6.0, 9.0)];
        let points: Vec<DVec2> = rings.iter().flatten().copied().collect();
        let triangles = with_holes(&rings);
        assert!((area(&points, &triangles) - (100.0 - 4.0 - 9.0)).abs() < 1e-9);
        let turned: Vec<Vec<DVec2>> =
            rings.iter().map(|ring| ring.iter().rev().copied().collect()).collect();
        let points: Vec<DVec2> = turned.iter().flatten().copied().collect();
        assert!((area(&points, &with_holes(&turned)) - 87.0).abs() < 1e-9);
    }

    #[test]
    fn nothing_comes_of_nothing() {
        assert!(with_holes(&[]).is_empty());
        assert!(with_holes(&[vec![DVec2::ZERO, DVec2::X]]).is_empty());
    }
}
