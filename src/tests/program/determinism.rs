//! The thesis's determinism experiment: with a fixed step two runs end in the same bits whatever the frames
//! were; with a variable step nothing is promised, and the table must say honestly what happened.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::report::experiments::determinism::{self, Row, SECONDS};
use lamina2d::clock::Accumulator;
use lamina2d::scene::mixes;
use lamina2d::settings::{Integrator, Settings, Stepping};
use lamina2d::simulation::{Simulation, simulate};

const DT_SECS: f64 = 1.0 / 60.0;

fn rows_of(rows: &[Row], stepping: Stepping) -> impl Iterator<Item = &Row> {
    rows.iter().filter(move |row| row.stepping == stepping)
}

fn world(integrator: Integrator) -> Box<dyn Simulation> {
    simulate(&mixes::determinism(), Settings { integrator, ..Settings::default() }).unwrap()
}

/// Runs `total` fixed steps out of frames of these lengths, repeated; returns the hash and the frames used.
fn play_fixed(integrator: Integrator, frames_secs: &[f64], total: u32) -> (u64, usize) {
    let mut world = world(integrator);
    let mut clock = Accumulator::new(DT_SECS, Accumulator::CLAMP_SECS);
    let mut steps = 0;
    for (frame, &frame_secs) in frames_secs.iter().cycle().enumerate() {
        for _ in 0..clock.steps_due(frame_secs).min(total - steps) {
            world.step(DT_SECS).unwrap();
            steps += 1;
        }
        if steps == total {
            return (world.hash(), frame + 1);
        }
    }
    unreachable!("frames repeat for ever")
}

#[test]
fn the_experiment_has_every_row_once() {
    let rows = determinism::run().unwrap();
    for stepping in [Stepping::Fixed, Stepping::Variable] {
        for seconds in SECONDS {
            let of = |engine: &str| -> Vec<String> {
                let these = rows_of(&rows, stepping).filter(|r| r.seconds == seconds && r.engine == engine);
                these.map(|r| r.integrator.clone()).collect()
            };
            let all: Vec<_> = Integrator::ALL.iter().map(|i| i.name().to_owned()).collect();
            assert_eq!(of("lamina2d"), all, "{stepping}, {seconds} s");
            assert_eq!(of("thesis"), ["semi_implicit_euler"], "{stepping}, {seconds} s");
        }
    }
    assert_eq!(rows.len(), 2 * SECONDS.len() * (Integrator::ALL.len() + 1));
    for row in &rows {
        assert_eq!(row.identical, row.hashes[0] == row.hashes[1], "{row:?}");
        assert!(row.max_apart_m.is_finite() && row.max_apart_m >= 0.0, "{row:?}");
        assert!(!row.identical || row.max_apart_m == 0.0, "same bits, other places: {row:?}");
        let compared = row.engine == "lamina2d" && row.stepping == Stepping::Fixed;
        assert_eq!(row.from_semi_implicit_m.is_some(), compared, "{row:?}");
    }
}

#[test]
fn two_fixed_step_runs_end_in_the_same_bits_with_every_integrator_and_in_the_thesis_engine() {
    let rows = determinism::run().unwrap();
    for row in rows_of(&rows, Stepping::Fixed) {
        assert!(row.identical && row.max_apart_m == 0.0, "{row:?}");
        if let Some(apart_m) = row.from_semi_implicit_m {
            let is_itself = row.integrator == Integrator::SemiImplicitEuler.name();
            assert!(apart_m.is_finite() && (apart_m == 0.0 || !is_itself), "{row:?}");
        }
    }
}

#[test]
fn fixed_steps_forget_how_long_the_frames_were() {
    let fast = [1.0 / 144.0, 1.0 / 144.0, 1.0 / 120.0];
    let slow = [0.05, 0.017, 0.031];
    let stalling = [0.016, 3.0, 0.0, 0.1];
    for &integrator in Integrator::ALL {
        let [a, b, c] = [&fast[..], &slow, &stalling].map(|frames| play_fixed(integrator, frames, 300));
        assert_eq!([a.0, a.0], [b.0, c.0], "{integrator}");
        assert!(a.1 > b.1 && a.1 > c.1, "the three machines drew different numbers of frames");
    }
}

#[test]
fn variable_steps_repeat_only_as_far_as_their_frames_do() {
    let play = |frames_secs: &[f64]| {
        let mut world = world(Integrator::SemiImplicitEuler);
        for &frame_secs in frames_secs.iter().cycle().take(300) {
            world.step(frame_secs).unwrap();
        }
        world.hash()
    };
    let (steady, jittered) = ([DT_SECS, DT_SECS], [DT_SECS * 1.01, DT_SECS * 0.99]);
    assert_eq!(play(&jittered), play(&jittered));
    assert_ne!(play(&jittered), play(&steady));
}
