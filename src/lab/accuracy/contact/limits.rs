//! Limits, found by halving: the angle, the overhang, the thickness at which something gives way.

use super::trial::{Trial, edge, relative};
use crate::cases::contact::{
    ARCH_LIMIT, LOOP_RADIUS_M, STICK_FRICTION, TOPPLE_RATIO, arch, block_on_slope, box_on_slope, loop_at,
    overhang,
};

/// B2: the steepest slope a block stays on, rad from atan μ.
pub(super) fn stick(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let exact = STICK_FRICTION.atan();
    let stays = |angle: f64| {
        let mut run = trial.begin_with(&block_on_slope(angle))?;
        while run.step()? {}
        let [vx, vy] = run.body(1).velocity;
        // Beyond the limit by δ it goes at gδt/cos θ.
        Ok(vx.hypot(vy) < 1e-4)
    };
    Ok((edge([0.5 * exact, 1.5 * exact], 1e-6, stays)? - exact).abs())
}

/// B3: tan of the steepest slope a box stands on, over its width over height.
pub(super) fn topple(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let exact = TOPPLE_RATIO.atan();
    let stands = |angle: f64| {
        let mut run = trial.begin_with(&box_on_slope(angle))?;
        while run.step()? {}
        let [c, s] = run.body(1).rotation;
        Ok((s * angle.cos() - c * angle.sin()).abs() < 0.01)
    };
    Ok(relative(edge([0.8 * exact, 1.2 * exact], 1e-6, stands)?.tan(), TOPPLE_RATIO))
}

/// Does the disc go round, in touch with the loop, until half a radian past the top?
fn goes_round(trial: &Trial<'_>, height: f64, rolls: bool) -> anyhow::Result<bool> {
    let mut run = trial.begin_with(&loop_at(height, rolls))?;
    let mut behind = false;
    while run.step()? {
        let [x, y] = run.last().position;
        if x.hypot(y) < 0.998 * LOOP_RADIUS_M {
            return Ok(false);
        }
        behind |= x > 0.0 && y > 0.0;
        // From the top on: the angle past it.
        if behind && x < 0.0 && (-x).atan2(y) > 0.5 {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Least height, in radii, from which a disc goes round, over the exact one.
fn round(trial: &Trial<'_>, exact: f64, rolls: bool) -> anyhow::Result<f64> {
    let falls = |radii: f64| Ok(!goes_round(trial, radii * LOOP_RADIUS_M, rolls)?);
    Ok(relative(edge([0.9 * exact, 1.3 * exact], 1e-4, falls)?, exact))
}

/// B8: sliding.
pub(super) fn loop_sliding(trial: &Trial<'_>) -> anyhow::Result<f64> {
    round(trial, 2.5, false)
}

/// B8: rolling.
pub(super) fn loop_rolling(trial: &Trial<'_>) -> anyhow::Result<f64> {
    round(trial, 2.75, true)
}

/// The furthest any body has come down, metres, after the trial's time.
fn fallen(trial: &Trial<'_>, scene: &lamina2d::scene::Scene) -> anyhow::Result<f64> {
    let mut run = trial.begin_with(scene)?;
    let heights = |run: &super::trial::Run| -> Vec<f64> {
        run.world.states().iter().map(|body| body.position[1]).collect()
    };
    let before = heights(&run);
    while run.step()? {}
    let after = heights(&run);
    Ok(before.iter().zip(&after).map(|(before, after)| before - after).fold(0.0, f64::max))
}

/// B21: the share of the harmonic overhang that stands.
pub(super) fn overhangs(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let stands = |share: f64| Ok(fallen(trial, &overhang(share))? < 0.05);
    Ok(relative(edge([0.8, 1.2], 1e-3, stands)?, 1.0))
}

/// B22: the least thickness over radius of an arch that stands.
pub(super) fn thickness(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let falls = |ratio: f64| Ok(fallen(trial, &arch(ratio))? > 0.25);
    Ok(relative(edge([0.05, 0.2], 2e-4, falls)?, ARCH_LIMIT))
}
