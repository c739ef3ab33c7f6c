//! Veins that leave another on one side keep some room between them.

/// The places nearest to these rising ones (in the sum of squares) that lie `gaps` apart or more, between 0
/// and `most`; where there is no room for that, they share it in proportion. A small change of the places
/// changes them a little.
///
/// Source: with the gaps before each taken off it is an isotonic regression, solved by pooling adjacent
/// violators (Ayer et al., Ann. Math. Stat. 26, 1955). `gaps[i]` is that before place i, the first from 0.
/// Linear time.
pub(super) fn spaced(places: &[f64], gaps: &[f64], most: f64) -> Vec<f64> {
    let need: f64 = gaps.iter().sum();
    let part = if need > most { most / need } else { 1.0 };
    let before: Vec<f64> = gaps
        .iter()
        .scan(0.0, |sum, gap| {
            *sum += gap * part;
            Some(*sum)
        })
        .collect();
    let room = (most - need * part).max(0.0);
    // Mean and count of each pool.
    let mut pools: Vec<(f64, usize)> = Vec::new();
    for (place, taken) in places.iter().zip(&before) {
        let mut pool = (place - taken, 1);
        while let Some(&(mean, count)) = pools.last().filter(|(mean, _)| *mean > pool.0) {
            pools.pop();
            let all = count + pool.1;
            pool = ((mean * count as f64 + pool.0 * pool.1 as f64) / all as f64, all);
        }
        pools.push(pool);
    }
    let means = pools.iter().flat_map(|&(mean, count)| std::iter::repeat_n(mean, count));
    means.zip(&before).map(|(mean, taken)| mean.clamp(0.0, room) + taken).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Seed, Stage};

    #[test]
    fn places_that_have_room_stay() {
        let places = [0.1, 0.3, 0.35, 0.9];
        for (a, b) in spaced(&places, &[0.05; 4], 1.0).iter().zip(places) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn crowded_places_get_room_and_follow_smoothly() {
        let mut rng = Seed(3).stream(Stage::Guides);
        for _ in 0..300 {
            let n = 1 + (rng.bits() % 12) as usize;
            let mut places: Vec<f64> = (0..n).map(|_| rng.between(0.0, 1.0).powi(3)).collect();
            places.sort_by(f64::total_cmp);
            let gaps: Vec<f64> = (0..n).map(|_| rng.between(0.0, 0.1)).collect();
            let part = (0.97 / gaps.iter().sum::<f64>()).min(1.0);
            let now = spaced(&places, &gaps, 0.97);
            let mut last = 0.0;
            for (place, gap) in now.iter().zip(&gaps) {
                assert!(*place >= last + part * gap - 1e-9, "{now:?} of {places:?}");
                last = *place;
            }
            assert!(last <= 0.97 + 1e-9);
            let moved: Vec<f64> = places.iter().map(|p| p + 1e-3).collect();
            for (a, b) in now.iter().zip(spaced(&moved, &gaps, 0.97)) {
                assert!((a - b).abs() <= 1e-3 + 1e-9);
            }
        }
    }
}
