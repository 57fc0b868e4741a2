//! What is run: scenes, how long before and while the clock runs, and with which engines.

use lamina2d::scene::Scene;

use crate::engine::{Name, Setup};

/// Substeps and iterations of the sweeps.
const SWEEP: [u32; 5] = [1, 2, 4, 8, 16];
/// A minute of steps.
const MINUTE: usize = 3600;

/// Engines on one scene: each runs `before` on its own, then they take turns of `1 + steps` steps, the first of each
/// untimed, `windows` times.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// The scene, by its name.
    pub scene: String,
    /// Steps before the clock runs.
    pub before: usize,
    /// Turns of each engine.
    pub windows: usize,
    /// Timed steps of a turn.
    pub steps: usize,
    /// Who runs.
    pub setups: Vec<Setup>,
}

/// All engines as they come.
fn all() -> Vec<Setup> {
    Name::ALL.map(Setup::new).to_vec()
}

impl Group {
    fn new(scene: &str, before: usize, windows: usize, steps: usize) -> Self {
        Self { scene: scene.to_owned(), before, windows, steps, setups: all() }
    }

    /// Runs that take `total` steps altogether, the last `windows`·(1 + `steps`) of them in turns.
    fn within(scene: &str, total: usize, windows: usize, steps: usize) -> Self {
        Self::new(scene, total.saturating_sub(windows * (1 + steps)), windows, steps)
    }

    /// And the peers on two threads.
    fn two_threads(mut self) -> Self {
        let peers = [Name::Box2d, Name::Rapier2d];
        self.setups.extend(peers.map(|engine| Setup::new(engine).threads(2)));
        self
    }

    /// And all where bodies may fall asleep.
    fn asleep(mut self) -> Self {
        self.setups.extend(Name::ALL.map(|engine| Setup::new(engine).sleep()));
        self
    }

    /// All engines with each of [`SWEEP`], in place of four.
    fn sweep(mut self) -> Self {
        let others = self.setups.split_off(Name::ALL.len());
        self.setups = SWEEP.iter().flat_map(|&k| Name::ALL.map(|e| Setup::new(e).substeps(k))).collect();
        self.setups.extend(others);
        self
    }

    /// A scene of the library that no plan names: all its steps, the last half of them timed.
    pub fn of(scene: &Scene) -> Self {
        let total = scene.steps as usize;
        let windows = (total / 2).clamp(1, 10);
        let steps = (total / 2 / windows).saturating_sub(1).max(1);
        Self { scene: scene.name.clone(), ..Self::within("", total, windows, steps) }
    }

    /// Steps of each run, all told.
    pub fn total(&self) -> usize {
        self.before + self.windows * (1 + self.steps)
    }
}

/// Scenes with a closed form, with the steps they are drawn for.
const CASES: [(&str, usize); 9] = [
    ("spin", 600),
    ("pendulum", 600),
    ("slide", 120),
    ("incline", 180),
    ("roll", 180),
    ("slide_to_roll", 120),
    ("bounce", 240),
    ("head_on/100", 180),
    ("rod_hit", 60),
];

fn cases() -> impl Iterator<Item = Group> {
    CASES.into_iter().map(|(scene, total)| Group::within(scene, total, 4, 9).sweep())
}

/// Everything.
pub fn full() -> Vec<Group> {
    let mut groups: Vec<Group> = cases().collect();
    for mix in ["circles", "circles_polygons", "polygons", "all"] {
        groups.push(Group::new(&format!("{mix}/150"), 600, 24, 60));
        let thousand = Group::new(&format!("{mix}/1000"), 600, 12, 20);
        let large = Group::new(&format!("{mix}/10000"), 1800, 4, 15);
        match mix {
            "polygons" => groups.extend([thousand.two_threads().asleep().sweep(), large.two_threads()]),
            "all" => groups.extend([thousand.two_threads(), large.two_threads()]),
            _ => groups.extend([thousand, large]),
        }
    }
    groups.extend([
        Group::new("stack/10", 600, 10, 30).sweep(),
        Group::within("columns/20", MINUTE, 10, 30),
        Group::within("columns/40", MINUTE, 10, 30).sweep(),
        Group::within("columns/80", MINUTE, 10, 30),
        Group::within("heavy/100", MINUTE, 10, 30).sweep(),
        Group::within("heavy/1000", MINUTE, 10, 30),
        Group::new("pyramid/30", 600, 10, 20).sweep(),
        Group::new("pyramid/100", 600, 6, 15).two_threads().asleep(),
        Group::new("pyramids/100", 600, 6, 15).two_threads().asleep(),
        Group::within("tumbler/2000", 900, 10, 29).two_threads(),
        Group::within("spinner/2000", 900, 10, 29).two_threads(),
        Group::within("rain/1000", 600, 16, 29).two_threads(),
        Group::new("joint_grid/20", 600, 10, 30),
        Group::new("joint_grid/60", 600, 5, 15).two_threads(),
        Group::within("free_flight/100000", 60, 5, 5).two_threads(),
    ]);
    groups
}

/// A little of everything, in about a minute.
pub fn quick() -> Vec<Group> {
    vec![
        Group::within("pendulum", 600, 4, 9),
        Group::within("incline", 180, 4, 9).sweep(),
        Group::within("bounce", 240, 4, 9),
        Group::within("head_on/100", 180, 4, 9),
        Group::new("all/150", 600, 6, 30),
        Group::new("polygons/1000", 600, 4, 15).two_threads(),
        Group::new("stack/10", 600, 6, 20).sweep(),
        Group::within("columns/20", MINUTE, 6, 20),
        Group::within("heavy/100", MINUTE, 6, 20),
        Group::new("pyramid/30", 300, 6, 15).asleep(),
        Group::within("tumbler/500", 300, 6, 15),
        Group::new("joint_grid/10", 300, 6, 15),
        Group::within("free_flight/10000", 60, 4, 9),
    ]
}
