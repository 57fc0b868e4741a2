//! Instructions of the same workloads that criterion times, under the same names, counted by callgrind: what
//! `lamina gate` compares with `reports/instructions.toml`.
//!
//! Of a kernel one call is counted, of a scene the [`steps::WINDOW_STEPS`] steps of its window; both after a first
//! call or step, in which memory grows. Beside every mix, integrator, solver and skip at 150 bodies: each stage's
//! kernels at 8 lanes, and at 1 where that tells what lanes are worth.
//!
//! Nothing is settled under valgrind: the runner first runs [`hand_over`] outside of it, which leaves the states in
//! files for [`restore`].
//!
//! ```sh
//! cargo bench --bench instructions          # needs valgrind and iai-callgrind-runner
//! ```

#![expect(missing_docs, reason = "the framework's macros make functions and constants without")]

mod common;
mod kernels;
mod steps;

use std::path::PathBuf;

use iai_callgrind::{
    Callgrind, LibraryBenchmarkConfig, OutputFormat, library_benchmark, library_benchmark_group,
};
use lamina2d::column::Column;
use lamina2d::internals::PlainWorld;
use lamina2d::simulation::Simulation;

use common::{Agreement, Settled, step_through, world};
use kernels::Work;
use steps::WINDOW_STEPS;

/// The kernel of a name, called once.
fn kernel_of(settled: &Settled, agreement: &Agreement, name: &str) -> Box<dyn Work> {
    let all = kernels::all();
    let found = all.iter().find(|kernel| kernel.name == name);
    let kernel = found.unwrap_or_else(|| panic!("no kernel '{name}'"));
    let mut work = kernel.build(settled);
    work.run();
    let answer = work.answer();
    assert!(answer.count > 0 && work.elements() > 0, "{name} found nothing to do");
    agreement.check(&kernel.alike, name, answer);
    if work.resets() {
        work.reset();
    }
    work
}

/// The scene's world at the beginning of its window.
fn scene_of(settled: &Settled, agreement: &Agreement, name: &str) -> Box<dyn Simulation> {
    let found = steps::all().into_iter().find_map(|case| {
        let lanes = case.lanes.iter().copied().find(|&lanes| case.at(lanes) == name)?;
        Some((case, lanes))
    });
    let (case, lanes) = found.unwrap_or_else(|| panic!("no scene '{name}'"));
    let mut world = case.start(settled, lanes);
    // As in criterion's windows: a copy's first step, in which its vectors grow, is left out.
    steps::step(world.as_mut());
    let mut ahead = world.duplicate();
    (0..WINDOW_STEPS).for_each(|_| steps::step(ahead.as_mut()));
    agreement.check(&case.alike, name, steps::answer(name, ahead.as_ref(), case.touch));
    world
}

/// Where the state of a scene after some steps is handed over.
fn path_of(name: &str, steps: usize) -> PathBuf {
    let file = format!("{}-{steps}.state", name.replace('/', "-"));
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("settled").join(file)
}

/// Columns of poses and velocities.
fn columns(world: &mut PlainWorld) -> [&mut Column<f32>; 7] {
    let bodies = world.bodies_mut();
    [
        &mut bodies.x,
        &mut bodies.y,
        &mut bodies.c,
        &mut bodies.s,
        &mut bodies.vx,
        &mut bodies.vy,
        &mut bodies.w,
    ]
}

/// Steps a scene through and leaves its state in a file: hash, then columns.
fn hand_over_state(name: &str, steps: usize) -> PlainWorld {
    let mut world = step_through(name, steps);
    let mut bytes = world.hash().to_le_bytes().to_vec();
    for column in columns(&mut world) {
        bytes.extend(column.as_slice().iter().flat_map(|value| value.to_le_bytes()));
    }
    let path = path_of(name, steps);
    // Whoever reads while another writes finds the old or the new file, which are the same.
    let part = path.with_extension(format!("{}.part", std::process::id()));
    std::fs::create_dir_all(path.parent().expect("a file in a folder")).expect("a folder for states");
    std::fs::write(&part, bytes).and_then(|()| std::fs::rename(&part, &path)).expect("a file for a state");
    world
}

/// The state that [`hand_over_state`] left.
fn restore(name: &str, steps: usize) -> PlainWorld {
    let bytes = std::fs::read(path_of(name, steps)).expect("a state that was handed over");
    let (hash, values) = bytes.split_at(8);
    let mut values =
        values.chunks_exact(4).map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]));
    let mut world = world(name);
    for column in columns(&mut world) {
        column.as_mut_slice().iter_mut().for_each(|value| *value = values.next().expect("a value per slot"));
    }
    assert_eq!(world.hash().to_le_bytes(), hash, "{name} is not in the state that was handed over");
    world
}

/// Runs every setup once outside valgrind: states are left in files, answers are checked, and that nothing is left out.
fn hand_over() {
    let (settled, agreement) = (Settled::new(hand_over_state), Agreement::default());
    for name in KERNELS.iter().chain(PROOF) {
        kernel_of(&settled, &agreement, name);
    }
    for name in STEPS {
        scene_of(&settled, &agreement, name);
    }
    let of_gated_size = |name: &str| name.ends_with("/150/x8") || name.ends_with("/144/x8");
    for kernel in kernels::all().iter().filter(|kernel| of_gated_size(&kernel.name)) {
        assert!(KERNELS.contains(&kernel.name.as_str()), "{} is not among the kernels counted", kernel.name);
    }
    for name in steps::all().iter().filter(|case| case.bodies <= 150).map(|case| case.at(8)) {
        assert!(STEPS.contains(&name.as_str()), "{name} is not among the scenes counted");
    }
}

fn kernel(name: &str) -> Box<dyn Work> {
    kernel_of(&Settled::new(restore), &Agreement::default(), name)
}

fn scene(name: &str) -> Box<dyn Simulation> {
    scene_of(&Settled::new(restore), &Agreement::default(), name)
}

/// Names a list of benches, and counts what `$body` does with what `$setup` makes of each name. The workload is handed
/// out again so that dropping it is not counted.
macro_rules! counted {
    ($list:ident, $bench:ident, $setup:ident, |$work:ident: $kind:ty| { $($body:tt)* }, [$($name:literal),+ $(,)?]) => {
        const $list: &[&str] = &[$($name),+];

        #[library_benchmark]
        #[benches::of(args = [$($name),+], setup = $setup)]
        fn $bench(mut $work: $kind) -> $kind {
            $($body)*;
            $work
        }
    };
}

// What the gate allows a count to change by follows from the names of these functions.
counted!(
    KERNELS,
    kernels_once,
    kernel,
    |work: Box<dyn Work>| { work.run() },
    [
        "integrate/explicit_euler/150/x8",
        "integrate/semi_implicit_euler/150/x8",
        "integrate/velocity_verlet/150/x8",
        "integrate/velocity_verlet_closed_form/150/x8",
        "integrate/position_verlet/150/x8",
        "integrate/position_verlet_closed_form/150/x8",
        "integrate/rk4/150/x8",
        "integrate/rk4/150/x1",
        "integrate/rk4_closed_form/150/x8",
        "integrate/yoshida4/150/x8",
        "integrate/yoshida4_closed_form/150/x8",
        "broad/brute/150/x8",
        "broad/brute/150/x1",
        "broad/sweep/150/x8",
        "broad/sweep/150/x1",
        "broad/grid/150/x8",
        "broad/grid/150/x1",
        "narrow/circle-circle/150/x8",
        "narrow/circle-circle/150/x1",
        "narrow/circle-box/150/x8",
        "narrow/circle-box/150/x1",
        "narrow/circle-polygon/150/x8",
        "narrow/circle-polygon/150/x1",
        "narrow/box-box/150/x8",
        "narrow/box-box/150/x1",
        "narrow/box-polygon/150/x8",
        "narrow/box-polygon/150/x1",
        "narrow/polygon-polygon/150/x8",
        "narrow/polygon-polygon/150/x1",
        "prepare/circles/150/x8",
        "prepare/polygons/150/x8",
        "prepare/polygons/150/x1",
        "solve/impulse/circles/150/x8",
        "solve/impulse/polygons/150/x8",
        "solve/impulse_settle/circles/150/x8",
        "solve/impulse_settle/polygons/150/x8",
        "solve/pgs/circles/150/x8",
        "solve/pgs/polygons/150/x8",
        "solve/soft/circles/150/x8",
        "solve/soft/polygons/150/x8",
        "solve/soft/polygons/150/x1",
        "solve/soft_settle/circles/150/x8",
        "solve/soft_settle/polygons/150/x8",
        "solve/soft_settle/polygons/150/x1",
        "solve/xpbd_settle/circles/150/x8",
        "solve/xpbd_settle/polygons/150/x8",
        "solve/avbd_settle/circles/150/x8",
        "solve/avbd_settle/polygons/150/x8",
        "store/circles/150/x8",
        "store/polygons/150/x8",
        "joints/place/144/x8",
        "joints/push/144/x8",
        "joints/relax/144/x8",
        "joints/push/144/x1",
    ]
);

counted!(
    STEPS,
    steps_of_window,
    scene,
    |world: Box<dyn Simulation>| { (0..WINDOW_STEPS).for_each(|_| steps::step(world.as_mut())) },
    [
        "mixes/circles/150/explicit_euler/x8",
        "mixes/circles/150/semi_implicit_euler/x8",
        "mixes/circles/150/velocity_verlet/x8",
        "mixes/circles/150/velocity_verlet/x1",
        "mixes/circles/150/position_verlet/x8",
        "mixes/circles/150/rk4/x8",
        "mixes/circles/150/yoshida4/x8",
        "mixes/circles_polygons/150/explicit_euler/x8",
        "mixes/circles_polygons/150/semi_implicit_euler/x8",
        "mixes/circles_polygons/150/velocity_verlet/x8",
        "mixes/circles_polygons/150/velocity_verlet/x1",
        "mixes/circles_polygons/150/position_verlet/x8",
        "mixes/circles_polygons/150/rk4/x8",
        "mixes/circles_polygons/150/yoshida4/x8",
        "mixes/polygons/150/explicit_euler/x8",
        "mixes/polygons/150/semi_implicit_euler/x8",
        "mixes/polygons/150/velocity_verlet/x8",
        "mixes/polygons/150/velocity_verlet/x1",
        "mixes/polygons/150/position_verlet/x8",
        "mixes/polygons/150/rk4/x8",
        "mixes/polygons/150/yoshida4/x8",
        "mixes/all/150/explicit_euler/x8",
        "mixes/all/150/semi_implicit_euler/x8",
        "mixes/all/150/velocity_verlet/x8",
        "mixes/all/150/velocity_verlet/x1",
        "mixes/all/150/position_verlet/x8",
        "mixes/all/150/rk4/x8",
        "mixes/all/150/yoshida4/x8",
        "falling/circles/150/x8",
        "falling/circles_polygons/150/x8",
        "falling/polygons/150/x8",
        "falling/all/150/x8",
        "falling/polygons/150/x1",
        "free_flight/150/x8",
        "free_flight/150/x1",
        "stack/10/x8",
        "pyramid/10/x8",
        "pyramid/10/x1",
        "tumbler/100/x8",
        "sleeping/polygons/150/x8",
        "solvers/polygons/150/impulse/x8",
        "solvers/polygons/150/pgs/x8",
        "solvers/polygons/150/soft/x8",
        "solvers/polygons/150/xpbd/x8",
        "solvers/polygons/150/avbd/x8",
        "solvers/pyramid/10/impulse/x8",
        "solvers/pyramid/10/pgs/x8",
        "solvers/pyramid/10/soft/x8",
        "solvers/pyramid/10/xpbd/x8",
        "solvers/pyramid/10/avbd/x8",
        "jointed/joint_grid/12/x8",
        "jointed/joint_grid/12/x1",
        "jointed/chain/30/x8",
        "jointed/bridge/40/x8",
        "skips/closed_form/free_flight/150/on/x8",
        "skips/closed_form/free_flight/150/off/x8",
        "skips/free_flight/free_flight/150/on/x8",
        "skips/free_flight/free_flight/150/off/x8",
        "skips/rotation/free_flight/150/on/x8",
        "skips/rotation/free_flight/150/off/x8",
        "skips/friction/head_on/75/on/x8",
        "skips/friction/head_on/75/off/x8",
        "skips/restitution/pyramid/10/on/x8",
        "skips/restitution/pyramid/10/off/x8",
        "skips/pair_list/polygons/150/on/x8",
        "skips/pair_list/polygons/150/off/x8",
        "skips/manifold_reuse/polygons/150/on/x8",
        "skips/manifold_reuse/polygons/150/off/x8",
        "skips/exact/polygons/150/on/x8",
        "skips/exact/polygons/150/off/x8",
        "checks/watchdog/polygons/150/on/x8",
        "checks/watchdog/polygons/150/off/x8",
        "checks/positions/polygons/150/f64/x8",
        "checks/positions/polygons/150/f32/x8",
        "broad_on_off/polygons/60/on/x8",
        "broad_on_off/polygons/60/off/x8",
        "broad_on_off/polygons/80/on/x8",
        "broad_on_off/polygons/80/off/x8",
        "broad_on_off/polygons/100/on/x8",
        "broad_on_off/polygons/100/off/x8",
    ]
);

counted!(
    PROOF,
    proof_once,
    kernel,
    |work: Box<dyn Work>| { work.run() },
    ["proof/once/6399/x8", "proof/one_percent_more/6463/x8", "proof/twice/12799/x8"]
);

library_benchmark_group!(name = kernel_calls; benchmarks = kernels_once);
library_benchmark_group!(name = scene_windows; benchmarks = steps_of_window);
library_benchmark_group!(name = proof; benchmarks = proof_once);

/// Makes a program of some groups: the framework runs all of what `main!` is given.
macro_rules! program {
    ($name:ident: $($group:ident),+) => {
        mod $name {
            use super::{config, hand_over, $($group),+};

            iai_callgrind::main!(
                config = config();
                setup = hand_over();
                library_benchmark_groups = $($group),+
            );

            pub(super) fn run() {
                main();
            }
        }
    };
}

program!(all: kernel_calls, scene_windows, proof);
program!(kernels_alone: kernel_calls);
program!(scenes_alone: scene_windows);
program!(proof_alone: proof);

fn config() -> LibraryBenchmarkConfig {
    let mut config = LibraryBenchmarkConfig::default();
    config.tool(Callgrind::with_args(["--cache-sim=no"]));
    // All of the environment that is left, and cargo writes the checkout's path into it: its length moves the stack,
    // and with it by a few instructions what copies onto the stack take.
    config.env("LD_LIBRARY_PATH", "/");
    config.output_format(OutputFormat::default().truncate_description(None));
    config
}

/// `LAMINA_INSTRUCTIONS` chooses the group, so that the gate can run two at once. Under valgrind the environment is
/// empty, and the runner names the bench.
fn main() {
    match std::env::var("LAMINA_INSTRUCTIONS").as_deref() {
        Ok("kernels") => kernels_alone::run(),
        Ok("scenes") => scenes_alone::run(),
        Ok("proof") => proof_alone::run(),
        Ok(other) => panic!("LAMINA_INSTRUCTIONS is kernels, scenes or proof, not '{other}'"),
        Err(_) => all::run(),
    }
}
