//! From fitted halves to the numbers of the settings: sides of a unilobed blade, records of lobes.
//!
//! Halves know the line from foot to tip; records measure angles from the vein of their lobe. All
//! headings here are clockwise from +y, on a right side.

use glam::DVec2;

use super::super::lobes::{FlankKind, HalfLobe, LobeRecord, LobeSide, ValleyKind};
use super::super::parametric::SideSpec;
use super::flank::{AtApex, Flank};
use super::half::Half;

/// A lobe's vein begins at the base when its axis meets the midrib nearer to it than this (lengths).
const AT_BASE: f64 = 0.2;

/// A unilobed side.
pub(super) fn side(half: &Half) -> SideSpec {
    let mut side = SideSpec {
        waist_x: half.waist.x,
        waist_y: half.waist.y,
        base_angle_deg: half.foot_angle.to_degrees(),
        apex_angle_deg: half.tip_angle.to_degrees(),
        tension: half.tension,
        tail_depth: 0.0,
        shoulder_height: 0.0,
        ..SideSpec::default()
    };
    if let Some(tail) = half.tail {
        (side.tail_x, side.tail_depth) = (tail.x, -tail.y);
    }
    if let Some(shoulder) = half.shoulder {
        (side.shoulder_x, side.shoulder_height) = (shoulder.x, shoulder.y - 1.0);
    }
    side
}

/// The records of a lobed leaf: those of the right side, of the left, and the one at the apex.
pub(super) fn records(right: &Flank, left: &Flank, at_apex: AtApex) -> Vec<LobeRecord> {
    let mut records = lateral(right, at_apex, LobeSide::Right);
    records.extend(lateral(left, at_apex, LobeSide::Left));
    if at_apex == AtApex::Tip {
        records.push(LobeRecord {
            side: LobeSide::Apex,
            lower: at_tip(right),
            upper: at_tip(left),
            ..plain()
        });
    }
    records
}

/// A record that leaves nothing to meet and measures from foot to tip.
fn plain() -> LobeRecord {
    LobeRecord { flanks: FlankKind::Chord, valley: ValleyKind::Set, ..LobeRecord::default() }
}

fn heading(v: DVec2) -> f64 {
    libm::atan2(v.x, v.y)
}

/// In degrees, within half a turn either way.
fn degrees(angle: f64) -> f64 {
    let turns = angle / std::f64::consts::TAU;
    (turns - turns.round()) * 360.0
}

/// A half of a record: its waist, and its angles as given.
fn half_lobe(half: &Half, base: f64, apex: f64) -> HalfLobe {
    HalfLobe {
        waist_x: half.waist.x,
        waist_y: half.waist.y,
        base_angle_deg: degrees(base),
        apex_angle_deg: degrees(apex),
    }
}

/// The half of the lobe at the apex that ends a side.
fn at_tip(flank: &Flank) -> HalfLobe {
    let last = flank.halves.len() - 1;
    let half = &flank.halves[last];
    let chord = heading(flank.corners[last + 1] - flank.corners[last]);
    half_lobe(half, half.foot_angle + chord, half.tip_angle - chord)
}

/// The records of the lobes along a side, from base to apex.
fn lateral(flank: &Flank, at_apex: AtApex, side: LobeSide) -> Vec<LobeRecord> {
    let corners = &flank.corners;
    let last = corners.len() - 1;
    // A tip that ends the side belongs to the lobe at the apex.
    let tips = (1..last).step_by(2);
    tips.map(|k| {
        let (below, tip, above) = (corners[k - 1], corners[k], corners[k + 1]);
        let origin = origin(below, tip, above);
        let vein = tip - origin;
        let along = heading(vein);
        let (lower, upper) = (&flank.halves[k - 1], &flank.halves[k]);
        let (rises, falls) = (heading(tip - below), heading(tip - above));
        let mut record = LobeRecord {
            side,
            origin: origin.y,
            angle_deg: degrees(along),
            length: vein.length(),
            lower: half_lobe(
                lower,
                lower.foot_angle + rises - along,
                lower.tip_angle + along - rises,
            ),
            upper: half_lobe(
                upper,
                upper.foot_angle + along - falls,
                upper.tip_angle + falls - along,
            ),
            ..plain()
        };
        let notched = at_apex == AtApex::Valley && k + 1 == last;
        if notched {
            record.notch_angle_deg = degrees(falls - upper.foot_angle);
            return record;
        }
        let way = above - origin;
        let next = &flank.halves[k + 1];
        let next_rises = heading(corners[k + 2] - above);
        record.valley_distance = way.length() / vein.length();
        record.valley_angle_deg = degrees(along - heading(way));
        record.valley_lower_deg = degrees(falls - upper.foot_angle - heading(way));
        record.valley_upper_deg = degrees(heading(way) - next_rises - next.foot_angle);
        record
    })
    .collect()
}

/// Where on the midrib the vein of a lobe begins: where the axis of the lobe meets it; the base for a
/// lobe that comes from near it.
pub(in crate::margin) fn origin(below: DVec2, tip: DVec2, above: DVec2) -> DVec2 {
    let axis = tip - (below + above) * 0.5;
    let meets = tip.y - axis.y / axis.x * tip.x;
    let far = axis.x > 0.0 && meets > AT_BASE && meets < tip.y.min(0.98);
    if far { DVec2::new(0.0, meets) } else { DVec2::ZERO }
}
