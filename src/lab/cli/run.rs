//! `lamina run`: one scene, once.

use std::path::PathBuf;
use std::time::Instant;

use anyhow::ensure;
use lamina::cases::{self, error_of};
use lamina::report::Timing;
use lamina2d::measure::{Counts, Stage};
use lamina2d::record::Recorder;
use lamina2d::scene::Scene;
use lamina2d::settings::{Broad, Integrator, Precision, Settings, Skip, Skips, Solver, StiffFields, Threads};
use lamina2d::simulation::{Simulation, simulate};
use lamina2d::world::StepError;
use serde_json::{Map, Value, json};

use super::{output, refuse};

/// Arguments of `lamina run`.
#[expect(clippy::struct_excessive_bools, reason = "flags of a command line")]
#[derive(Debug, clap::Args)]
#[command(allow_negative_numbers = true)]
pub(crate) struct Args {
    /// A scene's name, `name/parameter`, or the path of a .toml file.
    scene: String,
    /// Number of bodies, pairs or boxes, as the scene takes it.
    #[arg(long, value_parser = whole::<usize>)]
    bodies: Option<usize>,
    /// Steps to run [default: the scene's own].
    #[arg(long, value_parser = whole::<u64>)]
    steps: Option<u64>,
    /// Seconds per step [default: the scene's own, 1/60].
    #[arg(long)]
    dt: Option<f64>,
    /// explicit_euler, semi_implicit_euler, velocity_verlet, position_verlet, rk4 or yoshida4.
    #[arg(long)]
    integrator: Option<Integrator>,
    /// impulse, pgs, soft, xpbd or avbd.
    #[arg(long)]
    solver: Option<Solver>,
    /// Integrate-and-solve rounds per step.
    #[arg(long, value_parser = whole::<u32>)]
    substeps: Option<u32>,
    /// off, brute, sweep, grid or auto.
    #[arg(long)]
    broad: Option<Broad>,
    /// Numbers per vector: 1, 4, 8 or 16 (f32), 1 or 4 (f64).
    #[arg(long, value_parser = whole::<usize>)]
    lanes: Option<usize>,
    /// f32 or f64.
    #[arg(long)]
    precision: Option<Precision>,
    /// Threads of a step: a number, or auto for as many as there are cores where bodies are many [default: 1].
    #[arg(long)]
    threads: Option<Threads>,
    /// Where the scene's random numbers come from.
    #[arg(long, value_parser = whole::<u64>, default_value_t = 1)]
    seed: u64,
    /// Work to leave out where a scene does not need it: all, none, or names separated by commas.
    #[arg(long)]
    skip: Option<Skips>,
    /// Let fast bodies go through thin walls.
    #[arg(long)]
    no_continuous: bool,
    /// Let islands of bodies at rest fall asleep.
    #[arg(long)]
    sleep: bool,
    /// Give each island as many substeps as keep its contacts from sagging by more than this, metres.
    #[arg(long, allow_hyphen_values = true)]
    max_sag: Option<f64>,
    /// Give no island more substeps than others, though a slender stack may buckle with them.
    #[arg(long)]
    fixed_substeps: bool,
    /// What advances a body whose fields its scheme cannot follow: what they do exactly, or the scheme all the same [default:
    /// exact].
    #[arg(long)]
    stiff_fields: Option<StiffFields>,
    /// Stiffness of soft contacts: their frequency as a share of the substep rate, over 0 up to 0.5 [default: 0.18].
    #[arg(long, allow_hyphen_values = true)]
    stiffness: Option<f64>,
    /// f64 keeps positions in more digits than a precision of f32 has: for scenes far from the origin.
    #[arg(long)]
    positions: Option<Precision>,
    /// Stop where a body is faster than this, m/s.
    #[arg(long, allow_hyphen_values = true)]
    max_speed: Option<f64>,
    /// Stop where kinetic and potential energy together have grown by more than this, J.
    #[arg(long, allow_hyphen_values = true)]
    max_gain: Option<f64>,
    /// Record the run into this file.
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Steps from one recorded frame to the next; numbers and hash are recorded at every step.
    #[arg(long, value_parser = whole::<u64>, default_value_t = 1, requires = "record")]
    every: u64,
    /// Print JSON.
    #[arg(long)]
    json: bool,
}

/// A number that counts: what `parse` says of a minus sign or a letter helps nobody.
fn whole<T: TryFrom<u64>>(given: &str) -> Result<T, &'static str> {
    given
        .parse::<u64>()
        .ok()
        .and_then(|n| n.try_into().ok())
        .ok_or("not a whole number from 0 up, or too large")
}

pub(crate) fn main(args: &Args) -> anyhow::Result<()> {
    let (scene, settings) = load(args)?;
    let steps = args.steps.unwrap_or(scene.steps);
    if steps == 0 {
        return Err(refuse(anyhow::anyhow!("--steps must be at least 1, got 0")));
    }
    let mut world = simulate(&scene, settings).map_err(refuse)?;
    if args.every == 0 {
        return Err(refuse(anyhow::anyhow!("--every must be at least 1, got 0")));
    }
    if scene.bodies.is_empty() {
        output::warn(&format!("{}: no [[body]]: the scene is empty, and nothing will move", scene.name));
    }
    if args.record.is_some() {
        world.time_every_step();
    }
    let recorder =
        args.record.as_ref().map(|path| Recorder::create(path, &scene, world.as_ref(), args.every));
    let mut recorder = recorder.transpose().map_err(refuse)?;
    let bar = output::progress(steps, "run");
    let mut samples_ms = Vec::new();
    for step in 0..steps {
        let start = Instant::now();
        let stepped = world.step(settings.dt_secs).map_err(|error| name_body(&scene, error));
        samples_ms.push(start.elapsed().as_secs_f64() * 1e3);
        if let Some(recorder) = &mut recorder {
            // The state that ended a run is worth a look.
            recorder.record(world.as_ref(), stepped.is_err() || step + 1 == steps)?;
        }
        stepped?;
        if step % 64 == 0 {
            bar.set_position(step);
        }
    }
    bar.finish_and_clear();
    let recorded = recorder.map(Recorder::finish).transpose()?;
    let mut result = describe(&scene, steps, world.as_ref(), &Timing::of(&samples_ms))?;
    if let Some(recorded) = recorded {
        result.insert("recorded".to_owned(), json!(recorded));
    }
    if args.json { output::print_json(&result) } else { output::print_fields(&Value::Object(result)) }
}

/// Adds the scene, and the body by its number in the scene: the k-th is in slot k + 1.
fn name_body(scene: &Scene, error: StepError) -> anyhow::Error {
    let body = error.slot().map_or_else(String::new, |slot| format!(", body {}", slot - 1));
    anyhow::Error::new(error).context(format!("scene {}{body}", scene.name))
}

fn load(args: &Args) -> anyhow::Result<(Scene, Settings)> {
    let (scene, asked) = cases::load(&args.scene, args.bodies, args.seed).map_err(refuse)?;
    // Steps of another length do at the same times what the scene does at steps of its own.
    let scene = if args.dt.is_some_and(|dt| dt != scene.dt_secs) { scene.timed() } else { scene };
    let precision = args.precision.unwrap_or(asked.precision);
    let default_lanes =
        if precision == asked.precision { asked.lanes } else { asked.with_precision(precision).lanes };
    let settings = Settings {
        dt_secs: args.dt.unwrap_or(asked.dt_secs),
        integrator: args.integrator.unwrap_or(asked.integrator),
        solver: args.solver.unwrap_or(asked.solver),
        substeps: args.substeps.unwrap_or(asked.substeps),
        broad: args.broad.unwrap_or(asked.broad),
        lanes: args.lanes.unwrap_or(default_lanes),
        precision,
        threads: args.threads.unwrap_or(asked.threads),
        skips: args.skip.unwrap_or(asked.skips),
        continuous: asked.continuous && !args.no_continuous,
        sleep: args.sleep || asked.sleep,
        max_sag: args.max_sag.or(asked.max_sag),
        fixed_substeps: args.fixed_substeps || asked.fixed_substeps,
        stiff_fields: args.stiff_fields.or(asked.stiff_fields),
        stiffness: args.stiffness.or(asked.stiffness),
        positions: args.positions.or(asked.positions),
        max_speed: args.max_speed.or(asked.max_speed),
        max_gain: args.max_gain.or(asked.max_gain),
    };
    settings.check().map_err(refuse)?;
    Ok((scene, settings))
}

/// The JSON object of a run; the table shows the same fields.
fn describe(
    scene: &Scene,
    steps: u64,
    world: &dyn Simulation,
    timing: &Timing,
) -> anyhow::Result<Map<String, Value>> {
    let (settings, counts, times) = (world.settings(), world.counts(), world.times());
    let stages: Map<_, _> =
        Stage::ALL.iter().map(|s| (s.name().to_owned(), json!(times.mean_ns(*s).round()))).collect();
    let (overlap, sums) = (world.penetration(), world.invariants());
    // JSON has no infinity: a finite state may still have an energy beyond all numbers.
    for (field, value) in [
        ("max_penetration", overlap.max),
        ("kinetic_energy", sums.kinetic_energy),
        ("potential_energy", sums.potential_energy),
        ("momentum x", sums.momentum[0]),
        ("momentum y", sums.momentum[1]),
        ("angular_momentum", sums.angular_momentum),
    ] {
        ensure!(
            value.is_finite(),
            "scene {}: after step {steps}, {field} is not finite: {value}",
            scene.name
        );
    }
    let fields = json!({
        "scene": scene.name,
        "bodies": world.bodies(),
        "steps": steps,
        "dt": settings.dt_secs,
        "integrator": settings.integrator,
        "solver": settings.solver,
        "substeps": settings.substeps,
        "broad": settings.broad,
        "broad_in_use": world.broad_in_use(),
        "lanes": settings.lanes,
        "precision": settings.precision,
        "threads": settings.threads,
        "seed": scene.seed,
        "skip": settings.skips.to_string(),
        "continuous": settings.continuous,
        "sleep": settings.sleep,
        "ms_per_step": timing,
        "stages_ns": stages,
        "counts": counted(&counts),
        "error": {
            "max_penetration": overlap.max,
            "mean_penetration": overlap.mean,
            "kinetic_energy": sums.kinetic_energy,
            "potential_energy": sums.potential_energy,
            "momentum": sums.momentum,
            "angular_momentum": sums.angular_momentum,
        },
        "hash": format!("{:016x}", world.hash()),
    });
    match fields {
        Value::Object(mut map) => {
            // Only where the scene has a closed form.
            if let Some(case) = error_of(world, scene, steps as f64 * settings.dt_secs) {
                ensure!(
                    case.is_finite(),
                    "scene {}: after step {steps}, the case's error is not finite",
                    scene.name
                );
                map["error"]["case"] = json!(case);
            }
            for (name, asked) in [
                ("max_sag", settings.max_sag),
                ("stiffness", settings.stiffness),
                ("max_speed", settings.max_speed),
                ("max_gain", settings.max_gain),
            ] {
                map.extend(asked.map(|asked| (name.to_owned(), json!(asked))));
            }
            map.extend(settings.fixed_substeps.then(|| ("fixed_substeps".to_owned(), json!(true))));
            map.extend(settings.stiff_fields.map(|asked| ("stiff_fields".to_owned(), json!(asked))));
            map.extend(settings.positions.map(|asked| ("positions".to_owned(), json!(asked))));
            Ok(map)
        }
        _ => unreachable!("an object literal"),
    }
}

/// What the last step counted, as JSON.
fn counted(counts: &Counts) -> Value {
    let skipped: Map<_, _> =
        Skip::ALL.iter().map(|s| (s.name().to_owned(), json!(counts.skipped[*s as usize]))).collect();
    json!({
        "candidates": counts.candidates,
        "pairs": counts.pairs,
        "contacts": counts.contacts,
        "sleeping": counts.sleeping,
        "islands": counts.islands,
        "substeps": counts.substeps,
        "direct_joints": counts.direct_joints,
        "direct_contacts": counts.direct_contacts,
        "stiff": counts.stiff,
        "skipped": skipped,
    })
}
