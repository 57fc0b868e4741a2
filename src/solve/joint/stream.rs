//! Joints in batches of lanes, colour by colour: what holds constraints, and the passes over them.

use std::ops::Range;

use super::batches::{Batches, Joined, MOST};
use super::direct::Direct;
use super::pin::Pin;
use super::rod::Rod;
use super::row::Numbers;
use super::{Linkage, Pose, Stiffness, Swing};
use crate::body::{Bodies, BodyId, BodyKind};
use crate::each::Each as _;
use crate::force::Field;
use crate::joint::{Held, Joint, JointKind, Joints};
use crate::lanes::{Lanes, Real};
use crate::solve::color::COLORS;
use crate::solve::constraint::Side;

/// What constraints are made of.
#[derive(Debug)]
pub struct Sources<'a, R: Real> {
    /// The joints.
    pub joints: &'a Joints<R>,
    /// What they join.
    pub bodies: &'a Bodies<R>,
    /// What pulls these.
    pub fields: &'a [Field<R>],
    /// Seconds per substep.
    pub h_secs: f64,
    /// What an impulse changes a moving velocity by, over what it changes the velocity by.
    pub share: f64,
    /// By slot; a joint without an end that is awake has no constraint. `None`: all are.
    pub awake: Option<&'a [bool]>,
    /// Hard trees and nets are to be solved directly.
    pub direct: bool,
}

impl<R: Real> Sources<'_, R> {
    pub(super) fn joints_in(&self, places: &[u32]) -> [Option<&Joint>; MOST] {
        crate::each::indexed(|k| places.get(k).and_then(|&place| self.joints.at(place)))
    }

    pub(super) fn numbers(&self, joints: &[Option<&Joint>; MOST]) -> [Numbers; MOST] {
        joints.each(|j| j.map_or_else(Numbers::default, |joint| Numbers::of(joint, self.h_secs, self.share)))
    }
}

/// One colour's batches, as ranges.
#[derive(Clone, Debug)]
struct Span {
    pins: Range<usize>,
    rods: Range<usize>,
}

/// What constraints were made from: while it is the same, so are they.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct MadeFrom {
    joints: u64,
    bodies: u64,
    h_secs: f64,
    share: f64,
    groupings: u64,
    direct: bool,
}

/// All joints in batches of lanes, colour by colour; memory is kept from step to step.
#[derive(Clone, Debug)]
pub struct JointStream<L: Lanes> {
    pins: Batches<Pin<L>>,
    rods: Batches<Rod<L>>,
    spans: Vec<Span>,
    direct: Direct,
    made_from: MadeFrom,
    /// What impulses were before an impact that is no load to go on with.
    before: (Vec<Pin<L>>, Vec<Rod<L>>),
}

impl<L: Lanes> Default for JointStream<L> {
    fn default() -> Self {
        Self {
            pins: Batches::default(),
            rods: Batches::default(),
            spans: Vec::new(),
            direct: Direct::default(),
            made_from: MadeFrom::default(),
            before: (Vec::new(), Vec::new()),
        }
    }
}

/// Runs a block for each batch, colour by colour, pins first: `c` a constraint, `ends` its bodies.
macro_rules! each {
    ($stream:expr, |$c:ident, $ends:ident| $body:block) => {
        for span in &$stream.spans {
            $stream.pins.each::<L>(span.pins.clone(), |$c, $ends| $body);
            $stream.rods.each::<L>(span.rods.clone(), |$c, $ends| $body);
        }
    };
}

impl<L: Lanes> JointStream<L> {
    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.spans.is_empty()
    }

    /// Batches of hinges and welds, and of distance joints.
    pub fn batches(&self) -> [usize; 2] {
        [self.pins.links.len(), self.rods.links.len()]
    }

    /// Colours and constraints, where their sources are others than those they were made from; `groupings`: how often
    /// who is awake has changed.
    pub fn prepare(&mut self, sources: &Sources<'_, L::Elem>, groupings: u64) {
        let Sources { joints, bodies, fields, h_secs, share, awake, direct } = *sources;
        let (of_joints, of_bodies) = (joints.revision(), bodies.revision());
        let from = MadeFrom { joints: of_joints, bodies: of_bodies, h_secs, share, groupings, direct };
        let last = std::mem::replace(&mut self.made_from, from);
        if last == from || (joints.is_empty() && self.is_empty()) {
            return;
        }
        if last == (MadeFrom { h_secs: last.h_secs, share: last.share, ..from }) {
            self.pins.retune(sources);
            self.rods.retune(sources);
            return;
        }
        self.pins.clear();
        self.rods.clear();
        self.spans.clear();
        let colors = colors(joints, bodies);
        let of_color = |color: usize| {
            let pick = |rod: bool| -> Vec<u32> {
                let is_awake = |id: BodyId| awake.is_none_or(|awake| awake[id.slot()]);
                // Between two bodies that nothing moves there is nothing to hold.
                let moves = |id: BodyId| bodies.kind(id.slot()) == BodyKind::Dynamic;
                let good = |(place, joint): &(u32, &Joint)| {
                    colors[*place as usize] as usize == color
                        && matches!(joint.kind, JointKind::Distance(_)) == rod
                        && joint.bodies.into_iter().any(is_awake)
                        && joint.bodies.into_iter().any(moves)
                };
                joints.living().filter(good).map(|(place, _)| place).collect()
            };
            [pick(false), pick(true)]
        };
        let used = colors.iter().map(|&color| usize::from(color) + 1).max().unwrap_or(0);
        for color in 0..used.min(COLORS) {
            let [pins, rods] = of_color(color);
            if !pins.is_empty() || !rods.is_empty() {
                self.append(&pins, &rods, L::WIDTH, sources);
            }
        }
        // More joints on a body than colours: one at a time, in order.
        let [pins, rods] = of_color(COLORS);
        for place in pins {
            self.append(&[place], &[], 1, sources);
        }
        for place in rods {
            self.append(&[], &[place], 1, sources);
        }
        self.direct.clear();
        if direct {
            self.direct.look_over(&self.pins, &self.rods, bodies);
            self.direct.foresee_swing(&self.rods, (bodies, fields));
        }
    }

    fn append(&mut self, pins: &[u32], rods: &[u32], width: usize, sources: &Sources<'_, L::Elem>) {
        let (first_pin, first_rod) = (self.pins.links.len(), self.rods.links.len());
        self.pins.push(pins, width, sources);
        self.rods.push(rods, width, sources);
        self.spans
            .push(Span { pins: first_pin..self.pins.links.len(), rods: first_rod..self.rods.links.len() });
    }

    /// A step begins: arms, gaps and angles from the poses.
    pub fn place(&mut self, bodies: &Bodies<L::Elem>) {
        each!(self, |c, ends| { c.place(Pose::gather(bodies, [ends.a, ends.b])) });
        self.direct.stiffen(&mut self.pins, &mut self.rods, self.made_from.h_secs);
    }

    /// Makes impulses `scale` times what they were and adds what they change velocities by, times `share`: with the
    /// geometry of now, so that nothing is owed.
    pub fn warm_start(&mut self, rows: &mut [[L::Elem; 4]], scale: f64, share: f64) {
        let (scale, share) = (L::lit(scale), L::lit(share));
        each!(self, |c, ends| {
            *c.late() = Swing::none();
            with_sides(rows, &ends, |a, b| c.warm_start(scale, share, a, b));
        });
    }

    /// Before bodies move, or the only pass of a solver that has one: with bias. `moved`: displacements not yet known
    /// to the constraints.
    pub(in crate::solve) fn push(
        &mut self,
        rows: &mut [[L::Elem; 4]],
        moved: Option<&[[L::Elem; 4]]>,
        how: &Stiffness<L>,
    ) {
        each!(self, |c, ends| {
            if let Some(moved) = moved {
                let swing = c.follow(&L::gather_fours(moved, ends.a), &L::gather_fours(moved, ends.b));
                *c.late() = swing;
            }
            with_sides(rows, &ends, |a, b| {
                let late = std::mem::replace(c.late(), Swing::none());
                late.times(how.share).apply(c.inv_inertia(), a, b);
                c.push(how, a, b);
            });
        });
    }

    /// After bodies moved by `moved`: impulses turn with their joints, velocities without bias.
    pub(in crate::solve) fn relax(
        &mut self,
        rows: &mut [[L::Elem; 4]],
        moved: &[[L::Elem; 4]],
        how: &Stiffness<L>,
    ) {
        each!(self, |c, ends| {
            let swing = c.follow(&L::gather_fours(moved, ends.a), &L::gather_fours(moved, ends.b));
            *c.late() = swing.times(how.share);
            with_sides(rows, &ends, |a, b| {
                swing.times(L::one() - how.share).apply(c.inv_inertia(), a, b);
                c.relax(how, a, b);
            });
        });
    }

    /// Velocities alone once more, without bias.
    pub(in crate::solve) fn relax_velocities(&mut self, rows: &mut [[L::Elem; 4]], how: &Stiffness<L>) {
        each!(self, |c, ends| {
            with_sides(rows, &ends, |a, b| c.relax(how, a, b));
        });
        self.solve_directly(rows, None);
    }

    /// Bodies were displaced as a step ended: joints are seen from where they are now.
    pub(in crate::solve) fn follow(&mut self, displaced: &[[L::Elem; 4]]) {
        each!(self, |c, ends| {
            c.follow(&L::gather_fours(displaced, ends.a), &L::gather_fours(displaced, ends.b));
        });
    }

    /// [`JointStream::note`]; until they are taken back joints hold bodies, but drive none: displacements are solved with them.
    pub(in crate::solve) fn note_and_let_go(&mut self) {
        self.note();
        each!(self, |c, _ends| { c.let_go() });
    }

    /// Notes impulses, to be taken back by [`JointStream::restore`].
    pub(in crate::solve) fn note(&mut self) {
        self.before.0.clone_from(&self.pins.links);
        self.before.1.clone_from(&self.rods.links);
    }

    /// Impulses are again those that were noted.
    pub(in crate::solve) fn restore(&mut self) {
        std::mem::swap(&mut self.before.0, &mut self.pins.links);
        std::mem::swap(&mut self.before.1, &mut self.rods.links);
    }

    /// Marks the slots of bodies with joints.
    pub(in crate::solve) fn mark(&self, jointed: &mut [bool]) {
        let slots = [&self.pins.a, &self.pins.b, &self.rods.a, &self.rods.b];
        for &slot in slots.into_iter().flatten() {
            // The world stands for padding.
            jointed[slot as usize] = slot != 0;
        }
    }

    /// Hands impulses and angles back to the joints.
    pub fn end(&mut self, joints: &mut Joints<L::Elem>) {
        each!(self, |c, ends| {
            let [x, y, drive, limit, angle] = c.held().each(L::to_array);
            for (k, &place) in ends.place.iter().enumerate() {
                let held = Held { point: [x[k], y[k]], drive: drive[k], limit: limit[k], angle: angle[k] };
                joints.hold_at(place, held);
            }
        });
    }

    /// ω of the body that pulls of directly solved rods swing fastest across them, rad/s, as of the last step.
    pub fn swing(&self) -> f64 {
        self.direct.swing()
    }

    /// Joints that are solved directly; see `direct.rs`.
    pub fn direct(&self) -> usize {
        self.direct.len()
    }

    /// After [`JointStream::push`] (with how it was) or [`JointStream::relax`]: hard trees and nets all at once.
    pub(in crate::solve) fn solve_directly(
        &mut self,
        rows: &mut [[L::Elem; 4]],
        push: Option<&Stiffness<f64>>,
    ) {
        self.direct.solve((&mut self.pins, &mut self.rods), rows, push);
    }

    /// Bytes of constraints and slots a pass streams.
    pub fn bytes(&self) -> usize {
        let [pins, rods] = self.batches();
        pins * (size_of::<Pin<L>>() + 8 * L::WIDTH) + rods * (size_of::<Rod<L>>() + 8 * L::WIDTH)
    }
}

/// Both sides' rows, gathered, changed and put back.
#[inline(always)]
fn with_sides<L: Lanes>(
    rows: &mut [[L::Elem; 4]],
    ends: &Joined<'_>,
    change: impl FnOnce(&mut Side<L>, &mut Side<L>),
) {
    let (mut a, mut b) = (Side::gather(rows, ends.a), Side::gather(rows, ends.b));
    change(&mut a, &mut b);
    a.scatter(rows, ends.a);
    b.scatter(rows, ends.b);
}

/// Per place the lowest colour neither dynamic body of the joint has yet, [`COLORS`] where there is none.
fn colors<R: Real>(joints: &Joints<R>, bodies: &Bodies<R>) -> Vec<u8> {
    let mut used = vec![0_u64; bodies.len()];
    let mut colors = Vec::new();
    for (place, joint) in joints.living() {
        let slots = joint.bodies.each(BodyId::slot).into_iter();
        let dynamic = slots.filter(|&slot| bodies.kind(slot) == BodyKind::Dynamic);
        let color = dynamic.clone().fold(0, |sum, slot| sum | used[slot]).trailing_ones() as usize;
        if color < COLORS {
            dynamic.for_each(|slot| used[slot] |= 1 << color);
        }
        colors.resize(place as usize + 1, COLORS as u8);
        colors[place as usize] = color as u8;
    }
    colors
}
