//! The watchdog: what it stops, what it says, what it leaves alone, and what it keeps.

use lamina2d::force::{Forces, Spring};
use lamina2d::measure::Stage;
use lamina2d::scene::{BodySpec, ShapeSpec, by_name};
use lamina2d::settings::{Broad, Integrator, Precision, Settings, SettingsError};
use lamina2d::simulation::Simulation;
use lamina2d::world::{StepError, WATCHED_EVERY};

use crate::shared_motion::{DT_SECS, at_every_width, at_widths, disc, scatter, scene_of, start};

/// Steps until one is refused, at most so many.
fn until_refused(world: &mut dyn Simulation, steps: u64) -> Option<StepError> {
    (0..steps).find_map(|_| world.step(DT_SECS).err())
}

#[test]
fn a_runaway_is_stopped_at_its_first_step_beyond_the_bound() {
    let scene = scene_of(vec![disc([50.0, 0.0]), disc([0.0, 0.0])], Forces::gravity());
    for settings in at_every_width(Settings { max_speed: Some(5.0), ..Settings::default() }) {
        let mut world = start(&scene, settings);
        let id = world.body(2).expect("the second disc").id;
        world.apply_impulse(id, [0.0, -1.0 / world.body(2).expect("it").inv_mass], 0.0).expect("dynamic");
        let error = until_refused(world.as_mut(), 100).expect("falls ever faster");
        let StepError::Runaway { step, slot, speed, bound, stage } = error else { panic!("{error}") };
        // 1 m/s at first and 9.81/64 m/s more each step: the 27th is the first over 5.
        assert_eq!((step, slot, stage), (27, 2, Stage::Integrate));
        assert!(bound == 5.0 && (speed - (1.0 + 27.0 * 9.81 / 64.0)).abs() < 1e-4, "{speed}");
        assert_eq!(world.steps(), 27);
        let text = error.to_string();
        for word in ["step 27", "slot 2", "max-speed = 5", "integrate"] {
            assert!(text.contains(word), "{text}");
        }
    }
}

#[test]
fn a_speed_that_the_solver_made_is_laid_at_its_door() {
    // Two discs almost in one place, and a heavy one that hits a light one.
    let light = disc([0.0, 0.0]).surface(1.0, 0.0).mass(1e-3);
    let heavy = disc([-1.0, 0.0]).surface(1.0, 0.0).mass(1e3).moving([4.0, 0.0], 0.0);
    let scene = scene_of(vec![light, heavy], Forces::default());
    let mut world = start(&scene, Settings { max_speed: Some(6.0), ..Settings::default() });
    let error = until_refused(world.as_mut(), 60).expect("the light one leaves at nearly 8 m/s");
    let StepError::Runaway { slot, stage, .. } = error else { panic!("{error}") };
    assert_eq!((slot, stage), (1, Stage::Solve));
}

/// Squares of such speeds overflow in f32: each body then reaches for every other.
#[test]
fn bodies_faster_than_squares_can_be_end_in_an_error_or_not_but_in_no_panic() {
    for (speed, broad) in
        [1e16, 1e20, 1e30, 3e38].into_iter().flat_map(|v| Broad::ALL.iter().map(move |b| (v, *b)))
    {
        let one = |k: usize| {
            let shape = if k.is_multiple_of(3) { ShapeSpec::Box([0.5, 0.1]) } else { ShapeSpec::Circle(0.2) };
            let way = [scatter(k, 1) * speed, scatter(k, 2) * speed];
            BodySpec::new(shape, [0.3 * k as f64, 0.0]).moving(way, 0.0)
        };
        let scene = scene_of((0..19).map(one).collect(), Forces::gravity());
        for settings in at_widths(Settings { broad, ..Settings::default() }, Precision::F32) {
            let mut world = start(&scene, settings);
            match until_refused(world.as_mut(), 8) {
                None => assert!(world.invariants().kinetic_energy > 0.0),
                Some(error) => assert!(matches!(error, StepError::NonFinite { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn an_integrator_that_gains_energy_is_stopped_and_one_that_does_not_goes_on() {
    let spring = Some(Spring { anchor: [0.0; 2], stiffness: 4.0 });
    let scene = scene_of(vec![disc([1.0, 0.0]).mass(1.0)], Forces { spring, ..Forces::default() });
    for settings in at_every_width(Settings { max_gain: Some(0.2), substeps: 1, ..Settings::default() }) {
        let mut calm = start(&scene, settings);
        assert_eq!(until_refused(calm.as_mut(), 2000), None);
        let mut rising = start(&scene, Settings { integrator: Integrator::ExplicitEuler, ..settings });
        let error = until_refused(rising.as_mut(), 2000).expect("gains (hω)² of itself a step");
        let StepError::Gain { step, slot, gain, bound, stage, .. } = error else { panic!("{error}") };
        // E = 2 J·(1 + h²ω²)ⁿ passes 2.2 J after n = 97.6 steps.
        assert_eq!((step, slot, bound), (98_u64.next_multiple_of(WATCHED_EVERY), 1, 0.2));
        let exact = 2.0 * (1.0 + 4.0 * DT_SECS * DT_SECS).powf(step as f64) - 2.0;
        assert!((gain - exact).abs() < 1e-3, "{gain} {exact}");
        assert_eq!(stage, Stage::Integrate);
    }
}

#[test]
fn who_puts_energy_in_by_hand_begins_the_account_anew() {
    let scene = scene_of(vec![disc([0.0, 0.0]).mass(1.0)], Forces::default());
    let mut world = start(&scene, Settings { max_gain: Some(1e-3), ..Settings::default() });
    for _ in 0..5 {
        let id = world.body(1).expect("the disc").id;
        world.apply_impulse(id, [3.0, 0.0], 0.1).expect("dynamic");
        world.insert(&disc([0.0, 9.0 + world.steps() as f64]).moving([0.0, 7.0], 0.0)).expect("a disc");
        assert_eq!(until_refused(world.as_mut(), 4 * WATCHED_EVERY), None);
    }
}

#[test]
fn a_watched_world_has_the_same_bits_and_piles_that_settle_gain_nothing() {
    for name in ["all/150", "stack/10", "bridge/40"] {
        let scene = by_name(name, None, 1).expect("a named scene");
        let run = |settings| {
            let mut world = start(&scene, settings);
            for _ in 0..300 {
                world.step(1.0 / 60.0).expect("stays within bounds");
            }
            world.hash()
        };
        let watched = Settings { max_speed: Some(100.0), max_gain: Some(10.0), ..Settings::default() };
        assert_eq!(run(watched), run(Settings::default()), "{name}");
    }
}

#[test]
fn bounds_are_positive_numbers() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let speed = Settings { max_speed: Some(bad), ..Settings::default() };
        let gain = Settings { max_gain: Some(bad), ..Settings::default() };
        for (settings, wanted) in [(speed, "max-speed"), (gain, "max-gain")] {
            let Err(SettingsError::Bound { name, .. }) = settings.check() else { panic!("{bad}") };
            assert_eq!(name, wanted);
        }
    }
    // A bound beyond what a scalar can square is a bound none the less.
    let body = BodySpec::new(ShapeSpec::Circle(0.1), [0.0; 2]).moving([1e25, 0.0], 0.0);
    let scene = scene_of(vec![body], Forces::default());
    let mut world = start(&scene, Settings { max_speed: Some(1e26), ..Settings::default() });
    assert_eq!(world.step(1e-20), Ok(()));
}
