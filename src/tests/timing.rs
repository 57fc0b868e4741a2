//! Acceptance of timings: the thesis baseline's ratios and trends, and that scenes alike cost alike. `cargo test --release --test timing -- --nocapture --test-threads 1`

#[path = "shared/thesis.rs"]
mod shared_thesis;

use std::time::Instant;

use lamina::thesis::{ThesisIntegrator, ThesisWorld, Version};
use lamina2d::force::Forces;
use lamina2d::scene::named::scene;
use lamina2d::scene::{BodySpec, ShapeSpec};
use lamina2d::settings::Settings;
use lamina2d::simulation::simulate;
use shared_thesis::{MIXES, continued, mix, run, world_with};

/// A case of the timing table: a settled world and the times of its windows.
struct Case {
    label: String,
    world: ThesisWorld,
    window_ms: Vec<f64>,
}

impl Case {
    fn settled(
        name: &str,
        bodies: usize,
        integrator: ThesisIntegrator,
        version: Version,
        broad: bool,
    ) -> Self {
        let scene = mix(name, bodies);
        let mut world = world_with(&scene, integrator, version, true);
        run(&mut world, 600);
        if !broad {
            // The states are the same to the bit either way: settle fast, then measure slow.
            world = world_with(&continued(&scene, &world), integrator, version, false);
        }
        let label = format!("{version:?} {name}/{bodies} {integrator:?} broad {broad}");
        Self { label, world, window_ms: Vec::new() }
    }

    fn window(&mut self) {
        const STEPS: usize = 60;
        let start = Instant::now();
        run(&mut self.world, STEPS);
        self.window_ms.push(start.elapsed().as_secs_f64() * 1e3 / STEPS as f64);
    }

    /// The median, and the least for comparison: what lies between them is the machine's other work.
    fn median_and_least_ms(&self) -> [f64; 2] {
        let mut sorted = self.window_ms.clone();
        sorted.sort_by(f64::total_cmp);
        [sorted[sorted.len() / 2], sorted[0]]
    }
}

/// Median and least of each case. The windows of all cases run in turn, so that a slow moment of the machine
/// falls on all of them.
fn measured(mut cases: Vec<Case>, windows: usize) -> [Vec<f64>; 2] {
    for _ in 0..windows {
        for case in &mut cases {
            case.window();
        }
    }
    println!("case, median and least of {windows} windows, candidates, contacts");
    for case in &cases {
        let [median, least] = case.median_and_least_ms();
        let (candidates, contacts) = (case.world.candidates(), case.world.contacts());
        println!("{:50} {median:.4} ms {least:.4} ms {candidates:5} {contacts:4}", case.label);
    }
    [0, 1].map(|which| cases.iter().map(|case| case.median_and_least_ms()[which]).collect())
}

#[test]
fn timing_of_shapes_and_integrators_has_the_published_trend() {
    for version in Version::ALL {
        let cases = MIXES.iter().flat_map(|name| {
            ThesisIntegrator::ALL.map(|integrator| Case::settled(name, 150, integrator, version, true))
        });
        let [medians, least] = measured(cases.collect(), 15);
        for (what, ms) in [("medians", medians), ("least", least)] {
            let (circles, mixed, polygons) = (ms[0], ms[3], ms[6]);
            let range =
                |mix: &[f64]| mix.iter().copied().fold((f64::MAX, 0.0_f64), |r, t| (t.min(r.0), t.max(r.1)));
            let spread: Vec<f64> = ms.chunks(3).map(range).map(|(low, high)| high / low).collect();
            println!(
                "{version:?}, {what}: polygons/circles {:.2} (published 3.23), mixed {:.2} of the way (0.55), \
                 slowest/fastest integrator {spread:.3?} (up to 1.07)",
                polygons / circles,
                (mixed - circles) / (polygons - circles),
            );
            assert!(circles < mixed && mixed < polygons);
        }
    }
}

#[test]
fn timing_of_the_bounding_test_has_the_published_trend() {
    for version in Version::ALL {
        let cases = [60, 80, 100, 200].iter().flat_map(|&n| {
            [true, false].map(|broad| Case::settled("polygons", n, ThesisIntegrator::Euler, version, broad))
        });
        for (what, ms) in ["medians", "least"].iter().zip(measured(cases.collect(), 15)) {
            let ratios: Vec<f64> = ms.chunks(2).map(|on_off| on_off[1] / on_off[0]).collect();
            let slope = |from: f64, to: f64| (to / from).ln() / (200.0_f64 / 60.0).ln();
            println!(
                "{version:?}, {what}: off/on {ratios:.2?} (published 3.77 4.71 5.35 8.92), \
                 slope on {:.2} off {:.2} (1.19, 1.90)",
                slope(ms[0], ms[6]),
                slope(ms[1], ms[7]),
            );
            assert!(ratios[3] > ratios[0]);
        }
    }
}

/// The least time of a step over windows that alternate between scenes, ms.
fn least_ms(scenes: &[Vec<BodySpec>]) -> Vec<f64> {
    let begun = |bodies: &Vec<BodySpec>| {
        let scene = scene("cliff", bodies.clone(), Forces::default(), 60);
        simulate(&scene, Settings { dt_secs: 1.0 / 60.0, ..Settings::default() })
            .expect("a scene that can be run")
    };
    let mut worlds: Vec<_> = scenes.iter().map(begun).collect();
    let mut least = vec![f64::INFINITY; worlds.len()];
    for _ in 0..12 {
        for (world, least) in worlds.iter_mut().zip(&mut least) {
            let start = Instant::now();
            for _ in 0..20 {
                world.step(1.0 / 60.0).expect("stays finite");
            }
            *least = least.min(start.elapsed().as_secs_f64() * 1e3 / 20.0);
        }
    }
    println!("{least:.4?} ms");
    least
}

/// `count` bodies of a shape in a square, `apart` metres from each other, at up to 1 m/s.
fn flying(count: usize, apart: f64, shape: &ShapeSpec) -> Vec<BodySpec> {
    let side = (count as f64).sqrt().ceil() as usize;
    let body = |k: usize| {
        let at = [(k % side) as f64 * apart, (k / side) as f64 * apart];
        let turn = 2.4 * k as f64;
        BodySpec::new(shape.clone(), at).turned(turn).moving([turn.cos(), turn.sin()], 0.0).surface(1.0, 0.0)
    };
    (0..count).map(body).collect()
}

/// What a step costs has no cliffs: planks little longer than others, lines one way or the other, statics in a heap.
#[test]
fn neighbours_cost_alike() {
    // Of one area, and apart: what differs is their form.
    let planks = |aspect: f64| flying(1500, 3.0, &ShapeSpec::Box([0.4 * aspect.sqrt(), 0.4 / aspect.sqrt()]));
    let of_planks = least_ms(&[2.9, 3.1, 4.0, 5.0].map(planks));
    for pair in of_planks.windows(2) {
        assert!(pair[1] < 2.0 * pair[0], "{of_planks:?}");
    }
    let line = |way: [f64; 2]| {
        let disc = |k: usize| {
            let at = way.map(|way| way * 0.3 * k as f64);
            let speed = (1.7 * k as f64).sin();
            BodySpec::new(ShapeSpec::Circle(0.1), at)
                .moving(way.map(|way| way * speed), 0.0)
                .surface(1.0, 0.0)
        };
        (0..1500).map(disc).collect::<Vec<_>>()
    };
    let of_lines = least_ms(&[[1.0, 0.0], [0.0, 1.0]].map(line));
    assert!(of_lines[1] < 2.0 * of_lines[0] && of_lines[0] < 2.0 * of_lines[1], "{of_lines:?}");
    let heap = |count: usize| {
        let fixed = |k: usize| BodySpec::new(ShapeSpec::Box([0.5; 2]), [1e-3 * k as f64, 0.0]).fixed();
        let mut bodies: Vec<_> = (0..count).map(fixed).collect();
        bodies.push(BodySpec::new(ShapeSpec::Circle(0.5), [1000.0, 0.0]).moving([1.0, 0.0], 0.0));
        bodies
    };
    let of_heaps = least_ms(&[100, 1000].map(heap));
    assert!(of_heaps[1] < 12.0 * of_heaps[0], "{of_heaps:?}");
}
