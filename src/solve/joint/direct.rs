//! A direct solve for chains, trees and nets of joints whose masses differ much.
//!
//! One visit a substep carries a weight's pull one joint further; a chain of 50 links that carries 50,000 times a link
//! needs thousands, and without them impulses swing up until numbers end. Where the rigid joints of some bodies – pins, welds,
//! rods – make up a tree whose masses are too far apart for its length (`trees`), all its rows are therefore solved at once after the pass
//! over all joints, without softness: (J·M⁻¹·Jᵀ)·Δλ = −(J·v + bias), in `f64`. The matrix has a 3×3 block for each two
//! joints that share a body; they are eliminated from the leaves to the root, so that what is left of a pin's neighbours
//! already has blocks, and no others come to be (Davis, Direct Methods for Sparse Linear Systems, 2006, §4.1: a perfect
//! order). Work grows with the number of joints. Motors, limits and
//! springs are left to the pass before.
//!
//! A light link under a heavy pull swings across it with ω² up to T/(m·L), faster than substeps can see, and directions
//! are those of the substep's beginning: beyond ωh = 2 that blows up, however exactly impulses are solved. So a link
//! turns as if it had h²·Σ T·|r| more inertia, which bounds ωh by 1: the diagonal of the geometric stiffness (Andrews,
//! Teichmann and Kry, Geometric Stiffness for Real-time Constrained Multibody Dynamics, 2017). Motions slower than
//! substeps are moved little by it; faster ones were not resolved. T is what the substep's own solve finds, which is
//! therefore done twice: with the pull of the substep before, a chain that snaps taut was thrown by up to 0.9 of its
//! fall's energy. Inertia that comes at once must not come with a spin it was never given: where it grows by more than
//! [`BRAKED`] the angular momentum stays, and energy is lost, as in any impact. (Braked at every growth, swings lost
//! 0.5 % of their energy; never, some chains still blew up.)
//!
//! What is not resolved must not ring on either. Links that tremble by a radian per second about their chain shorten it
//! by as much as a fall does, so that pulls change by half of themselves each substep and feed what trembles: at 16
//! substeps a chain of 50 under 50,000 ended in no number after 9 s. So neighbours rub, by momentum that goes from spin
//! to spin, as far as their inertia is borrowed ([`RUBBED`]: a chain that swings as one loses nothing, links that turn
//! against each other lose half of that a substep), and wholly where they turn apart by more than substeps can follow
//! ([`FOLLOWED_RAD`]; the fourth power, so that substeps make what it takes from the rest vanish: with the first power
//! chains of 70:1 lost 5 % in five seconds at any number of substeps).
//!
//! Nets, which close on themselves, are eliminated in the order that fills in least, and blocks come to be. Where that is
//! too much, and where a body has more than a few pins, the pass over all joints is all there is.

mod block;
mod find;
mod link;
mod trees;

use super::Stiffness;
use super::batches::Batches;
use super::pin::Pin;
use super::rod::Rod;
use crate::each::Each as _;
use crate::lanes::{Lanes, Real};
use crate::solve::constraint::Side;
use crate::vec2::Vec2;
use block::{Block, Triple, apply, inverse, inverse_by_pivots, minus, times, transposed};
use link::{Kind, Link};

/// A link's inertia that becomes this much greater in a solve slows its spin.
const BRAKED: f64 = 1.0 / 0.9;

/// The share of a difference in spin that two neighbours of only borrowed inertia lose in a substep.
const RUBBED: f64 = 0.5;
/// Neighbours that turn apart by as much in a substep lose all of their difference; by half as much, 1/16 of it.
const FOLLOWED_RAD: f64 = 1.0 / 12.0;

/// A joint of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    kind: Kind,
    /// Batch and lane.
    at: [usize; 2],
    slots: [usize; 2],
    /// What is added to its diagonal, as a share: of nets.
    shared: f64,
}

/// A body of a tree.
#[derive(Clone, Copy, Debug)]
struct Member {
    side: Side<f64>,
    /// 1/kg and 1/(kg·m²), its own.
    own_inv_mass: f64,
    inv_inertia: f64,
    /// Inertia that its pins' pulls add, kg·m².
    borne: f64,
    /// ω² with which rods swing it across them, 1/s².
    swing: f64,
    /// What its pins have turned it with in this substep, N·m·s.
    torque: f64,
    /// 1/(kg·m²) by which it has turned so far.
    before: f64,
}

impl Member {
    /// 1/(kg·m²), what its pulls add counted in.
    fn now(&self) -> f64 {
        self.inv_inertia / (1.0 + self.inv_inertia * self.borne)
    }

    /// The share of its inertia that its pulls add.
    fn lent(&self) -> f64 {
        let borne = self.inv_inertia * self.borne;
        borne / (1.0 + borne)
    }
}

/// All trees that are solved directly; memory is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Direct {
    /// From the leaves to the root, tree after tree.
    nodes: Vec<Node>,
    /// Where each tree ends.
    tree_ends: Vec<usize>,
    /// Pins after each that share a body with it: where in `nodes`, and their block.
    later: Vec<Vec<(usize, Block)>>,
    /// Of each pin: its own block, and what is to be taken from its velocity.
    own: Vec<(Block, Triple)>,
    answer: Vec<Triple>,
    links: Vec<Link>,
    /// By slot.
    members: Vec<Member>,
    /// The largest ω² of bodies across their rods at the end of this step and of the last.
    swings: [f64; 2],
    /// Whose swing was foreseen: slots of joints.
    foreseen: Vec<[usize; 2]>,
}

impl Direct {
    /// ω of the body that its rods' pulls swing fastest across them, rad/s: what both of the last steps saw, for a snap asks
    /// for nothing.
    pub(super) fn swing(&self) -> f64 {
        if self.nodes.is_empty() { 0.0 } else { self.swings[0].min(self.swings[1]).sqrt() }
    }

    /// Pins that are solved directly.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.later.clear();
        self.tree_ends.clear();
    }

    /// A step begins: bodies of all trees turn with the inertia that the last impulses, of substeps of `h_secs`, add.
    pub(super) fn stiffen<L: Lanes>(
        &mut self,
        pins: &mut Batches<Pin<L>>,
        rods: &mut Batches<Rod<L>>,
        h_secs: f64,
    ) {
        self.look_at(pins, rods);
        self.answer.clear();
        self.answer.resize(self.nodes.len(), [0.0; 3]);
        self.swings[1] = self.swings[0];
        self.feel_pulls(h_secs, 1.0);
        self.hand_inertia(pins, rods);
    }

    /// Joints as they are now.
    fn look_at<L: Lanes>(&mut self, pins: &Batches<Pin<L>>, rods: &Batches<Rod<L>>) {
        self.links.clear();
        self.links.extend(self.nodes.iter().map(|node| {
            let [batch, lane] = node.at;
            if node.kind == Kind::Rod {
                let [impulse, rest] = rods.link(batch).row().held_lane(lane);
                Link::Rod(rods.link(batch).lane(lane), rest, impulse)
            } else {
                let [_, rest] = pins.link(batch).row().held_lane(lane);
                Link::Pin(pins.link(batch).lane(lane), rest, node.kind)
            }
        }));
    }

    /// Sums what impulses, those solved for counted in, bodies turn with.
    fn feel_pulls(&mut self, h_secs: f64, share: f64) {
        let Self { nodes, answer, links, members, swings, .. } = self;
        for slot in nodes.iter().flat_map(|node| node.slots) {
            members[slot].before = members[slot].now();
        }
        for slot in nodes.iter().flat_map(|node| node.slots) {
            (members[slot].borne, members[slot].swing, members[slot].torque) = (0.0, 0.0, 0.0);
        }
        let length = |v: Vec2<f64>| v.length_squared().sqrt();
        for ((node, answer), link) in nodes.iter().zip(answer).zip(&*links) {
            let given = link.impulse();
            let pull = length(given + link.force(*answer) * (1.0 / share));
            for (end, sign) in [(0, -1.0), (1, 1.0)] {
                let (arm, body) = (link.arm(end), &mut members[node.slots[end]]);
                body.borne += h_secs * (pull * length(arm));
                body.swing += link.per_length() * (pull / h_secs) * body.own_inv_mass;
                body.torque += sign * share * arm.cross(given);
            }
        }
        let fastest = nodes.iter().flat_map(|node| node.slots).map(|slot| members[slot].swing);
        swings[0] = fastest.fold(0.0, f64::max);
        for (node, link) in nodes.iter().zip(links) {
            link.set_inv_inertia(node.slots.each(|slot| members[slot].now()));
        }
    }

    fn hand_inertia<L: Lanes>(&self, pins: &mut Batches<Pin<L>>, rods: &mut Batches<Rod<L>>) {
        for node in &self.nodes {
            let inv_inertia = node.slots.each(|slot| self.members[slot].now());
            if node.kind == Kind::Rod {
                rods.link_mut(node.at[0]).set_inv_inertia(node.at[1], inv_inertia);
            } else {
                pins.link_mut(node.at[0]).set_inv_inertia(node.at[1], inv_inertia);
            }
        }
    }

    /// Bodies turn with the inertia that the impulses just solved for add.
    fn restiffen(&mut self, how: &Stiffness<f64>) {
        self.feel_pulls(how.h, how.share());
        for slot in self.nodes.iter().flat_map(|node| node.slots) {
            let body = &mut self.members[slot];
            let now = body.now();
            // The second time that a body is met nothing has changed.
            let before = std::mem::replace(&mut body.before, now);
            if now * BRAKED < before {
                body.side.spin *= now / before;
            } else {
                // What its impulses are worth now.
                body.side.spin += body.torque * (now - before);
            }
        }
    }

    /// Takes from neighbours' spins a share of what they differ by: [`RUBBED`], as far as what they turn with is not
    /// their own, or what turns too far from its neighbour in a substep to be followed.
    fn rub(&mut self, h_secs: f64) {
        for &Node { slots: [first, second], .. } in &self.nodes {
            let [a, b] = [first, second].each(|slot| self.members[slot]);
            let inv_inertia = [a.now(), b.now()];
            let (apart, sum) = (b.side.spin - a.side.spin, inv_inertia[0] + inv_inertia[1]);
            let unresolved = (h_secs * apart / FOLLOWED_RAD).powi(4).min(1.0);
            let share = unresolved.max(RUBBED * a.lent() * b.lent());
            if sum > 0.0 {
                let impulse = share * apart / sum;
                self.members[first].side.spin += inv_inertia[0] * impulse;
                self.members[second].side.spin -= inv_inertia[1] * impulse;
            }
        }
    }

    /// Makes the points of all trees stand still, or close their gaps as a push says.
    pub(super) fn solve<L: Lanes>(
        &mut self,
        (pins, rods): (&mut Batches<Pin<L>>, &mut Batches<Rod<L>>),
        rows: &mut [[L::Elem; 4]],
        how: Option<&Stiffness<f64>>,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        self.look_at(pins, rods);
        for slot in self.nodes.iter().flat_map(|node| node.slots) {
            self.members[slot].side = side(rows[slot]);
        }
        if let Some(how) = how {
            self.rub(how.h);
        }
        self.assemble(how);
        self.eliminate();
        if let Some(how) = how {
            self.restiffen(how);
            self.assemble(Some(how));
            self.eliminate();
            self.hand_inertia(pins, rods);
        }
        self.give((pins, rods), rows, how.map_or(1.0, Stiffness::share));
    }

    /// Hands impulses to the joints, and velocities to the rows.
    fn give<L: Lanes>(
        &mut self,
        (pins, rods): (&mut Batches<Pin<L>>, &mut Batches<Rod<L>>),
        rows: &mut [[L::Elem; 4]],
        share: f64,
    ) {
        let Self { nodes, answer, links, members, .. } = self;
        for ((node, answer), link) in nodes.iter().zip(answer).zip(links) {
            for (end, slot) in node.slots.into_iter().enumerate() {
                let body = &mut members[slot];
                let given = apply(transposed(link.jacobian(end)), *answer);
                let Side { velocity, spin, inv_mass } = body.side;
                let now = body.now();
                body.side.velocity = velocity + Vec2::new(given[0], given[1]) * inv_mass;
                body.side.spin = spin + now * given[2];
            }
            let ([batch, lane], per_share) = (node.at, 1.0 / share);
            if node.kind == Kind::Rod {
                rods.link_mut(batch).row_mut().add_limit(lane, answer[0] * per_share);
            } else {
                let pin = pins.link_mut(batch);
                pin.add_impulse(lane, Vec2::new(answer[0], answer[1]) * per_share);
                if node.kind == Kind::Weld {
                    pin.row_mut().add_limit(lane, answer[2] * per_share);
                }
            }
        }
        for slot in nodes.iter().flat_map(|node| node.slots) {
            let Side { velocity, spin, .. } = members[slot].side;
            rows[slot][..3].copy_from_slice(&[velocity.x, velocity.y, spin].each(L::Elem::from_f64));
        }
    }

    /// Blocks and velocities as bodies are and move now.
    fn assemble(&mut self, how: Option<&Stiffness<f64>>) {
        let Self { nodes, later, own, links, members, .. } = self;
        own.clear();
        for (at, (node, link)) in nodes.iter().zip(&*links).enumerate() {
            let [a, b] = node.slots.each(|slot| members[slot].side);
            let masses = |slot: usize| [members[slot].side.inv_mass, members[slot].now()];
            let mut block = coupling(link, node.slots, link, node.slots, masses);
            // Rows that are none answer with nothing.
            for row in link.rows()..3 {
                block[row][row] = 1.0;
            }
            for row in 0..3 {
                block[row][row] *= 1.0 + node.shared;
            }
            own.push((block, link.wanted(&a, &b, how)));
            for (other, block) in &mut later[at] {
                *block = coupling(link, node.slots, &links[*other], nodes[*other].slots, masses);
            }
        }
    }

    /// Block elimination from the leaves, and back.
    fn eliminate(&mut self) {
        let Self { nodes, later, own, answer, .. } = self;
        for at in 0..nodes.len() {
            let (block, wanted) = own[at];
            let inverse = if nodes[at].shared > 0.0 { inverse_by_pivots(block) } else { inverse(block) };
            let (_, rest) = later.split_at_mut(at);
            let Some((mine, rest)) = rest.split_first_mut() else { break };
            for (k, &(j, a_ij)) in mine.iter().enumerate() {
                // Aᵀ·D⁻¹, once per neighbour.
                let factor = times(transposed(a_ij), inverse);
                let taken = apply(factor, wanted);
                own[j].1 = crate::each::indexed(|k| own[j].1[k] - taken[k]);
                own[j].0 = minus(own[j].0, times(factor, a_ij));
                for &(i, a_ii) in &mine[k + 1..] {
                    // In a tree neighbours of a leaf share a body, in a net `fill_in` made them neighbours.
                    let change = times(factor, a_ii);
                    let theirs = &mut rest[j - at - 1];
                    if let Some((_, block)) = theirs.iter_mut().find(|(other, _)| *other == i) {
                        *block = minus(*block, change);
                    }
                }
            }
            own[at].0 = inverse;
        }
        answer.clear();
        answer.resize(nodes.len(), [0.0; 3]);
        for at in (0..nodes.len()).rev() {
            let (inverse, wanted) = own[at];
            let sum = later[at].iter().fold(wanted, |sum, &(j, block)| {
                let part = apply(block, answer[j]);
                crate::each::indexed(|k| sum[k] + part[k])
            });
            answer[at] = apply(inverse, sum).each(|solved: f64| -solved);
        }
    }
}

/// What impulses of one joint change the rows of another by through the body or bodies they share: J·M⁻¹·Jᵀ.
fn coupling(
    link: &Link,
    slots: [usize; 2],
    other: &Link,
    theirs: [usize; 2],
    masses: impl Fn(usize) -> [f64; 2],
) -> Block {
    let mut sum = [[0.0; 3]; 3];
    for (k, &slot) in slots.iter().enumerate() {
        for (n, &there) in theirs.iter().enumerate() {
            let [m, i] = masses(slot);
            if slot != there || m == 0.0 {
                continue;
            }
            let (own, their) = (link.jacobian(k), other.jacobian(n));
            for (sums, own) in sum.iter_mut().zip(own) {
                for (sum, their) in sums.iter_mut().zip(their) {
                    *sum += m * (own[0] * their[0] + own[1] * their[1]) + i * (own[2] * their[2]);
                }
            }
        }
    }
    sum
}

fn side<R: Real>(row: [R; 4]) -> Side<f64> {
    let [x, y, spin, inv_mass] = row.each(Real::to_f64);
    Side { velocity: Vec2::new(x, y), spin, inv_mass }
}
