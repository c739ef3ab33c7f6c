//! A closed polygon as a B-spline of few control points, its corners kept.
//!
//! Source: L. Mündermann, P. MacMurchy, J. Pivovarov & P. Prusinkiewicz, "Modeling lobed leaves", 2003,
//! section 3.1: a silhouette is traced pixel by pixel and then reduced to a compact B-spline by inverse
//! subdivision. Departs from it: instead of halving the points of a curve by the rule of a subdivision,
//! pieces are laid as long as the tolerance allows, so the number of control points follows the shape;
//! and corners are knots where the curve may turn at once.
//!
//! Between two corners the curve is one quadratic B-spline. Its knots lie on the outline, with the
//! outline's direction there; from knot to knot run two parabolas that meet half-way between their
//! control points, whose distances from the knots are those of least squares.

use super::DVec2;
use super::bspline::QuadraticBSpline;
use super::deviation::squared_to_line;

/// A closed curve near a polygon.
///
/// # Guarantees
///
/// - The pieces are joined end to end, the last to the first; where two meet is a corner.
/// - No vertex of the polygon is farther from the curve than [`deviation`](Self::deviation).
#[derive(Debug, Clone, PartialEq)]
pub struct CompactCurve {
    pieces: Vec<QuadraticBSpline>,
    deviation: f64,
}

impl CompactCurve {
    /// From corner to corner.
    #[must_use]
    pub fn pieces(&self) -> &[QuadraticBSpline] {
        &self.pieces
    }

    /// Control points, each corner counted once.
    #[must_use]
    pub fn control_points(&self) -> usize {
        self.pieces.iter().map(|piece| piece.control().len() - 1).sum()
    }

    /// The corners.
    pub fn corners(&self) -> impl Iterator<Item = DVec2> + '_ {
        self.pieces.iter().map(|piece| piece.control()[0])
    }

    /// The greatest distance between polygon and curve, from the vertices of the one and points along the
    /// other.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// The curve as quadratic Bézier curves, end to end.
    pub fn beziers(&self) -> impl Iterator<Item = [DVec2; 3]> + '_ {
        self.pieces.iter().flat_map(|piece| piece.spans().map(|(_, _, bezier)| bezier))
    }

    /// A polygon that stays within `tolerance` of the curve.
    #[must_use]
    pub fn flattened(&self, tolerance: f64) -> Vec<DVec2> {
        let mut points = Vec::new();
        for piece in &self.pieces {
            points.extend(piece.flattened(tolerance));
            points.pop();
        }
        points
    }
}

/// A place where the outline turns by more than this within [`ARM`] tolerances to either side is a corner
/// (degrees).
const CORNER_DEG: f64 = 50.0;

/// How far to either side a corner is looked at, in tolerances: well beyond the unevenness of a boundary.
const ARM: f64 = 6.0;

/// The curve of fewest pieces found that stays within `tolerance` of a simple polygon, the vertices at
/// `corners` kept as corners beside those that are found.
///
/// # Panics
///
/// With fewer than three vertices: that is no polygon.
#[must_use]
pub fn compact(polygon: &[DVec2], corners: &[usize], tolerance: f64) -> CompactCurve {
    assert!(polygon.len() >= 3, "a polygon has three vertices");
    let ring = Ring::new(polygon);
    let mut corners = [corners, &ring.corners(tolerance)].concat();
    if corners.is_empty() {
        corners.push(0);
    }
    corners.sort_unstable();
    corners.dedup();
    let mut pieces = Vec::with_capacity(corners.len());
    let mut deviation = 0.0_f64;
    for (k, &from) in corners.iter().enumerate() {
        let to = corners.get(k + 1).copied().unwrap_or(corners[0] + polygon.len());
        let line: Vec<DVec2> = (from..=to).map(|i| polygon[i % polygon.len()]).collect();
        let (piece, off) = fitted(&line, tolerance);
        deviation = deviation.max(off);
        pieces.push(piece);
    }
    CompactCurve { pieces, deviation }
}

/// A polygon by the way along it.
struct Ring<'a> {
    polygon: &'a [DVec2],
    ways: Vec<f64>,
}

impl<'a> Ring<'a> {
    fn new(polygon: &'a [DVec2]) -> Self {
        let mut way = 0.0;
        let mut ways = vec![0.0];
        ways.extend(super::polygon::edges(polygon).map(|(a, b)| {
            way += a.distance(b);
            way
        }));
        Self { polygon, ways }
    }

    fn at(&self, way: f64) -> DVec2 {
        let n = self.polygon.len();
        let way = way.rem_euclid(self.ways[n]);
        let i = self.ways.partition_point(|&w| w <= way).clamp(1, n) - 1;
        let long = (self.ways[i + 1] - self.ways[i]).max(f64::MIN_POSITIVE);
        self.polygon[i].lerp(self.polygon[(i + 1) % n], (way - self.ways[i]) / long)
    }

    /// The vertices where the outline turns most sharply, of those within an arm of each other the
    /// sharpest.
    fn corners(&self, tolerance: f64) -> Vec<usize> {
        let n = self.polygon.len();
        let arm = (ARM * tolerance).min(self.ways[n] / 8.0);
        let turn = |i: usize| {
            let (here, way) = (self.polygon[i], self.ways[i]);
            (here - self.at(way - arm)).angle_to(self.at(way + arm) - here).abs()
        };
        let turns: Vec<f64> = (0..n).map(turn).collect();
        let is_sharpest = |i: &usize| {
            let i = *i;
            let near = |mut j: usize, step: usize| {
                let mut reached = 0.0;
                loop {
                    let next = (j + step) % n;
                    reached += self.polygon[j].distance(self.polygon[next]);
                    if reached > arm || next == i {
                        return true;
                    }
                    if turns[next] > turns[i] || (turns[next] == turns[i] && next < i) {
                        return false;
                    }
                    j = next;
                }
            };
            turns[i] > CORNER_DEG.to_radians() && near(i, 1) && near(i, n - 1)
        };
        (0..n).filter(is_sharpest).collect()
    }
}

/// The spline along a line from corner to corner, and its deviation.
fn fitted(line: &[DVec2], tolerance: f64) -> (QuadraticBSpline, f64) {
    let last = line.len() - 1;
    let total: f64 = line.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
    let window = (2.0 * tolerance).min(total / 4.0);
    let mut control = vec![line[0]];
    let mut knots = vec![0.0; 3];
    let (mut from, mut deviation, mut u, mut step) = (0, 0.0_f64, 0.0, 1.0);
    let mut arrived = None;
    while from < last {
        let leaving = direction(line, from, window);
        // As far as the tolerance allows: doubled until it fails, then halved between.
        let try_to = |to: usize| span(&line[from..=to], leaving, direction(line, to, window));
        let (mut good, mut reach) = ((from + 1, try_to(from + 1)), 2);
        let mut bad = last + 1;
        while from + reach < bad {
            let to = from + reach;
            let tried = try_to(to);
            if tried.off <= tolerance {
                (good, reach) = ((to, tried), reach * 2);
            } else {
                bad = to;
            }
        }
        let whole = try_to(last);
        if bad > last && whole.off <= tolerance {
            good = (last, whole);
        }
        while bad.min(last + 1) - good.0 > 1 {
            let middle = usize::midpoint(good.0, bad.min(last + 1));
            let tried = try_to(middle);
            if tried.off <= tolerance {
                good = (middle, tried);
            } else {
                bad = middle;
            }
        }
        let (to, span) = good;
        // Intervals beside a knot are as the distances of the control points there.
        if let Some(arrived) = arrived {
            step *= span.reach[0] / arrived;
            knots.push(u);
        }
        knots.push(u + step);
        u += 2.0 * step;
        arrived = Some(span.reach[1]);
        control.extend([
            line[from] + leaving * span.reach[0],
            line[to] - span.arriving * span.reach[1],
        ]);
        deviation = deviation.max(span.off);
        from = to;
    }
    control.push(line[last]);
    knots.extend([u; 3]);
    (QuadraticBSpline::new(knots, control), deviation)
}

/// The direction of a line at a vertex, over a window to both sides where it has them.
fn direction(line: &[DVec2], at: usize, window: f64) -> DVec2 {
    let walk = |step: isize| {
        let (mut i, mut way) = (at, 0.0);
        while let Some(next) = i.checked_add_signed(step).filter(|&next| next < line.len()) {
            way += line[i].distance(line[next]);
            i = next;
            if way >= window {
                break;
            }
        }
        line[i]
    };
    let (before, after) = (walk(-1), walk(1));
    (after - before).normalize_or((after - line[at]).normalize_or(DVec2::X))
}

/// The two parabolas from one knot to the next.
struct Span {
    /// The distances of the control points from their knots.
    reach: [f64; 2],
    arriving: DVec2,
    /// The greatest distance between line and curve.
    off: f64,
}

/// The span of least squares along a line, leaving and arriving in the given directions.
fn span(line: &[DVec2], leaving: DVec2, arriving: DVec2) -> Span {
    let last = line.len() - 1;
    let (a, d) = (line[0], line[last]);
    let chord = a.distance(d).max(f64::MIN_POSITIVE);
    let mut shares = vec![0.0];
    for pair in line.windows(2) {
        shares.push(shares[shares.len() - 1] + pair[0].distance(pair[1]));
    }
    let total = shares[last].max(f64::MIN_POSITIVE);
    // A point of the curve is A(s)·a + B(s)·q + C(s)·r + D(s)·d with its inner control points q and r.
    let weights = |s: f64| -> [f64; 4] {
        let t = if s < 0.5 { 2.0 * s } else { 2.0 - 2.0 * s };
        let near = [(1.0 - t).powi(2), 2.0 * t * (1.0 - t) + 0.5 * t * t, 0.5 * t * t, 0.0];
        if s < 0.5 { near } else { [near[3], near[2], near[1], near[0]] }
    };
    let (mut xx, mut xy, mut yy, mut bx, mut by) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for (p, way) in line.iter().zip(&shares) {
        let [wa, wq, wr, wd] = weights(way / total);
        let (x, y) = (leaving * wq, -arriving * wr);
        let rest = *p - a * (wa + wq) - d * (wr + wd);
        (xx, xy, yy) = (xx + x.dot(x), xy + x.dot(y), yy + y.dot(y));
        (bx, by) = (bx + x.dot(rest), by + y.dot(rest));
    }
    let determinant = xx * yy - xy * xy;
    let solved = [(bx * yy - by * xy) / determinant, (by * xx - bx * xy) / determinant];
    // Control points on the wrong side of their knots, or far off, make loops.
    let usable = solved.iter().all(|reach| *reach > 0.02 * chord && *reach < 2.0 * chord);
    let reach = if usable { solved } else { [chord / 4.0; 2] };
    let (q, r) = (a + leaving * reach[0], d - arriving * reach[1]);
    let steps = last.clamp(8, 64);
    let curve: Vec<DVec2> = (0..=steps)
        .map(|i| {
            let [wa, wq, wr, wd] = weights(i as f64 / steps as f64);
            a * wa + q * wq + r * wr + d * wd
        })
        .collect();
    let there = line.iter().map(|&p| squared_to_line(p, &curve));
    let off =
        there.chain(curve.iter().map(|&p| squared_to_line(p, line))).fold(0.0, f64::max).sqrt();
    Span { reach, arriving, off }
}

#[cfg(test)]
mod tests {
    use super::super::deviation::to_polygon;
    use super::super::polygon;
    use super::*;

    /// A rosette of arcs with cusps between them, which are corners.
    fn rosette(petals: usize, steps: usize) -> Vec<DVec2> {
        (0..petals)
            .flat_map(|k| {
                (0..steps).map(move |i| {
                    let share = i as f64 / steps as f64;
                    let turn = std::f64::consts::TAU * (k as f64 + share) / petals as f64;
                    let radius = 40.0 + 15.0 * libm::sin(std::f64::consts::PI * share);
                    DVec2::new(libm::cos(turn), libm::sin(turn)) * radius
                })
            })
            .collect()
    }

    #[test]
    fn a_curve_keeps_corners_stays_within_the_tolerance_and_has_few_points() {
        let outline = rosette(5, 120);
        for tolerance in [0.05, 0.2, 0.8] {
            let curve = compact(&outline, &[], tolerance);
            let drawn = curve.flattened(1e-3);
            let there = to_polygon(&outline, &drawn).into_iter().fold(0.0, f64::max);
            let back = to_polygon(&drawn, &outline).into_iter().fold(0.0, f64::max);
            assert!(
                there <= curve.deviation() + 2e-3 && back <= tolerance + 0.01,
                "{there} {back}"
            );
            assert!(curve.deviation() <= tolerance, "{}", curve.deviation());
            assert!(curve.control_points() * 8 < outline.len(), "{}", curve.control_points());
            let corners: Vec<DVec2> = curve.corners().collect();
            let cusps: Vec<DVec2> = (0..5).map(|k| outline[k * 120]).collect();
            assert_eq!(corners, cusps, "tolerance {tolerance}");
        }
    }

    #[test]
    fn a_finer_tolerance_takes_more_points_and_a_round_outline_has_no_corner_but_its_start() {
        let circle: Vec<DVec2> = (0..500)
            .map(|i| {
                let turn = std::f64::consts::TAU * f64::from(i) / 500.0;
                DVec2::new(libm::cos(turn), libm::sin(turn)) * 30.0
            })
            .collect();
        let counts: Vec<usize> =
            [1.0, 0.1, 0.01].iter().map(|t| compact(&circle, &[], *t).control_points()).collect();
        assert!(counts.is_sorted() && counts[0] < counts[2], "{counts:?}");
        let curve = compact(&circle, &[], 0.1);
        assert_eq!(curve.pieces().len(), 1);
        assert!(counts[1] <= 24, "{counts:?}");
        // Inside a piece the curve never turns at once: it is a B-spline.
        let beziers: Vec<[DVec2; 3]> = curve.beziers().collect();
        for pair in beziers.windows(2) {
            let (out, on) = (pair[0][2] - pair[0][1], pair[1][1] - pair[1][0]);
            assert!(out.normalize().dot(on.normalize()) > 1.0 - 1e-9);
            assert!(pair[0][2].distance(pair[1][0]) < 1e-9);
        }
        let area = polygon::signed_area(&curve.flattened(1e-3));
        assert!((area / polygon::signed_area(&circle) - 1.0).abs() < 0.005);
    }
}
