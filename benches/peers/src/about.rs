//! Each engine's version and build: compiler, flags, SIMD, and the defaults that decide its results.

use lamina::report::Machine;
use lamina2d::settings::Settings;
use serde::Serialize;
use serde_json::{Map, Value, json};

use crate::box2d::Box2d;
use crate::engine::Name;
use crate::rapier::Rapier;

/// An engine and how it was built.
#[derive(Clone, Debug, Serialize)]
pub struct About {
    /// The engine.
    pub name: &'static str,
    /// Its version.
    pub version: String,
    /// How it was built.
    pub build: Value,
    /// What it was run with where a row does not say otherwise.
    pub defaults: Value,
}

/// The version of an engine.
pub fn version(engine: Name) -> String {
    match engine {
        Name::Lamina2d => lamina_version(),
        Name::Box2d => {
            format!(
                "{} ({}, boxdd-sys {})",
                Box2d::version(),
                &boxdd_sys::UPSTREAM_SHA[..10],
                env!("PEERS_BOXDD")
            )
        }
        Name::Rapier2d => env!("PEERS_RAPIER").to_owned(),
    }
}

fn lamina_version() -> String {
    let machine = Machine::read();
    format!("{} ({})", machine.version, machine.commit)
}

/// What is to be known of all engines.
pub fn engines() -> Vec<About> {
    let builds = [lamina(), box2d(), rapier()];
    let about = |(engine, (build, defaults)): (Name, (Value, Value))| About {
        name: engine.name(),
        version: version(engine),
        build,
        defaults,
    };
    Name::ALL.into_iter().zip(builds).map(about).collect()
}

/// What the Rust code of all engines is built with.
fn rust_build(simd: &str) -> Value {
    let machine = Machine::read();
    json!({
        "compiler": machine.rustc,
        "flags": machine.flags,
        "profile": machine.build,
        "simd": simd,
    })
}

fn lamina() -> (Value, Value) {
    let s = Settings::default();
    let defaults = json!({
        "solver": s.solver,
        "integrator": s.integrator,
        "substeps": s.substeps,
        "precision": s.precision,
        "lanes": s.lanes,
        "skip": s.skips.to_string(),
        "continuous": s.continuous,
        "contact_margin": "1/40 of the median bounding radius",
        "bounces_from": "what gravity makes in three steps",
    });
    let wide = Machine::read().features.last().copied().unwrap_or("none");
    (rust_build(&format!("{} lanes of f32, {wide}", s.lanes)), defaults)
}

fn named(values: Vec<(&'static str, f32)>) -> Map<String, Value> {
    values.into_iter().map(|(name, value)| (name.to_owned(), json!(value))).collect()
}

fn box2d() -> (Value, Value) {
    let simd = if cfg!(target_arch = "x86_64") { "8 lanes of f32, avx2 (feature simd-avx2)" } else { "neon" };
    let build = json!({
        "compiler": env!("PEERS_C_COMPILER"),
        "flags": env!("PEERS_C_FLAGS"),
        "profile": "C; of two -O the last counts",
        "simd": simd,
        "assertions": Box2d::asserts(),
    });
    let mut defaults = named(Box2d::defaults());
    for (name, value) in [
        ("substeps", json!(4)),
        ("linear_slop_m", json!(0.005)),
        ("speculative_distance_m", json!(0.02)),
        ("contact_recycling", json!(true)),
        ("continuous", json!("fast bodies against static ones")),
        ("maximum_rotation_per_step_rad", json!(std::f64::consts::FRAC_PI_4)),
    ] {
        defaults.insert(name.to_owned(), value);
    }
    (build, Value::Object(defaults))
}

fn rapier() -> (Value, Value) {
    let parallel = if cfg!(feature = "parallel") { ", parallel" } else { "" };
    let mut build = rust_build("8 lanes of f32 (feature simd8)");
    build["features"] = json!(format!("simd8, block-solver (default){parallel}"));
    build["parry2d"] = json!(env!("PEERS_PARRY"));
    let mut defaults = named(Rapier::defaults());
    for (name, value) in [
        ("solver_iterations", json!(4)),
        ("contact_recycling", json!(true)),
        ("joints", json!("impulse joints; a rod is a spring as stiff as joints are")),
        ("continuous", json!("fast bodies against fixed ones")),
    ] {
        defaults.insert(name.to_owned(), value);
    }
    (build, Value::Object(defaults))
}
