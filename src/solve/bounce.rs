//! Bounces, located within the step.
//!
//! As a step begins, a point that does not rest and closes at v < 0 over a gap s under the relative acceleration a will
//! meet at t = 2s/(u − v) with the speed u = √(v² − 2a·s), and parts with e·u. As the step ends, r = h − t after that, its
//! speed is e·u + a·r and its gap e·u·r + ½a·r²: [`Bounce`] gives the impulse for the one, and displacements for the
//! other. Under constant acceleration both are exact, so no time is lost, no energy is gained, and a ball comes to rest
//! when it should: where 2e·u < −a·r·(1 − e), all the bounces that are left fit into the step.
//!
//! What a bounce displaces must not enter others: [`MoveOut`] moves it out again, and what comes to lie there begins the next
//! step at the gap 0.

use super::batches::{Ends, Visit};
use super::block::{answer, cross, non_negative, part};
use super::constraint::{Constraint, Normals, Side};
use super::joint::JointStream;
use super::stream::Stream;
use crate::lanes::{LaneMask, Lanes};

/// Bounces of one point within a step that are followed one by one.
const HOPS: usize = 16;

/// How a point will part that bounces within the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rebound<L> {
    /// Speed right after it has met, m/s; 0 where it does not bounce.
    begins: L,
    /// As the step ends, m/s.
    speed: L,
    /// As the step ends, metres.
    gap: L,
    /// From the impact to the step's end, seconds.
    since: L,
    /// What the contact stops that holds it from then on, which it will not have to, m/s.
    supported_velocity: L,
    /// Has it bounced in this step, in an earlier round? 1 or 0.
    bounced: L,
}

/// What was noted at a step's beginning, per batch and point.
#[derive(Clone, Debug)]
pub(crate) struct Bounces<L> {
    two: Vec<[Rebound<L>; 2]>,
    one: Vec<[Rebound<L>; 1]>,
    /// Of batches of one and of two points: does any of their points bounce? What else is noted of others is of no step: few
    /// bounce, and a batch's notes are as long as its constraints.
    any: [Vec<bool>; 2],
}

/// Bounces of a step; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Bouncing<L: Lanes> {
    pub(super) bounces: Bounces<L>,
    /// What bounces displace, per slot: x, y (metres), angle, –.
    pub(super) displaced: Vec<[L::Elem; 4]>,
    /// Bodies were fast enough to bounce as this step began: their approaches were looked at.
    pub(super) looked: bool,
    /// Something bounces in this step.
    pub(super) any: bool,
    /// Rounds of joints and contacts by which velocities are relaxed after an impact on what joints hold.
    pub(super) rounds: u32,
    /// Per slot, whether joints hold its body.
    pub(super) jointed: Vec<bool>,
}

impl<L: Lanes> Default for Bouncing<L> {
    fn default() -> Self {
        Self {
            bounces: Bounces::default(),
            displaced: Vec::new(),
            looked: false,
            any: false,
            rounds: 0,
            jointed: Vec::new(),
        }
    }
}

impl<L> Default for Bounces<L> {
    fn default() -> Self {
        Self { two: Vec::new(), one: Vec::new(), any: [Vec::new(), Vec::new()] }
    }
}

impl<L: Lanes> Bounces<L> {
    /// Makes room for so many batches.
    pub(crate) fn resize(&mut self, [two, one]: [usize; 2]) {
        let zero = L::zero();
        let none = Rebound {
            begins: zero,
            speed: zero,
            gap: zero,
            since: zero,
            supported_velocity: zero,
            bounced: zero,
        };
        self.two.resize(two, [none; 2]);
        self.one.resize(one, [none; 1]);
        self.any[0].resize(one, false);
        self.any[1].resize(two, false);
    }

    /// Does a point of a batch bounce?
    #[inline(always)]
    fn any_at<const POINTS: usize>(&mut self, at: usize) -> &mut bool {
        &mut self.any[POINTS - 1][at]
    }

    #[inline(always)]
    fn at<const POINTS: usize>(&mut self, at: usize) -> &mut [Rebound<L>] {
        if POINTS == 2 { &mut self.two[at] } else { &mut self.one[at] }
    }
}

/// Rounds of joints and contacts after an impact on, or a bounce of, what joints hold: one round leaves a share of what the
/// other took, cos² of the angle between them.
pub(super) const ROUNDS: u32 = 12;

impl<L: Lanes> Bouncing<L> {
    /// As a step begins: rounds where something meets a body that joints hold. `rows`: velocities as the step begins.
    pub(super) fn look_for_impacts(
        &mut self,
        stream: &mut Stream<L>,
        joints: &JointStream<L>,
        rows: &[[L::Elem; 4]],
        [threshold, dt_secs]: [f64; 2],
    ) {
        self.mark_jointed(joints, rows.len());
        let (threshold, dt_secs) = (L::lit(threshold), L::lit(dt_secs));
        let mut any = false;
        stream.each(|first, contacts| {
            let (rows, jointed) = (&rows[first..], &self.jointed[first..]);
            let mut pass = Impacts { rows, jointed, threshold, dt_secs, any };
            contacts.visit(&mut pass);
            any = pass.any;
        });
        self.rounds = if any { ROUNDS } else { 0 };
    }

    /// Notes which bodies joints hold, of so many slots.
    pub(super) fn mark_jointed(&mut self, joints: &JointStream<L>, slots: usize) {
        self.jointed.clear();
        self.jointed.resize(slots, false);
        joints.mark(&mut self.jointed);
    }
}

/// Looks for what meets a body that joints hold within a step.
struct Impacts<'a, L: Lanes> {
    rows: &'a [[L::Elem; 4]],
    jointed: &'a [bool],
    threshold: L,
    dt_secs: L,
    any: bool,
}

impl<L: Lanes> Visit<L> for Impacts<'_, L> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let is_held = |lane: usize| [ends.a, ends.b].iter().any(|slots| self.jointed[slots[lane] as usize]);
        if self.any || !(0..L::WIDTH).any(is_held) {
            return;
        }
        let (a, b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        let speeds = Normals::begin(c, &a, &b);
        for point in &c.points {
            let speed = speeds.velocity(point);
            let meets = speed.lt(-self.threshold)
                & point.separation.lt(-(speed * self.dt_secs))
                & point.velocity_impulse.lt(L::lit(-0.5) * speed)
                & L::zero().lt(point.mass);
            self.any |= crate::lanes::set_lanes(meets.bits()).any(is_held);
        }
    }
}

/// Notes how each point will part that approaches faster than the threshold and than its load of the last step explains.
#[derive(Debug)]
pub(crate) struct NoteApproach<'a, L: Lanes> {
    /// Velocities at the step's beginning per slot.
    pub rows: &'a [[L::Elem; 4]],
    /// Accelerations at the step's beginning per slot: x, y (m/s²), angular.
    pub accelerations: &'a [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    pub moved: Option<&'a [[L::Elem; 4]]>,
    /// Slower approaches do not bounce, m/s.
    pub threshold: L,
    /// The step, seconds.
    pub dt_secs: L,
    /// Where to.
    pub bounces: &'a mut Bounces<L>,
    /// Is anything noted?
    pub any: bool,
}

impl<L: Lanes> Visit<L> for NoteApproach<'_, L> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, at: usize) {
        let normals = |rows: &[[L::Elem; 4]]| {
            let (a, b) = (Side::gather(rows, ends.a), Side::gather(rows, ends.b));
            Normals::begin(c, &a, &b)
        };
        let (speeds, pulls) = (normals(self.rows), normals(self.accelerations));
        let zero = L::zero();
        let gaps = gaps(c, &ends, self.moved.filter(|_| !ends.fresh));
        let approaches: [(L, L::Mask); POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            let speed = speeds.velocity(point);
            // What it carried, if anything, is not what stops it: it has yet to meet.
            let meeting = point.velocity_impulse.lt(L::lit(-0.5) * speed);
            (speed, speed.lt(-self.threshold) & meeting & zero.lt(point.mass))
        });
        *self.bounces.any_at::<POINTS>(at) = false;
        if !approaches.iter().any(|(_, bounces)| bounces.any()) {
            return;
        }
        self.any = true;
        let (noted, mut any) = (self.bounces.at::<POINTS>(at), false);
        for (k, noted) in noted.iter_mut().enumerate() {
            let (gap, (speed, bounces)) = (gaps[k], approaches[k]);
            let pull = pulls.velocity(&c.points[k]);
            let meets = zero.max(speed * speed - L::lit(2.0) * (pull * gap)).sqrt();
            let closing = L::select(bounces, meets - speed, L::one());
            let until = L::lit(2.0) * zero.max(gap) / closing;
            // Later than this step it meets only if others hold it up, as fast as it is.
            let meets = L::select(until.le(self.dt_secs), meets, -speed);
            let begins = L::select(bounces, c.restitution * meets, zero);
            *noted = rebound(begins, zero.max(self.dt_secs - until), pull, c.restitution);
            any |= zero.lt(noted.begins).any();
        }
        *self.bounces.any_at::<POINTS>(at) = any;
    }
}

/// How a point parts that has just met and has `since` seconds left, pulled back by `pull` < 0: it may meet again.
#[inline(always)]
fn rebound<L: Lanes>(mut begins: L, mut since: L, pull: L, restitution: L) -> Rebound<L> {
    let (zero, two) = (L::zero(), L::lit(2.0));
    // Both sides of 2u < −a·r; `again` where it comes back within the step.
    let comes = |begins: L, since: L| zero.lt(begins) & (two * begins).lt(-(pull * since));
    let left = -(pull * since) * (L::one() - restitution);
    begins = L::select((two * begins).lt(left), zero, begins);
    let mut again = comes(begins, since);
    for _ in 0..HOPS {
        if !again.any() {
            break;
        }
        since = L::select(again, since + two * begins / L::select(again, pull, -L::one()), since);
        begins = L::select(again, restitution * begins, begins);
        again = again & comes(begins, since);
    }
    begins = L::select(again, zero, begins);
    let change = pull * since;
    let gap = (begins + L::lit(0.5) * change) * since;
    let supported_velocity = zero.max(-change);
    Rebound { begins, speed: begins + change, gap, since, supported_velocity, bounced: zero }
}

/// The pass that ends a step: points that bounce and were stopped part as noted.
#[derive(Debug)]
pub(crate) struct Bounce<'a, L: Lanes> {
    /// Velocities per slot.
    pub rows: &'a mut [[L::Elem; 4]],
    /// What bounces displace, per slot: x, y, angle, –; zeros before the first round.
    pub displaced: &'a mut [[L::Elem; 4]],
    /// Gaps up to this share of the pair's length count as touched.
    pub touch: L,
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    pub moved: Option<&'a [[L::Elem; 4]]>,
    /// What was noted.
    pub bounces: &'a mut Bounces<L>,
    /// Per slot, whether joints hold its body.
    pub jointed: &'a [bool],
    /// Did something?
    pub any: bool,
    /// Of which joints hold a body?
    pub any_jointed: bool,
}

impl<L: Lanes> Visit<L> for Bounce<'_, L> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, at: usize) {
        if !*self.bounces.any_at::<POINTS>(at) {
            return;
        }
        let (noted, zero) = (self.bounces.at::<POINTS>(at), L::zero());
        let (mut a, mut b) = (Side::gather(self.rows, ends.a), Side::gather(self.rows, ends.b));
        let mut to_a = Side::displacement(self.displaced, ends.a, a.inv_mass);
        let mut to_b = Side::displacement(self.displaced, ends.b, b.inv_mass);
        let mut displacements = Normals::begin(c, &to_a, &to_b);
        let mut normals = Normals::begin(c, &a, &b);
        let gaps = gaps(c, &ends, self.moved);
        let gaps: [L; POINTS] = crate::each::indexed(|k| gaps[k] + displacements.velocity(&c.points[k]));
        let bounces: [L::Mask; POINTS] = crate::each::indexed(|k| {
            // One that nothing has stopped yet will be met in the next step.
            let stopped = (L::lit(-0.5) * noted[k].begins).le(normals.velocity(&c.points[k]));
            let touches = gaps[k].le(self.touch * c.length) | zero.lt(noted[k].bounced);
            zero.lt(noted[k].begins) & touches & stopped
        });
        let where_bounces = |of: &dyn Fn(usize) -> L| -> [L; POINTS] {
            crate::each::indexed(|k| L::select(bounces[k], of(k), zero))
        };
        let masses = where_bounces(&|k| c.points[k].mass);
        let cross = cross(c, &normals);
        let supported_velocity = where_bounces(&|k| noted[k].supported_velocity);
        let answer = answer(cross, masses, supported_velocity);
        let lacks = where_bounces(&|k| normals.velocity(&c.points[k]) - noted[k].speed - answer[k]);
        let given = non_negative(cross, masses, lacks);
        let parted = non_negative(cross, masses, where_bounces(&|k| gaps[k] - noted[k].gap));
        let (mut load, mut since, mut kept) = (zero, zero, zero);
        for k in 0..POINTS {
            let impulse = masses[k] * (given[k] - supported_velocity[k]);
            normals.push(c, k, impulse);
            displacements.push(c, k, masses[k] * parted[k]);
            load = load + zero.max(impulse);
            since = since.max(L::select(bounces[k], noted[k].since, zero));
            // An impact is no load to begin the next step with.
            c.points[k].velocity_impulse = L::select(bounces[k], zero, c.points[k].velocity_impulse);
            kept = kept.max(c.points[k].velocity_impulse);
            noted[k].bounced = L::select(bounces[k], L::one(), noted[k].bounced);
            // Taken off once, in the first round.
            noted[k].supported_velocity = L::select(bounces[k], zero, noted[k].supported_velocity);
            self.any |= bounces[k].any();
            self.any_jointed |= crate::lanes::set_lanes(bounces[k].bits())
                .any(|lane| [ends.a, ends.b].iter().any(|slots| self.jointed[slots[lane] as usize]));
        }
        normals.end(c, &mut a, &mut b);
        displacements.end(c, &mut to_a, &mut to_b);
        let rubbed = c.apply_friction_within(&mut a, &mut b, zero, load);
        c.apply_friction(&mut to_a, &mut to_b, rubbed * since);
        c.tangent_impulse = L::select(zero.lt(since) & kept.le(zero), zero, c.tangent_impulse);
        a.scatter(self.rows, ends.a);
        b.scatter(self.rows, ends.b);
        to_a.scatter(self.displaced, ends.a);
        to_b.scatter(self.displaced, ends.b);
    }
}

/// The pass that ends a step by displacements alone: what is in others, by a law, is moved out of them.
#[derive(Debug)]
pub(crate) struct MoveOut<'a, L: Lanes, F> {
    /// Velocities per slot, for their inverse masses.
    pub rows: &'a [[L::Elem; 4]],
    /// What is displaced so far, per slot.
    pub displaced: &'a mut [[L::Elem; 4]],
    /// Displacement of the last substep per slot; `None` where gaps are up to date.
    pub moved: Option<&'a [[L::Elem; 4]]>,
    /// How far a point has to be moved out, metres, negative, 0 where it has not: from its gap as the step ends, what that
    /// has been displaced by so far, and its effective mass, 0 where it does not exist.
    pub entered: F,
    /// Was there one?
    pub any: bool,
}

/// What bounces displaced into others, or deeper into them; what overlapped before may, as much.
pub(crate) fn by_bounces<L: Lanes>([gap, way, ..]: [L; 4]) -> L {
    let zero = L::zero();
    L::select(way.lt(zero), zero.min(way + zero.max(gap)), zero)
}

impl<L: Lanes, F: Fn([L; 4]) -> L> Visit<L> for MoveOut<'_, L, F> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let side = |slots: &[u32]| {
            Side::displacement(self.displaced, slots, Side::<L>::gather(self.rows, slots).inv_mass)
        };
        let (mut to_a, mut to_b) = (side(ends.a), side(ends.b));
        let displacements = Normals::begin(c, &to_a, &to_b);
        let gaps = gaps(c, &ends, self.moved);
        let entered: [L; POINTS] = crate::each::indexed(|k| {
            let point = &c.points[k];
            (self.entered)([gaps[k], displacements.velocity(point), point.mass, c.length])
        });
        if !entered.iter().any(|entered| entered.lt(L::zero()).any()) {
            return;
        }
        self.any = true;
        part(c, displacements, entered, [&mut to_a, &mut to_b]);
        to_a.scatter(self.displaced, ends.a);
        to_b.scatter(self.displaced, ends.b);
    }
}

/// Gaps once bodies have `moved`.
#[inline(always)]
fn gaps<L: Lanes, const POINTS: usize>(
    c: &Constraint<L, POINTS>,
    ends: &Ends<'_>,
    moved: Option<&[[L::Elem; 4]]>,
) -> [L; POINTS] {
    let mut change = [L::zero(); POINTS];
    if let Some(moved) = moved {
        change = c.change_by(moved, ends);
    }
    crate::each::indexed(|k| c.points[k].separation + change[k])
}
