//! A vein in the coordinates of the blade that bears it: it follows when the blade changes.

use glam::DVec2;

use super::super::curve;
use super::laid::Laid;
use crate::geometry::geodesic::Geodesics;
use crate::margin::morph::MarginSide;
use crate::veins::graph::VeinKind;

/// Where a vein runs in one leaf.
#[derive(Debug, Clone)]
pub(super) struct Strand {
    /// The share of its parent at which it leaves.
    pub(super) from: f64,
    /// The place of the margin nearest to its end.
    pub(super) left: bool,
    pub(super) measure: f64,
    /// The way to its end seen from that to the place on the margin: turned and stretched as the product of
    /// complex numbers says.
    pub(super) to: DVec2,
    /// The strand its end was joined to, and the share of that.
    pub(super) joined: Option<(usize, f64)>,
    pub(super) course: Course,
}

/// How a vein runs between its ends, at equal steps.
#[derive(Debug, Clone)]
pub(super) enum Course {
    /// In complex parts of the way from end to end.
    Across(Vec<DVec2>),
    /// Along the margin: measures, and how far inside (lengths).
    Along(Vec<(f64, f64)>),
}

/// The sides of a blade of length 1, right and left.
pub(super) type Sides = [MarginSide; 2];

/// Points to a vein.
fn count(kind: VeinKind) -> usize {
    match kind {
        VeinKind::Primary => 48,
        VeinKind::Secondary | VeinKind::Intersecondary => 32,
        VeinKind::Intramarginal | VeinKind::Marginal => 24,
        VeinKind::Exterior => 16,
        VeinKind::Tertiary | VeinKind::Minor => 12,
    }
}

/// a / b as complex numbers; 0 where b is.
fn quotient(a: DVec2, b: DVec2) -> DVec2 {
    let square = b.length_squared();
    if square > 0.0 { DVec2::new(b.x, -b.y).rotate(a) / square } else { DVec2::ZERO }
}

/// The place of the margin that a vein with this end is measured by.
fn landing(end: DVec2, sides: &Sides) -> (bool, f64) {
    let [right, left] = sides.each_ref().map(|side| side.nearest(end));
    if left.1 < right.1 { (true, left.0) } else { (false, right.0) }
}

impl Strand {
    pub(super) fn of(vein: &Laid, sides: &Sides) -> Self {
        let line = curve::resampled_to(&vein.line, count(vein.rank.kind));
        let (from, end) = (line[0], line[line.len() - 1]);
        let (left, measure) = landing(end, sides);
        let side = &sides[usize::from(left)];
        let to = quotient(end - from, side.at(measure) - from);
        let course = match vein.rank.kind {
            VeinKind::Intramarginal | VeinKind::Marginal => {
                let hand = if left { -1.0 } else { 1.0 };
                let place = |p: &DVec2| {
                    let measure = side.nearest(*p).0;
                    let inwards = side.ahead(measure).perp() * hand;
                    (measure, (*p - side.at(measure)).dot(inwards))
                };
                Course::Along(line.iter().map(place).collect())
            }
            _ => Course::Across(line.iter().map(|p| quotient(*p - from, end - from)).collect()),
        };
        let from = vein.parent.map_or(0.0, |(_, share)| share);
        Self { from, left, measure, to, joined: None, course }
    }

    /// The end of a vein that leaves at `from`, by the margin alone.
    fn end(&self, from: DVec2, sides: &Sides) -> DVec2 {
        from + self.to.rotate(sides[usize::from(self.left)].at(self.measure) - from)
    }
}

/// An end that moves by no more of its side of the margin follows that. One that goes from lobe to lobe
/// would run round them, far faster than anything else moves; it takes the shortest way inside the blade.
const ALONG: f64 = 0.1;

/// A vein between that of the first leaf and that of the last, as `share` of the last.
pub(super) struct Between<'a> {
    pub(super) of: &'a [Strand; 2],
    pub(super) share: f64,
    pub(super) sides: &'a Sides,
    /// What lies inside the blade.
    pub(super) inside: &'a Geodesics,
}

impl Between<'_> {
    fn mix(&self, value: impl Fn(&Strand) -> f64) -> f64 {
        let [a, b] = self.of.each_ref().map(value);
        a + (b - a) * self.share
    }

    /// Where on its parent it leaves.
    pub(super) fn from(&self) -> f64 {
        self.mix(|strand| strand.from)
    }

    /// Its line from a place on its parent; `met` has where strands lie that its ends are joined to.
    pub(super) fn line(&self, from: DVec2, met: [Option<DVec2>; 2]) -> Vec<DVec2> {
        let end = self.end(from, met);
        match self.of.each_ref().map(|strand| &strand.course) {
            [Course::Across(a), Course::Across(b)] => {
                let parts = a.len().max(b.len()) - 1;
                let part = |row: &[DVec2], i: usize| {
                    let at = i as f64 / parts as f64 * (row.len() - 1) as f64;
                    let k = (at as usize).min(row.len() - 2);
                    row[k].lerp(row[k + 1], at - k as f64)
                };
                let place =
                    |i: usize| from + part(a, i).lerp(part(b, i), self.share).rotate(end - from);
                (0..=parts).map(place).collect()
            }
            [Course::Along(a), Course::Along(b)] => {
                let [own, other] = self.of.each_ref().map(|strand| strand.left);
                let side = &self.sides[usize::from(own)];
                let hand = if own { -1.0 } else { 1.0 };
                let share = if own == other { self.share } else { 0.0 };
                let place = |(a, b): (&(f64, f64), &(f64, f64))| {
                    let measure = a.0 + (b.0 - a.0) * share;
                    let inside = a.1 + (b.1 - a.1) * share;
                    side.at(measure) + side.ahead(measure).perp() * (hand * inside)
                };
                let mut line: Vec<DVec2> = a.iter().zip(b).map(place).collect();
                line[0] = from;
                line
            }
            // Groups keep these apart.
            _ => vec![from, end],
        }
    }

    fn end(&self, from: DVec2, met: [Option<DVec2>; 2]) -> DVec2 {
        let [a, b] = self.of;
        if met == [None, None] && a.left == b.left && (a.measure - b.measure).abs() < ALONG {
            let at = self.sides[usize::from(a.left)].at(self.mix(|strand| strand.measure));
            return from + a.to.lerp(b.to, self.share).rotate(at - from);
        }
        let [first, last] =
            [0, 1].map(|k| met[k].unwrap_or_else(|| self.of[k].end(from, self.sides)));
        // No straight way: it may lead over a sinus.
        let way = self.inside.way(first, last);
        way.map_or(first.lerp(last, self.share), |way| curve::at(&way, self.share).0)
    }
}
