//! Networks with known answers.

use glam::DVec2;

use super::areoles::Areoles;
use super::distances::Distances;
use super::junctions::{Junction, junctions};
use super::measures::Unit;
use super::nesting::Nesting;
use super::rows::Architecture;
use super::strahler::strahler;
use super::topology::Topology;
use super::{Measures, Network, Segment, picture};
use crate::raster::Grid;
use crate::seed::{Seed, Stage};
use crate::veins::VeinGraph;

fn network(nodes: &[DVec2], edges: &[[usize; 2]], outline: &[DVec2]) -> Network {
    let segment = |&ends: &[usize; 2]| Segment::new(ends, ends.map(|i| nodes[i]).to_vec(), 0.1, 1);
    Network::new(nodes, &edges.iter().map(segment).collect::<Vec<_>>(), &[], outline)
}

/// `columns` × `rows` squares of side 1, in a blade of just that size.
fn squares(columns: usize, rows: usize) -> Network {
    let at = |x: usize, y: usize| y * (columns + 1) + x;
    let (mut nodes, mut edges) = (Vec::new(), Vec::new());
    for y in 0..=rows {
        for x in 0..=columns {
            nodes.push(DVec2::new(x as f64, y as f64));
            if x > 0 {
                edges.push([at(x - 1, y), at(x, y)]);
            }
            if y > 0 {
                edges.push([at(x, y - 1), at(x, y)]);
            }
        }
    }
    let (w, h) = (columns as f64, rows as f64);
    network(&nodes, &edges, &[(0.0, 0.0), (w, 0.0), (w, h), (0.0, h)].map(DVec2::from))
}

/// Regular hexagons of side 1, `side` by `side`.
fn honeycomb(side: i32) -> Network {
    let root3 = 3f64.sqrt();
    let (mut nodes, mut edges): (Vec<DVec2>, Vec<[usize; 2]>) = Default::default();
    for row in 0..side {
        for column in 0..side {
            let centre = DVec2::new(
                root3 * (f64::from(column) + f64::from(row % 2) / 2.0),
                1.5 * f64::from(row),
            );
            let corners: [usize; 6] = std::array::from_fn(|k| {
                let angle = (30.0 + 60.0 * k as f64).to_radians();
                let p = centre + DVec2::from_angle(angle);
                nodes.iter().position(|q| q.distance(p) < 1e-6).unwrap_or_else(|| {
                    nodes.push(p);
                    nodes.len() - 1
                })
            });
            for k in 0..6 {
                let (a, b) = (corners[k], corners[(k + 1) % 6]);
                let edge = [a.min(b), a.max(b)];
                if !edges.contains(&edge) {
                    edges.push(edge);
                }
            }
        }
    }
    network(&nodes, &edges, &[])
}

fn close(a: f64, b: f64, by: f64) -> bool {
    (a - b).abs() <= by
}

#[test]
fn a_grid_of_squares_has_square_areoles() {
    let grid = squares(10, 10);
    let topology = Topology::of(&grid);
    // The four corners have degree 2 and are merged.
    assert_eq!((topology.nodes, topology.segments), (117, 216));
    assert_eq!((topology.loops(), topology.degree_3, topology.degree_4), (100, 36, 81));
    assert!(close(topology.meshedness().unwrap(), 100.0 / 229.0, 1e-12));
    let areoles = Areoles::of(&grid).list;
    assert_eq!(areoles.len(), 100);
    for areole in &areoles {
        assert!(close(areole.area, 1.0, 1e-12) && close(areole.perimeter, 4.0, 1e-12));
        assert!(close(areole.elongation, 1.0, 1e-9));
        assert!(close(areole.circularity(), std::f64::consts::FRAC_PI_4, 1e-12));
        assert!((3..=4).contains(&areole.segments) && areole.free_ends == 0);
    }
    let measures = Measures::of(&grid, Unit::Millimetre);
    let value = |key: &str| measures.all().find(|(_, m)| m.key == key).unwrap().1.value.unwrap();
    assert!(close(value("loop_index"), 100.0 * 100.0 / (220.0 * 220.0), 1e-12));
    assert!(close(value("vla"), 2.2, 1e-12));
    assert!(close(value("areole_ln_area_sd"), 0.0, 1e-9));
    // T-junctions at the rim only.
    assert!(close(value("angle_smallest_median"), 90.0, 1e-9));
    assert!(close(value("angle_largest_median"), 180.0, 1e-9));
    assert!(close(value("imbalance_median"), 1.0 / 3.0, 1e-12));
}

#[test]
fn tissue_in_squares_is_a_sixth_of_their_side_from_a_vein() {
    let distances = Distances::of(&squares(8, 12), 96).unwrap();
    assert!(close(distances.mean, 1.0 / 6.0, 0.002), "{distances:?}");
    // A share 1 − (1 − 2d)² lies nearer than d.
    assert!(close(distances.median, (1.0 - 0.5f64.sqrt()) / 2.0, 0.003), "{distances:?}");
    assert!(close(distances.inradius_mean.unwrap(), 0.5, 0.04), "{distances:?}");
}

#[test]
fn veins_side_by_side_leave_a_quarter_of_their_spacing() {
    let nodes: Vec<DVec2> =
        (0..10).flat_map(|i| [0.0, 20.0].map(|y| DVec2::new(f64::from(i) + 0.5, y))).collect();
    let edges: Vec<[usize; 2]> = (0..10).map(|i| [2 * i, 2 * i + 1]).collect();
    let outline = [(0.0, 0.0), (10.0, 0.0), (10.0, 20.0), (0.0, 20.0)].map(DVec2::from);
    let network = network(&nodes, &edges, &outline);
    let distances = Distances::of(&network, 0).unwrap();
    // Lines along the sides of pixels are the worst case of the grid.
    assert!(close(distances.mean * network.length() / 200.0, 0.25, 0.003), "{distances:?}");
    assert_eq!(distances.inradius_mean, None);
}

#[test]
fn a_honeycomb_is_in_balance() {
    let comb = honeycomb(9);
    assert_eq!(Topology::of(&comb).loops(), 81);
    let areoles = Areoles::of(&comb).list;
    assert_eq!(areoles.len(), 81);
    let hexagon = 1.5 * 3f64.sqrt();
    for areole in &areoles {
        assert!(close(areole.area, hexagon, 1e-9) && close(areole.elongation, 1.0, 1e-6));
        assert!(close(areole.circularity(), std::f64::consts::PI * 3f64.sqrt() / 6.0, 1e-9));
    }
    let straight = junctions(&comb);
    // Merged rim segments bend, and so do their chords: look at the inner junctions.
    let even = straight.iter().filter(|j| j.imbalance(1.0) < 1e-9).count();
    assert!(even > straight.len() / 2, "{even} of {}", straight.len());
    let inner = straight.iter().find(|j| j.imbalance(1.0) < 1e-9).unwrap();
    assert!(inner.angles().iter().all(|&angle| close(angle, 120.0, 1e-9)));
    // The drawn hull holds all of it and little more.
    let area = comb.blade_area();
    assert!((81.0 * hexagon..1.15 * 81.0 * hexagon).contains(&area), "{area}");
}

#[test]
fn a_free_ending_splits_the_boundary_but_is_no_part_of_it() {
    let outline = [(0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (0.0, 1.0)].map(DVec2::from);
    let mut nodes = outline.to_vec();
    nodes.extend([DVec2::new(2.0, 0.0), DVec2::new(2.0, 0.5), DVec2::new(2.3, 0.7)]);
    nodes.extend([DVec2::new(1.7, 0.7), DVec2::new(5.0, 0.0)]);
    let edges = [[0, 4], [4, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [5, 7], [1, 8]];
    let network = network(&nodes, &edges, &outline);
    let areoles = Areoles::of(&network).list;
    assert_eq!(areoles.len(), 1);
    let areole = &areoles[0];
    assert_eq!((areole.free_ends, areole.segments), (2, 2));
    assert!(close(areole.area, 4.0, 1e-12) && close(areole.perimeter, 10.0, 1e-12));
    assert!(close(areole.elongation, 4.0, 1e-9));
    assert!(areole.centroid.distance(DVec2::new(2.0, 0.5)) < 1e-12);
    assert_eq!(Topology::of(&network).free_ends, 3);
}

/// Every vein forks in two `depth` times.
fn forking_tree(depth: u32) -> (VeinGraph, Vec<f64>) {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::new(0.0, -1.0));
    let mut radii = vec![1.0];
    let mut tips = vec![graph.sprout(root, DVec2::ZERO)];
    radii.push(1.0);
    for level in 1..=depth {
        let spread = 0.5f64.powi(level as i32);
        let mut next = Vec::new();
        for &tip in &tips {
            let from = graph.positions()[tip as usize];
            for side in [-1.0, 1.0] {
                next.push(graph.sprout(tip, from + DVec2::new(side * spread, 1.0)));
                radii.push(libm::pow(2.0, -f64::from(level) / 3.0));
            }
        }
        tips = next;
    }
    (graph, radii)
}

#[test]
fn a_forking_tree_has_no_loops_and_halves_its_streams() {
    let (graph, radii) = forking_tree(5);
    let network = Network::of_graph(&graph, &radii, &vec![1; graph.len()], &[]);
    let topology = Topology::of(&network);
    assert_eq!((topology.loops(), topology.free_ends, topology.junctions), (0, 32, 31));
    assert!(close(topology.spanning_length, network.length(), 1e-9));
    assert!(Areoles::of(&network).list.is_empty());
    assert_eq!(Distances::of(&network, 0).unwrap().inradius_mean, None);
    let table = strahler(&network);
    let streams: Vec<usize> = table.iter().map(|order| order.streams).collect();
    assert_eq!(streams, [32, 16, 8, 4, 2, 1]);
    let ratio = table[1].width / table[0].width;
    assert!(close(ratio, libm::cbrt(2.0), 1e-9));
    let junctions = junctions(&network);
    assert_eq!(junctions.len(), 31);
    assert!(junctions.iter().all(|j| close(j.murray_exponent(), 3.0, 1e-6)));
    let measures = Measures::of(&network, Unit::Millimetre);
    assert_eq!(measures.architecture, Architecture::Dichotomous);
    let row = |number: u32| measures.rows.iter().find(|row| row.number == number).unwrap();
    assert!(row(1).is_inside() && row(2).is_inside(), "no loops, all of it a tree");
    let netted = Measures::by(&network, Unit::Millimetre, Some(Architecture::Reticulate));
    assert!(netted.rows.iter().all(|row| row.number != 1 || !row.is_inside()));
}

#[test]
fn an_exponent_of_equal_widths_is_infinite() {
    let junction = Junction { widths: [2.0, 2.0, 1.0], directions: [DVec2::X; 3] };
    assert_eq!(junction.murray_exponent(), f64::INFINITY);
    assert_eq!(junction.area_ratio(), 1.25);
    assert_eq!(junction.imbalance(1.0), 1.0);
}

#[test]
fn nested_loops_tell_from_a_row_of_loops() {
    let row = squares(4, 1);
    let areoles = Areoles::of(&row);
    assert_eq!(areoles.list.len(), 4);
    let widths = |of: [f64; 3]| -> Vec<f64> {
        let divider = |s: &Segment| {
            let upright = s.path.iter().all(|p| p.x == s.path[0].x) && s.path.len() == 2;
            let x = s.path[0].x as usize;
            if upright && (1..=3).contains(&x) { of[x - 1] } else { 9.0 }
        };
        row.segments().iter().map(divider).collect()
    };
    let nested = Nesting::of(&areoles, &widths([1.0, 3.0, 2.0])).unwrap();
    assert_eq!((nested.plain, nested.weighted), (1.0, 1.0));
    let in_turn = Nesting::of(&areoles, &widths([1.0, 2.0, 3.0])).unwrap();
    assert!(close(in_turn.plain, (1.0 + 0.5 + 1.0 / 3.0) / 3.0, 1e-12));
    assert!(close(in_turn.weighted, (1.0 + 2.0 * 0.5 + 3.0 / 3.0) / 6.0, 1e-12));
}

/// A forest on a lattice, joined at random between neighbours: planar.
fn random_graph(seed: u64) -> VeinGraph {
    let mut rng = Seed(seed).stream(Stage::Shuffle);
    let side = 12;
    let mut graph = VeinGraph::new();
    let mut id = vec![None; side * side];
    let mut joins = Vec::new();
    for i in 0..side * side {
        let place = DVec2::new((i % side) as f64, (i / side) as f64)
            + DVec2::new(rng.unit(), rng.unit()) * 0.2;
        let left = (i % side > 0).then(|| id[i - 1]).flatten();
        let below = (i >= side).then(|| id[i - side]).flatten();
        let node = match (left, below) {
            _ if rng.unit() < 0.15 => continue,
            (Some(left), below) if rng.unit() < 0.6 => {
                if let Some(below) = below.filter(|_| rng.unit() < 0.7) {
                    joins.push((graph.len() as u32, below));
                }
                graph.sprout(left, place)
            }
            (_, Some(below)) if rng.unit() < 0.9 => graph.sprout(below, place),
            _ => graph.add_root(place),
        };
        id[i] = Some(node);
    }
    joins.into_iter().for_each(|(a, b)| graph.join(a, b));
    graph
}

#[test]
fn areoles_are_joins_less_roots_plus_parts() {
    for seed in 0..40 {
        let graph = random_graph(seed);
        assert_eq!(graph.check(), None);
        let roots = (0..graph.len() as u32).filter(|&n| graph.parent(n).is_none()).count();
        let mut part: Vec<usize> = (0..graph.len()).collect();
        let edges: Vec<(u32, u32)> = graph.edges().chain(graph.joins().iter().copied()).collect();
        for _ in 0..graph.len() {
            for &(a, b) in &edges {
                let least = part[a as usize].min(part[b as usize]);
                (part[a as usize], part[b as usize]) = (least, least);
            }
        }
        let parts = (0..graph.len()).filter(|&node| part[node] == node).count();
        let ones = vec![1.0; graph.len()];
        let outline = [(-1.0, -1.0), (13.0, -1.0), (13.0, 13.0)].map(DVec2::from);
        let network = Network::of_graph(&graph, &ones, &vec![1; graph.len()], &outline);
        let expected = graph.joins().len() + parts - roots;
        assert_eq!(Areoles::of(&network).list.len(), expected, "seed {seed}");
        assert_eq!(Topology::of(&network).loops(), expected, "seed {seed}");
    }
}

#[test]
fn a_ring_is_one_segment_and_one_areole() {
    let nodes: Vec<DVec2> =
        (0..6).map(|k| DVec2::from_angle(f64::from(k).to_radians() * 60.0)).collect();
    let edges: Vec<[usize; 2]> = (0..6).map(|k| [k, (k + 1) % 6]).collect();
    let network = network(&nodes, &edges, &[]);
    assert_eq!((network.nodes().len(), network.segments().len()), (1, 1));
    assert!(close(network.length(), 6.0, 1e-9));
    assert_eq!(Areoles::of(&network).list.len(), 1);
}

#[test]
fn a_picture_of_a_grid_is_a_grid() {
    // Squares of 30 px, veins 7 px wide; a bump, a pinhole and a speck that mean nothing.
    let size = 6 * 30 + 21;
    let mut veins = Grid::filled(size, size, false);
    for y in 0..size {
        for x in 0..size {
            let within = |v: usize| (7..7 + 6 * 30 + 7).contains(&v);
            let on = |v: usize| (v + 30 - 7) % 30 < 7;
            veins[(x, y)] = within(x) && within(y) && (on(x) || on(y));
        }
    }
    veins[(24, 14)] = true;
    veins[(10, 20)] = false;
    veins[(2, 2)] = true;
    let network = picture::network(veins, 0.5);
    let topology = Topology::of(&network);
    assert_eq!((topology.loops(), topology.free_ends, topology.parts), (36, 0, 1));
    let areoles = Areoles::of(&network).list;
    assert_eq!(areoles.len(), 36);
    assert!(areoles.iter().all(|a| close(a.area, 225.0, 25.0)), "{:?}", areoles[0]);
    assert!(network.segments().iter().all(|s| close(s.width, 3.75, 0.5)));
    assert!(close(network.length(), 14.0 * 6.0 * 15.0, 40.0), "{}", network.length());
}

#[test]
fn an_empty_picture_is_an_empty_network() {
    let network = picture::network(Grid::filled(9, 9, false), 1.0);
    assert!(network.segments().is_empty());
    assert_eq!(Measures::of(&network, Unit::Pixel).rows_inside(), 0);
    let full = picture::network(Grid::filled(9, 9, true), 1.0);
    let _ = Measures::of(&full, Unit::Pixel);
}
