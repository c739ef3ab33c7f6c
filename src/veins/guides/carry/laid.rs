//! The guides of one leaf as veins on veins.

use glam::DVec2;

use super::super::aside::TIP;
use super::super::curve;
use super::super::planter::Planter;
use crate::veins::graph::{NodeId, Rank, VeinKind};

/// A vein that was laid, in lengths of the blade.
#[derive(Debug, Clone)]
pub(super) struct Laid {
    pub(super) rank: Rank,
    /// The vein it leaves, and at which share of that one; `None` for the one that leads to the apex.
    pub(super) parent: Option<(usize, f64)>,
    pub(super) line: Vec<DVec2>,
    /// The vein its end was joined to, and at which share of that one.
    pub(super) joined: Option<(usize, f64)>,
    pub(super) group: Group,
}

/// Only veins of one group can answer each other, on veins that do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Group {
    left: bool,
    kind: u8,
}

impl Group {
    /// On which side of its parent a vein leaves it.
    pub(super) fn is_left(self) -> bool {
        self.left
    }

    /// Primaries beside the midrib and secondaries are one: in one leaf a lobe has one, in another the other.
    pub(super) fn is_main(self) -> bool {
        self.kind == 0
    }
}

/// What was laid, parents first; the first is the midrib, or the vein nearest to one.
pub(super) fn laid(planter: &Planter<'_>) -> Vec<Laid> {
    let length = planter.ground.length();
    let positions = planter.graph.positions();
    let place = |node: &NodeId| positions[*node as usize] / length;
    // By node, the vein that laid it and the place in its row.
    let mut owners: Vec<Option<(usize, usize)>> = vec![None; positions.len()];
    for (i, record) in planter.records.iter().enumerate() {
        for (k, &node) in record.nodes.iter().enumerate().skip(1) {
            owners[node as usize] = Some((i, k));
        }
    }
    let share = |node: NodeId| {
        owners[node as usize]
            .map(|(i, k)| (i, k as f64 / (planter.records[i].nodes.len() - 1) as f64))
    };
    let lines: Vec<Vec<DVec2>> =
        planter.records.iter().map(|record| record.nodes.iter().map(place).collect()).collect();
    let Some(trunk) = trunk(planter, &lines) else { return Vec::new() };
    let mut all: Vec<Laid> = planter
        .records
        .iter()
        .zip(&lines)
        .enumerate()
        .map(|(i, (record, line))| Laid {
            rank: record.rank,
            parent: match share(record.nodes[0]) {
                Some(parent) => Some(parent),
                None => (i != trunk).then_some((trunk, 0.0)),
            },
            line: line.clone(),
            joined: record.joined.and_then(share),
            group: Group { left: false, kind: 0 },
        })
        .collect();
    for i in 0..all.len() {
        all[i].group = group(&all, i);
    }
    let free = FREE * planter.step / length;
    for i in 0..all.len() {
        if let Some((parent, _)) = all[i].parent {
            all[i].line = off(&all[i].line, &all[parent].line, free);
        }
    }
    trunk_first(all, trunk)
}

/// A vein runs straight until it is so many steps off the one it leaves.
const FREE: f64 = 3.0;

/// At most this share of a vein is made straight.
const STRAIGHT: f64 = 0.3;

/// A line without the stretch on which it clings to its parent: on another blade it would run across that.
fn off(line: &[DVec2], parent: &[DVec2], free: f64) -> Vec<DVec2> {
    let near =
        |p: &DVec2| curve::nearest(parent, *p).is_some_and(|(foot, _)| foot.distance(*p) < free);
    let most = (line.len() as f64 * STRAIGHT) as usize;
    let clings = line[1..].iter().take(most).take_while(|p| near(p)).count();
    let mut freed = vec![line[0]];
    freed.extend(&line[1 + clings..]);
    freed
}

/// Of the veins out of the base the one that leads to the apex.
fn trunk(planter: &Planter<'_>, lines: &[Vec<DVec2>]) -> Option<usize> {
    let is_root = |i: &usize| planter.graph.parent(planter.records[*i].nodes[0]).is_none();
    let aside = |i: &usize| {
        let to = lines[*i][lines[*i].len() - 1] - lines[*i][0];
        to.angle_to(DVec2::Y).abs()
    };
    // A midrib is laid before all others.
    let roots = || (0..lines.len()).filter(is_root);
    let first = roots().next()?;
    let leads = lines[first][lines[first].len() - 1].y > 0.8;
    if leads { Some(first) } else { roots().min_by(|i, j| aside(i).total_cmp(&aside(j))) }
}

fn group(all: &[Laid], i: usize) -> Group {
    let vein = &all[i];
    let left = vein.parent.is_some_and(|(parent, share)| {
        let (_, ahead) = curve::at(&all[parent].line, share);
        let (out, _) = curve::at(&vein.line, 0.25);
        ahead.perp_dot(out - vein.line[0]) > 0.0
    });
    let kind = match vein.rank.kind {
        VeinKind::Primary => 0,
        // An arch leaves the end of a secondary.
        VeinKind::Secondary if vein.parent.is_some_and(|(_, share)| share > TIP) => 1,
        VeinKind::Secondary => 0,
        VeinKind::Intersecondary => 2,
        VeinKind::Exterior => 3,
        VeinKind::Intramarginal => 4,
        VeinKind::Marginal => 5,
        VeinKind::Tertiary | VeinKind::Minor => 6,
    };
    Group { left, kind }
}

/// The same with the trunk in the first place, for what is told apart by it comes after it.
fn trunk_first(mut all: Vec<Laid>, trunk: usize) -> Vec<Laid> {
    let moved = |i: usize| match i.cmp(&trunk) {
        std::cmp::Ordering::Less => i + 1,
        std::cmp::Ordering::Equal => 0,
        std::cmp::Ordering::Greater => i,
    };
    all[..=trunk].rotate_right(1);
    for vein in &mut all {
        vein.parent = vein.parent.map(|(i, share)| (moved(i), share));
        vein.joined = vein.joined.map(|(i, share)| (moved(i), share));
    }
    all
}
