//! What is done to a scene on its way takes effect, at once and wholly, on what sleeps too.
//!
//! Falls are g·t²/2.

use lamina2d::event::{Action, SceneEvent, When};
use lamina2d::force::Forces;
use lamina2d::joint::{JointKind, JointSpec, Motor, Revolute};
use lamina2d::scene::BodyKind;

use super::case::{Case, Column, G, disc, floor, rectangle};

/// A box rests on a floor, long asleep, until something is done after three seconds; two more are run.
fn resting(name: &str, action: Action) -> Case {
    let bodies =
        vec![floor(50.0).surface(0.0, 0.0), rectangle([0.5; 2], [0.0, 0.5]).mass(2.0).surface(0.0, 0.0)];
    at(Case::new(name.to_owned(), bodies, 5.0).sleepy(), When::Time(3.0), action)
}

fn at(mut case: Case, at: When, action: Action) -> Case {
    case.scene.events.push(SceneEvent { at, action });
    case
}

/// An arm on a hinge with a motor that turns at 1 rad/s.
fn arm() -> Case {
    let bodies = vec![disc(0.02, [0.0, 0.0]).fixed(), rectangle([0.5, 0.05], [0.5, 0.0]).mass(1.0)];
    let motor = Some(Motor { speed: 1.0, max_torque: 1e3 });
    let hinge = JointKind::Revolute(Revolute { anchor: [0.0; 2], motor, limits: None });
    Case::new("motor turns back".to_owned(), bodies, 3.0)
        .weightless()
        .joined(vec![JointSpec::new(0, 1, hinge)])
}

pub(super) fn cases() -> Vec<Case> {
    let fallen = 0.5 * G * 4.0;
    let up = Forces { gravity: Some([0.0, 5.0]), ..Forces::default() };
    let force = |x: f64| Action::Force { slot: 2, force: [x, 0.0], torque: 0.0 };
    let back = Action::Motor { joint: 0, speed: -1.0, max_torque: 1e3 };
    let put = Action::Teleport { slot: 2, position: Some([7.0, 0.5]), angle: None };
    let go = Action::Velocity { slot: 2, velocity: Some([1.5, 0.0]), angular_velocity: None };
    let hit = Action::Impulse { slot: 2, linear: [4.0, 0.0], angular: 0.0 };
    let free = Action::Change { slot: 1, kind: BodyKind::Dynamic, mass: Some(1.0) };
    let comes = Action::Insert(Box::new(rectangle([0.5; 2], [0.0, 1.5]).mass(1.0)));
    vec![
        resting("floor is taken away", Action::Remove { slot: 1 }).end(1, Column::Y, 0.5 - fallen, 0.1),
        resting("floor becomes dynamic", free).end(1, Column::Y, 0.5 - fallen, 0.1),
        resting("gravity turns", Action::Fields(Box::new(up))).end(1, Column::Y, 0.5 + 10.0, 0.1),
        resting("force comes", force(3.0)).end(1, Column::Vx, 3.0, 0.01).end(1, Column::X, 3.0, 0.05),
        resting("impulse", hit).end(1, Column::Vx, 2.0, 1e-3).end(1, Column::X, 4.0, 0.01),
        resting("velocity", go).end(1, Column::X, 3.0, 0.01),
        resting("teleport", put).end(1, Column::X, 7.0, 1e-3).end(1, Column::Y, 0.5, 0.01),
        resting("another comes", comes).end(2, Column::Y, 1.5, 0.01).end(1, Column::Y, 0.5, 0.01),
        at(arm(), When::Time(1.0), back).end(1, Column::Angle, -1.0, 0.02),
    ]
}
