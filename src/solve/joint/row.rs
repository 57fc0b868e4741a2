//! One degree of freedom of a joint: a rod's length or the angle between two bodies.
//!
//! A row has a coordinate x with velocity w and an effective mass 1/k, a *drive* (a spring about x = rest, or a
//! motor) and *bounds* lower ≤ x ≤ upper, equal where x is held. Each has its impulse. With w₀ the velocity that
//! would be without both:
//!
//! ```text
//! drive = clamp(gain·(target − w₀)/k, ±bound)      target = speed − rate·(x − rest)
//! limit = (clamp(w₁, w_lo, w_hi) − w₁)/k           w₁ = w₀ + k·drive
//! ```
//!
//! with w_lo and w_hi the velocities at which x would reach its bounds in a substep, or that push it back from beyond
//! them. One formula for rods, ropes, welds, springs, motors and limits: kinds of one shape share their lanes.
//!
//! A spring of stiffness k_s and damping c acts with −h·(k_s·(x + θ·h·u) + c·u), u the moving velocity and θ its share
//! (½ where u is the mean of old and new velocity: then it is the implicit midpoint, which neither feeds nor loses
//! energy; 1 else). That is a soft constraint of substep θh, whatever the stiffness.

use super::Stiffness;
use crate::joint::{Held, Joint, JointKind, JointSpring};
use crate::lanes::{Lanes, Real};
use crate::solve::constraint::inverse;
use crate::solve::soft;

/// What a joint's row is made of, before it has lanes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Numbers {
    gain: f64,
    rate: f64,
    speed: f64,
    bound: f64,
    rest: f64,
    lower: f64,
    upper: f64,
}

impl Numbers {
    /// For substeps of `h_secs` in which an impulse changes the moving velocity by `share` of the velocity's change.
    pub(super) fn of(joint: &Joint, h_secs: f64, share: f64) -> Self {
        let free = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY, ..Self::default() };
        let spring = |spring: JointSpring| {
            // What swings by more than a radian in a substep is not followed, only brought to rest: θ = 1.
            let followed = std::f64::consts::TAU * spring.hertz * h_secs < 1.0;
            let share = if followed { share } else { 1.0 };
            let (rate, gain) = soft::coefficients(share * h_secs, spring.hertz, spring.damping);
            Self { gain, rate, bound: f64::INFINITY, ..free }
        };
        match &joint.kind {
            JointKind::Distance(distance) => {
                let row = Self { rest: joint.length, ..distance.spring.map_or(free, spring) };
                if distance.spring.is_none() && distance.min.is_none() && distance.max.is_none() {
                    return Self { lower: joint.length, upper: joint.length, ..row };
                }
                let [lower, upper] = [distance.min.unwrap_or(free.lower), distance.max.unwrap_or(free.upper)];
                Self { lower, upper, ..row }
            }
            JointKind::Revolute(revolute) => {
                let row = revolute.limits.map_or(free, |l| Self { lower: l.lower, upper: l.upper, ..free });
                revolute.motor.map_or(row, |motor| Self {
                    gain: 1.0,
                    speed: motor.speed,
                    bound: motor.max_torque * h_secs,
                    ..row
                })
            }
            // Its angle is 0 where it was made.
            JointKind::Weld(weld) => weld.spring.map_or_else(Self::default, spring),
        }
    }
}

/// `WIDTH` rows: 7 values that stay and 2 impulses.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row<L> {
    gain: L,
    rate: L,
    speed: L,
    bound: L,
    rest: L,
    lower: L,
    upper: L,
    /// Impulse of spring or motor, in units of v.
    pub(super) drive: L,
    /// Impulse of the bounds, likewise.
    pub(super) limit: L,
}

impl<L: Lanes> Row<L> {
    /// From the numbers and impulses of at most `WIDTH` joints; what is left is all zeros, and inert.
    pub(super) fn new(numbers: &[Numbers], held: &[Held<L::Elem>]) -> Self {
        let lanes = |of: fn(&Numbers) -> f64| super::lanes(numbers, |n| L::Elem::from_f64(of(n)));
        Self {
            gain: lanes(|n| n.gain),
            rate: lanes(|n| n.rate),
            speed: lanes(|n| n.speed),
            bound: lanes(|n| n.bound),
            rest: lanes(|n| n.rest),
            lower: lanes(|n| n.lower),
            upper: lanes(|n| n.upper),
            drive: super::lanes(held, |h| h.drive),
            limit: super::lanes(held, |h| h.limit),
        }
    }

    /// Is the coordinate of a lane held rigidly, at one value?
    pub(super) fn is_rigid(&self, lane: usize) -> bool {
        let at = |value: &L| value.to_array()[lane];
        at(&self.lower) == at(&self.upper) && at(&self.gain) == L::Elem::ZERO
    }

    /// Adds to the impulse of the bounds of one lane, in units of v.
    pub(super) fn add_limit(&mut self, lane: usize, impulse: f64) {
        let mut values = self.limit.to_array();
        values[lane] = L::Elem::from_f64(values[lane].to_f64() + impulse);
        self.limit = L::load(&values);
    }

    /// One lane's impulse and the value it is held at, in `f64`.
    pub(super) fn held_lane(&self, lane: usize) -> [f64; 2] {
        let at = |value: L| value.to_array()[lane].to_f64();
        [at(self.impulse()), at(self.upper)]
    }

    /// The whole impulse, in units of v.
    #[inline(always)]
    pub(super) fn impulse(&self) -> L {
        self.drive + self.limit
    }

    /// Other numbers, the same impulses.
    pub(super) fn retune(&mut self, numbers: &[Numbers]) {
        *self = Self { drive: self.drive, limit: self.limit, ..Self::new(numbers, &[]) };
    }

    /// Solves with bias; returns the change of the impulse in units of u. `x` the coordinate, `w` its moving velocity
    /// as far as it is linear, `bend` what the substep adds to it by turning; `k` the inverse effective mass that
    /// impulses meet, `rigid` that of what a spring's stiffness is said for.
    #[inline(always)]
    pub(super) fn push(&mut self, how: &Stiffness<L>, x: L, w: L, bend: L, [k, rigid]: [L; 2]) -> L {
        let (zero, mass) = (L::zero(), inverse(k));
        // A spring's gain g is k_r/(k_r + γ); with another k it is the same spring where it is 1/(k + γ).
        let sprung = inverse(rigid + self.gain * (k - rigid));
        let (drive, limit) = (self.drive * how.share, self.limit * how.share);
        let w0 = (w + bend) - k * (drive + limit);
        let target = self.speed - self.rate * (x - self.rest);
        let bound = self.bound * how.share;
        let next_drive = (-bound).max(bound.min(self.gain * (sprung * (target - w0))));
        let w1 = w0 + k * next_drive;
        let equal = self.upper.le(self.lower);
        let (above, below) = (x - self.lower, x - self.upper);
        let (clear_low, clear_high) = (zero.lt(above) & !equal, below.lt(zero) & !equal);
        let low = -(above * L::select(clear_low, how.per_sec, how.bias_rate));
        let high = -(below * L::select(clear_high, how.per_sec, how.bias_rate));
        let wanted = mass * (low.max(high.min(w1)) - w1);
        // A bound not yet reached is met exactly; where it is pushed back from, softly.
        let meets = (zero.lt(wanted) & clear_low) | (wanted.lt(zero) & clear_high);
        let next_limit = wanted * L::select(meets, L::one(), how.mass_scale);
        self.drive = next_drive * how.per_share;
        self.limit = next_limit * how.per_share;
        (next_drive - drive) + (next_limit - limit)
    }

    /// Solves velocities without bias; returns the change of the impulse. Springs keep theirs: they are forces, and
    /// have acted. A bound that carried nothing may go on being closed in on.
    #[inline(always)]
    pub(super) fn relax(&mut self, how: &Stiffness<L>, x: L, w: L, k: L) -> L {
        let (zero, mass) = (L::zero(), inverse(k));
        let w0 = w - k * (self.drive + self.limit);
        let turned = (-self.bound).max(self.bound.min(self.gain * (mass * (self.speed - w0))));
        let drive = L::select(zero.lt(self.rate), self.drive, turned);
        let w1 = w0 + k * drive;
        let equal = self.upper.le(self.lower);
        let (above, below) = (zero.max(x - self.lower), zero.max(self.upper - x));
        let low = L::select(equal | zero.lt(self.limit), zero, -(above * how.per_sec));
        let high = L::select(equal | self.limit.lt(zero), zero, below * how.per_sec);
        let limit = mass * (low.max(high.min(w1)) - w1);
        let change = (drive - self.drive) + (limit - self.limit);
        (self.drive, self.limit) = (drive, limit);
        change
    }

    /// For displacements: springs and motors have acted, and what bounds carry, N·s, is none of theirs.
    pub(super) fn let_go(&mut self) {
        (self.drive, self.limit, self.bound) = (L::zero(), L::zero(), L::zero());
    }

    /// Impulses of a substep that is `share` of the last one.
    #[inline(always)]
    pub(super) fn scale(&mut self, share: L) {
        self.drive = self.drive * share;
        self.limit = self.limit * share;
    }
}
