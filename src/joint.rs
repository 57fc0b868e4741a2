//! Joints: what holds two bodies together, by stable ids.
//!
//! A joint keeps its place in the table until it is removed or one of its bodies is; the hole is filled by the
//! next insertion, lowest place first, under a new generation. Joints are solved in the order of their places
//! (see [`crate::solve::joint`]), in lanes and colours like contacts.
//!
//! Cold: a table of records that a step reads only when joints or bodies have changed. What a step needs lies in
//! the solver's constraints; what must outlive them is [`Held`], 5 reals a joint.

mod check;
mod spec;

use crate::body::{Bodies, BodyId, BodyKind};
use crate::each::Each as _;
use crate::lanes::Real;
use crate::vec2::{Rot, Vec2};

use check::Checker;
pub use check::JointError;
pub use spec::{Distance, JointKind, JointSpec, JointSpring, Limits, Motor, Revolute, Weld};

/// A joint's stable name: place and generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct JointId {
    place: u32,
    generation: u32,
}

/// A joint in a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    /// The bodies A and B.
    pub bodies: [BodyId; 2],
    /// As it was given: anchors where they were in the world then.
    pub kind: JointKind,
    /// Do the two bodies collide with each other?
    pub collide: bool,
    /// The anchors in the frames of A and B, about their centroids, metres.
    pub anchors_body: [[f64; 2]; 2],
    /// cos and sin of B's attitude seen from A when the joint was made: where its angle is 0.
    pub reference: [f64; 2],
    /// Of a distance joint, metres: given, or what it was when the joint was made. 0 for other kinds.
    pub length: f64,
}

/// What a joint carries from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Held<R> {
    /// Impulse on B at the anchor, x and y, N·s per substep; 0 for distance joints.
    pub point: [R; 2],
    /// Impulse of motor or spring, N·s along the rod or N·m·s, per substep.
    pub drive: R,
    /// Impulse of what holds length or angle, or keeps them within bounds; likewise.
    pub limit: R,
    /// B's attitude seen from A, rad, whole turns counted; 0 for distance joints.
    pub angle: R,
}

#[derive(Clone, Debug)]
struct Place<R> {
    joint: Option<Joint>,
    generation: u32,
    held: Held<R>,
}

/// All joints of a world.
#[derive(Clone, Debug)]
pub struct Joints<R: Real> {
    places: Vec<Place<R>>,
    free: Vec<u32>,
    inserted: usize,
    live: usize,
    revision: u64,
}

impl<R: Real> Default for Joints<R> {
    fn default() -> Self {
        Self { places: Vec::new(), free: Vec::new(), inserted: 0, live: 0, revision: 0 }
    }
}

impl<R: Real> Joints<R> {
    /// How many there are.
    pub fn len(&self) -> usize {
        self.live
    }
    /// Is there none?
    pub fn is_empty(&self) -> bool {
        self.live == 0
    }
    /// Grows whenever a joint is inserted, removed or driven otherwise.
    pub fn revision(&self) -> u64 {
        self.revision
    }
    /// The ids of all joints, in the order of their places.
    pub fn ids(&self) -> impl Iterator<Item = JointId> + '_ {
        let id = |(at, place): (usize, &Place<R>)| {
            place.joint.as_ref().map(|_| JointId { place: at as u32, generation: place.generation })
        };
        self.places.iter().enumerate().filter_map(id)
    }
    /// All joints with their places, in order.
    pub fn living(&self) -> impl Iterator<Item = (u32, &Joint)> + '_ {
        self.places.iter().enumerate().filter_map(|(at, place)| Some((at as u32, place.joint.as_ref()?)))
    }

    /// Slots of the bodies that each joint holds, in order.
    pub(crate) fn ends(&self) -> impl Iterator<Item = [u32; 2]> + '_ {
        self.living().map(|(_, joint)| joint.bodies.each(|id| id.slot() as u32))
    }

    /// The joint in a place, if there is one.
    pub fn at(&self, place: u32) -> Option<&Joint> {
        self.places.get(place as usize)?.joint.as_ref()
    }
    /// What the joint in a place carries; zeros where there is none.
    pub fn held_at(&self, place: u32) -> Held<R> {
        self.places.get(place as usize).map_or_else(Held::default, |p| p.held)
    }
    /// Notes what the joint in a place carries.
    pub fn hold_at(&mut self, place: u32, held: Held<R>) {
        if let Some(at) = self.places.get_mut(place as usize) {
            at.held = held;
        }
    }

    /// A joint.
    ///
    /// # Errors
    /// An id whose joint is gone.
    pub fn get(&self, id: JointId) -> Result<&Joint, JointError> {
        let place = self.places.get(id.place as usize).filter(|p| p.generation == id.generation);
        place
            .and_then(|p| p.joint.as_ref())
            .ok_or(JointError::Stale { place: id.place, generation: id.generation })
    }

    /// What a joint carried at the last step's end.
    ///
    /// # Errors
    /// An id whose joint is gone.
    pub fn held(&self, id: JointId) -> Result<Held<R>, JointError> {
        self.get(id)?;
        Ok(self.held_at(id.place))
    }

    /// Where a joint's anchors on A and B lie in the world, metres, in `f64`.
    ///
    /// # Errors
    /// An id whose joint is gone.
    pub fn anchors_world(&self, id: JointId, bodies: &Bodies<R>) -> Result<[[f64; 2]; 2], JointError> {
        let joint = self.get(id)?;
        Ok([0, 1].each(|k| {
            let (at, rot) = pose(bodies, joint.bodies[k].slot());
            let [x, y] = joint.anchors_body[k];
            let world = at + rot.apply(Vec2::new(x, y));
            [world.x, world.y]
        }))
    }

    /// Takes a joint in.
    ///
    /// # Errors
    /// A body that is gone, twice the same body, two bodies that are not dynamic; anchors, lengths, springs, motors
    /// or limits out of range, crossed, or not finite in this precision. Nothing has changed then.
    pub fn insert(
        &mut self,
        bodies: &Bodies<R>,
        ends: [BodyId; 2],
        kind: JointKind,
        collide: bool,
    ) -> Result<JointId, JointError> {
        let checker = Checker { joint: self.inserted };
        let joint = self.built(bodies, ends, kind, collide, &checker)?;
        let at = self.free.pop().map_or(self.places.len(), |place| place as usize);
        if at == self.places.len() {
            self.places.push(Place { joint: None, generation: 0, held: Held::default() });
        }
        let place = &mut self.places[at];
        (place.joint, place.held) = (Some(joint), Held::default());
        self.inserted += 1;
        self.live += 1;
        self.revision += 1;
        Ok(JointId { place: at as u32, generation: place.generation })
    }

    fn built(
        &self,
        bodies: &Bodies<R>,
        ends: [BodyId; 2],
        kind: JointKind,
        collide: bool,
        checker: &Checker,
    ) -> Result<Joint, JointError> {
        let joint = self.inserted;
        let slot = |id| bodies.check_alive(id).map_err(|why| JointError::Body { joint, why });
        let (a, b) = (slot(ends[0])?, slot(ends[1])?);
        if a == b {
            return Err(JointError::Itself { joint, slot: a });
        }
        let name = |slot| match bodies.kind(slot) {
            BodyKind::Static => "static",
            BodyKind::Kinematic => "kinematic",
            BodyKind::Dynamic => "dynamic",
        };
        if [a, b].iter().all(|&slot| bodies.kind(slot) != BodyKind::Dynamic) {
            return Err(JointError::NoneDynamic { joint, a: name(a), b: name(b) });
        }
        checker.check::<R>(&kind)?;
        let poses = [pose(bodies, a), pose(bodies, b)];
        let given = kind.anchors();
        let world = [0, 1].each(|k| given[k].map_or(poses[k].0, |[x, y]| Vec2::new(x, y)));
        let anchors_body = [0, 1].each(|k| {
            let local = poses[k].1.apply_inverse(world[k] - poses[k].0);
            [local.x, local.y]
        });
        let length = match &kind {
            JointKind::Distance(distance) => {
                let length = distance.length.unwrap_or((world[1] - world[0]).length_squared().sqrt());
                checker.length(length)?;
                length
            }
            _ => 0.0,
        };
        let reference = poses[0].1.relative(poses[1].1);
        let reference = [reference.c, reference.s];
        Ok(Joint { bodies: ends, kind, collide, anchors_body, reference, length })
    }

    /// Lets the motor of the hinge in a place run otherwise; one without torque is taken off.
    ///
    /// # Errors
    /// No joint there, one that is no hinge; a speed or torque that is not finite, a torque below 0. Nothing has changed
    /// then.
    pub fn set_motor(&mut self, place: u32, motor: Motor) -> Result<(), JointError> {
        let joint = place as usize;
        Checker { joint }.motor::<R>(motor)?;
        let at = self.places.get_mut(joint).and_then(|at| at.joint.as_mut());
        match at.map(|at| &mut at.kind) {
            Some(JointKind::Revolute(hinge)) => hinge.motor = Some(motor).filter(|m| m.max_torque > 0.0),
            Some(_) => return Err(JointError::NoHinge { joint }),
            None => return Err(JointError::NoJoint { joint }),
        }
        self.revision += 1;
        Ok(())
    }

    /// Takes a joint out.
    ///
    /// # Errors
    /// An id whose joint is gone.
    pub fn remove(&mut self, id: JointId) -> Result<(), JointError> {
        self.get(id)?;
        self.clear(id.place);
        Ok(())
    }

    /// Takes out the joints of which a body is gone.
    pub fn prune(&mut self, bodies: &Bodies<R>) {
        for place in 0..self.places.len() as u32 {
            let gone = |joint: &Joint| joint.bodies.iter().any(|&id| bodies.check_alive(id).is_err());
            if self.at(place).is_some_and(gone) {
                self.clear(place);
            }
        }
    }

    fn clear(&mut self, place: u32) {
        let at = &mut self.places[place as usize];
        (at.joint, at.held) = (None, Held::default());
        at.generation += 1;
        // Kept descending, so that the lowest hole is filled first whatever the order of removals.
        let position = self.free.partition_point(|&f| f > place);
        self.free.insert(position, place);
        self.live -= 1;
        self.revision += 1;
    }

    /// The same joints without the impulses of their last step; angles keep their whole turns.
    #[must_use]
    pub fn without_impulses(mut self) -> Self {
        for place in &mut self.places {
            place.held = Held { angle: place.held.angle, ..Held::default() };
        }
        self
    }

    /// The pairs of bodies that do not collide with each other: slots a < b, ordered by a, then b.
    pub fn apart(&self) -> Vec<[u32; 2]> {
        let mut pairs: Vec<_> = (self.living().filter(|(_, joint)| !joint.collide))
            .map(|(_, joint)| {
                let [a, b] = joint.bodies.each(|id| id.slot() as u32);
                [a.min(b), a.max(b)]
            })
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        self.places.capacity() * size_of::<Place<R>>() + self.free.capacity() * 4
    }
}

/// Centroid and attitude of a body in `f64`.
fn pose<R: Real>(bodies: &Bodies<R>, slot: usize) -> (Vec2<f64>, Rot<f64>) {
    let read = |value: R| value.to_f64();
    let [x, y] = bodies.place(slot);
    let at = Vec2::new(x, y);
    (at, Rot { c: read(bodies.c[slot]), s: read(bodies.s[slot]) })
}
