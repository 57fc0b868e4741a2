//! A body on its way through a step.

use glam::DVec2;

use super::approach::Reach;
use super::respond::Motion;
use super::sweep::Course;
use crate::body::Bodies;
use crate::lanes::Real;
use crate::vec2::Rot;

/// How often a body may meet others within a step; then it stays where it is.
pub(super) const MEETINGS: u32 = 8;

/// A body on its way through a step. Without its outline, which only those need that come near each other.
#[derive(Clone, Debug)]
pub(super) struct Way {
    pub(super) slot: usize,
    /// What is left of it.
    pub(super) course: Course,
    /// The share of the step that is over.
    pub(super) since: f64,
    pub(super) motion: Motion,
    pub(super) reach: Reach,
    /// It has met something: its pose and velocity are to be written.
    pub(super) met: bool,
    pub(super) left: u32,
    pub(super) next: Option<Meeting>,
}

/// What a body meets next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// As a share of the whole step.
    pub(super) at: f64,
    /// Unit, towards what it meets.
    pub(super) axis: DVec2,
    pub(super) with: Other,
}

#[derive(Clone, Copy, Debug)]
pub(super) enum Other {
    /// One of the obstacles.
    Wall(usize),
    /// One of the ways.
    Way(usize),
}

impl Way {
    pub(super) fn new<R: Real>(bodies: &Bodies<R>, slot: usize, course: Course, reach: Reach) -> Self {
        let motion = Motion::of(bodies, slot);
        Self { slot, course, since: 0.0, motion, reach, met: false, left: MEETINGS, next: None }
    }

    /// What is left of it from an instant of the step on that is not over.
    pub(super) fn from(&self, since: f64) -> Course {
        let over = if self.since < 1.0 { (since - self.since) / (1.0 - self.since) } else { 0.0 };
        self.course.after(over)
    }

    /// [`Way::from`] an instant; where the way was seen last it is lent as it is, as most are: copies took half of a pair's time.
    pub(super) fn lent<'a>(&'a self, since: f64, later: &'a mut Option<Course>) -> &'a Course {
        if self.since == since { &self.course } else { later.insert(self.from(since)) }
    }

    /// The body stays where it is for the rest of the step.
    pub(super) fn stay(&mut self) {
        (self.met, self.left) = (true, 0);
        (self.course.moved, self.course.angle) = (DVec2::ZERO, 0.0);
    }

    /// The body is where it is at an instant of the step.
    pub(super) fn go_to(&mut self, at: f64) {
        let over =
            if self.since < 1.0 { ((at - self.since) / (1.0 - self.since)).clamp(0.0, 1.0) } else { 1.0 };
        self.course = self.course.after(over);
        self.since = at;
    }

    /// The body goes on with the velocity it will have as the step ends, of which it has yet to gain some.
    pub(super) fn go_on(&mut self, motion: Motion, rest_secs: f64, gained: DVec2) {
        (self.motion, self.met) = (motion, true);
        self.left = self.left.saturating_sub(1);
        if self.left > 0 {
            self.course.moved = (motion.velocity - gained * 0.5) * rest_secs;
            self.course.angle = motion.spin * rest_secs;
        } else {
            (self.course.moved, self.course.angle) = (DVec2::ZERO, 0.0);
        }
    }

    /// Pose and velocity at its end.
    pub(super) fn write<R: Real>(&self, bodies: &mut Bodies<R>) {
        let (slot, end) = (self.slot, self.course.after(1.0));
        let rot = Rot { c: R::from_f64(end.rot.c), s: R::from_f64(end.rot.s) };
        bodies.set_place(slot, end.x.into());
        (bodies.c[slot], bodies.s[slot]) = (rot.c, rot.s);
        bodies.vx[slot] = R::from_f64(self.motion.velocity.x);
        bodies.vy[slot] = R::from_f64(self.motion.velocity.y);
        bodies.w[slot] = R::from_f64(self.motion.spin);
    }
}
