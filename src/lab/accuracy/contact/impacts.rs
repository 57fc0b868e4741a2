//! Bodies that meet: what they do after.

use super::trial::{Run, Trial, relative, worst};
use crate::cases::contact::{
    BILLIARD_SIZE_M, ELASTIC_DROP_M, GRAVITY, after_head_on, after_oblique, cradle_at_once_after,
    cradle_gaps_after, cradle_touching_after, reversed,
};

/// Bounces of B10 whose heights are compared.
const BOUNCES: usize = 4;

/// How high the ball of B10 and B11 will rise or fell from, above the floor, metres: y − r + `v_y`²/2g.
fn rise(run: &Run, radius: f64) -> f64 {
    let ball = run.body(1);
    ball.position[1] - radius + ball.velocity[1].powi(2) / (2.0 * GRAVITY)
}

/// B10: the height after each of four bounces over e²ⁿH. A bounce that does not come is an error of 1.
pub(super) fn heights(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let ball = &trial.scene.bodies[1];
    let (mut run, mut found) = (trial.begin()?, Vec::new());
    let radius = crate::cases::radius(ball);
    let drop = ball.position[1] - radius;
    let mut rising = false;
    while run.step()? {
        let up = run.body(1).velocity[1] > 0.0;
        if rising && !up {
            found.push(rise(&run, radius));
        }
        rising = up;
    }
    let of = |n: usize| {
        let wanted = (0..=n).fold(drop, |height, _| height * ball.restitution.powi(2));
        found.get(n).map_or(1.0, |height| relative(*height, wanted))
    };
    Ok(worst((0..BOUNCES).map(of)))
}

/// Nearer to the floor than this a ball does not bounce any more, metres: what is left of B10 then takes 0.1 ms.
const OFF_FLOOR_M: f64 = 1e-9;

/// B10: the last time the ball is off the floor, over √(2H/g)(1 + e)/(1 − e).
pub(super) fn rest(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let ball = &trial.scene.bodies[1];
    let radius = crate::cases::radius(ball);
    let (mut run, mut last) = (trial.begin()?, 0.0);
    while run.step()? {
        if run.body(1).position[1] - radius > OFF_FLOOR_M {
            last = run.secs();
        }
    }
    let drop = ball.position[1] - radius;
    let e = ball.restitution;
    Ok(relative(last, (2.0 * drop / GRAVITY).sqrt() * (1.0 + e) / (1.0 - e)))
}

/// B11: the largest change of energy over the first.
pub(super) fn energy(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let radius = crate::cases::radius(&trial.scene.bodies[1]);
    let (mut run, mut most) = (trial.begin()?, 0.0);
    while run.step()? {
        most = worst([most, relative(rise(&run, radius), ELASTIC_DROP_M)]);
    }
    Ok(most)
}

fn speeds(run: &Run) -> Vec<f64> {
    run.world.states().iter().map(|body| body.velocity[0]).collect()
}

fn apart(found: &[f64], wanted: &[f64]) -> f64 {
    worst(found.iter().zip(wanted).map(|(found, wanted)| (found - wanted).abs()))
}

/// B12: speeds after, over the speed of closing, 2 m/s.
pub(super) fn head_on(trial: &Trial<'_>) -> anyhow::Result<f64> {
    Ok(apart(&speeds(&trial.finish()?), &after_head_on(trial.scene)) / 2.0)
}

/// B13: velocity and rim speed after, over the speed towards the wall.
pub(super) fn oblique(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let of = |(k, wanted): (usize, [f64; 3])| {
        let (spec, body) = (&trial.scene.bodies[k + 1], run.body(k + 1));
        let rim = crate::cases::radius(spec) * (body.angular_velocity - wanted[2]);
        worst([body.velocity[0] - wanted[0], body.velocity[1] - wanted[1], rim].map(f64::abs))
            / spec.velocity[0]
    };
    Ok(worst(after_oblique(trial.scene).into_iter().enumerate().map(of)))
}

/// B14: speeds, and the speed of the rod's end, over that of the disc before.
pub(super) fn rod(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let (now, before) = (trial.exact(run.secs())?, trial.exact(run.secs() - 0.1)?);
    let of = |k: usize| {
        let body = run.body(now[k].body);
        let speed = (now[k].position[0] - before[k].position[0]) / 0.1;
        let spin = (now[k].angle - before[k].angle) / 0.1;
        worst([body.velocity[0] - speed, body.angular_velocity - spin].map(f64::abs))
    };
    Ok(worst((0..now.len()).map(of)) / trial.scene.bodies[0].velocity[0])
}

/// B16: how far from where the unfolded way has it, over the box.
pub(super) fn billiard(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let exact = trial.exact(run.secs())?;
    let [x, y] = run.last().position;
    Ok((x - exact[0].position[0]).hypot(y - exact[0].position[1]) / BILLIARD_SIZE_M)
}

/// B17, discs apart: speeds after over the first.
pub(super) fn cradle_gaps(trial: &Trial<'_>) -> anyhow::Result<f64> {
    Ok(apart(&speeds(&trial.finish()?), &cradle_gaps_after()))
}

/// B17, discs that touch, against the law of one impact after the other.
pub(super) fn cradle_touching(trial: &Trial<'_>) -> anyhow::Result<f64> {
    Ok(apart(&speeds(&trial.finish()?), &cradle_touching_after()))
}

/// B17, discs that touch, against Newton's law at both contacts at once.
pub(super) fn cradle_at_once(trial: &Trial<'_>) -> anyhow::Result<f64> {
    Ok(apart(&speeds(&trial.finish()?), &cradle_at_once_after()))
}

/// B30: half the time on, and back: the largest distance from where a ball began over its radius.
pub(super) fn back(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let half = Trial { secs: 0.5 * trial.secs, ..*trial };
    let there = half.finish()?.world.states();
    let again = reversed(trial.scene, &there);
    let home = Trial { scene: &again, ..half }.finish()?.world.states();
    let of = |(spec, body): (&lamina2d::scene::BodySpec, &lamina2d::simulation::BodyState)| {
        let [x, y] = spec.position;
        (body.position[0] - x).hypot(body.position[1] - y) / crate::cases::radius(spec)
    };
    Ok(worst(trial.scene.bodies.iter().zip(&home).filter(|(spec, _)| spec.kind != STATIC).map(of)))
}

const STATIC: lamina2d::scene::BodyKind = lamina2d::scene::BodyKind::Static;
