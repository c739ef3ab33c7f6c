//! Unilobed margins from landmarks and tangents.
//!
//! Each side of the blade is one quadratic B-spline from base to apex through its landmark points,
//! with a given tangent at each: base, (tail), waist, (shoulder), apex.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! chapter 5; the curve itself is in [`super::curve`].
//!
//! Coordinates of the settings are relative to the primary vein (length 1), as in the thesis.

pub(super) mod mending;
#[cfg(test)]
mod properties;

use glam::DVec2;

use super::curve::{self, Waypoint};
use super::{Landmark, LandmarkKind, MarginError, MarginSpec, Outline};
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
        /// Length of a slender drip tip; 0 for none.
        drip_length: number(0.0, 0.0..=0.7, "lengths"),
        /// Half width where the drip tip begins.
        drip_x: number(0.04, 0.002..=0.5, "lengths"),
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
            drip_length: mix(self.drip_length, other.drip_length),
            drip_x: mix(self.drip_x, other.drip_x),
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
    let drips = side.drip_length > 0.0;
    if drips && apical {
        let problem = "cannot stand on an apical extension; set shoulder_height = 0";
        return Err(wrong("drip_length", side.drip_length, problem));
    }
    if drips && 1.0 - side.drip_length <= side.waist_y {
        let problem = "reaches down to the waist; keep it below 1 - waist_y";
        return Err(wrong("drip_length", side.drip_length, problem));
    }
    if drips && side.drip_x >= side.waist_x {
        let problem = "is not below waist_x: a drip tip is narrower than the blade";
        return Err(wrong("drip_x", side.drip_x, problem));
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
    if drips {
        // The margin turns into the drip tip's own straight side.
        let neck = DVec2::new(side.drip_x, 1.0 - side.drip_length);
        pass(neck.x, neck.y, (DVec2::Y - neck).normalize());
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

/// What a bent midrib makes of a waypoint of the right side; the midrib is an arc from (0, 0) to (0, 1)
/// that turns by `bend` (radians) and bows to the right. Source: Garg, figure 5.23, where landmarks of
/// a leaf with a curved vein are given relative to that vein.
fn bent(waypoint: &Waypoint, bend: f64) -> Waypoint {
    let half = bend / 2.0;
    let here = half * (1.0 - 2.0 * waypoint.at.y);
    let (sine, cosine) = (libm::sin(here), libm::cos(here));
    let chord = 2.0 * libm::sin(half);
    let vein = DVec2::new(cosine - libm::cos(half), libm::sin(half) - sine) / chord;
    let across = DVec2::new(cosine, -sine);
    let ahead = DVec2::new(sine, cosine);
    Waypoint {
        at: vein + across * waypoint.at.x,
        towards: across * waypoint.towards.x + ahead * waypoint.towards.y,
    }
}

/// The outline of a unilobed leaf relative to the primary vein (length 1): base at (0, 0), apex at
/// (0, 1); where drip tips begin stands as a landmark.
///
/// # Errors
///
/// [`MarginError::Landmark`] for angles and landmarks that contradict each other.
pub fn outline(spec: &MarginSpec) -> Result<Outline, MarginError> {
    let [right, left] = spec.sides();
    let bend = Angle::from_degrees(spec.midrib_bend_deg).radians();
    let side = |side: &SideSpec, name, bend: f64| -> Result<Vec<Waypoint>, MarginError> {
        let mut list = waypoints(side, name)?;
        if bend != 0.0 {
            list.iter_mut().for_each(|waypoint| *waypoint = bent(waypoint, bend));
        }
        Ok(list)
    };
    let (right, left) =
        ((side(&right, "right", bend)?, &right), (side(&left, "left", -bend)?, &left));
    let mut points = Vec::with_capacity(256);
    let mut landmarks = Vec::new();
    points.push(DVec2::ZERO);
    // The curve is local: it may be drawn from waypoint to waypoint.
    let (list, side) = &right;
    let neck = if side.drip_length > 0.0 { list.len() - 2 } else { list.len() - 1 };
    curve::append(&mut points, &list[..=neck], side.tension);
    if neck + 1 < list.len() {
        landmarks.push(Landmark { vertex: points.len() - 1, kind: LandmarkKind::TipNeck });
        curve::append(&mut points, &list[neck..], side.tension);
    }
    let apex = points.len() - 1;
    let (list, side) = &left;
    let neck = if side.drip_length > 0.0 { list.len() - 2 } else { list.len() - 1 };
    if neck + 1 < list.len() {
        curve::append_reversed(&mut points, &list[neck..], side.tension);
        landmarks.push(Landmark { vertex: points.len() - 1, kind: LandmarkKind::TipNeck });
    }
    curve::append_reversed(&mut points, &list[..=neck], side.tension);
    points.pop();
    points[apex + 1..].iter_mut().for_each(|p| p.x = -p.x);
    Ok(Outline { points, apex, landmarks, ..Outline::default() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::polygon;
    use crate::margin::entire;

    fn plain() -> SideSpec {
        SideSpec { waist_x: 0.3, waist_y: 0.4, ..SideSpec::default() }
    }

    #[test]
    fn the_two_sides_are_their_own() {
        let left = SideSpec { waist_x: 0.4, ..plain() };
        let spec = MarginSpec { right: plain(), left, ..MarginSpec::default() };
        let margin = entire(&spec).unwrap();
        let bounds = margin.bounds();
        assert!((bounds.max.x - 0.3 * 80.0).abs() < 1e-2, "{bounds:?}");
        assert!((bounds.min.x + 0.4 * 80.0).abs() < 1e-2, "{bounds:?}");
        let mirrored = entire(&MarginSpec { asymmetry: 0.0, ..spec }).unwrap();
        assert!((mirrored.bounds().min.x + 0.3 * 80.0).abs() < 1e-2);
        assert_eq!(margin.check(), None);
    }

    #[test]
    fn a_cordate_base_lies_below_the_petiole() {
        let side = SideSpec { base_angle_deg: 130.0, tail_depth: 0.2, ..plain() };
        let spec = MarginSpec { right: side.clone(), left: side, ..MarginSpec::default() };
        let margin = entire(&spec).unwrap();
        assert!((margin.bounds().min.y + 16.0).abs() < 1e-2);
        assert!(polygon::contains(margin.outline(), DVec2::new(0.0, 1.0)));
        assert!(!polygon::contains(margin.outline(), DVec2::new(0.0, -1.0)));
    }

    #[test]
    fn landmarks_that_contradict_each_other_name_the_key() {
        let side = SideSpec { base_angle_deg: 120.0, ..plain() };
        let spec = MarginSpec { left: side, ..MarginSpec::default() };
        let message = entire(&spec).unwrap_err().to_string();
        assert!(message.contains("margin.left.base_angle_deg = 120"), "{message}");
    }

    #[test]
    fn a_drip_tip_is_as_slender_as_its_landmark_says() {
        let side = SideSpec { drip_length: 0.3, drip_x: 0.03, apex_angle_deg: 10.0, ..plain() };
        let spec = MarginSpec { right: side.clone(), left: side, ..MarginSpec::default() };
        let margin = entire(&spec).unwrap();
        let necks: Vec<DVec2> = margin
            .landmarks()
            .iter()
            .filter(|mark| mark.kind == LandmarkKind::TipNeck)
            .map(|mark| margin.outline()[mark.vertex])
            .collect();
        let expected = [DVec2::new(0.03, 0.7) * 80.0, DVec2::new(-0.03, 0.7) * 80.0];
        assert!(necks.iter().zip(expected).all(|(a, b)| a.distance(b) < 1e-9), "{necks:?}");
        let tip = margin.outline().iter().filter(|p| p.y > 0.7 * 80.0);
        assert!(tip.map(|p| p.x.abs()).fold(0.0, f64::max) < 0.0301 * 80.0);
        let long = SideSpec { drip_length: 0.6, ..plain() };
        let spec = MarginSpec { right: long, ..MarginSpec::default() };
        assert!(entire(&spec).unwrap_err().to_string().contains("margin.right.drip_length = 0.6"));
    }

    #[test]
    fn landmarks_follow_a_bent_midrib() {
        let narrow = SideSpec { waist_x: 0.05, waist_y: 0.5, ..SideSpec::default() };
        let bend = 70.0_f64;
        let spec = MarginSpec {
            right: narrow.clone(),
            left: narrow,
            midrib_bend_deg: bend,
            ..MarginSpec::default()
        };
        let margin = entire(&spec).unwrap();
        // The middle of an arc over a chord of 1 that turns by `bend` lies tan(bend/4)/2 beside it.
        let sag = (bend.to_radians() / 4.0).tan() / 2.0;
        let waists = [sag + 0.05, sag - 0.05].map(|x| DVec2::new(x, 0.5) * 80.0);
        for waist in waists {
            let near =
                margin.outline().iter().map(|p| p.distance(waist)).fold(f64::INFINITY, f64::min);
            assert!(near < 1e-9, "{waist}: {near}");
        }
        let mirrored = entire(&MarginSpec { midrib_bend_deg: -bend, ..spec }).unwrap();
        assert!((mirrored.bounds().min.x + margin.bounds().max.x).abs() < 1e-9);
    }

    #[test]
    fn a_peltate_blade_has_its_base_inside() {
        let side = SideSpec { base_angle_deg: 120.0, tail_depth: 0.1, ..plain() };
        let spec = MarginSpec {
            right: side.clone(),
            left: side,
            base_inset: 0.4,
            length_mm: 100.0,
            ..MarginSpec::default()
        };
        let margin = entire(&spec).unwrap();
        assert_eq!(margin.check(), None);
        assert!(margin.is_peltate() && polygon::contains(margin.outline(), DVec2::ZERO));
        assert_eq!(margin.apex(), DVec2::new(0.0, 100.0));
        assert!(margin.outline()[0].distance(DVec2::new(0.0, -100.0 * 0.4 / 0.6)) < 1e-9);
        // Its shape is that of the leaf whose base is on the margin.
        let plain = entire(&MarginSpec { base_inset: 0.0, ..spec }).unwrap();
        assert!(!plain.is_peltate());
        assert!((margin.area_mm2() * 0.36 / plain.area_mm2() - 1.0).abs() < 1e-3);
    }
}
