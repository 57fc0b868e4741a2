//! Joints that close on themselves, and rods that swing, bounce and carry: solved at once, whatever the masses.

use lamina2d::force::Forces;
use lamina2d::joint::{Distance, JointKind, JointSpec, Motor, Revolute, Weld};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::Simulation;

use crate::EVERY;
use crate::shared_motion::{scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;
/// Standard gravity, m/s².
const G: f64 = 9.81;

fn advanced(scene: &Scene, steps: usize) -> Box<dyn Simulation> {
    let mut world = start(scene, Settings::default());
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
    world
}

fn disc(at: [f64; 2]) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(0.05), at)
}

fn rod(a: usize, b: usize) -> JointSpec {
    JointSpec::new(a, b, JointKind::Distance(Distance::default()))
}

/// Trusses that are just held and such that have rods to spare, light at their nodes and loaded in the middle, stand.
#[test]
fn trusses_carry_what_stands_on_them() {
    let cases = [2, 6, 10].into_iter().flat_map(|bays| {
        [1.0, 30.0, 1000.0].into_iter().flat_map(move |load| [false, true].map(|x| (bays, load, x)))
    });
    for (bays, load, crossed) in cases.step_by(EVERY) {
        let (nodes, middle) = (bays + 1, bays + 1 + bays / 2);
        let bodies = (0..2 * nodes).map(|k| match k {
            k if k == 0 || k == bays => disc([k as f64, 0.0]).fixed(),
            k => disc([(k % nodes) as f64, (k / nodes) as f64]).mass(if k == middle { load } else { 0.1 }),
        });
        let mut scene = scene_of(bodies.collect(), Forces::gravity());
        scene.joints = (0..nodes).map(|k| rod(k, nodes + k)).collect();
        for k in 0..bays {
            let bay = [rod(k, k + 1), rod(nodes + k, nodes + k + 1), rod(k, nodes + k + 1)];
            scene.joints.extend(bay);
            scene.joints.extend(crossed.then(|| rod(k + 1, nodes + k)));
        }
        let world = advanced(&scene, 600);
        for (k, state) in world.states().into_iter().enumerate() {
            let right = [(k % nodes) as f64, (k / nodes) as f64];
            let off = (state.position[0] - right[0]).hypot(state.position[1] - right[1]);
            assert!(off < 2e-3 * bays as f64, "{bays} bays, {load} kg, {crossed}: node {k} off by {off} m");
        }
        assert!(world.counts().direct_joints > 0 || load < 10.0, "{bays} bays, {load} kg");
    }
}

/// Boxes welded in a ring, hung from one of them, are one body: more rows than they have degrees of freedom.
#[test]
fn welded_rings_are_one_body() {
    for (count, load) in [5, 8, 12].into_iter().flat_map(|n| [50.0, 500.0].map(|load| (n, load))) {
        let turn = std::f64::consts::TAU / count as f64;
        let radius = 0.5 / (0.5 * turn).sin();
        let at = |k: f64| [-radius * (k * turn).sin(), radius * (k * turn).cos()];
        let link = |k: usize| {
            let spec = BodySpec::new(ShapeSpec::Box([0.4, 0.1]), at(k as f64));
            let spec = BodySpec { angle: k as f64 * turn, ..spec };
            if k == 0 { spec.fixed() } else { spec.mass(if k == count / 2 { load } else { 0.5 }) }
        };
        let mut scene = scene_of((0..count).map(link).collect(), Forces::gravity());
        let weld = |k: usize| JointKind::Weld(Weld { anchor: at(k as f64 + 0.5), spring: None });
        scene.joints = (0..count).map(|k| JointSpec::new(k, (k + 1) % count, weld(k))).collect();
        for (k, state) in advanced(&scene, 600).states().into_iter().enumerate() {
            let off = (state.position[0] - at(k as f64)[0]).hypot(state.position[1] - at(k as f64)[1]);
            assert!(off < 0.02 * radius, "{count} boxes, {load} kg: {k} off by {off} m");
        }
    }
}

/// A line of light beads on rods swings with the load at its end as one pendulum: substeps follow the beads across their rods.
#[test]
fn loads_on_rods_swing_as_pendulums() {
    for (links, load) in [2, 5, 20].into_iter().flat_map(|n| [10.0, 1000.0, 20_000.0].map(|load| (n, load))) {
        let (angle, long) = (0.05f64, 0.5 * f64::from(links));
        let at = |k: i32| [angle.sin(), -angle.cos()].map(|way| way * 0.5 * f64::from(k));
        let mass = |k: i32| if k == links { load } else { 0.1 };
        let bodies =
            std::iter::once(disc([0.0; 2]).fixed()).chain((1..=links).map(|k| disc(at(k)).mass(mass(k))));
        let mut scene = scene_of(bodies.collect(), Forces::gravity());
        scene.joints = (0..links as usize).map(|k| rod(k, k + 1)).collect();
        let mut world = start(&scene, Settings::default());
        for step in 1..=300 {
            world.step(DT_SECS).expect("stays finite");
            let phase = f64::from(step) * DT_SECS * (G / long).sqrt() / (1.0 + angle * angle / 16.0);
            let right = long * (angle * phase.cos()).sin();
            let found = world.states().last().expect("a load").position[0];
            // Light chains have their own weight, and with it another period.
            let bound = if load < 1000.0 { 0.1 } else { 0.02 };
            assert!(
                (found - right).abs() < bound * long * angle,
                "{links}, {load} kg, step {step}: {found}, {right}"
            );
        }
    }
}

/// A ball on a rod, guided by it onto a wall, bounces with e: along the rod it loses nothing that a wall would not take.
#[test]
fn what_rods_guide_bounces_with_its_energy() {
    for (reach, e) in [0.6, 1.0, 2.0, 5.0].into_iter().flat_map(|reach| [1.0, 0.8].map(|e| (reach, e))) {
        let still = |spec: BodySpec| spec.surface(1.0, 0.0).fixed();
        let wall = BodySpec::new(ShapeSpec::Box([0.5 * reach, 0.025]), [-reach, 0.0]);
        let ball = BodySpec::new(ShapeSpec::Circle(0.1 * reach), [reach, 0.0]).mass(1.0);
        let bodies = vec![still(disc([0.0; 2])), still(wall), ball.surface(e, 0.0).moving([0.0, 3.0], 0.0)];
        let mut scene = scene_of(bodies, Forces::default());
        scene.joints = vec![rod(0, 2)];
        let (mut world, mut bounces, mut before) = (start(&scene, Settings::default()), 0, 3.0);
        for step in 0..1200 {
            world.step(DT_SECS).expect("stays finite");
            let state = world.states()[2];
            let [[x, y], [vx, vy]] = [state.position, state.velocity];
            let around = (x * vy - y * vx) / reach;
            bounces += i32::from(around * before < 0.0);
            before = around;
            let right = 4.5 * e.powi(2 * bounces);
            let found = world.invariants().kinetic_energy;
            let off = (found / right - 1.0).abs();
            // Of second order in what the rod turns by in a step.
            let bound = (2.0 * (3.0 * DT_SECS / reach).powi(2)).max(2e-3) * f64::from(1 + bounces);
            assert!(off < bound, "{reach} m, e = {e}, step {step}, bounce {bounces}: {found}, {right}");
        }
        assert!(bounces > 1, "{reach} m: {bounces} bounces");
    }
}

/// A ball that bounces is no concern of what joints hold elsewhere: bit for bit as without it.
#[test]
fn motors_do_not_turn_further_where_something_bounces() {
    for (speed, max_torque) in [(5.0, 1e6), (0.5, 1e6), (5.0, 0.1)] {
        let wheel = |with_ball: bool| {
            let motor = Some(Motor { speed, max_torque });
            let mut bodies = vec![
                BodySpec::new(ShapeSpec::Box([1.0, 0.5]), [0.0, -0.5]).fixed().surface(1.0, 0.0),
                BodySpec::new(ShapeSpec::Circle(0.5), [5.0, 5.0]).mass(1.0).surface(1.0, 0.0),
            ];
            if with_ball {
                bodies.push(BodySpec::new(ShapeSpec::Circle(0.1), [0.0, 1.0]).mass(1.0).surface(1.0, 0.0));
            }
            let mut scene = scene_of(bodies, Forces::gravity());
            let kind = JointKind::Revolute(Revolute { anchor: [5.0, 5.0], motor, limits: None });
            scene.joints = vec![JointSpec::new(0, 1, kind)];
            let world = advanced(&scene, 300);
            world.states()[1]
        };
        let (alone, beside) = (wheel(false), wheel(true));
        assert_eq!(alone, beside, "{speed} rad/s, {max_torque} N·m");
    }
}

/// A chain that hangs still stays so where its step changes from one to the next: what joints carry belongs to a length.
#[test]
fn chains_hang_still_under_changing_steps() {
    for (links, load, others) in [(4, 2.0, 80.0), (4, 2.0, 120.0), (10, 1.0, 90.0)] {
        let bodies = (0..=links).map(|k| {
            let bead = disc([0.0, -0.5 * f64::from(k)]);
            if k == 0 { bead.fixed() } else { bead.mass(if k == links { load } else { 1.0 }) }
        });
        let mut scene = scene_of(bodies.collect(), Forces::gravity());
        scene.joints = (0..links as usize).map(|k| rod(k, k + 1)).collect();
        let mut world = start(&scene, Settings::default());
        let mut most = 0.0f64;
        for step in 0..600 {
            world.step(if step % 3 == 0 { 1.0 / 60.0 } else { 1.0 / others }).expect("stays finite");
            let [x, y] = world.states().last().expect("a load").position;
            most = most.max((y + 0.5 * f64::from(links)).abs() + x.abs());
        }
        println!("{links} rods, {load} kg, every third step {others}/60 as long: off by {most:.1e} m");
        assert!(most < 1e-3 * f64::from(links), "{links} rods, {load} kg, {others}: off by {most} m");
    }
}
