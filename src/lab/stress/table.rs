//! Table T: what must hold of each.

use lamina2d::internals::PUSH_CAP;
use lamina2d::scene::ShapeSpec;
use lamina2d::settings::Precision;
use lamina2d::simulation::Simulation;

use super::case::{Case, Check, Own, Parameter, Worse};
use super::own;
use super::seen::Seen;
use crate::cases::stress as scenes;

const fn raised(name: &'static str, unit: &'static str, value: f64, range: [f64; 2]) -> Parameter {
    Parameter { name, unit, value, range, worse: Worse::Larger, whole: false }
}

const fn counted(name: &'static str, value: f64, range: [f64; 2]) -> Parameter {
    Parameter { name, unit: "", value, range, worse: Worse::Larger, whole: true }
}

const fn lowered(name: &'static str, unit: &'static str, value: f64, range: [f64; 2]) -> Parameter {
    Parameter { name, unit, value, range, worse: Worse::Smaller, whole: false }
}

const fn case(
    [name, item, about]: [&'static str; 3],
    build: fn(f64) -> lamina2d::scene::Scene,
    parameter: Parameter,
    secs: [f64; 2],
    checks: &'static [Check],
) -> Case {
    Case {
        name,
        item,
        about,
        parameter,
        secs,
        build,
        deed: None,
        pace: None,
        checks,
        own: None,
        positions: None,
        missed: "",
    }
}

const fn beside(own: Own, case: Case) -> Case {
    Case { own: Some(own), ..case }
}

const fn at_most(what: &'static str, most: f64, of: fn(&Seen) -> f64) -> Check {
    Check { what, most, of }
}

const STANDS: Check = at_most("farthest m", 0.1, Seen::farthest);
const DRIFTS: Check = at_most("drift m", 0.1, |seen| seen.metrics.drift);
const STILL: Check = at_most("jit m/s", 1e-4, |seen| seen.metrics.jit);
const NOT_SUNK: Check = at_most("sunk m", 0.5, Seen::sunk);
const NONE_OUT: Check = at_most("escaped", 0.0, |seen| seen.metrics.escaped as f64);
const NO_GAIN: Check = at_most("energy gain over the first", 1e-6, gain);

/// Energy gained over that at the start.
fn gain(seen: &Seen) -> f64 {
    let [start, _] = seen.sums;
    seen.metrics.energy_gain / (start.kinetic_energy + start.potential_energy).abs()
}

/// The farthest a box has moved of the columns that statics let stand.
fn standing(seen: &Seen) -> f64 {
    let moved: Vec<_> = seen.moved().collect();
    let columns = moved.chunks(scenes::TILTED_BOXES).filter(|column| {
        let lean = column[1].0.position[0] - column[0].0.position[0];
        lean * (scenes::TILTED_BOXES as f64) / 2.0 < 0.499
    });
    let far = |(a, b): &(&lamina2d::simulation::BodyState, &lamina2d::simulation::BodyState)| {
        (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1])
    };
    columns.flatten().map(far).fold(0.0, f64::max)
}

/// What the fastest body was faster than the cap on pushes lets it be, over that cap.
fn over_cap(seen: &Seen) -> f64 {
    let radius = |shape: &ShapeSpec| match shape {
        ShapeSpec::Circle(radius) => *radius,
        ShapeSpec::Box([x, y]) => x.hypot(*y),
        ShapeSpec::Polygon(outline) => outline.iter().map(|[x, y]| x.hypot(*y)).fold(0.0, f64::max),
    };
    let movable = seen.scene.bodies.iter().filter(|body| body.kind == lamina2d::scene::BodyKind::Dynamic);
    let radii: Vec<f64> = movable.map(|body| radius(&body.shape)).collect();
    let cap = PUSH_CAP * crate::reference::chaos::percentile(&radii, 50) / seen.scene.dt_secs;
    seen.fastest / cap
}

/// How far any projectile, each before its wall, is beyond the middle of it, metres.
fn through(seen: &Seen) -> f64 {
    let pairs = seen.end.chunks(2).map(|pair| pair[0].position[0] - pair[1].position[0]);
    pairs.fold(f64::MIN, f64::max)
}

/// How far the keystone, the ninth of the wedges, has come down, metres.
fn keystone(seen: &Seen) -> f64 {
    seen.moved().nth(8).map_or(f64::NAN, |(start, end)| start.position[1] - end.position[1])
}

/// The joints' gaps over the length of the chain.
fn stretched(seen: &Seen) -> f64 {
    seen.stretch / (0.5 * (seen.scene.bodies.len() as f64 - 2.0))
}

/// Takes away the last body after two seconds.
fn unload(world: &mut dyn Simulation, step: u64) -> anyhow::Result<()> {
    if step == 120 {
        let slot = world.bodies();
        let body = world.body(slot).ok_or_else(|| anyhow::anyhow!("no body in slot {slot}"))?;
        world.remove(body.id)?;
    }
    Ok(())
}

/// Every case of table T.
pub const CASES: &[Case] = &[
    case(
        ["t01_column", "T1", "a column of boxes 1 cm off stands and is still"],
        scenes::column,
        counted("boxes", 15.0, [2.0, 128.0]),
        [60.0, 10.0],
        &[STANDS, STILL],
    ),
    case(
        ["t02_columns", "T2", "a tall column stands"],
        scenes::column,
        counted("boxes", 80.0, [10.0, 640.0]),
        [60.0, 10.0],
        &[NOT_SUNK],
    ),
    Case {
        missed: "as contacts begin to sag, the nine boxes on the lowest of a column that leans by 9 cm a box tip with 0.03 rad/s, \
                 0.011 J/kg, where 0.003 J/kg carry them over its edge; with 16 substeps, which sag a quarter, all stand that \
                 statics let stand",
        ..case(
            ["t03_tilted", "T3", "leaning columns stand that statics let stand"],
            scenes::tilted,
            raised("most lean", "m", 0.2, [0.05, 0.2]),
            [60.0, 10.0],
            &[at_most("farthest of those m", 0.1, standing)],
        )
    },
    case(
        ["t04_pyramid", "T4", "a pyramid does not drift"],
        scenes::pyramid,
        counted("base", 100.0, [10.0, 100.0]),
        [60.0, 10.0],
        &[DRIFTS, NOT_SUNK],
    ),
    case(
        ["t05_crowned", "T5", "a pyramid with a dense top"],
        scenes::crowned,
        raised("density", "kg/m²", 300.0, [1.0, 1e6]),
        [20.0, 10.0],
        &[at_most("pen m", 0.02, |seen| seen.metrics.pen), NOT_SUNK],
    ),
    case(
        ["t06_feet", "T6", "a large box on two small ones"],
        scenes::footed,
        raised("side", "m", 20.0, [2.0, 200.0]),
        [60.0, 10.0],
        &[at_most("pen m", 0.05, |seen| seen.metrics.pen), NOT_SUNK],
    ),
    case(
        ["t07_heavy", "T7", "a heavy box on a light one"],
        scenes::heavy,
        raised("ratio", "", 100.0, [1.0, 1e6]),
        [60.0, 10.0],
        &[at_most("pen m", 0.01, |seen| seen.metrics.pen), NOT_SUNK],
    ),
    case(
        ["t08_sizes", "T8", "each box twice the size of the one below"],
        scenes::sizes,
        counted("boxes", 6.0, [2.0, 12.0]),
        [60.0, 10.0],
        &[NOT_SUNK],
    ),
    beside(
        own::TIGHTER,
        case(
            ["t09_chain", "T9", "four times the substeps hold a heavy chain four times as tight"],
            |ratio| scenes::heavy_chain(17, ratio),
            raised("ratio", "", 1000.0, [1.0, 1e6]),
            [10.0, 4.0],
            &[],
        ),
    ),
    case(
        ["t10_chain", "T10", "a long chain with a weight keeps its length and swings"],
        |ratio| scenes::heavy_chain(50, ratio),
        raised("ratio", "", 5e4, [1.0, 1e6]),
        [10.0, 10.0],
        &[
            at_most("stretch over the length", 0.01, stretched),
            at_most("s/m of the fastest", 1.0, |seen| 1.0 / seen.fastest),
        ],
    ),
    case(
        ["t12_cards", "T12", "a house of cards stands"],
        scenes::card_house,
        counted("levels", 4.0, [1.0, 12.0]),
        [60.0, 10.0],
        &[at_most("farthest m", 0.05, Seen::farthest)],
    ),
    Case {
        missed: "17 joints that sag by up to 0.6 mm add up; the drop goes with the inverse square of the substeps, 1.2 mm at 16",
        ..case(
            ["t13_arch", "T13", "an arch carries boxes"],
            scenes::arched,
            counted("boxes", 4.0, [1.0, 64.0]),
            [60.0, 10.0],
            &[at_most("keystone's drop m", 1e-3, keystone)],
        )
    },
    case(
        ["t14_overlap", "T14", "what begins in each other parts gently"],
        scenes::sunk,
        raised("share", "", 0.25, [0.05, 0.9]),
        [10.0, 5.0],
        &[at_most("fastest over the push cap", 1.0, over_cap)],
    ),
    case(
        ["t14_point", "T14", "bodies at one point part gently"],
        scenes::dense,
        counted("bodies", 20.0, [2.0, 200.0]),
        [10.0, 5.0],
        &[at_most("fastest over the push cap", 1.0, over_cap)],
    ),
    case(
        ["t15_confined", "T15", "packed discs stay in their box"],
        scenes::confined,
        raised("radius", "m", 0.39, [0.3, 0.5]),
        [60.0, 10.0],
        &[NONE_OUT, at_most("jit m/s", 0.5, |seen| seen.metrics.jit)],
    ),
    Case {
        deed: Some(unload),
        ..case(
            ["t16_removed", "T16", "a weight is taken away, and what carried it does not leap"],
            scenes::laden,
            raised("ratio", "", 100.0, [1.0, 1e5]),
            [10.0, 5.0],
            &[at_most("rise m", 0.01, |seen| seen.highest)],
        )
    },
    case(
        ["t17_pulled", "T17", "discs pulled to the centre do not explode"],
        scenes::pulled,
        counted("bodies", 400.0, [10.0, 1000.0]),
        [30.0, 10.0],
        &[at_most("energy gain over the first", 1e-3, gain)],
    ),
    case(
        ["t18_bullet", "T18", "a bullet stops at a thin wall"],
        scenes::fired,
        raised("speed", "m/s", 200.0, [10.0, 1e5]),
        [1.0, 1.0],
        &[at_most("beyond the wall m", 0.0, through)],
    ),
    case(
        ["t19_bullets", "T19", "wedge, sliver and plate stop at thin walls"],
        scenes::flung,
        raised("share of 200, 100, 100 m/s", "", 1.0, [0.1, 1000.0]),
        [1.0, 1.0],
        &[at_most("beyond the wall m", 0.0, through)],
    ),
    case(
        ["t20_spinner", "T20", "stirred bodies stay in their box"],
        |count| scenes::stirred(count, 1),
        counted("bodies", 2000.0, [100.0, 4000.0]),
        [50.0, 5.0],
        &[at_most("escaped", 2.0, |seen| seen.metrics.escaped as f64)],
    ),
    beside(
        own::ULPS,
        case(
            ["t21_far", "T21", "a pyramid far from the origin does not drift"],
            scenes::far,
            raised("distance", "m", 1e5, [100.0, 1e8]),
            [10.0, 5.0],
            &[],
        ),
    ),
    Case {
        positions: Some(Precision::F64),
        ..case(
            ["t21_fine", "T21", "a pyramid very far from the origin does not drift, with positions in f64"],
            scenes::far,
            raised("distance", "m", 1e7, [1e4, 1e12]),
            [10.0, 5.0],
            &[at_most("drift m", 1e-3, |seen| seen.metrics.drift)],
        )
    },
    case(
        ["t22_wide", "T22", "a column on a floor of 2000 km"],
        scenes::wide,
        raised("half-width", "m", 1e6, [100.0, 1e9]),
        [8.4, 8.4],
        &[STANDS, at_most("jit m/s", 0.1, |seen| seen.metrics.jit)],
    ),
    beside(
        own::SIMILAR,
        case(
            ["t23_tiny", "T23", "a small pyramid does what a large one does, in its own time"],
            scenes::scaled,
            lowered("size", "m", 0.05, [1e-3, 1.0]),
            [4.0, 2.0],
            &[],
        ),
    ),
    case(
        ["t24_pile", "T24", "a pile at rest for a million steps"],
        scenes::pyramid,
        counted("base", 10.0, [2.0, 80.0]),
        [1e6 / 60.0, 60.0],
        &[NO_GAIN, STANDS],
    ),
    case(
        ["t24_net", "T24", "a net of joints for a million steps"],
        scenes::net,
        counted("side", 8.0, [2.0, 40.0]),
        [1e6 / 60.0, 60.0],
        &[NO_GAIN],
    ),
    beside(
        own::CHURN,
        case(
            ["t24_churn", "T24", "bodies come into a tumbler and go for a million steps"],
            scenes::tumbling,
            counted("bodies at first", 150.0, [150.0, 600.0]),
            [1e6 / 60.0, 60.0],
            &[],
        ),
    ),
    case(
        ["t25_spin", "T25", "a long box that turns fast"],
        scenes::spun,
        raised("rate", "rad/s", 1000.0, [10.0, 1e6]),
        [10.0, 5.0],
        &[],
    ),
    Case {
        pace: Some(own::uneven),
        ..case(
            ["t26_steps", "T26", "steps that change by up to four times, and of 1/10 s"],
            scenes::column,
            counted("boxes", 10.0, [2.0, 40.0]),
            [20.0, 10.0],
            &[at_most("fastest over the push cap", 1.0, over_cap), NOT_SUNK],
        )
    },
    beside(
        own::STRAIGHT,
        case(
            ["t27_drift", "T27", "bodies drift straight for 100,000 steps"],
            scenes::drifting,
            raised("speed", "m/s", 1.0, [0.1, 1e3]),
            [1e5 / 60.0, 60.0],
            &[],
        ),
    ),
    beside(
        own::REFUSED,
        case(
            ["t28_shapes", "T28", "what is hardly a shape is refused or stays finite"],
            |_| scenes::column(1.0),
            lowered("share of thicknesses", "", 1.0, [1e-6, 1.0]),
            [1.0, 1.0],
            &[],
        ),
    ),
];
