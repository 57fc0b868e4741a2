//! What a step asks of its solver, in order: the dispatch from [`Solver`] to the files beside this one.

mod end;

use super::bounce::{self, Bounces};
use super::color::Coloring;
use super::constraint::Constraint;
use super::joint::{JointStream, Sources, Stiffness};
use super::pace::{Goal, Paces};
use super::soft::{self, Softness};
use super::stream::{Ends, Stream, Visit, WarmStart};
use super::{Task, avbd, carries_impulses, deep, impulse, pgs, pushes, xpbd};
use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real};
use crate::motion::{Motion, Warm};
use crate::settings::Solver;

/// Where today's gaps and impulses are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Latest {
    /// In the pairs' rows.
    #[default]
    InPairs,
    /// In the constraints.
    InConstraints,
    /// In the constraints, whose gaps have yet to hear of the last displacements.
    BeforeDisplacements,
}

/// Gaps hear of displacements.
struct Follow<'a, R> {
    moved: &'a [[R; 4]],
}

impl<L: Lanes> Visit<L> for Follow<'_, L::Elem> {
    #[inline(always)]
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        c.follow(self.moved, &ends);
    }
}

impl Latest {
    /// The displacements that gaps have yet to hear of; none where a settling pass has told them.
    fn yet_to_follow<R: Real>(self, motion: &Motion<R>) -> Option<&[[R; 4]]> {
        (self == Self::BeforeDisplacements).then_some(motion.moved.fours())
    }
}

/// Colours, constraints and what solvers keep; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Solving<L: Lanes> {
    coloring: Coloring,
    stream: Stream<L>,
    joints: JointStream<L>,
    paces: Paces<L::Elem>,
    /// The pace that is being solved, where there are several.
    pace: Option<usize>,
    bounces: Bounces<L>,
    /// What bounces displace, per slot: x, y (metres), angle, –.
    displaced: Vec<[L::Elem; 4]>,
    avbd: avbd::Avbd<L>,
    /// The graph of contacts is not the one `avbd` was cut for.
    recut: bool,
    /// The substep the impulses of the last step belong to, seconds.
    last_h_secs: f64,
    /// This substep over that one.
    scale: f64,
    /// The longest step that contacts still remember, seconds; see [`soft::STIFFENING`].
    remembered_secs: f64,
    /// The same of joints.
    last_joint_h_secs: f64,
    joint_scale: f64,
    latest: Latest,
    /// Bodies were fast enough to bounce as this step began: their approaches were looked at.
    lively: bool,
    /// Something bounces in this step.
    bouncing: bool,
    deep: deep::Apart,
    /// Steps until impulses are summed anew though nothing has changed: what the sums of the warm start per body
    /// round off must not add up.
    until_summed: u32,
}

/// Steps for which a warm start is carried from one to the next.
const CARRIED_STEPS: u32 = 16;

impl<L: Lanes> Default for Solving<L> {
    fn default() -> Self {
        Self {
            coloring: Coloring::default(),
            stream: Stream::default(),
            joints: JointStream::default(),
            paces: Paces::default(),
            pace: None,
            bounces: Bounces::default(),
            displaced: Vec::new(),
            avbd: avbd::Avbd::default(),
            recut: true,
            last_h_secs: 0.0,
            scale: 1.0,
            remembered_secs: 0.0,
            last_joint_h_secs: 0.0,
            joint_scale: 1.0,
            latest: Latest::default(),
            lively: false,
            bouncing: false,
            deep: deep::Apart::default(),
            until_summed: 0,
        }
    }
}

impl<L: Lanes> Solving<L> {
    /// Gives islands their substeps; says whether any has others than before. Then all constraints are to be prepared.
    pub fn decide_paces(
        &mut self,
        goal: &Goal,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        joints: &Joints<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        let ends = || joints.living().map(|(_, joint)| joint.bodies.each(|id| id.slot() as u32));
        let looked = self.paces.looks(goal);
        if looked {
            if goal.max_sag.is_some() {
                self.stream.visit(&mut self.paces.reading());
            }
            self.stream.visit(&mut self.paces.touching(goal));
            self.paces.weigh(goal, bodies, ends());
        }
        let wanted = self.paces.wants(goal, looked);
        let changed = wanted && self.paces.decide(goal, bodies, manifolds, ends(), &motion.runs, looked);
        self.paces.count_step(looked);
        if changed {
            self.hand_back(manifolds, motion);
            self.paces.scale_impulses(bodies, manifolds);
            motion.paces.clone_from(self.paces.index());
        }
        changed
    }

    /// How often substeps are counted out in a step: once for each number of them.
    pub fn paces(&self) -> &Paces<L::Elem> {
        &self.paces
    }

    /// Where there are several paces: passes go over one, until [`Solving::leave_pace`].
    pub fn enter_pace(&mut self, pace: usize, motion: &mut Motion<L::Elem>) {
        if self.paces.count() > 1 {
            self.pace = Some(pace);
            self.stream.choose(self.pace);
            motion.pace = Some(L::Elem::from_f64(pace as f64));
            std::mem::swap(&mut motion.runs, self.paces.runs_mut(pace));
        }
    }

    /// After [`Solving::enter_pace`]: passes go over all contacts again. Gaps hear of the last displacements: those of
    /// kinematic bodies will be of another substep when the next step begins.
    pub fn leave_pace(&mut self, pace: usize, motion: &mut Motion<L::Elem>) {
        if self.pace.take().is_some() {
            self.stream.visit(&mut Follow { moved: motion.moved.fours() });
            self.stream.choose(None);
            motion.pace = None;
            std::mem::swap(&mut motion.runs, self.paces.runs_mut(pace));
        }
    }

    /// Are joints solved in this pace?
    fn with_joints(&self) -> bool {
        self.pace.is_none_or(|pace| self.paces.of_joints() == self.paces.substeps(pace))
    }

    /// Makes constraints of the manifolds found: all of them where the graph of contacts has changed, else those of
    /// the places looked at.
    pub fn prepare(
        &mut self,
        bodies: &Bodies<L::Elem>,
        (manifolds, looked_at): (&mut Manifolds<L::Elem>, impl Iterator<Item = u32>),
        changed: bool,
        motion: &Motion<L::Elem>,
    ) {
        self.recut |= changed;
        if changed {
            self.coloring.run(bodies, manifolds);
            self.stream.cut(&self.coloring, manifolds, &self.paces);
        } else {
            looked_at.for_each(|place| self.stream.touch(place));
        }
        self.stream.begin(manifolds, motion.matter.fours());
        if self.latest != Latest::BeforeDisplacements {
            self.stream.age();
        }
        self.until_summed = 0;
    }

    /// Bodies have come, or changed.
    pub fn freshen(&mut self, came: bool) {
        self.deep.fresh = true;
        if came {
            self.paces.freshen();
        }
    }

    /// After bodies have come: notes how deep the deepest of the pairs last looked at is; later ones are looked at as a
    /// step ends. `deepest`: metres, negative; `length`: the scene's median radius.
    pub fn note_depth(&mut self, deepest: impl FnOnce() -> f64, length: f64) {
        if std::mem::take(&mut self.deep.fresh) && deepest() < -deep::DEEP * length {
            self.deep.steps = deep::STEPS;
        }
    }

    /// Forgets what constraints hold: the pairs they belong to are gone.
    pub fn forget(&mut self) {
        (self.latest, self.until_summed) = (Latest::InPairs, 0);
    }

    /// Hands gaps and impulses of the places that will be looked at back to them, and of those whose constraints are
    /// prepared along with them; `prepare` is to follow.
    pub fn hand_back_chosen(
        &mut self,
        (manifolds, looked_at): (&mut Manifolds<L::Elem>, impl Iterator<Item = u32>),
        motion: &Motion<L::Elem>,
    ) {
        if self.latest != Latest::InPairs {
            looked_at.for_each(|place| self.stream.touch(place));
            self.stream.end_where(true, manifolds, self.latest.yet_to_follow(motion));
        }
    }

    /// Hands gaps and impulses back to the pairs, those of [`Solving::hand_back_chosen`] left out: they have been.
    pub fn hand_back(&mut self, manifolds: &mut Manifolds<L::Elem>, motion: &Motion<L::Elem>) {
        if self.latest != Latest::InPairs {
            self.stream.end_where(false, manifolds, self.latest.yet_to_follow(motion));
            self.latest = Latest::InPairs;
        }
    }

    /// Makes constraints of joints, where they, bodies, the substep or who is `awake` have changed, and finds where
    /// they are. `awake`: bodies by slot, all if `None`, and how often that has changed.
    pub fn prepare_joints(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        joints: &Joints<L::Elem>,
        awake: (Option<&[bool]>, u64),
    ) {
        let substeps = self.paces.of_joints().unwrap_or(task.plan.substeps);
        let [h_secs, share] = [task.dt_secs / f64::from(substeps), task.plan.impulse_share()];
        let last = std::mem::replace(&mut self.last_joint_h_secs, h_secs);
        self.joint_scale = if last > 0.0 { h_secs / last } else { 1.0 };
        let direct = task.solver == Solver::Soft;
        self.joints.prepare(&Sources { joints, bodies, h_secs, share, awake: awake.0, direct }, awake.1);
        self.joints.place(bodies);
    }

    /// Before the first substep: what bounces is noted, and where the warm start is said.
    pub fn begin(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> Warm {
        let (h, last) = (task.plan.h_secs, std::mem::replace(&mut self.last_h_secs, task.plan.h_secs));
        self.scale = if last > 0.0 { h / last } else { 1.0 };
        self.remembered_secs = task.dt_secs.max(self.remembered_secs * soft::STIFFENING);
        let lively = task.traits.restitution && pushes(task.solver) && motion.lively;
        let was_lively = std::mem::replace(&mut self.lively, lively);
        self.bouncing = lively && self.note_approaches(task, bodies, manifolds, motion);
        let carries = carries_impulses(task.solver);
        // Joints are placed anew in each step; where approaches were looked at the rows are theirs.
        let settled = self.joints.is_empty() && !was_lively && !lively && h == last;
        if carries && settled && self.until_summed > 0 {
            self.until_summed -= 1;
            return Warm::Carried;
        }
        self.until_summed = CARRIED_STEPS;
        motion.clear_rows();
        if carries {
            let rows = motion.velocity.fours_mut();
            self.joints.warm_start(rows, self.joint_scale, 1.0);
            self.stream.visit(&mut WarmStart { rows, share: L::Elem::from_f64(self.scale) });
        }
        Warm::Summed
    }

    /// Notes how what approaches will part; says whether anything does.
    fn note_approaches(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        self.follow_pairs(task, manifolds, motion);
        motion.load::<L>(task.plan, bodies);
        self.bounces.resize(self.stream.batches());
        let mut pass = bounce::NoteApproach {
            rows: motion.velocity.fours(),
            accelerations: motion.acceleration.fours(),
            moved: self.latest.yet_to_follow(motion),
            threshold: L::lit(task.bounce_threshold()),
            dt_secs: L::lit(task.dt_secs),
            bounces: &mut self.bounces,
            any: false,
        };
        self.stream.visit(&mut pass);
        pass.any
    }

    /// Joints, then contacts of one substep, before bodies move.
    pub fn solve(&mut self, task: &Task<'_, L::Elem>, motion: &mut Motion<L::Elem>, first: bool) {
        let h_secs = task.plan.h_secs;
        // 1 to the bit where all steps have one length.
        let softened = task.dt_secs / self.remembered_secs.max(task.dt_secs);
        let rows = motion.velocity.fours_mut();
        // Constraints that were not prepared anew have yet to hear of the last step's last displacement.
        let moved = (!first || self.latest == Latest::BeforeDisplacements).then_some(motion.moved.fours());
        // Joints have: they are placed at a step's beginning.
        let joints_moved = moved.filter(|_| !first);
        let scale = if first { self.joint_scale } else { 1.0 };
        let with_joints = self.with_joints();
        let share = task.plan.impulse_share();
        let (stream, joints) = (&mut self.stream, &mut self.joints);
        match task.solver {
            Solver::Soft => {
                if with_joints {
                    joints.push(rows, None, &Stiffness::soft(h_secs, share));
                    joints.solve_directly(rows, Some(&Stiffness::soft(h_secs, share)));
                }
                let cap = soft::PUSH_CAP * task.traits.length / task.dt_secs;
                let soft = softened * (task.stiffness / h_secs);
                let soft = Softness::new(h_secs, soft, soft::DAMPING, cap);
                let deep = L::lit(-deep::DEEP * task.traits.length);
                let [share, per_share] = [share, 1.0 / share].each(L::lit);
                if self.deep.steps > 0 {
                    stream.visit(&mut soft::Push::<L, true> { rows, moved, soft, deep, share, per_share });
                } else {
                    stream.visit(&mut soft::Push::<L, false> { rows, moved, soft, deep, share, per_share });
                }
            }
            Solver::Pgs => {
                for iteration in 0..pgs::ITERATIONS {
                    let once = iteration == 0;
                    joints.push(rows, joints_moved.filter(|_| once), &Stiffness::baumgarte(h_secs));
                    pgs::iterate(stream, task, rows, moved.filter(|_| once));
                }
            }
            // Bodies move before contacts are seen.
            Solver::Xpbd | Solver::Avbd => {
                joints.warm_start(rows, scale, share);
                joints.push(rows, None, &Stiffness::soft(h_secs, share));
            }
            Solver::Impulse => {
                // One visit leaks less than it takes back: carried from step to step, impulses of chains would grow.
                joints.warm_start(rows, if first { 0.0 } else { 1.0 }, 1.0);
                joints.push(rows, joints_moved, &Stiffness::baumgarte(h_secs));
                impulse::resolve(stream, task, rows, moved);
            }
        }
        if first {
            self.stream.age();
        }
    }

    /// Joints, then contacts of one substep, after bodies moved.
    pub fn settle(
        &mut self,
        task: &Task<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        let how = Stiffness::soft(task.plan.h_secs, task.plan.impulse_share());
        let with_joints = self.with_joints();
        let (stream, joints) = (&mut self.stream, &mut self.joints);
        match task.solver {
            Solver::Soft => {
                let (rows, per_sec) = (motion.velocity.fours_mut(), L::lit(1.0 / task.plan.h_secs));
                if with_joints {
                    joints.relax(rows, motion.moved.fours(), &how);
                    joints.solve_directly(rows, None);
                }
                if task.traits.friction {
                    stream.visit(&mut soft::Relax::<L, true> { rows, per_sec });
                } else {
                    stream.visit(&mut soft::Relax::<L, false> { rows, per_sec });
                }
            }
            Solver::Pgs => {}
            Solver::Avbd => {
                if std::mem::take(&mut self.recut) {
                    self.avbd.cut(bodies, manifolds);
                }
                let pace = avbd::Pace::new(task.plan.h_secs, task.plan.impulse_share(), task.traits.length);
                self.avbd.settle(manifolds, motion, &pace);
                joints.relax(motion.velocity.fours_mut(), motion.moved.fours(), &how);
            }
            Solver::Xpbd => {
                let (moved, rows) = (motion.moved.fours_mut(), motion.velocity.fours_mut());
                xpbd::project(stream, task, moved, rows);
                joints.relax(rows, moved, &how);
                xpbd::settle(stream, task, moved, rows);
            }
            Solver::Impulse => stream.visit(&mut impulse::Correct {
                moved: motion.moved.fours_mut(),
                rows: motion.velocity.fours(),
                slop: L::lit(impulse::SLOP * task.traits.length),
            }),
        }
    }

    /// The manifolds with today's gaps and impulses.
    pub fn brought_up_to_date(
        &self,
        manifolds: &Manifolds<L::Elem>,
        motion: &Motion<L::Elem>,
    ) -> Manifolds<L::Elem> {
        let mut manifolds = manifolds.clone();
        if !self.pairs_are_up_to_date() {
            self.stream.clone().end_where(false, &mut manifolds, self.yet_to_follow(motion));
        }
        manifolds
    }

    /// Do pairs hold today's gaps and impulses? Else constraints do.
    pub(super) fn pairs_are_up_to_date(&self) -> bool {
        self.latest == Latest::InPairs
    }

    /// The displacements that gaps of constraints have yet to hear of.
    pub(super) fn yet_to_follow<'a>(&self, motion: &'a Motion<L::Elem>) -> Option<&'a [[L::Elem; 4]]> {
        self.latest.yet_to_follow(motion)
    }

    /// Hands impulses and angles back to the joints.
    pub fn end_joints(&mut self, joints: &mut Joints<L::Elem>) {
        self.joints.end(joints);
    }

    /// Joints that are solved directly.
    pub fn direct_joints(&self) -> usize {
        self.joints.direct()
    }

    /// The joints' constraints.
    pub fn joints(&self) -> &JointStream<L> {
        &self.joints
    }
    /// The colours.
    pub fn coloring(&self) -> &Coloring {
        &self.coloring
    }
    /// The constraints.
    pub fn stream(&self) -> &Stream<L> {
        &self.stream
    }
}
