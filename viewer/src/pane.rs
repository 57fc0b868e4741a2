//! One run as it is shown: the frame, which bodies hang together, where they were.

use std::collections::VecDeque;
use std::sync::Arc;

use lamina2d::joint::JointSpec;
use lamina2d::record::{Frame, FrameData};
use lamina2d::scene::{BodyKind, ShapeSpec};
use lamina2d::world::{BodyEntry, BodyTable};

use crate::source::{Source, SourceError};
use crate::view::MOST_TRAIL;

/// Positions kept for trails at most, over all bodies: 8 bytes each.
const MOST_POSITIONS: usize = 400_000;

/// The columns of a frame by place; see [`lamina2d::world::COLUMNS`].
pub mod column {
    /// Centroid, metres.
    pub const X: usize = 0;
    /// Centroid, metres.
    pub const Y: usize = 1;
    /// Cosine of the attitude.
    pub const COS: usize = 2;
    /// Sine of the attitude.
    pub const SIN: usize = 3;
    /// m/s.
    pub const VX: usize = 4;
    /// m/s.
    pub const VY: usize = 5;
}

/// A source and the frame of it that is shown.
#[derive(Debug)]
pub struct Pane {
    /// Where frames come from.
    pub source: Box<dyn Source>,
    shown: Option<usize>,
    data: FrameData,
    table: Arc<BodyTable>,
    /// By slot: its entry in the table, and one more.
    entry_of: Vec<u32>,
    /// By slot: the least slot of its island; 0 for what is in none.
    islands: Vec<u32>,
    island_count: usize,
    trail: VecDeque<(usize, Vec<[f32; 2]>)>,
    trail_failed: Option<usize>,
    /// Why the frame shown is not the one asked for.
    error: Option<String>,
    joints: Vec<JointEnds>,
}

/// Where a joint of the scene holds its bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
struct JointEnds {
    slots: [usize; 2],
    /// Metres from each body's centroid, in its own axes.
    anchors_body: [[f64; 2]; 2],
}

impl Pane {
    /// Shows a source's first frame.
    pub fn new(source: Box<dyn Source>) -> Self {
        let nothing =
            BodyTable { step: u64::MAX, bodies: Vec::new(), forces: lamina2d::force::Forces::default() };
        let mut pane = Self {
            source,
            shown: None,
            data: FrameData::default(),
            table: Arc::new(nothing),
            entry_of: Vec::new(),
            islands: Vec::new(),
            island_count: 0,
            trail: VecDeque::new(),
            trail_failed: None,
            error: None,
            joints: Vec::new(),
        };
        pane.show(pane.source.first());
        pane.joints = pane.find_joints();
        pane
    }

    /// Reads a frame, unless it is the one that is shown. One that cannot be read leaves the last in place, and
    /// [`Pane::error`] says why.
    pub fn show(&mut self, frame: usize) {
        if self.shown == Some(frame) {
            return;
        }
        self.shown = Some(frame);
        self.error = self.read(frame).err().map(|why| why.to_string());
    }

    /// Forgets which frame is shown: it may be another one now.
    pub fn refresh(&mut self) {
        self.shown = None;
    }

    /// The scene's joints, by the poses of its first frame, from which their anchors go with the bodies.
    fn find_joints(&self) -> Vec<JointEnds> {
        if self.error.is_some() || self.frame().step != 0 {
            return Vec::new();
        }
        let ends = |joint: &JointSpec| {
            let slots = joint.bodies.map(|body| body + 1);
            let given = joint.kind.anchors();
            let mut anchors_body = [[0.0; 2]; 2];
            for k in 0..2 {
                let centroid = self.position(slots[k])?;
                let [dx, dy] = given[k].map_or([0.0; 2], |at| [at[0] - centroid[0], at[1] - centroid[1]]);
                let [c, s] = [column::COS, column::SIN].map(|at| self.frame().get(at, slots[k]));
                anchors_body[k] = [c * dx + s * dy, c * dy - s * dx];
            }
            Some(JointEnds { slots, anchors_body })
        };
        self.source.scene().joints.iter().filter_map(ends).collect()
    }

    /// Where the scene's joints hold their bodies A and B now, and these bodies' centroids, metres: of those whose bodies
    /// are both still there.
    pub fn joints(&self) -> impl Iterator<Item = ([[f64; 2]; 2], [[f64; 2]; 2])> + '_ {
        self.joints.iter().filter_map(|joint| {
            let (mut held, mut centroids) = ([[0.0; 2]; 2], [[0.0; 2]; 2]);
            for k in 0..2 {
                let slot = joint.slots[k];
                // Another body may have the slot by now.
                self.entry(slot).filter(|body| body.generation == 0)?;
                centroids[k] = self.position(slot)?;
                let [c, s] = [column::COS, column::SIN].map(|at| self.frame().get(at, slot));
                let [x, y] = joint.anchors_body[k];
                held[k] = [centroids[k][0] + c * x - s * y, centroids[k][1] + s * x + c * y];
            }
            Some((held, centroids))
        })
    }

    fn read(&mut self, frame: usize) -> Result<(), SourceError> {
        let data = self.source.frame(frame)?;
        let table = self.source.bodies(data.frame.step)?;
        if !Arc::ptr_eq(&table, &self.table) || self.entry_of.len() <= data.frame.alive.len() {
            self.entry_of = vec![0; data.frame.alive.len() + 1];
            for (at, body) in table.bodies.iter().enumerate() {
                if let Some(entry) = self.entry_of.get_mut(body.slot as usize) {
                    *entry = at as u32 + 1;
                }
            }
            self.table = table;
        }
        self.data = data;
        (self.islands, self.island_count) = islands(&self.data, |slot| self.is_dynamic(slot));
        Ok(())
    }

    fn is_dynamic(&self, slot: usize) -> bool {
        self.entry(slot).is_some_and(|body| body.kind == BodyKind::Dynamic)
    }

    /// The frame shown.
    pub fn frame(&self) -> &Frame {
        &self.data.frame
    }
    /// The frame shown with its contacts.
    pub fn data(&self) -> &FrameData {
        &self.data
    }
    /// Why the frame shown is not the one asked for.
    pub fn error(&self) -> Option<&str> {
        self.error.as_deref()
    }
    /// Islands of more than one dynamic body.
    pub fn island_count(&self) -> usize {
        self.island_count
    }
    /// The least slot of a body's island; 0 for what is in none.
    pub fn island(&self, slot: usize) -> u32 {
        self.islands.get(slot).copied().unwrap_or(0)
    }

    /// What the body in a slot is.
    pub fn entry(&self, slot: usize) -> Option<&BodyEntry> {
        let at = self.entry_of.get(slot).copied().unwrap_or(0);
        self.table.bodies.get((at as usize).checked_sub(1)?)
    }

    /// Bodies of the frame that are known, in the order of their slots.
    pub fn bodies(&self) -> impl Iterator<Item = (usize, &BodyEntry)> + '_ {
        self.data.frame.slots().filter_map(|slot| Some((slot, self.entry(slot)?)))
    }

    /// Where a living body's centroid is, metres.
    pub fn position(&self, slot: usize) -> Option<[f64; 2]> {
        let frame = &self.data.frame;
        frame.lives(slot).then(|| [frame.get(column::X, slot), frame.get(column::Y, slot)])
    }

    /// The body a point lies in, metres; of several the smallest.
    pub fn body_at(&self, point: [f64; 2]) -> Option<usize> {
        let hit = self.bodies().filter(|(slot, body)| contains(self.frame(), *slot, body, point));
        hit.min_by(|a, b| a.1.radius.total_cmp(&b.1.radius)).map(|(slot, _)| slot)
    }

    /// Makes the trail reach back `length` frames from the one shown, as far as memory allows.
    pub fn extend_trail(&mut self, length: usize) {
        let Some(shown) = self.shown else { return };
        let slots = self.data.frame.alive.len().max(1);
        let length = length.min(MOST_TRAIL).min(MOST_POSITIONS / slots);
        if length == 0 || self.error.is_some() {
            self.trail.clear();
            return;
        }
        let first = shown.saturating_sub(length).max(self.source.first());
        let follows = self.trail.back().is_some_and(|(last, _)| (first..=shown).contains(last));
        if !follows {
            self.trail.clear();
        }
        while self.trail.front().is_some_and(|(frame, _)| *frame < first) {
            self.trail.pop_front();
        }
        // A trail begins where it is whole: a longer one than before is read anew.
        if self.trail.front().is_some_and(|(frame, _)| *frame > first) && self.trail_failed != Some(first) {
            self.trail.clear();
        }
        let from = self.trail.back().map_or(first, |(last, _)| last + 1);
        for frame in from..=shown {
            let positions = if frame == shown {
                Some(positions(&self.data.frame))
            } else {
                self.source.frame(frame).ok().map(|data| positions(&data.frame))
            };
            if let Some(positions) = positions {
                self.trail.push_back((frame, positions));
            } else {
                self.trail.clear();
                self.trail_failed = Some(first);
            }
        }
    }

    /// Positions by slot − 1, of frame after frame up to the one shown, metres.
    pub fn trail(&self) -> impl DoubleEndedIterator<Item = &[[f32; 2]]> + '_ {
        self.trail.iter().map(|(_, positions)| positions.as_slice())
    }
}

fn positions(frame: &Frame) -> Vec<[f32; 2]> {
    let place = |(at, alive): (usize, &bool)| {
        let place = [frame.columns[column::X][at] as f32, frame.columns[column::Y][at] as f32];
        if *alive { place } else { [f32::NAN; 2] }
    };
    frame.alive.iter().enumerate().map(place).collect()
}

/// Does a point lie in a body? Metres.
fn contains(frame: &Frame, slot: usize, body: &BodyEntry, point: [f64; 2]) -> bool {
    let [dx, dy] = [point[0] - frame.get(column::X, slot), point[1] - frame.get(column::Y, slot)];
    let (c, s) = (frame.get(column::COS, slot), frame.get(column::SIN, slot));
    let [x, y] = [c * dx + s * dy, c * dy - s * dx];
    match &body.shape {
        ShapeSpec::Circle(radius) => x.hypot(y) <= *radius,
        ShapeSpec::Box([hx, hy]) => x.abs() <= *hx && y.abs() <= *hy,
        ShapeSpec::Polygon(outline) => {
            let edges = outline.iter().zip(outline.iter().cycle().skip(1));
            outline.len() > 2
                && edges
                    .map(|(a, b)| (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]))
                    .all(|side| side >= 0.0)
        }
    }
}

/// Union-find over contacts between dynamic bodies: by slot the least slot of its island, 0 for those that touch no
/// other; and how many islands there are.
fn islands(data: &FrameData, is_dynamic: impl Fn(usize) -> bool) -> (Vec<u32>, usize) {
    let mut parent: Vec<u32> = (0..=data.frame.alive.len() as u32).collect();
    let mut joined = vec![false; parent.len()];
    for contact in &data.contacts {
        let [a, b] = contact.slots.map(|slot| slot as usize);
        if is_dynamic(a) && is_dynamic(b) {
            (joined[a], joined[b]) = (true, true);
            let (a, b) = (root(&mut parent, a as u32), root(&mut parent, b as u32));
            parent[a.max(b) as usize] = a.min(b);
        }
    }
    let islands: Vec<u32> =
        (0..parent.len()).map(|slot| if joined[slot] { root(&mut parent, slot as u32) } else { 0 }).collect();
    let count = islands.iter().enumerate().filter(|(slot, root)| *slot > 0 && *slot as u32 == **root).count();
    (islands, count)
}

/// The root of a slot; paths are halved on the way.
fn root(parent: &mut [u32], mut slot: u32) -> u32 {
    while parent[slot as usize] != slot {
        let above = parent[parent[slot as usize] as usize];
        parent[slot as usize] = above;
        slot = above;
    }
    slot
}

#[cfg(test)]
mod tests {
    use lamina2d::record::RecordedContact;

    use super::*;

    #[test]
    fn islands_are_joined_by_contacts_of_dynamic_bodies_alone() {
        let touch = |a: u32, b: u32| RecordedContact {
            slots: [a, b],
            points: 1,
            features: [0; 2],
            values: [0.0; 11],
        };
        let frame = Frame { alive: vec![true; 7], ..Frame::default() };
        // Slot 4 is a floor; 5, 6 and 7 hang together in a chain that is closed last.
        let contacts = vec![touch(1, 2), touch(2, 4), touch(3, 4), touch(6, 7), touch(5, 7)];
        let (islands, count) = islands(&FrameData { frame, contacts }, |slot| slot != 4);
        assert_eq!(islands, [0, 1, 1, 0, 0, 5, 5, 5]);
        assert_eq!(count, 2);
    }
}
