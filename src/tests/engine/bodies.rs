//! The life of bodies: ids and holes, static and kinematic ones, filters, impulses, forces, bytes, and
//! states that stop being finite. Held against arithmetic, and against worlds where it never happened.

#![expect(clippy::unwrap_used, reason = "functions generic over lanes are tests too")]

use lamina2d::body::{Bodies, BodyError, BodyId};
use lamina2d::force::Forces;
use lamina2d::lanes::{Lanes, Real, f32s, f64s};
use lamina2d::measure::Stage;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Settings, Skip, Skips, Solver};
use lamina2d::world::{StepError, World};

use crate::shared_motion::{DT_SECS, disc, every_field, scene_of};

/// Calls a function generic over lanes at every precision and width.
macro_rules! at_every_width {
    ($test:ident) => {
        $test::<f32s::X1>();
        $test::<f32s::X4>();
        $test::<f32s::X8>();
        $test::<f32s::X16>();
        $test::<f64s::X1>();
        $test::<f64s::X4>();
    };
}

fn world<L: Lanes>(bodies: &[BodySpec], forces: Forces) -> World<L> {
    World::from_scene(&scene_of(bodies.to_vec(), forces), Settings::default()).expect("the scene is good")
}

fn advance<L: Lanes>(world: &mut World<L>, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

fn id<L: Lanes>(world: &World<L>, slot: usize) -> BodyId {
    world.bodies().id(slot).expect("a living body")
}

/// x, y, c, s, vx, vy, w of a slot.
fn state<R: Real>(bodies: &Bodies<R>, at: usize) -> [R; 7] {
    [bodies.x[at], bodies.y[at], bodies.c[at], bodies.s[at], bodies.vx[at], bodies.vy[at], bodies.w[at]]
}

#[test]
fn stale_ids_are_refused_by_slot_and_generation() {
    let mut world = world::<f32s::X8>(&[disc([0.0; 2]), disc([1.0, 0.0])], Forces::default());
    let old = id(&world, 1);
    world.remove(old).unwrap();
    let stale = BodyError::Stale { slot: 1, generation: 0 };
    assert_eq!(stale.to_string(), "no living body has the id of slot 1, generation 0");
    assert_eq!(world.bodies().check_alive(old), Err(stale.clone()), "while the slot is a hole");
    let new = world.insert(&disc([5.0, 0.0])).unwrap();
    assert_eq!((new.slot(), old.slot()), (1, 1));
    assert_ne!(new, old);
    let untouched = state(world.bodies(), 1);
    assert_eq!(world.remove(old), Err(stale.clone()));
    assert_eq!(world.apply_impulse(old, [1.0, 0.0], 1.0), Err(stale.clone()));
    assert_eq!(world.bodies_mut().set_force(old, [1.0, 0.0], 1.0), Err(stale));
    assert_eq!(state(world.bodies(), 1), untouched, "the successor feels nothing");
    assert_eq!(world.bodies().check_alive(new), Ok(1));
    world.remove(new).unwrap();
    assert!(world.remove(new).is_err(), "nobody is removed twice");
    assert_eq!((world.bodies().live(), world.bodies().id(1), world.bodies().id(99)), (1, None, None));
}

#[test]
fn the_lowest_hole_is_filled_first_whatever_the_order_of_removals() {
    for order in [[2, 5, 3], [5, 3, 2], [3, 2, 5], [2, 3, 5]] {
        let six: Vec<_> = (0..6).map(|k| disc([f64::from(k), 0.0])).collect();
        let mut world = world::<f32s::X4>(&six, Forces::default());
        for slot in order {
            world.remove(id(&world, slot)).unwrap();
        }
        assert_eq!(world.bodies().slots().collect::<Vec<_>>(), [1, 4, 6]);
        let slots: Vec<_> = (0..4).map(|_| world.insert(&disc([9.0, 0.0])).unwrap().slot()).collect();
        assert_eq!(slots, [2, 3, 5, 7], "removed in order {order:?}");
    }
}

/// A busy scene with strangers in it: every third body is one; returns the scene and their slots.
fn with_strangers() -> (Scene, Scene, Vec<usize>) {
    let without = by_name("all/40", None, 5).expect("a named scene");
    let mut bodies = Vec::new();
    let mut strangers = Vec::new();
    for (k, body) in without.bodies.iter().enumerate() {
        if k % 3 == 1 {
            bodies.push(BodySpec { force: [3.0, 1.0], torque: 0.5, ..body.clone() }.moving([0.0; 2], 0.0));
            strangers.push(bodies.len());
        }
        bodies.push(body.clone());
    }
    (Scene { bodies, ..without.clone() }, without, strangers)
}

/// What holds: after a removal the world goes on, to the bit and in the order of slots, as a world in
/// which the other bodies alone were inserted in that order. (Slots differ; what depends on slots is
/// only their order.)
fn removed_bodies_leave_no_trace<L: Lanes>() {
    let (with, without, strangers) = with_strangers();
    let settings = Settings::default();
    let mut world = World::<L>::from_scene(&with, settings).unwrap();
    for &slot in strangers.iter().rev() {
        world.remove(id(&world, slot)).unwrap();
    }
    let mut plain = World::<L>::from_scene(&without, settings).unwrap();
    assert_eq!(world.hash(), plain.hash());
    for step in 0..200 {
        world.step(DT_SECS).unwrap();
        plain.step(DT_SECS).unwrap();
        assert_eq!(world.hash(), plain.hash(), "step {step}");
    }
    assert!(plain.counts().contacts > 20, "the scene tests contacts");
    assert_eq!(world.counts().contacts, plain.counts().contacts);
    // The holes are filled from the lowest: as if inserted there in the first place (without the impulses of the
    // last step, which only the one that has run has).
    let settings = Settings { solver: Solver::Impulse, skips: Skips::EXACT, ..settings };
    let mut world = World::<L>::from_bodies(world.bodies().clone(), without.forces, settings).unwrap();
    let guest = disc([0.0, 30.0]).moving([1.0, -2.0], 3.0);
    world.insert(&guest).unwrap();
    let mut specs = without.clone();
    specs.bodies.insert(strangers[0] - 1, guest);
    let mut rebuilt = World::<L>::from_scene(&specs, settings).unwrap();
    copy_states(&world, &mut rebuilt);
    advance(&mut world, 60);
    advance(&mut rebuilt, 60);
    assert_eq!(world.hash(), rebuilt.hash());
}

/// Copies poses and velocities from slot to slot, in the order of living bodies.
fn copy_states<L: Lanes>(from: &World<L>, to: &mut World<L>) {
    let targets: Vec<usize> = to.bodies().slots().collect();
    for (source, target) in from.bodies().slots().zip(targets) {
        let [x, y, c, s, vx, vy, w] = state(from.bodies(), source);
        let bodies = to.bodies_mut();
        (bodies.x[target], bodies.y[target]) = (x, y);
        (bodies.c[target], bodies.s[target]) = (c, s);
        (bodies.vx[target], bodies.vy[target], bodies.w[target]) = (vx, vy, w);
    }
}

#[test]
fn a_removed_body_leaves_no_trace_at_any_width() {
    at_every_width!(removed_bodies_leave_no_trace);
}

/// Removed while it carries others: the rest go on as a world built without it from their states.
fn removal_in_the_middle<L: Lanes>() {
    let scene = by_name("stack/6", None, 0).expect("a named scene");
    let mut world = World::<L>::from_scene(&scene, Settings::default()).unwrap();
    advance(&mut world, 50);
    world.remove(id(&world, 4)).unwrap();
    let mut rest = scene.clone();
    rest.bodies.remove(3);
    let mut rebuilt = World::<L>::from_scene(&rest, Settings::default()).unwrap();
    copy_states(&world, &mut rebuilt);
    advance(&mut world, 100);
    advance(&mut rebuilt, 100);
    assert_eq!(world.hash(), rebuilt.hash());
}

#[test]
fn removing_a_carrier_leaves_the_others_as_they_are() {
    at_every_width!(removal_in_the_middle);
}

/// A kinematic plate rises and turns under a heap in every field: it alone decides how it moves.
fn kinematic_keeps_its_course<L: Lanes>() {
    let plate = BodySpec {
        kind: BodyKind::Kinematic,
        force: [1e3, 1e3],
        torque: 1e3,
        ..BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.0, 0.0])
    };
    let mut bodies = vec![plate.moving([0.25, 0.5], 0.125)];
    bodies.extend((0..8).map(|k| disc([0.3 * f64::from(k) - 1.0, 1.0]).mass(1000.0)));
    let mut world = world::<L>(&bodies, Forces { central: None, ..every_field() });
    let mut touched = 0;
    for n in 1..=128 {
        advance(&mut world, 1);
        touched += world.counts().contacts;
        let [x, y, c, s, vx, vy, w] = state(world.bodies(), 1).map(Real::to_f64);
        assert_eq!([vx, vy, w], [0.25, 0.5, 0.125], "its velocity is nobody's to change");
        let t = f64::from(n) * DT_SECS;
        // Products of powers of two: exact.
        assert_eq!([x, y], [0.25 * t, 0.5 * t]);
        let (sin, cos) = (0.125 * t).sin_cos();
        let round_off = f64::from(n) * <L::Elem as Real>::EPSILON.to_f64();
        assert!((c - cos).hypot(s - sin) < round_off, "step {n}");
    }
    assert!(touched > 100, "it carried them: {touched}");
}

#[test]
fn kinematic_bodies_move_with_their_velocity_and_nothing_else() {
    at_every_width!(kinematic_keeps_its_course);
}

fn static_stays<L: Lanes>() {
    let mut bodies = vec![
        BodySpec { force: [9.0, 9.0], torque: 9.0, ..BodySpec::new(ShapeSpec::Box([5.0, 0.5]), [0.1, 0.2]) }
            .turned(0.3)
            .fixed(),
    ];
    bodies.extend((0..8).map(|k| disc([0.5 * f64::from(k) - 1.0, 3.0]).moving([1.0, -50.0], 9.0).mass(1e4)));
    let mut world = world::<L>(&bodies, Forces { central: None, ..every_field() });
    let before = state(world.bodies(), 1);
    let mut touched = 0;
    for _ in 0..100 {
        advance(&mut world, 1);
        touched += world.counts().contacts;
        assert_eq!(state(world.bodies(), 1), before);
    }
    assert!(touched > 0, "it was hit");
}

#[test]
fn static_bodies_never_move() {
    at_every_width!(static_stays);
}

#[test]
fn filters_ask_both_sides_and_one_dynamic_body() {
    use BodyKind::{Dynamic, Kinematic, Static};
    let cases = [
        ((Dynamic, 1, u32::MAX), (Dynamic, 1, u32::MAX), true, "defaults"),
        ((Dynamic, 0b01, 0b10), (Dynamic, 0b10, 0b01), true, "each wants the other"),
        ((Dynamic, 0b01, 0b10), (Dynamic, 0b10, 0b10), false, "only A wants B"),
        ((Dynamic, 0b10, 0b10), (Dynamic, 0b01, 0b10), false, "only B wants A"),
        ((Dynamic, 0b110, 0b100), (Dynamic, 0b101, 0b010), true, "one bit of several is enough"),
        ((Dynamic, 1 << 31, u32::MAX), (Dynamic, 1, 1 << 31), true, "the highest bit"),
        ((Dynamic, 0, u32::MAX), (Dynamic, 1, u32::MAX), false, "in no category"),
        ((Dynamic, 1, 0), (Dynamic, 1, u32::MAX), false, "with nobody"),
        ((Static, 1, u32::MAX), (Dynamic, 1, u32::MAX), true, "static and dynamic"),
        ((Kinematic, 1, u32::MAX), (Dynamic, 1, u32::MAX), true, "kinematic and dynamic"),
        ((Static, 1, u32::MAX), (Kinematic, 1, u32::MAX), false, "static and kinematic"),
        ((Kinematic, 1, u32::MAX), (Kinematic, 1, u32::MAX), false, "two kinematic"),
        ((Static, 1, u32::MAX), (Static, 1, u32::MAX), false, "two static"),
    ];
    for (a, b, collide, why) in cases {
        let body =
            |(kind, category, collides_with), x| BodySpec { kind, category, collides_with, ..disc([x, 0.0]) };
        for [first, second] in [[a, b], [b, a]] {
            let mut world = world::<f32s::X8>(&[body(first, 0.0), body(second, 0.15)], Forces::default());
            let before = [state(world.bodies(), 1), state(world.bodies(), 2)];
            advance(&mut world, 1);
            assert_eq!(world.counts().contacts, usize::from(collide), "{why}");
            let after = [state(world.bodies(), 1), state(world.bodies(), 2)];
            assert_eq!(before != after, collide, "{why}: pushed apart");
        }
    }
}

/// Δv = J/m and Δω = L/I: to the bit where 1/m and 1/I are powers of two, else to the rounding of 1/m, the
/// product and the sum.
fn impulse_is_exact<L: Lanes>() {
    for (mass, exact) in [(0.5, true), (8.0, true), (3.0, false), (0.7, false)] {
        // A disc of radius 1: I = m/2.
        let body = BodySpec::new(ShapeSpec::Circle(1.0), [0.0; 2]).mass(mass).moving([1.0, -2.0], 0.5);
        let mut world = world::<L>(&[body], Forces::default());
        world.apply_impulse(id(&world, 1), [3.0, -0.25], 1.5).unwrap();
        let [x, y, c, s, vx, vy, w] = state(world.bodies(), 1).map(Real::to_f64);
        let expected = [1.0 + 3.0 / mass, -2.0 - 0.25 / mass, 0.5 + 1.5 / (mass / 2.0)];
        assert_eq!([x, y, c, s], [0.0, 0.0, 1.0, 0.0], "an impulse moves nothing at once");
        for (got, expected) in [vx, vy, w].into_iter().zip(expected) {
            let round_off = if exact { 0.0 } else { 2.0 * <L::Elem as Real>::EPSILON.to_f64() };
            assert!((got - expected).abs() <= round_off * expected.abs(), "{mass} kg: {got} for {expected}");
        }
    }
}

#[test]
fn impulses_change_velocities_by_j_over_m_and_l_over_i() {
    at_every_width!(impulse_is_exact);
}

/// 4 N and 1 N·m on 2 kg, I = 1: set, held, taken away again, and never inherited.
fn forces_act_as_set<L: Lanes>() {
    let body = BodySpec::new(ShapeSpec::Circle(1.0), [0.0; 2]).mass(2.0);
    let far = BodySpec::new(ShapeSpec::Circle(1.0), [50.0, 0.0]).mass(2.0);
    let mut world = world::<L>(&[body.clone(), far], Forces::default());
    let velocity = |world: &World<L>, slot| {
        let [.., vx, vy, w] = state(world.bodies(), slot).map(Real::to_f64);
        [vx, vy, w]
    };
    let first = id(&world, 1);
    advance(&mut world, 4);
    world.bodies_mut().set_force(first, [4.0, -2.0], 1.0).unwrap();
    advance(&mut world, 64);
    assert_eq!(velocity(&world, 1), [2.0, -1.0, 1.0], "one second of it");
    assert_eq!(velocity(&world, 2), [0.0; 3], "the other has none");
    world.bodies_mut().set_force(first, [0.0; 2], 0.0).unwrap();
    advance(&mut world, 64);
    assert_eq!(velocity(&world, 1), [2.0, -1.0, 1.0], "and no more");
    world.bodies_mut().set_force(first, [4.0, -2.0], 1.0).unwrap();
    world.remove(first).unwrap();
    assert_eq!(world.insert(&body).unwrap().slot(), 1);
    advance(&mut world, 8);
    assert_eq!(velocity(&world, 1), [0.0; 3], "the successor does not inherit it");
}

#[test]
fn forces_and_torques_act_from_when_they_are_set_until_they_are_taken_away() {
    at_every_width!(forces_act_as_set);
}

/// The table at the top of `body.rs`, per slot (world and padding to 64 slots included) and polygon.
#[test]
fn bytes_are_those_the_documentation_states() {
    fn bytes<R: Real>(specs: &[BodySpec]) -> usize {
        let mut bodies = Bodies::<R>::new();
        for spec in specs {
            bodies.insert(spec).expect("a good body");
        }
        bodies.bytes()
    }
    let discs: Vec<_> = (0..127).map(|k| disc([f64::from(k), 0.0])).collect();
    let mut pushed = discs.clone();
    pushed[5].torque = 1.0;
    let triangle = ShapeSpec::Polygon(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
    let mut mixed = discs.clone();
    mixed[..10].iter_mut().for_each(|body| body.shape = triangle.clone());
    assert_eq!(bytes::<f32>(&discs), 128 * (60 + 23));
    assert_eq!(bytes::<f64>(&discs), 128 * (120 + 23));
    assert_eq!(bytes::<f32>(&pushed), 128 * (60 + 23 + 12));
    assert_eq!(bytes::<f64>(&pushed), 128 * (120 + 23 + 24));
    assert_eq!(bytes::<f32>(&mixed), 128 * (60 + 23) + 10 * (256 + 5));
    assert_eq!(bytes::<f64>(&mixed), 128 * (120 + 23) + 10 * (512 + 5));
    assert_eq!(bytes::<f32>(&discs[..1]), 64 * 60 + 2 * 23, "hot columns come in 64s");
}

/// What a world says when it stops at its first step, and that it keeps the state it names.
fn stop<L: Lanes>(bodies: &[BodySpec], settings: Settings) -> (usize, &'static str, Stage) {
    let mut world = World::<L>::from_scene(&scene_of(bodies.to_vec(), Forces::default()), settings).unwrap();
    let error = world.step(DT_SECS).expect_err("overflows");
    let StepError::NonFinite { step, slot, column, value, stage } = error else { panic!("{error}") };
    assert_eq!((step, world.steps()), (1, 1));
    let column_of = |bodies: &Bodies<L::Elem>| match column {
        "vx" => bodies.vx[slot],
        "x" => bodies.x[slot],
        other => panic!("{other}"),
    };
    let kept = column_of(world.bodies()).to_f64();
    assert!(!value.is_finite() && (kept == value || kept.is_nan() && value.is_nan()), "{kept} {value}");
    let text = error.to_string();
    let named = format!("step 1: body in slot {slot} is no longer finite: {column} = {value} after {stage}");
    assert_eq!(text, named);
    (slot, column, stage)
}

/// Overflow by a force in the integrator; in the solver by an impulse (two of 1e30 kg meeting at 2e10 m/s)
/// and by a push (3e38 kg, 1.95 m deep), whatever the skips and the rounds per step.
fn overflow_is_named<L: Lanes>() {
    let (huge, light) = (<L::Elem as Real>::NAME == "f64", disc([9.0, 0.0]).mass(1e-3));
    let big = |in_f32: f64, in_f64: f64| if huge { in_f64 } else { in_f32 };
    let pushed = BodySpec { force: [big(3e38, 1e308), 0.0], ..light.clone() };
    let meeting = |x: f64, v: f64| disc([x, 0.0]).mass(big(1e30, 1e300)).moving([v, 0.0], 0.0);
    let round = BodySpec::new(ShapeSpec::Circle(1.0), [0.0, 1e4]);
    let heavy = BodySpec { position: [0.05, 1e4], ..round.clone() }.mass(big(3e38, 1.7e308));
    for skips in [Skips::ALL, Skips::NONE, Skips::ALL.without(Skip::FreeFlight)] {
        for substeps in [1, 3] {
            let settings = Settings { skips, substeps, solver: Solver::Impulse, ..Settings::default() };
            let at = |bodies: &[BodySpec]| stop::<L>(bodies, settings);
            let apart = BodySpec { position: [20.0, 0.0], ..pushed.clone() };
            assert_eq!(at(&[light.clone(), apart]), (2, "vx", Stage::Integrate));
            // Whom it touches is not blamed, though he comes first and caught it in the solver.
            assert_eq!(at(&[light.clone(), pushed.clone()]), (2, "vx", Stage::Integrate));
            let meet = [light.clone(), meeting(0.0, 1e10), meeting(0.15, -1e10)];
            assert_eq!(at(&meet), (2, "vx", Stage::Solve), "× {substeps}");
            let deep = [light.clone(), heavy.clone(), round.clone().fixed()];
            assert_eq!(at(&deep), (2, "x", Stage::Solve), "× {substeps}");
            // Contacts elsewhere do not take the blame.
            let both = [disc([0.0; 2]), disc([0.15, 0.0]), pushed.clone()];
            assert_eq!(at(&both), (3, "vx", Stage::Integrate), "× {substeps}");
        }
    }
}

#[test]
fn overflow_stops_the_run_with_step_slot_column_and_the_stage_that_began_it() {
    at_every_width!(overflow_is_named);
}
