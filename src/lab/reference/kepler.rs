//! Kepler's equation.

/// The eccentric anomaly E of M = E − e·sin E, rad, for 0 ≤ e < 1, by Newton's method.
///
/// M is reduced to −π…π first, where E = M + e·sgn M is a start from which the method comes down monotonically.
pub fn eccentric_anomaly(mean: f64, eccentricity: f64) -> f64 {
    let turns = (mean / std::f64::consts::TAU).round();
    let rest = mean - turns * std::f64::consts::TAU;
    let mut anomaly = rest + eccentricity.copysign(rest);
    for _ in 0..60 {
        let step = (anomaly - eccentricity * anomaly.sin() - rest) / (1.0 - eccentricity * anomaly.cos());
        anomaly -= step;
        if step.abs() < 1e-16 {
            break;
        }
    }
    anomaly + turns * std::f64::consts::TAU
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_anomaly_solves_the_equation() {
        for e in [0.0, 0.5, 0.9, 0.999] {
            for k in -40..40 {
                let mean = 0.31 * f64::from(k);
                let anomaly = eccentric_anomaly(mean, e);
                assert!((anomaly - e * anomaly.sin() - mean).abs() < 1e-14, "e = {e}, M = {mean}");
            }
        }
    }
}
