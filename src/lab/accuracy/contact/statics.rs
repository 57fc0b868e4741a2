//! What must stay where it is, and what carries it.

use lamina2d::contact::Contact;

use super::trial::{Run, Trial, relative, worst};
use crate::cases::contact::{CHAIN_LENGTH_M, offset_loads, stack_loads};

/// The contact of two bodies, by their numbers in the scene.
fn between(run: &Run, a: usize, b: usize) -> Option<Contact> {
    // Slot 0 is the world.
    let slots = [a as u32 + 1, b as u32 + 1];
    let is = |contact: &Contact| slots.contains(&contact.a) && slots.contains(&contact.b);
    run.world.contacts().into_iter().find(is)
}

/// Loads of a contact's points from left to right, N; none where there is no contact.
fn loads(contact: Option<Contact>, substep_secs: f64) -> Vec<f64> {
    let mut points = contact.map_or_else(Vec::new, |contact| contact.points);
    points.sort_by(|p, q| p.arm_a[0].total_cmp(&q.arm_a[0]));
    points.iter().map(|point| point.impulse / substep_secs).collect()
}

/// B18: the load under each box over the weight above.
pub(super) fn stack(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let of = |(k, wanted): (usize, f64)| {
        let found: f64 = loads(between(&run, k, k + 1), run.substep_secs()).iter().sum();
        relative(found, wanted)
    };
    Ok(worst(stack_loads(trial.scene).into_iter().enumerate().map(of)))
}

/// B18, off the middle: the load at each point, over that point's.
pub(super) fn offset(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.finish()?;
    let of = |(k, wanted): (usize, [f64; 2])| {
        let found = loads(between(&run, k, k + 1), run.substep_secs());
        let point = |at: usize| relative(found.get(at).copied().unwrap_or(0.0), wanted[at]);
        worst([point(0), point(1)])
    };
    Ok(worst(offset_loads().into_iter().enumerate().map(of)))
}

/// B26: how far any link is from where it rests, over the chain's length.
pub(super) fn sag(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let mut run = trial.begin()?;
    let rests = trial.exact(0.0)?;
    let mut most = 0.0;
    while run.step()? {
        let states = run.world.states();
        let away = rests.iter().map(|exact| {
            let [x, y] = states[exact.body].position;
            (x - exact.position[0]).hypot(y - exact.position[1])
        });
        most = worst(away.chain([most]));
    }
    Ok(most / CHAIN_LENGTH_M)
}

/// B2: 1 % below the limit, how fast the block creeps in the second half, m/s.
pub(super) fn creep(trial: &Trial<'_>) -> anyhow::Result<f64> {
    use crate::cases::contact::{STICK_FRICTION, block_on_slope};
    let mut run = trial.begin_with(&block_on_slope(0.99 * STICK_FRICTION.atan()))?;
    while run.secs() < 0.5 * trial.secs && run.step()? {}
    let (since, from) = (run.secs(), run.body(1).position);
    while run.step()? {}
    let to = run.body(1).position;
    Ok((to[0] - from[0]).hypot(to[1] - from[1]) / (run.secs() - since))
}
