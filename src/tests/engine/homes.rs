//! Contacts in their lanes: each in one, and in no other, whoever comes, goes, sleeps or is taken out.

use std::collections::BTreeSet;

use lamina2d::force::{Forces, Spring};
use lamina2d::lanes::{Lanes, f32s, f64s};
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Settings, Skip, Skips, Solver};
use lamina2d::world::World;

use crate::shared_motion::{at_every_width, disc, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;

/// Every pair that touches has one lane, every lane in use a pair that touches, and no colour a dynamic body twice.
fn check<L: Lanes>(world: &World<L>, when: &str) {
    let manifolds = world.manifolds();
    let touching: BTreeSet<u32> = manifolds.touching().iter().copied().collect();
    let mut seen = BTreeSet::new();
    for (overflow, places) in world.solving().stream().places() {
        let mut held = BTreeSet::new();
        for place in places.filter(|&place| place != manifolds.padding()) {
            assert!(seen.insert(place), "{when}: the pair at {place} has two lanes");
            assert!(manifolds.homes()[place as usize].is_some(), "{when}: the pair at {place} knows no lane");
            for slot in manifolds.slots(place as usize) {
                let moves = world.bodies().kind(slot as usize) == BodyKind::Dynamic;
                assert!(held.insert(slot) || !moves || overflow, "{when}: body {slot} twice in a colour");
            }
        }
    }
    assert_eq!(seen, touching, "{when}");
}

fn world_of<L: Lanes>(name: &str, settings: Settings) -> World<L> {
    World::from_scene(&by_name(name, None, 1).expect("a named scene"), settings).expect("a good scene")
}

fn settings() -> Settings {
    Settings { sleep: true, ..Settings::default() }
}

/// Bodies are taken out and put in while a pile falls, settles and sleeps, under every solver.
#[test]
fn a_contact_has_one_lane_whoever_comes_and_goes() {
    let mut touched = 0;
    for &solver in Solver::ALL {
        for (name, skips) in
            [("all/60", Skips::ALL), ("polygons/60", Skips::ALL.without(Skip::ManifoldReuse))]
        {
            let mut world = world_of::<f32s::X8>(name, Settings { solver, skips, ..settings() });
            for step in 0..400_u32 {
                world.step(DT_SECS).expect("stays finite");
                check(&world, &format!("{name} {solver} step {step}"));
                touched = touched.max(world.manifolds().len());
                if step % 40 == 20 {
                    let slot = world.bodies().len() - 1 - step as usize / 40 * 3;
                    let id = world.bodies().id(slot).expect("it lives");
                    world.remove(id).expect("it lives");
                    let high = 4.0 + f64::from(step % 3);
                    world
                        .insert(&BodySpec::new(ShapeSpec::Box([0.3, 0.2]), [0.1, high]))
                        .expect("a good body");
                }
            }
        }
    }
    assert!(touched > 60, "{touched} contacts");
}

/// Ninety discs pressed onto one: more contacts than there are colours.
fn crowd() -> Scene {
    let hub = BodySpec::new(ShapeSpec::Circle(10.0), [0.0, 0.0]).mass(300.0);
    let around = (0..90).map(|k| {
        let (sin, cos) = (f64::from(k) * std::f64::consts::TAU / 90.0).sin_cos();
        BodySpec::new(ShapeSpec::Circle(0.35), [10.36 * cos, 10.36 * sin]).mass(1.0)
    });
    let spring = Spring { anchor: [0.0, 0.0], stiffness: 30.0 };
    let forces = Forces { spring: Some(spring), linear_drag: Some(1.0), ..Forces::default() };
    scene_of(std::iter::once(hub).chain(around).collect(), forces)
}

/// Contacts beyond the last colour carry like the others, also while they come and go.
#[test]
fn a_body_with_more_contacts_than_colours_is_carried_by_all_of_them() {
    let scene = crowd();
    let mut ends = Vec::new();
    for settings in at_every_width(Settings { fixed_substeps: true, ..Settings::default() }) {
        let mut world = start(&scene, settings);
        for step in 0..240 {
            world.step(DT_SECS).expect("stays finite");
            if step % 60 == 30 {
                // Two that face each other, so that the hub stays where it is; and one that touches nothing comes.
                for slot in [2, 47].map(|first| first + step / 60) {
                    let id = world.body(slot).expect("it lives").id;
                    world.remove(id).expect("it lives");
                }
                world.insert(&disc([0.0, 40.0]).fixed()).expect("a good body");
            }
        }
        let contacts = world.contacts();
        let on_hub: Vec<_> = contacts.iter().filter(|contact| contact.a == 1).collect();
        assert!(on_hub.len() > 80, "{} contacts", on_hub.len());
        // Each disc presses with stiffness·distance = 30·10.35 N.
        let (h, pressed) = (DT_SECS / f64::from(settings.substeps), 30.0 * 10.35);
        for contact in on_hub {
            let force = contact.points[0].impulse / h;
            assert!((force / pressed - 1.0).abs() < 0.02, "{force} N instead of {pressed} N: {contact:?}");
        }
        ends.push((settings.precision, world.hash()));
    }
    assert!(ends.iter().all(|end| ends.iter().all(|other| end.0 != other.0 || end == other)), "{ends:?}");
}

/// The order in which pairs were listed and contacts came says nothing of what they hold: a world copied while it moves
/// goes on as the original.
#[test]
fn a_copy_goes_on_as_the_original() {
    let mut world = world_of::<f64s::X4>("polygons/150", settings());
    for _ in 0..90 {
        world.step(DT_SECS).expect("stays finite");
    }
    let mut copy = world.clone();
    for step in 0..90 {
        world.step(DT_SECS).expect("stays finite");
        copy.step(DT_SECS).expect("stays finite");
        assert_eq!(world.hash(), copy.hash(), "step {step}");
        check(&copy, &format!("step {step}"));
    }
}
