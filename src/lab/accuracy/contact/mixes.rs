//! The four shape mixes: no course of theirs can be told for long, so their error is what stays meaningful.
//!
//! | name ends in | error | source |
//! |---|---|---|
//! | `penetration` | 99th percentile of the depths of all overlaps while the pile comes to rest, over the bodies' median diameter | [`depths`] |
//! | `momentum` | the largest momentum balance of a round of the settling pile | [`momentum_balance`] |
//! | `laws` | 99th percentile of the Signorini or friction residuals of a settling pile's contacts, over mgh of a substep | [`Residuals`] |
//! | `height` | how many standard errors the mean height of 64 piles is from that of finely stepped ones | [`Ensemble`] |
//!
//! Momentum and laws are those of bodies that do not bounce: an impact is over before its impulse can be read.

use std::sync::OnceLock;

use lamina2d::measure::depths;
use lamina2d::measure::momentum::{Pushed, momentum_balance};
use lamina2d::measure::residual::{Residuals, Side};
use lamina2d::scene::mixes::Mix;
use lamina2d::scene::{BodyKind, Scene};
use lamina2d::settings::{Integrator, Precision, Settings, Skips, Solver};
use lamina2d::simulation::{Simulation, simulate};

use super::super::case::{Case, Expect, Method, Norm, Sweep};
use super::trial::{Experiment, Run, Trial, worst};
use crate::reference::chaos::{Ensemble, Growth, percentile};

/// Of a run: bodies have come down after three, and lie after five.
const SECS: f64 = 6.0;
/// Looks at the second half of a run.
const LOOKS: u32 = 12;
/// Starts of an ensemble, and how far a start is from another, of the first body's place, metres.
const STARTS: u32 = 64;
const APART_M: f64 = 1e-6;
/// Rounds in which a twin takes up its impulses before one is balanced.
const WARM_ROUNDS: u32 = 8;
/// Twins begin so far apart, and are as far apart as any from this on, metres.
const TWINS_M: f64 = 1e-8;
const SATURATED_M: f64 = 0.1;

const fn soft(substeps: u32, stiffness: Option<f64>, integrator: Integrator) -> (Method, Expect) {
    (Method { integrator, solver: Some(Solver::Soft), substeps, stiffness }, Expect::Target(0.0))
}

const fn other(solver: Solver, substeps: u32) -> (Method, Expect) {
    let integrator = Integrator::VelocityVerlet;
    (Method { integrator, solver: Some(solver), substeps, stiffness: None }, Expect::Target(0.0))
}

const COUNT: usize = 15;

/// Solvers with the default's integrator, and integrators with the default's solver.
const fn swept(target: f64) -> [(Method, Expect); COUNT] {
    let mut methods = [
        soft(4, None, Integrator::VelocityVerlet),
        soft(1, None, Integrator::VelocityVerlet),
        soft(2, None, Integrator::VelocityVerlet),
        soft(16, None, Integrator::VelocityVerlet),
        soft(4, Some(0.09), Integrator::VelocityVerlet),
        soft(4, Some(0.25), Integrator::VelocityVerlet),
        soft(4, None, Integrator::ExplicitEuler),
        soft(4, None, Integrator::SemiImplicitEuler),
        soft(4, None, Integrator::PositionVerlet),
        soft(4, None, Integrator::Rk4),
        soft(4, None, Integrator::Yoshida4),
        other(Solver::Pgs, 4),
        other(Solver::Impulse, 4),
        other(Solver::Xpbd, 4),
        other(Solver::Avbd, 1),
    ];
    let mut k = 0;
    while k < COUNT {
        methods[k].1 = Expect::Target(target);
        k += 1;
    }
    methods
}

/// 1 % of a diameter: what nobody sees.
const PENETRATION: [(Method, Expect); COUNT] = swept(1e-2);
/// As the list of cases has it, in `f32`.
const MOMENTUM: [(Method, Expect); COUNT] = swept(1e-6);
/// 1 % of a body's weight.
const LAWS: [(Method, Expect); COUNT] = swept(1e-2);
/// Further apart by chance once in 370 times.
const HEIGHT: [(Method, Expect); 4] = [
    (soft(4, None, Integrator::VelocityVerlet).0, Expect::Target(3.0)),
    (soft(1, None, Integrator::VelocityVerlet).0, Expect::Target(3.0)),
    (soft(4, None, Integrator::SemiImplicitEuler).0, Expect::Target(3.0)),
    (other(Solver::Avbd, 1).0, Expect::Target(3.0)),
];

const fn case(
    [name, scene, about]: [&'static str; 3],
    unit: &'static str,
    experiment: Experiment,
    methods: &'static [(Method, Expect)],
    full: u32,
) -> Case {
    Case {
        name,
        item: "M",
        about,
        scene,
        horizon_secs: SECS,
        samples: 1,
        norm: Norm::Own(experiment),
        unit,
        sweep: Sweep::Halvings { coarsest: 60 * SECS as u32, quick: 0, full },
        methods,
    }
}

macro_rules! of_mix {
    ($mix:literal, $words:literal) => {
        [
            case(
                [concat!("m_", $mix, "_penetration"), $mix, concat!("how deep ", $words, " overlap")],
                "diameters",
                penetration,
                &PENETRATION,
                1,
            ),
            case(
                [concat!("m_", $mix, "_momentum"), $mix, concat!("momentum lost or made up among ", $words)],
                "relative",
                momentum,
                &MOMENTUM,
                1,
            ),
            case(
                [concat!("m_", $mix, "_laws"), $mix, concat!("contact laws among ", $words)],
                "mgh",
                laws,
                &LAWS,
                1,
            ),
            case(
                [concat!("m_", $mix, "_height"), $mix, concat!("the height of piles of ", $words)],
                "standard errors",
                height,
                &HEIGHT,
                0,
            ),
        ]
    };
}

const BY_MIX: [[Case; 4]; 4] = [
    of_mix!("circles", "circles"),
    of_mix!("circles_polygons", "circles and polygons"),
    of_mix!("polygons", "polygons"),
    of_mix!("all", "circles, boxes and polygons"),
];

pub(in super::super) const CASES: &[Case] = BY_MIX.as_flattened();

/// The median diameter of what can move, metres.
fn diameter(world: &dyn Simulation) -> f64 {
    let table = world.body_table();
    let radii: Vec<f64> =
        table.bodies.iter().filter(|body| body.kind == BodyKind::Dynamic).map(|body| body.radius).collect();
    2.0 * percentile(&radii, 50)
}

/// Looks at the second half of a run, evenly.
fn looking(
    mut run: Run,
    secs: f64,
    mut look: impl FnMut(&dyn Simulation) -> anyhow::Result<()>,
) -> anyhow::Result<()> {
    let mut looks = 0;
    while run.step()? {
        let due = secs * (0.5 + 0.5 * f64::from(looks + 1) / f64::from(LOOKS));
        if run.secs() >= due - 1e-9 {
            looks += 1;
            look(run.world.as_ref())?;
        }
    }
    Ok(())
}

/// The 99th percentile of depths, over a diameter.
fn penetration(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let (run, mut found) = (trial.begin()?, Vec::new());
    let size = diameter(run.world.as_ref());
    looking(run, trial.secs, |world| {
        found.extend(depths(&world.outlines()));
        Ok(())
    })?;
    Ok(percentile(&found, 99) / size)
}

/// The scene, whose bodies do not bounce.
fn dull(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.bodies.iter_mut().for_each(|body| body.restitution = 0.0);
    scene
}

/// The largest momentum balance of a round of the run's substep.
fn momentum(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.begin_with(&dull(trial.scene))?;
    let (size, mut most) = (diameter(run.world.as_ref()), 0.0);
    let gravity = trial.scene.forces.gravity.unwrap_or_default();
    looking(run, trial.secs, |world| {
        most = worst([most, balance(world, trial.substep_secs(), gravity, size)?]);
        Ok(())
    })?;
    Ok(most)
}

/// Of one round of a twin.
fn balance(world: &dyn Simulation, h_secs: f64, [gx, gy]: [f64; 2], size: f64) -> anyhow::Result<f64> {
    let mut twin = world.duplicate();
    // A manifold that is reused has the levers of when it was found: 1e-3 of the angular momentum of a pile on its way.
    let skips = Skips::EXACT;
    twin.set_settings(Settings { dt_secs: h_secs, substeps: 1, skips, ..*world.settings() })?;
    for _ in 0..WARM_ROUNDS {
        twin.step(h_secs)?;
    }
    let table = twin.body_table();
    let of = |world: &dyn Simulation| -> Vec<Pushed> {
        let slots = 1 + table.bodies.iter().map(|body| body.slot as usize).max().unwrap_or(0);
        let mut bodies = vec![Pushed::default(); slots];
        for (body, state) in table.bodies.iter().zip(world.states()) {
            let ([vx, vy], w) = (state.velocity, state.angular_velocity);
            bodies[body.slot as usize] = Pushed {
                mass: body.mass,
                inertia: body.inertia,
                position: state.position,
                before: [vx, vy, w],
                after: [vx, vy, w],
                force: [body.mass * gx, body.mass * gy, 0.0],
            };
        }
        bodies
    };
    let mut bodies = of(twin.as_ref());
    twin.step(h_secs)?;
    for (body, after) in bodies.iter_mut().zip(of(twin.as_ref())) {
        body.after = after.after;
    }
    // What the step rounds to, as the engine does.
    let h_secs = match world.settings().precision {
        Precision::F32 => f64::from(h_secs as f32),
        Precision::F64 => h_secs,
    };
    Ok(momentum_balance(&bodies, &twin.contacts(), h_secs, size))
}

/// The 99th percentile of residuals over mgh of a substep, m being a body's mass.
fn laws(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let run = trial.begin_with(&dull(trial.scene))?;
    let table = run.world.body_table();
    let (size, mut found) = (diameter(run.world.as_ref()), Vec::new());
    let masses: Vec<f64> = table.bodies.iter().map(|body| body.mass).filter(|mass| *mass > 0.0).collect();
    let [gx, gy] = trial.scene.forces.gravity.unwrap_or_default();
    let unit = percentile(&masses, 50) * gx.hypot(gy) * trial.substep_secs();
    let friction: Vec<f64> = table.bodies.iter().map(|body| body.friction).collect();
    looking(run, trial.secs, |world| {
        let side = |slot: u32| {
            let body = world.body(slot as usize);
            body.map_or_else(Side::default, |body| Side {
                position: body.state.position,
                velocity: body.state.velocity,
                angular_velocity: body.state.angular_velocity,
                inv_mass: body.inv_mass,
                inv_inertia: body.inv_inertia,
                friction: friction[slot as usize - 1],
            })
        };
        for contact in world.contacts() {
            let of = Residuals::of(&[contact], side, unit, size).over(unit, size);
            found.push(of.signorini.max(of.friction));
        }
        Ok(())
    })?;
    Ok(percentile(&found, 99))
}

/// The scene, its first movable body so many metres to the right.
fn nudged(scene: &Scene, by_m: f64) -> Scene {
    let mut scene = scene.clone();
    if let Some(first) = scene.bodies.iter_mut().find(|body| body.kind == BodyKind::Dynamic) {
        first.position[0] += by_m;
    }
    scene
}

/// The mean height of what can move at a run's end, over starts that differ by a micrometre each.
fn heights(trial: &Trial<'_>) -> anyhow::Result<Ensemble> {
    let of = |start: u32| {
        let scene = nudged(trial.scene, APART_M * f64::from(start));
        let mut run = trial.begin_with(&scene)?;
        while run.step()? {}
        let moving = run.world.body_table().bodies.into_iter().map(|body| body.kind == BodyKind::Dynamic);
        let heights: Vec<f64> = run
            .world
            .states()
            .iter()
            .zip(moving)
            .filter_map(|(state, moving)| moving.then_some(state.position[1]))
            .collect();
        Ok(heights.iter().sum::<f64>() / heights.len() as f64)
    };
    let means: Vec<f64> = (0..STARTS).map(of).collect::<anyhow::Result<_>>()?;
    Ensemble::of(&means).ok_or_else(|| anyhow::anyhow!("an ensemble of one"))
}

/// Standard errors between these piles and finely stepped ones.
fn height(trial: &Trial<'_>) -> anyhow::Result<f64> {
    static FINE: [OnceLock<Ensemble>; 4] = [const { OnceLock::new() }; 4];
    let name = trial.scene.name.split('/').next();
    let mix = Mix::ALL.iter().position(|mix| name == Some(mix.name()));
    let fine = &FINE[mix.ok_or_else(|| anyhow::anyhow!("'{}' is no mix", trial.scene.name))?];
    let found = heights(trial)?;
    if let Some(fine) = fine.get() {
        return Ok(found.apart(fine));
    }
    let settings =
        Settings { substeps: 8, dt_secs: 1.0 / 120.0, ..Settings::default().with_precision(Precision::F64) };
    let reference = heights(&Trial { settings, ..*trial })?;
    Ok(found.apart(fine.get_or_init(|| reference)))
}

/// How fast twins of a mix part that begin 10 nm apart, in `f64` with the default settings.
///
/// # Errors
/// A run that does not stay finite.
pub fn growth(mix: Mix) -> anyhow::Result<Option<Growth>> {
    let scene = crate::cases::by_name(mix.name(), None, 1)?;
    let other = nudged(&scene, TWINS_M);
    let settings = Settings::default().with_precision(Precision::F64);
    let mut twins = [simulate(&scene, settings)?, simulate(&other, settings)?];
    let (mut times, mut differences) = (Vec::new(), Vec::new());
    for step in 0..(SECS / settings.dt_secs) as u32 {
        times.push(f64::from(step) * settings.dt_secs);
        let [a, b] = [twins[0].states(), twins[1].states()];
        let apart = a
            .iter()
            .zip(&b)
            .map(|(a, b)| (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1]));
        differences.push(apart.fold(0.0, f64::max));
        for twin in &mut twins {
            twin.step(settings.dt_secs)?;
        }
    }
    Ok(Growth::of(&times, &differences, SATURATED_M))
}
