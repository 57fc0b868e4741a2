//! Joints in the same lanes as contacts: coloured among themselves, solved before contacts in each pass.
//!
//! | part of a step | reads | writes |
//! |---|---|---|
//! | [`JointStream::prepare`] when joints, bodies or the substep change | joints, masses | colours, batches, constraints |
//! | [`JointStream::place`] at a step's beginning | poses | arms, gaps, angles |
//! | [`JointStream::warm_start`] | impulses, rows | rows |
//! | `push` before bodies move | constraints, rows | impulses, rows |
//! | `relax` after bodies moved | displacements, constraints, rows | arms, gaps, impulses, rows |
//! | [`JointStream::end`] | constraints | what joints carry |
//!
//! Two shapes of constraint: `pin` for hinges and welds, `rod` for distances, each with one bounded `row`.
//!
//! **Positions.** Gaps and lengths are found from the poses once a step and then changed by what bodies moved, so
//! that far from the origin they keep their precision. Arms are turned by the sine and cosine of each substep's angle,
//! exact to round-off of the arm, and come from the attitude again with the next step. The push also knows what arms
//! and rods bend by beyond the linear step: gaps stay of third order in h.
//!
//! **Impulses turn with their joint.** Where u is the mean velocity of a substep (`share` ½), an impulse given
//! before bodies move with the geometry G is to count half with G and half with the geometry G′ after: then the
//! push is the first and the relaxation the second half of RATTLE (Andersen 1983), of second order, symplectic, and
//! angular momentum is kept. So the relaxation first adds (1 − share)·(G′ − G)ᵀλ. The rest, which the warm start per
//! body does not know of, is a `Swing` and is owed to the next push. Without it a pendulum gained energy: the
//! impulse of the last substep, a little behind, pulled it forward.
//!
//! **Stiffness.** Rigid joints are soft constraints of [`HERTZ_TIMES_SUBSTEP`] and [`DAMPING`] in the push, and
//! rigid in the relaxation. Not stiffer, for a reason. A long chain's slowest mode is one that a visit hardly
//! changes: per substep, with y = 2π·hz·h, the impulse λ leaks by l = 1/(1 + y(2ζ + y)) of itself in the push and grows
//! by a small share g of 2v + b·x/h, b = y/(2ζ + y) the bias, x and v the mode's gap and its rate (push and relaxation
//! each see v, the push alone x). With x″ = −λ that is
//!
//! ```text
//! s³ + l·s² + 2g·s + g·b = 0       stable where 2l > b, for every g:   y² < 2·(1 − y/(2·(2ζ + y)))  <  2
//! ```
//!
//! so hz·h < √2/2π = 0.225, however large ζ. The bound is sharp: hanging chains of 17 to 600 links came to rest at
//! 0.22 and 0.25 and blew up at 0.3 and 0.5, whatever ζ. Where the leak is left out (λ + scale·(wanted − λ)) nothing
//! is stable. What stiffness there is costs a stretch of N·h²/(m_eff·y²) per joint under a load of N; substeps
//! shrink it by their square. ζ = 5 rather than 1 or 2: residual motion of a chain with a 100-fold weight after ten
//! seconds 0.1 to 0.6 mm/s, against 25 to 150.

mod batches;
mod direct;
mod pin;
mod rod;
mod row;
mod stream;

use super::constraint::Side;
use super::soft;
use crate::body::{Bodies, fine_difference};
use crate::column::Column;
use crate::each::Each as _;
use crate::joint::{Held, Joint};
use crate::lanes::{Lanes, Real};
use crate::vec2::{Rot, Vec2, sin_cos};
use row::Numbers;

pub(crate) use stream::{JointStream, Sources};

/// Stiffness of rigid joints: hz·h, below what chains of any length bear.
pub(crate) const HERTZ_TIMES_SUBSTEP: f64 = 0.22;
/// Damping ratio of rigid joints.
pub(crate) const DAMPING: f64 = 5.0;
/// Of solvers with one pass: the share of an error that a visit takes back, and the share of an impulse that it
/// leaks. More of the first than eight visits leak, and chains blow up.
const BAUMGARTE: f64 = 0.1;
const LEAK: f64 = 0.02;

/// How a pass solves: the coefficients all joints share.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stiffness<L> {
    /// Seconds per substep.
    h: L,
    /// 1/h.
    per_sec: L,
    /// Bias velocity per metre or radian, 1/s.
    bias_rate: L,
    /// Factor on the effective mass.
    mass_scale: L,
    /// What an impulse changes u by, over what it changes v by.
    share: L,
    /// 1/`share`.
    per_share: L,
}

impl<L: Lanes> Stiffness<L> {
    /// Of `soft`: see the module's head.
    #[inline]
    pub(super) fn soft(h_secs: f64, share: f64) -> Self {
        let (bias_rate, mass_scale) = soft::coefficients(h_secs, HERTZ_TIMES_SUBSTEP / h_secs, DAMPING);
        Self::new(h_secs, share, bias_rate, mass_scale)
    }

    /// Of the solvers with one pass.
    pub(super) fn baumgarte(h_secs: f64) -> Self {
        Self::new(h_secs, 1.0, BAUMGARTE / h_secs, 1.0 - LEAK)
    }

    /// What an impulse changes u by, over what it changes v by.
    fn share(&self) -> L {
        self.share
    }

    fn new(h_secs: f64, share: f64, bias_rate: f64, mass_scale: f64) -> Self {
        Self {
            h: L::lit(h_secs),
            per_sec: L::lit(1.0 / h_secs),
            bias_rate: L::lit(bias_rate),
            mass_scale: L::lit(mass_scale),
            share: L::lit(share),
            per_share: L::lit(1.0 / share),
        }
    }

    /// What turning with `spin` moves the end of an arm by beyond ω×r, m/s on average over a substep:
    /// −(1 − cos φ)·r/h, with tan(φ/2) taken for φ/2. Nothing over a radian: such a spin is not the one that the push
    /// will leave, and light bodies on long levers were thrown by what it said.
    #[inline(always)]
    fn bend(&self, arm: Vec2<L>, spin: L) -> Vec2<L> {
        let half = L::lit(0.5) * (self.h * spin);
        let square = L::select(half.abs().le(L::lit(0.5)), half * half, L::zero());
        -(arm * (((square + square) / (L::one() + square)) * self.per_sec))
    }
}

/// What a joint's impulse became another by because its geometry has turned: the change of its force on B (that
/// on A is the opposite), and of its torques on A and B. In units of v.
#[derive(Clone, Copy, Debug)]
struct Swing<L> {
    force: Vec2<L>,
    torque: [L; 2],
}

impl<L: Lanes> Swing<L> {
    #[inline]
    fn none() -> Self {
        Self { force: Vec2::zero(), torque: [L::zero(); 2] }
    }

    #[inline(always)]
    fn times(self, k: L) -> Self {
        Self { force: self.force * k, torque: [self.torque[0] * k, self.torque[1] * k] }
    }

    #[inline(always)]
    fn apply(self, inv_inertia: [L; 2], a: &mut Side<L>, b: &mut Side<L>) {
        a.velocity = a.velocity - self.force * a.inv_mass;
        b.velocity = b.velocity + self.force * b.inv_mass;
        a.spin = a.spin + inv_inertia[0] * self.torque[0];
        b.spin = b.spin + inv_inertia[1] * self.torque[1];
    }
}

/// Where the bodies of one side of a batch are.
#[derive(Clone, Copy, Debug)]
struct Pose<L> {
    at: Vec2<L>,
    rot: Rot<L>,
}

impl<L: Lanes> Pose<L> {
    #[inline(always)]
    fn of(bodies: &Bodies<L::Elem>, slots: &[u32]) -> Self {
        let at = Vec2::new(gathered(&bodies.x, slots), gathered(&bodies.y, slots));
        Self { at, rot: Rot { c: gathered(&bodies.c, slots), s: gathered(&bodies.s, slots) } }
    }

    /// Those of A and B; where positions are finer than their columns, seen from A.
    #[inline(always)]
    fn gather(bodies: &Bodies<L::Elem>, slots: [&[u32]; 2]) -> [Self; 2] {
        let mut poses = [Self::of(bodies, slots[0]), Self::of(bodies, slots[1])];
        if let Some(rows) = &bodies.fine {
            let rest = slots.each(|slots| {
                let of = |k: usize| lanes::<L, _>(slots, |&slot| rows.fours()[slot as usize][k]);
                [of(0), of(1), L::zero(), L::zero()]
            });
            let to_b = fine_difference([poses[0].at, poses[1].at], rest);
            (poses[0].at, poses[1].at) = (Vec2::zero(), to_b);
        }
        poses
    }
}

/// A shape of constraint in lanes; the same signature for each.
trait Linkage<L: Lanes>: Copy {
    /// One lane per joint; where there is none it is all zeros, and inert.
    fn new(
        joints: &[Option<&Joint>],
        numbers: &[Numbers],
        held: &[Held<L::Elem>],
        inv_inertia: [L; 2],
    ) -> Self;
    /// Other numbers, the same impulses.
    fn retune(&mut self, numbers: &[Numbers]);
    /// Keeps what holds bodies, and lets go what drives them.
    fn let_go(&mut self);
    /// A step begins with bodies A and B here.
    fn place(&mut self, poses: [Pose<L>; 2]);
    /// Bodies have moved and turned by these rows x, y, angle; what that made of the impulses.
    fn follow(&mut self, a: &[L; 4], b: &[L; 4]) -> Swing<L>;
    /// What is owed to the next push.
    fn late(&mut self) -> &mut Swing<L>;
    /// 1/(kg·m²) of A and B.
    fn inv_inertia(&self) -> [L; 2];
    /// Makes the impulses `scale` times what they were and gives them, times `share`, to both sides.
    fn warm_start(&mut self, scale: L, share: L, a: &mut Side<L>, b: &mut Side<L>);
    /// Solves moving velocities with bias.
    fn push(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>);
    /// Solves velocities without.
    fn relax(&mut self, how: &Stiffness<L>, a: &mut Side<L>, b: &mut Side<L>);
    /// Impulse x and y, of drive and limit, and the angle.
    fn held(&self) -> [L; 5];
}

/// What turning by `angle` moves the end of an arm by.
#[inline(always)]
fn turn<L: Lanes>(arm: Vec2<L>, angle: L) -> Vec2<L> {
    let (s, c) = sin_cos(angle);
    arm.turned_by(s) + arm * (c - L::one())
}

/// Changes one lane of two values.
fn set_lane<L: Lanes>(of: &mut [L; 2], lane: usize, values: [f64; 2]) {
    for (lanes, value) in of.iter_mut().zip(values) {
        let mut all = lanes.to_array();
        all[lane] = L::Elem::from_f64(value);
        *lanes = L::load(&all);
    }
}

/// One number per slot, `WIDTH` of them. Neither closure nor `zip`: as calls they took a grid of joints 6 % of its step.
#[inline(always)]
fn gathered<L: Lanes>(column: &Column<L::Elem>, slots: &[u32]) -> L {
    let (column, slots) = (column.as_slice(), &slots[..L::WIDTH]);
    let mut values = [L::Elem::ZERO; 16];
    for lane in 0..L::WIDTH {
        values[lane] = column[slots[lane] as usize];
    }
    L::load(&values)
}

/// One lane per item, the rest zeros.
#[inline]
fn lanes<L: Lanes, T>(items: &[T], of: impl Fn(&T) -> L::Elem) -> L {
    let mut values = [L::Elem::ZERO; 16];
    for (lane, item) in items.iter().enumerate() {
        values[lane] = of(item);
    }
    L::load(&values)
}

/// One number of each joint; 0 where there is none.
fn number<L: Lanes>(joints: &[Option<&Joint>], of: fn(&Joint) -> f64) -> L {
    lanes(joints, |joint| L::Elem::from_f64(joint.map_or(0.0, of)))
}

/// The anchors in the frames of A and B, metres.
fn anchors<L: Lanes>(joints: &[Option<&Joint>]) -> [Vec2<L>; 2] {
    [
        Vec2::new(number(joints, |j| j.anchors_body[0][0]), number(joints, |j| j.anchors_body[0][1])),
        Vec2::new(number(joints, |j| j.anchors_body[1][0]), number(joints, |j| j.anchors_body[1][1])),
    ]
}
