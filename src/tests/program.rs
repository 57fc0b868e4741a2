//! Tests of the laboratory and of the program `lamina`.

#[path = "shared/cli.rs"]
mod shared_cli;
#[path = "shared/motion.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_motion;
#[path = "shared/orders.rs"]
mod shared_orders;
#[path = "shared/recording.rs"]
mod shared_recording;
#[path = "shared/scenes.rs"]
mod shared_scenes;
#[path = "shared/soak.rs"]
mod shared_soak;
#[path = "shared/thesis.rs"]
mod shared_thesis;

mod program {
    mod accuracy_cli;
    mod accuracy_contact;
    mod accuracy_laws;
    mod accuracy_orders;
    mod accuracy_references;
    mod cases;
    mod cli;
    mod cli_recordings;
    mod cli_refusals;
    mod determinism;
    mod gate;
    mod metamorphic;
    mod report_strips;
    mod stress;
    mod thesis;
    mod tune;
    mod wild;
}
