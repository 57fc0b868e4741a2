//! Which joints are solved directly, and in what order.

use super::link::Kind;
use super::trees::{Order, Trees};
use super::{Direct, Member, Node};
use crate::body::{Bodies, BodyKind};
use crate::each::Each as _;
use crate::force::{Field, acceleration_of};
use crate::lanes::{Lanes, Real};
use crate::solve::constraint::Side;
use crate::solve::joint::batches::Batches;
use crate::solve::joint::pin::Pin;
use crate::solve::joint::rod::Rod;
use crate::vec2::Vec2;

/// Added to the diagonals of nets, as a share of them: rows that depend on each other share what they carry. It softens
/// changes of the impulses alone, so that what a net carries for long it carries nearly whole: a truss of ten bays and 0.1 kg a node
/// sags under 100 kg by 0.2 mm with 1e-4, 1.6 mm with 1e-3, 4.6 mm with 3e-3; one with both diagonals feeds its rounding errors
/// to no number with 1e-4, and under 1000 kg with 1e-3.
const SHARED_BY_RODS: f64 = 3e-3;
/// The same where none are rods: a ring of twelve welds under 500 kg is off by 4e-2 of its radius with 1e-3, 1e-2 with 1e-4.
const SHARED: f64 = 1e-4;
/// How far from their centroids bodies of nets may be held, in bounding radii. Of 256 worlds of random joints, in loops and twice
/// over, with masses 10,000 apart and levers of ten radii, 13 ended in no number where such nets were solved directly, one without.
const MOST_REACH: f64 = 2.0;

impl Direct {
    /// Finds the trees among the rigid joints in these batches that masses make hard.
    pub(in crate::solve::joint) fn look_over<L: Lanes>(
        &mut self,
        pins: &Batches<Pin<L>>,
        rods: &Batches<Rod<L>>,
        bodies: &Bodies<L::Elem>,
    ) {
        let pin = |(at, slots): ([usize; 2], [usize; 2])| {
            let welded = pins.link(at[0]).row().is_rigid(at[1]);
            Node { kind: if welded { Kind::Weld } else { Kind::Pin }, at, slots, shared: 0.0 }
        };
        let rod = |(at, slots): ([usize; 2], [usize; 2])| {
            rods.link(at[0]).row().is_rigid(at[1]).then_some(Node { kind: Kind::Rod, at, slots, shared: 0.0 })
        };
        let mut ends: Vec<Node> = pins.ends(L::WIDTH).into_iter().map(pin).collect();
        ends.extend(rods.ends(L::WIDTH).into_iter().filter_map(rod));
        let moves: Vec<bool> = (0..bodies.len()).map(|slot| bodies.kind(slot) == BodyKind::Dynamic).collect();
        self.members.clear();
        self.members.extend((0..bodies.len()).map(|slot| Member {
            side: Side { velocity: Vec2::zero(), spin: 0.0, inv_mass: 0.0 },
            own_inv_mass: bodies.inv_mass[slot].to_f64(),
            inv_inertia: bodies.inv_inertia[slot].to_f64(),
            borne: 0.0,
            swing: 0.0,
            torque: 0.0,
            before: 0.0,
        }));
        let far = |node: &Node| {
            let [batch, lane] = node.at;
            (0..2).any(|end| {
                let slot = node.slots[end];
                let reach = match node.kind {
                    Kind::Rod => rods.link(batch).reach(end, lane),
                    Kind::Pin | Kind::Weld => pins.link(batch).reach(end, lane),
                };
                moves[slot] && reach > MOST_REACH * bodies.radius[slot].to_f64()
            })
        };
        let far: Vec<usize> = (0..ends.len()).filter(|&k| far(&ends[k])).collect();
        self.take_trees(&ends, &far, &moves);
    }

    /// Of these joints, those that make up trees or nets that are solved at once. `far`: which hold bodies too far out for nets;
    /// `moves`: which bodies can, by slot. Knows no lanes, so that there is one of it.
    fn take_trees(&mut self, ends: &[Node], far: &[usize], moves: &[bool]) {
        let mut trees = Trees::of(ends.iter().map(|node| (node.slots, node.kind == Kind::Weld)), moves);
        trees.refuse_nets(far);
        trees.refuse_easy(|slot| self.members[slot].own_inv_mass, moves);
        for Order { joints, looped } in trees.orders() {
            let first = self.nodes.len();
            let shared = match looped {
                true if joints.iter().any(|&k| ends[k].kind == Kind::Rod) => SHARED_BY_RODS,
                true => SHARED,
                false => 0.0,
            };
            self.nodes.extend(joints.iter().map(|&k| Node { shared, ..ends[k] }));
            for at in first..self.nodes.len() {
                let shares = |other: &usize| {
                    let shared = |slot: &usize| moves[*slot] && self.nodes[*other].slots.contains(slot);
                    self.nodes[at].slots.iter().any(shared)
                };
                let later = (at + 1..self.nodes.len()).filter(shares).map(|other| (other, [[0.0; 3]; 3]));
                self.later.push(later.collect());
            }
            if looped {
                self.fill_in(first);
            }
            self.tree_ends.push(self.nodes.len());
        }
    }

    /// Before impulses are known: rods may have to pull with the weight of their whole tree or net. Of joints that were solved
    /// directly before they are.
    pub(in crate::solve::joint) fn foresee_swing<L: Lanes>(
        &mut self,
        rods: &Batches<Rod<L>>,
        (bodies, fields): (&Bodies<L::Elem>, &[Field<L::Elem>]),
    ) {
        if self.nodes.iter().map(|node| node.slots).eq(self.foreseen.iter().copied()) {
            return;
        }
        let pull = |slot: usize| {
            let velocity = [bodies.vx[slot], bodies.vy[slot]].each(Real::to_f64);
            let [x, y] = acceleration_of(fields, bodies, slot, [bodies.place(slot), velocity], 0.0);
            x.hypot(y)
        };
        self.swing_under(&pull, &|[batch, lane]| rods.link(batch).row().held_lane(lane)[1]);
    }

    /// As fast as under weights by `pull`, m/s² by slot; `length`: of the rod in a batch and lane, metres.
    fn swing_under(&mut self, pull: &dyn Fn(usize) -> f64, length: &dyn Fn([usize; 2]) -> f64) {
        self.foreseen.clear();
        self.foreseen.extend(self.nodes.iter().map(|node| node.slots));
        let mut counted = vec![false; self.members.len()];
        let (mut first, mut fastest) = (0, 0.0f64);
        for &end in &self.tree_ends {
            let nodes = &self.nodes[first..end];
            first = end;
            let mut weight = 0.0;
            for slot in nodes.iter().flat_map(|node| node.slots) {
                let inv_mass = self.members[slot].own_inv_mass;
                if inv_mass > 0.0 && !std::mem::replace(&mut counted[slot], true) {
                    weight += pull(slot) / inv_mass;
                }
            }
            for node in nodes.iter().filter(|node| node.kind == Kind::Rod) {
                let rest = length(node.at);
                for slot in node.slots {
                    let body = &mut self.members[slot];
                    body.swing += weight * body.own_inv_mass / rest.max(f64::MIN_POSITIVE);
                    fastest = fastest.max(body.swing);
                }
            }
        }
        self.swings = [fastest; 2];
    }

    /// Neighbours of a joint become neighbours as it is eliminated: those from `first` on get the blocks that come to be.
    fn fill_in(&mut self, first: usize) {
        for at in first..self.later.len() {
            self.later[at].sort_unstable_by_key(|&(other, _)| other);
            let around: Vec<usize> = self.later[at].iter().map(|&(other, _)| other).collect();
            for (k, &near) in around.iter().enumerate() {
                for &far in &around[k + 1..] {
                    if self.later[near].iter().all(|&(other, _)| other != far) {
                        self.later[near].push((far, [[0.0; 3]; 3]));
                    }
                }
            }
        }
    }
}
