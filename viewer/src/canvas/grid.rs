//! The grid: lines at round numbers of metres.

use eframe::egui::{Align2, Pos2};

use super::{Brush, Scenery};

/// Lines are at least this far apart, points.
const APART: f64 = 70.0;

/// The least of 1, 2 or 5 times a power of ten that is no less than `least`.
fn round_up(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|digit| digit * power)
        .find(|step| *step >= least * 0.999)
        .unwrap_or(least)
}

/// A length as people write it, with its unit.
fn metres(value: f64, step: f64) -> String {
    let value = if value == 0.0 { 0.0 } else { value };
    if step < 1e-3 {
        return format!("{value:.1e} m");
    }
    let digits = if step >= 1.0 { 0 } else { (-step.log10()).ceil() as usize };
    format!("{value:.digits$} m")
}

/// Draws the lines; returns the words for their ends.
pub(super) fn draw(brush: &mut Brush, scenery: &Scenery<'_>) -> Vec<(Pos2, Align2, String)> {
    let (rect, palette) = (scenery.rect, &scenery.palette);
    let step = round_up(APART / scenery.camera.points_per_metre);
    let low = scenery.camera.world(rect, rect.left_bottom());
    let high = scenery.camera.world(rect, rect.right_top());
    let mut labels = Vec::new();
    for axis in 0..2 {
        let (first, last) = ((low[axis] / step).ceil(), (high[axis] / step).floor());
        let count = (last - first).clamp(-1.0, 400.0);
        let lines = if count.is_finite() { (count + 1.0) as u32 } else { 0 };
        for k in 0..lines {
            let value = (first + f64::from(k)) * step;
            let at = scenery.screen([value; 2]);
            let color = if value == 0.0 { palette.axis } else { palette.grid };
            if axis == 0 {
                brush.line(Pos2::new(at.x, rect.top()), Pos2::new(at.x, rect.bottom()), color, 0.5);
                let place = Pos2::new(at.x + 3.0, rect.bottom() - 2.0);
                labels.push((place, Align2::LEFT_BOTTOM, metres(value, step)));
            } else {
                brush.line(Pos2::new(rect.left(), at.y), Pos2::new(rect.right(), at.y), color, 0.5);
                if at.y < rect.bottom() - 26.0 && at.y > rect.top() + 30.0 {
                    let place = Pos2::new(rect.left() + 3.0, at.y - 1.0);
                    labels.push((place, Align2::LEFT_BOTTOM, metres(value, step)));
                }
            }
        }
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (least, step) in [(0.7, 1.0), (1.0, 1.0), (1.1, 2.0), (2.5, 5.0), (0.06, 0.1), (70.0, 100.0)] {
            assert!((round_up(least) - step).abs() < 1e-12 * step, "{least}");
        }
        assert_eq!(metres(-0.0, 1.0), "0 m");
        assert_eq!(metres(0.25, 0.05), "0.25 m");
        assert_eq!(metres(3e-5, 1e-5), "3.0e-5 m");
    }
}
