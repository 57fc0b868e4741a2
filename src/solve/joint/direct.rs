//! A direct solve for chains and trees of joints whose masses differ much.
//!
//! One visit a substep carries a weight's pull one joint further; a chain of 50 links that carries 50,000 times a link
//! needs thousands, and without them impulses swing up until numbers end. Where the pins of some bodies make up a tree
//! whose masses are too far apart for its length ([`HARD_RATIO`], [`HARD_LOAD`]), all its points are therefore solved
//! at once after the pass over all joints, without softness: (J·M⁻¹·Jᵀ)·Δλ = −(J·v + bias), in `f64`. The matrix has a
//! 2×2 block for each two pins that share a body; pins are eliminated from the leaves to the root, so that what is left
//! of a pin's neighbours already has blocks, and no others come to be (Davis, Direct Methods for Sparse Linear Systems,
//! 2006, §4.1: a perfect order). Work grows with the number of joints. Rows of angles are left to the pass before.
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
//! Loops are not trees: there, and where a body has more than [`MOST_PINS`], the pass over all joints is all there is.

use super::Stiffness;
use super::pin::{Pin, Response};
use super::stream::Batches;
use crate::body::Bodies;
use crate::island::root;
use crate::lanes::{Lanes, Real};
use crate::scene::BodyKind;
use crate::solve::constraint::Side;
use crate::vec2::Vec2;

/// Masses so far apart are too far for visits, in a tree of any size.
const HARD_RATIO: f64 = 64.0;
/// Where the heaviest is at least [`HARD_FROM`] times the lightest: this ratio times the square of the number of pins is
/// too much, as an error crosses n pins in n² visits.
const HARD_LOAD: f64 = 4096.0;
/// Chains of equal links are left to visits, however long.
const HARD_FROM: f64 = 1.5;
/// Pins on one body that a tree is solved with: blocks grow with their square.
const MOST_PINS: usize = 8;

/// A link's inertia that becomes this much greater in a solve slows its spin.
const BRAKED: f64 = 1.0 / 0.9;

/// 2×2, by rows.
type Block = [[f64; 2]; 2];

/// A pin of a tree.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Node {
    /// Batch and lane.
    at: [usize; 2],
    slots: [usize; 2],
}

/// How a body of a tree turns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Turning {
    /// 1/(kg·m²), its own.
    inv_inertia: f64,
    /// Inertia that its pins' pulls add, kg·m².
    borne: f64,
    /// What its pins have turned it with in this substep, N·m·s.
    torque: f64,
    /// 1/(kg·m²) by which it has turned so far.
    before: f64,
}

impl Turning {
    /// 1/(kg·m²), what its pulls add counted in.
    fn now(&self) -> f64 {
        self.inv_inertia / (1.0 + self.inv_inertia * self.borne)
    }
}

/// All trees that are solved directly; memory is kept.
#[derive(Clone, Debug, Default)]
pub(super) struct Direct {
    /// From the leaves to the root, tree after tree.
    nodes: Vec<Node>,
    /// Pins after each that share a body with it: where in `nodes`, and their block.
    later: Vec<Vec<(usize, Block)>>,
    /// Of each pin: its own block, and what is to be taken from its velocity.
    own: Vec<(Block, [f64; 2])>,
    answer: Vec<[f64; 2]>,
    pins: Vec<Pin<f64>>,
    /// By slot.
    turning: Vec<Turning>,
}

impl Direct {
    /// Pins that are solved directly.
    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(super) fn clear(&mut self) {
        self.nodes.clear();
        self.later.clear();
    }

    /// Finds the trees among the pins in these batches that masses make hard.
    pub(super) fn look_over<L: Lanes>(&mut self, pins: &Batches<Pin<L>>, bodies: &Bodies<L::Elem>) {
        let ends = pins.ends(L::WIDTH);
        let moves = |slot: usize| bodies.kind(slot) == BodyKind::Dynamic;
        let mut trees = Trees::of(ends.iter().map(|(_, slots)| *slots), bodies.len(), moves);
        self.turning.clear();
        self.turning.resize(bodies.len(), Turning::default());
        for slot in 0..bodies.len() {
            self.turning[slot].inv_inertia = bodies.inv_inertia[slot].to_f64();
        }
        let inv_mass = |slot: usize| bodies.inv_mass[slot].to_f64();
        trees.refuse_easy(inv_mass, moves);
        for depth_first in trees.orders() {
            let first = self.nodes.len();
            self.nodes.extend(depth_first.iter().map(|&k| Node { at: ends[k].0, slots: ends[k].1 }));
            for at in first..self.nodes.len() {
                let shares = |other: &usize| {
                    let shared = |slot: &usize| moves(*slot) && self.nodes[*other].slots.contains(slot);
                    self.nodes[at].slots.iter().any(shared)
                };
                let later = (at + 1..self.nodes.len()).filter(shares).map(|other| (other, [[0.0; 2]; 2]));
                self.later.push(later.collect());
            }
        }
    }

    /// A step begins: bodies of all trees turn with the inertia that the last impulses, of substeps of `h_secs`, add.
    pub(super) fn stiffen<L: Lanes>(&mut self, pins: &mut Batches<Pin<L>>, h_secs: f64) {
        self.look_at(pins);
        self.answer.clear();
        self.answer.resize(self.nodes.len(), [0.0; 2]);
        self.feel_pulls(h_secs, 1.0);
        self.hand_inertia(pins);
    }

    /// Pins as they are now.
    fn look_at<L: Lanes>(&mut self, pins: &Batches<Pin<L>>) {
        self.pins.clear();
        self.pins.extend(self.nodes.iter().map(|node| pins.link(node.at[0]).lane(node.at[1])));
    }

    /// Sums what impulses, those solved for counted in, bodies turn with.
    fn feel_pulls(&mut self, h_secs: f64, share: f64) {
        let Self { nodes, answer, pins, turning, .. } = self;
        for slot in nodes.iter().flat_map(|node| node.slots) {
            turning[slot].before = turning[slot].now();
        }
        for slot in nodes.iter().flat_map(|node| node.slots) {
            (turning[slot].borne, turning[slot].torque) = (0.0, 0.0);
        }
        let length = |v: Vec2<f64>| v.length_squared().sqrt();
        for ((node, answer), pin) in nodes.iter().zip(answer).zip(pins) {
            let given = pin.impulse();
            let pull = length(given + Vec2::new(answer[0], answer[1]) * (1.0 / share));
            for (end, sign) in [(0, -1.0), (1, 1.0)] {
                let (arm, body) = (pin.arm(end), &mut turning[node.slots[end]]);
                body.borne += h_secs * (pull * length(arm));
                body.torque += sign * share * arm.cross(given);
            }
        }
    }

    fn hand_inertia<L: Lanes>(&self, pins: &mut Batches<Pin<L>>) {
        for node in &self.nodes {
            let inv_inertia = node.slots.map(|slot| self.turning[slot].now());
            pins.link_mut(node.at[0]).set_inv_inertia(node.at[1], inv_inertia);
        }
    }

    /// Bodies turn with the inertia that the impulses just solved for add.
    fn restiffen<L: Lanes>(
        &mut self,
        pins: &mut Batches<Pin<L>>,
        rows: &mut [[L::Elem; 4]],
        how: &Stiffness<f64>,
    ) {
        self.feel_pulls(how.h, how.share());
        for slot in self.nodes.iter().flat_map(|node| node.slots) {
            let (body, spin) = (&mut self.turning[slot], rows[slot][2].to_f64());
            let now = body.now();
            // The second time that a body is met nothing has changed.
            let before = std::mem::replace(&mut body.before, now);
            let spin = if now * BRAKED < before {
                spin * (now / before)
            } else {
                // What its impulses are worth now.
                spin + body.torque * (now - before)
            };
            rows[slot][2] = L::Elem::from_f64(spin);
        }
        self.hand_inertia(pins);
    }

    /// Makes the points of all trees stand still, or close their gaps as a push says.
    pub(super) fn solve<L: Lanes>(
        &mut self,
        pins: &mut Batches<Pin<L>>,
        rows: &mut [[L::Elem; 4]],
        how: Option<&Stiffness<f64>>,
    ) {
        if self.nodes.is_empty() {
            return;
        }
        let share = how.map_or(1.0, Stiffness::share);
        self.assemble(pins, rows, how);
        self.eliminate();
        if let Some(how) = how {
            self.restiffen(pins, rows, how);
            self.assemble(pins, rows, Some(how));
            self.eliminate();
        }
        for ((node, answer), pin) in self.nodes.iter().zip(&self.answer).zip(&mut self.pins) {
            let [batch, lane] = node.at;
            let [mut a, mut b] = node.slots.map(|slot| side(rows, slot));
            let impulse = Vec2::new(answer[0], answer[1]);
            pin.apply(&mut a, &mut b, impulse, 0.0);
            put(rows, node.slots[0], &a);
            put(rows, node.slots[1], &b);
            pins.link_mut(batch).add_impulse(lane, impulse * (1.0 / share));
        }
    }

    /// Blocks and velocities as bodies are and move now.
    fn assemble<L: Lanes>(
        &mut self,
        pins: &Batches<Pin<L>>,
        rows: &[[L::Elem; 4]],
        how: Option<&Stiffness<f64>>,
    ) {
        self.look_at(pins);
        let Self { nodes, later, own, pins: now, .. } = self;
        own.clear();
        for (at, (node, pin)) in nodes.iter().zip(&*now).enumerate() {
            let [a, b] = node.slots.map(|slot| side(rows, slot));
            let [k11, k12, k22] = Response::matrix(pin, a.inv_mass + b.inv_mass);
            let wanted = pin.wanted(&a, &b, how);
            own.push(([[k11, k12], [k12, k22]], [wanted.x, wanted.y]));
            for (other, block) in &mut later[at] {
                let inv_mass = |slot| side(rows, slot).inv_mass;
                *block = coupling(pin, node.slots, &now[*other], nodes[*other].slots, inv_mass);
            }
        }
    }

    /// Block elimination from the leaves, and back.
    fn eliminate(&mut self) {
        let Self { nodes, later, own, answer, .. } = self;
        for at in 0..nodes.len() {
            let (block, wanted) = own[at];
            let inverse = inverse(block);
            let (_, rest) = later.split_at_mut(at);
            let Some((mine, rest)) = rest.split_first_mut() else { break };
            for (k, &(j, a_ij)) in mine.iter().enumerate() {
                // Aᵀ·D⁻¹, once per neighbour.
                let factor = times(transposed(a_ij), inverse);
                let taken = apply(factor, wanted);
                own[j].1 = [own[j].1[0] - taken[0], own[j].1[1] - taken[1]];
                own[j].0 = minus(own[j].0, times(factor, a_ij));
                for &(i, a_ii) in &mine[k + 1..] {
                    // Neighbours of a leaf share a body, so that they are neighbours too.
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
        answer.resize(nodes.len(), [0.0; 2]);
        for at in (0..nodes.len()).rev() {
            let (inverse, wanted) = own[at];
            let sum = later[at].iter().fold(wanted, |sum, &(j, block)| {
                let part = apply(block, answer[j]);
                [sum[0] + part[0], sum[1] + part[1]]
            });
            let solved = apply(inverse, sum);
            answer[at] = [-solved[0], -solved[1]];
        }
    }
}

/// What an impulse at one pin moves another by through the body or bodies they share: kg⁻¹.
fn coupling(
    pin: &Pin<f64>,
    slots: [usize; 2],
    other: &Pin<f64>,
    theirs: [usize; 2],
    inv_mass: impl Fn(usize) -> f64,
) -> Block {
    let mut sum = [[0.0; 2]; 2];
    for (k, &slot) in slots.iter().enumerate() {
        for (n, &there) in theirs.iter().enumerate() {
            let m = inv_mass(slot);
            if slot != there || m == 0.0 {
                continue;
            }
            let sign = if k == n { 1.0 } else { -1.0 };
            let (r, s) = (pin.arm(k), other.arm(n));
            let inv_inertia = pin.inv_inertia_of(k);
            let [ru, su] = [[-r.y, r.x], [-s.y, s.x]];
            for i in 0..2 {
                for j in 0..2 {
                    let linear = if i == j { m } else { 0.0 };
                    sum[i][j] += sign * (linear + inv_inertia * ru[i] * su[j]);
                }
            }
        }
    }
    sum
}

fn side<R: Real>(rows: &[[R; 4]], slot: usize) -> Side<f64> {
    let [x, y, spin, inv_mass] = rows[slot].map(Real::to_f64);
    Side { velocity: Vec2::new(x, y), spin, inv_mass }
}

fn put<R: Real>(rows: &mut [[R; 4]], slot: usize, side: &Side<f64>) {
    let new = [side.velocity.x, side.velocity.y, side.spin].map(R::from_f64);
    rows[slot][..3].copy_from_slice(&new);
}

fn transposed(a: Block) -> Block {
    [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]
}

fn times(a: Block, b: Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][0] * b[0][j] + a[i][1] * b[1][j]))
}

fn minus(a: Block, b: Block) -> Block {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] - b[i][j]))
}

fn apply(a: Block, v: [f64; 2]) -> [f64; 2] {
    [a[0][0] * v[0] + a[0][1] * v[1], a[1][0] * v[0] + a[1][1] * v[1]]
}

/// Zeros where nothing yields.
fn inverse(a: Block) -> Block {
    let determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
    if determinant <= 0.0 {
        return [[0.0; 2]; 2];
    }
    let per = 1.0 / determinant;
    [[a[1][1] * per, -a[0][1] * per], [-a[1][0] * per, a[0][0] * per]]
}

/// Pins by the bodies that they hang together by.
struct Trees {
    ends: Vec<[usize; 2]>,
    /// Pins on each slot, of bodies that move.
    on: Vec<Vec<usize>>,
    /// The tree of each slot, by its root.
    parent: Vec<u32>,
    /// By root: a tree, and a hard one.
    wanted: Vec<bool>,
}

impl Trees {
    fn of(ends: impl Iterator<Item = [usize; 2]>, slots: usize, moves: impl Fn(usize) -> bool) -> Self {
        let ends: Vec<_> = ends.collect();
        let mut on = vec![Vec::new(); slots];
        let mut parent: Vec<u32> = (0..slots as u32).collect();
        let mut wanted = vec![true; slots];
        for (k, &[a, b]) in ends.iter().enumerate() {
            for slot in [a, b].into_iter().filter(|&slot| moves(slot)) {
                on[slot].push(k);
            }
            if moves(a) && moves(b) {
                let [a, b] = [a, b].map(|slot| root(&mut parent, slot as u32) as usize);
                if a == b {
                    wanted[a] = false;
                } else {
                    let both = wanted[a] && wanted[b];
                    parent[b] = a as u32;
                    wanted[a] = both;
                }
            }
        }
        Self { ends, on, parent, wanted }
    }

    /// Leaves those alone whose masses are near each other.
    fn refuse_easy(&mut self, inv_mass: impl Fn(usize) -> f64, moves: impl Fn(usize) -> bool) {
        let mut spans = vec![[f64::INFINITY, 0.0f64]; self.on.len()];
        let mut pins = vec![0.0f64; self.on.len()];
        for slot in (0..self.on.len()).filter(|&slot| moves(slot) && !self.on[slot].is_empty()) {
            let tree = root(&mut self.parent, slot as u32) as usize;
            let span = &mut spans[tree];
            *span = [span[0].min(inv_mass(slot)), span[1].max(inv_mass(slot))];
            self.wanted[tree] &= self.on[slot].len() <= MOST_PINS;
            // As many as bodies, or one more or less.
            pins[tree] += 1.0;
        }
        for ((wanted, [least, most]), pins) in self.wanted.iter_mut().zip(spans).zip(pins) {
            let ratio = most / least;
            let hard = ratio >= HARD_RATIO || (ratio >= HARD_FROM && ratio * pins * pins >= HARD_LOAD);
            *wanted &= least.is_finite() && hard;
        }
    }

    /// The pins of each wanted tree, from the leaves to the root.
    fn orders(&mut self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.ends.len()];
        let mut orders = Vec::new();
        for slot in 0..self.on.len() {
            let is_root = root(&mut self.parent, slot as u32) as usize == slot;
            if !is_root || !self.wanted[slot] || self.on[slot].is_empty() {
                continue;
            }
            // Outwards from this body; read backwards each pin comes before those nearer to it.
            let (mut order, mut bodies) = (Vec::new(), vec![slot]);
            while let Some(body) = bodies.pop() {
                for &pin in &self.on[body] {
                    if !std::mem::replace(&mut seen[pin], true) {
                        order.push(pin);
                        let [a, b] = self.ends[pin];
                        bodies.extend(
                            [a, b].into_iter().filter(|&end| end != body && !self.on[end].is_empty()),
                        );
                    }
                }
            }
            order.reverse();
            orders.push(order);
        }
        orders
    }
}
