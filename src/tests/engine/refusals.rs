//! Everything that is refused, held against its whole message: the item, the field, the value.
//!
//! Bodies, fields, steps and settings, scene files, and joints, one table each.

use lamina2d::body::{Bodies, BodyError};
use lamina2d::force::{Central, Forces, Spring};
use lamina2d::joint::{Distance, JointKind, JointSpec, JointSpring, Limits, Motor, Revolute};
use lamina2d::lanes::{Lanes, f32s, f64s};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, file};
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::simulate;
use lamina2d::world::{StepError, World};

use crate::shared_motion::{disc, scene_of};

/// What an `f32` world says to a body like a good one but for `change`, inserted as the third.
fn refusal(change: impl FnOnce(&mut BodySpec)) -> String {
    let mut bad = disc([1.0, 2.0]);
    change(&mut bad);
    let mut bodies = Bodies::<f32>::new();
    for _ in 0..2 {
        bodies.insert(&disc([0.0; 2])).expect("a good body");
    }
    let revision = bodies.revision();
    let error = bodies.insert(&bad).expect_err("refused");
    assert_eq!((bodies.live(), bodies.len(), bodies.revision()), (2, 3, revision), "nothing has changed");
    error.to_string()
}

const FAR: &str = "position must be less than 1e15 (f32) or 1e97 (f64) from the origin, got";
const NOT_FINITE: &str = "is not finite in this precision:";

#[test]
fn bad_places_speeds_and_forces_are_refused_by_field_and_value() {
    let nan = f64::NAN;
    // Finite in f64 alone.
    let beyond = 1e39;
    let cases = [
        (refusal(|b| b.position[0] = nan), format!("position {NOT_FINITE} NaN")),
        (refusal(|b| b.position[1] = f64::NEG_INFINITY), format!("position {NOT_FINITE} -inf")),
        (refusal(|b| b.position[1] = beyond), format!("position {NOT_FINITE} {beyond:?}")),
        (refusal(|b| b.position[0] = -2e15), format!("{FAR} -2000000000000000.0")),
        (refusal(|b| b.angle = nan), format!("angle {NOT_FINITE} NaN")),
        (refusal(|b| b.velocity[0] = beyond), format!("velocity {NOT_FINITE} {beyond:?}")),
        (refusal(|b| b.velocity[1] = nan), format!("velocity {NOT_FINITE} NaN")),
        (refusal(|b| b.angular_velocity = nan), format!("angular_velocity {NOT_FINITE} NaN")),
        (refusal(|b| b.force[0] = beyond), format!("force {NOT_FINITE} {beyond:?}")),
        (refusal(|b| b.force[1] = nan), format!("force {NOT_FINITE} NaN")),
        (refusal(|b| b.torque = f64::INFINITY), format!("torque {NOT_FINITE} inf")),
        (refusal(|b| b.friction = nan), format!("friction {NOT_FINITE} NaN")),
        (refusal(|b| b.friction = -0.5), "friction must be at least 0, got -0.5".into()),
        (refusal(|b| b.restitution = 1.5), "restitution must be 0 to 1, got 1.5".into()),
        (refusal(|b| b.restitution = -0.1), "restitution must be 0 to 1, got -0.1".into()),
        (refusal(|b| b.restitution = nan), "restitution must be 0 to 1, got NaN".into()),
    ];
    for (message, expected) in cases {
        assert_eq!(message, format!("body 2: {expected}"));
    }
}

#[test]
fn bad_matter_and_shapes_are_refused_by_field_and_value() {
    let positive = "must be positive and finite, got";
    let invertible = "must be invertible in this precision, got";
    let disc_of = |radius| move |b: &mut BodySpec| b.shape = ShapeSpec::Circle(radius);
    let cases = [
        (refusal(|b| b.mass = Some(0.0)), format!("mass {positive} 0.0")),
        (refusal(|b| b.mass = Some(-3.0)), format!("mass {positive} -3.0")),
        (refusal(|b| b.mass = Some(f64::NAN)), format!("mass {positive} NaN")),
        (refusal(|b| b.density = Some(f64::INFINITY)), format!("density {positive} inf")),
        (
            refusal(|b| (b.kind, b.density) = (BodyKind::Static, Some(-1.0))),
            format!("density {positive} -1.0"),
        ),
        (refusal(|b| b.mass = Some(1e-40)), format!("mass {invertible} {:?}", 1e-40)),
        (refusal(|b| b.mass = Some(1e50)), format!("mass {invertible} {:?}", 1e50)),
        // I = m/2·r²: 1/I overflows f32 though 1/m does not.
        (refusal(|b| b.mass = Some(2f64.powi(-127))), {
            // The disc's radius is 0.1: r² is not a power of two, so the value is what it is in f64.
            let inertia = disc([0.0; 2]).shape.build().unwrap().mass_properties();
            let value = 2f64.powi(-127) / inertia.area * inertia.second_moment;
            format!("moment of inertia {invertible} {value:?}")
        }),
        (
            refusal(|b| (b.mass, b.density) = (Some(2.0), Some(3.0))),
            "give mass or density, not both (mass 2.0, density 3.0)".into(),
        ),
        (
            refusal(|b| (b.kind, b.velocity) = (BodyKind::Static, [0.0, 4.0])),
            "a static body has no velocity, got 4.0; make it kinematic".into(),
        ),
        (
            refusal(|b| (b.kind, b.angular_velocity) = (BodyKind::Static, -1.0)),
            "a static body has no angular_velocity, got -1.0; make it kinematic".into(),
        ),
        (refusal(disc_of(-1.0)), format!("shape: radius {positive} -1.0")),
        (refusal(|b| b.shape = ShapeSpec::Box([1.0, 0.0])), format!("shape: half-extent y {positive} 0.0")),
        (
            refusal(|b| b.shape = ShapeSpec::Polygon(vec![[0.0; 2]; 2])),
            "shape: a polygon needs at least 3 vertices, got 2".into(),
        ),
        (
            refusal(disc_of(1e16)),
            "shape size must be less than 1e15 (f32) or 1e97 (f64) metres, got 1e16".into(),
        ),
    ];
    for (message, expected) in cases {
        assert_eq!(message, format!("body 2: {expected}"));
    }
}

/// What the same numbers mean in `f64`: nothing is wrong with them.
#[test]
fn what_f32_cannot_hold_f64_takes() {
    let mut bodies = Bodies::<f64>::new();
    for (position, velocity, mass) in [(1e16, 1e39, 1e-40), (-1e90, -1e300, 1e50)] {
        bodies.insert(&disc([position, 0.0]).moving([velocity, 0.0], 0.0).mass(mass)).unwrap();
    }
    assert!(bodies.insert(&disc([1e98, 0.0])).is_err());
}

/// Once slots are filled again a body's number is not to be had from its slot: slots are named.
#[test]
fn bad_impulses_and_forces_name_the_slot() {
    let mut bodies = Bodies::<f32>::new();
    let first = bodies.insert(&disc([0.0; 2])).unwrap();
    let fixed = bodies.insert(&disc([0.0; 2]).fixed()).unwrap();
    bodies.remove(first).unwrap();
    let third = bodies.insert(&disc([0.0; 2])).unwrap();
    let refused = |linear, angular| {
        let mut bodies = bodies.clone();
        let error = bodies.apply_impulse(third, linear, angular).expect_err("refused");
        let now = [bodies.vx[1], bodies.vy[1], bodies.w[1]];
        assert_eq!(now, [0.0; 3], "nothing has changed");
        error.to_string()
    };
    let expected = |field: &str, value: f64| {
        format!("body in slot 1: {field} is not finite in this precision: {value:?}")
    };
    assert_eq!(refused([f64::NAN, 0.0], 0.0), expected("impulse", f64::NAN));
    assert_eq!(refused([1.0, f64::INFINITY], 0.0), expected("impulse", f64::INFINITY));
    assert_eq!(refused([1.0, 1.0], 1e39), expected("impulse", 1e39));
    let of_force = |force, torque| bodies.clone().set_force(third, force, torque).unwrap_err().to_string();
    assert_eq!(of_force([0.0, f64::NAN], 0.0), expected("force", f64::NAN));
    assert_eq!(of_force([0.0; 2], -1e39), expected("torque", -1e39));
    let error = bodies.apply_impulse(fixed, [1.0, 0.0], 0.0).unwrap_err();
    assert_eq!(error, BodyError::NotDynamic(2));
    assert_eq!(error.to_string(), "body in slot 2 is not dynamic: an impulse cannot move it");
}

#[test]
fn bad_fields_are_refused_by_name_and_value() {
    let none = Forces::default();
    let spring = |x, stiffness| Forces { spring: Some(Spring { anchor: [x, 0.0], stiffness }), ..none };
    let central = |strength| Forces { central: Some(Central { center: [0.0; 2], strength }), ..none };
    let not_finite = |field, value: f64| format!("force {field}: {value:?} is not finite in this precision");
    let negative = |field| format!("force {field}: coefficient must not be negative, got -1.0");
    let beyond = 1e39;
    let cases = [
        (Forces { gravity: Some([0.0, f64::NAN]), ..none }, not_finite("gravity", f64::NAN)),
        (Forces { gravity: Some([beyond, 0.0]), ..none }, not_finite("gravity", beyond)),
        (Forces { linear_drag: Some(f64::INFINITY), ..none }, not_finite("linear_drag", f64::INFINITY)),
        (Forces { linear_drag: Some(beyond), ..none }, not_finite("linear_drag", beyond)),
        (Forces { linear_drag: Some(-1.0), ..none }, negative("linear_drag")),
        (Forces { quadratic_drag: Some(-1.0), ..none }, negative("quadratic_drag")),
        (Forces { quadratic_drag: Some(f64::NAN), ..none }, not_finite("quadratic_drag", f64::NAN)),
        (
            Forces { linear_drag: Some(1.0), wind: Some([f64::NAN, 0.0]), ..none },
            not_finite("wind", f64::NAN),
        ),
        (spring(f64::NAN, 1.0), not_finite("spring", f64::NAN)),
        (spring(0.0, beyond), not_finite("spring", beyond)),
        (central(f64::NEG_INFINITY), not_finite("central", f64::NEG_INFINITY)),
        (Forces { magnetic: Some(f64::NAN), ..none }, not_finite("magnetic", f64::NAN)),
        (
            Forces { wind: Some([1.0, 0.0]), ..none },
            "force wind: has no effect without linear_drag or quadratic_drag; give one of them".into(),
        ),
    ];
    for (forces, expected) in cases {
        let error = simulate(&scene_of(vec![disc([0.0; 2])], forces), Settings::default()).err();
        assert_eq!(error.map(|e| e.to_string()), Some(expected));
    }
}

fn bad_steps_change_nothing<L: Lanes>() {
    let scene = scene_of(vec![disc([0.0; 2])], Forces::gravity());
    let mut world = World::<L>::from_scene(&scene, Settings::default()).expect("the scene is good");
    let before = world.hash();
    for (dt, text) in
        [(0.0, "0.0"), (-0.0, "-0.0"), (-1e-3, "-0.001"), (f64::NAN, "NaN"), (f64::INFINITY, "inf")]
    {
        let error = world.step(dt).expect_err("refused");
        assert!(matches!(error, StepError::Dt(given) if given.to_bits() == dt.to_bits()), "{error}");
        assert_eq!(error.to_string(), format!("dt must be positive and finite, got {text}"));
        assert_eq!((world.hash(), world.steps()), (before, 0));
    }
    world.step(1.0 / 60.0).expect("and goes on");
}

#[test]
fn steps_of_no_length_are_refused() {
    bad_steps_change_nothing::<f32s::X8>();
    bad_steps_change_nothing::<f64s::X4>();
}

#[test]
fn bad_settings_are_refused_by_value_and_choices() {
    let good = Settings::default();
    let mut cases = vec![
        (Settings { dt_secs: 0.0, ..good }, "dt must be positive and finite in f32, got 0.0"),
        (Settings { dt_secs: -1.0, ..good }, "dt must be positive and finite in f32, got -1.0"),
        (Settings { dt_secs: f64::NAN, ..good }, "dt must be positive and finite in f32, got NaN"),
        (Settings { dt_secs: f64::INFINITY, ..good }, "dt must be positive and finite in f32, got inf"),
        (Settings { substeps: 0, ..good }, "substeps must be 1 to 1000, got 0"),
        (Settings { substeps: 1001, ..good }, "substeps must be 1 to 1000, got 1001"),
        (Settings { lanes: 0, ..good }, "lanes must be 1, 4, 8 or 16 with f32, got 0"),
        (Settings { lanes: 32, ..good }, "lanes must be 1, 4, 8 or 16 with f32, got 32"),
    ];
    let of_f64 = good.with_precision(Precision::F64);
    cases.push((Settings { lanes: 8, ..of_f64 }, "lanes must be 1 or 4 with f64, got 8"));
    let scene = scene_of(vec![disc([0.0; 2])], Forces::default());
    for (settings, expected) in cases {
        assert_eq!(settings.check().unwrap_err().to_string(), expected);
        assert_eq!(simulate(&scene, settings).err().map(|e| e.to_string()), Some(expected.to_owned()));
    }
    for settings in [Settings { substeps: 1000, ..good }, Settings { lanes: 1, ..of_f64 }] {
        assert_eq!(settings.check(), Ok(()));
    }
    let running = simulate(&scene, good).unwrap();
    let error = running.with_settings(of_f64).err().map(|e| e.to_string());
    assert_eq!(error.as_deref(), Some("a world of f32 cannot become one of f64"));
}

const DISC: &str = "[[body]]\nshape = { circle = 1.0 }\nposition = [0, 0]\n";

/// Where a file is wrong, the message names the file, the item, the value and what was expected.
#[test]
fn bad_scene_files_are_refused_by_item_field_and_value() {
    let cases: [(&str, &[&str]); 20] = [
        ("bodies = 3", &["scene file s.toml", "line 1", "unknown field `bodies`", "expected one of `about`"]),
        ("[settings]\nsubstep = 3", &["line 2", "unknown field `substep`", "`substeps`"]),
        ("[forces]\ngravityy = [0, 1]", &["line 2", "unknown field `gravityy`", "`gravity`"]),
        ("[settings]\ndt = \"fast\"", &["line 2", "invalid type: string \"fast\"", "f64"]),
        ("[settings]\nsteps = -1", &["line 2", "-1", "u64"]),
        ("[settings]\ndt = -0.5", &["scene file s.toml", "dt must be positive and finite in f32, got -0.5"]),
        ("[settings]\nsubsteps = 0", &["scene file s.toml", "substeps must be 1 to 1000, got 0"]),
        ("[settings]\nlanes = 3", &["scene file s.toml", "lanes must be 1, 4, 8 or 16 with f32, got 3"]),
        ("[settings]\nskip = \"sleep\"", &["scene file s.toml", "unknown skip 'sleep'", "closed_form"]),
        ("[settings]\nintegrator = \"rk5\"", &["line 2", "unknown variant `rk5`", "`yoshida4`"]),
        ("[forces]\nlinear_drag = -2", &["force linear_drag", "must not be negative", "got -2.0"]),
        ("[forces]\nwind = [1, 0]", &["force wind", "linear_drag or quadratic_drag"]),
        ("[forces]\nspring = { anchor = [0, nan], stiffness = 1 }", &["force spring", "NaN"]),
        ("[forces]\ncompanion = { center = [0, inf], strength = 1 }", &["force companion", "inf"]),
        ("[forces]\nhenon_heiles = nan", &["force henon_heiles", "NaN"]),
        ("[forces]\ndrive = { amplitude = [1, 0], rate = nan }", &["force drive", "NaN"]),
        (
            "[forces]\ndrive = { amplitude = [1, 0], rate = 1, delay = 2 }",
            &["line 2", "unknown field `delay`"],
        ),
        ("[forces]\nattraction = nan", &["force attraction", "NaN"]),
        ("[[body]]\nposition = [0, 0]", &["line 1", "missing field `shape`"]),
        (
            "[[body]]\nshape = { circle = 1.0 }\nposition = [0]",
            &["line 3", "expected two numbers [x, y], got 1"],
        ),
    ];
    for (text, expected) in cases {
        let message = file::parse("s.toml", text).expect_err(text).to_string();
        for part in expected {
            assert!(message.contains(part), "{text}\nsays\n{message}\nwithout\n{part}");
        }
    }
}

#[test]
fn bad_bodies_in_files_are_refused_when_a_world_takes_them_in() {
    let text = format!("{DISC}{DISC}friction = -1\n");
    let (scene, settings) = file::parse("s.toml", &text).unwrap();
    let error = simulate(&scene, settings).err().map(|e| e.to_string());
    assert_eq!(error.as_deref(), Some("body 1: friction must be at least 0, got -1.0"));
    for (line, named) in
        [("masss = 1", "`masss`"), ("kind = \"ghost\"", "`ghost`"), ("mass = \"1\"", "\"1\"")]
    {
        let message = file::parse("s.toml", &format!("{DISC}{line}\n")).unwrap_err().to_string();
        assert!(message.contains(named) && message.contains("line 4"), "{message}");
    }
}

#[test]
fn good_files_say_what_they_mean() {
    let text = format!(
        "about = \"a drop\"\n[settings]\ndt = 0.01\nsteps = 7\nintegrator = \"rk4\"\nprecision = \"f64\"\n\
         skip = \"rotation,friction\"\n[forces]\ngravity = [0, -10]\nlinear_drag = 1\n{DISC}mass = 2\n"
    );
    let (scene, settings) = file::parse("s.toml", &text).unwrap();
    assert_eq!((scene.steps, scene.bodies.len(), scene.bodies[0].mass), (7, 1, Some(2.0)));
    assert_eq!((settings.dt_secs, settings.lanes, settings.integrator.name()), (0.01, 4, "rk4"));
    assert_eq!(settings.skips.to_string(), "rotation,friction");
    assert!(simulate(&scene, settings).is_ok());
    let missing = file::read("/nowhere/s.toml").unwrap_err().to_string();
    assert!(missing.starts_with("cannot read scene file /nowhere/s.toml: "), "{missing}");
}

#[test]
fn bad_joints_are_refused_by_number_field_and_value() {
    let bodies = vec![
        disc([0.0; 2]),
        disc([1.0, 0.0]),
        disc([2.0, 0.0]).fixed(),
        BodySpec { kind: BodyKind::Kinematic, ..disc([3.0, 0.0]) },
    ];
    let scene =
        Scene { joints: vec![JointSpec::new(0, 1, JointKind::rod())], ..scene_of(bodies, Forces::default()) };
    let mut world = World::<f32s::X8>::from_scene(&scene, Settings::default()).unwrap();
    let gone = world.insert(&disc([9.0, 0.0])).unwrap();
    world.remove(gone).unwrap();
    let mut refused = |a: usize, b: usize, kind: JointKind| {
        let id = |slot: usize| if slot == 5 { gone } else { world.bodies().id(slot).unwrap() };
        let ends = [id(a), id(b)];
        let before = world.joints().revision();
        let message = world.insert_joint(ends, kind, false).unwrap_err().to_string();
        assert_eq!((world.joints().revision(), world.joints().len()), (before, 1), "nothing has changed");
        message
    };
    let length = |length| JointKind::Distance(Distance { length: Some(length), ..Distance::default() });
    let bounds = |min, max| JointKind::Distance(Distance { min, max, ..Distance::default() });
    let sprung = |hertz, damping| {
        let spring = Some(JointSpring { hertz, damping });
        JointKind::Distance(Distance { spring, ..Distance::default() })
    };
    let hinge = |motor, limits| JointKind::Revolute(Revolute { anchor: [0.0; 2], motor, limits });
    let motor = |speed, max_torque| hinge(Some(Motor { speed, max_torque }), None);
    let limits = |lower, upper| hinge(None, Some(Limits { lower, upper }));
    let nan = f64::NAN;
    let beyond = 1e39;
    let finite = "is not finite in this precision:";
    for (a, b, kind, message) in [
        (1, 5, JointKind::rod(), "no living body has the id of slot 5, generation 0".to_owned()),
        (1, 1, JointKind::rod(), "bodies: joins the body in slot 1 to itself; name two bodies".into()),
        (
            3,
            4,
            JointKind::rod(),
            "bodies: one of the two must be dynamic, these are static and kinematic".into(),
        ),
        (1, 2, length(0.0), "length must be positive, got 0.0".into()),
        (1, 2, length(-1.5), "length must be positive, got -1.5".into()),
        (1, 2, length(nan), format!("length {finite} NaN")),
        (1, 2, length(beyond), format!("length {finite} {beyond:?}")),
        (1, 2, bounds(Some(2.0), Some(1.0)), "min must not be above max, got 2.0 and 1.0".into()),
        (1, 2, bounds(Some(-1.0), None), "min must be at least 0, got -1.0".into()),
        (1, 2, bounds(None, Some(0.0)), "max must be positive, got 0.0".into()),
        (1, 2, bounds(None, Some(nan)), format!("max {finite} NaN")),
        (1, 2, sprung(-1.0, 0.0), "spring hertz must be positive, got -1.0".into()),
        (1, 2, sprung(nan, 0.0), format!("spring hertz {finite} NaN")),
        (1, 2, sprung(1.0, -0.5), "spring damping must be at least 0, got -0.5".into()),
        (1, 2, sprung(1.0, f64::INFINITY), format!("spring damping {finite} inf")),
        (1, 2, motor(1.0, -2.0), "motor max_torque must be at least 0, got -2.0".into()),
        (1, 2, motor(1.0, beyond), format!("motor max_torque {finite} {beyond:?}")),
        (1, 2, motor(nan, 1.0), format!("motor speed {finite} NaN")),
        (1, 2, limits(0.5, -0.5), "limits lower must not be above limits upper, got 0.5 and -0.5".into()),
        (1, 2, limits(nan, 0.0), format!("limits lower {finite} NaN")),
        (1, 2, JointKind::hinge([nan, 0.0]), format!("anchor {finite} NaN")),
        (1, 2, JointKind::weld([0.0, f64::INFINITY]), format!("anchor {finite} inf")),
        (
            1,
            2,
            JointKind::weld([0.0, 1e16]),
            "anchor must be less than 1e15 (f32) or 1e97 (f64) from the origin, got 1e16".into(),
        ),
    ] {
        assert_eq!(refused(a, b, kind), format!("joint 1: {message}"));
    }
    let missing = Scene { joints: vec![JointSpec::new(0, 7, JointKind::rod())], ..scene };
    let error = World::<f32s::X8>::from_scene(&missing, Settings::default()).err().unwrap();
    assert_eq!(error.to_string(), "joint 0: bodies: there is no body 7, the scene has 4, numbered from 0");
}
