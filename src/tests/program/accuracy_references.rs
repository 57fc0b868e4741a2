//! The references of the laboratory: two independent methods agree a hundred times better than the best point that is
//! plotted against them.
//!
//! One is the library's extrapolated midpoint rule of order 16 with fixed steps, the other the Runge–Kutta method of
//! order 8 of Dormand and Prince with steps of its own choice, by the crate `ode_solvers`.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use lamina::accuracy::case::Reference;
use lamina::accuracy::{CASES, Case, Norm};
use lamina::cases;
use lamina::cases::smooth::{Problem, converged};
use lamina2d::scene::BodyKind;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{DVector, Dop853, System};

struct Slope(fn(&[f64], &mut [f64]));

impl System<f64, DVector<f64>> for Slope {
    fn system(&self, _: f64, y: &DVector<f64>, dy: &mut DVector<f64>) {
        (self.0)(y.as_slice(), dy.as_mut_slice());
    }
}

/// Centroids after each of `times`, by the other method.
fn by_others(problem: &Problem, times: &[f64]) -> Vec<Vec<[f64; 2]>> {
    let (mut state, mut now) = (DVector::from_vec((problem.start)()), 0.0);
    let mut to = |&time: &f64| {
        let slope = Slope(problem.slope);
        let mut method = Dop853::from_param(
            slope,
            now,
            time,
            time - now,
            state.clone(),
            1e-15,
            1e-15,
            0.9,
            0.0,
            0.333,
            6.0,
            time - now,
            0.0,
            1_000_000,
            u32::MAX,
            OutputType::Sparse,
        );
        method.integrate().unwrap();
        state = method.y_out().last().unwrap().clone();
        now = time;
        (problem.places)(state.as_slice())
    };
    times.iter().map(&mut to).collect()
}

fn apart(a: &[Vec<[f64; 2]>], b: &[Vec<[f64; 2]>]) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max)
}

fn hold(name: &str) {
    let case: &'static Case = CASES.iter().find(|case| case.name == name).unwrap();
    let problem = converged(case.scene).unwrap();
    let times = case.times();
    let [coarse, fine] = [1, 2].map(|refined| problem.course(&times, refined));
    let others = by_others(problem, &times);
    let Norm::Place(size) = case.norm else { panic!("{name} is compared by places") };
    let [halved, other] = [apart(&coarse, &fine), apart(&fine, &others)].map(|apart| apart / size);
    let Reference { floor, gate, .. } = case.reference(&case.scene().unwrap());
    println!("{name:20} half the step {halved:.1e}, other method {other:.1e}, plotted from {gate:.1e}");
    // The floor that is drawn covers both, nothing is plotted within a hundred times of it, and that is far below
    // the least error any table speaks of.
    assert!(halved <= floor && other <= floor && 100.0 * floor <= gate && gate < 1e-8, "{floor:e}");
}

#[test]
fn references_of_the_shot_agree() {
    hold("a04_quadratic_shot");
}

#[test]
fn references_of_the_double_pendulum_agree() {
    hold("a11_double_pendulum");
}

#[test]
fn references_of_arenstorfs_orbit_agree() {
    hold("a14_arenstorf");
}

#[test]
fn references_of_the_pleiades_agree() {
    hold("a15_pleiades");
}

#[test]
fn references_of_henon_and_heiles_agree() {
    hold("a15_henon_heiles");
}

/// Every case that is compared by places has a closed form or a converged reference, never both, and each begins where
/// the scene's bodies are.
#[test]
fn every_case_has_one_reference_that_begins_with_its_scene() {
    for case in CASES.iter().filter(|case| !case.is_contact()) {
        let scene = case.scene().unwrap();
        let start: Option<Vec<[f64; 2]>> =
            cases::exact(&scene, 0.0).map(|all| all.iter().map(|exact| exact.position).collect());
        let problem = converged(case.scene).map(|problem| (problem.places)(&(problem.start)()));
        assert!(start.is_none() || problem.is_none(), "{} has two", case.name);
        let start = start.or(problem).unwrap_or_else(|| panic!("{} has none", case.name));
        let movable = scene.bodies.iter().filter(|body| body.kind != BodyKind::Static);
        let placed: Vec<_> = movable.map(|body| body.position).collect();
        assert_eq!(placed.len(), start.len(), "{}", case.name);
        for (scene, reference) in placed.iter().zip(&start) {
            let off = (scene[0] - reference[0]).hypot(scene[1] - reference[1]);
            assert!(off < 1e-14, "{}: {off:e}", case.name);
        }
    }
}

/// The closed forms obey the law they solve: x″ by differences is the acceleration of the scene's own fields, checked
/// for the two that are not one formula copied from a book.
#[test]
fn closed_forms_of_springs_and_fields_satisfy_their_equations() {
    let course = |name: &str, t: f64| {
        let scene = cases::by_name(name, None, 1).unwrap();
        cases::exact(&scene, t).unwrap()[0].position
    };
    let d = 1e-4;
    for t in [0.3, 1.1, 1.9] {
        for (name, rate) in [("a13_circle", 3.0), ("a13_drift", 3.0)] {
            let [before, now, after] = [t - d, t, t + d].map(|t| course(name, t));
            let a: [f64; 2] = std::array::from_fn(|k| (after[k] - 2.0 * now[k] + before[k]) / (d * d));
            let v: [f64; 2] = std::array::from_fn(|k| (after[k] - before[k]) / (2.0 * d));
            let push = if name == "a13_drift" { 1.0 } else { 0.0 };
            assert!((a[0] - rate * v[1]).abs() < 1e-5 && (a[1] + rate * v[0] - push).abs() < 1e-5, "{name}");
        }
        let [before, now, after] = [t - d, t, t + d].map(|t| course("a07_overdamped", t)[0] - 1.0);
        let (a, v) = ((after - 2.0 * now + before) / (d * d), (after - before) / (2.0 * d));
        let square = (std::f64::consts::TAU * 5.0).powi(2);
        assert!((a + 1e4 * v + square * now).abs() < 1e-3 * square * now, "{a} {v} {now}");
    }
}
