//! Puts an outline from elsewhere into leaf space: finds the petiole and cuts it off, finds the tip,
//! turns and scales the blade so that its base is at the origin and its apex on the +y axis.
//!
//! Outlines come with y up; `base` says how the two ends are told apart.

mod base;
mod stalk;

use glam::DVec2;

use super::{Margin, MarginError};
use crate::geometry::{Rect, polygon};
use base::{Base, Shape};
use stalk::Stalk;

/// What told where the petiole is attached.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// The user.
    Given,
    /// A thin stalk, cut off here.
    Stalk,
    /// The rest of a petiole too short to cut off.
    Nub,
    /// A notch in the base.
    Notch,
    /// The end of the blade that looks most like a base.
    End,
}

/// An outline in leaf space.
#[derive(Debug, Clone, PartialEq)]
pub struct Placed {
    /// The outline (mm): base first, anticlockwise.
    pub outline: Vec<DVec2>,
    /// Slits inside (mm).
    pub cuts: Vec<Vec<DVec2>>,
    /// Index of the apex.
    pub apex: usize,
    /// Where the base was, in the coordinates of the input.
    pub base_was: DVec2,
    /// Where the apex was, in the coordinates of the input.
    pub apex_was: DVec2,
    /// What told where the base is.
    pub found: Found,
}

/// A root this far from the outline, as a share of the leaf's extent, still means the outline.
const ROOT_REACH: f64 = 0.05;
/// Points of the ring on which an outline is judged, over the extent of the leaf.
const STEPS: f64 = 450.0;

/// Places an outline of either winding, y up; `root` is where the petiole is attached, if known.
///
/// # Errors
///
/// [`MarginError::NotFinite`], [`MarginError::TooFewPoints`] and [`MarginError::NoArea`] for what
/// is no outline, [`MarginError::Root`] for a root away from the leaf.
pub fn place(
    outline: &[DVec2],
    cuts: &[Vec<DVec2>],
    root: Option<DVec2>,
    length_mm: f64,
) -> Result<Placed, MarginError> {
    if let Some(index) = outline.iter().position(|p| !p.is_finite()) {
        return Err(MarginError::NotFinite { index });
    }
    // To numbers near one, whatever the unit of the input.
    let bounds = Rect::around(outline.iter().copied());
    let extent = bounds.size().max_element();
    if !(extent > 0.0 && extent.is_finite()) {
        return Err(MarginError::NoArea { area_mm2: 0.0 });
    }
    let near_one = |p: &DVec2| (*p - bounds.min) / extent;
    let unit: Vec<DVec2> = outline.iter().map(near_one).collect();
    let mut unit = polygon::without_short_edges(&unit, 1e-9);
    if unit.len() < 3 {
        return Err(MarginError::TooFewPoints { count: unit.len(), least: 3 });
    }
    let area = polygon::signed_area(&unit);
    if area.abs() < 1e-5 {
        return Err(MarginError::NoArea { area_mm2: area * extent * extent });
    }
    if area < 0.0 {
        unit.reverse();
    }

    let ring = polygon::resampled(&unit, 1.0 / STEPS);
    let shape = Shape::of(&ring);
    let base = match root {
        Some(root) => at_root(&shape, &unit, near_one(&root))
            .map_err(|problem| MarginError::Root { x: root.x, y: root.y, problem })?,
        None => shape.base(),
    };
    let tip = shape.tip(base.at);

    let mut blade = vec![base.at];
    let around = Around::of(&unit);
    let (start, end) = match base.stalk {
        Some(Stalk { from, to, .. }) => (around.nearest(ring[to]), around.nearest(ring[from])),
        None => {
            let at = around.nearest(base.at);
            (at, at)
        }
    };
    blade.extend(around.between(start, end));
    let apex = with_vertex_at(&mut blade, tip, 2.0 / STEPS);

    // Turn, scale, and put the two ends exactly where they belong.
    let along = blade[apex];
    let axis = along - base.at;
    let scale = length_mm / axis.length();
    let turn = axis.normalize();
    let to_leaf = |p: &DVec2| {
        let off = *p - base.at;
        DVec2::new(-turn.perp_dot(off), turn.dot(off)) * scale
    };
    let mut placed: Vec<DVec2> = blade.iter().map(to_leaf).collect();
    placed[0] = DVec2::ZERO;
    placed[apex] = DVec2::new(0.0, length_mm);
    let (placed, apex) = without_crowding(&placed, apex);
    let cuts = cuts.iter().map(|line| line.iter().map(|p| to_leaf(&near_one(p))).collect());
    let cuts = inside(&placed, cuts.collect());
    Ok(Placed {
        cuts,
        outline: placed,
        apex,
        base_was: bounds.min + base.at * extent,
        apex_was: bounds.min + along * extent,
        found: base.found,
    })
}

/// The base that a given root means: the stalk it is on or beside, or else the nearest point of the
/// outline.
fn at_root(shape: &Shape<'_>, outline: &[DVec2], root: DVec2) -> Result<Base, String> {
    if !root.is_finite() {
        return Err("is not a finite place".into());
    }
    let nearest = polygon::edges(outline)
        .map(|(a, b)| polygon::nearest_on_segment(a, b, root))
        .min_by(|p, q| p.distance_squared(root).total_cmp(&q.distance_squared(root)))
        .ok_or("has no outline near it")?;
    let away = nearest.distance(root);
    if away > ROOT_REACH && !polygon::contains(outline, root) {
        return Err(format!(
            "lies outside the leaf, {:.0} % of its size away from it (at most {:.0} %); put it \
             where the petiole meets the blade",
            away * 100.0,
            ROOT_REACH * 100.0
        ));
    }
    let on = (0..shape.ring.len()).min_by(|&i, &j| {
        let off = |i: usize| shape.ring[i].distance_squared(nearest);
        off(i).total_cmp(&off(j))
    });
    let stalk = shape
        .stalks
        .iter()
        .find(|stalk| on.is_some_and(|i| stalk.holds(i)) || stalk.attachment.distance(root) < 0.03);
    Ok(Base {
        at: stalk.map_or(nearest, |stalk| stalk.attachment),
        found: Found::Given,
        stalk: stalk.copied(),
    })
}

/// Places on a polygon by the length of the way there from vertex 0.
struct Around<'a> {
    polygon: &'a [DVec2],
    ways: Vec<f64>,
}

impl<'a> Around<'a> {
    fn of(polygon: &'a [DVec2]) -> Self {
        let mut way = 0.0;
        let mut ways = vec![0.0];
        ways.extend(polygon::edges(polygon).map(|(a, b)| {
            way += a.distance(b);
            way
        }));
        Self { polygon, ways }
    }

    /// The way to the boundary's point nearest to `p`.
    fn nearest(&self, p: DVec2) -> f64 {
        let mut best = (f64::INFINITY, 0.0);
        for (i, (a, b)) in polygon::edges(self.polygon).enumerate() {
            let q = polygon::nearest_on_segment(a, b, p);
            let off = q.distance_squared(p);
            if off < best.0 {
                best = (off, self.ways[i] + a.distance(q));
            }
        }
        best.1
    }

    fn at(&self, way: f64) -> DVec2 {
        let n = self.polygon.len();
        let i = self.ways.partition_point(|&w| w <= way).clamp(1, n) - 1;
        let (a, b) = (self.polygon[i], self.polygon[(i + 1) % n]);
        a + (b - a).normalize_or_zero() * (way - self.ways[i])
    }

    /// The points from one place forward to another, both included; all the way round when they
    /// are the same, then without them.
    fn between(&self, start: f64, end: f64) -> Vec<DVec2> {
        let n = self.polygon.len();
        let whole = start == end;
        let mut points = Vec::with_capacity(n + 2);
        if !whole {
            points.push(self.at(start));
        }
        let first = self.ways.partition_point(|&w| w <= start);
        let total = self.ways[n];
        let length = if end > start { end - start } else { end + total - start };
        for k in 0..n {
            let i = first + k;
            let way = self.ways[i % n] + if i >= n { total } else { 0.0 };
            if way - start >= length * (1.0 - 1e-12) {
                break;
            }
            points.push(self.polygon[i % n]);
        }
        if !whole {
            points.push(self.at(end));
        }
        points
    }
}

/// The index of the vertex at `tip`: the one farthest from vertex 0 of those within `reach`, or else
/// a new one on the boundary.
fn with_vertex_at(blade: &mut Vec<DVec2>, tip: DVec2, reach: f64) -> usize {
    let far = |i: usize| blade[i].distance_squared(blade[0]);
    let near = (1..blade.len()).filter(|&i| blade[i].distance(tip) <= reach);
    if let Some(i) = near.max_by(|&i, &j| far(i).total_cmp(&far(j))) {
        return i;
    }
    let mut best = (f64::INFINITY, 0, tip);
    for (i, (a, b)) in polygon::edges(blade).enumerate() {
        let q = polygon::nearest_on_segment(a, b, tip);
        let off = q.distance_squared(tip);
        if off < best.0 {
            best = (off, i + 1, q);
        }
    }
    blade.insert(best.1, best.2);
    best.1
}

/// Without the vertices that stand too close for a [`Margin`]; base and apex stay.
fn without_crowding(outline: &[DVec2], apex: usize) -> (Vec<DVec2>, usize) {
    let tip = outline[apex];
    let least = 2.0 * Margin::MIN_EDGE_MM;
    let clear = |&&p: &&DVec2| p == tip || p.distance(tip) >= least;
    let kept: Vec<DVec2> = outline.iter().filter(clear).copied().collect();
    let kept = polygon::without_short_edges(&kept, least);
    let apex = kept.iter().position(|&p| p == tip).unwrap_or(0);
    (kept, apex)
}

/// The parts of the lines that lie inside the outline.
fn inside(outline: &[DVec2], lines: Vec<Vec<DVec2>>) -> Vec<Vec<DVec2>> {
    let mut kept = Vec::new();
    for line in lines {
        let runs = line.split(|&p| !polygon::contains(outline, p)).filter(|run| run.len() > 1);
        kept.extend(runs.map(<[DVec2]>::to_vec));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An ovate blade 100 high and 60 wide with its base at the origin and a petiole below.
    fn leaf(petiole: f64) -> Vec<DVec2> {
        let half = |t: f64| 72.0 * t.powf(0.6) * (1.0 - t);
        let right = (1..60).map(|i| f64::from(i) / 60.0).map(|t| DVec2::new(half(t), 100.0 * t));
        let right: Vec<DVec2> = right.filter(|p| petiole == 0.0 || p.x > 1.5).collect();
        let left: Vec<DVec2> = right.iter().rev().map(|p| DVec2::new(-p.x, p.y)).collect();
        let mut outline = right;
        outline.push(DVec2::new(0.0, 100.0));
        outline.extend(left);
        if petiole > 0.0 {
            outline.extend(
                [(-1.5, 0.0), (-1.5, -petiole), (1.5, -petiole), (1.5, 0.0)].map(DVec2::from),
            );
        } else {
            outline.push(DVec2::ZERO);
        }
        outline
    }

    fn turned(outline: &[DVec2], degrees: f64) -> Vec<DVec2> {
        let turn = DVec2::from_angle(degrees.to_radians());
        outline.iter().map(|p| turn.rotate(*p) * 7.0 + DVec2::new(300.0, -40.0)).collect()
    }

    fn accepted(placed: &Placed) -> Margin {
        Margin::new(placed.outline.clone(), placed.apex, placed.cuts.clone(), "").expect("placed")
    }

    #[test]
    fn a_petiole_tells_the_base_whichever_way_the_leaf_lies() {
        for degrees in [0.0, 33.0, 90.0, 180.0, 250.0] {
            let placed = place(&turned(&leaf(30.0), degrees), &[], None, 80.0).expect("a leaf");
            assert_eq!(placed.found, Found::Stalk);
            let base = turned(&[DVec2::ZERO], degrees)[0];
            assert!(placed.base_was.distance(base) < 0.03 * 700.0, "{degrees}: {placed:?}");
            assert_eq!(placed.outline[0], DVec2::ZERO);
            assert_eq!(placed.outline[placed.apex], DVec2::new(0.0, 80.0));
            let lowest = placed.outline.iter().map(|p| p.y).fold(0.0, f64::min);
            assert!(lowest > -2.0, "the petiole is gone: {lowest}");
            let _ = accepted(&placed);
        }
    }

    #[test]
    fn without_a_petiole_the_blunt_lower_end_is_the_base() {
        for degrees in [0.0, 40.0, -60.0] {
            let placed = place(&turned(&leaf(0.0), degrees), &[], None, 80.0).expect("a leaf");
            let base = turned(&[DVec2::ZERO], degrees)[0];
            assert!(placed.base_was.distance(base) < 0.03 * 700.0, "{degrees}: {placed:?}");
            let _ = accepted(&placed);
        }
    }

    #[test]
    fn a_given_root_wins_and_takes_the_stalk_along() {
        let outline = leaf(30.0);
        for root in [DVec2::new(0.0, -29.0), DVec2::new(0.5, 0.5)] {
            let placed = place(&outline, &[], Some(root), 80.0).expect("a leaf");
            assert_eq!(placed.found, Found::Given);
            assert!(placed.base_was.length() < 3.0, "{root}: {}", placed.base_was);
        }
        let top = place(&outline, &[], Some(DVec2::new(0.0, 101.0)), 80.0).expect("a leaf");
        assert!(top.base_was.distance(DVec2::new(0.0, 100.0)) < 1.5, "{top:?}");
        let error = place(&outline, &[], Some(DVec2::new(60.0, 50.0)), 80.0).expect_err("far off");
        assert!(
            error.to_string().starts_with("the root (60, 50) lies outside the leaf"),
            "{error}"
        );
    }

    #[test]
    fn the_winding_and_the_first_vertex_do_not_matter() {
        let outline = leaf(0.0);
        let first = place(&outline, &[], None, 80.0).expect("a leaf");
        let mut other: Vec<DVec2> = outline.into_iter().rev().collect();
        other.rotate_left(17);
        let second = place(&other, &[], None, 80.0).expect("a leaf");
        assert!(first.base_was.distance(second.base_was) < 0.5);
        assert!(first.apex_was.distance(second.apex_was) < 1e-9);
    }

    #[test]
    fn lines_and_points_are_refused() {
        let line: Vec<DVec2> = (0..9).map(|i| DVec2::new(f64::from(i), 2.0)).collect();
        assert!(matches!(place(&line, &[], None, 80.0), Err(MarginError::NoArea { .. })));
        assert!(matches!(
            place(&[DVec2::ONE; 4], &[], None, 80.0),
            Err(MarginError::NoArea { .. })
        ));
        assert!(place(&[], &[], None, 80.0).is_err());
    }
}
