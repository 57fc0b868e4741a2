//! A step in progress: what bodies have moved so far, one substep's prediction, and the rows solvers work on. What
//! integration leaves for the stages around it, so that none of them imports another's work.

mod blocks;
mod near;
mod plan;
mod span;

use std::ops::Range;

use crate::body::Bodies;
use crate::column::{BLOCK, Column, PAD};
use crate::force::acceleration;
use crate::lanes::{Lanes, Real};
use crate::workers::{Parts, Workers};

pub(crate) use blocks::*;
pub(crate) use near::{Near, TOUCH};
pub use plan::Plan;
pub(crate) use span::*;

/// Path over the bounding radius after which a body's manifolds are found anew: linear prediction of its gaps
/// errs by half the square of this at most, times the radius.
pub const CONTACT_REUSE_DISTANCE: f64 = 4e-3;

/// What a step's passes left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Skipped {
    /// Bodies whose scheme collapsed to its closed form.
    pub closed_form: u64,
    /// Bodies whose attitude was not touched.
    pub rotation: u64,
    /// Pairs that kept their manifold.
    pub manifolds: u64,
    /// Bodies that were advanced beside their scheme, which could not follow.
    pub stiff: u64,
}

/// A body that moved further in a step than it may unseen: where it began, and how far it went. 32 B in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fast<R> {
    /// Its slot.
    pub slot: u32,
    /// x, y (metres), cos, sin of the attitude as the step began.
    pub start: [R; 4],
    /// x, y (metres), angle (rad).
    pub moved: [R; 3],
}

/// The fast bodies of a step, by slot; `None` where nobody asks.
pub(crate) type FastBodies<'a, R> = Option<&'a mut Vec<Fast<R>>>;

/// Columns of a step in progress: what bodies moved so far, and one substep's prediction.
#[derive(Clone, Debug)]
pub struct Motion<R: Real> {
    /// Displacement since the step began, the last substep's left out: x, y (metres), angle (rad).
    pub(crate) total: [Column<R>; 3],
    /// Velocity after the scheme, before contacts: x, y, angular.
    pub(crate) free: [Column<R>; 3],
    /// The scheme's displacement in this substep: x, y, angle.
    pub(crate) ahead: [Column<R>; 3],
    /// Rows of four per slot, what a solver gathers and scatters: vx, vy, ω, 1/m; before the first substep what
    /// the warm start adds to velocities; during a push the moving velocity.
    pub velocity: Column<R>,
    /// Rows of four per slot: the last substep's displacement x, y, angle, –.
    pub moved: Column<R>,
    /// Rows of four per slot: 1/m, 1/I, what lengths are shares of ([`Bodies::length`]), –.
    pub inverse_masses: Column<R>,
    /// Rows of four per slot: acceleration at the step's beginning x, y, angular, inverse mass; only where something bounces.
    pub acceleration: Column<R>,
    /// Path since the body last moved, turning counted at the bounding radius, metres.
    pub(crate) drift: Column<R>,
    /// Slots of bodies whose manifolds are to be found anew.
    pub has_moved: Vec<bool>,
    /// What the next step has to expect.
    pub outlook: Outlook,
    /// The slots a step goes over: from multiples of [`PAD`] on, ascending. In the others nothing moves.
    pub runs: Vec<Range<usize>>,
    /// Which substep group moves now.
    pub group: Group<R>,
    /// Who does a step's work, and what they share out.
    pub(crate) workers: Workers,
    pub(crate) parts: Parts,
    /// Memory for fast bodies, per part.
    pub(crate) fast: Vec<Vec<Fast<R>>>,
}

/// What the speeds and paths of a step say of the next.
#[derive(Clone, Copy, Debug)]
pub struct Outlook {
    /// Is there a body whose manifolds are to be found anew?
    pub any_has_moved: bool,
    /// May two bodies close more than the gap that contacts are found within?
    pub needs_speculative_margin: bool,
    /// May two bodies meet fast enough to bounce?
    pub may_bounce: bool,
}

impl Outlook {
    /// Not 0 where bodies have moved, are so fast, may bounce.
    pub(crate) fn note(&mut self, [moved, speculative, bouncing]: [u32; 3]) {
        self.any_has_moved = moved != 0;
        (self.needs_speculative_margin, self.may_bounce) = (speculative != 0, bouncing != 0);
    }
}

/// The substep group whose bodies move.
#[derive(Clone, Debug)]
pub struct Group<R: Real> {
    /// Which group each slot has.
    pub of_slot: Column<R>,
    /// The one; all bodies move where it is `None`.
    pub current: Option<R>,
}

/// Where a step's warm start is found before its first substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Warm {
    /// The step goes on: rows hold velocities, and what contacts changed them by since the last prediction is
    /// the warm start.
    Onward,
    /// A step begins as the last one ended: like [`Warm::Onward`], displacements start at 0.
    Carried,
    /// A step begins and rows hold what was summed over contacts.
    Summed,
}

impl<R: Real> Default for Motion<R> {
    fn default() -> Self {
        let zeros = || Column::new(R::ZERO);
        let three = || std::array::from_fn(|_| zeros());
        Self {
            total: three(),
            free: three(),
            ahead: three(),
            velocity: zeros(),
            moved: zeros(),
            inverse_masses: zeros(),
            acceleration: zeros(),
            drift: zeros(),
            has_moved: Vec::new(),
            outlook: Outlook { any_has_moved: true, needs_speculative_margin: true, may_bounce: true },
            runs: Vec::new(),
            group: Group { of_slot: Column::new(R::ZERO), current: None },
            workers: Workers::ALONE,
            parts: Parts::default(),
            fast: Vec::new(),
        }
    }
}

/// Which lanes a pass over one substep group changes: its bodies and, in all, those without mass. The others keep their rows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chosen<L: Lanes> {
    pub(crate) moves: L::Mask,
    pub(crate) massless: L::Mask,
}

impl<L: Lanes> Chosen<L> {
    #[inline(always)]
    pub(crate) fn new(of_slot: &Column<L::Elem>, group: L::Elem, at: usize, inv_mass: L) -> Self {
        let massless = inv_mass.le(L::zero());
        Self { moves: of_slot.lanes::<L>()[at].equals(L::splat(group)) | massless, massless }
    }
}

impl<R: Real> Motion<R> {
    /// Makes room for the bodies and notes their masses; allocates only when the world grows.
    pub fn resize(&mut self, bodies: &Bodies<R>) {
        let len = bodies.len();
        for column in self.total.iter_mut().chain(&mut self.free).chain(&mut self.ahead) {
            column.resize(len);
        }
        self.drift.resize(len);
        // A row for every lane of the last block, padding included.
        let padded = len.next_multiple_of(PAD);
        for rows in [&mut self.velocity, &mut self.moved, &mut self.inverse_masses, &mut self.acceleration] {
            rows.resize(padded * 4);
        }
        self.has_moved.resize(padded, false);
        self.go_over_all(bodies);
    }

    /// A step goes over all bodies.
    pub fn go_over_all(&mut self, bodies: &Bodies<R>) {
        let len = bodies.len();
        for (slot, row) in self.inverse_masses.fours_mut()[..len].iter_mut().enumerate() {
            *row = [bodies.inv_mass[slot], bodies.inv_inertia[slot], bodies.length(slot), R::ZERO];
        }
        self.runs.clear();
        self.runs.push(0..len);
    }

    /// A step goes over the blocks of [`PAD`] slots in which something is awake. Bodies that sleep there have no
    /// mass, so that nothing moves them; the rows of the other blocks become those of bodies at rest.
    pub fn go_over_awake(&mut self, bodies: &Bodies<R>, awake: &[bool], asleep: &[bool]) {
        self.go_over_all(bodies);
        self.runs.clear();
        let len = bodies.len();
        for start in (0..len).step_by(PAD) {
            let end = (start + PAD).min(len);
            if !awake[start..end].contains(&true) {
                for rows in [&mut self.velocity, &mut self.moved, &mut self.acceleration] {
                    rows.fours_mut()[start..start + PAD].fill([R::ZERO; 4]);
                }
            } else if let Some(last) = self.runs.last_mut().filter(|last| last.end == start) {
                last.end = end;
            } else {
                self.runs.push(start..end);
            }
        }
        let rows = self.inverse_masses.fours_mut()[..len].iter_mut().zip(asleep);
        rows.filter(|(_, asleep)| **asleep).for_each(|(row, _)| [row[0], row[1]] = [R::ZERO; 2]);
    }

    /// Bodies may be as fast as they like: something has changed.
    pub fn assume_fast_bodies(&mut self) {
        (self.outlook.needs_speculative_margin, self.outlook.may_bounce) = (true, true);
    }

    /// All bodies begin to drift anew.
    pub fn forget_drift(&mut self) {
        self.drift.padded_mut().fill(R::ZERO);
    }

    /// Was what the scheme predicted for a slot, before contacts, finite: where a non-finite state began.
    pub fn predicted_finite(&self, slot: usize) -> bool {
        self.free.iter().chain(&self.ahead).all(|column| column[slot].is_finite())
    }

    /// The speed that the scheme predicted for a slot in the last substep, before contacts, m/s.
    pub fn predicted_speed(&self, slot: usize) -> f64 {
        let [x, y, _] = &self.free;
        x[slot].to_f64().hypot(y[slot].to_f64())
    }

    /// Velocities into the solver's rows, and accelerations: what a bounce is reckoned from.
    pub fn load<L: Lanes<Elem = R>>(&mut self, plan: &Plan<'_, R>, bodies: &Bodies<R>) {
        if plan.couples() && L::WIDTH < R::Widest::WIDTH {
            return self.load::<R::Widest>(plan, bodies);
        }
        for (at, _) in blocks_in::<L>(&self.runs) {
            let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
            let v = vectors::<L>(block(&bodies.vx, at), block(&bodies.vy, at));
            let w = block::<L>(&bodies.w, at);
            let matter = matter(bodies, at);
            let pull = acceleration(plan.fields, matter, 0.0, &x, &v);
            let alpha = angular_acceleration::<L>(bodies, at);
            for i in 0..BLOCK {
                let spin = alpha.map_or(L::zero(), |a| a[i]);
                store_four::<L>(&mut self.velocity, at + i, [v[i].x, v[i].y, w[i], matter.inv_mass[i]]);
                let row = [pull[i].x, pull[i].y, spin, matter.inv_mass[i]];
                store_four::<L>(&mut self.acceleration, at + i, row);
            }
        }
    }

    /// Rows of no velocity: what a warm start sums into.
    pub fn clear_rows(&mut self) {
        for run in &self.runs {
            let slots = run.start..run.end.next_multiple_of(PAD);
            let rows = self.velocity.fours_mut()[slots.clone()].iter_mut();
            for (row, matter) in rows.zip(&self.inverse_masses.fours()[slots]) {
                *row = [R::ZERO, R::ZERO, R::ZERO, matter[0]];
            }
        }
    }
}
