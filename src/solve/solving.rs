//! What a step asks of its solver, in order; what each of them does is in the files beside this one.

mod end;
mod groups;
mod read;

use super::bounce::{self, Bouncing};
use super::direct::DirectContacts;
use super::joint::{JointStream, Sources};
use super::lengths::StepLengths;
use super::scheme::{Pairs, Substep, solver_of};
use super::stream::{Stream, WarmStart};
use super::substep_group::SubstepGroups;
use super::{SolverContext, avbd, carries_impulses, deep, pushes};
use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real};
use crate::motion::{Motion, Warm};
use crate::settings::Solver;
use crate::workers::Workers;

/// Constraints and what solvers keep; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Solving<L: Lanes> {
    stream: Stream<L>,
    joints: JointStream<L>,
    substep_groups: SubstepGroups<L::Elem>,
    /// The substep group that is being solved, where there are several.
    substep_group: Option<usize>,
    bouncing: Bouncing<L>,
    avbd: avbd::Avbd<L>,
    lengths: StepLengths,
    /// Gaps of constraints have yet to hear of the last displacements.
    behind: bool,
    /// The solver works on the pairs: their rows hold gaps and impulses, and constraints are made of them when asked.
    in_rows: bool,
    deep: deep::Apart,
    direct: DirectContacts,
    /// Steps until impulses are summed anew though nothing has changed: what the sums of the warm start per body
    /// round off must not add up.
    until_summed: u32,
}

/// Steps for which a warm start is carried from one to the next.
const CARRIED_STEPS: u32 = 16;

impl<L: Lanes> Default for Solving<L> {
    fn default() -> Self {
        Self {
            stream: Stream::default(),
            joints: JointStream::default(),
            substep_groups: SubstepGroups::default(),
            substep_group: None,
            bouncing: Bouncing::default(),
            avbd: avbd::Avbd::default(),
            lengths: StepLengths::default(),
            behind: false,
            in_rows: false,
            deep: deep::Apart::default(),
            direct: DirectContacts::default(),
            until_summed: 0,
        }
    }
}

impl<L: Lanes> Solving<L> {
    /// Are joints solved in this substep group?
    fn with_joints(&self) -> bool {
        self.substep_group.is_none_or(|substep_group| {
            self.substep_groups.of_joints() == self.substep_groups.substeps(substep_group)
        })
    }

    /// Takes in what the narrow phase found: contacts that touch no more go, and impulses stay with the features of points.
    pub fn follow(&mut self, manifolds: &mut Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if self.stream.overflows() {
            self.catch_up(motion);
        }
        self.stream.follow(manifolds, self.in_rows);
    }

    /// Takes in that pairs were listed anew.
    pub fn rename(&mut self, manifolds: &mut Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if self.stream.overflows() {
            self.catch_up(motion);
        }
        self.stream.rename(manifolds, self.in_rows);
    }

    /// Gaps hear of the last displacements now: before bodies that moved are seen otherwise, or contacts leave their lanes.
    pub fn catch_up(&mut self, motion: &Motion<L::Elem>) {
        if std::mem::take(&mut self.behind) {
            self.stream.follow_displacements(motion.moved.fours());
        }
    }

    /// Puts the contacts of which `which(slots)` holds down to their pairs' rows: they will not be solved.
    pub fn put_down(
        &mut self,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
        which: impl Fn([u32; 2]) -> bool,
    ) {
        self.catch_up(motion);
        self.stream.put_down(manifolds, self.in_rows, which);
    }

    /// Makes constraints of the manifolds looked at; contacts that have come get a place first. `changed`: which pairs touch
    /// has, or with how many points.
    pub fn prepare<'a>(
        &mut self,
        bodies: &Bodies<L::Elem>,
        (manifolds, looked_at): (&mut Manifolds<L::Elem>, impl Iterator<Item = &'a [u32]> + Clone),
        changed: bool,
        (workers, motion): (&Workers, &Motion<L::Elem>),
    ) {
        self.avbd.outdated |= changed;
        if changed || self.stream.is_outdated() {
            self.stream.arrange(bodies, manifolds, &self.substep_groups);
        }
        let all = looked_at.clone().map(<[u32]>::len).sum::<usize>() == manifolds.pairs();
        if !all {
            let homes = manifolds.homes();
            for &place in looked_at.flatten() {
                self.stream.touch(homes[place as usize]);
            }
        }
        let moved = self.behind.then_some(motion.moved.fours());
        self.stream.prepare((workers, all), manifolds, motion.inverse_masses.fours(), moved);
        if !self.behind {
            self.stream.age();
        }
        self.until_summed = 0;
    }

    /// Bodies have come, or changed.
    pub fn freshen(&mut self, came: bool) {
        self.deep.fresh = true;
        self.direct.forget();
        if came {
            self.substep_groups.freshen();
        }
    }

    /// Other forces act: what stands under them may need other substeps.
    pub fn look_at_loads(&mut self) {
        self.substep_groups.freshen();
    }

    /// After bodies have come: notes how deep the deepest of the pairs last looked at is; later ones are looked at as a
    /// step ends. `deepest`: over its pair's length, negative.
    pub fn note_depth(&mut self, deepest: impl FnOnce() -> f64) {
        if std::mem::take(&mut self.deep.fresh) && deepest() < -deep::DEEP {
            self.deep.steps = deep::STEPS;
        }
    }

    /// Forgets all contacts: the pairs they belong to are gone.
    pub fn forget(&mut self) {
        self.stream.clear();
        self.until_summed = 0;
    }

    /// Makes constraints of joints, where they, bodies, the substep or who is `awake` have changed. `awake`: bodies by slot,
    /// all if `None`, and how often that has changed.
    pub fn make_joints(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        joints: &Joints<L::Elem>,
        awake: (Option<&[bool]>, u64),
    ) {
        let [h_secs, share] = [self.joint_h_secs(context), context.plan.impulse_share()];
        let direct = context.solver == Solver::Soft;
        let fields = context.plan.fields;
        let sources = Sources { joints, bodies, fields, h_secs, share, awake: awake.0, direct };
        self.joints.prepare(&sources, awake.1);
    }

    /// [`Solving::make_joints`], and finds where they are.
    pub fn prepare_joints(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        joints: &Joints<L::Elem>,
        awake: (Option<&[bool]>, u64),
    ) {
        self.lengths.begin_joints(self.joint_h_secs(context));
        self.make_joints(context, bodies, joints, awake);
        self.joints.place(bodies);
    }

    /// A substep of joints, seconds.
    fn joint_h_secs(&self, context: &SolverContext<'_, L::Elem>) -> f64 {
        context.dt_secs / f64::from(self.substep_groups.of_joints().unwrap_or(context.plan.substeps))
    }

    /// Before the first substep: what bounces is noted, and where the warm start is said.
    pub fn begin(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> Warm {
        self.in_rows = context.solver == Solver::Avbd;
        self.direct.clear();
        if context.solver == Solver::Soft {
            self.direct.choose(&mut self.stream, bodies);
        }
        let same_length = self.lengths.begin(context);
        let may_bounce = context.needs.restitution && pushes(context.solver) && motion.outlook.may_bounce;
        let jointed = pushes(context.solver) && motion.outlook.may_bounce && !self.joints.is_empty();
        let may_hit = jointed && self.stream.batches() != [0; 2];
        let looks = may_bounce || may_hit;
        let might_bounce = std::mem::replace(&mut self.bouncing.looked, looks);
        self.bouncing.any = may_bounce && self.note_approaches(context, bodies, manifolds, motion);
        self.bouncing.rounds = 0;
        if may_hit {
            if !may_bounce {
                motion.load::<L>(context.plan, bodies);
            }
            let (rows, bounds) = (motion.velocity.fours(), [context.bounce_threshold(), context.dt_secs]);
            self.bouncing.look_for_impacts(&mut self.stream, &self.joints, rows, bounds);
        }
        let carries = carries_impulses(context.solver);
        // Joints are placed anew in each step; where approaches were looked at the rows are theirs.
        let settled = self.joints.is_empty() && !might_bounce && !looks && same_length;
        if carries && settled && self.until_summed > 0 {
            self.until_summed -= 1;
            return Warm::Carried;
        }
        self.until_summed = CARRIED_STEPS;
        motion.clear_rows();
        if carries {
            let rows = motion.velocity.fours_mut();
            self.joints.warm_start(rows, self.lengths.joint_scale, 1.0);
            let share = L::Elem::from_f64(self.lengths.scale);
            self.stream.share(context.plan.workers, rows, &|rows, _, contacts| {
                contacts.visit(&mut WarmStart { rows, share });
            });
        }
        Warm::Summed
    }

    /// Notes how what approaches will part; says whether anything does.
    fn note_approaches(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        self.take_rows(manifolds, motion);
        motion.load::<L>(context.plan, bodies);
        if !self.joints.is_empty() {
            // What joints pull with is what they pulled with in the last substep; their impulses are of this length from here on.
            let scale = std::mem::replace(&mut self.lengths.joint_scale, 1.0);
            let per_sec = 1.0 / self.lengths.joint_h_secs;
            self.joints.warm_start(motion.acceleration.fours_mut(), scale, per_sec);
        }
        self.bouncing.bounces.resize(self.stream.batches());
        let moved = self.behind.then_some(motion.moved.fours());
        let mut any = false;
        self.stream.each(|first, contacts| {
            let mut pass = bounce::NoteApproach {
                rows: &motion.velocity.fours()[first..],
                accelerations: &motion.acceleration.fours()[first..],
                moved: moved.map(|moved| &moved[first..]),
                threshold: L::lit(context.bounce_threshold()),
                dt_secs: L::lit(context.dt_secs),
                bounces: &mut self.bouncing.bounces,
                any: false,
            };
            contacts.visit(&mut pass);
            any |= pass.any;
        });
        any
    }

    /// Joints, then contacts of one substep, before bodies move.
    pub fn solve(&mut self, context: &SolverContext<'_, L::Elem>, motion: &mut Motion<L::Elem>, first: bool) {
        solver_of(context.solver).solve(&mut self.substep(context, motion, first).0);
        if first {
            self.stream.age();
        }
    }

    /// Joints, then contacts of one substep, after bodies moved.
    pub fn relax(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        let (mut substep, avbd) = self.substep(context, motion, false);
        solver_of(context.solver).relax(&mut substep, Pairs { bodies, manifolds, avbd });
    }

    /// A substep, and what beside it only `avbd` uses.
    fn substep<'a>(
        &'a mut self,
        context: &'a SolverContext<'a, L::Elem>,
        motion: &'a mut Motion<L::Elem>,
        first: bool,
    ) -> (Substep<'a, L>, &'a mut avbd::Avbd<L>) {
        let with_joints = self.with_joints();
        let substep = Substep {
            context,
            stream: &mut self.stream,
            direct: &mut self.direct,
            joints: with_joints.then_some(&mut self.joints),
            motion,
            first,
            behind: !first || self.behind,
            deep: self.deep.steps > 0,
            rounds: self.bouncing.rounds,
            softened: self.lengths.softened(context.dt_secs),
            joint_scale: self.lengths.joint_scale,
        };
        (substep, &mut self.avbd)
    }

    /// Hands impulses and angles back to the joints.
    pub fn end_joints(&mut self, joints: &mut Joints<L::Elem>) {
        self.joints.end(joints);
    }
}
