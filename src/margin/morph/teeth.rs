//! Teeth of several leaves that answer each other, so that none springs up or vanishes at once.

use super::super::MarginSpec;
use super::super::detail::{Tooth, ToothForm, ToothType};

/// The same number of teeth for every leaf, each with its counterparts in the same place of the
/// lists. Where a leaf has fewer, the missing ones have no width, between those that are there; where
/// it has none, they have no height.
pub(super) fn unified(lists: &[Vec<Tooth>]) -> Vec<Vec<Tooth>> {
    let most = lists.iter().map(Vec::len).max().unwrap_or(0);
    let model = lists.iter().find(|list| list.len() == most).cloned().unwrap_or_default();
    let mut all: Vec<Vec<Tooth>> = lists.iter().map(|list| filled(list, &model)).collect();
    for j in 0..most {
        for flank in 0..2 {
            let small: Vec<Vec<Tooth>> =
                all.iter().map(|list| list[j].flanks[flank].clone()).collect();
            for (list, small) in all.iter_mut().zip(unified(&small)) {
                list[j].flanks[flank] = small;
            }
        }
    }
    all
}

/// A list of teeth with as many as the model has.
fn filled(list: &[Tooth], model: &[Tooth]) -> Vec<Tooth> {
    if list.is_empty() {
        return model.iter().map(flat).collect();
    }
    let matches = matched(list, model);
    let mut filled: Vec<Tooth> = Vec::with_capacity(model.len());
    for (j, tooth) in model.iter().enumerate() {
        if let Some(i) = matches[j] {
            filled.push(list[i].clone());
            continue;
        }
        // Between the last one before it and the first one after it.
        let before = matches[..j].iter().rev().find_map(|m| m.map(|i| list[i].to));
        let after = matches[j..].iter().find_map(|m| m.map(|i| list[i].from));
        let at = before.or(after).unwrap_or(0.5 * (tooth.from + tooth.to));
        filled.push(Tooth { from: at, to: at, ..tooth.clone() });
    }
    filled
}

/// A tooth that does not stand out, nor anything on it.
fn flat(tooth: &Tooth) -> Tooth {
    let flanks = tooth.flanks.clone().map(|small| small.iter().map(flat).collect());
    Tooth { depth: 0.0, flanks, ..tooth.clone() }
}

/// For every tooth of the model the one of the shorter list that answers it: all of these are matched,
/// in order, with the least sum of distances.
fn matched(list: &[Tooth], model: &[Tooth]) -> Vec<Option<usize>> {
    let (n, m) = (list.len(), model.len());
    let centre = |tooth: &Tooth| 0.5 * (tooth.from + tooth.to);
    let far = |i: usize, j: usize| (centre(&list[i]) - centre(&model[j])).abs();
    // cost[i][j]: the first i teeth matched among the first j of the model.
    let mut cost = vec![vec![f64::INFINITY; m + 1]; n + 1];
    cost[0].fill(0.0);
    for i in 1..=n {
        for j in i..=m {
            cost[i][j] = (cost[i - 1][j - 1] + far(i - 1, j - 1)).min(cost[i][j - 1]);
        }
    }
    let mut matches = vec![None; m];
    let (mut i, mut j) = (n, m);
    while i > 0 && j > 0 {
        if cost[i][j] == cost[i][j - 1] {
            j -= 1;
        } else {
            (i, j) = (i - 1, j - 1);
            matches[j] = Some(i);
        }
    }
    matches
}

/// The teeth between unified ones.
pub(super) fn mixed(lists: &[Vec<Tooth>], shares: &[f64]) -> Vec<Tooth> {
    let count = lists.first().map_or(0, Vec::len);
    (0..count)
        .map(|j| {
            let mix = |value: fn(&Tooth) -> f64| -> f64 {
                lists.iter().zip(shares).map(|(list, share)| share * value(&list[j])).sum()
            };
            let flank = |k: usize| {
                let small: Vec<Vec<Tooth>> =
                    lists.iter().map(|list| list[j].flanks[k].clone()).collect();
                mixed(&small, shares)
            };
            let (from, to) = (mix(|t| t.from), mix(|t| t.to));
            Tooth { from, to, depth: mix(|t| t.depth), flanks: [flank(0), flank(1)] }
        })
        .collect()
}

/// The form of every leaf's teeth; one without teeth borrows that of the nearest with some.
pub(super) fn forms(specs: &[MarginSpec]) -> Vec<ToothForm> {
    let toothed = |i: &usize| specs[*i].teeth.r#type != ToothType::None;
    (0..specs.len())
        .map(|i| {
            let near = (0..specs.len()).filter(toothed).min_by_key(|&j| j.abs_diff(i)).unwrap_or(i);
            ToothForm::of(&specs[near].teeth)
        })
        .collect()
}

pub(super) fn mixed_form(forms: &[ToothForm], shares: &[f64]) -> ToothForm {
    let mix = |value: &dyn Fn(&ToothForm) -> f64| -> f64 {
        forms.iter().zip(shares).map(|(form, share)| share * value(form)).sum()
    };
    ToothForm {
        lean: mix(&|f| f.lean),
        tip_rounding: mix(&|f| f.tip_rounding),
        sinus_rounding: mix(&|f| f.sinus_rounding),
        bow: [0, 1].map(|k| mix(&|f| f.bow[k])),
        flexure: [0, 1].map(|k| mix(&|f| f.flexure[k])),
        bristle_mm: mix(&|f| f.bristle_mm),
        gland_mm: mix(&|f| f.gland_mm),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(count: usize) -> Vec<Tooth> {
        let at = |i: usize| i as f64 / count as f64;
        (0..count)
            .map(|i| Tooth { from: at(i), to: at(i + 1), depth: 0.5, flanks: Default::default() })
            .collect()
    }

    #[test]
    fn teeth_without_counterpart_have_no_width_and_leave_no_gap() {
        let all = unified(&[row(3), row(7), row(5)]);
        assert!(all.iter().all(|list| list.len() == 7));
        assert_eq!(all[1], row(7));
        for (list, real) in [(&all[0], 3), (&all[2], 5)] {
            assert_eq!(list.iter().filter(|tooth| tooth.to > tooth.from).count(), real);
            assert!(list.windows(2).all(|pair| pair[0].to == pair[1].from));
        }
        let halfway = mixed(&all[..2], &[0.5, 0.5]);
        assert!(halfway.windows(2).all(|pair| (pair[0].to - pair[1].from).abs() < 1e-12));
        assert_eq!(mixed(&all, &[0.0, 1.0, 0.0]), row(7));
    }

    #[test]
    fn a_leaf_without_teeth_has_flat_ones() {
        let all = unified(&[Vec::new(), row(4)]);
        assert!(all[0].iter().all(|tooth| tooth.depth == 0.0 && tooth.to > tooth.from));
    }
}
