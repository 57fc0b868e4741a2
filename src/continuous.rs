//! Continuous collision: a fast body stops at the wall in its way instead of passing it between two steps.
//!
//! A body is fast when a point of it may have moved further in one step than half its inner radius
//! ([`Bodies::core`]); the passes that end a step note such bodies ([`Fast`]), at one comparison per lane value.
//! Each goes its way in a straight line at even speed and spin until it meets another body: there both get the impulse of
//! their restitution and friction, and go on with what is left of the step, where either may meet again ([`way::MEETINGS`]).
//! What happens within a step happens in the order of its instants; ties go by slots.
//! A jointed body stops where it meets something and keeps its velocity, and so does what it hits: the next step solves the impact
//! together with the joints. Bounced as if it were free, a ball on a rod lost a twelfth of its energy.
//!
//! Whom it may meet: every static and kinematic body, and of dynamic ones those it has a candidate pair with, which reach as
//! far as both move; none of those under a solver that hears of overlaps alone (`impulse`), whose pairs do not. Gravity is reckoned in: a body that meets something at the share t of a step has by then the velocity
//! of its end less g·(1 − t)·dt.
//!
//! # Time of impact
//! Conservative advancement over separating axes (Mirtich, Impulse-based Dynamic Simulation of Rigid Body Systems,
//! 1996, §2.3). Along a fixed axis n two bodies s apart cannot close faster than −n·(v_B − v_A) + |ω_A|·R_A +
//! |ω_B|·R_B, so each axis promises a time without impact, and the longest of them holds. A face of B that turns may take
//! its axis along: B then reaches as far along it at all times, and they close no faster than −n·(v_B − v_A) −
//! ω_B·n⊥·(x_B − x_A) + |ω_B − ω_A|·R_A and what that changes by as n turns: |ω_B|·(2·|v_B − v_A| + |ω_B|·|x_B − x_A|). A
//! wall ten metres long that turns would else promise hardly anything. Without spin the face
//! normals promise the exact time; an axis that opens ends the search, so that a body that slides along a wall or
//! passes its end is done at once. All in `f64` scalars: few bodies are fast.
//!
//! # Where a body is stopped
//! The next step must find the contact. Solvers that hear of gaps get a body half a skin away, where they stop it
//! without letting it sink; one that hears of overlaps alone gets it one skin deep. A pair that is nearer than two
//! skins (or overlaps) as the step begins is left to the solver, but for its core, a disc of half the inner radius,
//! which never gets in: a plate that has come down on a corner would turn about it and through. A body whose contact
//! has stopped it, or whose way ends before the wall, is left where it is, however near that is: stopped half a skin
//! early, a billiard ball lost 20 µs. The skin is a thousandth of the body's radius, at most a fiftieth of the
//! body's core, at least what a coordinate is rounded by.
//!
//! # What a pair costs
//! Fast bodies are tested against each obstacle's bounding circle first, one after the other: their product is
//! the cost, which is what a scene of thousands of both would pay for. Then against its faces, with the body's
//! bounding circle in its place: a wall's own circle is as wide as the wall is long and turns nothing away. A face
//! that promises a whole step to the circle promises it to the body, so the search would have said the same.

mod ahead;
mod approach;
mod neighbours;
mod respond;
mod sweep;
mod way;

use glam::DVec2;

use crate::body::{Bodies, BodyKind, Placed};
use crate::each::Each as _;
use crate::lanes::Real;
use crate::motion::{Fast, FastBodies, TOUCH};
use crate::seams::Seams;

use approach::Reach;
use neighbours::Neighbours;
use respond::Motion;
use sweep::{Course, Sweep, Wall};
use way::{Meeting, Other, Way};

/// What a step knows that its fast bodies may meet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Around<'a, R> {
    /// Gaps the solver hears of, metres.
    pub(crate) margin: R,
    /// The step, seconds.
    pub(crate) dt_secs: f64,
    /// m/s².
    pub(crate) gravity: [f64; 2],
    /// Candidate pairs.
    pub(crate) pairs: &'a [[u32; 2]],
    /// Pairs that do not collide, ordered.
    pub(crate) apart: &'a [[u32; 2]],
    /// What can be touched of outlines that are covered in part.
    pub(crate) seams: &'a Seams,
}

/// The fast bodies of a step, and what they may meet; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(crate) struct Continuous<R: Real> {
    fast: Vec<Fast<R>>,
    /// Slots of static and kinematic bodies, ascending.
    obstacles: Vec<u32>,
    /// The obstacles' ways through this step, in their order.
    walls: Vec<Wall>,
    ways: Vec<Way>,
    /// By slot: which way, counted from 1; 0 for none.
    way_of: Vec<u32>,
    /// Ways that may meet.
    neighbours: Neighbours,
    /// Those that one may meet, while it looks ahead.
    beside: Vec<u32>,
    /// Per slot, whether joints hold the body.
    jointed: Vec<bool>,
}

impl<R: Real> Default for Continuous<R> {
    fn default() -> Self {
        Self {
            fast: Vec::new(),
            obstacles: Vec::new(),
            walls: Vec::new(),
            ways: Vec::new(),
            way_of: Vec::new(),
            neighbours: Neighbours::default(),
            beside: Vec::new(),
            jointed: Vec::new(),
        }
    }
}

impl<R: Real> Continuous<R> {
    /// Notes which bodies can be in the way.
    pub(crate) fn look_over(&mut self, bodies: &Bodies<R>) {
        let fixed = bodies.slots().filter(|&slot| bodies.kind(slot) != BodyKind::Dynamic);
        self.obstacles.clear();
        self.obstacles.extend(fixed.map(|slot| slot as u32));
    }

    /// Where a step is to note its fast bodies: nowhere if nothing can be in their way.
    pub(crate) fn begin(&mut self, wanted: bool, pairs: usize) -> FastBodies<'_, R> {
        self.fast.clear();
        (wanted && (pairs > 0 || !self.obstacles.is_empty())).then_some(&mut self.fast)
    }

    /// Lets the fast bodies of a step meet what is in their ways; those that do are marked in `has_moved`. `joined`: slots that
    /// joints join.
    pub(crate) fn stop(
        &mut self,
        bodies: &mut Bodies<R>,
        around: &Around<'_, R>,
        joined: impl Iterator<Item = [u32; 2]>,
        has_moved: &mut [bool],
    ) {
        if self.fast.is_empty() {
            return;
        }
        self.jointed.clear();
        self.jointed.resize(bodies.len(), false);
        joined.flatten().for_each(|slot| self.jointed[slot as usize] = true);
        self.walls.clear();
        let walls = self.obstacles.iter().map(|&slot| Wall::new(bodies, slot as usize, around.dt_secs));
        self.walls.extend(walls);
        self.set_out(bodies, around);
        self.neighbours.list(self.ways.len());
        for way in 0..self.ways.len() {
            self.look_ahead(bodies, around, way);
        }
        while let Some(way) = self.earliest() {
            self.meet(bodies, around, way);
        }
        for way in self.ways.iter().filter(|way| way.met) {
            way.write(bodies);
            has_moved[way.slot] = true;
        }
    }

    /// Slots of the bodies that have met something in the last step.
    pub(crate) fn met(&self) -> impl Iterator<Item = usize> {
        let ways = if self.fast.is_empty() { &[][..] } else { &self.ways[..] };
        ways.iter().filter(|way| way.met).map(|way| way.slot)
    }

    /// The ways of fast bodies, and of those they have pairs with.
    fn set_out(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>) {
        self.ways.clear();
        self.neighbours.clear();
        self.way_of.clear();
        self.way_of.resize(bodies.len(), 0);
        for at in 0..self.fast.len() {
            let fast = self.fast[at];
            self.set_out_one(bodies, around, fast.slot as usize, Course::of_fast(bodies, &fast));
        }
        let fast = self.ways.len();
        for &[a, b] in around.pairs {
            let both = [a, b].each(|slot| slot as usize);
            let is_fast = |slot: usize| (1..=fast).contains(&(self.way_of[slot] as usize));
            if !both.iter().any(|&slot| is_fast(slot))
                || both.iter().any(|&slot| bodies.kind(slot) != BodyKind::Dynamic)
            {
                continue;
            }
            for slot in both {
                if self.way_of[slot] == 0 {
                    // As an obstacle that came to where it is by its velocity.
                    let course = Course::of_obstacle(bodies, slot, around.dt_secs);
                    self.set_out_one(bodies, around, slot, course);
                }
            }
            let ways = both.each(|slot| self.way_of[slot]);
            // One that is not finite has none; the finite check names it.
            if ways.iter().all(|&way| way > 0) {
                self.neighbours.add(ways.each(|way| way - 1));
            }
        }
    }

    /// Appends a way; the ways of fast bodies come first.
    fn set_out_one(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>, slot: usize, course: Course) {
        if !course.is_finite() {
            return;
        }
        let core = bodies.core[slot].to_f64();
        let hears_of_gaps = around.margin > R::ZERO;
        let skin = TOUCH * bodies.radius[slot].to_f64();
        let reach = Reach::new(skin, hears_of_gaps, core, &course, bodies.place_epsilon());
        self.ways.push(Way::new(bodies, slot, course, reach));
        self.way_of[slot] = self.ways.len() as u32;
    }

    /// Finds what a body meets next.
    fn look_ahead(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>, way: usize) {
        let Way { slot, course, met, left, .. } = &self.ways[way];
        // Once it has met something what goes no further than slow bodies do is left to the next step's contacts; whom it may
        // meet that is slow is found by the other.
        let path = course.moved.length() + course.angle.abs() * course.radius;
        let goes_on = if *met { path > bodies.core[*slot].to_f64() } else { way < self.fast.len() };
        if *left == 0 || !goes_on {
            self.ways[way].next = None;
            return;
        }
        let beside = self.beside(bodies, around, way);
        let mut first: Option<Meeting> = None;
        let mut keep = |found: Option<Meeting>| {
            if let Some(found) = found
                && first.is_none_or(|first| found.at < first.at)
            {
                first = Some(found);
            }
        };
        for wall in 0..self.walls.len() {
            keep(self.wall_ahead(bodies, around, way, wall));
        }
        for other in &beside {
            keep(self.body_ahead(bodies, way, *other as usize));
        }
        self.beside = beside;
        self.ways[way].next = first;
    }

    /// The ways that may meet one: those it has a pair with, or once it has met something, and goes where nobody expected it,
    /// all that are near its way.
    fn beside(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>, way: usize) -> Vec<u32> {
        let mut beside = std::mem::take(&mut self.beside);
        beside.clear();
        let Way { slot, course, met, .. } = self.ways[way];
        let length = course.moved.length();
        if !met || length <= bodies.core[slot].to_f64() {
            beside.extend_from_slice(self.neighbours.of(way));
            return beside;
        }
        for other in bodies.slots().filter(|&other| other != slot && bodies.kind(other) == BodyKind::Dynamic)
        {
            let speed = DVec2::new(bodies.vx[other].to_f64(), bodies.vy[other].to_f64()).length();
            let reach =
                length + speed * around.dt_secs + (bodies.radius[other] + bodies.radius[slot]).to_f64();
            let pair = [slot.min(other) as u32, slot.max(other) as u32];
            if (DVec2::from(bodies.place(other)) - course.x).length_squared() > reach * reach
                || !bodies.may_collide(slot, other)
                || around.apart.binary_search(&pair).is_ok()
            {
                continue;
            }
            if self.way_of[other] == 0 {
                let course = Course::of_obstacle(bodies, other, around.dt_secs);
                self.set_out_one(bodies, around, other, course);
            }
            beside.extend(self.way_of[other].checked_sub(1));
        }
        beside
    }

    /// The body that meets something first, by slot where several do.
    fn earliest(&self) -> Option<usize> {
        let meets = |way: &usize| self.ways[*way].next.map(|next| (next.at, self.ways[*way].slot));
        (0..self.ways.len())
            .filter(|way| meets(way).is_some())
            .min_by(|a, b| meets(a).partial_cmp(&meets(b)).unwrap_or(std::cmp::Ordering::Equal))
    }

    /// Lets a body meet what it meets next, and looks ahead again.
    fn meet(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>, way: usize) {
        let Some(Meeting { at, axis, with }) = self.ways[way].next.take() else { return };
        let rest_secs = (1.0 - at) * around.dt_secs;
        let gained = DVec2::from(around.gravity) * rest_secs;
        self.ways[way].go_to(at);
        let mut own = self.ways[way].motion;
        own.velocity -= gained;
        let placed = self.placed(bodies, way);
        match with {
            Other::Wall(_) if self.jointed[self.ways[way].slot] => {
                self.ways[way].stay();
                self.expect_anew(bodies, around, [way, way]);
            }
            Other::Way(other) if [way, other].into_iter().any(|way| self.jointed[self.ways[way].slot]) => {
                self.ways[other].go_to(at);
                for way in [way, other] {
                    self.ways[way].stay();
                }
                self.expect_anew(bodies, around, [way, other]);
            }
            Other::Wall(wall) => {
                let slot = self.obstacles[wall] as usize;
                let wall = &self.walls[wall].sweep;
                let their = wall.on(wall.course.after(at)).at(0.0);
                let slots = [self.ways[way].slot, slot];
                respond::collide(
                    bodies,
                    slots,
                    [&placed, &their],
                    axis,
                    [&mut own, &mut Motion::of(bodies, slot)],
                );
                own.velocity += gained;
                self.ways[way].go_on(own, rest_secs, gained);
                self.look_ahead(bodies, around, way);
            }
            Other::Way(other) => {
                self.ways[other].go_to(at);
                let mut their = self.ways[other].motion;
                their.velocity -= gained;
                let their_placed = self.placed(bodies, other);
                let slots = [self.ways[way].slot, self.ways[other].slot];
                respond::collide(bodies, slots, [&placed, &their_placed], axis, [&mut own, &mut their]);
                own.velocity += gained;
                their.velocity += gained;
                self.ways[way].go_on(own, rest_secs, gained);
                self.ways[other].go_on(their, rest_secs, gained);
                self.expect_anew(bodies, around, [way, other]);
            }
        }
    }

    /// Two bodies have met: they, and whoever was to meet one of them, look ahead again.
    fn expect_anew(&mut self, bodies: &Bodies<R>, around: &Around<'_, R>, [way, other]: [usize; 2]) {
        for k in 0..self.ways.len() {
            let expects = |with: Other| matches!(with, Other::Way(met) if met == way || met == other);
            if k == way || k == other || self.ways[k].next.is_some_and(|next| expects(next.with)) {
                self.look_ahead(bodies, around, k);
            }
        }
    }

    /// A body where it is on its way.
    fn placed(&self, bodies: &Bodies<R>, way: usize) -> Placed {
        let Way { slot, course, .. } = &self.ways[way];
        Sweep::of(bodies, *slot, *course).at(0.0)
    }
}
