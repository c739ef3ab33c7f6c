//! What to change about a unilobed margin that crosses itself: the key, its value and how far it may go.

use glam::DVec2;

use super::SideSpec;
use crate::margin::{Margin, MarginError, MarginSpec};

/// Bisections for a bound: it is printed with three digits.
const HALVINGS: usize = 12;

/// Shares of the way to the harmless end at which a setting is tried first.
const SHARES: [f64; 6] = [0.1, 0.25, 0.4, 0.6, 0.8, 1.0];

/// A setting that can make a margin cross itself.
struct Lever {
    key: &'static str,
    /// Of both sides, and of the whole leaf where it is one.
    get: fn(&SideSpec) -> f64,
    set: fn(&mut SideSpec, f64),
    /// Where it does no harm.
    harmless: f64,
}

const LEVERS: [Lever; 7] = [
    Lever { key: "tension", get: |s| s.tension, set: |s, x| s.tension = x, harmless: 0.05 },
    Lever {
        key: "tail_depth",
        get: |s| s.tail_depth,
        set: |s, x| s.tail_depth = x,
        harmless: 0.001,
    },
    Lever {
        key: "shoulder_height",
        get: |s| s.shoulder_height,
        set: |s, x| s.shoulder_height = x,
        harmless: 0.001,
    },
    Lever {
        key: "base_angle_deg",
        get: |s| s.base_angle_deg,
        set: |s, x| s.base_angle_deg = x,
        harmless: 90.0,
    },
    Lever {
        key: "apex_angle_deg",
        get: |s| s.apex_angle_deg,
        set: |s, x| s.apex_angle_deg = x,
        harmless: 90.0,
    },
    Lever { key: "waist_x", get: |s| s.waist_x, set: |s, x| s.waist_x = x, harmless: 0.5 },
    Lever { key: "waist_y", get: |s| s.waist_y, set: |s, x| s.waist_y = x, harmless: 0.5 },
];

/// For a margin that crosses itself, the setting that has the shortest way to go, and its bound with
/// everything else as it is; the error as it was when none alone helps.
pub(in crate::margin) fn advised(spec: &MarginSpec, error: MarginError) -> MarginError {
    let MarginError::SelfCrossing { x, y, .. } = error else { return error };
    let mut best: Option<(f64, MarginError)> = None;
    let mut offer = |share: f64, key: String, value: f64, bound: f64| {
        if best.as_ref().is_none_or(|(least, _)| share < *least) {
            let side = if bound < value { "most" } else { "least" };
            let problem = format!("takes the margin across itself; take {bound} at {side}");
            best = Some((share, MarginError::CrossingBy { x, y, key, value, problem }));
        }
    };
    if spec.midrib_bend_deg != 0.0 {
        let bend = spec.midrib_bend_deg;
        let straighter =
            |share: f64| MarginSpec { midrib_bend_deg: bend * (1.0 - share), ..spec.clone() };
        if let Some(share) = least_share(straighter) {
            let bound = inward(bend * (1.0 - share), 0.0);
            offer(share, "margin.midrib_bend_deg".into(), bend, bound);
        }
    }
    let [right, left] = spec.sides();
    for lever in &LEVERS {
        let values = [(lever.get)(&right), (lever.get)(&left)];
        let off = values.map(|value| (value - lever.harmless).abs());
        let (value, name) =
            if off[1] > off[0] { (values[1], "left") } else { (values[0], "right") };
        let to = |share: f64| value + (lever.harmless - value) * share;
        let moved = |share: f64| {
            let bound = inward(to(share), lever.harmless);
            let mut spec = spec.clone();
            let mut sides = [right.clone(), left.clone()];
            for side in &mut sides {
                let now = (lever.get)(side);
                let bounded = if bound < value { now.min(bound) } else { now.max(bound) };
                (lever.set)(side, bounded);
            }
            [spec.right, spec.left] = sides;
            spec.asymmetry = 1.0;
            spec
        };
        if let Some(share) = least_share(moved) {
            let bound = inward(to(share), lever.harmless);
            offer(share, format!("margin.{name}.{}", lever.key), value, bound);
        }
    }
    best.map_or(error, |(_, advice)| advice)
}

/// Rounded to three digits towards what does no harm, so that the bound itself works.
fn inward(value: f64, harmless: f64) -> f64 {
    let digits = value * 1e3;
    if value > harmless { digits.floor() / 1e3 } else { digits.ceil() / 1e3 }
}

/// The shortest way to a margin, as a share of the way to the harmless end.
fn least_share(at: impl Fn(f64) -> MarginSpec) -> Option<f64> {
    let works = |share: f64| {
        let spec = at(share);
        super::outline(&spec).is_ok_and(|outline| {
            let outline = outline.peltate(spec.base_inset).scaled(DVec2::splat(spec.length_mm));
            Margin::from_outline(outline, "").is_ok()
        })
    };
    let first = SHARES.iter().position(|&share| works(share))?;
    let (mut low, mut high) = (if first == 0 { 0.0 } else { SHARES[first - 1] }, SHARES[first]);
    for _ in 0..HALVINGS {
        let middle = f64::midpoint(low, high);
        if works(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    Some(high)
}
