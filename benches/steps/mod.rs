//! Whole steps of settled scenes.
//!
//! `group/scene/bodies/…/xLANES`. The steps are always the same: the first [`WINDOW_STEPS`] after the settled state,
//! one before them left out, in which a copy's memory grows.
//!
//! | group | what runs |
//! |---|---|
//! | `mixes` | the thesis's four mixes × integrators at 150, 1000 and 10,000, settled |
//! | `falling` | the mixes at 150 in their second second: contacts come and go |
//! | `free_flight` | circles that never touch |
//! | `stack`, `pyramid` | boxes at rest on each other |
//! | `tumbler` | small boxes in a box that turns |
//! | `sleeping` | piles asleep |
//! | `solvers` | each solver, from the state in which `soft` settled |
//! | `jointed` | a net, a chain, a bridge |
//! | `skips` | each skip on and off; `exact` all that change no bit, on and off |
//! | `checks` | the watchdog on and off, positions in f64 and in f32 |
//! | `broad_on_off` | polygons with the broad phase of `auto` and with all pairs in the narrow phase |

mod skips;

use lamina2d::internals::as_simulation;
use lamina2d::scene::mixes::Mix;
use lamina2d::settings::{Broad, Integrator, Precision, Settings, Skips, Solver};
use lamina2d::simulation::Simulation;

use crate::common::{Answer, DT_SECS, SETTLE_STEPS, Settled};

/// Steps from the settled state on that are measured, and after which answers are compared.
pub(crate) const WINDOW_STEPS: u64 = 20;

/// Is something touching after the window?
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touch {
    /// There are contacts.
    Always,
    /// There is none.
    Never,
}

/// A scene at one state, stepped with some settings at some widths.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// `group/scene/bodies/…`, to which a width is added.
    pub(crate) name: String,
    /// Cases that share it must be in the same state after the window.
    pub(crate) alike: String,
    /// Bodies that move.
    pub(crate) bodies: u64,
    /// The widths it is measured at.
    pub(crate) lanes: &'static [usize],
    /// What its answer must be.
    pub(crate) touch: Touch,
    scene: String,
    /// Steps with default settings.
    settle_steps: usize,
    /// Steps with its own settings after those.
    further_steps: usize,
    settings: Settings,
}

impl Case {
    fn new(name: &str, scene: &str, bodies: u64, settle_steps: usize) -> Self {
        Self {
            name: name.to_owned(),
            alike: name.to_owned(),
            bodies,
            lanes: &[8, 1],
            touch: Touch::Always,
            scene: scene.to_owned(),
            settle_steps,
            further_steps: 0,
            settings: Settings::default(),
        }
    }

    fn with(self, settings: Settings) -> Self {
        Self { settings, ..self }
    }

    /// The name at a width.
    pub(crate) fn at(&self, lanes: usize) -> String {
        format!("{}/x{lanes}", self.name)
    }

    /// The state from which steps are measured.
    pub(crate) fn start(&self, settled: &Settled, lanes: usize) -> Box<dyn Simulation> {
        let settled = settled.get(&self.scene, self.settle_steps);
        let world = as_simulation(&settled);
        let settings = Settings { lanes, ..self.settings };
        let mut world = world.with_settings(settings).expect("settings that run");
        (0..self.further_steps).for_each(|_| step(world.as_mut()));
        world
    }
}

/// Steps once.
pub(crate) fn step(world: &mut dyn Simulation) {
    world.step(DT_SECS).expect("a scene that stays finite");
}

/// Contacts of the last step and hash of the state.
///
/// # Panics
/// If there are contacts where there should be none, or none where there should be.
pub(crate) fn answer(name: &str, world: &dyn Simulation, touch: Touch) -> Answer {
    let answer = Answer { count: world.counts().contacts, hash: world.hash() };
    assert_eq!(answer.count > 0, touch == Touch::Always, "{name}: {} contacts", answer.count);
    answer
}

/// All cases.
pub(crate) fn all() -> Vec<Case> {
    let mut cases = mixes();
    cases.extend(piles());
    cases.extend(solvers());
    cases.extend(jointed());
    cases.extend(skips::cases());
    cases.extend(checks());
    cases.extend(broad_on_off());
    cases
}

fn mixes() -> Vec<Case> {
    let mut cases = Vec::new();
    for bodies in [150, 1000, 10_000] {
        for mix in Mix::ALL {
            for &integrator in Integrator::ALL {
                let scene = format!("{}/{bodies}", mix.name());
                let case = Case::new(&format!("mixes/{scene}/{integrator}"), &scene, bodies, SETTLE_STEPS);
                // Width tells the same whatever the scheme: with the default one, and not where steps are long.
                let both =
                    integrator == Integrator::VelocityVerlet && (bodies < 10_000 || mix == Mix::Polygons);
                let lanes: &[usize] = if both { &[8, 1] } else { &[8] };
                cases.push(Case { lanes, ..case.with(Settings { integrator, ..Settings::default() }) });
            }
        }
    }
    let falling = Mix::ALL.into_iter().map(|mix| {
        let scene = format!("{}/150", mix.name());
        Case::new(&format!("falling/{scene}"), &scene, 150, 90)
    });
    cases.extend(falling);
    cases
}

fn piles() -> Vec<Case> {
    let flight = |bodies: u64| {
        let scene = format!("free_flight/{bodies}");
        Case { touch: Touch::Never, ..Case::new(&scene, &scene, bodies, 0) }
    };
    let asleep = |scene: &str, bodies: u64| {
        let settings = Settings { sleep: true, ..Settings::default() };
        let case = Case::new(&format!("sleeping/{scene}"), scene, bodies, SETTLE_STEPS).with(settings);
        Case { further_steps: 300, ..case }
    };
    vec![
        flight(150),
        flight(100_000),
        Case::new("stack/10", "stack/10", 10, 300),
        Case::new("pyramid/10", "pyramid/10", 55, 300),
        Case::new("pyramid/40", "pyramid/40", 820, 300),
        Case::new("tumbler/100", "tumbler/100", 100, 120),
        Case::new("tumbler/2000", "tumbler/2000", 2000, 120),
        asleep("polygons/150", 150),
        asleep("polygons/1000", 1000),
    ]
}

fn solvers() -> Vec<Case> {
    let mut cases = Vec::new();
    for (scene, bodies, settle_steps) in
        [("polygons/150", 150, SETTLE_STEPS), ("polygons/1000", 1000, SETTLE_STEPS), ("pyramid/10", 55, 300)]
    {
        for &solver in Solver::ALL {
            // It goes ten times over bodies and contacts in its one substep.
            let substeps = if solver == Solver::Avbd { 1 } else { Settings::default().substeps };
            let settings = Settings { solver, substeps, ..Settings::default() };
            cases.push(
                Case::new(&format!("solvers/{scene}/{solver}"), scene, bodies, settle_steps).with(settings),
            );
        }
    }
    cases
}

fn jointed() -> Vec<Case> {
    let case = |scene: &str, bodies: u64| {
        // They swing: nothing but the bridge's planks may touch.
        Case { touch: Touch::Never, ..Case::new(&format!("jointed/{scene}"), scene, bodies, 60) }
    };
    vec![case("joint_grid/12", 142), case("joint_grid/32", 1022), case("chain/30", 30), case("bridge/40", 40)]
}

fn checks() -> Vec<Case> {
    let watched = Settings { max_speed: Some(1e3), max_gain: Some(1e6), ..Settings::default() };
    let finer = Settings { positions: Some(Precision::F64), ..Settings::default() };
    let case = |name: &str, settings: Settings| {
        Case::new(&format!("checks/{name}"), "polygons/150", 150, SETTLE_STEPS).with(settings)
    };
    let watchdog = [("on", watched), ("off", Settings::default())].map(|(state, settings)| Case {
        // It looks and changes nothing.
        alike: "checks/watchdog".to_owned(),
        ..case(&format!("watchdog/polygons/150/{state}"), settings)
    });
    let positions = [("f64", finer), ("f32", Settings::default())]
        .map(|(kind, settings)| case(&format!("positions/polygons/150/{kind}"), settings));
    watchdog.into_iter().chain(positions).collect()
}

fn broad_on_off() -> Vec<Case> {
    let mut cases = Vec::new();
    // The thesis's numbers of bodies.
    for bodies in [60, 80, 100, 200] {
        let scene = format!("polygons/{bodies}");
        for (name, broad) in [("on", Broad::Auto), ("off", Broad::Off)] {
            // Which pairs are listed decides when manifolds are reused; all other skips keep every bit.
            let settings = Settings { broad, skips: Skips::EXACT, ..Settings::default() };
            let alike = format!("broad_on_off/{scene}");
            let case = Case::new(&format!("{alike}/{name}"), &scene, bodies, SETTLE_STEPS).with(settings);
            cases.push(Case { alike, ..case });
        }
    }
    cases
}
