//! What must not change a bit of smooth motion: skips, lanes, mass units, contacts elsewhere.
//!
//! Each is held against the same world without it, by the hash of all poses and velocities.

use lamina2d::force::{Central, Forces, Spring};
use lamina2d::scene::{BodySpec, Scene, ShapeSpec};
use lamina2d::settings::{Integrator, Precision, Settings, Skip, Skips};
use lamina2d::simulation::simulate;

use crate::shared_motion::{
    at_every_width, at_widths, disc, every_field, fields, ghosts, run, scene_of, start,
};

const STEPS: usize = 40;

/// Settings of every integrator, at substeps 1 and 3.
fn every_integrator() -> impl Iterator<Item = Settings> {
    Integrator::ALL.iter().flat_map(|&integrator| {
        [1, 3].map(|substeps| Settings { integrator, substeps, ..Settings::default() })
    })
}

/// Gravity alone, forces and torques per body alone, and both.
fn constant_forces() -> Vec<(&'static str, Scene)> {
    let pushed = || {
        let mut bodies = ghosts(75);
        for (k, body) in bodies.iter_mut().enumerate().filter(|(k, _)| k % 4 != 0) {
            body.force = [k as f64 * 0.3 - 5.0, 7.0 - k as f64 * 0.1];
            body.torque = 0.05 * k as f64 - 1.0;
        }
        bodies
    };
    let gravity = Forces { gravity: Some([0.3, -9.81]), ..Forces::default() };
    vec![
        ("gravity", scene_of(ghosts(75), gravity)),
        ("force and torque per body", scene_of(pushed(), Forces::default())),
        ("both", scene_of(pushed(), gravity)),
    ]
}

#[test]
fn closed_form_gives_the_bits_of_every_integrator_under_constant_force() {
    for (name, scene) in constant_forces() {
        for settings in every_integrator() {
            for with in at_every_width(settings) {
                let without = Settings { skips: with.skips.without(Skip::ClosedForm), ..with };
                let (a, b) = (run(&scene, with, STEPS), run(&scene, without, STEPS));
                assert_eq!(a.hash(), b.hash(), "{name}: {with:?}");
                // That the skip was taken, not only asked for.
                let staged =
                    !matches!(with.integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler);
                let spared = if staged { 75 } else { 0 };
                assert_eq!(a.counts().skipped[Skip::ClosedForm as usize], spared, "{name}: {with:?}");
                assert_eq!(b.counts().skipped[Skip::ClosedForm as usize], 0, "{name}: {with:?}");
            }
        }
    }
}

/// The skip must not be taken where acceleration depends on the state.
#[test]
fn closed_form_is_not_taken_in_other_fields() {
    for (name, forces) in fields() {
        let scene = scene_of(ghosts(5), forces);
        let settings = Settings { integrator: Integrator::Rk4, ..Settings::default() };
        let taken = run(&scene, settings, 1).counts().skipped[Skip::ClosedForm as usize] > 0;
        assert_eq!(taken, matches!(name, "no field" | "gravity"), "{name}");
    }
}

#[test]
fn free_flight_and_rotation_skips_give_the_bits_of_the_whole_step() {
    for (name, forces) in fields() {
        // Half of the blocks spin, half do not: the rotation skip goes block by block.
        let mut bodies = ghosts(150);
        bodies[75..].iter_mut().for_each(|body| body.angular_velocity = 0.0);
        let scene = scene_of(bodies, forces);
        for settings in every_integrator() {
            for all in at_every_width(settings) {
                let expected = run(&scene, Settings { skips: Skips::NONE, ..all }, 10);
                for skips in [
                    Skips::ALL,
                    Skips::ALL.without(Skip::FreeFlight),
                    Skips::ALL.without(Skip::Rotation),
                    Skips::NONE.with(Skip::FreeFlight),
                ] {
                    let got = run(&scene, Settings { skips, ..all }, 10);
                    assert_eq!(got.hash(), expected.hash(), "{name}: {skips} {all:?}");
                    let flew = got.counts().skipped[Skip::FreeFlight as usize] > 0;
                    assert_eq!(flew, skips.has(Skip::FreeFlight), "{name}: {skips}");
                }
            }
        }
    }
}

/// Bodies that attract each other move at once whatever the width, flying or by whole steps; one more is refused.
#[test]
fn attraction_gives_the_same_bits_at_every_width_and_with_every_skip() {
    let forces = Forces { attraction: Some(3.0), ..every_field() };
    let scene = scene_of(ghosts(15), forces);
    for settings in every_integrator() {
        for precision in [Precision::F32, Precision::F64] {
            let narrow = Settings { precision, lanes: 1, ..settings };
            let expected = run(&scene, Settings { skips: Skips::NONE, ..narrow }, 10);
            let apart = run(&scene_of(ghosts(15), every_field()), narrow, 10);
            assert_ne!(expected.hash(), apart.hash(), "attraction does something");
            for &lanes in Settings::widths(precision) {
                for skips in [Skips::ALL, Skips::NONE] {
                    let got = run(&scene, Settings { skips, lanes, ..narrow }, 10);
                    assert_eq!(got.hash(), expected.hash(), "{skips} {lanes} lanes: {settings:?}");
                }
            }
        }
    }
    let refusal = |bodies: usize, settings| {
        simulate(&scene_of(ghosts(bodies), forces), settings).err().map(|e| e.to_string()).unwrap_or_default()
    };
    let at_most = "body 15: force attraction: at most 15 bodies attract each other";
    assert_eq!(refusal(16, Settings::default()), at_most);
    let asleep = "force attraction: all bodies must move at once; run it without sleep";
    assert_eq!(refusal(2, Settings { sleep: true, ..Settings::default() }), asleep);
    let paced = Settings { max_sag: Some(1e-3), ..Settings::default() };
    assert_eq!(refusal(2, paced), asleep.replace("sleep", "max-sag"));
}

/// A swarm that drifts at 20 m/s while its bodies slowly run into each other: the list of pairs is kept nearly all the
/// way, and every contact is found when it would be without.
#[test]
fn a_drifting_swarm_keeps_its_pairs_and_every_bit() {
    let scatter = crate::shared_motion::scatter;
    let swarm = |extra: Option<BodySpec>| {
        let bodies = (0..400).map(|k| {
            let position = [(k % 20) as f64 * 0.202, (k / 20) as f64 * 0.202];
            let velocity = [20.0 + 0.03 * scatter(k, 1), 20.0 + 0.03 * scatter(k, 2)];
            disc(position).moving(velocity, 0.0)
        });
        scene_of(bodies.chain(extra).collect(), Forces::gravity())
    };
    // With a floor, even far below, nothing is seen relative to anything.
    let floor = BodySpec::new(ShapeSpec::Box([50.0, 0.5]), [0.0, -90.0]).fixed();
    for (scene, keeps) in [(swarm(None), true), (swarm(Some(floor)), false)] {
        for settings in at_every_width(Settings { skips: Skips::EXACT, ..Settings::default() }) {
            let without = Settings { skips: settings.skips.without(Skip::PairList), ..settings };
            let (mut kept, mut found) = (start(&scene, settings), start(&scene, without));
            let (mut served, mut contacts) = (0, 0);
            for _ in 0..40 {
                kept.step(crate::shared_motion::DT_SECS).unwrap();
                found.step(crate::shared_motion::DT_SECS).unwrap();
                assert_eq!(kept.hash(), found.hash(), "{settings:?}");
                served += usize::from(kept.counts().skipped[Skip::PairList as usize] > 0);
                contacts += kept.counts().contacts;
            }
            assert!(contacts > 40, "{contacts} contacts");
            assert_eq!(served > 20, keeps, "served {served} times of 40 in {settings:?}");
        }
    }
}

/// 150 bodies in slots 1 to 150, of which only the first spins: the block of the first is not spared,
/// and no body that does not exist is counted as spared.
#[test]
fn rotation_skip_counts_bodies_and_not_padding() {
    let mut bodies = ghosts(150);
    bodies[1..].iter_mut().for_each(|body| body.angular_velocity = 0.0);
    let scene = scene_of(bodies, Forces::gravity());
    for settings in at_every_width(Settings::default()) {
        let spared = run(&scene, settings, 1).counts().skipped[Skip::Rotation as usize];
        // The first block holds the world and the first bodies.
        let block = lamina2d::internals::BLOCK * settings.lanes;
        assert_eq!(spared as usize, 150 - (block - 1), "{settings:?}");
    }
}

#[test]
fn friction_and_restitution_skips_give_the_bits_of_the_whole_solver() {
    for (restitution, friction) in [(0.0, 0.0), (0.5, 0.0), (0.0, 0.5)] {
        let mut scene = lamina2d::scene::by_name("all/40", None, 3).expect("a named scene");
        for body in &mut scene.bodies {
            (body.restitution, body.friction) = (restitution, friction);
        }
        for all in at_every_width(Settings { skips: Skips::EXACT, ..Settings::default() }) {
            let (a, b) = (run(&scene, all, 150), run(&scene, Settings { skips: Skips::NONE, ..all }, 150));
            assert!(a.counts().contacts > 0, "the scene tests contacts");
            assert_eq!(a.hash(), b.hash(), "e {restitution} μ {friction}: {all:?}");
        }
    }
}

/// Free bodies, every shape and field; 130 of them, so that every width has whole and broken blocks.
#[test]
fn lanes_do_not_change_a_bit_with_every_field_at_once() {
    let mut bodies = ghosts(130);
    for (k, body) in bodies.iter_mut().enumerate().filter(|(k, _)| k % 5 == 0) {
        (body.force, body.torque) = ([k as f64 * 0.1 - 3.0, 2.0], 0.3 - k as f64 * 0.01);
    }
    for skips in [Skips::ALL, Skips::NONE] {
        for settings in every_integrator() {
            for precision in [Precision::F32, Precision::F64] {
                let scene = scene_of(bodies.clone(), every_field());
                let hashes: Vec<u64> = at_widths(Settings { skips, ..settings }, precision)
                    .map(|settings| run(&scene, settings, STEPS).hash())
                    .collect();
                assert!(hashes.iter().all(|&h| h == hashes[0]), "{precision} {settings:?}: {hashes:x?}");
            }
        }
    }
}

/// A stack that rests on a floor 1000 m away, whatever fields of moderate strength act.
fn far_stack() -> Vec<BodySpec> {
    let floor = BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [1000.0, -0.5]).fixed();
    let boxes = (0..5).map(|k| {
        let half = ShapeSpec::Box([0.5, 0.5]);
        BodySpec::new(half, [1000.0, 0.5 + f64::from(k)]).mass(50.0).surface(0.0, 0.5)
    });
    std::iter::once(floor).chain(boxes).collect()
}

/// Beside contacts a body advances by the scheme's displacement plus h·0: as if there were no solver.
///
/// The wanderers stand before the stack in one world, behind it in the other: neither their slots nor
/// their neighbours in a block matter. Everything has mass, spin, and forces of its own.
#[test]
fn bodies_that_touch_nothing_do_not_feel_contacts_elsewhere() {
    let weak = Forces {
        gravity: Some([0.0, -9.81]),
        spring: Some(Spring { anchor: [3.0, 1.0], stiffness: 0.02 }),
        // It grows with the square of the distance, and the stack stands at 1000 m.
        henon_heiles: None,
        ..every_field()
    };
    let mut wanderers = ghosts(20);
    (wanderers[3].force, wanderers[3].torque) = ([1.0, 2.0], 0.5);
    for forces in [Forces::gravity(), weak] {
        let alone = scene_of(wanderers.clone(), forces);
        let before = scene_of([wanderers.clone(), far_stack()].concat(), forces);
        let behind = scene_of([far_stack(), wanderers.clone()].concat(), forces);
        for settings in every_integrator() {
            for settings in at_every_width(settings) {
                let mut worlds = [&alone, &before, &behind].map(|scene| start(scene, settings));
                for step in 0..STEPS {
                    for world in &mut worlds {
                        world.step(crate::shared_motion::DT_SECS).expect("stays finite");
                    }
                    let touching = worlds.each_ref().map(|world| world.counts().contacts > 0);
                    // The stack touches from the second step on: at first it only touches exactly.
                    assert_eq!(touching, [false, step > 0 || touching[1], step > 0 || touching[2]]);
                    let [alone, before, behind] = worlds.each_ref().map(|world| world.states());
                    assert_eq!(before[..20], alone, "step {step}: {settings:?}");
                    assert_eq!(behind[6..], alone, "step {step}: {settings:?}");
                }
            }
        }
    }
}

/// Gravity and attraction give all masses the same acceleration; other forces scale with the mass.
#[test]
fn mass_units_do_not_change_a_bit_in_free_flight() {
    let scaled = |scale: f64| {
        let all = every_field();
        let forces = Forces {
            linear_drag: all.linear_drag.map(|k| k * scale),
            quadratic_drag: all.quadratic_drag.map(|k| k * scale),
            spring: all.spring.map(|s| Spring { stiffness: s.stiffness * scale, ..s }),
            magnetic: all.magnetic.map(|k| k * scale),
            ..all
        };
        let mut bodies = ghosts(40);
        for (k, body) in bodies.iter_mut().enumerate() {
            body.mass = body.mass.map(|m| m * scale);
            (body.force, body.torque) = ([scale * k as f64, -2.0 * scale], scale * 0.1);
        }
        scene_of(bodies, forces)
    };
    for settings in every_integrator() {
        for settings in at_every_width(settings) {
            let expected = run(&scaled(1.0), settings, STEPS).hash();
            for exponent in [-20, -1, 1, 10] {
                let hash = run(&scaled(2f64.powi(exponent)), settings, STEPS).hash();
                assert_eq!(hash, expected, "2^{exponent}: {settings:?}");
            }
        }
    }
}

/// Under gravity and attraction alone, nothing but the mass may change.
#[test]
fn mass_does_not_matter_to_gravity() {
    let forces =
        Forces { central: Some(Central { center: [0.0, 30.0], strength: 50.0 }), ..Forces::gravity() };
    let of_mass = |mass: f64| scene_of(vec![disc([1.0, 2.0]).moving([3.0, 4.0], 5.0).mass(mass)], forces);
    for settings in every_integrator() {
        let expected = run(&of_mass(1.0), settings, STEPS).hash();
        for mass in [1e-9, 0.3, 7.0, 1e9] {
            assert_eq!(run(&of_mass(mass), settings, STEPS).hash(), expected, "{mass}: {settings:?}");
        }
    }
}

/// Every name of a set of skips reads back as that set.
#[test]
fn skips_read_back_what_they_print() {
    for bits in 0..1u32 << Skip::ALL.len() {
        let some = Skip::ALL.iter().filter(|&&skip| bits >> skip as u32 & 1 == 1);
        let set = some.fold(Skips::NONE, |set, &skip| set.with(skip));
        assert_eq!(set.to_string().parse(), Ok(set), "'{set}'");
    }
}
