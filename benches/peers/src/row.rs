//! What is said of a run, measured by the same `f64` code on every engine's states.

use lamina::cases::case_error;
use lamina::report::Timing;
use lamina2d::joint::{Joint, JointKind};
use lamina2d::measure::{hash_of, penetration};
use lamina2d::scene::{BodyKind, Scene};
use lamina2d::shape::Shape;
use lamina2d::simulation::BodyState;
use serde::Serialize;

use crate::blueprint::Blueprint;
use crate::engine::{Engine, Setup};

/// One engine on one scene.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The scene.
    pub scene: String,
    /// Its bodies, static ones included.
    pub bodies: usize,
    /// The engine.
    pub engine: &'static str,
    /// Its version.
    pub version: String,
    /// Threads it was given.
    pub threads: usize,
    /// What it was run with beside its defaults, in words.
    pub settings: String,
    /// Substeps, or solver iterations.
    pub substeps: u32,
    /// Could bodies fall asleep?
    pub sleep: bool,
    /// Of the timed steps, one by one.
    pub ms_per_step: Timing,
    /// Steps timed.
    pub timed: usize,
    /// Steps run, all told.
    pub steps: usize,
    /// Pairs with a point of contact at the end, as the engine itself counts, within its own margin.
    pub contacts: usize,
    /// Pairs that overlap at the end.
    pub overlaps: usize,
    /// The deepest overlap at the end, metres.
    pub max_penetration: f64,
    /// The mean depth of pairs that overlap at the end, metres.
    pub mean_penetration: f64,
    /// How far bodies are from the scene's closed form at the end; see [`case_error`]. None where it has none.
    pub error: Option<f64>,
    /// |Σmv − exact| / |exact| at the end, where nothing can push against the ground.
    pub momentum_error: Option<f64>,
    /// How much lower the body that began highest is, metres, where a scene is meant to stand.
    pub sunk: Option<f64>,
    /// The widest gap any joint has at the end, metres: between the points it holds together, or between a rod and
    /// its length. None where the scene has no joints.
    pub joint_gap: Option<f64>,
    /// Movable bodies below everything that holds them, at the end.
    pub escaped: usize,
    /// Bodies asleep at the end.
    pub asleep: usize,
    /// Is every state finite at the end?
    pub finite: bool,
    /// Why the run ended early, if it did.
    pub stopped: Option<String>,
    /// xxh3 over pose and velocity of all bodies at the end, as the library has it.
    pub hash: String,
}

impl Row {
    /// Of a run at its end, after `steps` steps.
    pub fn of(
        scene: &Scene,
        blueprint: &Blueprint,
        setup: Setup,
        engine: &dyn Engine,
        samples_ms: &[f64],
        steps: usize,
        stopped: Option<String>,
    ) -> Self {
        let states = engine.states();
        let t_secs = steps as f64 * scene.dt_secs;
        let overlap = penetration(&blueprint.outlines(&states));
        Self {
            scene: scene.name.clone(),
            bodies: blueprint.bodies.len(),
            engine: setup.engine.name(),
            version: crate::about::version(setup.engine),
            threads: setup.threads,
            settings: setup.words(),
            substeps: setup.substeps,
            sleep: setup.sleep,
            ms_per_step: Timing::of(samples_ms),
            timed: samples_ms.len(),
            steps,
            contacts: engine.contacts(),
            overlaps: overlap.pairs,
            max_penetration: overlap.max,
            mean_penetration: overlap.mean,
            error: case_error(scene, t_secs, |body| (states[body].position, states[body].rotation)),
            momentum_error: momentum_error(blueprint, &states, t_secs),
            sunk: sunk(blueprint, &states),
            joint_gap: joint_gap(blueprint, &states),
            escaped: escaped(blueprint, &states),
            asleep: engine.asleep(),
            finite: columns(&states).all(f64::is_finite),
            stopped,
            hash: format!("{:016x}", hash_of(columns(&states))),
        }
    }
}

/// All numbers of all states, column by column, as the library hashes them.
pub fn columns(states: &[BodyState]) -> impl Iterator<Item = f64> + '_ {
    let columns: [fn(&BodyState) -> f64; 7] = [
        |s| s.position[0],
        |s| s.position[1],
        |s| s.rotation[0],
        |s| s.rotation[1],
        |s| s.velocity[0],
        |s| s.velocity[1],
        |s| s.angular_velocity,
    ];
    columns.into_iter().flat_map(move |column| states.iter().map(column))
}

/// The relative error of Σmv where all forces are gravity and constant: every body dynamic.
fn momentum_error(blueprint: &Blueprint, states: &[BodyState], t_secs: f64) -> Option<f64> {
    let (mut sum, mut exact) = ([0.0; 2], [0.0; 2]);
    for (body, state) in blueprint.bodies.iter().zip(states) {
        if body.spec.kind != BodyKind::Dynamic {
            return None;
        }
        for k in 0..2 {
            let force = body.mass * blueprint.gravity[k] + body.spec.force[k];
            sum[k] += body.mass * state.velocity[k];
            exact[k] += body.mass * body.start.velocity[k] + force * t_secs;
        }
    }
    let size = exact[0].hypot(exact[1]);
    (size > 0.0).then(|| (sum[0] - exact[0]).hypot(sum[1] - exact[1]) / size)
}

/// Scenes whose bodies are to stay where they are put.
const STANDING: [&str; 9] =
    ["stack", "pyramid", "pyramids", "columns", "heavy", "sizes", "two_feet", "arch", "cards"];

/// How much lower the body that began highest is, metres.
fn sunk(blueprint: &Blueprint, states: &[BodyState]) -> Option<f64> {
    let base = blueprint.scene.split('/').next()?;
    STANDING.contains(&base).then_some(())?;
    let began = |k: usize| blueprint.bodies[k].start.position[1];
    let highest = (0..states.len()).max_by(|&a, &b| began(a).total_cmp(&began(b)))?;
    Some(began(highest) - states[highest].position[1])
}

/// The widest gap of any joint, metres.
fn joint_gap(blueprint: &Blueprint, states: &[BodyState]) -> Option<f64> {
    let gap = |joint: &Joint| {
        let ends = Blueprint::ends(joint);
        let [[ax, ay], [bx, by]] = [0, 1].map(|k| {
            let ([x, y], [c, s]) = (states[ends[k]].position, states[ends[k]].rotation);
            let [u, v] = joint.anchors_body[k];
            [x + c * u - s * v, y + s * u + c * v]
        });
        let apart = (bx - ax).hypot(by - ay);
        match &joint.kind {
            JointKind::Revolute(_) | JointKind::Weld(_) => apart,
            JointKind::Distance(d) if d.spring.is_none() && d.min.is_none() && d.max.is_none() => {
                (apart - joint.length).abs()
            }
            JointKind::Distance(d) => {
                (apart - d.max.unwrap_or(f64::INFINITY)).max(d.min.unwrap_or(0.0) - apart).max(0.0)
            }
        }
    };
    blueprint.joints.iter().map(gap).reduce(f64::max)
}

/// Movable bodies whose centre is below every box that is static or kinematic.
fn escaped(blueprint: &Blueprint, states: &[BodyState]) -> usize {
    let dynamic = |k: &usize| blueprint.bodies[*k].spec.kind == BodyKind::Dynamic;
    let holds = |k: &usize| !dynamic(k) && matches!(blueprint.bodies[*k].shape, Shape::Box { .. });
    let corners = |k: usize| blueprint.bodies[k].outline_at(&states[k]).vertices;
    let lowest = (0..states.len()).filter(holds).flat_map(corners).map(|[_, y]| y).reduce(f64::min);
    lowest.map_or(0, |lowest| {
        (0..states.len()).filter(dynamic).filter(|&k| states[k].position[1] < lowest).count()
    })
}
