//! Tests of recordings and of sessions done again from them (feature `record`).

#[path = "shared/motion.rs"]
#[allow(dead_code, reason = "each binary takes the helpers it needs")]
mod shared_motion;
#[path = "shared/recording.rs"]
mod shared_recording;
#[path = "shared/victim.rs"]
mod shared_victim;

mod record {
    mod recording;
    mod recording_hostile;
    mod sessions;
}
