//! Joints held to formulas that know nothing of the solver, to their limits, and to the same bits at every width.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::f64::consts::TAU;

use lamina2d::body::BodyId;
use lamina2d::force::Forces;
use lamina2d::joint::{
    Distance, JointError, JointId, JointKind, JointSpec, JointSpring, Limits, Motor, Revolute, Weld,
};
use lamina2d::lanes::{f32s, f64s};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec, by_name, jointed};
use lamina2d::settings::{Settings, Solver};
use lamina2d::world::World;

use crate::shared_joints::{DT_SECS, GRAVITY, advance, energy, gaps, in_f64};
use crate::shared_motion::{at_every_width, disc, scene_of, start};

fn with_joints(bodies: Vec<BodySpec>, joints: Vec<JointSpec>, forces: Forces) -> Scene {
    Scene { joints, ..scene_of(bodies, forces) }
}

/// Half a period from a quarter turn: T = 2π·√(L/g)/AGM(1, cos ½θ₀), Gauss.
fn exact_period_secs(length: f64, start_rad: f64) -> f64 {
    let (mut a, mut b) = (1.0, (start_rad / 2.0).cos());
    for _ in 0..8 {
        (a, b) = (0.5 * (a + b), f64::sqrt(a * b));
    }
    TAU * (length / GRAVITY).sqrt() / a
}

/// Period, stretch and energy of a pendulum let go level, over 20 s.
fn swing(settings: Settings) -> [f64; 3] {
    let mut world = start(&by_name("pendulum", None, 1).unwrap(), settings);
    let level = energy(&*world);
    let (mut crossings, mut stretch, mut gained) = (Vec::new(), 0.0f64, f64::MIN);
    let mut last = world.states()[1].position[0];
    for step in 1..=1200 {
        world.step(DT_SECS).unwrap();
        let [x, y] = world.states()[1].position;
        if last > 0.0 && x <= 0.0 {
            crossings.push((f64::from(step) - x / (x - last)) * DT_SECS);
        }
        last = x;
        stretch = stretch.max((x.hypot(y) - 1.0).abs());
        gained = gained.max(energy(&*world) - level);
    }
    let period = (crossings.last().unwrap() - crossings[0]) / (crossings.len() - 1) as f64;
    [period, stretch, gained]
}

#[test]
fn a_pendulum_keeps_the_time_of_the_exact_formula_its_length_and_its_energy() {
    let exact = exact_period_secs(1.0, TAU / 4.0);
    assert!((exact - 7.416_298_7 / GRAVITY.sqrt()).abs() < 1e-7, "K(k) of the tables");
    for (settings, bounds) in [
        (in_f64(), [1e-4, 2e-4, 1e-8]),
        (Settings { substeps: 16, ..in_f64() }, [6e-6, 1e-5, 1e-8]),
        (Settings::default(), [1e-4, 2e-4, 1e-6]),
        (Settings { solver: Solver::Pgs, ..in_f64() }, [1e-3, 5e-3, 1e-2]),
    ] {
        let [period, stretch, gained] = swing(settings);
        let late = period / exact - 1.0;
        println!(
            "pendulum {} {} × {}: period {late:+.2e}, stretch {stretch:.2e} m, energy {gained:+.2e} J",
            settings.precision, settings.solver, settings.substeps
        );
        assert!(late.abs() < bounds[0] && stretch < bounds[1], "{late} {stretch}");
        assert!(gained < bounds[2] * GRAVITY, "{gained} J above the start");
    }
}

fn hinge(anchor: [f64; 2], motor: Option<Motor>, limits: Option<Limits>) -> JointKind {
    JointKind::Revolute(Revolute { anchor, motor, limits })
}

/// A world of two bodies and a joint.
fn pair_world(a: BodySpec, b: BodySpec, kind: JointKind, forces: Forces) -> (World<f64s::X4>, JointId) {
    let scene = with_joints(vec![a, b], vec![JointSpec::new(0, 1, kind)], forces);
    let world = World::from_scene(&scene, in_f64()).unwrap();
    let id = world.joints().ids().next().unwrap();
    (world, id)
}

/// 0.25 N·m on 0.125 kg·m²: 2 rad/s more each second, until the speed is reached.
#[test]
fn a_motor_reaches_its_speed_and_its_torque_is_bounded() {
    for speed in [3.0, -3.0] {
        let wheel = BodySpec::new(ShapeSpec::Circle(0.5), [1.0, 2.0]).mass(1.0);
        let kind = hinge([1.0, 2.0], Some(Motor { speed, max_torque: 0.25 }), None);
        let (mut world, id) = pair_world(disc([1.0, 2.0]).fixed(), wheel, kind, Forces::default());
        for step in 1..=120 {
            world.step(DT_SECS).unwrap();
            let expected = f64::min(2.0 * f64::from(step) * DT_SECS, 3.0).copysign(speed);
            let spin = world.bodies().w[2];
            assert!((spin - expected).abs() < 1e-9, "step {step}: {spin}, expected {expected}");
            let torque = world.joints().held(id).unwrap().drive / (DT_SECS / 4.0);
            assert!(torque.abs() <= 0.25 * (1.0 + 1e-12), "{torque} N·m");
        }
    }
    // Against a weight of 2 N·m it cannot lift, it does not; with ten times the torque it does.
    for (max_torque, turns) in [(1.0, false), (10.0, true)] {
        let arm = BodySpec::new(ShapeSpec::Box([0.25, 0.05]), [0.25, 0.0]).mass(2.0 / (0.25 * GRAVITY));
        let kind = hinge([0.0; 2], Some(Motor { speed: 2.0, max_torque }), None);
        let (mut world, id) = pair_world(disc([0.0; 2]).fixed(), arm, kind, Forces::gravity());
        for _ in 0..600 {
            world.step(DT_SECS).unwrap();
        }
        let angle = world.joints().held(id).unwrap().angle;
        assert_eq!(angle > 15.0, turns, "{angle} rad after ten seconds");
    }
}

/// A bar falls on its lower limit; thrown up it stops at its upper one; whole turns count.
#[test]
fn limits_hold() {
    let bar = BodySpec::new(ShapeSpec::Box([0.5, 0.05]), [0.5, 0.0]);
    let limits = Limits { lower: -0.3, upper: 0.5 };
    for (spin, end, solver) in
        [(0.0, -0.3, Solver::Soft), (20.0, -0.3, Solver::Soft), (0.0, -0.3, Solver::Pgs)]
    {
        let thrown = bar.clone().moving([0.0, 0.5 * spin], spin);
        let scene = with_joints(
            vec![disc([0.0; 2]).fixed(), thrown],
            vec![JointSpec::new(0, 1, hinge([0.0; 2], None, Some(limits)))],
            Forces::gravity(),
        );
        let mut world = World::<f64s::X4>::from_scene(&scene, Settings { solver, ..in_f64() }).unwrap();
        let attitude = |world: &World<f64s::X4>| world.bodies().s[2].atan2(world.bodies().c[2]);
        for _ in 0..300 {
            world.step(DT_SECS).unwrap();
            let angle = attitude(&world);
            assert!((-0.31..0.51).contains(&angle), "{angle} rad");
        }
        let angle = attitude(&world);
        assert!((angle - end).abs() < 1e-3, "rests at {angle} rad");
        let id = world.joints().ids().next().unwrap();
        assert!((world.joints().held(id).unwrap().angle - angle).abs() < 1e-2);
    }
    // Two turns and a half.
    let limits = Limits { lower: 0.0, upper: 2.5 * TAU };
    let wheel = BodySpec::new(ShapeSpec::Circle(0.5), [0.0; 2]).moving([0.0; 2], 8.0);
    let (mut world, id) =
        pair_world(disc([0.0; 2]).fixed(), wheel, hinge([0.0; 2], None, Some(limits)), Forces::default());
    for _ in 0..300 {
        world.step(DT_SECS).unwrap();
    }
    let angle = world.joints().held(id).unwrap().angle;
    assert!((angle - 2.5 * TAU).abs() < 1e-3 && world.bodies().w[2].abs() < 1e-6, "{angle} rad");
}

#[test]
fn ropes_and_springs_do_what_they_are_named_for() {
    // A rope of 2 m lets fall and then holds; a strut of at least 0.8 m keeps off.
    let rope = Distance { max: Some(2.0), ..Distance::default() };
    let kind = JointKind::Distance(rope);
    let bob = || disc([1.0, 0.0]).mass(1.0);
    let (mut world, _) = pair_world(disc([0.0; 2]).fixed(), bob(), kind, Forces::gravity());
    let mut longest = 0.0f64;
    for step in 0..600 {
        world.step(DT_SECS).unwrap();
        let bodies = world.bodies();
        longest = longest.max(bodies.x[2].hypot(bodies.y[2]));
        assert!(step > 20 || (bodies.x[2] - 1.0).abs() < 1e-12, "falls freely at first");
    }
    assert!((longest - 2.0).abs() < 2e-3, "{longest} m");
    let strut = JointKind::Distance(Distance { min: Some(0.8), ..Distance::default() });
    let (mut world, _) =
        pair_world(disc([0.0; 2]).fixed(), bob().moving([-1.0, 0.0], 0.0), strut, Forces::default());
    for _ in 0..60 {
        world.step(DT_SECS).unwrap();
        assert!(world.bodies().x[2] > 0.8 - 1e-6);
    }
    assert!((world.bodies().x[2] - 0.8).abs() < 1e-6, "it came to rest there");
    // A spring of 2 Hz, 0.5 m out: the implicit midpoint keeps its amplitude.
    let spring = Some(JointSpring { hertz: 2.0, damping: 0.0 });
    let kind = JointKind::Distance(Distance { length: Some(0.5), spring, ..Distance::default() });
    let (mut world, _) = pair_world(disc([0.0; 2]).fixed(), bob(), kind, Forces::default());
    let mut extremes = [f64::MAX, f64::MIN];
    for step in 1..=600 {
        world.step(DT_SECS).unwrap();
        let x = world.bodies().x[2];
        extremes = [x.min(extremes[0]), x.max(extremes[1])];
        if step == 60 {
            assert!((x - 1.0).abs() < 1e-3, "after two periods: {x}");
        }
    }
    assert!(extremes[0] > -1e-3 && extremes[1] < 1.0 + 1e-3, "{extremes:?}");
}

/// A bar of 1 m and 1 kg held at one end: rigidly, and by a spring that gives τ/(I·ω²).
#[test]
fn a_weld_keeps_a_cantilever_angle() {
    let bar = || BodySpec::new(ShapeSpec::Box([0.5, 0.05]), [0.5, 0.0]).mass(1.0);
    let sag = |spring| {
        let kind = JointKind::Weld(Weld { anchor: [0.0; 2], spring });
        let (mut world, id) = pair_world(disc([0.0; 2]).fixed(), bar(), kind, Forces::gravity());
        for _ in 0..600 {
            world.step(DT_SECS).unwrap();
        }
        let [a, b] = world.joints().anchors_world(id, world.bodies()).unwrap();
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-3, "the point is rigid");
        -world.bodies().s[2].atan2(world.bodies().c[2])
    };
    let rigid = sag(None);
    println!("cantilever: {rigid:.2e} rad");
    assert!(rigid.abs() < 1e-3, "{rigid} rad");
    let inertia = (1.0 + 0.01) / 12.0 + 0.25;
    let soft = sag(Some(JointSpring { hertz: 2.0, damping: 0.7 }));
    let statics = 0.5 * GRAVITY * soft.cos() / (inertia * (2.0 * TAU).powi(2));
    assert!((soft / statics - 1.0).abs() < 1e-3, "{soft} rad, {statics} by statics");
}

/// Two welds between the same two bodies, one of them on a lever of 24 radii, say the same thing twice.
#[test]
fn welds_side_by_side_are_one_weld() {
    let mut light = disc([0.0; 2]).mass(0.06).moving([0.0; 2], -7.0);
    light.shape = ShapeSpec::Circle(0.1);
    let welds = [JointKind::weld([0.0; 2]), JointKind::weld([-2.4, 0.0])];
    let scene = |welds: &[JointKind]| {
        let joints = welds.iter().map(|weld| JointSpec::new(0, 1, weld.clone())).collect();
        with_joints(vec![light.clone(), disc([0.0; 2]).mass(1.0)], joints, Forces::default())
    };
    for &solver in Solver::ALL {
        let [one, two] = [&welds[..1], &welds].map(|welds| {
            let mut world = start(&scene(welds), Settings { solver, ..in_f64() });
            advance(&mut *world, 60);
            (world.states()[1].angular_velocity, gaps(&*world)[0])
        });
        println!("{solver}: {one:?} rad/s and m, twice {two:?}");
        // The point's softness against the rigid row had the second weld's gap grow by 60 each substep.
        assert!((one.0 - two.0).abs() < 1e-3 * one.0.abs() && two.1 < 1e-3, "{solver}: {one:?} {two:?}");
    }
}

#[test]
fn two_free_bodies_keep_their_momentum() {
    let springy = Some(JointSpring { hertz: 3.0, damping: 0.1 });
    for (name, kind, drift) in [
        ("hinge", JointKind::hinge([1.0, 0.2]), 1e-9),
        ("weld", JointKind::weld([1.0, 0.2]), 1e-9),
        ("rod", JointKind::rod(), 1e-9),
        ("spring", JointKind::Distance(Distance { spring: springy, ..Distance::default() }), 1e-9),
    ] {
        let a = BodySpec::new(ShapeSpec::Box([0.5, 0.2]), [0.0; 2]).mass(2.0).moving([1.0, -2.0], 3.0);
        let b = BodySpec::new(ShapeSpec::Circle(0.3), [2.0, 0.5]).mass(0.7).moving([-1.0, 3.0], -2.0);
        let scene = with_joints(vec![a, b], vec![JointSpec::new(0, 1, kind)], Forces::default());
        let mut world = start(&scene, in_f64());
        let before = world.invariants();
        advance(&mut *world, 600);
        let after = world.invariants();
        for k in 0..2 {
            let change = after.momentum[k] - before.momentum[k];
            assert!(change.abs() < 1e-12, "{name}: momentum changed by {change}");
        }
        let change = after.angular_momentum / before.angular_momentum - 1.0;
        println!("{name}: angular momentum {change:+.2e}");
        assert!(change.abs() < drift, "{name}: angular momentum changed by {change}");
        assert!(after.kinetic_energy < before.kinetic_energy * (1.0 + 1e-4), "{name}");
    }
}

#[test]
fn joints_end_in_the_same_bits_at_every_width() {
    for name in ["chain/30", "bridge", "joint_grid", "pendulum"] {
        let scene = by_name(name, None, 1).unwrap();
        for solver in [Solver::Soft, Solver::Pgs] {
            let mut hashes = Vec::new();
            for settings in at_every_width(Settings { solver, ..Settings::default() }) {
                let mut world = start(&scene, settings);
                advance(&mut *world, if solver == Solver::Soft { 300 } else { 60 });
                hashes.push((settings.precision, world.hash()));
            }
            for (precision, hash) in &hashes {
                let (_, first) = hashes.iter().find(|(p, _)| p == precision).unwrap();
                assert_eq!(hash, first, "{name} {solver}: {hashes:?}");
            }
        }
    }
}

/// More joints on a hub than there are colours, of two kinds: the rest is solved one at a time.
#[test]
fn a_hub_of_a_hundred_joints_is_the_same_at_every_width() {
    let mut bodies = vec![BodySpec::new(ShapeSpec::Circle(1.0), [0.0; 2])];
    let mut joints = Vec::new();
    for k in 0..100 {
        let (s, c) = (TAU * f64::from(k) / 100.0).sin_cos();
        bodies.push(BodySpec { collides_with: 0, ..disc([2.0 * c, 2.0 * s]) }.moving([-s, c], 0.0));
        let kind = if k % 3 == 0 { JointKind::rod() } else { JointKind::hinge([c, s]) };
        joints.push(JointSpec::new(0, bodies.len() - 1, kind));
    }
    let scene = with_joints(bodies, joints, Forces::default());
    let end = |settings| {
        let mut world = start(&scene, settings);
        advance(&mut *world, 60);
        (world.hash(), world.joint_anchors().len())
    };
    let narrow = end(Settings { lanes: 1, ..Settings::default() });
    assert_eq!(narrow.1, 100);
    for lanes in [4, 8, 16] {
        assert_eq!(end(Settings { lanes, ..Settings::default() }), narrow);
    }
}

fn id_of(world: &World<f32s::X8>, slot: usize) -> BodyId {
    world.bodies().id(slot).unwrap()
}

/// Two discs that overlap: as long as a joint holds them they do not collide, unless it says so.
#[test]
fn joined_bodies_pass_through_each_other_unless_they_are_to_collide() {
    let bodies = vec![disc([0.0; 2]), disc([0.15, 0.0]), disc([0.1, 0.1])];
    let scene = scene_of(bodies, Forces::default());
    for broad in lamina2d::settings::Broad::ALL {
        let settings = Settings { broad: *broad, ..Settings::default() };
        let mut world = World::<f32s::X8>::from_scene(&scene, settings).unwrap();
        let pairs = |world: &mut World<f32s::X8>| {
            world.step(1e-6).unwrap();
            world.pairs().to_vec()
        };
        assert_eq!(pairs(&mut world), [[1, 2], [1, 3], [2, 3]]);
        let ends = [id_of(&world, 2), id_of(&world, 1)];
        let apart = world.insert_joint(ends, JointKind::rod(), false).unwrap();
        let touching = world.insert_joint([ends[1], id_of(&world, 3)], JointKind::rod(), true).unwrap();
        assert_eq!(pairs(&mut world), [[1, 3], [2, 3]]);
        assert!(world.contacts().iter().all(|contact| contact.a != 1 || contact.b != 2));
        world.remove_joint(apart).unwrap();
        assert_eq!(pairs(&mut world), [[1, 2], [1, 3], [2, 3]]);
        assert_eq!(world.joints().ids().collect::<Vec<_>>(), [touching]);
    }
}

#[test]
fn joints_and_bodies_taken_out_on_the_way_leave_nothing_behind() {
    let mut world = World::<f32s::X8>::from_scene(&jointed::chain(10, None), Settings::default()).unwrap();
    let ids: Vec<_> = world.joints().ids().collect();
    for _ in 0..30 {
        world.step(DT_SECS).unwrap();
    }
    // The lower half comes off: its centre of mass falls freely.
    world.remove_joint(ids[5]).unwrap();
    let stale = world.remove_joint(ids[5]).unwrap_err();
    assert_eq!(stale.to_string(), "no joint has the id of place 5, generation 0");
    let velocity = |world: &World<f32s::X8>| (7..=11).map(|slot| world.bodies().vy[slot]).sum::<f32>() / 5.0;
    let before = velocity(&world);
    for _ in 0..6 {
        world.step(DT_SECS).unwrap();
    }
    let fallen = f64::from(velocity(&world) - before);
    assert!((fallen + 0.1 * GRAVITY).abs() < 1e-3, "{fallen} m/s in 0.1 s");
    // A link goes, and both its joints; its slot's next owner is not joined.
    world.remove(id_of(&world, 3)).unwrap();
    assert_eq!(world.joints().len(), 7);
    assert!(matches!(world.joints().get(ids[1]), Err(JointError::Stale { place: 1, generation: 0 })));
    let guest = world.insert(&disc([50.0, 0.0])).unwrap();
    assert_eq!(guest.slot(), 3);
    for _ in 0..60 {
        world.step(DT_SECS).unwrap();
    }
    assert!((world.bodies().x[3] - 50.0).abs() < 1e-6, "nothing pulls it");
    // The lowest place is filled first, under a new generation.
    let hung = world.insert_joint([guest, id_of(&world, 1)], JointKind::rod(), false).unwrap();
    assert_eq!(world.joints().ids().nth(1), Some(hung));
    // Behind the world's back, too.
    world.bodies_mut().remove(guest).unwrap();
    world.step(DT_SECS).unwrap();
    assert_eq!(world.joints().len(), 7);
    // And the last one: free flight again.
    for id in world.joints().ids().collect::<Vec<_>>() {
        world.remove_joint(id).unwrap();
    }
    assert!(world.joints().is_empty());
    world.step(DT_SECS).unwrap();
    assert!(world.solving().joints().is_empty() || world.counts().contacts == 0);
}

#[test]
fn other_settings_keep_the_joints() {
    let mut world = start(&by_name("bridge/12", None, 1).unwrap(), Settings::default());
    advance(&mut *world, 60);
    let mut ends = Vec::new();
    for lanes in [1, 16] {
        let mut other = world.with_settings(Settings { lanes, substeps: 8, ..Settings::default() }).unwrap();
        assert_eq!(other.joint_anchors(), world.joint_anchors());
        advance(&mut *other, 60);
        assert!(gaps(&*other)[0] < 0.01);
        ends.push(other.hash());
    }
    assert_eq!(ends[0], ends[1]);
}
