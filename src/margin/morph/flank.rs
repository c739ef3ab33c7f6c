//! One side of a margin as the space sees it: a line from base to apex with the lobes that stand on it.

use glam::DVec2;

use super::super::fit::{incisions, records};
use super::super::{LandmarkKind, Outline};
use crate::geometry::measured::stretch;
use crate::geometry::polygon;

/// The tip of a lobe or the valley between two.
#[derive(Debug, Clone, Copy)]
pub(super) struct Turn {
    /// The way to it from the base.
    pub(super) way: f64,
    /// Where the lobe's vein begins; `None` for a valley.
    pub(super) origin: Option<DVec2>,
}

impl Turn {
    pub(super) fn is_tip(&self) -> bool {
        self.origin.is_some()
    }
}

/// One side of a blade of length 1 as if it were the right one, by the way along it from the base.
#[derive(Debug, Clone)]
pub(super) struct Flank {
    points: Vec<DVec2>,
    ways: Vec<f64>,
    /// From base to apex, the apex itself left out.
    pub(super) turns: Vec<Turn>,
}

impl Flank {
    /// Both sides of an outline, right and left. An outline that knows of no lobes is searched for them.
    pub(super) fn both(outline: &Outline) -> [Self; 2] {
        let length = outline.points[outline.apex].y;
        let known = Self::knows_lobes(outline);
        let size = polygon::signed_area(&outline.points).abs().sqrt() / length;
        let n = outline.points.len();
        [false, true].map(|left| {
            let vertex = |i: usize| if left { (n - i) % n } else { i };
            let last = if left { n - outline.apex } else { outline.apex };
            let as_right = |p: DVec2| {
                let p = p / length;
                if left { DVec2::new(-p.x, p.y) } else { p }
            };
            let points = (0..=last).map(|i| as_right(outline.points[vertex(i)])).collect();
            let mut flank = Self::of(points);
            if known {
                let at = |i: usize| outline.landmarks.iter().find(|mark| mark.vertex == vertex(i));
                flank.turns = (1..last)
                    .filter_map(|i| {
                        let origin = match at(i)?.kind {
                            LandmarkKind::LobeTip { origin } => Some(as_right(origin)),
                            LandmarkKind::Valley => None,
                            _ => return None,
                        };
                        Some(Turn { way: flank.ways[i], origin })
                    })
                    .collect();
            } else {
                flank.turns = flank.found(DEEP * size);
            }
            flank
        })
    }

    /// Whether an outline tells where its lobes are.
    pub(super) fn knows_lobes(outline: &Outline) -> bool {
        outline
            .landmarks
            .iter()
            .any(|mark| matches!(mark.kind, LandmarkKind::LobeTip { .. } | LandmarkKind::Valley))
    }

    fn of(points: Vec<DVec2>) -> Self {
        let mut way = 0.0;
        let mut ways = vec![0.0];
        ways.extend(points.windows(2).map(|pair| {
            way += pair[0].distance(pair[1]);
            way
        }));
        Self { points, ways, turns: Vec::new() }
    }

    pub(super) fn length(&self) -> f64 {
        self.ways[self.ways.len() - 1]
    }

    pub(super) fn points(&self) -> &[DVec2] {
        &self.points
    }

    pub(super) fn ways(&self) -> &[f64] {
        &self.ways
    }

    pub(super) fn at(&self, way: f64) -> DVec2 {
        let (i, t) = stretch(&self.ways, way);
        self.points[i].lerp(self.points[i + 1], t)
    }

    /// The way to where a ray meets this side last; `None` when it does not.
    pub(super) fn way_to(&self, from: DVec2, towards: DVec2) -> Option<f64> {
        let mut best: Option<(f64, f64)> = None;
        for (i, pair) in self.points.windows(2).enumerate() {
            let edge = pair[1] - pair[0];
            let across = towards.perp_dot(edge);
            if across == 0.0 {
                continue;
            }
            let far = (pair[0] - from).perp_dot(edge) / across;
            let t = (pair[0] - from).perp_dot(towards) / across;
            if far > 1e-6 && (0.0..=1.0).contains(&t) && best.is_none_or(|(most, _)| far > most) {
                best = Some((far, self.ways[i] + t * (self.ways[i + 1] - self.ways[i])));
            }
        }
        best.map(|(_, way)| way)
    }

    /// Lobes as [`fit`](super::super::fit) finds them: parted by incisions, their tips farthest from the
    /// feet on both sides.
    fn found(&self, least: f64) -> Vec<Turn> {
        let step = self.length() / FINDING as f64;
        let line: Vec<DVec2> = (0..=FINDING).map(|i| self.at(step * i as f64)).collect();
        let mut feet: Vec<usize> =
            incisions::incisions(&line, least).iter().map(|incision| incision.at).collect();
        if feet.is_empty() {
            return Vec::new();
        }
        feet.push(0);
        feet.sort_unstable();
        // Beyond the last valley the margin ends in a lobe at the apex, or comes down to a notch there.
        let last = feet[feet.len() - 1];
        if line[last..].iter().any(|p| p.y > NOTCHED) {
            feet.push(FINDING);
        }
        let mut turns = Vec::new();
        for (k, pair) in feet.windows(2).enumerate() {
            let (from, to) = (pair[0], pair[1]);
            let middle = (line[from] + line[to]) * 0.5;
            let far = |i: &usize| line[*i].distance_squared(middle);
            let Some(tip) = (from + 1..to).max_by(|i, j| far(i).total_cmp(&far(j))) else {
                continue;
            };
            if k > 0 {
                turns.push(Turn { way: step * from as f64, origin: None });
            }
            let origin = records::origin(line[from], line[tip], line[to]);
            turns.push(Turn { way: step * tip as f64, origin: Some(origin) });
        }
        if last == feet[feet.len() - 1] {
            turns.push(Turn { way: step * last as f64, origin: None });
        }
        turns
    }
}

/// Lobes are looked for among so many points of a side.
const FINDING: usize = 400;

/// Incisions deeper than this part lobes, as a share of the root of the blade's area: deeper than teeth,
/// shallower than the sinuses of an oak.
const DEEP: f64 = 0.07;

/// A side that rises above this on its way to the apex comes down to a notch there.
const NOTCHED: f64 = 1.02;
