//! A leaf as a pile of absorbing plates: how much light of one wavelength it sends back and lets
//! through.
//!
//! Source: PROSPECT (S. Jacquemoud, F. Baret, "PROSPECT: a model of leaf optical properties spectra",
//! Remote Sens. Environ. 34, 1990), with the interfaces after F. Stern (1964) and W. Allen (1973) and
//! the pile after G. Stokes (1862). `structure` is N, the number of plates, any real number from 1.

/// What becomes of the light of one wavelength that falls on a leaf; the rest is absorbed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattered {
    /// Share sent back, the mirror part of the upper surface included.
    pub reflected: f64,
    /// Share let through.
    pub transmitted: f64,
}

/// The interfaces of a plate of one refractive index.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interfaces {
    /// Share of light from a cone of 40° that enters the first plate.
    enters: f64,
    /// Share of diffuse light that enters a plate, and that leaves it.
    enters_diffuse: f64,
    leaves_diffuse: f64,
}

/// Half-angle of the light on the leaf (degrees): the rough surface spreads it that far.
const CONE_DEG: f64 = 40.0;

impl Interfaces {
    /// The interfaces between air and tissue of the refractive index `n` (above 1).
    #[must_use]
    pub fn new(n: f64) -> Self {
        let enters_diffuse = mean_transmissivity(90.0, n);
        Self {
            enters: mean_transmissivity(CONE_DEG, n),
            enters_diffuse,
            leaves_diffuse: enters_diffuse / (n * n),
        }
    }

    /// The mirror part of the reflectance: what never entered the leaf.
    #[must_use]
    pub fn surface(&self) -> f64 {
        1.0 - self.enters
    }

    /// Reflectance and transmittance of `structure` plates that absorb with the coefficient
    /// `absorption` in all.
    #[must_use]
    pub fn pile(&self, structure: f64, absorption: f64) -> Scattered {
        let k = (absorption / structure).max(1e-9);
        let tau = (1.0 - k) * libm::exp(-k) + k * k * exponential_integral(k);
        let (t12, t21) = (self.enters_diffuse, self.leaves_diffuse);
        let (r12, r21) = (1.0 - t12, 1.0 - t21);
        let echo = 1.0 - r21 * r21 * tau * tau;
        // The plate that is lit by the cone, and a plate that is lit from everywhere.
        let first_t = self.enters * tau * t21 / echo;
        let first_r = self.surface() + r21 * tau * first_t;
        let t = t12 * tau * t21 / echo;
        let r = r12 + r21 * tau * t;
        // Stokes: the N − 1 plates below the first.
        let d = ((1.0 + r + t) * (1.0 + r - t) * (1.0 - r + t) * (1.0 - r - t)).max(0.0).sqrt();
        let a = (1.0 + r * r - t * t + d) / (2.0 * r);
        let b = (1.0 - r * r + t * t + d) / (2.0 * t.max(1e-12));
        let bn = libm::pow(b, structure - 1.0);
        let below = a * a * bn * bn - 1.0;
        let (rest_r, rest_t) = if below.is_finite() && below > 0.0 {
            (a * (bn * bn - 1.0) / below, bn * (a * a - 1.0) / below)
        } else {
            (1.0 / a, 0.0)
        };
        let between = 1.0 - rest_r * r;
        Scattered {
            reflected: first_r + first_t * rest_r * t / between,
            transmitted: first_t * rest_t / between,
        }
    }
}

/// Share of light from a cone of `alpha_deg` that passes into a medium of the index `n`, averaged over
/// the cone and both polarisations (Stern 1964, as PROSPECT writes it).
fn mean_transmissivity(alpha_deg: f64, n: f64) -> f64 {
    let n2 = n * n;
    let (p, m) = (n2 + 1.0, n2 - 1.0);
    let a = (n + 1.0).powi(2) / 2.0;
    let k = -m * m / 4.0;
    let sin2 = libm::pow(libm::sin(alpha_deg.to_radians()), 2.0);
    let b2 = sin2 - p / 2.0;
    let b1 = if alpha_deg < 90.0 { (b2 * b2 + k).max(0.0).sqrt() } else { 0.0 };
    let b = b1 - b2;
    let s_part = |x: f64| k * k / (6.0 * x.powi(3)) + k / x - x / 2.0;
    let s = s_part(b) - s_part(a);
    let (pa, pb) = (2.0 * p * a - m * m, 2.0 * p * b - m * m);
    let p1 = -2.0 * n2 * (b - a) / (p * p);
    let p2 = -2.0 * n2 * p * libm::log(b / a) / (m * m);
    let p3 = n2 * (1.0 / b - 1.0 / a) / 2.0;
    let p4 = 16.0 * n2 * n2 * (n2 * n2 + 1.0) * libm::log(pb / pa) / (p.powi(3) * m * m);
    let p5 = 16.0 * n2.powi(3) * (1.0 / pb - 1.0 / pa) / p.powi(3);
    (s + p1 + p2 + p3 + p4 + p5) / (2.0 * sin2)
}

/// E₁(x) = ∫ₓ^∞ e⁻ᵗ / t dt for x > 0: a series below 1, a continued fraction above.
fn exponential_integral(x: f64) -> f64 {
    const EULER: f64 = 0.577_215_664_901_532_9;
    if x <= 1.0 {
        let (mut term, mut sum) = (1.0, 0.0);
        for k in 1..20 {
            term *= -x / f64::from(k);
            sum -= term / f64::from(k);
        }
        sum - libm::log(x) - EULER
    } else {
        let fraction =
            (1..=30).rev().fold(0.0, |rest, k| f64::from(k) / (1.0 + f64::from(k) / (x + rest)));
        libm::exp(-x) / (x + fraction)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponential_integral_has_its_known_values() {
        for (x, expected) in [(0.1, 1.822_923_958), (1.0, 0.219_383_934), (3.0, 0.013_048_381)] {
            let found = exponential_integral(x);
            assert!((found - expected).abs() < 1e-7, "{x}: {found}");
        }
    }

    #[test]
    fn a_cone_of_no_width_is_fresnel_at_right_angles() {
        let n: f64 = 1.45;
        let upright = 1.0 - ((n - 1.0) / (n + 1.0)).powi(2);
        assert!((mean_transmissivity(1.0, n) - upright).abs() < 1e-4);
        assert!(mean_transmissivity(90.0, n) < upright);
    }

    #[test]
    fn light_is_never_made_and_clear_plates_lose_none() {
        let interfaces = Interfaces::new(1.47);
        for structure in [1.0, 1.5, 2.4, 3.2] {
            let clear = interfaces.pile(structure, 0.0);
            assert!((clear.reflected + clear.transmitted - 1.0).abs() < 1e-6, "{clear:?}");
            let mut last = 1.0;
            for absorption in [0.1, 0.5, 2.0, 10.0, 60.0] {
                let Scattered { reflected, transmitted } = interfaces.pile(structure, absorption);
                let sum = reflected + transmitted;
                assert!(sum < last && transmitted >= 0.0 && reflected >= interfaces.surface());
                last = sum;
            }
        }
    }

    #[test]
    fn two_plates_are_a_plate_on_a_plate() {
        // The sum of all echoes between two plates, term by term, against Stokes' closed form.
        let interfaces = Interfaces::new(1.5);
        let whole = interfaces.pile(2.0, 1.2);
        let single = |enters: f64| {
            let one = Interfaces { enters, ..interfaces };
            let one = one.pile(1.0, 0.6);
            (one.reflected, one.transmitted)
        };
        let ((ra, ta), (r, t)) = (single(interfaces.enters), single(interfaces.enters_diffuse));
        let (mut down, mut up, mut reflected, mut transmitted) = (ta, 0.0, ra, 0.0);
        for _ in 0..60 {
            transmitted += down * t;
            up += down * r;
            reflected += up * t;
            (down, up) = (up * r, 0.0);
        }
        assert!((whole.reflected - reflected).abs() < 1e-9, "{whole:?} {reflected}");
        assert!((whole.transmitted - transmitted).abs() < 1e-9, "{whole:?} {transmitted}");
    }
}
