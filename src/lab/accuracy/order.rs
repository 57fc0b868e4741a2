//! The order a line of errors shows.

use crate::present::fitted_exponent;

/// An order is fitted over at least so many halvings.
pub const MIN_HALVINGS: usize = 4;

/// How far an observed order may be from the table's.
pub const TOLERANCE: f64 = 0.15;

/// An error this many times round-off is still the method's own.
const ABOVE_ROUND_OFF: f64 = 50.0;
/// An error this many times the reference's floor moves the slope over five points by a fiftieth at most.
const ABOVE_FLOOR: f64 = 12.5;

/// An error above this is not yet in the range where a step's order shows.
const ASYMPTOTIC: f64 = 0.3;

/// An observed order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Order {
    /// The exponent p of error ∝ hᵖ.
    pub order: f64,
    /// Halvings it is fitted over.
    pub halvings: usize,
}

impl Order {
    /// Of points (h, error) from the longest step to the shortest, each half of the one before: the slope over the
    /// last [`MIN_HALVINGS`] halvings that are well above the floor of round-off, which grows with the steps taken.
    ///
    /// `None` where there are not so many: errors that jump about at the floor have no order.
    pub(super) fn of(points: &[(f64, f64)], horizon_secs: f64, floor: f64) -> Option<Self> {
        let clear = |&&(h, error): &&(f64, f64)| {
            // Round-off adds up like a walk at best, like a march at worst: here in between.
            let round_off = f64::EPSILON * (horizon_secs / h).powf(0.75);
            error > (ABOVE_ROUND_OFF * round_off).max(ABOVE_FLOOR * floor)
        };
        let count = points.iter().take_while(clear).count();
        let first = count.checked_sub(MIN_HALVINGS + 1)?;
        let fitted = &points[first..count];
        if fitted[0].1 > ASYMPTOTIC {
            return None;
        }
        fitted_exponent(fitted).map(|order| Self { order, halvings: MIN_HALVINGS })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_shows_its_order_above_the_floor_alone() {
        let points = |floor: f64| -> Vec<(f64, f64)> {
            (3..13).map(|k| 0.5f64.powi(k)).map(|h| (h, (0.3 * h.powi(4)).max(floor))).collect()
        };
        let order = Order::of(&points(1e-13), 2.0, f64::EPSILON).unwrap();
        assert!((order.order - 4.0).abs() < 1e-9, "{order:?}");
        assert_eq!(Order::of(&points(1e-6), 2.0, 1e-6), None, "the floor of the reference hides it");
        assert_eq!(Order::of(&points(0.0)[..4], 2.0, f64::EPSILON), None, "three halvings");
    }
}
