//! What lanes are worth: each stage's kernel alone, on the same settled bodies, at every width.

use std::time::Instant;

use serde::Serialize;

use lamina2d::body::Bodies;
use lamina2d::internals::{self, BroadPhase, Narrow, Plan, Workers};
use lamina2d::settings::{Broad, Integrator, Settings, Skips};

use crate::cases::by_name;
use crate::report::{Record, median};

/// One kernel at one width.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The kernel.
    pub kernel: &'static str,
    /// Numbers per vector.
    pub lanes: usize,
    /// What it ran on.
    pub scene: &'static str,
    /// Elements per call: pairs tested, pairs collided, bodies advanced.
    pub elements: usize,
    /// Median time per element, ns.
    pub ns_per_element: f64,
    /// Median of lanes 1 over this median.
    pub speed_up: f64,
}

impl Record for Row {
    const NAME: &'static str = "lanes";
    const TITLE: &'static str = "Lanes";
    const COMMAND: &'static str = "lamina report --only lanes";
    const NOTE: &'static str = "Each kernel alone on the same settled bodies; an element is a pair tested, a pair collided, a body advanced.";
    const HEADER: &'static [&'static str] =
        &["kernel", "scene", "lanes", "elements", "ns per element", "over 1 lane"];

    fn cells(&self) -> Vec<String> {
        vec![
            self.kernel.to_owned(),
            self.scene.to_owned(),
            self.lanes.to_string(),
            self.elements.to_string(),
            format!("{:.3}", self.ns_per_element),
            format!("{:.2}×", self.speed_up),
        ]
    }
}

/// A kernel, its scene, the bodies of that scene, and steps to settle them.
struct Case {
    kernel: &'static str,
    scene: &'static str,
    steps: usize,
}

const CASES: [Case; 7] = [
    Case { kernel: "broad brute", scene: "circles/1000", steps: 600 },
    Case { kernel: "broad grid", scene: "circles/1000", steps: 600 },
    Case { kernel: "circle-circle", scene: "circles/1000", steps: 600 },
    Case { kernel: "box-box", scene: "stack/200", steps: 1 },
    Case { kernel: "polygon-polygon (SAT)", scene: "polygons/1000", steps: 600 },
    Case { kernel: "integrate", scene: "free_flight/1000", steps: 1 },
    Case { kernel: "integrate rk4, stages", scene: "free_flight/1000", steps: 1 },
];

/// Times every kernel at widths 1, 4, 8 and 16, taking turns `repeats` times.
///
/// # Errors
/// A scene that cannot be run.
pub fn run(repeats: usize) -> anyhow::Result<Vec<Row>> {
    let mut rows = Vec::new();
    for case in CASES {
        let scene = by_name(case.scene, None, 1)?;
        let settled = internals::bodies_after(&scene, case.steps).map_err(anyhow::Error::from_boxed)?;
        let widths = Settings::widths(lamina2d::settings::Precision::F32);
        let mut kernels: Vec<_> =
            widths.iter().map(|&lanes| kernel(lanes, case.kernel, settled.clone())).collect();
        let mut samples = vec![Vec::new(); kernels.len()];
        let mut elements = 0;
        for _ in 0..repeats {
            for (kernel, samples) in kernels.iter_mut().zip(&mut samples) {
                let calls = 20;
                let start = Instant::now();
                for _ in 0..calls {
                    elements = kernel();
                }
                samples.push(start.elapsed().as_nanos() as f64 / f64::from(calls) / elements as f64);
            }
        }
        let medians: Vec<f64> = samples.iter().map(|s| median(s)).collect();
        for (&lanes, &ns) in widths.iter().zip(&medians) {
            let (kernel, scene) = (case.kernel, case.scene);
            rows.push(Row { kernel, lanes, scene, elements, ns_per_element: ns, speed_up: medians[0] / ns });
        }
    }
    Ok(rows)
}

/// A closure that runs the named kernel once and says how many elements it handled.
fn kernel(
    lanes: usize,
    name: &str,
    (bodies, pairs): (Bodies<f32>, Vec<[u32; 2]>),
) -> Box<dyn FnMut() -> usize> {
    match name {
        "broad brute" => broad(lanes, bodies, Broad::Brute),
        "broad grid" => broad(lanes, bodies, Broad::Grid),
        "integrate" => advance(lanes, bodies, Integrator::SemiImplicitEuler),
        "integrate rk4, stages" => advance(lanes, bodies, Integrator::Rk4),
        _ => narrow(lanes, bodies, pairs, name),
    }
}

fn broad(lanes: usize, bodies: Bodies<f32>, method: Broad) -> Box<dyn FnMut() -> usize> {
    let mut broad = BroadPhase::default();
    // What one lane would test: each body against all later ones, or, with a grid, its candidates.
    let all = bodies.live() * (bodies.live() - 1) / 2;
    Box::new(move || {
        let counts = internals::find_at(lanes, &mut broad, &bodies, method, 0.0);
        if method == Broad::Brute { all } else { counts.candidates }
    })
}

fn narrow(
    lanes: usize,
    mut bodies: Bodies<f32>,
    mut pairs: Vec<[u32; 2]>,
    name: &str,
) -> Box<dyn FnMut() -> usize> {
    bodies.refresh_polygons();
    // Only pairs of the kernel's own forms.
    let form = if name == "circle-circle" {
        lamina2d::body::Form::Circle
    } else if name == "box-box" {
        lamina2d::body::Form::Box
    } else {
        lamina2d::body::Form::Polygon
    };
    pairs.retain(|pair| pair.iter().all(|&slot| bodies.form(slot as usize) == form));
    let mut narrow = Narrow::default();
    // The kernel alone: pairs are dealt into buckets once, as they are while a list serves.
    internals::run_at(lanes, &mut narrow, &bodies, &pairs, 0.0);
    Box::new(move || {
        internals::collide_at(lanes, &mut narrow, &bodies);
        std::hint::black_box(&narrow.manifolds);
        pairs.len()
    })
}

fn advance(lanes: usize, mut bodies: Bodies<f32>, integrator: Integrator) -> Box<dyn FnMut() -> usize> {
    let fields = lamina2d::force::Forces::gravity().fields();
    Box::new(move || {
        let plan = Plan {
            integrator,
            fields: &fields,
            h_secs: 1e-3,
            since_secs: 0.0,
            substeps: 1,
            skips: Skips::NONE,
            moving: false,
            carries: false,
            workers: &Workers::ALONE,
        };
        internals::fly_at(lanes, &plan, &mut bodies);
        bodies.live()
    })
}
