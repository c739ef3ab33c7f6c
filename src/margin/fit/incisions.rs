//! Where a side of a blade is incised: the pockets of its convex hull, and the pockets in these.

use glam::DVec2;

/// A place where the margin comes nearer to the inside than its neighbours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::margin) struct Incision {
    /// Index of the deepest point.
    pub(in crate::margin) at: usize,
    /// How far inside the line over the pocket it lies.
    pub(in crate::margin) depth: f64,
}

/// The incisions of a line from base to apex whose outside is on the right hand, the deepest first;
/// those shallower than `least` are left away.
pub(in crate::margin) fn incisions(line: &[DVec2], least: f64) -> Vec<Incision> {
    let mut found = Vec::new();
    let mut open = vec![(0, line.len() - 1)];
    while let Some((first, last)) = open.pop() {
        for edge in outer_hull(line, first, last).windows(2) {
            let (a, b) = (edge[0], edge[1]);
            let along = (line[b] - line[a]).normalize_or_zero();
            let depth = |i: usize| along.perp_dot(line[i] - line[a]);
            let deepest = (a + 1..b).max_by(|&i, &j| depth(i).total_cmp(&depth(j)));
            let Some(at) = deepest.filter(|&i| depth(i) >= least) else { continue };
            found.push(Incision { at, depth: depth(at) });
            open.extend([(a, at), (at, b)]);
        }
    }
    found.sort_by(|a, b| b.depth.total_cmp(&a.depth).then(a.at.cmp(&b.at)));
    found
}

/// The vertices of the hull on the right of the line, from `first` to `last`.
fn outer_hull(line: &[DVec2], first: usize, last: usize) -> Vec<usize> {
    let mut hull: Vec<usize> = Vec::new();
    for i in first..=last {
        while let [.., a, b] = hull[..]
            && (line[b] - line[a]).perp_dot(line[i] - line[b]) <= 0.0
        {
            hull.pop();
        }
        hull.push(i);
    }
    hull
}
