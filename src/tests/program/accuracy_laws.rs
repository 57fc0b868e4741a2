//! What the cases of table A must show beside their orders: what stays finite, what closes, what is conserved.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::cases::smooth::{ARENSTORF_PERIOD_SECS, converged};
use lamina::cases::{self, by_name};
use lamina::reference::ode;
use lamina2d::force::{Forces, Spring};
use lamina2d::scene::Scene;
use lamina2d::settings::{Integrator, Precision, Settings, Skips, Solver, StiffFields};
use lamina2d::simulation::{Simulation, simulate};

fn named(name: &str) -> Scene {
    by_name(name, None, 1).unwrap()
}

fn world(scene: &Scene, integrator: Integrator) -> Box<dyn Simulation> {
    let stiff_fields = Some(StiffFields::Scheme);
    let settings =
        Settings { integrator, substeps: 1, continuous: false, stiff_fields, ..Settings::default() };
    simulate(scene, settings.with_precision(Precision::F64)).unwrap()
}

fn energy(world: &dyn Simulation) -> f64 {
    let sums = world.invariants();
    sums.kinetic_energy + sums.potential_energy
}

/// A7: c = 10⁴/s, steps of up to a whole second: c·h = 10⁴, and the joint creeps back to its length as it should.
#[test]
fn a_sprung_joint_stays_finite_however_long_the_step_is() {
    let scene = named("a07_overdamped");
    for &solver in Solver::ALL {
        for (h, steps) in [(1.0, 100), (0.1, 300), (1.0 / 60.0, 600)] {
            let settings = Settings { solver, substeps: 1, ..Settings::default() };
            let mut world = simulate(&scene, settings.with_precision(Precision::F64)).unwrap();
            for step in 1..=steps {
                world.step(h).unwrap_or_else(|why| panic!("{solver} at h = {h}: {why}"));
                let stretch = world.states()[1].position[0] - 1.0;
                assert!(stretch.abs() <= 0.5 + 1e-12, "{solver} at h = {h}: {stretch} m after step {step}");
                assert!(step < steps || stretch < 0.4, "{solver} at h = {h}: {stretch} m are left");
            }
        }
    }
}

/// A7, what no scheme can do: as a field the same drag is explicit, and at c·h = 167 every scheme leaves it. The run is
/// stopped and says so.
#[test]
fn stiff_drag_as_a_field_is_left_by_every_scheme_and_the_run_says_so() {
    let spring = Some(Spring { anchor: [0.0; 2], stiffness: 9.0 });
    let scene = Scene {
        forces: Forces { linear_drag: Some(1e4), spring, ..Forces::default() },
        ..named("a07_damped")
    };
    for &integrator in Integrator::ALL {
        let mut world = world(&scene, integrator);
        let failed = (0..1000).find_map(|_| world.step(1.0 / 60.0).err());
        let message = failed.unwrap_or_else(|| panic!("{integrator} stays finite")).to_string();
        assert!(message.contains("no longer finite"), "{integrator}: {message}");
    }
}

/// A12: over 1000 orbits the energy error of a symplectic method is as large in the last ten as in the first ten; RK4
/// loses the same share with every orbit.
#[test]
fn energy_of_an_orbit_is_bounded_for_symplectic_methods_and_drifts_for_rk4() {
    const PER_ORBIT: u32 = 256;
    let h = std::f64::consts::TAU / f64::from(PER_ORBIT);
    for &integrator in Integrator::ALL {
        let mut world = world(&named("a12_kepler_e05"), integrator);
        let start = energy(world.as_ref());
        let mut largest = [0.0f64; 3];
        for orbit in 0..1000 {
            for _ in 0..PER_ORBIT {
                world.step(h).unwrap();
                let off = (energy(world.as_ref()) / start - 1.0).abs();
                let spans = [orbit < 10, (495..505).contains(&orbit), orbit >= 990];
                for (largest, inside) in largest.iter_mut().zip(spans) {
                    *largest = largest.max(if inside { off } else { 0.0 });
                }
            }
        }
        let [first, middle, last] = largest;
        println!("{integrator:20} {first:.2e}, {middle:.2e}, {last:.2e}");
        match integrator {
            Integrator::ExplicitEuler => assert!(last > 0.5, "the planet is gone: {largest:?}"),
            Integrator::Rk4 => {
                assert!((last / middle - 2.0).abs() < 0.1, "a steady drift: {largest:?}");
                assert!(first < last / 50.0, "{largest:?}");
            }
            _ => assert!(last < 1.05 * first && middle < 1.05 * first, "{integrator}: {largest:?}"),
        }
    }
}

/// A8: a world that goes on with other settings goes on in the middle of the swing, and substeps see the time they are
/// at: both keep to the closed form.
#[test]
fn a_drive_goes_on_through_substeps_and_a_change_of_settings() {
    let scene = named("a08_resonance");
    let mut world = world(&scene, Integrator::Rk4);
    let mut settings = *world.settings();
    let mut worst = 0.0f64;
    for step in 1..=960 {
        if step % 100 == 0 {
            settings.substeps = 1 + step / 100 % 4;
            settings.skips = if step % 200 == 0 { Skips::NONE } else { Skips::ALL };
            world = world.with_settings(settings).unwrap();
        }
        world.step(1.0 / 240.0).unwrap();
        let exact = cases::exact(&scene, f64::from(step) / 240.0).unwrap()[0].position[0];
        worst = worst.max((world.states()[0].position[0] - exact).abs());
    }
    println!("off by {worst:.1e} m");
    assert!(worst < 1e-9, "{worst:e}");
}

/// A14: by the reference, and by RK4 in the engine, the satellite is back where it began with the velocity it had.
#[test]
fn arenstorfs_orbit_closes() {
    let problem = converged("a14_arenstorf").unwrap();
    let start = (problem.start)();
    let end = ode::extrapolated(&problem.slope, &start, ARENSTORF_PERIOD_SECS, 40_000);
    let off = end.iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("reference closes to {off:.1e}");
    assert!(off < 1e-9, "{off:e}");

    let steps = 1 << 20;
    let mut world = world(&named("a14_arenstorf"), Integrator::Rk4);
    for _ in 0..steps {
        world.step(ARENSTORF_PERIOD_SECS / f64::from(steps)).unwrap();
    }
    let body = world.states()[0];
    let state = [body.position, body.velocity].concat();
    let off = state.iter().zip(&start).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!("rk4 closes to {off:.1e}");
    assert!(off < 1e-7, "{off:e}");
}

/// Jacobi's integral is what the energy sum of the turning frame's fields is: the Coriolis force does no work.
#[test]
fn jacobis_integral_is_the_energy_of_the_turning_frame() {
    let mut world = world(&named("a14_arenstorf"), Integrator::Rk4);
    let start = energy(world.as_ref());
    for _ in 0..100_000 {
        world.step(1e-5).unwrap();
    }
    assert!((energy(world.as_ref()) - start).abs() < 1e-10, "{start}");
}

/// A15: seven bodies keep their momentum to round-off with every scheme, and their energy to the scheme's error.
#[test]
fn seven_bodies_keep_momentum_and_energy() {
    let scene = named("a15_pleiades");
    for &integrator in Integrator::ALL {
        let off = [1e-4, 5e-5].map(|h: f64| {
            let mut world = world(&scene, integrator);
            let start = (world.invariants(), energy(world.as_ref()));
            for _ in 0..(3.0 / h) as u32 {
                world.step(h).unwrap();
            }
            let end = world.invariants();
            let momentum = (0..2).map(|k| (end.momentum[k] - start.0.momentum[k]).abs()).fold(0.0, f64::max);
            assert!(momentum < 1e-10, "{integrator}: {momentum:e} kg·m/s");
            (energy(world.as_ref()) / start.1 - 1.0).abs()
        });
        println!("{integrator:20} energy off by {:.1e}, {:.1e}", off[0], off[1]);
        let most = if integrator == Integrator::ExplicitEuler { 1.0 } else { 1e-3 };
        assert!(off[1] < most && off[1] < off[0].max(1e-12), "{integrator}: {off:?}");
    }
}

/// A15: the energy of a star of Hénon and Heiles over 1000 s, in which nothing drifts that is symplectic.
#[test]
fn a_star_of_henon_and_heiles_keeps_its_energy() {
    for &integrator in Integrator::ALL {
        let mut world = world(&named("a15_henon_heiles"), integrator);
        let start = energy(world.as_ref());
        let mut halves = [0.0f64; 2];
        for step in 0..20_000 {
            if world.step(0.05).is_err() {
                halves = [0.0, f64::INFINITY];
                break;
            }
            let half = &mut halves[step / 10_000];
            *half = half.max((energy(world.as_ref()) / start - 1.0).abs());
        }
        println!("{integrator:20} {:.1e}, {:.1e}", halves[0], halves[1]);
        let symplectic = !matches!(integrator, Integrator::ExplicitEuler | Integrator::Rk4);
        assert_eq!(halves[1] < 1.1 * halves[0], symplectic, "{integrator}: {halves:?}");
    }
}
