//! The colours of all leaves, worked out once: a lattice over the amounts of pigments, read in between.
//!
//! Five axes (chlorophyll, carotenoid, anthocyanin, brown, structure); along the first four nodes lie
//! evenly in c / (c + half), where colours change evenly, and no amount is out of range. Between the
//! nodes the value is linear in the simplex of the sorted coordinates (H. Kuhn, 1960): six nodes are
//! read, not thirty-two. Values are sRGB numbers, continued outside 0–1.

use std::sync::LazyLock;

use super::pigment::{Albedo, Amounts};
use super::spectrum::{Spectrum, encoded};
use super::strip::{LANES, Lane};

/// Nodes on each axis.
const NODES: [usize; 5] = [16, 8, 9, 8, 5];

/// Amounts at which an axis has come half way; for the structure, its range.
const HALF: [f64; 4] = [12.0, 8.0, 8.0, 0.8];
const STRUCTURE: [f64; 2] = [1.0, 3.2];

/// The last node stands for these amounts; more looks the same.
const MOST: [f64; 4] = [120.0, 40.0, 60.0, 4.0];

/// Red, green, blue sent back and let through; two lanes are spare.
type Node = [f32; 8];

/// Colours over amounts.
#[derive(Debug)]
pub(super) struct Lattice {
    nodes: Vec<Node>,
    scale: [f32; 4],
}

/// The lattice of this kind of base colour, made when first asked for.
pub(super) fn of(albedo: Albedo) -> &'static Lattice {
    static TOTAL: LazyLock<Lattice> = LazyLock::new(|| Lattice::new(Albedo::Total));
    static DIFFUSE: LazyLock<Lattice> = LazyLock::new(|| Lattice::new(Albedo::Diffuse));
    match albedo {
        Albedo::Total => &TOTAL,
        Albedo::Diffuse => &DIFFUSE,
    }
}

/// Steps from a node to the next one on each axis, in the list of nodes.
const STRIDES: [usize; 5] = {
    let mut strides = [1; 5];
    let mut axis = 4;
    while axis > 0 {
        strides[axis - 1] = strides[axis] * NODES[axis];
        axis -= 1;
    }
    strides
};

/// A channel of the light sent back and let through. At no wavelength is that more than falls on the
/// leaf, but a pale saturated yellow lies outside sRGB and would have more red than white has: both
/// are brought down together. In between the nodes it holds too, since sRGB's curve is concave.
fn held(back: f64, through: f64) -> [f64; 2] {
    let excess = (back + through).max(1.0);
    [back / excess, through / excess]
}

impl Lattice {
    fn new(albedo: Albedo) -> Self {
        let spectrum = Spectrum::new();
        let scale: [f64; 4] =
            std::array::from_fn(|k| (NODES[k] - 1) as f64 * (MOST[k] + HALF[k]) / MOST[k]);
        let amount = |k: usize, i: usize| {
            let place = i as f64 / scale[k];
            HALF[k] * place / (1.0 - place)
        };
        let count = NODES.iter().product();
        let node = |index: usize| {
            let at: [usize; 5] = std::array::from_fn(|k| index / STRIDES[k] % NODES[k]);
            let share = at[4] as f64 / (NODES[4] - 1) as f64;
            let structure = STRUCTURE[0] + (STRUCTURE[1] - STRUCTURE[0]) * share;
            let [a, b, c, d] = std::array::from_fn(|k| amount(k, at[k]));
            let seen = spectrum.seen(&Amounts::of([a, b, c, d, structure]));
            let back = match albedo {
                Albedo::Total => seen.total,
                Albedo::Diffuse => seen.diffuse,
            };
            let mut node = [0.0; 8];
            for c in 0..3 {
                let [back, through] = held(back[c], seen.through[c]);
                node[c] = encoded(back) as f32;
                node[c + 3] = encoded(through) as f32;
            }
            node
        };
        Self { nodes: (0..count).map(node).collect(), scale: scale.map(|v| v as f32) }
    }

    /// Red, green, blue sent back, then let through, as sRGB numbers, of leaves with so much
    /// chlorophyll, carotenoid, anthocyanin, brown and structure.
    #[inline(always)]
    pub(super) fn read(&self, amounts: &[Lane; 5], colours: &mut [Node; LANES]) {
        const PER_STRUCTURE: f32 = (NODES[4] - 1) as f32 / (STRUCTURE[1] - STRUCTURE[0]) as f32;
        let mut first = [0_i32; LANES];
        // How far past its node a place lies on each axis, from far to near. Positive floats sort as
        // their bits do; the last three bits carry the axis.
        let mut keys = [[0_u32; LANES]; 5];
        for i in 0..LANES {
            let place: [f32; 5] = std::array::from_fn(|k| {
                let amount = amounts[k][i];
                let place = if k < 4 {
                    amount / (amount + HALF[k] as f32) * self.scale[k]
                } else {
                    (amount - STRUCTURE[0] as f32) * PER_STRUCTURE
                };
                place.max(0.0).min((NODES[k] - 1) as f32 - 1e-3)
            });
            let node = place.map(|v| v as i32);
            first[i] = (0..5).map(|k| node[k] * STRIDES[k] as i32).sum();
            let mut key: [u32; 5] =
                std::array::from_fn(|k| ((place[k] - node[k] as f32).to_bits() & !7) | k as u32);
            for (a, b) in [(0, 3), (1, 4), (0, 2), (1, 3), (0, 1), (2, 4), (1, 2), (3, 4), (2, 3)] {
                (key[a], key[b]) = (key[a].max(key[b]), key[a].min(key[b]));
            }
            for (keys, key) in keys.iter_mut().zip(key) {
                keys[i] = key;
            }
        }
        for i in 0..LANES {
            let (mut index, mut before, mut sum) = (first[i] as usize, 1.0, [0.0; 8]);
            for key in &keys {
                let share = f32::from_bits(key[i] & !7);
                add(&mut sum, &self.nodes[index], before - share);
                index += AXIS_STRIDES[(key[i] & 7) as usize];
                before = share;
            }
            add(&mut sum, &self.nodes[index], before);
            colours[i] = sum;
        }
    }
}

/// [`STRIDES`], and as many more as make every three bits name one.
const AXIS_STRIDES: [usize; 8] =
    [STRIDES[0], STRIDES[1], STRIDES[2], STRIDES[3], STRIDES[4], 0, 0, 0];

#[inline(always)]
fn add(sum: &mut Node, node: &Node, weight: f32) {
    for (sum, value) in sum.iter_mut().zip(node) {
        *sum += value * weight;
    }
}

#[cfg(test)]
mod tests {
    use super::super::spectrum::decoded;
    use super::*;
    use crate::seed::{Seed, Stage};

    impl Lattice {
        fn at(&self, amounts: [f32; 5]) -> Node {
            let mut colours = [[0.0; 8]; LANES];
            self.read(&amounts.map(|amount| [amount; LANES]), &mut colours);
            colours[LANES - 1]
        }
    }

    #[test]
    fn between_the_nodes_the_lattice_is_the_model_to_two_steps_of_eight_bits() {
        let (lattice, spectrum) = (of(Albedo::Total), Spectrum::new());
        let mut rng = Seed(5).stream(Stage::Tissue);
        let (mut squares, mut worst) = (0.0, (0.0_f64, [0.0; 5], 0));
        for _ in 0..3000 {
            let state = [
                rng.between(0.0, 75.0),
                rng.between(0.0, 16.0),
                rng.between(0.0, 30.0) * rng.between(0.0, 1.0),
                rng.between(0.0, 2.5) * rng.between(0.0, 1.0),
                rng.between(1.2, 2.8),
            ];
            let seen = spectrum.seen(&Amounts::of(state));
            let found = lattice.at(state.map(|v| v as f32));
            for c in 0..3 {
                let exact = held(seen.total[c], seen.through[c]);
                for (found, exact) in [(found[c], exact[0]), (found[c + 3], exact[1])] {
                    let off = (f64::from(found).max(0.0) - encoded(exact).max(0.0)) * 255.0;
                    // Near black a step of eight bits is a tenth of what it is in the middle: there
                    // the light itself counts.
                    let light = decoded(f64::from(found).max(0.0)) - exact.max(0.0);
                    if off.abs() > worst.0 && light.abs() > 0.004 {
                        worst = (off.abs(), state, c);
                    }
                    squares += off * off / (6.0 * 3000.0);
                }
            }
        }
        assert!(squares.sqrt() < 1.2 && worst.0 < 6.0, "{} {worst:?}", squares.sqrt());
    }

    #[test]
    fn no_node_sends_back_and_lets_through_more_than_falls_on_it() {
        for node in &of(Albedo::Total).nodes {
            for c in 0..3 {
                let sum = decoded(f64::from(node[c])) + decoded(f64::from(node[c + 3]));
                assert!(sum <= 1.0 + 1e-6, "{node:?}");
            }
        }
    }

    #[test]
    fn amounts_beyond_all_measure_look_like_the_most() {
        let lattice = of(Albedo::Total);
        assert_eq!(lattice.at([1e9, 0.0, 0.0, 1e9, 9.0]), lattice.at([1e9, 0.0, 0.0, 1e9, 3.2]));
    }
}
