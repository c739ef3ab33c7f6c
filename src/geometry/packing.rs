//! Rectangles laid into a square without overlap; the only file that names crunch.

use crunch::{Item, Rect, Rotation};

/// Where each rectangle (width, height) comes to lie in a square: its corner with the least coordinates,
/// in the order given. `gap` is kept free between rectangles and along the border. None when they do not
/// fit. None is turned: leaves keep their direction.
#[must_use]
pub fn into_square(
    rectangles: &[(usize, usize)],
    side: usize,
    gap: usize,
) -> Option<Vec<(usize, usize)>> {
    // A gap at the right and at the top of each; the border at the other two sides.
    let room = side.checked_sub(gap)?;
    let item = |(i, &(width, height)): (usize, &(usize, usize))| {
        Item::new(i, width + gap, height + gap, Rotation::None)
    };
    let packed = crunch::pack(Rect::of_size(room, room), rectangles.iter().enumerate().map(item));
    let mut places = vec![(0, 0); rectangles.len()];
    for item in packed.ok()? {
        places[item.data] = (item.rect.x + gap, item.rect.y + gap);
    }
    Some(places)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rectangles_keep_their_distance() {
        let sizes: Vec<(usize, usize)> =
            (0..30).map(|i| (20 + 7 * i % 31, 15 + 11 * i % 43)).collect();
        let places = into_square(&sizes, 300, 4).unwrap();
        for (i, (&(x, y), &(w, h))) in places.iter().zip(&sizes).enumerate() {
            assert!(x >= 4 && y >= 4 && x + w <= 296 && y + h <= 296, "{i}");
            for (&(u, v), &(s, t)) in places.iter().zip(&sizes).skip(i + 1) {
                let apart = x + w + 4 <= u || u + s + 4 <= x || y + h + 4 <= v || v + t + 4 <= y;
                assert!(apart, "{i}");
            }
        }
    }

    #[test]
    fn what_does_not_fit_is_none() {
        assert_eq!(into_square(&[(10, 10)], 10, 1), None);
        assert_eq!(into_square(&[(10, 10)], 12, 1), Some(vec![(1, 1)]));
        assert_eq!(into_square(&[(1, 1)], 3, 4), None);
    }
}
