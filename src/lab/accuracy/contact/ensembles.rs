//! What holds of many bodies together, and of energy.

use lamina2d::scene::similar::enlarged;
use lamina2d::simulation::BodyState;

use super::trial::{Trial, relative, worst};
use crate::cases::contact::{GAS, GRAVITY, rocking_block, rocking_ratio};

/// Energy of a body above height 0 over its mass, J/kg; `square` is its radius of gyration squared.
fn energy_per_kg(body: &BodyState, square: f64) -> f64 {
    let [vx, vy] = body.velocity;
    0.5 * (vx * vx + vy * vy + square * body.angular_velocity.powi(2)) + GRAVITY * body.position[1]
}

/// B23: √ of the energy left after the first impact, at the next turning point, over what was there: the ratio of the
/// spins just after and just before.
pub(super) fn rocking(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let [half_width, half_height] = rocking_block();
    let square = (half_width * half_width + half_height * half_height) / 3.0;
    let above = |body: &BodyState| energy_per_kg(body, square) - GRAVITY * half_height;
    let mut run = trial.begin()?;
    let before = above(&run.body(1));
    let mut over = false;
    while run.step()? {
        let body = run.body(1);
        over |= body.rotation[1] > 0.0;
        if over && body.angular_velocity <= 0.0 {
            return Ok(relative((above(&body).max(0.0) / before).sqrt(), rocking_ratio()));
        }
    }
    // It never came up on the other side.
    Ok(1.0)
}

/// B31: what energy is gained over what there was, at most.
pub(super) fn painleve(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let mut run = trial.begin()?;
    let energy = |run: &super::trial::Run| {
        let sums = run.world.invariants();
        sums.kinetic_energy + sums.potential_energy
    };
    let start = energy(&run);
    let mut most = 0.0;
    while run.step()? {
        most = worst([most, (energy(&run) - start).max(0.0) / start.abs()]);
    }
    Ok(most)
}

/// The domino whose fall begins the measured part, and the one that ends it.
const MEASURED: [usize; 2] = [5, 13];

/// v/√(gℓ) of the dominoes, all 4ᵏ times as large.
fn wave(trial: &Trial<'_>, k: i32) -> anyhow::Result<f64> {
    let scene = enlarged(trial.scene, k);
    let time = 2f64.powi(k);
    let settings = lamina2d::settings::Settings { dt_secs: trial.settings.dt_secs * time, ..trial.settings };
    let large = Trial { scene: &scene, settings, secs: trial.secs * time };
    let (mut run, mut falls) = (large.begin()?, [None; 2]);
    while run.step()? {
        for (fall, number) in falls.iter_mut().zip(MEASURED) {
            let lean = run.body(number + 1).rotation[1];
            if lean < -0.2 {
                fall.get_or_insert(run.secs());
            }
        }
    }
    let [Some(first), Some(last)] = falls else { return Ok(0.0) };
    let way = scene.bodies[MEASURED[1] + 1].position[0] - scene.bodies[MEASURED[0] + 1].position[0];
    Ok(way / (last - first) / (GRAVITY * 4f64.powi(k)).sqrt())
}

/// B27: how much v/√(gℓ) differs between dominoes of 1 m and of 1.6 cm, 6 cm, 4 m, 16 m and 64 m.
pub(super) fn dominoes(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let one = wave(trial, 0)?;
    let others: Vec<f64> = [-3, -2, 1, 2, 3].into_iter().map(|k| wave(trial, k)).collect::<Result<_, _>>()?;
    Ok(worst(others.into_iter().map(|other| relative(other, one))))
}

/// Sums over the steps of a gas.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    /// Momentum handed to walls, N·s.
    walls: f64,
    /// Discs in the middle, those of them that met another, and steps.
    middle: f64,
    met: f64,
    steps: f64,
    /// Σv² and Σv⁴ over discs and steps.
    squares: f64,
    fourths: f64,
}

/// Nearer than this a disc whose velocity has turned away from a wall has met it, metres.
const AT_WALL_M: f64 = 0.02;

impl Sums {
    fn add(&mut self, before: &[BodyState], after: &[BodyState]) {
        self.steps += 1.0;
        let reach = GAS.half_m - GAS.radius_m;
        for (old, new) in before.iter().zip(after) {
            let square = new.velocity[0].powi(2) + new.velocity[1].powi(2);
            self.squares += square;
            self.fourths += square * square;
            for k in 0..2 {
                let side = new.position[k].signum();
                let turned = old.velocity[k] * side > 0.0 && new.velocity[k] * side < 0.0;
                if turned && new.position[k].abs() > reach - AT_WALL_M {
                    self.walls += (old.velocity[k] - new.velocity[k]).abs();
                }
            }
            if new.position.iter().all(|x| x.abs() < 0.5 * GAS.half_m) {
                self.middle += 1.0;
                let changed = (0..2).map(|k| (new.velocity[k] - old.velocity[k]).abs()).fold(0.0, f64::max);
                self.met += f64::from(u8::from(changed > 1e-5));
            }
        }
    }
}

/// Sums over a gas after the first tenth of its time, in which it comes to rest in itself.
fn gas(trial: &Trial<'_>) -> anyhow::Result<(Sums, f64)> {
    let mut run = trial.begin()?;
    let discs = |run: &super::trial::Run| run.world.states()[4..].to_vec();
    while run.secs() < 0.1 * trial.secs && run.step()? {}
    let (since, mut before, mut sums) = (run.secs(), discs(&run), Sums::default());
    while run.step()? {
        let after = discs(&run);
        sums.add(&before, &after);
        before = after;
    }
    Ok((sums, run.secs() - since))
}

/// Density in the middle, 1/m², temperature, J, and share of the area covered, of discs of 1 kg.
fn state(sums: &Sums) -> [f64; 3] {
    let density = sums.middle / sums.steps / (GAS.half_m * GAS.half_m);
    let count = (GAS.side * GAS.side) as f64;
    let temperature = 0.5 * sums.squares / sums.steps / count;
    [density, temperature, density * std::f64::consts::PI * GAS.radius_m.powi(2)]
}

/// B28: Z = P/nT over (1 + φ²/8)/(1 − φ)² (Henderson 1975), n and φ those in the middle of the box.
pub(super) fn pressure(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let (sums, secs) = gas(trial)?;
    let [density, temperature, phi] = state(&sums);
    // Centres keep a radius away from walls and corners.
    let wall = 8.0 * (GAS.half_m - GAS.radius_m);
    let found = sums.walls / (secs * wall) / (density * temperature);
    Ok(relative(found, (1.0 + phi * phi / 8.0) / (1.0 - phi).powi(2)))
}

/// B28: collisions per disc and second over 2√π·nσχ√(T/m), χ = (1 − 7φ/16)/(1 − φ)² (Enskog).
pub(super) fn collisions(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let (sums, _) = gas(trial)?;
    let [density, temperature, phi] = state(&sums);
    let chi = (1.0 - 7.0 * phi / 16.0) / (1.0 - phi).powi(2);
    let per_sec = 2.0 * std::f64::consts::PI.sqrt() * density * 2.0 * GAS.radius_m * chi * temperature.sqrt();
    Ok(relative(sums.met / sums.middle / trial.settings.dt_secs, per_sec))
}

/// B28: ⟨v⁴⟩/⟨v²⟩² over 2N/(N + 1), Maxwell's 2 for N discs that share a fixed energy.
pub(super) fn maxwell(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let (sums, _) = gas(trial)?;
    let count = (GAS.side * GAS.side) as f64;
    let samples = sums.steps * count;
    let found = (sums.fourths / samples) / (sums.squares / samples).powi(2);
    Ok(relative(found, 2.0 * count / (count + 1.0)))
}

/// B28: how much energy is lost or gained, over the first.
pub(super) fn kept(trial: &Trial<'_>) -> anyhow::Result<f64> {
    let mut run = trial.begin()?;
    let start = run.world.invariants().kinetic_energy;
    while run.step()? {}
    Ok(relative(run.world.invariants().kinetic_energy, start))
}
