//! Grid: circles sorted by cell with a counting sort, one grid per level of size.
//!
//! A level holds radii within a factor of two; its cells are as wide as two of its largest circles, so
//! a circle's partners on its level lie in the 3 × 3 cells around its own. Cells of a row are contiguous
//! in memory: the neighbourhood is three runs, tested in whole lanes at any alignment. On its own level a
//! circle looks only ahead (the rest of its row's run, and the row above); on coarser levels at all three
//! rows. Cells are wider than needed by 1 % so that rounding of a cell's number loses no pair.

use super::{Circles, ordered};
use crate::lanes::{LaneMask, Lanes, Real, set_lanes};
use crate::workers::Workers;

/// Cells per circle at most; a scene spread wider gets larger cells.
const CELLS_PER_CIRCLE: f64 = 8.0;
/// Levels at most: a factor of 2⁴⁰ between the smallest and the largest plain body.
const MAX_LEVELS: usize = 40;

/// Cells are crowded where circles share theirs with so many, on the mean, themselves counted in: outliers have stretched them.
const CROWDED: usize = 16;
/// Lists for which crowded cells are not tried again.
const CROWDED_LISTS: u32 = 64;

/// Circles of a share from which on it is worth a thread: some 20 µs.
const WORTH: usize = 512;

/// The most cells a level of this many circles is laid out in.
fn most_cells(circles: usize) -> f64 {
    CELLS_PER_CIRCLE * circles as f64 + 16.0
}

/// One level of the grid.
#[derive(Clone, Debug)]
struct Level<R: Real> {
    sorted: Circles<R>,
    /// Start of each cell in `sorted`, row by row; one more entry for the end of the last.
    starts: Vec<u32>,
    members: Vec<u32>,
    cells: Vec<u32>,
    origin: [f64; 2],
    cell_size: f64,
    columns: i64,
    rows: i64,
    /// With how many each circle shares its cell, summed over circles.
    sharing: usize,
}

impl<R: Real> Level<R> {
    fn new() -> Self {
        Self {
            sorted: Circles::new(),
            starts: Vec::new(),
            members: Vec::new(),
            cells: Vec::new(),
            origin: [0.0; 2],
            cell_size: 1.0,
            columns: 0,
            rows: 0,
            sharing: 0,
        }
    }
}

/// The levels, finest first; memory is kept from step to step.
#[derive(Clone, Debug)]
pub(super) struct Grid<R: Real> {
    levels: Vec<Level<R>>,
    /// Lists that are to be found otherwise.
    pause: u32,
    /// Pairs that workers beside the first have found.
    beside: Vec<Vec<[u32; 2]>>,
}

impl<R: Real> Default for Grid<R> {
    fn default() -> Self {
        Self { levels: Vec::new(), pause: 0, beside: Vec::new() }
    }
}

impl<R: Real> Grid<R> {
    pub(super) fn bytes(&self) -> usize {
        let level = |l: &Level<R>| {
            (l.starts.capacity() + l.members.capacity() + l.cells.capacity()) * 4 + l.sorted.x.bytes() * 3
        };
        self.levels.iter().map(level).sum()
    }

    /// Says whether it has found them: it `gives_way` where cells are crowded.
    pub(super) fn find<L: Lanes<Elem = R>>(
        &mut self,
        workers: &Workers,
        circles: &Circles<R>,
        pairs: &mut Vec<[u32; 2]>,
        gives_way: bool,
    ) -> bool {
        if gives_way && self.pause > 0 {
            self.pause -= 1;
            return false;
        }
        self.assign(circles);
        for level in &mut self.levels {
            level.build(circles);
        }
        let sharing: usize = self.levels.iter().map(|level| level.sharing).sum();
        if gives_way && sharing > CROWDED * circles.len() {
            self.pause = CROWDED_LISTS;
            return false;
        }
        for (k, level) in self.levels.iter().enumerate() {
            level.share_own_pairs::<L>(workers, &mut self.beside, pairs);
            for coarser in &self.levels[k + 1..] {
                level.pairs_with::<L>(coarser, pairs);
            }
        }
        true
    }

    /// Deals the circles out to levels by the power of two of their radius over the smallest.
    fn assign(&mut self, circles: &Circles<R>) {
        for level in &mut self.levels {
            level.members.clear();
        }
        let radii = &circles.r.padded()[..circles.len()];
        let smallest = radii.iter().map(|r| r.to_f64()).fold(f64::INFINITY, f64::min);
        for (at, radius) in radii.iter().enumerate() {
            // Radii of up to twice the smallest share the finest level.
            let (mut ratio, mut level) = (radius.to_f64() / smallest, 0);
            while ratio > 2.0 && level + 1 < MAX_LEVELS {
                (ratio, level) = (0.5 * ratio, level + 1);
            }
            while self.levels.len() <= level {
                self.levels.push(Level::new());
            }
            self.levels[level].members.push(at as u32);
        }
    }
}

impl<R: Real> Level<R> {
    fn build(&mut self, circles: &Circles<R>) {
        if self.sorted.len() != self.members.len() {
            self.sorted.resize(self.members.len());
        }
        self.lay_out(circles);
        self.starts.clear();
        // Room for all it may ever get: bodies that drift apart make more cells, but no allocation.
        self.starts.reserve(most_cells(self.members.len()) as usize + 1);
        self.starts.resize((self.columns * self.rows) as usize + 1, 0);
        self.cells.clear();
        for &member in &self.members {
            let (x, y, _, _) = circles.get(member as usize);
            let (column, row) = self.cell_of(x.to_f64(), y.to_f64());
            let cell = (row * self.columns + column) as u32;
            self.cells.push(cell);
            self.starts[cell as usize + 1] += 1;
        }
        (self.sharing, _) = self.starts.iter_mut().fold((0, 0), |(sharing, end), start| {
            let shared = *start as usize;
            *start += end;
            (sharing + shared * shared, *start)
        });
        // Placing from the last moves each start to where its cell begins, in stable order.
        for (&member, &cell) in self.members.iter().zip(&self.cells).rev() {
            let end = &mut self.starts[cell as usize + 1];
            *end -= 1;
            self.sorted.set(*end as usize, circles.get(member as usize));
        }
        self.starts.rotate_left(1);
        if let Some(last) = self.starts.last_mut() {
            *last = self.members.len() as u32;
        }
    }

    fn lay_out(&mut self, circles: &Circles<R>) {
        let (mut low, mut high, mut largest) = ([f64::MAX; 2], [f64::MIN; 2], 0.0f64);
        for &member in &self.members {
            let (x, y, r, _) = circles.get(member as usize);
            for (k, v) in [x.to_f64(), y.to_f64()].into_iter().enumerate() {
                (low[k], high[k]) = (low[k].min(v), high[k].max(v));
            }
            largest = largest.max(r.to_f64());
        }
        if self.members.is_empty() {
            (self.columns, self.rows) = (0, 0);
            return;
        }
        let (width, height) = (high[0] - low[0], high[1] - low[1]);
        let most = most_cells(self.members.len());
        let mut size = largest * 2.02;
        // At most a few cells per circle, whatever its outliers.
        while (width / size + 1.0) * (height / size + 1.0) > most {
            size *= 1.5;
        }
        (self.origin, self.cell_size) = (low, size);
        self.columns = (width / size) as i64 + 1;
        self.rows = (height / size) as i64 + 1;
    }

    /// Column and row of a point. Outside the grid they run on past its edges, up to the first from which
    /// no neighbour is inside: a body that flew away has no cell number an integer could hold.
    #[inline]
    fn cell_of(&self, x: f64, y: f64) -> (i64, i64) {
        let index = |v: f64, origin: f64, cells: i64| {
            ((v - origin) / self.cell_size).floor().clamp(-2.0, cells as f64 + 1.0) as i64
        };
        (index(x, self.origin[0], self.columns), index(y, self.origin[1], self.rows))
    }

    /// The run of circles in columns `first..=last` of a row, clipped to the grid.
    fn run(&self, row: i64, first: i64, last: i64) -> std::ops::Range<usize> {
        let (first, last) = (first.max(0), last.min(self.columns - 1));
        if row < 0 || row >= self.rows || first > last {
            return 0..0;
        }
        let cell = |column: i64| self.starts[(row * self.columns + column) as usize] as usize;
        cell(first)..cell(last + 1)
    }

    /// The level's own pairs: rows of cells shared out, as many circles to each worker; what they have found is put behind each
    /// other.
    fn share_own_pairs<L: Lanes<Elem = R>>(
        &self,
        workers: &Workers,
        beside: &mut Vec<Vec<[u32; 2]>>,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let shares = workers.count().min(self.sorted.len() / WORTH).max(1);
        let share = self.sorted.len().div_ceil(shares);
        // Circles before a row.
        let before = |row: i64| self.starts[(row * self.columns) as usize] as usize;
        let cut = |number: usize| {
            let mut row = 0;
            while row < self.rows && (number == shares || before(row) < number * share) {
                row += 1;
            }
            row
        };
        let find =
            |number: usize, pairs: &mut Vec<_>| self.own_pairs::<L>(cut(number)..cut(number + 1), pairs);
        if shares == 1 {
            return find(0, pairs);
        }
        beside.resize_with(beside.len().max(shares), Vec::new);
        workers.each(&mut beside[..shares], find);
        for found in &mut beside[..shares] {
            pairs.append(found);
        }
    }

    fn own_pairs<L: Lanes<Elem = R>>(&self, rows: std::ops::Range<i64>, pairs: &mut Vec<[u32; 2]>) {
        for row in rows {
            for column in 0..self.columns {
                let own = self.run(row, column, column);
                if own.is_empty() {
                    continue;
                }
                let beside_end = self.run(row, column, column + 1).end;
                let above = self.run(row + 1, column - 1, column + 1);
                for a in own {
                    let circle = self.sorted.get(a);
                    self.test::<L>(circle, a + 1..beside_end, pairs);
                    self.test::<L>(circle, above.clone(), pairs);
                }
            }
        }
    }

    fn pairs_with<L: Lanes<Elem = R>>(&self, coarser: &Self, pairs: &mut Vec<[u32; 2]>) {
        for a in 0..self.sorted.len() {
            let circle = self.sorted.get(a);
            let (column, row) = coarser.cell_of(circle.0.to_f64(), circle.1.to_f64());
            for row in row - 1..=row + 1 {
                coarser.test::<L>(circle, coarser.run(row, column - 1, column + 1), pairs);
            }
        }
    }

    #[inline(always)]
    fn test<L: Lanes<Elem = R>>(
        &self,
        (x, y, r, slot): (R, R, R, u32),
        run: std::ops::Range<usize>,
        pairs: &mut Vec<[u32; 2]>,
    ) {
        let (x, y, r) = (L::splat(x), L::splat(y), L::splat(r));
        let mut at = run.start;
        while at < run.end {
            let in_run = (run.end - at).min(L::WIDTH);
            let hits = self.sorted.meeting(at, x, y, r).bits() & ((1 << in_run) - 1);
            for lane in set_lanes(hits) {
                pairs.push(ordered(slot, self.sorted.slot[at + lane]));
            }
            at += L::WIDTH;
        }
    }
}
