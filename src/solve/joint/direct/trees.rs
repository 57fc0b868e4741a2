//! Which joints make up trees or nets whose masses are too far apart for visits, and in what order these are eliminated.

use std::collections::{BTreeMap, BTreeSet};

use crate::partition::Sets;

/// Masses so far apart are too far for visits, in a tree of any size.
const HARD_RATIO: f64 = 64.0;
/// Where the heaviest is at least [`HARD_FROM`] times the lightest: this ratio times the square of the number of pins is
/// too much, as an error crosses n pins in n² visits.
const HARD_LOAD: f64 = 4096.0;
/// Chains of equal links are left to visits, however long.
const HARD_FROM: f64 = 1.5;
/// The same of nets, where an error goes round.
const HARD_NET: f64 = 256.0;
/// Pins on one body that a tree is solved with: blocks grow with their square.
const MOST_PINS: usize = 8;
/// Joints of a net, and blocks beside the diagonal for each of them: what an elimination fills in.
const MOST_JOINTS: usize = 512;
const MOST_BLOCKS: usize = 16;

/// The joints of a tree or net, in the order of their elimination.
pub(super) struct Order {
    pub joints: Vec<usize>,
    /// It closes on itself: eliminating a joint makes neighbours of its neighbours, and rows may depend on each other.
    pub looped: bool,
}

/// Pins by the bodies that they hang together by.
pub(super) struct Trees {
    ends: Vec<[usize; 2]>,
    /// Pins on each slot, of bodies that move.
    on: Vec<Vec<usize>>,
    /// Whom pins join.
    sets: Sets,
    /// By the lowest slot of a set: a hard one.
    wanted: Vec<bool>,
    /// Likewise: not a tree.
    looped: Vec<bool>,
}

impl Trees {
    /// Of joints between these slots, of which some are welds. `moves`: which bodies can, by slot.
    pub(super) fn of(ends: impl Iterator<Item = ([usize; 2], bool)>, moves: &[bool]) -> Self {
        let slots = moves.len();
        let (ends, welds): (Vec<_>, Vec<_>) = ends.unzip();
        let mut on = vec![Vec::new(); slots];
        let mut sets = Sets::default();
        sets.part(slots, std::slice::from_ref(&(0..slots)));
        let mut looped = vec![false; slots];
        for (k, &[a, b]) in ends.iter().enumerate() {
            for slot in [a, b].into_iter().filter(|&slot| moves[slot]) {
                on[slot].push(k);
            }
            if moves[a] && moves[b] {
                match sets.join([a as u32, b as u32]) {
                    Some([low, high]) => looped[low as usize] |= looped[high as usize],
                    // They hang together already.
                    None => looped[sets.of(a as u32) as usize] = true,
                }
            }
        }
        // What hangs from the ground by two joints closes on itself through it; with pins alone its rows are still independent.
        let mut held = vec![(0, false); slots];
        for (&[a, b], weld) in ends.iter().zip(welds) {
            let Some(end) = [a, b].into_iter().find(|&slot| moves[slot]) else { continue };
            let (anchors, has_weld) = &mut held[sets.of(end as u32) as usize];
            *anchors += u32::from(!moves[a] || !moves[b]);
            *has_weld |= weld;
        }
        for (looped, (anchors, has_weld)) in looped.iter_mut().zip(held) {
            *looped |= anchors > 2 || (anchors == 2 && has_weld);
        }
        Self { ends, on, sets, wanted: vec![true; slots], looped }
    }

    /// Leaves nets alone that have one of these joints.
    pub(super) fn refuse_nets(&mut self, joints: &[usize]) {
        for &joint in joints {
            for end in self.ends[joint] {
                let set = self.sets.of(end as u32) as usize;
                self.wanted[set] &= !self.looped[set];
            }
        }
    }

    /// Leaves those alone whose masses are near each other.
    pub(super) fn refuse_easy(&mut self, inv_mass: impl Fn(usize) -> f64, moves: &[bool]) {
        let mut spans = vec![[f64::INFINITY, 0.0f64]; self.on.len()];
        let mut pins = vec![0.0f64; self.on.len()];
        for slot in (0..self.on.len()).filter(|&slot| moves[slot] && !self.on[slot].is_empty()) {
            let tree = self.sets.of(slot as u32) as usize;
            let span = &mut spans[tree];
            *span = [span[0].min(inv_mass(slot)), span[1].max(inv_mass(slot))];
            self.wanted[tree] &= self.on[slot].len() <= MOST_PINS;
            // As many as bodies, or one more or less.
            pins[tree] += 1.0;
        }
        let sets = self.wanted.iter_mut().zip(&self.looped).zip(spans.iter().zip(pins));
        for ((wanted, &looped), (&[least, most], pins)) in sets {
            let (ratio, load) = (most / least, if looped { HARD_NET } else { HARD_LOAD });
            let hard = ratio >= HARD_RATIO || (ratio >= HARD_FROM && ratio * pins * pins >= load);
            *wanted &= least.is_finite() && hard;
        }
    }

    /// The joints of each wanted tree, from the leaves to the root; of a net, those with the fewest neighbours first.
    pub(super) fn orders(&mut self) -> Vec<Order> {
        let mut seen = vec![false; self.ends.len()];
        let mut orders = Vec::new();
        for slot in 0..self.on.len() {
            let is_root = self.sets.of(slot as u32) as usize == slot;
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
            let looped = self.looped[slot];
            let joints = if looped { self.least_filling(&order) } else { Some(order) };
            orders.extend(joints.map(|joints| Order { joints, looped }));
        }
        orders
    }

    /// An order in which eliminating fills in little: the joint with the fewest neighbours next. `None` where that is too much.
    fn least_filling(&self, joints: &[usize]) -> Option<Vec<usize>> {
        if joints.len() > MOST_JOINTS {
            return None;
        }
        let mut left: Vec<usize> = joints.to_vec();
        left.sort_unstable();
        let beside = |joint: usize| -> BTreeSet<usize> {
            let on = self.ends[joint].into_iter().flat_map(|slot| &self.on[slot]).copied();
            on.filter(|&other| other != joint).collect()
        };
        let mut neighbours: BTreeMap<usize, BTreeSet<usize>> =
            left.iter().map(|&joint| (joint, beside(joint))).collect();
        let (mut order, mut blocks) = (Vec::new(), 0);
        while let Some(at) = (0..left.len()).min_by_key(|&at| (neighbours[&left[at]].len(), left[at])) {
            let joint = left.swap_remove(at);
            let around = neighbours.remove(&joint).unwrap_or_default();
            blocks += around.len();
            if blocks > MOST_BLOCKS * joints.len() {
                return None;
            }
            for &other in &around {
                let beside = neighbours.entry(other).or_default();
                beside.extend(around.iter().copied().filter(|&third| third != other));
                beside.remove(&joint);
            }
            order.push(joint);
        }
        Some(order)
    }
}
