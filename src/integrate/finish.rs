//! The pass that ends a step.

use super::path_of;
use crate::body::{Bodies, move_finely};
use crate::column::{BLOCK, Column};
use crate::each::Each as _;
use crate::lanes::{LaneMask, Lanes, set_lanes};
use crate::motion::{
    CONTACT_REUSE_DISTANCE, Common, Fast, FastBodies, Motion, Span, block_starts, four_of, lanes_of,
};
use crate::vec2::Rot;
use crate::workers::{PerPart, Workers, take};

/// Of the bodies of a part, what a step ends by reading and writing, from its first slot on.
struct Ending<'a, L: Lanes> {
    /// x, y, cos, sin.
    pose: [&'a mut [L]; 4],
    /// See [`Bodies::fine`].
    fine: Option<&'a mut [[L::Elem; 4]]>,
    /// vx, vy, ω.
    velocity: [&'a mut [L]; 3],
    /// Those that went far; where somebody asks.
    fast: FastBodies<'a, L::Elem>,
    /// Has any moved, is any fast enough for a margin, may any bounce; not 0 where so.
    any: [u32; 3],
}

impl<'a, L: Lanes> Ending<'a, L> {
    /// Takes what comes before so many lane values, or all.
    fn take(&mut self, lanes: Option<usize>, fast: FastBodies<'a, L::Elem>) -> Self {
        Self {
            pose: self.pose.each_mut().map(|column| take(column, lanes)),
            fine: self.fine.as_mut().map(|rows| take(rows, lanes.map(|lanes| lanes * L::WIDTH))),
            velocity: self.velocity.each_mut().map(|column| take(column, lanes)),
            fast,
            any: [0; 3],
        }
    }
}

/// What bodies are like, by slot, and what speeds say.
#[derive(Clone, Copy)]
struct Given<'a, L: Lanes> {
    radius: &'a [L],
    core: &'a [L],
    /// Half the speeds of [`finish`], m/s.
    half_speeds: [L; 2],
}

/// Ends a step: velocities go back to their columns, displacements are added to the poses, and bodies that
/// have gone further than [`CONTACT_REUSE_DISTANCE`] of their radius since they last did are noted as having moved, fast ones in `fast`.
/// `speeds`, m/s, that no two bodies' points reach together while no body's reaches half of them: those of
/// [`Outlook`](crate::motion::Outlook).
pub(crate) fn finish<L: Lanes>(
    workers: &Workers,
    bodies: &mut Bodies<L::Elem>,
    motion: &mut Motion<L::Elem>,
    fast: FastBodies<'_, L::Elem>,
    speeds: [f64; 2],
) {
    let given = Given::<L> {
        radius: bodies.radius.lanes(),
        core: bodies.core.lanes(),
        half_speeds: speeds.each(|speed| L::lit(0.5 * speed)),
    };
    let Bodies { x, y, c, s, vx, vy, w, fine, .. } = bodies;
    let asked = fast.is_some();
    let mut all = Ending::<L> {
        pose: [x.lanes_mut(), y.lanes_mut(), c.lanes_mut(), s.lanes_mut()],
        fine: fine.as_mut().map(Column::fours_mut),
        velocity: [vx.lanes_mut(), vy.lanes_mut(), w.lanes_mut()],
        fast: None,
        any: [0; 3],
    };
    let finish = |common: Common<'_, L::Elem>, part: &mut Span<'_, L>, ending: &mut Option<Ending<'_, L>>| {
        if let Some(ending) = ending {
            finish_span::<L>(common, given, part, ending);
        }
    };
    if motion.parts.count() == 1 {
        all.fast = fast;
        let mut one = [Some(all)];
        motion.each_span(workers, &mut one, finish);
        return motion.outlook.note(one[0].as_ref().map_or([0; 3], |ending| ending.any));
    }
    let mut lists = std::mem::take(&mut motion.fast);
    lists.resize_with(motion.parts.count(), Vec::new);
    let mut endings: PerPart<_> = std::array::from_fn(|_| None);
    let mut first = 0;
    for ((ending, end), list) in endings.iter_mut().zip(motion.parts.ends()).zip(&mut lists) {
        let lanes = end.map(|end| (end - first) / L::WIDTH);
        first = end.unwrap_or(first);
        *ending = Some(all.take(lanes, asked.then_some(list)));
    }
    motion.each_span(workers, &mut endings, finish);
    let any =
        endings.iter().flatten().fold([0; 3], |any, ending| crate::each::indexed(|k| any[k] | ending.any[k]));
    if let Some(fast) = fast {
        for list in &mut lists {
            fast.append(list);
        }
    }
    motion.fast = lists;
    motion.outlook.note(any);
}

fn finish_span<L: Lanes>(
    common: Common<'_, L::Elem>,
    given: Given<'_, L>,
    part: &mut Span<'_, L>,
    ending: &mut Ending<'_, L>,
) {
    let bound = L::lit(CONTACT_REUSE_DISTANCE);
    let first = part.first;
    let [mut any_has_moved, mut any_speculative, mut any_bouncing] = [0; 3];
    for run in part.own(common.runs) {
        let end = lanes_of::<L>(&run).end;
        for start in block_starts::<L>(run) {
            let mut angle = [L::zero(); BLOCK];
            for at in start..end.min(start + BLOCK) {
                let [vx, vy, w, _] = four_of::<L>(part.velocity, at);
                let last = four_of::<L>(part.moved, at);
                let moved: [L; 3] = crate::each::indexed(|k| part.total[k][at] + last[k]);
                let radius = given.radius[first + at];
                let path = path_of(moved, radius);
                if let Some(fast) = &mut ending.fast {
                    let is_fast = given.core[first + at].lt(path);
                    if is_fast.any() {
                        push_fast(&ending.pose, (first, at), is_fast.bits(), moved, fast);
                    }
                }
                for (column, value) in ending.velocity.iter_mut().zip([vx, vy, w]) {
                    column[at] = value;
                }
                let [x, y, _, _] = &mut ending.pose;
                if let Some(rows) = &mut ending.fine {
                    move_finely([x, y], rows, at, [moved[0], moved[1]]);
                } else {
                    for (column, step) in [(x, moved[0]), (y, moved[1])] {
                        column[at] = column[at] + step;
                    }
                }
                angle[at - start] = moved[2];
                let speed = (vx.abs() + vy.abs()) + radius * w.abs();
                any_speculative |= given.half_speeds[0].le(speed).bits();
                any_bouncing |= given.half_speeds[1].le(speed).bits();
                let drift = part.drift[at] + path;
                let stirs = (bound * radius).lt(drift);
                part.drift[at] = L::select(stirs, L::zero(), drift);
                let bits = stirs.bits();
                any_has_moved |= bits;
                for (lane, has_moved) in
                    part.has_moved[at * L::WIDTH..(at + 1) * L::WIDTH].iter_mut().enumerate()
                {
                    *has_moved = bits >> lane & 1 == 1;
                }
            }
            let [_, _, c, s] = &mut ending.pose;
            let block = start..end.min(start + BLOCK);
            turn([&mut c[block.clone()], &mut s[block]], &angle);
        }
    }
    ending.any = [any_has_moved, any_speculative, any_bouncing];
}

/// Turns a block of attitudes, or what of one is in use.
#[inline(always)]
pub(super) fn turn<L: Lanes>([c, s]: [&mut [L]; 2], angle: &[L; BLOCK]) {
    for i in 0..c.len().min(BLOCK) {
        let rot = Rot { c: c[i], s: s[i] }.turned(angle[i]);
        (c[i], s[i]) = (rot.c, rot.s);
    }
}

/// Notes the fast among the bodies of one lane value of a part, before their poses change. Out of line: inlined at every width
/// these few calls were a tenth of this room.
#[cold]
#[inline(never)]
pub(super) fn push_fast<L: Lanes>(
    pose: &[&mut [L]; 4],
    (first, at): (usize, usize),
    lanes: u32,
    moved: [L; 3],
    fast: &mut Vec<Fast<L::Elem>>,
) {
    let moved = moved.each(L::to_array);
    let start: [_; 4] = crate::each::indexed(|k| pose[k][at].to_array());
    for lane in set_lanes(lanes) {
        fast.push(Fast {
            slot: ((first + at) * L::WIDTH + lane) as u32,
            start: start.each(|lanes| lanes[lane]),
            moved: moved.each(|lanes| lanes[lane]),
        });
    }
}
