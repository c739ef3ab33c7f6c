//! The type of a blade from its polygon.
//!
//! Source: Garg (2011), section 5.4: with ϕ the angle between the midrib and the line from an end to
//! the waist, and θ that between midrib and margin at that end, the end is straight when θ lies within
//! ε of ϕ, concave below and convex above; ε is [`EPSILON_DEG`]. Waists by section 2.2. Extensions
//! reach past base or apex by more than [`EXTENSION`]; sides count as parallel when the half width
//! stays within [`PARALLEL`] of the greatest.

use glam::DVec2;

use super::{ApexShape, BaseShape, ShapeType, WaistShape};
use crate::margin::Margin;

/// ε of section 5.4 (degrees): an end that starts within this of the line to the waist is straight.
pub const EPSILON_DEG: f64 = 10.0;

/// How far half the width of an oblong blade may fall short of the greatest, over the middle third.
pub const PARALLEL: f64 = 0.04;

/// How far past base or apex an extension reaches at least, in lengths.
pub const EXTENSION: f64 = 0.01;

/// A linear blade is at most this wide, in lengths.
const LINEAR: f64 = 0.1;

/// The waist is the middle of the stretch that is as wide as the widest place, but for this share.
const AS_WIDE: f64 = 0.005;

/// The tangent at an end is taken from the margin over this way and twice this way, in lengths, and
/// drawn on to the end itself.
const TANGENT: f64 = 0.01;

/// The type of the right side and of the left, from the polygon alone.
#[must_use]
pub fn classify(margin: &Margin) -> [ShapeType; 2] {
    let (outline, apex) = (margin.outline(), margin.apex_index());
    let scale = 1.0 / margin.length_mm();
    let right: Vec<DVec2> = outline[..=apex].iter().map(|p| *p * scale).collect();
    let mut left = vec![DVec2::ZERO];
    left.extend(outline[apex..].iter().rev().map(|p| DVec2::new(-p.x, p.y) * scale));
    let widths = [&right, &left].map(|side| width(side));
    let linear = widths[0] + widths[1] < LINEAR;
    [&right, &left].map(|side| of_side(side, linear))
}

fn width(side: &[DVec2]) -> f64 {
    side.iter().map(|p| p.x).fold(0.0, f64::max)
}

fn of_side(side: &[DVec2], linear: bool) -> ShapeType {
    let most = width(side);
    let wide = side.iter().filter(|p| p.x >= (1.0 - AS_WIDE) * most).map(|p| p.y);
    let (low, high) =
        wide.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let waist = DVec2::new(most, f64::midpoint(low, high));
    let lowest = side.iter().map(|p| p.y).fold(0.0, f64::min);
    let highest = side.iter().map(|p| p.y).fold(1.0, f64::max);
    let (cordate, emarginate) = (lowest < -EXTENSION, highest > 1.0 + EXTENSION);
    let apex_up: Vec<DVec2> = side.iter().rev().map(|p| DVec2::new(p.x, 1.0 - p.y)).collect();
    let base = if cordate {
        BaseShape::Cordate
    } else {
        match bulge(side, waist) {
            off if off.abs() <= EPSILON_DEG => BaseShape::Straight,
            off if off < 0.0 => BaseShape::Concave,
            _ => BaseShape::Convex,
        }
    };
    let apex = if emarginate {
        ApexShape::Emarginate
    } else {
        match bulge(&apex_up, DVec2::new(waist.x, 1.0 - waist.y)) {
            off if off.abs() <= EPSILON_DEG => ApexShape::Straight,
            off if off < 0.0 => ApexShape::Acuminate,
            _ => ApexShape::Convex,
        }
    };
    let waist = if linear {
        WaistShape::Linear
    } else if !cordate && !emarginate && is_parallel(side, most) {
        WaistShape::Oblong
    } else if waist.y < 0.4 {
        WaistShape::Ovate
    } else if waist.y <= 0.6 {
        WaistShape::Elliptic
    } else {
        WaistShape::Obovate
    };
    ShapeType { waist, base, apex }
}

/// θ − ϕ (degrees) at the first point of a side.
fn bulge(side: &[DVec2], waist: DVec2) -> f64 {
    let angle = |p: DVec2| libm::atan2(p.x, p.y).to_degrees();
    let (near, far) = (angle(after(side, TANGENT)), angle(after(side, 2.0 * TANGENT)));
    2.0 * near - far - angle(waist)
}

/// The point of a line at a distance along it from its first point, relative to that.
fn after(line: &[DVec2], way: f64) -> DVec2 {
    let mut left = way;
    for pair in line.windows(2) {
        let length = pair[0].distance(pair[1]);
        if length >= left && length > 0.0 {
            return pair[0].lerp(pair[1], left / length) - line[0];
        }
        left -= length;
    }
    line[line.len() - 1] - line[0]
}

/// Whether a side is nearly as wide as anywhere over the middle third of the length.
fn is_parallel(side: &[DVec2], most: f64) -> bool {
    (0..=40).all(|i| {
        let y = (1.0 + f64::from(i) / 40.0) / 3.0;
        let crossing = |pair: &[DVec2]| {
            let (a, b) = (pair[0], pair[1]);
            ((a.y > y) != (b.y > y)).then(|| a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y))
        };
        let width = side.windows(2).filter_map(crossing).fold(0.0, f64::max);
        width >= (1.0 - PARALLEL) * most
    })
}
