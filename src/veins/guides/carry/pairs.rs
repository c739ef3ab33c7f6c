//! Which guides of two leaves answer each other.

use std::collections::BTreeMap;

use super::laid::{Group, Laid};
use crate::geometry::alignment;

/// A vein of the first leaf, of the last, or of both.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    /// Its number in each leaf.
    pub(super) of: [Option<usize>; 2],
    /// The pair that it leaves.
    pub(super) parent: Option<usize>,
    /// Where a leaf that has it not would have it: the shares of the parent between which it lies in
    /// the leaf that has it, and those in the other.
    pub(super) gap: [[f64; 2]; 2],
    /// The same for measures of the margin; `None` between ends of the margin's side.
    pub(super) ends: Option<[[f64; 2]; 2]>,
}

/// All veins of both leaves, parents first. Those that leave answering veins on one side answer each other
/// in order: as many as can, the nearest.
pub(super) fn pairs(first: &[Laid], last: &[Laid], measures: [&[f64]; 2]) -> Vec<Pair> {
    let leaves = [first, last];
    let whole = [[0.0, 1.0]; 2];
    let mut pairs = vec![Pair { of: [Some(0), Some(0)], parent: None, gap: whole, ends: None }];
    let mut next = 0;
    while next < pairs.len() {
        let families = [0, 1].map(|k| family(leaves[k], pairs[next].of[k], measures[k]));
        let mut groups: Vec<Group> =
            families.iter().flat_map(|family| family.keys().copied()).collect();
        groups.sort_unstable();
        groups.dedup();
        for group in groups {
            let rows = families.each_ref().map(|f| f.get(&group).cloned().unwrap_or_default());
            pairs.extend(matched(leaves, measures, [&rows[0], &rows[1]], group, next));
        }
        next += 1;
    }
    pairs
}

/// The veins that leave one, by group, each from its base up.
fn family(leaf: &[Laid], parent: Option<usize>, measures: &[f64]) -> BTreeMap<Group, Vec<usize>> {
    let mut groups: BTreeMap<Group, Vec<usize>> = BTreeMap::new();
    let Some(parent) = parent else { return groups };
    for (i, vein) in leaf.iter().enumerate() {
        if vein.parent.is_some_and(|(of, _)| of == parent) {
            groups.entry(vein.group).or_default().push(i);
        }
    }
    // Of those that leave one place the lowest is the one that comes to the margin nearest to the base.
    let key = |i: &usize| ((share(leaf, *i) * SAME).round(), measures[*i]);
    for row in groups.values_mut() {
        row.sort_by(|i, j| key(i).partial_cmp(&key(j)).expect("finite"));
    }
    groups
}

/// Places on a vein nearer than a part of this are one.
const SAME: f64 = 200.0;

fn share(leaf: &[Laid], i: usize) -> f64 {
    leaf[i].parent.map_or(0.0, |(_, share)| share)
}

/// What a pair gains whose places are the whole vein and the whole margin apart is still above 0, so that
/// no vein is left alone that could have another.
const APART: f64 = 0.9;

/// Two rows of veins that leave one pair put together, with the gaps in which lie those without
/// counterpart.
fn matched(
    leaves: [&[Laid]; 2],
    measures: [&[f64]; 2],
    rows: [&[usize]; 2],
    group: Group,
    parent: usize,
) -> Vec<Pair> {
    let at = |k: usize, i: usize| share(leaves[k], rows[k][i]);
    let end = |k: usize, i: usize| measures[k][rows[k][i]];
    let gain = |i: usize, j: usize| {
        let ends = if group.is_main() { (end(0, i) - end(1, j)).abs() } else { 0.0 };
        2.0 - APART * ((at(0, i) - at(1, j)).abs() + ends)
    };
    let partners = alignment::in_order(rows[0].len(), rows[1].len(), gain);
    let mut made = Vec::new();
    let mut low: Option<[usize; 2]> = None;
    let mut done = [0; 2];
    let mut anchors: Vec<[usize; 2]> =
        partners.iter().enumerate().filter_map(|(i, j)| Some([i, (*j)?])).collect();
    let last = [rows[0].len(), rows[1].len()];
    anchors.push(last);
    for anchor in anchors {
        let high = (anchor != last).then_some(anchor);
        let gap =
            [0, 1].map(|k| [low.map_or(0.0, |i| at(k, i[k])), high.map_or(1.0, |i| at(k, i[k]))]);
        let ends =
            low.zip(high).map(|(low, high)| [0, 1].map(|k| [end(k, low[k]), end(k, high[k])]));
        let mut add = |of| made.push(Pair { of, parent: Some(parent), gap, ends });
        rows[0][done[0]..anchor[0]].iter().for_each(|&v| add([Some(v), None]));
        rows[1][done[1]..anchor[1]].iter().for_each(|&v| add([None, Some(v)]));
        if high.is_some() {
            add([Some(rows[0][anchor[0]]), Some(rows[1][anchor[1]])]);
        }
        low = high;
        done = anchor.map(|i| i + 1);
    }
    made
}
