//! Joints hold in every engine what they hold in ours, and what an engine has not is refused by name.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod common;

use common::{PEERS, after, angle, close, named, scene_of};
use lamina_peers::engine::{self, Gap, Name, Setup};
use lamina2d::force::Forces;
use lamina2d::joint::{Distance, JointKind, JointSpec, JointSpring, Limits, Motor, Revolute, Weld};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};

/// A static disc at the origin and a disc of 1 kg, joined.
fn hung(position: [f64; 2], kind: JointKind) -> Scene {
    let disc = |at| BodySpec::new(ShapeSpec::Circle(0.1), at).mass(1.0);
    scene_of(vec![disc([0.0; 2]).fixed(), disc(position)], vec![JointSpec::new(0, 1, kind)])
}

#[test]
fn a_pendulum_keeps_its_rod() {
    for engine in Name::ALL {
        for steps in [37, 150, 300] {
            let bob = after(&named("pendulum"), engine, steps)[1].position;
            close(&format!("{engine} after {steps}"), bob[0].hypot(bob[1]), 1.0, 0.01);
        }
    }
}

#[test]
fn a_chain_holds_together() {
    let scene = named("chain/6");
    for engine in Name::ALL {
        let states = after(&scene, engine, 120);
        for pair in states[1..].windows(2) {
            // The right end of a link and the left end of the next: half a pitch along.
            let end = |k: usize, side: f64| {
                let ([x, y], [c, s]) = (pair[k].position, pair[k].rotation);
                [x + side * 0.25 * c, y + side * 0.25 * s]
            };
            let ([ax, ay], [bx, by]) = (end(0, 1.0), end(1, -1.0));
            assert!((bx - ax).hypot(by - ay) < 0.02, "{engine}: the chain came apart");
        }
    }
}

#[test]
fn a_rope_is_taut_and_a_spring_sags_by_its_hertz() {
    let rope = JointKind::Distance(Distance { max: Some(1.0), ..Distance::default() });
    let soft = JointSpring { hertz: 2.0, damping: 1.0 };
    let spring =
        JointKind::Distance(Distance { length: Some(1.0), spring: Some(soft), ..Distance::default() });
    for engine in Name::ALL {
        let bob = after(&hung([0.0, -0.5], rope.clone()), engine, 300)[1].position;
        close(&format!("{engine}: rope"), bob[1], -1.0, 0.01);
        let bob = after(&hung([0.0, -1.0], spring.clone()), engine, 300)[1].position;
        let sag = 9.81 / (4.0 * std::f64::consts::PI).powi(2);
        close(&format!("{engine}: spring"), bob[1], -1.0 - sag, 0.05 * sag);
    }
}

fn hinged(revolute: Revolute) -> Scene {
    let post = BodySpec::new(ShapeSpec::Circle(0.05), [0.0; 2]).fixed();
    let bar = BodySpec::new(ShapeSpec::Box([0.5, 0.05]), [0.5, 0.0]).mass(1.0);
    scene_of(vec![post, bar], vec![JointSpec::new(0, 1, JointKind::Revolute(revolute))])
}

#[test]
fn motors_turn_and_limits_stop() {
    let motor = Motor { speed: 2.0, max_torque: 100.0 };
    let turned = hinged(Revolute { anchor: [0.0; 2], motor: Some(motor), limits: None });
    let limits = Limits { lower: -0.5, upper: 0.5 };
    let stopped = hinged(Revolute { anchor: [0.0; 2], motor: None, limits: Some(limits) });
    let weak = Motor { speed: 2.0, max_torque: 0.1 };
    let slipping = hinged(Revolute { anchor: [0.0; 2], motor: Some(weak), limits: None });
    for engine in Name::ALL {
        // rapier solves its joints once per iteration, without what they needed before.
        let by = if engine == Name::Rapier2d { 0.2 } else { 0.02 };
        close(&format!("{engine}: motor"), after(&turned, engine, 90)[1].angular_velocity, 2.0, by);
        close(&format!("{engine}: limit"), angle(&after(&stopped, engine, 300)[1]), -0.5, 0.02);
        assert!(after(&slipping, engine, 20)[1].angular_velocity < 0.0, "{engine}: 0.1 N·m cannot hold it");
    }
}

#[test]
fn a_limit_counts_from_where_the_joint_was_made() {
    let mut scene =
        hinged(Revolute { anchor: [0.0; 2], motor: None, limits: Some(Limits { lower: -0.3, upper: 0.3 }) });
    scene.bodies[0].angle = 1.0;
    scene.bodies[1].angle = -0.4;
    for engine in Name::ALL {
        close(&format!("{engine}"), angle(&after(&scene, engine, 300)[1]), -0.7, 0.02);
    }
}

#[test]
fn a_weld_holds_place_and_angle() {
    let wall = BodySpec::new(ShapeSpec::Box([0.1, 0.5]), [0.0; 2]).turned(0.3).fixed();
    let shelf = BodySpec::new(ShapeSpec::Box([0.3, 0.05]), [0.4, 0.0]).mass(1.0);
    let weld = |spring| JointKind::Weld(Weld { anchor: [0.1, 0.0], spring });
    let scene =
        |spring| scene_of(vec![wall.clone(), shelf.clone()], vec![JointSpec::new(0, 1, weld(spring))]);
    let soft = JointSpring { hertz: 3.0, damping: 1.0 };
    let ours = angle(&after(&scene(Some(soft)), Name::Lamina2d, 300)[1]);
    assert!(ours < -0.01);
    for engine in Name::ALL {
        let state = after(&scene(None), engine, 300)[1];
        close(&format!("{engine}: angle"), angle(&state), 0.0, 0.01);
        close(&format!("{engine}: place"), state.position[1], 0.0, 0.01);
        // rapier's way of solving joints reaches it with its iterations: 0.082 rad with four.
        let rounds = if engine == Name::Rapier2d { 32 } else { 4 };
        let mut world = engine::build(&scene(Some(soft)), Setup::new(engine).substeps(rounds)).unwrap();
        world.run(300).unwrap();
        let sprung = angle(&world.states()[1]);
        close(&format!("{engine}: spring"), sprung, ours, 0.1 * ours.abs());
    }
}

fn gap(scene: &Scene, engine: Name) -> String {
    let refused = engine::build(scene, Setup::new(engine)).map(|_| ()).unwrap_err();
    assert!(refused.is::<Gap>(), "{refused}");
    refused.to_string()
}

#[test]
fn what_a_peer_has_not_is_refused_by_name() {
    let windy = Forces { linear_drag: Some(0.1), wind: Some([1.0, 0.0]), ..Forces::gravity() };
    let scene = Scene { forces: windy, ..named("stack/1") };
    for engine in PEERS {
        assert_eq!(gap(&scene, engine), format!("{engine} cannot run stack/1: it has no field wind"));
    }
    let strut = JointKind::Distance(Distance { min: Some(0.5), ..Distance::default() });
    assert!(gap(&hung([1.0, 0.0], strut), Name::Rapier2d).contains("joint 0 has a least distance of 0.5 m"));
    let winding = Limits { lower: -1.0, upper: 7.0 };
    let wound = hinged(Revolute { anchor: [0.0; 2], motor: None, limits: Some(winding) });
    for engine in PEERS {
        assert!(gap(&wound, engine).contains("joint 0 has a limit of 7 rad"));
    }
    assert!(
        engine::build(&named("stack/1"), Setup::new(Name::Lamina2d).threads(2)).is_err(),
        "ours has one thread"
    );
}
