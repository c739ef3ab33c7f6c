//! A season at a pace that a film can follow.
//!
//! The course of the pigments is given; how fast it is gone through is not. Where a colour would leap, as
//! when the first brown comes into a bright leaf, more of the season is spent.

/// A colour may change by so much (0–1 for black to white) from the one end of the season to the other if it
/// changes evenly: at 60 pictures 4.8 steps of 8 bits from one to the next, which leaves room for places that
/// are ahead of the others.
pub(super) const FASTEST: f32 = 4.8 / 255.0 * 59.0;

/// Where on the course (0–1) evenly spaced times of the season are, the first and the last at its ends.
/// `changes` says how far colours go over each of as many equal pieces of the course less one.
pub(super) fn paced(changes: &[f32], fastest: f32) -> Vec<f32> {
    let piece = 1.0 / changes.len() as f32;
    // When each piece begins, and the last ends.
    let mut times = vec![0.0];
    let mut time = 0.0;
    for change in changes {
        time += piece.max(change / fastest);
        times.push(time);
    }
    let mut k = 0;
    let place = |i: usize| {
        let wanted = time * i as f32 / changes.len() as f32;
        while k + 1 < changes.len() && times[k + 1] < wanted {
            k += 1;
        }
        (k as f32 + ((wanted - times[k]) / (times[k + 1] - times[k])).clamp(0.0, 1.0)) * piece
    };
    (0..=changes.len()).map(place).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_slow_enough_stays_and_what_leaps_takes_its_time() {
        let even = paced(&[0.1; 10], 2.0);
        assert!(even.iter().enumerate().all(|(i, at)| (at - 0.1 * i as f32).abs() < 1e-6));
        // A leap in the middle, of as much as all the rest.
        let mut changes = [0.02; 100];
        changes[50] = 2.0;
        let places = paced(&changes, 2.0);
        assert_eq!((places[0], places[100]), (0.0, 1.0));
        let way = |at: f32| {
            let whole = (at * 100.0) as usize;
            let part = changes.get(whole).map_or(0.0, |change| change * (at * 100.0).fract());
            changes[..whole].iter().sum::<f32>() + part
        };
        for pair in places.windows(2) {
            assert!(pair[0] < pair[1], "{pair:?}");
            assert!(way(pair[1]) - way(pair[0]) < 2.0 * 0.021, "{pair:?}");
        }
    }
}
