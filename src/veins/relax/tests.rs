use glam::DVec2;

use super::*;
use crate::margin::MarginSpec;
use crate::veins::Rank;
use crate::veins::graph::VeinKind;

fn margin() -> Margin {
    crate::margin::build(&MarginSpec::default(), crate::seed::Seed(1)).expect("the default margin")
}

fn relaxing(sweeps: u64) -> VeinSpec {
    VeinSpec { relaxation: sweeps, ..VeinSpec::default() }
}

fn stepping() -> VeinSpec {
    VeinSpec { node_step_mm: 0.3, ..VeinSpec::default() }
}

/// A T: two ends opposite of each other and a stem, equally wide, with a node along each.
fn tee() -> VeinGraph {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::new(0.0, 20.0));
    let along = graph.sprout(root, DVec2::new(0.0, 24.0));
    let fork = graph.sprout(along, DVec2::new(0.0, 30.0));
    for side in [-1.0, 1.0] {
        let along = graph.sprout(fork, DVec2::new(side * 3.0, 30.0));
        let end = graph.sprout(along, DVec2::new(side * 6.0, 30.0));
        // Ends of guided veins stay.
        graph.set_rank(end, Rank { order: 3, kind: VeinKind::Tertiary });
    }
    graph
}

#[test]
fn a_veinlet_goes_along_whole() {
    let mut graph = VeinGraph::new();
    let root = graph.add_root(DVec2::new(0.0, 20.0));
    let fork = graph.sprout(root, DVec2::new(0.0, 24.0));
    let end = graph.sprout(fork, DVec2::new(0.0, 28.0));
    graph.set_rank(end, Rank { order: 3, kind: VeinKind::Tertiary });
    let tip = graph.sprout(fork, DVec2::new(1.0, 24.0));
    let places = Relaxation::new(&graph, &[1.0; 4], margin().lines(), &stepping()).run(20, || ());
    let [fork, tip] = [fork, tip].map(|node| places[node as usize]);
    assert!(fork.x > 0.1, "pulled towards the veinlet: {fork}");
    assert!((tip - fork).distance(DVec2::X) < 1e-9, "{fork} {tip}");
}

/// Four triangles of one square around a hub that is off the middle; its corners stay.
fn pane(hub: DVec2) -> VeinGraph {
    let mut graph = VeinGraph::new();
    let corner = |x: f64, y: f64| DVec2::new(x, 30.0 + y);
    let ends = [corner(-4.0, -4.0), corner(4.0, -4.0), corner(4.0, 4.0), corner(-4.0, 4.0)];
    let mut nodes = vec![graph.add_root(ends[0])];
    for end in &ends[1..] {
        nodes.push(graph.sprout(nodes[nodes.len() - 1], *end));
    }
    let middle = graph.sprout(nodes[0], hub);
    for &node in &nodes[1..] {
        graph.join(node, middle);
    }
    graph.join(nodes[3], nodes[0]);
    for node in nodes {
        graph.set_rank(node, Rank { order: 1, kind: VeinKind::Primary });
    }
    graph
}

#[test]
fn small_faces_press_and_large_ones_give_way() {
    let push = |hub: DVec2| {
        let graph = pane(hub);
        let chains = Chains::of(&graph);
        let net = Net::new(&graph, &chains, &vec![1.0; chains.chains.len()]);
        let mut faces = Faces::of(&net);
        faces.measure(&net);
        faces.push(&net, net.number(4))
    };
    let off = push(DVec2::new(2.5, 30.0));
    assert!(off.x < 0.0 && off.y.abs() < 1e-12, "{off}");
    // In the middle all are alike.
    assert!(push(DVec2::new(0.0, 30.0)).length() < 1e-12);
}

#[test]
fn equal_veins_meet_at_120_degrees() {
    let graph = tee();
    let mut relaxation = Relaxation::new(&graph, &[1.0; 7], margin().lines(), &stepping());
    relaxation.room.margin = SegmentIndex::new(Vec::new());
    let positions = relaxation.run(400, || ());
    let hub = positions[2];
    let angle = (positions[6] - hub).angle_to(positions[4] - hub).to_degrees().abs();
    assert!((angle - 120.0).abs() < 0.1, "{angle} at {hub}");
    // The node between has followed and makes no kink.
    let (a, b) = (positions[5] - hub, positions[6] - positions[5]);
    assert!(a.angle_to(b).abs() < 1e-6, "{positions:?}");
    assert_eq!([0, 4, 6].map(|i| positions[i]), [0, 4, 6].map(|i| graph.positions()[i]));
}

#[test]
fn a_wide_vein_holds_its_course() {
    let graph = tee();
    let widths = [0.1, 0.1, 1.0, 1.0, 1.0, 1.0, 1.0];
    let mut widths = widths.to_vec();
    widths[2] = 0.1;
    let positions = Relaxation::new(&graph, &widths, margin().lines(), &stepping()).run(5, || ());
    assert!(positions[2].distance(graph.positions()[2]) < 0.6, "{}", positions[2]);
}

#[test]
fn roots_and_guided_veins_of_the_first_order_stay() {
    let mut graph = tee();
    for node in 0..3 {
        graph.set_rank(node, Rank { order: 1, kind: VeinKind::Primary });
    }
    assert_eq!(relaxed(&relaxing(5), &margin(), graph.clone(), || ()), graph);
    assert_eq!(relaxed(&relaxing(0), &margin(), tee(), || ()), tee());
}

#[test]
fn a_vein_in_the_way_stops_a_junction() {
    let mut graph = tee();
    let free = relaxed(&relaxing(60), &margin(), graph.clone(), || ()).positions()[2];
    assert!(free.y < 29.0, "{free}");
    // A bar across the way, hung up on the left.
    let far = graph.sprout(0, DVec2::new(-8.0, 20.5));
    let up = graph.sprout(far, DVec2::new(-8.0, 29.6));
    graph.sprout(up, DVec2::new(-0.05, 29.6));
    let stopped = relaxed(&relaxing(60), &margin(), graph, || ()).positions()[2];
    assert!(stopped.y > 29.5, "{stopped}");
}
