//! Unilobed margins from landmarks and tangents.
//!
//! Each side of the blade is one quadratic B-spline from base to apex through its landmark points,
//! with a given tangent at each: base, (tail), waist, (shoulder), apex.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! chapter 5. Control points by equations 5.15 and 5.20, which are one rule for any number of
//! landmarks (see [`control_points`]); u₃ in 5.16 is cumulative chord length, as in 5.9.
//!
//! Coordinates of the settings are relative to the primary vein (length 1), as in the thesis.

use glam::DVec2;

use super::{Margin, MarginError, MarginSpec};
use crate::geometry::bspline::QuadraticBSpline;
use crate::parameter::parameters;

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

pub(super) fn unilobed(_spec: &MarginSpec) -> Result<Margin, MarginError> {
    let _: Option<(QuadraticBSpline, DVec2)> = None;
    unimplemented!()
}
