//! Contacts with an outline of which something is covered.

use glam::DVec2;

use super::{Face, Outline};
use crate::body::Placed;
use crate::shape::MAX_VERTICES;

impl Placed {
    fn corner(&self, k: usize) -> DVec2 {
        self.centre + self.corners[k % self.count]
    }

    /// A side, as an outline has them: all of it exposed; of no length where there is none.
    pub(super) fn face(&self, j: usize) -> Face {
        if j >= self.count {
            return Face::default();
        }
        let (start, end) = (self.corner(j), self.corner(j + 1));
        let length = (end - start).length();
        let tangent = (end - start) / length;
        Face { start, tangent, normal: -tangent.perp(), length, exposed: true }
    }
}

/// A point that touches.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Touch {
    /// Midway between the two surfaces, metres.
    pub(crate) at: DVec2,
    /// Metres, negative where they overlap.
    pub(crate) separation: f64,
    /// See [`crate::contact::Feature`].
    pub(crate) feature: u16,
}

/// A contact with an outline.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Met {
    /// Unit, out of the outline.
    pub(crate) normal: DVec2,
    points: [Touch; 2],
    count: usize,
}

impl Met {
    /// How far a body is outside of the surface that this contact is with, along its normal, metres.
    pub(crate) fn outside(&self, mover: &Placed) -> f64 {
        let [first, _] = self.points;
        let surface = (first.at - self.normal * (0.5 * first.separation)).dot(self.normal);
        let corners = mover.corners().iter().map(|corner| corner.dot(self.normal));
        let lowest = if mover.count == 0 { -mover.disc } else { corners.fold(f64::MAX, f64::min) };
        mover.centre.dot(self.normal) + lowest - surface
    }

    /// One or two.
    pub(crate) fn points(&self) -> &[Touch] {
        &self.points[..self.count]
    }
}

/// Which two features a point is of: bit 7 says whose face is the reference.
fn feature(of_mover: bool, face: usize, other: usize, end: usize) -> u16 {
    (u16::from(of_mover) << 7) | ((face as u16) << 4) | ((other as u16) << 1) | end as u16
}

impl Outline {
    /// The contact with a body, of points closer than `margin`, metres.
    pub(crate) fn meet(&self, mover: &Placed, margin: f64) -> Option<Met> {
        if mover.count == 0 { self.meet_disc(mover, margin) } else { self.meet_outline(mover, margin) }
    }

    /// From where to where along a face something can touch it: beyond corners that are none it goes on a little.
    fn span(&self, k: usize) -> [f64; 2] {
        let beyond =
            |corner: usize| if self.wedges[corner % self.count].is_none() { self.reach } else { 0.0 };
        [-beyond(k), self.faces[k].length + beyond(k + 1)]
    }

    fn meet_disc(&self, mover: &Placed, margin: f64) -> Option<Met> {
        let (centre, radius) = (mover.centre, mover.disc);
        let mut best: Option<(f64, usize)> = None;
        // From outside only what it looks at; from inside, what is nearest.
        let inside = self.contains(centre);
        for (k, face) in self.faces().iter().enumerate().filter(|(_, face)| face.exposed) {
            let ([from, to], along, outside) = (self.span(k), face.along(centre), face.outside(centre));
            let seen = from <= along && along <= to && (inside || outside > 0.0);
            if seen && best.is_none_or(|(most, _)| most < outside) {
                best = Some((outside, k));
            }
        }
        let met = |normal: DVec2, separation: f64, feature: u16| {
            let at = centre - normal * (radius + 0.5 * separation);
            let touch = Touch { at, separation, feature };
            (separation <= margin).then_some(Met { normal, points: [touch; 2], count: 1 })
        };
        if let Some((outside, k)) = best {
            return met(self.faces[k].normal, outside - radius, feature(false, k, 0, 0));
        }
        for k in 0..self.count {
            let Some([from, to]) = self.wedges[k] else { continue };
            let away = centre - self.faces[k].start;
            if from.perp_dot(away) >= 0.0 && away.perp_dot(to) >= 0.0 && away.length_squared() > 0.0 {
                let distance = away.length();
                return met(away / distance, distance - radius, feature(false, k, 0, 1));
            }
        }
        None
    }

    fn meet_outline(&self, mover: &Placed, margin: f64) -> Option<Met> {
        let corners = || (0..mover.count).map(|k| mover.corner(k));
        let lowest = |face: &Face| corners().map(|at| face.outside(at)).fold(f64::MAX, f64::min);
        // Along any face, covered or not, bodies may be told apart.
        let depths: [f64; MAX_VERTICES] =
            crate::each::indexed(|k| if k < self.count { lowest(&self.faces[k]) } else { f64::MIN });
        if depths[..self.count].iter().any(|depth| *depth > margin) {
            return None;
        }
        let faces: [Face; MAX_VERTICES] = crate::each::indexed(|j| mover.face(j));
        let faces = &faces[..mover.count];
        let lowest_own = |face: &Face| {
            let apart = self.faces().iter().map(|own| face.outside(own.start));
            apart.fold(f64::MAX, f64::min)
        };
        let mut most = depths[..self.count].iter().copied().fold(f64::MIN, f64::max);
        for face in faces {
            let depth = lowest_own(face);
            if depth > margin {
                return None;
            }
            most = most.max(depth);
        }
        // What a covered face tells apart is not pushed out by the far side: no further in than half of what comes is deep.
        let inner = faces.iter().map(|face| -face.outside(mover.centre)).fold(f64::MAX, f64::min);
        let least = most.min(0.0) - 0.5 * inner;
        let mut best: Option<(f64, Met)> = None;
        let mut keep = |depth: f64, met: Option<Met>, bias: f64| {
            if let Some(met) = met.filter(|_| depth >= least)
                && best.as_ref().is_none_or(|(most, _)| *most < depth - bias)
            {
                best = Some((depth, met));
            }
        };
        for k in (0..self.count).filter(|&k| self.faces[k].exposed) {
            keep(depths[k], self.on_own_face(k, mover, margin), 0.0);
        }
        for (j, face) in faces.iter().enumerate() {
            // A face of what has come lies on this outline's own, but for a corner's breadth: the first is preferred.
            keep(lowest_own(face), self.on_face_of(j, face, margin), 0.1 * self.reach);
        }
        best.map(|(_, met)| met)
    }

    /// An exposed face as the reference: points of the other's edge that faces it.
    fn on_own_face(&self, k: usize, mover: &Placed, margin: f64) -> Option<Met> {
        let face = &self.faces[k];
        let facing = |j: &usize| (mover.corner(j + 1) - mover.corner(*j)).normalize().dot(face.tangent);
        let j = (0..mover.count).min_by(|a, b| facing(a).total_cmp(&facing(b)))?;
        let ends = [mover.corner(j), mover.corner(j + 1)];
        let clipped = clip(ends, face, self.span(k));
        met_of(face.normal, clipped?, margin, |end, at| {
            let separation = face.outside(at);
            let at = at - face.normal * (0.5 * separation);
            Touch { at, separation, feature: feature(false, k, j, end) }
        })
    }

    /// A face of the other as the reference, where a corner of this outline may touch it.
    fn on_face_of(&self, j: usize, face: &Face, margin: f64) -> Option<Met> {
        let out = -face.normal;
        let meets = |k: usize| {
            self.wedges[k].is_some_and(|[from, to]| from.perp_dot(out) >= 0.0 && out.perp_dot(to) >= 0.0)
        };
        let deepest = (0..self.count).min_by(|&a, &b| {
            let depth = |k: usize| face.outside(self.faces[k].start);
            depth(a).total_cmp(&depth(b))
        })?;
        if !meets(deepest) {
            return None;
        }
        // The edge at that corner that faces it, if it can be touched.
        let before = (deepest + self.count - 1) % self.count;
        let turned = |k: usize| self.faces[k].tangent.dot(face.tangent);
        let k = if turned(before) < turned(deepest) { before } else { deepest };
        let own = &self.faces[k];
        let ends = if own.exposed {
            [own.start, own.start + own.tangent * own.length]
        } else {
            [self.faces[deepest].start; 2]
        };
        let clipped = clip(ends, face, [0.0, face.length]);
        met_of(out, clipped?, margin, |end, at| {
            let separation = face.outside(at);
            let at = at - face.normal * (0.5 * separation);
            Touch { at, separation, feature: feature(true, j, k, end) }
        })
    }
}

/// The part of an edge that lies over a face's span, in its own order.
fn clip(ends: [DVec2; 2], face: &Face, [from, to]: [f64; 2]) -> Option<[DVec2; 2]> {
    let [a, b] = ends.map(|end| face.along(end));
    if a.max(b) < from || a.min(b) > to {
        return None;
    }
    let at = |along: f64| {
        let share = if (b - a).abs() > 0.0 { (along.clamp(from, to) - a) / (b - a) } else { 0.0 };
        ends[0] + (ends[1] - ends[0]) * share.clamp(0.0, 1.0)
    };
    Some([at(a), at(b)])
}

/// Points closer than the margin.
fn met_of(
    normal: DVec2,
    ends: [DVec2; 2],
    margin: f64,
    touch: impl Fn(usize, DVec2) -> Touch,
) -> Option<Met> {
    let both = [touch(0, ends[0]), touch(1, ends[1])];
    let same = (ends[0] - ends[1]).length_squared() == 0.0;
    let near = |touch: &Touch| touch.separation <= margin;
    match both {
        [first, _] if same => near(&first).then_some(Met { normal, points: [first; 2], count: 1 }),
        [first, second] if near(&first) && near(&second) => Some(Met { normal, points: both, count: 2 }),
        [first, second] => {
            let one = if first.separation <= second.separation { first } else { second };
            near(&one).then_some(Met { normal, points: [one; 2], count: 1 })
        }
    }
}
