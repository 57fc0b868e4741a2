//! `avbd`: augmented vertex block descent: each body in turn goes where inertia and its contacts pull it.
//!
//! Recipe of a substep: predict and move → [`Avbd::warm`] → [`ITERATIONS`] times { every body: [`Avbd::descend`], every
//! contact: [`Avbd::raise`] } → velocities from displacements → one more descent for what overlaps are left
//! ([`Avbd::settle`]).
//!
//! A body solves (M/h² + Σ k·JJᵀ)·Δx = −M/h²·(x − y) + Σ J·F by LDLᵀ, where x is its displacement in this substep, y the
//! predicted one, F = max(0, λ − k·C) along a normal and clamp(λ − k·C, ±μ·ΣF) along the tangent; k counts only
//! where F is not clamped. Contacts then take λ ← F and k ← k + β·|C|. Source: Giles, Diaz, Yuksel, Augmented Vertex
//! Block Descent (2025). Bodies are coloured, not contacts: no two of a colour touch, so that lanes of one colour descend
//! together and colours follow each other (Gauss–Seidel).
//!
//! * **C** = (1 − α)·s + Δs for an overlap s from before the substep, s + Δs for a gap: the overlap itself is taken
//!   away by the last descent (α = 0), after velocities are known, so that it gives none.
//! * **Without units.** k is in shares of m/h², m the effective mass at the contact's first point, h the substep: it
//!   begins at [`START`] and grows by [`GROWTH`] per length of the pair of |C|. m/h² is the body's own stiffness in the system
//!   above, so that START says how much more a contact counts than inertia, at every step, mass and size.
//! * **Warm start.** λ ← αγλ, k ← max(γk, START), kept with the pair: λ as an impulse, k in the fourth slot.
//! * **Velocities** are x/h, and y is h times the predicted velocity: first order, whatever the scheme. With the
//!   scheme's own displacement an impulse counts half, x/h twice, and an error of x in one step comes back
//!   doubled in the next: ten boxes exploded. Bodies on which nothing pushes keep the scheme's step to the bit.
//! * **Where k counts.** Along a normal also where the point pushes not here but where inertia wants the body; along a
//!   tangent that slips, the share that friction has over the slip. With k only where F is not clamped polygons
//!   exploded within 30 steps; with k everywhere a body that comes near a floor hangs above it, and none slides.
//!
//! # Chosen by
//! Overlap after 10 s, mm, at 1 substep of 1/60 s, α = γ = 0.99 (paper: 0.95, 0.99; γ = 0.5 lets stack/10 sink 1.8 mm):
//!
//! | START, GROWTH | stack/10 | stack/40 | heavy/100 | heavy/1000 | heavy/10000 | polygons/150 |
//! |---|---|---|---|---|---|---|
//! | 1, 100 | 0.85 | – | – | – | – | 1.5 |
//! | 10, 0 | 0.27 | – | – | – | – | 0.84 |
//! | **10, 100** | 0.27 | 4.1 | 1.2 | 9.4 | 49 | 0.42 |
//! | 10, 300 | 0.26 | 2.7 | 0.42 | 3.8 | 23 | 0.75 |
//! | 10, 1000 | 0.19 | – | – | – | – | thrown about |
//! | 10, 10,000 | 0.04 | – | – | – | – | thrown about |
//!
//! Stiffer carries more and converges less in ten rounds; the choice keeps a factor of ten from what throws bodies. Others:
//! [`super`]. The fading of λ, 2 % a step, keeps resting bodies moving at some mm/s. It loses energy: not
//! for e = 1. Each body moves by the forces it last saw: pairs that meet head on lose 4.5 % of their momentum.

mod batch;
mod seen;

use super::constraint::inverse;
use super::joint::Stiffness;
use super::scheme::{ContactSolver, Pairs, Substep};
use crate::column::Column;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::lanes::{Lanes, ROW, Real};
use crate::motion::Motion;
use crate::vec2::Vec2;

use seen::Seen;

/// Rounds of bodies and contacts per substep.
pub(super) const ITERATIONS: usize = 10;
/// Share of an overlap from before the substep that forces leave alone, α.
const KEEP: f64 = 0.99;
/// Share of the stiffness kept from step to step, γ.
const FADE: f64 = 0.99;
/// Least stiffness, in effective masses per h².
const START: f64 = 10.0;
/// Growth of the stiffness, in effective masses per h² and per length of the pair of |C|.
const GROWTH: f64 = 100.0;
/// Greatest stiffness, in effective masses per h².
const MOST: f64 = 1e6;
/// Colours of bodies; the last is for those that found none and descend alone.
const COLORS: usize = 64;

/// Bodies in batches, with their contacts; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct Avbd<L: Lanes> {
    /// Per slot: where its contacts begin in `contacts`.
    starts: Vec<u32>,
    /// Places of contacts, body by body.
    contacts: Vec<u32>,
    color: Vec<u8>,
    /// Slots of bodies by colour, `WIDTH` per batch.
    slots: Vec<u32>,
    batches: Vec<Batch>,
    /// Per visit `WIDTH` entries: place, slot of the other body, 1 where the body is B and −1 where it is A.
    place: Vec<u32>,
    other: Vec<u32>,
    side: Vec<L>,
    /// Predicted displacements per slot: by the scheme, and h times its velocity.
    ahead: Column<L::Elem>,
    target: Column<L::Elem>,
    /// Places that touch, padded to whole lanes, and their slots.
    pairs: [Vec<u32>; 3],
    /// The graph of contacts is not the one that batches were cut for.
    pub(super) outdated: bool,
}

/// The visits of one batch of bodies.
#[derive(Clone, Copy, Debug)]
struct Batch {
    start: usize,
    end: usize,
}

impl<L: Lanes> Default for Avbd<L> {
    fn default() -> Self {
        Self {
            starts: Vec::new(),
            contacts: Vec::new(),
            color: Vec::new(),
            slots: Vec::new(),
            batches: Vec::new(),
            place: Vec::new(),
            other: Vec::new(),
            side: Vec::new(),
            ahead: Column::new(L::Elem::ZERO),
            target: Column::new(L::Elem::ZERO),
            pairs: Default::default(),
            outdated: true,
        }
    }
}

/// What a substep of one length multiplies by, in lanes.
#[derive(Clone, Copy, Debug)]
pub(super) struct SubstepCoefficients<L> {
    /// 1/h², 1/s².
    pub(super) per_h2: L,
    /// λ per impulse: 1/h.
    pub(super) force: L,
    /// Impulse per λ.
    pub(super) impulse: L,
    /// Velocity per displacement, 1/s.
    pub(super) velocity: L,
    /// h, s.
    pub(super) h: L,
    /// Prediction less acceleration: 2 where bodies move by the mean velocity, else 1.
    pub(super) guess: L,
}

impl<L: Lanes> SubstepCoefficients<L> {
    /// Of substeps of `h_secs`; `share` is what an impulse changes the displacement by over h times the velocity.
    pub(super) fn new(h_secs: f64, share: f64) -> Self {
        Self {
            per_h2: L::lit(1.0 / (h_secs * h_secs)),
            force: L::lit(1.0 / h_secs),
            impulse: L::lit(h_secs),
            velocity: L::lit(1.0 / h_secs),
            h: L::lit(h_secs),
            guess: L::lit(1.0 / share),
        }
    }
}

impl<L: Lanes> Avbd<L> {
    /// All of a substep, after bodies moved by the prediction.
    pub(super) fn settle(
        &mut self,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
        coefficients: &SubstepCoefficients<L>,
    ) {
        self.warm(manifolds, motion, coefficients);
        let keep = L::lit(KEEP);
        for _ in 0..ITERATIONS {
            self.descend(manifolds, motion, coefficients, keep);
            self.raise(manifolds, motion, coefficients, keep);
        }
        self.find_velocities(motion, coefficients);
        self.descend(manifolds, motion, coefficients, L::zero());
        self.release(motion);
        self.follow(manifolds, motion, coefficients);
    }

    /// Fades λ and k, and sets bodies on their way without acceleration: resting ones begin where they end.
    fn warm(
        &mut self,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
        coefficients: &SubstepCoefficients<L>,
    ) {
        for slots in self.slots.chunks(L::WIDTH) {
            let ahead = L::gather_fours(motion.moved.fours(), slots);
            let velocity = L::gather_fours(motion.velocity.fours(), slots);
            L::scatter_fours(ahead, self.ahead.fours_mut(), slots);
            let mut target = ahead;
            let mut guess = ahead;
            for k in 0..3 {
                let by_velocity = velocity[k] * coefficients.h;
                target[k] = by_velocity;
                guess[k] = ahead[k] + (coefficients.guess - L::one()) * (ahead[k] - by_velocity);
            }
            L::scatter_fours(target, self.target.fours_mut(), slots);
            L::scatter_fours(guess, motion.moved.fours_mut(), slots);
        }
        let [places, a, b] = &self.pairs;
        for at in (0..places.len()).step_by(L::WIDTH) {
            let (place, a, b) = (&places[at..at + L::WIDTH], &a[at..at + L::WIDTH], &b[at..at + L::WIDTH]);
            let least = L::lit(START) * stiffness(manifolds, motion, place, [a, b], coefficients).0;
            let [j0, j1, jt, k] = L::gather_fours(manifolds.impulses(), place);
            let fade = L::lit(KEEP * FADE);
            let k = least.max(k * L::lit(FADE));
            L::scatter_fours([j0 * fade, j1 * fade, jt * fade, k], manifolds.impulses_mut(), place);
        }
    }

    /// Every body once, colour by colour.
    fn descend(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
        coefficients: &SubstepCoefficients<L>,
        keep: L,
    ) {
        for (batch, slots) in self.batches.iter().zip(self.slots.chunks(L::WIDTH)) {
            let [inv_mass, inv_inertia, ..] = L::gather_fours(motion.inverse_masses.fours(), slots);
            let x = L::gather_fours(motion.moved.fours(), slots);
            let y = L::gather_fours(self.target.fours(), slots);
            let (mass, inertia) =
                (coefficients.per_h2 * inverse(inv_mass), coefficients.per_h2 * inverse(inv_inertia));
            // Lower triangle of H: xx, xy, yy, xθ, yθ, θθ.
            let mut h = [mass, L::zero(), mass, L::zero(), L::zero(), inertia];
            let mut pushed = L::zero();
            let to_y: [L; 3] = crate::each::indexed(|k| y[k] - x[k]);
            let mut f = [mass * (y[0] - x[0]), mass * (y[1] - x[1]), inertia * (y[2] - x[2])];
            for visit in batch.start..batch.end {
                let lanes = visit * L::WIDTH..(visit + 1) * L::WIDTH;
                let seen = Seen::<L>::gather(manifolds, &self.place[lanes.clone()], coefficients);
                let theirs = L::gather_fours(motion.moved.fours(), &self.other[lanes]);
                let side = self.side[visit];
                let is_b = L::zero().lt(side);
                let pick = |a: L, b: L| L::select(is_b, b, a);
                let a: [L; 4] = crate::each::indexed(|k| pick(x[k], theirs[k]));
                let b: [L; 4] = crate::each::indexed(|k| pick(theirs[k], x[k]));
                let c = seen.violation(&a, &b, keep);
                let (force, holds) = seen.forces(&c);
                pushed = pushed + (force[0] + force[1]);
                let tangent = -seen.normal.right();
                for (k, axis) in [seen.normal, seen.normal, tangent].into_iter().enumerate() {
                    let lever = pick(seen.levers[k][0], seen.levers[k][1]);
                    let (jx, jy, jw) = (axis.x * side, axis.y * side, lever * side);
                    f = [f[0] + jx * force[k], f[1] + jy * force[k], f[2] + jw * force[k]];
                    let counts = if k < 2 {
                        let on_the_way = (jx * to_y[0] + jy * to_y[1]) + jw * to_y[2];
                        seen.presses(k, c[k].min(c[k] + on_the_way))
                    } else {
                        seen.drags(force[0] + force[1], c[2], holds[2])
                    };
                    let stiff = seen.dual[3] * counts;
                    let (sx, sy, sw) = (stiff * jx, stiff * jy, stiff * jw);
                    h = [
                        h[0] + sx * jx,
                        h[1] + sx * jy,
                        h[2] + sy * jy,
                        h[3] + sx * jw,
                        h[4] + sy * jw,
                        h[5] + sw * jw,
                    ];
                }
            }
            let step = solve(h, f);
            let next = [x[0] + step[0], x[1] + step[1], x[2] + step[2], pushed];
            L::scatter_fours(next, motion.moved.fours_mut(), slots);
        }
    }

    /// λ takes the force, k grows where it is not clamped.
    fn raise(
        &self,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
        coefficients: &SubstepCoefficients<L>,
        keep: L,
    ) {
        let [places, a, b] = &self.pairs;
        for at in (0..places.len()).step_by(L::WIDTH) {
            let (place, a, b) = (&places[at..at + L::WIDTH], &a[at..at + L::WIDTH], &b[at..at + L::WIDTH]);
            let seen = Seen::<L>::gather(manifolds, place, coefficients);
            let moved = [a, b].each(|slots| L::gather_fours(motion.moved.fours(), slots));
            let c = seen.violation(&moved[0], &moved[1], keep);
            let (force, counts) = seen.forces(&c);
            let (unit, length) = stiffness(manifolds, motion, place, [a, b], coefficients);
            let miss = (c[0].abs() * counts[0]).max(c[1].abs() * counts[1]).max(c[2].abs() * counts[2]);
            let k = seen.dual[3] + L::lit(GROWTH) * unit * (miss / length);
            let k = k.min(L::lit(MOST) * unit);
            let [j0, j1, jt] = force.each(|force| force * coefficients.impulse);
            L::scatter_fours([j0, j1, jt, k], manifolds.impulses_mut(), place);
        }
    }

    /// Velocities of bodies that touch, by what contacts moved them by.
    fn find_velocities(&self, motion: &mut Motion<L::Elem>, coefficients: &SubstepCoefficients<L>) {
        for slots in self.slots.chunks(L::WIDTH) {
            let (x, y) =
                (L::gather_fours(motion.moved.fours(), slots), L::gather_fours(self.target.fours(), slots));
            let mut velocity = L::gather_fours(motion.velocity.fours(), slots);
            for k in 0..3 {
                let change = (x[k] - y[k]) * coefficients.velocity;
                velocity[k] = velocity[k] + L::select(L::zero().lt(x[3]), change, L::zero());
            }
            L::scatter_fours(velocity, motion.velocity.fours_mut(), slots);
        }
    }

    /// Bodies on which nothing pushes move as the scheme has it, to the bit.
    fn release(&self, motion: &mut Motion<L::Elem>) {
        for slots in self.slots.chunks(L::WIDTH) {
            let (x, ahead) =
                (L::gather_fours(motion.moved.fours(), slots), L::gather_fours(self.ahead.fours(), slots));
            let pushed = L::zero().lt(x[3]);
            let moved = crate::each::indexed(|k| L::select(pushed, x[k], ahead[k]));
            L::scatter_fours(moved, motion.moved.fours_mut(), slots);
        }
    }

    /// Brings the gaps up to date.
    fn follow(
        &self,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
        coefficients: &SubstepCoefficients<L>,
    ) {
        let [places, a, b] = &self.pairs;
        for at in (0..places.len()).step_by(L::WIDTH) {
            let (place, a, b) = (&places[at..at + L::WIDTH], &a[at..at + L::WIDTH], &b[at..at + L::WIDTH]);
            let seen = Seen::<L>::gather(manifolds, place, coefficients);
            let moved = [a, b].each(|slots| L::gather_fours(motion.moved.fours(), slots));
            let change = seen.change(&moved[0], &moved[1]);
            let [s0, s1, friction, restitution] = L::gather_fours(manifolds.gaps(), place);
            let gaps = [s0 + change[0], s1 + change[1] * seen.exists, friction, restitution];
            L::scatter_fours(gaps, manifolds.gaps_mut(), place);
        }
    }
}

/// m/h² of the contacts' first points, N/m, and the pairs' lengths, metres.
#[inline(always)]
fn stiffness<L: Lanes>(
    manifolds: &Manifolds<L::Elem>,
    motion: &Motion<L::Elem>,
    places: &[u32],
    ends: [&[u32]; 2],
    coefficients: &SubstepCoefficients<L>,
) -> (L, L) {
    let row: [L; ROW] = L::gather_rows(manifolds.geometry(), places);
    let [ma, mb] = ends.each(|slots| L::gather_fours(motion.inverse_masses.fours(), slots));
    let (normal, arm) = (Vec2::new(row[0], row[1]), Vec2::new(row[2], row[3]));
    let (la, lb) = (arm.cross(normal), (arm - Vec2::new(row[6], row[7])).cross(normal));
    let unit = coefficients.per_h2 * inverse((ma[0] + mb[0]) + (ma[1] * (la * la) + mb[1] * (lb * lb)));
    (unit, ma[2].min(mb[2]))
}

/// Δx of H·Δx = f by LDLᵀ; 0 for padding, whose H is 0.
#[inline(always)]
fn solve<L: Lanes>([xx, xy, yy, xw, yw, ww]: [L; 6], f: [L; 3]) -> [L; 3] {
    let d0 = inverse(xx);
    let (l10, l20) = (xy * d0, xw * d0);
    let d1 = inverse(yy - l10 * xy);
    let v21 = yw - l20 * xy;
    let l21 = v21 * d1;
    let d2 = inverse(ww - l20 * xw - l21 * v21);
    let z1 = f[1] - l10 * f[0];
    let z2 = f[2] - l20 * f[0] - l21 * z1;
    let w = z2 * d2;
    let y = z1 * d1 - l21 * w;
    let x = f[0] * d0 - l10 * y - l20 * w;
    [x, y, w]
}

/// The solver.
#[derive(Debug)]
pub(super) struct Blocks;

impl<L: Lanes> ContactSolver<L> for Blocks {
    fn solve(&self, substep: &mut Substep<'_, L>) {
        // Bodies move before contacts are seen.
        substep.push_joints();
    }

    fn relax(&self, substep: &mut Substep<'_, L>, pairs: Pairs<'_, L>) {
        let Pairs { bodies, manifolds, avbd } = pairs;
        if std::mem::take(&mut avbd.outdated) {
            avbd.cut(bodies, manifolds);
        }
        let (h_secs, share) = (substep.h_secs(), substep.share());
        avbd.settle(manifolds, substep.motion, &SubstepCoefficients::new(h_secs, share));
        if let Some(joints) = &mut substep.joints {
            let (rows, moved) = (substep.motion.velocity.fours_mut(), substep.motion.moved.fours());
            joints.relax(rows, moved, &Stiffness::soft(h_secs, share));
        }
    }
}
