//! Unilobed margins from landmarks and tangents.
//!
//! Each side of the blade is one quadratic B-spline from base to apex through its landmark points,
//! with a given tangent at each: base, (tail), waist, (shoulder), apex.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! chapter 5; the curve itself is in [`super::curve`].
//!
//! Coordinates of the settings are relative to the primary vein (length 1), as in the thesis.

use glam::DVec2;

use super::curve::{self, Waypoint};
use super::{Margin, MarginError, MarginSpec, Outline};
use crate::parameter::parameters;
use crate::units::Angle;

parameters! {
    /// One side of a unilobed blade, relative to the primary vein (length 1).
    pub struct SideSpec {
        /// Half width at the waist, the widest place.
        waist_x: number(0.28, 0.005..=2.0, "lengths"),
        /// How far up the waist lies: 0 at the base, 1 at the apex.
        waist_y: number(0.45, 0.02..=0.98, "lengths"),
        /// Angle between midrib and margin at the base; past 90° with a basal extension.
        base_angle_deg: number(70.0, 0.0..=180.0, "deg"),
        /// Angle between midrib and margin at the apex; past 90° with an apical extension.
        apex_angle_deg: number(35.0, 0.0..=180.0, "deg"),
        /// Half width at the tail, the lowest place of a basal extension.
        tail_x: number(0.15, 0.005..=2.0, "lengths"),
        /// How far the basal extension reaches below the base; 0 for none.
        tail_depth: number(0.0, 0.0..=0.9, "lengths"),
        /// Half width at the shoulder, the highest place of an apical extension.
        shoulder_x: number(0.15, 0.005..=2.0, "lengths"),
        /// How far the apical extension reaches above the apex; 0 for none.
        shoulder_height: number(0.0, 0.0..=0.9, "lengths"),
        /// Tension: 1 as in the thesis, 0.5 for rhomboidal and deltoid blades.
        tension: number(1.0, 0.05..=1.5, ""),
    }
}

impl SideSpec {
    /// This side mixed with `other`: this one at `share` 0, the other at 1.
    fn mixed(&self, other: &Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Self {
            waist_x: mix(self.waist_x, other.waist_x),
            waist_y: mix(self.waist_y, other.waist_y),
            base_angle_deg: mix(self.base_angle_deg, other.base_angle_deg),
            apex_angle_deg: mix(self.apex_angle_deg, other.apex_angle_deg),
            tail_x: mix(self.tail_x, other.tail_x),
            tail_depth: mix(self.tail_depth, other.tail_depth),
            shoulder_x: mix(self.shoulder_x, other.shoulder_x),
            shoulder_height: mix(self.shoulder_height, other.shoulder_height),
            tension: mix(self.tension, other.tension),
        }
    }
}

/// The landmarks of one side as if it were the right one, from base to apex.
fn waypoints(side: &SideSpec, name: &str) -> Result<Vec<Waypoint>, MarginError> {
    let wrong = |key: &str, value: f64, problem: &str| MarginError::Landmark {
        key: format!("margin.{name}.{key}"),
        value,
        problem: problem.to_owned(),
    };
    let (basal, apical) = (side.tail_depth > 0.0, side.shoulder_height > 0.0);
    if !basal && side.base_angle_deg > 90.0 {
        let problem = "is past 90 without a basal extension; set tail_depth above 0 too";
        return Err(wrong("base_angle_deg", side.base_angle_deg, problem));
    }
    if basal && side.base_angle_deg < 90.0 {
        let problem = "is below 90 with a basal extension; set 90 or more, or tail_depth = 0";
        return Err(wrong("base_angle_deg", side.base_angle_deg, problem));
    }
    if !apical && side.apex_angle_deg > 90.0 {
        let problem = "is past 90 without an apical extension; set shoulder_height above 0 too";
        return Err(wrong("apex_angle_deg", side.apex_angle_deg, problem));
    }
    if apical && side.apex_angle_deg < 90.0 {
        let problem =
            "is below 90 with an apical extension; set 90 or more, or shoulder_height = 0";
        return Err(wrong("apex_angle_deg", side.apex_angle_deg, problem));
    }
    if basal && side.tail_x >= side.waist_x {
        let problem = "is not below waist_x: the tail lies under the waist, nearer the midrib";
        return Err(wrong("tail_x", side.tail_x, problem));
    }
    if apical && side.shoulder_x >= side.waist_x {
        let problem = "is not below waist_x: the shoulder lies over the waist, nearer the midrib";
        return Err(wrong("shoulder_x", side.shoulder_x, problem));
    }
    let base = Angle::from_degrees(side.base_angle_deg);
    let apex = Angle::from_degrees(side.apex_angle_deg);
    let mut list = vec![Waypoint { at: DVec2::ZERO, towards: DVec2::new(base.sin(), base.cos()) }];
    let mut pass = |x, y, towards| list.push(Waypoint { at: DVec2::new(x, y), towards });
    if basal {
        pass(side.tail_x, -side.tail_depth, DVec2::X);
    }
    pass(side.waist_x, side.waist_y, DVec2::Y);
    if apical {
        pass(side.shoulder_x, 1.0 + side.shoulder_height, DVec2::NEG_X);
    }
    pass(0.0, 1.0, DVec2::new(-apex.sin(), apex.cos()));
    Ok(list)
}

impl MarginSpec {
    /// The two sides of a unilobed leaf, right and left, as they are drawn.
    pub(super) fn sides(&self) -> [SideSpec; 2] {
        [self.right.clone(), self.right.mixed(&self.left, self.asymmetry)]
    }
}

/// The margin of a unilobed leaf.
///
/// # Errors
///
/// [`MarginError::Landmark`] for angles and landmarks that contradict each other,
/// [`MarginError::SelfCrossing`] when the sides meet.
pub fn unilobed(spec: &MarginSpec) -> Result<Margin, MarginError> {
    let left = spec.right.mixed(&spec.left, spec.asymmetry);
    let mut points = vec![DVec2::ZERO];
    curve::append(&mut points, &waypoints(&spec.right, "right")?, spec.right.tension);
    let apex = points.len() - 1;
    curve::append_reversed(&mut points, &waypoints(&left, "left")?, left.tension);
    points.pop();
    points[apex + 1..].iter_mut().for_each(|p| p.x = -p.x);
    let outline = Outline { points, apex, ..Outline::default() };
    let hint = "lower tension, or narrow tail_x or shoulder_x";
    Margin::from_outline(outline.scaled(DVec2::splat(spec.length_mm)), hint)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;

    fn plain() -> SideSpec {
        SideSpec { waist_x: 0.3, waist_y: 0.4, ..SideSpec::default() }
    }

    #[test]
    fn the_two_sides_are_their_own() {
        let left = SideSpec { waist_x: 0.4, ..plain() };
        let spec = MarginSpec { right: plain(), left, ..MarginSpec::default() };
        let margin = unilobed(&spec).unwrap();
        let bounds = margin.bounds();
        assert!((bounds.max.x - 0.3 * 80.0).abs() < 1e-2, "{bounds:?}");
        assert!((bounds.min.x + 0.4 * 80.0).abs() < 1e-2, "{bounds:?}");
        let mirrored = unilobed(&MarginSpec { asymmetry: 0.0, ..spec }).unwrap();
        assert!((mirrored.bounds().min.x + 0.3 * 80.0).abs() < 1e-2);
        assert_eq!(margin.check(), None);
    }

    #[test]
    fn a_cordate_base_lies_below_the_petiole() {
        let side = SideSpec { base_angle_deg: 130.0, tail_depth: 0.2, ..plain() };
        let spec = MarginSpec { right: side.clone(), left: side, ..MarginSpec::default() };
        let margin = unilobed(&spec).unwrap();
        assert!((margin.bounds().min.y + 16.0).abs() < 1e-2);
        assert!(polygon::contains(margin.outline(), DVec2::new(0.0, 1.0)));
        assert!(!polygon::contains(margin.outline(), DVec2::new(0.0, -1.0)));
    }

    #[test]
    fn landmarks_that_contradict_each_other_name_the_key() {
        let side = SideSpec { base_angle_deg: 120.0, ..plain() };
        let spec = MarginSpec { left: side, ..MarginSpec::default() };
        let message = unilobed(&spec).unwrap_err().to_string();
        assert!(message.contains("margin.left.base_angle_deg = 120"), "{message}");
    }
}
