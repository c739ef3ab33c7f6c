//! Normals from heights by central differences, OpenGL convention: +x right, +y up the picture.

/// The unit normal of a surface whose height rises by `dx` per unit to the right and by `dy` per
/// unit up the picture.
#[must_use]
#[inline]
pub fn from_slopes(dx: f32, dy: f32) -> [f32; 3] {
    let scale = 1.0 / (1.0 + dx * dx + dy * dy).sqrt();
    [-dx * scale, -dy * scale, scale]
}

/// A unit vector as bytes: 0–255 for −1–1.
#[must_use]
#[inline]
pub fn encoded(normal: [f32; 3]) -> [u8; 3] {
    normal.map(|component| (component * 127.5 + 128.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_is_the_usual_blue() {
        assert_eq!(encoded(from_slopes(0.0, 0.0)), [128, 128, 255]);
    }

    #[test]
    fn slopes_lean_away_from_the_rise() {
        let [x, y, z] = from_slopes(2.0, -1.0);
        assert!(x < 0.0 && y > 0.0 && z > 0.0);
        assert!((x * x + y * y + z * z - 1.0).abs() < 1e-6);
        assert!((x / z + 2.0).abs() < 1e-6);
        // Steep beyond all measure: still in front.
        assert!(encoded(from_slopes(1e6, 1e6))[2] >= 128);
    }
}
