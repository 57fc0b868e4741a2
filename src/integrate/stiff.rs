//! Bodies whose fields a substep cannot follow: what drags, holds or turns them answers within a fraction of it.
//!
//! **The law.** A scheme follows a field of rate r (1/s) while h·r is small: each has a limit beyond which its error grows
//! from step to step without bound ([`Limits`]). Rates of a body of mass m are k/m of linear drag, k·|v|/m of quadratic drag,
//! √(k/m) of a spring, k/m of a magnetic field. Where one of them exceeds its limit over h the body is advanced by what these
//! fields do exactly instead:
//!
//! * With z = position + i·position of the plane, seen from the spring's anchor, and f all other accelerations, constant for a
//!   substep, z″ = −(k/m)·z − (c/m + i·q/m)·z′ + f is linear, and (z, z′, f) goes on by the exponential of a matrix. Drag decays,
//!   springs and magnetic fields turn, at any step: an oscillator keeps its energy to round-off.
//! * Quadratic drag is implicit: s·(1 + k·s·h/m) = |w| for the speed s that is left of w. Its terminal speed is exact.
//!
//! Slower bodies keep the bits of their scheme, as do all with [`StiffFields::Scheme`](crate::settings::StiffFields::Scheme). How many are advanced so is counted in
//! [`Counts::stiff`](crate::measure::Counts::stiff).
//!
//! The exponential is by scaling and squaring: a Taylor series of ten terms at a norm below 1/16 (Moler and Van Loan,
//! Nineteen Dubious Ways, 2003), in `f64` and plain operations, so that every machine has the same bits.

use crate::body::Bodies;
use crate::each::Each as _;
use crate::force::{Field, Forces, acceleration_of};
use crate::lanes::Real;
use crate::motion::{Motion, Plan, Warm};
use crate::settings::Integrator;

/// Rates times substep beyond which a scheme does not follow.
#[derive(Clone, Copy, Debug)]
struct Limits {
    /// Springs: where the leapfrogs, composed or not, and RK4 begin to grow. Explicit Euler grows at any step, which is
    /// what it is shown for; it is given up where the others are.
    spring: f64,
    /// Drags: 2 under most schemes, whose velocity then turns round at once; less than that is a decay.
    drag: f64,
    /// Magnetic fields: RK4 loses (h·r)⁶/144 a substep; schemes of order 2 gain (h·r)⁴/8, 1 % in ten thousand at the limit.
    magnetic: f64,
}

impl Limits {
    fn of(integrator: Integrator) -> Self {
        let spring = match integrator {
            Integrator::Yoshida4 => 1.573,
            Integrator::Rk4 => 2.828,
            _ => 2.0,
        };
        let magnetic = if matches!(integrator, Integrator::Rk4) { 1.0 } else { 0.05 };
        Self { spring, drag: 1.5, magnetic }
    }
}

/// A complex number: x, y of the plane.
type Complex = [f64; 2];

fn times(a: Complex, b: Complex) -> Complex {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn plus(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

fn scaled(a: Complex, by: f64) -> Complex {
    [a[0] * by, a[1] * by]
}

fn product(a: &[[Complex; 3]; 3], b: &[[Complex; 3]; 3]) -> [[Complex; 3]; 3] {
    let at = |i: usize, j: usize| (0..3).fold([0.0; 2], |sum, k| plus(sum, times(a[i][k], b[k][j])));
    crate::each::indexed(|i| crate::each::indexed(|j| at(i, j)))
}

/// e^m.
fn exponential(m: &[[Complex; 3]; 3]) -> [[Complex; 3]; 3] {
    let norm =
        m.iter().map(|row| row.iter().map(|c| c[0].abs() + c[1].abs()).sum::<f64>()).fold(0.0, f64::max);
    let mut halvings = 0;
    let mut scale = 1.0;
    while norm * scale > 0.0625 {
        scale *= 0.5;
        halvings += 1;
    }
    let small: [[Complex; 3]; 3] = m.each(|row| row.each(|c| scaled(c, scale)));
    let one: [[Complex; 3]; 3] =
        crate::each::indexed(|i| crate::each::indexed(|j| [f64::from(u8::from(i == j)), 0.0]));
    let (mut sum, mut term) = (one, one);
    for n in 1..=10 {
        term = product(&term, &small).each(|row| row.each(|c| scaled(c, 1.0 / f64::from(n))));
        for (sums, terms) in sum.iter_mut().zip(term) {
            for (sum, term) in sums.iter_mut().zip(terms) {
                *sum = plus(*sum, term);
            }
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

/// How a substep changes (z, h·v) of a body: rows of what comes of z, h·v and h²·f.
type Propagator = [[Complex; 3]; 2];

/// The fields that may be stiff, per kilogram where they are divided by a mass.
#[derive(Clone, Copy, Debug, Default)]
struct StiffFields {
    linear_drag: f64,
    quadratic_drag: f64,
    wind: [f64; 2],
    spring: f64,
    anchor: [f64; 2],
    magnetic: f64,
}

impl StiffFields {
    /// Does a field answer too fast for substeps of `h_secs`: of a body with this inverse mass and so much speed against
    /// the wind?
    fn exceed(&self, limits: &Limits, inv_mass: f64, speed: f64, h_secs: f64) -> bool {
        let drag = (self.linear_drag + self.quadratic_drag * speed) * inv_mass;
        let spring = (self.spring.abs() * inv_mass).sqrt();
        let magnetic = self.magnetic.abs() * inv_mass;
        drag * h_secs > limits.drag || spring * h_secs > limits.spring || magnetic * h_secs > limits.magnetic
    }

    fn propagator(&self, inv_mass: f64, h_secs: f64) -> Propagator {
        let zero = [0.0; 2];
        let stiffness = [-self.spring * inv_mass * h_secs * h_secs, 0.0];
        let turning = [-self.linear_drag * inv_mass * h_secs, -self.magnetic * inv_mass * h_secs];
        let one = [1.0, 0.0];
        let [z, v, _] = exponential(&[[zero, one, zero], [stiffness, turning, one], [zero; 3]]);
        [z, v]
    }
}

/// A body as a substep begins.
#[derive(Clone, Copy, Debug)]
struct Begun {
    slot: u32,
    /// Metres, world.
    place: [f64; 2],
    /// m/s.
    velocity: [f64; 2],
    /// What contacts are expected to change it by, as the prediction has it, m/s.
    warm: [f64; 2],
}

/// Who is stiff; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Stiff<R> {
    fields: StiffFields,
    limits: Limits,
    /// All other fields.
    others: Vec<Field<R>>,
    /// What they accelerate by at most where that does not depend on the place, m/s²: how fast a body may become in a step.
    pull: f64,
    /// Is there a field that may be stiff, of bodies that do not move each other?
    possible: bool,
    /// The inverse mass of the lightest body, 1/kg.
    lightest: f64,
    /// May a body be stiff in this step?
    active: bool,
    /// Propagators by inverse mass, for substeps of `h_secs`.
    propagators: Vec<(f64, Propagator)>,
    h_secs: f64,
    begun: Vec<Begun>,
}

impl<R> Default for Stiff<R> {
    fn default() -> Self {
        Self {
            fields: StiffFields::default(),
            limits: Limits::of(Integrator::VelocityVerlet),
            others: Vec::new(),
            pull: 0.0,
            possible: false,
            lightest: 0.0,
            active: false,
            propagators: Vec::new(),
            h_secs: 0.0,
            begun: Vec::new(),
        }
    }
}

impl<R: Real> Stiff<R> {
    /// Takes in bodies and fields of a world: as they are written down, and as integrators take them.
    pub(crate) fn look_over(&mut self, bodies: &Bodies<R>, forces: &Forces, fields: &[Field<R>]) {
        let spring = forces.spring;
        self.fields = StiffFields {
            linear_drag: forces.linear_drag.unwrap_or(0.0),
            quadratic_drag: forces.quadratic_drag.unwrap_or(0.0),
            wind: forces.wind.unwrap_or_default(),
            spring: spring.map_or(0.0, |spring| spring.stiffness),
            anchor: spring.map_or([0.0; 2], |spring| spring.anchor),
            magnetic: forces.magnetic.unwrap_or(0.0),
        };
        let may_be_stiff = |field: &&Field<R>| {
            matches!(
                field,
                Field::LinearDrag { .. }
                    | Field::QuadraticDrag { .. }
                    | Field::Spring { .. }
                    | Field::Magnetic(_)
            )
        };
        self.possible = fields.iter().any(|field| may_be_stiff(&field)) && !fields.iter().any(Field::couples);
        self.others.clear();
        self.others.extend(fields.iter().filter(|field| !may_be_stiff(field)));
        let length = |v: [f64; 2]| v[0].hypot(v[1]);
        self.pull =
            forces.gravity.map_or(0.0, length) + forces.drive.map_or(0.0, |drive| length(drive.amplitude));
        self.propagators.clear();
        self.lightest = bodies.slots().map(|slot| bodies.inv_mass[slot].to_f64()).fold(0.0, f64::max);
    }

    /// A step of `dt_secs` begins at `time_secs`: may a body be stiff in substeps of `h_secs` or, where islands have their own,
    /// of half a step?
    pub(crate) fn begin(
        &mut self,
        integrator: Integrator,
        bodies: &Bodies<R>,
        time_secs: f64,
        [h_secs, dt_secs]: [f64; 2],
    ) -> bool {
        self.active = false;
        if !self.possible {
            return false;
        }
        for field in &mut self.others {
            field.begin(time_secs);
        }
        let speed =
            if self.fields.quadratic_drag > 0.0 { self.fastest(bodies) + self.pull * dt_secs } else { 0.0 };
        let longest = h_secs.max(0.5 * dt_secs);
        self.limits = Limits::of(integrator);
        self.active = self.fields.exceed(&self.limits, self.lightest, speed, longest);
        self.active
    }

    /// The highest speed against the wind, m/s.
    fn fastest(&self, bodies: &Bodies<R>) -> f64 {
        let wind = self.fields.wind.each(R::from_f64);
        let square = bodies.slots().fold(R::ZERO, |most, slot| {
            let (x, y) = (bodies.vx[slot] - wind[0], bodies.vy[slot] - wind[1]);
            let square = x * x + y * y;
            if most < square { square } else { most }
        });
        square.to_f64().sqrt()
    }

    fn is_stiff_at(&self, bodies: &Bodies<R>, slot: usize, v: [f64; 2], [h_secs, gained]: [f64; 2]) -> bool {
        let inv_mass = bodies.inv_mass[slot].to_f64();
        let wind = self.fields.wind;
        let speed = (v[0] - wind[0]).hypot(v[1] - wind[1]) + gained;
        inv_mass > 0.0 && self.fields.exceed(&self.limits, inv_mass, speed, h_secs)
    }

    /// Before a substep is predicted: notes who is stiff, and how they begin it. Returns how many.
    pub(crate) fn note(
        &mut self,
        plan: &Plan<'_, R>,
        bodies: &Bodies<R>,
        motion: &Motion<R>,
        from: Warm,
    ) -> usize {
        self.begun.clear();
        if !self.active {
            return 0;
        }
        if self.h_secs != plan.h_secs {
            self.h_secs = plan.h_secs;
            self.propagators.clear();
        }
        for slot in motion.runs.iter().cloned().flatten().filter(|&slot| bodies.is_alive(slot)) {
            // What sleeps has no mass in the rows; what another substep group moves is left alone.
            let sleeps = motion.inverse_masses.fours()[slot][0] <= R::ZERO;
            let moves = motion.group.current.is_none_or(|group| motion.group.of_slot[slot] == group);
            if sleeps || !moves {
                continue;
            }
            let mut place = bodies.place(slot);
            let mut velocity = [bodies.vx[slot], bodies.vy[slot]].each(R::to_f64);
            let row = motion.velocity.fours()[slot];
            let warm = crate::each::indexed(|k| match from {
                Warm::Summed => row[k].to_f64(),
                _ if plan.carries => (row[k] - motion.free[k][slot]).to_f64(),
                _ => 0.0,
            });
            if from == Warm::Onward {
                let last = motion.moved.fours()[slot];
                for k in 0..2 {
                    place[k] += (motion.total[k][slot] + last[k]).to_f64();
                    velocity[k] = row[k].to_f64();
                }
            }
            if self.is_stiff_at(bodies, slot, velocity, [plan.h_secs, self.pull * plan.h_secs]) {
                self.begun.push(Begun { slot: slot as u32, place, velocity, warm });
            }
        }
        self.begun.len()
    }

    /// After a substep was predicted: those that were noted are predicted exactly.
    pub(crate) fn correct(&mut self, plan: &Plan<'_, R>, bodies: &Bodies<R>, motion: &mut Motion<R>) {
        let (h, share) = (plan.h_secs, plan.impulse_share());
        for at in 0..self.begun.len() {
            let begun = self.begun[at];
            let slot = begun.slot as usize;
            let (moved, velocity) = self.advanced(plan, bodies, &begun);
            let row = &mut motion.velocity.fours_mut()[slot];
            for k in 0..2 {
                motion.ahead[k][slot] = R::from_f64(moved[k]);
                motion.free[k][slot] = R::from_f64(velocity[k]);
                // As the prediction has it, of numbers that it may have lost.
                let base = if plan.moving {
                    motion.ahead[k][slot] * R::from_f64(1.0 / h)
                } else {
                    motion.free[k][slot]
                };
                row[k] = base + R::from_f64(begun.warm[k] * share);
            }
        }
    }

    /// Displacement and velocity after a substep.
    fn advanced(&mut self, plan: &Plan<'_, R>, bodies: &Bodies<R>, begun: &Begun) -> ([f64; 2], [f64; 2]) {
        let (slot, h) = (begun.slot as usize, plan.h_secs);
        let inv_mass = bodies.inv_mass[slot].to_f64();
        let StiffFields { linear_drag, quadratic_drag, wind, anchor, .. } = self.fields;
        let since = plan.since_secs + 0.5 * h;
        let pulled = acceleration_of(&self.others, bodies, slot, [begun.place, begun.velocity], since);
        let f: Complex = crate::each::indexed(|k| pulled[k] + linear_drag * inv_mass * wind[k]);
        let z: Complex = crate::each::indexed(|k| begun.place[k] - anchor[k]);
        let (hv, h2f) = (scaled(begun.velocity, h), scaled(f, h * h));
        let [to_z, to_v] = self.propagator(inv_mass);
        let sum = |row: [Complex; 3]| plus(plus(times(row[0], z), times(row[1], hv)), times(row[2], h2f));
        let mut moved = plus(sum(to_z), scaled(z, -1.0));
        let mut velocity = scaled(sum(to_v), 1.0 / h);
        if quadratic_drag > 0.0 {
            let against: Complex = crate::each::indexed(|k| velocity[k] - wind[k]);
            let speed = against[0].hypot(against[1]);
            let k = quadratic_drag * inv_mass * h;
            // s·(1 + k·s) = speed, without the difference of equals.
            let left = 2.0 / (1.0 + (1.0 + 4.0 * k * speed).sqrt());
            let after: Complex = crate::each::indexed(|i| wind[i] + against[i] * left);
            let is_stiff = k * speed > self.limits.drag;
            for i in 0..2 {
                let change = h * (after[i] - velocity[i]);
                moved[i] = if is_stiff { h * after[i] } else { moved[i] + 0.5 * change };
            }
            velocity = after;
        }
        (moved, velocity)
    }

    fn propagator(&mut self, inv_mass: f64) -> Propagator {
        if let Some((_, known)) = self.propagators.iter().find(|(mass, _)| *mass == inv_mass) {
            return *known;
        }
        let made = self.fields.propagator(inv_mass, self.h_secs);
        self.propagators.push((inv_mass, made));
        made
    }
}
