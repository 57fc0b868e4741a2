//! What every solver owes: stacks stand, friction holds and slides as Coulomb says, momentum stays, one hash at all
//! widths, no energy from nowhere. What a solver cannot do is stated with it.

use lamina2d::force::Forces;
use lamina2d::scene::{BodyKind, BodySpec, Scene, ShapeSpec, by_name};
use lamina2d::settings::{Integrator, Precision, Settings, Solver};
use lamina2d::simulation::Simulation;

use crate::shared_motion::{at_every_width, scene_of, start};

const DT_SECS: f64 = 1.0 / 60.0;
const GRAVITY: f64 = 9.81;

fn named(name: &str) -> Scene {
    by_name(name, None, 1).expect("a named scene")
}

/// The substeps a solver is used with: `avbd` iterates inside one.
fn of(solver: Solver) -> Settings {
    let substeps = if solver == Solver::Avbd { 1 } else { 4 };
    Settings { solver, substeps, ..Settings::default() }
}

fn run(world: &mut dyn Simulation, steps: usize) {
    for _ in 0..steps {
        world.step(DT_SECS).expect("stays finite");
    }
}

/// Ten boxes for ten seconds: overlap and speed at the end. `impulse` has no memory and lets the stack sink.
#[test]
fn a_stack_of_ten_stands() {
    for &solver in Solver::ALL {
        let mut world = start(&named("stack/10"), of(solver));
        run(&mut *world, 600);
        let top = world.states()[10].position;
        let (overlap, speed) =
            (world.penetration().max, world.states().iter().map(|s| s.velocity[1].abs()).fold(0.0, f64::max));
        println!("{solver}: overlap {overlap} m, fastest {speed} m/s, top {top:?}");
        if solver == Solver::Impulse {
            assert!(overlap < 0.3 && top[1] > 7.5, "{solver}: {overlap} m, {top:?}");
            continue;
        }
        assert!(overlap < 2e-3 && speed < 0.03, "{solver}: {overlap} m, {speed} m/s");
        assert!(top[0].abs() < 1e-3 && (top[1] - 9.5).abs() < 0.01, "{solver}: {top:?}");
    }
}

/// A soft contact sags by N/(m·ω²): with the inverse square of its stiffness.
#[test]
fn softer_contacts_sag_as_springs_do() {
    let sag = |stiffness: Option<f64>| {
        let settings = Settings { stiffness, ..of(Solver::Soft) };
        let mut world = start(&named("stack/2"), settings);
        run(&mut *world, 600);
        world.penetration().max
    };
    let usual = sag(None);
    assert_eq!(sag(Some(0.18)).to_bits(), usual.to_bits(), "named or not");
    for stiffness in [0.06, 0.09, 0.12, 0.25] {
        let (found, wanted) = (sag(Some(stiffness)) / usual, (0.18f64 / stiffness).powi(2));
        assert!((found / wanted - 1.0).abs() < 0.02, "{stiffness}: {found} times, for {wanted}");
    }
}

/// Where the others fall through: a thousand times the mass of the body that carries it.
#[test]
fn avbd_carries_heavy_bodies() {
    for (ratio, most) in [(100, 3e-3), (1000, 0.02), (10_000, 0.08)] {
        let mut world = start(&named(&format!("heavy/{ratio}")), of(Solver::Avbd));
        run(&mut *world, 600);
        let (overlap, y) = (world.penetration().max, world.states()[2].position[1]);
        assert!(overlap < most && (y - 1.5).abs() < 2.0 * most, "{ratio}: {overlap} m, {y} m");
    }
}

/// A box on a slope of tan θ, in the frame of the slope: gravity leans instead.
fn on_a_slope(tan: f64, friction: f64, solver: Solver) -> Box<dyn Simulation> {
    let cos = 1.0 / (1.0 + tan * tan).sqrt();
    let floor = BodySpec::new(ShapeSpec::Box([200.0, 0.5]), [0.0, -0.5]).surface(0.0, friction).fixed();
    let load = BodySpec::new(ShapeSpec::Box([0.5, 0.25]), [0.0, 0.25]).surface(0.0, friction);
    let gravity = Some([GRAVITY * tan * cos, -GRAVITY * cos]);
    let mut world = start(&scene_of(vec![floor, load], Forces { gravity, ..Forces::default() }), of(solver));
    run(&mut *world, 120);
    world
}

/// Two seconds at tan θ = 0.9 μ: how far a box creeps; at 1.1 μ: a = g(sin θ − μ cos θ). What each solver is off by at
/// most, metres and share: `impulse` has no memory, and the push out of overlaps of `pgs` rubs.
#[test]
fn boxes_stick_and_slide_as_coulomb_says() {
    let friction = 0.5;
    let mut wrong = Vec::new();
    for &solver in Solver::ALL {
        let (creep_most, off_most) = match solver {
            Solver::Impulse => (0.1, 0.08),
            Solver::Pgs => (0.02, 0.05),
            Solver::Soft | Solver::Xpbd | Solver::Avbd => (0.01, 0.03),
        };
        let creep = on_a_slope(0.9 * friction, friction, solver).states()[1].position[0];
        let tan: f64 = 1.1 * friction;
        let cos = 1.0 / (1.0 + tan * tan).sqrt();
        let expected = GRAVITY * cos * (tan - friction) * 2.0;
        let off = on_a_slope(tan, friction, solver).states()[1].velocity[0] / expected - 1.0;
        println!("{solver}: creeps {creep:.2e} m, slides {off:+.2e} off");
        if creep.abs() > creep_most || off.abs() > off_most {
            wrong.push((solver, creep, off));
        }
    }
    assert!(wrong.is_empty(), "{wrong:?}");
}

#[test]
fn momentum_stays_when_bodies_meet_head_on() {
    for &solver in Solver::ALL {
        let settings = of(solver).with_precision(Precision::F64);
        let mut world = start(&named("head_on/20"), settings);
        let before = world.invariants().momentum;
        run(&mut *world, 180);
        let after = world.invariants().momentum;
        let off = (after[0] - before[0]).hypot(after[1] - before[1]);
        println!("{solver}: {off} of {} kg·m/s", before[0].abs());
        // Ten rounds leave the two bodies' forces on each other a few hundredths apart.
        let most = if solver == Solver::Avbd { 0.06 * before[0].abs() } else { 1e-9 };
        assert!(off < most, "{solver}: {off} kg·m/s");
        let met = world.states().chunks(2).all(|pair| pair[0].position[0] < pair[1].position[0]);
        assert!(met && world.states()[0].velocity[0] < 0.9, "{solver}: they met: {:?}", &world.states()[..2]);
    }
}

#[test]
fn no_width_moves_a_bit_of_any_solver() {
    for &solver in Solver::ALL {
        for precision in Precision::ALL {
            let hashes: Vec<_> = at_every_width(of(solver))
                .filter(|settings| settings.precision == *precision)
                .map(|settings| {
                    let mut world = start(&named("polygons/40"), settings);
                    run(&mut *world, 200);
                    world.hash()
                })
                .collect();
            assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{solver} {precision}: {hashes:?}");
        }
    }
}

/// A pile that falls: kinetic and potential energy never exceed the start by more than a thousandth; `pgs` leaves what it
/// pushes overlaps out by in the bodies, 0.12 % here.
#[test]
fn no_solver_makes_energy_in_a_falling_pile() {
    let mut bodies = vec![BodySpec::new(ShapeSpec::Box([20.0, 0.5]), [0.0, -0.5]).fixed()];
    for k in 0..60 {
        let position =
            [f64::from(k % 6) * 1.05 - 2.6 + 0.1 * f64::from(k / 6 % 2), 1.0 + 1.1 * f64::from(k / 6)];
        let shape = match k % 3 {
            0 => ShapeSpec::Circle(0.45),
            1 => ShapeSpec::Box([0.45, 0.4]),
            _ => ShapeSpec::Polygon(vec![[-0.45, -0.4], [0.45, -0.4], [0.3, 0.4], [-0.3, 0.4]]),
        };
        bodies.push(BodySpec::new(shape, position).turned(0.3 * f64::from(k % 5)));
    }
    let scene = scene_of(bodies, Forces::gravity());
    for &solver in Solver::ALL {
        let mut world = start(&scene, of(solver));
        let energy = |world: &dyn Simulation| {
            let sums = world.invariants();
            sums.kinetic_energy + sums.potential_energy
        };
        let (first, mut most) = (energy(&*world), f64::MIN);
        for _ in 0..300 {
            run(&mut *world, 1);
            most = most.max(energy(&*world));
        }
        println!(
            "{solver}: {first} J, at most {:+.1e} of it more, ends with {}",
            most / first - 1.0,
            energy(&*world)
        );
        let gain = if solver == Solver::Pgs { 2e-3 } else { 1e-3 };
        assert!(most < first * (1.0 + gain), "{solver}: {first} J, at most {most}");
    }
}

/// What touches nothing moves by the scheme alone, whichever solver works beside it.
#[test]
fn bodies_that_touch_nothing_keep_their_bits() {
    let mut bodies = named("stack/3").bodies;
    bodies.push(BodySpec::new(ShapeSpec::Circle(0.3), [7.0, 30.0]).moving([1.0, 3.0], 2.0));
    for &integrator in Integrator::ALL {
        let last = |solver| {
            let settings = Settings { integrator, substeps: 4, ..of(solver) };
            let mut world = start(&scene_of(bodies.clone(), Forces::gravity()), settings);
            run(&mut *world, 60);
            world.states()[4]
        };
        for &solver in Solver::ALL {
            assert_eq!(last(solver), last(Solver::Soft), "{solver} {integrator}");
        }
    }
}

/// Settled first; then 60 steps are counted.
#[test]
fn no_solver_allocates_once_a_pile_has_settled() {
    for &solver in Solver::ALL {
        for name in ["stack/10", "all/150"] {
            let mut world = start(&named(name), of(solver));
            run(&mut *world, 600);
            let count = allocation_counter::measure(|| run(&mut *world, 60)).count_total;
            assert_eq!(count, 0, "{solver} {name}");
        }
    }
}

#[test]
fn solvers_agree_on_which_bodies_move() {
    for &solver in Solver::ALL {
        let scene = named("spinner/30");
        let mut world = start(&scene, of(solver));
        run(&mut *world, 120);
        for (state, spec) in world.states().iter().zip(&scene.bodies) {
            if spec.kind == BodyKind::Static {
                assert_eq!(state.position, spec.position.map(|x| f64::from(x as f32)), "{solver}");
            }
        }
    }
}
