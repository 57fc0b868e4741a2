//! One step: move every body, then walk all pairs once and resolve each contact on the spot.

use glam::Vec2;

use super::rigid::{Rigid, ThesisIntegrator};

/// A way to keep the bodies; the step below is compiled once for each.
pub(super) trait Layout {
    /// Bodies.
    fn len(&self) -> usize;
    /// The state of one.
    fn rigid(&self, body: usize) -> &Rigid;
    /// Moves every body that is not static by one step, and its corners with it.
    fn advance(&mut self, integrator: ThesisIntegrator, gravity_px: Vec2, h: f32);
    /// Is the bounding test all there is to test?
    fn both_circles(&self, i: usize, j: usize) -> bool;
    /// Do the bounding circles touch?
    fn bounds_meet(&self, i: usize, j: usize) -> bool;
    /// Narrow test (none for circles: the caller has found them touching) and, where it finds a contact,
    /// its resolution; whether anything was resolved. `i < j`.
    fn collide(&mut self, i: usize, j: usize) -> bool;
}

/// What is the same in every step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rules {
    pub(super) integrator: ThesisIntegrator,
    pub(super) gravity_px: Vec2,
    /// Is the bounding test on?
    pub(super) broad: bool,
}

/// What a step met.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    /// Pairs that passed the bounding test or were spared it.
    pub(super) candidates: usize,
    /// Contacts resolved.
    pub(super) contacts: usize,
}

/// One step of `h` seconds.
pub(super) fn step<L: Layout>(bodies: &mut L, rules: Rules, h: f32) -> Tally {
    bodies.advance(rules.integrator, rules.gravity_px, h);
    let mut tally = Tally::default();
    for i in 0..bodies.len() {
        for j in i + 1..bodies.len() {
            let tested = bodies.both_circles(i, j) || rules.broad;
            if tested && !bodies.bounds_meet(i, j) {
                continue;
            }
            tally.candidates += 1;
            tally.contacts += usize::from(bodies.collide(i, j));
        }
    }
    tally
}
