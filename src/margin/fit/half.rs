//! One half of a lobe, fitted to the stretch of margin from its foot (base or valley) to its tip.
//!
//! The frame is that of a unilobed side: foot at (0, 0), tip at (0, 1), x outwards. Four numbers: the
//! place of the waist, where the margin runs along the frame's y (on a half that bulges, its farthest
//! place from the line from foot to tip), and the angles at both ends. Two more for a tail and for a
//! shoulder, one for tension.

use glam::DVec2;

use super::super::curve::{self, Waypoint};
use crate::geometry::deviation::squared_to_line;
use crate::geometry::minimise::{Search, minimum};

/// What a half has beside waist and angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Extras {
    /// A lowest place below the foot.
    pub(super) tail: bool,
    /// A highest place above the tip.
    pub(super) shoulder: bool,
    /// A tension of its own.
    pub(super) tension: bool,
    /// Angles and waist as a unilobed blade may have them.
    pub(super) unilobed: bool,
}

/// The numbers of one half, in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Half {
    pub(super) waist: DVec2,
    /// Between frame and margin at the foot, and at the tip (radians).
    pub(super) foot_angle: f64,
    pub(super) tip_angle: f64,
    pub(super) tail: Option<DVec2>,
    pub(super) shoulder: Option<DVec2>,
    pub(super) tension: f64,
}

impl Half {
    fn waypoints(&self) -> Vec<Waypoint> {
        let turn = |angle: f64| DVec2::new(libm::sin(angle), libm::cos(angle));
        let pass = |at, towards| Waypoint { at, towards };
        let mut list = vec![pass(DVec2::ZERO, turn(self.foot_angle))];
        list.extend(self.tail.map(|at| pass(at, DVec2::X)));
        list.push(pass(self.waist, DVec2::Y));
        list.extend(self.shoulder.map(|at| pass(at, DVec2::NEG_X)));
        list.push(pass(DVec2::Y, turn(-self.tip_angle)));
        list
    }

    /// Points along its curve.
    fn sampled(&self) -> Vec<DVec2> {
        const PIECES: u32 = 6;
        let mut points = vec![DVec2::ZERO];
        for [a, b, c] in curve::parabolas(&self.waypoints(), self.tension) {
            points.extend((1..=PIECES).map(|i| {
                let s = f64::from(i) / f64::from(PIECES);
                a.lerp(b, s).lerp(b.lerp(c, s), s)
            }));
        }
        points
    }

    fn numbers(&self) -> Vec<f64> {
        let mut list = vec![self.waist.x, self.waist.y, self.foot_angle, self.tip_angle];
        list.extend([self.tail, self.shoulder].into_iter().flatten().flat_map(|p| p.to_array()));
        list.push(self.tension);
        list
    }

    /// The same with only a share of its bulge and of its angles.
    pub(super) fn softened(&self, share: f64) -> Self {
        Self {
            waist: DVec2::new(self.waist.x * share, self.waist.y),
            foot_angle: self.foot_angle * share,
            tip_angle: self.tip_angle * share,
            ..self.clone()
        }
    }

    /// How many numbers were fitted: tension counts where it is not that of the thesis.
    pub(super) fn count(&self) -> usize {
        self.numbers().len() - usize::from(self.tension == 1.0)
    }

    /// The half of a list of [`numbers`](Self::numbers) or one shorter, of tension 1.
    fn of_numbers(list: &[f64], extras: Extras) -> Self {
        let mut rest = list.iter().copied();
        let mut next = || rest.next().unwrap_or(1.0);
        let waist = DVec2::new(next(), next());
        let (foot_angle, tip_angle) = (next(), next());
        let mut place = |wanted: bool| wanted.then(|| DVec2::new(next(), next()));
        let (tail, shoulder) = (place(extras.tail), place(extras.shoulder));
        Self { waist, foot_angle, tip_angle, tail, shoulder, tension: next() }
    }
}

/// A stretch of margin in the frame of its half: from (0, 0) to (0, 1).
#[derive(Debug, Clone)]
pub(super) struct Stretch {
    line: Vec<DVec2>,
}

/// How much a search may cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Effort {
    /// To compare places for tips and valleys.
    Quick,
    /// For the result.
    Full,
}

impl Stretch {
    /// A stretch of margin as given, from foot to tip; `mirrored` when its outside is on the left.
    pub(super) fn of(line: &[DVec2], mirrored: bool) -> Self {
        let (foot, tip) = (line[0], line[line.len() - 1]);
        let axis = tip - foot;
        let (along, out) = (axis / axis.length_squared(), if mirrored { -1.0 } else { 1.0 });
        let local = |p: &DVec2| {
            let off = *p - foot;
            DVec2::new(-along.perp_dot(off) * out, along.dot(off))
        };
        Self { line: line.iter().map(local).collect() }
    }

    /// The squared distances between a half and this, from the points of each to the other.
    fn squared_distances(&self, half: &[DVec2]) -> Vec<f64> {
        let there = half.iter().map(|&p| squared_to_line(p, &self.line));
        there.chain(self.line.iter().map(|&p| squared_to_line(p, half))).collect()
    }

    /// The greatest distance between a half and this, either way.
    pub(super) fn worst(&self, half: &Half) -> f64 {
        self.squared_distances(&half.sampled()).into_iter().fold(0.0, f64::max).sqrt()
    }

    /// The numbers as they can be read off.
    fn guess(&self, extras: Extras) -> Half {
        let n = self.line.len();
        let inner = &self.line[1..n - 1];
        let far = |p: &DVec2| if extras.unilobed { p.x } else { p.x.abs() };
        let middle = inner.iter().filter(|p| (0.03..0.97).contains(&p.y));
        let waist = middle.max_by(|a, b| far(a).total_cmp(&far(b)));
        let arm = (n / 8).clamp(1, n - 1);
        let (out, back) = (self.line[arm], self.line[n - 1 - arm] - DVec2::Y);
        // Past half a turn outwards rather than inwards.
        let angle = |x: f64, y: f64| {
            let angle = libm::atan2(x, y);
            if angle < -2.0 { angle + std::f64::consts::TAU } else { angle }
        };
        let by_height = |a: &DVec2, b: &DVec2| a.y.total_cmp(&b.y);
        let low = inner.iter().copied().min_by(by_height).unwrap_or(DVec2::ZERO);
        let high = inner.iter().copied().max_by(by_height).unwrap_or(DVec2::Y);
        Half {
            waist: waist.copied().unwrap_or(DVec2::new(0.1, 0.5)),
            foot_angle: angle(out.x, out.y),
            tip_angle: angle(back.x, -back.y),
            tail: extras.tail.then_some(low),
            shoulder: extras.shoulder.then_some(high),
            tension: 1.0,
        }
    }

    /// The half nearest to this stretch, and its greatest distance; searches from `start` or, without
    /// one, from what can be read off.
    pub(super) fn fit(&self, extras: Extras, start: Option<&Half>, effort: Effort) -> (Half, f64) {
        use std::f64::consts::{FRAC_PI_2, PI};
        // Limits of `parametric` for unilobed blades, of `lobes` for others.
        let (waist, [foot, tip]) = if extras.unilobed {
            let past = |extended| if extended { [FRAC_PI_2, PI] } else { [0.0, FRAC_PI_2] };
            ([0.005, 2.0], [past(extras.tail), past(extras.shoulder)])
        } else {
            ([-1.0, 3.0], [[-PI, PI]; 2])
        };
        let mut bounds = vec![waist, [0.02, 0.98], foot, tip];
        let mut steps = vec![0.05, 0.08, 0.3, 0.3];
        if extras.tail {
            bounds.extend([[0.005, 2.0], [-0.9, -0.002]]);
            steps.extend([0.05, -0.04]);
        }
        if extras.shoulder {
            bounds.extend([[0.005, 2.0], [1.002, 1.9]]);
            steps.extend([0.05, 0.04]);
        }
        if extras.tension {
            bounds.push([0.3, 1.5]);
            steps.push(0.1);
        }
        // The mean square first, which guides from afar, then nearly the greatest distance.
        let value = |power: f64| {
            move |list: &[f64]| {
                let half = Half::of_numbers(list, extras);
                // A tail or a shoulder wider than the waist is not one.
                let beyond =
                    |p: Option<DVec2>| p.map_or(0.0, |p| (p.x - half.waist.x + 1e-3).max(0.0));
                let distances = self.squared_distances(&half.sampled());
                let sum: f64 = distances.iter().map(|d| libm::pow(*d, power / 2.0)).sum();
                libm::pow(sum / distances.len() as f64, 1.0 / power)
                    + beyond(half.tail)
                    + beyond(half.shoulder)
            }
        };
        let mut list = match start {
            Some(half) => half.numbers(),
            None => self.guess(extras).numbers(),
        };
        list.truncate(bounds.len());
        let rounds: &[(f64, usize)] = match effort {
            Effort::Quick => &[(2.0, 60), (8.0, 80)],
            Effort::Full => &[(2.0, 200), (8.0, 300), (12.0, 200)],
        };
        for &(power, most_calls) in rounds {
            let search = Search { most_calls, tolerance: 1e-6 };
            list = minimum(value(power), &list, &steps, &bounds, search).at;
            steps.iter_mut().for_each(|step| *step *= 0.4);
        }
        let half = Half::of_numbers(&list, extras);
        let worst = self.worst(&half);
        (half, worst)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_half_is_found_again_from_its_own_curve() {
        let waist = DVec2::new(0.4, 0.35);
        let plain = Half {
            waist,
            foot_angle: 1.2,
            tip_angle: 0.5,
            tail: None,
            shoulder: None,
            tension: 1.0,
        };
        let cordate = Half {
            foot_angle: 2.3,
            tail: Some(DVec2::new(0.2, -0.12)),
            tip_angle: 0.4,
            ..plain.clone()
        };
        let slack = Half { tension: 0.6, ..plain.clone() };
        for half in [plain, cordate, slack] {
            let extras = Extras {
                tail: half.tail.is_some(),
                tension: half.tension != 1.0,
                unilobed: true,
                ..Extras::default()
            };
            let stretch = Stretch { line: half.sampled() };
            let (found, worst) = stretch.fit(extras, None, Effort::Full);
            assert!(worst < 2e-3, "{half:?}: {found:?} is off by {worst}");
            assert!(found.waist.distance(half.waist) < 0.02, "{half:?}: {found:?}");
        }
    }

    #[test]
    fn a_stretch_is_laid_from_foot_to_tip_with_its_outside_at_positive_x() {
        let line = [(2.0, 1.0), (4.0, 2.0), (2.0, 5.0)].map(DVec2::from);
        let stretch = Stretch::of(&line, false);
        assert!(stretch.line[1].distance(DVec2::new(0.5, 0.25)) < 1e-12, "{stretch:?}");
        let mirrored = Stretch::of(&line.map(|p| DVec2::new(-p.x, p.y)), true);
        assert!(mirrored.line[1].distance(DVec2::new(0.5, 0.25)) < 1e-12);
    }
}
