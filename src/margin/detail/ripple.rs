//! Waves and roughness: an edge displaced by noise along it.

use glam::DVec2;

use super::node::Node;
use super::run::Run;
use super::spec::{RoughnessSpec, WaveSpec};
use crate::geometry::noise;

/// Points to a wave.
const FINENESS: f64 = 24.0;

/// The edge in waves, none at its ends nor before they begin; `longest` is the longest edge (mm), `scale` the
/// length of the blade (mm).
pub(super) fn waves(run: Run, spec: &WaveSpec, longest: f64, scale: f64, seed: u32) -> Run {
    if spec.height == 0.0 {
        return run;
    }
    let length = run.length();
    let count = (spec.count * length / longest).max(0.5);
    let pieces = (count * FINENESS).ceil();
    // Every point of the edge, and as many more as the waves need.
    let mut ways: Vec<f64> = (0..=pieces as usize).map(|i| length * i as f64 / pieces).collect();
    let mut way = 0.0;
    ways.extend(run.points().windows(2).map(|w| {
        way += w[0].distance(w[1]);
        way
    }));
    ways.retain(|way| *way <= length);
    ways.sort_by(f64::total_cmp);
    ways.dedup_by(|a, b| *a - *b < 1e-9 * length);
    let phase = f64::from(noise::unit(noise::lattice(0, 1, seed)));
    let shift = |s: f64| {
        let x = s / length;
        // Noise swings less than a sine of the same height and by half its frequency.
        let even = libm::sin(std::f64::consts::TAU * (count * x + phase));
        let uneven = 1.6 * noise::gradient_1d(2.0 * count * x + phase, seed);
        let mixed = even + (uneven - even) * spec.irregularity;
        let end = ((x - spec.from) * count).min((1.0 - x) * count).clamp(0.0, 1.0);
        spec.height * scale * mixed * end * end * (3.0 - 2.0 * end)
    };
    let reach = 0.25 * length / count;
    let points: Vec<DVec2> = ways
        .iter()
        .map(|&s| run.at(s) + run.frame(s, reach.min(0.02 * length)).1 * shift(s))
        .collect();
    let feet = ways.iter().map(|&s| run.foot(s)).collect();
    Run::displaced(points, feet, run.outward)
}

/// Bumps of the grain are drawn with this many points.
const GRAIN_POINTS: f64 = 5.0;

/// Over so many grains roughness fades towards base and apex.
const FADE: f64 = 2.0;

/// An outline's nodes with fine unevenness; `fixed` are the base and the apex.
pub(super) fn roughened(
    nodes: &[Node],
    fixed: &[usize],
    spec: &RoughnessSpec,
    seed: u32,
) -> Vec<Node> {
    if spec.height_mm == 0.0 {
        return nodes.to_vec();
    }
    let n = nodes.len();
    let step = spec.grain_mm / GRAIN_POINTS / 4.0;
    let mut dense: Vec<(Node, f64)> = Vec::new();
    let mut way = 0.0;
    for (i, a) in nodes.iter().enumerate() {
        let b = &nodes[(i + 1) % n];
        let long = a.at.distance(b.at);
        let pieces = (long / step).ceil().max(1.0);
        dense.push((*a, way));
        for k in 1..pieces as usize {
            let t = k as f64 / pieces;
            let mut node = Node::plain(a.at.lerp(b.at, t), a.foot.lerp(b.foot, t), a.part);
            node.bare = a.bare.lerp(b.bare, t);
            if (b.part - a.part).abs() < 1.0 {
                node.part = a.part + (b.part - a.part) * t;
            }
            dense.push((node, way + t * long));
        }
        way += long;
    }
    let still: Vec<DVec2> = fixed.iter().map(|&i| nodes[i].at).collect();
    let count = dense.len();
    (0..count)
        .map(|i| {
            let (node, s) = dense[i];
            let (before, after) = (dense[(i + count - 1) % count].0, dense[(i + 1) % count].0);
            let out = -(after.at - before.at).normalize_or_zero().perp();
            let near = still.iter().map(|p| p.distance(node.at)).fold(f64::INFINITY, f64::min);
            let fade = (near / (FADE * spec.grain_mm)).min(1.0);
            let shift = spec.height_mm * fade * 1.6 * noise::fractal_1d(s / spec.grain_mm, 4, seed);
            Node { at: node.at + out * shift, bare: node.bare + out * shift, ..node }
        })
        .collect()
}
