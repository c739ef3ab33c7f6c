//! Which places of several margins answer each other, after sections 7.2.1 and 7.2.2.

use glam::DVec2;

use super::flank::{Flank, Turn};
use crate::geometry::alignment;

/// A place that every side has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum MarkKind {
    /// Base or apex.
    End,
    /// The tip of a lobe.
    Tip,
    /// The valley between two lobes.
    Valley,
    /// The highest or lowest place of an extension, or the waist.
    Landmark,
}

/// A mark on one of the sides.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mark {
    pub(super) way: f64,
    /// Where the vein of the lobe begins there, or would; of tips.
    pub(super) origin: DVec2,
}

/// The marks of all sides, those that answer each other in the same place of the lists; ways rise.
pub(super) fn marks(flanks: &[&Flank]) -> (Vec<MarkKind>, Vec<Vec<Mark>>) {
    let tips = |flank: &Flank| flank.turns.iter().filter(|turn| turn.is_tip()).count();
    let most = flanks.iter().map(|flank| tips(flank)).max().unwrap_or(0);
    let (kinds, inner) = if most > 0 {
        let model = flanks.iter().find(|flank| tips(flank) == most).expect("one has the most");
        let kind = |turn: &Turn| if turn.is_tip() { MarkKind::Tip } else { MarkKind::Valley };
        let kinds = model.turns.iter().map(kind).collect();
        (kinds, flanks.iter().map(|flank| lobed(flank, model)).collect::<Vec<_>>())
    } else {
        unilobed(flanks)
    };
    let ends = |kinds: Vec<MarkKind>| [vec![MarkKind::End], kinds, vec![MarkKind::End]].concat();
    let full = |(flank, mut inner): (&&Flank, Vec<Mark>)| {
        spread(&mut inner, flank.length());
        let end = |way: f64| Mark { way, origin: DVec2::ZERO };
        [vec![end(0.0)], inner, vec![end(flank.length())]].concat()
    };
    (ends(kinds), flanks.iter().zip(inner).map(full).collect())
}

/// Marks are at least this share of the side apart.
const APART: f64 = 1e-3;

fn spread(marks: &mut [Mark], length: f64) {
    let count = marks.len();
    let gap = APART.min(0.5 / (count + 1) as f64) * length;
    let mut low = gap;
    for (i, mark) in marks.iter_mut().enumerate() {
        mark.way = mark.way.clamp(low, (length - gap * (count - i) as f64).max(low));
        low = mark.way + gap;
    }
}

/// Tail, waist and shoulder, after 7.2.1: the waist is the widest place; a side without an extension has
/// its landmark where that of the nearest side with one divides the way (equation 7.1).
fn unilobed(flanks: &[&Flank]) -> (Vec<MarkKind>, Vec<Vec<Mark>>) {
    let extreme = |flank: &Flank, range: std::ops::Range<usize>, value: fn(DVec2) -> f64| {
        let points = flank.points();
        let most = range.max_by(|&i, &j| value(points[i]).total_cmp(&value(points[j])));
        most.map(|i| (flank.ways()[i], value(points[i])))
    };
    let waists: Vec<f64> = flanks
        .iter()
        .map(|flank| {
            let inner = 1..flank.points().len() - 1;
            extreme(flank, inner, |p| p.x).map_or(0.5 * flank.length(), |(way, _)| way)
        })
        .collect();
    let vertex = |flank: &Flank, way: f64| flank.ways().partition_point(|&w| w < way);
    let sides = || flanks.iter().zip(&waists);
    let tails: Vec<Option<f64>> = sides()
        .map(|(flank, &waist)| {
            let lowest = extreme(flank, 1..vertex(flank, waist).max(1), |p| -p.y)?;
            (lowest.1 > EXTENDS - flank.points()[0].y).then_some(lowest.0 / waist)
        })
        .collect();
    let shoulders: Vec<Option<f64>> = sides()
        .map(|(flank, &waist)| {
            let last = flank.points().len() - 1;
            let highest = extreme(flank, vertex(flank, waist)..last, |p| p.y)?;
            (highest.1 > 1.0 + EXTENDS)
                .then(|| (flank.length() - highest.0) / (flank.length() - waist))
        })
        .collect();
    let (tails, shoulders) = (shared_ratios(tails), shared_ratios(shoulders));
    let count = 1 + usize::from(tails.is_some()) + usize::from(shoulders.is_some());
    let place = |(k, (flank, &waist)): (usize, (&&Flank, &f64))| {
        let mut ways = Vec::with_capacity(count);
        ways.extend(tails.as_ref().map(|ratios| ratios[k] * waist));
        ways.push(waist);
        let upper = flank.length() - waist;
        ways.extend(shoulders.as_ref().map(|ratios| flank.length() - ratios[k] * upper));
        ways.into_iter().map(|way| Mark { way, origin: DVec2::ZERO }).collect()
    };
    (vec![MarkKind::Landmark; count], sides().enumerate().map(place).collect())
}

/// A side that reaches farther than this beyond its end has an extension (lengths).
const EXTENDS: f64 = 0.004;

/// Along the chain of leaves, what one lacks is that of its nearest neighbour; `None` when all lack it.
fn shared_ratios(mut ratios: Vec<Option<f64>>) -> Option<Vec<f64>> {
    ratios.iter().flatten().next()?;
    while ratios.iter().any(Option::is_none) {
        let before = ratios.clone();
        for k in 0..ratios.len() {
            if before[k].is_none() {
                let lower = k.checked_sub(1).and_then(|j| before[j]);
                ratios[k] = lower.or_else(|| before.get(k + 1).copied().flatten());
            }
        }
    }
    ratios.into_iter().collect()
}

/// Lobes whose tips are seen from the base at more than this angle from each other never answer each
/// other (degrees).
const SAME_LOBE_DEG: f64 = 75.0;

/// Where a side has the model's lobe tips and valleys, after 7.2.2: its own where they answer each other;
/// else where the model's vein, cast from its origin, meets the margin, and half-way between tips.
fn lobed(flank: &Flank, model: &Flank) -> Vec<Mark> {
    let turns = &model.turns;
    let own = &flank.turns;
    let alike =
        own.len() == turns.len() && own.iter().zip(turns).all(|(a, b)| a.is_tip() == b.is_tip());
    if alike {
        return own.iter().map(|turn| Mark { way: turn.way, origin: origin(turn) }).collect();
    }
    let (low, high) = (0.0, flank.length());
    let tips: Vec<&Turn> = turns.iter().filter(|turn| turn.is_tip()).collect();
    let own_tips: Vec<&Turn> = own.iter().filter(|turn| turn.is_tip()).collect();
    let angle = |p: DVec2| libm::atan2(p.x, p.y).to_degrees();
    let gain = |i: usize, j: usize| {
        let (a, b) = (flank.at(own_tips[i].way), model.at(tips[j].way));
        1.0 - (angle(a) - angle(b)).abs() / SAME_LOBE_DEG
    };
    let mut known: Vec<Option<Mark>> = vec![None; tips.len()];
    for (i, answer) in alignment::in_order(own_tips.len(), tips.len(), gain).iter().enumerate() {
        if let Some(j) = answer {
            known[*j] = Some(Mark { way: own_tips[i].way, origin: origin(own_tips[i]) });
        }
    }
    // The others by their veins, kept in order between those that are known.
    let mut all: Vec<Mark> = Vec::with_capacity(tips.len());
    for (j, tip) in tips.iter().enumerate() {
        if let Some(mark) = known[j] {
            all.push(mark);
            continue;
        }
        let before = all.last().map_or(low, |mark| mark.way);
        let next = (j..tips.len()).find_map(|k| known[k].map(|mark| (k, mark.way)));
        let (k, after) = next.unwrap_or((tips.len(), high));
        let from = origin(tip);
        let cast = flank.way_to(from, (model.at(tip.way) - from).normalize_or_zero());
        let room = (after - before) / (k - j + 1) as f64;
        let fits = |way: &f64| *way > before + 0.25 * room && *way < after - 0.25 * room;
        let way = cast.filter(fits).unwrap_or(before + room);
        all.push(Mark { way, origin: from });
    }
    // Valleys: an own one between the two tips, or the middle of the way.
    let mut next = 0;
    turns
        .iter()
        .map(|turn| {
            if turn.is_tip() {
                next += 1;
                return all[next - 1];
            }
            let before = if next > 0 { all[next - 1].way } else { low };
            let after = all.get(next).map_or(high, |mark| mark.way);
            let middle = 0.5 * (before + after);
            let inside = |way: &f64| *way > before && *way < after;
            let valleys = own.iter().filter(|own| !own.is_tip()).map(|own| own.way);
            let near = |a: &f64, b: &f64| (a - middle).abs().total_cmp(&(b - middle).abs());
            let way = valleys.filter(inside).min_by(near).unwrap_or(middle);
            Mark { way, origin: DVec2::ZERO }
        })
        .collect()
}

fn origin(turn: &Turn) -> DVec2 {
    turn.origin.unwrap_or(DVec2::ZERO)
}
