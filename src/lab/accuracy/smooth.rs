//! The cases of table A: errors of integrators on smooth motion.

use std::f64::consts::TAU;

use lamina2d::settings::{Integrator, Solver};

use super::case::{Case, Expect, Failing, Method, Norm, Sweep};
use crate::cases::smooth::{ARENSTORF_PERIOD_SECS, STIFF_RATE};

use Expect::{AtLeast, AtMost, Exact, Limit, Order};

type Methods = [(Method, Expect); 6];

/// Every integrator with what is expected of it, in [`Integrator::ALL`]'s order.
const fn each(expect: [Expect; 6]) -> Methods {
    let mut all = [(Method::alone(Integrator::ExplicitEuler), expect[0]); 6];
    let mut k = 1;
    while k < 6 {
        all[k] = (Method::alone(Integrator::ALL[k]), expect[k]);
        k += 1;
    }
    all
}

// In the order of Integrator::ALL: EE, SE, VV, PV, RK4, Y4.

/// Constant force: Σd = 1 and Σd(1 − c) = ½ make every scheme with a ½h² exact.
const CONSTANT: Methods = each([Order(1.0), Order(1.0), Exact(4.0), Exact(4.0), Exact(4.0), Exact(4.0)]);
/// Forces of velocity: the leapfrogs kick by the velocity a step began with. Yoshida multiplies v by Π(1 + `d_k`hA),
/// whose h²A² term ½(1 − Σ`d_k`²) is ½ only if Σ`d_k`² = 0; it is 6.5: order 1, for "<2" in the table.
const OF_VELOCITY: Methods = each([Order(1.0), Order(1.0), Order(2.0), Order(1.0), Order(4.0), Order(1.0)]);
/// Forces of position, and of time, which a drift carries along like a position.
const OF_POSITION: Methods = each([Order(1.0), Order(1.0), Order(2.0), Order(2.0), Order(4.0), Order(4.0)]);
/// Spin is exact for all.
const SPIN: Methods = each([Exact(50.0); 6]);
const LIMITS: Methods = each([Limit; 6]);
/// The order of Kepler's orbits, but Euler's: near the periapsis of e = 0.9, and where it swings round the Moon, its
/// errors are as large as the orbit until steps are shorter than a sweep goes.
const STEEP: Methods = each([AtLeast(0.01), Order(1.0), Order(2.0), Order(2.0), Order(4.0), Order(4.0)]);
/// Coriolis's force is one of velocity.
const TURNING: Methods = each([AtLeast(0.01), AtLeast(0.01), Order(2.0), Order(1.0), Order(4.0), Order(1.0)]);
/// Energy over 1000 orbits at 256 steps each: bounded where a scheme is symplectic, whatever the time; RK4 loses a
/// little with every orbit, Euler gains until the planet is gone.
const ENERGY: Methods =
    each([AtLeast(0.5), AtMost(0.06), AtMost(2.5e-3), AtMost(1e-3), AtLeast(1e-5), AtMost(1e-5)]);
/// Angular momentum over 100 orbits: a kick towards the centre from the place it acts at leaves it alone, and so does
/// a drift; the stages of Runge and Kutta are neither.
const MOMENTUM: Methods =
    each([AtLeast(0.1), AtMost(1e-12), AtMost(1e-12), AtMost(1e-12), AtLeast(1e-11), AtMost(1e-12)]);
/// How far the apsis turns in 100 orbits: with h² for the leapfrogs, h⁴ for the others. Semi-implicit Euler is a
/// leapfrog seen from half a kick away: a turn of order 2 that grows with time, and an offset of order 1 that does not.
const APSIS: Methods = each([AtLeast(0.01), AtMost(0.02), Order(2.0), Order(2.0), Order(4.0), Order(4.0)]);
/// Bodies that pass within a hundredth of their distance. Semi-implicit Euler is as above between orders 1 and 2
/// (observed 1.23), RK4 between the 4 of its phase and the 5 of the energy it loses (4.38) until the reference's
/// own floor hides both: what is held is the error with the shortest step.
const ENCOUNTERS: Methods =
    each([AtLeast(0.01), AtMost(2e-4), Order(2.0), Order(2.0), AtMost(2e-9), Order(4.0)]);

const fn held(integrator: Integrator, solver: Solver, substeps: u32, expect: Expect) -> (Method, Expect) {
    (Method { integrator, solver: Some(solver), substeps, stiffness: None }, expect)
}

type Joined = [(Method, Expect); 8];

/// Bodies held by joints: every solver, and `soft`, the default, with the integrators that differ there; `euler` is
/// what is expected of the one of order 1.
const fn joined(expect: Expect, euler: Expect) -> Joined {
    [
        held(Integrator::VelocityVerlet, Solver::Impulse, 1, expect),
        held(Integrator::VelocityVerlet, Solver::Pgs, 1, expect),
        held(Integrator::VelocityVerlet, Solver::Xpbd, 1, expect),
        held(Integrator::VelocityVerlet, Solver::Avbd, 1, expect),
        held(Integrator::VelocityVerlet, Solver::Soft, 1, expect),
        held(Integrator::VelocityVerlet, Solver::Soft, 4, expect),
        held(Integrator::SemiImplicitEuler, Solver::Soft, 4, euler),
        held(Integrator::Rk4, Solver::Soft, 4, expect),
    ]
}

/// A joint's impulse is applied once per round: order 2 with the mean of old and new velocity, whatever the order of
/// the scheme beside it, and 1 with the new one.
const SWINGING: Joined = joined(Order(2.0), Order(1.0));
/// The length of a rod is held by the joint alone.
const HELD: Joined = joined(Order(2.0), Order(2.0));
/// c·h from 333 to 1.3: what is asked is that it stays where it belongs, at every step.
const OVERDAMPED: Joined = joined(AtMost(1e-4), AtMost(1e-4));

const SECONDS_2: Sweep = Sweep::Halvings { coarsest: 60, quick: 8, full: 8 };
/// Joints cost a hundred times as much.
const JOINTS: Sweep = Sweep::Halvings { coarsest: 60, quick: 5, full: 8 };

/// A case of 2 s from 30 to 7680 steps a second.
const fn place(
    [name, item, about]: [&'static str; 3],
    size_m: f64,
    methods: &'static [(Method, Expect)],
) -> Case {
    Case {
        name,
        item,
        about,
        scene: name,
        horizon_secs: 2.0,
        samples: 20,
        norm: Norm::Place(size_m),
        unit: "relative",
        sweep: SECONDS_2,
        methods,
    }
}

const fn jointed(case: Case) -> Case {
    Case { sweep: JOINTS, ..case }
}

/// A case over so many seconds, from `coarsest` steps on.
const fn over(case: Case, horizon_secs: f64, [coarsest, quick, full]: [u32; 3]) -> Case {
    Case { horizon_secs, samples: 16, sweep: Sweep::Halvings { coarsest, quick, full }, ..case }
}

/// Many orbits of e = 0.5, from 64 steps each on.
const fn orbits(
    [name, about]: [&'static str; 2],
    (count, halvings): (u32, u32),
    (norm, unit): (Norm, &'static str),
    methods: &'static Methods,
) -> Case {
    Case {
        name,
        item: "A12",
        about,
        scene: "a12_kepler_e05",
        horizon_secs: count as f64 * TAU,
        samples: 1,
        norm,
        unit,
        sweep: Sweep::Halvings { coarsest: 64 * count, quick: halvings, full: halvings },
        methods,
    }
}

pub(super) const CASES: &[Case] = &[
    place(["a01_gravity", "A1", "a throw under constant gravity"], 20.0, &CONSTANT),
    place(["a02_linear_drag", "A2", "a throw with linear drag in a wind"], 10.0, &OF_VELOCITY),
    place(["a03_quadratic_drop", "A3", "a drop with quadratic drag"], 10.0, &OF_VELOCITY),
    place(["a04_quadratic_shot", "A4", "a shot with quadratic drag"], 5.0, &OF_VELOCITY),
    place(["a05_oscillator", "A5", "an oscillator, hω = 0.1 to 0.0004"], 1.0, &OF_POSITION),
    Case {
        norm: Norm::Growth,
        unit: "times the start",
        sweep: Sweep::Limits {
            rate: STIFF_RATE,
            limits: [0.02, 2.0, 2.0, 2.0, 2.828_427_124_746_190_3, 1.573],
        },
        ..place(
            ["a06_stiff", "A6", "a stiff oscillator at 0.5 to 1.01 times its longest stable step"],
            1.0,
            &LIMITS,
        )
    },
    place(["a07_damped", "A7", "a damped oscillator"], 1.0, &OF_VELOCITY),
    jointed(place(["a07_overdamped", "A7", "a sprung joint with c = 10⁴/s"], 0.5, &OVERDAMPED)),
    place(["a08_resonance", "A8", "an oscillator pushed at its own frequency"], 0.3, &OF_POSITION),
    jointed(place(["a09_pendulum", "A9", "a pendulum on a rod, let go level"], 1.0, &SWINGING)),
    Case {
        scene: "a09_pendulum",
        norm: Norm::Length,
        unit: "m",
        ..jointed(place(["a09_length", "A9", "the length of the pendulum's rod"], 1.0, &HELD))
    },
    Case {
        scene: "a09_pendulum",
        norm: Norm::Energy(9.81),
        unit: "of mgL",
        ..jointed(place(["a09_energy", "A9", "the energy of the pendulum"], 1.0, &SWINGING))
    },
    jointed(place(["a10_rod", "A10", "a rod on a hinge, let go level"], 0.5, &SWINGING)),
    jointed(place(["a11_double_pendulum", "A11", "a double pendulum, let go level"], 2.0, &SWINGING)),
    over(place(["a12_kepler_e05", "A12", "an orbit of e = 0.5"], 1.0, &OF_POSITION), TAU, [128, 11, 11]),
    over(place(["a12_kepler_e09", "A12", "an orbit of e = 0.9"], 1.0, &STEEP), TAU, [512, 8, 11]),
    orbits(
        ["a12_energy", "energy over 1000 orbits of e = 0.5"],
        (1000, 2),
        (Norm::Energy(1.0), "relative energy"),
        &ENERGY,
    ),
    orbits(
        ["a12_momentum", "angular momentum over 100 orbits"],
        (100, 3),
        (Norm::Momentum, "relative momentum"),
        &MOMENTUM,
    ),
    orbits(["a12_apsis", "how far the apsis turns in 100 orbits"], (100, 6), (Norm::Apsis, "rad"), &APSIS),
    place(["a13_circle", "A13", "a charged particle goes round"], 1.0, &OF_VELOCITY),
    place(["a13_drift", "A13", "a charged particle drifts across two fields"], 1.0, &OF_VELOCITY),
    over(
        place(["a14_arenstorf", "A14", "an orbit between Earth and Moon that closes"], 1.0, &TURNING),
        ARENSTORF_PERIOD_SECS,
        [4096, 6, 9],
    ),
    over(
        place(["a15_pleiades", "A15", "seven bodies that attract each other"], 3.0, &ENCOUNTERS),
        3.0,
        [480, 6, 10],
    ),
    over(
        place(["a15_henon_heiles", "A15", "a star in a cubic potential"], 0.5, &OF_POSITION),
        20.0,
        [160, 6, 10],
    ),
    Case {
        horizon_secs: 1.0,
        norm: Norm::Turn,
        unit: "rad",
        sweep: Sweep::Halvings { coarsest: 60, quick: 7, full: 7 },
        ..place(["a16_spin", "A16", "bars that spin at 1 to 1000 rad/s"], 1.0, &SPIN)
    },
];

pub(super) const FAILING: &[Failing] = &[
    Failing {
        name: "a02_exponential",
        reason: "an update by e^(−kt), exact on linear drag, is not among the integrators: all six take drag as a \
                 force, to their own order",
    },
    Failing {
        name: "a07_stiff_drag",
        reason: "linear drag is a force: with c·h > 2 every scheme here leaves it and the run stops at a state that is \
                 not finite; only a sprung joint (a07_overdamped) stays finite at any c·h",
    },
];
