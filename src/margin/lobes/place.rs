//! A lobe in its place on the right side of the leaf.

use glam::DVec2;

use super::{
    FlankKind, HalfLobe, LobeRecord, LobeSide, STRIP, STRIP_ANGLE_DEG, ValleyKind, Waypoint,
};
use crate::units::Angle;

/// One half of a lobe: numbers of [`HalfLobe`] with the sines and cosines taken.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Half {
    waist: DVec2,
    /// (sine, cosine) of the angles at base and apex.
    base: DVec2,
    apex: DVec2,
    /// 1 for the half clockwise of the vein (the lower one on the right), −1 for the other.
    side: f64,
}

/// A lobe on the right side, or at the apex. What is on the left is its mirror image.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Lobe {
    pub(super) origin: DVec2,
    pub(super) tension: f64,
    pub(super) lower: Half,
    pub(super) upper: Half,
    /// How the margin leaves the set valley above: towards this lobe and towards the next.
    pub(super) valley: Option<(Waypoint, Waypoint)>,
    /// Waists are measured from the start of the half to the tip, not along the vein.
    by_chord: bool,
    direction: DVec2,
    pub(super) length: f64,
    /// Half of what the vein turns (radians).
    bend: f64,
    notch: DVec2,
}

/// (sine, cosine).
fn direction(degrees: f64) -> DVec2 {
    let angle = Angle::from_degrees(degrees);
    DVec2::new(angle.sin(), angle.cos())
}

/// `v` turned by the angle of the given (sine, cosine), clockwise for `side` 1.
fn turned(v: DVec2, angle: DVec2, side: f64) -> DVec2 {
    let (sine, cosine) = (angle.x * side, angle.y);
    DVec2::new(v.x * cosine + v.y * sine, v.y * cosine - v.x * sine)
}

impl Half {
    fn new(half: &HalfLobe, side: f64) -> Self {
        Self {
            waist: DVec2::new(half.waist_x, half.waist_y),
            base: direction(half.base_angle_deg),
            apex: direction(half.apex_angle_deg),
            side,
        }
    }
}

impl Lobe {
    pub(super) fn new(record: &LobeRecord) -> Self {
        let apex = record.side == LobeSide::Apex;
        let length = if apex { 1.0 - record.origin } else { record.length };
        let along = if apex { DVec2::Y } else { direction(record.angle_deg) };
        let origin = DVec2::new(0.0, record.origin);
        let valley = (record.valley == ValleyKind::Set && !apex).then(|| {
            // Towards the apex is anticlockwise on the right (equation 6.10).
            let way = turned(along, direction(record.valley_angle_deg), -1.0);
            let at = origin + way * (record.valley_distance * length);
            let leaving =
                |degrees, side| Waypoint { at, towards: turned(way, direction(degrees), side) };
            (leaving(record.valley_lower_deg, 1.0), leaving(record.valley_upper_deg, -1.0))
        });
        Self {
            origin,
            tension: record.tension,
            lower: Half::new(&record.lower, 1.0),
            // The halves of a lobe at the apex are both taken as right ones.
            upper: Half::new(&record.upper, if apex { 1.0 } else { -1.0 }),
            valley,
            by_chord: record.flanks == FlankKind::Chord,
            direction: along,
            length,
            bend: if apex { 0.0 } else { Angle::from_degrees(record.bend_deg).radians() / 2.0 },
            notch: direction(record.notch_angle_deg),
        }
    }

    pub(super) fn tip(&self) -> DVec2 {
        self.origin + self.direction * self.length
    }

    /// A place and the direction of the vein there, `along` it (0–1) and `across` (lobe lengths).
    ///
    /// A bent vein is an arc whose ends are those of the straight one.
    fn frame(&self, across: f64, along: f64, side: f64) -> (DVec2, DVec2) {
        let (place, ahead) = if self.bend == 0.0 {
            (DVec2::new(along, 0.0), self.direction)
        } else {
            let here = self.bend * (1.0 - 2.0 * along);
            let (sine, cosine) = (libm::sin(self.bend), libm::cos(self.bend));
            let (sine_here, cosine_here) = (libm::sin(here), libm::cos(here));
            let place = DVec2::new(sine - sine_here, cosine_here - cosine) / (2.0 * sine);
            // It starts turned away from the apex and ends turned towards it.
            (place, turned(self.direction, DVec2::new(sine_here, cosine_here), 1.0))
        };
        // What the arc sags by is away from the apex.
        let on = self.direction * place.x - self.direction.perp() * place.y;
        let out = -ahead.perp() * side;
        (self.origin + (on + out * across) * self.length, ahead)
    }

    /// How the margin leaves `from`, at the base of the half.
    pub(super) fn leaving(&self, half: Half, from: DVec2) -> Waypoint {
        let (_, ahead) = self.frame(0.0, 0.0, half.side);
        Waypoint { at: from, towards: turned(ahead, half.base, half.side) }
    }

    /// How it leaves the valley at the apex of the leaf.
    pub(super) fn notch(&self) -> Waypoint {
        Waypoint { at: DVec2::Y, towards: self.notch }
    }

    /// The valley between this lobe and the next when they do not meet.
    pub(super) fn strip(&self, next: &Self) -> (Waypoint, Waypoint) {
        let way = (self.direction + next.direction).normalize_or(self.direction);
        let reach = STRIP * self.length.min(next.length);
        let at = (self.origin + next.origin) * 0.5 + way * reach;
        let leaving =
            |side| Waypoint { at, towards: turned(way, direction(STRIP_ANGLE_DEG), side) };
        (leaving(1.0), leaving(-1.0))
    }

    /// The waypoints of a half from `start` to the tip; the waist only when it lies between them
    /// (section 6.3).
    pub(super) fn waypoints(&self, list: &mut Vec<Waypoint>, half: Half, start: Waypoint) {
        if self.by_chord {
            let chord = self.tip() - start.at;
            let out = -chord.perp() * half.side;
            let at = start.at + chord * half.waist.y + out * half.waist.x;
            list.push(start);
            list.push(Waypoint { at, towards: chord.normalize_or(self.direction) });
            list.push(self.arriving(half));
            return;
        }
        let reached = (start.at - self.origin).dot(self.direction) / self.length;
        list.push(start);
        if reached < half.waist.y {
            let (at, towards) = self.frame(half.waist.x, half.waist.y, half.side);
            list.push(Waypoint { at, towards });
        }
        list.push(self.arriving(half));
    }

    /// How the margin of a half reaches the tip.
    fn arriving(&self, half: Half) -> Waypoint {
        let (_, ahead) = self.frame(0.0, 1.0, half.side);
        Waypoint { at: self.tip(), towards: turned(ahead, half.apex, -half.side) }
    }
}
