//! Smooth motion: one scheme per file, and the three passes a step makes over the columns.
//!
//! A scheme turns (x, v) of a block of bodies into a displacement and a new velocity. Positions are not
//! touched inside a step: displacements are summed in the `moved` columns and added once at its end,
//! which is what keeps precision far from the origin.
//!
//! Next to contacts, a body advances by the scheme's displacement plus h·(`v_solved` − `v_free`): where
//! no contact changed its velocity the difference is exactly zero, so a body that touches nothing moves
//! as if there were no solver, to the bit.
//!
//! | pass | reads | writes |
//! |---|---|---|
//! | [`fly`] (no contact in the world) | x v θ, fields | x v θ |
//! | [`predict`] (per substep) | x v moved, fields | solver rows, `v_free`, displacement |
//! | [`correct`] (per substep) | solver rows, `v_free`, displacement | v, moved |
//! | [`finish`] (per step) | moved | x, attitude |
//!
//! Drag, springs and the other fields act at the centroid: attitude follows from constant torque alone.
//! `moved` sums one angle per step, turned exactly by [`Rot::turned`].

mod explicit_euler;
mod position_verlet;
mod rk4;
mod semi_implicit_euler;
mod velocity_verlet;
mod yoshida4;

use crate::body::Bodies;
use crate::column::{Column, PAD};
use crate::force::{Field, Matter, acceleration};
use crate::lanes::{LaneMask, Lanes, ROW, Real};
use crate::settings::{Integrator, Skip, Skips};
use crate::vec2::{Rot, Vec2};

/// Lane values a scheme advances together; fields are matched once for all of them.
pub const BLOCK: usize = 4;

/// A vector per body of a block.
pub type Block<L> = [Vec2<L>; BLOCK];

/// h, ½h and ½h² in lanes, seconds.
#[derive(Clone, Copy, Debug)]
pub struct Step<L> {
    /// h.
    pub h: L,
    /// ½h.
    pub half_h: L,
    /// ½h².
    pub half_h2: L,
}

impl<L: Lanes> Step<L> {
    /// Of a step of `h_secs`.
    pub fn new(h_secs: f64) -> Self {
        let h = L::Elem::from_f64(h_secs);
        let half = L::Elem::from_f64(0.5);
        Self { h: L::splat(h), half_h: L::splat(half * h), half_h2: L::splat(half * h * h) }
    }
}

/// What a scheme makes of one step of a block.
#[derive(Clone, Copy, Debug)]
pub struct Advance<L> {
    /// Metres.
    pub displacement: Block<L>,
    /// At the end of the step, m/s.
    pub velocity: Block<L>,
}

/// An integrator: the same signature for every scheme.
pub trait Scheme {
    /// Advances (x, v) by one step under `accel(x, v)`.
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>) -> Block<L>,
    ) -> Advance<L>;

    /// The angle turned and the angular velocity reached under constant angular acceleration.
    #[inline(always)]
    fn spin<L: Lanes>(step: Step<L>, w: L, alpha: L) -> (L, L) {
        (step.h * w + step.half_h2 * alpha, w + step.h * alpha)
    }
}

/// What every scheme of order ≥ 2 is under constant acceleration: x + hv + ½h²a, v + ha.
///
/// The schemes are written as this plus deviations between their stages, so the collapse is exact to the bit.
struct ClosedForm;

impl Scheme for ClosedForm {
    #[inline(always)]
    fn advance<L: Lanes>(
        step: Step<L>,
        x: &Block<L>,
        v: &Block<L>,
        accel: impl Fn(&Block<L>, &Block<L>) -> Block<L>,
    ) -> Advance<L> {
        let a = accel(x, v);
        Advance { displacement: drift(step, v, &a), velocity: along(v, step.h, &a) }
    }
}

/// a + k·b for each body of a block.
#[inline(always)]
fn along<L: Lanes>(a: &Block<L>, k: L, b: &Block<L>) -> Block<L> {
    std::array::from_fn(|i| a[i] + b[i] * k)
}

/// h·v + ½h²·a for each body of a block.
#[inline(always)]
fn drift<L: Lanes>(step: Step<L>, v: &Block<L>, a: &Block<L>) -> Block<L> {
    std::array::from_fn(|i| v[i] * step.h + a[i] * step.half_h2)
}

/// Columns of a step in progress: what bodies moved so far, and one substep's prediction.
#[derive(Clone, Debug)]
pub struct Motion<R: Real> {
    /// Displacement since the step began: x, y (metres), angle (rad).
    pub moved: [Column<R>; 3],
    /// Velocity after the scheme, before contacts: x, y, angular.
    free: [Column<R>; 3],
    /// The scheme's displacement in this substep: x, y, angle.
    ahead: [Column<R>; 3],
    /// Per body [`vx`, `vy`, `w`, 1/m, 1/I, moved x, moved y, moved angle]: what a solver gathers and scatters.
    pub rows: Column<R>,
}

impl<R: Real> Default for Motion<R> {
    fn default() -> Self {
        let three = || std::array::from_fn(|_| Column::new(R::ZERO));
        Self { moved: three(), free: three(), ahead: three(), rows: Column::new(R::ZERO) }
    }
}

impl<R: Real> Motion<R> {
    /// Makes room for `len` bodies; allocates only when the world grows.
    pub fn resize(&mut self, len: usize) {
        for column in self.moved.iter_mut().chain(&mut self.free).chain(&mut self.ahead) {
            column.resize(len);
        }
        // A row for every lane of the last block, padding included.
        self.rows.resize(len.next_multiple_of(PAD) * ROW);
    }

    /// Was what the scheme predicted for a slot, before contacts, finite: where a non-finite state began.
    pub fn predicted_finite(&self, slot: usize) -> bool {
        self.free.iter().chain(&self.ahead).all(|column| column[slot].is_finite())
    }
}

/// What the passes of this module left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Skipped {
    /// Bodies whose scheme collapsed to its closed form.
    pub closed_form: u64,
    /// Bodies whose attitude was not touched.
    pub rotation: u64,
}

/// How smooth motion is to be advanced.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a, R> {
    /// The scheme.
    pub integrator: Integrator,
    /// The fields present.
    pub fields: &'a [Field<R>],
    /// Seconds per substep.
    pub h_secs: f64,
    /// Substeps per step.
    pub substeps: u32,
    /// Work that may be left out.
    pub skips: Skips,
}

impl<R: Real> Plan<'_, R> {
    /// Does the scheme collapse to its closed form?
    pub fn collapses(&self) -> bool {
        let staged = !matches!(self.integrator, Integrator::ExplicitEuler | Integrator::SemiImplicitEuler);
        staged && self.skips.has(Skip::ClosedForm) && self.fields.iter().all(Field::is_constant)
    }
}

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

/// A whole step of bodies that touch nothing: one pass over the columns.
pub fn fly<L: Lanes>(plan: &Plan<'_, L::Elem>, bodies: &mut Bodies<L::Elem>) -> Skipped {
    let mut skipped = with_scheme!(plan, fly_with(plan, bodies));
    skipped.closed_form = if plan.collapses() { bodies.live() as u64 } else { 0 };
    skipped
}

/// One substep's prediction: velocities and displacements as if nothing touched, and the solver's rows.
pub fn predict<L: Lanes>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
) -> Skipped {
    with_scheme!(plan, predict_with(plan, bodies, motion));
    Skipped { closed_form: if plan.collapses() { bodies.live() as u64 } else { 0 }, rotation: 0 }
}

/// The block of a column that starts at lane value `at`.
#[inline(always)]
fn block<L: Lanes>(column: &Column<L::Elem>, at: usize) -> &[L; BLOCK] {
    column.lanes::<L>()[at..at + BLOCK]
        .try_into()
        .unwrap_or_else(|_| unreachable!("columns are padded to whole blocks"))
}

/// Vectors from two blocks of coordinates.
#[inline(always)]
fn vectors<L: Lanes>(x: &[L; BLOCK], y: &[L; BLOCK]) -> Block<L> {
    std::array::from_fn(|i| Vec2::new(x[i], y[i]))
}

/// First lane value of each block that holds a body.
fn block_starts<L: Lanes>(len: usize) -> impl Iterator<Item = usize> {
    (0..len.div_ceil(L::WIDTH)).step_by(BLOCK)
}

#[inline(always)]
fn matter<L: Lanes>(bodies: &Bodies<L::Elem>, at: usize) -> Matter<'_, L> {
    let force = bodies.force.as_ref().map(|f| (block(&f[0], at), block(&f[1], at)));
    Matter { inv_mass: block(&bodies.inv_mass, at), force }
}

#[inline(always)]
fn angular_acceleration<L: Lanes>(bodies: &Bodies<L::Elem>, at: usize) -> Option<[L; BLOCK]> {
    let inv_inertia = block::<L>(&bodies.inv_inertia, at);
    bodies.force.as_ref().map(|f| {
        let torque = block::<L>(&f[2], at);
        std::array::from_fn(|i| torque[i] * inv_inertia[i])
    })
}

fn fly_with<L: Lanes, S: Scheme>(plan: &Plan<'_, L::Elem>, bodies: &mut Bodies<L::Elem>) -> Skipped {
    let step = Step::new(plan.h_secs);
    let may_skip_rotation = plan.skips.has(Skip::Rotation);
    let mut skipped = Skipped::default();
    for at in block_starts::<L>(bodies.len()) {
        let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
        let mut v = vectors::<L>(block(&bodies.vx, at), block(&bodies.vy, at));
        let matter = matter(bodies, at);
        let mut moved = [Vec2::zero(); BLOCK];
        for _ in 0..plan.substeps {
            let here = std::array::from_fn(|i| x[i] + moved[i]);
            let next = S::advance(step, &here, &v, |x, v| acceleration(plan.fields, matter, x, v));
            moved = std::array::from_fn(|i| moved[i] + next.displacement[i]);
            v = next.velocity;
        }
        let mut w = *block::<L>(&bodies.w, at);
        let alpha = angular_acceleration::<L>(bodies, at);
        let still = may_skip_rotation && alpha.is_none() && !w.iter().any(|w| (!w.equals(L::zero())).any());
        if still {
            skipped.rotation += bodies.live_in(at * L::WIDTH..(at + BLOCK) * L::WIDTH) as u64;
        } else {
            let mut angle = [L::zero(); BLOCK];
            for _ in 0..plan.substeps {
                for i in 0..BLOCK {
                    let (turn, next) = S::spin(step, w[i], alpha.map_or(L::zero(), |a| a[i]));
                    angle[i] = angle[i] + turn;
                    w[i] = next;
                }
            }
            turn_block(bodies, at, &angle);
            bodies.w.lanes_mut::<L>()[at..at + BLOCK].copy_from_slice(&w);
        }
        store_block(&mut bodies.x, &mut bodies.y, at, &std::array::from_fn(|i| x[i] + moved[i]));
        store_block(&mut bodies.vx, &mut bodies.vy, at, &v);
    }
    skipped
}

fn predict_with<L: Lanes, S: Scheme>(
    plan: &Plan<'_, L::Elem>,
    bodies: &Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
) {
    let step = Step::new(plan.h_secs);
    for at in block_starts::<L>(bodies.len()) {
        let moved = vectors::<L>(block(&motion.moved[0], at), block(&motion.moved[1], at));
        let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
        let v = vectors::<L>(block(&bodies.vx, at), block(&bodies.vy, at));
        let here = std::array::from_fn(|i| x[i] + moved[i]);
        let matter = matter(bodies, at);
        let next = S::advance(step, &here, &v, |x, v| acceleration(plan.fields, matter, x, v));
        let w = *block::<L>(&bodies.w, at);
        let alpha = angular_acceleration::<L>(bodies, at);
        let spin: [(L, L); BLOCK] =
            std::array::from_fn(|i| S::spin(step, w[i], alpha.map_or(L::zero(), |a| a[i])));
        let [free_x, free_y, free_w] = &mut motion.free;
        store_block(free_x, free_y, at, &next.velocity);
        free_w.lanes_mut::<L>()[at..at + BLOCK].copy_from_slice(&spin.map(|s| s.1));
        let [ahead_x, ahead_y, ahead_w] = &mut motion.ahead;
        store_block(ahead_x, ahead_y, at, &next.displacement);
        ahead_w.lanes_mut::<L>()[at..at + BLOCK].copy_from_slice(&spin.map(|s| s.0));
        let (inv_mass, inv_inertia) = (matter.inv_mass, block::<L>(&bodies.inv_inertia, at));
        let turned = *block::<L>(&motion.moved[2], at);
        for i in 0..BLOCK {
            let row = [
                next.velocity[i].x,
                next.velocity[i].y,
                spin[i].1,
                inv_mass[i],
                inv_inertia[i],
                moved[i].x,
                moved[i].y,
                turned[i],
            ];
            L::store_rows(row, &mut motion.rows.rows_mut()[(at + i) * L::WIDTH..]);
        }
    }
}

/// After the solver: velocities back into their columns, displacements summed. Are all of them finite?
#[must_use]
pub fn correct<L: Lanes>(h_secs: f64, bodies: &mut Bodies<L::Elem>, motion: &mut Motion<L::Elem>) -> bool {
    let h = Step::<L>::new(h_secs).h;
    let mut doubtful = L::zero();
    let index: [u32; 16] = std::array::from_fn(|k| k as u32);
    for at in block_starts::<L>(bodies.len()).flat_map(|start| start..start + BLOCK) {
        let rows = &motion.rows.rows()[at * L::WIDTH..];
        let [vx, vy, w, _, _, moved_x, moved_y, turned] = L::gather_rows(rows, &index);
        for (k, (solved, moved)) in [(vx, moved_x), (vy, moved_y), (w, turned)].into_iter().enumerate() {
            let change = solved - motion.free[k].lanes::<L>()[at];
            let ahead = motion.ahead[k].lanes::<L>()[at];
            let moved = moved + (ahead + h * change);
            motion.moved[k].lanes_mut::<L>()[at] = moved;
            // 0 while finite, NaN once not, and NaN stays; a velocity that is not finite is seen in `change`.
            doubtful = doubtful + moved * L::zero();
        }
        bodies.vx.lanes_mut::<L>()[at] = vx;
        bodies.vy.lanes_mut::<L>()[at] = vy;
        bodies.w.lanes_mut::<L>()[at] = w;
    }
    !(!doubtful.equals(L::zero())).any()
}

/// Ends a step: what was moved is added to the poses and set back to zero.
pub fn finish<L: Lanes>(bodies: &mut Bodies<L::Elem>, motion: &mut Motion<L::Elem>) {
    for at in block_starts::<L>(bodies.len()) {
        let x = vectors::<L>(block(&bodies.x, at), block(&bodies.y, at));
        let moved = vectors::<L>(block(&motion.moved[0], at), block(&motion.moved[1], at));
        store_block(&mut bodies.x, &mut bodies.y, at, &std::array::from_fn(|i| x[i] + moved[i]));
        let angle = *block::<L>(&motion.moved[2], at);
        turn_block(bodies, at, &angle);
        for column in &mut motion.moved {
            column.lanes_mut::<L>()[at..at + BLOCK].fill(L::zero());
        }
    }
}

#[inline(always)]
fn turn_block<L: Lanes>(bodies: &mut Bodies<L::Elem>, at: usize, angle: &[L; BLOCK]) {
    let (c, s) =
        (&mut bodies.c.lanes_mut::<L>()[at..at + BLOCK], &mut bodies.s.lanes_mut::<L>()[at..at + BLOCK]);
    for i in 0..BLOCK {
        let rot = Rot { c: c[i], s: s[i] }.turned(angle[i]);
        (c[i], s[i]) = (rot.c, rot.s);
    }
}

#[inline(always)]
fn store_block<L: Lanes>(x: &mut Column<L::Elem>, y: &mut Column<L::Elem>, at: usize, values: &Block<L>) {
    for (i, value) in values.iter().enumerate() {
        x.lanes_mut::<L>()[at + i] = value.x;
        y.lanes_mut::<L>()[at + i] = value.y;
    }
}
