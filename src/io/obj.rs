//! The leaf as a card: OBJ and MTL.
//!
//! Base of the blade at the origin, apex on +y, upper side towards +z. OBJ has no unit; numbers are
//! metres, as in glTF, and a comment says so. What programs really make of an MTL decides its lines:
//!
//! - `map_d` names the grey-and-alpha opacity map. Some take a picture's alpha, some its green, some
//!   its brightness: here all agree. The base colour's alpha is not enough, and a mask without alpha
//!   leaves a rectangle in Blender.
//! - `norm` is the normal map. `map_Bump` is height to some and normals to others, so it is left out.
//! - `Pr` and `Ns` are both there: without them Blender shows a mirror. `Ks` too: without it, full
//!   shine.
//! - `map_Pr` is read as if it were a colour, which makes leaves shine: the roughness is one number here.
//! - `illum 2` and no `Tf`: either alternative turns the leaf to glass somewhere.

use std::fmt::Write as _;

use super::card::{Card, MapPaths, Side};
use super::decimal::decimal;

/// Of a metre, to a tenth of a micrometre.
const PLACES: usize = 7;

/// The geometry.
#[must_use]
pub fn obj(card: &Card<'_>) -> String {
    let stem = card.stem;
    let mut obj = format!(
        "# {}\n# unit: metre; base of the blade at the origin, apex on +y, upper side to +z\n\
         mtllib {stem}.mtl\no {stem}\n",
        super::GENERATOR
    );
    let mut faces = String::new();
    let mut first = 1;
    for (normal, side) in (1..).zip(Side::ALL) {
        let corners = card.corners(side);
        for corner in &corners {
            let [x, y, z] = corner.position.map(|x| decimal(x, PLACES));
            let _ = writeln!(obj, "v {x} {y} {z}");
        }
        for corner in &corners {
            let [u, v] = corner.uv.map(|x| decimal(x, PLACES));
            let _ = writeln!(obj, "vt {u} {v}");
        }
        let _ = writeln!(faces, "g {stem}_{side}\nusemtl {stem}_{side}", side = side.word());
        for triangle in card.triangles(side) {
            let [a, b, c] = triangle.map(|corner| corner + first);
            let _ = writeln!(faces, "f {a}/{a}/{normal} {b}/{b}/{normal} {c}/{c}/{normal}");
        }
        first += corners.len() as u32;
    }
    obj + "vn 0 0 1\nvn 0 0 -1\n" + &faces
}

/// The materials.
#[must_use]
pub fn mtl(card: &Card<'_>, sides: &[MapPaths; 2]) -> String {
    let mut mtl = format!("# {}\n", super::GENERATOR);
    for (side, paths) in Side::ALL.into_iter().zip(sides) {
        mtl.push('\n');
        mtl.push_str(&material(card, side, paths));
    }
    mtl
}

fn material(card: &Card<'_>, side: Side, paths: &MapPaths) -> String {
    let (stem, ks) = (card.stem, decimal(card.shine(side), PLACES));
    let roughness = card.microfacet_roughness(side);
    // The exponent from which Blender computes the same roughness.
    let exponent = 1000.0 * (1.0 - roughness) * (1.0 - roughness);
    let mut mtl = format!(
        "newmtl {stem}_{}\nKa 0 0 0\nKd 1 1 1\nKs {ks} {ks} {ks}\nNs {}\nPr {}\nillum 2\n",
        side.word(),
        decimal(exponent, PLACES),
        decimal(roughness, PLACES)
    );
    for (statement, path) in
        [("map_Kd", &paths.base_colour), ("map_d", &paths.opacity), ("norm", &paths.normal)]
    {
        if let Some(path) = path {
            let _ = writeln!(mtl, "{statement} {path}");
        }
    }
    mtl
}
