//! Acceptance of the thesis baseline: its published figures, and each of its known defects.

use lamina::thesis::{THESIS_DT_SECS, ThesisError, ThesisIntegrator, ThesisWorld, Version};
use lamina2d::force::Forces;
use lamina2d::scene::mixes::PX_PER_M;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};

use crate::shared_motion::scene_of;
use crate::shared_thesis::{MIXES, continued, mix, run, world_with};

/// 15 s of 0.0167 s.
const STEPS_IN_15_SECS: usize = 898;

fn circle(radius_px: f64, x_px: f64, y_px: f64) -> BodySpec {
    BodySpec::new(ShapeSpec::Circle(radius_px / PX_PER_M), [x_px / PX_PER_M, y_px / PX_PER_M]).mass(1.0)
}

/// A regular hexagon whose listed corners begin at `first`·60°.
fn hexagon(radius_px: f64, first: u32) -> BodySpec {
    let corner = |k: u32| {
        let angle = f64::from((k + first) % 6) * std::f64::consts::FRAC_PI_3;
        [radius_px / PX_PER_M * angle.cos(), radius_px / PX_PER_M * angle.sin()]
    };
    BodySpec::new(ShapeSpec::Polygon((0..6).map(corner).collect()), [0.0; 2]).mass(1.0)
}

fn world(scene: &Scene, version: Version) -> ThesisWorld {
    world_with(scene, ThesisIntegrator::Euler, version, true)
}

/// Both versions after one step without forces.
fn after_one_step(bodies: &[BodySpec]) -> [ThesisWorld; 2] {
    Version::ALL.map(|version| {
        let mut world = world(&scene_of(bodies.to_vec(), Forces::default()), version);
        world.step(THESIS_DT_SECS);
        world
    })
}

fn free_fall_px(integrator: ThesisIntegrator, version: Version) -> f64 {
    let scene = scene_of(vec![circle(15.0, 0.0, 0.0)], Forces::gravity());
    let mut world = world_with(&scene, integrator, version, true);
    run(&mut world, 120);
    -world.positions_m()[0][1] * PX_PER_M
}

#[test]
fn free_fall_ends_where_the_formulas_and_the_published_figures_say() {
    let (g, h, n) = (245.25, f64::from(THESIS_DT_SECS), 120.0);
    let steps_before = n * (n - 1.0) / 2.0;
    let gain = 1.0 + h / 2.0 + h * h / 6.0 + h * h * h / 24.0;
    let rk4 = gain * steps_before + n * (0.5 + h / 6.0 + h * h / 24.0);
    assert!((0.5 * g * (n * h).powi(2) - 492.46_f64).abs() < 0.01);
    let expected = [
        (ThesisIntegrator::Euler, g * h * h * (steps_before + n), 496.57),
        (ThesisIntegrator::Verlet, g * h * h * (steps_before + 0.5), 488.39),
        (ThesisIntegrator::Rk4, g * h * h * rk4, 496.59),
    ];
    for (integrator, formula, published) in expected {
        assert!((formula - published).abs() < 0.01, "{integrator:?}: formula {formula}");
        for version in Version::ALL {
            let fallen = free_fall_px(integrator, version);
            assert!((fallen - formula).abs() < 0.01, "{integrator:?}: {fallen} for {formula}");
        }
    }
}

#[test]
fn rk4_is_no_better_than_euler() {
    let error = |integrator| (free_fall_px(integrator, Version::Faithful) - 492.46).abs();
    assert!(error(ThesisIntegrator::Rk4) >= error(ThesisIntegrator::Euler));
}

#[test]
fn two_runs_are_bit_identical() {
    for name in MIXES {
        let scene = mix(name, 40);
        for integrator in ThesisIntegrator::ALL {
            for version in Version::ALL {
                let hash = || {
                    let mut world = world_with(&scene, integrator, version, true);
                    run(&mut world, 300);
                    world.hash()
                };
                assert_eq!(hash(), hash(), "{name} {integrator:?} {version:?}");
            }
        }
    }
}

#[test]
fn bounding_test_changes_no_bit() {
    for name in MIXES {
        let scene = mix(name, 60);
        for version in Version::ALL {
            let [on, off] = [true, false].map(|broad| {
                let mut world = world_with(&scene, ThesisIntegrator::Euler, version, broad);
                run(&mut world, 400);
                world
            });
            assert_eq!(on.hash(), off.hash(), "{name} {version:?}");
            assert_eq!(on.contacts(), off.contacts());
            assert!(on.contacts() > 30, "{name}: {} contacts", on.contacts());
            assert!(on.contacts() <= on.candidates() && on.candidates() <= off.candidates());
        }
    }
}

#[test]
fn tidy_circles_are_the_faithful_ones_to_the_bit() {
    for integrator in ThesisIntegrator::ALL {
        let falling = (0..40).map(|k| {
            let (column, row) = (f64::from(k % 5), f64::from(k / 5));
            circle(15.0, column * 31.0 + 3.0 * row, row * 31.0).surface(0.5, 0.5)
        });
        let bowl = circle(400.0, 60.0, -420.0).surface(0.2, 0.2);
        let bowl = BodySpec { mass: None, ..bowl.fixed() };
        let scene = scene_of(std::iter::once(bowl).chain(falling).collect(), Forces::gravity());
        let [faithful, tidy] = Version::ALL.map(|version| {
            let mut world = world_with(&scene, integrator, version, true);
            run(&mut world, 60);
            assert!(world.contacts() > 10);
            world.hash()
        });
        assert_eq!(faithful, tidy, "{integrator:?}");
    }
}

fn farthest_px(a: &ThesisWorld, b: &ThesisWorld) -> f64 {
    let apart = |(p, q): (&[f64; 2], &[f64; 2])| (p[0] - q[0]).hypot(p[1] - q[1]) * PX_PER_M;
    a.positions_m().iter().zip(&b.positions_m()).map(apart).fold(0.0, f64::max)
}

#[test]
fn tidy_agrees_with_faithful_to_rounding_step_by_step() {
    // A pile is chaotic, so both are compared one step on from common states. Where two corners or two axes
    // tie, or a contact is only just one, rounding chooses differently: few steps may differ visibly.
    const VISIBLE_PX: f64 = 2e-3;
    for name in MIXES {
        let scene = mix(name, 60);
        let mut path = world(&scene, Version::Faithful);
        let (mut visible, mut largest) = (0, 0.0_f64);
        for _ in 0..60 {
            run(&mut path, 10);
            let now = continued(&scene, &path);
            let [faithful, tidy] = Version::ALL.map(|version| {
                let mut world = world(&now, version);
                world.step(THESIS_DT_SECS);
                world
            });
            let apart = farthest_px(&faithful, &tidy);
            if apart > VISIBLE_PX || faithful.contacts() != tidy.contacts() {
                visible += 1;
            } else {
                largest = largest.max(apart);
            }
        }
        println!("{name}: largest {largest:.1e} px, {visible} of 60 steps differ visibly");
        assert!(visible <= 3, "{name}: {visible} of 60 steps differ by more than {VISIBLE_PX} px");
    }
}

#[test]
fn tidy_piles_settle_as_faithful_piles_do() {
    for name in MIXES {
        let scene = mix(name, 60);
        let means = Version::ALL.map(|version| {
            let mut world = world(&scene, version);
            run(&mut world, 600);
            let heights = world.positions_m().into_iter().skip(5).map(|p| p[1]);
            heights.sum::<f64>() / (world.len() - 5) as f64
        });
        println!("{name}: mean heights {means:.3?} m");
        assert!((means[0] / means[1] - 1.0).abs() < 0.1, "{name}: {means:?}");
    }
}

#[test]
fn determinism_scene_rests_at_the_published_heights() {
    let mut scene = by_name("determinism", None, 0).unwrap();
    // .45π in the window's axes is clockwise. Where body 3 comes to rest depends on the way the slope faces.
    scene.bodies[1].angle = -0.45 * std::f64::consts::PI;
    for version in Version::ALL {
        let mut world = world(&scene, version);
        run(&mut world, STEPS_IN_15_SECS);
        // `scene::mixes` puts the floor's top, y = 555 in the window, at 0.
        let y: Vec<f64> = world.positions_m()[5..].iter().map(|p| 555.0 - p[1] * PX_PER_M).collect();
        let speeds: Vec<f64> =
            world.velocities_m_per_s()[5..].iter().map(|v| v[0].hypot(v[1]) * PX_PER_M).collect();
        println!("{version:?}: y {y:.2?} px, speeds {speeds:.1?} px/s, {} contacts", world.contacts());
        for (k, rest) in [(0, 530.0), (1, 530.0), (2, 505.0), (3, 535.0)] {
            assert!((y[k] - rest).abs() < 0.5, "{version:?} body {}: {} for {rest}", k + 1, y[k]);
        }
        assert!((speeds[3] - 11.0).abs() < 0.5, "body 4 lies still but for its jitter of {}", speeds[3]);
    }
}

#[test]
fn two_thousand_kilograms_are_static() {
    let falls = |mass: f64| {
        let scene = scene_of(vec![circle(15.0, 0.0, 0.0).mass(mass)], Forces::gravity());
        let mut world = world(&scene, Version::Faithful);
        run(&mut world, 10);
        (world.is_static(0), world.positions_m()[0][1] < 0.0)
    };
    assert_eq!(falls(1999.0), (false, true));
    assert_eq!(falls(2000.0), (true, false));
    assert_eq!(falls(1e6), (true, false));
}

#[test]
fn parting_circles_are_pulled_together() {
    for world in after_one_step(&[
        circle(15.0, 0.0, 0.0).moving([-1.0, 0.0], 0.0).surface(0.5, 0.0),
        circle(15.0, 25.0, 0.0).moving([1.0, 0.0], 0.0).surface(0.5, 0.0),
    ]) {
        let parting = world.velocities_m_per_s()[1][0] - world.velocities_m_per_s()[0][0];
        assert!((parting + 0.5 * 2.0).abs() < 1e-5, "they parted with 2 m/s and now with {parting}");
    }
}

#[test]
fn friction_has_no_cone() {
    // A graze: hardly any approach, much sliding. Coulomb would bound the tangential change by f·|normal|.
    let floor = BodySpec { mass: None, ..circle(1000.0, 0.0, -1000.0).fixed() };
    for world in after_one_step(&[
        floor.surface(0.0, 0.5),
        circle(15.0, -4.0, 14.9).moving([10.0, 0.0], 0.0).surface(0.0, 0.5),
    ]) {
        let [vx, vy] = world.velocities_m_per_s()[1];
        assert_eq!(world.contacts(), 1);
        assert!(10.0 - vx > 10.0 * 0.5 * vy.abs(), "sliding lost {}, normal change {vy}", 10.0 - vx);
    }
}

#[test]
fn slowest_approach_still_bounces() {
    for world in after_one_step(&[
        circle(15.0, 0.0, 0.0).moving([1e-4, 0.0], 0.0).surface(1.0, 0.0),
        circle(15.0, 29.99, 0.0).moving([-1e-4, 0.0], 0.0).surface(1.0, 0.0),
    ]) {
        assert!(world.velocities_m_per_s()[0][0] < -0.9e-4);
    }
}

#[test]
fn coincident_centres_become_nan() {
    for world in after_one_step(&[circle(15.0, 3.0, 4.0), circle(10.0, 3.0, 4.0)]) {
        assert!(world.positions_m().iter().flatten().all(|x| x.is_nan()));
        assert_eq!(world.contacts(), 1);
    }
}

#[test]
fn circle_against_polygon_takes_the_first_edge_that_sees_it() {
    // 10 px over the edge from 60° to 120°, 5 px along it: 11.2 px from the corner at 60°. A circle of
    // 10.5 px overlaps that edge but not the corner, and the edge before the corner sees it too, 0.7 px high.
    let over_edge = circle(10.5, 10.0, 15.0 * 3.0_f64.sqrt() + 10.0);
    let hits: Vec<[usize; 2]> = (0..6)
        .map(|first| after_one_step(&[hexagon(30.0, first), over_edge.clone()]).map(|world| world.contacts()))
        .collect();
    for version in 0..2 {
        let found = hits.iter().filter(|hit| hit[version] == 1).count();
        assert!((1..6).contains(&found), "by the corner listed first: {hits:?}");
    }
}

#[test]
fn polygons_swallow_circles_that_boxes_expel() {
    let inside = circle(5.0, 0.0, 20.0);
    for world in after_one_step(&[hexagon(30.0, 0), inside.clone()]) {
        let [hull, ball] = [world.positions_m()[0][1], world.positions_m()[1][1]];
        assert!((ball - hull) * PX_PER_M < 19.9, "pulled in");
    }
    let slab = BodySpec::new(ShapeSpec::Box([1.0, 1.0]), [0.0; 2]).mass(1.0);
    for world in after_one_step(&[slab, inside]) {
        let [hull, ball] = [world.positions_m()[0][1], world.positions_m()[1][1]];
        assert!((ball - hull) * PX_PER_M > 20.1, "pushed out");
    }
}

/// A box of 1 m, turned by `angle`, meets a wide floor at 2 m/s.
fn landings(angle: f64) -> [ThesisWorld; 2] {
    let floor = BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [0.0, -0.5]).fixed();
    let falling = BodySpec::new(ShapeSpec::Box([0.5, 0.5]), [0.0, 0.499]).mass(1.0).turned(angle);
    after_one_step(&[floor, falling.moving([0.0, -2.0], 0.0)])
}

#[test]
fn one_contact_point_spins_an_all_but_flat_landing() {
    for world in landings(1e-3) {
        assert_eq!(world.contacts(), 1);
        assert!(world.angular_velocities_rad_per_s()[1].abs() > 1.0);
    }
}

#[test]
fn exactly_flat_landing_is_struck_at_the_floors_far_corner() {
    // Both faces overlap equally; the falling box's is taken, and the floor's corner 20 m away is "deepest"
    // in it. At that arm the impulse is next to nothing: the box keeps falling.
    for world in landings(0.0) {
        assert_eq!(world.contacts(), 1);
        assert!(world.velocities_m_per_s()[1][1] < -1.9);
    }
}

#[test]
fn readers_give_the_scene_back() {
    let scene = mix("all", 30);
    for version in Version::ALL {
        let world = world(&scene, version);
        assert_eq!(world.len(), scene.bodies.len());
        for (k, body) in scene.bodies.iter().enumerate() {
            let [x, y] = world.positions_m()[k];
            assert!((x - body.position[0]).hypot(y - body.position[1]) < 1e-5);
            assert!((world.angles_rad()[k] - body.angle).abs() < 1e-6);
            assert_eq!(world.is_static(k), body.kind == BodyKind::Static);
            check_outline(&world.outline_m(k), world.radius_m(k), body);
        }
    }
}

fn check_outline(outline: &[[f64; 2]], radius_m: f64, body: &BodySpec) {
    match &body.shape {
        ShapeSpec::Circle(radius) => assert!(outline.is_empty() && (radius_m - radius).abs() < 1e-6),
        ShapeSpec::Box([x, y]) => assert!((area(outline) / (4.0 * x * y) - 1.0).abs() < 1e-5),
        ShapeSpec::Polygon(given) => {
            // The same corners in the same place; only where the list begins may differ.
            let listed = |v: [f64; 2]| outline.iter().any(|w| (v[0] - w[0]).hypot(v[1] - w[1]) < 1e-5);
            assert!(given.iter().all(|v| listed([v[0] + body.position[0], v[1] + body.position[1]])));
            assert!((area(outline) - area(given)).abs() < 1e-5 && area(given) > 0.0);
        }
    }
}

fn area(outline: &[[f64; 2]]) -> f64 {
    let n = outline.len();
    let cross = |k: usize| outline[k][0] * outline[(k + 1) % n][1] - outline[k][1] * outline[(k + 1) % n][0];
    (0..n).map(cross).sum::<f64>() / 2.0
}

#[test]
fn angles_turn_counter_clockwise_as_in_the_scene() {
    let bar = BodySpec::new(ShapeSpec::Box([2.0, 0.1]), [0.0; 2]).mass(1.0).turned(0.5).moving([0.0; 2], 1.0);
    for world in after_one_step(&[bar]) {
        let angle = 0.5 + f64::from(THESIS_DT_SECS);
        assert!((world.angles_rad()[0] - angle).abs() < 1e-6);
        let tip = [2.0 * angle.cos() - 0.1 * angle.sin(), 2.0 * angle.sin() + 0.1 * angle.cos()];
        assert!(world.outline_m(0).iter().any(|v| (v[0] - tip[0]).hypot(v[1] - tip[1]) < 1e-5));
    }
}

#[test]
fn mass_comes_from_density_and_area() {
    // Equal and opposite momenta without restitution come to rest.
    let small = BodySpec { density: Some(4.0), mass: None, ..circle(10.0, 0.0, 0.0) };
    let large = BodySpec { density: Some(1.0), mass: None, ..circle(20.0, 28.0, 0.0) };
    for world in after_one_step(&[
        small.moving([1.0, 0.0], 0.0).surface(0.0, 0.0),
        large.moving([-1.0, 0.0], 0.0).surface(0.0, 0.0),
    ]) {
        assert!(world.velocities_m_per_s().iter().all(|v| v[0].abs() < 1e-6));
    }
}

#[test]
fn what_the_baseline_lacks_is_refused_by_name() {
    let refused = |bodies: Vec<BodySpec>, forces: Forces| {
        ThesisWorld::new(&scene_of(bodies, forces), ThesisIntegrator::Euler, Version::Tidy, true).unwrap_err()
    };
    let body = || circle(15.0, 0.0, 0.0);
    let none = Forces::default();
    let platform = BodySpec { kind: BodyKind::Kinematic, ..body() };
    assert_eq!(refused(vec![body(), platform], none), ThesisError::Kinematic { body: 1 });
    let drag = Forces { linear_drag: Some(0.1), ..none };
    assert_eq!(refused(vec![body()], drag), ThesisError::Field { field: "linear_drag" });
    let pushed = BodySpec { force: [1.0, 0.0], ..body() };
    let message = refused(vec![pushed], none).to_string();
    assert!(message.contains("body 0: the thesis baseline has no constant force"), "{message}");
    let ghost = BodySpec { collides_with: 0, ..body() };
    assert!(matches!(refused(vec![ghost], none), ThesisError::Feature { body: 0, .. }));
    let both = BodySpec { density: Some(1.0), ..body() };
    assert_eq!(refused(vec![both], none), ThesisError::MassAndDensity { body: 0 });
    assert!(matches!(refused(vec![body().mass(-1.0)], none), ThesisError::OutOfRange { field: "mass", .. }));
    let dot = BodySpec::new(ShapeSpec::Circle(0.0), [0.0; 2]);
    assert!(matches!(refused(vec![dot], none), ThesisError::Shape { body: 0, .. }));
    let nowhere = BodySpec { position: [f64::NAN, 0.0], ..body() };
    assert!(matches!(refused(vec![nowhere], none), ThesisError::OutOfRange { field: "position x", .. }));
}

#[test]
fn the_baseline_takes_no_joints() {
    let scene = by_name("pendulum", None, 1).unwrap();
    let error = ThesisWorld::new(&scene, ThesisIntegrator::Euler, Version::Tidy, true).unwrap_err();
    assert_eq!(error, ThesisError::Joints { joints: 1 });
}
