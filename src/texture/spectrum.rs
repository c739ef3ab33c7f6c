//! From amounts of pigments to colours: absorption over the visible wavelengths, a pile of plates at
//! each, and what an eye makes of it in daylight.
//!
//! Absorption: sums of Gaussians fitted to the tables of PROSPECT-PRO (J.-B. Féret et al., Remote
//! Sens. Environ. 252, 2021); against the tables their colours differ by a ΔE2000 of 0.4 in the mean
//! and 2.1 at most. Eye: C. Wyman, P.-P. Sloan, P. Shirley, "Simple analytic approximations to the CIE
//! XYZ color matching functions", JCGT 2(2), 2013. Light: CIE D65, so that white paper is white.
//!
//! Sixteen wavelengths, 20 nm apart, are enough: 5 nm changes no colour by a ΔE of more than 0.6.

use super::pigment::Amounts;
use super::plates::{Interfaces, Scattered};

/// How many wavelengths, the first (nm), and the distance between two.
const SAMPLES: usize = 16;
const FIRST_NM: f64 = 400.0;
const STEP_NM: f64 = 20.0;

/// CIE D65 at those wavelengths.
const DAYLIGHT: [f64; SAMPLES] = [
    82.75, 93.43, 104.86, 117.81, 115.92, 109.35, 104.79, 104.41, 100.0, 95.79, 90.01, 87.70,
    83.70, 80.21, 78.28, 71.61,
];

/// Peak (cm²/µg), place and width (nm) of the bands of a pigment.
type Band = (f64, f64, f64);

const CHLOROPHYLL: &[Band] = &[
    (0.0697, 406.6, 18.4),
    (0.0504, 439.6, 12.6),
    (0.0378, 475.1, 21.1),
    (0.0048, 546.7, 11.8),
    (0.0191, 593.0, 25.8),
    (0.0201, 630.7, 15.0),
    (0.0179, 649.5, 8.2),
    (0.0707, 675.1, 12.9),
];
const CAROTENOID: &[Band] =
    &[(0.1645, 401.0, 41.5), (0.0853, 455.0, 19.9), (0.0555, 485.8, 12.9), (0.0590, 509.1, 18.3)];
const ANTHOCYANIN: &[Band] = &[(0.0802, 373.7, 23.8), (0.0358, 442.0, 39.1), (0.0715, 531.8, 42.8)];

/// Dry matter of a blade (g/cm²): it dims the violet, hardly anything else.
const DRY_MATTER: f64 = 0.004;

/// A colour of light in linear sRGB, not clipped: leaves may lie outside of it.
pub type Linear = [f64; 3];

/// Everything that does not depend on the pigments, at each wavelength.
#[derive(Debug)]
pub struct Spectrum {
    waves: Vec<Wave>,
}

#[derive(Debug)]
struct Wave {
    interfaces: Interfaces,
    /// Absorption by a unit of chlorophyll, carotenoid, anthocyanin and brown, and by dry matter.
    pigments: [f64; 4],
    dry: f64,
    /// What light of this wavelength adds to linear red, green and blue; white sums to 1.
    seen: Linear,
}

/// What an eye sees of a leaf: light sent back, without the mirror part of the surface if so wanted,
/// and light let through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// All that is sent back.
    pub total: Linear,
    /// The same less the mirror part of the surface: what a renderer with its own gloss needs.
    pub diffuse: Linear,
    /// Let through.
    pub through: Linear,
}

impl Default for Spectrum {
    fn default() -> Self {
        Self::new()
    }
}

impl Spectrum {
    /// The visible wavelengths.
    #[must_use]
    pub fn new() -> Self {
        let waves: Vec<f64> = (0..SAMPLES).map(|i| FIRST_NM + STEP_NM * i as f64).collect();
        let seen: Vec<Linear> = waves
            .iter()
            .zip(DAYLIGHT)
            .map(|(&nm, light)| linear(matching(nm).map(|v| v * light)))
            .collect();
        let white: Linear = std::array::from_fn(|c| seen.iter().map(|rgb| rgb[c]).sum());
        let wave = |(&nm, seen): (&f64, &Linear)| {
            let u = nm - FIRST_NM;
            let q = (nm - 550.0) / 100.0;
            let brown = 0.545 - 1.393e-3 * u + 8.25e-8 * u * u;
            Wave {
                interfaces: Interfaces::new(1.4709 - 0.02350 * q + 0.00306 * q * q),
                pigments: [
                    bands(CHLOROPHYLL, nm),
                    bands(CAROTENOID, nm),
                    bands(ANTHOCYANIN, nm),
                    brown,
                ],
                dry: DRY_MATTER * (2.3 + 107.0 * libm::exp(-u / 17.5)),
                seen: std::array::from_fn(|c| seen[c] / white[c]),
            }
        };
        Self { waves: waves.iter().zip(&seen).map(wave).collect() }
    }

    /// Share of light sent back and let through at each wavelength.
    pub fn scattered<'a>(&'a self, amounts: &'a Amounts) -> impl Iterator<Item = Scattered> + 'a {
        let [chlorophyll, carotenoid, anthocyanin, brown, structure] = amounts.array();
        let pigments = [chlorophyll, carotenoid, anthocyanin, brown];
        self.waves.iter().map(move |wave| {
            let absorbed: f64 = wave.pigments.iter().zip(pigments).map(|(k, c)| k * c).sum();
            wave.interfaces.pile(structure, absorbed + wave.dry)
        })
    }

    /// What an eye sees of a leaf with these pigments.
    #[must_use]
    pub fn seen(&self, amounts: &Amounts) -> Seen {
        let mut seen = Seen { total: [0.0; 3], diffuse: [0.0; 3], through: [0.0; 3] };
        for (wave, light) in self.waves.iter().zip(self.scattered(amounts)) {
            for c in 0..3 {
                seen.total[c] += wave.seen[c] * light.reflected;
                seen.diffuse[c] += wave.seen[c] * (light.reflected - wave.interfaces.surface());
                seen.through[c] += wave.seen[c] * light.transmitted;
            }
        }
        seen
    }
}

/// How much light piles of one structure send back and let through, over how much they absorb: for
/// many leaves that differ in their pigments only.
#[derive(Debug)]
pub(super) struct Tabulated<'a> {
    spectrum: &'a Spectrum,
    /// For every wavelength, evenly in absorption / (absorption + 1).
    piles: Vec<[Scattered; ENTRIES]>,
}

/// Between 400 entries the light is linear to 1e-5.
const ENTRIES: usize = 400;

/// More is never absorbed: twice what the darkest leaf does.
const MOST_ABSORBED: f64 = 50.0;

impl Spectrum {
    /// Piles of so many plates.
    pub(super) fn tabulated(&self, structure: f64) -> Tabulated<'_> {
        let most = MOST_ABSORBED / (1.0 + MOST_ABSORBED);
        let piles = self.waves.iter().map(|wave| {
            std::array::from_fn(|i| {
                let place = most * i as f64 / (ENTRIES - 1) as f64;
                wave.interfaces.pile(structure, place / (1.0 - place))
            })
        });
        Tabulated { spectrum: self, piles: piles.collect() }
    }
}

impl Tabulated<'_> {
    /// What an eye sees of a leaf with so much chlorophyll, carotenoid, anthocyanin and brown.
    pub(super) fn seen(&self, pigments: [f64; 4]) -> Seen {
        let mut seen = Seen { total: [0.0; 3], diffuse: [0.0; 3], through: [0.0; 3] };
        for (wave, piles) in self.spectrum.waves.iter().zip(&self.piles) {
            let absorbed: f64 =
                wave.pigments.iter().zip(pigments).map(|(k, c)| k * c).sum::<f64>() + wave.dry;
            let most = MOST_ABSORBED / (1.0 + MOST_ABSORBED);
            let place = absorbed / (1.0 + absorbed) / most * (ENTRIES - 1) as f64;
            let i = (place as usize).min(ENTRIES - 2);
            let (a, b, t) = (piles[i], piles[i + 1], place - i as f64);
            let reflected = a.reflected + (b.reflected - a.reflected) * t;
            let transmitted = a.transmitted + (b.transmitted - a.transmitted) * t;
            for c in 0..3 {
                seen.total[c] += wave.seen[c] * reflected;
                seen.diffuse[c] += wave.seen[c] * (reflected - wave.interfaces.surface());
                seen.through[c] += wave.seen[c] * transmitted;
            }
        }
        seen
    }
}

fn bands(bands: &[Band], nm: f64) -> f64 {
    bands.iter().map(|&(a, m, s)| a * libm::exp(-(nm - m).powi(2) / (2.0 * s * s))).sum()
}

/// x̄, ȳ, z̄ after Wyman et al. 2013, equation 4 and table 1.
fn matching(nm: f64) -> [f64; 3] {
    let lobe = |height: f64, place: f64, below: f64, above: f64| {
        let t = (nm - place) / if nm < place { below } else { above };
        height * libm::exp(-0.5 * t * t)
    };
    [
        lobe(1.056, 599.8, 37.9, 31.0) + lobe(0.362, 442.0, 16.0, 26.7)
            - lobe(0.065, 501.1, 20.4, 26.2),
        lobe(0.821, 568.8, 46.9, 40.5) + lobe(0.286, 530.9, 16.3, 31.1),
        lobe(1.217, 437.0, 11.8, 36.0) + lobe(0.681, 459.0, 26.0, 13.8),
    ]
}

/// XYZ to linear sRGB (IEC 61966-2-1).
fn linear([x, y, z]: [f64; 3]) -> Linear {
    [
        3.2406 * x - 1.5372 * y - 0.4986 * z,
        -0.9689 * x + 1.8758 * y + 0.0415 * z,
        0.0557 * x - 0.2040 * y + 1.0570 * z,
    ]
}

/// sRGB's curve, continued below 0 and above 1, so that what lies outside can be mixed with what lies
/// inside.
#[must_use]
pub fn encoded(linear: f64) -> f64 {
    let size = linear.abs();
    let curve =
        if size <= 0.003_130_8 { 12.92 * size } else { 1.055 * libm::pow(size, 1.0 / 2.4) - 0.055 };
    curve.copysign(linear)
}

/// The inverse of [`encoded`].
#[must_use]
pub fn decoded(value: f64) -> f64 {
    let size = value.abs();
    let curve =
        if size <= 0.040_45 { size / 12.92 } else { libm::pow((size + 0.055) / 1.055, 2.4) };
    curve.copysign(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use palette::color_difference::EuclideanDistance;
    use palette::{FromColor, Lab, LinSrgb};

    fn lab(linear: Linear) -> Lab<palette::white_point::D65, f64> {
        let [r, g, b] = linear;
        Lab::from_color(LinSrgb::new(r, g, b))
    }

    /// States of leaves: N, chlorophyll, carotenoid, anthocyanin, brown; L*, a*, b*; T/R by luminance.
    /// Computed apart from this code, with the full tables of PROSPECT-D and D65.
    const STATES: &[(&str, [f64; 5], [f64; 3], f64)] = &[
        ("dark green", [1.7, 60.0, 12.0, 1.0, 0.0], [34.0, -16.0, 17.0], 0.58),
        ("green", [1.5, 40.0, 8.0, 0.5, 0.0], [38.0, -19.0, 23.0], 0.92),
        ("thick sun leaf", [2.2, 55.0, 12.0, 1.0, 0.0], [39.0, -18.0, 24.0], 0.32),
        ("mid green", [1.5, 25.0, 7.0, 0.5, 0.0], [44.0, -17.0, 32.0], 0.98),
        ("young", [1.4, 12.0, 4.0, 0.5, 0.0], [52.0, -14.0, 39.0], 1.14),
        ("yellow-green", [1.5, 6.0, 5.0, 0.0, 0.0], [59.0, -8.0, 47.0], 1.02),
        ("yellow", [1.6, 1.5, 6.0, 0.0, 0.05], [64.0, 3.0, 53.0], 0.93),
        ("orange", [1.6, 1.0, 6.0, 4.0, 0.1], [52.0, 18.0, 38.0], 0.91),
        ("red", [1.6, 2.0, 5.0, 15.0, 0.1], [39.0, 28.0, 20.0], 0.79),
        ("deep red", [1.6, 2.0, 5.0, 30.0, 0.2], [32.0, 27.0, 12.0], 0.60),
        ("bronze", [1.4, 12.0, 4.0, 12.0, 0.0], [35.0, 12.0, 15.0], 1.02),
        ("copper beech", [1.5, 35.0, 8.0, 25.0, 0.0], [26.0, 4.0, 3.0], 0.41),
        ("brown", [2.0, 0.5, 3.0, 0.0, 1.0], [52.0, 5.0, 26.0], 0.59),
        ("dark brown", [2.2, 0.2, 2.0, 0.0, 2.5], [41.0, 7.0, 15.0], 0.35),
        ("tan", [2.0, 0.2, 2.0, 0.0, 0.5], [61.0, 3.0, 27.0], 0.65),
        ("bleached", [2.3, 0.0, 0.5, 0.0, 0.1], [76.0, -2.0, 15.0], 0.61),
    ];

    #[test]
    fn states_of_leaves_have_their_colours() {
        let spectrum = Spectrum::new();
        let mut sum = 0.0;
        for (name, [structure, chlorophyll, carotenoid, anthocyanin, brown], expected, ratio) in
            STATES
        {
            let amounts =
                Amounts::of([*chlorophyll, *carotenoid, *anthocyanin, *brown, *structure]);
            let seen = spectrum.seen(&amounts);
            let [l, a, b] = *expected;
            let off = lab(seen.total).distance(Lab::new(l, a, b));
            assert!(off < 2.0, "{name}: {:?}, off by {off}", lab(seen.total));
            sum += off;
            let luminance = |[r, g, b]: Linear| 0.2126 * r + 0.7152 * g + 0.0722 * b;
            let found = luminance(seen.through) / luminance(seen.total);
            assert!((found - ratio).abs() < 0.025, "{name}: T/R {found}");
        }
        assert!(sum / (STATES.len() as f64) < 1.1, "{sum}");
    }

    #[test]
    fn tables_say_what_the_piles_do() {
        let spectrum = Spectrum::new();
        for structure in [1.0, 1.6, 3.2] {
            let table = spectrum.tabulated(structure);
            for pigments in
                [[0.0; 4], [42.0, 9.0, 0.7, 0.0], [3.0, 6.0, 20.0, 0.4], [120.0, 40.0, 60.0, 4.0]]
            {
                let [a, b, c, d] = pigments;
                let exact = spectrum.seen(&Amounts::of([a, b, c, d, structure]));
                let found = table.seen(pigments);
                for c in 0..3 {
                    for (found, exact) in [
                        (found.total[c], exact.total[c]),
                        (found.diffuse[c], exact.diffuse[c]),
                        (found.through[c], exact.through[c]),
                    ] {
                        assert!((found - exact).abs() < 2e-5, "{pigments:?}: {found} {exact}");
                    }
                }
            }
        }
    }

    #[test]
    fn white_paper_is_white_and_the_surface_is_grey() {
        let spectrum = Spectrum::new();
        let white: Linear =
            std::array::from_fn(|c| spectrum.waves.iter().map(|wave| wave.seen[c]).sum());
        assert!(white.iter().all(|v| (v - 1.0).abs() < 1e-12));
        let seen = spectrum.seen(&Amounts::of([40.0, 8.0, 0.5, 0.0, 1.5]));
        for c in 0..3 {
            let surface = seen.total[c] - seen.diffuse[c];
            assert!((0.034..0.045).contains(&surface), "{surface}");
        }
    }

    #[test]
    fn the_curve_and_its_inverse_agree() {
        for i in -50..=60 {
            let value = f64::from(i) / 50.0;
            assert!((decoded(encoded(value)) - value).abs() < 1e-9);
        }
    }
}
