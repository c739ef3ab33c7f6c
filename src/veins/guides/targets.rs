//! Where on the margin veins end: teeth and lobe tips.
//!
//! A tooth is a place that stands out of the margin as it would be without teeth (the outline
//! evened), by more than its neighbourhood does; fine and coarse teeth are looked for apart. A lobe
//! tip is farther from the petiole than the margin on both its sides, by a good share of the length.
//! Found on any polygon, drawn or scanned; a margin that knows its own teeth is asked for them.

use glam::DVec2;

use crate::geometry::polygon;
use crate::margin::{Landmark, LandmarkKind, Margin};

/// Fine teeth: the outline is evened over this share of the length of the blade.
const FINE: f64 = 0.012;

/// A tooth stands out by this share of the length over which the outline was evened. Rounded parts
/// of the margin itself stay below.
const STANDS_OUT: f64 = 0.16;

/// A lobe is longer than this, in lengths of the blade.
const LOBE: f64 = 0.12;

/// Nothing this near to base or apex (along the margin, in lengths of the blade) is a tooth.
const ENDS: f64 = 0.05;

/// A tip on the margin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tip {
    pub(super) at: DVec2,
    /// Where it is on the outline: 0 at the base, 1 at the apex, on its side.
    pub(super) along: f64,
    /// How far it stands out (mm).
    pub(super) height: f64,
    /// 1 right, −1 left.
    pub(super) side: f64,
    /// Where its vein begins, of the tip of a lobe whose maker knows.
    pub(super) origin: Option<DVec2>,
}

/// A closed line of even steps, smoothed over `sigma` steps on either side.
pub(super) fn evened(line: &[DVec2], sigma: f64) -> Vec<DVec2> {
    // Three means of three have the spread of a bell curve; a round of ¼ ½ ¼ adds ½ to its square.
    let rounds = (2.0 * sigma * sigma).ceil() as usize;
    let n = line.len();
    let mut line = line.to_vec();
    let mut next = line.clone();
    for _ in 0..rounds {
        for i in 0..n {
            next[i] = (line[(i + n - 1) % n] + line[i] * 2.0 + line[(i + 1) % n]) * 0.25;
        }
        std::mem::swap(&mut line, &mut next);
    }
    line
}

/// The teeth of a margin on both sides, from base to apex on each; `spacing` is what lies between
/// two secondaries at the margin (mm).
pub(super) fn teeth(margin: &Margin, spacing: f64) -> Vec<Tip> {
    let known = known_teeth(margin);
    // Whoever put lobes there would know of teeth on them.
    if !known.is_empty() || !known_lobes(margin).is_empty() {
        return known;
    }
    let fine = FINE * margin.length_mm();
    let mut tips = tips_at(margin, fine);
    let coarse = (0.5 * spacing).min(0.08 * margin.length_mm());
    if coarse > 1.5 * fine {
        for tip in tips_at(margin, coarse) {
            let same = tips.iter_mut().find(|other| other.at.distance(tip.at) < 1.2 * coarse);
            match same {
                // A coarse tooth may carry fine ones: its own tip is the one that stands out most.
                Some(other) => other.height = other.height.max(tip.height),
                None => tips.push(tip),
            }
        }
    }
    tips.sort_by(|a, b| (b.side, a.along).partial_cmp(&(a.side, b.along)).expect("finite"));
    tips
}

/// The teeth of the first order that the margin itself knows of, in the order of [`teeth`].
fn known_teeth(margin: &Margin) -> Vec<Tip> {
    let marks = margin.landmarks();
    let at = |i: usize| margin.outline()[marks[i].vertex];
    let is_sinus = |mark: &Landmark| matches!(mark.kind, LandmarkKind::Sinus { order: 1 });
    let ways = Ways::new(margin);
    let teeth = (0..marks.len()).filter(|&i| marks[i].kind == LandmarkKind::Tooth { order: 1 });
    let mut tips: Vec<Tip> = teeth
        .map(|i| {
            let below = marks[..i].iter().rposition(is_sinus).map(at);
            let above = marks[i..].iter().position(is_sinus).map(|k| at(i + k));
            // A polygon may know its teeth without the sinuses: then all are alike.
            let height = below.zip(above).map_or(1.0, |(below, above)| {
                polygon::nearest_on_segment(below, above, at(i)).distance(at(i))
            });
            ways.tip(marks[i].vertex, height)
        })
        .collect();
    tips.sort_by(|a, b| (b.side, a.along).partial_cmp(&(a.side, b.along)).expect("finite"));
    tips
}

/// How far along the outline its vertices are.
struct Ways<'a> {
    margin: &'a Margin,
    /// From the base on, and all the way round at last (mm).
    ways: Vec<f64>,
}

impl<'a> Ways<'a> {
    fn new(margin: &'a Margin) -> Self {
        let mut ways = vec![0.0];
        ways.extend(polygon::edges(margin.outline()).scan(0.0, |way, (a, b)| {
            *way += a.distance(b);
            Some(*way)
        }));
        Self { margin, ways }
    }

    fn tip(&self, vertex: usize, height: f64) -> Tip {
        let outline = self.margin.outline();
        let (way, apex) = (self.ways[vertex], self.ways[self.margin.apex_index()]);
        let round = self.ways[outline.len()];
        let (side, along) = if vertex <= self.margin.apex_index() {
            (1.0, way / apex)
        } else {
            (-1.0, (round - way) / (round - apex))
        };
        Tip { at: outline[vertex], along, height, side, origin: None }
    }
}

fn tips_at(margin: &Margin, sigma: f64) -> Vec<Tip> {
    let step = sigma / 5.0;
    let line = polygon::resampled(margin.outline(), step);
    let even = evened(&line, 5.0);
    let n = line.len();
    let out = |i: usize| {
        let ahead = (even[(i + 1) % n] - even[(i + n - 1) % n]).normalize_or_zero();
        // Anticlockwise: outside is on the right.
        (line[i] - even[i]).dot(-ahead.perp())
    };
    let height: Vec<f64> = (0..n).map(out).collect();
    let places = Places::new(margin, &line);
    let ends = ENDS * margin.length_mm();
    peaks(&height, STANDS_OUT * sigma)
        .into_iter()
        .map(|(i, height)| places.tip(i, line[i], height))
        .filter(|tip| {
            let (below, above) = (tip.along, 1.0 - tip.along);
            let side = places.length(tip.side);
            below * side > ends && above * side > ends
        })
        .collect()
}

/// The tips of the lobes of a margin, without the apex, on each side from apex to base.
pub(super) fn lobes(margin: &Margin) -> Vec<Tip> {
    let known = known_lobes(margin);
    if !known.is_empty() {
        return known;
    }
    let line = polygon::resampled(margin.outline(), 0.005 * margin.length_mm());
    let reach: Vec<f64> = evened(&line, 1.5).iter().map(|p| p.length()).collect();
    let places = Places::new(margin, &line);
    let tip = margin.apex();
    let mut lobes: Vec<Tip> = peaks(&reach, LOBE * margin.length_mm())
        .into_iter()
        .filter(|&(i, _)| line[i].distance(tip) > LOBE * margin.length_mm())
        .map(|(i, height)| places.tip(i, line[i], height))
        .collect();
    lobes.sort_by(|a, b| (b.side, b.along).partial_cmp(&(a.side, a.along)).expect("finite"));
    lobes
}

/// The tips of the lobes that the maker of a margin put there, without the one at the apex, from apex
/// to base on each side.
pub(super) fn known_lobes(margin: &Margin) -> Vec<Tip> {
    let near_apex = 0.02 * margin.length_mm();
    let ways = Ways::new(margin);
    let mut tips: Vec<Tip> = margin
        .landmarks()
        .iter()
        .filter(|mark| margin.outline()[mark.vertex].distance(margin.apex()) > near_apex)
        .filter_map(|mark| match mark.kind {
            LandmarkKind::LobeTip { origin } => {
                let tip = ways.tip(mark.vertex, LOBE * margin.length_mm());
                Some(Tip { origin: Some(origin), ..tip })
            }
            _ => None,
        })
        .collect();
    tips.sort_by(|a, b| (b.side, b.along).partial_cmp(&(a.side, a.along)).expect("finite"));
    tips
}

/// Peaks of a closed row of numbers that rise by `least` or more over the passes to higher ones, and
/// by how much; in order.
fn peaks(row: &[f64], least: f64) -> Vec<(usize, f64)> {
    let n = row.len();
    let higher = |a: usize, b: usize| row[a] > row[b] || (row[a] == row[b] && a < b);
    let mut found = Vec::new();
    for i in 0..n {
        let (before, after) = ((i + n - 1) % n, (i + 1) % n);
        if !higher(i, before) || !higher(i, after) {
            continue;
        }
        // Down on either side until something higher comes.
        let pass = |ahead: bool| {
            let mut low = row[i];
            for k in 1..n {
                let j = if ahead { (i + k) % n } else { (i + n - k) % n };
                if higher(j, i) {
                    break;
                }
                low = low.min(row[j]);
            }
            low
        };
        let rise = row[i] - pass(true).max(pass(false));
        if rise >= least {
            found.push((i, rise));
        }
    }
    found
}

/// Where on its side each vertex of a resampled outline lies.
struct Places {
    apex: usize,
    count: usize,
    step: f64,
}

impl Places {
    fn new(margin: &Margin, line: &[DVec2]) -> Self {
        let tip = margin.apex();
        let distance = |i: &usize| line[*i].distance_squared(tip);
        let nearest = (0..line.len()).min_by(|i, j| distance(i).total_cmp(&distance(j)));
        let apex = nearest.unwrap_or(0).clamp(1, line.len() - 1);
        let step = polygon::perimeter(line) / line.len() as f64;
        Self { apex, count: line.len(), step }
    }

    fn length(&self, side: f64) -> f64 {
        let count = if side > 0.0 { self.apex } else { self.count - self.apex };
        count as f64 * self.step
    }

    fn tip(&self, i: usize, at: DVec2, height: f64) -> Tip {
        let (side, along) = if i <= self.apex {
            (1.0, i as f64 / self.apex as f64)
        } else {
            (-1.0, (self.count - i) as f64 / (self.count - self.apex) as f64)
        };
        Tip { at, along, height, side, origin: None }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// An ellipse 100 mm long and 50 wide with teeth between base and apex.
    pub(in super::super) fn toothed(teeth: usize, depth: f64) -> Margin {
        let n = 1200;
        let at = |i: usize| {
            let share = i as f64 / n as f64;
            let t = std::f64::consts::TAU * share;
            let side = (2.0 * share).fract();
            let tooth = (teeth as f64 * side).fract();
            // A slow rise and a sudden fall towards the apex, as in an elm.
            let forward = if share < 0.5 { tooth } else { 1.0 - tooth };
            let out = 1.0 + depth / 25.0 * (forward - 0.5);
            DVec2::new(25.0 * out * libm::sin(t), 50.0 - 50.0 * libm::cos(t))
        };
        let mut outline: Vec<DVec2> = (0..n).map(at).collect();
        outline[n / 2].x = 0.0;
        Margin::new(outline, n / 2, Vec::new(), "").expect("a toothed margin")
    }

    #[test]
    fn teeth_are_found_on_both_sides_and_none_on_an_entire_margin() {
        for count in [8, 12] {
            let margin = toothed(count, 3.0);
            let found = teeth(&margin, 100.0 / count as f64);
            for side in [1.0, -1.0] {
                let tips = found.iter().filter(|tip| tip.side == side).count();
                assert!((count - 2..=count).contains(&tips), "{count} {side} {tips}");
            }
            assert!(found.iter().all(|tip| tip.height > 0.1), "{found:?}");
        }
        assert_eq!(teeth(&toothed(1, 0.0), 10.0), []);
    }

    #[test]
    fn five_lobes_have_four_tips_beside_the_apex() {
        let n = 720;
        let at = |i: usize| {
            let t = std::f64::consts::TAU * (i as f64 + 0.5) / n as f64;
            // Five lobes at 0, ±50 and ±100 degrees from the apex.
            let from_apex = (t - std::f64::consts::PI).to_degrees();
            let lobes = [0.0, 50.0, -50.0, 100.0, -100.0];
            let near = lobes.iter().map(|l| (from_apex - l).abs()).fold(f64::INFINITY, f64::min);
            let r = 40.0 + 40.0 * (1.0 - near / 25.0).max(-0.6);
            DVec2::new(r * libm::sin(t), -r * libm::cos(t))
        };
        let mut outline: Vec<DVec2> = vec![DVec2::ZERO];
        outline.extend((0..n).map(at));
        let apex = (1..=n).max_by(|&i, &j| outline[i].y.total_cmp(&outline[j].y)).expect("some");
        outline[apex].x = 0.0;
        let margin = Margin::new(outline, apex, Vec::new(), "").expect("a lobed margin");
        let found = lobes(&margin);
        assert_eq!(found.len(), 4, "{found:?}");
        assert_eq!(found.iter().filter(|tip| tip.side > 0.0).count(), 2);
    }
}
