//! Ordinary differential equations to round-off, for references: Gragg's midpoint rule, extrapolated.
//!
//! Source: Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, II.9. The error of the modified midpoint
//! rule has even powers of the step alone, so that each column of the table gains two orders: eight columns, order 16.

/// Midpoint steps per row of the table.
const ROWS: [usize; 8] = [2, 4, 6, 8, 10, 12, 14, 16];

/// The slope of a state, written into the second argument.
pub type Slope<'a> = &'a dyn Fn(&[f64], &mut [f64]);

/// The state after `secs` seconds in `steps` extrapolated steps of order 16 (2 × 36 slopes each).
pub fn extrapolated(slope: Slope<'_>, start: &[f64], secs: f64, steps: u32) -> Vec<f64> {
    let h = secs / f64::from(steps);
    let (mut state, mut rest) = (start.to_vec(), vec![0.0; start.len()]);
    for _ in 0..steps {
        let change = step(slope, &state, h);
        // Compensated: thousands of steps would round more than they err (Kahan, 1965).
        for k in 0..state.len() {
            let wanted = change[k] + rest[k];
            let sum = state[k] + wanted;
            rest[k] = wanted - (sum - state[k]);
            state[k] = sum;
        }
    }
    state
}

/// What one extrapolated step changes a state by.
fn step(slope: Slope<'_>, state: &[f64], h: f64) -> Vec<f64> {
    // The entries of a row: the midpoint rule, then each column two orders better than the one before.
    let mut last: Vec<Vec<f64>> = Vec::new();
    for (row, &count) in ROWS.iter().enumerate() {
        let mut entries = vec![midpoint(slope, state, h, count)];
        for column in 1..=row {
            // Aitken and Neville in h².
            let ratio = (count as f64 / ROWS[row - column] as f64).powi(2) - 1.0;
            let (fine, coarse) = (&entries[column - 1], &last[column - 1]);
            let better = fine.iter().zip(coarse).map(|(fine, coarse)| fine + (fine - coarse) / ratio);
            entries.push(better.collect());
        }
        last = entries;
    }
    last.pop().unwrap_or_default()
}

/// What Gragg's rule of `count` steps changes a state by.
fn midpoint(slope: Slope<'_>, state: &[f64], h: f64, count: usize) -> Vec<f64> {
    let part = h / count as f64;
    let mut rate = vec![0.0; state.len()];
    let mut at = state.to_vec();
    slope(state, &mut rate);
    // Changes since the start, so that small steps do not round away.
    let mut before = vec![0.0; state.len()];
    let mut now: Vec<f64> = rate.iter().map(|r| part * r).collect();
    for _ in 1..count {
        for k in 0..at.len() {
            at[k] = state[k] + now[k];
        }
        slope(&at, &mut rate);
        for k in 0..at.len() {
            (before[k], now[k]) = (now[k], before[k] + 2.0 * part * rate[k]);
        }
    }
    for k in 0..at.len() {
        at[k] = state[k] + now[k];
    }
    slope(&at, &mut rate);
    // Gragg's smoothing step.
    (0..at.len()).map(|k| 0.5 * (before[k] + now[k] + part * rate[k])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle, once round: the error falls by 2¹⁶ per halving until it is round-off.
    #[test]
    fn extrapolation_is_of_order_sixteen() {
        let swing = |y: &[f64], d: &mut [f64]| (d[0], d[1]) = (y[1], -y[0]);
        let error = |steps| {
            let end = extrapolated(&swing, &[1.0, 0.0], std::f64::consts::TAU, steps);
            (end[0] - 1.0).hypot(end[1])
        };
        let [coarse, fine] = [error(1), error(2)];
        assert!((coarse / fine).log2() > 14.0, "{coarse:e} to {fine:e}");
        // The table's ratios make round-off of the first rows ten times as large.
        assert!(error(16) < 1e-13, "{:e}", error(16));
    }
}
