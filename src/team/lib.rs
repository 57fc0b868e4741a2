//! A few threads that share out short work: what a step of lamina2d is done by.
//!
//! A step of a large world has some hundred stages of 10 to 500 µs. A pool whose threads sleep between two of them takes as
//! long to wake as such a stage takes. The threads of a [`Team`] wait for the next one awake, for a while, and are handed it
//! in the time that a cache line takes from core to core.
//!
//! | part | what it does |
//! |---|---|
//! | [`Team::each`] | hands out entries of a slice, one to each worker, and waits until all are done |
//! | claim | every entry is claimed before it is worked on: who has done its own takes those that nobody has begun, so that a thread that the system has put aside holds nobody up |
//! | wait | a worker spins, then yields, then parks until it is called |
//!
//! # What is unsafe, and why it holds
//! 1. A task is borrowed for one call and handed to threads that outlive it. A worker reads it only after it has claimed an
//!    entry of this call; the call returns only when every claimed entry is done, and all are claimed by then.
//! 2. Entries are handed out as `&mut`, by index. An index is claimed once per call.
//!
//! A claim is a count of calls: entry k of call n is free while its count is n − 1, and whoever sets it to n has it. A worker
//! that comes late finds all counts past its call and touches nothing.
//!
//! `cargo test -p lamina-team`; `cargo +nightly miri test -p lamina-team` looks for undefined behaviour and data races.

use std::any::Any;
use std::cell::UnsafeCell;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError, TryLockError};
use std::thread::{JoinHandle, Thread};

/// Looks for the next call that a worker makes without a pause: about 10 µs.
const SPINS: u32 = 1 << 12;
/// Looks, each after yielding its core, before a worker parks: a millisecond at least.
const YIELDS: u32 = 1 << 12;

/// What a call asks of every entry.
type Task<'a> = dyn Fn(usize) + Sync + 'a;

/// A line of its own: who writes here does not take away what others read.
#[derive(Debug)]
#[repr(align(128))]
struct Line<T>(T);

/// What the caller and its workers share.
struct Shared {
    /// The task of the present call, and how many entries it has.
    task: UnsafeCell<Option<(*const Task<'static>, usize)>>,
    /// Number of the present call.
    call: Line<AtomicU64>,
    /// The last call each entry was claimed in.
    claimed: Vec<Line<AtomicU64>>,
    /// Entries of the present call that are done.
    done: Line<AtomicUsize>,
    /// A worker is parked, or about to be.
    parked: Vec<Line<AtomicBool>>,
    /// Workers are to end.
    ends: AtomicBool,
    /// What a task panicked with.
    panic: Mutex<Option<Box<dyn Any + Send>>>,
}

// SAFETY: `task` is written by the caller alone, while no entry is claimed, and read by who has claimed one.
unsafe impl Sync for Shared {}
// SAFETY: as above; the pointer is to what is `Sync`.
unsafe impl Send for Shared {}

impl Shared {
    /// Claims entries of a call and does them: its own first, then what others have not begun.
    fn work(&self, own: usize, call: u64) {
        let count = self.claimed.len();
        for step in 0..count {
            let entry = (own + step) % count;
            let claim = &self.claimed[entry].0;
            if claim.load(Ordering::Relaxed) != call - 1
                || claim.compare_exchange(call - 1, call, Ordering::AcqRel, Ordering::Relaxed).is_err()
            {
                continue;
            }
            // SAFETY: this entry is claimed for `call` and not done, so that the call has not returned: the task is the one
            // that was written before `call` was, and lives.
            let task = unsafe { *self.task.get() };
            if let Some((task, entries)) = task
                && entry < entries
            {
                // SAFETY: as above.
                let task = unsafe { &*task };
                if let Err(panic) = catch_unwind(AssertUnwindSafe(|| task(entry))) {
                    *self.panic.lock().unwrap_or_else(PoisonError::into_inner) = Some(panic);
                }
            }
            self.done.0.fetch_add(1, Ordering::Release);
        }
    }

    /// Until another call than `last` begins; `None` where workers are to end.
    fn next_call(&self, own: usize, last: u64) -> Option<u64> {
        let mut looks = 0_u32;
        loop {
            let call = self.call.0.load(Ordering::Acquire);
            if call != last {
                return Some(call);
            }
            if self.ends.load(Ordering::Acquire) {
                return None;
            }
            looks += 1;
            if looks < SPINS {
                std::hint::spin_loop();
            } else if looks < SPINS + YIELDS {
                std::thread::yield_now();
            } else {
                self.parked[own].0.store(true, Ordering::SeqCst);
                if self.call.0.load(Ordering::SeqCst) == last && !self.ends.load(Ordering::SeqCst) {
                    std::thread::park();
                }
                self.parked[own].0.store(false, Ordering::Relaxed);
                looks = 0;
            }
        }
    }
}

impl std::fmt::Debug for Shared {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Shared").field("workers", &self.claimed.len()).finish_non_exhaustive()
    }
}

/// Some threads, the caller's among them.
#[derive(Debug)]
pub struct Team {
    shared: Arc<Shared>,
    /// Held by a call: another thread's goes on alone meanwhile.
    busy: Mutex<()>,
    threads: Vec<JoinHandle<()>>,
}

impl Team {
    /// `workers` threads, at least one: the caller's, and others that start now.
    ///
    /// # Errors
    /// Where the system starts no more threads.
    pub fn new(workers: usize) -> std::io::Result<Self> {
        let workers = workers.max(1);
        let shared = Arc::new(Shared {
            task: UnsafeCell::new(None),
            call: Line(AtomicU64::new(0)),
            claimed: (0..workers).map(|_| Line(AtomicU64::new(0))).collect(),
            done: Line(AtomicUsize::new(0)),
            parked: (0..workers).map(|_| Line(AtomicBool::new(false))).collect(),
            ends: AtomicBool::new(false),
            panic: Mutex::new(None),
        });
        let mut team = Self { shared, busy: Mutex::new(()), threads: Vec::with_capacity(workers - 1) };
        for own in 1..workers {
            let shared = Arc::clone(&team.shared);
            let work = move || {
                let mut last = 0;
                while let Some(call) = shared.next_call(own, last) {
                    shared.work(own, call);
                    last = call;
                }
            };
            // Where one cannot be started, dropping the team ends those that were.
            team.threads.push(std::thread::Builder::new().name(format!("lamina-{own}")).spawn(work)?);
        }
        Ok(team)
    }

    /// Threads, the caller's among them.
    pub fn workers(&self) -> usize {
        self.shared.claimed.len()
    }

    /// Does `task(k, &mut entries[k])` for every entry; returns when all are done. Entry k is done by worker k where that one is
    /// free, the first [`Team::workers`] of them beside each other.
    ///
    /// # Panics
    /// Where a task does, after the others have ended.
    pub fn each<T: Send>(&self, entries: &mut [T], task: impl Fn(usize, &mut T) + Sync) {
        let workers = self.workers();
        let busy = match self.busy.try_lock() {
            // A call that panicked has ended: nothing of it is left.
            Err(TryLockError::Poisoned(busy)) => Some(busy.into_inner()),
            Ok(busy) => Some(busy),
            Err(TryLockError::WouldBlock) => None,
        };
        if workers == 1 || entries.len() < 2 || busy.is_none() {
            return entries.iter_mut().enumerate().for_each(|(k, entry)| task(k, entry));
        }
        for (first, entries) in (0..).step_by(workers).zip(entries.chunks_mut(workers)) {
            let base = Entries(entries.as_mut_ptr());
            let count = entries.len();
            self.call(count, &|k| {
                // SAFETY: k < count, and `call` hands every k out once.
                let entry = unsafe { &mut *base.at(k) };
                task(first + k, entry);
            });
        }
    }

    /// Does `task(k)` once for every k below `count`, which is at most the number of workers.
    fn call(&self, count: usize, task: &Task<'_>) {
        let shared = &*self.shared;
        // SAFETY: only the lifetime changes. Nobody reads the pointer after this call: see `Shared::work`.
        let task = unsafe { std::mem::transmute::<&Task<'_>, &'static Task<'static>>(task) };
        shared.done.0.store(0, Ordering::Relaxed);
        // SAFETY: every entry of the last call is done, and none of the next can be claimed yet: nobody reads.
        unsafe { *shared.task.get() = Some((std::ptr::from_ref(task), count)) };
        let call = shared.call.0.load(Ordering::Relaxed) + 1;
        shared.call.0.store(call, Ordering::SeqCst);
        for (thread, parked) in self.threads.iter().zip(&shared.parked[1..]) {
            if parked.0.load(Ordering::SeqCst) {
                Thread::unpark(thread.thread());
            }
        }
        shared.work(0, call);
        let mut looks = 0_u32;
        while shared.done.0.load(Ordering::Acquire) < self.workers() {
            looks += 1;
            // There may be more threads than cores.
            if looks < SPINS { std::hint::spin_loop() } else { std::thread::yield_now() }
        }
        let panic = shared.panic.lock().unwrap_or_else(PoisonError::into_inner).take();
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }
}

impl Drop for Team {
    fn drop(&mut self) {
        self.shared.ends.store(true, Ordering::SeqCst);
        for thread in self.threads.drain(..) {
            thread.thread().unpark();
            // A task's panic has been handed on already.
            drop(thread.join());
        }
    }
}

/// The entries of a call.
struct Entries<T>(*mut T);

impl<T> Entries<T> {
    fn at(&self, k: usize) -> *mut T {
        self.0.wrapping_add(k)
    }
}

// SAFETY: entries are handed to one thread each, and may be sent there.
unsafe impl<T: Send> Sync for Entries<T> {}

#[cfg(test)]
mod tests {
    use super::Team;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::time::{Duration, Instant};

    /// Miri is a hundred times slower.
    const CALLS: usize = if cfg!(miri) { 30 } else { 20_000 };

    #[test]
    fn every_entry_is_done_once_in_every_call() {
        for workers in [1, 2, 3, 4, 16] {
            let team = Team::new(workers).expect("threads");
            assert_eq!(team.workers(), workers);
            for entries in [0, 1, 2, workers, 2 * workers + 1] {
                let mut counts = vec![0_usize; entries];
                for call in 1..=CALLS / 20 {
                    team.each(&mut counts, |k, count| {
                        assert!(k < entries);
                        *count += k + 1;
                    });
                    assert!(counts.iter().enumerate().all(|(k, &count)| count == call * (k + 1)));
                }
            }
        }
    }

    #[test]
    fn calls_that_follow_see_what_those_before_them_wrote() {
        let team = Team::new(2).expect("threads");
        let mut rows = vec![1_u64; 64];
        for _ in 0..CALLS {
            let (left, right) = rows.split_at_mut(32);
            team.each(&mut [left, right], |_, rows| {
                rows.iter_mut().for_each(|row| *row = row.wrapping_mul(3));
            });
            // The halves change hands.
            rows.rotate_left(32);
        }
        let expected = (0..CALLS).fold(1_u64, |row, _| row.wrapping_mul(3));
        assert!(rows.iter().all(|&row| row == expected));
    }

    #[test]
    fn a_panic_reaches_the_caller_and_the_team_goes_on() {
        let team = Team::new(3).expect("threads");
        let done = AtomicUsize::new(0);
        let call = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            team.each(&mut [0; 3], |k, _| {
                assert!(k != 1, "entry one");
                done.fetch_add(1, Ordering::Relaxed);
            });
        }));
        let panic = call.expect_err("one entry panics");
        assert_eq!(panic.downcast_ref::<&str>(), Some(&"entry one"));
        assert_eq!(done.load(Ordering::Relaxed), 2, "the others have ended");
        // Beside each other, as before: each waits for the others.
        let (begun, until) = (AtomicUsize::new(0), Instant::now() + Duration::from_mins(1));
        let mut all_begun = [false; 3];
        team.each(&mut all_begun, |_, all| {
            begun.fetch_add(1, Ordering::SeqCst);
            while begun.load(Ordering::SeqCst) < 3 && Instant::now() < until {
                std::thread::yield_now();
            }
            *all = begun.load(Ordering::SeqCst) == 3;
        });
        assert_eq!(all_begun, [true; 3]);
    }

    #[test]
    fn threads_that_share_a_team_do_not_wait_for_each_other() {
        let team = Team::new(2).expect("threads");
        std::thread::scope(|scope| {
            for _ in 0..3 {
                scope.spawn(|| {
                    let mut sums = [0_usize; 4];
                    for _ in 0..CALLS / 10 {
                        team.each(&mut sums, |k, sum| *sum += k);
                    }
                    assert_eq!(sums, [0, 1, 2, 3].map(|k| k * (CALLS / 10)));
                });
            }
        });
    }

    #[test]
    fn parked_workers_come_when_called() {
        let team = Team::new(2).expect("threads");
        for _ in 0..3 {
            std::thread::sleep(Duration::from_millis(if cfg!(miri) { 1 } else { 60 }));
            let mut entries = [0; 2];
            team.each(&mut entries, |k, entry| *entry = k + 1);
            assert_eq!(entries, [1, 2]);
        }
    }
}
