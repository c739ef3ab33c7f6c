//! The leaf as a card: OBJ and MTL.
//!
//! The card is the square of the textures: base of the blade at the origin, apex on +y, upper side
//! towards +z. OBJ has no unit; numbers are metres, as in glTF, and a comment says so.
//!
//! Front and back are sheets of their own, each with its material, for an OBJ cannot say that a face
//! has two sides. What programs really make of an MTL decides its lines:
//!
//! - `map_d` names the grey-and-alpha opacity map. Some take a picture's alpha, some its green, some
//!   its brightness: here all agree. The base colour's alpha is not enough, and a mask without alpha
//!   leaves a rectangle in Blender.
//! - `norm` is the normal map. `map_Bump` is height to some and normals to others, so it is left out.
//! - `Pr` and `Ns` are both there: without them Blender shows a mirror. `Ks` too: without it, full
//!   shine.
//! - `illum 2` and no `Tf`: either alternative turns the leaf to glass somewhere.

use std::fmt::Write as _;

use crate::texture::map::MapKind;
use crate::units::TextureFrame;

/// How far behind the front sheet the back sheet lies, as a share of the side. In one plane the two
/// would flicker wherever back faces are not culled, which is the default in Blender; of a leaf of
/// 100 mm this is 0.2 mm, about the thickness of a blade and more than a depth buffer confuses at
/// any distance from which the leaf is larger than a few pixels.
const GAP: f64 = 1.0 / 500.0;

/// The lower side has this share of the upper side's shine (Foster 2014).
const BACK_SHINE: f64 = 1.0 / 3.0;

/// What a card's files are called and which maps they may name.
#[derive(Debug, Clone, Copy)]
pub struct Card<'a> {
    /// Beginning of the names of all files; without spaces.
    pub stem: &'a str,
    /// The maps that are written beside it.
    pub maps: &'a [MapKind],
    /// The square that the card fills.
    pub frame: &'a TextureFrame,
    /// Shine of the upper side, 0–1.
    pub specularity: f64,
    /// Roughness of the surface, 0–1.
    pub roughness: f64,
}

impl Card<'_> {
    /// The geometry.
    #[must_use]
    pub fn obj(&self) -> String {
        let stem = self.stem;
        let mut obj = format!(
            "# {}\n# unit: metre; base of the blade at the origin, apex on +y, upper side to +z\n\
             mtllib {stem}.mtl\no {stem}\n",
            super::GENERATOR
        );
        let [left, bottom] = (self.frame.min * 1e-3).to_array();
        let side = self.frame.side_mm * 1e-3;
        let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)];
        for z in [0.0, -GAP * side] {
            for (u, v) in corners {
                let _ = writeln!(
                    obj,
                    "v {} {} {}",
                    number(left + u * side),
                    number(bottom + v * side),
                    number(z)
                );
            }
        }
        for (u, v) in corners {
            let _ = writeln!(obj, "vt {u} {v}");
        }
        obj.push_str("vn 0 0 1\nvn 0 0 -1\n");
        let _ = writeln!(obj, "g {stem}_front\nusemtl {stem}_front\nf 1/1/1 2/2/1 3/3/1 4/4/1");
        // The back maps are mirrored: its left corner shows the right edge of the picture.
        let _ = writeln!(obj, "g {stem}_back\nusemtl {stem}_back\nf 6/1/2 5/2/2 8/3/2 7/4/2");
        obj
    }

    /// The materials.
    #[must_use]
    pub fn mtl(&self) -> String {
        let front = self.material("front", "", self.specularity);
        let back = self.material("back", "back/", self.specularity * BACK_SHINE);
        format!("# {}\n{front}\n{back}", super::GENERATOR)
    }

    fn material(&self, side: &str, folder: &str, specularity: f64) -> String {
        let (stem, ks) = (self.stem, number(specularity));
        let roughness = microfacet_roughness(specularity, self.roughness);
        // The exponent from which Blender computes the same roughness.
        let exponent = 1000.0 * (1.0 - roughness) * (1.0 - roughness);
        let mut mtl = format!(
            "newmtl {stem}_{side}\nKa 0 0 0\nKd 1 1 1\nKs {ks} {ks} {ks}\nNs {}\nPr {}\nillum 2\n",
            number(exponent),
            number(roughness)
        );
        for (statement, map) in [
            ("map_Kd", MapKind::BaseColour),
            ("map_d", MapKind::Opacity),
            ("norm", MapKind::Normal),
        ] {
            if self.maps.contains(&map) {
                let _ = writeln!(mtl, "{statement} {folder}{stem}_{}.png", map.suffix());
            }
        }
        mtl
    }
}

/// Roughness as renderers mean it (GGX, 0 mirror – 1 chalk) from the shine and the roughness of a
/// leaf: 0.7 for a common leaf, the middle of the 0.6–0.8 that game artists give foliage; 0.3 at its
/// glossiest, 0.95 at its dullest.
fn microfacet_roughness(specularity: f64, roughness: f64) -> f64 {
    0.8 - 0.5 * specularity + 0.15 * roughness
}

/// To a ten-millionth, never in scientific notation, without trailing zeros.
fn number(value: f64) -> String {
    let printed = format!("{value:.7}");
    let printed = printed.trim_end_matches('0').trim_end_matches('.');
    if printed == "-0" { "0".into() } else { printed.into() }
}
