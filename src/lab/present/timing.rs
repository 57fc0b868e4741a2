//! Statistics of timings.

use serde::Serialize;
use statrs::statistics::{Data, Distribution, Min, OrderStatistics, Statistics as _};

/// Of many steps, ms per step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Timing {
    /// The fastest.
    pub min: f64,
    /// Half are faster.
    pub median: f64,
    /// The mean.
    pub mean: f64,
    /// 99 of 100 are faster.
    pub p99: f64,
}

impl Timing {
    /// Of samples in ms; all NaN where there are none.
    pub fn of(samples_ms: &[f64]) -> Self {
        let mut data = Data::new(samples_ms.to_vec());
        Self {
            min: data.min(),
            median: data.median(),
            mean: data.mean().unwrap_or(f64::NAN),
            p99: data.quantile(0.99),
        }
    }
}

/// The median of samples; NaN where there are none.
pub fn median(samples: &[f64]) -> f64 {
    Data::new(samples.to_vec()).median()
}

/// What so large a share of the samples does not exceed; NaN where there are none.
pub(crate) fn quantile(samples: &[f64], share: f64) -> f64 {
    Data::new(samples.to_vec()).quantile(share)
}

/// The exponent p of y ∝ xᵖ, by least squares on logarithms; `None` below two points.
pub fn fitted_exponent(points: &[(f64, f64)]) -> Option<f64> {
    let logs: Vec<(f64, f64)> = points.iter().map(|(x, y)| (x.ln(), y.ln())).collect();
    fitted_line(&logs).map(|[slope, _]| slope)
}

/// Slope of the least-squares line through points, and its value at 0; `None` where they have fewer than two places.
pub(crate) fn fitted_line(points: &[(f64, f64)]) -> Option<[f64; 2]> {
    let [x, y] = [|point: &(f64, f64)| point.0, |point: &(f64, f64)| point.1].map(|of| points.iter().map(of));
    let slope = x.clone().population_covariance(y.clone()) / x.clone().population_variance();
    slope.is_finite().then(|| [slope, y.mean() - slope * x.mean()])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_samples() {
        let timing = Timing::of(&[1.0, 2.0, 3.0, 4.0, 100.0]);
        assert_eq!((timing.min, timing.median, timing.mean), (1.0, 3.0, 22.0));
        assert!(timing.p99 > 4.0);
    }

    #[test]
    fn exponent_of_a_square_is_two() {
        let points: Vec<_> = [1.0, 2.0, 5.0, 9.0].iter().map(|&x: &f64| (x, 3.0 * x * x)).collect();
        assert!((fitted_exponent(&points).unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(fitted_exponent(&points[..1]), None);
    }
}
