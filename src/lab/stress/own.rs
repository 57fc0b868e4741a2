//! Cases that compare runs, vary the step, or try what should be refused.

use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::simulate;

use super::case::{Own, Trial};
use crate::cases::stress;

/// Gaps of all joints of a chain together, m: what is tighter need not be made tighter, and is near what rounding lets
/// it be.
const TIGHT_M: f64 = 1e-3;

/// T9: what the joints gape with four times the substeps, over what they do with these, or over [`TIGHT_M`].
pub(super) const TIGHTER: Own = Own {
    what: "gaps with 4 × the substeps over those without, or over 1 mm",
    most: 0.25,
    of: |trial, seen| {
        let settings = Settings { substeps: 4 * trial.settings.substeps, ..trial.settings };
        let finer = Trial { settings, ..*trial }.watch(&(trial.case.build)(trial.value))?;
        Ok(if finer.failed.is_some() { f64::NAN } else { finer.stretch / seen.stretch.max(TIGHT_M) })
    },
};

/// T21: drift in the second half over the distance of neighbouring numbers there.
pub(super) const ULPS: Own = Own {
    what: "drift, units in the last place",
    most: 2.0,
    of: |trial, seen| {
        let ulp = match trial.settings.precision {
            Precision::F32 => {
                let at = trial.value as f32;
                f64::from(at.next_up() - at)
            }
            Precision::F64 => trial.value.next_up() - trial.value,
        };
        Ok(seen.metrics.drift / ulp)
    },
};

/// T23: the farthest a body is from where the same pyramid of boxes of 1 m has it, in boxes.
pub(super) const SIMILAR: Own = Own {
    what: "away from the pyramid of 1 m, boxes",
    most: 1e-3,
    of: |trial, seen| {
        let steps = (trial.secs / seen.scene.dt_secs).round();
        let large = stress::scaled(1.0);
        let secs = steps * large.dt_secs;
        let other = Trial { value: 1.0, secs, ..*trial }.watch(&large)?;
        let apart = seen.moved().zip(other.moved()).map(|((_, small), (_, large))| {
            let [x, y] = [0, 1].map(|k| small.position[k] / trial.value - large.position[k]);
            x.hypot(y)
        });
        Ok(apart.fold(0.0, f64::max))
    },
};

/// T24: ids that are wrong, bodies that are out, megabytes that the process has grown by since a tenth of the time.
pub(super) const CHURN: Own = Own {
    what: "wrong ids + escaped bodies + MB grown",
    most: 4.0,
    of: |trial, _| super::churn::churned(trial),
};

/// T26: steps of 1/240 to 1/15 s in no order, each tenth of 1/10 s.
pub(super) fn uneven(step: u64) -> f64 {
    if step % 10 == 9 {
        return 0.1;
    }
    // A multiplicative walk through the exponents −1 to 1.
    let share = (step.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40) as f64 / (1u64 << 24) as f64;
    4f64.powf(2.0 * share - 1.0) / 60.0
}

/// T27: how far any body is from its straight line, over the way it has come; and what momenta have changed by.
pub(super) const STRAIGHT: Own = Own {
    what: "off the line or the momenta, relative, over n·ε",
    most: 1.0,
    of: |trial, seen| {
        let steps = (trial.secs / seen.scene.dt_secs).round();
        let secs = steps * seen.scene.dt_secs;
        let off = seen.moved().map(|(start, end)| {
            let [x, y] = [0, 1].map(|k| end.position[k] - start.position[k] - secs * start.velocity[k]);
            x.hypot(y) / (secs * start.velocity[0].hypot(start.velocity[1]))
        });
        let off = off.fold(0.0, f64::max);
        let [before, after] = seen.sums;
        let scale = seen.moved().map(|(start, _)| start.velocity[0].hypot(start.velocity[1])).sum::<f64>();
        let lost = [0, 1].map(|k| (after.momentum[k] - before.momentum[k]).abs() / scale);
        let epsilon = match trial.settings.precision {
            Precision::F32 => f64::from(f32::EPSILON),
            Precision::F64 => f64::EPSILON,
        };
        Ok(off.max(lost[0]).max(lost[1]) / (steps * epsilon))
    },
};

/// T28: how many of what is hardly a shape are neither refused nor stay finite; those that are thin, thinner by a share.
pub(super) const REFUSED: Own = Own {
    what: "neither refused nor finite",
    most: 0.0,
    of: |trial, seen| {
        let floor = seen.scene.bodies[0].clone();
        let share = trial.value;
        let polygon = |outline: &[[f64; 2]]| BodySpec::new(ShapeSpec::Polygon(outline.to_vec()), [0.0, 2.0]);
        let doubtful = [
            polygon(&[[-1.0, 0.0], [1.0, 0.0], [0.0, 1e-5 * share]]),
            polygon(&[[-1.0, 0.0], [1.0, 0.0], [1.0, 1e-3 * share], [-1.0, 2e-3 * share]]),
            polygon(&[[-1.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
            polygon(&[[-1.0, 0.0], [0.0, 0.0], [1.0, 0.0]]),
            BodySpec::new(ShapeSpec::Box([1.0, 1e-6 * share]), [0.0, 2.0]),
            BodySpec::new(ShapeSpec::Box([0.0, 1.0]), [0.0, 2.0]),
            BodySpec::new(ShapeSpec::Circle(1e-9 * share), [0.0, 2.0]),
            BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 2.0]).mass(0.0),
            BodySpec::new(ShapeSpec::Circle(0.5), [0.0, 2.0]).mass(f64::NAN),
        ];
        let mut wrong = 0;
        for body in doubtful {
            let scene = Scene { bodies: vec![floor.clone(), body], ..seen.scene.clone() };
            let settings = Settings { dt_secs: scene.dt_secs, ..trial.settings };
            let Ok(mut world) = simulate(&scene, settings) else { continue };
            let finite = (0..300).all(|_| world.step(scene.dt_secs).is_ok());
            wrong += u32::from(!finite);
        }
        Ok(f64::from(wrong))
    },
};
