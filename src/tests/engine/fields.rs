//! Force fields against their formulas, and what is refused of them.

use lamina2d::force::{Central, Drive, ForceError, Forces, Matter, Spring, acceleration};
use lamina2d::internals::BLOCK;
use lamina2d::vec2::Vec2;

fn at(forces: &Forces, x: [f64; 2], v: [f64; 2], inv_mass: f64) -> [f64; 2] {
    let (mass, no_force) = ([inv_mass; BLOCK], None);
    let matter = Matter { inv_mass: &mass, force: no_force };
    let a = acceleration::<f64>(
        &forces.fields(),
        matter,
        0.0,
        &[Vec2::splat(x); BLOCK],
        &[Vec2::splat(v); BLOCK],
    );
    [a[0].x, a[0].y]
}

#[test]
fn each_field_has_its_formula() {
    let none = Forces::default();
    assert_eq!(at(&Forces::gravity(), [1.0, 2.0], [3.0, 4.0], 0.5), [0.0, -9.81]);
    let drag = Forces { linear_drag: Some(2.0), wind: Some([1.0, 0.0]), ..none };
    assert_eq!(at(&drag, [0.0; 2], [3.0, 4.0], 0.5), [-2.0, -4.0]);
    let drag = Forces { quadratic_drag: Some(2.0), ..none };
    assert_eq!(at(&drag, [0.0; 2], [3.0, 4.0], 0.5), [-15.0, -20.0]);
    let spring = Forces { spring: Some(Spring { anchor: [1.0, 1.0], stiffness: 4.0 }), ..none };
    assert_eq!(at(&spring, [2.0, 3.0], [0.0; 2], 0.5), [-2.0, -4.0]);
    let central = Forces { central: Some(Central { center: [0.0, 0.0], strength: 8.0 }), ..none };
    assert_eq!(at(&central, [0.0, 2.0], [0.0; 2], 0.5), [0.0, -2.0]);
    assert_eq!(at(&central, [0.0, 0.0], [0.0; 2], 0.5), [0.0, 0.0]);
    let magnetic = Forces { magnetic: Some(2.0), ..none };
    assert_eq!(at(&magnetic, [0.0; 2], [3.0, 4.0], 0.5), [4.0, -3.0]);
    let both = Forces { companion: Some(Central { center: [0.0, 4.0], strength: 4.0 }), ..central };
    assert_eq!(at(&both, [0.0, 2.0], [0.0; 2], 0.5), [0.0, -1.0]);
    let cubic = Forces { henon_heiles: Some(2.0), ..none };
    assert_eq!(at(&cubic, [3.0, 1.0], [0.0; 2], 0.5), [-12.0, -16.0]);
    let drive = Forces { drive: Some(Drive { amplitude: [2.0, -1.0], rate: 3.0, phase: 0.0 }), ..none };
    assert_eq!(at(&drive, [0.0; 2], [0.0; 2], 0.5), [2.0, -1.0]);
}

/// The phase is that of the step plus what has gone by since, in `f64`.
#[test]
fn a_drive_swings_in_time() {
    let drive = Drive { amplitude: [2.0, 0.0], rate: 3.0, phase: 0.25 };
    let mut fields = Forces { drive: Some(drive), ..Forces::default() }.fields::<f64>();
    fields[0].begin(100.0);
    let (mass, still) = ([1.0; BLOCK], [Vec2::zero(); BLOCK]);
    let a = acceleration::<f64>(&fields, Matter { inv_mass: &mass, force: None }, 0.5, &still, &still);
    assert!((a[0].x - 2.0 * (0.25f64 + 3.0 * 100.5).cos()).abs() < 1e-13, "{}", a[0].x);
}

/// Momentum does not change, and the pull is G·m/r².
#[test]
fn bodies_attract_each_other_by_their_masses() {
    let fields = Forces { attraction: Some(3.0), ..Forces::default() }.fields::<f64>();
    let inv_mass = [1.0, 0.5, 0.0, 0.25];
    let at = [[0.0, 0.0], [2.0, 0.0], [1.0, 1.0], [0.0, 4.0]].map(Vec2::splat);
    let matter = Matter { inv_mass: &inv_mass, force: None };
    let a = acceleration::<f64>(&fields, matter, 0.0, &at, &[Vec2::zero(); BLOCK]);
    assert_eq!([a[0].x, a[0].y], [3.0 * 2.0 / 4.0, 3.0 * 4.0 / 16.0]);
    assert_eq!([a[2].x, a[2].y], [0.0; 2], "a held body is not pulled");
    let momentum = |of: fn(Vec2<f64>) -> f64| of(a[0]) + 2.0 * of(a[1]) + 4.0 * of(a[3]);
    assert!(momentum(|v| v.x).abs() < 1e-15 && momentum(|v| v.y).abs() < 1e-15);
}

#[test]
fn held_bodies_feel_nothing() {
    let all = Forces {
        gravity: Some([1.0, 2.0]),
        wind: Some([5.0, 5.0]),
        linear_drag: Some(1.0),
        quadratic_drag: Some(1.0),
        spring: Some(Spring { anchor: [1.0, 1.0], stiffness: 4.0 }),
        central: Some(Central { center: [0.0, 0.0], strength: 8.0 }),
        magnetic: Some(1.0),
        companion: Some(Central { center: [1.0, 0.0], strength: 2.0 }),
        henon_heiles: Some(1.0),
        drive: Some(Drive { amplitude: [1.0, 2.0], rate: 3.0, phase: 0.5 }),
        attraction: Some(1.0),
    };
    assert_eq!(at(&all, [2.0, 3.0], [1.0, 1.0], 0.0), [0.0, 0.0]);
}

#[test]
fn bad_coefficients_are_named() {
    let bad = Forces { linear_drag: Some(-1.0), ..Forces::default() };
    assert_eq!(bad.check(), Err(ForceError::Negative { field: "linear_drag", value: -1.0 }));
    let bad = Forces { wind: Some([1.0, 0.0]), ..Forces::default() };
    assert_eq!(bad.check(), Err(ForceError::WindWithoutDrag));
    let bad = Forces { gravity: Some([0.0, f64::NAN]), ..Forces::default() };
    assert!(matches!(bad.check(), Err(ForceError::NonFinite { field: "gravity", .. })));
}
