//! Bodies that slide and roll, held against their whole course.

use super::trial::{Trial, relative, worst};
use crate::cases::contact::{GRAVITY, pushed_board_accelerations};

/// Of each body how far it is from where it must be over the way it went, and the chord between attitude and exact
/// attitude over the angle it turned by.
pub(super) fn course(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let states = run.world.states();
    let of = |exact: &crate::cases::Exact| {
        let (spec, state) = (&trial.scene.bodies[exact.body], &states[exact.body]);
        let apart = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
        let (s, c) = exact.angle.sin_cos();
        let (way, turn) = (apart(exact.position, spec.position), (exact.angle - spec.angle).abs());
        let turned = if turn > 0.0 { apart(state.rotation, [c, s]) / turn } else { 0.0 };
        worst([apart(state.position, exact.position) / way, turned])
    };
    Ok(worst(trial.exact(run.secs())?.iter().map(of)))
}

/// B1: way and time to rest. Time is that of the last step in motion and what its speed has left at μg.
pub(super) fn stop(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let block = &trial.scene.bodies[1];
    let slowing = block.friction * GRAVITY;
    let (mut run, mut stops_secs) = (trial.begin()?, 0.0);
    while run.step()? {
        let speed = run.body(1).velocity[0];
        if speed > 1e-3 * block.velocity[0] {
            stops_secs = run.secs() + speed / slowing;
        }
    }
    let way = run.body(1).position[0] - block.position[0];
    let speed = block.velocity[0];
    Ok(worst([relative(way, speed * speed / (2.0 * slowing)), relative(stops_secs, speed / slowing)]))
}

/// B5: the course, and ⅔ of the speed at the end.
pub(super) fn rolls(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let disc = run.body(1);
    let speed = 2.0 / 3.0 * trial.scene.bodies[1].velocity[0];
    Ok(worst([
        course(trial)?,
        relative(disc.velocity[0], speed),
        relative(-disc.angular_velocity * 0.5, speed),
    ]))
}

/// B24: the root of the mean squared difference from at over all steps and bodies, over the board's speed at the end.
pub(super) fn board(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let [board, disc] = pushed_board_accelerations();
    let (mut run, mut sum, mut count) = (trial.begin()?, 0.0, 0.0);
    while run.step()? {
        let t = run.secs();
        for (k, body) in run.world.states().iter().enumerate().skip(1) {
            let wanted = if k == 1 { board } else { disc } * t;
            sum += (body.velocity[0] - wanted).powi(2);
            count += 1.0;
        }
    }
    Ok((sum / count).sqrt() / (board * run.secs()))
}

/// B25: the way a block slips over the belt.
pub(super) fn slip(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let [belt, block] = [0, 1].map(|k| &trial.scene.bodies[k]);
    let run = trial.finish()?;
    let speed = belt.velocity[0];
    let slipped = speed * run.secs() - (run.body(1).position[0] - block.position[0]);
    Ok(relative(slipped, speed * speed / (2.0 * block.friction * GRAVITY)))
}

/// B6: from the first to the third time the disc passes the lowest point.
pub(super) fn bowl(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let angle = |[x, y]: [f64; 2]| x.atan2(-y);
    let (mut run, mut crossings) = (trial.begin()?, Vec::new());
    let mut before = angle(run.last().position);
    while run.step()? {
        let now = angle(run.last().position);
        if before * now < 0.0 {
            crossings.push(run.secs() - trial.settings.dt_secs * now / (now - before));
        }
        before = now;
    }
    // A disc that never comes back has no period.
    let period = crossings.get(2).map_or(f64::INFINITY, |third| third - crossings[0]);
    Ok(relative(period, crate::cases::contact::bowl_period_secs()).min(1.0))
}
