//! Smooth motion: one scheme per file, and the three passes a step makes over the columns.
//!
//! A scheme turns (x, v) of a block of bodies into a displacement and a new velocity. Positions are not
//! touched inside a step: displacements are summed in the `moved` columns and added once at its end,
//! which is what keeps precision far from the origin.
//!
//! Next to contacts, a substep moves a body by the scheme's displacement plus h times what contacts changed its
//! moving velocity by (see [`crate::solve::soft`]): where no contact acts the difference is exactly zero, so a
//! body that touches nothing moves as if there were no solver, to the bit.
//!
//! | pass | reads | writes |
//! |---|---|---|
//! | [`fly`] (no contact in the world) | x v θ, fields | x v θ |
//! | [`predict`] (per substep) | x v moved, fields, rows | rows, free velocity, displacement |
//! | [`advance`] (per substep) | rows, free velocity, displacement | rows, displacement rows |
//! | [`finish`] (per step) | rows, displacements | v, x, attitude, drift |
//!
//! All but `fly` go over the blocks of [`Motion::runs`]: the others hold nothing that moves.
//!
//! Where fields answer faster than a substep can follow, [`Stiff`] advances bodies instead of their scheme.
//!
//! Drag, springs and the other fields act at the centroid: attitude follows from constant torque alone.
//! `moved` sums one angle per step, turned exactly by [`Rot::turned`].

mod explicit_euler;
mod finish;
mod position_verlet;
mod rk4;
mod scheme;
mod semi_implicit_euler;
mod stiff;
mod velocity_verlet;
mod yoshida4;

use crate::body::Bodies;
use crate::column::{BLOCK, Column};
use crate::each::Each as _;
use crate::force::{Matter, acceleration};
use crate::lanes::{LaneMask, Lanes, Real};
use crate::motion::{
    Block, Chosen, Common, FastBodies, Motion, Plan, Skipped, Span, Warm, angular_acceleration, block,
    block_starts, four_of, lanes_of, matter, put_four, vectors,
};
use crate::settings::{Integrator, MOST_THREADS, Skip};
use crate::vec2::Vec2;

pub(crate) use finish::finish;
pub(crate) use scheme::{Advance, Scheme, Step};
pub(crate) use stiff::Stiff;

use finish::{push_fast, turn};
use scheme::{ClosedForm, along, drift};

/// Moves a block of bodies whose positions are finer than their columns. By value: a reference would keep blocks that
/// nobody hands over here in memory too.
#[cold]
#[inline(never)]
fn move_finely<L: Lanes>(bodies: &mut Bodies<L::Elem>, at: usize, moved: Block<L>) {
    for (i, moved) in moved.iter().enumerate() {
        bodies.move_lanes(at + i, [moved.x, moved.y]);
    }
}

/// |Δx| + |Δy| + R·|Δθ|: no point of a body goes further.
#[inline(always)]
fn path_of<L: Lanes>(moved: [L; 3], radius: L) -> L {
    (moved[0].abs() + moved[1].abs()) + radius * moved[2].abs()
}

/// The widest lanes of a scalar: see [`Plan::couples`].
type Widest<L> = <<L as Lanes>::Elem as Real>::Widest;

/// Runs `$pass::<L, Scheme>` for the scheme a plan names: the one place where the enum is matched.
macro_rules! with_scheme {
    ($plan:expr, $pass:ident ( $($arg:expr),* )) => {
        if $plan.collapses() {
            $pass::<L, ClosedForm>($($arg),*)
        } else {
            match $plan.integrator {
                Integrator::ExplicitEuler => $pass::<L, explicit_euler::ExplicitEuler>($($arg),*),
                Integrator::SemiImplicitEuler => $pass::<L, semi_implicit_euler::SemiImplicitEuler>($($arg),*),
                Integrator::VelocityVerlet => $pass::<L, velocity_verlet::VelocityVerlet>($($arg),*),
                Integrator::PositionVerlet => $pass::<L, position_verlet::PositionVerlet>($($arg),*),
                Integrator::Rk4 => $pass::<L, rk4::Rk4>($($arg),*),
                Integrator::Yoshida4 => $pass::<L, yoshida4::Yoshida4>($($arg),*),
            }
        }
    };
}

/// A whole step of bodies that touch nothing: one pass over the columns. Notes the fast ones in `fast`.
pub fn fly<L: Lanes>(
    plan: &Plan<'_, L::Elem>,
    bodies: &mut Bodies<L::Elem>,
    mut fast: FastBodies<'_, L::Elem>,
) -> Skipped {
    if plan.couples() && L::WIDTH < <Widest<L> as Lanes>::WIDTH {
        return fly::<Widest<L>>(plan, bodies, fast);
    }
    let mut skipped = with_scheme!(plan, fly_with(plan, bodies, &mut fast));
    skipped.closed_form = if plan.collapses() { bodies.live() as u64 } else { 0 };
    skipped
}

/// One substep's prediction: velocities and displacements as if nothing touched, and the solver's rows with
/// the warm start applied.
pub fn predict<L: Lanes>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
    start: Warm,
) -> Skipped {
    if plan.couples() && L::WIDTH < <Widest<L> as Lanes>::WIDTH {
        return predict::<Widest<L>>(plan, bodies, motion, start);
    }
    with_scheme!(plan, predict_with(plan, bodies, motion, start));
    Skipped { closed_form: if plan.collapses() { bodies.live() as u64 } else { 0 }, ..Skipped::default() }
}

fn fly_with<L: Lanes, S: Scheme>(
    plan: &Plan<'_, L::Elem>,
    bodies: &mut Bodies<L::Elem>,
    fast: &mut FastBodies<'_, L::Elem>,
) -> Skipped {
    let step = Step::new(plan.h_secs);
    let may_skip_rotation = plan.skips.has(Skip::Rotation);
    let is_fine = bodies.fine.is_some();
    let mut skipped = Skipped::default();
    for at in block_starts::<L>(0..bodies.len()) {
        let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
        let mut v = vectors::<L>(block(&bodies.vx, at), block(&bodies.vy, at));
        let matter = matter(bodies, at);
        let mut moved = [Vec2::zero(); BLOCK];
        for substep in 0..plan.substeps {
            let here = crate::each::indexed(|i| x[i] + moved[i]);
            let since = |c: f64| plan.since_secs + plan.h_secs * (f64::from(substep) + c);
            let next =
                S::advance(step, &here, &v, |x, v, c| acceleration(plan.fields, matter, since(c), x, v));
            moved = crate::each::indexed(|i| moved[i] + next.displacement[i]);
            v = next.velocity;
        }
        let mut w = *block::<L>(&bodies.w, at);
        let alpha = angular_acceleration::<L>(bodies, at);
        let still = may_skip_rotation && alpha.is_none() && !w.iter().any(|w| (!w.equals(L::zero())).any());
        let mut angle = [L::zero(); BLOCK];
        if !still {
            for _ in 0..plan.substeps {
                for i in 0..BLOCK {
                    let (turn, next) = S::spin(step, w[i], alpha.map_or(L::zero(), |a| a[i]));
                    angle[i] = angle[i] + turn;
                    w[i] = next;
                }
            }
        }
        if let Some(fast) = fast {
            for i in 0..BLOCK {
                let moved = [moved[i].x, moved[i].y, angle[i]];
                let is_fast =
                    bodies.core.lanes::<L>()[at + i].lt(path_of(moved, bodies.radius.lanes::<L>()[at + i]));
                if is_fast.any() {
                    let pose = [&mut bodies.x, &mut bodies.y, &mut bodies.c, &mut bodies.s];
                    let pose = pose.map(Column::lanes_mut::<L>);
                    push_fast(&pose, (0, at + i), is_fast.bits(), moved, fast);
                }
            }
        }
        if still {
            skipped.rotation += bodies.live_in(at * L::WIDTH..(at + BLOCK) * L::WIDTH) as u64;
        } else {
            let attitudes =
                [&mut bodies.c, &mut bodies.s].map(|column| &mut column.lanes_mut::<L>()[at..at + BLOCK]);
            turn(attitudes, &angle);
            for (i, spin) in bodies.w.lanes_mut::<L>()[at..at + BLOCK].iter_mut().enumerate() {
                *spin = w[i];
            }
        }
        if is_fine {
            move_finely(bodies, at, moved);
        } else {
            store_block(&mut bodies.x, &mut bodies.y, at, &crate::each::indexed(|i| x[i] + moved[i]));
        }
        store_block(&mut bodies.vx, &mut bodies.vy, at, &v);
    }
    skipped
}

/// A block of bodies as a substep begins.
struct Begun<L: Lanes> {
    /// From the rows, where bodies that sleep have none.
    inv_mass: [L; BLOCK],
    /// vx, vy, ω.
    state: [[L; 3]; BLOCK],
    /// What contacts are expected to change them by.
    warm: [[L; 3]; BLOCK],
    /// Displacement since the step began.
    total: [[L; 3]; BLOCK],
}

impl<L: Lanes> Default for Begun<L> {
    #[inline(always)]
    fn default() -> Self {
        let zeros = [[L::zero(); 3]; BLOCK];
        Self { inv_mass: [L::zero(); BLOCK], state: zeros, warm: zeros, total: zeros }
    }
}

impl<L: Lanes> Begun<L> {
    /// `start`: of a block of the part.
    #[inline(always)]
    fn read(
        &mut self,
        carries: bool,
        bodies: &Bodies<L::Elem>,
        part: &Span<'_, L>,
        start: usize,
        from: Warm,
    ) {
        let Self { inv_mass, state, warm, total } = self;
        for i in 0..BLOCK {
            let at = start + i;
            let [px, py, pw, held] = four_of::<L>(part.velocity, at);
            inv_mass[i] = held;
            state[i] = [px, py, pw];
            if from == Warm::Summed {
                warm[i] = state[i];
            } else if carries {
                for k in 0..3 {
                    warm[i][k] = state[i][k] - part.free[k][at];
                }
            }
            if from == Warm::Onward {
                let last = four_of::<L>(part.moved, at);
                for k in 0..3 {
                    total[i][k] = part.total[k][at] + last[k];
                }
            } else {
                let slot = part.first + at;
                state[i] = [bodies.vx.lanes()[slot], bodies.vy.lanes()[slot], bodies.w.lanes()[slot]];
            }
        }
    }
}

fn predict_with<L: Lanes, S: Scheme>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
    from: Warm,
) {
    motion.each_span::<L, _>(plan.workers, &mut [(); MOST_THREADS], |common, part, ()| {
        predict_span::<L, S>(plan, bodies, common, part, from);
    });
}

fn predict_span<L: Lanes, S: Scheme>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    common: Common<'_, L::Elem>,
    part: &mut Span<'_, L>,
    from: Warm,
) {
    // Whole blocks, padding and all: left off at its end, a loop over one was code at width 1 that valgrind 3.19 does not
    // know (a `vmovq` between registers, of the form for memory).
    for start in part.own(common.runs).flat_map(block_starts::<L>) {
        let mut begun = Begun::default();
        begun.read(plan.carries, bodies, part, start, from);
        let chosen = common.group.current.map(|substep_group| -> [Chosen<L>; BLOCK] {
            let at = part.first + start;
            crate::each::indexed(|i| {
                Chosen::new(&common.group.of_slot, substep_group, at + i, begun.inv_mass[i])
            })
        });
        for (warm, chosen) in begun.warm.iter_mut().zip(chosen.iter().flatten()) {
            // What drives bodies without mass in one substep group is no warm start in the next.
            *warm = warm.each(|warm| L::select(chosen.massless, L::zero(), warm));
        }
        predict_block::<L, S>(plan, bodies, (&begun, chosen), part, start);
    }
}

/// Predicts the bodies of one block of a part.
#[inline(always)]
fn predict_block<L: Lanes, S: Scheme>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    (begun, chosen): (&Begun<L>, Option<[Chosen<L>; BLOCK]>),
    part: &mut Span<'_, L>,
    start: usize,
) {
    let step = Step::new(plan.h_secs);
    let (per_h, share) = (L::lit(1.0 / plan.h_secs), L::lit(plan.impulse_share()));
    let Begun { inv_mass, state, warm, total } = begun;
    let at = part.first + start;
    let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
    let x = crate::each::indexed(|i| x[i] + Vec2::new(total[i][0], total[i][1]));
    let v = crate::each::indexed(|i| Vec2::new(state[i][0], state[i][1]));
    let matter = Matter { inv_mass, ..matter(bodies, at) };
    let since = |c: f64| plan.since_secs + plan.h_secs * c;
    let next = S::advance(step, &x, &v, |x, v, c| acceleration(plan.fields, matter, since(c), x, v));
    let alpha = angular_acceleration::<L>(bodies, at);
    for i in 0..BLOCK {
        let at = start + i;
        let alpha = alpha.map_or(L::zero(), |a| L::select(inv_mass[i].le(L::zero()), L::zero(), a[i]));
        let (turn, spin) = S::spin(step, state[i][2], alpha);
        let free = [next.velocity[i].x, next.velocity[i].y, spin];
        let ahead = [next.displacement[i].x, next.displacement[i].y, turn];
        let mut row = [inv_mass[i]; 4];
        for k in 0..3 {
            let base = if plan.moving { ahead[k] * per_h } else { free[k] };
            row[k] = base + warm[i][k] * share;
        }
        let columns = [&mut part.free, &mut part.ahead, &mut part.total];
        for (column, mut new) in columns.into_iter().zip([free, ahead, total[i]]) {
            for k in 0..3 {
                let value = &mut column[k][at];
                if let Some(chosen) = &chosen {
                    new[k] = L::select(chosen[i].moves, new[k], *value);
                }
                *value = new[k];
            }
        }
        if let Some(chosen) = &chosen {
            let old = four_of::<L>(part.velocity, at);
            row = crate::each::indexed(|k| L::select(chosen[i].moves, row[k], old[k]));
        }
        put_four::<L>(part.velocity, at, row);
    }
}

/// After contacts: displacements of the substep, and the rows hold velocities again. Are all of them finite?
#[must_use]
pub fn advance<L: Lanes>(plan: &Plan<'_, L::Elem>, motion: &mut Motion<L::Elem>) -> bool {
    let mut finite = [true; MOST_THREADS];
    motion.each_span::<L, _>(plan.workers, &mut finite, |common, part, finite| {
        *finite = advance_span::<L>(plan, common, part);
    });
    !finite.contains(&false)
}

fn advance_span<L: Lanes>(
    plan: &Plan<'_, L::Elem>,
    common: Common<'_, L::Elem>,
    part: &mut Span<'_, L>,
) -> bool {
    let (h, per_h) = (Step::<L>::new(plan.h_secs).h, L::lit(1.0 / plan.h_secs));
    let per_share = L::lit(1.0 / plan.impulse_share());
    let mut doubtful = L::zero();
    for run in part.own(common.runs) {
        for at in lanes_of::<L>(&run) {
            let row = four_of::<L>(part.velocity, at);
            let mut velocity = row;
            let mut moved = [L::zero(); 4];
            for k in 0..3 {
                let (free, ahead) = (part.free[k][at], part.ahead[k][at]);
                let base = if plan.moving { ahead * per_h } else { free };
                let change = row[k] - base;
                velocity[k] = free + change * per_share;
                moved[k] = ahead + h * change;
                // 0 while finite, NaN once not, and NaN stays; a velocity that is not finite is seen in `change`.
                doubtful = doubtful + moved[k] * L::zero();
            }
            if let Some(substep_group) = common.group.current {
                let chosen = Chosen::<L>::new(&common.group.of_slot, substep_group, part.first + at, row[3]);
                let old = four_of::<L>(part.moved, at);
                velocity = crate::each::indexed(|k| L::select(chosen.moves, velocity[k], row[k]));
                moved = crate::each::indexed(|k| L::select(chosen.moves, moved[k], old[k]));
            }
            put_four::<L>(part.velocity, at, velocity);
            put_four::<L>(part.moved, at, moved);
        }
    }
    !(!doubtful.equals(L::zero())).any()
}

#[inline(always)]
fn store_block<L: Lanes>(x: &mut Column<L::Elem>, y: &mut Column<L::Elem>, at: usize, values: &Block<L>) {
    for (i, value) in values.iter().enumerate() {
        x.lanes_mut::<L>()[at + i] = value.x;
        y.lanes_mut::<L>()[at + i] = value.y;
    }
}
