//! Which pins make up trees whose masses are too far apart for visits, and in what order these are eliminated.

use crate::partition::Sets;

/// Masses so far apart are too far for visits, in a tree of any size.
const HARD_RATIO: f64 = 64.0;
/// Where the heaviest is at least [`HARD_FROM`] times the lightest: this ratio times the square of the number of pins is
/// too much, as an error crosses n pins in n² visits.
const HARD_LOAD: f64 = 4096.0;
/// Chains of equal links are left to visits, however long.
const HARD_FROM: f64 = 1.5;
/// Pins on one body that a tree is solved with: blocks grow with their square.
const MOST_PINS: usize = 8;

/// Pins by the bodies that they hang together by.
pub(super) struct Trees {
    ends: Vec<[usize; 2]>,
    /// Pins on each slot, of bodies that move.
    on: Vec<Vec<usize>>,
    /// Whom pins join.
    sets: Sets,
    /// By the lowest slot of a set: a tree, and a hard one.
    wanted: Vec<bool>,
}

impl Trees {
    pub(super) fn of(
        ends: impl Iterator<Item = [usize; 2]>,
        slots: usize,
        moves: impl Fn(usize) -> bool,
    ) -> Self {
        let ends: Vec<_> = ends.collect();
        let mut on = vec![Vec::new(); slots];
        let mut sets = Sets::default();
        sets.part(slots, std::slice::from_ref(&(0..slots)));
        let mut wanted = vec![true; slots];
        for (k, &[a, b]) in ends.iter().enumerate() {
            for slot in [a, b].into_iter().filter(|&slot| moves(slot)) {
                on[slot].push(k);
            }
            if moves(a) && moves(b) {
                match sets.join([a as u32, b as u32]) {
                    Some([low, high]) => wanted[low as usize] &= wanted[high as usize],
                    // They hang together already: a loop, no tree.
                    None => wanted[sets.of(a as u32) as usize] = false,
                }
            }
        }
        Self { ends, on, sets, wanted }
    }

    /// Leaves those alone whose masses are near each other.
    pub(super) fn refuse_easy(&mut self, inv_mass: impl Fn(usize) -> f64, moves: impl Fn(usize) -> bool) {
        let mut spans = vec![[f64::INFINITY, 0.0f64]; self.on.len()];
        let mut pins = vec![0.0f64; self.on.len()];
        for slot in (0..self.on.len()).filter(|&slot| moves(slot) && !self.on[slot].is_empty()) {
            let tree = self.sets.of(slot as u32) as usize;
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
    pub(super) fn orders(&mut self) -> Vec<Vec<usize>> {
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
            orders.push(order);
        }
        orders
    }
}
