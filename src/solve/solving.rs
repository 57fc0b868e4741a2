//! What a step asks of its solver, in order; what each of them does is in the files beside this one.

mod end;
mod latest;

use super::bounce::{self, Bounces};
use super::color::Coloring;
use super::joint::{JointStream, Sources};
use super::scheme::{Pairs, Substep, solver_of};
use super::soft;
use super::stream::{Stream, WarmStart};
use super::substep_group::{Goal, SubstepGroups};
use super::{SolverContext, avbd, carries_impulses, deep, pushes};
use crate::body::Bodies;
use crate::contact::Manifolds;
use crate::each::Each as _;
use crate::joint::Joints;
use crate::lanes::{Lanes, Real};
use crate::motion::{Motion, Warm};
use crate::settings::Solver;

use latest::{Follow, Latest};

/// Colours, constraints and what solvers keep; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct Solving<L: Lanes> {
    coloring: Coloring,
    stream: Stream<L>,
    joints: JointStream<L>,
    substep_groups: SubstepGroups<L::Elem>,
    /// The substep group that is being solved, where there are several.
    substep_group: Option<usize>,
    bounces: Bounces<L>,
    /// What bounces displace, per slot: x, y (metres), angle, –.
    displaced: Vec<[L::Elem; 4]>,
    avbd: avbd::Avbd<L>,
    /// The graph of contacts is not the one `avbd` was cut for.
    graph_outdated: bool,
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
    may_bounce: bool,
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
            substep_groups: SubstepGroups::default(),
            substep_group: None,
            bounces: Bounces::default(),
            displaced: Vec::new(),
            avbd: avbd::Avbd::default(),
            graph_outdated: true,
            last_h_secs: 0.0,
            scale: 1.0,
            remembered_secs: 0.0,
            last_joint_h_secs: 0.0,
            joint_scale: 1.0,
            latest: Latest::default(),
            may_bounce: false,
            bouncing: false,
            deep: deep::Apart::default(),
            until_summed: 0,
        }
    }
}

impl<L: Lanes> Solving<L> {
    /// Gives islands their substeps; says whether any has others than before. Then all constraints are to be prepared.
    pub fn decide_substep_groups(
        &mut self,
        goal: &Goal,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        joints: &Joints<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        let ends = || joints.living().map(|(_, joint)| joint.bodies.each(|id| id.slot() as u32));
        let looked = self.substep_groups.looks(goal);
        if looked {
            if goal.max_sag.is_some() {
                self.stream.visit(&mut self.substep_groups.reading());
            }
            self.stream.visit(&mut self.substep_groups.touching(goal));
            self.substep_groups.weigh(goal, bodies, ends());
        }
        let wanted = self.substep_groups.wants(goal, looked);
        let changed =
            wanted && self.substep_groups.decide(goal, bodies, manifolds, ends(), &motion.runs, looked);
        self.substep_groups.count_step(looked);
        if changed {
            self.hand_back(manifolds, motion);
            self.substep_groups.scale_impulses(bodies, manifolds);
            motion.substep_groups.clone_from(self.substep_groups.index());
        }
        changed
    }

    /// How often substeps are counted out in a step: once for each number of them.
    pub fn substep_groups(&self) -> &SubstepGroups<L::Elem> {
        &self.substep_groups
    }

    /// Where there are several substep groups: passes go over one, until [`Solving::leave_group`].
    pub fn enter_group(&mut self, substep_group: usize, motion: &mut Motion<L::Elem>) {
        if self.substep_groups.count() > 1 {
            self.substep_group = Some(substep_group);
            self.stream.choose(self.substep_group);
            motion.substep_group = Some(L::Elem::from_f64(substep_group as f64));
            std::mem::swap(&mut motion.runs, self.substep_groups.runs_mut(substep_group));
        }
    }

    /// After [`Solving::enter_group`]: passes go over all contacts again. Gaps hear of the last displacements: those of
    /// kinematic bodies will be of another substep when the next step begins.
    pub fn leave_group(&mut self, substep_group: usize, motion: &mut Motion<L::Elem>) {
        if self.substep_group.take().is_some() {
            self.stream.visit(&mut Follow { moved: motion.moved.fours() });
            self.stream.choose(None);
            motion.substep_group = None;
            std::mem::swap(&mut motion.runs, self.substep_groups.runs_mut(substep_group));
        }
    }

    /// Are joints solved in this substep group?
    fn with_joints(&self) -> bool {
        self.substep_group.is_none_or(|substep_group| {
            self.substep_groups.of_joints() == self.substep_groups.substeps(substep_group)
        })
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
        self.graph_outdated |= changed;
        if changed {
            self.coloring.run(bodies, manifolds);
            self.stream.cut(&self.coloring, manifolds, &self.substep_groups);
        } else {
            looked_at.for_each(|place| self.stream.touch(place));
        }
        self.stream.begin(manifolds, motion.inverse_masses.fours());
        if self.latest != Latest::BeforeDisplacements {
            self.stream.age();
        }
        self.until_summed = 0;
    }

    /// Bodies have come, or changed.
    pub fn freshen(&mut self, came: bool) {
        self.deep.fresh = true;
        if came {
            self.substep_groups.freshen();
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
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        joints: &Joints<L::Elem>,
        awake: (Option<&[bool]>, u64),
    ) {
        let substeps = self.substep_groups.of_joints().unwrap_or(context.plan.substeps);
        let [h_secs, share] = [context.dt_secs / f64::from(substeps), context.plan.impulse_share()];
        let last = std::mem::replace(&mut self.last_joint_h_secs, h_secs);
        self.joint_scale = if last > 0.0 { h_secs / last } else { 1.0 };
        let direct = context.solver == Solver::Soft;
        self.joints.prepare(&Sources { joints, bodies, h_secs, share, awake: awake.0, direct }, awake.1);
        self.joints.place(bodies);
    }

    /// Before the first substep: what bounces is noted, and where the warm start is said.
    pub fn begin(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> Warm {
        let (h, last) = (context.plan.h_secs, std::mem::replace(&mut self.last_h_secs, context.plan.h_secs));
        self.scale = if last > 0.0 { h / last } else { 1.0 };
        self.remembered_secs = context.dt_secs.max(self.remembered_secs * soft::STIFFENING);
        let may_bounce = context.needs.restitution && pushes(context.solver) && motion.may_bounce;
        let might_bounce = std::mem::replace(&mut self.may_bounce, may_bounce);
        self.bouncing = may_bounce && self.note_approaches(context, bodies, manifolds, motion);
        let carries = carries_impulses(context.solver);
        // Joints are placed anew in each step; where approaches were looked at the rows are theirs.
        let settled = self.joints.is_empty() && !might_bounce && !may_bounce && h == last;
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
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) -> bool {
        self.follow_pairs(context, manifolds, motion);
        motion.load::<L>(context.plan, bodies);
        self.bounces.resize(self.stream.batches());
        let mut pass = bounce::NoteApproach {
            rows: motion.velocity.fours(),
            accelerations: motion.acceleration.fours(),
            moved: self.latest.yet_to_follow(motion),
            threshold: L::lit(context.bounce_threshold()),
            dt_secs: L::lit(context.dt_secs),
            bounces: &mut self.bounces,
            any: false,
        };
        self.stream.visit(&mut pass);
        pass.any
    }

    /// Joints, then contacts of one substep, before bodies move.
    pub fn solve(&mut self, context: &SolverContext<'_, L::Elem>, motion: &mut Motion<L::Elem>, first: bool) {
        solver_of(context.solver).solve(&mut self.substep(context, motion, first).0);
        if first {
            self.stream.age();
        }
    }

    /// Joints, then contacts of one substep, after bodies moved.
    pub fn settle(
        &mut self,
        context: &SolverContext<'_, L::Elem>,
        bodies: &Bodies<L::Elem>,
        manifolds: &mut Manifolds<L::Elem>,
        motion: &mut Motion<L::Elem>,
    ) {
        let (mut substep, avbd, graph_outdated) = self.substep(context, motion, false);
        let pairs = Pairs { bodies, manifolds, avbd, graph_outdated };
        solver_of(context.solver).relax(&mut substep, pairs);
    }

    /// A substep, and what beside it only `avbd` uses.
    fn substep<'a>(
        &'a mut self,
        context: &'a SolverContext<'a, L::Elem>,
        motion: &'a mut Motion<L::Elem>,
        first: bool,
    ) -> (Substep<'a, L>, &'a mut avbd::Avbd<L>, &'a mut bool) {
        let with_joints = self.with_joints();
        let substep = Substep {
            context,
            stream: &mut self.stream,
            joints: with_joints.then_some(&mut self.joints),
            motion,
            first,
            // Constraints that were not prepared anew have yet to hear of the last step's last displacement.
            behind: !first || self.latest == Latest::BeforeDisplacements,
            deep: self.deep.steps > 0,
            softened: context.dt_secs / self.remembered_secs.max(context.dt_secs),
            joint_scale: self.joint_scale,
        };
        (substep, &mut self.avbd, &mut self.graph_outdated)
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
