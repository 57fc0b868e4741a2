//! How fast twins part, and what can be said of many starts where no single course can be told.

use statrs::statistics::{Data, Distribution, OrderStatistics};

use crate::present::timing::fitted_line;

/// How fast a small difference grows, and until when a course can be compared with another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Growth {
    /// λ in δ(t) = δ₀·e^(λt), 1/s; 0 where it does not grow.
    pub rate: f64,
    /// δ₀ by the fit, in the unit of the differences.
    pub start: f64,
}

impl Growth {
    /// The least-squares line through ln δ of a twin, by times in seconds, from the first difference up to `saturated`:
    /// beyond, twins are as far apart as any two states. `None` of fewer than three differences, or of one time.
    pub fn of(times_secs: &[f64], differences: &[f64], saturated: f64) -> Option<Self> {
        let pairs = times_secs.iter().zip(differences);
        let growing = pairs.skip_while(|(_, d)| **d <= 0.0).take_while(|(_, d)| **d > 0.0 && **d < saturated);
        let points: Vec<(f64, f64)> = growing.map(|(t, d)| (*t, d.ln())).collect();
        if points.len() < 3 {
            return None;
        }
        let [rate, at_zero] = fitted_line(&points)?;
        Some(Self { rate: rate.max(0.0), start: at_zero.exp() })
    }

    /// Until then courses may be compared, seconds: ½·ln(tolerance/δ₀)/λ, the half since errors are not the only thing
    /// that grows. Infinite where nothing does.
    pub fn horizon_secs(&self, tolerance: f64) -> f64 {
        if self.rate > 0.0 {
            (0.5 * (tolerance / self.start).ln() / self.rate).max(0.0)
        } else {
            f64::INFINITY
        }
    }
}

/// A number over many starts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ensemble {
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation, by n − 1.
    pub deviation: f64,
    /// Starts.
    pub count: usize,
}

impl Ensemble {
    /// Of one number per start; `None` of fewer than two.
    pub fn of(values: &[f64]) -> Option<Self> {
        let data = Data::new(values.to_vec());
        let deviation = data.std_dev().filter(|_| values.len() > 1)?;
        Some(Self { mean: data.mean()?, deviation, count: values.len() })
    }

    /// |difference of means| over its standard error: under 3, two engines or settings cannot be told apart. 0 where
    /// both are the same number, infinite where they differ and do not scatter.
    pub fn apart(&self, other: &Self) -> f64 {
        let share = |e: &Self| e.deviation * e.deviation / e.count as f64;
        let (difference, error) = ((self.mean - other.mean).abs(), (share(self) + share(other)).sqrt());
        if difference == 0.0 { 0.0 } else { difference / error }
    }
}

/// The value that so many of a hundred do not exceed, between neighbours by their distance (R's type 8). 0 of nothing.
pub fn percentile(values: &[f64], percent: usize) -> f64 {
    if values.is_empty() { 0.0 } else { Data::new(values.to_vec()).percentile(percent) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exponential_shows_its_rate_and_horizon() {
        let times: Vec<f64> = (0..40).map(|k| 0.1 * f64::from(k)).collect();
        // The first state is the same, and beyond 1e-3 it saturates.
        let difference = |t: &f64| if *t == 0.0 { 0.0 } else { (1e-8 * (4.0 * t).exp()).min(2e-3) };
        let differences: Vec<f64> = times.iter().map(difference).collect();
        let growth = Growth::of(&times, &differences, 1e-3).expect("enough points");
        assert!((growth.rate - 4.0).abs() < 1e-9 && (growth.start / 1e-8 - 1.0).abs() < 1e-9, "{growth:?}");
        let horizon = 0.5 * 1e4_f64.ln() / 4.0;
        assert!((growth.horizon_secs(1e-4) - horizon).abs() < 1e-8);
        assert_eq!(growth.horizon_secs(1e-9), 0.0);
    }

    #[test]
    fn what_does_not_grow_can_be_compared_for_ever() {
        let growth = Growth::of(&[0.0, 1.0, 2.0, 3.0], &[2.0, 2.0, 2.0, 2.0], 10.0).expect("enough");
        assert_eq!((growth.rate, growth.horizon_secs(1.0)), (0.0, f64::INFINITY));
        assert_eq!(Growth::of(&[0.0, 1.0], &[1.0, 2.0], 10.0), None);
    }

    #[test]
    fn means_are_told_apart_by_their_scatter() {
        let a = Ensemble::of(&[1.0, 2.0, 3.0]).expect("three");
        assert_eq!((a.mean, a.deviation, a.count), (2.0, 1.0, 3));
        let b = Ensemble::of(&[2.0, 3.0, 4.0]).expect("three");
        assert!((a.apart(&b) - 1.0 / (2.0_f64 / 3.0).sqrt()).abs() < 1e-15);
        assert_eq!(a.apart(&a), 0.0);
        assert_eq!(Ensemble::of(&[1.0]), None);
    }

    #[test]
    fn percentiles_are_between_the_values_they_divide() {
        let values: Vec<f64> = (1..=200).rev().map(f64::from).collect();
        assert_eq!([50, 100].map(|p| percentile(&values, p)), [100.5, 200.0]);
        assert!((198.0..199.0).contains(&percentile(&values, 99)));
        assert_eq!((percentile(&[7.0], 1), percentile(&[], 99)), (7.0, 0.0));
    }
}
