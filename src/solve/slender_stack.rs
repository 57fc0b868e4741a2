//! Slender stacks: what stands on one contact alone, and how many substeps it takes to stand, and to stand where it is.
//!
//! Soft contacts yield, so a stack leans and its weight bends it further. A contact of two points w apart, each with
//! stiffness k, answers a turn θ with the moment c·θ, c = k₀k₁/(k₀ + k₁)·w². What it alone carries weighs N along the
//! normal and has its centre of mass h above it: per radian that is the moment N·h. The stack buckles where Σ N·h/c over
//! its contacts passes 1 (Dunkerley's bound, on the safe side: of n equal boxes n³ may be 6·c/(m·g·ℓ), where the
//! column of n joints bears 7.84). k grows with the square of the substeps, so a stack asks for √Σ of them, Σ for one.
//!
//! Measured with boxes of 1 m, 60 steps a second: by the bound 80 need 30 substeps. With 8 they lean by 3.5 times as
//! much every two seconds and fall after 16, with 16 twice as much and after 34, with 32 they stand; f64 alike.
//!
//! Which contacts carry something alone is found by peeling: a body with one contact is given to the body below it, with
//! all it carries, until what is left holds on to itself in rings. Bodies with joints are not peeled. What has its centre
//! of mass not above its contact's points adds nothing, as on a single point: no stiffness keeps it from tipping.
//! The same weight N along the normal presses a contact of effective mass m in by N/(m·ω²): where that is more than a
//! few thousandths of the smaller body's size, the stack asks for as many substeps as make it one.
//! Weights are those of all fields and forces that act on bodies at rest where they are, not the impulses that contacts hold:
//! they are right from the first step on,
//! and an impact asks for nothing.

use super::batches::{Ends, Visit};
use super::constraint::Constraint;
use super::direct::DirectContacts;
use super::substep_group::Goal;
use crate::body::{Bodies, BodyKind};
use crate::each::Each as _;
use crate::force::{Field, acceleration_of};
use crate::lanes::{Lanes, Real};

/// What stands on one contact alone and would sink in by more than [`BORNE`] times this share of the smaller body's radius
/// gets the substeps with which it does not sink further than this: a thousandth of a box's side.
const MOST_SAG: f64 = 1.3e-3;
/// Under standard gravity 13 boxes of 1 m on each other, or one of 4 cm, are borne by 4 substeps; ten sink by 1.5e-3.
const BORNE: f64 = 2.0;
/// Contacts there is room for from the beginning.
const ROOM: usize = 64;
/// A body with joints has at least so many contacts: more than can be peeled off it.
const JOINED: u32 = 1 << 30;

/// A contact that may carry something.
#[derive(Clone, Copy, Debug)]
struct Edge {
    slots: [u32; 2],
    /// m₀m₁/(m₀ + m₁)·w² with the points' effective masses, kg·m²; 0 unless there are two points.
    turn: f64,
    /// Effective mass of its points together, kg.
    mass: f64,
    /// From A's centroid to the points, along the normal, metres.
    ahead: f64,
    /// From A's centroid to either point, along the tangent, metres.
    aside: [f64; 2],
    /// From A to B.
    normal: [f64; 2],
}

/// What a body carries, with itself.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    /// Contacts that have not been peeled.
    contacts: u32,
    /// Their numbers, joined by exclusive or: of one that is left, its number.
    which: u32,
    /// What pulls it and what it carries, N.
    weight: [f64; 2],
    /// Sum of the magnitudes of those, N.
    load: f64,
    /// Magnitude times place, N·m.
    moment: [f64; 2],
    /// The largest Σ N·h/c of one substep over what stands on it.
    sum: f64,
}

/// Slender stacks; memory is kept from look to look.
#[derive(Clone, Debug)]
pub(crate) struct SlenderStacks {
    edges: Vec<Edge>,
    parts: Vec<Part>,
    /// Slots with one contact left.
    loose: Vec<u32>,
}

impl Default for SlenderStacks {
    fn default() -> Self {
        // A world whose bodies touch but now and then does not allocate when they do.
        Self { edges: Vec::with_capacity(ROOM), parts: Vec::new(), loose: Vec::new() }
    }
}

impl SlenderStacks {
    /// A visitor that notes contacts whose gap is at most `touch` of the pair's length, or that carry something.
    pub(super) fn reading<L: Lanes>(&mut self, touch: f64) -> Touching<'_, L> {
        self.edges.clear();
        Touching { edges: &mut self.edges, touch: L::lit(touch), first: 0 }
    }

    /// Substeps that the stack needs that stands on each body's way down, per slot: so as not to lean, and not to sink in;
    /// the second below 0 for what holds on to itself in rings. `joined`: slots of joints; `direct`: contacts that do not
    /// give way.
    pub(super) fn look<R: Real>(
        &mut self,
        goal: &Goal,
        (bodies, fields): (&Bodies<R>, &[Field<R>]),
        (joined, direct): (impl Iterator<Item = [u32; 2]>, &DirectContacts),
        needs: &mut Vec<[f64; 2]>,
    ) {
        needs.clear();
        if !self.edges.iter().any(|edge| edge.turn > 0.0) {
            return;
        }
        needs.resize(bodies.len(), [0.0; 2]);
        self.weigh(bodies, fields, joined);
        let movable = |slot: usize| bodies.kind(slot) == BodyKind::Dynamic;
        let one_left = |slot: &usize| self.parts[*slot].contacts == 1 && movable(*slot);
        self.loose.clear();
        self.loose.extend((0..bodies.len()).filter(one_left).map(|slot| slot as u32));
        let mut next = 0;
        while let Some(&slot) = self.loose.get(next) {
            next += 1;
            let part = self.parts[slot as usize];
            // The other end of its last contact was peeled first.
            if part.contacts != 1 {
                continue;
            }
            let edge = self.edges[part.which as usize];
            let below = edge.slots[usize::from(edge.slots[0] == slot)] as usize;
            let sum = part.sum + goal.leaning(edge.moment(slot, &part, bodies), edge.turn);
            let sizes = edge.slots.each(|slot| bodies.radius[slot as usize].to_f64());
            // What nothing moves may be as small as a pin, or the world itself.
            let size =
                if movable(below) { sizes[0].min(sizes[1]) } else { bodies.radius[slot as usize].to_f64() };
            let sinking = goal.sinking(edge.pressed(slot, &part), edge.mass) / (MOST_SAG * size);
            // Discs alone do not stand on each other.
            let asks = goal.holds_up && edge.turn > 0.0 && sinking > BORNE * f64::from(goal.base).powi(2);
            let asks = asks && part.rests(bodies, slot as usize) && !direct.holds(slot);
            let sinking = if asks { sinking } else { 0.0 };
            needs[slot as usize] = [sum, sinking].each(f64::sqrt);
            self.parts[slot as usize].contacts = 0;
            if !movable(below) {
                continue;
            }
            let onto = &mut self.parts[below];
            onto.contacts -= 1;
            onto.which ^= part.which;
            onto.load += part.load;
            onto.weight = [0, 1].each(|k| onto.weight[k] + part.weight[k]);
            onto.moment = [0, 1].each(|k| onto.moment[k] + part.moment[k]);
            onto.sum = onto.sum.max(sum);
            if onto.contacts == 1 {
                self.loose.push(below as u32);
            }
        }
        for (needs, _) in needs.iter_mut().zip(&self.parts).filter(|(_, part)| part.contacts > 0) {
            needs[1] = -1.0;
        }
    }

    /// Each body alone, and how many contacts it has.
    fn weigh<R: Real>(
        &mut self,
        bodies: &Bodies<R>,
        fields: &[Field<R>],
        joined: impl Iterator<Item = [u32; 2]>,
    ) {
        self.parts.clear();
        self.parts.resize(bodies.len(), Part::default());
        // Bodies may have gone since.
        self.edges.retain(|edge| edge.slots.iter().all(|&slot| bodies.is_alive(slot as usize) || slot == 0));
        for (number, edge) in self.edges.iter().enumerate() {
            for slot in edge.slots {
                let part = &mut self.parts[slot as usize];
                part.contacts += 1;
                part.which ^= number as u32;
            }
        }
        for slot in joined.flatten() {
            self.parts[slot as usize].contacts |= JOINED;
        }
        for (slot, part) in self.parts.iter_mut().enumerate() {
            let inv_mass = bodies.inv_mass[slot].to_f64();
            if inv_mass > 0.0 && part.contacts > 0 {
                let place = bodies.place(slot);
                let pull = acceleration_of(fields, bodies, slot, [place, [0.0; 2]], 0.0);
                part.weight = pull.each(|pull| pull / inv_mass);
                part.load = part.weight[0].hypot(part.weight[1]);
                part.moment = place.each(|at| part.load * at);
            }
        }
    }
}

impl Part {
    /// Is the body that carries this slower than what it would fall by in a tenth of its size? What is stirred or falls
    /// asks for nothing.
    fn rests<R: Real>(&self, bodies: &Bodies<R>, slot: usize) -> bool {
        let speed = bodies.vx[slot].to_f64().hypot(bodies.vy[slot].to_f64());
        let pull = self.load * bodies.inv_mass[slot].to_f64();
        speed * speed < 0.02 * pull * bodies.radius[slot].to_f64()
    }
}

impl Edge {
    /// What `slot` carries presses its points together by so much, N.
    fn pressed(&self, slot: u32, part: &Part) -> f64 {
        let along = part.weight[0] * self.normal[0] + part.weight[1] * self.normal[1];
        (if self.slots[0] == slot { along } else { -along }).max(0.0)
    }

    /// N·h of what `slot` carries, N·m per radian; 0 where that does not stand on the points.
    fn moment<R: Real>(&self, slot: u32, part: &Part, bodies: &Bodies<R>) -> f64 {
        if part.load <= 0.0 {
            return 0.0;
        }
        let a = self.slots[0] as usize;
        let from_a = |k: usize| part.moment[k] / part.load - bodies.place(a)[k];
        let center = [from_a(0), from_a(1)];
        let ([nx, ny], [tx, ty]) = (self.normal, [-self.normal[1], self.normal[0]]);
        let along = |v: [f64; 2]| v[0] * nx + v[1] * ny;
        let across = |v: [f64; 2]| v[0] * tx + v[1] * ty;
        let (ahead, pull) = (along(center) - self.ahead, along(part.weight));
        // Where the plumb line through the centre of mass meets the line of the points.
        let plumb = across(center) - across(part.weight) / pull * ahead;
        let [first, last] = self.aside;
        let stands = first.min(last) < plumb && plumb < first.max(last);
        // Away from what carries it.
        let away = if self.slots[0] == slot { -1.0 } else { 1.0 };
        if stands && away * ahead > 0.0 { (-away * pull).max(0.0) * (away * ahead) } else { 0.0 }
    }
}

/// Notes contacts that touch.
#[derive(Debug)]
pub(super) struct Touching<'a, L> {
    edges: &'a mut Vec<Edge>,
    touch: L,
    first: u32,
}

impl<L> Touching<'_, L> {
    /// The same, of contacts whose slots count from this one.
    pub(super) fn from(&mut self, first: usize) -> &mut Self {
        self.first = first as u32;
        self
    }
}

impl<L: Lanes> Visit<L> for Touching<'_, L> {
    fn visit<const POINTS: usize>(&mut self, c: &mut Constraint<L, POINTS>, ends: Ends<'_>, _: usize) {
        let zero = L::zero();
        let touches = c.points.each(|point| {
            let near = zero.lt(point.velocity_impulse) | point.separation.le(self.touch * c.length);
            L::select(near & zero.lt(point.mass), point.mass, zero).to_array()
        });
        let levers = c.points.each(|point| point.levers[0].to_array());
        let [nx, ny, ahead] = [c.normal.x, c.normal.y, c.tangent_levers[0]].each(L::to_array);
        for lane in 0..L::WIDTH {
            let [m, n] = [touches[0][lane].to_f64(), touches[POINTS - 1][lane].to_f64()];
            if m + n > 0.0 {
                // The lever r×n is −r·t.
                let aside = [0, POINTS - 1].each(|k| -levers[k][lane].to_f64());
                let turn = m * n / (m + n) * (aside[0] - aside[1]).powi(2);
                let normal = [nx[lane], ny[lane]].each(L::Elem::to_f64);
                let slots = [ends.a[lane], ends.b[lane]].each(|slot| slot + self.first);
                let mass = if POINTS == 1 { m } else { m + n };
                self.edges.push(Edge { slots, turn, mass, ahead: ahead[lane].to_f64(), aside, normal });
            }
        }
    }
}
