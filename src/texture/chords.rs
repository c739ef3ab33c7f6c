//! The veins of a leaf as few straight strokes.
//!
//! Veins grow in steps of a few hundredths of a millimetre, on most textures a texel or two: drawn one by one, their
//! strokes would overlap many times. Steps in a row become one chord as long as no node is farther from it, and no
//! radius farther from its own, than may be. A chord is lengthened while its direction stays within what all nodes
//! passed allow, so that a node costs the same on a chord of any length (Z. Zhao, A. Saalfeld, "Linear-time
//! sleeve-fitting polyline simplification algorithms", 1997).

use glam::DVec2;

use super::fields::BRANCH_FLARE;
use crate::veins::Venation;

/// A vein thins to this share of its radius at its end, so that it is lost in the tissue.
const TIP: f64 = 0.35;

/// A straight, tapered piece of a vein.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Chord {
    pub(super) from: u32,
    pub(super) to: u32,
    /// At both ends (mm).
    pub(super) radii: [f64; 2],
}

/// The veins that have grown, with these radii at the nodes: at a fork a branch widens to at most
/// [`BRANCH_FLARE`] times its own radius, and by no more than it is long. Nodes and radii are met to `tolerance`;
/// all lengths are in mm.
pub(super) fn chords(venation: &Venation, radii: &[f64], tolerance: f64) -> Vec<Chord> {
    let graph = venation.graph();
    let (positions, orders) = (graph.positions(), venation.orders());
    let children = graph.child_counts();
    let mut joined = vec![false; graph.len()];
    for &(a, b) in graph.joins() {
        (joined[a as usize], joined[b as usize]) = (true, true);
    }
    // The chord that each node ends, as far as it may still be lengthened.
    let mut open: Vec<Option<Sleeve>> = vec![None; graph.len()];
    let mut chords = Vec::new();
    for (parent, child) in graph.edges() {
        let (a, b) = (parent as usize, child as usize);
        let ends = children[b] == 0 && !joined[b];
        let radius = radii[b] * if ends { TIP } else { 1.0 };
        let length = positions[a].distance(positions[b]);
        let flared = (radii[b] * BRANCH_FLARE).min(radii[b] + length);
        let alike = children[a] == 1 && radii[a] <= flared && orders[a] == orders[b];
        let longer = open[a].take().and_then(|sleeve| {
            let longer = if alike { sleeve.past(positions[b], radius, tolerance) } else { None };
            if longer.is_none() {
                chords.push(sleeve.chord(parent));
            }
            longer
        });
        let start = Sleeve::new(parent, positions[a], radii[a].min(flared));
        match longer.or_else(|| start.past(positions[b], radius, tolerance)) {
            Some(sleeve) if children[b] == 1 => open[b] = Some(sleeve),
            Some(sleeve) => chords.push(sleeve.chord(child)),
            None => chords.push(Sleeve { radius, ..start }.chord(child)),
        }
    }
    chords
}

/// A chord from a node on, and where it may go.
#[derive(Debug, Clone, Copy)]
struct Sleeve {
    from: u32,
    start: DVec2,
    first_radius: f64,
    /// Between these directions, anticlockwise; none before the first node that says anything.
    between: Option<[DVec2; 2]>,
    /// How far the chord goes (mm): it does not turn back.
    reach: f64,
    /// The radius may change by so much from mm to mm.
    slopes: [f64; 2],
    /// At the node reached.
    radius: f64,
}

impl Sleeve {
    fn new(from: u32, start: DVec2, radius: f64) -> Self {
        let slopes = [f64::NEG_INFINITY, f64::INFINITY];
        Self { from, start, first_radius: radius, between: None, reach: 0.0, slopes, radius }
    }

    fn chord(&self, to: u32) -> Chord {
        Chord { from: self.from, to, radii: [self.first_radius, self.radius] }
    }

    /// The same lengthened to a place, where it has a radius; none where it may not go there.
    fn past(self, at: DVec2, radius: f64, tolerance: f64) -> Option<Self> {
        let to = at - self.start;
        let length = to.length();
        if length <= tolerance {
            // So near the start every direction meets it.
            let near = self.reach == 0.0 && (radius - self.first_radius).abs() <= tolerance;
            return near.then_some(Self { radius, ..self });
        }
        let (slope, off) = ((radius - self.first_radius) / length, tolerance / length);
        let [least, most] = self.slopes;
        let is_between = self.between.is_none_or(|[right, left]| {
            right.perp_dot(to) >= 0.0 && to.perp_dot(left) >= 0.0 && to.dot(right + left) > 0.0
        });
        if !is_between || length < self.reach || slope < least || slope > most {
            return None;
        }
        // The directions that pass the place within the tolerance.
        let turn = DVec2::new((1.0 - off * off).sqrt(), off);
        let (right, left) = (DVec2::new(turn.x, -turn.y).rotate(to), turn.rotate(to));
        let [right, left] = self.between.map_or([right, left], |[first, last]| {
            [
                if first.perp_dot(right) > 0.0 { right } else { first },
                if left.perp_dot(last) > 0.0 { left } else { last },
            ]
        });
        let slopes = [least.max(slope - off), most.min(slope + off)];
        Some(Self { between: Some([right, left]), reach: length, slopes, radius, ..self })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};
    use crate::veins::VeinGraph;

    /// A winding vein that forks at times, with radii that fall.
    fn winding(seed: u64) -> Venation {
        let mut rng = Seed(seed).stream(Stage::Tissue);
        let mut graph = VeinGraph::new();
        let mut radii = vec![0.4];
        let mut tips = vec![(graph.add_root(DVec2::ZERO), DVec2::Y, 0.4)];
        for _ in 0..600 {
            let i = (rng.between(0.0, tips.len() as f64) as usize).min(tips.len() - 1);
            let (tip, way, radius) = tips[i];
            let turn = rng.between(-0.25, 0.25) * rng.between(0.0, 1.0);
            let way = DVec2::from_angle(turn).rotate(way);
            let step = rng.between(0.0, 0.1);
            let at = graph.positions()[tip as usize] + way * step;
            let radius = radius * rng.between(0.98, 1.0);
            let next = graph.sprout(tip, at);
            radii.push(radius);
            tips[i] = (next, way, radius);
            if rng.between(0.0, 1.0) < 0.03 {
                let side = DVec2::from_angle(0.9).rotate(way);
                let branch = graph.sprout(tip, at + 0.05 * side);
                radii.push(0.5 * radius);
                tips.push((branch, side, 0.5 * radius));
            }
        }
        let orders = vec![1; radii.len()];
        Venation::new(graph, radii, orders)
    }

    #[test]
    fn chords_pass_every_node_and_radius_within_the_tolerance() {
        for (seed, tolerance) in [(1, 0.002), (2, 0.01), (3, 0.05)] {
            let venation = winding(seed);
            let graph = venation.graph();
            let at = |node: u32| graph.positions()[node as usize];
            let children = graph.child_counts();
            let chords = chords(&venation, venation.radii(), tolerance);
            let mut passed = 0;
            for chord in &chords {
                let (a, b) = (at(chord.from), at(chord.to));
                let along = (b - a) / a.distance_squared(b).max(1e-12);
                let mut node = chord.to;
                while node != chord.from {
                    passed += 1;
                    let place = (at(node) - a).dot(along).clamp(0.0, 1.0);
                    let off = at(node).distance(a.lerp(b, place));
                    assert!(off <= 1.001 * tolerance, "{off} off at {node} of {chord:?}");
                    let radius = chord.radii[0] + (chord.radii[1] - chord.radii[0]) * place;
                    if children[node as usize] == 1 {
                        let off = (radius - venation.radii()[node as usize]).abs();
                        assert!(off <= 1.3 * tolerance, "radius {off} off at {node} of {chord:?}");
                    }
                    node = graph.parent(node).expect("a chord follows a vein");
                    let inner = node == chord.from || children[node as usize] == 1;
                    assert!(inner, "no chord runs past a fork");
                }
            }
            assert_eq!(passed, graph.edges().count(), "every edge lies on one chord");
            assert!(chords.len() * 2 < passed, "{} chords for {passed} edges", chords.len());
        }
    }

    #[test]
    fn a_vein_thins_at_its_end_and_widens_at_a_fork() {
        let mut graph = VeinGraph::new();
        let root = graph.add_root(DVec2::ZERO);
        let fork = graph.sprout(root, DVec2::Y);
        graph.sprout(fork, DVec2::new(0.0, 2.0));
        graph.sprout(fork, DVec2::new(1.0, 1.0));
        let radii = vec![0.4, 0.4, 0.3, 0.1];
        let venation = Venation::new(graph, radii.clone(), vec![1; 4]);
        let found = chords(&venation, &radii, 0.01);
        let chord = |from, to, radii| Chord { from, to, radii };
        let expected = [
            chord(0, 1, [0.4, 0.4]),
            chord(1, 2, [0.3 * BRANCH_FLARE, 0.3 * TIP]),
            chord(1, 3, [0.1 * BRANCH_FLARE, 0.1 * TIP]),
        ];
        assert_eq!(found, expected);
    }
}
