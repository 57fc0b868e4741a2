//! Lengths of steps and substeps, which may change from one to the next: what is carried belongs to one of them.

use super::{SolverContext, soft};

/// What a step has to know of the lengths of those before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct StepLengths {
    /// The substep that the impulses of contacts belong to, seconds; 0 before the first.
    h_secs: f64,
    /// This substep over that one.
    pub scale: f64,
    /// The longest step that contacts still remember, seconds; see [`soft::STIFFENING`].
    remembered_secs: f64,
    /// The substep that the impulses of joints belong to, seconds.
    pub joint_h_secs: f64,
    /// This substep over that one.
    pub joint_scale: f64,
}

impl Default for StepLengths {
    fn default() -> Self {
        Self { h_secs: 0.0, scale: 1.0, remembered_secs: 0.0, joint_h_secs: 0.0, joint_scale: 1.0 }
    }
}

impl StepLengths {
    /// A step begins; says whether its substeps are as long as the last one's.
    pub(super) fn begin<R>(&mut self, context: &SolverContext<'_, R>) -> bool {
        let h_secs = context.plan.h_secs;
        let last = std::mem::replace(&mut self.h_secs, h_secs);
        self.scale = over(h_secs, last);
        self.remembered_secs = context.dt_secs.max(self.remembered_secs * soft::STIFFENING);
        h_secs == last
    }

    /// Joints will be solved with substeps of `h_secs`.
    pub(super) fn begin_joints(&mut self, h_secs: f64) {
        let last = std::mem::replace(&mut self.joint_h_secs, h_secs);
        self.joint_scale = over(h_secs, last);
    }

    /// Of contacts whose step has become shorter: their stiffness over what it will be; 1 to the bit where all steps have
    /// one length.
    pub(super) fn softened(&self, dt_secs: f64) -> f64 {
        dt_secs / self.remembered_secs.max(dt_secs)
    }
}

fn over(h_secs: f64, last: f64) -> f64 {
    if last > 0.0 { h_secs / last } else { 1.0 }
}
