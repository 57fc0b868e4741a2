//! Golden state hashes: each scene ends in the same bits at every lane width, with all skips and with none,
//! in debug and release, with AVX2 and with SSE2 alone.
//!
//! Fast bodies are not stopped here: the table holds what contacts and integrators make of a scene. That they
//! stop alike everywhere has a test of its own.
//!
//! A change that is meant to move bits is blessed with `LAMINA_BLESS=1 cargo test --test golden`, which
//! rewrites golden.toml; its diff belongs into the commit that moved them.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

use lamina2d::scene::{self, Scene, by_name};
use lamina2d::settings::{Broad, Integrator, Precision, Settings, Skips};
use lamina2d::simulation::simulate;

/// By precision, then by case.
type Table = BTreeMap<String, BTreeMap<String, String>>;

/// Every force field and every shape and kind of body at once; the bodies meet above a turning cross bar.
const ALL_FIELDS: &str = r#"
[forces]
gravity = [0.5, -9.81]
wind = [2, 1]
linear_drag = 0.05
quadratic_drag = 0.02
spring = { anchor = [0, 3], stiffness = 4 }
central = { center = [-2, -4], strength = 6 }
magnetic = 0.7

[[body]]
shape = { box = [12, 0.5] }
position = [0, -0.5]
kind = "static"

[[body]]
shape = { box = [2, 0.2] }
position = [0, 1.5]
kind = "kinematic"
velocity = [0.1, 0]
angular_velocity = 0.8

[[body]]
shape = { circle = 0.5 }
position = [-2, 4]
velocity = [1, 2]
restitution = 0.6

[[body]]
shape = { circle = 0.4 }
position = [2.2, 4]
velocity = [-1, 0]
angular_velocity = 3
mass = 2
force = [0.3, 1]
torque = 0.2

[[body]]
shape = { box = [0.5, 0.4] }
position = [0.3, 6]
angle = 0.4
friction = 0.8
restitution = 0.3

[[body]]
shape = { box = [0.6, 0.3] }
position = [-0.4, 8]
velocity = [0, -3]
density = 2

[[body]]
shape = { polygon = [[-0.5, -0.4], [0.6, -0.3], [0.7, 0.4], [0, 0.8], [-0.6, 0.3]] }
position = [1.2, 9]
angular_velocity = -2

[[body]]
shape = { polygon = [[0, 0], [1, 0.2], [0.3, 0.9]] }
position = [-1.5, 10]
angle = 2
torque = -0.3
"#;

struct Case {
    name: String,
    scene: Scene,
    integrator: Integrator,
}

/// The four mixes and other named scenes as they stand, all fields with every integrator; piles, driven bodies and
/// joints as by default.
fn cases() -> Vec<Case> {
    let names = [
        "circles/150",
        "circles_polygons/150",
        "polygons/150",
        "all/150",
        "stack/10",
        "determinism",
        "head_on/100",
        "free_flight/1000",
    ];
    let named = names.iter().map(|name| Case {
        name: (*name).to_owned(),
        scene: by_name(name, None, 1).unwrap(),
        integrator: Integrator::SemiImplicitEuler,
    });
    let (fields, _) = scene::file::parse("all_fields", ALL_FIELDS).unwrap();
    let integrated = Integrator::ALL.iter().map(|&integrator| Case {
        name: format!("all_fields/{integrator}"),
        scene: fields.clone(),
        integrator,
    });
    let held = ["pyramid/20", "tumbler/100", "chain/30", "bridge/40", "joint_grid/10"];
    let held = held.iter().map(|name| Case {
        name: (*name).to_owned(),
        scene: Scene { steps: 600, ..by_name(name, None, 1).unwrap() },
        integrator: Integrator::VelocityVerlet,
    });
    named.chain(integrated).chain(held).collect()
}

/// The state hash after the scene's own number of steps, or why there is none.
fn final_hash(case: &Case, settings: Settings) -> String {
    let settings = Settings { integrator: case.integrator, dt_secs: case.scene.dt_secs, ..settings };
    let mut world = simulate(&case.scene, settings).unwrap();
    for _ in 0..case.scene.steps {
        if let Err(error) = world.step(settings.dt_secs) {
            return error.to_string();
        }
    }
    format!("{:016x}", world.hash())
}

fn table_path() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "src", "tests", "golden.toml"].iter().collect()
}

fn read_table() -> Table {
    toml::from_str(&std::fs::read_to_string(table_path()).unwrap_or_default()).unwrap()
}

/// The settings of the table.
fn held(precision: Precision, lanes: usize, skips: Skips) -> Settings {
    Settings { precision, lanes, skips, continuous: false, ..Settings::default() }
}

/// Writes what width 1 without skips finds, and fails: a blessed run has tested nothing.
fn bless() -> ! {
    let mut text = "# State hashes, by precision and scene: see golden.rs.\n".to_owned();
    for precision in Precision::ALL {
        writeln!(text, "\n[{precision}]").unwrap();
        for case in cases() {
            let hash = final_hash(&case, held(*precision, 1, Skips::NONE));
            writeln!(text, "\"{}\" = \"{hash}\"", case.name).unwrap();
        }
    }
    std::fs::write(table_path(), text).unwrap();
    panic!("rewrote src/tests/golden.toml: look at its diff, then run again without LAMINA_BLESS");
}

#[test]
fn no_width_and_no_skip_moves_a_bit_of_any_scene() {
    if std::env::var_os("LAMINA_BLESS").is_some_and(|v| v == "1") {
        bless();
    }
    let table = read_table();
    let mut wrong = String::new();
    for case in cases() {
        for &precision in Precision::ALL {
            let expected = table.get(precision.name()).and_then(|t| t.get(&case.name));
            let expected = expected.map_or("no line in golden.toml", String::as_str);
            for &lanes in Settings::widths(precision) {
                for skips in [Skips::EXACT, Skips::NONE] {
                    let found = final_hash(&case, held(precision, lanes, skips));
                    if found != expected {
                        let (name, integrator) = (&case.name, case.integrator);
                        writeln!(
                            wrong,
                            "{name}, {integrator}, {precision}, lanes {lanes}, skip {skips}: \
                             expected {expected}, found {found}"
                        )
                        .unwrap();
                    }
                }
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "bits moved:\n{wrong}\nWhere that was the purpose: LAMINA_BLESS=1 cargo test --test engine golden"
    );
}

#[test]
fn no_width_and_no_skip_moves_a_bit_where_fast_bodies_are_stopped() {
    for case in cases().into_iter().filter(|case| case.name.starts_with("all_fields")) {
        for &precision in Precision::ALL {
            let plain = held(precision, 1, Skips::NONE);
            let stopped = final_hash(&case, Settings { continuous: true, ..plain });
            for &lanes in Settings::widths(precision) {
                for skips in [Skips::EXACT, Skips::NONE] {
                    let settings = Settings { continuous: true, ..held(precision, lanes, skips) };
                    assert_eq!(final_hash(&case, settings), stopped, "{} {settings:?}", case.name);
                }
            }
        }
    }
}

/// Reused manifolds change bits, the same at every width.
#[test]
fn no_width_moves_a_bit_where_manifolds_are_reused() {
    for case in cases() {
        for &precision in Precision::ALL {
            let by = |&lanes| final_hash(&case, Settings { precision, lanes, ..Settings::default() });
            let hashes: Vec<_> = Settings::widths(precision).iter().map(by).collect();
            assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{}: {hashes:?}", case.name);
        }
    }
}

#[test]
fn no_broad_phase_moves_a_bit_of_a_mix() {
    for case in cases().into_iter().filter(|case| case.name.ends_with("/150")) {
        let by = |broad| final_hash(&case, Settings { broad, ..Settings::default() });
        let brute = by(Broad::Brute);
        for broad in [Broad::Sweep, Broad::Grid, Broad::Auto] {
            assert_eq!(by(broad), brute, "{} with broad phase {broad}", case.name);
        }
    }
}

#[test]
fn golden_scenes_are_worth_their_hash() {
    let table = read_table();
    let lines: Vec<_> = table.values().flatten().collect();
    assert_eq!(lines.len(), Precision::ALL.len() * cases().len(), "stale lines in golden.toml");
    for (name, hash) in &lines {
        let is_hash = hash.len() == 16 && hash.chars().all(|c| c.is_ascii_hexdigit());
        assert!(is_hash, "{name} did not reach its last step: {hash}");
    }
    let hashes: std::collections::BTreeSet<_> = lines.iter().map(|(_, hash)| hash).collect();
    assert_eq!(hashes.len(), lines.len(), "two golden lines end in the same state");
}
