//! What is measured of a world by itself, held against arithmetic: balance of momentum, laws of contact, overlap.

use lamina2d::contact::{Contact, ContactPoint};
use lamina2d::measure::momentum::{Pushed, momentum_balance};
use lamina2d::measure::residual::{Residuals, Side};
use lamina2d::measure::{Outline, Penetration, penetration};

/// A disc of 2 kg and radius 1 m rests on the ground for 0.1 s at 10 m/s², and is pushed by `impulse` N·s and rubbed
/// by `tangent`; what it has after is `after`.
fn rubbed(after: [f64; 3], impulse: f64, tangent: f64) -> f64 {
    let ground = Pushed::default();
    let body = Pushed {
        mass: 2.0,
        inertia: 1.0,
        position: [0.0, 1.0],
        after,
        force: [0.0, -20.0, 0.0],
        ..Pushed::default()
    };
    let point = ContactPoint { arm_a: [0.0, 0.0], separation: 0.0, feature: 0, impulse };
    let contact = Contact { a: 0, b: 1, normal: [0.0, 1.0], points: vec![point], tangent_impulse: tangent };
    momentum_balance(&[ground, body], &[contact], 0.1, 0.5)
}

#[test]
fn a_load_that_holds_up_is_balanced_and_half_of_it_is_not() {
    assert_eq!(rubbed([0.0; 3], 2.0, 0.0), 0.0);
    assert_eq!(rubbed([0.0; 3], 1.0, 0.0), 0.5);
    assert_eq!(rubbed([0.0, -1.0, 0.0], 0.0, 0.0), 0.0, "falls freely");
}

#[test]
fn friction_pushes_and_turns() {
    // The tangent points to −x: 0.4 N·s give −0.2 m/s, and with an arm of 1 m downwards −0.4 rad/s.
    assert!(rubbed([-0.2, 0.0, -0.4], 2.0, 0.4) < 1e-16);
    // Without the turn 0.4 N·m·s are missing, 0.8 N·s over half a metre, of 2.
    assert!((rubbed([-0.2, 0.0, 0.0], 2.0, 0.4) - 0.4).abs() < 1e-15);
}

#[test]
fn what_cannot_be_pushed_counts_for_nothing() {
    let wall = Pushed { before: [3.0, 0.0, 0.0], after: [0.0; 3], ..Pushed::default() };
    assert_eq!(momentum_balance(&[wall], &[], 0.1, 1.0), 0.0);
}

/// A disc of 2 kg and radius 1 m on the ground, pushed up by `impulse` and sideways by `tangent`.
fn pushed(velocity: [f64; 2], [impulse, tangent, gap]: [f64; 3]) -> Residuals {
    let point = ContactPoint { arm_a: [0.0, 0.0], separation: gap, feature: 0, impulse };
    let contact = Contact { a: 1, b: 2, normal: [0.0, 1.0], points: vec![point], tangent_impulse: tangent };
    let ground = Side { friction: 0.5, ..Side::default() };
    let disc = Side {
        position: [0.0, 1.0],
        velocity,
        inv_mass: 0.5,
        inv_inertia: 1.0,
        friction: 0.8,
        ..Side::default()
    };
    Residuals::of(&[contact], |slot| if slot == 1 { ground } else { disc }, 10.0, 1.0)
}

#[test]
fn what_rests_and_is_pushed_obeys() {
    assert_eq!(pushed([0.0; 2], [3.0, 0.0, 0.0]), Residuals::default());
}

#[test]
fn what_parts_is_not_pushed_and_what_sinks_is_pushed_more() {
    // 2 kg parting at 0.5 m/s: 1 N·s too much. Sinking at 0.5: 1 too little. Not pushed and parting: right.
    assert_eq!(pushed([0.0, 0.5], [3.0, 0.0, 0.0]).signorini, 1.0);
    assert_eq!(pushed([0.0, -0.5], [3.0, 0.0, 0.0]).signorini, 1.0);
    assert_eq!(pushed([0.0, 0.5], [0.0, 0.0, 0.1]).signorini, 0.0);
    assert_eq!(pushed([0.0, 0.0], [-2.0, 0.0, 0.0]).signorini, 2.0, "a contact never pulls");
}

#[test]
fn friction_stops_or_slides_at_its_bound() {
    // The bound is 0.5·3 N·s; along the ground the disc's effective mass is 1/(½ + 1) kg, and the tangent points
    // to −x. Sliding to +x at the bound against it is right, half of it is half short.
    assert_eq!(pushed([6.0, 0.0], [3.0, 1.5, 0.0]).friction, 0.0);
    assert_eq!(pushed([6.0, 0.0], [3.0, 0.75, 0.0]).friction, 0.75);
    let short = pushed([0.3, 0.0], [3.0, 0.0, 0.0]).friction;
    assert!((short - 0.2).abs() < 1e-15, "{short}: 0.3 m/s of ⅔ kg");
    assert_eq!(pushed([0.0; 2], [3.0, 2.0, 0.0]).friction, 0.5, "more than the bound");
}

#[test]
fn there_is_a_gap_or_a_push() {
    assert_eq!(pushed([0.0; 2], [0.0, 0.0, 0.2]).complementarity, 0.0);
    assert_eq!(pushed([0.0; 2], [5.0, 0.0, 0.2]).complementarity, 0.2);
    assert_eq!(pushed([0.0; 2], [5.0, 0.0, -0.3]).complementarity, 0.3);
    let over = pushed([0.0, 0.5], [3.0, 0.0, -0.3]).over(10.0, 2.0);
    assert_eq!((over.signorini, over.complementarity), (0.1, 0.15));
}

fn square(x: f64, y: f64) -> Outline {
    let vertices = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]].map(|[u, v]| [x + u, y + v]).to_vec();
    Outline { centre: [x, y], radius: 0.0, vertices, fixed: false }
}
fn disc(x: f64, y: f64) -> Outline {
    Outline { centre: [x, y], radius: 0.5, vertices: Vec::new(), fixed: false }
}

#[test]
fn known_overlaps() {
    assert!((penetration(&[square(0.0, 0.0), square(0.9, 0.3)]).max - 0.1).abs() < 1e-12);
    assert!((penetration(&[square(0.0, 0.0), disc(0.9, 0.3)]).max - 0.1).abs() < 1e-12);
    assert!((penetration(&[disc(0.0, 0.0), disc(0.6, 0.0)]).max - 0.4).abs() < 1e-12);
    let corner = penetration(&[square(0.0, 0.0), disc(0.74, 0.82)]);
    assert!((corner.max - 0.1).abs() < 1e-12);
    assert_eq!(penetration(&[square(0.0, 0.0), square(2.0, 0.0)]), Penetration::default());
}

#[test]
fn pairs_of_fixed_bodies_do_not_count() {
    let fixed = Outline { fixed: true, ..square(0.0, 0.0) };
    assert_eq!(penetration(&[fixed.clone(), fixed.clone()]).pairs, 0);
    assert_eq!(penetration(&[fixed, square(0.0, 0.0)]).pairs, 1);
}
