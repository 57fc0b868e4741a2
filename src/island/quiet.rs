//! When a body is quiet, and for how long it has been.
//!
//! **The law.** A body may sleep when what it has done since it became quiet is what a body at rest does: it has gone
//! nowhere, and it is not on its way. Speed alone does not tell: a box on its corner, a pendulum where it turns, a slow motor
//! are slower than a pile that shivers. So a body is quiet from a moment on while it is slow ([`QUIET_RADII_PER_SEC`]) and
//! within [`QUIET_RADII`] of where it was at that moment; else the moment is now. It is ripe once that has lasted its window,
//! and the window's second half took it no further than the first by more than noise ([`GROWTH`], [`NOISE_RADII`]): what rests
//! wavers about one place, what creeps is twice as far at the end, what falls from rest four times, what leaves an unstable
//! balance more.
//!
//! **Why that suffices.** All that a body of radius r does by its weight goes no slower than √(g/r) allows: a fall by r takes
//! √(2r/g), an unstable balance grows by e in about √(r/g), a swing about its own support has the period 2π√(r/g). A window of
//! [`WINDOW`]·√(r/g) is e⁶ of growth: from 1e-6 of r off balance it is beyond the noise. What swings more slowly does so by
//! links or springs, whose lengths and frequencies are known: they demand longer windows ([`super::Demand`], [`Pull`]).

use std::ops::Range;

use crate::body::Bodies;
use crate::column::Column;
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, Real};
use crate::motion::lanes_in;

/// The shortest window, seconds.
pub(super) const QUIET_SECS: f64 = 0.5;
/// The window in units of √(r/g).
const WINDOW: f64 = 6.0;
/// Below this speed, in bounding radii per second, a body is quiet: in [`QUIET_SECS`] it then goes no further than
/// a manifold is held to be unchanged ([`crate::motion::CONTACT_REUSE_DISTANCE`]).
///
/// Measured (largest speed of any body per half second): pyramid/10 falls below 1 mm/s in 2 s, pyramid/20 below 5
/// mm/s in 4.5 s, polygons/150 below 2 mm/s in 8 s, rain/200 and cards/3 likewise, all of them decaying towards 0;
/// an arch creeps by 1 mm/s, a column of 20 boxes wavers by 1.7 mm/s. What must not sleep: in circles/150 a disc of
/// 0.6 m rolls on by 9.2 mm/s. With radii of 0.6 to 1 m the bound is 5 to 8 mm/s, between the two.
///
/// `pgs` leaves a resting body ½gh of velocity, 2 cm/s with the defaults, which its next step takes away: under it
/// nothing of ordinary size falls asleep.
const QUIET_RADII_PER_SEC: f64 = crate::motion::CONTACT_REUSE_DISTANCE / QUIET_SECS;
/// And below what gravity gives in so many seconds: large bodies and weak gravity take their time to begin a fall.
const QUIET_FALL_SECS: f64 = 1e-3;
/// How far a quiet body may go, turning counted at the bounding radius, in radii.
const QUIET_RADII: f64 = 1e-3;
/// How far it may go in the whole window, over how far in its first half.
const GROWTH: f64 = 1.6;
/// So far, in radii, says nothing.
const NOISE_RADII: f64 = 1e-4;

/// Whether islands are worth a look after a step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct QuietTime {
    /// Some dynamic body is ripe for sleep.
    pub some: bool,
    /// One has been so since this step.
    pub newly: bool,
}

/// What bodies are pulled by.
#[derive(Clone, Copy, Debug)]
pub struct Pull {
    /// m/s²; 0 where there is none.
    pub gravity: f64,
    /// Stiffness of the spring that holds each body to a place, N/m; 0 where there is none.
    pub spring: f64,
}

/// How long bodies have been quiet; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct Quiet<R: Real> {
    /// Seconds; far below 0 while a body sleeps, so that it is not put to sleep once more.
    secs: Column<R>,
    /// Where it became quiet: x, y (metres), cos, sin.
    since: [Column<R>; 4],
    /// How far it went in the first half of its window, metres.
    first_half: Column<R>,
    /// 1 where it has been quiet for its window.
    ripe: Column<R>,
}

impl<R: Real> Default for Quiet<R> {
    fn default() -> Self {
        let zeros = || Column::new(R::ZERO);
        Self {
            secs: zeros(),
            since: [zeros(), zeros(), zeros(), zeros()],
            first_half: zeros(),
            ripe: zeros(),
        }
    }
}

impl<R: Real> Quiet<R> {
    pub(super) fn resize(&mut self, len: usize) {
        for column in self.since.iter_mut().chain([&mut self.secs, &mut self.first_half, &mut self.ripe]) {
            column.resize(len);
        }
    }

    /// The time of the body in a slot begins anew.
    pub(super) fn begin(&mut self, slot: usize) {
        if slot < self.secs.len() {
            (self.secs[slot], self.ripe[slot]) = (R::ZERO, R::ZERO);
        }
    }

    /// The times of all bodies begin anew.
    pub(super) fn begin_all(&mut self) {
        self.secs.padded_mut().fill(R::ZERO);
        self.ripe.padded_mut().fill(R::ZERO);
    }

    /// The body in a slot sleeps.
    pub(super) fn end(&mut self, slot: usize) {
        (self.secs[slot], self.ripe[slot]) = (-R::FAR, R::ZERO);
    }

    /// Has the body in a slot been quiet for its window?
    pub(super) fn is_ripe(&self, slot: usize) -> bool {
        self.ripe[slot] > R::ZERO
    }

    /// For how long the body in a slot has been quiet, seconds.
    pub(super) fn secs(&self, slot: usize) -> f64 {
        self.secs[slot].to_f64()
    }

    /// A step of `dt_secs` is done, of the bodies in `runs`.
    pub(super) fn accumulate<L: Lanes<Elem = R>>(
        &mut self,
        bodies: &Bodies<R>,
        runs: &[Range<usize>],
        pull: Pull,
        dt_secs: f64,
    ) -> QuietTime {
        let (zero, one, dt) = (L::zero(), L::one(), L::lit(dt_secs));
        let Pull { gravity, spring } = pull;
        let fall = if gravity > 0.0 { L::lit(QUIET_FALL_SECS * gravity) } else { L::splat(R::FAR) };
        let per_gravity = L::lit(if gravity > 0.0 { WINDOW * WINDOW / gravity } else { 0.0 });
        let shortest = L::lit(QUIET_SECS);
        // Half a period of mass and spring, 2π·√(m/k)/2.
        let half_period = L::lit(if spring > 0.0 { std::f64::consts::PI / spring.sqrt() } else { 0.0 });
        let columns = [&bodies.vx, &bodies.vy, &bodies.w, &bodies.radius, &bodies.inv_mass];
        let columns = columns.each(Column::lanes::<L>);
        let poses = [&bodies.x, &bodies.y, &bodies.c, &bodies.s].each(Column::lanes::<L>);
        let since = self.since.each_mut().map(Column::lanes_mut::<L>);
        let (times, ripes) = (self.secs.lanes_mut::<L>(), self.ripe.lanes_mut::<L>());
        let halves = self.first_half.lanes_mut::<L>();
        let mut quiet_time = QuietTime::default();
        for at in lanes_in::<L>(runs) {
            let [vx, vy, w, radius, inv_mass] = columns.each(|column| column[at]);
            let now = poses.each(|column| column[at]);
            let gone: [L; 4] = crate::each::indexed(|k| (now[k] - since[k][at]).abs());
            let path = (gone[0] + gone[1]) + radius * (gone[2] + gone[3]);
            let speed = (vx.abs() + vy.abs()) + radius * w.abs();
            let moves = zero.lt(inv_mass);
            let of_spring = half_period / L::select(moves, inv_mass, one).sqrt();
            let window = shortest.max((per_gravity * radius).sqrt()).max(of_spring);
            let (noise, most) = (L::lit(NOISE_RADII) * radius, L::lit(QUIET_RADII) * radius);
            let before = times[at];
            let in_first_half = (before + before).lt(window);
            let goes_on = in_first_half | before.lt(window) | path.le(noise.max(L::lit(GROWTH) * halves[at]));
            let slow = speed.lt((L::lit(QUIET_RADII_PER_SEC) * radius).min(fall));
            let quiet = slow & path.le(most) & goes_on;
            for k in 0..4 {
                since[k][at] = L::select(quiet, since[k][at], now[k]);
            }
            let first_half = L::select(in_first_half, halves[at].max(path), halves[at]);
            halves[at] = L::select(quiet, first_half, zero);
            let after = L::select(quiet, before + dt, zero);
            times[at] = after;
            let ripe = window.le(after) & quiet & path.le(noise.max(L::lit(GROWTH) * halves[at])) & moves;
            if ripe.any() {
                quiet_time.some = true;
                quiet_time.newly |= (ripe & ripes[at].le(zero)).any();
            }
            ripes[at] = L::select(ripe, one, zero);
        }
        quiet_time
    }
}
