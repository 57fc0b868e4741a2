//! Pairs of which one body is a static outline that its neighbours cover in part: see [`crate::seams`].

use glam::DVec2;

use super::Narrow;
use crate::body::Bodies;
use crate::contact::{Code, Places};
use crate::lanes::{ROW, Real};
use crate::motion::Near;
use crate::seams::{Met, Seams};

impl<R: Real> Narrow<R> {
    /// Takes in which static outlines are covered in part: bodies have changed.
    pub fn look_over(&mut self, bodies: &Bodies<R>) {
        self.seams.look_over(bodies);
    }

    /// What of static outlines is covered.
    pub(crate) fn seams(&self) -> &Seams {
        &self.seams
    }

    /// Takes the pairs of such outlines from those that are looked at in lanes.
    pub(super) fn set_seamed_apart(&mut self) {
        self.seamed.clear();
        if self.seams.is_empty() {
            return;
        }
        let Self { seams, seamed, todo, manifolds, .. } = self;
        for todo in todo {
            let mut kept = 0;
            for k in 0..todo.len {
                let (a, b, place) = (todo.a[k], todo.b[k], todo.place[k]);
                if seams.of(a).is_some() || seams.of(b).is_some() {
                    seamed.push(place);
                } else {
                    (todo.a[kept], todo.b[kept], todo.place[kept]) = (a, b, place);
                    kept += 1;
                }
            }
            if kept < todo.len {
                todo.end(kept, manifolds);
            }
        }
    }

    /// Finds the contacts of those pairs; margins as [`Narrow::collide`] has them.
    pub(super) fn meet_seamed(&mut self, bodies: &Bodies<R>, margin: Near<R>, ahead_secs: R) {
        for at in 0..self.seamed.len() {
            let place = self.seamed[at];
            let slots = self.manifolds.slots(place as usize);
            let Some((end, outline)) = (0..2).find_map(|end| Some((end, self.seams.of(slots[end])?))) else {
                continue;
            };
            let (own, other) = (slots[end] as usize, slots[1 - end] as usize);
            let speed = |slot: usize| DVec2::new(bodies.vx[slot].to_f64(), bodies.vy[slot].to_f64());
            let closing = (speed(other) - speed(own)).length() * ahead_secs.to_f64();
            let most = 0.5 * bodies.radius[other].to_f64().min(bodies.radius[own].to_f64());
            let length = bodies.length(own).to_f64().min(bodies.length(other).to_f64());
            let still = margin.metres.to_f64() + margin.share.to_f64() * length;
            let met = outline.meet(&bodies.placed(other), still + closing.min(most));
            let mut places = self.manifolds.places();
            match met {
                Some(met) => {
                    keep_met(bodies, (&mut places, place), slots.map(|slot| slot as usize), end, &met);
                }
                None => places.write_apart(&[place]),
            }
        }
    }
}

/// Writes a contact down; `end`: which of the two bodies is the outline.
fn keep_met<R: Real>(
    bodies: &Bodies<R>,
    (places, place): (&mut Places<'_, R>, u32),
    [a, b]: [usize; 2],
    end: usize,
    met: &Met,
) {
    let [from_a, from_b] = [a, b].map(|slot| DVec2::from(bodies.place(slot)));
    let normal = if end == 0 { met.normal } else { -met.normal };
    let points = met.points();
    let last = points[points.len() - 1];
    let arms = [points[0].at - from_a, if points.len() == 2 { last.at - from_a } else { DVec2::ZERO }];
    let to_b = from_b - from_a;
    let real = R::from_f64;
    let geometry: [R; ROW] =
        [normal.x, normal.y, arms[0].x, arms[0].y, arms[1].x, arms[1].y, to_b.x, to_b.y].map(real);
    let second = if points.len() == 2 { last.separation } else { 0.0 };
    let least = |column: &crate::column::Column<R>| {
        if column[a] < column[b] { column[a] } else { column[b] }
    };
    let gap = [real(points[0].separation), real(second), least(&bodies.friction), least(&bodies.restitution)];
    let feature = |k: usize| if k < points.len() { f64::from(points[k].feature) } else { 0.0 };
    let code = Code::lanes([real(feature(0)), real(feature(1))], real(points.len() as f64));
    places.write::<R>(&[place], code, geometry, gap);
}
