//! The watchdog: a step that ends with a body faster, or with more energy, than it may have is the last one.
//!
//! Bounds are those of [`Settings::max_speed`](crate::settings::Settings::max_speed), held against every step, and
//! [`Settings::max_gain`](crate::settings::Settings::max_gain), held against each [`EVERY`]th. The world keeps the state
//! that was too much, for inspection. Whoever puts energy in by hand (bodies inserted, removed or written to,
//! impulses, other fields) begins the account anew; what drives and fields that change put in counts as gained.

use super::{Laws, Log, StepError, World};
use crate::body::Bodies;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};
use crate::measure::{Invariants, Stage, invariants_of};

/// Steps from one look at energies to the next: sums in `f64` cost 1 to 3 % of a step, so both bounds 0.6 % of a settled
/// one (instructions; bench `checks/watchdog`).
pub const EVERY: u64 = 16;

/// What the watchdog remembers.
#[derive(Clone, Debug, Default)]
pub(super) struct Watchdog {
    /// Kinetic and potential energy as the account began, J.
    begun: Option<[f64; 2]>,
    /// Those of each slot when last looked at.
    last: Vec<[f64; 2]>,
}

/// What a look at the energies saw.
struct Look {
    /// Kinetic and potential, J.
    sums: [f64; 2],
    /// The slot in which each has risen most since the last look.
    risen: [usize; 2],
}

impl Watchdog {
    /// Begins the account anew with the next step.
    pub(super) fn forget(&mut self) {
        self.begun = None;
    }
}

impl<L: Lanes> World<L> {
    /// As a step begins: what energy is held against.
    pub(super) fn begin_watch(&mut self) {
        if self.settings.max_gain.is_some() && self.log.watchdog.begun.is_none() {
            self.log.watchdog.begun = Some(self.look_at_energies().sums);
        }
    }

    /// As a step ends, `free` of contacts and joints or not.
    pub(super) fn watch(&mut self, free: bool) -> Result<(), StepError> {
        let step = self.log.steps;
        if let Some(bound) = self.settings.max_speed
            && let Some((slot, speed)) = fastest_beyond(self, bound)
        {
            let stage = self.stage_behind(slot, free);
            return Err(StepError::Runaway { step, slot, speed, bound, stage });
        }
        let (Some(bound), Some(begun)) = (self.settings.max_gain, self.log.watchdog.begun) else {
            return Ok(());
        };
        if !step.is_multiple_of(EVERY) {
            return Ok(());
        }
        let Look { sums, risen } = self.look_at_energies();
        let [kinetic, potential] = [sums[0] - begun[0], sums[1] - begun[1]];
        let gain = kinetic + potential;
        if gain <= bound {
            return Ok(());
        }
        let (term, slot) = if kinetic >= potential { ("kinetic", risen[0]) } else { ("potential", risen[1]) };
        Err(StepError::Gain { step, slot, gain, bound, term, stage: self.stage_behind(slot, free) })
    }

    /// Sums energies and notes those of each slot.
    fn look_at_energies(&mut self) -> Look {
        let Self { bodies, laws: Laws { forces, .. }, log: Log { watchdog, .. }, .. } = self;
        watchdog.last.resize(bodies.len(), [0.0; 2]);
        let dynamic = bodies.slots().filter(|&slot| bodies.inv_mass[slot] > L::Elem::ZERO);
        let (mut sum, mut risen, mut most) = (Invariants::default(), [0; 2], [f64::NEG_INFINITY; 2]);
        if forces.attraction.is_some() {
            sum.potential_energy = crate::measure::attraction_energy(bodies, forces);
        }
        for slot in dynamic {
            let one = invariants_of(bodies, forces, slot);
            let now = [one.kinetic_energy, one.potential_energy];
            for k in 0..2 {
                let rise = now[k] - watchdog.last[slot][k];
                if rise > most[k] {
                    (most[k], risen[k]) = (rise, slot);
                }
            }
            sum.kinetic_energy += now[0];
            sum.potential_energy += now[1];
            watchdog.last[slot] = now;
        }
        Look { sums: [sum.kinetic_energy, sum.potential_energy], risen }
    }

    /// Which stage made a body as fast as it is.
    fn stage_behind(&self, slot: usize, free: bool) -> Stage {
        let read = |columns: [&crate::column::Column<L::Elem>; 2]| {
            let [x, y] = columns.each(|column| column[slot].to_f64());
            x.hypot(y)
        };
        let predicted = self.motion.predicted_speed(slot);
        let pushed = read([&self.bodies.vx, &self.bodies.vy]) > predicted;
        if free || !pushed { Stage::Integrate } else { Stage::Solve }
    }
}

/// The fastest dynamic body beyond a bound, m/s: slot and speed.
fn fastest_beyond<L: Lanes>(world: &World<L>, bound: f64) -> Option<(usize, f64)> {
    let bodies: &Bodies<L::Elem> = &world.bodies;
    let most = L::lit(bound);
    let (vx, vy) = (bodies.vx.lanes::<L>(), bodies.vy.lanes::<L>());
    let mut fastest: Option<(usize, f64)> = None;
    for (at, (x, y)) in vx.iter().zip(vy).enumerate() {
        // Never less than the speed, and without squares that leave the range of a scalar.
        let doubtful = most.lt(x.abs() + y.abs());
        if doubtful.any() {
            for slot in set_lanes(doubtful.bits()).map(|lane| at * L::WIDTH + lane) {
                let speed = bodies.vx[slot].to_f64().hypot(bodies.vy[slot].to_f64());
                let moves = bodies.inv_mass[slot] > L::Elem::ZERO;
                if moves && speed > bound && fastest.is_none_or(|(_, most)| speed > most) {
                    fastest = Some((slot, speed));
                }
            }
        }
    }
    fastest
}
