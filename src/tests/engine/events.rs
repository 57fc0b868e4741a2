//! What a scene does to itself: when, in which order, with which outcome, at every width; and what is refused beforehand.

#![expect(clippy::unwrap_used, reason = "what parses scenes is part of the test")]

use lamina2d::scene::file::parse;
use lamina2d::settings::{Precision, Settings};
use lamina2d::simulation::{BodyState, Simulation, simulate};

/// A floor, a box of 1 m that lies on it, and a disc far away in the air, held by an arm from a static post.
const SCENE: &str = r"
[settings]
sleep = true
[forces]
gravity = [0, -10]
[[body]]
kind = 'static'
shape = { box = [10, 0.5] }
position = [0, -0.5]
[[body]]
shape = { box = [0.5, 0.5] }
position = [0, 0.5]
mass = 2
friction = 0
[[body]]
kind = 'static'
shape = { circle = 0.1 }
position = [100, 0]
[[body]]
shape = { circle = 0.5 }
position = [101, 0]
mass = 1
[[joint]]
bodies = [2, 3]
kind = { revolute = { anchor = [100, 0] } }
";

fn read(events: &str) -> Result<(lamina2d::scene::Scene, Settings), String> {
    parse("events.toml", &format!("{SCENE}{events}")).map_err(|why| why.to_string())
}

/// The world after so many steps in `f64`, the same at every width and in `f32` to 1e-3.
fn after(events: &str, steps: u32) -> Box<dyn Simulation> {
    let (scene, settings) = read(events).unwrap();
    let run = |precision: Precision, lanes: usize| {
        let settings = Settings { lanes, ..settings.with_precision(precision) };
        let mut world = simulate(&scene, settings).unwrap();
        for _ in 0..steps {
            world.advance().unwrap();
        }
        world
    };
    let exact = run(Precision::F64, 4);
    assert_eq!(exact.hash(), run(Precision::F64, 1).hash());
    let single = run(Precision::F32, 8);
    for lanes in [1, 4, 16] {
        assert_eq!(single.hash(), run(Precision::F32, lanes).hash(), "{lanes} lanes");
    }
    for (a, b) in single.states().iter().zip(exact.states()) {
        for k in [0, 1] {
            assert!((a.position[k] - b.position[k]).abs() <= 1e-3 * b.position[k].abs().max(1.0));
        }
    }
    exact
}

/// The state of the body of this number in the scene, where none has gone.
fn body(world: &dyn Simulation, number: usize) -> BodyState {
    world.body(number + 1).unwrap().state
}

#[track_caller]
fn near(found: f64, right: f64, tolerance: f64) {
    assert!((found - right).abs() <= tolerance, "{found}, right is {right}");
}

/// Steps are of 1/60 s: a fall of a second is within half a step's way of the parabola.
#[test]
fn each_does_what_it_says() {
    // The floor goes after two seconds, when the box has long been asleep; a second later it has fallen 5 m.
    let world = after("[[event]]\ntime = 2.0\nremove = { body = 0 }", 180);
    near(body(world.as_ref(), 1).position[1], 0.5 - 5.0, 0.05);
    // Pushed along the floor by 4 N for one second: 2 m/s, then at that speed.
    let push = "[[event]]\nstep = 120\nforce = { body = 1, force = [4, 0] }\n
        [[event]]\nstep = 180\nforce = { body = 1 }";
    let world = after(push, 240);
    near(body(world.as_ref(), 1).velocity[0], 2.0, 1e-3);
    near(body(world.as_ref(), 1).position[0], 1.0 + 2.0, 0.03);
    // Struck: 6 N·s on 2 kg.
    let world = after("[[event]]\nstep = 120\nimpulse = { body = 1, linear = [6, 0] }", 180);
    near(body(world.as_ref(), 1).position[0], 3.0, 1e-3);
    // Set going.
    let world = after("[[event]]\nstep = 120\nset_velocity = { body = 1, velocity = [-1.5, 0] }", 180);
    near(body(world.as_ref(), 1).position[0], -1.5, 1e-3);
    // Put 5 m up and turned by a right angle: it falls for a second less than it takes to land.
    let world =
        after("[[event]]\nstep = 120\nteleport = { body = 1, position = [3, 8.5], angle = 1.5707963 }", 180);
    near(body(world.as_ref(), 1).position[1], 3.5, 0.05);
    near(body(world.as_ref(), 1).position[0], 3.0, 1e-9);
    near(body(world.as_ref(), 1).rotation[1], 1.0, 1e-6);
    // Weightless at a time: what lies stays; what swings goes on in a circle at its speed.
    let world = after(
        "[[event]]\ntime = 0\nfield = {}\n[[event]]\ntime = 0\nvelocity = { body = 3, velocity = [0, 1] , angular_velocity = 1 }",
        60,
    );
    near(body(world.as_ref(), 3).position[0], 100.0 + 1f64.cos(), 1e-3);
    near(body(world.as_ref(), 3).position[1], 1f64.sin(), 1e-3);
    // A motor of 2 rad/s holds the arm against its weight of 10 N·m.
    let world = after("[[event]]\nstep = 60\nmotor = { joint = 0, speed = 2, max_torque = 1e4 }", 240);
    near(body(world.as_ref(), 3).angular_velocity, 2.0, 1e-2);
    // What becomes static hangs in the air.
    let world = after("[[event]]\nstep = 0\nkind = { body = 3, kind = 'static' }", 120);
    near(body(world.as_ref(), 3).position[0], 101.0, 0.0);
    // What comes falls onto what is there; another method takes over on its way.
    let comes = "[[event]]\nstep = 10\ninsert = { shape = { circle = 0.25 }, position = [0, 3], mass = 1 }\n
        [[event]]\nstep = 20\nchoose = { integrator = 'rk4', solver = 'pgs', substeps = 8 }";
    let world = after(comes, 240);
    assert_eq!(world.bodies(), 5);
    near(body(world.as_ref(), 4).position[1], 1.25, 0.02);
}

/// Those that are due at once go in the order of the file; a time is met by whatever step begins then.
#[test]
fn order_and_times() {
    let both = "[[event]]\nstep = 30\nvelocity = { body = 1, velocity = [1, 0] }\n
        [[event]]\ntime = 0.5\nvelocity = { body = 1, velocity = [2, 0] }";
    near(body(after(both, 31).as_ref(), 1).velocity[0], 2.0, 1e-12);
    near(body(after(both, 30).as_ref(), 1).velocity[0], 0.0, 1e-12);
    // Half as long steps: the time stays, the step comes sooner.
    let (scene, settings) = read(both).unwrap();
    let mut world = simulate(&scene, settings).unwrap();
    for _ in 0..31 {
        world.step(1.0 / 120.0).unwrap();
    }
    near(body(world.as_ref(), 1).velocity[0], 1.0, 1e-12);
    for _ in 31..61 {
        world.step(1.0 / 120.0).unwrap();
    }
    near(body(world.as_ref(), 1).velocity[0], 2.0, 1e-12);
}

/// What is due before the same step is done by its time, however the file has it: here what comes is there to be pushed.
#[test]
fn what_is_due_at_once_goes_by_its_time() {
    let events = "[[event]]\ntime = 0.012\nvelocity = { body = 4, velocity = [3, 0] }\n
        [[event]]\ntime = 0.005\ninsert = { shape = { circle = 0.2 }, position = [50, 50] }";
    let (scene, settings) = read(events).unwrap();
    let mut world = simulate(&scene, settings).unwrap();
    for _ in 0..3 {
        world.advance().unwrap();
    }
    near(body(world.as_ref(), 4).velocity[0], 3.0, 1e-6);
}

/// Bodies come to attract each other where a stack has more substeps than others: all move on, at one number.
#[test]
fn attraction_may_come_on_the_way() {
    let stack = (1..12).map(|k| {
        format!(
            "[[body]]\nshape = {{ box = [0.01, 0.01] }}\nposition = [5, {}]\n",
            0.01 + 0.02 * f64::from(k - 1)
        )
    });
    let text = "[forces]\ngravity = [0, -50]\n[[body]]\nkind = 'static'\nshape = { box = [10, 0.5] }
        position = [0, -0.5]\n[[body]]\nshape = { circle = 0.5 }\nposition = [0, 9]\n
        [[event]]\nstep = 40\nfield = { attraction = 1e-3, gravity = [0, -50] }\n
        [[event]]\nstep = 50\ninsert = { shape = { circle = 0.1 }, position = [5, 0.4] }\n";
    let (scene, settings) = parse("attracted.toml", &(text.to_owned() + &stack.collect::<String>())).unwrap();
    let mut world = simulate(&scene, settings).unwrap();
    for step in 0..120 {
        world.advance().unwrap();
        assert!(step != 39 || world.counts().substeps[1] > 4, "{:?}", world.counts().substeps);
    }
    assert_eq!(world.counts().substeps, [4; 2]);
    assert!(world.body(14).unwrap().state.position[1] < 0.4);
}

/// Numbers go on counting, though the slot of a body that has gone is filled again.
#[test]
fn numbers_are_not_used_twice() {
    let events = "
        [[event]]\nstep = 5\nremove = { body = 1 }
        [[event]]\nstep = 10\ninsert = { shape = { circle = 0.2 }, position = [5, 0.2] }
        [[event]]\nstep = 20\nvelocity = { body = 4, velocity = [3, 0] }";
    let world = after(events, 30);
    // In the slot of body 1.
    near(body(world.as_ref(), 1).velocity[0], 3.0, 1.0);
    assert_eq!(world.bodies(), 4);
    let gone = "[[event]]\nstep = 5\nremove = { body = 1 }\n[[event]]\nstep = 6\nremove = { body = 1 }";
    assert_eq!(refused(gone), "event 1: remove, body 1: it is gone by then");
}

/// What goes on from a state still has the rest to do, by steps and times of its own.
#[test]
fn a_world_with_other_settings_does_the_rest() {
    let (scene, settings) = read("[[event]]\nstep = 60\nimpulse = { body = 1, linear = [6, 0] }").unwrap();
    let mut world = simulate(&scene, settings).unwrap();
    for _ in 0..50 {
        world.advance().unwrap();
    }
    let mut other = world.with_settings(Settings { lanes: 4, ..settings }).unwrap();
    for _ in 50..90 {
        world.advance().unwrap();
        other.advance().unwrap();
    }
    near(body(other.as_ref(), 1).position[0], 1.5, 1e-3);
    near(body(other.as_ref(), 1).position[0], body(world.as_ref(), 1).position[0], 1e-4);
}

fn refused(events: &str) -> String {
    match read(events) {
        Err(why) => why,
        Ok((scene, settings)) => simulate(&scene, settings).map(|_| ()).unwrap_err().to_string(),
    }
}

#[test]
fn what_cannot_be_done_is_refused_before_the_first_step() {
    for (event, why) in [
        ("remove = { body = 1 }", "event 0: give the step or the time it happens at"),
        ("step = 1\ntime = 1\nremove = { body = 1 }", "event 0: give its step or its time, not both"),
        ("step = -1\nremove = { body = 1 }", "event 0: step must be a whole number from 0 up, got -1"),
        ("time = -0.5\nremove = { body = 1 }", "event 0: time must be finite and at least 0, got -0.5"),
        ("time = nan\nremove = { body = 1 }", "event 0: time must be finite and at least 0, got NaN"),
        ("step = 1", "event 0: give what is done: insert, remove, teleport, velocity, …"),
        (
            "step = 1\nremove = { body = 1 }\nforce = { body = 1 }",
            "event 0: one thing is done by an event, got force and remove; give each its own",
        ),
        ("step = 1\nremove = { body = 7 }", "event 0: remove, body 7: there is none"),
        (
            "step = 1\nremove = { slot = 2 }",
            "event 0: remove: a body is named by `body`, its number in the scene from 0",
        ),
        (
            "step = 1\nremove = { body = -1 }",
            "event 0: remove: body must be a whole number from 0 up, got -1",
        ),
        (
            "step = 1\nvelocity = { body = 0, velocity = [1, 0] }",
            "event 0: velocity, body 0: body in slot 1 is static: it takes no velocity; make it kinematic",
        ),
        (
            "step = 1\nvelocity = { body = 1, velocity = [inf, 0] }",
            "event 0: velocity, body 1: body 1: velocity is not finite in this precision: inf",
        ),
        (
            "step = 1\ninsert = { shape = { circle = 0 }, position = [0, 0] }",
            "event 0: insert: body 4: shape: radius must be positive and finite, got 0.0",
        ),
        (
            "step = 1\nmotor = { joint = 0, speed = 1, max_torque = -1 }",
            "event 0: motor: joint 0: motor max_torque must be at least 0, got -1.0",
        ),
        ("step = 1\nmotor = { joint = 3, speed = 1, max_torque = 1 }", "event 0: motor: there is no joint 3"),
        (
            "step = 1\nfield = { linear_drag = -2 }",
            "event 0: fields: force linear_drag: coefficient must not be negative, got -2.0",
        ),
        (
            "step = 1\nimpulse = { body = 0, linear = [1, 0] }",
            "event 0: impulse, body 0: body in slot 1 is not dynamic: an impulse cannot move it",
        ),
    ] {
        assert_eq!(refused(&format!("[[event]]\n{event}")), why, "{event}");
    }
    let unknown = refused("[[event]]\nstep = 1\nexplode = { body = 1 }");
    assert!(
        unknown.contains("event 0: explode: name the body") || unknown.contains("unknown variant"),
        "{unknown}"
    );
    let field = refused("[[event]]\nstep = 1\nremove = { body = 1, speed = 2 }");
    assert!(field.starts_with("event 0: remove: unknown field `speed`"), "{field}");
}
