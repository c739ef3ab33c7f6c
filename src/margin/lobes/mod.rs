//! Margins of several lobes: one unilobed blade along each vein, joined at valleys.
//!
//! Source: S. Garg, *Procedural modelling and constrained morphing of leaves*, PhD thesis, 2011,
//! chapter 6. Here a leaf is a list of [`LobeRecord`]s, every lobe with numbers of its own, as the
//! thesis allows (sections 6.1 and 6.2); its 26 numbers are a shorthand that expands to such a list
//! ([`shorthand`]). Fitting and morphing work on records.
//!
//! [`outline`] is a pure function of the records. Each half of a lobe is the curve of
//! [`super::curve`] through valley, waist and tip (through valley and tip when the waist lies below
//! the valley, section 6.3). Departures, where the thesis is silent or leaves no blade:
//!
//! - A lower and an upper half, seen from the base, in place of left and right: so that a lobe and
//!   its mirror image have the same numbers.
//! - The margin starts at the base (0, 0) also when the first lobe's vein leaves higher up.
//! - Neighbours that do not meet are joined by a strip of blade along the midrib, where the thesis
//!   has them touch on it: see [`STRIP`].
//! - A set valley that the lobes beside it cover lies where they meet: what is inside of both is no
//!   margin, as in section 6.3 for default valleys.
//! - Basal lobes that would overlap are cut back to a slit along the axis, (see [`SLIT`]).
//!
//! Coordinates are relative to the primary vein (length 1), those inside a lobe to the lobe's vein.

mod meeting;
pub(super) mod mending;
mod place;
pub mod shorthand;

use glam::DVec2;

use super::curve::{self, Waypoint};
use super::{Landmark, LandmarkKind, MarginError, Outline};
use crate::parameter::{parameters, words};
use place::{Half, Lobe};

words! {
    /// Where a lobe stands.
    pub enum LobeSide {
        /// One on the right and its mirror image on the left.
        Both = "both",
        /// One on either side, with numbers of their own where a file gives ranges: the left one as far
        /// its own as `margin.asymmetry` says.
        Each = "each",
        /// Right of the midrib, seen from the front.
        Right = "right",
        /// Left of the midrib.
        Left = "left",
        /// At the end of the midrib; its length is what the midrib has left, its angle 0.
        Apex = "apex",
    }
}

words! {
    /// What makes the valley between a lobe and the next one towards the apex.
    pub enum ValleyKind {
        /// It lies where the two lobes meet.
        Meet = "meet",
        /// It lies at `valley_distance` and `valley_angle_deg`.
        Set = "set",
    }
}

words! {
    /// What the waists of a lobe are measured along.
    pub enum FlankKind {
        /// The vein of the lobe, as in the thesis.
        Vein = "vein",
        /// The line from where the half begins (base or valley) to the tip, in its lengths.
        Chord = "chord",
    }
}

impl LobeSide {
    /// Whether a lobe that stands here has one on `side`, right or left.
    #[must_use]
    pub fn is_on(self, side: Self) -> bool {
        self == side || matches!(self, Self::Both | Self::Each)
    }
}

parameters! {
    /// One half of a lobe, on one side of its vein.
    pub struct HalfLobe {
        /// Half width at the widest place; below 0 where the half is hollow.
        waist_x: number(0.3, -1.0..=3.0, "lobe lengths"),
        /// How far along the vein that is.
        waist_y: number(0.5, 0.02..=0.98, "lobe lengths"),
        /// Angle between vein and margin at the lobe's base; of no effect above a set valley.
        base_angle_deg: number(60.0, -180.0..=180.0, "deg"),
        /// Angle between vein and margin at the tip: 90 for a round one.
        apex_angle_deg: number(40.0, -180.0..=180.0, "deg"),
    }
}

parameters! {
    /// One lobe, and the valley between it and the next one towards the apex. Lobes of a side are
    /// listed from base to apex.
    pub struct LobeRecord {
        /// Where it stands: right, left, on both sides (mirror images), on each (alike as far as ranges
        /// and `margin.asymmetry` leave them so) or at the apex.
        side: choice(LobeSide, LobeSide::Both),
        /// Where on the midrib its vein begins.
        origin: number(0.0, 0.0..=0.98, "lengths"),
        /// Angle between the midrib and its vein.
        angle_deg: number(50.0, 0.0..=180.0, "deg"),
        /// Length of its vein.
        length: number(0.7, 0.02..=3.0, "lengths"),
        /// How far its vein turns on its way, towards the apex where above 0.
        bend_deg: number(0.0, -120.0..=120.0, "deg"),
        /// The half towards the base; the right half of a lobe at the apex.
        lower: group(HalfLobe, HalfLobe::default()),
        /// The half towards the apex; the left half of a lobe at the apex.
        upper: group(HalfLobe, HalfLobe::default()),
        /// Tension of its margin: 1 as in the thesis, less for straighter flanks.
        tension: number(1.0, 0.05..=1.5, ""),
        /// What its waists are measured along: its vein, or the line from base or valley to the tip.
        flanks: choice(FlankKind, FlankKind::Vein),
        /// The valley above it: `meet`, where the two lobes meet, or `set`, at the place given.
        valley: choice(ValleyKind, ValleyKind::Meet),
        /// How far a set valley lies from where the vein begins.
        valley_distance: number(0.5, 0.02..=3.0, "lobe lengths"),
        /// Angle at that place between the vein and the way to the valley, towards the apex.
        valley_angle_deg: number(22.0, -180.0..=180.0, "deg"),
        /// Angle between the way to the valley and the margin, on this lobe's side of the valley:
        /// 0 sharp, 90 smooth.
        valley_lower_deg: number(50.0, -180.0..=180.0, "deg"),
        /// The same on the next lobe's side.
        valley_upper_deg: number(50.0, -180.0..=180.0, "deg"),
        /// Angle between midrib and margin at the apex, where no lobe stands there and this is the
        /// last of its side.
        notch_angle_deg: number(60.0, -180.0..=180.0, "deg"),
        /// Teeth on this lobe, times what `margin.teeth` asks for; 0 for none.
        teeth_count: number(1.0, 0.0..=10.0, ""),
        /// Height of the teeth on this lobe, times what `margin.teeth` asks for.
        teeth_depth: number(1.0, 0.0..=5.0, ""),
    }
}

/// Neighbours that do not meet, or nearer to the midrib than this, leave this share of the shorter lobe
/// between them and it.
pub const STRIP: f64 = 0.08;

/// The margin through the tangent at a valley made by [`STRIP`] (degrees).
const STRIP_ANGLE_DEG: f64 = 60.0;

/// Basal lobes that overlap are cut back to this distance from the axis: they lie edge to edge, a slit
/// of twice this between them, which a texel of a blade 500 texels long just shows.
pub const SLIT: f64 = 0.002;

/// The outline of a leaf of these lobes, relative to the primary vein (length 1): base at (0, 0),
/// apex at (0, 1), lobe tips and valleys as landmarks.
///
/// # Errors
///
/// [`MarginError::Unsuited`] when the list makes no leaf: none at all, two at the apex, or one side bare
/// with no lobe at the apex. That the outline does not cross itself is for
/// [`Margin`](super::Margin) to check.
pub fn outline(records: &[LobeRecord]) -> Result<Outline, MarginError> {
    let wrong = |problem: &str| Err(MarginError::Unsuited(problem.to_owned()));
    let mut at_apex = records.iter().filter(|record| record.side == LobeSide::Apex);
    let apex = at_apex.next();
    if at_apex.next().is_some() {
        return wrong("margin.lobe has more than one record with side = \"apex\"; keep one");
    }
    let on = |side: LobeSide| -> Vec<Lobe> {
        records.iter().filter(|record| record.side.is_on(side)).map(Lobe::new).collect()
    };
    let (right, left) = (on(LobeSide::Right), on(LobeSide::Left));
    if apex.is_none() && (right.is_empty() || left.is_empty()) {
        return wrong(
            "margin.lobe leaves a side without lobes; give lobes of side right and left, or both, or \
             one at the apex",
        );
    }
    let at_apex = apex.map(Lobe::new);
    let mut outline = Outline { points: vec![DVec2::ZERO], ..Outline::default() };
    flank(&mut outline, &right, at_apex.as_ref().map(|lobe| (lobe, lobe.lower)));
    outline.apex = outline.points.len() - 1;
    let kind = match &at_apex {
        Some(lobe) => LandmarkKind::LobeTip { origin: lobe.origin },
        None => LandmarkKind::Valley,
    };
    outline.landmarks.push(Landmark { vertex: outline.apex, kind });
    let same = right == left && at_apex.as_ref().is_none_or(|lobe| lobe.lower == lobe.upper);
    if same {
        mirror(&mut outline, None);
    } else {
        let mut other = Outline { points: vec![DVec2::ZERO], ..Outline::default() };
        flank(&mut other, &left, at_apex.as_ref().map(|lobe| (lobe, lobe.upper)));
        mirror(&mut outline, Some(other));
    }
    Ok(outline)
}

/// Adds the left side: the mirror image of `other` (of the right side itself, if none), from the apex
/// down.
fn mirror(outline: &mut Outline, other: Option<Outline>) {
    let apex = outline.apex;
    let right = outline.landmarks.iter().filter(|mark| mark.vertex < apex).copied().collect();
    let (points, marks) = match other {
        Some(other) => (other.points, other.landmarks),
        None => (outline.points[..=apex].to_vec(), right),
    };
    let last = points.len() - 1;
    let flipped = |p: &DVec2| DVec2::new(-p.x, p.y);
    outline.points.extend(points[1..last].iter().rev().map(flipped));
    outline.landmarks.extend(
        marks.iter().rev().map(|mark| Landmark { vertex: apex + last - mark.vertex, ..*mark }),
    );
}

/// Adds the right side from the base to the apex; `apex` is the lobe there and its half.
fn flank(outline: &mut Outline, lobes: &[Lobe], apex: Option<(&Lobe, Half)>) {
    let mut upward = Vec::with_capacity(3);
    let mut start = lobes
        .first()
        .map(|lobe| (lobe, lobe.lower))
        .or(apex)
        .map(|(lobe, half)| lobe.leaving(half, DVec2::ZERO));
    for (i, lobe) in lobes.iter().enumerate() {
        // The lower half, unless the valley below has drawn it already.
        if let Some(start) = start.take() {
            upward.clear();
            lobe.waypoints(&mut upward, lobe.lower, start);
            curve::append(&mut outline.points, &upward, lobe.tension);
            cut_back(&mut outline.points);
        }
        let vertex = outline.points.len() - 1;
        let kind = LandmarkKind::LobeTip { origin: lobe.origin };
        outline.landmarks.push(Landmark { vertex, kind });
        let next = lobes.get(i + 1).map(|next| (next, next.lower)).or(apex);
        let Some((next, half)) = next else {
            let notch = lobe.notch();
            upward.clear();
            lobe.waypoints(&mut upward, lobe.upper, notch);
            curve::append_reversed(&mut outline.points, &upward, lobe.tension);
            return;
        };
        let pair = (lobe, next, half);
        let own = (lobe.leaving(lobe.upper, lobe.origin), next.leaving(half, next.origin));
        let met = lobe.valley.is_none() && meeting::join(outline, pair, own);
        if !met {
            meeting::join(outline, pair, lobe.valley.unwrap_or_else(|| lobe.strip(next)));
        }
    }
    if let (Some(start), Some((lobe, half))) = (start, apex) {
        upward.clear();
        lobe.waypoints(&mut upward, half, start);
        curve::append(&mut outline.points, &upward, lobe.tension);
    }
}

/// Cuts the lowest lobe back where it would reach over the axis below the base. `points` runs from the
/// base to the tip of that lobe.
fn cut_back(points: &mut Vec<DVec2>) {
    let over = |p: &DVec2| p.x < SLIT && p.y < 0.0;
    let last = points.len() - 1;
    let Some(end) = points[1..last].iter().rposition(over).map(|i| i + 1) else { return };
    // Beside the base itself the margin may run close to the axis.
    if !points[1..=end].iter().any(|p| p.x < 0.0) {
        return;
    }
    let (a, b) = (points[end], points[end + 1]);
    let exit = a.lerp(b, (SLIT - a.x) / (b.x - a.x));
    points.splice(1..=end, [DVec2::new(SLIT, exit.y)]);
}

#[cfg(test)]
mod tests;
