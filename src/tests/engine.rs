//! Tests of the engine: kernels against oracles, laws of motion, contacts, joints, sleep, bits.

#[path = "shared/joints.rs"]
mod shared_joints;
#[path = "shared/motion.rs"]
mod shared_motion;
#[path = "shared/oracle.rs"]
mod shared_oracle;
#[path = "shared/pairs.rs"]
mod shared_pairs;
#[path = "shared/scenes.rs"]
mod shared_scenes;
#[path = "shared/sleep.rs"]
mod shared_sleep;

/// Of the long ranges every so many cases are run here; all of them are, optimised, by `slow`. Prime to the inner sides
/// of a range, so that their values take turns.
const EVERY: usize = 7;

mod engine {
    mod balances;
    mod bodies;
    mod chains;
    mod contacts;
    mod continuous;
    mod events;
    mod fields;
    mod fuzz;
    mod homes;
    mod impacts;
    mod interface;
    mod joints;
    mod loads;
    mod motion_laws;
    mod motion_orders;
    mod motion_skips;
    mod nets;
    mod oracle_broad;
    mod oracle_lanes;
    mod oracle_narrow;
    mod paces;
    mod refusals;
    mod restless;
    mod rooms;
    mod scenes;
    mod seams;
    mod shapes;
    mod sleep;
    mod solvers;
    mod stiff;
    mod threads;
    mod waking;
    mod watchdog;
}
