//! When two shapes on their ways meet.

use glam::DVec2;

use super::sweep::{Course, Sweep};
use crate::seams::Outline;

/// Advances after which a body is stopped where it is known not to have met anything yet.
const ADVANCES: usize = 64;

/// How near counts, metres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// Pairs this near as a step begins are the solver's.
    pub(super) touching: f64,
    /// The separation bodies are stopped at.
    pub(super) target: f64,
    /// What a search may miss the target by.
    pub(super) tolerance: f64,
    /// Bodies that end their way no nearer than this go it to its end.
    pub(super) clear: f64,
    /// Radius of the disc about the centroid that never gets in, metres.
    pub(super) core: f64,
}

impl Reach {
    pub(super) fn new(skin_m: f64, hears_of_gaps: bool, core: f64, course: &Course, epsilon: f64) -> Self {
        let coordinate = course.x.abs().max_element() + course.moved.abs().max_element();
        let skin = skin_m.min(core / 50.0).max(16.0 * epsilon * coordinate);
        let (touching, target) = if hears_of_gaps { (2.0 * skin, 0.5 * skin) } else { (0.0, -skin) };
        let tolerance = 0.25 * skin;
        Self { touching, target, tolerance, clear: target.min(-tolerance), core }
    }

    /// For the core: no contact knows of it, so it is stopped however near it begins.
    pub(super) fn of_core(self) -> Self {
        let target = 2.0 * self.tolerance;
        Self { touching: 0.0, target, clear: target, ..self }
    }
}

/// When a fast body meets an obstacle, as a share of the step. A pair that touches from the beginning is the
/// solver's, which stops points and not what turns about them: there only the body's core is held back.
pub(super) fn impact(body: &Sweep, obstacle: &Sweep, reach: &Reach) -> Option<(f64, DVec2)> {
    match approach(body, obstacle, reach) {
        Approach::Meets(t, axis) => Some((t, axis)),
        Approach::Passes => None,
        Approach::Touching => match approach(&body.core(reach.core), obstacle, &reach.of_core()) {
            Approach::Meets(t, axis) => Some((t, axis)),
            Approach::Passes | Approach::Touching => None,
        },
    }
}

/// Is what a body meets at a time a part of an outline that can be touched? A face that a neighbour covers stops nobody.
pub(super) fn touches(body: &Sweep, t: f64, outline: &Outline, reach: &Reach) -> Option<DVec2> {
    let near = reach.target.max(0.0) + 4.0 * reach.tolerance;
    // What begins near the surface is the solver's, as it is for other pairs: it slides.
    let begun = body.at(0.0);
    let met = outline.meet(&body.at(t), near).filter(|met| met.outside(&begun) > reach.touching)?;
    Some(-met.normal)
}

/// How two bodies come to each other in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Approach {
    /// As near as wanted, for the first time at this share of it; along this axis, from the one to the other.
    Meets(f64, DVec2),
    /// Never as near.
    Passes,
    /// Near from the beginning.
    Touching,
}

/// See the module's documentation.
pub(super) fn approach(a: &Sweep, b: &Sweep, reach: &Reach) -> Approach {
    let (of_a, of_b) = (&a.course, &b.course);
    let (velocity, spin) = (of_b.moved - of_a.moved, of_a.spin_speed() + of_b.spin_speed());
    let (mut t, mut last) = (0.0, DVec2::Y);
    for _ in 0..ADVANCES {
        let (placed_a, placed_b) = (a.at(t), b.at(t));
        let to_b = placed_b.centre - placed_a.centre;
        let (mut separation, mut nearest, mut wait, mut clear) = (f64::MIN, DVec2::Y, 0.0f64, false);
        // Of the separation along an axis that turns with `b`, of whose shape it then always sees the same.
        let (left, distance) = (1.0 - t, to_b.length());
        let swerve = of_b.angle.abs() * left * (2.0 * velocity.length() + of_b.angle.abs() * distance);
        let relative = if a.count == 0 { 0.0 } else { (of_b.angle - of_a.angle).abs() * of_a.radius };
        let turning =
            |axis: DVec2| relative + swerve - axis.dot(velocity) - of_b.angle * axis.perp().dot(to_b);
        let mut along = |axis: DVec2, turns: bool| {
            let apart = axis.dot(to_b) - placed_a.extent(axis) - placed_b.extent(-axis);
            if separation < apart {
                (separation, nearest) = (apart, axis);
            }
            let fixed = spin - axis.dot(velocity);
            let closing = if turns { fixed.min(turning(axis)) } else { fixed };
            clear |= apart > reach.touching && apart - reach.clear >= closing * (1.0 - t);
            let spare = apart - reach.target;
            if spare > 0.0 {
                wait = wait.max(if closing > 0.0 { spare / closing } else { f64::INFINITY });
            }
        };
        placed_a.normals().for_each(|axis| along(axis, false));
        placed_b.normals().for_each(|axis| along(-axis, of_b.angle != 0.0));
        if a.count == 0 {
            along(placed_a.towards(&placed_b), false);
        } else if b.count == 0 {
            along(-placed_b.towards(&placed_a), false);
        }
        last = nearest;
        if t == 0.0 && separation <= reach.touching {
            return Approach::Touching;
        }
        if wait == f64::INFINITY || clear {
            return Approach::Passes;
        }
        if separation <= reach.target + reach.tolerance {
            return Approach::Meets(t, nearest);
        }
        t += wait;
        if t >= 1.0 {
            return Approach::Passes;
        }
    }
    Approach::Meets(t, last)
}
