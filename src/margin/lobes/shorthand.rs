//! A lobed leaf in 26 numbers: how many lobes, the first and the last of each side, one shape.
//!
//! Source: Garg (2011), section 6.1: origins by 6.3–6.4, angles by 6.7, lengths by 6.8, in equal
//! steps between the first and the last lobe of a side. The printed list sums to 25; Δs of each side
//! makes 26. Palmate leaves have s₀ = Δs = 0; an odd number of lobes puts one at the apex; with an
//! even number the leaf ends in a notch. With one lobe a side, 6.7 and 6.8 have no last: the first
//! counts.
//!
//! The lobe at the apex takes its both halves from the upper half, so that a leaf of uneven lobes is
//! not lopsided itself.

use super::{HalfLobe, LobeRecord, LobeSide, ValleyKind};
use crate::margin::MarginError;
use crate::parameter::parameters;

parameters! {
    /// The veins of the lobes of one side.
    pub struct LobeRow {
        /// From the base to the first vein, s₀: 0 for a palmate leaf.
        first_spacing: number(0.0, 0.0..=0.95, "lengths"),
        /// How much each spacing is longer than the one below, Δs.
        spacing_change: number(0.0, -0.5..=0.9, "lengths"),
        /// Angle between the midrib and the lowest vein, θ₁.
        first_angle_deg: number(95.0, 0.0..=180.0, "deg"),
        /// Angle between the midrib and the highest vein, θₙ.
        last_angle_deg: number(48.0, 0.0..=180.0, "deg"),
        /// Length of the lowest vein, l₁.
        first_length: number(0.6, 0.02..=3.0, "lengths"),
        /// Length of the highest vein, lₙ.
        last_length: number(0.85, 0.02..=3.0, "lengths"),
    }
}

parameters! {
    /// A lobed leaf by its first and last lobes; used when no `margin.lobe` is given.
    pub struct LobingSpec {
        /// Lobes of the whole leaf, N: with an odd number one stands at the apex.
        count: count(5, 2..=41, "lobes"),
        /// Veins of the right side.
        right: group(LobeRow, LobeRow::default()),
        /// Veins of the left side.
        left: group(LobeRow, LobeRow::default()),
        /// The half of each lobe towards the base.
        lower: group(HalfLobe, HalfLobe::default()),
        /// The half of each lobe towards the apex.
        upper: group(HalfLobe, HalfLobe::default()),
        /// What makes the valleys: `meet`, where lobes meet, or `set`, at the place given.
        valley: choice(ValleyKind, ValleyKind::Meet),
        /// How far set valleys lie from where the vein begins, m.
        valley_distance: number(0.5, 0.02..=1.5, "lobe lengths"),
        /// Angle there between the vein and the way to the valley, ϕ.
        valley_angle_deg: number(22.0, -30.0..=150.0, "deg"),
        /// Angle between that way and the margin on the lower lobe's side, θᵥ.
        valley_lower_deg: number(50.0, 0.0..=180.0, "deg"),
        /// Angle between that way and the margin on the upper lobe's side, θᵥ.
        valley_upper_deg: number(50.0, 0.0..=180.0, "deg"),
        /// Angle between midrib and margin at the apex of a leaf of even lobes, ψ.
        notch_angle_deg: number(60.0, 0.0..=180.0, "deg"),
    }
}

impl LobingSpec {
    /// The record of every lobe, right ones first, each side from base to apex.
    ///
    /// # Errors
    ///
    /// [`MarginError::Landmark`] for spacings that leave the midrib or run backwards: the key, the
    /// value and the bound (equation 6.6 above, −s₀/(n − 1) below).
    pub fn records(&self) -> Result<Vec<LobeRecord>, MarginError> {
        let per_side = self.count / 2;
        let (right, left) = (&self.right, &self.left);
        let mut records = Vec::with_capacity(self.count as usize);
        if right == left {
            self.add(&mut records, right, per_side, LobeSide::Both, "right")?;
        } else {
            self.add(&mut records, right, per_side, LobeSide::Right, "right")?;
            self.add(&mut records, left, per_side, LobeSide::Left, "left")?;
        }
        if self.count % 2 == 1 {
            let mut apex = self.lobe(LobeSide::Apex);
            apex.lower = self.upper.clone();
            records.push(apex);
        }
        Ok(records)
    }

    fn add(
        &self,
        records: &mut Vec<LobeRecord>,
        row: &LobeRow,
        n: u64,
        side: LobeSide,
        name: &str,
    ) -> Result<(), MarginError> {
        row.check(n, name)?;
        for i in 1..=n {
            let share = if n > 1 { (i - 1) as f64 / (n - 1) as f64 } else { 0.0 };
            records.push(LobeRecord {
                origin: row.origin(i),
                angle_deg: between(row.first_angle_deg, row.last_angle_deg, share),
                length: between(row.first_length, row.last_length, share),
                ..self.lobe(side)
            });
        }
        Ok(())
    }

    /// What all lobes share.
    fn lobe(&self, side: LobeSide) -> LobeRecord {
        LobeRecord {
            side,
            lower: self.lower.clone(),
            upper: self.upper.clone(),
            valley: self.valley,
            valley_distance: self.valley_distance,
            valley_angle_deg: self.valley_angle_deg,
            valley_lower_deg: self.valley_lower_deg,
            valley_upper_deg: self.valley_upper_deg,
            notch_angle_deg: self.notch_angle_deg,
            ..LobeRecord::default()
        }
    }
}

/// Equations 6.7 and 6.8: the first value at 0, the last at 1.
fn between(first: f64, last: f64, share: f64) -> f64 {
    first + share * (last - first)
}

impl LobeRow {
    /// Where vein i begins, counted from 1: equation 6.4.
    #[must_use]
    pub fn origin(&self, i: u64) -> f64 {
        let i = i as f64;
        i * self.first_spacing + i * (i - 1.0) / 2.0 * self.spacing_change
    }

    /// Refuses origins outside the midrib, or in the wrong order.
    fn check(&self, n: u64, side: &str) -> Result<(), MarginError> {
        let wrong = |key: &str, value: f64, problem: String| {
            let key = format!("margin.lobing.{side}.{key}");
            Err(MarginError::Landmark { key, value, problem })
        };
        let (s0, change, count) = (self.first_spacing, self.spacing_change, n as f64);
        if n < 2 {
            return Ok(());
        }
        let least = -s0 / (count - 1.0);
        if change < least {
            let problem = format!(
                "makes the spacings of {n} lobes a side run backwards; take {least:.4} or more \
                 (-first_spacing / {})",
                n - 1
            );
            return wrong("spacing_change", change, problem);
        }
        if count * s0 >= 1.0 {
            let problem = format!("puts {n} lobes a side past the apex; take less than 1/{n}");
            return wrong("first_spacing", s0, problem);
        }
        let most = 2.0 * (1.0 - count * s0) / (count * (count - 1.0));
        if change >= most {
            let problem = format!(
                "puts the last of {n} lobes a side past the apex; take less than {most:.4}"
            );
            return wrong("spacing_change", change, problem);
        }
        Ok(())
    }
}
