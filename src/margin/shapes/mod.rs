//! Shapes of unilobed blades by name: fifty types, and the names botanists have for twelve of them.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011: the
//! types are those of table 4.2 (waist, base and apex apart), the names those of table 4.3. Which
//! numbers stand for a type is our choice; [`classify`](classify::classify) gives each back its own.
//!
//! A name is `waist-base-apex`: `ovate-cordate-straight`. A base with an extension is `cordate`, an
//! apex with one `emarginate`; a concave apex is `acuminate` (table 4.1).

pub mod classify;

use super::parametric::SideSpec;
use super::{MarginKind, MarginSpec};
use crate::parameter::words;

words! {
    /// Where a blade is widest.
    pub enum WaistShape {
        /// In the middle fifth.
        Elliptic = "elliptic",
        /// Nearer to the apex.
        Obovate = "obovate",
        /// Nearer to the base.
        Ovate = "ovate",
        /// All along: parallel sides over the middle third at least.
        Oblong = "oblong",
        /// Ten times as long as wide, or more.
        Linear = "linear",
    }
}

words! {
    /// How the margin leaves the base.
    pub enum BaseShape {
        /// Curved towards the midrib.
        Concave = "concave",
        /// Straight to the waist.
        Straight = "straight",
        /// Curved away from the midrib.
        Convex = "convex",
        /// With an extension below the base.
        Cordate = "cordate",
    }
}

words! {
    /// How the margin comes to the apex.
    pub enum ApexShape {
        /// Curved towards the midrib.
        Acuminate = "acuminate",
        /// Straight from the waist.
        Straight = "straight",
        /// Curved away from the midrib.
        Convex = "convex",
        /// With an extension above the apex.
        Emarginate = "emarginate",
    }
}

/// A type of unilobed blade.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ShapeType {
    /// Where it is widest.
    pub waist: WaistShape,
    /// Its base.
    pub base: BaseShape,
    /// Its apex.
    pub apex: ApexShape,
}

impl std::fmt::Display for ShapeType {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(&format!("{}-{}-{}", self.waist, self.base, self.apex))
    }
}

/// A shape with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct Shape {
    /// `reniform`, `ovate-cordate-straight`.
    pub name: String,
    /// Its type: table 4.2, or for a botanist's name table 4.3.
    pub kind: ShapeType,
    /// Both its sides.
    pub side: SideSpec,
}

impl MarginSpec {
    /// The same leaf with the margin of a shape; its length stays.
    #[must_use]
    pub fn shaped(&self, shape: &Shape) -> Self {
        Self {
            kind: MarginKind::Unilobed,
            right: shape.side.clone(),
            left: shape.side.clone(),
            ..self.clone()
        }
    }
}

impl ShapeType {
    /// The fifty of table 4.2, in its order.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let mut list = Vec::with_capacity(50);
        for waist in [WaistShape::Elliptic, WaistShape::Obovate, WaistShape::Ovate] {
            for &base in BaseShape::ALL {
                list.extend(ApexShape::ALL.iter().map(|&apex| Self { waist, base, apex }));
            }
        }
        list.push(OBLONG);
        list.push(Self {
            waist: WaistShape::Linear,
            base: BaseShape::Straight,
            apex: ApexShape::Straight,
        });
        list
    }

    /// A blade of this type.
    fn side(self) -> SideSpec {
        let extended = self.base == BaseShape::Cordate || self.apex == ApexShape::Emarginate;
        let (waist_x, waist_y) = match self.waist {
            // Extensions need room beside the midrib.
            WaistShape::Elliptic => (if extended { 0.36 } else { 0.27 }, 0.5),
            WaistShape::Obovate => (if extended { 0.4 } else { 0.3 }, 0.7),
            WaistShape::Ovate => (if extended { 0.4 } else { 0.3 }, 0.3),
            WaistShape::Oblong => return oblong(),
            WaistShape::Linear => {
                return SideSpec {
                    waist_x: 0.035,
                    waist_y: 0.5,
                    base_angle_deg: 4.0,
                    apex_angle_deg: 4.0,
                    ..SideSpec::default()
                };
            }
        };
        let mut side = SideSpec { waist_x, waist_y, ..SideSpec::default() };
        // The angle of a straight end is that of the line to the waist (section 5.4).
        let line = |reach: f64| libm::atan2(waist_x, reach).to_degrees();
        // The margin swings out beside an extension: keep that inside the waist.
        let room = |reach: f64| waist_x - 0.015 - 0.25 * libm::hypot(0.6 * waist_x, reach);
        let angle = |straight: f64, curved: Curved| match curved {
            Curved::In => straight - 22.0,
            Curved::Not => straight,
            Curved::Out => straight + 30.0,
        };
        match self.base {
            BaseShape::Cordate => {
                (side.tail_depth, side.base_angle_deg) = (0.1, 125.0);
                side.tail_x = room(waist_y + 0.1);
            }
            BaseShape::Concave => side.base_angle_deg = angle(line(waist_y), Curved::In),
            BaseShape::Straight => side.base_angle_deg = angle(line(waist_y), Curved::Not),
            BaseShape::Convex => side.base_angle_deg = angle(line(waist_y), Curved::Out),
        }
        let reach = 1.0 - waist_y;
        match self.apex {
            ApexShape::Emarginate => {
                (side.shoulder_height, side.apex_angle_deg) = (0.05, 120.0);
                side.shoulder_x = room(reach + 0.05);
            }
            ApexShape::Acuminate => side.apex_angle_deg = angle(line(reach), Curved::In),
            ApexShape::Straight => side.apex_angle_deg = angle(line(reach), Curved::Not),
            ApexShape::Convex => side.apex_angle_deg = angle(line(reach), Curved::Out),
        }
        side.base_angle_deg = side.base_angle_deg.max(2.0);
        side.apex_angle_deg = side.apex_angle_deg.max(2.0);
        side
    }
}

/// Which way a margin curves on its way to the waist.
enum Curved {
    In,
    Not,
    Out,
}

const OBLONG: ShapeType =
    ShapeType { waist: WaistShape::Oblong, base: BaseShape::Convex, apex: ApexShape::Convex };

fn oblong() -> SideSpec {
    plain(0.18, 0.5, 80.0, 80.0, 1.3)
}

/// A side without extensions.
fn plain(
    waist_x: f64,
    waist_y: f64,
    base_angle_deg: f64,
    apex_angle_deg: f64,
    tension: f64,
) -> SideSpec {
    SideSpec { waist_x, waist_y, base_angle_deg, apex_angle_deg, tension, ..SideSpec::default() }
}

/// A side with a heart-shaped base.
fn heart(waist: [f64; 2], tail: [f64; 2], base_angle_deg: f64, apex_angle_deg: f64) -> SideSpec {
    SideSpec {
        tail_x: tail[0],
        tail_depth: tail[1],
        ..plain(waist[0], waist[1], base_angle_deg, apex_angle_deg, 1.0)
    }
}

/// The twelve of table 4.3, in its order.
fn botanical() -> Vec<Shape> {
    use {ApexShape as Apex, BaseShape as Base, WaistShape as Waist};
    let shape = |name: &str, waist, base, apex, side| {
        let kind = ShapeType { waist, base, apex };
        Shape { name: name.to_owned(), kind, side }
    };
    vec![
        shape(
            "elliptic",
            Waist::Elliptic,
            Base::Convex,
            Apex::Convex,
            plain(0.25, 0.5, 58.0, 58.0, 1.0),
        ),
        shape(
            "lanceolate",
            Waist::Ovate,
            Base::Convex,
            Apex::Straight,
            plain(0.13, 0.33, 60.0, 12.0, 1.0),
        ),
        shape(
            "oblanceolate",
            Waist::Obovate,
            Base::Straight,
            Apex::Convex,
            plain(0.13, 0.68, 11.0, 58.0, 1.0),
        ),
        shape("oblong", Waist::Oblong, Base::Convex, Apex::Convex, oblong()),
        shape(
            "oval",
            Waist::Elliptic,
            Base::Convex,
            Apex::Convex,
            plain(0.33, 0.5, 72.0, 72.0, 1.0),
        ),
        shape(
            "obovate",
            Waist::Obovate,
            Base::Straight,
            Apex::Convex,
            plain(0.29, 0.68, 23.0, 75.0, 1.0),
        ),
        shape(
            "ovate",
            Waist::Ovate,
            Base::Convex,
            Apex::Straight,
            plain(0.3, 0.33, 78.0, 25.0, 1.0),
        ),
        shape(
            "orbicular",
            Waist::Elliptic,
            Base::Convex,
            Apex::Convex,
            plain(0.5, 0.5, 89.0, 89.0, 1.17),
        ),
        shape(
            "rhomboidal",
            Waist::Elliptic,
            Base::Straight,
            Apex::Straight,
            plain(0.34, 0.5, 34.2, 34.2, 0.5),
        ),
        shape(
            "cordate",
            Waist::Ovate,
            Base::Cordate,
            Apex::Straight,
            heart([0.42, 0.27], [0.22, 0.13], 135.0, 31.0),
        ),
        shape(
            "deltoid",
            Waist::Ovate,
            Base::Concave,
            Apex::Straight,
            plain(0.4, 0.14, 52.0, 25.0, 0.5),
        ),
        shape(
            "reniform",
            Waist::Ovate,
            Base::Cordate,
            Apex::Straight,
            heart([0.74, 0.28], [0.42, 0.25], 140.0, 47.0),
        ),
    ]
}

/// Every shape with a name: the fifty types, then the twelve botanists' names.
#[must_use]
pub fn all() -> Vec<Shape> {
    let types = ShapeType::all().into_iter();
    let mut list: Vec<Shape> =
        types.map(|kind| Shape { name: kind.to_string(), kind, side: kind.side() }).collect();
    list.extend(botanical());
    list
}

/// The shape of a name. A concave apex, an extended base and an extended apex are also known by these
/// words, and `linear` needs no more.
#[must_use]
pub fn find(name: &str) -> Option<Shape> {
    let mut parts: Vec<&str> = name.split('-').collect();
    if let [_, base, apex] = &mut parts[..] {
        if *base == "extended" {
            *base = BaseShape::Cordate.word();
        }
        match *apex {
            "concave" => *apex = ApexShape::Acuminate.word(),
            "extended" => *apex = ApexShape::Emarginate.word(),
            _ => {}
        }
    }
    let name = match &parts[..] {
        ["linear"] => "linear-straight-straight".to_owned(),
        parts => parts.join("-"),
    };
    all().into_iter().find(|shape| shape.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::margin;

    #[test]
    fn there_are_fifty_types_and_twelve_names() {
        assert_eq!(ShapeType::all().len(), 50);
        let shapes = all();
        assert_eq!(shapes.len(), 62);
        for shape in &shapes {
            assert_eq!(find(&shape.name).as_ref(), Some(shape), "{}", shape.name);
        }
        assert_eq!(find("ovate-concave-concave").unwrap().name, "ovate-concave-acuminate");
        assert_eq!(find("ovate-extended-extended").unwrap().name, "ovate-cordate-emarginate");
        assert_eq!(find("linear").unwrap().name, "linear-straight-straight");
        assert_eq!(find("round"), None);
    }

    #[test]
    fn the_classifier_gives_every_shape_back_its_own_type() {
        for shape in all() {
            let spec = MarginSpec::default().shaped(&shape);
            let margin = margin::entire(&spec).unwrap_or_else(|e| panic!("{}: {e}", shape.name));
            assert_eq!(margin.check(), None);
            let found = classify::classify(&margin);
            assert_eq!(found, [shape.kind; 2], "{}", shape.name);
            // It reads a plain polygon as well.
            let polygon =
                margin::Margin::new(margin.outline().to_vec(), margin.apex_index(), Vec::new(), "");
            assert_eq!(classify::classify(&polygon.unwrap()), found);
        }
    }

    #[test]
    fn sides_are_classified_apart() {
        let [ovate, obovate] = ["ovate", "obovate"].map(|name| find(name).unwrap());
        let spec = MarginSpec { left: obovate.side, ..MarginSpec::default().shaped(&ovate) };
        let margin = margin::entire(&spec).unwrap();
        assert_eq!(classify::classify(&margin), [ovate.kind, obovate.kind]);
    }
}
