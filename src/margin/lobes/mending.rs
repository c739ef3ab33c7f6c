//! What to change about lobes that cross: the key, its value and how far it may go.

use glam::DVec2;

use super::{LobeRecord, LobeSide, outline};
use crate::margin::{LandmarkKind, Margin, MarginError, MarginSpec, Outline};

/// Bisections for a bound: it is printed with three digits.
const HALVINGS: usize = 12;

/// Widths that are tried first, from wide to narrow, as shares of what it is: a lobe much narrower than
/// its valleys are apart crosses itself as well, so the half that is narrow already stays.
const SHARES: [f64; 9] = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1];

/// So many lobes around a crossing are looked at.
const TRIED: usize = 4;

/// For lobes that cross: the waist of the lobe there, and the widest it may be with everything else as it
/// is; the error as it was when no width of that lobe helps.
pub(in crate::margin) fn advised(
    spec: &MarginSpec,
    records: &[LobeRecord],
    error: MarginError,
) -> MarginError {
    let MarginError::SelfCrossing { x, y, .. } = error else { return error };
    let at = DVec2::new(x, y) / spec.length_mm;
    let crossing = outline(records).map(|outline| outline.peltate(spec.base_inset));
    crossing.ok().and_then(|crossing| advice(spec, records, &crossing, at)).unwrap_or(error)
}

fn advice(
    spec: &MarginSpec,
    records: &[LobeRecord],
    crossing: &Outline,
    at: DVec2,
) -> Option<MarginError> {
    let nearest = (0..crossing.points.len()).min_by(|&i, &j| {
        let off = |i: usize| crossing.points[i].distance_squared(at);
        off(i).total_cmp(&off(j))
    })?;
    // The lobes by how far along the outline their tips are: first the one between the valleys around
    // that vertex; where it is not the one to blame, its neighbours.
    let mut tips: Vec<usize> = crossing
        .landmarks
        .iter()
        .filter(|mark| matches!(mark.kind, LandmarkKind::LobeTip { .. }))
        .map(|mark| mark.vertex)
        .collect();
    tips.sort_by_key(|vertex| vertex.abs_diff(nearest));
    tips.into_iter().take(TRIED).find_map(|tip| {
        let index = record_of(records, crossing.points[tip], spec.base_inset)?;
        bound(spec, records, index, at)
    })
}

/// The widest that a lobe may be.
fn bound(
    spec: &MarginSpec,
    records: &[LobeRecord],
    index: usize,
    at: DVec2,
) -> Option<MarginError> {
    let listed = !spec.lobe.is_empty();
    let record = &records[index];
    let upper = record.upper.waist_x >= record.lower.waist_x;
    let value = if upper { record.upper.waist_x } else { record.lower.waist_x };
    let works = |share: f64| {
        let mut narrower = records.to_vec();
        for (i, lobe) in narrower.iter_mut().enumerate() {
            // In the shorthand all lobes have one shape.
            if i == index || !listed {
                lobe.lower.waist_x = lobe.lower.waist_x.min(value * share);
                lobe.upper.waist_x = lobe.upper.waist_x.min(value * share);
            }
        }
        let scale = DVec2::splat(spec.length_mm);
        outline(&narrower)
            .and_then(|o| Margin::from_outline(o.peltate(spec.base_inset).scaled(scale), ""))
            .is_ok()
    };
    let first = SHARES.iter().position(|&share| works(share))?;
    let (mut low, mut high) = (SHARES[first], if first == 0 { 1.0 } else { SHARES[first - 1] });
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if works(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    let half = if upper { "upper" } else { "lower" };
    let group = if listed { format!("margin.lobe.{}", index + 1) } else { "margin.lobing".into() };
    // Rounded down, so that the bound itself works.
    let most = (value * low * 1e3).floor() / 1e3;
    Some(MarginError::CrossingBy {
        x: at.x * spec.length_mm,
        y: at.y * spec.length_mm,
        key: format!("{group}.{half}.waist_x"),
        value,
        problem: format!(
            "is too wide beside its neighbours; take {most} or less, and no more for the other half"
        ),
    })
}

/// The record whose lobe has its tip there.
fn record_of(records: &[LobeRecord], tip: DVec2, inset: f64) -> Option<usize> {
    let at = tip * (1.0 - inset) + DVec2::new(0.0, inset);
    let folded = DVec2::new(at.x.abs(), at.y);
    let off = |record: &LobeRecord| {
        let on = match record.side {
            LobeSide::Right => at.x >= 0.0,
            LobeSide::Left => at.x <= 0.0,
            LobeSide::Both | LobeSide::Each | LobeSide::Apex => true,
        };
        if on { super::Lobe::new(record).tip().distance(folded) } else { f64::INFINITY }
    };
    (0..records.len()).min_by(|&i, &j| off(&records[i]).total_cmp(&off(&records[j])))
}
