//! The stalk of the leaf: drawn over the blade behind, and in front from the base down.
//!
//! Source: Foster, section 2.3.6. Departs from it: a bent, tapered stalk, cut off where it sat on the stem, its
//! width and colour running into the midrib's, instead of a line; in front it lies over the lobes beside it.

use std::ops::Range;

use glam::{DVec2, Vec2};

use super::pigment::Hsv;
use super::tissue::smooth;
use crate::geometry::Rect;
use crate::parameter::parameters;
use crate::raster::coverage::{Capsule, stroke_share};
use crate::units::{Angle, TextureFrame};

parameters! {
    /// The stalk of the leaf.
    pub struct PetioleSpec {
        /// Length below the base of the blade; 0 for a sessile leaf.
        length_mm: number(15.0, 0.0..=1000.0, "mm"),
        /// Width at the stem; it narrows to the midrib's at the blade.
        width_mm: number(1.8, 0.05..=100.0, "mm"),
        /// How far it bends aside, as the angle between its two ends.
        bend_deg: number(8.0, -80.0..=80.0, "deg"),
        /// Its colour.
        colour: group(Hsv, Hsv { hue_deg: 70.0, saturation: 0.45, value: 0.55 }),
    }
}

/// A stalk is thicker by this share where it sat on the stem, over so many of its radii.
const CUSHION: f64 = 0.14;
const CUSHION_RADII: f32 = 7.0;

/// How far its end bulges out, in radii: a scar, no ball.
const SCAR: f32 = 0.22;

/// Straight pieces of the line around that.
const END_PIECES: usize = 8;

/// Straight pieces of the stalk: at 80° of bend they turn by 2° each, which no eye finds.
const PIECES: usize = 40;

/// A stalk in leaf space: points from the midrib over the base to the stem, with radii (mm).
#[derive(Debug, Clone)]
pub(super) struct Stalk {
    points: Vec<DVec2>,
    radii: Vec<f64>,
    /// Distance of each point from the blade along the stalk (mm), negative above the base.
    along: Vec<f64>,
}

/// The stalk runs on along the midrib over so many of its radii, thinning: a blade that narrows to
/// a point would else stand on it with a notch.
const ROOT_RADII: f64 = 13.0;

/// What the stalk is at one texel.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct StalkAt {
    /// How much of the texel it covers (0–1).
    pub cover: f32,
    /// How far down from the blade (mm).
    pub along: f32,
    /// Radius here (mm).
    pub radius: f32,
    /// Height of the round stalk over its axis' plane (mm).
    pub dome: f32,
}

/// A straight midrib wanders by up to so many degrees beside its base.
const STRAIGHT_DEG: f64 = 10.0;

/// Over this share of its length the stalk turns back from where such a midrib leads it.
const RETURN: f32 = 0.35;

impl Stalk {
    /// The stalk of a leaf whose midrib runs from the base along `midrib` and has `neck` as its
    /// radius there (mm). It `leads` where the petiole goes on from it, bent as it is.
    pub(super) fn new(spec: &PetioleSpec, neck: f64, midrib: &[DVec2], leads: bool) -> Self {
        let length = spec.length_mm;
        if length <= 0.0 {
            return Self { points: vec![DVec2::ZERO], radii: vec![0.0], along: vec![0.0] };
        }
        let (mut points, mut radii, mut along) = Self::root(neck, midrib);
        let stem_radius = 0.5 * spec.width_mm;
        // A circular arc that leaves the blade along the midrib.
        let step = length / PIECES as f64;
        let off_deg = if leads { Self::off_deg(neck, midrib) } else { 0.0 };
        let wander_deg = off_deg.clamp(-STRAIGHT_DEG, STRAIGHT_DEG);
        let mut point = DVec2::ZERO;
        let share = |pieces: usize| pieces as f32 / PIECES as f32;
        for i in 0..=PIECES {
            let t = share(i);
            // Most of the widening right below the blade, then a slow taper.
            let widening = f64::from(0.6 * smooth(0.0, 0.55, t) + 0.4 * t);
            // The cushion by which it sits on the stem.
            let left = (length - step * i as f64) / stem_radius;
            let cushion = 1.0 + CUSHION * f64::from(1.0 - smooth(0.0, CUSHION_RADII, left as f32));
            points.push(point);
            radii.push((neck + (stem_radius - neck) * widening) * cushion);
            along.push(step * i as f64);
            let next = share(i + 1);
            let back = wander_deg * f64::from(smooth(0.0, RETURN, next));
            let turned = Angle::from_degrees(off_deg - back + spec.bend_deg * f64::from(next));
            point += DVec2::new(turned.cos(), turned.sin()).rotate(DVec2::NEG_Y) * step;
        }
        Self { points, radii, along }
    }

    /// How far a midrib is turned aside at its base (degrees, anticlockwise).
    pub(super) fn off_deg(neck: f64, midrib: &[DVec2]) -> f64 {
        let reach = ROOT_RADII * neck;
        let ahead = midrib.iter().find(|p| p.length() >= reach);
        ahead.map_or(0.0, |ahead| DVec2::Y.angle_to(*ahead).to_degrees())
    }

    /// The part along the midrib, from its thin end down to the base, which is not in it.
    fn root(neck: f64, midrib: &[DVec2]) -> (Vec<DVec2>, Vec<f64>, Vec<f64>) {
        let reach = ROOT_RADII * neck;
        let (mut points, mut radii, mut along) = (Vec::new(), Vec::new(), Vec::new());
        let (mut last, mut walked) = (DVec2::ZERO, 0.0);
        for &p in midrib {
            walked += last.distance(p);
            last = p;
            if walked >= reach {
                break;
            }
            if walked > 0.0 {
                points.push(p);
                radii.push(neck * (1.0 - 0.85 * (walked / reach).powi(2)));
                along.push(-walked);
            }
        }
        points.reverse();
        radii.reverse();
        along.reverse();
        (points, radii, along)
    }

    /// The far end of its axis (mm).
    pub(super) fn end(&self) -> DVec2 {
        self.points[self.points.len() - 1]
    }

    /// The line around it (mm), anticlockwise; nothing where there is none.
    pub(super) fn outline(&self) -> Vec<DVec2> {
        let last = self.points.len() - 1;
        if last == 0 {
            return Vec::new();
        }
        let ahead = |i: usize| {
            let (a, b) = (self.points[i.saturating_sub(1)], self.points[(i + 1).min(last)]);
            (b - a).normalize_or_zero()
        };
        let side = |i: usize, turn: f64| self.points[i] - ahead(i).perp() * (turn * self.radii[i]);
        // Down on the left of who looks at it, around the end, and up again.
        let end = (1..END_PIECES).map(|k| {
            let turned = Angle::from_degrees(180.0 * k as f64 / END_PIECES as f64);
            let radius = self.radii[last];
            let aside = -ahead(last).perp() * (turned.cos() * radius);
            self.points[last] + aside + ahead(last) * (turned.sin() * f64::from(SCAR) * radius)
        });
        let (down, up) =
            ((0..=last).map(|i| side(i, 1.0)), (0..=last).rev().map(|i| side(i, -1.0)));
        down.chain(end).chain(up).collect()
    }

    /// The greatest radius (mm).
    pub(super) fn widest(&self) -> f64 {
        self.radii.iter().copied().fold(0.0, f64::max)
    }

    /// The box around it (mm).
    pub(super) fn bounds(&self) -> Rect {
        let ends = self
            .points
            .iter()
            .zip(&self.radii)
            .flat_map(|(&p, &r)| [p - DVec2::splat(r), p + DVec2::splat(r)]);
        Rect::around(ends)
    }

    /// The stalk over some rows of a texture, row by row; `None` when it is not in them.
    pub(super) fn rows(
        &self,
        frame: &TextureFrame,
        size: usize,
        rows: Range<usize>,
    ) -> Option<Vec<StalkAt>> {
        let per_mm = frame.pixels_per_mm(size);
        let mm = 1.0 / per_mm as f32;
        let [before, at] = [2, 1].map(|back| {
            let point = self.points[self.points.len().saturating_sub(back)];
            frame.pixel_from_leaf(point, size).as_vec2()
        });
        let radius = (self.radii[self.radii.len() - 1] * per_mm) as f32;
        let along = self.along[self.along.len() - 1] as f32;
        let end = End { at, ahead: (at - before).normalize_or_zero(), radius, along };
        // And how far from the axis each texel is, squared.
        let mut texels: Option<(Vec<StalkAt>, Vec<f32>)> = None;
        for i in 1..self.points.len() {
            let capsule = Capsule {
                a: frame.pixel_from_leaf(self.points[i - 1], size).as_vec2(),
                b: frame.pixel_from_leaf(self.points[i], size).as_vec2(),
                radius_a: (self.radii[i - 1] * per_mm) as f32,
                radius_b: (self.radii[i] * per_mm) as f32,
            };
            let (from, to) = (self.along[i - 1] as f32, self.along[i] as f32);
            let [columns, lines] = capsule.pixels(capsule.widest() + 0.5, size, rows.clone());
            for y in lines {
                let (texels, nearest) = texels.get_or_insert_with(|| {
                    let count = size * rows.len();
                    (vec![StalkAt::default(); count], vec![f32::INFINITY; count])
                });
                for x in columns.clone() {
                    let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    let (mut distance2, t) = capsule.nearest(centre);
                    let (mut radius, mut along) = (capsule.radius(t), from + (to - from) * t);
                    // Of a short stalk many pieces reach over the end.
                    if let Some(beyond) = end.beyond(centre) {
                        (distance2, radius, along) = (beyond, end.radius, end.along);
                    }
                    let index = (y - rows.start) * size + x;
                    // Neighbouring pieces overlap: the wide round end of a short stalk lies over all of it.
                    if distance2 >= nearest[index] {
                        continue;
                    }
                    nearest[index] = distance2;
                    texels[index] = StalkAt {
                        cover: stroke_share(distance2.sqrt(), radius, 0.5),
                        radius: radius * mm,
                        dome: (radius * radius - distance2).max(0.0).sqrt() * mm,
                        along,
                    };
                }
            }
        }
        texels.map(|(texels, _)| texels)
    }
}

/// Where a stalk is cut off (pixels).
struct End {
    at: Vec2,
    ahead: Vec2,
    radius: f32,
    /// From the blade (mm).
    along: f32,
}

impl End {
    /// The squared distance of a point beyond the end, by which it is a flat ellipse instead of a ball; nothing of
    /// other points.
    fn beyond(&self, p: Vec2) -> Option<f32> {
        let to = p - self.at;
        let along = to.dot(self.ahead);
        // A bent stalk may pass the line of its end elsewhere.
        let here = along > 0.0 && to.length_squared() < (2.0 * self.radius).powi(2);
        here.then(|| to.length_squared() - along * along + (along / SCAR).powi(2))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bend_is_the_angle_between_the_ends() {
        let spec = PetioleSpec { bend_deg: 80.0, ..PetioleSpec::default() };
        let midrib = [DVec2::ZERO, DVec2::new(0.1, 1.0), DVec2::Y * 9.0];
        let stalk = Stalk::new(&spec, 0.4, &midrib, true);
        assert_eq!(stalk.along[..2], [-DVec2::new(0.1, 1.0).length(), 0.0]);
        let last = stalk.points[PIECES + 1] - stalk.points[PIECES];
        assert!((last.angle_to(DVec2::NEG_Y).abs().to_degrees() - 80.0).abs() < 1e-6);
        assert!(stalk.end().x > 0.0 && stalk.end().y < 0.0);
        assert!((stalk.radii[1] - 0.4).abs() < 1e-12);
    }

    #[test]
    fn the_end_is_cut_off_however_short_the_stalk() {
        for length_mm in [1.0, 30.0] {
            let spec = PetioleSpec { length_mm, width_mm: 2.0, ..PetioleSpec::default() };
            let stalk = Stalk::new(&spec, 0.6, &[], true);
            let frame = TextureFrame { min: stalk.end() - DVec2::splat(4.0), side_mm: 8.0 };
            let rows = stalk.rows(&frame, 256, 0..256).expect("a stalk");
            let ahead = Angle::from_degrees(spec.bend_deg);
            let ahead = DVec2::new(ahead.cos(), ahead.sin()).rotate(DVec2::NEG_Y);
            let cover = |along: f64, across: f64| {
                let p =
                    frame.pixel_from_leaf(stalk.end() + ahead * along + ahead.perp() * across, 256);
                rows[p.y as usize * 256 + p.x as usize].cover
            };
            // A ball would reach as far as the stalk is thick.
            for (along, across, seen) in [
                (-0.1, 0.9, 1.0),
                (-0.1, -0.9, 1.0),
                (0.15, 0.0, 1.0),
                (0.35, 0.0, 0.0),
                (0.3, 0.5, 0.0),
            ] {
                assert_eq!(cover(along, across), seen, "{length_mm} {along} {across}");
            }
        }
    }

    #[test]
    fn the_line_around_it_is_as_wide_and_as_long_as_it() {
        let spec = PetioleSpec { length_mm: 20.0, bend_deg: 0.0, ..PetioleSpec::default() };
        let stalk = Stalk::new(&spec, 0.6, &[], true);
        let outline = stalk.outline();
        let area = crate::geometry::polygon::signed_area(&outline);
        let mean = stalk.radii.windows(2).map(|r| r[0] + r[1]).sum::<f64>() / PIECES as f64;
        assert!((area - 20.0 * mean).abs() < 0.6, "{area} {mean}");
        let bounds = Rect::around(outline);
        assert!((bounds.max.x - stalk.widest()).abs() < 1e-6 && bounds.max.y.abs() < 1e-9);
        assert!((bounds.min.y + 20.0 + f64::from(SCAR) * stalk.radii[PIECES]).abs() < 1e-6);
    }

    #[test]
    fn a_sessile_leaf_has_none() {
        let spec = PetioleSpec { length_mm: 0.0, ..PetioleSpec::default() };
        let stalk = Stalk::new(&spec, 0.4, &[], true);
        assert_eq!(stalk.outline(), []);
        assert_eq!((stalk.end(), stalk.widest()), (DVec2::ZERO, 0.0));
    }

    #[test]
    fn a_midrib_bent_at_its_base_takes_the_petiole_along() {
        let spec = PetioleSpec { length_mm: 20.0, bend_deg: 0.0, ..PetioleSpec::default() };
        let stalk = |off_deg: f64, leads: bool| {
            let (sine, cosine) = off_deg.to_radians().sin_cos();
            let midrib = [DVec2::ZERO, DVec2::new(sine, cosine) * 30.0];
            Stalk::new(&spec, 0.4, &midrib, leads)
        };
        // To the left of straight down, where it leaves the blade and at its end.
        let leans = |stalk: &Stalk| {
            let lean = |i: usize| {
                let way = stalk.points[i] - stalk.points[i - 1];
                way.angle_to(DVec2::NEG_Y).to_degrees()
            };
            [lean(1), lean(PIECES)]
        };
        let several = stalk(40.0, false);
        assert!(several.end().distance(DVec2::NEG_Y * 20.0) < 1e-9, "one of several");
        for (off, [leaves, ends]) in [(9.0, [9.0, 0.0]), (-9.0, [-9.0, 0.0]), (40.0, [40.0, 30.0])]
        {
            let found = leans(&stalk(off, true));
            assert!((found[0] - leaves).abs() < 0.2, "{off}: no kink below the blade, {found:?}");
            assert!((found[1] - ends).abs() < 1e-9, "{off}: a straight one wanders, {found:?}");
        }
    }
}
