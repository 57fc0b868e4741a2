//! Which islands fall asleep.

use std::ops::Range;

use super::{DRIFTING, Demand, Islands, Making, RESTLESS, SUPPORTED, is_at_rest};
use crate::body::{Bodies, BodyKind};
use crate::contact::Manifolds;
use crate::lanes::Real;

impl<R: Real> Islands<R> {
    /// Is there a link whose demand time may meet?
    pub fn waits(&self) -> bool {
        self.making.waits
    }

    /// What links ask of their ends from now on.
    pub fn take_demands(&mut self, demands: impl Iterator<Item = Demand>) {
        self.making.demands.clear();
        self.making.demands.extend(demands);
    }

    /// Lets the islands in `runs` fall asleep that may. `fields`: does any act? `gravity`, m/s².
    pub fn fall_asleep(
        &mut self,
        bodies: &mut Bodies<R>,
        manifolds: &Manifolds<R>,
        runs: &[Range<usize>],
        fields: bool,
        gravity: f64,
    ) {
        self.join(bodies, manifolds, runs);
        self.ask(bodies, gravity);
        for slot in runs.iter().cloned().flatten() {
            if !self.awake[slot] || bodies.kind(slot) != BodyKind::Dynamic {
                continue;
            }
            let root = self.making.sets.of(slot as u32) as usize;
            let bits = self.making.bits[root];
            let rests = bits & SUPPORTED != 0 || !(fields || bits & DRIFTING != 0);
            if bits & RESTLESS == 0 && rests {
                self.put_to_sleep(bodies, slot, root);
            }
        }
    }

    /// Finds the islands of awake bodies and what they are.
    fn join(&mut self, bodies: &Bodies<R>, manifolds: &Manifolds<R>, runs: &[Range<usize>]) {
        self.making.sets.part(bodies.len(), runs);
        for slot in runs.iter().cloned().flatten() {
            self.making.bits[slot] = 0;
        }
        let is_dynamic = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let Self { links, awake, making: Making { sets, bits, .. }, .. } = self;
        let awake_links = links.iter().filter(|ends| ends.iter().any(|&end| awake[end as usize]));
        let touching = manifolds.touching().iter().map(|&place| manifolds.slots(place as usize));
        let edges = touching.chain(awake_links.copied());
        for ends in edges.clone() {
            if ends.into_iter().all(is_dynamic) {
                sets.join(ends);
            }
        }
        for [a, b] in edges {
            for (own, other) in [(a, b), (b, a)] {
                if is_dynamic(own) && !is_dynamic(other) {
                    let root = sets.of(own) as usize;
                    bits[root] |= if awake[other as usize] { RESTLESS } else { SUPPORTED };
                }
            }
        }
        for slot in runs.iter().cloned().flatten().filter(|&slot| is_dynamic(slot as u32)) {
            let quiet = self.quiet.is_ripe(slot);
            let root = sets.of(slot as u32) as usize;
            bits[root] |= if quiet { 0 } else { RESTLESS };
            bits[root] |= if is_at_rest(bodies, slot) { 0 } else { DRIFTING };
        }
    }

    /// What links demand: islands with one that is not met are restless. All that hangs together swings no slower than a
    /// pendulum as long as its links, in 2π·√(length/g).
    fn ask(&mut self, bodies: &Bodies<R>, gravity: f64) {
        let demands = std::mem::take(&mut self.making.demands);
        self.making.waits = false;
        let is_dynamic = |slot: u32| bodies.kind(slot as usize) == BodyKind::Dynamic;
        let ends = |demand: &Demand| demand.ends.into_iter().filter(|&end| is_dynamic(end));
        for end in demands.iter().flat_map(ends) {
            self.making.reach[self.making.sets.of(end) as usize] = 0.0;
        }
        for demand in &demands {
            if let Some(end) = ends(demand).next() {
                self.making.reach[self.making.sets.of(end) as usize] += demand.reach;
            }
        }
        for demand in &demands {
            for end in ends(demand) {
                let root = self.making.sets.of(end) as usize;
                let swings = if gravity > 0.0 { (self.making.reach[root] / gravity).sqrt() } else { 0.0 };
                let needed = demand.quiet_secs.max(std::f64::consts::TAU * swings);
                if self.quiet.secs(end as usize) < needed {
                    self.making.bits[root] |= RESTLESS;
                    self.making.waits |= needed.is_finite();
                }
            }
        }
        self.making.demands = demands;
    }

    fn put_to_sleep(&mut self, bodies: &mut Bodies<R>, slot: usize, root: usize) {
        // Slots ascend and a root is the lowest: it always begins its ring.
        if slot == root {
            self.next[slot] = slot as u32;
            self.census.rings += 1;
        } else {
            self.next[slot] = std::mem::replace(&mut self.next[root], slot as u32);
        }
        (self.asleep[slot], self.awake[slot]) = (true, false);
        self.quiet.end(slot);
        for column in [&mut bodies.vx, &mut bodies.vy, &mut bodies.w] {
            column[slot] = R::ZERO;
        }
        self.census.sleeping += 1;
        self.changes += 1;
    }
}
