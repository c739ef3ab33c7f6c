//! The sheet cut out around the leaf, against the coverage it is cut from.

use proptest::prelude::*;
use venation::geometry::DVec2;
use venation::geometry::polygon::cross;
use venation::io::card::Sheet;
use venation::raster::Grid;

/// How many triangles hold a point.
fn holders(sheet: &Sheet, p: DVec2) -> usize {
    let holds = |t: &&[u32; 3]| {
        let [a, b, c] = t.map(|i| sheet.points[i as usize]);
        cross(a, b, p) > 0.0 && cross(b, c, p) > 0.0 && cross(c, a, p) > 0.0
    };
    sheet.triangles.iter().filter(holds).count()
}

fn uv(x: usize, y: usize, size: usize) -> DVec2 {
    // Off the centre, so that no edge between round numbers runs through it.
    DVec2::new((x as f64 + 0.503) / size as f64, 1.0 - (y as f64 + 0.497) / size as f64)
}

fn covered_everywhere_and_tight(picture: &Grid<[u8; 4]>) -> Result<(), TestCaseError> {
    let size = picture.width();
    let Some(sheet) = Sheet::cut_out(picture) else {
        // No leaf, or none with room around it.
        let covered = |i: usize| picture.values()[i][3] > 0;
        let near = |v: usize| v < 2 || v >= size - 2;
        let mut on = (0..size * size).filter(|&i| covered(i)).peekable();
        prop_assert!(on.peek().is_none() || on.any(|i| near(i % size) || near(i / size)));
        return Ok(());
    };
    prop_assert_eq!(sheet.check(), None);
    for y in 0..size {
        for x in 0..size {
            let held = holders(&sheet, uv(x, y, size));
            prop_assert!(held <= 1, "two triangles hold ({}, {})", x, y);
            if picture[(x, y)][3] > 0 {
                prop_assert_eq!(held, 1, "({}, {}) is not on the sheet", x, y);
            }
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn every_covered_texel_is_on_the_sheet_once(
        discs in prop::collection::vec((8.0..56.0, 8.0..56.0, 1.0..9.0), 0..5),
        hole in (16.0..48.0, 16.0..48.0, 0.0..12.0),
    ) {
        let within = |x: usize, y: usize, (cx, cy, r): (f64, f64, f64)| {
            (x as f64 - cx).hypot(y as f64 - cy) < r
        };
        let mut picture = Grid::filled(64, 64, [0; 4]);
        for y in 0..64 {
            for x in 0..64 {
                let leaf = discs.iter().any(|&disc| within(x, y, disc));
                picture[(x, y)] = [9, 9, 9, if leaf && !within(x, y, hole) { 255 } else { 0 }];
            }
        }
        covered_everywhere_and_tight(&picture)?;
    }
}

#[test]
fn a_long_blade_gets_a_sheet_of_its_own_shape() {
    let size = 300;
    let mut picture = Grid::filled(size, size, [0_u8; 4]);
    for y in 10..290 {
        // A lancet, 30 texels wide in the middle.
        let half = 15.0 * (std::f64::consts::PI * (y - 10) as f64 / 280.0).sin();
        for x in 0..size {
            if (x as f64 - 150.0).abs() < half {
                picture[(x, y)][3] = 255;
            }
        }
    }
    covered_everywhere_and_tight(&picture).unwrap();
    let sheet = Sheet::cut_out(&picture).unwrap();
    let area: f64 = sheet
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|i| sheet.points[i as usize]);
            0.5 * cross(a, b, c)
        })
        .sum();
    let leaf = picture.values().iter().filter(|texel| texel[3] > 0).count() as f64;
    assert!(area < 1.35 * leaf / (size * size) as f64, "{area}");
    assert!(sheet.triangles.len() < 40, "{}", sheet.triangles.len());
}
