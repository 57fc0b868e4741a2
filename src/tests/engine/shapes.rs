//! Outlines, mass properties, what is refused of them; frames counted into steps.

use std::f64::consts::PI;

use glam::DVec2;
use lamina2d::clock::Accumulator;
use lamina2d::shape::{Polygon, Shape, ShapeError};

fn outline(points: &[(f64, f64)]) -> Vec<DVec2> {
    points.iter().map(|&p| p.into()).collect()
}

#[test]
fn box_and_equal_polygon_have_equal_mass_properties() {
    let a = Shape::rectangle(2.0, 0.5).unwrap().mass_properties();
    let corners = outline(&[(5.0, 7.0), (9.0, 7.0), (9.0, 8.0), (5.0, 8.0)]);
    let b = Shape::polygon(&corners).unwrap().mass_properties();
    assert!((a.area - b.area).abs() < 1e-12 && (a.second_moment - b.second_moment).abs() < 1e-12);
    assert!(b.centroid.distance(DVec2::new(7.0, 7.5)) < 1e-12);
}

#[test]
fn many_sided_polygon_approaches_the_disc() {
    let points: Vec<_> = (0..8).map(|k| DVec2::from_angle(PI * f64::from(k) / 4.0)).collect();
    let octagon = Shape::polygon(&points).unwrap();
    // Regular n-gon of circumradius 1: I = A/6·(2 + cos(2π/n))/1 about its centroid.
    let p = octagon.mass_properties();
    assert!((p.area - 2.0 * 2f64.sqrt()).abs() < 1e-12);
    assert!((p.second_moment - p.area / 6.0 * (2.0 + (PI / 4.0).cos())).abs() < 1e-12);
}

#[test]
fn interior_angles_sum_to_n_minus_two_half_turns() {
    for n in 3..=8 {
        let points: Vec<_> =
            (0..n).map(|k| DVec2::from_angle(f64::from(k) * 2.0 * PI / f64::from(n) + 0.1)).collect();
        let polygon = Polygon::new(&points).unwrap();
        assert!((polygon.interior_angle_sum_rad() - f64::from(n - 2) * PI).abs() < 1e-12);
    }
}

#[test]
fn clockwise_outlines_are_reversed_and_recentred() {
    let polygon = Polygon::new(&outline(&[(0.0, 0.0), (0.0, 2.0), (2.0, 0.0)])).unwrap();
    let corners = polygon.vertices();
    let turns = |k: usize| (corners[(k + 1) % 3] - corners[k]).perp_dot(corners[(k + 2) % 3] - corners[k]);
    assert!((0..3).all(|k| turns(k) > 0.0));
    assert!(corners.iter().sum::<DVec2>().length() < 1e-15);
    assert!(polygon.centroid_given().distance(DVec2::splat(2.0 / 3.0)) < 1e-15);
}

#[test]
fn every_bad_outline_is_refused_by_name() {
    let star: Vec<_> = (0..5).map(|k| DVec2::from_angle(f64::from(k) * 0.8 * PI)).collect();
    let nan = outline(&[(0.0, 0.0), (1.0, f64::NAN), (0.0, 1.0)]);
    assert!(matches!(Polygon::new(&nan), Err(ShapeError::NonFinite { vertex: 1, .. })));
    assert!(matches!(Polygon::new(&star), Err(ShapeError::SelfCrossing { .. })));
    let cases: [(&[(f64, f64)], ShapeError); 7] = [
        (&[(0.0, 0.0), (1.0, 0.0)], ShapeError::TooFewVertices(2)),
        (&[(0.0, 0.0); 9], ShapeError::TooManyVertices(9)),
        (&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 0.0)], ShapeError::Duplicate { first: 1, second: 3 }),
        (&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)], ShapeError::SelfCrossing { first: 0, second: 2 }),
        (&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], ShapeError::ZeroArea(1)),
        (&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 1.0)], ShapeError::Collinear(1)),
        (&[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.5, 0.5)], ShapeError::Concave(3)),
    ];
    for (points, error) in cases {
        assert_eq!(Polygon::new(&outline(points)), Err(error));
    }
    assert_eq!(Shape::circle(0.0), Err(ShapeError::Radius(0.0)));
    assert!(Shape::circle(f64::NAN).is_err() && Shape::circle(-1.0).is_err());
    assert!(matches!(Shape::rectangle(1.0, -1.0), Err(ShapeError::HalfExtent { axis: 'y', .. })));
}

#[test]
fn frames_of_any_length_add_up_to_fixed_steps() {
    let mut clock = Accumulator::new(0.01, 0.2);
    let frames = [0.016, 0.016, 0.033, 0.001, 0.034];
    let steps: u32 = frames.iter().map(|&f| clock.steps_due(f)).sum();
    assert_eq!(steps, 10);
    assert!(clock.blend() < 1e-9 || clock.blend() > 1.0 - 1e-9);
}

#[test]
fn a_long_frame_counts_as_the_clamp() {
    let mut clock = Accumulator::new(0.01, 0.2);
    assert!(clock.steps_due(5.0) <= 20);
    assert_eq!(clock.steps_due(f64::NAN) + clock.steps_due(-1.0), 0);
}
