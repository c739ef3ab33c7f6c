//! Where particles start: the four scatter patterns.
//!
//! Source: Rodkaew et al. 2002, section 3 and figure 7. Departs from it: in the hexagonal pattern
//! every second row is shifted (the text says "every three rows", the figure shows every other);
//! the random pattern takes its number from the spacing too, as area over spacing².

use glam::DVec2;

use super::ParticleSpec;
use crate::geometry::scatter::PolygonScatter;
use crate::geometry::segments::SegmentIndex;
use crate::margin::Margin;
use crate::parameter::words;
use crate::seed::Rng;
use crate::veins::VeinError;

words! {
    /// Where particles start (Rodkaew et al. 2002, figure 7).
    pub enum Pattern {
        /// The corners of regular squares.
        Square = "square",
        /// The square pattern with every second row shifted by half a unit.
        Hexagonal = "hexagonal",
        /// The square pattern, each particle moved at random within its square.
        Jitter = "jitter",
        /// Anywhere.
        Random = "random",
    }
}

/// More particles than this are a slip of the keyboard.
const MAX_PARTICLES: f64 = 1e6;

/// Lattice spacings are multiples of this (mm), so that places and their distances are exact and
/// equally far neighbours tie on every machine.
const EXACT: f64 = 1.0 / (1u64 << 20) as f64;

/// How far (in shares) a spacing may be off the one that area and count give, and in which steps it
/// is looked for.
const COUNT_SEARCH: (i32, f64) = (40, 0.0025);

/// The starting places in a blade, from the base upwards, left to right (the random ones as they
/// fall).
///
/// # Errors
///
/// [`VeinError`] when there would be none, or more than anybody can mean.
pub fn starts(
    spec: &ParticleSpec,
    margin: &Margin,
    rng: &mut Rng,
) -> Result<Vec<DVec2>, VeinError> {
    let area = margin.area_mm2();
    let wanted = match spec.count {
        0 => area / (spec.spacing_mm * spec.spacing_mm),
        count => count as f64,
    };
    let error = |problem: String| match spec.count {
        0 => VeinError::setting("veins.particles.spacing_mm", spec.spacing_mm, problem),
        count => VeinError::setting("veins.particles.count", count as f64, problem),
    };
    if wanted > MAX_PARTICLES {
        return Err(error(format!("scatters {wanted:.0} particles, more than {MAX_PARTICLES:.0}")));
    }
    let edges = SegmentIndex::of_polygon(margin.outline());
    let points = if spec.pattern == Pattern::Random {
        random(margin, &edges, wanted.round() as usize, rng)
    } else {
        let spacing = if spec.count == 0 {
            spec.spacing_mm
        } else {
            spacing_for(spec.pattern, margin, &edges, spec.count as usize)
        };
        lattice(spec.pattern, margin, &edges, spacing, rng)
    };
    if points.is_empty() {
        return Err(error(String::from(
            "leaves no particle inside the blade; try a finer pattern",
        )));
    }
    Ok(points)
}

fn random(margin: &Margin, edges: &SegmentIndex, count: usize, rng: &mut Rng) -> Vec<DVec2> {
    let scatter = PolygonScatter::new(margin.outline());
    // A point that rounding puts on the margin is thrown again; none is thrown for ever.
    (0..10 * count)
        .map(|_| scatter.point(rng.unit(), rng.unit()))
        .filter(|p| edges.contains(*p))
        .take(count)
        .collect()
}

/// The places of a lattice with one column on the midrib.
fn lattice(
    pattern: Pattern,
    margin: &Margin,
    edges: &SegmentIndex,
    spacing: f64,
    rng: &mut Rng,
) -> Vec<DVec2> {
    let spacing = (spacing / EXACT).round().max(1.0) * EXACT;
    let bounds = margin.bounds();
    // One ring more: jitter may move particles in.
    let first = (bounds.min / spacing).floor() - DVec2::ONE;
    let count = (bounds.size() / spacing).ceil() + DVec2::splat(4.0);
    let mut points = Vec::new();
    for j in 0..count.y as u32 {
        let row = first.y + f64::from(j);
        let shift = match pattern {
            Pattern::Hexagonal if row.rem_euclid(2.0) == 1.0 => 0.5,
            _ => 0.0,
        };
        for i in 0..count.x as u32 {
            let mut place = DVec2::new(first.x + f64::from(i) + shift, row + 0.5);
            if pattern == Pattern::Jitter {
                let (u, v) = (rng.unit(), rng.unit());
                place += DVec2::new(u - 0.5, v - 0.5);
            }
            let p = place * spacing;
            if edges.contains(p) {
                points.push(p);
            }
        }
    }
    points
}

/// The spacing whose lattice has (very nearly) `count` places; jitter moves a few over the margin.
fn spacing_for(pattern: Pattern, margin: &Margin, edges: &SegmentIndex, count: usize) -> f64 {
    let even = (margin.area_mm2() / count as f64).sqrt();
    let pattern = if pattern == Pattern::Jitter { Pattern::Square } else { pattern };
    // The stream is not drawn from: these patterns have nothing random.
    let mut unused = crate::seed::Seed(0).stream(crate::seed::Stage::Particles);
    let mut best = (usize::MAX, even);
    let (shares, step) = COUNT_SEARCH;
    for share in (0..=shares).flat_map(|k| [k, -k]) {
        let spacing = even * (1.0 + step * f64::from(share));
        let off = lattice(pattern, margin, edges, spacing, &mut unused).len().abs_diff(count);
        if off < best.0 {
            best = (off, spacing);
        }
        if best.0 * 1000 <= count {
            break;
        }
    }
    best.1
}
