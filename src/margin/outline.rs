//! An outline on its way to a [`Margin`](super::Margin): what the makers of outlines hand over.

use glam::DVec2;

use super::Margin;
use super::landmarks::{Landmark, LandmarkKind};
use crate::geometry::polygon;

/// An outline of which nothing is guaranteed yet.
///
/// The first vertex is the base, at the origin (of a peltate leaf, whose base lies inside: a vertex
/// on the −y axis); the vertex `apex` stands on the +y axis. Either winding.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Outline {
    /// The vertices (mm), the first not repeated at the end.
    pub points: Vec<DVec2>,
    /// Index of the apex.
    pub apex: usize,
    /// Slits inside (mm).
    pub cuts: Vec<Vec<DVec2>>,
    /// What stands at which vertex, in any order.
    pub landmarks: Vec<Landmark>,
}

impl Outline {
    /// The same stretched by `scale` about the base.
    #[must_use]
    pub fn scaled(mut self, scale: DVec2) -> Self {
        let cuts = self.cuts.iter_mut().flatten();
        self.points.iter_mut().chain(cuts).for_each(|p| *p *= scale);
        for landmark in &mut self.landmarks {
            landmark.kind = landmark.kind.mapped(|p| p * scale);
        }
        self
    }

    /// The same with every point moved, the edges first cut to be no longer than `longest`, because
    /// they may bend.
    #[must_use]
    pub fn mapped(mut self, longest: f64, place: impl Fn(DVec2) -> DVec2) -> Self {
        let mut points = Vec::new();
        let mut at = Vec::new();
        for (a, b) in polygon::edges(&self.points) {
            at.push(points.len());
            points.extend(polygon::pieces(a, b, longest).map(&place));
        }
        self.points = points;
        self.apex = at[self.apex];
        for landmark in &mut self.landmarks {
            landmark.vertex = at[landmark.vertex];
            landmark.kind = landmark.kind.mapped(&place);
        }
        for line in &mut self.cuts {
            let cut = line.windows(2).flat_map(|w| polygon::pieces(w[0], w[1], longest));
            *line = cut.chain(line.last().copied()).map(&place).collect();
        }
        self
    }

    /// The same with the base moved up into the blade by a share of its length, and brought back to the
    /// length from there to the apex: a peltate leaf. Nothing changes at 0. For outlines of length 1.
    #[must_use]
    pub fn peltate(self, share: f64) -> Self {
        if share == 0.0 {
            return self;
        }
        let raised = |p: DVec2| (p - DVec2::new(0.0, share)) / (1.0 - share);
        let cuts = self.cuts.into_iter().map(|line| line.into_iter().map(raised).collect());
        let landmarks = self.landmarks.into_iter().map(|mark| match mark.kind {
            // Veins come from the petiole now, or from where they left the midrib above it.
            LandmarkKind::LobeTip { origin } => {
                let origin = raised(origin).max(DVec2::ZERO);
                Landmark { kind: LandmarkKind::LobeTip { origin }, ..mark }
            }
            _ => mark,
        });
        Self {
            points: self.points.into_iter().map(raised).collect(),
            apex: self.apex,
            cuts: cuts.collect(),
            landmarks: landmarks.collect(),
        }
    }

    /// Anticlockwise, whatever it was; `area` is its signed area.
    pub(super) fn wound(&mut self, area: f64) {
        if area >= 0.0 {
            return;
        }
        let n = self.points.len();
        let mirrored = |vertex: usize| if vertex == 0 { 0 } else { n - vertex };
        self.points[1..].reverse();
        self.apex = mirrored(self.apex);
        for landmark in &mut self.landmarks {
            landmark.vertex = mirrored(landmark.vertex);
        }
    }

    /// Without vertices within [`Margin::MIN_EDGE_MM`] of the one before. The base goes before the
    /// apex, the apex before landmarks, and these before plain vertices; a landmark whose vertex
    /// goes, goes too, unless it can sit on the vertex that stays.
    pub(super) fn spaced(mut self) -> Self {
        self.landmarks.retain(|mark| mark.vertex < self.points.len());
        self.landmarks.sort_by_key(|mark| mark.vertex);
        let close = |a: DVec2, b: DVec2| a.distance_squared(b) < Margin::MIN_EDGE_MM.powi(2);
        let n = self.points.len();
        let crowded = (0..n).any(|i| close(self.points[i], self.points[(i + 1) % n]));
        if !crowded {
            return self.with_single_landmarks();
        }
        let mut worth = vec![0_u8; n];
        self.landmarks.iter().for_each(|mark| worth[mark.vertex] = 1);
        worth[self.apex] = 2;
        worth[0] = 3;
        // What became of each vertex: its place among those kept, or that of the one it stood by.
        let mut place = vec![0; n];
        let mut kept: Vec<usize> = Vec::with_capacity(n);
        let mut gone = Vec::new();
        for i in 0..n {
            while let Some(&last) = kept.last() {
                if !close(self.points[last], self.points[i]) || worth[last] >= worth[i] {
                    break;
                }
                kept.pop();
                gone.push(last);
            }
            let free = kept.last().is_none_or(|&last| !close(self.points[last], self.points[i]));
            if free {
                kept.push(i);
            }
            gone.push(i);
            gone.drain(..).for_each(|i| place[i] = kept.len() - 1);
        }
        while kept.len() > 1 && close(self.points[0], self.points[kept[kept.len() - 1]]) {
            kept.pop();
        }
        let last = kept.len() - 1;
        self.points = kept.iter().map(|&i| self.points[i]).collect();
        // Places past the end belong to vertices that stood by the base.
        let now = |i: usize| if place[i] > last { 0 } else { place[i] };
        self.apex = now(self.apex);
        for mark in &mut self.landmarks {
            mark.vertex = now(mark.vertex);
        }
        self.landmarks.sort_by_key(|mark| mark.vertex);
        self.with_single_landmarks()
    }

    /// One landmark a vertex: the weightiest.
    fn with_single_landmarks(mut self) -> Self {
        self.landmarks.dedup_by(|later, first| {
            let same = later.vertex == first.vertex;
            if same && later.kind.outranks(first.kind) {
                *first = *later;
            }
            same
        });
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn marked(vertex: usize, order: u8) -> Landmark {
        Landmark { vertex, kind: LandmarkKind::Tooth { order } }
    }

    fn outline(points: &[(f64, f64)], apex: usize, landmarks: Vec<Landmark>) -> Outline {
        let points = points.iter().map(|&p| DVec2::from(p)).collect();
        Outline { points, apex, landmarks, cuts: Vec::new() }
    }

    #[test]
    fn a_landmark_keeps_its_place_when_its_neighbours_go() {
        let points = [
            (0.0, 0.0),
            (5.0, 1.0),
            (5.0002, 1.0),
            (5.0004, 1.0),
            (0.0, 9.0),
            (0.0001, 9.0),
            (-5.0, 1.0),
            (-1e-5, 0.0),
        ];
        let spaced = outline(&points, 5, vec![marked(7, 1), marked(2, 2), marked(3, 1)]).spaced();
        let expected = [(0.0, 0.0), (5.0002, 1.0), (0.0001, 9.0), (-5.0, 1.0)].map(DVec2::from);
        assert_eq!(spaced.points, expected);
        assert_eq!(spaced.apex, 2);
        assert_eq!(spaced.landmarks, [marked(0, 1), marked(1, 1)], "the large tooth stays");
    }

    #[test]
    fn turning_the_winding_takes_the_landmarks_along() {
        let points = [(0.0, 0.0), (-5.0, 1.0), (0.0, 9.0), (5.0, 1.0), (3.0, 0.5)];
        let mut turned = outline(&points, 2, vec![marked(1, 1), marked(4, 2)]);
        let before: Vec<DVec2> = turned.landmarks.iter().map(|m| turned.points[m.vertex]).collect();
        turned.wound(-1.0);
        let after: Vec<DVec2> = turned.landmarks.iter().map(|m| turned.points[m.vertex]).collect();
        assert_eq!(before, after);
        assert_eq!(turned.points[turned.apex], DVec2::new(0.0, 9.0));
    }
}
