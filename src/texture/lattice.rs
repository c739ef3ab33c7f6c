//! The colours of all leaves, worked out once: a lattice over the amounts of pigments, read in between.
//!
//! Five axes (chlorophyll, carotenoid, anthocyanin, brown, structure); along the first four nodes lie
//! evenly in c / (c + half), where colours change evenly, and no amount is out of range. Between the
//! nodes the value is linear in the simplex of the sorted coordinates (H. Kuhn, 1960): six nodes are
//! read, not thirty-two. Values are sRGB numbers, continued outside 0–1.

use std::sync::LazyLock;

use super::brush::Shades;
use super::pigment::Albedo;
use super::spectrum::{Spectrum, Tabulated, encoded};
use super::strip::{LANES, Lane, texel};
use crate::geometry::whole;

/// Nodes on each axis.
const NODES: [usize; 5] = [16, 8, 9, 8, 5];

/// Amounts at which an axis has come half way; for the structure, its range.
const HALF: [f64; 4] = [12.0, 8.0, 8.0, 0.8];
const STRUCTURE: [f64; 2] = [1.0, 3.2];

/// The last node stands for these amounts; more looks the same.
const MOST: [f64; 4] = [120.0, 40.0, 60.0, 4.0];

/// Texels whose colours are turned from node by node to channel by channel together.
const BLOCK: usize = 8;

/// Red, green, blue sent back and let through; two lanes are spare.
type Node = [f32; 8];

/// As many nodes as a number of 16 bits can name: found by one, a node is not looked for past the end of a list.
const NAMED: usize = 1 << 16;
const _: () = assert!(STRIDES[0] * NODES[0] <= NAMED);

/// Colours over amounts.
#[derive(Debug)]
pub(super) struct Lattice {
    /// Those past the last on the lattice are black.
    nodes: Box<[Node; NAMED]>,
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

/// The bits of a sorted coordinate that hold a stride: what they take from it, a two-thousandth, is far less
/// than a step of 8 bits between any two nodes.
const STEP: u32 = (1 << 12) - 1;
const _: () = assert!(STRIDES[0] <= STEP as usize);

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
        let tables: Vec<Tabulated<'_>> = (0..NODES[4])
            .map(|i| {
                let share = i as f64 / (NODES[4] - 1) as f64;
                spectrum.tabulated(STRUCTURE[0] + (STRUCTURE[1] - STRUCTURE[0]) * share)
            })
            .collect();
        let node = |index: usize| {
            let at: [usize; 5] = std::array::from_fn(|k| index / STRIDES[k] % NODES[k]);
            let pigments = std::array::from_fn(|k| amount(k, at[k]));
            let seen = tables[at[4]].seen(pigments);
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
        let mut nodes: Vec<Node> = (0..count).map(node).collect();
        nodes.resize(NAMED, [0.0; 8]);
        let nodes = nodes.try_into().expect("as many as are named");
        Self { nodes, scale: scale.map(|v| v as f32) }
    }

    /// Red, green, blue sent back, then let through, as sRGB numbers, of leaves with so much
    /// chlorophyll, carotenoid, anthocyanin, brown and structure.
    #[inline(always)]
    pub(super) fn read(&self, amounts: &[Lane; 5], colours: &mut Shades) {
        const PER_STRUCTURE: f32 = (NODES[4] - 1) as f32 / (STRUCTURE[1] - STRUCTURE[0]) as f32;
        // The corners of a place's simplex, one after the other, and how much each counts.
        let (mut corners, mut weights) = ([[0_u32; LANES]; 6], [[0.0_f32; LANES]; 6]);
        for i in 0..LANES {
            let place: [f32; 5] = std::array::from_fn(|k| {
                let amount = amounts[k][i];
                let place = if k < 4 {
                    amount / (amount + HALF[k] as f32) * self.scale[k]
                } else {
                    (amount - STRUCTURE[0] as f32) * PER_STRUCTURE
                };
                whole::held(place, (NODES[k] - 1) as f32 - 1e-3)
            });
            let node = place.map(whole::floor);
            // How far past its node a place lies on each axis, from far to near. Positive floats sort as
            // their bits do; the last bits carry the step to the next node on that axis.
            let mut key: [u32; 5] = std::array::from_fn(|k| {
                ((place[k] - node[k] as f32).to_bits() & !STEP) | STRIDES[k] as u32
            });
            for (a, b) in [(0, 3), (1, 4), (0, 2), (1, 3), (0, 1), (2, 4), (1, 2), (3, 4), (2, 3)] {
                (key[a], key[b]) = (key[a].max(key[b]), key[a].min(key[b]));
            }
            let first: i32 = (0..5).map(|k| node[k] * STRIDES[k] as i32).sum();
            let (mut corner, mut before) = (first as u32, 1.0);
            for k in 0..5 {
                let share = f32::from_bits(key[k] & !STEP);
                (corners[k][i], weights[k][i]) = (corner, before - share);
                (corner, before) = (corner + (key[k] & STEP), share);
            }
            (corners[5][i], weights[5][i]) = (corner, before);
        }
        for block in (0..LANES).step_by(BLOCK) {
            let mut seen = [[0.0; 8]; BLOCK];
            for (i, seen) in seen.iter_mut().enumerate() {
                let at = block + i;
                let node = |k: usize| &self.nodes[usize::from(corners[k][at] as u16)];
                let mut sum = node(0).map(|channel| channel * weights[0][at]);
                for (k, weights) in weights.iter().enumerate().skip(1) {
                    let node = node(k);
                    for c in 0..8 {
                        sum[c] += node[c] * weights[at];
                    }
                }
                *seen = sum;
            }
            for c in 0..6 {
                for i in 0..BLOCK {
                    colours[c][block + i] = seen[i][c];
                }
            }
        }
    }
}

impl Lattice {
    /// Amounts of chlorophyll, carotenoid, anthocyanin, brown and structure of a leaf that sends back a
    /// colour (sRGB numbers, 0–1), or as near to it as leaves come. Of several such leaves that which is
    /// most like a living one: carotenoid follows chlorophyll, and nothing is brown without need.
    pub(super) fn leaf_of(&self, colour: [f32; 3]) -> [f32; 5] {
        let off = |amounts: [f32; 5], seen: &[f32]| -> f32 {
            let far: f32 = (0..3).map(|c| (seen[c] - colour[c]).powi(2)).sum();
            let [green, yellow, red, brown, structure] = amounts;
            let usual = ((yellow - 0.2 * green - 1.0) / 20.0).powi(2);
            far + 1e-4 * usual + 2e-6 * red + 1e-4 * brown + 1e-4 * (structure - 1.6).powi(2)
        };
        let node = |index: usize| -> [f32; 5] {
            std::array::from_fn(|k| {
                let at = (index / STRIDES[k] % NODES[k]) as f32;
                if k < 4 {
                    let place = at / self.scale[k];
                    HALF[k] as f32 * place / (1.0 - place)
                } else {
                    let share = at / (NODES[4] - 1) as f32;
                    (STRUCTURE[0] + (STRUCTURE[1] - STRUCTURE[0]) * f64::from(share)) as f32
                }
            })
        };
        let count = NODES.iter().product();
        let best = self.nodes[..count].iter().enumerate().map(|(i, seen)| (off(node(i), seen), i));
        let (mut least, i) = best.fold((f32::INFINITY, 0), |a, b| if b.0 < a.0 { b } else { a });
        let mut leaf = node(i);
        // From the nearest node downhill, a step to either side on every axis; steps shrink.
        let mut steps = [6.0, 3.0, 5.0, 0.3, 0.3_f32];
        let mut seen = [[0.0; LANES]; 6];
        for _ in 0..40 {
            let mut lanes = leaf.map(|amount| [amount; LANES]);
            for (k, lane) in lanes.iter_mut().enumerate() {
                let most = if k < 4 { MOST[k] } else { STRUCTURE[1] } as f32;
                let low = if k < 4 { 0.0 } else { STRUCTURE[0] as f32 };
                lane[2 * k] = (leaf[k] + steps[k]).min(most);
                lane[2 * k + 1] = (leaf[k] - steps[k]).max(low);
            }
            self.read(&lanes, &mut seen);
            let mut better = None;
            for i in 0..10 {
                let tried = texel(&lanes, i);
                let far = off(tried, &texel(&seen, i));
                if far < least {
                    (least, better) = (far, Some(tried));
                }
            }
            match better {
                Some(tried) => leaf = tried,
                None => steps = steps.map(|step| 0.5 * step),
            }
        }
        leaf
    }
}

#[cfg(test)]
mod tests {
    use super::super::pigment::Amounts;
    use super::super::spectrum::decoded;
    use super::*;
    use crate::seed::{Seed, Stage};
    use palette::color_difference::EuclideanDistance;
    use palette::{FromColor, Lab, Srgb};

    impl Lattice {
        fn at(&self, amounts: [f32; 5]) -> [f32; 6] {
            let mut colours = [[0.0; LANES]; 6];
            self.read(&amounts.map(|amount| [amount; LANES]), &mut colours);
            texel(&colours, LANES - 1)
        }
    }

    #[test]
    fn between_the_nodes_the_lattice_looks_like_the_model() {
        let lab = |[r, g, b]: [f64; 3]| {
            let clip = |v: f64| v.clamp(0.0, 1.0);
            Lab::<palette::white_point::D65, f64>::from_color(Srgb::new(clip(r), clip(g), clip(b)))
        };
        let (lattice, spectrum) = (of(Albedo::Total), Spectrum::new());
        let mut rng = Seed(5).stream(Stage::Tissue);
        let (mut sum, mut worst) = (0.0, 0.0_f64);
        for _ in 0..3000 {
            let state = [
                rng.between(0.0, 75.0),
                rng.between(0.0, 16.0),
                rng.between(0.0, 30.0) * rng.between(0.0, 1.0),
                rng.between(0.0, 2.5) * rng.between(0.0, 1.0),
                rng.between(1.2, 2.8),
            ];
            let seen = spectrum.seen(&Amounts::of(state));
            let found = lattice.at(state.map(|v| v as f32)).map(f64::from);
            let exact: [[f64; 2]; 3] =
                std::array::from_fn(|c| held(seen.total[c], seen.through[c]).map(encoded));
            for way in 0..2 {
                let read: [f64; 3] = std::array::from_fn(|c| found[3 * way + c]);
                let off = lab(read).distance(lab(exact.map(|channel| channel[way])));
                sum += off;
                worst = worst.max(off);
            }
        }
        assert!(sum / 6000.0 < 0.5 && worst < 3.0, "mean {}, worst {worst}", sum / 6000.0);
    }

    #[test]
    fn no_node_sends_back_and_lets_through_more_than_falls_on_it() {
        for node in of(Albedo::Total).nodes.iter() {
            for c in 0..3 {
                let sum = decoded(f64::from(node[c])) + decoded(f64::from(node[c + 3]));
                assert!(sum <= 1.0 + 1e-6, "{node:?}");
            }
        }
    }

    #[test]
    fn the_leaf_of_a_leafs_colour_has_that_colour() {
        let lattice = of(Albedo::Total);
        let mut rng = Seed(8).stream(Stage::Tissue);
        for _ in 0..60 {
            let amounts = [
                rng.between(0.5, 70.0),
                rng.between(0.5, 14.0),
                rng.between(0.0, 20.0),
                rng.between(0.0, 1.0),
                rng.between(1.2, 2.6),
            ];
            let [r, g, b, ..] = lattice.at(amounts.map(|v| v as f32));
            let colour = [r, g, b].map(|v| v.clamp(0.0, 1.0));
            let found = lattice.leaf_of(colour);
            let seen = lattice.at(found);
            for c in 0..3 {
                assert!((seen[c] - colour[c]).abs() < 4.0 / 255.0, "{amounts:?} {found:?}");
            }
        }
    }

    #[test]
    fn amounts_beyond_all_measure_look_like_the_most() {
        let lattice = of(Albedo::Total);
        assert_eq!(lattice.at([1e9, 0.0, 0.0, 1e9, 9.0]), lattice.at([1e9, 0.0, 0.0, 1e9, 3.2]));
    }
}
