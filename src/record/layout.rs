//! Messages as bytes: little-endian, no padding, every length checked.

use crate::contact::CONTACT_COLUMNS;
use crate::world::{COLUMNS, Snapshot};

use super::container::{Damage, damage};

/// What a message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(super) enum Topic {
    /// [`super::RunInfo`], JSON.
    Run,
    /// [`crate::scene::Scene`], JSON.
    Scene,
    /// [`super::BodyTable`], JSON: where bodies come, go, or change what they are.
    Bodies,
    /// [`crate::session::Event`], JSON: what was done to the world before the step after it.
    Event,
    /// [`Frame`].
    Frame,
    /// [`Contacts`].
    Contacts,
    /// [`StepRow`].
    Step,
    /// Step rows once more, and the chunk of each step's frame.
    Index,
    /// [`super::recording`]'s table, JSON.
    Contents,
}

impl Topic {
    pub(super) const ALL: [Self; 9] = [
        Self::Run,
        Self::Scene,
        Self::Bodies,
        Self::Event,
        Self::Frame,
        Self::Contacts,
        Self::Step,
        Self::Index,
        Self::Contents,
    ];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Run => "/run",
            Self::Scene => "/scene",
            Self::Bodies => "/bodies",
            Self::Event => "/event",
            Self::Frame => "/frame",
            Self::Contacts => "/contacts",
            Self::Step => "/step",
            Self::Index => "/index",
            Self::Contents => "/contents",
        }
    }

    /// Of a message of bytes: what is in it, in words.
    pub(super) fn layout(self) -> Option<String> {
        let floats = |columns: &[&str]| columns.join(", ");
        Some(match self {
            Self::Frame => format!(
                "u64 step, f64 time_secs, u32 slots, u32 width (bytes per number: 4 or 8); then slots numbers each of {}; \
                 then slots bytes: 1 lives, 2 sleeps. Slot k is entry k - 1.",
                floats(&COLUMNS)
            ),
            Self::Contacts => format!(
                "u64 step, u32 count, u32 width; then count u32 each of slot_a, slot_b, code (points << 16 | feature1 << 8 | \
                 feature0); then count numbers each of {}",
                floats(&CONTACT_COLUMNS)
            ),
            Self::Step => format!("u64 step, u64 hash, f64 each of {}", floats(&STATISTICS)),
            Self::Index => {
                "u32 count; then count of: a /step message, u32 chunk of its frame (4294967295: none)".into()
            }
            _ => return None,
        })
    }

    pub(super) fn encoding(self) -> &'static str {
        if self.layout().is_some() { "lamina2d" } else { "json" }
    }
}

/// What is known of each step, by name: seconds, ns per stage, counts, J, kg·m/s, kg·m²/s, metres.
///
/// Overlaps are what the contacts' gaps say; NaN where a step's contacts were not recorded. Joints and contacts that were solved
/// directly, and bodies that were advanced beside their scheme, which could not follow their fields: NaN in recordings of
/// format 1, which did not have them.
pub const STATISTICS: [&str; 24] = [
    "time_secs",
    "broad_ns",
    "narrow_ns",
    "prepare_ns",
    "integrate_ns",
    "solve_ns",
    "measure_ns",
    "candidates",
    "pairs",
    "contacts",
    "sleeping",
    "islands",
    "substeps_least",
    "substeps_most",
    "kinetic_energy",
    "potential_energy",
    "momentum_x",
    "momentum_y",
    "angular_momentum",
    "max_overlap",
    "mean_overlap",
    "direct_joints",
    "direct_contacts",
    "stiff",
];

/// How many of them a format has: the first.
pub(super) fn statistics_in(format: u32) -> usize {
    if format <= 1 { 21 } else { STATISTICS.len() }
}

/// One step's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepRow {
    /// Its number; 0 is the state before the first.
    pub step: u64,
    /// Of poses and velocities; see [`crate::measure::state_hash`].
    pub hash: u64,
    /// [`STATISTICS`].
    pub values: [f64; STATISTICS.len()],
}

impl StepRow {
    /// One of [`STATISTICS`] by its name.
    pub fn get(&self, name: &str) -> Option<f64> {
        STATISTICS.iter().position(|known| *known == name).map(|at| self.values[at])
    }

    pub(super) fn write(&self, out: &mut Vec<u8>) {
        out.extend_from_slice(&self.step.to_le_bytes());
        out.extend_from_slice(&self.hash.to_le_bytes());
        out.extend(self.values.iter().flat_map(|value| value.to_le_bytes()));
    }

    /// `known`: how many statistics there are, see [`statistics_in`].
    pub(super) fn read(bytes: &[u8], known: usize) -> Result<Self, Damage> {
        let mut from = Bytes(bytes);
        let row = Self::take(&mut from, known)?;
        from.end("a step's numbers").map(|()| row)
    }

    pub(super) fn take(from: &mut Bytes<'_>, known: usize) -> Result<Self, Damage> {
        let (step, hash, mut values) = (from.u64()?, from.u64()?, [f64::NAN; STATISTICS.len()]);
        for value in &mut values[..known] {
            *value = from.f64()?;
        }
        Ok(Self { step, hash, values })
    }
}

/// All bodies at one step: columns by slot, entry k − 1 for slot k.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frame {
    /// Its number.
    pub step: u64,
    /// Simulated seconds.
    pub time_secs: f64,
    /// [`COLUMNS`]: metres, cos, sin, m/s, rad/s.
    pub columns: [Vec<f64>; COLUMNS.len()],
    /// Does a body live in the slot?
    pub alive: Vec<bool>,
    /// Does it sleep?
    pub asleep: Vec<bool>,
}

/// Bytes of a frame before its columns.
const FRAME_HEAD: usize = 24;

/// Writes a snapshot's bodies.
pub(super) fn write_frame(snapshot: &Snapshot, time_secs: f64, out: &mut Vec<u8>) {
    out.clear();
    out.reserve(FRAME_HEAD + snapshot.columns.len() + snapshot.flags.len());
    out.extend_from_slice(&snapshot.step.to_le_bytes());
    out.extend_from_slice(&time_secs.to_le_bytes());
    out.extend_from_slice(&(snapshot.slots as u32).to_le_bytes());
    out.extend_from_slice(&(snapshot.width as u32).to_le_bytes());
    out.extend_from_slice(&snapshot.columns);
    out.extend_from_slice(&snapshot.flags);
}

impl Frame {
    /// The step alone.
    pub(super) fn step_of(bytes: &[u8]) -> Result<u64, Damage> {
        Bytes(bytes).u64()
    }

    pub(super) fn read(bytes: &[u8]) -> Result<Self, Damage> {
        let mut from = Bytes(bytes);
        let (step, time_secs) = (from.u64()?, from.f64()?);
        let (slots, width) = (from.u32()? as usize, from.u32()? as usize);
        let mut frame = Self { step, time_secs, ..Self::default() };
        for column in &mut frame.columns {
            *column = from.numbers(slots, width)?;
        }
        let flags = from.take(slots)?;
        frame.alive = flags.iter().map(|flags| flags & 1 != 0).collect();
        frame.asleep = flags.iter().map(|flags| flags & 2 != 0).collect();
        from.end("a frame").map(|()| frame)
    }

    /// Does a body live in a slot, of those the frame has and of any other?
    pub fn lives(&self, slot: usize) -> bool {
        slot.checked_sub(1).and_then(|at| self.alive.get(at)).is_some_and(|alive| *alive)
    }

    /// Slots of living bodies, ascending.
    pub fn slots(&self) -> impl Iterator<Item = usize> + '_ {
        self.alive.iter().enumerate().filter(|(_, alive)| **alive).map(|(at, _)| at + 1)
    }

    /// A column's entry for a slot, in the order of [`COLUMNS`].
    pub fn get(&self, column: usize, slot: usize) -> f64 {
        self.columns[column][slot - 1]
    }
}

/// A contact as it was recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecordedContact {
    /// Slots of bodies A and B.
    pub slots: [u32; 2],
    /// 1 or 2.
    pub points: usize,
    /// Which features touch, per point.
    pub features: [u8; 2],
    /// [`CONTACT_COLUMNS`].
    pub values: [f64; CONTACT_COLUMNS.len()],
}

impl RecordedContact {
    /// Unit normal from A to B.
    pub fn normal(&self) -> [f64; 2] {
        [self.values[0], self.values[1]]
    }
    /// Point `k` from A's centroid when the manifold was found, world axes, metres.
    pub fn arm(&self, k: usize) -> [f64; 2] {
        [self.values[2 + 2 * k], self.values[3 + 2 * k]]
    }
    /// Of point `k`, metres, negative where bodies overlap.
    pub fn separation(&self, k: usize) -> f64 {
        self.values[6 + k]
    }
    /// Of point `k`, N·s per substep.
    pub fn impulse(&self, k: usize) -> f64 {
        self.values[8 + k]
    }
    /// Friction, N·s per substep, along the normal turned a quarter counter-clockwise.
    pub fn tangent_impulse(&self) -> f64 {
        self.values[10]
    }
}

/// The order of contacts by their slots, which in memory depends on lanes; kept while pairs stay as they are.
#[derive(Debug, Default)]
pub(super) struct Order {
    pairs: Vec<[u32; 3]>,
    order: Vec<u32>,
}

impl Order {
    fn of(&mut self, pairs: &[[u32; 3]]) -> &[u32] {
        if self.pairs != pairs {
            self.pairs.clear();
            self.pairs.extend_from_slice(pairs);
            self.order.clear();
            self.order.extend(0..pairs.len() as u32);
            self.order.sort_unstable_by_key(|&at| pairs[at as usize]);
        }
        &self.order
    }
}

/// Writes a snapshot's contacts in the order of their slots.
pub(super) fn write_contacts(snapshot: &Snapshot, order: &mut Order, out: &mut Vec<u8>) {
    let (count, width) = (snapshot.pairs.len(), snapshot.contact_width);
    let order = order.of(&snapshot.pairs);
    out.clear();
    out.reserve(16 + count * (12 + CONTACT_COLUMNS.len() * width));
    out.extend_from_slice(&snapshot.step.to_le_bytes());
    out.extend_from_slice(&(count as u32).to_le_bytes());
    out.extend_from_slice(&(width as u32).to_le_bytes());
    for column in 0..3 {
        out.extend(order.iter().flat_map(|&at| snapshot.pairs[at as usize][column].to_le_bytes()));
    }
    for column in 0..CONTACT_COLUMNS.len() {
        for &at in order {
            let entry = (at as usize * CONTACT_COLUMNS.len() + column) * width;
            out.extend_from_slice(&snapshot.contacts[entry..entry + width]);
        }
    }
}

/// The contacts of a step, and its number.
pub(super) fn read_contacts(bytes: &[u8]) -> Result<(u64, Vec<RecordedContact>), Damage> {
    let mut from = Bytes(bytes);
    let step = from.u64()?;
    let (count, width) = (from.u32()? as usize, from.u32()? as usize);
    let mut whole = || (0..3).map(|_| from.u32s(count)).collect::<Result<Vec<_>, _>>();
    let pairs = whole()?;
    let columns =
        CONTACT_COLUMNS.map(|_| from.numbers(count, width)).into_iter().collect::<Result<Vec<_>, _>>()?;
    from.end("contacts")?;
    let contact = |at: usize| {
        let code = pairs[2][at];
        RecordedContact {
            slots: [pairs[0][at], pairs[1][at]],
            points: (code >> 16) as usize,
            features: [code as u8, (code >> 8) as u8],
            values: std::array::from_fn(|column| columns[column][at]),
        }
    };
    let contacts: Vec<_> = (0..count).map(contact).collect();
    match contacts.iter().find(|contact| !(1..=2).contains(&contact.points)) {
        Some(odd) => Err(damage(format!("a contact of {} points", odd.points))),
        None => Ok((step, contacts)),
    }
}

/// Bytes yet to be read.
pub(super) struct Bytes<'a>(pub(super) &'a [u8]);

impl<'a> Bytes<'a> {
    fn take(&mut self, length: usize) -> Result<&'a [u8], Damage> {
        let (taken, rest) = self.0.split_at_checked(length).ok_or_else(|| damage("a message ends early"))?;
        self.0 = rest;
        Ok(taken)
    }
    fn array<const N: usize>(&mut self) -> Result<[u8; N], Damage> {
        Ok(self.take(N)?.try_into().unwrap_or([0; N]))
    }
    pub(super) fn u32(&mut self) -> Result<u32, Damage> {
        Ok(u32::from_le_bytes(self.array()?))
    }
    fn u64(&mut self) -> Result<u64, Damage> {
        Ok(u64::from_le_bytes(self.array()?))
    }
    fn f64(&mut self) -> Result<f64, Damage> {
        Ok(f64::from_le_bytes(self.array()?))
    }

    fn u32s(&mut self, count: usize) -> Result<Vec<u32>, Damage> {
        let bytes = self.take(count.checked_mul(4).ok_or_else(|| damage("a length without end"))?)?;
        Ok(bytes
            .chunks_exact(4)
            .map(|word| u32::from_le_bytes(word.try_into().unwrap_or_default()))
            .collect())
    }

    /// `count` numbers of 4 or 8 bytes.
    fn numbers(&mut self, count: usize, width: usize) -> Result<Vec<f64>, Damage> {
        if width != 4 && width != 8 {
            return Err(damage(format!("numbers of {width} bytes")));
        }
        let bytes = self.take(count.checked_mul(width).ok_or_else(|| damage("a length without end"))?)?;
        Ok((0..count).map(|at| Snapshot::number(bytes, width, at)).collect())
    }

    /// Nothing may be left.
    pub(super) fn end(&self, what: &str) -> Result<(), Damage> {
        if self.0.is_empty() {
            Ok(())
        } else {
            Err(damage(format!("{what} has {} bytes too many", self.0.len())))
        }
    }
}
