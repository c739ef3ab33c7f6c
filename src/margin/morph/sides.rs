//! Both sides of a blade on the way, measured so that places answer each other: what lies on the blade can
//! keep its place while the margin changes.

use glam::DVec2;

use super::flank::Flank;
use super::{MorphPath, Way, bump};
use crate::geometry::measured::stretch;
use crate::geometry::{nurbs, polygon};
use crate::margin::{MarginError, MarginSpec, entire};

/// A side of a blade as a line from base to apex (mm), without teeth where both ends have the same kind
/// of margin. Its measure rises from 0 to 1; on the same side of another place of the path, a place of
/// the same measure answers it.
#[derive(Debug, Clone)]
pub struct MarginSide {
    measures: Vec<f64>,
    points: Vec<DVec2>,
}

impl MarginSide {
    /// A side from places with their measures, which rise.
    fn new(places: impl Iterator<Item = (f64, DVec2)>) -> Self {
        let (measures, points) = places.unzip();
        Self { measures, points }
    }

    /// The same as if the blade were so many times as large.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.points.iter_mut().for_each(|p| *p *= factor);
        self
    }

    /// The place with this measure.
    #[must_use]
    pub fn at(&self, measure: f64) -> DVec2 {
        let (i, t) = stretch(&self.measures, measure);
        self.points[i].lerp(self.points[i + 1], t)
    }

    /// The direction towards the apex there.
    #[must_use]
    pub fn ahead(&self, measure: f64) -> DVec2 {
        let (i, _) = stretch(&self.measures, measure);
        (self.points[i + 1] - self.points[i]).normalize_or(DVec2::Y)
    }

    /// The measure of the place nearest to `p`, and how far that is. One pass.
    #[must_use]
    pub fn nearest(&self, p: DVec2) -> (f64, f64) {
        let mut best = (0.0, f64::INFINITY);
        for (i, pair) in self.points.windows(2).enumerate() {
            let q = polygon::nearest_on_segment(pair[0], pair[1], p);
            let far = q.distance(p);
            if far < best.1 {
                let t = q.distance(pair[0]) / pair[0].distance(pair[1]).max(1e-300);
                let (low, high) = (self.measures[i], self.measures[i + 1]);
                best = (low + t.min(1.0) * (high - low), far);
            }
        }
        best
    }
}

impl MorphPath {
    /// Both sides of the blade at `u`, right and left.
    ///
    /// # Errors
    ///
    /// As [`at`](Self::at).
    pub fn sides(&self, u: f64) -> Result<[MarginSide; 2], MarginError> {
        let u = u.clamp(0.0, 1.0);
        let shares = nurbs::shares(&self.weights, u);
        let spec = self.mixed(&shares);
        let length = spec.length_mm;
        let Way::Space { space, ease } = &self.way else {
            let ends = [&self.specs[0], &self.specs[self.specs.len() - 1]];
            return numbered(&spec, ends, length);
        };
        let detail = 1.0 - ease * bump(u);
        Ok([false, true].map(|left| {
            let hand = DVec2::new(if left { -length } else { length }, length);
            let places = space.side(left, &shares, detail);
            MarginSide::new(places.into_iter().map(|(measure, p)| (measure, p * hand)))
        }))
    }
}

/// The sides of a parametric leaf: by the way along them, between lobe tips and valleys where the ends have
/// the same.
fn numbered(
    spec: &MarginSpec,
    ends: [&MarginSpec; 2],
    length: f64,
) -> Result<[MarginSide; 2], MarginError> {
    let flanks = |spec: &MarginSpec| Ok::<_, MarginError>(Flank::both(&entire(spec)?.to_outline()));
    let own = flanks(spec)?;
    let ends = [flanks(ends[0])?, flanks(ends[1])?];
    Ok([0, 1].map(|k| {
        let flank = &own[k];
        let same = ends.iter().all(|end| end[k].turns.len() == flank.turns.len());
        let inner = flank.turns.iter().map(|turn| turn.way).filter(|_| same);
        let mut knots = vec![0.0];
        knots.extend(inner);
        knots.push(flank.length());
        let count = (knots.len() - 1) as f64;
        let measure = |way: f64| {
            let (j, part) = stretch(&knots, way);
            (j as f64 + part) / count
        };
        let hand = DVec2::new(if k == 1 { -length } else { length }, length);
        let places = flank.ways().iter().zip(flank.points());
        MarginSide::new(places.map(|(&way, &p)| (measure(way), p * hand)))
    }))
}
