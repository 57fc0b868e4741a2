//! Elliptic integrals and functions by the arithmetic–geometric mean, in `f64`.
//!
//! Source: Abramowitz and Stegun, Handbook of Mathematical Functions, 17.6 (K) and 16.4 (sn, cn, dn). The mean doubles
//! its digits with every round, so that six rounds reach round-off for every modulus up to 1 − 10⁻⁶.

/// Rounds of the mean: two more than any modulus below 1 − 10⁻¹⁰ needs.
const ROUNDS: usize = 10;
/// By so much is the phase doubled on the way.
const DOUBLED: f64 = (1u32 << ROUNDS) as f64;

/// K(k) = ∫₀^½π dφ/√(1 − k² sin² φ), of the modulus k in 0…1 (exclusive).
pub fn complete_first(modulus: f64) -> f64 {
    let (mut a, mut b) = (1.0f64, (1.0 - modulus * modulus).sqrt());
    for _ in 0..ROUNDS {
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
    }
    std::f64::consts::FRAC_PI_2 / a
}

/// sn, cn and dn of u, of the modulus k in 0…1 (exclusive).
pub fn jacobi(u: f64, modulus: f64) -> [f64; 3] {
    let (mut a, mut b) = (1.0f64, (1.0 - modulus * modulus).sqrt());
    let mut ratio = [0.0; ROUNDS];
    for ratio in &mut ratio {
        let half_gap = 0.5 * (a - b);
        (a, b) = (f64::midpoint(a, b), (a * b).sqrt());
        *ratio = half_gap / a;
    }
    let mut phase = DOUBLED * a * u;
    for ratio in ratio.iter().rev() {
        phase = 0.5 * (phase + (ratio * phase.sin()).asin());
    }
    let (s, c) = phase.sin_cos();
    [s, c, (1.0 - (modulus * s).powi(2)).sqrt()]
}

/// Angle of a pendulum let go at rest at `start` rad from its lowest point, after `turns` = t·√(g/L): θ″ = −sin θ.
///
/// sin ½θ = k·sn(t + K), k = sin ½θ₀; the period is 4·K(k).
pub fn pendulum_angle(start: f64, turns: f64) -> f64 {
    let modulus = (0.5 * start).sin().abs();
    let [s, ..] = jacobi(turns + complete_first(modulus), modulus);
    (2.0 * (modulus * s).asin()).copysign(s) * start.signum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Abramowitz and Stegun, table 17.1: K at k² = 0, ½ and 0.99.
    #[test]
    fn complete_integrals_of_the_table() {
        for (square, known) in [
            (0.0f64, std::f64::consts::FRAC_PI_2),
            (0.5, 1.854_074_677_301_372),
            (0.99, 3.695_637_362_989_875),
        ] {
            let found = complete_first(square.sqrt());
            assert!((found - known).abs() < 4e-15 * known, "k² = {square}: {found}");
        }
    }

    /// sn K = 1, sn² + cn² = 1, and d/du sn = cn·dn.
    #[test]
    fn elliptic_functions_obey_their_laws() {
        for k in [0.1, 0.5, 0.9, 0.999] {
            let quarter = complete_first(k);
            assert!((jacobi(quarter, k)[0] - 1.0).abs() < 1e-13);
            for u in [-3.0, 0.3, 1.7, 12.5] {
                let [s, c, d] = jacobi(u, k);
                assert!((s * s + c * c - 1.0).abs() < 1e-14);
                let step = 1e-5;
                let slope = (jacobi(u + step, k)[0] - jacobi(u - step, k)[0]) / (2.0 * step);
                assert!((slope - c * d).abs() < 1e-9, "k = {k}, u = {u}: {slope} for {}", c * d);
                assert!((jacobi(u + 4.0 * quarter, k)[0] - s).abs() < 1e-12);
            }
        }
    }

    /// From 90° the period is 7.4162987·√(L/g), and half of it later the pendulum is on the other side.
    #[test]
    fn a_pendulum_from_level_has_the_known_period() {
        let start = std::f64::consts::FRAC_PI_2;
        let period = 4.0 * complete_first((0.5 * start).sin());
        assert!((period - 7.416_298_709_205_487).abs() < 1e-13, "{period}");
        for (share, angle) in [(0.0, start), (0.25, 0.0), (0.5, -start), (1.0, start)] {
            // Near its turning point the angle goes with the square of the rest.
            assert!((pendulum_angle(start, share * period) - angle).abs() < 1e-7, "{share}");
        }
        assert!((pendulum_angle(-0.3, 2.0) + pendulum_angle(0.3, 2.0)).abs() < 1e-15);
    }
}
