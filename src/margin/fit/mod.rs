//! The parametric leaf nearest to a real outline: Garg's named future work (section 8.1).
//!
//! Each side of the blade is cut at its feet (base, valleys) and tips. Valleys are looked for where
//! the margin is incised (`incisions`); tips and valleys then move along the margin to where the
//! halves of lobes between them fit best (`flank`). A half is the curve of section 5.3 with four
//! numbers (`half`), found by a search that at last makes nearly the greatest distance least. The
//! simplest leaf that is near enough is taken: unilobed, with extensions, then lobes.
//!
//! A lobe has twelve numbers at most: four for either half, two for its tip, two for a valley. On the
//! tip of the leaf, which is the apex, two are saved. A half bulges from the line between its foot
//! and its tip, not from its vein: so flanks of tilted and bent lobes need no numbers more (in the
//! thesis their waists are measured along the vein; for unilobed blades it is the same).
//!
//! Distances are relative to the primary vein and taken from the points of each margin to the nearest
//! place of the other. (The thesis goes along normals, which misses places that no normal meets.)

mod flank;
mod half;
pub(super) mod incisions;
pub(super) mod records;

use glam::DVec2;

use super::{Margin, MarginError, MarginKind, MarginSpec};
use crate::geometry::deviation::{self, Distances};
use crate::geometry::polygon;
use crate::seed::Seed;
use flank::{AtApex, Flank, Side};
use half::{Extras, Half};
use incisions::Incision;

/// A real margin and the parametric one nearest to it.
#[derive(Debug, Clone)]
pub struct Fit {
    /// The numbers, as settings of a leaf of the same length.
    pub spec: MarginSpec,
    /// The margin they make (mm).
    pub margin: Margin,
    /// From the points of the fitted margin to the real one (lengths of the primary vein).
    pub fitted_to_real: Distances,
    /// From the points of the real margin to the fitted one (lengths of the primary vein).
    pub real_to_fitted: Distances,
    /// Lobes; 1 for a unilobed blade.
    pub lobes: usize,
    /// Numbers fitted, of all lobes together.
    pub numbers: usize,
}

impl Fit {
    /// Whether the leaf is `unilobed` or `lobed`.
    #[must_use]
    pub fn kind(&self) -> &'static str {
        if self.is_unilobed() { "unilobed" } else { "lobed" }
    }

    /// Whether the blade of a unilobed leaf reaches below its base, on either side.
    #[must_use]
    pub fn has_tail(&self) -> bool {
        self.is_unilobed() && [&self.spec.right, &self.spec.left].iter().any(|s| s.tail_depth > 0.0)
    }

    /// Whether the blade of a unilobed leaf reaches above its apex, on either side.
    #[must_use]
    pub fn has_shoulder(&self) -> bool {
        let sides = [&self.spec.right, &self.spec.left];
        self.is_unilobed() && sides.iter().any(|s| s.shoulder_height > 0.0)
    }

    fn is_unilobed(&self) -> bool {
        self.spec.kind == MarginKind::Unilobed
    }

    /// What was found, in a few words.
    #[must_use]
    pub fn description(&self) -> String {
        let mut words = match self.lobes {
            1 => "unilobed".to_owned(),
            lobes => format!("{lobes} lobes"),
        };
        if self.has_tail() {
            words += ", basal extension";
        }
        if self.has_shoulder() {
            words += ", apical extension";
        }
        words
    }

    /// The greatest distance, in the direction where it is larger (lengths).
    #[must_use]
    pub fn worst(&self) -> f64 {
        self.fitted_to_real.max.max(self.real_to_fitted.max)
    }
}

/// A fit is good when no point is farther off than this (lengths): what the thesis takes for an
/// accurate shape is 0.03. A unilobed blade must be nearer, or lobes are looked for.
const GOOD: f64 = 0.025;
/// Beyond this, other readings of the apex are tried.
const POOR: f64 = 0.03;
/// A lobe more must bring at least this (lengths).
const WORTH_A_LOBE: f64 = 0.008;
/// An extension must bring at least this (lengths).
const WORTH_AN_EXTENSION: f64 = 0.003;

/// Incisions deeper than this part lobes; shallower ones only where a fit needs them. Both as shares
/// of the root of the blade's area.
const DEEP: f64 = 0.1;
const SHALLOW: f64 = 0.012;
/// What is left of the bulge of halves that make lobes cross, step by step.
const SOFTENED: [f64; 3] = [0.85, 0.65, 0.4];
/// Lobes that a side may get beyond those that deep incisions part.
const MORE_LOBES: usize = 3;

/// The parametric leaf nearest to `real`.
///
/// # Errors
///
/// [`MarginError`] when every leaf tried crosses itself: the last reason met.
pub fn fit(real: &Margin) -> Result<Fit, MarginError> {
    let sides = Sides::of(real);
    let mut tried = Tried::new(real);
    sides.try_all(&mut tried);
    tried.best()
}

/// The two sides of the blade as right ones, relative to the primary vein, and their incisions.
struct Sides {
    sides: [Side; 2],
    incisions: [Vec<Incision>; 2],
    deep: [usize; 2],
    at_apex: AtApex,
}

/// A leaf that was tried.
enum Shape {
    Unilobed([Half; 2]),
    Lobed([Flank; 2], AtApex),
}

impl Shape {
    /// The settings of a blade of that length, its lobes and the numbers fitted.
    fn settings(&self, length_mm: f64) -> (MarginSpec, usize, usize) {
        match self {
            Self::Unilobed([right, left]) => {
                let spec = MarginSpec {
                    kind: MarginKind::Unilobed,
                    length_mm,
                    right: records::side(right),
                    left: records::side(left),
                    ..MarginSpec::default()
                };
                (spec, 1, right.count() + left.count())
            }
            Self::Lobed([right, left], at_apex) => {
                let lobe = records::records(right, left, *at_apex);
                let lobes = lobe.len();
                let tips_and_valleys = right.corners.len() + left.corners.len() - 4;
                let halves = right.halves.len() + left.halves.len();
                let spec = MarginSpec {
                    kind: MarginKind::Lobed,
                    length_mm,
                    lobe,
                    ..MarginSpec::default()
                };
                (spec, lobes, 2 * tips_and_valleys + 4 * halves)
            }
        }
    }
}

impl Sides {
    fn of(real: &Margin) -> Self {
        let length = real.length_mm();
        let outline: Vec<DVec2> = real.outline().iter().map(|p| *p / length).collect();
        let apex = real.apex_index();
        let right = Side::of(&outline[..=apex]);
        let left = outline[apex..].iter().chain(&outline[..1]).rev();
        let left: Vec<DVec2> = left.map(|p| DVec2::new(-p.x, p.y)).collect();
        let sides = [right, Side::of(&left)];
        let size = polygon::signed_area(&outline).abs().sqrt();
        let incisions = [0, 1].map(|i| incisions::incisions(sides[i].line(), SHALLOW * size));
        let at_apex = at_apex(&sides);
        let deep = incisions.each_ref().map(|list| match at_apex {
            AtApex::Tip => list.iter().filter(|incision| incision.depth > DEEP * size).count(),
            // Between a lobe and the valley at the apex the margin may be hollow without a lobe.
            AtApex::Valley => 0,
        });
        Self { sides, incisions, deep, at_apex }
    }

    fn try_all(&self, tried: &mut Tried<'_>) {
        self.try_unilobed(tried);
        if tried.worst() > GOOD {
            self.try_lobed(tried, self.at_apex, self.deep);
        }
        if tried.worst() > POOR {
            let other = match self.at_apex {
                AtApex::Tip => AtApex::Valley,
                AtApex::Valley => AtApex::Tip,
            };
            self.try_lobed(tried, other, self.deep);
        }
    }

    fn try_unilobed(&self, tried: &mut Tried<'_>) {
        let tension = Extras { tension: true, ..Extras::default() };
        let tail = Extras { tail: true, ..Extras::default() };
        let shoulder = Extras { shoulder: true, ..Extras::default() };
        let best = |choices: &[Extras], side: &Side| {
            let fits = choices.iter().map(|&extras| side.unilobed(extras));
            fits.reduce(
                |simple, more| {
                    if more.1 < simple.1 - WORTH_AN_EXTENSION { more } else { simple }
                },
            )
            .expect("there are choices")
        };
        let choices: &[Extras] = match self.at_apex {
            AtApex::Tip => &[tension, tail],
            AtApex::Valley => &[tension, shoulder],
        };
        let [right, left] = self.sides.each_ref().map(|side| best(choices, side).0);
        tried.add(&Shape::Unilobed([right, left]));
    }

    /// Lobes with valleys at the first `counts` incisions, then at more on the side that is worse.
    fn try_lobed(&self, tried: &mut Tried<'_>, at_apex: AtApex, counts: [usize; 2]) {
        let fit = |i: usize, count: usize| {
            let valleys: Vec<usize> = self.incisions[i][..count].iter().map(|v| v.at).collect();
            self.sides[i].lobed(&valleys, at_apex)
        };
        let mut counts = counts;
        let mut flanks = [0, 1].map(|i| fit(i, counts[i]));
        let mut spent = [false; 2];
        for _ in 0..=2 * MORE_LOBES {
            if let [Some(right), Some(left)] = &flanks {
                tried.add(&Shape::Lobed([right.clone(), left.clone()], at_apex));
            }
            let off = [0, 1].map(|i| flanks[i].as_ref().map_or(f64::INFINITY, |f| f.worst));
            spent = [0, 1].map(|i| {
                spent[i]
                    || counts[i] >= self.incisions[i].len()
                    || counts[i] >= self.deep[i] + MORE_LOBES
                    || off[i] < GOOD
            });
            let worse = usize::from(off[1] > off[0]);
            let i = if spent[worse] { 1 - worse } else { worse };
            if spent[i] {
                return;
            }
            counts[i] += 1;
            let more = fit(i, counts[i]);
            match more {
                Some(more) if more.worst < off[i] => flanks[i] = Some(more),
                _ => {}
            }
        }
    }
}

/// What ends both sides: a valley where they come down to the apex from higher up.
fn at_apex(sides: &[Side; 2]) -> AtApex {
    // Higher than this, relative to the apex, are the lobes beside a valley; a lobe between them
    // stands out by the second from what lies before it.
    const HIGHER: f64 = 1.02;
    const STANDS_OUT: f64 = 0.08;
    let falls = |side: &Side| {
        let line = side.line();
        let highest = (0..line.len()).max_by(|&a, &b| line[a].y.total_cmp(&line[b].y)).unwrap_or(0);
        let lowest = line[highest..].iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
        line[highest].y > HIGHER && lowest > 1.0 - STANDS_OUT
    };
    if sides.iter().all(falls) { AtApex::Valley } else { AtApex::Tip }
}

/// The leaves tried so far.
struct Tried<'a> {
    real: &'a Margin,
    dense: Vec<DVec2>,
    best: Option<(f64, Fit)>,
    refused: Option<MarginError>,
}

impl<'a> Tried<'a> {
    fn new(real: &'a Margin) -> Self {
        Self { real, dense: dense(real), best: None, refused: None }
    }

    fn worst(&self) -> f64 {
        self.best.as_ref().map_or(f64::INFINITY, |(_, fit)| fit.worst())
    }

    fn best(self) -> Result<Fit, MarginError> {
        match self.best {
            Some((_, fit)) => Ok(fit),
            None => Err(self.refused.unwrap_or_else(|| {
                MarginError::Picture("no leaf of lobes comes near this outline".into())
            })),
        }
    }

    /// Builds the leaf and keeps it when it is the best so far. Lobes that cross are drawn towards the
    /// lines from foot to tip until they do not.
    fn add(&mut self, shape: &Shape) {
        let mut result = self.measured(shape);
        if let Shape::Lobed(flanks, at_apex) = shape {
            for share in SOFTENED {
                if result.is_ok() {
                    break;
                }
                let flanks = flanks.each_ref().map(|flank| flank.softened(share));
                result = self.measured(&Shape::Lobed(flanks, *at_apex));
            }
        }
        match result {
            Ok(fit) => {
                let cost = fit.worst() + WORTH_A_LOBE * fit.lobes as f64;
                if self.best.as_ref().is_none_or(|(least, _)| cost < *least) {
                    self.best = Some((cost, fit));
                }
            }
            Err(error) => self.refused = Some(error),
        }
    }

    fn measured(&self, shape: &Shape) -> Result<Fit, MarginError> {
        let (spec, lobes, numbers) = shape.settings(self.real.length_mm());
        let margin = super::build(&spec, Seed(0))?;
        let length = margin.length_mm();
        let fitted = dense(&margin);
        let there = deviation::to_polygon(&fitted, self.real.outline());
        let back = deviation::to_polygon(&self.dense, margin.outline());
        Ok(Fit {
            spec,
            fitted_to_real: Distances::of(there).scaled(1.0 / length),
            real_to_fitted: Distances::of(back).scaled(1.0 / length),
            margin,
            lobes,
            numbers,
        })
    }
}

/// Points at equal steps of a margin.
fn dense(margin: &Margin) -> Vec<DVec2> {
    const STEPS: f64 = 1500.0;
    polygon::resampled(margin.outline(), polygon::perimeter(margin.outline()) / STEPS)
}
