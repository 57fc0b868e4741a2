//! What a body meets next on its way.

use super::approach::{Approach, approach, impact, touches};
use super::sweep::{Course, Sweep};
use super::way::{Meeting, Other, Way};
use super::{Around, Continuous};
use crate::body::Bodies;
use crate::lanes::Real;

impl<R: Real> Continuous<R> {
    pub(super) fn wall_ahead(
        &self,
        bodies: &Bodies<R>,
        around: &Around<'_, R>,
        way: usize,
        wall_number: usize,
    ) -> Option<Meeting> {
        let Way { slot, course, since, reach, .. } = &self.ways[way];
        let (other, wall) = (self.obstacles[wall_number], &self.walls[wall_number]);
        if *since == 0.0 && wall.keeps_clear(course, reach) {
            return None;
        }
        let wall_course = wall.sweep.course.after(*since);
        if !course.may_meet(&wall_course, reach) {
            return None;
        }
        let pair = [other.min(*slot as u32), other.max(*slot as u32)];
        if !bodies.may_collide(*slot, other as usize) || around.apart.binary_search(&pair).is_ok() {
            return None;
        }
        let sweep = Sweep::of(bodies, *slot, *course);
        let (t, axis) = impact(&sweep, &wall.sweep.on(wall_course), reach)?;
        let outline = around.seams.of(other);
        let met = outline.map_or(Some(axis), |outline| touches(&sweep, t, outline, reach))?;
        Some(Meeting { at: since + t * (1.0 - since), axis: met, with: Other::Wall(wall_number) })
    }

    pub(super) fn body_ahead(&self, bodies: &Bodies<R>, way: usize, other: usize) -> Option<Meeting> {
        let (own, their) = (&self.ways[way], &self.ways[other]);
        // Both from the later of the instants they were last seen at.
        let since = own.since.max(their.since);
        let mut later = [None; 2];
        let [own_later, their_later] = &mut later;
        let (own_course, their_course) = (own.lent(since, own_later), their.lent(since, their_later));
        // Bodies that come no further than half of both are deep do not pass through each other: the next step's contact holds.
        let length = (own_course.moved - their_course.moved).length();
        if length <= own.reach.core + their.reach.core || !own_course.may_meet(their_course, &own.reach) {
            return None;
        }
        let of = |way: &Way, course: &Course| Sweep::of(bodies, way.slot, *course);
        match approach(&of(own, own_course), &of(their, their_course), &own.reach) {
            Approach::Meets(t, axis) => {
                Some(Meeting { at: since + t * (1.0 - since), axis, with: Other::Way(other) })
            }
            Approach::Passes | Approach::Touching => None,
        }
    }
}
