//! How contacts come into lanes, move between them, and leave.

use super::{COLORS, JOIN, LISTS, LaneValues, List, Stream, at};
use crate::contact::{Home, Manifolds, gap, impulse};
use crate::lanes::{Lanes, Real};
use crate::solve::substep_group::SubstepGroups;
use crate::workers::Parts;

impl<L: Lanes> Stream<L> {
    /// After pairs have been listed anew: contacts whose pair has left the list go, the others learn its new place.
    /// Gaps of the overflow are up to date; with `in_rows` the pairs' rows hold gaps and impulses of all.
    pub fn rename(&mut self, manifolds: &mut Manifolds<L::Elem>, in_rows: bool) {
        let padding = manifolds.padding();
        for place in 0..padding {
            let home = manifolds.homes()[place as usize];
            if home.is_some() {
                self.lists[home.list as usize].rename(home, place);
            }
        }
        let mut gone = std::mem::take(&mut self.gone);
        manifolds.take_gone(&mut gone);
        for &home in &gone {
            if home.list as usize % LISTS == COLORS {
                self.lists[home.list as usize].rename(home, padding);
            } else {
                self.remove(home, manifolds);
            }
        }
        self.gone = gone;
        for list in &mut self.lists {
            list.two.rename_padding(padding);
            list.one.rename_padding(padding);
        }
        self.put_overflow_down(manifolds, in_rows);
    }

    /// After manifolds have been found: contacts that touch no more go, and impulses stay with the features of points.
    pub fn follow(&mut self, manifolds: &mut Manifolds<L::Elem>, in_rows: bool) {
        let mut recoded = std::mem::take(&mut self.recoded);
        manifolds.take_recoded(&mut recoded);
        if !recoded.is_empty() {
            self.put_overflow_down(manifolds, in_rows);
        }
        for changed in &recoded {
            let place = changed.place as usize;
            let home = manifolds.homes()[place];
            if home.is_some() && !in_rows {
                manifolds.impulses_mut()[place] = self.lists[home.list as usize].impulses(home);
            }
            manifolds.rematch(changed);
            if !home.is_some() {
                continue;
            }
            let points = changed.now.points();
            if points == 0 {
                self.remove(home, manifolds);
                manifolds.homes_mut()[place] = Home::NONE;
                continue;
            }
            let row = manifolds.impulses()[place];
            let list = &mut self.lists[home.list as usize];
            if home.two == (points == 2 || list.joined) {
                list.set_impulses(home, row);
            } else {
                self.remove_lane(home, manifolds);
                self.put(home.list as usize, changed.place, manifolds);
            }
        }
        self.recoded = recoded;
    }

    /// Contacts of which `which(slots)` holds are put down to their pairs' rows. Gaps are up to date.
    pub fn put_down(
        &mut self,
        manifolds: &mut Manifolds<L::Elem>,
        in_rows: bool,
        which: impl Fn([u32; 2]) -> bool,
    ) {
        self.put_overflow_down(manifolds, in_rows);
        for place in 0..manifolds.pairs() {
            let home = manifolds.homes()[place];
            if home.is_some() && which(manifolds.slots(place)) {
                if !in_rows {
                    write(manifolds, place, &self.lane(home));
                }
                self.remove(home, manifolds);
                manifolds.homes_mut()[place] = Home::NONE;
            }
        }
    }

    /// Substep groups are others, or parts: contacts keep their colours, and what they hold. `scale(slots)` is what their
    /// impulses are to be multiplied by, if at all.
    pub(in crate::solve) fn regroup(
        &mut self,
        manifolds: &mut Manifolds<L::Elem>,
        in_rows: bool,
        (groups, parts): (&SubstepGroups<L::Elem>, &Parts),
        scale: impl Fn([u32; 2]) -> Option<L::Elem>,
    ) {
        self.put_overflow_down(manifolds, in_rows);
        let held: Vec<_> = manifolds
            .touching()
            .iter()
            .map(|&place| (place, manifolds.homes()[place as usize]))
            .map(|(place, home)| {
                (
                    place,
                    home.is_some().then(|| {
                        (
                            self.lane(home),
                            self.lists[home.list as usize].is_stale(home),
                            home.list as usize % LISTS,
                        )
                    }),
                )
            })
            .collect();
        for list in &mut self.lists {
            list.clear();
        }
        self.parts = *parts;
        let colors = LISTS * parts.lists();
        let lists = self.lists.len().max(groups.count() * colors).next_multiple_of(colors);
        self.lists.resize_with(lists, List::default);
        for (place, held) in held {
            let slots = manifolds.slots(place as usize);
            let scale = scale(slots);
            if let Some(scale) = scale.filter(|_| in_rows || held.is_none()) {
                for impulse in &mut manifolds.impulses_mut()[place as usize][..3] {
                    *impulse = *impulse * scale;
                }
            }
            let Some((mut values, stale, color)) = held else { continue };
            if let Some(scale) = scale {
                let [first, second] = at::VELOCITY_IMPULSE;
                for at in [first, second, at::TANGENT_IMPULSE] {
                    values[at] = values[at] * scale;
                }
            }
            let list = self.list_of(groups.of_pair(slots), color, slots);
            self.carry(list, place, (&values, stale), manifolds);
        }
        self.outdated = true;
    }

    /// One-point contacts of a colour are solved among its two-point contacts where that saves a batch, while they are few.
    pub(super) fn join(&mut self, color: usize, manifolds: &mut Manifolds<L::Elem>) {
        let per_part = self.colors_of_part();
        let points = |place: u32, manifolds: &Manifolds<L::Elem>| manifolds.code(place as usize).points();
        let is_one = |&place: &u32| points(place, manifolds) == 1;
        let batches = |count: usize| count.div_ceil(JOIN);
        let of = |count: &dyn Fn(&List<L>) -> usize| {
            self.lists[color..].iter().step_by(per_part).map(count).sum::<usize>()
        };
        let (two, one) = (of(&|list| list.two.used()), of(&|list| list.one.used()));
        let joined = self.lists[color].joined;
        let joins = if color % LISTS == COLORS {
            return;
        } else if joined {
            let one = of(&|list| list.two.places().iter().filter(|place| is_one(place)).count());
            one < two && one <= 3 * JOIN
        } else {
            let saves = batches(two) + batches(one) > batches(two + one);
            two > 0 && (1..=2 * JOIN).contains(&one) && saves
        };
        if joins == joined {
            return;
        }
        let mut movers = std::mem::take(&mut self.picked);
        for number in (color..self.lists.len()).step_by(per_part) {
            let list = &mut self.lists[number];
            list.joined = joins;
            movers.clear();
            let from = if joins { list.one.places() } else { list.two.places() };
            movers.extend(from.iter().copied().filter(|&place| points(place, manifolds) == 1));
            for &place in &movers {
                let home = manifolds.homes()[place as usize];
                let (values, stale) = (self.lane(home), self.lists[number].is_stale(home));
                self.remove_lane(home, manifolds);
                self.carry(number, place, (&values, stale), manifolds);
            }
        }
        self.picked = movers;
    }

    /// Takes a contact into a list with what it holds, and whether its manifold was found anew.
    fn carry(
        &mut self,
        list: usize,
        place: u32,
        (values, stale): (&LaneValues<L::Elem>, bool),
        manifolds: &mut Manifolds<L::Elem>,
    ) {
        let home = self.place_in(list, place, manifolds);
        self.lists[list].hold(home, values);
        if stale {
            self.touch(home);
        }
    }

    /// Takes a contact into a list, to be prepared with the impulses that its pair's row holds.
    pub(super) fn put(&mut self, list: usize, place: u32, manifolds: &mut Manifolds<L::Elem>) {
        let home = self.place_in(list, place, manifolds);
        self.lists[list].set_impulses(home, manifolds.impulses()[place as usize]);
        self.outdated = true;
    }

    fn place_in(&mut self, number: usize, place: u32, manifolds: &mut Manifolds<L::Elem>) -> Home {
        let (alone, per_part) = (number % LISTS == COLORS, self.colors_of_part());
        let list = &mut self.lists[number];
        let two = alone || list.joined || manifolds.code(place as usize).points() == 2;
        let first = self.parts.first(number / per_part) as u32;
        let contact = (place, manifolds.slots(place as usize).map(|slot| slot - first));
        let lane = if two {
            list.two.push(contact, manifolds.padding(), alone)
        } else {
            list.one.push(contact, manifolds.padding(), false)
        };
        let home = Home { list: number as u16, two, lane };
        manifolds.homes_mut()[place as usize] = home;
        home
    }

    /// A contact is no more.
    fn remove(&mut self, home: Home, manifolds: &mut Manifolds<L::Elem>) {
        let first = self.parts.first(home.list as usize / self.colors_of_part()) as u32;
        let slots = self.lists[home.list as usize].slots(home).map(|slot| slot + first);
        self.colors.free(slots, home.list as usize % LISTS);
        self.remove_lane(home, manifolds);
        self.outdated = true;
    }

    /// A contact leaves its lane, to the last of its list.
    fn remove_lane(&mut self, home: Home, manifolds: &mut Manifolds<L::Elem>) {
        let moved = self.lists[home.list as usize].remove(home, manifolds.padding());
        if let Some(place) = moved {
            manifolds.homes_mut()[place as usize].lane = home.lane;
        }
    }

    /// Contacts without a colour go back to their pairs' rows; they are to be arranged anew.
    fn put_overflow_down(&mut self, manifolds: &mut Manifolds<L::Elem>, in_rows: bool) {
        for number in (COLORS..self.lists.len()).step_by(LISTS) {
            for batch in 0..self.lists[number].two.len() {
                let home = Home { list: number as u16, two: true, lane: (batch * L::WIDTH) as u32 };
                let place = self.lists[number].two.places()[home.lane as usize];
                if place != manifolds.padding() {
                    if !in_rows {
                        write(manifolds, place as usize, &self.lane(home));
                    }
                    manifolds.homes_mut()[place as usize] = Home::NONE;
                }
                self.outdated = true;
            }
            self.lists[number].two.clear();
        }
    }
}

/// Impulses of a lane as a pair's row, N·s.
#[inline]
pub(super) fn impulses_of<R: Real>(values: &LaneValues<R>) -> [R; 4] {
    let normal = |k: usize| values[at::VELOCITY_IMPULSE[k]] * values[at::MASS[k]];
    [normal(0), normal(1), values[at::TANGENT_IMPULSE], R::ZERO]
}

/// Writes gaps and impulses of a lane to a pair's rows.
#[inline]
pub(super) fn write<R: Real>(manifolds: &mut Manifolds<R>, place: usize, values: &LaneValues<R>) {
    const { assert!(impulse::NORMAL == 0 && impulse::TANGENT == 2) };
    manifolds.impulses_mut()[place] = impulses_of(values);
    for k in 0..2 {
        manifolds.gaps_mut()[place][gap::SEPARATION + k] = values[at::SEPARATION[k]];
    }
}
